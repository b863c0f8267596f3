// The quasi-static run: equilibrium at every step, with memory.
// SPDX-License-Identifier: Apache-2.0
//
// Newton's method on the forces at the end of a step with trial memory (stress = alpha T + history,
// which makes the step implicit and exact for stresses linear in time). The first correction of a
// step moves prescribed nodes to their new places together with the linear answer of all others, so
// that no cell beside a moved face is crushed on the way. Later corrections are halved until the
// residual falls. A step that fails is halved, and grows again afterwards.
//
// Steps land on outputs and on corners of whatever is imposed. While something changes there are at
// least 20 steps to a ramp. After each corner memory starts with short steps that grow by half each
// time: then the free part of the strain, which creeps while a boundary is held, is followed too.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/run.h"
#include "springs/steps.h"

enum { NEWTON_MOST = 40, HALVINGS = 10, RAMP_STEPS = 20, FEW_CORNERS = 8, CUTS_MOST = 24 };
static const double least_step = 1e-8; // of the whole time
static const double tolerance = 1e-10; // residual over reactions and loads
static const double settled = 1e-7;    // the same where rounding allows no less
static const double grow = 1.5;

typedef struct solver {
    sn_run *run;
    const sn_net *net;
    sn_state *s;
    sn_tangent *tangent;
    double *history;
    double *start, *before; ///< quads: at the start of the step, of the correction
    double *b, *x;          ///< (nodes x 3)
    double *last;           ///< free part of the last step's motion  (nodes x 3)
    double last_step;
    double *ext;    ///< loads, tools and weight               (nodes x 3)
    double *inner;  ///< internal forces at the start of the step (nodes x 3)
    double *held;   ///< Nullable: after a cut, forces that hold the body where it was
    double holding; ///< part of them that acts yet
    double *inner_now;
    sn_contact *touch;   ///< trial contact
    double time, level;  ///< that equilibrium is sought for; part of the loads
    double scale, least; ///< of the residual; the least of it: when nothing pulls
    double smallest;     ///< volume ratio of any cell
    double residual;
} solver;

//---- residual ------------------------------------------------------------------------------------

double sn_net_smallest_ratio(const sn_net *net, const sn_parts *parts, const double *u) {
    const double *gradient = net->data[SN_DOUBLE].gradient;
    const double *volume = sn_parts_volume(net, parts, SN_DOUBLE);
    double least = INFINITY;
    for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) {
        const size_t block = (size_t)s / SN_BLOCK, lane = (size_t)s % SN_BLOCK;
        const int *corner = net->cell_node + block * 4 * SN_BLOCK + lane;
        double F[9];
        if (!(volume[s] > 0)) continue; // gone, or filling: a copy of a cell that may be gone
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++) {
                double sum = net->axes[3 * j + i];
                for (size_t a = 1; a < 4; a++)
                    sum += (u[4 * corner[a * SN_BLOCK] + (int)i] - u[4 * corner[0] + (int)i]) *
                           gradient[(block * 9 + 3 * (a - 1) + j) * SN_BLOCK + lane];
                F[3 * i + j] = sum;
            }
        double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                   F[2] * (F[3] * F[7] - F[4] * F[6]);
        least = fmin(least, J);
        if (!isfinite(J)) return (double)NAN;
    }
    return least;
}

static void external(solver *v, sn_tangent *tangent) {
    const sn_net *net = v->net;
    sn_state *s = v->s;
    memset(v->ext, 0, (size_t)net->nodes * 3 * sizeof *v->ext);
    const sn_load_call load = {SN_DOUBLE, s->u, sn_state_parts(s)};
    sn_net_loads(net, v->time, &load, v->ext);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            v->ext[3 * i + d] = v->level * (v->ext[3 * i + d] + net->mass[i] * net->gravity[d]);
    for (int t = 0; t < net->tool_count; t++)
        sn_net_tool_pose(net, s, t, v->time, &s->tool_pose[t]);
    const sn_contact_call call = {.precision = SN_DOUBLE,
                                  .u = s->u,
                                  .pose = s->tool_pose,
                                  .before = s->contact,
                                  .after = v->touch,
                                  .ext = v->ext,
                                  .tool_force = s->tool_force,
                                  .parts = load.parts,
                                  .tangent = tangent ? sn_tangent_add_contact : NULL,
                                  .context = tangent};
    sn_net_contact(net, &call);
}

