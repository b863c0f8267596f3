// Dynamic moduli over frequency: power laws, plateaus, the peak of tan delta; sweeps.
// SPDX-License-Identifier: Apache-2.0
// Source: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed., Wiley 1980: storage and loss
// moduli, plateaus. Peak: vertex of the least-squares parabola in log frequency through the points
// about the largest tan delta, five where they are dense.
#include "lab/reduce/dynamic.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "lab/reduce/line.h"
#include "lab/reduce/signal.h"

static const double level = 0.02;   // power law of a plateau
static const double end_part = 0.5; // decades at an end that show whether it is level
static const double dense = 0.25;   // decades: five points about a peak that lie this close

static int by_frequency(const void *a, const void *b) {
    double x = ((const sn_oscillation *)a)->frequency, y = ((const sn_oscillation *)b)->frequency;
    return (x > y) - (x < y);
}

static double decades(const sn_dynamic *d, int a, int b) {
    return log10(d->at[b].frequency / d->at[a].frequency);
}

// power law of a modulus over points first to last; NAN where there is none
static double power(const sn_dynamic *d, int first, int last, bool storage) {
    double n = last - first + 1, mx = 0.0, my = 0.0, sxx = 0.0, sxy = 0.0;
    for (int pass = 0; pass < 2; ++pass)
        for (int k = first; k <= last; ++k) {
            double x = log10(d->at[k].frequency);
            double y = log10(storage ? d->at[k].storage_modulus : d->at[k].loss_modulus);
            if (pass == 0) {
                mx += x / n;
                my += y / n;
            } else {
                sxx += (x - mx) * (x - mx);
                sxy += (x - mx) * (y - my);
            }
        }
    return sxx > 0.0 ? sxy / sxx : (double)NAN;
}

// storage modulus over the points first to last, the last half decade at an end of the record
static double plateau(const sn_dynamic *d, int first, int last, const char *end, char *reason) {
    double slope = power(d, first, last, true), sum = 0.0;
    for (int k = first; k <= last; ++k) sum += d->at[k].storage_modulus;
    if (last - first < 1)
        snprintf(reason, SN_TEXT_MAX, "one frequency in the %s half decade", end);
    else if (!(fabs(slope) <= level))
        snprintf(reason, SN_TEXT_MAX,
                 "not level: the storage modulus goes with frequency to the power %.3f at the %s "
                 "end",
                 slope, end);
    else
        return sum / (last - first + 1);
    return (double)NAN;
}

// vertex of the parabola through tan delta about point k
static bool vertex(const sn_dynamic *d, int k, double *frequency, double *value) {
    int half = k >= 2 && k + 2 < d->count && decades(d, k - 2, k + 2) <= 4.0 * dense ? 2 : 1;
    double a[9] = {0}, c[3] = {0}, unit = decades(d, k - half, k + half);
    for (int i = k - half; i <= k + half; ++i) {
        double u = decades(d, k, i) / unit, row[3] = {1.0, u, u * u};
        for (int j = 0; j < 3; ++j) {
            c[j] += row[j] * d->at[i].tan_delta;
            for (int m = 0; m < 3; ++m) a[3 * j + m] += row[j] * row[m];
        }
    }
    if (!sn_normal_solve(3, a, c) || !(c[2] < 0.0)) return false;
    double u = -0.5 * c[1] / c[2];
    *frequency = d->at[k].frequency * pow(10.0, u * unit);
    *value = c[0] - 0.25 * c[1] * c[1] / c[2];
    return *frequency >= d->at[k - half].frequency && *frequency <= d->at[k + half].frequency;
}

