// Runs that are killed after one of their outputs and go on from what they saved there.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodies.h"

/// What a run saved last.
typedef struct keeper {
    int left; ///< times that it saves yet before it is killed
    unsigned char *bytes;
    size_t size;
} keeper;

static inline sn_status keep(void *context, const void *bytes, size_t count) {
    keeper *k = context;
    k->bytes = realloc(k->bytes, count);
    memcpy(k->bytes, bytes, count);
    k->size = count;
    return --k->left == 0 ? sn_fail(SN_E_STOPPED, "killed") : SN_OK;
}

/// Runs a case until it is killed at its save number `stop`; the bytes are the caller's to free().
static inline keeper run_killed(const sn_case *c, const sn_output *output, int stop) {
    keeper k = {.left = stop};
    const sn_restart point = {.context = &k, .save = keep};
    sn_run_summary summary;
    sn_record *history;
    CHECK_OK(sn_record_create("killed", &history));
    CHECK_FAILS(sn_springs_resume(c, output, &point, &summary, history), SN_E_STOPPED, "killed");
    sn_record_destroy(history);
    return k;
}

/// Goes on from there to the end, saving on its way; the record is the caller's.
static inline sn_record *run_on(const sn_case *c, const sn_output *output, const keeper *from,
                                sn_run_summary *summary) {
    keeper later = {0};
    const sn_restart point = {
        .context = &later, .save = keep, .state = from->bytes, .bytes = from->size};
    sn_record *history;
    CHECK_OK(sn_record_create("whole", &history));
    CHECK_OK(sn_springs_resume(c, output, &point, summary, history));
    free(later.bytes);
    return history;
}

/// Going on from there must fail.
#define CHECK_RUN_ON_FAILS(c, output, from, status, part)                                          \
    do {                                                                                           \
        sn_run_summary run_s_;                                                                     \
        sn_record *run_r_;                                                                         \
        const sn_restart run_p_ = {.state = (from)->bytes, .bytes = (from)->size};                 \
        CHECK_OK(sn_record_create("refused", &run_r_));                                            \
        CHECK_FAILS(sn_springs_resume(c, output, &run_p_, &run_s_, run_r_), status, part);         \
        sn_record_destroy(run_r_);                                                                 \
    } while (0)

/// Bit for bit.
static inline void check_same_rows(const sn_record *a, const sn_record *b) {
    assert_int_equal(a->rows, b->rows);
    assert_int_equal(a->series_count, b->series_count);
    for (int k = 0; k < a->series_count; k++)
        assert_memory_equal(a->series[k].value, b->series[k].value,
                            (size_t)a->rows * sizeof(double));
}

static inline void without_wall(sn_run_summary *s) {
    s->wall_s = s->real_time_factor = 0;
    s->step_wall_p50_s = s->step_wall_p99_s = s->step_wall_max_s = 0;
}

/// Bit for bit, but for wall times.
static inline void check_same_summary(sn_run_summary a, sn_run_summary b) {
    without_wall(&a);
    without_wall(&b);
    assert_memory_equal(&a, &b, sizeof a);
}
