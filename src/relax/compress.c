// A memory as the fewest exponentials that keep a stated error over a band of times.
// SPDX-License-Identifier: Apache-2.0
//
// A finite sum keeps its terms, less those that the band cannot tell apart. A continuous spectrum
// starts from its expansion (some 30 terms), is gathered into N cells of equal width in ln tau, and
// improved by minimax.c; N grows from 0 until the error is reached. Where minimax.c no longer helps
// (errors below about 1e-6) the expansion itself, as short as the tolerance allows, is the answer.
//
// The error between the points of a grid is bounded, not hoped for. In x = ln t every exponential
// has |d3/dx3 exp(-z)| = |z^3 - 3z^2 + z| exp(-z) between -0.387 and 0.430 (z = t/tau). The error
// is a difference of two completely monotone functions, each with at most the mass W = 1 - g_inf,
// so |e'''| <= 0.82 W. On three points a step h apart the parabola through them is off by at most
// h^3/(9 sqrt 3) |e'''|; the largest |parabola| is known exactly. The step is chosen so that the
// remainder is 1 % of the tolerance (at least 200 points a decade); the remainder is part of
// max_error.
#include "relax/minimax.h"

#include "relax/laws.h"

#include <math.h>
#include <string.h>

// a search that gained less than a fifth so many times below this error has come to its end
#define STALL_ERROR 1e-4
#define STALL_COUNT 2
#define SEARCH_TOLERANCE 1e-7 // below it the search ends at a few terms: more would only creep
#define SEARCH_FEW 4
#define BAND_MAX 1e30 // t_max/t_min: no test is that long, and its logarithm stays sound
#define STEP_MAX (M_LN10 / 200)
#define THIRD_DERIVATIVE 0.82
#define REMAINDER (0.0641500299 * THIRD_DERIVATIVE) // 1/(9 sqrt 3)

// largest |parabola| through (-1, a), (0, b), (1, c) within [-1, 1]
static double parabola_peak(double a, double b, double c) {
    double peak = fmax(fabs(a), fmax(fabs(b), fabs(c)));
    double slope = 0.5 * (c - a), bend = a - 2 * b + c;
    if (fabs(slope) < fabs(bend)) peak = fmax(peak, fabs(b - 0.5 * slope * slope / bend));
    return peak;
}

// a bound on |e - G| for all t of [t_min, t_max]; gives up above `enough`
static double band_error(const sn_memory *memory, const sn_exponentials *e, double t_min,
                         double t_max, double enough) {
    double W = 1 - fmin(e->g_inf, sn_memory_equilibrium(memory));
    double remainder = 0.01 * fmax(enough, 1e-10), length = log(t_max / t_min);
    double step = fmin(STEP_MAX, cbrt(remainder / (REMAINDER * fmax(W, 1e-3))));
    int intervals = 2 * (int)ceil(0.5 * length / step);
    double v[3] = {0}, peak = 0;
    for (int k = 0; k <= intervals && peak + remainder <= enough; k++) {
        double t = k < intervals ? t_min * exp(length * k / intervals) : t_max;
        v[k % 2 ? 1 : (k % 4 ? 2 : 0)] = sn_exponentials_at(e, t) - sn_memory_relaxation(memory, t);
        if (k > 0 && k % 2 == 0) peak = fmax(peak, parabola_peak(v[0], v[1], v[2]));
    }
    return peak + remainder;
}

static void swap_terms(sn_exponentials *e, int i, int j) {
    double g = e->g[i], tau = e->tau[i];
    e->g[i] = e->g[j], e->tau[i] = e->tau[j];
    e->g[j] = g, e->tau[j] = tau;
}

// terms in the order of their times
static void sort_terms(sn_exponentials *e) {
    for (int i = 1; i < e->terms; i++)
        for (int j = i; j > 0 && e->tau[j] < e->tau[j - 1]; j--) swap_terms(e, j, j - 1);
}

// Takes from a sum of exponentials the terms that the band cannot see: those that have not begun
// to relax at its end become part of g_inf; of those that are over at its beginning all but the
// slowest join the slowest. Both make the sum larger than G, by what is added up here: the first
// most at t_max, the second (for tau < t_min) most at t_min.
// Returns the largest error in the band.
static double drop_unseen(sn_exponentials *e, double t_min, double t_max, double tolerance) {
    double spent = 0;
    sort_terms(e);
    while (e->terms > 0) {
        int last = e->terms - 1;
        double cost = -e->g[last] * expm1(-t_max / e->tau[last]);
        if (e->tau[last] < t_max || spent + cost > tolerance) break;
        spent += cost;
        e->g_inf += e->g[last];
        e->terms--;
    }
    while (e->terms > 1 && e->tau[1] < t_min) {
        double cost = e->g[0] * (exp(-t_min / e->tau[1]) - exp(-t_min / e->tau[0]));
        if (spent + cost > tolerance) break;
        spent += cost;
        e->g[1] += e->g[0];
        e->terms--;
        for (int i = 0; i < e->terms; i++) {
            e->g[i] = e->g[i + 1];
            e->tau[i] = e->tau[i + 1];
        }
    }
    return spent;
}

// Share of the interval [a, b] that lies within [low, high].
static double overlap(double a, double b, double low, double high) {
    return fmax(0, fmin(b, high) - fmax(a, low)) / (b - a);
}

