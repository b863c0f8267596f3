// What must hold for every law of the registry, with random constants and strains.
// SPDX-License-Identifier: Apache-2.0
//
// Objectivity needs no test: laws are functions of E, which a superposed rotation does not change.
// Major symmetry of the tangent is in its storage; that the one triangle is right for both is what
// the differences of S show.
#include "points.h"

#include "law/kernels.h"

enum { CASES = 60 };

/// The strain of Hooke's law is not isochoric; all other solid laws do not notice a dilatation.
static bool is_isochoric(const sn_law *law) {
    return strcmp(law->name, "hookean") != 0;
}

//---- derivatives ---------------------------------------------------------------------------------

/// Whether errors of central differences with steps h and h/2 show a right derivative: they fall by
/// 4, or are as small as rounding and the next term let them be. A wrong derivative leaves a
/// constant error, ratio 1.
static bool derivative_is_right(double error, double error_half, double scale) {
    double ratio = error / error_half;
    return error_half <= 1e-8 * scale || (ratio > 3.5 && ratio < 4.5);
}

typedef struct derivative_count {
    int right, sloped, wrong_found;
} derivative_count;

static void count(derivative_count *c, double error[2], double wrong[2], double scale,
                  const char *what, const char *name) {
    if (derivative_is_right(error[0], error[1], scale))
        c->right++;
    else
        print_message("%s of %s: errors %.3g, %.3g, scale %.3g\n", what, name, error[0], error[1],
                      scale);
    c->sloped += error[1] > 1e-8 * scale;
    c->wrong_found += !derivative_is_right(wrong[0], wrong[1], scale);
}

/// Whether the tangent is continuous along the differences: fibres that carry tension only must not
/// begin to carry there.
static bool is_smooth(const sn_law *law, const double *value, const double E[6],
                      const double h[6]) {
    if (strcmp(law->name, "hgo") != 0) return true;
    double e[2][2], shifted[6];
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < 6; k++) shifted[k] = E[k] + (side ? 1.1e-3 : -1.1e-3) * h[k];
        hgo_strains(value, shifted, e[side]);
    }
    return e[0][0] * e[1][0] > 0 && e[0][1] * e[1][1] > 0;
}

/// Differences of W and S along a random direction of strain against S and D, and against S and D
/// made wrong by one part in a thousand.
static void difference_solid(const sn_law *law, const double *value, uint64_t *seed,
                             derivative_count *of_W, derivative_count *of_S) {
    double E[6], h[6], W, S[6], D[21], Dh[6];
    do {
        random_strain(seed, 0.25, E);
        random_strain(seed, 0.25, h);
        double length = norm6(h);
        for (int k = 0; k < 6; k++) h[k] /= length;
    } while (!is_smooth(law, value, E, h));
    law_at(law, value, E, &W, S, D);
    tangent_times(D, h, Dh);
    double error_W[2], wrong_W[2], error_S[2], wrong_S[2];
    for (int half = 0; half < 2; half++) {
        // the third derivative of exp(b |E|^2) is about (2 b |E|)^2 times the first: with b = 20
        // and |E| = 0.5 a step of 1e-3 leaves 7e-5, and the next term of the series 1 % of that
        double step = half ? 5e-4 : 1e-3, W2[2], S2[2][6], shifted[6], difference[6], off[6];
        for (int side = 0; side < 2; side++) {
            for (int k = 0; k < 6; k++) shifted[k] = E[k] + (side ? step : -step) * h[k];
            law_at(law, value, shifted, &W2[side], S2[side], NULL);
        }
        error_W[half] = fabs((W2[1] - W2[0]) / (2 * step) - dot6(S, h));
        wrong_W[half] = fabs((W2[1] - W2[0]) / (2 * step) - 1.001 * dot6(S, h));
        for (int k = 0; k < 6; k++) {
            difference[k] = (S2[1][k] - S2[0][k]) / (2 * step) - Dh[k];
            off[k] = difference[k] - 0.001 * Dh[k];
        }
        error_S[half] = norm6(difference);
        wrong_S[half] = norm6(off);
    }
    count(of_W, error_W, wrong_W, norm6(S), "stress", law->name);
    count(of_S, error_S, wrong_S, norm6(Dh), "tangent", law->name);
}

