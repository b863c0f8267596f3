// Laws against formulas written in another way: energies from the tensors themselves, uniaxial
// stress in closed form, limits in which one law becomes another.
// SPDX-License-Identifier: Apache-2.0
#include "points.h"

enum { CASES = 200 };

//---- energies from C directly --------------------------------------------------------------------

/// Principal values of a tensor by Cardano's formula.
static void principal_values(const double a[6], double value[3]) {
    double mean = (a[0] + a[1] + a[2]) / 3, b[6], B[3][3];
    for (int k = 0; k < 6; k++) b[k] = a[k] - (k < 3 ? mean : 0);
    tensor_of(b, B);
    double size = sqrt(dot6(b, b) / 6), angle = acos(det3(B) / (2 * size * size * size)) / 3;
    for (int i = 0; i < 3; i++)
        value[i] = mean + 2 * size * cos(angle + i * 2 * 3.14159265358979323846 / 3);
}

static double plain_ogden(const double *p, const double Ebar[6]) {
    double c[6], value[3], W = 0;
    for (int k = 0; k < 6; k++) c[k] = 2 * Ebar[k] + (k < 3);
    principal_values(c, value);
    for (int term = 0; term < 2; term++)
        for (int i = 0; i < 3; i++)
            W += p[term] / p[2 + term] * (pow(value[i], p[2 + term] / 2) - 1);
    return W;
}

static double plain_form(const double *a, const double *e) {
    return a[0] * e[0] * e[0] + a[1] * e[1] * e[1] + a[2] * e[2] * e[2] +
           2 * (a[3] * e[0] * e[1] + a[4] * e[1] * e[2] + a[5] * e[2] * e[0]) +
           2 * (a[6] * e[3] * e[3] + a[7] * e[4] * e[4] + a[8] * e[5] * e[5]);
}

static double plain_energy(const char *name, const double *p, const double E[6]) {
    double e[6], I1, I2;
    isochoric_of(E, e, &I1, &I2);
    if (strcmp(name, "neo-hookean") == 0) return p[0] / 2 * (I1 - 3);
    if (strcmp(name, "mooney-rivlin") == 0) return p[0] * (I1 - 3) + p[1] * (I2 - 3);
    if (strcmp(name, "demiray") == 0) return p[0] / (2 * p[1]) * (exp(p[1] * (I1 - 3)) - 1);
    if (strcmp(name, "veronda-westmann") == 0)
        return p[0] * (exp(p[1] * (I1 - 3)) - 1) - p[0] * p[1] / 2 * (I2 - 3);
    if (strcmp(name, "guccione") == 0) {
        double Q = p[1] * e[0] * e[0] + p[2] * (e[1] * e[1] + e[2] * e[2] + 2 * e[4] * e[4]) +
                   p[3] * (2 * e[3] * e[3] + 2 * e[5] * e[5]);
        return p[0] / 2 * (exp(Q) - 1);
    }
    if (strcmp(name, "ogden") == 0) return plain_ogden(p, e);
    if (strcmp(name, "fung") == 0) return p[0] / 2 * (exp(plain_form(p + 1, e)) - 1);
    if (strcmp(name, "fung-general") == 0)
        return plain_form(p, e) / 2 + p[9] / 2 * (exp(plain_form(p + 10, e)) - 1);
    if (strcmp(name, "hgo") == 0) {
        double f[2], W = p[0] / 2 * (I1 - 3);
        hgo_strains(p, E, f);
        for (int i = 0; i < 2; i++)
            if (f[i] > 0) W += p[1] / (2 * p[2]) * (exp(p[2] * f[i] * f[i]) - 1);
        return W;
    }
    if (strcmp(name, "hookean") == 0) { // 1/2 lambda tr^2 + mu E:E less K/2 tr^2
        double mu = p[0] / (2 * (1 + p[1])), lambda = 2 * mu * p[1] / (1 - 2 * p[1]);
        double bulk = lambda + 2 * mu / 3, trace = E[0] + E[1] + E[2];
        return (lambda - bulk) / 2 * trace * trace + mu * dot6(E, E);
    }
    fail_msg("no plain formula for %s: write one here", name);
    return 0;
}

