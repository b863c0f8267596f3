// Exponentials with the smallest largest error on a grid of times.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/relax.h"

#define SN_MINIMAX_TERMS 24   ///< most terms that are searched for
#define SN_MINIMAX_POINTS 240 ///< most points of the grid
#define SN_MINIMAX_PARAMS (2 * SN_MINIMAX_TERMS + 1)

/// The problem and its workspace; plain data, about 120 kB: allocate it.
typedef struct sn_minimax {
    int points;
    double t[SN_MINIMAX_POINTS];      ///< times, seconds, rising
    double target[SN_MINIMAX_POINTS]; ///< G there
    double goal;                      ///< stop as soon as the largest |error| is below
    // workspace of sn_minimax_improve()
    int params;
    double error[SN_MINIMAX_POINTS];
    double jacobian[SN_MINIMAX_POINTS][SN_MINIMAX_PARAMS];
    double normal[SN_MINIMAX_PARAMS][SN_MINIMAX_PARAMS];
} sn_minimax;

/// Moves weights and times of `e` (terms >= 1, all weights > 0, their sum with g_inf 1, which stays
/// so) towards the smallest largest error on the grid. Stops early below the goal, and as soon as
/// it is clear that this number of terms does not reach it.
/// @return the largest |error| on the grid.
double sn_minimax_improve(sn_minimax *m, sn_exponentials *e);
