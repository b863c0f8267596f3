// Derivatives of the residuals of a fit by its constants, against central differences.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

#include "lab/fit/problem.h"

enum { ROWS = 60, RESIDUALS = 3 * ROWS, CONSTANTS = SN_FIT_PARAMS_MAX };

// a fast ramp, a hold with growing steps, half the way back and a slower rise again
static sn_curve zigzag(double top) {
    double time[ROWS] = {0.0}, stretch[ROWS] = {1.0}, stress[ROWS] = {0.0};
    for (int i = 1; i < ROWS; ++i) {
        double way = i < 10 ? i / 9.0 : i < 30 ? 1.0 : i < 40 ? 1.0 - (i - 30) / 18.0 : i / 59.0;
        time[i] = time[i - 1] + (i < 10 ? 0.013 : i < 30 ? 0.01 * pow(1.5, i - 10) : 0.7);
        stretch[i] = 1.0 + (top - 1.0) * way;
        stress[i] = 3e3 * way; // any: residuals differ from stresses by a constant
    }
    return oracle_curve("zigzag", ROWS, time, stretch, stress);
}

typedef struct fit_case {
    const char *law;
    int law_terms;
    double value[8];
    sn_memory memory;
    double bulk; // fixed; 0: incompressible, or no constant of the law
    double top;
} fit_case;

static sn_problem *problem_of(const fit_case *c, const sn_curve *curve, sn_fit_def *def) {
    static const double weight = 2.25;
    *def = sn_fit_def_default();
    def->curve = curve;
    def->curve_count = 1;
    def->weight = &weight;
    def->law = sn_law_find(c->law);
    def->law_terms = c->law_terms;
    def->memory = c->memory.law;
    def->terms = c->memory.terms;
    if (c->bulk > 0.0) {
        def->fixed_count = 1;
        def->fixed_name[0] = "bulk_modulus";
        def->fixed_value[0] = c->bulk;
    }
    sn_problem *p;
    CHECK_OK(sn_problem_create(def, &p));
    return p;
}

// the case's constants in the scale of the fit
static void point_of(const sn_problem *p, const fit_case *c, double *x) {
    for (int j = 0; j < p->free_count; ++j) {
        const sn_fit_constant *k = &p->constant[p->free[j]];
        double value = (k->in_memory ? c->memory.value : c->value)[k->index];
        assert_true(k->low < value && value < k->high);
        x[j] = sn_problem_scaled(k, value);
    }
}

// central differences with steps h and h/2, extrapolated to the fourth order
static void differences(sn_problem *p, const double *x, int j, double *column) {
    enum { SIDES = 4 };
    static const double offset[SIDES] = {-1.0, 1.0, -0.5, 0.5};
    const sn_fit_constant *c = &p->constant[p->free[j]];
    double at[CONSTANTS], residual[SIDES][RESIDUALS];
    double step = c->param->log_scale ? 2e-3 : 2e-3 * fmax(fabs(x[j]), 1e-2);
    for (int s = 0; s < SIDES; ++s) {
        memcpy(at, x, sizeof at);
        at[j] += offset[s] * step;
        assert_true(sn_problem_residuals(p, at, residual[s]));
    }
    for (int i = 0; i < p->points; ++i) {
        double coarse = (residual[1][i] - residual[0][i]) / (2.0 * step);
        double fine = (residual[3][i] - residual[2][i]) / step;
        column[i] = fine + (fine - coarse) / 3.0;
    }
}

// Largest difference to central differences, over the largest number of the column; its place is
// shown. The extrapolated differences are good to 1e-10 (steps of 2e-3 to the fourth, 2e-11, times
// derivatives of the fifth order over the first); rounding of the model over the step 1e-16/1e-3.
static double worst_of(sn_problem *p, const double *x, const double *J) {
    double worst = 0.0;
    for (int j = 0; j < p->free_count; ++j) {
        double column[RESIDUALS], largest = 0.0, off = 0.0;
        differences(p, x, j, column);
        for (int i = 0; i < p->points; ++i) {
            largest = fmax(largest, fabs(column[i]));
            off = fmax(off, fabs(column[i] - J[j * p->points + i]));
        }
        if (strcmp(p->constant[p->free[j]].name, "bfs") == 0) { // shear: no pull shows it
            assert_true(largest == 0.0 && off == 0.0);
            continue;
        }
        assert_true(largest > 1e-6 * p->peak); // no other column is empty
        if (getenv("SINEW_SHOW"))
            print_message("%s x %s, %s: %.3g of %.3g\n", p->tissue.law->name,
                          p->tissue.memory.law->name, p->constant[p->free[j]].name, off / largest,
                          largest);
        worst = fmax(worst, off / largest);
    }
    return worst;
}

static sn_memory memory_at(int index) {
    static const double maxwell[] = {6.3}, voigt[] = {0.043}, kelvin[] = {0.61, 1.37};
    static const double prony[] = {0.23, 0.31, 0.19, 0.05, 0.37, 21.0};
    static const double spectrum[] = {0.137, 0.061, 83.0};
    switch (index) {
    case 0: return sn_memory_none();
    case 1: return oracle_memory("maxwell", 0, maxwell, 1);
    case 2: return oracle_memory("voigt", 0, voigt, 1);
    case 3: return oracle_memory("kelvin", 0, kelvin, 2);
    case 4: return oracle_memory("prony", 3, prony, 6);
    default: return oracle_memory("fung-spectrum", 0, spectrum, 3);
    }
}
enum { MEMORIES = 6 };

