// Values of one mesh at the material points of another.
// SPDX-License-Identifier: Apache-2.0
//
// Cells are found through a grid of boxes about as large as a cell: each box lists the cells whose
// own boxes touch it. Means over a cell are taken at the four points of Hammer and Stroud's rule of
// degree 2, so that on equal meshes every cell gets its own value.
#include "compare/sample.h"

#include <math.h>
#include <string.h>

static const double inside = -1e-9; // least weight of a point in a cell, with rounding

typedef struct grid {
    const sn_mesh *mesh;
    double low[3], box[3];
    int n[3];
    int *first; ///< of a box in `cell`                        (boxes + 1)
    int *cell;
} grid;

static double least_of(const double w[4]) {
    return fmin(fmin(w[0], w[1]), fmin(w[2], w[3]));
}

// barycentric weights; *least gets the smallest
static double weigh(const sn_mesh *mesh, int cell, const double point[3], double w[4]) {
    const int *v = mesh->cell + 4 * (size_t)cell;
    double e[3][3], to[3], cross[3][3];
    for (int d = 0; d < 3; d++) {
        double origin = mesh->node[3 * (size_t)v[0] + (size_t)d];
        for (int k = 0; k < 3; k++) e[k][d] = mesh->node[3 * (size_t)v[k + 1] + (size_t)d] - origin;
        to[d] = point[d] - origin;
    }
    for (int k = 0; k < 3; k++) {
        const double *a = e[(k + 1) % 3], *b = e[(k + 2) % 3];
        for (int d = 0; d < 3; d++) {
            int i = (d + 1) % 3, j = (d + 2) % 3;
            cross[k][d] = a[i] * b[j] - a[j] * b[i];
        }
    }
    double six = e[0][0] * cross[0][0] + e[0][1] * cross[0][1] + e[0][2] * cross[0][2];
    w[0] = 1;
    for (int k = 0; k < 3; k++) {
        w[k + 1] = (to[0] * cross[k][0] + to[1] * cross[k][1] + to[2] * cross[k][2]) / six;
        w[0] -= w[k + 1];
    }
    return least_of(w);
}

//---- grid ----------------------------------------------------------------------------------------

static int box_along(const grid *g, int d, double x) {
    double at = floor((x - g->low[d]) / g->box[d]);
    return (int)fmin(fmax(at, 0), g->n[d] - 1);
}

static void boxes_of(const grid *g, int cell, int from[3], int to[3]) {
    const int *v = g->mesh->cell + 4 * (size_t)cell;
    for (int d = 0; d < 3; d++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < 4; k++) {
            double x = g->mesh->node[3 * (size_t)v[k] + (size_t)d];
            low = fmin(low, x);
            high = fmax(high, x);
        }
        double margin = 1e-9 * (high - low); // a point on a face belongs to both sides
        from[d] = box_along(g, d, low - margin);
        to[d] = box_along(g, d, high + margin);
    }
}

static void size_boxes(grid *g) {
    const sn_mesh *mesh = g->mesh;
    double high[3], volume = 1;
    for (int d = 0; d < 3; d++) {
        g->low[d] = HUGE_VAL;
        high[d] = -HUGE_VAL;
        for (int i = 0; i < mesh->node_count; i++) {
            double x = mesh->node[3 * (size_t)i + (size_t)d];
            g->low[d] = fmin(g->low[d], x);
            high[d] = fmax(high[d], x);
        }
        volume *= high[d] - g->low[d];
    }
    double wish = cbrt(6 * volume / mesh->cell_count); // a brick of six cells
    for (int d = 0; d < 3; d++) {
        double length = high[d] - g->low[d];
        g->n[d] = (int)fmin(fmax(floor(length / wish), 1), 256);
        g->box[d] = length / g->n[d];
    }
}

static sn_status grid_create(const sn_mesh *mesh, grid *g) {
    *g = (grid){.mesh = mesh};
    size_boxes(g);
    size_t boxes = (size_t)g->n[0] * (size_t)g->n[1] * (size_t)g->n[2];
    g->first = sn_alloc(boxes + 1, sizeof *g->first);
    if (!g->first) return SN_E_MEMORY;
    for (int pass = 0; pass < 2; pass++) {
        for (int c = 0; c < mesh->cell_count; c++) {
            int from[3], to[3];
            boxes_of(g, c, from, to);
            for (int k = from[2]; k <= to[2]; k++)
                for (int j = from[1]; j <= to[1]; j++)
                    for (int i = from[0]; i <= to[0]; i++) {
                        size_t box =
                            (size_t)i + (size_t)g->n[0] * ((size_t)j + (size_t)g->n[1] * (size_t)k);
                        // counted into the box, then filled from its end backwards
                        if (pass == 0)
                            g->first[box]++;
                        else
                            g->cell[--g->first[box]] = c;
                    }
        }
        if (pass == 1) break;
        for (size_t b = 0; b < boxes; b++) g->first[b + 1] += g->first[b];
        g->cell = sn_alloc((size_t)g->first[boxes], sizeof *g->cell);
        if (!g->cell) return SN_E_MEMORY;
    }
    return SN_OK;
}

