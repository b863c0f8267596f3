// Deformed bodies of a report: their surfaces as compact numbers for the script that draws them.
// SPDX-License-Identifier: Apache-2.0
//
// Positions are 16-bit shares of one cube around all bodies of the figure, values 16-bit shares of
// the colour scale: a screen shows no more. Only nodes of the outer faces are kept, each once. The
// shape at rest is drawn as its sharp edges, or as its box where it has none.
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "io/report.h"

#define SHARP 0.82 // cosine of the angle between faces, about 35 degrees
#define NO_VALUE 65535
#define TOP_VALUE 65534

// The cube that positions are shares of.
typedef struct cube {
    double low[3], size;
} cube;

typedef struct skin {
    const sn_body *body;
    const sn_surface *boundary;
    int node_count;
    int *number; ///< of each node of the mesh in the skin, -1 outside  (mesh nodes)
    int *node;   ///< of the mesh                                       (node_count)
} skin;

static const sn_surface *find_boundary(const sn_mesh *mesh) {
    for (int s = 0; s < mesh->surface_count; s++)
        if (!strcmp(mesh->surface[s].name, "boundary")) return &mesh->surface[s];
    return NULL;
}

static double position(const sn_body *body, int node, int axis, bool deformed) {
    size_t i = 3 * (size_t)node + (size_t)axis;
    return body->mesh->node[i] + (deformed ? body->displacement[i] : 0);
}

static sn_status skin_create(const sn_body *body, skin *s) {
    const sn_mesh *mesh = body->mesh;
    *s = (skin){.body = body, .boundary = find_boundary(mesh)};
    SN_ASSERT(s->boundary); // sn_mesh_finish() made it
    s->number = sn_alloc((size_t)mesh->node_count, sizeof *s->number);
    s->node = sn_alloc((size_t)mesh->node_count, sizeof *s->node);
    if (!s->number || !s->node) return SN_E_MEMORY;
    for (int n = 0; n < mesh->node_count; n++) s->number[n] = -1;
    for (int k = 0; k < 3 * s->boundary->face_count; k++) {
        int n = s->boundary->face[k];
        if (s->number[n] >= 0) continue;
        s->number[n] = s->node_count;
        s->node[s->node_count++] = n;
    }
    return SN_OK;
}

static void skin_free(skin *s) {
    sn_free(s->number);
    sn_free(s->node);
}

//---- shares --------------------------------------------------------------------------------------

// Adds 16-bit or 32-bit numbers, low byte first.
static void put(unsigned char *out, unsigned long number, int width) {
    for (int k = 0; k < width; k++) out[k] = (unsigned char)(number >> 8 * k & 255);
}

static void put_position(unsigned char *out, const cube *c, const skin *s, int node,
                         bool deformed) {
    for (int i = 0; i < 3; i++) {
        double share = (position(s->body, node, i, deformed) - c->low[i]) / c->size;
        put(out + 2 * i, (unsigned long)lround(65535 * fmin(fmax(share, 0), 1)), 2);
    }
}

static void add_attribute(sn_buffer *page, const char *name, const unsigned char *bytes,
                          size_t count) {
    sn_buffer_print(page, " data-%s=\"", name);
    sn_buffer_base64(page, bytes, count);
    sn_buffer_text(page, "\"");
}

static void add_points(sn_buffer *page, const cube *c, const skin *s, unsigned char *bytes) {
    for (int k = 0; k < s->node_count; k++)
        put_position(bytes + 6 * (size_t)k, c, s, s->node[k], true);
    add_attribute(page, "points", bytes, 6 * (size_t)s->node_count);
}

static void add_faces(sn_buffer *page, const skin *s, unsigned char *bytes) {
    int width = s->node_count > 65536 ? 4 : 2;
    size_t count = 3 * (size_t)s->boundary->face_count;
    for (size_t k = 0; k < count; k++)
        put(bytes + (size_t)width * k, (unsigned long)s->number[s->boundary->face[k]], width);
    sn_buffer_print(page, " data-width=\"%d\"", width);
    add_attribute(page, "faces", bytes, (size_t)width * count);
}

