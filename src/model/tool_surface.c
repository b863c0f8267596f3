// A closed surface of triangles as a tool: its nearest point, and on which side of it a point is.
// SPDX-License-Identifier: Apache-2.0
// Source: nearest point of a triangle, Ericson, Real-Time Collision Detection (2005), section
// 5.1.5; the side by angle-weighted normals, Baerentzen & Aanaes, IEEE TVCG 11 (2005) 243.
//
// The side is that of the normal at the nearest point: of the face, of the two faces of an edge
// together, of all faces of a corner weighted by their angles. A tree of boxes over the triangles
// leads to the nearest one; it is walked with a stack of fixed size, as a step may not allocate.
#include <stdlib.h>
#include <string.h>

#include "base/vector.h"
#include "model/tool.h"

enum { LEAF = 4, STACK = 128 }; // median splits: at most 2 log2(2^31 / LEAF) boxes wait

typedef struct box {
    double low[3], high[3];
    int first,
        count; // triangles of a leaf; else count is 0 and first the left box, right beside it
} box;

struct sn_tool_surface {
    int corners, triangles, boxes;
    double *corner;        // m                                    (corners x 3)
    int *face;             // corners of each triangle, tree order (triangles x 3)
    double *face_normal;   // unit; NULL with the others: open     (triangles x 3)
    double *edge_normal;   // of edges 01 12 20, any length        (triangles x 3 x 3)
    double *corner_normal; // any length                           (corners x 3)
    box *box;              // the first holds all
    double reach;
};

const double *sn_tool_surface_corners(const sn_tool_surface *surface, int *count) {
    *count = surface->corners;
    return surface->corner;
}

double sn_tool_surface_reach(const sn_tool_surface *surface) {
    return surface->reach;
}

void sn_tool_surface_destroy(sn_tool_surface *s) {
    if (!s) return;
    void *const parts[] = {s->corner,      s->face,          s->face_normal,
                           s->edge_normal, s->corner_normal, s->box};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) sn_free(parts[i]);
    sn_free(s);
}

//---- building: corners, edges, normals -----------------------------------------------------------

typedef struct place {
    double x[3];
    int at;
} place;

static int compare_places(const void *a, const void *b) {
    const place *p = a, *q = b;
    for (int d = 0; d < 3; d++)
        if (p->x[d] != q->x[d]) return p->x[d] < q->x[d] ? -1 : 1;
    return 0;
}

// corners at equal places become one; triangles that lose a corner by that are dropped
static sn_status join_corners(int triangles, const double *corner, sn_tool_surface *s) {
    const size_t n = 3 * (size_t)triangles;
    place *p = sn_alloc(n, sizeof *p);
    s->corner = sn_alloc(n * 3, sizeof *s->corner);
    s->face = sn_alloc(n, sizeof *s->face);
    if (!p || !s->corner || !s->face) {
        sn_free(p);
        return SN_E_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        p[i].at = (int)i;
        for (int d = 0; d < 3; d++) p[i].x[d] = corner[3 * i + (size_t)d] + 0.0; // -0 is 0
    }
    qsort(p, n, sizeof *p, compare_places);
    for (size_t i = 0; i < n; i++) {
        if (i == 0 || compare_places(&p[i - 1], &p[i]) != 0) {
            memcpy(s->corner + 3 * (size_t)s->corners, p[i].x, sizeof p[i].x);
            s->reach = fmax(s->reach, norm3(p[i].x));
            s->corners++;
        }
        s->face[p[i].at] = s->corners - 1;
    }
    sn_free(p);
    for (int f = 0; f < triangles; f++) {
        const int *v = s->face + 3 * f;
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
        memmove(s->face + 3 * s->triangles++, v, 3 * sizeof *v);
    }
    return SN_OK;
}

static double angle_between(const double a[3], const double b[3]) {
    double c[3];
    cross3(a, b, c);
    return atan2(norm3(c), dot3(a, b));
}

