// The quasi-static run: equilibrium at every step, with memory.
// SPDX-License-Identifier: Apache-2.0
//
// A step without equilibrium is halved, and grows again afterwards. Where halving has not helped
// the body is let go and snaps to another equilibrium (springs/equilibrium.c): what that gives off
// is lost, and the note of the run says when it happened.
//
// Steps land on outputs and on corners of whatever is imposed. While something changes there are at
// least 20 steps to a ramp. After each corner memory starts with short steps that grow by half each
// time: then the free part of the strain, which creeps while a boundary is held, is followed too.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "springs/equilibrium.h"
#include "springs/parts.h"
#include "springs/run.h"
#include "springs/steps.h"

enum { RAMP_STEPS = 20, FEW_CORNERS = 8, CUTS_MOST = 24 };
enum { SNAPS_MOST = 2, CRAWL_MOST = 30 };   // times that a body is let go; tiny steps in a row
static const double least_step = 1e-8;      // of the whole time
static const double crawl = 1e-2;           // of the step that the run would take
static const double stuck_below = 1.0 / 32; // of that step: the body is let go
static const double grow = 1.5;

//---- steps ---------------------------------------------------------------------------------------

static void use_factors(sn_balance *v, double h) {
    sn_net_factors(v->net, h, v->s->factors);
    sn_net_history(v->net, v->s->factors, v->s->store, v->history);
}

static sn_moment moment_of(const sn_balance *v) {
    return (sn_moment){.time = v->s->time,
                       .precision = SN_DOUBLE,
                       .u = v->s->u,
                       .f = v->s->now.f,
                       .store = v->s->store,
                       .pressure = v->s->now.pressure,
                       .tool_force = v->s->tool_force,
                       .damped = v->given_off,
                       .parts = sn_state_parts(v->s)};
}

// takes what was found for the state: memory and contact
static void keep(sn_balance *v) {
    const sn_net *net = v->net;
    sn_state *s = v->s;
    sn_balance_residual(v, SN_MEMORY_ADVANCE);
    memcpy(s->contact, v->touch,
           (size_t)net->tool_count * (size_t)net->contact_count * sizeof *s->contact);
}

// accepts a step: memory, contact, work
static void accept(sn_balance *v, double h) {
    const sn_net *net = v->net;
    const double *u = v->s->u;
    keep(v);
    double work = 0;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const int k = 3 * i + d;
            const bool fixed = net->fixed_bits[i] >> d & 1;
            const double way = u[4 * i + d] - v->start[4 * i + d];
            if (v->snapped && !fixed) // not in equilibrium on its way: what it gives off is lost
                work += way * v->ext[k];
            else
                work -= 0.5 * way * (v->inner[k] + v->inner_now[k]);
            v->last[k] = fixed || v->snapped ? 0.0 : way;
        }
    memcpy(v->inner, v->inner_now, (size_t)net->nodes * 3 * sizeof *v->inner);
    // in equilibrium all that is done from outside is done on the tissue
    v->run->internal_work += work;
    v->run->external_work += work;
    v->last_step = h;
}

// accepts a snap, the tissue having stored so much before: what it does not keep is given off
static void accept_snap(sn_balance *v, double h, double stored) {
    sn_run *run = v->run;
    const double before = run->external_work;
    if (v->snaps++ == 0) v->first_snap = v->time;
    accept(v, h);
    const sn_moment moment = moment_of(v);
    const double lost = run->external_work - before - (sn_run_store(run, &moment) - stored);
    run->internal_work -= lost;
    v->given_off += lost;
}

static void give_up(sn_balance *v, double h) {
    sn_run_summary *s = v->run->summary;
    s->converged = false;
    snprintf(
        s->reason, sizeof s->reason,
        "no equilibrium after %.6g s of %.6g s: residual %.2g of the forces, smallest volume ratio "
        "of a cell %.3g, after %d cuts of the step down to %.2g s",
        v->s->time, v->net->until, v->residual / v->scale, v->smallest, s->cutbacks, h);
}

// factors of a change that takes no time
static void use_sudden_factors(sn_balance *v) {
    use_factors(v, 1e-12 * v->net->until);
    sn_net_no_impulse(v->net, v->s->factors);
    sn_net_history(v->net, v->s->factors, v->s->store, v->history);
}

