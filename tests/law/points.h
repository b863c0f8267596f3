// Random constants and strains for the tests of laws, and a law at one point.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"
#include "sinew/law.h"

enum { POINTS_VALUES_MAX = 32 };

// index pairs of the six components, and the place of (i, j)
static const int comp_first[6] = {0, 1, 2, 0, 1, 2}, comp_second[6] = {0, 1, 2, 1, 2, 0};

static inline int upper(int i, int j) {
    return i <= j ? i * (11 - i) / 2 + j : j * (11 - j) / 2 + i;
}

static inline void tensor_of(const double a[6], double A[3][3]) {
    for (int k = 0; k < 6; k++)
        A[comp_first[k]][comp_second[k]] = A[comp_second[k]][comp_first[k]] = a[k];
}
static inline void components_of(double A[3][3], double a[6]) {
    for (int k = 0; k < 6; k++) a[k] = A[comp_first[k]][comp_second[k]];
}
static inline double det3(double A[3][3]) {
    return A[0][0] * (A[1][1] * A[2][2] - A[1][2] * A[2][1]) -
           A[0][1] * (A[1][0] * A[2][2] - A[1][2] * A[2][0]) +
           A[0][2] * (A[1][0] * A[2][1] - A[1][1] * A[2][0]);
}
/// A:B
static inline double dot6(const double a[6], const double b[6]) {
    double sum = 0;
    for (int k = 0; k < 6; k++) sum += (k < 3 ? 1 : 2) * a[k] * b[k];
    return sum;
}
static inline double norm6(const double a[6]) {
    return sqrt(dot6(a, a));
}

/// Constants in the range of the table, as tissues have them: moduli from 100 Pa to 1 MPa,
/// exponents from 0.1 to 20, ratios anywhere. One bulk modulus in four is infinite.
static inline void random_values(const sn_law *law, uint64_t *seed, double *value) {
    for (int k = 0; k < law->param_count; k++) {
        const sn_param *p = &law->params[k];
        assert_int_equal(sn_param_length(p, 1), 1);
        if (strcmp(p->unit, "Pa") == 0)
            value[k] = exp(check_random(seed, log(1e2), log(1e6)));
        else if (p->max - p->min < 2)
            value[k] = check_random(seed, p->min + 1e-3, p->max - 1e-3);
        else
            value[k] = exp(check_random(seed, log(0.1), log(20)));
        if (p->infinity && check_random(seed, 0, 1) < 0.25) value[k] = (double)INFINITY;
    }
    CHECK_OK(sn_law_check(law, value, 0));
}

/// Green strain of a random deformation gradient: displacement gradients up to `size`, det F > 0.4.
static inline void random_strain(uint64_t *seed, double size, double E[6]) {
    double F[3][3], C[3][3];
    do {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) F[i][j] = (i == j) + check_random(seed, -size, size);
    } while (det3(F) < 0.4);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            C[i][j] = -(i == j);
            for (int m = 0; m < 3; m++) C[i][j] += F[m][i] * F[m][j];
        }
    components_of(C, E);
    for (int k = 0; k < 6; k++) E[k] /= 2;
}

/// A rotation from a random unit quaternion; about the first axis if `about_first`.
static inline void random_rotation(uint64_t *seed, bool about_first, double Q[3][3]) {
    double q[4], length = 0;
    for (int i = 0; i < 4; i++) {
        q[i] = about_first && i > 1 ? 0 : check_random(seed, -1, 1);
        length += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++) q[i] /= sqrt(length);
    double w = q[0], v[3] = {q[1], q[2], q[3]};
    double cross[3][3] = {{0, -v[2], v[1]}, {v[2], 0, -v[0]}, {-v[1], v[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            Q[i][j] = (i == j ? 2 * w * w - 1 : 0) + 2 * v[i] * v[j] + 2 * w * cross[i][j];
}

/// Q^T A Q
static inline void rotate6(double Q[3][3], const double a[6], double out[6]) {
    double A[3][3], B[3][3] = {{0}};
    tensor_of(a, A);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++) B[i][j] += Q[k][i] * A[k][l] * Q[l][j];
    components_of(B, out);
}

/// D times the strain direction h, as a stress.
static inline void tangent_times(const double D[21], const double h[6], double out[6]) {
    for (int i = 0; i < 6; i++) {
        out[i] = 0;
        for (int j = 0; j < 6; j++) out[i] += D[upper(i, j)] * (j < 3 ? 1 : 2) * h[j];
    }
}
