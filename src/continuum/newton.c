// Newton's method with a line search, for one step.
// SPDX-License-Identifier: Apache-2.0
//
// The linear systems are solved no further than Newton's own convergence can use (Dembo, Eisenstat
// & Steihaug, SIAM J. Numer. Anal. 19 (1982) 400): to a reduction of the order of the error itself,
// which keeps the convergence quadratic, and not below what the tolerance still asks for.
//
// The error to be reduced is that of sn_fe_balance. A full step that reduces it is taken; else the
// step is halved. Where halving does not help, the best of the trials is taken for a while: near
// rounding level the error cannot fall, and a state that stagnates there is as good as it gets.
#include "continuum/newton.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROUNDED 1e-5 // largest error at which stagnation is put down to rounding
#define LOOSEST 1e-2 // reduction of the residual by a linear solution
#define LIFTED 1e-4  // the same where prescribed increments are carried into the body
#define SHARE 0.2    // of the tolerance that a linear solution may leave
enum { HALVINGS = 6, STALLS = 3 };

sn_status sn_fe_newton_init(sn_fe_newton *n, sn_fe_problem *problem, double tolerance) {
    size_t dofs = (size_t)problem->space->dofs, rows = (size_t)problem->pattern->total;
    *n = (sn_fe_newton){.problem = problem, .tolerance = tolerance};
    n->trial = sn_alloc(dofs, sizeof *n->trial);
    n->increment = sn_alloc(dofs, sizeof *n->increment);
    n->right = sn_alloc(rows, sizeof *n->right);
    n->solution = sn_alloc(rows, sizeof *n->solution);
    return n->trial && n->increment && n->right && n->solution ? SN_OK : SN_E_MEMORY;
}

void sn_fe_newton_free(sn_fe_newton *n) {
    sn_free(n->trial);
    sn_free(n->increment);
    sn_free(n->right);
    sn_free(n->solution);
    *n = (sn_fe_newton){0};
}

// How far a linear system is solved at an error of the state.
static double reduction(const sn_fe_newton *n, double error) {
    return fmax(fmin(error, LOOSEST), fmin(SHARE * n->tolerance / error, LOOSEST));
}

// The Newton increment at x, whose balance is `at`; with `lift`, `increment` holds the prescribed
// increments already.
static sn_status find_increment(sn_fe_newton *n, const double *x, const sn_fe_balance *at,
                                bool lift, bool *good) {
    sn_fe_problem *p = n->problem;
    const int *row = p->pattern->row;
    int dofs = p->space->dofs;
    *good = true;
    if (!p->solver) return SN_OK; // everything is prescribed
    sn_fe_problem_tangent(p, x, lift ? n->increment : NULL);
    for (int d = 0; d < dofs; d++)
        if (row[d] >= 0) n->right[row[d]] = -p->residual[d] - p->lifted[d];
    sn_fe_problem_weigh(p, at);
    SN_TRY(sn_fe_solver_reduce(p->solver, lift ? LIFTED : reduction(n, at->error), n->right,
                               n->solution, good));
    for (int k = 0; k < p->pattern->total && *good; k++) *good = isfinite(n->solution[k]);
    for (int d = 0; d < dofs && *good; d++)
        if (row[d] >= 0)
            n->increment[d] = n->solution[row[d]];
        else if (!lift)
            n->increment[d] = 0.0;
    if (*good) sn_fe_rigid_project(p->space, row, x, n->increment);
    return SN_OK;
}

static void try_length(sn_fe_newton *n, const double *x, double length, sn_fe_balance *balance) {
    for (int d = 0; d < n->problem->space->dofs; d++) n->trial[d] = x[d] + length * n->increment[d];
    sn_fe_problem_balance(n->problem, n->trial, balance);
}

