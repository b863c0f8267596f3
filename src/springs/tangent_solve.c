// Solves with the tangent: conjugate gradients, and what replaces them where friction slips.
// SPDX-License-Identifier: Apache-2.0
// Source: Hestenes and Stiefel 1952; BiCGSTAB: van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992).
#include <math.h>
#include <string.h>

#include "springs/tangent.h"
#include "springs/vectors.h"

static void hold(const sn_net *net, double *x) {
    for (int k = 0; k < net->fixed_count; k++)
        x[3 * net->fixed[k].node + net->fixed[k].direction] = 0.0;
}

static void multiply(const sn_net *net, sn_tangent *t, const double *x, double *y) {
    sn_tangent_multiply(net, t, x, y);
    hold(net, y);
}

static void precondition(const sn_net *net, const sn_tangent *t, const double *r, double *z) {
    for (int i = 0; i < net->nodes; i++) {
        const double *m = t->inverse + 9 * (size_t)i, *v = r + 3 * (size_t)i;
        for (int d = 0; d < 3; d++)
            z[3 * i + d] = m[3 * d] * v[0] + m[3 * d + 1] * v[1] + m[3 * d + 2] * v[2];
    }
}

static int conjugate_gradients(const sn_net *net, sn_tangent *t, int most, double target,
                               double *x) {
    const size_t n = (size_t)net->nodes * 3;
    precondition(net, t, t->r, t->z);
    memcpy(t->p, t->z, n * sizeof *t->p);
    double rz = sn_dot(t->r, t->z, n);
    int turn = 0;
    for (; turn < most && sn_dot(t->r, t->r, n) > target * target; turn++) {
        multiply(net, t, t->p, t->q);
        double pq = sn_dot(t->p, t->q, n);
        if (!(pq > 0)) return turn == 0 ? -1 : -turn;
        double a = rz / pq;
        for (size_t i = 0; i < n; i++) {
            x[i] += a * t->p[i];
            t->r[i] -= a * t->q[i];
        }
        precondition(net, t, t->r, t->z);
        double next = sn_dot(t->r, t->z, n), ratio = next / rz;
        rz = next;
        for (size_t i = 0; i < n; i++) t->p[i] = t->z[i] + ratio * t->p[i];
    }
    return turn;
}

// Two products a turn; where its two-term recurrence breaks down the caller gets what there is.
static int stabilised_gradients(const sn_net *net, sn_tangent *t, int most, double target,
                                double *x) {
    const size_t n = (size_t)net->nodes * 3;
    double *r = t->r, *p = t->p;
    memcpy(t->shadow, r, n * sizeof *r);
    memcpy(p, r, n * sizeof *r);
    double rho = sn_dot(t->shadow, r, n);
    int turn = 0;
    for (; turn < most && sn_dot(r, r, n) > target * target; turn++) {
        precondition(net, t, p, t->y);
        multiply(net, t, t->y, t->v);
        const double a = rho / sn_dot(t->shadow, t->v, n);
        for (size_t i = 0; i < n; i++) r[i] -= a * t->v[i];
        precondition(net, t, r, t->z);
        multiply(net, t, t->z, t->q);
        const double w = sn_dot(t->q, r, n) / sn_dot(t->q, t->q, n);
        if (!isfinite(a) || !isfinite(w) || w == 0) return -1 - turn;
        for (size_t i = 0; i < n; i++) {
            x[i] += a * t->y[i] + w * t->z[i];
            r[i] -= w * t->q[i];
        }
        const double next = sn_dot(t->shadow, r, n), ratio = next / rho * (a / w);
        rho = next;
        for (size_t i = 0; i < n; i++) p[i] = r[i] + ratio * (p[i] - w * t->v[i]);
    }
    return turn;
}

int sn_tangent_solve(const sn_net *net, sn_tangent *t, const double *b, double target, double *x) {
    const size_t n = (size_t)net->nodes * 3;
    const int most = 200 + 20 * (int)sqrt((double)n) + (int)n / 4;
    multiply(net, t, x, t->q);
    for (size_t i = 0; i < n; i++) t->r[i] = b[i] - t->q[i];
    return t->unsymmetric ? stabilised_gradients(net, t, most, target, x)
                          : conjugate_gradients(net, t, most, target, x);
}
