// The run with inertia, explicit or implicit: steps, records, counts energy.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/run.h"
#include "springs/steps.h"

/// What the ledger keeps from one step to the next.
typedef struct ledger {
    double *ext;  ///< of loads and tools at the start of the step (nodes x 3)
    double fixed; ///< kinetic energy of prescribed directions then
} ledger;

static double fixed_kinetic(const sn_net *net, const sn_state *s) {
    double sum = 0;
    for (int k = 0; k < net->fixed_count; k++) {
        const sn_net_fixed *fixed = &net->fixed[k];
        double v =
            sn_real_at(s->precision, s->v, 4 * (size_t)fixed->node + (size_t)fixed->direction);
        sum += 0.5 * net->mass[fixed->node] * v * v;
    }
    for (int k = 0; k < s->gripped_count; k++) // in directions that were not counted yet
        for (int d = 0; d < 3; d++) {
            const int node = s->gripped[k];
            double v = sn_real_at(s->precision, s->v, 4 * (size_t)node + (size_t)d);
            if (!(net->fixed_bits[node] >> d & 1)) sum += 0.5 * net->mass[node] * v * v;
        }
    return sum;
}

// kinetic energy at the time of u: free velocities of the explicit step are half of it behind
static double kinetic(const sn_net *net, const sn_state *s) {
    const double behind = s->implicit ? 0.0 : 0.5 * s->last_step;
    double sum = 0;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            size_t at = 4 * (size_t)i + (size_t)d;
            double v = sn_real_at(s->precision, s->v, at);
            if (!(net->fixed_bits[i] >> d & 1) && s->grip[i].tool < 0)
                v += behind * sn_real_at(s->precision, s->now.f, at) / net->mass[i];
            sum += 0.5 * net->mass[i] * v * v;
        }
    return sum;
}

static sn_moment moment_of(const sn_net *net, const sn_state *s) {
    return (sn_moment){.time = s->time,
                       .precision = s->precision,
                       .u = s->u,
                       .v = s->v,
                       .f = s->now.f,
                       .store = s->store,
                       .pressure = s->now.pressure,
                       .a_fixed = s->a_fixed,
                       .tool_force = s->tool_force,
                       .kinetic = s->broken ? 0.0 : kinetic(net, s),
                       .damped = s->damped_energy,
                       .parts = sn_state_parts(s),
                       .upright = sn_state_is_upright(s)};
}

// way of number `at` in the last step
static double way_of(const sn_state *s, size_t at) {
    if (s->implicit) return ((const double *)s->u)[at] - sn_implicit_before(s->implicit)[at];
    return s->last_step * sn_real_at(s->precision, s->v, at);
}

// work of one step: all forces over the way of all nodes, by the trapezoidal rule
static void count_work(sn_run *run, const sn_state *s, ledger *l) {
    const sn_net *net = run->net;
    double all = 0, ext = 0, on_fixed = 0;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            size_t at = 4 * (size_t)i + (size_t)d;
            double way = way_of(s, at);
            double work = 0.5 * way *
                          (sn_real_at(s->precision, s->f_before, at) +
                           sn_real_at(s->precision, s->now.f, at));
            all += work;
            ext += way * net->mass[i] * net->gravity[d];
            if (net->fixed_bits[i] >> d & 1 || s->grip[i].tool >= 0) on_fixed += work;
        }
    for (int k = 0; k < sn_net_loaded(net, sn_state_parts(s)); k++)
        for (int d = 0; d < 3; d++) {
            int at = 3 * net->loaded[k] + d;
            double way = way_of(s, 4 * (size_t)net->loaded[k] + (size_t)d);
            ext += 0.5 * way * (l->ext[at] + s->ext[at]);
            l->ext[at] = s->ext[at];
        }
    double fixed = fixed_kinetic(net, s);
    run->internal_work += ext - all;
    // supports give what prescribed nodes gain and pass on
    run->external_work += ext + fixed - l->fixed - on_fixed;
    l->fixed = fixed;
}

static sn_status record(sn_run *run, const sn_state *s) {
    const sn_moment moment = moment_of(run->net, s);
    return sn_run_record(run, &moment);
}

