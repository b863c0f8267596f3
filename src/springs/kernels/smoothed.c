// Forces of cells whose strain is smoothed over the cells around each edge.
// SPDX-License-Identifier: Apache-2.0
// Source: edge-based smoothed finite elements (Liu, Nguyen-Thoi, Lam, J. Sound Vib. 320, 2009; for
// tetrahedra Cazes, Meschke, Int. J. Numer. Meth. Engng 94, 2013); laws by equation (16), memory by
// equations (33)-(35).
//
// Every cell gives a sixth of its volume to each of its edges. Edge e has the displacement gradient
//     H_e = sum over the cells around it of V_c/6 H_c / V_e,   V_e = sum of V_c/6,
// and the energy V_e W(H_e). Its stress P_e pulls through all these cells: a node of cell c gets
//     f_a = -V_c P_c g_a,   P_c = 1/6 sum over the six edges of P_e  (+ p_c cof F_c by nodal
//     volume).
// So a step is three passes: cells, edges, cells.
#include "springs/kernels/cells.h"

void SN_KERNEL(sn_shapes)(const sn_cell_pass *pass, const sn_tile *tile);
void SN_KERNEL(sn_edges)(const sn_cell_pass *pass, int block);
void SN_KERNEL(sn_shares)(const sn_cell_pass *pass, const sn_tile *tile);

/// Three quads.
enum { ITEM = 12 };

//---- cells ---------------------------------------------------------------------------------------

void SN_KERNEL(sn_shapes)(const sn_cell_pass *pass, const sn_tile *tile) {
    const real sixth = (real)(1.0 / 6.0);
    tile_quads nodes;
    cell_block c;
    tile_load_quads(tile, pass->u, NULL, NULL, &nodes);
    for (int b = 0; b < tile->blocks; b++) {
        const size_t at = (size_t)(tile->block + b) * SN_BLOCK;
        const real *volume = (const real *)pass->volume + at;
        real *to = (real *)pass->shape + ITEM * at;
        displacement_gradient(pass, &nodes, tile->corner + 4 * b * SN_BLOCK, at, false, &c);
        for (int i = 0; i < SN_BLOCK; i += 4, to += 4 * ITEM) {
            const quad part = sixth * quad_load(volume + i), none = {0, 0, 0, 0};
            for (int r = 0; r < 3; r++) {
                const real *row = c.H + 3 * r * SN_BLOCK + i;
                quad q[4];
                quad_turn(part * quad_load(row), part * quad_load(row + SN_BLOCK),
                          part * quad_load(row + 2 * SN_BLOCK), r == 0 ? part : none, q);
                for (int k = 0; k < 4; k++) quad_store(to + k * ITEM + 4 * r, q[k]);
            }
        }
    }
}

//---- edges ---------------------------------------------------------------------------------------

// H of the edges of a block
SN_INLINE void gather_shapes(const sn_cell_pass *pass, size_t at, cell_block *c) {
    const real *shape = pass->shape;
    const int *start = pass->share_start + at;
    real volume[SN_BLOCK];
    for (int i = 0; i < SN_BLOCK; i += 4) {
        quad q[3][4];
        for (int k = 0; k < 4; k++) {
            quad sum[3] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
            for (int s = start[i + k]; s < start[i + k + 1]; s++) {
                const real *from = shape + ITEM * (size_t)pass->share[s];
                for (int r = 0; r < 3; r++) sum[r] += quad_load(from + 4 * r);
            }
            for (int r = 0; r < 3; r++) q[r][k] = sum[r];
            volume[i + k] = sum[0][3];
        }
        for (int r = 0; r < 3; r++) {
            real *row = c->H + 3 * r * SN_BLOCK + i;
            block_put(row, row + SN_BLOCK, row + 2 * SN_BLOCK, q[r][0], q[r][1], q[r][2], q[r][3]);
        }
    }
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide V = wide_load(volume + i), none = wide_set(0);
        wide over = wide_select(wide_less(none, V), 1 / V, none);
        for (int k = 0; k < 9; k++)
            wide_store(c->H + k * SN_BLOCK + i, over * wide_load(c->H + k * SN_BLOCK + i));
    }
}

