// Properties from a tensile curve: modulus, offset yield, strength, work to failure, slope against
// stress.
// SPDX-License-Identifier: Apache-2.0
// Source: ASTM E8 for the 0.2 % offset, ASTM D638 annex A1 for the toe compensation.
//
// Modulus. The curve up to its largest stress is tried for an initial straight part: the rows up to
// a quarter of the stress range (fewer where those are bent), extended while the slope of the last
// quarter of the rows taken stays within 2 % (or within three standard errors) of the slope of all.
// A J-shaped curve has no such part: where the steepest tenth of the strain is more than 10 %
// (and four standard errors) steeper than the initial rows, the modulus is the slope of that tenth
// (the linear region), and the offset is counted from where its line meets zero stress. The method
// used is said in words.
//
// Yield. A line with the slope of the modulus through strain 0.002 (from the zero of the modulus
// line); the first crossing after the rows of the modulus. A curve that never bends back has none,
// nor has one that meets the line only in the fall of its failure.
// What is compared with the line is the mean over as many rows as bring the scatter down to a fifth
// of the height of the line under the curve, slope times 0.002; where that takes more than a
// twentieth of the rows, the noise hides the offset and there is no yield but a reason.
#include <math.h>
#include <stdio.h>

#include "lab/reduce/pull.h"

static const double slope_change = 0.02, j_shape = 1.10, offset = 0.002, region = 0.10;
static const double steepest_errors = 4.0; // the steepest of many windows is so by chance, too
static const double yield_errors = 5.0, smooth_most = 0.05;
static const double failure = 0.10; // of the stress, lost from one row to the next

static sn_line_fit line_of(const sn_pull *p, int first, int last) {
    return sn_line_window(&p->sums, first, last);
}

// The rows up to `last` are straight: their last quarter has the slope of all. The noise is that of
// the rows before the quarter, whose own scatter would take a bend for noise; the error of a slope
// goes with the power -3/2 of the number of rows.
static bool straight(const sn_pull *p, int last) {
    int quarter = (last + 1) / 4 > 2 ? (last + 1) / 4 : 3, before = last + 1 - quarter;
    sn_line_fit all = line_of(p, 0, last), tail = line_of(p, last - quarter + 1, last);
    double noise = before > 2 ? line_of(p, 0, before - 1).slope_error : 0.0;
    noise *= pow((double)before / quarter, 1.5);
    return fabs(tail.slope - all.slope) <= fmax(slope_change * fabs(all.slope), 3.0 * noise);
}

// last row of the initial straight part, which starts at row 0
static int initial_part(const sn_pull *p) {
    double low = p->stress[0], top = p->stress[p->top - 1];
    int least = SN_PULL_MIN - 1, last = least, under = p->top - 1;
    while (last + 1 < p->top && p->stress[last] < low + 0.25 * (top - low)) ++last;
    while (under > last && p->stress[under] >= low + 0.25 * (top - low)) --under;
    last = (last + under) / 2; // scatter takes the curve across more than once
    // a bend within the first quarter of the stress: the part ends before it
    while (last > least && !straight(p, last)) last = 3 * last / 4 > least ? 3 * last / 4 : least;
    while (last + 1 < p->top && straight(p, last + 1)) ++last;
    return last;
}

// steepest stretch of rows that spans a tenth of the strain and has at least SN_PULL_MIN rows
static sn_line_fit steepest(const sn_pull *p, int *first, int *last) {
    sn_line_fit best = {.slope = -(double)INFINITY};
    for (int i = 0, j = 0; i < p->top; ++i) {
        while (j < p->top && (p->stretch[j] - p->stretch[i] < region * p->strain_range ||
                              j - i + 1 < SN_PULL_MIN))
            ++j;
        if (j == p->top) break;
        sn_line_fit line = line_of(p, i, j);
        if (line.slope > best.slope) {
            best = line;
            *first = i;
            *last = j;
        }
    }
    return best;
}

// standard error of a slope from the scatter alone: that about the line holds its bend as well
static double noise_error(const sn_pull *p, int first, int last) {
    double width = p->stretch[last] - p->stretch[first];
    return p->noise * sqrt(12.0 / (last - first + 1)) / width;
}

static double toe_modulus(const sn_pull *p) {
    int last = 2;
    while (last + 1 < p->top && p->stretch[last] - p->stretch[0] < region * p->strain_range) ++last;
    return line_of(p, 0, last).slope;
}

// the rows up to the largest stress between two strains
static sn_status asked_window(const sn_curve *curve, const sn_pull *p, const sn_tensile_def *def,
                              int *first, int *last) {
    *first = 0;
    *last = p->top - 1;
    while (*first < p->top && p->stretch[*first] - 1.0 < def->from) ++*first;
    while (*last >= 0 && p->stretch[*last] - 1.0 > def->to) --*last;
    if (*last - *first >= 2) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "%s: %d rows between strain %g and %g: a window of the modulus needs 3 between "
                   "%g and %g, where the loading ramp and its largest stress are",
                   curve->name, *last >= *first ? *last - *first + 1 : 0, def->from, def->to,
                   p->stretch[0] - 1.0, p->stretch[p->top - 1] - 1.0);
}

