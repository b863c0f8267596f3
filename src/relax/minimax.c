// Exponentials with the smallest largest error on a grid of times.
// SPDX-License-Identifier: Apache-2.0
//
// Unknowns are u_i = ln tau_i and v_i of g_i = exp(v_i)/Z, Z = sum over i and infinity: weights
// stay positive and sum to 1 whatever the step, so G(0) = 1 is exact and nothing is constrained.
// With x_i = t/tau_i and G~ the sum itself
//     dG~/du_i = g_i x_i exp(-x_i),   dG~/dv_i = g_i (exp(-x_i) - G~),   dG~/dv_inf = g_inf (1 -
//     G~).
// (The v may all be shifted by one number: the damping takes care of that direction.)
//
// The largest error is approached through p-norms, p = 2, 4, 8, … 128, each started from the last.
// A Newton step of the p-norm solves a least-squares problem with weights w_k = |e_k/max e|^(p-2),
// divided by p - 1:
//     (sum w J J' + damping) d = -(sum w J e)/(p - 1)
// with Levenberg-Marquardt damping. At p = 128 and 200 points the largest error is within
// 200^(1/128) = 4 % of the smallest possible near this optimum; one exponential more divides it by
// 1.5 (12 decades of relaxation times) to 3 (4 decades), so a number of terms is wrongly refused
// only in a sliver of tolerances.
//
// Errors down to about 1e-6 are reached to a few percent; below, the valley of the optimum is so
// narrow and bent that the search creeps (with orthogonal factors too), and compress.c stops it.
//
// The least-squares optimum (p = 2) also tells when to give up: no exponentials near it have a
// largest error below its root mean square error.
#include "relax/minimax.h"

#include <float.h>
#include <math.h>

#define POWER_MAX 128.0

// the errors of e on the grid; returns the largest
static double errors(const sn_minimax *m, const sn_exponentials *e, double *error) {
    double largest = 0;
    for (int k = 0; k < m->points; k++) {
        error[k] = sn_exponentials_at(e, m->t[k]) - m->target[k];
        largest = fmax(largest, fabs(error[k]));
    }
    return largest;
}

// (mean of |e_k|^p)^(1/p), with nothing that overflows
static double norm(const sn_minimax *m, const double *error, double largest, double p) {
    if (largest == 0) return 0;
    double sum = 0;
    for (int k = 0; k < m->points; k++) sum += pow(fabs(error[k]) / largest, p);
    return largest * pow(sum / m->points, 1 / p);
}

static void fill_jacobian(sn_minimax *m, const sn_exponentials *e) {
    int n = e->terms;
    m->params = 2 * n + 1;
    for (int k = 0; k < m->points; k++) {
        double *row = m->jacobian[k], G = m->target[k] + m->error[k];
        for (int i = 0; i < n; i++) {
            double x = m->t[k] / e->tau[i], decay = exp(-x);
            row[i] = x < 700 ? e->g[i] * x * decay : 0.0;
            row[n + i] = e->g[i] * (decay - G);
        }
        row[2 * n] = e->g_inf * (1 - G);
    }
}

// the normal matrix (lower half) and the right-hand side of a Newton step of the p-norm
static void fill_normal(sn_minimax *m, double largest, double p, double *right) {
    int size = m->params;
    for (int i = 0; i < size; i++) {
        right[i] = 0;
        for (int j = 0; j <= i; j++) m->normal[i][j] = 0;
    }
    for (int k = 0; k < m->points; k++) {
        double w = p > 2 ? pow(fabs(m->error[k]) / largest, p - 2) : 1.0;
        if (w < DBL_EPSILON) continue;
        const double *row = m->jacobian[k];
        for (int i = 0; i < size; i++) {
            double wi = w * row[i];
            right[i] -= wi * m->error[k] / (p - 1);
            for (int j = 0; j <= i; j++) m->normal[i][j] += wi * row[j];
        }
    }
}

// Cholesky solution of (normal + damping of its diagonal) d = right. Returns false where rounding
// leaves no positive pivot.
static bool solve(const sn_minimax *m, double damping, const double *right, double *d) {
    double L[SN_MINIMAX_PARAMS][SN_MINIMAX_PARAMS], trace = 0;
    int size = m->params;
    for (int i = 0; i < size; i++) trace += m->normal[i][i];
    for (int i = 0; i < size; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = m->normal[i][j];
            // a share of the trace holds back what the grid does not see at all
            if (i == j) sum += damping * (sum + 1e-6 * trace) + DBL_EPSILON * trace;
            for (int k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
            if (i == j) {
                if (!(sum > 0)) return false;
                L[i][i] = sqrt(sum);
            } else {
                L[i][j] = sum / L[j][j];
            }
        }
    }
    for (int i = 0; i < size; i++) {
        d[i] = right[i];
        for (int k = 0; k < i; k++) d[i] -= L[i][k] * d[k];
        d[i] /= L[i][i];
    }
    for (int i = size - 1; i >= 0; i--) {
        for (int k = i + 1; k < size; k++) d[i] -= L[k][i] * d[k];
        d[i] /= L[i][i];
    }
    return true;
}

// e moved by d, at most a factor of 10 in any unknown
static sn_exponentials moved(const sn_exponentials *e, const double *d) {
    sn_exponentials out = *e;
    int n = e->terms;
    double largest = 0, total = 0;
    for (int i = 0; i <= 2 * n; i++) largest = fmax(largest, fabs(d[i]));
    double scale = largest > log(10) ? log(10) / largest : 1.0;
    for (int i = 0; i < n; i++) {
        out.tau[i] *= exp(scale * d[i]);
        out.g[i] *= exp(scale * d[n + i]);
        total += out.g[i];
    }
    out.g_inf *= exp(scale * d[2 * n]);
    total += out.g_inf;
    for (int i = 0; i < n; i++) out.g[i] /= total;
    out.g_inf /= total;
    return out;
}

// Levenberg-Marquardt on one p-norm. Returns the largest error; *reached is the norm.
static double descend(sn_minimax *m, sn_exponentials *e, double p, int steps, double *reached) {
    double right[SN_MINIMAX_PARAMS], d[SN_MINIMAX_PARAMS];
    double trial_error[SN_MINIMAX_POINTS], damping = 1e-3;
    double largest = errors(m, e, m->error);
    *reached = norm(m, m->error, largest, p);
    for (int step = 0; step < steps && largest > m->goal; step++) {
        fill_jacobian(m, e);
        fill_normal(m, largest, p, right);
        double before = *reached;
        for (int attempt = 0; attempt < 8; attempt++, damping *= 8) {
            if (!solve(m, damping, right, d)) continue;
            sn_exponentials trial = moved(e, d);
            double trial_largest = errors(m, &trial, trial_error);
            double trial_norm = norm(m, trial_error, trial_largest, p);
            if (!(trial_norm < *reached)) continue;
            *e = trial;
            *reached = trial_norm;
            largest = trial_largest;
            for (int k = 0; k < m->points; k++) m->error[k] = trial_error[k];
            damping = fmax(damping / 10, 1e-14);
            break;
        }
        if (*reached > before * (1 - 2e-3)) break; // settled
    }
    return largest;
}

double sn_minimax_improve(sn_minimax *m, sn_exponentials *e) {
    double reached, largest = descend(m, e, 2, 40, &reached);
    for (double p = 4; p <= POWER_MAX && largest > m->goal && reached <= m->goal; p *= 2)
        largest = descend(m, e, p, 8, &reached);
    return largest;
}
