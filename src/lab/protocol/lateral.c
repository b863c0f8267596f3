// Hereditary stress of a solid whose lateral stretches must be solved for.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); free sides, S22 = S33 = 0.
//
// Compressible:    S = H[S_d] + H[K (J - 1)] J C^-1, both lateral stretches unknown.
// Incompressible:  S = H[S_d] - p C^-1, J = 1; the sides differ (orthotropic laws), so one lateral
//                  stretch is unknown and the condition is that both sides give the same p.
// Where the memory is branched, S_d is two sums of channels, of the matrix and of the fibres, and
// each kind of channel has its own H.
//
// The recursion for a step is affine in the new stress, H[S] = a S_new + b, so a trial of the
// lateral stretches costs one evaluation of the law and touches no memory variable. Newton on the
// logarithms of the stretches with differences for the 2 x 2 matrix: they need no tangent of the
// volume term and the three points go to the law in one call. Steps are of second order; the
// callers refine.
#include <math.h>
#include <string.h>

#include "lab/protocol/path.h"

// S11, S22, S33 distortional, K (J - 1), and S11, S22, S33 of fibres with a memory of their own
enum { VOLUME = 3, FIBRES = 4, CHANNELS = 7 };
static const int newton_max = 40;
static const double difference = 1e-6; // of a logarithm: balances rounding against curvature

typedef struct puller {
    const sn_tissue *tissue;
    sn_tissue part[2]; // of the distortional stress
    int parts, channels;
    int memories; // 1, or SN_PARTS where branched
    const sn_exponentials *e;
    double bulk; // INFINITY: incompressible
    double time, stretch;
    double log_lateral[2];
    double value[CHANNELS];           // elastic, at the end of the last step
    double H[CHANNELS][SN_TERMS_MAX]; // shares of the exponentials
    double a[CHANNELS], b[CHANNELS];  // affine map of the step at hand
} puller;

// which of the memories acts on a channel
static int memory_of(const puller *p, int channel) {
    if (p->memories == 1 || channel < VOLUME) return SN_PART_DEVIATORIC;
    return channel == VOLUME ? SN_PART_VOLUMETRIC : SN_PART_FIBRE;
}

static int unknowns(const puller *p) {
    return isinf(p->bulk) ? 1 : 2;
}

// lateral stretches of a trial
static void lateral(const puller *p, double stretch, const double *y, double out[2]) {
    out[0] = exp(y[0]);
    out[1] = isinf(p->bulk) ? 1.0 / (stretch * out[0]) : exp(y[1]);
}

// elastic channels and total stresses at n trials; residual (2 x n), axial nominal stress (n)
static void trials(const puller *p, double stretch, int n, double y[][2], double value[][CHANNELS],
                   double residual[][2], double *nominal) {
    double E[6 * 3] = {0}, S[2][6 * 3];
    SN_ASSERT(n <= 3);
    for (int i = 0; i < n; ++i) {
        double side[2];
        lateral(p, stretch, y[i], side);
        E[i] = 0.5 * (stretch * stretch - 1.0);
        E[n + i] = 0.5 * (side[0] * side[0] - 1.0);
        E[2 * n + i] = 0.5 * (side[1] * side[1] - 1.0);
    }
    for (int k = 0; k < p->parts; ++k)
        sn_law_solid(p->tissue->law, p->part[k].value, p->tissue->terms, n, E, NULL, S[k], NULL);
    for (int i = 0; i < n; ++i) {
        double side[2], total[CHANNELS] = {0.0};
        lateral(p, stretch, y[i], side);
        double J = stretch * side[0] * side[1];
        for (int c = 0; c < 3; ++c) {
            value[i][c] = S[0][c * n + i];
            if (p->parts > 1) value[i][FIBRES + c] = S[1][c * n + i];
        }
        value[i][VOLUME] = isinf(p->bulk) ? 0.0 : sn_volume_stress(p->bulk, J);
        for (int c = 0; c < p->channels; ++c) total[c] = p->a[c] * value[i][c] + p->b[c];
        for (int c = FIBRES; c < p->channels; ++c) total[c - FIBRES] += total[c];
        double s22 = total[1] * side[0] * side[0], s33 = total[2] * side[1] * side[1];
        if (isinf(p->bulk)) {
            residual[i][0] = s22 - s33;
            residual[i][1] = 0.0;
            nominal[i] = stretch * total[0] - s33 / stretch;
        } else {
            residual[i][0] = s22 + total[VOLUME] * J;
            residual[i][1] = s33 + total[VOLUME] * J;
            nominal[i] = stretch * total[0] + total[VOLUME] * J / stretch;
        }
    }
}

