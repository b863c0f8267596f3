// The virtual uniaxial testing machine: steps refined until the stress stands still.
// SPDX-License-Identifier: Apache-2.0
//
// Every level doubles the steps. Where the stress is a known function of the stretch the error
// falls by 8 to 16 a level, so the change between two levels bounds the error of the finer one with
// room. Where the lateral stretch is solved for, the error falls by 4 (by 2 under a Voigt memory,
// whose rate is a backward difference); Romberg's table removes those powers, and the change
// between two of its last entries is what is held against the tolerance.
#include <math.h>
#include <string.h>

#include "lab/protocol/path.h"

enum { LEVELS = 12 };
static const double tolerance = 5e-8; // of the peak

static double peak_of(int n, const double *stress) {
    double peak = 0.0;
    for (int i = 0; i < n; ++i) peak = fmax(peak, fabs(stress[i]));
    return peak;
}

static double change_of(int n, const double *a, const double *b) {
    double change = 0.0;
    for (int i = 0; i < n; ++i) change = fmax(change, fabs(a[i] - b[i]));
    return change;
}

static sn_status check_finite(const sn_path *path, const sn_tissue *tissue, const double *stress) {
    for (int i = 0; i < path->records; ++i)
        if (!isfinite(stress[i]))
            return sn_fail(SN_E_RANGE, "law %s overflows at stretch %g, %g s: check the constants",
                           tissue->law->name, path->stretch[path->record[i]],
                           path->time[path->record[i]]);
    return SN_OK;
}

// row 0 of `table` is the new level; row k becomes the entry from which k powers are removed
static void romberg(int level, int n, double base, double (*restrict next)[LEVELS],
                    double (*restrict table)[LEVELS]) {
    for (int i = 0; i < n; ++i) {
        double factor = 1.0;
        for (int k = 1; k <= level; ++k) {
            factor *= base;
            next[i][k] = next[i][k - 1] + (next[i][k - 1] - table[i][k - 1]) / (factor - 1.0);
        }
    }
}

static sn_status refine(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                        const sn_exponentials *e, double *stress) {
    int n = path->records;
    double base = pull != SN_PULL_LATERAL ? 0.0 : e->viscous > 0.0 ? 2.0 : 4.0;
    sn_status status = SN_E_MEMORY;
    double(*table)[LEVELS] = sn_alloc((size_t)n, sizeof *table);
    double(*next)[LEVELS] = sn_alloc((size_t)n, sizeof *next);
    double *last = sn_alloc((size_t)n, sizeof *last), change = (double)INFINITY;
    if (!table || !next || !last) goto fail;
    for (int level = 0; level < LEVELS; ++level) {
        SN_TRY_GOTO(status, sn_path_stress(path, tissue, pull, e, 1 << level, stress));
        SN_TRY_GOTO(status, check_finite(path, tissue, stress));
        if (base > 0.0) {
            for (int i = 0; i < n; ++i) next[i][0] = stress[i];
            romberg(level, n, base, next, table);
            for (int i = 0; i < n; ++i) stress[i] = next[i][level];
            memcpy(table, next, (size_t)n * sizeof *table);
        }
        change = level > 0 ? change_of(n, stress, last) : (double)INFINITY;
        if (change <= tolerance * peak_of(n, stress)) goto fail; // with SN_OK
        memcpy(last, stress, (size_t)n * sizeof *last);
    }
    status =
        sn_fail(SN_E_SOLVER,
                "law %s: the uniaxial test changes by %g of its peak when its steps are halved "
                "the last time (expected %g): use a slower or smaller stretch",
                tissue->law->name, change / peak_of(n, stress), tolerance);
fail:
    sn_free(table);
    sn_free(next);
    sn_free(last);
    return status;
}

sn_status sn_lab_uniaxial(const sn_tissue *tissue, const sn_history *stretch, int n,
                          const double *time, double *stress) {
    SN_ASSERT(tissue && tissue->law && stretch && time && stress);
    if (n <= 0) return SN_OK;
    sn_pull pull;
    sn_exponentials e;
    sn_path *path;
    SN_TRY(sn_pull_choose(tissue, &pull));
    SN_TRY(sn_memory_expand(&tissue->memory, &e));
    SN_TRY(sn_path_create(stretch, n, time, &path));
    sn_status status = refine(path, tissue, pull, &e, stress);
    sn_path_destroy(path);
    return status;
}
