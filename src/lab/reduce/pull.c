// The loading ramp of a record: cycles, holds, preload.
// SPDX-License-Identifier: Apache-2.0
//
// A ramp is the way from a lowest stretch to the next highest; turns smaller than 1 % of the range,
// or than eight times the scatter of the stretch, are noise. It starts at the last row at its
// lowest stretch and ends at the first at its highest. Where the stretch is held there, "at" means
// within 0.5 % of the way (six times the scatter where that is more), because a held stretch
// flickers and settles; whether it is held is told from how many rows stand within that band: far
// more than a steady ramp would leave there.
#include <math.h>
#include <string.h>

#include "lab/reduce/pull.h"
#include "lab/reduce/signal.h"

static const double turn_range = 0.01, turn_noise = 8.0; // a turn, of the range and the scatter
static const double band_range = 0.005, band_noise = 6.0;
static const double preload_scatters = 10.0, preload_rows = 0.05;
static const double reach = 0.9; // of the largest way: a ramp that counts

typedef struct ramp {
    int low, high; // rows of its turns
} ramp;

static double way(const sn_curve *c, ramp r) {
    return c->stretch[r.high] - c->stretch[r.low];
}

// rows of [first, last] within the band of the extreme are far more than a steady way leaves there
static bool held(const sn_curve *c, ramp r, double extreme, double band) {
    int inside = 0;
    for (int i = r.low; i <= r.high; ++i) inside += fabs(c->stretch[i] - extreme) <= band;
    double steady = band / way(c, r) * (r.high - r.low);
    return inside > 3.0 * steady + 3.0;
}

// the rows of the ramp without what was held before and after it
static void trim(const sn_curve *c, double noise, ramp *r) {
    double low = c->stretch[r->low], high = c->stretch[r->high];
    double band = fmax(band_range * (high - low), band_noise * noise);
    ramp whole = *r;
    double top = held(c, whole, high, band) ? high - band : high;
    double bottom = held(c, whole, low, band) ? low + band : low;
    for (r->high = whole.low; c->stretch[r->high] < top;) ++r->high;
    for (r->low = r->high; c->stretch[r->low] > bottom;) --r->low;
}

// all ramps; their number in *count, never 0: a record without one is one ramp
static sn_status find_ramps(const sn_curve *c, double noise, double range, ramp **ramps,
                            int *count) {
    int *turn = sn_alloc((size_t)c->count + 1, sizeof *turn);
    *ramps = sn_alloc((size_t)c->count + 1, sizeof **ramps);
    *count = 0;
    if (!turn || !*ramps) {
        sn_free(turn);
        return SN_E_MEMORY;
    }
    int turns = sn_turns(c->count, c->stretch, fmax(turn_range * range, turn_noise * noise), turn);
    for (int k = 0; k + 1 < turns; k += 2) (*ramps)[(*count)++] = (ramp){turn[k], turn[k + 1]};
    if (*count == 0) (*ramps)[(*count)++] = (ramp){0, c->count - 1};
    sn_free(turn);
    return SN_OK;
}

static sn_status choose_ramp(const sn_curve *c, const sn_tensile_def *def, double noise,
                             double range, sn_tensile *out) {
    ramp *ramps, used = {0, c->count - 1};
    sn_status status = find_ramps(c, noise, range, &ramps, &out->ramps);
    double largest = 0.0;
    for (int k = 0; status == SN_OK && k < out->ramps; ++k)
        largest = fmax(largest, way(c, ramps[k]));
    if (status == SN_OK && def->ramp > out->ramps)
        status = sn_fail(SN_E_RANGE, "%s: loading ramp %d asked for, the record has %d", c->name,
                         def->ramp, out->ramps);
    if (status == SN_OK) {
        out->ramp = def->ramp > 0 ? def->ramp : out->ramps;
        if (def->ramp == 0)
            while (way(c, ramps[out->ramp - 1]) < reach * largest) --out->ramp;
        used = ramps[out->ramp - 1];
        if (way(c, used) > 0.0) trim(c, noise, &used);
    }
    sn_free(ramps);
    out->first = used.low;
    out->last = used.high;
    return status;
}

// what of the record was not used
static void say_rest(const sn_curve *c, sn_tensile *out) {
    int before = out->first, after = c->count - 1 - out->last;
    out->discarded = before + after;
    if (out->ramps > 1)
        sn_remark(out->remarks, sizeof out->remarks, "loading ramp %d of %d used: rows %d to %d",
                  out->ramp, out->ramps, out->first + 1, out->last + 1);
    if (before > 0)
        sn_remark(out->remarks, sizeof out->remarks, "%d row(s) before the ramp left out", before);
    if (after > 0)
        sn_remark(out->remarks, sizeof out->remarks,
                  "%d row(s) after it reached its largest stretch (row %d) left out", after,
                  out->last + 1);
}

