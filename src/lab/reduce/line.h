// Straight lines through rows of a curve, and small linear least squares.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdbool.h>

/// y = intercept + slope x by least squares, with the standard error of the slope and R2.
typedef struct sn_line_fit {
    double slope, intercept, slope_error, r_squared;
} sn_line_fit;

/// Through n rows. All NAN where the x are all equal or n < 2; slope_error 0 for n = 2.
sn_line_fit sn_line_through(int n, const double *x, const double *y);

/// Sums over the rows before each, so that a line through any window of rows costs the same.
typedef struct sn_line_sums {
    int rows;
    double x0, y0; // subtracted from every row
    double *sum;   // x y xx xy yy                                  (rows + 1 x 5), owned
} sn_line_sums;

/// @return false where memory is short. Release with sn_line_sums_release() in any case.
bool sn_line_sums_create(int rows, const double *x, const double *y, sn_line_sums *sums);
void sn_line_sums_release(sn_line_sums *sums);
/// sn_line_through() of rows first to last, both included. Good to rounding times the square of
/// all rows' range over the window's.
sn_line_fit sn_line_window(const sn_line_sums *sums, int first, int last);
/// Means of x and y over rows first to last.
void sn_window_means(const sn_line_sums *sums, int first, int last, double *x, double *y);

/// Solves the normal equations a x = b of m unknowns by Cholesky. a is overwritten.
/// @param a  symmetric, the lower half is read                      (m x m)
/// @param x  b on entry, the solution on return                     (m)
/// @return false where a is not positive definite.
bool sn_normal_solve(int m, double *a, double *x);
