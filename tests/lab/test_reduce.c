// Reduction of curves with known answers.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 1001 };

static sn_record *record_of(int columns, const char *const *names, int rows,
                            const double *const *values) {
    sn_record *record;
    CHECK_OK(sn_record_create("specimen.csv", &record));
    for (int c = 0; c < columns; ++c) CHECK_OK(sn_record_add_series(record, names[c], "1"));
    for (int i = 0; i < rows; ++i) {
        double row[4];
        for (int c = 0; c < columns; ++c) row[c] = values[c][i];
        CHECK_OK(sn_record_append(record, row));
    }
    return record;
}

//---- columns -------------------------------------------------------------------------------------

static void every_column_becomes_stretch_and_nominal_stress(void **state) {
    (void)state;
    const double gauge = 0.0213, area = 3.7e-6;
    double time[5], column[9][5], stretch[5], nominal[5];
    for (int i = 0; i < 5; ++i) {
        double l = 1.0 + 0.031 * i, T = 2.3e4 * i + 17.0;
        time[i] = 0.7 * i;
        stretch[i] = l;
        nominal[i] = T;
        column[0][i] = l;
        column[1][i] = l - 1.0;
        column[2][i] = 0.5 * (l * l - 1.0);
        column[3][i] = l * gauge;
        column[4][i] = (l - 1.0) * gauge;
        column[5][i] = T;
        column[6][i] = T * area;
        column[7][i] = T * l; // Cauchy
        column[8][i] = T / l; // second Piola-Kirchhoff
    }
    const char *const lengths[] = {"stretch", "strain", "green_strain", "length", "extension"};
    const char *const loads[] = {"stress", "force", "true_stress", "pk2_stress"};
    for (int k = 0; k < 20; ++k) {
        const char *const names[] = {"time", lengths[k / 4], loads[k % 4]};
        const double *const values[] = {time, column[k / 4], column[5 + k % 4]};
        sn_record *record = record_of(3, names, 5, values);
        CHECK_OK(sn_record_add_note(record, "gauge_length", "21.3 mm", gauge));
        CHECK_OK(sn_record_add_note(record, "area", "3.7 mm2", area));
        sn_curve curve;
        CHECK_OK(sn_curve_from_record(record, &curve));
        assert_int_equal(curve.count, 5);
        assert_string_equal(curve.name, "specimen.csv");
        assert_true((k / 4 == 0 && k % 4 == 0) == (curve.remarks[0] == 0));
        for (int i = 0; i < 5; ++i) { // a few roundings
            CHECK_REL(curve.stretch[i], stretch[i], 1e-14);
            CHECK_REL(curve.stress[i], nominal[i], 1e-14);
            assert_true(curve.time[i] == time[i]);
        }
        sn_curve_release(&curve);
        sn_record_destroy(record);
    }
}

static void check_refused(const char *length, const char *load, int rows, const double *time,
                          const double *l, const double *f, const char *part) {
    const char *const names[] = {"time", length, load};
    const double *const values[] = {time, l, f};
    sn_record *record = record_of(3, names, rows, values);
    sn_curve curve;
    CHECK_FAILS(sn_curve_from_record(record, &curve), SN_E_DATA, part);
    assert_non_null(strstr(sn_error_text(), "specimen.csv"));
    assert_null(curve.stretch);
    sn_record_destroy(record);
}

static void bad_records_are_refused(void **state) {
    (void)state;
    const double t[] = {0.0, 1.0, 2.0, 3.0}, back[] = {0.0, 1.0, 0.5, 3.0};
    const double l[] = {1.0, 1.1, 1.2, 1.3}, f[] = {0.0, 1.0, 2.0, 3.0};
    const double nan[] = {0.0, 1.0, (double)NAN, 3.0}, zero[] = {1.0, 0.0, 1.2, 1.3};
    check_refused("stretch", "stress", 4, back, l, f, "row 3: time goes back from 1 s to 0.5 s");
    check_refused("stretch", "stress", 4, nan, l, f, "row 3: time is");
    check_refused("stretch", "stress", 4, t, nan, f, "row 1: stretch is 0");
    check_refused("stretch", "stress", 4, t, zero, f, "row 2: stretch is 0");
    check_refused("stretch", "stress", 4, t, l, nan, "row 3: stress is");
    check_refused("stretch", "stress", 2, t, l, f, "2 usable rows: expected at least 3");
    check_refused("extension", "stress", 4, t, f, f, "gauge_length");
    check_refused("stretch", "force", 4, t, l, f, "\"# area: ...\"");
    check_refused("strech", "stress", 4, t, l, f, "no column for the stretch");
    check_refused("stretch", "stres", 4, t, l, f, "no column for the stress");
    const double twice[] = {0.0, 1.0, 1.0, 3.0};
    const char *const names[] = {"time", "stretch", "stress"};
    const double *const values[] = {twice, l, f};
    sn_record *record = record_of(3, names, 4, values);
    sn_curve curve;
    CHECK_OK(sn_curve_from_record(record, &curve));
    assert_int_equal(curve.count, 3);
    assert_int_equal(curve.discarded, 1);
    assert_non_null(strstr(curve.remarks, "1 row(s) at the time"));
    sn_curve_release(&curve);
    sn_record_destroy(record);
}

