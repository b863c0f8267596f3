// Built-in shapes: block, tube, cylinder, ellipsoid.
// SPDX-License-Identifier: Apache-2.0
//
// A shape gives nodes, tetrahedra and, for each node, one bit a surface it lies on.
// sn_mesh_finish() turns the tetrahedra the right way and finds the boundary; a boundary face lies
// on a surface when its three nodes do.
#include <stdint.h>
#include <string.h>

#include "base/vector.h"
#include "model/disc.h"
#include "model/lattice.h"
#include "model/mesh.h"

#define PI 3.14159265358979323846

static const char axis_name[3][8] = {"x", "y", "z"};
static const char round_name[3][8] = {"radial", "around", "along"};

static sn_status check_length(const char *what, double value) {
    if (value > 0 && isfinite(value)) return SN_OK;
    return sn_fail(SN_E_RANGE, "%s is %g m: it must be positive and finite", what, value);
}

static sn_status check_cells(const int cells[3], const char name[3][8], int least_around) {
    for (int d = 0; d < 3; d++) {
        int least = d == 1 ? least_around : 1;
        if (cells[d] < least)
            return sn_fail(SN_E_RANGE, "cells [%d, %d, %d]: %d along \"%s\", at least %d expected",
                           cells[0], cells[1], cells[2], cells[d], name[d], least);
    }
    return SN_OK;
}

// Tetrahedra within SN_CELLS_MAX, nodes within int. Both are counted in wide numbers beforehand.
static sn_status check_total(const int cells[3], double tetrahedra, double nodes) {
    if (tetrahedra <= SN_CELLS_MAX && nodes <= INT32_MAX / 4) return SN_OK;
    return sn_fail(
        SN_E_RANGE,
        "cells [%d, %d, %d] make %.0f tetrahedra: at most %d are possible; take fewer cells",
        cells[0], cells[1], cells[2], tetrahedra, SN_CELLS_MAX);
}

// Finishes the mesh and names its surfaces: bit s of on[node] says that the node lies on surface s.
static sn_status name_surfaces(sn_mesh *mesh, const unsigned char *on, const char *const *name,
                               int count) {
    SN_TRY(sn_mesh_finish(mesh));
    int boundary = mesh->surface_count - 1;
    sn_surface *grown = sn_resize(mesh->surface, (size_t)(boundary + 1 + count), sizeof *grown);
    if (!grown) return SN_E_MEMORY;
    mesh->surface = grown;
    grown[count] = grown[boundary]; // it stays the last
    memset(grown, 0, (size_t)count * sizeof *grown);
    mesh->surface_count = count + 1;

    const sn_surface *all = &grown[count];
    for (int s = 0; s < count; s++) {
        strcpy(grown[s].name, name[s]);
        int faces = 0;
        for (int pass = 0; pass < 2; pass++) {
            if (pass == 1) SN_TRY(sn_surface_reserve(&grown[s], faces));
            faces = 0;
            for (int f = 0; f < all->face_count; f++) {
                const int *node = all->face + 3 * (size_t)f;
                if (!(on[node[0]] & on[node[1]] & on[node[2]] & (1 << s))) continue;
                if (pass == 1) {
                    memcpy(grown[s].face + 3 * (size_t)faces, node, 3 * sizeof *node);
                    grown[s].cell[faces] = all->cell[f];
                }
                faces++;
            }
        }
    }
    return SN_OK;
}

// Bits 2 d + side for the nodes on the low and high end of direction d.
static void mark_ends(const sn_lattice *lattice, unsigned char *on) {
    int n[3];
    sn_lattice_nodes(lattice, n);
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                int at[3] = {i, j, k}, bits = 0;
                for (int d = 0; d < 3; d++) {
                    bits |= (at[d] == 0) << (2 * d);
                    bits |= (at[d] == n[d] - 1) << (2 * d + 1);
                }
                *on++ = (unsigned char)bits;
            }
}

// Puts every centre into the mean of the eight corners of its cell.
static void place_centres(const sn_lattice *l, double *node) {
    int n[3];
    sn_lattice_nodes(l, n);
    double *out = node + 3 * (size_t)sn_lattice_corner_count(l);
    for (int k = 0; k < l->cells[2]; k++)
        for (int j = 0; j < l->cells[1]; j++)
            for (int i = 0; i < l->cells[0]; i++, out += 3)
                for (int c = 0; c < 8; c++) {
                    int at =
                        i + (c & 1) + n[0] * ((j + (c >> 1 & 1)) % n[1] + n[1] * (k + (c >> 2)));
                    for (int d = 0; d < 3; d++) out[d] += node[3 * (size_t)at + (size_t)d] / 8;
                }
}

