// The quadratic form of the strain that the orthotropic laws share.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (18) of the paper, with the symmetry of three planes.
//
//     Q = a11 E11^2 + a22 E22^2 + a33 E33^2 + 2 a12 E11 E22 + 2 a23 E22 E33 + 2 a31 E33 E11
//       + s12 (E12^2 + E21^2) + s23 (E23^2 + E32^2) + s31 (E31^2 + E13^2)
//
// in the axes of the material. The nine constants stand in this order, which is that of the
// components of a tensor twice over; the shears count E12 and E21 both, as equation (21) does.
#pragma once

#include "law/isochoric.h"

enum { ORTHOTROPIC = 9 };

/// Element of the 6 x 6 matrix of Q between tensor components: Q = E.A E, where a shear stands for
/// both of its components. 0 where the planes of symmetry want it.
SN_INLINE real orthotropic_at(const real *a, int i, int k) {
    if (i == k) return i < 3 ? a[i] : a[3 + i];
    if (i >= 3 || k >= 3) return 0;
    return a[i + k == 1 ? 3 : i + k == 3 ? 4 : 5];
}

/// q = A E, half the derivative of Q by the tensor E; and Q = q:E.
SN_INLINE void orthotropic_times(const real *a, const wide E[6], wide q[6]) {
    SOLID_UNROLL for (int i = 0; i < 3; i++) {
        q[i] = orthotropic_at(a, i, 0) * E[0] + orthotropic_at(a, i, 1) * E[1] +
               orthotropic_at(a, i, 2) * E[2];
        q[3 + i] = a[6 + i] * E[3 + i];
    }
}

/// dq_i/de_k, e with doubled shears (sinew/law.h).
SN_INLINE real orthotropic_slope(const real *a, int i, int k) {
    return i == k && i >= 3 ? (real)0.5 * a[3 + i] : orthotropic_at(a, i, k);
}

#if SN_LAW_TABLE
/// dq/da of q = A E for the nine constants, into zeros.
SN_INLINE void orthotropic_slopes(const double E[6], double dq[ORTHOTROPIC][6]) {
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3;
        dq[i][i] = E[i];
        dq[3 + i][i] = E[k];
        dq[3 + i][k] = E[i];
        dq[6 + i][3 + i] = E[3 + i];
    }
}

/// From dq/da to the derivatives of c exp(Q) q, which are c exp(Q) (dQ/da q + dq/da), dQ = dq:E.
SN_INLINE void orthotropic_exponential_slopes(double scale, const double q[6], const double E[6],
                                              double dq[ORTHOTROPIC][6]) {
    for (int k = 0; k < ORTHOTROPIC; k++) {
        double dQ = solid_dot(dq[k], E);
        for (int c = 0; c < 6; c++) dq[k][c] = scale * (dQ * q[c] + dq[k][c]);
    }
}

/// Refuses constants of which Q is not convex. It must be positive for every strain but 0 or, if
/// `weak`, negative for none: all principal minors positive, or not negative but for rounding.
/// `law` and `list` say whose constants they are.
static inline sn_status orthotropic_check(const char *law, const char *list, const double *a,
                                          bool weak) {
    const double det = a[0] * (a[1] * a[2] - a[4] * a[4]) - a[3] * (a[3] * a[2] - a[4] * a[5]) +
                       a[5] * (a[3] * a[4] - a[1] * a[5]);
    const struct {
        const char *text;
        double value, size;
    } minor[] = {
        {"11", a[0], 0},
        {"22", a[1], 0},
        {"33", a[2], 0},
        {"11 22 - 12^2", a[0] * a[1] - a[3] * a[3], a[0] * a[1]},
        {"22 33 - 23^2", a[1] * a[2] - a[4] * a[4], a[1] * a[2]},
        {"33 11 - 31^2", a[2] * a[0] - a[5] * a[5], a[2] * a[0]},
        {"det [11 12 31; 12 22 23; 31 23 33]", det, a[0] * a[1] * a[2]},
        {"shear 12", a[6], 0},
        {"shear 23", a[7], 0},
        {"shear 31", a[8], 0},
    };
    for (int k = 0; k < (int)(sizeof minor / sizeof minor[0]); k++) {
        bool good = weak ? minor[k].value >= -1e-12 * minor[k].size : minor[k].value > 0;
        if (good) continue;
        return sn_fail(SN_E_RANGE,
                       "law %s is not convex: of the nine constants %s, %s is %g: expected %s 0 "
                       "(the matrix of the normal strains positive %sdefinite, every shear %s 0)",
                       law, list, minor[k].text, minor[k].value, weak ? "at least" : "more than",
                       weak ? "semi" : "", weak ? "at least" : "more than");
    }
    return SN_OK;
}
#endif
