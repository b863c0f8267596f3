// Laws with axes: the laws they contain, the conditions they put on their constants, membranes
// against equations (19) to (21) as they are written.
// SPDX-License-Identifier: Apache-2.0
#include "points.h"

enum { CASES = 200 };

/// Two laws at the same points: largest difference of W, S and D, each by its own size.
static double law_difference(const char *one, const double *p, const char *other, const double *q) {
    uint64_t seed = 801;
    double worst = 0;
    for (int i = 0; i < CASES; i++) {
        double E[6], W[2], S[2][6], D[2][21], largest = 0;
        random_strain(&seed, 0.25, E);
        law_at(sn_law_find(one), p, E, &W[0], S[0], D[0]);
        law_at(sn_law_find(other), q, E, &W[1], S[1], D[1]);
        worst = fmax(worst, fabs(W[1] - W[0]) / W[1]);
        for (int k = 0; k < 6; k++) worst = fmax(worst, fabs(S[1][k] - S[0][k]) / norm6(S[1]));
        for (int k = 0; k < 21; k++) largest = fmax(largest, fabs(D[1][k]));
        for (int k = 0; k < 21; k++) worst = fmax(worst, fabs(D[1][k] - D[0][k]) / largest);
    }
    return worst;
}
static const double rounding = 1e-12; // exponents of 10 at strains of 0.5

static void test_fung_limits(void **state) {
    (void)state;
    const double C = 2300, bf = 8.5, bt = 2.5, bfs = 4.25;
    const double guccione[] = {C, bf, bt, bfs, 1e6};
    double fung[] = {C, bf, bt, bt, 0, 0, 0, bfs, bt, bfs, 1e6};
    CHECK_ABS(law_difference("fung", fung, "guccione", guccione), 0, rounding);
    fung[4] = 0.01; // seen
    assert_true(law_difference("fung", fung, "guccione", guccione) > 1e-4);

    const double full[] = {C, 9, 5, 4, 1.5, -1, 0.5, 3, 2, 2.5, 1e6};
    double general[20] = {0};
    memcpy(general + 9, full, sizeof full);
    CHECK_ABS(law_difference("fung-general", general, "fung", full), 0, rounding);
    // a first-order in alpha: the energies add
    const double alpha[] = {900, 700, 800, 100, -200, 50, 300, 400, 350};
    memcpy(general, alpha, sizeof alpha);
    double both = law_difference("fung-general", general, "fung", full);
    for (int k = 0; k < 9; k++) general[k] /= 2;
    CHECK_REL(both / law_difference("fung-general", general, "fung", full), 2, 1e-9);
}

/// On strains in the plane that keep the volume the solid law is equation (21).
static void test_fung_is_planar(void **state) {
    (void)state;
    uint64_t seed = 802;
    const double solid[] = {2300, 9, 5, 4, 1.5, -1, 0.5, 3, 2, 2.5, 1e6};
    const double planar[] = {2300, 9, 5, 3, 1.5};
    const sn_law *fung = sn_law_find("fung"), *plane_law = sn_law_find("fung-planar");
    for (int i = 0; i < CASES; i++) {
        double x = check_random(&seed, 0.7, 1.5), xy = check_random(&seed, -0.4, 0.4), W[2];
        double C22 = (1 + xy * xy) / x, E[6] = {(x - 1) / 2, (C22 - 1) / 2, 0, xy / 2};
        law_at(fung, solid, E, &W[0], NULL, NULL);
        law_at(plane_law, planar, E, &W[1], NULL, NULL);
        CHECK_REL(W[0], W[1], 1e-12);
    }
}

