// Hereditary stress of a pull where the elastic stress is a known function of the stretch, and its
// derivatives by the constants.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); incompressible uniaxial tension.
//
// A uniaxial law has one channel f = T(stretch). An incompressible solid has two, f = S11 and S22
// at the lateral stretch L^(-1/2); its nominal stress is L H[S11] - H[S22] / L^2, H the hereditary
// integral. A strip of a membrane has S22 = 0 at its free side at every instant, hence H[S22] = 0,
// hence one channel S11 and the nominal stress L H[S11].
//
// A pressure is in the second part of a solid's, so its stress and a uniaxial law's are linear in f
// and in G, and their derivatives are H of df/dp (p of the law) and the integral with dG/dp (p of
// the memory).
#include <math.h>

#include "lab/protocol/hereditary.h"

// points at which the law is asked for derivatives at a time, and the step of their slope over the
// stretch: off by (B step)^2 / 2 where the law goes like exp(B stretch), rounding by 1e-16/step
enum { BLOCK = 64 };
static const double step = 3e-6;

typedef struct known {
    const sn_pulled *pulled;
    const sn_constants *by;
} known;

static int channels_of(sn_pull pull) {
    return pull == SN_PULL_CLOSED ? 2 : 1;
}

// strain of a pull without change of volume, both sides alike
static void closed_strain(int n, const double *stretch, double *E) {
    for (int i = 0; i < n; ++i) {
        E[i] = 0.5 * (stretch[i] - 1.0) * (stretch[i] + 1.0);
        E[n + i] = E[2 * n + i] = 0.5 * (1.0 - stretch[i]) / stretch[i];
    }
}

sn_status sn_pull_closed(const sn_tissue *tissue, int points, const double *stretch, double *value,
                         double *slope) {
    size_t n = (size_t)points;
    double *E = sn_alloc((6 + 6 + 21) * n, sizeof *E);
    if (!E) return SN_E_MEMORY;
    double *S = E + 6 * n, *D = S + 6 * n;
    closed_strain(points, stretch, E);
    sn_law_solid(tissue->law, tissue->value, tissue->terms, points, E, NULL, S, D);
    for (size_t i = 0; i < n; ++i) {
        double along = stretch[i], across = -0.5 / (along * along); // dE/dstretch
        value[i] = S[i];
        value[n + i] = S[n + i];
        slope[i] = D[i] * along + (D[n + i] + D[2 * n + i]) * across;
        slope[n + i] = D[n + i] * along + (D[6 * n + i] + D[7 * n + i]) * across;
    }
    sn_free(E);
    return SN_OK;
}

// Newton for E22 at S22 = 0, all points at once; leaves stresses S and tangents D there
static sn_status free_side(const sn_tissue *tissue, int points, double *E, double *S, double *D) {
    enum { NEWTON_MAX = 200 };
    size_t n = (size_t)points;
    double largest = 0.0;
    for (int k = 0; k < NEWTON_MAX; ++k) {
        sn_law_membrane(tissue->law, tissue->value, tissue->terms, points, E, NULL, S, D);
        largest = 0.0;
        for (size_t i = 0; i < n; ++i) {
            double *side = &E[n + i], room = 1.0 + 2.0 * *side; // the square of its stretch
            double change = -S[n + i] / D[3 * n + i];
            if (!isfinite(change) || !(D[3 * n + i] > 0.0)) change = (double)INFINITY;
            largest = fmax(largest, fabs(change) / room);
            *side += fmax(-0.1 * room, fmin(0.1 * room, change));
        }
        if (largest <= 1e-14) return SN_OK;
        if (isinf(largest)) break;
    }
    return sn_fail(SN_E_SOLVER,
                   "law %s: a strip finds no free side (last change %g): use a smaller stretch, or "
                   "check the constants",
                   tissue->law->name, largest);
}

sn_status sn_pull_strip(const sn_tissue *tissue, int points, const double *stretch, double *value,
                        double *slope) {
    size_t n = (size_t)points;
    double *E = sn_alloc((3 + 3 + 6) * n, sizeof *E);
    if (!E) return SN_E_MEMORY;
    double *S = E + 3 * n, *D = S + 3 * n; // the side starts from rest: E22 = 0
    for (size_t i = 0; i < n; ++i) E[i] = 0.5 * (stretch[i] - 1.0) * (stretch[i] + 1.0);
    sn_status status = free_side(tissue, points, E, S, D);
    for (size_t i = 0; status == SN_OK && i < n; ++i) {
        double coupling = D[n + i];
        value[i] = S[i];
        slope[i] = (D[i] - coupling * coupling / D[3 * n + i]) * stretch[i];
    }
    sn_free(E);
    return status;
}

//---- channels ------------------------------------------------------------------------------------

static sn_status fill_stress(const void *context, int n, const double *x, double *value,
                             double *slope) {
    const sn_pulled *p = ((const known *)context)->pulled;
    const sn_tissue *tissue = p->tissue;
    if (p->pull == SN_PULL_CLOSED) return sn_pull_closed(tissue, n, x, value, slope);
    if (p->pull == SN_PULL_STRIP) return sn_pull_strip(tissue, n, x, value, slope);
    sn_law_uniaxial(tissue->law, tissue->value, tissue->terms, n, x, NULL, value, slope);
    return SN_OK;
}

