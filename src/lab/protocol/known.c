// Hereditary stress where the elastic stress is a known function of the stretch.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); incompressible uniaxial tension.
//
// A uniaxial law has one channel f = T(stretch). An incompressible solid has two, f = S11 and S22
// at the lateral stretch L^(-1/2); its nominal stress is L H[S11] - H[S22] / L^2, H the hereditary
// integral H[f](t) = int G(t - s) f'(s) ds. Over a step of h seconds an exponential's share obeys
//     H_i <- exp(-x) H_i + g_i h (wa f'(0) + wm f'(h/2) + we f'(h)),    x = h/tau_i,
// where the weights integrate exp(-(h - s)/tau_i) times the parabola through the three rates
// exactly. With u = 1 - s/h and the moments M_k = int_0^1 u^k exp(-x u) du they are
//     we = M0 - 3 M1 + 2 M2,   wm = 4 M1 - 4 M2,   wa = 2 M2 - M1.
// Nothing depends on x being small: a relaxation time far below the step sees the rate at the end
// of the step, one far above it sees Simpson's rule.
#include <math.h>

#include "lab/protocol/path.h"

enum { CHANNELS_MAX = 2 };
// coarsest sub-steps over the whole range of the stretch, at level 1
static const double steps_over_range = 12.0;

typedef struct channels {
    int count;     // of channels
    int points;    // at which they are known
    double *block; // owns what follows
    double *stretch;
    double *value[CHANNELS_MAX]; // f
    double *slope[CHANNELS_MAX]; // df/dstretch
} channels;

typedef struct weights {
    double decay[SN_TERMS_MAX], start[SN_TERMS_MAX], middle[SN_TERMS_MAX], end[SN_TERMS_MAX];
} weights;

// sum over j of (-x)^j / (j! (j + 3)), 0 <= x <= 1: the remainder is below 1/(18! 21) = 1e-17
static double moment2_series(double x) {
    double sum = 0.0;
    static const double c[] = {1.0 / 3,
                               1.0 / 4,
                               1.0 / (2.0 * 5),
                               1.0 / (6.0 * 6),
                               1.0 / (24.0 * 7),
                               1.0 / (120.0 * 8),
                               1.0 / (720.0 * 9),
                               1.0 / (5040.0 * 10),
                               1.0 / (40320.0 * 11),
                               1.0 / (362880.0 * 12),
                               1.0 / (3628800.0 * 13),
                               1.0 / (39916800.0 * 14),
                               1.0 / (479001600.0 * 15),
                               1.0 / (6227020800.0 * 16),
                               1.0 / (87178291200.0 * 17),
                               1.0 / (1307674368000.0 * 18),
                               1.0 / (20922789888000.0 * 19),
                               1.0 / (355687428096000.0 * 20)};
    for (int j = (int)(sizeof c / sizeof *c) - 1; j >= 0; --j) sum = c[j] - x * sum;
    return sum;
}

// `moving`: the weights are wanted too
static void step_weights(const sn_exponentials *e, double h, bool moving, weights *w) {
    for (int i = 0; i < e->terms && !moving; ++i) w->decay[i] = exp(-h / e->tau[i]);
    for (int i = 0; i < e->terms && moving; ++i) {
        double x = h / e->tau[i], decay = exp(-x), m0, m1, m2;
        if (x < 1.0) { // downwards from the series: the upward way cancels
            m2 = moment2_series(x);
            m1 = 0.5 * (x * m2 + decay);
            m0 = x * m1 + decay;
        } else {
            m0 = (1.0 - decay) / x;
            m1 = (m0 - decay) / x;
            m2 = (2.0 * m1 - decay) / x;
        }
        double scale = e->g[i] * h;
        w->decay[i] = decay;
        w->start[i] = scale * (2.0 * m2 - m1);
        w->middle[i] = scale * 4.0 * (m1 - m2);
        w->end[i] = scale * (m0 - 3.0 * m1 + 2.0 * m2);
    }
}

// equal parts of the interval between instants k and k + 1
static int parts_of(const sn_path *path, int k, int level) {
    double change = fabs(path->stretch[k + 1] - path->stretch[k]);
    if (change == 0.0) return 1;
    return (int)fmax(1.0, ceil(level * steps_over_range * change / path->range));
}

