// Virtual tests of a net against closed forms.
// SPDX-License-Identifier: Apache-2.0
//
// A stress that is linear in space and in balance without body forces, put on a body of any shape
// by its own tractions, is what a homogeneous body answers with: even stretch, shear and
// pressure, bending and torsion as in a long beam. The free net gets the consistent nodal forces
//     f_a = integral of sigma grad N_a = sum over cells V sigma(middle) grad N_a
// and answers, at small strain, with u = K^-1 f. Its stiffness is the body's when the work f.u is
// the integral of sigma.epsilon. Nodes on the surface are free, so what the net lacks there counts.
// Held, nodes on the surface go where the body's would and the net inside them relaxes to u: it is
// stiffer by u.Ku over the integral of sigma.epsilon. With even strains these are the apparent
// moduli of homogenisation, held from above, free from below; bending and torsion add what cells of
// this size cannot follow.
#include <math.h>
#include <string.h>

#include "springs/tangent.h"
#include "springs/vectors.h"

#define SOLVED 1e-5 // residual over the forces; the work is better by far

// stress at y from the middle of the body: xx yy zz xy yz zx
static void stress_at(int test, const double y[3], double s[6]) {
    memset(s, 0, 6 * sizeof *s);
    const int i = test < 6 ? 0 : (test - 7) % 3, j = (i + 1) % 3, k = (i + 2) % 3;
    if (test < 6) {
        s[test] = 1.0;
    } else if (test == 6) {
        s[0] = s[1] = s[2] = 1.0;
    } else if (test < 10) {
        s[i] = y[j];
    } else { // about axis i: s_ij = -y_k, s_ki = y_j
        s[3 + i] = -y[k];
        s[3 + k] = y[j];
    }
}

const char *sn_net_response_name(int test) {
    static const char *const name[SN_RESPONSES] = {
        "stretch x", "stretch y", "stretch z", "shear xy", "shear yz", "shear zx", "pressure",
        "bend x",    "bend y",    "bend z",    "twist x",  "twist y",  "twist z"};
    SN_ASSERT(test >= 0 && test < SN_RESPONSES);
    return name[test];
}

/// A net without supports, and one test on it.
typedef struct bench {
    sn_net net; // shares everything with that of the caller but what is prescribed
    sn_tangent *tangent;
    double *f, *x, *u;       // forces, displacements                (nodes x 3)
    double middle[3], size;  // of the body
    double work;             // of the continuum
    double compliance[6][6]; // strain over stress, shears twice the tensor's
} bench;

static void corner_offset(const bench *b, int node, double y[3]) {
    for (int d = 0; d < 3; d++)
        y[d] = (b->net.node_position[3 * node + d] - b->middle[d]) / b->size;
}

// integral of sigma.epsilon over a cell, sigma linear with the values s at its corners
static double cell_work(double V, double s[4][6], double compliance[6][6]) {
    double sum = 0;
    for (int a = 0; a < 4; a++)
        for (int c = a; c < 4; c++)
            for (int i = 0; i < 6; i++)
                for (int j = 0; j < 6; j++) sum += 2.0 * s[a][i] * compliance[i][j] * s[c][j];
    return V / 20.0 * sum;
}

// nodal forces and work of a test
static void load(bench *b, int test) {
    const sn_net *net = &b->net;
    const double *volume = net->data[SN_DOUBLE].volume;
    const double *gradient = net->data[SN_DOUBLE].gradient;
    memset(b->f, 0, (size_t)net->nodes * 3 * sizeof *b->f);
    b->work = 0;
    for (int slot = 0; slot < net->cell_blocks * SN_BLOCK; slot++) {
        const int block = slot / SN_BLOCK, lane = slot % SN_BLOCK;
        double s[4][6], mean[6] = {0}, g[4][3] = {{0}};
        int node[4];
        if (!(volume[slot] > 0)) continue;
        for (int a = 0; a < 4; a++) {
            double y[3];
            node[a] = net->cell_node[(block * 4 + a) * SN_BLOCK + lane];
            corner_offset(b, node[a], y);
            stress_at(test, y, s[a]);
            for (int k = 0; k < 6; k++) mean[k] += 0.25 * s[a][k];
            for (int k = 0; k < 3 && a > 0; k++) {
                g[a][k] = gradient[(size_t)(block * 9 + 3 * (a - 1) + k) * SN_BLOCK + (size_t)lane];
                g[0][k] -= g[a][k];
            }
        }
        b->work += cell_work(volume[slot], s, b->compliance);
        for (int a = 0; a < 4; a++) {
            double *f = b->f + 3 * (size_t)node[a];
            f[0] += volume[slot] * (mean[0] * g[a][0] + mean[3] * g[a][1] + mean[5] * g[a][2]);
            f[1] += volume[slot] * (mean[3] * g[a][0] + mean[1] * g[a][1] + mean[4] * g[a][2]);
            f[2] += volume[slot] * (mean[5] * g[a][0] + mean[4] * g[a][1] + mean[2] * g[a][2]);
        }
    }
}

