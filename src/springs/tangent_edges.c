// The derivative of the nodal forces of smoothed edges.
// SPDX-License-Identifier: Apache-2.0
//
// An edge with the cells around it, its cluster, is an element with one strain,
//     F_e = Q^T + sum over the nodes a of the cluster of u_a G_a,
//     G_a = sum over the cells around e that have node a of V_c g_a / sum of V_c,
// so its stiffness is V_e (B^T D B + G.S G), and V_e (K c_a c_b + p (c_a c_b - c_b c_a) / J) with
// c_a = cof F_e G_a where edges have the volume stress too: the formulas of a cell, with more
// nodes.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "springs/parts.h"
#include "springs/tangent.h"

/// Deformation of the cluster of one edge, and scratch for its stiffness.
struct sn_cluster {
    int nodes, most;
    int *node;      ///< (most)
    double (*g)[3]; ///< G
    double (*c)[3]; ///< cof F G
    double (*B)[6][3], (*DB)[6][3];
    double F[9], cofactor[9], J, V;
    double E[6], S[6], D[21]; ///< of the law; D as its upper triangle by rows
};

//---- clusters ------------------------------------------------------------------------------------

// place of a node in the cluster, added where it is new
static int place_of(struct sn_cluster *c, int node) {
    for (int k = 0; k < c->nodes; k++)
        if (c->node[k] == node) return k;
    SN_ASSERT(c->nodes < c->most);
    c->node[c->nodes] = node;
    memset(c->g[c->nodes], 0, sizeof c->g[0]);
    return c->nodes++;
}

// nodes, volume and gradients of the cluster of an edge
static void gather_cluster(const sn_net *net, const sn_parts *parts, int edge,
                           struct sn_cluster *c) {
    const double *gradient = net->data[SN_DOUBLE].gradient;
    const double *volume = sn_parts_volume(net, parts, SN_DOUBLE);
    c->nodes = 0;
    c->V = 0;
    for (int s = net->edge_start[edge]; s < net->edge_start[edge + 1]; s++) {
        const int slot = net->edge_cell[s], block = slot / SN_BLOCK, lane = slot % SN_BLOCK;
        const double V = volume[slot] / 6.0;
        const int first = place_of(c, net->cell_node[block * 4 * SN_BLOCK + lane]);
        c->V += V;
        for (int a = 1; a < 4; a++) {
            const int at = place_of(c, net->cell_node[(block * 4 + a) * SN_BLOCK + lane]);
            for (int k = 0; k < 3; k++) {
                const double g =
                    V * gradient[(size_t)(block * 9 + 3 * (a - 1) + k) * SN_BLOCK + (size_t)lane];
                c->g[at][k] += g;
                c->g[first][k] -= g;
            }
        }
    }
    for (int a = 0; a < c->nodes && c->V > 0; a++)
        for (int k = 0; k < 3; k++) c->g[a][k] /= c->V;
}

static void deform(const sn_net *net, const double *u, struct sn_cluster *c) {
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    double *F = c->F;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            F[3 * i + j] = net->axes[3 * j + i];
            for (int a = 0; a < c->nodes; a++) F[3 * i + j] += u[4 * c->node[a] + i] * c->g[a][j];
        }
    for (int k = 0; k < 6; k++) {
        int i = pair[k][0], j = pair[k][1];
        c->E[k] = 0.5 * (F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j] - (i == j));
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c->cofactor[3 * i + j] =
                F[3 * i1 + j1] * F[3 * i2 + j2] - F[3 * i1 + j2] * F[3 * i2 + j1];
        }
    c->J = F[0] * c->cofactor[0] + F[1] * c->cofactor[1] + F[2] * c->cofactor[2];
    for (int a = 0; a < c->nodes; a++)
        for (int i = 0; i < 3; i++) {
            c->c[a][i] = 0;
            for (int j = 0; j < 3; j++) c->c[a][i] += c->cofactor[3 * i + j] * c->g[a][j];
        }
}

//---- stiffness -----------------------------------------------------------------------------------

static void find_rows(struct sn_cluster *c) {
    double D[6][6];
    for (int i = 0, k = 0; i < 6; i++)
        for (int j = i; j < 6; j++, k++) D[i][j] = D[j][i] = c->D[k];
    for (int a = 0; a < c->nodes; a++) {
        sn_strain_rows(c->F, c->g[a], c->B[a]);
        for (int k = 0; k < 6; k++)
            for (int j = 0; j < 3; j++) {
                c->DB[a][k][j] = 0;
                for (int l = 0; l < 6; l++) c->DB[a][k][j] += D[k][l] * c->B[a][l][j];
            }
    }
}

// S and D as they act now; bulk and p 0 with nodal volume
static void add_stiffness(sn_tangent *t, const struct sn_cluster *c, double bulk, double p) {
    const double *S = c->S;
    for (int a = 0; a < c->nodes; a++)
        for (int b = 0; b < c->nodes; b++) {
            double *to = t->block + 9 * (size_t)sn_sparsity_find(&t->cells, c->node[a], c->node[b]);
            const double *x = c->g[a], *y = c->g[b];
            double geometric = x[0] * (S[0] * y[0] + S[3] * y[1] + S[5] * y[2]) +
                               x[1] * (S[3] * y[0] + S[1] * y[1] + S[4] * y[2]) +
                               x[2] * (S[5] * y[0] + S[4] * y[1] + S[2] * y[2]);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) {
                    double ab = c->c[a][i] * c->c[b][j], ba = c->c[b][i] * c->c[a][j];
                    double sum = bulk * ab + p / c->J * (ab - ba) + (i == j ? geometric : 0.0);
                    for (int k = 0; k < 6; k++) sum += c->B[a][k][i] * c->DB[b][k][j];
                    to[3 * i + j] += c->V * sum;
                }
        }
}

