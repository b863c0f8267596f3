// sinew compare: its cases, meshes and models, and what its files share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

enum { COMPARE_MESHES_MAX = 8 };

/// One model on one mesh of one case.
typedef struct compare_run {
    int model, mesh; ///< index of the model; factor on the cells
    bool left_out;   ///< `why` says why the default leaves it out
    char why[SN_TEXT_MAX];
    sn_comparison_model result;
} compare_run;

/// One case with all its runs.
typedef struct compare_case {
    const char *path;
    char folder[SN_NAME_MAX]; ///< its own under that of the results, where there are several cases
    sn_case *c;               ///< as read, on its own mesh
    int reference_mesh;       ///< factor on the cells of the reference
    sn_reference reference;   ///< once all is done without the fields of its frames
    int run_count;
    compare_run *run;
} compare_case;

/// A whole comparison.
typedef struct compare_study {
    int case_count;
    compare_case *item;
    int mesh_count, mesh[COMPARE_MESHES_MAX];
    bool models_given;
    int model_count, model[SN_COMPARE_MODELS_MAX];
    int jobs;
    const char *folder; ///< Nullable: nothing is kept
    cli_progress progress;
    double work, done; ///< of what is to be computed, in units of compare_work.c
} compare_study;

//---- compare_work.c ------------------------------------------------------------------------------

/// Runs what is not kept in the folder from before, and keeps it.
sn_status compare_work(compare_study *study);
void compare_study_release(compare_study *study);

//---- compare_keep.c ------------------------------------------------------------------------------

/// A key of a run: of all of the case that the answer depends on, the model and its mesh, and the
/// version of this program. 16 hexadecimal digits and a closing zero.
void compare_key(const sn_case *c, const char *model, int mesh, const char *reference,
                 char key[17]);
/// Files in folder/kept, written to a temporary name and renamed. A file that cannot be read for
/// whatever reason is one that is not there: false.
bool compare_kept_model(const char *folder, const char *key, sn_comparison_model *model);
bool compare_kept_reference(const char *folder, const char *key, sn_reference *reference);
sn_status compare_keep_model(const char *folder, const char *key, const sn_comparison_model *model);
sn_status compare_keep_reference(const char *folder, const char *key,
                                 const sn_reference *reference);

//---- compare_words.c -----------------------------------------------------------------------------

/// One number for a model: the larger of the errors of displacement (rms) and of what answers; NAN
/// where it did not run to its end.
double compare_main_error(const sn_comparison_model *model);
/// Error as a percentage: "1.23 %", "—".
const char *compare_percent(double value);
/// One model on one mesh over all cases of a study.
typedef struct compare_summary {
    int model, mesh;
    int cases, missing;          ///< that ran to their end; that did not
    double worst, median;        ///< of compare_main_error()
    double displacement, answer; ///< worst of each
    double relaxation;           ///< worst; NAN where no case has a memory
    double wall_s;               ///< sum
    double slowest;              ///< least live real-time factor; NAN where there is none
    int nodes;                   ///< most of any case
    char worst_case[SN_NAME_MAX];
} compare_summary;
/// Rows for all models on all meshes. *rows is sn_alloc'd. @return their number, -1 without memory
int compare_summarise(const compare_study *study, compare_summary **rows);
/// Which rung to use for which error, in plain words, by the rules that are at the head of
/// compare_words.c. One call of `say` a paragraph.
void compare_words(const compare_study *study, const compare_case *only,
                   void (*say)(void *context, const char *text), void *context);

//---- compare_page.c, compare_overview.c ----------------------------------------------------------

/// report.html of one case.
sn_status compare_write_page(const char *path, const compare_study *study, const compare_case *one);
/// Draws errors, from 0 to 1, over what the plot says, both logarithmic; nothing without a line.
void compare_error_plot(sn_report *report, const sn_plot *plot);
/// What compare_words() calls to put its paragraphs into a sn_report.
void compare_add_words(void *report, const char *text);
/// report.html over several cases.
sn_status compare_write_overview(const char *path, const compare_study *study);

/// A table of texts in the making: rows are added until it is full.
typedef struct compare_table {
    int columns, rows, most;
    char (*text)[64];
} compare_table;
sn_status compare_table_create(int columns, int most, compare_table *table);
/// The place of the next row's texts.
char (*compare_table_row(compare_table *table))[64];
void compare_table_add(sn_report *report, const compare_table *table, const char *caption);
void compare_table_print(const compare_table *table);
void compare_table_release(compare_table *table);
/// The models of one case: header, reference, models mesh by mesh.
sn_status compare_case_table(const compare_case *one, compare_table *table);
/// All models on all meshes over the cases of a study.
sn_status compare_summary_table(const compare_study *study, compare_table *table);
/// Every case on its finest mesh: displacement / answer of every model.
sn_status compare_cases_table(const compare_study *study, compare_table *table);