static void find_middle(bench *b) {
    const sn_net *net = &b->net;
    const double *volume = net->data[SN_DOUBLE].volume;
    double sum = 0;
    for (int slot = 0; slot < net->cell_blocks * SN_BLOCK; slot++)
        for (int a = 0; a < 4 && volume[slot] > 0; a++) {
            const int node = net->cell_node[(slot / SN_BLOCK * 4 + a) * SN_BLOCK + slot % SN_BLOCK];
            sum += volume[slot] / 4.0;
            for (int d = 0; d < 3; d++)
                b->middle[d] += volume[slot] / 4.0 * net->node_position[3 * node + d];
        }
    for (int d = 0; d < 3; d++) b->middle[d] /= sum;
    b->size = cbrt(sum);
}

// nodes with a traction under pressure
static void hold_surface(bench *b) {
    load(b, 6);
    const double least = 1e-9 * b->size * b->size / cbrt((double)b->net.nodes);
    for (int i = 0; i < b->net.nodes; i++) {
        const double *f = b->f + 3 * (size_t)i;
        if (f[0] * f[0] + f[1] * f[1] + f[2] * f[2] <= least * least) continue;
        b->net.fixed_bits[i] = 7;
        for (int d = 0; d < 3; d++)
            b->net.fixed[b->net.fixed_count++] = (sn_net_fixed){.node = i, .direction = d};
    }
}

static sn_status open_bench(const sn_net *net, bool held, bench *b) {
    const size_t nodes = (size_t)net->nodes;
    b->net = *net;
    b->net.fixed_count = 0;
    b->net.fixed_bits = sn_alloc(nodes, sizeof *b->net.fixed_bits);
    b->net.fixed = sn_alloc(nodes * 3, sizeof *b->net.fixed);
    b->f = sn_alloc(nodes * 3, sizeof *b->f);
    b->x = sn_alloc(nodes * 4, sizeof *b->x);
    b->u = sn_alloc(nodes * 3, sizeof *b->u);
    double *pressure = sn_alloc((size_t)net->point_blocks * SN_BLOCK, sizeof *pressure);
    sn_status status =
        b->net.fixed_bits && b->net.fixed && b->f && b->x && b->u && pressure ? SN_OK : SN_E_MEMORY;
    if (status == SN_OK) status = sn_tangent_create(&b->net, &b->tangent);
    if (status == SN_OK) {
        find_middle(b);
        if (held) hold_surface(b);
        // at rest: x is still zero, of as many numbers as quads have
        const sn_tangent_call call = {.u = b->x, .pressure = pressure};
        sn_tangent_assemble(&b->net, b->tangent, &call);
        sn_tangent_prepare(&b->net, b->tangent);
    }
    sn_free(pressure);
    return status;
}

static void close_bench(bench *b) {
    sn_tangent_destroy(b->tangent);
    sn_free(b->net.fixed_bits);
    sn_free(b->net.fixed);
    sn_free(b->u);
    sn_free(b->f);
    sn_free(b->x);
}

static double free_test(bench *b, int test) {
    const size_t n = (size_t)b->net.nodes * 3;
    load(b, test);
    memset(b->x, 0, n * sizeof *b->x);
    const double target = SOLVED * sqrt(sn_dot(b->f, b->f, n));
    if (sn_tangent_solve(&b->net, b->tangent, b->f, target, b->x) < 0) return (double)NAN;
    return b->work / sn_dot(b->f, b->x, n) - 1.0;
}