// The scale runs from zero, or from the smallest value where there are negative ones.
static void add_values(sn_buffer *page, const skin *s, unsigned char *bytes) {
    double low = 0, high = -HUGE_VAL, top;
    for (int k = 0; k < s->node_count; k++) {
        double value = s->body->value[s->node[k]];
        if (!isfinite(value)) continue;
        low = fmin(low, value);
        high = fmax(high, value);
    }
    top = s->body->value_max > low ? s->body->value_max : high;
    if (!(top > low)) top = low + 1;
    for (int k = 0; k < s->node_count; k++) {
        double share = (s->body->value[s->node[k]] - low) / (top - low);
        long number = isfinite(share) ? lround(TOP_VALUE * fmin(fmax(share, 0), 1)) : NO_VALUE;
        put(bytes + 2 * (size_t)k, (unsigned long)number, 2);
    }
    double scale = s->body->value_scale != 0 ? s->body->value_scale : 1;
    sn_buffer_print(page, " data-low=\"%.6g\" data-high=\"%.6g\" data-over=\"%d\"", low * scale,
                    top * scale, high > top * (1 + 1e-9));
    add_attribute(page, "values", bytes, 2 * (size_t)s->node_count);
}

//---- the shape at rest ---------------------------------------------------------------------------

typedef struct edge {
    int low, high, face;
} edge;

static int compare_edges(const void *left, const void *right) {
    const edge *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return a->face - b->face;
}

static void rest_normal(const skin *s, int face, double normal[3]) {
    const int *v = s->boundary->face + 3 * (size_t)face;
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
        double origin = position(s->body, v[0], i, false);
        a[i] = position(s->body, v[1], i, false) - origin;
        b[i] = position(s->body, v[2], i, false) - origin;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = a[j] * b[k] - a[k] * b[j];
    }
    double size = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (int i = 0; i < 3 && size > 0; i++) normal[i] /= size;
}

static bool is_sharp(const skin *s, int face, int other) {
    double a[3], b[3];
    rest_normal(s, face, a);
    rest_normal(s, other, b);
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < SHARP;
}

// Sharp edges as pairs of ends. `bytes` holds 12 an edge.
static size_t sharp_edges(const cube *c, const skin *s, edge *edges, unsigned char *bytes) {
    int count = 3 * s->boundary->face_count;
    for (int k = 0; k < count; k++) {
        const int *v = s->boundary->face + 3 * (size_t)(k / 3);
        int a = v[k % 3], b = v[(k + 1) % 3];
        edges[k] = (edge){a < b ? a : b, a < b ? b : a, k / 3};
    }
    qsort(edges, (size_t)count, sizeof *edges, compare_edges);
    size_t found = 0;
    for (int k = 0; k + 1 < count; k++) {
        const edge *e = &edges[k], *next = &edges[k + 1];
        if (e->low != next->low || e->high != next->high || !is_sharp(s, e->face, next->face))
            continue;
        put_position(bytes + 12 * found, c, s, e->low, false);
        put_position(bytes + 12 * found + 6, c, s, e->high, false);
        found++;
    }
    return found;
}

// The twelve edges of the box around the shape at rest.
static size_t box_edges(const cube *c, const skin *s, unsigned char *bytes) {
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = HUGE_VAL;
        high[i] = -HUGE_VAL;
        for (int k = 0; k < s->node_count; k++) {
            low[i] = fmin(low[i], position(s->body, s->node[k], i, false));
            high[i] = fmax(high[i], position(s->body, s->node[k], i, false));
        }
    }
    size_t found = 0;
    for (int corner = 0; corner < 8; corner++)
        for (int axis = 0; axis < 3; axis++) {
            if (corner >> axis & 1) continue;
            for (int end = 0; end < 2; end++)
                for (int i = 0; i < 3; i++) {
                    int bits = corner | end << axis;
                    double share = ((bits >> i & 1 ? high[i] : low[i]) - c->low[i]) / c->size;
                    put(bytes + 12 * found + 6 * (size_t)end + 2 * (size_t)i,
                        (unsigned long)lround(65535 * fmin(fmax(share, 0), 1)), 2);
                }
            found++;
        }
    return found;
}

