// Derivatives of the residuals of a fit by its constants.
// SPDX-License-Identifier: Apache-2.0
//
// A curve that sn_path_slopes() holds for (problem->slopes) has exact derivatives; any other takes
// central differences of that curve alone. Both are per unit of the constant; the scale of the fit
// and the weights come on top, for all curves alike.
#include <math.h>

#include "lab/fit/problem.h"

static const double difference = 1e-4; // of a logarithm or a value; error 1e-8, noise 1e-11/1e-4

static double *value_of(sn_problem *p, const sn_fit_constant *c) {
    return (c->in_memory ? p->tissue.memory.value : p->tissue.value) + c->index;
}

// model stresses of curve k with constant c at `value`
static sn_status stress_with(sn_problem *p, int k, const sn_fit_constant *c, double value,
                             double *stress) {
    sn_exponentials e;
    sn_pull pull;
    double *at = value_of(p, c), before = *at;
    *at = value;
    sn_status status = sn_law_check(p->tissue.law, p->tissue.value, p->tissue.terms);
    if (status == SN_OK) status = sn_memory_expand(&p->tissue.memory, &e);
    if (status == SN_OK) status = sn_pull_choose(&p->tissue, &pull);
    if (status == SN_OK) status = sn_problem_curve(p, k, pull, &e, stress);
    *at = before;
    return status;
}

// Column of constant c for curve k, n rows. One-sided where one side is not feasible; zero where
// neither is.
static sn_status difference_column(sn_problem *p, int k, const sn_fit_constant *c, int n,
                                   double *column) {
    double value = *value_of(p, c),
           reach = difference * fmax(fabs(value), 1e-4 * (c->high - c->low));
    double side[2] = {value - reach, value + reach};
    double *stress = sn_alloc(3 * (size_t)n, sizeof *stress);
    if (!stress) return SN_E_MEMORY;
    double *at[2] = {stress, stress + n}, *middle = stress + 2 * n;
    sn_status status = stress_with(p, k, c, value, middle);
    for (int s = 0; s < 2 && status == SN_OK; ++s)
        if (stress_with(p, k, c, side[s], at[s]) != SN_OK) {
            at[s] = middle;
            side[s] = value;
        }
    double width = side[1] - side[0];
    for (int i = 0; i < n && status == SN_OK; ++i)
        column[i] = width > 0.0 ? (at[1][i] - at[0][i]) / width : 0.0;
    sn_free(stress);
    return status;
}

// columns of curve k per unit of the constants, n rows each
static sn_status curve_columns(sn_problem *p, int k, int n, double *columns) {
    sn_exponentials e;
    sn_constants by = {0};
    sn_pulled pulled = {p->path[k], &p->tissue, SN_PULL_UNIAXIAL, &e, SN_PROBLEM_LEVEL};
    if (!p->slopes[k]) {
        for (int j = 0; j < p->free_count; ++j)
            SN_TRY(
                difference_column(p, k, &p->constant[p->free[j]], n, columns + (ptrdiff_t)j * n));
        return SN_OK;
    }
    for (int j = 0; j < p->free_count; ++j) { // in this order: the law's first
        const sn_fit_constant *c = &p->constant[p->free[j]];
        if (c->in_memory)
            by.memory[by.memory_count++] = c->index;
        else
            by.law[by.law_count++] = c->index;
    }
    SN_TRY(sn_law_check(p->tissue.law, p->tissue.value, p->tissue.terms));
    SN_TRY(sn_memory_expand(&p->tissue.memory, &e));
    SN_TRY(sn_pull_choose(&p->tissue, &pulled.pull));
    return sn_path_slopes(&pulled, &by, columns);
}

static sn_status all_columns(sn_problem *p, double *jacobian) {
    int most = 0;
    for (int k = 0; k < p->def->curve_count; ++k)
        if (p->def->curve[k].count > most) most = p->def->curve[k].count;
    double *columns = sn_alloc((size_t)most * (size_t)p->free_count, sizeof *columns);
    if (!columns) return SN_E_MEMORY;
    sn_status status = SN_OK;
    for (int k = 0, at = 0; k < p->def->curve_count && status == SN_OK; ++k) {
        int n = p->def->curve[k].count;
        status = curve_columns(p, k, n, columns);
        for (int j = 0; j < p->free_count && status == SN_OK; ++j) {
            sn_fit_constant *c = &p->constant[p->free[j]];
            double unit = c->param->log_scale ? *value_of(p, c) : 1.0; // dp/dx
            double *to = jacobian + (ptrdiff_t)j * p->points + at;
            const double *from = columns + (ptrdiff_t)j * n;
            for (int i = 0; i < n; ++i) to[i] = unit * p->weight[at + i] * from[i];
        }
        at += n;
    }
    sn_free(columns);
    return status;
}

bool sn_problem_jacobian(sn_problem *problem, const double *x, double *jacobian) {
    ptrdiff_t numbers = (ptrdiff_t)problem->free_count * problem->points;
    problem->evaluations++;
    sn_problem_set(problem, x);
    bool good = all_columns(problem, jacobian) == SN_OK;
    for (ptrdiff_t i = 0; i < numbers && good; ++i) good = fabs(jacobian[i]) < 1e150;
    for (ptrdiff_t i = 0; i < numbers && !good; ++i) jacobian[i] = 0.0;
    return good;
}
