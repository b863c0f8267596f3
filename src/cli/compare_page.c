// sinew compare: report.html of one case.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/compare.h"

enum { LINES_MAX = COMPARE_MESHES_MAX * SN_COMPARE_MODELS_MAX };

static bool is_shown(const compare_case *one, int k) {
    return !one->run[k].left_out && one->run[k].result.response;
}

static int finest(const compare_study *s) {
    return s->mesh[s->mesh_count - 1];
}

//---- bodies --------------------------------------------------------------------------------------

static void bodies(sn_report *report, const compare_study *s, const compare_case *one) {
    sn_body body[SN_COMPARE_MODELS_MAX];
    int n = 0;
    double top = 0;
    for (int k = 0; k < one->run_count; k++) {
        const sn_comparison_model *m = &one->run[k].result;
        if (one->run[k].mesh != finest(s) || !m->displacement) continue;
        for (int i = 0; i < m->points; i++) top = fmax(top, m->distance[i]);
        body[n++] = (sn_body){.title = m->name,
                              .value_label = "displacement error [mm]",
                              .mesh = one->reference.mesh,
                              .displacement = m->displacement,
                              .value = m->distance,
                              .value_scale = 1e3};
    }
    for (int k = 0; k < n; k++) body[k].value_max = top;
    if (n > 0)
        sn_report_bodies(report, n, body,
                         "The deformed body at the last output time, painted with the distance to "
                         "the reference, one scale for all. Drag to turn, wheel to zoom.");
}

//---- curves --------------------------------------------------------------------------------------

// one answer of the reference and of all models on the finest mesh, over time or over what is
// prescribed
static void answer_plot(sn_report *report, const compare_study *s, const compare_case *one, int k,
                        bool over_time) {
    const sn_record *truth = one->reference.model.response;
    sn_line line[1 + SN_COMPARE_MODELS_MAX];
    int n = 0;
    bool force_answers = strcmp(truth->series[k].unit, "N") == 0;
    // force stands upright, whatever answers
    int up = over_time || force_answers ? k : k - 1, across = over_time ? 0 : up == k ? k - 1 : k;
    line[n++] =
        (sn_line){"P2P1 reference",       SN_LINE, 0, truth->rows, truth->series[across].value,
                  truth->series[up].value};
    for (int r = 0; r < one->run_count; r++) {
        const sn_record *h = one->run[r].result.response;
        if (one->run[r].mesh != finest(s) || !is_shown(one, r) || h->rows == 0) continue;
        line[n] = (sn_line){one->run[r].result.name, SN_DASHED,          n, h->rows,
                            h->series[across].value, h->series[up].value};
        n++;
    }
    char title[2 * SN_NAME_MAX + 32], label[2][SN_NAME_MAX + 16];
    const int column[2] = {across, up};
    double scale[2];
    for (int side = 0; side < 2; side++) {
        const sn_series *series = &truth->series[column[side]];
        bool length = strcmp(series->unit, "m") == 0;
        scale[side] = length ? 1e3 : 1;
        snprintf(label[side], sizeof label[side], "%s [%s]", series->name,
                 length ? "mm" : series->unit);
    }
    snprintf(title, sizeof title, "%s over %s", truth->series[up].name, truth->series[across].name);
    sn_report_plot(report, &(sn_plot){.title = title,
                                      .x_label = label[0],
                                      .y_label = label[1],
                                      .x_scale = scale[0],
                                      .y_scale = scale[1],
                                      .line_count = n,
                                      .line = line});
}

//---- error against cost and mesh -----------------------------------------------------------------

void compare_error_plot(sn_report *report, const sn_plot *plot) {
    sn_plot error = *plot;
    error.y_label = "error [%]";
    error.y_scale = 100;
    error.log_x = error.log_y = true;
    if (error.line_count > 0) sn_report_plot(report, &error);
}

typedef struct points {
    int count[SN_COMPARE_MODELS_MAX];
    double x[SN_COMPARE_MODELS_MAX][COMPARE_MESHES_MAX],
        y[SN_COMPARE_MODELS_MAX][COMPARE_MESHES_MAX];
} points;

typedef enum abscissa { OVER_WALL, OVER_LIVE, OVER_NODES } abscissa;

static double abscissa_of(const sn_comparison_model *m, abscissa what) {
    switch (what) {
    case OVER_WALL: return m->summary.wall_s;
    case OVER_LIVE: return 1 / m->live.real_time_factor;
    case OVER_NODES: break;
    }
    return m->summary.nodes;
}

