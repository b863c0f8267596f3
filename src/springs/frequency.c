// The highest frequency of a net, which rules the explicit step.
// SPDX-License-Identifier: Apache-2.0
//
// The operator is A = M^-1/2 K M^-1/2 on the free directions, K the derivative of the true force
// function (directional differences). Lanczos' method finds its highest eigenvalue from below; it
// is power iteration that forgets nothing, and needs several times fewer steps. A few steps are
// followed by a restart from the best vector. The
// safety factor of the step, 0.9, is 0.81 in the eigenvalue; tests hold the step at rest against
// thousands of power iterations.
#include <math.h>
#include <string.h>

#include "springs/steps.h"
#include "springs/vectors.h"

static void evaluate(const sn_net *net, const sn_frequency_call *call, const void *u, bool bare) {
    sn_force_call force = {.precision = call->precision,
                           .mode = SN_MEMORY_OFF,
                           .u = u,
                           .parts = call->parts,
                           .upright = call->upright,
                           .bare = bare,
                           .out = call->scratch,
                           .team = call->team};
    sn_net_forces(net, &force);
}

// trial <- u + tiny M^-1/2 y
static void place_trial(const sn_net *net, const sn_frequency_call *call, double tiny,
                        const double *y) {
    const double *root = net->root_inverse_mass;
    if (call->precision == SN_SINGLE) {
        const float *u = call->u;
        float *trial = call->trial;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++)
                trial[4 * i + d] = u[4 * i + d] + (float)(tiny * y[3 * i + d] * root[3 * i + d]);
    } else {
        const double *u = call->u;
        double *trial = call->trial;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++)
                trial[4 * i + d] = u[4 * i + d] + tiny * y[3 * i + d] * root[3 * i + d];
    }
}

// out <- factor M^-1/2 (base - f)
static void take_force(const sn_net *net, const sn_frequency_call *call, double factor,
                       const double *base, double *out) {
    const double *root = net->root_inverse_mass;
    if (call->precision == SN_SINGLE) {
        const float *f = call->scratch->f;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++)
                out[3 * i + d] =
                    factor * root[3 * i + d] * (base[3 * i + d] - (double)f[4 * i + d]);
    } else {
        const double *f = call->scratch->f;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++)
                out[3 * i + d] = factor * root[3 * i + d] * (base[3 * i + d] - f[4 * i + d]);
    }
}

// out += factor M^-1/2 f
static void add_force(const sn_net *net, const sn_frequency_call *call, double factor,
                      double *out) {
    for (int k = 0; k < 3 * net->nodes; k++)
        out[k] +=
            factor * net->root_inverse_mass[k] *
            sn_real_at(call->precision, call->scratch->f, 4 * (size_t)(k / 3) + (size_t)(k % 3));
}

// The largest difference of a displacement, of an edge, is the root of the rounding in either
// precision, or more: what it leaves is far below the safety of the step.
static void try_vector(const sn_net *net, const sn_frequency_call *call, const double *y,
                       sn_lanczos *l) {
    double most = 0.0;
    for (int k = 0; k < 3 * net->nodes; k++) {
        const double size = fabs(y[k]) * net->root_inverse_mass[k];
        most = size > most ? size : most;
    }
    l->tiny = (call->precision == SN_SINGLE ? 1e-3 : 1e-6) * net->edge / most;
    place_trial(net, call, l->tiny, y);
}

// out <- A y, from the forces at the trial place
static void take_product(const sn_net *net, const sn_frequency_call *call, const double *base,
                         const double *y, double tiny, double *out) {
    take_force(net, call, 1.0 / tiny, base, out);
    if (!call->taut) return;
    // fibres that are slack this way are taut that way
    place_trial(net, call, -tiny, y);
    for (int bare = 0; bare < 2; bare++) {
        evaluate(net, call, call->trial, bare);
        add_force(net, call, (bare ? -1.0 : 1.0) / tiny, out);
    }
}

// largest eigenvalue of a small symmetric tridiagonal matrix and its vector, by power iteration
static double small_eigenvalue(const double *diagonal, const double *beside, int n, double *x) {
    double value = 0.0, shift = 0.0;
    for (int i = 0; i < n; i++) shift = fmax(shift, fabs(diagonal[i]));
    for (int i = 0; i < n; i++) x[i] = 1.0;
    for (int turn = 0; turn < 400; turn++) {
        double y[SN_LANCZOS_MAX], norm = 0.0;
        for (int i = 0; i < n; i++) {
            y[i] = (diagonal[i] + 0.25 * shift) * x[i];
            if (i > 0) y[i] += beside[i - 1] * x[i - 1];
            if (i + 1 < n) y[i] += beside[i] * x[i + 1];
            norm += y[i] * y[i];
        }
        norm = sqrt(norm);
        if (!(norm > 0)) return 0.0;
        value = norm - 0.25 * shift;
        for (int i = 0; i < n; i++) x[i] = y[i] / norm;
    }
    return value;
}

// the basis is followed by the force at u
static double *base_of(const sn_net *net, const sn_frequency_call *call) {
    return call->basis + (size_t)call->steps * (size_t)net->nodes * 3;
}

