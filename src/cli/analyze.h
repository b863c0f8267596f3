// What the methods of analyze share: one set of findings for the terminal, the page and JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

typedef struct analysis {
    const char *path, *test;
    int rows;
    bool headed; ///< the heading has been printed
    json_t *json;
    sn_report *report;             ///< NULL without --out
    bool quiet;                    ///< nothing on standard output but JSON
    sn_tensile_def def;            ///< options of the tensile method
    int discarded;                 ///< rows that the reduction left out
    char remarks[SN_TEXT_MAX * 2]; ///< what it did to the data
} analysis;

/// One line of a result: on standard output and in the table of the page.
typedef struct finding {
    const char *what, *value;
    const char *remark; ///< Nullable
} finding;

#define FINDINGS_MAX 24

/// A line on standard output, after the heading.
void analyze_say(analysis *a, const char *what, const char *value, const char *remark);
/// Findings on standard output and as a table of the page.
void analyze_present(analysis *a, const char *caption, int count, const finding *f);
#define PRESENT(a, caption, findings)                                                              \
    analyze_present(a, caption, (int)(sizeof(findings) / sizeof(findings)[0]), findings)
/// Style of a line through n rows: marks where they are few enough to be told apart.
#define ANALYZE_MARKS(n) ((n) > 100 ? SN_LINE : SN_LINE_POINTS)
/// Which rows a reduction used and left out.
void analyze_discard(analysis *a, int rows, const char *remarks);
/// A plot of nominal stress in kPa.
void analyze_stress_plot(sn_report *report, const char *title, const char *x_label, bool log_x,
                         int lines, const sn_line *line);

// The methods: a curve, or the record of a sweep, to a->json and the page.
sn_status analyze_tensile(const sn_curve *curve, analysis *a);
sn_status analyze_cyclic(const sn_curve *curve, analysis *a);
sn_status analyze_relaxation(const sn_curve *curve, analysis *a);
sn_status analyze_creep(const sn_curve *curve, analysis *a);
sn_status analyze_biaxial(const sn_curve *curve, analysis *a);
sn_status analyze_sinusoids(const sn_curve *curve, analysis *a);
sn_status analyze_sweep(const sn_record *record, analysis *a);
