// Calls the kernels in order: volumes, volume points, cells, springs, nodes.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "springs/net.h"

static size_t real_size(sn_precision p) {
    return p == SN_SINGLE ? sizeof(float) : sizeof(double);
}

// array + i numbers
static void *at(const void *array, sn_precision p, size_t i) {
    return array ? (char *)(uintptr_t)array + i * real_size(p) : NULL;
}

static void set_memory(const sn_net_region *region, const sn_force_call *call, size_t store,
                       const sn_factors *factors, sn_memory_pass *m) {
    m->mode = region->branches > 0 ? call->mode : SN_MEMORY_OFF;
    if (m->mode == SN_MEMORY_OFF) return;
    m->branches = region->branches;
    m->g_inf = region->memory.g_inf;
    m->alpha = factors->alpha;
    memcpy(m->decay, factors->decay, (size_t)region->branches * sizeof *m->decay);
    memcpy(m->gain, factors->gain, (size_t)region->branches * sizeof *m->gain);
    m->store = at(call->store, call->precision, store);
    // a history stands where its T does in the store
    m->history = at(call->history, call->precision, store);
}

static void set_cells(const sn_net *net, const sn_net_region *region, const sn_force_call *call,
                      sn_cell_pass *pass) {
    const sn_net_data *data = &net->data[call->precision];
    const sn_precision p = call->precision;
    const size_t slot = (size_t)region->cell_block * SN_BLOCK;
    pass->blocks = region->cell_blocks;
    pass->node = net->cell_node + 4 * slot;
    pass->gradient = at(data->gradient, p, 9 * slot);
    pass->volume = at(data->volume, p, slot);
    pass->u = call->u;
    memcpy(pass->axes, net->axes, sizeof pass->axes);
    pass->rotated = net->rotated;
    pass->law = net->rung == SN_RUNG_COUPLED ? region->tissue.law : NULL;
    pass->value = region->tissue.value;
    pass->value_f = region->value_f;
    pass->terms = region->tissue.terms;
    pass->volume_mode = net->volume_mode;
    pass->bulk = region->bulk;
    pass->point = net->cell_point + 4 * slot;
    pass->pressure = call->out->pressure;
    pass->growth = at(call->out->growth, p, slot);
    pass->force = at(call->out->cell_force, p, 16 * slot);
}

static void set_springs(const sn_net *net, const sn_net_region *region, const sn_force_call *call,
                        sn_spring_pass *pass) {
    const sn_net_data *data = &net->data[call->precision];
    const sn_precision p = call->precision;
    const size_t slot = (size_t)region->spring_block * SN_BLOCK;
    pass->blocks = region->spring_blocks;
    pass->end = net->spring_end + 2 * slot;
    pass->edge = at(data->edge, p, 3 * slot);
    pass->inverse = at(data->inverse, p, slot);
    pass->stiffness = at(data->stiffness, p, slot);
    pass->exponent = region->exponent;
    pass->u = call->u;
    pass->force = at(call->out->spring_force, p, 4 * slot);
}

static void volume_points(const sn_net *net, const sn_spring_kernels *kernels,
                          const sn_force_call *call) {
    for (int r = 0; r < net->region_count; r++) {
        sn_cell_pass pass;
        set_cells(net, &net->region[r], call, &pass);
        kernels->volumes(&pass);
    }
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        const size_t point = (size_t)region->point_block * SN_BLOCK;
        sn_point_pass pass = {
            .blocks = region->point_blocks,
            .start = net->point_start + point,
            .item = net->point_item,
            .growth = call->out->growth,
            .stiffness = at(net->data[call->precision].point_stiffness, call->precision, point),
            .pressure = at(call->out->pressure, call->precision, point)};
        set_memory(region, call, region->point_store, call->factors ? &call->factors[r] : NULL,
                   &pass.memory);
        kernels->points(&pass);
    }
}

