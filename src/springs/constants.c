// Stiffness of single springs, from outside.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "springs/steps.h"

void sn_net_springs(const sn_net *net, int *ends, double *stiffness) {
    const double *k = net->data[SN_DOUBLE].stiffness;
    int count = 0;
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        if (!(net->spring_volume[s] > 0)) continue; // filling
        const int *end = net->spring_end + s / SN_BLOCK * 2 * SN_BLOCK + s % SN_BLOCK;
        for (int e = 0; e < 2 && ends; e++) ends[2 * count + e] = net->node_name[end[e * SN_BLOCK]];
        if (stiffness) stiffness[count] = k[s];
        count++;
    }
    SN_ASSERT(count == net->springs);
}

static void put(sn_net *net, const double *stiffness) {
    double *k = net->data[SN_DOUBLE].stiffness;
    float *single = net->data[SN_SINGLE].stiffness;
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        if (!(net->spring_volume[s] > 0)) continue;
        k[s] = *stiffness++;
        if (single) single[s] = (float)k[s];
    }
}

sn_status sn_net_set_spring_stiffness(sn_net *net, const double *stiffness) {
    if (net->springs == 0)
        return sn_fail(SN_E_UNSUPPORTED,
                       "springs: a net of model %s has no springs; per-edge constants need model "
                       "central",
                       net->rung == SN_RUNG_SMOOTHED ? "smoothed" : "coupled");
    for (int k = 0; k < net->springs; k++)
        if (!(stiffness[k] >= 0) || !isfinite(stiffness[k]))
            return sn_fail(SN_E_RANGE,
                           "springs: stiffness of spring %d is %g N/m, expected 0 or more", k,
                           stiffness[k]);
    double *before = sn_alloc((size_t)net->springs, sizeof *before);
    if (!before) return SN_E_MEMORY;
    sn_net_springs(net, NULL, before);
    put(net, stiffness);
    double *mode = net->mode; // the search makes another
    sn_status status = SN_OK;
    if (net->integrator == SN_INTEGRATOR_EXPLICIT) {
        net->mode = NULL;
        status = sn_net_find_step(net);
        if (status != SN_OK) {
            double *unused = net->mode;
            net->mode = mode;
            mode = unused;
            put(net, before);
        }
        sn_free(mode);
    }
    if (status == SN_OK)
        net->fingerprint =
            sn_hash(net->fingerprint, stiffness, (size_t)net->springs * sizeof *stiffness);
    sn_free(before);
    return status;
}
