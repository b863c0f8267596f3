// Stiffness of the springs of the built-in blocks.
// SPDX-License-Identifier: Apache-2.0
// Source: Cauchy-Born rule; the class constants were tried on a prototype first.
//
// Under a uniform strain E a spring of rest vector D and stiffness k stores k (D.E.D)^2 / (2 L^2),
// so that a lattice with n_s springs of class s in a cell of volume v has the elastic tensor
//     C_ijkl = 1/v sum_s n_s k_s <D_i D_j D_k D_l> / L_s^2,
// totally symmetric, hence lambda = mu (the Cauchy relations). It is isotropic with shear modulus
// mu when the six sums for xxxx yyyy zzzz are 3 mu and those for xxyy yyzz zzxx are mu: all others
// vanish because every class holds its mirror images in equal numbers. Classes are those of |dx|
// |dy| |dz|:
//     mirrored: three along the axes, three face diagonals, one body diagonal; one of each per
//     cell.
//               One parameter is left free and chosen by the least sum over kinds (axis, face,
//               body) of the mean square. Cubic cells of edge h get 17/14, 11/7, 9/14 times mu h.
//     bcc:      three along the axes (two of each per cell: corners and centres) and the half body
//               diagonals (eight). Only cubic cells can be isotropic: mu h and 3/2 mu h.
//               Diagonals that the cut of the boundary adds get no spring.
// Constants must not be negative, which rules out very flat cells. Springs on the boundary are
// shared with the missing neighbour: they count by the angle of their cells over a full turn.
#include <math.h>
#include <string.h>

#include "springs/net.h"

enum { CLASSES = 7, EQUATIONS = 6 };

typedef struct lattice_system {
    double A[EQUATIONS][CLASSES];
    double b[EQUATIONS];
    double norm[CLASSES]; // weight of k^2
    int classes;
} lattice_system;

static void add_class(lattice_system *s, const double D[3], double per_volume, double norm) {
    double L2 = D[0] * D[0] + D[1] * D[1] + D[2] * D[2];
    int k = s->classes++;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        s->A[i][k] = per_volume * D[i] * D[i] * D[i] * D[i] / L2;
        s->A[3 + i][k] = per_volume * D[i] * D[i] * D[j] * D[j] / L2;
    }
    s->norm[k] = norm;
}

// Solves the symmetric positive semidefinite G y = b with complete pivoting; rows that vanish are
// left out (their consistency is checked by the caller's residual).
static void solve_semidefinite(double G[EQUATIONS][EQUATIONS], const double *b, double *y) {
    double x[EQUATIONS], scale = 0.0;
    bool done[EQUATIONS] = {false};
    memcpy(x, b, sizeof x);
    for (int i = 0; i < EQUATIONS; i++) scale = fmax(scale, G[i][i]);
    for (int turn = 0; turn < EQUATIONS; turn++) {
        int p = -1;
        for (int i = 0; i < EQUATIONS; i++)
            if (!done[i] && (p < 0 || G[i][i] > G[p][p])) p = i;
        if (G[p][p] <= 1e-10 * scale) break;
        done[p] = true;
        double pivot = G[p][p];
        for (int j = 0; j < EQUATIONS; j++) G[p][j] /= pivot;
        x[p] /= pivot;
        for (int i = 0; i < EQUATIONS; i++) {
            if (i == p) continue;
            double factor = G[i][p];
            for (int j = 0; j < EQUATIONS; j++) G[i][j] -= factor * G[p][j];
            x[i] -= factor * x[p];
        }
    }
    for (int i = 0; i < EQUATIONS; i++) y[i] = done[i] ? x[i] : 0.0;
}

// least-norm solution with the classes in `used`; false where there is none without negative ones
static bool solve_with(const lattice_system *s, unsigned used, double *k, double *norm) {
    double G[EQUATIONS][EQUATIONS] = {{0}}, y[EQUATIONS];
    for (int i = 0; i < EQUATIONS; i++)
        for (int j = 0; j < EQUATIONS; j++)
            for (int c = 0; c < s->classes; c++)
                if (used >> c & 1) G[i][j] += s->A[i][c] * s->A[j][c] / s->norm[c];
    solve_semidefinite(G, s->b, y);
    *norm = 0.0;
    double largest = 0.0;
    for (int c = 0; c < s->classes; c++) {
        k[c] = 0.0;
        if (used >> c & 1)
            for (int i = 0; i < EQUATIONS; i++) k[c] += s->A[i][c] * y[i] / s->norm[c];
        largest = fmax(largest, fabs(k[c]));
        *norm += s->norm[c] * k[c] * k[c];
    }
    for (int c = 0; c < s->classes; c++)
        if (k[c] < -1e-12 * largest) return false;
    for (int i = 0; i < EQUATIONS; i++) {
        double sum = -s->b[i];
        for (int c = 0; c < s->classes; c++) sum += s->A[i][c] * k[c];
        if (fabs(sum) > 1e-9) return false;
    }
    return true;
}

bool sn_lattice_constants(const sn_shape_def *shape, double axis[3], double face[3], double *body) {
    lattice_system s = {.b = {3, 3, 3, 1, 1, 1}};
    double h[3], v = 1.0;
    for (int d = 0; d < 3; d++) {
        h[d] = shape->size[d] / shape->cells[d];
        v *= h[d];
    }
    bool bcc = shape->pattern == SN_PATTERN_BCC;
    if (shape->shape != SN_SHAPE_BLOCK || shape->pattern == SN_PATTERN_KUHN) return false;
    if (shape->ratio > 0 && shape->ratio != 1) return false; // cells of many sizes: no classes
    for (int d = 0; d < 3; d++) {
        double D[3] = {0};
        D[d] = h[d];
        add_class(&s, D, (bcc ? 2 : 1) / v, 1.0 / 3.0);
    }
    for (int d = 0; d < 3 && !bcc; d++) { // xy yz zx
        double D[3] = {h[0], h[1], h[2]};
        D[(d + 2) % 3] = 0;
        add_class(&s, D, 1 / v, 1.0 / 3.0);
    }
    const double half = bcc ? 0.5 : 1.0, D[3] = {half * h[0], half * h[1], half * h[2]};
    add_class(&s, D, (bcc ? 8 : 1) / v, 1.0);

    double best[CLASSES] = {0}, least = INFINITY;
    for (unsigned used = 1; used < 1u << s.classes; used++) {
        double k[CLASSES], norm;
        if (!solve_with(&s, used, k, &norm) || norm >= least) continue;
        least = norm;
        memcpy(best, k, sizeof best);
    }
    for (int d = 0; d < 3; d++) {
        axis[d] = best[d];
        face[d] = bcc ? 0.0 : best[3 + d];
    }
    *body = best[s.classes - 1];
    return isfinite(least);
}