bool sn_lanczos_begin(const sn_net *net, const sn_frequency_call *call, sn_lanczos *l) {
    const size_t n = (size_t)net->nodes * 3;
    double *base = base_of(net, call);
    *l = (sn_lanczos){0};
    for (size_t k = 0; k < n; k++) {
        base[k] = sn_real_at(call->precision, call->scratch->f, 4 * (k / 3) + k % 3);
        call->basis[k] = net->root_inverse_mass[k] > 0 ? call->mode[k] : 0.0;
    }
    const double norm = sqrt(sn_dot(call->basis, call->basis, n));
    if (!(norm > 0) || !isfinite(norm)) return false;
    for (size_t k = 0; k < n; k++) call->basis[k] /= norm;
    try_vector(net, call, call->basis, l);
    return true;
}

bool sn_lanczos_go_on(const sn_net *net, const sn_frequency_call *call, sn_lanczos *l) {
    const size_t n = (size_t)net->nodes * 3;
    const int at = l->steps++;
    const bool last = l->steps == call->steps;
    const double *q = call->basis + (size_t)at * n;
    double *w = last ? call->mode : call->basis + (size_t)(at + 1) * n;
    take_product(net, call, base_of(net, call), q, l->tiny, w);
    l->diagonal[at] = sn_dot(q, w, n);
    if (last) return false;
    for (int j = 0; j <= at; j++) { // against all: rounding would bring copies back
        const double *p = call->basis + (size_t)j * n;
        const double along = sn_dot(p, w, n);
        for (size_t k = 0; k < n; k++) w[k] -= along * p[k];
    }
    l->beside[at] = sqrt(sn_dot(w, w, n));
    if (!(l->beside[at] > 1e-9 * fabs(l->diagonal[0]))) return false;
    for (size_t k = 0; k < n; k++) w[k] /= l->beside[at];
    try_vector(net, call, w, l);
    return true;
}

double sn_lanczos_end(const sn_net *net, const sn_frequency_call *call, sn_lanczos *l) {
    const size_t n = (size_t)net->nodes * 3;
    double x[SN_LANCZOS_MAX];
    const double value = small_eigenvalue(l->diagonal, l->beside, l->steps, x);
    for (size_t k = 0; k < n; k++) call->mode[k] = x[0] * call->basis[k];
    for (int j = 1; j < l->steps; j++)
        for (size_t k = 0; k < n; k++) call->mode[k] += x[j] * call->basis[(size_t)j * n + k];
    if (call->parts) sn_lanczos_spread(net, call, l);
    return value;
}

double sn_net_frequency(const sn_net *net, const sn_frequency_call *call) {
    sn_lanczos l;
    evaluate(net, call, call->u, false);
    bool more = sn_lanczos_begin(net, call, &l);
    if (!more) return 0.0;
    while (more) {
        evaluate(net, call, call->trial, false);
        more = sn_lanczos_go_on(net, call, &l);
    }
    return sn_lanczos_end(net, call, &l);
}

double sn_net_stable_step(const sn_net *net, double omega2) {
    double viscous = 0.0;
    for (int r = 0; r < net->region_count; r++)
        for (int p = 0; p < SN_PARTS; p++)
            viscous = fmax(viscous, sn_region_memory(&net->region[r], (sn_part)p)->viscous);
    if (!(omega2 > 0)) return INFINITY;
    // symplectic Euler with a viscous force of the velocity half a step ago
    double omega = sqrt(omega2), xi = 0.5 * viscous * omega;
    return 2.0 / (omega * (sqrt(1.0 + xi * xi) + xi));
}

// restarts until the eigenvalue settles
static double search(const sn_net *net, const sn_frequency_call *call) {
    double omega2 = 0.0;
    uint64_t noise = SN_NOISE_START;
    for (int k = 0; k < 3 * net->nodes; k++) call->mode[k] = sn_noise(&noise);
    for (int turn = 0; turn < 10; turn++) {
        double before = omega2;
        omega2 = sn_net_frequency(net, call);
        if (!(fabs(omega2 - before) > 2e-3 * omega2)) break;
    }
    return omega2;
}

sn_status sn_net_find_step(sn_net *net) {
    const size_t nodes = (size_t)net->nodes;
    sn_scratch scratch = {0};
    double *u = sn_alloc(nodes * 4, sizeof *u), *trial = sn_alloc(nodes * 4, sizeof *trial);
    double *basis = sn_alloc(nodes * 3 * (SN_LANCZOS_MAX + 1), sizeof *basis);
    net->mode = sn_alloc(nodes * 3, sizeof *net->mode);
    sn_status status = sn_scratch_create(net, SN_DOUBLE, &scratch);
    if (!u || !trial || !net->mode || !basis) status = SN_E_MEMORY;
    if (status == SN_OK) {
        const sn_frequency_call call = {.precision = SN_DOUBLE,
                                        .u = u,
                                        .trial = trial,
                                        .mode = net->mode,
                                        .basis = basis,
                                        .steps = SN_LANCZOS_MAX,
                                        .scratch = &scratch,
                                        .taut = sn_net_has_fibres(net)};
        net->omega2 = search(net, &call);
        double longest = sn_net_step_safety(net) * sn_net_stable_step(net, net->omega2);
        net->step = fmin(longest, net->output_every); // nothing free to move has no limit
        if (net->asked_step > 0) net->step = fmin(net->asked_step, net->step);
    }
    sn_free(u);
    sn_free(trial);
    sn_free(basis);
    sn_scratch_destroy(&scratch);
    return status;
}
