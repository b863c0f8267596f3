// Global search by controlled random search, local search by Levenberg-Marquardt.
// SPDX-License-Identifier: Apache-2.0
// Source: Kaelo & Ali, controlled random search with local mutation (NLopt); Moré's
// Levenberg-Marquardt (MINPACK, by cminpack).
//
// The global stage works on the unit cube of the bounds. Every law is proportional to its constants
// that are stresses, so their common factor is solved for at each point and the cube loses its
// longest direction. The best points that are apart from each other start local searches. Bounds
// become y -> (1 + sin y)/2, so that Levenberg-Marquardt is free. Its Jacobian is that of
// sn_problem_jacobian().
#include "lab/fit/search.h"

#include <math.h>
#include <string.h>

#include <cminpack.h>
#include <nlopt.h>

enum { STARTS_MAX = 16, PER_CONSTANT = 120, LOCAL_CALLS = 200 };
// rows on which the search for a start is done, in all and at least of every curve
enum { START_ROWS = 200, START_LEAST = 30 };
static const double apart = 0.1;       // of the unit cube, largest difference of a coordinate
static const double near_bound = 0.02; // part of the range

typedef struct cube {
    sn_problem *problem;
    double low[SN_FIT_PARAMS_MAX], high[SN_FIT_PARAMS_MAX]; // in the scale of the fit
    double *residual;
    int kept_max, kept_count;
    sn_found kept[STARTS_MAX]; // in the cube; best first
} cube;

static void cube_bounds(cube *c) {
    for (int j = 0; j < c->problem->free_count; ++j) {
        const sn_fit_constant *k = &c->problem->constant[c->problem->free[j]];
        c->low[j] = sn_problem_scaled(k, k->low);
        c->high[j] = sn_problem_scaled(k, k->high);
    }
}

static double distance(int n, const double *a, const double *b) {
    double d = 0.0;
    for (int j = 0; j < n; ++j) d = fmax(d, fabs(a[j] - b[j]));
    return d;
}

// keeps a point if it is among the best, replacing those near it that are worse
static void keep(cube *c, const double *z, double sum) {
    int n = c->problem->free_count;
    for (int i = 0; i < c->kept_count; ++i)
        if (c->kept[i].sum <= sum && distance(n, c->kept[i].x, z) < apart) return;
    int left = 0;
    for (int i = 0; i < c->kept_count; ++i)
        if (distance(n, c->kept[i].x, z) >= apart) c->kept[left++] = c->kept[i];
    int at = left;
    while (at > 0 && c->kept[at - 1].sum > sum) --at;
    c->kept_count = left;
    if (at >= c->kept_max) return;
    if (left == c->kept_max) left--;
    memmove(&c->kept[at + 1], &c->kept[at], (size_t)(left - at) * sizeof *c->kept);
    memcpy(c->kept[at].x, z, (size_t)n * sizeof *z);
    c->kept[at].sum = sum;
    c->kept_count = left + 1;
}

static double global_objective(unsigned n, const double *z, double *gradient, void *context) {
    cube *c = context;
    (void)gradient;
    double x[SN_FIT_PARAMS_MAX], scaled[SN_FIT_PARAMS_MAX];
    for (unsigned j = 0; j < n; ++j) x[j] = c->low[j] + z[j] * (c->high[j] - c->low[j]);
    double sum = sn_problem_scaled_sum(c->problem, x, c->residual);
    for (unsigned j = 0; j < n; ++j)
        scaled[j] = fmin(1.0, fmax(0.0, (x[j] - c->low[j]) / (c->high[j] - c->low[j])));
    keep(c, scaled, sum);
    return log(sum + 1e-300); // ranks are all that counts; the logarithm never overflows
}

