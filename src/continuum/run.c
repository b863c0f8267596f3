// The public function: checks what can be run, runs it, fills the summary.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/continuum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "continuum/linear.h"

static sn_status check(const sn_case *c) {
    for (int t = 0; t < c->tool_count; t++)
        if (c->tool[t].grasp[1] > c->tool[t].grasp[0])
            return sn_fail(SN_E_UNSUPPORTED,
                           "continuum: tool \"%s\": grasp is not supported; it runs on the engine "
                           "springs, integrator explicit",
                           c->tool[t].name);
    if (c->cut_count > 0)
        return sn_fail(SN_E_UNSUPPORTED,
                       "continuum: cuts are not supported; they run on the engine springs");
    if (!(c->continuum.tolerance > 0.0) || !(c->continuum.memory_tolerance > 0.0))
        return sn_fail(
            SN_E_RANGE,
            "continuum: tolerance and memory_tolerance must be positive, found %g and %g",
            c->continuum.tolerance, c->continuum.memory_tolerance);
    double rho = c->continuum.rho_infinity;
    if (!(rho >= 0.0 && rho <= 1.0))
        return sn_fail(SN_E_RANGE, "continuum: rho_infinity must be from 0 to 1, found %g", rho);
    double error = c->continuum.step_tolerance;
    if (!(error >= 0.0 && error < 1.0))
        return sn_fail(
            SN_E_RANGE,
            "continuum: step_tolerance must be from 0 (fixed steps) to below 1, found %g", error);
    if (error > 0.0 && c->continuum.analysis != SN_ANALYSIS_DYNAMIC)
        return sn_fail(
            SN_E_UNSUPPORTED,
            "continuum: step: auto and step_tolerance are for analysis: dynamic; the "
            "others take \"steps\" and shorten them after corners and where Newton fails");
    SN_TRY(sn_case_check(c));
    int carrier = sn_case_carried_by(c);
    if (carrier >= 0 && c->continuum.analysis != SN_ANALYSIS_DYNAMIC)
        return sn_fail(SN_E_DEFINITION,
                       "continuum: no supports: the body would only be carried along by the rigid "
                       "motion of \"%s\"; hold another surface under \"supports\"",
                       c->mesh->surface[carrier].name);
    return SN_OK;
}

// What small strain leaves out.
static sn_status check_linear(const sn_case *c) {
    const sn_memory none = sn_memory_none();
    if (c->continuum.analysis != SN_ANALYSIS_LINEAR) return SN_OK;
    if (c->tool_count > 0)
        return sn_fail(SN_E_UNSUPPORTED, "continuum: contact with tools is not linear; use "
                                         "analysis: quasi-static");
    for (int r = 0; r < c->mesh->region_count; r++)
        if (c->tissue[r].memory.law != none.law)
            return sn_fail(SN_E_UNSUPPORTED,
                           "region \"%s\": analysis: linear is elastic, and the tissue has a "
                           "memory; use analysis: quasi-static, or take the memory out",
                           c->mesh->region_name[r]);
    return SN_OK;
}

