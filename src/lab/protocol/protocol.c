// Protocols of the uniaxial testing machine: tensile, cyclic, relaxation.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "sinew/lab.h"

static const double inf = (double)INFINITY;

// the parameters that every protocol has; `ramp` of 0 asks for `rate`
#define STRETCH(value)                                                                             \
    {                                                                                              \
        .name = "stretch", .symbol = "lambda", .unit = "1", .min = 0.0, .max = inf,                \
        .min_open = true, .max_open = true, .init = (value),                                       \
        .text = "Target stretch: length over original length."                                     \
    }
#define RAMP(value)                                                                                \
    {                                                                                              \
        .name = "ramp", .symbol = "t_r", .unit = "s", .min = 0.0, .max = inf, .max_open = true,    \
        .init = (value), .log_scale = true,                                                        \
        .text = "Time from stretch 1 to the target; 0: follows from the rate."                     \
    }
#define RATE(value)                                                                                \
    {                                                                                              \
        .name = "rate", .symbol = "dlambda/dt", .unit = "1/s", .min = 0.0, .max = inf,             \
        .max_open = true, .init = (value), .log_scale = true,                                      \
        .text = "Stretch per second; used where the ramp time is 0."                               \
    }
#define POINTS(value)                                                                              \
    {                                                                                              \
        .name = "points", .symbol = "n", .unit = "1", .min = 3.0, .max = 1e6, .init = (value),     \
        .text = "Rows of the curve."                                                               \
    }

static const sn_param tensile_params[] = {STRETCH(1.1), RATE(0.01), RAMP(0.0), POINTS(101.0)};
static const sn_param cyclic_params[] = {STRETCH(1.1),
                                         RAMP(1.0),
                                         RATE(0.1),
                                         {.name = "cycles",
                                          .symbol = "N",
                                          .unit = "1",
                                          .min = 1.0,
                                          .max = 1e4,
                                          .init = 3.0,
                                          .text = "Triangles from 1 to the target and back."},
                                         POINTS(301.0)};
static const sn_param relaxation_params[] = {STRETCH(1.1),
                                             RAMP(0.1),
                                             RATE(1.0),
                                             {.name = "hold",
                                              .symbol = "t_h",
                                              .unit = "s",
                                              .min = 0.0,
                                              .max = inf,
                                              .min_open = true,
                                              .max_open = true,
                                              .init = 100.0,
                                              .log_scale = true,
                                              .text = "Time at the target stretch after the ramp."},
                                             POINTS(91.0)};

typedef struct row {
    const char *name;
    const sn_param *params;
    int count;
} row;
#define ROW(name, table)                                                                           \
    { name, table, (int)(sizeof(table) / sizeof *(table)) }
static const row rows[] = {[SN_PROTOCOL_TENSILE] = ROW("tensile", tensile_params),
                           [SN_PROTOCOL_CYCLIC] = ROW("cyclic", cyclic_params),
                           [SN_PROTOCOL_RELAXATION] = ROW("relaxation", relaxation_params)};
enum { ROWS = sizeof rows / sizeof *rows };

int sn_protocol_count(void) {
    return ROWS;
}

const char *sn_protocol_name(sn_protocol_kind kind) {
    return rows[kind].name;
}

bool sn_protocol_find(const char *name, sn_protocol_kind *kind) {
    const char *names[ROWS];
    for (int i = 0; i < ROWS; ++i) {
        names[i] = rows[i].name;
        if (strcmp(name, names[i]) == 0) {
            *kind = (sn_protocol_kind)i;
            return true;
        }
    }
    const char *near = sn_suggest(name, names, ROWS);
    if (near)
        sn_fail(SN_E_NAME, "unknown protocol \"%s\": did you mean \"%s\"?", name, near);
    else
        sn_fail(SN_E_NAME, "unknown protocol \"%s\": expected tensile, cyclic or relaxation", name);
    return false;
}

const sn_param *sn_protocol_params(sn_protocol_kind kind, int *count) {
    *count = rows[kind].count;
    return rows[kind].params;
}

static double initial(sn_protocol_kind kind, const char *name) {
    int k = sn_param_find(rows[kind].params, rows[kind].count, name);
    return k < 0 ? 0.0 : rows[kind].params[k].init;
}

sn_protocol sn_protocol_default(sn_protocol_kind kind) {
    return (sn_protocol){.kind = kind,
                         .stretch = initial(kind, "stretch"),
                         .ramp = initial(kind, "ramp"),
                         .rate = initial(kind, "rate"),
                         .hold = initial(kind, "hold"),
                         .cycles = (int)initial(kind, "cycles"),
                         .points = (int)initial(kind, "points")};
}