// The position of lattice node (i, j, k).
typedef void place_node(const sn_shape_def *def, int i, int j, int k, double *x);

// Grading: along an edge of length L the length of a cell grows as exp(g |s - s0|) with the share s
// of the cells, away from the point p that s0 is at; g gives the far end `ratio` times the shortest
// cell. So x - p = +-(h/g) (exp(g |s - s0|) - 1), and the two sides of p fix s0:
//     p (exp(g (1 - s0)) - 1) = (L - p) (exp(g s0) - 1),   g = ln(ratio) / max(s0, 1 - s0).
// It is the same curve for any number of cells: a mesh of twice the cells has all the old nodes.
typedef struct grading {
    double growth, share, scale; // g, s0, h/g
} grading;

static grading find_grading(double length, double point, double ratio) {
    double low = 0, high = 1;
    for (int turn = 0; turn < 60; turn++) {
        double s0 = 0.5 * (low + high), g = log(ratio) / fmax(s0, 1 - s0);
        if ((length - point) * expm1(g * s0) > point * expm1(g * (1 - s0)))
            high = s0;
        else
            low = s0;
    }
    double s0 = point <= 0 ? 0 : point >= length ? 1 : 0.5 * (low + high);
    double g = log(ratio) / fmax(s0, 1 - s0);
    return (grading){g, s0, length / (expm1(g * s0) + expm1(g * (1 - s0)))};
}

static double graded(const sn_shape_def *def, int d, int at) {
    double length = def->size[d], share = (double)at / def->cells[d];
    if (at == 0) return 0;
    if (at == def->cells[d]) return length;
    grading g = find_grading(length, def->towards[d], def->ratio);
    double far = share - g.share;
    return def->towards[d] + copysign(g.scale * expm1(g.growth * fabs(far)), far);
}

static bool is_graded(const sn_shape_def *def) {
    return def->ratio > 0 && def->ratio != 1;
}

static void place_block(const sn_shape_def *def, int i, int j, int k, double *x) {
    int at[3] = {i, j, k};
    for (int d = 0; d < 3; d++)
        x[d] =
            is_graded(def) ? graded(def, d, at[d]) : def->size[d] * ((double)at[d] / def->cells[d]);
}

static void place_tube(const sn_shape_def *def, int i, int j, int k, double *x) {
    double s = (double)i / def->cells[0], angle = 2 * PI * j / def->cells[1];
    double radius = (1 - s) * def->inner_radius + s * def->outer_radius;
    x[0] = radius * cos(angle);
    x[1] = radius * sin(angle);
    x[2] = def->length * ((double)k / def->cells[2]);
}

static sn_status build_lattice(const sn_shape_def *def, bool ring, place_node *place,
                               const char *const *name, sn_mesh **mesh) {
    sn_lattice lattice = {.ring = ring, .pattern = def->pattern};
    memcpy(lattice.cells, def->cells, sizeof lattice.cells);
    double tetrahedra = sn_lattice_cell_count(&lattice), nodes = sn_lattice_node_count(&lattice);
    SN_TRY(check_total(def->cells, tetrahedra, nodes));

    sn_status status;
    unsigned char *on = sn_alloc((size_t)nodes, 1);
    if (!on) return SN_E_MEMORY;
    SN_TRY_GOTO(status, sn_mesh_create((int)nodes, (int)tetrahedra, 1, 0, mesh));
    double *x = (*mesh)->node;
    int n[3];
    sn_lattice_nodes(&lattice, n);
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++, x += 3) place(def, i, j, k, x);
    if (def->pattern == SN_PATTERN_BCC) place_centres(&lattice, (*mesh)->node);
    sn_lattice_cut(&lattice, (*mesh)->cell);
    mark_ends(&lattice, on);
    if (ring) // bits 2 and 3 are the seam, which is none: inner outer bottom top
        for (int a = 0; a < (int)nodes; a++) on[a] = (unsigned char)((on[a] & 3) | on[a] >> 4 << 2);
    SN_TRY_GOTO(status, name_surfaces(*mesh, on, name, ring ? 4 : 6));
fail:
    sn_free(on);
    return status;
}

