// Fits: recovery of known constants, intervals, identifiability, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { RAMPS = 4, RISING = 15, HELD = 35, ROWS = 1 + RISING + HELD };
static const double ramp_time[RAMPS] = {0.05, 1.0, 20.0, 100.0};

// a ramp and hold of a tissue, with normal noise of a part of its peak
static sn_curve virtual_ramp(const sn_tissue *tissue, double ramp, double top, double noise,
                             uint64_t *seed) {
    double time[ROWS] = {0.0}, stretch[ROWS] = {1.0}, stress[ROWS], peak = 0.0;
    for (int i = 1; i <= RISING; ++i) {
        time[i] = i == RISING ? ramp : ramp * i / RISING;
        stretch[i] = 1.0 + (top - 1.0) * i / RISING;
    }
    for (int i = 0; i < HELD; ++i) {
        time[1 + RISING + i] = ramp + pow(300.0, i / 34.0) - 1.0 + 0.01;
        stretch[1 + RISING + i] = top;
    }
    const double knots[] = {0.0, ramp, ramp + 1000.0}, value[] = {1.0, top, top};
    sn_history *h;
    CHECK_OK(sn_history_create(1, 3, knots, value, &h));
    CHECK_OK(sn_lab_uniaxial(tissue, h, ROWS, time, stress));
    sn_history_destroy(h);
    for (int i = 0; i < ROWS; ++i) peak = fmax(peak, fabs(stress[i]));
    for (int i = 1; i < ROWS; ++i) stress[i] += noise * peak * oracle_normal(seed);
    return oracle_curve("ramp", ROWS, time, stretch, stress);
}

static void virtual_ramps(const sn_tissue *tissue, double noise, uint64_t *seed,
                          sn_curve curve[RAMPS]) {
    for (int k = 0; k < RAMPS; ++k)
        curve[k] = virtual_ramp(tissue, ramp_time[k], 1.15, noise, seed);
}

static void release(sn_curve curve[RAMPS]) {
    for (int k = 0; k < RAMPS; ++k) sn_curve_release(&curve[k]);
}

//---- recovery ------------------------------------------------------------------------------------

// Data without noise: the constants come back. At these steps the model of a fit is good to 1e-7 of
// the peak; the constants may be off by that times the condition of the problem, some 10 to 100.
static void check_recovery(const char *law, const double *value, int count, sn_memory memory,
                           int memory_count) {
    uint64_t seed = 1;
    sn_tissue tissue = oracle_tissue(law, value, count);
    tissue.memory = memory;
    sn_curve curve[RAMPS];
    virtual_ramps(&tissue, 0.0, &seed, curve);
    sn_fit_def def = oracle_fit(&tissue, curve, RAMPS);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    if (!r->converged) print_message("%s x %s: %s\n", law, memory.law->name, r->reason);
    assert_true(r->converged);
    CHECK_ABS(r->r_squared, 1.0, 1e-10);
    for (int k = 0; k < count; ++k)
        if (isfinite(value[k])) CHECK_REL(r->tissue.value[k], value[k], 1e-5);
    // terms of a sum may come in any order
    int terms = memory.terms;
    for (int k = 0; k < memory_count; ++k) {
        double nearest = (double)INFINITY, v = memory.value[k];
        int from = terms ? k / terms * terms : k, to = terms ? from + terms : k + 1;
        for (int j = from; j < to; ++j)
            if (fabs(r->tissue.memory.value[j] - v) < fabs(nearest - v))
                nearest = r->tissue.memory.value[j];
        CHECK_REL(nearest, v, 1e-5);
    }
    sn_fit_release(r);
    sn_free(r);
    release(curve);
}

static void constants_come_back_without_noise(void **state) {
    (void)state;
    const double exponential[] = {11.7, 1.37e4}, demiray[] = {2.9e3, 7.3, (double)INFINITY};
    const double linear[] = {4.1e4}, neo[] = {5.3e3, (double)INFINITY};
    const double spectrum[] = {0.137, 0.061, 83.0}, prony[] = {0.23, 0.31, 0.19, 21.0};
    const double kelvin[] = {3.1, 5.7}, maxwell[] = {63.0}, voigt[] = {0.043};
    sn_memory none = sn_memory_none();
    check_recovery("exponential", exponential, 2, none, 0);
    check_recovery("exponential", exponential, 2, oracle_memory("fung-spectrum", 0, spectrum, 3),
                   3);
    check_recovery("exponential", exponential, 2, oracle_memory("prony", 2, prony, 4), 4);
    check_recovery("exponential", exponential, 2, oracle_memory("kelvin", 0, kelvin, 2), 2);
    check_recovery("linear", linear, 1, oracle_memory("maxwell", 0, maxwell, 1), 1);
    check_recovery("linear", linear, 1, oracle_memory("voigt", 0, voigt, 1), 1);
    check_recovery("demiray", demiray, 3, oracle_memory("fung-spectrum", 0, spectrum, 3), 3);
    check_recovery("neo-hookean", neo, 2, oracle_memory("prony", 2, prony, 4), 4);
}

