// A case on finer and finer meshes or of a higher order: observed order, extrapolated values,
// estimated errors. SPDX-License-Identifier: Apache-2.0 Source: Roache, J. Fluids Eng. 116 (1994)
// 405 (grid convergence index).
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "continuum/refine.h"

#define ASSUMED_ORDER 2.0 // what displacement and reaction reach where edges and contact limit them
#define LEAST_ORDER 0.5   // outside this band three meshes show no order
#define MOST_ORDER 6.0
#define SAFE_OBSERVED 1.25
#define SAFE_ASSUMED 3.0

//---- one quantity -------------------------------------------------------------------------------

void sn_fe_extrapolate(sn_refined *q, int meshes, double floor) {
    const double *f = q->value;
    double last = f[meshes - 1] - f[meshes - 2], largest = fabs(last), safe = SAFE_ASSUMED;
    q->order = ASSUMED_ORDER;
    if (meshes == 3) {
        double ratio = (f[1] - f[0]) / last, order = log2(ratio);
        largest = fmax(largest, fabs(f[1] - f[0]));
        q->observed = fabs(last) > floor && order >= LEAST_ORDER && order <= MOST_ORDER;
        if (q->observed) {
            q->order = order;
            safe = SAFE_OBSERVED;
        }
    }
    q->extrapolated = f[meshes - 1] + last / (exp2(q->order) - 1.0);
    for (int k = 0; k < meshes; k++) {
        q->error[k] = fmax(safe * fabs(f[k] - q->extrapolated), floor);
        // three meshes without an order: at least what they differ by
        if (meshes == 3 && !q->observed) q->error[k] = fmax(q->error[k], largest);
    }
}

// Two runs: the quadratic value stands for the limit, and the linear one errs by at most twice the
// difference where the higher order at least halves the error; the quadratic one by the difference.
// Three: the quadratic values are two meshes, and what they leave is added to the linear one's.
void sn_fe_extrapolate_order(sn_refined *q, int runs, double floor) {
    const double *f = q->value;
    double raised = fabs(f[1] - f[0]);
    if (runs == 2) {
        q->order = ASSUMED_ORDER;
        q->extrapolated = f[1];
        q->error[0] = fmax(2.0 * raised, floor);
        q->error[1] = fmax(raised, floor);
        return;
    }
    sn_refined quadratic = {.value = {f[1], f[2]}};
    sn_fe_extrapolate(&quadratic, 2, floor);
    q->order = quadratic.order;
    q->extrapolated = quadratic.extrapolated;
    q->error[0] = SAFE_OBSERVED * fabs(f[0] - q->extrapolated) + quadratic.error[1];
    q->error[1] = quadratic.error[0];
    q->error[2] = quadratic.error[1];
}

// The largest end value among the three directions of a probe: what small components are small to.
static double scale_of(const sn_record *const *history, int meshes, int column) {
    int first = 1 + (column - 1) / 3 * 3;
    double scale = 0.0;
    for (int m = 0; m < meshes; m++)
        for (int k = first; k < first + 3 && k < history[m]->series_count; k++)
            scale = fmax(scale, fabs(history[m]->series[k].value[history[m]->rows - 1]));
    return scale;
}

static sn_status sum_up(const sn_case *c, bool order, const sn_record *const *history,
                        sn_refinement *out) {
    int columns = history[0]->series_count;
    if (out->meshes < 2) return SN_OK;
    for (int m = 0; m < out->meshes; m++)
        if (history[m]->rows == 0) return SN_OK;
    out->quantity = sn_alloc((size_t)columns, sizeof *out->quantity);
    if (!out->quantity) return SN_E_MEMORY;
    out->count = columns; // all but the time, and the energy
    for (int k = 0; k < columns; k++) {
        sn_refined *q = out->quantity + k;
        const sn_series *s = history[0]->series + (k + 1 < columns ? k + 1 : 0);
        bool energy = k + 1 == columns;
        snprintf(q->name, sizeof q->name, "%s", energy ? "elastic_J" : s->name);
        snprintf(q->unit, sizeof q->unit, "%s", energy ? "J" : s->unit);
        double scale = energy ? fabs(out->run[0].elastic_J) : scale_of(history, out->meshes, k + 1);
        for (int m = 0; m < out->meshes; m++)
            q->value[m] = energy ? out->run[m].elastic_J
                                 : history[m]->series[k + 1].value[history[m]->rows - 1];
        double floor = c->continuum.tolerance * scale;
        if (order)
            sn_fe_extrapolate_order(q, out->meshes, floor);
        else
            sn_fe_extrapolate(q, out->meshes, floor);
    }
    return SN_OK;
}

//---- the runs ----------------------------------------------------------------------------------

