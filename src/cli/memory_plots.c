// Plots of a memory: its relaxation function, and the exponentials that stand for it.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/cli.h"

enum { POINTS = 200 };

void cli_relaxation_plot(sn_report *report, const sn_memory *memory, const sn_exponentials *e) {
    double t[POINTS], exact[POINTS], sum[POINTS];
    for (int i = 0; i < POINTS; i++) {
        t[i] = e->t_min * pow(e->t_max / e->t_min, i / (POINTS - 1.0));
        exact[i] = sn_memory_relaxation(memory, t[i]);
        sum[i] = sn_exponentials_at(e, t[i]);
    }
    char label[64], caption[256];
    snprintf(label, sizeof label, "%d exponential%s", e->terms, e->terms == 1 ? "" : "s");
    snprintf(caption, sizeof caption,
             "The memory and the %s that stand for it: largest error %.2g of G(0) from %s to %s.",
             label, e->max_error, cli_show(e->t_min, "s"), cli_show(e->t_max, "s"));
    sn_line line[] = {{memory->law->name, SN_LINE, 0, POINTS, t, exact},
                      {label, SN_DASHED, 1, POINTS, t, sum}};
    sn_report_plot(report, &(sn_plot){.title = "Reduced relaxation function",
                                      .x_label = "time [s]",
                                      .y_label = "G [1]",
                                      .caption = caption,
                                      .log_x = true,
                                      .line_count = 2,
                                      .line = line});
}

void cli_spectrum_plot(sn_report *report, const sn_exponentials *e) {
    sn_line bars = {NULL, SN_BARS, 2, e->terms, e->tau, e->g};
    char caption[128];
    snprintf(caption, sizeof caption,
             "Weights of the exponentials at their times. What never relaxes: %.4g.", e->g_inf);
    sn_report_plot(report, &(sn_plot){.title = "Spectrum",
                                      .x_label = "relaxation time [s]",
                                      .y_label = "weight g [1]",
                                      .caption = caption,
                                      .log_x = true,
                                      .line_count = 1,
                                      .line = &bars});
}
