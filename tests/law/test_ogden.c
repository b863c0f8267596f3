// Ogden's law where stretches are equal or nearly so, and the laws it contains.
// SPDX-License-Identifier: Apache-2.0
#include "points.h"

enum { CASES = 300 };

/// Strain with the principal values of C a (1, 1 + first, 1 + second), axes at random.
static void strain_of(uint64_t *seed, double first, double second, double E[6]) {
    double Q[3][3], a = check_random(seed, 0.6, 1.6);
    double diagonal[6] = {(a - 1) / 2, (a * (1 + first) - 1) / 2, (a * (1 + second) - 1) / 2};
    random_rotation(seed, false, Q);
    rotate6(Q, diagonal, E);
}

/// Two terms, 2 and -2, are Mooney-Rivlin's law, which never needs a principal stretch: W, S and D
/// agree for any distance of the stretches, none included.
static void test_nearly_equal_stretches(void **state) {
    (void)state;
    uint64_t seed = 701;
    const sn_law *ogden = sn_law_find("ogden"), *mooney = sn_law_find("mooney-rivlin");
    double worst[3] = {0};
    for (int i = 0; i < 20 * CASES; i++) {
        double c1 = check_random(&seed, 100, 5000), c2 = check_random(&seed, 100, 5000);
        const double p[] = {2 * c1, -2 * c2, 2, -2, 1e6}, q[] = {c1, c2, 1e6};
        double E[6], W[2], S[2][6], D[2][21];
        // distances from 1e-20 to 1 between two or three of the stretches, or exactly none
        double first = i % 3 ? pow(10, check_random(&seed, -20, 0)) : 0;
        double second = i % 4 ? pow(10, check_random(&seed, -20, 0)) : first;
        strain_of(&seed, first, second, E);
        law_at(ogden, p, E, &W[0], S[0], D[0]);
        law_at(mooney, q, E, &W[1], S[1], D[1]);
        // S and W by the strain that rounding of E leaves in both
        worst[0] = fmax(worst[0], fabs(W[0] - W[1]) / (c1 + c2));
        for (int k = 0; k < 6; k++) worst[1] = fmax(worst[1], fabs(S[0][k] - S[1][k]) / (c1 + c2));
        for (int k = 0; k < 21; k++) worst[2] = fmax(worst[2], fabs(D[0][k] - D[1][k]) / (c1 + c2));
    }
    print_message("W %.2g, S %.2g, D %.2g of c1 + c2\n", worst[0], worst[1], worst[2]);
    // C reaches down to 0.6, where D is some (1/0.6)^2 4 times c1 + c2; 50 operations in a row
    CHECK_ABS(worst[0], 0, 1e-14);
    CHECK_ABS(worst[1], 0, 1e-14);
    CHECK_ABS(worst[2], 0, 1e-13);
}

static double unlike(const double *p, const double *q, const char *other) {
    uint64_t seed = 702;
    double worst = 0;
    for (int i = 0; i < CASES; i++) {
        double E[6], S[2][6];
        random_strain(&seed, 0.25, E);
        law_at(sn_law_find("ogden"), p, E, NULL, S[0], NULL);
        law_at(sn_law_find(other), q, E, NULL, S[1], NULL);
        for (int k = 0; k < 6; k++) worst = fmax(worst, fabs(S[0][k] - S[1][k]) / norm6(S[1]));
    }
    return worst;
}

static void test_contained_laws(void **state) {
    (void)state;
    const double mu = 3210, neo[] = {mu, 1e6};
    // half of mu to each of two equal terms
    CHECK_ABS(unlike((double[]){mu / 2, mu / 2, 2, 2, 1e6}, neo, "neo-hookean"), 0, 1e-13);
    // first order in the distance of alpha from 2
    double far = unlike((double[]){mu / 2, mu / 2, 2.02, 2.02, 1e6}, neo, "neo-hookean");
    double near = unlike((double[]){mu / 2, mu / 2, 2.01, 2.01, 1e6}, neo, "neo-hookean");
    CHECK_REL(far / near, 2, 0.05);
}

