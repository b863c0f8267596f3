// The nonlinear law of calibrated springs, from finite virtual deformations.
// SPDX-License-Identifier: Apache-2.0
//
// Under a deformation F that is the same everywhere a spring of direction n has the stretch
// lambda = |F n|, so that a net stores 1/V sum k L^2 phi(lambda), phi' = t: (exp(B x) - 1)/B in
// tension, x = lambda - 1, and (lambda - 1/lambda^2)/3 in compression; the volume term adds kappa/2
// (J - 1)^2. Paths are stretching and compressing along x y z with the sides free, and simple
// shear. B and a factor on all stiffnesses bring the stress closest to the tissue's, each path
// measured by its largest stress and weighed by what the case does. The sides of net and tissue
// find their own places: stretched springs pull on the volume too, which no tissue with a
// deviatoric law does, and where kappa is small that shows in the force. Of a uniaxial law only its
// curve is known: stretching.
//
// Springs enter by their directions only; those that differ by a few degrees are taken together.
#include <math.h>
#include <string.h>

#include "compare/calibrate.h"

enum { GRID = 12, BINS = 3 * GRID * GRID, LEVELS = 6, PATHS = 9, FACTORS = 3 };
static const char *const path_name[PATHS] = {"stretch x",  "stretch y",  "stretch z",
                                             "compress x", "compress y", "compress z",
                                             "shear xy",   "shear yz",   "shear zx"};

typedef struct finite_fit {
    int bins;
    double n[BINS][3], weight[BINS]; // k L^2 over the volume
    int path_count;
    double share[SN_CALIBRATION_KINDS];               // weights of three paths each
    double s[LEVELS];                                 // strains
    double bulk, own_bulk;                            // of the tissue, of the springs
    double stress[PATHS][LEVELS], largest[PATHS];     // of the tissue
    double net[PATHS][LEVELS], volume[PATHS][LEVELS]; // of the springs, of the volume term
} finite_fit;

//---- directions ----------------------------------------------------------------------------------

static int bin_of(const double n[3]) {
    int axis = 0;
    for (int d = 1; d < 3; d++)
        if (fabs(n[d]) > fabs(n[axis])) axis = d;
    int at[2];
    for (int k = 0; k < 2; k++) {
        const double x = n[(axis + 1 + k) % 3] / n[axis]; // of either sense
        const int cell = (int)floor((0.5 + 0.5 * x) * GRID);
        at[k] = cell < 0 ? 0 : cell >= GRID ? GRID - 1 : cell;
    }
    return (axis * GRID + at[0]) * GRID + at[1];
}

// Weights add up to `total`; 0: to what they are.
static void gather_directions(const sn_case *c, double total, finite_fit *f) {
    const sn_spring_set *set = c->springs_given;
    double all = 0;
    memset(f->n, 0, sizeof f->n);
    memset(f->weight, 0, sizeof f->weight);
    for (int k = 0; k < set->count; k++) {
        double D[3], L2 = 0;
        for (int d = 0; d < 3; d++) {
            D[d] =
                c->mesh->node[3 * set->end[2 * k + 1] + d] - c->mesh->node[3 * set->end[2 * k] + d];
            L2 += D[d] * D[d];
        }
        const int bin = bin_of(D);
        const double w = set->stiffness[k] * L2;
        double along = 0;
        for (int d = 0; d < 3; d++) along += D[d] * f->n[bin][d];
        for (int d = 0; d < 3; d++) f->n[bin][d] += (along < 0 ? -w : w) * D[d] / sqrt(L2);
        f->weight[bin] += w;
        all += w;
    }
    f->bins = 0;
    for (int b = 0; b < BINS; b++) {
        double size =
            sqrt(f->n[b][0] * f->n[b][0] + f->n[b][1] * f->n[b][1] + f->n[b][2] * f->n[b][2]);
        if (!(f->weight[b] > 0) || !(size > 0)) continue;
        for (int d = 0; d < 3; d++) f->n[f->bins][d] = f->n[b][d] / size;
        f->weight[f->bins++] =
            total > 0 ? total * f->weight[b] / all : f->weight[b] / sn_mesh_volume(c->mesh);
    }
}

//---- stresses ------------------------------------------------------------------------------------

static double tension(double B, double lambda) {
    const double x = lambda - 1;
    if (x < 0) return (lambda - 1 / (lambda * lambda)) / 3;
    return fabs(B * x) < 1e-12 ? x : expm1(B * x) / B;
}

