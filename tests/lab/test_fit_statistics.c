// What a fit says about its constants: recovery, weights, windows, bootstrap, numbers of terms.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { CONSTANTS = 5, MOST = 4 };
static const char *const names[CONSTANTS] = {"B", "C", "c", "tau1", "tau2"};
static const double truth[CONSTANTS] = {11.0, 12e3, 0.15, 0.08, 60.0};

static sn_tissue spectrum_tissue(void) {
    sn_tissue tissue = oracle_tissue("exponential", truth, 2);
    tissue.memory = oracle_memory("fung-spectrum", 0, truth + 2, 3);
    return tissue;
}

static void release(sn_curve *curve, int count) {
    for (int k = 0; k < count; ++k) sn_curve_release(&curve[k]);
}

//---- recovery ------------------------------------------------------------------------------------

// Where the tests show every constant, B, C and c come back within 5 % and all five within twice
// their 95 % intervals (a chance of 1e-4 to miss one; the seed is fixed). verification/coverage.c
// counts how often the intervals themselves hold.
static void check_known(const sn_curve *curve, int count, int points) {
    sn_tissue tissue = spectrum_tissue();
    sn_fit_def def = oracle_fit(&tissue, curve, count);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    assert_true(r->converged && r->identifiable);
    assert_int_equal(r->points, points);
    assert_string_equal(r->determined, "");
    for (int j = 0; j < CONSTANTS; ++j) {
        const sn_fit_param *p = oracle_param(r, names[j]);
        if (j < 3) CHECK_REL(p->value, truth[j], 0.05);
        CHECK_ABS(p->value, truth[j], p->ci95[1] - p->ci95[0]);
    }
    for (int k = 0; k < count; ++k) // white noise: 2, with an error of 2/sqrt(n); four errors
        CHECK_ABS(r->curve[k].durbin_watson, 2.0, 8.0 / sqrt(curve[k].count));
    sn_fit_release(r);
    sn_free(r);
}

static void known_constants_come_back(void **state) {
    (void)state;
    static const double ramp[MOST] = {0.05, 1.0, 20.0, 100.0};
    uint64_t seed = 31;
    sn_tissue tissue = spectrum_tissue();
    sn_curve curve[MOST];
    for (int k = 0; k < MOST; ++k) {
        curve[k] = oracle_test(&tissue, SN_PROTOCOL_RELAXATION, ramp[k], 150);
        oracle_noise(&curve[k], 0.01 * oracle_peak(&curve[k]), &seed);
    }
    check_known(curve, MOST, 600);
    release(curve, MOST);
    curve[0] = oracle_test(&tissue, SN_PROTOCOL_RELAXATION, 0.05, 300);
    curve[1] = oracle_test(&tissue, SN_PROTOCOL_CYCLIC, 2.0, 300);
    for (int k = 0; k < 2; ++k) oracle_noise(&curve[k], 0.01 * oracle_peak(&curve[k]), &seed);
    check_known(curve, 2, 600);
    release(curve, 2);
}

// One ramp and hold: tau1 is hidden, and the fit says so and what it does know. Its curve is right
// to the noise: the error of the prediction against the noiseless stress is that of five constants
// from 600 rows, noise * sqrt(5/600) = 0.09 noise; half the noise would be a defect.
static void one_ramp_does_not_know_all(void **state) {
    (void)state;
    uint64_t seed = 5;
    sn_tissue tissue = spectrum_tissue();
    sn_curve clean = oracle_test(&tissue, SN_PROTOCOL_RELAXATION, 2.0, 600);
    sn_curve curve = oracle_test(&tissue, SN_PROTOCOL_RELAXATION, 2.0, 600);
    double noise = 0.01 * oracle_peak(&curve), error = 0.0;
    oracle_noise(&curve, noise, &seed);
    sn_fit_def def = oracle_fit(&tissue, &curve, 1);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    print_message("determined: %s\nweakest: %s\n", r->determined, r->weakest);
    assert_false(r->identifiable || oracle_param(r, "tau1")->identifiable);
    assert_non_null(strstr(r->weakest, "ln tau1"));
    assert_non_null(strstr(r->determined, "C"));
    assert_non_null(strstr(r->determined, "in SI units"));
    for (int i = 0; i < clean.count; ++i)
        error += pow(r->curve[0].predicted[i] - clean.stress[i], 2.0) / clean.count;
    assert_true(sqrt(error) < 0.5 * noise);
    sn_fit_release(r);
    sn_free(r);
    sn_curve_release(&clean);
    sn_curve_release(&curve);
}

