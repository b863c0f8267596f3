// The nonlinear law of calibrated springs, from finite virtual deformations.
// SPDX-License-Identifier: Apache-2.0
//
// Under a deformation F that is the same everywhere a spring of direction n has the stretch
// lambda = |F n|, so that a net stores 1/V sum k L^2 phi(lambda), phi' = t, with x = lambda - 1
//     t = (exp(B x) - 1)/B + x (exp(C_n x^2) - 1)        in tension,
//     t = (lambda - 1/lambda^2)/3 + x (exp(c x^2) - 1)   in compression;
// the volume term adds kappa/2 (J - 1)^2. C_n = n.C n has the axes of the material; it is one
// number for isotropic tissues. Paths are stretching and compressing along x y z with the sides
// free, alike in both directions, and simple shear. B, C, c and a factor on all stiffnesses bring
// the stress closest to the tissue's, each path measured by its largest stress and weighed by what
// the case does; a small price on B, C and c keeps those near 0 that the strain is too small for.
// The least squares are found by Levenberg's and Marquardt's method (MINPACK, by cminpack), from
// the best B alone and from a law of squares alone. The sides of net and tissue find their own
// places: stretched springs pull on the volume too, which no tissue with a deviatoric law does, and
// where kappa is small that shows in the force. Of a uniaxial law only its curve is known,
// stretching, and only B is fitted.
//
// Springs of a lattice enter by their directions; those that differ by a few degrees are taken
// together. Springs that were fitted at every node enter as what they were fitted to: the sum over
// a body that is not straight mixes directions that no point of it has.
#include <cminpack.h>
#include <math.h>
#include <string.h>

#include "compare/calibrate.h"

enum { GRID = 12, BINS = 3 * GRID * GRID, LEVELS = 6, PATHS = 9, VALUES = 6, CALLS = 400 };
#define RESIDUALS (PATHS * LEVELS + PATHS + VALUES)
static const double enough = 1e-9;            // of the sum of squares and of the values
static const double wobble = 1e-10;           // of the residuals: slopes by steps of its root
static const double far_off = 1e3;            // a residual that is none
enum { FACTOR, EXPONENT, UP, DOWN = UP + 3 }; // what is fitted
static const char *const path_name[PATHS] = {"stretch x",  "stretch y",  "stretch z",
                                             "compress x", "compress y", "compress z",
                                             "shear xy",   "shear yz",   "shear zx"};

typedef struct finite_fit {
    int bins;
    double n[BINS][3], weight[BINS]; // k L^2 over the volume
    double square[BINS][3];          // n in the axes of the material, squared
    double axes[9];
    bool oriented;        // C differs by direction
    int from, to;         // of the values that are fitted
    double value[VALUES]; // of the law
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

static void put_direction(finite_fit *f, const double n[3], double weight) {
    for (int d = 0; d < 3; d++) {
        const double *q = f->axes + 3 * d, m = q[0] * n[0] + q[1] * n[1] + q[2] * n[2];
        f->n[f->bins][d] = n[d];
        f->square[f->bins][d] = m * m;
    }
    f->weight[f->bins++] = weight;
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
        const double n[3] = {f->n[b][0] / size, f->n[b][1] / size, f->n[b][2] / size};
        put_direction(
            f, n, total > 0 ? total * f->weight[b] / all : f->weight[b] / sn_mesh_volume(c->mesh));
    }
}

//---- stresses ------------------------------------------------------------------------------------

static double tension(const double *value, const double square[3], double lambda) {
    const double x = lambda - 1, B = value[EXPONENT];
    if (x < 0)
        return (lambda - 1 / (lambda * lambda)) / 3 + x * expm1(fmin(value[DOWN] * x * x, 60));
    double C = 0;
    for (int d = 0; d < 3; d++) C += value[UP + d] * square[d];
    return (fabs(B * x) < 1e-12 ? x : expm1(B * x) / B) + x * expm1(fmin(C * x * x, 60));
}

// diagonal of the nominal stress of springs, and P_ij for shear along i
static void spring_stress(const finite_fit *f, const double F[9], int i, int j, double P[4]) {
    memset(P, 0, 4 * sizeof *P);
    for (int b = 0; b < f->bins; b++) {
        const double *n = f->n[b];
        double x[3], l2 = 0;
        for (int d = 0; d < 3; d++) {
            x[d] = F[3 * d] * n[0] + F[3 * d + 1] * n[1] + F[3 * d + 2] * n[2];
            l2 += x[d] * x[d];
        }
        const double lambda = sqrt(l2);
        const double t = f->weight[b] * tension(f->value, f->square[b], lambda) / lambda;
        for (int d = 0; d < 3; d++) P[d] += t * x[d] * n[d];
        P[3] += t * x[i] * n[j];
    }
}

