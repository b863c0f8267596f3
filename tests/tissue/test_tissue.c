// Tissues: checks, named values, conversion from long-term constants, moduli.
// SPDX-License-Identifier: Apache-2.0
#include "check.h"

#include "sinew/tissue.h"

static const sn_param list_params[] = {
    {.name = "scale", .symbol = "s", .unit = "1", .min = 0, .max = 9, .init = 1},
    {.name = "mu", .symbol = "mu", .unit = "Pa", .max = 1e9, .length = SN_PARAM_LIST},
    {.name = "alpha", .symbol = "alpha", .unit = "1", .min = -9, .max = 9, .length = SN_PARAM_LIST},
    {.name = "bulk", .symbol = "K", .unit = "Pa", .max = 1e12, .infinity = "incompressible"},
};
/// A solid law with lists, which is never evaluated.
static const sn_law list_law = {
    .name = "listed", .kind = SN_LAW_SOLID, .param_count = 4, .params = list_params};

static sn_tissue spring(void) {
    sn_tissue t = sn_tissue_default();
    t.law = sn_law_find("exponential");
    assert_non_null(t.law);
    CHECK_OK(sn_tissue_set(&t, "B", 11.37));
    CHECK_OK(sn_tissue_set(&t, "C", 20713.0));
    return t;
}

static void set_memory(sn_tissue *t, const char *law, int terms, const double *value, int count) {
    t->memory = (sn_memory){.law = sn_memory_law_find(law), .terms = terms};
    assert_non_null(t->memory.law);
    memcpy(t->memory.value, value, (size_t)count * sizeof *value);
}

static void test_default(void **state) {
    (void)state;
    sn_tissue t = sn_tissue_default();
    assert_null(t.law);
    assert_true(isnan(t.density) && isnan(t.poissons_ratio));
    assert_string_equal(t.memory.law->name, "none");
    CHECK_FAILS(sn_tissue_check(&t), SN_E_DEFINITION, "no elastic law");
    t = spring();
    CHECK_OK(sn_tissue_check(&t));
    t.density = 1071.3;
    t.poissons_ratio = 0.37;
    CHECK_OK(sn_tissue_check(&t));
}

static void test_check_refuses(void **state) {
    (void)state;
    sn_tissue good = spring(), t = good;
    strcpy(t.name, "rabbit skin");
    t.density = 0;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "tissue rabbit skin: density is 0 kg/m3");
    t = good, t.density = INFINITY;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "density is inf");
    t = good, t.poissons_ratio = 0.5;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "poissons_ratio is 0.5");
    t = good, t.poissons_ratio = -1;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "poissons_ratio is -1");
    t = sn_tissue_default(), t.law = &list_law, t.terms = 1; // its zeros are in range
    CHECK_OK(sn_tissue_check(&t));
    t.poissons_ratio = 0.3;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_DEFINITION, "law listed is not uniaxial");
    t = good, t.law = &list_law, t.terms = 0;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "law listed: 0 terms");
    t = good, t.terms = 3;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "law exponential: 3 terms");
    t = good;
    CHECK_OK(sn_tissue_set(&t, "C", NAN));
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "C is missing");
    t = good;
    set_memory(&t, "kelvin", 0, (double[]){2, 1}, 2);
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "memory kelvin");
}

static void test_named_values(void **state) {
    (void)state;
    sn_tissue t = spring();
    assert_true(sn_tissue_value(&t, "B") == 11.37 && sn_tissue_value(&t, "C") == 20713.0);
    assert_true(isnan(sn_tissue_value(&t, "D")));
    CHECK_FAILS(sn_tissue_set(&t, "quasar", 1), SN_E_NAME, "law exponential has no parameter");
    t.law = &list_law, t.terms = 3;
    CHECK_OK(sn_tissue_set(&t, "bulk", 3e5));
    assert_true(t.value[1 + 3 + 3] == 3e5 && sn_tissue_value(&t, "bulk") == 3e5);
    CHECK_FAILS(sn_tissue_set(&t, "mu", 1), SN_E_NAME, "is a list");
    assert_true(isnan(sn_tissue_value(&t, "mu")));
    CHECK_FAILS(sn_tissue_set(&t, "bulc", 1), SN_E_NAME, "did you mean \"bulk\"");
    t.law = NULL;
    assert_true(isnan(sn_tissue_value(&t, "bulk")));
    CHECK_FAILS(sn_tissue_set(&t, "bulk", 1), SN_E_NAME, "no elastic law");
}

static double stress_at(const sn_tissue *t, double stretch) {
    double T;
    sn_law_uniaxial(t->law, t->value, t->terms, 1, &stretch, NULL, &T, NULL);
    return T;
}

