// Properties of a creep test: compliance, creep rate, rupture, recovery.
// SPDX-License-Identifier: Apache-2.0
//
// The held stress is the median of the stress over the middle half of the time during which it
// stands above half of its largest value: overshoot and ramps have no say in it. A rupture and an
// unloading both end the hold; what tells them apart is the strain, which goes on where the
// specimen broke and comes back where it was unloaded.
//
// Rows are judged with the scatter of the stress: "within 2 %" means within four scatters where
// these are more. The zero of stress and strain is the mean of the rows before the loading.
#include <math.h>
#include <stdio.h>

#include "lab/reduce/line.h"
#include "lab/reduce/signal.h"

enum { HOLD_MIN = 5 };
static const double plateau = 0.02;  // of the held stress: where the hold begins and ends
static const double wander = 0.10;   // of the held stress: more is no hold
static const double overshoot = 0.1; // of the hold: how long it may last
static const double window = 0.25;   // of the hold, for the creep rate
static const double at_rest = 0.001; // of the held stress: loading has not begun
static const double scatters = 4.0;  // of the stress: no row is off by more by chance
static const int end_rows = 50;      // the strain at the end: over this part of the hold

typedef struct hold {
    int start, first, last; // rows: last before loading, first and last under the stress
    double stress;          // over that at rest
    double zero_stress, zero_stretch, noise;
} hold;

static double load(const sn_curve *c, const hold *h, int row) {
    return c->stress[row] - h->zero_stress;
}

static double strain(const sn_curve *c, const hold *h, int row) {
    return c->stretch[row] - h->zero_stretch;
}

// strain at the end of rows first to last: of the last row, or of a line through the last of them
static double end_strain(const sn_curve *c, const hold *h, int first, int last) {
    int n = (last - first + 1) / end_rows;
    if (n < 3) return strain(c, h, last);
    first = last - n + 1;
    sn_line_fit line = sn_line_through(n, c->time + first, c->stretch + first);
    return line.intercept + line.slope * c->time[last] - h->zero_stretch;
}

// median of the stress over the middle half of the time between two rows
static sn_status held_stress(const sn_curve *c, const hold *h, int first, int last,
                             double *stress) {
    double quarter = 0.25 * (c->time[last] - c->time[first]);
    double *value = sn_alloc((size_t)(last - first + 1), sizeof *value);
    if (!value) return SN_E_MEMORY;
    int n = 0;
    for (int i = first; i <= last; ++i)
        if (c->time[i] >= c->time[first] + quarter && c->time[i] <= c->time[last] - quarter)
            value[n++] = load(c, h, i);
    if (n == 0) value[n++] = load(c, h, (first + last) / 2);
    *stress = sn_median(n, value);
    sn_free(value);
    return SN_OK;
}

// rows of the hold; the zero is that of row 0 so far
static sn_status find_rows(const sn_curve *c, hold *h) {
    int top = 0, first = 0, last = c->count - 1;
    for (int i = 0; i < c->count; ++i)
        if (fabs(load(c, h, i)) > fabs(load(c, h, top))) top = i;
    if (load(c, h, top) == 0.0)
        return sn_fail(SN_E_DATA, "%s: the stress is %g Pa in every row: a creep test needs a load",
                       c->name, c->stress[0]);
    double half = 0.5 * load(c, h, top);
    while (load(c, h, first) / half < 1.0) ++first;
    while (load(c, h, last) / half < 1.0) --last;
    SN_TRY(held_stress(c, h, first, last, &h->stress));
    h->first = first;
    h->last = last;
    double least = 1.0 - fmax(plateau, scatters * h->noise / fabs(h->stress));
    while (h->first < last && load(c, h, h->first) / h->stress < least) ++h->first;
    while (h->last > h->first && load(c, h, h->last) / h->stress < least) --h->last;
    double rest = fmax(at_rest, 1.5 * scatters * h->noise / fabs(h->stress)); // row 0 is off, too
    h->start = 0;
    while (h->start + 1 < h->first && fabs(load(c, h, h->start + 1) / h->stress) <= rest)
        ++h->start;
    return SN_OK;
}