static sn_status finer(const sn_case *c, sn_case **fine) {
    sn_mesh *mesh = NULL;
    sn_shape_def def = c->shape;
    *fine = NULL;
    for (int k = 0; k < 3; k++) def.cells[k] *= 2;
    if (c->has_shape)
        SN_TRY(sn_mesh_build(&def, &mesh));
    else
        SN_TRY(sn_mesh_refine(c->mesh, &mesh));
    sn_status status = sn_case_on_mesh(c, mesh, fine);
    if (status != SN_OK) {
        sn_mesh_destroy(mesh);
        return status;
    }
    (*fine)->shape = def; // sn_case_on_mesh() clears it with another number of cells
    (*fine)->has_shape = c->has_shape;
    return SN_OK;
}

// The same mesh with the quadratic element that any tissue may have.
static sn_status raised(const sn_case *c, sn_case **high) {
    sn_mesh *mesh = NULL;
    SN_TRY(sn_mesh_copy(c->mesh, &mesh));
    sn_status status = sn_case_on_mesh(c, mesh, high);
    if (status != SN_OK) {
        sn_mesh_destroy(mesh);
        return status;
    }
    (*high)->continuum.element = SN_ELEMENT_P2P1;
    return SN_OK;
}

/// Progress of one mesh as a part of the whole.
typedef struct share {
    const sn_output *output; ///< Nullable
    int mesh, meshes;
} share;

// A mesh of half the size takes at least eight times as long.
static void pass_progress(void *context, double done, const char *text) {
    const share *s = context;
    double before = 0.0, all = 0.0;
    char line[SN_TEXT_MAX];
    for (int m = 0; m < s->meshes; m++) {
        all += exp2(3.0 * m);
        if (m < s->mesh) before = all;
    }
    snprintf(line, sizeof line, "mesh %d of %d: %.200s", s->mesh + 1, s->meshes, text);
    s->output->progress(s->output->context, (before + done * exp2(3.0 * s->mesh)) / all, line);
}

static sn_status pass_frame(void *context, const sn_frame *frame) {
    const share *s = context;
    return s->output->frame(s->output->context, frame);
}

// Runs one mesh; *out->reason says why it did not get to its end.
static sn_status run_mesh(const sn_case *c, share *s, sn_record *history, sn_refinement *out) {
    sn_run_summary *run = out->run + out->meshes;
    sn_output output = {.context = s};
    if (s->output && s->output->progress) output.progress = pass_progress;
    if (s->output && s->output->frame && s->mesh == 0) output.frame = pass_frame;
    SN_TRY(sn_continuum_run(c, &output, run, history));
    if (run->converged)
        out->meshes++;
    else
        snprintf(out->reason, sizeof out->reason, "mesh %d of %d nodes: %.200s", s->mesh + 1,
                 c->mesh->node_count, run->reason);
    return SN_OK;
}

void sn_refinement_release(sn_refinement *r) {
    sn_free(r->quantity);
    *r = (sn_refinement){0};
}

static sn_status go(const sn_case *c, int meshes, bool order, const sn_output *output,
                    sn_run_summary *summary, sn_record *history, sn_refinement *out) {
    sn_case *body[SN_REFINE_MAX] = {0};
    sn_record *course[SN_REFINE_MAX] = {history};
    sn_status status = SN_OK;
    *out = (sn_refinement){0};
    if (meshes < 2 || meshes > SN_REFINE_MAX)
        return sn_fail(SN_E_RANGE, "refine: found %d meshes, expected 2 or 3", meshes);
    for (int m = 0; m < meshes && out->meshes == m; m++) {
        share s = {output, m, meshes};
        const sn_case *last = m > 1 ? body[m - 1] : c;
        if (m > 0) SN_TRY_GOTO(status, sn_record_create(c->name, &course[m]));
        if (m > 0) status = order && m == 1 ? raised(last, &body[m]) : finer(last, &body[m]);
        if (status == SN_OK) status = run_mesh(m > 0 ? body[m] : c, &s, course[m], out);
        if (m == 0) *summary = out->run[0];
        if (status != SN_OK && m == 0) goto fail;
        if (status != SN_OK) // what the coarser meshes say is worth more than an error
            snprintf(out->reason, sizeof out->reason, "mesh %d: %.200s", m + 1, sn_error_text());
    }
    status = sum_up(c, order, (const sn_record *const *)course, out);
fail:
    for (int m = 1; m < meshes; m++) {
        sn_record_destroy(course[m]);
        sn_case_destroy(body[m]);
    }
    if (status != SN_OK) sn_refinement_release(out);
    return status;
}

sn_status sn_continuum_refine(const sn_case *c, int meshes, const sn_output *output,
                              sn_run_summary *summary, sn_record *history, sn_refinement *out) {
    return go(c, meshes, false, output, summary, history, out);
}

sn_status sn_continuum_raise(const sn_case *c, int runs, const sn_output *output,
                             sn_run_summary *summary, sn_record *history, sn_refinement *out) {
    if (c->continuum.element != SN_ELEMENT_P1) {
        *out = (sn_refinement){0};
        return sn_fail(SN_E_UNSUPPORTED,
                       "refine by order: no element stands above the quadratic ones; start from "
                       "element: P1, or refine by cells");
    }
    return go(c, runs, true, output, summary, history, out);
}
