// sinew fit: measured curves to a tissue.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/fit.h"

//---- reading -------------------------------------------------------------------------------------

static void release_data(fit_data *data) {
    for (int k = 0; k < data->count; k++) sn_curve_release(&data->curve[k]);
    data->count = 0;
}

static sn_status read_data(const cli_arguments *arguments, fit_data *data) {
    for (int k = 0; k < arguments->count; k++) {
        const char *path = arguments->item[k];
        sn_record *record;
        SN_TRY(sn_curve_read(path, &record));
        data->path[k] = path;
        data->curve[k] = (sn_curve){0};
        sn_status status = sn_curve_from_record(record, &data->curve[k]);
        data->count = k + 1;
        // biaxial and shear tables are published without; sn_fit() asks for it where memory needs
        // it
        const sn_curve *curve = &data->curve[k];
        if (status == SN_OK && !curve->time && curve->kind == SN_CURVE_UNIAXIAL)
            status =
                sn_fail(SN_E_DATA, "%s: no time column: a fit follows the recorded history", path);
        sn_record_destroy(record);
        SN_TRY(status);
        SN_TRY(sn_file_sha256(path, data->sha256[k]));
    }
    return SN_OK;
}

// the parameter of a table that a name stands for: its own, or a3 of a list a; NULL: none
static const sn_param *find_constant(const sn_param *params, int count, const char *name) {
    int at = sn_param_find(params, count, name);
    if (at >= 0) return &params[at];
    for (int i = 0; i < count; i++) {
        size_t stem = strlen(params[i].name);
        if (params[i].length == 0 || strncmp(name, params[i].name, stem) != 0) continue;
        if (name[stem] && name[stem + strspn(name + stem, "0123456789")] == 0) return &params[i];
    }
    return NULL;
}

// "NAME=VALUE" with the value in the unit of the law's or the memory's table
static sn_status read_fixed(const cli_list *list, sn_fit_def *def, char names[][SN_NAME_MAX]) {
    for (int k = 0; k < list->count; k++) {
        const char *equals = strchr(list->item[k], '=');
        size_t length = equals ? (size_t)(equals - list->item[k]) : 0;
        if (!equals || length == 0 || length >= SN_NAME_MAX)
            return sn_fail(SN_E_SYNTAX, "--fix: found \"%s\", expected NAME=VALUE", list->item[k]);
        memcpy(names[k], list->item[k], length);
        names[k][length] = 0;
        const sn_param *param = find_constant(def->law->params, def->law->param_count, names[k]);
        if (!param && def->memory)
            param = find_constant(def->memory->params, def->memory->param_count, names[k]);
        if (!param)
            return sn_fail(SN_E_NAME,
                           "--fix: neither law \"%s\" nor the memory has a constant "
                           "\"%s\"",
                           def->law->name, names[k]);
        def->fixed_name[k] = names[k];
        sn_status status = sn_quantity_parse(equals + 1, param->unit, &def->fixed_value[k]);
        if (status != SN_OK) return sn_fail_within(status, "--fix %s", names[k]);
    }
    def->fixed_count = list->count;
    return SN_OK;
}

//---- held-out predictions ------------------------------------------------------------------------

// fits all curves but one and predicts that one
static sn_status hold_out(const sn_fit_def *def, const fit_data *data, int left_out,
                          held_out *result) {
    sn_curve others[SN_FIT_CURVES_MAX];
    int count = 0;
    for (int k = 0; k < data->count; k++)
        if (k != left_out) others[count++] = data->curve[k];
    sn_fit_def rest = *def;
    rest.curve = others;
    rest.curve_count = count;
    sn_fit_result *fit = sn_alloc(1, sizeof *fit);
    if (!fit) return SN_E_MEMORY;
    sn_status status = sn_fit(&rest, fit);
    if (status == SN_OK) {
        result->tissue = fit->tissue;
        status = sn_fit_predict(&fit->tissue, &data->curve[left_out], &result->prediction);
        sn_fit_release(fit);
    }
    sn_free(fit);
    return status;
}

