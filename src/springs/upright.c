// Finds cells that were crushed.
// SPDX-License-Identifier: Apache-2.0
//
// Nodal volumes hide single cells, but cells are not turned round without the volume of some node
// falling far on the way: that is cheap to see, and only then cells are looked at one by one.
#include "springs/net.h"

static const double fallen = -0.5; // growth J - 1 of a volume point

static bool a_point_fell(const sn_net *net, const sn_state *s) {
    const double *volume = sn_parts_point_volume(net, sn_state_parts(s));
    for (int p = 0; p < net->point_blocks * SN_BLOCK; p++) {
        double sum = 0;
        for (int k = net->point_start[p]; k < net->point_start[p + 1]; k++)
            sum += sn_real_at(s->precision, s->now.growth, (size_t)net->point_item[k]);
        if (sum < fallen * volume[p]) return true;
    }
    return false;
}

// six times the volume of a cell, moved by `part` of the displacements
static double six_volumes(const sn_net *net, const sn_state *s, int slot, double part) {
    const int *corner = net->cell_node + (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
    double x[4][3], e[3][3];
    for (int a = 0; a < 4; a++)
        for (int d = 0; d < 3; d++) {
            const int node = corner[a * SN_BLOCK];
            x[a][d] = net->node_position[3 * node + d] +
                      part * sn_real_at(s->precision, s->u, 4 * (size_t)node + (size_t)d);
            if (a > 0) e[a - 1][d] = x[a][d] - x[0][d];
        }
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
           e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

static bool a_cell_is_crushed(const sn_net *net, const sn_state *s) {
    const sn_parts *parts = sn_state_parts(s);
    for (int e = 0; e < net->cells; e++) {
        const int slot = net->cell_slot[e];
        if (parts && parts->gone[slot]) continue;
        if (six_volumes(net, s, slot, 1) < SN_UPRIGHT * six_volumes(net, s, slot, 0)) return true;
    }
    return false;
}

void sn_state_look_at_cells(const sn_net *net, sn_state *s) {
    if (!net->volume || (!s->crushed && !a_point_fell(net, s))) return;
    const bool now = a_cell_is_crushed(net, s);
    s->warnings += now && !s->crushed;
    s->crushed = now;
}
