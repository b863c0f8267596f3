// The linear solver: MUMPS through PETSc.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/solver.h"

#include <math.h>
#include <petscksp.h>
#include <stdlib.h>
#include <time.h>

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
    //---- reuse of the factors
    KSP gmres;       // NULL until it is needed first
    Vec scaled;      // what the factors are applied to
    Mat weighted;    // the matrix with weighted rows
    int first;       // first weighted row
    double weight;   // of the rows from `first` on
    bool rough;      // the factors are approximate when they are made
    bool factored;   // there are factors, of this matrix or an older one
    double price;    // of a factorisation, in applications of the factors
    double spent;    // since they were made, with their price
    double digits;   // gained for that
    double marginal; // applications a digit in the last solution
    sn_fe_solver_work work;
};

enum { ROOM_FIRST = 40, ROOM_MOST = 2000, LARGE = 2000, LARGE_ROUGH = 20000, BASIS_MOST = 60 };
#define ROUGHNESS 1e-3      // relative error of the blocks of low rank
#define FLOPS_AN_ENTRY 50.0 // that a factorisation does while one entry of the factors is applied

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
    PetscInt rows;
    TRY_PETSC(MatGetSize(s->matrix, &rows, NULL), "matrix");
    // PORD: two thirds of the time of the minimum degree that MUMPS takes for middle sizes
    if (rows > LARGE) TRY_PETSC(MatMumpsSetIcntl(s->factor, 7, 4), "MUMPS ordering");
    // blocks of low rank: factors that are good enough to start from, in two thirds of the time
    if (s->rough) {
        TRY_PETSC(MatMumpsSetIcntl(s->factor, 35, 1), "MUMPS low rank");
        TRY_PETSC(MatMumpsSetCntl(s->factor, 7, ROUGHNESS), "MUMPS low rank");
    }
    if (s->symmetric)
        TRY_PETSC(MatCholeskyFactorSymbolic(s->factor, s->matrix, NULL, &info), "analysis");
    else
        TRY_PETSC(MatLUFactorSymbolic(s->factor, s->matrix, NULL, NULL, &info), "analysis");
fail:
    return status;
}

void sn_fe_solver_destroy(sn_fe_solver *s) {
    if (!s) return;
    KSPDestroy(&s->gmres);
    MatDestroy(&s->weighted);
    VecDestroy(&s->scaled);
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
    s->rough = p->rows > LARGE_ROUGH;
    s->first = p->rows;
    s->weight = 1.0;
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
    s->factored = *good;
    s->work.factorisations++;
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
    s->work.applications++;
    TRY_PETSC(VecResetArray(s->b), "solution");
    TRY_PETSC(VecResetArray(s->x), "solution");
fail:
    PetscPopErrorHandler();
    return status;
}

//---- old factors as a preconditioner ------------------------------------------------------------

void sn_fe_solver_weigh(sn_fe_solver *s, int first, double weight) {
    s->first = first;
    s->weight = weight;
}

void sn_fe_solver_forget(sn_fe_solver *s) {
    s->factored = false;
    s->spent = s->digits = s->marginal = 0.0;
}

sn_fe_solver_work sn_fe_solver_done(const sn_fe_solver *s) {
    return s->work;
}

static PetscErrorCode scale_rows(const sn_fe_solver *s, double by, Vec v) {
    PetscScalar *value;
    PetscInt rows;
    PetscCall(VecGetLocalSize(v, &rows));
    PetscCall(VecGetArray(v, &value));
    for (PetscInt k = s->first; k < rows; k++) value[k] *= by;
    PetscCall(VecRestoreArray(v, &value));
    return 0;
}

static PetscErrorCode apply_weighted(Mat weighted, Vec x, Vec y) {
    sn_fe_solver *s;
    PetscCall(MatShellGetContext(weighted, &s));
    PetscCall(MatMult(s->matrix, x, y));
    return scale_rows(s, s->weight, y);
}

static PetscErrorCode apply_factors(PC pc, Vec y, Vec x) {
    sn_fe_solver *s;
    PetscCall(PCShellGetContext(pc, &s));
    PetscCall(VecCopy(y, s->scaled));
    PetscCall(scale_rows(s, 1.0 / s->weight, s->scaled));
    PetscCall(MatSolve(s->factor, s->scaled, x));
    s->work.applications++;
    return 0;
}

