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

// the value of a column that is farthest from rest
static double peak_of(const sn_record *record, const sn_series *series) {
    double rest = strncmp(series->name, "stretch", 7) == 0 ? 1 : 0, peak = rest;
    for (int i = 0; i < record->rows; i++)
        if (fabs(series->value[i] - rest) > fabs(peak - rest)) peak = series->value[i];
    return peak;
}

// what a test moves and measures has a peak; its clock and its count of cycles have none
static bool has_peak(const sn_series *series) {
    return strcmp(series->name, "time") != 0 && strcmp(series->name, "cycle") != 0;
}

// the memory as exponentials over the test, with the error that this costs
static json_t *exponentials_json(const sn_memory *memory, double duration) {
    sn_exponentials e;
    bool done = sn_memory_compress(memory, 1e-4 * duration, duration, 1e-3, &e) == SN_OK;
    return done ? cli_exponentials(&e) : json_null();
}

// of every part of the stress where these have a memory each
static json_t *memory_json(const sn_tissue *tissue, double duration) {
    static const char *const parts[SN_PARTS] = {"deviatoric", "volumetric", "fibre"};
    if (!tissue->branched) return exponentials_json(&tissue->memory, duration);
    json_t *json = json_object();
    for (int k = 0; k < SN_PARTS; k++)
        if (k != SN_PART_FIBRE || tissue->law->fibre_constant)
            cli_put(json, parts[k],
                    exponentials_json(sn_tissue_memory(tissue, (sn_part)k), duration));
    return json;
}

static json_t *test_json(const sn_tissue *tissue, const sn_record *record,
                         const sn_fit_curve *prediction) {
    double duration = sn_record_values(record, "time")[record->rows - 1];
    json_t *json = json_object();
    cli_put_text(json, "tissue", tissue->name);
    cli_put_integer(json, "points", record->rows);
    for (int k = 0; k < record->series_count; k++) {
        const sn_series *series = &record->series[k];
        if (!has_peak(series)) continue;
        char key[2 * SN_NAME_MAX];
        snprintf(key, sizeof key, "peak_%s%s", series->name,
                 strcmp(series->unit, "Pa") == 0 ? "_Pa" : "");
        cli_put_number(json, key, peak_of(record, series));
    }
    cli_put_number(json, "duration_s", duration);
    cli_put(json, "memory", memory_json(tissue, duration));
    if (prediction) {
        cli_put_number(json, "rmse_Pa", prediction->rmse);
        cli_put_number(json, "rmse_over_peak", prediction->rmse / prediction->peak);
        cli_put_number(json, "r_squared", prediction->r_squared);
    }
    return json;
}

//---- what a test shows ---------------------------------------------------------------------------

// one row of a sweep as text and as JSON
static void sweep_row(const sn_record *record, sn_protocol_kind kind, int i, json_t *rows) {
    double frequency = sn_record_values(record, "frequency")[i];
    if (kind == SN_PROTOCOL_HYSTERESIS) {
        double H = sn_record_values(record, "hysteresis")[i];
        if (!rows) {
            printf("  %12s %12s %12.6f\n", cli_show(frequency, "Hz"),
                   cli_show(0.5 / frequency, "s"), H);
            return;
        }
        json_t *row = json_object();
        cli_put_number(row, "frequency_Hz", frequency);
        cli_put_number(row, "ramp_s", 0.5 / frequency);
        cli_put_number(row, "hysteresis", H);
        json_array_append_new(rows, row);
        return;
    }
    double storage = sn_record_values(record, "storage_modulus")[i];
    double loss = sn_record_values(record, "loss_modulus")[i];
    if (!rows) {
        printf("  %12s %14s %14s %12.6f\n", cli_show(frequency, "Hz"), cli_show(storage, "Pa"),
               cli_show(loss, "Pa"), loss / storage);
        return;
    }
    json_t *row = json_object();
    cli_put_number(row, "frequency_Hz", frequency);
    cli_put_number(row, "storage_modulus_Pa", storage);
    cli_put_number(row, "loss_modulus_Pa", loss);
    cli_put_number(row, "tan_delta", loss / storage);
    json_array_append_new(rows, row);
}

static void show_sweep(const sn_tissue *tissue, const sn_record *record, sn_protocol_kind kind,
                       const cli_arguments *arguments) {
    if (arguments->json) {
        json_t *json = json_object(), *rows = json_array();
        cli_put_text(json, "tissue", tissue->name);
        cli_put_integer(json, "points", record->rows);
        for (int i = 0; i < record->rows; i++) sweep_row(record, kind, i, rows);
        cli_put(json, "sweep", rows);
        cli_print_json(json);
        return;
    }
    printf("tissue \"%s\": %d speeds\n", tissue->name, record->rows);
    if (kind == SN_PROTOCOL_HYSTERESIS)
        printf("  %12s %12s %12s\n", "frequency", "ramp", "hysteresis");
    else
        printf("  %12s %14s %14s %12s\n", "frequency", "storage", "loss", "tan delta");
    for (int i = 0; i < record->rows; i++) sweep_row(record, kind, i, NULL);
}

