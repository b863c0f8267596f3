// How fast the finite elements are here: a clamped cube pulled by 30 % in 10 steps.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "continuum/march.h"
#include "sinew/continuum.h"

enum { STEPS = 10, REPEATS = 5 };

static double processor_seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

//---- memory -------------------------------------------------------------------------------------

// Linux starts the peak anew on this word; elsewhere there is no such file, and no harm.
static void forget_peak(void) {
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file) return;
    fputs("5", file);
    fclose(file);
}

static double peak_memory(void) {
    char line[256];
    double kilobytes = 0.0;
    FILE *file = fopen("/proc/self/status", "r");
    if (!file) return 0.0;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "VmHWM: %lf", &kilobytes) == 1) break;
    fclose(file);
    return 1024.0 * kilobytes;
}

//---- the case -----------------------------------------------------------------------------------

static sn_status bench_case(sn_element element, int cells, sn_solver solver, sn_case **out) {
    static const char *const name[] = {"c1", "c2", "bulk_modulus"};
    static const double value[] = {1.0, 0.1, 100.0};
    SN_TRY(sn_case_create(out));
    sn_case *c = *out;
    c->shape = (sn_shape_def){.shape = SN_SHAPE_BLOCK,
                              .pattern = SN_PATTERN_KUHN,
                              .size = {1, 1, 1},
                              .cells = {cells, cells, cells}};
    c->has_shape = true;
    SN_TRY(sn_mesh_build(&c->shape, &c->mesh));
    c->tissue = sn_alloc(1, sizeof *c->tissue);
    c->support = sn_alloc(1, sizeof *c->support);
    c->load = sn_alloc(1, sizeof *c->load);
    if (!c->tissue || !c->support || !c->load) return SN_E_MEMORY;
    c->tissue[0] = sn_tissue_default();
    c->tissue[0].density = 1000.0;
    c->tissue[0].law = sn_law_find("mooney-rivlin");
    for (int k = 0; k < 3; k++) SN_TRY(sn_tissue_set(c->tissue, name[k], value[k]));
    c->support_count = c->load_count = 1;
    c->support[0] =
        (sn_support){.surface = sn_mesh_surface(c->mesh, "bottom"), .fix = {true, true, true}};
    c->load[0] = (sn_load){.kind = SN_LOAD_DISPLACEMENT,
                           .surface = sn_mesh_surface(c->mesh, "top"),
                           .vector = {0.0, 0.0, 0.3}};
    SN_TRY(sn_history_create(1, 2, (double[]){0, 1}, (double[]){0, 1}, &c->load[0].factor));
    c->until = c->output_every = 1.0;
    c->continuum.element = element;
    c->continuum.steps = STEPS;
    c->continuum.solver = solver;
    return sn_case_check(c);
}

//---- measurement --------------------------------------------------------------------------------

// The best of several evaluations at the last state.
static void time_assembly(sn_fe_march *m, sn_continuum_bench_row *row) {
    double residual = 1e30, tangent = 1e30;
    sn_fe_balance balance;
    for (int k = 0; k < REPEATS; k++) {
        double start = processor_seconds();
        sn_fe_problem_balance(m->problem, m->x, &balance);
        double middle = processor_seconds();
        sn_fe_problem_tangent(m->problem, m->x, NULL);
        tangent = fmin(tangent, processor_seconds() - middle);
        residual = fmin(residual, middle - start);
    }
    row->residual_ns = 1e9 * residual / row->cells;
    row->tangent_ns = 1e9 * tangent / row->cells;
}

static void describe(sn_fe_march *m, const sn_run_summary *summary, sn_continuum_bench_row *row) {
    sn_fe_solver_work work = sn_fe_solver_done(m->problem->solver);
    row->nodes = m->problem->space->nodes;
    row->cells = m->c->mesh->cell_count;
    row->unknowns = m->problem->pattern->unknowns;
    row->steps = (int)summary->steps;
    row->ranks = m->problem->space->ranks->count;
    row->newton_iterations = summary->newton_iterations;
    row->systems = work.systems;
    row->rescues = work.rescues;
    row->factorisations = work.factorisations;
    row->applications = work.applications;
    row->solve_s = work.seconds;
}

// Cycles of multigrid for the tangent at the last state under a dead pull, from a new hierarchy.
static sn_status count_cycles(sn_fe_march *m, sn_continuum_bench_row *row) {
    sn_fe_problem *p = m->problem;
    sn_fe_newton *n = &m->newton;
    bool good;
    int before = row->applications;
    memset(n->right, 0, (size_t)p->pattern->total * sizeof *n->right);
    sn_fe_problem_tangent(p, m->x, NULL);
    for (int a = 0; a < p->space->nodes; a++)
        if (p->pattern->row[3 * a + 2] >= 0) n->right[p->pattern->row[3 * a + 2]] = 1.0;
    sn_fe_solver_forget(p->solver);
    SN_TRY(sn_fe_solver_reduce(p->solver, 1e-8, n->right, n->solution, &good));
    row->cycles = sn_fe_solver_done(p->solver).applications - before;
    return SN_OK;
}

// Times of the slowest rank, memory of all.
static void join_ranks(const sn_fe_ranks *r, sn_continuum_bench_row *row) {
    double *const largest[] = {&row->residual_ns, &row->tangent_ns, &row->solve_s, &row->total_s,
                               &row->wall_s};
    for (size_t k = 0; k < sizeof largest / sizeof *largest; k++)
        *largest[k] = sn_fe_largest(r, *largest[k]);
    row->peak_memory_bytes = sn_fe_sum(r, row->peak_memory_bytes);
}

sn_status sn_continuum_bench(sn_element element, int cells, sn_solver solver,
                             sn_continuum_bench_row *row) {
    sn_status status = SN_OK;
    sn_case *c = NULL;
    sn_record *history = NULL;
    sn_run_summary summary = {0};
    sn_fe_march march = {0};
    *row = (sn_continuum_bench_row){.element = element};
    if (cells < 1 || cells > 200)
        return sn_fail(SN_E_RANGE, "bench: %d cells an edge; expected 1 to 200", cells);
    forget_peak();
    double start = processor_seconds(), clock = sn_clock();
    SN_TRY_GOTO(status, bench_case(element, cells, solver, &c));
    SN_TRY_GOTO(status, sn_record_create("bench", &history));
    SN_TRY_GOTO(status, sn_fe_march_init(&march, c, NULL, &summary, history));
    SN_TRY_GOTO(status, sn_fe_march_go(&march));
    row->total_s = processor_seconds() - start;
    row->wall_s = sn_clock() - clock;
    row->peak_memory_bytes = peak_memory();
    describe(&march, &summary, row);
    time_assembly(&march, row);
    join_ranks(march.problem->space->ranks, row);
    if (march.stopped)
        status = sn_fail(SN_E_SOLVER, "bench: it did not converge: %.150s", summary.reason);
    else if (solver == SN_SOLVER_ITERATIVE)
        status = count_cycles(&march, row);
fail:
    sn_fe_march_free(&march);
    sn_record_destroy(history);
    sn_case_destroy(c);
    return status;
}
