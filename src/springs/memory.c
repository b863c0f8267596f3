// Where items remember, and the factors of their recursions.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32): docs/theory/memory.md.
//
// A tissue with one memory passes all components of the stress of an item through one recursion.
// Where the parts of the stress have a memory each (branches), the matrix, the fibres and the
// volume stress are passes of their own, with their own exponentials and stores. The number of
// exponentials may differ from part to part.
#include <math.h>

#include "springs/forces.h"
#include "springs/moment.h"

void sn_region_stores(const sn_net *net, const sn_net_region *g, sn_net_store store[SN_STORES]) {
    const bool own_volume = net->volume_mode == SN_VOLUME_CELL, branched = g->tissue.branched;
    const int places = sn_region_law_blocks(net, g), central = sn_net_first_split(net);
    store[SN_STORE_CELL] = (sn_net_store){SN_PART_DEVIATORIC, own_volume && !branched ? 7 : 6,
                                          central ? 0 : places, g->cell_store};
    store[SN_STORE_SPRING] =
        (sn_net_store){SN_PART_DEVIATORIC, 1, g->spring_blocks, g->spring_store};
    store[SN_STORE_POINT] = (sn_net_store){SN_PART_VOLUMETRIC, 1, g->point_blocks, g->point_store};
    store[SN_STORE_FIBRE] =
        (sn_net_store){SN_PART_FIBRE, 6, g->splits > 1 ? places : 0, g->fibre_store};
    store[SN_STORE_BULK] =
        (sn_net_store){SN_PART_VOLUMETRIC, 1, own_volume && branched ? places : 0, g->bulk_store};
}

sn_recalled sn_recall(const sn_net *net, const sn_net_region *region, const sn_moment *moment,
                      int kind) {
    sn_net_store store[SN_STORES];
    sn_region_stores(net, region, store);
    const sn_net_store *s = &store[kind];
    return (sn_recalled){moment, sn_region_memory(region, s->part), s->first,
                         (size_t)s->components * SN_BLOCK,
                         (size_t)sn_region_branches(region, s->part)};
}

void sn_net_place_stores(sn_net *net) {
    size_t at = 0;
    for (int r = 0; r < net->region_count; r++) {
        sn_net_region *g = &net->region[r];
        size_t *first[SN_STORES] = {&g->cell_store, &g->spring_store, &g->point_store,
                                    &g->fibre_store, &g->bulk_store};
        sn_net_store store[SN_STORES];
        sn_region_stores(net, g, store);
        for (int k = 0; k < SN_STORES; k++) {
            const int branches = sn_region_branches(g, store[k].part);
            *first[k] = at;
            if (branches > 0)
                at += (size_t)(1 + branches) * SN_BLOCK * (size_t)store[k].components *
                      (size_t)store[k].blocks;
        }
    }
    net->store_size = at;
}

static void set_factors(const sn_exponentials *memory, double h, sn_recursion *f) {
    int branches = memory->terms;
    sn_exponentials_factors(memory, h, f->decay, f->gain);
    // the viscous part is a branch that forgets at once: viscous dT/h
    if (memory->viscous > 0) {
        f->decay[branches] = 0.0;
        f->gain[branches++] = memory->viscous / h;
    }
    f->alpha = memory->g_inf;
    for (int k = 0; k < branches; k++) f->alpha += f->gain[k];
}

void sn_net_factors(const sn_net *net, double h, sn_factors *factors) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        sn_recursion *f = factors[r].part;
        set_factors(&g->memory, h, &f[0]);
        for (int p = 1; p < SN_PARTS; p++) {
            if (g->tissue.branched)
                set_factors(sn_region_memory(g, (sn_part)p), h, &f[p]);
            else
                f[p] = f[0];
        }
    }
}

void sn_net_no_impulse(const sn_net *net, sn_factors *factors) {
    for (int r = 0; r < net->region_count; r++)
        for (int p = 0; p < SN_PARTS; p++) {
            const sn_exponentials *memory = sn_region_memory(&net->region[r], (sn_part)p);
            sn_recursion *f = &factors[r].part[p];
            if (!(memory->viscous > 0)) continue;
            f->alpha -= f->gain[memory->terms];
            f->gain[memory->terms] = 0;
        }
}

// one kind of item of one region
static void item_history(const sn_net_store *place, size_t branches, const sn_recursion *factors,
                         const double *store, double *history) {
    const size_t count = (size_t)place->components * SN_BLOCK;
    double gain = 0.0;
    for (size_t k = 0; k < branches; k++) gain += factors->gain[k];
    for (size_t b = 0; branches > 0 && b < (size_t)place->blocks; b++) {
        const double *before = store + place->first + b * (1 + branches) * count;
        double *out = history + place->first + b * count;
        for (size_t i = 0; i < count; i++) {
            double sum = -gain * before[i];
            for (size_t k = 0; k < branches; k++)
                sum += factors->decay[k] * before[(1 + k) * count + i];
            out[i] = sum;
        }
    }
}

void sn_net_history(const sn_net *net, const sn_factors *factors, const double *store,
                    double *history) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        sn_net_store place[SN_STORES];
        sn_region_stores(net, g, place);
        for (int k = 0; k < SN_STORES; k++)
            item_history(&place[k], (size_t)sn_region_branches(g, place[k].part),
                         &factors[r].part[place[k].part], store, history);
    }
}
