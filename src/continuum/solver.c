// The linear solver: MUMPS through PETSc.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/solver.h"

#include <petscmat.h>
#include <stdlib.h>

// MPI, which PETSc starts, does not give all its memory back at the end; that would hide our own
// leaks from the leak checker.
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#define LEAKS_OF_OTHERS(call) (__lsan_disable(), (call), __lsan_enable())
#else
#define LEAKS_OF_OTHERS(call) ((void)(call))
#endif

struct sn_fe_solver {
    Mat matrix, factor;
    Vec b, x;
    bool symmetric;
    int room; // MUMPS' workspace in per cent over its estimate
};

enum { ROOM_FIRST = 40, ROOM_MOST = 2000 };

static sn_status petsc_failed(PetscErrorCode code, const char *what) {
    const char *text = NULL;
    PetscErrorMessage(code, &text, NULL);
    return sn_fail(code == PETSC_ERR_MEM ? SN_E_MEMORY : SN_E_SOLVER, "%s: PETSc error %d: %s",
                   what, (int)code, text ? text : "unknown");
}

#define TRY_PETSC(call, what)                                                                      \
    do {                                                                                           \
        PetscErrorCode try_code_ = (call);                                                         \
        if (try_code_) {                                                                           \
            status = petsc_failed(try_code_, (what));                                              \
            goto fail;                                                                             \
        }                                                                                          \
    } while (0)

// OpenBLAS starts a thread a core, which on the small fronts of a factorisation mostly wait for
// each other (a third of the processor time of an indentation went into that) and fight with other
// ranks. Weak: another BLAS has no such function.
void openblas_set_num_threads(int threads) __attribute__((weak));

static void finish_petsc(void) {
    LEAKS_OF_OTHERS(PetscFinalize());
}

static sn_status start_petsc(void) {
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

static sn_status analyse(sn_fe_solver *s) {
    sn_status status = SN_OK;
    MatFactorInfo info;
    TRY_PETSC(MatFactorInfoInitialize(&info), "analysis");
    TRY_PETSC(MatGetFactor(s->matrix, MATSOLVERMUMPS,
                           s->symmetric ? MAT_FACTOR_CHOLESKY : MAT_FACTOR_LU, &s->factor),
              "MUMPS (is PETSc built with it?)");
    TRY_PETSC(MatMumpsSetIcntl(s->factor, 14, s->room), "MUMPS workspace");
    if (s->symmetric)
        TRY_PETSC(MatCholeskyFactorSymbolic(s->factor, s->matrix, NULL, &info), "analysis");
    else
        TRY_PETSC(MatLUFactorSymbolic(s->factor, s->matrix, NULL, NULL, &info), "analysis");
fail:
    return status;
}

void sn_fe_solver_destroy(sn_fe_solver *s) {
    if (!s) return;
    MatDestroy(&s->factor);
    MatDestroy(&s->matrix);
    VecDestroy(&s->b);
    VecDestroy(&s->x);
    sn_free(s);
}

sn_status sn_fe_solver_create(const sn_fe_pattern *p, double *value, bool symmetric,
                              sn_fe_solver **solver) {
    sn_status status = SN_OK;
    *solver = NULL;
    SN_TRY(start_petsc());
    sn_fe_solver *s = sn_alloc(1, sizeof *s);
    if (!s) return SN_E_MEMORY;
    s->symmetric = symmetric;
    s->room = ROOM_FIRST;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    TRY_PETSC(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, p->rows, p->rows, p->row_start, p->column,
                                        value, &s->matrix),
              "matrix");
    if (symmetric) TRY_PETSC(MatSetOption(s->matrix, MAT_SYMMETRIC, PETSC_TRUE), "matrix");
    TRY_PETSC(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, p->rows, NULL, &s->b), "vector");
    TRY_PETSC(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, p->rows, NULL, &s->x), "vector");
    SN_TRY_GOTO(status, analyse(s));
    PetscPopErrorHandler();
    *solver = s;
    return SN_OK;
fail:
    sn_fe_solver_destroy(s);
    PetscPopErrorHandler();
    return status;
}

sn_status sn_fe_solver_factor(sn_fe_solver *s, bool *good) {
    sn_status status = SN_OK;
    MatFactorInfo info;
    MatFactorError error = MAT_FACTOR_NOERROR;
    *good = false;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    TRY_PETSC(MatFactorInfoInitialize(&info), "factorisation");
    PetscScalar *value; // handing the array back tells PETSc that it has changed
    TRY_PETSC(MatSeqAIJGetArray(s->matrix, &value), "factorisation");
    TRY_PETSC(MatSeqAIJRestoreArray(s->matrix, &value), "factorisation");
    for (;;) {
        if (s->symmetric)
            TRY_PETSC(MatCholeskyFactorNumeric(s->factor, s->matrix, &info), "factorisation");
        else
            TRY_PETSC(MatLUFactorNumeric(s->factor, s->matrix, &info), "factorisation");
        TRY_PETSC(MatFactorGetError(s->factor, &error), "factorisation");
        if (error != MAT_FACTOR_OUTMEMORY || s->room >= ROOM_MOST) break;
        s->room *= 3; // pivoting needed more than the analysis foresaw
        TRY_PETSC(MatDestroy(&s->factor), "factorisation");
        SN_TRY_GOTO(status, analyse(s));
    }
    if (error == MAT_FACTOR_OUTMEMORY)
        status = sn_fail(SN_E_MEMORY, "MUMPS ran out of memory in the factorisation");
    *good = error == MAT_FACTOR_NOERROR;
fail:
    PetscPopErrorHandler();
    return status;
}

sn_status sn_fe_solver_solve(sn_fe_solver *s, double *b, double *x) {
    sn_status status = SN_OK;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    TRY_PETSC(VecPlaceArray(s->b, b), "solution");
    TRY_PETSC(VecPlaceArray(s->x, x), "solution");
    TRY_PETSC(MatSolve(s->factor, s->b, s->x), "solution");
    TRY_PETSC(VecResetArray(s->b), "solution");
    TRY_PETSC(VecResetArray(s->x), "solution");
fail:
    PetscPopErrorHandler();
    return status;
}
