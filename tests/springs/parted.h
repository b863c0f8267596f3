// Tissues whose parts have a memory each, and what of a force is whose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodies.h"
#include "parts.h"
#include "springs/net.h"

/// One memory for all parts, the fibres' exponentials in another order, so that all are kept apart.
static inline void equal_memories(sn_tissue *t) {
    sn_tissue part[2];
    t->branched = true;
    t->memory = t->volumetric = prony(0.3, 0.05, 0.2, 0.4);
    if (!t->law->fibre_constant) return;
    t->fibre = prony(0.2, 0.4, 0.3, 0.05);
    assert_int_equal(sn_tissue_split(t, part), 2);
}