void sn_tangent_add_edges(const sn_net *net, sn_tangent *t, const sn_net_region *region,
                          const sn_tangent_law *law, const sn_tangent_call *call) {
    const bool with_volume = net->volume_mode == SN_VOLUME_CELL;
    struct sn_cluster *c = t->cluster;
    for (int e = region->edge_block * SN_BLOCK;
         e < (region->edge_block + region->edge_blocks) * SN_BLOCK; e++) {
        if (net->edge_filling[e]) continue;
        gather_cluster(net, call->parts, e, c);
        if (!(c->V > 0)) continue;
        deform(net, call->u, c);
        const size_t n = (size_t)(e - region->edge_block * SN_BLOCK);
        sn_tangent_law_at(net, region, law, e, 1, c->E, c->S, c->D);
        double p = 0, bulk = with_volume ? region->bulk : 0.0;
        if (with_volume) p = sn_tangent_pressure(law, n, bulk * (c->J - 1.0));
        find_rows(c);
        add_stiffness(t, c, law->volume.alpha * bulk, p);
    }
}

//---- pattern -------------------------------------------------------------------------------------

// edges whose cluster has each node: start (nodes + 1), item
static sn_status list_clusters(const sn_net *net, struct sn_cluster *c, int **start, int **item) {
    int *from = *start = sn_alloc((size_t)net->nodes + 2, sizeof *from);
    if (!from) return SN_E_MEMORY;
    for (int pass = 0; pass < 2; pass++) {
        for (int e = 0; e < net->edge_blocks * SN_BLOCK; e++) {
            if (net->edge_filling[e]) continue;
            gather_cluster(net, NULL, e, c);
            for (int a = 0; a < c->nodes; a++) {
                if (pass == 0)
                    from[c->node[a] + 2]++;
                else
                    (*item)[from[c->node[a] + 1]++] = e;
            }
        }
        if (pass == 1) break;
        for (int i = 0; i < net->nodes; i++) from[i + 2] += from[i + 1];
        *item = sn_alloc((size_t)from[net->nodes + 1], sizeof **item);
        if (!*item) return SN_E_MEMORY;
    }
    return SN_OK;
}

// nodes that share a cluster with a node, rising, to `row`; returns how many
static int find_row(const sn_net *net, struct sn_cluster *c, const int *edge, int edges, int *seen,
                    int name, int *row) {
    int count = 0;
    for (int k = 0; k < edges; k++) {
        gather_cluster(net, NULL, edge[k], c);
        for (int a = 0; a < c->nodes; a++) {
            if (seen[c->node[a]] == name) continue;
            seen[c->node[a]] = name;
            row[count++] = c->node[a];
        }
    }
    qsort(row, (size_t)count, sizeof *row, compare_int);
    return count;
}

static sn_status create_pattern(const sn_net *net, struct sn_cluster *c, sn_sparsity *p) {
    int *start = NULL, *item = NULL, room = 0;
    int *seen = sn_alloc((size_t)net->nodes, sizeof *seen);
    int *row = sn_alloc((size_t)net->nodes, sizeof *row);
    sn_status status = SN_E_MEMORY;
    p->rows = net->nodes;
    p->start = sn_alloc((size_t)net->nodes + 1, sizeof *p->start);
    if (!seen || !row || !p->start) goto fail;
    SN_TRY_GOTO(status, list_clusters(net, c, &start, &item));
    for (int i = 0; i < net->nodes; i++) {
        const int count =
            find_row(net, c, item + start[i], start[i + 1] - start[i], seen, i + 1, row);
        p->start[i + 1] = p->start[i] + count;
        if (p->start[i + 1] > room) {
            room = 2 * room + p->start[i + 1];
            int *column = sn_resize(p->column, (size_t)room, sizeof *column);
            if (!column) {
                status = SN_E_MEMORY;
                goto fail;
            }
            p->column = column;
        }
        memcpy(p->column + p->start[i], row, (size_t)count * sizeof *row);
    }
fail:
    sn_free(seen);
    sn_free(row);
    sn_free(start);
    sn_free(item);
    return status;
}

sn_status sn_tangent_create_edges(const sn_net *net, sn_tangent *t) {
    struct sn_cluster *c = t->cluster = sn_alloc(1, sizeof *c);
    if (!c) return SN_E_MEMORY;
    c->most = 2 + 2 * net->edge_most;
    const size_t most = (size_t)c->most;
    c->node = sn_alloc(most, sizeof *c->node);
    c->g = sn_alloc(most, sizeof *c->g);
    c->c = sn_alloc(most, sizeof *c->c);
    c->B = sn_alloc(most, sizeof *c->B);
    c->DB = sn_alloc(most, sizeof *c->DB);
    if (!c->node || !c->g || !c->c || !c->B || !c->DB) return SN_E_MEMORY;
    return create_pattern(net, c, &t->cells);
}

void sn_tangent_destroy_edges(sn_tangent *t) {
    struct sn_cluster *c = t->cluster;
    if (!c) return;
    sn_free(c->node);
    sn_free(c->g);
    sn_free(c->c);
    sn_free(c->B);
    sn_free(c->DB);
    sn_free(c);
}
