// Memory laws: closed forms, limits, complete monotonicity, moduli, registry, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "relax/laws.h"
#include "samples.h"

// Reference values of the spectrum c = 0.1, 0.01 s to 100 s, computed with 30 digits and given to
// 12: 1e-11 is ten units of their last place.
static void test_reference(void **state) {
    (void)state;
    sn_memory m = SAMPLE("fung-spectrum", 0, 0.1, 0.01, 100.0);
    CHECK_ABS(sn_memory_relaxation(&m, 1e-4), 0.999480797567, 1e-11);
    CHECK_ABS(sn_memory_relaxation(&m, 0.01), 0.958537975571, 1e-11);
    CHECK_ABS(sn_memory_relaxation(&m, 1), 0.730748612712, 1e-11);
    CHECK_ABS(sn_memory_relaxation(&m, 50), 0.549692165277, 1e-11);
    CHECK_ABS(sn_memory_relaxation(&m, 300), 0.521232221148, 1e-11);
    CHECK_ABS(sn_memory_equilibrium(&m), 0.520552983777, 1e-11);
    double storage, loss;
    sn_memory_modulus(&m, 1, &storage, &loss);
    CHECK_ABS(storage, 0.760276491888, 1e-11);
    CHECK_ABS(loss, 0.0807272002158, 1e-11);
}

static void test_closed_forms(void **state) {
    (void)state;
    uint64_t seed = 20231;
    for (int k = 0; k < 200; k++) {
        double t = exp(check_random(&seed, log(1e-6), log(1e3)));
        double tau = exp(check_random(&seed, log(1e-3), log(1e2)));
        double sigma = tau * check_random(&seed, 1, 30);
        // a few roundings, and exp magnifies that of its argument by it: up to 745 of them
        double exp_digits = 4e-16 * (2 + t / tau);
        if (t / tau < 700) {
            sn_memory maxwell = SAMPLE("maxwell", 0, tau);
            CHECK_REL(sn_memory_relaxation(&maxwell, t), exp(-t / tau), exp_digits);
        }
        // equation (36) as printed, q = tau_epsilon, S = tau_sigma/tau_epsilon - 1
        sn_memory kelvin = SAMPLE("kelvin", 0, tau, sigma);
        double S = sigma / tau - 1;
        CHECK_REL(sn_memory_relaxation(&kelvin, t), (1 + S * exp(-t / tau)) / (1 + S), 2e-15);
        // equation (29): E_R is G(infinity), the relaxed over the instantaneous modulus
        double ER = sn_memory_equilibrium(&kelvin);
        CHECK_REL(sn_memory_relaxation(&kelvin, t), ER * (1 - (1 - sigma / tau) * exp(-t / tau)),
                  1e-14); // the factor in brackets cancels when sigma is near tau
        sn_memory voigt = SAMPLE("voigt", 0, tau);
        assert_true(sn_memory_relaxation(&voigt, t) == 1);
        assert_true(voigt.law->impulse(voigt.value, 0) == tau);
    }
}

typedef struct spectrum {
    double t;
} spectrum;

static double spectrum_integrand(const void *context, double u) {
    const spectrum *s = context;
    return exp(-s->t * exp(-u));
}

// Equation (37) with (38) by quadrature over u = ln q, 400 panels of order 16: far below rounding
// except for the sum, whose 3200 terms of size L/3200 leave some 1e-15.
static void test_spectrum_is_its_integral(void **state) {
    (void)state;
    uint64_t seed = 77003;
    for (int k = 0; k < 60; k++) {
        double c = exp(check_random(&seed, log(0.01), log(10)));
        double tau1 = exp(check_random(&seed, log(1e-6), log(1e2)));
        double L = k % 3 ? check_random(&seed, 0.3, 9) : exp(check_random(&seed, -12, -1));
        sn_memory m = SAMPLE("fung-spectrum", 0, c, tau1, tau1 * exp(L));
        L = log1p((m.value[2] - m.value[1]) / m.value[1]);
        spectrum s = {.t = exp(check_random(&seed, log(1e-4 * tau1), log(1e2 * tau1 * exp(L))))};
        double D = 0;
        for (int i = 0; i < 400; i++)
            D += sample_gauss(spectrum_integrand, &s, log(tau1) + L * i / 400,
                              log(tau1) + L * (i + 1) / 400);
        double expected = (1 + c * D) / (1 + c * L);
        // c/(1 + c L) times the rounding of E1, 6e-15 at worst, and of ln q itself
        CHECK_REL(sn_memory_relaxation(&m, s.t), expected, 2e-14 * (1 + c / (1 + c * L)));
    }
}

