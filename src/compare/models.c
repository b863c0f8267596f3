// The table of models, and one run of a case with all that is taken from it.
// SPDX-License-Identifier: Apache-2.0
#include "compare/models.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compare/calibrate.h"
#include "compare/cost.h"
#include "compare/response.h"
#include "sinew/continuum.h"
#include "sinew/springs.h"

static const sn_model_row rows[] = {
    {"central", "springs on the edges, constants of the tissue's moduli", sn_springs_run,
     SN_RUNG_CENTRAL, false, -1},
    {"central+volume", "springs on the edges and a nodal volume energy", sn_springs_run,
     SN_RUNG_CENTRAL, true, -1},
    {"coupled", "the six edges of a cell share the tissue's energy", sn_springs_run,
     SN_RUNG_COUPLED, false, -1},
    {"coupled+volume", "the same for the distortion, and a nodal volume energy", sn_springs_run,
     SN_RUNG_COUPLED, true, -1},
    {"smoothed", "the tissue's energy of the strain averaged around an edge", sn_springs_run,
     SN_RUNG_SMOOTHED, false, -1},
    {"smoothed+volume", "the same for the distortion, and a nodal volume energy", sn_springs_run,
     SN_RUNG_SMOOTHED, true, -1},
    {"P1", "linear finite elements: what the mesh alone costs", sn_continuum_run, SN_RUNG_COUPLED,
     false, -1},
    {"calibrated+volume", "central+volume, constants calibrated against the continuum",
     sn_springs_run, SN_RUNG_CENTRAL, true, SN_CALIBRATION_FULL},
    {"uniform+volume", "central+volume, one stiffness for all springs", sn_springs_run,
     SN_RUNG_CENTRAL, true, SN_CALIBRATION_UNIFORM},
    {"lloyd+volume", "central+volume, the rule of Lloyd, Szekely and Harders (2007)",
     sn_springs_run, SN_RUNG_CENTRAL, true, SN_CALIBRATION_LLOYD},
};

const sn_model_row *sn_model_row_at(int model) {
    SN_ASSERT(model >= 0 && model < sn_compare_model_count());
    return &rows[model];
}

int sn_compare_model_count(void) {
    return (int)(sizeof rows / sizeof rows[0]);
}

const char *sn_compare_model_name(int model) {
    return sn_model_row_at(model)->name;
}

const char *sn_compare_model_text(int model) {
    return sn_model_row_at(model)->text;
}

// springs alone have Poisson's ratio 1/4; above 1/3 the volume term is most of the tissue
bool sn_compare_model_fits(const sn_case *c, int model, char why[SN_TEXT_MAX]) {
    const sn_model_row *row = sn_model_row_at(model);
    why[0] = 0;
    if (row->run != sn_springs_run || row->volume) return true;
    for (int r = 0; r < c->mesh->region_count; r++) {
        sn_moduli m;
        sn_tissue_moduli(&c->tissue[r], &m);
        double nu =
            isfinite(m.bulk) ? (3 * m.bulk - 2 * m.shear) / (2 * (3 * m.bulk + m.shear)) : 0.5;
        if (row->rung == SN_RUNG_CENTRAL && nu > 1.0 / 3) {
            snprintf(why, SN_TEXT_MAX,
                     "springs alone have Poisson's ratio 1/4, the tissue has %.4g; --models %s "
                     "runs it",
                     nu, row->name);
            return false;
        }
    }
    if (row->rung == SN_RUNG_CENTRAL) return true;
    snprintf(why, SN_TEXT_MAX, "%s; --models %s runs it",
             row->rung == SN_RUNG_COUPLED ? "it equals P1" : "it locks as P1 does near nu = 1/2",
             row->name);
    return false;
}

//---- one run -------------------------------------------------------------------------------------

typedef struct watcher {
    sn_capture *capture;
    sn_response *response;
    const sn_output *output;
    const char *name;
    double from, to; ///< of the progress
} watcher;