static void check_law(fit_case c, double tolerance) {
    sn_curve curve = zigzag(c.top);
    for (int m = 0; m < MEMORIES; ++m) {
        sn_fit_def def;
        double x[CONSTANTS] = {0.0};
        c.memory = memory_at(m);
        sn_problem *p = problem_of(&c, &curve, &def);
        double *J = sn_alloc((size_t)(p->free_count * ROWS), sizeof *J);
        point_of(p, &c, x);
        assert_true(p->slopes);
        assert_true(sn_problem_jacobian(p, x, J));
        CHECK_ABS(worst_of(p, x, J), 0.0, tolerance);
        // the check sees one number in a thousand wrong by a part in a thousand
        J[ROWS - 1] *= 1.001;
        if (fabs(J[ROWS - 1]) > 0.1 * p->peak) assert_true(worst_of(p, x, J) > 10.0 * tolerance);
        // the other way, differences of all residuals: 1e-8 of second order and rounding
        p->slopes = false;
        assert_true(sn_problem_jacobian(p, x, J));
        CHECK_ABS(worst_of(p, x, J), 0.0, 1e-6);
        sn_free(J);
        sn_problem_destroy(p);
    }
    sn_curve_release(&curve);
}

// The law's derivatives are means and differences over the stretch with a step of 3e-6, off by
// (B step)^2/2 where they go like exp(B stretch), B up to 20 here, and by 1e-16/3e-6: 2e-9 in all.
static void known_pulls(void **state) {
    (void)state;
    check_law((fit_case){"linear", 0, {4.1e4}, .top = 1.2}, 3e-9);
    check_law((fit_case){"exponential", 0, {11.7, 1.37e4}, .top = 1.2}, 3e-9);
    check_law((fit_case){"neo-hookean", 0, {5.3e3}, .top = 1.4}, 3e-9);
    check_law((fit_case){"mooney-rivlin", 0, {2.3e3, 1.1e3}, .top = 1.4}, 3e-9);
    check_law((fit_case){"demiray", 0, {2.9e3, 4.3}, .top = 1.3}, 3e-9);
    check_law((fit_case){"veronda-westmann", 0, {1.9e3, 3.1}, .top = 1.3}, 3e-9);
    check_law((fit_case){"guccione", 0, {1.9e3, 9.1, 3.7, 2.3}, .top = 1.2}, 3e-9);
    check_law((fit_case){"ogden", 2, {310, -120, 6.7, -3.1}, .top = 1.3}, 3e-9);
}

// Sides that are solved for, to 1e-11 or better, in both ways; dy of the one has no differences.
static void lateral_pulls(void **state) {
    (void)state;
    check_law((fit_case){"hookean", 0, {5.3e3, 0.31}, .top = 1.15}, 3e-8);
    check_law((fit_case){"neo-hookean", 0, {5.3e3}, .bulk = 1.1e4, .top = 1.4}, 3e-8);
    check_law((fit_case){"demiray", 0, {2.9e3, 4.3}, .bulk = 9e3, .top = 1.3}, 3e-8);
    check_law((fit_case){"ogden", 1, {310, 6.7}, .bulk = 3e3, .top = 1.3}, 3e-8);
    check_law((fit_case){"hgo", 0, {2.1e3, 3.1e3, 0.7, 0.11, 0.6}, .top = 1.2}, 3e-8);
    check_law((fit_case){"hgo", 0, {2.1e3, 3.1e3, 0.7, 0.11, 0.6}, .bulk = 5e4, .top = 1.2}, 3e-8);
}

// A biaxial curve, two residuals a row, beside a pulled one, of which the first rows are not
// fitted: differences of second order, 1e-8, of all of them.
static void mixed_curves(void **state) {
    (void)state;
    static const double value[] = {0.23, 0.4};
    const fit_case c = {
        "demiray", 0, {2.9e3, 4.3}, oracle_memory("prony", 1, value, 2), .top = 1.2};
    sn_curve curve[2] = {zigzag(c.top), zigzag(c.top)};
    curve[1].kind = SN_CURVE_BIAXIAL;
    curve[1].stretch_2 = sn_alloc(ROWS, sizeof *curve[1].stretch_2);
    curve[1].stress_2 = sn_alloc(ROWS, sizeof *curve[1].stress_2);
    assert_true(curve[1].stretch_2 && curve[1].stress_2);
    for (int i = 0; i < ROWS; ++i) {
        curve[1].stretch_2[i] = 1.0 + 0.4 * (curve[1].stretch[i] - 1.0);
        curve[1].stress_2[i] = 0.5 * curve[1].stress[i];
    }
    sn_fit_def def = sn_fit_def_default();
    def.curve = curve;
    def.curve_count = 2;
    def.law = sn_law_find(c.law);
    def.memory = c.memory.law;
    def.terms = 1;
    def.from = 0.05;
    sn_problem *p;
    double x[CONSTANTS] = {0.0}, J[CONSTANTS * RESIDUALS];
    CHECK_OK(sn_problem_create(&def, &p));
    assert_int_equal(p->points, RESIDUALS);
    point_of(p, &c, x);
    assert_false(p->slopes);
    assert_true(sn_problem_jacobian(p, x, J));
    CHECK_ABS(worst_of(p, x, J), 0.0, 1e-6);
    J[RESIDUALS - 1] *= 1.001;
    assert_true(worst_of(p, x, J) > 1e-5);
    sn_problem_destroy(p);
    for (int k = 0; k < 2; ++k) sn_curve_release(&curve[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_pulls),
        cmocka_unit_test(lateral_pulls),
        cmocka_unit_test(mixed_curves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
