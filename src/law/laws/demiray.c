// Demiray: an isotropic law that stiffens exponentially.
// SPDX-License-Identifier: Apache-2.0
// Source: Demiray (1972).
//
//     W = c/(2 b) (exp(b (I1 - 3)) - 1)
//
// I1 the first invariant of the isochoric right Cauchy-Green tensor, c the shear modulus at rest.
// For b -> 0 it becomes the neo-Hookean law: W = c/2 i1 phi1(b i1), phi1(x) = (exp(x) - 1)/x.
#include "law/isochoric.h"

enum { SHEAR, STIFFENING, BULK };

SN_INLINE invariant_energy energy(const real *p, wide i1, wide i2) {
    (void)i2;
    real half = (real)0.5 * p[SHEAR];
    wide x = p[STIFFENING] * i1;
    wide w1 = half * wide_exp(x);
    return (invariant_energy){.W = half * i1 * wide_phi1(x), .w1 = w1, .w11 = p[STIFFENING] * w1};
}
SN_LAW_INVARIANT_KERNEL(demiray, INVARIANT_W11)

#if SN_LAW_TABLE
/// w1 = c/2 exp(b i1)
static void slopes(const double *p, double i1, invariant_slope out[]) {
    double power = wide_exp(p[STIFFENING] * i1);
    out[SHEAR] = (invariant_slope){.w1 = 0.5 * power};
    out[STIFFENING] = (invariant_slope){.w1 = 0.5 * p[SHEAR] * i1 * power};
}
SN_LAW_INVARIANT_SENSITIVITY(2)

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = law_moduli_of(p[SHEAR], p[BULK]);
}

static const sn_param params[] = {
    SN_LAW_MODULUS("c", "c", "Shear modulus at rest."),
    SN_LAW_NUMBER("b", "b", 0, 1000, "How fast it stiffens; 0 leaves a neo-Hookean law."),
    SN_LAW_BULK_MODULUS,
};

const sn_law sn_law_demiray = {
    .name = "demiray",
    .text = "Isotropic, stiffens exponentially; most soft tissues without marked fibres.",
    .source = "Demiray, J. Biomech. 5 (1972) 309",
    .kind = SN_LAW_SOLID,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
