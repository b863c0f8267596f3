// Tissues whose parts have a memory each, and what of a force is whose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodies.h"
#include "springs/net.h"

/// hgo of dispersed fibres in two families at an angle, without memory.
static inline sn_tissue artery(double k1, double bulk) {
    static const char *const name[] = {"mu", "k1", "k2", "kappa", "angle", "bulk_modulus"};
    const double value[] = {1300, k1, 1.6, 0.1, 0.5, bulk};
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

/// One memory for all parts, the fibres' exponentials in another order, so that all are kept apart.
static inline void equal_memories(sn_tissue *t) {
    sn_tissue part[2];
    t->branched = true;
    t->memory = t->volumetric = prony(0.3, 0.05, 0.2, 0.4);
    if (!t->law->fibre_constant) return;
    t->fibre = prony(0.2, 0.4, 0.3, 0.05);
    assert_int_equal(sn_tissue_split(t, part), 2);
}
