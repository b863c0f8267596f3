// Memory: reduced relaxation functions G(t) with G(0) = 1, and their reduction to exponentials.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sn_exponentials;
struct sn_memory_slope;

/// A memory law: a constant table. Adding one is one file in src/relax/ and one registry line.
typedef struct sn_memory_law {
    const char *name;   ///< key in files
    const char *text;   ///< one sentence
    const char *source; ///< equation of the paper
    int param_count;
    const sn_param *params;
    sn_status (*check)(const double *value, int terms);                       ///< Nullable
    double (*relaxation)(const double *value, int terms, double t);           ///< G(t), t >= 0
    void (*modulus)(const double *value, int terms, double w, double out[2]); ///< G'(w), G''(w)
    double (*equilibrium)(const double *value, int terms);                    ///< G(infinity)
    double (*impulse)(const double *value, int terms); ///< Nullable: seconds in front of delta(t)
    /// G as exponentials at every t >= 0: terms, g, tau, g_inf, viscous of a zeroed `out`.
    /// max_error stays 0 where the sum is G itself; else it bounds the error, and is at most the
    /// tolerance unless SN_TERMS_MAX terms do not reach it.
    void (*expand)(const double *value, int terms, double tolerance, struct sn_exponentials *out);
    /// sn_memory_sensitivity() into slopes that are zero but for tau = 1.
    void (*sensitivity)(const double *value, int terms, struct sn_memory_slope *out);
} sn_memory_law;

SN_API int sn_memory_law_count(void);
SN_API const sn_memory_law *sn_memory_law_at(int index);
/// A memory law by name. @return NULL with a text (and a suggestion) stored when there is none.
SN_API const sn_memory_law *sn_memory_law_find(const char *name);

/// A memory law with its constants.
typedef struct sn_memory {
    const sn_memory_law *law;
    int terms; ///< terms of list parameters, else 0
    double value[SN_VALUES_MAX];
} sn_memory;

/// No memory: G = 1.
SN_API sn_memory sn_memory_none(void);
SN_API sn_status sn_memory_check(const sn_memory *memory);
SN_API double sn_memory_relaxation(const sn_memory *memory, double t);
SN_API double sn_memory_equilibrium(const sn_memory *memory);
/// Storage and loss modulus at angular frequency w [rad/s], relative to the instantaneous modulus.
SN_API void sn_memory_modulus(const sn_memory *memory, double w, double *storage, double *loss);

/// G(t) ~ g_inf + sum g_i exp(-t/tau_i) + viscous * delta(t).
typedef struct sn_exponentials {
    int terms;
    double g_inf;
    double viscous; ///< seconds: the viscous part adds viscous * dT/dt (Voigt)
    double g[SN_TERMS_MAX];
    double tau[SN_TERMS_MAX]; ///< seconds
    double max_error;         ///< largest |difference to G| over the band, of G(0) = 1
    double t_min, t_max;      ///< the band, seconds
} sn_exponentials;

/// Derivative of G by one constant p. Every law has it in this form, with one exponential:
///     dG/dp = constant + own G(t) + (plain + aged t/tau) exp(-t/tau) + viscous delta(t)
/// It is 0 at t = 0 but for the impulse: G(0) stays 1. Parts are per unit of p.
typedef struct sn_memory_slope {
    double constant, own, plain, aged;
    double tau;     ///< seconds, > 0; 1 where there is no exponential
    double viscous; ///< seconds
} sn_memory_slope;
/// Derivatives of G by every value of a memory that is in range, exact (where sn_memory_expand()
/// approximates G, they are those of G).
/// @param out                                                     (values of the memory)
SN_API void sn_memory_sensitivity(const sn_memory *memory, sn_memory_slope *out);
/// dG/dp at t >= 0 without the impulse, G = G(t).
SN_API double sn_memory_slope_at(const sn_memory_slope *slope, double G, double t);

/// The fewest exponentials (g_i > 0, g_inf >= 0, sum 1) found that keep |error| <= tolerance for
/// t = 0 and all t in [t_min, t_max], t_min > 0. Finite sums come back as they are (less terms that
/// cannot be seen in the band, if the error allows).
/// @return SN_OK; SN_E_RANGE when SN_TERMS_MAX terms do not reach the tolerance.
SN_API sn_status sn_memory_compress(const sn_memory *memory, double t_min, double t_max,
                                    double tolerance, sn_exponentials *out);
/// Exponentials that equal G at every t >= 0 to about 1e-11: for laboratory work, where accuracy
/// counts and terms do not.
SN_API sn_status sn_memory_expand(const sn_memory *memory, sn_exponentials *out);

/// Value of the exponentials at t.
SN_API double sn_exponentials_at(const sn_exponentials *e, double t);
/// Factors of the exact recursion for a step of h seconds: with x = h/tau_i,
///     H_i <- decay_i H_i + gain_i dT,  decay_i = exp(-x), gain_i = g_i (1 - exp(-x))/x,
/// stress = g_inf T + sum H_i (+ viscous dT/h). Exact for T linear within the step, for any h.
/// Source: quasi-linear viscoelasticity, equations (33)-(35), with (32).
SN_API void sn_exponentials_factors(const sn_exponentials *e, double h, double *decay,
                                    double *gain);

/// Creep function J(t), the deflection under a unit step of load, with G(0) = 1 as the unit of
/// stiffness: int_0^t G(t - s) J(s) ds = t.
///     J(t) = instant + flow t + sum j_i (1 - exp(-t/tau_i)),  every j_i > 0
typedef struct sn_retardations {
    int terms;
    double instant;               ///< J(0): 1; 0 under a viscous part
    double flow;                  ///< 1/s: the end of a fluid (g_inf = 0), else 0
    double j[SN_TERMS_MAX + 1];   ///< compliances of the Kelvin-Voigt bodies in series
    double tau[SN_TERMS_MAX + 1]; ///< their retardation times, seconds, falling
} sn_retardations;
/// Creep function of a sum of exponentials, exact but for rounding.
/// Source: equations (23), (27), (28) and (31) for sums: the zeros of s times the transform of G.
SN_API void sn_exponentials_creep(const sn_exponentials *e, sn_retardations *out);
/// Creep function of any memory, through sn_memory_expand(). @return SN_OK, SN_E_RANGE.
SN_API sn_status sn_memory_creep(const sn_memory *memory, sn_retardations *out);
/// J at t >= 0.
SN_API double sn_retardations_at(const sn_retardations *r, double t);

#ifdef __cplusplus
}
#endif
