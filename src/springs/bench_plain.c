// A step as one would write it first: one item after the other, in numbers of single precision,
// reading nodes by their index and adding forces to them.
// SPDX-License-Identifier: Apache-2.0
//
// Source: the formulas of springs/kernels, without blocks, tiles, stars, fans and lanes. Items and
// nodes stand along the curve of springs/order.c, which a first version would not have either.
#include "springs/bench_plain.h"
#include "springs/forces.h"

#include <math.h>
#include <string.h>

typedef struct plain_spring {
    int a, b;
    float D[3], inverse, stiffness;
} plain_spring;

typedef struct plain_cell {
    int node[4], edge[6];
    float g[9], V;
} plain_cell;

struct sn_plain {
    int nodes, springs, cells, edges, branches;
    bool coupled, smoothed, volume;
    float B, shear, stiffening, bulk, g_inf, step;
    float decay[SN_BRANCHES_MAX], gain[SN_BRANCHES_MAX];
    plain_spring *spring;
    plain_cell *cell;
    float *edge;      ///< smoothed: deformation gradient, then stress, and volume (edges x 10)
    float *memory;    ///< T before, then the branches, of every item and component
    float *u, *v, *f; ///< (nodes x 3)
    float *inverse_mass, *around, *growth; ///< (nodes)
};

static float remember(const sn_plain *p, float *before, float T) {
    float sum = p->g_inf * T, change = T - before[0];
    if (p->branches == 0) return T;
    before[0] = T;
    for (int k = 0; k < p->branches; k++) {
        before[1 + k] = p->decay[k] * before[1 + k] + p->gain[k] * change;
        sum += before[1 + k];
    }
    return sum;
}

static void pull(sn_plain *p) {
    for (int s = 0; s < p->springs; s++) {
        const plain_spring *q = &p->spring[s];
        float d[3], e = 0;
        for (int k = 0; k < 3; k++) {
            d[k] = p->u[3 * q->b + k] - p->u[3 * q->a + k];
            e += (2 * q->D[k] + d[k]) * d[k];
        }
        float lambda = sqrtf(1 + e * q->inverse), x = e * q->inverse / (1 + lambda);
        float T = x < 0 ? (lambda - 1 / (lambda * lambda)) / 3 : (expf(p->B * x) - 1) / p->B;
        T = remember(p, p->memory + s * (1 + p->branches), T);
        for (int k = 0; k < 3; k++) {
            float f = q->stiffness * T / lambda * (q->D[k] + d[k]);
            p->f[3 * q->a + k] += f;
            p->f[3 * q->b + k] -= f;
        }
    }
}

static void deform(const sn_plain *p, const plain_cell *c, float F[9]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            F[3 * i + j] = i == j;
            for (int a = 0; a < 3; a++)
                F[3 * i + j] +=
                    (p->u[3 * c->node[a + 1] + i] - p->u[3 * c->node[0] + i]) * c->g[3 * a + j];
        }
}

static float volume_ratio(const float F[9], float cofactor[9]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            cofactor[3 * i + j] = F[3 * a + c] * F[3 * b + d] - F[3 * a + d] * F[3 * b + c];
        }
    return F[0] * cofactor[0] + F[1] * cofactor[1] + F[2] * cofactor[2];
}

static void grow(sn_plain *p) {
    memset(p->growth, 0, (size_t)p->nodes * sizeof *p->growth);
    for (int e = 0; e < p->cells; e++) {
        const plain_cell *c = &p->cell[e];
        float F[9], cofactor[9];
        deform(p, c, F);
        float change = 0.25f * c->V * (volume_ratio(F, cofactor) - 1);
        for (int a = 0; a < 4; a++) p->growth[c->node[a]] += change;
    }
}

// isochoric stress S with memory, times F, added to P
static void add_law(sn_plain *p, const float F[9], float J, const float cofactor[9], float *memory,
                    float P[9]) {
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    float S[6], trace = 0, scale = 1 / cbrtf(J * J);
    for (int k = 0; k < 9; k++) trace += F[k] * F[k];
    float w = p->shear * scale;
    if (p->stiffening > 0) w *= expf(p->stiffening * (scale * trace - 3));
    for (int k = 0; k < 6; k++) {
        const int i = pair[k][0], j = pair[k][1];
        float inverse = 0; // of C
        for (int a = 0; a < 3; a++) inverse += cofactor[3 * a + i] * cofactor[3 * a + j];
        S[k] = w * ((i == j) - trace / 3 * inverse / (J * J));
        S[k] = remember(p, memory + k * (1 + p->branches), S[k]);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) P[3 * i + j] += F[3 * i + k] * S[sym[k][j]];
}

