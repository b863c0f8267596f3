// Properties from a tensile curve: modulus, offset yield, strength, work to failure, slope against
// stress.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (13) for the slope against stress; ASTM E8 for the 0.2 % offset, ASTM D638 annex
// A1 for the toe compensation.
//
// Modulus. The curve up to its largest stress is tried for an initial straight part: the rows up to
// a quarter of the stress range (fewer where those are bent), extended while the slope of the last
// quarter of the rows taken stays within 2 % (or within three standard errors) of the slope of all.
// A J-shaped curve has no such part: where the steepest tenth of the strain is more than 10 %
// steeper than the initial rows, the modulus is the slope of that tenth (the linear region), and
// the offset is counted from where its line meets zero stress. The method used is said in words.
//
// Yield. A line with the slope of the modulus through strain 0.002 (from the zero of the modulus
// line); the first crossing after the rows of the modulus. A curve that never bends back has none.
#include <math.h>
#include <stdio.h>

#include "lab/reduce/line.h"
#include "sinew/lab.h"

static const double slope_change = 0.02, j_shape = 1.10, offset = 0.002, region = 0.10;
enum { WINDOW_MIN = 5 };

typedef struct pull {
    int rows; // up to the largest stress, and including it
    const double *stretch, *stress;
    double strain_range; // from the first row to that of the largest stress
} pull;

static sn_line_fit line_of(const pull *p, int first, int last) {
    return sn_line_through(last - first + 1, p->stretch + first, p->stress + first);
}

// The rows up to `last` are straight: their last quarter has the slope of all. The noise is that of
// the rows before the quarter, whose own scatter would take a bend for noise; the error of a slope
// goes with the power -3/2 of the number of rows.
static bool straight(const pull *p, int last) {
    int quarter = (last + 1) / 4 > 2 ? (last + 1) / 4 : 3, before = last + 1 - quarter;
    sn_line_fit all = line_of(p, 0, last), tail = line_of(p, last - quarter + 1, last);
    double noise = before > 2 ? line_of(p, 0, before - 1).slope_error : 0.0;
    noise *= pow((double)before / quarter, 1.5);
    return fabs(tail.slope - all.slope) <= fmax(slope_change * fabs(all.slope), 3.0 * noise);
}

// last row of the initial straight part, which starts at row 0
static int initial_part(const pull *p) {
    double low = p->stress[0], top = p->stress[p->rows - 1];
    int least = WINDOW_MIN - 1, last = least;
    while (last + 1 < p->rows && p->stress[last] < low + 0.25 * (top - low)) ++last;
    // a bend within the first quarter of the stress: the part ends before it
    while (last > least && !straight(p, last)) last = 3 * last / 4 > least ? 3 * last / 4 : least;
    while (last + 1 < p->rows && straight(p, last + 1)) ++last;
    return last;
}

// steepest stretch of rows that spans a tenth of the strain and has at least WINDOW_MIN rows
static sn_line_fit steepest(const pull *p, int *first, int *last) {
    sn_line_fit best = {.slope = -(double)INFINITY};
    for (int i = 0, j = 0; i < p->rows; ++i) {
        while (j < p->rows &&
               (p->stretch[j] - p->stretch[i] < region * p->strain_range || j - i + 1 < WINDOW_MIN))
            ++j;
        if (j == p->rows) break;
        sn_line_fit line = line_of(p, i, j);
        if (line.slope > best.slope) {
            best = line;
            *first = i;
            *last = j;
        }
    }
    return best;
}

static double toe_modulus(const pull *p) {
    int last = 2;
    while (last + 1 < p->rows && p->stretch[last] - p->stretch[0] < region * p->strain_range)
        ++last;
    return line_of(p, 0, last).slope;
}

// the modulus with its rows; returns its line
static sn_line_fit modulus(const pull *p, sn_tensile *out) {
    int first = 0, last = p->rows - 1, begin = initial_part(p);
    sn_line_fit initial = line_of(p, 0, begin), steep = steepest(p, &first, &last);
    out->toe_modulus = toe_modulus(p);
    out->max_slope_modulus = isfinite(steep.slope) ? steep.slope : initial.slope;
    bool j_shaped = steep.slope > j_shape * initial.slope;
    sn_line_fit line = j_shaped ? steep : initial;
    out->window_first = j_shaped ? first : 0;
    out->window_last = j_shaped ? last : begin;
    out->youngs_modulus = line.slope;
    double from = p->stretch[out->window_first] - 1.0, to = p->stretch[out->window_last] - 1.0;
    snprintf(
        out->modulus_method, sizeof out->modulus_method,
        j_shaped
            ? "J-shaped curve: least-squares slope of the steepest tenth of the strain, strain "
              "%.4g to %.4g"
            : "least-squares slope of the initial straight part, extended until the slope "
              "changes by 2 %%, strain %.4g to %.4g",
        from, to);
    return line;
}