//---- lines: everything has a closed form ---------------------------------------------------------

enum { ROWS = 200 };

// stress = slope * strain + noise that grows with the strain by `grow`
static sn_curve line(double slope, double noise, double grow, uint64_t *seed) {
    double time[ROWS], stretch[ROWS], stress[ROWS];
    for (int i = 0; i < ROWS; ++i) {
        double strain = 0.1 * i / (ROWS - 1.0);
        time[i] = 0.01 * i;
        stretch[i] = 1.0 + strain;
        stress[i] = slope * strain + noise * (1.0 + grow * strain) * oracle_normal(seed);
    }
    return oracle_curve("line", ROWS, time, stretch, stress);
}

static sn_fit_def fit_line(const sn_curve *curve, int count) {
    sn_tissue tissue = oracle_tissue("linear", (const double[]){1.0}, 1);
    return oracle_fit(&tissue, curve, count);
}

// Wild refits of a line through the origin have the variance sum x^2 r^2 / (sum x^2)^2 n/(n-1)
// exactly; a percentile of 2000 of them is known to 3 % of the half-width (the quantile's error
// sqrt(q(1-q)/N)/density = 0.06 of a standard error of 1.96), here four of those errors.
static void bootstrap_has_the_variance_of_the_residuals(void **state) {
    (void)state;
    uint64_t seed = 8;
    sn_curve curve = line(4e4, 60.0, 30.0, &seed);
    sn_fit_def def = fit_line(&curve, 1);
    sn_fit_result *r[2];
    def.bootstrap = 2000;
    for (int k = 0; k < 2; ++k) {
        r[k] = sn_alloc(1, sizeof **r);
        CHECK_OK(sn_fit(&def, r[k]));
    }
    const sn_fit_param *p = &r[0]->param[0];
    double xx = 0.0, xr = 0.0;
    for (int i = 0; i < ROWS; ++i) {
        double x = curve.stretch[i] - 1.0, residual = curve.stress[i] - p->value * x;
        xx += x * x;
        xr += x * x * residual * residual;
    }
    double error = sqrt(xr * ROWS / (ROWS - 1.0)) / xx;
    CHECK_REL(p->ci95_bootstrap[1] - p->ci95_bootstrap[0], 2.0 * 1.96 * error, 0.12);
    CHECK_REL(p->ci95_bootstrap[1] + p->ci95_bootstrap[0], 2.0 * p->value, 0.01);
    // the noise grows where the lever is long: the linearised error is too small, and this shows it
    assert_true(error > 1.2 * p->standard_error);
    assert_int_equal(r[0]->bootstrap.asked, 2000);
    assert_int_equal(r[0]->bootstrap.done, 2000);
    assert_int_equal(r[0]->bootstrap.block, 1);
    assert_string_equal(r[0]->bootstrap.reason, "");
    for (int side = 0; side < 2; ++side) // same seed, same bits
        assert_true(p->ci95_bootstrap[side] == r[1]->param[0].ci95_bootstrap[side]);
    sn_fit_release(r[1]);
    def.seed = 2;
    CHECK_OK(sn_fit(&def, r[1]));
    assert_true(p->value == r[1]->param[0].value ||
                fabs(p->value / r[1]->param[0].value - 1) < 1e-9);
    assert_true(p->ci95_bootstrap[0] != r[1]->param[0].ci95_bootstrap[0]);
    sn_fit_release(r[1]);
    def.bootstrap = SN_FIT_BOOTSTRAP_MIN - 1;
    CHECK_FAILS(sn_fit(&def, r[1]), SN_E_RANGE, "39 bootstrap refits: expected 0 or at least 40");
    sn_fit_release(r[0]);
    for (int k = 0; k < 2; ++k) sn_free(r[k]);
    sn_curve_release(&curve);
}

// Residuals that wander: errors are drawn in blocks and the intervals are wider than those of white
// noise, for r_i = 0.9 r_(i-1) + e_i by up to sqrt((1 + 0.9)/(1 - 0.9)) = 4.4.
static void correlated_residuals_widen_the_bootstrap(void **state) {
    (void)state;
    uint64_t seed = 3;
    sn_curve curve = line(4e4, 0.0, 0.0, &seed);
    double drift = 0.0;
    for (int i = 0; i < ROWS; ++i) {
        drift = 0.9 * drift + 40.0 * oracle_normal(&seed);
        curve.stress[i] += drift;
    }
    sn_fit_def def = fit_line(&curve, 1);
    def.bootstrap = 500;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    const sn_fit_param *p = &r->param[0];
    assert_true(r->curve[0].durbin_watson < 0.6); // 2 (1 - 0.9) and its error
    assert_true(r->bootstrap.block >= 5 && r->bootstrap.block <= ROWS / 5);
    assert_true(p->ci95_bootstrap[1] - p->ci95_bootstrap[0] > 1.5 * (p->ci95[1] - p->ci95[0]));
    sn_fit_release(r);
    sn_free(r);
    sn_curve_release(&curve);
}