static sn_status build_block(const sn_shape_def *def, sn_mesh **mesh) {
    static const char *const name[] = {"left", "right", "front", "back", "bottom", "top"};
    for (int d = 0; d < 3; d++) {
        char what[SN_NAME_MAX] = "size along ";
        strcat(what, axis_name[d]);
        SN_TRY(check_length(what, def->size[d]));
    }
    SN_TRY(check_cells(def->cells, axis_name, 1));
    if (def->ratio != 0 && !(def->ratio >= 1 && def->ratio <= 100))
        return sn_fail(SN_E_RANGE, "grading ratio %g: 1 (even) to 100 expected", def->ratio);
    for (int d = 0; d < 3 && is_graded(def); d++)
        if (!(def->towards[d] >= 0 && def->towards[d] <= def->size[d]))
            return sn_fail(SN_E_RANGE,
                           "grading towards %s = %g m: a point of the block expected, 0 to %g m",
                           axis_name[d], def->towards[d], def->size[d]);
    return build_lattice(def, false, place_block, name, mesh);
}

// A body-centred ring is cut along the lines between centres of neighbouring cells. They must pass
// outside the inner edge of the face between the cells: r_middle cos^2(pi/n) > r_inner, in the
// outermost cells. Returns the least number of cells around.
static double least_around_bcc(const sn_shape_def *def) {
    double thick = (def->outer_radius - def->inner_radius) / def->cells[0];
    double inner = def->outer_radius - thick;
    double needed = PI / asin(sqrt(thick / (2 * inner + thick)));
    return fmax(3, floor(needed) + 1);
}

static sn_status build_tube(const sn_shape_def *def, sn_mesh **mesh) {
    static const char *const name[] = {"inner", "outer", "bottom", "top"};
    SN_TRY(check_length("inner_radius", def->inner_radius));
    SN_TRY(check_length("outer_radius", def->outer_radius));
    SN_TRY(check_length("length", def->length));
    if (def->outer_radius <= def->inner_radius)
        return sn_fail(SN_E_RANGE, "outer_radius %g m must be larger than inner_radius %g m",
                       def->outer_radius, def->inner_radius);
    SN_TRY(check_cells(def->cells, round_name, 3));
    int around = def->cells[1];
    if (def->pattern == SN_PATTERN_MIRRORED && around % 2)
        return sn_fail(
            SN_E_RANGE,
            "%d cells around: the mirrored pattern closes only with an even number; take "
            "%d, or pattern bcc or kuhn",
            around, around + 1);
    if (def->pattern == SN_PATTERN_BCC && around < least_around_bcc(def))
        return sn_fail(
            SN_E_RANGE,
            "%d cells around: pattern bcc needs %.0f at least with %d through this wall; "
            "take more around, or pattern mirrored",
            around, least_around_bcc(def), def->cells[0]);
    return build_lattice(def, true, place_tube, name, mesh);
}

// Places the points of the disc on every level, and marks the surfaces they lie on.
typedef void place_levels(const sn_shape_def *def, int points, const double *point,
                          unsigned char *on, double *x);

// A disc of `radial` rings, extruded in `layers` layers; three surfaces.
static sn_status build_over_disc(const sn_shape_def *def, int radial, int layers,
                                 place_levels *place, const char *const *name, sn_mesh **mesh) {
    const int around = def->cells[1];
    // a ring has 3 points at least, so this many rings are too many whatever they hold
    SN_TRY(check_total(def->cells, 6.0 * radial, 0));
    double wide_points = sn_disc_point_count(radial, around);
    double wide_triangles = sn_disc_triangle_count(radial, around);
    SN_TRY(check_total(def->cells, 3 * wide_triangles * layers, wide_points * (layers + 1.0)));

    int points = (int)wide_points, triangles = (int)wide_triangles;
    size_t nodes = (size_t)points * ((size_t)layers + 1);
    sn_status status = SN_E_MEMORY;
    double *point = sn_alloc((size_t)points * 2, sizeof *point);
    int *triangle = sn_alloc((size_t)triangles * 3, sizeof *triangle);
    unsigned char *on = sn_alloc(nodes, 1);
    if (!point || !triangle || !on) goto fail;
    SN_TRY_GOTO(status, sn_mesh_create((int)nodes, 3 * triangles * layers, 1, 0, mesh));
    sn_disc_cut(radial, around, point, triangle);
    place(def, points, point, on, (*mesh)->node);
    sn_disc_extrude(points, triangles, triangle, layers, def->pattern == SN_PATTERN_MIRRORED,
                    (*mesh)->cell);
    SN_TRY_GOTO(status, name_surfaces(*mesh, on, name, 3));
fail:
    sn_free(point);
    sn_free(triangle);
    sn_free(on);
    return status;
}

