// Calls the kernels in order: volumes, volume points, springs and cells (with smoothed edges
// between two passes of cells), nodes.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "springs/forces.h"
#include "springs/parts.h"

static size_t real_size(sn_precision p) {
    return p == SN_SINGLE ? sizeof(float) : sizeof(double);
}

// array + i numbers
static void *at(const void *array, sn_precision p, size_t i) {
    return array ? (char *)(uintptr_t)array + i * real_size(p) : NULL;
}

static void set_memory(const sn_net_region *region, const sn_force_call *call, sn_part part,
                       size_t store, const sn_factors *factors, sn_memory_pass *m) {
    const int branches = sn_region_branches(region, part);
    m->mode = branches > 0 ? call->mode : SN_MEMORY_OFF;
    if (m->mode == SN_MEMORY_OFF) return;
    const sn_recursion *f = &factors->part[part];
    m->branches = branches;
    m->g_inf = sn_region_memory(region, part)->g_inf;
    m->alpha = f->alpha;
    memcpy(m->decay, f->decay, (size_t)branches * sizeof *m->decay);
    memcpy(m->gain, f->gain, (size_t)branches * sizeof *m->gain);
    m->store = at(call->store, call->precision, store);
    // a history stands where its T does in the store
    m->history = at(call->history, call->precision, store);
}

// the parts of the stress of a branched tissue, each with its own memory
static void set_parts(const sn_net_region *region, const sn_force_call *call,
                      const sn_factors *factors, sn_cell_pass *pass) {
    pass->apart = region->tissue.branched && call->mode != SN_MEMORY_OFF;
    pass->fibre_value = NULL;
    if (!pass->apart) return;
    set_memory(region, call, SN_PART_VOLUMETRIC, region->bulk_store, factors, &pass->bulk_memory);
    if (region->splits == 1) return;
    pass->value = region->split[0].value;
    pass->value_f = region->split_value_f[0];
    pass->fibre_value = region->split[1].value;
    pass->fibre_value_f = region->split_value_f[1];
    set_memory(region, call, SN_PART_FIBRE, region->fibre_store, factors, &pass->fibre_memory);
}

static void set_cells(const sn_net *net, const sn_net_region *region, const sn_force_call *call,
                      const sn_factors *factors, sn_cell_pass *pass) {
    const sn_net_data *data = &net->data[call->precision];
    pass->gradient = data->gradient;
    pass->volume = sn_parts_volume(net, call->parts, call->precision);
    pass->u = call->u;
    memcpy(pass->axes, net->axes, sizeof pass->axes);
    pass->rotated = net->rotated;
    pass->turn = region->tissue.law->fibres ? data->turn : NULL;
    pass->law = region->tissue.law;
    pass->value = region->tissue.value;
    pass->value_f = region->value_f;
    pass->terms = region->tissue.terms;
    pass->volume_mode = net->volume_mode;
    pass->bulk = region->bulk;
    pass->pressure = call->out->pressure;
    pass->upright = call->upright && net->volume ? sn_region_upright(region) : 0.0;
    pass->first = sn_region_law_block(net, region);
    pass->shape = call->out->shape;
    pass->piola = call->out->piola;
    pass->share_start = net->edge_start;
    pass->share = net->edge_cell;
    pass->edge = net->cell_edge;
    if (call->bare && region->fibred) {
        pass->value = region->bare.value;
        pass->value_f = region->bare_f;
    }
    set_memory(region, call, SN_PART_DEVIATORIC, region->cell_store, factors, &pass->memory);
    if (net->rung != SN_RUNG_CENTRAL) set_parts(region, call, factors, pass);
}

// the fibres of a central net: cells that know nothing else, with the volume stress elsewhere
static void set_fibres(const sn_net_region *region, const sn_force_call *call,
                       const sn_factors *factors, const sn_cell_pass *cells, sn_cell_pass *pass) {
    if (region->splits == 1) return;
    *pass = *cells;
    pass->value = region->split[1].value;
    pass->value_f = region->split_value_f[1];
    pass->volume_mode = SN_VOLUME_NONE;
    pass->upright = 0.0;
    set_memory(region, call, SN_PART_FIBRE, region->fibre_store, factors, &pass->memory);
}

static void set_springs(const sn_net *net, const sn_net_region *region, const sn_force_call *call,
                        const sn_factors *factors, sn_spring_pass *pass) {
    pass->stiffness = sn_parts_stiffness(net, call->parts, call->precision);
    pass->exponent = region->exponent;
    pass->square = region->squared ? region->square : NULL;
    pass->u = call->u;
    pass->first = region->spring_block;
    set_memory(region, call, SN_PART_DEVIATORIC, region->spring_store, factors, &pass->memory);
}

