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
