// A run on its way: steps that are cut back where Newton fails and grow again where it does not.
// SPDX-License-Identifier: Apache-2.0
//
// What acts at time 0 already (gravity, constant loads, a history that starts with a jump) is
// brought on first, in as few instantaneous steps as it takes. Then come the steps in time. The
// guess for a step is extrapolated from the last two to four states, by the order that leaves the
// least residual (a smooth path wants the highest, contact and friction a low one); after a corner
// of a history, or where that fails, the tangent at the start of the step carries the prescribed
// increments into the body.
//
// In a dynamic run with a step_tolerance the estimated error of a step, of third order in its
// length, chooses the next: 0.9 of what would just do, at most twice the last. A step that errs by
// more is taken back. Lengths are left alone while they are within a fifth of that, because
// generalised-alpha is at its best with equal steps.
#include "continuum/state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CUTBACKS = 12 };     // halvings of the shortest planned step
#define REGROW 1.5          // of the step after a success
#define PROGRESS_EVERY 0.25 // seconds between two texts
#define AIM 0.9             // of the step that would err by just the tolerance
#define QUICKEST 2.0        // growth of the steps by accuracy
#define SLOWEST 0.1         // cut of a step by accuracy
#define IDLE 0.2            // change of the steps that is not worth it

//---- life ---------------------------------------------------------------------------------------

static bool remembers(const sn_case *c) {
    const sn_memory none = sn_memory_none();
    for (int r = 0; r < c->mesh->region_count; r++)
        for (int k = 0; k < SN_PARTS; k++)
            if (sn_tissue_memory(c->tissue + r, (sn_part)k)->law != none.law) return true;
    return false;
}

// A step below which accuracy cuts no further: one mode errs by (beta - 1/6)(omega h)^3 or so, and
// no mode of the mesh is faster than some 15 over the transit time (quadratic elements), so that
// this one keeps the tolerance in all of them.
static double shortest_useful(const sn_fe_march *m) {
    double part = cbrt(m->c->continuum.step_tolerance) / 8.0;
    return fmin(part * sn_fe_inertia_transit(m->c, m->problem->space), m->schedule.longest);
}

static sn_status alloc_states(sn_fe_march *m) {
    size_t dofs = (size_t)m->problem->space->dofs;
    m->x = sn_alloc(dofs, sizeof *m->x);
    bool room = true;
    for (int k = 0; k < SN_FE_PAST; k++) room &= !!(m->past[k] = sn_alloc(dofs, sizeof *m->x));
    m->guess = sn_alloc(dofs, sizeof *m->guess);
    m->force = sn_alloc(dofs, sizeof *m->force);
    return room && m->x && m->guess && m->force ? SN_OK : SN_E_MEMORY;
}

sn_status sn_fe_march_init(sn_fe_march *m, const sn_case *c, const sn_output *output,
                           sn_run_summary *summary, sn_record *history) {
    *m = (sn_fe_march){.c = c, .output = output, .summary = summary, .history = history};
    m->limit = m->pace = (double)INFINITY;
    m->told = m->started = sn_clock();
    SN_TRY(sn_fe_schedule_create(c, remembers(c), &m->schedule));
    SN_TRY(sn_fe_problem_create(c, m->schedule.shortest, &m->problem));
    SN_TRY(sn_fe_newton_init(&m->newton, m->problem, c->continuum.tolerance));
    SN_TRY(sn_case_history_columns(c, history));
    const sn_fe_ranks *ranks = m->problem->space->ranks;
    bool fields = sn_fe_from_first(ranks, output && output->frame);
    SN_TRY(sn_fe_measure_create(m->problem, history, fields, &m->measure));
    if (m->problem->inertia && c->continuum.step_tolerance > 0.0)
        m->pace = m->least_pace = shortest_useful(m);
    return sn_fe_agree(ranks, alloc_states(m));
}

