// sinew run: a case through one engine.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/run.h"

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
    cli_put_integer(json, "ranks", s->ranks);
    cli_put_integer(json, "newton_iterations", s->newton_iterations);
    cli_put_integer(json, "cutbacks", s->cutbacks);
}

static json_t *summary_json(const sn_run_summary *s, const sn_record *history,
                            const sn_refinement *refinement) {
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
    cli_put_number(json, "released_J", s->released_J);
    cli_put_integer(json, "cells_removed", s->cells_removed);
    cli_put_number(json, "external_work_J", s->external_work_J);
    cli_put_number(json, "energy_residual", s->energy_residual);
    cli_put_integer(json, "memory_terms", s->memory_terms);
    cli_put_number(json, "memory_error", s->memory_error);
    cli_put(json, "memory_band_s", cli_numbers(2, s->memory_band_s));
    cli_put_flag(json, "converged", s->converged);
    cli_put_text(json, "reason", s->reason);
    cli_put_text(json, "note", s->note);
    cli_put(json, "probes", probes_json(history));
    if (refinement->meshes) cli_put(json, "refinement", run_refinement_json(refinement));
    return json;
}

//---- frames: to ParaView, and the last one to the report -----------------------------------------

typedef struct run_context {
    cli_progress progress;
    sn_vtu *vtu;
    int nodes;
    const sn_record *history;
    int earlier; ///< frames of the run that is resumed; -1 until they are known
    sn_refinement refinement;
    double *displacement; ///< of the last frame                    (nodes x 3)
    int cells;
    bool *removed;     ///< of the last frame, by cuts               (cells)
    sn_record *energy; ///< rows of energy.csv; none where the engine gives none
} run_context;