static int compare_double(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void describe_body(const sn_fe_problem *p, sn_run_summary *s) {
    snprintf(s->engine, sizeof s->engine, "continuum");
    snprintf(s->model, sizeof s->model, "%s", p->space->element.name);
    s->nodes = p->space->nodes;
    s->cells = p->c->mesh->cell_count;
    s->unknowns = p->pattern->unknowns;
    s->ranks = p->space->ranks->count;
    s->threads = 1;
    for (int r = 0; r < p->materials->count; r++) {
        const sn_fe_material *m = p->materials->material + r;
        for (int k = 0; k < SN_PARTS && m->remembers; k++) {
            const sn_exponentials *e = &m->part[k].series;
            s->memory_terms = e->terms > s->memory_terms ? e->terms : s->memory_terms;
            s->memory_error = fmax(s->memory_error, e->max_error);
            if (m->part[k].count == 0) continue;
            s->memory_band_s[0] = e->t_min;
            s->memory_band_s[1] = e->t_max;
        }
    }
}

// Energies: what came in and is neither stored nor moves has been dissipated. With memory, what is
// stored is known only where the body is back in its rest shape and relaxed: the elastic law gives
// the energy of the same strain reached at once.
static void balance_energy(sn_fe_march *m, sn_run_summary *s) {
    if (m->c->continuum.analysis == SN_ANALYSIS_LINEAR) {
        s->elastic_J = sn_fe_linear_energy(m);
        double size = fmax(fabs(s->external_work_J), s->elastic_J);
        if (size > 0.0) s->energy_residual = fabs(s->external_work_J - s->elastic_J) / size;
        return;
    }
    // a step that failed has changed the factors of the memory: an instantaneous one undoes that
    if (m->stopped)
        sn_fe_problem_begin(m->problem, (sn_fe_level){m->problem->level.time, 1.0, 0.0});
    s->elastic_J = sn_fe_measure_energy(m->problem, m->x);
    if (m->problem->inertia)
        s->kinetic_J = sn_fe_inertia_energy(m->problem->inertia, m->problem->space);
    double lost = s->external_work_J - s->elastic_J - s->kinetic_J;
    double largest = fmax(fmax(fabs(s->external_work_J), fabs(s->elastic_J)), s->kinetic_J);
    if (m->problem->materials->remembers)
        s->dissipated_J = lost;
    else // left: the trapezoidal rule of the work, friction, the damping of the steps
        s->energy_residual = largest > 0.0 ? fabs(lost) / largest : 0.0;
}

#define LONG_STEP 1e-3 // error of one step, of the largest displacement, that a note is worth

// How the steps of a dynamic run came about, or that they were long.
static void judge_steps(const sn_fe_march *m, sn_run_summary *s) {
    const sn_fe_inertia *i = m->problem->inertia;
    double tolerance = m->c->continuum.step_tolerance;
    if (!i || s->note[0] || s->steps == 0) return;
    if (tolerance > 0.0) {
        int used = snprintf(
            s->note, sizeof s->note,
            "steps of %.2g s to %.2g s, so that one errs by at most %.2g of the largest "
            "displacement (rms); %d were taken back for it, %d because Newton failed",
            s->step_s, m->longest_used, tolerance, m->inaccurate, s->cutbacks - m->inaccurate);
        if (m->blind > 0)
            snprintf(s->note + used, sizeof s->note - (size_t)used,
                     "; %d of %.2g s, faster than the mesh, erred by more", m->blind,
                     m->least_pace);
    } else if (i->error > LONG_STEP * i->way) {
        snprintf(
            s->note, sizeof s->note,
            "steps are long for this motion: one errs by up to %.2g of the largest "
            "displacement (rms); what is faster than some %.2g s is damped, shorten continuum: "
            "step to see it, or let step: auto choose",
            i->error / i->way, 10.0 * s->step_s);
    }
}

static void judge_solver(const sn_fe_solver *solver, sn_run_summary *s) {
    sn_fe_solver_work work = solver ? sn_fe_solver_done(solver) : (sn_fe_solver_work){0};
    if (work.rescues == 0 || s->note[0]) return;
    snprintf(s->note, sizeof s->note,
             "solver: iterative left %d of %d linear systems to the direct solver%s", work.rescues,
             work.systems, work.rescues < SN_FE_RESCUES ? "" : ", and all that followed");
}

static void sum_up(sn_fe_march *m, sn_run_summary *s) {
    describe_body(m->problem, s);
    balance_energy(m, s);
    s->wall_s = sn_clock() - m->started;
    s->real_time_factor = s->simulated_s / s->wall_s;
    s->converged = !m->stopped;
    size_t steps = m->walls; // of this session, where the run was resumed
    if (steps > 0) {
        qsort(m->wall, steps, sizeof *m->wall, compare_double);
        s->step_wall_p50_s = m->wall[(steps - 1) / 2];
        s->step_wall_p99_s = m->wall[(size_t)ceil(0.99 * (double)steps) - 1];
        s->step_wall_max_s = m->wall[steps - 1];
    }
    if (m->rounded > 0 && !s->note[0])
        snprintf(s->note, sizeof s->note,
                 "%d of %ld steps were accepted at rounding level, above the tolerance of %.3g",
                 m->rounded, s->steps, m->c->continuum.tolerance);
    judge_steps(m, s);
    judge_solver(m->problem->solver, s);
    if (m->problem->materials->remembers && !s->note[0])
        snprintf(s->note, sizeof s->note,
                 "elastic_J is the energy of the last strain if it were reached at once; a relaxed "
                 "body stores less, so dissipated_J (work minus elastic_J) may be negative");
    s->instant_J = s->elastic_J;
}

sn_status sn_continuum_run(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                           sn_record *history) {
    return sn_continuum_resume(c, output, NULL, summary, history);
}

sn_status sn_continuum_resume(const sn_case *c, const sn_output *output, const sn_restart *restart,
                              sn_run_summary *summary, sn_record *history) {
    sn_fe_march march;
    *summary = (sn_run_summary){0};
    SN_TRY(check(c));
    SN_TRY(check_linear(c));
    if (restart && restart->state && c->continuum.analysis == SN_ANALYSIS_LINEAR)
        return sn_fail(SN_E_UNSUPPORTED,
                       "resume: analysis: linear has no state to go on from; run it again");
    sn_status status = sn_fe_march_init(&march, c, output, summary, history);
    march.restart = restart;
    bool linear = c->continuum.analysis == SN_ANALYSIS_LINEAR;
    if (status == SN_OK) status = linear ? sn_fe_linear_go(&march) : sn_fe_march_go(&march);
    if (status == SN_OK) sum_up(&march, summary);
    status = sn_fe_settle(status);
    sn_fe_march_free(&march);
    return status;
}
