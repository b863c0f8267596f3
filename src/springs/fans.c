// Groups the cells of a net around edges.
// SPDX-License-Identifier: Apache-2.0
//
// A cell joins a fan around its longest edge: in the blocks of the built-in shapes all six cells of
// a cube share their longest edge, and on other meshes the longest edges gather most cells too.
// Where two edges are equally long, the first that is met takes the cell.
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

/// A cell at one of its longest edges; the corners low high one two are positively oriented.
typedef struct fan_part {
    int low, high, one, two;
    int cell;
} fan_part;

static int compare_parts(const void *a, const void *b) {
    const fan_part *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return (p->cell > q->cell) - (p->cell < q->cell);
}

// appends a cell at its longest edges
static int add_parts(const sn_mesh *mesh, int cell, fan_part *part) {
    static const int corner[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                     {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}; // even
    const int *node = mesh->cell + 4 * cell;
    double length2[6], most = 0;
    int count = 0;
    for (int k = 0; k < 6; k++) {
        const double *a = mesh->node + 3 * node[corner[k][0]];
        const double *b = mesh->node + 3 * node[corner[k][1]];
        length2[k] = 0;
        for (int d = 0; d < 3; d++) length2[k] += (b[d] - a[d]) * (b[d] - a[d]);
        most = length2[k] > most ? length2[k] : most;
    }
    for (int k = 0; k < 6; k++) {
        if (length2[k] < most * (1 - 1e-6)) continue;
        int i = node[corner[k][0]], j = node[corner[k][1]];
        int one = node[corner[k][2]], two = node[corner[k][3]];
        part[count++] = i < j ? (fan_part){i, j, one, two, cell} : (fan_part){j, i, two, one, cell};
    }
    return count;
}

// takes the longest run of `count` parts of one edge that starts at part k
static void follow(fan_part *part, int count, int k, bool *used, sn_fan *fan) {
    *fan = (sn_fan){.node = {part[k].low, part[k].high, part[k].one, part[k].two}, .ring = 2};
    used[part[k].cell] = true;
    for (int j = 0; j < count; j++) {
        if (used[part[j].cell] || part[j].one != fan->node[1 + fan->ring]) continue;
        if (part[j].two == fan->node[2]) {
            used[part[j].cell] = true;
            fan->closed = true;
            return;
        }
        if (fan->ring == SN_FAN_RING) return;
        fan->node[2 + fan->ring++] = part[j].two;
        used[part[j].cell] = true;
        j = -1; // from the start again, for the next
    }
}

// whether another free part of the edge leads to part k
static bool led_to(const fan_part *part, int count, int k, const bool *used) {
    for (int j = 0; j < count; j++)
        if (!used[part[j].cell] && part[j].two == part[k].one) return true;
    return false;
}

static int edge_fans(fan_part *part, int count, bool *used, sn_fan *fan) {
    int made = 0;
    for (int open = 1; open >= 0; open--) // open runs from their starts, then rings
        for (int k = 0; k < count; k++)
            if (!used[part[k].cell] && !(open && led_to(part, count, k, used)))
                follow(part, count, k, used, &fan[made++]);
    return made;
}

static int compare_fans(const void *a, const void *b) {
    const sn_fan *p = a, *q = b;
    if (p->ring != q->ring) return p->ring > q->ring ? -1 : 1;
    if (p->closed != q->closed) return p->closed ? -1 : 1;
    for (int k = 0; k < 4; k++)
        if (p->node[k] != q->node[k]) return p->node[k] < q->node[k] ? -1 : 1;
    return 0;
}

sn_status sn_net_list_fans(const sn_mesh *mesh, int region, sn_fan **fans, int *count) {
    fan_part *part = sn_alloc((size_t)mesh->cell_count * 6, sizeof *part);
    bool *used = sn_alloc((size_t)mesh->cell_count, sizeof *used);
    *fans = sn_alloc((size_t)mesh->cell_count, sizeof **fans);
    *count = 0;
    int parts = 0;
    const bool all = part && used && *fans;
    for (int e = 0; all && e < mesh->cell_count; e++)
        if (mesh->region[e] == region) parts += add_parts(mesh, e, part + parts);
    if (all) qsort(part, (size_t)parts, sizeof *part, compare_parts);
    for (int k = 0, end; all && k < parts; k = end) {
        for (end = k; end < parts && part[end].low == part[k].low && part[end].high == part[k].high;
             end++) {
        }
        *count += edge_fans(part + k, end - k, used, *fans + *count);
    }
    if (all) qsort(*fans, (size_t)*count, sizeof **fans, compare_fans);
    sn_free(part);
    sn_free(used);
    return all ? SN_OK : SN_E_MEMORY;
}