static void test_hgo_limits(void **state) {
    (void)state;
    const double mu = 2300, neo[] = {mu, 1e6}, half_pi = 1.57079632679489661923;
    CHECK_ABS(law_difference("hgo", (double[]){mu, 0, 5, 0.1, 0.5, 1e6}, "neo-hookean", neo), 0,
              rounding);
    // fibres in all directions: no angle is seen
    CHECK_ABS(law_difference("hgo", (double[]){mu, 9e3, 5, 1.0 / 3, 0.5, 1e6}, "hgo",
                             (double[]){mu, 9e3, 5, 1.0 / 3, 1.2, 1e6}),
              0, rounding);
    // two families in line are one of twice the stiffness; along the second axis by exchange
    const sn_law *law = sn_law_find("hgo");
    uint64_t seed = 803;
    for (int i = 0; i < CASES; i++) {
        double E[6], turned[6], W[2], S[2][6], k2 = check_random(&seed, 0.1, 20);
        random_strain(&seed, 0.25, E);
        const double swap[6] = {E[1], E[0], E[2], E[3], E[5], E[4]};
        memcpy(turned, swap, sizeof swap);
        law_at(law, (double[]){mu, 9e3, k2, 0.05, 0, 1e6}, E, &W[0], S[0], NULL);
        law_at(law, (double[]){mu, 9e3, k2, 0.05, half_pi, 1e6}, turned, &W[1], S[1], NULL);
        CHECK_REL(W[0], W[1], 1e-13);
        CHECK_ABS((S[0][0] - S[1][1]) / norm6(S[0]), 0, 1e-13);
        double e[2], q[] = {mu, 9e3, k2, 0.05, 0};
        hgo_strains(q, E, e);
        double fibres = e[0] > 0 ? 9e3 / k2 * expm1(k2 * e[0] * e[0]) : 0, Ebar[6], I1, I2;
        isochoric_of(E, Ebar, &I1, &I2);
        CHECK_REL(W[0], mu / 2 * (I1 - 3) + fibres, 1e-11);
    }
    // pressed along fibres in line: none carries, and across them all do
    double pressed[6] = {-0.2, 0.12, 0.12, 0.01, 0.02, -0.03}, pulled[6] = {0.2, -0.1, -0.1};
    double W[2], S[2][6], D[2][21], p[] = {mu, 9e3, 5, 0, 0, 1e6};
    law_at(law, p, pressed, &W[0], S[0], D[0]);
    law_at(sn_law_find("neo-hookean"), neo, pressed, &W[1], S[1], D[1]);
    CHECK_REL(W[0], W[1], 1e-14);
    for (int k = 0; k < 6; k++) CHECK_ABS(S[0][k] / mu, S[1][k] / mu, 1e-14);
    for (int k = 0; k < 21; k++) CHECK_ABS(D[0][k] / mu, D[1][k] / mu, 1e-14);
    law_at(law, p, pulled, &W[0], S[0], D[0]);
    law_at(sn_law_find("neo-hookean"), neo, pulled, &W[1], S[1], D[1]);
    assert_true(W[0] > 2 * W[1] && S[0][0] > 2 * S[1][0]);
    // k2 = 0 is the limit of small k2
    CHECK_ABS(law_difference("hgo", (double[]){mu, 9e3, 1e-9, 0.1, 0.6, 1e6}, "hgo",
                             (double[]){mu, 9e3, 0, 0.1, 0.6, 1e6}),
              0, 1e-8);
}

//---- membranes -----------------------------------------------------------------------------------