// derivatives of the channels at points on both sides of `count` others, into the places of these
static void fill_block(const known *k, int n, int count, const double *x, double *dS, double *value,
                       double *slope) {
    const sn_tissue *tissue = k->pulled->tissue;
    const bool closed = k->pulled->pull == SN_PULL_CLOSED;
    const int rows = closed ? 6 : 1, two = 2 * count;
    double at[2 * BLOCK], E[6 * 2 * BLOCK] = {0};
    for (int i = 0; i < count; ++i) {
        at[i] = x[i] - step;
        at[count + i] = x[i] + step;
    }
    if (closed) closed_strain(two, at, E);
    sn_law_sensitivity(tissue->law, tissue->value, tissue->terms, two, closed ? E : at, dS);
    for (int j = 0; j < k->by->law_count; ++j)
        for (int a = 0; a < channels_of(k->pulled->pull); ++a) {
            const double *d = dS + (ptrdiff_t)(k->by->law[j] * rows + a) * two;
            for (int i = 0; i < count; ++i) {
                value[i] = 0.5 * (d[count + i] + d[i]);
                slope[i] = (d[count + i] - d[i]) / (2.0 * step);
            }
            value += n;
            slope += n;
        }
}

// the channels of the stress, then those of its derivatives by every constant of the law
static sn_status fill_all(const void *context, int n, const double *x, double *value,
                          double *slope) {
    const known *k = context;
    const sn_tissue *tissue = k->pulled->tissue;
    ptrdiff_t own = (ptrdiff_t)channels_of(k->pulled->pull) * n;
    SN_TRY(fill_stress(context, n, x, value, slope));
    int values = sn_param_offset(tissue->law->params, tissue->law->param_count, tissue->terms);
    double *dS =
        sn_alloc((size_t)(values * sn_law_components(tissue->law)), 2 * BLOCK * sizeof *dS);
    if (!dS) return SN_E_MEMORY;
    for (int i = 0; i < n && k->by->law_count > 0; i += BLOCK) {
        int count = n - i < BLOCK ? n - i : BLOCK;
        fill_block(k, n, count, x + i, dS, value + own + i, slope + own + i);
    }
    sn_free(dS);
    return SN_OK;
}

//---- nominal stress ------------------------------------------------------------------------------

// from hereditary integrals, `stride` numbers from instant to instant, to the records
static void nominal(const sn_path *path, sn_pull pull, const double *H, int stride,
                    double *stress) {
    for (int r = 0; r < path->records; ++r) {
        int k = path->record[r];
        if (k < 0) {
            stress[r] = 0.0;
            continue;
        }
        const double *at = H + (ptrdiff_t)k * stride;
        double L = path->stretch[k];
        stress[r] = pull == SN_PULL_CLOSED  ? L * at[0] - at[1] / (L * L)
                    : pull == SN_PULL_STRIP ? L * at[0]
                                            : at[0];
    }
}

sn_status sn_path_stress_known(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                               const sn_exponentials *e, int level, double *stress) {
    const sn_pulled pulled = {path, tissue, pull, e, level};
    const known k = {&pulled, NULL};
    sn_channels of = {channels_of(pull), &k, fill_stress};
    double *out = sn_alloc((size_t)(path->count * of.count), sizeof *out);
    if (!out) return SN_E_MEMORY;
    sn_status status = sn_path_hereditary(path, &of, e, level, out);
    if (status == SN_OK) nominal(path, pull, out, of.count, stress);
    sn_free(out);
    return status;
}

sn_status sn_path_slopes_known(const sn_pulled *pulled, const sn_constants *by, double *slopes) {
    SN_ASSERT(pulled->pull == SN_PULL_UNIAXIAL || pulled->pull == SN_PULL_CLOSED);
    const sn_path *path = pulled->path;
    const known k = {pulled, by};
    const int own = channels_of(pulled->pull), records = path->records;
    sn_channels all = {own * (1 + by->law_count), &k, fill_all}, f = {own, &k, fill_stress};
    sn_memory_slope every[SN_VALUES_MAX], slope[SN_FIT_PARAMS_MAX];
    size_t rows = (size_t)path->count;
    double *H = sn_alloc(rows * (size_t)all.count, sizeof *H);
    double *M = sn_alloc(rows * (size_t)(own * by->memory_count), sizeof *M);
    sn_status status = SN_E_MEMORY;
    if (!H || !M) goto fail;
    SN_TRY_GOTO(status, sn_path_hereditary(path, &all, pulled->e, pulled->level, H));
    for (int j = 0; j < by->law_count; ++j, slopes += records)
        nominal(path, pulled->pull, H + own * (1 + j), all.count, slopes);
    sn_memory_sensitivity(&pulled->tissue->memory, every);
    for (int j = 0; j < by->memory_count; ++j) slope[j] = every[by->memory[j]];
    SN_TRY_GOTO(status,
                sn_path_hereditary_slopes(path, &f, by->memory_count, slope, pulled->level, M));
    for (int j = 0; j < by->memory_count; ++j, slopes += records) {
        double *m = M + (size_t)(j * own) * rows;
        for (size_t i = 0; i < rows; ++i)
            for (int a = 0; a < own; ++a)
                m[i * (size_t)own + (size_t)a] +=
                    slope[j].own * H[i * (size_t)all.count + (size_t)a];
        nominal(path, pulled->pull, m, own, slopes);
    }
fail:
    sn_free(H);
    sn_free(M);
    return status;
}
