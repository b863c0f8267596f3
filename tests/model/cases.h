// A small case that the tests of model/ change in one place each.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes.h"

static const sn_param test_params[] = {{.name = "modulus",
                                        .symbol = "E",
                                        .unit = "Pa",
                                        .min = 0,
                                        .max = INFINITY,
                                        .min_open = true,
                                        .init = NAN,
                                        .text = "stiffness"}};

static void test_moduli(const double *value, int terms, sn_moduli *out) {
    (void)terms;
    *out = (sn_moduli){.young = value[0], .shear = value[0] / 3, .bulk = 1000 * value[0]};
}

/// A law of the wanted kind; only what a case asks of it.
#define TEST_LAW(kind_, fibres_)                                                                   \
    {                                                                                              \
        .name = "test", .text = "for tests", .source = "none", .kind = (kind_),                    \
        .fibres = (fibres_), .param_count = 1, .params = test_params, .moduli = test_moduli        \
    }
static const sn_law solid_law = TEST_LAW(SN_LAW_SOLID, false);
static const sn_law fibre_law = TEST_LAW(SN_LAW_SOLID, true);
static const sn_law uniaxial_law = TEST_LAW(SN_LAW_UNIAXIAL, false);
static const sn_law membrane_law = TEST_LAW(SN_LAW_MEMBRANE, false);

/// A block of tissue that passes sn_case_check(), with nothing on it.
static inline sn_case *block_case(void) {
    sn_case *c = NULL;
    CHECK_OK(sn_case_create(&c));
    c->shape = block(SN_PATTERN_MIRRORED, 3, 4, 2);
    c->has_shape = true;
    c->mesh = build(&c->shape);
    c->tissue = sn_alloc(1, sizeof *c->tissue);
    c->tissue[0] = sn_tissue_default();
    strcpy(c->tissue[0].name, "liver");
    c->tissue[0].law = &solid_law;
    c->tissue[0].memory = sn_memory_none();
    c->tissue[0].value[0] = 9100;
    c->tissue[0].density = 1060;
    c->until = 1;
    c->output_every = 0.1;
    (void)fibre_law, (void)uniaxial_law, (void)membrane_law;
    return c;
}

/// Adds a support; `fix` holds letters of "xyz".
static inline void hold(sn_case *c, const char *surface, const char *fix) {
    c->support = sn_resize(c->support, (size_t)c->support_count + 1, sizeof *c->support);
    sn_support *s = &c->support[c->support_count++];
    *s = (sn_support){.surface = sn_mesh_surface(c->mesh, surface)};
    for (int d = 0; d < 3; d++) s->fix[d] = strchr(fix, "xyz"[d]) != NULL;
}

/// Adds a displacement load; NAN is a free component.
static inline sn_load *move(sn_case *c, const char *surface, double x, double y, double z) {
    c->load = sn_resize(c->load, (size_t)c->load_count + 1, sizeof *c->load);
    sn_load *l = &c->load[c->load_count++];
    *l = (sn_load){.kind = SN_LOAD_DISPLACEMENT, .surface = sn_mesh_surface(c->mesh, surface)};
    double v[3] = {x, y, z};
    for (int d = 0; d < 3; d++) {
        l->free[d] = isnan(v[d]);
        l->vector[d] = isnan(v[d]) ? 0 : v[d];
    }
    return l;
}

static inline sn_history *ramp(double from, double to, double end) {
    sn_history *h = NULL;
    CHECK_OK(sn_history_create(1, 2, (double[]){0, end}, (double[]){from, to}, &h));
    return h;
}

static inline sn_tool *add_sphere(sn_case *c, const char *name, double radius, double x, double y,
                                  double z) {
    c->tool = sn_resize(c->tool, (size_t)c->tool_count + 1, sizeof *c->tool);
    sn_tool *t = &c->tool[c->tool_count++];
    *t = (sn_tool){.radius = radius, .at = {x, y, z}};
    strcpy(t->name, name);
    return t;
}

static inline void add_probe(sn_case *c, const char *name, sn_probe_kind kind, double x, double y,
                             double z, const char *surface) {
    c->probe = sn_resize(c->probe, (size_t)c->probe_count + 1, sizeof *c->probe);
    sn_probe *p = &c->probe[c->probe_count++];
    *p = (sn_probe){.kind = kind, .point = {x, y, z}};
    if (surface) p->surface = sn_mesh_surface(c->mesh, surface);
    strcpy(p->name, name);
}
