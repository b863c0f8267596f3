// The exponential uniaxial law of soft tissues.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (13) and (14) of the paper.
//
//     T = C/B (exp(B (stretch - 1)) - 1),  dT/dstretch = B T + C
//
// T the nominal stress. With e = stretch - 1 and the functions of base/wide.h it reads
// T = C e phi1(B e) and W = C e^2 phi2(B e), which hold for B = 0 too: T = C e. Below stretch 1 the
// law gives compression that tends to -C/B.
#include "law/uniaxial.h"

enum { B, C };

SN_INLINE void point(const real *p, wide stretch, uniaxial_point *out) {
    wide e = stretch - 1;
    wide x = p[B] * e;
    out->T = p[C] * e * wide_phi1(x);
    out->dT = p[C] * wide_exp(x);
    out->W = p[C] * e * e * wide_phi2(x);
}
SN_LAW_UNIAXIAL_KERNEL(exponential)

#if SN_LAW_TABLE
/// dT/dB = C e^2 phi1'(x), x = B e, and phi1' = phi1 - phi2.
static void sensitivity(const double *p, int terms, int n, const double *stretch, double *dT) {
    (void)terms;
    for (int i = 0; i < n; i++) {
        double e = stretch[i] - 1, x = p[B] * e, one = wide_phi1(x);
        dT[B * n + i] = p[C] * e * e * (one - wide_phi2(x));
        dT[C * n + i] = e * one;
    }
}

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = (sn_moduli){.young = p[C]};
}

static const sn_param params[] = {
    SN_LAW_NUMBER("B", "B", 0, 10000, "How fast the slope grows with the stress; 0 is linear."),
    SN_LAW_MODULUS("C", "C", "Slope of nominal stress against stretch at rest."),
};

const sn_law sn_law_exponential = {
    .name = "exponential",
    .text = "Slope grows in proportion to stress: tendon, skin, muscle at rest, along one axis.",
    .source = "equation (14)",
    .kind = SN_LAW_UNIAXIAL,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
