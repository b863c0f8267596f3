// Cuts: cells that a running state loses.
// SPDX-License-Identifier: Apache-2.0
//
// A net is constant, so what a cut changes stands with the state: copies of the arrays in which
// cells have their share (sn_parts), made with the state where the net is cuttable. They follow
// from the set of removed cells alone, whatever the order of the cuts, so a snapshot holds that
// set and no more. Before the first cut a state reads the arrays of its net.
//
// - A removed cell has no volume and all its corners at one node: no strain, no force, however far
//   its nodes fly apart. Springs keep the part of their stiffness that the cells left around them
//   had; one that has none stands where another of its tile stands (two nodes at one place would
//   divide by zero) with stiffness 0. Fans skip cells. Volume points and smoothed edges are means
//   over the cells that are left.
// - Masses stay. A node that has lost all its cells is loose: it flies on by itself, with its
//   weight, and neither tools nor loads see it.
// - What the memory of a place holds stays with what is left of it: the branches keep their
//   stress. The instantaneous stress from which the next step counts its change is taken anew,
//   since the mean of a volume point or smoothed edge is another one without the cell. What is
//   gone forgets.
// - The velocity of the explicit step is half a step behind. It is brought up to the present place
//   by the forces before the cut and back by those after it: a cut moves nothing and its forces
//   act from its time on.
#include "springs/cut.h"

#include <math.h>
#include <string.h>

#include "springs/run.h"
#include "springs/steps.h"
#include "springs/vectors.h"

static const double same_time = 1e-9; // of the whole time: two times that are one

//---- life ----------------------------------------------------------------------------------------

static size_t most_of(size_t a, size_t b) {
    return a > b ? a : b;
}

// room for a copy of count numbers in both precisions, as far as the net has them
static bool copies(const sn_net *net, const void *const from[2], size_t count, void *to[2]) {
    const bool single = net->precision == SN_SINGLE && from[SN_SINGLE];
    to[SN_SINGLE] = single ? sn_alloc(count, sizeof(float)) : NULL;
    to[SN_DOUBLE] = sn_alloc(count, sizeof(double));
    return to[SN_DOUBLE] && (!single || to[SN_SINGLE]);
}

static sn_status create_loads(const sn_net *net, sn_cut *cut) {
    const size_t loads = (size_t)net->load_count;
    cut->load_force = sn_alloc(loads, sizeof *cut->load_force);
    cut->load_gone = sn_alloc(loads, sizeof *cut->load_gone);
    if (!cut->load_force || !cut->load_gone) return SN_E_MEMORY;
    for (size_t l = 0; l < loads; l++) {
        const size_t count = (size_t)net->load[l].count;
        if (net->load[l].kind == SN_LOAD_PRESSURE)
            cut->load_gone[l] = sn_alloc(count, sizeof **cut->load_gone);
        else
            cut->load_force[l] = sn_alloc(count * 3, sizeof **cut->load_force);
        if (!cut->load_gone[l] && !cut->load_force[l]) return SN_E_MEMORY;
    }
    return SN_OK;
}

