// Cells: nodal forces and tangent matrices from the values at the quadrature points.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/cell.h"

#include <math.h>
#include <string.h>

enum { N = SN_FE_POINTS, L = SN_FE_LANES };

static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

//---- forces -------------------------------------------------------------------------------------

// f_k = V (F S) grad lambda_k at point q of all cells, k = 0 … 3.
static void corner_forces(const sn_fe_space *s, int batch, int q, const sn_fe_points *p,
                          double *f) {
    int width = s->batch_cells;
    const double *g = s->gradient + (size_t)batch * (size_t)(12 * width);
    for (int c = 0; c < width; c++) {
        int n = q * width + c;
        double P[3][3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double v = p->S[sym[i][j] * N + n];
                for (int k = 0; k < 3; k++)
                    v += p->M[(3 * i + k) * N + n] * p->S[sym[k][j] * N + n];
                P[i][j] = v * p->weight[n];
            }
        for (int k = 0; k < 4; k++)
            for (int i = 0; i < 3; i++)
                f[(3 * k + i) * width + c] = P[i][0] * g[3 * k * width + c] +
                                             P[i][1] * g[(3 * k + 1) * width + c] +
                                             P[i][2] * g[(3 * k + 2) * width + c];
    }
}

static void scatter_forces(const sn_fe_space *s, int batch, const sn_fe_work *work,
                           double *residual) {
    int width = s->batch_cells, nodes = s->element.nodes;
    const int *node = s->node + (size_t)batch * (size_t)(nodes * width);
    for (int c = 0; c < s->batch_count[batch]; c++) {
        const double *R = sn_fe_axes(s, batch, c);
        for (int a = 0; a < nodes; a++) {
            const double *f = work->force + 3 * a * width + c;
            double v[3] = {f[0], f[width], f[2 * width]};
            double *to = residual + 3 * (size_t)node[a * width + c];
            for (int i = 0; i < 3; i++)
                to[i] += s->rotated ? R[i] * v[0] + R[3 + i] * v[1] + R[6 + i] * v[2] : v[i];
        }
        for (int k = 0; k < 4 && s->element.mixed; k++)
            residual[3 * (size_t)s->nodes + (size_t)node[k * width + c]] +=
                work->flux[k * width + c];
    }
}

void sn_fe_cell_forces(const sn_fe_space *s, int batch, sn_fe_work *work, double *residual) {
    int width = s->batch_cells, nodes = s->element.nodes;
    const sn_fe_points *p = &work->points;
    memset(work->force, 0, (size_t)(3 * nodes * width) * sizeof *work->force);
    memset(work->flux, 0, sizeof work->flux);
    for (int q = 0; q < s->element.points; q++) {
        double f[12 * N];
        corner_forces(s, batch, q, p, f);
        for (int a = 0; a < nodes; a++)
            for (int k = 0; k < 4; k++) {
                double slope = s->element.slope[q][a][k];
                if (slope == 0.0) continue;
                for (int i = 0; i < 3; i++)
                    for (int c = 0; c < width; c++)
                        work->force[(3 * a + i) * width + c] += slope * f[(3 * k + i) * width + c];
            }
        for (int k = 0; k < 4 && s->element.mixed; k++)
            for (int c = 0; c < width; c++)
                work->flux[k * width + c] +=
                    s->element.lambda[q][k] * p->weight[q * width + c] * p->g[q * width + c];
    }
    scatter_forces(s, batch, work, residual);
}

//---- tangent ------------------------------------------------------------------------------------

// The tangent of the corners at point q of SN_FE_LANES cells from `first`:
//     K_kl = V (B_k^T D B_l + (grad lambda_k . S grad lambda_l) I),
// B_k the derivative of e = (E_xx, E_yy, E_zz, 2 E_xy, 2 E_yz, 2 E_zx). Corners 1 … 3 are formed,
// corner 0 is minus their sum.
typedef struct lanes {
    double g[3][3][L]; // gradients of lambda_1 … lambda_3, times the volume in gv
    double F[3][3][L];
    double B[3][6][3][L];
    double DB[6][3][L];
} lanes;

