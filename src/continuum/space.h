// The discrete body: nodes with midsides, cells in batches, surfaces, which motions are prescribed.
// SPDX-License-Identifier: Apache-2.0
//
// Unknowns stand in one vector x: three displacements a node (corners in the order of the mesh,
// then midsides in the order of the mesh's edges), then, for the mixed element, one pressure a
// corner.
//
// Cells are sorted by region and packed in batches of SN_FE_POINTS quadrature points, so that one
// batch has one tissue and every kernel runs over structures of arrays of fixed length. A last
// batch is filled by repeating its last cell; `batch_count` says how many cells are real. On
// several ranks the batches hold the cells that this rank works on; all else is of the whole body.
#pragma once

#include "continuum/element.h"
#include "continuum/ranks.h"

#define SN_FE_POINTS 64 ///< quadrature points of a batch; point q of cell c stands at q * cells + c

typedef struct sn_fe_space {
    sn_fe_element element;
    sn_fe_ranks *ranks;
    int corners;  ///< nodes of the mesh
    int nodes;    ///< with midsides
    int cells;    ///< of the mesh
    int dofs;     ///< length of x
    double *rest; ///< rest positions                              (nodes x 3)
    int *edge;    ///< ends of the edges, rising; none for P1       (edge_count x 2)
    int *edge_at; ///< first edge that starts at a corner           (corners + 1)
    int edge_count;
    bool rotated;   ///< a tissue has fibres: cells work in material axes
    double axes[9]; ///< rotation from space to material axes, where all cells have the same
    double *turned; ///< Nullable: rotation of each place, instead   (batches x cells x 9)
    int batch_cells, batches;
    int *batch_region;        ///<                                         (batches)
    int *batch_count;         ///<                                         (batches)
    int *slot;                ///< cell of the mesh at each place          (batches x cells)
    int *node;                ///< nodes of each place                     (batches x nodes x cells)
    double *gradient;         ///< grad lambda_k in material axes, 1/m     (batches x 4 x 3 x cells)
    double *volume;           ///< m3                                      (batches x cells)
    unsigned char *fixed;     ///< prescribed directions, bits 1 2 4    (nodes)
    double middle[3], size;   ///< of the body's box, m; the axes and the unit of the motions
    int free_motions;         ///< rigid motions that no support sees: see rigid.h
    double free_motion[6][6]; ///< translation, rotation about the middle; orthonormal
    int pin[6];               ///< unknowns that are left out for them
} sn_fe_space;

/// Faces of a surface with their midside nodes.
typedef struct sn_fe_faces {
    int count;
    int *node;    ///< (count x face_nodes)
    double *area; ///< rest area, m2 (count)
} sn_fe_faces;

sn_status sn_fe_space_create(const sn_case *c, sn_fe_space **space);
void sn_fe_space_destroy(sn_fe_space *space); // NULL is allowed
/// First unknown of a block: blocks are the nodes, then the pressures.
static inline int sn_fe_block_dof(const sn_fe_space *s, int block) {
    return block < s->nodes ? 3 * block : 2 * s->nodes + block;
}
/// Rotation from space to material axes of cell `at` of a batch.
static inline const double *sn_fe_axes(const sn_fe_space *s, int batch, int at) {
    return s->turned ? s->turned + 9 * ((size_t)batch * (size_t)s->batch_cells + (size_t)at)
                     : s->axes;
}
/// Index of the midside node between two corners. The edge must exist.
int sn_fe_space_midside(const sn_fe_space *s, int a, int b);
/// Faces of a surface. Free with sn_fe_faces_free().
sn_status sn_fe_faces_of(const sn_fe_space *s, const sn_mesh *mesh, int surface, sn_fe_faces *out);
void sn_fe_faces_free(sn_fe_faces *faces);
/// Nodes of a surface with midsides, each once, rising; sn_alloc'd for the caller.
sn_status sn_fe_surface_nodes(const sn_fe_space *s, const sn_mesh *mesh, int surface, int **nodes,
                              int *count);
/// Prescribed displacements at time t; a midside takes the mean of its ends.
/// @param value  at fixed directions, m; others untouched             (nodes x 3)
void sn_fe_space_prescribed(const sn_fe_space *s, const sn_case *c, double t, double *value);
/// Nodes of a cell of the mesh, with midsides.                     (element.nodes)
void sn_fe_cell_nodes(const sn_fe_space *s, const sn_mesh *mesh, int cell, int *node);
