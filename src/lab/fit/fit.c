// Fitting of curves to a tissue, and prediction of a curve by a tissue.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (14), (33)-(38): elastic and memory law together, through the recorded history.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/fit/statistics.h"

enum { RESTARTS = 4 }; // profiles that met a better point

sn_fit_def sn_fit_def_default(void) {
    return (sn_fit_def){.terms = 3, .law_terms = 1, .starts = 6, .seed = 1};
}

// fills all but `predicted` from it
static void judge_curve(const sn_curve *curve, sn_fit_curve *out) {
    double mean = 0.0, sse = 0.0, sst = 0.0, largest = -1.0;
    for (int i = 0; i < curve->count; ++i) mean += curve->stress[i] / curve->count;
    for (int i = 0; i < curve->count; ++i) {
        double residual = fabs(out->predicted[i] - curve->stress[i]);
        sse += residual * residual;
        sst += (curve->stress[i] - mean) * (curve->stress[i] - mean);
        out->peak = fmax(out->peak, fabs(curve->stress[i]));
        if (residual > largest) {
            largest = residual;
            out->worst = i;
        }
    }
    out->rmse = sqrt(sse / curve->count);
    out->r_squared = sst > 0.0 ? 1.0 - sse / sst : (double)NAN;
}

static void judge_all(const sn_problem *p, const sn_found *best, sn_fit_result *r) {
    double mean = 0.0, sse = 0.0, sst = 0.0, n = p->points;
    for (int i = 0; i < p->points; ++i) mean += p->measured[i] / n;
    for (int i = 0; i < p->points; ++i) {
        sse += (p->model[i] - p->measured[i]) * (p->model[i] - p->measured[i]);
        sst += (p->measured[i] - mean) * (p->measured[i] - mean);
    }
    r->points = p->points;
    r->r_squared = sst > 0.0 ? 1.0 - sse / sst : (double)NAN;
    r->rmse = sqrt(sse / n);
    r->nrmse = r->rmse / p->peak;
    // the variance of the noise is fitted as well
    double k = p->free_count + 1.0, room = n - k - 1.0;
    double likelihood = n * log(fmax(best->sum, 1e-300) / n) + 2.0 * k;
    r->aicc = room > 0.0 ? likelihood + 2.0 * k * (k + 1.0) / room : (double)INFINITY;
}

static sn_status fill_curves(const sn_problem *p, sn_fit_result *r) {
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        const sn_curve *curve = &p->def->curve[k];
        sn_fit_curve *out = &r->curve[r->curve_count++];
        out->count = curve->count;
        out->predicted = sn_alloc((size_t)curve->count, sizeof *out->predicted);
        if (!out->predicted) return SN_E_MEMORY;
        memcpy(out->predicted, p->model + at, (size_t)curve->count * sizeof *out->predicted);
        judge_curve(curve, out);
        at += curve->count;
    }
    return SN_OK;
}

static void say_end(const sn_found *best, int restarts, sn_fit_result *r) {
    r->converged = best->info >= 1 && best->info != 5;
    snprintf(r->reason, sizeof r->reason, "%s after %d evaluations%s%s",
             r->converged      ? "converged"
             : best->info == 5 ? "stopped at the limit of evaluations of the local search"
                               : "the local search failed",
             r->evaluations,
             restarts ? "; a profile met a better point and the search went on from it" : "",
             restarts == RESTARTS ? ", as often as allowed: the best may not be found" : "");
}

static sn_status search_and_describe(sn_problem *p, sn_fit_result *r) {
    sn_found best;
    SN_TRY(sn_search(p, &best));
    bool moved = true;
    int restarts = 0;
    while (moved) {
        if (p->def->progress) p->def->progress(p->def->progress_context, 0.75, "intervals");
        SN_TRY(sn_describe(p, &best, restarts == RESTARTS, r, &moved));
        if (!moved) break;
        restarts++;
        SN_TRY(sn_search_local(p, NULL, 1e-12, &best));
    }
    double *residual = sn_alloc((size_t)p->points, sizeof *residual);
    if (!residual) return SN_E_MEMORY;
    sn_problem_residuals(p, best.x, residual); // tissue and model stresses as of the best
    sn_free(residual);
    r->tissue = p->tissue;
    r->evaluations = p->evaluations;
    say_end(&best, restarts, r);
    judge_all(p, &best, r);
    return fill_curves(p, r);
}

sn_status sn_fit(const sn_fit_def *def, sn_fit_result *result) {
    SN_ASSERT(def && result);
    memset(result, 0, sizeof *result);
    result->tissue = sn_tissue_default();
    sn_problem *problem;
    SN_TRY(sn_problem_create(def, &problem));
    sn_status status = search_and_describe(problem, result);
    sn_problem_destroy(problem);
    if (status != SN_OK) sn_fit_release(result);
    if (status == SN_OK && def->progress) def->progress(def->progress_context, 1.0, "done");
    return status;
}

void sn_fit_release(sn_fit_result *result) {
    if (!result) return;
    for (int k = 0; k < SN_FIT_CURVES_MAX; ++k) sn_free(result->curve[k].predicted);
    memset(result->curve, 0, sizeof result->curve);
    result->curve_count = 0;
}

sn_status sn_fit_predict(const sn_tissue *tissue, const sn_curve *curve, sn_fit_curve *prediction) {
    SN_ASSERT(tissue && curve && prediction);
    *prediction = (sn_fit_curve){.count = curve->count};
    if (!curve->time)
        return sn_fail(SN_E_DATA, "%s: no time column: a prediction needs one", curve->name);
    SN_TRY(sn_tissue_check(tissue));
    sn_history *history = NULL;
    sn_status status;
    SN_TRY_GOTO(status, sn_history_create(1, curve->count, curve->time, curve->stretch, &history));
    status = SN_E_MEMORY;
    prediction->predicted = sn_alloc((size_t)curve->count, sizeof *prediction->predicted);
    if (!prediction->predicted) goto fail;
    SN_TRY_GOTO(status,
                sn_lab_uniaxial(tissue, history, curve->count, curve->time, prediction->predicted));
    judge_curve(curve, prediction);
fail:
    if (status != SN_OK) {
        sn_free(prediction->predicted);
        prediction->predicted = NULL;
    }
    sn_history_destroy(history);
    return status;
}
