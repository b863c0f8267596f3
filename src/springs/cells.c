// Puts the cells of a case into blocks and weighs the volume points.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "springs/net.h"

static int blocks_of(int items) {
    return (items + SN_BLOCK - 1) / SN_BLOCK;
}

// rotates to material axes
static void to_axes(const double Q[9], const double x[3], double y[3]) {
    for (int r = 0; r < 3; r++) y[r] = Q[3 * r] * x[0] + Q[3 * r + 1] * x[1] + Q[3 * r + 2] * x[2];
}

// gradients of shape functions 1 2 3 in material axes; returns the volume
static double shape_gradients(const sn_net *net, const int *node, double g[9]) {
    double D[3][3]; // rest edges from corner 0
    for (int a = 0; a < 3; a++) {
        double d[3];
        for (int k = 0; k < 3; k++)
            d[k] = net->node_position[3 * node[a + 1] + k] - net->node_position[3 * node[0] + k];
        to_axes(net->axes, d, D[a]);
    }
    double det = 0.0;
    for (int a = 0; a < 3; a++) {
        const double *p = D[(a + 1) % 3], *q = D[(a + 2) % 3];
        g[3 * a] = p[1] * q[2] - p[2] * q[1];
        g[3 * a + 1] = p[2] * q[0] - p[0] * q[2];
        g[3 * a + 2] = p[0] * q[1] - p[1] * q[0];
    }
    for (int k = 0; k < 3; k++) det += D[0][k] * g[k];
    for (int k = 0; k < 9; k++) g[k] /= det;
    return det / 6.0;
}

// blocks of all regions: how many, and where each region starts; the slot of each cell
static sn_status place_cells(const sn_mesh *mesh, sn_net *net) {
    int *count = sn_alloc((size_t)net->region_count, sizeof *count);
    int *done = sn_alloc((size_t)net->region_count, sizeof *done);
    int *order = sn_alloc((size_t)mesh->cell_count, sizeof *order);
    sn_status status = count && done && order ? sn_net_cell_order(mesh, order) : SN_E_MEMORY;
    if (status != SN_OK) goto fail;
    for (int e = 0; e < mesh->cell_count; e++) count[mesh->region[e]]++;
    for (int r = 0; r < net->region_count; r++) {
        net->region[r].cell_block = net->cell_blocks;
        net->region[r].cell_blocks = blocks_of(count[r]);
        net->cell_blocks += net->region[r].cell_blocks;
    }
    for (int k = 0; k < mesh->cell_count; k++) {
        const int r = mesh->region[order[k]];
        net->cell_slot[order[k]] = net->region[r].cell_block * SN_BLOCK +
                                   sn_spread(done[r]++, count[r], SN_TILE_BLOCKS * SN_BLOCK);
    }
fail:
    sn_free(count);
    sn_free(done);
    sn_free(order);
    return status;
}

static void fill_slot(sn_net *net, int slot, const int *node, bool real_one) {
    const size_t block = (size_t)slot / SN_BLOCK, lane = (size_t)slot % SN_BLOCK;
    sn_net_data *data = &net->data[SN_DOUBLE];
    double g[9], volume = shape_gradients(net, node, g);
    for (size_t a = 0; a < 4; a++) net->cell_node[(block * 4 + a) * SN_BLOCK + lane] = node[a];
    for (size_t k = 0; k < 9; k++)
        ((double *)data->gradient)[(block * 9 + k) * SN_BLOCK + lane] = g[k];
    ((double *)data->volume)[slot] = real_one ? volume : 0.0;
}

static void fill_cells(const sn_mesh *mesh, sn_net *net) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        int last = -1, count = 0; // the cell of the last slot
        for (int e = 0; e < mesh->cell_count; e++) {
            if (mesh->region[e] != r) continue;
            fill_slot(net, net->cell_slot[e], mesh->cell + 4 * e, true);
            if (last < 0 || net->cell_slot[e] > net->cell_slot[last]) last = e;
            count++;
        }
        for (int k = count; k < region->cell_blocks * SN_BLOCK; k++)
            fill_slot(net, region->cell_block * SN_BLOCK + k, mesh->cell + 4 * last, false);
    }
}

