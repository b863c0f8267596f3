// Reference elements: shape functions and quadrature of the tetrahedra and of their faces.
// SPDX-License-Identifier: Apache-2.0
//
// Everything is written in barycentric coordinates lambda_0 … lambda_3 of the straight-sided cell.
// Their gradients are constant in a cell, and the gradient of shape function a at a point is
//     grad N_a = sum_k (dN_a / dlambda_k) grad lambda_k,
// so that a quadratic element is a linear one with a constant table of slopes in front: forces and
// tangents are first formed for the four lambda_k and then mixed by the slopes.
//
// Quadrature. P1: the centroid (the integrands are constant). P2 and P2P1: four points, exact to
// degree 2, which is what the stiffness of a quadratic element needs for optimal order (Ciarlet,
// The finite element method for elliptic problems, section 4.1: degree 2k - 2) and gives 4 x 6 = 24
// independent strains for the 30 - 6 deformation modes of a cell. Faces: the centroid for P1, the
// six-point rule of degree 4 for P2, exact for a follower pressure.
// Source: Dunavant, Int. J. Numer. Meth. Eng. 21 (1985) 1129; Hammer, Marlowe & Stroud, Math.
// Tables Aids Comp. 10 (1956) 130.
#pragma once

#include "sinew/model.h"

#define SN_FE_NODES 10      ///< most nodes of a cell
#define SN_FE_QUADRATURE 4  ///< most points of a cell
#define SN_FE_FACE_NODES 6  ///< most nodes of a face
#define SN_FE_FACE_POINTS 6 ///< most points of a face

/// Ends of the midside nodes 4 … 9 of a cell, and 3 … 5 of a face.
extern const int sn_fe_cell_edge[6][2];
extern const int sn_fe_face_edge[3][2];

/// One element: values at its quadrature points.
typedef struct sn_fe_element {
    const char *name;
    bool mixed;                                                ///< has a linear pressure
    int nodes, points;                                         ///< of a cell
    int face_nodes, face_points;                               ///< of a face
    double weight[SN_FE_QUADRATURE];                           ///< of the cell's volume, sum 1
    double lambda[SN_FE_QUADRATURE][4];                        ///< the points
    double slope[SN_FE_QUADRATURE][SN_FE_NODES][4];            ///< dN_a / dlambda_k
    double face_weight[SN_FE_FACE_POINTS];                     ///< of the face's area, sum 1
    double face_shape[SN_FE_FACE_POINTS][SN_FE_FACE_NODES];    ///< N_a
    double face_slope[SN_FE_FACE_POINTS][SN_FE_FACE_NODES][2]; ///< d/dxi, d/deta
} sn_fe_element;

/// Fills the tables of an element.
void sn_fe_element_init(sn_element kind, sn_fe_element *element);
/// Shape functions of a cell with 4 or 10 nodes at barycentric coordinates.
/// @param shape  N_a                                            (nodes)
void sn_fe_cell_shape(int nodes, const double lambda[4], double *shape);
