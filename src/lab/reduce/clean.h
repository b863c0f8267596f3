// Rows of a curve in the order of time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/lab.h"

/// Puts rows that got out of the order of time by accident back into it, leaves out rows at the
/// time of another and says both, and gaps, in the curve's remarks. Curves without time are left
/// as they are.
/// @return SN_OK, SN_E_DATA (time goes back otherwise, naming the row), SN_E_MEMORY.
sn_status sn_curve_clean(sn_curve *curve);
