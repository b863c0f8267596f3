// Turns the edges of a case into springs, and lists what touches each node.
// SPDX-License-Identifier: Apache-2.0
//
// Every region has springs of its own; an edge between two regions carries one of each. On the
// built-in blocks the stiffness is the class constant of sn_lattice_constants() times the part of a
// full turn that the cells around the edge fill. Elsewhere it follows from the volume of the cells,
//     k_e = 15 mu v_e / L_e^2,  v_e = sum over the cells around e of V / 6,
// whose sum of v_e is the volume of the body: were edges spread evenly over all directions, the
// shear modulus would be mu. How far a
// given mesh is from that is not checked here.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

/// An edge of a cell: one of six.
typedef struct edge_part {
    int low, high; // nodes
    int slot;      // of the cell
    double volume; // of the cell
    double turn;   // dihedral angle over a full turn
} edge_part;

static int compare_parts(const void *a, const void *b) {
    const edge_part *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->slot < q->slot ? -1 : p->slot > q->slot;
}

// angle between the faces of a tetrahedron that meet in the edge from a to b; p q the other corners
static double dihedral(const double *a, const double *b, const double *p, const double *q) {
    double e[3], l2 = 0, u[3], v[3], ue = 0, ve = 0, uv = 0, uu = 0, vv = 0;
    for (int k = 0; k < 3; k++) {
        e[k] = b[k] - a[k];
        u[k] = p[k] - a[k];
        v[k] = q[k] - a[k];
        l2 += e[k] * e[k];
        ue += u[k] * e[k];
        ve += v[k] * e[k];
    }
    for (int k = 0; k < 3; k++) {
        double x = u[k] - ue / l2 * e[k], y = v[k] - ve / l2 * e[k];
        uv += x * y;
        uu += x * x;
        vv += y * y;
    }
    return acos(fmax(-1.0, fmin(1.0, uv / sqrt(uu * vv))));
}