static sn_status find_hold(const sn_curve *c, hold *h) {
    SN_TRY(sn_scatter(c->count, c->time, c->stress, &h->noise));
    h->zero_stress = c->stress[0];
    h->zero_stretch = c->stretch[0];
    SN_TRY(find_rows(c, h));
    double stress = 0.0, stretch = 0.0;
    for (int i = 0; i <= h->start; ++i) {
        stress += c->stress[i] / (h->start + 1);
        stretch += c->stretch[i] / (h->start + 1);
    }
    h->stress += h->zero_stress - stress;
    h->zero_stress = stress;
    h->zero_stretch = stretch;
    double settled = c->time[h->first] + overshoot * (c->time[h->last] - c->time[h->first]);
    double most = fmax(wander, 1.5 * scatters * h->noise / fabs(h->stress));
    for (int i = h->first; i <= h->last; ++i) {
        double off = load(c, h, i) / h->stress - 1.0;
        if (off < -most || (off > most && c->time[i] > settled))
            return sn_fail(SN_E_DATA,
                           "%s: row %d: stress %g Pa leaves the %g Pa held from row %d to %d: "
                           "expected one load and hold",
                           c->name, i + 1, c->stress[i], h->stress + h->zero_stress, h->first + 1,
                           h->last + 1);
    }
    if (h->last - h->first + 1 >= HOLD_MIN) return SN_OK;
    return sn_fail(SN_E_DATA,
                   "%s: %d rows within %g %% of the held stress of %g Pa: a creep test needs a "
                   "hold of at least %d rows",
                   c->name, h->last - h->first + 1, 100 * plateau, h->stress + h->zero_stress,
                   (int)HOLD_MIN);
}

// the smallest slope (in size) of the strain over a quarter of the hold, by least squares
static double creep_rate(const sn_curve *c, const hold *h) {
    double span = window * (c->time[h->last] - c->time[h->first]), best = (double)INFINITY;
    for (int i = h->first, j = i; i <= h->last; ++i) {
        while (j < h->last && (c->time[j] - c->time[i] < span || j - i + 1 < HOLD_MIN)) ++j;
        if (c->time[j] - c->time[i] < span || j - i + 1 < HOLD_MIN) break;
        double slope = sn_line_through(j - i + 1, c->time + i, c->stretch + i).slope;
        if (fabs(slope) < fabs(best)) best = slope;
    }
    if (isfinite(best)) return best;
    int n = h->last - h->first + 1; // rows too sparse for a quarter: all of them
    return sn_line_through(n, c->time + h->first, c->stretch + h->first).slope;
}

sn_status sn_reduce_creep(const sn_curve *curve, sn_creep_result *out) {
    SN_ASSERT(curve && out);
    *out = (sn_creep_result){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a creep test"));
    if (!curve->time)
        return sn_fail(SN_E_DATA, "%s: no time column: a creep test needs one", curve->name);
    hold h = {0};
    SN_TRY(find_hold(curve, &h));
    double reached = end_strain(curve, &h, h.first, h.last);
    out->stress = h.stress;
    out->ramp_s = curve->time[h.first] - curve->time[h.start];
    out->hold_s = curve->time[h.last] - curve->time[h.first];
    out->initial_compliance = strain(curve, &h, h.first) / h.stress;
    out->compliance = reached / h.stress;
    out->creep_rate = creep_rate(curve, &h);
    out->time_to_rupture = out->recovered_fraction = (double)NAN;
    if (h.start > 0)
        sn_remark(out->remarks, sizeof out->remarks,
                  "%d row(s) before the loading give the zero of stress and strain", h.start);
    int fallen = h.last;
    while (fallen < curve->count && load(curve, &h, fallen) / h.stress >= 0.5) ++fallen;
    if (fallen == curve->count) { // ended under the stress
        snprintf(out->rupture_reason, sizeof out->rupture_reason,
                 "no rupture within the %.4g s of the hold", out->hold_s);
        snprintf(out->recovery_reason, sizeof out->recovery_reason,
                 "the record ends under the stress");
    } else if (strain(curve, &h, fallen) / reached > 1.0) {
        out->time_to_rupture = out->hold_s;
        snprintf(out->recovery_reason, sizeof out->recovery_reason, "the specimen broke");
    } else {
        out->recovered_fraction = 1.0 - end_strain(curve, &h, fallen, curve->count - 1) / reached;
        snprintf(out->rupture_reason, sizeof out->rupture_reason, "unloaded after a hold of %.4g s",
                 out->hold_s);
    }
    return SN_OK;
}
