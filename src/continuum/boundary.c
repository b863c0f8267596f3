// What acts on the body from outside: gravity, traction, follower pressure, tools.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/boundary.h"

#include <math.h>
#include <string.h>

//---- creation -----------------------------------------------------------------------------------

static sn_status make_gravity(const sn_case *c, const sn_fe_space *s, sn_fe_boundary *b) {
    const double *g = c->gravity;
    if (g[0] == 0.0 && g[1] == 0.0 && g[2] == 0.0) return SN_OK;
    b->gravity = sn_alloc(3 * (size_t)s->nodes, sizeof *b->gravity);
    if (!b->gravity) return SN_E_MEMORY;
    int width = s->batch_cells, nodes = s->element.nodes;
    for (int k = 0; k < s->batches; k++) {
        const int *node = s->node + (size_t)k * (size_t)(nodes * width);
        double density = c->tissue[s->batch_region[k]].density;
        if (!isfinite(density))
            return sn_fail(SN_E_DEFINITION, "region \"%s\": gravity needs the tissue's density",
                           c->mesh->region_name[s->batch_region[k]]);
        for (int a = 0; a < nodes; a++) {
            double share = nodes == 4 ? 0.25 : a < 4 ? -0.05 : 0.2; // int N_a / volume
            for (int at = 0; at < s->batch_count[k]; at++)
                for (int i = 0; i < 3; i++)
                    b->gravity[3 * node[a * width + at] + i] +=
                        share * density * s->volume[k * width + at] * g[i];
        }
    }
    return SN_OK;
}

static sn_status make_traction(const sn_case *c, const sn_fe_space *s, int load,
                               sn_fe_boundary *b) {
    sn_fe_faces faces;
    int width = s->element.face_nodes;
    SN_TRY(sn_fe_faces_of(s, c->mesh, c->load[load].surface, &faces));
    double *f = b->traction[load] = sn_alloc(3 * (size_t)s->nodes, sizeof *f);
    for (int k = 0; f && k < faces.count; k++)
        for (int a = 0; a < width; a++) {
            double share = width == 3 || a >= 3 ? 1.0 / 3.0 : 0.0; // int N_a / area
            for (int i = 0; i < 3; i++)
                f[3 * faces.node[k * width + a] + i] +=
                    share * faces.area[k] * c->load[load].vector[i];
        }
    sn_fe_faces_free(&faces);
    return f ? SN_OK : SN_E_MEMORY;
}

// A force at a material point, shared by the nodes of its cell as their shape functions are there.
static sn_status make_force(const sn_case *c, const sn_fe_space *s, int load, sn_fe_boundary *b) {
    int cell, nodes = s->element.nodes;
    double weight[4], shape[SN_FE_NODES];
    SN_TRY(sn_mesh_locate(c->mesh, c->load[load].point, &cell, weight));
    double *f = b->traction[load] = sn_alloc(3 * (size_t)s->nodes, sizeof *f);
    if (!f) return SN_E_MEMORY;
    int node[SN_FE_NODES];
    sn_fe_cell_nodes(s, c->mesh, cell, node);
    sn_fe_cell_shape(nodes, weight, shape);
    for (int a = 0; a < nodes; a++)
        for (int i = 0; i < 3; i++) f[3 * node[a] + i] += shape[a] * c->load[load].vector[i];
    return SN_OK;
}

// P1: one spot a node; P2: one a quadrature point of each face.
static sn_status place_spots(const sn_fe_space *s, const sn_fe_faces *faces, sn_fe_boundary *b) {
    const sn_fe_element *e = &s->element;
    if (e->face_nodes == 3) {
        b->spot = sn_alloc((size_t)s->nodes, sizeof *b->spot);
        if (!b->spot) return SN_E_MEMORY;
        for (int k = 0; k < 3 * faces->count; k++)
            b->spot[faces->node[k]].area += faces->area[k / 3] / 3.0;
        for (int a = 0; a < s->nodes; a++)
            if (b->spot[a].area > 0.0)
                b->spot[b->spots++] = (sn_fe_spot){1, {a}, {1.0}, b->spot[a].area};
        return SN_OK;
    }
    b->spot = sn_alloc((size_t)(faces->count * e->face_points), sizeof *b->spot);
    if (!b->spot) return SN_E_MEMORY;
    for (int f = 0; f < faces->count; f++)
        for (int q = 0; q < e->face_points; q++) {
            sn_fe_spot *to = b->spot + b->spots++;
            to->count = e->face_nodes;
            to->area = e->face_weight[q] * faces->area[f];
            for (int a = 0; a < e->face_nodes; a++) {
                to->node[a] = faces->node[f * e->face_nodes + a];
                to->shape[a] = e->face_shape[q][a];
            }
        }
    return SN_OK;
}