// the same of a solid law, without its volume stress: P = F Q^T S Q
static void solid_stress(const finite_fit *f, const sn_tissue *t, const double F[9], int i, int j,
                         double P[4]) {
    static const int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double G[9], E[6], S[6]; // G = F Q^T: strain in the axes of the material
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            G[3 * a + b] = 0;
            for (int k = 0; k < 3; k++) G[3 * a + b] += F[3 * a + k] * f->axes[3 * b + k];
        }
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            double C = -(double)(a == b);
            for (int k = 0; k < 3; k++) C += G[3 * k + a] * G[3 * k + b];
            E[at[a][b]] = 0.5 * C;
        }
    sn_law_solid(t->law, t->value, t->terms, 1, E, NULL, S, NULL);
    memset(P, 0, 4 * sizeof *P);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            for (int d = 0; d < 3; d++) P[d] += G[3 * d + a] * S[at[a][b]] * f->axes[3 * b + d];
            P[3] += G[3 * i + a] * S[at[a][b]] * f->axes[3 * b + j];
        }
}

/// A body that is stretched: springs, or a tissue where there is one.
typedef struct stretched {
    const finite_fit *f;
    const sn_tissue *tissue; ///< Nullable
    double factor, bulk;
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
        solid_stress(b->f, b->tissue, F, i, j, P);
    else
        spring_stress(b->f, F, i, j, P);
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

static double sheared(const finite_fit *f, const sn_tissue *tissue, int i, double s) {
    double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, P[4];
    const int j = (i + 1) % 3;
    F[3 * i + j] = s;
    if (tissue)
        solid_stress(f, tissue, F, i, j, P);
    else
        spring_stress(f, F, i, j, P);
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
                *to = p < 6 ? free_stress(&body, p % 3, a, &volume) : sheared(f, t, p % 3, f->s[i]);
            *to += volume;
            f->largest[p] = fmax(f->largest[p], fabs(*to));
        }
    }
}

//---- the fit -------------------------------------------------------------------------------------

// stresses of the net with the values of its law; the volume term has what springs lack
static void set_net(finite_fit *f) {
    const double factor = f->value[FACTOR];
    const stretched net = {
        .f = f, .factor = factor, .bulk = fmax(f->bulk - factor * f->own_bulk, 0.0)};
    for (int p = 0; p < f->path_count; p++)
        for (int i = 0; i < LEVELS; i++) {
            f->volume[p][i] = 0;
            f->net[p][i] = p < 6
                               ? free_stress(&net, p % 3, stretch_of(p, f->s[i]), &f->volume[p][i])
                               : sheared(f, NULL, p % 3, f->s[i]);
        }
}

/// Where each value may be, and the price of it.
typedef struct bound {
    double low, high, price;
} bound;
static const bound bounds[VALUES] = {{0.1, 10, 0},   {-10, 200, 1e-3}, {0, 500, 2e-4},
                                     {0, 500, 2e-4}, {0, 500, 2e-4},   {0, 500, 2e-4}};

// number v of the fit: which value, of an isotropic tissue all three of C
static void set_value(finite_fit *f, int v, double to) {
    static const int alike[] = {FACTOR, EXPONENT, UP, DOWN};
    const int at = f->oriented ? v : alike[v];
    f->value[at] = fmin(fmax(to, bounds[at].low), bounds[at].high);
    if (at == UP && !f->oriented) f->value[UP + 1] = f->value[UP + 2] = f->value[UP];
}

static double get_value(const finite_fit *f, int v) {
    static const int alike[] = {FACTOR, EXPONENT, UP, DOWN};
    return f->value[f->oriented ? v : alike[v]];
}

// Differences over the largest stress of each path; the modulus at rest as one point more of each;
// prices. Returns the sum of their squares.
static double residuals(finite_fit *f, double *r) {
    double sum = 0;
    set_net(f);
    memset(r, 0, RESIDUALS * sizeof *r);
    for (int p = 0; p < f->path_count; p++) {
        const double w = sqrt(f->share[p / 3]);
        for (int i = 0; i < LEVELS; i++)
            r[p * LEVELS + i] =
                w * (f->value[FACTOR] * f->net[p][i] + f->volume[p][i] - f->stress[p][i]) /
                f->largest[p];
        r[PATHS * LEVELS + p] = w * (f->value[FACTOR] - 1);
    }
    for (int v = 0; v < VALUES; v++) r[PATHS * LEVELS + PATHS + v] = bounds[v].price * f->value[v];
    for (int k = 0; k < RESIDUALS; k++) sum += r[k] * r[k];
    return isfinite(sum) ? sum : (double)INFINITY;
}

// as lmdif wants it
static int evaluate(void *context, int residual_count, int count, const double *x, double *r,
                    int what) {
    finite_fit *f = context;
    (void)what;
    for (int v = 0; v < count; v++) set_value(f, f->from + v, x[v]);
    if (!isfinite(residuals(f, r))) // no net: lmdif goes back
        for (int k = 0; k < residual_count; k++) r[k] = far_off;
    return 0;
}

