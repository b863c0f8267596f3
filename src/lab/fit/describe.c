// Values, intervals and identifiability of the constants of a fit, in words.
// SPDX-License-Identifier: Apache-2.0
//
// A constant is called identifiable unless one of these holds; the first that does is the reason.
//  1. It is a relaxation time that the test cannot show: under a third of the fastest ramp (the
//     ramp hides it), under the shortest sampling interval of a ramp, or over the longest record;
//     a sweep shows times from 1/omega of its fastest to that of its slowest oscillation, so what
//     lies between is not hidden; and its interval is at least moderately wide, see 5.
//  2. It stands at a bound of the search, or a Fung law at the limit of its convexity.
//  3. Its 95 % interval is open: it reaches a bound of the search.
//  4. Its interval is wide: ends more than a factor of 10 apart where the scale is the logarithm,
//     or more than the value apart where it is not.
//  5. Its interval is moderately wide (a factor of 2, or 0.7 of the value) and it is tied to
//     another constant by a correlation beyond 0.98: only a combination of the two is known.
//  6. Its interval is not narrow (ends 1.25 times apart, or a quarter of the value) and it is tied
//     by a correlation beyond 0.98 to a constant whose interval is open: the bounds of the search
//     cut its interval, not the data.
// Where all curves have one loading ratio, or are sweeps about one stretch, that takes the place of
// the reason of 2 to 6.
// A correlation alone is no reason: B and C of an exponential law are tied in every test, and
// narrow intervals of both say that the data tell them apart.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/fit/fung.h"
#include "lab/fit/statistics.h"

static const double hidden = 1.0 / 3.0, wide_factor = 10.0, wide_part = 1.0;
static const double moderate_factor = 2.0, moderate_part = 0.7, tied = 0.98;
static const double narrow_factor = 1.25, narrow_part = 0.25;

// wider than the factor (logarithmic constants) or part of the value (the others)
static bool wider(const sn_fit_constant *c, const sn_fit_param *p, double factor, double part) {
    if (c->param->log_scale) return p->ci95[1] > factor * p->ci95[0];
    return p->ci95[1] - p->ci95[0] > part * fabs(p->value);
}

// in the scale of the fit, where a bound may be 18 e-folds away
static bool meets(const sn_fit_constant *c, double value, double bound) {
    double range = sn_problem_scaled(c, c->high) - sn_problem_scaled(c, c->low);
    return fabs(sn_problem_scaled(c, value) - sn_problem_scaled(c, bound)) <= 2e-3 * range;
}

static void linear_interval(const sn_fit_constant *c, double x, double half, sn_fit_param *p) {
    p->ci95[0] = sn_problem_natural(c, x - half);
    p->ci95[1] = sn_problem_natural(c, x + half);
}

// the error that has the same interval, so that errors and intervals tell one story
static void from_profile(const sn_fit_constant *c, const double interval[2], double student,
                         sn_fit_param *p) {
    for (int side = 0; side < 2; ++side) p->ci95[side] = sn_problem_natural(c, interval[side]);
    double error = (interval[1] - interval[0]) / (2.0 * student);
    p->standard_error = error * (c->param->log_scale ? p->value : 1.0);
}

static bool because_of_time(const sn_problem *problem, const sn_fit_constant *c, sn_fit_param *p) {
    // a narrow interval shows that the data do see it
    if (!c->time || !wider(c, p, moderate_factor, moderate_part)) return false;
    double fastest = problem->fastest, slowest = problem->slowest; // of sweeps
    if (p->value < fmin(problem->sampling, fastest) && fastest <= problem->sampling)
        snprintf(p->reason, sizeof p->reason,
                 "shorter than 1/omega of the fastest oscillation, %.3g s", fastest);
    else if (p->value >= fastest && p->value <= slowest)
        return false;
    else if (isfinite(problem->sampling) && p->value < problem->sampling)
        snprintf(p->reason, sizeof p->reason,
                 "shorter than the shortest sampling interval of a ramp, %.3g s",
                 problem->sampling);
    else if (isfinite(problem->ramp) && p->value < hidden * problem->ramp)
        snprintf(p->reason, sizeof p->reason,
                 "hidden by the ramp: under a third of the fastest ramp, %.3g s", problem->ramp);
    else if (p->value > fmax(problem->record, slowest) && slowest > problem->record)
        snprintf(p->reason, sizeof p->reason,
                 "longer than 1/omega of the slowest oscillation, %.3g s", slowest);
    else if (p->value > problem->record)
        snprintf(p->reason, sizeof p->reason, "longer than the longest record, %.3g s",
                 problem->record);
    return p->reason[0] != 0;
}