// f and df/dstretch of an incompressible solid with equal lateral stretches
static sn_status fill_closed(const sn_tissue *tissue, channels *c) {
    size_t n = (size_t)c->points;
    double *E = sn_alloc((6 + 6 + 21) * n, sizeof *E);
    if (!E) return SN_E_MEMORY;
    double *S = E + 6 * n, *D = S + 6 * n;
    for (size_t i = 0; i < n; ++i) {
        double stretch = c->stretch[i];
        E[i] = 0.5 * (stretch - 1.0) * (stretch + 1.0);
        E[n + i] = E[2 * n + i] = 0.5 * (1.0 - stretch) / stretch;
    }
    sn_law_solid(tissue->law, tissue->value, tissue->terms, c->points, E, NULL, S, D);
    for (size_t i = 0; i < n; ++i) {
        double along = c->stretch[i], across = -0.5 / (along * along); // dE/dstretch
        c->value[0][i] = S[i];
        c->value[1][i] = S[n + i];
        c->slope[0][i] = D[i] * along + (D[n + i] + D[2 * n + i]) * across;
        c->slope[1][i] = D[n + i] * along + (D[6 * n + i] + D[7 * n + i]) * across;
    }
    sn_free(E);
    return SN_OK;
}

// the points of all intervals one after the other: start, then middle and end of every part
static sn_status channels_create(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                                 int level, channels *c) {
    *c = (channels){.count = pull == SN_PULL_UNIAXIAL ? 1 : 2, .points = 1};
    for (int k = 0; k + 1 < path->count; ++k) c->points += 2 * parts_of(path, k, level);
    size_t n = (size_t)c->points;
    c->block = sn_alloc((1 + 2 * (size_t)c->count) * n, sizeof *c->block);
    if (!c->block) return SN_E_MEMORY;
    c->stretch = c->block;
    for (int a = 0; a < c->count; ++a) {
        c->value[a] = c->block + (size_t)(1 + 2 * a) * n;
        c->slope[a] = c->block + (size_t)(2 + 2 * a) * n;
    }
    c->stretch[0] = path->stretch[0];
    for (int k = 0, at = 1; k + 1 < path->count; ++k) {
        int parts = parts_of(path, k, level);
        double step = (path->stretch[k + 1] - path->stretch[k]) / (2 * parts);
        for (int j = 1; j <= 2 * parts; ++j)
            c->stretch[at++] = j == 2 * parts ? path->stretch[k + 1] : path->stretch[k] + step * j;
    }
    if (pull == SN_PULL_CLOSED) {
        sn_status status = fill_closed(tissue, c);
        if (status != SN_OK) sn_free(c->block);
        return status;
    }
    sn_law_uniaxial(tissue->law, tissue->value, tissue->terms, c->points, c->stretch, NULL,
                    c->value[0], c->slope[0]);
    return SN_OK;
}

// one interval of `parts` parts for one channel, the weights of a part given
static void advance(const sn_exponentials *e, const weights *w, int parts, double rate,
                    const double *slope, double *H) {
    if (rate == 0.0) {
        for (int i = 0; i < e->terms; ++i) H[i] *= w->decay[i];
        return;
    }
    for (int j = 0; j < parts; ++j, slope += 2) {
        double a = rate * slope[0], m = rate * slope[1], b = rate * slope[2];
        for (int i = 0; i < e->terms; ++i)
            H[i] = w->decay[i] * H[i] + w->start[i] * a + w->middle[i] * m + w->end[i] * b;
    }
}

static double combine(sn_pull pull, double stretch, const double *out) {
    if (pull == SN_PULL_UNIAXIAL) return out[0];
    return stretch * out[0] - out[1] / (stretch * stretch);
}

sn_status sn_path_stress_known(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                               const sn_exponentials *e, int level, double *stress) {
    double H[CHANNELS_MAX][SN_TERMS_MAX], out[CHANNELS_MAX];
    weights w;
    channels c;
    SN_TRY(channels_create(path, tissue, pull, level, &c));
    double *at_instant = sn_alloc((size_t)path->count, sizeof *at_instant);
    if (!at_instant) {
        sn_free(c.block);
        return SN_E_MEMORY;
    }
    for (int a = 0; a < c.count; ++a) { // a step from rest: G(0) = 1
        out[a] = c.value[a][0];
        for (int i = 0; i < e->terms; ++i) H[a][i] = e->g[i] * out[a];
    }
    at_instant[0] = combine(pull, path->stretch[0], out);
    for (int k = 0, at = 0; k + 1 < path->count; ++k) {
        int parts = parts_of(path, k, level);
        double duration = path->time[k + 1] - path->time[k];
        double rate = (path->stretch[k + 1] - path->stretch[k]) / duration;
        step_weights(e, duration / parts, rate != 0.0, &w);
        for (int a = 0; a < c.count; ++a) {
            advance(e, &w, parts, rate, c.slope[a] + at, H[a]);
            out[a] = e->g_inf * c.value[a][at + 2 * parts] +
                     e->viscous * rate * c.slope[a][at + 2 * parts];
            for (int i = 0; i < e->terms; ++i) out[a] += H[a][i];
        }
        at += 2 * parts;
        at_instant[k + 1] = combine(pull, path->stretch[k + 1], out);
    }
    for (int r = 0; r < path->records; ++r)
        stress[r] = path->record[r] < 0 ? 0.0 : at_instant[path->record[r]];
    sn_free(at_instant);
    sn_free(c.block);
    return SN_OK;
}
