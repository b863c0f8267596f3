// The state of a run as bytes, so that a killed run can go on.
// SPDX-License-Identifier: Apache-2.0
//
// All that later steps depend on is in it, to the last bit: a run that goes on from it takes the
// same steps and gives the same numbers as one that was never interrupted. Numbers are as the
// machine holds them; the head refuses another kind of machine, another case, another build of the
// format.
#pragma once

#include "continuum/march.h"

/// Hands the state after the output at `time` to m->restart->save; nothing where that is NULL.
sn_status sn_fe_state_save(sn_fe_march *m, double time);
/// Takes up m->restart->state, with the history so far. @param stop  out: the schedule's stop that
/// the state belongs to; -1 where there is nothing to resume.
/// @return SN_OK, SN_E_DATA (damaged, or not of this case), SN_E_MEMORY.
sn_status sn_fe_state_restore(sn_fe_march *m, int *stop);