static void difference_uniaxial(const sn_law *law, const double *value, uint64_t *seed,
                                derivative_count *of_W, derivative_count *of_T) {
    double stretch = check_random(seed, 0.8, 1.3), W, T, dT;
    sn_law_uniaxial(law, value, 0, 1, &stretch, &W, &T, &dT);
    double error_W[2], wrong_W[2], error_T[2], wrong_T[2];
    for (int half = 0; half < 2; half++) {
        double step = half ? 5e-4 : 1e-3, W2[2], T2[2];
        double at[2] = {stretch - step, stretch + step};
        sn_law_uniaxial(law, value, 0, 2, at, W2, T2, NULL);
        double slope_W = (W2[1] - W2[0]) / (2 * step), slope_T = (T2[1] - T2[0]) / (2 * step);
        error_W[half] = fabs(slope_W - T), wrong_W[half] = fabs(slope_W - 1.001 * T);
        error_T[half] = fabs(slope_T - dT), wrong_T[half] = fabs(slope_T - 1.001 * dT);
    }
    count(of_W, error_W, wrong_W, fabs(T), "stress", law->name);
    count(of_T, error_T, wrong_T, fabs(dT), "slope", law->name);
}

static void test_derivatives(void **state) {
    (void)state;
    uint64_t seed = 101;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        derivative_count of_W = {0}, of_S = {0};
        for (int i = 0; i < CASES; i++) {
            double value[POINTS_VALUES_MAX];
            random_values(law, &seed, value);
            if (law->kind == SN_LAW_UNIAXIAL)
                difference_uniaxial(law, value, &seed, &of_W, &of_S);
            else
                difference_solid(law, value, &seed, &of_W, &of_S);
        }
        print_message("%-18s of %d: stress %d (slope seen %d), tangent %d (%d)\n", law->name, CASES,
                      of_W.right, of_W.sloped, of_S.right, of_S.sloped);
        assert_int_equal(of_W.right, CASES);
        assert_int_equal(of_S.right, CASES);
        // errors of one part in a thousand are found (save where the direction makes S:h small)
        assert_true(of_W.wrong_found >= CASES * 9 / 10);
        assert_true(of_S.wrong_found >= CASES * 9 / 10);
        bool linear = strcmp(law->name, "linear") == 0 || strcmp(law->name, "hookean") == 0;
        if (!linear) assert_true(of_S.sloped >= CASES / 2);
    }
}

//---- rest, rotation, dilatation ------------------------------------------------------------------

static void test_rest(void **state) {
    (void)state;
    uint64_t seed = 102;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        double value[POINTS_VALUES_MAX], rest[6] = {0}, one = 1, W, S[6] = {0}, D[21];
        for (int i = 0; i < CASES; i++) {
            random_values(law, &seed, value);
            if (law->kind == SN_LAW_UNIAXIAL)
                sn_law_uniaxial(law, value, 0, 1, &one, &W, S, D);
            else
                law_at(law, value, rest, &W, S, D);
            assert_true(W == 0);
            for (int k = 0; k < 6; k++) assert_true(S[k] == 0);
            assert_true(D[0] > 0);
        }
    }
}

typedef enum turns { ANY_TURN, ABOUT_FIRST, HALF_TURNS } turns;

/// Half a turn about one of the axes.
static void half_turn(uint64_t *seed, double Q[3][3]) {
    int axis = (int)check_random(seed, 0, 3);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) Q[i][j] = i != j ? 0 : i == axis ? 1 : -1;
}

/// Largest difference of W and S under rotations, relative.
static double rotation_error(const sn_law *law, turns which, uint64_t *seed) {
    double worst = 0;
    for (int i = 0; i < CASES; i++) {
        double value[POINTS_VALUES_MAX], E[6], S[6], W, Q[3][3], E2[6], S2[6], W2, expected[6];
        random_values(law, seed, value);
        random_strain(seed, 0.25, E);
        if (which == HALF_TURNS)
            half_turn(seed, Q);
        else
            random_rotation(seed, which == ABOUT_FIRST, Q);
        rotate6(Q, E, E2);
        law_at(law, value, E, &W, S, NULL);
        law_at(law, value, E2, &W2, S2, NULL);
        rotate6(Q, S, expected);
        for (int k = 0; k < 6; k++) worst = fmax(worst, fabs(S2[k] - expected[k]) / norm6(S));
        worst = fmax(worst, fabs(W2 - W) / W);
    }
    return worst;
}

