// Tissues whose parts have a memory each, and what of a force is whose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "build.h"

/// hgo without memory: fibres of dispersion kappa in two families at an angle, or one along the
/// first axis.
static inline sn_tissue artery(double k1, double kappa, double angle, double bulk) {
    static const char *const name[] = {"mu", "k1", "k2", "kappa", "angle", "bulk_modulus"};
    const double value[] = {1300, k1, 1.6, kappa, angle, bulk};
    sn_tissue t = make_tissue("hgo");
    for (int k = 0; k < 6; k++) CHECK_OK(sn_tissue_set(&t, name[k], value[k]));
    return t;
}

/// Gives matrix, volume and fibres a memory each, of other times and other numbers of terms.
static inline void part_memories(sn_tissue *t) {
    t->branched = true;
    t->memory = prony(0.3, 0.25, 0.2, 3.0);
    t->volumetric = (sn_memory){.law = sn_memory_law_find("kelvin"), .value = {0.4, 0.7}};
    if (t->law->fibre_constant)
        t->fibre =
            (sn_memory){.law = sn_memory_law_find("fung-spectrum"), .value = {0.2, 0.02, 30}};
    CHECK_OK(sn_tissue_check(t));
}

/// Stress along the first axis of hgo by its parts, at F = diag(L, 1, 1), second Piola-Kirchhoff:
/// from the law with the constants of the other part put to 0 by hand.
static inline void part_stresses(const sn_tissue *t, double L, double stress[SN_PARTS]) {
    const double E[6] = {0.5 * (L * L - 1)}, bulk = sn_tissue_value(t, "bulk_modulus");
    for (int k = 0; k < SN_PARTS; k++) {
        double v[SN_VALUES_MAX], S[6];
        memcpy(v, t->value, sizeof v);
        v[k == SN_PART_DEVIATORIC] = 0; // k1 or mu
        sn_law_solid(t->law, v, 0, 1, E, NULL, S, NULL);
        stress[k] = k == SN_PART_VOLUMETRIC ? bulk * (L - 1) / L : S[0]; // p J C^-1, J = L
    }
}

/// A force over the first, against a sum of parts (weights sum to 1) that relax with their own G: a
/// jump at time 0, held, in 21 rows. Left over: the compression of the memories, 1e-6 of G(0) a
/// part.
static inline void check_relaxation(const sn_record *r, const sn_tissue *tissue,
                                    const double weight[SN_PARTS]) {
    const double *t = sn_record_values(r, "time"), *f = sn_record_values(r, "pull_fx");
    assert_true(r->rows == 21 && f[0] != 0);
    for (int i = 0; i < r->rows; i++) {
        double expected = 0;
        for (int k = 0; k < SN_PARTS; k++)
            expected +=
                weight[k] * sn_memory_relaxation(sn_tissue_memory(tissue, (sn_part)k), t[i]);
        CHECK_REL(f[i] / f[0], expected, 3e-6);
    }
}