static void grid_release(grid *g) {
    sn_free(g->first);
    sn_free(g->cell);
}

// the cell around a point, or the one it is least outside of
static int find(const grid *g, const double point[3], double weight[4]) {
    size_t box = 0;
    for (int d = 2; d >= 0; d--) box = box * (size_t)g->n[d] + (size_t)box_along(g, d, point[d]);
    double best = -HUGE_VAL, w[4];
    int found = 0;
    for (int k = g->first[box]; k < g->first[box + 1] && best < inside; k++) {
        double least = weigh(g->mesh, g->cell[k], point, w);
        if (least <= best) continue;
        best = least;
        found = g->cell[k];
        memcpy(weight, w, sizeof w);
    }
    for (int c = 0; c < g->mesh->cell_count && best < inside; c++) {
        double least = weigh(g->mesh, c, point, w);
        if (least <= best) continue;
        best = least;
        found = c;
        memcpy(weight, w, sizeof w);
    }
    return found;
}

//---- sampler -------------------------------------------------------------------------------------

sn_status sn_sampler_create(const sn_mesh *from, const sn_mesh *at, sn_sampler *s) {
    static const double near = 0.58541019662496845446, far = 0.13819660112501051518;
    grid g;
    sn_status status;
    *s = (sn_sampler){.points = at->node_count, .cells = at->cell_count, .corner = from->cell};
    SN_TRY_GOTO(status, grid_create(from, &g));
    status = SN_E_MEMORY;
    s->cell = sn_alloc((size_t)s->points, sizeof *s->cell);
    s->weight = sn_alloc((size_t)s->points, 4 * sizeof *s->weight);
    s->source = sn_alloc((size_t)s->cells, SN_CELL_POINTS * sizeof *s->source);
    if (!s->cell || !s->weight || !s->source) goto fail;
    for (int i = 0; i < s->points; i++)
        s->cell[i] = find(&g, at->node + 3 * (size_t)i, s->weight + 4 * (size_t)i);
    for (int c = 0; c < s->cells; c++)
        for (int p = 0; p < SN_CELL_POINTS; p++) {
            double point[3] = {0}, w[4];
            for (int k = 0; k < 4; k++)
                for (int d = 0; d < 3; d++)
                    point[d] +=
                        (k == p ? near : far) *
                        at->node[3 * (size_t)at->cell[4 * (size_t)c + (size_t)k] + (size_t)d];
            s->source[SN_CELL_POINTS * (size_t)c + (size_t)p] = find(&g, point, w);
        }
    status = SN_OK;
fail:
    grid_release(&g);
    if (status != SN_OK) sn_sampler_release(s);
    return status;
}

void sn_sampler_release(sn_sampler *s) {
    sn_free(s->cell);
    sn_free(s->weight);
    sn_free(s->source);
    *s = (sn_sampler){0};
}

void sn_sample_nodes(const sn_sampler *s, const double *value, double *out) {
    for (size_t i = 0; i < (size_t)s->points; i++)
        for (size_t d = 0; d < 3; d++) {
            double sum = 0;
            for (size_t k = 0; k < 4; k++) {
                size_t node = (size_t)s->corner[4 * (size_t)s->cell[i] + k];
                sum += s->weight[4 * i + k] * value[3 * node + d];
            }
            out[3 * i + d] = sum;
        }
}

void sn_sample_cells(const sn_sampler *s, const double *value, double *out) {
    for (size_t c = 0; c < (size_t)s->cells; c++)
        for (size_t m = 0; m < 6; m++) {
            double sum = 0;
            for (size_t p = 0; p < SN_CELL_POINTS; p++)
                sum += value[6 * (size_t)s->source[SN_CELL_POINTS * c + p] + m];
            out[6 * c + m] = sum / SN_CELL_POINTS;
        }
}