// Rounding of E2 is 2e-16 of |E|; an exponent of 20 with strains of 1 raises that to some 1e-14,
// and the norm of S is smaller than the terms it is summed from.
static const double rounding = 1e-12;

static void test_isotropy(void **state) {
    (void)state;
    uint64_t seed = 103;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        if (law->kind == SN_LAW_UNIAXIAL) continue;
        double any = rotation_error(law, ANY_TURN, &seed);
        double first = rotation_error(law, ABOUT_FIRST, &seed);
        double half = rotation_error(law, HALF_TURNS, &seed);
        print_message("%-18s rotation %.2g, about the first axis %.2g, half turns %.2g\n",
                      law->name, any, first, half);
        CHECK_ABS(half, 0, rounding); // all are orthotropic at least
        if (law->fibres)
            assert_true(any > 0.1); // fibres are seen
        else
            CHECK_ABS(any, 0, rounding);
        if (!law->fibres || strcmp(law->name, "guccione") == 0)
            CHECK_ABS(first, 0, rounding);
        else
            assert_true(first > 0.1); // two axes are seen
    }
}

static void test_dilatation(void **state) {
    (void)state;
    uint64_t seed = 104;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        if (law->kind != SN_LAW_SOLID) continue;
        double worst_pressure = 0, worst_energy = 0;
        for (int i = 0; i < CASES; i++) {
            double value[POINTS_VALUES_MAX], E[6], C[6], S[6], W, W2, grown[6];
            random_values(law, &seed, value);
            random_strain(&seed, 0.25, E);
            double s = check_random(&seed, 0.5, 2);
            for (int k = 0; k < 6; k++) {
                C[k] = 2 * E[k] + (k < 3);
                grown[k] = (s * C[k] - (k < 3)) / 2;
            }
            law_at(law, value, E, &W, S, NULL);
            law_at(law, value, grown, &W2, NULL, NULL);
            worst_pressure = fmax(worst_pressure, fabs(dot6(S, C)) / (norm6(S) * norm6(C)));
            worst_energy = fmax(worst_energy, fabs(W2 - W) / W);
        }
        if (is_isochoric(law)) {
            CHECK_ABS(worst_pressure, 0, rounding);
            CHECK_ABS(worst_energy, 0, rounding);
        } else {
            assert_true(worst_pressure > 0.01 && worst_energy > 0.1);
        }
    }
}

//---- moduli --------------------------------------------------------------------------------------

static void test_moduli(void **state) {
    (void)state;
    uint64_t seed = 105;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        double value[POINTS_VALUES_MAX], rest[6] = {0}, one = 1, D[21];
        for (int i = 0; i < CASES; i++) {
            sn_moduli m;
            random_values(law, &seed, value);
            law->moduli(value, law_terms(law), &m);
            if (law->kind == SN_LAW_UNIAXIAL) {
                sn_law_uniaxial(law, value, 0, 1, &one, NULL, NULL, D);
                CHECK_REL(D[0], m.young, 1e-14);
                continue;
            }
            law_at(law, value, rest, NULL, NULL, D);
            if (law->kind == SN_LAW_MEMBRANE) {
                double d12 = D[upper(0, 1)];
                CHECK_REL(m.young, D[0] - d12 * d12 / D[upper(1, 1)], 1e-12);
                CHECK_REL(m.shear, D[upper(3, 3)], 1e-14);
                assert_true(isinf(m.bulk));
                continue;
            }
            CHECK_REL(1 / m.young, 1 / (9 * m.bulk) + 1 / (3 * m.shear), 1e-12);
            // 2 mu times the deviator; across the fibres only its shear is the isotropic part's
            for (int j = 0; j < 6; j++)
                for (int k = j; k < 6; k++) {
                    double expected = m.shear * (j != k  ? k < 3 ? -2.0 / 3 : 0
                                                 : j < 3 ? 4.0 / 3
                                                         : 1);
                    if (law->fibres && !(j == 4 && k == 4)) continue;
                    CHECK_ABS(D[upper(j, k)] / m.shear, expected / m.shear, 1e-14);
                }
        }
    }
}

//---- single precision ----------------------------------------------------------------------------

