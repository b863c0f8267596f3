// Hereditary integrals of elastic stresses that are known functions of what drives the test.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32).
//
// A channel f is an elastic stress as a function of the driving number x, which is linear in time
// between two instants; its hereditary integral is H[f](t) = int G(t - s) f'(s) ds. Over a step of
// h seconds an exponential's share obeys
//     H_i <- exp(-x) H_i + g_i h (wa f'(0) + wm f'(h/2) + we f'(h)),    x = h/tau_i,
// where the weights integrate exp(-(h - s)/tau_i) times the parabola through the three rates
// exactly. With u = 1 - s/h and the moments M_k = int_0^1 u^k exp(-x u) du they are
//     we = M0 - 3 M1 + 2 M2,   wm = 4 M1 - 4 M2,   wa = 2 M2 - M1.
// With an age in front, x u exp(-x u), the moments of the weights are the next ones, times x:
//     A <- exp(-x) (A + x H) + x h (M1 - 3 M2 + 2 M3) f'(h) + …
// Nothing depends on x being small: a relaxation time far below the step sees the rate at the end
// of the step, one far above it sees Simpson's rule.
#include "lab/protocol/hereditary.h"

#include <float.h>
#include <math.h>

// coarsest sub-steps over the whole range of what drives the test, at level 1
static const double steps_over_range = 12.0;

