// PETSc for the files that call it: start, errors, whose ranks take part.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/petsc.h"

#include <stdlib.h>

// MPI, which PETSc starts, does not give all its memory back at the end; that would hide our own
// leaks from the leak checker.
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#define LEAKS_OF_OTHERS(call) (__lsan_disable(), (call), __lsan_enable())
#else
#define LEAKS_OF_OTHERS(call) ((void)(call))
#endif

sn_status sn_fe_petsc_failed(PetscErrorCode code, const char *what) {
    const char *text = NULL;
    PetscErrorMessage(code, &text, NULL);
    return sn_fail(code == PETSC_ERR_MEM ? SN_E_MEMORY : SN_E_SOLVER, "%s: PETSc error %d: %s",
                   what, (int)code, text ? text : "unknown");
}

// OpenBLAS starts a thread a core, which on the small fronts of a factorisation mostly wait for
// each other (a third of the processor time of an indentation went into that) and fight with other
// ranks. Weak: another BLAS has no such function.
void openblas_set_num_threads(int threads) __attribute__((weak));

static void finish_petsc(void) {
    LEAKS_OF_OTHERS(PetscFinalize());
}

sn_status sn_fe_petsc_start(void) {
    sn_status status = SN_OK;
    PetscBool started = PETSC_FALSE, ended = PETSC_FALSE;
    TRY_PETSC(PetscInitialized(&started), "start");
    TRY_PETSC(PetscFinalized(&ended), "start");
    if (ended) return sn_fail(SN_E_SOLVER, "PETSc was shut down in this process");
    if (started) return SN_OK;
    if (openblas_set_num_threads && !getenv("OPENBLAS_NUM_THREADS")) openblas_set_num_threads(1);
    TRY_PETSC(PetscOptionsSetValue(NULL, "-no_signal_handler", "true"), "start");
    PetscErrorCode code;
    LEAKS_OF_OTHERS(code = PetscInitializeNoArguments());
    TRY_PETSC(code, "start");
    atexit(finish_petsc);
fail:
    return status;
}