// " Pa", or nothing for a pure number
static const char *unit_text(const sn_fit_constant *c) {
    static _Thread_local char text[SN_NAME_MAX + 1];
    snprintf(text, sizeof text, " %s", c->param->unit);
    return strcmp(c->param->unit, "1") == 0 ? "" : text;
}

static bool because_of_interval(const sn_fit_constant *c, sn_fit_param *p) {
    bool low = meets(c, p->ci95[0], c->low), high = meets(c, p->ci95[1], c->high);
    if (low || high)
        snprintf(p->reason, sizeof p->reason,
                 "its 95 %% interval is open %s: it reaches the bound%s of the search",
                 low && high ? "on both sides"
                 : low       ? "below"
                             : "above",
                 low && high ? "s" : "");
    else if (wider(c, p, wide_factor, wide_part))
        snprintf(p->reason, sizeof p->reason, "its 95 %% interval is wide: %.3g to %.3g%s",
                 p->ci95[0], p->ci95[1], unit_text(c));
    return p->reason[0] != 0;
}

static void because_of_tie(const sn_problem *problem, const sn_spread *spread, int j,
                           sn_fit_param *p) {
    const sn_fit_constant *c = &problem->constant[problem->free[j]];
    if (!wider(c, p, moderate_factor, moderate_part)) return;
    int n = problem->free_count, partner = -1;
    for (int k = 0; k < n; ++k)
        if (k != j && (partner < 0 || fabs(spread->correlation[j * n + k]) >
                                          fabs(spread->correlation[j * n + partner])))
            partner = k;
    if (partner < 0 || !(fabs(spread->correlation[j * n + partner]) > tied)) return;
    snprintf(p->reason, sizeof p->reason,
             "tied to %s (correlation %.3f): only a combination of the two is known",
             problem->constant[problem->free[partner]].name, spread->correlation[j * n + partner]);
}

static bool open_ended(const sn_fit_constant *c, const sn_fit_param *p) {
    return meets(c, p->ci95[0], c->low) || meets(c, p->ci95[1], c->high);
}

static void because_of_open_partners(const sn_problem *problem, const sn_spread *spread,
                                     sn_fit_result *result) {
    int n = problem->free_count;
    for (int j = 0; j < n; ++j) {
        sn_fit_param *p = &result->param[problem->free[j]];
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        for (int k = 0; k < n && p->identifiable; ++k) {
            const sn_fit_constant *other = &problem->constant[problem->free[k]];
            double r = spread->correlation[j * n + k];
            if (k == j || fabs(r) <= tied || !wider(c, p, narrow_factor, narrow_part)) continue;
            if (!open_ended(other, &result->param[problem->free[k]])) continue;
            snprintf(p->reason, sizeof p->reason,
                     "tied to %s (correlation %.3f), whose interval is open: the bounds of the "
                     "search cut this one",
                     other->name, r);
            p->identifiable = false;
        }
    }
}

