// Stresses of a tissue along a recorded biaxial or shear curve.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); S = H[S_d] - p C^-1, H the hereditary integral, J = 1.
//
// Both motions are known, so there is nothing to solve. Solid: the free thickness, S33 = 0, gives
// p = l3^2 H[S33], l3 = 1/(l1 l2). Membrane: its energy knows the thickness, there is no p.
//     biaxial   T_i = l_i H[S_ii] - l3^2 H[S33]/l_i (solid),   T_i = l_i H[S_ii] (membrane)
//     shear g   T_12 = H[S12] + g H[S22]            (both: p drops out)
//
// Recorded stretches are noisy and turn at every row, so a channel f = S_ij has a corner at every
// row, and its rate is taken from its values: stretches are straight between two rows; over a part
// of h seconds f is the parabola through its start f0, middle fm and end f1, its rate the line from
// r0 = (-3 f0 + 4 fm - f1)/h to r1 = (f0 - 4 fm + 3 f1)/h, and the share of an exponential obeys
//     H <- exp(-x) H + g h (r1 M0 + (r0 - r1) M1),    x = h/tau,  M_k = int_0^1 u^k exp(-x u) du
// exactly for that line: fourth order in h for x small, and no order lost where x is large.
#include "lab/fit/in_plane.h"

#include <math.h>

static const double parts_over_reach = 48.0; // of the largest distance from rest
enum { CHANNELS_MAX = 3 };

struct sn_in_plane {
    const sn_curve *curve;
    bool membrane, shear;
    int points;
    int *first;   // point of a row; its parts follow, middle and end of each     (rows)
    double *time; // of the rows                                                  (rows)
    double *E;    // as the law wants it                                 (3 or 6 x points)
};

// distance of two rows
static double apart(const sn_curve *c, int i, int k) {
    double d = fabs(c->stretch[i] - c->stretch[k]);
    return c->stretch_2 ? fmax(d, fabs(c->stretch_2[i] - c->stretch_2[k])) : d;
}

static double reach(const sn_curve *c) {
    double most = 0.0, rest = c->kind == SN_CURVE_SHEAR ? 0.0 : 1.0;
    for (int i = 0; i < c->count; ++i) {
        most = fmax(most, fabs(c->stretch[i] - rest));
        if (c->stretch_2) most = fmax(most, fabs(c->stretch_2[i] - rest));
    }
    return most;
}

sn_status sn_in_plane_check(const sn_tissue *tissue, const sn_curve *curve) {
    const sn_law *law = tissue->law;
    const char *kind = sn_curve_kind_name(curve->kind);
    if (law->kind == SN_LAW_UNIAXIAL)
        return sn_fail(SN_E_UNSUPPORTED,
                       "%s: a %s curve, and law %s is uniaxial: expected a membrane or a solid law",
                       curve->name, kind, law->name);
    if (law->kind == SN_LAW_MEMBRANE) return SN_OK;
    sn_moduli moduli;
    law->moduli(tissue->value, tissue->terms, &moduli);
    if (!isfinite(moduli.bulk)) return SN_OK; // of constants not yet set: not a number
    return sn_fail(SN_E_UNSUPPORTED,
                   "%s: a %s curve of law %s with a finite bulk modulus: expected "
                   "bulk_modulus: incompressible",
                   curve->name, kind, law->name);
}

// the strain at a point between row i and the next
static void strain_at(const sn_in_plane *p, int i, double part, int point) {
    const sn_curve *c = p->curve;
    int next = part > 0.0 ? i + 1 : i;
    size_t n = (size_t)p->points, at = (size_t)point;
    double x = c->stretch[i] + part * (c->stretch[next] - c->stretch[i]);
    if (p->shear) {
        p->E[n + at] = 0.5 * x * x;
        p->E[(p->membrane ? 2 : 3) * n + at] = 0.5 * x;
        return;
    }
    double y = c->stretch_2[i] + part * (c->stretch_2[next] - c->stretch_2[i]), z = 1.0 / (x * y);
    p->E[at] = 0.5 * (x - 1.0) * (x + 1.0);
    p->E[n + at] = 0.5 * (y - 1.0) * (y + 1.0);
    if (!p->membrane) p->E[2 * n + at] = 0.5 * (z - 1.0) * (z + 1.0);
}

sn_status sn_in_plane_create(const sn_curve *curve, const double *time, const sn_law *law,
                             bool memory, sn_in_plane **path) {
    *path = NULL;
    sn_in_plane *p = sn_alloc(1, sizeof *p);
    if (!p) return SN_E_MEMORY;
    p->curve = curve;
    p->membrane = law->kind == SN_LAW_MEMBRANE;
    p->shear = curve->kind == SN_CURVE_SHEAR;
    p->first = sn_alloc((size_t)curve->count, sizeof *p->first);
    p->time = sn_alloc((size_t)curve->count, sizeof *p->time);
    if (!p->first || !p->time) goto fail;
    double most = reach(curve);
    p->points = 1;
    for (int i = 0; i < curve->count; ++i) {
        p->time[i] = time[i];
        p->first[i] = p->points - 1;
        if (i + 1 == curve->count) break;
        double parts = most > 0.0 ? ceil(parts_over_reach * apart(curve, i, i + 1) / most) : 1.0;
        p->points += memory ? 2 * (int)fmax(1.0, parts) : 1;
    }
    p->E = sn_alloc((p->membrane ? 3 : 6) * (size_t)p->points, sizeof *p->E);
    if (!p->E) goto fail;
    for (int i = 0; i < curve->count; ++i) {
        int steps = i + 1 < curve->count ? p->first[i + 1] - p->first[i] : 1;
        for (int j = 0; j < steps; ++j) strain_at(p, i, (double)j / steps, p->first[i] + j);
    }
    *path = p;
    return SN_OK;
fail:
    sn_in_plane_destroy(p);
    return SN_E_MEMORY;
}

