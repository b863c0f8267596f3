// A run on its way: steps that are cut back where Newton fails and grow again where it does not.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "continuum/measure.h"
#include "continuum/newton.h"
#include "continuum/schedule.h"
#include "sinew/continuum.h"

enum { SN_FE_PAST = 5 }; ///< states before the last that the guess for a step may be drawn from

typedef struct sn_fe_march {
    const sn_case *c;
    const sn_output *output;   ///< Nullable
    const sn_restart *restart; ///< Nullable
    sn_run_summary *summary;
    sn_record *history;
    sn_fe_schedule schedule;
    sn_fe_problem *problem;
    sn_fe_newton newton;
    sn_fe_measure *measure;
    double *x;                  ///< the last accepted state                        (dofs)
    double *past[SN_FE_PAST];   ///< accepted states before it, the latest first     (dofs)
    double past_at[SN_FE_PAST]; ///< their times less that of x, s; negative
    int past_count;             ///< how many belong to a smooth stretch that x ends
    double *guess;              ///< the state being solved for                     (dofs)
    double *force;              ///< internal forces of x, N                        (dofs)
    sn_fe_level reached;        ///< level of x
    double wish, limit;         ///< longest next step: by the schedule, by what failed before
    double pace;                ///< longest next step by accuracy; INFINITY where steps are fixed
    double least_pace;          ///< below which accuracy cuts no step, s
    double longest_used;        ///< step, s
    int inaccurate;             ///< steps that were cut back because they erred by too much
    int blind;                  ///< steps of least_pace that were accepted all the same
    double *wall;               ///< seconds of each step
    size_t wall_room, walls;
    int rounded;             ///< steps accepted at rounding level
    double told;             ///< clock of the last progress text
    double started, elapsed; ///< clock at the start, seconds of work so far
    bool stopped;            ///< Newton gave up: summary->reason says why
} sn_fe_march;

sn_status sn_fe_march_init(sn_fe_march *m, const sn_case *c, const sn_output *output,
                           sn_run_summary *summary, sn_record *history);
void sn_fe_march_free(sn_fe_march *m);
/// Counts a step of `length` seconds that took so long.
sn_status sn_fe_march_note(sn_fe_march *m, double wall, double length);
/// Goes through the whole programme, or until Newton gives up.
sn_status sn_fe_march_go(sn_fe_march *m);
