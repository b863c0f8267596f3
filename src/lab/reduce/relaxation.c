// Properties of a ramp and hold: peak, relaxed fraction, rate, the fall on log time.
// SPDX-License-Identifier: Apache-2.0
//
// Holds first: the longest runs of rows whose stretch stays in a band without drifting through it.
// What leads to a hold since the one before (or since the start) is its way in, and the last way up
// of that is the ramp; a short way back after it is the settling of an overshoot.
#include <math.h>
#include <stdio.h>

#include "lab/reduce/line.h"
#include "lab/reduce/signal.h"

static const double plateau = 0.01;   // of the change of stretch: the ramp has arrived
static const double band_noise = 6.0; // scatters: the band of a hold, and of arriving
static const double end_noise = 3.0;  // scatters: a row that has left the hold
static const double at_rest = 0.001;  // of the change of stretch: the ramp has not begun
static const double turn_range = 0.05, turn_noise = 8.0;
static const double settling = 0.3;    // of the way up: more back is no overshoot
static const double hold_least = 0.25; // of the ramp's time
static const double drift_most = 0.25; // of the band, from the first third to the last
static const double larger = 1.05;     // steps that differ by less are equal
static const int bins_per_decade = 10, end_rows = 50;
enum { HOLD_MIN = 3, SPIKE = 2 };

typedef struct hold {
    int first, last; // rows
} hold;

typedef struct step {
    int start, end, last; // rows: the ramp's first and last, the hold's last
    double held, change, overshoot;
} step;

//---- holds ---------------------------------------------------------------------------------------

static double mean(const double *value, int first, int last) {
    double sum = 0.0;
    for (int i = first; i <= last; ++i) sum += value[i];
    return sum / (last - first + 1);
}

// last row of the run from `first` that stays within a band
static int run_from(const sn_curve *c, int first, double band) {
    double low = c->stretch[first], high = low;
    int last = first;
    while (last + 1 < c->count) {
        low = fmin(low, c->stretch[last + 1]);
        high = fmax(high, c->stretch[last + 1]);
        if (high - low > band) break;
        ++last;
    }
    return last;
}

static int find_holds(const sn_curve *c, double band, hold *holds) {
    int count = 0;
    for (int first = 0; first < c->count;) {
        int last = run_from(c, first, band), third = (last - first + 1) / 3;
        double drift = third > 0 ? mean(c->stretch, last - third + 1, last) -
                                       mean(c->stretch, first, first + third - 1)
                                 : 0.0;
        if (third == 0 || fabs(drift) > drift_most * band) {
            first += (last - first) / 4 + 1; // a ramp
            continue;
        }
        hold *before = count > 0 ? &holds[count - 1] : NULL;
        if (before && first - before->last - 1 <= SPIKE &&
            fabs(mean(c->stretch, first, last) - mean(c->stretch, before->first, before->last)) <
                0.5 * band)
            before->last = last; // a spike had split it
        else
            holds[count++] = (hold){first, last};
        first = last + 1;
    }
    return count;
}

//---- ramps ---------------------------------------------------------------------------------------

// Rows at which the ramp to a hold starts and where it has its largest stretch, looked for from row
// `from` on. y and turn are scratch.
static void find_way(const sn_curve *c, int from, const hold *h, double threshold, double *y,
                     int *turn, int *start, int *top) {
    double sign = c->stretch[h->first] >= c->stretch[from] ? 1.0 : -1.0;
    int n = h->first - from + 1;
    for (int i = 0; i < n; ++i) y[i] = sign * c->stretch[from + i];
    int turns = sn_turns(n, y, threshold, turn), up = turns - 2; // the way ends at a highest
    if (turns % 2 && turns >= 3) {                               // … or comes back from one
        double back = y[turn[turns - 2]] - y[turn[turns - 1]];
        double way = y[turn[turns - 2]] - y[turn[turns - 3]];
        if (back < settling * way) up = turns - 3;
    }
    if (up < 0) up = 0;
    *start = from + turn[up];
    *top = from + turn[up + 1 < turns ? up + 1 : up];
}

