// Prony memory: a sum of exponentials.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (32), normalised: G(t) = g_inf + sum g_i exp(-t/tau_i), g_inf = 1 - sum g_i.
#include "relax/laws.h"

#include <math.h>

// what rounding may add to a sum of weights that is 1 on paper
#define SUM_SLACK 1e-12

static const sn_param params[] = {
    {.name = "g",
     .symbol = "g_i",
     .unit = "1",
     .min = 0,
     .max = 1,
     .init = NAN,
     .length = SN_PARAM_LIST,
     .text = "Weights of the exponentials; what is left to 1 never relaxes."},
    {.name = "tau",
     .symbol = "tau_i",
     .unit = "s",
     .min = SN_TAU_MIN,
     .max = SN_TAU_MAX,
     .init = NAN,
     .log_scale = true,
     .length = SN_PARAM_LIST,
     .text = "Relaxation times of the exponentials."},
};

static double sum(const double *g, int terms) {
    double total = 0;
    for (int i = 0; i < terms; i++) total += g[i];
    return total;
}

static sn_status check(const double *value, int terms) {
    double total = sum(value, terms);
    if (total <= 1 + SUM_SLACK) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "memory prony: the weights g sum to %.15g: expected at most 1, since G(0) = 1 "
                   "(for weights over the long-term modulus say `convention: long-term`)",
                   total);
}

static double equilibrium(const double *value, int terms) {
    return fmax(0.0, 1 - sum(value, terms));
}

static double relaxation(const double *value, int terms, double t) {
    const double *tau = value + terms;
    double G = equilibrium(value, terms);
    for (int i = 0; i < terms; i++) G += value[i] * exp(-t / tau[i]);
    return G;
}

static void modulus(const double *value, int terms, double w, double out[2]) {
    out[0] = equilibrium(value, terms);
    out[1] = 0.0;
    for (int i = 0; i < terms; i++) sn_relax_add_modulus(value[i], value[terms + i], w, out);
}

static void expand(const double *value, int terms, double tolerance, sn_exponentials *out) {
    (void)tolerance;
    out->g_inf = equilibrium(value, terms);
    for (int i = 0; i < terms; i++) {
        if (value[i] == 0) continue;
        out->g[out->terms] = value[i];
        out->tau[out->terms++] = value[terms + i];
    }
}

static void sensitivity(const double *value, int terms, sn_memory_slope *out) {
    for (int i = 0; i < terms; i++) {
        double g = value[i], tau = value[terms + i];
        out[i] = (sn_memory_slope){.constant = -1, .plain = 1, .tau = tau};
        out[terms + i] = (sn_memory_slope){.aged = g / tau, .tau = tau};
    }
}

const sn_memory_law sn_relax_prony = {
    .name = "prony",
    .text = "Sum of exponentials (generalised Maxwell body).",
    .source = "equation (32)",
    .param_count = 2,
    .params = params,
    .check = check,
    .relaxation = relaxation,
    .modulus = modulus,
    .equilibrium = equilibrium,
    .expand = expand,
    .sensitivity = sensitivity,
};
