// What speed costs: springs against the continuum on the same case.
// SPDX-License-Identifier: Apache-2.0
//
// A reference is run once for a case; models are then run on meshes of any size and held against it
// at the same material points: the nodes and cells of the reference's mesh.
#pragma once

#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SN_COMPARE_MODELS_MAX 16
#define SN_LIVE_BINS 56 ///< eight a decade, from 1 us to 10 s

/// Errors against the reference. Lengths, forces and stresses are over the reference's largest,
/// over all times; NAN where the case has none.
typedef struct sn_comparison_errors {
    double displacement_rms; ///< over points (by volume) and output times
    double displacement_max;
    double response_rms;   ///< of what answers: the force on what is moved, the motion of what is
                           ///< pushed; rms over output times, worst of the loads and tools
    double reaction_rms;   ///< the same of the force columns of the history (probes, tools)
    double stress_rms;     ///< Cauchy stress, over cells (by volume) and output times
    double energy;         ///< W + U of the instantaneous law at the end
    double relaxation_max; ///< of the force on what is moved, without what of it is elastic
                           ///< (docs/theory/study.md): what the memory is in error by; largest
                           ///< over output times. NAN where no tissue has a memory or no force
                           ///< answers
} sn_comparison_errors;

/// Frames of 1 ms of the explicit engine in single precision, at its stable step, as a simulator
/// runs them: what a model costs live, whatever integrator the comparison itself used.
typedef struct sn_live {
    double step_s;           ///< stable step at rest; NAN where the model is not for live use
    double real_time_factor; ///< of the median frame: other work on the machine does not count
    double frame_p50_s, frame_p99_s, frame_max_s; ///< wall time
    int frames;
    int bin[SN_LIVE_BINS]; ///< frames of a wall time from 10^(k/8) us to 10^((k + 1)/8) us
} sn_live;

/// One model of a comparison.
typedef struct sn_comparison_model {
    char name[SN_NAME_MAX];
    bool done; ///< false: summary.reason says why it could not run to the end
    sn_run_summary summary;
    sn_comparison_errors error;
    sn_live live;
    double calibration_s;     ///< time that finding the springs' constants took; 0 where none
    double peak_memory_bytes; ///< of the run above what was there before; 0: not known
    sn_record *history;       ///< owned
    sn_record *energy;        ///< owned; rows only of springs
    sn_record *response;  ///< owned; time, then for each load that moves or pushes and each tool
                          ///< that moves what is prescribed and what answers
                          ///< (NAME_displacement [m], NAME_force [N] in either order)
    sn_record *elastic;   ///< owned; the same response where no tissue has a memory; NULL where
                          ///< none has one anyway, no force answers or that run did not end
    int points;           ///< nodes of the reference's mesh
    double *displacement; ///< there, at the last common time, owned  (points x 3)
    double *distance;     ///< to the reference there, m, owned       (points)
} sn_comparison_model;

/// The continuum that models are held against. Release it also where its run did not end.
typedef struct sn_reference {
    sn_mesh *mesh;              ///< its nodes and cells are the material points, owned
    sn_comparison_model model;  ///< P2P1; its errors are its own estimated ones
    char text[SN_TEXT_MAX * 2]; ///< how it was converged and its error estimated
    int frames;                 ///< 0 where it did not run to its end
    double *time;               ///< owned                               (frames)
    double *displacement;       ///< m, owned             (frames x nodes x 3)
    double *stress;             ///< Cauchy stress, Pa, owned (frames x cells x 6)
} sn_reference;

/// The case on a mesh of its own shape with `factor` times the cells along each direction;
/// shapes from files are refined by sn_mesh_refine().
/// @return SN_OK, SN_E_RANGE (factor; a mesh from a file takes 1, 2, 4, …), what building says.
SN_API sn_status sn_compare_mesh(const sn_case *c, int factor, sn_case **on_mesh);

/// Runs P2P1 on the case's mesh. Its own error is estimated by P2P1 on a mesh of half the cells
/// along each edge (built-in shapes where that is possible, or `coarser`) or of twice: the
/// difference over 2^2 - 1, order 2 being what a solution with corners reaches.
/// @param coarser  Nullable: the case on a mesh of cells of about twice the size, whose nodes are
///                 nodes of the case's mesh
/// @return SN_OK also where the run did not end (model.done false); else what refuses the case.
SN_API sn_status sn_reference_create(const sn_case *c, const sn_case *coarser,
                                     const sn_output *output, sn_reference *reference);
SN_API void sn_reference_release(sn_reference *reference);

//---- models --------------------------------------------------------------------------------------

/// The models there are: 0 … count - 1.
SN_API int sn_compare_model_count(void);
SN_API const char *sn_compare_model_name(int model); ///< "central+volume", …
SN_API const char *sn_compare_model_text(int model); ///< what it is, one line
/// Whether a model belongs to the comparison of a case unless it is asked for by name; else `why`
/// says in one line why not.
SN_API bool sn_compare_model_fits(const sn_case *c, int model, char why[SN_TEXT_MAX]);
/// Runs a model of a case (on a mesh of its own) and holds it against the reference.
/// @return SN_OK also where the model refuses the case or stops early (out->done false, reason);
/// SN_E_MEMORY, SN_E_STOPPED, SN_E_DEFINITION (the reference did not run to its end).
SN_API sn_status sn_compare_model(const sn_reference *reference, const sn_case *c, int model,
                                  const sn_output *output, sn_comparison_model *out);
SN_API void sn_comparison_model_release(sn_comparison_model *model);

//---- all at once ---------------------------------------------------------------------------------

typedef struct sn_comparison {
    sn_reference reference;
    int model_count;
    sn_comparison_model model[SN_COMPARE_MODELS_MAX];
} sn_comparison;

/// The reference and models, all on the case's own mesh.
/// @param models  Nullable: those that fit                                 (count)
SN_API sn_status sn_compare(const sn_case *c, int count, const int *models, const sn_output *output,
                            sn_comparison *comparison);
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
    double left[2];  ///< parts of the forces that even and linearly growing strains want at nodes
                     ///< which no springs can give; NAN but where they were fitted
    double scale;    ///< common factor from the held tests; 1 where not fitted
    double strain;   ///< the nonlinear part was fitted up to this |stretch - 1| and shear
    double exponent; ///< of the law of the springs
    double square[SN_SPRING_SQUARES]; ///< C and c of it
    double factor; ///< on all stiffnesses, fitted with the law; 1 where not fitted
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
