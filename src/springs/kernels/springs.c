// Forces of springs with a nonlinear law and memory.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (14) in tension; memory by equations (33)-(35) in one dimension.
//
// With D the rest vector of the spring, d what its ends moved apart and L its rest length,
//     e = (2 D.d + d.d) / L^2 = lambda^2 - 1,   x = lambda - 1 = e / (1 + lambda)
// lose no digits at small strain, which single precision could not spare. Force over stiffness and
// rest length, with slope 1 at rest:
//     t = (exp(B x) - 1) / B                 in tension
//     t = (lambda - 1/lambda^2) / 3          in compression: no spring collapses
// and the force on end 0 is k t_visc / lambda (D + d).
#include "springs/kernels/block.h"

void SN_KERNEL(sn_springs)(const sn_spring_pass *pass);

typedef struct spring_block {
    real d[3 * SN_BLOCK]; // difference of displacements, then the force
    real t[SN_BLOCK];
    real over[SN_BLOCK]; // 1 / lambda
} spring_block;

SN_INLINE void tension(const sn_spring_pass *pass, const real *D, const real *inverse,
                       spring_block *s) {
    const real B = (real)pass->exponent, third = (real)(1.0 / 3.0);
    const real least = (real)1e-6; // of lambda^2: a spring turned to a point stays finite
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide dx = wide_load(s->d + i), dy = wide_load(s->d + SN_BLOCK + i);
        wide dz = wide_load(s->d + 2 * SN_BLOCK + i);
        wide Dx = wide_load(D + i), Dy = wide_load(D + SN_BLOCK + i);
        wide Dz = wide_load(D + 2 * SN_BLOCK + i);
        wide e = ((Dx + Dx + dx) * dx + (Dy + Dy + dy) * dy + (Dz + Dz + dz) * dz) *
                 wide_load(inverse + i);
        e = wide_max(e, wide_set(least - 1));
        wide lambda = wide_sqrt(1 + e);
        wide over = 1 / lambda;
        wide x = e / (1 + lambda);
        wide pull = wide_phi1(B * wide_max(x, wide_set(0))) * x;
        wide push = x * (1 + x * (1 + third * x)) * (over * over);
        wide_store(s->t + i, wide_select(wide_less(x, wide_set(0)), push, pull));
        wide_store(s->over + i, over);
    }
}

void SN_KERNEL(sn_springs)(const sn_spring_pass *pass) {
    spring_block s;
    for (int b = 0; b < pass->blocks; b++) {
        const size_t at = (size_t)b * SN_BLOCK;
        const int *end = pass->end + 2 * at;
        const real *D = (const real *)pass->edge + 3 * at;
        const real *stiffness = (const real *)pass->stiffness + at;
        block_difference(pass->u, end, end + SN_BLOCK, s.d);
        tension(pass, D, (const real *)pass->inverse + at, &s);
        block_memory(&pass->memory, b, SN_BLOCK, s.t);
        for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
            wide f = wide_load(stiffness + i) * wide_load(s.t + i) * wide_load(s.over + i);
            for (int c = 0; c < 3; c++) {
                int at_c = c * SN_BLOCK + i;
                wide_store(s.d + at_c, f * (wide_load(D + at_c) + wide_load(s.d + at_c)));
            }
        }
        block_take((real *)pass->force + 4 * at, s.d, s.d + SN_BLOCK, s.d + 2 * SN_BLOCK);
    }
}
