// From a pointwise solid law to its batch kernels.
// SPDX-License-Identifier: Apache-2.0
//
// A law's file holds a pointwise function and one line that makes the kernels of it:
//     SN_LAW_SOLID_KERNEL(name)       point(p, E, out): W_d, S, D at the Green strain E
//     SN_LAW_LIST_KERNEL(name)        point(p, terms, E, out): the same, constants in lists
//     SN_LAW_ISOCHORIC_KERNEL(name)   point(p, E, out), at the isochoric strain (law/isochoric.h)
//     SN_LAW_INVARIANT_KERNEL(name)   energy(p, i1, i2): a function of invariants (law/isochoric.h)
// The point function fills everything; there are three copies of the loop (stress; energy and
// stress; all), and from each the compiler drops what has no use there.
//
// Order of components and of the tangent: sinew/law.h.
#pragma once

#include "law/kernels.h"

typedef struct solid_point {
    wide W;     ///< energy, J/m3
    wide S[6];  ///< second Piola-Kirchhoff stress, Pa
    wide D[21]; ///< tangent, Pa
} solid_point;

/// A law: constants, length of the lists among them, strain.
typedef void solid_law(const real *p, int terms, const wide E[6], solid_point *out);

enum { SOLID_STRESS, SOLID_ENERGY, SOLID_TANGENT };

/// Place of row i, column j >= i in the upper triangle.
#define SOLID_UPPER(i, j) ((i) * (11 - (i)) / 2 + (j))

// all loops over components are unrolled, so that arrays of components become registers
#ifdef __clang__
#define SOLID_UNROLL _Pragma("clang loop unroll(full)")
#else
#define SOLID_UNROLL _Pragma("GCC unroll 21")
#endif

/// Copies `count` numbers of each of `rows` rows. The last points, fewer than lanes, go through
/// rows of full length (the other lanes are at rest, which no law minds).
SN_INLINE void solid_rest_copy(real *to, const real *from, int rows, int to_stride, int from_stride,
                               int count) {
    for (int k = 0; k < rows; k++)
        memcpy(to + (ptrdiff_t)k * to_stride, from + (ptrdiff_t)k * from_stride,
               (size_t)count * sizeof(real));
}

/// `rows` components of one group of lanes: straight to the batch, or by way of `rest`.
SN_INLINE void solid_store(const wide *x, int rows, real *to, int n, int count, real *rest) {
    real *at = count < SN_LANES ? rest : to;
    const ptrdiff_t stride = count < SN_LANES ? SN_LANES : n;
    SOLID_UNROLL for (int k = 0; k < rows; k++) wide_store(at + k * stride, x[k]);
    if (count < SN_LANES) solid_rest_copy(to, rest, rows, n, SN_LANES, count);
}

SN_INLINE void solid_batch(const law_batch *b, solid_law *law, int level) {
    const int n = b->n;
    for (int i = 0; i < n; i += SN_LANES) {
        const int count = n - i;
        real rest[21 * SN_LANES];
        const real *from = b->in + i;
        ptrdiff_t stride = n;
        if (count < SN_LANES) {
            memset(rest, 0, sizeof rest);
            solid_rest_copy(rest, from, 6, SN_LANES, n, count);
            from = rest;
            stride = SN_LANES;
        }
        wide E[6];
        SOLID_UNROLL for (int k = 0; k < 6; k++) E[k] = wide_load(from + k * stride);
        solid_point out;
        law(b->value, b->terms, E, &out);
        if (b->S) solid_store(out.S, 6, b->S + i, n, count, rest);
        if (level >= SOLID_ENERGY && b->W) solid_store(&out.W, 1, b->W + i, n, count, rest);
        if (level >= SOLID_TANGENT) solid_store(out.D, 21, b->D + i, n, count, rest);
    }
}

/// The kernel of this build, from a solid_law.
#define SN_LAW_KERNEL_OF(name, law)                                                                \
    SN_LAW_KERNELS(name)                                                                           \
    void SN_KERNEL(sn_law_##name)(const law_batch *b) {                                            \
        if (b->D)                                                                                  \
            solid_batch(b, law, SOLID_TANGENT);                                                    \
        else if (b->W)                                                                             \
            solid_batch(b, law, SOLID_ENERGY);                                                     \
        else                                                                                       \
            solid_batch(b, law, SOLID_STRESS);                                                     \
    }

#define SN_LAW_SOLID_KERNEL(name)                                                                  \
    SN_INLINE void plain_point(const real *p, int terms, const wide E[6], solid_point *out) {      \
        (void)terms;                                                                               \
        point(p, E, out);                                                                          \
    }                                                                                              \
    SN_LAW_KERNEL_OF(name, plain_point)

#define SN_LAW_LIST_KERNEL(name) SN_LAW_KERNEL_OF(name, point)
