// Derivatives of the stress by the constants, for every law of the registry.
// SPDX-License-Identifier: Apache-2.0
#include "points.h"

enum { CASES = 60, POINTS = 5, ROWS_MAX = 6, NUMBERS_MAX = POINTS_VALUES_MAX * ROWS_MAX };

/// Stress at one point, of any kind of law.
static void stress_at(const sn_law *law, const double *value, const double *in, double *S) {
    const int terms = law_terms(law);
    if (law->kind == SN_LAW_UNIAXIAL)
        sn_law_uniaxial(law, value, terms, 1, in, NULL, S, NULL);
    else if (law->kind == SN_LAW_SOLID)
        sn_law_solid(law, value, terms, 1, in, NULL, S, NULL);
    else
        sn_law_membrane(law, value, terms, 1, in, NULL, S, NULL);
}

/// A stretch, or a strain in the order of the law's kind.
static void random_in(const sn_law *law, uint64_t *seed, double *in) {
    random_strain(seed, 0.25, in);
    if (law->kind == SN_LAW_UNIAXIAL) in[0] = check_random(seed, 0.7, 1.4);
    if (law->kind == SN_LAW_MEMBRANE) in[2] = in[3];
}

static double size_of(int rows, const double *S) {
    double sum = 0;
    for (int c = 0; c < rows; c++) sum += S[c] * S[c];
    return sqrt(sum);
}

/// Whether no family of fibres begins to carry while constant k moves by the part `step`.
static bool is_smooth(const sn_law *law, const double *value, const double *in, int k,
                      double step) {
    if (strcmp(law->name, "hgo") != 0) return true;
    double e[2][2], moved[POINTS_VALUES_MAX];
    for (int side = 0; side < 2; side++) {
        memcpy(moved, value, sizeof moved);
        moved[k] *= side ? 1 + step : 1 - step;
        hgo_strains(moved, in, e[side]);
    }
    return e[0][0] * e[1][0] > 0 && e[0][1] * e[1][1] > 0;
}

typedef struct tally {
    int right, sloped, wrong_found, tried;
} tally;

/// Central differences by the logarithm of constant k with steps h and h/2: their errors fall by 4,
/// or are as small as rounding lets them be (1e-16 of the stress over the step, and room). Against
/// a derivative that is wrong by one part in a thousand they do not fall.
static void difference(const sn_law *law, const double *value, const double *in, int k,
                       const double *dS, tally *count) {
    const int rows = sn_law_components(law);
    double S[ROWS_MAX], slope[ROWS_MAX], error[2], wrong[2], moved[POINTS_VALUES_MAX];
    if (!is_smooth(law, value, in, k, 1.1e-3)) return;
    stress_at(law, value, in, S);
    for (int c = 0; c < rows; c++) slope[c] = value[k] * dS[k * rows + c];
    const double scale = size_of(rows, S) + size_of(rows, slope);
    for (int half = 0; half < 2; half++) {
        double step = half ? 5e-4 : 1e-3, side[2][ROWS_MAX], off[ROWS_MAX], bad[ROWS_MAX];
        for (int s = 0; s < 2; s++) {
            memcpy(moved, value, sizeof moved);
            moved[k] *= s ? 1 + step : 1 - step;
            stress_at(law, moved, in, side[s]);
        }
        for (int c = 0; c < rows; c++) {
            off[c] = (side[1][c] - side[0][c]) / (2 * step) - slope[c];
            bad[c] = off[c] - 1e-3 * slope[c];
        }
        error[half] = size_of(rows, off);
        wrong[half] = size_of(rows, bad);
    }
    const double floor = 1e-9 * scale;
    bool right = error[1] <= floor || fabs(error[0] / error[1] - 4) < 0.5;
    if (!right)
        print_message("%s, value %d: errors %.3g, %.3g, scale %.3g\n", law->name, k, error[0],
                      error[1], scale);
    count->tried++;
    count->right += right;
    count->sloped += error[1] > floor;
    // a constant that the stress hardly knows, at this point, cannot be found wrong
    bool seen = size_of(rows, slope) > 1e-4 * scale;
    count->wrong_found += !seen || !(wrong[1] <= floor || fabs(wrong[0] / wrong[1] - 4) < 0.5);
}

