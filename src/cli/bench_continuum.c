// sinew bench continuum: how fast the finite elements are here.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

typedef struct bench_body {
    sn_element element;
    int cells; // an edge
} bench_body;

// 3,375, 12,167 and 50,653 nodes, midsides included
static const bench_body bodies[] = {
    {SN_ELEMENT_P1, 14},  {SN_ELEMENT_P1, 22},   {SN_ELEMENT_P1, 36},
    {SN_ELEMENT_P2, 7},   {SN_ELEMENT_P2, 11},   {SN_ELEMENT_P2, 18},
    {SN_ELEMENT_P2P1, 7}, {SN_ELEMENT_P2P1, 11}, {SN_ELEMENT_P2P1, 18},
};
enum { BODIES = sizeof bodies / sizeof bodies[0] };

static const char *const elements[] = {"P1", "P2", "P2P1"}; // in the order of the enum
static const char *const solvers[] = {"direct", "iterative"};

static const char *element_name(sn_element element) {
    return elements[element];
}

static json_t *row_json(const sn_continuum_bench_row *r, bool iterative) {
    json_t *json = json_object();
    cli_put_text(json, "element", element_name(r->element));
    cli_put_integer(json, "nodes", r->nodes);
    cli_put_integer(json, "cells", r->cells);
    cli_put_integer(json, "unknowns", r->unknowns);
    cli_put_integer(json, "ranks", r->ranks);
    cli_put_integer(json, "steps", r->steps);
    cli_put_integer(json, "newton_iterations", r->newton_iterations);
    cli_put_integer(json, "factorisations", r->factorisations);
    cli_put_integer(json, "applications", r->applications);
    cli_put_integer(json, "systems", r->systems);
    if (iterative) cli_put_integer(json, "rescues", r->rescues);
    if (iterative) cli_put_integer(json, "cycles", r->cycles);
    cli_put_number(json, "residual_ns", r->residual_ns);
    cli_put_number(json, "tangent_ns", r->tangent_ns);
    cli_put_number(json, "solve_s", r->solve_s);
    cli_put_number(json, "total_s", r->total_s);
    cli_put_number(json, "wall_s", r->wall_s);
    cli_put_number(json, "peak_memory_bytes", r->peak_memory_bytes);
    return json;
}

static void print_head(const char *machine, bool iterative) {
    printf("%s, one thread a rank, seconds of the processor and on the wall, cells in ns\n",
           machine);
    printf("%-7s %5s %6s %8s %8s %6s %8s %8s %8s %7s %8s %8s %8s %8s%s\n", "element", "ranks",
           "nodes", "cells", "unknowns", "Newton", iterative ? "built" : "factors", "applied",
           "residual", "tangent", "solve", "total", "wall", "memory", iterative ? "  to 1e-8" : "");
}

static void print_row(const sn_continuum_bench_row *r) {
    printf("%-7s %5d %6d %8d %8d %6d %8d %8d %8.0f %7.0f %6.2f s %6.2f s %6.2f s %5.0f MB",
           element_name(r->element), r->ranks, r->nodes, r->cells, r->unknowns,
           r->newton_iterations, r->factorisations, r->applications, r->residual_ns, r->tangent_ns,
           r->solve_s, r->total_s, r->wall_s, 1e-6 * r->peak_memory_bytes);
    if (r->cycles) printf(" %4d cycles", r->cycles);
    printf("\n");
    fflush(stdout);
}

// The best of several: a machine that does other work as well only ever makes it slower.
static sn_status best_of(int repeats, const bench_body *body, sn_solver solver,
                         sn_continuum_bench_row *best) {
    *best = (sn_continuum_bench_row){0};
    for (int k = 0; k < repeats; k++) {
        sn_continuum_bench_row row = {0};
        SN_TRY(sn_continuum_bench(body->element, body->cells, solver, &row));
        double residual = k ? fmin(row.residual_ns, best->residual_ns) : row.residual_ns;
        double tangent = k ? fmin(row.tangent_ns, best->tangent_ns) : row.tangent_ns;
        if (!k || row.total_s < best->total_s) *best = row;
        best->residual_ns = residual;
        best->tangent_ns = tangent;
    }
    return SN_OK;
}

