// The memory laws that exist, and what they share.
// SPDX-License-Identifier: Apache-2.0
//
// A new memory law is one file that defines `const sn_memory_law sn_relax_NAME` and one line here.
// It must be completely monotone (a sum or an integral of exponentials with weights >= 0): the
// bound of compress.c between the points of its grid rests on that, and so does passivity.
#pragma once

#include "sinew/relax.h"

#define SN_MEMORY_LAWS(X)                                                                          \
    X(none)                                                                                        \
    X(maxwell)                                                                                     \
    X(voigt)                                                                                       \
    X(kelvin)                                                                                      \
    X(prony)                                                                                       \
    X(fung_spectrum)

#define SN_MEMORY_LAW_DECLARE(name) extern const sn_memory_law sn_relax_##name;
SN_MEMORY_LAWS(SN_MEMORY_LAW_DECLARE)
#undef SN_MEMORY_LAW_DECLARE

// Shortest and longest characteristic time of every law, seconds: what a fit searches.
#define SN_TAU_MIN 1e-6
#define SN_TAU_MAX 1e6

/// Storage and loss modulus of g exp(-t/tau), added to out: g x2/(1 + x2) and g x/(1 + x2) with
/// x = w tau, in a form that neither overflows nor cancels.
static inline void sn_relax_add_modulus(double g, double tau, double w, double out[2]) {
    double x = w * tau;
    if (x > 1) {
        double r = 1 / x;
        out[0] += g / (1 + r * r);
        out[1] += g * r / (1 + r * r);
    } else {
        out[0] += g * x * x / (1 + x * x);
        out[1] += g * x / (1 + x * x);
    }
}