/// Equation (20) as it is written.
static void test_skin_stresses(void **state) {
    (void)state;
    uint64_t seed = 804;
    const sn_law *law = sn_law_find("fung-skin");
    for (int i = 0; i < CASES; i++) {
        double v[POINTS_VALUES_MAX], e[6], S[3], W, zero[3] = {0}, D[6];
        random_values(law, &seed, v);
        random_strain(&seed, 0.25, e);
        const double E11 = e[0], E22 = e[1], E12 = e[3], E[3] = {E11, E22, E12};
        const double *alpha = v, c = v[4], *a = v + 5;
        const double g1 = v[9], g2 = v[10], g4 = v[11], g5 = v[12];
        double Q = a[0] * E11 * E11 + a[1] * E22 * E22 + 2 * a[2] * E12 * E12 +
                   2 * a[3] * E11 * E22 + g1 * pow(E11, 3) + g2 * pow(E22, 3) +
                   g4 * E11 * E11 * E22 + g5 * E11 * E22 * E22;
        double X = exp(Q);
        double A1 =
            a[0] * E11 + a[3] * E22 + 1.5 * g1 * E11 * E11 + g4 * E11 * E22 + g5 * E22 * E22 / 2;
        double A2 =
            a[3] * E11 + a[1] * E22 + 1.5 * g2 * E22 * E22 + g4 * E11 * E11 / 2 + g5 * E11 * E22;
        double S11 = alpha[0] * E11 + alpha[3] * E22 + c * A1 * X;
        double S22 = alpha[3] * E11 + alpha[1] * E22 + c * A2 * X;
        double S12 = alpha[2] * E12 + c * a[2] * E12 * X;
        sn_law_membrane(law, v, 0, 1, E, &W, S, NULL);
        double size = fabs(S11) + fabs(S22) + fabs(S12);
        CHECK_ABS(S[0] / size, S11 / size, 1e-13);
        CHECK_ABS(S[1] / size, S22 / size, 1e-13);
        CHECK_ABS(S[2] / size, S12 / size, 1e-13);
        CHECK_REL(W,
                  (alpha[0] * E11 * E11 + alpha[1] * E22 * E22 + 2 * alpha[2] * E12 * E12 +
                   2 * alpha[3] * E11 * E22) /
                          2 +
                      c / 2 * (X - 1),
                  1e-10);
        // S12 counts E12 and E21 apart: moving the one symbol for both does twice its work
        double moved[2][3] = {{E11, E22, E12 - 1e-6}, {E11, E22, E12 + 1e-6}}, W2[2];
        for (int k = 0; k < 2; k++) sn_law_membrane(law, v, 0, 1, moved[k], &W2[k], NULL, NULL);
        CHECK_ABS((W2[1] - W2[0]) / 2e-6 / size, 2 * S12 / size, 1e-7);
        sn_law_membrane(law, v, 0, 1, zero, NULL, NULL, D);
        CHECK_REL(D[5], (alpha[2] + c * a[2]) / 2, 1e-14);
    }
}

static void test_membrane_limits(void **state) {
    (void)state;
    uint64_t seed = 805;
    const double planar[] = {2300, 9, 5, 3, 1.5};
    double skin[13] = {0, 0, 0, 0, 2300, 9, 5, 3, 1.5};
    CHECK_ABS(law_difference("fung-skin", skin, "fung-planar", planar), 0, rounding);
    // isotropic in its plane where a1 = a2 and a4 = a1 - a3
    const sn_law *law = sn_law_find("fung-planar");
    const double round[] = {2300, 9, 9, 5, 4}, oval[] = {2300, 9, 9, 5, 3};
    double seen = 0;
    for (int i = 0; i < CASES; i++) {
        double E[6], W[4], turn = check_random(&seed, 0, 6), c = cos(turn), s = sin(turn);
        random_strain(&seed, 0.25, E);
        const double turned[6] = {c * c * E[0] + s * s * E[1] + 2 * c * s * E[3],
                                  s * s * E[0] + c * c * E[1] - 2 * c * s * E[3], 0,
                                  c * s * (E[1] - E[0]) + (c * c - s * s) * E[3]};
        law_at(law, round, E, &W[0], NULL, NULL);
        law_at(law, round, turned, &W[1], NULL, NULL);
        CHECK_REL(W[1], W[0], 1e-12);
        law_at(law, oval, E, &W[2], NULL, NULL);
        law_at(law, oval, turned, &W[3], NULL, NULL);
        seen = fmax(seen, fabs(W[3] / W[2] - 1));
    }
    assert_true(seen > 0.1);
}

//---- conditions ----------------------------------------------------------------------------------

static double form_of(const double *a, const double x[3]) {
    return a[0] * x[0] * x[0] + a[1] * x[1] * x[1] + a[2] * x[2] * x[2] +
           2 * (a[3] * x[0] * x[1] + a[4] * x[1] * x[2] + a[5] * x[2] * x[0]);
}

/// What is accepted is positive in every direction tried; what is refused is not in some.
static void test_fung_conditions(void **state) {
    (void)state;
    uint64_t seed = 806;
    const sn_law *law = sn_law_find("fung");
    int accepted = 0, refused = 0, agreed = 0;
    for (int i = 0; i < 2000; i++) {
        double v[11] = {2300}, *a = v + 1, x[3], least = (double)INFINITY;
        for (int k = 0; k < 3; k++) a[k] = check_random(&seed, -1, 9);
        for (int k = 3; k < 6; k++) a[k] = check_random(&seed, -4, 4);
        for (int k = 6; k < 9; k++) a[k] = 1;
        v[10] = 1e6;
        for (int k = 0; k < 3000; k++) {
            double length = 0;
            for (int d = 0; d < 3; d++) x[d] = check_random(&seed, -1, 1), length += x[d] * x[d];
            least = fmin(least, form_of(a, x) / length);
        }
        bool good = sn_law_check(law, v, 0) == SN_OK;
        if (good) assert_true(least > 0);
        accepted += good;
        refused += !good;
        agreed += good == (least > 0);
    }
    assert_true(accepted > 300 && refused > 300);
    assert_true(agreed > 1980); // 3000 directions miss the narrowest cones
}

