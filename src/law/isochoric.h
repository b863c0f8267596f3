// The isochoric split: laws that are given on the strain without its change of volume.
// SPDX-License-Identifier: Apache-2.0
// Source: the split of Flory (1961); stress and tangent by the projections of Holzapfel, Nonlinear
// Solid Mechanics (2000), section 6.4.
//
// With C = 2 E + I, J^2 = det C and Cbar = J^(-2/3) C the law is a function of
// Ebar = (Cbar - I) / 2. We never form Cbar - I, which would lose all of a small strain in single
// precision. As Cbar does not notice a dilatation, C is divided by a third of its trace instead:
//     C = a G,  G = I + g,  a = 1 + 2/3 tr E,  g = 2 dev E / a,  tr g = 0
//     det G = 1 + d,  d = det g - g:g / 2,  j = (1 + d)^(-1/3),  Cbar = j G
// in which j - 1 comes from d without cancellation (wide_rcbrt_m1), and with it
//     Ebar   = ((j - 1) I + j g) / 2
//     I1 - 3 = 3 (j - 1)
//     I2 - 3 = 3 (j - 1) (j + 1) - j^2 g:g / 2.
// With P = G^-1 = j^3 (I - g + adj g), so C^-1 = P / a, and Dev A = A - (A:G)/3 P, a stress
// Sbar = dW/dEbar and its tangent Hbar give
//     S = j/a S',   S' = Dev Sbar
//     D = j/a^2 { j Dev Hbar Dev^T + 2/3 t (P (.) P - P x P / 3) - 2/3 (P x S' + S' x P) }
// with t = Sbar:G and (P (.) P)_ijkl = (P_ik P_jl + P_il P_jk) / 2. Where Sbar holds a multiple of
// I (all isotropic laws), its part is N = Dev I = I - P = j^3 (d I + g - adj g): again no
// difference of large numbers. tr C > 0 wherever det C > 0, so the split exists wherever the law
// does.
#pragma once

#include "law/solid.h"

typedef struct isochoric {
    wide a_inverse; ///< 1/a
    wide j, j_m1;   ///< j and j - 1
    wide d;         ///< det G - 1
    wide g_half;    ///< g:g / 2
    wide g[6];      ///< g
    wide adj[6];    ///< adj g
    wide P[6];      ///< G^-1
} isochoric;

SN_INLINE void isochoric_split(const wide E[6], isochoric *q) {
    const real third2 = (real)(2.0 / 3.0);
    wide a = 1 + (E[0] + E[1] + E[2]) * third2;
    q->a_inverse = 1 / a;
    wide c = third2 * q->a_inverse, c2 = 2 * q->a_inverse;
    wide x = ((E[0] - E[1]) + (E[0] - E[2])) * c;
    wide y = ((E[1] - E[0]) + (E[1] - E[2])) * c;
    wide z = ((E[2] - E[0]) + (E[2] - E[1])) * c;
    wide xy = E[3] * c2, yz = E[4] * c2, zx = E[5] * c2;
    const wide g[6] = {x, y, z, xy, yz, zx};
    const wide adj[6] = {y * z - yz * yz,  z * x - zx * zx,  x * y - xy * xy,
                         yz * zx - xy * z, zx * xy - yz * x, xy * yz - zx * y};
    q->g_half = (x * x + y * y + z * z) * (real)0.5 + (xy * xy + yz * yz + zx * zx);
    q->d = (x * adj[0] + xy * adj[3] + zx * adj[5]) - q->g_half;
    q->j_m1 = wide_rcbrt_m1(q->d);
    q->j = q->j_m1 + 1;
    wide j3 = q->j * q->j * q->j;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        q->g[i] = g[i];
        q->adj[i] = adj[i];
        wide part = adj[i] - g[i];
        q->P[i] = j3 * (i < 3 ? 1 + part : part);
    }
}

/// A:B of symmetric tensors.
SN_INLINE wide solid_dot(const wide A[6], const wide B[6]) {
    return (A[0] * B[0] + A[1] * B[1] + A[2] * B[2]) +
           2 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}

/// Component (row i, column k) of P (.) P.
SN_INLINE wide isochoric_square(const wide P[6], int i, int k) {
    static const unsigned char first[6] = {0, 1, 2, 0, 1, 2}, second[6] = {0, 1, 2, 1, 2, 0};
    static const unsigned char at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    int a = first[i], b = second[i], c = first[k], d = second[k];
    wide one = P[at[a][c]] * P[at[b][d]], two = P[at[a][d]] * P[at[b][c]];
    return i < 3 || k < 3 ? one : (one + two) * (real)0.5; // equal there
}

//---- a law on Ebar -------------------------------------------------------------------------------

SN_INLINE void isochoric_strain(const isochoric *q, wide E[6]) {
    wide half_j = q->j * (real)0.5, half_m1 = q->j_m1 * (real)0.5;
    SOLID_UNROLL for (int i = 0; i < 6; i++) E[i] =
        i < 3 ? half_m1 + half_j * q->g[i] : half_j * q->g[i];
}