static sn_status take_frame(void *context, const sn_frame *frame) {
    watcher *w = context;
    sn_capture *c = w->capture;
    SN_TRY(sn_capture_frame(c, frame));
    size_t at = 3 * (size_t)c->nodes * (size_t)(c->frames - 1);
    return sn_response_frame(w->response, frame->time, c->displacement + at);
}

static void pass_progress(void *context, double done, const char *text) {
    const watcher *w = context;
    if (!w->output || !w->output->progress) return;
    char line[SN_TEXT_MAX + SN_NAME_MAX];
    snprintf(line, sizeof line, "%s: %s", w->name, text);
    w->output->progress(w->output->context, w->from + done * (w->to - w->from), line);
}

bool sn_case_remembers(const sn_case *c) {
    const sn_memory none = sn_memory_none();
    for (int r = 0; r < c->mesh->region_count; r++)
        for (int part = 0; part < SN_PARTS; part++)
            if (sn_tissue_memory(&c->tissue[r], (sn_part)part)->law != none.law) return true;
    return false;
}

static bool same_memory(const sn_memory *a, const sn_memory *b) {
    return a->law == b->law && a->terms == b->terms &&
           memcmp(a->value, b->value, sizeof a->value) == 0;
}

const sn_memory *sn_case_memory(const sn_case *c) {
    for (int r = 0; r < c->mesh->region_count; r++)
        if (c->tissue[r].branched || !same_memory(&c->tissue[0].memory, &c->tissue[r].memory))
            return NULL;
    return &c->tissue[0].memory;
}

sn_status sn_case_own(const sn_case *c, sn_case **copy) {
    sn_mesh *mesh;
    SN_TRY(sn_mesh_copy(c->mesh, &mesh));
    sn_status status = sn_case_on_mesh(c, mesh, copy);
    if (status != SN_OK) sn_mesh_destroy(mesh);
    return status;
}

sn_status sn_model_response(const sn_case *c, const sn_mesh *points, const sn_capture *capture,
                            const sn_record *history, sn_record **record) {
    sn_response response;
    sn_status status;
    SN_TRY_GOTO(status, sn_response_create(c, points, &response));
    for (int f = 0; f < capture->frames; f++) {
        const double *u = capture->displacement + 3 * (size_t)capture->nodes * (size_t)f;
        SN_TRY_GOTO(status, sn_response_frame(&response, capture->time[f], u));
    }
    sn_response_finish(&response, history);
    *record = response.record;
    response.record = NULL;
fail:
    sn_response_release(&response);
    return status;
}

// One run of the row's engine: frames to capture, what answers to *record.
static sn_status run_engine(const sn_case *c, const sn_model_row *row, const sn_mesh *points,
                            watcher *w, sn_comparison_model *model, sn_record **record) {
    sn_response response = {0};
    sn_status status;
    SN_TRY_GOTO(status, sn_record_create(row->name, &model->history));
    SN_TRY_GOTO(status, sn_record_create(row->name, &model->energy));
    SN_TRY_GOTO(status, sn_response_create(c, points, &response));
    w->response = &response;
    sn_output own = {.context = w,
                     .frame = take_frame,
                     .progress = pass_progress,
                     .energy = row->run == sn_springs_run ? model->energy : NULL};
    double before = sn_memory_watch();
    status = row->run(c, &own, &model->summary, model->history);
    model->peak_memory_bytes = sn_memory_peak(before);
    if (status == SN_E_MEMORY || status == SN_E_STOPPED) goto fail;
    if (status != SN_OK)
        snprintf(model->summary.reason, sizeof model->summary.reason, "%s", sn_error_text());
    model->done = status == SN_OK && model->summary.converged;
    status = SN_OK;
    sn_response_finish(&response, model->history);
    if (model->done || record == &model->response) {
        *record = response.record;
        response.record = NULL;
    }
fail:
    sn_response_release(&response);
    return status;
}

