// Scatter, turns and medians of noisy signals.
// SPDX-License-Identifier: Apache-2.0
// Source: T. Gasser, L. Sroka, C. Jennen-Steinmetz, Residual variance and residual pattern in
// nonlinear regression, Biometrika 73 (1986) 625: variance from local differences for any spacing;
// here with parabolas, and the median in place of the mean.
#include "lab/reduce/signal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double normal_quartile = 0.67448975019608171; // median of |standard normal|
enum { SCATTER_MIN = 8, STEPS_PER_REVERSAL = 20 };

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double sn_median(int n, double *value) {
    qsort(value, (size_t)n, sizeof *value, by_value);
    return n % 2 ? value[n / 2] : 0.5 * (value[n / 2 - 1] + value[n / 2]);
}

// y[i] less its value on the parabola through rows i - 1, i + 1, i + 2, over the standard deviation
// that this has for independent rows of unit scatter
static double residual(int i, const double *x, const double *y) {
    double x0 = -1.0, x1 = 1.0, x2 = 2.0; // from row i
    if (x && x[i - 1] < x[i] && x[i] < x[i + 1] && x[i + 1] < x[i + 2]) {
        x0 = x[i - 1] - x[i];
        x1 = x[i + 1] - x[i];
        x2 = x[i + 2] - x[i];
    }
    double w0 = x1 * x2 / ((x0 - x1) * (x0 - x2)), w1 = x0 * x2 / ((x1 - x0) * (x1 - x2));
    double w2 = x0 * x1 / ((x2 - x0) * (x2 - x1));
    double off = y[i] - w0 * y[i - 1] - w1 * y[i + 1] - w2 * y[i + 2];
    return off / sqrt(1.0 + w0 * w0 + w1 * w1 + w2 * w2);
}

sn_status sn_scatter(int n, const double *x, const double *y, double *sigma) {
    *sigma = 0.0;
    if (n < SCATTER_MIN) return SN_OK;
    double *off = sn_alloc((size_t)n, sizeof *off);
    if (!off) return SN_E_MEMORY;
    int count = 0;
    for (int i = 1; i + 2 < n; ++i) off[count++] = fabs(residual(i, x, y));
    *sigma = sn_median(count, off) / normal_quartile;
    sn_free(off);
    return SN_OK;
}

sn_status sn_stretch_scatter(const sn_curve *curve, double *sigma) {
    int reversals = 0;
    double last = 0.0;
    for (int i = 1; i < curve->count; ++i) {
        double step = curve->stretch[i] - curve->stretch[i - 1];
        if (step == 0.0) continue;
        reversals += step * last < 0.0;
        last = step;
    }
    *sigma = 0.0;
    if (reversals * STEPS_PER_REVERSAL <= curve->count) return SN_OK;
    return sn_scatter(curve->count, curve->time, curve->stretch, sigma);
}

int sn_turns(int n, const double *y, double threshold, int *turn) {
    int count = 0, extreme = 0;
    bool rising = false; // a start at the top is left out by looking for a lowest first
    for (int i = 1; i < n; ++i) {
        double back = y[i] - y[extreme];
        if (rising ? back >= 0.0 : back < 0.0) {
            extreme = i; // equal tops: the last row of a plateau belongs to the way up
        } else if (fabs(back) > threshold) {
            turn[count++] = extreme;
            rising = !rising;
            extreme = i;
        }
    }
    turn[count++] = extreme;
    return count;
}

void sn_remark(char *remarks, size_t size, const char *format, ...) {
    size_t used = strlen(remarks);
    if (used > 0 && used + 2 < size) {
        memcpy(remarks + used, "; ", 3);
        used += 2;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(remarks + used, size - used, format, arguments);
    va_end(arguments);
}
