// Values of one mesh at the material points of another.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

enum { SN_CELL_POINTS = 4 }; // where a cell takes its mean of the other mesh's cells

/// Where the points of a mesh are in another one. A point outside (curved walls of straight cells)
/// belongs to the cell that it is least outside of, and values go on linearly.
typedef struct sn_sampler {
    int points;        ///< nodes of the mesh that takes
    int cells;         ///< its cells
    int *cell;         ///< of the mesh that gives                (points)
    double *weight;    ///< of its nodes                          (points x 4)
    int *source;       ///< cells that it means over              (cells x SN_CELL_POINTS)
    const int *corner; ///< nodes of the cells that give, borrowed
} sn_sampler;

/// @param from  the mesh with the values; must outlive the sampler
/// @param at    the mesh whose nodes and cells are the points
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_sampler_create(const sn_mesh *from, const sn_mesh *at, sn_sampler *sampler);
void sn_sampler_release(sn_sampler *sampler);
/// Vectors on nodes.                                  (nodes x 3) -> (points x 3)
void sn_sample_nodes(const sn_sampler *sampler, const double *value, double *out);
/// Tensors on cells.                                  (cells x 6) -> (cells x 6)
void sn_sample_cells(const sn_sampler *sampler, const double *value, double *out);
