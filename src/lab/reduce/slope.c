// Slope against stress, whether it is a straight line, and the toe.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (13), dT/dL = B T + C.
//
// Local slopes. The slope at a row is that of the least-squares line through the rows about it, and
// the stress that goes with it their mean. For an exponential curve both are the true ones times
// factors that depend on B times half the window alone, so a wide window does not bend the
// regression. The window is 1 % of the strain, or more where the scatter asks for it: the standard
// error of a slope through evenly spread rows, sigma sqrt(12/(rows in the window))/window, shall be
// 3 % of the steepest; and wide against the scatter of the stretch, which would flatten the slopes.
//
// Straightness. Twenty separate pieces of equal strain, so that their errors are independent, each
// with its slope and mean stress; a parabola through these. Its bend is significant where it is
// three times its standard error, and matters where it takes the parabola more than 5 % of the
// range of slopes away from a straight line.
#include <math.h>
#include <stdio.h>

#include "lab/reduce/pull.h"

static const double window = 0.01, window_most = 0.25; // of the strain
static const double slope_error = 0.03;                // of the steepest slope
static const double stretch_noises = 20.0;             // window over the scatter of the stretch
static const double bend_matters = 0.05, bend_errors = 3.0;
enum { PIECES = 20, PIECES_MIN = 6, PIECE_ROWS = 4 };

// strain over which slopes are taken
static double window_for(const sn_pull *p, double steepest) {
    double density = p->top / p->strain_range, noise = hypot(p->noise, steepest * p->stretch_noise);
    double wanted = cbrt(12.0 * noise * noise / density / pow(slope_error * steepest, 2.0));
    wanted = fmax(fmax(window * p->strain_range, stretch_noises * p->stretch_noise), wanted);
    return fmin(wanted, window_most * p->strain_range);
}

// local slopes at the rows whose window lies within the pull; `at` their stretches
static void local_slopes(const sn_pull *p, double *at, sn_tensile *out) {
    const double *x = p->stretch;
    double half = 0.5 * out->slope_window * (1.0 + 1e-9);
    int lo = 0, hi = 0, n = 0;
    for (int i = 1; i + 1 < p->top; ++i) {
        while (lo < i - 1 && x[i] - x[lo] > half) ++lo;
        if (hi < i + 1) hi = i + 1;
        while (hi + 1 < p->top && x[hi + 1] - x[i] <= half) ++hi;
        bool three = lo == i - 1 && hi == i + 1;
        double room = fmin(x[i] - x[0], x[p->top - 1] - x[i]);
        if (!three && room < 0.999 * half) continue; // the window would lean to one side
        double slope = sn_line_window(&p->sums, lo, hi).slope;
        if (!isfinite(slope)) continue; // the machine stood still
        sn_window_means(&p->sums, lo, hi, &at[n], &out->slope_stress[n]);
        out->slope[n++] = slope;
    }
    out->slope_count = n;
}

static void find_toe(const double *at, sn_tensile *out) {
    int steepest = 0;
    for (int i = 0; i < out->slope_count; ++i)
        if (out->slope[i] > out->slope[steepest]) steepest = i;
    out->toe_limit = out->toe_stress = (double)NAN;
    if (out->slope_count == 0) {
        snprintf(out->toe_reason, sizeof out->toe_reason, "no slopes: too few rows");
        return;
    }
    double half = 0.5 * out->slope[steepest];
    int i = steepest;
    while (i >= 0 && out->slope[i] >= half) --i;
    if (i < 0) {
        snprintf(out->toe_reason, sizeof out->toe_reason,
                 "no toe: the slope starts at %.0f %% of the steepest",
                 50.0 * out->slope[0] / half);
        return;
    }
    double part = (half - out->slope[i]) / (out->slope[i + 1] - out->slope[i]);
    out->toe_limit = at[i] + part * (at[i + 1] - at[i]) - 1.0;
    out->toe_stress =
        out->slope_stress[i] + part * (out->slope_stress[i + 1] - out->slope_stress[i]);
}

