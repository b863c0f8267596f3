// Runs the models of a comparison and holds them against the reference.
// SPDX-License-Identifier: Apache-2.0
//
// One case, one mesh, one material: P2P1 finite elements are the reference, P1 finite elements show
// what the mesh alone costs, the spring rungs what the springs cost. All hand out their fields at
// the same nodes, cells and times, so that differences need no interpolation. Only the estimate of
// the reference's own error compares two meshes: there the nodes of the coarser one are looked up
// in the finer one.
#include "sinew/compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compare/norms.h"
#include "sinew/continuum.h"
#include "sinew/springs.h"

typedef sn_status run_function(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                               sn_record *history);

// which part of the whole a run is, for the progress of the whole
typedef struct progress_part {
    const sn_output *output;
    const char *name;
    double from, to;
} progress_part;

typedef struct run_context {
    sn_capture *capture;
    progress_part part;
} run_context;

static sn_status take_frame(void *context, const sn_frame *frame) {
    return sn_capture_frame(((run_context *)context)->capture, frame);
}

static void pass_progress(void *context, double done, const char *text) {
    const progress_part *part = &((run_context *)context)->part;
    if (!part->output || !part->output->progress) return;
    char line[SN_TEXT_MAX];
    snprintf(line, sizeof line, "%s: %s", part->name, text);
    part->output->progress(part->output->context, part->from + done * (part->to - part->from),
                           line);
}

// runs one model; a refusal or an early end is noted in the model, not an error of the comparison
static sn_status run_model(const sn_case *c, run_function *run, const progress_part *part,
                           sn_comparison_model *model, sn_capture *capture) {
    snprintf(model->name, sizeof model->name, "%s", part->name);
    SN_TRY(sn_record_create(part->name, &model->history));
    *capture = (sn_capture){.nodes = c->mesh->node_count, .cells = c->mesh->cell_count};
    run_context context = {capture, *part};
    sn_output output = {.context = &context, .frame = take_frame, .progress = pass_progress};
    sn_status status = run(c, &output, &model->summary, model->history);
    if (status == SN_E_MEMORY || status == SN_E_STOPPED) return status;
    if (status != SN_OK)
        snprintf(model->summary.reason, sizeof model->summary.reason, "%s", sn_error_text());
    model->done = status == SN_OK && model->summary.converged;
    return SN_OK;
}

// ends of the model's and the reference's last common frame, for the pictures
static sn_status keep_last(const sn_capture *a, const sn_capture *b, sn_comparison_model *model) {
    int frames = a->frames < b->frames ? a->frames : b->frames;
    size_t nodes = (size_t)a->nodes, at = (size_t)(frames - 1) * nodes * 3;
    model->displacement = sn_alloc(nodes, 3 * sizeof(double));
    model->error = sn_alloc(nodes, sizeof(double));
    if (!model->displacement || !model->error) return SN_E_MEMORY;
    memcpy(model->displacement, a->displacement + at, nodes * 3 * sizeof(double));
    for (size_t i = 0; i < nodes; i++) {
        double sum = 0;
        for (size_t k = 0; k < 3; k++) {
            double d = a->displacement[at + 3 * i + k] - b->displacement[at + 3 * i + k];
            sum += d * d;
        }
        model->error[i] = sqrt(sum);
    }
    return SN_OK;
}

static sn_status measure(const sn_mesh *mesh, const sn_capture *capture,
                         const sn_capture *reference, const sn_comparison_model *truth,
                         sn_comparison_model *model) {
    double *node = NULL, *cell = NULL;
    sn_status status;
    model->displacement_rms = model->displacement_max = model->reaction_rms = NAN;
    model->stress_rms = model->energy = NAN;
    if (capture->frames == 0) return SN_OK; // refused before the first frame
    SN_TRY_GOTO(status, sn_node_weights(mesh, &node));
    SN_TRY_GOTO(status, sn_cell_weights(mesh, &cell));
    sn_displacement_error(capture, reference, node, &model->displacement_rms,
                          &model->displacement_max);
    double scale = sn_displacement_scale(reference);
    model->displacement_rms /= scale;
    model->displacement_max /= scale;
    model->stress_rms = sn_stress_error(capture, reference, cell) / sn_stress_scale(reference);
    model->reaction_rms = sn_reaction_error(model->history, truth->history);
    model->energy =
        fabs(model->summary.instant_J - truth->summary.instant_J) / fabs(truth->summary.instant_J);
    SN_TRY_GOTO(status, keep_last(capture, reference, model));
fail:
    sn_free(node);
    sn_free(cell);
    return status;
}