void sn_fe_march_free(sn_fe_march *m) {
    sn_fe_measure_destroy(m->measure, m->c);
    sn_fe_newton_free(&m->newton);
    sn_fe_problem_destroy(m->problem);
    sn_fe_schedule_free(&m->schedule);
    sn_free(m->x);
    for (int k = 0; k < SN_FE_PAST; k++) sn_free(m->past[k]);
    sn_free(m->guess);
    sn_free(m->force);
    sn_free(m->wall);
}

//---- one step -----------------------------------------------------------------------------------

// The polynomial through x and the `order` states before it, a step later.
static void extrapolate(sn_fe_march *m, int order, double step) {
    const sn_fe_problem *p = m->problem;
    double weight[SN_FE_PAST + 1]; // Lagrange's, of x and of the past
    for (int k = 0; k <= order; k++) {
        double own = k ? m->past_at[k - 1] : 0.0;
        weight[k] = 1.0;
        for (int n = 0; n <= order; n++) {
            double other = n ? m->past_at[n - 1] : 0.0;
            if (n != k) weight[k] *= (step - other) / (own - other);
        }
    }
    for (int d = 0; d < p->space->dofs; d++) {
        double sum = 0.0; // of differences, which keeps rounding small
        for (int k = 1; k <= order; k++) sum += weight[k] * (m->past[k - 1][d] - m->x[d]);
        m->guess[d] = m->x[d] + sum;
    }
    for (int d = 0; d < 3 * p->space->nodes; d++)
        if (p->pattern->row[d] == SN_FE_PRESCRIBED) m->guess[d] = p->prescribed[d];
}

// Extrapolates by the best order.
static void guess_ahead(sn_fe_march *m, double step) {
    int best = 1;
    double least = (double)INFINITY;
    sn_fe_balance balance;
    for (int order = m->past_count; order >= 1 && m->past_count > 1; order--) {
        extrapolate(m, order, step);
        sn_fe_problem_balance(m->problem, m->guess, &balance);
        if (!balance.sound || balance.error >= least) continue;
        least = balance.error;
        best = order;
    }
    extrapolate(m, best, step);
}

static sn_status attempt(sn_fe_march *m, sn_fe_level level, sn_fe_outcome *out) {
    size_t bytes = (size_t)m->problem->space->dofs * sizeof *m->x;
    sn_fe_problem_begin(m->problem, level);
    if (m->past_count > 0 && level.step > 0.0) {
        guess_ahead(m, level.step);
        SN_TRY(sn_fe_newton_solve(&m->newton, false, m->guess, out));
        m->summary->newton_iterations += out->iterations;
        if (out->converged) return SN_OK;
    }
    memcpy(m->guess, m->x, bytes);
    SN_TRY(sn_fe_newton_solve(&m->newton, true, m->guess, out));
    m->summary->newton_iterations += out->iterations;
    return SN_OK;
}

// Whether the guess that converged is accurate enough, and how long the next step may be.
static bool accurate(sn_fe_march *m, double step) {
    const sn_fe_problem *p = m->problem;
    double error, way, tolerance = m->c->continuum.step_tolerance, last = m->pace;
    if (!isfinite(m->pace)) return true;
    sn_fe_inertia_judge(p->inertia, p->space, p->pattern, m->guess, &error, &way);
    bool good = error <= tolerance * way, blind = !good && step <= m->least_pace * (1.0 + 1e-9);
    double want = error > 0.0 ? AIM * step * cbrt(tolerance * way / error) : (double)INFINITY;
    if (good && fabs(want / last - 1.0) > IDLE)
        m->pace = fmin(want, QUICKEST * last);
    else if (!good)
        m->pace = fmin(fmax(want, SLOWEST * step), (1.0 - IDLE) * step);
    m->pace = fmin(fmax(m->pace, m->least_pace), m->schedule.longest);
    m->blind += blind;
    m->inaccurate += !good && !blind;
    return good || blind;
}