// slopes and mean stresses of pieces of equal strain; returns how many
static int pieces(const sn_pull *p, double *slope, double *stress) {
    int wanted = p->top / PIECE_ROWS < PIECES ? p->top / PIECE_ROWS : PIECES, n = 0;
    for (int k = 0, first = 0; k < wanted; ++k) {
        double end = p->stretch[0] + p->strain_range * (k + 1) / wanted, mean;
        int last = first;
        while (last + 1 < p->top && (p->stretch[last + 1] < end || k == wanted - 1)) ++last;
        if (last - first >= 2) {
            slope[n] = sn_line_window(&p->sums, first, last).slope;
            sn_window_means(&p->sums, first, last, &mean, &stress[n]);
            n += isfinite(slope[n]);
        }
        first = last + 1 < p->top ? last + 1 : last;
    }
    return n;
}

// coefficients of a parabola in u, with the standard error of the last; false where there is none
static bool parabola(int n, const double *u, const double *y, double c[3], double *error) {
    double a[9] = {0}, inverse[3] = {0.0, 0.0, 1.0}, rest = 0.0, copy[9];
    c[0] = c[1] = c[2] = 0.0;
    for (int i = 0; i < n; ++i) {
        double row[3] = {1.0, u[i], u[i] * u[i]};
        for (int j = 0; j < 3; ++j) {
            c[j] += row[j] * y[i];
            for (int k = 0; k < 3; ++k) a[3 * j + k] += row[j] * row[k];
        }
    }
    for (int k = 0; k < 9; ++k) copy[k] = a[k];
    if (!sn_normal_solve(3, a, c) || !sn_normal_solve(3, copy, inverse)) return false;
    for (int i = 0; i < n; ++i) rest += pow(y[i] - c[0] - u[i] * (c[1] + u[i] * c[2]), 2.0);
    *error = sqrt(rest / (n - 3) * inverse[2]);
    return true;
}

static void straight_line_test(const sn_pull *p, sn_tensile *out) {
    double slope[PIECES], stress[PIECES], c[3], error;
    double low = (double)INFINITY, high = -low, least = low, most = -low;
    int n = pieces(p, slope, stress);
    out->slope_curvature = out->slope_curvature_t = (double)NAN;
    for (int k = 0; k < n; ++k) {
        low = fmin(low, stress[k]);
        high = fmax(high, stress[k]);
        least = fmin(least, slope[k]);
        most = fmax(most, slope[k]);
    }
    for (int k = 0; k < n; ++k) stress[k] = (2.0 * stress[k] - low - high) / (high - low);
    if (n < PIECES_MIN || !(high > low) || !parabola(n, stress, slope, c, &error)) {
        snprintf(out->slope_test, sizeof out->slope_test,
                 "not tested: %d rows up to the largest stress are too few", p->top);
        return;
    }
    // u^2 on [-1, 1] stands off its best straight line by at most 1/2
    double scale = fmax(most - least, 0.1 * fabs(most));
    out->slope_curvature = 0.5 * c[2] / scale;
    out->slope_curvature_t = error > 0.0 ? c[2] / error : 0.0;
    bool matters = fabs(out->slope_curvature) > bend_matters;
    bool clear = fabs(out->slope_curvature_t) > bend_errors;
    const char *verdict = !matters     ? "straight"
                          : !clear     ? "no bend that the noise lets see"
                          : c[2] > 0.0 ? "not straight, the slope rises faster than (13)"
                                       : "not straight, the slope rises slower than (13)";
    snprintf(out->slope_test, sizeof out->slope_test,
             "%s: bend of %.1f %% of the range of slopes, %.1f standard errors", verdict,
             100.0 * out->slope_curvature, fabs(out->slope_curvature_t));
}

sn_status sn_pull_slopes(const sn_pull *p, sn_tensile *out) {
    out->slope_window = window_for(p, out->max_slope_modulus);
    out->slope = sn_alloc((size_t)p->top, sizeof *out->slope);
    out->slope_stress = sn_alloc((size_t)p->top, sizeof *out->slope_stress);
    double *at = sn_alloc((size_t)p->top, sizeof *at);
    if (!out->slope || !out->slope_stress || !at) {
        sn_free(at);
        return SN_E_MEMORY;
    }
    local_slopes(p, at, out);
    find_toe(at, out);
    sn_free(at);
    sn_line_fit line = sn_line_through(out->slope_count, out->slope_stress, out->slope);
    out->B = line.slope;
    out->C = line.intercept;
    out->slope_r_squared = line.r_squared;
    straight_line_test(p, out);
    return SN_OK;
}
