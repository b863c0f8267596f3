// Set-up of a fit from its definition, and its residuals.
// SPDX-License-Identifier: Apache-2.0
#include "lab/fit/problem.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double exponent_max = 40.0; // largest exponent that a bound of a pure number allows

double sn_sum_squares(int n, const double *x) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += x[i] * x[i];
    return sum;
}

double sn_problem_scaled(const sn_fit_constant *constant, double value) {
    return constant->param->log_scale ? log(value) : value;
}

double sn_problem_natural(const sn_fit_constant *constant, double scaled) {
    double value = constant->param->log_scale ? exp(scaled) : scaled;
    return fmin(fmax(value, constant->low), constant->high); // exp(log(x)) may leave by a bit
}

//---- constants and bounds ------------------------------------------------------------------------

// Bounds: the table's, narrowed to what the data can speak of. Stresses by the secant modulus,
// times by sampling and record, pure numbers by the exponent they make at the largest strain.
static void set_bounds(const sn_problem *p, sn_fit_constant *c) {
    const sn_param *t = c->param;
    double low = t->min, high = t->max, modulus = p->peak / p->strain;
    if (c->stress) {
        low = fmax(low, t->log_scale || t->min >= 0.0 ? 1e-6 * modulus : -1e3 * modulus);
        high = fmin(high, 1e3 * modulus);
    } else if (c->time) {
        low = fmax(low, p->sampling / 100.0);
        high = fmin(high, 100.0 * p->record);
    } else {
        double limit = exponent_max / p->strain;
        low = fmax(low, t->log_scale ? 1e-4 : -limit);
        high = fmin(high, limit);
    }
    double inside = 1e-9 * fmin(high - low, fmax(fabs(low), fabs(high)));
    if (t->min_open && low == t->min) low += inside;
    if (t->max_open && high == t->max) high -= inside;
    c->low = low;
    c->high = high;
}

static int fixed_index(const sn_fit_def *def, const char *name) {
    for (int i = 0; i < def->fixed_count; ++i)
        if (strcmp(def->fixed_name[i], name) == 0) return i;
    return -1;
}

static sn_status add_constant(sn_problem *p, const sn_param *param, bool in_memory, int index,
                              int term) {
    if (p->count == SN_FIT_PARAMS_MAX)
        return sn_fail(SN_E_DEFINITION, "fit: more than %d constants: use fewer terms",
                       SN_FIT_PARAMS_MAX);
    sn_fit_constant *c = &p->constant[p->count++];
    *c = (sn_fit_constant){.param = param, .index = index, .in_memory = in_memory};
    if (term > 0)
        snprintf(c->name, sizeof c->name, "%s%d", param->name, term);
    else
        snprintf(c->name, sizeof c->name, "%s", param->name);
    if (in_memory && sn_param_find(p->tissue.law->params, p->tissue.law->param_count,
                                   param->name) >= 0) { // c of demiray and c of the spectrum
        char own[SN_NAME_MAX];
        snprintf(own, sizeof own, "%s", c->name);
        snprintf(c->name, sizeof c->name, "memory.%.50s", own);
    }
    c->stress = strcmp(param->unit, "Pa") == 0;
    c->time = strcmp(param->unit, "s") == 0;
    double *value = (in_memory ? p->tissue.memory.value : p->tissue.value) + index;
    int fixed = fixed_index(p->def, c->name);
    if (fixed >= 0) {
        *value = p->def->fixed_value[fixed];
    } else if (param->infinity) {
        *value = (double)INFINITY; // a uniaxial test does not see the bulk modulus of a soft tissue
    } else {
        set_bounds(p, c);
        if (!(c->low < c->high))
            return sn_fail(SN_E_DATA,
                           "fit: the data leave no range for %s (%g to %g %s): check the units of "
                           "the curve, or fix it",
                           c->name, c->low, c->high, param->unit);
        c->free = true;
        p->free[p->free_count++] = p->count - 1;
    }
    return SN_OK;
}

