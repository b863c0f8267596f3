// The page of sinew test: the plots that papers print of each test, and the tissue's memory.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/test.h"

enum { LINES_MAX = 4, TABLE_ROWS = 40, CELL = 200 };

static const double *column(const test_outcome *o, const char *name) {
    return sn_record_values(o->record, name);
}

static sn_line line_of(const test_outcome *o, const char *label, int colour, const char *x,
                       const char *y) {
    return (sn_line){label, SN_LINE, colour, o->record->rows, column(o, x), column(o, y)};
}

// one line of two columns of the record, stresses in kPa
static void one_line(sn_report *report, const test_outcome *o, const char *title, const char *x,
                     const char *x_label, const char *y, const char *y_label) {
    sn_line line = line_of(o, NULL, 0, x, y);
    bool pascals = strcmp(o->record->series[sn_record_find(o->record, y)].unit, "Pa") == 0;
    sn_report_plot(report, &(sn_plot){.title = title,
                                      .x_label = x_label,
                                      .y_label = y_label,
                                      .y_scale = pascals ? 1e-3 : 0,
                                      .line_count = 1,
                                      .line = &line});
}

static void stress_stretch(sn_report *report, const test_outcome *o) {
    one_line(report, o, "Stress against stretch", "stretch", "stretch [1]", "stress",
             "nominal stress [kPa]");
}

static void stress_time(sn_report *report, const test_outcome *o) {
    one_line(report, o, "Stress over time", "time", "time [s]", "stress", "nominal stress [kPa]");
}

//---- motions along one axis ----------------------------------------------------------------------

static void tensile_plots(sn_report *report, const test_outcome *o) {
    stress_stretch(report, o);
    stress_time(report, o);
}

// the first and the last loop; those between would hide both
static void loops_plot(sn_report *report, const test_outcome *o) {
    const double *stretch = column(o, "stretch"), *stress = column(o, "stress");
    int last = o->cycles.count - 1;
    char label[2][32];
    sn_line line[2];
    for (int k = 0; k < 2; k++) {
        const sn_cycle *c = &o->cycles.cycle[k ? last : 0];
        snprintf(label[k], sizeof label[k], "cycle %d",
                 o->protocol.precondition + (k ? last + 1 : 1));
        line[k] = (sn_line){label[k],           SN_LINE,          k, c->last - c->first + 1,
                            stretch + c->first, stress + c->first};
    }
    sn_report_plot(report, &(sn_plot){.title = "Stress against stretch, first and last cycle",
                                      .x_label = "stretch [1]",
                                      .y_label = "nominal stress [kPa]",
                                      .y_scale = 1e-3,
                                      .line_count = 2,
                                      .line = line});
}

static void cyclic_plots(sn_report *report, const test_outcome *o) {
    if (o->cycles.count < 2) {
        tensile_plots(report, o);
        return;
    }
    loops_plot(report, o);
    stress_time(report, o);
    size_t n = (size_t)o->cycles.count;
    double *number = sn_alloc(3 * n, sizeof *number), *peak = number + n, *H = peak + n;
    if (!number) return; // sn_report_write reports the shortage that follows
    for (size_t i = 0; i < n; i++) {
        number[i] = (double)i + 1 + o->protocol.precondition;
        peak[i] = o->cycles.cycle[i].peak_stress;
        H[i] = o->cycles.cycle[i].hysteresis;
    }
    sn_line line = {NULL, SN_LINE_POINTS, 0, (int)n, number, peak};
    sn_report_plot(report, &(sn_plot){.title = "Peak stress of every cycle",
                                      .x_label = "cycle [1]",
                                      .y_label = "peak nominal stress [kPa]",
                                      .y_scale = 1e-3,
                                      .line_count = 1,
                                      .line = &line});
    line.y = H;
    sn_report_plot(report, &(sn_plot){.title = "Hysteresis of every cycle",
                                      .x_label = "cycle [1]",
                                      .y_label = "H [1]",
                                      .caption = "Loop area over area under the loading curve.",
                                      .line_count = 1,
                                      .line = &line});
    sn_free(number);
}

