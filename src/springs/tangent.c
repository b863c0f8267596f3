// The derivative of the nodal forces, for equilibrium.
// SPDX-License-Identifier: Apache-2.0
//
// Cells and springs give 3 x 3 blocks between nodes that share a cell, assembled by rows. The nodal
// volume energy couples nodes two cells apart; it stays a product,
//     sum over points a of (alpha K / V_a) b_a b_a^T,  b_a = d(V_a J_a)/dx,
// with b_a by rows. Its second part, p d2(V J)/dx2, is assembled with the cells.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "springs/parts.h"
#include "springs/tangent.h"
#include "springs/vectors.h"

//---- patterns ------------------------------------------------------------------------------------

// pairs of the ends of springs: those that were given need not share a cell
static void add_springs(const sn_net *net, sn_sparsity *p, int *fill) {
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        const int *end = net->spring_end + s / SN_BLOCK * 2 * SN_BLOCK + s % SN_BLOCK;
        for (int e = 0; e < 2; e++) {
            const int row = end[e * SN_BLOCK], column = end[(1 - e) * SN_BLOCK];
            if (fill)
                p->column[fill[row]++] = column;
            else
                p->start[row + 1]++;
        }
    }
}

// rows[4 a cell slot] are the rows that a cell touches, at [(block * 4 + corner) * SN_BLOCK + lane]
static sn_status create_pattern(const sn_net *net, int rows, const int *row_of, sn_sparsity *p) {
    const double *volume = net->data[SN_DOUBLE].volume;
    p->rows = rows;
    p->start = sn_alloc((size_t)rows + 1, sizeof *p->start);
    int *fill = sn_alloc((size_t)rows + 1, sizeof *fill);
    const bool springs = net->springs > 0 && row_of == net->cell_node;
    const size_t pairs = springs ? (size_t)net->spring_blocks * SN_BLOCK * 2 : 0;
    p->column = sn_alloc((size_t)net->cells * 16 + pairs, sizeof *p->column);
    if (!p->start || !fill || !p->column) {
        sn_free(fill);
        return SN_E_MEMORY;
    }
    for (int pass = 0; pass < 2; pass++) {
        for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) {
            if (!(volume[s] > 0)) continue;
            const int at = (s / SN_BLOCK) * 4 * SN_BLOCK + s % SN_BLOCK;
            for (int a = 0; a < 4; a++)
                for (int b = 0; b < 4; b++) {
                    int row = row_of[at + a * SN_BLOCK];
                    if (pass == 0)
                        p->start[row + 1]++;
                    else
                        p->column[fill[row]++] = net->cell_node[at + b * SN_BLOCK];
                }
        }
        if (springs) add_springs(net, p, pass == 0 ? NULL : fill);
        if (pass == 0)
            for (int i = 0; i < rows; i++) p->start[i + 1] += p->start[i];
        memcpy(fill, p->start, ((size_t)rows + 1) * sizeof *fill);
    }
    int kept = 0; // each column once
    for (int i = 0; i < rows; i++) {
        int from = fill[i], to = fill[i + 1];
        qsort(p->column + from, (size_t)(to - from), sizeof *p->column, compare_int);
        p->start[i] = kept;
        for (int k = from; k < to; k++)
            if (k == from || p->column[k] != p->column[k - 1]) p->column[kept++] = p->column[k];
    }
    p->start[rows] = kept;
    sn_free(fill);
    return SN_OK;
}

