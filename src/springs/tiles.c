// Cuts blocks of springs, cells and fans into tiles and lists what each node sums.
// SPDX-License-Identifier: Apache-2.0
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

/// What cutting needs to know of one kind of items of one region.
typedef struct tile_source {
    int region;
    int width, corners; ///< of a block
    int ring;           ///< of fans
    bool closed;
    int first, blocks;   ///< of the net; the arrays start there
    int most;            ///< blocks of a tile
    const int *node;     ///< (blocks x corners x width)
    const bool *filling; ///< (blocks x width)
    bool flat;           ///< filling has all its corners at one node
    const int *point;    ///< Nullable: volume point of each node of the net (nodes)
} tile_source;

/// Nodes met so far in the tile under way.
typedef struct tile_marks {
    int *place; ///< in `met`; -1: not met   (nodes)
    int count;
    int met[SN_TILE_NODES]; ///< nodes
    int point[SN_TILE_NODES];
} tile_marks;

static int compare_met(const void *a, const void *b) {
    const int *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

// adds the nodes of a block; false, with nothing added, where they are too many for the tile
static bool add_block(const tile_source *s, int block, tile_marks *m) {
    const int before = m->count, *node = s->node + block * s->corners * s->width;
    for (int k = 0; k < s->corners * s->width; k++) {
        if (s->filling[block * s->width + k % s->width] || m->place[node[k]] >= 0) continue;
        if (m->count == SN_TILE_NODES) {
            while (m->count > before) m->place[m->met[--m->count]] = -1;
            return false;
        }
        m->place[node[k]] = m->count;
        m->met[m->count++] = node[k];
    }
    return true;
}

static void set_corners(const tile_source *s, int block, const tile_marks *m, uint16_t *corner) {
    const int *node = s->node + block * s->corners * s->width;
    for (int k = 0; k < s->corners * s->width; k++) {
        const bool flat = s->flat && s->filling[block * s->width + k % s->width];
        corner[k] = (uint16_t)(flat ? 0 : 4 * m->place[node[k]]);
    }
}

// room for one more tile
static sn_status grow_tiles(sn_tiles *t, const tile_source *s, int nodes, size_t corners) {
    const size_t tiles = (size_t)t->count + 1, all = (size_t)t->start[t->count] + (size_t)nodes;
    sn_tile_place *place = sn_resize(t->place, tiles, sizeof *place);
    if (place) t->place = place;
    int *start = sn_resize(t->start, tiles + 1, sizeof *start);
    if (start) t->start = start;
    int *node = sn_resize(t->node, all, sizeof *node);
    if (node) t->node = node;
    int *point = s->point ? sn_resize(t->point, all, sizeof *point) : NULL;
    if (point) t->point = point;
    uint16_t *corner = sn_resize(t->corner, t->corner_count + corners, sizeof *corner);
    if (corner) t->corner = corner;
    return place && start && node && corner && (point || !s->point) ? SN_OK : SN_E_MEMORY;
}

// makes a tile of blocks [first, last) of the source and forgets its marks
static sn_status close_tile(const tile_source *s, int first, int last, tile_marks *m, sn_tiles *t) {
    const size_t corners = (size_t)(s->corners * s->width);
    SN_TRY(grow_tiles(t, s, m->count, (size_t)(last - first) * corners));
    const int from = t->start[t->count];
    qsort(m->met, (size_t)m->count, sizeof *m->met, compare_met); // near in memory, near here
    for (int k = 0; k < m->count; k++) m->place[m->met[k]] = k;
    t->place[t->count] = (sn_tile_place){.region = s->region,
                                         .block = s->first + first,
                                         .blocks = last - first,
                                         .ring = s->ring,
                                         .closed = s->closed,
                                         .corner = t->corner_count};
    for (int b = first; b < last; b++, t->corner_count += corners)
        set_corners(s, b, m, t->corner + t->corner_count);
    for (int k = 0; k < m->count; k++) {
        t->node[from + k] = m->met[k];
        if (s->point) t->point[from + k] = s->point[m->met[k]];
        m->place[m->met[k]] = -1;
    }
    t->start[++t->count] = from + m->count;
    m->count = 0;
    return SN_OK;
}

static sn_status cut(const tile_source *s, tile_marks *m, sn_tiles *t) {
    int first = 0;
    if (!t->start && !(t->start = sn_alloc(1, sizeof *t->start))) return SN_E_MEMORY;
    for (int b = 0; b < s->blocks; b++) {
        if (b - first < s->most && add_block(s, b, m)) continue;
        SN_TRY(close_tile(s, first, b, m, t));
        first = b--; // this block again, in a new tile
    }
    return first < s->blocks ? close_tile(s, first, s->blocks, m, t) : SN_OK;
}

// rest positions of the nodes of tiles, from the first node of each
static sn_status set_positions(const sn_net *net, sn_tiles *t) {
    const size_t count = (size_t)sn_tiles_entries(t) * 4;
    double *position = t->position[SN_DOUBLE] = sn_alloc(count, sizeof *position);
    if (!position) return SN_E_MEMORY;
    for (int k = 0; k < t->count; k++)
        for (int i = t->start[k]; i < t->start[k + 1]; i++)
            for (int d = 0; d < 3; d++)
                position[4 * i + d] = net->node_position[3 * t->node[i] + d] -
                                      net->node_position[3 * t->node[t->start[k]] + d];
    return SN_OK;
}

static sn_status cut_cells(const sn_net *net, tile_source *s, tile_marks *m, sn_tiles *t) {
    const sn_net_region *g = &net->region[s->region];
    const double *volume = (const double *)net->data[SN_DOUBLE].volume + g->cell_block * SN_BLOCK;
    bool *filling = sn_alloc((size_t)g->cell_blocks * SN_BLOCK, sizeof *filling);
    if (!filling) return SN_E_MEMORY;
    for (int k = 0; k < g->cell_blocks * SN_BLOCK; k++) filling[k] = !(volume[k] > 0);
    s->width = SN_BLOCK;
    s->corners = 4;
    s->first = g->cell_block;
    s->blocks = g->cell_blocks;
    s->most = SN_TILE_BLOCKS;
    s->node = net->cell_node + g->cell_block * 4 * SN_BLOCK;
    s->filling = filling;
    s->flat = true;
    sn_status status = cut(s, m, t);
    sn_free(filling);
    return status;
}

static sn_status cut_stars(const sn_net *net, tile_source *s, tile_marks *m, sn_tiles *t) {
    const sn_net_region *g = &net->region[s->region];
    const int width = SN_BLOCK / SN_STAR, corners = 1 + SN_STAR;
    int *node = sn_alloc((size_t)(g->spring_blocks * corners * width), sizeof *node);
    bool *filling = sn_alloc((size_t)(g->spring_blocks * width), sizeof *filling);
    sn_status status = node && filling ? SN_OK : SN_E_MEMORY;
    for (int b = 0; b < g->spring_blocks && status == SN_OK; b++) {
        const int *end = net->spring_end + (g->spring_block + b) * 2 * SN_BLOCK;
        int *to = node + b * corners * width;
        memcpy(to, end, (size_t)width * sizeof *to);
        memcpy(to + width, end + SN_BLOCK, SN_BLOCK * sizeof *to);
    }
    s->width = width;
    s->corners = corners;
    s->first = g->spring_block;
    s->blocks = g->spring_blocks;
    s->most = SN_TILE_BLOCKS;
    s->node = node;
    s->filling = filling; // none: what fills has no stiffness
    if (status == SN_OK) status = cut(s, m, t);
    sn_free(node);
    sn_free(filling);
    return status;
}

// `count` fans of one size and kind
static sn_status cut_class(tile_source *s, const sn_fan *fan, int count, tile_marks *m,
                           sn_tiles *t) {
    s->width = SN_FAN_BLOCK;
    s->corners = 2 + fan->ring;
    s->ring = fan->ring;
    s->closed = fan->closed;
    s->flat = true;
    s->most = SN_TILE_BLOCKS * SN_BLOCK / SN_FAN_BLOCK;
    s->blocks = (count + SN_FAN_BLOCK - 1) / SN_FAN_BLOCK;
    const int slots = s->blocks * SN_FAN_BLOCK;
    int *node = sn_alloc((size_t)(slots * s->corners), sizeof *node);
    bool *filling = sn_alloc((size_t)slots, sizeof *filling);
    sn_status status = node && filling ? SN_OK : SN_E_MEMORY;
    for (int k = 0; k < slots && status == SN_OK; k++) {
        const int slot = k < count ? sn_spread(k, count, SN_BLOCK) : k;
        filling[slot] = k >= count;
        for (int a = 0; a < s->corners; a++)
            node[(slot / SN_FAN_BLOCK * s->corners + a) * SN_FAN_BLOCK + slot % SN_FAN_BLOCK] =
                fan[k < count ? k : count - 1].node[a];
    }
    s->node = node;
    s->filling = filling;
    if (status == SN_OK) status = cut(s, m, t);
    sn_free(node);
    sn_free(filling);
    return status;
}

static sn_status cut_fans(const sn_mesh *mesh, tile_source *s, tile_marks *m, sn_tiles *t) {
    sn_fan *fan = NULL;
    int count = 0;
    sn_status status = sn_net_list_fans(mesh, s->region, &fan, &count);
    for (int k = 0, end; k < count && status == SN_OK; k = end) {
        for (end = k;
             end < count && fan[end].ring == fan[k].ring && fan[end].closed == fan[k].closed;
             end++) {
        }
        status = cut_class(s, fan + k, end - k, m, t);
    }
    sn_free(fan);
    return status;
}

// volume point of each node, as far as the region has one
static void find_points(const sn_net *net, const sn_net_region *g, int *point) {
    for (int k = g->point_block * SN_BLOCK; k < (g->point_block + g->point_blocks) * SN_BLOCK; k++)
        if (net->point_node[k] >= 0) point[net->point_node[k]] = k;
}

static sn_status cut_region(const sn_mesh *mesh, sn_net *net, int r, int *point, tile_marks *m) {
    const sn_net_region *g = &net->region[r];
    if (net->volume) find_points(net, g, point);
    tile_source s = {.region = r};
    if (net->rung == SN_RUNG_CENTRAL) SN_TRY(cut_stars(net, &s, m, &net->spring_tiles));
    if (sn_region_law_blocks(net, g) > 0) {
        s = (tile_source){.region = r, .point = net->volume ? point : NULL};
        SN_TRY(cut_cells(net, &s, m, &net->cell_tiles));
    }
    if (!net->volume) return SN_OK;
    s = (tile_source){.region = r, .point = point};
    return cut_fans(mesh, &s, m, &net->fan_tiles);
}

static sn_status cut_all(const sn_mesh *mesh, sn_net *net) {
    tile_marks *m = sn_alloc(1, sizeof *m);
    int *point = sn_alloc((size_t)net->nodes, sizeof *point);
    if (m) m->place = sn_alloc((size_t)net->nodes, sizeof *m->place);
    sn_status status = m && m->place && point ? SN_OK : SN_E_MEMORY;
    for (int i = 0; i < net->nodes && status == SN_OK; i++) m->place[i] = -1;
    for (int r = 0; r < net->region_count && status == SN_OK; r++)
        status = cut_region(mesh, net, r, point, m);
    if (m) sn_free(m->place);
    sn_free(m);
    sn_free(point);
    if (status == SN_OK) status = set_positions(net, &net->spring_tiles);
    if (status == SN_OK) status = set_positions(net, &net->cell_tiles);
    return status == SN_OK ? set_positions(net, &net->fan_tiles) : status;
}

// entries of tiles by owner (nodes or volume points)
static sn_status list_entries(const int *owner, int entries, int owners, int **start, int **item) {
    int *from = *start = sn_alloc((size_t)owners + 1, sizeof *from);
    int *list = *item = sn_alloc((size_t)entries, sizeof *list);
    int *at = sn_alloc((size_t)owners + 1, sizeof *at);
    if (from && list && at) {
        for (int k = 0; k < entries; k++) from[owner[k] + 1]++;
        for (int i = 0; i < owners; i++) from[i + 1] += from[i];
        memcpy(at, from, ((size_t)owners + 1) * sizeof *at);
        for (int k = 0; k < entries; k++) list[at[owner[k]]++] = k;
    }
    bool all = from && list && at;
    sn_free(at);
    return all ? SN_OK : SN_E_MEMORY;
}

sn_status sn_net_build_tiles(const sn_case *c, sn_net *net) {
    SN_TRY(cut_all(c->mesh, net));
    // fans give forces of their own only where cells do not
    const sn_tiles *fans = &net->fan_tiles;
    const sn_tiles *const kind[] = {&net->spring_tiles, net->rung == SN_RUNG_CENTRAL ? fans : NULL,
                                    &net->cell_tiles};
    int first[4] = {0};
    for (int k = 0; k < 3; k++) first[k + 1] = first[k] + (kind[k] ? sn_tiles_entries(kind[k]) : 0);
    const int all = net->part_count = first[3];
    net->fan_part = first[1];
    net->cell_part = first[2];
    int *owner = sn_alloc((size_t)all, sizeof *owner);
    if (!owner) return SN_E_MEMORY;
    for (int k = 0; k < 3; k++)
        for (int i = first[k]; i < first[k + 1]; i++) owner[i] = kind[k]->node[i - first[k]];
    sn_status status = list_entries(owner, all, net->nodes, &net->node_start, &net->node_item);
    sn_free(owner);
    if (status == SN_OK && net->volume)
        status = list_entries(fans->point, sn_tiles_entries(fans), net->point_blocks * SN_BLOCK,
                              &net->point_start, &net->point_item);
    return status;
}

void sn_tiles_destroy(sn_tiles *t) {
    void *all[] = {t->place,  t->start,       t->node,       t->point,
                   t->corner, t->position[0], t->position[1]};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
}
