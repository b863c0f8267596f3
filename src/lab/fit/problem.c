// Set-up of a fit from its definition.
// SPDX-License-Identifier: Apache-2.0
#include "lab/fit/problem.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/fit/fung.h"

static const double exponent_max = 40.0; // largest exponent that a bound of a pure number allows
static const double form_max = 20.0;     // the same of one term of Fung's quadratic form
static const double shaken = 0.05;       // least strain that a sweep stands for in the bounds
static const double two_pi = 6.28318530717958647693;

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

int sn_problem_rows(const sn_curve *curve) {
    return sn_curve_measured(curve, 1) ? 2 * curve->count : curve->count;
}

//---- constants and bounds ------------------------------------------------------------------------

// The constant's term of a Fung form by the strains it multiplies: E_i E_j of a normal or cross
// constant, 2 E12^2 of a shear. 0: it is in no form.
static double form_strain(const sn_problem *p, int index, bool *positive) {
    const sn_fung_form *form;
    int count = sn_fung_forms(p->tissue.law, &form);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < 3; ++i) {
            double first = fmax(p->green[i], 1e-3), next = fmax(p->green[(i + 1) % 3], 1e-3);
            *positive = form[k].cross[i] != index;
            if (form[k].normal[i] == index) return first * first;
            if (form[k].cross[i] == index) return first * next;
            if (form[k].shear[i] == index) return 2.0 * fmax(p->shear * p->shear, 1e-6);
        }
    return 0.0;
}

// Bounds of a constant of a Fung form: no term beyond an exponent, no linear term beyond twice the
// largest stress; normal constants and shears positive.
static void set_form_bounds(const sn_problem *p, double strain, bool positive, sn_fit_constant *c) {
    double high = c->stress ? 2.0 * p->stress / sqrt(strain) : form_max / strain;
    c->high = fmin(c->param->max, high);
    c->low = fmax(c->param->min, positive ? 1e-6 * c->high : -c->high);
}