static sn_status create_arrays(const sn_net *net, sn_cut *cut) {
    const sn_net_data *d = &net->data[SN_DOUBLE], *f = &net->data[SN_SINGLE];
    const size_t slots = (size_t)net->cell_blocks * SN_BLOCK, nodes = (size_t)net->nodes;
    const size_t springs = (size_t)net->spring_blocks * SN_BLOCK;
    const size_t points = (size_t)net->point_blocks * SN_BLOCK;
    const size_t most = most_of(most_of(springs, points), nodes);
    const double one = 1;
    bool all =
        copies(net, (const void *[]){f->volume, d->volume}, slots, cut->volume) &&
        copies(net, (const void *[]){f->stiffness, NULL}, springs, cut->stiffness) &&
        copies(net, (const void *[]){f->point_stiffness, NULL}, points, cut->point_stiffness) &&
        copies(net, (const void *[]){&one, &one}, net->fan_tiles.corner_count, cut->present);
    cut->removed = sn_alloc((size_t)net->cells, sizeof *cut->removed);
    cut->point_volume = sn_alloc(points, sizeof *cut->point_volume);
    cut->spring_volume = sn_alloc(springs, sizeof *cut->spring_volume);
    cut->contact_stiffness = sn_alloc((size_t)net->contact_count, sizeof *cut->contact_stiffness);
    cut->cell_corner = sn_alloc(net->cell_tiles.corner_count, sizeof *cut->cell_corner);
    cut->spring_corner = sn_alloc(net->spring_tiles.corner_count, sizeof *cut->spring_corner);
    cut->spring_empty = sn_alloc((size_t)net->spring_tiles.count, 1);
    cut->rim = sn_alloc((size_t)net->cells, sizeof *cut->rim);
    cut->gone = sn_alloc(slots, sizeof *cut->gone);
    cut->loose = sn_alloc(nodes, sizeof *cut->loose);
    cut->piece = sn_alloc(nodes, sizeof *cut->piece);
    cut->rigid = sn_alloc(nodes / 4 + 1, sizeof *cut->rigid); // a piece has four nodes at least
    cut->touched = sn_alloc(most, sizeof *cut->touched);
    cut->sum = sn_alloc(most, sizeof *cut->sum);
    all = all && cut->removed && cut->point_volume && cut->spring_volume &&
          cut->contact_stiffness && cut->cell_corner && cut->spring_corner && cut->spring_empty &&
          cut->rim && cut->gone && cut->loose && cut->piece && cut->rigid && cut->touched &&
          cut->sum;
    return all ? create_loads(net, cut) : SN_E_MEMORY;
}

static void set_parts(sn_cut *cut) {
    sn_parts *p = &cut->parts;
    for (int k = 0; k < 2; k++) {
        p->volume[k] = cut->volume[k];
        p->stiffness[k] = cut->stiffness[k];
        p->point_stiffness[k] = cut->point_stiffness[k];
        p->present[k] = cut->present[k];
    }
    p->point_volume = cut->point_volume;
    p->spring_volume = cut->spring_volume;
    p->cell_corner = cut->cell_corner;
    p->spring_corner = cut->spring_corner;
    p->spring_empty = cut->spring_empty;
    p->rim = cut->rim;
    p->rim_count = &cut->rim_count;
    p->gone = cut->gone;
    p->loose = cut->loose;
    p->contact_stiffness = cut->contact_stiffness;
    p->load_force = cut->load_force;
    p->load_gone = cut->load_gone;
}

sn_status sn_cut_create(const sn_net *net, sn_cut **cut) {
    sn_cut *k = *cut = sn_alloc(1, sizeof *k); // a state that fails is destroyed whole
    if (!k) return SN_E_MEMORY;
    k->load_count = net->load_count;
    SN_TRY(create_arrays(net, k));
    set_parts(k);
    return SN_OK;
}

void sn_cut_destroy(sn_cut *k) {
    if (!k) return;
    for (int l = 0; l < k->load_count; l++) {
        if (k->load_force) sn_free(k->load_force[l]);
        if (k->load_gone) sn_free(k->load_gone[l]);
    }
    for (int p = 0; p < 2; p++) {
        sn_free(k->volume[p]);
        sn_free(k->stiffness[p]);
        sn_free(k->point_stiffness[p]);
        sn_free(k->present[p]);
    }
    void *all[] = {k->removed,      k->point_volume, k->spring_volume, k->contact_stiffness,
                   k->cell_corner,  k->rim,          k->gone,          k->spring_corner,
                   k->spring_empty, k->loose,        k->load_force,    k->load_gone,
                   k->piece,        k->rigid,        k->touched,       k->sum};
    for (size_t n = 0; n < sizeof all / sizeof *all; n++) sn_free(all[n]);
    sn_free(k);
}