void sn_in_plane_destroy(sn_in_plane *path) {
    if (!path) return;
    sn_free(path->first);
    sn_free(path->time);
    sn_free(path->E);
    sn_free(path);
}

// what a part of h seconds does to the share of every exponential
typedef struct weights {
    double decay[SN_TERMS_MAX], start[SN_TERMS_MAX], end[SN_TERMS_MAX]; // of r0 h and r1 h
} weights;

static void part_weights(const sn_exponentials *e, double h, weights *w) {
    for (int i = 0; i < e->terms; ++i) {
        double x = h / e->tau[i], decay = exp(-x), m0, m1;
        if (x < 1e-2) { // the closed form cancels; what is left out is x^4/144, under 1e-10
            m1 = 0.5 - x * (1.0 / 3.0 - x * (0.125 - x / 30.0));
            m0 = x * m1 + decay;
        } else {
            m0 = -expm1(-x) / x;
            m1 = (m0 - decay) / x;
        }
        w->decay[i] = decay;
        w->start[i] = e->g[i] * m1;
        w->end[i] = e->g[i] * (m0 - m1);
    }
}

// H[f] at the rows from f at the points
static void hereditary(const sn_in_plane *p, const sn_exponentials *e, const double *f,
                       double *out) {
    double H[SN_TERMS_MAX];
    weights w;
    out[0] = f[0]; // a step from rest: G(0) = 1
    for (int i = 0; i < e->terms; ++i) H[i] = e->g[i] * f[0];
    for (int k = 0; k + 1 < p->curve->count; ++k) {
        int steps = p->first[k + 1] - p->first[k], parts = steps / 2;
        double h = (p->time[k + 1] - p->time[k]) / fmax(parts, 1.0), last = 0.0;
        const double *v = f + p->first[k];
        if (e->terms > 0) part_weights(e, h, &w);
        for (int j = 0; j < parts; ++j, v += 2) {
            double r0 = 4.0 * (v[1] - v[0]) - (v[2] - v[0]);
            last = 3.0 * (v[2] - v[0]) - 4.0 * (v[1] - v[0]);
            for (int i = 0; i < e->terms; ++i)
                H[i] = w.decay[i] * H[i] + w.start[i] * r0 + w.end[i] * last;
        }
        out[k + 1] = e->g_inf * f[p->first[k + 1]] + e->viscous * last / h;
        for (int i = 0; i < e->terms; ++i) out[k + 1] += H[i];
    }
}

// the elastic channels at the points: biaxial S11 S22 (S33), shear S22 S12
static void channels(const sn_in_plane *p, const sn_tissue *t, double *S) {
    if (p->membrane)
        sn_law_membrane(t->law, t->value, t->terms, p->points, p->E, NULL, S, NULL);
    else
        sn_law_solid(t->law, t->value, t->terms, p->points, p->E, NULL, S, NULL);
}

static void assemble(const sn_in_plane *p, const double *H, double *stress) {
    const sn_curve *c = p->curve;
    size_t n = (size_t)c->count;
    for (size_t i = 0; i < n; ++i) {
        double x = c->stretch[i];
        if (p->shear) {
            stress[i] = H[n + i] + x * H[i];
            continue;
        }
        double y = c->stretch_2[i], z = 1.0 / (x * y);
        double pressure = p->membrane ? 0.0 : z * z * H[2 * n + i];
        stress[i] = x * H[i] - pressure / x;
        stress[n + i] = y * H[n + i] - pressure / y;
    }
}

sn_status sn_in_plane_stress(const sn_in_plane *path, const sn_tissue *tissue,
                             const sn_exponentials *e, double *stress) {
    static const size_t biaxial[] = {0, 1, 2}, sheared_solid[] = {1, 3}, sheared_sheet[] = {1, 2};
    const size_t *component = !path->shear     ? biaxial
                              : path->membrane ? sheared_sheet
                                               : sheared_solid;
    const sn_curve *c = path->curve;
    bool at_rest =
        c->stretch[0] == (path->shear ? 0.0 : 1.0) && (!c->stretch_2 || c->stretch_2[0] == 1.0);
    if (e->viscous > 0.0 && !at_rest)
        return sn_fail(SN_E_RANGE, "%s: a step at its start under memory %s has infinite stress",
                       c->name, tissue->memory.law->name);
    size_t n = (size_t)path->points, rows = (size_t)c->count;
    int count = path->shear || path->membrane ? 2 : 3;
    double *S = sn_alloc((path->membrane ? 3 : 6) * n + CHANNELS_MAX * rows, sizeof *S);
    if (!S) return SN_E_MEMORY;
    double *H = S + (path->membrane ? 3 : 6) * n;
    channels(path, tissue, S);
    for (int a = 0; a < count; ++a) hereditary(path, e, S + component[a] * n, H + (size_t)a * rows);
    assemble(path, H, stress);
    sn_free(S);
    return SN_OK;
}