// The same where nothing remembers, for model->elastic: instantaneous constants are elastic ones.
static sn_status run_elastic(sn_case *c, const sn_model_row *row, const sn_mesh *points, watcher *w,
                             sn_comparison_model *model) {
    const int regions = c->mesh->region_count;
    sn_capture capture = {
        .nodes = w->capture->nodes, .cells = w->capture->cells, .sampler = w->capture->sampler};
    sn_comparison_model run = {0};
    sn_tissue *kept = sn_alloc((size_t)regions, sizeof *kept);
    if (!kept) return SN_E_MEMORY;
    memcpy(kept, c->tissue, (size_t)regions * sizeof *kept);
    for (int r = 0; r < regions; r++) {
        c->tissue[r].memory = sn_memory_none();
        c->tissue[r].branched = false;
    }
    w->capture = &capture;
    sn_status status = run_engine(c, row, points, w, &run, &model->elastic);
    memcpy(c->tissue, kept, (size_t)regions * sizeof *kept);
    sn_free(kept);
    sn_capture_release(&capture);
    sn_comparison_model_release(&run);
    return status;
}

sn_status sn_model_run(sn_case *c, const sn_model_row *row, const sn_mesh *points,
                       const sn_output *output, sn_capture *capture, sn_comparison_model *model) {
    sn_response response = {0};
    watcher w = {.capture = capture, .output = output, .name = row->name, .to = 1};
    sn_status status;
    model->error = sn_no_errors();
    snprintf(model->name, sizeof model->name, "%s", row->name);
    SN_TRY_GOTO(status, sn_response_probes(c));
    SN_TRY_GOTO(status, sn_response_create(c, points, &response));
    const bool twice = sn_case_remembers(c) && sn_response_has_force(&response);
    if (twice) w.to = 0.5;
    SN_TRY_GOTO(status, run_engine(c, row, points, &w, model, &model->response));
    w.from = w.to;
    w.to = 1;
    if (twice && model->done) status = run_elastic(c, row, points, &w, model);
fail:
    sn_response_release(&response);
    return status;
}

//---- errors --------------------------------------------------------------------------------------

sn_comparison_errors sn_no_errors(void) {
    const double none = (double)NAN;
    return (sn_comparison_errors){none, none, none, none, none, none, none};
}

sn_status sn_model_errors(const sn_mesh *points, const sn_capture *capture,
                          const sn_comparison_model *model, const sn_capture *truth,
                          const sn_comparison_model *reference, const sn_memory *memory,
                          sn_comparison_errors *error) {
    double *node = NULL, *cell = NULL;
    sn_status status;
    *error = sn_no_errors();
    if (capture->frames == 0) return SN_OK; // refused before the first frame
    SN_TRY_GOTO(status, sn_node_weights(points, &node));
    SN_TRY_GOTO(status, sn_cell_weights(points, &cell));
    sn_displacement_error(capture, truth, node, &error->displacement_rms, &error->displacement_max);
    double scale = sn_displacement_scale(truth);
    error->displacement_rms /= scale;
    error->displacement_max /= scale;
    error->stress_rms = sn_stress_error(capture, truth, cell) / sn_stress_scale(truth);
    error->reaction_rms = sn_reaction_error(model->history, reference->history);
    error->response_rms = sn_response_error(model->response, reference->response);
    const sn_force_pair pair[] = {{model->response, model->elastic},
                                  {reference->response, reference->elastic}};
    SN_TRY_GOTO(status, sn_relaxation_error(memory, &pair[0], &pair[1], &error->relaxation_max));
    double energy = reference->summary.instant_J;
    if (model->done) error->energy = fabs(model->summary.instant_J - energy) / fabs(energy);
fail:
    sn_free(node);
    sn_free(cell);
    return status;
}

sn_status sn_model_keep_last(const sn_capture *a, const sn_capture *b, sn_comparison_model *model) {
    int frames = a->frames < b->frames ? a->frames : b->frames;
    size_t points = (size_t)a->nodes, at = (size_t)(frames - 1) * points * 3;
    if (frames == 0) return SN_OK;
    model->displacement = sn_alloc(points, 3 * sizeof(double));
    model->distance = sn_alloc(points, sizeof(double));
    if (!model->displacement || !model->distance) return SN_E_MEMORY;
    model->points = a->nodes;
    memcpy(model->displacement, a->displacement + at, points * 3 * sizeof(double));
    for (size_t i = 0; i < points; i++) {
        double sum = 0;
        for (size_t k = 0; k < 3; k++) {
            double d = a->displacement[at + 3 * i + k] - b->displacement[at + 3 * i + k];
            sum += d * d;
        }
        model->distance[i] = sqrt(sum);
    }
    return SN_OK;
}

