// sinew bench fit: how long a fit takes, and what a plain convolution would.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/cli.h"

#define RAMPS 4
#define RAMP_ROWS 500
#define CYCLES 50
#define CYCLE_ROWS 100000

static sn_tissue bench_tissue(void) {
    sn_tissue t = sn_tissue_default();
    t.law = sn_law_find("exponential");
    sn_tissue_set(&t, "B", 12);
    sn_tissue_set(&t, "C", 10e3);
    t.memory = (sn_memory){.law = sn_memory_law_find("fung-spectrum"), .value = {0.15, 0.08, 60}};
    return t;
}

static sn_status virtual_curve(const sn_tissue *tissue, const sn_protocol *protocol,
                               sn_curve *curve) {
    sn_record *record = NULL;
    sn_status status = sn_lab_test(tissue, protocol, &record);
    if (status == SN_OK) status = sn_curve_from_record(record, curve);
    sn_record_destroy(record);
    return status;
}

// four ramps and holds, 2000 rows in all
static sn_status ramps(const sn_tissue *tissue, sn_curve *curve) {
    static const double ramp[RAMPS] = {0.05, 1, 20, 100};
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_RELAXATION);
    p.stretch = 1.15;
    p.hold = 300;
    p.points = RAMP_ROWS;
    for (int k = 0; k < RAMPS; k++) {
        p.ramp = ramp[k];
        SN_TRY(virtual_curve(tissue, &p, &curve[k]));
    }
    return SN_OK;
}

static sn_status cycles(const sn_tissue *tissue, sn_curve *curve) {
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_CYCLIC);
    p.stretch = 1.15;
    p.ramp = 1;
    p.cycles = CYCLES;
    p.points = CYCLE_ROWS;
    return virtual_curve(tissue, &p, curve);
}

static sn_status time_fit(const sn_tissue *tissue, const sn_curve *curve, int count,
                          double *seconds, int *evaluations) {
    sn_fit_def def = sn_fit_def_default();
    def.curve = curve;
    def.curve_count = count;
    def.law = tissue->law;
    def.memory = tissue->memory.law;
    sn_fit_result *result = sn_alloc(1, sizeof *result);
    if (!result) return SN_E_MEMORY;
    double start = sn_clock();
    sn_status status = sn_fit(&def, result);
    *seconds = sn_clock() - start;
    *evaluations = result->evaluations;
    if (status == SN_OK) sn_fit_release(result);
    sn_free(result);
    return status;
}

// One curve by the hereditary integral as it stands, a sum over all earlier rows with G from its
// closed form; and by the recursion. Both once.
static sn_status time_models(const sn_tissue *tissue, const sn_curve *curve, double *direct,
                             double *recursion) {
    sn_fit_curve prediction = {0};
    double start = sn_clock(), sum = 0, B = tissue->value[0], C = tissue->value[1];
    for (int i = 0; i < curve->count; i++)
        for (int j = 1; j <= i; j++) {
            double middle = 0.5 * (curve->time[j] + curve->time[j - 1]);
            double rise =
                C / B * (exp(B * (curve->stretch[j] - 1)) - exp(B * (curve->stretch[j - 1] - 1)));
            sum += sn_memory_relaxation(&tissue->memory, curve->time[i] - middle) * rise;
        }
    *direct = sn_clock() - start;
    if (!isfinite(sum)) return sn_fail(SN_E_SOLVER, "bench: the convolution is not finite");
    start = sn_clock();
    sn_status status = sn_fit_predict(tissue, curve, &prediction);
    *recursion = sn_clock() - start;
    sn_free(prediction.predicted);
    return status;
}

typedef struct fit_times {
    double ramps, cycles, direct, recursion;
    int ramp_evaluations, cycle_evaluations;
} fit_times;

static sn_status measure(fit_times *t) {
    sn_tissue tissue = bench_tissue();
    sn_curve curve[RAMPS] = {0}, cyclic = {0};
    sn_status status;
    SN_TRY_GOTO(status, ramps(&tissue, curve));
    SN_TRY_GOTO(status, time_fit(&tissue, curve, RAMPS, &t->ramps, &t->ramp_evaluations));
    SN_TRY_GOTO(status, time_models(&tissue, &curve[1], &t->direct, &t->recursion));
    SN_TRY_GOTO(status, cycles(&tissue, &cyclic));
    SN_TRY_GOTO(status, time_fit(&tissue, &cyclic, 1, &t->cycles, &t->cycle_evaluations));
fail:
    for (int k = 0; k < RAMPS; k++) sn_curve_release(&curve[k]);
    sn_curve_release(&cyclic);
    return status;
}

static json_t *row(const char *what, int points, double seconds, int evaluations) {
    json_t *json = json_object();
    cli_put_text(json, "what", what);
    cli_put_integer(json, "points", points);
    cli_put_number(json, "seconds", seconds);
    cli_put_integer(json, "evaluations", evaluations);
    return json;
}

int cli_bench_fit(const cli_arguments *arguments) {
    char machine[256];
    fit_times t;
    cli_machine(machine, sizeof machine);
    sn_status status = measure(&t);
    if (status != SN_OK) return cli_fail(status);
    if (!arguments->json && !arguments->quiet) {
        printf("%s, one thread: exponential x fung-spectrum\n", machine);
        printf("  fit of four ramps, %6d points   %s, %d evaluations\n", RAMPS * RAMP_ROWS,
               cli_show(t.ramps, "s"), t.ramp_evaluations);
        printf("  fit of %d cycles,  %6d points   %s, %d evaluations\n", CYCLES, CYCLE_ROWS,
               cli_show(t.cycles, "s"), t.cycle_evaluations);
        printf("  one curve, %d points: direct convolution %s, recursion %s (%.0f times)\n",
               RAMP_ROWS, cli_show(t.direct, "s"), cli_show(t.recursion, "s"),
               t.direct / t.recursion);
    }
    json_t *json = json_object(), *results = json_array();
    json_array_append_new(results,
                          row("four ramps", RAMPS * RAMP_ROWS, t.ramps, t.ramp_evaluations));
    json_array_append_new(results, row("cycles", CYCLE_ROWS, t.cycles, t.cycle_evaluations));
    cli_put_number(json, "direct_convolution_s", t.direct);
    cli_put_number(json, "recursion_s", t.recursion);
    return cli_bench_end(arguments, json, results);
}
