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

#ifdef __cplusplus
}
#endif
