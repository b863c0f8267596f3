// Fung's law of skin under biaxial stress: a membrane.
// SPDX-License-Identifier: Apache-2.0
// Source: Tong and Fung (1976); equations (19) and (20) of the paper.
//
//     W = 1/2 (alpha1 E11^2 + alpha2 E22^2 + alpha3 (E12^2 + E21^2) + 2 alpha4 E11 E22)
//       + c/2 (exp(Q) - 1)
//     Q = a1 E11^2 + a2 E22^2 + a3 (E12^2 + E21^2) + 2 a4 E11 E22
//       + gamma1 E11^3 + gamma2 E22^3 + gamma4 E11^2 E22 + gamma5 E11 E22^2
//
// per original volume, with the sign between its parts that equation (19) as printed lacks, and
// less the constant c/2. There is no gamma3. With X = exp(Q) the stresses (20) are
//     S11 = alpha1 E11 + alpha4 E22 + c A1 X,  S22 = alpha4 E11 + alpha2 E22 + c A2 X,
//     S12 = alpha3 E12 + c A3 X,
//     A1 = a1 E11 + a4 E22 + 3/2 gamma1 E11^2 + gamma4 E11 E22 + gamma5 E22^2 / 2
//     A2 = a4 E11 + a2 E22 + 3/2 gamma2 E22^2 + gamma4 E11^2 / 2 + gamma5 E11 E22,  A3 = a3 E12,
// S12 with E12 and E21 independent, half the derivative where one symbol stands for both. The
// strain is the whole strain, not the isochoric one: the thickness is free, its stretch that of an
// incompressible sheet, and no pressure is left to find. The cubic terms are not convex everywhere:
// they are for the range in which they were measured.
#include "law/membrane.h"

enum { ALPHA1, ALPHA2, ALPHA3, ALPHA4, SCALE, A1, A2, A3, A4, GAMMA1, GAMMA2, GAMMA4, GAMMA5 };

SN_INLINE void point(const real *p, const wide E[3], membrane_point *out) {
    const real half = (real)0.5, three_halves = (real)1.5;
    const wide x = E[0], y = E[1], z = E[2];
    wide xx = x * x, yy = y * y, xy = x * y;
    wide Q = (p[A1] * xx + p[A2] * yy) + 2 * (p[A3] * z * z + p[A4] * xy) +
             ((p[GAMMA1] * xx + p[GAMMA5] * yy) * x + (p[GAMMA2] * yy + p[GAMMA4] * xx) * y);
    const wide A[3] = {p[A1] * x + p[A4] * y + three_halves * p[GAMMA1] * xx + p[GAMMA4] * xy +
                           half * p[GAMMA5] * yy,
                       p[A4] * x + p[A2] * y + three_halves * p[GAMMA2] * yy +
                           half * p[GAMMA4] * xx + p[GAMMA5] * xy,
                       p[A3] * z};
    const wide linear[3] = {p[ALPHA1] * x + p[ALPHA4] * y, p[ALPHA4] * x + p[ALPHA2] * y,
                            p[ALPHA3] * z};
    wide scale = p[SCALE] * wide_exp(Q);
    out->W = half * (linear[0] * x + linear[1] * y + 2 * linear[2] * z + p[SCALE] * wide_expm1(Q));
    for (int i = 0; i < 3; i++) out->S[i] = linear[i] + scale * A[i];

    wide d11 = p[A1] + 3 * p[GAMMA1] * x + p[GAMMA4] * y;
    wide d12 = p[A4] + p[GAMMA4] * x + p[GAMMA5] * y;
    wide d22 = p[A2] + 3 * p[GAMMA2] * y + p[GAMMA5] * x;
    out->D[0] = p[ALPHA1] + scale * (2 * A[0] * A[0] + d11);
    out->D[1] = p[ALPHA4] + scale * (2 * A[0] * A[1] + d12);
    out->D[2] = scale * (2 * A[0] * A[2]);
    out->D[3] = p[ALPHA2] + scale * (2 * A[1] * A[1] + d22);
    out->D[4] = scale * (2 * A[1] * A[2]);
    out->D[5] = half * p[ALPHA3] + scale * (2 * A[2] * A[2] + half * p[A3]);
}
SN_LAW_MEMBRANE_KERNEL(fung_skin)

