// sinew bench: how fast the engine runs here.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

// Every model at 11^3, 21^3 and 41^3 nodes, what the published figures of other engines use, with 0
// and 3 exponentials, on 1 and 2 threads; then some in double precision.
typedef struct bench_model {
    sn_rung rung;
    bool volume;
    const char *law;
} bench_model;
static const bench_model models[] = {{SN_RUNG_CENTRAL, false, "exponential"},
                                     {SN_RUNG_CENTRAL, true, "exponential"},
                                     {SN_RUNG_COUPLED, true, "neo-hookean"},
                                     {SN_RUNG_COUPLED, true, "demiray"},
                                     {SN_RUNG_SMOOTHED, true, "neo-hookean"}};
static const int sizes[] = {10, 20, 40}, terms[] = {0, 3};
enum { MODELS = 5, SIZES = 3, TERMS = 2, THREADS = 2, SINGLE = MODELS * SIZES * TERMS * THREADS };
enum { PLANS = SINGLE + MODELS }; // the models once more, in double precision

static sn_springs_bench_plan plan_of(int k) {
    const bool whole = k < SINGLE;
    const bench_model *m = &models[whole ? k / (SIZES * TERMS * THREADS) : k - SINGLE];
    return (sn_springs_bench_plan){.rung = m->rung,
                                   .volume = m->volume,
                                   .law = m->law,
                                   .memory_terms = whole ? terms[k / THREADS % TERMS] : 3,
                                   .cells = whole ? sizes[k / (TERMS * THREADS) % SIZES] : 20,
                                   .threads = whole ? 1 + k % THREADS : 1,
                                   .precision = whole ? SN_SINGLE : SN_DOUBLE};
}

// a row, and beside what it is to be read
typedef struct bench_ratios {
    double memory;  ///< time of a step over that without memory; NAN where there is no such row
    double threads; ///< speed over that on one thread
} bench_ratios;

static double step_seconds(const sn_springs_bench_row *r) {
    return r->step_s / r->real_time_factor;
}

// rows come by size, then number of exponentials, then threads
static bench_ratios ratios_of(const sn_springs_bench_row *row, int k) {
    bench_ratios out = {(double)NAN, (double)NAN};
    if (k >= SINGLE) return out;
    if (k / THREADS % TERMS > 0) out.memory = step_seconds(row) / step_seconds(row - THREADS);
    if (k % THREADS > 0) out.threads = step_seconds(row - 1) / step_seconds(row);
    return out;
}

static json_t *row_json(const sn_springs_bench_row *r, bench_ratios ratios) {
    json_t *json = json_object();
    cli_put_text(json, "model", r->model);
    cli_put_text(json, "law", r->law);
    cli_put_flag(json, "volume", r->volume);
    cli_put_integer(json, "memory_terms", r->memory_terms);
    cli_put_integer(json, "nodes", r->nodes);
    cli_put_integer(json, "springs", r->springs);
    cli_put_integer(json, "cells", r->cells);
    cli_put_integer(json, "threads", r->threads);
    cli_put_text(json, "precision", r->precision == SN_SINGLE ? "single" : "double");
    cli_put_number(json, "springs_per_second", r->springs_per_second);
    cli_put_number(json, "cells_per_second", r->cells_per_second);
    cli_put_number(json, "bound_per_second", r->bound_per_second);
    cli_put_number(json, "memory_bound_per_second", r->memory_bound_per_second);
    cli_put_number(json, "arithmetic_bound_per_second", r->arithmetic_bound_per_second);
    cli_put_number(json, "plain_per_second", r->plain_per_second);
    cli_put_number(json, "step_s", r->step_s);
    cli_put_number(json, "real_time_factor", r->real_time_factor);
    cli_put_number(json, "memory_cost", ratios.memory);
    cli_put_number(json, "thread_gain", ratios.threads);
    return json;
}

static void print_row(const sn_springs_bench_row *r, bench_ratios ratios) {
    double speed = r->springs_per_second > 0 ? r->springs_per_second : r->cells_per_second;
    char model[SN_NAME_MAX + 8];
    snprintf(model, sizeof model, "%s%s", r->model, r->volume ? "+volume" : "");
    printf("%-15s %-11s %6d %6d %3d %3d %-6s %7.1f M %-9s %7.1f M %4.0f %% %6.1f x %9.3f", model,
           r->law, r->nodes, r->springs > 0 ? r->springs : r->cells, r->memory_terms, r->threads,
           r->precision == SN_SINGLE ? "single" : "double", 1e-6 * speed,
           r->springs_per_second > 0 ? "springs/s" : "cells/s", 1e-6 * r->bound_per_second,
           100 * speed / r->bound_per_second, speed / r->plain_per_second, r->real_time_factor);
    if (!isnan(ratios.memory)) printf("  memory %.2f x", ratios.memory);
    if (!isnan(ratios.threads)) printf("  threads %.2f x", ratios.threads);
    printf("\n");
    fflush(stdout);
}

