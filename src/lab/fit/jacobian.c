// Derivatives of the residuals of a fit by its constants.
// SPDX-License-Identifier: Apache-2.0
//
// Pulled curves have exact derivatives (sn_path_slopes). They are per unit of the constant; the
// scale of the fit and the weights come on top. Tied constants follow the free ones but multiply
// shears that no such curve has, so they add nothing. With curves of another kind among them, or
// where a point had to be shrunk and every cross constant moves with every other, the residuals as
// a whole take central differences.
#include <math.h>
#include <string.h>

#include "lab/fit/problem.h"

static const double difference = 1e-4; // of the scale of the fit; error 1e-8, noise 1e-11/1e-4

static const double *value_of(const sn_problem *p, const sn_fit_constant *c) {
    return (c->in_memory ? p->tissue.memory.value : p->tissue.value) + c->index;
}

//---- exact ---------------------------------------------------------------------------------------

// columns of curve k per unit of the constants, n rows each
static sn_status curve_columns(const sn_problem *p, int k, double *columns) {
    sn_exponentials e;
    sn_constants by = {0};
    sn_pulled pulled = {p->path[k], &p->tissue, SN_PULL_UNIAXIAL, &e, SN_PROBLEM_LEVEL};
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

static sn_status all_columns(const sn_problem *p, double *jacobian) {
    int most = 0;
    for (int k = 0; k < p->def->curve_count; ++k)
        if (p->def->curve[k].count > most) most = p->def->curve[k].count;
    double *columns = sn_alloc((size_t)most * (size_t)p->free_count, sizeof *columns);
    if (!columns) return SN_E_MEMORY;
    sn_status status = SN_OK;
    for (int k = 0, at = 0; k < p->def->curve_count && status == SN_OK; ++k) {
        int n = p->def->curve[k].count;
        status = curve_columns(p, k, columns);
        for (int j = 0; j < p->free_count && status == SN_OK; ++j) {
            const sn_fit_constant *c = &p->constant[p->free[j]];
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

//---- differences ---------------------------------------------------------------------------------

// One-sided where one side is not feasible or beyond the bound; zero where neither is to be had.
static void difference_column(sn_problem *p, const double *at, int j, const double *middle,
                              double *column, double *work) {
    double x[SN_FIT_PARAMS_MAX], h[2] = {0.0, 0.0};
    const sn_fit_constant *c = &p->constant[p->free[j]];
    double bound[2] = {sn_problem_scaled(c, c->low), sn_problem_scaled(c, c->high)};
    double step = difference;
    if (!c->param->log_scale) step *= fmax(fabs(at[j]), 1e-4 * (bound[1] - bound[0]));
    const double *side[2] = {middle, middle};
    memcpy(x, at, (size_t)p->free_count * sizeof *x);
    for (int s = 0; s < 2; ++s) {
        x[j] = s ? fmin(bound[1], at[j] + step) : fmax(bound[0], at[j] - step);
        double *trial = work + (ptrdiff_t)s * p->points;
        if (x[j] == at[j] || !sn_problem_residuals(p, x, trial)) continue;
        h[s] = fabs(x[j] - at[j]);
        side[s] = trial;
    }
    double width = h[0] + h[1];
    for (int i = 0; i < p->points; ++i)
        column[i] = width > 0.0 ? (side[1][i] - side[0][i]) / width : 0.0;
}

static sn_status differences(sn_problem *p, const double *x, double *jacobian) {
    double *work = sn_alloc(3 * (size_t)p->points, sizeof *work);
    if (!work) return SN_E_MEMORY;
    sn_status status = sn_problem_residuals(p, x, work) ? SN_OK : SN_E_RANGE;
    for (int j = 0; j < p->free_count && status == SN_OK; ++j)
        difference_column(p, x, j, work, jacobian + (ptrdiff_t)j * p->points, work + p->points);
    sn_free(work);
    return status;
}

bool sn_problem_jacobian(sn_problem *problem, const double *x, double *jacobian) {
    ptrdiff_t numbers = (ptrdiff_t)problem->free_count * problem->points;
    problem->evaluations++;
    sn_problem_set(problem, x);
    bool exact = problem->slopes && problem->convexity == 1.0;
    bool good =
        (exact ? all_columns(problem, jacobian) : differences(problem, x, jacobian)) == SN_OK;
    for (ptrdiff_t i = 0; i < numbers && good; ++i) good = fabs(jacobian[i]) < 1e150;
    for (ptrdiff_t i = 0; i < numbers && !good; ++i) jacobian[i] = 0.0;
    return good;
}
