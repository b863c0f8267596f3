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
// Calibrated springs have x (exp(C x^2) - 1) more, C = D.C D / L^2 in tension and one number in
// compression. The force on end 0 is k t_visc / lambda (D + d).
#include "springs/kernels/block.h"

void SN_KERNEL(sn_springs)(const sn_spring_pass *pass, const sn_tile *tile);

enum { STARS = SN_BLOCK / SN_STAR };

typedef struct spring_block {
    real d[3 * SN_BLOCK]; // difference of displacements
    real D[3 * SN_BLOCK]; // of rest positions
    real t[SN_BLOCK];
    real over[SN_BLOCK]; // 1 / lambda
} spring_block;

// x = lambda - 1 and 1 / lambda of the springs of a block; returns the largest x
SN_INLINE real stretch(spring_block *s) {
    const real least = (real)1e-6; // of lambda^2: a spring turned to a point stays finite
    wide most = wide_set(0);
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide dx = wide_load(s->d + i), dy = wide_load(s->d + SN_BLOCK + i);
        wide dz = wide_load(s->d + 2 * SN_BLOCK + i);
        wide Dx = wide_load(s->D + i), Dy = wide_load(s->D + SN_BLOCK + i);
        wide Dz = wide_load(s->D + 2 * SN_BLOCK + i);
        wide e = ((Dx + Dx + dx) * dx + (Dy + Dy + dy) * dy + (Dz + Dz + dz) * dz) /
                 (Dx * Dx + Dy * Dy + Dz * Dz);
        e = wide_max(e, wide_set(least - 1));
        wide lambda = wide_sqrt(1 + e);
        wide one = 1 + lambda, inverse = 1 / (lambda * one); // of both divisions
        wide x = e * lambda * inverse;
        most = wide_max(x, most);
        wide_store(s->t + i, x);
        wide_store(s->over + i, one * inverse);
    }
    real lane[SN_LANES], largest = 0;
    wide_store(lane, most);
    for (int k = 0; k < SN_LANES; k++) largest = lane[k] > largest ? lane[k] : largest;
    return largest;
}

// what calibrated springs have more: C and c of the law
SN_INLINE wide square_part(const double *square, const spring_block *s, int i, wide x) {
    wide Dx = wide_load(s->D + i), Dy = wide_load(s->D + SN_BLOCK + i);
    wide Dz = wide_load(s->D + 2 * SN_BLOCK + i);
    real q[SN_SPRING_SQUARES];
    for (int k = 0; k < SN_SPRING_SQUARES; k++) q[k] = (real)square[k];
    wide C = q[0] * Dx * Dx + q[1] * Dy * Dy + q[2] * Dz * Dz +
             2 * (q[3] * Dx * Dy + q[4] * Dy * Dz + q[5] * Dz * Dx);
    C = wide_select(wide_less(x, wide_set(0)), wide_set(q[6]), C / (Dx * Dx + Dy * Dy + Dz * Dz));
    return x * wide_expm1(wide_min(C * x * x, wide_set((real)SN_SPRING_STEEPEST)));
}

/// How (exp(B x) - 1) / B is found in a block: the bits are the same wherever two ways would do.
typedef enum spring_curve { CURVE_NONE, CURVE_NEAR, CURVE_FAR } spring_curve;

SN_INLINE void pull_or_push(real B, real over_B, spring_curve curve, const double *square,
                            spring_block *s) {
    const real third = (real)(1.0 / 3.0);
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide x = wide_load(s->t + i), over = wide_load(s->over + i);
        wide stretched = wide_max(x, wide_set(0)), y = B * stretched;
        wide pull = curve == CURVE_NONE   ? stretched
                    : curve == CURVE_NEAR ? wide_expm1_near(y) * over_B
                                          : wide_expm1(y) * over_B;
        wide push = x * (1 + x * (1 + third * x)) * (over * over);
        wide t = wide_select(wide_less(x, wide_set(0)), push, pull);
        if (square) t = t + square_part(square, s, i, x);
        wide_store(s->t + i, t);
    }
}

SN_INLINE void tension(const sn_spring_pass *pass, spring_block *s) {
    const real B = (real)pass->exponent, most = (real)fabs(pass->exponent) * stretch(s);
    if (!(fabs(pass->exponent) > 1e-20))
        pull_or_push(B, 0, CURVE_NONE, pass->square, s);
    else if (most < (real)SN_EXPM1_NEAR)
        pull_or_push(B, (real)(1.0 / pass->exponent), CURVE_NEAR, pass->square, s);
    else
        pull_or_push(B, (real)(1.0 / pass->exponent), CURVE_FAR, pass->square, s);
}

SN_INLINE void take(const real *rows, const uint16_t *corner, bool away, real *force) {
    for (int i = 0; i < STARS; i += 4) {
        quad q[4];
        block_take(rows + i, rows + SN_BLOCK + i, rows + 2 * SN_BLOCK + i, q);
        if (away)
            tile_subtract(force, corner + i, q);
        else
            tile_add(force, corner + i, q);
    }
}

// forces of a block on the nodes of the tile
SN_INLINE void pull(const real *stiffness, const uint16_t *corner, spring_block *s, real *force) {
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide f = wide_load(stiffness + i) * wide_load(s->t + i) * wide_load(s->over + i);
        for (int c = 0; c < 3; c++) {
            int at = c * SN_BLOCK + i;
            wide_store(s->d + at, f * (wide_load(s->D + at) + wide_load(s->d + at)));
        }
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < STARS; i += SN_LANES) {
            wide sum = wide_load(s->d + c * SN_BLOCK + i);
            for (int n = 1; n < SN_STAR; n++)
                sum = sum + wide_load(s->d + c * SN_BLOCK + n * STARS + i);
            wide_store(s->D + c * SN_BLOCK + i, sum); // no longer needed
        }
    take(s->D, corner, false, force);
    for (int n = 0; n < SN_STAR; n++) take(s->d + n * STARS, corner + (1 + n) * STARS, true, force);
}

void SN_KERNEL(sn_springs)(const sn_spring_pass *pass, const sn_tile *tile) {
    const block_layout layout = {.width = STARS, .component = SN_BLOCK, .spoke = STARS};
    tile_nodes nodes;
    spring_block s;
    tile_load(tile, pass->u, &nodes);
    memset(tile->force, 0, (size_t)tile->nodes * sizeof(quad));
    for (int b = 0; b < tile->blocks; b++) {
        const uint16_t *corner = tile->corner + (1 + SN_STAR) * STARS * b;
        const int block = tile->block + b;
        if (b + 1 < tile->blocks) {
            block_ask_memory(&pass->memory, block + 1 - pass->first, SN_BLOCK);
            block_ask((const real *)pass->stiffness + (size_t)(block + 1) * SN_BLOCK,
                      SN_BLOCK * sizeof(real));
        }
        block_spokes(&nodes, corner, SN_STAR, layout, s.d, s.D);
        tension(pass, &s);
        block_memory(&pass->memory, block - pass->first, SN_BLOCK, s.t);
        pull((const real *)pass->stiffness + (size_t)block * SN_BLOCK, corner, &s, tile->force);
    }
}