static sn_status add_outline(sn_buffer *page, const cube *c, const skin *s, unsigned char *bytes) {
    edge *edges = sn_alloc(3 * (size_t)s->boundary->face_count, sizeof *edges);
    if (!edges) return SN_E_MEMORY;
    size_t found = sharp_edges(c, s, edges, bytes);
    if (found == 0) found = box_edges(c, s, bytes);
    add_attribute(page, "outline", bytes, 12 * found);
    sn_free(edges);
    return SN_OK;
}

//---- page ----------------------------------------------------------------------------------------

// The cube around all bodies, at rest and deformed.
// @return false where a position is not finite: *where then tells the body and its node
static bool measure(const skin *skins, int count, cube *c, int where[2]) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int b = 0; b < count; b++)
        for (int k = 0; k < 6 * skins[b].node_count; k++) {
            int node = skins[b].node[k / 6], axis = k % 3;
            double x = position(skins[b].body, node, axis, k % 6 >= 3);
            if (!isfinite(x)) {
                where[0] = b;
                where[1] = node;
                return false;
            }
            low[axis] = fmin(low[axis], x);
            high[axis] = fmax(high[axis], x);
        }
    c->size = fmax(high[0] - low[0], fmax(high[1] - low[1], high[2] - low[2]));
    for (int i = 0; i < 3; i++) c->low[i] = 0.5 * (low[i] + high[i] - c->size);
    return true;
}

static sn_status add_body(sn_buffer *page, const cube *c, const skin *s) {
    // enough for the largest: 12 bytes for each of three edges of a face, or the twelve of a box
    size_t faces = (size_t)s->boundary->face_count, nodes = (size_t)s->node_count;
    unsigned char *bytes = sn_alloc(36 * faces + 6 * nodes + 144, 1);
    if (!bytes) return SN_E_MEMORY;
    sn_buffer_text(page, "<div><b class=\"title\">");
    sn_buffer_escape(page, s->body->title);
    sn_buffer_text(page, "</b>\n<canvas tabindex=\"0\" role=\"img\" aria-label=\"");
    sn_buffer_escape(page, s->body->title);
    sn_buffer_text(page, ": ");
    sn_buffer_escape(page, s->body->value_label);
    sn_buffer_text(page, "\" data-label=\"");
    sn_buffer_escape(page, s->body->value_label);
    sn_buffer_text(page, "\"");
    add_values(page, s, bytes);
    add_points(page, c, s, bytes);
    add_faces(page, s, bytes);
    sn_status status = add_outline(page, c, s, bytes);
    sn_buffer_text(page, "></canvas></div>\n");
    sn_free(bytes);
    return status;
}

static sn_status add_bodies(sn_report *report, skin *skins, int count, const sn_body *bodies) {
    sn_buffer *page = &report->page;
    cube c;
    int where[2];
    for (int b = 0; b < count; b++) SN_TRY(skin_create(&bodies[b], &skins[b]));
    if (!measure(skins, count, &c, where)) {
        sn_report_missing(
            report,
            "No picture: node %d of “%s” (counted from 0) has a position that is not a "
            "number.",
            where[1], bodies[where[0]].title);
        return SN_OK;
    }
    sn_buffer_print(page, "<div class=\"bodies\" data-half=\"%.9g\">\n", 0.5 * c.size);
    for (int b = 0; b < count; b++) SN_TRY(add_body(page, &c, &skins[b]));
    sn_buffer_text(
        page, "</div>\n<div class=\"hint\">Drag to turn; click, then scroll to zoom; "
              "double-click to go back. Keys: arrows, + − 0.</div>\n"
              "<noscript><div class=\"note\">This figure needs JavaScript.</div></noscript>\n");
    report->has_bodies = true;
    return SN_OK;
}

void sn_report_bodies(sn_report *report, int count, const sn_body *bodies, const char *caption) {
    SN_ASSERT(count >= 1);
    skin *skins = sn_alloc((size_t)count, sizeof *skins);
    sn_buffer_text(&report->page, "<figure>\n");
    sn_status status = skins ? add_bodies(report, skins, count, bodies) : SN_E_MEMORY;
    if (status != SN_OK) report->page.status = status;
    sn_report_end_figure(report, caption);
    for (int b = 0; skins && b < count; b++) skin_free(&skins[b]);
    sn_free(skins);
}
