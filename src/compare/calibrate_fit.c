// Springs by nonnegative least squares on nodal forces.
// SPDX-License-Identifier: Apache-2.0
// Source: the conditions are derived here; the solver is sequential coordinate-wise descent, Franc,
// Hlavac, Navara, CAIP 2005 (LNCS 3691) 407-414.
//
// Springs act like an isotropic continuum where the displacement that it would have leaves every
// node in balance. Near a node take that as E xi and as quadratic terms, xi = x - x_a. Springs of
// stiffness k, length L and direction n (away from the node) answer with the forces
//     f_i = -(sum k L n_i n_j n_k) E_jk              for u_j = E_jk xi_k,
//     f_i = -(sum k L^2 n_i n_k n_j n_l)             for u_k = xi_j xi_l,
// the continuum of a tensor K that is symmetric in all indices (lambda = mu where it is isotropic),
// by the shape function N of the node, with
//     f_i = K_ijkm A_m E_jk,                         A_m = integral of dN/dx_m,
//     f_i = K_imkj T_ml + K_imkl T_mj,               T_ml = integral of dN/dx_m xi_l.
// Inside, A = 0 and T = -V_a d: moments of third order must vanish, those of fourth order be those
// of K. At the surface A and T are the consistent tractions. What springs do is symmetric in
// all indices, so that only the symmetric part of a target can be met: 10 + 15 numbers a node. The
// fourth moments of all nodes add up to the elastic tensor of the net.
//
// Edges alone leave half of the forces at the surface unmet. Second neighbours, nodes with a
// neighbour in common, meet most of them. Each costs a little, so that few are kept.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/calibrate.h"

enum { THIRD = 10, FOURTH = 15, MOMENTS = THIRD + FOURTH, SWEEPS = 500 };
static const double weight[2] = {0.5, 1.0}; // of third and fourth moments
static const double cost = 0.05;            // of a second neighbour, for a column of norm 1 and
                                            // the tensor of a shear modulus of 1
static const double reach = 2.0;            // longest second neighbour, of the mean edge
static const double settled = 1e-5;         // gain of a sweep, relative