// the largest stress and the rows up to it
static sn_status find_top(const sn_curve *c, sn_pull *p) {
    int top = 0;
    for (int i = 0; i < p->rows; ++i)
        if (p->stress[i] > p->stress[top]) top = i;
    p->top = top + 1;
    p->strain_range = p->stretch[top] - p->stretch[0];
    if (p->top >= SN_PULL_MIN && p->strain_range > 0.0) return SN_OK;
    return sn_fail(SN_E_DATA,
                   "%s: largest stress at row %d, strain %g after the first row: expected a rising "
                   "curve of at least %d rows up to the largest stress",
                   c->name, p->first + top + 1, p->strain_range, (int)SN_PULL_MIN);
}

// mean stress of the rows about row i
static double mean_stress(const sn_pull *p, int i, int half) {
    int from = i > half ? i - half : 0, to = i + half < p->top ? i + half : p->top - 1;
    double x, y;
    sn_window_means(&p->sums, from, to, &x, &y);
    return y;
}

// Drops the rows under the preload. The crossing is that of the mean over as many rows as bring the
// scatter down to a tenth of the preload, a twentieth of the rows at most; where that still crosses
// more than once, the middle of its first and last crossing.
static sn_status apply_preload(const sn_curve *c, double preload, sn_pull *p, sn_tensile *out) {
    double wanted = pow(preload_scatters * p->noise / preload, 2.0), most = preload_rows * p->top;
    int half = wanted > 1.0 ? (int)ceil(0.5 * fmin(wanted, most)) : 0;
    int above = 0, below = p->top - 1;
    while (above < p->top && mean_stress(p, above, half) < preload) ++above;
    while (below >= 0 && mean_stress(p, below, half) >= preload) --below;
    if (above == p->top || above == 0 || below == p->top - 1)
        return sn_fail(SN_E_DATA,
                       "%s: the preload of %g Pa lies outside the stresses of the ramp, %g to %g "
                       "Pa: choose one between them",
                       c->name, preload, mean_stress(p, 0, half), p->stress[p->top - 1]);
    double y0 = mean_stress(p, below, half), y1 = mean_stress(p, below + 1, half);
    double zero = p->stretch[below] +
                  (preload - y0) / (y1 - y0) * (p->stretch[below + 1] - p->stretch[below]);
    if (above < below) zero = 0.5 * (p->stretch[above] + p->stretch[below]);
    int start = (above < below ? (above + below) / 2 : below) + 1;
    p->rows -= start;
    p->top -= start;
    p->first += start;
    memmove(p->stretch, p->stretch + start, (size_t)p->rows * sizeof *p->stretch);
    memmove(p->stress, p->stress + start, (size_t)p->rows * sizeof *p->stress);
    for (int i = 0; i < p->rows; ++i) p->stretch[i] /= zero;
    p->preload_stretch = zero;
    out->first += start;
    out->discarded += start;
    sn_remark(out->remarks, sizeof out->remarks, "%d row(s) under the preload left out", start);
    return find_top(c, p);
}

sn_status sn_pull_create(const sn_curve *curve, const sn_tensile_def *def, sn_pull *p,
                         sn_tensile *out) {
    *p = (sn_pull){.preload_stretch = 1.0};
    double low = curve->stretch[0], high = low;
    for (int i = 0; i < curve->count; ++i) {
        low = fmin(low, curve->stretch[i]);
        high = fmax(high, curve->stretch[i]);
    }
    if (!(high > low))
        return sn_fail(SN_E_DATA, "%s: the stretch is %g in every row: a tensile test needs a pull",
                       curve->name, high);
    SN_TRY(sn_stretch_scatter(curve, &p->stretch_noise));
    SN_TRY(choose_ramp(curve, def, p->stretch_noise, high - low, out));
    say_rest(curve, out);
    p->first = out->first;
    p->rows = out->last - out->first + 1;
    p->stretch = sn_alloc((size_t)p->rows, sizeof *p->stretch);
    p->stress = sn_alloc((size_t)p->rows, sizeof *p->stress);
    if (!p->stretch || !p->stress) return SN_E_MEMORY;
    memcpy(p->stretch, curve->stretch + p->first, (size_t)p->rows * sizeof *p->stretch);
    memcpy(p->stress, curve->stress + p->first, (size_t)p->rows * sizeof *p->stress);
    const double *along = curve->time ? curve->time + p->first : p->stretch;
    SN_TRY(sn_scatter(p->rows, along, p->stress, &p->noise));
    SN_TRY(find_top(curve, p));
    if (!sn_line_sums_create(p->rows, p->stretch, p->stress, &p->sums)) return SN_E_MEMORY;
    if (def->preload != 0.0) {
        SN_TRY(apply_preload(curve, def->preload, p, out));
        sn_line_sums_release(&p->sums);
        if (!sn_line_sums_create(p->rows, p->stretch, p->stress, &p->sums)) return SN_E_MEMORY;
    }
    out->preload_stretch = p->preload_stretch;
    out->stress_noise = p->noise;
    out->ultimate = p->first + p->top - 1;
    return SN_OK;
}

void sn_pull_release(sn_pull *p) {
    sn_free(p->stretch);
    sn_free(p->stress);
    sn_line_sums_release(&p->sums);
    *p = (sn_pull){0};
}
