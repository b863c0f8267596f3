// Veronda-Westmann: exponential in the first invariant, linear in the second.
// SPDX-License-Identifier: Apache-2.0
// Source: Veronda and Westmann (1970).
//
//     W = c1 (exp(c2 (I1 - 3)) - 1) - c1 c2/2 (I2 - 3)
//
// I1, I2 the invariants of the isochoric right Cauchy-Green tensor. Shear modulus at rest c1 c2.
#include "law/isochoric.h"

enum { C1, C2, BULK };

SN_INLINE invariant_energy energy(const real *p, wide i1, wide i2) {
    wide x = p[C2] * i1;
    real c12 = p[C1] * p[C2];
    wide w1 = c12 * wide_exp(x);
    return (invariant_energy){
        .W = p[C1] * wide_expm1(x) - (real)0.5 * c12 * i2,
        .w1 = w1,
        .w2 = wide_set((real)-0.5 * c12),
        .w11 = p[C2] * w1,
    };
}
SN_LAW_INVARIANT_KERNEL(veronda_westmann, INVARIANT_W2 | INVARIANT_W11)

#if SN_LAW_TABLE
/// w1 = c1 c2 exp(c2 i1), w2 = -c1 c2/2
static void slopes(const double *p, double i1, invariant_slope out[]) {
    double x = p[C2] * i1, power = wide_exp(x);
    out[C1] = (invariant_slope){.w1 = p[C2] * power, .w2 = -0.5 * p[C2]};
    out[C2] = (invariant_slope){.w1 = p[C1] * (1 + x) * power, .w2 = -0.5 * p[C1]};
}
SN_LAW_INVARIANT_SENSITIVITY(2)

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(p[C1] * p[C2], p[BULK]);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("c1", "c1", "Scale of the stress; the shear modulus at rest is c1 c2."),
    {.name = "c2",
     .symbol = "c2",
     .unit = "1",
     .min = 0,
     .min_open = true,
     .max = 1000,
     .init = (double)NAN,
     .log_scale = true,
     .text = "How fast it stiffens."},
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_veronda_westmann = {
    .name = "veronda-westmann",
    .text = "Isotropic, stiffens exponentially; skin.",
    .source = "Veronda and Westmann, J. Biomech. 3 (1970) 111",
    .kind = SN_LAW_SOLID,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
