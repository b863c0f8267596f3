// Values on finer and finer meshes, extrapolated.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/continuum.h"

/// Fills order, observed, extrapolated and error from the values on 2 or 3 meshes of halved cells.
/// @param floor  the part of a value that the solver leaves open
void sn_fe_extrapolate(sn_refined *q, int meshes, double floor);
/// The same from a value of linear cells, one of quadratic cells on the same mesh and, with
/// runs = 3, one of quadratic cells of half the size.
void sn_fe_extrapolate_order(sn_refined *q, int runs, double floor);