// Bounds: the table's, narrowed to what the data can speak of. Stresses by the secant modulus,
// times by sampling and record, pure numbers by the exponent they make at the largest strain.
static void set_bounds(const sn_problem *p, sn_fit_constant *c) {
    const sn_param *t = c->param;
    bool positive = false;
    double strain = c->in_memory ? 0.0 : form_strain(p, c->index, &positive);
    if (strain > 0.0) {
        set_form_bounds(p, strain, positive, c);
        return;
    }
    double low = t->min, high = t->max, modulus = fmax(p->stress / p->strain, p->modulus);
    if (c->stress) {
        low = fmax(low, t->log_scale || t->min >= 0.0 ? 1e-6 * modulus : -1e3 * modulus);
        // from 0 on a straight scale, as fibres have it: no room for a far end to drown the near
        // one
        high = fmin(high, (t->min == 0.0 && !t->log_scale ? 20.0 : 1e3) * modulus);
    } else if (c->time) {
        low = fmax(low, fmin(p->sampling, p->fastest) / 100.0);
        high = fmin(high, 100.0 * fmax(p->record, p->slowest));
    } else if (p->tissue.law->kind != SN_LAW_MEMBRANE || c->in_memory) {
        // the cubic terms of a membrane keep the bounds of their table
        // pulled two ways, laws stiffen by invariants, which are of second order
        double limit = exponent_max / (p->biaxial ? p->strain * p->strain : p->strain);
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

// a shear constant of a plane in which no curve shears
static bool is_unseen(const sn_problem *p, const sn_fit_constant *c) {
    if (c->in_memory) return false;
    int plane = sn_fung_shear_plane(p->tissue.law, c->index);
    if (plane < 0) return false;
    for (int k = 0; k < p->def->curve_count && plane == 0; ++k)
        if (p->def->curve[k].kind == SN_CURVE_SHEAR) return false;
    return true;
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
        if (!in_memory) p->held[index] = true;
    } else if (is_unseen(p, c)) {
        c->tied = true;
        *value = 1.0; // until the others are set
    } else if (param->infinity) {
        *value = (double)INFINITY; // no test here sees the bulk modulus of a soft tissue
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

static double apart(const sn_curve *c, int i, int k) {
    double d = fabs(c->stretch[i] - c->stretch[k]);
    return c->stretch_2 ? hypot(d, c->stretch_2[i] - c->stretch_2[k]) : d;
}

// first row at which the stretch is within 1 % of its range of the largest distance from the start
static int ramp_end(const sn_curve *curve) {
    double reach = 0.0;
    for (int i = 0; i < curve->count; ++i) reach = fmax(reach, apart(curve, i, 0));
    int end = 0;
    while (apart(curve, end, 0) < 0.99 * reach) ++end;
    return end;
}

static double green(double stretch) {
    return 0.5 * (stretch - 1.0) * (stretch + 1.0);
}

// strains of a pull to stretches x and y of the first two axes
static void take_pull(sn_problem *p, double x, double y) {
    double E[] = {green(x), green(y), green(1.0 / (x * y))};
    for (int j = 0; j < 3; ++j) p->green[j] = fmax(p->green[j], fabs(E[j]));
    p->strain = fmax(p->strain, fabs(x - 1.0));
}

// the largest strains and stresses
static void take_extremes(sn_problem *p, const sn_curve *c) {
    for (int i = 0; i < c->count; ++i) {
        double x = c->stretch[i];
        double stress = fabs(c->stress[i]);
        if (c->stress_2) stress = fmax(stress, fabs(c->stress_2[i]));
        p->stress = fmax(p->stress, stress);
        p->peak = fmax(p->peak, stress);
        if (c->kind == SN_CURVE_SHEAR) {
            p->strain = fmax(p->strain, fabs(x));
            p->shear = fmax(p->shear, 0.5 * fabs(x));
            p->green[1] = fmax(p->green[1], 0.5 * x * x);
            continue;
        }
        double y = c->stretch_2 ? c->stretch_2[i] : 1.0 / sqrt(x);
        take_pull(p, x, y);
        if (c->stretch_2) p->biaxial = true;
        if (c->stretch_2) p->strain = fmax(p->strain, fabs(y - 1.0));
    }
}

// a sweep: what bounds need of it
static void add_sweep(sn_problem *p, const sn_curve *c) {
    double strain = fmax(fabs(c->mean_stretch - 1.0), shaken);
    double x = c->mean_stretch < 1.0 - shaken ? c->mean_stretch : 1.0 + strain, modulus = 0.0;
    take_pull(p, x, 1.0 / sqrt(x));
    for (int i = 0; i < c->count; ++i) {
        modulus = fmax(modulus, fabs(c->storage[i]));
        p->peak = fmax(p->peak, fmax(modulus, fabs(c->loss[i])));
        p->fastest = fmin(p->fastest, 1.0 / (two_pi * c->frequency[i]));
        p->slowest = fmax(p->slowest, 1.0 / (two_pi * c->frequency[i]));
    }
    p->modulus = fmax(p->modulus, modulus);
    p->stress = fmax(p->stress, modulus * strain);
}

static sn_status add_curve(sn_problem *p, int k, const double *time) {
    const sn_curve *curve = &p->def->curve[k];
    take_extremes(p, curve);
    int end = ramp_end(curve);
    if (end == 0)
        return sn_fail(SN_E_DATA, "%s: the %s is %g in every row: a fit needs a pull", curve->name,
                       curve->kind == SN_CURVE_SHEAR ? "shear" : "stretch", curve->stretch[0]);
    for (int i = 1; i <= end; ++i) p->sampling = fmin(p->sampling, time[i] - time[i - 1]);
    p->ramp = fmin(p->ramp, time[end] - time[0]);
    p->record = fmax(p->record, fmin(time[curve->count - 1], p->def->to) - time[0]);
    if (curve->kind != SN_CURVE_UNIAXIAL) {
        bool memory = p->def->memory && p->def->memory->param_count > 0;
        return sn_in_plane_create(curve, time, p->def->law, memory, &p->plane[k]);
    }
    sn_history *history;
    SN_TRY(sn_history_create(1, curve->count, time, curve->stretch, &history));
    sn_status status = sn_path_create(history, curve->count, time, &p->path[k]);
    sn_history_destroy(history);
    if (status != SN_OK) return sn_fail_within(status, "%s", curve->name);
    return SN_OK;
}

// without a memory time does not matter: the row numbers stand for it
static sn_status add_curves(sn_problem *p) {
    const sn_fit_def *def = p->def;
    double *rows = NULL;
    sn_status status = SN_OK;
    for (int k = 0; k < def->curve_count && status == SN_OK; ++k) {
        const sn_curve *curve = &def->curve[k];
        if (curve->kind == SN_CURVE_DYNAMIC) {
            add_sweep(p, curve);
            continue;
        }
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
    p->sampling = p->ramp = p->fastest = (double)INFINITY;
    SN_TRY(add_curves(p));
    p->slopes = true;
    for (int k = 0; k < def->curve_count; ++k) p->slopes = p->slopes && p->path[k];
    if (!(p->stress > 0.0))
        return sn_fail(SN_E_DATA, "%s: the %s is 0 in every row: nothing to fit",
                       def->curve[0].name,
                       def->curve[0].kind == SN_CURVE_DYNAMIC ? "storage modulus" : "stress");
    for (int k = 0; k < def->curve_count; ++k) p->points += sn_problem_rows(&def->curve[k]);
    p->measured = sn_alloc(3 * (size_t)p->points, sizeof *p->measured);
    if (!p->measured) return SN_E_MEMORY;
    p->weight = p->measured + p->points;
    p->model = p->weight + p->points;
    for (int k = 0, at = 0; k < def->curve_count; ++k) {
        double weight = def->weight ? def->weight[k] : 1.0;
        if (!(weight > 0.0) || !isfinite(weight))
            return sn_fail(SN_E_RANGE, "%s: weight %g: expected a number above 0",
                           def->curve[k].name, weight);
        const sn_curve *curve = &def->curve[k];
        for (int i = 0; i < sn_problem_rows(curve); ++i, ++at) {
            int row = i % curve->count;
            bool in = sn_problem_in_window(def, curve, row);
            p->measured[at] = sn_curve_measured(curve, i / curve->count)[row];
            p->weight[at] = in ? sqrt(weight) : 0.0;
            p->norm += in ? weight * p->measured[at] * p->measured[at] : 0.0;
            p->used += in;
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
    bool biaxial = false;
    for (int k = 0; k < def->curve_count; ++k) {
        biaxial = biaxial || def->curve[k].kind == SN_CURVE_BIAXIAL;
        if (def->law->kind == SN_LAW_MEMBRANE && def->curve[k].kind == SN_CURVE_UNIAXIAL)
            return sn_fail(SN_E_UNSUPPORTED,
                           "fit: law %s is a membrane and the curve %s is uniaxial: expected a "
                           "uniaxial or a solid law, or biaxial and shear curves",
                           def->law->name, def->curve[k].name);
    }
    for (int k = 0; k < def->curve_count; ++k) {
        const sn_curve *c = &def->curve[k];
        if (c->count < 3)
            return sn_fail(SN_E_DATA, "%s: %d rows: expected at least 3", c->name, c->count);
        if (c->kind == SN_CURVE_DYNAMIC && !(c->mean_stretch > 0.0))
            return sn_fail(SN_E_DATA, "%s: mean stretch %g: expected a number above 0", c->name,
                           c->mean_stretch);
    }
    for (int k = 0; k < def->law->param_count && !biaxial; ++k)
        if (def->law->params[k].length > 1)
            return sn_fail(
                SN_E_UNSUPPORTED,
                "fit: law %s has the list %s of %d constants for three directions, which no "
                "uniaxial or shear curve tells apart: add biaxial curves, or use another law",
                def->law->name, def->law->params[k].name, def->law->params[k].length);
    return SN_OK;
}

// law and memory against the kind and the start of every curve
static sn_status check_curves(const sn_problem *p) {
    for (int k = 0; k < p->def->curve_count; ++k) {
        const sn_curve *c = &p->def->curve[k];
        bool shear = c->kind == SN_CURVE_SHEAR;
        if (c->kind == SN_CURVE_DYNAMIC)
            continue; // it moves about a stretch that all memories have
        if (c->kind != SN_CURVE_UNIAXIAL) SN_TRY(sn_in_plane_check(&p->tissue, c));
        double rest = shear ? 0.0 : 1.0;
        bool second = c->stretch_2 && c->stretch_2[0] != 1.0;
        if (p->tissue.memory.law->impulse && (c->stretch[0] != rest || second))
            return sn_fail(SN_E_DATA,
                           "%s: the curve starts at %s %g: memory %s needs a start at %g", c->name,
                           shear ? "shear" : "stretch", second ? c->stretch_2[0] : c->stretch[0],
                           p->tissue.memory.law->name, rest);
    }
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
    if (p->used <= p->free_count) {
        status = sn_fail(SN_E_DATA, "%s%s: %d rows for %d constants: expected more rows than that",
                         def->curve[0].name, def->curve_count > 1 ? " and others" : "", p->used,
                         p->free_count);
        goto fail;
    }
    SN_TRY_GOTO(status, check_curves(p));
    *problem = p;
    return SN_OK;
fail:
    sn_problem_destroy(p);
    return status;
}

void sn_problem_destroy(sn_problem *problem) {
    if (!problem) return;
    for (int k = 0; k < SN_FIT_CURVES_MAX; ++k) {
        sn_path_destroy(problem->path[k]);
        sn_in_plane_destroy(problem->plane[k]);
    }
    sn_free(problem->measured);
    sn_free(problem);
}