sn_status sn_tangent_create(const sn_net *net, sn_tangent **tangent) {
    *tangent = NULL;
    sn_tangent *t = sn_alloc(1, sizeof *t);
    if (!t) return SN_E_MEMORY;
    const size_t n = (size_t)net->nodes * 3, points = (size_t)net->point_blocks * SN_BLOCK;
    sn_status status;
    if (net->rung == SN_RUNG_SMOOTHED)
        SN_TRY_GOTO(status, sn_tangent_create_edges(net, t));
    else
        SN_TRY_GOTO(status, create_pattern(net, net->nodes, net->cell_node, &t->cells));
    t->block = sn_alloc((size_t)t->cells.start[net->nodes] * 9, sizeof *t->block);
    if (net->volume) {
        SN_TRY_GOTO(status, create_pattern(net, (int)points, net->cell_point, &t->points));
        t->flux = sn_alloc((size_t)t->points.start[points] * 3, sizeof *t->flux);
    } else {
        t->flux = sn_alloc(0, sizeof *t->flux);
    }
    t->stiffness = sn_alloc(points, sizeof *t->stiffness);
    t->along = sn_alloc(points, sizeof *t->along);
    t->inverse = sn_alloc(n * 3, sizeof *t->inverse);
    t->piece_sum = sn_alloc(net->cuttable ? (size_t)net->nodes / 4 + 1 : 0, sizeof(double));
    t->r = sn_alloc(n, sizeof *t->r);
    t->z = sn_alloc(n, sizeof *t->z);
    t->p = sn_alloc(n, sizeof *t->p);
    t->q = sn_alloc(n, sizeof *t->q);
    for (int k = 0; k < net->tool_count; k++) t->rubs = t->rubs || net->tool[k].friction > 0;
    t->shadow = sn_alloc(t->rubs ? n : 0, sizeof *t->shadow);
    t->y = sn_alloc(t->rubs ? n : 0, sizeof *t->y);
    t->v = sn_alloc(t->rubs ? n : 0, sizeof *t->v);
    status = t->block && t->flux && t->stiffness && t->along && t->inverse && t->piece_sum &&
                     t->r && t->z && t->p && t->q && t->shadow && t->y && t->v
                 ? SN_OK
                 : SN_E_MEMORY;
fail:
    if (status == SN_OK)
        *tangent = t;
    else
        sn_tangent_destroy(t);
    return status;
}

void sn_tangent_destroy(sn_tangent *t) {
    if (!t) return;
    sn_tangent_destroy_edges(t);
    void *all[] = {t->cells.start,
                   t->cells.column,
                   t->block,
                   t->points.start,
                   t->points.column,
                   t->flux,
                   t->stiffness,
                   t->inverse,
                   t->along,
                   t->piece_sum,
                   t->r,
                   t->z,
                   t->p,
                   t->q,
                   t->shadow,
                   t->y,
                   t->v};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_free(t);
}

//---- cells ---------------------------------------------------------------------------------------

typedef struct cell_values {
    int node[4];
    double g[4][3]; // gradients of the shape functions
    double F[9], V;
    double cof[4][3]; // cof F g
    double J;
} cell_values;

static void find_values(const sn_net *net, int slot, const double *u, cell_values *c) {
    const size_t block = (size_t)slot / SN_BLOCK, lane = (size_t)slot % SN_BLOCK;
    const double *gradient = net->data[SN_DOUBLE].gradient;
    c->V = ((const double *)net->data[SN_DOUBLE].volume)[slot];
    for (size_t a = 0; a < 4; a++) c->node[a] = net->cell_node[(block * 4 + a) * SN_BLOCK + lane];
    for (size_t k = 0; k < 3; k++) {
        c->g[0][k] = 0;
        for (size_t a = 1; a < 4; a++) {
            c->g[a][k] = gradient[(block * 9 + 3 * (a - 1) + k) * SN_BLOCK + lane];
            c->g[0][k] -= c->g[a][k];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            c->F[3 * i + j] = net->axes[3 * j + i];
            for (int a = 0; a < 4; a++) c->F[3 * i + j] += u[4 * c->node[a] + i] * c->g[a][j];
        }
    double cofactor[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            cofactor[3 * i + j] =
                c->F[3 * i1 + j1] * c->F[3 * i2 + j2] - c->F[3 * i1 + j2] * c->F[3 * i2 + j1];
        }
    c->J = c->F[0] * cofactor[0] + c->F[1] * cofactor[1] + c->F[2] * cofactor[2];
    for (int a = 0; a < 4; a++)
        for (int i = 0; i < 3; i++) {
            c->cof[a][i] = 0;
            for (int j = 0; j < 3; j++) c->cof[a][i] += cofactor[3 * i + j] * c->g[a][j];
        }
}

static void green_strain(const double F[9], double E[6]) {
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int k = 0; k < 6; k++) {
        int i = pair[k][0], j = pair[k][1];
        E[k] = 0.5 * (F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j] - (i == j));
    }
}

