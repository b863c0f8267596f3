// sinew analyze: a measured curve to properties.
// SPDX-License-Identifier: Apache-2.0
#include "cli/analyze.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void analyze_say(analysis *a, const char *what, const char *value, const char *remark) {
    if (a->quiet) return;
    // nothing is printed before the reduction has succeeded
    if (!a->headed) printf("%s: %s test, %d rows\n", a->path, a->test, a->rows);
    a->headed = true;
    printf("  %-34s %s%s%s\n", what, value, *remark ? "   " : "", remark);
}

void analyze_present(analysis *a, const char *caption, int count, const finding *f) {
    const char *cells[(FINDINGS_MAX + 1) * 3];
    int n = 0, columns = 2;
    SN_ASSERT(count <= FINDINGS_MAX);
    for (int i = 0; i < count; i++) {
        analyze_say(a, f[i].what, f[i].value, f[i].remark ? f[i].remark : "");
        if (f[i].remark && *f[i].remark) columns = 3;
    }
    if (!a->report) return;
    cells[n++] = "property", cells[n++] = "value";
    if (columns == 3) cells[n++] = "remark";
    for (int i = 0; i < count; i++) {
        cells[n++] = f[i].what, cells[n++] = f[i].value;
        if (columns == 3) cells[n++] = f[i].remark ? f[i].remark : "";
    }
    sn_report_table(a->report, count + 1, columns, cells, caption);
}

void analyze_discard(analysis *a, int rows, const char *remarks) {
    a->discarded = rows;
    snprintf(a->remarks, sizeof a->remarks, "%s", remarks);
    if (*a->remarks) analyze_say(a, "rows", a->remarks, "");
    if (a->report && *a->remarks) sn_report_text(a->report, "Rows: %s.", a->remarks);
}

void analyze_stress_plot(sn_report *report, const char *title, const char *x_label, bool log_x,
                         int lines, const sn_line *line) {
    sn_report_plot(report, &(sn_plot){.title = title,
                                      .x_label = x_label,
                                      .y_label = "nominal stress [kPa]",
                                      .y_scale = 1e-3,
                                      .log_x = log_x,
                                      .line_count = lines,
                                      .line = line});
}

//---- the command ---------------------------------------------------------------------------------

typedef struct test_method {
    const char *name;
    sn_status (*analyze)(const sn_curve *curve, analysis *a);
    sn_status (*sweep)(const sn_record *record, analysis *a); // NULL: takes no sweep over frequency
} test_method;

static const test_method methods[] = {
    {"tensile", analyze_tensile, NULL},
    {"cyclic", analyze_cyclic, NULL},
    {"creep", analyze_creep, NULL},
    {"relaxation", analyze_relaxation, NULL},
    {"dynamic", analyze_sinusoids, analyze_sweep},
    {"biaxial", analyze_biaxial, NULL},
};

#define METHODS ((int)(sizeof methods / sizeof methods[0]))

/// The options as they came.
typedef struct analyze_options {
    const char *test, *folder, *preload, *window;
    int ramp;
} analyze_options;

static sn_status write_results(const char *folder, analysis *a) {
    char path[4096];
    SN_TRY(sn_folder_make(folder));
    SN_TRY(cli_write_json(folder, "analysis.json", a->json));
    return sn_report_write(a->report, cli_path(path, sizeof path, folder, "report.html"));
}

// a stress, or a force over the area of the record
static sn_status read_preload(const char *text, const sn_record *record, double *preload) {
    double force;
    if (sn_quantity_parse(text, "N", &force) == SN_OK) {
        const sn_note *area = sn_record_note(record, "area");
        if (!area || !(area->value > 0.0))
            return sn_fail(
                SN_E_DATA,
                "%s: --preload %s is a force and needs a remark \"# area: ...\" with its "
                "unit: add it, or give a stress",
                record->name, text);
        *preload = force / area->value;
    } else {
        sn_status status = sn_quantity_parse(text, "Pa", preload);
        if (status != SN_OK) return sn_fail_within(status, "--preload");
    }
    if (isfinite(*preload) && *preload > 0.0) return SN_OK;
    return sn_fail(SN_E_RANGE, "--preload: found %s, expected a force or a stress above 0", text);
}

static sn_status read_window(const char *text, sn_tensile_def *def) {
    char *end;
    def->from = strtod(text, &end);
    bool good = end != text && *end == ',';
    if (good) {
        const char *second = end + 1;
        def->to = strtod(second, &end);
        good = end != second && !*end && isfinite(def->from) && isfinite(def->to) &&
               def->to > def->from;
    }
    if (good) return SN_OK;
    return sn_fail(SN_E_SYNTAX,
                   "--window: found \"%s\", expected two rising strains with a comma, such as "
                   "0.02,0.05",
                   text);
}

