// Which rows of a fit count, and how much.
// SPDX-License-Identifier: Apache-2.0
// Source: iteratively reweighted least squares with a variance per group, Carroll & Ruppert,
// Transformation and weighting in regression (1988), chapter 2.
#include <math.h>

#include "lab/fit/statistics.h"

enum { ROUNDS = 25 };
static const double settled = 1e-3;  // largest relative change of a weight
static const double quietest = 1e-6; // least noise that is believed, part of the largest stress

bool sn_problem_in_window(const sn_fit_def *def, const sn_curve *curve, int row) {
    return !curve->time || (curve->time[row] >= def->from && curve->time[row] <= def->to);
}

static double peak_of(const sn_fit_def *def, int k) {
    const sn_curve *curve = &def->curve[k];
    double peak = 0.0;
    for (int i = 0; i < curve->count; ++i) {
        if (!sn_problem_in_window(def, curve, i)) continue;
        for (int axis = 0; axis < 2 && sn_curve_measured(curve, axis); ++axis)
            peak = fmax(peak, fabs(sn_curve_measured(curve, axis)[i]));
    }
    return peak;
}

sn_status sn_weigh_peaks(const sn_fit_def *def, double *weight) {
    double largest = 0.0;
    for (int k = 0; k < def->curve_count; ++k) largest = fmax(largest, peak_of(def, k));
    for (int k = 0; k < def->curve_count; ++k) {
        double peak = peak_of(def, k);
        if (!(peak > 0.0))
            return sn_fail(SN_E_DATA,
                           "%s: the stress is 0 in every row of the window: there is no peak to "
                           "weigh the curve by",
                           def->curve[k].name);
        weight[k] = (def->weight ? def->weight[k] : 1.0) * pow(largest / peak, 2.0);
    }
    return SN_OK;
}

// variance of the residuals of every curve; its share of the constants is taken off its rows
static void variances(const sn_problem *p, double *variance) {
    double floor = pow(quietest * p->peak, 2.0);
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        double sum = 0.0;
        int used = 0, rows = sn_problem_rows(&p->def->curve[k]);
        for (int i = at; i < at + rows; ++i) {
            if (p->weight[i] == 0.0) continue;
            sum += pow(p->model[i] - p->measured[i], 2.0);
            used++;
        }
        at += rows;
        double freedom = used * (1.0 - (double)p->free_count / p->used);
        variance[k] = fmax(floor, freedom > 0.0 ? sum / freedom : 0.0);
    }
}

// the largest relative change of a weight
static double reweigh(sn_problem *p, const double *variance, double largest) {
    double change = 0.0;
    p->norm = 0.0;
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        double own = p->def->weight ? p->def->weight[k] : 1.0;
        double root = sqrt(own * largest / variance[k]);
        for (int end = at + sn_problem_rows(&p->def->curve[k]); at < end; ++at) {
            if (p->weight[at] == 0.0) continue;
            change = fmax(change, fabs(pow(root / p->weight[at], 2.0) - 1.0));
            p->weight[at] = root;
            p->norm += pow(root * p->measured[at], 2.0);
        }
    }
    return change;
}

sn_status sn_weigh_noise(sn_problem *problem, sn_found *best, bool *same) {
    double variance[SN_FIT_CURVES_MAX], *residual;
    residual = sn_alloc((size_t)problem->points, sizeof *residual);
    if (!residual) return SN_E_MEMORY;
    sn_status status = SN_OK;
    *same = false;
    for (int round = 0; round < ROUNDS && !*same && status == SN_OK; ++round) {
        double largest = 0.0;
        sn_problem_residuals(problem, best->x, residual); // model stresses as of the best
        variances(problem, variance);
        for (int k = 0; k < problem->def->curve_count; ++k) largest = fmax(largest, variance[k]);
        *same = reweigh(problem, variance, largest) < settled;
        status = sn_search_local(problem, NULL, 1e-12, best);
    }
    sn_free(residual);
    return status;
}
