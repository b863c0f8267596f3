// What a fit must know of the constants of Fung's laws: convexity, and shears that no curve sees.
// SPDX-License-Identifier: Apache-2.0
// Source: law/orthotropic.h and law/membrane.h for the conditions: the matrix of the constants of
// the normal strains is positive definite, shears are positive.
//
// Bounds keep normal constants and shears positive. The cross constants have no box that is both
// safe and wide enough, so a trial outside the cone is pulled straight towards its axis, the
// diagonal matrix, to just inside the cone.
#include "lab/fit/fung.h"

#include <math.h>
#include <string.h>

static const double inside = 1.0 - 1e-6; // of the factor that makes the matrix singular

static const struct {
    const char *law;
    int count;
    sn_fung_form form[2];
} table[] = {
    {"fung", 1, {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}}},
    {"fung-general",
     2,
     {{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}, {{10, 11, 12}, {13, 14, 15}, {16, 17, 18}}}},
    {"fung-planar", 1, {{{1, 2, -1}, {4, -1, -1}, {3, -1, -1}}}},
    {"fung-skin",
     2,
     {{{0, 1, -1}, {3, -1, -1}, {2, -1, -1}}, {{5, 6, -1}, {8, -1, -1}, {7, -1, -1}}}},
};
enum { TABLE = sizeof table / sizeof *table, GUCCIONE_BF = 1, GUCCIONE_BT, GUCCIONE_BFS };

int sn_fung_forms(const sn_law *law, const sn_fung_form **forms) {
    for (int k = 0; k < TABLE; ++k) {
        if (strcmp(law->name, table[k].law) != 0) continue;
        *forms = table[k].form;
        return table[k].count;
    }
    *forms = NULL;
    return 0;
}

// determinants of the leading minors with the cross constants, relative to their normal constants,
// each times its factor: all above 0?
static bool definite(const double r[3], const double factor[3]) {
    double a = factor[0] * r[0], b = factor[1] * r[1], c = factor[2] * r[2];
    return 1.0 - a * a > 0.0 && 1.0 - a * a - b * b - c * c + 2.0 * a * b * c > 0.0;
}

static bool definite_at(const double r[3], const bool held[3], double t) {
    double factor[3];
    for (int i = 0; i < 3; ++i) factor[i] = held[i] ? 1.0 : t;
    return definite(r, factor);
}

static double shrink(const sn_fung_form *f, const bool *is_held, double *value) {
    double normal[3], r[3];
    bool held[3];
    for (int i = 0; i < 3; ++i) normal[i] = f->normal[i] < 0 ? 1.0 : value[f->normal[i]];
    for (int i = 0; i < 3; ++i) {
        double size = sqrt(normal[i] * normal[(i + 1) % 3]);
        r[i] = f->cross[i] < 0 ? 0.0 : value[f->cross[i]] / size;
        held[i] = f->cross[i] >= 0 && is_held && is_held[f->cross[i]];
        if (!isfinite(r[i])) return 1.0; // the law's own check refuses such constants
    }
    if (definite_at(r, held, 1.0) || !definite_at(r, held, 0.0)) return 1.0;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k) { // the cone is convex: one factor divides inside from outside
        double middle = 0.5 * (low + high);
        *(definite_at(r, held, middle) ? &low : &high) = middle;
    }
    for (int i = 0; i < 3; ++i)
        if (f->cross[i] >= 0 && !held[i]) value[f->cross[i]] *= low * inside;
    return low * inside;
}

double sn_fung_convex(const sn_law *law, const bool *held, double *value) {
    const sn_fung_form *form;
    double least = 1.0;
    int count = sn_fung_forms(law, &form);
    for (int k = 0; k < count; ++k) least = fmin(least, shrink(&form[k], held, value));
    return least;
}

static bool is_guccione(const sn_law *law) {
    return strcmp(law->name, "guccione") == 0;
}

int sn_fung_shear_plane(const sn_law *law, int index) {
    const sn_fung_form *form;
    int count = sn_fung_forms(law, &form);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < 3; ++i)
            if (form[k].shear[i] == index) return i;
    return is_guccione(law) && index == GUCCIONE_BFS ? 0 : -1;
}

void sn_fung_tie(const sn_law *law, int index, double most, double *value) {
    const sn_fung_form *form;
    int count = sn_fung_forms(law, &form);
    if (is_guccione(law)) value[GUCCIONE_BFS] = 0.5 * (value[GUCCIONE_BF] + value[GUCCIONE_BT]);
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < 3; ++i) {
            if (form[k].shear[i] != index) continue;
            double mean = 0.5 * (value[form[k].normal[i]] + value[form[k].normal[(i + 1) % 3]]);
            value[index] = mean - value[form[k].cross[i]];
        }
    value[index] = fmin(value[index], most);
}

bool sn_fung_at_limit(const sn_law *law, const double *value, int index) {
    const sn_fung_form *form;
    int count = sn_fung_forms(law, &form);
    double trial[SN_VALUES_MAX];
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < 3; ++i) {
            if (form[k].cross[i] != index || value[index] == 0.0) continue;
            memcpy(trial, value, sizeof trial);
            for (int j = 0; j < 3; ++j)
                if (form[k].cross[j] >= 0) trial[form[k].cross[j]] *= 1.0 + 1e-3;
            return shrink(&form[k], NULL, trial) < 1.0;
        }
    return false;
}
