// Sums at nodes and volume points, and the motion of nodes.
// SPDX-License-Identifier: Apache-2.0
#include "springs/kernels/block.h"

void SN_KERNEL(sn_points)(const sn_point_pass *pass, int block);
void SN_KERNEL(sn_nodes)(const sn_node_pass *pass, int chunk);
void SN_KERNEL(sn_move)(const sn_move_pass *pass, int chunk);
double SN_KERNEL(sn_peak)(long turns, double *out);

void SN_KERNEL(sn_points)(const sn_point_pass *pass, int block) {
    const size_t at = (size_t)block * SN_BLOCK;
    const real *growth = pass->growth, *stiffness = (const real *)pass->stiffness + at;
    real *p = (real *)pass->pressure + at;
    for (size_t i = 0; i < SN_BLOCK; i++) {
        real sum = 0;
        for (int k = pass->start[at + i]; k < pass->start[at + i + 1]; k++)
            sum += growth[pass->item[k]];
        p[i] = stiffness[i] * sum;
    }
    block_memory(&pass->memory, block - pass->first, SN_BLOCK, p);
}

void SN_KERNEL(sn_nodes)(const sn_node_pass *pass, int chunk) {
    const real *weight = pass->weight, *part = pass->part;
    real *force = pass->force;
    const int first = chunk * SN_NODE_CHUNK, last = first + SN_NODE_CHUNK;
    for (int i = first; i < last && i < pass->nodes; i++) {
        const int *start = pass->start + i;
        quad sum = quad_load(weight + 4 * (size_t)i);
        for (int k = start[0]; k < start[1]; k++)
            sum += quad_load(part + 4 * (size_t)pass->item[k]);
        quad_store(force + 4 * (size_t)i, sum);
    }
}

#if SN_REAL_BITS == 64
typedef int64_t quad_int __attribute__((vector_size(4 * sizeof(real))));
#else
typedef int32_t quad_int __attribute__((vector_size(4 * sizeof(real))));
#endif

SN_INLINE quad quad_max(quad a, quad b) {
    quad_int more = (quad_int)(a > b);
    return (quad)((more & (quad_int)a) | (~more & (quad_int)b));
}

void SN_KERNEL(sn_move)(const sn_move_pass *pass, int chunk) {
    const real h = (real)pass->step, kick = (real)pass->kick;
    const real *force = pass->force, *inverse_mass = pass->inverse_mass;
    real *u = pass->u, *v = pass->v;
    quad sum = {0, 0, 0, 0}, most = {0, 0, 0, 0};
    const int first = chunk * SN_NODE_CHUNK, last = first + SN_NODE_CHUNK;
    for (int i = first; i < last && i < pass->nodes; i++) {
        const size_t at = 4 * (size_t)i;
        quad w = quad_load(v + at);
        w += kick * (quad_load(force + at) * quad_load(inverse_mass + at));
        quad w2 = w * w;
        sum += w2;
        most = quad_max(w2, most);
        quad_store(v + at, w);
        quad_store(u + at, quad_load(u + at) + h * w);
    }
    pass->sum[chunk] = (double)((sum[0] + sum[1]) + (sum[2] + sum[3]));
    double largest = 0;
    for (int k = 0; k < 3; k++) largest = (double)most[k] > largest ? (double)most[k] : largest;
    pass->fastest[chunk] = largest;
}

// chains that do not wait for each other; nothing in it can be left out
double SN_KERNEL(sn_peak)(long turns, double *out) {
    enum { CHAINS = 12 };
    wide x[CHAINS];
    const wide a = wide_set((real)(1 - 1e-3)), b = wide_set((real)1e-3);
    for (int k = 0; k < CHAINS; k++) x[k] = wide_set((real)k);
    for (long n = 0; n < turns; n++)
        for (int k = 0; k < CHAINS; k++) x[k] = x[k] * a + b;
    wide sum = x[0];
    for (int k = 1; k < CHAINS; k++) sum = sum + x[k];
    real all[SN_LANES];
    wide_store(all, sum);
    *out = (double)all[0];
    return 2.0 * CHAINS * SN_LANES * (double)turns;
}