// H becomes P
SN_INLINE void find_piola(const sn_cell_pass *pass, cell_block *c) {
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide F[9], P[9];
        deformation(pass, c->H, i, F);
        law_stress(F, c->T, i, P);
        if (pass->volume_mode == SN_VOLUME_CELL)
            add_volume_stress(F, wide_load(c->T + 6 * SN_BLOCK + i), P);
        for (int k = 0; k < 9; k++) wide_store(c->H + k * SN_BLOCK + i, P[k]);
    }
}

void SN_KERNEL(sn_edges)(const sn_cell_pass *pass, int block) {
    const size_t at = (size_t)block * SN_BLOCK;
    real *to = (real *)pass->piola + ITEM * at;
    cell_block c;
    ask_memory(pass, block - pass->first);
    gather_shapes(pass, at, &c);
    strain(pass, &c);
    evaluate_law(pass, at, &c);
    remember(pass, at, block - pass->first, &c);
    find_piola(pass, &c);
    for (int i = 0; i < SN_BLOCK; i += 4, to += 4 * ITEM)
        for (int r = 0; r < 3; r++) {
            const real *row = c.H + 3 * r * SN_BLOCK + i;
            quad q[4];
            block_take(row, row + SN_BLOCK, row + 2 * SN_BLOCK, q);
            for (int k = 0; k < 4; k++) quad_store(to + k * ITEM + 4 * r, q[k]);
        }
}

//---- cells again ---------------------------------------------------------------------------------

// sum of P over the six edges of the cells of a block
SN_INLINE void gather_piola(const sn_cell_pass *pass, size_t at, real *P) {
    const real *piola = pass->piola;
    const int *edge = pass->edge + 6 * at;
    for (int i = 0; i < SN_BLOCK; i += 4) {
        quad q[3][4];
        for (int k = 0; k < 4; k++) {
            quad sum[3] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
            for (int e = 0; e < 6; e++) {
                const real *from = piola + ITEM * (size_t)edge[e * SN_BLOCK + i + k];
                for (int r = 0; r < 3; r++) sum[r] += quad_load(from + 4 * r);
            }
            for (int r = 0; r < 3; r++) q[r][k] = sum[r];
        }
        for (int r = 0; r < 3; r++) {
            real *row = P + 3 * r * SN_BLOCK + i;
            block_put(row, row + SN_BLOCK, row + 2 * SN_BLOCK, q[r][0], q[r][1], q[r][2], q[r][3]);
        }
    }
}

void SN_KERNEL(sn_shares)(const sn_cell_pass *pass, const sn_tile *tile) {
    const bool nodal = pass->volume_mode == SN_VOLUME_NODE;
    const real sixth = (real)(1.0 / 6.0);
    tile_quads nodes;
    cell_block c;
    real sum[9 * SN_BLOCK];
    if (nodal) tile_load_quads(tile, pass->u, NULL, pass->pressure, &nodes);
    memset(tile->force, 0, (size_t)tile->nodes * sizeof(quad));
    for (int b = 0; b < tile->blocks; b++) {
        const size_t at = (size_t)(tile->block + b) * SN_BLOCK;
        const uint16_t *corner = tile->corner + 4 * b * SN_BLOCK;
        const real *gradient = (const real *)pass->gradient + 9 * at;
        const real *volume = (const real *)pass->volume + at;
        gather_piola(pass, at, sum);
        if (nodal) displacement_gradient(pass, &nodes, corner, at, true, &c);
        if (nodal && pass->upright > 0) add_upright(pass, &c);
        for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
            wide F[9], P[9], V = wide_load(volume + i);
            load9(sum, i, P);
            for (int k = 0; k < 9; k++) P[k] = sixth * P[k];
            if (nodal) {
                deformation(pass, c.H, i, F);
                add_volume_stress(F, wide_load(c.T + 6 * SN_BLOCK + i), P);
            }
            for (int k = 0; k < 9; k++) P[k] = -V * P[k];
            corner_forces(gradient, i, P, c.f);
        }
        add_forces(c.f, corner, tile->force);
    }
}
