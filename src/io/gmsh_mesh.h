// What a Gmsh file lists, and the mesh it becomes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

/// A physical surface (dimension 2) or volume (3). Tag 0 is what is in no physical volume.
typedef struct sn_gmsh_group {
    int dimension;
    long long tag;
    char name[SN_NAME_MAX];
    int count; ///< faces or cells in it
    int index; ///< surface or region of the mesh; -1 where it is empty
} sn_gmsh_group;

/// Nodes by their place in the file.
typedef struct sn_gmsh_face {
    int node[3], group;
} sn_gmsh_face;
typedef struct sn_gmsh_cell {
    int node[4], group;
} sn_gmsh_cell;

typedef struct sn_gmsh_lists {
    int group_count, node_count, face_count, cell_count;
    int split_cells; ///< hexahedra, prisms and pyramids that became tetrahedra
    sn_gmsh_group *groups;
    double *node; ///< metres                                      (node_count x 3)
    sn_gmsh_face *faces;
    sn_gmsh_cell *cells;
} sn_gmsh_lists;

void sn_gmsh_lists_free(sn_gmsh_lists *lists);
/// Builds and finishes the mesh: only nodes of tetrahedra, only groups with something in them.
/// @return SN_OK, SN_E_MESH with the path, SN_E_MEMORY.
sn_status sn_gmsh_build(sn_gmsh_lists *lists, const char *path, sn_mesh **mesh);