// forces at s->u; b <- residual of the free directions; returns its norm
static double find_residual(solver *v, sn_memory_mode mode) {
    const sn_net *net = v->net;
    sn_state *s = v->s;
    const sn_force_call call = {.precision = SN_DOUBLE,
                                .mode = mode,
                                .u = s->u,
                                .factors = s->factors,
                                .store = s->store,
                                .history = v->history,
                                .parts = sn_state_parts(s),
                                .out = &s->now,
                                .team = s->team};
    sn_net_forces(net, &call);
    external(v, NULL);
    double *f = s->now.f, free2 = 0, fixed2 = 0, ext2 = 0;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            double inner = f[4 * i + d] - net->mass[i] * net->gravity[d];
            double all = inner + v->ext[3 * i + d];
            if (v->holding > 0) all += v->holding * v->held[3 * i + d];
            v->inner_now[3 * i + d] = inner;
            f[4 * i + d] = all;
            bool fixed = net->fixed_bits[i] >> d & 1;
            bool loose = call.parts && call.parts->loose[i]; // stays where it is
            v->b[3 * i + d] = fixed || loose ? 0.0 : all;
            ext2 += v->ext[3 * i + d] * v->ext[3 * i + d];
            if (loose) continue;
            if (fixed)
                fixed2 += all * all;
            else
                free2 += all * all;
        }
    v->scale = fmax(fmax(sqrt(fixed2), sqrt(ext2)), v->least);
    return sqrt(free2);
}

static void assemble(solver *v) {
    const sn_tangent_call call = {.u = v->s->u,
                                  .factors = v->s->factors,
                                  .history = v->history,
                                  .pressure = v->s->now.pressure,
                                  .parts = sn_state_parts(v->s)};
    sn_tangent_assemble(v->net, v->tangent, &call);
    if (v->net->tool_count > 0) external(v, v->tangent);
    sn_tangent_prepare(v->net, v->tangent);
}

//---- corrections ---------------------------------------------------------------------------------

// u <- before + part * x
static void place(solver *v, double part) {
    double *u = v->s->u;
    for (int i = 0; i < v->net->nodes; i++)
        for (int d = 0; d < 3; d++) u[4 * i + d] = v->before[4 * i + d] + part * v->x[3 * i + d];
}

static void remember_place(solver *v) {
    memcpy(v->before, v->s->u, (size_t)v->net->nodes * 4 * sizeof *v->before);
}

// x <- motion of prescribed nodes still to come, 0 elsewhere; returns whether there is any
static bool prescribed_motion(solver *v) {
    const double *u = v->s->u;
    bool any = false;
    memset(v->x, 0, (size_t)v->net->nodes * 3 * sizeof *v->x);
    for (int k = 0; k < v->net->fixed_count; k++) {
        const sn_net_fixed *fixed = &v->net->fixed[k];
        double there = v->level * sn_net_prescribed(v->net, fixed, v->time);
        double way = there - u[4 * fixed->node + fixed->direction];
        v->x[3 * fixed->node + fixed->direction] = way;
        any = any || way != 0;
    }
    return any;
}

static void land_prescribed(solver *v) {
    double *u = v->s->u;
    for (int k = 0; k < v->net->fixed_count; k++) {
        const sn_net_fixed *fixed = &v->net->fixed[k];
        u[4 * fixed->node + fixed->direction] =
            v->level * sn_net_prescribed(v->net, fixed, v->time);
    }
}

// the first correction: prescribed nodes go all their way
static bool predict(solver *v, double h) {
    const size_t n = (size_t)v->net->nodes * 3;
    double *way = v->s->ext; // scratch here
    assemble(v);
    if (prescribed_motion(v)) {
        memcpy(way, v->x, n * sizeof *way);
        double *pushed = v->inner_now; // overwritten by the next residual
        sn_tangent_multiply(v->net, v->tangent, way, pushed);
        for (size_t k = 0; k < n; k++)
            if (!(v->net->fixed_bits[k / 3] >> (k % 3) & 1)) v->b[k] -= pushed[k];
    } else {
        memset(way, 0, n * sizeof *way);
    }
    double norm = 0;
    for (size_t k = 0; k < n; k++) norm += v->b[k] * v->b[k];
    // the last step's motion, continued, is the first guess
    double part = v->last_step > 0 ? h / v->last_step : 0.0;
    for (size_t k = 0; k < n; k++) v->x[k] = part * v->last[k];
    sn_tangent_solve(v->net, v->tangent, v->b, 1e-4 * sqrt(norm), v->x);
    for (size_t k = 0; k < n; k++) v->x[k] += way[k];
    remember_place(v);
    place(v, 1.0);
    land_prescribed(v);
    v->smallest = sn_net_smallest_ratio(v->net, sn_state_parts(v->s), v->s->u);
    if (!(v->smallest > 0)) return false;
    v->residual = find_residual(v, SN_MEMORY_TRIAL);
    return isfinite(v->residual);
}