static void cell_parts(const sn_mesh *mesh, const sn_net *net, int e, edge_part *part) {
    static const int corner[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                     {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    const int *node = mesh->cell + 4 * e;
    for (int k = 0; k < 6; k++, part++) {
        const double *x[4];
        for (int a = 0; a < 4; a++) x[a] = mesh->node + 3 * node[corner[k][a]];
        int a = node[corner[k][0]], b = node[corner[k][1]];
        part->low = a < b ? a : b;
        part->high = a < b ? b : a;
        part->slot = net->cell_slot[e];
        part->volume = ((const double *)net->data[SN_DOUBLE].volume)[part->slot];
        part->turn = dihedral(x[0], x[1], x[2], x[3]) / (2.0 * 3.14159265358979323846);
    }
}

typedef struct constants {
    bool classes; // class constants, else the rule of volumes
    double h[3], axis[3], face[3], body;
} constants;

// constant of the class of an edge, over the shear modulus
static double class_constant(const constants *c, const double D[3]) {
    int kind = 0, along[3];
    for (int d = 0; d < 3; d++)
        if (fabs(D[d]) > 1e-6 * c->h[d]) along[kind++] = d;
    if (kind == 1) return c->axis[along[0]];
    if (kind == 3) return c->body;
    return c->face[along[0] == 0 && along[1] == 2 ? 2 : along[0]]; // xy yz zx
}

typedef struct spring {
    int low, high;
    double edge[3], length2, stiffness, volume;
} spring;

// gathers the parts of one edge; returns how many there are
static int gather(const sn_net *net, const sn_net_region *region, const constants *k,
                  const edge_part *part, int left, spring *s) {
    int n = 0;
    double turn = 0;
    *s = (spring){.low = part->low, .high = part->high};
    for (; n < left && part[n].low == s->low && part[n].high == s->high; n++) {
        s->volume += part[n].volume;
        turn += part[n].turn;
    }
    for (int d = 0; d < 3; d++) {
        s->edge[d] = net->node_position[3 * s->high + d] - net->node_position[3 * s->low + d];
        s->length2 += s->edge[d] * s->edge[d];
    }
    double shear = region->shear * region->stiffening;
    s->stiffness = k->classes ? shear * turn * class_constant(k, s->edge)
                              : 15.0 * shear * (s->volume / 6.0) / s->length2;
    return n;
}

static void store_spring(sn_net *net, int slot, const spring *s, double stiffness) {
    const size_t block = (size_t)slot / SN_BLOCK, lane = (size_t)slot % SN_BLOCK;
    sn_net_data *data = &net->data[SN_DOUBLE];
    net->spring_end[block * 2 * SN_BLOCK + lane] = s->low;
    net->spring_end[(block * 2 + 1) * SN_BLOCK + lane] = s->high;
    for (size_t d = 0; d < 3; d++)
        ((double *)data->edge)[(block * 3 + d) * SN_BLOCK + lane] = s->edge[d];
    ((double *)data->inverse)[slot] = 1.0 / s->length2;
    ((double *)data->stiffness)[slot] = stiffness;
    net->spring_volume[slot] = s->volume;
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

// sorts the parts of a region by edge: first by low node with buckets, then inside a bucket
static sn_status sorted_parts(const sn_mesh *mesh, const sn_net *net, int r, edge_part **parts,
                              int *count) {
    int *start = sn_alloc((size_t)net->nodes + 1, sizeof *start), cells = 0;
    edge_part *all = NULL, six[6];
    for (int e = 0; e < mesh->cell_count; e++) cells += mesh->region[e] == r;
    all = sn_alloc((size_t)cells * 6, sizeof *all);
    if (!start || !all) {
        sn_free(start);
        sn_free(all);
        return SN_E_MEMORY;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int e = 0; e < mesh->cell_count; e++) {
            if (mesh->region[e] != r) continue;
            cell_parts(mesh, net, e, six);
            for (int k = 0; k < 6; k++) {
                if (pass == 0)
                    start[six[k].low + 1]++;
                else
                    all[start[six[k].low]++] = six[k];
            }
        }
        if (pass == 0)
            for (int i = 0; i < net->nodes; i++) start[i + 1] += start[i];
    }
    // each start now stands at the end of its bucket
    for (int i = 0, from = 0; i < net->nodes; from = start[i++])
        qsort(all + from, (size_t)(start[i] - from), sizeof *all, compare_parts);
    sn_free(start);
    *parts = all;
    *count = cells * 6;
    return SN_OK;
}

static sn_status region_springs(const sn_mesh *mesh, sn_net *net, int r, const constants *k) {
    sn_net_region *region = &net->region[r];
    edge_part *part = NULL;
    int count, first = net->spring_blocks * SN_BLOCK, slot = first;
    sn_status status = sorted_parts(mesh, net, r, &part, &count);
    spring s;
    for (int i = 0; i < count && status == SN_OK;) {
        i += gather(net, region, k, part + i, count - i, &s);
        if (s.stiffness <= 0) continue;
        if (slot % SN_BLOCK == 0) {
            // room for half as much again, so that growing costs little
            int blocks = slot / SN_BLOCK;
            if (blocks == net->spring_blocks) {
                net->spring_blocks = blocks + 8 + blocks / 2;
                status = grow_springs(net, net->spring_blocks);
                if (status != SN_OK) break;
            }
        }
        store_spring(net, slot++, &s, s.stiffness);
    }
    sn_free(part);
    region->spring_block = first / SN_BLOCK;
    region->spring_count = slot - first;
    region->spring_blocks = (slot - first + SN_BLOCK - 1) / SN_BLOCK;
    net->spring_blocks = region->spring_block + region->spring_blocks;
    net->springs += region->spring_count;
    if (status != SN_OK || slot == first) return status;
    // the last spring again, without stiffness
    int last = slot - 1;
    const double *edge = (double *)net->data[SN_DOUBLE].edge;
    size_t block = (size_t)last / SN_BLOCK, lane = (size_t)last % SN_BLOCK;
    s.low = net->spring_end[block * 2 * SN_BLOCK + lane];
    s.high = net->spring_end[(block * 2 + 1) * SN_BLOCK + lane];
    s.length2 = 1.0 / ((double *)net->data[SN_DOUBLE].inverse)[last];
    for (size_t d = 0; d < 3; d++) s.edge[d] = edge[(block * 3 + d) * SN_BLOCK + lane];
    s.volume = 0;
    for (; slot < net->spring_blocks * SN_BLOCK; slot++) store_spring(net, slot, &s, 0.0);
    return SN_OK;
}

sn_status sn_net_build_springs(const sn_case *c, sn_net *net) {
    constants k = {0};
    if (c->has_shape && sn_lattice_constants(&c->shape, k.axis, k.face, &k.body)) {
        k.classes = true;
        for (int d = 0; d < 3; d++) k.h[d] = c->shape.size[d] / c->shape.cells[d];
    }
    for (int r = 0; r < net->region_count; r++) SN_TRY(region_springs(c->mesh, net, r, &k));
    return SN_OK;
}

//---- node lists ----------------------------------------------------------------------------------

// counts (item NULL) or fills the three lists of every node; `at` counts, then points into item
static void list_nodes(const sn_net *net, int *at, int *item) {
    const double *stiffness = net->data[SN_DOUBLE].stiffness, *volume = net->data[SN_DOUBLE].volume;
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        if (!(stiffness[s] > 0)) continue;
        for (int end = 0; end < 2; end++) {
            size_t k =
                ((size_t)(s / SN_BLOCK) * 2 + (size_t)end) * SN_BLOCK + (size_t)(s % SN_BLOCK);
            int *place = &at[3 * net->spring_end[k] + end];
            if (item)
                item[(*place)++] = s;
            else
                ++*place;
        }
    }
    if (net->rung == SN_RUNG_CENTRAL && !net->volume) return;
    for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) {
        if (!(volume[s] > 0)) continue;
        for (int a = 0; a < 4; a++) {
            int k = ((s / SN_BLOCK) * 4 + a) * SN_BLOCK + s % SN_BLOCK;
            int *place = &at[3 * net->cell_node[k] + 2];
            if (item)
                item[(*place)++] = k;
            else
                ++*place;
        }
    }
}

sn_status sn_net_build_nodes(sn_net *net) {
    const size_t lists = (size_t)net->nodes * 3;
    int *at = sn_alloc(lists + 1, sizeof *at);
    net->node_start = sn_alloc(lists + 1, sizeof *net->node_start);
    if (!at || !net->node_start) {
        sn_free(at);
        return SN_E_MEMORY;
    }
    list_nodes(net, at, NULL);
    for (size_t k = 0; k < lists; k++) net->node_start[k + 1] = net->node_start[k] + at[k];
    net->node_item = sn_alloc((size_t)net->node_start[lists], sizeof *net->node_item);
    if (!net->node_item) {
        sn_free(at);
        return SN_E_MEMORY;
    }
    memcpy(at, net->node_start, lists * sizeof *at);
    list_nodes(net, at, net->node_item);
    sn_free(at);
    return SN_OK;
}
