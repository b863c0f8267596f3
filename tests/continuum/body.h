// Cases for the tests of the continuum, built in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parts.h"
#include "sinew/continuum.h"

static inline sn_tissue body_tissue(const char *law, double bulk) {
    sn_tissue t = make_tissue(law);
    if (bulk > 0) CHECK_OK(sn_tissue_set(&t, "bulk_modulus", bulk));
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
    static const double spectrum[] = {0.2, 0.02, 30}, terms[] = {0.3, 0.25, 0.2, 3.0},
                        kelvin[] = {0.4, 0.7};
    sn_tissue t = artery(1900, kappa, 0.5, bulk);
    body_set_memory(&t, "fung-spectrum", 0, spectrum, 3);
    t.fibre = t.memory;
    if (isfinite(bulk)) {
        body_set_memory(&t, "kelvin", 0, kelvin, 2);
        t.volumetric = t.memory;
    }
    body_set_memory(&t, "prony", 2, terms, 4);
    t.branched = true;
    CHECK_OK(sn_tissue_check(&t));
    return t;
}

/// A case on a mesh of a built-in shape, which it does not know of, with one tissue; takes nothing.
static inline sn_case *body_case(const sn_shape_def *def, const sn_tissue *tissue,
                                 sn_element element) {
    sn_case *c = make_case(def, tissue);
    c->has_shape = false;
    c->tool = sn_alloc(2, sizeof *c->tool);
    c->continuum.element = element;
    c->continuum.steps = 1;
    c->continuum.tolerance = 1e-10;
    c->output_every = 1;
    return c;
}

static inline sn_case *body_block(double x, double y, double z, int nx, int ny, int nz,
                                  const sn_tissue *tissue, sn_element element) {
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {x, y, z}, .cells = {nx, ny, nz}};
    return body_case(&def, tissue, element);
}

static inline void body_support(sn_case *c, const char *on, bool x, bool y, bool z) {
    sn_support *s = add_support(c, on, "");
    s->fix[0] = x, s->fix[1] = y, s->fix[2] = z;
}

#define ANY ((double)NAN) // a component of a displacement that is free

/// A displacement; NAN components are free.
static inline void body_move(sn_case *c, const char *on, double x, double y, double z,
                             sn_history *factor) {
    const double v[3] = {x, y, z};
    sn_load *load = add_load(c, SN_LOAD_DISPLACEMENT, on, 0, 0, 0, 0);
    load->factor = factor;
    for (int i = 0; i < 3; i++) {
        load->free[i] = isnan(v[i]);
        load->vector[i] = load->free[i] ? 0 : v[i];
    }
}

static inline void body_pull(sn_case *c, const char *on, double x, double y, double z,
                             sn_history *factor) {
    add_load(c, SN_LOAD_TRACTION, on, x, y, z, 0)->factor = factor;
}

static inline void body_press(sn_case *c, const char *on, double pressure, sn_history *factor) {
    sn_load *load = add_load(c, SN_LOAD_PRESSURE, on, 0, 0, 0, 0);
    load->pressure = pressure;
    load->factor = factor;
}

static inline void body_probe(sn_case *c, const char *name, double x, double y, double z) {
    add_probe(c, name, SN_PROBE_POINT, NULL, x, y, z);
}

static inline void body_reaction(sn_case *c, const char *name, const char *on) {
    add_probe(c, name, SN_PROBE_REACTION, on, 0, 0, 0);
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

/// Moves the nodes inside a mesh at random by up to `by` of its shortest edge.
static inline void body_distort(sn_case *c, double by, uint64_t seed) {
    sn_mesh *m = c->mesh;
    int *nodes, count, *edges, edge_count;
    double shortest = (double)INFINITY;
    CHECK_OK(sn_mesh_surface_nodes(m, surface_of(c, "boundary"), &nodes, &count));
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