// components of totally symmetric tensors: powers of x y z, and how often each stands in the tensor
static const int power[MOMENTS][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {2, 1, 0}, {2, 0, 1},
                                      {1, 2, 0}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}, {1, 1, 1},
                                      {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {3, 1, 0}, {3, 0, 1},
                                      {1, 3, 0}, {0, 3, 1}, {1, 0, 3}, {0, 1, 3}, {2, 2, 0},
                                      {2, 0, 2}, {0, 2, 2}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
static const double often[MOMENTS] = {1, 1, 1, 3, 3, 3, 3, 3, 3, 6,  1,  1, 1,
                                      4, 4, 4, 4, 4, 4, 6, 6, 6, 12, 12, 12};

/// A possible spring as a column of the system.
typedef struct column {
    int end[2];
    float product[MOMENTS];     // of its direction, seen from end 0
    double third[2], fourth[2]; // factors of the products at the ends
    double unit;                // stiffness where x is 1
    double x;
    bool edge;
} column;

typedef struct fit {
    const sn_mesh *mesh;
    int count;
    column *spring;
    double *size;     // cube root of the volume of each node       (nodes)
    double *residual; // weighted                                   (nodes x MOMENTS)
} fit;

//---- candidates ----------------------------------------------------------------------------------

static double distance(const sn_mesh *mesh, int a, int b) {
    double sum = 0;
    for (int d = 0; d < 3; d++) {
        double D = mesh->node[3 * b + d] - mesh->node[3 * a + d];
        sum += D * D;
    }
    return sqrt(sum);
}

/// Nodes joined to each node by edges.
typedef struct neighbours {
    int *start, *node; ///< (nodes + 2), (2 edges)
    int *mark;         ///< the last node that met each          (nodes)
} neighbours;

static sn_status list_neighbours(int nodes, const int *edge, int edges, neighbours *n) {
    n->start = sn_alloc((size_t)nodes + 2, sizeof *n->start);
    n->node = sn_alloc((size_t)edges * 2, sizeof *n->node);
    n->mark = sn_alloc((size_t)nodes, sizeof *n->mark);
    if (!n->start || !n->node || !n->mark) return SN_E_MEMORY;
    for (int k = 0; k < 2 * edges; k++) n->start[edge[k] + 2]++;
    for (int i = 0; i < nodes; i++) n->start[i + 2] += n->start[i + 1];
    for (int k = 0; k < 2 * edges; k++) n->node[n->start[edge[k] + 1]++] = edge[k ^ 1];
    for (int i = 0; i < nodes; i++) n->mark[i] = -1;
    return SN_OK;
}

// Appends the second neighbours of node a behind it; counts them only where `spring` is NULL.
static int add_second(const fit *f, const neighbours *n, int a, double longest, column *spring) {
    int count = 0;
    n->mark[a] = a;
    for (int p = n->start[a]; p < n->start[a + 1]; p++) n->mark[n->node[p]] = a;
    for (int p = n->start[a]; p < n->start[a + 1]; p++)
        for (int q = n->start[n->node[p]]; q < n->start[n->node[p] + 1]; q++) {
            const int b = n->node[q];
            if (n->mark[b] == a) continue;
            n->mark[b] = a;
            if (b < a || distance(f->mesh, a, b) > longest) continue;
            if (spring) spring[count] = (column){.end = {a, b}};
            count++;
        }
    return count;
}

static sn_status find_candidates(fit *f) {
    const int nodes = f->mesh->node_count;
    neighbours n = {0};
    int *edge = NULL, edges = 0, second = 0;
    double mean = 0;
    sn_status status;
    SN_TRY_GOTO(status, sn_mesh_edges(f->mesh, &edge, &edges));
    SN_TRY_GOTO(status, list_neighbours(nodes, edge, edges, &n));
    for (int k = 0; k < edges; k++) mean += distance(f->mesh, edge[2 * k], edge[2 * k + 1]) / edges;
    for (int a = 0; a < nodes; a++) second += add_second(f, &n, a, reach * mean, NULL);
    for (int i = 0; i < nodes; i++) n.mark[i] = -1;
    f->spring = sn_alloc((size_t)edges + (size_t)second, sizeof *f->spring);
    status = f->spring ? SN_OK : SN_E_MEMORY;
    for (int k = 0; k < edges && f->spring; k++)
        f->spring[f->count++] = (column){.end = {edge[2 * k], edge[2 * k + 1]}, .edge = true};
    for (int a = 0; a < nodes && f->spring; a++)
        f->count += add_second(f, &n, a, reach * mean, f->spring + f->count);
fail:
    sn_free(edge);
    sn_free(n.start);
    sn_free(n.node);
    sn_free(n.mark);
    return status;
}

//---- the system ----------------------------------------------------------------------------------

static void set_column(const fit *f, column *c) {
    const double L = distance(f->mesh, c->end[0], c->end[1]);
    double n[3], sum = 0;
    for (int d = 0; d < 3; d++)
        n[d] = (f->mesh->node[3 * c->end[1] + d] - f->mesh->node[3 * c->end[0] + d]) / L;
    for (int m = 0; m < MOMENTS; m++) {
        double product = 1;
        for (int d = 0; d < 3; d++)
            for (int k = 0; k < power[m][d]; k++) product *= n[d];
        c->product[m] = (float)product;
    }
    for (int e = 0; e < 2; e++) {
        const double h = f->size[c->end[e]];
        c->third[e] = (e ? -weight[0] : weight[0]) * L / (h * h);
        c->fourth[e] = weight[1] * L * L / (h * h * h);
        sum += c->third[e] * c->third[e] + c->fourth[e] * c->fourth[e];
    }
    c->unit = 1 / sqrt(sum); // sums of often product^2 are powers of n.n
    for (int e = 0; e < 2; e++) {
        c->third[e] *= c->unit;
        c->fourth[e] *= c->unit;
    }
}

// moments of the continuum at a node, from A and the symmetric part S of T
static void node_target(double K[3][3][3][3], const double A[3], double S[3][3], double *t) {
    for (int m = 0; m < MOMENTS; m++) {
        int i[4], n = 0, order = m < THIRD ? 3 : 4;
        double sum = 0;
        for (int d = 0; d < 3; d++)
            for (int k = 0; k < power[m][d]; k++) i[n++] = d;
        for (int l = 0; l < 3; l++) {
            if (order == 3) sum += K[i[0]][i[1]][i[2]][l] * A[l];
            for (int p = 0; p < 4 && order == 4; p++)
                sum += 0.5 * S[l][i[p]] * K[i[(p + 1) % 4]][i[(p + 2) % 4]][i[(p + 3) % 4]][l];
        }
        t[m] = -sum;
    }
}

// V grad N of corner a of a cell
static void corner_area(const sn_mesh *mesh, const int *node, int a, double g[3]) {
    const double *x = mesh->node + 3 * node[a], *p = mesh->node + 3 * node[(a + 1) % 4];
    const double *q = mesh->node + 3 * node[(a + 2) % 4], *r = mesh->node + 3 * node[(a + 3) % 4];
    double out = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, l = (i + 2) % 3;
        g[i] = ((q[j] - p[j]) * (r[l] - p[l]) - (q[l] - p[l]) * (r[j] - p[j])) / 6;
        out += g[i] * (x[i] - p[i]);
    }
    for (int i = 0; i < 3 && out < 0; i++) g[i] = -g[i];
}