// Takes the guess as the new state.
static void accept(sn_fe_march *m, sn_fe_level level, const sn_fe_outcome *out) {
    sn_fe_problem *p = m->problem;
    double work = 0.0;
    sn_fe_problem_commit(p, m->guess, &out->balance);
    for (int d = 0; d < 3 * p->space->nodes; d++) {
        double force = p->residual[d] + p->external[d];
        work += 0.5 * (force + m->force[d]) * (m->guess[d] - m->x[d]);
        m->force[d] = force;
    }
    m->summary->external_work_J += work;
    double *free = m->past[SN_FE_PAST - 1];
    for (int k = SN_FE_PAST - 1; k > 0; k--) {
        m->past[k] = m->past[k - 1];
        m->past_at[k] = m->past_at[k - 1] - level.step;
    }
    m->past[0] = m->x;
    m->past_at[0] = -level.step;
    m->past_count = level.step > 0.0 ? m->past_count + (m->past_count < SN_FE_PAST) : 0;
    m->x = m->guess;
    m->guess = free;
    m->reached = level;
    m->rounded += out->rounded;
}

sn_status sn_fe_march_note(sn_fe_march *m, double wall, double length) {
    sn_run_summary *s = m->summary;
    if (m->walls == m->wall_room) {
        m->wall_room = 2 * m->wall_room + 64;
        double *more = sn_resize(m->wall, m->wall_room, sizeof *more);
        if (!more) return SN_E_MEMORY;
        m->wall = more;
    }
    m->wall[m->walls++] = wall;
    s->steps++;
    s->step_s = s->step_s > 0.0 ? fmin(s->step_s, length) : length;
    m->longest_used = fmax(m->longest_used, length);
    return SN_OK;
}

static void tell(sn_fe_march *m, double time) {
    char text[SN_TEXT_MAX];
    if (!m->output || !m->output->progress || sn_clock() - m->told < PROGRESS_EVERY) return;
    m->told = sn_clock();
    snprintf(text, sizeof text, "%.4g s of %.4g s, step %ld, %d Newton iterations", time,
             m->c->until, m->summary->steps, m->summary->newton_iterations);
    m->output->progress(m->output->context, time / m->c->until, text);
}

// Whether forces act that a body may be unable to carry, however far it gives way.
static bool pushed(const sn_case *c) {
    bool any = c->gravity[0] != 0.0 || c->gravity[1] != 0.0 || c->gravity[2] != 0.0;
    for (int k = 0; k < c->load_count; k++) any |= c->load[k].kind != SN_LOAD_DISPLACEMENT;
    return any && c->continuum.analysis == SN_ANALYSIS_QUASI_STATIC;
}

static void give_up(sn_fe_march *m, bool start, double at, double step, const char *why) {
    char *to = m->summary->reason;
    m->stopped = true;
    if (start)
        snprintf(to, SN_TEXT_MAX,
                 "only %.3g of the loads that act at time 0 could be applied, further %.3g failed: "
                 "%.80s",
                 at, step, why);
    else
        snprintf(to, SN_TEXT_MAX,
                 "stopped at %.6g s of %.6g s, where a step of %.3g s still failed: %.80s", at,
                 m->c->until, step, why);
    size_t used = strlen(to);
    if (pushed(m->c))
        snprintf(
            to + used, SN_TEXT_MAX - used,
            "; the load may be more than the body can carry: prescribe a displacement instead");
}

//---- many steps ---------------------------------------------------------------------------------

// From `at` to `end`: in time towards a stop of the schedule, or, at the start, in the scale of the
// loads from 0 to 1.
static sn_status walk(sn_fe_march *m, bool start, double at, double end, int stop) {
    while (at < end && !m->stopped) {
        sn_fe_outcome out;
        double clock = sn_clock(), room = fmin(fmin(m->wish, m->limit), m->pace);
        double least = (start ? 1.0 : fmin(m->schedule.shortest, m->pace)) / (1 << CUTBACKS);
        double step =
            start ? fmin(room, end - at) : sn_fe_schedule_step(&m->schedule, stop, at, room);
        double to = at + step > end - 1e-9 * step ? end : at + step;
        sn_fe_level level = start ? (sn_fe_level){0.0, to, 0.0} : (sn_fe_level){to, 1.0, to - at};
        SN_TRY(attempt(m, level, &out));
        if (!out.converged) {
            m->summary->cutbacks++;
            if (0.5 * step < least) give_up(m, start, at, step, out.reason);
            m->limit = 0.5 * step;
            m->past_count = 0;
            continue;
        }
        if (!accurate(m, level.step)) {
            m->summary->cutbacks++;
            continue;
        }
        accept(m, level, &out);
        at = to;
        m->wish *= SN_FE_GROWTH;
        m->limit *= REGROW;
        if (start) continue;
        SN_TRY(sn_fe_march_note(m, sn_clock() - clock, level.step));
        tell(m, at);
    }
    m->summary->simulated_s = start ? 0.0 : at;
    return SN_OK;
}

