// sinew test: the virtual testing machine.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"

// the measured curve's own stretch history applied to the tissue, stress at its own times
static sn_status replay(const sn_tissue *tissue, const char *path, sn_record **record,
                        sn_fit_curve *prediction) {
    sn_record *measured = NULL;
    sn_curve curve = {0};
    sn_status status;
    SN_TRY_GOTO(status, sn_curve_read(path, &measured));
    SN_TRY_GOTO(status, sn_curve_from_record(measured, &curve));
    SN_TRY_GOTO(status, sn_fit_predict(tissue, &curve, prediction));
    SN_TRY_GOTO(status, sn_record_create(path, record));
    SN_TRY_GOTO(status, sn_record_add_series(*record, "time", "s"));
    SN_TRY_GOTO(status, sn_record_add_series(*record, "stretch", "1"));
    SN_TRY_GOTO(status, sn_record_add_series(*record, "stress", "Pa"));
    for (int i = 0; i < curve.count; i++)
        SN_TRY_GOTO(status, sn_record_append(*record, (double[]){curve.time[i], curve.stretch[i],
                                                                 prediction->predicted[i]}));
fail:
    if (status != SN_OK) status = sn_fail_within(status, "%s", path);
    sn_curve_release(&curve);
    sn_record_destroy(measured);
    return status;
}

static double peak_of(const sn_record *record) {
    const double *stress = sn_record_values(record, "stress");
    double peak = 0;
    for (int i = 0; i < record->rows; i++)
        if (fabs(stress[i]) > fabs(peak)) peak = stress[i];
    return peak;
}

// the memory as exponentials over the test, with the error that this costs
static json_t *memory_json(const sn_tissue *tissue, double duration) {
    sn_exponentials e;
    if (sn_memory_compress(&tissue->memory, 1e-4 * duration, duration, 1e-3, &e) != SN_OK)
        return json_null();
    return json_pack("{s:i, s:o, s:o, s:o, s:o, s:[f,f]}", "terms", e.terms, "max_error",
                     cli_number(e.max_error), "g_infinity", cli_number(e.g_inf), "g",
                     cli_numbers(e.terms, e.g), "tau_s", cli_numbers(e.terms, e.tau), "band_s",
                     e.t_min, e.t_max);
}

static int finish(const cli_arguments *arguments, const sn_tissue *tissue, sn_record *record,
                  const sn_fit_curve *prediction, const char *out) {
    char source[SN_TEXT_MAX];
    snprintf(source, sizeof source, "sinew test of tissue \"%s\"", tissue->name);
    sn_status status = sn_record_add_note(record, "source", source, NAN);
    if (status == SN_OK && out) status = sn_curve_write(out, record, true);
    if (status != SN_OK) return cli_fail(status);
    double duration = sn_record_values(record, "time")[record->rows - 1];
    if (arguments->json) {
        json_t *json =
            json_pack("{s:s, s:i, s:o, s:o, s:o}", "tissue", tissue->name, "points", record->rows,
                      "peak_stress_Pa", cli_number(peak_of(record)), "duration_s",
                      cli_number(duration), "memory", memory_json(tissue, duration));
        if (prediction)
            json_object_update_new(json, json_pack("{s:o, s:o, s:o}", "rmse_Pa",
                                                   cli_number(prediction->rmse), "rmse_over_peak",
                                                   cli_number(prediction->rmse / prediction->peak),
                                                   "r_squared", cli_number(prediction->r_squared)));
        cli_print_json(json);
    } else if (!arguments->quiet) {
        printf("tissue \"%s\": %d points over %s, peak stress %s\n", tissue->name, record->rows,
               cli_show(duration, "s"), cli_show(peak_of(record), "Pa"));
        if (prediction)
            printf("  against the measured curve: rms error %s, %.2f %% of its peak, R2 %.4f\n",
                   cli_show(prediction->rmse, "Pa"), 100 * prediction->rmse / prediction->peak,
                   prediction->r_squared);
        if (out) printf("  curve written to %s\n", out);
    }
    return CLI_DONE;
}

static int run(const cli_command *command, int argc, char **argv) {
    const char *protocol_name = NULL, *out = NULL, *replayed = NULL;
    sn_protocol p = {.stretch = NAN, .ramp = NAN, .rate = NAN, .hold = NAN};
    const cli_option options[] = {
        {"protocol", CLI_TEXT, "NAME", NULL, &protocol_name, "tensile, cyclic or relaxation"},
        {"replay", CLI_TEXT, "CURVE.csv", NULL, &replayed,
         "applies the recorded stretch of a measured curve instead"},
        {"stretch", CLI_QUANTITY, "STRETCH", "1", &p.stretch, "target stretch, e.g. 1.2"},
        {"ramp", CLI_QUANTITY, "TIME", "s", &p.ramp, "time of the ramp, e.g. \"100 ms\""},
        {"rate", CLI_QUANTITY, "RATE", "1/s", &p.rate, "stretch rate, instead of --ramp"},
        {"hold", CLI_QUANTITY, "TIME", "s", &p.hold, "time at the target (relaxation)"},
        {"cycles", CLI_INTEGER, "N", NULL, &p.cycles, "number of cycles (cyclic)"},
        {"points", CLI_INTEGER, "N", NULL, &p.points, "rows of the curve"},
        {"out", CLI_TEXT, "CURVE.csv", NULL, &out, "writes the curve there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, 9, &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("test: expected one tissue file, got %d", arguments.count);
    if (!protocol_name == !replayed)
        return cli_refuse("test: expected either --protocol or --replay");
    sn_tissue tissue;
    sn_status status = sn_tissue_read(arguments.item[0], &tissue);
    if (status != SN_OK) return cli_fail(status);

    sn_record *record = NULL;
    sn_fit_curve prediction = {0};
    if (replayed) {
        status = replay(&tissue, replayed, &record, &prediction);
    } else {
        sn_protocol_kind kind;
        if (!sn_protocol_find(protocol_name, &kind)) return cli_fail(SN_E_NAME);
        sn_protocol full = sn_protocol_default(kind);
        if (!isnan(p.stretch)) full.stretch = p.stretch;
        if (!isnan(p.rate)) full.rate = p.rate, full.ramp = 0;
        if (!isnan(p.ramp)) full.ramp = p.ramp;
        if (!isnan(p.hold)) full.hold = p.hold;
        if (p.cycles) full.cycles = p.cycles;
        if (p.points) full.points = p.points;
        status = sn_lab_test(&tissue, &full, &record);
    }
    code = status == SN_OK ? finish(&arguments, &tissue, record, replayed ? &prediction : NULL, out)
                           : cli_fail(status);
    sn_free(prediction.predicted);
    sn_record_destroy(record);
    return code;
}

const cli_command cli_test = {
    "test",
    "TISSUE.yaml --protocol tensile|cyclic|relaxation | --replay CURVE.csv [--out CURVE.csv]",
    "the virtual testing machine: what a tissue would show in a test",
    "sinew test examples/muscle/muscle.yaml --protocol relaxation --stretch 1.2 --ramp \"0.1 s\" "
    "--hold \"300 s\" --out relaxation.csv",
    run};
