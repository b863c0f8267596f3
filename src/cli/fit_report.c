// The results of sinew fit: JSON, text, page.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/fit.h"

// band and tolerance at which the spectrum's compression is reported: the span of the records
#define COMPRESSION_TOLERANCE 1e-3
#define TWO_PI 6.28318530717958648

static bool is_sweep(const sn_curve *curve) {
    return curve->kind == SN_CURVE_DYNAMIC;
}

static int count_sweeps(const fit_outcome *o) {
    int n = 0;
    for (int k = 0; k < o->data->count; k++) n += is_sweep(&o->data->curve[k]);
    return n;
}

// every curve that is no sweep has a time
static bool timed(const fit_outcome *o) {
    for (int k = 0; k < o->data->count; k++)
        if (!o->data->curve[k].time && !is_sweep(&o->data->curve[k])) return false;
    return true;
}

// where a row stands: its time, its frequency, or its number
static const char *place_of(const sn_curve *curve, int row) {
    static char text[4][32];
    static int turn;
    if (curve->time) return cli_show(curve->time[row], "s");
    if (is_sweep(curve)) return cli_show(curve->frequency[row], "Hz");
    turn = (turn + 1) % 4;
    snprintf(text[turn], sizeof text[turn], "row %d", row + 1);
    return text[turn];
}

static double worst_measured(const sn_curve *m, const sn_fit_curve *c) {
    return sn_curve_measured(m, c->second)[c->worst];
}

static double worst_fitted(const sn_fit_curve *c) {
    return c->second ? c->predicted_2[c->worst] : c->predicted[c->worst];
}

// Fung's laws have a condition to be convex, and the fit stays within it
static json_t *convex_json(const sn_tissue *tissue) {
    if (strncmp(tissue->law->name, "fung", 4) != 0) return json_null();
    return json_boolean(sn_law_check(tissue->law, tissue->value, tissue->terms) == SN_OK);
}

// times that the curves speak of; of a sweep those of 1/omega
static void time_span(const fit_outcome *o, double *shortest, double *longest) {
    *shortest = INFINITY;
    *longest = 0;
    for (int k = 0; k < o->data->count; k++) {
        const sn_curve *c = &o->data->curve[k];
        if (is_sweep(c)) {
            *shortest = fmin(*shortest, 1 / (TWO_PI * c->frequency[c->count - 1]));
            *longest = fmax(*longest, 1 / (TWO_PI * c->frequency[0]));
            continue;
        }
        for (int i = 1; i < c->count; i++) *shortest = fmin(*shortest, c->time[i] - c->time[i - 1]);
        *longest = fmax(*longest, c->time[c->count - 1] - c->time[0]);
    }
}

static bool compress(const fit_outcome *o, sn_exponentials *e) {
    double shortest, longest;
    if (!timed(o)) return false;
    time_span(o, &shortest, &longest);
    return sn_memory_compress(&o->fit->tissue.memory, shortest, longest, COMPRESSION_TOLERANCE,
                              e) == SN_OK;
}

// a constant may be infinite: the bulk modulus of an incompressible specimen
static const char *shown_value(const sn_fit_param *p) {
    return isinf(p->value) ? "incompressible" : cli_show(p->value, p->unit);
}

//---- JSON ----------------------------------------------------------------------------------------

static json_t *parameters_json(const sn_fit_result *f) {
    json_t *parameters = json_array();
    for (int k = 0; k < f->param_count; k++) {
        const sn_fit_param *p = &f->param[k];
        json_t *row = json_object();
        cli_put_text(row, "name", p->name);
        cli_put_number(row, "value", p->value);
        cli_put_text(row, "unit", p->unit);
        cli_put_number(row, "standard_error", p->standard_error);
        cli_put(row, "ci95", cli_numbers(2, p->ci95));
        if (f->bootstrap.asked) cli_put(row, "ci95_bootstrap", cli_numbers(2, p->ci95_bootstrap));
        cli_put_flag(row, "fixed", p->fixed);
        cli_put_flag(row, "identifiable", p->identifiable);
        json_array_append_new(parameters, row);
    }
    return parameters;
}

