// Runs a case to its end, by any integrator.
// SPDX-License-Identifier: Apache-2.0
//
// The ledger. elastic: of the equilibrium part of the law, g_inf (W + U). memory: stored in the
// branches (energy.c). external work: of gravity, loads, tools, supports and prescribed motion, by
// the trapezoidal rule over each step; what a tool's friction and penalty take stays on the tool's
// side. What a cut removes is dissipated too: the stored energy before it less that after it
// (released_J). dissipated: that, what damping by mass took, and with memory or damping by
// stiffness the work done on the tissue less what it stored, which is never below zero but for the
// trapezoidal rule and, in cells and smoothed edges, the approximation of energy.c. residual: what
// is left of
//     kinetic + elastic + memory + dissipated - external work;
// with memory it shows the integration of the motion (with the implicit integrator what that takes
// out of it), without memory that of the tissue too. energy_residual is over the largest of them.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "springs/run.h"

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

double sn_run_store(sn_run *run, const sn_moment *moment) {
    sn_fields_fill(run->net, run->fields, moment);
    const sn_stored stored = sn_fields_stored(run->net, run->fields, moment);
    run->summary->elastic_J = stored.elastic;
    run->summary->memory_J = stored.memory;
    run->summary->instant_J = stored.instant;
    return stored.elastic + stored.memory;
}

static bool remembers(const sn_net *net) {
    for (int r = 0; r < net->region_count; r++)
        for (int p = 0; p < SN_PARTS; p++)
            if (sn_region_branches(&net->region[r], (sn_part)p) > 0) return true;
    return false;
}

// what the tissue took of the work done on it, J; what cuts took is in the first already
static double lost_inside(const sn_run *run, double stored) {
    return remembers(run->net) ? run->internal_work - (stored - run->stored_start) : run->released;
}

static const char *const energy_columns[] = {
    "time",          "kinetic_energy", "elastic_energy", "memory_energy", "dissipated_energy",
    "external_work", "energy_residual"};
enum { ENERGY_COLUMNS = 7 };

static sn_status energy_row(sn_run *run, const sn_moment *moment) {
    sn_record *energy = run->output->energy;
    const double stored = sn_run_store(run, moment);
    const double lost = moment->damped + lost_inside(run, stored);
    const double row[ENERGY_COLUMNS] = {moment->time,
                                        moment->kinetic,
                                        run->summary->elastic_J,
                                        run->summary->memory_J,
                                        lost,
                                        run->external_work,
                                        moment->kinetic - run->kinetic_start + stored -
                                            run->stored_start + lost - run->external_work};
    return sn_record_append(energy, row);
}

static sn_status add_energy_columns(sn_record *energy) {
    for (int k = 0; energy->series_count < ENERGY_COLUMNS && k < ENERGY_COLUMNS; k++)
        SN_TRY(sn_record_add_series(energy, energy_columns[k], k == 0 ? "s" : "J"));
    return SN_OK;
}

sn_status sn_run_energy_rows(sn_record *energy, int rows) {
    const double none[ENERGY_COLUMNS] = {0};
    while (energy->rows < rows) SN_TRY(sn_record_append(energy, none));
    return SN_OK;
}

sn_status sn_run_record(sn_run *run, const sn_moment *moment) {
    SN_TRY(sn_net_history_row(run->net, moment, run->row, run->history));
    if (run->output && run->output->energy) SN_TRY(energy_row(run, moment));
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
    for (int n = 0; n < net->region_count * SN_PARTS; n++) {
        const sn_exponentials *e =
            sn_region_memory(&net->region[n / SN_PARTS], (sn_part)(n % SN_PARTS));
        if (e->terms > s->memory_terms) s->memory_terms = e->terms;
        s->memory_error = fmax(s->memory_error, e->max_error);
        s->memory_band_s[0] = e->t_min;
        s->memory_band_s[1] = e->t_max;
    }
}

static void finish(sn_run *run) {
    sn_run_summary *s = run->summary;
    s->wall_s = sn_clock() - run->started;
    s->real_time_factor = s->simulated_s / s->wall_s;
    s->external_work_J = run->external_work;
    const double stored = s->elastic_J + s->memory_J;
    s->dissipated_J += lost_inside(run, stored);
    s->released_J = run->released;
    double left = s->kinetic_J - run->kinetic_start + stored - run->stored_start + s->dissipated_J -
                  s->external_work_J;
    double largest = fmax(fmax(fabs(s->kinetic_J), stored),
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
    if (output && output->energy) SN_TRY_GOTO(status, add_energy_columns(output->energy));
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
    SN_TRY_GOTO(status, net->integrator == SN_INTEGRATOR_QUASI_STATIC ? sn_run_quasi_static(&run)
                                                                      : sn_run_motion(&run));
    finish(&run);
fail:
    sn_free(run.row);
    sn_free(run.wall);
    sn_fields_destroy(run.fields);
    sn_net_destroy(net);
    return status;
}
