// Fits of dynamic curves: moduli over frequency, alone and with a pull.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 25 };
static const double two_pi = 6.28318530717958647693;

// rows backwards, as a machine that starts fast would write them
static sn_record *sweep_record(const double *storage, const double *loss, const double *frequency,
                               double mean) {
    sn_record *r;
    CHECK_OK(sn_record_create("sweep.csv", &r));
    CHECK_OK(sn_record_add_series(r, "frequency", "Hz"));
    CHECK_OK(sn_record_add_series(r, "storage_modulus", "Pa"));
    CHECK_OK(sn_record_add_series(r, "loss_modulus", "Pa"));
    if (mean > 0.0) CHECK_OK(sn_record_add_note(r, "mean_stretch", "m", mean));
    for (int i = ROWS - 1; i >= 0; --i)
        CHECK_OK(sn_record_append(r, (double[]){frequency[i], storage[i], loss[i]}));
    return r;
}

// A sweep of the virtual machine from 1 mHz to 100 Hz with noise of a part of each modulus.
static sn_curve sweep(const sn_tissue *tissue, double mean, double noise, uint64_t *seed) {
    sn_protocol protocol = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    sn_record *record;
    sn_curve c;
    protocol.stretch = mean;
    protocol.from = 1e-3;
    protocol.to = 100.0;
    protocol.points = ROWS;
    CHECK_OK(sn_lab_test(tissue, &protocol, &record));
    CHECK_OK(sn_curve_from_record(record, &c));
    sn_record_destroy(record);
    assert_int_equal(c.kind, SN_CURVE_DYNAMIC);
    assert_true(c.mean_stretch == mean); // the machine's record says it
    for (int i = 0; i < ROWS; ++i) {
        c.storage[i] *= 1.0 + noise * oracle_normal(seed);
        c.loss[i] *= 1.0 + noise * oracle_normal(seed);
    }
    return c;
}

static sn_tissue spectrum_tissue(const char *law, const double *value, int count) {
    sn_tissue t = oracle_tissue(law, value, count);
    t.memory = oracle_memory("fung-spectrum", 0, (double[]){0.2, 0.05, 20.0}, 3);
    return t;
}

//---- reading -------------------------------------------------------------------------------------

static void records_become_sweeps(void **state) {
    (void)state;
    double f[ROWS], s[ROWS], l[ROWS];
    for (int i = 0; i < ROWS; ++i) f[i] = 1.0 + i, s[i] = 1e3 + i, l[i] = 10.0 + i;
    sn_curve c;
    sn_record *r = sweep_record(s, l, f, 1.25);
    CHECK_OK(sn_curve_from_record(r, &c));
    assert_int_equal(c.kind, SN_CURVE_DYNAMIC);
    assert_string_equal(sn_curve_kind_name(c.kind), "dynamic");
    assert_true(c.count == ROWS && c.mean_stretch == 1.25);
    assert_true(!c.time && !c.stretch && !c.stress && !c.stretch_2 && !c.stress_2);
    for (int i = 0; i < ROWS; ++i) // put in the order of the frequency, each row whole
        assert_true(c.frequency[i] == f[i] && c.storage[i] == s[i] && c.loss[i] == l[i]);
    sn_tensile t;
    CHECK_FAILS(sn_reduce_tensile(&c, NULL, &t), SN_E_UNSUPPORTED,
                "a dynamic curve: a tensile test needs a uniaxial one");
    sn_cycles y;
    CHECK_FAILS(sn_reduce_cyclic(&c, &y), SN_E_UNSUPPORTED, "a dynamic curve");
    sn_creep_result w;
    CHECK_FAILS(sn_reduce_creep(&c, &w), SN_E_UNSUPPORTED, "a dynamic curve");
    sn_relaxation_result x;
    CHECK_FAILS(sn_reduce_relaxation(&c, &x), SN_E_UNSUPPORTED, "a dynamic curve");
    sn_biaxial_result b;
    CHECK_FAILS(sn_reduce_biaxial(&c, &b), SN_E_UNSUPPORTED, "a dynamic curve");
    sn_dynamic d;
    CHECK_FAILS(sn_reduce_oscillation(&c, &d), SN_E_UNSUPPORTED, "a dynamic curve");
    sn_curve_release(&c);
    sn_record_values(r, "frequency")[3] = 0.0;
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "row 4: frequency is 0");
    sn_record_values(r, "frequency")[3] = 1.0;
    sn_record_values(r, "loss_modulus")[2] = (double)NAN;
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "row 3: loss_modulus is");
    CHECK_OK(sn_record_add_series(r, "stress", "Pa"));
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "stress and storage_modulus");
    sn_record_destroy(r);

    r = sweep_record(s, l, f, 0.0);
    CHECK_OK(sn_curve_from_record(r, &c));
    assert_true(c.mean_stretch == 1.0);
    assert_non_null(strstr(c.remarks, "taken as 1"));
    sn_curve_release(&c);
    CHECK_OK(sn_record_add_note(r, "mean_stretch", "much", (double)NAN));
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "mean_stretch: much: expected a number");
    sn_record_destroy(r);

    CHECK_OK(sn_record_create("part.csv", &r));
    CHECK_OK(sn_record_add_series(r, "storage_modulus", "Pa"));
    CHECK_OK(sn_record_append(r, (double[]){1.0}));
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "no column frequency");
    sn_record_destroy(r);
}