static void find_peak(sn_dynamic *d) {
    int top = 0;
    d->peak_tan_delta = d->peak_frequency = (double)NAN;
    for (int k = 0; k < d->count; ++k)
        if (d->at[k].tan_delta > d->at[top].tan_delta) top = k;
    if (d->count < 3)
        snprintf(d->peak_reason, SN_TEXT_MAX, "%d frequencies: a peak needs 3", d->count);
    else if (top == 0 || top == d->count - 1)
        snprintf(d->peak_reason, SN_TEXT_MAX,
                 "tan delta is largest, %.4g, at the %s of the record, %.4g Hz: the peak lies "
                 "beyond it",
                 d->at[top].tan_delta, top == 0 ? "lower end" : "upper end", d->at[top].frequency);
    else if (!vertex(d, top, &d->peak_frequency, &d->peak_tan_delta)) {
        d->peak_tan_delta = d->peak_frequency = (double)NAN;
        snprintf(d->peak_reason, SN_TEXT_MAX,
                 "tan delta has no clear peak: largest, %.4g, at %.4g Hz", d->at[top].tan_delta,
                 d->at[top].frequency);
    }
}

void sn_dynamic_finish(sn_dynamic *d) {
    qsort(d->at, (size_t)d->count, sizeof *d->at, by_frequency);
    int last = d->count - 1, low = 0, high = last;
    while (low < last && decades(d, 0, low + 1) <= end_part) ++low;
    while (high > 0 && decades(d, high - 1, last) <= end_part) --high;
    d->storage_per_decade = power(d, 0, last, true);
    d->loss_per_decade = power(d, 0, last, false);
    d->low_plateau = plateau(d, 0, low, "lower", d->low_reason);
    d->high_plateau = plateau(d, high, last, "upper", d->high_reason);
    find_peak(d);
}

//---- sweep ---------------------------------------------------------------------------------------

static sn_status columns_of(const sn_record *record, const double *column[3]) {
    static const char *const names[] = {"frequency", "storage_modulus", "loss_modulus"};
    for (int k = 0; k < 3; ++k) {
        column[k] = sn_record_values(record, names[k]);
        if (!column[k])
            return sn_fail(SN_E_DATA,
                           "%s: no column %s: a dynamic test needs frequency, storage_modulus and "
                           "loss_modulus, or time, stretch and stress",
                           record->name, names[k]);
        for (int i = 0; i < record->rows; ++i)
            if (!isfinite(column[k][i]) || !(k < 2 ? column[k][i] > 0.0 : column[k][i] >= 0.0))
                return sn_fail(SN_E_DATA, "%s: row %d: %s is %g, expected a number %s",
                               record->name, i + 1, names[k], column[k][i],
                               k < 2 ? "above 0" : "of 0 or more");
    }
    return SN_OK;
}

sn_status sn_reduce_sweep(const sn_record *record, sn_dynamic *out) {
    SN_ASSERT(record && out);
    *out = (sn_dynamic){0};
    const double *column[3];
    SN_TRY(columns_of(record, column));
    if (record->rows < 1) return sn_fail(SN_E_DATA, "%s: no rows", record->name);
    out->at = sn_alloc((size_t)record->rows, sizeof *out->at);
    if (!out->at) return SN_E_MEMORY;
    const double none = (double)NAN;
    bool sorted = true;
    for (int i = 0; i < record->rows; ++i) {
        double storage = column[1][i], loss = column[2][i];
        sorted = sorted && (i == 0 || column[0][i] > column[0][i - 1]);
        out->at[i] = (sn_oscillation){column[0][i],
                                      storage,
                                      loss,
                                      none,
                                      none,
                                      loss / storage,
                                      atan2(loss, storage),
                                      none,
                                      none,
                                      none,
                                      none,
                                      none,
                                      i,
                                      i,
                                      none};
    }
    out->count = record->rows;
    sn_dynamic_finish(out);
    if (!sorted) sn_remark(out->remarks, sizeof out->remarks, "rows put in order of frequency");
    for (int k = 1; k < out->count; ++k)
        if (!(out->at[k].frequency > out->at[k - 1].frequency)) {
            sn_status status = sn_fail(
                SN_E_DATA, "%s: rows %d and %d have the same frequency, %g Hz: keep one",
                record->name, out->at[k - 1].first + 1, out->at[k].first + 1, out->at[k].frequency);
            sn_dynamic_release(out);
            return status;
        }
    return SN_OK;
}

void sn_dynamic_release(sn_dynamic *dynamic) {
    if (!dynamic) return;
    sn_free(dynamic->at);
    *dynamic = (sn_dynamic){0};
}