void sn_cut_mend(const sn_net *net, sn_cut *cut) {
    memset(cut->removed, 0, (size_t)net->cells * sizeof *cut->removed);
    cut->count = cut->next = 0;
}

int sn_cut_pieces(const sn_net *net, sn_cut *cut, sn_piece *piece) {
    const sn_piece all[SN_CUT_PIECES] = {{cut->removed, (size_t)net->cells * sizeof *cut->removed},
                                         {&cut->next, sizeof cut->next}};
    memcpy(piece, all, sizeof all);
    return SN_CUT_PIECES;
}

//---- what was read -------------------------------------------------------------------------------

const sn_parts *sn_state_parts(const sn_state *s) {
    return s->cut && s->cut->count > 0 ? &s->cut->parts : NULL;
}
int sn_state_removed(const sn_state *s) {
    return s->cut ? s->cut->count : 0;
}
const int *sn_state_pieces(const sn_state *s, int *count) {
    if (!sn_state_parts(s)) return NULL;
    *count = s->cut->pieces;
    return s->cut->piece;
}
sn_rigid *sn_state_rigid(const sn_state *s) {
    return sn_state_parts(s) ? s->cut->rigid : NULL;
}
bool sn_state_has_free_piece(const sn_state *s) {
    return sn_state_parts(s) && s->cut->free_piece;
}

bool sn_state_is_cut(const sn_net *net, const sn_state *s, int cell) {
    SN_ASSERT(cell >= 0 && cell < net->cells);
    (void)net;
    return s->cut && s->cut->removed[cell];
}

bool sn_state_is_loose(const sn_net *net, const sn_state *s, int node) {
    SN_ASSERT(node >= 0 && node < net->nodes);
    return sn_state_parts(s) && s->cut->loose[net->node_place[node]];
}

bool sn_state_due_cut(const sn_net *net, sn_state *s, int *count, const int **cells) {
    const sn_cutting *k = net->cutting;
    if (!k || s->cut->next == k->count) return false;
    const int n = s->cut->next;
    if (k->at[n] > s->time + same_time * net->until) return false;
    *cells = k->cell + k->start[n];
    *count = k->start[n + 1] - k->start[n];
    s->cut->next++;
    return true;
}

//---- cutting -------------------------------------------------------------------------------------

// forgets a place: all its numbers in the store
static void forget(const sn_net_region *g, sn_state *s, const sn_net_store *store, size_t item) {
    const size_t branches = (size_t)sn_region_branches(g, store->part);
    const size_t components = (size_t)store->components, n = components * SN_BLOCK;
    const size_t at = store->first + item / SN_BLOCK * (1 + branches) * n + item % SN_BLOCK;
    for (size_t k = 0; branches > 0 && k < (1 + branches) * components; k++)
        sn_real_put(s->precision, s->store, at + k * SN_BLOCK, 0.0);
}

static double edge_volume(const sn_net *net, const double *volume, int edge) {
    double sum = 0;
    for (int k = net->edge_start[edge]; k < net->edge_start[edge + 1]; k++)
        sum += volume[net->edge_cell[k]];
    return sum;
}

// what is left of item k of a region: its stiffness or volume
static double left_of(const sn_net *net, const sn_net_region *g, const sn_parts *parts, int kind,
                      int k) {
    const double *stiffness = parts->stiffness[SN_DOUBLE];
    if (kind == SN_STORE_SPRING) return stiffness[g->spring_block * SN_BLOCK + k];
    if (kind == SN_STORE_POINT) return parts->point_volume[g->point_block * SN_BLOCK + k];
    const int place = sn_region_law_block(net, g) * SN_BLOCK + k;
    const double *volume = parts->volume[SN_DOUBLE];
    return net->rung == SN_RUNG_SMOOTHED ? edge_volume(net, volume, place) : volume[place];
}

// what is gone forgets
static void forget_all(const sn_net *net, sn_state *s) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        sn_net_store store[SN_STORES];
        sn_region_stores(net, g, store);
        for (int kind = 0; kind < SN_STORES; kind++)
            for (int k = 0; k < store[kind].blocks * SN_BLOCK; k++)
                if (!(left_of(net, g, &s->cut->parts, kind, k) > 0))
                    forget(g, s, &store[kind], (size_t)k);
    }
}

