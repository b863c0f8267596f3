// A tissue: elastic law, memory, density and where the constants come from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/law.h"
#include "sinew/relax.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The material point that every solver and every fit uses. A plain value: copy it freely.
/// Memory acts on the distortional stress S_d as a whole and on the volume stress dU/dJ, with the
/// same G (equation 33 with one scalar G); elastic constants are instantaneous, G(0) = 1.
typedef struct sn_tissue {
    char name[SN_NAME_MAX];
    char source[SN_TEXT_MAX]; ///< where the constants come from
    double density;           ///< kg/m3, NAN where not given
    const sn_law *law;
    int terms; ///< terms of list parameters of the law, else 0
    double value[SN_VALUES_MAX];
    double poissons_ratio; ///< for a uniaxial law in three dimensions; NAN where not given
    sn_memory memory;
} sn_tissue;

/// An empty tissue: no law, no memory, density NAN.
SN_API sn_tissue sn_tissue_default(void);
/// Law present, all constants in range. @return SN_OK, SN_E_DEFINITION, SN_E_RANGE.
SN_API sn_status sn_tissue_check(const sn_tissue *tissue);
/// Value of a scalar parameter of the law by name. NAN when the law has none of that name.
SN_API double sn_tissue_value(const sn_tissue *tissue, const char *name);
/// Sets a scalar parameter of the law. @return SN_OK, SN_E_NAME.
SN_API sn_status sn_tissue_set(sn_tissue *tissue, const char *name, double value);
/// Converts constants that were given for the long term (G(infinity) = 1, Prony weights over the
/// long-term modulus, as FEBio and ArtiSynth have it) to ours (G(0) = 1): stresses are multiplied
/// by G(0)/G(infinity), Prony weights divided by it. @return SN_OK, SN_E_RANGE (a fluid has none).
SN_API sn_status sn_tissue_from_long_term(sn_tissue *tissue);
/// Instantaneous small-strain moduli. A uniaxial law uses poissons_ratio for shear and bulk.
SN_API void sn_tissue_moduli(const sn_tissue *tissue, sn_moduli *out);

#ifdef __cplusplus
}
#endif