// The two forms of G meet at t = tau1, and the ends are exact.
static void test_spectrum_ends(void **state) {
    (void)state;
    sn_memory m = SAMPLE("fung-spectrum", 0, 2.31, 0.0173, 41.9);
    double tau1 = m.value[1], N = 1 + 2.31 * log(41.9 / 0.0173);
    // G falls by 2e-16 tau1 G' only
    CHECK_REL(sn_memory_relaxation(&m, nextafter(tau1, 1)), sn_memory_relaxation(&m, tau1), 5e-15);
    // first order: 1 - G = c t (1/tau1 - 1/tau2)/N; at t/tau1 = 1e-9 the second is 2.5e-10 of it,
    // and the rounding of G at 1 is 1e-16 of 2e-10
    double t = 1e-9 * tau1, slope = 2.31 * (1 / tau1 - 1 / 41.9) / N;
    CHECK_REL(1 - sn_memory_relaxation(&m, t), slope * t, 2e-6);
    assert_true(sn_memory_relaxation(&m, 5e-324) == 1);
    assert_true(sn_memory_relaxation(&m, 1e300) == sn_memory_equilibrium(&m));
    assert_true(sn_memory_relaxation(&m, INFINITY) == sn_memory_equilibrium(&m));
}

static void test_starts_at_one(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        sn_memory m = sample_at(i);
        CHECK_ABS(sn_memory_relaxation(&m, 0), 1, 4e-16); // a sum of a few terms
        CHECK_ABS(sn_memory_relaxation(&m, 1e9), sn_memory_equilibrium(&m), 4e-16);
    }
}

// (-1)^k times the k-th difference of G on even grids is >= 0, up to the rounding 2^k * 4e-15.
static void test_completely_monotone(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        sn_memory m = sample_at(i);
        int clear = 0; // how often a difference stands clear of rounding: the test sees something
        for (double h = 1e-3; h < 100; h *= 3.7) {
            for (int start = 0; start < 20; start++) {
                double G[8];
                for (int j = 0; j < 8; j++) G[j] = sn_memory_relaxation(&m, (start + j) * h);
                for (int k = 1; k < 8; k++) {
                    for (int j = 0; j < 8 - k; j++) G[j] -= G[j + 1];
                    double noise = ldexp(4e-15, k);
                    assert_true(G[0] >= -noise);
                    clear += G[0] > 10 * noise;
                }
            }
        }
        bool relaxes = sn_memory_equilibrium(&m) < 1;
        assert_true(relaxes ? clear > 200 : clear == 0);
    }
}

typedef struct wave {
    const sn_memory *memory;
    double equilibrium, w;
    bool cosine;
} wave;

static double wave_integrand(const void *context, double t) {
    const wave *f = context;
    double relaxing = sn_memory_relaxation(f->memory, t) - f->equilibrium;
    return f->w * relaxing * (f->cosine ? cos(f->w * t) : sin(f->w * t));
}

// Panels of a quarter radian, shorter near t = 0, until nothing is left of exp(-t/longest).
static double wave_integral(const wave *f, double longest) {
    double sum = 0;
    for (double t = 0, next; t < 40 * longest; t = next) {
        next = t + fmin(0.25 / f->w, fmin(0.3 * t + 1e-4, 0.5 * longest));
        sum += sample_gauss(wave_integrand, f, t, next);
    }
    return sum;
}

// G' = G(infinity) + w int (G - G(infinity)) sin wt dt, G'' = w int (G - G(infinity)) cos wt dt.
// The quadrature is exact to rounding: up to 2e4 panels of size 1e-2 and less leave 1e-12.
static void test_modulus_is_fourier_integral(void **state) {
    (void)state;
    static const double longest[SAMPLE_COUNT] = {1, 0.7321, 1, 0.4133, 7.731, 100, 0.9173};
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        if (i == 2) continue; // voigt: the impulse is not in the integral
        sn_memory m = sample_at(i);
        for (double w = 0.0317; w < 40; w *= 5.3) {
            wave f = {.memory = &m, .equilibrium = sn_memory_equilibrium(&m), .w = w};
            double storage, loss;
            sn_memory_modulus(&m, w, &storage, &loss);
            CHECK_ABS(storage, f.equilibrium + wave_integral(&f, longest[i]), 1e-11);
            f.cosine = true;
            CHECK_ABS(loss, wave_integral(&f, longest[i]), 1e-11);
        }
    }
}

