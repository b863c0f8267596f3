// The elastic tensor that springs can give a tissue, and constants by direction.
// SPDX-License-Identifier: Apache-2.0
// Source: Cauchy-Born rule; the solver of the nonnegative least squares as in calibrate_fit.c.
//
// Springs of direction n that hold the part w of k L^2 per volume have the tensor w nnnn; with the
// volume term, which brings what they lack of the bulk modulus K, the net has
//     sum w (n n n n - d d / 9) + K d d,
// which should be the tissue's C = D + K d d. Weights w >= 0 bring the first sum closest to D in
// the sense of least squares of L^-1 (.) L^-T, C = L L^T: errors count by what they change of the
// energy of a strain, those that only a change of volume feels by little. What springs cannot carry
// whatever their weights is the part of D that is not symmetric in all four indices (but for
// multiples of d d), and what would need negative ones.
//
// On a lattice every node has a spring and its mirror image, so that springs may have any constants
// by direction and still be in balance under even strain: the constants of the isotropic net get a
// factor by direction. On other meshes the fit at the nodes aims at the tensor found here.
#include <math.h>
#include <string.h>

#include "compare/calibrate.h"

enum { MOST = SN_CALIBRATION_RAYS, SWEEPS = 20000 };
static const int grid = 6;           // 3 grid^2 = MOST
static const double settled = 1e-11; // largest step of a sweep, of the shear modulus

/// Springs of one direction.
typedef struct ray {
    double n[3];
    double share;     ///< of k L^2 over the volume in the isotropic net of shear modulus 1
    double weight;    ///< w / share
    double column[6]; ///< L^-1 v, v v^T = n n n n: squares once, products by sqrt 2
    double norm;
} ray;

typedef struct tensor_fit {
    double L[6][6], d[6]; // of C; L^-1 of the unit tensor
    double left[6][6];    // L^-1 (D - sum) L^-T
    double size;          // of the first, squared
    int count;
    ray ray[MOST];
} tensor_fit;

bool sn_calibration_oriented(const sn_tissue *t) {
    return t->law->fibres && !t->law->fibre_constant;
}

//---- the metric ----------------------------------------------------------------------------------

static void lower_solve(double L[6][6], double v[6]) {
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < i; k++) v[i] -= L[i][k] * v[k];
        v[i] /= L[i][i];
    }
}

// L of C, and L^-1 D L^-T
static void set_metric(const sn_calibration_body *body, tensor_fit *f) {
    const double root = sqrt(2.0);
    const sn_tissue *tissue = &body->c->tissue[0];
    double axes[9], C[6][6] = {{0}};
    sn_moduli moduli;
    sn_case_axes(body->c, axes);
    sn_tissue_moduli(tissue, &moduli);
    for (int i = 0; i < 6; i++) { // isotropic
        for (int j = 0; j < 3 && i < 3; j++) C[i][j] = moduli.bulk - 2.0 / 3.0 * moduli.shear;
        C[i][i] += (i < 3 ? 2 : 1) * moduli.shear;
    }
    if (sn_calibration_oriented(tissue)) sn_tissue_stiffness(tissue, axes, C);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            C[i][j] *= (i < 3 ? 1.0 : root) * (j < 3 ? 1.0 : root);
            f->left[i][j] = C[i][j] - (i < 3 && j < 3 ? moduli.bulk : 0.0);
        }
    for (int j = 0; j < 6; j++)
        for (int i = j; i < 6; i++) {
            double sum = C[i][j];
            for (int k = 0; k < j; k++) sum -= f->L[i][k] * f->L[j][k];
            f->L[i][j] = i == j ? sqrt(fmax(sum, 1e-12 * C[i][i])) : sum / f->L[j][j];
        }
    for (int turn = 0; turn < 2; turn++) // from the left; transposed, from the right
        for (int j = 0; j < 6; j++) {
            double v[6];
            for (int i = 0; i < 6; i++) v[i] = f->left[turn ? j : i][turn ? i : j];
            lower_solve(f->L, v);
            for (int i = 0; i < 6; i++) f->left[turn ? j : i][turn ? i : j] = v[i];
        }
    for (int i = 0; i < 6; i++) f->d[i] = i < 3;
    lower_solve(f->L, f->d);
    for (int i = 0; i < 36; i++) f->size += f->left[i / 6][i % 6] * f->left[i / 6][i % 6];
}

static void finish_ray(tensor_fit *f, ray *r) {
    double vv = 0, vd = 0, dd = 0;
    for (int i = 0; i < 6; i++)
        r->column[i] = i < 3 ? r->n[i] * r->n[i] : sqrt(2.0) * r->n[i - 3] * r->n[(i - 2) % 3];
    lower_solve(f->L, r->column);
    for (int i = 0; i < 6; i++) {
        vv += r->column[i] * r->column[i];
        vd += r->column[i] * f->d[i];
        dd += f->d[i] * f->d[i];
    }
    r->norm = vv * vv - 2.0 / 9.0 * vd * vd + dd * dd / 81.0;
}

// takes `step` of a ray's tensor from what is left
static void take(tensor_fit *f, const ray *r, double step) {
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            f->left[i][j] -= step * (r->column[i] * r->column[j] - f->d[i] * f->d[j] / 9.0);
}

