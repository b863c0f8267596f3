// Bars that can move along one axis alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "body.h"

#define DENSITY 1000.0 // of body_tissue()
static const sn_element elements[] = {SN_ELEMENT_P1, SN_ELEMENT_P2, SN_ELEMENT_P2P1};

// A bar of 0.1 m held at its left end that can move along `axis` alone: waves of one speed.
static inline sn_case *wave_bar(sn_element element, int cells, int axis, const sn_tissue *tissue) {
    sn_case *c = body_block(0.1, 0.01, 0.01, cells, 1, 1, tissue, element);
    bool held[3] = {true, true, true};
    body_support(c, "left", true, true, true);
    held[axis] = false;
    body_support(c, "boundary", held[0], held[1], held[2]);
    c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
    c->continuum.tolerance = 1e-9;
    body_probe(c, "tip", 0.1, 0.005, 0.005);
    body_reaction(c, "wall", "left");
    return c;
}
