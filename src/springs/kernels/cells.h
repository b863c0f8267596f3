// What kernels of cells and of smoothed edges share: deformation, strain, stress, forces.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (16); memory by equations (33)-(35) on the second Piola-Kirchhoff stress.
//
// With g_a the gradients of the shape functions in material axes, H = sum u_a g_a and Q the
// rotation to material axes,
//     F = Q^T + H,  M = Q H,  E = (M + M^T + M^T M)/2,  J - 1 = tr M + minors of M + det M
// so that small strains lose no digits. Where Q differs from item to item the axes are those of
// space, and the law alone is turned: see springs/turned.c. Stresses S (law) and p (volume) give
// the nodal forces
//     f_a = -V (F S + p cof F) g_a,   f_0 = -(f_1 + f_2 + f_3).
#pragma once

#include "springs/kernels/block.h"

typedef struct cell_block {
    real H[9 * SN_BLOCK]; // displacement gradient; before that differences of displacements
    real E[6 * SN_BLOCK];
    real T[7 * SN_BLOCK];  // stress: six components of S, then p
    real f[12 * SN_BLOCK]; // forces on the corners
} cell_block;

static const block_layout layout = {
    .width = SN_BLOCK, .component = SN_BLOCK, .spoke = 3 * SN_BLOCK};

SN_INLINE void load9(const real *from, int i, wide x[9]) {
    for (int k = 0; k < 9; k++) x[k] = wide_load(from + k * SN_BLOCK + i);
}

// mean of the pressure of the corners; difference: of corners 1 2 3 from corner 0
SN_INLINE void mean_pressure(const tile_quads *nodes, const uint16_t *corner,
                             const real *difference, real *p) {
    const real quarter = (real)0.25;
    block_fourth(nodes->at, corner, SN_BLOCK, p);
    for (int i = 0; i < SN_BLOCK; i += SN_LANES)
        wide_store(p + i, wide_load(p + i) + quarter * (wide_load(difference + i) +
                                                        wide_load(difference + SN_BLOCK + i) +
                                                        wide_load(difference + 2 * SN_BLOCK + i)));
}

// H = sum over corners 1 2 3 of (u_a - u_0) g_a; nodal: p too
SN_INLINE void displacement_gradient(const sn_cell_pass *pass, const tile_quads *nodes,
                                     const uint16_t *corner, size_t at, bool nodal, cell_block *c) {
    const real *gradient = (const real *)pass->gradient + 9 * at;
    block_quads(nodes->at, corner, 3, layout, c->H, nodal ? c->f : NULL);
    if (nodal) mean_pressure(nodes, corner, c->f, c->T + 6 * SN_BLOCK);
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide d[9], g[9];
        load9(c->H, i, d);
        load9(gradient, i, g);
        for (int r = 0; r < 3; r++)
            for (int s = 0; s < 3; s++)
                wide_store(c->H + (3 * r + s) * SN_BLOCK + i,
                           d[r] * g[s] + d[3 + r] * g[3 + s] + d[6 + r] * g[6 + s]);
    }
}

// M = Q H, or H itself
SN_INLINE void to_axes(const sn_cell_pass *pass, const wide H[9], wide M[9]) {
    if (!pass->rotated) {
        for (int k = 0; k < 9; k++) M[k] = H[k];
        return;
    }
    real Q[9];
    for (int k = 0; k < 9; k++) Q[k] = (real)pass->axes[k];
    for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++)
            M[3 * r + s] = Q[3 * r] * H[s] + Q[3 * r + 1] * H[3 + s] + Q[3 * r + 2] * H[6 + s];
}

// J - 1
SN_INLINE wide growth(const wide M[9]) {
    wide xx = M[4] * M[8] - M[5] * M[7], yy = M[0] * M[8] - M[2] * M[6];
    wide zz = M[0] * M[4] - M[1] * M[3];
    wide det = M[0] * xx - M[1] * (M[3] * M[8] - M[5] * M[6]) + M[2] * (M[3] * M[7] - M[4] * M[6]);
    return (M[0] + M[4] + M[8]) + (xx + yy + zz) + det;
}