//---- the model -----------------------------------------------------------------------------------

// A standard linear solid on a straight law: E (1 - g + g (w^2 + i w)/(1 + w^2)), w in 1/tau:
// closed form, 1e-13 is rounding
static void prediction_is_the_closed_form(void **state) {
    (void)state;
    uint64_t seed = 1;
    const double E = 3e4, g = 0.4, tau = 0.7;
    sn_tissue t = oracle_tissue("linear", &E, 1);
    t.memory = oracle_memory("prony", 1, (double[]){g, tau}, 2);
    sn_curve c = sweep(&t, 1.1, 0.0, &seed);
    sn_fit_curve p;
    CHECK_OK(sn_fit_predict(&t, &c, &p));
    for (int i = 0; i < ROWS; ++i) {
        double w = two_pi * c.frequency[i] * tau, part = g / (1.0 + w * w);
        CHECK_REL(p.predicted[i], E * (1.0 - g + part * w * w), 1e-13);
        CHECK_REL(p.predicted_2[i], E * part * w, 1e-13);
    }
    assert_true(p.used == ROWS && p.rmse == 0.0);
    sn_free(p.predicted);
    sn_free(p.predicted_2);
    sn_curve_release(&c);
}

//---- fits ----------------------------------------------------------------------------------------

// Exact data. Central differences of 1e-4 leave a Jacobian good to 1e-8, which slows the search but
// does not move its end: the constants come back to its own tolerance, 1e-6 of the residuals' root.
static void exact_sweep_gives_its_constants(void **state) {
    (void)state;
    uint64_t seed = 1;
    const double E = 2e4;
    sn_tissue t = spectrum_tissue("linear", &E, 1);
    sn_curve c = sweep(&t, 1.0, 0.0, &seed);
    sn_fit_def def = oracle_fit(&t, &c, 1);
    sn_fit_result r;
    CHECK_OK(sn_fit(&def, &r));
    assert_true(r.points == 2 * ROWS && r.converged && r.identifiable);
    CHECK_REL(r.tissue.value[0], E, 1e-6);
    for (int k = 0; k < 3; ++k) CHECK_REL(r.tissue.memory.value[k], t.memory.value[k], 1e-6);
    sn_fit_release(&r);
    sn_curve_release(&c);
}

// 95 % intervals of four constants in five sets of data: 20 in all, of which 1 is expected to miss
// and 5 or more have a chance of 0.3 %. The seeds are fixed.
static void noisy_sweeps_are_within_their_intervals(void **state) {
    (void)state;
    const double E = 2e4;
    sn_tissue t = spectrum_tissue("linear", &E, 1);
    const double truth[] = {E, 0.2, 0.05, 20.0};
    uint64_t seed = 20;
    int missed = 0;
    for (int set = 0; set < 5; ++set) {
        sn_curve c = sweep(&t, 1.0, 0.01, &seed);
        sn_fit_def def = oracle_fit(&t, &c, 1);
        sn_fit_result r;
        CHECK_OK(sn_fit(&def, &r));
        assert_true(r.converged && r.identifiable && r.param_count == 4);
        for (int k = 0; k < 4; ++k) {
            const sn_fit_param *p = &r.param[k];
            missed += !(p->ci95[0] < truth[k] && truth[k] < p->ci95[1]);
            // 1 % of 50 numbers: no interval is beyond a half of its value, none is empty
            double width = (p->ci95[1] - p->ci95[0]) / p->value;
            assert_true(width > 1e-4 && width < 0.5);
        }
        sn_fit_release(&r);
        sn_curve_release(&c);
    }
    assert_in_range(missed, 0, 4);
}

