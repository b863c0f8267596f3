// sinew analyze: a measured curve to properties.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

typedef struct analysis {
    const char *path, *test;
    int rows;
    bool headed; ///< the heading has been printed
    json_t *json;
    sn_report *report; ///< NULL without --out
    bool quiet;        ///< nothing on standard output but JSON
} analysis;

static void say(analysis *a, const char *what, const char *value, const char *remark) {
    if (a->quiet) return;
    // nothing is printed before the reduction has succeeded
    if (!a->headed) printf("%s: %s test, %d rows\n", a->path, a->test, a->rows);
    a->headed = true;
    printf("  %-34s %s%s%s\n", what, value, *remark ? "   " : "", remark);
}

/// One line of a result: on standard output and in the table of the page.
typedef struct finding {
    const char *what, *value;
    const char *remark; ///< Nullable
} finding;

#define FINDINGS_MAX 12

static void present(analysis *a, const char *caption, int count, const finding *f) {
    const char *cells[(FINDINGS_MAX + 1) * 3];
    int n = 0, columns = 2;
    SN_ASSERT(count <= FINDINGS_MAX);
    for (int i = 0; i < count; i++) {
        say(a, f[i].what, f[i].value, f[i].remark ? f[i].remark : "");
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

#define PRESENT(a, caption, findings)                                                              \
    present(a, caption, (int)(sizeof(findings) / sizeof(findings)[0]), findings)

static void stress_plot(sn_report *report, const char *title, int lines, const sn_line *line) {
    sn_report_plot(report, &(sn_plot){.title = title,
                                      .x_label = "stretch [1]",
                                      .y_label = "nominal stress [kPa]",
                                      .y_scale = 1e-3,
                                      .line_count = lines,
                                      .line = line});
}

//---- tensile -------------------------------------------------------------------------------------

static json_t *tensile_json(const sn_tensile *r) {
    json_t *json = json_object(), *slope = json_object();
    cli_put_number(json, "youngs_modulus_Pa", r->youngs_modulus);
    cli_put_text(json, "modulus_method", r->modulus_method);
    cli_put_number(json, "toe_modulus_Pa", r->toe_modulus);
    cli_put_number(json, "max_slope_modulus_Pa", r->max_slope_modulus);
    cli_put_number(json, "yield_stress_Pa", r->yield_stress);
    cli_put_number(json, "yield_strain", r->yield_strain);
    if (*r->reason) cli_put_text(json, "reason", r->reason);
    cli_put_number(json, "ultimate_tensile_strength_Pa", r->ultimate_tensile_strength);
    cli_put_number(json, "strain_at_ultimate", r->strain_at_ultimate);
    cli_put_number(json, "work_to_failure_J_per_m3", r->work_to_failure);
    cli_put_number(slope, "B", r->B);
    cli_put_number(slope, "C_Pa", r->C);
    cli_put_number(slope, "r_squared", r->slope_r_squared);
    cli_put(json, "slope_stress", slope);
    return json;
}

static sn_status analyze_tensile(const sn_curve *curve, analysis *a) {
    sn_tensile r;
    SN_TRY(sn_reduce_tensile(curve, &r));
    a->json = tensile_json(&r);
    char work[64], slope[128], squared[64];
    snprintf(work, sizeof work, "%.4g J/m3", r.work_to_failure);
    snprintf(slope, sizeof slope, "B = %.4g, C = %s", r.B, cli_show(r.C, "Pa"));
    snprintf(squared, sizeof squared, "R2 of the line %.4f", r.slope_r_squared);
    const finding found[] = {
        {"Young's modulus", cli_show(r.youngs_modulus, "Pa"), r.modulus_method},
        {"toe modulus", cli_show(r.toe_modulus, "Pa"), NULL},
        {"largest slope", cli_show(r.max_slope_modulus, "Pa"), NULL},
        {"yield stress, 0.2 % offset", cli_show(r.yield_stress, "Pa"), r.reason},
        {"ultimate tensile strength", cli_show(r.ultimate_tensile_strength, "Pa"), NULL},
        {"strain at ultimate", cli_show(r.strain_at_ultimate, "1"), NULL},
        {"work to failure", work, NULL},
        {"slope against stress (13)", slope, squared},
    };
    PRESENT(a, "Tension", found);
    if (!a->report) return SN_OK;
    int n = r.window_last - r.window_first + 1;
    sn_line lines[] = {{"measured", SN_LINE_POINTS, 0, curve->count, curve->stretch, curve->stress},
                       {"window of the modulus", SN_LINE, 1, n, curve->stretch + r.window_first,
                        curve->stress + r.window_first}};
    stress_plot(a->report, "Stress against stretch", 2, lines);
    return SN_OK;
}

//---- cyclic --------------------------------------------------------------------------------------

static sn_status analyze_cyclic(const sn_curve *curve, analysis *a) {
    sn_cycles r;
    SN_TRY(sn_reduce_cyclic(curve, &r));
    if (*r.remarks) say(a, "data", r.remarks, "");
    json_t *cycles = json_array();
    for (int i = 0; i < r.count; i++) {
        const sn_cycle *c = &r.cycle[i];
        json_t *row = json_object();
        cli_put_number(row, "hysteresis", c->hysteresis);
        cli_put_number(row, "loading_area_J_per_m3", c->loading_area);
        cli_put_number(row, "loop_area_J_per_m3", c->loop_area);
        cli_put_number(row, "peak_stress_Pa", c->peak_stress);
        json_array_append_new(cycles, row);
        char what[32], value[160];
        snprintf(what, sizeof what, "cycle %d", i + 1);
        snprintf(value, sizeof value, "hysteresis %.4f, peak %s", c->hysteresis,
                 cli_show(c->peak_stress, "Pa"));
        say(a, what, value, "");
    }
    a->json = json_object();
    cli_put(a->json, "cycles", cycles);
    cli_put_text(a->json, "definition",
                 "hysteresis = loop area / area under the loading curve, nominal stress");
    if (a->report) {
        sn_line line = {"measured", SN_LINE, 0, curve->count, curve->stretch, curve->stress};
        stress_plot(a->report, "Cycles", 1, &line);
        for (int i = 0; i < r.count; i++)
            sn_report_text(a->report,
                           "Cycle %d: hysteresis %.4f (loop area %.4g J/m3 over loading area "
                           "%.4g J/m3), peak stress %s.",
                           i + 1, r.cycle[i].hysteresis, r.cycle[i].loop_area,
                           r.cycle[i].loading_area, cli_show(r.cycle[i].peak_stress, "Pa"));
    }
    sn_cycles_release(&r);
    return SN_OK;
}

//---- relaxation ----------------------------------------------------------------------------------

static sn_status analyze_relaxation(const sn_curve *curve, analysis *a) {
    sn_relaxation_result r;
    SN_TRY(sn_reduce_relaxation(curve, &r));
    a->json = json_object();
    cli_put_number(a->json, "peak_stress_Pa", r.peak_stress);
    cli_put_number(a->json, "relaxed_fraction", r.relaxed_fraction);
    cli_put_number(a->json, "rate_per_decade", r.rate_per_decade);
    cli_put_number(a->json, "ramp_s", r.ramp_s);
    cli_put_number(a->json, "final_stress_Pa", r.final_stress);
    char fraction[32], rate[32];
    snprintf(fraction, sizeof fraction, "%.1f %%", 100 * r.relaxed_fraction);
    snprintf(rate, sizeof rate, "%.1f %%", 100 * r.rate_per_decade);
    const finding found[] = {
        {"ramp", cli_show(r.ramp_s, "s"), NULL},
        {"peak stress", cli_show(r.peak_stress, "Pa"), NULL},
        {"final stress", cli_show(r.final_stress, "Pa"), NULL},
        {"relaxed fraction", fraction, "of the peak"},
        {"relaxation per decade of time", rate, "of the peak"},
    };
    PRESENT(a, "Relaxation", found);
    if (!a->report) return SN_OK;
    sn_line line = {"measured", SN_LINE_POINTS, 0, curve->count, curve->time, curve->stress};
    sn_report_plot(a->report, &(sn_plot){.title = "Stress over time",
                                         .x_label = "time [s]",
                                         .y_label = "nominal stress [kPa]",
                                         .y_scale = 1e-3,
                                         .log_x = true,
                                         .line_count = 1,
                                         .line = &line});
    stress_plot(
        a->report, "Stress against stretch", 1,
        &(sn_line){"measured", SN_LINE_POINTS, 0, curve->count, curve->stretch, curve->stress});
    return SN_OK;
}

//---- creep ---------------------------------------------------------------------------------------

static void creep_plot(const sn_curve *curve, sn_report *report) {
    sn_line line = {"measured", SN_LINE_POINTS, 0, curve->count, curve->time, curve->stretch};
    sn_report_plot(report, &(sn_plot){.title = "Stretch over time",
                                      .x_label = "time [s]",
                                      .y_label = "stretch [1]",
                                      .line_count = 1,
                                      .line = &line});
    line.y = curve->stress;
    sn_report_plot(report, &(sn_plot){.title = "Stress over time",
                                      .x_label = "time [s]",
                                      .y_label = "nominal stress [kPa]",
                                      .y_scale = 1e-3,
                                      .line_count = 1,
                                      .line = &line});
}

static sn_status analyze_creep(const sn_curve *curve, analysis *a) {
    sn_creep_result r;
    SN_TRY(sn_reduce_creep(curve, &r));
    a->json = json_object();
    cli_put_number(a->json, "compliance_per_Pa", r.compliance);
    cli_put_number(a->json, "initial_compliance_per_Pa", r.initial_compliance);
    cli_put_number(a->json, "creep_rate_per_s", r.creep_rate);
    cli_put_number(a->json, "time_to_rupture_s", r.time_to_rupture);
    cli_put_number(a->json, "recovered_fraction", r.recovered_fraction);
    cli_put_number(a->json, "stress_Pa", r.stress);
    cli_put_number(a->json, "ramp_s", r.ramp_s);
    cli_put_number(a->json, "hold_s", r.hold_s);
    char initial[64], compliance[64], rate[64], recovered[64] = "—";
    snprintf(initial, sizeof initial, "%.4g 1/Pa", r.initial_compliance);
    snprintf(compliance, sizeof compliance, "%.4g 1/Pa", r.compliance);
    snprintf(rate, sizeof rate, "%.4g 1/s", r.creep_rate);
    if (isfinite(r.recovered_fraction))
        snprintf(recovered, sizeof recovered, "%.1f %%", 100 * r.recovered_fraction);
    const finding found[] = {
        {"held stress", cli_show(r.stress, "Pa"), NULL},
        {"loading", cli_show(r.ramp_s, "s"), NULL},
        {"hold", cli_show(r.hold_s, "s"), NULL},
        {"compliance, start of the hold", initial, NULL},
        {"compliance, end of the hold", compliance, NULL},
        {"creep rate, smallest", rate, NULL},
        {"time to rupture", cli_show(r.time_to_rupture, "s"), NULL},
        {"recovered, of the strain", recovered, NULL},
    };
    PRESENT(a, "Creep", found);
    if (!a->report) return SN_OK;
    creep_plot(curve, a->report);
    return SN_OK;
}

//---- biaxial -------------------------------------------------------------------------------------

static json_t *biaxial_json(const sn_biaxial_result *r) {
    static const char *const keys[2][4] = {
        {"peak_stretch_1", "peak_stress_1_Pa", "low_modulus_1_Pa", "high_modulus_1_Pa"},
        {"peak_stretch_2", "peak_stress_2_Pa", "low_modulus_2_Pa", "high_modulus_2_Pa"}};
    json_t *json = json_object();
    for (int k = 0; k < 2; k++) {
        cli_put_number(json, keys[k][0], r->axis[k].peak_stretch);
        cli_put_number(json, keys[k][1], r->axis[k].peak_stress);
        cli_put_number(json, keys[k][2], r->axis[k].low_modulus);
        cli_put_number(json, keys[k][3], r->axis[k].high_modulus);
    }
    cli_put_number(json, "stress_ratio", r->stress_ratio);
    cli_put_number(json, "stretch_ratio", r->stretch_ratio);
    cli_put_number(json, "anisotropy", r->anisotropy);
    cli_put_number(json, "strain_energy_J_per_m3", r->energy);
    return json;
}

static sn_status analyze_biaxial(const sn_curve *curve, analysis *a) {
    sn_biaxial_result r;
    SN_TRY(sn_reduce_biaxial(curve, &r));
    a->json = biaxial_json(&r);
    char stretches[64], stresses[64], index[32], energy[64];
    snprintf(stretches, sizeof stretches, "at stretches %.4g and %.4g", r.axis[0].peak_stretch,
             r.axis[1].peak_stretch);
    snprintf(stresses, sizeof stresses, "strains %s", cli_show(r.stretch_ratio, "1"));
    snprintf(index, sizeof index, "%.3f", r.anisotropy);
    snprintf(energy, sizeof energy, "%.4g J/m3", r.energy);
    const finding found[] = {
        {"peak stress, axis 1", cli_show(r.axis[0].peak_stress, "Pa"), stretches},
        {"peak stress, axis 2", cli_show(r.axis[1].peak_stress, "Pa"), NULL},
        {"modulus at low stretch, axis 1", cli_show(r.axis[0].low_modulus, "Pa"), "first fifth"},
        {"modulus at low stretch, axis 2", cli_show(r.axis[1].low_modulus, "Pa"), NULL},
        {"modulus at high stretch, axis 1", cli_show(r.axis[0].high_modulus, "Pa"), "last fifth"},
        {"modulus at high stretch, axis 2", cli_show(r.axis[1].high_modulus, "Pa"), NULL},
        {"ratio 1 to 2 at the peak, stresses", cli_show(r.stress_ratio, "1"), stresses},
        {"anisotropy", index, "above 0: axis 1 is stiffer"},
        {"strain energy at the peak", energy, NULL},
    };
    PRESENT(a, "Biaxial tension", found);
    if (!a->report) return SN_OK;
    const sn_line lines[] = {
        {"axis 1", SN_LINE_POINTS, 0, curve->count, curve->stretch, curve->stress},
        {"axis 2", SN_LINE_POINTS, 1, curve->count, curve->stretch_2, curve->stress_2}};
    stress_plot(a->report, "Stress against stretch, both axes", 2, lines);
    return SN_OK;
}

//---- the command ---------------------------------------------------------------------------------

typedef struct test_method {
    const char *name;
    sn_status (*analyze)(const sn_curve *curve, analysis *a);
} test_method;

static const test_method methods[] = {
    {"tensile", analyze_tensile},       {"cyclic", analyze_cyclic},   {"creep", analyze_creep},
    {"relaxation", analyze_relaxation}, {"biaxial", analyze_biaxial},
};

#define METHODS ((int)(sizeof methods / sizeof methods[0]))

static sn_status write_results(const char *folder, analysis *a) {
    char path[4096];
    SN_TRY(sn_folder_make(folder));
    SN_TRY(cli_write_json(folder, "analysis.json", a->json));
    return sn_report_write(a->report, cli_path(path, sizeof path, folder, "report.html"));
}

static sn_status analyze(const char *path, const test_method *method, const char *folder,
                         analysis *a) {
    sn_record *record = NULL;
    sn_curve curve = {0};
    sn_status status;
    SN_TRY_GOTO(status, sn_curve_read(path, &record));
    status = sn_curve_from_record(record, &curve);
    if (status == SN_OK && folder) {
        char title[SN_TEXT_MAX];
        snprintf(title, sizeof title, "%s: %s test", cli_basename(path), method->name);
        status = sn_report_create(title, &a->report);
    }
    if (status == SN_OK) {
        a->rows = curve.count;
        if (a->report) sn_report_text(a->report, "Data: %s. %s", path, curve.remarks);
        status = method->analyze(&curve, a);
        if (status == SN_OK && *curve.remarks) say(a, "data", curve.remarks, "");
    }
    if (status == SN_OK && folder) status = write_results(folder, a);
fail:
    sn_curve_release(&curve);
    sn_record_destroy(record);
    sn_report_destroy(a->report);
    return status;
}

static int run(const cli_command *command, int argc, char **argv) {
    const char *test = NULL, *folder = NULL;
    const cli_option options[] = {
        {"test", CLI_TEXT, "METHOD", NULL, &test, "tensile, cyclic, creep, relaxation or biaxial"},
        {"out", CLI_TEXT, "DIR", NULL, &folder, "writes analysis.json and report.html there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 2, &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("analyze: expected one curve, got %d", arguments.count);
    if (!test)
        return cli_refuse(
            "analyze: --test is missing: tensile, cyclic, creep, relaxation or biaxial");
    const char *names[METHODS];
    for (int k = 0; k < METHODS; k++) {
        names[k] = methods[k].name;
        if (strcmp(test, names[k]) != 0) continue;
        analysis a = {
            .path = arguments.item[0], .test = test, .quiet = arguments.json || arguments.quiet};
        sn_status status = analyze(arguments.item[0], &methods[k], folder, &a);
        if (status != SN_OK) {
            json_decref(a.json);
            return cli_fail(status);
        }
        if (arguments.json)
            cli_print_json(a.json);
        else
            json_decref(a.json);
        return CLI_DONE;
    }
    return cli_unknown("test", test, names, METHODS);
}

const cli_command cli_analyze = {
    "analyze", "CURVE.csv --test tensile|cyclic|creep|relaxation|biaxial [--out DIR]",
    "properties of a measured curve: moduli, yield, strength, hysteresis, creep, relaxation",
    "sinew analyze data/cardiac-muscle/ramp-1s.csv --test relaxation", run};
