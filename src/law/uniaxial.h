// From a pointwise uniaxial law to its batch kernels.
// SPDX-License-Identifier: Apache-2.0
//
// A law's file holds
//     SN_INLINE void point(const real *p, wide stretch, uniaxial_point *out);
//     SN_LAW_UNIAXIAL_KERNEL(name)
// The point function fills everything; what a batch did not ask for is never calculated, because
// the compiler drops it from the copy of the loop that has no use for it.
#pragma once

#include "law/kernels.h"

typedef struct uniaxial_point {
    wide W;  ///< energy per original volume, J/m3
    wide T;  ///< nominal stress, Pa
    wide dT; ///< dT/dstretch, Pa
} uniaxial_point;

typedef void uniaxial_law(const real *p, wide stretch, uniaxial_point *out);

/// Stores the lanes that there are.
SN_INLINE void uniaxial_store(real *to, int count, wide x) {
    if (count >= SN_LANES) {
        wide_store(to, x);
        return;
    }
    real lane[SN_LANES];
    wide_store(lane, x);
    memcpy(to, lane, (size_t)count * sizeof(real));
}

SN_INLINE void uniaxial_batch(const law_batch *b, uniaxial_law *law, bool stress_only) {
    const real *value = b->value;
    for (int i = 0; i < b->n; i += SN_LANES) {
        int count = b->n - i;
        wide stretch;
        if (count >= SN_LANES) {
            stretch = wide_load(b->in + i);
        } else {
            real lane[SN_LANES];
            for (int k = 0; k < SN_LANES; k++) lane[k] = k < count ? b->in[i + k] : 1;
            stretch = wide_load(lane);
        }
        uniaxial_point at;
        law(value, stretch, &at);
        if (b->S) uniaxial_store(b->S + i, count, at.T);
        if (stress_only) continue;
        if (b->W) uniaxial_store(b->W + i, count, at.W);
        if (b->D) uniaxial_store(b->D + i, count, at.dT);
    }
}

/// The kernel of this build, from the function `point`.
#define SN_LAW_UNIAXIAL_KERNEL(name)                                                               \
    SN_LAW_KERNELS(name)                                                                           \
    void SN_KERNEL(sn_law_##name)(const law_batch *b) {                                            \
        if (b->W || b->D)                                                                          \
            uniaxial_batch(b, point, false);                                                       \
        else                                                                                       \
            uniaxial_batch(b, point, true);                                                        \
    }