static void put_verdicts(json_t *json, const sn_fit_result *f) {
    json_t *bounds = json_array(), *reasons = json_array();
    for (int k = 0; k < f->param_count; k++) {
        const sn_fit_param *p = &f->param[k];
        if (p->at_bound) json_array_append_new(bounds, json_string(p->name));
        if (p->identifiable) continue;
        json_t *row = json_object();
        cli_put_text(row, "name", p->name);
        cli_put_text(row, "reason", p->reason);
        json_array_append_new(reasons, row);
    }
    cli_put(json, "active_bounds", bounds);
    cli_put_flag(json, "identifiable", f->identifiable);
    cli_put(json, "not_identifiable", reasons);
    cli_put_text(json, "weakest_combination", f->weakest);
    cli_put_text(json, "determined_combination", f->determined);
}

static json_t *curves_json(const fit_outcome *o) {
    json_t *data = json_array();
    for (int k = 0; k < o->data->count; k++) {
        const sn_fit_curve *c = &o->fit->curve[k];
        const sn_curve *m = &o->data->curve[k];
        json_t *row = json_object(), *worst = json_object();
        cli_put_text(row, "file", o->data->path[k]);
        cli_put_text(row, "sha256", o->data->sha256[k]);
        cli_put_integer(row, "points", c->used);
        cli_put_text(row, "kind", sn_curve_kind_name(m->kind));
        cli_put(row, "window",
                m->time
                    ? cli_numbers(2, (double[]){m->time[c->first], m->time[c->first + c->used - 1]})
                    : json_null());
        cli_put_number(row, "weight", c->weight);
        cli_put_number(row, "rmse_Pa", c->rmse);
        cli_put_number(row, "rmse_over_peak", c->rmse / c->peak);
        cli_put_number(row, "r_squared", c->r_squared);
        cli_put_number(row, "durbin_watson", c->durbin_watson);
        cli_put_integer(worst, "row", c->worst + 1);
        cli_put_number(worst, "time_s", m->time ? m->time[c->worst] : (double)NAN);
        if (is_sweep(m)) {
            cli_put_number(worst, "frequency_Hz", m->frequency[c->worst]);
            cli_put_text(worst, "modulus", c->second ? "loss" : "storage");
        }
        if (m->kind == SN_CURVE_BIAXIAL) cli_put_integer(worst, "axis", c->second ? 2 : 1);
        cli_put_number(worst, "measured_Pa", worst_measured(m, c));
        cli_put_number(worst, "fitted_Pa", worst_fitted(c));
        cli_put(row, "worst", worst);
        json_array_append_new(data, row);
    }
    return data;
}

static json_t *held_out_json(const fit_outcome *o) {
    json_t *rows = json_array();
    for (int k = 0; k < o->data->count; k++) {
        const sn_fit_curve *c = &o->held_out[k].prediction;
        json_t *row = json_object();
        cli_put_text(row, "file", o->data->path[k]);
        cli_put_number(row, "rmse_Pa", c->rmse);
        cli_put_number(row, "rmse_over_peak", c->rmse / c->peak);
        cli_put_number(row, "r_squared", c->r_squared);
        json_array_append_new(rows, row);
    }
    return rows;
}

json_t *fit_json(const fit_outcome *o) {
    const sn_fit_result *f = o->fit;
    json_t *json = json_object(), *correlation = json_array();
    for (int k = 0; k < f->param_count; k++)
        json_array_append_new(correlation,
                              cli_numbers(f->param_count, f->correlation + k * f->param_count));
    cli_put_text(json, "elastic", f->tissue.law->name);
    cli_put_text(json, "memory", f->tissue.memory.law->name);
    cli_put(json, "parameters", parameters_json(f));
    cli_put_number(json, "r_squared", f->r_squared);
    cli_put_number(json, "rmse_Pa", f->rmse);
    cli_put_number(json, "nrmse", f->nrmse);
    cli_put_number(json, "aicc", f->aicc);
    cli_put(json, "correlation", correlation);
    put_verdicts(json, f);
    cli_put(json, "convex", convex_json(&f->tissue));
    cli_put_flag(json, "converged", f->converged);
    cli_put_text(json, "reason", f->reason);
    cli_put_integer(json, "points", f->points);
    cli_put(json, "data", curves_json(o));
    fit_details_json(json, o);
    sn_exponentials e;
    if (compress(o, &e)) cli_put(json, "memory_as_exponentials", cli_exponentials(&e));
    if (o->has_held_out) cli_put(json, "held_out", held_out_json(o));
    return json;
}