/// The law at the cells of a block.
typedef struct law_values {
    double E[6 * SN_BLOCK], S[6 * SN_BLOCK], D[21 * SN_BLOCK];
} law_values;

// V (B^T D B + g.S g I), with D and S as they act now
static void add_law(const cell_values *c, const double *S, double D[6][6], double K[4][4][9]) {
    double B[4][6][3], DB[4][6][3];
    for (int a = 0; a < 4; a++) {
        sn_strain_rows(c->F, c->g[a], B[a]);
        for (int k = 0; k < 6; k++)
            for (int j = 0; j < 3; j++) {
                DB[a][k][j] = 0;
                for (int l = 0; l < 6; l++) DB[a][k][j] += D[k][l] * B[a][l][j];
            }
    }
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++) {
            const double *p = c->g[a], *q = c->g[b];
            double geometric = p[0] * (S[0] * q[0] + S[3] * q[1] + S[5] * q[2]) +
                               p[1] * (S[3] * q[0] + S[1] * q[1] + S[4] * q[2]) +
                               p[2] * (S[5] * q[0] + S[4] * q[1] + S[2] * q[2]);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) {
                    double sum = i == j ? geometric : 0.0;
                    for (int k = 0; k < 6; k++) sum += B[a][k][i] * DB[b][k][j];
                    K[a][b][3 * i + j] += c->V * sum;
                }
        }
}

// bulk V cof_a cof_b + p V (cof_a cof_b^T - cof_b cof_a^T) / J
static void add_volume(const cell_values *c, double bulk, double p, double K[4][4][9]) {
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) {
                    double ab = c->cof[a][i] * c->cof[b][j], ba = c->cof[b][i] * c->cof[a][j];
                    K[a][b][3 * i + j] += c->V * (bulk * ab + p / c->J * (ab - ba));
                }
}

static void spread(sn_tangent *t, const cell_values *c, double K[4][4][9]) {
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++) {
            double *to = t->block + 9 * (size_t)sn_sparsity_find(&t->cells, c->node[a], c->node[b]);
            for (int k = 0; k < 9; k++) to[k] += K[a][b][k];
        }
}

static void add_flux(const sn_net *net, sn_tangent *t, int slot, const cell_values *c) {
    const int at = (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++) {
            double *to = t->flux + 3 * (size_t)sn_sparsity_find(&t->points,
                                                                net->cell_point[at + a * SN_BLOCK],
                                                                c->node[b]);
            for (int k = 0; k < 3; k++) to[k] += 0.25 * c->V * c->cof[b][k];
        }
}

