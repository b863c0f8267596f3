// Steps halved until the result stands still.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/base.h"

enum { SN_REFINE_LEVELS = 12 };

/// A result of n numbers with `level` times the coarsest steps.
typedef sn_status sn_at_level(const void *context, int level, double *out);

/// Doubles the steps until the result changes by no more than `tolerance` of its largest number.
/// @param base    factor by which the error falls when the steps are halved, all its powers being
///                removed by Romberg's table (4: even powers of the step, 2: every power); 0: none
///                are, the error falls by 8 or more
/// @param change  of the last doubling, over the largest number: above the tolerance where
///                SN_REFINE_LEVELS did not do                             (n)
/// @return SN_OK, SN_E_MEMORY, what at_level returns.
sn_status sn_refine(sn_at_level *at_level, const void *context, int n, double base,
                    double tolerance, double *out, double *change);