static sn_status set_face_normals(sn_tool_surface *s) {
    const size_t n = (size_t)s->triangles;
    s->face_normal = sn_alloc(n * 3, sizeof(double));
    s->edge_normal = sn_alloc(n * 9, sizeof(double));
    s->corner_normal = sn_alloc((size_t)s->corners * 3, sizeof(double));
    if (!s->face_normal || !s->edge_normal || !s->corner_normal) return SN_E_MEMORY;
    double volume = 0;
    for (int f = 0; f < s->triangles; f++) {
        double side[3][3], *normal = s->face_normal + 3 * f;
        const double *x[3];
        for (int k = 0; k < 3; k++) x[k] = s->corner + 3 * (size_t)s->face[3 * f + k];
        for (int k = 0; k < 3; k++) sub3(x[(k + 1) % 3], x[k], side[k]);
        cross3(side[0], side[1], normal);
        volume += dot3(x[0], normal);
        const double length = norm3(normal);
        for (int d = 0; d < 3 && length > 0; d++) normal[d] /= length; // a needle has no normal
        for (int k = 0; k < 3; k++) {
            const double back[3] = {-side[(k + 2) % 3][0], -side[(k + 2) % 3][1],
                                    -side[(k + 2) % 3][2]};
            const double angle = angle_between(side[k], back);
            for (int d = 0; d < 3; d++)
                s->corner_normal[3 * s->face[3 * f + k] + d] += angle * normal[d];
        }
    }
    if (volume > 0) return SN_OK;
    return sn_fail(SN_E_MESH,
                   "the surface encloses %g m3: expected triangles whose normals point "
                   "outwards (the right-hand rule)",
                   volume / 6);
}

typedef struct edge {
    int low, high, face, side; // side -1 - k: runs from high to low
} edge;

static int compare_edges(const void *a, const void *b) {
    const edge *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->face - q->face;
}

static sn_status refuse_edge(const sn_tool_surface *s, const edge *e, int faces) {
    const double *a = s->corner + 3 * (size_t)e->low, *b = s->corner + 3 * (size_t)e->high;
    return sn_fail(SN_E_MESH,
                   "the surface is not closed: the edge from (%g, %g, %g) to (%g, %g, %g) m has %d "
                   "triangles%s, expected two that run along it in opposite directions",
                   a[0], a[1], a[2], b[0], b[1], b[2], faces,
                   faces == 2 ? " that run the same way" : "");
}

// every edge has two triangles; its normal is their sum
static sn_status set_edge_normals(sn_tool_surface *s) {
    const size_t n = 3 * (size_t)s->triangles;
    edge *e = sn_alloc(n, sizeof *e);
    if (!e) return SN_E_MEMORY;
    for (int f = 0; f < s->triangles; f++)
        for (int k = 0; k < 3; k++) {
            const int a = s->face[3 * f + k], b = s->face[3 * f + (k + 1) % 3];
            e[3 * f + k] = a < b ? (edge){a, b, f, k} : (edge){b, a, f, -1 - k};
        }
    qsort(e, n, sizeof *e, compare_edges);
    sn_status status = SN_OK;
    for (size_t i = 0; i < n && status == SN_OK;) {
        size_t end = i + 1;
        while (end < n && e[end].low == e[i].low && e[end].high == e[i].high) end++;
        if (end - i != 2 || (e[i].side < 0) == (e[i + 1].side < 0)) {
            status = refuse_edge(s, &e[i], (int)(end - i));
            break;
        }
        for (size_t k = i; k < end; k++) {
            const int side = e[k].side < 0 ? -1 - e[k].side : e[k].side;
            for (int d = 0; d < 3; d++)
                s->edge_normal[9 * e[k].face + 3 * side + d] =
                    s->face_normal[3 * e[i].face + d] + s->face_normal[3 * e[i + 1].face + d];
        }
        i = end;
    }
    sn_free(e);
    return status;
}

//---- building: the tree --------------------------------------------------------------------------