// rows from the first after time `from` to `until`, with times since `from`; returns their number
static int rows_since(const test_outcome *o, double from, double until, double *since, int *first) {
    const double *time = column(o, "time");
    int count = 0;
    for (int i = 0; i < o->record->rows; i++) {
        if (!(time[i] > from * (1 + 1e-12)) || time[i] > until * (1 + 1e-12)) continue;
        if (count == 0) *first = i;
        since[count++] = time[i] - from;
    }
    return count;
}

static void relaxation_plots(sn_report *report, const test_outcome *o) {
    tensile_plots(report, o);
    const sn_protocol *p = &o->protocol;
    const double *stress = column(o, "stress"), *time = column(o, "time");
    size_t rows = (size_t)o->record->rows;
    double *since = sn_alloc(3 * rows, sizeof *since), *fall = since + rows, *G = fall + rows;
    if (!since) return;
    double end = time[rows - 1] - p->hold;
    int first = 0, n = rows_since(o, end, time[rows - 1], since, &first);
    double peak = first > 0 ? stress[first - 1] : (double)NAN;
    for (int i = 0; i < n; i++) {
        fall[i] = stress[first + i] / peak;
        G[i] = sn_memory_relaxation(&o->tissue->memory, since[i]);
    }
    sn_line line[] = {{"stress over its peak", SN_LINE_POINTS, 0, n, since, fall},
                      {"G(t) of the tissue", SN_DASHED, 1, n, since, G}};
    sn_report_plot(report,
                   &(sn_plot){.title = "Relaxation",
                              .x_label = "time since the end of the ramp [s]",
                              .y_label = "stress over peak stress; G [1]",
                              .caption = o->tissue->branched
                                             ? NULL
                                             : "A step would fall along G(t). What relaxes during "
                                               "the ramp is missing from the stress over its peak.",
                              .log_x = true,
                              .line_count = o->tissue->branched ? 1 : 2, // no G is of all
                              .line = line});
    sn_free(since);
}

static void compliance_plot(sn_report *report, const test_outcome *o, double *since, double *y,
                            double *linear) {
    const sn_protocol *p = &o->protocol;
    const double *stretch = column(o, "stretch");
    sn_retardations creep;
    sn_moduli moduli;
    sn_tissue_moduli(o->tissue, &moduli);
    int first = 0, n = rows_since(o, p->ramp, p->ramp + p->hold, since, &first);
    bool branched = o->tissue->branched; // no creep function is of all
    bool known = !branched && sn_memory_creep(&o->tissue->memory, &creep) == SN_OK;
    for (int i = 0; i < n; i++) {
        y[i] = (stretch[first + i] - 1) / p->stress;
        linear[i] = known ? sn_retardations_at(&creep, since[i]) / moduli.young : (double)NAN;
    }
    sn_line line[] = {{"strain over stress", SN_LINE_POINTS, 0, n, since, y},
                      {"J(t)/E, small strains", SN_DASHED, 1, n, since, linear}};
    sn_report_plot(report,
                   &(sn_plot){.title = "Creep compliance",
                              .x_label = "time since the end of the loading [s]",
                              .y_label = "compliance [1/kPa]",
                              .y_scale = 1e3,
                              .caption = branched ? NULL
                                                  : "Dashed: the creep function of the tissue's "
                                                    "memory under a step, over its modulus at "
                                                    "rest.",
                              .log_x = true,
                              .line_count = branched ? 1 : 2,
                              .line = line});
}