// forces of what is left; branches keep their stress, and the present stress is where the next
// step starts from
static void find_forces(const sn_net *net, sn_state *s) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *g = &net->region[r];
        for (int p = 0; p < SN_PARTS; p++) {
            sn_recursion *f = &s->factors[r].part[p];
            *f = (sn_recursion){.alpha = sn_region_memory(g, (sn_part)p)->g_inf};
            for (int k = 0; k < sn_region_branches(g, (sn_part)p); k++) f->decay[k] = 1.0;
        }
    }
    s->factors_step = 0;
    sn_state_find_forces(net, s);
}

// loose nodes leave the tools that hold them
static void let_go(sn_state *s) {
    int kept = 0;
    for (int k = 0; k < s->gripped_count; k++) {
        const int node = s->gripped[k];
        if (s->cut->loose[node])
            s->grip[node].tool = -1;
        else
            s->gripped[kept++] = node;
    }
    s->gripped_count = kept;
}

// what the next look starts from: the mode that was the highest, and motions without structure
// around the cut and everywhere
static void stir_mode(const sn_net *net, sn_state *s, int count, const int *cells) {
    uint64_t noise = SN_NOISE_START;
    const double part = 0.5 / sqrt((double)count);
    sn_lanczos_stir(net, s->mode);
    for (int c = 0; c < count; c++)
        for (int a = 0; a < 4; a++) {
            const int slot = net->cell_slot[cells[c]];
            const int node = net->cell_node[(slot / SN_BLOCK * 4 + a) * SN_BLOCK + slot % SN_BLOCK];
            for (int d = 0; d < 3 && !s->cut->loose[node]; d++)
                s->mode[3 * node + d] += part * sn_noise(&noise);
        }
}

static sn_status check(const sn_net *net, int count, const int *cells) {
    if (!net->cuttable)
        return sn_fail(SN_E_UNSUPPORTED, "springs: a state of this net cannot be cut: set "
                                         "springs.cuttable in the case before the net is built");
    for (int k = 0; k < count; k++)
        if (cells[k] < 0 || cells[k] >= net->cells)
            return sn_fail(SN_E_RANGE,
                           "springs: cut of cell %d: the mesh has cells 0 to %d; nothing was cut",
                           cells[k], net->cells - 1);
    return SN_OK;
}

sn_status sn_state_cut(const sn_net *net, sn_state *s, int count, const int *cells, int *removed) {
    int taken = 0;
    if (removed) *removed = 0;
    SN_TRY(check(net, count, cells));
    if (net->integrator == SN_INTEGRATOR_EXPLICIT) sn_state_finish_look(net, s);
    for (int k = 0; k < count; k++) {
        taken += !s->cut->removed[cells[k]];
        s->cut->removed[cells[k]] = true;
    }
    if (removed) *removed = taken;
    if (taken == 0) return SN_OK;
    const bool explicit = net->integrator == SN_INTEGRATOR_EXPLICIT;
    if (explicit) sn_state_half_kick(net, s, 0.5 * s->last_step);
    sn_cut_restore(net, s->cut);
    forget_all(net, s);
    find_forces(net, s);
    if (explicit) {
        sn_state_half_kick(net, s, -0.5 * s->last_step);
        let_go(s);
        stir_mode(net, s, count, cells);
        sn_state_doubt_frequency(net, s);
    }
    if (s->implicit) sn_implicit_restart(s->implicit);
    return SN_OK;
}

sn_status sn_run_cut(sn_run *run, sn_state *s, const sn_moment *before, int count,
                     const int *cells) {
    run->released += sn_run_store(run, before);
    SN_TRY(sn_state_cut(run->net, s, count, cells, NULL));
    run->summary->cells_removed = s->cut->count;
    return SN_OK;
}
