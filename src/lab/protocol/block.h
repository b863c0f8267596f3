// A block of a solid in the middle of a test: what its steps and their derivatives share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/protocol/path.h"

/// Channels: S11, S22, S33 distortional, K (J - 1), and S11, S22, S33 of fibres with a memory of
/// their own.
enum { SN_BLOCK_VOLUME = 3, SN_BLOCK_FIBRES = 4, SN_BLOCK_CHANNELS = 7 };

typedef struct sn_block_slopes sn_block_slopes;

typedef struct sn_block {
    const sn_tissue *tissue;
    sn_tissue part[2]; ///< of the distortional stress (sn_tissue_split)
    int parts, channels;
    int memories; ///< 1, or SN_PARTS where branched
    const sn_faces *faces;
    const sn_exponentials *e;                  ///< (memories)
    double bulk;                               ///< INFINITY: incompressible
    int unknowns, unknown[3];                  ///< faces whose stretch is solved for
    double time, target[3];                    ///< stretches of held faces, loads of the others, Pa
    double y[3];                               ///< logarithms of the stretches
    double value[SN_BLOCK_CHANNELS];           ///< elastic, at the end of the last step
    double H[SN_BLOCK_CHANNELS][SN_TERMS_MAX]; ///< shares of the exponentials
    double a[SN_BLOCK_CHANNELS], b[SN_BLOCK_CHANNELS]; ///< affine map of the step at hand
    sn_block_slopes *slopes;                           ///< Nullable; not of a branched tissue
} sn_block;

/// A trial of the stretches and what comes of it.
typedef struct sn_block_trial {
    double y[3];
    double value[SN_BLOCK_CHANNELS]; ///< elastic channels; of fibres only where there are any
    double stretch[3], nominal[3];
    double residual[3]; ///< of the unknown faces, times their stretch
} sn_block_trial;

/// A block at rest; what it points to must outlive it.
sn_block sn_block_of(const sn_tissue *tissue, const sn_faces *faces, const sn_exponentials *e);
/// To the first instant of a path. @return SN_OK, SN_E_SOLVER (no equilibrium).
sn_status sn_block_start(sn_block *block, const sn_path *path, sn_block_row *row);
/// From instant k of the path to the next, with `level` times the coarsest steps. @return as above.
sn_status sn_block_cross(sn_block *block, const sn_path *path, int k, int level, sn_block_row *row);

/// A x = -r for n <= 3 unknowns by Gauss with pivots; A is used up.
void sn_solve_small(int n, double A[3][3], const double *r, double *x);

/// Derivatives at the first instant, at its equilibrium.
void sn_block_slopes_start(sn_block *block, const sn_block_trial *now);
/// Derivatives at the end of a step of h seconds, at its equilibrium; value and H of the block are
/// still those of its start.
/// @param decay, gain  sn_exponentials_factors() of the step and the only memory
void sn_block_slopes_step(sn_block *block, double h, const double *decay, const double *gain,
                          const sn_block_trial *now);
