// Continuous spectrum: all relaxation times from tau1 to tau2 in equal measure.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (37) and (38), S(q) = c/q for tau1 <= q <= tau2. In closed form
//     G(t) = (1 + c D(t))/N,  D(t) = E1(t/tau2) - E1(t/tau1),  N = 1 + c L,  L = ln(tau2/tau1),
//     G'(w) = (1 + c/2 ln[(1 + w2 tau2^2)/(1 + w2 tau1^2)])/N,
//     G''(w) = c [atan(w tau2) - atan(w tau1)]/N.
//
// Digits. Both E1 grow like -ln t for small t while D stays below L. With the entire function
// Ein(x) = E1(x) + ln x + 0.5772… = integral from 0 to x of (1 - exp(-s))/s ds,
//     D = L - [Ein(t/tau1) - Ein(t/tau2)]
// has nothing large in it; it serves for t <= tau1, and gives G(0) = 1 to the last bit. For larger
// t, E1(t/tau1) < 0.22 and the printed form is good; for t >> tau2 it is E1(t/tau2) alone.
//
// As exponentials. D is the integral over s = ln(tau/tau1) from 0 to L of exp(-(t/tau1) exp(-s)).
// The integrand is entire but huge beyond |Im s| = pi/2, so Gauss-Legendre, which is made for an
// ellipse, wastes nodes when L is long. Hale & Trefethen, "New quadrature formulas from conformal
// maps", SIAM J. Numer. Anal. 46 (2008), map the ellipse to something like a strip; their simplest
// map, x -> arcsin(alpha x)/arcsin(alpha), is used here. Weights stay positive; they are scaled to
// sum to L, so that G(0) = 1.
#include "relax/laws.h"

#include <math.h>

#define PI 3.14159265358979323846

static const sn_param params[] = {
    {.name = "c",
     .symbol = "c",
     .unit = "1",
     .min = 1e-4,
     .max = 10,
     .init = NAN,
     .log_scale = true,
     .text = "Strength of the spectrum: the relaxing part per e-fold of relaxation time."},
    {.name = "tau1",
     .symbol = "q1",
     .unit = "s",
     .min = SN_TAU_MIN,
     .max = SN_TAU_MAX,
     .init = NAN,
     .log_scale = true,
     .text = "Shortest relaxation time."},
    {.name = "tau2",
     .symbol = "q2",
     .unit = "s",
     .min = SN_TAU_MIN,
     .max = SN_TAU_MAX,
     .init = NAN,
     .log_scale = true,
     .text = "Longest relaxation time, more than tau1."},
};

enum { C, TAU1, TAU2 };

static sn_status check(const double *value, int terms) {
    (void)terms;
    if (value[TAU1] < value[TAU2]) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "memory fung-spectrum: tau1 is %g s and tau2 %g s: expected tau1 < tau2",
                   value[TAU1], value[TAU2]);
}

// ln(tau2/tau1), also where the two are near each other
static double width(const double *value) {
    return log1p((value[TAU2] - value[TAU1]) / value[TAU1]);
}

// Ein(x) for 0 <= x <= 1, by its series x - x2/(2 2!) + x3/(3 3!) - …; to rounding
static double ein(double x) {
    double sum = 0, term = 1;
    for (int k = 1; k <= 20 && fabs(term) > 1e-17 * sum; k++) {
        term *= -x / k;
        sum -= term / k;
    }
    return sum;
}

static double relaxation(const double *value, int terms, double t) {
    (void)terms;
    double c = value[C], N = 1 + c * width(value);
    double fast = t / value[TAU1], slow = t / value[TAU2];
    if (fast <= 1) return 1 - c * (ein(fast) - ein(slow)) / N;
    return (1 + c * (sn_expint_e1(slow) - sn_expint_e1(fast))) / N;
}

static double equilibrium(const double *value, int terms) {
    (void)terms;
    return 1 / (1 + value[C] * width(value));
}

// ln(1 + x2)/2 without overflow
static double half_log1p_square(double x) {
    return x < 1e8 ? 0.5 * log1p(x * x) : log(x);
}

