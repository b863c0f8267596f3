// Sums of exponentials: value, and the factors of the exact recursion.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (32) to (35). With T linear within a step of h, dT/ds = dT/h, and
//     H_i(t + h) = exp(-h/tau_i) H_i(t) + g_i integral over the step of exp(-(t+h-s)/tau_i) dT/h ds
// whose integral is (1 - exp(-x))/x dT, x = h/tau_i.
#include "sinew/relax.h"

#include <math.h>

double sn_exponentials_at(const sn_exponentials *e, double t) {
    SN_ASSERT(t >= 0);
    double G = e->g_inf;
    for (int i = 0; i < e->terms; i++) G += e->g[i] * exp(-t / e->tau[i]);
    return G;
}

void sn_exponentials_factors(const sn_exponentials *e, double h, double *decay, double *gain) {
    SN_ASSERT(h >= 0);
    for (int i = 0; i < e->terms; i++) {
        double x = h / e->tau[i];
        decay[i] = exp(-x);
        // expm1 keeps all digits for small x, where 1 - exp(-x) has none; x = 0 is the limit
        gain[i] = x > 0 ? e->g[i] * (-expm1(-x) / x) : e->g[i];
    }
}
