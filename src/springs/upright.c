// Finds cells that were crushed.
// SPDX-License-Identifier: Apache-2.0
//
// Nodal volumes hide single cells, but cells are not turned round without the volume of some node
// falling far on the way: that is cheap to see, and only then cells are looked at one by one. Not
// so those that a cut left hanging by a corner or an edge, which fold without a node feeling it:
// cells at nodes that have lost one are looked at always, so that the step allows in time for their
// stress, which acts in a cut body always.
#include <math.h>

#include "base/vector.h"
#include "springs/moment.h"
#include "springs/parts.h"
#include "springs/steps.h"

static const double fallen = -0.5;    // growth J - 1 of a volume point
static const double near_depth = 0.3; // above SN_UPRIGHT, of cells that may be crushed soon

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

// six times the volume of a cell, moved by `part` of the displacements u, quads
static double six_volumes(const sn_net *net, sn_precision precision, const void *u, int slot,
                          double part) {
    const int *corner = net->cell_node + (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
    double x[4][3], e[3][3];
    for (int a = 0; a < 4; a++)
        for (int d = 0; d < 3; d++) {
            const int node = corner[a * SN_BLOCK];
            x[a][d] = net->node_position[3 * node + d] +
                      part * sn_real_at(precision, u, 4 * (size_t)node + (size_t)d);
            if (a > 0) e[a - 1][d] = x[a][d] - x[0][d];
        }
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
           e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

// how far a cell is below SN_UPRIGHT of its volume
static double depth_of(const sn_net *net, sn_precision precision, const void *u, int slot) {
    const double rest = six_volumes(net, precision, u, slot, 0);
    return SN_UPRIGHT - six_volumes(net, precision, u, slot, 1) / rest;
}

static bool a_cell_is_crushed(const sn_net *net, const sn_state *s) {
    const sn_parts *parts = sn_state_parts(s);
    for (int e = 0; e < net->cells; e++) {
        const int slot = net->cell_slot[e];
        if (parts && parts->gone[slot]) continue;
        if (depth_of(net, s->precision, s->u, slot) > 0) return true;
    }
    return false;
}

static bool one_at_a_cut_is_crushed(const sn_net *net, const sn_state *s) {
    const sn_parts *parts = sn_state_parts(s);
    for (int k = 0; parts && k < *parts->rim_count; k++)
        if (depth_of(net, s->precision, s->u, parts->rim[k]) > 0) return true;
    return false;
}

void sn_state_look_at_cells(const sn_net *net, sn_state *s) {
    if (!net->volume) return;
    const bool fell = s->crushed || a_point_fell(net, s);
    const bool now = fell ? a_cell_is_crushed(net, s) : one_at_a_cut_is_crushed(net, s);
    s->warnings += now && !s->crushed;
    s->crushed = now;
}

// in a cut body always: a stress that comes on where cells are crushed already is energy from
// nowhere
bool sn_state_is_upright(const sn_state *s) {
    return s->crushed || (sn_state_parts(s) && !s->implicit);
}

double sn_region_upright(const sn_net_region *region) {
    return fmax(20 * region->shear, region->bulk);
}

// Of one cell, K V g^T M^-1 g with g = dJ/dx: as much as its stress adds to the eigenvalue of any
// motion once it acts.
static double stiffness_of(const sn_net *net, const sn_state *s, int slot, double modulus) {
    static const int face[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    const int *corner = net->cell_node + (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
    const double six = six_volumes(net, s->precision, s->u, slot, 0);
    double x[4][3], sum = 0;
    for (int a = 0; a < 4; a++)
        for (int d = 0; d < 3; d++) {
            const int node = corner[a * SN_BLOCK];
            x[a][d] = net->node_position[3 * node + d] +
                      sn_real_at(s->precision, s->u, 4 * (size_t)node + (size_t)d);
        }
    for (int a = 0; a < 4; a++) {
        double u[3], v[3], n[3];
        for (int d = 0; d < 3; d++) {
            u[d] = x[face[a][1]][d] - x[face[a][0]][d];
            v[d] = x[face[a][2]][d] - x[face[a][0]][d];
        }
        cross3(u, v, n);
        for (int d = 0; d < 3; d++) {
            const double g = net->root_inverse_mass[3 * corner[a * SN_BLOCK] + d] * n[d] / six;
            sum += g * g;
        }
    }
    return modulus * six / 6 * sum;
}

double sn_state_upright_stiffness(const sn_net *net, const sn_state *s) {
    const double *volume = sn_parts_volume(net, sn_state_parts(s), SN_DOUBLE);
    double most = 0;
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        const int first = g->cell_block * SN_BLOCK, last = first + g->cell_blocks * SN_BLOCK;
        for (int slot = first; slot < last; slot++)
            if (volume[slot] > 0 && depth_of(net, s->precision, s->u, slot) > -near_depth)
                most = fmax(most, stiffness_of(net, s, slot, sn_region_upright(g)));
    }
    return most;
}

double sn_net_upright_energy(const sn_net *net, const sn_moment *m) {
    const double *volume = sn_parts_volume(net, m->parts, SN_DOUBLE);
    double sum = 0;
    for (int r = 0; r < net->region_count && m->upright && net->volume; r++) {
        const sn_net_region *g = &net->region[r];
        const int first = g->cell_block * SN_BLOCK, last = first + g->cell_blocks * SN_BLOCK;
        for (int slot = first; slot < last; slot++) {
            if (!(volume[slot] > 0)) continue; // gone, or filling
            const double depth = fmax(0, depth_of(net, m->precision, m->u, slot));
            sum += 0.5 * sn_region_upright(g) * depth * depth * volume[slot];
        }
    }
    return sum;
}
