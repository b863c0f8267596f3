// The sparse matrix of the free unknowns: which entries there are, where each cell adds, the
// values. SPDX-License-Identifier: Apache-2.0
//
// A block is a node (three displacements) or a pressure (one unknown). Prescribed unknowns have no
// row and no column. The rows of a block stand together and share their columns, so one number for
// each pair of blocks of a cell, the place of the second among the columns of the first, finds all
// nine entries:
//     entry (A i, B j) = base[A] + local[A][i] * length[A] + offset(A, B) + local[B][j].
//
// On several ranks each holds the rows of its own blocks; rows are numbered rank by rank, those of
// the pressures behind those of the displacements of the rank. `whole` patterns, for solvers that
// want three rows a node, keep a row for every unknown: that of a prescribed one is all zero but
// for its diagonal, which the solver sets.
#pragma once

#include "continuum/space.h"

enum { SN_FE_PRESCRIBED = -1, SN_FE_PINNED = -2 }; ///< unknowns without a row

#define SN_FE_BLOCKS (SN_FE_NODES + 4) ///< most blocks of a cell

typedef struct sn_fe_pattern {
    int blocks;           ///< nodes, then pressures
    int unknowns;         ///< free ones of all ranks
    int total;            ///< rows of all ranks
    int first, rows;      ///< rows of this rank: first, how many
    int pressures;        ///< of these, the first of a pressure, counted from `first`
    int *row;             ///< row of each unknown, or one of the two above  (dofs)
    signed char *local;   ///< place among the rows of its block, -1 where prescribed (blocks x 3)
    signed char *own;     ///< the same, -1 also in blocks of other ranks             (blocks x 3)
    bool whole;           ///< prescribed unknowns have rows
    int held_count;       ///< of these, on this rank
    int *held;            ///< entries on the diagonal of such rows          (held_count)
    int *by_row;          ///< blocks in the order of their rows             (blocks)
    int *order;           ///< place of a block in that                      (blocks)
    int *block_row;       ///< first row of a block                          (blocks)
    int own_from, own_to; ///< places of the blocks of this rank
    int *base;            ///< entry of the block's first row                (blocks)
    int *length;          ///< columns in a row of the block                 (blocks)
    int *near_at;         ///< first neighbour of a block                    (blocks + 1)
    int *near;            ///< neighbours with itself, by their rows         (near_at[blocks])
    int *near_offset;     ///< place of the neighbour among the columns      (near_at[blocks])
    int cell_blocks;      ///< blocks of a cell
    int *offset; ///< offset(A, B) of every place    (batches x cells x cell_blocks x cell_blocks)
    int *row_start; ///< compressed rows                                   (rows + 1)
    int *column;    ///<                                                   (row_start[rows])
} sn_fe_pattern;

sn_status sn_fe_pattern_create(const sn_fe_space *s, bool whole, sn_fe_pattern **pattern);
void sn_fe_pattern_destroy(sn_fe_pattern *pattern); // NULL is allowed
/// offset(A, B) of two blocks that share a cell; 0 where A is of another rank.
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
    double *soft;       ///< Nullable: the pressures' Schur complement, its diagonal (corners)
} sn_fe_matrix;

/// Adds the 3 x 3 block k (row-major) of blocks A and B; entries of unknowns that a pressure block
/// does not have are not read.
static inline void sn_fe_matrix_add(const sn_fe_matrix *m, int A, int B, int offset,
                                    const double k[9]) {
    const sn_fe_pattern *p = m->pattern;
    const signed char *row = p->own + 3 * A, *column = p->local + 3 * B;
    int length = p->length[A];
    double *to = m->value + p->base[A] + offset;
    if ((row[0] | row[1] | row[2]) == 3 && (column[0] | column[1] | column[2]) == 3) {
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
