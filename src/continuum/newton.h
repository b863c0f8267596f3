// Newton's method with a line search, for one step.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "continuum/problem.h"

enum { SN_FE_ITERATIONS = 25 }; ///< most of one step

/// Vectors that Newton works with.
typedef struct sn_fe_newton {
    sn_fe_problem *problem;
    double tolerance;                   ///< of sn_fe_balance.error
    double *trial;                      ///< (dofs)
    double *increment;                  ///< (dofs)
    double *right, *solution;           ///< (total)
    double trace[SN_FE_ITERATIONS + 2]; ///< error after each iteration, the first the start's
} sn_fe_newton;

/// How a step went.
typedef struct sn_fe_outcome {
    bool converged;
    bool rounded; ///< accepted above the tolerance, because rounding keeps the residual up
    int iterations;
    sn_fe_balance balance;    ///< of the last state
    char reason[SN_TEXT_MAX]; ///< why it did not converge
} sn_fe_outcome;

sn_status sn_fe_newton_init(sn_fe_newton *n, sn_fe_problem *problem, double tolerance);
void sn_fe_newton_free(sn_fe_newton *n);
/// Solves for the level that the problem has begun. With `predict`, x is the state at the start of
/// the step and the first iteration carries the prescribed increments through the tangent; without,
/// x is a guess that holds the prescribed values already.
/// @return SN_OK also where it did not converge; SN_E_SOLVER, SN_E_MEMORY.
sn_status sn_fe_newton_solve(sn_fe_newton *n, bool predict, double *x, sn_fe_outcome *out);
