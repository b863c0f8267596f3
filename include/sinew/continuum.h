// Finite elements: the accurate reference. PETSc underneath; none of its types shows here.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Runs a case by total-Lagrangian finite elements with Newton's method (elements and steps from
/// c->continuum). Fields: displacement [m], pressure [Pa], Green strain [1], Cauchy stress [Pa],
/// energy density [J/m3], on the nodes and cells of c->mesh (elements with midside nodes give their
/// corner values).
/// @param history  gets the columns of sn_case_history_columns()
/// @return SN_OK also where Newton gave up (summary->converged false, summary->reason says why;
/// what converged before is in the history); SN_E_DEFINITION where rigid motion is free;
/// SN_E_UNSUPPORTED; SN_E_MEMORY.
SN_API sn_status sn_continuum_run(const sn_case *c, const sn_output *output,
                                  sn_run_summary *summary, sn_record *history);

#ifdef __cplusplus
}
#endif
