// Numbers the nodes of a net along a space-filling curve.
// SPDX-License-Identifier: Apache-2.0
//
// Source: Skilling (2004), Programming the Hilbert curve, AIP Conf. Proc. 707, 381.
//
// Nodes that are near each other in the body come to stand near each other in memory, so that the
// nodes of a tile of cells or springs fit the first cache. Cells take the place of their middle on
// the same curve.
#include <stdlib.h>

#include "springs/net.h"

enum { CURVE_BITS = 16 };

// place on the Hilbert curve of a point of the cube of side 2^CURVE_BITS
static uint64_t curve_place(uint32_t x[3]) {
    uint32_t t = 0;
    for (uint32_t q = 1u << (CURVE_BITS - 1); q > 1; q >>= 1) {
        const uint32_t p = q - 1;
        for (int i = 0; i < 3; i++) {
            if (x[i] & q) {
                x[0] ^= p;
            } else {
                uint32_t swap = (x[0] ^ x[i]) & p;
                x[0] ^= swap;
                x[i] ^= swap;
            }
        }
    }
    for (int i = 1; i < 3; i++) x[i] ^= x[i - 1];
    for (uint32_t q = 1u << (CURVE_BITS - 1); q > 1; q >>= 1)
        if (x[2] & q) t ^= q - 1;
    for (int i = 0; i < 3; i++) x[i] ^= t;
    uint64_t place = 0;
    for (int bit = CURVE_BITS - 1; bit >= 0; bit--)
        for (int i = 0; i < 3; i++) place = place << 1 | (x[i] >> bit & 1);
    return place;
}

typedef struct curve_item {
    uint64_t place;
    int name;
} curve_item;

static int compare_items(const void *a, const void *b) {
    const curve_item *p = a, *q = b;
    if (p->place != q->place) return p->place < q->place ? -1 : 1;
    return (p->name > q->name) - (p->name < q->name);
}

// order[k]: which of the points (count x 3) comes k-th
static sn_status sort_points(const sn_mesh *mesh, const double *point, int count, int *order) {
    curve_item *item = sn_alloc((size_t)count, sizeof *item);
    if (!item) return SN_E_MEMORY;
    double low[3], side = 0;
    for (int d = 0; d < 3; d++) {
        double high = low[d] = mesh->node[d];
        for (int i = 0; i < mesh->node_count; i++) {
            double x = mesh->node[3 * i + d];
            low[d] = x < low[d] ? x : low[d];
            high = x > high ? x : high;
        }
        side = high - low[d] > side ? high - low[d] : side;
    }
    const double scale = side > 0 ? ((1 << CURVE_BITS) - 1) / side : 0;
    for (int i = 0; i < count; i++) {
        uint32_t x[3];
        for (int d = 0; d < 3; d++) x[d] = (uint32_t)((point[3 * i + d] - low[d]) * scale);
        item[i] = (curve_item){curve_place(x), i};
    }
    qsort(item, (size_t)count, sizeof *item, compare_items);
    for (int k = 0; k < count; k++) order[k] = item[k].name;
    sn_free(item);
    return SN_OK;
}

sn_status sn_net_cell_order(const sn_mesh *mesh, int *order) {
    double *middle = sn_alloc((size_t)mesh->cell_count * 3, sizeof *middle);
    if (!middle) return SN_E_MEMORY;
    for (int e = 0; e < mesh->cell_count; e++)
        for (int a = 0; a < 4; a++)
            for (int d = 0; d < 3; d++)
                middle[3 * e + d] += 0.25 * mesh->node[3 * mesh->cell[4 * e + a] + d];
    sn_status status = sort_points(mesh, middle, mesh->cell_count, order);
    sn_free(middle);
    return status;
}

sn_status sn_net_order_nodes(const sn_mesh *mesh, sn_mesh **ordered, int *name) {
    SN_TRY(sn_mesh_copy(mesh, ordered));
    sn_mesh *m = *ordered;
    int *place = sn_alloc((size_t)mesh->node_count, sizeof *place);
    sn_status status = place ? sort_points(mesh, mesh->node, mesh->node_count, name) : SN_E_MEMORY;
    if (status == SN_OK) {
        for (int k = 0; k < mesh->node_count; k++) {
            place[name[k]] = k;
            for (int d = 0; d < 3; d++) m->node[3 * k + d] = mesh->node[3 * name[k] + d];
        }
        for (int k = 0; k < 4 * mesh->cell_count; k++) m->cell[k] = place[mesh->cell[k]];
        for (int s = 0; s < mesh->surface_count; s++)
            for (int k = 0; k < 3 * mesh->surface[s].face_count; k++)
                m->surface[s].face[k] = place[mesh->surface[s].face[k]];
    } else {
        sn_mesh_destroy(m);
        *ordered = NULL;
    }
    sn_free(place);
    return status;
}
