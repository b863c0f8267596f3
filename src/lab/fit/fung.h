// What a fit must know of the constants of Fung's laws: convexity, and shears that no curve sees.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/law.h"

/// One quadratic form of a law: where its constants stand among the law's values. Of a form of two
/// directions the others are -1.
typedef struct sn_fung_form {
    int normal[3]; ///< 11 22 33
    int cross[3];  ///< 12 23 31
    int shear[3];  ///< 12 23 31
} sn_fung_form;

/// The forms of a law, 0 to 2 of them.
int sn_fung_forms(const sn_law *law, const sn_fung_form **forms);
/// Shrinks the cross constants of every form by the largest common factor up to 1 for which the
/// matrix of its normal and cross constants is positive definite. What no factor can make so stays.
/// @param held  Nullable: constants that stay                       (values of the law)
/// @return the smallest factor; 1: nothing was changed.
double sn_fung_convex(const sn_law *law, const bool *held, double *value);
/// Whether this is a shear constant, and of which plane (0 the 12 plane). @return -1: it is none.
int sn_fung_shear_plane(const sn_law *law, int index);
/// Sets a shear constant to what an isotropic law with such normal constants would have:
/// (a_ii + a_jj)/2 - a_ij, above 0 for all convex forms. Guccione's bfs: (bf + bt)/2. At most
/// `most`.
void sn_fung_tie(const sn_law *law, int index, double most, double *value);
/// Whether a cross constant stands where a thousandth more would not be convex.
bool sn_fung_at_limit(const sn_law *law, const double *value, int index);