// the modulus with its rows, counted in the pull; *line is its line
static sn_status modulus(const sn_curve *curve, const sn_pull *p, const sn_tensile_def *def,
                         sn_tensile *out, sn_line_fit *line) {
    int first = 0, last = p->top - 1, begin = initial_part(p);
    sn_line_fit initial = line_of(p, 0, begin), steep = steepest(p, &first, &last);
    out->toe_modulus = toe_modulus(p);
    out->max_slope_modulus = isfinite(steep.slope) ? steep.slope : initial.slope;
    double chance = steepest_errors * hypot(noise_error(p, first, last), noise_error(p, 0, begin));
    bool asked = isfinite(def->from),
         j_shaped = steep.slope > j_shape * initial.slope && steep.slope > initial.slope + chance;
    const char *method = "J-shaped curve: least-squares slope of the steepest tenth of the strain";
    if (asked) {
        SN_TRY(asked_window(curve, p, def, &first, &last));
        method = "least-squares slope of the chosen window";
    } else if (!j_shaped) {
        first = 0;
        last = begin;
        method = "least-squares slope of the initial straight part, extended until the slope "
                 "changes by 2 %";
    }
    *line = line_of(p, first, last);
    out->window_first = first;
    out->window_last = last;
    out->youngs_modulus = line->slope;
    out->youngs_modulus_error = line->slope_error;
    out->chord_modulus =
        (p->stress[last] - p->stress[first]) / (p->stretch[last] - p->stretch[first]);
    snprintf(out->modulus_method, sizeof out->modulus_method, "%s, strain %.4g to %.4g", method,
             p->stretch[first] - 1.0, p->stretch[last] - 1.0);
    return SN_OK;
}

// how far the curve stands over the offset line at row i, mean over the rows about it
static double above_line(const sn_pull *p, const sn_line_fit *line, int i, int half) {
    int from = i > half ? i - half : 0, to = i + half < p->rows ? i + half : p->rows - 1;
    double zero = -line->intercept / line->slope + offset, x, y;
    sn_window_means(&p->sums, from, to, &x, &y);
    return y - line->slope * (x - zero);
}

// rows to both sides that the comparison with the offset line averages over; -1: noise hides it
static int yield_smoothing(const sn_pull *p, const sn_line_fit *line) {
    double noise = hypot(p->noise, line->slope * p->stretch_noise);
    double rows = pow(yield_errors * noise / (line->slope * offset), 2.0);
    if (rows <= 1.0) return 0;
    return rows > smooth_most * p->rows ? -1 : (int)ceil(0.5 * (rows - 1.0));
}

// the whole ramp is searched, past the largest stress too
static void yield(const sn_pull *p, const sn_line_fit *line, sn_tensile *out) {
    out->yield_stress = out->yield_strain = (double)NAN;
    if (!(line->slope > 0.0)) {
        snprintf(out->reason, sizeof out->reason, "no yield: the modulus is not above 0");
        return;
    }
    int half = yield_smoothing(p, line);
    if (half < 0) {
        snprintf(out->reason, sizeof out->reason,
                 "the scatter of %.3g Pa hides a 0.2 %% offset, which is %.3g Pa at this modulus",
                 p->noise, line->slope * offset);
        return;
    }
    double zero = -line->intercept / line->slope; // stretch where the modulus line meets 0
    double before = (double)NAN;
    for (int i = out->window_last; i + half < p->rows; ++i) {
        double above = above_line(p, line, i, half);
        if (before >= 0.0 && above < 0.0) {
            if (i >= p->top && p->stress[i] < (1.0 - failure) * p->stress[i - 1]) {
                snprintf(out->reason, sizeof out->reason,
                         "no yield: the curve meets the 0.2 %% offset line only where the specimen "
                         "fails, strain %.4g",
                         p->stretch[i] - 1.0);
                return;
            }
            double part = before / (before - above), x0 = p->stretch[i - 1];
            double x = x0 + part * (p->stretch[i] - x0);
            out->yield_strain = x - 1.0;
            out->yield_stress = line->slope * (x - zero - offset);
            return;
        }
        before = above;
    }
    snprintf(
        out->reason, sizeof out->reason,
        "no intersection: the line of slope %.4g Pa from strain %.4g (0.2 %% offset) never meets "
        "the curve after strain %.4g",
        line->slope, zero + offset - 1.0, p->stretch[out->window_last] - 1.0);
}

// area under the ramp to its end, or to where the stress has fallen under a tenth of the largest
static double work(const sn_pull *p) {
    double sum = 0.0;
    for (int i = 1; i < p->rows; ++i) {
        sum += 0.5 * (p->stress[i] + p->stress[i - 1]) * (p->stretch[i] - p->stretch[i - 1]);
        if (i >= p->top && p->stress[i] < 0.1 * p->stress[p->top - 1]) break;
    }
    return sum;
}

static sn_status reduce(const sn_curve *curve, const sn_tensile_def *def, const sn_pull *p,
                        sn_tensile *out) {
    sn_line_fit line;
    SN_TRY(modulus(curve, p, def, out, &line));
    yield(p, &line, out);
    out->window_first += p->first;
    out->window_last += p->first;
    out->ultimate_tensile_strength = p->stress[p->top - 1];
    out->strain_at_ultimate = p->stretch[p->top - 1] - 1.0;
    out->work_to_failure = work(p);
    return sn_pull_slopes(p, out);
}

sn_tensile_def sn_tensile_def_default(void) {
    return (sn_tensile_def){.from = (double)NAN, .to = (double)NAN};
}

sn_status sn_reduce_tensile(const sn_curve *curve, const sn_tensile_def *def, sn_tensile *out) {
    SN_ASSERT(curve && out);
    sn_tensile_def standard = sn_tensile_def_default();
    *out = (sn_tensile){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a tensile test"));
    sn_pull pull;
    sn_status status = sn_pull_create(curve, def ? def : &standard, &pull, out);
    if (status == SN_OK) status = reduce(curve, def ? def : &standard, &pull, out);
    sn_pull_release(&pull);
    if (status != SN_OK) sn_tensile_release(out);
    return status;
}

void sn_tensile_release(sn_tensile *tensile) {
    if (!tensile) return;
    sn_free(tensile->slope);
    sn_free(tensile->slope_stress);
    *tensile = (sn_tensile){0};
}
