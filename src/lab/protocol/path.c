// Layout of a uniaxial test in time, and the choice of how a tissue is pulled.
// SPDX-License-Identifier: Apache-2.0
#include "lab/protocol/path.h"

#include <math.h>
#include <stdlib.h>

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// index of t among the instants, which contain it
static int instant_of(const sn_path *path, double t) {
    int low = 0, high = path->count - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (path->time[middle] < t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static sn_status check_times(int n, const double *time) {
    for (int i = 0; i < n; ++i)
        if (!isfinite(time[i]))
            return sn_fail(SN_E_DATA, "recorded time %d is not finite: give seconds", i + 1);
    return SN_OK;
}

static void lay_motion(sn_path *path, const sn_history *motion, double rest) {
    double low = rest, high = rest;
    for (int i = 0; i < path->count; ++i) {
        sn_history_at(motion, path->time[i], &path->stretch[i]);
        low = fmin(low, path->stretch[i]);
        high = fmax(high, path->stretch[i]);
    }
    path->range = high - low;
    path->rest = rest;
}

sn_status sn_path_lay(const sn_history *motion, double rest, int n, const double *time,
                      sn_path **path) {
    SN_ASSERT(motion && motion->channels == 1 && n > 0 && time && path);
    *path = NULL;
    SN_TRY(check_times(n, time));
    double start = motion->time[0], end = start;
    for (int i = 0; i < n; ++i) end = fmax(end, time[i]);

    sn_status status = SN_E_MEMORY;
    sn_path *p = sn_alloc(1, sizeof *p);
    if (!p) return status;
    p->time = sn_alloc((size_t)(n + motion->count), sizeof *p->time);
    p->stretch = sn_alloc((size_t)(n + motion->count), sizeof *p->stretch);
    p->record = sn_alloc((size_t)n, sizeof *p->record);
    if (!p->time || !p->stretch || !p->record) goto fail;

    int count = 0;
    for (int i = 0; i < motion->count; ++i)
        if (motion->time[i] <= end) p->time[count++] = motion->time[i];
    for (int i = 0; i < n; ++i)
        if (time[i] > start) p->time[count++] = time[i];
    qsort(p->time, (size_t)count, sizeof *p->time, by_value);
    for (int i = 0; i < count; ++i)
        if (p->count == 0 || p->time[i] > p->time[p->count - 1]) p->time[p->count++] = p->time[i];

    lay_motion(p, motion, rest);
    p->records = n;
    for (int i = 0; i < n; ++i) p->record[i] = time[i] < start ? -1 : instant_of(p, time[i]);
    *path = p;
    return SN_OK;
fail:
    sn_path_destroy(p);
    return status;
}

sn_status sn_path_create(const sn_history *stretch, int n, const double *time, sn_path **path) {
    SN_TRY(sn_path_lay(stretch, 1.0, n, time, path));
    sn_status status = SN_OK;
    for (int i = 0; i < (*path)->count && status == SN_OK; ++i)
        if (!((*path)->stretch[i] > 0.0))
            status = sn_fail(SN_E_RANGE, "stretch at %g s is %g: expected more than 0",
                             (*path)->time[i], (*path)->stretch[i]);
    if (status == SN_OK) return status;
    sn_path_destroy(*path);
    *path = NULL;
    return status;
}

void sn_path_destroy(sn_path *path) {
    if (!path) return;
    sn_free(path->time);
    sn_free(path->stretch);
    sn_free(path->record);
    sn_free(path);
}

// S under a probe strain that is alike in both lateral directions
static sn_status probe(const sn_tissue *tissue, double S[6], double *size) {
    const double E[6] = {0.05, -0.04, -0.04, 0.0, 0.0, 0.0};
    sn_law_solid(tissue->law, tissue->value, tissue->terms, 1, E, NULL, S, NULL);
    *size = fmax(fabs(S[0]), fabs(S[1]));
    if (isfinite(*size) && *size > 0.0) return SN_OK;
    return sn_fail(SN_E_RANGE, "law %s gives no usable stress at a stretch of 1.05",
                   tissue->law->name);
}

sn_status sn_pull_straight(const sn_tissue *tissue) {
    double S[6], size;
    SN_TRY(probe(tissue, S, &size));
    for (int i = 3; i < 6; ++i)
        if (fabs(S[i]) > 1e-10 * size)
            return sn_fail(SN_E_UNSUPPORTED,
                           "law %s shears when it is pulled along its first axis: a test with free "
                           "sides needs "
                           "axes that stay at right angles",
                           tissue->law->name);
    return SN_OK;
}

sn_status sn_pull_choose(const sn_tissue *tissue, sn_pull *pull) {
    const sn_law *law = tissue->law;
    if (law->kind != SN_LAW_SOLID) {
        *pull = law->kind == SN_LAW_UNIAXIAL ? SN_PULL_UNIAXIAL : SN_PULL_STRIP;
        return SN_OK;
    }
    double S[6], size;
    SN_TRY(sn_pull_straight(tissue));
    SN_TRY(probe(tissue, S, &size));
    sn_moduli moduli;
    law->moduli(tissue->value, tissue->terms, &moduli);
    bool alike = fabs(S[1] - S[2]) <= 1e-10 * size;
    *pull = isinf(moduli.bulk) && alike ? SN_PULL_CLOSED : SN_PULL_LATERAL;
    return SN_OK;
}

sn_status sn_path_memory(const sn_tissue *tissue, sn_exponentials e[SN_PARTS], bool *viscous) {
    *viscous = false;
    for (int k = 0; k < SN_PARTS; ++k) {
        if (k > 0 && !tissue->branched)
            e[k] = e[0];
        else
            SN_TRY(sn_memory_expand(sn_tissue_memory(tissue, (sn_part)k), &e[k]));
        *viscous |= e[k].viscous > 0.0;
    }
    return SN_OK;
}

// the stress of a known motion is a sum over the parts of the elastic stress, each with its memory
static sn_status stress_of_parts(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                                 const sn_exponentials *e, int level, double *stress) {
    sn_tissue part[2];
    if (sn_tissue_split(tissue, part) == 1)
        return sn_path_stress_known(path, &part[0], pull, e, level, stress);
    double *fibres = sn_alloc((size_t)path->records, sizeof *fibres);
    if (!fibres) return SN_E_MEMORY;
    sn_status status = sn_path_stress_known(path, &part[0], pull, e, level, stress);
    if (status == SN_OK)
        status = sn_path_stress_known(path, &part[1], pull, &e[SN_PART_FIBRE], level, fibres);
    for (int i = 0; status == SN_OK && i < path->records; ++i) stress[i] += fibres[i];
    sn_free(fibres);
    return status;
}

// stress of a step under a Voigt memory is an impulse: no number
static sn_status check_step(const sn_path *path, const sn_tissue *tissue,
                            const sn_exponentials *e) {
    int voigt = 0;
    while (tissue->branched && voigt + 1 < SN_PARTS && e[voigt].viscous == 0.0) ++voigt;
    if (e[voigt].viscous == 0.0 || path->stretch[0] == 1.0) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "a step to stretch %g at %g s under memory %s has infinite stress: start at "
                   "stretch 1 and use a ramp",
                   path->stretch[0], path->time[0],
                   sn_tissue_memory(tissue, (sn_part)voigt)->law->name);
}

sn_status sn_path_stress(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                         const sn_exponentials *e, int level, double *stress) {
    SN_TRY(check_step(path, tissue, e));
    if (pull == SN_PULL_LATERAL) return sn_path_stress_lateral(path, tissue, e, level, stress);
    if (tissue->branched) return stress_of_parts(path, tissue, pull, e, level, stress);
    return sn_path_stress_known(path, tissue, pull, e, level, stress);
}

sn_status sn_path_slopes(const sn_pulled *pulled, const sn_constants *by, double *slopes) {
    SN_TRY(check_step(pulled->path, pulled->tissue, pulled->e));
    if (pulled->pull == SN_PULL_LATERAL) return sn_path_slopes_lateral(pulled, by, slopes);
    return sn_path_slopes_known(pulled, by, slopes);
}
