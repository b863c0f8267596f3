// The linear solver: MUMPS or multigrid through PETSc.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/solver.h"

#include <math.h>
#include <string.h>
#include <time.h>

#include "continuum/multigrid.h"
#include "continuum/petsc.h"

struct sn_fe_solver {
    sn_fe_solver_def def;
    MPI_Comm comm;
    Mat matrix, factor;
    //---- several ranks and a small system: all rows, on each of them
    int *entries; // of each rank, then where they begin
    int *row_start, *column;
    double *value;              // NULL otherwise
    sn_fe_multigrid *multigrid; // instead of the factor; NULL where direct
    Vec b, x;
    int rows;         // of these vectors
    int *size, *from; // rows of each rank, for the solution; NULL on one
    int room;         // MUMPS' workspace in per cent over its estimate
    //---- reuse of the factors
    KSP gmres;       // NULL until it is needed first
    Vec scaled;      // what the factors are applied to
    Mat weighted;    // the matrix with weighted rows
    double weight;   // of the pressures' rows
    bool rough;      // the factors are approximate when they are made
    bool factored;   // there are factors, of this matrix or an older one
    double price;    // of a factorisation, in applications of the factors
    double fresh;    // applications a digit with a new hierarchy
    double spent;    // since they were made, with their price
    double digits;   // gained for that
    double marginal; // applications a digit in the last solution
    sn_fe_solver_work work;
};

enum { ROOM_FIRST = 40, ROOM_MOST = 2000, LARGE = 2000, LARGE_ROUGH = 20000, BASIS_MOST = 60 };
enum { BASIS_LARGE = 100, CYCLES_MOST = 500 }; // of multigrid
#define HIERARCHY 10.0                         // what a hierarchy of multigrid costs, in cycles
#define ROUGHNESS 1e-3                         // relative error of the blocks of low rank
#define LEAST_PIVOT 1e-8                       // over the largest of its row
#define FLOPS_AN_ENTRY 50.0 // that a factorisation does while one entry of the factors is applied

static sn_status analyse(sn_fe_solver *s) {
    sn_status status = SN_OK;
    MatFactorInfo info;
    TRY_PETSC(MatFactorInfoInitialize(&info), "analysis");
    TRY_PETSC(MatGetFactor(s->matrix, MATSOLVERMUMPS,
                           s->def.symmetric ? MAT_FACTOR_CHOLESKY : MAT_FACTOR_LU, &s->factor),
              "MUMPS (is PETSc built with it?)");
    TRY_PETSC(MatMumpsSetIcntl(s->factor, 14, s->room), "MUMPS workspace");
    PetscInt rows;
    TRY_PETSC(MatGetSize(s->matrix, &rows, NULL), "matrix");
    // PORD: two thirds of the time of the minimum degree that MUMPS takes for middle sizes
    if (rows > LARGE) TRY_PETSC(MatMumpsSetIcntl(s->factor, 7, 4), "MUMPS ordering");
    // blocks of low rank: factors that are good enough to start from, in two thirds of the time
    // small pivots too: pressures have blocks of -1/kappa, and such a matrix (quasi-definite) has
    // factors in any order; the search for large ones took half of the time
    if (s->rough) {
        TRY_PETSC(MatMumpsSetIcntl(s->factor, 35, 1), "MUMPS low rank");
        TRY_PETSC(MatMumpsSetCntl(s->factor, 7, ROUGHNESS), "MUMPS low rank");
        TRY_PETSC(MatMumpsSetCntl(s->factor, 1, LEAST_PIVOT), "MUMPS pivots");
    }
    if (s->def.symmetric)
        TRY_PETSC(MatCholeskyFactorSymbolic(s->factor, s->matrix, NULL, &info), "analysis");
    else
        TRY_PETSC(MatLUFactorSymbolic(s->factor, s->matrix, NULL, NULL, &info), "analysis");
fail:
    return status;
}

void sn_fe_solver_destroy(sn_fe_solver *s) {
    if (!s) return;
    KSPDestroy(&s->gmres);
    sn_fe_multigrid_destroy(s->multigrid);
    MatDestroy(&s->weighted);
    VecDestroy(&s->scaled);
    MatDestroy(&s->factor);
    MatDestroy(&s->matrix);
    VecDestroy(&s->b);
    VecDestroy(&s->x);
    void *const parts[] = {s->size, s->from, s->entries, s->row_start, s->column, s->value};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(s);
}

// Gives the rows of each rank to all.
static void exchange(const sn_fe_solver *s, double *v) {
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, v, s->size, s->from, MPI_DOUBLE,
                   PETSC_COMM_WORLD);
}

