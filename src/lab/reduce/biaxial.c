// Properties of a biaxial test.
// SPDX-License-Identifier: Apache-2.0
//
// A loading counts from the first row to the row with the largest sum of both nominal stresses; of
// a test with cycles that is the way to its highest peak. Moduli are slopes of least-squares lines
// through the rows whose stretch lies in the first or the last fifth of the way of that axis: both
// axes are pulled, so they are properties of this ratio, not of the tissue.
#include <math.h>

#include "lab/reduce/line.h"
#include "sinew/lab.h"

static const double window = 0.2; // part of the way of an axis
enum { ROWS_LEAST = 5 };

// slope of stress over stretch where the part of the way is in [low, high]; at least 3 rows, taken
// from the end that is meant if the window holds fewer
static double slope(int n, const double *stretch, const double *stress, double low, double high) {
    double from = stretch[0], way = stretch[n - 1] - from;
    int first = n, last = -1;
    for (int i = 0; i < n; ++i) {
        double part = (stretch[i] - from) / way;
        if (!(part >= low && part <= high)) continue;
        if (i < first) first = i;
        last = i;
    }
    if (last - first < 2) {
        first = low > 0.0 ? n - 3 : 0;
        last = first + 2;
    }
    return sn_line_through(last - first + 1, stretch + first, stress + first).slope;
}

static void reduce_axis(int n, const double *stretch, const double *stress, sn_biaxial_axis *a) {
    a->peak_stretch = stretch[n - 1];
    a->peak_stress = stress[n - 1];
    bool moves = fabs(stretch[n - 1] - stretch[0]) > 0.0;
    a->low_modulus = moves ? slope(n, stretch, stress, 0.0, window) : (double)NAN;
    a->high_modulus = moves ? slope(n, stretch, stress, 1.0 - window, 1.0) : (double)NAN;
}

static double ratio(double a, double b) {
    return b != 0.0 ? a / b : (double)NAN;
}

// work of both stresses, trapezoids
static double work(int n, const sn_curve *c) {
    double sum = 0.0;
    for (int i = 1; i < n; ++i) {
        sum += 0.5 * (c->stress[i] + c->stress[i - 1]) * (c->stretch[i] - c->stretch[i - 1]);
        sum +=
            0.5 * (c->stress_2[i] + c->stress_2[i - 1]) * (c->stretch_2[i] - c->stretch_2[i - 1]);
    }
    return sum;
}

sn_status sn_reduce_biaxial(const sn_curve *curve, sn_biaxial_result *out) {
    SN_ASSERT(curve && out);
    *out = (sn_biaxial_result){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_BIAXIAL, "a biaxial test"));
    int peak = 0;
    const double *one = curve->stress, *two = curve->stress_2;
    for (int i = 1; i < curve->count; ++i)
        if (one[i] + two[i] > one[peak] + two[peak]) peak = i;
    int n = peak + 1;
    if (n < ROWS_LEAST)
        return sn_fail(SN_E_DATA,
                       "%s: %d rows up to the largest sum of stresses: expected at least %d",
                       curve->name, n, ROWS_LEAST);
    double e1 = curve->stretch[peak] - 1.0, e2 = curve->stretch_2[peak] - 1.0;
    if (curve->stretch[peak] == curve->stretch[0] && curve->stretch_2[peak] == curve->stretch_2[0])
        return sn_fail(SN_E_DATA, "%s: no axis is pulled up to row %d", curve->name, n);
    out->peak = peak;
    reduce_axis(n, curve->stretch, one, &out->axis[0]);
    reduce_axis(n, curve->stretch_2, two, &out->axis[1]);
    out->stretch_ratio = ratio(e1, e2);
    out->stress_ratio = ratio(one[peak], two[peak]);
    double c1 = ratio(e1, one[peak]), c2 = ratio(e2, two[peak]);
    out->anisotropy = ratio(2.0 * (c2 - c1), c1 + c2);
    out->energy = work(n, curve);
    return SN_OK;
}