static sn_status global(cube *c) {
    unsigned n = (unsigned)c->problem->free_count;
    double z[SN_FIT_PARAMS_MAX], zero[SN_FIT_PARAMS_MAX], one[SN_FIT_PARAMS_MAX], value;
    for (unsigned j = 0; j < n; ++j) {
        z[j] = 0.5;
        zero[j] = 0.0;
        one[j] = 1.0;
    }
    nlopt_opt search = nlopt_create(NLOPT_GN_CRS2_LM, n);
    if (!search) return sn_fail(SN_E_MEMORY, "fit: no memory for the global search");
    nlopt_srand(c->problem->def->seed);
    nlopt_set_lower_bounds(search, zero);
    nlopt_set_upper_bounds(search, one);
    nlopt_set_min_objective(search, global_objective, c);
    nlopt_set_maxeval(search, PER_CONSTANT * (int)(n + 1));
    nlopt_optimize(search, z, &value); // whatever its end, the points kept are what we use
    nlopt_destroy(search);
    if (c->kept_count == 0)
        return sn_fail(SN_E_SOLVER, "fit: the global search met no usable point");
    return SN_OK;
}

//---- local search --------------------------------------------------------------------------------

typedef struct local {
    sn_problem *problem;
    int count; // of constants that move
    int moving[SN_FIT_PARAMS_MAX];
    double x[SN_FIT_PARAMS_MAX], low[SN_FIT_PARAMS_MAX], high[SN_FIT_PARAMS_MAX];
    double *all; // derivatives by all constants                        (free_count x points)
} local;

static void local_point(local *l, int n, const double *y) {
    for (int j = 0; j < n; ++j) {
        int k = l->moving[j];
        l->x[k] = l->low[k] + 0.5 * (1.0 + sin(y[j])) * (l->high[k] - l->low[k]);
    }
}

// as lmder wants it: residuals, or their derivatives by y
static int local_evaluate(void *context, int m, int n, const double *y, double *residual,
                          double *jacobian, int stride, int what) {
    local *l = context;
    local_point(l, n, y);
    if (what == 1) {
        sn_problem_residuals(l->problem, l->x, residual);
        return 0;
    }
    sn_problem_jacobian(l->problem, l->x, l->all);
    for (int j = 0; j < n; ++j) {
        int k = l->moving[j];
        double slope = 0.5 * cos(y[j]) * (l->high[k] - l->low[k]); // dx/dy
        const double *from = l->all + (ptrdiff_t)k * m;
        double *to = jacobian + (ptrdiff_t)j * stride;
        for (int i = 0; i < m; ++i) to[i] = slope * from[i];
    }
    return 0;
}

static void local_start(local *l, const bool *hold, const sn_found *found, double *y) {
    sn_problem *p = l->problem;
    memcpy(l->x, found->x, sizeof l->x);
    for (int j = 0; j < p->free_count; ++j) {
        const sn_fit_constant *k = &p->constant[p->free[j]];
        l->low[j] = sn_problem_scaled(k, k->low);
        l->high[j] = sn_problem_scaled(k, k->high);
        if (hold && hold[j]) continue;
        double z = (l->x[j] - l->low[j]) / (l->high[j] - l->low[j]);
        z = fmin(1.0 - 1e-4, fmax(1e-4, z)); // off the bound, where the sine is flat
        y[l->count] = asin(2.0 * z - 1.0);
        l->moving[l->count++] = j;
    }
}

sn_status sn_search_local(sn_problem *problem, const bool *hold, double enough, sn_found *found) {
    local l = {.problem = problem};
    double y[SN_FIT_PARAMS_MAX], diag[SN_FIT_PARAMS_MAX], qtf[SN_FIT_PARAMS_MAX];
    double wa[3][SN_FIT_PARAMS_MAX];
    int pivot[SN_FIT_PARAMS_MAX], calls = 0, slopes = 0;
    local_start(&l, hold, found, y);
    size_t m = (size_t)problem->points, n = (size_t)l.count;
    double *work = sn_alloc(m * (n + 2 + (size_t)problem->free_count), sizeof *work);
    if (!work) return SN_E_MEMORY;
    double *residual = work, *wa4 = work + m, *jacobian = work + 2 * m;
    l.all = jacobian + m * n;
    if (n == 0) {
        found->info = 1;
        sn_problem_residuals(problem, found->x, residual);
        found->sum = sn_sum_squares(problem->points, residual);
        sn_free(work);
        return SN_OK;
    }
    found->info =
        lmder(local_evaluate, &l, (int)m, (int)n, y, residual, jacobian, (int)m, enough, 1e-9, 0.0,
              LOCAL_CALLS, diag, 1, 1.0, 0, &calls, &slopes, pivot, qtf, wa[0], wa[1], wa[2], wa4);
    local_point(&l, (int)n, y);
    sn_problem_residuals(problem, l.x, residual);
    memcpy(found->x, l.x, sizeof found->x);
    found->sum = sn_sum_squares(problem->points, residual);
    sn_free(work);
    return SN_OK;
}

