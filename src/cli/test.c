// sinew test: the virtual testing machine.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/test.h"

// the measured curve's own stretch history applied to the tissue, stress at its own times
static sn_status replay(const char *path, test_outcome *o) {
    sn_record *measured = NULL;
    sn_curve *curve = &o->measured;
    sn_status status;
    SN_TRY_GOTO(status, sn_curve_read(path, &measured));
    SN_TRY_GOTO(status, sn_curve_from_record(measured, curve));
    SN_TRY_GOTO(status, sn_curve_expect(curve, SN_CURVE_UNIAXIAL, "--replay"));
    if (!curve->time)
        SN_TRY_GOTO(status, sn_fail(SN_E_DATA, "%s: no time column: --replay needs one", path));
    SN_TRY_GOTO(status, sn_fit_predict(o->tissue, curve, &o->prediction));
    SN_TRY_GOTO(status, sn_record_create(path, &o->record));
    SN_TRY_GOTO(status, sn_record_add_series(o->record, "time", "s"));
    SN_TRY_GOTO(status, sn_record_add_series(o->record, "stretch", "1"));
    SN_TRY_GOTO(status, sn_record_add_series(o->record, "stress", "Pa"));
    for (int i = 0; i < curve->count; i++)
        SN_TRY_GOTO(status,
                    sn_record_append(o->record, (double[]){curve->time[i], curve->stretch[i],
                                                           o->prediction.predicted[i]}));
fail:
    sn_record_destroy(measured);
    return status;
}

// the cycles of a cyclic test; too few rows to tell them apart leave none
static void split_cycles(test_outcome *o) {
    sn_curve curve = {0};
    if (!test_is(o, SN_PROTOCOL_CYCLIC)) return;
    if (sn_curve_from_record(o->record, &curve) != SN_OK ||
        sn_reduce_cyclic(&curve, &o->cycles) != SN_OK)
        o->cycles = (sn_cycles){0};
    sn_curve_release(&curve);
}

bool test_is(const test_outcome *o, sn_protocol_kind kind) {
    return !o->replayed && o->protocol.kind == kind;
}

const char *test_part(const sn_tissue *tissue, sn_part part) {
    static const char *const names[SN_PARTS] = {"deviatoric", "volumetric", "fibre"};
    bool has = tissue->branched ? part != SN_PART_FIBRE || tissue->law->fibre_constant
                                : part == SN_PART_DEVIATORIC;
    return has ? names[part] : NULL;
}

