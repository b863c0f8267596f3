// Rows out of order, repeated and missing.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 400 };

// a record whose row k of the file is row order[k] of a smooth curve
static sn_record *shuffled(int rows, const int *order) {
    sn_record *record;
    CHECK_OK(sn_record_create("specimen.csv", &record));
    CHECK_OK(sn_record_add_series(record, "time", "s"));
    CHECK_OK(sn_record_add_series(record, "stretch", "1"));
    CHECK_OK(sn_record_add_series(record, "stress", "Pa"));
    for (int i = 0; i < rows; ++i) {
        double t = 0.1 * order[i], row[] = {t, 1.0 + 0.01 * t, 3e3 * t * t};
        CHECK_OK(sn_record_append(record, row));
    }
    return record;
}

static void move(int *order, int from, int to) {
    int value = order[from];
    for (int i = from; i > to; --i) order[i] = order[i - 1];
    for (int i = from; i < to; ++i) order[i] = order[i + 1];
    order[to] = value;
}

// up to 1 % of the rows, each up to 5 places late, come back bit for bit
static void late_rows_are_put_back(void **state) {
    (void)state;
    uint64_t seed = 5;
    for (int trial = 0; trial < 50; ++trial) {
        int order[ROWS], late = 1 + trial % 4;
        for (int i = 0; i < ROWS; ++i) order[i] = i;
        for (int k = 0; k < late; ++k) {
            int from = 20 + 90 * k + (int)check_random(&seed, 0.0, 60.0);
            move(order, from, from + 1 + (int)check_random(&seed, 0.0, 4.999));
        }
        sn_record *record = shuffled(ROWS, order);
        sn_curve curve;
        CHECK_OK(sn_curve_from_record(record, &curve));
        assert_int_equal(curve.count, ROWS);
        assert_int_equal(curve.discarded, 0);
        char said[64];
        snprintf(said, sizeof said, "%d row(s) out of the order of time put back", late);
        assert_non_null(strstr(curve.remarks, said));
        for (int i = 0; i < ROWS; ++i) {
            double t = 0.1 * i;
            assert_true(curve.time[i] == t && curve.stretch[i] == 1.0 + 0.01 * t &&
                        curve.stress[i] == 3e3 * t * t);
        }
        sn_curve_release(&curve);
        sn_record_destroy(record);
    }
}

static void refused(int rows, const int *order, const char *part) {
    sn_record *record = shuffled(rows, order);
    sn_curve curve;
    CHECK_FAILS(sn_curve_from_record(record, &curve), SN_E_DATA, part);
    assert_null(curve.stretch);
    sn_record_destroy(record);
}

static void other_disorder_is_refused(void **state) {
    (void)state;
    int order[ROWS];
    for (int i = 0; i < ROWS; ++i) order[i] = i % 200; // two records one after the other
    refused(ROWS, order, "specimen.csv: row 201: time goes back from 19.9 s to 0 s");
    for (int i = 0; i < ROWS; ++i) order[i] = i;
    move(order, 100, 106); // six places
    refused(ROWS, order, "row 107: time goes back from 10.6 s to 10 s");
    for (int i = 0; i < ROWS; ++i) order[i] = i;
    for (int k = 0; k < 5; ++k) move(order, 50 * k + 7, 50 * k + 8); // five of 400
    refused(ROWS, order, "row 9: time goes back");
    for (int i = 0; i < ROWS; ++i) order[i] = ROWS - 1 - i;
    refused(ROWS, order, "row 2: time goes back");
    int few[] = {0, 1, 3, 2, 4, 5, 6, 7, 8, 9};
    refused(10, few, "row 4: time goes back"); // one of ten is no exception
}

static void gaps_and_repeats_are_said(void **state) {
    (void)state;
    int order[ROWS];
    for (int i = 0; i < ROWS; ++i) order[i] = i < 300 ? i : i + 50;
    order[40] = 39;
    order[41] = 39;
    sn_record *record = shuffled(ROWS, order);
    sn_curve curve;
    CHECK_OK(sn_curve_from_record(record, &curve));
    assert_int_equal(curve.count, ROWS - 2);
    assert_int_equal(curve.discarded, 2);
    assert_non_null(strstr(curve.remarks, "2 row(s) at the time of the row before left out"));
    assert_non_null(strstr(curve.remarks, "1 gap(s) in time, the longest of 5.1 s from 29.9 s on"));
    sn_curve_release(&curve);
    sn_record_destroy(record);
    // rows that thin out, as a relaxation's do, have no gaps
    for (int i = 0; i < 60; ++i) order[i] = (int)(10.0 * pow(1.15, i)) + i;
    record = shuffled(60, order);
    CHECK_OK(sn_curve_from_record(record, &curve));
    assert_string_equal(curve.remarks, "");
    sn_curve_release(&curve);
    sn_record_destroy(record);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(late_rows_are_put_back),
        cmocka_unit_test(other_disorder_is_refused),
        cmocka_unit_test(gaps_and_repeats_are_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
