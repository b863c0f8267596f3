// Arranges springs in stars of SN_STAR around one node, and stars in blocks.
// SPDX-License-Identifier: Apache-2.0
//
// A star reads and writes its middle once for all its springs. Nodes take stars in the order of the
// curve, as many whole ones as their springs that are left make, those to earlier nodes first; what
// does not fill a star stays for the node at the other end. What is left after all makes stars with
// filling.
#include <string.h>

#include "springs/net.h"

/// Springs at each node, and who has taken them.
typedef struct star_lists {
    int *start, *item; ///< springs of each node, by the other end
    int *star;         ///< springs of the stars made so far, -1: filling (stars x SN_STAR)
    int stars;
    bool *used;
} star_lists;

static int other_end(const sn_spring *s, int node) {
    return s->end[0] == node ? s->end[1] : s->end[0];
}

static sn_status create_lists(int nodes, const sn_spring *spring, int count, star_lists *l) {
    l->start = sn_alloc((size_t)nodes + 2, sizeof *l->start);
    l->item = sn_alloc((size_t)count * 2, sizeof *l->item);
    l->star = sn_alloc((size_t)count * SN_STAR, sizeof *l->star);
    l->used = sn_alloc((size_t)count, sizeof *l->used);
    if (!l->start || !l->item || !l->star || !l->used) return SN_E_MEMORY;
    for (int k = 0; k < count; k++)
        for (int e = 0; e < 2; e++) l->start[spring[k].end[e] + 2]++;
    for (int i = 0; i < nodes; i++) l->start[i + 2] += l->start[i + 1];
    // springs come sorted by end 0, so all lists start with what leads to earlier nodes
    for (int e = 1; e >= 0; e--)
        for (int k = 0; k < count; k++) l->item[l->start[spring[k].end[e] + 1]++] = k;
    return SN_OK;
}

static void destroy_lists(star_lists *l) {
    sn_free(l->start);
    sn_free(l->item);
    sn_free(l->star);
    sn_free(l->used);
}

// stars around a node: whole ones, or all that is left
static void take_stars(star_lists *l, int node, bool whole) {
    int left = 0;
    for (int k = l->start[node]; k < l->start[node + 1]; k++) left += !l->used[l->item[k]];
    if (whole) left -= left % SN_STAR;
    for (int k = l->start[node]; left > 0; k++) {
        if (l->used[l->item[k]]) continue;
        int *star = l->star + l->stars++ * SN_STAR;
        for (int n = 0; n < SN_STAR; n++) {
            star[n] = -1;
            if (left == 0) continue;
            while (l->used[l->item[k]]) k++;
            star[n] = l->item[k];
            l->used[l->item[k]] = true;
            left--;
        }
    }
}

static void store_spring(sn_net *net, int slot, const sn_spring *s, int middle, bool filling) {
    const size_t block = (size_t)slot / SN_BLOCK, lane = (size_t)slot % SN_BLOCK;
    const double sign = s->end[0] == middle ? 1.0 : -1.0;
    sn_net_data *data = &net->data[SN_DOUBLE];
    net->spring_end[block * 2 * SN_BLOCK + lane] = middle;
    net->spring_end[(block * 2 + 1) * SN_BLOCK + lane] = other_end(s, middle);
    for (size_t d = 0; d < 3; d++)
        ((double *)data->edge)[(block * 3 + d) * SN_BLOCK + lane] = sign * s->edge[d];
    ((double *)data->inverse)[slot] = 1.0 / s->length2;
    ((double *)data->stiffness)[slot] = filling ? 0.0 : s->stiffness;
    net->spring_volume[slot] = filling ? 0.0 : s->volume;
}

// the node that all springs of a star have in common; the first end of a single one
static int middle_of(const sn_spring *spring, const int *star) {
    const sn_spring *s = &spring[star[0]];
    if (star[1] < 0) return s->end[0];
    const int *end = spring[star[1]].end;
    return s->end[0] == end[0] || s->end[0] == end[1] ? s->end[0] : s->end[1];
}

static void store_star(sn_net *net, int place, const sn_spring *spring, const int *star,
                       bool filling) {
    const int wide = SN_BLOCK / SN_STAR, middle = middle_of(spring, star);
    const int first = place / wide * SN_BLOCK + place % wide;
    for (int n = 0; n < SN_STAR; n++) {
        const sn_spring *s = &spring[star[n] < 0 ? star[0] : star[n]];
        store_spring(net, first + n * wide, s, middle, filling || star[n] < 0);
    }
}

static sn_status grow_springs(sn_net *net, int blocks) {
    sn_net_data *data = &net->data[SN_DOUBLE];
    const size_t slots = (size_t)blocks * SN_BLOCK;
    void *end = sn_resize(net->spring_end, slots * 2, sizeof(int));
    if (end) net->spring_end = end;
    void *edge = sn_resize(data->edge, slots * 3, sizeof(double));
    if (edge) data->edge = edge;
    void *inverse = sn_resize(data->inverse, slots, sizeof(double));
    if (inverse) data->inverse = inverse;
    void *stiffness = sn_resize(data->stiffness, slots, sizeof(double));
    if (stiffness) data->stiffness = stiffness;
    void *volume = sn_resize(net->spring_volume, slots, sizeof(double));
    if (volume) net->spring_volume = volume;
    return end && edge && inverse && stiffness && volume ? SN_OK : SN_E_MEMORY;
}

sn_status sn_net_place_springs(sn_net *net, sn_net_region *region, const sn_spring *spring,
                               int count) {
    const int wide = SN_BLOCK / SN_STAR;
    star_lists l = {0};
    sn_status status = create_lists(net->nodes, spring, count, &l);
    for (int whole = 1; whole >= 0 && status == SN_OK; whole--)
        for (int i = 0; i < net->nodes; i++) take_stars(&l, i, whole);
    region->spring_block = net->spring_blocks;
    region->spring_blocks = (l.stars + wide - 1) / wide;
    if (status == SN_OK) status = grow_springs(net, net->spring_blocks + region->spring_blocks);
    if (status == SN_OK) {
        const int first = net->spring_blocks * wide;
        for (int k = 0; k < region->spring_blocks * wide; k++) {
            const bool filling = k >= l.stars;
            const int place = filling ? k : sn_spread(k, l.stars, SN_TILE_BLOCKS * wide);
            store_star(net, first + place, spring, l.star + (filling ? l.stars - 1 : k) * SN_STAR,
                       filling);
        }
        net->spring_blocks += region->spring_blocks;
        net->springs += count;
    }
    destroy_lists(&l);
    return status;
}