static sn_status make_contact(const sn_case *c, const sn_fe_space *s, sn_fe_boundary *b) {
    if (c->tool_count == 0) return SN_OK;
    sn_fe_faces faces;
    int surface = sn_mesh_surface(c->mesh, "boundary");
    if (surface < 0) return sn_fail_within(SN_E_MESH, "tools touch the surface 'boundary'");
    b->penalty = sn_case_penalty(c);
    SN_TRY(sn_fe_faces_of(s, c->mesh, surface, &faces));
    sn_status status = place_spots(s, &faces, b);
    sn_fe_faces_free(&faces);
    SN_TRY(status);
    size_t pairs = (size_t)c->tool_count * (size_t)b->spots;
    b->before = sn_alloc(pairs, sizeof *b->before);
    b->after = sn_alloc(pairs, sizeof *b->after);
    b->tool_force = sn_alloc((size_t)c->tool_count, sizeof *b->tool_force);
    return b->before && b->after && b->tool_force ? SN_OK : SN_E_MEMORY;
}

void sn_fe_boundary_destroy(sn_fe_boundary *b, const sn_case *c) {
    if (!b) return;
    for (int k = 0; k < c->load_count; k++) {
        if (b->traction) sn_free(b->traction[k]);
        if (b->pressed) sn_fe_faces_free(b->pressed + k);
    }
    void *const parts[] = {b->gravity, b->traction, b->pressed,   b->spot,
                           b->before,  b->after,    b->tool_force};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(b);
}

sn_status sn_fe_boundary_create(const sn_case *c, const sn_fe_space *s, sn_fe_boundary **out) {
    sn_status status = SN_E_MEMORY;
    sn_fe_boundary *b = *out = sn_alloc(1, sizeof *b);
    if (!b) return SN_E_MEMORY;
    b->symmetric = true;
    for (int k = 0; k < c->tool_count; k++) b->symmetric &= !(c->tool[k].friction > 0.0);
    b->traction = sn_alloc((size_t)c->load_count, sizeof *b->traction);
    b->pressed = sn_alloc((size_t)c->load_count, sizeof *b->pressed);
    if (!b->traction || !b->pressed) goto fail;
    SN_TRY_GOTO(status, make_gravity(c, s, b));
    for (int k = 0; k < c->load_count; k++) {
        if (c->load[k].kind == SN_LOAD_TRACTION) SN_TRY_GOTO(status, make_traction(c, s, k, b));
        if (c->load[k].kind == SN_LOAD_FORCE) SN_TRY_GOTO(status, make_force(c, s, k, b));
        if (c->load[k].kind != SN_LOAD_PRESSURE) continue;
        b->symmetric = false;
        SN_TRY_GOTO(status, sn_fe_faces_of(s, c->mesh, c->load[k].surface, b->pressed + k));
    }
    SN_TRY_GOTO(status, make_contact(c, s, b));
    return SN_OK;
fail:
    sn_fe_boundary_destroy(b, c);
    *out = NULL;
    return status;
}

//---- pressure -----------------------------------------------------------------------------------

// [v] with [v] w = v x w
static void cross_matrix(const double v[3], double out[9]) {
    const double m[9] = {0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0};
    memcpy(out, m, sizeof m);
}

static void add_pressure_tangent(const sn_fe_element *e, int q, const int *node, double p,
                                 const double xi[3], const double eta[3],
                                 const sn_fe_matrix *matrix) {
    double Xi[9], Eta[9];
    cross_matrix(xi, Xi);
    cross_matrix(eta, Eta);
    for (int b = 0; b < e->face_nodes; b++)
        for (int a = 0; a < e->face_nodes; a++) {
            double k[9], by = p * e->face_shape[q][a];
            for (int n = 0; n < 9; n++) // e x eta = -[eta] e
                k[n] = by * (e->face_slope[q][b][1] * Xi[n] - e->face_slope[q][b][0] * Eta[n]);
            sn_fe_matrix_add(matrix, node[a], node[b],
                             sn_fe_pattern_offset(matrix->pattern, node[a], node[b]), k);
        }
}

