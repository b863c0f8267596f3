// The memory of the tissues in an order that does not depend on the number of ranks.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/shelf.h"

enum { N = SN_FE_POINTS };

static size_t kept(const sn_fe_shelf *shelf, int region) {
    return sn_fe_material_kept(shelf->problem->materials->material + region);
}

void sn_fe_shelf_free(sn_fe_shelf *shelf) {
    sn_free(shelf->start);
    sn_free(shelf->cells);
    sn_free(shelf->place);
    sn_free(shelf->all);
    *shelf = (sn_fe_shelf){0};
}

sn_status sn_fe_shelf_init(const sn_fe_problem *p, bool room, sn_fe_shelf *shelf) {
    const sn_mesh *mesh = p->c->mesh;
    int width = p->space->batch_cells;
    *shelf = (sn_fe_shelf){.problem = p};
    shelf->start = sn_alloc((size_t)mesh->region_count, sizeof *shelf->start);
    shelf->cells = sn_alloc((size_t)mesh->region_count, sizeof *shelf->cells);
    shelf->place = sn_alloc((size_t)mesh->cell_count, sizeof *shelf->place);
    if (!shelf->start || !shelf->cells || !shelf->place) return SN_E_MEMORY;
    for (int c = 0; c < mesh->cell_count; c++) shelf->place[c] = shelf->cells[mesh->region[c]]++;
    for (int r = 0; r < mesh->region_count; r++) {
        size_t batches = (size_t)((shelf->cells[r] + width - 1) / width);
        shelf->start[r] = shelf->total;
        shelf->total += kept(shelf, r) * N * batches;
    }
    if (room) shelf->all = sn_alloc(shelf->total, sizeof *shelf->all);
    return shelf->all || !room ? SN_OK : SN_E_MEMORY;
}

// Number k of the point q of a cell, from its place in its region.
static double *at(const sn_fe_shelf *shelf, int region, int place, size_t k, int q) {
    int width = shelf->problem->space->batch_cells;
    size_t batch = (size_t)(place / width) * kept(shelf, region);
    return shelf->all + shelf->start[region] + (batch + k) * N +
           (size_t)(q * width + place % width);
}

static size_t length_of(const sn_fe_shelf *shelf, int rank) {
    const sn_fe_space *s = shelf->problem->space;
    const sn_fe_ranks *ranks = s->ranks;
    size_t sum = 0;
    for (int k = ranks->cell_start[rank]; k < ranks->cell_start[rank + 1]; k++)
        sum += kept(shelf, shelf->problem->c->mesh->region[ranks->cell_list[k]]);
    return sum * (size_t)s->element.points;
}

// The numbers of the own cells: regions one after the other, cells rising, as batches hold them.
static void pack(const sn_fe_shelf *shelf, double *to) {
    const sn_fe_problem *p = shelf->problem;
    const sn_fe_space *s = p->space;
    int width = s->batch_cells;
    for (int b = 0; b < s->batches; b++) {
        const double *from = p->materials->state + p->materials->at[b];
        size_t numbers = kept(shelf, s->batch_region[b]);
        for (int c = 0; c < s->batch_count[b]; c++) {
            if (!sn_fe_cell_is_own(s->ranks, s->slot[b * width + c])) continue;
            for (size_t k = 0; k < numbers; k++)
                for (int q = 0; q < s->element.points; q++)
                    *to++ = from[k * N + (size_t)(q * width + c)];
        }
    }
}

static void unpack(const sn_fe_shelf *shelf, const double *from) {
    const sn_fe_ranks *ranks = shelf->problem->space->ranks;
    const sn_mesh *mesh = shelf->problem->c->mesh;
    for (int rank = 0; rank < ranks->count; rank++)
        for (int r = 0; r < mesh->region_count; r++)
            for (int n = ranks->cell_start[rank]; n < ranks->cell_start[rank + 1]; n++) {
                int cell = ranks->cell_list[n];
                if (mesh->region[cell] != r) continue;
                for (size_t k = 0; k < kept(shelf, r); k++)
                    for (int q = 0; q < shelf->problem->space->element.points; q++)
                        *at(shelf, r, shelf->place[cell], k, q) = *from++;
            }
}

// The last cell of a region fills its last batch.
static void repeat_last(const sn_fe_shelf *shelf) {
    const sn_fe_space *s = shelf->problem->space;
    for (int r = 0; r < shelf->problem->c->mesh->region_count; r++)
        for (int n = shelf->cells[r]; n > 0 && n % s->batch_cells; n++)
            for (size_t k = 0; k < kept(shelf, r); k++)
                for (int q = 0; q < s->element.points; q++)
                    *at(shelf, r, n, k, q) = *at(shelf, r, shelf->cells[r] - 1, k, q);
}

sn_status sn_fe_shelf_fill(sn_fe_shelf *shelf) {
    const sn_fe_ranks *ranks = shelf->problem->space->ranks;
    size_t *length = sn_alloc((size_t)ranks->count, sizeof *length), sum = 0;
    for (int p = 0; length && p < ranks->count; p++) sum += length[p] = length_of(shelf, p);
    size_t room = !length ? 0 : ranks->rank == 0 ? sum : length[ranks->rank];
    double *part = sn_alloc(room, sizeof *part);
    sn_status status = sn_fe_agree(ranks, length && part ? SN_OK : SN_E_MEMORY);
    if (status == SN_OK) {
        pack(shelf, part);
        sn_fe_gather_parts(ranks, length, part);
        if (ranks->rank == 0) {
            unpack(shelf, part);
            repeat_last(shelf);
        }
    }
    sn_free(length);
    sn_free(part);
    return status;
}

void sn_fe_shelf_take(const sn_fe_shelf *shelf) {
    const sn_fe_problem *p = shelf->problem;
    const sn_fe_space *s = p->space;
    int width = s->batch_cells;
    for (int b = 0; b < s->batches; b++) {
        int region = s->batch_region[b];
        double *to = p->materials->state + p->materials->at[b];
        for (int c = 0; c < width; c++)
            for (size_t k = 0; k < kept(shelf, region); k++)
                for (int q = 0; q < s->element.points; q++)
                    to[k * N + (size_t)(q * width + c)] =
                        *at(shelf, region, shelf->place[s->slot[b * width + c]], k, q);
    }
}