static void place_cylinder(const sn_shape_def *def, int points, const double *point,
                           unsigned char *on, double *x) {
    int rim = points - def->cells[1];
    for (int k = 0; k <= def->cells[2]; k++)
        for (int p = 0; p < points; p++, x += 3) {
            x[0] = def->radius * point[2 * (size_t)p];
            x[1] = def->radius * point[2 * (size_t)p + 1];
            x[2] = def->length * ((double)k / def->cells[2]);
            *on++ = (unsigned char)((p >= rim) | (k == 0) << 1 | (k == def->cells[2]) << 2);
        }
}

static sn_status build_cylinder(const sn_shape_def *def, sn_mesh **mesh) {
    static const char *const name[] = {"outer", "bottom", "top"};
    SN_TRY(check_length("radius", def->radius));
    SN_TRY(check_length("length", def->length));
    SN_TRY(check_cells(def->cells, round_name, 3));
    if (def->pattern == SN_PATTERN_BCC)
        return sn_fail(SN_E_UNSUPPORTED,
                       "pattern bcc is not possible in a cylinder, whose cells are "
                       "not rectangular: take mirrored or kuhn");
    return build_over_disc(def, def->cells[0], def->cells[2], place_cylinder, name, mesh);
}

// Angle of the cut from the apex, seen in the circle that a half axis `end` along z scales.
static double angle_of_base(double base, double end) {
    return acos(-base / end);
}

// A disc of meridians and circles, bent over the wall: the rim is the base.
static void place_ellipsoid(const sn_shape_def *def, int points, const double *point,
                            unsigned char *on, double *x) {
    const int layers = def->cells[0], rim = points - def->cells[1];
    for (int k = 0; k <= layers; k++) {
        const double s = (double)k / layers;
        const double side = (1 - s) * def->inner[0] + s * def->outer[0];
        const double end = (1 - s) * def->inner[1] + s * def->outer[1];
        const double last = angle_of_base(def->base, end);
        for (int p = 0; p < points; p++, x += 3) {
            const double *at = point + 2 * (size_t)p, radius = hypot(at[0], at[1]);
            // on the rim the radius is 1 but for rounding, and z is the base's
            const double angle = p >= rim ? last : radius * last;
            const double out = radius > 0 ? side * sin(angle) / radius : 0;
            x[0] = out * at[0];
            x[1] = out * at[1];
            x[2] = p >= rim ? def->base : -end * cos(angle);
            *on++ = (unsigned char)((k == 0) | (k == layers) << 1 | (p >= rim) << 2);
        }
    }
}

static sn_status build_ellipsoid(const sn_shape_def *def, sn_mesh **mesh) {
    static const char *const name[] = {"inner", "outer", "base"};
    static const char wall_name[3][8] = {"through", "around", "along"};
    static const char *const axis[] = {"short", "long"};
    for (int k = 0; k < 2; k++) {
        SN_TRY(check_length(k ? "inner, long" : "inner, short", def->inner[k]));
        SN_TRY(check_length(k ? "outer, long" : "outer, short", def->outer[k]));
        if (def->outer[k] <= def->inner[k])
            return sn_fail(SN_E_RANGE,
                           "the %s half axis of the outer wall, %g m, must be larger "
                           "than that of the inner, %g m",
                           axis[k], def->outer[k], def->inner[k]);
    }
    if (!(fabs(def->base) < def->inner[1]))
        return sn_fail(SN_E_RANGE,
                       "base at z = %g m does not cut the inner wall, which ends at %g "
                       "and %g m",
                       def->base, -def->inner[1], def->inner[1]);
    SN_TRY(check_cells(def->cells, wall_name, 3));
    if (def->pattern == SN_PATTERN_BCC)
        return sn_fail(SN_E_UNSUPPORTED, "pattern bcc is not possible in an ellipsoid, whose cells "
                                         "are not rectangular: take mirrored or kuhn");
    return build_over_disc(def, def->cells[2], def->cells[0], place_ellipsoid, name, mesh);
}

sn_status sn_mesh_build(const sn_shape_def *def, sn_mesh **mesh) {
    *mesh = NULL;
    sn_status status = SN_OK;
    switch (def->shape) {
    case SN_SHAPE_BLOCK: status = build_block(def, mesh); break;
    case SN_SHAPE_CYLINDER: status = build_cylinder(def, mesh); break;
    case SN_SHAPE_TUBE: status = build_tube(def, mesh); break;
    case SN_SHAPE_ELLIPSOID: status = build_ellipsoid(def, mesh); break;
    }
    if (status != SN_OK) {
        sn_mesh_destroy(*mesh);
        *mesh = NULL;
        return status;
    }
    strcpy((*mesh)->region_name[0], "body");
    return SN_OK;
}
