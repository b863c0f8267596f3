// States and the explicit step.
// SPDX-License-Identifier: Apache-2.0
//
// Symplectic Euler: v <- v + h a(u), u <- u + h v, then the forces at the new place, which also
// move the memory on by h. At the end of a step u, the forces and the memory belong to one time; v
// belongs to the middle of the step, so a kick lasts from the middle of the last step to that of
// the next, and half a step at the start: second order in u. Prescribed directions take the place
// they must have at the new time, and the velocity that leads there.
//
// Damping acts on the velocity relative to the rigid motion of the whole body (the velocity and
// spin that have its momentum and angular momentum), by the factor exp(-damping h), between the two
// halves of the kick: it takes no momentum, does not slow a fall or a spin, and leaves the
// stability limit where it is or higher.
#include <float.h>
#include <math.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/steps.h"

static const double lost_way = 1e3;  // of an edge in one step: nothing comes back from there
static const double wild_way = 0.02; // of an edge in one step: a fiftieth of the speed of waves

static size_t real_size(sn_precision p) {
    return p == SN_SINGLE ? sizeof(float) : sizeof(double);
}

sn_status sn_state_create(const sn_net *net, sn_state **state) {
    *state = NULL;
    sn_state *s = sn_alloc(1, sizeof *s);
    if (!s) return SN_E_MEMORY;
    const size_t nodes = (size_t)net->nodes, size = real_size(net->precision);
    const size_t tools = (size_t)net->tool_count;
    const bool steps = net->integrator == SN_INTEGRATOR_EXPLICIT;
    s->precision = net->precision;
    s->u = sn_alloc(nodes * 4, size);
    s->v = sn_alloc(nodes * 4, size);
    s->f_before = sn_alloc(nodes * 4, size);
    s->store = sn_alloc(net->store_size, size);
    s->factors = sn_alloc((size_t)net->region_count, sizeof *s->factors);
    s->a_fixed = sn_alloc((size_t)net->fixed_count, sizeof *s->a_fixed);
    s->ext = sn_alloc(nodes * 3, sizeof *s->ext);
    s->chunk_sum = sn_alloc((size_t)sn_net_chunks(net), sizeof *s->chunk_sum);
    s->chunk_fastest = sn_alloc((size_t)sn_net_chunks(net), sizeof *s->chunk_fastest);
    s->contact = sn_alloc(tools * (size_t)net->contact_count, sizeof *s->contact);
    s->tool_pose = sn_alloc(tools, sizeof *s->tool_pose);
    s->tool_set = sn_alloc(tools, sizeof *s->tool_set);
    s->tool_force = sn_alloc(tools, sizeof *s->tool_force);
    s->tool_torque = sn_alloc(tools, sizeof *s->tool_torque);
    s->tool_phase = sn_alloc(tools, sizeof *s->tool_phase);
    s->load_factor = sn_alloc((size_t)net->factor_count, sizeof *s->load_factor);
    s->load_was = sn_alloc((size_t)net->factor_count, sizeof *s->load_was);
    s->load_set = sn_alloc((size_t)net->factor_count, sizeof *s->load_set);
    s->push = sn_alloc(nodes * 3, sizeof *s->push);
    s->pushed = sn_alloc(nodes, sizeof *s->pushed);
    s->grip = sn_alloc(nodes, sizeof *s->grip);
    s->gripped = sn_alloc(nodes, sizeof *s->gripped);
    s->look.u = sn_alloc(steps ? nodes * 4 : 0, size);
    s->probe_trial = sn_alloc(steps ? nodes * 4 : 0, size);
    s->mode = sn_alloc(nodes * 3, sizeof *s->mode);
    s->basis = sn_alloc(steps ? nodes * 3 * (SN_LANCZOS_MAX + 1) : 0, sizeof *s->basis);
    bool all = s->u && s->v && s->f_before && s->store && s->factors && s->a_fixed && s->ext &&
               s->contact && s->tool_pose && s->tool_set && s->tool_force && s->probe_trial &&
               s->look.u && s->mode && s->basis && s->chunk_sum && s->chunk_fastest &&
               s->tool_torque && s->tool_phase && s->load_factor && s->load_was && s->load_set &&
               s->push && s->pushed && s->grip && s->gripped;
    if (!all || sn_scratch_create(net, s->precision, &s->now) != SN_OK ||
        (net->integrator != SN_INTEGRATOR_QUASI_STATIC &&
         sn_scratch_create(net, net->precision, &s->probe) != SN_OK)) {
        sn_state_destroy(s);
        return SN_E_MEMORY;
    }
    sn_status status = sn_team_create(net->threads, &s->team);
    if (status == SN_OK && net->cuttable) status = sn_cut_create(net, &s->cut);
    if (status == SN_OK && net->integrator == SN_INTEGRATOR_IMPLICIT)
        status = sn_implicit_create(net, &s->implicit);
    if (status != SN_OK) {
        sn_state_destroy(s);
        return status;
    }
    sn_state_reset(net, s);
    *state = s;
    return SN_OK;
}