//---- text ----------------------------------------------------------------------------------------

void fit_print(const fit_outcome *o) {
    const sn_fit_result *f = o->fit;
    printf(
        "%s x %s, %d curve%s, %d points: R2 %.4f, rms error %s (%.2f %% of the largest stress)\n",
        f->tissue.law->name, f->tissue.memory.law->name, o->data->count,
        o->data->count == 1 ? "" : "s", f->points, f->r_squared, cli_show(f->rmse, "Pa"),
        100 * f->nrmse);
    for (int k = 0; k < f->param_count; k++) {
        const sn_fit_param *p = &f->param[k];
        printf("  %-10s %-14s", p->name, shown_value(p));
        if (p->fixed)
            printf(" held%s%s\n", *p->reason ? ": " : "", p->reason);
        else
            printf(" 95 %% interval %s to %s%s%s\n", cli_show(p->ci95[0], p->unit),
                   cli_show(p->ci95[1], p->unit),
                   p->identifiable ? "" : "   NOT DETERMINED: ", p->identifiable ? "" : p->reason);
    }
    for (int k = 0; k < o->data->count; k++) {
        const sn_fit_curve *c = &f->curve[k];
        const sn_curve *m = &o->data->curve[k];
        printf("  %-24s rms %.2f %% of its peak; worst at %s: measured %s, fitted %s\n",
               cli_basename(o->data->path[k]), 100 * c->rmse / c->peak, place_of(m, c->worst),
               cli_show(worst_measured(m, c), "Pa"), cli_show(worst_fitted(c), "Pa"));
        if (o->has_held_out)
            printf("  %-24s predicted from the others: rms %.2f %% of its peak\n", "",
                   100 * o->held_out[k].prediction.rmse / o->held_out[k].prediction.peak);
    }
    sn_exponentials e;
    if (f->tissue.memory.law->param_count > 0 && compress(o, &e) && e.terms > 0)
        printf("  memory as %d exponentials: error at most %.2g of G(0) from %s to %s\n", e.terms,
               e.max_error, cli_show(e.t_min, "s"), cli_show(e.t_max, "s"));
    if (!f->converged) printf("  the search did not converge: %s\n", f->reason);
    fit_details_print(o);
}

//---- page ----------------------------------------------------------------------------------------

static void parameter_table(sn_report *report, const sn_fit_result *f) {
    const char *cells[(SN_FIT_PARAMS_MAX + 1) * 4];
    char text[SN_FIT_PARAMS_MAX][3][160];
    int n = 0;
    cells[n++] = "constant", cells[n++] = "value", cells[n++] = "95 % interval";
    cells[n++] = "determined by the data";
    for (int k = 0; k < f->param_count; k++) {
        const sn_fit_param *p = &f->param[k];
        snprintf(text[k][0], sizeof text[k][0], "%s", shown_value(p));
        snprintf(text[k][1], sizeof text[k][1], "%s … %s", cli_show(p->ci95[0], p->unit),
                 cli_show(p->ci95[1], p->unit));
        snprintf(text[k][2], sizeof text[k][2], "%s",
                 p->fixed          ? (*p->reason ? p->reason : "not asked")
                 : p->identifiable ? "yes"
                                   : p->reason);
        cells[n++] = p->name, cells[n++] = text[k][0];
        cells[n++] = p->fixed ? "held" : text[k][1], cells[n++] = text[k][2];
    }
    sn_report_table(
        report, f->param_count + 1, 4, cells,
        "Constants. Elastic constants are instantaneous, G(0) = 1; intervals are "
        "linearised at the optimum, in the logarithm where the constant is positive, or "
        "likelihood profiles where that would be too wide to trust.");
}

