// What the files of other programs share: units, memories of few terms, laws put together.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/io.h"

/// Units given and of use. @return SN_OK, SN_E_DEFINITION.
sn_status sn_foreign_check(const sn_foreign *how);
/// Before a tissue is written: units and tissue checked, remarks empty but for what the units
/// cannot say. @return as sn_foreign_check() and sn_tissue_check().
sn_status sn_foreign_start(const sn_tissue *tissue, sn_foreign *how);
/// Adds a sentence to the remarks.
void sn_foreign_remark(sn_foreign *how, const char *format, ...) SN_PRINTF(2, 3);
/// SI value of the unit of density that follows from stress, time and length; NAN without a length.
double sn_foreign_density(const sn_foreign *how);

/// The memory of a tissue as at most `most` exponentials: as it is, or the fewest within 1e-3, or
/// the best `most` can do. Fills terms and max_error of `how`. @return SN_OK, SN_E_UNSUPPORTED (an
/// impulse), SN_E_RANGE.
sn_status sn_foreign_memory(const sn_tissue *tissue, int most, sn_foreign *how,
                            sn_exponentials *out);

/// Starts a tissue of a law with `terms` terms; all its values are NAN.
void sn_foreign_law(sn_tissue *tissue, const char *law, int terms);
/// Sets value `index` of a parameter of the law, in SI.
void sn_foreign_set(sn_tissue *tissue, const char *name, int index, double value);
/// Value `index` of a parameter of the law.
double sn_foreign_get(const sn_tissue *tissue, const char *name, int index);
/// Multiplies every stress of the law but, unless `bulk`, the bulk modulus.
void sn_foreign_scale(sn_tissue *tissue, double factor, bool bulk);
/// Sets the memory: weights of G(0) = 1. None where there are no terms.
void sn_foreign_prony(sn_tissue *tissue, int terms, const double *g, const double *tau);
/// The nine constants of the orthotropic form of `fung`, also of a `guccione` tissue.
void sn_foreign_orthotropic(const sn_tissue *tissue, double a[9]);
