// Fung's general law: a quadratic and an exponential part, both orthotropic.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (18) of the paper.
//
//     W = P/2 + c/2 (exp(Q) - 1)
//
// P and Q quadratic forms as in law/orthotropic.h at the isochoric strain, in the axes of the
// material: P with the constants alpha, in pascals, Q with the constants a. Against equation (18):
// P/2 = 1/2 alpha_ijkl E_ij E_kl; c/2 = beta_0; Q = gamma_ijkl E_ij E_kl. gamma_ij must be zero, or
// the body would not be free of stress at rest; the polynomial beta_mnpq E_mn E_pq in front of the
// exponential is left out (P has its part at small strains, Q at large ones), and the constant
// beta_0 is taken off, so that W = 0 at rest. Equation (19) without its cubic terms is the planar
// form. alpha = 0 leaves the law fung.
#include "law/isochoric.h"
#include "law/orthotropic.h"

enum { ALPHA, SCALE = ALPHA + ORTHOTROPIC, A, BULK = A + ORTHOTROPIC };

SN_INLINE void point(const real *p, const wide E[6], solid_point *out) {
    const real *alpha = p + ALPHA, *a = p + A;
    wide linear[6], q[6];
    orthotropic_times(alpha, E, linear);
    orthotropic_times(a, E, q);
    wide Q = solid_dot(q, E);
    wide scale = p[SCALE] * wide_exp(Q);
    out->W = (real)0.5 * (solid_dot(linear, E) + p[SCALE] * wide_expm1(Q));
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        out->S[i] = linear[i] + scale * q[i];
        SOLID_UNROLL for (int k = i; k < 6; k++) out->D[SOLID_UPPER(i, k)] =
            scale * (2 * q[i] * q[k] + orthotropic_slope(a, i, k)) + orthotropic_slope(alpha, i, k);
    }
}
SN_LAW_ISOCHORIC_KERNEL(fung_general)

#if SN_LAW_TABLE
/// Sbar = alpha E + c exp(Q) q
static void slopes(const double *p, const double E[6], double dS[][6]) {
    double q[6];
    orthotropic_times(p + A, E, q);
    double power = wide_exp(solid_dot(q, E));
    orthotropic_slopes(E, dS + ALPHA);
    for (int c = 0; c < 6; c++) dS[SCALE][c] = power * q[c];
    orthotropic_slopes(E, dS + A);
    orthotropic_exponential_slopes(p[SCALE] * power, q, E, dS + A);
}
SN_LAW_ISOCHORIC_SENSITIVITY(BULK)

/// Shear modulus: of shear in the plane of the second and third axes, S23 = (alpha_s23 + c s23) E23
/// = 2 mu E23 at rest. Young's modulus is that of the isotropic law with this shear modulus.
static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(0.5 * (p[ALPHA + 7] + p[SCALE] * p[A + 7]), p[BULK]);
}

static sn_status check(const double *p, int terms) {
    (void)terms;
    SN_TRY(orthotropic_check("fung-general", "alpha", p + ALPHA, true));
    return orthotropic_check("fung-general", "a", p + A, false);
}

static const sn_param params[] = {
    {.name = "alpha",
     .symbol = "alpha",
     .unit = "Pa",
     .min = -1e12,
     .max = 1e12,
     .init = (double)NAN,
     .length = ORTHOTROPIC,
     .text = "Quadratic part: alpha11, alpha22, alpha33, alpha12, alpha23, alpha31 and the shears "
             "12, 23, 31."},
    SN_LAW_MODULUS("c", "c", "Scale of the exponential part."),
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

const sn_law sn_law_fung_general = {
    .name = "fung-general",
    .text = "Orthotropic, a linear part and one that stiffens exponentially; skin, arteries.",
    .source = "equation (18)",
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