/// Largest error of single precision against double at the same (single precision) numbers, in
/// units of the single precision rounding unit: of W by itself, of S by its norm, of D by its
/// largest component.
static void single_errors(const sn_law *law, double size, uint64_t *seed, double worst[3]) {
    worst[0] = worst[1] = worst[2] = 0;
    for (int i = 0; i < 10 * CASES; i++) {
        double value[POINTS_VALUES_MAX], E[6], W, S[6] = {0}, D[21] = {0};
        float value_f[POINTS_VALUES_MAX], E_f[6], W_f, S_f[6] = {0}, D_f[21] = {0};
        random_values(law, seed, value);
        for (int k = 0; k < law_values(law); k++) value[k] = (double)(value_f[k] = (float)value[k]);
        if (law->kind == SN_LAW_UNIAXIAL) {
            E[0] = (double)(E_f[0] = (float)check_random(seed, 1 - size, 1 + size));
            sn_law_uniaxial(law, value, 0, 1, E, &W, S, D);
            sn_law_uniaxial_f(law, value_f, 0, 1, E_f, &W_f, S_f, D_f);
        } else {
            random_strain(seed, size, E);
            for (int k = 0; k < 6; k++) E[k] = (double)(E_f[k] = (float)E[k]);
            law_at(law, value, E, &W, S, D);
            law_at_f(law, value_f, E_f, &W_f, S_f, D_f);
        }
        const double unit = 0x1p-24;
        worst[0] = fmax(worst[0], fabs((double)W_f - W) / W / unit);
        for (int k = 0; k < 6; k++)
            worst[1] = fmax(worst[1], fabs((double)S_f[k] - S[k]) / norm6(S) / unit);
        double largest = 0;
        for (int k = 0; k < 21; k++) largest = fmax(largest, fabs(D[k]));
        for (int k = 0; k < 21; k++)
            worst[2] = fmax(worst[2], fabs((double)D_f[k] - D[k]) / largest / unit);
    }
}

static void test_single_precision(void **state) {
    (void)state;
    uint64_t seed = 106;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        double large[3], small[3];
        single_errors(law, 0.25, &seed, large);
        single_errors(law, 1e-4, &seed, small);
        print_message("%-18s rounding units: W %.0f, S %.0f, D %.0f; at strains of 1e-4: "
                      "W %.0f, S %.0f, D %.0f\n",
                      law->name, large[0], large[1], large[2], small[0], small[1], small[2]);
        // some 30 operations in a row, each good for a unit or two, and an exponent (up to 40 here)
        // that multiplies the error of its argument
        for (int k = 0; k < 3; k++) CHECK_ABS(large[k], 0, 200);
        // nothing cancels at small strains: without the care of isochoric.h S would lose a factor
        // of 1e4, W of 1e8
        for (int k = 0; k < 3; k++) CHECK_ABS(small[k], 0, 30);
    }
}

//---- batches -------------------------------------------------------------------------------------

enum { BATCH = 83, GUARD = 7 };
static const double guard = 12345.678;

typedef struct outputs {
    double W[BATCH + GUARD], S[6 * BATCH + GUARD], D[21 * BATCH + GUARD];
    float W_f[BATCH + GUARD], S_f[6 * BATCH + GUARD], D_f[21 * BATCH + GUARD];
} outputs;

static void outputs_reset(outputs *o) {
    double *all = (double *)o->W;
    size_t count = (sizeof o->W + sizeof o->S + sizeof o->D) / sizeof(double);
    for (size_t i = 0; i < count; i++) all[i] = guard;
    float *all_f = (float *)o->W_f;
    count = (sizeof o->W_f + sizeof o->S_f + sizeof o->D_f) / sizeof(float);
    for (size_t i = 0; i < count; i++) all_f[i] = (float)guard;
}

/// One batch on one row; bit 0, 1, 2 of `which`: W, S, D wanted.
static void run_row(const sn_law *law, int isa, int n, int which, const double *value,
                    const double *in, outputs *o) {
    float value_f[POINTS_VALUES_MAX], in_f[6 * BATCH];
    for (int k = 0; k < law_values(law); k++) value_f[k] = (float)value[k];
    for (int k = 0; k < 6 * n; k++) in_f[k] = (float)in[k];
    outputs_reset(o);
    sn_law_batch_64 b = {.value = value, .terms = law_terms(law), .n = n, .in = in};
    b.W = which & 1 ? o->W : NULL, b.S = which & 2 ? o->S : NULL, b.D = which & 4 ? o->D : NULL;
    law->kernels->f64[isa](&b);
    sn_law_batch_32 f = {.value = value_f, .terms = law_terms(law), .n = n, .in = in_f};
    f.W = which & 1 ? o->W_f : NULL, f.S = which & 2 ? o->S_f : NULL;
    f.D = which & 4 ? o->D_f : NULL;
    law->kernels->f32[isa](&f);
}

