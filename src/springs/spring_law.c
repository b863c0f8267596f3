// The law of springs that together stretch like a given tissue.
// SPDX-License-Identifier: Apache-2.0
// Source: equation (14) for the spring; the orientation average is computed here.
//
// A net of springs of all orientations, of stiffness k L^2 adding up to 15 mu per volume, has the
// energy 15 mu <Phi(lambda_n)>, with < > the mean over directions n, Phi' = t and
//     lambda_n^2 = lambda^2 c^2 + (1 - c^2)/lambda,  c = cos(angle to the axis)
// when it is stretched by lambda at constant volume; its nominal stress is the derivative
//     T_net = 15 mu <t(lambda_n) (lambda c^2 - (1 - c^2)/(2 lambda^2)) / lambda_n>,
// which starts with slope 3 mu, as it must for shear modulus mu. B is what brings T_net closest to
// the tissue's own stress over stretches 1 ... 1.3, in the sense of least squares. For a solid law
// mu stays what it is (small strains are right); for a uniaxial law, of which no more is known than
// this curve, the factor on mu is fitted with B.
#include <math.h>

#include "springs/net.h"

enum { STRETCHES = 30, GAUSS = 16 };
static const double last_stretch = 1.3;

// Gauss-Legendre points on 0 ... 1, by Newton's method on the Legendre polynomial
static void gauss_points(double x[GAUSS], double w[GAUSS]) {
    for (int i = 0; i < GAUSS; i++) {
        double z = cos(3.14159265358979323846 * (i + 0.75) / (GAUSS + 0.5)), slope = 1.0;
        for (int turn = 0; turn < 50; turn++) {
            double p = 1.0, before = 0.0;
            for (int k = 0; k < GAUSS; k++) {
                double next = ((2.0 * k + 1.0) * z * p - k * before) / (k + 1.0);
                before = p;
                p = next;
            }
            slope = GAUSS * (z * p - before) / (z * z - 1.0);
            double dz = p / slope;
            z -= dz;
            if (fabs(dz) < 1e-15) break;
        }
        x[i] = 0.5 * (1.0 + z);
        w[i] = 1.0 / ((1.0 - z * z) * slope * slope);
    }
}

static double spring_tension(double B, double lambda) {
    double x = lambda - 1.0;
    if (x < 0) return (lambda - 1.0 / (lambda * lambda)) / 3.0;
    return fabs(B * x) < 1e-12 ? x : expm1(B * x) / B;
}

// nominal stress of the net over mu
static double net_stress(double B, double lambda) {
    double x[GAUSS], w[GAUSS], sum = 0.0;
    gauss_points(x, w);
    for (int i = 0; i < GAUSS; i++) {
        double c2 = x[i] * x[i];
        double n = sqrt(lambda * lambda * c2 + (1.0 - c2) / lambda);
        double slope = (lambda * c2 - (1.0 - c2) / (2.0 * lambda * lambda)) / n;
        sum += w[i] * spring_tension(B, n) * slope;
    }
    return 15.0 * sum;
}

// nominal stress of the tissue, stretched at constant volume
static void tissue_stress(const sn_tissue *t, const double *stretch, double *T) {
    if (t->law->kind == SN_LAW_UNIAXIAL) {
        sn_law_uniaxial(t->law, t->value, t->terms, STRETCHES, stretch, NULL, T, NULL);
        return;
    }
    double E[6 * STRETCHES] = {0}, S[6 * STRETCHES];
    for (int i = 0; i < STRETCHES; i++) {
        E[i] = 0.5 * (stretch[i] * stretch[i] - 1.0);
        E[STRETCHES + i] = E[2 * STRETCHES + i] = 0.5 * (1.0 / stretch[i] - 1.0);
    }
    sn_law_solid(t->law, t->value, t->terms, STRETCHES, E, NULL, S, NULL);
    for (int i = 0; i < STRETCHES; i++)
        T[i] = stretch[i] * S[i] -
               0.5 * (S[STRETCHES + i] + S[2 * STRETCHES + i]) / (stretch[i] * stretch[i]);
}

typedef struct curve {
    double stretch[STRETCHES], T[STRETCHES];
    double shear;
    bool free_factor;
} curve;

// sum of squared differences; *factor gets the best one where it is free
static double misfit(const curve *c, double B, double *factor) {
    double net[STRETCHES], top = 0.0, bottom = 0.0, sum = 0.0;
    for (int i = 0; i < STRETCHES; i++) {
        net[i] = c->shear * net_stress(B, c->stretch[i]);
        top += net[i] * c->T[i];
        bottom += net[i] * net[i];
    }
    *factor = c->free_factor ? top / bottom : 1.0;
    for (int i = 0; i < STRETCHES; i++)
        sum += (*factor * net[i] - c->T[i]) * (*factor * net[i] - c->T[i]);
    return sum;
}

sn_status sn_spring_fit(const sn_tissue *tissue, double *exponent, double *factor) {
    curve c;
    sn_moduli moduli;
    sn_tissue_moduli(tissue, &moduli);
    c.shear = moduli.shear;
    c.free_factor = tissue->law->kind == SN_LAW_UNIAXIAL;
    for (int i = 0; i < STRETCHES; i++)
        c.stretch[i] = 1.0 + (last_stretch - 1.0) * (i + 1.0) / STRETCHES;
    tissue_stress(tissue, c.stretch, c.T);

    // a scan finds the valley, golden section its bottom
    const double low = -5.0, high = 150.0, width = 2.5;
    double best = low, least = INFINITY;
    for (double B = low; B <= high; B += width) {
        double m = misfit(&c, B, factor);
        if (m < least) {
            least = m;
            best = B;
        }
    }
    const double golden = 0.61803398874989485;
    double a = best - width, b = best + width;
    while (b - a > 1e-7 * (1.0 + fabs(a))) {
        double left = b - golden * (b - a), right = a + golden * (b - a), unused;
        if (misfit(&c, left, &unused) < misfit(&c, right, &unused))
            b = right;
        else
            a = left;
    }
    *exponent = 0.5 * (a + b);
    least = misfit(&c, *exponent, factor);
    if (!isfinite(least) || !(*factor > 0))
        return sn_fail(SN_E_UNSUPPORTED,
                       "tissue %s: no spring law follows its uniaxial stress up to a stretch of "
                       "%g; use the coupled rung",
                       tissue->name, last_stretch);
    return SN_OK;
}