void sn_net_forces(const sn_net *net, const sn_force_call *call) {
    const sn_spring_kernels *kernels = sn_spring_kernels_row(net->isa, call->precision);
    if (net->volume) volume_points(net, kernels, call);
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        const sn_factors *factors = call->factors ? &call->factors[r] : NULL;
        if (net->rung == SN_RUNG_COUPLED || net->volume) {
            sn_cell_pass pass;
            set_cells(net, region, call, &pass);
            set_memory(region, call, region->cell_store, factors, &pass.memory);
            kernels->cells(&pass);
        }
        if (net->rung == SN_RUNG_CENTRAL) {
            sn_spring_pass pass;
            set_springs(net, region, call, &pass);
            set_memory(region, call, region->spring_store, factors, &pass.memory);
            kernels->springs(&pass);
        }
    }
    const sn_node_pass pass = {.nodes = net->nodes,
                               .weight = net->data[call->precision].weight,
                               .start = net->node_start,
                               .item = net->node_item,
                               .spring_force = call->out->spring_force,
                               .cell_force = call->out->cell_force,
                               .force = call->out->f};
    kernels->nodes(&pass);
}

sn_status sn_scratch_create(const sn_net *net, sn_precision precision, sn_scratch *scratch) {
    const size_t size = real_size(precision);
    const size_t cells = (size_t)net->cell_blocks * SN_BLOCK;
    scratch->f = sn_alloc((size_t)net->nodes * 4, size);
    scratch->cell_force =
        sn_alloc(net->rung == SN_RUNG_COUPLED || net->volume ? cells * 16 : 0, size);
    scratch->spring_force = sn_alloc((size_t)net->spring_blocks * SN_BLOCK * 4, size);
    scratch->growth = sn_alloc(net->volume ? cells : 0, size);
    scratch->pressure = sn_alloc((size_t)net->point_blocks * SN_BLOCK, size);
    bool all = scratch->f && scratch->cell_force && scratch->spring_force && scratch->growth &&
               scratch->pressure;
    return all ? SN_OK : SN_E_MEMORY;
}

void sn_scratch_destroy(sn_scratch *scratch) {
    sn_free(scratch->f);
    sn_free(scratch->cell_force);
    sn_free(scratch->spring_force);
    sn_free(scratch->growth);
    sn_free(scratch->pressure);
    *scratch = (sn_scratch){0};
}

void sn_net_factors(const sn_net *net, double h, sn_factors *factors) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        sn_factors *f = &factors[r];
        sn_exponentials_factors(&region->memory, h, f->decay, f->gain);
        // the viscous part is a branch that forgets at once: viscous dT/h
        if (region->branches > region->memory.terms) {
            f->decay[region->memory.terms] = 0.0;
            f->gain[region->memory.terms] = region->memory.viscous / h;
        }
        f->alpha = region->memory.g_inf;
        for (int k = 0; k < region->branches; k++) f->alpha += f->gain[k];
    }
}

// one kind of item of one region
static void item_history(const sn_net_region *region, const sn_factors *factors, size_t first,
                         int blocks, int n, const double *store, double *history) {
    const size_t branches = (size_t)region->branches, count = (size_t)n;
    double gain = 0.0;
    for (size_t k = 0; k < branches; k++) gain += factors->gain[k];
    for (size_t b = 0; branches > 0 && b < (size_t)blocks; b++) {
        const double *before = store + first + b * (1 + branches) * count;
        double *out = history + first + b * count;
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
    const int components = net->volume_mode == SN_VOLUME_CELL ? 7 : 6;
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        if (net->rung == SN_RUNG_COUPLED)
            item_history(g, &factors[r], g->cell_store, g->cell_blocks, components * SN_BLOCK,
                         store, history);
        else
            item_history(g, &factors[r], g->spring_store, g->spring_blocks, SN_BLOCK, store,
                         history);
        if (net->volume)
            item_history(g, &factors[r], g->point_store, g->point_blocks, SN_BLOCK, store, history);
    }
}
