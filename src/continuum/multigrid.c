// A preconditioner whose work and memory grow with the unknowns: multigrid.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/multigrid.h"

#include <math.h>

struct sn_fe_multigrid {
    const sn_fe_pattern *pattern;
    const sn_fe_space *space;
    const double *soft; // diagonal of S, by corners; NULL without pressures
    Mat matrix;         // borrowed
    Mat A, Bt;          // displacements; with pressures copies of their parts
    IS part[2];         // rows of displacements and pressures, where there are pressures
    PC cycle;           // of A
    Vec correction;     // B^T x_p
};

//---- life ---------------------------------------------------------------------------------------

void sn_fe_multigrid_destroy(sn_fe_multigrid *m) {
    if (!m) return;
    PCDestroy(&m->cycle);
    VecDestroy(&m->correction);
    MatDestroy(&m->A);
    MatDestroy(&m->Bt);
    for (int k = 0; k < 2; k++) ISDestroy(&m->part[k]);
    sn_free(m);
}

// The rigid motions of the nodes of this rank, as what multigrid must represent.
static sn_status describe_motions(sn_fe_multigrid *m) {
    sn_status status = SN_OK;
    const sn_fe_pattern *p = m->pattern;
    Vec rest = NULL;
    MatNullSpace motions = NULL;
    PetscScalar *to;
    TRY_PETSC(MatCreateVecs(m->A, &rest, NULL), "multigrid");
    TRY_PETSC(VecSetBlockSize(rest, 3), "multigrid");
    TRY_PETSC(VecGetArray(rest, &to), "multigrid");
    for (int k = p->own_from; k < p->own_to; k++)
        for (int i = 0; i < 3 && p->by_row[k] < m->space->nodes; i++)
            *to++ = m->space->rest[3 * p->by_row[k] + i];
    to -= p->pressures;
    TRY_PETSC(VecRestoreArray(rest, &to), "multigrid");
    TRY_PETSC(MatNullSpaceCreateRigidBody(rest, &motions), "multigrid");
    TRY_PETSC(MatSetNearNullSpace(m->A, motions), "multigrid");
fail:
    MatNullSpaceDestroy(&motions);
    VecDestroy(&rest);
    return status;
}

// The rows of displacements and of pressures of this rank, and the parts of the matrix.
static sn_status split(sn_fe_multigrid *m) {
    sn_status status = SN_OK;
    const sn_fe_pattern *p = m->pattern;
    MPI_Comm comm = PetscObjectComm((PetscObject)m->matrix);
    TRY_PETSC(ISCreateStride(comm, p->pressures, p->first, 1, &m->part[0]), "multigrid");
    TRY_PETSC(ISCreateStride(comm, p->rows - p->pressures, p->first + p->pressures, 1, &m->part[1]),
              "multigrid");
    TRY_PETSC(ISSetBlockSize(m->part[0], 3), "multigrid");
    TRY_PETSC(MatCreateSubMatrix(m->matrix, m->part[0], m->part[0], MAT_INITIAL_MATRIX, &m->A),
              "multigrid");
    TRY_PETSC(MatCreateSubMatrix(m->matrix, m->part[0], m->part[1], MAT_INITIAL_MATRIX, &m->Bt),
              "multigrid");
    TRY_PETSC(MatCreateVecs(m->A, NULL, &m->correction), "multigrid");
fail:
    return status;
}

static sn_status create_cycle(sn_fe_multigrid *m) {
    sn_status status = SN_OK;
    TRY_PETSC(MatSetBlockSize(m->A, 3), "multigrid");
    SN_TRY_GOTO(status, describe_motions(m));
    TRY_PETSC(PCCreate(PetscObjectComm((PetscObject)m->A), &m->cycle), "multigrid");
    TRY_PETSC(PCSetType(m->cycle, PCGAMG), "multigrid");
    // some of its defaults come only with this call
    TRY_PETSC(PCSetOptionsPrefix(m->cycle, "sinew_"), "multigrid");
    TRY_PETSC(PCSetFromOptions(m->cycle), "multigrid");
    // bounds of the spectrum that smoothers rely on come with the interpolation: old ones ruin it
    TRY_PETSC(PCGAMGSetReuseInterpolation(m->cycle, PETSC_FALSE), "multigrid");
fail:
    return status;
}

