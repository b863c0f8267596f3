// What the kernels of blocks share: moving between quads and blocks, and memory.
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

/// SN_BLOCK numbers each of x, y and z become quads.
SN_INLINE void block_take(real *to, const real *x, const real *y, const real *z) {
    const quad none = {0, 0, 0, 0};
    for (int i = 0; i < SN_BLOCK; i += 4) {
        quad X = quad_load(x + i), Y = quad_load(y + i), Z = quad_load(z + i);
        quad low = __builtin_shufflevector(X, Y, 0, 4, 1, 5);
        quad high = __builtin_shufflevector(X, Y, 2, 6, 3, 7);
        quad zlow = __builtin_shufflevector(Z, none, 0, 4, 1, 5);
        quad zhigh = __builtin_shufflevector(Z, none, 2, 6, 3, 7);
        quad_store(to + 4 * i, __builtin_shufflevector(low, zlow, 0, 1, 4, 5));
        quad_store(to + 4 * i + 4, __builtin_shufflevector(low, zlow, 2, 3, 6, 7));
        quad_store(to + 4 * i + 8, __builtin_shufflevector(high, zhigh, 0, 1, 4, 5));
        quad_store(to + 4 * i + 12, __builtin_shufflevector(high, zhigh, 2, 3, 6, 7));
    }
}

/// Differences u[to] - u[from] of SN_BLOCK pairs of nodes, as rows x y z of SN_BLOCK.
SN_INLINE void block_difference(const real *u, const int *from, const int *to, real *rows) {
    for (int i = 0; i < SN_BLOCK; i += 4) {
        quad d[4];
        for (int k = 0; k < 4; k++)
            d[k] = quad_load(u + 4 * (size_t)to[i + k]) - quad_load(u + 4 * (size_t)from[i + k]);
        block_put(rows + i, rows + SN_BLOCK + i, rows + 2 * SN_BLOCK + i, d[0], d[1], d[2], d[3]);
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
    const int branches = m->branches;
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
