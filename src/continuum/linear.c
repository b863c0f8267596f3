// Linear statics: Navier's equation with the tangent of the laws at rest.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/linear.h"

#include <math.h>
#include <string.h>

#define PROBED_STRAIN 1e-5

//---- what belongs to a linear displacement -------------------------------------------------------

static void scale_state(const sn_fe_march *m, double by, double *out) {
    for (int d = 0; d < m->problem->space->dofs; d++) out[d] = by * m->x[d];
}

// Largest component of the Green strain at a state; INFINITY where it cannot be evaluated.
static double largest_strain(const sn_fe_problem *p, const double *x) {
    sn_fe_fault fault;
    double largest = 0.0;
    for (int b = 0; b < p->space->batches && isfinite(largest); b++) {
        if (!sn_fe_points_at(p->space, p->materials, b, x, 0, &p->work->points, &fault))
            largest = (double)INFINITY;
        for (int k = 0; k < 6 * SN_FE_POINTS && isfinite(largest); k++)
            largest = fmax(largest, fabs(p->work->points.E[k]));
    }
    return sn_fe_largest(p->space->ranks, largest);
}

// The factor s of the head of linear.h; 1 where nothing is strained.
static double small_factor(sn_fe_march *m) {
    double s = 1.0, strain = 0.0;
    for (int pass = 0; pass < 100; pass++) { // Green strain is linear once it is small
        scale_state(m, s, m->guess);
        strain = largest_strain(m->problem, m->guess);
        if (strain <= 2.0 * PROBED_STRAIN) break;
        s *= isfinite(strain) ? fmin(0.5, PROBED_STRAIN / strain) : 0.01;
    }
    return strain > 0.0 ? s * PROBED_STRAIN / strain : 1.0;
}

// Forces of the cells at s x, times `by`, into `out`.
static void add_forces(sn_fe_march *m, double s, double by, double *out) {
    sn_fe_problem *p = m->problem;
    sn_fe_fault fault;
    scale_state(m, s, m->guess);
    memset(p->residual, 0, (size_t)p->space->dofs * sizeof *p->residual);
    for (int b = 0; b < p->space->batches; b++) {
        bool good =
            sn_fe_points_at(p->space, p->materials, b, m->guess, 0, &p->work->points, &fault);
        SN_ASSERT(good);
        (void)good;
        sn_fe_cell_forces(p->space, b, p->work, p->residual);
    }
    sn_fe_gather_nodes(p->space, p->residual);
    for (int d = 0; d < 3 * p->space->nodes; d++) out[d] += by * p->residual[d];
}

// The linear forces of the cells into p->lifted.
static void inner_forces(sn_fe_march *m, double s) {
    sn_fe_problem *p = m->problem;
    memset(p->lifted, 0, (size_t)p->space->dofs * sizeof *p->lifted);
    add_forces(m, s, 0.5 / s, p->lifted);
    add_forces(m, -s, -0.5 / s, p->lifted);
}

// The forces of supports, as a row of the history reads them; adds to the external work.
static void react(sn_fe_march *m, double s) {
    sn_fe_problem *p = m->problem;
    double work = 0.0, *inner = p->lifted;
    inner_forces(m, s);
    memset(p->residual, 0, (size_t)p->space->dofs * sizeof *p->residual);
    for (int d = 0; d < 3 * p->space->nodes; d++) {
        bool held = p->pattern->row[d] == SN_FE_PRESCRIBED;
        double force = held ? inner[d] : p->external[d];
        if (held) p->residual[d] = inner[d] - p->external[d];
        work += 0.5 * (force + m->force[d]) * (m->x[d] - m->past[0][d]);
        m->force[d] = force;
    }
    m->summary->external_work_J += work;
}

// u . f(u) / 2, f linear: small differences of energies would be rounding.
double sn_fe_linear_energy(sn_fe_march *m) {
    double s = small_factor(m), sum = 0.0;
    inner_forces(m, s);
    for (int d = 0; d < 3 * m->problem->space->nodes; d++)
        sum += 0.5 * m->x[d] * m->problem->lifted[d];
    return sum;
}

// out = (plus - minus)/(2 s) into `plus`; `even`: (plus + minus)/(2 s^2).
static void combine(double *plus, const double *minus, size_t count, double s, bool even) {
    for (size_t k = 0; k < count; k++)
        plus[k] = even ? (plus[k] + minus[k]) / (2.0 * s * s) : (plus[k] - minus[k]) / (2.0 * s);
}

