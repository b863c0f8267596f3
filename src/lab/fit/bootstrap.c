// Intervals from refits of perturbed data.
// SPDX-License-Identifier: Apache-2.0
// Source: Wu, Jackknife, bootstrap and other resampling methods in regression analysis, Annals of
// Statistics 14 (1986) 1261; signs: Davidson & Flachaire, J. Econometrics 146 (2008) 162; blocks:
// Shao, The dependent wild bootstrap, JASA 105 (2010) 218; their length: Carlstein, Annals of
// Statistics 14 (1986) 1171.
//
// Every residual stays at its row of its curve and only its sign is drawn anew, so that whatever
// the noise does along a curve or from curve to curve is in every set of data. Neighbours share a
// sign over blocks as long as the residuals are correlated: the misfit of a law is not white, and
// refits that took it so would give intervals too narrow. A refit starts from the best constants.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lab/fit/statistics.h"

enum { BLOCKS_LEAST = 5 };         // of a curve: with fewer there is nothing to draw
static const double enough = 1e-3; // change of the sum over its mean square that ends a refit

typedef struct refits {
    sn_problem *problem;
    sn_found best;
    double *model, *noise; // of the best, Pa; the residuals, widened            (points)
    int block[SN_FIT_CURVES_MAX];
    double *value; // of the free constants, natural units               (free_count x asked)
    int done;
    uint64_t state;
} refits;

// splitmix64 (Steele, Lea & Flood 2014)
static double sign(refits *r) {
    uint64_t z = r->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (z ^ (z >> 31)) >> 63 ? 1.0 : -1.0;
}

// Rows that share a sign: 1 where the correlation of neighbours is within its error of 0, else
// Carlstein's length for a first-order process.
static int block_length(int n, const double *residual) {
    double square = 0.0, product = 0.0;
    for (int i = 0; i < n; ++i) {
        square += residual[i] * residual[i];
        if (i > 0) product += residual[i] * residual[i - 1];
    }
    if (!(square > 0.0) || product / square < 2.0 / sqrt(n)) return 1;
    double rho = fmin(product / square, 0.999);
    double length = cbrt(pow(sqrt(6.0) * rho / (1.0 - rho * rho), 2.0) * n);
    return (int)fmax(1.0, fmin(floor(length + 0.5), n / BLOCKS_LEAST));
}

static void prepare(refits *r) {
    sn_problem *p = r->problem;
    double widen = sqrt((double)p->used / (p->used - p->free_count));
    memcpy(r->model, p->model, (size_t)p->points * sizeof *r->model);
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        int rows = sn_problem_rows(&p->def->curve[k]), first = at, used = 0;
        for (int i = at; i < at + rows; ++i) {
            r->noise[i] = widen * (p->measured[i] - p->model[i]);
            if (p->weight[i] == 0.0) continue;
            if (used++ == 0) first = i;
        }
        r->block[k] = block_length(used, r->noise + first);
        at += rows;
    }
}

static void draw(refits *r) {
    sn_problem *p = r->problem;
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        int rows = sn_problem_rows(&p->def->curve[k]);
        double s = 0.0;
        for (int i = 0; i < rows; ++i, ++at) {
            if (i % r->block[k] == 0) s = sign(r);
            p->measured[at] = r->model[at] + s * r->noise[at];
        }
    }
}

static sn_status refit_all(refits *r) {
    sn_problem *p = r->problem;
    const sn_fit_def *def = p->def;
    for (int i = 0; i < def->bootstrap; ++i) {
        sn_found found = r->best;
        draw(r);
        SN_TRY(sn_search_local(p, NULL, enough / p->used, &found));
        if (def->progress)
            def->progress(def->progress_context, 0.8 + 0.2 * i / def->bootstrap, "bootstrap");
        if (found.info < 1 || found.info == 5 || !isfinite(found.sum)) continue;
        for (int j = 0; j < p->free_count; ++j)
            r->value[j * def->bootstrap + r->done] =
                sn_problem_natural(&p->constant[p->free[j]], found.x[j]);
        r->done++;
    }
    return SN_OK;
}

static int rising(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// of sorted values, straight between them
static double quantile(int n, const double *sorted, double q) {
    double at = q * (n - 1);
    int i = (int)at < n - 2 ? (int)at : n - 2;
    return sorted[i] + (at - i) * (sorted[i + 1] - sorted[i]);
}

static void conclude(refits *r, sn_fit_result *result) {
    const sn_problem *p = r->problem;
    sn_fit_bootstrap *b = &result->bootstrap;
    b->done = r->done;
    for (int k = 0; k < p->def->curve_count; ++k)
        b->block = r->block[k] > b->block ? r->block[k] : b->block;
    bool few = r->done < SN_FIT_BOOTSTRAP_MIN;
    if (few)
        snprintf(b->reason, sizeof b->reason,
                 "no intervals: only %d of %d refits converged, and the percentiles need %d",
                 r->done, b->asked, SN_FIT_BOOTSTRAP_MIN);
    else if (r->done < b->asked)
        snprintf(b->reason, sizeof b->reason,
                 "%d of %d refits did not converge and are left out of the intervals",
                 b->asked - r->done, b->asked);
    const char *bound = NULL;
    for (int k = 0; k < result->param_count; ++k)
        if (result->param[k].at_bound) bound = result->param[k].name;
    size_t said = strlen(b->reason);
    if (bound)
        snprintf(b->reason + said, sizeof b->reason - said,
                 "%s%s stands at its bound and the refits stay there: intervals of what is tied to "
                 "it are too narrow",
                 said ? "; " : "", bound);
    for (int j = 0; j < p->free_count && !few; ++j) {
        double *value = r->value + (size_t)j * (size_t)b->asked;
        double *ci = result->param[p->free[j]].ci95_bootstrap;
        qsort(value, (size_t)r->done, sizeof *value, rising);
        ci[0] = quantile(r->done, value, 0.025);
        ci[1] = quantile(r->done, value, 0.975);
    }
}

sn_status sn_bootstrap(sn_problem *problem, const sn_found *best, sn_fit_result *result) {
    size_t points = (size_t)problem->points, asked = (size_t)problem->def->bootstrap;
    refits r = {.problem = problem, .best = *best, .state = problem->def->seed};
    result->bootstrap = (sn_fit_bootstrap){.asked = problem->def->bootstrap};
    sn_status status = SN_E_MEMORY;
    r.model = sn_alloc(2 * points, sizeof *r.model);
    r.value = sn_alloc(asked * (size_t)problem->free_count, sizeof *r.value);
    if (!r.model || !r.value) goto fail;
    r.noise = r.model + points;
    prepare(&r);
    SN_TRY_GOTO(status, refit_all(&r));
    conclude(&r, result);
fail:
    sn_free(r.value);
    sn_free(r.model);
    return status;
}
