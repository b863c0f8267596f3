// The sparse matrix of the free unknowns: its entries, where each cell adds, the values.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/pattern.h"

#include <limits.h>
#include <stdlib.h>

#include "base/sort.h"

// The blocks of each rank: its nodes, then its pressures.
static sn_status order_blocks(const sn_fe_space *s, sn_fe_pattern *p) {
    const sn_fe_ranks *r = s->ranks;
    p->by_row = sn_alloc((size_t)p->blocks, sizeof *p->by_row);
    p->order = sn_alloc((size_t)p->blocks, sizeof *p->order);
    if (!p->by_row || !p->order) return SN_E_MEMORY;
    p->own_to = p->blocks;
    for (int b = 0; b < p->blocks; b++) p->by_row[b] = b;
    for (int rank = 0, to = 0; rank < r->count && r->count > 1; rank++) {
        const int *node = r->node_list + r->node_start[rank];
        if (rank == r->rank) p->own_from = to;
        for (int k = 0; k < r->node_start[rank + 1] - r->node_start[rank]; k++)
            p->by_row[to++] = node[k];
        for (int k = 0; k < r->corners[rank] && s->element.mixed; k++)
            p->by_row[to++] = s->nodes + node[k];
        if (rank == r->rank) p->own_to = to;
    }
    for (int k = 0; k < p->blocks; k++) p->order[p->by_row[k]] = k;
    return SN_OK;
}

// Rows of one block from `first` on; returns how many.
static int number_block(const sn_fe_space *s, int b, int first, sn_fe_pattern *p) {
    int width = b < s->nodes ? 3 : 1, place = 0, dof = sn_fe_block_dof(s, b);
    unsigned fixed = b < s->nodes ? s->fixed[b] : 0u;
    for (int i = 0; i < 3; i++) {
        bool pinned = false;
        for (int k = 0; k < s->free_motions; k++) pinned |= s->pin[k] == 3 * b + i;
        pinned &= i < width && b < s->nodes;
        bool free = i < width && !(fixed >> i & 1u) && !pinned;
        p->local[3 * b + i] = (signed char)(free ? place : -1);
        if (i < width)
            p->row[dof + i] = free ? first + place : pinned ? SN_FE_PINNED : SN_FE_PRESCRIBED;
        place += free || (p->whole && i < width);
        p->unknowns += free;
    }
    return place;
}

static sn_status number_rows(const sn_fe_space *s, sn_fe_pattern *p) {
    p->row = sn_alloc((size_t)s->dofs, sizeof *p->row);
    p->local = sn_alloc(3 * (size_t)p->blocks, 1);
    p->own = sn_alloc(3 * (size_t)p->blocks, 1);
    p->block_row = sn_alloc((size_t)p->blocks + 1, sizeof *p->block_row);
    if (!p->row || !p->local || !p->own || !p->block_row) return SN_E_MEMORY;
    for (int k = 0; k < p->blocks; k++) {
        int b = p->by_row[k];
        bool own = k >= p->own_from && k < p->own_to;
        if (k == p->own_from) p->first = p->total;
        p->block_row[b] = p->total;
        p->total += number_block(s, b, p->total, p);
        for (int i = 0; i < 3; i++) p->own[3 * b + i] = own ? p->local[3 * b + i] : -1;
        if (!own) continue;
        p->rows = p->total - p->first;
        if (b < s->nodes) p->pressures = p->rows;
    }
    return SN_OK;
}

static int block_width(const sn_fe_space *s, const sn_fe_pattern *p, int block) {
    int width = 0;
    if (p->whole) return block < s->nodes ? 3 : 1;
    for (int i = 0; i < 3; i++) width += p->local[3 * block + i] >= 0;
    return width;
}