// lists of one value a term are searched, and only where the law's own condition holds
static void ogden_is_fitted_by_terms(void **state) {
    (void)state;
    const double value[] = {-310.0, -6.7, (double)INFINITY};
    uint64_t seed = 1;
    sn_tissue tissue = oracle_tissue("ogden", value, 3);
    tissue.terms = 1;
    sn_curve curve = virtual_ramp(&tissue, 1.0, 1.3, 0.0, &seed);
    sn_fit_def def = oracle_fit(&tissue, &curve, 1);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    assert_int_equal(r->tissue.terms, 1);
    // no memory, no steps: what the search stops at
    CHECK_REL(oracle_param(r, "mu1")->value, value[0], 1e-6);
    CHECK_REL(oracle_param(r, "alpha1")->value, value[1], 1e-6);
    CHECK_OK(sn_tissue_check(&r->tissue));
    sn_fit_release(r);
    for (int i = 0; i < curve.count; ++i) curve.stress[i] = -curve.stress[i];
    CHECK_OK(sn_fit(&def, r)); // only mu alpha < 0 would follow this curve
    CHECK_OK(sn_tissue_check(&r->tissue));
    assert_true(r->r_squared < 0.5);
    sn_fit_release(r);
    def.law = sn_law_find("fung");
    CHECK_FAILS(sn_fit(&def, r), SN_E_UNSUPPORTED, "list a of 9 constants");
    def.law = sn_law_find("fung-general");
    CHECK_FAILS(sn_fit(&def, r), SN_E_UNSUPPORTED, "list alpha of 9 constants");
    sn_free(r);
    sn_curve_release(&curve);
}

// a finite bulk modulus is taken when it is fixed, and is no parameter when it is not
static void bulk_modulus_is_fixed_or_infinite(void **state) {
    (void)state;
    const double value[] = {5.3e3, 1.1e4}, g[] = {0.4, 2.0};
    uint64_t seed = 1;
    sn_tissue tissue = oracle_tissue("neo-hookean", value, 2);
    tissue.memory = oracle_memory("prony", 1, g, 2);
    sn_curve curve = virtual_ramp(&tissue, 1.0, 1.3, 0.0, &seed);
    sn_fit_def def = oracle_fit(&tissue, &curve, 1);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    assert_true(isinf(r->tissue.value[1]));
    assert_true(oracle_param(r, "bulk_modulus")->fixed);
    assert_true(isnan(oracle_param(r, "bulk_modulus")->standard_error));
    sn_fit_release(r);
    def.fixed_count = 1;
    def.fixed_name[0] = "bulk_modulus";
    def.fixed_value[0] = 1.1e4;
    CHECK_OK(sn_fit(&def, r));
    assert_true(r->tissue.value[1] == 1.1e4);
    CHECK_REL(r->tissue.value[0], 5.3e3, 5e-4); // steps of second order: 1e-4 of the peak
    CHECK_REL(r->tissue.memory.value[0], 0.4, 5e-4);
    sn_fit_release(r);
    sn_free(r);
    sn_curve_release(&curve);
}

//---- noise ---------------------------------------------------------------------------------------

static const char *const names[] = {"B", "C", "c", "tau1", "tau2"};

static sn_tissue random_tissue(uint64_t *seed, double truth[5]) {
    truth[0] = check_random(seed, 6.0, 20.0);
    truth[1] = check_random(seed, 5e3, 3e4);
    truth[2] = check_random(seed, 0.08, 0.3);
    truth[3] = check_random(seed, 0.05, 0.15);
    truth[4] = check_random(seed, 30.0, 120.0);
    sn_tissue tissue = oracle_tissue("exponential", truth, 2);
    tissue.memory = oracle_memory("fung-spectrum", 0, truth + 2, 3);
    return tissue;
}

