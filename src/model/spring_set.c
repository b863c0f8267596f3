// Springs given one by one.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "sinew/model.h"

sn_status sn_spring_set_create(int count, int region_count, sn_spring_set **set) {
    *set = NULL;
    sn_spring_set *s = sn_alloc(1, sizeof *s);
    if (!s) return SN_E_MEMORY;
    s->count = count;
    s->region_count = region_count;
    s->end = sn_alloc((size_t)count * 2, sizeof *s->end);
    s->region = sn_alloc((size_t)count, sizeof *s->region);
    s->stiffness = sn_alloc((size_t)count, sizeof *s->stiffness);
    s->exponent = sn_alloc((size_t)region_count, sizeof *s->exponent);
    s->square = sn_alloc((size_t)region_count * SN_SPRING_SQUARES, sizeof *s->square);
    s->bulk = sn_alloc((size_t)region_count, sizeof *s->bulk);
    if (!s->end || !s->region || !s->stiffness || !s->exponent || !s->square || !s->bulk) {
        sn_spring_set_destroy(s);
        return SN_E_MEMORY;
    }
    for (int r = 0; r < region_count; r++) s->bulk[r] = NAN;
    *set = s;
    return SN_OK;
}

void sn_spring_set_destroy(sn_spring_set *set) {
    if (!set) return;
    sn_free(set->end);
    sn_free(set->region);
    sn_free(set->stiffness);
    sn_free(set->exponent);
    sn_free(set->square);
    sn_free(set->bulk);
    sn_free(set);
}

sn_status sn_spring_set_copy(const sn_spring_set *set, sn_spring_set **copy) {
    *copy = NULL;
    if (!set) return SN_OK;
    SN_TRY(sn_spring_set_create(set->count, set->region_count, copy));
    sn_spring_set *to = *copy;
    const size_t count = (size_t)set->count, regions = (size_t)set->region_count;
    if (count > 0) {
        memcpy(to->end, set->end, 2 * count * sizeof *to->end);
        memcpy(to->region, set->region, count * sizeof *to->region);
        memcpy(to->stiffness, set->stiffness, count * sizeof *to->stiffness);
    }
    memcpy(to->exponent, set->exponent, regions * sizeof *to->exponent);
    memcpy(to->square, set->square, regions * SN_SPRING_SQUARES * sizeof *to->square);
    memcpy(to->bulk, set->bulk, regions * sizeof *to->bulk);
    return SN_OK;
}

//---- check ---------------------------------------------------------------------------------------

static sn_status check_spring(const sn_spring_set *set, int k, const sn_mesh *mesh) {
    const int *end = set->end + 2 * (size_t)k;
    for (int e = 0; e < 2; e++)
        if (end[e] < 0 || end[e] >= mesh->node_count)
            return sn_fail(SN_E_DEFINITION, "spring %d ends at node %d: the mesh has nodes 0 to %d",
                           k, end[e], mesh->node_count - 1);
    if (end[0] == end[1])
        return sn_fail(SN_E_DEFINITION, "spring %d has node %d at both ends", k, end[0]);
    if (set->region[k] < 0 || set->region[k] >= mesh->region_count)
        return sn_fail(SN_E_DEFINITION, "spring %d is of region %d: the mesh has regions 0 to %d",
                       k, set->region[k], mesh->region_count - 1);
    if (!(set->stiffness[k] >= 0) || !isfinite(set->stiffness[k]))
        return sn_fail(SN_E_RANGE, "spring %d has a stiffness of %g N/m, expected 0 or more", k,
                       set->stiffness[k]);
    return SN_OK;
}

// whether the nodes of the springs of each region belong to cells of it; `mark` by node
static sn_status check_ends(const sn_spring_set *set, const sn_mesh *mesh, int *mark) {
    for (int r = 0; r < mesh->region_count; r++) {
        for (int e = 0; e < mesh->cell_count; e++)
            for (int a = 0; a < 4 && mesh->region[e] == r; a++) mark[mesh->cell[4 * e + a]] = r + 1;
        for (int k = 0; k < set->count; k++)
            for (int e = 0; e < 2 && set->region[k] == r; e++)
                if (mark[set->end[2 * k + e]] != r + 1)
                    return sn_fail(SN_E_DEFINITION,
                                   "spring %d ends at node %d, which is not of its region \"%s\"",
                                   k, set->end[2 * k + e], mesh->region_name[r]);
    }
    return SN_OK;
}

// n.C n >= 0 in all directions: the principal minors, but for rounding; c >= 0
static bool squares_fit(const double *q) {
    double size = 0;
    for (int k = 0; k < SN_SPRING_SQUARES; k++) {
        if (!isfinite(q[k])) return false;
        size = fmax(size, fabs(q[k]));
    }
    const double least = -1e-9 * size, xy = q[0] * q[1] - q[3] * q[3];
    const double yz = q[1] * q[2] - q[4] * q[4], zx = q[2] * q[0] - q[5] * q[5];
    const double all =
        q[0] * yz - q[3] * (q[3] * q[2] - q[4] * q[5]) + q[5] * (q[3] * q[4] - q[1] * q[5]);
    return q[0] >= least && q[1] >= least && q[2] >= least && xy >= least * size &&
           yz >= least * size && zx >= least * size && all >= least * size * size && q[6] >= 0;
}

sn_status sn_spring_set_check(const sn_spring_set *set, const sn_mesh *mesh) {
    if (set->region_count != mesh->region_count)
        return sn_fail(SN_E_DEFINITION, "the springs are of %d regions, the mesh has %d",
                       set->region_count, mesh->region_count);
    for (int k = 0; k < set->count; k++) SN_TRY(check_spring(set, k, mesh));
    for (int r = 0; r < set->region_count; r++) {
        if (!isfinite(set->exponent[r]))
            return sn_fail(SN_E_RANGE, "the springs of region \"%s\" have the exponent %g",
                           mesh->region_name[r], set->exponent[r]);
        if (!squares_fit(set->square + SN_SPRING_SQUARES * (size_t)r))
            return sn_fail(SN_E_RANGE,
                           "the springs of region \"%s\" stiffen by squares that are below "
                           "0 in some direction, or not finite",
                           mesh->region_name[r]);
        if (set->bulk[r] < 0 || isinf(set->bulk[r]))
            return sn_fail(SN_E_RANGE,
                           "the springs of region \"%s\" have a bulk modulus of %g Pa beside them, "
                           "expected 0 or more",
                           mesh->region_name[r], set->bulk[r]);
    }
    int *mark = sn_alloc((size_t)mesh->node_count, sizeof *mark);
    if (!mark) return SN_E_MEMORY;
    sn_status status = check_ends(set, mesh, mark);
    sn_free(mark);
    return status;
}