// two lines through the origin, slopes 1 and 3, weighed: sum w x y / sum w x^2
static void weights_are_what_was_asked(void **state) {
    (void)state;
    uint64_t seed = 4;
    sn_curve curve[2] = {line(1e4, 0.0, 0.0, &seed), line(3e4, 0.0, 0.0, &seed)};
    sn_fit_def def = fit_line(curve, 2);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    def.weighting = SN_FIT_PEAK;
    CHECK_OK(sn_fit(&def, r));
    CHECK_REL(r->curve[0].weight, 9.0, 1e-12);
    CHECK_REL(r->curve[1].weight, 1.0, 1e-12);
    CHECK_REL(r->param[0].value, (9.0 * 1e4 + 3e4) / 10.0, 1e-6);
    sn_fit_release(r);
    const double own[] = {1.0, 9.0};
    def.weight = own; // times the peaks': even
    CHECK_OK(sn_fit(&def, r));
    CHECK_REL(r->param[0].value, 2e4, 1e-6);
    sn_fit_release(r);
    release(curve, 2);
    def.weight = NULL;

    // noise of 20 Pa and 200 Pa on one line: weights 100 to 1 (variances of 200 rows are known to
    // sqrt(2/200) = 10 % each, four errors of both), and the error is that of the quiet curve
    curve[0] = line(2e4, 20.0, 0.0, &seed);
    curve[1] = line(2e4, 200.0, 0.0, &seed);
    double plain;
    def.weighting = SN_FIT_PLAIN;
    CHECK_OK(sn_fit(&def, r));
    plain = r->param[0].standard_error;
    double aicc = r->aicc;
    sn_fit_release(r);
    def.weighting = SN_FIT_NOISE;
    CHECK_OK(sn_fit(&def, r));
    assert_true(r->converged);
    CHECK_REL(r->curve[0].weight / r->curve[1].weight, 100.0, 0.6);
    assert_true(r->param[0].standard_error < 0.3 * plain);
    assert_true(r->aicc < aicc - 100.0); // two variances explain these data, one does not
    CHECK_ABS(r->param[0].value, 2e4, 4.0 * r->param[0].standard_error);
    sn_fit_release(r);

    for (int i = 0; i < ROWS; ++i) curve[0].stress[i] = 0.0;
    def.weighting = SN_FIT_PEAK;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "line: the stress is 0 in every row of the window");
    sn_free(r);
    release(curve, 2);
}

// Rows outside the window are not fitted, yet they are the history of the rows inside.
static void a_window_keeps_the_history(void **state) {
    (void)state;
    uint64_t seed = 6;
    sn_tissue tissue = oracle_tissue("linear", (const double[]){3e4}, 1);
    tissue.memory = oracle_memory("maxwell", 0, (const double[]){20.0}, 1);
    sn_curve curve = oracle_test(&tissue, SN_PROTOCOL_RELAXATION, 2.0, 200);
    sn_fit_def def = oracle_fit(&tissue, &curve, 1);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    int inside = 0;
    for (int i = 0; i < curve.count; ++i) {
        bool in = curve.time[i] >= 5.0 && curve.time[i] <= 60.0;
        inside += in;
        if (!in) curve.stress[i] += 3e2 * oracle_normal(&seed); // rubbish that must not count
    }
    def.from = 5.0;
    def.to = 60.0;
    CHECK_OK(sn_fit(&def, r));
    assert_int_equal(r->points, inside);
    assert_int_equal(r->curve[0].used, inside);
    assert_true(curve.time[r->curve[0].first] >= 5.0 && curve.time[r->curve[0].first - 1] < 5.0);
    CHECK_REL(oracle_param(r, "modulus")->value, 3e4, 1e-5);
    CHECK_REL(oracle_param(r, "tau")->value, 20.0, 1e-5);
    sn_fit_release(r);
    def.from = 1e4;
    def.to = 2e4;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "no row from 10000 to 20000 s");
    sn_free(r);
    sn_curve_release(&curve);
}

//---- number of terms -----------------------------------------------------------------------------