// what a hold is: a turn that looks like one, a rest after an unloading, or the hold of a step
typedef enum hold_kind { TURN, REST, STEP } hold_kind;

static hold_kind find_step(const sn_curve *c, int from, const hold *h, double noise, double range,
                           double *y, int *turn, step *s) {
    int top, middle = (h->first + h->last) / 2, n = 0;
    find_way(c, from, h, fmax(turn_range * range, turn_noise * noise), y, turn, &s->start, &top);
    for (int i = middle; i <= h->last; ++i) y[n++] = c->stretch[i];
    s->last = h->last;
    s->held = sn_median(n, y);
    double rest = c->stretch[s->start], sign = s->held >= rest ? 1.0 : -1.0;
    s->change = fabs(s->held - rest);
    double band = fmax(plateau * s->change, band_noise * noise);
    if (!(s->change > band)) return REST;
    s->end = s->start;
    while (sign * (c->stretch[s->end] - s->held) < -band) ++s->end;
    int highest = s->end;
    for (int i = s->end; i <= h->first || i <= top; ++i)
        if (sign * (c->stretch[i] - c->stretch[highest]) > 0.0) highest = i;
    double over = sign * (c->stretch[highest] - s->held);
    s->overshoot = over > band ? over / s->change : 0.0;
    if (over > band) s->end = highest;
    double still = fmax(at_rest * s->change, band_noise * noise);
    while (s->start + 1 < s->end && fabs(c->stretch[s->start + 1] - rest) <= still) ++s->start;
    // the first rows of the next ramp are still within the band
    while (s->last + 1 < c->count && s->last > s->end &&
           fabs(c->stretch[s->last] - s->held) > fmax(at_rest * s->change, end_noise * noise))
        --s->last;
    double hold_s = c->time[s->last] - c->time[s->end];
    if (hold_s < hold_least * (c->time[s->end] - c->time[s->start])) return TURN;
    bool away = fabs(s->held - c->stretch[0]) > fabs(rest - c->stretch[0]);
    return away && s->last - s->end + 1 >= HOLD_MIN ? STEP : REST;
}

// the step that is used; *count steps in the record, *which of them it is, from 1
static sn_status choose_step(const sn_curve *c, double range, step *used, int *count, int *which) {
    double noise, *y = sn_alloc((size_t)c->count, sizeof *y);
    int *turn = sn_alloc((size_t)c->count + 1, sizeof *turn);
    hold *holds = sn_alloc((size_t)c->count, sizeof *holds);
    sn_status status = y && turn && holds ? sn_stretch_scatter(c, &noise) : SN_E_MEMORY;
    *count = *which = 0;
    if (status == SN_OK) {
        double band = 2.0 * fmax(plateau * range, band_noise * noise);
        int n = find_holds(c, band, holds);
        for (int k = 0, from = 0; k < n; ++k) {
            step s = {0};
            hold_kind kind = REST; // what is held from the first row on
            if (holds[k].first > 0) kind = find_step(c, from, &holds[k], noise, range, y, turn, &s);
            if (kind != TURN) from = (holds[k].first + holds[k].last) / 2; // safely within it
            if (kind != STEP) continue;
            ++*count;
            if (*which > 0 && s.change <= larger * used->change) continue;
            *used = s;
            *which = *count;
        }
    }
    sn_free(y);
    sn_free(turn);
    sn_free(holds);
    return status;
}

//---- the fall ------------------------------------------------------------------------------------

