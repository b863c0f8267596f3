// The search for the best constants of a fit: a global stage, then Levenberg-Marquardt.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/fit/problem.h"

/// A point of the search, in the scale of the fit.
typedef struct sn_found {
    double x[SN_FIT_PARAMS_MAX];
    double sum; ///< of squares
    int info;   ///< of Levenberg-Marquardt: 1 to 4 and 6 to 8 are convergence
} sn_found;

/// Global and local search from the bounds. @return SN_OK, SN_E_SOLVER (no feasible point),
/// SN_E_MEMORY.
sn_status sn_search(sn_problem *problem, sn_found *best);
/// Levenberg-Marquardt from found->x, within the bounds, until a step lowers the sum of squares by
/// less than the part `enough` of it. Constants with hold[j] stay (Nullable). @return SN_OK,
/// SN_E_MEMORY.
sn_status sn_search_local(sn_problem *problem, const bool *hold, double enough, sn_found *found);
