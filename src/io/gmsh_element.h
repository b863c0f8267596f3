// The elements of Gmsh, and how faces and cells are cut into triangles and tetrahedra.
// SPDX-License-Identifier: Apache-2.0
#pragma once

typedef enum sn_gmsh_kind {
    SN_GMSH_SKIPPED, ///< points and lines
    SN_GMSH_FACE,
    SN_GMSH_CELL,
    SN_GMSH_REFUSED ///< known, but of no use here
} sn_gmsh_kind;

typedef struct sn_gmsh_element {
    int number; ///< Gmsh's
    sn_gmsh_kind kind;
    int dimension;
    int nodes;   ///< the corners stand first
    int corners; ///< that are kept; 0 where it is skipped or refused
    const char *name;
} sn_gmsh_element;

#define SN_GMSH_CORNERS 8 ///< most corners of an element
#define SN_GMSH_PARTS 6   ///< most tetrahedra of a cell; a face has 2 triangles at most

/// An element by Gmsh's number; NULL where it is not listed.
const sn_gmsh_element *sn_gmsh_element_find(long long number);
/// Cuts a triangle or a quadrangle. @param part  keeps the direction of the face  (2 x 3)
/// @return how many triangles.
int sn_gmsh_cut_face(int corners, const int *node, int part[2][3]);
/// Cuts a tetrahedron, a pyramid, a prism or a hexahedron (4, 5, 6, 8 corners in Gmsh's order).
/// @param part  of positive volume where the cell is    (SN_GMSH_PARTS x 4)
/// @return how many tetrahedra.
int sn_gmsh_cut_cell(int corners, const int *node, int part[SN_GMSH_PARTS][4]);
