// Protocols: tables, histories, recorded times, records.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

static void tables_and_names_agree(void **state) {
    (void)state;
    for (int k = 0; k < sn_protocol_count(); ++k) {
        sn_protocol_kind kind;
        int count;
        assert_true(sn_protocol_find(sn_protocol_name((sn_protocol_kind)k), &kind));
        assert_int_equal((int)kind, k);
        const sn_param *params = sn_protocol_params(kind, &count);
        double value[SN_PROTOCOL_PARAMS_MAX];
        sn_param_defaults(params, count, 0, value);
        CHECK_OK(sn_param_check(params, count, 0, value, "protocol"));
        sn_protocol p = sn_protocol_default(kind);
        int stretch = sn_param_find(params, count, "stretch");
        if (stretch >= 0) CHECK_REL(p.stretch, value[stretch], 0.0);
        assert_int_equal(p.points, (int)value[sn_param_find(params, count, "points")]);
        for (int i = 0; i < count; ++i) assert_true(strlen(params[i].text) > 10);
    }
    sn_protocol_kind kind;
    assert_false(sn_protocol_find("tensil", &kind));
    assert_non_null(strstr(sn_error_text(), "did you mean \"tensile\""));
    assert_false(sn_protocol_find("xyzzy", &kind));
    assert_non_null(strstr(sn_error_text(), "expected tensile, cyclic, relaxation"));
}

static void check_rising(int n, const double *time) {
    for (int i = 1; i < n; ++i) assert_true(time[i] > time[i - 1]);
}

static void relaxation_records_ramp_and_hold(void **state) {
    (void)state;
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_RELAXATION);
    const double ramps[] = {0.0507, 3.1, 9.7};
    const int points[] = {3, 5, 60, 91};
    for (int k = 0; k < 12; ++k) {
        p.stretch = 1.137;
        p.ramp = ramps[k % 3];
        p.hold = 3.3;
        p.points = points[k / 3];
        sn_history *h;
        double *time, at;
        CHECK_OK(sn_protocol_history(&p, &h, &time));
        check_rising(p.points, time);
        assert_true(time[0] == 0.0 && time[p.points / 3] == p.ramp);
        assert_true(time[p.points - 1] == p.ramp + p.hold);
        sn_history_at(h, 0.5 * p.ramp, &at);
        CHECK_REL(at, 1.0 + 0.5 * 0.137, 1e-14);
        sn_history_at(h, p.ramp, &at);
        assert_true(at == 1.137);
        sn_history_at(h, p.ramp + p.hold, &at);
        assert_true(at == 1.137);
        sn_history_destroy(h);
        sn_free(time);
    }
}

static void cyclic_rows_hit_every_corner(void **state) {
    (void)state;
    double v[] = {9.1, 1.3e4};
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_CYCLIC);
    p.stretch = 0.93; // pushed
    p.ramp = 0.0;
    p.rate = 0.07;
    p.cycles = 3;
    p.points = 50;
    sn_record *record;
    CHECK_OK(sn_lab_test(&tissue, &p, &record));
    assert_int_equal(record->rows, 50);
    const double *time = sn_record_values(record, "time"), *l = sn_record_values(record, "stretch");
    const double *cycle = sn_record_values(record, "cycle");
    const double *stress = sn_record_values(record, "stress");
    check_rising(50, time);
    CHECK_REL(time[49], 6.0, 1e-14);
    int corners = 0;
    for (int i = 1; i < 50; ++i) {
        corners += l[i] == 0.93;
        assert_true(cycle[i] >= cycle[i - 1] && cycle[i] <= 3.0);
        CHECK_ABS(stress[i], v[1] / v[0] * expm1(v[0] * (l[i] - 1.0)), 1e-10 * v[1]);
        if (time[i] < 1.999) assert_true(cycle[i] == 1.0);
        if (time[i] > 2.001 && time[i] < 3.999) assert_true(cycle[i] == 2.0);
    }
    assert_int_equal(corners, 3);
    assert_true(cycle[49] == 3.0);
    sn_record_destroy(record);
}

static void tensile_pulls_at_its_rate(void **state) {
    (void)state;
    double modulus = 3.3e5;
    sn_tissue tissue = oracle_tissue("linear", &modulus, 1);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_TENSILE);
    p.stretch = 1.25;
    p.points = 11;
    sn_record *record;
    CHECK_OK(sn_lab_test(&tissue, &p, &record));
    assert_int_equal(sn_record_find(record, "cycle"), -1);
    const double *time = sn_record_values(record, "time");
    const double *stress = sn_record_values(record, "stress");
    CHECK_REL(time[10], 25.0, 1e-14); // 0.25 at the default 0.01 1/s
    for (int i = 0; i <= 10; ++i) CHECK_ABS(stress[i], modulus * 0.025 * i, 1e-9 * modulus);
    sn_record_destroy(record);
}

static void refusals_say_what(void **state) {
    (void)state;
    sn_history *h;
    double *time;
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_TENSILE);
    p.stretch = 1.0;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "nothing would move");
    p.stretch = -0.5;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "stretch");
    p = sn_protocol_default(SN_PROTOCOL_TENSILE);
    p.rate = 0.0;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "ramp and rate are both 0");
    p.rate = 1e-320;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "no usable time");
    p = sn_protocol_default(SN_PROTOCOL_CYCLIC);
    p.points = 6;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "expected at least 13");
    p.cycles = 0;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "cycles");
    p = sn_protocol_default(SN_PROTOCOL_RELAXATION);
    p.hold = -1.0;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "hold");
    assert_null(h);
    assert_null(time);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_and_names_agree),
        cmocka_unit_test(relaxation_records_ramp_and_hold),
        cmocka_unit_test(cyclic_rows_hit_every_corner),
        cmocka_unit_test(tensile_pulls_at_its_rate),
        cmocka_unit_test(refusals_say_what),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
