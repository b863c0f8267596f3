// Fitting of curves to a tissue, and prediction of a curve by a tissue.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (14), (33)-(38): elastic and memory law together, through the recorded history.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/fit/statistics.h"
#include "lab/protocol/protocol.h"

enum { RESTARTS = 4 }; // profiles that met a better point

sn_fit_def sn_fit_def_default(void) {
    return (sn_fit_def){.terms = 3,
                        .law_terms = 1,
                        .starts = 6,
                        .seed = 1,
                        .from = -(double)INFINITY,
                        .to = (double)INFINITY};
}

// fills all but what is predicted from it, over the rows of the window
static void judge_curve(const sn_curve *curve, sn_fit_curve *out) {
    double mean = 0.0, sse = 0.0, sst = 0.0, largest = -1.0, steps = 0.0;
    int end = out->first + out->used, axes = sn_curve_measured(curve, 1) ? 2 : 1;
    double n = (double)axes * out->used;
    for (int axis = 0; axis < axes; ++axis) {
        const double *measured = sn_curve_measured(curve, axis);
        for (int i = out->first; i < end; ++i) mean += measured[i] / n;
    }
    for (int axis = 0; axis < axes; ++axis) {
        const double *measured = sn_curve_measured(curve, axis);
        const double *predicted = axis ? out->predicted_2 : out->predicted;
        double last = 0.0;
        for (int i = out->first; i < end; ++i) {
            double residual = predicted[i] - measured[i];
            sse += residual * residual;
            sst += (measured[i] - mean) * (measured[i] - mean);
            if (i > out->first) steps += (residual - last) * (residual - last);
            last = residual;
            out->peak = fmax(out->peak, fabs(measured[i]));
            if (fabs(residual) > largest) {
                largest = fabs(residual);
                out->worst = i;
                out->second = axis == 1;
            }
        }
    }
    out->rmse = sqrt(sse / n);
    out->r_squared = sst > 0.0 ? 1.0 - sse / sst : (double)NAN;
    out->durbin_watson = sse > 0.0 ? steps / sse : (double)NAN;
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
    if (sn_curve_measured(curve, 1))
        SN_TRY(copy(curve->count, stress + curve->count, &out->predicted_2));
    judge_curve(curve, out);
    return SN_OK;
}

static void judge_all(const sn_problem *p, const sn_found *best, sn_fit_result *r) {
    double mean = 0.0, sse = 0.0, sst = 0.0, n = p->used, weights = 0.0;
    for (int i = 0; i < p->points; ++i)
        if (p->weight[i] > 0.0) mean += p->measured[i] / n;
    for (int i = 0; i < p->points; ++i) {
        if (p->weight[i] == 0.0) continue;
        sse += (p->model[i] - p->measured[i]) * (p->model[i] - p->measured[i]);
        sst += (p->measured[i] - mean) * (p->measured[i] - mean);
        weights += 2.0 * log(p->weight[i]);
    }
    r->points = p->used;
    r->r_squared = sst > 0.0 ? 1.0 - sse / sst : (double)NAN;
    r->rmse = sqrt(sse / n);
    r->nrmse = r->rmse / p->peak;
    // the variance of the noise is fitted as well, by curve where it is asked for by curve
    double variances = p->def->weighting == SN_FIT_NOISE ? p->def->curve_count : 1.0;
    double k = p->free_count + variances, room = n - k - 1.0;
    double likelihood = n * log(fmax(best->sum, 1e-300) / n) - weights + 2.0 * k;
    r->aicc = room > 0.0 ? likelihood + 2.0 * k * (k + 1.0) / room : (double)INFINITY;
}

static sn_status fill_curves(const sn_problem *p, sn_fit_result *r) {
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        const sn_curve *curve = &p->def->curve[k];
        sn_fit_curve *out = &r->curve[r->curve_count++];
        for (int i = curve->count - 1; i >= 0; --i) {
            if (p->weight[at + i] == 0.0) continue;
            out->first = i;
            out->used++;
            out->weight = p->weight[at + i] * p->weight[at + i];
        }
        SN_TRY(take_prediction(curve, p->model + at, out));
        at += sn_problem_rows(curve);
    }
    return SN_OK;
}

