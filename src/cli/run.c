// sinew run: a case through one engine.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

// the last row of the history
static json_t *probes_json(const sn_record *history) {
    json_t *probes = json_object();
    for (int k = 1; history->rows > 0 && k < history->series_count; k++)
        cli_put_number(probes, history->series[k].name,
                       history->series[k].value[history->rows - 1]);
    return probes;
}

static void put_cost(json_t *json, const sn_run_summary *s) {
    cli_put_number(json, "step_s", s->step_s);
    cli_put_integer(json, "steps", s->steps);
    cli_put_number(json, "simulated_s", s->simulated_s);
    cli_put_number(json, "wall_s", s->wall_s);
    cli_put_number(json, "real_time_factor", s->real_time_factor);
    cli_put_number(json, "step_wall_p50_s", s->step_wall_p50_s);
    cli_put_number(json, "step_wall_p99_s", s->step_wall_p99_s);
    cli_put_number(json, "step_wall_max_s", s->step_wall_max_s);
    cli_put_integer(json, "threads", s->threads);
    cli_put_integer(json, "newton_iterations", s->newton_iterations);
    cli_put_integer(json, "cutbacks", s->cutbacks);
}

static json_t *summary_json(const sn_run_summary *s, const sn_record *history) {
    json_t *json = json_object();
    cli_put_text(json, "engine", s->engine);
    cli_put_text(json, "model", s->model);
    cli_put_integer(json, "nodes", s->nodes);
    cli_put_integer(json, "cells", s->cells);
    cli_put_integer(json, "springs", s->springs);
    cli_put_integer(json, "unknowns", s->unknowns);
    put_cost(json, s);
    cli_put_number(json, "kinetic_J", s->kinetic_J);
    cli_put_number(json, "elastic_J", s->elastic_J);
    cli_put_number(json, "memory_J", s->memory_J);
    cli_put_number(json, "dissipated_J", s->dissipated_J);
    cli_put_number(json, "external_work_J", s->external_work_J);
    cli_put_number(json, "energy_residual", s->energy_residual);
    cli_put_integer(json, "memory_terms", s->memory_terms);
    cli_put_number(json, "memory_error", s->memory_error);
    cli_put(json, "memory_band_s", cli_numbers(2, s->memory_band_s));
    cli_put_flag(json, "converged", s->converged);
    cli_put_text(json, "reason", s->reason);
    cli_put_text(json, "note", s->note);
    cli_put(json, "probes", probes_json(history));
    return json;
}

//---- frames: to ParaView, and the last one to the report -----------------------------------------

typedef struct run_context {
    cli_progress progress;
    sn_vtu *vtu;
    int nodes;
    double *displacement; ///< of the last frame                    (nodes x 3)
    sn_record *energy;    ///< rows of energy.csv; none where the engine gives none
} run_context;

static sn_status take_frame(void *context, const sn_frame *frame) {
    run_context *r = context;
    for (int k = 0; k < frame->field_count; k++)
        if (strcmp(frame->fields[k].name, "displacement") == 0)
            memcpy(r->displacement, frame->fields[k].value,
                   (size_t)r->nodes * 3 * sizeof *r->displacement);
    return r->vtu ? sn_vtu_frame(r->vtu, frame) : SN_OK;
}

static void pass_progress(void *context, double done, const char *text) {
    cli_progress_show(&((run_context *)context)->progress, done, text);
}

//---- report --------------------------------------------------------------------------------------

// one plot for all columns of a probe: NAME_ux NAME_uy NAME_uz
static void history_plots(sn_report *report, const sn_record *history) {
    static const char *const axes[] = {"x", "y", "z"};
    for (int k = 1; k + 2 < history->series_count; k += 3) {
        char title[SN_NAME_MAX + 16], label[32];
        const sn_series *s = &history->series[k];
        snprintf(title, sizeof title, "%.*s", (int)strlen(s->name) - 3, s->name);
        bool force = strcmp(s->unit, "N") == 0;
        snprintf(label, sizeof label, "%s", force ? "force [N]" : "displacement [mm]");
        sn_line line[3];
        for (int d = 0; d < 3; d++)
            line[d] =
                (sn_line){axes[d],       SN_LINE_POINTS,           d,
                          history->rows, history->series[0].value, history->series[k + d].value};
        sn_report_plot(report, &(sn_plot){.title = title,
                                          .x_label = "time [s]",
                                          .y_label = label,
                                          .y_scale = force ? 1 : 1e3,
                                          .line_count = 3,
                                          .line = line});
    }
}

