// Holzapfel-Gasser-Ogden: a matrix with two families of dispersed fibres.
// SPDX-License-Identifier: Apache-2.0
// Source: Gasser, Ogden and Holzapfel (2006).
//
//     W = mu/2 (I1 - 3) + k1/(2 k2) sum_i (exp(k2 <e_i>^2) - 1)
//     e_i = kappa (I1 - 3) + (1 - 3 kappa) (a_i.C a_i - 1)
//
// C the right Cauchy-Green tensor without the change of volume, I1 its trace, a_1 and a_2 the
// directions at +angle and -angle to the first axis in the plane of the first two axes. kappa
// spreads each family: 0 all fibres in line, 1/3 fibres in all directions. <e> is e where it is
// positive, else 0: fibres carry tension only. Stress is continuous there, the tangent jumps by k1.
//
// e_i is linear in the isochoric strain, de_i/dE = H_i = 2 (kappa I + (1 - 3 kappa) a_i x a_i), so
// with f = k1 e exp(k2 e^2), in the notation of law/isochoric.h,
//     Sbar = mu I + sum f_i H_i,  Hbar = sum f_i' H_i x H_i.
// Both are projected here: Dev H_i = 2 (kappa N + (1 - 3 kappa) Dev (a_i x a_i)), in which the
// round part of strongly dispersed fibres does not cancel, and Dev (mu I) = mu N as everywhere.
// k2 = 0 has its limit, W = k1/2 <e>^2.
#include "law/isochoric.h"

enum { MU, K1, K2, KAPPA, ANGLE, BULK };

/// Cosine and sine of an angle from 0 to pi/2, from the series at half of it: our own, so that all
/// machines have equal bits.
SN_INLINE void direction(real angle, real *cosine, real *sine) {
    const real t = (real)0.5 * angle, z = t * t;
    real c = 1, s = 1; // nested series of cos t and sin t / t
    for (int k = 9; k > 0; k--) {
        c = 1 - z / (real)(2 * k * (2 * k - 1)) * c;
        s = 1 - z / (real)(2 * k * (2 * k + 1)) * s;
    }
    s = s * t;
    *cosine = 1 - 2 * s * s;
    *sine = 2 * s * c;
}

typedef struct family {
    wide W;      ///< energy
    wide e;      ///< strain, 0 where not pulled
    wide along;  ///< a.G a - 1
    wide f, df;  ///< stress along H and its slope
    wide t;      ///< H:G
    wide dev[6]; ///< Dev H
} family;

/// The family of direction (c, s, 0); N = Dev I.
SN_INLINE void family_at(const real *p, const isochoric *q, const wide N[6], real c, real s,
                         family *out) {
    const real third = (real)(1.0 / 3.0), aligned = 1 - 3 * p[KAPPA];
    const real A[6] = {c * c, s * s, 0, c * s, 0, 0};
    wide along = q->g[0] * A[0] + q->g[1] * A[1] + 2 * (q->g[3] * A[3]); // a.G a - 1
    wide e = 3 * p[KAPPA] * q->j_m1 + aligned * (q->j_m1 + q->j * along);
    wide_mask pulled = wide_less(wide_set(0), e);
    e = wide_max(wide_set(0), e);
    out->e = e;
    out->along = along;
    wide x = p[K2] * e * e;
    wide slope = p[K1] * wide_exp(x);
    out->W = (real)0.5 * p[K1] * (e * e * wide_phi1(x));
    out->f = slope * e;
    out->df = wide_select(pulled, slope * (1 + 2 * x), wide_set(0));
    out->t = 6 * p[KAPPA] + 2 * aligned * (1 + along);
    SOLID_UNROLL for (int i = 0; i < 6; i++) out->dev[i] =
        2 * (p[KAPPA] * N[i] + aligned * (A[i] - (1 + along) * third * q->P[i]));
}

/// N = Dev I
SN_INLINE void round_part(const isochoric *q, wide N[6]) {
    wide j3 = q->j * q->j * q->j;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        wide part = q->g[i] - q->adj[i];
        N[i] = j3 * (i < 3 ? q->d + part : part);
    }
}

