// Sums at nodes and volume points, and the motion of nodes.
// SPDX-License-Identifier: Apache-2.0
#include "springs/kernels/block.h"

void SN_KERNEL(sn_points)(const sn_point_pass *pass);
void SN_KERNEL(sn_nodes)(const sn_node_pass *pass);
void SN_KERNEL(sn_move)(sn_move_pass *pass);

void SN_KERNEL(sn_points)(const sn_point_pass *pass) {
    const real *growth = pass->growth;
    for (int b = 0; b < pass->blocks; b++) {
        const size_t at = (size_t)b * SN_BLOCK;
        real *p = (real *)pass->pressure + at;
        const real *stiffness = (const real *)pass->stiffness + at;
        for (int i = 0; i < SN_BLOCK; i++) {
            const int end = pass->start[at + (size_t)i + 1];
            int k = pass->start[at + (size_t)i];
            quad sum = {0, 0, 0, 0}; // four sums do not wait for each other
            for (; k + 4 <= end; k += 4) {
                const int *item = pass->item + k;
                sum += (quad){growth[item[0]], growth[item[1]], growth[item[2]], growth[item[3]]};
            }
            for (; k < end; k++) sum[0] += growth[pass->item[k]];
            p[i] = stiffness[i] * ((sum[0] + sum[1]) + (sum[2] + sum[3]));
        }
        block_memory(&pass->memory, b, SN_BLOCK, p);
    }
}

// sum of the quads from[item[first]] … from[item[end - 1]], two at a time
SN_INLINE quad gather_sum(const real *from, const int *item, int first, int end) {
    quad even = {0, 0, 0, 0}, odd = {0, 0, 0, 0};
    int k = first;
    for (; k + 2 <= end; k += 2) {
        even += quad_load(from + 4 * (size_t)item[k]);
        odd += quad_load(from + 4 * (size_t)item[k + 1]);
    }
    if (k < end) even += quad_load(from + 4 * (size_t)item[k]);
    return even + odd;
}

void SN_KERNEL(sn_nodes)(const sn_node_pass *pass) {
    const real *weight = pass->weight;
    real *force = pass->force;
    for (int i = 0; i < pass->nodes; i++) {
        const int *start = pass->start + 3 * (size_t)i;
        quad sum = quad_load(weight + 4 * (size_t)i);
        sum += gather_sum(pass->spring_force, pass->item, start[0], start[1]);
        sum -= gather_sum(pass->spring_force, pass->item, start[1], start[2]);
        sum += gather_sum(pass->cell_force, pass->item, start[2], start[3]);
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

void SN_KERNEL(sn_move)(sn_move_pass *pass) {
    const real h = (real)pass->step, kick = (real)pass->kick;
    const real *force = pass->force, *inverse_mass = pass->inverse_mass;
    real *u = pass->u, *v = pass->v;
    quad sum = {0, 0, 0, 0}, most = {0, 0, 0, 0};
    for (int i = 0; i < pass->nodes; i++) {
        const size_t at = 4 * (size_t)i;
        quad w = quad_load(v + at);
        w += kick * (quad_load(force + at) * quad_load(inverse_mass + at));
        quad w2 = w * w;
        sum += w2;
        most = quad_max(w2, most);
        quad_store(v + at, w);
        quad_store(u + at, quad_load(u + at) + h * w);
    }
    pass->sum = (double)((sum[0] + sum[1]) + (sum[2] + sum[3]));
    double largest = 0;
    for (int k = 0; k < 3; k++) largest = (double)most[k] > largest ? (double)most[k] : largest;
    pass->fastest = sqrt(3 * largest);
}