void sn_state_destroy(sn_state *s) {
    if (!s) return;
    sn_team_destroy(s->team);
    sn_implicit_destroy(s->implicit);
    sn_cut_destroy(s->cut);
    sn_scratch_destroy(&s->now);
    sn_scratch_destroy(&s->probe);
    void *all[] = {s->chunk_sum,  s->chunk_fastest, s->u,          s->v,           s->f_before,
                   s->store,      s->factors,       s->a_fixed,    s->ext,         s->contact,
                   s->tool_set,   s->tool_pose,     s->mode,       s->probe_trial, s->basis,
                   s->tool_force, s->tool_torque,   s->tool_phase, s->load_factor, s->load_was,
                   s->load_set,   s->push,          s->pushed,     s->grip,        s->gripped,
                   s->look.u};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_free(s);
}

// loads and contact at the present place and time, added to the forces
static void find_outer(const sn_net *net, sn_state *s) {
    const sn_parts *parts = sn_state_parts(s);
    const sn_load_call load = {s->precision, s->u, parts, NULL};
    const bool touched = s->touching;
    if (net->load_count > 0 || touched) sn_net_clear_ext(net, parts, s->ext);
    for (int l = 0; l < net->load_count; l++)
        sn_net_add_load(net, l, sn_state_load_factor(net, s, net->load[l].name, s->time), &load,
                        s->ext);
    for (int t = 0; t < net->tool_count; t++)
        sn_net_tool_pose(net, s, t, s->time, &s->tool_pose[t]);
    const sn_contact_call touch = {.precision = s->precision,
                                   .u = s->u,
                                   .pose = s->tool_pose,
                                   .before = s->contact,
                                   .after = s->contact,
                                   .ext = s->ext,
                                   .tool_force = s->tool_force,
                                   .tool_torque = s->tool_torque,
                                   .grip = s->gripped_count > 0 ? s->grip : NULL,
                                   .parts = parts};
    s->touching = sn_net_contact(net, &touch);
    if (s->touching && !touched) sn_state_look_closer(net, s);
    if (net->load_count == 0 && !s->touching) return;
    for (int k = 0; k < sn_net_loaded(net, parts); k++)
        for (int d = 0; d < 3; d++) {
            size_t at = 4 * (size_t)net->loaded[k] + (size_t)d;
            sn_real_put(s->precision, s->now.f, at,
                        sn_real_at(s->precision, s->now.f, at) + s->ext[3 * net->loaded[k] + d]);
        }
}

// all forces at the present place and time
static void find_forces(const sn_net *net, sn_state *s, sn_memory_mode mode) {
    const sn_force_call call = {.precision = s->precision,
                                .mode = mode,
                                .u = s->u,
                                .factors = s->factors,
                                .store = s->store,
                                .parts = sn_state_parts(s),
                                .upright = sn_state_is_upright(s),
                                .out = &s->now,
                                .team = s->team};
    sn_net_forces(net, &call);
    if (sn_net_loaded(net, sn_state_parts(s)) > 0) find_outer(net, s);
    sn_state_add_pushes(s);
    if (s->touching) sn_state_ease_contact(net, s);
    sn_state_pull_tools(net, s);
}