bool test_memory(const test_outcome *o, sn_part part, sn_exponentials *e) {
    const double two_pi = 6.28318530717958647693, *time = sn_record_values(o->record, "time");
    double from = o->protocol.from, to = o->protocol.to;
    double shortest = 0.1 * fmin(from, to), longest = 10 * fmax(from, to);
    if (time) {
        double duration = time[o->record->rows - 1];
        shortest = 1e-4 * duration, longest = duration;
    } else if (test_is(o, SN_PROTOCOL_DYNAMIC)) {
        shortest = 0.1 / (two_pi * fmax(from, to)), longest = 10 / (two_pi * fmin(from, to));
    }
    return sn_memory_compress(sn_tissue_memory(o->tissue, part), shortest, longest, 1e-3, e) ==
           SN_OK;
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

// last peak over the one before, less 1; NAN where there is none
static double peak_change(const sn_cycles *c) {
    if (c->count < 2) return (double)NAN;
    return c->cycle[c->count - 1].peak_stress / c->cycle[c->count - 2].peak_stress - 1;
}

static json_t *cycles_json(const test_outcome *o) {
    json_t *rows = json_array();
    for (int i = 0; i < o->cycles.count; i++) {
        json_t *row = json_object();
        cli_put_integer(row, "cycle", o->protocol.precondition + i + 1);
        cli_put_number(row, "peak_stress_Pa", o->cycles.cycle[i].peak_stress);
        cli_put_number(row, "hysteresis", o->cycles.cycle[i].hysteresis);
        json_array_append_new(rows, row);
    }
    return rows;
}

// of every part of the stress where these have a memory each
static json_t *memory_json(const test_outcome *o) {
    json_t *json = json_object();
    sn_exponentials e;
    for (int k = 0; k < SN_PARTS; k++) {
        const char *name = test_part(o->tissue, (sn_part)k);
        if (!name) continue;
        json_t *value = test_memory(o, (sn_part)k, &e) ? cli_exponentials(&e) : json_null();
        if (!o->tissue->branched) {
            json_decref(json);
            return value;
        }
        cli_put(json, name, value);
    }
    return json;
}

static json_t *test_json(const test_outcome *o) {
    const sn_record *record = o->record;
    json_t *json = json_object();
    cli_put_text(json, "tissue", o->tissue->name);
    cli_put_integer(json, "points", record->rows);
    for (int k = 0; k < record->series_count; k++) {
        const sn_series *series = &record->series[k];
        if (!has_peak(series)) continue;
        char key[2 * SN_NAME_MAX];
        snprintf(key, sizeof key, "peak_%s%s", series->name,
                 strcmp(series->unit, "Pa") == 0 ? "_Pa" : "");
        cli_put_number(json, key, peak_of(record, series));
    }
    cli_put_number(json, "duration_s", sn_record_values(record, "time")[record->rows - 1]);
    if (test_is(o, SN_PROTOCOL_CYCLIC)) {
        cli_put(json, "cycles", cycles_json(o));
        cli_put_number(json, "peak_change", peak_change(&o->cycles));
    }
    cli_put(json, "memory", memory_json(o));
    if (o->replayed) {
        cli_put_number(json, "rmse_Pa", o->prediction.rmse);
        cli_put_number(json, "rmse_over_peak", o->prediction.rmse / o->prediction.peak);
        cli_put_number(json, "r_squared", o->prediction.r_squared);
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

static void show_sweep(const test_outcome *o, bool as_json) {
    const sn_record *record = o->record;
    sn_protocol_kind kind = o->protocol.kind;
    if (as_json) {
        json_t *json = json_object(), *rows = json_array();
        cli_put_text(json, "tissue", o->tissue->name);
        cli_put_integer(json, "points", record->rows);
        for (int i = 0; i < record->rows; i++) sweep_row(record, kind, i, rows);
        cli_put(json, "sweep", rows);
        cli_print_json(json);
        return;
    }
    printf("tissue \"%s\": %d speeds\n", o->tissue->name, record->rows);
    if (kind == SN_PROTOCOL_HYSTERESIS)
        printf("  %12s %12s %12s\n", "frequency", "ramp", "hysteresis");
    else
        printf("  %12s %14s %14s %12s\n", "frequency", "storage", "loss", "tan delta");
    for (int i = 0; i < record->rows; i++) sweep_row(record, kind, i, NULL);
}

// the peaks as they settle: the first, the last and how much it still moved
static void show_cycles(const test_outcome *o) {
    const sn_cycles *c = &o->cycles;
    if (c->count < 2) return;
    printf("  peak stress %s in cycle %d, %s in cycle %d (%+.3g %% from the one before)\n",
           cli_show(c->cycle[0].peak_stress, "Pa"), o->protocol.precondition + 1,
           cli_show(c->cycle[c->count - 1].peak_stress, "Pa"), o->protocol.precondition + c->count,
           100 * peak_change(c));
}

static void show_motion(const test_outcome *o, bool as_json) {
    const sn_record *record = o->record;
    if (as_json) {
        cli_print_json(test_json(o));
        return;
    }
    double duration = sn_record_values(record, "time")[record->rows - 1];
    printf("tissue \"%s\": %d points over %s", o->tissue->name, record->rows,
           cli_show(duration, "s"));
    for (int k = 0; k < record->series_count; k++) {
        const sn_series *series = &record->series[k];
        if (has_peak(series))
            printf(", peak %s %s", series->name, cli_show(peak_of(record, series), series->unit));
    }
    printf("\n");
    show_cycles(o);
    if (o->replayed)
        printf("  against the measured curve: rms error %s, %.2f %% of its peak, R2 %.4f\n",
               cli_show(o->prediction.rmse, "Pa"), 100 * o->prediction.rmse / o->prediction.peak,
               o->prediction.r_squared);
}

// writes what was asked for and shows the rest
static int finish(const cli_arguments *arguments, const test_outcome *o, const char *out,
                  const char *report) {
    char source[SN_TEXT_MAX];
    snprintf(source, sizeof source, "sinew test of tissue \"%s\"", o->tissue->name);
    sn_status status = sn_record_add_note(o->record, "source", source, (double)NAN);
    if (status == SN_OK && out) status = sn_curve_write(out, o->record, true);
    if (status == SN_OK && report) status = test_report(report, o);
    if (status != SN_OK) return cli_fail(status);
    if (arguments->quiet && !arguments->json) return CLI_DONE;
    if (sn_record_find(o->record, "frequency") >= 0)
        show_sweep(o, arguments->json);
    else
        show_motion(o, arguments->json);
    if (out && !arguments->json) printf("  curve written to %s\n", out);
    if (report && !arguments->json) printf("  page written to %s\n", report);
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
    LOWER,
    PRECONDITION,
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

// what the user asked for
typedef struct asked {
    const char *protocol, *wave, *out, *replayed, *report;
    wish wish[WISHES];
    cli_arguments arguments;
} asked;

static int parse(const cli_command *command, int argc, char **argv, asked *a) {
    static const char *const names[WISHES] = {
        [STRETCH] = "stretch",     [STRESS] = "stress", [STRETCH_1] = "stretch-1",
        [STRETCH_2] = "stretch-2", [SHEAR] = "shear",   [RECOVERY] = "recovery",
        [RAMP] = "ramp",           [RATE] = "rate",     [HOLD] = "hold",
        [FROM] = "from",           [TO] = "to",         [CYCLES] = "cycles",
        [LOWER] = "lower",         [POINTS] = "points", [PRECONDITION] = "precondition"};
    wish *w = a->wish;
    for (int k = 0; k < WISHES; k++) w[k] = (wish){.name = names[k], .number = (double)NAN};
    const cli_option options[] = {
        {"protocol", CLI_TEXT, "NAME", NULL, &a->protocol,
         "tensile, cyclic, creep, relaxation, biaxial, shear, dynamic or hysteresis"},
        {"replay", CLI_TEXT, "CURVE.csv", NULL, &a->replayed,
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
        {"cycles", CLI_INTEGER, "N", NULL, &w[CYCLES].whole, "cycles that are recorded (cyclic)"},
        {"precondition", CLI_INTEGER, "N", NULL, &w[PRECONDITION].whole,
         "cycles before those that are recorded (cyclic)"},
        {"lower", CLI_QUANTITY, "STRETCH", "1", &w[LOWER].number,
         "stretch where cycles start and end, else 1 (cyclic)"},
        {"wave", CLI_TEXT, "NAME", NULL, &a->wave, "triangle or sine (cyclic)"},
        {"from", CLI_TEXT, "TIME|FREQUENCY", NULL, &w[FROM].text,
         "start of a sweep: ramp time (hysteresis) or frequency (dynamic)"},
        {"to", CLI_TEXT, "TIME|FREQUENCY", NULL, &w[TO].text, "end of a sweep"},
        {"points", CLI_INTEGER, "N", NULL, &w[POINTS].whole, "rows of the curve"},
        {"out", CLI_TEXT, "CURVE.csv", NULL, &a->out, "writes the curve there"},
        {"report", CLI_TEXT, "PAGE.html", NULL, &a->report, "writes a page with the plots there"},
    };
    int code = cli_parse(command, argc, argv, options, (int)(sizeof options / sizeof *options),
                         &a->arguments);
    if (code >= 0) return code;
    if (a->arguments.count != 1)
        return cli_refuse("test: expected one tissue file, got %d", a->arguments.count);
    if (!a->protocol == !a->replayed)
        return cli_refuse("test: expected either --protocol or --replay");
    return -1;
}

static int run(const cli_command *command, int argc, char **argv) {
    asked a = {0};
    int code = parse(command, argc, argv, &a);
    if (code >= 0) return code;
    sn_tissue tissue;
    test_outcome o = {.tissue = &tissue, .replayed = a.replayed != NULL};
    sn_status status = a.protocol ? protocol_of(a.protocol, a.wish, WISHES, &o.protocol) : SN_OK;
    if (status != SN_OK) return cli_fail(status);
    if (a.wave && (code = wave_of(a.wave, &o.protocol)) >= 0) return code;
    status = sn_tissue_read(a.arguments.item[0], &tissue);
    if (status != SN_OK) return cli_fail(status);
    status = a.replayed ? replay(a.replayed, &o) : sn_lab_test(&tissue, &o.protocol, &o.record);
    if (status == SN_OK) split_cycles(&o);
    code = status == SN_OK ? finish(&a.arguments, &o, a.out, a.report) : cli_fail(status);
    sn_cycles_release(&o.cycles);
    sn_curve_release(&o.measured);
    sn_free(o.prediction.predicted);
    sn_record_destroy(o.record);
    return code;
}

const cli_command cli_test = {
    "test",
    "TISSUE.yaml --protocol NAME | --replay CURVE.csv [--out CURVE.csv] [--report PAGE.html]",
    "the virtual testing machine: what a tissue would show in a test",
    "sinew test examples/muscle/muscle.yaml --protocol relaxation --stretch 1.2 --ramp \"0.1 s\" "
    "--hold \"300 s\" --out relaxation.csv",
    run};
