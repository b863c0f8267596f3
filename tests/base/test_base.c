// Foundations: error text, parameter tables, histories, records, special functions.
// SPDX-License-Identifier: Apache-2.0
#include "check.h"

static void error_text_is_kept_and_prefixed(void **state) {
    (void)state;
    assert_int_equal(sn_fail(SN_E_UNIT, "found \"%s\"", "kpa"), SN_E_UNIT);
    assert_string_equal(sn_error_text(), "found \"kpa\"");
    assert_int_equal(sn_fail_within(SN_E_UNIT, "%s:%d", "a.yaml", 7), SN_E_UNIT);
    assert_string_equal(sn_error_text(), "a.yaml:7: found \"kpa\"");
    for (int s = 0; s < SN_STATUS_COUNT; s++) assert_true(strlen(sn_status_text((sn_status)s)) > 3);
}

static void long_text_is_cut_not_overrun(void **state) {
    (void)state;
    char longer[4096];
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = 0;
    sn_fail(SN_E_DATA, "%s", longer);
    sn_fail_within(SN_E_DATA, "%s", longer);
    assert_true(strlen(sn_error_text()) < sizeof longer);
}

static int releases, failing_after;
static void *counting_resize(void *context, void *block, size_t bytes) {
    (void)context;
    return failing_after-- > 0 ? realloc(block, bytes) : NULL;
}
static void counting_release(void *context, void *block) {
    (void)context;
    releases++;
    free(block);
}

static void allocation_overflow_and_shortage_are_reported(void **state) {
    (void)state;
    assert_null(sn_alloc(SIZE_MAX / 2, 16));
    assert_non_null(strstr(sn_error_text(), "out of memory"));
    sn_set_allocator(&(sn_allocator){counting_resize, counting_release, NULL});
    // every allocation of a record in turn fails; nothing leaks (sanitizers), nothing crashes
    for (int n = 0; n < 6; n++) {
        failing_after = n;
        sn_record *record = NULL;
        if (sn_record_create("r", &record) == SN_OK &&
            sn_record_add_series(record, "time", "s") == SN_OK &&
            sn_record_add_note(record, "area", "4 mm2", 4e-6) == SN_OK)
            sn_record_append(record, &(double){1.5});
        sn_record_destroy(record);
    }
    failing_after = 0;
    sn_history *history = NULL;
    assert_int_equal(sn_history_create(1, 1, &(double){0}, &(double){1}, &history), SN_E_MEMORY);
    sn_set_allocator(NULL);
    assert_true(releases > 0);
}

static const sn_param table[] = {
    {.name = "modulus",
     .symbol = "E",
     .unit = "Pa",
     .min = 0,
     .max = INFINITY,
     .min_open = true,
     .init = NAN,
     .log_scale = true,
     .text = "modulus"},
    {.name = "weights",
     .symbol = "g",
     .unit = "1",
     .min = 0,
     .max = 1,
     .init = 0.25,
     .length = SN_PARAM_LIST,
     .text = "weights"},
    {.name = "shear",
     .symbol = "s",
     .unit = "1",
     .min = -2,
     .max = 3,
     .max_open = true,
     .init = 1,
     .length = 3,
     .text = "three"},
    {.name = "bulk",
     .symbol = "K",
     .unit = "Pa",
     .min = 0,
     .max = INFINITY,
     .init = 2,
     .infinity = "incompressible",
     .text = "bulk"},
};

static void parameter_tables(void **state) {
    (void)state;
    assert_int_equal(sn_param_offset(table, 3, 5), 1 + 5 + 3);
    assert_int_equal(sn_param_find(table, 4, "shear"), 2);
    assert_int_equal(sn_param_find(table, 4, "shears"), -1);
    double v[16];
    sn_param_defaults(table, 4, 2, v);
    CHECK_FAILS(sn_param_check(table, 4, 2, v, "law x"), SN_E_RANGE, "law x: modulus is missing");
    v[0] = 3.7;
    CHECK_OK(sn_param_check(table, 4, 2, v, "law x"));
    v[6] = INFINITY; // the bulk modulus has a word for it
    CHECK_OK(sn_param_check(table, 4, 2, v, "law x"));
    v[0] = 0;
    CHECK_FAILS(sn_param_check(table, 4, 2, v, "law x"), SN_E_RANGE, "more than 0 Pa");
    v[0] = INFINITY;
    CHECK_FAILS(sn_param_check(table, 4, 2, v, "law x"), SN_E_RANGE, "modulus");
    v[0] = 1;
    v[5] = 3;
    CHECK_FAILS(sn_param_check(table, 4, 2, v, "law x"), SN_E_RANGE, "less than 3");
}

static void suggestions(void **state) {
    (void)state;
    static const char *const names[] = {"supports", "loads", "tissue", "gravity", "tools"};
    assert_string_equal(sn_suggest("suports", names, 5), "supports");
    assert_string_equal(sn_suggest("gravtiy", names, 5), "gravity");
    assert_string_equal(sn_suggest("tool", names, 5), "tools");
    assert_null(sn_suggest("velocity", names, 5));
    assert_null(sn_suggest("", names, 0));
}

