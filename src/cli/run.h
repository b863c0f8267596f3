// What the parts of `sinew run` share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

/// Error estimates of --refine for summary.json.
json_t *run_refinement_json(const sn_refinement *r);
/// Prints them as a table.
void run_refinement_print(const sn_refinement *r);
/// Adds them to the report.
void run_refinement_report(const sn_refinement *r, sn_report *report);

/// Adds to the note what reading did to the cells of the mesh.
void run_mesh_note(const sn_mesh *mesh, sn_run_summary *s);

#define RUN_STATE "state.bin" ///< the state of an unfinished run in its folder

/// Reads FOLDER/state.bin for --resume; sn_free() the bytes.
/// @return SN_OK, SN_E_FILE, SN_E_MEMORY.
sn_status run_state_read(const char *folder, void **bytes, size_t *count);
/// An sn_restart save callback; context: the folder's name.
sn_status run_state_write(void *folder, const void *state, size_t bytes);
/// Removes it after the end.
void run_state_remove(const char *folder);
