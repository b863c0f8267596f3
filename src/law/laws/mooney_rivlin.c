// Mooney-Rivlin: two invariants, each with its constant.
// SPDX-License-Identifier: Apache-2.0
// Source: Mooney (1940), Rivlin (1948).
//
//     W = c1 (I1 - 3) + c2 (I2 - 3)
//
// I1, I2 the invariants of the isochoric right Cauchy-Green tensor. Shear modulus 2 (c1 + c2).
#include "law/isochoric.h"

enum { C1, C2, BULK }; // order of the values, as in the table below

SN_INLINE invariant_energy energy(const real *p, wide i1, wide i2) {
    return (invariant_energy){
        .W = p[C1] * i1 + p[C2] * i2,
        .w1 = wide_set(p[C1]),
        .w2 = wide_set(p[C2]),
    };
}
SN_LAW_INVARIANT_KERNEL(mooney_rivlin, INVARIANT_W2)

#if SN_LAW_TABLE
/// Derivatives of dW/dI1 and dW/dI2 by the constants.
static void slopes(const double *p, double i1, invariant_slope out[]) {
    (void)p, (void)i1;
    out[C1] = (invariant_slope){.w1 = 1};
    out[C2] = (invariant_slope){.w2 = 1};
}
SN_LAW_INVARIANT_SENSITIVITY(2)

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(2 * (p[C1] + p[C2]), p[BULK]);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("c1", "c1", "Constant of the first invariant."),
    {.name = "c2",
     .symbol = "c2",
     .unit = "Pa",
     .min = 0,
     .max = 1e12,
     .init = (double)NAN,
     .text = "Constant of the second invariant; 0 leaves a neo-Hookean law."},
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_mooney_rivlin = {
    .name = "mooney-rivlin",
    .text = "Isotropic; rubber and soft gels at moderate stretch.",
    .source = "Mooney, J. Appl. Phys. 11 (1940) 582; Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379",
    .kind = SN_LAW_SOLID,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