// one Newton correction with line search
static bool correct(solver *v, double forcing) {
    const size_t n = (size_t)v->net->nodes * 3;
    assemble(v);
    memset(v->x, 0, n * sizeof *v->x);
    double goal = fmax(forcing * v->residual, 0.2 * tolerance * v->scale);
    sn_tangent_solve(v->net, v->tangent, v->b, goal, v->x);
    remember_place(v);
    double part = 1.0, before = v->residual;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        place(v, part);
        v->smallest = sn_net_smallest_ratio(v->net, sn_state_parts(v->s), v->s->u);
        if (!(v->smallest > 0)) continue;
        v->residual = find_residual(v, SN_MEMORY_TRIAL);
        if (v->residual < (1.0 - 1e-3 * part) * before) return true;
    }
    // back to where it was better
    place(v, 0.0);
    v->residual = find_residual(v, SN_MEMORY_TRIAL);
    return false;
}

// equilibrium at v->time and v->level with the present factors; u keeps what it was where it fails
static bool equilibrium(solver *v, double h) {
    const size_t quads = (size_t)v->net->nodes * 4;
    memcpy(v->start, v->s->u, quads * sizeof *v->start);
    v->residual = find_residual(v, SN_MEMORY_TRIAL);
    if (v->residual <= tolerance * v->scale && !prescribed_motion(v)) return true; // nothing acts
    bool good = predict(v, h);
    double forcing = 1e-2;
    for (int turn = 0; good && v->residual > tolerance * v->scale; turn++) {
        double before = v->residual;
        v->run->summary->newton_iterations++;
        good = turn < NEWTON_MOST && correct(v, forcing);
        if (!good && v->residual < settled * v->scale) good = true; // rounding
        if (v->residual >= before) break;
        double ratio = v->residual / before;
        forcing = fmin(0.05, fmax(1e-6, ratio * ratio));
    }
    if (!good) memcpy(v->s->u, v->start, quads * sizeof *v->start);
    return good;
}

//---- steps ---------------------------------------------------------------------------------------

static void use_factors(solver *v, double h) {
    sn_net_factors(v->net, h, v->s->factors);
    sn_net_history(v->net, v->s->factors, v->s->store, v->history);
}

// takes what was found for the state: memory and contact
static void keep(solver *v) {
    const sn_net *net = v->net;
    sn_state *s = v->s;
    find_residual(v, SN_MEMORY_ADVANCE);
    memcpy(s->contact, v->touch,
           (size_t)net->tool_count * (size_t)net->contact_count * sizeof *s->contact);
}

// accepts a step: memory, contact, work
static void accept(solver *v, double h) {
    const sn_net *net = v->net;
    const double *u = v->s->u;
    keep(v);
    double work = 0;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            int k = 3 * i + d;
            double way = u[4 * i + d] - v->start[4 * i + d];
            work -= 0.5 * way * (v->inner[k] + v->inner_now[k]);
            v->last[k] = net->fixed_bits[i] >> d & 1 ? 0.0 : way;
        }
    memcpy(v->inner, v->inner_now, (size_t)net->nodes * 3 * sizeof *v->inner);
    // in equilibrium all that is done from outside is done on the tissue
    v->run->internal_work += work;
    v->run->external_work += work;
    v->last_step = h;
}

static void give_up(solver *v, double h) {
    sn_run_summary *s = v->run->summary;
    s->converged = false;
    snprintf(
        s->reason, sizeof s->reason,
        "no equilibrium at %.6g s of %.6g s: residual %.2g of the forces, smallest volume ratio "
        "of a cell %.3g, after %d cuts of the step down to %.2g s",
        v->time, v->net->until, v->residual / v->scale, v->smallest, s->cutbacks, h);
}

// factors of a change that takes no time
static void use_sudden_factors(solver *v) {
    use_factors(v, 1e-12 * v->net->until);
    sn_net_no_impulse(v->net, v->s->factors);
    sn_net_history(v->net, v->s->factors, v->s->store, v->history);
}

