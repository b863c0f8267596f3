// Runs of a case to its end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/moment.h"
#include "springs/state.h"

#define SN_WALLS 65536 ///< wall times kept of a run
typedef struct sn_run {
    const sn_net *net;
    const sn_output *output;   ///< Nullable
    const sn_restart *restart; ///< Nullable
    sn_run_summary *summary;
    sn_record *history;
    sn_fields *fields;
    double *row;
    double started, told; ///< on the clock
    double *wall;         ///< of steps; a sample where there are more than SN_WALLS
    long wall_seen;
    double internal_work; ///< done on the tissue by its nodes so far, J
    double external_work; ///< J
    double released;      ///< by cuts so far, J
    double stored_start, kinetic_start;
} sn_run;
void sn_run_wall(sn_run *run, double seconds);
/// @return SN_OK; tells progress at most a few times a second.
void sn_run_progress(sn_run *run, double time);
/// Row and frame of a moment.
sn_status sn_run_record(sn_run *run, const sn_moment *moment);
/// Hands a frame out, without a row: the first thing that a run does that goes on from bytes.
sn_status sn_run_frame(sn_run *run, const sn_moment *moment);
static inline bool sn_run_goes_on(const sn_run *run) {
    return run->restart && run->restart->state;
}
/// After every output: saves the run, its state and `own`, what the integrator keeps beside them.
sn_status sn_run_save(sn_run *run, const sn_state *s, const sn_piece *own, int count);
/// Takes all that from run->restart->state. @return SN_OK, SN_E_DATA, SN_E_DEFINITION (another
/// case), SN_E_UNSUPPORTED (another version), SN_E_MEMORY.
sn_status sn_run_load(sn_run *run, sn_state *s, const sn_piece *own, int count);
/// Time of output k, or the end of the run; INFINITY after the end.
double sn_run_output_time(const sn_net *net, long k);
/// Fills the fields and the stored energies of the summary; returns elastic and memory, J.
double sn_run_store(sn_run *run, const sn_moment *moment);
/// Rows to be filled in sn_output.energy.
sn_status sn_run_energy_rows(sn_record *energy, int rows);
sn_status sn_run_motion(sn_run *run);
sn_status sn_run_quasi_static(sn_run *run);

/// Removes cells in a run. run->released gets what was stored before; the caller takes off what is
/// stored afterwards. @return as sn_state_cut().
sn_status sn_run_cut(sn_run *run, sn_state *s, const sn_moment *before, int count,
                     const int *cells);