static sn_status hold_out_each(const sn_fit_def *def, const fit_data *data, held_out *results) {
    if (data->count < 2)
        return sn_fail(SN_E_DATA, "--hold-out needs at least two curves: one is predicted from the "
                                  "others");
    for (int k = 0; k < data->count; k++) SN_TRY(hold_out(def, data, k, &results[k]));
    return SN_OK;
}

//---- the tissue file -----------------------------------------------------------------------------

static sn_status write_tissue(const char *folder, const fit_outcome *o) {
    char path[4096], comment[1024];
    snprintf(comment, sizeof comment,
             "fitted by sinew fit %s to %d curve%s, %d points: R2 %.4f, rms error %s\n"
             "elastic constants are instantaneous: G(0) = 1%s",
             sn_version(), o->data->count, o->data->count == 1 ? "" : "s", o->fit->points,
             o->fit->r_squared, cli_show(o->fit->rmse, "Pa"),
             o->bulk_ratio > 0 ? "\nbulk_modulus was not fitted: a multiple of the shear modulus, "
                                 "for engines that need it finite"
                               : "");
    return sn_tissue_write(cli_path(path, sizeof path, folder, "tissue.yaml"), &o->fit->tissue,
                           comment);
}

static sn_status complete_tissue(fit_outcome *o, const char *name, double density) {
    sn_tissue *tissue = &o->fit->tissue;
    snprintf(tissue->name, sizeof tissue->name, "%s", name ? name : "fitted tissue");
    snprintf(tissue->source, sizeof tissue->source, "fit of");
    for (int k = 0; k < o->data->count; k++) {
        size_t used = strlen(tissue->source);
        snprintf(tissue->source + used, sizeof tissue->source - used, "%s %s", k ? "," : "",
                 cli_basename(o->data->path[k]));
    }
    tissue->density = density;
    if (o->bulk_ratio <= 0) return SN_OK;
    sn_moduli moduli;
    sn_tissue_moduli(tissue, &moduli);
    sn_status status = sn_tissue_set(tissue, "bulk_modulus", o->bulk_ratio * moduli.shear);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "--bulk-ratio");
}

//---- the command ---------------------------------------------------------------------------------

static sn_status write_results(const char *folder, const fit_outcome *o, const json_t *json) {
    char path[4096];
    SN_TRY(sn_folder_make(folder));
    SN_TRY(write_tissue(folder, o));
    SN_TRY(cli_write_json(folder, "fit.json", json));
    return fit_report(cli_path(path, sizeof path, folder, "report.html"), o);
}

typedef struct fit_request {
    const char *elastic, *memory, *folder, *name;
    int terms;
    bool hold_out;
    double density, bulk_ratio;
    cli_list fixed;
} fit_request;

static sn_status fit_all(const fit_request *request, const cli_arguments *arguments,
                         fit_outcome *o) {
    sn_fit_def def = sn_fit_def_default();
    char names[SN_FIT_PARAMS_MAX][SN_NAME_MAX];
    cli_progress progress = cli_progress_start(arguments);
    def.law = sn_law_find(request->elastic);
    if (!def.law) return sn_fail_within(SN_E_NAME, "--elastic");
    if (request->memory) {
        def.memory = sn_memory_law_find(request->memory);
        if (!def.memory) return sn_fail_within(SN_E_NAME, "--memory");
    }
    SN_TRY(read_fixed(&request->fixed, &def, names));
    SN_TRY(read_data(arguments, o->data));
    def.terms = request->terms;
    def.curve = o->data->curve;
    def.curve_count = o->data->count;
    def.progress = cli_progress_show;
    def.progress_context = &progress;
    sn_status status = sn_fit(&def, o->fit);
    if (status != SN_OK) return status;
    o->fitted = true;
    if (request->hold_out) SN_TRY(hold_out_each(&def, o->data, o->held_out));
    cli_progress_end(&progress);
    return complete_tissue(o, request->name, request->density);
}

