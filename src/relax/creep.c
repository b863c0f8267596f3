// Creep functions: what a sum of exponentials in relaxation is under a constant load.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (23), (27) and (28) are the cases of one term; (30) and (31) ask for G * J = t.
//
// Under the Laplace transform G * J = t reads J~ = 1/(s Q(s)), Q(s) = s G~(s). With rates
// r_i = 1/tau_i and s = -p,
//     Q = g_inf - v p + sum g_i p/(p - r_i),
// which falls between its poles: one zero p_k lies in (0, r_1) unless g_inf = 0, one between every
// two neighbouring rates, and one above the last if there is a viscous part v. The residues give
//     J = J(0) + flow t + sum j_k (1 - exp(-p_k t)),   j_k = 1/(p_k dQ/ds),
//     dQ/ds = v + sum g_i r_i/(p - r_i)^2 > 0,   J(0) = 1/(g_inf + sum g_i), or 0 where v > 0,
// and flow = 1/(v + sum g_i tau_i) for a fluid, whose zero at s = 0 is double. Retardation times
// are the 1/p_k: every one longer than the relaxation time it follows.
//
// A zero can lie closer to a pole than the digits of p tell apart, so the unknown is the distance
// to the nearer end of its interval, and p - r_i is never formed by subtracting p.
#include "relax/laws.h"

#include <math.h>
#include <string.h>

// rates rising, equal ones gathered, terms without weight left out
typedef struct chain {
    int count;
    double rate[SN_TERMS_MAX], weight[SN_TERMS_MAX];
    double rest, viscous;
} chain;

static void gather(const sn_exponentials *e, chain *c) {
    *c = (chain){.rest = e->g_inf, .viscous = e->viscous};
    for (int i = 0; i < e->terms; i++) {
        if (!(e->g[i] > 0)) continue;
        double rate = 1 / e->tau[i];
        int at = c->count;
        while (at > 0 && c->rate[at - 1] >= rate) at--;
        if (at < c->count && c->rate[at] == rate) {
            c->weight[at] += e->g[i];
            continue;
        }
        for (int k = c->count++; k > at; k--) {
            c->rate[k] = c->rate[k - 1];
            c->weight[k] = c->weight[k - 1];
        }
        c->rate[at] = rate;
        c->weight[at] = e->g[i];
    }
}

// Q at p = base + offset
static double image(const chain *c, double base, double offset) {
    double p = base + offset, Q = c->rest - c->viscous * p;
    for (int i = 0; i < c->count; i++) Q += c->weight[i] * p / ((base - c->rate[i]) + offset);
    return Q;
}

static double image_slope(const chain *c, double base, double offset) {
    double slope = c->viscous;
    for (int i = 0; i < c->count; i++) {
        double distance = (base - c->rate[i]) + offset;
        slope += c->weight[i] * c->rate[i] / (distance * distance);
    }
    return slope;
}

// The zero between low and high, where Q falls: as an offset from *base, the nearer of the two.
// Halving of its logarithm: the offset may be as small as a weight.
static double zero_between(const chain *c, double low, double high, double *base) {
    double half = 0.5 * (high - low);
    bool near_low = image(c, low, half) < 0;
    *base = near_low ? low : high;
    double sign = near_low ? 1 : -1, far = log(half), near = far - 300;
    for (int k = 0; k < 100; k++) {
        double middle = 0.5 * (near + far);
        // Q falls: above 0 the zero lies higher
        bool higher = image(c, *base, sign * exp(middle)) > 0;
        if (higher == near_low)
            near = middle;
        else
            far = middle;
    }
    return sign * exp(0.5 * (near + far));
}

static void add_zero(const chain *c, double low, double high, sn_retardations *out) {
    double base, offset = zero_between(c, low, high, &base), p = base + offset;
    out->tau[out->terms] = 1 / p;
    out->j[out->terms++] = 1 / (p * image_slope(c, base, offset));
}

void sn_exponentials_creep(const sn_exponentials *e, sn_retardations *out) {
    chain c;
    gather(e, &c);
    memset(out, 0, sizeof *out);
    double whole = c.rest, moment = c.viscous;
    for (int i = 0; i < c.count; i++) {
        whole += c.weight[i];
        moment += c.weight[i] / c.rate[i];
    }
    out->instant = c.viscous > 0 ? 0 : 1 / whole;
    if (!(c.rest > 0)) out->flow = 1 / moment;
    for (int i = 0; i < c.count; i++) {
        if (i == 0 && !(c.rest > 0)) continue;
        add_zero(&c, i ? c.rate[i - 1] : 0, c.rate[i], out);
    }
    if (!(c.viscous > 0)) return;
    // v p = g_inf + sum g p/(p - r) has p below this: the bracket is twice the last rate or more
    double last = c.count ? c.rate[c.count - 1] : 0;
    add_zero(&c, last, 2 * last + 4 * whole / c.viscous, out);
}

sn_status sn_memory_creep(const sn_memory *memory, sn_retardations *out) {
    sn_exponentials e;
    SN_TRY(sn_memory_expand(memory, &e));
    sn_exponentials_creep(&e, out);
    return SN_OK;
}

double sn_retardations_at(const sn_retardations *r, double t) {
    SN_ASSERT(t >= 0);
    double J = r->instant + r->flow * t;
    for (int i = 0; i < r->terms; i++) J -= r->j[i] * expm1(-t / r->tau[i]);
    return J;
}
