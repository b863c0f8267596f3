// No memory: an elastic tissue, G = 1.
// SPDX-License-Identifier: Apache-2.0
#include "relax/laws.h"

static double relaxation(const double *value, int terms, double t) {
    (void)value, (void)terms, (void)t;
    return 1.0;
}

static void modulus(const double *value, int terms, double w, double out[2]) {
    (void)value, (void)terms, (void)w;
    out[0] = 1.0;
    out[1] = 0.0;
}

static double equilibrium(const double *value, int terms) {
    (void)value, (void)terms;
    return 1.0;
}

static void expand(const double *value, int terms, double tolerance, sn_exponentials *out) {
    (void)value, (void)terms, (void)tolerance;
    out->g_inf = 1.0;
}

static void sensitivity(const double *value, int terms, sn_memory_slope *out) {
    (void)value, (void)terms, (void)out;
}

const sn_memory_law sn_relax_none = {
    .name = "none",
    .text = "No memory: the stress follows the strain at once.",
    .source = "equation (16)",
    .relaxation = relaxation,
    .modulus = modulus,
    .equilibrium = equilibrium,
    .expand = expand,
    .sensitivity = sensitivity,
};