static double mean_pressure(const sn_net *net, const double *pressure, int slot) {
    const int at = (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
    double sum = 0;
    for (int a = 0; a < 4; a++) sum += 0.25 * pressure[net->cell_point[at + a * SN_BLOCK]];
    return sum;
}

static void unpack(const double *D, size_t lane, double out[6][6]) {
    for (int i = 0, k = 0; i < 6; i++)
        for (int j = i; j < 6; j++, k++) out[i][j] = out[j][i] = D[k * SN_BLOCK + (int)lane];
}

static void block_law(const sn_net *net, const sn_net_region *region, const sn_tangent_law *parts,
                      int block, const double *u, law_values *law) {
    for (int lane = 0; lane < SN_BLOCK; lane++) {
        cell_values c;
        double E[6];
        find_values(net, block * SN_BLOCK + lane, u, &c);
        green_strain(c.F, E);
        for (int k = 0; k < 6; k++) law->E[k * SN_BLOCK + lane] = E[k];
    }
    sn_tangent_law_at(net, region, parts, block * SN_BLOCK, SN_BLOCK, law->E, law->S, law->D);
}

static void assemble_block(const sn_net *net, sn_tangent *t, const sn_net_region *region,
                           const sn_tangent_law *parts, int block, const sn_tangent_call *call,
                           law_values *law) {
    const bool solid = net->rung != SN_RUNG_SMOOTHED && parts->first < parts->splits;
    const double *volume = sn_parts_volume(net, call->parts, SN_DOUBLE);
    if (solid) block_law(net, region, parts, block, call->u, law);
    for (size_t lane = 0; lane < SN_BLOCK; lane++) {
        const int slot = block * SN_BLOCK + (int)lane;
        cell_values c;
        double K[4][4][9] = {{{0}}}, S[6], D[6][6];
        if (!(volume[slot] > 0)) continue;
        find_values(net, slot, call->u, &c);
        if (solid) {
            for (size_t k = 0; k < 6; k++) S[k] = law->S[k * SN_BLOCK + lane];
            unpack(law->D, lane, D);
            add_law(&c, S, D, K);
        }
        if (solid && net->volume_mode == SN_VOLUME_CELL) {
            const size_t n = (size_t)(slot - region->cell_block * SN_BLOCK);
            double p = sn_tangent_pressure(parts, n, region->bulk * (c.J - 1.0));
            add_volume(&c, parts->volume.alpha * region->bulk, p, K);
        } else if (net->volume_mode == SN_VOLUME_NODE) {
            add_volume(&c, 0.0, mean_pressure(net, call->pressure, slot), K);
            add_flux(net, t, slot, &c);
        }
        spread(t, &c, K);
    }
}

//---- springs -------------------------------------------------------------------------------------

static void add_spring(const sn_net *net, sn_tangent *t, const sn_net_region *region,
                       const sn_tangent_memory *m, int slot, const sn_tangent_call *call) {
    const sn_net_data *data = &net->data[SN_DOUBLE];
    const double *stiffness = sn_parts_stiffness(net, call->parts, SN_DOUBLE);
    const double k = stiffness[slot];
    const double inverse = ((const double *)data->inverse)[slot];
    const size_t block = (size_t)slot / SN_BLOCK, lane = (size_t)slot % SN_BLOCK;
    if (!(k > 0)) return;
    int end[2];
    double x[3], l2 = 0;
    for (size_t e = 0; e < 2; e++) end[e] = net->spring_end[(block * 2 + e) * SN_BLOCK + lane];
    for (size_t d = 0; d < 3; d++) {
        x[d] = ((const double *)data->edge)[(block * 3 + d) * SN_BLOCK + lane] +
               call->u[4 * (size_t)end[1] + d] - call->u[4 * (size_t)end[0] + d];
        l2 += x[d] * x[d];
    }
    const sn_spring_law law = sn_net_spring_law(net, region, slot);
    double lambda = sqrt(l2 * inverse), slope, tension = sn_spring_tension(&law, lambda, &slope);
    tension = sn_tangent_stress(m, (size_t)(slot - region->spring_block * SN_BLOCK), tension);
    double across = k * tension / lambda;
    double along = k * (m->alpha * slope - tension / lambda) / (lambda * lambda) * inverse;
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            double *to = t->block + 9 * (size_t)sn_sparsity_find(&t->cells, end[a], end[b]);
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    to[3 * i + j] += (a == b ? 1 : -1) * (along * x[i] * x[j] + (i == j) * across);
        }
}

//---- whole ---------------------------------------------------------------------------------------

