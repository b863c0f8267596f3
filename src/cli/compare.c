// sinew compare: what the speed of the springs costs in accuracy.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

static json_t *model_json(const sn_comparison_model *m) {
    json_t *json = json_object();
    cli_put_text(json, "name", m->name);
    cli_put_flag(json, "done", m->done);
    cli_put_text(json, "reason", m->summary.reason);
    cli_put_number(json, "displacement_rms", m->displacement_rms);
    cli_put_number(json, "displacement_max", m->displacement_max);
    cli_put_number(json, "reaction_rms", m->reaction_rms);
    cli_put_number(json, "stress_rms", m->stress_rms);
    cli_put_number(json, "energy", m->energy);
    cli_put_number(json, "wall_s", m->summary.wall_s);
    cli_put_number(json, "real_time_factor", m->summary.real_time_factor);
    cli_put_integer(json, "nodes", m->summary.nodes);
    cli_put_integer(json, "cells", m->summary.cells);
    cli_put_integer(json, "memory_terms", m->summary.memory_terms);
    return json;
}

static json_t *comparison_json(const sn_case *c, const sn_comparison *r) {
    json_t *json = json_object(), *models = json_array(), *reference = model_json(&r->reference);
    cli_put_text(reference, "text", r->reference_text);
    for (int m = 0; m < r->model_count; m++)
        json_array_append_new(models, model_json(&r->model[m]));
    cli_put_text(json, "case", c->name);
    cli_put(json, "reference", reference);
    cli_put(json, "models", models);
    return json;
}

//---- table ---------------------------------------------------------------------------------------

#define COLUMNS 8
#define CELL 48

static const char *percent(char *text, double value) {
    if (!isfinite(value))
        snprintf(text, CELL, "\xe2\x80\x94");
    else if (fabs(value) < 1e-6) // a tenth of a thousandth of a per cent is nothing here
        snprintf(text, CELL, "< 0.0001 %%");
    else
        snprintf(text, CELL, "%.3g %%", 100 * value);
    return text;
}

static void fill_row(const sn_comparison_model *m, char text[COLUMNS][CELL]) {
    snprintf(text[0], CELL, "%s%s", m->name, m->done ? "" : " (not to the end)");
    percent(text[1], m->displacement_rms);
    percent(text[2], m->displacement_max);
    percent(text[3], m->reaction_rms);
    percent(text[4], m->stress_rms);
    percent(text[5], m->energy);
    snprintf(text[6], CELL, "%s", cli_show(m->summary.wall_s, "s"));
    snprintf(text[7], CELL, "%.3g", m->summary.real_time_factor);
}

// header, reference, models; rows * COLUMNS strings
static int fill_table(const sn_comparison *r, char text[][COLUMNS][CELL]) {
    static const char *const header[COLUMNS] = {"model",     "displ. rms",      "displ. max",
                                                "force rms", "stress rms",      "energy",
                                                "wall time", "real-time factor"};
    for (int k = 0; k < COLUMNS; k++) snprintf(text[0][k], CELL, "%s", header[k]);
    fill_row(&r->reference, text[1]);
    for (int m = 0; m < r->model_count; m++) fill_row(&r->model[m], text[2 + m]);
    return 2 + r->model_count;
}

//---- page ----------------------------------------------------------------------------------------

