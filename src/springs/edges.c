// Turns the edges of a case into springs.
// SPDX-License-Identifier: Apache-2.0
//
// Every region has springs of its own; an edge between two regions carries one of each. On the
// built-in blocks the stiffness is the class constant of sn_lattice_constants() times the part of a
// full turn that the cells around the edge fill. Elsewhere it is
//     k_e = s mu sum over the cells around e of (6 sqrt2 V)^(1/3),
// the edges of regular tetrahedra of the cells' volumes, as Lloyd, Szekely and Harders have it
// (IEEE Trans. Vis. Comput. Graph. 13 (2007) 1081), with a scale s common to the region from one
// virtual test (springs/relaxed.c). How far that is from the continuum on a given mesh is not
// checked here.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

static int compare_parts(const void *a, const void *b) {
    const sn_edge_part *p = a, *q = b;
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

static void cell_parts(const sn_mesh *mesh, const sn_net *net, int e, sn_edge_part *part) {
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
        part->side = k;
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

// gathers the parts of one edge, of stiffness over the shear modulus without the scale; returns how
// many there are
static int gather(const sn_net *net, const constants *k, const sn_edge_part *part, int left,
                  sn_spring *s) {
    int n = 0;
    double turn = 0, lengths = 0;
    *s = (sn_spring){.end = {part->low, part->high}};
    for (; n < left && part[n].low == part->low && part[n].high == part->high; n++) {
        s->volume += part[n].volume;
        turn += part[n].turn;
        lengths += cbrt(6.0 * sqrt(2.0) * part[n].volume);
    }
    for (int d = 0; d < 3; d++) {
        s->edge[d] = net->node_position[3 * s->end[1] + d] - net->node_position[3 * s->end[0] + d];
        s->length2 += s->edge[d] * s->edge[d];
    }
    s->stiffness = k->classes ? turn * class_constant(k, s->edge) : lengths;
    return n;
}

// first by low node with buckets, then inside a bucket
sn_status sn_net_list_parts(const sn_mesh *mesh, const sn_net *net, int r, sn_edge_part **parts,
                            int *count) {
    int *start = sn_alloc((size_t)net->nodes + 1, sizeof *start), cells = 0;
    sn_edge_part *all = NULL, six[6];
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
    sn_edge_part *part = NULL;
    sn_spring *spring = NULL;
    int count, springs = 0;
    sn_status status;
    SN_TRY_GOTO(status, sn_net_list_parts(mesh, net, r, &part, &count));
    spring = sn_alloc((size_t)count, sizeof *spring);
    if (!spring) {
        status = SN_E_MEMORY;
        goto fail;
    }
    for (int i = 0; i < count;) {
        i += gather(net, k, part + i, count - i, &spring[springs]);
        springs += spring[springs].stiffness > 0;
    }
    double scale = 1.0;
    if (!k->classes) SN_TRY_GOTO(status, sn_net_relaxed_scale(mesh, r, spring, springs, &scale));
    scale *= region->shear * region->stiffening;
    for (int i = 0; i < springs; i++) spring[i].stiffness *= scale;
    status = sn_net_place_springs(net, region, spring, springs);
fail:
    sn_free(part);
    sn_free(spring);
    return status;
}

bool sn_springs_lattice(const sn_case *c) {
    double axis[3], face[3], body;
    return c->has_shape && sn_lattice_constants(&c->shape, axis, face, &body);
}

sn_status sn_net_build_springs(const sn_case *c, sn_net *net) {
    constants k = {0};
    if (c->has_shape && sn_lattice_constants(&c->shape, k.axis, k.face, &k.body)) {
        k.classes = net->by_turn = true;
        for (int d = 0; d < 3; d++) k.h[d] = c->shape.size[d] / c->shape.cells[d];
    }
    for (int r = 0; r < net->region_count; r++)
        SN_TRY(c->springs_given ? sn_net_given_springs(c, net, r)
                                : region_springs(c->mesh, net, r, &k));
    return SN_OK;
}
