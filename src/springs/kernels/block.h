// What the kernels of tiles share: moving between nodes and blocks, and memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/wide.h"
#include "springs/pass.h"

typedef real quad __attribute__((vector_size(4 * sizeof(real))));

SN_INLINE quad quad_load(const real *from) {
    quad q;
    memcpy(&q, from, sizeof q);
    return q;
}
SN_INLINE void quad_store(real *to, quad q) {
    memcpy(to, &q, sizeof q);
}

/// Four quads become four numbers each of x, y and z.
SN_INLINE void block_put(real *x, real *y, real *z, quad a, quad b, quad c, quad d) {
    quad ab = __builtin_shufflevector(a, b, 0, 4, 1, 5),
         cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    quad az = __builtin_shufflevector(a, b, 2, 6, 3, 7),
         cz = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    quad_store(x, __builtin_shufflevector(ab, cd, 0, 1, 4, 5));
    quad_store(y, __builtin_shufflevector(ab, cd, 2, 3, 6, 7));
    quad_store(z, __builtin_shufflevector(az, cz, 0, 1, 4, 5));
}

//---- nodes of a tile -----------------------------------------------------------------------------

/// Nodes of a tile in the first cache, where displacement and rest position are needed apart: eight
/// numbers each, the displacement, one unused, the rest position and one unused.
typedef struct tile_nodes {
    real at[8 * SN_TILE_NODES];
} tile_nodes;

SN_INLINE void tile_load(const sn_tile *tile, const real *u, tile_nodes *nodes) {
    const real *position = tile->position;
    for (size_t k = 0; k < (size_t)tile->nodes; k++) {
        quad_store(nodes->at + 8 * k, quad_load(u + 4 * (size_t)tile->node[k]));
        quad_store(nodes->at + 8 * k + 4, quad_load(position + 4 * k));
    }
}

/// Nodes of a tile in the first cache, where four numbers each will do.
typedef struct tile_quads {
    real at[4 * SN_TILE_NODES];
} tile_quads;

/// Displacements (or where the nodes are now, if there are rest positions) and pressures.
SN_INLINE void tile_load_quads(const sn_tile *tile, const real *u, const real *position,
                               const real *pressure, tile_quads *nodes) {
    for (size_t k = 0; k < (size_t)tile->nodes; k++) {
        quad q = quad_load(u + 4 * (size_t)tile->node[k]);
        if (position) q += quad_load(position + 4 * k);
        if (pressure) q[3] = pressure[tile->point[k]];
        quad_store(nodes->at + 4 * k, q);
    }
}

/// Where differences go: component c of spoke k of item i to [k * spoke + c * component + i].
typedef struct block_layout {
    int width; ///< items
    int component, spoke;
} block_layout;

#if SN_LANE_BYTES * 8 >= 8 * SN_REAL_BITS
// the eight numbers of a node fit a register

typedef real octo __attribute__((vector_size(8 * sizeof(real))));

SN_INLINE octo octo_load(const real *from) {
    octo q;
    memcpy(&q, from, sizeof q);
    return q;
}
SN_INLINE void octo_store(real *to, octo q) {
    memcpy(to, &q, sizeof q);
}

