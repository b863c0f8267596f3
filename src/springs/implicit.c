// The implicit step: backward Euler or BDF2, by Newton's method.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (41); BDF2 with a variable step: Hairer, Norsett, Wanner, Solving Ordinary
// Differential Equations I (1993), section III.5.
//
// With h the step, w = h / (step before), g = (1 + 2w)/(1 + w) and l = w^2/(1 + w), BDF2 is
//     v1 = (g (u1 - u0) - l (u0 - u-1)) / h,   a1 = (g (v1 - v0) - l (v0 - v-1)) / h,
// second order and stable for w < 1 + sqrt(2). The first step, a step that grows by more, and all
// steps of scheme backward-euler take g = 1, l = 0. Sought is u1 with
//     M a1 = internal(u1) + weight + loads + contact - damping,
// the internal forces with the trial memory of the step, stress = alpha T + history: exact for
// stresses linear in time, and the tangent of the law is alpha times that of its instantaneous
// part. The viscous part wants the rate at the end of the step, (g dT - l w^-1 dT before) / h. What
// the store keeps of it is dT / h, so that it is a branch with gain g/h and decay -w/(1 + w).
//
// Damping by mass acts on the velocity relative to the rigid motion of the body (springs/drag.c);
// the tangent has its matrix too.
//
// Newton starts from u0 + h v0 + h^2/2 a0. The tangent of the last correction serves, across steps
// of one length too, until a correction leaves more than a fifth of the residual. Corrections are
// halved until the residual falls; a step that fails is halved, and steps then grow by two.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/steps.h"
#include "springs/vectors.h"

enum { NEWTON_MOST = 25, HALVINGS = 8, FEW_CORNERS = 8 };
// residual over the forces at work, where rounding allows no less
static const double settled = 1e-6;
static const double forcing = 1e-2; // of the linear solves, over the residual
static const double slow = 0.2;     // a correction that leaves more wants a new tangent
static const double most_growth = 2.4;
static const double least_part = 1.0 / 1024; // of the net's step: shorter ones are given up

struct sn_implicit {
    sn_tangent *tangent;
    bool fresh;          ///< the tangent may serve
    double tangent_step; ///< length, and g, that it was assembled for
    double tangent_g;
    double *history;
    sn_factors *trial;         ///< with the viscous rate at the end of the step (region_count)
    double *u0, *v0;           ///< quads: at the start of the step
    double *older_u, *older_v; ///< quads: a step before
    bool has_older;
    double *a;            ///< at the end of the step                (nodes x 3)
    double *before;       ///< quads: at the start of a correction
    double *b, *x;        ///< residual, correction                  (nodes x 3)
    double *drag, *drag0; ///< forces of damping by mass now, at the start (nodes x 3)
    double *rigid;        ///< M R                                (SN_RIGID x nodes x 3)
    sn_contact *touch;    ///< trial contact
    double g, l, h;       ///< of the step that is tried
    double longest;       ///< that a step may be after one was cut
    double scale, least, residual, smallest;
    int corrections, cuts;
    char reason[SN_TEXT_MAX];
};

//---- building ------------------------------------------------------------------------------------

double sn_net_implicit_step(const sn_net *net) {
    if (net->asked_step > 0) return net->asked_step;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    double extent = 0, speed = 0;
    for (int k = 0; k < 3 * net->nodes; k++) {
        low[k % 3] = fmin(low[k % 3], net->node_position[k]);
        high[k % 3] = fmax(high[k % 3], net->node_position[k]);
    }
    for (int d = 0; d < 3; d++) extent = fmax(extent, high[d] - low[d]);
    for (int r = 0; r < net->region_count; r++)
        speed = fmax(speed, sqrt(net->region[r].shear / net->region[r].density));
    double step = fmin(net->output_every, 0.05 * extent / speed), from = 0;
    for (int k = 0; k < FEW_CORNERS && from < net->until; k++) {
        double to = fmin(sn_net_next_corner(net, from), net->until);
        if (sn_net_changes(net, from, to)) step = fmin(step, 0.05 * (to - from));
        from = to;
    }
    return step;
}

void sn_implicit_destroy(sn_implicit *im) {
    if (!im) return;
    sn_tangent_destroy(im->tangent);
    void *all[] = {im->history, im->trial, im->u0, im->v0,   im->older_u, im->older_v, im->a,
                   im->before,  im->b,     im->x,  im->drag, im->drag0,   im->rigid,   im->touch};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_free(im);
}

