// Stress and tangent of the law at the end of a step, part by part.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35): every part of the stress has its own factor and history.
#include <string.h>

#include "springs/tangent.h"

sn_tangent_memory sn_tangent_memory_of(const sn_net *net, const sn_net_region *region,
                                       const sn_tangent_call *call, int store) {
    sn_net_store place[SN_STORES];
    sn_region_stores(net, region, place);
    const sn_part part = place[store].part;
    if (!call->factors || sn_region_branches(region, part) == 0)
        return (sn_tangent_memory){1.0, NULL};
    return (sn_tangent_memory){call->factors[region - net->region].part[part].alpha,
                               call->history + place[store].first};
}

void sn_tangent_law_of(const sn_net *net, const sn_net_region *region, const sn_tangent_call *call,
                       sn_tangent_law *law) {
    sn_net_store place[SN_STORES];
    sn_region_stores(net, region, place);
    static const int store[2] = {SN_STORE_CELL, SN_STORE_FIBRE};
    *law = (sn_tangent_law){.first = sn_net_first_split(net), .splits = region->splits};
    for (int k = law->first; k < law->splits; k++) {
        law->memory[k] = sn_tangent_memory_of(net, region, call, store[k]);
        law->components[k] = (size_t)place[store[k]].components;
    }
    const bool apart = region->tissue.branched;
    const int volume = apart ? SN_STORE_BULK : SN_STORE_CELL;
    law->volume = sn_tangent_memory_of(net, region, call, volume);
    law->volume_components = (size_t)place[volume].components;
    law->volume_first = apart ? 0 : 6;
}

void sn_tangent_law_at(const sn_net *net, const sn_net_region *region, const sn_tangent_law *law,
                       int slot, int count, const double *E, double *S, double *D) {
    const size_t n = (size_t)(slot - sn_region_law_block(net, region) * SN_BLOCK);
    double T[6 * SN_BLOCK], slope[21 * SN_BLOCK];
    const size_t many = (size_t)count;
    memset(S, 0, 6 * many * sizeof *S);
    memset(D, 0, 21 * many * sizeof *D);
    for (int k = law->first; k < law->splits; k++) {
        const sn_tangent_memory *m = &law->memory[k];
        const size_t first = n / SN_BLOCK * law->components[k] * SN_BLOCK + n % SN_BLOCK;
        sn_net_law(net, &region->split[k], slot, count, E, NULL, T, slope);
        for (size_t c = 0; c < 6; c++)
            for (size_t i = 0; i < many; i++)
                S[c * many + i] += sn_tangent_stress(m, first + c * SN_BLOCK + i, T[c * many + i]);
        for (size_t i = 0; i < 21 * many; i++) D[i] += m->alpha * slope[i];
    }
}