typedef struct item {
    double centre[3];
    int face, axis; // axis: by which it is being sorted
} item;

static int compare_items(const void *a, const void *b) {
    const item *p = a, *q = b;
    const double x = p->centre[p->axis], y = q->centre[q->axis];
    return x != y ? (x < y ? -1 : 1) : p->face - q->face;
}

static void bound(const sn_tool_surface *s, const item *items, int first, int count, box *b) {
    for (int d = 0; d < 3; d++) {
        b->low[d] = (double)INFINITY;
        b->high[d] = -(double)INFINITY;
    }
    for (int i = first; i < first + count; i++)
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++) {
                const double x = s->corner[3 * s->face[3 * items[i].face + k] + d];
                b->low[d] = fmin(b->low[d], x);
                b->high[d] = fmax(b->high[d], x);
            }
    b->first = first;
    b->count = count;
}

// splits box b at the median along its longest side until its parts are leaves
static void split(sn_tool_surface *s, item *items, int b) {
    box *of = &s->box[b];
    if (of->count <= LEAF) return;
    int axis = 0;
    for (int d = 1; d < 3; d++)
        if (of->high[d] - of->low[d] > of->high[axis] - of->low[axis]) axis = d;
    const int first = of->first, count = of->count, half = count / 2, left = s->boxes;
    for (int i = first; i < first + count; i++) items[i].axis = axis;
    qsort(items + first, (size_t)count, sizeof *items, compare_items);
    s->boxes += 2;
    bound(s, items, first, half, &s->box[left]);
    bound(s, items, first + half, count - half, &s->box[left + 1]);
    of->first = left;
    of->count = 0;
    split(s, items, left);
    split(s, items, left + 1);
}

// puts n rows of `width` bytes into the order of the items
static sn_status reorder(const item *items, int n, size_t width, void *rows) {
    char *copy = sn_alloc((size_t)n, width);
    if (!copy) return SN_E_MEMORY;
    memcpy(copy, rows, (size_t)n * width);
    for (int i = 0; i < n; i++)
        memcpy((char *)rows + (size_t)i * width, copy + (size_t)items[i].face * width, width);
    sn_free(copy);
    return SN_OK;
}

static sn_status grow_tree(sn_tool_surface *s) {
    const int n = s->triangles;
    item *items = sn_alloc((size_t)n, sizeof *items);
    s->box = sn_alloc(2 * (size_t)n, sizeof *s->box);
    sn_status status = items && s->box ? SN_OK : SN_E_MEMORY;
    if (status != SN_OK) goto fail;
    for (int f = 0; f < n; f++) {
        items[f].face = f;
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++)
                items[f].centre[d] += s->corner[3 * s->face[3 * f + k] + d] / 3;
    }
    s->boxes = 1;
    bound(s, items, 0, n, &s->box[0]);
    split(s, items, 0);
    SN_TRY_GOTO(status, reorder(items, n, 3 * sizeof *s->face, s->face));
    if (!s->face_normal) goto fail; // an open one
    SN_TRY_GOTO(status, reorder(items, n, 3 * sizeof(double), s->face_normal));
    SN_TRY_GOTO(status, reorder(items, n, 9 * sizeof(double), s->edge_normal));
fail:
    sn_free(items);
    return status;
}

sn_status sn_tool_surface_create(int triangles, const double *corner, sn_tool_surface **surface) {
    *surface = NULL;
    if (triangles < 4)
        return sn_fail(SN_E_MESH, "%d triangles: a closed surface has at least 4", triangles);
    for (size_t i = 0; i < 9 * (size_t)triangles; i++)
        if (!isfinite(corner[i]) || fabs(corner[i]) > 1e100)
            return sn_fail(SN_E_MESH, "triangle %zu has a corner at %g m", i / 9 + 1, corner[i]);
    sn_tool_surface *s = sn_alloc(1, sizeof *s);
    if (!s) return SN_E_MEMORY;
    sn_status status;
    SN_TRY_GOTO(status, join_corners(triangles, corner, s));
    if (s->triangles < 4) {
        status = sn_fail(SN_E_MESH, "no more than %d triangles have three corners", s->triangles);
        goto fail;
    }
    SN_TRY_GOTO(status, set_face_normals(s));
    SN_TRY_GOTO(status, set_edge_normals(s));
    SN_TRY_GOTO(status, grow_tree(s));
    *surface = s;
    return SN_OK;
fail:
    sn_tool_surface_destroy(s);
    return status;
}