/// Takes Sbar and Hbar in *out to S and D.
SN_INLINE void isochoric_project(const isochoric *q, solid_point *out) {
    const real third = (real)(1.0 / 3.0), third2 = (real)(2.0 / 3.0);
    const wide *P = q->P;
    wide G[6], HG[6], dev[6], R[6];
    SOLID_UNROLL for (int i = 0; i < 6; i++) G[i] = i < 3 ? 1 + q->g[i] : q->g[i];
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        wide row[6];
        SOLID_UNROLL for (int k = 0; k < 6; k++) row[k] =
            out->D[i < k ? SOLID_UPPER(i, k) : SOLID_UPPER(k, i)];
        HG[i] = solid_dot(row, G);
    }
    wide t = solid_dot(out->S, G);
    wide scale = q->j * q->a_inverse;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        dev[i] = out->S[i] - t * third * P[i];
        out->S[i] = scale * dev[i];
        R[i] = -(third2 * dev[i] + q->j * third * HG[i]);
    }
    wide c = third2 * t;
    wide p = (q->j * solid_dot(HG, G) - 2 * t) * (real)(1.0 / 9.0);
    wide scale2 = scale * q->a_inverse;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        SOLID_UNROLL for (int k = i; k < 6; k++) {
            wide *D = &out->D[SOLID_UPPER(i, k)];
            wide sum =
                q->j * *D + c * isochoric_square(P, i, k) + P[i] * (p * P[k] + R[k]) + R[i] * P[k];
            *D = scale2 * sum;
        }
    }
}

/// Kernel of a law whose `point` is a function of Ebar.
#define SN_LAW_ISOCHORIC_KERNEL(name)                                                              \
    SN_INLINE void isochoric_point(const real *p, int terms, const wide E[6], solid_point *out) {  \
        (void)terms;                                                                               \
        isochoric q;                                                                               \
        wide Ebar[6];                                                                              \
        isochoric_split(E, &q);                                                                    \
        isochoric_strain(&q, Ebar);                                                                \
        point(p, Ebar, out);                                                                       \
        isochoric_project(&q, out);                                                                \
    }                                                                                              \
    SN_LAW_KERNEL_OF(name, isochoric_point)

#if SN_LAW_TABLE
/// S of a stress Sbar on Ebar: a linear map, so that it takes derivatives of Sbar to those of S.
SN_INLINE void isochoric_stress(const isochoric *q, const double Sbar[6], double S[6]) {
    double G[6], scale = q->j * q->a_inverse;
    SOLID_UNROLL for (int i = 0; i < 6; i++) G[i] = i < 3 ? 1 + q->g[i] : q->g[i];
    double third = solid_dot(Sbar, G) / 3;
    SOLID_UNROLL for (int i = 0; i < 6; i++) S[i] = scale * (Sbar[i] - third * q->P[i]);
}

/// `sensitivity` of a law on Ebar, from slopes(p, E, dS): the derivatives of Sbar by the first
/// `count` constants at the strain Ebar, into zeros.
#define SN_LAW_ISOCHORIC_SENSITIVITY(count)                                                        \
    static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {      \
        (void)terms;                                                                               \
        for (int i = 0; i < n; i++) {                                                              \
            isochoric q;                                                                           \
            double e[6], Ebar[6], bar[count][6] = {{0}}, S[6];                                     \
            for (int c = 0; c < 6; c++) e[c] = E[(ptrdiff_t)c * n + i];                            \
            isochoric_split(e, &q);                                                                \
            isochoric_strain(&q, Ebar);                                                            \
            slopes(p, Ebar, bar);                                                                  \
            for (int k = 0; k < (count); k++) {                                                    \
                isochoric_stress(&q, bar[k], S);                                                   \
                law_sensitivity_add(dS, 6, n, k, i, S);                                            \
            }                                                                                      \
        }                                                                                          \
    }
#endif

//---- a law of the invariants I1 and I2 of Cbar ---------------------------------------------------

/// Energy and its derivatives at i1 = I1 - 3, i2 = I2 - 3. W must be linear in i2, with no product
/// of i1 and i2: every law so far is.
typedef struct invariant_energy {
    wide W;   ///< J/m3
    wide w1;  ///< dW/di1
    wide w2;  ///< dW/di2
    wide w11; ///< d2W/di1^2
} invariant_energy;

/// Which of the derivatives are not simply zero; w1 always counts.
enum { INVARIANT_W2 = 1, INVARIANT_W11 = 2 };

/// i1, i2 of a split.
SN_INLINE void invariant_values(const isochoric *q, wide *i1, wide *i2) {
    *i1 = 3 * q->j_m1;
    *i2 = 3 * (q->j_m1 * (q->j + 1)) - q->j * q->j * q->g_half;
}

