// Cases: life, copies, what they prescribe, columns of their history.
// SPDX-License-Identifier: Apache-2.0
#include <stdio.h>
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"

sn_springs_def sn_springs_def_default(void) {
    return (sn_springs_def){.rung = SN_RUNG_COUPLED,
                            .volume = true,
                            .integrator = SN_INTEGRATOR_EXPLICIT,
                            .step = 0,
                            .precision = SN_SINGLE,
                            .threads = 1,
                            .damping = 0,
                            .stiffness_damping = 0,
                            .memory_tolerance = 1e-3};
}

sn_continuum_def sn_continuum_def_default(void) {
    return (sn_continuum_def){.element = SN_ELEMENT_P2P1,
                              .analysis = SN_ANALYSIS_QUASI_STATIC,
                              .steps = 20,
                              .rho_infinity = 0.8,
                              .tolerance = 1e-8,
                              .memory_tolerance = 1e-4};
}

sn_status sn_case_create(sn_case **c) {
    *c = sn_alloc(1, sizeof **c);
    if (!*c) return SN_E_MEMORY;
    (*c)->springs = sn_springs_def_default();
    (*c)->continuum = sn_continuum_def_default();
    return SN_OK;
}

void sn_case_destroy(sn_case *c) {
    if (!c) return;
    sn_mesh_destroy(c->mesh);
    sn_free(c->tissue);
    sn_free(c->support);
    for (int i = 0; i < c->load_count; i++) sn_history_destroy(c->load[i].factor);
    sn_free(c->load);
    for (int i = 0; i < c->tool_count; i++) sn_tool_release(&c->tool[i]);
    sn_free(c->tool);
    sn_free(c->probe);
    for (int i = 0; i < c->cut_count; i++) sn_free(c->cut[i].cell);
    sn_free(c->cut);
    sn_free(c->fibres.listed);
    sn_spring_set_destroy(c->springs_given);
    sn_free(c);
}

// A copy of an array that holds no pointers of its own; NULL when there is no memory.
static void *copy_array(const void *from, int count, size_t size) {
    void *to = sn_alloc((size_t)count, size);
    if (to && count > 0) memcpy(to, from, (size_t)count * size);
    return to;
}

static sn_status copy_loads_and_tools(const sn_case *c, sn_case *to) {
    to->load = sn_alloc((size_t)c->load_count, sizeof *to->load);
    to->tool = sn_alloc((size_t)c->tool_count, sizeof *to->tool);
    if (!to->load || !to->tool) return SN_E_MEMORY;
    for (int i = 0; i < c->load_count; i++) {
        to->load[i] = c->load[i];
        to->load_count = i + 1;
        SN_TRY(sn_history_copy(c->load[i].factor, &to->load[i].factor));
    }
    for (int i = 0; i < c->tool_count; i++) {
        SN_TRY(sn_tool_copy(&c->tool[i], &to->tool[i]));
        to->tool_count = i + 1;
    }
    return SN_OK;
}

static sn_status copy_cuts(const sn_case *c, const sn_mesh *mesh, sn_case *to) {
    to->cut = sn_alloc((size_t)c->cut_count, sizeof *to->cut);
    if (!to->cut) return SN_E_MEMORY;
    for (int i = 0; i < c->cut_count; i++) {
        to->cut[i] = c->cut[i];
        to->cut[i].cell = NULL;
        to->cut_count = i + 1;
        if (c->cut[i].kind != SN_CUT_CELLS) continue;
        if (mesh->cell_count != c->mesh->cell_count)
            return sn_fail(SN_E_DEFINITION,
                           "cut %d: its numbers are of a mesh of %d cells, the other one has %d; "
                           "give a sphere or a box",
                           i + 1, c->mesh->cell_count, mesh->cell_count);
        to->cut[i].cell = copy_array(c->cut[i].cell, c->cut[i].cell_count, sizeof(int));
        if (!to->cut[i].cell) return SN_E_MEMORY;
    }
    return SN_OK;
}

static sn_status check_same_parts(const sn_mesh *from, const sn_mesh *to) {
    if (from->region_count != to->region_count)
        return sn_fail(SN_E_DEFINITION, "the other mesh has %d regions, the case has %d",
                       to->region_count, from->region_count);
    for (int s = 0; s < from->surface_count; s++)
        if (s >= to->surface_count || strcmp(from->surface[s].name, to->surface[s].name))
            return sn_fail(
                SN_E_DEFINITION, "the other mesh has \"%s\" where the case has surface \"%s\"",
                s < to->surface_count ? to->surface[s].name : "no surface", from->surface[s].name);
    return SN_OK;
}

static bool same_mesh(const sn_mesh *a, const sn_mesh *b) {
    if (a->node_count != b->node_count || a->cell_count != b->cell_count) return false;
    const size_t nodes = (size_t)a->node_count, cells = (size_t)a->cell_count;
    return memcmp(a->node, b->node, nodes * 3 * sizeof *a->node) == 0 &&
           memcmp(a->cell, b->cell, cells * 4 * sizeof *a->cell) == 0;
}