static double along(const tensor_fit *f, const ray *r) {
    double sum = 0;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            sum += f->left[i][j] * (r->column[i] * r->column[j] - f->d[i] * f->d[j] / 9.0);
    return sum;
}

// starts at the isotropic net of the shear modulus, so that it stays what it is where it may
static double descend(tensor_fit *f, double shear) {
    double rest = 0;
    for (int k = 0; k < f->count; k++) {
        f->ray[k].weight = shear;
        take(f, &f->ray[k], shear * f->ray[k].share);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double change = 0;
        for (int k = 0; k < f->count; k++) {
            ray *r = &f->ray[k];
            const double step = fmax(along(f, r) / r->norm / r->share, -r->weight);
            take(f, r, step * r->share);
            r->weight += step;
            change = fmax(change, fabs(step));
        }
        if (change < settled * shear) break;
    }
    for (int i = 0; i < 36; i++) rest += f->left[i / 6][i % 6] * f->left[i / 6][i % 6];
    return sqrt(rest / f->size);
}

//---- constants by direction ----------------------------------------------------------------------

static int find_ray(const tensor_fit *f, const double n[3]) {
    for (int k = 0; k < f->count; k++) {
        const double *m = f->ray[k].n;
        if (fabs(n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) > 1 - 1e-7) return k;
    }
    return -1;
}

static double direction(const sn_mesh *mesh, const int end[2], double n[3]) {
    double L2 = 0;
    for (int d = 0; d < 3; d++) {
        n[d] =
            mesh->node[3 * (size_t)end[1] + (size_t)d] - mesh->node[3 * (size_t)end[0] + (size_t)d];
        L2 += n[d] * n[d];
    }
    for (int d = 0; d < 3; d++) n[d] /= sqrt(L2);
    return L2;
}

sn_status sn_calibration_classes(sn_calibration_body *body, double *left) {
    const sn_mesh *mesh = body->c->mesh;
    sn_spring_set *set = body->c->springs_given; // of shear modulus 1
    const double volume = sn_mesh_volume(mesh);
    sn_moduli moduli;
    tensor_fit *f = sn_alloc(1, sizeof *f);
    if (!f) return SN_E_MEMORY;
    sn_tissue_moduli(&body->c->tissue[0], &moduli);
    set_metric(body, f);
    for (int k = 0; k < set->count; k++) {
        double n[3];
        const double L2 = direction(mesh, set->end + 2 * (size_t)k, n);
        int at = find_ray(f, n);
        if (at < 0) {
            SN_ASSERT(f->count < MOST); // a lattice has 13
            at = f->count++;
            memcpy(f->ray[at].n, n, sizeof n);
        }
        f->ray[at].share += set->stiffness[k] * L2 / volume;
    }
    for (int k = 0; k < f->count; k++) finish_ray(f, &f->ray[k]);
    *left = descend(f, moduli.shear);
    for (int k = 0; k < set->count; k++) {
        double n[3];
        direction(mesh, set->end + 2 * (size_t)k, n);
        set->stiffness[k] *= f->ray[find_ray(f, n)].weight;
    }
    sn_free(f);
    return SN_OK;
}

//---- the tensor of springs of all directions -----------------------------------------------------

// even over the faces of a cube; of k L^2 over the volume 15 in all
static void even_rays(tensor_fit *f) {
    double all = 0;
    for (int k = 0; k < MOST; k++) {
        const int axis = k / (grid * grid);
        ray *r = &f->ray[f->count++];
        r->n[axis] = 1;
        r->n[(axis + 1) % 3] = (k / grid % grid + 0.5) * 2 / grid - 1;
        r->n[(axis + 2) % 3] = (k % grid + 0.5) * 2 / grid - 1;
        const double size = sqrt(r->n[0] * r->n[0] + r->n[1] * r->n[1] + r->n[2] * r->n[2]);
        for (int d = 0; d < 3; d++) r->n[d] /= size;
        r->share = 1 / (size * size * size);
        all += r->share;
        finish_ray(f, r);
    }
    for (int k = 0; k < MOST; k++) f->ray[k].share *= 15 / all;
}

sn_status sn_calibration_target(sn_calibration_body *body, double K[3][3][3][3]) {
    sn_moduli moduli;
    tensor_fit *f = sn_alloc(1, sizeof *f);
    if (!f) return SN_E_MEMORY;
    memset(K, 0, 81 * sizeof(double));
    sn_tissue_moduli(&body->c->tissue[0], &moduli);
    set_metric(body, f);
    even_rays(f);
    descend(f, moduli.shear);
    body->total = 0;
    body->rays = MOST;
    for (int k = 0; k < MOST; k++) {
        const double *n = f->ray[k].n, w = f->ray[k].share * f->ray[k].weight;
        for (int i = 0; i < 81; i++)
            K[i / 27][i / 9 % 3][i / 3 % 3][i % 3] +=
                w * n[i / 27] * n[i / 9 % 3] * n[i / 3 % 3] * n[i % 3];
        memcpy(body->ray[k].n, n, sizeof body->ray[k].n);
        body->ray[k].weight = w;
        body->total += w;
    }
    sn_free(f);
    return SN_OK;
}