void sn_state_find_forces(const sn_net *net, sn_state *s) {
    find_forces(net, s, SN_MEMORY_ADVANCE);
}

// forces after a sudden change: the branches take all of it, as by a step of no length
static void change_suddenly(const sn_net *net, sn_state *s) {
    memset(s->ext, 0, (size_t)net->nodes * 3 * sizeof *s->ext);
    sn_net_factors(net, 1e-12 * net->until, s->factors);
    sn_net_no_impulse(net, s->factors);
    s->factors_step = 0;
    find_forces(net, s, SN_MEMORY_ADVANCE);
}

// in each precision by itself, so that the compiler makes wide comparisons of it
static bool forces_are_finite(const sn_net *net, const sn_state *s) {
    const size_t count = 4 * (size_t)net->nodes;
    int bad = 0;
    if (s->precision == SN_SINGLE) {
        const float *f = s->now.f;
        for (size_t k = 0; k < count; k++) bad |= !(fabsf(f[k]) <= FLT_MAX);
    } else {
        const double *f = s->now.f;
        for (size_t k = 0; k < count; k++) bad |= !(fabs(f[k]) <= DBL_MAX);
    }
    return !bad;
}

// at rest, but for what is prescribed at the state's time
void sn_state_rest(const sn_net *net, sn_state *s) {
    const size_t nodes = (size_t)net->nodes, size = real_size(s->precision);
    memset(s->u, 0, nodes * 4 * size);
    memset(s->v, 0, nodes * 4 * size);
    memset(s->store, 0, net->store_size * size);
    memset(s->a_fixed, 0, (size_t)net->fixed_count * sizeof *s->a_fixed);
    memset(s->contact, 0,
           (size_t)net->tool_count * (size_t)net->contact_count * sizeof *s->contact);
    for (int k = 0; k < net->fixed_count; k++) {
        const sn_net_fixed *fixed = &net->fixed[k];
        sn_real_put(s->precision, s->u, 4 * (size_t)fixed->node + (size_t)fixed->direction,
                    sn_state_prescribed(net, s, fixed, s->time, false));
    }
    for (int t = 0; t < net->tool_count; t++) sn_state_release(net, s, t);
    sn_state_rest_frequency(net, s);
    s->last_step = 0;
    s->touching = s->crushed = false;
    change_suddenly(net, s);
    if (sn_state_parts(s) && net->integrator == SN_INTEGRATOR_EXPLICIT)
        sn_state_find_frequency(net, s);
    if (!forces_are_finite(net, s))
        memset(s->now.f, 0, nodes * 4 * size); // prescribed out of shape
    memcpy(s->f_before, s->now.f, nodes * 4 * size);
    if (s->implicit) sn_implicit_reset(net, s->implicit);
}

void sn_state_reset(const sn_net *net, sn_state *s) {
    s->time = 0;
    s->steps = 0;
    s->warnings = 0;
    s->broken = false;
    s->damped_energy = 0;
    if (s->cut) sn_cut_mend(net, s->cut);
    sn_state_clear_imposed(net, s);
    sn_state_rest(net, s);
}

//---- damping -------------------------------------------------------------------------------------

// solves the symmetric 3 x 3 system A w = b; a direction without inertia gets no spin
static void solve3(const double A[9], const double b[3], double w[3]) {
    double M[3][4], scale = fmax(A[0], fmax(A[4], A[8]));
    bool done[3] = {false, false, false};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) M[i][j] = A[3 * i + j];
        M[i][3] = b[i];
    }
    for (int turn = 0; turn < 3; turn++) {
        int p = -1;
        for (int i = 0; i < 3; i++)
            if (!done[i] && (p < 0 || M[i][i] > M[p][p])) p = i;
        if (!(M[p][p] > 1e-12 * scale)) break;
        done[p] = true;
        for (int i = 0; i < 3; i++) {
            if (i == p) continue;
            double factor = M[i][p] / M[p][p];
            for (int j = 0; j < 4; j++) M[i][j] -= factor * M[p][j];
        }
    }
    for (int i = 0; i < 3; i++) w[i] = done[i] ? M[i][3] / M[i][i] : 0.0;
}