/// Nominal stress of an incompressible bar: sum mu (x^(alpha-1) - x^(-alpha/2-1)).
static void test_bar(void **state) {
    (void)state;
    uint64_t seed = 703;
    const sn_law *law = sn_law_find("ogden");
    for (int i = 0; i < CASES; i++) {
        double p[POINTS_VALUES_MAX], x = check_random(&seed, 0.6, 1.7), S[6], T = 0, size = 0;
        random_values(law, &seed, p);
        double side = (1 / x - 1) / 2, E[6] = {(x * x - 1) / 2, side, side};
        law_at(law, p, E, NULL, S, NULL);
        for (int k = 0; k < 2; k++) {
            T += p[k] * (pow(x, p[2 + k] - 1) - pow(x, -p[2 + k] / 2 - 1));
            size += fabs(p[k]) * (pow(x, p[2 + k] - 1) + pow(x, -p[2 + k] / 2 - 1));
        }
        // exponents up to 20 multiply the rounding of ln x
        CHECK_ABS((x * S[0] - S[1] / (x * x)) / size, T / size, 1e-14);
    }
}

/// The tangent against differences of the stress where stretches are equal: no plane of axes is
/// preferred, in double the error falls to what rounding leaves.
static void test_tangent_at_equal_stretches(void **state) {
    (void)state;
    uint64_t seed = 704;
    const sn_law *law = sn_law_find("ogden");
    const double step = 1e-4;
    for (int i = 0; i < CASES; i++) {
        double p[] = {900, -40, 7.5, -3.5, 1e6}, E[6], h[6], D[21], Dh[6], S[2][6], shifted[6];
        strain_of(&seed, i % 3 ? check_random(&seed, -0.3, 0.4) : 0, 0, E);
        random_strain(&seed, 0.25, h);
        law_at(law, p, E, NULL, NULL, D);
        tangent_times(D, h, Dh);
        for (int side = 0; side < 2; side++) {
            for (int k = 0; k < 6; k++) shifted[k] = E[k] + (side ? step : -step) * h[k];
            law_at(law, p, shifted, NULL, S[side], NULL);
        }
        for (int k = 0; k < 6; k++) {
            double slope = (S[1][k] - S[0][k]) / (2 * step);
            // (alpha step)^2 / 6 from the third derivative, 1e-16 / step of rounding
            CHECK_ABS((slope - Dh[k]) / norm6(Dh), 0, 1e-6);
        }
    }
}

/// A strain so flat that rounding takes the determinant to 0 gives numbers that are finite.
static void test_flat(void **state) {
    (void)state;
    const double p[] = {900, -40, 2.5, -1.5, 1e6};
    const double E[6] = {0.3, 0.2, -0.5 + 1e-17};
    double W, S[6], D[21];
    law_at(sn_law_find("ogden"), p, E, &W, S, D);
    assert_true(isfinite(W));
}

static void test_conditions(void **state) {
    (void)state;
    const sn_law *law = sn_law_find("ogden");
    CHECK_OK(sn_law_check(law, (double[]){10, -10, 2, -2, 1e6}, 2));
    CHECK_FAILS(sn_law_check(law, (double[]){10, 10, 2, -2, 1e6}, 2), SN_E_RANGE,
                "mu alpha of term 2 is -20 Pa");
    CHECK_FAILS(sn_law_check(law, (double[]){10, 0, 1e6}, 1), SN_E_RANGE, "term 1 is 0 Pa");
    sn_moduli m;
    law->moduli((double[]){10, -10, 2, -3, 1e6}, 2, &m);
    CHECK_REL(m.shear, 25, 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nearly_equal_stretches),
        cmocka_unit_test(test_contained_laws),
        cmocka_unit_test(test_bar),
        cmocka_unit_test(test_tangent_at_equal_stretches),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_conditions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
