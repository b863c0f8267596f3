// The least-squares problem behind a fit: its parameters, their bounds, its residuals.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/fit/in_plane.h"
#include "lab/protocol/path.h"

/// One constant of the law or the memory.
typedef struct sn_fit_constant {
    const sn_param *param;
    int index;      ///< in the values of its table
    bool in_memory; ///< of the memory, else of the law
    bool free;
    bool tied;        ///< a shear constant that no curve sees: follows the others (fit/fung.h)
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
    int points;                  ///< residuals of all curves, two a row where biaxial or dynamic
    int used;                    ///< of them within the window; the others have weight 0
    sn_path *path[SN_FIT_CURVES_MAX];      ///< of uniaxial curves, else NULL
    sn_in_plane *plane[SN_FIT_CURVES_MAX]; ///< of biaxial and shear curves, else NULL
    bool slopes; ///< every curve has sn_path_slopes(); else the residuals take differences
    double *measured, *weight, *model; ///< Pa, factor of a residual, Pa     (points)
    double norm;                       ///< weighted sum of squares of the measurements
    double peak;                       ///< largest |measured stress| or |modulus|
    double stress;                     ///< largest |stress|; of a sweep: what its strain would give
    double modulus;                    ///< largest |storage modulus|; 0 without a sweep
    double strain;                     ///< largest |stretch - 1|, or shear
    double green[3], shear;            ///< largest |E11|, |E22|, |E33|; largest |E12|
    bool biaxial;                      ///< some curve is
    bool held[SN_VALUES_MAX];          ///< constants of the law that are fixed
    double convexity;                  ///< factor that the last point needed (sn_fung_convex)
    double sampling;                   ///< shortest sampling interval while the stretch moves, s
    double ramp;                       ///< shortest first ramp, s
    double record;                     ///< longest record, s
    double fastest, slowest; ///< 1/(2 pi f) of sweeps, least and largest, s; or INFINITY, 0
    int evaluations;
} sn_problem;

sn_status sn_problem_create(const sn_fit_def *def, sn_problem **problem);
void sn_problem_destroy(sn_problem *problem); // NULL is allowed

/// Value of a constant in the scale of the fit, and back.
double sn_problem_scaled(const sn_fit_constant *constant, double value);
double sn_problem_natural(const sn_fit_constant *constant, double scaled);
/// Residuals of a curve: its rows, or twice that where it is biaxial (the first axis, then the
/// second) or dynamic (storage, then loss modulus).
int sn_problem_rows(const sn_curve *curve);
/// Puts a search point into the tissue, tied constants with it. Where it is not convex the cross
/// constants of a Fung law are shrunk until it is.
void sn_problem_set(sn_problem *problem, const double *x);
/// Sets a point and makes x what the tissue then has.
void sn_problem_settle(sn_problem *problem, double *x);
/// Weighted residuals (model - measured, Pa) at a search point. Where the constants break a
/// condition or the stress is not finite they are all 1e3 times the measured norm: no search stays
/// there. A point that sn_problem_set() had to shrink has the residuals of the point it became,
/// times 1 + 10 (1 - factor), so that the search comes back.
/// @return whether the point is feasible.
bool sn_problem_residuals(sn_problem *problem, const double *x, double *residual);
/// Derivatives of the weighted residuals by the free constants, in the scale of the fit.
/// @param jacobian  column of free constant j at [j * points]        (free_count x points)
/// @return whether the point is feasible; else they are all 0.
bool sn_problem_jacobian(sn_problem *problem, const double *x, double *jacobian);
/// Sum of squares after the best common factor on the free stresses; that factor goes into x.
double sn_problem_scaled_sum(sn_problem *problem, double *x, double *residual);
/// Whether a row of a curve is fitted: rows outside the window only move the model.
bool sn_problem_in_window(const sn_fit_def *def, const sn_curve *curve, int row);
/// Sum of squares of n numbers.
double sn_sum_squares(int n, const double *x);
