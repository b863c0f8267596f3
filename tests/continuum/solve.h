// One state, solved for where a test prescribes the motion of the boundary.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "body.h"
#include "continuum/measure.h"
#include "continuum/newton.h"

/// A test fills p->prescribed in between.
typedef struct solve {
    sn_case *c; ///< not owned
    sn_fe_problem *p;
    sn_fe_newton newton;
    sn_fe_measure *m;
    sn_record *history;
    double *x; ///< unknowns
} solve;

static inline solve solve_begin(sn_case *c, double tolerance) {
    solve s = {.c = c};
    CHECK_OK(sn_fe_problem_create(c, 1, &s.p));
    CHECK_OK(sn_fe_newton_init(&s.newton, s.p, tolerance));
    s.x = sn_alloc((size_t)s.p->space->dofs, sizeof *s.x);
    sn_fe_problem_begin(s.p, (sn_fe_level){1, 1, 1});
    return s;
}

static inline void solve_step(solve *s) {
    sn_fe_outcome out;
    CHECK_OK(sn_fe_newton_solve(&s->newton, true, s->x, &out));
    assert_true(out.converged);
}

/// Hands the solution to a sink of frames; s->m holds its fields then.
static inline void solve_frame(solve *s, const sn_output *output) {
    CHECK_OK(sn_record_create("test", &s->history));
    CHECK_OK(sn_case_history_columns(s->c, s->history));
    CHECK_OK(sn_fe_measure_create(s->p, s->history, true, &s->m));
    CHECK_OK(sn_fe_measure_frame(s->m, s->p, s->x, output));
}

static inline void solve_end(solve *s) {
    sn_fe_measure_destroy(s->m, s->c);
    sn_record_destroy(s->history);
    sn_free(s->x);
    sn_fe_newton_free(&s->newton);
    sn_fe_problem_destroy(s->p);
}
