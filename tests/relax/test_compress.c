// Compression: the stated error holds on times of the test's own, and no term is wasted.
// SPDX-License-Identifier: Apache-2.0
#include "samples.h"

// Weights > 0, g_inf >= 0, sum 1, times rising, and max_error within the tolerance and true at t =
// 0 and at 20000 random times, the ends included. Returns the largest error met.
static double check_result(const sn_memory *m, const sn_exponentials *e, double tolerance,
                           uint64_t *seed) {
    double total = e->g_inf;
    for (int i = 0; i < e->terms; i++) {
        assert_true(e->g[i] > 0 && e->tau[i] > 0 && isfinite(e->tau[i]));
        assert_true(i == 0 || e->tau[i] > e->tau[i - 1]);
        total += e->g[i];
    }
    assert_true(e->g_inf >= 0);
    CHECK_ABS(total, 1, 2e-15);
    assert_true(e->max_error <= tolerance);
    CHECK_ABS(sn_exponentials_at(e, 0), 1, 2e-15);
    double largest = 0, length = log(e->t_max / e->t_min);
    for (int k = 0; k < 20000; k++) {
        double t = e->t_min * exp(length * check_random(seed, 0, 1));
        if (k == 0) t = e->t_min;
        if (k == 1) t = e->t_max;
        largest = fmax(largest, fabs(sn_exponentials_at(e, t) - sn_memory_relaxation(m, t)));
    }
    CHECK_ABS(largest, 0, e->max_error + 1e-14); // rounding of E1
    return largest;
}

// The numbers of terms that the search finds for spectra over 1 ms to 1000 s. More would be a loss.
// Fewer there are not: with one term less the smallest largest error, from a search with ten times
// the steps, is 2.4e-2, 2.7e-3, 1.3e-4, 1.9e-5 in rows 2 to 5 and 1.3e-2, 1.3e-3, 1.2e-4 in rows 6
// to 8.
static void test_counts(void **state) {
    (void)state;
    static const struct {
        double c, tau1, tau2, tolerance;
        int terms;
    } row[] = {
        {0.1, 0.01, 100, 1e-1, 1}, {0.1, 0.01, 100, 1e-2, 3},  {0.1, 0.01, 100, 1e-3, 5},
        {0.1, 0.01, 100, 1e-4, 8}, {0.1, 0.01, 100, 1e-5, 10}, {1, 1e-3, 1e3, 1e-2, 5},
        {1, 1e-3, 1e3, 1e-3, 8},   {1, 1e-3, 1e3, 1e-4, 11},   {10, 1e-6, 1e6, 1e-3, 8},
    };
    uint64_t seed = 4711;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        sn_memory m = SAMPLE("fung-spectrum", 0, row[k].c, row[k].tau1, row[k].tau2);
        sn_exponentials e;
        CHECK_OK(sn_memory_compress(&m, 1e-3, 1e3, row[k].tolerance, &e));
        assert_int_equal(e.terms, row[k].terms);
        // the bound is tight: 1 % is for what lies between the points of its grid
        double largest = check_result(&m, &e, row[k].tolerance, &seed);
        assert_true(largest > 0.9 * e.max_error);
    }
}

// Random spectra, bands (inside, across, far off the spectrum) and tolerances.
static void test_guarantee(void **state) {
    (void)state;
    uint64_t seed = 13577;
    int searched = 0;
    for (int k = 0; k < 120; k++) {
        double L = check_random(&seed, 0.01, 20);
        double tau1 = exp(check_random(&seed, log(1e-6), log(1e6) - L));
        double c = exp(check_random(&seed, log(1e-3), log(10)));
        sn_memory m = SAMPLE("fung-spectrum", 0, c, tau1, tau1 * exp(L));
        double t_min = exp(check_random(&seed, log(1e-6), log(1e3)));
        double t_max = t_min * exp(check_random(&seed, 0.1, 16));
        double tolerance = pow(10, check_random(&seed, -8, -1));
        sn_exponentials e;
        CHECK_OK(sn_memory_compress(&m, t_min, t_max, tolerance, &e));
        assert_true(e.t_min == t_min && e.t_max == t_max && e.viscous == 0);
        check_result(&m, &e, tolerance, &seed);
        searched += e.terms > 1;
    }
    assert_true(searched > 60);
}

static void test_terms_rise_with_accuracy(void **state) {
    (void)state;
    sn_memory m = SAMPLE("fung-spectrum", 0, 0.3719, 0.0117, 231.3);
    int before = 0;
    for (double tolerance = 0.3; tolerance > 1e-11; tolerance /= 2.1) {
        sn_exponentials e;
        CHECK_OK(sn_memory_compress(&m, 2e-4, 700, tolerance, &e));
        assert_true(e.terms >= before);
        before = e.terms;
    }
    assert_true(before > 20);
}

// A band far from the spectrum: all relaxed before it, or nothing relaxed within it.
static void test_band_beside_spectrum(void **state) {
    (void)state;
    uint64_t seed = 31;
    sn_exponentials e;
    sn_memory fast = SAMPLE("fung-spectrum", 0, 1.7, 1e-6, 1e-5);
    CHECK_OK(sn_memory_compress(&fast, 0.01, 100, 1e-6, &e));
    check_result(&fast, &e, 1e-6, &seed);
    assert_int_equal(e.terms, 1); // G(0) = 1 still, through a term that is over at once
    assert_true(e.tau[0] < 0.01);
    sn_memory slow = SAMPLE("fung-spectrum", 0, 1.7, 1e5, 1e6);
    CHECK_OK(sn_memory_compress(&slow, 1e-4, 1e-2, 1e-6, &e));
    check_result(&slow, &e, 1e-6, &seed);
    assert_int_equal(e.terms, 0);
}