static sn_status take_frame(void *context, const sn_frame *frame) {
    run_context *r = context;
    if (r->vtu && r->earlier < 0) { // a frame stands beside every row of the history
        r->earlier = r->history->rows - 1;
        SN_TRY(sn_vtu_continue(r->vtu, r->earlier, r->history->series[0].value));
    }
    for (int k = 0; k < frame->field_count; k++)
        if (strcmp(frame->fields[k].name, "displacement") == 0)
            memcpy(r->displacement, frame->fields[k].value,
                   (size_t)r->nodes * 3 * sizeof *r->displacement);
    for (int k = 0; k < frame->field_count; k++)
        for (int e = 0; strcmp(frame->fields[k].name, "removed") == 0 && e < r->cells; e++)
            r->removed[e] = frame->fields[k].value[e] != 0;
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

// the body without the cells that cuts removed
static sn_status add_body(sn_report *report, const sn_case *c, const run_context *r) {
    const size_t nodes = (size_t)r->nodes;
    sn_mesh *rest = NULL;
    int left = 0;
    for (int e = 0; e < r->cells; e++) left += !r->removed[e];
    if (left == 0) return SN_OK;
    int *name = sn_alloc(nodes, sizeof *name);
    double *way = sn_alloc(nodes * 3, sizeof *way), *length = sn_alloc(nodes, sizeof *length);
    sn_status status = name && way && length ? SN_OK : SN_E_MEMORY;
    if (status == SN_OK) status = sn_mesh_without(c->mesh, r->removed, &rest, name);
    if (status == SN_OK) {
        for (int i = 0; i < rest->node_count; i++) {
            memcpy(way + 3 * i, r->displacement + 3 * name[i], 3 * sizeof *way);
            length[i] = hypot(hypot(way[3 * i], way[3 * i + 1]), way[3 * i + 2]);
        }
        sn_body body = {c->name, "displacement [mm]", rest, way, length, 0, 1e3};
        sn_report_bodies(report, 1, &body, "The body at the last output time. Drag to turn it.");
    }
    sn_mesh_destroy(rest);
    sn_free(name);
    sn_free(way);
    sn_free(length);
    return status;
}

static sn_status write_report(const char *path, const sn_case *c, const sn_run_summary *s,
                              const sn_record *history, const run_context *r) {
    sn_report *report;
    char title[SN_TEXT_MAX + 32];
    snprintf(title, sizeof title, "%s (%s)", c->name, s->engine);
    SN_TRY(sn_report_create(title, &report));
    summary_table(report, s);
    run_refinement_report(&r->refinement, report);
    if (*s->reason) sn_report_text(report, "The run ended early: %s", s->reason);
    if (*s->note) sn_report_text(report, "Note: %s", s->note);
    sn_status status = add_body(report, c, r);
    if (status == SN_OK) {
        history_plots(report, history);
        status = sn_report_write(report, path);
    }
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
    json_t *json = summary_json(s, history, &r->refinement);
    sn_status status = cli_write_json(folder, "summary.json", json);
    json_decref(json);
    if (status != SN_OK) return status;
    return write_report(cli_path(path, sizeof path, folder, "report.html"), c, s, history, r);
}

static void print_summary(const sn_run_summary *s, const sn_record *history,
                          const sn_refinement *refinement, const char *folder) {
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
    if (s->cells_removed)
        printf("  cut: %d cells removed, %s released\n", s->cells_removed,
               cli_show(s->released_J, "J"));
    run_refinement_print(refinement);
    if (*s->note) printf("  note: %s\n", s->note);
    if (folder)
        printf("  results in %s (report.html, summary.json, history.csv, fields.pvd%s)\n", folder,
               strcmp(s->engine, "springs") == 0 ? ", energy.csv" : "");
}

typedef struct run_options {
    const char *engine, *folder, *resume, *by;
    int refine;
} run_options;

static bool run_by_order(const char *by) {
    return by && strcmp(by, "order") == 0;
}

// Engines save their state beside the results, and go on from there with --resume.
static sn_status run_engine(const sn_case *c, const sn_output *output, const run_options *o,
                            run_context *r, sn_run_summary *summary, sn_record *history) {
    char folder[4096];
    void *state = NULL;
    if (o->refine) // sn_alloc'd parts of the estimate belong to the context
        return (run_by_order(o->by) ? sn_continuum_raise : sn_continuum_refine)(
            c, o->refine, output, summary, history, &r->refinement);
    sn_restart restart = {0};
    if (o->folder && cli_rank() == 0) {
        snprintf(folder, sizeof folder, "%s", o->folder);
        restart = (sn_restart){.context = folder, .save = run_state_write};
    }
    sn_status status = SN_OK;
    if (o->resume) status = run_state_read(o->folder, &state, &restart.bytes);
    SN_TRY(sn_ranks_agree(status));
    restart.state = state;
    status = strcmp(o->engine, "continuum") == 0
                 ? sn_continuum_resume(c, output, &restart, summary, history)
                 : sn_springs_resume(c, output, &restart, summary, history);
    sn_free(state);
    if (status == SN_OK && o->folder && cli_rank() == 0 && summary->converged)
        run_state_remove(o->folder);
    return status;
}

// The case, and all that a run fills; of several ranks the first alone writes files.
static sn_status prepare(const char *path, const run_options *o, sn_case **c, sn_record **history,
                         run_context *r) {
    SN_TRY(sn_case_read(path, c));
    SN_TRY(sn_record_create((*c)->name, history));
    SN_TRY(sn_record_create((*c)->name, &r->energy));
    r->history = *history;
    r->nodes = (*c)->mesh->node_count;
    r->displacement = sn_alloc((size_t)r->nodes, 3 * sizeof *r->displacement);
    r->cells = (*c)->mesh->cell_count;
    r->removed = sn_alloc((size_t)r->cells, sizeof *r->removed);
    if (!r->displacement || !r->removed) return SN_E_MEMORY;
    if (!o->folder || cli_rank() > 0) return SN_OK;
    SN_TRY(sn_folder_make(o->folder));
    return sn_vtu_create(o->folder, "fields", (*c)->mesh, &r->vtu);
}

static sn_status run_case(const char *path, const run_options *o, const cli_arguments *arguments,
                          sn_run_summary *summary) {
    sn_case *c = NULL;
    sn_record *history = NULL;
    run_context r = {.progress = cli_progress_start(arguments), .earlier = o->resume ? -1 : 0};
    sn_output output = {.context = &r, .frame = take_frame, .progress = pass_progress};
    sn_status status;
    SN_TRY_GOTO(status, sn_ranks_agree(prepare(path, o, &c, &history, &r)));
    output.energy = o->folder ? r.energy : NULL;
    status = run_engine(c, &output, o, &r, summary, history);
    cli_progress_end(&r.progress);
    run_mesh_note(c->mesh, summary);
    if (status != SN_OK) {
        status = sn_fail_within(status, "%s", path);
        goto fail;
    }
    if (o->folder && cli_rank() == 0)
        SN_TRY_GOTO(status, write_results(o->folder, c, summary, history, &r));
    if (arguments->json)
        cli_print_json(summary_json(summary, history, &r.refinement));
    else if (!arguments->quiet)
        print_summary(summary, history, &r.refinement, o->folder);
fail:
    sn_vtu_destroy(r.vtu);
    sn_refinement_release(&r.refinement);
    sn_free(r.displacement);
    sn_free(r.removed);
    sn_record_destroy(r.energy);
    sn_record_destroy(history);
    sn_case_destroy(c);
    return status;
}

// What belongs to one engine, and what excludes each other.
static int check_options(const run_options *o) {
    if (o->refine && strcmp(o->engine, "springs") == 0)
        return cli_refuse("run: --refine is for --engine continuum");
    if (cli_ranks() > 1 && strcmp(o->engine, "springs") == 0)
        return cli_refuse("run: --engine springs runs in one process (springs: threads); mpirun is "
                          "for --engine continuum");
    if (o->refine && o->resume) return cli_refuse("run: --refine and --resume exclude each other");
    if (o->refine == 1 || o->refine > SN_REFINE_MAX)
        return cli_refuse("--refine: found %d, expected 2 or 3 meshes", o->refine);
    if (o->by && !o->refine) return cli_refuse("run: --by says how --refine refines: give both");
    if (o->by && !run_by_order(o->by) && strcmp(o->by, "cells") != 0)
        return cli_refuse("--by: found \"%s\", expected cells or order", o->by);
    return CLI_DONE;
}

static int run(const cli_command *command, int argc, char **argv) {
    static const char *const engines[] = {"springs", "continuum"};
    run_options o = {0};
    const cli_option options[] = {
        {"engine", CLI_TEXT, "NAME", NULL, &o.engine, "springs or continuum"},
        {"out", CLI_TEXT, "DIR", NULL, &o.folder,
         "writes report.html, summary.json, history.csv and fields.pvd there"},
        {"refine", CLI_INTEGER, "N", NULL, &o.refine,
         "continuum: 2 or 3 meshes of halved cells, and the error they show"},
        {"by", CLI_TEXT, "NAME", NULL, &o.by,
         "with --refine: cells (halved), or order (P1, P2P1, P2P1 on halved cells)"},
        {"resume", CLI_TEXT, "DIR", NULL, &o.resume,
         "goes on where the run of the same case into DIR was killed"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 5, &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("run: expected one case file, got %d", arguments.count);
    if (!o.engine) return cli_refuse("run: --engine is missing: springs or continuum");
    if (strcmp(o.engine, engines[0]) != 0 && strcmp(o.engine, engines[1]) != 0)
        return cli_unknown("engine", o.engine, engines, 2);
    if ((code = check_options(&o)) != CLI_DONE) return code;
    if (o.resume && o.folder && strcmp(o.resume, o.folder) != 0)
        return cli_refuse("run: --resume %s goes on in that folder, not in --out %s", o.resume,
                          o.folder);
    if (o.resume) o.folder = o.resume;
    sn_run_summary summary = {0};
    sn_status status = run_case(arguments.item[0], &o, &arguments, &summary);
    if (status != SN_OK) return cli_fail(status);
    if (summary.converged) return CLI_DONE;
    cli_refuse("%s: %s", arguments.item[0], summary.reason);
    return CLI_FAILED;
}

const cli_command cli_run = {
    "run",
    "CASE.yaml --engine springs|continuum [--out DIR] [--refine N] [--by NAME] [--resume DIR]",
    "one case through the springs or the finite elements",
    "sinew run examples/muscle/strip-1s.yaml --engine springs --out out", run};