// After conversion the long-term stress, G(infinity) times the instantaneous one, is what was
// given, at every stretch; and the response to a step, over the long-term stress, is 1 + sum g
// exp(-t/tau).
static void test_from_long_term(void **state) {
    (void)state;
    static const double prony[] = {0.71, 0.93, 0.31, 0.05, 1.7, 33.0}; // weights sum to 1.95
    sn_tissue given = spring(), t = given;
    set_memory(&t, "prony", 3, prony, 6);
    CHECK_OK(sn_tissue_from_long_term(&t));
    CHECK_OK(sn_tissue_check(&t));
    for (double stretch = 0.9; stretch < 1.3; stretch += 0.07) {
        double long_term = stress_at(&given, stretch);
        CHECK_REL(sn_memory_equilibrium(&t.memory) * stress_at(&t, stretch), long_term, 1e-14);
        for (double time = 0.01; time < 100; time *= 9) {
            double expected = long_term;
            for (int i = 0; i < 3; i++)
                expected += long_term * prony[i] * exp(-time / prony[3 + i]);
            CHECK_REL(sn_memory_relaxation(&t.memory, time) * stress_at(&t, stretch), expected,
                      1e-14);
        }
    }
    t = given;
    set_memory(&t, "fung-spectrum", 0, (double[]){0.31, 0.02, 70}, 3);
    CHECK_OK(sn_tissue_from_long_term(&t));
    CHECK_REL(sn_tissue_value(&t, "C"), 20713.0 * (1 + 0.31 * log(70 / 0.02)), 1e-14);
    assert_true(sn_tissue_value(&t, "B") == 11.37 && t.memory.value[0] == 0.31);
    static const char *const unchanged[] = {"none", "voigt"};
    for (int i = 0; i < 2; i++) {
        t = given;
        set_memory(&t, unchanged[i], 0, (double[]){0.4}, 1);
        CHECK_OK(sn_tissue_from_long_term(&t));
        assert_true(sn_tissue_value(&t, "C") == 20713.0);
    }
}

static void test_from_long_term_lists(void **state) {
    (void)state;
    sn_tissue t = sn_tissue_default();
    t.law = &list_law, t.terms = 2;
    memcpy(t.value, (double[]){3, 100, 200, 5, 7, INFINITY}, 6 * sizeof(double));
    set_memory(&t, "kelvin", 0, (double[]){1, 4}, 2); // G(infinity) = 1/4
    CHECK_OK(sn_tissue_from_long_term(&t));
    static const double expected[] = {3, 400, 800, 5, 7, INFINITY};
    assert_memory_equal(t.value, expected, sizeof expected);
}

static void test_from_long_term_refuses(void **state) {
    (void)state;
    sn_tissue t = spring();
    set_memory(&t, "maxwell", 0, (double[]){0.4}, 1);
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_RANGE, "maxwell relaxes to no stress");
    set_memory(&t, "prony", 1, (double[]){-1.5, 2}, 2);
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_RANGE, "weights g sum to -1.5");
    set_memory(&t, "kelvin", 0, (double[]){4, 1}, 2);
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_RANGE, "tau_epsilon");
    t.law = NULL;
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_DEFINITION, "without an elastic law");
}

// The conversion multiplies constants in pascals: every law must be made of those and pure numbers.
static void test_units_of_laws(void **state) {
    (void)state;
    for (int i = 0; i < sn_law_count(); i++) {
        const sn_law *law = sn_law_at(i);
        for (int k = 0; k < law->param_count; k++) {
            const char *unit = law->params[k].unit;
            if (strcmp(unit, "Pa") && strcmp(unit, "1") && strcmp(unit, "rad")) {
                print_message("law %s: %s in %s\n", law->name, law->params[k].name, unit);
                fail();
            }
        }
    }
}

// Equation (5): a bar of modulus E and ratio nu, sheared and compressed.
static void test_moduli(void **state) {
    (void)state;
    sn_tissue t = spring();
    sn_moduli m;
    sn_tissue_moduli(&t, &m);
    assert_true(m.young == 20713.0 && isnan(m.shear) && isnan(m.bulk));
    t.poissons_ratio = 0.37;
    sn_tissue_moduli(&t, &m);
    CHECK_REL(m.young, 9 * m.bulk * m.shear / (3 * m.bulk + m.shear), 1e-15);
    CHECK_REL((3 * m.bulk - 2 * m.shear) / (2 * (3 * m.bulk + m.shear)), 0.37, 2e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_default),
        cmocka_unit_test(test_check_refuses),
        cmocka_unit_test(test_named_values),
        cmocka_unit_test(test_from_long_term),
        cmocka_unit_test(test_from_long_term_lists),
        cmocka_unit_test(test_from_long_term_refuses),
        cmocka_unit_test(test_units_of_laws),
        cmocka_unit_test(test_moduli),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
