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

// fills all but what is predicted from it
static void judge_curve(const sn_curve *curve, sn_fit_curve *out) {
    double mean = 0.0, sse = 0.0, sst = 0.0, largest = -1.0;
    int rows = sn_problem_rows(curve), n = curve->count;
    for (int i = 0; i < rows; ++i)
        mean += (i < n ? curve->stress[i] : curve->stress_2[i - n]) / rows;
    for (int i = 0; i < rows; ++i) {
        double measured = i < n ? curve->stress[i] : curve->stress_2[i - n];
        double predicted = i < n ? out->predicted[i] : out->predicted_2[i - n];
        double residual = fabs(predicted - measured);
        sse += residual * residual;
        sst += (measured - mean) * (measured - mean);
        out->peak = fmax(out->peak, fabs(measured));
        if (residual > largest) {
            largest = residual;
            out->worst = i % n;
            out->second = i >= n;
        }
    }
    out->rmse = sqrt(sse / rows);
    out->r_squared = sst > 0.0 ? 1.0 - sse / sst : (double)NAN;
}

// a copy of n numbers into *to
static sn_status copy(int n, const double *from, double **to) {
    *to = sn_alloc((size_t)n, sizeof **to);
    if (!*to) return SN_E_MEMORY;
    memcpy(*to, from, (size_t)n * sizeof **to);
    return SN_OK;
}

// predicted stresses of both axes from one array
static sn_status take_prediction(const sn_curve *curve, const double *stress, sn_fit_curve *out) {
    out->count = curve->count;
    SN_TRY(copy(curve->count, stress, &out->predicted));
    if (curve->kind == SN_CURVE_BIAXIAL)
        SN_TRY(copy(curve->count, stress + curve->count, &out->predicted_2));
    judge_curve(curve, out);
    return SN_OK;
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
        SN_TRY(take_prediction(curve, p->model + at, &r->curve[r->curve_count++]));
        at += sn_problem_rows(curve);
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
    sn_problem_settle(p, best.x);
    bool moved = true;
    int restarts = 0;
    while (moved) {
        if (p->def->progress) p->def->progress(p->def->progress_context, 0.75, "intervals");
        SN_TRY(sn_describe(p, &best, restarts == RESTARTS, r, &moved));
        if (!moved) break;
        restarts++;
        SN_TRY(sn_search_local(p, NULL, 1e-12, &best));
        sn_problem_settle(p, best.x);
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
    for (int k = 0; k < SN_FIT_CURVES_MAX; ++k) {
        sn_free(result->curve[k].predicted);
        sn_free(result->curve[k].predicted_2);
    }
    memset(result->curve, 0, sizeof result->curve);
    result->curve_count = 0;
}

static sn_status predict_uniaxial(const sn_tissue *tissue, const sn_curve *curve, double *stress) {
    sn_history *history;
    SN_TRY(sn_history_create(1, curve->count, curve->time, curve->stretch, &history));
    sn_status status = sn_lab_uniaxial(tissue, history, curve->count, curve->time, stress);
    sn_history_destroy(history);
    return status;
}

static sn_status predict_in_plane(const sn_tissue *tissue, const sn_curve *curve, double *stress) {
    bool memory = tissue->memory.law->param_count > 0;
    sn_exponentials e;
    sn_in_plane *path;
    SN_TRY(sn_in_plane_check(tissue, curve));
    SN_TRY(sn_memory_expand(&tissue->memory, &e));
    SN_TRY(sn_in_plane_create(curve, curve->time, tissue->law, memory, &path));
    sn_status status = sn_in_plane_stress(path, tissue, &e, stress);
    sn_in_plane_destroy(path);
    return status;
}

sn_status sn_fit_predict(const sn_tissue *tissue, const sn_curve *curve, sn_fit_curve *prediction) {
    SN_ASSERT(tissue && curve && prediction);
    *prediction = (sn_fit_curve){.count = curve->count};
    sn_curve timed = *curve; // without a memory time does not matter: row numbers stand for it
    double *rows = NULL, *stress = NULL;
    SN_TRY(sn_tissue_check(tissue));
    if (!curve->time && tissue->memory.law->param_count > 0)
        return sn_fail(SN_E_DATA, "%s: no time column: a prediction with memory %s needs one",
                       curve->name, tissue->memory.law->name);
    sn_status status = SN_E_MEMORY;
    rows = sn_alloc((size_t)curve->count, sizeof *rows);
    stress = sn_alloc((size_t)sn_problem_rows(curve), sizeof *stress);
    if (!rows || !stress) goto fail;
    for (int i = 0; i < curve->count; ++i) rows[i] = i;
    if (!timed.time) timed.time = rows;
    SN_TRY_GOTO(status, (curve->kind == SN_CURVE_UNIAXIAL ? predict_uniaxial : predict_in_plane)(
                            tissue, &timed, stress));
    SN_TRY_GOTO(status, take_prediction(curve, stress, prediction));
fail:
    if (status != SN_OK) {
        sn_free(prediction->predicted);
        sn_free(prediction->predicted_2);
        prediction->predicted = prediction->predicted_2 = NULL;
    }
    sn_free(rows);
    sn_free(stress);
    return status;
}