sn_status sn_case_on_mesh(const sn_case *c, sn_mesh *mesh, sn_case **copy) {
    *copy = NULL;
    SN_TRY(check_same_parts(c->mesh, mesh));
    sn_case *to = sn_alloc(1, sizeof *to);
    if (!to) return SN_E_MEMORY;
    sn_status status;
    *to = *c;
    to->mesh = NULL; // the caller's until all is done
    to->load_count = to->tool_count = to->cut_count = 0;
    to->load = NULL;
    to->tool = NULL;
    to->cut = NULL;
    to->fibres.listed = NULL;
    to->springs_given = NULL;
    to->tissue = copy_array(c->tissue, c->mesh->region_count, sizeof *c->tissue);
    to->support = copy_array(c->support, c->support_count, sizeof *c->support);
    to->probe = copy_array(c->probe, c->probe_count, sizeof *c->probe);
    if (!to->tissue || !to->support || !to->probe) {
        status = SN_E_MEMORY;
        goto fail;
    }
    SN_TRY_GOTO(status, copy_loads_and_tools(c, to));
    SN_TRY_GOTO(status, copy_cuts(c, mesh, to));
    SN_TRY_GOTO(status, sn_fibres_on_mesh(&c->fibres, c->mesh, mesh, &to->fibres));
    if (same_mesh(c->mesh, mesh))
        SN_TRY_GOTO(status, sn_spring_set_copy(c->springs_given, &to->springs_given));
    to->has_shape = c->has_shape && mesh->node_count == c->mesh->node_count &&
                    mesh->cell_count == c->mesh->cell_count;
    to->mesh = mesh;
    *copy = to;
    return SN_OK;
fail:
    sn_case_destroy(to);
    return status;
}

//---- what is prescribed --------------------------------------------------------------------------

// Marks the directions that `take` has at all nodes of a surface, with their values.
static void prescribe(const sn_mesh *mesh, int surface, const bool take[3], const double at[3],
                      unsigned char *fixed, double *value) {
    const sn_surface *s = &mesh->surface[surface];
    for (size_t i = 0; i < 3 * (size_t)s->face_count; i++) {
        size_t a = (size_t)s->face[i];
        for (unsigned d = 0; d < 3; d++) {
            if (!take[d]) continue;
            fixed[a] = (unsigned char)(fixed[a] | 1u << d);
            value[3 * a + d] = at[d];
        }
    }
}

void sn_case_prescribed(const sn_case *c, double t, unsigned char *fixed, double *value) {
    memset(fixed, 0, (size_t)c->mesh->node_count);
    for (int i = 0; i < c->support_count; i++)
        prescribe(c->mesh, c->support[i].surface, c->support[i].fix, (double[3]){0}, fixed, value);
    for (int i = 0; i < c->load_count; i++) {
        const sn_load *load = &c->load[i];
        if (load->kind != SN_LOAD_DISPLACEMENT) continue;
        double factor, at[3];
        bool take[3];
        sn_history_at(load->factor, t, &factor);
        for (int d = 0; d < 3; d++) {
            at[d] = load->vector[d] * factor;
            take[d] = !load->free[d];
        }
        prescribe(c->mesh, load->surface, take, at, fixed, value);
    }
}

//---- history -------------------------------------------------------------------------------------

static sn_status add_columns(sn_record *history, const char *name, const char *kind,
                             const char *unit) {
    for (int d = 0; d < 3; d++) {
        char column[SN_NAME_MAX];
        int length = snprintf(column, sizeof column, "%s_%s%c", name, kind, "xyz"[d]);
        if (length >= (int)sizeof column)
            return sn_fail(SN_E_DEFINITION,
                           "the name \"%s\" is too long for a column of the history: "
                           "take at most %d letters",
                           name, SN_NAME_MAX - 4);
        SN_TRY(sn_record_add_series(history, column, unit));
    }
    return SN_OK;
}

sn_status sn_case_history_columns(const sn_case *c, sn_record *history) {
    SN_TRY(sn_record_add_series(history, "time", "s"));
    for (int i = 0; i < c->probe_count; i++) {
        bool point = c->probe[i].kind == SN_PROBE_POINT;
        SN_TRY(add_columns(history, c->probe[i].name, point ? "u" : "f", point ? "m" : "N"));
    }
    for (int i = 0; i < c->tool_count; i++) SN_TRY(add_columns(history, c->tool[i].name, "f", "N"));
    return SN_OK;
}

//---- stiffness -----------------------------------------------------------------------------------

double sn_case_penalty(const sn_case *c) {
    double stiffest = 0;
    for (int r = 0; r < c->mesh->region_count; r++) {
        sn_moduli m;
        sn_tissue_moduli(&c->tissue[r], &m);
        stiffest = fmax(stiffest, fmin(m.bulk, 20 * m.shear) + 4 * m.shear / 3);
    }
    int boundary = sn_mesh_surface(c->mesh, "boundary");
    SN_ASSERT(boundary >= 0);
    const sn_surface *s = &c->mesh->surface[boundary];
    double length = 0; // every edge counts twice, or oftener where surfaces touch
    for (int f = 0; f < s->face_count; f++) {
        const int *v = s->face + 3 * (size_t)f;
        for (int i = 0; i < 3; i++)
            length += distance3(c->mesh->node + 3 * (size_t)v[i],
                                c->mesh->node + 3 * (size_t)v[(i + 1) % 3]);
    }
    return 2 * stiffest / (length / (3.0 * s->face_count));
}
