// Dynamic moduli from raw sinusoids: parts of one frequency, sine fits, harmonics.
// SPDX-License-Identifier: Apache-2.0
// Source: IEEE Std 1057, four-parameter least-squares sine fit (Gauss-Newton on the frequency),
// with a drift, because a tissue that swings also relaxes; Fourier coefficients of the stress as in
// large-amplitude oscillation.
//
// Parts. The stretch is cut at its turns into ways up and down; the moments at which the ways pass
// their middle are sharp where the turns are not. Ways that follow each other in even time and with
// even size make a part. What is fitted goes from the middle of a way to the middle of another, a
// whole number of cycles later.
#include <math.h>
#include <string.h>

#include "lab/reduce/dynamic.h"
#include "lab/reduce/line.h"
#include "lab/reduce/signal.h"

static const double turn_range = 0.05, turn_noise = 8.0; // a turn, of the range and the scatter
static const double even = 0.15;                         // of half a period, of a way
static const double two_pi = 6.283185307179586476925;
static const double no_sine = 0.05; // distortion of the stretch that is said
enum { HARMONICS = 5, ROWS_PER_HARMONIC = 4, TERMS = 3 + 2 * HARMONICS, ITERATIONS = 30 };

typedef struct swing {
    double middle; // time at which it passes its middle
    double size;   // signed, of the stretch
} swing;

// row and time at which a way passes its middle for the last time
static swing swing_of(const sn_curve *c, int first, int last) {
    double from = c->stretch[first], way = c->stretch[last] - from;
    int i = last;
    while (i > first && (c->stretch[i - 1] - from) / way >= 0.5) --i;
    double x0 = (c->stretch[i - 1] - from) / way, x1 = (c->stretch[i] - from) / way;
    return (swing){c->time[i - 1] + (0.5 - x0) / (x1 - x0) * (c->time[i] - c->time[i - 1]), way};
}

static bool evenly(double value, double expected) {
    return fabs(value - expected) <= even * fabs(expected);
}

// last swing of the part that starts with swing `first`
static int part_from(int count, const swing *s, int first) {
    int last = first;
    double size = fabs(s[first].size), half = 0.0;
    while (last + 1 < count && evenly(fabs(s[last + 1].size), size)) {
        double next = s[last + 1].middle - s[last].middle;
        if (last > first && !evenly(next, half)) break;
        int n = ++last - first;
        half += (next - half) / n;
        size += (fabs(s[last].size) - size) / (n + 1);
    }
    return last;
}

// Least squares of y on terms at every row; rest is the root mean square of the residuals.
typedef void basis(double t, const double *context, int terms, double *row);
static bool fit(int n, const double *t, const double *y, int terms, basis *of,
                const double *context, double *x, double *rest) {
    double a[TERMS * TERMS] = {0}, row[TERMS], sum = 0.0;
    memset(x, 0, (size_t)terms * sizeof *x);
    for (int i = 0; i < n; ++i) {
        of(t[i], context, terms, row);
        for (int j = 0; j < terms; ++j) {
            x[j] += row[j] * (y[i] - y[0]);
            for (int k = 0; k <= j; ++k) a[j * terms + k] += row[j] * row[k];
        }
    }
    if (n <= terms || !sn_normal_solve(terms, a, x)) return false;
    for (int i = 0; i < n; ++i) {
        double off = y[i] - y[0];
        of(t[i], context, terms, row);
        for (int j = 0; j < terms; ++j) off -= row[j] * x[j];
        sum += off * off;
    }
    x[0] += y[0];
    *rest = sqrt(sum / (n - terms));
    return true;
}

// 1, drift, cos, sin, and how the sine changes with its frequency. context: w, centre, half span,
// cosine and sine amplitudes
static void sine_row(double t, const double *context, int terms, double *row) {
    double u = (t - context[1]) / context[2], phase = context[0] * (t - context[1]);
    row[0] = 1.0;
    row[1] = u;
    row[2] = cos(phase);
    row[3] = sin(phase);
    if (terms > 4) row[4] = u * (context[4] * row[2] - context[3] * row[3]);
}

// 1, drift, its bend, and harmonics; context as above
static void harmonic_row(double t, const double *context, int terms, double *row) {
    double u = (t - context[1]) / context[2], phase = context[0] * (t - context[1]);
    row[0] = 1.0;
    row[1] = u;
    row[2] = u * u - 1.0 / 3.0;
    for (int k = 1; 2 * k + 2 < terms; ++k) {
        row[2 * k + 1] = cos(k * phase);
        row[2 * k + 2] = sin(k * phase);
    }
}

// the frequency that fits the stretch best, into context[0]
static bool refine(int n, const double *t, const double *y, double *context) {
    double x[5], rest;
    if (!fit(n, t, y, 4, sine_row, context, x, &rest)) return false;
    for (int k = 0; k < ITERATIONS; ++k) {
        context[3] = x[2];
        context[4] = x[3];
        if (!fit(n, t, y, 5, sine_row, context, x, &rest)) return false;
        context[0] += x[4] / context[2];
        if (fabs(x[4] / context[2]) <= 1e-13 * context[0]) break;
    }
    return context[0] > 0.0;
}

static double distortion(int terms, const double *x) {
    double sum = 0.0;
    for (int j = 5; j < terms; ++j) sum += x[j] * x[j];
    return sqrt(sum) / hypot(x[3], x[4]);
}

