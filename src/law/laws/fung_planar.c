// Fung's planar exponential law: a membrane.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (21) of the paper; Fung, Fronek and Patitucci (1979).
//
//     W = c/2 (exp(Q) - 1),  Q = a1 E11^2 + a2 E22^2 + a3 (E12^2 + E21^2) + 2 a4 E11 E22
//
// per original volume, less the constant c/2 of equation (21). Its stresses are those of
// fung_skin.c without the linear and the cubic terms; what is said there of S12 and of the
// thickness holds here.
#include "law/membrane.h"

enum { SCALE, A1, A2, A3, A4 };

SN_INLINE void point(const real *p, const wide E[3], membrane_point *out) {
    const wide A[3] = {p[A1] * E[0] + p[A4] * E[1], p[A4] * E[0] + p[A2] * E[1], p[A3] * E[2]};
    wide Q = A[0] * E[0] + A[1] * E[1] + 2 * A[2] * E[2];
    wide scale = p[SCALE] * wide_exp(Q);
    out->W = (real)0.5 * p[SCALE] * wide_expm1(Q);
    for (int i = 0; i < 3; i++) out->S[i] = scale * A[i];
    out->D[0] = scale * (2 * A[0] * A[0] + p[A1]);
    out->D[1] = scale * (2 * A[0] * A[1] + p[A4]);
    out->D[2] = scale * (2 * A[0] * A[2]);
    out->D[3] = scale * (2 * A[1] * A[1] + p[A2]);
    out->D[4] = scale * (2 * A[1] * A[2]);
    out->D[5] = scale * (2 * A[2] * A[2] + (real)0.5 * p[A3]);
}
SN_LAW_MEMBRANE_KERNEL(fung_planar)

#if SN_LAW_TABLE
/// S = c exp(Q) A, so dS/da = c exp(Q) (dQ/da A + dA/da).
static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {
    (void)terms;
    for (int i = 0; i < n; i++) {
        const double x = E[i], y = E[(ptrdiff_t)n + i], z = E[(ptrdiff_t)2 * n + i];
        const double A[3] = {p[A1] * x + p[A4] * y, p[A4] * x + p[A2] * y, p[A3] * z};
        const double dQ[5] = {0, x * x, y * y, 2 * z * z, 2 * x * y};
        const double dA[5][3] = {{0}, {x, 0, 0}, {0, y, 0}, {0, 0, z}, {y, x, 0}};
        double power = wide_exp(A[0] * x + A[1] * y + 2 * A[2] * z), scale = p[SCALE] * power;
        for (int c = 0; c < 3; c++) {
            dS[(ptrdiff_t)(3 * SCALE + c) * n + i] = power * A[c];
            for (int k = A1; k <= A4; k++)
                dS[(ptrdiff_t)(3 * k + c) * n + i] = scale * (dQ[k] * A[c] + dA[k][c]);
        }
    }
}

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    double c = p[SCALE];
    *out = membrane_moduli(c * p[A1], c * p[A2], c * p[A4], 0.5 * c * p[A3]);
}

static sn_status check(const double *p, int terms) {
    (void)terms;
    return membrane_check("fung-planar", "a", p + A1, false);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("c", "c", "Scale of the stress."),
    SN_LAW_NUMBER("a1", "a1", 0, 1000, "Stiffening along the first axis."),
    SN_LAW_NUMBER("a2", "a2", 0, 1000, "Stiffening along the second axis."),
    SN_LAW_NUMBER("a3", "a3", 0, 1000, "Stiffening in shear."),
    SN_LAW_NUMBER("a4", "a4", -1000, 1000, "Stiffening between the axes."),
};

const sn_law sn_law_fung_planar = {
    .name = "fung-planar",
    .text = "Membrane: orthotropic, stiffens exponentially; skin, pericardium, valves.",
    .source = "equation (21); Fung, Fronek and Patitucci, Am. J. Physiol. 237 (1979) H620",
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