static void load_lanes(const sn_fe_space *s, int batch, int q, int first, const sn_fe_points *p,
                       lanes *w) {
    int width = s->batch_cells, at = q * width + first;
    const double *g = s->gradient + (size_t)batch * (size_t)(12 * width) + first;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            for (int c = 0; c < L; c++) w->g[k][i][c] = g[(3 * k + 3 + i) * width + c];
            for (int c = 0; c < L; c++)
                w->F[k][i][c] = p->M[(3 * k + i) * N + at + c] + (k == i ? 1.0 : 0.0);
        }
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < L; c++) {
                double F0 = w->F[i][0][c], F1 = w->F[i][1][c], F2 = w->F[i][2][c];
                double g0 = w->g[k][0][c], g1 = w->g[k][1][c], g2 = w->g[k][2][c];
                w->B[k][0][i][c] = F0 * g0;
                w->B[k][1][i][c] = F1 * g1;
                w->B[k][2][i][c] = F2 * g2;
                w->B[k][3][i][c] = F0 * g1 + F1 * g0;
                w->B[k][4][i][c] = F1 * g2 + F2 * g1;
                w->B[k][5][i][c] = F2 * g0 + F0 * g2;
            }
}

// DB = V D B_l
static void stress_of(const sn_fe_points *p, int at, int l, lanes *w) {
    static const int upper[6][6] = {{0, 1, 2, 3, 4, 5},     {1, 6, 7, 8, 9, 10},
                                    {2, 7, 11, 12, 13, 14}, {3, 8, 12, 15, 16, 17},
                                    {4, 9, 13, 16, 18, 19}, {5, 10, 14, 17, 19, 20}};
    for (int e = 0; e < 6; e++) {
        double sum[3][L] = {{0}};
        for (int f = 0; f < 6; f++) {
            const double *D = p->D + upper[e][f] * N + at;
            for (int i = 0; i < 3; i++)
                for (int c = 0; c < L; c++) sum[i][c] += D[c] * w->B[l][f][i][c];
        }
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < L; c++) w->DB[e][i][c] = sum[i][c] * p->weight[at + c];
    }
}

static void corner_pair(const sn_fe_points *p, int at, int k, int l, const lanes *w, double *K) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum[L] = {0};
            for (int e = 0; e < 6; e++)
                for (int c = 0; c < L; c++) sum[c] += w->B[k][e][i][c] * w->DB[e][j][c];
            for (int c = 0; c < L; c++) K[(3 * i + j) * L + c] = sum[c];
        }
    double geometric[L] = {0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double *S = p->S + sym[i][j] * N + at;
            for (int c = 0; c < L; c++) geometric[c] += S[c] * w->g[k][i][c] * w->g[l][j][c];
        }
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < L; c++) K[4 * i * L + c] += geometric[c] * p->weight[at + c];
}

static void transpose(const double *K, double *out) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            memcpy(out + (3 * i + j) * L, K + (3 * j + i) * L, L * sizeof *K);
}

static void corner_tangent(const sn_fe_space *s, int batch, int q, int first, sn_fe_work *work) {
    const sn_fe_points *p = &work->points;
    int at = q * s->batch_cells + first;
    double(*K)[9 * L] = work->corner;
    lanes w;
    load_lanes(s, batch, q, first, p, &w);
    for (int l = 1; l < 4; l++) {
        stress_of(p, at, l - 1, &w);
        for (int k = 1; k <= l; k++) corner_pair(p, at, k - 1, l - 1, &w, K[4 * k + l]);
        for (int k = 1; k < l; k++) transpose(K[4 * k + l], K[4 * l + k]);
    }
    for (int l = 1; l < 4; l++) {
        for (int n = 0; n < 9 * L; n++) K[l][n] = -(K[4 + l][n] + K[8 + l][n] + K[12 + l][n]);
        transpose(K[l], K[4 * l]);
    }
    for (int n = 0; n < 9 * L; n++) K[0][n] = -(K[4][n] + K[8][n] + K[12][n]);
    if (!s->element.mixed) return;
    // V cof F grad lambda_k
    for (int c = 0; c < L; c++) {
        double cof[3][3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                cof[i][j] = w.F[i1][j1][c] * w.F[i2][j2][c] - w.F[i1][j2][c] * w.F[i2][j1][c];
            }
        for (int i = 0; i < 3; i++) {
            double sum = 0.0;
            for (int k = 1; k < 4; k++) {
                double v = 0.0;
                for (int j = 0; j < 3; j++) v += cof[i][j] * w.g[k - 1][j][c];
                work->cofactor[(3 * k + i) * L + c] = v * p->weight[at + c];
                sum += v * p->weight[at + c];
            }
            work->cofactor[i * L + c] = -sum;
        }
    }
}

