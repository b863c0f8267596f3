// Finding laws, their tables, and what is refused.
// SPDX-License-Identifier: Apache-2.0
#include "points.h"

static void test_find(void **state) {
    (void)state;
    assert_true(sn_law_count() >= 14);
    for (int i = 0; i < sn_law_count(); i++) {
        const sn_law *law = sn_law_at(i);
        assert_ptr_equal(sn_law_find(law->name), law);
        for (int j = 0; j < i; j++) assert_string_not_equal(sn_law_at(j)->name, law->name);
    }
    assert_null(sn_law_find("neo-hokean"));
    assert_non_null(strstr(sn_error_text(), "neo-hokean"));
    assert_non_null(strstr(sn_error_text(), "did you mean \"neo-hookean\""));
    assert_null(sn_law_find("quite something else"));
    assert_non_null(strstr(sn_error_text(), "guccione"));
    assert_null(sn_law_find(""));
}

static void test_tables(void **state) {
    (void)state;
    for (int i = 0; i < sn_law_count(); i++) {
        const sn_law *law = sn_law_at(i);
        assert_true(law->text && strlen(law->text) > 10 && law->source && *law->source);
        assert_true(law->moduli && law->kernels && law->param_count > 0);
        assert_true(law->kind != SN_LAW_UNIAXIAL || !law->fibres);
        for (int k = 0; k < law->param_count; k++) {
            const sn_param *p = &law->params[k];
            assert_true(p->name && *p->name && p->symbol && *p->symbol);
            assert_true(p->text && p->text[strlen(p->text) - 1] == '.');
            assert_true(strcmp(p->unit, "Pa") == 0 || strcmp(p->unit, "1") == 0 ||
                        strcmp(p->unit, "rad") == 0);
            assert_true(p->min < p->max);
            assert_true(isnan(p->init) || (p->init >= p->min && p->init <= p->max));
            assert_true(!p->log_scale || p->min > 0 || p->min_open);
            assert_int_equal(sn_param_find(law->params, law->param_count, p->name), k);
            assert_true(!strcmp(p->name, "bulk_modulus") == (p->infinity != NULL));
        }
    }
}

/// One constant below, at and above its range, and missing.
static void check_constant(const sn_law *law, const sn_param *p, const double *good, int at) {
    const int terms = law_terms(law);
    double bad[POINTS_VALUES_MAX];
    memcpy(bad, good, sizeof bad);
    bad[at] = (double)NAN;
    CHECK_FAILS(sn_law_check(law, bad, terms), SN_E_RANGE, p->name);
    assert_non_null(strstr(sn_error_text(), law->name));
    bad[at] = p->min - 1;
    CHECK_FAILS(sn_law_check(law, bad, terms), SN_E_RANGE, p->name);
    bad[at] = -(double)INFINITY;
    CHECK_FAILS(sn_law_check(law, bad, terms), SN_E_RANGE, p->name);
    // at the ends the law's own condition may refuse: the table alone is asked
#define TABLE_CHECK() sn_param_check(law->params, law->param_count, terms, bad, "law")
    bad[at] = p->min;
    assert_int_equal(TABLE_CHECK(), p->min_open ? SN_E_RANGE : SN_OK);
    bad[at] = (double)INFINITY;
    assert_int_equal(TABLE_CHECK(), p->infinity ? SN_OK : SN_E_RANGE);
    if (isinf(p->max)) return;
    bad[at] = p->max;
    assert_int_equal(TABLE_CHECK(), p->max_open ? SN_E_RANGE : SN_OK);
#undef TABLE_CHECK
    bad[at] = p->max * 1.01;
    CHECK_FAILS(sn_law_check(law, bad, terms), SN_E_RANGE, p->name);
}

static void test_ranges(void **state) {
    (void)state;
    uint64_t seed = 301;
    for (int i = 0; i < sn_law_count(); i++) {
        const sn_law *law = sn_law_at(i);
        double good[POINTS_VALUES_MAX] = {0};
        random_values(law, &seed, good);
        for (int k = 0, at = 0; k < law->param_count; k++)
            for (int j = 0; j < sn_param_length(&law->params[k], law_terms(law)); j++, at++)
                check_constant(law, &law->params[k], good, at);
    }
}

static sn_status refuse(const double *value, int terms) {
    (void)terms;
    return value[0] > 1 ? sn_fail(SN_E_RANGE, "not convex") : SN_OK;
}

/// A law's own condition comes after the ranges.
static void test_own_check(void **state) {
    (void)state;
    sn_law law = *sn_law_find("linear");
    law.check = refuse;
    CHECK_OK(sn_law_check(&law, (double[]){0.5}, 0));
    CHECK_FAILS(sn_law_check(&law, (double[]){2}, 0), SN_E_RANGE, "not convex");
    CHECK_FAILS(sn_law_check(&law, (double[]){-2}, 0), SN_E_RANGE, "modulus");
}

static void test_volume_stress(void **state) {
    (void)state;
    // the derivative of K/2 (J - 1)^2
    CHECK_REL(sn_volume_stress(2e5, 1.03), 6e3, 1e-14);
    assert_true(sn_volume_stress(1, 0.9) < 0);
}

static void test_instruction_set(void **state) {
    (void)state;
    const char *forced = getenv("SINEW_ISA");
    assert_non_null(sn_isa_name());
    if (forced && strcmp(forced, "scalar") == 0) assert_string_equal(sn_isa_name(), "scalar");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_find),          cmocka_unit_test(test_tables),
        cmocka_unit_test(test_ranges),        cmocka_unit_test(test_own_check),
        cmocka_unit_test(test_volume_stress), cmocka_unit_test(test_instruction_set),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