static void say_end(const sn_found *best, int restarts, bool settled, sn_fit_result *r) {
    r->converged = best->info >= 1 && best->info != 5 && settled;
    snprintf(r->reason, sizeof r->reason, "%s after %d evaluations%s%s",
             r->converged      ? "converged"
             : !settled        ? "the weights by the noise of the curves did not settle"
             : best->info == 5 ? "stopped at the limit of evaluations of the local search"
                               : "the local search failed",
             r->evaluations,
             restarts ? "; a profile met a better point and the search went on from it" : "",
             restarts == RESTARTS ? ", as often as allowed: the best may not be found" : "");
}

static sn_status search(sn_problem *p, const sn_tissue *near, sn_found *best, bool *settled) {
    *settled = true;
    sn_status status = sn_search(p, best);
    if (near && (status == SN_OK || status == SN_E_SOLVER)) {
        sn_found other;
        SN_TRY(sn_search_near(p, near, &other));
        if (status != SN_OK || other.sum < best->sum) *best = other;
        status = SN_OK;
    }
    if (status != SN_OK || p->def->weighting != SN_FIT_NOISE) return status;
    return sn_weigh_noise(p, best, settled);
}

// model stresses as of the best
static sn_status set_model(sn_problem *p, const sn_found *best) {
    double *residual = sn_alloc((size_t)p->points, sizeof *residual);
    if (!residual) return SN_E_MEMORY;
    sn_problem_residuals(p, best->x, residual);
    sn_free(residual);
    return SN_OK;
}

static sn_status search_and_describe(sn_problem *p, const sn_tissue *near, sn_fit_result *r) {
    sn_found best;
    bool moved = true, settled;
    int restarts = 0;
    SN_TRY(search(p, near, &best, &settled));
    sn_problem_settle(p, best.x);
    while (moved) {
        if (p->def->progress) p->def->progress(p->def->progress_context, 0.75, "intervals");
        SN_TRY(sn_describe(p, &best, restarts == RESTARTS, r, &moved));
        if (!moved) break;
        restarts++;
        SN_TRY(sn_search_local(p, NULL, 1e-12, &best));
        sn_problem_settle(p, best.x);
    }
    SN_TRY(set_model(p, &best));
    r->tissue = p->tissue;
    r->evaluations = p->evaluations;
    say_end(&best, restarts, settled, r);
    judge_all(p, &best, r);
    SN_TRY(fill_curves(p, r));
    return p->def->bootstrap > 0 ? sn_bootstrap(p, &best, r) : SN_OK;
}

// the problem of a definition with its weights worked out; *own and weight outlive it
static sn_status create(const sn_fit_def *def, sn_fit_def *own, double *weight,
                        sn_problem **problem) {
    *own = *def;
    if (def->bootstrap != 0 && def->bootstrap < SN_FIT_BOOTSTRAP_MIN)
        return sn_fail(SN_E_RANGE, "fit: %d bootstrap refits: expected 0 or at least %d",
                       def->bootstrap, SN_FIT_BOOTSTRAP_MIN);
    bool curves = def->curve && def->curve_count > 0 && def->curve_count <= SN_FIT_CURVES_MAX;
    for (int k = 0; curves && k < def->curve_count; ++k) {
        const sn_curve *curve = &def->curve[k];
        int in = 0;
        for (int i = 0; i < curve->count; ++i) in += sn_problem_in_window(def, curve, i);
        if (curve->count > 0 && in == 0)
            return sn_fail(SN_E_DATA, "%s: no row from %g to %g s: it ends at %g s", curve->name,
                           def->from, def->to, curve->time[curve->count - 1]);
    }
    if (curves && def->weighting == SN_FIT_PEAK) {
        SN_TRY(sn_weigh_peaks(def, weight));
        own->weight = weight;
    }
    return sn_problem_create(own, problem);
}

