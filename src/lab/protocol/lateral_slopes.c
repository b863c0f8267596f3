// Derivatives of the stress of a pulled block by the constants of its tissue.
// SPDX-License-Identifier: Apache-2.0
//
// They are those of the scheme itself (lateral.c), carried along with it. With S the total of a
// channel and v its elastic value, dS = a dv + db + X: db from the recursion of dv, X the integral
// with dG/dp where the constant is one of the memory; and dv = v_p + v_y dy, v_p at fixed stretches
// from the law. dy, of the logarithms of the unknown stretches, is what keeps the residuals at 0:
// with R_y their matrix, from the law's tangent, R_y dy = -R_S (a v_p + db + X).
#include <math.h>
#include <string.h>

#include "lab/protocol/block.h"

enum { VOLUME = SN_BLOCK_VOLUME, CHANNELS = SN_BLOCK_FIBRES }; // one memory: no fibres apart

// derivatives of what a block holds by every constant
struct sn_block_slopes {
    const sn_constants *by;
    int count;
    sn_memory_slope memory[SN_FIT_PARAMS_MAX];   // of the constants of the memory
    double bulk[SN_FIT_PARAMS_MAX];              // of the bulk modulus
    double fixed[SN_FIT_PARAMS_MAX][CHANNELS];   // of the totals, elastic values held
    double value[SN_FIT_PARAMS_MAX][CHANNELS];   // of the elastic values
    double aged[SN_FIT_PARAMS_MAX][CHANNELS][2]; // shares of the exponential of `memory`
    double H[SN_FIT_PARAMS_MAX][CHANNELS][SN_TERMS_MAX];
    double nominal[SN_FIT_PARAMS_MAX]; // of the nominal stress on the first face
    double dS[SN_VALUES_MAX * 6];      // from the law
};

// what the unknown stretches do to elastic values, residuals and nominal stress at an equilibrium
typedef struct sides {
    double l[3], square[3], J;
    double value[CHANNELS][3], residual[3][3], nominal[3]; // derivatives by their logarithms
} sides;

// R_c = l_c^2 S_c - p, less the load times l_c, which is 0 on free sides; p = l3^2 S_3 or -J S_v
static void sides_at(const sn_block *p, const sn_block_trial *now, sides *s) {
    static const int place[3][3] = {{0, 1, 2}, {1, 6, 7}, {2, 7, 11}}; // upper triangle by rows
    double E[6] = {0}, D[21], total[CHANNELS], a = p->a[0];
    bool closed = isinf(p->bulk);
    *s = (sides){.J = now->stretch[0] * now->stretch[1] * now->stretch[2]};
    for (int i = 0; i < 3; ++i) {
        s->l[i] = now->stretch[i];
        s->square[i] = s->l[i] * s->l[i];
        E[i] = 0.5 * (s->l[i] - 1.0) * (s->l[i] + 1.0);
    }
    sn_law_solid(p->tissue->law, p->tissue->value, p->tissue->terms, 1, E, NULL, NULL, D);
    for (int c = 0; c < CHANNELS; ++c) total[c] = a * now->value[c] + p->b[c];
    for (int j = 0; j < p->unknowns; ++j) {
        double move[3] = {0.0}; // of the logarithms of all stretches
        move[p->unknown[j]] = 1.0;
        if (closed) move[2] = -1.0;
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < 3; ++i) s->value[c][j] += D[place[c][i]] * s->square[i] * move[i];
        s->value[VOLUME][j] = closed ? 0.0 : p->bulk * s->J;
        double pressure = closed ? (a * s->value[2][j] + 2.0 * total[2] * move[2]) * s->square[2]
                                 : -(a * s->value[VOLUME][j] + total[VOLUME]) * s->J;
        for (int i = 0; i < p->unknowns; ++i) {
            int c = p->unknown[i];
            s->residual[i][j] =
                (a * s->value[c][j] + 2.0 * total[c] * move[c]) * s->square[c] - pressure;
        }
        s->nominal[j] = s->l[0] * a * s->value[0][j] - pressure / s->l[0];
    }
}

// dy, and with it dv and the derivative of the nominal stress, from dS at fixed stretches
static void follow_sides(const sn_block *p, const sides *s, const double dS[CHANNELS],
                         double value[CHANNELS], double *nominal) {
    double A[3][3], dR[3], dy[3];
    double pressure = isinf(p->bulk) ? dS[2] * s->square[2] : -dS[VOLUME] * s->J;
    for (int i = 0; i < p->unknowns; ++i) {
        int c = p->unknown[i];
        dR[i] = dS[c] * s->square[c] - pressure;
    }
    memcpy(A, s->residual, sizeof A);
    sn_solve_small(p->unknowns, A, dR, dy);
    *nominal = s->l[0] * dS[0] - pressure / s->l[0];
    for (int j = 0; j < p->unknowns; ++j) {
        *nominal += s->nominal[j] * dy[j];
        for (int c = 0; c < CHANNELS; ++c) value[c] += s->value[c][j] * dy[j];
    }
}

// derivatives at an equilibrium, the old ones in value[] replaced; `fixed` is known
static void slopes_solve(sn_block *p, const sn_block_trial *now) {
    sn_block_slopes *d = p->slopes;
    sides s;
    sides_at(p, now, &s);
    double E[6] = {0};
    for (int i = 0; i < 3; ++i) E[i] = 0.5 * (s.l[i] - 1.0) * (s.l[i] + 1.0);
    sn_law_sensitivity(p->tissue->law, p->tissue->value, p->tissue->terms, 1, E, d->dS);
    for (int k = 0; k < d->count; ++k) {
        double dS[CHANNELS];
        for (int c = 0; c < CHANNELS; ++c) {
            d->value[k][c] = 0.0;
            if (k < d->by->law_count)
                d->value[k][c] = c < VOLUME ? d->dS[d->by->law[k] * 6 + c]
                                            : d->bulk[k] * now->value[VOLUME] / p->bulk;
            dS[c] = p->a[c] * d->value[k][c] + d->fixed[k][c];
        }
        follow_sides(p, &s, dS, d->value[k], &d->nominal[k]);
    }
}

