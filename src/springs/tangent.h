// The inside of the tangent, for the files that assemble it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/forces.h"

/// A sparse matrix of blocks by rows; columns rise within a row.
typedef struct sn_sparsity {
    int rows;
    int *start;  ///< (rows + 1)
    int *column; ///< (start[rows])
} sn_sparsity;

struct sn_tangent {
    sn_sparsity cells;  // nodes by nodes
    double *block;      // 3 x 3 blocks
    sn_sparsity points; // volume points by nodes
    double *flux;       // b: 3 numbers an entry
    double *stiffness;  // alpha K / V of each point
    double *inverse;    // of the diagonal blocks
    double *along;      // scratch of the points
    int lowered;        // vectors taken off
    const double *lower;
    double lower_factor;
    const int *piece; // Nullable
    int pieces;
    double *piece_sum;          // (nodes / 4 + 1)
    bool rubs;                  // friction may make it unsymmetric
    bool unsymmetric;           // it has
    double *r, *z, *p, *q;      // scratch of the solvers
    double *shadow, *y, *v;     // of the unsymmetric one, where friction may be
    struct sn_cluster *cluster; // scratch of the smoothed edges
};

/// Place of an entry that is there.
static inline int sn_sparsity_find(const sn_sparsity *p, int row, int column) {
    int low = p->start[row], high = p->start[row + 1] - 1;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (p->column[middle] < column)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/// rows of d(e)/d(u_a), e = (E_xx, E_yy, E_zz, 2 E_xy, 2 E_yz, 2 E_zx)
static inline void sn_strain_rows(const double F[9], const double g[3], double B[6][3]) {
    for (int c = 0; c < 3; c++) {
        const double *f = F + 3 * c;
        for (int k = 0; k < 3; k++) {
            int l = (k + 1) % 3;
            B[k][c] = f[k] * g[k];
            B[3 + k][c] = f[k] * g[l] + f[l] * g[k];
        }
    }
}

/// How the stress at the end of a step follows from its instantaneous value T: alpha T + history.
typedef struct sn_tangent_memory {
    double alpha;
    const double *history; ///< Nullable: there is none
} sn_tangent_memory;
/// Of one kind of item; the history starts at its first number.
sn_tangent_memory sn_tangent_memory_of(const sn_net *net, const sn_net_region *region,
                                       const sn_tangent_call *call, int store);
/// Number `at` of the stress with memory.
static inline double sn_tangent_stress(const sn_tangent_memory *m, size_t at, double T) {
    return m->history ? m->alpha * T + m->history[at] : T;
}

/// What of a region's stress is where a solid law is, and how each part remembers.
typedef struct sn_tangent_law {
    int first, splits;                      ///< of region->split
    sn_tangent_memory memory[2];            ///< by split
    sn_tangent_memory volume;               ///< K (J - 1) where the law is
    size_t components[2];                   ///< numbers of a place in the history, by split
    size_t volume_components, volume_first; ///< the same, and which of them the volume is
} sn_tangent_law;
void sn_tangent_law_of(const sn_net *net, const sn_net_region *region, const sn_tangent_call *call,
                       sn_tangent_law *law);
/// K (J - 1) = p at place n of the region, as it acts now.
static inline double sn_tangent_pressure(const sn_tangent_law *law, size_t n, double p) {
    const size_t block = n / SN_BLOCK * law->volume_components + law->volume_first;
    return sn_tangent_stress(&law->volume, block * SN_BLOCK + n % SN_BLOCK, p);
}
/// S and D of count places of the region from `slot` on, within a block, as they act now.
/// S: (6 x count), D: (21 x count).
void sn_tangent_law_at(const sn_net *net, const sn_net_region *region, const sn_tangent_law *law,
                       int slot, int count, const double *E, double *S, double *D);

//---- smoothed edges (springs/tangent_edges.c) ----------------------------------------------------

/// Scratch, and the pattern of nodes that share an edge's cells.
sn_status sn_tangent_create_edges(const sn_net *net, sn_tangent *tangent);
void sn_tangent_destroy_edges(sn_tangent *tangent);
/// Adds the law, and without nodal volume the volume stress, at the edges of a region.
void sn_tangent_add_edges(const sn_net *net, sn_tangent *tangent, const sn_net_region *region,
                          const sn_tangent_law *law, const sn_tangent_call *call);