// all that acts at time 0 acts at once: instantaneous stiffness, the loads in parts where needed
static bool start_up(solver *v) {
    double part = 1.0;
    v->time = 0;
    v->level = 0;
    for (int cuts = 0; v->level < 1.0;) {
        double from = v->level;
        v->level = fmin(1.0, from + part);
        use_sudden_factors(v);
        if (equilibrium(v, part)) {
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

static sn_moment moment_of(const solver *v) {
    return (sn_moment){.time = v->s->time,
                       .precision = SN_DOUBLE,
                       .u = v->s->u,
                       .f = v->s->now.f,
                       .store = v->s->store,
                       .pressure = v->s->now.pressure,
                       .tool_force = v->s->tool_force,
                       .parts = sn_state_parts(v->s)};
}

static double work_of_loads(const solver *v, const double *from) {
    const double *u = v->s->u;
    double work = 0;
    for (int i = 0; i < v->net->nodes; i++)
        for (int d = 0; d < 3; d++) work += v->ext[3 * i + d] * (u[4 * i + d] - from[4 * i + d]);
    return work;
}

// from the place before the cut to equilibrium of what is left: forces that balance the cut fade
// away, at once or in parts where needed. work: of loads. False where there is none to be found
static bool spring_back(solver *v, double *work) {
    const size_t n = (size_t)v->net->nodes * 3;
    double part = 1.0;
    use_sudden_factors(v);
    v->holding = 0;
    find_residual(v, SN_MEMORY_TRIAL);
    for (size_t k = 0; k < n; k++) v->held[k] = -v->b[k];
    for (v->holding = 1.0; v->holding > 0;) {
        const double from = v->holding;
        v->holding = fmax(0.0, from - part);
        use_sudden_factors(v);
        if (equilibrium(v, part)) {
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
static sn_status cut(solver *v, bool *good) {
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

static pace set_pace(const solver *v, int corners) {
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

// one step of at most h to v->s->time + h; false where none, however short, succeeds
static bool step(solver *v, double *h) {
    double wall = sn_clock();
    for (;;) {
        v->time = v->s->time + *h;
        use_factors(v, *h);
        if (equilibrium(v, *h)) break;
        v->run->summary->cutbacks++;
        if (*h < least_step * v->net->until) {
            give_up(v, *h);
            return false;
        }
        *h *= 0.5;
    }
    accept(v, *h);
    v->s->time = v->time;
    sn_run_summary *s = v->run->summary;
    s->step_s = s->steps++ == 0 ? *h : fmin(s->step_s, *h);
    sn_run_wall(v->run, sn_clock() - wall);
    sn_run_progress(v->run, v->time);
    return true;
}

static sn_status march(solver *v) {
    const sn_net *net = v->net;
    const double tiny = 1e-9 * net->until;
    const int corners = count_corners(net);
    const size_t n = (size_t)net->nodes * 3;
    sn_moment moment;
    pace p = {0};
    double corner = sn_net_next_corner(net, 0.0);
    long output = 1;
    const sn_piece own[] = {{&output, sizeof output},
                            {&corner, sizeof corner},
                            {&p, sizeof p},
                            {&v->last_step, sizeof v->last_step},
                            {v->last, n * sizeof *v->last},
                            {v->inner, n * sizeof *v->inner}};
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
            if (!step(v, &h)) return SN_OK;
            p.wish = h < asked ? h : fmax(p.wish, h) * grow;
            if (net->asked_step > 0 && h == asked) p.wish = net->asked_step;
        }
        if (v->s->time < next - tiny) continue;
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

static void destroy(solver *v) {
    void *all[] = {v->history, v->start, v->before, v->b,         v->x,   v->last,
                   v->ext,     v->inner, v->touch,  v->inner_now, v->held};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_tangent_destroy(v->tangent);
    sn_state_destroy(v->s);
}

static sn_status create(solver *v) {
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
    v->least *= net->edge * net->edge;
    // a new state stands where its supports are at time 0; start_up() brings them there
    memset(v->s->u, 0, n * 4 * sizeof(double));
    memset(v->s->store, 0, net->store_size * sizeof(double));
    memset(v->s->contact, 0,
           (size_t)net->tool_count * (size_t)net->contact_count * sizeof *v->s->contact);
    return SN_OK;
}

sn_status sn_run_quasi_static(sn_run *run) {
    solver v = {.run = run, .net = run->net};
    sn_status status = create(&v);
    if (status == SN_OK) status = march(&v);
    if (status == SN_OK) {
        const sn_moment moment = moment_of(&v);
        run->summary->simulated_s = v.s->time;
        sn_fields_fill(run->net, run->fields, &moment);
        sn_run_store(run, &moment);
    }
    destroy(&v);
    return status;
}
