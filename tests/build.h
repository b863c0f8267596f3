// Tissues and cases that tests build in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <math.h>
#include <string.h>

#include "check.h"
#include "sinew/model.h"

/// A tissue with a law by name and its defaults, of the density of water, without memory.
static inline sn_tissue make_tissue(const char *law) {
    sn_tissue t = sn_tissue_default();
    snprintf(t.name, sizeof t.name, "%s", law);
    t.law = sn_law_find(law);
    assert_non_null(t.law);
    sn_param_defaults(t.law->params, t.law->param_count, 0, t.value);
    t.density = 1000;
    t.memory = sn_memory_none();
    return t;
}

static inline sn_tissue neo_hookean(double shear, double bulk) {
    sn_tissue t = make_tissue("neo-hookean");
    CHECK_OK(sn_tissue_set(&t, "shear_modulus", shear));
    CHECK_OK(sn_tissue_set(&t, "bulk_modulus", bulk));
    return t;
}

static inline sn_tissue demiray(double c, double b, double bulk) {
    sn_tissue t = make_tissue("demiray");
    CHECK_OK(sn_tissue_set(&t, "c", c));
    CHECK_OK(sn_tissue_set(&t, "b", b));
    CHECK_OK(sn_tissue_set(&t, "bulk_modulus", bulk));
    return t;
}

static inline sn_tissue guccione(double C, double bulk) {
    sn_tissue t = make_tissue("guccione");
    CHECK_OK(sn_tissue_set(&t, "C", C));
    CHECK_OK(sn_tissue_set(&t, "bf", 8));
    CHECK_OK(sn_tissue_set(&t, "bt", 2));
    CHECK_OK(sn_tissue_set(&t, "bfs", 4));
    CHECK_OK(sn_tissue_set(&t, "bulk_modulus", bulk));
    return t;
}

static inline sn_memory prony(double g1, double tau1, double g2, double tau2) {
    sn_memory m = {.law = sn_memory_law_find("prony"), .terms = 2};
    assert_non_null(m.law);
    m.value[0] = g1;
    m.value[1] = g2;
    m.value[2] = tau1;
    m.value[3] = tau2;
    return m;
}

/// A case on a mesh of a built-in shape, all one tissue, without supports.
static inline sn_case *make_case(const sn_shape_def *shape, const sn_tissue *tissue) {
    sn_case *c;
    CHECK_OK(sn_case_create(&c));
    c->has_shape = true;
    c->shape = *shape;
    CHECK_OK(sn_mesh_build(&c->shape, &c->mesh));
    c->tissue = sn_alloc((size_t)c->mesh->region_count, sizeof *c->tissue);
    for (int r = 0; r < c->mesh->region_count; r++) c->tissue[r] = *tissue;
    c->until = 1;
    c->output_every = 0.1;
    c->springs.precision = SN_DOUBLE;
    return c;
}

/// A block of cells[0] x cells[1] x cells[2] cells.
static inline sn_case *make_block(const double size[3], const int cells[3], sn_pattern pattern,
                                  const sn_tissue *tissue) {
    const sn_shape_def shape = {.shape = SN_SHAPE_BLOCK,
                                .pattern = pattern,
                                .size = {size[0], size[1], size[2]},
                                .cells = {cells[0], cells[1], cells[2]}};
    return make_case(&shape, tissue);
}

/// Fibres and second axes at random in every cell.
static inline void turn_fibres(sn_case *c, uint64_t seed) {
    c->fibres.rule = SN_FIBRES_LISTED;
    c->fibres.count = c->mesh->cell_count;
    c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
    for (int k = 0; k < 6 * c->mesh->cell_count; k++)
        c->fibres.listed[k] = check_random(&seed, -1, 1);
}

/// Moves every node by up to `part` of an edge, so that no cell is like another. Positions only:
/// call it before anything is built on the mesh.
static inline void jitter(sn_case *c, double part, uint64_t seed) {
    double h[3];
    for (int d = 0; d < 3; d++) h[d] = c->shape.size[d] / c->shape.cells[d];
    for (int k = 0; k < 3 * c->mesh->node_count; k++)
        c->mesh->node[k] += check_random(&seed, -part, part) * h[k % 3];
    c->has_shape = false;
}

static inline int surface_of(const sn_case *c, const char *name) {
    const int surface = sn_mesh_surface(c->mesh, name);
    assert_true(surface >= 0);
    return surface;
}

/// fix: of "xyz".
static inline sn_support *add_support(sn_case *c, const char *surface, const char *fix) {
    c->support = sn_resize(c->support, (size_t)c->support_count + 1, sizeof *c->support);
    sn_support *s = &c->support[c->support_count++];
    *s = (sn_support){.surface = surface_of(c, surface)};
    for (; *fix; fix++) s->fix[*fix - 'x'] = true;
    return s;
}

static inline sn_history *make_ramp(double start, double ramp) {
    sn_history *h;
    CHECK_OK(sn_history_create(1, 2, (double[]){start, start + ramp}, (double[]){0, 1}, &h));
    return h;
}

/// factor: ramp to 1 in `ramp` seconds.
static inline sn_load *add_load(sn_case *c, sn_load_kind kind, const char *surface, double x,
                                double y, double z, double ramp) {
    c->load = sn_resize(c->load, (size_t)c->load_count + 1, sizeof *c->load);
    sn_load *l = &c->load[c->load_count++];
    *l = (sn_load){.kind = kind, .surface = surface_of(c, surface), .vector = {x, y, z}};
    if (ramp > 0) l->factor = make_ramp(0, ramp);
    return l;
}

static inline void add_probe(sn_case *c, const char *name, sn_probe_kind kind, const char *surface,
                             double x, double y, double z) {
    c->probe = sn_resize(c->probe, (size_t)c->probe_count + 1, sizeof *c->probe);
    sn_probe *p = &c->probe[c->probe_count++];
    *p = (sn_probe){.kind = kind, .point = {x, y, z}};
    snprintf(p->name, sizeof p->name, "%s", name);
    if (kind == SN_PROBE_REACTION) p->surface = surface_of(c, surface);
}

static inline void add_tool(sn_case *c, const char *name, double radius, const double at[3],
                            const double way[3], double ramp) {
    c->tool = sn_resize(c->tool, (size_t)c->tool_count + 1, sizeof *c->tool);
    sn_tool *t = &c->tool[c->tool_count++];
    *t = (sn_tool){.kind = SN_TOOL_SPHERE, .radius = radius, .at = {at[0], at[1], at[2]}};
    snprintf(t->name, sizeof t->name, "%s", name);
    double value[6] = {0, 0, 0, way[0], way[1], way[2]};
    CHECK_OK(sn_history_create(3, 2, (double[]){0, ramp}, value, &t->path));
}

static inline double last_value(const sn_record *r, const char *column) {
    const double *v = sn_record_values(r, column);
    assert_non_null(v);
    return v[r->rows - 1];
}