static sn_status list_rows(sn_fe_solver *s) {
    const sn_fe_pattern *p = s->def.pattern;
    size_t ranks = (size_t)s->def.space->ranks->count;
    s->size = sn_alloc(ranks, sizeof *s->size);
    s->from = sn_alloc(ranks, sizeof *s->from);
    if (!s->size || !s->from) return SN_E_MEMORY;
    MPI_Allgather(&p->rows, 1, MPI_INT, s->size, 1, MPI_INT, PETSC_COMM_WORLD);
    MPI_Allgather(&p->first, 1, MPI_INT, s->from, 1, MPI_INT, PETSC_COMM_WORLD);
    return SN_OK;
}

// The compressed rows of all ranks, one behind the other, for a matrix that each has for itself.
static sn_status join_rows(sn_fe_solver *s) {
    const sn_fe_pattern *p = s->def.pattern;
    int ranks = s->def.space->ranks->count, own = p->row_start[p->rows], entries = 0;
    s->entries = sn_alloc(2 * (size_t)ranks, sizeof *s->entries);
    s->row_start = sn_alloc((size_t)p->total + 1, sizeof *s->row_start);
    if (!s->entries || !s->row_start) return SN_E_MEMORY;
    MPI_Allgather(&own, 1, MPI_INT, s->entries, 1, MPI_INT, PETSC_COMM_WORLD);
    for (int r = 0; r < ranks; entries += s->entries[r++]) s->entries[ranks + r] = entries;
    s->column = sn_alloc((size_t)entries, sizeof *s->column);
    s->value = sn_alloc((size_t)entries, sizeof *s->value);
    if (!s->column || !s->value) return SN_E_MEMORY;
    MPI_Allgatherv(p->column, own, MPI_INT, s->column, s->entries, s->entries + ranks, MPI_INT,
                   PETSC_COMM_WORLD);
    for (int r = 0; r < p->rows; r++) s->row_start[p->first + r] = p->row_start[r];
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, s->row_start, s->size, s->from, MPI_INT,
                   PETSC_COMM_WORLD);
    for (int r = 0; r < ranks; r++)
        for (int k = s->from[r]; k < s->from[r] + s->size[r]; k++)
            s->row_start[k] += s->entries[ranks + r];
    s->row_start[p->total] = entries;
    return SN_OK;
}

static sn_status create_matrix(sn_fe_solver *s) {
    sn_status status = SN_OK;
    const sn_fe_pattern *p = s->def.pattern;
    bool several = s->def.space->ranks->count > 1;
    bool whole = several && p->total <= LARGE && !s->def.iterative;
    s->comm = several && !whole ? PETSC_COMM_WORLD : PETSC_COMM_SELF;
    s->rows = several && !whole ? p->rows : p->total;
    if (several) SN_TRY(list_rows(s));
    if (whole) SN_TRY(join_rows(s));
    if (several && !whole)
        TRY_PETSC(MatCreateMPIAIJWithArrays(s->comm, p->rows, p->rows, p->total, p->total,
                                            p->row_start, p->column, s->def.value, &s->matrix),
                  "matrix");
    else
        TRY_PETSC(MatCreateSeqAIJWithArrays(
                      s->comm, s->rows, s->rows, whole ? s->row_start : p->row_start,
                      whole ? s->column : p->column, whole ? s->value : s->def.value, &s->matrix),
                  "matrix");
    if (s->def.symmetric) TRY_PETSC(MatSetOption(s->matrix, MAT_SYMMETRIC, PETSC_TRUE), "matrix");
    for (int k = 0; k < 2; k++) {
        Vec *v = k ? &s->x : &s->b;
        if (s->comm != PETSC_COMM_SELF)
            TRY_PETSC(VecCreateMPIWithArray(s->comm, 1, s->rows, p->total, NULL, v), "vector");
        else
            TRY_PETSC(VecCreateSeqWithArray(s->comm, 1, s->rows, NULL, v), "vector");
    }
fail:
    return status;
}

sn_status sn_fe_solver_create(const sn_fe_solver_def *def, sn_fe_solver **solver) {
    sn_status status = SN_OK;
    *solver = NULL;
    SN_TRY(sn_fe_petsc_start());
    sn_fe_solver *s = sn_alloc(1, sizeof *s);
    if (!s) return SN_E_MEMORY;
    s->def = *def;
    s->room = ROOM_FIRST;
    s->rough = def->pattern->total > LARGE_ROUGH;
    s->weight = 1.0;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    SN_TRY_GOTO(status, create_matrix(s));
    if (def->iterative)
        SN_TRY_GOTO(status, sn_fe_multigrid_create(def, s->matrix, &s->multigrid));
    else
        SN_TRY_GOTO(status, analyse(s));
    PetscPopErrorHandler();
    *solver = s;
    return SN_OK;
fail:
    sn_fe_solver_destroy(s);
    PetscPopErrorHandler();
    return status;
}

