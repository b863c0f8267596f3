// Fibres that are listed cell by cell and all alike, against one direction: whole runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "build.h"

/// The same axes, listed, every other cell with fibre and second axis turned round: the same law,
/// but no longer the same numbers.
static inline void list_alike(sn_case *c) {
    c->fibres.rule = SN_FIBRES_LISTED;
    c->fibres.count = c->mesh->cell_count;
    c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
    for (int k = 0; k < c->mesh->cell_count; k++)
        for (int i = 0; i < 3; i++) {
            c->fibres.listed[6 * k + i] = (k % 2 ? -1 : 1) * c->fibre[i];
            c->fibres.listed[6 * k + 3 + i] = (k % 3 ? -1 : 1) * c->fibres.sheet[i];
        }
}

/// Of the last frame.
typedef struct frames {
    double stress[6 * 200], fibre[3 * 200];
    int cells;
} frames;

static inline sn_status keep_frame(void *context, const sn_frame *frame) {
    frames *to = context;
    for (int k = 0; k < frame->field_count; k++) {
        const sn_field *f = &frame->fields[k];
        if (!strcmp(f->name, "cauchy_stress"))
            memcpy(to->stress, f->value, 6 * (size_t)to->cells * sizeof(double));
        if (strcmp(f->name, "fibre")) continue;
        assert_int_equal(f->place, SN_ON_CELLS);
        assert_int_equal(f->components, 3);
        memcpy(to->fibre, f->value, 3 * (size_t)to->cells * sizeof(double));
    }
    return SN_OK;
}

/// out[0] of one direction, out[1] of list_alike(); both solved to 1e-10 of the forces.
static inline void check_alike(const frames out[2], const sn_case *c) {
    double worst = 0, scale = 0;
    for (int i = 0; i < 6 * c->mesh->cell_count; i++) {
        worst = fmax(worst, fabs(out[0].stress[i] - out[1].stress[i]));
        scale = fmax(scale, fabs(out[0].stress[i]));
    }
    assert_true(scale > 100);
    CHECK_ABS(worst / scale, 0, 1e-7);
    for (int k = 0; k < 3 * c->mesh->cell_count; k++) {
        CHECK_ABS(out[0].fibre[k], c->fibre[k % 3], 1e-15);
        CHECK_ABS(out[1].fibre[k], (k / 3 % 2 ? -1 : 1) * c->fibre[k % 3], 1e-15);
    }
}