static void set_points(const sn_net *net, const sn_net_region *region, const sn_force_call *call,
                       const sn_factors *factors, sn_point_pass *pass) {
    pass->start = net->point_start;
    pass->item = net->point_item;
    pass->growth = call->out->growth;
    pass->stiffness = sn_parts_point_stiffness(net, call->parts, call->precision);
    pass->pressure = call->out->pressure;
    pass->first = region->point_block;
    set_memory(region, call, SN_PART_VOLUMETRIC, region->point_store, factors, &pass->memory);
}

//---- tasks ---------------------------------------------------------------------------------------

/// One evaluation of the forces.
typedef struct force_work {
    const sn_net *net;
    const sn_force_call *call;
    const sn_spring_kernels *kernels;
    sn_node_pass nodes;
} force_work;

// corners of the items of tiles, of what cuts have left
static const uint16_t *corners_of(const force_work *w, const sn_tiles *t) {
    const sn_parts *parts = w->call->parts;
    if (parts && t == &w->net->cell_tiles) return parts->cell_corner;
    if (parts && t == &w->net->spring_tiles) return parts->spring_corner;
    return t->corner;
}

// part: first entry of these tiles among all forces
static sn_tile tile_of(const force_work *w, const sn_tiles *t, int k, int part) {
    const sn_precision p = w->call->precision;
    const size_t entry = (size_t)t->start[k];
    const sn_tile_place *place = &t->place[k];
    const sn_parts *parts = w->call->parts;
    const bool fans = parts && t == &w->net->fan_tiles;
    return (sn_tile){.block = place->block,
                     .blocks = place->blocks,
                     .nodes = t->start[k + 1] - t->start[k],
                     .node = t->node + entry,
                     .point = t->point ? t->point + entry : NULL,
                     .corner = corners_of(w, t) + place->corner,
                     .present = fans ? at(parts->present[p], p, place->corner) : NULL,
                     .ring = place->ring,
                     .closed = place->closed,
                     .position = at(t->position[p], p, 4 * entry),
                     .force = at(w->call->out->part, p, 4 * ((size_t)part + entry)),
                     .growth = at(w->call->out->growth, p, entry)};
}

static void volume_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->fan_tiles;
    const sn_tile tile = tile_of(w, t, k, 0);
    w->kernels->volumes(&w->call->out->cells[t->place[k].region], &tile);
}

static void point_task(void *context, int block) {
    const force_work *w = context;
    int r = 0;
    while (block >= w->net->region[r].point_block + w->net->region[r].point_blocks) r++;
    w->kernels->points(&w->call->out->points[r], block);
}

static void spring_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->spring_tiles;
    const sn_tile tile = tile_of(w, t, k, 0);
    if (w->call->parts && w->call->parts->spring_empty[k]) {
        memset(tile.force, 0, (size_t)tile.nodes * 4 * real_size(w->call->precision));
        return;
    }
    w->kernels->springs(&w->call->out->springs[t->place[k].region], &tile);
}

static void cell_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->cell_tiles;
    const sn_tile tile = tile_of(w, t, k, w->net->cell_part);
    w->kernels->cells(&w->call->out->cells[t->place[k].region], &tile);
}

static void shape_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->cell_tiles;
    const sn_tile tile = tile_of(w, t, k, 0);
    w->kernels->shapes(&w->call->out->cells[t->place[k].region], &tile);
}

static void edge_task(void *context, int block) {
    const force_work *w = context;
    int r = 0;
    while (block >= w->net->region[r].edge_block + w->net->region[r].edge_blocks) r++;
    w->kernels->edges(&w->call->out->cells[r], block);
}

static void share_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->cell_tiles;
    const sn_tile tile = tile_of(w, t, k, w->net->cell_part);
    w->kernels->shares(&w->call->out->cells[t->place[k].region], &tile);
}

static void press_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->fan_tiles;
    const sn_tile tile = tile_of(w, t, k, w->net->fan_part);
    w->kernels->press(&w->call->out->cells[t->place[k].region], &tile);
}

static void fibre_task(void *context, int k) {
    const force_work *w = context;
    const sn_tiles *t = &w->net->cell_tiles;
    const sn_tile tile = tile_of(w, t, k, w->net->cell_part);
    if (w->call->bare)
        memset(tile.force, 0, 4 * (size_t)tile.nodes * real_size(w->call->precision));
    else
        w->kernels->cells(&w->call->out->fibre[t->place[k].region], &tile);
}

// springs, then what presses on the same nodes, then fibres
static void central_task(void *context, int k) {
    const force_work *w = context;
    const int springs = w->net->spring_tiles.count, fans = w->net->fan_tiles.count;
    if (k < springs)
        spring_task(context, k);
    else if (k < springs + fans)
        press_task(context, k - springs);
    else
        fibre_task(context, k - springs - fans);
}

static void node_task(void *context, int chunk) {
    const force_work *w = context;
    w->kernels->nodes(&w->nodes, chunk);
}