// Adds the corners' tangent of point q, mixed by the slopes, to K, and the pressure parts to L, M.
static void mix(const sn_fe_space *s, const sn_fe_material *m, int q, int first, sn_fe_work *work) {
    const sn_fe_element *e = &s->element;
    const double(*slope)[4] = e->slope[q];
    for (int a = 0; a < e->nodes; a++)
        for (int b = a; b < e->nodes; b++) {
            double *to = work->K[a * SN_FE_NODES + b];
            for (int k = 0; k < 4; k++)
                for (int l = 0; l < 4; l++) {
                    double by = slope[a][k] * slope[b][l];
                    if (by == 0.0) continue;
                    for (int n = 0; n < 9 * L; n++) to[n] += by * work->corner[4 * k + l][n];
                }
        }
    if (!e->mixed) return;
    for (int a = 0; a < e->nodes; a++)
        for (int k = 0; k < 4; k++)
            for (int b = 0; b < 4 && slope[a][k] != 0.0; b++)
                for (int n = 0; n < 3 * L; n++)
                    work->L[4 * a + b][n] +=
                        slope[a][k] * e->lambda[q][b] * work->cofactor[3 * k * L + n];
    double soft = isinf(m->bulk) ? 0.0 : -1.0 / (m->part[SN_PART_VOLUMETRIC].factor * m->bulk);
    const double *weight = work->points.weight + q * s->batch_cells + first;
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            for (int c = 0; c < L; c++)
                work->M[4 * a + b][c] += soft * e->lambda[q][a] * e->lambda[q][b] * weight[c];
}

// Adds the cells' share in the diagonal of the pressures' Schur complement (multigrid.h): the
// pressures' mass over mu and over K. For 2 mu dev e : dev e the trace of the cell's matrix is
// 10/3 mu sum_a int |grad N_a|^2, which gives the mu of the cell as it is strained; of such a
// material S is 3/4 of the mass over mu.
static void soften(const sn_fe_space *s, const sn_fe_material *m, int batch, int first,
                   const sn_fe_work *work, double *soft) {
    const sn_fe_element *e = &s->element;
    int width = s->batch_cells, count = s->batch_count[batch] - first;
    const double *g = s->gradient + (size_t)batch * (size_t)(12 * width) + first;
    double by[4][4] = {{0}};
    for (int q = 0; q < e->points; q++)
        for (int a = 0; a < e->nodes; a++)
            for (int k = 0; k < 4; k++)
                for (int l = 0; l < 4; l++)
                    by[k][l] += e->weight[q] * e->slope[q][a][k] * e->slope[q][a][l];
    for (int c = 0; c < L && c < count; c++) {
        double trace = 0.0, slopes = 0.0, volume = s->volume[batch * width + first + c];
        for (int a = 0; a < e->nodes; a++)
            for (int i = 0; i < 3; i++) trace += work->K[a * SN_FE_NODES + a][4 * i * L + c];
        for (int k = 0; k < 4; k++)
            for (int l = 0; l < 4; l++)
                for (int i = 0; i < 3; i++)
                    slopes += by[k][l] * g[(3 * k + i) * width + c] * g[(3 * l + i) * width + c];
        double mu = 0.3 * fabs(trace) / (volume * slopes);
        double K = m->part[SN_PART_VOLUMETRIC].factor * m->bulk;
        for (int k = 0; k < 4; k++)
            soft[sn_fe_cell_block(s, batch, first + c, k)] += 0.1 * volume * (0.75 / mu + 1.0 / K);
    }
}

