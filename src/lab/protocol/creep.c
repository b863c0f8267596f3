// Stretch under a prescribed force: the hereditary integral solved for the stretch.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (30)-(35) with (32): the Volterra equation T(t) = P(t) for the stretch.
//
// In a step the elastic channels are taken as straight lines in time, so that their hereditary
// integrals are affine in what they are at its end, H[f] = a f + b, and the equation for the new
// stretch is one of the elastic law alone; Newton solves it. That is of second order for any
// relaxation time (first under a Voigt memory, whose rate is a backward difference); Romberg's
// table removes the powers, as in uniaxial.c. A solid whose sides must be solved for as well, or
// whose parts have a memory each, is the block of lateral.c, loaded on its first face.
//
// After a corner of the load the stretch moves on every time scale of the memory, so each straight
// piece of the load is cut at the times that halve towards its start, 24 times.
#include <math.h>
#include <string.h>

#include "lab/protocol/path.h"
#include "lab/protocol/protocol.h"
#include "lab/protocol/refine.h"

enum { CHANNELS = 2, HALVINGS = 24, NEWTON_MAX = 100 };
static const double tolerance = 1e-7; // of the largest strain

typedef struct specimen {
    const sn_tissue *tissue;
    sn_pull pull;
    const sn_exponentials *e;
    int channels;
    double stretch, value[CHANNELS];  // at the end of the last step
    double H[CHANNELS][SN_TERMS_MAX]; // shares of the exponentials
    double a, b[CHANNELS];            // affine map of the step at hand
} specimen;

// elastic channels with slopes, the nominal stress and its slope
static sn_status trial(const specimen *s, double L, double value[CHANNELS], double *stress,
                       double *slope) {
    double df[CHANNELS], total[CHANNELS];
    if (s->pull == SN_PULL_UNIAXIAL)
        sn_law_uniaxial(s->tissue->law, s->tissue->value, s->tissue->terms, 1, &L, NULL, value, df);
    else if (s->pull == SN_PULL_STRIP)
        SN_TRY(sn_pull_strip(s->tissue, 1, &L, value, df));
    else
        SN_TRY(sn_pull_closed(s->tissue, 1, &L, value, df));
    for (int c = 0; c < s->channels; ++c) total[c] = s->a * value[c] + s->b[c];
    if (s->pull == SN_PULL_UNIAXIAL) {
        *stress = total[0];
        *slope = s->a * df[0];
    } else if (s->pull == SN_PULL_STRIP) {
        *stress = L * total[0];
        *slope = total[0] + s->a * L * df[0];
    } else {
        *stress = L * total[0] - total[1] / (L * L);
        *slope = total[0] + 2.0 * total[1] / (L * L * L) + s->a * (L * df[0] - df[1] / (L * L));
    }
    return SN_OK;
}

// the stretch that carries `load`, and the elastic channels there
static sn_status solve(const specimen *s, double load, double time, double *stretch,
                       double value[CHANNELS]) {
    double L = s->stretch, stress, slope, change = (double)INFINITY;
    for (int i = 0; i < NEWTON_MAX; ++i) {
        SN_TRY(trial(s, L, value, &stress, &slope));
        if (fabs(change) <= 1e-13 * L) {
            *stretch = L;
            return SN_OK;
        }
        change = (load - stress) / slope;
        if (!isfinite(change) || !(slope > 0.0)) break;
        double limit = 0.1 * L; // a tenth of the stretch a go: the law stays in its domain
        change = fmax(-limit, fmin(limit, change));
        L += change;
    }
    return sn_fail(SN_E_SOLVER,
                   "law %s: at %g s no stretch near %g carries a nominal stress of %g Pa: the "
                   "specimen gives way; use a smaller stress or a shorter test",
                   s->tissue->law->name, time, s->stretch, load);
}

// at once under a load that does not start from 0: G(0) = 1; a dashpot holds against it
static sn_status start(specimen *s, double load, double time) {
    s->stretch = 1.0;
    s->a = 1.0;
    memset(s->b, 0, sizeof s->b);
    SN_TRY(solve(s, s->e->viscous > 0.0 ? 0.0 : load, time, &s->stretch, s->value));
    for (int c = 0; c < s->channels; ++c)
        for (int i = 0; i < s->e->terms; ++i) s->H[c][i] = s->e->g[i] * s->value[c];
    return SN_OK;
}

