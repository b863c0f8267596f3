// Stresses of a tissue along a recorded biaxial or shear curve.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/lab.h"

/// The strains of a recorded curve, laid out once: they do not depend on the constants.
typedef struct sn_in_plane sn_in_plane;

/// Whether a law and a curve that is not uniaxial go together: membranes and incompressible solids
/// do. @return SN_OK, SN_E_UNSUPPORTED.
sn_status sn_in_plane_check(const sn_tissue *tissue, const sn_curve *curve);
/// @param time    seconds, or anything that rises where there is no memory  (curve->count)
/// @param memory  the law will be used with a memory
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_in_plane_create(const sn_curve *curve, const double *time, const sn_law *law,
                             bool memory, sn_in_plane **path);
void sn_in_plane_destroy(sn_in_plane *path); // NULL is allowed
/// Nominal stresses, Pa: of a shear curve T12 (count), of a biaxial one T1, then T2 (2 x count). A
/// smooth function of the tissue's constants. @param e  the tissue's memory as exponentials
/// @return SN_OK, SN_E_RANGE (a step under a Voigt memory), SN_E_MEMORY.
sn_status sn_in_plane_stress(const sn_in_plane *path, const sn_tissue *tissue,
                             const sn_exponentials *e, double *stress);