/// Where the tangent of one cell goes.
typedef struct target {
    const sn_fe_matrix *matrix;
    const int *offset;
    const double *axes; ///< Nullable: not rotated
    int lane, block[SN_FE_BLOCKS];
} target;

// R^T k R: from material axes to space.
static void turn(const double *R, double *k) {
    double half[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            half[3 * i + j] = k[3 * i] * R[j] + k[3 * i + 1] * R[3 + j] + k[3 * i + 2] * R[6 + j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            k[3 * i + j] = R[i] * half[j] + R[3 + i] * half[3 + j] + R[6 + i] * half[6 + j];
}

static void scatter_displacements(int nodes, const double (*K)[9 * L], int stride,
                                  const target *t) {
    int blocks = t->matrix->pattern->cell_blocks;
    for (int a = 0; a < nodes; a++)
        for (int b = 0; b < nodes; b++) {
            double k[9];
            const double *from = K[a <= b ? a * stride + b : b * stride + a] + t->lane;
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    k[3 * i + j] = from[(a <= b ? 3 * i + j : 3 * j + i) * L];
            if (t->axes) turn(t->axes, k);
            sn_fe_matrix_add(t->matrix, t->block[a], t->block[b], t->offset[a * blocks + b], k);
        }
}

static void scatter_pressures(int nodes, const sn_fe_work *work, const target *t) {
    const sn_fe_matrix *matrix = t->matrix;
    const int *block = t->block, *offset = t->offset, blocks = matrix->pattern->cell_blocks;
    const double *R = t->axes;
    for (int b = 0; b < 4; b++) {
        int pressure = nodes + b;
        for (int a = 0; a < nodes; a++) {
            const double *from = work->L[4 * a + b] + t->lane;
            double v[3] = {from[0], from[L], from[2 * L]}, k[3], column[9] = {0}, row[9] = {0};
            for (int i = 0; i < 3; i++)
                k[i] = R ? R[i] * v[0] + R[3 + i] * v[1] + R[6 + i] * v[2] : v[i];
            for (int i = 0; i < 3; i++) {
                column[3 * i] = k[i];
                row[i] = k[i];
            }
            sn_fe_matrix_add(matrix, block[a], block[pressure], offset[a * blocks + pressure],
                             column);
            sn_fe_matrix_add(matrix, block[pressure], block[a], offset[pressure * blocks + a], row);
        }
        for (int a = 0; a < 4; a++) {
            const double k[9] = {work->M[4 * a + b][t->lane]};
            sn_fe_matrix_add(matrix, block[nodes + a], block[pressure],
                             offset[(nodes + a) * blocks + pressure], k);
        }
    }
}

void sn_fe_cell_tangent(const sn_fe_space *s, const sn_fe_material *m, int batch, sn_fe_work *work,
                        const sn_fe_matrix *matrix) {
    int blocks = matrix->pattern->cell_blocks;
    bool linear = s->element.nodes == 4;
    for (int first = 0; first < s->batch_count[batch]; first += L) {
        if (!linear) {
            memset(work->K, 0, sizeof work->K);
            memset(work->L, 0, sizeof work->L);
            memset(work->M, 0, sizeof work->M);
        }
        for (int q = 0; q < s->element.points; q++) {
            corner_tangent(s, batch, q, first, work);
            if (!linear) mix(s, m, q, first, work);
        }
        if (matrix->soft) soften(s, m, batch, first, work, matrix->soft);
        for (int lane = 0; lane < L && first + lane < s->batch_count[batch]; lane++) {
            int at = first + lane;
            target t = {.matrix = matrix,
                        .offset = matrix->pattern->offset +
                                  (size_t)(batch * s->batch_cells + at) * (size_t)(blocks * blocks),
                        .axes = s->rotated ? sn_fe_axes(s, batch, at) : NULL,
                        .lane = lane};
            for (int k = 0; k < blocks; k++) t.block[k] = sn_fe_cell_block(s, batch, at, k);
            scatter_displacements(s->element.nodes,
                                  linear ? (const double(*)[9 * L]) work->corner
                                         : (const double(*)[9 * L]) work->K,
                                  linear ? 4 : SN_FE_NODES, &t);
            if (s->element.mixed) scatter_pressures(s->element.nodes, work, &t);
        }
    }
}