// diagonal of the nominal stress of springs, and P_ij for shear along i
static void spring_stress(const finite_fit *f, double B, const double F[9], int i, int j,
                          double P[4]) {
    memset(P, 0, 4 * sizeof *P);
    for (int b = 0; b < f->bins; b++) {
        const double *n = f->n[b];
        double x[3], l2 = 0;
        for (int d = 0; d < 3; d++) {
            x[d] = F[3 * d] * n[0] + F[3 * d + 1] * n[1] + F[3 * d + 2] * n[2];
            l2 += x[d] * x[d];
        }
        const double lambda = sqrt(l2), t = f->weight[b] * tension(B, lambda) / lambda;
        for (int d = 0; d < 3; d++) P[d] += t * x[d] * n[d];
        P[3] += t * x[i] * n[j];
    }
}

// the same of a solid law, without its volume stress: P = F S
static void solid_stress(const sn_tissue *t, const double F[9], int i, int j, double P[4]) {
    static const int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double E[6], S[6];
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            double C = -(double)(a == b);
            for (int k = 0; k < 3; k++) C += F[3 * k + a] * F[3 * k + b];
            E[at[a][b]] = 0.5 * C;
        }
    sn_law_solid(t->law, t->value, t->terms, 1, E, NULL, S, NULL);
    memset(P, 0, 4 * sizeof *P);
    for (int k = 0; k < 3; k++) {
        for (int d = 0; d < 3; d++) P[d] += F[3 * d + k] * S[at[k][d]];
        P[3] += F[3 * i + k] * S[at[k][j]];
    }
}

/// A body that is stretched: springs, or a tissue where there is one.
typedef struct stretched {
    const finite_fit *f;
    const sn_tissue *tissue; ///< Nullable
    double B, factor, bulk;
} stretched;

// Nominal stress along axis i at the stretch a with sides of stretch l; *side that across, *volume
// the part of the volume term.
static double stress_at(const stretched *b, int i, double a, double l, double *side,
                        double *volume) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double pull = b->bulk * (a * l * l - 1);
    double F[9] = {0}, P[4];
    F[4 * i] = a;
    F[4 * j] = F[4 * k] = l;
    if (b->tissue)
        solid_stress(b->tissue, F, i, j, P);
    else
        spring_stress(b->f, b->B, F, i, j, P);
    *side = b->factor * 0.5 * (P[j] + P[k]) + pull * a * l;
    *volume = pull * l * l;
    return P[i];
}

// the sides free: by the rule of false position with secants
static double free_stress(const stretched *b, int i, double a, double *volume) {
    double l = 1 / sqrt(a), before, side, stress = stress_at(b, i, a, l, &before, volume);
    double last = l;
    l *= 1 - 1e-3;
    for (int turn = 0; turn < 20; turn++) {
        stress = stress_at(b, i, a, l, &side, volume);
        if (side == before) break;
        const double next = l - side * (l - last) / (side - before);
        last = l;
        before = side;
        l = fmin(fmax(next, 0.8 * last), 1.25 * last);
        if (fabs(l - last) < 1e-8) break;
    }
    return stress;
}

static double stretch_of(int path, double s) {
    return path < 3 ? 1 + s : 1 / (1 + s);
}

static double sheared(const finite_fit *f, const sn_tissue *tissue, double B, int i, double s) {
    double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, P[4];
    const int j = (i + 1) % 3;
    F[3 * i + j] = s;
    if (tissue)
        solid_stress(tissue, F, i, j, P);
    else
        spring_stress(f, B, F, i, j, P);
    return P[3];
}

static void set_tissue(const sn_tissue *t, double strain, finite_fit *f) {
    const bool uniaxial = t->law->kind == SN_LAW_UNIAXIAL;
    const stretched body = {.f = f, .tissue = t, .factor = 1, .bulk = f->bulk};
    f->path_count = uniaxial ? 3 : PATHS;
    for (int i = 0; i < LEVELS; i++) f->s[i] = strain * (i + 1) / LEVELS;
    for (int p = 0; p < f->path_count; p++) {
        f->largest[p] = 0;
        for (int i = 0; i < LEVELS; i++) {
            const double a = stretch_of(p, f->s[i]);
            double volume = 0, *to = &f->stress[p][i];
            if (uniaxial)
                sn_law_uniaxial(t->law, t->value, t->terms, 1, &a, NULL, to, NULL);
            else
                *to = p < 6 ? free_stress(&body, p % 3, a, &volume)
                            : sheared(f, t, 0, p % 3, f->s[i]);
            *to += volume;
            f->largest[p] = fmax(f->largest[p], fabs(*to));
        }
    }
}

//---- the fit -------------------------------------------------------------------------------------