#if SN_LAW_TABLE
/// At one point: with X = exp(Q), of the linear part dS = dA; of c dS = A X; of the constants of Q
/// dS = c X (dQ A + dA). A is the sum of its constants times their dA, and Q likewise.
static void slopes(const double *p, double x, double y, double z, double dS[][3]) {
    enum { LAST = GAMMA5, COUNT = LAST + 1 - A1 };
    const double xx = x * x, yy = y * y, xy = x * y;
    const double dQ[COUNT] = {xx, yy, 2 * z * z, 2 * xy, xx * x, yy * y, xx * y, yy * x};
    const double dA[COUNT][3] = {{x, 0, 0},       {0, y, 0},        {0, 0, z},
                                 {y, x, 0},       {1.5 * xx, 0, 0}, {0, 1.5 * yy, 0},
                                 {xy, xx / 2, 0}, {yy / 2, xy, 0}};
    double Q = 0, A[3] = {0};
    for (int k = 0; k < COUNT; k++) {
        Q += p[A1 + k] * dQ[k];
        for (int c = 0; c < 3; c++) A[c] += p[A1 + k] * dA[k][c];
    }
    double X = wide_exp(Q);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 4; k++) dS[ALPHA1 + k][c] = dA[k][c];
        dS[SCALE][c] = A[c] * X;
        for (int k = 0; k < COUNT; k++) dS[A1 + k][c] = p[SCALE] * X * (dQ[k] * A[c] + dA[k][c]);
    }
}

static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {
    (void)terms;
    for (int i = 0; i < n; i++) {
        double one[GAMMA5 + 1][3];
        slopes(p, E[i], E[(ptrdiff_t)n + i], E[(ptrdiff_t)2 * n + i], one);
        for (int k = 0; k <= GAMMA5; k++) law_sensitivity_add(dS, 3, n, k, i, one[k]);
    }
}

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    double c = p[SCALE];
    *out = membrane_moduli(p[ALPHA1] + c * p[A1], p[ALPHA2] + c * p[A2], p[ALPHA4] + c * p[A4],
                           0.5 * (p[ALPHA3] + c * p[A3]));
}

static sn_status check(const double *p, int terms) {
    (void)terms;
    SN_TRY(membrane_check("fung-skin", "alpha", p + ALPHA1, true));
    return membrane_check("fung-skin", "a", p + A1, false);
}

#define LINEAR(key, low, says)                                                                     \
    {                                                                                              \
        .name = key, .symbol = key, .unit = "Pa", .min = low, .max = 1e12, .init = (double)NAN,    \
        .text = says                                                                               \
    }

static const sn_param params[] = {
    LINEAR("alpha1", 0, "Linear part along the first axis."),
    LINEAR("alpha2", 0, "Linear part along the second axis."),
    LINEAR("alpha3", 0, "Linear part in shear."),
    LINEAR("alpha4", -1e12, "Linear part between the axes."),
    SN_LAW_MODULUS("c", "c", "Scale of the exponential part."),
    SN_LAW_NUMBER("a1", "a1", 0, 1000, "Stiffening along the first axis."),
    SN_LAW_NUMBER("a2", "a2", 0, 1000, "Stiffening along the second axis."),
    SN_LAW_NUMBER("a3", "a3", 0, 1000, "Stiffening in shear."),
    SN_LAW_NUMBER("a4", "a4", -1000, 1000, "Stiffening between the axes."),
    SN_LAW_NUMBER("gamma1", "gamma1", -1000, 1000, "Cubic term of the first strain."),
    SN_LAW_NUMBER("gamma2", "gamma2", -1000, 1000, "Cubic term of the second strain."),
    SN_LAW_NUMBER("gamma4", "gamma4", -1000, 1000, "Cubic term, first strain squared."),
    SN_LAW_NUMBER("gamma5", "gamma5", -1000, 1000, "Cubic term, second strain squared."),
};

const sn_law sn_law_fung_skin = {
    .name = "fung-skin",
    .text = "Membrane: skin under biaxial stress, a linear and an exponential part.",
    .source = "equations (19) and (20); Tong and Fung, J. Biomech. 9 (1976) 649",
    .kind = SN_LAW_MEMBRANE,
    .fibres = true,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .check = check,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