static int bench_springs(const cli_arguments *arguments) {
    bool table = !arguments->json && !arguments->quiet;
    char machine[256];
    cli_machine(machine, sizeof machine);
    if (table)
        printf("%s, kernels %s\n%-15s %-11s %6s %6s %3s %3s %-6s %19s %9s %6s %8s %9s\n", machine,
               sn_isa_name(), "model", "law", "nodes", "items", "exp", "thr", "real", "speed",
               "bound", "of it", "of plain", "real time");
    json_t *results = json_array();
    static sn_springs_bench_row rows[PLANS];
    for (int k = 0; k < PLANS; k++) {
        sn_springs_bench_row *row = &rows[k];
        const sn_springs_bench_plan plan = plan_of(k);
        sn_status status = sn_springs_bench(&plan, row);
        if (status != SN_OK) {
            json_decref(results);
            return cli_fail(status);
        }
        json_array_append_new(results, row_json(row, ratios_of(row, k)));
        if (table) print_row(row, ratios_of(row, k));
    }
    json_t *json = json_object();
    cli_put_text(json, "kernels", sn_isa_name());
    return cli_bench_end(arguments, json, results);
}

static int run(const cli_command *command, int argc, char **argv) {
    static const char *const subjects[] = {"springs", "fit", "continuum"};
    cli_bench_choice choice = {.most_nodes = 13000, .repeat = 1, .ranks = 1, .solver = "direct"};
    bool haptic = false;
    double seconds = 5;
    const cli_option options[] = {
        {"haptic", CLI_FLAG, NULL, NULL, &haptic,
         "springs: frames of 1 ms of a poked block, and the largest block that holds them"},
        {"time", CLI_QUANTITY, "T", "s", &seconds,
         "haptic: how long each size must hold its frames, of simulated time; 5 s"},
        {"element", CLI_TEXT, "P1|P2|P2P1", NULL, &choice.element,
         "continuum: only this element; P2 only by name"},
        {"solver", CLI_TEXT, "NAME", NULL, &choice.solver, "continuum: direct or iterative"},
        {"nodes", CLI_INTEGER, "N", NULL, &choice.most_nodes,
         "continuum: bodies of at most N nodes; 50653 is the largest"},
        {"ranks", CLI_INTEGER, "N", NULL, &choice.ranks,
         "continuum: each body on one process and, by mpirun, on N"},
        {"repeat", CLI_INTEGER, "N", NULL, &choice.repeat, "continuum: the best of N runs"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 7, &arguments);
    if (code >= 0) return code;
    if (arguments.count > 1)
        return cli_refuse("bench: expected one subject: springs, fit or continuum");
    const char *subject = arguments.count ? arguments.item[0] : subjects[0];
    if (haptic && strcmp(subject, "springs") != 0)
        return cli_refuse("bench: --haptic belongs to springs");
    if (choice.ranks > 1 && cli_ranks() > 1)
        return cli_refuse("bench: --ranks starts mpirun itself: leave one of the two out");
    if (!strcmp(subject, "continuum")) return cli_bench_continuum(&arguments, &choice);
    if (cli_ranks() > 1)
        return cli_refuse("bench: %s runs in one process; mpirun is for: bench continuum", subject);
    if (choice.element || choice.most_nodes != 13000 || choice.repeat != 1 || choice.ranks != 1 ||
        strcmp(choice.solver, "direct") != 0)
        return cli_refuse("bench: --element, --nodes, --ranks, --repeat and --solver belong to: "
                          "bench continuum");
    if (haptic) return cli_bench_haptic(&arguments, seconds);
    if (!strcmp(subject, "springs")) return bench_springs(&arguments);
    if (!strcmp(subject, "fit")) return cli_bench_fit(&arguments);
    return cli_unknown("benchmark", subject, subjects, 3);
}

const cli_command cli_bench = {"bench", "[springs|fit|continuum] [--haptic]",
                               "how fast it runs here, against what the processor allows",
                               "sinew bench springs", run};
