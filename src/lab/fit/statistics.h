// What the data say about the constants of a fit: errors, intervals, correlations, identifiability.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/fit/search.h"

/// Linearised statistics at a point, in the scale of the fit, for the free constants.
typedef struct sn_spread {
    double error[SN_FIT_PARAMS_MAX];                           ///< standard errors
    double correlation[SN_FIT_PARAMS_MAX * SN_FIT_PARAMS_MAX]; ///< (free_count x free_count)
    double condition; ///< of J^T J with columns scaled to 1
    double
        weakest[SN_FIT_PARAMS_MAX]; ///< its eigenvector of the smallest eigenvalue, scaled columns
    double student; ///< quantile 0.975 of Student's t with points - free_count degrees of freedom
} sn_spread;

/// Weights of SN_FIT_PEAK, the definition's own included. @param weight  (curve_count)
/// @return SN_OK, SN_E_DATA (a curve without stress).
sn_status sn_weigh_peaks(const sn_fit_def *def, double *weight);
/// Weights of SN_FIT_NOISE and the constants with them, in turn until the weights stay; *same says
/// whether they did. @return SN_OK, SN_E_MEMORY.
sn_status sn_weigh_noise(sn_problem *problem, sn_found *best, bool *same);

/// Intervals from def->bootstrap refits; the model stresses must be those of the best. The
/// measurements and the model of the problem are lost. @return SN_OK, SN_E_MEMORY.
sn_status sn_bootstrap(sn_problem *problem, const sn_found *best, sn_fit_result *result);
/// A fit without intervals. It also starts from the constants of *tissue (law NULL: there are
/// none), which may have a term less, and leaves its own there. @return as sn_fit().
sn_status sn_fit_trial_of(const sn_fit_def *def, sn_tissue *tissue, sn_fit_trial *trial);
/// sn_fit() that also starts from the constants of a tissue (Nullable).
sn_status sn_fit_from(const sn_fit_def *def, const sn_tissue *near, sn_fit_result *result);
/// Local search from the constants of a tissue with as many terms, or with one less: the new one
/// starts small where it helps most. @return SN_OK, SN_E_MEMORY.
sn_status sn_search_near(sn_problem *problem, const sn_tissue *near, sn_found *found);

/// Quantile 0.975 of Student's t with nu >= 1 degrees of freedom, to 5e-4 relative.
double sn_student_975(int nu);
/// Eigenvalues (rising) and eigenvectors (columns of V) of a symmetric n x n matrix, which is lost.
void sn_eigen_symmetric(int n, double *A, double *value, double *V);

/// @return SN_OK, SN_E_MEMORY.
sn_status sn_spread_at(sn_problem *problem, const sn_found *best, sn_spread *spread);

/// 95 % interval of free constant j from the likelihood profile, in the scale of the fit: where the
/// sum of squares, the other constants fitted anew, reaches (1 + t^2/nu) times the least. An end
/// that is not reached within the bounds of the search is the bound.
/// @param better  set, and true returned in *improved, where the profile meets a smaller sum
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_profile(sn_problem *problem, const sn_found *best, const sn_spread *spread, int j,
                     double interval[2], sn_found *better, bool *improved);

/// Fills `determined` of a result whose constants are described.
void sn_describe_determined(const sn_problem *problem, const sn_spread *spread,
                            sn_fit_result *result);

/// Fills value, errors, intervals, correlation and identifiability of a result. Where a profile
/// meets a better point, *best becomes it, *moved true, and the caller starts again; the `last`
/// time the linearised interval stands instead.
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_describe(sn_problem *problem, sn_found *best, bool last, sn_fit_result *result,
                      bool *moved);