// the whole curve is searched, past the largest stress too
static void yield(const sn_curve *curve, const sn_line_fit *line, sn_tensile *out) {
    out->yield_stress = out->yield_strain = (double)NAN;
    if (!(line->slope > 0.0)) {
        snprintf(out->reason, sizeof out->reason, "no yield: the modulus is not above 0");
        return;
    }
    double zero = -line->intercept / line->slope; // stretch where the modulus line meets 0
    double before = (double)NAN;
    for (int i = out->window_last; i < curve->count; ++i) {
        double x = curve->stretch[i];
        double above = curve->stress[i] - line->slope * (x - zero - offset);
        if (i > out->window_last && before >= 0.0 && above < 0.0) {
            double part = before / (before - above);
            double x0 = curve->stretch[i - 1], y0 = curve->stress[i - 1];
            out->yield_strain = x0 + part * (x - x0) - 1.0;
            out->yield_stress = y0 + part * (curve->stress[i] - y0);
            return;
        }
        before = above;
    }
    snprintf(
        out->reason, sizeof out->reason,
        "no intersection: the line of slope %.4g Pa from strain %.4g (0.2 %% offset) never meets "
        "the curve after strain %.4g",
        line->slope, zero + offset - 1.0, curve->stretch[out->window_last] - 1.0);
}

// area under the curve to its end, or to where the stress has fallen under a tenth of the largest
static double work(const sn_curve *curve, int ultimate) {
    double sum = 0.0;
    for (int i = 1; i < curve->count; ++i) {
        sum += 0.5 * (curve->stress[i] + curve->stress[i - 1]) *
               (curve->stretch[i] - curve->stretch[i - 1]);
        if (i > ultimate && curve->stress[i] < 0.1 * curve->stress[ultimate]) break;
    }
    return sum;
}

// Regression of the slope on the stress (equation 13). The slope at a row is that of a line through
// the rows about it, 1 % of the rows: for an exponential curve such a slope is the true one times
// 1 + (B d)^2/10, d half the span, so the regression is not bent.
static sn_status slope_stress(const pull *p, sn_tensile *out) {
    int half = p->rows / 200 > 1 ? p->rows / 200 : 1, count = 0;
    double *slope = sn_alloc(2 * (size_t)p->rows, sizeof *slope);
    if (!slope) return SN_E_MEMORY;
    double *stress = slope + p->rows;
    for (int i = half; i + half < p->rows; ++i) {
        double local = line_of(p, i - half, i + half).slope, mean = 0.0;
        for (int j = i - half; j <= i + half; ++j) mean += p->stress[j] / (2 * half + 1);
        if (!isfinite(local)) continue; // the machine stood still
        slope[count] = local;
        stress[count++] = half > 1 ? mean : p->stress[i];
    }
    sn_line_fit line = sn_line_through(count, stress, slope);
    out->B = line.slope;
    out->C = line.intercept;
    out->slope_r_squared = line.r_squared;
    sn_free(slope);
    return SN_OK;
}

sn_status sn_reduce_tensile(const sn_curve *curve, sn_tensile *out) {
    SN_ASSERT(curve && out);
    *out = (sn_tensile){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a tensile test"));
    int ultimate = 0;
    double low = (double)INFINITY, high = -(double)INFINITY;
    for (int i = 0; i < curve->count; ++i) {
        if (curve->stress[i] > curve->stress[ultimate]) ultimate = i;
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA, "%s: the stretch is %g in every row: a tensile test needs a pull",
                       curve->name, high);
    pull p = {.rows = ultimate + 1, .stretch = curve->stretch, .stress = curve->stress};
    p.strain_range = p.stretch[ultimate] - p.stretch[0];
    if (p.rows < WINDOW_MIN || !(p.strain_range > 0.0))
        return sn_fail(SN_E_DATA,
                       "%s: largest stress at row %d, strain %g after the first row: expected a "
                       "rising curve of at least %d rows up to the largest stress",
                       curve->name, ultimate + 1, p.strain_range, (int)WINDOW_MIN);
    sn_line_fit line = modulus(&p, out);
    yield(curve, &line, out);
    out->ultimate_tensile_strength = curve->stress[ultimate];
    out->strain_at_ultimate = curve->stretch[ultimate] - 1.0;
    out->work_to_failure = work(curve, ultimate);
    return slope_stress(&p, out);
}
