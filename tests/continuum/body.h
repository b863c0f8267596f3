// Cases for the tests of the continuum, built in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"
#include "sinew/continuum.h"

static inline sn_tissue body_tissue(const char *law, double bulk) {
    sn_tissue t = sn_tissue_default();
    t.law = sn_law_find(law);
    assert_non_null(t.law);
    sn_param_defaults(t.law->params, t.law->param_count, 0, t.value);
    if (bulk > 0) CHECK_OK(sn_tissue_set(&t, "bulk_modulus", bulk));
    t.density = 1000;
    return t;
}

static inline sn_tissue body_demiray(double c, double b, double bulk) {
    sn_tissue t = body_tissue("demiray", bulk);
    CHECK_OK(sn_tissue_set(&t, "c", c));
    CHECK_OK(sn_tissue_set(&t, "b", b));
    return t;
}

static inline sn_tissue body_guccione(double C, double bulk) {
    static const char *const name[] = {"C", "bf", "bt", "bfs"};
    const double value[] = {C, 8, 2, 4};
    sn_tissue t = body_tissue("guccione", bulk);
    for (int k = 0; k < 4; k++) CHECK_OK(sn_tissue_set(&t, name[k], value[k]));
    return t;
}

static inline sn_tissue body_neo_hookean(double shear, double bulk) {
    sn_tissue t = body_tissue("neo-hookean", bulk);
    CHECK_OK(sn_tissue_set(&t, "shear_modulus", shear));
    return t;
}

static inline void body_set_memory(sn_tissue *t, const char *law, int terms, const double *value,
                                   int count) {
    t->memory = sn_memory_none();
    t->memory.law = sn_memory_law_find(law);
    assert_non_null(t->memory.law);
    t->memory.terms = terms;
    memcpy(t->memory.value, value, (size_t)count * sizeof *value);
    CHECK_OK(sn_memory_check(&t->memory));
}

/// hgo whose matrix, volume and fibres have a memory each; without the volume's where
/// incompressible.
static inline sn_tissue body_artery(double kappa, double bulk) {
    static const double spectrum[] = {0.2, 0.02, 30}, prony[] = {0.3, 0.25, 0.2, 3.0},
                        kelvin[] = {0.4, 0.7};
    static const char *const name[] = {"mu", "k1", "k2", "kappa", "angle"};
    const double value[] = {1300, 1900, 1.6, kappa, 0.5};
    sn_tissue t = body_tissue("hgo", bulk);
    for (int k = 0; k < 5; k++) CHECK_OK(sn_tissue_set(&t, name[k], value[k]));
    body_set_memory(&t, "fung-spectrum", 0, spectrum, 3);
    t.fibre = t.memory;
    if (isfinite(bulk)) {
        body_set_memory(&t, "kelvin", 0, kelvin, 2);
        t.volumetric = t.memory;
    }
    body_set_memory(&t, "prony", 2, prony, 4);
    t.branched = true;
    CHECK_OK(sn_tissue_check(&t));
    return t;
}

/// A case on a mesh of a built-in shape with one tissue; takes nothing.
static inline sn_case *body_case(const sn_shape_def *def, const sn_tissue *tissue,
                                 sn_element element) {
    sn_case *c;
    CHECK_OK(sn_case_create(&c));
    CHECK_OK(sn_mesh_build(def, &c->mesh));
    c->tissue = sn_alloc((size_t)c->mesh->region_count, sizeof *c->tissue);
    for (int r = 0; r < c->mesh->region_count; r++) c->tissue[r] = *tissue;
    c->support = sn_alloc(8, sizeof *c->support);
    c->load = sn_alloc(8, sizeof *c->load);
    c->tool = sn_alloc(2, sizeof *c->tool);
    c->probe = sn_alloc(8, sizeof *c->probe);
    c->continuum.element = element;
    c->continuum.steps = 1;
    c->continuum.tolerance = 1e-10;
    c->until = 1;
    c->output_every = 1;
    return c;
}

static inline sn_case *body_block(double x, double y, double z, int nx, int ny, int nz,
                                  const sn_tissue *tissue, sn_element element) {
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {x, y, z}, .cells = {nx, ny, nz}};
    return body_case(&def, tissue, element);
}

static inline int body_surface(const sn_case *c, const char *name) {
    int surface = sn_mesh_surface(c->mesh, name);
    assert_true(surface >= 0);
    return surface;
}

