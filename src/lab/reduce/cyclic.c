// Hysteresis of the cycles of a curve.
// SPDX-License-Identifier: Apache-2.0
// Source: the paper's hysteresis, loop area over the area under the loading curve.
//
// The area under the loading curve is int T dL from the start of a cycle to its largest stretch,
// the loop area is the same integral over the whole cycle. The ratio exceeds 1 where the stress
// turns negative on the way back: the tissue pushes.
#include <math.h>
#include <stdio.h>

#include "sinew/lab.h"

static const double noise = 0.05; // of the range: smaller turns are not turns

static double area(const sn_curve *c, int first, int last) {
    double sum = 0.0;
    for (int i = first + 1; i <= last; ++i)
        sum += 0.5 * (c->stress[i] + c->stress[i - 1]) * (c->stretch[i] - c->stretch[i - 1]);
    return sum;
}

// Rows of the turns, alternating lowest and highest, the first a lowest. A turn counts once the
// stretch has come back from it by more than the noise; the last row stands for the end.
static int find_turns(const sn_curve *c, double threshold, int *turn) {
    int count = 0, extreme = 0;
    bool rising = false; // a start at the top is left out by looking for a lowest first
    for (int i = 1; i < c->count; ++i) {
        double back = c->stretch[i] - c->stretch[extreme];
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

static sn_cycle cycle_of(const sn_curve *c, int first, int peak, int last) {
    sn_cycle cycle = {.first = first, .peak = peak, .last = last};
    cycle.peak_stress = c->stress[first];
    for (int i = first; i <= last; ++i) cycle.peak_stress = fmax(cycle.peak_stress, c->stress[i]);
    cycle.loading_area = area(c, first, peak);
    cycle.loop_area = area(c, first, last);
    cycle.hysteresis =
        cycle.loading_area > 0.0 ? cycle.loop_area / cycle.loading_area : (double)NAN;
    return cycle;
}

sn_status sn_reduce_cyclic(const sn_curve *curve, sn_cycles *out) {
    SN_ASSERT(curve && out);
    *out = (sn_cycles){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a cyclic test"));
    double low = (double)INFINITY, high = -(double)INFINITY;
    for (int i = 0; i < curve->count; ++i) {
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA, "%s: the stretch is %g in every row: a cyclic test needs cycles",
                       curve->name, high);
    double threshold = noise * (high - low);
    int *turn = sn_alloc((size_t)curve->count + 1, sizeof *turn);
    out->cycle = sn_alloc((size_t)curve->count, sizeof *out->cycle);
    if (!turn || !out->cycle) {
        sn_free(turn);
        sn_cycles_release(out);
        return SN_E_MEMORY;
    }
    int turns = find_turns(curve, threshold, turn), left = turns - 1;
    for (int k = 0; k + 2 < turns; k += 2) {
        bool end = k + 2 == turns - 1; // of the record: back where the cycle started?
        if (end && curve->stretch[turn[k + 2]] > curve->stretch[turn[k]] + threshold) break;
        out->cycle[out->count++] = cycle_of(curve, turn[k], turn[k + 1], turn[k + 2]);
        left = turns - 1 - (k + 2);
    }
    if (left > 0)
        snprintf(out->remarks, sizeof out->remarks,
                 "the last cycle is not finished: %d rows after row %d left out",
                 curve->count - 1 - (out->count ? out->cycle[out->count - 1].last : 0),
                 (out->count ? out->cycle[out->count - 1].last : 0) + 1);
    sn_free(turn);
    if (out->count > 0) return SN_OK;
    sn_cycles_release(out);
    return sn_fail(SN_E_DATA,
                   "%s: no full cycle: expected the stretch to rise and come back by more than %g",
                   curve->name, threshold);
}

void sn_cycles_release(sn_cycles *cycles) {
    if (!cycles) return;
    sn_free(cycles->cycle);
    *cycles = (sn_cycles){0};
}