//---- the reference and its own error -------------------------------------------------------------

// displacement of a captured run at a material point by linear interpolation in the cell around it
static sn_status sample(const sn_mesh *mesh, const sn_capture *run, int frame, const double *point,
                        double u[3]) {
    int cell;
    double w[4];
    SN_TRY(sn_mesh_locate(mesh, point, &cell, w));
    for (int d = 0; d < 3; d++) {
        u[d] = 0;
        for (int k = 0; k < 4; k++) {
            size_t node = (size_t)mesh->cell[4 * cell + k];
            u[d] += w[k] *
                    run->displacement[((size_t)frame * (size_t)run->nodes + node) * 3 + (size_t)d];
        }
    }
    return SN_OK;
}

// rms and maximum of the difference of two runs on different meshes at the last frame, over the
// nodes of `coarse`, relative to the largest displacement there
static sn_status mesh_difference(const sn_mesh *coarse, const sn_capture *on_coarse,
                                 const sn_mesh *fine, const sn_capture *on_fine, double *rms,
                                 double *max) {
    int frames = on_coarse->frames < on_fine->frames ? on_coarse->frames : on_fine->frames;
    double sum = 0, scale = 0;
    *max = 0;
    for (int i = 0; i < coarse->node_count; i++) {
        double u[3], v[3], d = 0;
        SN_TRY(sample(coarse, on_coarse, frames - 1, coarse->node + 3 * i, u));
        SN_TRY(sample(fine, on_fine, frames - 1, coarse->node + 3 * i, v));
        for (int k = 0; k < 3; k++) d += (u[k] - v[k]) * (u[k] - v[k]);
        sum += d;
        *max = fmax(*max, sqrt(d));
        scale = fmax(scale, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    }
    *rms = sqrt(sum / coarse->node_count) / scale;
    *max /= scale;
    return SN_OK;
}

static sn_status other_mesh(const sn_case *c, sn_mesh **other, bool *coarser) {
    *coarser = c->has_shape;
    for (int k = 0; k < 3; k++)
        if (c->shape.cells[k] < 2) *coarser = false;
    // halving the cells around a tube leaves a coarse polygon that is another body
    if (c->shape.shape != SN_SHAPE_BLOCK) *coarser = false;
    if (!*coarser) return sn_mesh_refine(c->mesh, other);
    sn_shape_def def = c->shape;
    for (int k = 0; k < 3; k++) def.cells[k] /= 2;
    return sn_mesh_build(&def, other);
}

// The difference of two meshes is (2^p - 1) times the error of the finer one, p = 2 the order that
// displacement and reaction reach where edges and contact limit smoothness.
static sn_status estimate(const sn_case *c, const sn_capture *run, const progress_part *part,
                          sn_comparison *out) {
    sn_mesh *mesh = NULL;
    sn_case *other = NULL;
    sn_comparison_model twin = {0};
    sn_capture capture = {0};
    bool coarser;
    sn_status status;
    SN_TRY_GOTO(status, other_mesh(c, &mesh, &coarser));
    status = sn_case_on_mesh(c, mesh, &other);
    if (status != SN_OK) sn_mesh_destroy(mesh);
    if (status != SN_OK) goto fail;
    SN_TRY_GOTO(status, run_model(other, sn_continuum_run, part, &twin, &capture));
    sn_comparison_model *r = &out->reference;
    if (!twin.done) {
        snprintf(out->reference_text, sizeof out->reference_text,
                 "P2P1 finite elements on the case's mesh; their own error is not known, because "
                 "the run on the %s mesh did not end: %s",
                 coarser ? "coarser" : "refined", twin.summary.reason);
        goto fail;
    }
    double factor = coarser ? 1.0 / 3 : 4.0 / 3;
    if (coarser)
        status = mesh_difference(other->mesh, &capture, c->mesh, run, &r->displacement_rms,
                                 &r->displacement_max);
    else
        status = mesh_difference(c->mesh, run, other->mesh, &capture, &r->displacement_rms,
                                 &r->displacement_max);
    if (status != SN_OK) goto fail;
    r->displacement_rms *= factor;
    r->displacement_max *= factor;
    r->reaction_rms = factor * sn_reaction_error(r->history, twin.history);
    r->energy =
        factor * fabs(twin.summary.instant_J - r->summary.instant_J) / fabs(r->summary.instant_J);
    snprintf(out->reference_text, sizeof out->reference_text,
             "P2P1 finite elements (quadratic displacement, linear pressure) on the case's mesh, "
             "%d unknowns. Own error: difference to the same elements on a %s mesh of %d nodes, "
             "times %s (Richardson, order 2)",
             r->summary.unknowns, coarser ? "coarser" : "refined", other->mesh->node_count,
             coarser ? "1/3" : "4/3");
fail:
    sn_record_destroy(twin.history);
    sn_capture_release(&capture);
    sn_case_destroy(other);
    return status;
}

//---- the comparison ------------------------------------------------------------------------------

typedef struct model_plan {
    const char *name;
    run_function *run;
    sn_rung rung;
} model_plan;

static const model_plan plans[] = {
    {"central+volume", sn_springs_run, SN_RUNG_CENTRAL},
    {"coupled+volume", sn_springs_run, SN_RUNG_COUPLED},
    {"smoothed+volume", sn_springs_run, SN_RUNG_SMOOTHED},
    {"P1 finite elements", sn_continuum_run, SN_RUNG_COUPLED},
};

#define PLANS ((int)(sizeof plans / sizeof plans[0]))

sn_status sn_compare(const sn_case *c, const sn_output *output, sn_comparison *comparison) {
    *comparison = (sn_comparison){0};
    sn_case *own = NULL;
    sn_capture truth = {0}, capture = {0};
    sn_comparison_model *reference = &comparison->reference;
    sn_status status;
    // a copy whose settings may be changed, on a mesh of its own
    sn_mesh *mesh;
    SN_TRY(sn_mesh_copy(c->mesh, &mesh));
    status = sn_case_on_mesh(c, mesh, &own);
    if (status != SN_OK) sn_mesh_destroy(mesh);
    if (status != SN_OK) goto fail;

    own->continuum.element = SN_ELEMENT_P2P1;
    progress_part part = {output, "P2P1 reference", 0, 0.4};
    SN_TRY_GOTO(status, run_model(own, sn_continuum_run, &part, reference, &truth));
    if (!reference->done) {
        status = sn_fail(SN_E_SOLVER, "the reference did not run to its end: %s",
                         reference->summary.reason);
        goto fail;
    }
    reference->displacement_rms = reference->displacement_max = NAN;
    reference->reaction_rms = reference->stress_rms = reference->energy = NAN;
    part = (progress_part){output, "P2P1 on another mesh", 0.4, 0.5};
    SN_TRY_GOTO(status, estimate(own, &truth, &part, comparison));
    SN_TRY_GOTO(status, keep_last(&truth, &truth, reference));

    for (int m = 0; m < PLANS; m++) {
        sn_comparison_model *model = &comparison->model[comparison->model_count++];
        own->springs.rung = plans[m].rung;
        own->springs.volume = true;
        own->continuum.element = SN_ELEMENT_P1;
        part = (progress_part){output, plans[m].name, 0.5 + 0.5 * m / PLANS,
                               0.5 + 0.5 * (m + 1) / PLANS};
        SN_TRY_GOTO(status, run_model(own, plans[m].run, &part, model, &capture));
        SN_TRY_GOTO(status, measure(own->mesh, &capture, &truth, reference, model));
        sn_capture_release(&capture);
    }
fail:
    sn_capture_release(&truth);
    sn_capture_release(&capture);
    sn_case_destroy(own);
    if (status != SN_OK) sn_comparison_destroy(comparison);
    return status;
}

static void release_model(sn_comparison_model *model) {
    sn_record_destroy(model->history);
    sn_free(model->displacement);
    sn_free(model->error);
}

void sn_comparison_destroy(sn_comparison *comparison) {
    release_model(&comparison->reference);
    for (int m = 0; m < comparison->model_count; m++) release_model(&comparison->model[m]);
    *comparison = (sn_comparison){0};
}