sn_status sn_tool_surface_open(int triangles, const int *face, const double *node,
                               sn_tool_surface **surface) {
    *surface = NULL;
    double *corner = sn_alloc(9 * (size_t)triangles, sizeof *corner);
    sn_tool_surface *s = sn_alloc(1, sizeof *s);
    sn_status status = corner && s ? SN_OK : SN_E_MEMORY;
    if (status != SN_OK) goto fail;
    for (size_t i = 0; i < 3 * (size_t)triangles; i++)
        memcpy(corner + 3 * i, node + 3 * (size_t)face[i], 3 * sizeof *corner);
    SN_TRY_GOTO(status, join_corners(triangles, corner, s));
    if (s->triangles < 1) {
        status = sn_fail(SN_E_MESH, "the surface has no triangle with three corners");
        goto fail;
    }
    SN_TRY_GOTO(status, grow_tree(s));
    *surface = s;
    s = NULL;
fail:
    sn_tool_surface_destroy(s);
    sn_free(corner);
    return status;
}

static void *copy_of(const void *from, size_t count, size_t size) {
    void *to = sn_alloc(count, size);
    if (to) memcpy(to, from, count * size);
    return to;
}

sn_status sn_tool_surface_copy(const sn_tool_surface *s, sn_tool_surface **copy) {
    const size_t n = (size_t)s->triangles, corners = (size_t)s->corners;
    sn_tool_surface *c = *copy = sn_alloc(1, sizeof *c);
    if (!c) return SN_E_MEMORY;
    *c = *s;
    c->corner = copy_of(s->corner, corners * 3, sizeof(double));
    c->face = copy_of(s->face, n * 3, sizeof *s->face);
    c->face_normal = copy_of(s->face_normal, n * 3, sizeof(double));
    c->edge_normal = copy_of(s->edge_normal, n * 9, sizeof(double));
    c->corner_normal = copy_of(s->corner_normal, corners * 3, sizeof(double));
    c->box = copy_of(s->box, (size_t)s->boxes, sizeof *s->box);
    if (c->corner && c->face && c->face_normal && c->edge_normal && c->corner_normal && c->box)
        return SN_OK;
    sn_tool_surface_destroy(c);
    *copy = NULL;
    return SN_E_MEMORY;
}

//---- nearest point -------------------------------------------------------------------------------

// where the nearest point of a triangle is: inside, on an edge 01 12 20, at a corner
typedef enum feature { FACE, EDGE_0, EDGE_1, EDGE_2, CORNER_0, CORNER_1, CORNER_2 } feature;

static feature triangle_near(const double *a, const double *b, const double *c, const double r[3],
                             double q[3]) {
    double ab[3], ac[3], ar[3], br[3], cr[3];
    sub3(b, a, ab), sub3(c, a, ac), sub3(r, a, ar), sub3(r, b, br), sub3(r, c, cr);
    const double d1 = dot3(ab, ar), d2 = dot3(ac, ar), d3 = dot3(ab, br), d4 = dot3(ac, br);
    const double d5 = dot3(ab, cr), d6 = dot3(ac, cr);
    double v = 0, w = 0;
    feature at = FACE;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (d1 <= 0 && d2 <= 0) {
        at = CORNER_0;
    } else if (d3 >= 0 && d4 <= d3) {
        at = CORNER_1, v = 1;
    } else if (d6 >= 0 && d5 <= d6) {
        at = CORNER_2, w = 1;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        at = EDGE_0, v = d1 / (d1 - d3);
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        at = EDGE_2, w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        at = EDGE_1, w = (d4 - d3) / ((d4 - d3) + (d5 - d6)), v = 1 - w;
    } else {
        v = vb / (va + vb + vc), w = vc / (va + vb + vc);
    }
    for (int i = 0; i < 3; i++) q[i] = a[i] + v * ab[i] + w * ac[i];
    return at;
}