static void test_energies(void **state) {
    (void)state;
    uint64_t seed = 201;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        if (law->kind != SN_LAW_SOLID) continue;
        for (int i = 0; i < CASES; i++) {
            double value[POINTS_VALUES_MAX], E[6], W;
            random_values(law, &seed, value);
            random_strain(&seed, 0.3, E);
            sn_law_solid(law, value, law_terms(law), 1, E, &W, NULL, NULL);
            // the plain formulas lose I1 - 3 > 1e-3 from 3, and the difference 1/(1 - 2 nu) of
            // Hooke's; exponents up to 40 multiply what is left of 16 digits
            CHECK_REL(W, plain_energy(law->name, value, E), 1e-9);
        }
    }
}

/// With equal exponents Guccione's law is a function of Ebar:Ebar alone.
static void test_guccione_isotropic(void **state) {
    (void)state;
    uint64_t seed = 202;
    const sn_law *law = sn_law_find("guccione");
    for (int i = 0; i < CASES; i++) {
        double C = check_random(&seed, 100, 5000), b = check_random(&seed, 0.5, 20);
        double value[] = {C, b, b, b, 1e6}, E[6], Ebar[6], W, W2, I1, I2, Q[3][3], turned[6];
        random_strain(&seed, 0.25, E);
        isochoric_of(E, Ebar, &I1, &I2);
        sn_law_solid(law, value, 0, 1, E, &W, NULL, NULL);
        CHECK_REL(W, C / 2 * expm1(b * ((I1 * I1 - 2 * I2) - 2 * I1 + 3) / 4), 1e-10);
        random_rotation(&seed, false, Q);
        rotate6(Q, E, turned);
        sn_law_solid(law, value, 0, 1, turned, &W2, NULL, NULL);
        CHECK_REL(W2, W, 1e-12);
    }
}

//---- uniaxial tension of an incompressible bar ---------------------------------------------------

/// Cauchy stress of a bar stretched by x with free sides: with the pressure taken from the sides,
/// s1 - s2 = 2 (x^2 - 1/x) (W1 + W2 / x).
static void test_uniaxial_tension(void **state) {
    (void)state;
    uint64_t seed = 203;
    const char *const names[] = {"neo-hookean", "mooney-rivlin", "demiray", "veronda-westmann"};
    for (int l = 0; l < 4; l++) {
        const sn_law *law = sn_law_find(names[l]);
        for (int i = 0; i < CASES; i++) {
            double p[POINTS_VALUES_MAX], x = check_random(&seed, 0.6, 1.7), S[6], W1, W2 = 0;
            random_values(law, &seed, p);
            double side = (1 / x - 1) / 2, E[6] = {(x * x - 1) / 2, side, side}, i1;
            i1 = x * x + 2 / x - 3;
            switch (l) {
            case 0: W1 = p[0] / 2; break;
            case 1: W1 = p[0], W2 = p[1]; break;
            case 2: W1 = p[0] / 2 * exp(p[1] * i1); break;
            default: W1 = p[0] * p[1] * exp(p[1] * i1), W2 = -p[0] * p[1] / 2; break;
            }
            sn_law_solid(law, p, 0, 1, E, NULL, S, NULL);
            // rounding of x^2 - 1/x near x = 1, and of exponents up to 20 * 1.1
            CHECK_ABS((x * x * S[0] - S[1] / x) / (2 * (W1 + fabs(W2) / x)),
                      (x * x - 1 / x) * (W1 + W2 / x) / (W1 + fabs(W2) / x), 1e-13);
            CHECK_ABS(S[1] / S[0], S[2] / S[0], 1e-14);
            assert_true(S[3] == 0 && S[4] == 0 && S[5] == 0);
        }
    }
}

static void test_exponential(void **state) {
    (void)state;
    uint64_t seed = 204;
    const sn_law *law = sn_law_find("exponential");
    for (int i = 0; i < CASES; i++) {
        double p[2], x = check_random(&seed, 0.7, 1.5), W, T, dT;
        random_values(law, &seed, p);
        double B = p[0], C = p[1], e = x - 1;
        sn_law_uniaxial(law, p, 0, 1, &x, &W, &T, &dT);
        CHECK_REL(T, C / B * expm1(B * e), 1e-14);
        CHECK_REL(dT, B * T + C, 1e-13);                             // equation (13)
        CHECK_ABS(W, C / B * (expm1(B * e) / B - e), 1e-13 * C / B); // its plain form cancels
    }
}

//---- limits --------------------------------------------------------------------------------------

