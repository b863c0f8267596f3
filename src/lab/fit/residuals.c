// The residuals of a fit at a point of its search.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>

#include "lab/fit/fung.h"
#include "lab/fit/problem.h"
#include "lab/protocol/protocol.h"

static const double beyond = 10.0; // how residuals grow outside convexity

void sn_problem_set(sn_problem *problem, const double *x) {
    for (int j = 0; j < problem->free_count; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        double *values = c->in_memory ? problem->tissue.memory.value : problem->tissue.value;
        values[c->index] = sn_problem_natural(c, x[j]);
    }
    problem->convexity = sn_fung_convex(problem->tissue.law, problem->held, problem->tissue.value);
    for (int k = 0; k < problem->count; ++k) {
        const sn_fit_constant *c = &problem->constant[k];
        if (c->tied)
            sn_fung_tie(problem->tissue.law, c->index, c->param->max, problem->tissue.value);
    }
}

void sn_problem_settle(sn_problem *problem, double *x) {
    sn_problem_set(problem, x);
    for (int j = 0; j < problem->free_count; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        const double *values = c->in_memory ? problem->tissue.memory.value : problem->tissue.value;
        x[j] = sn_problem_scaled(c, values[c->index]);
    }
}

// model stresses of the tissue as it stands
static sn_status model_stress(sn_problem *p) {
    sn_exponentials e;
    sn_pull pull = SN_PULL_UNIAXIAL;
    SN_TRY(sn_law_check(p->tissue.law, p->tissue.value, p->tissue.terms));
    SN_TRY(sn_memory_expand(&p->tissue.memory, &e));
    if (p->tissue.law->kind != SN_LAW_MEMBRANE) SN_TRY(sn_pull_choose(&p->tissue, &pull));
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        const sn_curve *c = &p->def->curve[k];
        if (c->kind == SN_CURVE_DYNAMIC)
            SN_TRY(sn_dynamic_moduli(&p->tissue, c->mean_stretch, c->count, c->frequency,
                                     p->model + at, p->model + at + c->count));
        else if (p->plane[k])
            SN_TRY(sn_in_plane_stress(p->plane[k], &p->tissue, &e, p->model + at));
        else
            SN_TRY(
                sn_path_stress(p->path[k], &p->tissue, pull, &e, SN_PROBLEM_LEVEL, p->model + at));
        at += sn_problem_rows(c);
    }
    return SN_OK;
}

bool sn_problem_residuals(sn_problem *problem, const double *x, double *residual) {
    problem->evaluations++;
    sn_problem_set(problem, x);
    bool good = model_stress(problem) == SN_OK;
    double away = 1.0 + beyond * (1.0 - problem->convexity);
    for (int i = 0; i < problem->points && good; ++i) {
        residual[i] = away * problem->weight[i] * (problem->model[i] - problem->measured[i]);
        good = fabs(residual[i]) < 1e150; // squares must not overflow; false for NaN
    }
    if (good) return true;
    double wall = 1e3 * sqrt(problem->norm / problem->points);
    for (int i = 0; i < problem->points; ++i) residual[i] = wall;
    return false;
}

double sn_problem_scaled_sum(sn_problem *problem, double *x, double *residual) {
    int n = problem->points;
    sn_problem_settle(problem, x);
    if (!sn_problem_residuals(problem, x, residual) || !problem->scalable)
        return sn_sum_squares(n, residual);
    double cross = 0.0, square = 0.0;
    for (int i = 0; i < n; ++i) {
        double w = problem->weight[i] * problem->weight[i];
        cross += w * problem->model[i] * problem->measured[i];
        square += w * problem->model[i] * problem->model[i];
    }
    double factor = square > 0.0 ? cross / square : 0.0;
    if (!(factor > 0.0)) return sn_sum_squares(n, residual);
    for (int j = 0; j < problem->free_count; ++j) { // all or none: within the bounds?
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        double value = factor * sn_problem_natural(c, x[j]);
        if (c->stress && (value < c->low || value > c->high)) return sn_sum_squares(n, residual);
    }
    for (int j = 0; j < problem->free_count; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        if (c->stress) x[j] = sn_problem_scaled(c, factor * sn_problem_natural(c, x[j]));
    }
    return fmax(0.0, problem->norm - factor * cross);
}
