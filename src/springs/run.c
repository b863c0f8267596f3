// Runs a case to its end, by either integrator.
// SPDX-License-Identifier: Apache-2.0
//
// Energies of the summary. elastic: W + U of the instantaneous law at the end. external work: of
// gravity, loads, tools, supports and prescribed motion, by the trapezoidal rule over each step.
// dissipated: what damping took, and with memory the work done on the tissue less `elastic`, of
// which branches that have not relaxed yet could still give some back. energy_residual: what is
// left of
//     kinetic + elastic + dissipated - external work,
// over the largest of them; with memory it shows the integration of the motion, without memory that
// of the tissue too.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "springs/net.h"

static const double progress_every = 0.25; // seconds of wall time

void sn_run_wall(sn_run *run, double seconds) {
    // after SN_WALLS steps each further one replaces one that a multiplicative hash picks
    long at = run->wall_seen++;
    if (at >= SN_WALLS) at = (long)(((uint64_t)at * 2654435761u) % SN_WALLS);
    run->wall[at] = seconds;
    run->summary->step_wall_max_s = fmax(run->summary->step_wall_max_s, seconds);
}

void sn_run_progress(sn_run *run, double time) {
    double now = sn_clock();
    if (!run->output || !run->output->progress || now - run->told < progress_every) return;
    run->told = now;
    char text[SN_TEXT_MAX];
    snprintf(text, sizeof text, "%.4g s of %.4g s", time, run->net->until);
    run->output->progress(run->output->context, time / run->net->until, text);
}

sn_status sn_run_record(sn_run *run, const sn_moment *moment) {
    SN_TRY(sn_net_history_row(run->net, moment, run->row, run->history));
    return sn_run_frame(run, moment);
}

sn_status sn_run_frame(sn_run *run, const sn_moment *moment) {
    if (!run->output || !run->output->frame) return SN_OK;
    sn_fields_fill(run->net, run->fields, moment);
    return sn_fields_emit(run->fields, moment->time, run->output);
}

double sn_run_output_time(const sn_net *net, long k) {
    const double same = 1e-9; // of until: two times that are one
    double time = (double)k * net->output_every, before = time - net->output_every;
    if (time <= net->until * (1.0 + same)) return fmin(time, net->until);
    return before < net->until * (1.0 - same) ? net->until : (double)INFINITY;
}

static int compare_double(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void describe(const sn_net *net, sn_run_summary *s) {
    snprintf(s->engine, sizeof s->engine, "springs");
    static const char *const rungs[] = {"central", "coupled", "smoothed"};
    snprintf(s->model, sizeof s->model, "%s%s", rungs[net->rung], net->volume ? "+volume" : "");
    s->nodes = net->nodes;
    s->cells = net->cells;
    s->springs = net->springs;
    s->unknowns = 3 * net->nodes - net->fixed_count;
    s->threads = net->threads;
    snprintf(s->note, sizeof s->note, "%s", net->note);
    for (int r = 0; r < net->region_count; r++) {
        const sn_exponentials *e = &net->region[r].memory;
        if (e->terms > s->memory_terms) s->memory_terms = e->terms;
        s->memory_error = fmax(s->memory_error, e->max_error);
        s->memory_band_s[0] = e->t_min;
        s->memory_band_s[1] = e->t_max;
    }
}

static bool remembers(const sn_net *net) {
    for (int r = 0; r < net->region_count; r++)
        if (net->region[r].branches > 0) return true;
    return false;
}

static void finish(sn_run *run) {
    sn_run_summary *s = run->summary;
    s->wall_s = sn_clock() - run->started;
    s->real_time_factor = s->simulated_s / s->wall_s;
    s->external_work_J = run->external_work;
    double stored = s->elastic_J - run->elastic_start;
    if (remembers(run->net)) s->dissipated_J += run->internal_work - stored;
    double left = s->kinetic_J - run->kinetic_start + stored + s->dissipated_J - s->external_work_J;
    double largest = fmax(fmax(fabs(s->kinetic_J), fabs(s->elastic_J)),
                          fmax(fabs(s->dissipated_J), fabs(s->external_work_J)));
    s->energy_residual = largest > 0 ? fabs(left) / largest : 0.0;
    size_t kept = (size_t)(run->wall_seen < SN_WALLS ? run->wall_seen : SN_WALLS);
    if (kept > 0) {
        qsort(run->wall, kept, sizeof *run->wall, compare_double);
        s->step_wall_p50_s = run->wall[(kept - 1) / 2];
        s->step_wall_p99_s = run->wall[(size_t)ceil(0.99 * (double)kept) - 1];
    }
}

sn_status sn_springs_run(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                         sn_record *history) {
    return sn_springs_resume(c, output, NULL, summary, history);
}

sn_status sn_springs_resume(const sn_case *c, const sn_output *output, const sn_restart *restart,
                            sn_run_summary *summary, sn_record *history) {
    sn_net *net = NULL;
    sn_run run = {.output = output,
                  .restart = restart,
                  .summary = summary,
                  .history = history,
                  .started = sn_clock()};
    *summary = (sn_run_summary){.converged = true};
    sn_status status;
    if (sn_run_goes_on(&run) && c->springs.integrator == SN_INTEGRATOR_IMPLICIT)
        return sn_fail(SN_E_UNSUPPORTED, "springs: a run of integrator implicit cannot be "
                                         "continued; explicit and quasi-static can");
    SN_TRY_GOTO(status, sn_net_create(c, &net));
    run.net = net;
    describe(net, summary);
    SN_TRY_GOTO(status, sn_case_history_columns(c, history));
    SN_TRY_GOTO(status, sn_fields_create(net, &run.fields));
    run.row = sn_alloc((size_t)history->series_count, sizeof *run.row);
    run.wall = sn_alloc(SN_WALLS, sizeof *run.wall);
    if (!run.row || !run.wall) {
        status = SN_E_MEMORY;
        goto fail;
    }
    SN_TRY_GOTO(status, net->integrator == SN_INTEGRATOR_EXPLICIT ? sn_run_explicit(&run)
                                                                  : sn_run_quasi_static(&run));
    finish(&run);
fail:
    sn_free(run.row);
    sn_free(run.wall);
    sn_fields_destroy(run.fields);
    sn_net_destroy(net);
    return status;
}
