// The memory of the tissues in an order that does not depend on the number of ranks.
// SPDX-License-Identifier: Apache-2.0
//
// A saved state holds the memory as one rank keeps it: batches of all cells, filled up by repeating
// the last cell of a region. So a run may go on with another number of ranks.
#pragma once

#include "continuum/problem.h"

typedef struct sn_fe_shelf {
    const sn_fe_problem *problem;
    size_t total;  ///< numbers of the memory of the whole body
    size_t *start; ///< first number of a region                     (regions)
    int *cells;    ///< of a region                                  (regions)
    int *place;    ///< of each cell among those of its region       (cells)
    double *all;   ///< the memory of the whole body                 (total)
} sn_fe_shelf;

/// @param room  whether `all` is needed on this rank
sn_status sn_fe_shelf_init(const sn_fe_problem *p, bool room, sn_fe_shelf *shelf);
void sn_fe_shelf_free(sn_fe_shelf *shelf);
/// Gathers the memory of all ranks in `all` on the first. Every rank calls it.
sn_status sn_fe_shelf_fill(sn_fe_shelf *shelf);
/// Takes the memory of this rank's cells out of `all`.
void sn_fe_shelf_take(const sn_fe_shelf *shelf);
