// Special functions and the clock.
// SPDX-License-Identifier: Apache-2.0
// Source: Abramowitz & Stegun, Handbook of Mathematical Functions, 5.1.11 (series) and 5.1.22
// (continued fraction), the fraction evaluated by Lentz's method.
#include "sinew/base.h"

#include <float.h>
#include <math.h>
#include <time.h>

#define EULER 0.57721566490153286061

double sn_expint_e1(double x) {
    if (isnan(x) || x < 0) return NAN;
    if (x == 0) return INFINITY;
    if (x <= 1.0) {
        // E1 = -gamma - ln x - sum (-x)^k / (k k!); beyond 1 the terms begin to cancel
        double sum = 0, term = 1;
        for (int k = 1; k < 40; k++) {
            term *= -x / k;
            sum += term / k;
            if (fabs(term) < 0.01 * DBL_EPSILON * fabs(sum)) break;
        }
        return -EULER - log(x) - sum;
    }
    if (x > 745.0) return 0.0; // exp(-x) underflows
    // E1 = exp(-x) / (x + 1 - 1/(x + 3 - 4/(x + 5 - …)))
    double b = x + 1, d = 1 / b, c = INFINITY, h = d;
    for (int k = 1; k < 200; k++) {
        double a = -(double)k * k;
        b += 2;
        d = 1 / (a * d + b);
        c = b + a / c;
        double factor = c * d;
        h *= factor;
        if (fabs(factor - 1) < DBL_EPSILON) break;
    }
    return h * exp(-x);
}

double sn_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
