// Properties of a ramp and hold: peak, relaxed fraction, rate.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>

#include "lab/reduce/line.h"
#include "sinew/lab.h"

static const double plateau = 0.01;  // of the change of stretch
static const double at_rest = 0.001; // of the change of stretch

// fall of stress over the peak per decade of the time since the peak, by least squares
static sn_status rate_per_decade(const sn_curve *c, int peak, double *rate) {
    int n = c->count - peak - 1;
    double *x = sn_alloc(2 * (size_t)(n > 0 ? n : 1), sizeof *x);
    if (!x) return SN_E_MEMORY;
    for (int i = 0; i < n; ++i) {
        x[i] = log10(c->time[peak + 1 + i] - c->time[peak]);
        x[n + i] = c->stress[peak + 1 + i] / c->stress[peak];
    }
    *rate = -sn_line_through(n, x, x + n).slope;
    sn_free(x);
    return SN_OK;
}

sn_status sn_reduce_relaxation(const sn_curve *curve, sn_relaxation_result *out) {
    SN_ASSERT(curve && out);
    *out = (sn_relaxation_result){0};
    SN_TRY(sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "a relaxation test"));
    if (!curve->time)
        return sn_fail(SN_E_DATA, "%s: no time column: a relaxation test needs one", curve->name);
    int n = curve->count, start = 0, end = 0, peak = 0;
    double from = curve->stretch[0], held = curve->stretch[n - 1], change = fabs(held - from);
    if (!(change > 0.0))
        return sn_fail(SN_E_DATA,
                       "%s: the last stretch equals the first, %g: a relaxation test needs a ramp",
                       curve->name, from);
    while (fabs(curve->stretch[end] - held) > plateau * change) ++end;
    while (start + 1 < end && fabs(curve->stretch[start + 1] - from) <= at_rest * change) ++start;
    for (int i = end; i < n; ++i)
        if (fabs(curve->stretch[i] - held) > plateau * change)
            return sn_fail(SN_E_DATA,
                           "%s: row %d: stretch %g leaves the plateau of %g reached at row %d: "
                           "expected one ramp and hold",
                           curve->name, i + 1, curve->stretch[i], held, end + 1);
    if (n - end < 3)
        return sn_fail(SN_E_DATA,
                       "%s: %d rows at the final stretch %g: a relaxation test needs a hold of at "
                       "least 3 rows",
                       curve->name, n - end, held);
    for (int i = 0; i < n; ++i)
        if (fabs(curve->stress[i]) > fabs(curve->stress[peak])) peak = i;
    out->ramp_s = curve->time[end] - curve->time[start];
    out->peak_stress = curve->stress[peak];
    out->final_stress = curve->stress[n - 1];
    out->relaxed_fraction = (out->peak_stress - out->final_stress) / out->peak_stress;
    return rate_per_decade(curve, peak, &out->rate_per_decade);
}