static bool wanted(const cli_bench_choice *choice, const bench_body *body) {
    int an_edge = body->element == SN_ELEMENT_P1 ? body->cells + 1 : 2 * body->cells + 1;
    if (!choice->element && body->element == SN_ELEMENT_P2) return false;
    return (!choice->element || !strcmp(choice->element, element_name(body->element))) &&
           an_edge * an_edge * an_edge <= choice->most_nodes;
}

// Prints the row of the same body on several ranks, and how much faster it is.
static void print_shared(const json_t *json, const sn_continuum_bench_row *alone) {
    sn_continuum_bench_row row = *alone;
    int *const counts[] = {&row.ranks, &row.newton_iterations, &row.factorisations,
                           &row.applications, &row.cycles};
    double *const numbers[] = {&row.residual_ns, &row.tangent_ns,        &row.solve_s,
                               &row.total_s,     &row.peak_memory_bytes, &row.wall_s};
    static const char *const count_keys[] = {"ranks", "newton_iterations", "factorisations",
                                             "applications", "cycles"};
    static const char *const number_keys[] = {"residual_ns", "tangent_ns",        "solve_s",
                                              "total_s",     "peak_memory_bytes", "wall_s"};
    for (int k = 0; k < 5; k++)
        *counts[k] = (int)json_integer_value(json_object_get(json, count_keys[k]));
    for (int k = 0; k < 6; k++)
        *numbers[k] = json_number_value(json_object_get(json, number_keys[k]));
    print_row(&row);
    printf("        faster: %.2f times by seconds of the processor of one rank, %.2f on the wall\n",
           alone->total_s / row.total_s, alone->wall_s / row.wall_s);
}

// Runs what is wanted; `shared` (nullable) holds the same on several ranks.
static sn_status run_bodies(const cli_bench_choice *choice, sn_solver solver, bool table,
                            const json_t *shared, json_t *results) {
    const json_t *others = json_object_get(shared, "results");
    for (int k = 0, n = 0; k < BODIES; k++) {
        sn_continuum_bench_row row = {0};
        if (!wanted(choice, bodies + k)) continue;
        SN_TRY(best_of(choice->repeat, bodies + k, solver, &row));
        json_array_append_new(results, row_json(&row, solver == SN_SOLVER_ITERATIVE));
        if (table) print_row(&row);
        if (!others) continue;
        json_t *other = json_array_get(others, (size_t)n++);
        if (table) print_shared(other, &row);
        json_array_append(results, other);
    }
    return SN_OK;
}

int cli_bench_continuum(const cli_arguments *arguments, const cli_bench_choice *choice) {
    bool table = !arguments->json && !arguments->quiet;
    char machine[256];
    int element = 0, solver = 0;
    while (choice->element && element < 3 && strcmp(choice->element, elements[element])) element++;
    if (element == 3) return cli_unknown("element", choice->element, elements, 3);
    while (solver < 2 && strcmp(choice->solver, solvers[solver])) solver++;
    if (solver == 2) return cli_unknown("solver", choice->solver, solvers, 2);
    json_t *shared = choice->ranks > 1 ? cli_bench_on_ranks(choice) : NULL;
    if (choice->ranks > 1 && !shared) return CLI_FAILED;
    cli_machine(machine, sizeof machine);
    if (table) print_head(machine, solver == SN_SOLVER_ITERATIVE);
    json_t *results = json_array();
    sn_status status = run_bodies(choice, (sn_solver)solver, table, shared, results);
    json_decref(shared);
    if (status != SN_OK) {
        json_decref(results);
        return cli_fail(status);
    }
    return cli_bench_end(arguments, json_object(), results);
}