static void test_messages(void **state) {
    (void)state;
    const sn_law *fung = sn_law_find("fung"), *general = sn_law_find("fung-general");
    const sn_law *skin = sn_law_find("fung-skin"), *planar = sn_law_find("fung-planar");
    double f[] = {2300, 9, 5, 4, 1.5, -1, 0.5, 3, 2, 2.5, 1e6}, g[20] = {0};
    CHECK_OK(sn_law_check(fung, f, 0));
    memcpy(g + 9, f, sizeof f);
    CHECK_OK(sn_law_check(general, g, 0)); // alpha = 0 is weakly convex
    f[1] = -9;
    CHECK_FAILS(sn_law_check(fung, f, 0), SN_E_RANGE, "a, 11 is -9: expected more than 0");
    f[1] = 9, f[4] = 7;
    CHECK_FAILS(sn_law_check(fung, f, 0), SN_E_RANGE, "11 22 - 12^2 is -4");
    f[4] = 4, f[5] = 4, f[6] = -4;
    CHECK_FAILS(sn_law_check(fung, f, 0), SN_E_RANGE, "det [11 12 31; 12 22 23; 31 23 33] is");
    f[4] = f[5] = f[6] = 0, f[8] = 0;
    CHECK_FAILS(sn_law_check(fung, f, 0), SN_E_RANGE, "shear 23 is 0");
    f[0] = -1;
    CHECK_FAILS(sn_law_check(fung, f, 0), SN_E_RANGE, "law fung: c is -1 Pa");
    g[0] = g[1] = g[2] = g[3] = g[4] = g[5] = 0.1; // of rank one: weakly convex, to rounding
    CHECK_OK(sn_law_check(general, g, 0));
    g[3] = -0.2;
    CHECK_FAILS(sn_law_check(general, g, 0), SN_E_RANGE, "alpha, 11 22 - 12^2 is -0.03");
    g[3] = 0.1, g[10] = 0;
    CHECK_FAILS(sn_law_check(general, g, 0), SN_E_RANGE, "a, 11 is 0");

    double s[] = {0, 0, 0, 0, 2300, 9, 5, 3, 1.5, 1, -1, 2, -2};
    CHECK_OK(sn_law_check(skin, s, 0));
    s[3] = 1;
    CHECK_FAILS(sn_law_check(skin, s, 0), SN_E_RANGE, "alpha1 alpha2 - alpha4^2 is -1");
    s[3] = 0, s[8] = -7;
    CHECK_FAILS(sn_law_check(skin, s, 0), SN_E_RANGE, "[a1 a4; a4 a2] positive definite");
    s[8] = 0, s[7] = 0;
    CHECK_FAILS(sn_law_check(skin, s, 0), SN_E_RANGE, "a3 is 0: expected more than 0");
    CHECK_FAILS(sn_law_check(planar, (double[]){-1, 9, 5, 3, 1.5}, 0), SN_E_RANGE, "c is -1 Pa");
    CHECK_FAILS(sn_law_check(planar, (double[]){1, 9, 5, 3, 6.8}, 0), SN_E_RANGE,
                "a1 a2 - a4^2 is -1.24");
    double h[] = {2300, 9e3, 5, 0.34, 0.5, 1e6};
    CHECK_FAILS(sn_law_check(sn_law_find("hgo"), h, 0), SN_E_RANGE, "kappa is 0.34");
    h[3] = 0.1, h[4] = 1.6;
    CHECK_FAILS(sn_law_check(sn_law_find("hgo"), h, 0), SN_E_RANGE, "angle is 1.6 rad");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fung_limits),     cmocka_unit_test(test_fung_is_planar),
        cmocka_unit_test(test_hgo_limits),      cmocka_unit_test(test_skin_stresses),
        cmocka_unit_test(test_membrane_limits), cmocka_unit_test(test_fung_conditions),
        cmocka_unit_test(test_messages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