// sums: A, T, V of each node
static void add_cell(const sn_mesh *mesh, int e, double *sums) {
    const int *node = mesh->cell + 4 * (size_t)e;
    double middle[3] = {0};
    for (int a = 0; a < 4; a++)
        for (int d = 0; d < 3; d++) middle[d] += 0.25 * mesh->node[3 * node[a] + d];
    for (int a = 0; a < 4; a++) {
        double g[3], *to = sums + 13 * (size_t)node[a];
        corner_area(mesh, node, a, g);
        for (int i = 0; i < 3; i++) {
            to[i] += g[i];
            for (int l = 0; l < 3; l++)
                to[3 + 3 * i + l] += g[i] * (middle[l] - mesh->node[3 * node[a] + l]);
        }
        to[12] += 0.25 * sn_mesh_cell_volume(mesh, e);
    }
}

static sn_status set_system(fit *f, double K[3][3][3][3]) {
    const size_t nodes = (size_t)f->mesh->node_count;
    double *sums = sn_alloc(nodes * 13, sizeof *sums);
    f->size = sn_alloc(nodes, sizeof *f->size);
    f->residual = sn_alloc(nodes * MOMENTS, sizeof *f->residual);
    if (!sums || !f->size || !f->residual) {
        sn_free(sums);
        return SN_E_MEMORY;
    }
    for (int e = 0; e < f->mesh->cell_count; e++) add_cell(f->mesh, e, sums);
    for (size_t a = 0; a < nodes; a++) {
        double S[3][3], *t = f->residual + MOMENTS * a;
        const double *A = sums + 13 * a, *T = A + 3, h = f->size[a] = cbrt(A[12]);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) S[i][j] = 0.5 * (T[3 * i + j] + T[3 * j + i]);
        node_target(K, A, S, t);
        for (int m = 0; m < MOMENTS; m++)
            t[m] *= m < THIRD ? weight[0] / (h * h) : weight[1] / (h * h * h);
    }
    sn_free(sums);
    for (int k = 0; k < f->count; k++) set_column(f, &f->spring[k]);
    return SN_OK;
}

//---- the solution --------------------------------------------------------------------------------

static double column_dot(const fit *f, const column *c) {
    double sum = 0;
    for (int e = 0; e < 2; e++) {
        const double *r = f->residual + MOMENTS * (size_t)c->end[e];
        double third = 0, fourth = 0;
        for (int m = 0; m < THIRD; m++) third += often[m] * r[m] * (double)c->product[m];
        for (int m = THIRD; m < MOMENTS; m++) fourth += often[m] * r[m] * (double)c->product[m];
        sum += c->third[e] * third + c->fourth[e] * fourth;
    }
    return sum;
}

static void move(fit *f, column *c, double step) {
    for (int e = 0; e < 2; e++) {
        double *r = f->residual + MOMENTS * (size_t)c->end[e];
        for (int m = 0; m < MOMENTS; m++)
            r[m] -= step * (m < THIRD ? c->third[e] : c->fourth[e]) * (double)c->product[m];
    }
    c->x += step;
}

// squares of the third and of the fourth moments that are left
static void left_over(const fit *f, double part[2]) {
    part[0] = part[1] = 0;
    for (size_t a = 0; a < (size_t)f->mesh->node_count; a++)
        for (int m = 0; m < MOMENTS; m++) {
            const double r = f->residual[MOMENTS * a + (size_t)m];
            part[m >= THIRD] += often[m] * r * r;
        }
}

static void descend(fit *f) {
    double part[2];
    left_over(f, part);
    double value = 0.5 * (part[0] + part[1]);
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double gain = 0;
        for (int k = 0; k < f->count; k++) {
            column *c = &f->spring[k];
            const double slope = (c->edge ? 0.0 : cost) - column_dot(f, c);
            const double step = fmax(-slope, -c->x);
            if (step == 0) continue;
            gain -= step * (slope + 0.5 * step);
            move(f, c, step);
        }
        value -= gain;
        if (gain < settled * value) break;
    }
}

sn_status sn_calibration_fit(const sn_mesh *mesh, double K[3][3][3][3], sn_spring_set **set,
                             double left[2]) {
    fit f = {.mesh = mesh};
    double before[2], after[2];
    int count = 0;
    *set = NULL;
    sn_status status = find_candidates(&f);
    if (status == SN_OK) status = set_system(&f, K);
    if (status != SN_OK) goto fail;
    left_over(&f, before);
    descend(&f);
    left_over(&f, after);
    for (int k = 0; k < 2; k++) left[k] = sqrt(after[k] / before[k]);
    for (int k = 0; k < f.count; k++) count += f.spring[k].x > 0;
    SN_TRY_GOTO(status, sn_spring_set_create(count, 1, set));
    count = 0;
    for (int k = 0; k < f.count; k++) {
        const column *c = &f.spring[k];
        if (!(c->x > 0)) continue;
        memcpy((*set)->end + 2 * (size_t)count, c->end, sizeof c->end);
        (*set)->stiffness[count++] = c->x * c->unit;
    }
fail:
    sn_free(f.spring);
    sn_free(f.size);
    sn_free(f.residual);
    return status;
}