static void creep_plots(sn_report *report, const test_outcome *o) {
    const sn_protocol *p = &o->protocol;
    const double *stretch = column(o, "stretch"), *time = column(o, "time");
    size_t rows = (size_t)o->record->rows;
    double *since = sn_alloc(3 * rows, sizeof *since), *y = since + rows, *linear = y + rows;
    if (!since) return;
    for (size_t i = 0; i < rows; i++) y[i] = stretch[i] - 1;
    sn_line line = {NULL, SN_LINE, 0, (int)rows, time, y};
    sn_report_plot(report, &(sn_plot){.title = "Strain over time",
                                      .x_label = "time [s]",
                                      .y_label = "strain [1]",
                                      .line_count = 1,
                                      .line = &line});
    stress_time(report, o);
    compliance_plot(report, o, since, y, linear);
    int first = 0, n = rows_since(o, time[rows - 1] - p->recovery, time[rows - 1], since, &first);
    double held = (double)NAN; // strain at the end of the hold
    for (size_t i = 0; i < rows; i++)
        if (time[i] <= (p->ramp + p->hold) * (1 + 1e-12)) held = stretch[i] - 1;
    for (int i = 0; i < n; i++) y[i] = (stretch[first + i] - 1) / held;
    line = (sn_line){NULL, SN_LINE_POINTS, 0, n, since, y};
    if (p->recovery > 0)
        sn_report_plot(report, &(sn_plot){.title = "Recovery",
                                          .x_label = "time since the end of the unloading [s]",
                                          .y_label = "strain over strain before unloading [1]",
                                          .log_x = true,
                                          .line_count = 1,
                                          .line = &line});
    sn_free(since);
}

static void replay_plots(sn_report *report, const test_outcome *o) {
    const sn_curve *m = &o->measured;
    for (int over_time = 0; over_time < 2; over_time++) {
        const char *x = over_time ? "time" : "stretch";
        sn_line line[] = {
            {"measured", SN_POINTS, 0, m->count, over_time ? m->time : m->stretch, m->stress},
            line_of(o, "predicted", 1, x, "stress")};
        sn_report_plot(
            report, &(sn_plot){.title = over_time ? "Stress over time" : "Stress against stretch",
                               .x_label = over_time ? "time [s]" : "stretch [1]",
                               .y_label = "nominal stress [kPa]",
                               .y_scale = 1e-3,
                               .line_count = 2,
                               .line = line});
    }
}

//---- two directions, shear, sweeps ---------------------------------------------------------------

static void biaxial_plots(sn_report *report, const test_outcome *o) {
    sn_line line[] = {line_of(o, "first axis", 0, "stretch_1", "stress_1"),
                      line_of(o, "second axis", 1, "stretch_2", "stress_2")};
    sn_plot plot = {.title = "Stress against stretch in both directions",
                    .x_label = "stretch [1]",
                    .y_label = "nominal stress [kPa]",
                    .y_scale = 1e-3,
                    .caption = "Equal targets of a law that is alike in both directions give one "
                               "curve.",
                    .line_count = 2,
                    .line = line};
    line[1].style = SN_DASHED; // seen where both are one
    sn_report_plot(report, &plot);
    line[0].x = line[1].x = column(o, "time");
    plot.title = "Stress over time in both directions";
    plot.x_label = "time [s]";
    plot.caption = NULL;
    sn_report_plot(report, &plot);
}

static void shear_plots(sn_report *report, const test_outcome *o) {
    one_line(report, o, "Shear stress against shear strain", "shear_strain", "shear strain [1]",
             "shear_stress", "shear stress [kPa]");
    one_line(report, o, "Shear stress over time", "time", "time [s]", "shear_stress",
             "shear stress [kPa]");
}

static void hysteresis_plot(sn_report *report, const test_outcome *o) {
    sn_line line = line_of(o, NULL, 0, "frequency", "hysteresis");
    line.style = SN_LINE_POINTS;
    sn_report_plot(report, &(sn_plot){.title = "Hysteresis against frequency",
                                      .x_label = "frequency of the triangle, 1/(2 ramp time) [Hz]",
                                      .y_label = "H [1]",
                                      .caption = "Loop area over area under the loading curve of "
                                                 "one triangle from rest.",
                                      .log_x = true,
                                      .line_count = 1,
                                      .line = &line});
}