typedef struct channels {
    int count;                      // of channels
    int points;                     // at which they are known
    double *block;                  // owns what follows
    double *x;                      // what drives the test
    double *value[SN_CHANNELS_MAX]; // f
    double *slope[SN_CHANNELS_MAX]; // df/dx
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

// M3 by (k + 1) M_k = x M_(k+1) + exp(-x) downwards, 0 <= x <= 1
static double moment3(double x, double decay) {
    double m = decay / 22.0; // near M21; its error is divided by 21!/3! = 8e18 on the way
    for (int k = 20; k >= 3; --k) m = (x * m + decay) / (k + 1);
    return m;
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

// Whether an interval of h seconds that ends at `time` may have the weights of one of `last`
// seconds: they are equal but for the rounding of the times.
static bool same_step(double h, double last, double time) {
    return fabs(h - last) <= 4.0 * DBL_EPSILON * fabs(time);
}

// Equal parts of the interval between instants k and k + 1: `level` times those of level 1, so that
// two levels that agree say something.
static int parts_of(const sn_path *path, int k, int level) {
    double change = fabs(path->stretch[k + 1] - path->stretch[k]);
    if (change == 0.0) return 1;
    return level * (int)fmax(1.0, ceil(steps_over_range * change / path->range));
}

// Fibres carry from rest on, so that a law's slope may jump there; the one wanted is that on the
// side of the motion, which is looked up `beside` rest. Values at rest are 0.
static void step_beside(const sn_path *path, double beside, channels *c) {
    for (int i = 0; i < c->points; ++i) {
        if (c->x[i] != path->rest) continue;
        double before = i > 0 ? c->x[i - 1] - path->rest : 0.0;
        double after = i + 1 < c->points ? c->x[i + 1] - path->rest : 0.0;
        double side = fabs(before) > beside ? before : after;
        if (side != 0.0) c->x[i] += copysign(beside, side);
    }
}

// the points of all intervals one after the other: start, then middle and end of every part
static sn_status channels_create(const sn_path *path, const sn_channels *of, int level,
                                 channels *c) {
    *c = (channels){.count = of->count, .points = 1};
    for (int k = 0; k + 1 < path->count; ++k) c->points += 2 * parts_of(path, k, level);
    size_t n = (size_t)c->points;
    c->block = sn_alloc((1 + 2 * (size_t)c->count) * n, sizeof *c->block);
    if (!c->block) return SN_E_MEMORY;
    c->x = c->block;
    for (int a = 0; a < c->count; ++a) {
        c->value[a] = c->block + (size_t)(1 + a) * n;
        c->slope[a] = c->block + (size_t)(1 + c->count + a) * n;
    }
    c->x[0] = path->stretch[0];
    for (int k = 0, at = 1; k + 1 < path->count; ++k) {
        int parts = parts_of(path, k, level);
        double step = (path->stretch[k + 1] - path->stretch[k]) / (2 * parts);
        for (int j = 1; j <= 2 * parts; ++j)
            c->x[at++] = j == 2 * parts ? path->stretch[k + 1] : path->stretch[k] + step * j;
    }
    double beside = 1e-9 * path->range;
    step_beside(path, beside, c);
    sn_status status = of->fill(of->context, c->points, c->x, c->value[0], c->slope[0]);
    if (status != SN_OK) sn_free(c->block);
    for (int i = 0; status == SN_OK && i < c->points; ++i)
        if (c->x[i] == path->rest + beside || c->x[i] == path->rest - beside)
            for (int a = 0; a < c->count; ++a) c->value[a][i] = 0.0;
    return status;
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

sn_status sn_path_hereditary(const sn_path *path, const sn_channels *of, const sn_exponentials *e,
                             int level, double *out) {
    double H[SN_CHANNELS_MAX][SN_TERMS_MAX], last = -(double)INFINITY;
    weights w;
    channels c;
    SN_ASSERT(of->count <= SN_CHANNELS_MAX);
    SN_TRY(channels_create(path, of, level, &c));
    for (int a = 0; a < c.count; ++a) { // a step from rest: G(0) = 1
        out[a] = c.value[a][0];
        for (int i = 0; i < e->terms; ++i) H[a][i] = e->g[i] * out[a];
    }
    for (int k = 0, at = 0; k + 1 < path->count; ++k) {
        int parts = parts_of(path, k, level);
        double duration = path->time[k + 1] - path->time[k];
        double rate = (path->stretch[k + 1] - path->stretch[k]) / duration;
        double *now = out + (size_t)(k + 1) * (size_t)c.count;
        if (rate == 0.0 || !same_step(duration / parts, last, path->time[k + 1])) {
            last = rate == 0.0 ? -(double)INFINITY : duration / parts;
            step_weights(e, duration / parts, rate != 0.0, &w);
        }
        for (int a = 0; a < c.count; ++a) {
            advance(e, &w, parts, rate, c.slope[a] + at, H[a]);
            now[a] = e->g_inf * c.value[a][at + 2 * parts] +
                     e->viscous * rate * c.slope[a][at + 2 * parts];
            for (int i = 0; i < e->terms; ++i) now[a] += H[a][i];
        }
        at += 2 * parts;
    }
    sn_free(c.block);
    return SN_OK;
}

//---- derivatives by constants of the memory ------------------------------------------------------

// one exponential of unit weight, plain and with its age in front
typedef struct aged {
    double x, decay;
    double plain[3], old[3]; // weights of the rates at the start, the middle and the end of a step
} aged;

static void aged_weights(double tau, double h, aged *w) {
    double x = h / tau, m[4];
    w->x = x;
    w->decay = exp(-x);
    if (x < 1.0) { // downwards, as in step_weights()
        m[3] = moment3(x, w->decay);
        for (int k = 2; k >= 0; --k) m[k] = (x * m[k + 1] + w->decay) / (k + 1);
    } else {
        m[0] = (1.0 - w->decay) / x;
        for (int k = 1; k < 4; ++k) m[k] = (k * m[k - 1] - w->decay) / x;
    }
    for (int age = 0; age < 2; ++age) {
        double scale = age ? x * h : h, *to = age ? w->old : w->plain;
        to[0] = scale * (2.0 * m[2 + age] - m[1 + age]);
        to[1] = scale * 4.0 * (m[1 + age] - m[2 + age]);
        to[2] = scale * (m[age] - 3.0 * m[1 + age] + 2.0 * m[2 + age]);
    }
}

// shares of one channel in the plain and the aged exponential over `parts` parts
static void advance_aged(const aged *w, int parts, double rate, const double *slope, double H[2]) {
    for (int j = 0; j < parts; ++j, slope += 2) {
        H[1] = w->decay * (H[1] + w->x * H[0]);
        H[0] = w->decay * H[0];
        for (int i = 0; i < 3; ++i) {
            H[0] += w->plain[i] * rate * slope[i];
            H[1] += w->old[i] * rate * slope[i];
        }
    }
}

// by one constant; out (path->count x channels)
static void slope_of(const sn_path *path, const channels *c, const sn_memory_slope *by, int level,
                     double *out) {
    double H[SN_CHANNELS_MAX][2], last = -(double)INFINITY;
    aged w = {0};
    for (int a = 0; a < c->count; ++a) {
        H[a][0] = c->value[a][0];
        H[a][1] = 0.0;
        out[a] = (by->constant + by->plain) * c->value[a][0];
    }
    for (int k = 0, at = 0; k + 1 < path->count; ++k) {
        int parts = parts_of(path, k, level);
        double duration = path->time[k + 1] - path->time[k];
        double rate = (path->stretch[k + 1] - path->stretch[k]) / duration;
        if (!same_step(duration / parts, last, path->time[k + 1])) {
            last = duration / parts;
            aged_weights(by->tau, last, &w);
        }
        out += c->count;
        for (int a = 0; a < c->count; ++a) {
            advance_aged(&w, parts, rate, c->slope[a] + at, H[a]);
            out[a] = by->constant * c->value[a][at + 2 * parts] + by->plain * H[a][0] +
                     by->aged * H[a][1] + by->viscous * rate * c->slope[a][at + 2 * parts];
        }
        at += 2 * parts;
    }
}

sn_status sn_path_hereditary_slopes(const sn_path *path, const sn_channels *of, int count,
                                    const sn_memory_slope *slope, int level, double *out) {
    channels c;
    if (count == 0) return SN_OK;
    SN_TRY(channels_create(path, of, level, &c));
    for (int k = 0; k < count; ++k)
        slope_of(path, &c, &slope[k], level, out + (size_t)(k * path->count * of->count));
    sn_free(c.block);
    return SN_OK;
}