// Four ramps with 1 % noise: every truth within its interval widened by its width on both sides,
// and 95 % intervals hold about 95 % of the truths: of 40, fewer than 32 has a chance under 1e-3.
// One ramp alone does not tell the constants apart.
static void noisy_ramps_give_intervals(void **state) {
    (void)state;
    enum { REPEATS = 8 };
    uint64_t seed = 2024;
    int held = 0;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    for (int k = 0; k < REPEATS; ++k) {
        double truth[5];
        sn_tissue tissue = random_tissue(&seed, truth);
        sn_curve curve[RAMPS];
        virtual_ramps(&tissue, 0.01, &seed, curve);
        sn_fit_def def = oracle_fit(&tissue, curve, RAMPS);
        CHECK_OK(sn_fit(&def, r));
        assert_true(r->converged && r->r_squared > 0.995);
        assert_int_equal(r->points, RAMPS * ROWS);
        for (int j = 0; j < 5; ++j) {
            const sn_fit_param *p = oracle_param(r, names[j]);
            double width = p->ci95[1] - p->ci95[0];
            held += p->ci95[0] <= truth[j] && truth[j] <= p->ci95[1];
            assert_true(p->ci95[0] < p->value && p->value < p->ci95[1]);
            assert_true(p->ci95[0] - width <= truth[j] && truth[j] <= p->ci95[1] + width);
        }
        sn_fit_release(r);
        def.curve = &curve[1];
        def.curve_count = 1;
        CHECK_OK(sn_fit(&def, r));
        assert_false(r->identifiable);
        assert_false(oracle_param(r, "tau1")->identifiable);
        assert_true(strlen(oracle_param(r, "tau1")->reason) > 10);
        sn_fit_release(r);
        release(curve);
    }
    assert_true(held >= 32);
    sn_free(r);
}

// A linear law without memory is linear regression through the origin: estimate, error and R2 have
// closed forms.
// Thousands of rows: the start comes from a part of them, the constants from all. Noise of 1 % of
// the peak on 3000 rows leaves errors of about 1 % / sqrt(3000) times the condition (10 to 100): 2
// %.
static void long_records(void **state) {
    (void)state;
    uint64_t seed = 77;
    sn_tissue tissue = oracle_tissue("exponential", (const double[]){13, 9e3}, 2);
    tissue.memory =
        (sn_memory){.law = sn_memory_law_find("fung-spectrum"), .value = {0.17, 0.09, 55}};
    sn_curve curve[RAMPS] = {0};
    sn_protocol protocol = sn_protocol_default(SN_PROTOCOL_RELAXATION);
    protocol.stretch = 1.15;
    protocol.hold = 250;
    for (int k = 0; k < RAMPS; ++k) {
        sn_record *record;
        protocol.ramp = ramp_time[k];
        protocol.points = k == 1 ? 20 : 1000; // a short record among long ones
        CHECK_OK(sn_lab_test(&tissue, &protocol, &record));
        CHECK_OK(sn_curve_from_record(record, &curve[k]));
        sn_record_destroy(record);
        double peak = 0.0;
        for (int i = 0; i < curve[k].count; ++i) peak = fmax(peak, curve[k].stress[i]);
        for (int i = 1; i < curve[k].count; ++i)
            curve[k].stress[i] += 0.01 * peak * oracle_normal(&seed);
    }
    sn_fit_def def = oracle_fit(&tissue, curve, RAMPS);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    assert_true(r->converged);
    assert_int_equal(r->points, 3020);
    CHECK_REL(oracle_param(r, "B")->value, 13, 0.02);
    CHECK_REL(oracle_param(r, "C")->value, 9e3, 0.02 * 3); // tied to B
    CHECK_REL(oracle_param(r, "c")->value, 0.17, 0.02 * 3);
    assert_true(r->r_squared > 0.998);
    release(curve);
    sn_fit_release(r);
    sn_free(r);
}