sn_status sn_implicit_create(const sn_net *net, sn_implicit **implicit) {
    const size_t n = (size_t)net->nodes;
    sn_implicit *im = *implicit = sn_alloc(1, sizeof *im);
    if (!im) return SN_E_MEMORY;
    double **quads[] = {&im->u0, &im->v0, &im->older_u, &im->older_v, &im->before};
    double **vectors[] = {&im->a, &im->b, &im->x, &im->drag, &im->drag0};
    bool all = true;
    for (size_t k = 0; k < 5; k++) {
        *quads[k] = sn_alloc(4 * n, sizeof(double));
        *vectors[k] = sn_alloc(3 * n, sizeof(double));
        all = all && *quads[k] && *vectors[k];
    }
    im->history = sn_alloc(net->store_size, sizeof(double));
    im->trial = sn_alloc((size_t)net->region_count, sizeof *im->trial);
    im->rigid = sn_alloc(net->damping > 0 ? SN_RIGID * 3 * n : 0, sizeof(double));
    im->touch = sn_alloc((size_t)net->tool_count * (size_t)net->contact_count, sizeof *im->touch);
    if (!all || !im->history || !im->trial || !im->rigid || !im->touch) return SN_E_MEMORY;
    // rounding of the forces of a cell, 1e-16 of its stiffness times edge, must stay below this
    for (int r = 0; r < net->region_count; r++)
        im->least = fmax(im->least, 1e-5 * (net->region[r].shear + net->region[r].bulk));
    im->least *= net->edge * net->edge;
    sn_implicit_reset(net, im);
    return sn_tangent_create(net, &im->tangent);
}

void sn_implicit_reset(const sn_net *net, sn_implicit *im) {
    memset(im->a, 0, (size_t)net->nodes * 3 * sizeof *im->a);
    memset(im->drag, 0, (size_t)net->nodes * 3 * sizeof *im->drag);
    im->has_older = im->fresh = false;
    im->longest = INFINITY;
    im->reason[0] = '\0';
}

const double *sn_implicit_before(const sn_implicit *im) {
    return im->u0;
}
const char *sn_implicit_reason(const sn_implicit *im) {
    return im->reason;
}

void sn_implicit_forget(sn_implicit *im) {
    im->fresh = false;
}

void sn_implicit_restart(sn_implicit *im) {
    im->fresh = im->has_older = false;
}

int sn_implicit_pieces(const sn_net *net, sn_implicit *im, sn_piece *piece) {
    const size_t quads = (size_t)net->nodes * 4 * sizeof(double);
    const size_t vectors = (size_t)net->nodes * 3 * sizeof(double);
    const sn_piece all[SN_IMPLICIT_PIECES] = {{im->older_u, quads},
                                              {im->older_v, quads},
                                              {im->a, vectors},
                                              {im->drag, vectors},
                                              {&im->has_older, sizeof im->has_older},
                                              {&im->longest, sizeof im->longest},
                                              {&im->corrections, sizeof im->corrections},
                                              {&im->cuts, sizeof im->cuts},
                                              {im->reason, sizeof im->reason}};
    sn_implicit_forget(im);
    memcpy(piece, all, sizeof all);
    return SN_IMPLICIT_PIECES;
}

void sn_implicit_counts(const sn_implicit *im, int *corrections, int *cuts) {
    *corrections = im->corrections;
    *cuts = im->cuts;
}

//---- residual ------------------------------------------------------------------------------------

static bool is_fixed(const sn_net *net, int i, int d) {
    return net->fixed_bits[i] >> d & 1;
}

// velocities and accelerations that belong to the present u
static void move_along(const sn_net *net, sn_state *s, sn_implicit *im) {
    const double *u = s->u, over = 1.0 / im->h;
    double *v = s->v;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const int k = 4 * i + d;
            if (is_fixed(net, i, d)) continue; // by land_prescribed()
            double way = im->g * (u[k] - im->u0[k]) - im->l * (im->u0[k] - im->older_u[k]);
            v[k] = way * over;
            double gain = im->g * (v[k] - im->v0[k]) - im->l * (im->v0[k] - im->older_v[k]);
            im->a[3 * i + d] = gain * over;
        }
}