// 1 + the linear principal strains: turning the strain round turns their order round.
static void combine_stretches(double *plus, const double *minus, size_t cells, double s) {
    for (size_t n = 0; n < cells; n++) {
        double *l = plus + 3 * n;
        for (int k = 0; k < 3; k++) l[k] = 1.0 + (l[k] - minus[3 * n + 2 - (size_t)k]) / (2.0 * s);
    }
}

static sn_status emit(sn_fe_march *m, double s) {
    sn_fe_measure *f = m->measure;
    if (!f->fields) return SN_OK;
    size_t corners = (size_t)m->problem->space->corners, cells = (size_t)m->c->mesh->cell_count;
    enum { FIELDS = 6, ENERGY = 4, STRETCH = 5 };
    double *const field[FIELDS] = {f->pressure,  f->strain, f->stress,
                                   f->reference, f->energy, f->stretch};
    const size_t count[FIELDS] = {corners, 6 * cells, 6 * cells, 6 * cells, cells, 3 * cells};
    double *minus = sn_alloc(corners + 22 * cells, sizeof *minus), *to = minus;
    if (!minus) return SN_E_MEMORY;
    scale_state(m, -s, m->guess);
    sn_fe_measure_fill(f, m->problem, m->guess);
    for (int k = 0; k < FIELDS; to += count[k], k++) memcpy(to, field[k], count[k] * sizeof *to);
    scale_state(m, s, m->guess);
    sn_fe_measure_fill(f, m->problem, m->guess);
    to = minus;
    for (int k = 0; k < STRETCH; to += count[k], k++)
        combine(field[k], to, count[k], s, k == ENERGY);
    combine_stretches(f->stretch, to, cells, s);
    sn_free(minus);
    memcpy(f->displacement, m->x, 3 * corners * sizeof *f->displacement);
    return sn_fe_measure_emit(f, m->problem, m->output);
}

//---- solutions ----------------------------------------------------------------------------------

// Puts the solution at the level that the problem has begun into m->x.
static sn_status solve(sn_fe_march *m) {
    sn_fe_problem *p = m->problem;
    sn_fe_newton *n = &m->newton;
    const int *row = p->pattern->row;
    int dofs = p->space->dofs;
    bool good = true;
    memset(m->guess, 0, (size_t)dofs * sizeof *m->guess);
    memset(m->x, 0, (size_t)dofs * sizeof *m->x);
    memset(p->external, 0, (size_t)dofs * sizeof *p->external);
    for (int d = 0; d < 3 * p->space->nodes; d++)
        if (row[d] == SN_FE_PRESCRIBED) m->x[d] = p->prescribed[d];
    sn_fe_boundary_apply(p->boundary, p->c, p->space, p->level.time, 1.0, m->guess, p->external,
                         NULL);
    if (!p->solver) return SN_OK; // everything is prescribed
    sn_fe_problem_stiffness(p, m->guess, m->x);
    for (int d = 0; d < dofs; d++)
        if (row[d] >= 0) n->right[row[d]] = p->external[d] - p->lifted[d];
    // factors of large systems are rough: the solver iterates with them, and keeps them
    SN_TRY(sn_fe_solver_reduce(p->solver, SN_FE_EXACT, n->right, n->solution, &good));
    for (int k = 0; k < p->pattern->total && good; k++) good = isfinite(n->solution[k]);
    if (!good)
        return sn_fail(SN_E_SOLVER,
                       "the stiffness at rest is singular: a part of the body hangs on "
                       "nothing, or a tissue has no stiffness in some direction");
    for (int d = 0; d < dofs; d++)
        if (row[d] >= 0) m->x[d] = n->solution[row[d]];
    sn_fe_rigid_project(p->space, row, m->guess, m->x);
    m->summary->newton_iterations++;
    return SN_OK;
}

sn_status sn_fe_linear_go(sn_fe_march *m) {
    const sn_fe_schedule *s = &m->schedule;
    for (int k = 0; k < s->count; k++) {
        double *swap = m->past[0], clock = sn_clock();
        double length = k > 0 ? s->stop[k].time - s->stop[k - 1].time : 0.0;
        m->past[0] = m->x;
        m->x = swap;
        sn_fe_problem_begin(m->problem, (sn_fe_level){s->stop[k].time, 1.0, 0.0});
        SN_TRY(solve(m));
        double small = small_factor(m);
        react(m, small);
        if (k > 0) SN_TRY(sn_fe_march_note(m, sn_clock() - clock, length));
        m->summary->simulated_s = s->stop[k].time;
        if (!s->stop[k].output) continue;
        SN_TRY(sn_fe_measure_row(m->measure, m->problem, m->x, m->history));
        SN_TRY(emit(m, small));
    }
    return SN_OK;
}