static void histories(void **state) {
    (void)state;
    const double time[] = {0.5, 1.25, 4}, value[] = {2, -1, 5, 3, 8, 3.5};
    sn_history *h;
    CHECK_OK(sn_history_create(2, 3, time, value, &h));
    double v[2];
    sn_history_at(h, 0.75, v);
    double first[2] = {v[0], v[1]}, again[2];
    CHECK_ABS(v[0], 3.0, 1e-15); // a third of the way
    CHECK_ABS(v[1], 1.0 / 3, 1e-15);
    sn_history_at(h, -1, v);
    assert_true(v[0] == 2 && v[1] == -1);
    sn_history_at(h, 1.25, v);
    assert_true(v[0] == 5 && v[1] == 3);
    sn_history_at(h, 9, v);
    assert_true(v[0] == 8 && v[1] == 3.5);
    assert_true(sn_history_next(h, 0.5) == 1.25);
    assert_true(sn_history_next(h, 0.1) == 0.5);
    assert_true(isinf(sn_history_next(h, 4)));
    sn_history *copy;
    CHECK_OK(sn_history_copy(h, &copy));
    sn_history_destroy(h);
    sn_history_at(copy, 0.75, again);
    assert_memory_equal(again, first, sizeof first);
    sn_history_destroy(copy);
    CHECK_OK(sn_history_copy(NULL, &copy));
    assert_null(copy);
    CHECK_FAILS(sn_history_create(1, 2, (double[]){1, 1}, value, &h), SN_E_DATA, "must rise");
    CHECK_FAILS(sn_history_create(1, 2, time, (double[]){1, NAN}, &h), SN_E_DATA, "finite");
    CHECK_FAILS(sn_history_create(1, 0, time, value, &h), SN_E_DATA, "knot");
    sn_history_at(NULL, 3, v);
    assert_true(v[0] == 1);
}

static void records(void **state) {
    (void)state;
    sn_record *r;
    CHECK_OK(sn_record_create("curve.csv", &r));
    CHECK_OK(sn_record_add_series(r, "time", "s"));
    CHECK_OK(sn_record_add_series(r, "stress", "Pa"));
    for (int i = 0; i < 200; i++) CHECK_OK(sn_record_append(r, (double[]){0.1 * i, 3.0 * i * i}));
    CHECK_OK(sn_record_add_series(r, "late", "1"));
    assert_true(r->rows == 200 && sn_record_values(r, "late")[199] == 0);
    assert_true(sn_record_values(r, "stress")[150] == 3.0 * 150 * 150);
    assert_null(sn_record_values(r, "strain"));
    CHECK_OK(sn_record_add_note(r, "area", "4.2 mm2", 4.2e-6));
    assert_true(sn_record_note(r, "area")->value == 4.2e-6);
    assert_null(sn_record_note(r, "gauge_length"));
    sn_record_destroy(r);
}

// independent path: composite Gauss-Legendre quadrature of exp(-x u)/u over u = 1 … infinity, in
// u = exp(s)
static double e1_by_quadrature(double x) {
    static const double node[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                  0.8611363115940526};
    static const double weight[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                    0.3478548451374538};
    double end = log(1 + 745 / x), sum = 0;
    int pieces = 4000;
    for (int i = 0; i < pieces; i++)
        for (int k = 0; k < 4; k++) {
            double s = end * (i + 0.5 + 0.5 * node[k]) / pieces;
            sum += weight[k] * exp(-x * exp(s));
        }
    return 0.5 * end / pieces * sum;
}

static void exponential_integral(void **state) {
    (void)state;
    // Abramowitz & Stegun, table 5.1, with the digits beyond it from the series in 30 digits
    CHECK_REL(sn_expint_e1(0.5), 0.55977359477616081, 4e-15);
    CHECK_REL(sn_expint_e1(1.0), 0.21938393439552027, 4e-15);
    CHECK_REL(sn_expint_e1(2.0), 0.04890051070806112, 4e-15);
    // the quadrature is good to about 1e-13: order 8 in steps of end/4000, 1e-16 rounding of sums
    for (double x = 1e-6; x < 600; x *= 1.731)
        CHECK_REL(sn_expint_e1(x), e1_by_quadrature(x), 3e-13);
    assert_true(isinf(sn_expint_e1(0)) && isnan(sn_expint_e1(-1)) && sn_expint_e1(800) == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_text_is_kept_and_prefixed),
        cmocka_unit_test(long_text_is_cut_not_overrun),
        cmocka_unit_test(allocation_overflow_and_shortage_are_reported),
        cmocka_unit_test(parameter_tables),
        cmocka_unit_test(suggestions),
        cmocka_unit_test(histories),
        cmocka_unit_test(records),
        cmocka_unit_test(exponential_integral),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