static void linear_law_is_linear_regression(void **state) {
    (void)state;
    enum { N = 25 };
    double stretch[N], stress[N], xx = 0.0, xy = 0.0, sse = 0.0, sst = 0.0, mean = 0.0;
    uint64_t seed = 8;
    for (int i = 0; i < N; ++i) {
        stretch[i] = 1.0 + 0.01 * i;
        stress[i] = 3.7e4 * 0.01 * i + 250.0 * oracle_normal(&seed);
        xx += 1e-4 * i * i;
        xy += 0.01 * i * stress[i];
        mean += stress[i] / N;
    }
    double slope = xy / xx;
    for (int i = 0; i < N; ++i) {
        sse += pow(stress[i] - slope * 0.01 * i, 2.0);
        sst += pow(stress[i] - mean, 2.0);
    }
    sn_curve curve = oracle_curve("line", N, NULL, stretch, stress); // no time: none is needed
    sn_fit_def def = sn_fit_def_default();
    def.curve = &curve;
    def.curve_count = 1;
    def.law = sn_law_find("linear");
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    double error = sqrt(sse / (N - 1) / xx), t = 2.0638986; // Student, 24 degrees of freedom
    CHECK_REL(r->param[0].value, slope, 1e-7);
    CHECK_REL(r->param[0].standard_error, error, 1e-5);
    CHECK_REL(log(r->param[0].ci95[1] / slope), t * error / slope, 1e-3); // logarithmic scale
    CHECK_REL(r->r_squared, 1.0 - sse / sst, 1e-10);
    CHECK_REL(r->rmse, sqrt(sse / N), 1e-10);
    double aicc = N * log(sse / N) + 4.0 + 12.0 / (N - 3.0);
    CHECK_REL(r->aicc, aicc, 1e-10);
    assert_true(r->identifiable && r->correlation[0] == 1.0);
    sn_fit_release(r);

    // scaling one curve's weight scales its squares: two lines of slopes 1 and 3 average by weight
    double one[N], three[N];
    for (int i = 0; i < N; ++i) {
        one[i] = 1e4 * 0.01 * i;
        three[i] = 3e4 * 0.01 * i;
    }
    sn_curve two[] = {oracle_curve("one", N, NULL, stretch, one),
                      oracle_curve("three", N, NULL, stretch, three)};
    const double weight[] = {3.0, 1.0};
    def.curve = two;
    def.curve_count = 2;
    def.weight = weight;
    CHECK_OK(sn_fit(&def, r));
    CHECK_REL(r->param[0].value, 1.5e4, 1e-6);
    assert_int_equal(r->curve[1].worst, N - 1);
    CHECK_REL(r->curve[1].peak, three[N - 1], 1e-12);
    sn_fit_release(r);
    sn_free(r);
    sn_curve_release(&curve);
    sn_curve_release(&two[0]);
    sn_curve_release(&two[1]);
}

static void same_input_gives_same_bits_and_seeds_agree(void **state) {
    (void)state;
    uint64_t seed = 5;
    double truth[5];
    sn_tissue tissue = random_tissue(&seed, truth);
    sn_curve curve[RAMPS];
    virtual_ramps(&tissue, 0.01, &seed, curve);
    sn_fit_def def = oracle_fit(&tissue, curve, RAMPS);
    sn_fit_result *r[3];
    for (int k = 0; k < 3; ++k) {
        r[k] = sn_alloc(1, sizeof **r);
        def.seed = k == 2 ? 99 : 7;
        CHECK_OK(sn_fit(&def, r[k]));
    }
    for (int j = 0; j < 5; ++j) {
        assert_true(r[0]->param[j].value == r[1]->param[j].value);
        assert_true(r[0]->param[j].ci95[0] == r[1]->param[j].ci95[0]);
        CHECK_REL(r[2]->param[j].value, r[0]->param[j].value, 1e-6);
    }
    for (int k = 0; k < 3; ++k) {
        sn_fit_release(r[k]);
        sn_free(r[k]);
    }
    release(curve);
}

// a name that law and memory share, a fixed constant, and the progress reports
static void count_progress(void *context, double done, const char *text) {
    assert_true(done >= 0.0 && done <= 1.0 && strlen(text) > 0);
    ++*(int *)context;
}

static void shared_names_and_fixed_constants(void **state) {
    (void)state;
    const double value[] = {2.9e3, 7.3, (double)INFINITY}, spectrum[] = {0.137, 0.061, 83.0};
    uint64_t seed = 1;
    int reports = 0;
    sn_tissue tissue = oracle_tissue("demiray", value, 3);
    tissue.memory = oracle_memory("fung-spectrum", 0, spectrum, 3);
    sn_curve curve[RAMPS];
    virtual_ramps(&tissue, 0.0, &seed, curve);
    sn_fit_def def = oracle_fit(&tissue, curve, RAMPS);
    def.fixed_count = 2;
    def.fixed_name[0] = "memory.c";
    def.fixed_value[0] = 0.137;
    def.fixed_name[1] = "tau1";
    def.fixed_value[1] = 0.061;
    def.progress = count_progress;
    def.progress_context = &reports;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    assert_true(oracle_param(r, "memory.c")->fixed && oracle_param(r, "memory.c")->value == 0.137);
    assert_false(oracle_param(r, "c")->fixed);
    CHECK_REL(oracle_param(r, "c")->value, 2.9e3, 1e-5);
    CHECK_REL(oracle_param(r, "tau2")->value, 83.0, 1e-5);
    assert_true(reports >= 3);

    // the tissue predicts its own data
    sn_fit_curve prediction;
    CHECK_OK(sn_fit_predict(&r->tissue, &curve[2], &prediction));
    assert_int_equal(prediction.count, ROWS);
    assert_true(prediction.rmse < 1e-6 * prediction.peak && prediction.r_squared > 1.0 - 1e-6);
    for (int i = 0; i < ROWS; ++i)
        CHECK_ABS(prediction.predicted[i], r->curve[2].predicted[i], 1e-6 * prediction.peak);
    sn_free(prediction.predicted);
    sn_fit_release(r);
    sn_free(r);
    release(curve);
}

