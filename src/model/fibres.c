// Material axes: one direction, a rule around an axis, or a list by cell.
// SPDX-License-Identifier: Apache-2.0
// Source: the rule is that of ventricles and arteries: an angle to the direction around the axis,
// linear in the depth through the wall (Streeter et al., Circ. Res. 24 (1969) 339; Land et al.,
// Proc. R. Soc. A 471 (2015) 20150641, problem 3; Holzapfel, Gasser, Ogden, J. Elasticity 61 (2000)
// 1).
//
// Depth. With d_i and d_o the distances of a node from the triangles of the inner and the outer
// wall, its depth is d_i / (d_i + d_o): 0 inside, 1 outside, linear through a wall of parallel
// faces. (A Laplace problem would be as smooth, but not linear: its level half way through the wall
// of a tube with radii 1 and 2 is 0.585.) A cell has the mean depth of its nodes. The normal is the
// gradient of the depth: that of linear cells, averaged to the nodes by volume, then to the cell,
// which takes one order off its error.
//
// Around. c = axis x (middle - axis) / |…|, n the normal less its part along c, l = n x c. So the
// axes are orthonormal whatever the mesh, and singular only on the axis itself.
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"
#include "model/tool.h"

// a direction this much shorter than what it is made of is rounding
#define NO_LENGTH 1e-9