// For every block the places (batch * cells + at) of the cells that hold it.
static sn_status list_cells(const sn_fe_space *s, const sn_fe_pattern *p, int **start, int **list) {
    *start = sn_alloc((size_t)p->blocks + 1, sizeof **start);
    if (!*start) return SN_E_MEMORY;
    for (int pass = 0; pass < 2; pass++) {
        for (int b = 0; b < s->batches; b++)
            for (int at = 0; at < s->batch_count[b]; at++)
                for (int k = 0; k < p->cell_blocks; k++) {
                    int block = sn_fe_cell_block(s, b, at, k);
                    if (pass)
                        (*list)[(*start)[block]++] = b * s->batch_cells + at;
                    else
                        (*start)[block + 1]++;
                }
        if (!pass) {
            for (int k = 0; k < p->blocks; k++) (*start)[k + 1] += (*start)[k];
            *list = sn_alloc((size_t)(*start)[p->blocks], sizeof **list);
            if (!*list) return SN_E_MEMORY;
        }
    }
    for (int k = p->blocks; k > 0; k--) (*start)[k] = (*start)[k - 1]; // the second pass moved them
    (*start)[0] = 0;
    return SN_OK;
}

// Neighbours of one block into `out`, by their rows; returns how many.
static int gather_near(const sn_fe_space *s, const sn_fe_pattern *p, const int *cell, int cells,
                       int block, int *seen, int *out) {
    int count = 0;
    for (int c = 0; c < cells; c++)
        for (int k = 0; k < p->cell_blocks; k++) {
            int other = sn_fe_cell_block(s, cell[c] / s->batch_cells, cell[c] % s->batch_cells, k);
            if (seen[other] == block + 1) continue;
            seen[other] = block + 1;
            out[count++] = p->order[other];
        }
    qsort(out, (size_t)count, sizeof *out, compare_int);
    for (int k = 0; k < count; k++) out[k] = p->by_row[out[k]];
    return count;
}

static sn_status find_neighbours(const sn_fe_space *s, sn_fe_pattern *p) {
    int *start = NULL, *list = NULL, *seen = NULL, *found = NULL;
    size_t room = 0;
    sn_status status = SN_OK;
    SN_TRY_GOTO(status, list_cells(s, p, &start, &list));
    p->near_at = sn_alloc((size_t)p->blocks + 1, sizeof *p->near_at);
    seen = sn_alloc((size_t)p->blocks, sizeof *seen);
    status = SN_E_MEMORY;
    if (!p->near_at || !seen) goto fail;
    for (int b = 0; b < p->blocks; b++) {
        size_t used = (size_t)p->near_at[b];
        p->near_at[b + 1] = p->near_at[b];
        if (p->order[b] < p->own_from || p->order[b] >= p->own_to) continue;
        size_t most = (size_t)(start[b + 1] - start[b]) * (size_t)p->cell_blocks;
        if (used + most > room) {
            room = 2 * (used + most);
            int *more = sn_resize(found, room, sizeof *found);
            if (!more) goto fail;
            found = more;
        }
        int count =
            gather_near(s, p, list + start[b], start[b + 1] - start[b], b, seen, found + used);
        p->near_at[b + 1] = p->near_at[b] + count;
    }
    p->near = found;
    found = NULL;
    status = SN_OK;
fail:
    sn_free(start);
    sn_free(list);
    sn_free(seen);
    sn_free(found);
    return status;
}

static sn_status lay_rows(const sn_fe_space *s, sn_fe_pattern *p) {
    p->near_offset = sn_alloc((size_t)p->near_at[p->blocks], sizeof *p->near_offset);
    p->base = sn_alloc((size_t)p->blocks, sizeof *p->base);
    p->length = sn_alloc((size_t)p->blocks, sizeof *p->length);
    p->row_start = sn_alloc((size_t)p->rows + 1, sizeof *p->row_start);
    if (!p->near_offset || !p->base || !p->length || !p->row_start) return SN_E_MEMORY;
    long long entries = 0;
    for (int place = p->own_from, row = 0; place < p->own_to; place++) {
        int b = p->by_row[place];
        for (int k = p->near_at[b]; k < p->near_at[b + 1]; k++) {
            p->near_offset[k] = p->length[b];
            p->length[b] += block_width(s, p, p->near[k]);
        }
        p->base[b] = (int)entries;
        for (int i = block_width(s, p, b); i > 0; i--) {
            entries += p->length[b];
            if (entries > INT_MAX)
                return sn_fail(SN_E_RANGE,
                               "the matrix has more than 2^31 entries, which the solver's 32-bit "
                               "indices cannot hold; use more ranks, a coarser mesh or element: "
                               "P1");
            p->row_start[++row] = (int)entries;
        }
    }
    p->column = sn_alloc((size_t)entries, sizeof *p->column);
    return p->column ? SN_OK : SN_E_MEMORY;
}

