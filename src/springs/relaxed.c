// The common scale of the springs of an irregular net.
// SPDX-License-Identifier: Apache-2.0
//
// Springs of an even net would answer an even strain without moving their nodes in any other way;
// those of an irregular one relax, and the net is softer by a factor that is nearly common to all
// deformations. One virtual test finds it: the surface moves with an even strain of constant volume
// that has stretch and shear in all directions, the nodes inside find equilibrium by conjugate
// gradients, and the springs are scaled so that their energy is 2 mu E:E V.
#include <math.h>
#include <string.h>

#include "springs/net.h"
#include "springs/vectors.h"

enum { TURNS = 300 };
static const double solved = 1e-2; // of the residual; the energy is right to its square
static const double strain[3][3] = {{1.0, 0.6, -0.4}, {0.6, -0.3, 0.8}, {-0.4, 0.8, -0.7}};

typedef struct relaxation {
    const sn_spring *spring;
    int count;
    size_t n; // 3 nodes
    double *diagonal, *u, *r, *z, *p, *q;
    unsigned char *held; // nodes of the surface
} relaxation;

// V grad N of the corners of a cell, summed: zero inside, the outward area at the surface
static void mark_surface(const sn_mesh *mesh, int region, relaxation *v) {
    double *area = v->q, size = 0;
    for (int e = 0; e < mesh->cell_count; e++)
        for (int a = 0; a < 4 && mesh->region[e] == region; a++) {
            const int *node = mesh->cell + 4 * (size_t)e;
            const double *x = mesh->node + 3 * node[a];
            double d[3][3], g[3], out = 0;
            for (int k = 0; k < 3; k++)
                for (int i = 0; i < 3; i++)
                    d[k][i] = mesh->node[3 * node[(a + 1 + k) % 4] + i] - x[i];
            for (int i = 0; i < 3; i++) {
                const int j = (i + 1) % 3, l = (i + 2) % 3;
                g[i] = (d[1][j] - d[0][j]) * (d[2][l] - d[0][l]) -
                       (d[1][l] - d[0][l]) * (d[2][j] - d[0][j]);
                out -= g[i] * d[0][i];
            }
            for (int i = 0; i < 3; i++) {
                area[3 * node[a] + i] += out < 0 ? -g[i] : g[i];
                size = fmax(size, fabs(g[i]));
            }
        }
    for (size_t i = 0; i < v->n; i++) v->held[i / 3] |= fabs(area[i]) > 1e-9 * size;
}

static void multiply(const relaxation *v, const double *x, double *y) {
    memset(y, 0, v->n * sizeof *y);
    for (int k = 0; k < v->count; k++) {
        const sn_spring *s = &v->spring[k];
        const double *a = x + 3 * (size_t)s->end[0], *b = x + 3 * (size_t)s->end[1];
        double along = 0;
        for (int d = 0; d < 3; d++) along += s->edge[d] * (b[d] - a[d]);
        along *= s->stiffness / s->length2;
        for (int d = 0; d < 3; d++) {
            y[3 * (size_t)s->end[0] + (size_t)d] -= along * s->edge[d];
            y[3 * (size_t)s->end[1] + (size_t)d] += along * s->edge[d];
        }
    }
}

static void precondition(const relaxation *v) {
    for (size_t i = 0; i < v->n; i++)
        v->z[i] = v->held[i / 3] || !(v->diagonal[i] > 0) ? 0.0 : v->r[i] / v->diagonal[i];
}

// u <- what balances the forces r of the nodes inside; returns the energy that it sets free, twice
static double relax(relaxation *v) {
    const size_t n = v->n;
    double freed = 0;
    precondition(v);
    memcpy(v->p, v->z, n * sizeof *v->p);
    double rz = sn_dot(v->r, v->z, n);
    const double target = solved * solved * rz;
    for (int turn = 0; turn < TURNS && rz > target && rz > 0; turn++) {
        multiply(v, v->p, v->q);
        for (size_t i = 0; i < n; i++) v->q[i] = v->held[i / 3] ? 0.0 : v->q[i];
        const double pq = sn_dot(v->p, v->q, n);
        if (!(pq > 0)) break;
        const double a = rz / pq;
        freed += a * rz;
        for (size_t i = 0; i < n; i++) v->r[i] -= a * v->q[i];
        precondition(v);
        const double next = sn_dot(v->r, v->z, n);
        for (size_t i = 0; i < n; i++) v->p[i] = v->z[i] + next / rz * v->p[i];
        rz = next;
    }
    return freed;
}

static double strain_energy(relaxation *v, const double *position) {
    for (size_t i = 0; i < v->n; i++) {
        v->u[i] = 0;
        for (size_t k = 0; k < 3; k++) v->u[i] += strain[i % 3][k] * position[i / 3 * 3 + k];
    }
    multiply(v, v->u, v->r);
    const double even = sn_dot(v->u, v->r, v->n);
    for (size_t i = 0; i < v->n; i++) v->r[i] = v->held[i / 3] ? 0.0 : -v->r[i];
    return even - relax(v);
}

sn_status sn_net_relaxed_scale(const sn_mesh *mesh, int region, const sn_spring *spring, int count,
                               double *scale) {
    relaxation v = {.spring = spring, .count = count, .n = (size_t)mesh->node_count * 3};
    double *all = sn_alloc(v.n * 6, sizeof *all), squares = 0, volume = 0;
    v.held = sn_alloc((size_t)mesh->node_count, 1);
    if (!all || !v.held) {
        sn_free(all);
        sn_free(v.held);
        return SN_E_MEMORY;
    }
    double **const part[] = {&v.diagonal, &v.u, &v.r, &v.z, &v.p, &v.q};
    for (size_t k = 0; k < 6; k++) *part[k] = all + k * v.n;
    mark_surface(mesh, region, &v);
    for (int k = 0; k < count; k++)
        for (size_t i = 0; i < 6; i++)
            v.diagonal[3 * (size_t)spring[k].end[i / 3] + i % 3] +=
                spring[k].stiffness * spring[k].edge[i % 3] * spring[k].edge[i % 3] /
                spring[k].length2;
    for (int e = 0; e < mesh->cell_count; e++)
        if (mesh->region[e] == region) volume += sn_mesh_cell_volume(mesh, e);
    for (int i = 0; i < 9; i++) squares += strain[i / 3][i % 3] * strain[i / 3][i % 3];
    *scale = 2.0 * squares * volume / strain_energy(&v, mesh->node);
    sn_free(all);
    sn_free(v.held);
    return SN_OK;
}