// the protocol held against its table, and its ramp time
static sn_status ramp_of(const sn_protocol *p, double *ramp) {
    const row *r = &rows[p->kind];
    double value[8];
    for (int k = 0; k < r->count; ++k) {
        const char *name = r->params[k].name;
        value[k] = strcmp(name, "stretch") == 0  ? p->stretch
                   : strcmp(name, "ramp") == 0   ? p->ramp
                   : strcmp(name, "rate") == 0   ? p->rate
                   : strcmp(name, "hold") == 0   ? p->hold
                   : strcmp(name, "cycles") == 0 ? (double)p->cycles
                                                 : (double)p->points;
    }
    char owner[SN_NAME_MAX] = "protocol ";
    strcat(owner, r->name);
    SN_TRY(sn_param_check(r->params, r->count, 0, value, owner));
    if (p->stretch == 1.0)
        return sn_fail(SN_E_RANGE, "%s: stretch is 1, nothing would move: give another target",
                       owner);
    if (p->ramp == 0.0 && p->rate == 0.0)
        return sn_fail(SN_E_RANGE, "%s: ramp and rate are both 0: give one of them", owner);
    *ramp = p->ramp > 0.0 ? p->ramp : fabs(p->stretch - 1.0) / p->rate;
    if (!isfinite(*ramp) || !(*ramp > 0.0))
        return sn_fail(SN_E_RANGE, "%s: rate %g 1/s to stretch %g takes no usable time: give ramp",
                       owner, p->rate, p->stretch);
    return SN_OK;
}

// knots of a triangle or a ramp: legs of one ramp time between 1 and the target
static sn_status legs_history(const sn_protocol *p, int legs, double ramp, double hold,
                              sn_history **stretch) {
    int count = legs + 1 + (hold > 0.0);
    double *knots = sn_alloc(2 * (size_t)count, sizeof *knots);
    if (!knots) return SN_E_MEMORY;
    for (int k = 0; k <= legs; ++k) {
        knots[k] = ramp * k;
        knots[count + k] = k % 2 ? p->stretch : 1.0;
    }
    if (hold > 0.0) {
        knots[legs + 1] = ramp * legs + hold;
        knots[count + legs + 1] = knots[count + legs];
    }
    sn_status status = sn_history_create(1, count, knots, knots + count, stretch);
    sn_free(knots);
    return status;
}

// rows spread over the legs, every corner a row
static void legs_times(int points, int legs, double ramp, double *time) {
    time[0] = 0.0;
    for (int leg = 0; leg < legs; ++leg) {
        int first = (int)((long long)(points - 1) * leg / legs);
        int last = (int)((long long)(points - 1) * (leg + 1) / legs);
        for (int i = first + 1; i <= last; ++i)
            time[i] =
                i == last ? ramp * (leg + 1) : ramp * (leg + (double)(i - first) / (last - first));
    }
}

// A third of the rows over the ramp, the others spaced by the logarithm of the time since its end:
// from a twentieth of the ramp or a hundredth of the hold, whichever is shorter.
static void hold_times(int points, double ramp, double hold, double *time) {
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
    bool held = protocol->kind == SN_PROTOCOL_RELAXATION;
    int legs = protocol->kind == SN_PROTOCOL_CYCLIC ? 2 * protocol->cycles : 1;
    if (protocol->points <= 2 * legs)
        return sn_fail(SN_E_RANGE,
                       "protocol %s: %d points for %d straight lines of the motion: expected at "
                       "least %d",
                       rows[protocol->kind].name, protocol->points, legs, 2 * legs + 1);
    double *t = sn_alloc((size_t)protocol->points, sizeof *t);
    if (!t) return SN_E_MEMORY;
    sn_status status = legs_history(protocol, legs, ramp, held ? protocol->hold : 0.0, stretch);
    if (status != SN_OK) {
        sn_free(t);
        return status;
    }
    if (held)
        hold_times(protocol->points, ramp, protocol->hold, t);
    else
        legs_times(protocol->points, legs, ramp, t);
    *time = t;
    return SN_OK;
}

// fills an empty record from the times and stresses of a run
static sn_status fill_record(const sn_protocol *protocol, const sn_history *stretch,
                             const double *time, const double *stress, sn_record *record) {
    bool cyclic = protocol->kind == SN_PROTOCOL_CYCLIC;
    SN_TRY(sn_record_add_series(record, "time", "s"));
    SN_TRY(sn_record_add_series(record, "stretch", "1"));
    SN_TRY(sn_record_add_series(record, "stress", "Pa"));
    if (cyclic) SN_TRY(sn_record_add_series(record, "cycle", "1"));
    for (int i = 0; i < protocol->points; ++i) {
        double at = 1.0;
        sn_history_at(stretch, time[i], &at);
        double period = 2.0 * stretch->time[1]; // the end of a cycle belongs to it
        double cycle = fmax(1.0, ceil(time[i] / period * (1.0 - 1e-12)));
        double values[4] = {time[i], at, stress[i], cycle};
        SN_TRY(sn_record_append(record, values));
    }
    return SN_OK;
}

sn_status sn_lab_test(const sn_tissue *tissue, const sn_protocol *protocol, sn_record **record) {
    SN_ASSERT(tissue && protocol && record);
    sn_history *stretch = NULL;
    double *time = NULL, *stress = NULL;
    sn_status status;
    *record = NULL;
    SN_TRY_GOTO(status, sn_protocol_history(protocol, &stretch, &time));
    status = SN_E_MEMORY;
    stress = sn_alloc((size_t)protocol->points, sizeof *stress);
    if (!stress) goto fail;
    SN_TRY_GOTO(status, sn_lab_uniaxial(tissue, stretch, protocol->points, time, stress));
    SN_TRY_GOTO(status, sn_record_create(rows[protocol->kind].name, record));
    SN_TRY_GOTO(status, fill_record(protocol, stretch, time, stress, *record));
fail:
    if (status != SN_OK) {
        sn_record_destroy(*record);
        *record = NULL;
    }
    sn_history_destroy(stretch);
    sn_free(time);
    sn_free(stress);
    return status;
}
