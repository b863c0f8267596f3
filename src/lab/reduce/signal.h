// What a noisy signal needs before it is reduced: its scatter, its turns, medians.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/lab.h"

/// Median of n >= 1 values, which are put in order.
double sn_median(int n, double *value);

/// Standard deviation of the scatter of y about a smooth curve in x, from how far every row stands
/// off the parabola through three of its neighbours: robust to corners and outliers, 0 where fewer
/// than 8 rows. x rises; NULL: rows.
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_scatter(int n, const double *x, const double *y, double *sigma);

/// The same for the stretch of a curve, over time or rows; 0 where it hardly ever reverses between
/// rows: a scatter smaller than the steps needs no care.
sn_status sn_stretch_scatter(const sn_curve *curve, double *sigma);

/// Rows of the turns, alternating lowest and highest, the first a lowest. A turn counts once y has
/// come back from it by more than the threshold; the last extreme stands for the end. Of equal lows
/// the first row is the turn, of equal tops the last.
/// @param turn  room for n + 1 rows
/// @return the number of turns, at least 1.
int sn_turns(int n, const double *y, double threshold, int *turn);

/// Adds a text to remarks, after "; " where there are some. What does not fit is cut.
void sn_remark(char *remarks, size_t size, const char *format, ...) SN_PRINTF(3, 4);
