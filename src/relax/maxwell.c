// Maxwell memory: a spring and a dashpot in series, a fluid in the long run.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (24), normalised: G(t) = exp(-t/tau), tau = eta/mu.
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
     .text = "Relaxation time: viscosity over modulus."},
};

static double relaxation(const double *value, int terms, double t) {
    (void)terms;
    return exp(-t / value[0]);
}

static void modulus(const double *value, int terms, double w, double out[2]) {
    (void)terms;
    out[0] = out[1] = 0.0;
    sn_relax_add_modulus(1.0, value[0], w, out);
}

static double equilibrium(const double *value, int terms) {
    (void)value, (void)terms;
    return 0.0;
}

static void expand(const double *value, int terms, double tolerance, sn_exponentials *out) {
    (void)terms, (void)tolerance;
    out->terms = 1;
    out->g[0] = 1.0;
    out->tau[0] = value[0];
}

static void sensitivity(const double *value, int terms, sn_memory_slope *out) {
    (void)terms;
    out[0].aged = 1 / value[0];
    out[0].tau = value[0];
}

const sn_memory_law sn_relax_maxwell = {
    .name = "maxwell",
    .text = "Spring and dashpot in series: all stress relaxes.",
    .source = "equation (24)",
    .param_count = 1,
    .params = params,
    .relaxation = relaxation,
    .modulus = modulus,
    .equilibrium = equilibrium,
    .expand = expand,
    .sensitivity = sensitivity,
};
