// The least-squares problem behind a fit: its parameters, their bounds, its residuals.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/protocol/path.h"

/// One constant of the law or the memory.
typedef struct sn_fit_constant {
    const sn_param *param;
    int index;      ///< in the values of its table
    bool in_memory; ///< of the memory, else of the law
    bool free;
    bool stress;      ///< its unit is the pascal
    bool time;        ///< its unit is the second
    double low, high; ///< bounds of the search, natural units
    char name[SN_NAME_MAX];
} sn_fit_constant;

/// Steps of the model: this level is good to 1e-6 of the peak for the curves people record, and the
/// model is a smooth function of the constants because the steps do not depend on them.
enum { SN_PROBLEM_LEVEL = 1 };

/// Search points are in the scale of the fit: the logarithm where the table says so, else the
/// value.
typedef struct sn_problem {
    const sn_fit_def *def;
    sn_tissue tissue; ///< fixed constants set; free ones as last tried
    int count;        ///< constants, fixed ones included
    sn_fit_constant constant[SN_FIT_PARAMS_MAX];
    int free_count;
    int free[SN_FIT_PARAMS_MAX]; ///< constants that are searched
    bool scalable;               ///< stress is proportional to the free constants that are stresses
    int points;                  ///< of all curves
    sn_path *path[SN_FIT_CURVES_MAX];
    bool slopes[SN_FIT_CURVES_MAX];    ///< sn_path_slopes() holds for the curve; else differences
    double *measured, *weight, *model; ///< Pa, factor of a residual, Pa     (points)
    double norm;                       ///< weighted sum of squares of the measurements
    double peak;                       ///< largest |measured stress|
    double strain;                     ///< largest |stretch - 1|
    double sampling;                   ///< shortest sampling interval while the stretch moves, s
    double ramp;                       ///< shortest first ramp, s
    double record;                     ///< longest record, s
    int evaluations;
} sn_problem;

sn_status sn_problem_create(const sn_fit_def *def, sn_problem **problem);
void sn_problem_destroy(sn_problem *problem); // NULL is allowed

/// Value of a constant in the scale of the fit, and back.
double sn_problem_scaled(const sn_fit_constant *constant, double value);
double sn_problem_natural(const sn_fit_constant *constant, double scaled);
/// Puts a search point into the tissue.
void sn_problem_set(sn_problem *problem, const double *x);
/// Model stresses of curve k, Pa, with the tissue as it stands.
sn_status sn_problem_curve(const sn_problem *problem, int k, sn_pull pull, const sn_exponentials *e,
                           double *stress);
/// Weighted residuals (model - measured, Pa) at a search point. Where the constants break a
/// condition or the stress is not finite they are all 1e3 times the measured norm: no search stays
/// there.
/// @return whether the point is feasible.
bool sn_problem_residuals(sn_problem *problem, const double *x, double *residual);
/// Derivatives of the weighted residuals by the free constants, in the scale of the fit.
/// @param jacobian  column of free constant j at [j * points]        (free_count x points)
/// @return whether the point is feasible; else they are all 0.
bool sn_problem_jacobian(sn_problem *problem, const double *x, double *jacobian);
/// Sum of squares after the best common factor on the free stresses; that factor goes into x.
double sn_problem_scaled_sum(sn_problem *problem, double *x, double *residual);
/// Sum of squares of n numbers.
double sn_sum_squares(int n, const double *x);