// Displacement at y of the body under the stress of a test, over its size. With the tensor strain
// e_ij = a_ijm y_m, or a_ij where it is even,
//     u_i = (a_ijm + a_imj - a_jmi) y_j y_m / 2,   or   u_i = a_ij y_j.
static void displacement_at(const bench *b, int test, const double y[3], double u[3]) {
    static const int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const bool even = test < 7;
    double a[3][6] = {{0}}; // strain for y along each axis
    for (int m = 0; m < 3; m++) {
        double s[6], unit[3] = {0};
        unit[m] = 1.0;
        stress_at(test, unit, s);
        for (int i = 0; i < 6; i++)
            for (int k = 0; k < 6; k++) a[m][i] += (i < 3 ? 1.0 : 0.5) * b->compliance[i][k] * s[k];
    }
    for (int i = 0; i < 3; i++) {
        u[i] = 0.0;
        for (int j = 0; j < 3; j++) {
            if (even) u[i] += a[0][at[i][j]] * y[j];
            for (int m = 0; m < 3 && !even; m++)
                u[i] += 0.5 * (a[m][at[i][j]] + a[j][at[i][m]] - a[i][at[j][m]]) * y[j] * y[m];
        }
    }
}

static void body_displacement(bench *b, int test) {
    for (int i = 0; i < b->net.nodes; i++) {
        double y[3], *u = b->u + 3 * (size_t)i;
        corner_offset(b, i, y);
        displacement_at(b, test, y, u);
        for (int d = 0; d < 3; d++) u[d] *= b->size;
    }
}

static double held_test(bench *b, int test) {
    const size_t n = (size_t)b->net.nodes * 3;
    load(b, test);
    body_displacement(b, test);
    sn_tangent_multiply(&b->net, b->tangent, b->u, b->f);
    const double affine = sn_dot(b->u, b->f, n);
    for (int k = 0; k < b->net.fixed_count; k++)
        b->f[3 * b->net.fixed[k].node + b->net.fixed[k].direction] = 0.0;
    memset(b->x, 0, n * sizeof *b->x);
    const double size = sqrt(sn_dot(b->f, b->f, n));
    if (sn_tangent_solve(&b->net, b->tangent, b->f, SOLVED * size, b->x) < 0) return (double)NAN;
    return (affine - sn_dot(b->f, b->x, n)) / b->work - 1.0;
}

// by Gauss's method: C is symmetric and positive definite
static void invert(double C[6][6], double out[6][6]) {
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) out[i][j] = i == j;
    for (int p = 0; p < 6; p++) {
        const double pivot = C[p][p];
        for (int j = 0; j < 6; j++) {
            C[p][j] /= pivot;
            out[p][j] /= pivot;
        }
        for (int i = 0; i < 6; i++) {
            const double factor = C[i][p];
            for (int j = 0; j < 6 && i != p; j++) {
                C[i][j] -= factor * C[p][j];
                out[i][j] -= factor * out[p][j];
            }
        }
    }
}

static void set_compliance(const sn_net *net, const sn_tissue *tissue, const sn_moduli *moduli,
                           double out[6][6]) {
    double C[6][6] = {{0}};
    if (tissue->law->kind == SN_LAW_SOLID) {
        sn_tissue_stiffness(tissue, net->axes, C);
    } else {
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 3 && i < 3; j++) C[i][j] = moduli->bulk - moduli->shear / 1.5;
            C[i][i] += (i < 3 ? 2.0 : 1.0) * moduli->shear;
        }
    }
    invert(C, out);
}

sn_status sn_net_responses(const sn_net *net, bool held, unsigned tests,
                           double error[SN_RESPONSES]) {
    const sn_tissue *tissue = &net->region[0].tissue;
    const bool turning = tissue->law->fibres && net->cell_axes;
    sn_moduli moduli;
    sn_tissue_moduli(tissue, &moduli);
    if (net->region_count != 1 || tissue->law->fibre_constant || turning || isinf(moduli.bulk))
        return sn_fail(SN_E_UNSUPPORTED,
                       "springs: virtual tests compare with one compressible tissue, alike "
                       "everywhere, whose fibres, if any, carry compression too; %s is not",
                       net->region_count != 1 ? "a body of several" : tissue->name);
    bench b = {.tangent = NULL};
    set_compliance(net, tissue, &moduli, b.compliance);
    sn_status status = open_bench(net, held, &b);
    for (int t = 0; t < SN_RESPONSES; t++) {
        error[t] = NAN;
        if (status != SN_OK || !(tests >> t & 1)) continue;
        error[t] = held ? held_test(&b, t) : free_test(&b, t);
    }
    close_bench(&b);
    return status;
}
