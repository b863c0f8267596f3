// Derivatives of the relaxation functions by their constants.
// SPDX-License-Identifier: Apache-2.0
#include "samples.h"

static int values_of(const sn_memory *m) {
    return sn_param_offset(m->law->params, m->law->param_count, m->terms);
}

// G with constant k multiplied by `factor`
static double moved(const sn_memory *m, int k, double factor, double t) {
    sn_memory other = *m;
    other.value[k] *= factor;
    return sn_memory_relaxation(&other, t);
}

// dG/d(ln p) by central differences, with steps of 4e-3 and 2e-3 extrapolated to the fourth order.
static double difference(const sn_memory *m, int k, double t) {
    double coarse = 4e-3, fine = 2e-3;
    double c = (moved(m, k, 1 + coarse, t) - moved(m, k, 1 - coarse, t)) / (2 * coarse);
    double f = (moved(m, k, 1 + fine, t) - moved(m, k, 1 - fine, t)) / (2 * fine);
    return f + (f - c) / 3;
}

static void check_memory(const sn_memory *m, int *seen) {
    sn_memory_slope slope[12];
    int values = values_of(m);
    assert_true(values <= 12);
    sn_memory_sensitivity(m, slope);
    for (int k = 0; k < values; k++) {
        double largest = 0;
        assert_true(slope[k].tau > 0);
        CHECK_ABS(m->value[k] * sn_memory_slope_at(&slope[k], 1, 0), 0, 1e-15); // G(0) stays 1
        for (double t = 1e-4; t < 2e3; t *= 2.9) {
            double G = sn_memory_relaxation(m, t);
            double exact = m->value[k] * sn_memory_slope_at(&slope[k], G, t);
            // the extrapolation leaves (4e-3)^4/480 p^5 d^5G/dp^5. That is 13 at most for an
            // exponential, 24 for E1, 5! (c/N)^5 < 120 for 1/N: in all under 190, so 1e-10
            CHECK_ABS(exact, difference(m, k, t), 1e-10);
            largest = fmax(largest, fabs(exact));
        }
        *seen += largest > 1e-2; // 1e8 times what the check allows
    }
}

static void test_differences(void **state) {
    (void)state;
    int seen = 0, tried = 0;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        sn_memory m = sample_at(i);
        if (m.law->impulse) continue;
        tried += values_of(&m);
        check_memory(&m, &seen);
    }
    assert_int_equal(tried, 1 + 2 + 6 + 3 + 3);
    assert_int_equal(seen, tried);
}

static void test_random_spectra(void **state) {
    (void)state;
    uint64_t seed = 4411;
    int seen = 0;
    for (int n = 0; n < 40; n++) {
        double c = exp(check_random(&seed, log(0.02), log(5)));
        double tau1 = exp(check_random(&seed, log(1e-3), log(1)));
        sn_memory m = SAMPLE("fung-spectrum", 0, c, tau1, tau1 * exp(check_random(&seed, 1, 9)));
        check_memory(&m, &seen);
    }
    assert_true(seen > 100);
}

// The impulse is all that depends on tau.
static void test_voigt(void **state) {
    (void)state;
    sn_memory m = sample_at(2);
    sn_memory_slope slope;
    sn_memory_sensitivity(&m, &slope);
    assert_true(slope.viscous == 1 && slope.constant == 0 && slope.own == 0);
    assert_true(sn_memory_slope_at(&slope, 1, 0.3) == 0);
}

// An end of time is no 0 times infinity.
static void test_ends(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        sn_memory m = sample_at(i);
        sn_memory_slope slope[12];
        sn_memory_sensitivity(&m, slope);
        for (int k = 0; k < values_of(&m); k++) {
            double end = sn_memory_slope_at(&slope[k], sn_memory_equilibrium(&m), INFINITY);
            assert_true(isfinite(end));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_differences),
        cmocka_unit_test(test_random_spectra),
        cmocka_unit_test(test_voigt),
        cmocka_unit_test(test_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
