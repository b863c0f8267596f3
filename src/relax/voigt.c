// Voigt memory: a spring and a dashpot side by side.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (26) and (27), normalised: G(t) = 1 + tau delta(t), tau = eta/mu.
//
// A step has no finite response here, so G(0) = 1 is read without the impulse: the elastic law is
// the long-term one (it is the instantaneous one for every other memory), and the dashpot adds
// tau dT/dt. The impulse is never sampled: relaxation() gives 1 and impulse() gives tau.
#include "relax/laws.h"

#include <math.h>

static const sn_param params[] = {
    {.name = "tau",
     .symbol = "tau",
     .unit = "s",
     .min = SN_TAU_MIN,
     .max = SN_TAU_MAX,
     .init = NAN,
     .log_scale = true,
     .text = "Retardation time: viscosity over modulus."},
};

static double relaxation(const double *value, int terms, double t) {
    (void)value, (void)terms, (void)t;
    return 1.0;
}

static void modulus(const double *value, int terms, double w, double out[2]) {
    (void)terms;
    out[0] = 1.0;
    out[1] = w * value[0];
}

static double equilibrium(const double *value, int terms) {
    (void)value, (void)terms;
    return 1.0;
}

static double impulse(const double *value, int terms) {
    (void)terms;
    return value[0];
}

static void expand(const double *value, int terms, double tolerance, sn_exponentials *out) {
    (void)terms, (void)tolerance;
    out->g_inf = 1.0;
    out->viscous = value[0];
}

static void sensitivity(const double *value, int terms, sn_memory_slope *out) {
    (void)value, (void)terms;
    out[0].viscous = 1;
}

const sn_memory_law sn_relax_voigt = {
    .name = "voigt",
    .text = "Spring and dashpot side by side: the elastic law is the long-term one.",
    .source = "equations (26) and (27)",
    .param_count = 1,
    .params = params,
    .relaxation = relaxation,
    .modulus = modulus,
    .equilibrium = equilibrium,
    .impulse = impulse,
    .expand = expand,
    .sensitivity = sensitivity,
};
