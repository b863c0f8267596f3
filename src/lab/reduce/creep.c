// Properties of a creep test: compliance, creep rate, rupture, recovery.
// SPDX-License-Identifier: Apache-2.0
//
// The held stress is the median of the stress over the middle half of the time during which it
// stands above half of its largest value: overshoot and ramps have no say in it. A rupture and an
// unloading both end the hold; what tells them apart is the strain, which goes on where the
// specimen broke and comes back where it was unloaded.
#include <math.h>
#include <stdlib.h>

#include "lab/reduce/line.h"
#include "sinew/lab.h"

enum { HOLD_MIN = 5 };
static const double plateau = 0.02;  // of the held stress: where the hold begins and ends
static const double wander = 0.10;   // of the held stress: more is no hold
static const double overshoot = 0.1; // of the hold: how long it may last
static const double window = 0.25;   // of the hold, for the creep rate
static const double at_rest = 0.001; // of the held stress: loading has not begun

typedef struct hold {
    int start, first, last; // rows: last before loading, first and last under the stress
    double stress;          // over that of row 0
} hold;

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double load(const sn_curve *c, int row) {
    return c->stress[row] - c->stress[0];
}

static double strain(const sn_curve *c, int row) {
    return c->stretch[row] - c->stretch[0];
}

// median of the stress over the middle half of the time between two rows
static sn_status held_stress(const sn_curve *c, int first, int last, double *stress) {
    double quarter = 0.25 * (c->time[last] - c->time[first]);
    double *value = sn_alloc((size_t)(last - first + 1), sizeof *value);
    if (!value) return SN_E_MEMORY;
    int n = 0;
    for (int i = first; i <= last; ++i)
        if (c->time[i] >= c->time[first] + quarter && c->time[i] <= c->time[last] - quarter)
            value[n++] = load(c, i);
    if (n == 0) value[n++] = load(c, (first + last) / 2);
    qsort(value, (size_t)n, sizeof *value, by_value);
    *stress = value[n / 2];
    sn_free(value);
    return SN_OK;
}

static sn_status find_hold(const sn_curve *c, hold *h) {
    int top = 0, first = 0, last = c->count - 1;
    for (int i = 0; i < c->count; ++i)
        if (fabs(load(c, i)) > fabs(load(c, top))) top = i;
    if (load(c, top) == 0.0)
        return sn_fail(SN_E_DATA, "%s: the stress is %g Pa in every row: a creep test needs a load",
                       c->name, c->stress[0]);
    double half = 0.5 * load(c, top);
    while (load(c, first) / half < 1.0) ++first;
    while (load(c, last) / half < 1.0) --last;
    SN_TRY(held_stress(c, first, last, &h->stress));
    h->first = first;
    h->last = last;
    while (h->first < last && load(c, h->first) / h->stress < 1.0 - plateau) ++h->first;
    while (h->last > h->first && load(c, h->last) / h->stress < 1.0 - plateau) --h->last;
    h->start = 0;
    while (h->start + 1 < h->first && fabs(load(c, h->start + 1) / h->stress) <= at_rest)
        ++h->start;
    double settled = c->time[h->first] + overshoot * (c->time[h->last] - c->time[h->first]);
    for (int i = h->first; i <= h->last; ++i) {
        double off = load(c, i) / h->stress - 1.0;
        if (off < -wander || (off > wander && c->time[i] > settled))
            return sn_fail(SN_E_DATA,
                           "%s: row %d: stress %g Pa leaves the %g Pa held from row %d to %d: "
                           "expected one load and hold",
                           c->name, i + 1, c->stress[i], h->stress + c->stress[0], h->first + 1,
                           h->last + 1);
    }
    if (h->last - h->first + 1 >= HOLD_MIN) return SN_OK;
    return sn_fail(SN_E_DATA,
                   "%s: %d rows within %g %% of the held stress of %g Pa: a creep test needs a "
                   "hold of at least %d rows",
                   c->name, h->last - h->first + 1, 100 * plateau, h->stress + c->stress[0],
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
    double reached = strain(curve, h.last);
    out->stress = h.stress;
    out->ramp_s = curve->time[h.first] - curve->time[h.start];
    out->hold_s = curve->time[h.last] - curve->time[h.first];
    out->initial_compliance = strain(curve, h.first) / h.stress;
    out->compliance = reached / h.stress;
    out->creep_rate = creep_rate(curve, &h);
    out->time_to_rupture = out->recovered_fraction = (double)NAN;
    int fallen = h.last;
    while (fallen < curve->count && load(curve, fallen) / h.stress >= 0.5) ++fallen;
    if (fallen == curve->count) return SN_OK; // ended under the stress
    if (strain(curve, fallen) / reached > 1.0)
        out->time_to_rupture = curve->time[h.last] - curve->time[h.first];
    else
        out->recovered_fraction = 1.0 - strain(curve, curve->count - 1) / reached;
    return SN_OK;
}
