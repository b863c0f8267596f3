// Motions of the uniaxial testing machine, and the dispatch of all tests.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "lab/protocol/protocol.h"

enum { SINE_LINES = 100 };
static const double pi = 3.14159265358979323846;

// where the legs of a motion start
static double start_of(const sn_protocol *p) {
    return p->kind == SN_PROTOCOL_CYCLIC ? p->lower : 1.0;
}

// checks a motion to a stretch and gives its ramp time
static sn_status ramp_of(const sn_protocol *p, double *ramp) {
    const char *name = sn_protocol_name(p->kind);
    SN_TRY(sn_protocol_check(p));
    double start = start_of(p);
    if (p->stretch == start)
        return sn_fail(SN_E_RANGE,
                       "protocol %s: stretch is %g, nothing would move: give another target", name,
                       start);
    if (p->ramp == 0.0 && p->rate == 0.0)
        return sn_fail(SN_E_RANGE, "protocol %s: ramp and rate are both 0: give one of them", name);
    *ramp = p->ramp > 0.0 ? p->ramp : fabs(p->stretch - start) / p->rate;
    if (!isfinite(*ramp) || !(*ramp > 0.0))
        return sn_fail(SN_E_RANGE,
                       "protocol %s: rate %g 1/s to stretch %g takes no usable time: give ramp",
                       name, p->rate, p->stretch);
    return SN_OK;
}

// way from the start to the target at the knot k of `lines` knots a leg
static double way(int k, int lines) {
    int at = k % (2 * lines);
    if (at > lines) at = 2 * lines - at;
    if (lines == 1 || at == 0 || at == lines) return at == 0 ? 0.0 : 1.0;
    double half = sin(0.5 * pi * at / lines);
    return half * half; // (1 - cos)/2
}

// a motion in legs of one ramp time between the start and the target, then a hold
typedef struct legs {
    int before, recorded; // of preconditioning, of the record
    double approach;      // seconds from stretch 1 to the start of the first leg
    double ramp, hold;
} legs;

static legs legs_of(const sn_protocol *p, double ramp) {
    bool cyclic = p->kind == SN_PROTOCOL_CYCLIC;
    double start = start_of(p);
    return (legs){.before = cyclic ? 2 * p->precondition : 0,
                  .recorded = cyclic ? 2 * p->cycles : 1,
                  .approach = ramp * fabs(start - 1.0) / fabs(p->stretch - start),
                  .ramp = ramp,
                  .hold = p->kind == SN_PROTOCOL_RELAXATION ? p->hold : 0.0};
}

static sn_status legs_history(const sn_protocol *p, const legs *l, sn_history **stretch) {
    int lines = p->wave == SN_WAVE_SINE ? SINE_LINES : 1;
    int moving = (l->before + l->recorded) * lines, first = l->approach > 0.0;
    int count = first + moving + 1 + (l->hold > 0.0);
    double start = start_of(p);
    double *knots = sn_alloc(2 * (size_t)count, sizeof *knots), *value = knots + count;
    if (!knots) return SN_E_MEMORY;
    value[0] = 1.0; // the first leg overwrites it where it starts at once
    for (int k = 0; k <= moving; ++k) {
        double w = way(k, lines);
        knots[first + k] = l->approach + l->ramp * (k / lines + (double)(k % lines) / lines);
        value[first + k] = w == 1.0 ? p->stretch : start + w * (p->stretch - start);
    }
    if (l->hold > 0.0) {
        knots[count - 1] = knots[count - 2] + l->hold;
        value[count - 1] = value[count - 2];
    }
    sn_status status = sn_history_create(1, count, knots, value, stretch);
    sn_free(knots);
    return status;
}

// rows spread over the recorded legs, every corner a row
static void legs_times(int points, const legs *l, double *time) {
    time[0] = l->approach + l->ramp * l->before;
    for (int leg = 0; leg < l->recorded; ++leg) {
        int first = (int)((long long)(points - 1) * leg / l->recorded);
        int last = (int)((long long)(points - 1) * (leg + 1) / l->recorded);
        for (int i = first + 1; i <= last; ++i) {
            double part = i == last ? 1.0 : (double)(i - first) / (last - first);
            time[i] = l->approach + l->ramp * (l->before + leg + part);
        }
    }
}

void sn_protocol_hold_times(int points, double ramp, double hold, double *time) {
    int rising = points / 3, held = points - rising - 1;
    for (int i = 0; i <= rising; ++i) time[i] = i == rising ? ramp : ramp * i / rising;
    double first = fmin(ramp / 20.0, hold / 100.0);
    for (int i = 1; i <= held; ++i) {
        double part = held > 1 ? (double)(i - 1) / (held - 1) : 1.0;
        time[rising + i] = i == held ? ramp + hold : ramp + first * pow(hold / first, part);
    }
}

