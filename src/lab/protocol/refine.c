// Steps halved until the result stands still.
// SPDX-License-Identifier: Apache-2.0
#include "lab/protocol/refine.h"

#include <math.h>
#include <string.h>

static double peak_of(int n, const double *x) {
    double peak = 0.0;
    for (int i = 0; i < n; ++i) peak = fmax(peak, fabs(x[i]));
    return peak;
}

static double change_of(int n, const double *a, const double *b) {
    double change = 0.0;
    for (int i = 0; i < n; ++i) change = fmax(change, fabs(a[i] - b[i]));
    return change;
}

// column 0 of `next` is the new level; column k becomes the entry from which k powers are removed
static void romberg(int level, int n, double base, double (*restrict next)[SN_REFINE_LEVELS],
                    double (*restrict table)[SN_REFINE_LEVELS]) {
    for (int i = 0; i < n; ++i) {
        double factor = 1.0;
        for (int k = 1; k <= level; ++k) {
            factor *= base;
            next[i][k] = next[i][k - 1] + (next[i][k - 1] - table[i][k - 1]) / (factor - 1.0);
        }
    }
}

sn_status sn_refine(sn_at_level *at_level, const void *context, int n, double base,
                    double tolerance, double *out, double *change) {
    sn_status status = SN_E_MEMORY;
    double(*table)[SN_REFINE_LEVELS] = sn_alloc((size_t)n, sizeof *table);
    double(*next)[SN_REFINE_LEVELS] = sn_alloc((size_t)n, sizeof *next);
    double *last = sn_alloc((size_t)n, sizeof *last);
    *change = (double)INFINITY;
    if (!table || !next || !last) goto fail;
    for (int level = 0; level < SN_REFINE_LEVELS; ++level) {
        SN_TRY_GOTO(status, at_level(context, 1 << level, out));
        if (base > 0.0) {
            for (int i = 0; i < n; ++i) next[i][0] = out[i];
            romberg(level, n, base, next, table);
            for (int i = 0; i < n; ++i) out[i] = next[i][level];
            memcpy(table, next, (size_t)n * sizeof *table);
        }
        double moved = level > 0 ? change_of(n, out, last) : (double)INFINITY;
        double peak = peak_of(n, out);
        *change = moved > 0.0 ? moved / peak : 0.0;
        if (*change <= tolerance) break;
        memcpy(last, out, (size_t)n * sizeof *last);
    }
fail:
    sn_free(table);
    sn_free(next);
    sn_free(last);
    return status;
}