static void error_plot(sn_report *report, const compare_case *one, abscissa what) {
    static const char *const titles[] = {"Error against cost of the comparison's own runs",
                                         "Error against cost, live", "Error against mesh size"};
    static const char *const labels[] = {"wall time [s]", "wall time of a simulated second [s]",
                                         "nodes"};
    points p = {0};
    sn_line line[SN_COMPARE_MODELS_MAX];
    int n = 0;
    for (int k = 0; k < one->run_count; k++) {
        const sn_comparison_model *m = &one->run[k].result;
        int row = one->run[k].model;
        double error = compare_main_error(m), x = abscissa_of(m, what);
        if (one->run[k].left_out || !isfinite(error) || error <= 0 || !isfinite(x)) continue;
        p.x[row][p.count[row]] = x;
        p.y[row][p.count[row]++] = error;
    }
    for (int row = 0; row < sn_compare_model_count(); row++)
        if (p.count[row] > 0)
            line[n++] = (sn_line){sn_compare_model_name(row),
                                  p.count[row] > 1 ? SN_LINE_POINTS : SN_POINTS,
                                  row,
                                  p.count[row],
                                  p.x[row],
                                  p.y[row]};
    compare_error_plot(
        report,
        &(sn_plot){.title = titles[what], .x_label = labels[what], .line_count = n, .line = line});
}

//---- frames --------------------------------------------------------------------------------------

// wall times of live frames of the spring models on the finest mesh, and the line of 1 kHz
static void frame_plot(sn_report *report, const compare_study *s, const compare_case *one) {
    double x[SN_LIVE_BINS], y[SN_COMPARE_MODELS_MAX][SN_LIVE_BINS], most = 0;
    sn_line line[SN_COMPARE_MODELS_MAX + 1];
    int n = 0;
    for (int b = 0; b < SN_LIVE_BINS; b++) x[b] = 1e-3 * pow(10, (b + 0.5) / 8);
    for (int k = 0; k < one->run_count; k++) {
        const sn_live *live = &one->run[k].result.live;
        if (one->run[k].mesh != finest(s) || one->run[k].left_out || live->frames == 0) continue;
        for (int b = 0; b < SN_LIVE_BINS; b++) {
            // an empty bin draws nothing
            y[n][b] = live->bin[b] ? 100.0 * live->bin[b] / live->frames : (double)NAN;
            if (live->bin[b]) most = fmax(most, y[n][b]);
        }
        line[n] = (sn_line){one->run[k].result.name, SN_BARS, n, SN_LIVE_BINS, x, y[n]};
        n++;
    }
    if (n == 0) return;
    const double at[2] = {1, 1}, height[2] = {0, most};
    line[n++] = (sn_line){"1 kHz", SN_LINE, 6, 2, at, height};
    sn_report_plot(report, &(sn_plot){.title = "Frames of 1 ms, live, on the finest mesh",
                                      .x_label = "wall time of a frame [ms]",
                                      .y_label = "share of the frames [%]",
                                      .log_x = true,
                                      .line_count = n,
                                      .line = line,
                                      .caption = "Frames left of the line keep up with a haptic "
                                                 "loop of 1 kHz."});
}

//---- energies ------------------------------------------------------------------------------------

static void energy_table(sn_report *report, const compare_study *s, const compare_case *one) {
    static const char *const head[] = {"model",      "kinetic", "elastic", "memory",
                                       "dissipated", "work",    "residual"};
    compare_table t;
    if (compare_table_create(7, 2 + one->run_count, &t) != SN_OK) return;
    char(*row)[64] = compare_table_row(&t);
    for (int k = 0; k < 7; k++) snprintf(row[k], 64, "%s", head[k]);
    for (int k = -1; k < one->run_count; k++) {
        const sn_comparison_model *m = k < 0 ? &one->reference.model : &one->run[k].result;
        if (k >= 0 && (one->run[k].mesh != finest(s) || !is_shown(one, k))) continue;
        const sn_run_summary *e = &m->summary;
        row = compare_table_row(&t);
        snprintf(row[0], 64, "%s", m->name);
        snprintf(row[1], 64, "%s", cli_show(e->kinetic_J, "J"));
        snprintf(row[2], 64, "%s", cli_show(e->elastic_J, "J"));
        snprintf(row[3], 64, "%s", cli_show(e->memory_J, "J"));
        snprintf(row[4], 64, "%s", cli_show(e->dissipated_J, "J"));
        snprintf(row[5], 64, "%s", cli_show(e->external_work_J, "J"));
        snprintf(row[6], 64, "%.2g", e->energy_residual);
    }
    compare_table_add(report, &t,
                      "Energies at the end, finest mesh. Elastic: springs what has not relaxed, "
                      "finite elements as if the strain were reached at once. Residual: of the "
                      "largest.");
    compare_table_release(&t);
}