//---- tensile -------------------------------------------------------------------------------------

// The offset yield of a bilinear curve is sp + Ep o/(1 - Ep/E) exactly; 5e-3 is what the modulus
// may be off by (a part of a row beyond the bend), and the yield follows it.
static void bilinear_curve_has_its_yield(void **state) {
    (void)state;
    uint64_t seed = 31;
    for (int k = 0; k < 40; ++k) {
        double E = check_random(&seed, 50e6, 200e6), Ep = check_random(&seed, 1e6, 8e6);
        double sp = check_random(&seed, 1e6, 4e6), stretch[ROWS], stress[ROWS], area = 0.0;
        for (int i = 0; i < ROWS; ++i) {
            double e = 2e-4 * i;
            stretch[i] = 1.0 + e;
            stress[i] = E * e < sp ? E * e : sp + Ep * (e - sp / E);
            if (i) area += 1e-4 * (stress[i] + stress[i - 1]);
        }
        sn_curve curve = oracle_curve("bilinear", ROWS, NULL, stretch, stress);
        sn_tensile out;
        CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
        CHECK_REL(out.youngs_modulus, E, 3e-3);
        CHECK_REL(out.toe_modulus, E, 1.0); // the first tenth may hold the bend: just a number
        CHECK_REL(out.yield_stress, sp + Ep * 0.002 / (1.0 - Ep / E), 1e-3);
        CHECK_REL(out.ultimate_tensile_strength, stress[ROWS - 1], 1e-15);
        CHECK_REL(out.strain_at_ultimate, 0.2, 1e-12);
        CHECK_REL(out.work_to_failure, area, 1e-12);
        assert_non_null(strstr(out.modulus_method, "initial straight part"));
        sn_tensile_release(&out);
        sn_curve_release(&curve);
    }
}

static void exponential_curve_has_no_yield(void **state) {
    (void)state;
    uint64_t seed = 32;
    for (int k = 0; k < 40; ++k) {
        double B = check_random(&seed, 3.0, 40.0), C = check_random(&seed, 2e3, 4e4);
        double stretch[ROWS], stress[ROWS];
        int rows = k % 2 ? ROWS : 41; // sparse as well
        double step = 0.2 / (rows - 1);
        for (int i = 0; i < rows; ++i) {
            stretch[i] = 1.0 + step * i;
            stress[i] = C / B * expm1(B * step * i);
        }
        sn_curve curve = oracle_curve("exponential", rows, NULL, stretch, stress);
        sn_tensile out;
        CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
        assert_true(isnan(out.yield_stress) && isnan(out.yield_strain));
        assert_non_null(strstr(out.reason, "no intersection"));
        assert_non_null(strstr(out.modulus_method, "J-shaped"));
        // slopes over the window: half the span d gives a factor near 1 + (B d)^2/6
        double d = step * (rows / 200 > 1 ? rows / 200 : 1);
        CHECK_REL(out.B, B, 1e-4 + B * B * d * d);
        CHECK_REL(out.C, C, 1e-4 + 2.0 * B * B * d * d);
        CHECK_ABS(out.slope_r_squared, 1.0, 1e-3);
        assert_true(out.toe_modulus > C && out.toe_modulus < C * exp(B * 0.025));
        assert_true(out.youngs_modulus > C * exp(B * 0.175) &&
                    out.youngs_modulus < C * exp(B * 0.2));
        sn_tensile_release(&out);
        sn_curve_release(&curve);
    }
}