// stresses of the net with a factor on its springs; the volume term has what they lack
static void set_net(finite_fit *f, double B, double factor) {
    const stretched net = {
        .f = f, .B = B, .factor = factor, .bulk = fmax(f->bulk - factor * f->own_bulk, 0.0)};
    for (int p = 0; p < f->path_count; p++)
        for (int i = 0; i < LEVELS; i++) {
            f->volume[p][i] = 0;
            f->net[p][i] = p < 6
                               ? free_stress(&net, p % 3, stretch_of(p, f->s[i]), &f->volume[p][i])
                               : sheared(f, NULL, B, p % 3, f->s[i]);
        }
}

// with the slope at rest as a point of each path: the factor is its error
static double sum_squares(const finite_fit *f, double factor) {
    double sum = 0;
    for (int p = 0; p < f->path_count; p++)
        for (int i = 0; i < LEVELS; i++) {
            const double r = factor * f->net[p][i] + f->volume[p][i] - f->stress[p][i];
            sum += f->share[p / 3] * r * r / (f->largest[p] * f->largest[p]);
        }
    for (int p = 0; p < f->path_count; p++) sum += f->share[p / 3] * (factor - 1) * (factor - 1);
    return sum;
}

// Sum of squares over the paths, each over its largest stress, with the modulus at rest as one
// point more of each; *factor gets the best one, which the sides depend on.
static double misfit(finite_fit *f, double B, double *factor) {
    *factor = 1;
    for (int turn = 0; turn < FACTORS; turn++) {
        double top = 0, bottom = 0;
        set_net(f, B, *factor);
        for (int p = 0; p < f->path_count; p++)
            for (int i = 0; i < LEVELS; i++) {
                const double w = f->share[p / 3] / (f->largest[p] * f->largest[p]);
                top += w * f->net[p][i] * (f->stress[p][i] - f->volume[p][i]);
                bottom += w * f->net[p][i] * f->net[p][i];
            }
        for (int p = 0; p < f->path_count; p++) {
            top += f->share[p / 3];
            bottom += f->share[p / 3];
        }
        *factor = fmin(fmax(top / bottom, 0.1), 10);
    }
    const double sum = sum_squares(f, *factor);
    return isfinite(sum) ? sum : (double)INFINITY;
}

// a scan finds the valley, golden section its bottom
static double best_exponent(finite_fit *f, double *factor) {
    const double low = -10, high = 200, width = 2.5, golden = 0.61803398874989485;
    double best = low, least = (double)INFINITY, unused;
    for (double B = low; B <= high; B += width) {
        const double m = misfit(f, B, &unused);
        if (m < least) {
            least = m;
            best = B;
        }
    }
    double a = best - width, b = best + width;
    while (b - a > 1e-6 * (1 + fabs(a))) {
        const double left = b - golden * (b - a), right = a + golden * (b - a);
        if (misfit(f, left, &unused) < misfit(f, right, &unused))
            b = right;
        else
            a = left;
    }
    misfit(f, 0.5 * (a + b), factor);
    set_net(f, 0.5 * (a + b), *factor);
    return 0.5 * (a + b);
}

static void note_errors(const finite_fit *f, sn_calibration_region *region) {
    for (int p = 0; p < f->path_count; p++) {
        double sum = 0;
        for (int i = 0; i < LEVELS; i++) {
            const double r = region->factor * f->net[p][i] + f->volume[p][i] - f->stress[p][i];
            sum += r * r / (f->largest[p] * f->largest[p]) / LEVELS;
        }
        sn_calibration_note(region, sqrt(sum), "finite, %s", path_name[p]);
    }
}

sn_status sn_calibration_finite(sn_calibration_body *body, const double *share, bool fit,
                                sn_calibration_region *region) {
    const sn_tissue *tissue = &body->c->tissue[0];
    sn_spring_set *set = body->c->springs_given;
    sn_moduli moduli;
    finite_fit *f = sn_alloc(1, sizeof *f);
    if (!f) return SN_E_MEMORY;
    sn_tissue_moduli(tissue, &moduli);
    gather_directions(body->c, fit ? 15 * moduli.shear : 0, f); // less what relaxes
    for (int b = 0; b < f->bins; b++) f->own_bulk += f->weight[b] / 9;
    f->bulk = moduli.bulk;
    set_tissue(tissue, region->strain, f);
    memcpy(f->share, share, sizeof f->share);
    region->factor = 1;
    if (fit) {
        set->exponent[0] = best_exponent(f, &region->factor);
        for (int k = 0; k < set->count; k++) set->stiffness[k] *= region->factor;
    } else {
        set_net(f, set->exponent[0], 1);
    }
    region->exponent = set->exponent[0];
    note_errors(f, region);
    sn_free(f);
    return isfinite(region->exponent) && region->factor > 0
               ? SN_OK
               : sn_fail(SN_E_UNSUPPORTED,
                         "tissue %s: no spring law follows its stress up to a strain of %g; use "
                         "the coupled rung",
                         tissue->name, region->strain);
}