// all that acts at time 0 acts at once: instantaneous stiffness, the loads in parts where needed
static bool start_up(sn_balance *v) {
    double part = 1.0;
    v->time = 0;
    v->level = 0;
    for (int cuts = 0; v->level < 1.0;) {
        double from = v->level;
        v->level = fmin(1.0, from + part);
        use_sudden_factors(v);
        if (sn_balance_equilibrium(v, part)) {
            accept(v, part);
            continue;
        }
        v->level = from;
        part *= 0.5;
        v->run->summary->cutbacks++;
        if (++cuts > CUTS_MOST) {
            give_up(v, 0.0);
            return false;
        }
    }
    v->last_step = 0; // what happened at once goes on no further
    return true;
}

//---- cuts ----------------------------------------------------------------------------------------

static double work_of_loads(const sn_balance *v, const double *from) {
    const double *u = v->s->u;
    double work = 0;
    for (int i = 0; i < v->net->nodes; i++)
        for (int d = 0; d < 3; d++) work += v->ext[3 * i + d] * (u[4 * i + d] - from[4 * i + d]);
    return work;
}

// from the place before the cut to equilibrium of what is left: forces that balance the cut fade
// away, at once or in parts where needed. work: of loads. False where there is none to be found
static bool spring_back(sn_balance *v, double *work) {
    const size_t n = (size_t)v->net->nodes * 3;
    double part = 1.0;
    use_sudden_factors(v);
    v->holding = 0;
    sn_balance_residual(v, SN_MEMORY_TRIAL);
    for (size_t k = 0; k < n; k++) v->held[k] = -v->b[k];
    for (v->holding = 1.0; v->holding > 0;) {
        const double from = v->holding;
        v->holding = fmax(0.0, from - part);
        use_sudden_factors(v);
        if (sn_balance_equilibrium(v, part)) {
            *work += work_of_loads(v, v->start);
            keep(v);
            part *= grow;
            continue;
        }
        v->holding = from;
        part *= 0.5;
        v->run->summary->cutbacks++;
        if (part < least_step) {
            v->holding = 0;
            give_up(v, 0.0);
            return false;
        }
    }
    memcpy(v->inner, v->inner_now, n * sizeof *v->inner);
    memset(v->last, 0, n * sizeof *v->last); // what happened at once goes on no further
    v->last_step = 0;
    return true;
}

// cuts of the case that are due. What the body gives off as it springs back is lost as well: here
// nothing moves
static sn_status cut(sn_balance *v, bool *good) {
    const int *cells;
    int count;
    *good = true;
    while (*good && sn_state_due_cut(v->net, v->s, &count, &cells)) {
        const sn_moment before = moment_of(v);
        SN_TRY(sn_run_cut(v->run, v->s, &before, count, cells));
        v->time = v->s->time;
        *good = !sn_state_has_free_piece(v->s);
        if (!*good) {
            v->run->summary->converged = false;
            snprintf(v->run->summary->reason, sizeof v->run->summary->reason,
                     "the cut at %.6g s leaves a piece that no support or prescribed motion holds: "
                     "it has no equilibrium; use integrator explicit or implicit",
                     v->time);
        }
        double work = 0;
        if (*good) *good = spring_back(v, &work);
        v->run->internal_work += work;
        v->run->external_work += work;
        const sn_moment after = moment_of(v);
        v->run->released += work - sn_run_store(v->run, &after);
    }
    return SN_OK;
}

/// How long steps are to be after the corner at s->time.
typedef struct pace {
    double longest; ///< until the next corner
    double wish;    ///< of the next step
} pace;

static int count_corners(const sn_net *net) {
    int count = 0;
    for (double t = sn_net_next_corner(net, 0.0); t < net->until && count <= 1000; count++)
        t = sn_net_next_corner(net, t);
    return count;
}

static double shortest_time(const sn_net *net) {
    double least = INFINITY;
    for (int r = 0; r < net->region_count; r++)
        for (int p = 0; p < SN_PARTS; p++) {
            const sn_exponentials *memory = sn_region_memory(&net->region[r], (sn_part)p);
            for (int k = 0; k < memory->terms; k++) least = fmin(least, memory->tau[k]);
        }
    return least;
}

