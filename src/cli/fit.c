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
        data->weight[k] = 1;
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

// "FILE=W" for a curve given by its path or its name
static sn_status read_weights(const cli_list *list, fit_data *data) {
    for (int k = 0; k < list->count; k++) {
        const char *equals = strrchr(list->item[k], '=');
        if (!equals || equals == list->item[k])
            return sn_fail(SN_E_SYNTAX, "--weight: found \"%s\", expected FILE=W, e.g. fast.csv=2",
                           list->item[k]);
        size_t length = (size_t)(equals - list->item[k]);
        int found = -1;
        for (int c = 0; c < data->count; c++) {
            const char *names[] = {data->path[c], cli_basename(data->path[c])};
            for (int n = 0; n < 2; n++)
                if (strlen(names[n]) == length && strncmp(names[n], list->item[k], length) == 0)
                    found = c;
        }
        if (found < 0)
            return sn_fail(SN_E_NAME,
                           "--weight %s: no curve of that name is given, the first is %s",
                           list->item[k], data->path[0]);
        sn_status status = sn_quantity_parse(equals + 1, "1", &data->weight[found]);
        if (status != SN_OK) return sn_fail_within(status, "--weight %s", list->item[k]);
        if (!(data->weight[found] > 0))
            return sn_fail(SN_E_RANGE, "--weight %s: expected a number above 0", list->item[k]);
    }
    return SN_OK;
}

static sn_status read_weighting(const char *text, sn_fit_def *def) {
    static const char *const names[] = {"plain", "peak", "noise"};
    for (int k = 0; k < 3; k++)
        if (strcmp(text, names[k]) == 0) {
            def->weighting = (sn_fit_weighting)k;
            return SN_OK;
        }
    return sn_fail(SN_E_NAME, "--weights: found \"%s\", expected plain, peak or noise", text);
}

// A number of terms, "auto" or "auto:N". *most: how many to try, 0 where the number is given.
static sn_status read_terms(const char *option, const char *text, int usual, int *terms,
                            int *most) {
    bool automatic = strncmp(text, "auto", 4) == 0;
    const char *digits = automatic ? text + 4 : text;
    *most = 0;
    if (automatic) *most = usual;
    if (automatic && *digits == 0) return SN_OK;
    if (automatic && *digits++ != ':') digits = "";
    char *end;
    long value = strtol(digits, &end, 10);
    if (end == digits || *end || value < 1 || value > SN_TERMS_MAX)
        return sn_fail(SN_E_SYNTAX,
                       "--%s: found \"%s\", expected a whole number of at least 1, auto or auto:N",
                       option, text);
    *(automatic ? most : terms) = (int)value;
    return SN_OK;
}

//---- held-out predictions ------------------------------------------------------------------------

// fits all curves but one and predicts that one
static sn_status hold_out(const sn_fit_def *def, const fit_data *data, int left_out,
                          held_out *result) {
    sn_curve others[SN_FIT_CURVES_MAX];
    double weight[SN_FIT_CURVES_MAX];
    int count = 0;
    for (int k = 0; k < data->count; k++) {
        if (k == left_out) continue;
        weight[count] = data->weight[k];
        others[count++] = data->curve[k];
    }
    sn_fit_def rest = *def;
    rest.bootstrap = 0;
    rest.weight = weight;
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
    const char *elastic, *memory, *folder, *name, *terms, *law_terms, *weights;
    int bootstrap, seed;
    bool hold_out;
    double density, bulk_ratio, from, to;
    cli_list fixed, weight;
} fit_request;

static sn_status set_request(const fit_request *request, sn_fit_def *def, fit_outcome *o,
                             int most[2]) {
    SN_TRY(read_terms("terms", request->terms, 6, &def->terms, &most[0]));
    SN_TRY(read_terms("law-terms", request->law_terms, 3, &def->law_terms, &most[1]));
    if (most[0] && most[1])
        return sn_fail(SN_E_UNSUPPORTED,
                       "fit: --terms auto and --law-terms auto together: give one "
                       "of the two numbers");
    SN_TRY(read_weighting(request->weights, def));
    if (!(request->from < request->to))
        return sn_fail(SN_E_RANGE, "fit: --from %g s is not before --to %g s", request->from,
                       request->to);
    def->from = request->from;
    def->to = request->to;
    def->bootstrap = request->bootstrap;
    def->seed = (unsigned)request->seed;
    def->weight = o->data->weight;
    o->weights = request->weights;
    o->seed = request->seed;
    return SN_OK;
}

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
    int most[2];
    SN_TRY(set_request(request, &def, o, most));
    SN_TRY(read_data(arguments, o->data));
    SN_TRY(read_weights(&request->weight, o->data));
    def.curve = o->data->curve;
    def.curve_count = o->data->count;
    def.progress = cli_progress_show;
    def.progress_context = &progress;
    o->chose = most[0] || most[1];
    o->chose_law = most[1];
    sn_status status =
        o->chose ? sn_fit_choose_terms(&def, o->chose_law, most[o->chose_law], &o->choice, o->fit)
                 : sn_fit(&def, o->fit);
    if (status != SN_OK) return status;
    o->fitted = true;
    if (o->chose)
        *(o->chose_law ? &def.law_terms : &def.terms) = o->choice.trial[o->choice.best].terms;
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

