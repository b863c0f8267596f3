// Equilibrium of a quasi-static run: Newton's method, and what is done where it finds none.
// SPDX-License-Identifier: Apache-2.0
//
// Newton's method on the forces at the end of a step with trial memory (stress = alpha T + history,
// which makes the step implicit and exact for stresses linear in time). The first correction of a
// step moves prescribed nodes to their new places together with the linear answer of all others, so
// that no cell beside a moved face is crushed on the way. Later corrections are halved until the
// residual falls.
//
// A body that wrinkles or snaps has no equilibrium near the last one, however short the step. Let
// go, it moves without inertia through a resistance to the motion of its mass, du/dt = r / (c m),
// in implicit steps c that grow as long as the tangent allows, until Newton's method takes over
// where it came to rest. The path goes downhill, so it ends in a stable equilibrium.
#include "springs/equilibrium.h"

#include <math.h>
#include <string.h>

enum { NEWTON_MOST = 40, HALVINGS = 10 };
enum { SNAP_MOST = 100 }; // corrections of a body let go
// residual over reactions and loads, where rounding allows no less
static const double settled = 1e-7;
static const double crushed = 0.3; // volume ratio: a body that folds into itself is not followed

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

static void external(sn_balance *v, sn_tangent *tangent) {
    const sn_net *net = v->net;
    sn_state *s = v->s;
    memset(v->ext, 0, (size_t)net->nodes * 3 * sizeof *v->ext);
    const sn_load_call load = {SN_DOUBLE, s->u, sn_state_parts(s), tangent};
    sn_net_loads(net, v->time, v->level, &load, v->ext);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) v->ext[3 * i + d] += v->level * net->mass[i] * net->gravity[d];
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

double sn_balance_residual(sn_balance *v, sn_memory_mode mode) {
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

static void assemble(sn_balance *v) {
    const sn_tangent_call call = {.u = v->s->u,
                                  .factors = v->s->factors,
                                  .history = v->history,
                                  .pressure = v->s->now.pressure,
                                  .parts = sn_state_parts(v->s)};
    sn_tangent_assemble(v->net, v->tangent, &call);
    external(v, v->tangent);
    sn_tangent_prepare(v->net, v->tangent);
}

//---- corrections ---------------------------------------------------------------------------------

// u <- before + part * x
static void place(sn_balance *v, double part) {
    double *u = v->s->u;
    for (int i = 0; i < v->net->nodes; i++)
        for (int d = 0; d < 3; d++) u[4 * i + d] = v->before[4 * i + d] + part * v->x[3 * i + d];
}

static void remember_place(sn_balance *v) {
    memcpy(v->before, v->s->u, (size_t)v->net->nodes * 4 * sizeof *v->before);
}

// x <- motion of prescribed nodes still to come, 0 elsewhere; returns whether there is any
static bool prescribed_motion(sn_balance *v) {
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

static void land_prescribed(sn_balance *v) {
    double *u = v->s->u;
    for (int k = 0; k < v->net->fixed_count; k++) {
        const sn_net_fixed *fixed = &v->net->fixed[k];
        u[4 * fixed->node + fixed->direction] =
            v->level * sn_net_prescribed(v->net, fixed, v->time);
    }
}

// the first correction: prescribed nodes go all their way
static bool predict(sn_balance *v, double h) {
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
    v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
    return isfinite(v->residual);
}

// one Newton correction with line search
static bool correct(sn_balance *v, double forcing) {
    const size_t n = (size_t)v->net->nodes * 3;
    assemble(v);
    memset(v->x, 0, n * sizeof *v->x);
    double goal = fmax(forcing * v->residual, 0.2 * v->net->tolerance * v->scale);
    sn_tangent_solve(v->net, v->tangent, v->b, goal, v->x);
    remember_place(v);
    double part = 1.0, before = v->residual;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        place(v, part);
        v->smallest = sn_net_smallest_ratio(v->net, sn_state_parts(v->s), v->s->u);
        if (!(v->smallest > 0)) continue;
        v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
        if (v->residual < (1.0 - 1e-3 * part) * before) return true;
    }
    // back to where it was better
    place(v, 0.0);
    v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
    return false;
}

bool sn_balance_equilibrium(sn_balance *v, double h) {
    const size_t quads = (size_t)v->net->nodes * 4;
    memcpy(v->start, v->s->u, quads * sizeof *v->start);
    v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
    if (v->residual <= v->net->tolerance * v->scale && !prescribed_motion(v))
        return true; // nothing acts
    bool good = predict(v, h);
    double forcing = 1e-2;
    for (int turn = 0; good && v->residual > v->net->tolerance * v->scale; turn++) {
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

// one implicit step of the resisted motion; false, where it was, if the tangent or the step is bad
static bool creep(sn_balance *v, double resistance) {
    const double before = v->residual;
    assemble(v);
    if (resistance > 0) {
        sn_tangent_add_mass(v->net, v->tangent, resistance);
        sn_tangent_prepare(v->net, v->tangent);
    }
    memset(v->x, 0, (size_t)v->net->nodes * 3 * sizeof *v->x);
    const double goal = fmax(1e-2 * before, 0.2 * v->net->tolerance * v->scale);
    const bool definite = sn_tangent_solve(v->net, v->tangent, v->b, goal, v->x) >= 0;
    remember_place(v);
    if (definite) {
        place(v, 1.0);
        v->smallest = sn_net_smallest_ratio(v->net, sn_state_parts(v->s), v->s->u);
        if (v->smallest > 0) {
            v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
            if (v->residual < 5.0 * before) return true; // the way down is not always easier
        }
    }
    place(v, 0.0);
    v->smallest = sn_net_smallest_ratio(v->net, sn_state_parts(v->s), v->s->u);
    v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
    return false;
}

bool sn_balance_snap(sn_balance *v, double h) {
    const size_t quads = (size_t)v->net->nodes * 4;
    const double most = v->firm, least = 1e-9 * most;
    memcpy(v->start, v->s->u, quads * sizeof *v->start);
    v->smallest = sn_net_smallest_ratio(v->net, sn_state_parts(v->s), v->s->u);
    v->residual = sn_balance_residual(v, SN_MEMORY_TRIAL);
    bool good = !prescribed_motion(v) || predict(v, h);
    double resistance = 1e-3 * most;
    for (int turn = 0; good && v->residual > v->net->tolerance * v->scale; turn++) {
        const double before = v->residual;
        v->run->summary->newton_iterations++;
        good = turn < SNAP_MOST && resistance < most && v->smallest > crushed;
        if (good && creep(v, resistance)) {
            resistance *= fmin(0.5, fmax(0.1, v->residual / before));
            if (resistance < least) resistance = 0;
        } else if (v->residual < settled * v->scale && resistance <= 0) {
            break; // rounding
        } else {
            resistance = fmax(2.0 * resistance, 1e-6 * most);
        }
    }
    if (!good) memcpy(v->s->u, v->start, quads * sizeof *v->start);
    return good;
}
