// Hysteresis of the cycles of a curve.
// SPDX-License-Identifier: Apache-2.0
// Source: the paper's hysteresis, loop area over the area under the loading curve.
//
// The area under the loading curve is int T dL from the start of a cycle to its largest stretch,
// the loop area is the same integral over the whole cycle. The ratio exceeds 1 where the stress
// turns negative on the way back: the tissue pushes.
#include <math.h>
#include <stdio.h>

#include "lab/reduce/signal.h"

static const double turn_range = 0.05, turn_noise = 8.0; // a turn, of the range and the scatter
static const double settled = 0.02;                      // change from cycle to cycle
static const double settled_hysteresis = 0.002;          // where there is hardly any

static double area(const sn_curve *c, int first, int last) {
    double sum = 0.0;
    for (int i = first + 1; i <= last; ++i)
        sum += 0.5 * (c->stress[i] + c->stress[i - 1]) * (c->stretch[i] - c->stretch[i - 1]);
    return sum;
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

static double change(double before, double after) {
    return before != 0.0 ? (after - before) / fabs(before) : (double)NAN;
}

static bool same(const sn_cycle *before, const sn_cycle *after) {
    double off = fabs(after->hysteresis - before->hysteresis);
    return fabs(change(before->peak_stress, after->peak_stress)) <= settled &&
           (off <= settled * fabs(before->hysteresis) || off <= settled_hysteresis);
}

static void preconditioning(sn_cycles *out) {
    const sn_cycle *cycle = out->cycle;
    int n = out->count;
    out->peak_change = out->hysteresis_change = (double)NAN;
    if (n < 2) {
        snprintf(out->reason, sizeof out->reason, "one cycle: nothing to compare it with");
        return;
    }
    out->peak_change = change(cycle[n - 2].peak_stress, cycle[n - 1].peak_stress);
    out->hysteresis_change = change(cycle[n - 2].hysteresis, cycle[n - 1].hysteresis);
    int first = n - 1;
    while (first > 0 && same(&cycle[first - 1], &cycle[first])) --first;
    if (first < n - 1)
        out->preconditioned_after = first + 1;
    else
        snprintf(out->reason, sizeof out->reason,
                 "from cycle %d to %d the peak stress changes by %.2g %% and the hysteresis by "
                 "%.2g %%: settled is up to %g %%",
                 n - 1, n, 100.0 * out->peak_change, 100.0 * out->hysteresis_change,
                 100.0 * settled);
}

// full cycles from the turns, and what is left over
static void split(const sn_curve *c, int turns, const int *turn, double threshold, sn_cycles *out) {
    for (int k = 0; k + 2 < turns; k += 2) {
        bool end = k + 2 == turns - 1; // of the record: back where the cycle started?
        if (end && c->stretch[turn[k + 2]] > c->stretch[turn[k]] + threshold) break;
        out->cycle[out->count++] = cycle_of(c, turn[k], turn[k + 1], turn[k + 2]);
    }
    if (out->count == 0) return;
    int before = out->cycle[0].first, last = out->cycle[out->count - 1].last;
    if (before > 0)
        sn_remark(out->remarks, sizeof out->remarks,
                  "%d row(s) before the first lowest stretch left out", before);
    if (turns - 1 > 2 * out->count)
        sn_remark(out->remarks, sizeof out->remarks,
                  "the last cycle is not finished: %d rows after row %d left out",
                  c->count - 1 - last, last + 1);
    else if (last + 1 < c->count)
        sn_remark(out->remarks, sizeof out->remarks, "%d row(s) after the last cycle left out",
                  c->count - 1 - last);
    out->discarded = before + c->count - 1 - last;
}

sn_status sn_reduce_cyclic(const sn_curve *curve, sn_cycles *out) {
    SN_ASSERT(curve && out);
    *out = (sn_cycles){0};
    double low = (double)INFINITY, high = -(double)INFINITY, noise;
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a cyclic test"));
    for (int i = 0; i < curve->count; ++i) {
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA, "%s: the stretch is %g in every row: a cyclic test needs cycles",
                       curve->name, high);
    SN_TRY(sn_stretch_scatter(curve, &noise));
    double threshold = fmax(turn_range * (high - low), turn_noise * noise);
    int *turn = sn_alloc((size_t)curve->count + 1, sizeof *turn);
    out->cycle = sn_alloc((size_t)curve->count, sizeof *out->cycle);
    if (!turn || !out->cycle) {
        sn_free(turn);
        sn_cycles_release(out);
        return SN_E_MEMORY;
    }
    split(curve, sn_turns(curve->count, curve->stretch, threshold, turn), turn, threshold, out);
    sn_free(turn);
    preconditioning(out);
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
