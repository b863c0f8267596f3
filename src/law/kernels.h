// What a law's file and the registry share: batches, the table of kernels, rows of parameters.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/isa.h"
#include "base/wide.h"
#include "sinew/law.h"

/// Points for a kernel: arguments of sn_law_uniaxial() and sn_law_solid().
#define SN_LAW_BATCH(bits, type)                                                                   \
    typedef struct sn_law_batch_##bits {                                                           \
        const type *value; /* constants of the law, in the order of its table */                   \
        int terms;         /* length of lists among them */                                        \
        int n;             /* number of points */                                                  \
        const type *in;    /* stretch (n) or Green strain (6 x n) */                               \
        type *W, *S, *D;   /* Nullable: energy, stress, slope or tangent */                        \
    } sn_law_batch_##bits;                                                                         \
    typedef void sn_law_kernel_##bits(const sn_law_batch_##bits *batch);
SN_LAW_BATCH(64, double)
SN_LAW_BATCH(32, float)
#undef SN_LAW_BATCH

struct sn_law_kernels {
    sn_law_kernel_64 *f64[SN_ISA_COUNT];
    sn_law_kernel_32 *f32[SN_ISA_COUNT];
};

#if SN_REAL_BITS == 64
typedef sn_law_batch_64 law_batch;
#else
typedef sn_law_batch_32 law_batch;
#endif

/// A law's file is compiled many times; this build of it also holds the table.
#define SN_LAW_TABLE (SN_LANE_BYTES == 0 && SN_REAL_BITS == 64)

#define SN_LAW_DECLARE(isa, name)                                                                  \
    void sn_law_##name##_##isa##_64(const sn_law_batch_64 *batch);                                 \
    void sn_law_##name##_##isa##_32(const sn_law_batch_32 *batch);
#define SN_LAW_ROW_64(isa, name) sn_law_##name##_##isa##_64,
#define SN_LAW_ROW_32(isa, name) sn_law_##name##_##isa##_32,
#if SN_LAW_TABLE
/// `kernels` of this law: every instruction set and precision.
#define SN_LAW_KERNELS(name)                                                                       \
    SN_ISA_LIST_FOR(SN_LAW_DECLARE, name)                                                          \
    static const sn_law_kernels kernels = {.f64 = {SN_ISA_LIST_FOR(SN_LAW_ROW_64, name)},          \
                                           .f32 = {SN_ISA_LIST_FOR(SN_LAW_ROW_32, name)}};
#else
#define SN_LAW_KERNELS(name) SN_ISA_LIST_FOR(SN_LAW_DECLARE, name)
#endif

#if SN_LAW_TABLE
/// Adds the `rows` components of one constant, number k of the law, to the sensitivities of point i
/// of n (sn_law_sensitivity()).
SN_INLINE void law_sensitivity_add(double *dS, int rows, int n, int k, int i, const double *x) {
    double *at = dS + (ptrdiff_t)k * rows * n + i;
    for (int c = 0; c < rows; c++) at[(ptrdiff_t)c * n] += x[c];
}
#endif

//---- rows of parameter tables --------------------------------------------------------------------

/// A positive modulus in pascals that the user must give.
#define SN_LAW_MODULUS(key, sign, says)                                                            \
    {                                                                                              \
        .name = key, .symbol = sign, .unit = "Pa", .min = 0, .min_open = true, .max = 1e12,        \
        .init = (double)NAN, .log_scale = true, .text = says                                       \
    }
/// A pure number from `low`, allowed, to `high` that the user must give.
#define SN_LAW_NUMBER(key, sign, low, high, says)                                                  \
    {                                                                                              \
        .name = key, .symbol = sign, .unit = "1", .min = low, .max = high, .init = (double)NAN,    \
        .text = says                                                                               \
    }
/// K of U(J); kernels never read it.
#define SN_LAW_BULK_MODULUS                                                                        \
    {                                                                                              \
        .name = "bulk_modulus", .symbol = "K", .unit = "Pa", .min = 0, .min_open = true,           \
        .max = (double)INFINITY, .init = (double)NAN, .log_scale = true,                           \
        .infinity = "incompressible",                                                              \
        .text = "Bulk modulus: resistance to a change of volume, U(J) = K/2 (J - 1)^2."            \
    }

/// Moduli of an isotropic solid.
static inline sn_moduli law_moduli_of(double shear, double bulk) {
    double young = isinf(bulk) ? 3 * shear : 9 * bulk * shear / (3 * bulk + shear);
    return (sn_moduli){.young = young, .shear = shear, .bulk = bulk};
}
