// Independent paths for the laboratory's tests: quadrature of the hereditary integral, noise,
// curves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"
#include "sinew/lab.h"

/// df/dstretch of an elastic channel.
typedef double oracle_slope(double stretch, const double *constants);

/// int_0^t G(t - s) f'(L(s)) L'(s) ds by Gauss-Legendre, 6 points on 240 pieces of every straight
/// line of the motion, graded by cubes towards s = t, where G changes fastest. Knows nothing of
/// exponentials and recursions.
static inline double oracle_hereditary(const sn_history *h, const sn_memory *memory, double t,
                                       oracle_slope *slope, const double *constants) {
    static const double x[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
    static const double w[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
    enum { PIECES = 240 };
    double sum = 0.0;
    for (int k = 0; k + 1 < h->count; ++k) {
        double a = h->time[k], b = fmin(h->time[k + 1], t), l0 = h->value[k];
        double rate = (h->value[k + 1] - l0) / (h->time[k + 1] - a);
        if (b <= a || rate == 0.0) continue;
        for (int i = 0; i < PIECES; ++i) {
            double e0 = b - (b - a) * pow(1.0 - (double)i / PIECES, 3.0);
            double e1 = b - (b - a) * pow(1.0 - (double)(i + 1) / PIECES, 3.0);
            double m = 0.5 * (e0 + e1), half = 0.5 * (e1 - e0);
            for (int q = 0; q < 6; ++q) {
                double s = m + half * (q < 3 ? x[q] : -x[q - 3]);
                sum += w[q % 3] * half * rate * sn_memory_relaxation(memory, t - s) *
                       slope(l0 + rate * (s - a), constants);
            }
        }
    }
    return sum;
}

/// A fit of `tissue`'s law and memory to curves.
static inline sn_fit_def oracle_fit(const sn_tissue *tissue, const sn_curve *curve, int count) {
    sn_fit_def def = sn_fit_def_default();
    def.curve = curve;
    def.curve_count = count;
    def.law = tissue->law;
    def.memory = tissue->memory.law->param_count > 0 ? tissue->memory.law : NULL;
    def.terms = tissue->memory.terms;
    return def;
}

/// A fitted constant by its name; the test fails where there is none.
static inline const sn_fit_param *oracle_param(const sn_fit_result *r, const char *name) {
    for (int k = 0; k < r->param_count; ++k)
        if (strcmp(r->param[k].name, name) == 0) return &r->param[k];
    fail_msg("no parameter %s", name);
    return NULL;
}

/// Brute-force convolution in equal steps, for stresses whose history must be solved for: the
/// integral of a channel is the sum of its increments, each times the mean of G over the times that
/// it lies back. Second order in the step. Use: at every step `history`, solve for the new values
/// with H = history + now (value - before), `keep`.
typedef struct oracle_march {
    int channels, steps, done;
    double *mean;      // of G over [k h, (k + 1) h]                     (steps)
    double *increment; //                                                (steps x channels)
    double history[4], before[4], now;
} oracle_march;

static inline double oracle_one(double x, const double *constants) {
    (void)x, (void)constants;
    return 1.0;
}

static inline oracle_march oracle_march_start(const sn_memory *memory, double seconds, int steps,
                                              int channels) {
    oracle_march m = {.channels = channels, .steps = steps};
    double h = seconds / steps, last = 0.0;
    m.mean = sn_alloc((size_t)(steps * (1 + channels)), sizeof *m.mean);
    assert_non_null(m.mean);
    m.increment = m.mean + steps;
    for (int k = 0; k < steps; ++k) { // int_0^t G is the integral of a motion at unit speed
        const double knots[] = {0.0, (k + 1) * h};
        sn_history *ramp;
        CHECK_OK(sn_history_create(1, 2, knots, knots, &ramp));
        double sum = oracle_hereditary(ramp, memory, knots[1], oracle_one, NULL);
        sn_history_destroy(ramp);
        m.mean[k] = (sum - last) / h;
        last = sum;
    }
    m.now = m.mean[0];
    return m;
}

static inline void oracle_march_history(oracle_march *m) {
    for (int c = 0; c < m->channels; ++c) m->history[c] = 0.0;
    for (int k = 0; k < m->done; ++k)
        for (int c = 0; c < m->channels; ++c)
            m->history[c] += m->mean[m->done - k] * m->increment[k * m->channels + c];
}

static inline double oracle_march_total(const oracle_march *m, int c, double value) {
    return m->history[c] + m->now * (value - m->before[c]);
}

static inline void oracle_march_keep(oracle_march *m, const double *value) {
    for (int c = 0; c < m->channels; ++c) {
        m->increment[m->done * m->channels + c] = value[c] - m->before[c];
        m->before[c] = value[c];
    }
    ++m->done;
}

/// Channels of a compressible neo-Hookean solid: S11, S22, S33 distortional, K (J - 1).
static inline void oracle_neo_hookean(double mu, double K, const double l[3], double value[4]) {
    double J = l[0] * l[1] * l[2], i1 = l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
    for (int i = 0; i < 3; ++i)
        value[i] = mu * pow(J, -2.0 / 3.0) * (1.0 - i1 / 3.0 / (l[i] * l[i]));
    value[3] = K * (J - 1.0);
}

/// Nominal stress along axis i at trial stretches of it.
static inline double oracle_neo_hookean_stress(const oracle_march *m, double mu, double K,
                                               const double l[3], int i) {
    double value[4];
    oracle_neo_hookean(mu, K, l, value);
    return l[i] * oracle_march_total(m, i, value[i]) +
           oracle_march_total(m, 3, value[3]) * l[0] * l[1] * l[2] / l[i];
}

/// Standard normal deviates (Box-Muller).
static inline double oracle_normal(uint64_t *seed) {
    double u = check_random(seed, 1e-12, 1.0), v = check_random(seed, 0.0, 1.0);
    return sqrt(-2.0 * log(u)) * cos(6.283185307179586 * v);
}

static inline sn_tissue oracle_tissue(const char *law, const double *value, int count) {
    sn_tissue tissue = sn_tissue_default();
    tissue.law = sn_law_find(law);
    assert_non_null(tissue.law);
    assert_true(count <= tissue.law->param_count);
    memcpy(tissue.value, value, (size_t)count * sizeof *value);
    tissue.memory = sn_memory_none();
    return tissue;
}

/// A memory of `terms` exponentials: all g, then all tau. Other laws: terms 0, values as in the
/// table.
static inline sn_memory oracle_memory(const char *law, int terms, const double *value, int count) {
    sn_memory memory = {.law = sn_memory_law_find(law), .terms = terms};
    assert_non_null(memory.law);
    memcpy(memory.value, value, (size_t)count * sizeof *value);
    return memory;
}

/// An owned curve of n rows.
static inline sn_curve oracle_curve(const char *name, int n, const double *time,
                                    const double *stretch, const double *stress) {
    sn_curve c = {.count = n};
    snprintf(c.name, sizeof c.name, "%s", name);
    c.stretch = sn_alloc((size_t)n, sizeof *c.stretch);
    c.stress = sn_alloc((size_t)n, sizeof *c.stress);
    memcpy(c.stretch, stretch, (size_t)n * sizeof *stretch);
    memcpy(c.stress, stress, (size_t)n * sizeof *stress);
    if (time) {
        c.time = sn_alloc((size_t)n, sizeof *c.time);
        memcpy(c.time, time, (size_t)n * sizeof *time);
    }
    return c;
}

/// A curve of the virtual machine: 1 -> 1.15 in `ramp` seconds, held for 300 s (relaxation) or
/// cycled five times.
static inline sn_curve oracle_test(const sn_tissue *tissue, sn_protocol_kind kind, double ramp,
                                   int points) {
    sn_protocol protocol = sn_protocol_default(kind);
    sn_record *record = NULL;
    sn_curve curve = {0};
    protocol.stretch = 1.15;
    protocol.ramp = ramp;
    protocol.hold = 300.0;
    protocol.cycles = 5;
    protocol.points = points;
    CHECK_OK(sn_lab_test(tissue, &protocol, &record));
    CHECK_OK(sn_curve_from_record(record, &curve));
    sn_record_destroy(record);
    return curve;
}

static inline double oracle_peak(const sn_curve *curve) {
    double peak = 0.0;
    for (int i = 0; i < curve->count; ++i) peak = fmax(peak, fabs(curve->stress[i]));
    return peak;
}

/// Adds normal noise of a given size, Pa, to every row.
static inline void oracle_noise(sn_curve *curve, double size, uint64_t *seed) {
    for (int i = 0; i < curve->count; ++i) curve->stress[i] += size * oracle_normal(seed);
}