// what was done to the data, and how many rows were not used
static void put_data(const sn_curve *curve, analysis *a) {
    json_t *remarks = json_array();
    if (*curve->remarks) json_array_append_new(remarks, json_string(curve->remarks));
    if (*a->remarks) json_array_append_new(remarks, json_string(a->remarks));
    cli_put_integer(a->json, "rows", a->rows + curve->discarded);
    cli_put_integer(a->json, "discarded", a->discarded + curve->discarded);
    cli_put(a->json, "remarks", remarks);
    if (*curve->remarks) analyze_say(a, "data", curve->remarks, "");
}

static sn_status reduce(const sn_record *record, const test_method *method, const char *folder,
                        analysis *a) {
    sn_curve curve = {0};
    bool sweep = method->sweep && sn_record_find(record, "frequency") >= 0;
    sn_status status = SN_OK;
    if (!sweep) status = sn_curve_from_record(record, &curve);
    if (status == SN_OK && folder) {
        char title[SN_TEXT_MAX];
        snprintf(title, sizeof title, "%s: %s test", cli_basename(a->path), method->name);
        status = sn_report_create(title, &a->report);
    }
    if (status == SN_OK) {
        a->rows = sweep ? record->rows : curve.count;
        if (a->report)
            sn_report_text(a->report, "Data: %s. %s%s", a->path, curve.remarks,
                           *curve.remarks ? "." : "");
        status = sweep ? method->sweep(record, a) : method->analyze(&curve, a);
    }
    if (status == SN_OK) put_data(&curve, a);
    if (status == SN_OK && folder) status = write_results(folder, a);
    sn_curve_release(&curve);
    sn_report_destroy(a->report);
    return status;
}

static sn_status analyze(const analyze_options *o, const test_method *method, analysis *a) {
    sn_record *record = NULL;
    sn_status status;
    a->def = sn_tensile_def_default();
    a->def.ramp = o->ramp;
    SN_TRY_GOTO(status, sn_curve_read(a->path, &record));
    if (o->preload) SN_TRY_GOTO(status, read_preload(o->preload, record, &a->def.preload));
    if (o->window) SN_TRY_GOTO(status, read_window(o->window, &a->def));
    status = reduce(record, method, o->folder, a);
fail:
    sn_record_destroy(record);
    return status;
}

static int run_method(const analyze_options *o, const test_method *method,
                      const cli_arguments *arguments) {
    bool tensile = method->analyze == analyze_tensile;
    if (!tensile && (o->preload || o->window || o->ramp))
        return cli_refuse("analyze: --%s belongs to --test tensile, not to %s",
                          o->preload  ? "preload"
                          : o->window ? "window"
                                      : "ramp",
                          method->name);
    analysis a = {.path = arguments->item[0],
                  .test = method->name,
                  .quiet = arguments->json || arguments->quiet};
    sn_status status = analyze(o, method, &a);
    if (status == SN_OK && arguments->json)
        cli_print_json(a.json);
    else
        json_decref(a.json);
    return status == SN_OK ? CLI_DONE : cli_fail(status);
}

static int run(const cli_command *command, int argc, char **argv) {
    analyze_options o = {0};
    const cli_option options[] = {
        {"test", CLI_TEXT, "METHOD", NULL, &o.test,
         "tensile, cyclic, creep, relaxation, dynamic or biaxial"},
        {"preload", CLI_TEXT, "QUANTITY", NULL, &o.preload,
         "tensile: the strain is 0 where the curve reaches this force or stress"},
        {"window", CLI_TEXT, "LO,HI", NULL, &o.window,
         "tensile: strains between which the modulus is taken"},
        {"ramp", CLI_INTEGER, "N", NULL, &o.ramp,
         "tensile: which loading ramp (default: the last full one)"},
        {"out", CLI_TEXT, "DIR", NULL, &o.folder, "writes analysis.json and report.html there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, (int)(sizeof options / sizeof options[0]),
                         &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("analyze: expected one curve, got %d", arguments.count);
    if (!o.test)
        return cli_refuse(
            "analyze: --test is missing: tensile, cyclic, creep, relaxation, dynamic or biaxial");
    const char *names[METHODS];
    for (int k = 0; k < METHODS; k++) {
        names[k] = methods[k].name;
        if (strcmp(o.test, names[k]) == 0) return run_method(&o, &methods[k], &arguments);
    }
    return cli_unknown("test", o.test, names, METHODS);
}

const cli_command cli_analyze = {
    "analyze", "CURVE.csv --test tensile|cyclic|creep|relaxation|dynamic|biaxial [--out DIR]",
    "properties of a measured curve: moduli, yield, strength, hysteresis, creep, relaxation, tan "
    "delta",
    "sinew analyze data/cardiac-muscle/ramp-1s.csv --test relaxation", run};
