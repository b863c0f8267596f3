// sinew compare: what the speed of the springs costs in accuracy.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/compare.h"

//---- JSON ----------------------------------------------------------------------------------------

static json_t *live_json(const sn_live *live) {
    json_t *json = json_object();
    cli_put_number(json, "step_s", live->step_s);
    cli_put_number(json, "real_time_factor", live->real_time_factor);
    cli_put_number(json, "frame_p50_s", live->frame_p50_s);
    cli_put_number(json, "frame_p99_s", live->frame_p99_s);
    cli_put_number(json, "frame_max_s", live->frame_max_s);
    return json;
}

static json_t *model_json(const sn_comparison_model *m, int mesh) {
    json_t *json = json_object();
    cli_put_text(json, "name", m->name);
    cli_put_integer(json, "mesh", mesh);
    cli_put_flag(json, "done", m->done);
    cli_put_text(json, "reason", m->summary.reason);
    cli_put_number(json, "displacement_rms", m->error.displacement_rms);
    cli_put_number(json, "displacement_max", m->error.displacement_max);
    cli_put_number(json, "response_rms", m->error.response_rms);
    cli_put_number(json, "reaction_rms", m->error.reaction_rms);
    cli_put_number(json, "stress_rms", m->error.stress_rms);
    cli_put_number(json, "energy", m->error.energy);
    cli_put_number(json, "relaxation_max", m->error.relaxation_max);
    cli_put_number(json, "wall_s", m->summary.wall_s);
    cli_put_number(json, "real_time_factor", m->summary.real_time_factor);
    cli_put(json, "live", live_json(&m->live));
    cli_put_number(json, "calibration_s", m->calibration_s);
    cli_put_number(json, "peak_memory_bytes", m->peak_memory_bytes);
    cli_put_integer(json, "nodes", m->summary.nodes);
    cli_put_integer(json, "cells", m->summary.cells);
    cli_put_integer(json, "springs", m->summary.springs);
    cli_put_integer(json, "memory_terms", m->summary.memory_terms);
    return json;
}

static void append_words(void *context, const char *text) {
    json_array_append_new(context, json_string(text));
}

static json_t *case_json(const compare_study *s, const compare_case *one) {
    json_t *json = json_object(), *models = json_array(), *left_out = json_array();
    json_t *reference = model_json(&one->reference.model, one->reference_mesh);
    json_t *words = json_array();
    cli_put_text(reference, "text", one->reference.text);
    for (int k = 0; k < one->run_count; k++) {
        const compare_run *run = &one->run[k];
        if (run->left_out && run->mesh == s->mesh[0]) {
            json_t *item = json_object();
            cli_put_text(item, "name", sn_compare_model_name(run->model));
            cli_put_text(item, "reason", run->why);
            json_array_append_new(left_out, item);
        }
        if (!run->left_out && one->reference.model.done)
            json_array_append_new(models, model_json(&run->result, run->mesh));
    }
    compare_words(s, one, append_words, words);
    cli_put_text(json, "case", one->c->name);
    cli_put_text(json, "file", one->path);
    cli_put(json, "reference", reference);
    cli_put(json, "models", models);
    cli_put(json, "left_out", left_out);
    cli_put(json, "words", words);
    return json;
}

static json_t *summary_json(const compare_study *s) {
    json_t *json = json_array();
    compare_summary *rows;
    int count = compare_summarise(s, &rows);
    for (int k = 0; k < count; k++) {
        json_t *row = json_object();
        cli_put_text(row, "name", sn_compare_model_name(rows[k].model));
        cli_put_integer(row, "mesh", rows[k].mesh);
        cli_put_integer(row, "nodes", rows[k].nodes);
        cli_put_integer(row, "cases", rows[k].cases);
        cli_put_integer(row, "missing", rows[k].missing);
        cli_put_number(row, "median", rows[k].median);
        cli_put_number(row, "worst", rows[k].worst);
        cli_put_text(row, "worst_case", rows[k].worst_case);
        cli_put_number(row, "displacement_rms", rows[k].displacement);
        cli_put_number(row, "response_rms", rows[k].answer);
        cli_put_number(row, "relaxation_max", rows[k].relaxation);
        cli_put_number(row, "wall_s", rows[k].wall_s);
        cli_put_number(row, "live_real_time_factor", rows[k].slowest);
        json_array_append_new(json, row);
    }
    sn_free(rows);
    return json;
}

