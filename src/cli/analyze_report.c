// sinew analyze --test cyclic, relaxation, creep, biaxial: findings, JSON and pages.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/analyze.h"

//---- cyclic --------------------------------------------------------------------------------------

static const char *const definition =
    "hysteresis = loop area / area under the loading curve, nominal stress";

static json_t *cyclic_json(const sn_cycles *r) {
    json_t *json = json_object(), *cycles = json_array();
    for (int i = 0; i < r->count; i++) {
        const sn_cycle *c = &r->cycle[i];
        json_t *row = json_object();
        cli_put_number(row, "hysteresis", c->hysteresis);
        cli_put_number(row, "loading_area_J_per_m3", c->loading_area);
        cli_put_number(row, "loop_area_J_per_m3", c->loop_area);
        cli_put_number(row, "peak_stress_Pa", c->peak_stress);
        json_array_append_new(cycles, row);
    }
    cli_put(json, "cycles", cycles);
    cli_put_text(json, "definition", definition);
    cli_put_number(json, "peak_stress_change", r->peak_change);
    cli_put_number(json, "hysteresis_change", r->hysteresis_change);
    if (r->preconditioned_after > 0) {
        cli_put_integer(json, "preconditioned_after_cycle", r->preconditioned_after);
    } else {
        cli_put_number(json, "preconditioned_after_cycle", (double)NAN);
        cli_put_text(json, "reason", r->reason);
    }
    return json;
}

// the loops, and how they settle
static sn_status cyclic_page(const sn_curve *curve, const sn_cycles *r, sn_report *report) {
    int first = r->cycle[0].first, last = r->cycle[r->count - 1].last, n = last - first + 1;
    const sn_cycle *end = &r->cycle[r->count - 1];
    sn_line loops[] = {{"measured", SN_LINE, 0, n, curve->stretch + first, curve->stress + first},
                       {"last cycle", SN_LINE, 1, end->last - end->first + 1,
                        curve->stretch + end->first, curve->stress + end->first}};
    analyze_stress_plot(report, "Cycles", "stretch [1]", false, r->count > 1 ? 2 : 1, loops);
    if (r->count < 2) return SN_OK;
    double *x = sn_alloc(3 * (size_t)r->count, sizeof *x);
    if (!x) return SN_E_MEMORY;
    double *peak = x + r->count, *hysteresis = peak + r->count;
    for (int i = 0; i < r->count; i++) {
        x[i] = i + 1;
        peak[i] = r->cycle[i].peak_stress;
        hysteresis[i] = r->cycle[i].hysteresis;
    }
    sn_line line = {"hysteresis", SN_LINE_POINTS, 0, r->count, x, hysteresis};
    sn_report_plot(report, &(sn_plot){.title = "Hysteresis from cycle to cycle",
                                      .x_label = "cycle",
                                      .y_label = "hysteresis [1]",
                                      .line_count = 1,
                                      .line = &line});
    line = (sn_line){"peak stress", SN_LINE_POINTS, 0, r->count, x, peak};
    analyze_stress_plot(report, "Peak stress from cycle to cycle", "cycle", false, 1, &line);
    sn_free(x);
    return SN_OK;
}

static void cycle_table(const sn_cycles *r, sn_report *report) {
    enum { COLUMNS = 5, ROWS_MAX = 40, WIDTH = 48 };
    char text[ROWS_MAX * COLUMNS][WIDTH];
    const char *cells[(ROWS_MAX + 1) * COLUMNS] = {"cycle", "hysteresis", "loading area",
                                                   "loop area", "peak stress"};
    int shown = r->count < ROWS_MAX ? r->count : ROWS_MAX;
    for (int i = 0; i < shown; i++) {
        const sn_cycle *c = &r->cycle[i];
        char(*row)[WIDTH] = text + (size_t)i * COLUMNS;
        snprintf(row[0], WIDTH, "%d", i + 1);
        snprintf(row[1], WIDTH, "%.4f", c->hysteresis);
        snprintf(row[2], WIDTH, "%.4g J/m3", c->loading_area);
        snprintf(row[3], WIDTH, "%.4g J/m3", c->loop_area);
        snprintf(row[4], WIDTH, "%s", cli_show(c->peak_stress, "Pa"));
        for (int k = 0; k < COLUMNS; k++) cells[(i + 1) * COLUMNS + k] = row[k];
    }
    sn_report_table(report, shown + 1, COLUMNS, cells,
                    shown < r->count ? "The first cycles; all are in analysis.json" : "Cycles");
}