static void test_differences(void **state) {
    (void)state;
    uint64_t seed = 311;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        tally count = {0};
        for (int n = 0; n < CASES; n++) {
            double value[POINTS_VALUES_MAX], in[6], dS[NUMBERS_MAX];
            random_values(law, &seed, value);
            random_in(law, &seed, in);
            sn_law_sensitivity(law, value, law_terms(law), 1, in, dS);
            for (int k = 0; k < law_values(law); k++)
                if (isfinite(value[k])) difference(law, value, in, k, dS, &count);
        }
        print_message("%s: %d derivatives, %d show their slope, %d spoilt ones found\n", law->name,
                      count.tried, count.sloped, count.wrong_found);
        assert_true(count.tried >= CASES / 2 && count.right == count.tried);
        assert_int_equal(count.wrong_found, count.tried);
        bool linear = true; // in every constant: then there is no error to fall
        for (int k = 0; k < law->param_count; k++) linear &= !strcmp(law->params[k].unit, "Pa");
        assert_true(linear ? count.sloped == 0 : count.sloped > count.tried / 50);
    }
}

/// The stress is linear in every constant that is a stress, so that doubling it adds constant times
/// derivative, to rounding; a bulk modulus adds nothing.
static void test_linear_constants(void **state) {
    (void)state;
    uint64_t seed = 312;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        const int rows = sn_law_components(law);
        for (int n = 0; n < CASES; n++) {
            double value[POINTS_VALUES_MAX], in[6], dS[NUMBERS_MAX], S[ROWS_MAX], twice[ROWS_MAX];
            random_values(law, &seed, value);
            random_in(law, &seed, in);
            sn_law_sensitivity(law, value, law_terms(law), 1, in, dS);
            stress_at(law, value, in, S);
            for (int p = 0, k = 0; p < law->param_count; p++) {
                for (int i = 0; i < sn_param_length(&law->params[p], law_terms(law)); i++, k++) {
                    if (strcmp(law->params[p].unit, "Pa") != 0) continue;
                    if (law->params[p].infinity) {
                        for (int c = 0; c < rows; c++) assert_true(dS[k * rows + c] == 0);
                        continue;
                    }
                    double one = value[k];
                    value[k] = 2 * one;
                    stress_at(law, value, in, twice);
                    value[k] = one;
                    // a few hundred roundings of the projections
                    double room = 1e-13 * (size_of(rows, S) + size_of(rows, twice));
                    for (int c = 0; c < rows; c++)
                        CHECK_ABS(one * dS[k * rows + c], twice[c] - S[c], room);
                }
            }
        }
    }
}

/// Layout: a point of a batch has the numbers of the point alone.
static void test_batches(void **state) {
    (void)state;
    uint64_t seed = 313;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        const int rows = sn_law_components(law), terms = law_terms(law);
        double value[POINTS_VALUES_MAX], in[POINTS][6], batch[6 * POINTS];
        double all[NUMBERS_MAX * POINTS], one[NUMBERS_MAX];
        random_values(law, &seed, value);
        for (int i = 0; i < POINTS; i++) {
            random_in(law, &seed, in[i]);
            for (int c = 0; c < rows; c++) batch[c * POINTS + i] = in[i][c];
        }
        sn_law_sensitivity(law, value, terms, POINTS, batch, all);
        for (int i = 0; i < POINTS; i++) {
            sn_law_sensitivity(law, value, terms, 1, in[i], one);
            for (int k = 0; k < law_values(law) * rows; k++)
                CHECK_ABS(all[k * POINTS + i], one[k], 1e-15 * fabs(one[k]));
        }
    }
}

/// Where a formula has a removable 0/0, or a part of the law vanishes: closed forms.
static void test_limits(void **state) {
    (void)state;
    const sn_law *law = sn_law_find("exponential");
    const double linear[] = {0, 3e3}, stretch = 1.17;
    double dT[2];
    sn_law_sensitivity(law, linear, 0, 1, &stretch, dT);
    CHECK_REL(dT[0], 3e3 * 0.17 * 0.17 / 2, 1e-14); // 0.17 is a difference: one rounding of 1.17
    CHECK_REL(dT[1], 0.17, 1e-14);
    const double E[6] = {0.3, -0.1, -0.12, 0.05, 0, 0.02};
    const double no_fibres[] = {2e3, 0, 0, 0.1, 0.5, 1e5};
    double dS[6 * 6], S[6];
    law = sn_law_find("hgo");
    sn_law_sensitivity(law, no_fibres, 0, 1, E, dS);
    const double fibres[] = {2e3, 1, 0, 0.1, 0.5, 1e5};
    double with[6];
    sn_law_solid(law, no_fibres, 0, 1, E, NULL, S, NULL);
    sn_law_solid(law, fibres, 0, 1, E, NULL, with, NULL);
    for (int c = 0; c < 6; c++) {
        CHECK_ABS(dS[6 + c], with[c] - S[c], 1e-12); // rounding of stresses of 1e3 Pa
        for (int k = 2; k < 6; k++) assert_true(dS[6 * k + c] == 0);
    }
    assert_true(fabs(dS[6]) > 1e-2); // pulled
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_differences),
        cmocka_unit_test(test_linear_constants),
        cmocka_unit_test(test_batches),
        cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
