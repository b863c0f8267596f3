// The one loading ramp of a record that a tensile reduction sees, and its slopes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/reduce/line.h"
#include "sinew/lab.h"

enum { SN_PULL_MIN = 5 }; // rows of a pull, and of a window of it

typedef struct sn_pull {
    int first;              // row of the curve at which it starts
    int rows;               // of the ramp
    int top;                // rows up to the largest stress, and including it
    double *stretch;        // over that at the preload                     (rows), owned
    double *stress;         // Pa                                           (rows), owned
    double strain_range;    // from the first row to that of the largest stress
    double noise;           // scatter of the stress, Pa
    double stretch_noise;   // scatter of the stretch
    double preload_stretch; // of the curve, at the zero of strain
    sn_line_sums sums;      // of all rows, owned
} sn_pull;

/// Chooses the ramp, finds the preload, and says in `out` what it left out.
/// @return SN_OK, SN_E_DATA, SN_E_RANGE, SN_E_MEMORY. Release in any case.
sn_status sn_pull_create(const sn_curve *curve, const sn_tensile_def *def, sn_pull *pull,
                         sn_tensile *out);
void sn_pull_release(sn_pull *pull);

/// Local slopes, their regression on the stress with its straight-line test, and the toe. Needs
/// max_slope_modulus.
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_pull_slopes(const sn_pull *pull, sn_tensile *out);