// what the law misses: the curve and the point with the largest residual
static void misses(sn_report *report, const fit_outcome *o) {
    int worst = 0;
    double largest = 0;
    for (int k = 0; k < o->data->count; k++) {
        const sn_fit_curve *c = &o->fit->curve[k];
        double residual = fabs(worst_measured(&o->data->curve[k], c) - worst_fitted(c));
        if (residual > largest) largest = residual, worst = k;
    }
    const sn_fit_curve *c = &o->fit->curve[worst];
    const sn_curve *m = &o->data->curve[worst];
    sn_report_text(
        report,
        "What the law misses: the largest residual is at %s of %s, where %s was measured "
        "and the fit has %s (%.1f %% of that curve's peak).",
        place_of(m, c->worst), cli_basename(o->data->path[worst]),
        cli_show(worst_measured(m, c), "Pa"), cli_show(worst_fitted(c), "Pa"),
        100 * largest / c->peak);
    for (int k = 0; k < o->fit->param_count; k++)
        if (!o->fit->param[k].identifiable)
            sn_report_text(report, "The data do not determine %s: %s.", o->fit->param[k].name,
                           o->fit->param[k].reason);
}

static void curve_table(sn_report *report, const fit_outcome *o) {
    const char *cells[(SN_FIT_CURVES_MAX + 1) * 4];
    char text[SN_FIT_CURVES_MAX][3][48];
    int n = 0, columns = o->has_held_out ? 4 : 3;
    cells[n++] = "curve", cells[n++] = "peak", cells[n++] = "rms error, fitted";
    if (columns == 4) cells[n++] = "rms error, predicted from the others";
    for (int k = 0; k < o->data->count; k++) {
        const sn_fit_curve *c = &o->fit->curve[k], *h = &o->held_out[k].prediction;
        snprintf(text[k][0], sizeof text[k][0], "%s", cli_show(c->peak, "Pa"));
        snprintf(text[k][1], sizeof text[k][1], "%.2f %% of peak", 100 * c->rmse / c->peak);
        if (columns == 4)
            snprintf(text[k][2], sizeof text[k][2], "%.2f %% of peak", 100 * h->rmse / h->peak);
        cells[n++] = cli_basename(o->data->path[k]);
        for (int j = 0; j < columns - 1; j++) cells[n++] = text[k][j];
    }
    sn_report_table(report, o->data->count + 1, columns, cells, "Errors, curve by curve.");
}

// Measured points and the fitted line of every curve of a kind. Over time: of all curves, those of
// the second axes among them.
static void fit_plot(sn_report *report, const fit_outcome *o, sn_curve_kind kind, bool over_time,
                     bool predicted) {
    sn_line line[4 * SN_FIT_CURVES_MAX];
    char label[2 * SN_FIT_CURVES_MAX][SN_TEXT_MAX];
    int n = 0;
    for (int k = 0; k < o->data->count; k++) {
        const sn_curve *m = &o->data->curve[k];
        const sn_fit_curve *c = predicted ? &o->held_out[k].prediction : &o->fit->curve[k];
        const double *x = over_time ? m->time : m->stretch;
        bool two = over_time && m->kind == SN_CURVE_BIAXIAL;
        if (over_time ? is_sweep(m) : m->kind != kind) continue;
        snprintf(label[n / 2], sizeof *label, "%s%s", cli_basename(o->data->path[k]),
                 two ? ", axis 1" : "");
        line[n] = (sn_line){label[n / 2], SN_POINTS, n / 2 % 8, m->count, x, m->stress};
        line[n + 1] = (sn_line){NULL, SN_LINE, n / 2 % 8, m->count, x, c->predicted};
        n += 2;
        if (!two) continue;
        snprintf(label[n / 2], sizeof *label, "%s, axis 2", cli_basename(o->data->path[k]));
        line[n] = (sn_line){label[n / 2], SN_POINTS, n / 2 % 8, m->count, x, m->stress_2};
        line[n + 1] = (sn_line){NULL, SN_LINE, n / 2 % 8, m->count, x, c->predicted_2};
        n += 2;
    }
    if (n == 0) return;
    bool shear = !over_time && kind == SN_CURVE_SHEAR;
    sn_report_plot(report,
                   &(sn_plot){.title = predicted   ? "Each curve predicted from the others"
                                       : over_time ? "Stress over time"
                                       : shear     ? "Shear stress against shear strain"
                                                   : "Stress against stretch",
                              .x_label = over_time ? "time [s]"
                                         : shear   ? "shear strain [1]"
                                                   : "stretch [1]",
                              .y_label = shear ? "shear stress [kPa]" : "nominal stress [kPa]",
                              .y_scale = 1e-3,
                              .caption = "Points: measured. Lines: model, through the recorded "
                                         "history.",
                              .log_x = over_time,
                              .line_count = n,
                              .line = line});
}