static sn_status step(specimen *s, double h, const double *decay, const double *gain, double load,
                      double time) {
    const sn_exponentials *e = s->e;
    double value[CHANNELS], viscous = e->viscous / h;
    s->a = e->g_inf + viscous;
    for (int i = 0; i < e->terms; ++i) s->a += gain[i];
    for (int c = 0; c < s->channels; ++c) {
        s->b[c] = -viscous * s->value[c];
        for (int i = 0; i < e->terms; ++i) s->b[c] += decay[i] * s->H[c][i] - gain[i] * s->value[c];
    }
    SN_TRY(solve(s, load, time, &s->stretch, value));
    for (int c = 0; c < s->channels; ++c) {
        for (int i = 0; i < e->terms; ++i)
            s->H[c][i] = decay[i] * s->H[c][i] + gain[i] * (value[c] - s->value[c]);
        s->value[c] = value[c];
    }
    return SN_OK;
}

// a block that is loaded on its first face
static sn_status stretch_of_block(const sn_path *path, const sn_tissue *tissue,
                                  const sn_exponentials *e, int level, double *stretch) {
    const sn_faces loaded_faces = {.per = {1.0, 0.0, 0.0}};
    sn_block_row *row = sn_alloc((size_t)path->count, sizeof *row);
    if (!row) return SN_E_MEMORY;
    sn_status status = sn_path_block(path, tissue, &loaded_faces, e, level, row);
    for (int r = 0; status == SN_OK && r < path->records; ++r)
        stretch[r] = path->record[r] < 0 ? 1.0 : row[path->record[r]].stretch[0];
    sn_free(row);
    return status;
}

sn_status sn_path_stretch(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                          const sn_exponentials *e, int level, double *stretch) {
    specimen s = {.tissue = tissue, .pull = pull, .e = e};
    if (pull == SN_PULL_LATERAL) return stretch_of_block(path, tissue, e, level, stretch);
    s.channels = pull == SN_PULL_CLOSED ? 2 : 1;
    double decay[SN_TERMS_MAX], gain[SN_TERMS_MAX];
    double *at_instant = sn_alloc((size_t)path->count, sizeof *at_instant);
    if (!at_instant) return SN_E_MEMORY;
    sn_status status = start(&s, path->stretch[0], path->time[0]);
    at_instant[0] = s.stretch;
    for (int k = 0; status == SN_OK && k + 1 < path->count; ++k) {
        double h = (path->time[k + 1] - path->time[k]) / level;
        double from = path->stretch[k], rise = path->stretch[k + 1] - from;
        sn_exponentials_factors(e, h, decay, gain);
        for (int j = 1; status == SN_OK && j <= level; ++j)
            status = step(&s, h, decay, gain, from + rise * j / level, path->time[k] + h * j);
        at_instant[k + 1] = s.stretch;
    }
    for (int r = 0; status == SN_OK && r < path->records; ++r)
        stretch[r] = path->record[r] < 0 ? 1.0 : at_instant[path->record[r]];
    sn_free(at_instant);
    return status;
}

//---- refined -------------------------------------------------------------------------------------

typedef struct loaded {
    const sn_path *path;
    const sn_tissue *tissue;
    sn_pull pull;
    const sn_exponentials *e;
} loaded;

// strains: their largest is what the tolerance is measured by
static sn_status strain_at_level(const void *context, int level, double *strain) {
    const loaded *l = context;
    SN_TRY(sn_path_stretch(l->path, l->tissue, l->pull, l->e, level, strain));
    for (int i = 0; i < l->path->records; ++i) strain[i] -= 1.0;
    return SN_OK;
}

// the recorded times, and after them the times that halve towards the start of each piece
static double *graded_times(const sn_history *stress, int n, const double *time, int *count) {
    double *t = sn_alloc((size_t)n + (size_t)stress->count * HALVINGS, sizeof *t), end = time[0];
    if (!t) return NULL;
    for (int i = 0; i < n; ++i) {
        t[i] = time[i];
        end = fmax(end, time[i]);
    }
    *count = n;
    for (int k = 0; k < stress->count; ++k) {
        double low = stress->time[k], high = k + 1 < stress->count ? stress->time[k + 1] : end;
        if (!(high > low)) continue;
        for (int j = 1; j <= HALVINGS; ++j) {
            double at = low + ldexp(high - low, -j);
            if (at > low && at < end) t[(*count)++] = at;
        }
    }
    return t;
}

