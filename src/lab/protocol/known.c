// Hereditary stress of a pull where the elastic stress is a known function of the stretch.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); incompressible uniaxial tension.
//
// A uniaxial law has one channel f = T(stretch). An incompressible solid has two, f = S11 and S22
// at the lateral stretch L^(-1/2); its nominal stress is L H[S11] - H[S22] / L^2, H the hereditary
// integral. A strip of a membrane has S22 = 0 at its free side at every instant, hence H[S22] = 0,
// hence one channel S11 and the nominal stress L H[S11].
#include <math.h>

#include "lab/protocol/hereditary.h"

sn_status sn_pull_closed(const sn_tissue *tissue, int points, const double *stretch, double *value,
                         double *slope) {
    size_t n = (size_t)points;
    double *E = sn_alloc((6 + 6 + 21) * n, sizeof *E);
    if (!E) return SN_E_MEMORY;
    double *S = E + 6 * n, *D = S + 6 * n;
    for (size_t i = 0; i < n; ++i) {
        E[i] = 0.5 * (stretch[i] - 1.0) * (stretch[i] + 1.0);
        E[n + i] = E[2 * n + i] = 0.5 * (1.0 - stretch[i]) / stretch[i];
    }
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

static sn_status fill_closed(const void *context, int n, const double *x, double *value,
                             double *slope) {
    return sn_pull_closed(context, n, x, value, slope);
}

static sn_status fill_uniaxial(const void *context, int n, const double *x, double *value,
                               double *slope) {
    const sn_tissue *tissue = context;
    sn_law_uniaxial(tissue->law, tissue->value, tissue->terms, n, x, NULL, value, slope);
    return SN_OK;
}

static sn_status fill_strip(const void *context, int n, const double *x, double *value,
                            double *slope) {
    return sn_pull_strip(context, n, x, value, slope);
}

sn_status sn_path_stress_known(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                               const sn_exponentials *e, int level, double *stress) {
    bool closed = pull == SN_PULL_CLOSED, strip = pull == SN_PULL_STRIP;
    sn_channels of = {closed ? 2 : 1, tissue,
                      closed  ? fill_closed
                      : strip ? fill_strip
                              : fill_uniaxial};
    double *out = sn_alloc((size_t)(path->count * of.count), sizeof *out);
    if (!out) return SN_E_MEMORY;
    sn_status status = sn_path_hereditary(path, &of, e, level, out);
    for (int r = 0; status == SN_OK && r < path->records; ++r) {
        int k = path->record[r];
        if (k < 0) {
            stress[r] = 0.0;
            continue;
        }
        double L = path->stretch[k];
        stress[r] = closed  ? L * out[2 * k] - out[2 * k + 1] / (L * L)
                    : strip ? L * out[k]
                            : out[k];
    }
    sn_free(out);
    return status;
}