// the integral with dG/dp of constant k at the end of a step of h seconds to `value`
static void memory_part(sn_block *p, int k, double h, const double value[CHANNELS]) {
    sn_block_slopes *d = p->slopes;
    const sn_memory_slope *by = &d->memory[k];
    double x = h / by->tau, decay = exp(-x), m0 = -expm1(-x) / x;
    // x M1; for small x the difference of m0 and decay would lose its digits
    double old = x > 1e-3 ? m0 - decay : x * (0.5 - x * (1.0 / 3.0 - x * (1.0 / 8.0 - x / 30.0)));
    for (int c = 0; c < CHANNELS; ++c) {
        double change = value[c] - p->value[c], *H = d->aged[k][c];
        H[1] = decay * (H[1] + x * H[0]) + old * change;
        H[0] = decay * H[0] + m0 * change;
        d->fixed[k][c] += by->constant * value[c] + by->own * (p->a[c] * value[c] + p->b[c]) +
                          by->plain * H[0] + by->aged * H[1] + by->viscous * change / h;
    }
}

void sn_block_slopes_step(sn_block *p, double h, const double *decay, const double *gain,
                          const sn_block_trial *now) {
    sn_block_slopes *d = p->slopes;
    const sn_exponentials *e = p->e;
    double old[SN_FIT_PARAMS_MAX][CHANNELS];
    memcpy(old, d->value, sizeof old);
    for (int k = 0; k < d->count; ++k) {
        for (int c = 0; c < CHANNELS; ++c) {
            double b = -e->viscous / h * old[k][c];
            for (int i = 0; i < e->terms; ++i) b += decay[i] * d->H[k][c][i] - gain[i] * old[k][c];
            d->fixed[k][c] = b;
        }
        if (k >= d->by->law_count) memory_part(p, k, h, now->value);
    }
    slopes_solve(p, now);
    for (int k = 0; k < d->count; ++k)
        for (int c = 0; c < CHANNELS; ++c)
            for (int i = 0; i < e->terms; ++i)
                d->H[k][c][i] = decay[i] * d->H[k][c][i] + gain[i] * (d->value[k][c] - old[k][c]);
}

void sn_block_slopes_start(sn_block *p, const sn_block_trial *now) {
    sn_block_slopes *d = p->slopes;
    slopes_solve(p, now);
    for (int k = 0; k < d->count; ++k)
        for (int c = 0; c < CHANNELS; ++c) {
            d->aged[k][c][0] = now->value[c];
            for (int i = 0; i < p->e->terms; ++i) d->H[k][c][i] = p->e->g[i] * d->value[k][c];
        }
}

// derivative of the bulk modulus by a constant of the law: a rational function in closed form, of
// which a difference leaves 1e-10
static double bulk_slope(const sn_tissue *tissue, int index) {
    sn_moduli side[2];
    double change = 1e-6 * fabs(tissue->value[index]), at[2];
    sn_tissue moved = *tissue;
    if (isinf(change) || change == 0.0) return 0.0;
    for (int s = 0; s < 2; ++s) {
        at[s] = moved.value[index] = tissue->value[index] + (s ? change : -change);
        tissue->law->moduli(moved.value, moved.terms, &side[s]);
    }
    return isinf(side[0].bulk) ? 0.0 : (side[1].bulk - side[0].bulk) / (at[1] - at[0]);
}

static sn_block_slopes *slopes_create(const sn_tissue *tissue, const sn_constants *by) {
    sn_memory_slope every[SN_VALUES_MAX];
    sn_block_slopes *d = sn_alloc(1, sizeof *d);
    if (!d) return NULL;
    d->by = by;
    d->count = by->law_count + by->memory_count;
    for (int k = 0; k < by->law_count; ++k) d->bulk[k] = bulk_slope(tissue, by->law[k]);
    sn_memory_sensitivity(&tissue->memory, every);
    for (int k = 0; k < by->memory_count; ++k) d->memory[by->law_count + k] = every[by->memory[k]];
    return d;
}

sn_status sn_path_slopes_lateral(const sn_pulled *pulled, const sn_constants *by, double *out) {
    SN_ASSERT(!pulled->tissue->branched);
    const sn_path *path = pulled->path;
    sn_block p = sn_block_of(pulled->tissue, &sn_faces_pulled, pulled->e);
    const int count = by->law_count + by->memory_count;
    sn_block_row row;
    double *at_instant = sn_alloc((size_t)path->count * (size_t)count, sizeof *at_instant);
    sn_status status = SN_E_MEMORY;
    p.slopes = slopes_create(pulled->tissue, by);
    if (!at_instant || !p.slopes) goto fail;
    SN_TRY_GOTO(status, sn_block_start(&p, path, &row));
    for (int k = 0; k < path->count; ++k) {
        if (k > 0) SN_TRY_GOTO(status, sn_block_cross(&p, path, k - 1, pulled->level, &row));
        memcpy(at_instant + (ptrdiff_t)k * count, p.slopes->nominal,
               (size_t)count * sizeof *at_instant);
    }
    for (int j = 0; j < count; ++j)
        for (int r = 0; r < path->records; ++r, ++out)
            *out = path->record[r] < 0 ? 0.0 : at_instant[(ptrdiff_t)path->record[r] * count + j];
fail:
    sn_free(at_instant);
    sn_free(p.slopes);
    return status;
}