// Hands the entries to PETSc as they are now.
static sn_status take_values(sn_fe_solver *s) {
    sn_status status = SN_OK;
    PetscScalar *value;
    if (s->value)
        MPI_Allgatherv(s->def.value, s->entries[s->def.space->ranks->rank], MPI_DOUBLE, s->value,
                       s->entries, s->entries + s->def.space->ranks->count, MPI_DOUBLE,
                       PETSC_COMM_WORLD);
    if (s->size && !s->value) {
        TRY_PETSC(MatUpdateMPIAIJWithArray(s->matrix, s->def.value), "matrix");
    } else { // handing the array back tells PETSc that it has changed
        TRY_PETSC(MatSeqAIJGetArray(s->matrix, &value), "matrix");
        TRY_PETSC(MatSeqAIJRestoreArray(s->matrix, &value), "matrix");
    }
fail:
    return status;
}

// Lends the vectors the rows of this rank; `lent` takes them back, and gives the solution to all.
static sn_status lend(sn_fe_solver *s, double *b, double *x) {
    sn_status status = SN_OK;
    int first = s->value ? 0 : s->def.pattern->first;
    if (s->value) exchange(s, b);
    TRY_PETSC(VecPlaceArray(s->b, b + first), "solution");
    TRY_PETSC(VecPlaceArray(s->x, x + first), "solution");
fail:
    return status;
}

static sn_status lent(sn_fe_solver *s, double *x) {
    sn_status status = SN_OK;
    TRY_PETSC(VecResetArray(s->b), "solution");
    TRY_PETSC(VecResetArray(s->x), "solution");
    if (s->size && !s->value) exchange(s, x);
fail:
    return status;
}

//---- factors ------------------------------------------------------------------------------------

