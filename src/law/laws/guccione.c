// Guccione: exponential, stiffest along the fibres; heart muscle at rest.
// SPDX-License-Identifier: Apache-2.0
// Source: Guccione, McCulloch and Waldman (1991); an instance of equation (18).
//
//     W = C/2 (exp(Q) - 1),
//     Q = bf E11^2 + bt (E22^2 + E33^2 + 2 E23^2) + bfs (2 E12^2 + 2 E13^2)
//
// E the isochoric strain in axes of which the first is the fibre. Q = sum b_i E_i^2 over all nine
// components, so S_i = C exp(Q) b_i E_i.
#include "law/isochoric.h"

enum { SCALE, BF, BT, BFS, BULK };

SN_INLINE void point(const real *p, const wide E[6], solid_point *out) {
    const real b[6] = {p[BF], p[BT], p[BT], p[BFS], p[BT], p[BFS]};
    wide q[6];
    SOLID_UNROLL for (int i = 0; i < 6; i++) q[i] = b[i] * E[i];
    wide Q = solid_dot(q, E);
    wide scale = p[SCALE] * wide_exp(Q);
    out->W = (real)0.5 * p[SCALE] * wide_expm1(Q);
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        out->S[i] = scale * q[i];
        SOLID_UNROLL for (int k = i; k < 6; k++) {
            wide d = 2 * q[i] * q[k];
            if (i == k) d = d + (i < 3 ? b[i] : (real)0.5 * b[i]);
            out->D[SOLID_UPPER(i, k)] = scale * d;
        }
    }
}
SN_LAW_ISOCHORIC_KERNEL(guccione)

#if SN_LAW_TABLE
/// Sbar_i = C exp(Q) b_i E_i, b_i one of three constants: the one of component i is group[i].
static void slopes(const double *p, const double E[6], double dS[][6]) {
    static const int group[6] = {BF, BT, BT, BFS, BT, BFS};
    double q[6], dQ[BULK] = {0};
    for (int c = 0; c < 6; c++) {
        q[c] = p[group[c]] * E[c];
        dQ[group[c]] += (c < 3 ? 1 : 2) * E[c] * E[c];
    }
    double power = wide_exp(solid_dot(q, E)), scale = p[SCALE] * power;
    for (int c = 0; c < 6; c++) {
        dS[SCALE][c] = power * q[c];
        for (int k = BF; k <= BFS; k++)
            dS[k][c] = scale * (dQ[k] * q[c] + (k == group[c] ? E[c] : 0));
    }
}
SN_LAW_ISOCHORIC_SENSITIVITY(BULK)

/// Shear modulus: of shear in the plane across the fibres, S23 = C bt E23 = 2 mu E23 at rest, which
/// is that of the isotropic law left when bf and bfs sink to bt. Young's modulus belongs to that
/// isotropic law too.
static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(0.5 * p[SCALE] * p[BT], p[BULK]);
}

#define EXPONENT(key, says)                                                                        \
    {                                                                                              \
        .name = key, .symbol = key, .unit = "1", .min = 0, .min_open = true, .max = 1000,          \
        .init = (double)NAN, .log_scale = true, .text = says                                       \
    }

static const sn_param params[] = {
    SN_LAW_MODULUS("C", "C", "Scale of the stress."),
    EXPONENT("bf", "Stiffening along the fibres."),
    EXPONENT("bt", "Stiffening across the fibres."),
    EXPONENT("bfs", "Stiffening in shear between fibre and cross directions."),
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_guccione = {
    .name = "guccione",
    .text = "Transversely isotropic, stiffens exponentially; heart muscle at rest.",
    .source = "Guccione, McCulloch and Waldman, J. Biomech. Eng. 113 (1991) 42; equation (18)",
    .kind = SN_LAW_SOLID,
    .fibres = true,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