static inline void body_support(sn_case *c, const char *on, bool x, bool y, bool z) {
    c->support[c->support_count++] = (sn_support){body_surface(c, on), {x, y, z}};
}

static inline sn_history *body_ramp(double start, double ramp) {
    sn_history *h;
    const double time[2] = {start, start + ramp}, value[2] = {0, 1};
    CHECK_OK(sn_history_create(1, 2, time, value, &h));
    return h;
}

#define ANY ((double)NAN) // a component of a displacement that is free

/// Fibres and second axes at random in every cell.
static inline void body_turn(sn_case *c, uint64_t seed) {
    c->fibres.rule = SN_FIBRES_LISTED;
    c->fibres.count = c->mesh->cell_count;
    c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
    for (int k = 0; k < 6 * c->mesh->cell_count; k++)
        c->fibres.listed[k] = check_random(&seed, -1, 1);
}

/// A displacement; NAN components are free.
static inline void body_move(sn_case *c, const char *on, double x, double y, double z,
                             sn_history *factor) {
    const double v[3] = {x, y, z};
    sn_load load = {.kind = SN_LOAD_DISPLACEMENT, .surface = body_surface(c, on), .factor = factor};
    for (int i = 0; i < 3; i++) {
        load.free[i] = isnan(v[i]);
        load.vector[i] = load.free[i] ? 0 : v[i];
    }
    c->load[c->load_count++] = load;
}

static inline void body_pull(sn_case *c, const char *on, double x, double y, double z,
                             sn_history *factor) {
    c->load[c->load_count++] = (sn_load){.kind = SN_LOAD_TRACTION,
                                         .surface = body_surface(c, on),
                                         .vector = {x, y, z},
                                         .factor = factor};
}

static inline void body_press(sn_case *c, const char *on, double pressure, sn_history *factor) {
    c->load[c->load_count++] = (sn_load){.kind = SN_LOAD_PRESSURE,
                                         .surface = body_surface(c, on),
                                         .pressure = pressure,
                                         .factor = factor};
}

static inline void body_probe(sn_case *c, const char *name, double x, double y, double z) {
    sn_probe p = {.kind = SN_PROBE_POINT, .point = {x, y, z}};
    snprintf(p.name, sizeof p.name, "%s", name);
    c->probe[c->probe_count++] = p;
}

static inline void body_reaction(sn_case *c, const char *name, const char *on) {
    sn_probe p = {.kind = SN_PROBE_REACTION, .surface = body_surface(c, on)};
    snprintf(p.name, sizeof p.name, "%s", name);
    c->probe[c->probe_count++] = p;
}

/// Three faces of a block on rollers: left x, front y, bottom z.
static inline void body_rollers(sn_case *c) {
    body_support(c, "left", true, false, false);
    body_support(c, "front", false, true, false);
    body_support(c, "bottom", false, false, true);
}

/// Runs a case that must converge.
static inline sn_record *body_run(const sn_case *c, const sn_output *output,
                                  sn_run_summary *summary) {
    sn_record *r;
    CHECK_OK(sn_record_create("test", &r));
    CHECK_OK(sn_continuum_run(c, output, summary, r));
    if (!summary->converged) {
        print_message("not converged: %s\n", summary->reason);
        fail();
    }
    return r;
}

static inline double body_last(const sn_record *r, const char *column) {
    const double *v = sn_record_values(r, column);
    assert_non_null(v);
    return v[r->rows - 1];
}

/// Moves the nodes inside a mesh at random by up to `by` of its shortest edge.
static inline void body_distort(sn_case *c, double by, uint64_t seed) {
    sn_mesh *m = c->mesh;
    int *nodes, count, *edges, edge_count;
    double shortest = (double)INFINITY;
    CHECK_OK(sn_mesh_surface_nodes(m, body_surface(c, "boundary"), &nodes, &count));
    CHECK_OK(sn_mesh_edges(m, &edges, &edge_count));
    for (int e = 0; e < edge_count; e++) {
        double square = 0;
        for (int i = 0; i < 3; i++)
            square += pow(m->node[3 * edges[2 * e] + i] - m->node[3 * edges[2 * e + 1] + i], 2);
        shortest = fmin(shortest, sqrt(square));
    }
    for (int a = 0, k = 0; a < m->node_count; a++) {
        if (k < count && nodes[k] == a) {
            k++;
            continue;
        }
        for (int i = 0; i < 3; i++) m->node[3 * a + i] += check_random(&seed, -by, by) * shortest;
    }
    sn_free(nodes);
    sn_free(edges);
}
