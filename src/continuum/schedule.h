// The times a run lands on, and how long its steps are to be between them.
// SPDX-License-Identifier: Apache-2.0
//
// A run lands on every knot of every history and on every output time. Steps are at most
// until/steps long. Where a tissue remembers, the stress after a corner of a history (a change of
// its slope by more than a fifth of its largest slope) varies on all time scales from the length of
// the ramps on, so the steps after it start at a twentieth of the shorter of its two neighbouring
// intervals and grow by a quarter each: the recursion is of second order in the step, and the
// remainder is about (1.25 - 1)^2/12 of the change per e-fold of time. After a jump at time 0 they
// start at a thousandth of the first interval.
#pragma once

#include "sinew/model.h"

#define SN_FE_GROWTH 1.25 ///< of the steps after a corner

/// A time to land on.
typedef struct sn_fe_stop {
    double time;
    bool output;
    bool corner;
    double first; ///< longest step after it, s; INFINITY where it is no corner
} sn_fe_stop;

typedef struct sn_fe_schedule {
    int count;
    sn_fe_stop *stop; ///< from time 0 to `until`
    double longest;   ///< step, s
    double shortest;  ///< planned step, s
} sn_fe_schedule;

/// @param remembers  a tissue of the case has a memory: steps are graded
sn_status sn_fe_schedule_create(const sn_case *c, bool remembers, sn_fe_schedule *out);
void sn_fe_schedule_free(sn_fe_schedule *s);
/// Length of the next step from `time` towards stop `next`, when it may be `wish` long.
double sn_fe_schedule_step(const sn_fe_schedule *s, int next, double time, double wish);