SN_INLINE void strain(const sn_cell_pass *pass, cell_block *c) {
    const real half = (real)0.5, bulk = (real)pass->bulk;
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide H[9], M[9];
        load9(c->H, i, H);
        to_axes(pass, H, M);
        for (int k = 0; k < 3; k++)
            wide_store(c->E + k * SN_BLOCK + i,
                       M[4 * k] + half * (M[k] * M[k] + M[3 + k] * M[3 + k] + M[6 + k] * M[6 + k]));
        for (int k = 0; k < 3; k++) { // xy yz zx
            int r = k, s = (k + 1) % 3;
            wide e = M[3 * r + s] + M[3 * s + r] + M[r] * M[s] + M[3 + r] * M[3 + s] +
                     M[6 + r] * M[6 + s];
            wide_store(c->E + (3 + k) * SN_BLOCK + i, half * e);
        }
        if (pass->volume_mode == SN_VOLUME_CELL)
            wide_store(c->T + 6 * SN_BLOCK + i, bulk * growth(M));
    }
}

// the stress that turns a crushed cell round: see SN_UPRIGHT
SN_INLINE void add_upright(const sn_cell_pass *pass, cell_block *c) {
    real *p = c->T + 6 * SN_BLOCK;
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide H[9], M[9];
        load9(c->H, i, H);
        to_axes(pass, H, M);
        wide below = wide_min(growth(M) + (real)(1 - SN_UPRIGHT), wide_set(0));
        wide_store(p + i, wide_load(p + i) + (real)pass->upright * below);
    }
}

// F = Q^T + H
SN_INLINE void deformation(const sn_cell_pass *pass, const real *H, int i, wide F[9]) {
    load9(H, i, F);
    for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) F[3 * r + s] = F[3 * r + s] + (real)pass->axes[3 * s + r];
}

// F S
SN_INLINE void law_stress(const wide F[9], const real *T, int i, wide P[9]) {
    wide S[6];
    for (int k = 0; k < 6; k++) S[k] = wide_load(T + k * SN_BLOCK + i);
    for (int r = 0; r < 3; r++) {
        const wide *f = F + 3 * r;
        P[3 * r] = f[0] * S[0] + f[1] * S[3] + f[2] * S[5];
        P[3 * r + 1] = f[0] * S[3] + f[1] * S[1] + f[2] * S[4];
        P[3 * r + 2] = f[0] * S[5] + f[1] * S[4] + f[2] * S[2];
    }
}

// P + p cof F
SN_INLINE void add_volume_stress(const wide F[9], wide p, wide P[9]) {
    for (int r = 0; r < 3; r++) {
        int r1 = (r + 1) % 3, r2 = (r + 2) % 3;
        for (int s = 0; s < 3; s++) {
            int s1 = (s + 1) % 3, s2 = (s + 2) % 3;
            wide cofactor = F[3 * r1 + s1] * F[3 * r2 + s2] - F[3 * r1 + s2] * F[3 * r2 + s1];
            P[3 * r + s] = P[3 * r + s] + p * cofactor;
        }
    }
}

// f_a = P g_a of one group of lanes, P with the factor -V
SN_INLINE void corner_forces(const real *gradient, int i, const wide P[9], real *f) {
    wide g[9], first[3] = {wide_set(0), wide_set(0), wide_set(0)};
    load9(gradient, i, g);
    for (int a = 0; a < 3; a++)
        for (int r = 0; r < 3; r++) {
            wide x =
                P[3 * r] * g[3 * a] + P[3 * r + 1] * g[3 * a + 1] + P[3 * r + 2] * g[3 * a + 2];
            first[r] = first[r] - x;
            wide_store(f + (3 * (a + 1) + r) * SN_BLOCK + i, x);
        }
    for (int r = 0; r < 3; r++) wide_store(f + r * SN_BLOCK + i, first[r]);
}