/// Tasks that need no others of their own kind.
typedef struct force_stage {
    sn_team_task *task;
    int count;
} force_stage;
enum { STAGES = 6 };

// the stages of an evaluation, in order; returns how many
static int list_stages(const sn_net *net, force_stage *stage) {
    const int springs = net->spring_tiles.count, fans = net->fan_tiles.count;
    const int cells = net->cell_tiles.count;
    int n = 0;
    if (net->volume) {
        stage[n++] = (force_stage){volume_task, fans};
        stage[n++] = (force_stage){point_task, net->point_blocks};
    }
    if (net->rung == SN_RUNG_COUPLED) {
        stage[n++] = (force_stage){cell_task, cells};
    } else if (net->rung == SN_RUNG_SMOOTHED) {
        stage[n++] = (force_stage){shape_task, cells};
        stage[n++] = (force_stage){edge_task, net->edge_blocks};
        stage[n++] = (force_stage){share_task, cells};
    } else {
        stage[n++] = (force_stage){central_task, springs + fans + cells};
    }
    stage[n++] = (force_stage){node_task, sn_net_chunks(net)};
    SN_ASSERT(n <= STAGES);
    return n;
}

/// Tasks of a stage from `first` on.
typedef struct stage_part {
    force_work *work;
    sn_team_task *task;
    int first;
} stage_part;

static void part_task(void *context, int k) {
    const stage_part *p = context;
    p->task(p->work, p->first + k);
}

int sn_net_force_tasks(const sn_net *net) {
    force_stage stage[STAGES];
    int tasks = 0;
    for (int k = 0, n = list_stages(net, stage); k < n; k++) tasks += stage[k].count;
    return tasks;
}

void sn_net_forces_part(const sn_net *net, const sn_force_call *call, int first, int count) {
    force_work w = {.net = net,
                    .call = call,
                    .kernels = sn_spring_kernels_row(net->isa, call->precision),
                    .nodes = {.nodes = net->nodes,
                              .weight = net->data[call->precision].weight,
                              .start = net->node_start,
                              .item = net->node_item,
                              .part = call->out->part,
                              .force = call->out->f}};
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        const sn_factors *factors = call->factors ? &call->factors[r] : NULL;
        set_cells(net, region, call, factors, &call->out->cells[r]);
        if (net->rung == SN_RUNG_CENTRAL)
            set_fibres(region, call, factors, &call->out->cells[r], &call->out->fibre[r]);
        set_springs(net, region, call, factors, &call->out->springs[r]);
        set_points(net, region, call, factors, &call->out->points[r]);
    }
    force_stage stage[STAGES];
    const int stages = list_stages(net, stage), last = first + count;
    for (int k = 0, from = 0; k < stages; from += stage[k++].count) {
        const int low = first > from ? first - from : 0;
        const int high = last - from < stage[k].count ? last - from : stage[k].count;
        stage_part part = {&w, stage[k].task, low};
        if (low < high) sn_team_run(call->team, high - low, part_task, &part);
    }
}

void sn_net_forces(const sn_net *net, const sn_force_call *call) {
    sn_net_forces_part(net, call, 0, sn_net_force_tasks(net));
}

sn_status sn_scratch_create(const sn_net *net, sn_precision precision, sn_scratch *scratch) {
    const size_t size = real_size(precision), regions = (size_t)net->region_count;
    scratch->f = sn_alloc((size_t)net->nodes * 4, size);
    scratch->part = sn_alloc((size_t)net->part_count * 4, size);
    scratch->growth = sn_alloc((size_t)sn_tiles_entries(&net->fan_tiles), size);
    const size_t cells = net->rung == SN_RUNG_SMOOTHED ? (size_t)net->cell_blocks * SN_BLOCK : 0;
    scratch->shape = sn_alloc(cells * 12, size);
    scratch->piola = sn_alloc((size_t)net->edge_blocks * SN_BLOCK * 12, size);
    scratch->pressure = sn_alloc((size_t)net->point_blocks * SN_BLOCK, size);
    scratch->cells = sn_alloc(regions, sizeof *scratch->cells);
    scratch->fibre = sn_alloc(regions, sizeof *scratch->fibre);
    scratch->springs = sn_alloc(regions, sizeof *scratch->springs);
    scratch->points = sn_alloc(regions, sizeof *scratch->points);
    bool all = scratch->f && scratch->part && scratch->growth && scratch->shape && scratch->piola &&
               scratch->pressure && scratch->cells && scratch->fibre && scratch->springs &&
               scratch->points;
    return all ? SN_OK : SN_E_MEMORY;
}

void sn_scratch_destroy(sn_scratch *scratch) {
    void *all[] = {scratch->f,       scratch->part,  scratch->growth, scratch->pressure,
                   scratch->shape,   scratch->piola, scratch->cells,  scratch->fibre,
                   scratch->springs, scratch->points};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    *scratch = (sn_scratch){0};
}
