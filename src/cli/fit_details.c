// How far a fit can be trusted: choice of terms, bootstrap, correlations, residuals, spectrum.
// SPDX-License-Identifier: Apache-2.0
// Source: slope against stress, equation (13); Durbin & Watson, Biometrika 37 (1950) 409.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/fit.h"

#define SLOPES 15 // points of slope against stress a curve

// Durbin-Watson is 2 for white residuals, with a standard error of 2/sqrt(n)
static bool wanders(const sn_fit_curve *c) {
    return c->durbin_watson < 2 - 4 / sqrt(c->used);
}

static int count_wandering(const fit_outcome *o) {
    int n = 0;
    for (int k = 0; k < o->data->count; k++) n += wanders(&o->fit->curve[k]);
    return n;
}

//---- JSON ----------------------------------------------------------------------------------------

static json_t *choice_json(const fit_outcome *o) {
    const sn_fit_choice *c = &o->choice;
    json_t *json = json_object(), *tried = json_array();
    for (int k = 0; k < c->count; k++) {
        const sn_fit_trial *t = &c->trial[k];
        json_t *row = json_object();
        cli_put_integer(row, "terms", t->terms);
        cli_put_integer(row, "constants", t->constants);
        cli_put_number(row, "aicc", t->aicc);
        cli_put_number(row, "r_squared", t->r_squared);
        cli_put_number(row, "rmse_Pa", t->rmse);
        cli_put_flag(row, "converged", t->converged);
        json_array_append_new(tried, row);
    }
    cli_put_text(json, "of", o->chose_law ? "elastic" : "memory");
    cli_put_integer(json, "chosen", c->trial[c->best].terms);
    if (c->second >= 0)
        cli_put_integer(json, "runner_up", c->trial[c->second].terms);
    else
        cli_put(json, "runner_up", json_null());
    cli_put_text(json, "reason", c->reason);
    cli_put(json, "tried", tried);
    return json;
}

void fit_details_json(json_t *json, const fit_outcome *o) {
    const sn_fit_bootstrap *b = &o->fit->bootstrap;
    cli_put_text(json, "weights", o->weights);
    if (o->chose) cli_put(json, "terms", choice_json(o));
    if (!b->asked) return;
    json_t *row = json_object();
    cli_put_integer(row, "refits", b->asked);
    cli_put_integer(row, "failed", b->asked - b->done);
    cli_put_integer(row, "seed", o->seed);
    cli_put_integer(row, "block_rows", b->block);
    cli_put_text(row, "reason", b->reason);
    cli_put(json, "bootstrap", row);
}

//---- text ----------------------------------------------------------------------------------------

void fit_details_print(const fit_outcome *o) {
    const sn_fit_result *f = o->fit;
    if (o->chose) printf("  terms: %s\n", o->choice.reason);
    if (f->determined[0]) printf("  determined: %s\n", f->determined);
    if (f->bootstrap.asked) {
        printf("  bootstrap, %d refits%s%s:\n", f->bootstrap.done,
               f->bootstrap.reason[0] ? "; " : "", f->bootstrap.reason);
        for (int k = 0; k < f->param_count; k++) {
            const sn_fit_param *p = &f->param[k];
            if (isfinite(p->ci95_bootstrap[0]))
                printf("  %-10s %-14s 95 %% interval %s to %s\n", p->name, "",
                       cli_show(p->ci95_bootstrap[0], p->unit),
                       cli_show(p->ci95_bootstrap[1], p->unit));
        }
    }
    int n = count_wandering(o);
    if (n)
        printf("  residuals of %d of %d curves are not white noise: intervals are too narrow%s\n",
               n, o->data->count,
               f->bootstrap.asked ? " but for the bootstrap's" : ", see --bootstrap");
}

//---- page ----------------------------------------------------------------------------------------