/// Four nodes become x y z w, of both halves.
SN_INLINE void octo_turn(const octo r[4], octo row[4]) {
    octo low = __builtin_shufflevector(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
    octo high = __builtin_shufflevector(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
    octo low2 = __builtin_shufflevector(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
    octo high2 = __builtin_shufflevector(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
    row[0] = __builtin_shufflevector(low, low2, 0, 1, 8, 9, 4, 5, 12, 13);
    row[1] = __builtin_shufflevector(low, low2, 2, 3, 10, 11, 6, 7, 14, 15);
    row[2] = __builtin_shufflevector(high, high2, 0, 1, 8, 9, 4, 5, 12, 13);
    row[3] = __builtin_shufflevector(high, high2, 2, 3, 10, 11, 6, 7, 14, 15);
}

// Differences of what nodes carry: `spokes` others from the first of every item. block_spokes:
// displacement to `d`, rest position to `D`. block_quads: the first three numbers of quads to `d`,
// the fourth to `fourth` (Nullable; a row of `width` a spoke).

SN_INLINE void block_spokes(const tile_nodes *nodes, const uint16_t *corner, int spokes,
                            block_layout at, real *d, real *D) {
    for (int i = 0; i < at.width; i += 8) {
        octo from[8];
        for (int k = 0; k < 8; k++) from[k] = octo_load(nodes->at + 2 * (size_t)corner[i + k]);
        const uint16_t *to = corner + at.width + i;
        for (int s = 0; s < spokes; s++, to += at.width) {
            octo r[8], one[4], two[4];
            for (int k = 0; k < 8; k++) r[k] = octo_load(nodes->at + 2 * (size_t)to[k]) - from[k];
            octo_turn(r, one);
            octo_turn(r + 4, two);
            for (int k = 0; k < 3; k++) {
                const int row = s * at.spoke + k * at.component + i;
                octo_store(d + row,
                           __builtin_shufflevector(one[k], two[k], 0, 1, 2, 3, 8, 9, 10, 11));
                octo_store(D + row,
                           __builtin_shufflevector(one[k], two[k], 4, 5, 6, 7, 12, 13, 14, 15));
            }
        }
    }
}

// the quads of eight nodes: k and k + 4 share a register
SN_INLINE void octo_pairs(const real *quads, const uint16_t *corner, octo pair[4]) {
    for (int k = 0; k < 4; k++) {
        const quad low = quad_load(quads + corner[k]), high = quad_load(quads + corner[k + 4]);
        pair[k] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
}

SN_INLINE void block_quads(const real *quads, const uint16_t *corner, int spokes, block_layout at,
                           real *d, real *fourth) {
    for (int i = 0; i < at.width; i += 8) {
        octo from[4];
        octo_pairs(quads, corner + i, from);
        for (int s = 0; s < spokes; s++) {
            octo r[4], row[4];
            octo_pairs(quads, corner + (s + 1) * at.width + i, r);
            for (int k = 0; k < 4; k++) r[k] -= from[k];
            octo_turn(r, row);
            for (int k = 0; k < 3; k++) octo_store(d + s * at.spoke + k * at.component + i, row[k]);
            if (fourth) octo_store(fourth + s * at.width + i, row[3]);
        }
    }
}
#else
SN_INLINE void block_spokes(const tile_nodes *nodes, const uint16_t *corner, int spokes,
                            block_layout at, real *d, real *D) {
    for (int half = 0; half < 2; half++) {
        const real *from = nodes->at + 4 * half;
        for (int s = 0; s < spokes; s++)
            for (int i = 0; i < at.width; i += 4) {
                const uint16_t *to = corner + (s + 1) * at.width + i;
                real *row = (half ? D : d) + s * at.spoke + i;
                quad r[4];
                for (int k = 0; k < 4; k++)
                    r[k] = quad_load(from + 2 * (size_t)to[k]) -
                           quad_load(from + 2 * (size_t)corner[i + k]);
                block_put(row, row + at.component, row + 2 * at.component, r[0], r[1], r[2], r[3]);
            }
    }
}

SN_INLINE void block_quads(const real *quads, const uint16_t *corner, int spokes, block_layout at,
                           real *d, real *fourth) {
    for (int s = 0; s < spokes; s++)
        for (int i = 0; i < at.width; i += 4) {
            const uint16_t *to = corner + (s + 1) * at.width + i;
            real *row = d + s * at.spoke + i;
            quad r[4];
            for (int k = 0; k < 4; k++)
                r[k] = quad_load(quads + to[k]) - quad_load(quads + corner[i + k]);
            block_put(row, row + at.component, row + 2 * at.component, r[0], r[1], r[2], r[3]);
            if (fourth)
                quad_store(fourth + s * at.width + i, (quad){r[0][3], r[1][3], r[2][3], r[3][3]});
        }
}
#endif

/// The fourth number of the quads of `width` nodes.
SN_INLINE void block_fourth(const real *quads, const uint16_t *corner, int width, real *fourth) {
    for (int i = 0; i < width; i++) fourth[i] = quads[corner[i] + 3];
}

/// Four numbers each of x, y, z and w become quads.
SN_INLINE void quad_turn(quad X, quad Y, quad Z, quad W, quad q[4]) {
    quad low = __builtin_shufflevector(X, Y, 0, 4, 1, 5);
    quad high = __builtin_shufflevector(X, Y, 2, 6, 3, 7);
    quad zlow = __builtin_shufflevector(Z, W, 0, 4, 1, 5);
    quad zhigh = __builtin_shufflevector(Z, W, 2, 6, 3, 7);
    q[0] = __builtin_shufflevector(low, zlow, 0, 1, 4, 5);
    q[1] = __builtin_shufflevector(low, zlow, 2, 3, 6, 7);
    q[2] = __builtin_shufflevector(high, zhigh, 0, 1, 4, 5);
    q[3] = __builtin_shufflevector(high, zhigh, 2, 3, 6, 7);
}

/// Four numbers each of x, y and z become quads.
SN_INLINE void block_take(const real *x, const real *y, const real *z, quad q[4]) {
    quad_turn(quad_load(x), quad_load(y), quad_load(z), (quad){0, 0, 0, 0}, q);
}

/// Adds quads to the force of nodes of the tile, one after the other.
SN_INLINE void tile_add(real *force, const uint16_t *corner, const quad q[4]) {
    for (int k = 0; k < 4; k++) {
        real *to = force + corner[k];
        quad_store(to, quad_load(to) + q[k]);
    }
}
SN_INLINE void tile_subtract(real *force, const uint16_t *corner, const quad q[4]) {
    for (int k = 0; k < 4; k++) {
        real *to = force + corner[k];
        quad_store(to, quad_load(to) - q[k]);
    }
}

/// Asks for memory that will be needed soon: what a processor foresees ends at every page.
SN_INLINE void block_ask(const void *from, size_t bytes) {
    for (size_t k = 0; k < bytes; k += 64) __builtin_prefetch((const char *)from + k);
}

/// Asks for the memory of n numbers of a block.
SN_INLINE void block_ask_memory(const sn_memory_pass *m, int block, int n) {
    if (m->mode != SN_MEMORY_ADVANCE) return;
    const size_t count = (size_t)(1 + m->branches) * (size_t)n;
    block_ask((const real *)m->store + (size_t)block * count, count * sizeof(real));
}

/// One step of the recursion.
SN_INLINE void block_advance(const sn_memory_pass *m, int block, int n, int branches, real *T) {
    real *before = (real *)m->store + (size_t)block * (size_t)(1 + branches) * (size_t)n;
    const real g_inf = (real)m->g_inf;
    real decay[SN_BRANCHES_MAX], gain[SN_BRANCHES_MAX];
    for (int k = 0; k < branches; k++) {
        decay[k] = (real)m->decay[k];
        gain[k] = (real)m->gain[k];
    }
    for (int i = 0; i < n; i += SN_LANES) {
        wide t = wide_load(T + i), d = t - wide_load(before + i), sum = g_inf * t;
        wide_store(before + i, t);
        real *branch = before + n + i;
        for (int k = 0; k < branches; k++, branch += n) {
            wide h = decay[k] * wide_load(branch) + gain[k] * d;
            wide_store(branch, h);
            sum = sum + h;
        }
        wide_store(T + i, sum);
    }
}

/// Passes n numbers of block `block` through the memory (equations 33 to 35 with 32: exact for a
/// stress that is linear in time within the step).
SN_INLINE void block_memory(const sn_memory_pass *m, int block, int n, real *T) {
    if (m->mode == SN_MEMORY_OFF) return;
    if (m->mode == SN_MEMORY_TRIAL) {
        const real *history = (const real *)m->history + (size_t)block * (size_t)n;
        const real alpha = (real)m->alpha;
        for (int i = 0; i < n; i += SN_LANES)
            wide_store(T + i, alpha * wide_load(T + i) + wide_load(history + i));
        return;
    }
    switch (m->branches) { // a known number lets the compiler unroll
    case 1: block_advance(m, block, n, 1, T); break;
    case 2: block_advance(m, block, n, 2, T); break;
    case 3: block_advance(m, block, n, 3, T); break;
    case 4: block_advance(m, block, n, 4, T); break;
    default: block_advance(m, block, n, m->branches, T);
    }
}
