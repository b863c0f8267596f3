// Springs given one by one, in place of those that follow from the tissue.
// SPDX-License-Identifier: Apache-2.0
//
// They join any two nodes of a region. A spring along an edge shares its energy and stress with the
// cells around the edge, any other one with all cells at its ends.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

static int compare_springs(const void *a, const void *b) {
    const sn_spring *p = a, *q = b;
    for (int e = 0; e < 2; e++)
        if (p->end[e] != q->end[e]) return p->end[e] < q->end[e] ? -1 : 1;
    return (p->stiffness > q->stiffness) - (p->stiffness < q->stiffness);
}

sn_status sn_net_order_springs(const sn_spring_set *set, const int *name, int nodes,
                               sn_spring_set **ordered) {
    int *place = sn_alloc((size_t)nodes, sizeof *place);
    sn_status status = place ? sn_spring_set_copy(set, ordered) : SN_E_MEMORY;
    for (int i = 0; i < nodes && status == SN_OK; i++) place[name[i]] = i;
    for (int k = 0; k < 2 * set->count && status == SN_OK; k++)
        (*ordered)->end[k] = place[set->end[k]];
    sn_free(place);
    return status;
}

double sn_net_given_bulk(const sn_case *c, int region, double bulk) {
    const sn_spring_set *set = c->springs_given;
    double sum = 0, volume = 0; // of k L^2 = 9 K V where all springs stretch alike
    if (!isnan(set->bulk[region])) return set->bulk[region];
    for (int e = 0; e < c->mesh->cell_count; e++)
        if (c->mesh->region[e] == region) volume += sn_mesh_cell_volume(c->mesh, e);
    for (int k = 0; k < set->count; k++)
        for (int d = 0; d < 3 && set->region[k] == region; d++) {
            const double *x = c->mesh->node + d;
            const double D = x[3 * set->end[2 * k + 1]] - x[3 * set->end[2 * k]];
            sum += set->stiffness[k] * D * D;
        }
    return fmax(bulk - sum / (9.0 * volume), 0.0);
}

sn_status sn_net_given_springs(const sn_case *c, sn_net *net, int r) {
    const sn_spring_set *set = c->springs_given;
    sn_spring *spring = sn_alloc((size_t)set->count, sizeof *spring);
    int count = 0;
    if (!spring) return SN_E_MEMORY;
    for (int k = 0; k < set->count; k++) {
        const int *end = set->end + 2 * (size_t)k;
        if (set->region[k] != r || !(set->stiffness[k] > 0)) continue;
        sn_spring *s = &spring[count++];
        s->end[0] = end[0] < end[1] ? end[0] : end[1];
        s->end[1] = end[0] < end[1] ? end[1] : end[0];
        s->stiffness = set->stiffness[k];
        s->volume = 1.0; // until its cells are known
        for (int d = 0; d < 3; d++) {
            s->edge[d] =
                net->node_position[3 * s->end[1] + d] - net->node_position[3 * s->end[0] + d];
            s->length2 += s->edge[d] * s->edge[d];
        }
    }
    qsort(spring, (size_t)count, sizeof *spring, compare_springs);
    sn_status status = sn_net_place_springs(net, &net->region[r], spring, count);
    sn_free(spring);
    return status;
}

//---- what belongs to whom ------------------------------------------------------------------------

/// Slots of the cells of a region at each node.
typedef struct node_cells {
    int *start, *slot; ///< (nodes + 2), (4 a cell)
} node_cells;

static void list_cells(const sn_net *net, const sn_net_region *g, node_cells *at) {
    const double *volume = net->data[SN_DOUBLE].volume;
    memset(at->start, 0, ((size_t)net->nodes + 2) * sizeof *at->start);
    for (int pass = 0; pass < 2; pass++) {
        for (int s = g->cell_block * SN_BLOCK; s < (g->cell_block + g->cell_blocks) * SN_BLOCK; s++)
            for (int a = 0; a < 4 && volume[s] > 0; a++) {
                const int node = net->cell_node[(s / SN_BLOCK * 4 + a) * SN_BLOCK + s % SN_BLOCK];
                if (pass == 0)
                    at->start[node + 2]++;
                else
                    at->slot[at->start[node + 1]++] = s;
            }
        for (int i = 0; i < net->nodes && pass == 0; i++) at->start[i + 2] += at->start[i + 1];
    }
}