sn_status sn_fe_multigrid_create(const sn_fe_solver_def *def, Mat matrix, sn_fe_multigrid **out) {
    sn_status status = SN_OK;
    sn_fe_multigrid *m = *out = sn_alloc(1, sizeof *m);
    if (!m) return SN_E_MEMORY;
    m->pattern = def->pattern;
    m->space = def->space;
    m->matrix = matrix;
    if (def->space->element.mixed) {
        m->soft = def->soft;
        SN_TRY_GOTO(status, split(m));
    } else {
        PetscObjectReference((PetscObject)matrix);
        m->A = matrix;
    }
    SN_TRY_GOTO(status, create_cycle(m));
    return SN_OK;
fail:
    sn_fe_multigrid_destroy(m);
    *out = NULL;
    return status;
}

//---- use ----------------------------------------------------------------------------------------

sn_status sn_fe_multigrid_couple(sn_fe_multigrid *m) {
    sn_status status = SN_OK;
    TRY_PETSC(MatCreateSubMatrix(m->matrix, m->part[0], m->part[1], MAT_REUSE_MATRIX, &m->Bt),
              "multigrid");
fail:
    return status;
}

sn_status sn_fe_multigrid_renew(sn_fe_multigrid *m, bool *good) {
    sn_status status = SN_OK;
    *good = false;
    if (m->soft)
        TRY_PETSC(MatCreateSubMatrix(m->matrix, m->part[0], m->part[0], MAT_REUSE_MATRIX, &m->A),
                  "multigrid");
    TRY_PETSC(PCSetOperators(m->cycle, m->A, m->A), "multigrid");
    // what is not finite or not of full rank fails in many places of the setup, and is no error
    *good = PCSetUp(m->cycle) == 0;
fail:
    return status;
}

// x_p = -S^-1 r_p, then the right-hand side of the displacements.
static PetscErrorCode eliminate(sn_fe_multigrid *m, Vec r, Vec x) {
    const sn_fe_pattern *p = m->pattern;
    const PetscScalar *from;
    PetscScalar *to;
    Vec r_u, x_p;
    PetscCall(VecGetArrayRead(r, &from));
    PetscCall(VecGetArray(x, &to));
    for (int row = p->pressures, k = p->own_from + p->pressures / 3; k < p->own_to; k++, row++)
        to[row] = -from[row] / m->soft[p->by_row[k] - m->space->nodes];
    PetscCall(VecRestoreArray(x, &to));
    PetscCall(VecRestoreArrayRead(r, &from));
    PetscCall(VecGetSubVector(x, m->part[1], &x_p));
    PetscCall(MatMult(m->Bt, x_p, m->correction));
    PetscCall(VecRestoreSubVector(x, m->part[1], &x_p));
    PetscCall(VecGetSubVector(r, m->part[0], &r_u));
    PetscCall(VecAYPX(m->correction, -1.0, r_u));
    PetscCall(VecRestoreSubVector(r, m->part[0], &r_u));
    return 0;
}

PetscErrorCode sn_fe_multigrid_apply(sn_fe_multigrid *m, Vec r, Vec x) {
    Vec x_u;
    if (!m->soft) return PCApply(m->cycle, r, x);
    PetscCall(eliminate(m, r, x));
    PetscCall(VecGetSubVector(x, m->part[0], &x_u));
    PetscCall(PCApply(m->cycle, m->correction, x_u));
    PetscCall(VecRestoreSubVector(x, m->part[0], &x_u));
    return 0;
}
