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

/// Terms of a law's lists in these tests.
static inline int law_terms(const sn_law *law) {
    for (int k = 0; k < law->param_count; k++)
        if (law->params[k].length == SN_PARAM_LIST) return 2;
    return 0;
}
/// Number of values of a law.
static inline int law_values(const sn_law *law) {
    return sn_param_offset(law->params, law->param_count, law_terms(law));
}
/// The first value of a parameter.
static inline double *value_of(const sn_law *law, double *value, const char *name) {
    int k = sn_param_find(law->params, law->param_count, name);
    assert_true(k >= 0);
    return value + sn_param_offset(law->params, k, law_terms(law));
}

/// Gives a between two diagonal elements the size that leaves them convex.
static inline void random_between(uint64_t *seed, double *a, double one, double two, double most) {
    *a = check_random(seed, -most, most) * sqrt(one * two);
}
/// Nine constants of law/orthotropic.h, the diagonal as it is.
static inline void make_convex(uint64_t *seed, double *a) {
    random_between(seed, &a[3], a[0], a[1], 0.45);
    random_between(seed, &a[4], a[1], a[2], 0.45);
    random_between(seed, &a[5], a[2], a[0], 0.45);
}
/// Takes random constants to some that the conditions of their law allow.
static inline void satisfy(const sn_law *law, uint64_t *seed, double *value) {
    if (strcmp(law->name, "ogden") == 0) {
        for (int k = 0; k < 2; k++)
            if (check_random(seed, -1, 1) < 0) value[k] = -value[k], value[2 + k] = -value[2 + k];
    } else if (strcmp(law->name, "fung") == 0) {
        make_convex(seed, value_of(law, value, "a"));
    } else if (strcmp(law->name, "fung-general") == 0) {
        make_convex(seed, value_of(law, value, "alpha"));
        make_convex(seed, value_of(law, value, "a"));
    } else if (law->kind == SN_LAW_MEMBRANE) {
        double *a = value_of(law, value, "a1");
        random_between(seed, &a[3], a[0], a[1], 0.5);
        if (law->param_count < 13) return;
        random_between(seed, &value[3], value[0], value[1], 0.5);
        // cubic terms that leave Q positive at strains up to 1, so that W is no small difference
        for (int k = 9; k < 13; k++) value[k] = check_random(seed, -0.1, 0.1) * fmin(a[0], a[1]);
    }
}

/// Constants in the range of the table, as tissues have them: moduli from 100 Pa to 1 MPa,
/// exponents from 0.1 to 20, ratios and angles anywhere. One bulk modulus in four is infinite.
static inline void random_values(const sn_law *law, uint64_t *seed, double *value) {
    double *at = value;
    assert_true(law_values(law) <= POINTS_VALUES_MAX);
    for (int k = 0; k < law->param_count; k++) {
        const sn_param *p = &law->params[k];
        for (int i = 0; i < sn_param_length(p, law_terms(law)); i++, at++) {
            if (strcmp(p->unit, "Pa") == 0)
                *at = exp(check_random(seed, log(1e2), log(1e6)));
            else if (p->max - p->min < 2)
                *at = check_random(seed, p->min + 1e-3, p->max - 1e-3);
            else
                *at = exp(check_random(seed, log(0.1), log(20)));
            if (p->infinity && check_random(seed, 0, 1) < 0.25) *at = (double)INFINITY;
        }
    }
    satisfy(law, seed, value);
    CHECK_OK(sn_law_check(law, value, law_terms(law)));
}

// where the components 11 22 12 of a membrane stand among six
static const int plane[3] = {0, 1, 3};

/// A solid law at one point, or a membrane as if it were one: no stress but in its plane.
static inline void law_at(const sn_law *law, const double *value, const double E[6], double *W,
                          double S[6], double D[21]) {
    if (law->kind == SN_LAW_SOLID) {
        sn_law_solid(law, value, law_terms(law), 1, E, W, S, D);
        return;
    }
    double e[3] = {E[0], E[1], E[3]}, s[3], d[6];
    sn_law_membrane(law, value, law_terms(law), 1, e, W, s, d);
    for (int k = 0; S && k < 6; k++) S[k] = 0;
    for (int k = 0; D && k < 21; k++) D[k] = 0;
    for (int i = 0, at = 0; i < 3; i++) {
        if (S) S[plane[i]] = s[i];
        for (int j = i; j < 3; j++, at++)
            if (D) D[upper(plane[i], plane[j])] = d[at];
    }
}
/// The same in single precision.
static inline void law_at_f(const sn_law *law, const float *value, const float E[6], float *W,
                            float S[6], float D[21]) {
    if (law->kind == SN_LAW_SOLID) {
        sn_law_solid_f(law, value, law_terms(law), 1, E, W, S, D);
        return;
    }
    float e[3] = {E[0], E[1], E[3]}, s[3], d[6];
    sn_law_membrane_f(law, value, law_terms(law), 1, e, W, s, d);
    for (int k = 0; k < 6; k++) S[k] = 0;
    for (int k = 0; k < 21; k++) D[k] = 0;
    for (int i = 0, at = 0; i < 3; i++) {
        S[plane[i]] = s[i];
        for (int j = i; j < 3; j++, at++) D[upper(plane[i], plane[j])] = d[at];
    }
}

/// Isochoric strain and invariants by the definitions, without any of isochoric.h's care.
static inline void isochoric_of(const double E[6], double Ebar[6], double *I1, double *I2) {
    double c[6], C[3][3];
    for (int k = 0; k < 6; k++) c[k] = 2 * E[k] + (k < 3);
    tensor_of(c, C);
    double factor = pow(det3(C), -1.0 / 3);
    for (int k = 0; k < 6; k++) {
        c[k] *= factor;
        Ebar[k] = (c[k] - (k < 3)) / 2;
    }
    *I1 = c[0] + c[1] + c[2];
    *I2 = (*I1 * *I1 - dot6(c, c)) / 2;
}

/// Strains of the two families of fibres of law hgo.
static inline void hgo_strains(const double *p, const double E[6], double e[2]) {
    double b[6], I1, I2, c = cos(p[4]), s = sin(p[4]);
    isochoric_of(E, b, &I1, &I2);
    for (int i = 0; i < 2; i++)
        e[i] = p[3] * (I1 - 3) +
               (1 - 3 * p[3]) * 2 * (c * c * b[0] + s * s * b[1] + (i ? -2 : 2) * c * s * b[3]);
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
