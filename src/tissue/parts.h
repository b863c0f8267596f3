// The parts of a tissue's stress inside the folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/tissue.h"

/// Whether a constant of the law belongs to a part of the stress: those in pascals do, the bulk
/// modulus to the volumetric one, the law's fibre constant to the fibres, the others to the rest.
bool sn_tissue_owns(const sn_law *law, const sn_param *param, sn_part part);
/// "deviatoric", "volumetric", "fibre": the keys in files.
const char *sn_tissue_part_name(sn_part part);
/// What the branches of a tissue with a law need of it, but for the ranges of their constants.
/// @return SN_OK, SN_E_UNSUPPORTED (no solid law; fibres that have no energy of their own),
/// SN_E_DEFINITION (a volumetric memory of an incompressible tissue).
sn_status sn_tissue_check_branches(const sn_tissue *tissue);
