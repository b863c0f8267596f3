// The linear uniaxial law.
// SPDX-License-Identifier: Apache-2.0
//
//     T = E (stretch - 1)
//
// T the nominal stress, E the modulus.
#include "law/uniaxial.h"

enum { MODULUS };

SN_INLINE void point(const real *p, wide stretch, uniaxial_point *out) {
    wide e = stretch - 1;
    out->T = p[MODULUS] * e;
    out->dT = wide_set(p[MODULUS]);
    out->W = (real)0.5 * out->T * e;
}
SN_LAW_UNIAXIAL_KERNEL(linear)

#if SN_LAW_TABLE
static void sensitivity(const double *p, int terms, int n, const double *stretch, double *dT) {
    (void)p, (void)terms;
    for (int i = 0; i < n; i++) dT[i] = stretch[i] - 1;
}

static void moduli(const double *p, int terms, sn_moduli *out) {
    (void)terms;
    *out = (sn_moduli){.young = p[MODULUS]};
}

static const sn_param params[] = {
    SN_LAW_MODULUS("modulus", "E", "Slope of nominal stress against stretch."),
};

const sn_law sn_law_linear = {
    .name = "linear",
    .text = "Nominal stress proportional to extension.",
    .source = "Hooke's law",
    .kind = SN_LAW_UNIAXIAL,
    .param_count = sizeof params / sizeof params[0],
    .params = params,
    .moduli = moduli,
    .sensitivity = sensitivity,
    .kernels = &kernels,
};
#endif