static void show_motion(const sn_tissue *tissue, const sn_record *record,
                        const sn_fit_curve *prediction, const cli_arguments *arguments) {
    if (arguments->json) {
        cli_print_json(test_json(tissue, record, prediction));
        return;
    }
    double duration = sn_record_values(record, "time")[record->rows - 1];
    printf("tissue \"%s\": %d points over %s", tissue->name, record->rows, cli_show(duration, "s"));
    for (int k = 0; k < record->series_count; k++) {
        const sn_series *series = &record->series[k];
        if (has_peak(series))
            printf(", peak %s %s", series->name, cli_show(peak_of(record, series), series->unit));
    }
    printf("\n");
    if (prediction)
        printf("  against the measured curve: rms error %s, %.2f %% of its peak, R2 %.4f\n",
               cli_show(prediction->rmse, "Pa"), 100 * prediction->rmse / prediction->peak,
               prediction->r_squared);
}

// `kind` is looked at where there is no prediction
static int finish(const cli_arguments *arguments, const sn_tissue *tissue, sn_record *record,
                  sn_protocol_kind kind, const sn_fit_curve *prediction, const char *out) {
    char source[SN_TEXT_MAX];
    snprintf(source, sizeof source, "sinew test of tissue \"%s\"", tissue->name);
    sn_status status = sn_record_add_note(record, "source", source, NAN);
    if (status == SN_OK && out) status = sn_curve_write(out, record, true);
    if (status != SN_OK) return cli_fail(status);
    if (arguments->quiet && !arguments->json) return CLI_DONE;
    if (!prediction && sn_record_find(record, "frequency") >= 0)
        show_sweep(tissue, record, kind, arguments);
    else
        show_motion(tissue, record, prediction, arguments);
    if (out && !arguments->json) printf("  curve written to %s\n", out);
    return CLI_DONE;
}

//---- the command ---------------------------------------------------------------------------------

enum {
    STRETCH,
    STRETCH_1,
    STRETCH_2,
    SHEAR,
    STRESS,
    RAMP,
    RATE,
    HOLD,
    RECOVERY,
    FROM,
    TO,
    CYCLES,
    POINTS,
    WISHES
};

// a parameter of a protocol as the user gave it; one of the three is set where it was given
typedef struct wish {
    const char *name;
    double number;    // else NAN
    int whole;        // else 0
    const char *text; // its unit depends on the protocol; else NULL
} wish;

// the value of a wish in the unit of the protocol's table
static sn_status value_of(const wish *w, const sn_param *table, int params, double *value) {
    *value = w->whole ? (double)w->whole : w->number;
    int k = sn_param_find(table, params, w->name);
    if (!w->text || k < 0) return SN_OK;
    sn_status status = sn_quantity_parse(w->text, table[k].unit, value);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "--%s", w->name);
}

static int wave_of(const char *name, sn_protocol *p) {
    static const char *const names[] = {[SN_WAVE_TRIANGLE] = "triangle", [SN_WAVE_SINE] = "sine"};
    for (int k = 0; k < 2; k++) {
        if (strcmp(name, names[k]) != 0) continue;
        p->wave = (sn_wave)k;
        return -1;
    }
    return cli_unknown("wave", name, names, 2);
}

// the wishes put over the defaults of the protocol
static sn_status protocol_of(const char *name, const wish *wishes, int count, sn_protocol *p) {
    sn_protocol_kind kind;
    if (!sn_protocol_find(name, &kind)) return SN_E_NAME;
    *p = sn_protocol_default(kind);
    int params;
    const sn_param *table = sn_protocol_params(kind, &params);
    for (const wish *w = wishes; w < wishes + count; w++) {
        double value;
        if (isnan(w->number) && !w->whole && !w->text) continue;
        SN_TRY(value_of(w, table, params, &value));
        SN_TRY(sn_protocol_set(p, w->name, value));
    }
    // a default ramp gives way to a rate
    if (!isnan(wishes[RATE].number) && isnan(wishes[RAMP].number)) p->ramp = 0;
    return SN_OK;
}

