// sinew analyze --test dynamic: moduli over frequency, from a sweep or from raw sinusoids.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/analyze.h"

enum { ROWS_MAX = 60, LOOPS_MAX = 8 };

static json_t *dynamic_json(const sn_dynamic *r, bool raw) {
    json_t *json = json_object(), *sweep = json_array();
    for (int k = 0; k < r->count; k++) {
        const sn_oscillation *o = &r->at[k];
        json_t *row = json_object();
        cli_put_number(row, "frequency_Hz", o->frequency);
        cli_put_number(row, "storage_modulus_Pa", o->storage_modulus);
        cli_put_number(row, "loss_modulus_Pa", o->loss_modulus);
        cli_put_number(row, "tan_delta", o->tan_delta);
        cli_put_number(row, "phase_rad", o->phase);
        if (raw) {
            cli_put_number(row, "storage_modulus_error_Pa", o->storage_error);
            cli_put_number(row, "loss_modulus_error_Pa", o->loss_error);
            cli_put_number(row, "mean_stretch", o->mean_stretch);
            cli_put_number(row, "stretch_amplitude", o->stretch_amplitude);
            cli_put_number(row, "mean_stress_Pa", o->mean_stress);
            cli_put_number(row, "stress_amplitude_Pa", o->stress_amplitude);
            cli_put_number(row, "harmonic_distortion", o->harmonic_distortion);
            cli_put_number(row, "cycles", o->cycles);
        }
        json_array_append_new(sweep, row);
    }
    cli_put(json, "sweep", sweep);
    cli_put_number(json, "storage_power_law", r->storage_per_decade);
    cli_put_number(json, "loss_power_law", r->loss_per_decade);
    cli_put_number(json, "low_plateau_modulus_Pa", r->low_plateau);
    if (*r->low_reason) cli_put_text(json, "low_plateau_reason", r->low_reason);
    cli_put_number(json, "high_plateau_modulus_Pa", r->high_plateau);
    if (*r->high_reason) cli_put_text(json, "high_plateau_reason", r->high_reason);
    cli_put_number(json, "peak_tan_delta", r->peak_tan_delta);
    cli_put_number(json, "peak_tan_delta_frequency_Hz", r->peak_frequency);
    if (*r->peak_reason) cli_put_text(json, "peak_tan_delta_reason", r->peak_reason);
    return json;
}

// the table of frequencies, on standard output and the page
static void moduli_table(const sn_dynamic *r, bool raw, analysis *a) {
    enum { COLUMNS = 6, WIDTH = 64 };
    char text[ROWS_MAX * COLUMNS][WIDTH];
    const char *cells[(ROWS_MAX + 1) * COLUMNS] = {"frequency", "storage modulus", "loss modulus",
                                                   "tan δ",     "stretch",         "distortion"};
    int columns = raw ? COLUMNS : 4, shown = r->count < ROWS_MAX ? r->count : ROWS_MAX;
    for (int k = 4; k < columns; k++) cells[k] = k == 4 ? "stretch" : "harmonic distortion";
    for (int i = 0; i < shown; i++) {
        const sn_oscillation *o = &r->at[i];
        char(*row)[WIDTH] = text + (size_t)i * COLUMNS;
        snprintf(row[0], WIDTH, "%.4g Hz", o->frequency);
        snprintf(row[1], WIDTH, "%s", cli_show(o->storage_modulus, "Pa"));
        snprintf(row[2], WIDTH, "%s", cli_show(o->loss_modulus, "Pa"));
        snprintf(row[3], WIDTH, "%.4f", o->tan_delta);
        snprintf(row[4], WIDTH, "%.4f ± %.4g", o->mean_stretch, o->stretch_amplitude);
        snprintf(row[5], WIDTH, isfinite(o->harmonic_distortion) ? "%.2f %%" : "—",
                 100.0 * o->harmonic_distortion);
        for (int k = 0; k < columns; k++) cells[(i + 1) * columns + k] = row[k];
        char value[4 * WIDTH];
        snprintf(value, sizeof value, "E′ %s, E″ %s, tan δ %s%s%s", row[1], row[2], row[3],
                 raw ? ", distortion " : "", raw ? row[5] : "");
        analyze_say(a, row[0], value, "");
    }
    if (a->report)
        sn_report_table(a->report, shown + 1, columns, cells,
                        shown < r->count ? "The first frequencies; all are in analysis.json"
                                         : "Moduli");
}