// A pull knows B and C, a sweep the fast times: together all five constants of one tissue.
static void sweep_and_pull_are_fitted_together(void **state) {
    (void)state;
    uint64_t seed = 3;
    sn_tissue t = spectrum_tissue("exponential", (double[]){12.0, 8e3}, 2);
    sn_curve c[2] = {sweep(&t, 1.1, 0.01, &seed), oracle_test(&t, SN_PROTOCOL_RELAXATION, 2.0, 60)};
    oracle_noise(&c[1], 0.003 * oracle_peak(&c[1]), &seed);
    sn_fit_def def = oracle_fit(&t, c, 2);
    def.weighting = SN_FIT_NOISE;
    sn_fit_result r;
    CHECK_OK(sn_fit(&def, &r));
    assert_true(r.converged && r.identifiable && r.points == 2 * ROWS + 60);
    static const char *const names[] = {"B", "C", "c", "tau1", "tau2"};
    const double truth[] = {12.0, 8e3, 0.2, 0.05, 20.0};
    for (int k = 0; k < 5; ++k) {
        const sn_fit_param *p = oracle_param(&r, names[k]);
        // three half widths of a 95 % interval: never left by noise
        double half = 0.5 * (p->ci95[1] - p->ci95[0]);
        CHECK_ABS(p->value, truth[k], 3.0 * half);
        assert_true(half < 0.25 * truth[k]);
    }
    assert_true(r.curve[0].predicted_2 && !r.curve[1].predicted_2);
    assert_true(r.curve[0].peak > r.curve[1].peak);
    sn_fit_release(&r);

    // the pull alone hides tau1 = 0.05 s in its ramp of 2 s
    def = oracle_fit(&t, c + 1, 1);
    CHECK_OK(sn_fit(&def, &r));
    assert_false(oracle_param(&r, "tau1")->identifiable);
    sn_fit_release(&r);
    // the sweep alone knows one slope: B and C are told from each other by nothing
    def = oracle_fit(&t, c, 1);
    CHECK_OK(sn_fit(&def, &r));
    const sn_fit_param *B = oracle_param(&r, "B");
    assert_false(B->identifiable);
    assert_non_null(strstr(B->reason, "every sweep is about the stretch 1.1"));
    assert_true(oracle_param(&r, "tau1")->identifiable);
    sn_fit_release(&r);
    for (int k = 0; k < 2; ++k) sn_curve_release(&c[k]);
}

// An incompressible solid moves its sides; two mean stretches tell c from alpha. Exact data, and
// the tolerance of the lateral equilibrium (1e-10 of the stretch) through the differences: 1e-5.
static void solid_is_fitted_from_two_stretches(void **state) {
    (void)state;
    uint64_t seed = 4;
    sn_tissue t = spectrum_tissue("demiray", (double[]){5e3, 3.0, (double)INFINITY}, 3);
    sn_curve c[2] = {sweep(&t, 1.02, 0.0, &seed), sweep(&t, 1.2, 0.0, &seed)};
    sn_fit_def def = oracle_fit(&t, c, 2);
    sn_fit_result r;
    CHECK_OK(sn_fit(&def, &r));
    assert_true(r.converged);
    for (int k = 0; k < 2; ++k) CHECK_REL(r.tissue.value[k], t.value[k], 1e-5);
    for (int k = 0; k < 3; ++k) CHECK_REL(r.tissue.memory.value[k], t.memory.value[k], 1e-5);
    sn_fit_release(&r);
    for (int k = 0; k < 2; ++k) sn_curve_release(&c[k]);
}

//---- what a sweep cannot show --------------------------------------------------------------------

// keeps the rows from `first`
static void cut(sn_curve *c, int first, int count) {
    double *const column[] = {c->frequency, c->storage, c->loss};
    for (int k = 0; k < 3; ++k)
        memmove(column[k], column[k] + first, (size_t)count * sizeof *column[k]);
    c->count = count;
}

static void times_outside_are_said(void **state) {
    (void)state;
    uint64_t seed = 5;
    const double E = 2e4;
    sn_tissue t = oracle_tissue("linear", &E, 1);
    t.memory = oracle_memory("fung-spectrum", 0, (double[]){0.2, 1e-3, 1e4}, 3);
    sn_curve c = sweep(&t, 1.0, 0.01, &seed);
    cut(&c, 6, 12); // to some 20 mHz and 3 Hz: 1/omega from 0.05 s to 8 s
    sn_fit_def def = oracle_fit(&t, &c, 1);
    sn_fit_result r;
    CHECK_OK(sn_fit(&def, &r));
    const sn_fit_param *fast = oracle_param(&r, "tau1"), *slow = oracle_param(&r, "tau2");
    assert_false(fast->identifiable);
    assert_non_null(strstr(fast->reason, "of the fastest oscillation"));
    assert_false(slow->identifiable);
    assert_non_null(strstr(slow->reason, "of the slowest oscillation"));
    sn_fit_release(&r);
    c.mean_stretch = 0.0;
    CHECK_FAILS(sn_fit(&def, &r), SN_E_DATA, "mean stretch 0: expected a number above 0");
    c.mean_stretch = 1.0;
    memset(c.storage, 0, (size_t)c.count * sizeof *c.storage);
    CHECK_FAILS(sn_fit(&def, &r), SN_E_DATA, "the storage modulus is 0 in every row");
    sn_curve_release(&c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_become_sweeps),
        cmocka_unit_test(prediction_is_the_closed_form),
        cmocka_unit_test(exact_sweep_gives_its_constants),
        cmocka_unit_test(noisy_sweeps_are_within_their_intervals),
        cmocka_unit_test(sweep_and_pull_are_fitted_together),
        cmocka_unit_test(solid_is_fitted_from_two_stretches),
        cmocka_unit_test(times_outside_are_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