static bool finite3(const double v[3]) {
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

// divides by the length; false where that is 0
static bool make_unit(double v[3]) {
    double length = norm3(v);
    for (int i = 0; i < 3 && length > 0; i++) v[i] /= length;
    return length > 0;
}

// takes the part along a unit vector off; false where (almost) nothing is left
static bool make_across(double v[3], const double unit[3]) {
    double before = norm3(v), part = dot3(v, unit);
    for (int i = 0; i < 3; i++) v[i] -= part * unit[i];
    if (!(norm3(v) > NO_LENGTH * before)) return false;
    if (norm3(v) < 0.5 * before) { // rounding has become large against it: once more
        make_unit(v);
        part = dot3(v, unit);
        for (int i = 0; i < 3; i++) v[i] -= part * unit[i];
    }
    return make_unit(v);
}

// Axes from a fibre and a second direction; zero: the coordinate axis that follows the fibre's
// largest component.
static void set_axes(const double fibre[3], const double sheet[3], double axes[9]) {
    double *first = axes, *second = axes + 3, *third = axes + 6;
    memcpy(first, fibre, 3 * sizeof *first);
    memcpy(second, sheet, 3 * sizeof *second);
    if (!make_unit(first)) first[0] = 1;
    if (!make_across(second, first)) {
        int largest = 0;
        for (int i = 1; i < 3; i++)
            if (fabs(first[i]) > fabs(first[largest])) largest = i;
        for (int i = 0; i < 3; i++) second[i] = (double)(i == (largest + 1) % 3);
        make_across(second, first);
    }
    cross3(first, second, third);
}

void sn_case_axes(const sn_case *c, double axes[9]) {
    set_axes(c->fibre, c->fibres.sheet, axes);
}

//---- the wall ------------------------------------------------------------------------------------

/// Depth through the wall, 0 to 1, and its gradient, at the nodes.
typedef struct wall {
    double *depth;    ///< (nodes)
    double *gradient; ///< times a volume                          (nodes x 3)
} wall;

static void wall_release(wall *w) {
    sn_free(w->depth);
    sn_free(w->gradient);
}

static sn_status find_depth(const sn_mesh *mesh, const int surface[2], double *depth) {
    sn_tool_surface *side[2] = {NULL, NULL};
    sn_status status = SN_OK;
    for (int k = 0; k < 2; k++) {
        const sn_surface *s = &mesh->surface[surface[k]];
        SN_TRY_GOTO(status, sn_tool_surface_open(s->face_count, s->face, mesh->node, &side[k]));
    }
    for (int a = 0; a < mesh->node_count; a++) {
        const double *x = mesh->node + 3 * (size_t)a;
        double in = sn_tool_surface_distance(side[0], x);
        double out = sn_tool_surface_distance(side[1], x);
        if (in + out > 0) {
            depth[a] = in / (in + out);
            continue;
        }
        status = sn_fail(SN_E_DEFINITION,
                         "fibres: the walls \"%s\" and \"%s\" touch at (%g, %g, %g) m, where there "
                         "is no depth: give two surfaces that are apart",
                         mesh->surface[surface[0]].name, mesh->surface[surface[1]].name, x[0], x[1],
                         x[2]);
        goto fail;
    }
fail:
    for (int k = 0; k < 2; k++) sn_tool_surface_destroy(side[k]);
    return status;
}

static sn_status wall_create(const sn_mesh *mesh, const int surface[2], wall *w) {
    w->depth = sn_alloc((size_t)mesh->node_count, sizeof *w->depth);
    w->gradient = sn_alloc(3 * (size_t)mesh->node_count, sizeof *w->gradient);
    if (!w->depth || !w->gradient) return SN_E_MEMORY;
    SN_TRY(find_depth(mesh, surface, w->depth));
    for (int c = 0; c < mesh->cell_count; c++) {
        const int *v = mesh->cell + 4 * (size_t)c;
        double sum[3] = {0}; // 6 V grad depth: the faces, each times the depth opposite to it
        for (int k = 0; k < 4; k++) {
            int node[3];
            double normal[3];
            sn_face_nodes(mesh, 4 * c + k, node);
            sn_triangle_normal(mesh, node, normal);
            for (int i = 0; i < 3; i++) sum[i] -= w->depth[v[k]] * normal[i];
        }
        for (size_t k = 0; k < 4; k++)
            for (size_t i = 0; i < 3; i++) w->gradient[3 * (size_t)v[k] + i] += sum[i];
    }
    return SN_OK;
}

//---- around an axis ------------------------------------------------------------------------------

static sn_status refuse_cell(int cell, const double x[3], const char *what) {
    return sn_fail(SN_E_DEFINITION,
                   "fibres: cell %d at (%g, %g, %g) m %s: its fibre has no direction", cell, x[0],
                   x[1], x[2], what);
}

// mean of the nodes of a cell
static double mean_at(const sn_mesh *mesh, int cell, const double *values, size_t width, size_t i) {
    double sum = 0;
    for (size_t k = 0; k < 4; k++)
        sum += 0.25 * values[width * (size_t)mesh->cell[4 * (size_t)cell + k] + i];
    return sum;
}

static sn_status around_axis(const sn_case *c, const wall *w, int cell, double axes[9]) {
    const sn_fibres *f = &c->fibres;
    double x[3], axis[3], n[3], around[3], along[3], fibre[3], across[3], depth = 0;
    sn_mesh_middle(c->mesh, cell, x);
    memcpy(axis, f->axis, sizeof axis);
    make_unit(axis);
    sub3(x, f->through, n);
    double far = norm3(n) + sn_mesh_size(c->mesh);
    double part = dot3(n, axis);
    for (int i = 0; i < 3; i++) n[i] -= part * axis[i];
    cross3(axis, n, around);
    if (!(norm3(around) > NO_LENGTH * far)) return refuse_cell(cell, x, "is on the axis");
    make_unit(around);
    if (w->depth) {
        depth = mean_at(c->mesh, cell, w->depth, 1, 0);
        for (size_t i = 0; i < 3; i++) n[i] = mean_at(c->mesh, cell, w->gradient, 3, i);
    }
    if (!make_across(n, around)) return refuse_cell(cell, x, "has a wall across the axis");
    cross3(n, around, along);
    double angle = f->angle[0] + depth * (f->angle[1] - f->angle[0]);
    for (int i = 0; i < 3; i++) {
        fibre[i] = cos(angle) * around[i] + sin(angle) * along[i];
        across[i] = cos(angle) * along[i] - sin(angle) * around[i];
    }
    set_axes(fibre, f->sheet_normal ? n : across, axes);
    return SN_OK;
}

//---- all cells -----------------------------------------------------------------------------------

static bool same_axes(const sn_case *c, const double *field, int *first) {
    *first = -1;
    for (int k = 0; k < c->mesh->cell_count; k++) {
        if (!c->tissue[c->mesh->region[k]].law->fibres) continue;
        if (*first < 0) *first = k;
        if (memcmp(field + 9 * (size_t)k, field + 9 * (size_t)*first, 9 * sizeof *field) != 0)
            return false;
    }
    return true;
}

static sn_status fill_field(const sn_case *c, const wall *w, double *field) {
    for (int k = 0; k < c->mesh->cell_count; k++) {
        double *axes = field + 9 * (size_t)k;
        if (!c->tissue[c->mesh->region[k]].law->fibres) {
            for (int i = 0; i < 9; i++) axes[i] = i % 4 == 0;
        } else if (c->fibres.rule == SN_FIBRES_LISTED) {
            const double *row = c->fibres.listed + 6 * (size_t)k;
            set_axes(row, row + 3, axes);
        } else {
            SN_TRY(around_axis(c, w, k, axes));
        }
    }
    return SN_OK;
}

sn_status sn_case_axes_field(const sn_case *c, double axes[9], double **field) {
    bool fibres = false;
    for (int r = 0; r < c->mesh->region_count; r++) fibres |= c->tissue[r].law->fibres;
    for (int k = 0; k < 9; k++) axes[k] = k % 4 == 0;
    *field = NULL;
    if (!fibres) return SN_OK;
    if (c->fibres.rule == SN_FIBRES_ALIKE) {
        sn_case_axes(c, axes);
        return SN_OK;
    }
    wall w = {NULL, NULL};
    int first;
    sn_status status = SN_E_MEMORY;
    double *out = sn_alloc(9 * (size_t)c->mesh->cell_count, sizeof *out);
    if (!out) goto fail;
    if (c->fibres.rule == SN_FIBRES_AROUND && c->fibres.wall[0] >= 0)
        SN_TRY_GOTO(status, wall_create(c->mesh, c->fibres.wall, &w));
    SN_TRY_GOTO(status, fill_field(c, &w, out));
    if (same_axes(c, out, &first)) {
        if (first >= 0) memcpy(axes, out + 9 * (size_t)first, 9 * sizeof *axes);
    } else {
        *field = out;
        out = NULL;
    }
fail:
    sn_free(out);
    wall_release(&w);
    return status;
}

//---- another mesh --------------------------------------------------------------------------------

/// Cells of a mesh, sorted along x.
typedef struct finder {
    const sn_mesh *mesh;
    struct start {
        double low; ///< least x of a cell, m
        int cell;
    } * start;
    double longest; ///< of a cell along x, m
} finder;

static int compare_starts(const void *a, const void *b) {
    const struct start *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return p->cell - q->cell;
}

static sn_status finder_create(const sn_mesh *mesh, finder *f) {
    *f = (finder){.mesh = mesh};
    f->start = sn_alloc((size_t)mesh->cell_count, sizeof *f->start);
    if (!f->start) return SN_E_MEMORY;
    for (int k = 0; k < mesh->cell_count; k++) {
        double low = (double)INFINITY, high = -(double)INFINITY;
        for (int i = 0; i < 4; i++) {
            double x = mesh->node[3 * (size_t)mesh->cell[4 * (size_t)k + (size_t)i]];
            low = fmin(low, x);
            high = fmax(high, x);
        }
        f->start[k] = (struct start){low, k};
        f->longest = fmax(f->longest, high - low);
    }
    qsort(f->start, (size_t)mesh->cell_count, sizeof *f->start, compare_starts);
    return SN_OK;
}

// The cell that a point is deepest in, or least outside of. `guess` ends the search where the point
// is inside of it.
static int find_cell(const finder *f, const double x[3], int guess) {
    double weight[4], best = -(double)INFINITY;
    int cell = 0;
    if (guess < f->mesh->cell_count && sn_mesh_depth(f->mesh, guess, x, weight) > 0) return guess;
    for (int whole = 0; whole < 2 && !(best > 0); whole++)
        for (int k = 0; k < f->mesh->cell_count; k++) {
            if (!whole && f->start[k].low + f->longest < x[0]) continue;
            if (!whole && f->start[k].low > x[0]) break;
            double depth = sn_mesh_depth(f->mesh, f->start[k].cell, x, weight);
            if (depth > best) best = depth, cell = f->start[k].cell;
        }
    return cell;
}

sn_status sn_fibres_on_mesh(const sn_fibres *from, const sn_mesh *mesh, const sn_mesh *other,
                            sn_fibres *to) {
    *to = *from;
    to->listed = NULL;
    if (from->rule != SN_FIBRES_LISTED) return SN_OK;
    finder f = {.mesh = NULL};
    sn_status status = SN_E_MEMORY;
    to->count = other->cell_count;
    to->listed = sn_alloc(6 * (size_t)other->cell_count, sizeof *to->listed);
    if (!to->listed) goto fail;
    SN_TRY_GOTO(status, finder_create(mesh, &f));
    // the same cell, or the one that it was split from, as a first guess
    int split = other->cell_count == 8 * (long long)mesh->cell_count ? 8 : 1;
    for (int k = 0; k < other->cell_count; k++) {
        double x[3];
        sn_mesh_middle(other, k, x);
        int cell = find_cell(&f, x, k / split);
        memcpy(to->listed + 6 * (size_t)k, from->listed + 6 * (size_t)cell, 6 * sizeof *x);
    }
fail:
    sn_free(f.start);
    return status;
}

//---- checks --------------------------------------------------------------------------------------

static sn_status check_alike(const sn_case *c) {
    double sheet[3];
    memcpy(sheet, c->fibres.sheet, sizeof sheet);
    if (norm3(c->fibre) > 0 && fabs(norm3(c->fibre) - 1) > 1e-9)
        return sn_fail(SN_E_RANGE, "the fibre direction has length %g: 1 expected",
                       norm3(c->fibre));
    if (!finite3(sheet)) return sn_fail(SN_E_RANGE, "fibres: the sheet must be finite numbers");
    if (norm3(sheet) > 0 && !make_across(sheet, c->fibre))
        return sn_fail(SN_E_DEFINITION,
                       "fibres: the sheet (%g, %g, %g) is along the fibre: another direction "
                       "expected",
                       c->fibres.sheet[0], c->fibres.sheet[1], c->fibres.sheet[2]);
    return SN_OK;
}

static sn_status check_around(const sn_case *c) {
    const sn_fibres *f = &c->fibres;
    if (!finite3(f->axis) || !(norm3(f->axis) > 0) || !finite3(f->through))
        return sn_fail(SN_E_RANGE, "fibres: the axis (%g, %g, %g) must be finite and have a length",
                       f->axis[0], f->axis[1], f->axis[2]);
    if (!isfinite(f->angle[0]) || !isfinite(f->angle[1]))
        return sn_fail(SN_E_RANGE, "fibres: the angles %g and %g must be finite", f->angle[0],
                       f->angle[1]);
    bool walls = f->wall[0] >= 0 || f->wall[1] >= 0;
    for (int k = 0; k < 2 && walls; k++)
        if (f->wall[k] < 0 || f->wall[k] >= c->mesh->surface_count ||
            c->mesh->surface[f->wall[k]].face_count == 0)
            return sn_fail(SN_E_DEFINITION, "fibres: the %s wall, surface %d, has no faces",
                           k ? "outer" : "inner", f->wall[k]);
    if (!walls && (f->angle[0] < f->angle[1] || f->angle[0] > f->angle[1]))
        return sn_fail(SN_E_DEFINITION, "fibres: an angle that changes through the wall needs "
                                        "walls: name its inner and its outer surface");
    return SN_OK;
}

static sn_status check_listed(const sn_case *c) {
    const sn_fibres *f = &c->fibres;
    if (f->count != c->mesh->cell_count)
        return sn_fail(SN_E_DEFINITION, "fibres: %d rows for %d cells: one a cell expected",
                       f->count, c->mesh->cell_count);
    for (int k = 0; k < f->count; k++) {
        const double *row = f->listed + 6 * (size_t)k;
        double fibre[3] = {row[0], row[1], row[2]}, sheet[3] = {row[3], row[4], row[5]};
        if (!finite3(fibre) || !finite3(sheet) || !make_unit(fibre))
            return sn_fail(SN_E_RANGE,
                           "fibres: row %d (%g, %g, %g): finite numbers and a length expected",
                           k + 1, row[0], row[1], row[2]);
        if (norm3(sheet) > 0 && !make_across(sheet, fibre))
            return sn_fail(SN_E_DEFINITION,
                           "fibres: row %d: the second direction (%g, %g, %g) is along the fibre",
                           k + 1, row[3], row[4], row[5]);
    }
    return SN_OK;
}

sn_status sn_fibres_check(const sn_case *c) {
    return c->fibres.rule == SN_FIBRES_AROUND   ? check_around(c)
           : c->fibres.rule == SN_FIBRES_LISTED ? check_listed(c)
                                                : check_alike(c);
}