static void summary_table(sn_report *report, const sn_run_summary *s) {
    char nodes[64], steps[96], factor[96], memory[128];
    snprintf(nodes, sizeof nodes, "%d nodes, %d cells, %d springs", s->nodes, s->cells, s->springs);
    snprintf(steps, sizeof steps, "%ld, smallest %s", s->steps, cli_show(s->step_s, "s"));
    snprintf(factor, sizeof factor, "%.3g (%s in %s)", s->real_time_factor,
             cli_show(s->simulated_s, "s"), cli_show(s->wall_s, "s"));
    snprintf(memory, sizeof memory, "%d exponentials, error at most %.2g over %s … %s",
             s->memory_terms, s->memory_error, cli_show(s->memory_band_s[0], "s"),
             cli_show(s->memory_band_s[1], "s"));
    const char *cells[] = {"quantity",
                           "value",
                           "engine",
                           s->engine,
                           "model",
                           s->model,
                           "size",
                           nodes,
                           "steps",
                           steps,
                           "real-time factor",
                           factor,
                           "memory",
                           memory,
                           "elastic energy",
                           cli_show(s->elastic_J, "J"),
                           "external work",
                           cli_show(s->external_work_J, "J")};
    sn_report_table(report, (int)(sizeof cells / sizeof cells[0]) / 2, 2, cells, "Summary");
}

static sn_status write_report(const char *path, const sn_case *c, const sn_run_summary *s,
                              const sn_record *history, const run_context *r) {
    sn_report *report;
    char title[SN_TEXT_MAX + 32];
    snprintf(title, sizeof title, "%s (%s)", c->name, s->engine);
    SN_TRY(sn_report_create(title, &report));
    summary_table(report, s);
    if (*s->reason) sn_report_text(report, "The run ended early: %s", s->reason);
    if (*s->note) sn_report_text(report, "Note: %s", s->note);
    double *magnitude = sn_alloc((size_t)r->nodes, sizeof *magnitude);
    sn_status status = magnitude ? SN_OK : SN_E_MEMORY;
    if (magnitude) {
        for (int i = 0; i < r->nodes; i++)
            magnitude[i] = hypot(hypot(r->displacement[3 * i], r->displacement[3 * i + 1]),
                                 r->displacement[3 * i + 2]);
        sn_body body = {c->name, "displacement [mm]", c->mesh, r->displacement, magnitude, 0, 1e3};
        sn_report_bodies(report, 1, &body, "The body at the last output time. Drag to turn it.");
        history_plots(report, history);
        status = sn_report_write(report, path);
    }
    sn_free(magnitude);
    sn_report_destroy(report);
    return status;
}

//---- the command ---------------------------------------------------------------------------------

static sn_status write_results(const char *folder, const sn_case *c, const sn_run_summary *s,
                               const sn_record *history, const run_context *r) {
    char path[4096];
    SN_TRY(sn_curve_write(cli_path(path, sizeof path, folder, "history.csv"), history, true));
    if (r->energy->rows > 0)
        SN_TRY(sn_curve_write(cli_path(path, sizeof path, folder, "energy.csv"), r->energy, true));
    json_t *json = summary_json(s, history);
    sn_status status = cli_write_json(folder, "summary.json", json);
    json_decref(json);
    if (status != SN_OK) return status;
    return write_report(cli_path(path, sizeof path, folder, "report.html"), c, s, history, r);
}