static int run_request(const fit_request *request, const cli_arguments *arguments) {
    fit_outcome *outcome = sn_alloc(1, sizeof *outcome);
    if (!outcome) return cli_fail(SN_E_MEMORY);
    outcome->bulk_ratio = request->bulk_ratio;
    outcome->has_held_out = request->hold_out;
    outcome->data = sn_alloc(1, sizeof *outcome->data);
    outcome->fit = sn_alloc(1, sizeof *outcome->fit);
    outcome->held_out = sn_alloc(SN_FIT_CURVES_MAX, sizeof *outcome->held_out);
    int code = outcome->data && outcome->fit && outcome->held_out
                   ? work(request, arguments, outcome)
                   : cli_fail(SN_E_MEMORY);
    if (outcome->fitted) sn_fit_release(outcome->fit);
    if (outcome->data) release_data(outcome->data);
    for (int k = 0; outcome->held_out && k < SN_FIT_CURVES_MAX; k++) {
        sn_free(outcome->held_out[k].prediction.predicted);
        sn_free(outcome->held_out[k].prediction.predicted_2);
    }
    sn_free(outcome->held_out);
    sn_free(outcome->fit);
    sn_free(outcome->data);
    sn_free(outcome);
    return code;
}

static int run(const cli_command *command, int argc, char **argv) {
    fit_request request = {.terms = "3",
                           .law_terms = "1",
                           .weights = "plain",
                           .seed = 1,
                           .density = NAN,
                           .from = -INFINITY,
                           .to = INFINITY};
    const cli_option options[] = {
        {"elastic", CLI_TEXT, "LAW", NULL, &request.elastic, "exponential, linear, demiray, …"},
        {"memory", CLI_TEXT, "LAW", NULL, &request.memory,
         "fung-spectrum, prony, kelvin, maxwell, voigt, none"},
        {"terms", CLI_TEXT, "N|auto[:N]", NULL, &request.terms,
         "exponentials of --memory prony; auto: 1 to 6 (or N), by AICc"},
        {"law-terms", CLI_TEXT, "N|auto[:N]", NULL, &request.law_terms,
         "terms of --elastic ogden; auto: 1 to 3 (or N), by AICc"},
        {"fix", CLI_LIST, "NAME=VALUE", NULL, &request.fixed,
         "holds a constant, e.g. tau1=\"1 ms\"; may be repeated"},
        {"from", CLI_QUANTITY, "TIME", "s", &request.from,
         "earlier rows move the model but are not fitted"},
        {"to", CLI_QUANTITY, "TIME", "s", &request.to, "later rows are not fitted"},
        {"weights", CLI_TEXT, "NAME", NULL, &request.weights,
         "of the curves: plain (1), peak (1/peak squared), noise (1/variance)"},
        {"weight", CLI_LIST, "FILE=W", NULL, &request.weight,
         "multiplies one curve's squares; may be repeated"},
        {"bootstrap", CLI_INTEGER, "N", NULL, &request.bootstrap,
         "95 % intervals from N refits as well (at least 40; 1000 is usual)"},
        {"seed", CLI_INTEGER, "N", NULL, &request.seed, "of the search and the bootstrap"},
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
    int code = cli_parse(command, argc, argv, options, (int)(sizeof options / sizeof *options),
                         &arguments);
    if (code >= 0) return code;
    if (arguments.count < 1) return cli_refuse("fit: no curve given; see sinew fit --help");
    if (arguments.count > SN_FIT_CURVES_MAX)
        return cli_refuse("fit: %d curves given, at most %d", arguments.count, SN_FIT_CURVES_MAX);
    if (!request.elastic)
        return cli_refuse("fit: --elastic is missing, e.g. --elastic exponential");
    return run_request(&request, &arguments);
}

const cli_command cli_fit = {
    "fit", "CURVE.csv… --elastic LAW [--memory LAW] [--terms N] [--hold-out] [--out DIR]",
    "measured curves to a tissue, through their recorded histories",
    "sinew fit data/cardiac-muscle/ramp-*.csv --elastic exponential --memory fung-spectrum "
    "--hold-out --out out",
    run};