// Kelvin: tan delta peaks at w = 1/sqrt(tau_sigma tau_epsilon) with (ts - te)/(2 sqrt(ts te)).
static void test_modulus_limits(void **state) {
    (void)state;
    sn_memory kelvin = sample_at(3);
    double te = 0.4133, ts = 1.9371, storage, loss;
    sn_memory_modulus(&kelvin, 1 / sqrt(te * ts), &storage, &loss);
    CHECK_REL(loss / storage, (ts - te) / (2 * sqrt(te * ts)), 2e-15);
    sn_memory voigt = sample_at(2);
    sn_memory_modulus(&voigt, 3.7, &storage, &loss);
    CHECK_REL(loss / storage, 3.7 * 0.2917, 2e-16);
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        if (i == 2) continue;
        sn_memory m = sample_at(i);
        sn_memory_modulus(&m, 0, &storage, &loss);
        CHECK_ABS(storage, sn_memory_equilibrium(&m), 2e-16);
        assert_true(loss == 0);
        sn_memory_modulus(&m, 1e200, &storage, &loss); // its square overflows
        CHECK_ABS(storage, 1, 1e-13); // ln of 1e200 less itself: 460 roundings of c/N
        assert_true(loss >= 0 && loss < 1e-190);
    }
}

static void test_registry(void **state) {
    (void)state;
    for (int i = 0; i < sn_memory_law_count(); i++) {
        const sn_memory_law *law = sn_memory_law_at(i);
        assert_ptr_equal(sn_memory_law_find(law->name), law);
        assert_true(law->name[0] && law->text[0] && law->source[0]);
        for (int k = 0; k < law->param_count; k++) {
            const sn_param *p = &law->params[k];
            assert_true(p->name[0] && p->symbol[0] && p->unit[0] && p->text[0]);
            assert_true(isfinite(p->min) && isfinite(p->max) && p->min < p->max);
            assert_true(!p->log_scale || p->min > 0); // a fit takes the logarithm of its bounds
        }
    }
    assert_null(sn_memory_law_find("fung-spectrm"));
    assert_non_null(strstr(sn_error_text(), "did you mean \"fung-spectrum\""));
    assert_null(sn_memory_law_find("quasar"));
    assert_non_null(strstr(sn_error_text(), "quasar"));
    assert_non_null(strstr(sn_error_text(), "kelvin"));
}

static void test_refusals(void **state) {
    (void)state;
    sn_memory m = sample_at(3);
    m.value[0] = 2.5;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "tau_epsilon is 2.5 s, more than tau_sigma");
    m.value[0] = 0;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "memory kelvin: tau_epsilon");
    m = sample_at(3), m.value[1] = NAN;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "tau_sigma is missing");
    m = sample_at(3), m.terms = 2;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "memory kelvin: 2 terms");
    m = sample_at(4), m.value[0] = 0.5;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "weights g sum to 1.1198");
    m = sample_at(4), m.value[1] = -0.1;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "memory prony: g");
    m = sample_at(4), m.value[5] = INFINITY;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "memory prony: tau");
    m = sample_at(4), m.terms = 0;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "expected 1 to 64");
    m = sample_at(4), m.terms = SN_TERMS_MAX + 1;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "expected 1 to 64");
    m = sample_at(5), m.value[1] = 100;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "expected tau1 < tau2");
    m = sample_at(5), m.value[0] = 0;
    CHECK_FAILS(sn_memory_check(&m), SN_E_RANGE, "memory fung-spectrum: c");
    m.law = NULL;
    CHECK_FAILS(sn_memory_check(&m), SN_E_DEFINITION, "without a law");
    // weights that sum to 1 on paper but not in doubles
    sn_memory fluid = SAMPLE("prony", 3, 0.7, 0.2, 0.1, 1.0, 2.0, 3.0);
    assert_true(sn_memory_equilibrium(&fluid) >= 0 && sn_memory_equilibrium(&fluid) < 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_spectrum_is_its_integral),
        cmocka_unit_test(test_spectrum_ends),
        cmocka_unit_test(test_starts_at_one),
        cmocka_unit_test(test_completely_monotone),
        cmocka_unit_test(test_modulus_is_fourier_integral),
        cmocka_unit_test(test_modulus_limits),
        cmocka_unit_test(test_registry),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
