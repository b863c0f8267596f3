// sinew analyze --test tensile: findings, JSON and page.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/analyze.h"

static json_t *tensile_json(const sn_tensile *r, const analysis *a) {
    json_t *json = json_object(), *slope = json_object();
    cli_put_number(json, "youngs_modulus_Pa", r->youngs_modulus);
    cli_put_number(json, "youngs_modulus_error_Pa", r->youngs_modulus_error);
    cli_put_text(json, "modulus_method", r->modulus_method);
    cli_put_number(json, "chord_modulus_Pa", r->chord_modulus);
    cli_put_number(json, "toe_modulus_Pa", r->toe_modulus);
    cli_put_number(json, "toe_limit_strain", r->toe_limit);
    cli_put_number(json, "toe_limit_stress_Pa", r->toe_stress);
    if (*r->toe_reason) cli_put_text(json, "toe_reason", r->toe_reason);
    cli_put_number(json, "max_slope_modulus_Pa", r->max_slope_modulus);
    cli_put_number(json, "yield_stress_Pa", r->yield_stress);
    cli_put_number(json, "yield_strain", r->yield_strain);
    if (*r->reason) cli_put_text(json, "reason", r->reason);
    cli_put_number(json, "ultimate_tensile_strength_Pa", r->ultimate_tensile_strength);
    cli_put_number(json, "strain_at_ultimate", r->strain_at_ultimate);
    cli_put_number(json, "work_to_failure_J_per_m3", r->work_to_failure);
    cli_put_number(json, "preload_Pa", a->def.preload > 0.0 ? a->def.preload : (double)NAN);
    cli_put_number(json, "stretch_at_zero_strain", r->preload_stretch);
    cli_put_number(json, "stress_noise_Pa", r->stress_noise);
    cli_put_integer(json, "loading_ramps", r->ramps);
    cli_put_integer(json, "loading_ramp", r->ramp);
    cli_put_number(slope, "B", r->B);
    cli_put_number(slope, "C_Pa", r->C);
    cli_put_number(slope, "r_squared", r->slope_r_squared);
    cli_put_number(slope, "window_strain", r->slope_window);
    cli_put_number(slope, "bend", r->slope_curvature);
    cli_put_number(slope, "bend_over_error", r->slope_curvature_t);
    cli_put_text(slope, "test", r->slope_test);
    cli_put(json, "slope_stress", slope);
    return json;
}

// the ramp with what was read off it
static void curve_plot(const sn_curve *curve, const sn_tensile *r, sn_report *report) {
    int n = r->last - r->first + 1, w = r->window_last - r->window_first + 1, lines = 0;
    const double *x = curve->stretch, *y = curve->stress;
    sn_line line[6];
    if (n < curve->count) line[lines++] = (sn_line){"whole record", SN_LINE, 7, curve->count, x, y};
    line[lines++] = (sn_line){"loading ramp", ANALYZE_MARKS(n), 0, n, x + r->first, y + r->first};
    line[lines++] =
        (sn_line){"window of the modulus", SN_LINE, 1, w, x + r->window_first, y + r->window_first};
    double toe = r->preload_stretch * (1.0 + r->toe_limit), toe_stress = r->toe_stress;
    if (isfinite(toe))
        line[lines++] = (sn_line){"end of the toe", SN_POINTS, 2, 1, &toe, &toe_stress};
    // the offset line from zero stress to the yield
    double at[2] = {r->preload_stretch *
                        (1.0 + r->yield_strain - r->yield_stress / r->youngs_modulus),
                    r->preload_stretch * (1.0 + r->yield_strain)};
    double stress[2] = {0.0, r->yield_stress};
    if (isfinite(r->yield_stress)) {
        line[lines++] = (sn_line){"0.2 % offset", SN_DASHED, 3, 2, at, stress};
        line[lines++] = (sn_line){"yield", SN_POINTS, 3, 1, at + 1, stress + 1};
    }
    analyze_stress_plot(report, "Stress against stretch", "stretch [1]", false, lines, line);
}

static void slope_plot(const sn_tensile *r, sn_report *report) {
    if (r->slope_count < 2) return;
    double low = r->slope_stress[0], high = low;
    for (int i = 0; i < r->slope_count; i++) {
        low = fmin(low, r->slope_stress[i]);
        high = fmax(high, r->slope_stress[i]);
    }
    double x[2] = {low, high}, y[2] = {r->B * low + r->C, r->B * high + r->C};
    char caption[SN_TEXT_MAX * 2];
    snprintf(caption, sizeof caption,
             "Slopes of least-squares lines over a strain of %.3g. Equation (13) is a straight "
             "line here; %s.",
             r->slope_window, r->slope_test);
    sn_line line[] = {{"measured", SN_POINTS, 0, r->slope_count, r->slope_stress, r->slope},
                      {"B T + C", SN_LINE, 1, 2, x, y}};
    sn_report_plot(report, &(sn_plot){.title = "Slope against stress",
                                      .x_label = "nominal stress [kPa]",
                                      .y_label = "slope [kPa]",
                                      .caption = caption,
                                      .x_scale = 1e-3,
                                      .y_scale = 1e-3,
                                      .line_count = 2,
                                      .line = line});
}

sn_status analyze_tensile(const sn_curve *curve, analysis *a) {
    sn_tensile r;
    SN_TRY(sn_reduce_tensile(curve, &a->def, &r));
    a->json = tensile_json(&r, a);
    char work[64], slope[128], squared[512], error[64], preload[96], zero[64], noise[64];
    snprintf(work, sizeof work, "%.4g J/m3", r.work_to_failure);
    snprintf(slope, sizeof slope, "B = %.4g, C = %s", r.B, cli_show(r.C, "Pa"));
    snprintf(squared, sizeof squared, "R2 of the line %.4f; %s", r.slope_r_squared, r.slope_test);
    snprintf(error, sizeof error, "%s ± %s", cli_show(r.youngs_modulus, "Pa"),
             cli_show(r.youngs_modulus_error, "Pa"));
    snprintf(zero, sizeof zero, "stretch %.6g", r.preload_stretch);
    snprintf(preload, sizeof preload, "preload of %s", cli_show(a->def.preload, "Pa"));
    snprintf(noise, sizeof noise, "%s", cli_show(r.stress_noise, "Pa"));
    const finding found[] = {
        {"zero of strain", zero, a->def.preload > 0.0 ? preload : "no preload"},
        {"Young's modulus", error, r.modulus_method},
        {"chord modulus", cli_show(r.chord_modulus, "Pa"), "between the ends of that window"},
        {"toe modulus", cli_show(r.toe_modulus, "Pa"), "first tenth of the strain"},
        {"end of the toe, strain", cli_show(r.toe_limit, "1"),
         *r.toe_reason ? r.toe_reason : "the slope reaches half of the steepest"},
        {"largest slope", cli_show(r.max_slope_modulus, "Pa"), "steepest tenth of the strain"},
        {"yield stress, 0.2 % offset", cli_show(r.yield_stress, "Pa"), r.reason},
        {"ultimate tensile strength", cli_show(r.ultimate_tensile_strength, "Pa"), NULL},
        {"strain at ultimate", cli_show(r.strain_at_ultimate, "1"), NULL},
        {"work to failure", work, NULL},
        {"slope against stress (13)", slope, squared},
        {"scatter of the stress", noise, NULL},
    };
    PRESENT(a, "Tension", found);
    analyze_discard(a, r.discarded, r.remarks);
    if (a->report) {
        curve_plot(curve, &r, a->report);
        slope_plot(&r, a->report);
    }
    sn_tensile_release(&r);
    return SN_OK;
}
