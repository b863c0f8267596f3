// PETSc for the files that call it: start, errors, whose ranks take part.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <petscksp.h>

#include "sinew/base.h"

/// Jumps to `fail` with `status` set where a call of PETSc fails.
#define TRY_PETSC(call, what)                                                                      \
    do {                                                                                           \
        PetscErrorCode try_code_ = (call);                                                         \
        if (try_code_) {                                                                           \
            status = sn_fe_petsc_failed(try_code_, (what));                                        \
            goto fail;                                                                             \
        }                                                                                          \
    } while (0)

/// Stores PETSc's text. @return SN_E_MEMORY or SN_E_SOLVER.
sn_status sn_fe_petsc_failed(PetscErrorCode code, const char *what);
/// Starts PETSc, and MPI with it, where nobody has. On several ranks all call it.
sn_status sn_fe_petsc_start(void);