// both axes of every biaxial curve, a plot each
static void biaxial_plots(sn_report *report, const fit_outcome *o, bool predicted) {
    for (int k = 0; k < o->data->count; k++) {
        const sn_curve *m = &o->data->curve[k];
        const sn_fit_curve *c = predicted ? &o->held_out[k].prediction : &o->fit->curve[k];
        if (m->kind != SN_CURVE_BIAXIAL) continue;
        char title[SN_TEXT_MAX + 32];
        snprintf(title, sizeof title, "%s%s", cli_basename(o->data->path[k]),
                 predicted ? ", predicted from the others" : "");
        const sn_line line[] = {{"axis 1", SN_POINTS, 0, m->count, m->stretch, m->stress},
                                {NULL, SN_LINE, 0, m->count, m->stretch, c->predicted},
                                {"axis 2", SN_POINTS, 1, m->count, m->stretch_2, m->stress_2},
                                {NULL, SN_LINE, 1, m->count, m->stretch_2, c->predicted_2}};
        sn_report_plot(report, &(sn_plot){.title = title,
                                          .x_label = "stretch of the axis [1]",
                                          .y_label = "nominal stress [kPa]",
                                          .y_scale = 1e-3,
                                          .caption = "Points: measured. Lines: model.",
                                          .line_count = 4,
                                          .line = line});
    }
}

// storage and loss modulus of every sweep, a plot each
static void sweep_plots(sn_report *report, const fit_outcome *o, bool predicted) {
    for (int k = 0; k < o->data->count; k++) {
        const sn_curve *m = &o->data->curve[k];
        const sn_fit_curve *c = predicted ? &o->held_out[k].prediction : &o->fit->curve[k];
        if (!is_sweep(m)) continue;
        char title[SN_TEXT_MAX + 64];
        snprintf(title, sizeof title, "%s, moduli about stretch %g%s",
                 cli_basename(o->data->path[k]), m->mean_stretch,
                 predicted ? ", predicted from the others" : "");
        const sn_line line[] = {{"storage", SN_POINTS, 0, m->count, m->frequency, m->storage},
                                {NULL, SN_LINE, 0, m->count, m->frequency, c->predicted},
                                {"loss", SN_POINTS, 1, m->count, m->frequency, m->loss},
                                {NULL, SN_LINE, 1, m->count, m->frequency, c->predicted_2}};
        sn_report_plot(report, &(sn_plot){.title = title,
                                          .x_label = "frequency [Hz]",
                                          .y_label = "dynamic modulus [kPa]",
                                          .y_scale = 1e-3,
                                          .caption = "Points: measured. Lines: model.",
                                          .log_x = true,
                                          .line_count = 4,
                                          .line = line});
    }
}