sn_status analyze_cyclic(const sn_curve *curve, analysis *a) {
    sn_cycles r;
    SN_TRY(sn_reduce_cyclic(curve, &r));
    a->json = cyclic_json(&r);
    for (int i = 0; i < r.count; i++) {
        const sn_cycle *c = &r.cycle[i];
        char what[32], value[160];
        snprintf(what, sizeof what, "cycle %d", i + 1);
        snprintf(value, sizeof value, "hysteresis %.4f, peak %s", c->hysteresis,
                 cli_show(c->peak_stress, "Pa"));
        analyze_say(a, what, value, "");
    }
    char peak[32] = "—", hysteresis[32] = "—", settled[32] = "—";
    if (isfinite(r.peak_change)) snprintf(peak, sizeof peak, "%.2f %%", 100 * r.peak_change);
    if (isfinite(r.hysteresis_change))
        snprintf(hysteresis, sizeof hysteresis, "%.2f %%", 100 * r.hysteresis_change);
    if (r.preconditioned_after > 0)
        snprintf(settled, sizeof settled, "cycle %d", r.preconditioned_after);
    const finding found[] = {
        {"last change of the peak stress", peak, NULL},
        {"last change of the hysteresis", hysteresis, definition},
        {"preconditioned after", settled,
         *r.reason ? r.reason : "no later cycle differs from the one before by more than 2 %"},
    };
    PRESENT(a, "Preconditioning", found);
    analyze_discard(a, r.discarded, r.remarks);
    sn_status status = SN_OK;
    if (a->report) {
        cycle_table(&r, a->report);
        status = cyclic_page(curve, &r, a->report);
    }
    sn_cycles_release(&r);
    return status;
}

//---- relaxation ----------------------------------------------------------------------------------

static json_t *relaxation_json(const sn_relaxation_result *r) {
    json_t *json = json_object(), *curve = json_array();
    cli_put_number(json, "peak_stress_Pa", r->peak_stress);
    cli_put_number(json, "relaxed_fraction", r->relaxed_fraction);
    cli_put_number(json, "rate_per_decade", r->rate_per_decade);
    cli_put_number(json, "ramp_s", r->ramp_s);
    cli_put_number(json, "hold_s", r->hold_s);
    cli_put_number(json, "final_stress_Pa", r->final_stress);
    cli_put_number(json, "held_stretch", r->held_stretch);
    cli_put_number(json, "overshoot", r->overshoot);
    cli_put_integer(json, "steps", r->steps);
    cli_put_integer(json, "step", r->step);
    for (int k = 0; k < r->points; k++) {
        json_t *point = json_object();
        cli_put_number(point, "time_s", r->point_s[k]);
        cli_put_number(point, "stress_over_peak", r->point_G[k]);
        json_array_append_new(curve, point);
    }
    cli_put(json, "relaxation", curve);
    return json;
}

// stress over peak on log time since the peak
static sn_status fall_plot(const sn_curve *curve, const sn_relaxation_result *r,
                           sn_report *report) {
    int n = r->last - r->peak;
    double *x = sn_alloc(2 * (size_t)(n > 0 ? n : 1), sizeof *x);
    if (!x) return SN_E_MEMORY;
    for (int i = 0; i < n; i++) {
        x[i] = curve->time[r->peak + 1 + i] - curve->time[r->peak];
        x[n + i] = curve->stress[r->peak + 1 + i] / r->peak_stress;
    }
    sn_line line[] = {
        {"measured", SN_POINTS, 0, n, x, x + n},
        {"means over tenths of a decade", SN_LINE, 1, r->points, r->point_s, r->point_G}};
    sn_report_plot(report, &(sn_plot){.title = "Relaxation",
                                      .x_label = "time since the peak [s]",
                                      .y_label = "stress over peak [1]",
                                      .log_x = true,
                                      .line_count = 2,
                                      .line = line});
    sn_free(x);
    return SN_OK;
}