// GMRES on the weighted rows, preconditioned from the right so that it sees the true residual.
static sn_status create_gmres(sn_fe_solver *s) {
    sn_status status = SN_OK;
    PC pc;
    PetscInt rows;
    TRY_PETSC(MatGetSize(s->matrix, &rows, NULL), "GMRES");
    TRY_PETSC(MatCreateShell(PETSC_COMM_SELF, rows, rows, rows, rows, s, &s->weighted), "GMRES");
    TRY_PETSC(MatShellSetOperation(s->weighted, MATOP_MULT, (void (*)(void))apply_weighted),
              "GMRES");
    TRY_PETSC(MatCreateVecs(s->matrix, &s->scaled, NULL), "GMRES");
    TRY_PETSC(KSPCreate(PETSC_COMM_SELF, &s->gmres), "GMRES");
    TRY_PETSC(KSPSetType(s->gmres, KSPGMRES), "GMRES");
    TRY_PETSC(KSPGMRESSetRestart(s->gmres, BASIS_MOST), "GMRES");
    TRY_PETSC(KSPSetPCSide(s->gmres, PC_RIGHT), "GMRES");
    TRY_PETSC(KSPSetNormType(s->gmres, KSP_NORM_UNPRECONDITIONED), "GMRES");
    TRY_PETSC(KSPSetOperators(s->gmres, s->weighted, s->weighted), "GMRES");
    TRY_PETSC(KSPGetPC(s->gmres, &pc), "GMRES");
    TRY_PETSC(PCSetType(pc, PCSHELL), "GMRES");
    TRY_PETSC(PCShellSetContext(pc, s), "GMRES");
    TRY_PETSC(PCShellSetApply(pc, apply_factors), "GMRES");
fail:
    return status;
}

// *done where the old factors did it within their limit.
static sn_status iterate(sn_fe_solver *s, double reduction, double *b, double *x, bool *done) {
    sn_status status = SN_OK;
    KSPConvergedReason reason;
    PetscInt count, most = (PetscInt)fmin(ceil(s->price), BASIS_MOST);
    double digits = fmax(-log10(reduction), 0.5);
    *done = false;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    if (!s->gmres) SN_TRY_GOTO(status, create_gmres(s));
    TRY_PETSC(KSPSetTolerances(s->gmres, reduction, 0.0, PETSC_DEFAULT, most), "GMRES");
    TRY_PETSC(VecPlaceArray(s->b, b), "GMRES");
    TRY_PETSC(VecPlaceArray(s->x, x), "GMRES");
    TRY_PETSC(scale_rows(s, s->weight, s->b), "GMRES");
    TRY_PETSC(KSPSolve(s->gmres, s->b, s->x), "GMRES");
    TRY_PETSC(scale_rows(s, 1.0 / s->weight, s->b), "GMRES");
    TRY_PETSC(VecResetArray(s->b), "GMRES");
    TRY_PETSC(VecResetArray(s->x), "GMRES");
    TRY_PETSC(KSPGetConvergedReason(s->gmres, &reason), "GMRES");
    TRY_PETSC(KSPGetIterationNumber(s->gmres, &count), "GMRES");
    *done = reason > 0;
    s->marginal = (double)count / digits;
    s->spent += (double)count;
    s->digits += digits;
fail:
    PetscPopErrorHandler();
    return status;
}

// What a factorisation costs, by the counts of MUMPS.
static sn_status appraise(sn_fe_solver *s) {
    sn_status status = SN_OK;
    PetscReal flops;
    PetscInt entries;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    TRY_PETSC(MatMumpsGetRinfog(s->factor, 3, &flops), "MUMPS");
    TRY_PETSC(MatMumpsGetInfog(s->factor, 29, &entries), "MUMPS");
    // large counts come in millions, with a minus
    double size = entries < 0 ? -1e6 * (double)entries : (double)entries;
    s->price = flops / (FLOPS_AN_ENTRY * fmax(size, 1.0));
fail:
    PetscPopErrorHandler();
    return status;
}

// From now on factors as exact as rounding allows.
static sn_status refine(sn_fe_solver *s, bool *good) {
    sn_status status = SN_OK;
    s->rough = false;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    TRY_PETSC(MatDestroy(&s->factor), "factorisation");
    SN_TRY_GOTO(status, analyse(s));
    SN_TRY_GOTO(status, sn_fe_solver_factor(s, good));
fail:
    PetscPopErrorHandler();
    return status;
}

static sn_status reduce(sn_fe_solver *s, double reduction, double *b, double *x, bool *good) {
    bool done = false;
    *good = true;
    if (s->factored && s->marginal * s->digits <= s->spent)
        SN_TRY(iterate(s, reduction, b, x, &done));
    if (done) return SN_OK;
    SN_TRY(sn_fe_solver_factor(s, good));
    if (!*good) return SN_OK;
    SN_TRY(appraise(s));
    s->digits = s->marginal = 0.0;
    s->spent = s->price;
    if (s->rough) {
        SN_TRY(iterate(s, reduction, b, x, &done));
        if (done) return SN_OK;
        SN_TRY(refine(s, good)); // too ill-conditioned for that
        if (!*good) return SN_OK;
    }
    s->digits = fmax(-log10(reduction), 0.5);
    s->spent += 1.0;
    return sn_fe_solver_solve(s, b, x);
}

sn_status sn_fe_solver_reduce(sn_fe_solver *s, double reduction, double *b, double *x, bool *good) {
    clock_t start = clock();
    sn_status status = reduce(s, reduction, b, x, good);
    s->work.seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
    return status;
}