// residuals of the fitted rows of every curve, of the second axis after the first
static void residual_plot(sn_report *report, const fit_outcome *o) {
    sn_line line[2 * SN_FIT_CURVES_MAX];
    char label[2 * SN_FIT_CURVES_MAX][SN_TEXT_MAX];
    bool over_time = timed(o) && !count_sweeps(o);
    size_t points = (size_t)o->fit->points;
    double *residual = sn_alloc(2 * points, sizeof *residual), *at = residual + points;
    if (!residual) return; // sn_report_write reports the shortage that follows
    int used = 0, n = 0;
    for (int k = 0; k < o->data->count; k++) {
        const sn_curve *m = &o->data->curve[k];
        const sn_fit_curve *c = &o->fit->curve[k];
        for (int axis = 0; axis < 2 && sn_curve_measured(m, axis); axis++) {
            const double *measured = sn_curve_measured(m, axis);
            const double *fitted = axis ? c->predicted_2 : c->predicted;
            snprintf(label[n], sizeof *label, "%s%s", cli_basename(o->data->path[k]),
                     !is_sweep(m) ? (axis ? ", axis 2" : "")
                     : axis       ? ", loss"
                                  : ", storage");
            line[n] =
                (sn_line){label[n], SN_LINE_POINTS, n % 8, c->used, at + used, residual + used};
            n++;
            for (int i = c->first; i < c->first + c->used; i++, used++) {
                at[used] = over_time ? m->time[i] : i + 1;
                residual[used] = measured[i] - fitted[i];
            }
        }
    }
    sn_report_plot(report, &(sn_plot){.title = "Residuals",
                                      .x_label = over_time ? "time [s]" : "row",
                                      .y_label = "measured - fitted [kPa]",
                                      .y_scale = 1e-3,
                                      .log_x = over_time,
                                      .line_count = n,
                                      .line = line});
    sn_free(residual);
}

static void memory_plot(sn_report *report, const fit_outcome *o) {
    const sn_memory *memory = &o->fit->tissue.memory;
    sn_exponentials e;
    if (memory->law->param_count == 0 || !compress(o, &e)) return;
    cli_relaxation_plot(report, memory, &e);
}

sn_status fit_report(const char *path, const fit_outcome *o) {
    sn_report *report;
    const sn_fit_result *f = o->fit;
    char title[SN_TEXT_MAX];
    snprintf(title, sizeof title, "%s: %s x %s", f->tissue.name, f->tissue.law->name,
             f->tissue.memory.law->name);
    SN_TRY(sn_report_create(title, &report));
    sn_report_text(report,
                   "%d curve%s, %d points, fitted together through their recorded histories: R2 = "
                   "1 - SSE/SST = %.4f, rms error %s (%.2f %% of the largest stress), AICc %.1f.",
                   o->data->count, o->data->count == 1 ? "" : "s", f->points, f->r_squared,
                   cli_show(f->rmse, "Pa"), 100 * f->nrmse, f->aicc);
    if (!f->converged) sn_report_text(report, "The search did not converge: %s", f->reason);
    parameter_table(report, f);
    misses(report, o);
    curve_table(report, o);
    bool clock = timed(o); // a plot over time only where all curves have one
    if (clock) fit_plot(report, o, SN_CURVE_UNIAXIAL, true, false);
    fit_plot(report, o, SN_CURVE_UNIAXIAL, false, false);
    biaxial_plots(report, o, false);
    fit_plot(report, o, SN_CURVE_SHEAR, false, false);
    sweep_plots(report, o, false);
    residual_plot(report, o);
    if (o->has_held_out) {
        if (clock) fit_plot(report, o, SN_CURVE_UNIAXIAL, true, true);
        if (!clock) fit_plot(report, o, SN_CURVE_UNIAXIAL, false, true);
        biaxial_plots(report, o, true);
        sweep_plots(report, o, true);
    }
    memory_plot(report, o);
    sn_exponentials e;
    bool memory = f->tissue.memory.law->param_count > 0 && compress(o, &e);
    fit_details_plots(report, o, memory ? &e : NULL);
    fit_details_page(report, o);
    sn_report_heading(report, "Data");
    for (int k = 0; k < o->data->count; k++)
        sn_report_text(report, "%s, SHA-256 %s. %s", o->data->path[k], o->data->sha256[k],
                       o->data->curve[k].remarks);
    sn_status status = sn_report_write(report, path);
    sn_report_destroy(report);
    return status;
}