// loads and contact at s->u and s->time + h, into s->ext; their slopes into a tangent
static void find_ext(const sn_net *net, sn_state *s, sn_implicit *im, sn_tangent *tangent) {
    const double time = s->time + im->h;
    const sn_load_call load = {SN_DOUBLE, s->u, sn_state_parts(s), tangent};
    sn_net_clear_ext(net, load.parts, s->ext);
    for (int l = 0; l < net->load_count; l++)
        sn_net_add_load(net, l, sn_state_load_factor(net, s, net->load[l].name, time), &load,
                        s->ext);
    for (int t = 0; t < net->tool_count; t++) sn_net_tool_pose(net, s, t, time, &s->tool_pose[t]);
    const sn_contact_call call = {.precision = SN_DOUBLE,
                                  .u = s->u,
                                  .pose = s->tool_pose,
                                  .before = s->contact,
                                  .after = im->touch,
                                  .ext = s->ext,
                                  .tool_force = s->tool_force,
                                  .tool_torque = s->tool_torque,
                                  .parts = load.parts,
                                  .tangent = tangent ? sn_tangent_add_contact : NULL,
                                  .context = tangent};
    sn_net_contact(net, &call);
}

// all forces at s->u in now.f; b <- residual of the free directions, `residual` its norm
static void find_residual(const sn_net *net, sn_state *s, sn_implicit *im) {
    const sn_force_call call = {.precision = SN_DOUBLE,
                                .mode = SN_MEMORY_TRIAL,
                                .u = s->u,
                                .factors = im->trial,
                                .history = im->history,
                                .parts = sn_state_parts(s),
                                .out = &s->now,
                                .team = s->team};
    double *f = s->now.f, sum[4] = {0};
    move_along(net, s, im);
    sn_net_forces(net, &call);
    if (sn_net_loaded(net, call.parts) > 0) find_ext(net, s, im, NULL);
    sn_state_add_pushes(s);
    if (net->damping > 0) sn_implicit_drag(net, s, im->rigid, im->drag);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const int k = 3 * i + d;
            double ext = s->ext[k], all = f[4 * i + d] += ext;
            double inertia = net->mass[i] * im->a[k], weight = net->mass[i] * net->gravity[d];
            sum[0] += (ext + weight) * (ext + weight);
            if (is_fixed(net, i, d)) {
                sum[1] += all * all;
                im->b[k] = 0;
                continue;
            }
            im->b[k] = all + im->drag[k] - inertia;
            sum[2] += inertia * inertia;
            sum[3] += im->b[k] * im->b[k];
        }
    im->scale = fmax(sqrt(fmax(sum[0], fmax(sum[1], sum[2]))), im->least);
    im->residual = sqrt(sum[3]);
}

// a place that the laws can bear: springs may turn inside out, cells may not
static bool try_place(const sn_net *net, sn_state *s, sn_implicit *im) {
    if (net->cell_tiles.count > 0) {
        im->smallest = sn_net_smallest_ratio(net, sn_state_parts(s), s->u);
        if (!(im->smallest > 0)) return false;
    }
    find_residual(net, s, im);
    return isfinite(im->residual);
}

//---- corrections ---------------------------------------------------------------------------------

static void assemble(const sn_net *net, sn_state *s, sn_implicit *im) {
    const double c = im->g / im->h;
    const sn_tangent_call call = {.u = s->u,
                                  .factors = im->trial,
                                  .history = im->history,
                                  .pressure = s->now.pressure,
                                  .parts = sn_state_parts(s)};
    sn_tangent_assemble(net, im->tangent, &call);
    if (sn_net_loaded(net, call.parts) > 0) find_ext(net, s, im, im->tangent);
    sn_tangent_add_mass(net, im->tangent, c * (c + net->damping));
    int pieces = 1;
    const int *piece = sn_state_pieces(s, &pieces);
    sn_tangent_lower(im->tangent, net->damping > 0 ? SN_RIGID : 0, im->rigid, c * net->damping);
    sn_tangent_lower_pieces(im->tangent, piece, pieces);
    sn_tangent_prepare(net, im->tangent);
    im->fresh = true;
    im->tangent_step = im->h;
    im->tangent_g = im->g;
}

// u <- before + part x
static void place(const sn_net *net, sn_state *s, const sn_implicit *im, double part) {
    double *u = s->u;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) u[4 * i + d] = im->before[4 * i + d] + part * im->x[3 * i + d];
}

static void remember_place(const sn_net *net, const sn_state *s, sn_implicit *im) {
    memcpy(im->before, s->u, (size_t)net->nodes * 4 * sizeof *im->before);
}

