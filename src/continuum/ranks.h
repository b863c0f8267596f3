// The ranks of MPI that share one body: who owns which cells and nodes, and what is exchanged.
// SPDX-License-Identifier: Apache-2.0
//
// Every rank reads the whole case and holds the vectors over all unknowns (displacements, forces),
// which are small beside what is shared out: cells with their memory, rows of the matrix, factors,
// Krylov vectors. Cells are parted by DMPlex (PT-Scotch where PETSc has it), a node belongs to the
// lowest rank among its cells, and a rank works on all cells that touch a node of its own, so that
// the rows of its nodes are complete without an exchange: a layer of cells between two ranks is
// worked on twice. What a cell adds to a node is added in the order of the cells of the mesh, as on
// one rank: forces and matrix are the same to the last bit for every number of ranks, and only the
// sums of the linear solver differ.
//
// After forces are formed, every rank hands the values of its own nodes to all others
// (sn_fe_gather_…). From then on all ranks hold the same bits and take the same decisions: norms,
// line search, lengths of steps, contact and probes are worked out by each for itself.
//
// See docs/design/ranks.md for what was rejected.
#pragma once

#include "sinew/model.h"

typedef struct sn_fe_space sn_fe_space;

typedef struct sn_fe_ranks {
    int rank, count;  ///< this one, all; what follows is NULL where there is only one
    bool *near;       ///< cells that touch an own node                          (cells)
    int *cell_owner;  ///< rank of each cell                                     (cells)
    int *cell_list;   ///< cells by rank, rising within                          (cells)
    int *cell_start;  ///< first of a rank                                       (count + 1)
    int *node_owner;  ///< rank of each node                                     (nodes)
    int *node_list;   ///< nodes by rank, rising within: corners first           (nodes)
    int *node_start;  ///< first of a rank                                       (count + 1)
    int *corners;     ///< how many of them are corners                          (count)
    int *size, *from; ///< of the parts of an exchange                          (count)
    double *packed;   ///< what goes out and comes in                           (largest vector)
} sn_fe_ranks;

/// Starts MPI and parts the cells and nodes of a space that has its nodes and edges.
/// @return SN_OK, SN_E_DEFINITION (more ranks than cells), SN_E_SOLVER, SN_E_MEMORY.
sn_status sn_fe_ranks_create(const sn_mesh *mesh, const sn_fe_space *s, sn_fe_ranks **ranks);
void sn_fe_ranks_destroy(sn_fe_ranks *ranks); // NULL is allowed

/// Whether this rank works on a cell of the mesh, and whether it is the one that owns it.
static inline bool sn_fe_cell_is_near(const sn_fe_ranks *r, int cell) {
    return !r->near || r->near[cell];
}
static inline bool sn_fe_cell_is_own(const sn_fe_ranks *r, int cell) {
    return !r->cell_owner || r->cell_owner[cell] == r->rank;
}
static inline bool sn_fe_node_is_own(const sn_fe_ranks *r, int node) {
    return !r->node_owner || r->node_owner[node] == r->rank;
}

/// Every rank gets the values of all: what counts on entry are the values of own nodes.
/// @param v  (nodes x 3), (corners) or all unknowns (dofs)
void sn_fe_gather_nodes(const sn_fe_space *s, double *v);
void sn_fe_gather_corners(const sn_fe_space *s, double *v);
void sn_fe_gather_unknowns(const sn_fe_space *s, double *v);
/// The same for all unknowns, and the smallest `number` of all ranks in the same exchange.
void sn_fe_gather_least(const sn_fe_space *s, double *v, int *number);
/// The first rank gets the values of all cells, `width` each: what counts on entry are own cells.
void sn_fe_gather_cells(const sn_fe_ranks *r, int width, double *v);
/// The same for rows of different length. @param part  values of the own cells in the order of
/// cell_list, replaced on the first rank by those of all; room there for `total`
/// @param length  values of each rank                                          (count)
void sn_fe_gather_parts(const sn_fe_ranks *r, const size_t *length, double *part);
/// The sum over all ranks, the largest of all, whether it holds on all.
double sn_fe_sum(const sn_fe_ranks *r, double value);
double sn_fe_largest(const sn_fe_ranks *r, double value);
bool sn_fe_all(const sn_fe_ranks *r, bool holds);
/// The value of the first rank that has `holds`, on all.
void sn_fe_from_holder(const sn_fe_ranks *r, bool holds, double *value);
/// The number of the first rank, on all.
int sn_fe_from_first(const sn_fe_ranks *r, int value);
/// The status of all ranks at the end of a run, where one may have failed alone, with the others
/// waiting for it: it does not wait for them longer than a few seconds, and is lost then: see
/// sn_ranks_lost().
sn_status sn_fe_settle(sn_status status);
/// The status of all ranks: where one has failed all return its status, with its text.
sn_status sn_fe_agree(const sn_fe_ranks *r, sn_status status);
