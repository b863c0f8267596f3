// What runs of the two engines are held to each other by.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"
#include "sinew/sinew.h"

/// sn_springs_run() or sn_continuum_run().
typedef sn_status engine(const sn_case *, const sn_output *, sn_run_summary *, sn_record *);

/// Runs a case, which must end well; the history is the caller's.
static inline sn_record *run_engine(engine *run, const sn_case *c, const sn_output *output,
                                    sn_run_summary *summary) {
    sn_record *history;
    CHECK_OK(sn_record_create("run", &history));
    CHECK_OK(run(c, output, summary, history));
    if (!summary->converged) print_message("%s\n", summary->reason);
    assert_true(summary->converged);
    return history;
}

static inline sn_record *reaction(engine *run, const sn_case *c) {
    sn_run_summary summary = {0};
    return run_engine(run, c, &(sn_output){0}, &summary);
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