// prescribed directions at the end of the step: place and velocity
static void land_prescribed(const sn_net *net, sn_state *s, const sn_implicit *im) {
    double *u = s->u, *v = s->v;
    for (int k = 0; k < net->fixed_count; k++) {
        const sn_net_fixed *fixed = &net->fixed[k];
        const int at = 4 * fixed->node + fixed->direction;
        u[at] = sn_state_prescribed(net, s, fixed, s->time + im->h, false);
        v[at] = (u[at] - im->u0[at]) / im->h;
    }
}

// the way of the last step goes on
static bool predict(const sn_net *net, sn_state *s, sn_implicit *im) {
    double *u = s->u;
    const double h = im->h;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const int k = 4 * i + d;
            if (!is_fixed(net, i, d))
                u[k] = im->u0[k] + h * (im->v0[k] + 0.5 * h * im->a[3 * i + d]);
        }
    land_prescribed(net, s, im);
    return try_place(net, s, im);
}

// from where all stand still: prescribed nodes go together with the linear answer of the others
static bool approach(const sn_net *net, sn_state *s, sn_implicit *im) {
    const size_t n = (size_t)net->nodes * 3;
    double *way = im->before; // as vector, until it is wanted
    memcpy(s->u, im->u0, (size_t)net->nodes * 4 * sizeof(double));
    if (!try_place(net, s, im)) return false;
    assemble(net, s, im);
    memset(way, 0, n * sizeof *way);
    for (int k = 0; k < net->fixed_count; k++) {
        const sn_net_fixed *fixed = &net->fixed[k];
        way[3 * fixed->node + fixed->direction] =
            sn_state_prescribed(net, s, fixed, s->time + im->h, false) -
            im->u0[4 * fixed->node + fixed->direction];
    }
    sn_tangent_multiply(net, im->tangent, way, im->x);
    for (size_t k = 0; k < n; k++)
        im->b[k] = is_fixed(net, (int)(k / 3), (int)(k % 3)) ? 0.0 : im->b[k] - im->x[k];
    memset(im->x, 0, n * sizeof *im->x);
    sn_tangent_solve(net, im->tangent, im->b, 1e-3 * sqrt(sn_dot(im->b, im->b, n)), im->x);
    for (size_t k = 0; k < n; k++) im->x[k] += way[k];
    remember_place(net, s, im);
    double part = 1.0;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        place(net, s, im, part);
        land_prescribed(net, s, im);
        if (try_place(net, s, im)) return true;
    }
    return false;
}

// one correction with line search; back to where it was better where it fails
static bool correct(const sn_net *net, sn_state *s, sn_implicit *im) {
    const double before = im->residual;
    memset(im->x, 0, (size_t)net->nodes * 3 * sizeof *im->x);
    const double goal = fmax(forcing * before, 0.2 * net->tolerance * im->scale);
    sn_tangent_solve(net, im->tangent, im->b, goal, im->x);
    remember_place(net, s, im);
    double part = 1.0;
    for (int k = 0; k < HALVINGS; k++, part *= 0.5) {
        place(net, s, im, part);
        if (try_place(net, s, im) && im->residual < (1.0 - 1e-3 * part) * before) return true;
    }
    place(net, s, im, 0.0);
    find_residual(net, s, im);
    return false;
}

// the place at the end of the step of im->h; u stays anywhere where it fails
static bool find_place(const sn_net *net, sn_state *s, sn_implicit *im) {
    if (im->tangent_step != im->h || im->tangent_g != im->g) im->fresh = false;
    im->residual = NAN;
    if (!predict(net, s, im) && !approach(net, s, im)) return false;
    for (int turn = 0; im->residual > net->tolerance * im->scale; turn++) {
        const double before = im->residual;
        const bool old = im->fresh;
        if (turn >= NEWTON_MOST) return im->residual < settled * im->scale;
        if (!old) assemble(net, s, im);
        im->corrections++;
        const bool good = correct(net, s, im);
        if (!good && !old) return im->residual < settled * im->scale;
        im->fresh = good && im->residual <= slow * before;
    }
    return true;
}

//---- steps ---------------------------------------------------------------------------------------