static void choice_table(sn_report *report, const sn_fit_choice *c) {
    const char *cells[(SN_FIT_TRIALS_MAX + 1) * 5];
    char text[SN_FIT_TRIALS_MAX][5][48];
    int n = 0;
    cells[n++] = "terms", cells[n++] = "constants", cells[n++] = "AICc", cells[n++] = "R2";
    cells[n++] = "rms error";
    for (int k = 0; k < c->count; k++) {
        const sn_fit_trial *t = &c->trial[k];
        snprintf(text[k][0], sizeof text[k][0], "%d%s", t->terms, k == c->best ? " (chosen)" : "");
        snprintf(text[k][1], sizeof text[k][1], "%d", t->constants);
        snprintf(text[k][2], sizeof text[k][2], "%.1f", t->aicc);
        snprintf(text[k][3], sizeof text[k][3], "%.5f", t->r_squared);
        snprintf(text[k][4], sizeof text[k][4], "%s", cli_show(t->rmse, "Pa"));
        for (int j = 0; j < 5; j++) cells[n++] = text[k][j];
    }
    char caption[SN_TEXT_MAX + 64];
    snprintf(caption, sizeof caption, "Number of terms. %s.", c->reason);
    sn_report_table(report, c->count + 1, 5, cells, caption);
}

static void bootstrap_table(sn_report *report, const fit_outcome *o) {
    const sn_fit_result *f = o->fit;
    const char *cells[(SN_FIT_PARAMS_MAX + 1) * 3];
    char text[SN_FIT_PARAMS_MAX][2][96], caption[2 * SN_TEXT_MAX];
    int n = 0, rows = 1;
    cells[n++] = "constant", cells[n++] = "95 % interval", cells[n++] = "bootstrap";
    for (int k = 0; k < f->param_count; k++) {
        const sn_fit_param *p = &f->param[k];
        if (p->fixed) continue;
        snprintf(text[k][0], sizeof text[k][0], "%s … %s", cli_show(p->ci95[0], p->unit),
                 cli_show(p->ci95[1], p->unit));
        snprintf(text[k][1], sizeof text[k][1], "%s … %s", cli_show(p->ci95_bootstrap[0], p->unit),
                 cli_show(p->ci95_bootstrap[1], p->unit));
        cells[n++] = p->name, cells[n++] = text[k][0], cells[n++] = text[k][1];
        rows++;
    }
    snprintf(
        caption, sizeof caption,
        "Percentiles of %d refits with the signs of the residuals drawn anew, in blocks of up to "
        "%d rows, seed %d. %s",
        f->bootstrap.done, f->bootstrap.block, o->seed, f->bootstrap.reason);
    sn_report_table(report, rows, 3, cells, caption);
}

static void correlation_table(sn_report *report, const sn_fit_result *f) {
    const char *cells[(SN_FIT_PARAMS_MAX + 1) * (SN_FIT_PARAMS_MAX + 1)];
    char text[SN_FIT_PARAMS_MAX * SN_FIT_PARAMS_MAX][12], caption[3 * SN_TEXT_MAX];
    int n = 0, free = 0, all = f->param_count, used = 0;
    cells[n++] = "";
    for (int k = 0; k < all; k++)
        if (!f->param[k].fixed) cells[n++] = f->param[k].name, free++;
    if (free < 2) return;
    for (int i = 0; i < all; i++) {
        if (f->param[i].fixed) continue;
        cells[n++] = f->param[i].name;
        for (int j = 0; j < all; j++) {
            if (f->param[j].fixed) continue;
            snprintf(text[used], sizeof text[used], "%.3f", f->correlation[i * all + j]);
            cells[n++] = text[used++];
        }
    }
    snprintf(caption, sizeof caption,
             "Correlation of the constants. The data know least: %s.%s%s%s", f->weakest,
             f->determined[0] ? " They do know: " : "", f->determined, f->determined[0] ? "." : "");
    sn_report_table(report, free + 1, free + 1, cells, caption);
}

static void residual_remark(sn_report *report, const fit_outcome *o) {
    int n = count_wandering(o), worst = 0;
    for (int k = 0; k < o->data->count; k++)
        if (o->fit->curve[k].durbin_watson < o->fit->curve[worst].durbin_watson) worst = k;
    const sn_fit_curve *c = &o->fit->curve[worst];
    if (n == 0) {
        sn_report_text(report,
                       "Neighbouring residuals are independent on every curve (Durbin-Watson from "
                       "%.2f, white noise has 2): the law follows the data to their noise.",
                       c->durbin_watson);
        return;
    }
    sn_report_text(
        report,
        "Neighbouring residuals are alike on %d of %d curves (Durbin-Watson down to %.2f, "
        "on %s; white noise has 2): what is left is a misfit of the law or a drift, not "
        "noise, and intervals that take it for noise are too narrow.%s",
        n, o->data->count, c->durbin_watson, cli_basename(o->data->path[worst]),
        o->fit->bootstrap.asked ? " The bootstrap draws them in blocks." : "");
}