static void modulus(const double *value, int terms, double w, double out[2]) {
    (void)terms;
    double c = value[C], N = 1 + c * width(value);
    double x1 = w * value[TAU1], x2 = w * value[TAU2];
    out[0] = (1 + c * (half_log1p_square(x2) - half_log1p_square(x1))) / N;
    // atan x2 - atan x1 as one arc tangent: nothing cancels where both are near pi/2
    double tangent = x1 > 1 ? (1 / x1 - 1 / x2) / (1 + 1 / x1 / x2) : (x2 - x1) / (1 + x1 * x2);
    out[1] = c * atan(tangent) / N;
}

// Nodes and weights of Gauss-Legendre on [-1, 1], by Newton's method on the Legendre polynomial.
static void gauss_legendre(int n, double *x, double *weight) {
    for (int i = 0; i < n; i++) {
        double z = -cos(PI * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int step = 0; step < 8; step++) {
            double p = 1, before = 0;
            for (int k = 1; k <= n; k++) {
                double next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
                before = p;
                p = next;
            }
            slope = n * (z * p - before) / (z * z - 1);
            double change = p / slope;
            z -= change;
            if (fabs(change) < 1e-15) break;
        }
        x[i] = z;
        weight[i] = 2 / ((1 - z * z) * slope * slope);
    }
}

// The map with rho = exp(RHO/(L + 2)) is within a few percent of the best one for every L, and the
// largest error at any t >= 0 is then below 2 rho^-2n times the relaxing part: found by trial, held
// by a test over the whole range of constants.
#define RHO 5.2

static void expand(const double *value, int terms, double tolerance, sn_exponentials *out) {
    (void)terms;
    double c = value[C], L = width(value), N = 1 + c * L, rate = RHO / (L + 2);
    double relaxing = c * L / N;
    double wanted = ceil(log(2 * relaxing / tolerance) / (2 * rate));
    int n = (int)fmin(fmax(wanted, 1), SN_TERMS_MAX);
    double x[SN_TERMS_MAX], weight[SN_TERMS_MAX], total = 0;
    gauss_legendre(n, x, weight);
    double alpha = 1 / cosh(rate); // the map is singular where the ellipse rho would be pinched
    for (int i = 0; i < n; i++) {
        weight[i] /= sqrt(1 - alpha * alpha * x[i] * x[i]); // dx of the map, but for a factor
        total += weight[i];
    }
    out->g_inf = 1 / N;
    out->terms = n;
    for (int i = 0; i < n; i++) {
        double s = asin(alpha * x[i]) / asin(alpha);
        out->tau[i] = value[TAU1] * exp(0.5 * L * (1 + s));
        out->g[i] = relaxing * weight[i] / total;
    }
    out->max_error = 2 * relaxing * exp(-2 * n * rate);
}

// With dD/dtau2 = exp(-t/tau2)/tau2, dD/dtau1 = -exp(-t/tau1)/tau1, D = (N G - 1)/c:
//     dG/dc = (G - 1)/(c N),  dG/dtau2 = c/(N tau2) (exp(-t/tau2) - G),
//     dG/dtau1 = c/(N tau1) (G - exp(-t/tau1)).
static void sensitivity(const double *value, int terms, sn_memory_slope *out) {
    (void)terms;
    double c = value[C], N = 1 + c * width(value);
    double first = c / (N * value[TAU1]), last = c / (N * value[TAU2]);
    out[C].own = 1 / (c * N);
    out[C].constant = -out[C].own;
    out[TAU1] = (sn_memory_slope){.own = first, .plain = -first, .tau = value[TAU1]};
    out[TAU2] = (sn_memory_slope){.own = -last, .plain = last, .tau = value[TAU2]};
}

const sn_memory_law sn_relax_fung_spectrum = {
    .name = "fung-spectrum",
    .text = "Continuous spectrum c/q between two relaxation times.",
    .source = "equations (37) and (38)",
    .param_count = 3,
    .params = params,
    .check = check,
    .relaxation = relaxation,
    .modulus = modulus,
    .equilibrium = equilibrium,
    .expand = expand,
    .sensitivity = sensitivity,
};
