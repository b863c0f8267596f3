// The measured ramps of data/cardiac-muscle, read simply.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab_oracle.h"

enum { CARDIAC_RAMPS = 4 };

/// The ramp of 0.1, 1, 10 or 100 s (k = 0 … 3). Owned.
static inline sn_curve cardiac_ramp(int k) {
    static const char *const names[] = {"0.1s", "1s", "10s", "100s"};
    enum { ROWS = 64 };
    double time[ROWS], stretch[ROWS], stress[ROWS];
    char path[512], line[512];
    snprintf(path, sizeof path, "%s/data/cardiac-muscle/ramp-%s.csv", SN_SOURCE_DIR, names[k]);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int n = 0;
    while (fgets(line, sizeof line, file))
        if (n < ROWS && sscanf(line, "%lf,%lf,%lf", &time[n], &stretch[n], &stress[n]) == 3) {
            stress[n] *= 1e3; // kPa
            n++;
        }
    fclose(file);
    assert_true(n > 30);
    return oracle_curve(names[k], n, time, stretch, stress);
}