static pace set_pace(const sn_balance *v, int corners) {
    const sn_net *net = v->net;
    const double now = v->s->time;
    double segment = fmin(sn_net_next_corner(net, now), net->until) - now;
    double every = fmin(net->output_every, net->until);
    pace p = {.longest = every};
    if (net->asked_step > 0) {
        p.longest = p.wish = net->asked_step;
        return p;
    }
    // a table of many points gives its own steps
    int parts = corners <= FEW_CORNERS ? RAMP_STEPS : 1 + RAMP_STEPS * FEW_CORNERS / corners;
    if (sn_net_changes(net, now, now + segment)) p.longest = fmin(every, segment / parts);
    double tau = shortest_time(net);
    p.wish = p.longest;
    if (isfinite(tau) && corners <= FEW_CORNERS)
        p.wish = fmin(p.longest, fmax(0.5 * tau, 1e-3 * segment));
    return p;
}

// one step of at most h to v->s->time + h, or of `far` where the body is let go: that drives it on;
// false where none, however short, succeeds
static bool step(sn_balance *v, double far, double *h) {
    double wall = sn_clock(), stored = 0;
    bool tried = false;
    v->snapped = false;
    for (;;) {
        v->time = v->s->time + *h;
        use_factors(v, *h);
        if (sn_balance_equilibrium(v, *h)) break;
        // also where the cuts of several steps have brought h there: near a limit point
        const bool stuck = !tried && *h <= stuck_below * far;
        // a body that has snapped as often as it may loses its hold again and again
        const bool lost = stuck && v->snaps > 0 && v->let_go == SNAPS_MOST;
        if (stuck && v->let_go < SNAPS_MOST) {
            tried = true;
            v->let_go++;
            const sn_moment before = moment_of(v); // the body is back where the step began
            stored = sn_run_store(v->run, &before);
            v->time = v->s->time + far;
            use_factors(v, far);
            v->snapped = sn_balance_snap(v, far);
            if (v->snapped) {
                *h = far;
                break;
            }
        }
        v->run->summary->cutbacks++;
        if (*h < least_step * v->net->until || lost) {
            give_up(v, *h);
            return false;
        }
        *h *= 0.5;
    }
    if (v->snapped)
        accept_snap(v, *h, stored);
    else
        accept(v, *h);
    v->s->time = v->time;
    sn_run_summary *s = v->run->summary;
    s->step_s = s->steps++ == 0 ? *h : fmin(s->step_s, *h);
    sn_run_wall(v->run, sn_clock() - wall);
    sn_run_progress(v->run, v->time);
    return true;
}

static sn_status march(sn_balance *v) {
    const sn_net *net = v->net;
    const double tiny = 1e-9 * net->until;
    const int corners = count_corners(net);
    const size_t n = (size_t)net->nodes * 3;
    sn_moment moment;
    pace p = {0};
    double corner = sn_net_next_corner(net, 0.0);
    long output = 1;
    int crawled = 0; // not saved: a step that lands goes all that was left, which is no crawl
    const sn_piece own[] = {{&output, sizeof output},
                            {&corner, sizeof corner},
                            {&p, sizeof p},
                            {&v->last_step, sizeof v->last_step},
                            {v->last, n * sizeof *v->last},
                            {v->inner, n * sizeof *v->inner},
                            {&v->let_go, sizeof v->let_go},
                            {&v->snaps, sizeof v->snaps},
                            {&v->first_snap, sizeof v->first_snap},
                            {&v->given_off, sizeof v->given_off}};
    const int owned = (int)(sizeof own / sizeof *own);
    if (sn_run_goes_on(v->run)) {
        SN_TRY(sn_run_load(v->run, v->s, own, owned));
        v->level = 1.0;
        moment = moment_of(v);
        SN_TRY(sn_run_frame(v->run, &moment));
    } else {
        if (!start_up(v)) return SN_OK;
        moment = moment_of(v);
        SN_TRY(sn_run_record(v->run, &moment));
        p = set_pace(v, corners);
    }
    while (v->s->time < net->until) {
        bool good;
        SN_TRY(cut(v, &good));
        if (!good) return SN_OK;
        double due = sn_run_output_time(net, output);
        double next = fmin(fmin(due, corner), net->until), left = next - v->s->time;
        double wish = fmin(p.wish, p.longest), h = left / fmax(1.0, ceil(left / wish - 1e-6));
        double asked = h;
        if (h < left && left - h < tiny) h = left;
        if (left > tiny) { // else an output and a corner at one time
            if (!step(v, fmin(p.longest, left), &h)) return SN_OK;
            crawled = h < crawl * fmin(p.longest, left) ? crawled + 1 : 0;
            if (crawled == CRAWL_MOST) {
                give_up(v, h);
                return SN_OK;
            }
            p.wish = h < asked ? h : fmax(p.wish, h) * grow;
        }
        if (v->s->time < next - tiny) continue;
        SN_ASSERT(crawled == 0);
        v->s->time = next;
        if (next == due) {
            moment = moment_of(v);
            SN_TRY(sn_run_record(v->run, &moment));
            output++;
        }
        if (next == corner) {
            p = set_pace(v, corners);
            corner = sn_net_next_corner(net, next);
        }
        if (next == due) SN_TRY(sn_run_save(v->run, v->s, own, owned));
    }
    return SN_OK;
}

