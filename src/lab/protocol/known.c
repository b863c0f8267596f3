// Hereditary stress of a pull where the elastic stress is a known function of the stretch.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); incompressible uniaxial tension.
//
// A uniaxial law has one channel f = T(stretch). An incompressible solid has two, f = S11 and S22
// at the lateral stretch L^(-1/2); its nominal stress is L H[S11] - H[S22] / L^2, H the hereditary
// integral.
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

sn_status sn_path_stress_known(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                               const sn_exponentials *e, int level, double *stress) {
    bool closed = pull == SN_PULL_CLOSED;
    sn_channels of = {closed ? 2 : 1, tissue, closed ? fill_closed : fill_uniaxial};
    double *out = sn_alloc((size_t)(path->count * of.count), sizeof *out);
    if (!out) return SN_E_MEMORY;
    sn_status status = sn_path_hereditary(path, &of, e, level, out);
    for (int r = 0; status == SN_OK && r < path->records; ++r) {
        int k = path->record[r];
        if (k < 0) {
            stress[r] = 0.0;
        } else if (closed) {
            double L = path->stretch[k];
            stress[r] = L * out[2 * k] - out[2 * k + 1] / (L * L);
        } else {
            stress[r] = out[k];
        }
    }
    sn_free(out);
    return status;
}
