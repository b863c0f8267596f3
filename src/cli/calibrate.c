// sinew calibrate: constants of central springs for a mesh and a tissue.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

static const char *const rule_name[] = {"full", "affine", "uniform", "lloyd"}; // as the enum
enum { RULES = 4, CELL = 48 };

/// Virtual tests of one kind, of which the largest error is told.
typedef struct test_kind {
    const char *prefix, *title, *text;
} test_kind;
static const test_kind kinds[] = {
    {"held, ", "surface held", "the surface moved as the continuum's, small strain: stiffness"},
    {"free, ", "free", "under tractions, small strain: stiffness"},
    {"finite, ", "finite", "up to the strain: stress, rms over its largest"}};
#define KINDS ((int)(sizeof kinds / sizeof kinds[0]))

// index of the largest error of a kind; -1 where there is none
static int worst(const sn_calibration_region *r, const char *prefix) {
    int found = -1;
    for (int k = 0; k < r->error_count; k++) {
        if (strncmp(r->error[k].name, prefix, strlen(prefix)) != 0) continue;
        if (!isfinite(r->error[k].error)) continue;
        if (found < 0 || fabs(r->error[k].error) > fabs(r->error[found].error)) found = k;
    }
    return found;
}

static json_t *region_json(const sn_calibration_region *r) {
    json_t *json = json_object(), *errors = json_object();
    cli_put_text(json, "name", r->name);
    cli_put_number(json, "force_residual", r->left[0]);
    cli_put_number(json, "tensor_residual", r->left[1]);
    cli_put_number(json, "scale", r->scale);
    cli_put_number(json, "strain", r->strain);
    cli_put_number(json, "exponent", r->exponent);
    json_t *squares = json_array();
    for (int k = 0; k < SN_SPRING_SQUARES; k++)
        json_array_append_new(squares, json_real(r->square[k]));
    cli_put(json, "squares", squares);
    cli_put_number(json, "factor", r->factor);
    for (int k = 0; k < r->error_count; k++)
        cli_put_number(errors, r->error[k].name, r->error[k].error);
    cli_put(json, "errors", errors);
    json_t *most = json_object();
    for (int k = 0; k < KINDS; k++) {
        const int w = worst(r, kinds[k].prefix);
        if (w >= 0) cli_put_text(most, kinds[k].title, r->error[w].name);
    }
    cli_put(json, "worst", most);
    return json;
}

static json_t *calibration_json(const sn_case *c, const sn_calibration *r) {
    json_t *json = json_object(), *regions = json_array();
    cli_put_text(json, "case", c->name);
    cli_put_text(json, "rule", rule_name[r->rule]);
    cli_put_integer(json, "nodes", c->mesh->node_count);
    cli_put_integer(json, "cells", c->mesh->cell_count);
    cli_put_integer(json, "springs", r->springs);
    cli_put_integer(json, "springs_beyond_edges", r->beyond);
    for (int k = 0; k < r->region_count; k++)
        json_array_append_new(regions, region_json(&r->region[k]));
    cli_put(json, "regions", regions);
    return json;
}

//---- text ----------------------------------------------------------------------------------------

static void print_region(const sn_calibration_region *r) {
    const double *q = r->square;
    printf("  %s: exponent %.4g, squares %.4g %.4g %.4g in tension, %.4g in compression, up to a "
           "strain of %.3g",
           r->name, r->exponent, q[0], q[1], q[2], q[6], r->strain);
    if (r->scale != 1 || r->factor != 1)
        printf("; common scale %.4f, factor with the law %.4f", r->scale, r->factor);
    printf("\n");
    if (isfinite(r->left[0]))
        printf("    nodal forces that no springs give: %.3g %% (even strains), %.3g %% (linear)\n",
               100 * r->left[0], 100 * r->left[1]);
    for (int k = 0; k < KINDS; k++) {
        const int w = worst(r, kinds[k].prefix);
        if (w < 0) continue;
        printf("    %-13s %+8.3g %%  %s (%s)\n", kinds[k].title, 100 * r->error[w].error,
               r->error[w].name + strlen(kinds[k].prefix), kinds[k].text);
    }
}

static void print_calibration(const sn_case *c, const sn_calibration *r) {
    printf("%s: %d nodes, %d springs (%d beyond the edges of the mesh), rule %s\n", c->name,
           c->mesh->node_count, r->springs, r->beyond, rule_name[r->rule]);
    printf("  what stays, by the deformation that carries most of it:\n");
    for (int k = 0; k < r->region_count; k++) print_region(&r->region[k]);
}

//---- page ----------------------------------------------------------------------------------------

static void region_table(sn_report *report, const sn_calibration_region *r) {
    char text[SN_CALIBRATION_ERRORS_MAX + 1][2][CELL];
    const char *cells[2 * (SN_CALIBRATION_ERRORS_MAX + 1)];
    snprintf(text[0][0], CELL, "virtual test");
    snprintf(text[0][1], CELL, "error [%%]");
    for (int k = 0; k < r->error_count; k++) {
        const double error = 100 * r->error[k].error;
        char number[CELL];
        snprintf(number, sizeof number, "%+.3g", error);
        snprintf(text[k + 1][0], CELL, "%s", r->error[k].name);
        snprintf(text[k + 1][1], CELL, "%s",
                 !isfinite(error)     ? "not found"
                 : fabs(error) < 1e-6 ? "0"
                                      : number);
    }
    for (int k = 0; k < 2 * (r->error_count + 1); k++) cells[k] = text[k / 2][k % 2];
    sn_report_table(
        report, r->error_count + 1, 2, cells,
        "Held: stiffness at small strain over the continuum's, less 1, with the surface "
        "moved as the continuum's. Free: the same under tractions. Finite: rms of the "
        "stress up to the strain, over its largest. Small strains are measured before "
        "the factor of the law.");
}