// velocity and spin with the momentum and angular momentum of each piece; piece: Nullable, of nodes
static void find_rigid(const sn_net *net, const sn_state *s, const int *piece, int pieces,
                       sn_rigid *all) {
    memset(all, 0, (size_t)pieces * sizeof *all);
    for (int i = 0; i < net->nodes; i++) {
        if (piece && piece[i] < 0) continue;
        sn_rigid *move = &all[piece ? piece[i] : 0];
        move->mass += net->mass[i];
        for (int d = 0; d < 3; d++) {
            size_t at = 4 * (size_t)i + (size_t)d;
            move->centre[d] +=
                net->mass[i] * (net->node_position[3 * i + d] + sn_real_at(s->precision, s->u, at));
            move->linear[d] += net->mass[i] * sn_real_at(s->precision, s->v, at);
        }
    }
    for (int k = 0; k < pieces; k++)
        for (int d = 0; d < 3; d++) {
            all[k].centre[d] /= all[k].mass;
            all[k].linear[d] /= all[k].mass;
        }
    for (int i = 0; i < net->nodes; i++) {
        double r[3], v[3], m = net->mass[i], r2 = 0;
        if (piece && piece[i] < 0) continue;
        sn_rigid *move = &all[piece ? piece[i] : 0];
        for (int d = 0; d < 3; d++) {
            size_t at = 4 * (size_t)i + (size_t)d;
            r[d] = net->node_position[3 * i + d] + sn_real_at(s->precision, s->u, at) -
                   move->centre[d];
            v[d] = sn_real_at(s->precision, s->v, at);
            r2 += r[d] * r[d];
        }
        for (int d = 0; d < 3; d++) {
            int e = (d + 1) % 3, g = (d + 2) % 3;
            move->spin[d] += m * (r[e] * v[g] - r[g] * v[e]);
            for (int k = 0; k < 3; k++)
                move->inertia[3 * d + k] += m * ((d == k) * r2 - r[d] * r[k]);
        }
    }
    for (int k = 0; k < pieces; k++) {
        double momentum[3];
        memcpy(momentum, all[k].spin, sizeof momentum);
        solve3(all[k].inertia, momentum, all[k].spin);
    }
}

static double kinetic(const sn_net *net, const sn_state *s) {
    double sum = 0;
    for (int i = 0; i < net->nodes; i++)
        for (size_t d = 0; d < 3; d++) {
            double v = sn_real_at(s->precision, s->v, 4 * (size_t)i + d);
            sum += 0.5 * net->mass[i] * v * v;
        }
    return sum;
}

// v += the kick of half a step by the present forces, but of nodes that tools hold
void sn_state_half_kick(const sn_net *net, sn_state *s, double half) {
    for (size_t k = 0; k < 4 * (size_t)net->nodes; k++) {
        if (s->grip[k / 4].tool >= 0) continue;
        double a = sn_real_at(s->precision, s->now.f, k) *
                   sn_real_at(s->precision, net->data[s->precision].inverse_mass, k);
        sn_real_put(s->precision, s->v, k, sn_real_at(s->precision, s->v, k) + half * a);
    }
}

// on the velocity at the time of u, between the halves of the kick: second order (but for a term of
// damping^2 h where supports hold part of the rigid motion), and what it takes can be counted
static void damp(const sn_net *net, sn_state *s, double h) {
    sn_rigid whole, *all = sn_state_rigid(s) ? sn_state_rigid(s) : &whole;
    int pieces = 1;
    const int *piece = sn_state_pieces(s, &pieces);
    sn_state_half_kick(net, s, 0.5 * s->last_step);
    find_rigid(net, s, piece, pieces, all);
    const double keep = exp(-0.5 * net->damping * (s->last_step + h));
    double before = kinetic(net, s);
    for (int i = 0; i < net->nodes; i++) {
        double r[3];
        if (piece && piece[i] < 0) continue; // a node alone has no motion but its own
        const sn_rigid move = all[piece ? piece[i] : 0];
        for (int d = 0; d < 3; d++)
            r[d] = net->node_position[3 * i + d] +
                   sn_real_at(s->precision, s->u, 4 * (size_t)i + (size_t)d) - move.centre[d];
        for (int d = 0; d < 3; d++) {
            if (net->fixed_bits[i] >> d & 1 || s->grip[i].tool >= 0) continue;
            int e = (d + 1) % 3, g = (d + 2) % 3;
            double rigid = move.linear[d] + move.spin[e] * r[g] - move.spin[g] * r[e];
            size_t at = 4 * (size_t)i + (size_t)d;
            double v = sn_real_at(s->precision, s->v, at);
            sn_real_put(s->precision, s->v, at, rigid + keep * (v - rigid));
        }
    }
    s->damped_energy += before - kinetic(net, s);
    sn_state_half_kick(net, s, -0.5 * s->last_step);
}