static int work(const fit_request *request, const cli_arguments *arguments, fit_outcome *o) {
    sn_status status = fit_all(request, arguments, o);
    if (status != SN_OK) return cli_fail(status);
    json_t *json = fit_json(o);
    if (request->folder) status = write_results(request->folder, o, json);
    if (status == SN_OK && !arguments->json && !arguments->quiet) {
        fit_print(o);
        if (request->folder)
            printf("  results in %s (report.html, fit.json, tissue.yaml)\n", request->folder);
    }
    if (status == SN_OK && arguments->json)
        cli_print_json(json);
    else
        json_decref(json);
    if (status != SN_OK) return cli_fail(status);
    return o->fit->converged ? CLI_DONE : CLI_FAILED;
}

static int run(const cli_command *command, int argc, char **argv) {
    fit_request request = {.terms = 3, .density = NAN, .bulk_ratio = 0};
    const cli_option options[] = {
        {"elastic", CLI_TEXT, "LAW", NULL, &request.elastic, "exponential, linear, demiray, …"},
        {"memory", CLI_TEXT, "LAW", NULL, &request.memory,
         "fung-spectrum, prony, kelvin, maxwell, voigt, none"},
        {"terms", CLI_INTEGER, "N", NULL, &request.terms, "exponentials of --memory prony"},
        {"fix", CLI_LIST, "NAME=VALUE", NULL, &request.fixed,
         "holds a constant, e.g. tau1=\"1 ms\"; may be repeated"},
        {"hold-out", CLI_FLAG, NULL, NULL, &request.hold_out,
         "also predicts every curve from a fit of the others"},
        {"name", CLI_TEXT, "TEXT", NULL, &request.name, "name of the tissue"},
        {"density", CLI_QUANTITY, "DENSITY", "kg/m3", &request.density,
         "density to put into tissue.yaml, e.g. \"1060 kg/m3\""},
        {"bulk-ratio", CLI_QUANTITY, "RATIO", "1", &request.bulk_ratio,
         "bulk over shear modulus to put into tissue.yaml instead of incompressible"},
        {"out", CLI_TEXT, "DIR", NULL, &request.folder,
         "writes tissue.yaml, fit.json and report.html there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 9, &arguments);
    if (code >= 0) return code;
    if (arguments.count < 1) return cli_refuse("fit: no curve given; see sinew fit --help");
    if (arguments.count > SN_FIT_CURVES_MAX)
        return cli_refuse("fit: %d curves given, at most %d", arguments.count, SN_FIT_CURVES_MAX);
    if (!request.elastic)
        return cli_refuse("fit: --elastic is missing, e.g. --elastic exponential");
    fit_outcome outcome = {.bulk_ratio = request.bulk_ratio};
    outcome.data = sn_alloc(1, sizeof *outcome.data);
    outcome.fit = sn_alloc(1, sizeof *outcome.fit);
    outcome.held_out = sn_alloc(SN_FIT_CURVES_MAX, sizeof *outcome.held_out);
    outcome.has_held_out = request.hold_out;
    code = outcome.data && outcome.fit && outcome.held_out ? work(&request, &arguments, &outcome)
                                                           : cli_fail(SN_E_MEMORY);
    if (outcome.fitted) sn_fit_release(outcome.fit);
    if (outcome.data) release_data(outcome.data);
    for (int k = 0; outcome.held_out && k < SN_FIT_CURVES_MAX; k++) {
        sn_free(outcome.held_out[k].prediction.predicted);
        sn_free(outcome.held_out[k].prediction.predicted_2);
    }
    sn_free(outcome.held_out);
    sn_free(outcome.fit);
    sn_free(outcome.data);
    return code;
}

const cli_command cli_fit = {
    "fit", "CURVE.csv… --elastic LAW [--memory LAW] [--terms N] [--hold-out] [--out DIR]",
    "measured curves to a tissue, through their recorded histories",
    "sinew fit data/cardiac-muscle/ramp-*.csv --elastic exponential --memory fung-spectrum "
    "--hold-out --out out",
    run};