SN_INLINE void point(const real *p, const wide E[6], solid_point *out) {
    const real third2 = (real)(2.0 / 3.0);
    isochoric q;
    family one, two;
    real c, s;
    wide N[6], dev[6];
    isochoric_split(E, &q);
    round_part(&q, N);
    direction(p[ANGLE], &c, &s);
    family_at(p, &q, N, c, s, &one);
    family_at(p, &q, N, c, -s, &two);

    wide scale = q.j * q.a_inverse, scale2 = scale * q.a_inverse;
    out->W = (real)1.5 * p[MU] * q.j_m1 + (one.W + two.W);
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        dev[i] = p[MU] * N[i] + (one.f * one.dev[i] + two.f * two.dev[i]);
        out->S[i] = scale * dev[i];
    }
    wide t = third2 * (3 * p[MU] + (one.f * one.t + two.f * two.t));
    wide df1 = q.j * one.df, df2 = q.j * two.df;
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        SOLID_UNROLL for (int k = i; k < 6; k++) {
            wide fibres = df1 * one.dev[i] * one.dev[k] + df2 * two.dev[i] * two.dev[k];
            wide round = isochoric_square(q.P, i, k) - (real)(1.0 / 3.0) * q.P[i] * q.P[k];
            wide mixed = third2 * (q.P[i] * dev[k] + dev[i] * q.P[k]);
            out->D[SOLID_UPPER(i, k)] = scale2 * (fibres + (t * round - mixed));
        }
    }
}
SN_LAW_SOLID_KERNEL(hgo)

#if SN_LAW_TABLE
/// Adds the share of one family, f Dev H, of direction (c, s, 0): by kappa and the angle both f, by
/// way of e, and Dev H change.
static void family_slopes(const double *p, const isochoric *q, const double N[6], double c,
                          double s, double sign, double dev[BULK][6]) {
    family F;
    family_at(p, q, N, c, s, &F);
    const double aligned = 1 - 3 * p[KAPPA], over = p[K2] * F.e * F.e;
    const double A[6] = {c * c, s * s, 0, c * s, 0, 0};
    const double turn[6] = {-2 * c * s * sign, 2 * c * s * sign, 0, (c * c - s * s) * sign, 0, 0};
    double swing = solid_dot(q->g, turn) + turn[0] + turn[1]; // turn:G
    double by_kappa = -3 * q->j * F.along * F.df, by_angle = aligned * q->j * swing * F.df;
    for (int i = 0; i < 6; i++) {
        double round = 2 * (N[i] - 3 * (A[i] - (1 + F.along) / 3 * q->P[i]));
        double turned = 2 * aligned * (turn[i] - swing / 3 * q->P[i]);
        dev[K1][i] += F.e * wide_exp(over) * F.dev[i];
        dev[K2][i] += F.f * F.e * F.e * F.dev[i];
        dev[KAPPA][i] += by_kappa * F.dev[i] + F.f * round;
        dev[ANGLE][i] += by_angle * F.dev[i] + F.f * turned;
    }
}

static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {
    (void)terms;
    double c, s;
    direction(p[ANGLE], &c, &s);
    for (int i = 0; i < n; i++) {
        isochoric q;
        double e[6], dev[BULK][6] = {{0}};
        for (int m = 0; m < 6; m++) e[m] = E[(ptrdiff_t)m * n + i];
        isochoric_split(e, &q);
        round_part(&q, dev[MU]);
        family_slopes(p, &q, dev[MU], c, s, 1, dev);
        family_slopes(p, &q, dev[MU], c, -s, -1, dev);
        for (int k = 0; k < BULK; k++) {
            for (int m = 0; m < 6; m++) dev[k][m] *= q.j * q.a_inverse;
            law_sensitivity_add(dS, 6, n, k, i, dev[k]);
        }
    }
}

/// Of the matrix: at rest the fibres are about to carry.
static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(p[MU], p[BULK]);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("mu", "mu", "Shear modulus of the matrix."),
    {.name = "k1",
     .symbol = "k1",
     .unit = "Pa",
     .min = 0,
     .max = 1e12,
     .init = (double)NAN,
     .text = "Stiffness of each family of fibres at small stretch; 0 leaves a neo-Hookean law."},
    SN_LAW_NUMBER("k2", "k2", 0, 1000, "How fast the fibres stiffen."),
    SN_LAW_NUMBER("kappa", "kappa", 0, 1.0 / 3,
                  "Dispersion of the fibres: 0 all in line, 1/3 in all directions."),
    {.name = "angle",
     .symbol = "theta",
     .unit = "rad",
     .min = 0,
     .max = 1.5707963267948968, // pi/2 and a rounding unit, so that 90 deg is within
     .init = (double)NAN,
     .text = "Angle of the two families to the first axis, one on either side, in the plane of the "
             "first two axes."},
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_hgo = {
    .name = "hgo",
    .text = "Two families of dispersed fibres that carry tension only; arteries, skin, cornea.",
    .source = "Gasser, Ogden and Holzapfel, J. R. Soc. Interface 3 (2006) 15",
    .kind = SN_LAW_SOLID,
    .fibres = true,
    .fibre_constant = "k1",
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
