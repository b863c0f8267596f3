// The laboratory: protocols and the virtual testing machine, reduction of curves to properties,
// fitting of curves to a tissue.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/tissue.h"

#ifdef __cplusplus
extern "C" {
#endif

//---- virtual testing machine ---------------------------------------------------------------------

typedef enum sn_protocol_kind {
    SN_PROTOCOL_TENSILE,
    SN_PROTOCOL_CYCLIC,
    SN_PROTOCOL_RELAXATION,
    SN_PROTOCOL_HYSTERESIS,
    SN_PROTOCOL_DYNAMIC,
    SN_PROTOCOL_CREEP,
    SN_PROTOCOL_BIAXIAL,
    SN_PROTOCOL_SHEAR
} sn_protocol_kind;

/// How a cycle goes to the target and back: straight, or as (1 - cos)/2, drawn with 100 straight
/// lines a way.
typedef enum sn_wave { SN_WAVE_TRIANGLE, SN_WAVE_SINE } sn_wave;

/// What the machine does. Fill from sn_protocol_default().
typedef struct sn_protocol {
    sn_protocol_kind kind;
    double stretch;              ///< target stretch; mean stretch (dynamic) [1]
    double ramp;                 ///< seconds from rest to the target; 0: from rate
    double rate;                 ///< stretch per second; used where ramp is 0
    double hold;                 ///< seconds at the target (relaxation) or under the stress (creep)
    double recovery;             ///< seconds without stress after unloading; 0: none (creep)
    double stress;               ///< nominal stress that is held, Pa (creep)
    double stretch_1, stretch_2; ///< targets along two axes (biaxial) [1]
    double shear;                ///< target shear strain [1]
    double from, to;  ///< ends of a sweep: ramp time, s (hysteresis), or frequency, Hz (dynamic)
    double lower;     ///< stretch where a cycle starts and ends; the specimen is brought there from
                      ///< 1 at the speed of a straight cycle (cyclic) [1]
    int cycles;       ///< recorded: lower -> target -> lower (cyclic)
    int precondition; ///< cycles before those that are recorded (cyclic)
    sn_wave wave;     ///< of a cycle; triangle by default (cyclic)
    int points;       ///< rows of the curve
} sn_protocol;
#define SN_PROTOCOL_PARAMS_MAX 12 ///< most parameters of one protocol

SN_API int sn_protocol_count(void);
SN_API const char *sn_protocol_name(sn_protocol_kind kind);
/// @return false with a text stored when there is no protocol of that name.
SN_API bool sn_protocol_find(const char *name, sn_protocol_kind *kind);
/// The parameters of a protocol with units and defaults (options of the command).
SN_API const sn_param *sn_protocol_params(sn_protocol_kind kind, int *count);
SN_API sn_protocol sn_protocol_default(sn_protocol_kind kind);
/// Sets a parameter by its name in the protocol's table. @return SN_OK, SN_E_NAME.
SN_API sn_status sn_protocol_set(sn_protocol *protocol, const char *name, double value);
/// Value of a parameter by its name in the protocol's table. NAN when it has none of that name.
SN_API double sn_protocol_get(const sn_protocol *protocol, const char *name);
/// The stretch over time of a tensile, cyclic or relaxation test, and the times at which the
/// machine records (in *time, sn_alloc'd, protocol->points of them; relaxation spaces them by the
/// logarithm after the ramp). A cyclic record begins with its first cycle after preconditioning;
/// its times count from the start of the test.
SN_API sn_status sn_protocol_history(const sn_protocol *protocol, sn_history **stretch,
                                     double **time);

/// Uniaxial test of a tissue with free sides: nominal stress at n times under a stretch history
/// that starts at t = history->time[0] from rest. A stretch of other than 1 at the start is a step.
/// Solid laws solve their lateral stretch (incompressible or not), membrane laws are strips along
/// their first axis with a free side (S22 = 0); memory acts as in tissue.h. A uniaxial law uses T
/// (nominal) with the hereditary integral on T (equation 33 in one dimension). Accurate to 1e-7 of
/// the peak: steps are halved until that holds.
/// @param stress  nominal stress, Pa                                        (n)
/// @return SN_OK, SN_E_UNSUPPORTED (a law that shears under the pull), SN_E_RANGE, SN_E_SOLVER,
/// SN_E_MEMORY.
SN_API sn_status sn_lab_uniaxial(const sn_tissue *tissue, const sn_history *stretch, int n,
                                 const double *time, double *stress);
/// Creep test with free sides: stretch at n times under a history of nominal stress that starts at
/// t = stress->time[0] from rest. A stress of other than 0 at the start is a step. All laws, as in
/// sn_lab_uniaxial(). Accurate to 1e-7 of the largest strain.
/// @param stretch  [1]                                                      (n)
/// @return SN_OK, SN_E_UNSUPPORTED (a law that shears under the pull), SN_E_DATA (time),
/// SN_E_SOLVER (the specimen gives way under the stress, no convergence), SN_E_MEMORY.
SN_API sn_status sn_lab_creep(const sn_tissue *tissue, const sn_history *stress, int n,
                              const double *time, double *stretch);
/// Runs a protocol. The columns of the record:
///     tensile, relaxation, creep  time [s], stretch [1], stress [Pa] (nominal)
///     cyclic                      the same and cycle [1], from precondition + 1
///     biaxial                     time [s], stretch_1 [1], stretch_2 [1], stress_1 [Pa], stress_2
///     shear                       time [s], shear_strain [1], shear_stress [Pa]
///     hysteresis                  frequency [Hz], hysteresis [1]
///     dynamic                     frequency [Hz], storage_modulus [Pa], loss_modulus [Pa]
/// Biaxial and shear need a solid or a membrane law. Biaxial: the thickness is free. Shear: simple,
/// F12 = shear, the thickness is held at 1 (where it stays by itself in a membrane, and no pressure
/// enters the stress in a solid).
/// Hysteresis is loop area over area under the loading curve of one triangle 1 -> stretch -> 1 from
/// rest, frequency 1/(2 ramp time); it is good to 1e-6. It exceeds 1 where the tissue must be
/// pushed back. Dynamic moduli are d(nominal stress)/d(stretch) of a small oscillation about a
/// stretch held for ever.
/// @return SN_OK, SN_E_RANGE (a parameter), SN_E_UNSUPPORTED (a law and a test that do not go
/// together), SN_E_SOLVER, SN_E_MEMORY.
SN_API sn_status sn_lab_test(const sn_tissue *tissue, const sn_protocol *protocol,
                             sn_record **record);

//---- reduction -----------------------------------------------------------------------------------

/// What was pulled: one axis with free sides; two axes of a sheet with a free thickness; one face
/// slid along the first axis over the second (simple shear); or one axis with free sides, shaken a
/// little about a held stretch, as moduli over frequency.
typedef enum sn_curve_kind {
    SN_CURVE_UNIAXIAL,
    SN_CURVE_BIAXIAL,
    SN_CURVE_SHEAR,
    SN_CURVE_DYNAMIC
} sn_curve_kind;

/// A curve brought to time, stretch and nominal stress from whatever columns it has (force over
/// area, extension over gauge_length, strain, true stress, …). Arrays owned.
typedef struct sn_curve {
    char name[SN_TEXT_MAX];
    sn_curve_kind kind;
    int count;
    double *time;                  ///< seconds; NULL where the curve has none
    double *stretch;               ///< [1], of the first axis; shear: the amount of shear [1]
    double *stress;                ///< nominal, Pa, along the first axis; shear: the shear stress
    double *stretch_2, *stress_2;  ///< of the second axis; NULL unless biaxial
    double *frequency;             ///< Hz, rising; NULL unless dynamic, which has none of the above
    double *storage, *loss;        ///< d(nominal stress)/d(stretch), Pa; NULL unless dynamic
    double mean_stretch;           ///< of a dynamic curve: the stretch that it is shaken about
    int discarded;                 ///< rows left out, why in `remarks`
    char remarks[SN_TEXT_MAX * 2]; ///< what was done to the data, in words
} sn_curve;

/// The columns say the kind: names with _1 and _2 are biaxial, shear_strain is a shear test,
/// storage_modulus and loss_modulus over frequency are dynamic, about the stretch of the remark
/// mean_stretch (1 without). Shear stress is nominal, which in simple shear is the true one as
/// well. Rows at the time of the row before are left out; a few rows that came late by a few places
/// are put back (at most 1 % of the rows, by at most 5 places), and gaps are said.
/// @return SN_OK, SN_E_DATA (a column or a quantity is missing, columns of two kinds of test, times
/// go backwards, too few rows).
SN_API sn_status sn_curve_from_record(const sn_record *record, sn_curve *curve);
SN_API void sn_curve_release(sn_curve *curve);
/// "uniaxial", "biaxial", "shear" or "dynamic".
SN_API const char *sn_curve_kind_name(sn_curve_kind kind);
/// What was measured, Pa: stress (which 0) and stress_2 (1), of a dynamic curve storage and loss.
/// NULL: there is no second.
SN_API const double *sn_curve_measured(const sn_curve *curve, int which);
/// Refuses a curve of another kind; `what` wants it ("a tensile test"). @return SN_OK,
/// SN_E_UNSUPPORTED.
SN_API sn_status sn_curve_expect(const sn_curve *curve, sn_curve_kind kind, const char *what);

/// How a tensile curve is reduced. Fill from sn_tensile_def_default().
typedef struct sn_tensile_def {
    double preload;  ///< nominal stress at the zero of strain, Pa; 0: strain is stretch - 1
    double from, to; ///< strains between which the modulus is taken; NAN: found in the data
    int ramp;        ///< loading ramp to use, from 1; 0: the last that reaches 90 % of the largest
} sn_tensile_def;
SN_API sn_tensile_def sn_tensile_def_default(void);

/// Values, NAN with a reason. Strain is stretch - 1, or from the preload where one is asked for.
typedef struct sn_tensile {
    int first, last, ultimate;   ///< rows of the curve: the loading ramp, its largest stress
    int ramps, ramp;             ///< loading ramps found; the one used, from 1
    double preload_stretch;      ///< stretch at the zero of strain; 1 without a preload
    double stress_noise;         ///< scatter of the stress about a smooth curve, Pa
    double youngs_modulus;       ///< Pa
    double youngs_modulus_error; ///< its standard error from the scatter about the line
    char modulus_method[SN_TEXT_MAX];
    double chord_modulus;         ///< between the ends of the modulus' window
    double toe_modulus;           ///< slope over the first tenth of the strain
    double toe_limit, toe_stress; ///< where the slope reaches half of the steepest; NAN: no toe
    char toe_reason[SN_TEXT_MAX]; ///< why there is no toe
    double max_slope_modulus;     ///< slope of the steepest tenth of the strain to the ultimate
    double yield_stress, yield_strain; ///< 0.2 % offset; NAN where the line never meets the curve
    char reason[SN_TEXT_MAX];          ///< why there is no yield
    double ultimate_tensile_strength, strain_at_ultimate;
    double work_to_failure;       ///< J/m3
    double B, C, slope_r_squared; ///< slope against stress (equation 13)
    double slope_window;          ///< strain over which a local slope is taken, from the noise
    double slope_curvature;       ///< bend of slope against stress over the range of slopes
    double slope_curvature_t;     ///< the bend over its standard error
    char slope_test[SN_TEXT_MAX]; ///< whether that is a straight line, in words
    int slope_count;
    double *slope_stress, *slope;  ///< local slopes and their stresses, owned    (slope_count)
    int window_first, window_last; ///< rows of the modulus, of the curve
    int discarded;                 ///< rows of the curve that were not used
    char remarks[SN_TEXT_MAX * 2]; ///< which and why
} sn_tensile;
/// Young's modulus, 0.2 % offset yield, strength, work to failure and slope against stress of one
/// loading ramp: from where the stretch leaves its lowest to where it first stands at its highest,
/// so that a hold, an unloading and other cycles have no say. Stress is nominal.
/// @param def  Nullable: the default
/// @return SN_OK, SN_E_DATA (constant stretch, fewer than 5 rows up to the largest stress, the
/// preload outside the stresses), SN_E_RANGE (the window, the ramp), SN_E_MEMORY.
SN_API sn_status sn_reduce_tensile(const sn_curve *curve, const sn_tensile_def *def,
                                   sn_tensile *out);
SN_API void sn_tensile_release(sn_tensile *tensile);

/// One triangle: rows of its start, its largest stretch and its end.
typedef struct sn_cycle {
    int first, peak, last;          ///< rows
    double hysteresis;              ///< loop area over area under the loading curve
    double loading_area, loop_area; ///< J/m3
    double peak_stress;
} sn_cycle;
typedef struct sn_cycles {
    int count;
    sn_cycle *cycle;           ///< owned
    int discarded;             ///< rows before the first and after the last cycle
    char remarks[SN_TEXT_MAX]; ///< rows left out and why; empty where all were used
    double peak_change;        ///< last cycle against the one before, over it; NAN for one cycle
    double hysteresis_change;  ///< the same of the hysteresis
    int preconditioned_after;  ///< cycles until neither changes by more than 2 %; 0: not reached
    char reason[SN_TEXT_MAX];  ///< why not
} sn_cycles;
/// Splits a curve at the turns of its stretch (turns smaller than 5 % of the range, or than eight
/// times the scatter of the stretch, are noise) and gives the hysteresis of every cycle. Rows
/// before the first lowest stretch and a last cycle that is not finished are left out; holds
/// between cycles are not. After cycle `preconditioned_after` no cycle differs by more than 2 %
/// from the one before it, neither in peak stress nor in hysteresis (or there by no more than
/// 0.002).
/// @return SN_OK, SN_E_DATA (constant stretch, no full cycle), SN_E_MEMORY.
SN_API sn_status sn_reduce_cyclic(const sn_curve *curve, sn_cycles *out);
SN_API void sn_cycles_release(sn_cycles *cycles);

#define SN_RELAXATION_POINTS 128 ///< most points of a reduced relaxation curve

typedef struct sn_relaxation_result {
    int start, end, last; ///< rows: the ramp's first and last, the last of the hold
    int peak;             ///< row of the largest stress
    int steps, step;      ///< ramps with a hold in the record, and the one used, from 1
    double held_stretch;
    double overshoot; ///< largest stretch over the held one, over the change; 0: none
    double ramp_s;    ///< end of the ramp, found in the data, from its start
    double hold_s;    ///< from there to the last row of the hold
    double peak_stress;
    double final_stress;     ///< at the end of the hold
    double relaxed_fraction; ///< (peak - final)/peak
    double rate_per_decade;  ///< fall of stress over peak per decade of time after the peak
    /// The fall on log time: means over tenths of a decade of time since the peak and of stress
    /// over peak.
    int points;
    double point_s[SN_RELAXATION_POINTS], point_G[SN_RELAXATION_POINTS];
    int discarded;             ///< rows before the ramp and after the hold
    char remarks[SN_TEXT_MAX]; ///< other steps and rows left out
} sn_relaxation_result;
/// Properties of a ramp and hold. A hold is at least 3 rows within 1 % of the range of the stretch
/// (six times its scatter where that is more), a quarter of the ramp's time or longer. The ramp
/// ends at the first row within 1 % of the held stretch, or at the largest where it overshoots by
/// more. Of several steps the largest is used, the first of equal ones; the rest is said.
/// @return SN_OK, SN_E_DATA (no time, constant stretch, no ramp with a hold), SN_E_MEMORY.
SN_API sn_status sn_reduce_relaxation(const sn_curve *curve, sn_relaxation_result *out);

typedef struct sn_creep_result {
    double stress;             ///< held nominal stress over that before the loading, Pa
    double ramp_s, hold_s;     ///< the loading, and the time under the stress, found in the data
    double initial_compliance; ///< strain over stress at the start of the hold, 1/Pa
    double compliance;         ///< the same at its end
    double creep_rate;         ///< smallest slope of the strain over a quarter of the hold, 1/s
    double time_to_rupture;    ///< from the start of the hold, s; NAN where it did not break
    double recovered_fraction; ///< of the strain at the end of the hold; NAN where not unloaded
    char rupture_reason[SN_TEXT_MAX], recovery_reason[SN_TEXT_MAX]; ///< why there is none
    char remarks[SN_TEXT_MAX]; ///< what the rows before the loading were used for
} sn_creep_result;
/// Properties of a creep test. Strain is stretch less that of the rows before the loading. The hold
/// is from the first to the last row within 2 % (or four scatters) of the held stress. The stress
/// falling under half of it ends the test: as a rupture where the strain stands above that of the
/// hold's end, as an unloading where it does not.
/// @return SN_OK, SN_E_DATA (no time, no stress, the stress not held, fewer than 5 rows of hold).
SN_API sn_status sn_reduce_creep(const sn_curve *curve, sn_creep_result *out);

/// A sinusoidal test at one frequency. Moduli are d(nominal stress)/d(stretch).
typedef struct sn_oscillation {
    double frequency;                       ///< Hz
    double storage_modulus, loss_modulus;   ///< Pa
    double storage_error, loss_error;       ///< standard errors; NAN from a sweep
    double tan_delta, phase;                ///< phase in rad
    double mean_stretch, stretch_amplitude; ///< NAN from a sweep, as all that follows
    double mean_stress, stress_amplitude;   ///< Pa
    double harmonic_distortion; ///< root sum of squares of the harmonics 2 to 5 over the first
    int first, last;            ///< rows of the curve that were fitted
    double cycles;              ///< in these rows
} sn_oscillation;
typedef struct sn_dynamic {
    int count;
    sn_oscillation *at;                         ///< rising frequencies, owned              (count)
    double storage_per_decade, loss_per_decade; ///< power laws: d log10 modulus / d log10 frequency
    double low_plateau, high_plateau; ///< storage modulus at the ends where it is level, Pa; or NAN
    char low_reason[SN_TEXT_MAX], high_reason[SN_TEXT_MAX]; ///< why not
    double peak_tan_delta, peak_frequency;                  ///< of a peak within the record; or NAN
    char peak_reason[SN_TEXT_MAX];                          ///< why not
    int discarded;                                          ///< rows not used
    char remarks[SN_TEXT_MAX * 2];                          ///< which and why
} sn_dynamic;
/// A sweep: columns frequency, storage_modulus, loss_modulus, in any order of rows.
/// @return SN_OK, SN_E_DATA (a column is missing, values not above 0, a frequency twice),
/// SN_E_MEMORY.
SN_API sn_status sn_reduce_sweep(const sn_record *record, sn_dynamic *out);
/// Raw sinusoids: the record is cut where period or amplitude change, and every part of 2 cycles or
/// more fitted by least squares at its own frequency, stretch and stress with a mean and a drift,
/// the stress with harmonics up to the fifth where the rows resolve them. Where a part has more
/// than 3 cycles the first is left out, for what goes before it, and the last half.
/// @return SN_OK, SN_E_DATA (no time, no part of 2 cycles), SN_E_MEMORY.
SN_API sn_status sn_reduce_oscillation(const sn_curve *curve, sn_dynamic *out);
SN_API void sn_dynamic_release(sn_dynamic *dynamic);
/// One axis of a biaxial test. Moduli are slopes of the nominal stress over the stretch along the
/// path of the test, so they hold for its ratio.
typedef struct sn_biaxial_axis {
    double peak_stretch, peak_stress; ///< in the row of the largest sum of stresses
    double low_modulus;               ///< over the first fifth of the stretch of the axis, Pa
    double high_modulus;              ///< over the last fifth, Pa
} sn_biaxial_axis;
typedef struct sn_biaxial_result {
    sn_biaxial_axis axis[2];
    double stretch_ratio; ///< (stretch_1 - 1)/(stretch_2 - 1) at the peak; NAN for 0 below
    double stress_ratio;  ///< stress_1/stress_2 at the peak; NAN for 0 below
    /// 2 (c2 - c1)/(c1 + c2), c the strain over the stress of an axis at the peak: 0 alike, above 0
    /// where the first axis is the stiffer one
    double anisotropy;
    double energy; ///< work of both stresses up to the peak, J/m3
    int peak;      ///< row
} sn_biaxial_result;
/// Properties of a biaxial loading, from the first row to the largest sum of both stresses.
/// @return SN_OK, SN_E_UNSUPPORTED (another kind of curve), SN_E_DATA (no pull, fewer than 5 rows).
SN_API sn_status sn_reduce_biaxial(const sn_curve *curve, sn_biaxial_result *out);

//---- fitting -------------------------------------------------------------------------------------

#define SN_FIT_PARAMS_MAX 32
#define SN_FIT_CURVES_MAX 32

/// What the squares of a curve are multiplied by, besides sn_fit_def.weight.
typedef enum sn_fit_weighting {
    SN_FIT_PLAIN, ///< 1: the noise is the same, in Pa, on all curves
    SN_FIT_PEAK,  ///< (largest peak of all / the curve's)^2: the noise is a part of each peak
    SN_FIT_NOISE  ///< 1 / the variance of the curve's residuals, found with the constants
} sn_fit_weighting;
#define SN_FIT_BOOTSTRAP_MIN 40 ///< least refits that a 2.5 % quantile asks for

/// What to fit. Fill from sn_fit_def_default().
typedef struct sn_fit_def {
    int curve_count;
    const sn_curve *curve; ///< of any kinds                       (curve_count), borrowed
    const double *weight;  ///< Nullable: factor of a curve's squares (curve_count), borrowed
    const sn_law *law;
    const sn_memory_law *memory; ///< Nullable: none
    int terms;                   ///< exponentials of a prony memory
    int law_terms;               ///< terms of an elastic law with lists (ogden)
    int starts;                  ///< local searches from the best of the global stage
    unsigned seed;
    sn_fit_weighting weighting;
    double from, to; ///< rows outside move the model, but are not fitted; s as recorded
    int bootstrap;   ///< refits for ci95_bootstrap, 0: none, else SN_FIT_BOOTSTRAP_MIN or more
    int fixed_count; ///< parameters held at a value
    const char *fixed_name[SN_FIT_PARAMS_MAX];
    double fixed_value[SN_FIT_PARAMS_MAX];
    void (*progress)(void *context, double done, const char *text); ///< Nullable
    void *progress_context;
} sn_fit_def;
SN_API sn_fit_def sn_fit_def_default(void);

/// One constant of a fit. Terms of a list are named g1, g2, …; a constant of the memory whose name
/// the law has as well is named memory.c.
typedef struct sn_fit_param {
    char name[SN_NAME_MAX];
    char unit[SN_NAME_MAX];
    double value, standard_error; ///< NAN error for a fixed parameter
    /// 95 % interval, NAN for a fixed parameter: linearised where it is narrow, from the likelihood
    /// profile where it is wide (the error is then the interval over 2 t); an end that meets the
    /// bounds of the search is open there.
    double ci95[2];
    bool profiled;            ///< ci95 is from the profile
    double ci95_bootstrap[2]; ///< percentiles of the refits; NAN without them
    bool fixed, at_bound;
    bool identifiable;
    char reason[SN_TEXT_MAX]; ///< why not; of a constant that no curve sees: what it was set to
} sn_fit_param;

typedef struct sn_fit_curve {
    int count;
    double *predicted; ///< nominal stress, or storage modulus, Pa, owned (count)
    /// along the second axis, or loss modulus, Pa, owned; NULL unless biaxial or dynamic (count)
    double *predicted_2;
    double rmse; ///< Pa, of both axes or moduli
    double peak; ///< largest |measured stress| or modulus, Pa, of both
    double r_squared;
    int worst;       ///< row of the largest residual
    bool second;     ///< that residual is of the second axis, or of the loss modulus
    int first, used; ///< rows of the window, which all of the above but what is predicted speak of
    double weight;   ///< factor of its squares
    double durbin_watson; ///< of its residuals in the order of the rows: 2 where they are white
} sn_fit_curve;

/// What became of the refits of a bootstrap.
typedef struct sn_fit_bootstrap {
    int asked, done;          ///< done: those that converged, on which the intervals stand
    int block;                ///< longest block of rows that share a sign
    char reason[SN_TEXT_MAX]; ///< why some are left out, or why there are no intervals
} sn_fit_bootstrap;

/// A fit: all stresses and moduli are residuals in Pa, R2 = 1 - SSE/SST over all points of all
/// curves.
typedef struct sn_fit_result {
    sn_tissue tissue;
    int param_count;
    sn_fit_param param[SN_FIT_PARAMS_MAX];
    double correlation[SN_FIT_PARAMS_MAX * SN_FIT_PARAMS_MAX]; ///< (param_count x param_count)
    double condition;          ///< condition number of J^T J with its columns scaled to 1
    char weakest[SN_TEXT_MAX]; ///< the combination of constants that the data know least
    /// What the data do know of two or more constants that they do not tell apart: a product of
    /// powers with its error. Empty where there are no such constants.
    char determined[SN_TEXT_MAX];
    bool identifiable; ///< every constant is
    bool converged;
    char reason[SN_TEXT_MAX]; ///< of the end of the search
    int points;
    double r_squared, rmse, nrmse, aicc; ///< nrmse: rmse over the largest that was measured
    int curve_count;
    sn_fit_curve curve[SN_FIT_CURVES_MAX];
    sn_fit_bootstrap bootstrap;
    int evaluations;
} sn_fit_result;

/// Fits law and memory together, through the recorded stretch history of every curve. A bulk
/// modulus is no parameter of a fit: it is infinite unless fixed. Solids and membranes take biaxial
/// and shear curves, residuals of both directions together; solids uniaxial ones as well. Dynamic
/// curves go with every law that the dynamic test of sn_lab_test() takes, and have two residuals a
/// frequency; `from` and `to` do not touch them. A shear
/// constant of a Fung law that no curve sees is tied to the others as in an isotropic law. Fung
/// laws stay convex. Same input, same bits.
/// @return SN_OK, SN_E_DATA (no time, fewer points than parameters, constant stretch),
/// SN_E_UNSUPPORTED (a law and a test that do not go together), SN_E_NAME (fixed name), SN_E_RANGE
/// (fixed value, weight, number of refits), SN_E_DEFINITION (no curve, no law, too many
/// parameters), SN_E_MEMORY.
SN_API sn_status sn_fit(const sn_fit_def *def, sn_fit_result *result);

/// One number of terms that was tried.
typedef struct sn_fit_trial {
    int terms, constants; ///< constants: that were searched
    bool converged;
    double r_squared, rmse, aicc;
} sn_fit_trial;
#define SN_FIT_TRIALS_MAX 12

/// The choice of a number of terms.
typedef struct sn_fit_choice {
    int count;
    sn_fit_trial trial[SN_FIT_TRIALS_MAX];
    int best, second;         ///< of `trial`; second -1 where there is one only
    char reason[SN_TEXT_MAX]; ///< what was chosen, over what, and why the trials ended
} sn_fit_choice;
/// Fits with 1, 2, … `most` terms of the memory (`in_law` false) or of the law and takes the number
/// with the least AICc. The number in `def` is not used. The trials end early where the rows are
/// too few for more constants.
/// @return as sn_fit(); SN_E_UNSUPPORTED where neither has terms, SN_E_RANGE (most).
SN_API sn_status sn_fit_choose_terms(const sn_fit_def *def, bool in_law, int most,
                                     sn_fit_choice *choice, sn_fit_result *result);
SN_API void sn_fit_release(sn_fit_result *result);
/// Stress that a tissue predicts for the recorded history of a curve.
SN_API sn_status sn_fit_predict(const sn_tissue *tissue, const sn_curve *curve,
                                sn_fit_curve *prediction);

#ifdef __cplusplus
}
#endif
