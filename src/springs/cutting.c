// What cuts need to know of a net: neighbours of cells, shares of cells in what they make up.
// SPDX-License-Identifier: Apache-2.0
//
// A cell is part of springs, fans, volume points, smoothed edges and loaded faces. A net keeps
// their sums; what a cell has in each of them is listed here, for nets that are cuttable.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"
#include "springs/cut.h"

//---- faces ---------------------------------------------------------------------------------------

static double third_of_area(const sn_mesh *mesh, const int node[3]) {
    double normal[3]; // twice the area long
    sn_triangle_normal(mesh, node, normal);
    return norm3(normal) / 6.0;
}

static sn_status list_neighbours(const sn_mesh *mesh, sn_cutting *k) {
    const size_t faces = (size_t)mesh->cell_count * 4;
    sn_faces all;
    k->neighbour = sn_alloc(faces, sizeof *k->neighbour);
    k->third = sn_alloc(faces, sizeof *k->third);
    if (!k->neighbour || !k->third) return SN_E_MEMORY;
    sn_status status = sn_faces_create(mesh, &all);
    for (int f = 0; f < 4 * mesh->cell_count && status == SN_OK; f++) {
        int node[3];
        sn_face_nodes(mesh, f, node);
        k->neighbour[f] = all.other[f] < 0 ? -1 : all.other[f] / 4;
        k->third[f] = third_of_area(mesh, node);
    }
    sn_faces_destroy(&all);
    return status;
}

//---- fans ----------------------------------------------------------------------------------------

/// A cell by its nodes.
typedef struct named_cell {
    int node[4]; ///< rising
    int slot;
} named_cell;

static int compare_cells(const void *a, const void *b) {
    const named_cell *p = a, *q = b;
    for (int k = 0; k < 4; k++)
        if (p->node[k] != q->node[k]) return p->node[k] < q->node[k] ? -1 : 1;
    return 0;
}

static named_cell name_cell(int a, int b, int c, int d) {
    named_cell cell = {.node = {a, b, c, d}};
    for (int i = 1; i < 4; i++)
        for (int j = i; j > 0 && cell.node[j - 1] > cell.node[j]; j--) {
            int swap = cell.node[j];
            cell.node[j] = cell.node[j - 1];
            cell.node[j - 1] = swap;
        }
    return cell;
}

// the cells of the fans of one tile
static void name_fans(const sn_net *net, int tile, const named_cell *cell, int *slot) {
    const sn_tiles *t = &net->fan_tiles;
    const sn_tile_place *place = &t->place[tile];
    const int corners = 2 + place->ring, members = place->closed ? place->ring : place->ring - 1;
    for (int b = 0; b < place->blocks; b++)
        for (int k = 0; k < members; k++)
            for (int i = 0; i < SN_FAN_BLOCK; i++) {
                const size_t row = place->corner + (size_t)(b * corners * SN_FAN_BLOCK + i);
                const int next = 2 + (k + 1) % place->ring, at[4] = {0, 1, 2 + k, next};
                int node[4];
                for (int a = 0; a < 4; a++)
                    node[a] =
                        t->node[t->start[tile] + t->corner[row + (size_t)at[a] * SN_FAN_BLOCK] / 4];
                const named_cell wanted = name_cell(node[0], node[1], node[2], node[3]);
                const named_cell *found =
                    bsearch(&wanted, cell, (size_t)net->cells, sizeof *cell, compare_cells);
                if (found) slot[row + (size_t)k * SN_FAN_BLOCK] = found->slot; // else filling
            }
}

static sn_status list_fan_slots(const sn_mesh *mesh, const sn_net *net, sn_cutting *k) {
    const sn_tiles *t = &net->fan_tiles;
    named_cell *cell = sn_alloc((size_t)net->cells, sizeof *cell);
    k->fan_slot = sn_alloc(t->corner_count, sizeof *k->fan_slot);
    const bool all = cell && k->fan_slot;
    if (all) {
        for (int e = 0; e < net->cells; e++) {
            const int *node = mesh->cell + 4 * e;
            cell[e] = name_cell(node[0], node[1], node[2], node[3]);
            cell[e].slot = net->cell_slot[e];
        }
        qsort(cell, (size_t)net->cells, sizeof *cell, compare_cells);
        for (size_t q = 0; q < t->corner_count; q++) k->fan_slot[q] = -1;
        for (int tile = 0; tile < t->count; tile++) name_fans(net, tile, cell, k->fan_slot);
    }
    sn_free(cell);
    return all ? SN_OK : SN_E_MEMORY;
}