static int run(const cli_command *command, int argc, char **argv) {
    const char *protocol = NULL, *wave = NULL, *out = NULL, *replayed = NULL;
    wish w[WISHES] = {
        [STRETCH].name = "stretch",     [STRESS].name = "stress", [STRETCH_1].name = "stretch-1",
        [STRETCH_2].name = "stretch-2", [SHEAR].name = "shear",   [RECOVERY].name = "recovery",
        [RAMP].name = "ramp",           [RATE].name = "rate",     [HOLD].name = "hold",
        [FROM].name = "from",           [TO].name = "to",         [CYCLES].name = "cycles",
        [POINTS].name = "points"};
    for (int k = 0; k < WISHES; k++) w[k].number = NAN;
    const cli_option options[] = {
        {"protocol", CLI_TEXT, "NAME", NULL, &protocol,
         "tensile, cyclic, creep, relaxation, biaxial, shear, dynamic or hysteresis"},
        {"replay", CLI_TEXT, "CURVE.csv", NULL, &replayed,
         "applies the recorded stretch of a measured curve instead"},
        {"stretch", CLI_QUANTITY, "STRETCH", "1", &w[STRETCH].number,
         "target stretch, e.g. 1.2; mean stretch (dynamic)"},
        {"stretch-1", CLI_QUANTITY, "STRETCH", "1", &w[STRETCH_1].number,
         "target along the first axis (biaxial)"},
        {"stretch-2", CLI_QUANTITY, "STRETCH", "1", &w[STRETCH_2].number,
         "target along the second axis (biaxial)"},
        {"shear", CLI_QUANTITY, "STRAIN", "1", &w[SHEAR].number, "target shear strain (shear)"},
        {"stress", CLI_QUANTITY, "STRESS", "Pa", &w[STRESS].number,
         "nominal stress (creep), e.g. \"2 kPa\""},
        {"ramp", CLI_QUANTITY, "TIME", "s", &w[RAMP].number, "time of the ramp, e.g. \"100 ms\""},
        {"rate", CLI_QUANTITY, "RATE", "1/s", &w[RATE].number, "stretch rate, instead of --ramp"},
        {"hold", CLI_QUANTITY, "TIME", "s", &w[HOLD].number,
         "time at the target (relaxation) or under the stress (creep)"},
        {"recovery", CLI_QUANTITY, "TIME", "s", &w[RECOVERY].number,
         "time after unloading (creep)"},
        {"cycles", CLI_INTEGER, "N", NULL, &w[CYCLES].whole, "number of cycles (cyclic)"},
        {"wave", CLI_TEXT, "NAME", NULL, &wave, "triangle or sine (cyclic)"},
        {"from", CLI_TEXT, "TIME|FREQUENCY", NULL, &w[FROM].text,
         "start of a sweep: ramp time (hysteresis) or frequency (dynamic)"},
        {"to", CLI_TEXT, "TIME|FREQUENCY", NULL, &w[TO].text, "end of a sweep"},
        {"points", CLI_INTEGER, "N", NULL, &w[POINTS].whole, "rows of the curve"},
        {"out", CLI_TEXT, "CURVE.csv", NULL, &out, "writes the curve there"},
    };
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, options, (int)(sizeof options / sizeof *options),
                         &arguments);
    if (code >= 0) return code;
    if (arguments.count != 1)
        return cli_refuse("test: expected one tissue file, got %d", arguments.count);
    if (!protocol == !replayed) return cli_refuse("test: expected either --protocol or --replay");
    sn_protocol p = {0};
    sn_status status = protocol ? protocol_of(protocol, w, WISHES, &p) : SN_OK;
    if (status != SN_OK) return cli_fail(status);
    if (wave && (code = wave_of(wave, &p)) >= 0) return code;
    sn_tissue tissue;
    status = sn_tissue_read(arguments.item[0], &tissue);
    if (status != SN_OK) return cli_fail(status);

    sn_record *record = NULL;
    sn_fit_curve prediction = {0};
    status = replayed ? replay(&tissue, replayed, &record, &prediction)
                      : sn_lab_test(&tissue, &p, &record);
    code = status == SN_OK
               ? finish(&arguments, &tissue, record, p.kind, replayed ? &prediction : NULL, out)
               : cli_fail(status);
    sn_free(prediction.predicted);
    sn_record_destroy(record);
    return code;
}

const cli_command cli_test = {
    "test", "TISSUE.yaml --protocol NAME | --replay CURVE.csv [--out CURVE.csv]",
    "the virtual testing machine: what a tissue would show in a test",
    "sinew test examples/muscle/muscle.yaml --protocol relaxation --stretch 1.2 --ramp \"0.1 s\" "
    "--hold \"300 s\" --out relaxation.csv",
    run};
