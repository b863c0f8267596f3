// Kelvin memory: the standard linear solid.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (28) and (29), normalised to G(0) = 1; equation (36) with q = tau_epsilon and
// S = tau_sigma/tau_epsilon - 1:
//     G(t) = (1 + S exp(-t/q))/(1 + S) = g_inf + (1 - g_inf) exp(-t/tau_epsilon),
// g_inf = tau_epsilon/tau_sigma. The elastic law is the instantaneous one; the relaxed modulus E_R
// of the paper is g_inf times it.
#include "relax/laws.h"

#include <math.h>

static const sn_param params[] = {
    {.name = "tau_epsilon",
     .symbol = "tau_epsilon",
     .unit = "s",
     .min = SN_TAU_MIN,
     .max = SN_TAU_MAX,
     .init = NAN,
     .log_scale = true,
     .text = "Relaxation time of the load at constant deflection."},
    {.name = "tau_sigma",
     .symbol = "tau_sigma",
     .unit = "s",
     .min = SN_TAU_MIN,
     .max = SN_TAU_MAX,
     .init = NAN,
     .log_scale = true,
     .text = "Relaxation time of the deflection at constant load, at least tau_epsilon."},
};

static sn_status check(const double *value, int terms) {
    (void)terms;
    if (value[0] <= value[1]) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "memory kelvin: tau_epsilon is %g s, more than tau_sigma, %g s: such a body "
                   "would give out energy; expected tau_epsilon <= tau_sigma",
                   value[0], value[1]);
}

static double equilibrium(const double *value, int terms) {
    (void)terms;
    return value[0] / value[1];
}

// the weight 1 - g_inf, exact where the two times are near each other
static double weight(const double *value) {
    return (value[1] - value[0]) / value[1];
}

static double relaxation(const double *value, int terms, double t) {
    return equilibrium(value, terms) + weight(value) * exp(-t / value[0]);
}

static void modulus(const double *value, int terms, double w, double out[2]) {
    out[0] = equilibrium(value, terms);
    out[1] = 0.0;
    sn_relax_add_modulus(weight(value), value[0], w, out);
}

static void expand(const double *value, int terms, double tolerance, sn_exponentials *out) {
    (void)tolerance;
    out->g_inf = equilibrium(value, terms);
    out->terms = 1;
    out->g[0] = weight(value);
    out->tau[0] = value[0];
}

// by tau_epsilon both the weights and the exponential change, by tau_sigma the weights alone
static void sensitivity(const double *value, int terms, sn_memory_slope *out) {
    (void)terms;
    double rise = 1 / value[1], fall = -value[0] / value[1] / value[1]; // of g_inf
    out[0] = (sn_memory_slope){
        .constant = rise, .plain = -rise, .aged = weight(value) / value[0], .tau = value[0]};
    out[1] = (sn_memory_slope){.constant = fall, .plain = -fall, .tau = value[0]};
}

const sn_memory_law sn_relax_kelvin = {
    .name = "kelvin",
    .text = "Standard linear solid: one relaxation time.",
    .source = "equations (28), (29) and (36)",
    .param_count = 2,
    .params = params,
    .check = check,
    .relaxation = relaxation,
    .modulus = modulus,
    .equilibrium = equilibrium,
    .expand = expand,
    .sensitivity = sensitivity,
};
