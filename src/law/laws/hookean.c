// Hooke's law on the Green strain.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (5) and (16) of the paper.
//
//     W_d = mu e:e,  S = 2 mu e,  e = E - tr(E)/3 I,  mu = Y / (2 (1 + nu))
//
// e is the deviator of the Green strain itself, not of the isochoric strain, so S is linear in E
// and the tangent constant. Together with U(J), K = Y / (3 (1 - 2 nu)), whose stress is K tr(E) I
// to first order, it has the small-strain limit of equation (5). At large compression Hooke's law
// on the Green strain softens and collapses; that is the law, not the code.
#include "law/solid.h"

enum { YOUNG, POISSON };

SN_INLINE void point(const real *p, const wide E[6], solid_point *out) {
    const real mu = p[YOUNG] / (2 * (1 + p[POISSON]));
    const real third2 = (real)(2.0 / 3.0) * mu;
    out->S[0] = third2 * ((E[0] - E[1]) + (E[0] - E[2]));
    out->S[1] = third2 * ((E[1] - E[0]) + (E[1] - E[2]));
    out->S[2] = third2 * ((E[2] - E[0]) + (E[2] - E[1]));
    SOLID_UNROLL for (int i = 3; i < 6; i++) out->S[i] = 2 * mu * E[i];
    out->W = (real)0.5 * ((out->S[0] * E[0] + out->S[1] * E[1] + out->S[2] * E[2]) +
                          2 * (out->S[3] * E[3] + out->S[4] * E[4] + out->S[5] * E[5]));
    SOLID_UNROLL for (int i = 0; i < 6; i++) {
        SOLID_UNROLL for (int k = i; k < 6; k++) {
            real c = i == k ? (i < 3 ? 2 * third2 : mu) : k < 3 ? -third2 : 0;
            out->D[SOLID_UPPER(i, k)] = wide_set(c);
        }
    }
}
SN_LAW_SOLID_KERNEL(hookean)

#if SN_LAW_TABLE
/// mu = Y / (2 (1 + nu))
static void sensitivity(const double *p, int terms, int n, const double *E, double *dS) {
    (void)terms;
    const double by_young = 1 / (1 + p[POISSON]), by_poisson = -p[YOUNG] * by_young * by_young;
    for (int i = 0; i < n; i++) {
        double mean = (E[i] + E[(ptrdiff_t)n + i] + E[(ptrdiff_t)2 * n + i]) / 3;
        for (int c = 0; c < 6; c++) {
            double dev = E[(ptrdiff_t)c * n + i] - (c < 3 ? mean : 0);
            dS[(ptrdiff_t)(6 * YOUNG + c) * n + i] = by_young * dev;
            dS[(ptrdiff_t)(6 * POISSON + c) * n + i] = by_poisson * dev;
        }
    }
}

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = (sn_moduli){.young = p[YOUNG],
                       .shear = p[YOUNG] / (2 * (1 + p[POISSON])),
                       .bulk = p[YOUNG] / (3 * (1 - 2 * p[POISSON]))};
}

static const sn_param params[] = {
    SN_LAW_MODULUS("youngs_modulus", "Y", "Young's modulus."),
    {.name = "poissons_ratio",
     .symbol = "nu",
     .unit = "1",
     .min = -1,
     .min_open = true,
     .max = 0.5,
     .max_open = true,
     .init = (double)NAN,
     .text = "Poisson's ratio; near 0.5 the volume hardly changes."},
};

const sn_law sn_law_hookean = {
    .name = "hookean",
    .text = "Isotropic and linear in the Green strain; for small strains at any rotation.",
    .source = "equation (5)",
    .kind = SN_LAW_SOLID,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
