// Neo-Hookean: one constant.
// SPDX-License-Identifier: Apache-2.0
// Source: Treloar (1943); Rivlin (1948).
//
//     W = mu/2 (I1 - 3)
//
// I1 the first invariant of the isochoric right Cauchy-Green tensor, mu the shear modulus.
#include "law/isochoric.h"

enum { SHEAR, BULK };

SN_INLINE invariant_energy energy(const real *p, wide i1, wide i2) {
    (void)i2;
    real half = (real)0.5 * p[SHEAR];
    return (invariant_energy){.W = half * i1, .w1 = wide_set(half)};
}
SN_LAW_INVARIANT_KERNEL(neo_hookean, 0)

#if SN_LAW_TABLE
/// w1 = mu/2
static void slopes(const double *p, double i1, invariant_slope out[]) {
    (void)p, (void)i1;
    out[SHEAR] = (invariant_slope){.w1 = 0.5};
}
SN_LAW_INVARIANT_SENSITIVITY(1)

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(p[SHEAR], p[BULK]);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("shear_modulus", "mu", "Shear modulus."),
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_neo_hookean = {
    .name = "neo-hookean",
    .text = "Isotropic; the simplest law that holds at large strain.",
    .source = "Treloar, Trans. Faraday Soc. 39 (1943) 241; Rivlin, Phil. Trans. R. Soc. A 240 "
              "(1948) 459",
    .kind = SN_LAW_SOLID,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
