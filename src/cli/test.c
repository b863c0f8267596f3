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
    bool done = sn_memory_compress(&tissue->memory, 1e-4 * duration, duration, 1e-3, &e) == SN_OK;
    return done ? cli_exponentials(&e) : json_null();
}

static json_t *test_json(const sn_tissue *tissue, const sn_record *record,
                         const sn_fit_curve *prediction) {
    double duration = sn_record_values(record, "time")[record->rows - 1];
    json_t *json = json_object();
    cli_put_text(json, "tissue", tissue->name);
    cli_put_integer(json, "points", record->rows);
    cli_put_number(json, "peak_stress_Pa", peak_of(record));
    cli_put_number(json, "duration_s", duration);
    cli_put(json, "memory", memory_json(tissue, duration));
    if (prediction) {
        cli_put_number(json, "rmse_Pa", prediction->rmse);
        cli_put_number(json, "rmse_over_peak", prediction->rmse / prediction->peak);
        cli_put_number(json, "r_squared", prediction->r_squared);
    }
    return json;
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
        cli_print_json(test_json(tissue, record, prediction));
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