static json_t *study_json(const compare_study *s) {
    if (s->case_count == 1) return case_json(s, &s->item[0]);
    json_t *json = json_object(), *cases = json_array(), *words = json_array();
    for (int k = 0; k < s->case_count; k++) json_array_append_new(cases, case_json(s, &s->item[k]));
    compare_words(s, NULL, append_words, words);
    cli_put(json, "cases", cases);
    cli_put(json, "summary", summary_json(s));
    cli_put(json, "words", words);
    return json;
}

//---- output --------------------------------------------------------------------------------------

static sn_status write_case(const compare_study *s, const compare_case *one) {
    char folder[2048], file[4096];
    json_t *json = case_json(s, one);
    sn_status status;
    cli_path(folder, sizeof folder, s->folder, one->folder);
    SN_TRY_GOTO(status, sn_folder_make(folder));
    SN_TRY_GOTO(status, cli_write_json(folder, "compare.json", json));
    status = compare_write_page(cli_path(file, sizeof file, folder, "report.html"), s, one);
fail:
    json_decref(json);
    return status;
}

static sn_status write_all(const compare_study *s, const json_t *json) {
    char file[4096];
    for (int k = 0; k < s->case_count; k++) SN_TRY(write_case(s, &s->item[k]));
    if (s->case_count == 1) return SN_OK;
    SN_TRY(cli_write_json(s->folder, "study.json", json));
    return compare_write_overview(cli_path(file, sizeof file, s->folder, "report.html"), s);
}

static void print_words(void *context, const char *text) {
    (void)context;
    printf("  %s\n", text);
}

static sn_status print_all(const compare_study *s) {
    compare_table table;
    if (s->case_count == 1) {
        printf("%s\n", s->item[0].c->name);
        SN_TRY(compare_case_table(&s->item[0], &table));
        compare_table_print(&table);
        compare_table_release(&table);
    } else {
        SN_TRY(compare_summary_table(s, &table));
        compare_table_print(&table);
        compare_table_release(&table);
        printf("\n");
        SN_TRY(compare_cases_table(s, &table));
        compare_table_print(&table);
        compare_table_release(&table);
    }
    compare_words(s, s->case_count == 1 ? s->item : NULL, print_words, NULL);
    if (s->folder)
        printf("  results in %s (report.html, %s)\n", s->folder,
               s->case_count == 1 ? "compare.json" : "study.json");
    return SN_OK;
}

static sn_status check_references(const compare_study *s) {
    for (int k = 0; k < s->case_count; k++)
        if (s->item[k].reference.model.done) return SN_OK;
    return sn_fail(SN_E_SOLVER, "%s: the reference did not run to its end: %s", s->item[0].path,
                   s->item[0].reference.model.summary.reason);
}

static sn_status compare(compare_study *s, const cli_arguments *arguments) {
    json_t *json = NULL;
    sn_status status;
    s->progress = cli_progress_start(arguments);
    status = compare_work(s);
    cli_progress_end(&s->progress);
    if (status != SN_OK) return status;
    json = study_json(s);
    if (s->folder) SN_TRY_GOTO(status, write_all(s, json));
    SN_TRY_GOTO(status, check_references(s));
    if (arguments->json)
        cli_print_json(json_incref(json));
    else if (!arguments->quiet)
        status = print_all(s);
fail:
    json_decref(json);
    return status;
}

//---- arguments -----------------------------------------------------------------------------------

// calls `take` with every part of "a,b,c"; stops at the first exit code
static int each_part(const char *list, compare_study *s,
                     int (*take)(compare_study *s, const char *part)) {
    char part[SN_NAME_MAX];
    for (const char *at = list; at; at = *at ? at + 1 : NULL) {
        size_t length = strcspn(at, ",");
        snprintf(part, sizeof part, "%.*s", (int)(length < 60 ? length : 60), at);
        int code = take(s, part);
        if (code >= 0) return code;
        at += length;
        if (!*at) break;
    }
    return -1;
}