// lengths and factors of a step of h
static void begin(const sn_net *net, sn_state *s, sn_implicit *im, double h) {
    const double w = im->has_older ? h / s->last_step : 0.0;
    const bool two = net->scheme == SN_SCHEME_BDF2 && im->has_older && w <= most_growth;
    im->h = h;
    im->g = two ? (1.0 + 2.0 * w) / (1.0 + w) : 1.0;
    im->l = two ? w * w / (1.0 + w) : 0.0;
    if (h != s->factors_step) sn_net_factors(net, h, s->factors);
    s->factors_step = h;
    memcpy(im->trial, s->factors, (size_t)net->region_count * sizeof *im->trial);
    for (int n = 0; two && n < net->region_count * SN_PARTS; n++) {
        const int r = n / SN_PARTS, p = n % SN_PARTS;
        const sn_exponentials *memory = sn_region_memory(&net->region[r], (sn_part)p);
        const int k = memory->terms;
        sn_recursion *f = &im->trial[r].part[p];
        if (!(memory->viscous > 0)) continue;
        f->alpha += (im->g - 1.0) * f->gain[k];
        f->gain[k] *= im->g;
        f->decay[k] = -w / (1.0 + w);
    }
    if (net->store_size > 0) sn_net_history(net, im->trial, s->store, im->history);
}

// moves the store on; the forces of the step stay those of its balance
static void advance_memory(const sn_net *net, sn_state *s) {
    const sn_force_call call = {.precision = SN_DOUBLE,
                                .mode = SN_MEMORY_ADVANCE,
                                .u = s->u,
                                .factors = s->factors,
                                .store = s->store,
                                .parts = sn_state_parts(s),
                                .out = &s->probe,
                                .team = s->team};
    sn_net_forces(net, &call);
}

static void accept(const sn_net *net, sn_state *s, sn_implicit *im) {
    const size_t quads = (size_t)net->nodes * 4;
    const double *u = s->u, *v = s->v;
    if (net->store_size > 0) advance_memory(net, s);
    memcpy(s->contact, im->touch,
           (size_t)net->tool_count * (size_t)net->contact_count * sizeof *s->contact);
    for (int k = 0; k < net->fixed_count; k++) {
        const int at = 4 * net->fixed[k].node + net->fixed[k].direction;
        s->a_fixed[k] = s->steps == 0 ? 0.0 : (v[at] - im->v0[at]) / im->h;
    }
    for (size_t q = 0; net->damping > 0 && q < (size_t)net->nodes * 3; q++) {
        const size_t at = 4 * (q / 3) + q % 3;
        s->damped_energy -= 0.5 * (im->drag0[q] + im->drag[q]) * (u[at] - im->u0[at]);
    }
    memcpy(im->older_u, im->u0, quads * sizeof(double));
    memcpy(im->older_v, im->v0, quads * sizeof(double));
    im->has_older = true;
    im->longest *= 2.0;
    s->last_step = im->h;
    s->time += im->h;
    s->steps++;
}

// the numbers of a step that failed; older ones stay where all went well
static void explain(sn_state *s, sn_implicit *im) {
    snprintf(im->reason, sizeof im->reason,
             "a step of %.3g s at %.6g s found no balance: residual %.2g of the forces, smallest "
             "volume ratio of a cell %.3g",
             im->h, s->time, im->residual / im->scale, im->smallest);
}

void sn_implicit_advance(const sn_net *net, sn_state *s, double dt) {
    sn_implicit *im = s->implicit;
    const size_t quads = (size_t)net->nodes * 4;
    const double whole = fmin(fmin(dt, net->step), im->longest);
    double h = whole;
    memcpy(im->u0, s->u, quads * sizeof(double));
    memcpy(im->v0, s->v, quads * sizeof(double));
    memcpy(im->drag0, im->drag, (size_t)net->nodes * 3 * sizeof *im->drag);
    memcpy(s->f_before, s->now.f, quads * sizeof(double));
    im->smallest = 1.0;
    const double least = fmin(net->step * least_part, whole);
    for (; h >= least; h *= 0.5) {
        begin(net, s, im, h);
        if (find_place(net, s, im)) {
            if (h < whole) im->longest = h;
            accept(net, s, im);
            return;
        }
        explain(s, im);
        memcpy(s->u, im->u0, quads * sizeof(double));
        memcpy(s->v, im->v0, quads * sizeof(double));
        im->fresh = false;
        im->cuts++;
        s->warnings++;
    }
    s->broken = true;
    s->time += whole;
    char reason[SN_TEXT_MAX];
    memcpy(reason, im->reason, sizeof reason);
    sn_state_rest(net, s);
    memcpy(im->reason, reason, sizeof reason);
}