// Newton's change of the unknowns from residuals at a point and at a difference in each unknown
static bool newton_change(int n, double residual[][2], double change[2]) {
    double A[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) A[i][j] = (residual[j + 1][i] - residual[0][i]) / difference;
    double det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
    change[0] = -(A[1][1] * residual[0][0] - A[0][1] * residual[0][1]) / det;
    change[1] = -(A[0][0] * residual[0][1] - A[1][0] * residual[0][0]) / det;
    double size = fmax(fabs(change[0]), fabs(change[1]));
    if (!isfinite(size)) return false;
    double limit = 0.1; // a tenth of the stretch a go: the law stays in its domain
    if (size > limit)
        for (int i = 0; i < 2; ++i) change[i] *= limit / size;
    return true;
}

// solves the sides at `stretch`; leaves elastic values in `value` and the nominal stress in
// *nominal
static sn_status solve_sides(puller *p, double stretch, double value[CHANNELS], double *nominal) {
    int n = unknowns(p);
    double y[3][2], values[3][CHANNELS], residual[3][2], stress[3], change[2] = {0.0, 0.0};
    memcpy(y[0], p->log_lateral, sizeof y[0]);
    for (int iteration = 0; iteration < newton_max; ++iteration) {
        for (int j = 0; j < n; ++j) {
            memcpy(y[j + 1], y[0], sizeof y[0]);
            y[j + 1][j] += difference;
        }
        trials(p, stretch, n + 1, y, values, residual, stress);
        if (!newton_change(n, residual, change)) break;
        double size = fmax(fabs(change[0]), fabs(change[1]));
        for (int j = 0; j < n; ++j) y[0][j] += change[j];
        if (size > 1e-11) continue; // the matrix is good to 1e-6: what remains is 1e-17
        trials(p, stretch, 1, y, values, residual, stress);
        memcpy(p->log_lateral, y[0], sizeof y[0]);
        memcpy(value, values[0], (size_t)p->channels * sizeof *value);
        *nominal = stress[0];
        return SN_OK;
    }
    return sn_fail(SN_E_SOLVER,
                   "law %s: the free sides at stretch %g, %g s have no equilibrium near lateral "
                   "stretch %g (last change %g): check the constants",
                   p->tissue->law->name, stretch, p->time, exp(p->log_lateral[0]), change[0]);
}

static sn_status start(puller *p, const sn_path *path, double *nominal) {
    double guess = -0.5 * log(path->stretch[0]), value[CHANNELS];
    p->time = path->time[0];
    p->stretch = path->stretch[0];
    p->log_lateral[0] = p->log_lateral[1] = guess;
    for (int c = 0; c < p->channels; ++c) p->a[c] = 1.0; // a step from rest: G(0) = 1
    SN_TRY(solve_sides(p, p->stretch, value, nominal));
    for (int c = 0; c < p->channels; ++c) {
        p->value[c] = value[c];
        const sn_exponentials *e = &p->e[memory_of(p, c)];
        for (int i = 0; i < e->terms; ++i) p->H[c][i] = e->g[i] * value[c];
    }
    return SN_OK;
}