static void region_page(sn_report *report, const sn_calibration_region *r) {
    sn_report_heading(report, r->name);
    sn_report_text(report,
                   "Law of the springs: exponent %.5g, squares %.5g %.5g %.5g along x y z in "
                   "tension and %.5g in compression, with a factor of %.5g on all stiffnesses, for "
                   "strains up to %.3g; common scale %.5g.",
                   r->exponent, r->square[0], r->square[1], r->square[2], r->square[6], r->factor,
                   r->strain, r->scale);
    if (isfinite(r->left[0]))
        sn_report_text(report,
                       "Of the nodal forces that a continuum answers even strains with, %.3g %% "
                       "cannot be met by these springs whatever their stiffness; of those of "
                       "linearly growing strains, which hold the elastic tensor, %.3g %%.",
                       100 * r->left[0], 100 * r->left[1]);
    for (int k = 0; k < KINDS; k++) {
        const int w = worst(r, kinds[k].prefix);
        if (w >= 0)
            sn_report_text(report, "Most of what stays (%s): %s, %+.3g %%.", kinds[k].text,
                           r->error[w].name, 100 * r->error[w].error);
    }
    region_table(report, r);
}

static sn_status write_report(const char *path, const sn_case *c, const sn_calibration *r) {
    char title[SN_TEXT_MAX + 32];
    sn_report *report;
    snprintf(title, sizeof title, "%s: calibrated springs", c->name);
    SN_TRY(sn_report_create(title, &report));
    sn_report_text(report,
                   "Rule %s: %d springs on %d nodes, %d of them beyond the edges of the mesh. Use "
                   "them in a case with springs: {model: central, constants: springs.csv}.",
                   rule_name[r->rule], r->springs, c->mesh->node_count, r->beyond);
    for (int k = 0; k < r->region_count; k++) region_page(report, &r->region[k]);
    sn_status status = sn_report_write(report, path);
    sn_report_destroy(report);
    return status;
}

//---- the command ---------------------------------------------------------------------------------

typedef struct calibrate_options {
    const char *folder, *rule;
    double strain;
} calibrate_options;

static sn_status write_folder(const char *folder, const sn_case *c, const sn_calibration *r,
                              const json_t *json) {
    char file[4096], comment[SN_TEXT_MAX + 64];
    SN_TRY(sn_folder_make(folder));
    SN_TRY(cli_write_json(folder, "calibration.json", json));
    snprintf(comment, sizeof comment, "%s: central springs by rule %s", c->name,
             rule_name[r->rule]);
    for (char *s = comment; *s; s++)
        if ((unsigned char)*s < 0x20) *s = ' ';
    SN_TRY(sn_springs_write(cli_path(file, sizeof file, folder, "springs.csv"), c->mesh, r->set,
                            comment));
    return write_report(cli_path(file, sizeof file, folder, "report.html"), c, r);
}

static sn_status calibrate(const char *path, const calibrate_options *o, sn_calibration_rule rule,
                           const cli_arguments *arguments) {
    sn_case *c = NULL;
    sn_calibration r = {0};
    json_t *json = NULL;
    cli_progress progress = cli_progress_start(arguments);
    const sn_output output = {.context = &progress, .progress = cli_progress_show};
    sn_status status;
    SN_TRY_GOTO(status, sn_case_read(path, &c));
    status = sn_calibrate_to(c, rule, o->strain, &output, &r);
    cli_progress_end(&progress);
    if (status != SN_OK) {
        status = sn_fail_within(status, "%s", path);
        goto fail;
    }
    json = calibration_json(c, &r);
    if (o->folder) SN_TRY_GOTO(status, write_folder(o->folder, c, &r, json));
    if (arguments->json) {
        cli_print_json(json_incref(json));
    } else if (!arguments->quiet) {
        print_calibration(c, &r);
        if (o->folder)
            printf("  results in %s (springs.csv, calibration.json, report.html)\n", o->folder);
    }
fail:
    json_decref(json);
    sn_calibration_destroy(&r);
    sn_case_destroy(c);
    return status;
}

static int run(const cli_command *command, int argc, char **argv) {
    calibrate_options o = {.rule = "full"};
    const cli_option options[] = {
        {"rule", CLI_TEXT, "RULE", NULL, &o.rule,
         "full (the best these springs can do), affine (what a net takes by itself), uniform, "
         "lloyd (published rules)"},
        {"strain", CLI_QUANTITY, "STRAIN", "1", &o.strain,
         "|stretch - 1| up to which the law of the springs is fitted; 0: what the case comes to in "
         "a quick run"},
        {"out", CLI_TEXT, "DIR", NULL, &o.folder,
         "writes springs.csv, calibration.json and report.html there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 3, &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("calibrate: expected one case file, got %d", arguments.count);
    int rule = 0;
    while (rule < RULES && strcmp(o.rule, rule_name[rule]) != 0) rule++;
    if (rule == RULES) return cli_unknown("rule", o.rule, rule_name, RULES);
    sn_status status = calibrate(arguments.item[0], &o, (sn_calibration_rule)rule, &arguments);
    return status == SN_OK ? CLI_DONE : cli_fail(status);
}

const cli_command cli_calibrate = {
    "calibrate", "CASE.yaml [--rule full|affine|uniform|lloyd] [--strain STRAIN] [--out DIR]",
    "constants of central springs, as near to the continuum as they come",
    "sinew calibrate examples/muscle/indentation.yaml --out out", run};
