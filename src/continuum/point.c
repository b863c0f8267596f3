// Quadrature points: from displacements and pressures to strain, stress and consistent tangent.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/point.h"

#include <math.h>
#include <string.h>

enum { N = SN_FE_POINTS };

void sn_fe_gather(const sn_fe_space *s, int batch, const double *x, double *u) {
    int width = s->batch_cells, nodes = s->element.nodes;
    const int *node = s->node + (size_t)batch * (size_t)(nodes * width);
    for (int a = 0; a < nodes; a++)
        for (int c = 0; c < width; c++) {
            const double *R = sn_fe_axes(s, batch, c);
            const double *from = x + 3 * (size_t)node[a * width + c];
            double *to = u + 3 * a * width + c;
            if (s->rotated) {
                for (int i = 0; i < 3; i++)
                    to[i * width] =
                        R[3 * i] * from[0] + R[3 * i + 1] * from[1] + R[3 * i + 2] * from[2];
            } else {
                for (int i = 0; i < 3; i++) to[i * width] = from[i];
            }
        }
}

// M at point q of all cells: M_ij = sum_k A_ik grad_j lambda_k, A_ik = sum_a u_ai dN_a/dlambda_k.
static void gradients(const sn_fe_space *s, int batch, const double *u, int q, sn_fe_points *out) {
    int width = s->batch_cells, nodes = s->element.nodes;
    const double *g = s->gradient + (size_t)batch * (size_t)(12 * width);
    double A[12 * N] = {0};
    for (int a = 0; a < nodes; a++)
        for (int k = 0; k < 4; k++) {
            double slope = s->element.slope[q][a][k];
            if (slope == 0.0) continue;
            for (int i = 0; i < 3; i++)
                for (int c = 0; c < width; c++)
                    A[(3 * k + i) * width + c] += slope * u[(3 * a + i) * width + c];
        }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double *M = out->M + (3 * i + j) * N + q * width;
            for (int c = 0; c < width; c++) {
                double v = 0.0;
                for (int k = 0; k < 4; k++)
                    v += A[(3 * k + i) * width + c] * g[(3 * k + j) * width + c];
                M[c] = v;
            }
        }
    for (int c = 0; c < width; c++)
        out->weight[q * width + c] = s->element.weight[q] * s->volume[batch * width + c];
}

// E, J - 1 and C^{-1} of all points.
static void strains(sn_fe_points *out) {
    for (int n = 0; n < N; n++) {
        double M[3][3], C[6];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) M[i][j] = out->M[(3 * i + j) * N + n];
        static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
        for (int k = 0; k < 6; k++) {
            int i = at[k][0], j = at[k][1];
            double square = M[0][i] * M[0][j] + M[1][i] * M[1][j] + M[2][i] * M[2][j];
            double E = 0.5 * (M[i][j] + M[j][i] + square);
            out->E[k * N + n] = E;
            C[k] = 2.0 * E + (k < 3 ? 1.0 : 0.0);
        }
        double m00 = M[1][1] * M[2][2] - M[1][2] * M[2][1];
        double m11 = M[0][0] * M[2][2] - M[0][2] * M[2][0];
        double m22 = M[0][0] * M[1][1] - M[0][1] * M[1][0];
        double det = M[0][0] * m00 - M[0][1] * (M[1][0] * M[2][2] - M[1][2] * M[2][0]) +
                     M[0][2] * (M[1][0] * M[2][1] - M[1][1] * M[2][0]);
        double J1 = (M[0][0] + M[1][1] + M[2][2]) + (m00 + m11 + m22) + det;
        double r = 1.0 / ((1.0 + J1) * (1.0 + J1));
        out->J1[n] = J1;
        out->Ci[0 * N + n] = (C[1] * C[2] - C[4] * C[4]) * r;
        out->Ci[1 * N + n] = (C[2] * C[0] - C[5] * C[5]) * r;
        out->Ci[2 * N + n] = (C[0] * C[1] - C[3] * C[3]) * r;
        out->Ci[3 * N + n] = (C[4] * C[5] - C[3] * C[2]) * r;
        out->Ci[4 * N + n] = (C[3] * C[5] - C[4] * C[0]) * r;
        out->Ci[5 * N + n] = (C[3] * C[4] - C[5] * C[1]) * r;
    }
}

// p, g and the elastic volumetric value of all points.
static void volumes(const sn_fe_space *s, const sn_fe_material *m, const double *past, int batch,
                    const double *x, sn_fe_points *out) {
    double *T = out->T + SN_FE_VOLUME * N, a = m->part[SN_PART_VOLUMETRIC].factor;
    past = past ? past + SN_FE_VOLUME * N : NULL;
    if (!s->element.mixed) {
        for (int n = 0; n < N; n++) {
            T[n] = m->bulk * out->J1[n];
            out->p[n] = a * T[n] + (past ? past[n] : 0.0);
        }
        return;
    }
    int width = s->batch_cells;
    const int *node = s->node + (size_t)batch * (size_t)(s->element.nodes * width);
    const double *pressure = x + 3 * (size_t)s->nodes;
    bool incompressible = isinf(m->bulk);
    for (int q = 0; q < s->element.points; q++)
        for (int c = 0; c < width; c++) {
            int n = q * width + c;
            double p = 0.0, before = past && !incompressible ? past[n] : 0.0;
            for (int k = 0; k < 4; k++)
                p += s->element.lambda[q][k] * pressure[node[k * width + c]];
            out->p[n] = p;
            T[n] = incompressible ? 0.0 : (p / m->bulk - before) / a;
            out->g[n] = out->J1[n] - T[n];
        }
}

// Index of component (i, j) of a symmetric tensor, and of (a, b) of the upper triangle by rows.
static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};