// All the way from the best start. A constant that has come to a bound is set on it and held: near
// its bound the sine is flat, and the search would creep there for ever.
static sn_status finish(cube *c, sn_found *best) {
    bool hold[SN_FIT_PARAMS_MAX] = {false}, any = false;
    sn_found settled = *best, polished = *best;
    for (int j = 0; j < c->problem->free_count; ++j) {
        double part = (best->x[j] - c->low[j]) / (c->high[j] - c->low[j]);
        hold[j] = part < near_bound || part > 1.0 - near_bound;
        if (hold[j]) settled.x[j] = part < 0.5 ? c->low[j] : c->high[j];
        any = any || hold[j];
    }
    if (any) {
        SN_TRY(sn_search_local(c->problem, hold, 1e-12, &settled));
        if (settled.sum <= best->sum * (1.0 + 1e-4)) {
            *best = settled;
            return SN_OK;
        }
    }
    SN_TRY(sn_search_local(c->problem, NULL, 1e-12, &polished));
    if (polished.sum <= best->sum) *best = polished;
    return SN_OK;
}

// One more start for laws of two directions, of which some have a dozen constants: those that may
// be 0 (cross, cubic and linear terms, fibres) are held there first, and then let go. The end is no
// worse than that of the simpler law.
static sn_status refine_simple(cube *c, sn_found *best) {
    sn_problem *p = c->problem;
    bool hold[SN_FIT_PARAMS_MAX] = {false}, in_plane = false;
    int held = 0;
    for (int k = 0; k < p->def->curve_count; ++k) in_plane = in_plane || p->plane[k];
    sn_found found = *best;
    for (int j = 0; j < p->free_count && in_plane; ++j) {
        const sn_fit_constant *k = &p->constant[p->free[j]];
        bool may = k->low < 0.0 && k->high > 0.0;
        hold[j] = !k->in_memory && !k->param->log_scale && (may || k->stress);
        if (hold[j]) found.x[j] = fmax(0.0, k->low);
        held += hold[j];
    }
    if (held == 0 || held == p->free_count) return SN_OK;
    SN_TRY(sn_search_local(p, hold, 1e-6, &found));
    SN_TRY(sn_search_local(p, NULL, 1e-6, &found));
    if (found.sum < best->sum) *best = found;
    return SN_OK;
}

static sn_status refine(cube *c, sn_found *best) {
    const sn_fit_def *def = c->problem->def;
    best->sum = (double)INFINITY;
    for (int i = 0; i < c->kept_count; ++i) {
        sn_found found = c->kept[i];
        for (int j = 0; j < c->problem->free_count; ++j)
            found.x[j] = c->low[j] + found.x[j] * (c->high[j] - c->low[j]);
        SN_TRY(sn_search_local(c->problem, NULL, 1e-4, &found));
        if (found.sum < best->sum) *best = found;
        if (def->progress)
            def->progress(def->progress_context, 0.3 + 0.4 * (i + 1) / c->kept_count,
                          "local search");
    }
    return refine_simple(c, best);
}

//---- long records --------------------------------------------------------------------------------

