// Edges of the smoothed rung and the cells around them.
// SPDX-License-Identifier: Apache-2.0
//
// Every region has edges of its own: strain is not smoothed from one tissue into another, and an
// edge between two regions stands once for each. Edges stand along the curve, in groups as large as
// the cells of a tile, those with equally many cells together: the sum over the cells around an
// edge then has the same length many times in a row, which a processor foresees.
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

enum { GROUP = SN_TILE_BLOCKS * SN_BLOCK };

/// The parts [first, first + count) of a list make an edge.
typedef struct smooth_edge {
    int first, count;
} smooth_edge;

static int compare_count(const void *a, const void *b) {
    const smooth_edge *x = a, *y = b;
    if (x->count != y->count) return x->count < y->count ? -1 : 1;
    return (x->first > y->first) - (x->first < y->first);
}

// edges of sorted parts in the order of their slots; returns how many
static int list_edges(const sn_edge_part *part, int parts, smooth_edge *edge) {
    int count = 0;
    for (int k = 0, end; k < parts; k = end) {
        for (end = k; end < parts && part[end].low == part[k].low && part[end].high == part[k].high;
             end++) {
        }
        edge[count++] = (smooth_edge){k, end - k};
    }
    for (int k = 0; k < count; k += GROUP)
        qsort(edge + k, (size_t)(count - k < GROUP ? count - k : GROUP), sizeof *edge,
              compare_count);
    return count;
}

// room for the edges of one more region
static sn_status grow_edges(sn_net *net, int blocks, int shares) {
    int *start = sn_resize(net->edge_start, (size_t)blocks * SN_BLOCK + 1, sizeof *start);
    if (start) net->edge_start = start;
    int *cell = sn_resize(net->edge_cell, (size_t)shares, sizeof *cell);
    if (cell) net->edge_cell = cell;
    bool *filling = sn_resize(net->edge_filling, (size_t)blocks * SN_BLOCK, sizeof *filling);
    if (filling) net->edge_filling = filling;
    return start && cell && filling ? SN_OK : SN_E_MEMORY;
}

// cells without volume have the edges of a cell that has
static void fill_up(sn_net *net, const sn_net_region *region, int like) {
    const double *volume = net->data[SN_DOUBLE].volume;
    for (int s = region->cell_block * SN_BLOCK;
         s < (region->cell_block + region->cell_blocks) * SN_BLOCK; s++)
        for (int k = 0; k < 6 && !(volume[s] > 0); k++)
            net->cell_edge[(s / SN_BLOCK * 6 + k) * SN_BLOCK + s % SN_BLOCK] =
                net->cell_edge[(like / SN_BLOCK * 6 + k) * SN_BLOCK + like % SN_BLOCK];
}

static void place_edges(sn_net *net, const sn_edge_part *part, const smooth_edge *edge, int edges,
                        int blocks) {
    int slot = net->edge_blocks * SN_BLOCK, at = net->edge_start[slot];
    for (int k = 0; k < blocks * SN_BLOCK; k++, slot++) {
        // the last edge once more where there is none
        const smooth_edge *e = &edge[k < edges ? k : edges - 1];
        for (int n = e->first; n < e->first + e->count; n++) {
            const int s = part[n].slot;
            net->edge_cell[at++] = s;
            if (k < edges)
                net->cell_edge[(s / SN_BLOCK * 6 + part[n].side) * SN_BLOCK + s % SN_BLOCK] = slot;
        }
        net->edge_start[slot + 1] = at;
        net->edge_filling[slot] = k >= edges;
        if (e->count > net->edge_most) net->edge_most = e->count;
    }
}

static sn_status region_edges(const sn_mesh *mesh, sn_net *net, int r) {
    sn_net_region *region = &net->region[r];
    sn_edge_part *part = NULL;
    smooth_edge *edge = NULL;
    int parts;
    sn_status status;
    SN_TRY_GOTO(status, sn_net_list_parts(mesh, net, r, &part, &parts));
    edge = sn_alloc((size_t)parts, sizeof *edge);
    if (!edge) {
        status = SN_E_MEMORY;
        goto fail;
    }
    const int edges = list_edges(part, parts, edge);
    const int blocks = (edges + SN_BLOCK - 1) / SN_BLOCK;
    const int filling = edges > 0 ? (blocks * SN_BLOCK - edges) * edge[edges - 1].count : 0;
    const int before = net->edge_start[net->edge_blocks * SN_BLOCK];
    SN_TRY_GOTO(status, grow_edges(net, net->edge_blocks + blocks, before + parts + filling));
    region->edge_block = net->edge_blocks;
    region->edge_blocks = blocks;
    place_edges(net, part, edge, edges, blocks);
    net->edge_blocks += blocks;
    if (parts > 0) fill_up(net, region, part[0].slot);
fail:
    sn_free(part);
    sn_free(edge);
    return status;
}

sn_status sn_net_build_edges(const sn_case *c, sn_net *net) {
    net->edge_start = sn_alloc(1, sizeof *net->edge_start);
    net->cell_edge = sn_alloc((size_t)net->cell_blocks * 6 * SN_BLOCK, sizeof *net->cell_edge);
    if (!net->edge_start || !net->cell_edge) return SN_E_MEMORY;
    for (int r = 0; r < net->region_count; r++) SN_TRY(region_edges(c->mesh, net, r));
    return SN_OK;
}

void sn_net_destroy_edges(sn_net *net) {
    sn_free(net->edge_start);
    sn_free(net->edge_cell);
    sn_free(net->edge_filling);
    sn_free(net->cell_edge);
}