static void stop(sn_run *run, const sn_state *s) {
    const double time = s->time;
    run->summary->converged = false;
    if (s->implicit) {
        snprintf(run->summary->reason, sizeof run->summary->reason, "%s",
                 sn_implicit_reason(s->implicit));
        return;
    }
    snprintf(run->summary->reason, sizeof run->summary->reason,
             "the motion became infinite at %.6g s of %.6g s, after %ld steps of about %.3g s: the "
             "loads may be too sudden, or the tissue too soft for them",
             time, run->net->until, run->summary->steps, time / (double)run->summary->steps);
}

// of the next step
static double pace(const sn_net *net, const sn_state *s, double left) {
    return s->implicit ? left / fmax(1.0, ceil(left / net->step - 1e-6)) : left;
}

// steps from now to `next`
static void go_on(sn_run *run, sn_state *s, ledger *l, double next) {
    const double tiny = 1e-9 * run->net->until;
    sn_run_summary *summary = run->summary;
    while (s->time < next - tiny && !s->broken) {
        double left = next - s->time, start = sn_clock();
        sn_step_info info = sn_state_step(run->net, s, pace(run->net, s, left));
        sn_run_wall(run, sn_clock() - start);
        summary->steps++;
        if (s->broken) return;
        summary->step_s = summary->steps == 1 ? info.step : fmin(summary->step_s, info.step);
        count_work(run, s, l);
        sn_run_progress(run, s->time);
    }
    s->time = next; // rounding of sums
}

// cuts of the case that are due
static sn_status cut(sn_run *run, sn_state *s, ledger *l) {
    const int *cells;
    int count;
    while (sn_state_due_cut(run->net, s, &count, &cells)) {
        const sn_moment before = moment_of(run->net, s);
        SN_TRY(sn_run_cut(run, s, &before, count, cells));
        const sn_moment after = moment_of(run->net, s);
        run->released -= sn_run_store(run, &after);
        memcpy(l->ext, s->ext, (size_t)run->net->nodes * 3 * sizeof *l->ext);
    }
    return SN_OK;
}

static sn_status start(sn_run *run, sn_state *s, ledger *l) {
    memcpy(l->ext, s->ext, (size_t)run->net->nodes * 3 * sizeof *l->ext);
    const sn_moment moment = moment_of(run->net, s);
    run->stored_start = sn_run_store(run, &moment);
    return record(run, s);
}

static sn_status resume(sn_run *run, sn_state *s, const sn_piece *own, int count) {
    SN_TRY(sn_run_load(run, s, own, count));
    const sn_moment moment = moment_of(run->net, s);
    return sn_run_frame(run, &moment);
}

static void finish(sn_run *run, const sn_state *s) {
    const sn_moment moment = moment_of(run->net, s);
    sn_run_summary *summary = run->summary;
    if (s->broken) stop(run, s);
    summary->simulated_s = s->time;
    summary->kinetic_J = moment.kinetic;
    summary->dissipated_J = moment.damped;
    sn_run_store(run, &moment);
    if (s->implicit)
        sn_implicit_counts(s->implicit, &summary->newton_iterations, &summary->cutbacks);
}

sn_status sn_run_motion(sn_run *run) {
    const sn_net *net = run->net;
    sn_state *s = NULL;
    ledger l = {.ext = sn_alloc((size_t)net->nodes * 3, sizeof(double))};
    sn_status status = l.ext ? sn_state_create(net, &s) : SN_E_MEMORY;
    long output = 1;
    const sn_piece own[] = {{&output, sizeof output},
                            {l.ext, (size_t)net->nodes * 3 * sizeof *l.ext}};
    if (status == SN_OK) status = sn_run_goes_on(run) ? resume(run, s, own, 2) : start(run, s, &l);
    while (status == SN_OK && !s->broken && s->time < net->until) {
        double due = sn_run_output_time(net, output);
        double next = fmin(fmin(due, sn_net_next_corner(net, s->time)), net->until);
        sn_state_follow_grasps(net, s);
        status = cut(run, s, &l);
        if (status != SN_OK) break;
        l.fixed = fixed_kinetic(net, s);
        go_on(run, s, &l, next);
        if (s->broken || next < due) continue;
        status = record(run, s);
        output++;
        if (s->implicit) sn_implicit_forget(s->implicit);
        if (status == SN_OK) status = sn_run_save(run, s, own, 2);
    }
    if (status == SN_OK) finish(run, s);
    sn_state_destroy(s);
    sn_free(l.ext);
    return status;
}
