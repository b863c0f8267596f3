// sinew compare: report.html over several cases.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/compare.h"

//---- plots ---------------------------------------------------------------------------------------

// a point for every case, mesh and model: error over the live cost of a simulated second
static sn_status cost_plot(sn_report *report, const compare_study *s) {
    size_t most = (size_t)s->case_count * (size_t)s->mesh_count;
    int models = sn_compare_model_count(), n = 0;
    sn_line line[SN_COMPARE_MODELS_MAX];
    double *value = sn_alloc(2 * most * (size_t)models, sizeof *value);
    if (!value) return SN_E_MEMORY;
    for (int model = 0; model < models; model++) {
        double *x = value + 2 * most * (size_t)model, *y = x + most;
        int count = 0;
        for (int i = 0; i < s->case_count; i++)
            for (int k = 0; k < s->item[i].run_count; k++) {
                const compare_run *run = &s->item[i].run[k];
                double cost = 1 / run->result.live.real_time_factor;
                double error = compare_main_error(&run->result);
                if (run->model != model || run->left_out || !isfinite(error) || !isfinite(cost))
                    continue;
                x[count] = cost;
                y[count++] = error;
            }
        if (count > 0)
            line[n++] = (sn_line){sn_compare_model_name(model), SN_POINTS, model, count, x, y};
    }
    compare_error_plot(report, &(sn_plot){.title = "Error against live cost, all cases and meshes",
                                          .x_label = "wall time of a simulated second [s]",
                                          .line_count = n,
                                          .line = line,
                                          .caption = "Left of 1 s a model runs faster than the "
                                                     "clock."});
    sn_free(value);
    return SN_OK;
}

// median over the cases, a line a model
static void mesh_plot(sn_report *report, const compare_study *s, const compare_summary *rows,
                      int count) {
    double x[SN_COMPARE_MODELS_MAX][COMPARE_MESHES_MAX],
        y[SN_COMPARE_MODELS_MAX][COMPARE_MESHES_MAX];
    sn_line line[SN_COMPARE_MODELS_MAX];
    int n = 0;
    for (int model = 0; model < sn_compare_model_count(); model++) {
        int points = 0;
        for (int k = 0; k < count; k++) {
            if (rows[k].model != model || rows[k].cases == 0) continue;
            x[n][points] = rows[k].mesh;
            y[n][points++] = rows[k].median;
        }
        if (points == 0) continue;
        line[n] =
            (sn_line){sn_compare_model_name(model), SN_LINE_POINTS, model, points, x[n], y[n]};
        n++;
    }
    if (s->mesh_count > 1)
        compare_error_plot(report,
                           &(sn_plot){.title = "Error against mesh size, median of the cases",
                                      .x_label = "mesh: factor on the cells along an edge",
                                      .line_count = n,
                                      .line = line});
}

//---- page ----------------------------------------------------------------------------------------

static sn_status add_tables(sn_report *report, const compare_study *s) {
    compare_table table;
    SN_TRY(compare_summary_table(s, &table));
    compare_table_add(report, &table,
                      "All cases. Error: the larger of that of the displacements (rms) and that of "
                      "the answer (the force on what is moved, the motion of what is pushed). P1: "
                      "what the mesh alone costs. Live: simulated over wall time of the explicit "
                      "engine in single precision, the slowest case.");
    compare_table_release(&table);
    SN_TRY(compare_cases_table(s, &table));
    compare_table_add(
        report, &table,
        "Every case on its finest mesh: error of displacements / of the answer / of "
        "the memory where there is one. Each case has a page of its own, in the folder "
        "of its name.");
    compare_table_release(&table);
    return SN_OK;
}

static sn_status fill(sn_report *report, const compare_study *s) {
    compare_summary *rows = NULL;
    sn_status status;
    sn_report_heading(report, "Which model to use");
    compare_words(s, NULL, compare_add_words, report);
    sn_report_heading(report, "Errors and cost");
    SN_TRY_GOTO(status, add_tables(report, s));
    SN_TRY_GOTO(status, cost_plot(report, s));
    int count = compare_summarise(s, &rows);
    if (count < 0) status = SN_E_MEMORY;
    mesh_plot(report, s, rows, count);
fail:
    sn_free(rows);
    return status;
}

sn_status compare_write_overview(const char *path, const compare_study *s) {
    sn_report *report;
    SN_TRY(sn_report_create("Springs against the continuum", &report));
    sn_status status = fill(report, s);
    if (status == SN_OK) status = sn_report_write(report, path);
    sn_report_destroy(report);
    return status;
}
