// Intervals from the likelihood profile.
// SPDX-License-Identifier: Apache-2.0
// Source: Raue et al., Structural and practical identifiability analysis of partially observed
// dynamical models by exploiting the profile likelihood, Bioinformatics 25 (2009) 1923.
//
// The linearised interval is wrong where the valley of the sum of squares is long and bent, which
// is the rule for relaxation times that the test hardly shows. The profile follows the valley: it
// moves one constant away from the best, fits the others anew from where they were last, and stops
// where the sum reaches its limit or the bound of the search.
#include <math.h>

#include "lab/fit/statistics.h"

enum { OUTWARD = 12, INWARD = 8 };

typedef struct walk {
    sn_problem *problem;
    int j;
    double limit;  // of the sum of squares
    sn_found last; // where the others were fitted last
} walk;

// the sum at x[j] = value, the other constants fitted
static sn_status profile_at(walk *w, double value, double *sum) {
    bool hold[SN_FIT_PARAMS_MAX] = {false};
    hold[w->j] = true;
    sn_found trial = w->last;
    trial.x[w->j] = value;
    SN_TRY(sn_search_local(w->problem, hold, 1e-5, &trial));
    *sum = trial.sum;
    if (trial.sum <= w->limit) w->last = trial;
    return SN_OK;
}

// from the best towards `bound`; *end is where the limit is reached
static sn_status walk_to(walk *w, double from, double first, double bound, double *end) {
    double sign = bound > from ? 1.0 : -1.0, inside = from, outside = bound, sum = 0.0;
    double inside_sum = w->last.sum, outside_sum = (double)INFINITY;
    for (int i = 0; i < OUTWARD && outside_sum > w->limit; ++i) {
        double x = from + sign * first * pow(2.0, i);
        if (i == OUTWARD - 1 || sign * (bound - x) <= 0.0) x = bound;
        SN_TRY(profile_at(w, x, &sum));
        if (sum > w->limit) {
            outside = x;
            outside_sum = sum;
            break;
        }
        inside = x;
        inside_sum = sum;
        if (x == bound) {
            *end = bound;
            return SN_OK;
        }
    }
    for (int i = 0; i < INWARD && fabs(outside - inside) > 0.02 * fabs(outside - from); ++i) {
        // the root of the sum is nearly straight in x; kept off the ends
        double a = sqrt(fmax(0.0, inside_sum)), b = sqrt(outside_sum), t = sqrt(w->limit);
        double part = isfinite(b) && b > a ? (t - a) / (b - a) : 0.5;
        part = i % 2 ? 0.5 : fmin(0.9, fmax(0.1, part));
        double x = inside + part * (outside - inside);
        SN_TRY(profile_at(w, x, &sum));
        if (sum > w->limit) {
            outside = x;
            outside_sum = sum;
        } else {
            inside = x;
            inside_sum = sum;
        }
    }
    *end = 0.5 * (inside + outside);
    return SN_OK;
}

sn_status sn_profile(sn_problem *problem, const sn_found *best, const sn_spread *spread, int j,
                     double interval[2], sn_found *better, bool *improved) {
    const sn_fit_constant *c = &problem->constant[problem->free[j]];
    double bound[2] = {sn_problem_scaled(c, c->low), sn_problem_scaled(c, c->high)};
    double nu = problem->used - problem->free_count, range = bound[1] - bound[0];
    double t = spread->student, first = fmin(fmax(t * spread->error[j], 1e-4 * range), 0.1 * range);
    *improved = false;
    for (int side = 0; side < 2; ++side) {
        walk w = {.problem = problem, .j = j, .last = *best};
        w.limit = best->sum * (1.0 + t * t / nu);
        if (fabs(bound[side] - best->x[j]) <= 1e-3 * range) {
            interval[side] = bound[side];
            continue;
        }
        SN_TRY(walk_to(&w, best->x[j], first, bound[side], &interval[side]));
        if (w.last.sum < best->sum * (1.0 - 1e-5)) {
            *better = w.last;
            *improved = true;
            return SN_OK;
        }
    }
    return SN_OK;
}