//---- refusals ------------------------------------------------------------------------------------

static void refusals_say_what_and_where(void **state) {
    (void)state;
    const double t[] = {0.0, 1.0, 2.0, 3.0}, l[] = {1.0, 1.1, 1.2, 1.3}, f[] = {0.0, 1.0, 2.0, 3.0};
    const double still[] = {1.2, 1.2, 1.2, 1.2}, zero[] = {0.0, 0.0, 0.0, 0.0};
    const double late[] = {1.05, 1.1, 1.2, 1.3}, bad_weight = -1.0;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    sn_fit_def def = sn_fit_def_default();
    CHECK_FAILS(sn_fit(&def, r), SN_E_DEFINITION, "a law and 1 to 32 curves");
    sn_curve good = oracle_curve("good", 4, t, l, f);
    def.curve = &good;
    def.curve_count = 1;
    def.law = sn_law_find("exponential");
    def.memory = sn_memory_law_find("fung-spectrum");
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "4 rows for 5 constants");

    sn_curve timeless = oracle_curve("timeless", 4, NULL, l, f);
    def.curve = &timeless;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "timeless: no time column");
    sn_fit_curve prediction;
    sn_tissue tissue = oracle_tissue("linear", (const double[]){1e4}, 1);
    tissue.memory = oracle_memory("maxwell", 0, (const double[]){1.0}, 1);
    CHECK_FAILS(sn_fit_predict(&tissue, &timeless, &prediction), SN_E_DATA, "no time column");
    assert_null(prediction.predicted);

    sn_curve quiet = oracle_curve("quiet", 4, t, still, f);
    def.curve = &quiet;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "quiet: the stretch is 1.2 in every row");
    sn_curve slack = oracle_curve("slack", 4, t, l, zero);
    def.curve = &slack;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "slack: the stress is 0");
    sn_curve stepped = oracle_curve("stepped", 4, t, late, f);
    def.curve = &stepped;
    def.law = sn_law_find("linear");
    def.memory = sn_memory_law_find("voigt");
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "stepped: the curve starts at stretch 1.05");

    def.curve = &good;
    def.weight = &bad_weight;
    CHECK_FAILS(sn_fit(&def, r), SN_E_RANGE, "good: weight -1");
    def.weight = NULL;
    def.fixed_count = 1;
    def.fixed_name[0] = "modulos";
    def.fixed_value[0] = 1.0;
    CHECK_FAILS(sn_fit(&def, r), SN_E_NAME, "did you mean \"modulus\"");
    def.fixed_name[0] = "modulus";
    def.fixed_value[0] = -1.0;
    CHECK_FAILS(sn_fit(&def, r), SN_E_RANGE, "modulus");
    def.fixed_count = 33;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DEFINITION, "33 fixed constants");
    def.fixed_count = 0;
    def.memory = sn_memory_law_find("prony");
    def.terms = 13;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DEFINITION, "13 of the memory");
    good.count = 2;
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "good: 2 rows");
    good.count = 4;
    sn_law membrane = *def.law;
    membrane.kind = SN_LAW_MEMBRANE;
    def.law = &membrane;
    CHECK_FAILS(sn_fit(&def, r), SN_E_UNSUPPORTED, "membrane");
    sn_free(r);
    sn_curve_release(&good);
    sn_curve_release(&timeless);
    sn_curve_release(&quiet);
    sn_curve_release(&slack);
    sn_curve_release(&stepped);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_come_back_without_noise),
        cmocka_unit_test(ogden_is_fitted_by_terms),
        cmocka_unit_test(bulk_modulus_is_fixed_or_infinite),
        cmocka_unit_test(noisy_ramps_give_intervals),
        cmocka_unit_test(long_records),
        cmocka_unit_test(linear_law_is_linear_regression),
        cmocka_unit_test(same_input_gives_same_bits_and_seeds_agree),
        cmocka_unit_test(shared_names_and_fixed_constants),
        cmocka_unit_test(refusals_say_what_and_where),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
