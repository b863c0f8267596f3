// What the data do know of constants that they do not tell apart.
// SPDX-License-Identifier: Apache-2.0
//
// Of the constants that are not known well by themselves, and those tied to them, the products of
// powers with the smallest relative errors: the eigenvectors of the smallest eigenvalues of their
// covariance in ln|x|. Exponents are rounded before the error is worked out, so that it is that of
// what is printed.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/fit/statistics.h"

enum { N = SN_FIT_PARAMS_MAX, COMBINATIONS = 2, PARTS = 3 }; // PARTS: more say nothing to a reader
static const double known = 0.05;  // largest half of a 95 % interval, relative
static const double nothing = 1e3; // error in ln|x| from which on a constant moves nothing
static const double tied = 0.9;    // correlation
static const double gain = 0.7;    // an error below this part of that of the best known constant
static const double least = 2e-3;  // relative: a part of a combination below it is left out
static const double share = 0.3;   // of the error of a combination: the same

// Standard error of ln|x|: from the profile where there is one, as the linearised error of a
// constant at its bound says nothing.
static double relative_error(const sn_problem *p, int j, const sn_fit_result *r) {
    const sn_fit_param *one = &r->param[p->free[j]];
    return one->standard_error / fmax(fabs(one->value), 1e-300);
}

// largest exponent 1, rounded to what is printed, the parts dropped that matter little
static void tidy(int n, const double *error, double variance, double *u) {
    double largest = 0.0;
    for (int i = 0; i < n; ++i)
        if (fabs(u[i]) > fabs(largest)) largest = u[i];
    for (int i = 0; i < n; ++i) {
        if (fabs(u[i]) * error[i] < fmax(least, share * sqrt(variance))) u[i] = 0.0;
        u[i] = floor(1000.0 * u[i] / largest + 0.5) / 1000.0;
    }
}

static double variance_of(int n, const double *u, const double *covariance) {
    double variance = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) variance += u[i] * u[j] * covariance[i * n + j];
    return fmax(0.0, variance);
}

static void append(sn_fit_result *r, const sn_problem *p, int n, const int *member, const double *u,
                   double half) {
    double product = 1.0;
    size_t size = sizeof r->determined, used = strlen(r->determined);
    if (used) used += (size_t)snprintf(r->determined + used, size - used, "; ");
    for (int i = 0; i < n; ++i) {
        const sn_fit_param *one = &r->param[p->free[member[i]]];
        if (u[i] == 0.0) continue;
        product *= pow(fabs(one->value), u[i]);
        snprintf(r->determined + used, size - used, one->value < 0.0 ? "|%s|" : "%s", one->name);
        used = strlen(r->determined);
        if (u[i] != 1.0) snprintf(r->determined + used, size - used, "^%.3g", u[i]);
        used = strlen(r->determined);
        snprintf(r->determined + used, size - used, " ");
        used = strlen(r->determined);
    }
    snprintf(r->determined + used, size - used, "= %.4g in SI units, to %.2g %%", product,
             100.0 * half);
}

// Constants that are not known well, and those tied to one of them. error[] is theirs.
static int choose(const sn_problem *p, const sn_spread *spread, const sn_fit_result *r, int *member,
                  double *error) {
    int n = 0, all = p->free_count;
    double relative[N];
    bool poor[N];
    for (int j = 0; j < all; ++j) {
        relative[j] = relative_error(p, j, r);
        poor[j] = spread->student * relative[j] > known && relative[j] < nothing;
    }
    for (int j = 0; j < all; ++j) {
        bool in = poor[j];
        for (int k = 0; k < all && relative[j] < nothing; ++k)
            in = in || (poor[k] && fabs(spread->correlation[j * all + k]) > tied);
        if (!in) continue;
        error[n] = relative[j];
        member[n++] = j;
    }
    return n;
}

void sn_describe_determined(const sn_problem *problem, const sn_spread *spread,
                            sn_fit_result *result) {
    int all = problem->free_count, member[N];
    double error[N], covariance[N * N] = {0}, work[N * N], value[N], V[N * N];
    result->determined[0] = 0;
    if (result->identifiable) return;
    int n = choose(problem, spread, result, member, error);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            covariance[i * n + j] =
                error[i] * error[j] * spread->correlation[member[i] * all + member[j]];
    memcpy(work, covariance, sizeof work);
    sn_eigen_symmetric(n, work, value, V);
    for (int k = 0; k < n && k < COMBINATIONS; ++k) {
        double u[N];
        int parts = 0;
        double alone = (double)INFINITY;
        for (int i = 0; i < n; ++i) u[i] = V[i * n + k];
        tidy(n, error, variance_of(n, u, covariance), u);
        for (int i = 0; i < n; ++i) {
            parts += u[i] != 0.0;
            if (u[i] != 0.0) alone = fmin(alone, error[i]);
        }
        double half = spread->student * sqrt(variance_of(n, u, covariance));
        bool better = half < gain * spread->student * alone; // than its best known part
        if (parts >= 2 && parts <= PARTS && better && half <= 2.0 * known)
            append(result, problem, n, member, u, half);
    }
}