static sn_status add_table(sn_problem *p, const sn_param *params, int count, int terms,
                           bool in_memory) {
    for (int k = 0; k < count; ++k) {
        int length = sn_param_length(&params[k], terms);
        int offset = sn_param_offset(params, k, terms);
        bool list = params[k].length == SN_PARAM_LIST || params[k].length > 1;
        for (int j = 0; j < length; ++j)
            SN_TRY(add_constant(p, &params[k], in_memory, offset + j, list ? j + 1 : 0));
    }
    return SN_OK;
}

static bool has_list(const sn_param *params, int count) {
    for (int k = 0; k < count; ++k)
        if (params[k].length == SN_PARAM_LIST) return true;
    return false;
}

static sn_status check_fixed_names(const sn_problem *p) {
    const char *names[SN_FIT_PARAMS_MAX];
    for (int k = 0; k < p->count; ++k) names[k] = p->constant[k].name;
    for (int i = 0; i < p->def->fixed_count; ++i) {
        const char *name = p->def->fixed_name[i];
        bool found = false;
        for (int k = 0; k < p->count && !found; ++k) found = strcmp(names[k], name) == 0;
        if (found) continue;
        const char *near = sn_suggest(name, names, p->count);
        return sn_fail(SN_E_NAME, "fit: no constant \"%s\" to fix in law %s with memory %s%s%s%s",
                       name, p->tissue.law->name, p->tissue.memory.law->name,
                       near ? ": did you mean \"" : "", near ? near : "", near ? "\"?" : "");
    }
    return SN_OK;
}

// proportional: every constant that is a stress is searched or infinite, and there is one
static bool is_scalable(const sn_problem *p) {
    int free = 0;
    for (int k = 0; k < p->count; ++k) {
        const sn_fit_constant *c = &p->constant[k];
        if (!c->stress) continue;
        if (!c->free && !isinf(p->tissue.value[c->index])) return false;
        free += c->free;
    }
    return free > 0;
}

static sn_status set_constants(sn_problem *p) {
    const sn_fit_def *def = p->def;
    const sn_law *law = def->law;
    p->tissue = sn_tissue_default();
    p->tissue.law = law;
    if (has_list(law->params, law->param_count)) p->tissue.terms = def->law_terms;
    p->tissue.memory = sn_memory_none();
    if (def->memory) p->tissue.memory.law = def->memory;
    const sn_memory_law *memory = p->tissue.memory.law;
    if (has_list(memory->params, memory->param_count)) p->tissue.memory.terms = def->terms;
    if (p->tissue.terms < 0 || p->tissue.terms > 8 || p->tissue.memory.terms < 0 ||
        p->tissue.memory.terms > 12)
        return sn_fail(SN_E_DEFINITION,
                       "fit: %d terms of the law and %d of the memory: expected at most 8 and 12",
                       p->tissue.terms, p->tissue.memory.terms);
    SN_TRY(add_table(p, law->params, law->param_count, p->tissue.terms, false));
    SN_TRY(add_table(p, memory->params, memory->param_count, p->tissue.memory.terms, true));
    SN_TRY(check_fixed_names(p));
    p->scalable = is_scalable(p);
    for (int k = 0; k < p->count; ++k) { // fixed values against the table
        const sn_fit_constant *c = &p->constant[k];
        if (c->free) continue;
        double v = (c->in_memory ? p->tissue.memory.value : p->tissue.value)[c->index];
        sn_param one = *c->param;
        one.length = 0;
        SN_TRY(sn_param_check(&one, 1, 0, &v, "fit, fixed value"));
    }
    return SN_OK;
}

//---- data ----------------------------------------------------------------------------------------

// first row at which the stretch is within 1 % of its range of the largest distance from the start
static int ramp_end(const sn_curve *curve) {
    double reach = 0.0;
    for (int i = 0; i < curve->count; ++i)
        reach = fmax(reach, fabs(curve->stretch[i] - curve->stretch[0]));
    int end = 0;
    while (fabs(curve->stretch[end] - curve->stretch[0]) < 0.99 * reach) ++end;
    return end;
}