static sn_status factor(sn_fe_solver *s, bool *good) {
    sn_status status = SN_OK;
    MatFactorInfo info;
    MatFactorError error = MAT_FACTOR_NOERROR;
    *good = false;
    TRY_PETSC(MatFactorInfoInitialize(&info), "factorisation");
    for (;;) {
        if (s->def.symmetric)
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
    return status;
}

// Factors the present values, or builds the hierarchy.
static sn_status renew(sn_fe_solver *s, bool *good) {
    sn_status status = SN_OK;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    if (s->multigrid && s->def.soft) s->def.assemble(s->def.context, false);
    SN_TRY_GOTO(status, take_values(s));
    if (s->multigrid)
        SN_TRY_GOTO(status, sn_fe_multigrid_renew(s->multigrid, good));
    else
        SN_TRY_GOTO(status, factor(s, good));
    s->factored = *good;
    s->work.factorisations++;
    if (!s->multigrid || !s->def.soft) goto fail;
    s->def.assemble(s->def.context, true);
    SN_TRY_GOTO(status, take_values(s));
    SN_TRY_GOTO(status, sn_fe_multigrid_couple(s->multigrid));
fail:
    PetscPopErrorHandler();
    return status;
}

// By the present factors.
static sn_status apply(sn_fe_solver *s, double *b, double *x) {
    sn_status status = SN_OK;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    SN_TRY_GOTO(status, lend(s, b, x));
    TRY_PETSC(MatSolve(s->factor, s->b, s->x), "solution");
    s->work.applications++;
    SN_TRY_GOTO(status, lent(s, x));
fail:
    PetscPopErrorHandler();
    return status;
}

//---- old factors as a preconditioner ------------------------------------------------------------

void sn_fe_solver_weigh(sn_fe_solver *s, double weight) {
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
    const sn_fe_pattern *p = s->def.pattern;
    PetscScalar *value;
    PetscCall(VecGetArray(v, &value));
    for (int k = p->pressures; k < p->rows && !s->value; k++) value[k] *= by;
    for (int b = s->def.space->nodes; b < p->blocks && s->value; b++) value[p->block_row[b]] *= by;
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
    if (s->multigrid)
        PetscCall(sn_fe_multigrid_apply(s->multigrid, s->scaled, x));
    else
        PetscCall(MatSolve(s->factor, s->scaled, x));
    s->work.applications++;
    return 0;
}

// GMRES on the weighted rows, preconditioned from the right so that it sees the true residual.
static sn_status create_gmres(sn_fe_solver *s) {
    sn_status status = SN_OK;
    PC pc;
    PetscInt rows = s->rows, total = s->def.pattern->total;
    TRY_PETSC(MatCreateShell(s->comm, rows, rows, total, total, s, &s->weighted), "GMRES");
    TRY_PETSC(MatShellSetOperation(s->weighted, MATOP_MULT, (void (*)(void))apply_weighted),
              "GMRES");
    TRY_PETSC(MatCreateVecs(s->matrix, &s->scaled, NULL), "GMRES");
    TRY_PETSC(KSPCreate(s->comm, &s->gmres), "GMRES");
    TRY_PETSC(KSPSetType(s->gmres, KSPGMRES), "GMRES");
    TRY_PETSC(KSPGMRESSetRestart(s->gmres, s->multigrid ? BASIS_LARGE : BASIS_MOST), "GMRES");
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

// *done where the preconditioner did it within `most` applications.
static sn_status iterate(sn_fe_solver *s, double reduction, int most, double *b, double *x,
                         bool *done) {
    sn_status status = SN_OK;
    KSPConvergedReason reason;
    PetscInt count;
    double digits = fmax(-log10(reduction), 0.5);
    *done = false;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    if (!s->gmres) SN_TRY_GOTO(status, create_gmres(s));
    TRY_PETSC(KSPSetTolerances(s->gmres, reduction, 0.0, PETSC_DEFAULT, most), "GMRES");
    SN_TRY_GOTO(status, lend(s, b, x));
    TRY_PETSC(scale_rows(s, s->weight, s->b), "GMRES");
    TRY_PETSC(KSPSolve(s->gmres, s->b, s->x), "GMRES");
    TRY_PETSC(scale_rows(s, 1.0 / s->weight, s->b), "GMRES");
    SN_TRY_GOTO(status, lent(s, x));
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
    SN_TRY_GOTO(status, renew(s, good));
fail:
    PetscPopErrorHandler();
    return status;
}

static sn_status reduce_by_factors(sn_fe_solver *s, double reduction, double *b, double *x,
                                   bool *good) {
    bool done = false;
    *good = true;
    if (s->factored && s->marginal * s->digits <= s->spent)
        SN_TRY(iterate(s, reduction, (int)fmin(ceil(s->price), BASIS_MOST), b, x, &done));
    if (done) return SN_OK;
    SN_TRY(renew(s, good));
    if (!*good) return SN_OK;
    SN_TRY(appraise(s));
    s->digits = s->marginal = 0.0;
    s->spent = s->price;
    if (s->rough) {
        SN_TRY(iterate(s, reduction, (int)fmin(ceil(s->price), BASIS_MOST), b, x, &done));
        if (done) return SN_OK;
        SN_TRY(refine(s, good)); // too ill-conditioned for that
        if (!*good) return SN_OK;
    }
    s->digits = fmax(-log10(reduction), 0.5);
    s->spent += 1.0;
    return apply(s, b, x);
}

//---- multigrid ----------------------------------------------------------------------------------

// What multigrid could not do: factors for this system, or for all that come.
static sn_status rescue(sn_fe_solver *s, double reduction, double *b, double *x, bool *good) {
    sn_status status = SN_OK;
    sn_fe_multigrid *multigrid = s->multigrid;
    s->work.rescues++;
    s->multigrid = NULL;
    s->factored = false;
    if (!s->factor) {
        PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
        status = analyse(s);
        PetscPopErrorHandler();
    }
    if (status == SN_OK) status = reduce_by_factors(s, reduction, b, x, good);
    if (s->work.rescues < SN_FE_RESCUES) {
        s->multigrid = multigrid;
        s->factored = false;
        MatDestroy(&s->factor);
    } else {
        sn_fe_multigrid_destroy(multigrid);
    }
    return status;
}

static sn_status reduce_by_multigrid(sn_fe_solver *s, double reduction, double *b, double *x,
                                     bool *good) {
    bool done = false;
    double digits = fmax(-log10(reduction), 0.5);
    *good = true;
    if (s->factored && s->marginal * s->digits <= s->spent) {
        int most = (int)ceil(2.0 * s->fresh * digits + HIERARCHY);
        SN_TRY(iterate(s, reduction, most, b, x, &done));
    }
    if (done) return SN_OK;
    SN_TRY(renew(s, good));
    s->digits = s->marginal = 0.0;
    s->spent = HIERARCHY;
    if (*good) SN_TRY(iterate(s, reduction, CYCLES_MOST, b, x, &done));
    s->fresh = s->marginal;
    return done ? SN_OK : rescue(s, reduction, b, x, good);
}

static sn_status reduce(sn_fe_solver *s, double reduction, double *b, double *x, bool *good) {
    SN_TRY(take_values(s));
    s->work.systems++;
    return s->multigrid ? reduce_by_multigrid(s, reduction, b, x, good)
                        : reduce_by_factors(s, reduction, b, x, good);
}

sn_status sn_fe_solver_reduce(sn_fe_solver *s, double reduction, double *b, double *x, bool *good) {
    clock_t start = clock();
    sn_status status = reduce(s, reduction, b, x, good);
    s->work.seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
    return status;
}