static void destroy(sn_balance *v) {
    void *all[] = {v->history, v->start, v->before, v->b,         v->x,   v->last,
                   v->ext,     v->inner, v->touch,  v->inner_now, v->held};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_tangent_destroy(v->tangent);
    sn_state_destroy(v->s);
}

static sn_status create(sn_balance *v) {
    const sn_net *net = v->net;
    const size_t n = (size_t)net->nodes;
    SN_TRY(sn_state_create(net, &v->s));
    SN_TRY(sn_tangent_create(net, &v->tangent));
    v->history = sn_alloc(net->store_size, sizeof(double));
    v->start = sn_alloc(n * 4, sizeof(double));
    v->before = sn_alloc(n * 4, sizeof(double));
    v->b = sn_alloc(n * 3, sizeof(double));
    v->x = sn_alloc(n * 3, sizeof(double));
    v->last = sn_alloc(n * 3, sizeof(double));
    v->ext = sn_alloc(n * 3, sizeof(double));
    v->inner = sn_alloc(n * 3, sizeof(double));
    v->inner_now = sn_alloc(n * 3, sizeof(double));
    v->held = sn_alloc(net->cuttable ? n * 3 : 0, sizeof(double));
    v->touch = sn_alloc((size_t)net->tool_count * (size_t)net->contact_count, sizeof *v->touch);
    bool all = v->history && v->start && v->before && v->b && v->x && v->last && v->ext &&
               v->inner && v->inner_now && v->touch && v->held;
    if (!all) return SN_E_MEMORY;
    // rounding of the forces of a cell, 1e-16 of its stiffness times edge, must stay below
    // tolerance
    for (int r = 0; r < net->region_count; r++)
        v->least = fmax(v->least, 1e-5 * (net->region[r].shear + net->region[r].bulk));
    double mass = 0;
    for (int i = 0; i < net->nodes; i++) mass += net->mass[i] / net->nodes;
    v->firm = 1e5 * v->least * net->edge / mass;
    v->least *= net->edge * net->edge;
    // a new state stands where its supports are at time 0; start_up() brings them there
    memset(v->s->u, 0, n * 4 * sizeof(double));
    memset(v->s->store, 0, net->store_size * sizeof(double));
    memset(v->s->contact, 0,
           (size_t)net->tool_count * (size_t)net->contact_count * sizeof *v->s->contact);
    return SN_OK;
}

static void tell_of_snaps(const sn_balance *v) {
    char *note = v->run->summary->note;
    const size_t used = strlen(note);
    if (v->snaps == 0) return;
    snprintf(note + used, SN_TEXT_MAX - used,
             "%sthe body wrinkled or snapped to another equilibrium in %d of its steps, first at "
             "%.4g s: what it gave off there is dissipated",
             used ? "; " : "", v->snaps, v->first_snap);
}

sn_status sn_run_quasi_static(sn_run *run) {
    sn_balance v = {.run = run, .net = run->net};
    sn_status status = create(&v);
    if (status == SN_OK) status = march(&v);
    if (status == SN_OK) {
        const sn_moment moment = moment_of(&v);
        run->summary->simulated_s = v.s->time;
        run->summary->dissipated_J = v.given_off;
        tell_of_snaps(&v);
        sn_fields_fill(run->net, run->fields, &moment);
        sn_run_store(run, &moment);
    }
    destroy(&v);
    return status;
}