// the ledger over time of the first spring model that has one
static void energy_plot(sn_report *report, const compare_study *s, const compare_case *one) {
    sn_line line[8];
    char title[SN_NAME_MAX + 32];
    for (int k = 0; k < one->run_count; k++) {
        const sn_record *e = one->run[k].result.energy;
        if (one->run[k].mesh != finest(s) || !is_shown(one, k) || !e || e->rows < 2) continue;
        int n = 0;
        for (int c = 1; c < e->series_count && n < 8; c++, n++)
            line[n] = (sn_line){e->series[c].name,  SN_LINE,           n, e->rows,
                                e->series[0].value, e->series[c].value};
        snprintf(title, sizeof title, "Energy ledger of %s", one->run[k].result.name);
        sn_report_plot(report, &(sn_plot){.title = title,
                                          .x_label = "time [s]",
                                          .y_label = "energy [mJ]",
                                          .y_scale = 1e3,
                                          .line_count = n,
                                          .line = line});
        return;
    }
}

//---- page ----------------------------------------------------------------------------------------

void compare_add_words(void *report, const char *text) {
    sn_report_text(report, "%s", text);
}

static void notes(sn_report *report, const compare_study *s, const compare_case *one) {
    for (int k = 0; k < one->run_count; k++) {
        const sn_run_summary *m = &one->run[k].result.summary;
        if (one->run[k].mesh != finest(s) || !is_shown(one, k)) continue;
        // the continuum's notes are about its energies, and the table says that
        if (*m->note && strcmp(m->engine, "springs") == 0)
            sn_report_text(report, "%s: %s", one->run[k].result.name, m->note);
        if (m->memory_terms)
            sn_report_text(report,
                           "%s: memory as %d exponentials, error at most %.2g of G(0) from %s to "
                           "%s; step %s.",
                           one->run[k].result.name, m->memory_terms, m->memory_error,
                           cli_show(m->memory_band_s[0], "s"), cli_show(m->memory_band_s[1], "s"),
                           cli_show(m->step_s, "s"));
    }
}

static sn_status fill(sn_report *report, const compare_study *s, const compare_case *one) {
    compare_table table;
    sn_report_heading(report, "Which model to use");
    compare_words(s, one, compare_add_words, report);
    sn_report_heading(report, "Errors and cost");
    sn_report_text(report, "Reference: %s.", one->reference.text);
    SN_TRY(compare_case_table(one, &table));
    compare_table_add(
        report, &table,
        "Errors over the reference's largest value of the whole run; the reference's own row holds "
        "its estimated error. Answer: the force on what is moved, the motion of what is pushed. "
        "Relaxation: what is left of a force's error when the elastic part is taken out. P1: what "
        "the mesh alone costs. Real time: simulated over wall time, of the run itself and live "
        "(frames "
        "of 1 ms of the explicit engine, single precision). Memory: peak of the run.");
    compare_table_release(&table);
    bodies(report, s, one);
    if (!one->reference.model.done) return SN_OK;
    sn_report_heading(report, "Force and motion");
    const sn_record *truth = one->reference.model.response;
    for (int k = 2; k < truth->series_count; k += 2)
        for (int over_time = 0; over_time < 2; over_time++)
            answer_plot(report, s, one, k, over_time);
    if (truth->series_count < 3)
        sn_report_text(report, "No load or tool of this case has a force and a motion to draw.");
    sn_report_heading(report, "Cost");
    error_plot(report, one, OVER_WALL);
    error_plot(report, one, OVER_LIVE);
    if (s->mesh_count > 1) error_plot(report, one, OVER_NODES);
    frame_plot(report, s, one);
    sn_report_heading(report, "Energy");
    energy_table(report, s, one);
    energy_plot(report, s, one);
    notes(report, s, one);
    return SN_OK;
}

sn_status compare_write_page(const char *path, const compare_study *s, const compare_case *one) {
    char title[SN_TEXT_MAX + 32];
    sn_report *report;
    snprintf(title, sizeof title, "%s: springs against the continuum", one->c->name);
    SN_TRY(sn_report_create(title, &report));
    sn_status status = fill(report, s, one);
    if (status == SN_OK) status = sn_report_write(report, path);
    sn_report_destroy(report);
    return status;
}
