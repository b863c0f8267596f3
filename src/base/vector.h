// Vectors of three numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <math.h>

/// out = a - b
static inline void sub3(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

static inline double dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// out = a x b; out is neither a nor b.
static inline void cross3(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double norm3(const double a[3]) {
    return sqrt(dot3(a, a));
}

static inline double distance3(const double a[3], const double b[3]) {
    double d[3];
    sub3(a, b, d);
    return norm3(d);
}

/// out = A x, A row-major 3 x 3; out is not x.
static inline void times3(const double A[9], const double x[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = A[3 * i] * x[0] + A[3 * i + 1] * x[1] + A[3 * i + 2] * x[2];
}

/// out = A^T x; out is not x.
static inline void transpose_times3(const double A[9], const double x[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = A[i] * x[0] + A[3 + i] * x[1] + A[6 + i] * x[2];
}
