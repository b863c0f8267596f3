// Creep functions: closed forms, G * J = t, the two ends, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "samples.h"

static double creep_of(const sn_memory *memory, double t) {
    sn_retardations r;
    CHECK_OK(sn_memory_creep(memory, &r));
    return sn_retardations_at(&r, t);
}

// (23), (27) and (28) with G(0) = 1: 1 + t/tau; 1 - exp(-t/tau); (ts/te)(1 - (1 - te/ts)
// exp(-t/ts))
static void closed_forms(void **state) {
    (void)state;
    uint64_t seed = 515;
    for (int k = 0; k < 200; k++) {
        double t = exp(check_random(&seed, log(1e-5), log(1e4)));
        double tau = exp(check_random(&seed, log(1e-5), log(1e5)));
        double longer = fmin(1e6, tau * (1 + exp(check_random(&seed, log(1e-6), log(1e4)))));
        sn_memory none = sn_memory_none(), maxwell = SAMPLE("maxwell", 0, tau);
        sn_memory voigt = SAMPLE("voigt", 0, tau), kelvin = SAMPLE("kelvin", 0, tau, longer);
        assert_true(creep_of(&none, t) == 1);
        CHECK_REL(creep_of(&maxwell, t), 1 + t / tau, 1e-15);
        // the zero is found to a few units of its last place, and t/tau magnifies that
        CHECK_REL(creep_of(&voigt, t), -expm1(-t / tau), 4e-14);
        double expected = 1 - (longer - tau) / tau * expm1(-t / longer);
        // the weight (ts - te)/ts has lost the digits that ts and te share: up to 1e-10, of j
        CHECK_REL(creep_of(&kelvin, t), expected, 4e-14 + 4e-16 * longer / (longer - tau));
    }
}

typedef struct product {
    const sn_memory *memory;
    const sn_retardations *creep;
    double t;
} product;

// over u = ln s, from the end where the argument of `early` is small
static double early_relaxation(const void *context, double u) {
    const product *p = context;
    double s = exp(u);
    return s * sn_memory_relaxation(p->memory, s) * sn_retardations_at(p->creep, p->t - s);
}
static double early_creep(const void *context, double u) {
    const product *p = context;
    double s = exp(u);
    return s * sn_memory_relaxation(p->memory, p->t - s) * sn_retardations_at(p->creep, s);
}

// int_0^t G(t - s) J(s) ds = t by quadrature over the logarithm from either end, with G itself and
// not its exponentials; the impulse of Voigt adds its time times J. From 1e-14 t to t/2 by 120
// panels of order 16; what is left out is 1e-14 J(t) of t, and
// a Maxwell body has J = 1e4 in the end.
static void convolution_with_relaxation_is_time(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        sn_memory m = sample_at(i);
        sn_retardations r;
        CHECK_OK(sn_memory_creep(&m, &r));
        double impulse = m.law->impulse ? m.law->impulse(m.value, m.terms) : 0;
        for (double t = 1.37e-4; t < 2e4; t *= 7.1) {
            product p = {&m, &r, t};
            double low = log(1e-14 * t), width = log(0.5 * t) - low;
            double sum = impulse * sn_retardations_at(&r, t);
            for (int k = 0; k < 120; k++) {
                double a = low + width * k / 120, b = low + width * (k + 1) / 120;
                sum += sample_gauss(early_relaxation, &p, a, b);
                sum += sample_gauss(early_creep, &p, a, b);
            }
            CHECK_REL(sum, t, 1e-10);
        }
    }
}

// g(0) c(0) = 1, g(infinity) c(infinity) = 1; every compliance above 0; times fall
static void ends_and_signs(void **state) {
    (void)state;
    for (int i = 0; i < SAMPLE_COUNT; i++) {
        sn_memory m = sample_at(i);
        sn_retardations r;
        CHECK_OK(sn_memory_creep(&m, &r));
        bool viscous = m.law->impulse != NULL;
        CHECK_ABS(sn_retardations_at(&r, 0), viscous ? 0 : 1, 1e-15);
        double rest = sn_memory_equilibrium(&m);
        if (rest > 0) CHECK_REL(sn_retardations_at(&r, 1e9), 1 / rest, 1e-11);
        assert_true((r.flow > 0) == !(rest > 0));
        for (int k = 0; k < r.terms; k++) {
            assert_true(r.j[k] > 0 && r.tau[k] > 0);
            assert_true(k == 0 || r.tau[k] < r.tau[k - 1]);
        }
    }
}

// equal times act as one; neighbours 1e-9 apart as one but for 1e-9; terms without weight as none;
// a viscous part beside exponentials, held by its convolution
static void awkward_chains(void **state) {
    (void)state;
    sn_memory one = SAMPLE("prony", 1, 0.61, 1.3), twins = SAMPLE("prony", 2, 0.2, 0.41, 1.3, 1.3);
    sn_memory near = SAMPLE("prony", 3, 0.2, 0.41, 0.0, 1.3, 1.3 * (1 + 1e-9), 7.0);
    for (double t = 0.01; t < 100; t *= 3.3) {
        CHECK_REL(creep_of(&twins, t), creep_of(&one, t), 1e-14);
        CHECK_REL(creep_of(&near, t), creep_of(&one, t), 2e-9);
    }
    sn_exponentials e = {
        .terms = 2, .g_inf = 0.3, .viscous = 0.07, .g = {0.5, 0.2}, .tau = {0.4, 3}};
    sn_retardations r;
    sn_exponentials_creep(&e, &r);
    assert_int_equal(r.terms, 3);
    assert_true(sn_retardations_at(&r, 0) == 0);
    double t = 1.9, sum = e.viscous * sn_retardations_at(&r, t);
    enum { PIECES = 20000 }; // Simpson on 1e-4 s, fourth order: 1e-12 and less
    for (int k = 0; k <= PIECES; k++) {
        double s = t * k / PIECES, w = k == 0 || k == PIECES ? 1 : k % 2 ? 4 : 2;
        sum += w * t / PIECES / 3 * sn_exponentials_at(&e, t - s) * sn_retardations_at(&r, s);
    }
    CHECK_REL(sum, t, 1e-11);
    CHECK_REL(sn_retardations_at(&r, 1e6), 1 / 0.3, 1e-13);
}

static void refusals(void **state) {
    (void)state;
    sn_memory m = sample_at(3);
    sn_retardations r;
    m.value[0] = -1;
    CHECK_FAILS(sn_memory_creep(&m, &r), SN_E_RANGE, "memory kelvin: tau_epsilon");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms),   cmocka_unit_test(convolution_with_relaxation_is_time),
        cmocka_unit_test(ends_and_signs), cmocka_unit_test(awkward_chains),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