static double box_distance2(const box *b, const double r[3]) {
    double sum = 0;
    for (int d = 0; d < 3; d++) {
        const double out = fmax(fmax(b->low[d] - r[d], r[d] - b->high[d]), 0);
        sum += out * out;
    }
    return sum;
}

typedef struct nearest {
    double distance2, q[3];
    int face;
    feature at;
} nearest;

static void look_at_leaf(const sn_tool_surface *s, const box *b, const double r[3], nearest *best) {
    for (int f = b->first; f < b->first + b->count; f++) {
        const int *v = s->face + 3 * f;
        double q[3], d[3];
        const feature at = triangle_near(s->corner + 3 * (size_t)v[0], s->corner + 3 * (size_t)v[1],
                                         s->corner + 3 * (size_t)v[2], r, q);
        sub3(r, q, d);
        const double distance2 = dot3(d, d);
        if (!(distance2 < best->distance2)) continue;
        *best = (nearest){distance2, {q[0], q[1], q[2]}, f, at};
    }
}

static nearest find_nearest(const sn_tool_surface *s, const double r[3]) {
    int stack[STACK], waiting = 0;
    nearest best = {.distance2 = (double)INFINITY};
    stack[waiting++] = 0;
    while (waiting > 0) {
        const box *b = &s->box[stack[--waiting]];
        if (box_distance2(b, r) >= best.distance2) continue;
        if (b->count > 0) {
            look_at_leaf(s, b, r, &best);
            continue;
        }
        const int left = b->first;
        const bool left_first =
            box_distance2(&s->box[left], r) <= box_distance2(&s->box[left + 1], r);
        stack[waiting++] = left_first ? left + 1 : left;
        stack[waiting++] = left_first ? left : left + 1;
    }
    return best;
}

double sn_tool_surface_distance(const sn_tool_surface *s, const double r[3]) {
    return sqrt(find_nearest(s, r).distance2);
}

void sn_tool_surface_near(const sn_tool_surface *s, const double r[3], sn_touch *touch) {
    const nearest best = find_nearest(s, r);
    const double *side = s->face_normal + 3 * best.face; // by which the side is told
    if (best.at >= CORNER_0)
        side = s->corner_normal + 3 * (size_t)s->face[3 * best.face + (int)(best.at - CORNER_0)];
    else if (best.at != FACE)
        side = s->edge_normal + 9 * best.face + 3 * (best.at - EDGE_0);
    double away[3];
    sub3(r, best.q, away);
    const double distance = sqrt(best.distance2);
    const bool inside = dot3(away, side) < 0;
    touch->depth = inside ? distance : -distance;
    if (best.at == FACE || !(distance > 0)) {
        const double length = norm3(side);
        for (int i = 0; i < 3 && length > 0; i++) touch->n[i] = side[i] / length;
        return;
    }
    const double sign = inside ? -1 : 1;
    double axis[3] = {0, 0, 0};
    if (best.at < CORNER_0) {
        const int k = (int)(best.at - EDGE_0), *v = s->face + 3 * best.face;
        sub3(s->corner + 3 * (size_t)v[(k + 1) % 3], s->corner + 3 * (size_t)v[k], axis);
        const double length = norm3(axis);
        for (int i = 0; i < 3; i++) axis[i] /= length;
    }
    for (int i = 0; i < 3; i++) touch->n[i] = sign * away[i] / distance;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            touch->bend[3 * i + j] =
                sign / distance * ((i == j) - touch->n[i] * touch->n[j] - axis[i] * axis[j]);
}