// A <- Q A Q^T of symmetric A where Q are axes of each item, or Q^T A Q
SN_INLINE void turn(const real *axes, bool back, real *A) {
    static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide Q[9], half[9], a[6];
        for (int k = 0; k < 9; k++)
            Q[back ? k % 3 * 3 + k / 3 : k] = wide_load(axes + k * SN_BLOCK + i);
        for (int k = 0; k < 6; k++) a[k] = wide_load(A + k * SN_BLOCK + i);
        for (int r = 0; r < 3; r++)
            for (int s = 0; s < 3; s++)
                half[3 * r + s] = Q[3 * r] * a[sym[0][s]] + Q[3 * r + 1] * a[sym[1][s]] +
                                  Q[3 * r + 2] * a[sym[2][s]];
        for (int k = 0; k < 6; k++) {
            const wide *h = half + 3 * pair[k][0], *q = Q + 3 * pair[k][1];
            wide_store(A + k * SN_BLOCK + i, h[0] * q[0] + h[1] * q[1] + h[2] * q[2]);
        }
    }
}

// the stress of the law of `value` at E, which is in the axes of the law; at: the first item
SN_INLINE void law_at(const sn_cell_pass *pass, const double *value, const float *value_f,
                      size_t at, const real *E, real *S) {
#if SN_REAL_BITS == 64
    (void)value_f;
    sn_law_solid(pass->law, value, pass->terms, SN_BLOCK, E, NULL, S, NULL);
#else
    (void)value;
    sn_law_solid_f(pass->law, value_f, pass->terms, SN_BLOCK, E, NULL, S, NULL);
#endif
    if (pass->turn) turn((const real *)pass->turn + 9 * at, true, S);
}

// E goes to the axes of the law
SN_INLINE void evaluate_law(const sn_cell_pass *pass, size_t at, cell_block *c) {
    if (pass->turn) turn((const real *)pass->turn + 9 * at, false, c->E);
    law_at(pass, pass->value, pass->value_f, at, c->E, c->T);
}

// T of block `block` of the memory becomes what it has relaxed to
SN_INLINE void remember(const sn_cell_pass *pass, size_t at, int block, cell_block *c) {
    if (!pass->apart) {
        const int components = pass->volume_mode == SN_VOLUME_CELL ? 7 : 6;
        block_memory(&pass->memory, block, components * SN_BLOCK, c->T);
        return;
    }
    block_memory(&pass->memory, block, 6 * SN_BLOCK, c->T);
    if (pass->volume_mode == SN_VOLUME_CELL)
        block_memory(&pass->bulk_memory, block, SN_BLOCK, c->T + 6 * SN_BLOCK);
    if (!pass->fibre_value) return;
    real *S = c->f; // not in use yet
    law_at(pass, pass->fibre_value, pass->fibre_value_f, at, c->E, S);
    block_memory(&pass->fibre_memory, block, 6 * SN_BLOCK, S);
    for (int i = 0; i < 6 * SN_BLOCK; i += SN_LANES)
        wide_store(c->T + i, wide_load(c->T + i) + wide_load(S + i));
}

// asks for what remember() will read
SN_INLINE void ask_memory(const sn_cell_pass *pass, int block) {
    const bool own_volume = pass->volume_mode == SN_VOLUME_CELL;
    block_ask_memory(&pass->memory, block, (own_volume && !pass->apart ? 7 : 6) * SN_BLOCK);
    if (!pass->apart) return;
    if (own_volume) block_ask_memory(&pass->bulk_memory, block, SN_BLOCK);
    if (pass->fibre_value) block_ask_memory(&pass->fibre_memory, block, 6 * SN_BLOCK);
}

// forces of the corners of a block to the nodes of the tile
SN_INLINE void add_forces(const real *f, const uint16_t *corner, real *force) {
    for (int a = 0; a < 4; a++)
        for (int i = 0; i < SN_BLOCK; i += 4) {
            const real *from = f + 3 * a * SN_BLOCK + i;
            quad q[4];
            block_take(from, from + SN_BLOCK, from + 2 * SN_BLOCK, q);
            tile_add(force, corner + a * SN_BLOCK + i, q);
        }
}