// from the present values, by Levenberg and Marquardt (MINPACK, by cminpack); returns the sum of
// squares that it comes to
static double improve(finite_fit *f) {
    double x[VALUES], r[RESIDUALS], jacobian[VALUES * RESIDUALS];
    double diagonal[VALUES], qtf[VALUES], work[3][VALUES], more[RESIDUALS];
    int pivot[VALUES], calls = 0;
    const int n = f->to - f->from;
    for (int v = 0; v < n; v++) x[v] = get_value(f, f->from + v);
    lmdif(evaluate, f, RESIDUALS, n, x, r, enough, enough, 0.0, CALLS, wobble, diagonal, 1, 1.0, 0,
          &calls, jacobian, RESIDUALS, pivot, qtf, work[0], work[1], work[2], more);
    for (int v = 0; v < n; v++) set_value(f, f->from + v, x[v]);
    return residuals(f, r);
}

// the exponent alone, by a scan
static void scan_exponent(finite_fit *f) {
    double best = 0, least = (double)INFINITY, r[RESIDUALS];
    for (double B = bounds[EXPONENT].low; B <= bounds[EXPONENT].high; B += 2.5) {
        f->value[EXPONENT] = B;
        const double sum = residuals(f, r);
        if (sum < least) {
            least = sum;
            best = B;
        }
    }
    f->value[EXPONENT] = best;
}

static void fit_values(finite_fit *f) {
    static const double squares[VALUES] = {1, 0, 5, 5, 5, 5};
    double best[VALUES];
    scan_exponent(f);
    const double sum = improve(f);
    memcpy(best, f->value, sizeof best);
    if (f->to > UP) {
        memcpy(f->value, squares, sizeof squares);
        if (improve(f) > sum) memcpy(f->value, best, sizeof best);
    }
    set_net(f);
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

// the law that a set has; C of one that was not fitted is 0
static void take_values(const sn_spring_set *set, finite_fit *f) {
    f->value[FACTOR] = 1;
    f->value[EXPONENT] = set->exponent[0];
}

// C = sum of C_a q_a q_a over the axes q of the material
static void give_values(const finite_fit *f, sn_spring_set *set) {
    static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    set->exponent[0] = f->value[EXPONENT];
    for (int k = 0; k < 6; k++) {
        set->square[k] = 0;
        for (int a = 0; a < 3; a++)
            set->square[k] +=
                f->value[UP + a] * f->axes[3 * a + at[k][0]] * f->axes[3 * a + at[k][1]];
    }
    set->square[6] = f->value[DOWN];
    for (int k = 0; k < set->count; k++) set->stiffness[k] *= f->value[FACTOR];
}

sn_status sn_calibration_finite(sn_calibration_body *body, const double *share,
                                sn_calibration_finite_fit fit, sn_calibration_region *region) {
    const sn_tissue *tissue = &body->c->tissue[0];
    const bool full = fit == SN_CALIBRATION_FIT_LAW,
               uniaxial = tissue->law->kind == SN_LAW_UNIAXIAL;
    sn_spring_set *set = body->c->springs_given;
    sn_moduli moduli;
    finite_fit *f = sn_alloc(1, sizeof *f);
    if (!f) return SN_E_MEMORY;
    sn_tissue_moduli(tissue, &moduli);
    sn_case_axes(body->c, f->axes);
    f->oriented = sn_calibration_oriented(tissue);
    f->from = full ? FACTOR : EXPONENT;
    f->to = !full || uniaxial ? UP : f->oriented ? VALUES : VALUES - 2;
    if (full && body->rays > 0)
        for (int k = 0; k < body->rays; k++) put_direction(f, body->ray[k].n, body->ray[k].weight);
    else
        gather_directions(body->c, full ? body->total : 0, f);
    for (int b = 0; b < f->bins; b++) f->own_bulk += f->weight[b] / 9;
    f->bulk = moduli.bulk;
    set_tissue(tissue, region->strain, f);
    memcpy(f->share, share, sizeof f->share);
    take_values(set, f);
    if (fit == SN_CALIBRATION_FIT_NOTHING)
        set_net(f);
    else
        fit_values(f);
    region->factor = f->value[FACTOR];
    region->exponent = f->value[EXPONENT];
    if (fit != SN_CALIBRATION_FIT_NOTHING) give_values(f, set);
    memcpy(region->square, set->square, sizeof region->square);
    note_errors(f, region);
    sn_free(f);
    return isfinite(region->exponent) && region->factor > 0
               ? SN_OK
               : sn_fail(SN_E_UNSUPPORTED,
                         "tissue %s: no spring law follows its stress up to a strain of %g; use "
                         "the coupled rung",
                         tissue->name, region->strain);
}