sn_status sn_lab_creep(const sn_tissue *tissue, const sn_history *stress, int n, const double *time,
                       double *stretch) {
    SN_ASSERT(tissue && tissue->law && stress && time && stretch);
    if (n <= 0) return SN_OK;
    sn_pull pull;
    sn_exponentials e[SN_PARTS];
    sn_path *path = NULL;
    bool viscous;
    int count;
    double change = (double)NAN, *t = NULL, *strain = NULL;
    SN_TRY(sn_pull_choose(tissue, &pull));
    SN_TRY(sn_path_memory(tissue, e, &viscous));
    if (tissue->branched) pull = SN_PULL_LATERAL; // the block has a memory for every channel
    if (tissue->branched && viscous && stress->value[0] != 0.0)
        return sn_fail(SN_E_UNSUPPORTED,
                       "law %s: a creep test whose stress starts at %g Pa under a branch memory "
                       "with a viscous part (voigt): start at 0 Pa and use a ramp",
                       tissue->law->name, stress->value[0]);
    sn_status status = SN_E_MEMORY;
    t = graded_times(stress, n, time, &count);
    if (!t) goto fail;
    SN_TRY_GOTO(status, sn_path_lay(stress, 0.0, count, t, &path));
    status = SN_E_MEMORY;
    strain = sn_alloc((size_t)count, sizeof *strain);
    if (!strain) goto fail;
    loaded l = {path, tissue, pull, e};
    double base = viscous ? 2.0 : 4.0;
    SN_TRY_GOTO(status, sn_refine(strain_at_level, &l, count, base, tolerance, strain, &change));
    for (int i = 0; i < n; ++i) stretch[i] = 1.0 + strain[i];
    if (!(change <= tolerance))
        status = sn_fail(SN_E_SOLVER,
                         "law %s: the creep test changes by %g of its largest strain when its "
                         "steps are halved the last time (expected %g): use a slower ramp or a "
                         "smaller stress",
                         tissue->law->name, change, tolerance);
fail:
    sn_path_destroy(path);
    sn_free(strain);
    sn_free(t);
    return status;
}

//---- the protocol --------------------------------------------------------------------------------

// load, hold, and where there is a recovery unload and wait: knots of the stress, their number
static int creep_knots(const sn_protocol *p, double time[5], double stress[5]) {
    const double until[5] = {0.0, p->ramp, p->hold, p->ramp, p->recovery};
    const double level[5] = {0.0, p->stress, p->stress, 0.0, 0.0};
    int count = p->recovery > 0.0 ? 5 : 3;
    for (int k = 0; k < count; ++k) {
        time[k] = until[k] + (k > 0 ? time[k - 1] : 0.0);
        stress[k] = level[k];
    }
    return count;
}

static void creep_times(const sn_protocol *p, const double *knots, double *time) {
    int held = p->recovery > 0.0 ? (p->points + 1) / 2 : p->points;
    sn_protocol_hold_times(held, p->ramp, p->hold, time);
    if (held == p->points) return;
    // the last row of the hold is the first of the unloading
    sn_protocol_hold_times(p->points - held + 1, p->ramp, p->recovery, time + held - 1);
    for (int i = held - 1; i < p->points; ++i) time[i] += knots[2];
    time[p->points - 1] = knots[4];
}

static sn_status creep_check(const sn_protocol *p) {
    SN_TRY(sn_protocol_check(p));
    if (p->stress == 0.0)
        return sn_fail(SN_E_RANGE, "protocol creep: stress is 0 Pa, nothing would move: give "
                                   "another");
    int least = p->recovery > 0.0 ? 8 : 4;
    if (p->points < least)
        return sn_fail(SN_E_RANGE, "protocol creep: %d points: expected at least %d", p->points,
                       least);
    return SN_OK;
}

sn_status sn_test_creep(const sn_tissue *tissue, const sn_protocol *p, sn_record *record) {
    double knots[5], level[5];
    SN_TRY(creep_check(p));
    int n = p->points, count = creep_knots(p, knots, level);
    sn_history *stress;
    SN_TRY(sn_history_create(1, count, knots, level, &stress));
    sn_status status = SN_E_MEMORY;
    double *time = sn_alloc(2 * (size_t)n, sizeof *time), *stretch = time + n;
    if (!time) goto fail;
    creep_times(p, knots, time);
    SN_TRY_GOTO(status, sn_lab_creep(tissue, stress, n, time, stretch));
    SN_TRY_GOTO(status, sn_record_add_series(record, "time", "s"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "stretch", "1"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "stress", "Pa"));
    for (int i = 0; i < n; ++i) {
        double row[] = {time[i], stretch[i], 0.0};
        sn_history_at(stress, time[i], &row[2]);
        SN_TRY_GOTO(status, sn_record_append(record, row));
    }
fail:
    sn_history_destroy(stress);
    sn_free(time);
    return status;
}