static bool has_corner(const sn_net *net, int slot, int node) {
    const int *corner = net->cell_node + slot / SN_BLOCK * 4 * SN_BLOCK + slot % SN_BLOCK;
    return corner[0] == node || corner[SN_BLOCK] == node || corner[2 * SN_BLOCK] == node ||
           corner[3 * SN_BLOCK] == node;
}

// The cells of a spring are counted, or written to the lists and their volume to the spring.
static void share_spring(sn_net *net, const node_cells *at, int spring, bool write, int *fill) {
    const int *end = net->spring_end + spring / SN_BLOCK * 2 * SN_BLOCK + spring % SN_BLOCK;
    const double *volume = net->data[SN_DOUBLE].volume;
    const int a = end[0], b = end[SN_BLOCK];
    double sum = 0;
    bool edge = false;
    for (int k = at->start[a]; k < at->start[a + 1]; k++)
        edge = edge || has_corner(net, at->slot[k], b);
    for (int e = 0; e < (edge ? 1 : 2); e++)
        for (int k = at->start[e ? b : a]; k < at->start[(e ? b : a) + 1]; k++) {
            const int slot = at->slot[k];
            if (edge && !has_corner(net, slot, b)) continue;
            sum += volume[slot];
            if (write)
                net->spring_share[fill[slot]++] = spring;
            else
                net->spring_share_start[slot + 1]++;
        }
    if (write) net->spring_volume[spring] = sum;
}

static sn_status share_all(sn_net *net, node_cells *at, int *fill) {
    const double *stiffness = net->data[SN_DOUBLE].stiffness;
    const int slots = net->cell_blocks * SN_BLOCK;
    for (int pass = 0; pass < 2; pass++) {
        for (int r = 0; r < net->region_count; r++) {
            const sn_net_region *g = &net->region[r];
            list_cells(net, g, at);
            for (int s = g->spring_block * SN_BLOCK;
                 s < (g->spring_block + g->spring_blocks) * SN_BLOCK; s++)
                if (stiffness[s] > 0) share_spring(net, at, s, pass == 1, fill);
        }
        if (pass == 1) break;
        for (int s = 0; s < slots; s++)
            net->spring_share_start[s + 1] += net->spring_share_start[s];
        memcpy(fill, net->spring_share_start, (size_t)slots * sizeof *fill);
        net->spring_share = sn_alloc((size_t)net->spring_share_start[slots], sizeof(int));
        if (!net->spring_share) return SN_E_MEMORY;
    }
    return SN_OK;
}

sn_status sn_net_share_given(sn_net *net) {
    const size_t slots = (size_t)net->cell_blocks * SN_BLOCK;
    node_cells at = {.start = sn_alloc((size_t)net->nodes + 2, sizeof *at.start),
                     .slot = sn_alloc((size_t)net->cells * 4, sizeof *at.slot)};
    int *fill = sn_alloc(slots, sizeof *fill);
    net->spring_share_start = sn_alloc(slots + 1, sizeof(int));
    sn_status status = at.start && at.slot && fill && net->spring_share_start
                           ? share_all(net, &at, fill)
                           : SN_E_MEMORY;
    sn_free(at.start);
    sn_free(at.slot);
    sn_free(fill);
    return status;
}

//---- the other way round -------------------------------------------------------------------------

sn_status sn_net_spring_set(const sn_net *net, sn_spring_set **set) {
    const double *stiffness = net->data[SN_DOUBLE].stiffness;
    SN_TRY(sn_spring_set_create(net->springs, net->region_count, set));
    int count = 0;
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        (*set)->exponent[r] = g->exponent;
        memcpy((*set)->square + SN_SPRING_SQUARES * r, g->square, sizeof g->square);
        if (net->volume) (*set)->bulk[r] = g->bulk;
        for (int s = g->spring_block * SN_BLOCK;
             s < (g->spring_block + g->spring_blocks) * SN_BLOCK; s++) {
            const int *end = net->spring_end + s / SN_BLOCK * 2 * SN_BLOCK + s % SN_BLOCK;
            if (!(net->spring_volume[s] > 0)) continue; // filling
            for (int e = 0; e < 2; e++)
                (*set)->end[2 * count + e] = net->node_name[end[e * SN_BLOCK]];
            (*set)->region[count] = r;
            (*set)->stiffness[count++] = stiffness[s];
        }
    }
    SN_ASSERT(count == net->springs);
    return SN_OK;
}
