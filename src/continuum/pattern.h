// The sparse matrix of the free unknowns: which entries there are, where each cell adds, the
// values. SPDX-License-Identifier: Apache-2.0
//
// A block is a node (three displacements) or a pressure (one unknown). Prescribed unknowns have no
// row and no column. The rows of a block stand together and share their columns, so one number for
// each pair of blocks of a cell, the place of the second among the columns of the first, finds all
// nine entries:
//     entry (A i, B j) = base[A] + local[A][i] * length[A] + offset(A, B) + local[B][j].
#pragma once

#include "continuum/space.h"

enum { SN_FE_PRESCRIBED = -1, SN_FE_PINNED = -2 }; ///< unknowns without a row

#define SN_FE_BLOCKS (SN_FE_NODES + 4) ///< most blocks of a cell

typedef struct sn_fe_pattern {
    int blocks;         ///< nodes, then pressures
    int rows;           ///< free unknowns
    int *row;           ///< row of each unknown, or one of the two below  (dofs)
    signed char *local; ///< place among the free ones of its block, or -1 (blocks x 3)
    int *base;          ///< entry of the block's first row                (blocks)
    int *length;        ///< columns in a row of the block                 (blocks)
    int *near_at;       ///< first neighbour of a block                    (blocks + 1)
    int *near;          ///< neighbours with itself, rising                (near_at[blocks])
    int *near_offset;   ///< place of the neighbour among the columns      (near_at[blocks])
    int cell_blocks;    ///< blocks of a cell
    int *offset; ///< offset(A, B) of every place    (batches x cells x cell_blocks x cell_blocks)
    int *row_start; ///< compressed rows                                   (rows + 1)
    int *column;    ///<                                                   (row_start[rows])
} sn_fe_pattern;

sn_status sn_fe_pattern_create(const sn_fe_space *s, sn_fe_pattern **pattern);
void sn_fe_pattern_destroy(sn_fe_pattern *pattern); // NULL is allowed
/// offset(A, B) of two blocks that share a cell.
int sn_fe_pattern_offset(const sn_fe_pattern *p, int A, int B);
/// The b-th block of the cell at a place of a batch.
static inline int sn_fe_cell_block(const sn_fe_space *s, int batch, int at, int b) {
    const int *node = s->node + (size_t)batch * (size_t)(s->element.nodes * s->batch_cells) + at;
    return b < s->element.nodes ? node[b * s->batch_cells]
                                : s->nodes + node[(b - s->element.nodes) * s->batch_cells];
}

/// The values of the matrix while it is assembled. With `lift` set, the columns of prescribed
/// unknowns are not lost: their product with `lift` is added to `lifted`.
typedef struct sn_fe_matrix {
    const sn_fe_pattern *pattern;
    const sn_fe_space *space;
    double *value;      ///< (row_start[rows])
    const double *lift; ///< Nullable: increments of the unknowns (dofs), zero where free
    double *lifted;     ///< (dofs)
} sn_fe_matrix;

/// Adds the 3 x 3 block k (row-major) of blocks A and B; entries of unknowns that a pressure block
/// does not have are not read.
static inline void sn_fe_matrix_add(const sn_fe_matrix *m, int A, int B, int offset,
                                    const double k[9]) {
    const sn_fe_pattern *p = m->pattern;
    const signed char *row = p->local + 3 * A, *column = p->local + 3 * B;
    int length = p->length[A];
    double *to = m->value + p->base[A] + offset;
    if (row[2] == 2 && column[2] == 2) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) to[i * length + j] += k[3 * i + j];
        return;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3 && row[i] >= 0; j++)
            if (column[j] >= 0) to[row[i] * length + column[j]] += k[3 * i + j];
    if (!m->lift || B >= m->space->nodes) return;
    int from = sn_fe_block_dof(m->space, A), by = sn_fe_block_dof(m->space, B);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3 && row[i] >= 0; j++)
            if (column[j] < 0) m->lifted[from + i] += k[3 * i + j] * m->lift[by + j];
}