/// Two laws at the same points: largest relative difference of W, S and D.
static double solid_difference(const char *one, const double *p, const char *other,
                               const double *q) {
    uint64_t seed = 205;
    double worst = 0;
    for (int i = 0; i < CASES; i++) {
        double E[6], W[2], S[2][6], D[2][21];
        random_strain(&seed, 0.25, E);
        law_at(sn_law_find(one), p, E, &W[0], S[0], D[0]);
        law_at(sn_law_find(other), q, E, &W[1], S[1], D[1]);
        worst = fmax(worst, fabs(W[1] - W[0]) / W[1]);
        for (int k = 0; k < 6; k++) worst = fmax(worst, fabs(S[1][k] - S[0][k]) / norm6(S[1]));
        for (int k = 0; k < 21; k++) worst = fmax(worst, fabs(D[1][k] - D[0][k]) / fabs(D[1][0]));
    }
    return worst;
}

static void test_limits(void **state) {
    (void)state;
    const double mu = 3210;
    // D is measured by one of its components, which may be small: some 1e-13
    CHECK_ABS(
        solid_difference("demiray", (double[]){mu, 0, 1e6}, "neo-hookean", (double[]){mu, 1e6}), 0,
        1e-12);
    // first order in b: half the tangent's (I1 - 3) b, with I1 - 3 and D's ratio of order 1
    for (double b = 1e-3; b > 1e-9; b /= 10)
        CHECK_ABS(
            solid_difference("demiray", (double[]){mu, b, 1e6}, "neo-hookean", (double[]){mu, 1e6}),
            0, 100 * b);
    assert_true(solid_difference("demiray", (double[]){mu, 1e-3, 1e6}, "neo-hookean",
                                 (double[]){mu, 1e6}) > 1e-5);
    CHECK_ABS(solid_difference("mooney-rivlin", (double[]){mu / 2, 0, 1e6}, "neo-hookean",
                               (double[]){mu, 1e6}),
              0, 1e-12);
    // c1 c2 kept at mu and c2 -> 0: Mooney-Rivlin with c1 = mu and c2 = -mu/2
    for (double c = 1e-3; c > 1e-7; c /= 10)
        CHECK_ABS(solid_difference("veronda-westmann", (double[]){mu / c, c, 1e6}, "mooney-rivlin",
                                   (double[]){mu, -mu / 2, 1e6}),
                  0, 1000 * c);

    uint64_t seed = 206;
    for (int i = 0; i < CASES; i++) {
        double x = check_random(&seed, 0.5, 2), e = x - 1, W, T, dT, W0, T0, dT0;
        sn_law_uniaxial(sn_law_find("linear"), (double[]){mu}, 0, 1, &x, &W0, &T0, &dT0);
        assert_true(dT0 == mu && T0 == mu * e);
        CHECK_REL(W0, mu * e * e / 2, 1e-15);
        for (double B = 1; B > 1e-18; B /= 100) {
            double zero = B < 1e-17 ? 0 : B;
            sn_law_uniaxial(sn_law_find("exponential"), (double[]){zero, mu}, 0, 1, &x, &W, &T,
                            &dT);
            // terms beyond the first: B e/2 + (B e)^2/6 + …, less than B while B e < 1
            CHECK_REL(T, T0, zero + 1e-15);
            CHECK_REL(W, W0, zero + 1e-15);
            CHECK_REL(dT, dT0, 2 * zero + 1e-15);
        }
    }
}

/// Constants that no tissue has: stress runs to infinity, never to NaN.
static void test_overflow(void **state) {
    (void)state;
    double E[6] = {1.5, -0.4, -0.4, 0, 0, 0}, W, S[6], stretch = 3, T, dT;
    sn_law_solid(sn_law_find("demiray"), (double[]){1e3, 1000, 1e6}, 0, 1, E, &W, S, NULL);
    assert_true(isinf(W) && isinf(S[0]));
    sn_law_uniaxial(sn_law_find("exponential"), (double[]){1000, 1e3}, 0, 1, &stretch, &W, &T, &dT);
    assert_true(isinf(W) && isinf(T) && isinf(dT));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energies),         cmocka_unit_test(test_guccione_isotropic),
        cmocka_unit_test(test_uniaxial_tension), cmocka_unit_test(test_exponential),
        cmocka_unit_test(test_limits),           cmocka_unit_test(test_overflow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
