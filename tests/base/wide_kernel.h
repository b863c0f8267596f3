// The functions of base/wide.h that test_wide.c compares, one name each.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#define WIDE_OPS(X)                                                                                \
    X(exp, wide_exp(x))                                                                            \
    X(expm1, wide_expm1(x))                                                                        \
    X(expm1_near, wide_expm1_near(x))                                                              \
    X(phi1, wide_phi1(x))                                                                          \
    X(phi2, wide_phi2(x))                                                                          \
    X(log, wide_log(x))                                                                            \
    X(rcbrt_m1, wide_rcbrt_m1(x))                                                                  \
    X(sqrt, wide_sqrt(x))                                                                          \
    X(abs, wide_abs(x))                                                                            \
    X(min, wide_min(x, wide_set((real)0.1)))                                                       \
    X(max, wide_max(x, wide_set((real)0.1)))

enum wide_op {
#define X(name, call) WIDE_##name,
    WIDE_OPS(X)
#undef X
        WIDE_gather, ///< x[16 j + (5 i + 3) % 16] for number 16 j + i
    WIDE_COUNT
};
