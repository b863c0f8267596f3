// Forces of cells whose six edges share one strain energy.
// SPDX-License-Identifier: Apache-2.0
#include "springs/kernels/cells.h"

void SN_KERNEL(sn_cells)(const sn_cell_pass *pass, const sn_tile *tile);

SN_INLINE void find_forces(const sn_cell_pass *pass, size_t at, cell_block *c) {
    const real *gradient = (const real *)pass->gradient + 9 * at;
    const real *volume = (const real *)pass->volume + at;
    for (int i = 0; i < SN_BLOCK; i += SN_LANES) {
        wide F[9], P[9], V = wide_load(volume + i);
        deformation(pass, c->H, i, F);
        law_stress(F, c->T, i, P);
        if (pass->volume_mode != SN_VOLUME_NONE)
            add_volume_stress(F, wide_load(c->T + 6 * SN_BLOCK + i), P);
        for (int k = 0; k < 9; k++) P[k] = -V * P[k];
        corner_forces(gradient, i, P, c->f);
    }
}

void SN_KERNEL(sn_cells)(const sn_cell_pass *pass, const sn_tile *tile) {
    tile_quads nodes;
    cell_block c;
    const bool nodal = pass->volume_mode == SN_VOLUME_NODE;
    tile_load_quads(tile, pass->u, NULL, nodal ? pass->pressure : NULL, &nodes);
    memset(tile->force, 0, (size_t)tile->nodes * sizeof(quad));
    for (int b = 0; b < tile->blocks; b++) {
        const int block = tile->block + b;
        const size_t at = (size_t)block * SN_BLOCK;
        const uint16_t *corner = tile->corner + 4 * b * SN_BLOCK;
        ask_memory(pass, block - pass->first);
        displacement_gradient(pass, &nodes, corner, at, nodal, &c);
        strain(pass, &c);
        if (pass->upright > 0) add_upright(pass, &c);
        evaluate_law(pass, at, &c);
        remember(pass, at, block - pass->first, &c);
        find_forces(pass, at, &c);
        add_forces(c.f, corner, tile->force);
    }
}
