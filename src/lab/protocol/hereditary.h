// Hereditary integrals of elastic stresses that are known functions of what drives the test.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/protocol/path.h"

enum { SN_CHANNELS_MAX = 2 * (1 + SN_FIT_PARAMS_MAX) };

/// Elastic stresses f as functions of the number x that drives a test.
typedef struct sn_channels {
    int count; ///< of stresses, at most SN_CHANNELS_MAX
    const void *context;
    /// f and df/dx at n points, channel after channel                (count x n)
    sn_status (*fill)(const void *context, int n, const double *x, double *value, double *slope);
} sn_channels;

/// int G(t - s) df(s) of every channel at every instant of a path, with `level` times the coarsest
/// steps. Error of fourth order in the step, whatever the relaxation times.
/// @param out                                                (path->count x of->count)
/// @return SN_OK, SN_E_MEMORY, what fill returns.
sn_status sn_path_hereditary(const sn_path *path, const sn_channels *of, const sn_exponentials *e,
                             int level, double *out);

/// Derivatives of the same integrals by `count` constants of the memory, int dG/dp(t - s) df(s),
/// but for the part own G(t) of each: that is `own` times sn_path_hereditary().
/// @param out                                        (count x path->count x of->count)
/// @return SN_OK, SN_E_MEMORY, what fill returns.
sn_status sn_path_hereditary_slopes(const sn_path *path, const sn_channels *of, int count,
                                    const sn_memory_slope *slope, int level, double *out);
