// Material axes that differ from place to place, and the law in them.
// SPDX-License-Identifier: Apache-2.0
//
// Where all cells have the same axes, gradients stand in them and nothing else knows (net->axes).
// Where they differ everything stands in the axes of space (net->axes is the identity) and the law
// alone is turned: with Q the axes of a cell or smoothed edge,
//     S = Q^T S_m Q,  S_m the law's stress at E_m = Q E Q^T.
// As numbers s, and e with doubled shears, that is s = A s_m and e_m = A^T e, so that the
// derivative ds/de is A (ds_m/de_m) A^T. The memory, which is linear, lives in the axes of space.
//
// A smoothed edge has the mean axes of its cells by volume, each turned to the side of the first
// (a fibre has no sign), made orthonormal.
#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "springs/net.h"

static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};

//---- building ------------------------------------------------------------------------------------

static void set_turn(sn_net *net, int slot, const double Q[9]) {
    double *turn = net->data[SN_DOUBLE].turn;
    for (int k = 0; k < 9; k++)
        turn[((size_t)(slot / SN_BLOCK) * 9 + (size_t)k) * SN_BLOCK + (size_t)(slot % SN_BLOCK)] =
            Q[k];
}

static void get_turn(const sn_net *net, int slot, double Q[9]) {
    const double *turn = net->data[SN_DOUBLE].turn;
    for (int k = 0; k < 9; k++)
        Q[k] = turn[((size_t)(slot / SN_BLOCK) * 9 + (size_t)k) * SN_BLOCK +
                    (size_t)(slot % SN_BLOCK)];
}

// adds V x to sum, turned to the side of `first`
static void add_side(double V, const double x[3], const double first[3], double sum[3]) {
    double side = dot3(x, first) < 0 ? -V : V;
    for (int i = 0; i < 3; i++) sum[i] += side * x[i];
}

static void mean_axes(const sn_net *net, const int *cell_of, int edge, double Q[9]) {
    const double *volume = net->data[SN_DOUBLE].volume, *first = NULL;
    double sum[2][3] = {{0}}, V = 0;
    for (int s = net->edge_start[edge]; s < net->edge_start[edge + 1]; s++) {
        const double part = volume[net->edge_cell[s]];
        const double *axes = net->cell_axes + 9 * (size_t)cell_of[net->edge_cell[s]];
        if (!first) first = axes;
        add_side(part, axes, first, sum[0]);
        add_side(part, axes + 3, first + 3, sum[1]);
        V += part;
    }
    memcpy(Q, first, 9 * sizeof *Q);
    double length = norm3(sum[0]);
    if (!(length > 1e-6 * V)) return; // of no direction: that of the first cell
    for (int i = 0; i < 3; i++) sum[0][i] /= length;
    double along = dot3(sum[0], sum[1]);
    for (int i = 0; i < 3; i++) sum[1][i] -= along * sum[0][i];
    length = norm3(sum[1]);
    if (!(length > 1e-6 * V)) return;
    for (int i = 0; i < 3; i++) {
        Q[i] = sum[0][i];
        Q[3 + i] = sum[1][i] / length;
    }
    cross3(Q, Q + 3, Q + 6);
}

sn_status sn_net_build_turns(sn_net *net) {
    const bool edges = net->rung == SN_RUNG_SMOOTHED;
    if (!net->cell_axes) return SN_OK;
    const size_t slots = (size_t)(edges ? net->edge_blocks : net->cell_blocks) * SN_BLOCK;
    static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    int *cell_of = sn_alloc((size_t)net->cell_blocks * SN_BLOCK, sizeof *cell_of);
    double *turn = net->data[SN_DOUBLE].turn = sn_alloc(slots * 9, sizeof *turn);
    if (!cell_of || !turn) {
        sn_free(cell_of);
        return SN_E_MEMORY;
    }
    for (size_t s = 0; s < slots; s++) set_turn(net, (int)s, unit);
    for (int e = 0; e < net->cells; e++) {
        cell_of[net->cell_slot[e]] = e;
        if (!edges) set_turn(net, net->cell_slot[e], net->cell_axes + 9 * (size_t)e);
    }
    for (size_t s = 0; s < slots && edges; s++) {
        double Q[9];
        if (net->edge_start[s + 1] == net->edge_start[s]) continue;
        mean_axes(net, cell_of, (int)s, Q);
        set_turn(net, (int)s, Q);
    }
    sn_free(cell_of);
    return SN_OK;
}

//---- the law -------------------------------------------------------------------------------------

// A: s = A s_m
static void stress_turn(const double Q[9], double A[6][6]) {
    for (int k = 0; k < 6; k++)
        for (int l = 0; l < 6; l++) {
            const int a = pair[k][0], b = pair[k][1], i = pair[l][0], j = pair[l][1];
            A[k][l] = Q[3 * i + a] * Q[3 * j + b];
            if (i != j) A[k][l] += Q[3 * j + a] * Q[3 * i + b];
        }
}

// Numbers of place i of n: D <- A D A^T
static void turn_tangent(double A[6][6], int n, double *D) {
    double full[6][6], half[6][6];
    for (int i = 0, k = 0; i < 6; i++)
        for (int j = i; j < 6; j++, k++) full[i][j] = full[j][i] = D[k * n];
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            half[i][j] = 0;
            for (int k = 0; k < 6; k++) half[i][j] += A[i][k] * full[k][j];
        }
    for (int i = 0, k = 0; i < 6; i++)
        for (int j = i; j < 6; j++, k++) {
            double sum = 0;
            for (int l = 0; l < 6; l++) sum += half[i][l] * A[j][l];
            D[k * n] = sum;
        }
}

static void turn_strain(double A[6][6], int n, const double *E, double *out) {
    for (int l = 0; l < 6; l++) {
        double sum = 0;
        for (int k = 0; k < 6; k++) sum += (k < 3 ? 1.0 : 2.0) * A[k][l] * E[k * n];
        out[l * n] = l < 3 ? sum : 0.5 * sum;
    }
}

static void turn_stress(double A[6][6], int n, double *S) {
    double s[6];
    for (int l = 0; l < 6; l++) s[l] = S[l * n];
    for (int k = 0; k < 6; k++) {
        S[k * n] = 0;
        for (int l = 0; l < 6; l++) S[k * n] += A[k][l] * s[l];
    }
}

void sn_net_law(const sn_net *net, const sn_tissue *tissue, int slot, int n, const double *E,
                double *W, double *S, double *D) {
    const bool turned = net->data[SN_DOUBLE].turn && tissue->law->fibres;
    double A[6][6], Q[9], material[6 * SN_BLOCK];
    SN_ASSERT(n <= SN_BLOCK);
    for (int i = 0; i < n && turned; i++) {
        get_turn(net, slot + i, Q);
        stress_turn(Q, A);
        turn_strain(A, n, E + i, material + i);
    }
    sn_law_solid(tissue->law, tissue->value, tissue->terms, n, turned ? material : E, W, S, D);
    for (int i = 0; i < n && turned; i++) {
        get_turn(net, slot + i, Q);
        stress_turn(Q, A);
        turn_stress(A, n, S + i);
        if (D) turn_tangent(A, n, D + i);
    }
}