sn_status sn_fit_from(const sn_fit_def *def, const sn_tissue *near, sn_fit_result *result) {
    SN_ASSERT(def && result);
    memset(result, 0, sizeof *result);
    result->tissue = sn_tissue_default();
    sn_problem *problem;
    sn_fit_def own;
    double weight[SN_FIT_CURVES_MAX];
    SN_TRY(create(def, &own, weight, &problem));
    sn_status status = search_and_describe(problem, near, result);
    sn_problem_destroy(problem);
    if (status != SN_OK) sn_fit_release(result);
    if (status == SN_OK && def->progress) def->progress(def->progress_context, 1.0, "done");
    return status;
}

sn_status sn_fit(const sn_fit_def *def, sn_fit_result *result) {
    return sn_fit_from(def, NULL, result);
}

sn_status sn_fit_trial_of(const sn_fit_def *def, sn_tissue *tissue, sn_fit_trial *trial) {
    sn_problem *problem;
    sn_fit_def own;
    sn_found best;
    bool settled;
    double weight[SN_FIT_CURVES_MAX];
    SN_TRY(create(def, &own, weight, &problem));
    sn_fit_result *result = sn_alloc(1, sizeof *result);
    sn_status status = SN_E_MEMORY;
    if (result) status = search(problem, tissue->law ? tissue : NULL, &best, &settled);
    if (status == SN_OK) status = set_model(problem, &best);
    if (status == SN_OK) {
        judge_all(problem, &best, result);
        *tissue = problem->tissue;
        *trial = (sn_fit_trial){.constants = problem->free_count,
                                .converged = settled && best.info >= 1 && best.info != 5,
                                .r_squared = result->r_squared,
                                .rmse = result->rmse,
                                .aicc = result->aicc};
    }
    sn_free(result);
    sn_problem_destroy(problem);
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
    if (tissue->branched)
        return sn_fail(SN_E_UNSUPPORTED,
                       "%s: a branch memory and a %s curve: a prediction takes uniaxial curves, or "
                       "a tissue with one memory",
                       curve->name, sn_curve_kind_name(curve->kind));
    SN_TRY(sn_in_plane_check(tissue, curve));
    SN_TRY(sn_memory_expand(&tissue->memory, &e));
    SN_TRY(sn_in_plane_create(curve, curve->time, tissue->law, memory, &path));
    sn_status status = sn_in_plane_stress(path, tissue, &e, stress);
    sn_in_plane_destroy(path);
    return status;
}

static sn_status predict_dynamic(const sn_tissue *tissue, const sn_curve *curve, double *moduli) {
    sn_status status = sn_dynamic_moduli(tissue, curve->mean_stretch, curve->count,
                                         curve->frequency, moduli, moduli + curve->count);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "%s", curve->name);
}

sn_status sn_fit_predict(const sn_tissue *tissue, const sn_curve *curve, sn_fit_curve *prediction) {
    SN_ASSERT(tissue && curve && prediction);
    *prediction = (sn_fit_curve){.used = curve->count, .weight = 1.0};
    sn_curve timed = *curve; // without a memory time does not matter: row numbers stand for it
    double *rows = NULL, *stress = NULL;
    SN_TRY(sn_tissue_check(tissue));
    bool dynamic = curve->kind == SN_CURVE_DYNAMIC;
    if (!curve->time && !dynamic && tissue->memory.law->param_count > 0)
        return sn_fail(SN_E_DATA, "%s: no time column: a prediction with memory %s needs one",
                       curve->name, tissue->memory.law->name);
    sn_status status = SN_E_MEMORY;
    rows = sn_alloc((size_t)curve->count, sizeof *rows);
    stress = sn_alloc((size_t)sn_problem_rows(curve), sizeof *stress);
    if (!rows || !stress) goto fail;
    for (int i = 0; i < curve->count; ++i) rows[i] = i;
    if (!timed.time) timed.time = rows;
    SN_TRY_GOTO(status,
                (dynamic                            ? predict_dynamic
                 : curve->kind == SN_CURVE_UNIAXIAL ? predict_uniaxial
                                                    : predict_in_plane)(tissue, &timed, stress));
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