// means over tenths of a decade of the time since the peak
static void fall(const sn_curve *c, sn_relaxation_result *out) {
    int n = 0, rows = 0, bin = 0;
    double x = 0.0, y = 0.0;
    for (int i = out->peak + 1; i <= out->last; ++i) {
        double log_time = log10(c->time[i] - c->time[out->peak]);
        int here = (int)floor(log_time * bins_per_decade);
        if (rows > 0 && here != bin && n < SN_RELAXATION_POINTS - 1) {
            out->point_s[n] = x / rows;
            out->point_G[n++] = y / rows;
            x = y = 0.0;
            rows = 0;
        }
        bin = here;
        x += log_time;
        y += c->stress[i] / out->peak_stress;
        ++rows;
    }
    if (rows > 0) {
        out->point_s[n] = x / rows;
        out->point_G[n++] = y / rows;
    }
    out->points = n;
    out->rate_per_decade = -sn_line_through(n, out->point_s, out->point_G).slope;
    for (int k = 0; k < n; ++k) out->point_s[k] = pow(10.0, out->point_s[k]);
}

// stress at the end of the hold: the last row, or the end of a line through the last 2 % of the
// rows where these are several
static double final_stress(const sn_curve *c, const sn_relaxation_result *out) {
    int n = (out->last - out->end + 1) / end_rows, first = out->last - n + 1;
    if (n < 3 || first <= out->peak) return c->stress[out->last];
    sn_line_fit line = sn_line_through(n, c->time + first, c->stress + first);
    return line.intercept + line.slope * c->time[out->last];
}

static void say_rest(const sn_curve *c, sn_relaxation_result *out) {
    int before = out->start, after = c->count - 1 - out->last;
    out->discarded = before + after;
    if (out->steps > 1)
        sn_remark(out->remarks, sizeof out->remarks, "step %d of %d used, the %s: rows %d to %d",
                  out->step, out->steps, out->step == 1 ? "first of the largest" : "largest",
                  out->start + 1, out->last + 1);
    if (before > 0)
        sn_remark(out->remarks, sizeof out->remarks, "%d row(s) before the ramp left out", before);
    if (after > 0)
        sn_remark(out->remarks, sizeof out->remarks, "%d row(s) after the hold left out", after);
    if (out->overshoot > 0.0)
        sn_remark(out->remarks, sizeof out->remarks,
                  "the ramp overshoots the held stretch by %.1f %% of its way",
                  100.0 * out->overshoot);
}

sn_status sn_reduce_relaxation(const sn_curve *curve, sn_relaxation_result *out) {
    SN_ASSERT(curve && out);
    *out = (sn_relaxation_result){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a relaxation test"));
    if (!curve->time)
        return sn_fail(SN_E_DATA, "%s: no time column: a relaxation test needs one", curve->name);
    double low = curve->stretch[0], high = low;
    for (int i = 0; i < curve->count; ++i) {
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA,
                       "%s: the stretch is %g in every row: a relaxation test needs a ramp",
                       curve->name, high);
    step s = {0};
    SN_TRY(choose_step(curve, high - low, &s, &out->steps, &out->step));
    if (out->steps == 0)
        return sn_fail(SN_E_DATA,
                       "%s: no ramp with a hold: expected the stretch to change and then to stay "
                       "within %g %% of the change for at least %d rows",
                       curve->name, 100.0 * plateau, (int)HOLD_MIN);
    out->start = out->peak = s.start;
    out->end = s.end;
    out->last = s.last;
    for (int i = s.start; i <= s.last; ++i)
        if (fabs(curve->stress[i]) > fabs(curve->stress[out->peak])) out->peak = i;
    out->held_stretch = s.held;
    out->overshoot = s.overshoot;
    out->ramp_s = curve->time[s.end] - curve->time[s.start];
    out->hold_s = curve->time[s.last] - curve->time[s.end];
    out->peak_stress = curve->stress[out->peak];
    out->final_stress = final_stress(curve, out);
    out->relaxed_fraction = (out->peak_stress - out->final_stress) / out->peak_stress;
    say_rest(curve, out);
    fall(curve, out);
    return SN_OK;
}
