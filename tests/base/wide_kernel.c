// base/wide.h as kernels: compiled for every instruction set and precision, called by test_wide.c.
// SPDX-License-Identifier: Apache-2.0
#include "wide_kernel.h"
#include "base/wide.h"

/// y = op(x) for n numbers, n a multiple of 16.
void SN_KERNEL(test_wide)(int op, int n, const real *in, real *out);
void SN_KERNEL(test_wide)(int op, int n, const real *in, real *out) {
    switch (op) {
#define X(name, call)                                                                              \
    case WIDE_##name:                                                                              \
        for (int i = 0; i < n; i += SN_LANES) {                                                    \
            wide x = wide_load(in + i);                                                            \
            wide_store(out + i, call);                                                             \
        }                                                                                          \
        break;
        WIDE_OPS(X)
#undef X
    case WIDE_gather:
        for (int i = 0; i < n; i += SN_LANES) {
            int index[SN_LANES];
            for (int k = 0; k < SN_LANES; k++)
                index[k] = (i + k) / 16 * 16 + (5 * (i + k) + 3) % 16;
            wide_store(out + i, wide_gather(in, index));
        }
        break;
    }
}