// A body with inertia is at rest and undeformed at time 0: what acts then acts suddenly, and moves
// nothing yet.
static sn_status start_at_rest(sn_fe_march *m) {
    sn_fe_problem *p = m->problem;
    size_t bytes = (size_t)p->space->dofs * sizeof *m->force;
    memcpy(m->force, p->external, bytes);
    memset(p->residual, 0, bytes);
    return SN_OK;
}

// Brings on what acts at time 0.
static sn_status into_start(sn_fe_march *m) {
    sn_fe_problem *p = m->problem;
    sn_fe_balance balance;
    double moved = 0.0;
    sn_fe_problem_begin(p, (sn_fe_level){0.0, 1.0, 0.0});
    sn_fe_problem_balance(p, m->x, &balance);
    if (p->inertia) return start_at_rest(m);
    for (int d = 0; d < 3 * p->space->nodes; d++)
        if (p->pattern->row[d] == SN_FE_PRESCRIBED) moved = fmax(moved, fabs(p->prescribed[d]));
    if (balance.reference == 0.0 && moved == 0.0) return SN_OK;
    if (p->materials->viscous) {
        snprintf(
            m->summary->note, SN_TEXT_MAX,
            "a tissue has a Voigt viscosity, so what jumps at time 0 acts over the first step");
        sn_fe_problem_begin(p, (sn_fe_level){0.0, 0.0, 0.0});
        sn_fe_problem_balance(p, m->x, &balance);
        return SN_OK;
    }
    m->wish = 1.0;
    SN_TRY(walk(m, true, 0.0, 1.0, 0));
    m->limit = (double)INFINITY;
    return SN_OK;
}

static sn_status record(sn_fe_march *m) {
    SN_TRY(sn_fe_measure_row(m->measure, m->problem, m->x, m->history));
    return sn_fe_measure_frame(m->measure, m->problem, m->x, m->output);
}

// The last state that converged, where it is not recorded already. Newton's last attempts have
// changed the level and the factors of the memory: an instantaneous step of no change undoes that.
static sn_status record_last(sn_fe_march *m) {
    sn_fe_balance balance;
    const sn_record *h = m->history;
    double at = m->reached.time;
    if (h->rows > 0 && h->series[0].value[h->rows - 1] >= at) return SN_OK;
    sn_fe_problem_begin(m->problem, (sn_fe_level){at, m->reached.scale, 0.0});
    sn_fe_problem_balance(m->problem, m->x, &balance);
    if (m->problem->inertia)
        sn_fe_inertia_reactions(m->problem->inertia, m->problem->space, m->problem->residual);
    return record(m);
}

sn_status sn_fe_march_go(sn_fe_march *m) {
    const sn_fe_schedule *s = &m->schedule;
    int done;
    SN_TRY(sn_fe_state_restore(m, &done));
    if (done < 0) SN_TRY(into_start(m));
    for (int k = done + 1; k < s->count && !m->stopped; k++) {
        if (k > 0) SN_TRY(walk(m, false, s->stop[k - 1].time, s->stop[k].time, k));
        if (m->stopped) break;
        if (s->stop[k].output) SN_TRY(record(m));
        if (s->stop[k].corner) {
            m->wish = fmin(s->stop[k].first, s->longest);
            m->past_count = 0;
        }
        m->wish = fmin(m->wish, s->longest);
        if (s->stop[k].output && k + 1 < s->count) SN_TRY(sn_fe_state_save(m, s->stop[k].time));
    }
    return m->stopped ? record_last(m) : SN_OK;
}
