// The table of models, and one run of a case with all that is taken from it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/norms.h"
#include "sinew/compare.h"

typedef sn_status sn_engine(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                            sn_record *history);

/// A row of the table.
typedef struct sn_model_row {
    const char *name, *text;
    sn_engine *run;
    sn_rung rung;
    bool volume;
    int rule; ///< sn_calibration_rule of the springs' constants; -1: the net's own
} sn_model_row;

const sn_model_row *sn_model_row_at(int model);

/// Runs a case that the caller owns (probes are added to it) and fills the model but for its
/// errors. A refusal or an early end is noted in the model. Where a tissue has a memory and forces
/// answer, it runs once more without memory, for model->elastic.
/// @param points  the mesh that the capture has the values of
/// @return SN_OK, SN_E_MEMORY, SN_E_STOPPED.
sn_status sn_model_run(sn_case *c, const sn_model_row *row, const sn_mesh *points,
                       const sn_output *output, sn_capture *capture, sn_comparison_model *model);
/// What answers in a run that was captured at other points than its model was run with.
/// *record is the caller's. @return SN_OK, SN_E_MEMORY.
sn_status sn_model_response(const sn_case *c, const sn_mesh *points, const sn_capture *capture,
                            const sn_record *history, sn_record **record);
/// Errors of a model against another run at the same points: over the common times.
/// @param memory  sn_case_memory()
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_model_errors(const sn_mesh *points, const sn_capture *capture,
                          const sn_comparison_model *model, const sn_capture *truth,
                          const sn_comparison_model *reference, const sn_memory *memory,
                          sn_comparison_errors *error);
sn_comparison_errors sn_no_errors(void);
/// Displacement at the last common time, and its distance to the truth. @return SN_OK, SN_E_MEMORY.
sn_status sn_model_keep_last(const sn_capture *capture, const sn_capture *truth,
                             sn_comparison_model *model);
bool sn_case_remembers(const sn_case *c);
/// The one memory of all tissues. NULL where they, or parts of one, differ.
const sn_memory *sn_case_memory(const sn_case *c);
/// A copy on a copy of the mesh. @return SN_OK, SN_E_MEMORY.
sn_status sn_case_own(const sn_case *c, sn_case **copy);