// toe, linear region of slope E, yield to slope Ep, failure to nothing: offset from the line's zero
static void s_shaped_curve_yields_after_its_toe(void **state) {
    (void)state;
    const double E = 3.1e7, Ep = 2.2e6, toe = 0.03, bend = 0.09;
    double stretch[ROWS], stress[ROWS], zero = 0.5 * toe, limit = E * (bend - zero);
    for (int i = 0; i < ROWS; ++i) {
        double e = 2e-4 * i;
        stretch[i] = 1.0 + e;
        stress[i] = e < toe    ? 0.5 * E * e * e / toe
                    : e < bend ? E * (e - zero)
                    : e < 0.18 ? limit + Ep * (e - bend)
                               : 0.01 * limit;
    }
    sn_curve curve = oracle_curve("tendon", ROWS, NULL, stretch, stress);
    sn_tensile out;
    CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
    CHECK_REL(out.youngs_modulus, E, 1e-3);
    CHECK_REL(out.yield_stress, limit + Ep * 0.002 / (1.0 - Ep / E), 1e-3);
    CHECK_ABS(out.strain_at_ultimate, 0.18, 2.1e-4);
    double whole = 0.5 * E * toe * toe / 3.0 + 0.5 * (0.5 * E * toe + limit) * (bend - toe) +
                   limit * 0.09 + 0.5 * Ep * 0.09 * 0.09;
    CHECK_REL(out.work_to_failure, whole, 2e-3); // a row at the failure
    sn_tensile_release(&out);
    sn_curve_release(&curve);
}

static void unusable_pulls_are_refused(void **state) {
    (void)state;
    const double same[] = {1.1, 1.1, 1.1, 1.1, 1.1, 1.1}, up[] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
    const double l[] = {1.0, 1.1, 1.2, 1.3, 1.4, 1.5}, down[] = {5.0, 4.0, 3.0, 2.0, 1.0, 0.0};
    sn_tensile out;
    sn_cycles cycles;
    sn_relaxation_result relaxation;
    sn_curve curve = oracle_curve("still", 6, up, same, up);
    CHECK_FAILS(sn_reduce_tensile(&curve, NULL, &out), SN_E_DATA, "still: the stretch is 1.1");
    CHECK_FAILS(sn_reduce_cyclic(&curve, &cycles), SN_E_DATA, "still: the stretch is 1.1");
    CHECK_FAILS(sn_reduce_relaxation(&curve, &relaxation), SN_E_DATA, "needs a ramp");
    sn_curve_release(&curve);
    curve = oracle_curve("falling", 6, up, l, down);
    CHECK_FAILS(sn_reduce_tensile(&curve, NULL, &out), SN_E_DATA, "largest stress at row 1");
    CHECK_FAILS(sn_reduce_cyclic(&curve, &cycles), SN_E_DATA, "no full cycle");
    CHECK_FAILS(sn_reduce_relaxation(&curve, &relaxation), SN_E_DATA,
                "falling: no ramp with a hold");
    sn_curve_release(&curve);
    curve = oracle_curve("timeless", 6, NULL, l, up);
    CHECK_FAILS(sn_reduce_relaxation(&curve, &relaxation), SN_E_DATA, "no time column");
    sn_curve_release(&curve);
}

//---- cyclic and relaxation -----------------------------------------------------------------------

// linear spring with dry friction f: loading area k e2/2 + f e, loop 2 f e; jitter is no turn
static void cycles_are_split_and_the_last_part_left_out(void **state) {
    (void)state;
    enum { LEG = 200, LEGS = 5 };
    const double k = 3e4, friction = 400.0, top = 0.1;
    double time[LEG * LEGS + 1], stretch[LEG * LEGS + 1], stress[LEG * LEGS + 1];
    uint64_t seed = 3;
    for (int i = 0; i <= LEG * LEGS; ++i) {
        int leg = i / LEG;
        double part = (double)(i % LEG) / LEG;
        double e = top * (leg % 2 ? 1.0 - part : part) + check_random(&seed, 0.0, 1e-4 * top);
        time[i] = i;
        stretch[i] = 1.0 + e;
        stress[i] = k * e + (leg % 2 ? -friction : friction);
    }
    sn_curve curve = oracle_curve("friction", LEG * LEGS - 60, time, stretch, stress);
    sn_cycles cycles;
    CHECK_OK(sn_reduce_cyclic(&curve, &cycles));
    assert_int_equal(cycles.count, 2);
    assert_non_null(strstr(cycles.remarks, "the last cycle is not finished: 139 rows"));
    double loading = 0.5 * k * top * top + friction * top;
    for (int i = 0; i < 2; ++i) { // jitter and the row at the turn: a row in 200
        CHECK_REL(cycles.cycle[i].loading_area, loading, 1e-2);
        CHECK_REL(cycles.cycle[i].loop_area, 2.0 * friction * top, 1e-2);
        CHECK_REL(cycles.cycle[i].hysteresis, 2.0 * friction * top / loading, 1e-2);
        CHECK_REL(cycles.cycle[i].peak_stress, k * top + friction, 2e-2);
        assert_true(abs(cycles.cycle[i].peak - (2 * i + 1) * LEG) <= 1);
    }
    sn_cycles_release(&cycles);
    sn_curve_release(&curve);
}