// the volume points of all regions: numbers them and gives every corner of a cell its point
static sn_status place_points(const sn_mesh *mesh, sn_net *net) {
    int *point = sn_alloc((size_t)net->nodes, sizeof *point), blocks = 0;
    if (!point) return SN_E_MEMORY;
    sn_status status = SN_OK;
    for (int r = 0; r < net->region_count; r++) {
        sn_net_region *region = &net->region[r];
        for (int i = 0; i < net->nodes; i++) point[i] = -1;
        for (int e = 0; e < mesh->cell_count; e++)
            for (int a = 0; a < 4 && mesh->region[e] == r; a++) point[mesh->cell[4 * e + a]] = 0;
        int count = 0;
        for (int i = 0; i < net->nodes; i++)
            if (point[i] == 0) point[i] = blocks * SN_BLOCK + count++;
        region->point_block = blocks;
        region->point_blocks = blocks_of(count);
        blocks += region->point_blocks;
        int *names = sn_resize(net->point_node, (size_t)blocks * SN_BLOCK, sizeof *names);
        if (!names) {
            status = SN_E_MEMORY;
            break;
        }
        net->point_node = names;
        for (int k = region->point_block * SN_BLOCK; k < blocks * SN_BLOCK; k++) names[k] = -1;
        for (int i = 0; i < net->nodes; i++)
            if (point[i] >= 0) names[point[i]] = i;
        for (int s = region->cell_block * SN_BLOCK;
             s < (region->cell_block + region->cell_blocks) * SN_BLOCK; s++)
            for (int a = 0; a < 4; a++) {
                size_t at =
                    ((size_t)(s / SN_BLOCK) * 4 + (size_t)a) * SN_BLOCK + (size_t)(s % SN_BLOCK);
                net->cell_point[at] = point[net->cell_node[at]];
            }
    }
    net->point_blocks = blocks;
    sn_free(point);
    return status;
}

// V and K / V of each volume point
static sn_status weigh_points(sn_net *net) {
    const size_t points = (size_t)net->point_blocks * SN_BLOCK;
    const double *volume = net->data[SN_DOUBLE].volume;
    net->point_volume = sn_alloc(points, sizeof *net->point_volume);
    double *stiffness = net->data[SN_DOUBLE].point_stiffness = sn_alloc(points, sizeof *stiffness);
    if (!net->point_volume || !stiffness) return SN_E_MEMORY;
    for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) {
        if (!(volume[s] > 0)) continue;
        for (int a = 0; a < 4; a++)
            net->point_volume[net->cell_point[(s / SN_BLOCK * 4 + a) * SN_BLOCK + s % SN_BLOCK]] +=
                0.25 * volume[s];
    }
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        for (int p = region->point_block * SN_BLOCK;
             p < (region->point_block + region->point_blocks) * SN_BLOCK; p++)
            stiffness[p] = net->point_volume[p] > 0 ? region->bulk / net->point_volume[p] : 0.0;
    }
    return SN_OK;
}

sn_status sn_net_build_cells(const sn_case *c, sn_net *net) {
    net->cell_slot = sn_alloc((size_t)net->cells, sizeof *net->cell_slot);
    if (!net->cell_slot) return SN_E_MEMORY;
    SN_TRY(place_cells(c->mesh, net));
    const size_t slots = (size_t)net->cell_blocks * SN_BLOCK;
    sn_net_data *data = &net->data[SN_DOUBLE];
    net->cell_node = sn_alloc(slots * 4, sizeof *net->cell_node);
    net->cell_point = sn_alloc(slots * 4, sizeof *net->cell_point);
    data->gradient = sn_alloc(slots * 9, sizeof(double));
    data->volume = sn_alloc(slots, sizeof(double));
    if (!net->cell_node || !net->cell_point || !data->gradient || !data->volume) return SN_E_MEMORY;
    fill_cells(c->mesh, net);
    if (!net->volume) return SN_OK;
    SN_TRY(place_points(c->mesh, net));
    return weigh_points(net);
}