// S += p J C^{-1}, and the same in the tangent.
static void add_volume(const sn_fe_space *s, const sn_fe_material *m, unsigned what,
                       sn_fe_points *out) {
    double stiff[N], pJ[N], factor = m->part[SN_PART_VOLUMETRIC].factor;
    for (int n = 0; n < N; n++) {
        double J = 1.0 + out->J1[n];
        pJ[n] = out->p[n] * J;
        stiff[n] = pJ[n] + (s->element.mixed ? 0.0 : factor * m->bulk * J * J);
    }
    for (int k = 0; k < 6; k++)
        for (int n = 0; n < N; n++) out->S[k * N + n] += pJ[n] * out->Ci[k * N + n];
    if (!(what & SN_FE_TANGENT)) return;
    const double *Ci = out->Ci;
    for (int a = 0, at = 0; a < 6; a++)
        for (int b = a; b < 6; b++, at++) {
            int i = pair[a][0], j = pair[a][1], k = pair[b][0], l = pair[b][1];
            const double *ik = Ci + sym[i][k] * N, *jl = Ci + sym[j][l] * N;
            const double *il = Ci + sym[i][l] * N, *jk = Ci + sym[j][k] * N;
            for (int n = 0; n < N; n++)
                out->D[at * N + n] += stiff[n] * Ci[a * N + n] * Ci[b * N + n] -
                                      pJ[n] * (ik[n] * jl[n] + il[n] * jk[n]);
        }
}

// Keeps the elastic S_d, then S = a S_d + past and D = a D_d.
static void remember(const sn_fe_material *m, const double *past, unsigned what,
                     sn_fe_points *out) {
    double a = m->part[SN_PART_DEVIATORIC].factor;
    memcpy(out->T, out->S, 6 * N * sizeof *out->T);
    if (!past) return;
    for (int k = 0; k < 6 * N; k++) out->S[k] = a * out->S[k] + past[k];
    if (what & SN_FE_TANGENT)
        for (int k = 0; k < 21 * N; k++) out->D[k] *= a;
}

// Adds fibres with a memory of their own: keeps their elastic S_f, then S += a S_f + past, and the
// same in W and D.
static void add_fibres(const sn_fe_material *m, const double *past, unsigned what,
                       sn_fe_points *out) {
    const sn_tissue *fibres = m->split + 1;
    double W[N], D[21 * N], *T = out->T + SN_FE_FIBRES * N, a = m->part[SN_PART_FIBRE].factor;
    sn_law_solid(fibres->law, fibres->value, fibres->terms, N, out->E,
                 what & SN_FE_ENERGY ? W : NULL, T, what & SN_FE_TANGENT ? D : NULL);
    for (int k = 0; k < 6 * N; k++) out->S[k] += a * T[k];
    for (int k = 0; k < 6 * N && past; k++) out->S[k] += past[SN_FE_FIBRES * N + k];
    for (int k = 0; k < N && what & SN_FE_ENERGY; k++) out->W[k] += W[k];
    for (int k = 0; k < 21 * N && what & SN_FE_TANGENT; k++) out->D[k] += a * D[k];
}

static bool sound(const sn_fe_space *s, int batch, const sn_fe_points *out, bool stressed,
                  sn_fe_fault *fault) {
    double check = 0.0, least = 1.0;
    for (int n = 0; n < N; n++) least = fmin(least, out->J1[n]);
    for (int k = 0; k < 6 * N; k++) check += 0.0 * (stressed ? out->S[k] : out->E[k]);
    if (least > -1.0 && check == 0.0) return true;
    int width = s->batch_cells, worst = 0;
    for (int n = 0; n < N; n++) {
        double sum = 0.0;
        for (int k = 0; k < 6; k++) sum += 0.0 * (stressed ? out->S[k * N + n] : out->E[k * N + n]);
        bool bad = sum != 0.0;
        if (bad || out->J1[n] < out->J1[worst]) worst = n;
        if (bad) break;
    }
    fault->cell = s->slot[batch * width + worst % width];
    fault->J = stressed ? (double)NAN : 1.0 + out->J1[worst];
    return false;
}

bool sn_fe_points_at(const sn_fe_space *s, const sn_fe_materials *materials, int batch,
                     const double *x, unsigned what, sn_fe_points *out, sn_fe_fault *fault) {
    double u[12 * SN_FE_POINTS]; // 64 linear cells; 16 quadratic ones need less
    const sn_fe_material *m = materials->material + s->batch_region[batch];
    const double *past = sn_fe_materials_past(materials, s, batch);
    sn_fe_gather(s, batch, x, u);
    for (int q = 0; q < s->element.points; q++) gradients(s, batch, u, q, out);
    strains(out);
    if (!sound(s, batch, out, false, fault)) return false;
    sn_law_solid(m->tissue->law, m->split->value, m->tissue->terms, N, out->E,
                 what & SN_FE_ENERGY ? out->W : NULL, out->S, what & SN_FE_TANGENT ? out->D : NULL);
    remember(m, past, what, out);
    if (m->splits > 1) add_fibres(m, past, what, out);
    volumes(s, m, past, batch, x, out);
    if (!(what & SN_FE_UNPRESSED)) add_volume(s, m, what, out);
    if (what & SN_FE_ENERGY && !isinf(m->bulk))
        for (int n = 0; n < N; n++) {
            // K (J - 1), or the volume strain of the pressure
            double v = out->T[SN_FE_VOLUME * N + n];
            out->W[n] += s->element.mixed ? 0.5 * m->bulk * v * v : 0.5 * v * v / m->bulk;
        }
    return sound(s, batch, out, true, fault);
}
