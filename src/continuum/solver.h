// The linear solver: MUMPS through PETSc.
// SPDX-License-Identifier: Apache-2.0
//
// The matrix lies in our own compressed rows; PETSc reads them in place. The symbolic factorisation
// is made once and used for all of a run. One rank: everything lives on PETSC_COMM_SELF.
//
// A factorisation costs as much as tens of solutions with its factors (27 at 33,000 unknowns of a
// block, 60 at 150,000), while the tangent changes little from one Newton iteration to the next.
// sn_fe_solver_reduce() therefore keeps the factors as a preconditioner of GMRES on the present
// matrix, and replaces them when that is cheaper: when a decimal digit of the last solution cost
// more than a digit has cost on average since the factors were made, they included (the rule for
// the replacement of a machine that wears). Costs are counted, not timed, so that the same input
// gives the same bits. Where GMRES needs more than a factorisation would cost, new factors are made
// at once.
#pragma once

#include "continuum/pattern.h"

typedef struct sn_fe_solver sn_fe_solver;

/// Starts PETSc where nobody has, and analyses the pattern.
/// @param value      entries of the matrix, borrowed for the life of the solver
/// @param symmetric  LDLT instead of LU
/// @return SN_OK, SN_E_SOLVER (with PETSc's text), SN_E_MEMORY.
sn_status sn_fe_solver_create(const sn_fe_pattern *pattern, double *value, bool symmetric,
                              sn_fe_solver **solver);
void sn_fe_solver_destroy(sn_fe_solver *solver); // NULL is allowed
/// Weight of the equations from row `first` on (the pressures') against those before it, in the
/// norm that sn_fe_solver_reduce() reduces. 1 at the start.
void sn_fe_solver_weigh(sn_fe_solver *solver, int first, double weight);
/// Solves with the present values until the weighted residual is at most `reduction` times that of
/// x = 0, by whatever means is cheapest. *good is false where the matrix is singular or not finite.
/// @param b right-hand side (rows)  @param x solution (rows)
sn_status sn_fe_solver_reduce(sn_fe_solver *solver, double reduction, double *b, double *x,
                              bool *good);
/// Drops the factors, so that what follows does not depend on what went before.
void sn_fe_solver_forget(sn_fe_solver *solver);
/// What it has done so far.
typedef struct sn_fe_solver_work {
    int factorisations;
    int applications; ///< of the factors
    double seconds;   ///< of the processor, in sn_fe_solver_reduce()
} sn_fe_solver_work;
sn_fe_solver_work sn_fe_solver_done(const sn_fe_solver *solver);
/// Factors the present values. *good is false where the matrix is singular or not finite.
sn_status sn_fe_solver_factor(sn_fe_solver *solver, bool *good);
/// Solves with the last factors. @param b right-hand side (rows)  @param x solution (rows)
sn_status sn_fe_solver_solve(sn_fe_solver *solver, double *b, double *x);