static void judge(const sn_problem *problem, const sn_spread *spread, int j, sn_fit_param *p) {
    const sn_fit_constant *c = &problem->constant[problem->free[j]];
    bool low = meets(c, p->value, c->low), high = meets(c, p->value, c->high);
    p->at_bound = low || high;
    p->reason[0] = 0;
    if (because_of_time(problem, c, p)) {
        // why comes before where: a time that runs to its bound does so because it is hidden
    } else if (p->at_bound) {
        snprintf(p->reason, sizeof p->reason, "at the %s bound of the search, %.4g%s",
                 low ? "lower" : "upper", low ? c->low : c->high, unit_text(c));
    } else if (!c->in_memory &&
               sn_fung_at_limit(problem->tissue.law, problem->tissue.value, c->index)) {
        p->at_bound = true;
        snprintf(p->reason, sizeof p->reason,
                 "at the limit of convexity: without it the data would go beyond");
    } else if (!because_of_interval(c, p)) {
        because_of_tie(problem, spread, j, p);
    }
    p->identifiable = p->reason[0] == 0;
}

// The ratio E22/E11 where all curves together have only one, else NAN. Rows of under a third of the
// largest strain do not count: their ratio is noise.
static double one_ratio(const sn_problem *problem) {
    static const double spread = 0.05; // radians
    double low = (double)INFINITY, high = -(double)INFINITY, size = 0.0;
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < problem->def->curve_count; ++k) {
            const sn_curve *c = &problem->def->curve[k];
            if (c->kind != SN_CURVE_BIAXIAL) return (double)NAN;
            for (int i = 0; i < c->count; ++i) {
                double x = 0.5 * (c->stretch[i] * c->stretch[i] - 1.0);
                double y = 0.5 * (c->stretch_2[i] * c->stretch_2[i] - 1.0), r = hypot(x, y);
                if (pass == 0) size = fmax(size, r);
                if (pass == 0 || r < size / 3.0) continue;
                low = fmin(low, atan2(y, x));
                high = fmax(high, atan2(y, x));
            }
        }
    return high - low < spread ? tan(0.5 * (low + high)) : (double)NAN;
}

static const char *name_at(const sn_problem *problem, int index) {
    for (int k = 0; k < problem->count; ++k)
        if (!problem->constant[k].in_memory && problem->constant[k].index == index)
            return problem->constant[k].name;
    return "";
}

// Says of the constants that were found wanting that all curves load alike, if they do, and what
// of a planar Fung form is known then: S11 = c X (a1 + r a4) E11, S22 = c X (a2 + a4/r) E22.
static void because_of_ratio(const sn_problem *problem, sn_fit_result *result) {
    double r = one_ratio(problem);
    if (!isfinite(r)) return;
    const sn_fung_form *form;
    int forms = sn_fung_forms(problem->tissue.law, &form);
    for (int j = 0; j < problem->free_count; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        sn_fit_param *p = &result->param[problem->free[j]];
        char known[SN_TEXT_MAX];
        if (p->identifiable || c->in_memory) continue;
        snprintf(known, sizeof known, "the data do not tell apart what makes up %.150s",
                 result->weakest);
        for (int k = 0; k < forms && form[k].normal[2] < 0; ++k) {
            if (c->index != form[k].normal[0] && c->index != form[k].normal[1] &&
                c->index != form[k].cross[0])
                continue;
            const char *cross = name_at(problem, form[k].cross[0]);
            snprintf(known, sizeof known, "only %.20s %+.3g %.20s and %.20s %+.3g %.20s are known",
                     name_at(problem, form[k].normal[0]), r, cross,
                     name_at(problem, form[k].normal[1]), 1.0 / r, cross);
        }
        snprintf(p->reason, sizeof p->reason, "one loading ratio: E22/E11 is %.3g throughout, %s",
                 r, known);
    }
}