//---- steps ---------------------------------------------------------------------------------------

typedef struct move_work {
    const sn_spring_kernels *kernels;
    sn_move_pass pass;
} move_work;

static void move_task(void *context, int chunk) {
    const move_work *w = context;
    w->kernels->move(&w->pass, chunk);
}

// kick by the force and drift; the sum of squared velocities and a bound of the speed of any node
static void move_nodes(const sn_net *net, sn_state *s, const void *force, double h, double *sum,
                       double *fastest) {
    move_work w = {.kernels = sn_spring_kernels_row(net->isa, s->precision),
                   .pass = {.nodes = net->nodes,
                            .step = h,
                            .kick = 0.5 * (s->last_step + h),
                            .force = force,
                            .inverse_mass = net->data[s->precision].inverse_mass,
                            .u = s->u,
                            .v = s->v,
                            .sum = s->chunk_sum,
                            .fastest = s->chunk_fastest}};
    double largest = 0;
    sn_team_run(s->team, sn_net_chunks(net), move_task, &w);
    *sum = 0;
    for (int k = 0; k < sn_net_chunks(net); k++) {
        *sum += s->chunk_sum[k];
        largest = fmax(largest, s->chunk_fastest[k]);
    }
    *fastest = sqrt(3 * largest);
}

// a bound of the speed of any node that has cells: those that have none change no force
static double fastest_bound(const sn_net *net, const sn_state *s) {
    const bool *loose = sn_state_parts(s)->loose;
    double most = 0;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3 && !loose[i]; d++)
            most = fmax(most, fabs(sn_real_at(s->precision, s->v, 4 * (size_t)i + (size_t)d)));
    return sqrt(3.0) * most;
}

static void move_prescribed(const sn_net *net, sn_state *s, double h) {
    for (int k = 0; k < net->fixed_count; k++) {
        const sn_net_fixed *fixed = &net->fixed[k];
        const size_t at = 4 * (size_t)fixed->node + (size_t)fixed->direction;
        // from the exact places: differences of rounded ones would shake
        double there = sn_state_prescribed(net, s, fixed, s->time + h, false);
        double v = (there - sn_state_prescribed(net, s, fixed, s->time, true)) / h;
        double before = s->steps == 0 ? v : sn_real_at(s->precision, s->v, at);
        s->a_fixed[k] = (v - before) / h;
        sn_real_put(s->precision, s->v, at, v);
        sn_real_put(s->precision, s->u, at, there);
    }
    for (int l = 0; l < net->factor_count; l++)
        s->load_was[l] = s->load_set[l] ? s->load_factor[l] : (double)NAN;
}

// an equal part of dt: steps that take turns in length feed oscillations whose period is near four
// steps and a half or less, even where each of them is within the limit
static double choose_step(const sn_net *net, sn_state *s, double dt) {
    double limit = sn_net_step_safety(net) * sn_net_stable_step(net, s->ruling_omega2);
    if (net->asked_step > limit) s->warnings++;
    if (net->asked_step > 0) limit = fmin(limit, net->asked_step);
    if (s->touching) limit = fmin(limit, SN_TOUCH_GROWTH * sn_state_touch_step(net, s));
    if (!(dt > limit)) return dt;
    const double parts = dt / limit, h = parts < 1e9 ? dt / ceil(parts - 1e-9) : limit;
    // what is left of dt has rounding errors, which no step need follow
    return fabs(h - s->factors_step) < 1e-9 * h ? s->factors_step : h;
}

