// The virtual uniaxial testing machine: steps refined until the stress stands still.
// SPDX-License-Identifier: Apache-2.0
//
// Every level doubles the steps. Where the stress is a known function of the stretch the error
// falls by 8 to 16 a level, so the change between two levels bounds the error of the finer one with
// room. Where the lateral stretch is solved for, the error falls by 4 (by 2 under a Voigt memory,
// whose rate is a backward difference); Romberg's table removes those powers, and the change
// between two of its last entries is what is held against the tolerance.
#include <math.h>

#include "lab/protocol/path.h"
#include "lab/protocol/refine.h"

static const double tolerance = 5e-8; // of the peak

typedef struct pulled {
    const sn_path *path;
    const sn_tissue *tissue;
    sn_pull pull;
    const sn_exponentials *e;
} pulled;

static sn_status stress_at_level(const void *context, int level, double *stress) {
    const pulled *p = context;
    SN_TRY(sn_path_stress(p->path, p->tissue, p->pull, p->e, level, stress));
    for (int i = 0; i < p->path->records; ++i)
        if (!isfinite(stress[i]))
            return sn_fail(SN_E_RANGE, "law %s overflows at stretch %g, %g s: check the constants",
                           p->tissue->law->name, p->path->stretch[p->path->record[i]],
                           p->path->time[p->path->record[i]]);
    return SN_OK;
}

sn_status sn_lab_uniaxial(const sn_tissue *tissue, const sn_history *stretch, int n,
                          const double *time, double *stress) {
    SN_ASSERT(tissue && tissue->law && stretch && time && stress);
    if (n <= 0) return SN_OK;
    sn_pull pull;
    sn_exponentials e[SN_PARTS];
    sn_path *path;
    bool viscous;
    double change;
    SN_TRY(sn_pull_choose(tissue, &pull));
    SN_TRY(sn_path_memory(tissue, e, &viscous));
    SN_TRY(sn_path_create(stretch, n, time, &path));
    pulled p = {path, tissue, pull, e};
    double base = pull != SN_PULL_LATERAL ? 0.0 : viscous ? 2.0 : 4.0;
    sn_status status = sn_refine(stress_at_level, &p, n, base, tolerance, stress, &change);
    sn_path_destroy(path);
    if (status != SN_OK || change <= tolerance) return status;
    return sn_fail(SN_E_SOLVER,
                   "law %s: the uniaxial test changes by %g of its peak when its steps are halved "
                   "the last time (expected %g): use a slower or smaller stretch",
                   tissue->law->name, change, tolerance);
}