// moduli of rows o->first to o->last, which hold o->cycles cycles
static bool fit_part(const sn_curve *c, sn_oscillation *o, double *motion_distortion) {
    int n = o->last - o->first + 1;
    const double *t = c->time + o->first;
    double span = t[n - 1] - t[0], l[TERMS], f[TERMS], rest;
    double context[5] = {two_pi * o->cycles / span, 0.5 * (t[0] + t[n - 1]), 0.5 * span, 0, 0};
    int harmonics = (int)(n / o->cycles / ROWS_PER_HARMONIC);
    if (harmonics > HARMONICS) harmonics = HARMONICS;
    if (harmonics < 1 || !refine(n, t, c->stretch + o->first, context)) return false;
    int terms = 3 + 2 * harmonics;
    if (!fit(n, t, c->stretch + o->first, terms, harmonic_row, context, l, &rest)) return false;
    if (!fit(n, t, c->stress + o->first, terms, harmonic_row, context, f, &rest)) return false;
    double square = l[3] * l[3] + l[4] * l[4];
    // x cos + y sin is the real part of (x - i y) exp(i w t); the modulus is the quotient
    o->frequency = context[0] / two_pi;
    o->storage_modulus = (f[3] * l[3] + f[4] * l[4]) / square;
    o->loss_modulus = (f[3] * l[4] - f[4] * l[3]) / square;
    o->storage_error = o->loss_error = rest * sqrt(2.0 / n / square);
    o->tan_delta = o->loss_modulus / o->storage_modulus;
    o->phase = atan2(o->loss_modulus, o->storage_modulus);
    o->mean_stretch = l[0];
    o->stretch_amplitude = sqrt(square);
    o->mean_stress = f[0];
    o->stress_amplitude = hypot(f[3], f[4]);
    o->harmonic_distortion = harmonics > 1 ? distortion(terms, f) : (double)NAN;
    *motion_distortion = harmonics > 1 ? distortion(terms, l) : 0.0;
    return true;
}

// rows of a part between the middles of two of its swings
static void rows_between(const sn_curve *c, double from, double to, sn_oscillation *o) {
    o->first = 0;
    while (c->time[o->first] < from) ++o->first;
    o->last = o->first;
    while (o->last + 1 < c->count && c->time[o->last + 1] < to) ++o->last;
}

static void take_part(const sn_curve *c, const swing *s, int first, int last, sn_dynamic *out) {
    int halves = last - first;
    if (halves < 4) return;
    if (halves > 6) { // the first cycle still feels what went before, the end is near the change
        halves -= 3;
        --last;
    }
    halves -= halves % 2;
    sn_oscillation *o = &out->at[out->count];
    *o = (sn_oscillation){.cycles = 0.5 * halves};
    double motion;
    rows_between(c, s[last - halves].middle, s[last].middle, o);
    if (!fit_part(c, o, &motion)) {
        sn_remark(out->remarks, sizeof out->remarks,
                  "%d rows from row %d on are too few for their %g cycles", o->last - o->first + 1,
                  o->first + 1, o->cycles);
        return;
    }
    if (motion > no_sine)
        sn_remark(out->remarks, sizeof out->remarks,
                  "the stretch at %.4g Hz is no sine: distortion %.1f %%", o->frequency,
                  100.0 * motion);
    out->discarded -= o->last - o->first + 1;
    ++out->count;
}

static sn_status find_parts(const sn_curve *c, double threshold, sn_dynamic *out) {
    int *turn = sn_alloc((size_t)c->count + 1, sizeof *turn);
    swing *s = sn_alloc((size_t)c->count + 1, sizeof *s);
    out->at = sn_alloc((size_t)c->count / 4 + 1, sizeof *out->at);
    out->discarded = c->count;
    if (turn && s && out->at) {
        int count = sn_turns(c->count, c->stretch, threshold, turn) - 1;
        for (int k = 0; k < count; ++k) s[k] = swing_of(c, turn[k], turn[k + 1]);
        for (int first = 0; first < count;) {
            int last = part_from(count, s, first);
            take_part(c, s, first, last, out);
            first = last > first ? last : first + 1;
        }
    }
    sn_status status = turn && s && out->at ? SN_OK : SN_E_MEMORY;
    sn_free(turn);
    sn_free(s);
    return status;
}

sn_status sn_reduce_oscillation(const sn_curve *curve, sn_dynamic *out) {
    SN_ASSERT(curve && out);
    *out = (sn_dynamic){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a test with sinusoids"));
    if (!curve->time)
        return sn_fail(SN_E_DATA, "%s: no time column: sinusoids need one", curve->name);
    double low = curve->stretch[0], high = low, noise;
    for (int i = 0; i < curve->count; ++i) {
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA, "%s: the stretch is %g in every row: a dynamic test needs cycles",
                       curve->name, high);
    SN_TRY(sn_stretch_scatter(curve, &noise));
    sn_status status = find_parts(curve, fmax(turn_range * (high - low), turn_noise * noise), out);
    if (status == SN_OK && out->count == 0)
        status =
            sn_fail(SN_E_DATA,
                    "%s: no sinusoids: expected at least 2 cycles of even period and size with "
                    "%d rows each",
                    curve->name, (int)ROWS_PER_HARMONIC);
    if (status != SN_OK) {
        sn_dynamic_release(out);
        return status;
    }
    sn_dynamic_finish(out);
    if (out->discarded > 0)
        sn_remark(out->remarks, sizeof out->remarks,
                  "%d row(s) outside the cycles that were fitted left out", out->discarded);
    return SN_OK;
}