static sn_status add_curve(sn_problem *p, int k, const double *time) {
    const sn_curve *curve = &p->def->curve[k];
    double low = (double)INFINITY, high = -(double)INFINITY;
    for (int i = 0; i < curve->count; ++i) {
        p->peak = fmax(p->peak, fabs(curve->stress[i]));
        p->strain = fmax(p->strain, fabs(curve->stretch[i] - 1.0));
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA, "%s: the stretch is %g in every row: a fit needs a pull",
                       curve->name, high);
    int end = ramp_end(curve);
    for (int i = 1; i <= end; ++i) p->sampling = fmin(p->sampling, time[i] - time[i - 1]);
    p->ramp = fmin(p->ramp, time[end] - time[0]);
    p->record = fmax(p->record, time[curve->count - 1] - time[0]);
    sn_history *history;
    SN_TRY(sn_history_create(1, curve->count, time, curve->stretch, &history));
    sn_status status = sn_path_create(history, curve->count, time, &p->path[k]);
    sn_history_destroy(history);
    if (status != SN_OK) return sn_fail_within(status, "%s", curve->name);
    p->slopes[k] = true;
    return SN_OK;
}

// without a memory time does not matter: the row numbers stand for it
static sn_status add_curves(sn_problem *p) {
    const sn_fit_def *def = p->def;
    double *rows = NULL;
    sn_status status = SN_OK;
    for (int k = 0; k < def->curve_count && status == SN_OK; ++k) {
        const sn_curve *curve = &def->curve[k];
        if (curve->time) {
            status = add_curve(p, k, curve->time);
            continue;
        }
        if (def->memory && def->memory->param_count > 0)
            return sn_fail(SN_E_DATA, "%s: no time column: a fit of memory %s needs one",
                           curve->name, def->memory->name);
        rows = sn_alloc((size_t)curve->count, sizeof *rows);
        if (!rows) return SN_E_MEMORY;
        for (int i = 0; i < curve->count; ++i) rows[i] = i;
        status = add_curve(p, k, rows);
        sn_free(rows);
    }
    return status;
}

static sn_status set_data(sn_problem *p) {
    const sn_fit_def *def = p->def;
    p->sampling = p->ramp = (double)INFINITY;
    SN_TRY(add_curves(p));
    if (!(p->peak > 0.0))
        return sn_fail(SN_E_DATA, "%s: the stress is 0 in every row: nothing to fit",
                       def->curve[0].name);
    for (int k = 0; k < def->curve_count; ++k) p->points += def->curve[k].count;
    p->measured = sn_alloc(3 * (size_t)p->points, sizeof *p->measured);
    if (!p->measured) return SN_E_MEMORY;
    p->weight = p->measured + p->points;
    p->model = p->weight + p->points;
    for (int k = 0, at = 0; k < def->curve_count; ++k) {
        double weight = def->weight ? def->weight[k] : 1.0;
        if (!(weight > 0.0) || !isfinite(weight))
            return sn_fail(SN_E_RANGE, "%s: weight %g: expected a number above 0",
                           def->curve[k].name, weight);
        for (int i = 0; i < def->curve[k].count; ++i, ++at) {
            p->measured[at] = def->curve[k].stress[i];
            p->weight[at] = sqrt(weight);
            p->norm += weight * p->measured[at] * p->measured[at];
        }
    }
    return SN_OK;
}

static sn_status check_definition(const sn_fit_def *def) {
    if (!def->law || def->curve_count < 1 || def->curve_count > SN_FIT_CURVES_MAX || !def->curve)
        return sn_fail(SN_E_DEFINITION, "fit: expected a law and 1 to %d curves, found %s and %d",
                       SN_FIT_CURVES_MAX, def->law ? def->law->name : "no law", def->curve_count);
    if (def->fixed_count < 0 || def->fixed_count > SN_FIT_PARAMS_MAX)
        return sn_fail(SN_E_DEFINITION, "fit: %d fixed constants: expected 0 to %d",
                       def->fixed_count, SN_FIT_PARAMS_MAX);
    if (def->law->kind == SN_LAW_MEMBRANE)
        return sn_fail(SN_E_UNSUPPORTED,
                       "fit: law %s is a membrane and the curves are uniaxial: expected a uniaxial "
                       "or a solid law",
                       def->law->name);
    for (int k = 0; k < def->law->param_count; ++k)
        if (def->law->params[k].length > 1)
            return sn_fail(
                SN_E_UNSUPPORTED,
                "fit: law %s has the list %s of %d constants for three directions, which "
                "pulls along one axis cannot tell apart: expected a law such as "
                "exponential, demiray or guccione",
                def->law->name, def->law->params[k].name, def->law->params[k].length);
    for (int k = 0; k < def->curve_count; ++k)
        if (def->curve[k].count < 3)
            return sn_fail(SN_E_DATA, "%s: %d rows: expected at least 3", def->curve[k].name,
                           def->curve[k].count);
    return SN_OK;
}

