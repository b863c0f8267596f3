// The public function: checks what can be run, runs it, fills the summary.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/continuum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "continuum/march.h"

static sn_status check(const sn_case *c) {
    if (c->continuum.analysis != SN_ANALYSIS_QUASI_STATIC)
        return sn_fail(SN_E_UNSUPPORTED, "continuum: analysis: dynamic is not supported, only "
                                         "quasi-static; motion with inertia runs on the engine "
                                         "springs");
    if (!(c->continuum.tolerance > 0.0) || !(c->continuum.memory_tolerance > 0.0))
        return sn_fail(
            SN_E_RANGE,
            "continuum: tolerance and memory_tolerance must be positive, found %g and %g",
            c->continuum.tolerance, c->continuum.memory_tolerance);
    SN_TRY(sn_case_check(c));
    int carrier = sn_case_carried_by(c);
    if (carrier >= 0)
        return sn_fail(SN_E_DEFINITION,
                       "continuum: no supports: the body would only be carried along by the rigid "
                       "motion of \"%s\"; hold another surface under \"supports\"",
                       c->mesh->surface[carrier].name);
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
    s->unknowns = p->pattern->rows;
    s->threads = 1;
    for (int r = 0; r < p->materials->count; r++) {
        const sn_fe_material *m = p->materials->material + r;
        if (!m->remembers) continue;
        s->memory_terms = m->series.terms > s->memory_terms ? m->series.terms : s->memory_terms;
        s->memory_error = fmax(s->memory_error, m->series.max_error);
        s->memory_band_s[0] = m->series.t_min;
        s->memory_band_s[1] = m->series.t_max;
    }
}

// Energies: quasi-static, so that what came in and is not stored has been dissipated. With memory,
// what is stored is known only where the body is back in its rest shape and relaxed: the elastic
// law gives the energy of the same strain reached at once.
static void balance_energy(const sn_fe_march *m, sn_run_summary *s) {
    // a step that failed has changed the factors of the memory: an instantaneous one undoes that
    if (m->stopped)
        sn_fe_problem_begin(m->problem, (sn_fe_level){m->problem->level.time, 1.0, 0.0});
    s->elastic_J = sn_fe_measure_energy(m->problem, m->x);
    double lost = s->external_work_J - s->elastic_J;
    double largest = fmax(fabs(s->external_work_J), fabs(s->elastic_J));
    if (m->problem->materials->remembers)
        s->dissipated_J = lost;
    else // the trapezoidal rule of the work is all that is left
        s->energy_residual = largest > 0.0 ? fabs(lost) / largest : 0.0;
}

static void sum_up(sn_fe_march *m, double start, sn_run_summary *s) {
    describe_body(m->problem, s);
    balance_energy(m, s);
    s->wall_s = sn_clock() - start;
    s->real_time_factor = s->simulated_s / s->wall_s;
    s->converged = !m->stopped;
    size_t steps = (size_t)s->steps;
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
    if (m->problem->materials->remembers && !s->note[0])
        snprintf(s->note, sizeof s->note,
                 "elastic_J is the energy of the last strain if it were reached at once; a relaxed "
                 "body stores less, so dissipated_J (work minus elastic_J) may be negative");
    s->instant_J = s->elastic_J;
}

sn_status sn_continuum_run(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                           sn_record *history) {
    double start = sn_clock();
    sn_fe_march march;
    *summary = (sn_run_summary){0};
    SN_TRY(check(c));
    sn_status status = sn_fe_march_init(&march, c, output, summary, history);
    if (status == SN_OK) status = sn_fe_march_go(&march);
    if (status == SN_OK) sum_up(&march, start, summary);
    sn_fe_march_free(&march);
    return status;
}
