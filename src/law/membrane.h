// From a pointwise membrane law to its batch kernels.
// SPDX-License-Identifier: Apache-2.0
//
// A law's file holds
//     SN_INLINE void point(const real *p, const wide E[3], membrane_point *out);
//     SN_LAW_MEMBRANE_KERNEL(name)
// and the rest is as in law/solid.h. Order of components and of the tangent: sinew/law.h.
#pragma once

#include "law/solid.h"

typedef struct membrane_point {
    wide W;    ///< energy per original volume, J/m3
    wide S[3]; ///< S11 S22 S12, Pa
    wide D[6]; ///< tangent dS/de, Pa
} membrane_point;

typedef void membrane_law(const real *p, const wide E[3], membrane_point *out);

SN_INLINE void membrane_batch(const law_batch *b, membrane_law *law, int level) {
    const int n = b->n;
    for (int i = 0; i < n; i += SN_LANES) {
        const int count = n - i;
        real rest[6 * SN_LANES];
        const real *from = b->in + i;
        ptrdiff_t stride = n;
        if (count < SN_LANES) {
            memset(rest, 0, sizeof rest);
            solid_rest_copy(rest, from, 3, SN_LANES, n, count);
            from = rest;
            stride = SN_LANES;
        }
        const wide E[3] = {wide_load(from), wide_load(from + stride), wide_load(from + 2 * stride)};
        membrane_point out;
        law(b->value, E, &out);
        if (b->S) solid_store(out.S, 3, b->S + i, n, count, rest);
        if (level >= SOLID_ENERGY && b->W) solid_store(&out.W, 1, b->W + i, n, count, rest);
        if (level >= SOLID_TANGENT) solid_store(out.D, 6, b->D + i, n, count, rest);
    }
}

/// The kernel of this build, from the function `point`.
#define SN_LAW_MEMBRANE_KERNEL(name)                                                               \
    SN_LAW_KERNELS(name)                                                                           \
    void SN_KERNEL(sn_law_##name)(const law_batch *b) {                                            \
        if (b->D)                                                                                  \
            membrane_batch(b, point, SOLID_TANGENT);                                               \
        else if (b->W)                                                                             \
            membrane_batch(b, point, SOLID_ENERGY);                                                \
        else                                                                                       \
            membrane_batch(b, point, SOLID_STRESS);                                                \
    }

#if SN_LAW_TABLE
/// Moduli at rest from the stiffnesses d11, d22, d12 of the normal strains and S12 = 2 shear E12.
static inline sn_moduli membrane_moduli(double d11, double d22, double d12, double shear) {
    return (sn_moduli){.young = d11 - d12 * d12 / d22, .shear = shear, .bulk = (double)INFINITY};
}

/// Refuses [a1 a4; a4 a2] that is not positive definite, and a3 that is not positive; `weak`: that
/// is indefinite or negative. a holds a1 to a4, `sign` what they are called.
static inline sn_status membrane_check(const char *law, const char *sign, const double a[4],
                                       bool weak) {
    double det = a[0] * a[1] - a[3] * a[3];
    const char *semi = weak ? "semi" : "";
    if (weak ? !(a[0] >= 0 && a[1] >= 0 && det >= -1e-12 * a[0] * a[1])
             : !(a[0] > 0 && a[1] > 0 && det > 0))
        return sn_fail(
            SN_E_RANGE,
            "law %s is not convex: %s1 is %g, %s2 is %g, %s1 %s2 - %s4^2 is %g: expected "
            "[%s1 %s4; %s4 %s2] positive %sdefinite",
            law, sign, a[0], sign, a[1], sign, sign, sign, det, sign, sign, sign, sign, semi);
    if (weak ? a[2] >= 0 : a[2] > 0) return SN_OK;
    return sn_fail(SN_E_RANGE, "law %s is not convex: %s3 is %g: expected %s 0", law, sign, a[2],
                   weak ? "at least" : "more than");
}
#endif