static void press(const sn_fe_space *s, const sn_fe_faces *faces, double pressure, const double *x,
                  double *external, const sn_fe_matrix *matrix) {
    const sn_fe_element *e = &s->element;
    for (int f = 0; f < faces->count; f++)
        for (int q = 0; q < e->face_points; q++) {
            const int *node = faces->node + f * e->face_nodes;
            double xi[3] = {0}, eta[3] = {0};
            for (int a = 0; a < e->face_nodes; a++)
                for (int i = 0; i < 3; i++) {
                    double at = s->rest[3 * node[a] + i] + x[3 * node[a] + i];
                    xi[i] += e->face_slope[q][a][0] * at;
                    eta[i] += e->face_slope[q][a][1] * at;
                }
            double p = 0.5 * e->face_weight[q] * pressure; // the reference triangle has area 1/2
            const double normal[3] = {xi[1] * eta[2] - xi[2] * eta[1],
                                      xi[2] * eta[0] - xi[0] * eta[2],
                                      xi[0] * eta[1] - xi[1] * eta[0]};
            for (int a = 0; a < e->face_nodes; a++)
                for (int i = 0; i < 3; i++)
                    external[3 * node[a] + i] -= p * e->face_shape[q][a] * normal[i];
            if (matrix) add_pressure_tangent(e, q, node, p, xi, eta, matrix);
        }
}

//---- contact ------------------------------------------------------------------------------------

static void touch(sn_fe_boundary *b, const sn_case *c, const sn_fe_space *s, int t, double time,
                  const double *x, double *external, const sn_fe_matrix *matrix) {
    sn_pose pose;
    sn_tool_pose(c->tool + t, time, &pose);
    memset(b->tool_force[t], 0, sizeof b->tool_force[t]);
    for (int k = 0; k < b->spots; k++) {
        const sn_fe_spot *spot = b->spot + k;
        double position[3] = {0}, force[3], tangent[9];
        for (int a = 0; a < spot->count; a++)
            for (int i = 0; i < 3; i++)
                position[i] +=
                    spot->shape[a] * (s->rest[3 * spot->node[a] + i] + x[3 * spot->node[a] + i]);
        size_t at = (size_t)t * (size_t)b->spots + (size_t)k;
        if (!sn_tool_contact(c->tool + t, &pose, position, b->penalty * spot->area, b->before + at,
                             b->after + at, force, matrix ? tangent : NULL))
            continue;
        for (int i = 0; i < 3; i++) b->tool_force[t][i] -= force[i];
        for (int a = 0; a < spot->count; a++)
            for (int i = 0; i < 3; i++)
                external[3 * spot->node[a] + i] += spot->shape[a] * force[i];
        if (!matrix) continue;
        for (int a = 0; a < spot->count; a++)
            for (int d = 0; d < spot->count; d++) {
                double block[9];
                for (int n = 0; n < 9; n++) block[n] = spot->shape[a] * spot->shape[d] * tangent[n];
                sn_fe_matrix_add(
                    matrix, spot->node[a], spot->node[d],
                    sn_fe_pattern_offset(matrix->pattern, spot->node[a], spot->node[d]), block);
            }
    }
}

//---- all together -------------------------------------------------------------------------------

void sn_fe_boundary_apply(sn_fe_boundary *b, const sn_case *c, const sn_fe_space *s, double t,
                          double scale, const double *x, double *external,
                          const sn_fe_matrix *matrix) {
    size_t count = 3 * (size_t)s->nodes;
    for (size_t n = 0; b->gravity && n < count; n++) external[n] += scale * b->gravity[n];
    for (int k = 0; k < c->load_count; k++) {
        double factor = 1.0;
        sn_history_at(c->load[k].factor, t, &factor);
        factor *= scale;
        for (size_t n = 0; b->traction[k] && n < count; n++)
            external[n] += factor * b->traction[k][n];
        if (c->load[k].kind == SN_LOAD_PRESSURE)
            press(s, b->pressed + k, factor * c->load[k].pressure, x, external, matrix);
    }
    for (int k = 0; k < c->tool_count; k++) touch(b, c, s, k, t, x, external, matrix);
}

void sn_fe_boundary_load(const sn_fe_boundary *b, const sn_case *c, const sn_fe_space *s, int load,
                         const double *x, double *external) {
    const double *dead = load < 0 ? b->gravity : b->traction[load];
    for (size_t n = 0; dead && n < 3 * (size_t)s->nodes; n++) external[n] += dead[n];
    if (load >= 0 && c->load[load].kind == SN_LOAD_PRESSURE)
        press(s, b->pressed + load, c->load[load].pressure, x, external, NULL);
}

void sn_fe_boundary_commit(sn_fe_boundary *b, const sn_case *c) {
    size_t pairs = (size_t)c->tool_count * (size_t)b->spots;
    if (pairs) memcpy(b->before, b->after, pairs * sizeof *b->before);
}