// every step-th row of a curve, and its last
static sn_status thin_curve(const sn_curve *curve, int step, sn_curve *out) {
    size_t most = (size_t)(curve->count / step + 2);
    *out = *curve;
    const double *const from[] = {curve->time,      curve->stretch,  curve->stress,
                                  curve->stretch_2, curve->stress_2, curve->frequency,
                                  curve->storage,   curve->loss};
    double **const to[] = {&out->time,     &out->stretch,   &out->stress,  &out->stretch_2,
                           &out->stress_2, &out->frequency, &out->storage, &out->loss};
    enum { COLUMNS = sizeof from / sizeof *from };
    bool whole = true;
    for (int k = 0; k < COLUMNS; ++k) {
        *to[k] = from[k] ? sn_alloc(most, sizeof **to[k]) : NULL;
        whole = whole && (!from[k] || *to[k]);
    }
    out->count = 0;
    if (!whole) return SN_E_MEMORY;
    for (int i = 0; i < curve->count; ++i) {
        if (i % step != 0 && i != curve->count - 1) continue;
        for (int k = 0; k < COLUMNS; ++k)
            if (from[k]) (*to[k])[out->count] = from[k][i];
        out->count++;
    }
    return SN_OK;
}

// Where to start on long records is found on a part of their rows, within the bounds of the whole:
// thousands of trials want the shape of the curves, not every row.
static sn_status search_part(sn_problem *whole, sn_found *best) {
    sn_problem *part = NULL;
    sn_fit_def def = *whole->def;
    sn_curve *thin = sn_alloc((size_t)def.curve_count, sizeof *thin);
    if (!thin) return SN_E_MEMORY;
    def.curve = thin;
    sn_status status = SN_OK;
    int step = whole->used / START_ROWS;
    for (int k = 0; k < def.curve_count && status == SN_OK; ++k) {
        const sn_curve *curve = &whole->def->curve[k];
        // a short curve among long ones keeps a few dozen rows
        int own = curve->count / START_LEAST;
        status = thin_curve(curve, own < 1 ? 1 : own < step ? own : step, &thin[k]);
    }
    if (status == SN_OK) status = sn_problem_create(&def, &part);
    if (status == SN_OK) {
        for (int k = 0; k < part->count; ++k) {
            part->constant[k].low = whole->constant[k].low;
            part->constant[k].high = whole->constant[k].high;
        }
        status = sn_search(part, best);
        whole->evaluations += part->evaluations;
    }
    sn_problem_destroy(part);
    for (int k = 0; k < def.curve_count; ++k) sn_curve_release(&thin[k]);
    sn_free(thin);
    return status;
}

static sn_status find_start(cube *c, sn_found *best) {
    sn_problem *p = c->problem;
    int most = 2 * (START_ROWS + START_LEAST * p->def->curve_count); // the part is below this
    if (p->used <= most) {
        SN_TRY(global(c));
        return refine(c, best);
    }
    SN_TRY(search_part(p, best));
    sn_problem_residuals(p, best->x, c->residual);
    best->sum = sn_sum_squares(p->points, c->residual);
    return SN_OK;
}

sn_status sn_search(sn_problem *problem, sn_found *best) {
    const sn_fit_def *def = problem->def;
    cube *c = sn_alloc(1, sizeof *c);
    if (!c) return SN_E_MEMORY;
    c->problem = problem;
    c->kept_max = def->starts < 1 ? 1 : def->starts > STARTS_MAX ? STARTS_MAX : def->starts;
    cube_bounds(c);
    sn_status status = SN_E_MEMORY;
    c->residual = sn_alloc((size_t)problem->points, sizeof *c->residual);
    if (!c->residual) goto fail;
    *best = (sn_found){0};
    if (problem->free_count == 0) {
        status = sn_search_local(problem, NULL, 1e-12, best);
        goto fail;
    }
    if (def->progress) def->progress(def->progress_context, 0.0, "global search");
    SN_TRY_GOTO(status, find_start(c, best));
    SN_TRY_GOTO(status, finish(c, best));
    if (best->sum >= problem->norm * 1e5)
        status = sn_fail(SN_E_SOLVER, "fit: no constants within the bounds give a usable stress");
fail:
    sn_free(c->residual);
    sn_free(c);
    return status;
}