static void test_finite_sums(void **state) {
    (void)state;
    uint64_t seed = 8191;
    for (int i = 0; i < 5; i++) {
        sn_memory m = sample_at(i);
        sn_exponentials e, all;
        CHECK_OK(sn_memory_expand(&m, &all));
        CHECK_OK(sn_memory_compress(&m, 1e-3, 1e3, 1e-6, &e));
        assert_int_equal(e.terms, all.terms); // the band sees every term
        assert_true(e.viscous == all.viscous && e.max_error == 0);
        check_result(&m, &e, 1e-6, &seed);
    }
    // terms that the band sees (0.1 s, 1 s), that are over before it (2 us, 7 us, 9 us) or have not
    // begun at its end (4e5 s, 7e5 s), and one of no weight
    sn_memory m = SAMPLE("prony", 8, 0.05, 0.11, 0.07, 0.13, 0.17, 0.19, 0.21, 0.0, // g
                         7e-6, 0.1, 4e5, 2e-6, 1.0, 9e-6, 7e5, 3.0);
    sn_exponentials e;
    CHECK_OK(sn_memory_compress(&m, 0.001, 10, 1e-4, &e));
    assert_int_equal(e.terms, 3);
    check_result(&m, &e, 1e-4, &seed);
    CHECK_REL(e.g[0], 0.05 + 0.13 + 0.19, 1e-15);
    CHECK_REL(e.tau[0], 9e-6, 1e-16);
    CHECK_REL(e.g_inf, 1 - 0.93 + 0.07 + 0.21, 1e-14);
    // 10 s of 4e5 s and 7e5 s are 4.75e-6: with less to spend, one slow term stays, then both
    CHECK_REL(e.max_error, 0.07 * 10 / 4e5 + 0.21 * 10 / 7e5, 1e-4);
    CHECK_OK(sn_memory_compress(&m, 0.001, 10, 3.5e-6, &e));
    assert_int_equal(e.terms, 4);
    check_result(&m, &e, 3.5e-6, &seed);
    CHECK_OK(sn_memory_compress(&m, 0.001, 10, 1e-6, &e));
    assert_int_equal(e.terms, 5);
    check_result(&m, &e, 1e-6, &seed);
    // a band that begins at 20 us sees the fast terms a little: exp(-20/9) = 0.1
    CHECK_OK(sn_memory_compress(&m, 2e-5, 10, 1e-3, &e));
    assert_true(e.terms > 3);
    check_result(&m, &e, 1e-3, &seed);
    CHECK_OK(sn_memory_compress(&m, 2e-5, 10, 0.03, &e));
    double largest = check_result(&m, &e, 0.03, &seed);
    CHECK_REL(e.max_error, largest, 1e-3); // the sum of costs is the error itself
}

static void test_refusals(void **state) {
    (void)state;
    sn_memory m = sample_at(5);
    sn_exponentials e;
    CHECK_FAILS(sn_memory_compress(&m, 0, 1, 1e-3, &e), SN_E_RANGE, "band from 0 s");
    CHECK_FAILS(sn_memory_compress(&m, 2, 1, 1e-3, &e), SN_E_RANGE, "band from 2 s to 1 s");
    CHECK_FAILS(sn_memory_compress(&m, 1, INFINITY, 1e-3, &e), SN_E_RANGE, "band from 1 s to inf");
    CHECK_FAILS(sn_memory_compress(&m, 1e-200, 1e200, 1e-3, &e), SN_E_RANGE, "30 decades");
    CHECK_FAILS(sn_memory_compress(&m, NAN, 1, 1e-3, &e), SN_E_RANGE, "band from nan");
    CHECK_FAILS(sn_memory_compress(&m, 1, 2, 0, &e), SN_E_RANGE, "tolerance of 0");
    CHECK_FAILS(sn_memory_compress(&m, 1, 2, NAN, &e), SN_E_RANGE, "tolerance of nan");
    m = SAMPLE("fung-spectrum", 0, 10, 1e-6, 1e6);
    CHECK_FAILS(sn_memory_compress(&m, 1e-6, 1e6, 1e-12, &e), SN_E_RANGE,
                "memory fung-spectrum: 64 exponentials keep an error of");
    m.value[0] = -1;
    CHECK_FAILS(sn_memory_compress(&m, 1, 2, 1e-3, &e), SN_E_RANGE, "memory fung-spectrum: c");
}

static void *no_block(void *context, void *block, size_t bytes) {
    (void)context, (void)block, (void)bytes;
    return NULL;
}

static void no_release(void *context, void *block) {
    (void)context, (void)block;
}

static void test_out_of_memory(void **state) {
    (void)state;
    sn_memory m = sample_at(5);
    sn_exponentials e;
    sn_set_allocator(&(sn_allocator){.resize = no_block, .release = no_release});
    sn_status status = sn_memory_compress(&m, 1e-3, 1e3, 1e-3, &e);
    sn_set_allocator(NULL);
    assert_int_equal(status, SN_E_MEMORY);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),
        cmocka_unit_test(test_guarantee),
        cmocka_unit_test(test_terms_rise_with_accuracy),
        cmocka_unit_test(test_band_beside_spectrum),
        cmocka_unit_test(test_finite_sums),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
