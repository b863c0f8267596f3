// A body that a test drives.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "body.h"

static const double size[3] = {0.04, 0.02, 0.02};
static const int cells[3] = {4, 2, 2};

static inline double farthest(const body *b) {
    double most = 0;
    for (int i = 0; i < 4 * b->net->nodes; i++)
        most = fmax(most, fabs(sn_real_at(b->s->precision, b->s->u, (size_t)i)));
    return most;
}

static inline sn_case *soft_block(void) {
    sn_tissue t = neo_hookean(3e3, 2e4);
    return make_block(size, cells, SN_PATTERN_MIRRORED, &t);
}
