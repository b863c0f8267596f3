// What runs of the two engines are held to each other by.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <math.h>

#include "check.h"
#include "sinew/sinew.h"

typedef sn_status engine(const sn_case *, const sn_output *, sn_run_summary *, sn_record *);

/// Runs a case to its end; the history is the caller's.
static inline sn_record *reaction(engine *run, const sn_case *c) {
    sn_record *history;
    sn_run_summary summary = {0};
    CHECK_OK(sn_record_create("run", &history));
    CHECK_OK(run(c, &(sn_output){0}, &summary, history));
    if (!summary.converged) print_message("%s\n", summary.reason);
    assert_true(summary.converged);
    return history;
}

/// Largest difference of the probes "pull" over the largest of b.
static inline double distance(const sn_record *a, const sn_record *b) {
    const double *x = sn_record_values(a, "pull_fx"), *y = sn_record_values(b, "pull_fx");
    double largest = 0, difference = 0;
    assert_int_equal(a->rows, b->rows);
    for (int i = 0; i < a->rows; i++) {
        largest = fmax(largest, fabs(y[i]));
        difference = fmax(difference, fabs(x[i] - y[i]));
    }
    assert_true(largest > 0);
    return difference / largest;
}