void sn_tangent_assemble(const sn_net *net, sn_tangent *t, const sn_tangent_call *call) {
    law_values law;
    t->unsymmetric = false;
    memset(t->block, 0, (size_t)t->cells.start[net->nodes] * 9 * sizeof *t->block);
    if (net->volume)
        memset(t->flux, 0, (size_t)t->points.start[t->points.rows] * 3 * sizeof *t->flux);
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        const sn_tangent_memory springs = sn_tangent_memory_of(net, g, call, SN_STORE_SPRING);
        const sn_tangent_memory points = sn_tangent_memory_of(net, g, call, SN_STORE_POINT);
        sn_tangent_law parts;
        sn_tangent_law_of(net, g, call, &parts);
        if ((net->rung != SN_RUNG_SMOOTHED && sn_region_law_blocks(net, g) > 0) || net->volume)
            for (int b = g->cell_block; b < g->cell_block + g->cell_blocks; b++)
                assemble_block(net, t, g, &parts, b, call, &law);
        if (net->rung == SN_RUNG_SMOOTHED) sn_tangent_add_edges(net, t, g, &parts, call);
        if (net->rung == SN_RUNG_CENTRAL)
            for (int s = g->spring_block * SN_BLOCK;
                 s < (g->spring_block + g->spring_blocks) * SN_BLOCK; s++)
                add_spring(net, t, g, &springs, s, call);
        const double *stiffness = sn_parts_point_stiffness(net, call->parts, SN_DOUBLE);
        for (int p = g->point_block * SN_BLOCK; p < (g->point_block + g->point_blocks) * SN_BLOCK;
             p++)
            t->stiffness[p] = points.alpha * stiffness[p];
    }
}

void sn_tangent_add(sn_tangent *t, int node, const double block[9]) {
    double *to = t->block + 9 * (size_t)sn_sparsity_find(&t->cells, node, node);
    for (int k = 0; k < 9; k++) to[k] += block[k];
}

void sn_tangent_add_contact(void *context, int node, const double block[9]) {
    sn_tangent *t = context;
    t->unsymmetric = t->rubs; // else it is symmetric to rounding
    sn_tangent_add(t, node, block);
}

void sn_tangent_add_pressure(sn_tangent *t, const int node[3], double x[3][3], double pressure) {
    // f = -p/6 (x0 x x1 + x1 x x2 + x2 x x0) at each node: node b moves it by -p/6 du x e_b, where
    // e_b is the edge to node b + 1 from node b + 2, so that the symmetric part of block (a, b) is
    // p/12 times the matrix that takes du to (e_a - e_b) x du
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            if (a == b) continue;
            double *to = t->block + 9 * (size_t)sn_sparsity_find(&t->cells, node[a], node[b]);
            for (int d = 0; d < 3; d++) {
                const int i = (d + 1) % 3, j = (d + 2) % 3;
                const double e_a = x[(a + 1) % 3][d] - x[(a + 2) % 3][d];
                const double e_b = x[(b + 1) % 3][d] - x[(b + 2) % 3][d];
                const double part = pressure / 12.0 * (e_a - e_b);
                to[3 * j + i] += part;
                to[3 * i + j] -= part;
            }
        }
}

void sn_tangent_add_mass(const sn_net *net, sn_tangent *t, double factor) {
    for (int i = 0; i < net->nodes; i++) {
        double *to = t->block + 9 * (size_t)sn_sparsity_find(&t->cells, i, i);
        for (int d = 0; d < 3; d++) to[4 * d] += factor * net->mass[i];
    }
}

void sn_tangent_lower(sn_tangent *t, int count, const double *vectors, double factor) {
    t->lowered = count;
    t->lower = vectors;
    t->lower_factor = factor;
}

void sn_tangent_lower_pieces(sn_tangent *t, const int *piece, int pieces) {
    t->piece = piece;
    t->pieces = pieces;
}

// y -= factor b (b . x), by pieces
static void lower_pieces(const sn_tangent *t, size_t n, const double *b, const double *x,
                         double *y) {
    memset(t->piece_sum, 0, (size_t)t->pieces * sizeof *t->piece_sum);
    for (size_t i = 0; i < n; i++)
        if (t->piece[i / 3] >= 0) t->piece_sum[t->piece[i / 3]] += b[i] * x[i];
    for (size_t i = 0; i < n; i++)
        if (t->piece[i / 3] >= 0) y[i] -= t->lower_factor * t->piece_sum[t->piece[i / 3]] * b[i];
}