// stress falls by a straight line in log10(t - t_peak)
static void relaxation_is_measured_from_the_peak(void **state) {
    (void)state;
    enum { N = 60, START = 5, RAMP = 15 };
    double time[N], stretch[N], stress[N];
    for (int i = 0; i < N; ++i) {
        bool held = i > RAMP;
        time[i] = i <= RAMP ? 0.2 * i : 3.0 + 0.01 * pow(10.0, (i - RAMP - 1) / 10.0);
        stretch[i] = i <= START ? 1.0 : held ? 1.24 : 1.0 + 0.024 * (i - START);
        stress[i] = held ? 9e3 * (0.8 - 0.07 * log10(time[i] - 3.0)) : 9e3 / 225.0 * i * i;
    }
    sn_curve curve = oracle_curve("hold", N, time, stretch, stress);
    sn_relaxation_result out;
    CHECK_OK(sn_reduce_relaxation(&curve, &out));
    CHECK_REL(out.ramp_s, 2.0, 1e-12);
    CHECK_REL(out.peak_stress, 9e3, 1e-12);
    CHECK_REL(out.rate_per_decade, 0.07, 1e-10);
    double final = 0.8 - 0.07 * log10(time[N - 1] - 3.0);
    CHECK_REL(out.relaxed_fraction, 1.0 - final, 1e-12);
    CHECK_REL(out.final_stress, 9e3 * final, 1e-12);
    sn_curve_release(&curve);
}

//---- creep ---------------------------------------------------------------------------------------

enum { CREEP_ROWS = 400 };

// Kelvin creep with flow under a held stress: strain = s (J1 (1 - exp(-t/tau)) + J0 + rate t), t
// from the end of the ramp; then it is unloaded, breaks, or ends.
typedef enum creep_end { ENDS, UNLOADED, BREAKS } creep_end;
static void creep_rows(creep_end end, double s, double *time, double *stretch, double *stress) {
    const double ramp = 0.5, hold = 60.0, J0 = 1.1e-5, J1 = 0.7e-5, tau = 4.0, flow = 2.3e-8;
    for (int i = 0; i < CREEP_ROWS; ++i) {
        double t = time[i] = 0.21 * i, under = fmax(0.0, t - ramp);
        double strain = s * (J0 * fmin(1.0, t / ramp) - J1 * expm1(-under / tau) + flow * under);
        stress[i] = s * fmin(1.0, t / ramp);
        if (t > ramp + hold && end != ENDS) {
            double after = t - ramp - hold;
            stress[i] = end == BREAKS ? 0.01 * s : s * fmax(0.0, 1.0 - after / ramp);
            if (end == BREAKS) strain *= 1.4;
            if (end == UNLOADED)
                strain =
                    s * (flow * hold + J0 * fmax(0.0, 1.0 - after / ramp) + J1 * exp(-after / tau));
        }
        stretch[i] = 1.003 + strain; // a preload: counted from the first row
        stress[i] += 17.0;
    }
}

