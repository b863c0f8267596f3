// Fung: orthotropic, exponential.
// SPDX-License-Identifier: Apache-2.0
// Source: Fung, Fronek and Patitucci (1979); the exponential part of equation (18) of the paper.
//
//     W = c/2 (exp(Q) - 1)
//
// Q the quadratic form of law/orthotropic.h at the isochoric strain, in the axes of the material.
// Equation (21) is its planar form. Guccione's law is the case a11 = bf, a22 = a33 = s23 = bt,
// s12 = s31 = bfs, all others zero.
#include "law/isochoric.h"
#include "law/orthotropic.h"

enum { SCALE, A, BULK = A + ORTHOTROPIC };

SN_INLINE void point(const real *p, const wide E[6], solid_point *out) {
    const real *a = p + A;
    wide q[6];
    orthotropic_times(a, E, q);
    wide Q = solid_dot(q, E);
    wide scale = p[SCALE] * wide_exp(Q);
    out->W = (real)0.5 * p[SCALE] * wide_expm1(Q);
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        out->S[i] = scale * q[i];
        SOLID_UNROLL for (int k = i; k < 6; k++) out->D[SOLID_UPPER(i, k)] =
            scale * (2 * q[i] * q[k] + orthotropic_slope(a, i, k));
    }
}
SN_LAW_ISOCHORIC_KERNEL(fung)

#if SN_LAW_TABLE
/// Sbar = c exp(Q) q
static void slopes(const double *p, const double E[6], double dS[][6]) {
    double q[6];
    orthotropic_times(p + A, E, q);
    double power = wide_exp(solid_dot(q, E));
    for (int c = 0; c < 6; c++) dS[SCALE][c] = power * q[c];
    orthotropic_slopes(E, dS + A);
    orthotropic_exponential_slopes(p[SCALE] * power, q, E, dS + A);
}
SN_LAW_ISOCHORIC_SENSITIVITY(BULK)

/// Shear modulus: of shear in the plane of the second and third axes, S23 = c s23 E23 = 2 mu E23 at
/// rest. Young's modulus is that of the isotropic law with this shear modulus.
static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(0.5 * p[SCALE] * p[A + 7], p[BULK]);
}

static sn_status check(const double *p, int terms) {
    (void)terms;
    return orthotropic_check("fung", "a", p + A, false);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("c", "c", "Scale of the stress."),
    {.name = "a",
     .symbol = "a",
     .unit = "1",
     .min = -1000,
     .max = 1000,
     .init = (double)NAN,
     .length = ORTHOTROPIC,
     .text = "Stiffening: a11, a22, a33, a12, a23, a31 and the shears s12, s23, s31."},
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_fung = {
    .name = "fung",
    .text = "Orthotropic, stiffens exponentially; arteries, skin, heart.",
    .source = "equation (18), exponential part; Fung, Fronek and Patitucci, Am. J. Physiol. 237 "
              "(1979) H620",
    .kind = SN_LAW_SOLID,
    .fibres = true,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .check = check,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