static void dynamic_plots(sn_report *report, const test_outcome *o) {
    sn_line line[] = {line_of(o, "E\xe2\x80\xb2, storage", 0, "frequency", "storage_modulus"),
                      line_of(o, "E\xe2\x80\xb3, loss", 1, "frequency", "loss_modulus")};
    for (int log_y = 0; log_y < 2; log_y++)
        sn_report_plot(report,
                       &(sn_plot){.title = log_y ? "Dynamic moduli, logarithmic" : "Dynamic moduli",
                                  .x_label = "frequency [Hz]",
                                  .y_label = "modulus [kPa]",
                                  .y_scale = 1e-3,
                                  .log_x = true,
                                  .log_y = log_y,
                                  .line_count = 2,
                                  .line = line});
    size_t rows = (size_t)o->record->rows;
    double *tangent = sn_alloc(rows, sizeof *tangent);
    if (!tangent) return;
    for (size_t i = 0; i < rows; i++) tangent[i] = line[1].y[i] / line[0].y[i];
    sn_line ratio = {NULL, SN_LINE, 2, (int)rows, line[0].x, tangent};
    sn_report_plot(report, &(sn_plot){.title = "Loss tangent",
                                      .x_label = "frequency [Hz]",
                                      .y_label = "tan \xce\xb4 [1]",
                                      .log_x = true,
                                      .line_count = 1,
                                      .line = &ratio});
    sn_free(tangent);
}

//---- the tissue ----------------------------------------------------------------------------------

static void part_plots(sn_report *report, const test_outcome *o, sn_part part) {
    const sn_memory *memory = sn_tissue_memory(o->tissue, part);
    const char *name = test_part(o->tissue, part);
    sn_exponentials e;
    if (!name || memory->law->param_count == 0) return;
    sn_report_heading(report, o->tissue->branched ? name : "Memory");
    if (!test_memory(o, part, &e)) {
        sn_report_text(report, "No sum of exponentials stands for %s over the times of this test.",
                       memory->law->name);
        return;
    }
    if (e.viscous > 0)
        sn_report_text(report,
                       "A dashpot of %s adds its time times the rate of the elastic "
                       "stress.",
                       cli_show(e.viscous, "s"));
    if (e.terms == 0) return;
    cli_relaxation_plot(report, memory, &e);
    cli_spectrum_plot(report, &e);
}

// a table in the making: name, value, meaning
typedef struct text_rows {
    int count;
    char cell[TABLE_ROWS][3][CELL];
} text_rows;

static void add_row(text_rows *r, const char *name, const char *value, const char *text) {
    if (r->count == TABLE_ROWS) return;
    snprintf(r->cell[r->count][0], CELL, "%s", name);
    snprintf(r->cell[r->count][1], CELL, "%s", value);
    snprintf(r->cell[r->count++][2], CELL, "%s", text);
}

static void add_params(text_rows *r, const sn_param *params, int count, int terms,
                       const double *value) {
    for (int k = 0; k < count; k++) {
        char text[CELL] = "";
        int n = sn_param_length(&params[k], terms), at = sn_param_offset(params, k, terms);
        for (int i = 0; i < n; i++) {
            size_t used = strlen(text);
            double v = value[at + i];
            snprintf(text + used, sizeof text - used, "%s%s", i ? ", " : "",
                     isinf(v) && params[k].infinity ? params[k].infinity
                                                    : cli_show(v, params[k].unit));
        }
        add_row(r, params[k].name, text, params[k].text);
    }
}