static sn_status frequency_plots(const sn_dynamic *r, sn_report *report) {
    if (r->count < 2) return SN_OK;
    size_t n = (size_t)r->count;
    double *x = sn_alloc(4 * n, sizeof *x);
    if (!x) return SN_E_MEMORY;
    for (size_t k = 0; k < n; k++) {
        x[k] = r->at[k].frequency;
        x[n + k] = r->at[k].storage_modulus;
        x[2 * n + k] = r->at[k].loss_modulus;
        x[3 * n + k] = r->at[k].tan_delta;
    }
    sn_line moduli[] = {{"storage modulus E′", SN_LINE_POINTS, 0, r->count, x, x + n},
                        {"loss modulus E″", SN_LINE_POINTS, 1, r->count, x, x + 2 * n}};
    sn_report_plot(report, &(sn_plot){.title = "Storage and loss modulus",
                                      .x_label = "frequency [Hz]",
                                      .y_label = "modulus [kPa]",
                                      .y_scale = 1e-3,
                                      .log_x = true,
                                      .log_y = true,
                                      .line_count = 2,
                                      .line = moduli});
    double peak_f = r->peak_frequency, peak = r->peak_tan_delta;
    sn_line loss[] = {{"tan δ", SN_LINE_POINTS, 2, r->count, x, x + 3 * n},
                      {"peak", SN_POINTS, 3, 1, &peak_f, &peak}};
    sn_report_plot(report, &(sn_plot){.title = "Loss tangent",
                                      .x_label = "frequency [Hz]",
                                      .y_label = "tan δ [1]",
                                      .log_x = true,
                                      .line_count = isfinite(peak) ? 2 : 1,
                                      .line = loss});
    sn_free(x);
    return SN_OK;
}

static void present(const sn_dynamic *r, bool raw, analysis *a) {
    char storage[32], loss[32], peak[96];
    moduli_table(r, raw, a);
    snprintf(storage, sizeof storage, isfinite(r->storage_per_decade) ? "%.3f" : "—",
             r->storage_per_decade);
    snprintf(loss, sizeof loss, isfinite(r->loss_per_decade) ? "%.3f" : "—", r->loss_per_decade);
    snprintf(peak, sizeof peak, isfinite(r->peak_tan_delta) ? "%.4f at %.4g Hz" : "—",
             r->peak_tan_delta, r->peak_frequency);
    const finding found[] = {
        {"power law of the storage modulus", storage, "d log E′ / d log frequency"},
        {"power law of the loss modulus", loss, "d log E″ / d log frequency"},
        {"plateau at low frequency", cli_show(r->low_plateau, "Pa"), r->low_reason},
        {"plateau at high frequency", cli_show(r->high_plateau, "Pa"), r->high_reason},
        {"peak of tan δ", peak, r->peak_reason},
    };
    PRESENT(a, "Over frequency", found);
    analyze_discard(a, r->discarded, r->remarks);
}

// one cycle of every part: the last
static void loops(const sn_curve *curve, const sn_dynamic *r, sn_report *report) {
    sn_line line[LOOPS_MAX];
    char label[LOOPS_MAX][64];
    int shown = r->count < LOOPS_MAX ? r->count : LOOPS_MAX;
    for (int i = 0; i < shown; i++) {
        int k = shown > 1 ? (int)((long)i * (r->count - 1) / (shown - 1)) : 0;
        const sn_oscillation *o = &r->at[k];
        int first = o->last;
        double period = 1.0 / o->frequency;
        while (first > o->first && curve->time[o->last] - curve->time[first] < period) --first;
        snprintf(label[i], sizeof label[i], "%.4g Hz", o->frequency);
        line[i] = (sn_line){label[i],
                            SN_LINE,
                            i,
                            o->last - first + 1,
                            curve->stretch + first,
                            curve->stress + first};
    }
    analyze_stress_plot(report, "Loops (last cycle of each frequency)", "stretch [1]", false, shown,
                        line);
}

sn_status analyze_sweep(const sn_record *record, analysis *a) {
    sn_dynamic r;
    SN_TRY(sn_reduce_sweep(record, &r));
    a->json = dynamic_json(&r, false);
    present(&r, false, a);
    sn_status status = a->report ? frequency_plots(&r, a->report) : SN_OK;
    sn_dynamic_release(&r);
    return status;
}

sn_status analyze_sinusoids(const sn_curve *curve, analysis *a) {
    sn_dynamic r;
    SN_TRY(sn_reduce_oscillation(curve, &r));
    a->json = dynamic_json(&r, true);
    present(&r, true, a);
    sn_status status = a->report ? frequency_plots(&r, a->report) : SN_OK;
    if (status == SN_OK && a->report) loops(curve, &r, a->report);
    sn_dynamic_release(&r);
    return status;
}
