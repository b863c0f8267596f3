// The linear solver: MUMPS through PETSc.
// SPDX-License-Identifier: Apache-2.0
//
// The matrix lies in our own compressed rows; PETSc reads them in place. The symbolic factorisation
// is made once and used for all of a run. One rank: everything lives on PETSC_COMM_SELF.
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
/// Factors the present values. *good is false where the matrix is singular or not finite.
sn_status sn_fe_solver_factor(sn_fe_solver *solver, bool *good);
/// Solves with the last factors. @param b right-hand side (rows)  @param x solution (rows)
sn_status sn_fe_solver_solve(sn_fe_solver *solver, double *b, double *x);
