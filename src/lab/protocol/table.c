// Protocols as tables: names, parameters, defaults, checks.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/protocol/protocol.h"

// the parameters that several protocols have; `ramp` of 0 asks for `rate`
#define STRETCH(key, sign, value, sentence)                                                        \
    {                                                                                              \
        .name = key, .symbol = sign, .unit = "1", .min = 0.0, .max = (double)INFINITY,             \
        .min_open = true, .max_open = true, .init = (value), .text = sentence                      \
    }
#define TARGET(value)                                                                              \
    STRETCH("stretch", "lambda", value, "Target stretch: length over original length.")
#define RAMP(value)                                                                                \
    {                                                                                              \
        .name = "ramp", .symbol = "t_r", .unit = "s", .min = 0.0, .max = (double)INFINITY,         \
        .max_open = true, .init = (value), .log_scale = true,                                      \
        .text = "Time of the way to the target; 0: follows from the rate."                         \
    }
#define RATE(value)                                                                                \
    {                                                                                              \
        .name = "rate", .symbol = "dlambda/dt", .unit = "1/s", .min = 0.0,                         \
        .max = (double)INFINITY, .max_open = true, .init = (value), .log_scale = true,             \
        .text = "Stretch per second; used where the ramp time is 0."                               \
    }
#define POINTS(value)                                                                              \
    {                                                                                              \
        .name = "points", .symbol = "n", .unit = "1", .min = 3.0, .max = 1e6, .init = (value),     \
        .text = "Rows of the curve."                                                               \
    }
// a duration or a frequency above 0
#define POSITIVE(key, sign, of, value, sentence)                                                   \
    {                                                                                              \
        .name = key, .symbol = sign, .unit = of, .min = 0.0, .max = (double)INFINITY,              \
        .min_open = true, .max_open = true, .init = (value), .log_scale = true, .text = sentence   \
    }

static const sn_param tensile_params[] = {TARGET(1.1), RATE(0.01), RAMP(0.0), POINTS(101.0)};
static const sn_param cyclic_params[] = {
    TARGET(1.1),
    RAMP(1.0),
    RATE(0.1),
    {.name = "cycles",
     .symbol = "N",
     .unit = "1",
     .min = 1.0,
     .max = 1e4,
     .init = 3.0,
     .text = "Recorded times to the target and back."},
    STRETCH("lower", "lambda_0", 1.0, "Stretch where a cycle starts and ends."),
    {.name = "precondition",
     .symbol = "N_0",
     .unit = "1",
     .min = 0.0,
     .max = 1e4,
     .init = 0.0,
     .text = "Cycles before those that are recorded."},
    POINTS(301.0)};
static const sn_param relaxation_params[] = {
    TARGET(1.1), RAMP(0.1), RATE(1.0),
    POSITIVE("hold", "t_h", "s", 100.0, "Time at the target stretch after the ramp."),
    POINTS(91.0)};
static const sn_param hysteresis_params[] = {
    TARGET(1.1), POSITIVE("from", "T", "s", 0.1, "First ramp time of the sweep."),
    POSITIVE("to", "T", "s", 100.0, "Last ramp time of the sweep."), POINTS(31.0)};
static const sn_param dynamic_params[] = {
    STRETCH("stretch", "lambda", 1.0, "Mean stretch of the oscillation."),
    POSITIVE("from", "f", "Hz", 0.01, "First frequency of the sweep."),
    POSITIVE("to", "f", "Hz", 100.0, "Last frequency of the sweep."), POINTS(41.0)};

static const sn_param creep_params[] = {
    {.name = "stress",
     .symbol = "T",
     .unit = "Pa",
     .min = -(double)INFINITY,
     .max = (double)INFINITY,
     .min_open = true,
     .max_open = true,
     .init = 1000.0,
     .text = "Nominal stress that is held: force over original area."},
    POSITIVE("ramp", "t_r", "s", 0.1, "Time of the loading, and of the unloading."),
    POSITIVE("hold", "t_h", "s", 100.0, "Time under the stress."),
    {.name = "recovery",
     .symbol = "t_0",
     .unit = "s",
     .min = 0.0,
     .max = (double)INFINITY,
     .max_open = true,
     .init = 100.0,
     .log_scale = true,
     .text = "Time without stress after the unloading; 0: the test ends under the stress."},
    POINTS(121.0)};

static const sn_param biaxial_params[] = {
    STRETCH("stretch-1", "lambda_1", 1.1, "Target stretch along the first axis."),
    STRETCH("stretch-2", "lambda_2", 1.1, "Target stretch along the second axis."),
    POSITIVE("ramp", "t_r", "s", 1.0, "Time from rest to the targets."), POINTS(101.0)};
static const sn_param shear_params[] = {
    {.name = "shear",
     .symbol = "gamma",
     .unit = "1",
     .min = -(double)INFINITY,
     .max = (double)INFINITY,
     .min_open = true,
     .max_open = true,
     .init = 0.1,
     .text = "Target shear strain: displacement of a face over its distance from the other."},
    POSITIVE("ramp", "t_r", "s", 1.0, "Time from rest to the target."),
    POINTS(101.0)};

typedef struct row {
    const char *name;
    const sn_param *params;
    int count;
} row;
#define ROW(name, table)                                                                           \
    { name, table, (int)(sizeof(table) / sizeof *(table)) }
static const row rows[] = {[SN_PROTOCOL_TENSILE] = ROW("tensile", tensile_params),
                           [SN_PROTOCOL_CYCLIC] = ROW("cyclic", cyclic_params),
                           [SN_PROTOCOL_RELAXATION] = ROW("relaxation", relaxation_params),
                           [SN_PROTOCOL_HYSTERESIS] = ROW("hysteresis", hysteresis_params),
                           [SN_PROTOCOL_DYNAMIC] = ROW("dynamic", dynamic_params),
                           [SN_PROTOCOL_CREEP] = ROW("creep", creep_params),
                           [SN_PROTOCOL_BIAXIAL] = ROW("biaxial", biaxial_params),
                           [SN_PROTOCOL_SHEAR] = ROW("shear", shear_params)};