static void print_summary(const sn_run_summary *s, const sn_record *history, const char *folder) {
    printf("%s, %s: %d nodes, %d cells, %d springs\n", s->engine, s->model, s->nodes, s->cells,
           s->springs);
    printf("  %s simulated in %s (real-time factor %.3g), %ld steps of at least %s\n",
           cli_show(s->simulated_s, "s"), cli_show(s->wall_s, "s"), s->real_time_factor, s->steps,
           cli_show(s->step_s, "s"));
    if (s->memory_terms)
        printf("  memory: %d exponentials, error at most %.2g of G(0) over %s to %s\n",
               s->memory_terms, s->memory_error, cli_show(s->memory_band_s[0], "s"),
               cli_show(s->memory_band_s[1], "s"));
    for (int k = 1; history->rows > 0 && k < history->series_count; k++)
        printf("  %-24s %s\n", history->series[k].name,
               cli_show(history->series[k].value[history->rows - 1], history->series[k].unit));
    if (*s->note) printf("  note: %s\n", s->note);
    if (folder)
        printf("  results in %s (report.html, summary.json, history.csv, fields.pvd%s)\n", folder,
               strcmp(s->engine, "springs") == 0 ? ", energy.csv" : "");
}

typedef sn_status engine_function(const sn_case *c, const sn_output *output,
                                  sn_run_summary *summary, sn_record *history);

static sn_status run_case(const char *path, engine_function *engine, const char *folder,
                          const cli_arguments *arguments, sn_run_summary *summary) {
    sn_case *c = NULL;
    sn_record *history = NULL;
    run_context r = {.progress = cli_progress_start(arguments)};
    sn_output output = {.context = &r, .frame = take_frame, .progress = pass_progress};
    sn_status status;
    SN_TRY_GOTO(status, sn_case_read(path, &c));
    SN_TRY_GOTO(status, sn_record_create(c->name, &history));
    SN_TRY_GOTO(status, sn_record_create(c->name, &r.energy));
    output.energy = folder ? r.energy : NULL;
    r.nodes = c->mesh->node_count;
    r.displacement = sn_alloc((size_t)r.nodes, 3 * sizeof *r.displacement);
    if (!r.displacement) {
        status = SN_E_MEMORY;
        goto fail;
    }
    if (folder) {
        SN_TRY_GOTO(status, sn_folder_make(folder));
        SN_TRY_GOTO(status, sn_vtu_create(folder, "fields", c->mesh, &r.vtu));
    }
    status = engine(c, &output, summary, history);
    cli_progress_end(&r.progress);
    if (status != SN_OK) {
        status = sn_fail_within(status, "%s", path);
        goto fail;
    }
    if (folder) SN_TRY_GOTO(status, write_results(folder, c, summary, history, &r));
    if (arguments->json)
        cli_print_json(summary_json(summary, history));
    else if (!arguments->quiet)
        print_summary(summary, history, folder);
fail:
    sn_vtu_destroy(r.vtu);
    sn_free(r.displacement);
    sn_record_destroy(r.energy);
    sn_record_destroy(history);
    sn_case_destroy(c);
    return status;
}

static int run(const cli_command *command, int argc, char **argv) {
    static const char *const engines[] = {"springs", "continuum"};
    static engine_function *const functions[] = {sn_springs_run, sn_continuum_run};
    const char *engine = NULL, *folder = NULL;
    const cli_option options[] = {
        {"engine", CLI_TEXT, "NAME", NULL, &engine, "springs or continuum"},
        {"out", CLI_TEXT, "DIR", NULL, &folder,
         "writes report.html, summary.json, history.csv and fields.pvd there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 2, &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("run: expected one case file, got %d", arguments.count);
    if (!engine) return cli_refuse("run: --engine is missing: springs or continuum");
    for (int k = 0; k < 2; k++) {
        if (strcmp(engine, engines[k]) != 0) continue;
        sn_run_summary summary = {0};
        sn_status status = run_case(arguments.item[0], functions[k], folder, &arguments, &summary);
        if (status != SN_OK) return cli_fail(status);
        if (summary.converged) return CLI_DONE;
        cli_refuse("%s: %s", arguments.item[0], summary.reason);
        return CLI_FAILED;
    }
    return cli_unknown("engine", engine, engines, 2);
}

const cli_command cli_run = {"run", "CASE.yaml --engine springs|continuum [--out DIR]",
                             "one case through the springs or the finite elements",
                             "sinew run examples/muscle/strip-1s.yaml --engine springs --out out",
                             run};