sn_status sn_protocol_history(const sn_protocol *protocol, sn_history **stretch, double **time) {
    SN_ASSERT(protocol && stretch && time);
    *stretch = NULL;
    *time = NULL;
    double ramp = (double)NAN;
    SN_TRY(ramp_of(protocol, &ramp));
    legs l = legs_of(protocol, ramp);
    if (protocol->points <= 2 * l.recorded)
        return sn_fail(SN_E_RANGE,
                       "protocol %s: %d points for %d straight lines of the motion: expected at "
                       "least %d",
                       sn_protocol_name(protocol->kind), protocol->points, l.recorded,
                       2 * l.recorded + 1);
    double *t = sn_alloc((size_t)protocol->points, sizeof *t);
    if (!t) return SN_E_MEMORY;
    sn_status status = legs_history(protocol, &l, stretch);
    if (status != SN_OK) {
        sn_free(t);
        return status;
    }
    if (l.hold > 0.0)
        sn_protocol_hold_times(protocol->points, ramp, protocol->hold, t);
    else
        legs_times(protocol->points, &l, t);
    *time = t;
    return SN_OK;
}

// the cycle that a recorded time of a cyclic test is in; its end belongs to it
static double cycle_at(const sn_protocol *protocol, const double *time, double t) {
    double length = (time[protocol->points - 1] - time[0]) / protocol->cycles;
    double done = (t - time[0]) / length;
    return protocol->precondition + fmax(1.0, ceil(done * (1.0 - 1e-12)));
}

// fills an empty record from the times and stresses of a run
static sn_status fill_record(const sn_protocol *protocol, const sn_history *stretch,
                             const double *time, const double *stress, sn_record *record) {
    bool cyclic = protocol->kind == SN_PROTOCOL_CYCLIC;
    SN_TRY(sn_record_add_series(record, "time", "s"));
    SN_TRY(sn_record_add_series(record, "stretch", "1"));
    SN_TRY(sn_record_add_series(record, "stress", "Pa"));
    if (cyclic) SN_TRY(sn_record_add_series(record, "cycle", "1"));
    if (cyclic && protocol->precondition > 0) {
        char text[SN_NAME_MAX];
        snprintf(text, sizeof text, "%d cycles before the first row", protocol->precondition);
        SN_TRY(sn_record_add_note(record, "preconditioning", text, (double)NAN));
    }
    for (int i = 0; i < protocol->points; ++i) {
        double at = 1.0;
        sn_history_at(stretch, time[i], &at);
        double values[4] = {time[i], at, stress[i], cyclic ? cycle_at(protocol, time, time[i]) : 0};
        SN_TRY(sn_record_append(record, values));
    }
    return SN_OK;
}

static sn_status test_uniaxial(const sn_tissue *tissue, const sn_protocol *protocol,
                               sn_record *record) {
    sn_history *stretch = NULL;
    double *time = NULL, *stress = NULL;
    sn_status status;
    SN_TRY_GOTO(status, sn_protocol_history(protocol, &stretch, &time));
    status = SN_E_MEMORY;
    stress = sn_alloc((size_t)protocol->points, sizeof *stress);
    if (!stress) goto fail;
    SN_TRY_GOTO(status, sn_lab_uniaxial(tissue, stretch, protocol->points, time, stress));
    SN_TRY_GOTO(status, fill_record(protocol, stretch, time, stress, record));
fail:
    sn_history_destroy(stretch);
    sn_free(time);
    sn_free(stress);
    return status;
}

sn_status sn_lab_test(const sn_tissue *tissue, const sn_protocol *protocol, sn_record **record) {
    SN_ASSERT(tissue && protocol && record);
    static sn_status (*const test[])(const sn_tissue *, const sn_protocol *, sn_record *) = {
        [SN_PROTOCOL_TENSILE] = test_uniaxial,    [SN_PROTOCOL_CYCLIC] = test_uniaxial,
        [SN_PROTOCOL_RELAXATION] = test_uniaxial, [SN_PROTOCOL_HYSTERESIS] = sn_test_hysteresis,
        [SN_PROTOCOL_DYNAMIC] = sn_test_dynamic,  [SN_PROTOCOL_CREEP] = sn_test_creep,
        [SN_PROTOCOL_BIAXIAL] = sn_test_plane,    [SN_PROTOCOL_SHEAR] = sn_test_plane,
    };
    SN_TRY(sn_record_create(sn_protocol_name(protocol->kind), record));
    sn_status status = test[protocol->kind](tissue, protocol, *record);
    if (status == SN_OK) return status;
    sn_record_destroy(*record);
    *record = NULL;
    return status;
}