// the component of a force that is largest in the reference, for all models
static void force_plot(sn_report *report, const sn_comparison *r, int first) {
    const sn_record *truth = r->reference.history;
    int best = first;
    double largest = -1;
    for (int d = first; d < first + 3; d++)
        for (int i = 0; i < truth->rows; i++)
            if (fabs(truth->series[d].value[i]) > largest) {
                largest = fabs(truth->series[d].value[i]);
                best = d;
            }
    sn_line line[1 + SN_COMPARE_MODELS_MAX];
    int n = 0;
    line[n++] = (sn_line){"P2P1 reference",         SN_LINE, 0, truth->rows, truth->series[0].value,
                          truth->series[best].value};
    for (int m = 0; m < r->model_count; m++) {
        const sn_record *h = r->model[m].history;
        if (h->rows == 0) continue;
        line[n++] = (sn_line){r->model[m].name, SN_DASHED,          m + 1,
                              h->rows,          h->series[0].value, h->series[best].value};
    }
    char title[SN_NAME_MAX + 32], label[SN_NAME_MAX + 16];
    const sn_series *s = &truth->series[best];
    bool is_force = strcmp(s->unit, "N") == 0;
    snprintf(title, sizeof title, "%s over time", s->name);
    snprintf(label, sizeof label, "%s [%s]", s->name, is_force ? "N" : "mm");
    sn_report_plot(report, &(sn_plot){.title = title,
                                      .x_label = "time [s]",
                                      .y_label = label,
                                      .y_scale = is_force ? 1 : 1e3,
                                      .line_count = n,
                                      .line = line});
}

// Error of the force where the case measures one: under prescribed motion the displacement error
// says little.
static void cost_plot(sn_report *report, const sn_comparison *r) {
    sn_line line[SN_COMPARE_MODELS_MAX];
    int n = 0;
    bool forces = isfinite(r->reference.reaction_rms) || isfinite(r->model[0].reaction_rms);
    for (int m = 0; m < r->model_count; m++) {
        const sn_comparison_model *model = &r->model[m];
        const double *error = forces ? &model->reaction_rms : &model->displacement_rms;
        if (!isfinite(*error) || *error <= 0) continue;
        line[n++] = (sn_line){model->name, SN_POINTS, m + 1, 1, &model->summary.wall_s, error};
    }
    sn_report_plot(report, &(sn_plot){.title = "Error against cost",
                                      .x_label = "wall time [s]",
                                      .y_label = forces ? "force error, rms [%]"
                                                        : "displacement error, rms [%]",
                                      .log_x = true,
                                      .log_y = true,
                                      .y_scale = 100,
                                      .line_count = n,
                                      .line = line});
}

static void bodies(sn_report *report, const sn_case *c, const sn_comparison *r) {
    sn_body body[SN_COMPARE_MODELS_MAX];
    int n = 0;
    double top = 0;
    for (int m = 0; m < r->model_count; m++) {
        const sn_comparison_model *model = &r->model[m];
        if (!model->displacement) continue;
        for (int i = 0; i < c->mesh->node_count; i++) top = fmax(top, model->error[i]);
        body[n++] = (sn_body){
            model->name, "displacement error [mm]", c->mesh, model->displacement, model->error, 0,
            1e3};
    }
    for (int k = 0; k < n; k++) body[k].value_max = top;
    if (n > 0)
        sn_report_bodies(report, n, body,
                         "The deformed body at the last output time, painted with the distance to "
                         "the reference, one scale for all. Drag to turn, wheel to zoom.");
}

static sn_status write_report(const char *path, const sn_case *c, const sn_comparison *r) {
    char text[2 + SN_COMPARE_MODELS_MAX][COLUMNS][CELL];
    const char *cells[(2 + SN_COMPARE_MODELS_MAX) * COLUMNS];
    char title[SN_TEXT_MAX + 32];
    sn_report *report;
    snprintf(title, sizeof title, "%s: springs against the continuum", c->name);
    SN_TRY(sn_report_create(title, &report));
    int rows = fill_table(r, text);
    for (int k = 0; k < rows * COLUMNS; k++) cells[k] = text[k / COLUMNS][k % COLUMNS];
    sn_report_text(report, "Reference: %s. %d nodes, %d cells.", r->reference_text,
                   c->mesh->node_count, c->mesh->cell_count);
    sn_report_table(report, rows, COLUMNS, cells,
                    "Errors relative to the reference's largest displacement, force and stress "
                    "over the whole run; the reference's own row holds its estimated error. P1 "
                    "finite elements show what the mesh alone costs. A real-time factor above 1 "
                    "is faster than the clock.");
    for (int m = 0; m < r->model_count; m++) {
        const sn_run_summary *s = &r->model[m].summary;
        if (*s->reason) sn_report_text(report, "%s: %s", r->model[m].name, s->reason);
        // the continuum's notes are about its energies, which a comparison does not show
        if (*s->note && strcmp(s->engine, "springs") == 0)
            sn_report_text(report, "%s: %s", r->model[m].name, s->note);
        if (s->memory_terms)
            sn_report_text(report,
                           "%s: memory as %d exponentials, error at most %.2g of G(0) from %s to "
                           "%s; step %s.",
                           r->model[m].name, s->memory_terms, s->memory_error,
                           cli_show(s->memory_band_s[0], "s"), cli_show(s->memory_band_s[1], "s"),
                           cli_show(s->step_s, "s"));
    }
    bodies(report, c, r);
    const sn_record *h = r->reference.history;
    for (int k = 1; k + 2 < h->series_count; k += 3) force_plot(report, r, k);
    cost_plot(report, r);
    sn_status status = sn_report_write(report, path);
    sn_report_destroy(report);
    return status;
}