static void creep_has_its_properties(void **state) {
    (void)state;
    double time[CREEP_ROWS], stretch[CREEP_ROWS], stress[CREEP_ROWS];
    for (int k = 0; k < 6; ++k) {
        creep_end end = (creep_end)(k % 3);
        double s = k < 3 ? 3.1e3 : -2.7e3;
        creep_rows(end, s, time, stretch, stress);
        sn_curve curve = oracle_curve("creep", CREEP_ROWS, time, stretch, stress);
        sn_creep_result r;
        CHECK_OK(sn_reduce_creep(&curve, &r));
        double until = end == ENDS ? 0.21 * (CREEP_ROWS - 1) - 0.5 : 60.0;
        CHECK_REL(r.stress, s, 1e-12);
        CHECK_ABS(r.ramp_s, 0.5, 0.21); // a row
        CHECK_ABS(r.hold_s, until, 2 * 0.21);
        CHECK_REL(r.initial_compliance, 1.1e-5, 0.04); // a row of retardation
        double J = 1.1e-5 - 0.7e-5 * expm1(-until / 4.0) + 2.3e-8 * until;
        CHECK_REL(r.compliance, J, 2e-3); // a row of flow
        // the last quarter has the flow and what is left of the retardation, exp(-45/4)
        CHECK_REL(r.creep_rate, s * 2.3e-8, 2e-3);
        assert_true(isfinite(r.time_to_rupture) == (end == BREAKS));
        assert_true(isfinite(r.recovered_fraction) == (end == UNLOADED));
        if (end == BREAKS) CHECK_ABS(r.time_to_rupture, 60.0, 2 * 0.21);
        // after 23 s the retardation has gone but for exp(-23/4) of it
        if (end == UNLOADED) CHECK_REL(r.recovered_fraction, 1.0 - 2.3e-8 * 60.0 / J, 3e-3);
        sn_curve_release(&curve);
    }
}

static void creep_survives_noise(void **state) {
    (void)state;
    double time[CREEP_ROWS], stretch[CREEP_ROWS], stress[CREEP_ROWS];
    uint64_t seed = 8;
    creep_rows(UNLOADED, 3.1e3, time, stretch, stress);
    for (int i = 0; i < CREEP_ROWS; ++i) {
        stretch[i] += 1e-4 * oracle_normal(&seed); // 0.2 % of the strain
        stress[i] += 15.0 * oracle_normal(&seed);  // 0.5 % of the stress
    }
    sn_curve curve = oracle_curve("creep", CREEP_ROWS, time, stretch, stress);
    sn_creep_result r;
    CHECK_OK(sn_reduce_creep(&curve, &r));
    CHECK_REL(r.stress, 3.1e3, 0.02);
    CHECK_REL(r.compliance, 1.1e-5 + 0.7e-5 + 2.3e-8 * 60.0, 0.02);
    CHECK_REL(r.creep_rate, 3.1e3 * 2.3e-8, 0.1); // 71 rows of 1e-4 over 15 s: 3e-6 1/s in 7e-5
    CHECK_REL(r.recovered_fraction, 1.0 - 2.3e-8 * 60.0 / 1.94e-5, 0.02);
    sn_curve_release(&curve);
}

static void creep_refusals(void **state) {
    (void)state;
    double time[CREEP_ROWS], stretch[CREEP_ROWS], stress[CREEP_ROWS];
    sn_creep_result r;
    creep_rows(ENDS, 3.1e3, time, stretch, stress);
    sn_curve curve = oracle_curve("creep.csv", CREEP_ROWS, NULL, stretch, stress);
    CHECK_FAILS(sn_reduce_creep(&curve, &r), SN_E_DATA, "no time column");
    sn_curve_release(&curve);
    curve = oracle_curve("creep.csv", CREEP_ROWS, time, stretch, stress);
    curve.stress[200] *= 0.7;
    CHECK_FAILS(sn_reduce_creep(&curve, &r), SN_E_DATA, "creep.csv: row 201: stress");
    for (int i = 0; i < CREEP_ROWS; ++i) curve.stress[i] = 5.0;
    CHECK_FAILS(sn_reduce_creep(&curve, &r), SN_E_DATA, "needs a load");
    for (int i = 0; i < CREEP_ROWS; ++i) curve.stress[i] = 9.0 * i;
    CHECK_FAILS(sn_reduce_creep(&curve, &r), SN_E_DATA, "creep.csv: row");
    sn_curve_release(&curve);
    curve = oracle_curve("creep.csv", 6, time, stretch, stress);
    CHECK_FAILS(sn_reduce_creep(&curve, &r), SN_E_DATA, "needs a hold of at least 5 rows");
    sn_curve_release(&curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_column_becomes_stretch_and_nominal_stress),
        cmocka_unit_test(bad_records_are_refused),
        cmocka_unit_test(bilinear_curve_has_its_yield),
        cmocka_unit_test(exponential_curve_has_no_yield),
        cmocka_unit_test(s_shaped_curve_yields_after_its_toe),
        cmocka_unit_test(unusable_pulls_are_refused),
        cmocka_unit_test(cycles_are_split_and_the_last_part_left_out),
        cmocka_unit_test(relaxation_is_measured_from_the_peak),
        cmocka_unit_test(creep_has_its_properties),
        cmocka_unit_test(creep_survives_noise),
        cmocka_unit_test(creep_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