static void fill_columns(const sn_fe_space *s, sn_fe_pattern *p) {
    for (int place = p->own_from; place < p->own_to; place++) {
        int b = p->by_row[place], *to = p->column + p->base[b], count = 0;
        int width = block_width(s, p, b);
        for (int k = p->near_at[b]; k < p->near_at[b + 1] && width > 0; k++)
            for (int j = 0; j < block_width(s, p, p->near[k]); j++)
                to[count++] = p->block_row[p->near[k]] + j;
        for (int i = 1; i < width; i++)
            for (int k = 0; k < count; k++) to[i * count + k] = to[k];
    }
}

int sn_fe_pattern_offset(const sn_fe_pattern *p, int A, int B) {
    int low = p->near_at[A], high = p->near_at[A + 1];
    if (low == high) return 0; // of another rank
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (p->order[p->near[middle]] <= p->order[B])
            low = middle;
        else
            high = middle;
    }
    SN_ASSERT(p->near[low] == B);
    return p->near_offset[low];
}

static sn_status find_held(const sn_fe_space *s, sn_fe_pattern *p) {
    for (int pass = 0; pass < 2 && p->whole; pass++) { // count, then fill
        int count = 0;
        for (int place = p->own_from; place < p->own_to; place++) {
            int b = p->by_row[place];
            for (int i = 0; i < 3 && b < s->nodes; i++) {
                if (p->local[3 * b + i] >= 0) continue;
                if (pass)
                    p->held[count] =
                        p->base[b] + i * (p->length[b] + 1) + sn_fe_pattern_offset(p, b, b);
                count++;
            }
        }
        p->held_count = count;
        if (!pass && !(p->held = sn_alloc((size_t)count, sizeof *p->held))) return SN_E_MEMORY;
    }
    return SN_OK;
}

static sn_status map_cells(const sn_fe_space *s, sn_fe_pattern *p) {
    int blocks = p->cell_blocks;
    size_t pairs = (size_t)(blocks * blocks);
    p->offset = sn_alloc((size_t)s->batches * (size_t)s->batch_cells * pairs, sizeof *p->offset);
    if (!p->offset) return SN_E_MEMORY;
    for (int b = 0; b < s->batches; b++)
        for (int at = 0; at < s->batch_count[b]; at++) {
            int *to = p->offset + (size_t)(b * s->batch_cells + at) * pairs;
            for (int A = 0; A < blocks; A++)
                for (int B = 0; B < blocks; B++)
                    *to++ = sn_fe_pattern_offset(p, sn_fe_cell_block(s, b, at, A),
                                                 sn_fe_cell_block(s, b, at, B));
        }
    return SN_OK;
}

void sn_fe_pattern_destroy(sn_fe_pattern *p) {
    if (!p) return;
    void *const parts[] = {p->row,     p->local, p->own,         p->base,   p->length,
                           p->near_at, p->near,  p->near_offset, p->offset, p->row_start,
                           p->column,  p->held,  p->by_row,      p->order,  p->block_row};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(p);
}

sn_status sn_fe_pattern_create(const sn_fe_space *s, bool whole, sn_fe_pattern **pattern) {
    sn_status status = SN_OK;
    sn_fe_pattern *p = *pattern = sn_alloc(1, sizeof *p);
    if (!p) return SN_E_MEMORY;
    p->blocks = s->nodes + (s->element.mixed ? s->corners : 0);
    p->cell_blocks = s->element.nodes + (s->element.mixed ? 4 : 0);
    p->whole = whole;
    SN_TRY_GOTO(status, order_blocks(s, p));
    SN_TRY_GOTO(status, number_rows(s, p));
    SN_TRY_GOTO(status, find_neighbours(s, p));
    SN_TRY_GOTO(status, lay_rows(s, p));
    fill_columns(s, p);
    SN_TRY_GOTO(status, find_held(s, p));
    SN_TRY_GOTO(status, map_cells(s, p));
    return SN_OK;
fail:
    sn_fe_pattern_destroy(p);
    *pattern = NULL;
    return status;
}
