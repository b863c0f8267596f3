// Linearised errors of fitted constants.
// SPDX-License-Identifier: Apache-2.0
// Source: covariance s^2 (J^T J)^-1, s^2 = SSE/(n - p); Student's t by the expansion of Abramowitz
// & Stegun 26.7.5; Jacobi's method for eigenvalues.
#include <math.h>
#include <string.h>

#include "lab/fit/statistics.h"

enum { N = SN_FIT_PARAMS_MAX };

double sn_student_975(int nu) {
    // the expansion in 1/nu is good to 5e-4 from nu = 4 on
    static const double few[] = {12.706205, 4.302653, 3.182446};
    if (nu < 1) return (double)INFINITY;
    if (nu <= 3) return few[nu - 1];
    double z = 1.959963984540054, z2 = z * z, v = nu;
    double g1 = z * (z2 + 1.0) / 4.0;
    double g2 = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
    double g3 = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
    double g4 = z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
    return z + (g1 + (g2 + (g3 + g4 / v) / v) / v) / v;
}

// one rotation that makes A[p][q] zero
static void rotate(int n, double *A, double *V, int p, int q) {
    double apq = A[p * n + q];
    if (apq == 0.0) return;
    double theta = 0.5 * (A[q * n + q] - A[p * n + p]) / apq;
    double t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + hypot(theta, 1.0));
    double c = 1.0 / hypot(t, 1.0), s = t * c;
    for (int k = 0; k < n; ++k) {
        double a = A[k * n + p], b = A[k * n + q];
        A[k * n + p] = c * a - s * b;
        A[k * n + q] = s * a + c * b;
    }
    for (int k = 0; k < n; ++k) {
        double a = A[p * n + k], b = A[q * n + k];
        A[p * n + k] = c * a - s * b;
        A[q * n + k] = s * a + c * b;
        double u = V[k * n + p], w = V[k * n + q];
        V[k * n + p] = c * u - s * w;
        V[k * n + q] = s * u + c * w;
    }
}

void sn_eigen_symmetric(int n, double *A, double *value, double *V) {
    memset(V, 0, (size_t)(n * n) * sizeof *V);
    for (int i = 0; i < n; ++i) V[i * n + i] = 1.0;
    for (int sweep = 0; sweep < 60; ++sweep) {
        double off = 0.0, diagonal = 0.0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) *(i == j ? &diagonal : &off) += A[i * n + j] * A[i * n + j];
        if (off <= 1e-32 * diagonal) break;
        for (int p = 0; p < n; ++p)
            for (int q = p + 1; q < n; ++q) rotate(n, A, V, p, q);
    }
    for (int i = 0; i < n; ++i) value[i] = A[i * n + i];
    for (int i = 0; i < n; ++i) { // rising
        int least = i;
        for (int j = i + 1; j < n; ++j)
            if (value[j] < value[least]) least = j;
        double v = value[i];
        value[i] = value[least];
        value[least] = v;
        for (int k = 0; k < n && least != i; ++k) {
            double u = V[k * n + i];
            V[k * n + i] = V[k * n + least];
            V[k * n + least] = u;
        }
    }
}

// errors and correlations from the eigenvalues of the scaled matrix
static void invert(int n, const double *scale, double variance, double *A, sn_spread *spread) {
    double value[N], V[N * N], covariance[N * N];
    sn_eigen_symmetric(n, A, value, V);
    const double rounding = 1e-14 * value[n - 1], least = fmax(value[0], rounding);
    spread->condition = value[n - 1] / least;
    for (int i = 0; i < n; ++i) spread->weakest[i] = V[i * n];
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int k = 0; k < n; ++k) sum += V[i * n + k] * V[j * n + k] / fmax(value[k], least);
            covariance[i * n + j] = sum;
        }
    for (int i = 0; i < n; ++i) {
        spread->error[i] = sqrt(variance * covariance[i * n + i]) / scale[i];
        for (int j = 0; j < n; ++j)
            spread->correlation[i * n + j] =
                i == j
                    ? 1.0
                    : covariance[i * n + j] / sqrt(covariance[i * n + i] * covariance[j * n + j]);
    }
    // A direction of which the data show nothing but rounding is open, however small the residuals:
    // so is every constant that has a part in it (the squares of the parts sum to 1).
    for (int k = 0; k < n && value[k] < rounding; ++k)
        for (int i = 0; i < n; ++i)
            if (fabs(V[i * n + k]) > 0.01) spread->error[i] = 1e30;
}

sn_status sn_spread_at(sn_problem *problem, const sn_found *best, sn_spread *spread) {
    int n = problem->free_count, m = problem->points;
    *spread = (sn_spread){.condition = 1.0, .student = sn_student_975(problem->used - n)};
    if (n == 0) return SN_OK;
    double *J = sn_alloc((size_t)m * (size_t)n, sizeof *J);
    if (!J) return SN_E_MEMORY;
    double scale[N], A[N * N];
    sn_problem_jacobian(problem, best->x, J);
    for (int j = 0; j < n; ++j) {
        scale[j] = sqrt(sn_sum_squares(m, J + (size_t)j * (size_t)m));
        // a constant that moves nothing: an error beyond any bound, and no division by zero
        scale[j] = fmax(scale[j], 1e-12 * sqrt(problem->norm));
    }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double sum = 0.0;
            for (int k = 0; k < m; ++k)
                sum += J[(size_t)i * (size_t)m + (size_t)k] * J[(size_t)j * (size_t)m + (size_t)k];
            A[i * n + j] = sum / scale[i] / scale[j];
        }
    invert(n, scale, best->sum / (problem->used - n), A, spread);
    sn_free(J);
    return SN_OK;
}