static sn_status relaxation_page(const sn_curve *curve, const sn_relaxation_result *r,
                                 sn_report *report) {
    int n = r->last - r->start + 1;
    bool part = n < curve->count;
    SN_TRY(fall_plot(curve, r, report));
    sn_line line[] = {
        {"used", ANALYZE_MARKS(n), 0, n, curve->time + r->start, curve->stress + r->start},
        {"whole record", SN_LINE, 7, curve->count, curve->time, curve->stress}};
    analyze_stress_plot(report, "Stress over time", "time [s]", false, part ? 2 : 1, line);
    line[0].y = curve->stretch + r->start;
    line[1].y = curve->stretch;
    sn_report_plot(report, &(sn_plot){.title = "Stretch over time",
                                      .x_label = "time [s]",
                                      .y_label = "stretch [1]",
                                      .line_count = part ? 2 : 1,
                                      .line = line});
    line[0] = (sn_line){
        "measured", SN_LINE_POINTS, 0, n, curve->stretch + r->start, curve->stress + r->start};
    analyze_stress_plot(report, "Stress against stretch", "stretch [1]", false, 1, line);
    return SN_OK;
}

sn_status analyze_relaxation(const sn_curve *curve, analysis *a) {
    sn_relaxation_result r;
    SN_TRY(sn_reduce_relaxation(curve, &r));
    a->json = relaxation_json(&r);
    char fraction[32], rate[32], held[64], overshoot[64];
    snprintf(fraction, sizeof fraction, "%.1f %%", 100 * r.relaxed_fraction);
    snprintf(rate, sizeof rate, "%.1f %%", 100 * r.rate_per_decade);
    snprintf(held, sizeof held, "%.6g", r.held_stretch);
    snprintf(overshoot, sizeof overshoot, "%.1f %%", 100 * r.overshoot);
    const finding found[] = {
        {"ramp", cli_show(r.ramp_s, "s"), NULL},
        {"hold", cli_show(r.hold_s, "s"), NULL},
        {"held stretch", held, NULL},
        {"overshoot of the ramp", overshoot, "of its way"},
        {"peak stress", cli_show(r.peak_stress, "Pa"), NULL},
        {"final stress", cli_show(r.final_stress, "Pa"), NULL},
        {"relaxed fraction", fraction, "of the peak"},
        {"relaxation per decade of time", rate, "of the peak"},
    };
    PRESENT(a, "Relaxation", found);
    analyze_discard(a, r.discarded, r.remarks);
    return a->report ? relaxation_page(curve, &r, a->report) : SN_OK;
}

//---- creep ---------------------------------------------------------------------------------------

static void creep_plot(const sn_curve *curve, sn_report *report) {
    sn_line line = {"measured",    ANALYZE_MARKS(curve->count), 0, curve->count, curve->time,
                    curve->stretch};
    sn_report_plot(report, &(sn_plot){.title = "Stretch over time",
                                      .x_label = "time [s]",
                                      .y_label = "stretch [1]",
                                      .line_count = 1,
                                      .line = &line});
    line.y = curve->stress;
    analyze_stress_plot(report, "Stress over time", "time [s]", false, 1, &line);
}

sn_status analyze_creep(const sn_curve *curve, analysis *a) {
    sn_creep_result r;
    SN_TRY(sn_reduce_creep(curve, &r));
    a->json = json_object();
    cli_put_number(a->json, "compliance_per_Pa", r.compliance);
    cli_put_number(a->json, "initial_compliance_per_Pa", r.initial_compliance);
    cli_put_number(a->json, "creep_rate_per_s", r.creep_rate);
    cli_put_number(a->json, "time_to_rupture_s", r.time_to_rupture);
    cli_put_number(a->json, "recovered_fraction", r.recovered_fraction);
    if (*r.rupture_reason) cli_put_text(a->json, "rupture_reason", r.rupture_reason);
    if (*r.recovery_reason) cli_put_text(a->json, "recovery_reason", r.recovery_reason);
    cli_put_number(a->json, "stress_Pa", r.stress);
    cli_put_number(a->json, "ramp_s", r.ramp_s);
    cli_put_number(a->json, "hold_s", r.hold_s);
    char initial[64], compliance[64], rate[64], recovered[64] = "—";
    snprintf(initial, sizeof initial, "%.4g 1/Pa", r.initial_compliance);
    snprintf(compliance, sizeof compliance, "%.4g 1/Pa", r.compliance);
    snprintf(rate, sizeof rate, "%.4g 1/s", r.creep_rate);
    if (isfinite(r.recovered_fraction))
        snprintf(recovered, sizeof recovered, "%.1f %%", 100 * r.recovered_fraction);
    const finding found[] = {
        {"held stress", cli_show(r.stress, "Pa"), NULL},
        {"loading", cli_show(r.ramp_s, "s"), NULL},
        {"hold", cli_show(r.hold_s, "s"), NULL},
        {"compliance, start of the hold", initial, NULL},
        {"compliance, end of the hold", compliance, NULL},
        {"creep rate, smallest", rate, NULL},
        {"time to rupture", cli_show(r.time_to_rupture, "s"), r.rupture_reason},
        {"recovered, of the strain", recovered, r.recovery_reason},
    };
    PRESENT(a, "Creep", found);
    analyze_discard(a, 0, r.remarks);
    if (a->report) creep_plot(curve, a->report);
    return SN_OK;
}