/// Every row gives the bits of the scalar row, for every length (tails), every choice of outputs,
/// and writes nothing beyond.
static void test_rows(void **state) {
    (void)state;
    static outputs all, some, expected;
    uint64_t seed = 107;
    int compared = 0;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        const bool solid = law->kind == SN_LAW_SOLID, membrane = law->kind == SN_LAW_MEMBRANE;
        const size_t rows_S = solid ? 6 : membrane ? 3 : 1, rows_D = solid ? 21 : membrane ? 6 : 1;
        double value[POINTS_VALUES_MAX], in[6 * BATCH];
        for (int n = 0; n <= BATCH; n = n < 18 ? n + 1 : n + 13) {
            random_values(law, &seed, value);
            for (int i = 0; i < n; i++) {
                double E[6];
                random_strain(&seed, 0.25, E);
                for (int k = 0; k < 6; k++) in[k * n + i] = E[k];
                if (law->kind == SN_LAW_UNIAXIAL) in[i] = check_random(&seed, 0.7, 1.4);
            }
            run_row(law, SN_ISA_scalar, n, 7, value, in, &all);
            for (int isa = 0; isa < SN_ISA_COUNT; isa++) {
                if (!sn_isa_available(isa)) continue;
                for (int which = 0; which < 8; which++) {
                    run_row(law, isa, n, which, value, in, &some);
                    outputs_reset(&expected);
                    const size_t N = (size_t)n;
#define TAKE(flag, part, rows)                                                                     \
    if (which & flag) memcpy(expected.part, all.part, (rows)*N * sizeof expected.part[0])
                    TAKE(1, W, 1);
                    TAKE(1, W_f, 1);
                    TAKE(2, S, rows_S);
                    TAKE(2, S_f, rows_S);
                    TAKE(4, D, rows_D);
                    TAKE(4, D_f, rows_D);
#undef TAKE
                    if (memcmp(&some, &expected, sizeof some) != 0)
                        fail_msg("%s: %s differs from scalar: n = %d, outputs %d", law->name,
                                 sn_isa_row_name(isa), n, which);
                    compared++;
                }
            }
            if (n > 0) assert_true(all.S[0] != guard && all.D_f[0] != (float)guard);
        }
    }
    print_message("%d batches compared\n", compared);
    assert_true(compared > 1000);
}

/// The point is the same wherever in a batch it stands, and by the public functions.
static void test_public_functions(void **state) {
    (void)state;
    uint64_t seed = 108;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        if (law->kind == SN_LAW_UNIAXIAL) continue;
        const bool membrane = law->kind == SN_LAW_MEMBRANE;
        const int rows = membrane ? 3 : 6, rows_D = membrane ? 6 : 21, terms = law_terms(law);
        void (*call)(const sn_law *, const double *, int, int, const double *, double *, double *,
                     double *) = membrane ? sn_law_membrane : sn_law_solid;
        double value[POINTS_VALUES_MAX], E[6 * BATCH], W[BATCH], S[6 * BATCH], D[21 * BATCH];
        random_values(law, &seed, value);
        for (int i = 0; i < BATCH; i++) {
            double one[6];
            random_strain(&seed, 0.25, one);
            for (int k = 0; k < 6; k++) E[k * BATCH + i] = one[k];
        }
        call(law, value, terms, BATCH, E, W, S, D);
        for (int i = 0; i < BATCH; i += 11) {
            double one[6], W1, S1[6], D1[21];
            for (int k = 0; k < rows; k++) one[k] = E[k * BATCH + i];
            call(law, value, terms, 1, one, &W1, S1, D1);
            assert_true(W1 == W[i]);
            for (int k = 0; k < rows; k++) assert_true(S1[k] == S[k * BATCH + i]);
            for (int k = 0; k < rows_D; k++) assert_true(D1[k] == D[k * BATCH + i]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivatives),      cmocka_unit_test(test_rest),
        cmocka_unit_test(test_isotropy),         cmocka_unit_test(test_dilatation),
        cmocka_unit_test(test_moduli),           cmocka_unit_test(test_rows),
        cmocka_unit_test(test_single_precision), cmocka_unit_test(test_public_functions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
