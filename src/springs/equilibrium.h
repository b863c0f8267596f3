// The solver of a quasi-static run, and equilibrium at one time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/parts.h"
#include "springs/run.h"
#include "springs/steps.h"

/// A quasi-static run under way.
typedef struct sn_balance {
    sn_run *run;
    const sn_net *net;
    sn_state *s;
    sn_tangent *tangent;
    double *history;
    double *start, *before; ///< quads: at the start of the step, of the correction
    double *b, *x;          ///< (nodes x 3)
    double *last;           ///< free part of the last step's motion  (nodes x 3)
    double last_step;
    double *ext;    ///< loads, tools and weight               (nodes x 3)
    double *inner;  ///< internal forces at the start of the step (nodes x 3)
    double *held;   ///< Nullable: after a cut, forces that hold the body where it was
    double holding; ///< part of them that acts yet
    double *inner_now;
    sn_contact *touch;   ///< trial contact
    double time, level;  ///< that equilibrium is sought for; part of the loads
    double scale, least; ///< of the residual; the least of it: when nothing pulls
    double smallest;     ///< volume ratio of any cell
    double residual;
    double firm;       ///< about the largest stiffness of a node over its mass, 1/s2
    bool snapped;      ///< in the step under way
    int let_go, snaps; ///< how often the body was let go, and found another equilibrium
    double first_snap; ///< s
    double given_off;  ///< by snaps, J
} sn_balance;

/// Forces at s->u; b <- residual of the free directions.
/// @return its norm, N
double sn_balance_residual(sn_balance *v, sn_memory_mode mode);
/// Equilibrium at v->time and v->level with the present factors, by Newton's method; u keeps what
/// it was where that fails. @param h  the step, s
bool sn_balance_equilibrium(sn_balance *v, double h);
/// Lets the body go: to equilibrium at v->time, however far it is; u keeps what it was where none
/// is found.
bool sn_balance_snap(sn_balance *v, double h);
