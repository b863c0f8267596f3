// A tissue: elastic law, memory, density and where the constants come from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/law.h"
#include "sinew/relax.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Parts of the stress that may have a memory each.
typedef enum sn_part {
    SN_PART_DEVIATORIC, ///< S_d, less its fibres where these have a memory of their own
    SN_PART_VOLUMETRIC, ///< the scalar dU/dJ
    SN_PART_FIBRE,      ///< the fibres' part of S_d
    SN_PARTS
} sn_part;

/// The material point that every solver and every fit uses. A plain value: copy it freely.
/// Memory acts on the distortional stress S_d as a whole and on the volume stress dU/dJ, with the
/// same G (equation 33 with one scalar G), or where `branched` with a G for each part (the tensor G
/// of equations 33 to 35); elastic constants are instantaneous, G(0) = 1.
typedef struct sn_tissue {
    char name[SN_NAME_MAX];
    char source[SN_TEXT_MAX]; ///< where the constants come from
    double density;           ///< kg/m3, NAN where not given
    const sn_law *law;
    int terms; ///< terms of list parameters of the law, else 0
    double value[SN_VALUES_MAX];
    double poissons_ratio; ///< for a uniaxial law in three dimensions; NAN where not given
    bool branched;         ///< the parts have a memory each; a solid law
    sn_memory memory;      ///< of all parts; of the deviatoric one where branched
    sn_memory volumetric;  ///< where branched; none where the law is incompressible
    sn_memory fibre;       ///< where branched; none where law->fibre_constant is NULL
} sn_tissue;

/// An empty tissue: no law, no memory, density NAN.
SN_API sn_tissue sn_tissue_default(void);
/// Law present, all constants in range. @return SN_OK, SN_E_DEFINITION, SN_E_RANGE.
SN_API sn_status sn_tissue_check(const sn_tissue *tissue);
/// Value of a scalar parameter of the law by name. NAN when the law has none of that name.
SN_API double sn_tissue_value(const sn_tissue *tissue, const char *name);
/// Sets a scalar parameter of the law. @return SN_OK, SN_E_NAME.
SN_API sn_status sn_tissue_set(sn_tissue *tissue, const char *name, double value);
/// The memory of a part: `memory` for all where the tissue is not branched.
SN_API const sn_memory *sn_tissue_memory(const sn_tissue *tissue, sn_part part);
/// The distortional stress as a sum: tissues that are not branched and whose S_d, each under its
/// own `memory`, add up to that of `tissue`: one, or the matrix and then the fibres where these
/// have another memory. They are for evaluation: the constants of the other are 0, maybe out of
/// range, and every one has the whole's bulk modulus.
/// @param part    (2). @return their number, 1 or 2.
SN_API int sn_tissue_split(const sn_tissue *tissue, sn_tissue part[2]);
/// The same where matrix and fibres are wanted apart whatever their memories.
/// @return 2, or 1 where the law's fibres have no energy of their own.
SN_API int sn_tissue_split_fibres(const sn_tissue *tissue, sn_tissue part[2]);
/// Converts constants that were given for the long term (G(infinity) = 1, Prony weights over the
/// long-term modulus, as FEBio and ArtiSynth have it) to ours (G(0) = 1): stresses are multiplied
/// by G(0)/G(infinity), Prony weights divided by it; each part by its own where branched.
/// @return SN_OK, SN_E_RANGE (a fluid has none), SN_E_UNSUPPORTED (hookean, whose constants are of
/// both parts, where they relax differently), what sn_tissue_check() says of branches.
SN_API sn_status sn_tissue_from_long_term(sn_tissue *tissue);
/// The way back, for memories `prony` and `none`: others are compressed by the caller first. The
/// weights may sum to more than 1 then: the result is for writing, not for evaluation.
/// @return as sn_tissue_from_long_term(); SN_E_UNSUPPORTED too for other memories. On failure the
/// tissue is as it was.
SN_API sn_status sn_tissue_to_long_term(sn_tissue *tissue);
/// Instantaneous small-strain moduli. A uniaxial law uses poissons_ratio for shear and bulk.
SN_API void sn_tissue_moduli(const sn_tissue *tissue, sn_moduli *out);
/// Instantaneous elastic stiffness at rest of a solid law, Pa: stress over strain, xx yy zz xy yz
/// zx, shears twice the tensor's, in the axes of space. Fibres that carry tension only have no part
/// in it.
/// @param axes  rotation to the axes of the material: rows are those axes
SN_API void sn_tissue_stiffness(const sn_tissue *tissue, const double axes[9], double C[6][6]);

#ifdef __cplusplus
}
#endif
