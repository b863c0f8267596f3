// Memories for the tests of this folder, and quadrature of their own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"

#include "sinew/relax.h"

/// A memory with up to six values; a list takes `terms` of them.
static inline sn_memory sample_memory(const char *name, int terms, const double *value, int count) {
    sn_memory memory = {.law = sn_memory_law_find(name), .terms = terms};
    assert_non_null(memory.law);
    memcpy(memory.value, value, (size_t)count * sizeof *value);
    CHECK_OK(sn_memory_check(&memory));
    return memory;
}
#define SAMPLE(name, terms, ...)                                                                   \
    sample_memory(name, terms, (double[]){__VA_ARGS__},                                            \
                  (int)(sizeof(double[]){__VA_ARGS__} / sizeof(double)))

enum { SAMPLE_COUNT = 7 };

/// One memory of every law, and two more spectra. Odd values, so that no error hides behind a
/// round number.
static inline sn_memory sample_at(int index) {
    switch (index) {
    case 0: return sn_memory_none();
    case 1: return SAMPLE("maxwell", 0, 0.7321);
    case 2: return SAMPLE("voigt", 0, 0.2917);
    case 3: return SAMPLE("kelvin", 0, 0.4133, 1.9371);
    case 4: return SAMPLE("prony", 3, 0.1173, 0.2891, 0.3307, 0.0213, 0.5119, 7.731);
    case 5: return SAMPLE("fung-spectrum", 0, 0.1, 0.01, 100.0);
    default: return SAMPLE("fung-spectrum", 0, 1.3719, 0.3137, 0.9173);
    }
}

/// Integral of f over [a, b] by Gauss-Legendre of order 16 (8 nodes).
static inline double sample_gauss(double (*f)(const void *, double), const void *context, double a,
                                  double b) {
    static const double x[4] = {0.1834346424956498049, 0.5255324099163289858, 0.7966664774136267396,
                                0.9602898564975362317};
    static const double w[4] = {0.3626837833783619830, 0.3137066458778872873, 0.2223810344533744705,
                                0.1012285362903762591};
    double middle = 0.5 * (a + b), half = 0.5 * (b - a), sum = 0;
    for (int i = 0; i < 4; i++)
        sum += w[i] * (f(context, middle - half * x[i]) + f(context, middle + half * x[i]));
    return half * sum;
}
