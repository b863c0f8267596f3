// Straight lines through rows of a curve.
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// y = intercept + slope x by least squares, with the standard error of the slope and R2.
typedef struct sn_line_fit {
    double slope, intercept, slope_error, r_squared;
} sn_line_fit;

/// Through n rows. All NAN where the x are all equal or n < 2; slope_error 0 for n = 2.
sn_line_fit sn_line_through(int n, const double *x, const double *y);