static int take_mesh(compare_study *s, const char *part) {
    char *end;
    long factor = strtol(part, &end, 10);
    if (*end || end == part || factor < 1 || factor > 64)
        return cli_refuse("compare: --meshes: found \"%s\", expected factors on the cells of the "
                          "case such as 1,2,3",
                          part);
    if (s->mesh_count == COMPARE_MESHES_MAX)
        return cli_refuse("compare: --meshes: at most %d expected", COMPARE_MESHES_MAX);
    if (s->mesh_count > 0 && s->mesh[s->mesh_count - 1] >= factor)
        return cli_refuse("compare: --meshes: %ld after %d, expected rising factors", factor,
                          s->mesh[s->mesh_count - 1]);
    s->mesh[s->mesh_count++] = (int)factor;
    return -1;
}

static int take_model(compare_study *s, const char *part) {
    const char *names[SN_COMPARE_MODELS_MAX];
    int count = sn_compare_model_count();
    for (int k = 0; k < count; k++) {
        names[k] = sn_compare_model_name(k);
        if (strcmp(names[k], part) != 0) continue;
        for (int m = 0; m < s->model_count; m++)
            if (s->model[m] == k) return cli_refuse("compare: --models: %s stands twice", part);
        s->model[s->model_count++] = k;
        return -1;
    }
    return cli_unknown("model", part, names, count);
}

// the file's name without its ending, and a number where another case has that too
static void name_folder(compare_study *s, int k) {
    const char *base = cli_basename(s->item[k].path), *dot = strrchr(base, '.');
    size_t length = dot ? (size_t)(dot - base) : strlen(base);
    char *name = s->item[k].folder;
    if (s->case_count == 1) return;
    snprintf(name, SN_NAME_MAX, "%.*s", (int)(length < 50 ? length : 50), base);
    for (int i = 0; i < k; i++)
        if (strcmp(s->item[i].folder, name) == 0) {
            snprintf(name, SN_NAME_MAX, "%.*s-%d", (int)(length < 50 ? length : 50), base, k + 1);
            break;
        }
}

static sn_status read_cases(compare_study *s, const cli_arguments *arguments, int reference) {
    s->item = sn_alloc((size_t)arguments->count, sizeof *s->item);
    if (!s->item) return SN_E_MEMORY;
    s->case_count = arguments->count;
    for (int k = 0; k < s->case_count; k++) {
        compare_case *one = &s->item[k];
        one->path = arguments->item[k];
        one->reference_mesh = reference > 0 ? reference : s->mesh[s->mesh_count - 1];
        SN_TRY(sn_case_read(one->path, &one->c));
        name_folder(s, k);
    }
    return SN_OK;
}

static int run(const cli_command *command, int argc, char **argv) {
    const char *meshes = NULL, *models = NULL;
    int reference = 0;
    compare_study s = {.jobs = 1};
    const cli_option options[] = {
        {"models", CLI_TEXT, "NAMES", NULL, &models,
         "of central, central+volume, …, P1; default: all that make sense"},
        {"meshes", CLI_TEXT, "FACTORS", NULL, &meshes,
         "on the cells along each edge, such as 1,2,3 (files: 1,2,4); default 1"},
        {"reference", CLI_INTEGER, "FACTOR", NULL, &reference,
         "mesh of the reference; default: the last of --meshes"},
        {"jobs", CLI_INTEGER, "N", NULL, &s.jobs, "processes that share the cases; default 1"},
        {"out", CLI_TEXT, "DIR", NULL, &s.folder,
         "writes report.html and compare.json or study.json there, goes on with what it holds"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 5, &arguments);
    if (code >= 0) return code;
    if (arguments.count < 1) return cli_refuse("compare: expected a case file");
    code = each_part(meshes ? meshes : "1", &s, take_mesh);
    if (code < 0 && models) code = each_part(models, &s, take_model);
    if (code >= 0) return code;
    s.models_given = models != NULL;
    if (s.jobs > 1 && !s.folder)
        return cli_refuse("compare: --jobs needs --out, where the processes put their results");
    sn_status status = read_cases(&s, &arguments, reference);
    if (status == SN_OK) status = compare(&s, &arguments);
    compare_study_release(&s);
    return status == SN_OK ? CLI_DONE : cli_fail(status);
}

const cli_command cli_compare = {"compare",
                                 "CASE.yaml… [--models NAMES] [--meshes FACTORS] [--out DIR]",
                                 "spring rungs against the continuum: error and cost",
                                 "sinew compare examples/muscle/strip-1s.yaml --out out", run};
