// What the tests of the springs share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "build.h"
#include "sinew/springs.h"

/// Runs a case; the record is the caller's.
static inline sn_record *run_case(const sn_case *c, sn_run_summary *summary) {
    sn_record *history;
    CHECK_OK(sn_record_create("run", &history));
    CHECK_OK(sn_springs_run(c, NULL, summary, history));
    return history;
}
