// What speed costs: springs against the continuum on the same case.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SN_COMPARE_MODELS_MAX 8

/// One model of a comparison; errors relative to the reference's maximum over nodes and times.
typedef struct sn_comparison_model {
    char name[SN_NAME_MAX];
    bool done; ///< false: summary.reason says why it could not run to the end
    sn_run_summary summary;
    sn_record *history; ///< owned
    double displacement_rms, displacement_max;
    double reaction_rms;  ///< worst of the reaction probes and tools; NAN where there is none
    double stress_rms;    ///< Cauchy stress, volume-weighted over cells
    double energy;        ///< stored elastic energy at the end
    double *displacement; ///< at the last common time, owned  (nodes x 3)
    double *error;        ///< displacement error there, m, owned (nodes)
} sn_comparison_model;

typedef struct sn_comparison {
    sn_comparison_model reference;        ///< P2P1; its errors are its own estimated ones
    char reference_text[SN_TEXT_MAX * 2]; ///< how it was converged and its error estimated
    int model_count;
    sn_comparison_model model[SN_COMPARE_MODELS_MAX];
} sn_comparison;

/// Runs `central`, `coupled` and `smoothed`, each + volume, and P1 (what the mesh alone costs)
/// against P2P1 on the same mesh. The reference's own error is estimated by P2P1 on a coarser mesh
/// (built-in shapes) or by P2P1 on the refined mesh (others): the difference over 2^2 - 1, order 2
/// being what a solution with corners reaches.
SN_API sn_status sn_compare(const sn_case *c, const sn_output *output, sn_comparison *comparison);
SN_API void sn_comparison_destroy(sn_comparison *comparison);

//---- calibration ---------------------------------------------------------------------------------

/// Where the constants of central springs come from.
typedef enum sn_calibration_rule {
    SN_CALIBRATION_FULL,    ///< the best that this net can do (docs/theory/calibration.md)
    SN_CALIBRATION_AFFINE,  ///< what a central net takes by itself
    SN_CALIBRATION_UNIFORM, ///< one stiffness for all springs
    SN_CALIBRATION_LLOYD    ///< Lloyd, Szekely and Harders, IEEE Trans. Vis. Comput. Graph. 13
                            ///< (2007) 1081
} sn_calibration_rule;

#define SN_CALIBRATION_ERRORS_MAX 40

/// What springs are in error by under one virtual deformation.
typedef struct sn_calibration_error {
    /// "held, stretch x": stiffness at small strain over the continuum's, less 1, with the surface
    /// moved as the continuum's; "free, bend x": the same under tractions (sn_net_responses());
    /// "finite, shear xy": rms of the stress up to the strain, over its largest.
    char name[SN_NAME_MAX];
    double error;
} sn_calibration_error;

typedef struct sn_calibration_region {
    char name[SN_NAME_MAX];
    double left[2]; ///< parts of the forces that even and linearly growing strains want at nodes
                    ///< which no springs can give; NAN but where they were fitted
    double scale;   ///< common factor from the held tests; 1 where not fitted
    double strain;  ///< the nonlinear part was fitted up to this |stretch - 1| and shear
    double exponent;
    double factor; ///< on all stiffnesses, fitted with the exponent; 1 where not fitted
    int error_count;
    sn_calibration_error error[SN_CALIBRATION_ERRORS_MAX];
} sn_calibration_region;

typedef struct sn_calibration {
    sn_calibration_rule rule;
    sn_spring_set *set; ///< owned; sn_case.springs_given takes it (put NULL here then)
    int springs;        ///< with a stiffness above 0
    int beyond;         ///< of them, those that are no edges of the mesh
    int region_count;
    sn_calibration_region *region; ///< owned                    (region_count)
} sn_calibration;

/// Constants of the central rung for the mesh and the tissues of a case; the nonlinear part for the
/// strain that the case comes to in a quick run.
/// @param progress  Nullable; only its `progress` is called
/// @return SN_OK, SN_E_UNSUPPORTED (a tissue that central springs cannot carry), SN_E_SOLVER,
/// SN_E_MEMORY.
SN_API sn_status sn_calibrate(const sn_case *c, sn_calibration_rule rule, const sn_output *progress,
                              sn_calibration *out);
/// The same for a strain of the caller's, |stretch - 1|, at most 2; 0: as sn_calibrate().
SN_API sn_status sn_calibrate_to(const sn_case *c, sn_calibration_rule rule, double strain,
                                 const sn_output *progress, sn_calibration *out);
SN_API void sn_calibration_destroy(sn_calibration *calibration);

#ifdef __cplusplus
}
#endif