//---- biaxial -------------------------------------------------------------------------------------

static json_t *biaxial_json(const sn_biaxial_result *r) {
    static const char *const keys[2][4] = {
        {"peak_stretch_1", "peak_stress_1_Pa", "low_modulus_1_Pa", "high_modulus_1_Pa"},
        {"peak_stretch_2", "peak_stress_2_Pa", "low_modulus_2_Pa", "high_modulus_2_Pa"}};
    json_t *json = json_object();
    for (int k = 0; k < 2; k++) {
        cli_put_number(json, keys[k][0], r->axis[k].peak_stretch);
        cli_put_number(json, keys[k][1], r->axis[k].peak_stress);
        cli_put_number(json, keys[k][2], r->axis[k].low_modulus);
        cli_put_number(json, keys[k][3], r->axis[k].high_modulus);
    }
    cli_put_number(json, "stress_ratio", r->stress_ratio);
    cli_put_number(json, "stretch_ratio", r->stretch_ratio);
    cli_put_number(json, "anisotropy", r->anisotropy);
    cli_put_number(json, "strain_energy_J_per_m3", r->energy);
    return json;
}

sn_status analyze_biaxial(const sn_curve *curve, analysis *a) {
    sn_biaxial_result r;
    SN_TRY(sn_reduce_biaxial(curve, &r));
    a->json = biaxial_json(&r);
    char stretches[64], stresses[64], index[32], energy[64];
    snprintf(stretches, sizeof stretches, "at stretches %.4g and %.4g", r.axis[0].peak_stretch,
             r.axis[1].peak_stretch);
    snprintf(stresses, sizeof stresses, "strains %s", cli_show(r.stretch_ratio, "1"));
    snprintf(index, sizeof index, "%.3f", r.anisotropy);
    snprintf(energy, sizeof energy, "%.4g J/m3", r.energy);
    const finding found[] = {
        {"peak stress, axis 1", cli_show(r.axis[0].peak_stress, "Pa"), stretches},
        {"peak stress, axis 2", cli_show(r.axis[1].peak_stress, "Pa"), NULL},
        {"modulus at low stretch, axis 1", cli_show(r.axis[0].low_modulus, "Pa"), "first fifth"},
        {"modulus at low stretch, axis 2", cli_show(r.axis[1].low_modulus, "Pa"), NULL},
        {"modulus at high stretch, axis 1", cli_show(r.axis[0].high_modulus, "Pa"), "last fifth"},
        {"modulus at high stretch, axis 2", cli_show(r.axis[1].high_modulus, "Pa"), NULL},
        {"ratio 1 to 2 at the peak, stresses", cli_show(r.stress_ratio, "1"), stresses},
        {"anisotropy", index, "above 0: axis 1 is stiffer"},
        {"strain energy at the peak", energy, NULL},
    };
    PRESENT(a, "Biaxial tension", found);
    if (!a->report) return SN_OK;
    const sn_line lines[] = {
        {"axis 1", SN_LINE_POINTS, 0, curve->count, curve->stretch, curve->stress},
        {"axis 2", SN_LINE_POINTS, 1, curve->count, curve->stretch_2, curve->stress_2}};
    analyze_stress_plot(a->report, "Stress against stretch, both axes", "stretch [1]", false, 2,
                        lines);
    return SN_OK;
}