// Gathers many terms into n: equal cells of ln tau over what the band sees, each with the weight
// and the mean ln tau of what falls into it. Every term counts as spread evenly up to half way to
// its neighbours, else a cell would hold two or three of them by chance. What is faster than the
// cells joins the first, what is slower g_inf.
static sn_exponentials gather(const sn_exponentials *full, int n, double t_min, double t_max) {
    sn_exponentials out = {.terms = n, .g_inf = full->g_inf};
    int last = full->terms - 1;
    double low = log(fmax(full->tau[0], t_min / 5));
    double high = fmax(low + 0.1 * n, log(fmin(full->tau[last], t_max * 5)));
    double width = (high - low) / n, mean[SN_TERMS_MAX] = {0};
    for (int i = 0; i <= last; i++) {
        double u = log(full->tau[i]);
        double a = i > 0 ? 0.5 * (u + log(full->tau[i - 1])) : u - 1e-3;
        double b = i < last ? 0.5 * (u + log(full->tau[i + 1])) : u + 1e-3;
        for (int k = 0; k < n; k++) {
            double from = low + k * width, begin = k > 0 ? from : -(double)INFINITY;
            double mass = full->g[i] * overlap(a, b, begin, from + width);
            out.g[k] += mass;
            mean[k] += mass * fmin(u, from + 0.5 * width);
        }
        out.g_inf += full->g[i] * overlap(a, b, high, INFINITY);
    }
    double total = out.g_inf = fmax(out.g_inf, 1e-9); // a weight of 0 could never grow
    for (int k = 0; k < n; k++) {
        double centre = low + (k + 0.5) * width;
        out.tau[k] = exp(k == 0 && out.g[k] > 0 ? mean[k] / out.g[k] : centre);
        out.g[k] = fmax(out.g[k], 1e-9);
        total += out.g[k];
    }
    for (int k = 0; k < n; k++) out.g[k] /= total;
    out.g_inf /= total;
    return out;
}

// The grid of the search: the band, less what lies so far from the spectrum of `full` that G moves
// by less than the goal there.
static void set_grid(sn_minimax *m, const sn_memory *memory, const sn_exponentials *full,
                     double t_min, double t_max) {
    double from = fmin(fmax(t_min, m->goal * full->tau[0]), 0.5 * t_max);
    double to = fmax(fmin(t_max, 30 * full->tau[full->terms - 1]), 2 * from);
    from = fmax(from, t_min), to = fmin(to, t_max);
    double length = log(to / from);
    int points = 1 + (int)ceil(length / M_LN10 * 24);
    m->points = points < 40 ? 40 : points > SN_MINIMAX_POINTS ? SN_MINIMAX_POINTS : points;
    for (int k = 0; k < m->points; k++) {
        m->t[k] = from * exp(length * k / (m->points - 1));
        m->target[k] = sn_memory_relaxation(memory, m->t[k]);
    }
}

// Puts into `out` fewer terms than it has, where minimax.c finds such that keep the tolerance over
// its band; else leaves it alone.
static void search(sn_minimax *m, const sn_memory *memory, double tolerance, sn_exponentials *out) {
    double t_min = out->t_min, t_max = out->t_max, before = (double)INFINITY;
    int stalled = 0;
    sn_exponentials full;
    sn_memory_expand(memory, &full);
    m->goal = 0.98 * tolerance; // room for the remainder and for peaks between its points
    set_grid(m, memory, &full, t_min, t_max);
    int most = tolerance < SEARCH_TOLERANCE ? SEARCH_FEW : SN_MINIMAX_TERMS;
    for (int n = 0; n < out->terms && n <= most; n++) {
        sn_exponentials trial = {.g_inf = 1};
        if (n > 0) {
            trial = gather(&full, n, t_min, t_max);
            double error = sn_minimax_improve(m, &trial);
            if (error < STALL_ERROR && error > 0.8 * before && ++stalled == STALL_COUNT) return;
            before = fmin(error, before);
            if (error > m->goal) continue;
        }
        trial.max_error = band_error(memory, &trial, t_min, t_max, tolerance);
        if (trial.max_error > tolerance) continue;
        *out = trial;
        out->t_min = t_min;
        out->t_max = t_max;
        return;
    }
}

static sn_status check_band(double t_min, double t_max, double tolerance) {
    if (!(t_min > 0 && t_min < t_max && t_max / t_min < BAND_MAX))
        return sn_fail(
            SN_E_RANGE,
            "a band from %g s to %g s: expected 0 < from < to, less than 30 decades apart", t_min,
            t_max);
    if (!(tolerance > 0))
        return sn_fail(SN_E_RANGE, "a tolerance of %g: expected more than 0", tolerance);
    return SN_OK;
}

sn_status sn_memory_compress(const sn_memory *memory, double t_min, double t_max, double tolerance,
                             sn_exponentials *out) {
    memset(out, 0, sizeof *out);
    SN_TRY(sn_memory_check(memory));
    SN_TRY(check_band(t_min, t_max, tolerance));
    // a sum that is good at every time, with an error to spare for what the band does not see
    memory->law->expand(memory->value, memory->terms, 0.5 * tolerance, out);
    bool finite_sum = out->max_error == 0;
    if (out->max_error < tolerance)
        out->max_error += drop_unseen(out, t_min, t_max, tolerance - out->max_error);
    out->t_min = t_min;
    out->t_max = t_max;
    if (!finite_sum) {
        sn_minimax *m = sn_alloc(1, sizeof *m);
        if (!m) return SN_E_MEMORY;
        search(m, memory, tolerance, out);
        sn_free(m);
    }
    if (out->max_error > tolerance)
        return sn_fail(SN_E_RANGE,
                       "memory %s: %d exponentials keep an error of %.2g, not %.2g, from %g s to "
                       "%g s: ask for a larger tolerance",
                       memory->law->name, out->terms, out->max_error, tolerance, t_min, t_max);
    sort_terms(out);
    return SN_OK;
}