enum { ROWS = sizeof rows / sizeof *rows };

// where the value of a parameter stands in sn_protocol
typedef struct field {
    const char *name;
    size_t offset;
    bool whole; // an int, else a double
} field;
static const field fields[] = {{"stretch", offsetof(sn_protocol, stretch), false},
                               {"ramp", offsetof(sn_protocol, ramp), false},
                               {"rate", offsetof(sn_protocol, rate), false},
                               {"hold", offsetof(sn_protocol, hold), false},
                               {"recovery", offsetof(sn_protocol, recovery), false},
                               {"stress", offsetof(sn_protocol, stress), false},
                               {"stretch-1", offsetof(sn_protocol, stretch_1), false},
                               {"stretch-2", offsetof(sn_protocol, stretch_2), false},
                               {"shear", offsetof(sn_protocol, shear), false},
                               {"from", offsetof(sn_protocol, from), false},
                               {"to", offsetof(sn_protocol, to), false},
                               {"lower", offsetof(sn_protocol, lower), false},
                               {"precondition", offsetof(sn_protocol, precondition), true},
                               {"cycles", offsetof(sn_protocol, cycles), true},
                               {"points", offsetof(sn_protocol, points), true}};

static const field *field_of(const char *name) {
    const field *f = fields;
    while (strcmp(f->name, name) != 0) ++f; // every parameter of the tables has one
    return f;
}

static void put(sn_protocol *p, const char *name, double value) {
    const field *f = field_of(name);
    char *place = (char *)p + f->offset;
    if (f->whole)
        *(int *)place = (int)value;
    else
        *(double *)place = value;
}

int sn_protocol_count(void) {
    return ROWS;
}

const char *sn_protocol_name(sn_protocol_kind kind) {
    return rows[kind].name;
}

bool sn_protocol_find(const char *name, sn_protocol_kind *kind) {
    const char *names[ROWS];
    char list[SN_TEXT_MAX] = "";
    for (int i = 0; i < ROWS; ++i) {
        names[i] = rows[i].name;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s",
                 i == 0          ? ""
                 : i == ROWS - 1 ? " or "
                                 : ", ",
                 names[i]);
        if (strcmp(name, names[i]) == 0) {
            *kind = (sn_protocol_kind)i;
            return true;
        }
    }
    const char *near = sn_suggest(name, names, ROWS);
    if (near)
        sn_fail(SN_E_NAME, "unknown protocol \"%s\": did you mean \"%s\"?", name, near);
    else
        sn_fail(SN_E_NAME, "unknown protocol \"%s\": expected %s", name, list);
    return false;
}

const sn_param *sn_protocol_params(sn_protocol_kind kind, int *count) {
    *count = rows[kind].count;
    return rows[kind].params;
}

sn_protocol sn_protocol_default(sn_protocol_kind kind) {
    sn_protocol p = {.kind = kind};
    for (int k = 0; k < rows[kind].count; ++k)
        put(&p, rows[kind].params[k].name, rows[kind].params[k].init);
    return p;
}

double sn_protocol_get(const sn_protocol *protocol, const char *name) {
    SN_ASSERT(protocol && name);
    const row *r = &rows[protocol->kind];
    if (sn_param_find(r->params, r->count, name) < 0) return (double)NAN;
    const field *f = field_of(name);
    const char *place = (const char *)protocol + f->offset;
    return f->whole ? (double)*(const int *)place : *(const double *)place;
}

sn_status sn_protocol_set(sn_protocol *protocol, const char *name, double value) {
    SN_ASSERT(protocol && name);
    const row *r = &rows[protocol->kind];
    if (sn_param_find(r->params, r->count, name) >= 0) {
        put(protocol, name, value);
        return SN_OK;
    }
    char list[SN_TEXT_MAX] = "";
    for (int k = 0; k < r->count; ++k) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "", r->params[k].name);
    }
    return sn_fail(SN_E_NAME, "protocol %s takes no %s: it takes %s", r->name, name, list);
}

sn_status sn_protocol_check(const sn_protocol *protocol) {
    const row *r = &rows[protocol->kind];
    double value[SN_PROTOCOL_PARAMS_MAX];
    SN_ASSERT(r->count <= SN_PROTOCOL_PARAMS_MAX);
    for (int k = 0; k < r->count; ++k) value[k] = sn_protocol_get(protocol, r->params[k].name);
    char owner[SN_NAME_MAX];
    snprintf(owner, sizeof owner, "protocol %s", r->name);
    if (protocol->wave != SN_WAVE_TRIANGLE && protocol->kind != SN_PROTOCOL_CYCLIC)
        return sn_fail(SN_E_RANGE, "%s takes no wave: cyclic does", owner);
    return sn_param_check(r->params, r->count, 0, value, owner);
}

sn_status sn_protocol_sweep(const sn_protocol *protocol, double **value) {
    *value = NULL;
    SN_TRY(sn_protocol_check(protocol));
    double from = protocol->from, to = protocol->to;
    if (from == to)
        return sn_fail(SN_E_RANGE, "protocol %s: from and to are both %g: give a range",
                       rows[protocol->kind].name, from);
    double *v = sn_alloc((size_t)protocol->points, sizeof *v);
    if (!v) return SN_E_MEMORY;
    int last = protocol->points - 1;
    for (int i = 0; i <= last; ++i) v[i] = i == last ? to : from * pow(to / from, (double)i / last);
    *value = v;
    return SN_OK;
}