/// With Sbar = s0 I + s1 g, s0 = 2 (w1 + 2 j w2), s1 = -2 j w2, and
/// Hbar = 4 {w11 I x I + w2 (I x I - 1)}; 1 the identity of symmetric tensors.
SN_INLINE void invariant_point(const isochoric *q, const invariant_energy *w, int uses,
                               solid_point *out) {
    const real third = (real)(1.0 / 3.0), third2 = (real)(2.0 / 3.0);
    const wide *P = q->P;
    const bool has_w2 = uses & INVARIANT_W2, has_w11 = uses & INVARIANT_W11;
    wide jw2 = q->j * w->w2;
    wide s0 = has_w2 ? 2 * (w->w1 + 2 * jw2) : 2 * w->w1, s1 = -2 * jw2;
    wide j3 = q->j * q->j * q->j;
    wide scale = q->j * q->a_inverse;
    wide N[6], dev[6], R[6];
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        wide part = q->g[i] - q->adj[i];
        N[i] = j3 * (i < 3 ? q->d + part : part);
        dev[i] = s0 * N[i];
        if (has_w2) dev[i] = dev[i] + s1 * (q->g[i] - third2 * q->g_half * P[i]);
        out->S[i] = scale * dev[i];
        R[i] = -third2 * dev[i];
        if (has_w2) R[i] = R[i] + 4 * third * jw2 * (i < 3 ? 1 + q->g[i] : q->g[i]);
    }
    out->W = w->W;

    wide t = has_w2 ? 3 * s0 + 2 * s1 * q->g_half : 3 * s0; // Sbar:G
    wide c = third2 * t;
    wide p = -third * c;
    if (has_w2) p = p - (real)(4.0 / 9.0) * jw2 * (3 + 2 * q->g_half);
    wide nn = 4 * q->j * (has_w2 && has_w11 ? w->w11 + w->w2 : has_w2 ? w->w2 : w->w11);
    wide scale2 = scale * q->a_inverse;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        SOLID_UNROLL for (int k = i; k < 6; k++) {
            wide sum = c * isochoric_square(P, i, k) + P[i] * (p * P[k] + R[k]) + R[i] * P[k];
            if (uses) sum = sum + nn * N[i] * N[k];
            if (has_w2 && i == k) sum = sum - jw2 * (i < 3 ? (real)4 : (real)2);
            out->D[SOLID_UPPER(i, k)] = scale2 * sum;
        }
    }
}

/// Kernel of a law that is a function `energy` of the invariants; `uses`: its derivatives.
#define SN_LAW_INVARIANT_KERNEL(name, uses)                                                        \
    SN_INLINE void invariant_law(const real *p, int terms, const wide E[6], solid_point *out) {    \
        (void)terms;                                                                               \
        isochoric q;                                                                               \
        wide i1, i2;                                                                               \
        isochoric_split(E, &q);                                                                    \
        invariant_values(&q, &i1, &i2);                                                            \
        invariant_energy w = energy(p, i1, i2);                                                    \
        invariant_point(&q, &w, uses, out);                                                        \
    }                                                                                              \
    SN_LAW_KERNEL_OF(name, invariant_law)

#if SN_LAW_TABLE
/// Derivatives of w1 and w2 by one constant.
typedef struct invariant_slope {
    double w1, w2;
} invariant_slope;

/// S of w1 and w2, in which it is linear (see invariant_point()).
SN_INLINE void invariant_stress(const isochoric *q, invariant_slope w, double S[6]) {
    double s0 = 2 * (w.w1 + 2 * q->j * w.w2), s1 = -2 * q->j * w.w2;
    double j3 = q->j * q->j * q->j, scale = q->j * q->a_inverse;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        double part = q->g[i] - q->adj[i], N = j3 * (i < 3 ? q->d + part : part);
        S[i] = scale * (s0 * N + s1 * (q->g[i] - 2 * q->g_half * q->P[i] / 3));
    }
}

/// `sensitivity` of a law of the invariants, from slopes(p, i1, out) for its first `count`
/// constants.
#define SN_LAW_INVARIANT_SENSITIVITY(count)                                                        \
    static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {      \
        (void)terms;                                                                               \
        for (int i = 0; i < n; i++) {                                                              \
            isochoric q;                                                                           \
            invariant_slope w[count];                                                              \
            double e[6], S[6];                                                                     \
            for (int c = 0; c < 6; c++) e[c] = E[(ptrdiff_t)c * n + i];                            \
            isochoric_split(e, &q);                                                                \
            slopes(p, 3 * q.j_m1, w);                                                              \
            for (int k = 0; k < (count); k++) {                                                    \
                invariant_stress(&q, w[k], S);                                                     \
                law_sensitivity_add(dS, 6, n, k, i, S);                                            \
            }                                                                                      \
        }                                                                                          \
    }
#endif
