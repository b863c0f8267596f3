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
        for (int i = 0; i < count; ++i)
            assert_true(sn_protocol_get(&p, params[i].name) == value[i]);
        assert_true(isnan(sn_protocol_get(&p, "xyzzy")));
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

// a preconditioned record is the end of the record of all cycles, to the last bit of its motion and
// to the machine's 1e-7 in its stress; the peaks settle towards one value
static void preconditioning_is_the_cycles_before(void **state) {
    (void)state;
    double v[] = {9.1, 1.3e4}, prony[] = {0.2, 0.3, 0.4, 6.0};
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    tissue.memory = oracle_memory("prony", 2, prony, 4);
    for (int k = 0; k < 4; ++k) {
        sn_protocol p = sn_protocol_default(SN_PROTOCOL_CYCLIC);
        sn_record *all, *late;
        p.wave = k % 2 ? SN_WAVE_SINE : SN_WAVE_TRIANGLE;
        p.lower = k < 2 ? 1.0 : 1.04;
        p.stretch = 1.13;
        p.ramp = 0.7;
        p.cycles = 8;
        p.points = 161;
        CHECK_OK(sn_lab_test(&tissue, &p, &all));
        assert_null(sn_record_note(all, "preconditioning"));
        p.precondition = 5;
        p.cycles = 3;
        p.points = 61;
        CHECK_OK(sn_lab_test(&tissue, &p, &late));
        assert_non_null(strstr(sn_record_note(late, "preconditioning")->text, "5 cycles"));
        double approach = k < 2 ? 0.0 : 0.7 * 0.04 / 0.09, peak = 0.0, before = (double)INFINITY;
        CHECK_REL(sn_record_values(late, "time")[0], approach + 7.0, 1e-14);
        CHECK_REL(sn_record_values(all, "time")[160], approach + 11.2, 1e-14);
        static const char *const names[] = {"time", "stretch", "cycle", "stress"};
        for (int i = 0; i < 61; ++i)
            for (int c = 0; c < 4; ++c) {
                if (i == 0 && c == 2)
                    continue; // the first row ends cycle 5 in one, starts 6 in the other
                double tolerance = c == 3 ? 2e-7 * 1.3e4 * 0.13 * 2.0 : 1e-14 * (c ? 10.0 : 12.0);
                CHECK_ABS(sn_record_values(late, names[c])[i],
                          sn_record_values(all, names[c])[100 + i], tolerance);
            }
        for (int i = 0; i < 8; ++i) { // turns at the target, and at the lower stretch
            peak = sn_record_values(all, "stress")[20 * i + 10];
            assert_true(sn_record_values(all, "stretch")[20 * i + 10] == 1.13);
            assert_true(sn_record_values(all, "stretch")[20 * i] == p.lower);
            assert_true(peak < before && peak > 0.5 * v[1] / v[0] * expm1(v[0] * 0.13));
            before = peak;
        }
        assert_true(sn_record_values(all, "stress")[0] == 0.0 || k >= 2);
        sn_record_destroy(all);
        sn_record_destroy(late);
    }
}

static double exponential_slope(double stretch, const double *v) {
    return v[1] * exp(v[0] * (stretch - 1.0)); // equation (14)
}

// knots written down by hand: 1 -> 1.05 at the speed of the legs, then 1.05 -> 1.11 -> 1.05 …
static void preconditioned_cycles_follow_quadrature(void **state) {
    (void)state;
    double v[] = {11.0, 7e3}, spectrum[] = {0.2, 0.05, 20.0};
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    tissue.memory = oracle_memory("fung-spectrum", 0, spectrum, 3);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_CYCLIC);
    p.lower = 1.05;
    p.stretch = 1.11;
    p.ramp = 0.0;
    p.rate = 0.03; // 2 s a way
    p.precondition = 2;
    p.cycles = 2;
    p.points = 41;
    double knots[10], value[10];
    knots[0] = 0.0, value[0] = 1.0;
    for (int i = 0; i < 9; ++i) {
        knots[i + 1] = 0.05 / 0.03 + 2.0 * i;
        value[i + 1] = i % 2 ? 1.11 : 1.05;
    }
    sn_history *h;
    sn_record *record;
    CHECK_OK(sn_history_create(1, 10, knots, value, &h));
    CHECK_OK(sn_lab_test(&tissue, &p, &record));
    const double *time = sn_record_values(record, "time"), *T = sn_record_values(record, "stress");
    for (int i = 0; i < 41; ++i) {
        CHECK_REL(time[i], 0.05 / 0.03 + 8.0 + 0.2 * i, 1e-13);
        CHECK_ABS(T[i], oracle_hereditary(h, &tissue.memory, time[i], exponential_slope, v),
                  1e-7 * T[10]);
    }
    sn_history_destroy(h);
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
    p.lower = p.stretch;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "stretch is 1.1, nothing would");
    p.lower = 1.0;
    p.precondition = -1;
    CHECK_FAILS(sn_protocol_history(&p, &h, &time), SN_E_RANGE, "precondition");
    p.precondition = 0;
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
        cmocka_unit_test(preconditioning_is_the_cycles_before),
        cmocka_unit_test(preconditioned_cycles_follow_quadrature),
        cmocka_unit_test(tensile_pulls_at_its_rate),
        cmocka_unit_test(refusals_say_what),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