//---- springs -------------------------------------------------------------------------------------

// angle at the edge from node a to node b of a cell, over a full turn
static double turn_of(const sn_net *net, const int *node, int a, int b) {
    double e[3], u[2][3];
    int others = 0;
    for (int k = 0; k < 3; k++)
        e[k] = net->node_position[3 * b + k] - net->node_position[3 * a + k];
    for (int c = 0; c < 4; c++) {
        if (node[c] == a || node[c] == b) continue;
        double *x = u[others++];
        for (int k = 0; k < 3; k++)
            x[k] = net->node_position[3 * node[c] + k] - net->node_position[3 * a + k];
        const double along = dot3(x, e) / dot3(e, e);
        for (int k = 0; k < 3; k++) x[k] -= along * e[k];
    }
    double n[3];
    cross3(u[0], u[1], n);
    return atan2(norm3(n), dot3(u[0], u[1])) / (2.0 * 3.14159265358979323846);
}

static sn_status list_weights(const sn_mesh *mesh, const sn_net *net, sn_cutting *k) {
    if (net->rung != SN_RUNG_CENTRAL) return SN_OK;
    const double *volume = net->data[SN_DOUBLE].volume;
    const size_t slots = (size_t)net->cell_blocks * SN_BLOCK;
    k->share = sn_alloc((size_t)net->spring_share_start[slots], sizeof *k->share);
    k->spring_whole = sn_alloc((size_t)net->spring_blocks * SN_BLOCK, sizeof *k->spring_whole);
    if (!k->share || !k->spring_whole) return SN_E_MEMORY;
    for (int e = 0; e < net->cells; e++) {
        const int slot = net->cell_slot[e];
        for (int q = net->spring_share_start[slot]; q < net->spring_share_start[slot + 1]; q++) {
            const int s = net->spring_share[q];
            const int *end = net->spring_end + s / SN_BLOCK * 2 * SN_BLOCK + s % SN_BLOCK;
            // as springs/edges.c puts springs together
            k->share[q] = net->by_turn ? turn_of(net, mesh->cell + 4 * e, end[0], end[SN_BLOCK])
                                       : cbrt(volume[slot]);
            k->spring_whole[s] += k->share[q];
        }
    }
    return SN_OK;
}

//---- loads ---------------------------------------------------------------------------------------

static sn_status list_faces(const sn_mesh *mesh, const sn_net *net, const sn_load *from,
                            const sn_net_load *load, sn_cutting_load *to) {
    const sn_surface *s = &mesh->surface[from->surface];
    const size_t faces = (size_t)s->face_count;
    to->faces = s->face_count;
    to->cell = sn_alloc(faces, sizeof *to->cell);
    to->place = sn_alloc(faces * 3, sizeof *to->place);
    to->third = sn_alloc(faces, sizeof *to->third);
    int *place = sn_alloc((size_t)net->nodes, sizeof *place);
    const bool all = to->cell && to->place && to->third && place;
    for (int k = 0; all && load->kind == SN_LOAD_TRACTION && k < load->count; k++)
        place[load->node[k]] = k;
    for (int f = 0; all && f < s->face_count; f++) {
        to->cell[f] = s->cell[f];
        to->third[f] = third_of_area(mesh, s->face + 3 * f);
        for (int a = 0; a < 3; a++) to->place[3 * f + a] = place[s->face[3 * f + a]];
    }
    sn_free(place);
    return all ? SN_OK : SN_E_MEMORY;
}

static sn_status list_loads(const sn_case *c, const sn_net *net, sn_cutting *k) {
    k->load = sn_alloc((size_t)net->load_count, sizeof *k->load);
    if (!k->load) return SN_E_MEMORY;
    k->load_count = net->load_count;
    for (int l = 0; l < net->load_count; l++) {
        const sn_load *from = &c->load[net->load[l].name];
        sn_cutting_load *to = &k->load[l];
        memcpy(to->vector, from->vector, sizeof to->vector);
        if (from->kind != SN_LOAD_FORCE) {
            SN_TRY(list_faces(c->mesh, net, from, &net->load[l], to));
            continue;
        }
        double weight[4];
        to->faces = 1;
        to->cell = sn_alloc(1, sizeof *to->cell);
        if (!to->cell) return SN_E_MEMORY;
        SN_TRY(sn_mesh_locate(c->mesh, from->point, to->cell, weight));
    }
    return SN_OK;
}

