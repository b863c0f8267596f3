// The reference of a comparison with its own error, and whole comparisons.
// SPDX-License-Identifier: Apache-2.0
//
// P2P1 finite elements are the reference, P1 finite elements show what the mesh alone costs, the
// spring rungs what the springs cost. All are held against the reference at the nodes and cells of
// its mesh: displacements of linear cells are known everywhere, while those of the quadratic
// reference are handed out at its corners, where nothing has to be interpolated.
#include "sinew/compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compare/models.h"
#include "sinew/continuum.h"

// above this own error of displacement or response a reference is not called converged
static const double converged = 0.02;

//---- meshes --------------------------------------------------------------------------------------

static sn_status refine(const sn_mesh *mesh, int factor, sn_mesh **out) {
    if (factor < 1 || (factor & (factor - 1)) != 0)
        return sn_fail(SN_E_RANGE,
                       "mesh %d: a mesh from a file is refined by halving its edges, so 1, 2, 4, "
                       "… are possible",
                       factor);
    SN_TRY(sn_mesh_copy(mesh, out));
    for (; factor > 1; factor /= 2) {
        sn_mesh *fine;
        sn_status status = sn_mesh_refine(*out, &fine);
        sn_mesh_destroy(*out);
        *out = NULL;
        SN_TRY(status);
        *out = fine;
    }
    return SN_OK;
}

static sn_status build(const sn_case *c, const sn_shape_def *def, sn_case **out) {
    sn_mesh *mesh = NULL;
    SN_TRY(sn_mesh_build(def, &mesh));
    sn_status status = sn_case_on_mesh(c, mesh, out);
    if (status != SN_OK) {
        sn_mesh_destroy(mesh);
        return status;
    }
    (*out)->shape = *def;
    (*out)->has_shape = true;
    return SN_OK;
}

sn_status sn_compare_mesh(const sn_case *c, int factor, sn_case **out) {
    sn_shape_def def = c->shape;
    *out = NULL;
    if (factor < 1 || factor > 64)
        return sn_fail(SN_E_RANGE, "mesh %d: a factor on the cells of 1 to 64 expected", factor);
    if (c->has_shape) {
        for (int k = 0; k < 3; k++) def.cells[k] *= factor;
        return build(c, &def, out);
    }
    sn_mesh *mesh;
    SN_TRY(refine(c->mesh, factor, &mesh));
    sn_status status = sn_case_on_mesh(c, mesh, out);
    if (status != SN_OK) sn_mesh_destroy(mesh);
    return status;
}

// half the cells along each direction, where there is such a mesh; else twice
static sn_status other_mesh(const sn_case *c, const sn_case *given, sn_case **other,
                            bool *coarser) {
    sn_shape_def def = c->shape;
    *coarser = true;
    if (given) return sn_case_own(given, other);
    *coarser = c->has_shape;
    for (int k = 0; k < 3; k++) {
        *coarser = *coarser && def.cells[k] % 2 == 0;
        def.cells[k] /= 2;
    }
    if (*coarser && build(c, &def, other) == SN_OK) return SN_OK;
    *coarser = false;
    return sn_compare_mesh(c, 2, other);
}

//---- the reference -------------------------------------------------------------------------------

static const sn_model_row reference_row = {"P2P1 reference", "",    sn_continuum_run,
                                           SN_RUNG_COUPLED,  false, -1};
static const sn_model_row twin_row = {"P2P1 on another mesh", "",    sn_continuum_run,
                                      SN_RUNG_COUPLED,        false, -1};

// The difference of two meshes is (2^p - 1) times the error of the finer one, p = 2 the order that
// displacement and reaction reach where edges and contact limit smoothness. It is taken at the
// corners of the coarser mesh.
static sn_status measure(sn_case *c, sn_case *other, bool coarser, const sn_output *output,
                         const sn_capture *run, sn_reference *r) {
    const sn_mesh *points = coarser ? other->mesh : c->mesh;
    sn_sampler sampler = {0};
    sn_capture sampled = {.sampler = &sampler, .nodes = points->node_count};
    sn_capture twin_run = {.nodes = other->mesh->node_count, .cells = other->mesh->cell_count};
    sn_comparison_model twin = {0};
    sn_record *response = NULL;
    sn_status status;
    sampled.cells = points->cell_count;
    SN_TRY_GOTO(status, sn_model_run(other, &twin_row, other->mesh, output, &twin_run, &twin));
    if (!twin.done) {
        snprintf(r->text, sizeof r->text,
                 "P2P1 finite elements, %d nodes of linear cells; their own error is not known, "
                 "because the run on the %s mesh did not end: %s",
                 c->mesh->node_count, coarser ? "coarser" : "refined", twin.summary.reason);
        goto fail;
    }
    const sn_capture *fine = coarser ? run : &twin_run;
    SN_TRY_GOTO(status, sn_sampler_create(coarser ? c->mesh : other->mesh, points, &sampler));
    for (int f = 0; f < fine->frames; f++) {
        size_t u = 3 * (size_t)fine->nodes, s = 6 * (size_t)fine->cells, at = (size_t)f;
        sn_field fields[] = {{"displacement", "m", SN_ON_NODES, 3, fine->displacement + at * u},
                             {"cauchy_stress", "Pa", SN_ON_CELLS, 6, fine->stress + at * s}};
        SN_TRY_GOTO(status, sn_capture_frame(&sampled, &(sn_frame){fine->time[f], 2, fields}));
    }
    // the finer run's response at the corners of the coarser mesh, as the coarser one has its own
    SN_TRY_GOTO(status, sn_model_response(coarser ? c : other, points, &sampled,
                                          coarser ? r->model.history : twin.history, &response));
    sn_comparison_model fine_model = coarser ? r->model : twin; // borrows
    fine_model.response = response;
    sn_comparison_errors *e = &r->model.error;
    SN_TRY_GOTO(status,
                sn_model_errors(points, coarser ? &twin_run : run, coarser ? &twin : &r->model,
                                &sampled, &fine_model, sn_case_memory(c), e));
    double factor = coarser ? 1.0 / 3 : 4.0 / 3;
    double *all[] = {&e->displacement_rms, &e->displacement_max, &e->response_rms,
                     &e->reaction_rms,     &e->stress_rms,       &e->energy,
                     &e->relaxation_max};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) *all[k] *= factor;
    bool good = e->displacement_rms < converged && !(e->response_rms > converged);
    snprintf(r->text, sizeof r->text,
             "%sP2P1 finite elements (quadratic displacement, linear pressure), %d nodes of linear "
             "cells, %d unknowns. Own error: difference to the same elements on a %s mesh of %d "
             "nodes, times %s (Richardson, order 2)",
             good ? "" : "NOT CONVERGED (own error above 2 %): ", c->mesh->node_count,
             r->model.summary.unknowns, coarser ? "coarser" : "refined", other->mesh->node_count,
             coarser ? "1/3" : "4/3");
