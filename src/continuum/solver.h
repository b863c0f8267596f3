// The linear solver: MUMPS or multigrid through PETSc.
// SPDX-License-Identifier: Apache-2.0
//
// The matrix lies in our own compressed rows; on one rank PETSc reads them in place, on several it
// copies those of its rank. The symbolic factorisation is made once and used for all of a run.
// Small systems take longer to share than to solve: every rank then gets the whole matrix and
// solves it for itself.
//
// A factorisation costs as much as tens of solutions with its factors (27 at 33,000 unknowns of a
// block, 60 at 150,000), while the tangent changes little from one Newton iteration to the next.
// sn_fe_solver_reduce() therefore keeps the factors as a preconditioner of GMRES on the present
// matrix, and replaces them when that is cheaper: when a decimal digit of the last solution cost
// more than a digit has cost on average since the factors were made, they included (the rule for
// the replacement of a machine that wears). Costs are counted, not timed, so that the same input
// gives the same bits. Where GMRES needs more than a factorisation would cost, new factors are made
// at once.
//
// `iterative` has multigrid (multigrid.h) in the place of the factors, by the same rule. A system
// that it does not solve is given to MUMPS; after SN_FE_RESCUES of them everything is.
#pragma once

#include "continuum/pattern.h"

typedef struct sn_fe_solver sn_fe_solver;

enum { SN_FE_RESCUES = 3 };
#define SN_FE_EXACT 1e-10

/// What to solve. All is borrowed for the life of the solver.
typedef struct sn_fe_solver_def {
    const sn_fe_space *space;
    const sn_fe_pattern *pattern; ///< whole where `iterative`
    double *value;                ///< entries of the matrix
    const double *soft;           ///< P2P1: diagonal of the pressures' Schur complement (corners)
    bool symmetric;               ///< LDLT instead of LU
    bool iterative;
    /// P2P1, iterative: fills `value` for the state of the last assembly, with or without what the
    /// pressure does in the block of the displacements.
    void (*assemble)(void *context, bool pressed);
    void *context;
} sn_fe_solver_def;

/// Analyses the pattern. On several ranks all call it, as everything below.
/// @return SN_OK, SN_E_SOLVER (with PETSc's text), SN_E_MEMORY.
sn_status sn_fe_solver_create(const sn_fe_solver_def *def, sn_fe_solver **solver);
void sn_fe_solver_destroy(sn_fe_solver *solver); // NULL is allowed
/// Weight of the pressure equations against the forces in the norm that sn_fe_solver_reduce()
/// reduces. 1 at the start.
void sn_fe_solver_weigh(sn_fe_solver *solver, double weight);
/// Solves with the present values until the weighted residual is at most `reduction` times that of
/// x = 0, by whatever means is cheapest. *good is false where the matrix is singular or not finite.
/// @param b right-hand side; what counts are the rows of this rank (total)
/// @param x solution, the same on all ranks                       (total)
sn_status sn_fe_solver_reduce(sn_fe_solver *solver, double reduction, double *b, double *x,
                              bool *good);
/// Drops the factors, so that what follows does not depend on what went before.
void sn_fe_solver_forget(sn_fe_solver *solver);
/// What it has done so far.
typedef struct sn_fe_solver_work {
    int factorisations; ///< or hierarchies of multigrid
    int applications;   ///< of the factors, or cycles of multigrid
    int systems;        ///< that were solved
    int rescues;        ///< of these, that multigrid had to leave to MUMPS
    double seconds;     ///< of the processor, in sn_fe_solver_reduce()
} sn_fe_solver_work;
sn_fe_solver_work sn_fe_solver_done(const sn_fe_solver *solver);