static sn_status step(puller *p, double time, double stretch, double *nominal) {
    double decay[SN_PARTS][SN_TERMS_MAX], gain[SN_PARTS][SN_TERMS_MAX], value[CHANNELS];
    double h = time - p->time;
    for (int m = 0; m < p->memories; ++m) sn_exponentials_factors(&p->e[m], h, decay[m], gain[m]);
    for (int c = 0; c < p->channels; ++c) {
        int m = memory_of(p, c);
        const sn_exponentials *e = &p->e[m];
        const double *d = decay[m], *g = gain[m];
        double viscous = e->viscous / h;
        p->a[c] = e->g_inf + viscous;
        p->b[c] = -viscous * p->value[c];
        for (int i = 0; i < e->terms; ++i) {
            p->a[c] += g[i];
            p->b[c] += d[i] * p->H[c][i] - g[i] * p->value[c];
        }
    }
    double guess = log(stretch / p->stretch);
    for (int j = 0; j < 2; ++j) p->log_lateral[j] -= 0.5 * guess;
    p->time = time;
    SN_TRY(solve_sides(p, stretch, value, nominal));
    for (int c = 0; c < p->channels; ++c) {
        int m = memory_of(p, c);
        const double *d = decay[m], *g = gain[m];
        for (int i = 0; i < p->e[m].terms; ++i)
            p->H[c][i] = d[i] * p->H[c][i] + g[i] * (value[c] - p->value[c]);
        p->value[c] = value[c];
    }
    p->stretch = stretch;
    return SN_OK;
}

// Parts of the interval after instant k, and how they are graded: part j of n ends at the fraction
// (exp(alpha j/n) - 1)/(exp(alpha) - 1) of it. A hold after a fast ramp wants its steps early, and
// a smooth grading keeps the even expansion of the error.
static int parts_of(const sn_path *path, int k, int level, double *alpha) {
    double change = fabs(path->stretch[k + 1] - path->stretch[k]);
    double duration = path->time[k + 1] - path->time[k];
    double before = k > 0 ? path->time[k] - path->time[k - 1] : duration;
    *alpha = log1p(duration / before) - log(2.0);
    if (!(*alpha > 0.1)) *alpha = 0.0;
    double parts = path->range > 0.0 ? ceil(12.0 * change / path->range) : 1.0;
    return level * (int)fmax(1.0 + ceil(*alpha), parts);
}

sn_status sn_path_stress_lateral(const sn_path *path, const sn_tissue *tissue,
                                 const sn_exponentials *e, int level, double *stress) {
    sn_moduli moduli;
    tissue->law->moduli(tissue->value, tissue->terms, &moduli);
    puller p = {.tissue = tissue, .e = e, .bulk = moduli.bulk};
    p.parts = sn_tissue_split(tissue, p.part);
    p.channels = p.parts > 1 ? CHANNELS : FIBRES;
    p.memories = tissue->branched ? SN_PARTS : 1;
    double *at_instant = sn_alloc((size_t)path->count, sizeof *at_instant);
    if (!at_instant) return SN_E_MEMORY;
    sn_status status = start(&p, path, &at_instant[0]);
    for (int k = 0; status == SN_OK && k + 1 < path->count; ++k) {
        double alpha, t0 = path->time[k], l0 = path->stretch[k];
        int parts = parts_of(path, k, level, &alpha);
        for (int j = 1; status == SN_OK && j <= parts; ++j) {
            double part = (double)j / parts;
            double u = alpha > 0.0 ? expm1(alpha * part) / expm1(alpha) : part;
            if (j == parts) u = 1.0;
            double t = j == parts ? path->time[k + 1] : t0 + u * (path->time[k + 1] - t0);
            status = step(&p, t, l0 + u * (path->stretch[k + 1] - l0), &at_instant[k + 1]);
        }
    }
    for (int r = 0; status == SN_OK && r < path->records; ++r)
        stress[r] = path->record[r] < 0 ? 0.0 : at_instant[path->record[r]];
    sn_free(at_instant);
    return status;
}