sn_step_info sn_state_step(const sn_net *net, sn_state *s, double dt) {
    SN_ASSERT(net->integrator != SN_INTEGRATOR_QUASI_STATIC && dt > 0);
    if (net->integrator == SN_INTEGRATOR_IMPLICIT) {
        sn_implicit_advance(net, s, dt);
        return (sn_step_info){s->time, s->last_step, s->warnings};
    }
    const double h = choose_step(net, s, dt);
    if (h != s->factors_step) {
        sn_net_factors(net, h, s->factors);
        s->factors_step = h;
    }
    if (net->damping > 0) damp(net, s, h);
    sn_state_remember_grips(s);
    void *f = s->now.f;
    s->now.f = s->f_before;
    s->f_before = f;
    double sum, fastest;
    move_nodes(net, s, f, h, &sum, &fastest);
    if (sn_state_parts(s)) fastest = fastest_bound(net, s);
    move_prescribed(net, s, h);
    sn_state_move_grips(net, s, h);
    s->time += h;
    s->last_step = h;
    s->steps++;
    if (isfinite(sum)) find_forces(net, s, SN_MEMORY_ADVANCE);
    // forces overflow only where something has moved far within the step, or was put there
    const bool lost = !(h * fastest < lost_way * net->edge);
    const bool wild =
        h * fastest > wild_way * net->edge || net->factor_count + s->gripped_count > 0;
    if (!isfinite(sum) || lost || (wild && !forces_are_finite(net, s))) {
        s->broken = true;
        s->warnings++;
        sn_state_rest(net, s);
        return (sn_step_info){s->time, h, s->warnings};
    }
    sn_state_follow_frequency(net, s, h * fastest);
    return (sn_step_info){s->time, h, s->warnings};
}

//---- another net ---------------------------------------------------------------------------------

static bool same_body(const sn_net *a, const sn_net *b) {
    const size_t nodes = (size_t)a->nodes, corners = (size_t)a->cell_blocks * 4 * SN_BLOCK;
    return a->nodes == b->nodes && a->cell_blocks == b->cell_blocks && a->rung == b->rung &&
           a->volume_mode == b->volume_mode && a->integrator == b->integrator &&
           a->precision == b->precision && a->region_count == b->region_count &&
           a->spring_blocks == b->spring_blocks && a->tool_count == b->tool_count &&
           a->contact_count == b->contact_count && a->factor_count == b->factor_count &&
           a->fixed_count == b->fixed_count && a->part_count == b->part_count &&
           a->cuttable == b->cuttable &&
           memcmp(a->node_position, b->node_position, nodes * 3 * sizeof(double)) == 0 &&
           memcmp(a->cell_node, b->cell_node, corners * sizeof(int)) == 0;
}

static bool same_branches(const sn_net *a, const sn_net *b) {
    for (int r = 0; r < a->region_count; r++) {
        const sn_net_region *g = &a->region[r], *h = &b->region[r];
        if (g->tissue.branched != h->tissue.branched || g->splits != h->splits) return false;
        for (int p = 0; p < SN_PARTS; p++)
            if (sn_region_branches(g, (sn_part)p) != sn_region_branches(h, (sn_part)p))
                return false;
    }
    return true;
}

sn_status sn_state_move(const sn_net *from, const sn_net *to, sn_state *s) {
    if (!same_body(from, to) || to->integrator != SN_INTEGRATOR_EXPLICIT)
        return sn_fail(SN_E_DEFINITION,
                       "the state cannot go on with this net: mesh, model, precision, supports, "
                       "number of loads and tools must be the same, the integrator explicit");
    if (!same_branches(from, to)) {
        const size_t size = real_size(s->precision);
        void *store = sn_resize(s->store, to->store_size, size);
        if (!store && to->store_size > 0) return SN_E_MEMORY;
        s->store = store;
        if (store) memset(store, 0, to->store_size * size);
    }
    if (s->cut) sn_cut_restore(to, s->cut);
    change_suddenly(to, s);
    memcpy(s->mode, to->mode, (size_t)to->nodes * 3 * sizeof *s->mode);
    sn_state_find_frequency(to, s);
    return SN_OK;
}