static void table(sn_report *report, const text_rows *r, const char *first, const char *caption) {
    const char *cells[(TABLE_ROWS + 1) * 3] = {first, "value", "meaning"};
    for (int i = 0; i < r->count; i++)
        for (int j = 0; j < 3; j++) cells[3 * (i + 1) + j] = r->cell[i][j];
    if (r->count > 0) sn_report_table(report, r->count + 1, 3, cells, caption);
}

static void tissue_table(sn_report *report, const sn_tissue *t) {
    text_rows r = {0};
    char caption[SN_TEXT_MAX];
    add_params(&r, t->law->params, t->law->param_count, t->terms, t->value);
    int used = snprintf(caption, sizeof caption, "Constants: elastic law %s", t->law->name);
    for (int k = 0; k < SN_PARTS; k++) {
        const char *part = test_part(t, (sn_part)k);
        const sn_memory *m = sn_tissue_memory(t, (sn_part)k);
        if (!part) continue;
        add_params(&r, m->law->params, m->law->param_count, m->terms, m->value);
        used += snprintf(caption + used, sizeof caption - (size_t)used, ", %s%smemory %s",
                         t->branched ? part : "", t->branched ? " " : "", m->law->name);
    }
    snprintf(caption + used, sizeof caption - (size_t)used,
             ". Elastic constants are instantaneous, G(0) = 1.");
    sn_report_heading(report, "Tissue");
    table(report, &r, "constant", caption);
    if (t->source[0]) sn_report_text(report, "Source of the constants: %s", t->source);
}

static void protocol_table(sn_report *report, const sn_protocol *p) {
    text_rows r = {0};
    int count;
    const sn_param *params = sn_protocol_params(p->kind, &count);
    for (int k = 0; k < count; k++)
        add_row(&r, params[k].name, cli_show(sn_protocol_get(p, params[k].name), params[k].unit),
                params[k].text);
    if (p->kind == SN_PROTOCOL_CYCLIC)
        add_row(&r, "wave", p->wave == SN_WAVE_SINE ? "sine" : "triangle", "Shape of a cycle.");
    char caption[SN_TEXT_MAX];
    snprintf(caption, sizeof caption, "The test: %s.", sn_protocol_name(p->kind));
    table(report, &r, "option", caption);
}

sn_status test_report(const char *path, const test_outcome *o) {
    static void (*const plots[])(sn_report *, const test_outcome *) = {
        [SN_PROTOCOL_TENSILE] = tensile_plots,       [SN_PROTOCOL_CYCLIC] = cyclic_plots,
        [SN_PROTOCOL_RELAXATION] = relaxation_plots, [SN_PROTOCOL_HYSTERESIS] = hysteresis_plot,
        [SN_PROTOCOL_DYNAMIC] = dynamic_plots,       [SN_PROTOCOL_CREEP] = creep_plots,
        [SN_PROTOCOL_BIAXIAL] = biaxial_plots,       [SN_PROTOCOL_SHEAR] = shear_plots,
    };
    char title[SN_TEXT_MAX];
    sn_report *report;
    snprintf(title, sizeof title, "%s: %s", o->tissue->name,
             o->replayed ? "replay of a measured curve" : sn_protocol_name(o->protocol.kind));
    SN_TRY(sn_report_create(title, &report));
    if (o->replayed)
        sn_report_text(report,
                       "The stretch of %s applied to the tissue: rms error %s, %.2f %% of the "
                       "measured peak, R2 = 1 - SSE/SST = %.4f.",
                       cli_basename(o->record->name), cli_show(o->prediction.rmse, "Pa"),
                       100 * o->prediction.rmse / o->prediction.peak, o->prediction.r_squared);
    (o->replayed ? replay_plots : plots[o->protocol.kind])(report, o);
    if (!o->replayed) protocol_table(report, &o->protocol);
    tissue_table(report, o->tissue);
    for (int k = 0; k < SN_PARTS; k++) part_plots(report, o, (sn_part)k);
    sn_status status = sn_report_write(report, path);
    sn_report_destroy(report);
    return status;
}