// Moves x along the increment. Returns false where no trial is sound; *stalled where none is
// better.
static bool search(sn_fe_newton *n, double *x, sn_fe_balance *balance, bool *stalled) {
    double start = balance->error, best = (double)INFINITY, best_length = 0.0, length = 1.0;
    sn_fe_balance at;
    *stalled = false;
    for (int k = 0; k <= HALVINGS; k++, length *= 0.5) {
        try_length(n, x, length, &at);
        bool better = at.sound && at.error <= (1.0 - 1e-4 * length) * start;
        if (better || (at.sound && at.error <= n->tolerance)) {
            memcpy(x, n->trial, (size_t)n->problem->space->dofs * sizeof *x);
            *balance = at;
            return true;
        }
        if (at.sound && at.error < best) {
            best = at.error;
            best_length = length;
        }
    }
    *stalled = true;
    if (best_length == 0.0) {
        *balance = at;
        return false;
    }
    try_length(n, x, best_length, balance);
    memcpy(x, n->trial, (size_t)n->problem->space->dofs * sizeof *x);
    return true;
}

static void explain_fault(const sn_fe_fault *fault, char *reason) {
    if (isnan(fault->J))
        snprintf(reason, SN_TEXT_MAX, "the stress of cell %d overflows", fault->cell);
    else
        snprintf(reason, SN_TEXT_MAX, "cell %d is turned inside out (J = %.3g)", fault->cell,
                 fault->J);
}

// The first iteration from the start of the step, prescribed increments included.
static sn_status predict_state(sn_fe_newton *n, double *x, sn_fe_outcome *out) {
    sn_fe_problem *p = n->problem;
    bool good;
    sn_fe_problem_balance(p, x, &out->balance);
    if (!out->balance.sound) {
        explain_fault(&out->balance.fault, out->reason);
        return SN_OK;
    }
    memset(n->increment, 0, (size_t)p->space->dofs * sizeof *n->increment);
    for (int d = 0; d < 3 * p->space->nodes; d++)
        if (p->pattern->row[d] == SN_FE_PRESCRIBED) n->increment[d] = p->prescribed[d] - x[d];
    SN_TRY(find_increment(n, x, &out->balance, true, &good));
    out->iterations = 1;
    if (!good) {
        snprintf(out->reason, sizeof out->reason, "the tangent is singular");
        out->balance.sound = false;
        return SN_OK;
    }
    try_length(n, x, 1.0, &out->balance);
    if (!out->balance.sound) explain_fault(&out->balance.fault, out->reason);
    memcpy(x, n->trial, (size_t)p->space->dofs * sizeof *x);
    for (int d = 0; d < 3 * p->space->nodes; d++) // no rounding in what is prescribed
        if (p->pattern->row[d] == SN_FE_PRESCRIBED) x[d] = p->prescribed[d];
    return SN_OK;
}

sn_status sn_fe_newton_solve(sn_fe_newton *n, bool predict, double *x, sn_fe_outcome *out) {
    *out = (sn_fe_outcome){0};
    if (predict)
        SN_TRY(predict_state(n, x, out));
    else
        sn_fe_problem_balance(n->problem, x, &out->balance);
    if (!out->balance.sound) {
        if (!out->reason[0]) explain_fault(&out->balance.fault, out->reason);
        return SN_OK;
    }
    n->trace[out->iterations] = out->balance.error;
    int stalls = 0;
    while (out->balance.error > n->tolerance) {
        bool good = true, stalled = false;
        if (stalls == STALLS || out->iterations == SN_FE_ITERATIONS) {
            out->rounded = out->balance.error < ROUNDED && stalls > 0;
            snprintf(out->reason, sizeof out->reason,
                     "%d iterations left a relative residual of %.3g", out->iterations,
                     out->balance.error);
            break;
        }
        SN_TRY(find_increment(n, x, &out->balance, false, &good));
        out->iterations++;
        if (!good) {
            snprintf(out->reason, sizeof out->reason, "the tangent is singular");
            return SN_OK;
        }
        if (!search(n, x, &out->balance, &stalled)) {
            explain_fault(&out->balance.fault, out->reason);
            return SN_OK;
        }
        n->trace[out->iterations] = out->balance.error;
        stalls = stalled ? stalls + 1 : 0;
    }
    out->converged = out->balance.error <= n->tolerance || out->rounded;
    return SN_OK;
}