static void terms_are_chosen_by_aicc(void **state) {
    (void)state;
    const double two[] = {0.3, 0.25, 0.5, 30.0};
    uint64_t seed = 12;
    sn_tissue tissue = oracle_tissue("exponential", truth, 2);
    tissue.memory = oracle_memory("prony", 2, two, 4);
    sn_curve curve[2] = {oracle_test(&tissue, SN_PROTOCOL_RELAXATION, 0.2, 120),
                         oracle_test(&tissue, SN_PROTOCOL_RELAXATION, 20.0, 120)};
    for (int k = 0; k < 2; ++k) oracle_noise(&curve[k], 0.01 * oracle_peak(&curve[k]), &seed);
    sn_fit_def def = oracle_fit(&tissue, curve, 2);
    sn_fit_choice choice;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit_choose_terms(&def, false, 4, &choice, r));
    print_message("%s\n", choice.reason);
    assert_int_equal(choice.count, 4);
    assert_int_equal(choice.trial[choice.best].terms, 2);
    assert_int_equal(r->tissue.memory.terms, 2);
    assert_int_equal(choice.trial[2].constants, 8);
    assert_true(choice.second != choice.best);
    assert_true(choice.trial[0].aicc > choice.trial[1].aicc + 100.0); // one term misses plainly
    CHECK_REL(r->aicc, choice.trial[choice.best].aicc, 1e-12);
    for (int i = 1; i < choice.count; ++i) // more constants fit no worse, but for the search's end
        assert_true(choice.trial[i].rmse < choice.trial[i - 1].rmse * 1.002);
    assert_non_null(strstr(choice.reason, "2 terms: least AICc"));
    sn_fit_release(r);

    CHECK_FAILS(sn_fit_choose_terms(&def, true, 3, &choice, r), SN_E_UNSUPPORTED,
                "law exponential has no terms");
    CHECK_FAILS(sn_fit_choose_terms(&def, false, 13, &choice, r), SN_E_RANGE, "expected 1 to 12");
    def.memory = NULL;
    CHECK_FAILS(sn_fit_choose_terms(&def, false, 3, &choice, r), SN_E_UNSUPPORTED,
                "memory none has no terms");
    release(curve, 2);

    // ten rows carry no more than three terms of five, seven and nine constants (2 + 2 N)
    double t[10], l[10], s[10];
    for (int i = 0; i < 10; ++i) {
        t[i] = i;
        l[i] = 1.0 + 0.01 * i;
        s[i] = 120.0 * i + 7.0 * oracle_normal(&seed);
    }
    curve[0] = oracle_curve("short", 10, t, l, s);
    def = oracle_fit(&tissue, curve, 1);
    CHECK_OK(sn_fit_choose_terms(&def, false, 8, &choice, r));
    assert_int_equal(choice.count, 3);
    assert_non_null(strstr(choice.reason, "10 rows for 10 constants"));
    sn_fit_release(r);
    sn_curve_release(&curve[0]);
    sn_free(r);
}

static void terms_of_a_law(void **state) {
    (void)state;
    const double value[] = {900.0, -60.0, 2.5, -9.0, (double)INFINITY};
    uint64_t seed = 2;
    sn_tissue tissue = oracle_tissue("ogden", value, 3);
    memcpy(tissue.value, value, sizeof value);
    tissue.terms = 2;
    sn_curve curve = oracle_test(&tissue, SN_PROTOCOL_TENSILE, 1.0, 150);
    oracle_noise(&curve, 0.002 * oracle_peak(&curve), &seed);
    sn_fit_def def = oracle_fit(&tissue, &curve, 1);
    sn_fit_choice choice;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit_choose_terms(&def, true, 2, &choice, r));
    print_message("%s\n", choice.reason);
    assert_int_equal(choice.count, 2);
    assert_int_equal(choice.trial[1].constants, 4);
    assert_true(choice.trial[1].aicc < choice.trial[0].aicc - 5.0);
    assert_int_equal(choice.trial[choice.best].terms, 2);
    assert_int_equal(r->tissue.terms, choice.trial[choice.best].terms);
    sn_fit_release(r);
    sn_free(r);
    sn_curve_release(&curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_constants_come_back),
        cmocka_unit_test(one_ramp_does_not_know_all),
        cmocka_unit_test(bootstrap_has_the_variance_of_the_residuals),
        cmocka_unit_test(correlated_residuals_widen_the_bootstrap),
        cmocka_unit_test(weights_are_what_was_asked),
        cmocka_unit_test(a_window_keeps_the_history),
        cmocka_unit_test(terms_are_chosen_by_aicc),
        cmocka_unit_test(terms_of_a_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