//---- cuts of the case ----------------------------------------------------------------------------

/// A cut by its time; of equal ones that which the case names first.
typedef struct timed_cut {
    double at;
    int number;
} timed_cut;

static int compare_cuts(const void *a, const void *b) {
    const timed_cut *p = a, *q = b;
    if (p->at != q->at) return p->at < q->at ? -1 : 1;
    return p->number - q->number;
}

static sn_status add_cut(const sn_case *c, const timed_cut *cut, int n, sn_cutting *k) {
    int *cells = NULL, count, before = k->start[n];
    SN_TRY(sn_case_cut_cells(c, cut->number, &cells, &count));
    int *list = sn_resize(k->cell, (size_t)(before + count), sizeof *list);
    if (list) {
        k->cell = list;
        if (count > 0) memcpy(list + before, cells, (size_t)count * sizeof *list);
        k->at[n] = cut->at;
        k->start[n + 1] = before + count;
    }
    sn_free(cells);
    return list ? SN_OK : SN_E_MEMORY;
}

static sn_status list_cuts(const sn_case *c, sn_cutting *k) {
    const size_t count = (size_t)c->cut_count;
    timed_cut *cut = sn_alloc(count, sizeof *cut);
    k->at = sn_alloc(count, sizeof *k->at);
    k->start = sn_alloc(count + 1, sizeof *k->start);
    sn_status status = cut && k->at && k->start ? SN_OK : SN_E_MEMORY;
    for (int n = 0; n < c->cut_count && status == SN_OK; n++) cut[n] = (timed_cut){c->cut[n].at, n};
    if (status == SN_OK && count > 0) qsort(cut, count, sizeof *cut, compare_cuts);
    for (int n = 0; n < c->cut_count && status == SN_OK; n++) status = add_cut(c, &cut[n], n, k);
    if (status == SN_OK) k->count = c->cut_count;
    sn_free(cut);
    return status;
}

//---- whole ---------------------------------------------------------------------------------------

sn_status sn_cutting_create(const sn_case *c, sn_net *net) {
    if (c->springs_given && net->rung == SN_RUNG_CENTRAL)
        return sn_fail(SN_E_UNSUPPORTED,
                       "springs: cells cannot be cut from springs that are given one by one, as "
                       "none of these belongs to a cell; leave `constants` or the cuts away");
    sn_cutting *k = net->cutting = sn_alloc(1, sizeof *k); // a net that fails is destroyed whole
    if (!k) return SN_E_MEMORY;
    k->penalty = sn_case_penalty(c);
    SN_TRY(list_neighbours(c->mesh, k));
    SN_TRY(list_fan_slots(c->mesh, net, k));
    SN_TRY(list_weights(c->mesh, net, k));
    SN_TRY(list_loads(c, net, k));
    return list_cuts(c, k);
}

void sn_cutting_destroy(sn_cutting *k) {
    if (!k) return;
    for (int l = 0; l < k->load_count; l++) {
        sn_free(k->load[l].cell);
        sn_free(k->load[l].place);
        sn_free(k->load[l].third);
    }
    void *all[] = {k->neighbour, k->third, k->fan_slot, k->share, k->spring_whole,
                   k->load,      k->at,    k->start,    k->cell};
    for (size_t n = 0; n < sizeof all / sizeof *all; n++) sn_free(all[n]);
    sn_free(k);
}

uint64_t sn_cutting_mix(uint64_t hash, const sn_net *net) {
    const sn_cutting *k = net->cutting;
    if (!k || k->count == 0) return hash;
    hash = sn_hash(hash, k->at, (size_t)k->count * sizeof *k->at);
    hash = sn_hash(hash, k->start, ((size_t)k->count + 1) * sizeof *k->start);
    return sn_hash(hash, k->cell, (size_t)k->start[k->count] * sizeof *k->cell);
}

double sn_cutting_next(const sn_net *net, double t) {
    const sn_cutting *k = net->cutting;
    for (int n = 0; k && n < k->count; n++)
        if (k->at[n] > t) return k->at[n];
    return (double)INFINITY;
}