fail:
    sn_record_destroy(response);
    sn_comparison_model_release(&twin);
    sn_capture_release(&twin_run);
    sn_capture_release(&sampled);
    sn_sampler_release(&sampler);
    return status;
}

// part of the progress of the whole
typedef struct part {
    const sn_output *output;
    double from, to;
} part;

static void pass_part(void *context, double done, const char *text) {
    const part *p = context;
    if (p->output && p->output->progress)
        p->output->progress(p->output->context, p->from + done * (p->to - p->from), text);
}

sn_status sn_reference_create(const sn_case *c, const sn_case *given, const sn_output *output,
                              sn_reference *r) {
    sn_case *own = NULL, *other = NULL;
    sn_capture run = {.nodes = c->mesh->node_count, .cells = c->mesh->cell_count};
    part first = {output, 0, 0.8}, second = {output, 0.8, 1};
    bool coarser;
    sn_status status;
    *r = (sn_reference){.model.error = sn_no_errors()};
    SN_TRY_GOTO(status, sn_mesh_copy(c->mesh, &r->mesh));
    SN_TRY_GOTO(status, sn_case_own(c, &own));
    own->continuum.element = SN_ELEMENT_P2P1;
    sn_output part_output = {.context = &first, .progress = pass_part};
    SN_TRY_GOTO(status,
                sn_model_run(own, &reference_row, own->mesh, &part_output, &run, &r->model));
    const double none = (double)NAN;
    r->model.live = (sn_live){none, none, none, none, none, 0, {0}};
    if (!r->model.done) {
        snprintf(r->text, sizeof r->text,
                 "NONE: P2P1 finite elements did not run to their end, so no error is known: %s",
                 r->model.summary.reason);
        goto fail;
    }
    SN_TRY_GOTO(status, other_mesh(c, given, &other, &coarser));
    other->continuum.element = SN_ELEMENT_P2P1;
    part_output.context = &second;
    SN_TRY_GOTO(status, measure(own, other, coarser, &part_output, &run, r));
    SN_TRY_GOTO(status, sn_model_keep_last(&run, &run, &r->model));
    r->frames = run.frames;
    r->time = run.time;
    r->displacement = run.displacement;
    r->stress = run.stress;
    run = (sn_capture){0};
fail:
    sn_capture_release(&run);
    sn_case_destroy(own);
    sn_case_destroy(other);
    if (status != SN_OK) sn_reference_release(r);
    return status;
}

void sn_reference_release(sn_reference *r) {
    sn_mesh_destroy(r->mesh);
    sn_comparison_model_release(&r->model);
    sn_free(r->time);
    sn_free(r->displacement);
    sn_free(r->stress);
    *r = (sn_reference){0};
}

//---- all at once ---------------------------------------------------------------------------------

sn_status sn_compare(const sn_case *c, int count, const int *models, const sn_output *output,
                     sn_comparison *comparison) {
    int fitting[SN_COMPARE_MODELS_MAX];
    char why[SN_TEXT_MAX];
    part p = {output, 0, 0.5};
    sn_output own = {.context = &p, .progress = pass_part};
    sn_status status;
    *comparison = (sn_comparison){0};
    if (!models) {
        count = 0;
        for (int m = 0; m < sn_compare_model_count(); m++)
            if (sn_compare_model_fits(c, m, why)) fitting[count++] = m;
        models = fitting;
    }
    SN_ASSERT(count <= SN_COMPARE_MODELS_MAX);
    SN_TRY_GOTO(status, sn_reference_create(c, NULL, &own, &comparison->reference));
    if (!comparison->reference.model.done) {
        status = sn_fail(SN_E_SOLVER, "the reference did not run to its end: %s",
                         comparison->reference.model.summary.reason);
        goto fail;
    }
    for (int m = 0; m < count; m++) {
        p = (part){output, 0.5 + 0.5 * m / count, 0.5 + 0.5 * (m + 1) / count};
        SN_TRY_GOTO(status, sn_compare_model(&comparison->reference, c, models[m], &own,
                                             &comparison->model[m]));
        comparison->model_count++;
    }
fail:
    if (status != SN_OK) sn_comparison_destroy(comparison);
    return status;
}

void sn_comparison_destroy(sn_comparison *comparison) {
    sn_reference_release(&comparison->reference);
    for (int m = 0; m < comparison->model_count; m++)
        sn_comparison_model_release(&comparison->model[m]);
    *comparison = (sn_comparison){0};
}