// deformation of the edges, then their stress
static void smooth(sn_plain *p) {
    memset(p->edge, 0, (size_t)p->edges * 10 * sizeof *p->edge);
    for (int e = 0; e < p->cells; e++) {
        const plain_cell *c = &p->cell[e];
        float F[9];
        deform(p, c, F);
        for (int k = 0; k < 6; k++) {
            float *to = p->edge + 10 * c->edge[k];
            for (int i = 0; i < 9; i++) to[i] += c->V / 6 * F[i];
            to[9] += c->V / 6;
        }
    }
    for (int e = 0; e < p->edges; e++) {
        float F[9], P[9], cofactor[9], *to = p->edge + 10 * e;
        if (!(to[9] > 0)) continue; // filling
        for (int k = 0; k < 9; k++) F[k] = to[k] / to[9];
        float J = volume_ratio(F, cofactor);
        for (int k = 0; k < 9; k++) P[k] = p->volume ? 0 : p->bulk * (J - 1) * cofactor[k];
        add_law(p, F, J, cofactor, p->memory + e * 6 * (1 + p->branches), P);
        memcpy(to, P, sizeof P);
    }
}

static void press(sn_plain *p) {
    for (int e = 0; e < p->cells; e++) {
        const plain_cell *c = &p->cell[e];
        float F[9], cofactor[9], P[9], pressure = 0;
        deform(p, c, F);
        float J = volume_ratio(F, cofactor);
        if (p->volume)
            for (int a = 0; a < 4; a++) pressure += 0.25f * p->growth[c->node[a]];
        else
            pressure = p->smoothed ? 0 : p->bulk * (J - 1);
        for (int k = 0; k < 9; k++) P[k] = pressure * cofactor[k];
        if (p->coupled) add_law(p, F, J, cofactor, p->memory + e * 6 * (1 + p->branches), P);
        for (int k = 0; k < 6 && p->smoothed; k++)
            for (int i = 0; i < 9; i++) P[i] += p->edge[10 * c->edge[k] + i] / 6;
        for (int a = 0; a < 3; a++)
            for (int i = 0; i < 3; i++) {
                float f = 0;
                for (int j = 0; j < 3; j++) f -= c->V * P[3 * i + j] * c->g[3 * a + j];
                p->f[3 * c->node[a + 1] + i] += f;
                p->f[3 * c->node[0] + i] -= f;
            }
    }
}

void sn_plain_step(sn_plain *p) {
    memset(p->f, 0, (size_t)p->nodes * 3 * sizeof *p->f);
    if (p->volume) {
        grow(p);
        for (int i = 0; i < p->nodes; i++) p->growth[i] *= p->bulk / p->around[i];
    }
    if (p->smoothed) smooth(p);
    pull(p);
    if (p->coupled || p->smoothed || p->volume) press(p);
    for (int k = 0; k < 3 * p->nodes; k++) {
        p->v[k] += p->step * p->f[k] * p->inverse_mass[k / 3];
        p->u[k] += p->step * p->v[k];
    }
    p->step = -p->step; // there and back
}

//---- building ------------------------------------------------------------------------------------

static void copy_springs(const sn_net *net, sn_plain *p) {
    const sn_net_data *data = &net->data[SN_DOUBLE];
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        const double *stiffness = data->stiffness, *inverse = data->inverse, *edge = data->edge;
        const int block = s / SN_BLOCK, lane = s % SN_BLOCK;
        if (!(stiffness[s] > 0)) continue;
        plain_spring *q = &p->spring[p->springs++];
        q->a = net->spring_end[block * 2 * SN_BLOCK + lane];
        q->b = net->spring_end[(block * 2 + 1) * SN_BLOCK + lane];
        q->inverse = (float)inverse[s];
        q->stiffness = (float)stiffness[s];
        for (int d = 0; d < 3; d++) q->D[d] = (float)edge[(block * 3 + d) * SN_BLOCK + lane];
    }
}