//---- the command ---------------------------------------------------------------------------------

static void print_table(const sn_case *c, const sn_comparison *r) {
    char text[2 + SN_COMPARE_MODELS_MAX][COLUMNS][CELL];
    int rows = fill_table(r, text);
    printf("%s: %d nodes, %d cells\n", c->name, c->mesh->node_count, c->mesh->cell_count);
    for (int i = 0; i < rows; i++) {
        printf("  %-22s", i == 1 ? "P2P1 (own error)" : text[i][0]);
        for (int k = 1; k < COLUMNS; k++) {
            // the dash for "not known" is three bytes and one column
            int wide = strchr(text[i][k], '\xe2') || strchr(text[i][k], '\xc2') ? 1 : 0;
            printf(" %*s", 12 + wide + (text[i][k][0] == '\xe2' ? 1 : 0), text[i][k]);
        }
        printf("\n");
    }
    for (int m = 0; m < r->model_count; m++)
        if (*r->model[m].summary.reason)
            printf("  %s: %s\n", r->model[m].name, r->model[m].summary.reason);
}

static sn_status compare(const char *path, const char *folder, const cli_arguments *arguments) {
    sn_case *c = NULL;
    sn_comparison r = {0};
    json_t *json = NULL;
    char file[4096];
    cli_progress progress = cli_progress_start(arguments);
    sn_output output = {.context = &progress, .progress = cli_progress_show};
    sn_status status;
    SN_TRY_GOTO(status, sn_case_read(path, &c));
    status = sn_compare(c, &output, &r);
    cli_progress_end(&progress);
    if (status != SN_OK) {
        status = sn_fail_within(status, "%s", path);
        goto fail;
    }
    json = comparison_json(c, &r);
    if (folder) {
        SN_TRY_GOTO(status, sn_folder_make(folder));
        SN_TRY_GOTO(status, cli_write_json(folder, "compare.json", json));
        SN_TRY_GOTO(status,
                    write_report(cli_path(file, sizeof file, folder, "report.html"), c, &r));
    }
    if (arguments->json) {
        cli_print_json(json_incref(json));
    } else if (!arguments->quiet) {
        print_table(c, &r);
        if (folder) printf("  results in %s (report.html, compare.json)\n", folder);
    }
fail:
    json_decref(json);
    sn_comparison_destroy(&r);
    sn_case_destroy(c);
    return status;
}

static int run(const cli_command *command, int argc, char **argv) {
    const char *folder = NULL;
    const cli_option options[] = {
        {"out", CLI_TEXT, "DIR", NULL, &folder, "writes report.html and compare.json there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 1, &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("compare: expected one case file, got %d", arguments.count);
    sn_status status = compare(arguments.item[0], folder, &arguments);
    return status == SN_OK ? CLI_DONE : cli_fail(status);
}

const cli_command cli_compare = {"compare", "CASE.yaml [--out DIR]",
                                 "spring rungs against the continuum on one case: error and cost",
                                 "sinew compare examples/muscle/strip-1s.yaml --out out", run};
