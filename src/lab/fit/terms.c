// The choice of a number of terms by AICc.
// SPDX-License-Identifier: Apache-2.0
// Source: Hurvich & Tsai, Regression and time series model selection in small samples, Biometrika
// 76 (1989) 297; what a difference means: Burnham & Anderson, Model selection and multimodel
// inference (2002), section 2.6.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/fit/statistics.h"

enum { PLACES = 12 }; // tried for a new relaxation time or exponent
static const double exponent_least = 1.5, exponent_span = 20.0;
static const double level = 2.0;  // a difference of AICc below it says little
static const double fresh = 0.04; // weight of a new exponential; the others give way

static bool has_terms(const sn_param *params, int count) {
    for (int k = 0; k < count; ++k)
        if (params[k].length == SN_PARAM_LIST) return true;
    return false;
}

static sn_status check(const sn_fit_def *def, bool in_law, int most) {
    bool good = in_law ? def->law && has_terms(def->law->params, def->law->param_count)
                       : def->memory && has_terms(def->memory->params, def->memory->param_count);
    if (!good)
        return sn_fail(SN_E_UNSUPPORTED, "fit: %s %s has no terms to choose the number of: %s",
                       in_law ? "law" : "memory",
                       in_law        ? def->law ? def->law->name : "none"
                       : def->memory ? def->memory->name
                                     : "none",
                       in_law ? "expected ogden" : "expected prony");
    int limit = in_law ? 8 : SN_FIT_TRIALS_MAX;
    if (most < 1 || most > limit)
        return sn_fail(SN_E_RANGE, "fit: up to %d terms of the %s: expected 1 to %d", most,
                       in_law ? "law" : "memory", limit);
    return SN_OK;
}

static sn_fit_def with_terms(const sn_fit_def *def, bool in_law, int terms) {
    sn_fit_def own = *def;
    *(in_law ? &own.law_terms : &own.terms) = terms;
    return own;
}

// Value of a constant of the problem as of `near`, or of a term that `near` has not: an exponential
// with a small weight at a relaxation time, a small stress with an exponent of either sign.
static double value_near(const sn_problem *p, const sn_fit_constant *c, const sn_tissue *near,
                         int place) {
    const sn_param *params = c->in_memory ? near->memory.law->params : near->law->params;
    const double *values = c->in_memory ? near->memory.value : near->value;
    int terms = c->in_memory ? p->tissue.memory.terms : p->tissue.terms;
    int old = c->in_memory ? near->memory.terms : near->terms;
    int k = (int)(c->param - params), i = c->index - sn_param_offset(params, k, terms);
    const double *own = values + sn_param_offset(params, k, old);
    bool list = c->param->length == SN_PARAM_LIST, weight = list && c->in_memory && !c->time;
    if (!list || i < old) return own[i] * (weight && terms > old ? 1.0 - fresh : 1.0);
    if (weight) return 0.9 * fresh;
    double part = (place + 0.5) / PLACES, sign = place % 2 ? -1.0 : 1.0;
    if (c->time) {
        double low = fmin(p->sampling, p->fastest);
        double high = fmax(2.0 * low, fmax(p->record, p->slowest));
        return low * pow(high / low, part);
    }
    return sign * (c->stress ? fresh * fabs(own[0]) : exponent_least * pow(exponent_span, part));
}

sn_status sn_search_near(sn_problem *problem, const sn_tissue *near, sn_found *found) {
    double *residual = sn_alloc((size_t)problem->points, sizeof *residual);
    if (!residual) return SN_E_MEMORY;
    *found = (sn_found){.sum = (double)INFINITY};
    for (int place = 0; place < PLACES; ++place) {
        sn_found trial;
        for (int j = 0; j < problem->free_count; ++j) {
            const sn_fit_constant *c = &problem->constant[problem->free[j]];
            double value = value_near(problem, c, near, place);
            trial.x[j] = sn_problem_scaled(c, fmin(fmax(value, c->low), c->high));
        }
        sn_problem_residuals(problem, trial.x, residual);
        double sum = sn_sum_squares(problem->points, residual);
        if (sum >= found->sum) continue;
        memcpy(found->x, trial.x, sizeof trial.x);
        found->sum = sum;
    }
    sn_free(residual);
    return sn_search_local(problem, NULL, 1e-12, found);
}

static void rank(sn_fit_choice *c) {
    c->best = 0;
    c->second = -1;
    for (int i = 1; i < c->count; ++i)
        if (c->trial[i].aicc < c->trial[c->best].aicc) c->best = i;
    for (int i = 0; i < c->count; ++i)
        if (i != c->best && (c->second < 0 || c->trial[i].aicc < c->trial[c->second].aicc))
            c->second = i;
}

static void say(sn_fit_choice *c, const char *end) {
    const sn_fit_trial *best = &c->trial[c->best], *second = &c->trial[c->second];
    size_t size = sizeof c->reason;
    snprintf(c->reason, size, "%d term%s: least AICc, %.1f", best->terms,
             best->terms == 1 ? "" : "s", best->aicc);
    size_t used = strlen(c->reason);
    if (c->second >= 0) {
        double gap = second->aicc - best->aicc;
        snprintf(c->reason + used, size - used, "; next %d with %.1f more%s", second->terms, gap,
                 gap < level ? ", which is hardly worse" : "");
    }
    used = strlen(c->reason);
    if (c->best == c->count - 1 && !end[0] && c->count > 1)
        end = "; the most that were tried: more may be better";
    snprintf(c->reason + used, size - used, "%s", end);
}

sn_status sn_fit_choose_terms(const sn_fit_def *def, bool in_law, int most, sn_fit_choice *choice,
                              sn_fit_result *result) {
    SN_ASSERT(def && choice && result);
    *choice = (sn_fit_choice){0};
    SN_TRY(check(def, in_law, most));
    char end[SN_TEXT_MAX / 2] = "";
    sn_tissue tissue = sn_tissue_default(), best_tissue = tissue;
    double least = (double)INFINITY;
    for (int terms = 1; terms <= most; ++terms) {
        sn_fit_def own = with_terms(def, in_law, terms);
        sn_status status = sn_fit_trial_of(&own, &tissue, &choice->trial[choice->count]);
        // more terms than the data carry end the trials; nothing else does
        if (choice->count > 0 && (status == SN_E_DATA || status == SN_E_DEFINITION)) {
            snprintf(end, sizeof end, "; no more than %d: %s", choice->count, sn_error_text());
            break;
        }
        SN_TRY(status);
        choice->trial[choice->count].terms = terms;
        if (!(choice->trial[choice->count++].aicc >= least)) {
            least = choice->trial[choice->count - 1].aicc;
            best_tissue = tissue;
        }
    }
    rank(choice);
    sn_fit_trial *best = &choice->trial[choice->best];
    sn_fit_def own = with_terms(def, in_law, best->terms);
    SN_TRY(sn_fit_from(&own, &best_tissue, result));
    best->aicc = result->aicc; // the profiles of a whole fit may have met a better point
    best->r_squared = result->r_squared;
    best->rmse = result->rmse;
    best->converged = result->converged;
    say(choice, end);
    return SN_OK;
}
