// A preconditioner whose work and memory grow with the unknowns: multigrid.
// SPDX-License-Identifier: Apache-2.0
//
// Displacements: smoothed aggregation (GAMG) with the six rigid motions as what a coarse level must
// represent, three unknowns a node. P2P1: block triangular,
//     x_p = -S^-1 r_p,   x_u = A^-1 (r_u - B^T x_p),
// with one cycle for A^-1 and, for the Schur complement S = B A^-1 B^T + C of the pressures, the
// diagonal of the pressures' mass with weight 1/mu + 1/K, whose spectrum is that of S up to
// constants that know nothing of the mesh (Elman, Silvester & Wathen, Finite elements and fast
// iterative solvers, chapter 5). mu is that of each cell as it is strained: sn_fe_cell_tangent()
// reads it from the trace of the cell's own matrix. A is formed without the pressure: with it A is
// positive only where the volume keeps, which neither a smoother nor a coarse level knows.
#pragma once

#include "continuum/petsc.h"
#include "continuum/solver.h"

typedef struct sn_fe_multigrid sn_fe_multigrid;

/// For a matrix of a `whole` pattern. @return SN_OK, SN_E_SOLVER, SN_E_MEMORY.
sn_status sn_fe_multigrid_create(const sn_fe_solver_def *def, Mat matrix, sn_fe_multigrid **out);
void sn_fe_multigrid_destroy(sn_fe_multigrid *m); // NULL is allowed
/// Builds the hierarchy of the present values. *good is false where there is none.
sn_status sn_fe_multigrid_renew(sn_fe_multigrid *m, bool *good);
/// Takes B from the present values.
sn_status sn_fe_multigrid_couple(sn_fe_multigrid *m);
/// x = one application to r: a fixed linear map.
PetscErrorCode sn_fe_multigrid_apply(sn_fe_multigrid *m, Vec r, Vec x);