void fit_details_page(sn_report *report, const fit_outcome *o) {
    sn_report_heading(report, "How far to trust it");
    if (o->chose) choice_table(report, &o->choice);
    if (o->fit->bootstrap.asked) bootstrap_table(report, o);
    correlation_table(report, o->fit);
    residual_remark(report, o);
}

//---- plots ---------------------------------------------------------------------------------------

// least-squares slope of y over x
static double slope_of(int n, const double *x, const double *y) {
    double mx = 0, my = 0, xx = 0, xy = 0;
    for (int i = 0; i < n; i++) mx += x[i] / n, my += y[i] / n;
    for (int i = 0; i < n; i++) {
        xx += (x[i] - mx) * (x[i] - mx);
        xy += (x[i] - mx) * (y[i] - my);
    }
    return xx > 0 ? xy / xx : (double)NAN;
}

static double mean_of(int n, const double *x) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] / n;
    return sum;
}

// stress and slope over equal parts of the first pull, up to the largest stretch
static int slopes(const sn_curve *m, const double *stress, double *x, double *y) {
    int top = 0, n = 0;
    for (int i = 0; i < m->count; i++)
        if (m->stretch[i] > m->stretch[top]) top = i;
    int parts = top / 3 < SLOPES ? top / 3 : SLOPES;
    for (int k = 0; k < parts; k++) {
        int from = k * top / parts, rows = (k + 1) * top / parts - from + 1;
        double slope = slope_of(rows, m->stretch + from, stress + from);
        if (!isfinite(slope)) continue;
        x[n] = mean_of(rows, stress + from);
        y[n++] = slope;
    }
    return n;
}

static void slope_plot(sn_report *report, const fit_outcome *o) {
    enum { LINES = 2 * SN_FIT_CURVES_MAX + 1 };
    double x[LINES - 1][SLOPES], y[LINES - 1][SLOPES], top = 0;
    sn_line line[LINES];
    int n = 0;
    for (int k = 0; k < o->data->count; k++) {
        const sn_curve *m = &o->data->curve[k];
        if (m->kind != SN_CURVE_UNIAXIAL) continue;
        const double *stress[] = {m->stress, o->fit->curve[k].predicted};
        for (int j = 0; j < 2; j++) {
            int count = slopes(m, stress[j], x[n], y[n]);
            for (int i = 0; i < count; i++) top = fmax(top, x[n][i]);
            line[n] = (sn_line){j == 0 ? cli_basename(o->data->path[k]) : NULL,
                                j == 0 ? SN_POINTS : SN_LINE,
                                k % 8,
                                count,
                                x[n],
                                y[n]};
            if (count > 1) n++;
        }
    }
    if (n == 0) return;
    double B = sn_tissue_value(&o->fit->tissue, "B"), C = sn_tissue_value(&o->fit->tissue, "C");
    double elastic_x[] = {0, top}, elastic_y[] = {C, C + B * top};
    line[n++] = (sn_line){"instantaneous: B T + C", SN_DASHED, 7, 2, elastic_x, elastic_y};
    sn_report_plot(report, &(sn_plot){.title = "Slope against stress, first pull",
                                      .x_label = "nominal stress T [kPa]",
                                      .y_label = "dT/d(stretch) [kPa]",
                                      .x_scale = 1e-3,
                                      .y_scale = 1e-3,
                                      .caption = "Points: measured, regression over parts of the "
                                                 "pull. Lines: the fit, the same way. The "
                                                 "instantaneous law is straight, equation (13); "
                                                 "relaxation during the pull lowers the slope.",
                                      .line_count = n,
                                      .line = line});
}

void fit_details_plots(sn_report *report, const fit_outcome *o, const sn_exponentials *memory) {
    if (memory && memory->terms > 0) cli_spectrum_plot(report, memory);
    if (strcmp(o->fit->tissue.law->name, "exponential") == 0) slope_plot(report, o);
}