void sn_comparison_model_release(sn_comparison_model *model) {
    sn_record_destroy(model->history);
    sn_record_destroy(model->energy);
    sn_record_destroy(model->response);
    sn_record_destroy(model->elastic);
    sn_free(model->displacement);
    sn_free(model->distance);
    *model = (sn_comparison_model){0};
}

//---- a model against a reference -----------------------------------------------------------------

static sn_status compare(const sn_reference *r, sn_case *own, const sn_model_row *row,
                         const sn_output *output, sn_comparison_model *out) {
    // what the reference left, as if it had just been captured
    const sn_capture truth = {.nodes = r->mesh->node_count,
                              .cells = r->mesh->cell_count,
                              .frames = r->frames,
                              .time = r->time,
                              .displacement = r->displacement,
                              .stress = r->stress};
    sn_sampler sampler = {0};
    sn_capture capture = {.sampler = &sampler, .nodes = truth.nodes, .cells = truth.cells};
    sn_status status;
    SN_TRY_GOTO(status, sn_sampler_create(own->mesh, r->mesh, &sampler));
    SN_TRY_GOTO(status, sn_model_run(own, row, r->mesh, output, &capture, out));
    SN_TRY_GOTO(status, sn_model_errors(r->mesh, &capture, out, &truth, &r->model,
                                        sn_case_memory(own), &out->error));
    SN_TRY_GOTO(status, sn_model_keep_last(&capture, &truth, out));
fail:
    sn_capture_release(&capture);
    sn_sampler_release(&sampler);
    return status;
}

// Gives the case the springs of the row's rule. A rule that cannot be had is noted in the model:
// *possible is false then.
static sn_status constants(sn_case *own, const sn_model_row *row, const sn_output *output,
                           sn_comparison_model *out, bool *possible) {
    *possible = true;
    if (row->rule < 0) return SN_OK;
    sn_spring_set *set = NULL;
    double start = sn_clock();
    sn_status status = sn_calibration_springs(own, (sn_calibration_rule)row->rule, output, &set);
    if (status == SN_E_MEMORY || status == SN_E_STOPPED) return status;
    if (status == SN_OK) {
        out->calibration_s = sn_clock() - start;
        sn_spring_set_destroy(own->springs_given);
        own->springs_given = set;
        return SN_OK;
    }
    *possible = false;
    snprintf(out->name, sizeof out->name, "%s", row->name);
    snprintf(out->summary.reason, sizeof out->summary.reason, "%s", sn_error_text());
    return SN_OK;
}

static sn_live no_live(void) {
    const double none = (double)NAN;
    return (sn_live){none, none, none, none, none, 0, {0}};
}

sn_status sn_compare_model(const sn_reference *r, const sn_case *c, int model,
                           const sn_output *output, sn_comparison_model *out) {
    const sn_model_row *row = sn_model_row_at(model);
    sn_case *own = NULL;
    bool possible;
    *out = (sn_comparison_model){.error = sn_no_errors(), .live = no_live()};
    if (r->frames == 0)
        return sn_fail(SN_E_DEFINITION, "there is no reference to hold \"%s\" against: %s",
                       row->name, r->model.summary.reason);
    sn_status status;
    SN_TRY_GOTO(status, sn_case_own(c, &own));
    own->springs.rung = row->rung;
    own->springs.volume = row->volume;
    own->continuum.element = SN_ELEMENT_P1;
    SN_TRY_GOTO(status, constants(own, row, output, out, &possible));
    if (possible) SN_TRY_GOTO(status, compare(r, own, row, output, out));
    if (possible && row->run == sn_springs_run) sn_live_measure(own, &out->live);
fail:
    sn_case_destroy(own);
    if (status != SN_OK) sn_comparison_model_release(out);
    return status;
}
