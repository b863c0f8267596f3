// What the files of model/ share about meshes: matched faces, measures of cells and surfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

/// The faces of all cells, matched in pairs. Face 4 c + k lies opposite node k of cell c.
typedef struct sn_faces {
    int *other; ///< the same face of the neighbour, -1 on the boundary  (4 cell_count)
    int *head;  ///< first face of a chain: all whose nodes have one sum  (3 node_count)
    int *next;  ///< the face that follows in its chain, -1 at the end    (4 cell_count)
} sn_faces;

/// Matches faces. @return SN_OK, SN_E_MESH (a face of three cells), SN_E_MEMORY.
sn_status sn_faces_create(const sn_mesh *mesh, sn_faces *faces);
void sn_faces_destroy(sn_faces *faces);
/// A face with these three nodes in any order; -1 when no cell has it.
int sn_faces_find(const sn_mesh *mesh, const sn_faces *faces, const int node[3]);
/// Nodes of a face, its normal out of its cell by the right-hand rule.
void sn_face_nodes(const sn_mesh *mesh, int face, int node[3]);

/// Makes room for the faces of a surface that has none. @return SN_OK, SN_E_MEMORY.
sn_status sn_surface_reserve(sn_surface *surface, int face_count);
/// Twice the area of a triangle as a vector along its normal, m2.
void sn_triangle_normal(const sn_mesh *mesh, const int node[3], double normal[3]);
/// The box around the mesh, m.
void sn_mesh_box(const sn_mesh *mesh, double low[3], double high[3]);
/// Diagonal of the box around the mesh, m.
double sn_mesh_size(const sn_mesh *mesh);
/// The middle of a cell, m.
void sn_mesh_middle(const sn_mesh *mesh, int cell, double middle[3]);
/// Barycentric weights of a point in a cell; returns how far it is inside the nearest of the four
/// planes, m (negative outside).
double sn_mesh_depth(const sn_mesh *mesh, int cell, const double point[3], double weight[4]);
/// What of `from` holds on another mesh: the rule, or the list cell by cell. @return SN_OK,
/// SN_E_MEMORY.
sn_status sn_fibres_on_mesh(const sn_fibres *from, const sn_mesh *mesh, const sn_mesh *other,
                            sn_fibres *to);
/// Checks of fibres of a case. @return SN_OK, SN_E_DEFINITION, SN_E_RANGE.
sn_status sn_fibres_check(const sn_case *c);
/// As sn_mesh_locate(), without a text. @return false where the point is outside.
bool sn_mesh_find_point(const sn_mesh *mesh, const double point[3], int *cell, double weight[4]);
