// The law of one spring, in double precision: force, slope, energy and inverse.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (14) in tension.
//
// What a calibration adds, x (exp(C x^2) - 1), stiffens with the square of the strain as the
// exponential laws of solids do, and leaves the slope at rest and the way down to no length what
// they are.
#include <math.h>

#include "springs/net.h"

sn_spring_law sn_net_spring_law(const sn_net *net, const sn_net_region *region, int slot) {
    const double *D = (const double *)net->data[SN_DOUBLE].edge +
                      (size_t)(slot / SN_BLOCK) * 3 * SN_BLOCK + (size_t)(slot % SN_BLOCK);
    const double *q = region->square,
                 inverse = ((const double *)net->data[SN_DOUBLE].inverse)[slot];
    const double x = D[0], y = D[SN_BLOCK], z = D[2 * SN_BLOCK];
    sn_spring_law law = {.exponent = region->exponent};
    if (!region->squared) return law;
    law.up = inverse * (q[0] * x * x + q[1] * y * y + q[2] * z * z +
                        2.0 * (q[3] * x * y + q[4] * y * z + q[5] * z * x));
    law.down = q[6];
    return law;
}

double sn_spring_tension(const sn_spring_law *law, double lambda, double *slope) {
    const double x = lambda - 1.0, B = law->exponent, C = x < 0 ? law->down : law->up;
    double t, dt;
    if (x < 0) {
        t = (lambda - 1.0 / (lambda * lambda)) / 3.0;
        dt = (1.0 + 2.0 / (lambda * lambda * lambda)) / 3.0;
    } else {
        t = fabs(B * x) < 1e-12 ? x : expm1(B * x) / B;
        dt = exp(B * x);
    }
    if (C != 0) {
        const double y = C * x * x, more = expm1(fmin(y, SN_SPRING_STEEPEST));
        t += x * more;
        dt += more + (y < SN_SPRING_STEEPEST ? 2.0 * y * (more + 1.0) : 0.0);
    }
    if (slope) *slope = dt;
    return t;
}

// integral of x (exp(C x^2) - 1)
static double square_potential(double C, double x) {
    const double y = C * x * x;
    if (y > SN_SPRING_STEEPEST) {
        const double x0 = sqrt(SN_SPRING_STEEPEST / C);
        return square_potential(C, x0) + 0.5 * expm1(SN_SPRING_STEEPEST) * (x * x - x0 * x0);
    }
    if (y < 1e-5) return 0.25 * y * x * x * (1.0 + y / 3.0);
    return 0.5 * (expm1(y) / C - x * x);
}

double sn_spring_potential(const sn_spring_law *law, double lambda) {
    const double x = lambda - 1.0, B = law->exponent;
    const double more = square_potential(x < 0 ? law->down : law->up, x);
    if (x < 0) return more + (0.5 * lambda * lambda + 1.0 / lambda - 1.5) / 3.0;
    if (fabs(B * x) < 1e-5) return more + x * x * (0.5 + B * x / 6.0);
    return more + (expm1(B * x) / B - x) / B;
}

// of x^3 - 3 t x^2 - 1, convex and rising above its root
static double compressed(double t) {
    double x = 1.0;
    for (int turn = 0; turn < 60; turn++) {
        double step = (x * x * (x - 3.0 * t) - 1.0) / (3.0 * x * (x - 2.0 * t));
        x -= step;
        if (fabs(step) < 1e-15 * x) break;
    }
    return x;
}

// between rest and a stretch that is too far: Newton's method, or halving where that leaves the
// bracket or is slow
static double between(const sn_spring_law *law, double t, double far) {
    double near = 1.0, x = far, last = fabs(far - 1.0);
    for (int turn = 0; turn < 100; turn++) {
        double slope;
        const double off = sn_spring_tension(law, x, &slope) - t;
        if ((off > 0) == (far > 1.0))
            far = x;
        else
            near = x;
        double next = x - off / slope;
        if (!((next - near) * (next - far) < 0) || 2.0 * fabs(off) > last * slope)
            next = 0.5 * (near + far);
        last = fabs(next - x);
        x = next;
        if (last < 1e-15 * x) break;
    }
    return x;
}

double sn_spring_stretch(const sn_spring_law *law, double t) {
    const double B = law->exponent;
    const bool straight = fabs(B) < 1e-12;
    if ((t < 0 ? law->down : law->up) == 0)
        return t < 0 ? compressed(t) : 1.0 + (straight ? t : log1p(B * t) / B);
    if (t < 0) return between(law, t, compressed(t)); // each part alone is too soft
    // 1 more than where exp(C x^2) - 1 = t, but for forces that no body survives
    double far = 2.0 + sqrt(log1p(t) / law->up);
    if (B * t > -0.9) far = fmin(far, 1.0 + (straight ? t : log1p(B * t) / B));
    return t > 0 ? between(law, t, far) : 1.0;
}