// inverse of a symmetric 3 x 3 block; a diagonal one where it is not positive definite
static void invert(const double A[9], double out[9]) {
    double c[9], det;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c[3 * j + i] = A[3 * i1 + j1] * A[3 * i2 + j2] - A[3 * i1 + j2] * A[3 * i2 + j1];
        }
    det = A[0] * c[0] + A[1] * c[3] + A[2] * c[6];
    bool definite = A[0] > 0 && c[8] > 0 && det > 0;
    for (int k = 0; k < 9; k++)
        out[k] = definite ? c[k] / det : k % 4 == 0 && A[k] != 0 ? 1.0 / fabs(A[k]) : 0.0;
}

void sn_tangent_prepare(const sn_net *net, sn_tangent *t) {
    // the diagonal, gathered in `inverse`
    for (int i = 0; i < net->nodes; i++)
        memcpy(t->inverse + 9 * (size_t)i, t->block + 9 * (size_t)sn_sparsity_find(&t->cells, i, i),
               9 * sizeof(double));
    for (int p = 0; p < t->points.rows; p++)
        for (int k = t->points.start[p]; k < t->points.start[p + 1]; k++) {
            const double *b = t->flux + 3 * (size_t)k;
            double *to = t->inverse + 9 * (size_t)t->points.column[k];
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) to[3 * i + j] += t->stiffness[p] * b[i] * b[j];
        }
    for (int i = 0; i < net->nodes; i++) {
        double A[9], *to = t->inverse + 9 * (size_t)i;
        memcpy(A, to, sizeof A);
        for (int d = 0; d < 3; d++) {
            if (!(net->fixed_bits[i] >> d & 1)) continue;
            for (int k = 0; k < 3; k++) A[3 * d + k] = A[3 * k + d] = 0.0;
            A[4 * d] = 1.0;
        }
        invert(A, to);
    }
}

void sn_tangent_multiply(const sn_net *net, sn_tangent *t, const double *x, double *y) {
    for (int i = 0; i < net->nodes; i++) {
        double a = 0, b = 0, c = 0;
        for (int k = t->cells.start[i]; k < t->cells.start[i + 1]; k++) {
            const double *m = t->block + 9 * (size_t)k, *v = x + 3 * (size_t)t->cells.column[k];
            a += m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
            b += m[3] * v[0] + m[4] * v[1] + m[5] * v[2];
            c += m[6] * v[0] + m[7] * v[1] + m[8] * v[2];
        }
        y[3 * (size_t)i] = a;
        y[3 * (size_t)i + 1] = b;
        y[3 * (size_t)i + 2] = c;
    }
    for (int p = 0; p < t->points.rows; p++) {
        double sum = 0;
        for (int k = t->points.start[p]; k < t->points.start[p + 1]; k++) {
            const double *b = t->flux + 3 * (size_t)k, *v = x + 3 * (size_t)t->points.column[k];
            sum += b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
        }
        sum *= t->stiffness[p];
        for (int k = t->points.start[p]; k < t->points.start[p + 1]; k++) {
            const double *b = t->flux + 3 * (size_t)k;
            double *v = y + 3 * (size_t)t->points.column[k];
            for (int d = 0; d < 3; d++) v[d] += sum * b[d];
        }
    }
    const size_t n = (size_t)net->nodes * 3;
    for (int k = 0; k < t->lowered; k++) {
        const double *b = t->lower + (size_t)k * n;
        if (t->piece) {
            lower_pieces(t, n, b, x, y);
            continue;
        }
        const double off = t->lower_factor * sn_dot(b, x, n);
        for (size_t i = 0; i < n; i++) y[i] -= off * b[i];
    }
}