sn_status sn_problem_create(const sn_fit_def *def, sn_problem **problem) {
    *problem = NULL;
    SN_TRY(check_definition(def));
    sn_problem *p = sn_alloc(1, sizeof *p);
    if (!p) return SN_E_MEMORY;
    p->def = def;
    sn_status status;
    SN_TRY_GOTO(status, set_data(p));
    SN_TRY_GOTO(status, set_constants(p));
    if (p->points <= p->free_count) {
        status = sn_fail(SN_E_DATA, "%s%s: %d rows for %d constants: expected more rows than that",
                         def->curve[0].name, def->curve_count > 1 ? " and others" : "", p->points,
                         p->free_count);
        goto fail;
    }
    for (int k = 0; k < def->curve_count; ++k)
        if (p->tissue.memory.law->impulse && def->curve[k].stretch[0] != 1.0) {
            status = sn_fail(
                SN_E_DATA, "%s: the curve starts at stretch %g: memory %s needs a start at 1",
                def->curve[k].name, def->curve[k].stretch[0], p->tissue.memory.law->name);
            goto fail;
        }
    *problem = p;
    return SN_OK;
fail:
    sn_problem_destroy(p);
    return status;
}

void sn_problem_destroy(sn_problem *problem) {
    if (!problem) return;
    for (int k = 0; k < SN_FIT_CURVES_MAX; ++k) sn_path_destroy(problem->path[k]);
    sn_free(problem->measured);
    sn_free(problem);
}

//---- residuals -----------------------------------------------------------------------------------

void sn_problem_set(sn_problem *problem, const double *x) {
    for (int j = 0; j < problem->free_count; ++j) {
        const sn_fit_constant *c = &problem->constant[problem->free[j]];
        double *values = c->in_memory ? problem->tissue.memory.value : problem->tissue.value;
        values[c->index] = sn_problem_natural(c, x[j]);
    }
}

sn_status sn_problem_curve(const sn_problem *p, int k, sn_pull pull, const sn_exponentials *e,
                           double *stress) {
    return sn_path_stress(p->path[k], &p->tissue, pull, e, SN_PROBLEM_LEVEL, stress);
}

// model stresses of the tissue as it stands
static sn_status model_stress(sn_problem *p) {
    sn_exponentials e;
    sn_pull pull;
    SN_TRY(sn_law_check(p->tissue.law, p->tissue.value, p->tissue.terms));
    SN_TRY(sn_memory_expand(&p->tissue.memory, &e));
    SN_TRY(sn_pull_choose(&p->tissue, &pull));
    for (int k = 0, at = 0; k < p->def->curve_count; ++k) {
        SN_TRY(sn_problem_curve(p, k, pull, &e, p->model + at));
        at += p->def->curve[k].count;
    }
    return SN_OK;
}

bool sn_problem_residuals(sn_problem *problem, const double *x, double *residual) {
    problem->evaluations++;
    sn_problem_set(problem, x);
    bool good = model_stress(problem) == SN_OK;
    for (int i = 0; i < problem->points && good; ++i) {
        residual[i] = problem->weight[i] * (problem->model[i] - problem->measured[i]);
        good = fabs(residual[i]) < 1e150; // squares must not overflow; false for NaN
    }
    if (good) return true;
    double wall = 1e3 * sqrt(problem->norm / problem->points);
    for (int i = 0; i < problem->points; ++i) residual[i] = wall;
    return false;
}

double sn_problem_scaled_sum(sn_problem *problem, double *x, double *residual) {
    int n = problem->points;
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