static void copy_cells(const sn_net *net, sn_plain *p) {
    const sn_net_data *data = &net->data[SN_DOUBLE];
    for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) {
        const double *volume = data->volume, *gradient = data->gradient;
        const int block = s / SN_BLOCK, lane = s % SN_BLOCK;
        if (!(volume[s] > 0)) continue;
        plain_cell *c = &p->cell[p->cells++];
        c->V = (float)volume[s];
        for (int a = 0; a < 4; a++) {
            c->node[a] = net->cell_node[(block * 4 + a) * SN_BLOCK + lane];
            p->around[c->node[a]] += 0.25f * c->V;
        }
        for (int k = 0; k < 6 && p->smoothed; k++)
            c->edge[k] = net->cell_edge[(block * 6 + k) * SN_BLOCK + lane];
        for (int k = 0; k < 9; k++) c->g[k] = (float)gradient[(block * 9 + k) * SN_BLOCK + lane];
    }
}

static void set_numbers(const sn_net *net, sn_plain *p) {
    const sn_net_region *g = &net->region[0];
    sn_recursion factors;
    p->nodes = net->nodes;
    p->coupled = net->rung == SN_RUNG_COUPLED;
    p->smoothed = net->rung == SN_RUNG_SMOOTHED;
    p->edges = net->edge_blocks * SN_BLOCK;
    p->volume = net->volume;
    p->branches = g->branches;
    p->B = (float)g->exponent;
    p->shear = (float)g->shear;
    p->stiffening = strcmp(g->tissue.law->name, "demiray") == 0 ? 2 : 0;
    p->bulk = (float)g->bulk;
    p->g_inf = (float)g->memory.g_inf;
    p->step = (float)(1e-3 * net->step);
    sn_exponentials_factors(&g->memory, net->step, factors.decay, factors.gain);
    for (int k = 0; k < g->branches; k++) {
        p->decay[k] = (float)factors.decay[k];
        p->gain[k] = (float)factors.gain[k];
    }
}

sn_status sn_plain_create(const sn_net *net, sn_plain **plain) {
    SN_ASSERT(net->region_count == 1);
    sn_plain *p = *plain = sn_alloc(1, sizeof *p);
    if (!p) return SN_E_MEMORY;
    const size_t nodes = (size_t)net->nodes, terms = 1 + (size_t)net->region[0].branches;
    const size_t items = (size_t)(net->rung == SN_RUNG_COUPLED    ? 6 * net->cells
                                  : net->rung == SN_RUNG_SMOOTHED ? 6 * net->edge_blocks * SN_BLOCK
                                                                  : net->springs);
    set_numbers(net, p);
    p->edge = sn_alloc((size_t)p->edges * 10, sizeof *p->edge);
    p->spring = sn_alloc((size_t)net->springs, sizeof *p->spring);
    p->cell = sn_alloc((size_t)net->cells, sizeof *p->cell);
    p->memory = sn_alloc(items * terms, sizeof *p->memory);
    p->u = sn_alloc(nodes * 3, sizeof *p->u);
    p->v = sn_alloc(nodes * 3, sizeof *p->v);
    p->f = sn_alloc(nodes * 3, sizeof *p->f);
    p->inverse_mass = sn_alloc(nodes, sizeof *p->inverse_mass);
    p->around = sn_alloc(nodes, sizeof *p->around);
    p->growth = sn_alloc(nodes, sizeof *p->growth);
    if (!p->edge || !p->spring || !p->cell || !p->memory || !p->u || !p->v || !p->f ||
        !p->inverse_mass || !p->around || !p->growth) {
        sn_plain_destroy(p);
        *plain = NULL;
        return SN_E_MEMORY;
    }
    copy_springs(net, p);
    copy_cells(net, p);
    for (int i = 0; i < net->nodes; i++) p->inverse_mass[i] = (float)(1 / net->mass[i]);
    unsigned seed = 1;
    for (int k = 0; k < 3 * net->nodes; k++) {
        seed = seed * 1664525u + 1013904223u;
        p->u[k] = (float)(0.02 * net->edge * ((double)(seed >> 8) / 8388608.0 - 1));
    }
    return SN_OK;
}

void sn_plain_destroy(sn_plain *p) {
    if (!p) return;
    void *all[] = {p->spring, p->cell,         p->memory, p->u,      p->v,
                   p->f,      p->inverse_mass, p->around, p->growth, p->edge};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_free(p);
}