// The same where all curves are sweeps about one stretch: of the law they know one slope.
static void because_of_one_stretch(const sn_problem *problem, sn_fit_result *result) {
    const sn_curve *curve = problem->def->curve;
    int elastic = 0; // constants that are searched
    for (int k = 0; k < problem->def->curve_count; ++k)
        if (curve[k].kind != SN_CURVE_DYNAMIC || curve[k].mean_stretch != curve[0].mean_stretch)
            return;
    for (int j = 0; j < problem->free_count; ++j)
        elastic += !problem->constant[problem->free[j]].in_memory;
    for (int j = 0; j < problem->free_count && elastic > 1; ++j) {
        sn_fit_param *p = &result->param[problem->free[j]];
        if (p->identifiable || problem->constant[problem->free[j]].in_memory) continue;
        snprintf(p->reason, sizeof p->reason,
                 "every sweep is about the stretch %g: what they know of the law is its slope "
                 "there; add sweeps about other stretches, or a pull",
                 curve[0].mean_stretch);
    }
}

static void describe_constants(const sn_problem *problem, sn_fit_result *result) {
    result->param_count = problem->count;
    for (int k = 0; k < problem->count; ++k) {
        const sn_fit_constant *c = &problem->constant[k];
        sn_fit_param *p = &result->param[k];
        *p = (sn_fit_param){.fixed = !c->free, .identifiable = true, .standard_error = (double)NAN};
        p->ci95[0] = p->ci95[1] = p->ci95_bootstrap[0] = p->ci95_bootstrap[1] = (double)NAN;
        p->value = (c->in_memory ? problem->tissue.memory.value : problem->tissue.value)[c->index];
        if (c->tied)
            snprintf(p->reason, sizeof p->reason,
                     "no curve sees it: set to what an isotropic law would have");
        snprintf(p->name, sizeof p->name, "%s", c->name);
        snprintf(p->unit, sizeof p->unit, "%s", c->param->unit);
    }
}

static void describe_correlation(const sn_problem *problem, const sn_spread *spread,
                                 sn_fit_result *result) {
    int n = problem->free_count, all = problem->count;
    memset(result->correlation, 0, sizeof result->correlation);
    for (int k = 0; k < all; ++k) result->correlation[k * all + k] = 1.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            result->correlation[problem->free[i] * all + problem->free[j]] =
                spread->correlation[i * n + j];
    // the combination that the data know least, its small parts left out
    result->condition = spread->condition;
    result->weakest[0] = 0;
    for (int j = 0; j < n; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        if (fabs(spread->weakest[j]) < 0.2) continue;
        size_t used = strlen(result->weakest);
        snprintf(result->weakest + used, sizeof result->weakest - used,
                 c->param->log_scale ? "%s%.2f ln %s" : "%s%.2f %s", used ? " " : "",
                 spread->weakest[j], c->name);
    }
}

sn_status sn_describe(sn_problem *problem, sn_found *best, bool last, sn_fit_result *result,
                      bool *moved) {
    sn_spread spread;
    *moved = false;
    SN_TRY(sn_spread_at(problem, best, &spread));
    sn_problem_set(problem, best->x);
    describe_constants(problem, result);
    describe_correlation(problem, &spread, result);
    result->identifiable = true;
    for (int j = 0; j < problem->free_count; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        sn_fit_param *p = &result->param[problem->free[j]];
        p->standard_error = spread.error[j] * (c->param->log_scale ? p->value : 1.0);
        linear_interval(c, best->x[j], spread.student * spread.error[j], p);
        if (wider(c, p, moderate_factor, moderate_part)) {
            double interval[2];
            sn_found better;
            bool improved;
            SN_TRY(sn_profile(problem, best, &spread, j, interval, &better, &improved));
            if (improved && !last) {
                *best = better;
                *moved = true;
                return SN_OK;
            }
            p->profiled = !improved;
            if (!improved) from_profile(c, interval, spread.student, p);
        }
        judge(problem, &spread, j, p);
        result->identifiable = result->identifiable && p->identifiable;
    }
    because_of_open_partners(problem, &spread, result);
    because_of_ratio(problem, result);
    because_of_one_stretch(problem, result);
    sn_describe_determined(problem, &spread, result);
    return SN_OK;
}
