// What is left of a net without its removed cells.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "springs/cut.h"

// number i of arrays in both precisions
static void put(void *const to[2], size_t i, double x) {
    ((double *)to[SN_DOUBLE])[i] = x;
    if (to[SN_SINGLE]) ((float *)to[SN_SINGLE])[i] = (float)x;
}

static void copy_doubles(const void *from, size_t count, void *to) {
    if (count > 0) memcpy(to, from, count * sizeof(double));
}

//---- cells and fans ------------------------------------------------------------------------------

static void leave_cells(const sn_net *net, sn_cut *cut) {
    const double *volume = net->data[SN_DOUBLE].volume;
    const sn_tiles *t = &net->cell_tiles;
    for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) {
        put(cut->volume, (size_t)s, volume[s]);
        cut->gone[s] = false;
    }
    cut->count = 0;
    for (int e = 0; e < net->cells; e++) {
        if (!cut->removed[e]) continue;
        cut->count++;
        cut->gone[net->cell_slot[e]] = true;
        put(cut->volume, (size_t)net->cell_slot[e], 0.0);
    }
    for (int k = 0; k < t->count; k++) {
        const sn_tile_place *place = &t->place[k];
        for (size_t n = 0; n < (size_t)place->blocks * 4 * SN_BLOCK; n++) {
            const size_t slot =
                ((size_t)place->block + n / (4 * SN_BLOCK)) * SN_BLOCK + n % SN_BLOCK;
            const size_t at = place->corner + n;
            cut->cell_corner[at] = cut->gone[slot] ? 0 : t->corner[at];
        }
    }
}

static void leave_fans(const sn_net *net, sn_cut *cut) {
    const int *slot = net->cutting->fan_slot;
    for (size_t k = 0; k < net->fan_tiles.corner_count; k++)
        put(cut->present, k, slot[k] >= 0 && cut->gone[slot[k]] ? 0.0 : 1.0);
}

//---- volume points -------------------------------------------------------------------------------

static const int *points_of(const sn_net *net, int slot) {
    return net->cell_point + slot / SN_BLOCK * 4 * SN_BLOCK + slot % SN_BLOCK;
}

static void leave_points(const sn_net *net, sn_cut *cut) {
    const size_t points = (size_t)net->point_blocks * SN_BLOCK;
    const double *stiffness = net->data[SN_DOUBLE].point_stiffness;
    const double *volume = net->data[SN_DOUBLE].volume;
    memset(cut->touched, 0, points * sizeof *cut->touched);
    memset(cut->sum, 0, points * sizeof *cut->sum);
    for (int e = 0; e < net->cells && net->volume; e++) {
        const int slot = net->cell_slot[e], *point = points_of(net, slot);
        for (int a = 0; a < 4; a++) {
            cut->touched[point[a * SN_BLOCK]] |= cut->removed[e];
            if (!cut->removed[e]) cut->sum[point[a * SN_BLOCK]] += 0.25 * volume[slot];
        }
    }
    for (size_t p = 0; p < points; p++) {
        const double left = cut->touched[p] ? cut->sum[p] : net->point_volume[p];
        const bool same = !cut->touched[p] || !(left > 0);
        cut->point_volume[p] = left;
        put(cut->point_stiffness, p,
            !(left > 0) ? 0.0
            : same      ? stiffness[p]
                        : stiffness[p] * (net->point_volume[p] / left));
    }
}

//---- springs -------------------------------------------------------------------------------------

// stiffness and volume of springs by the cells around them that are left
static void leave_springs(const sn_net *net, sn_cut *cut) {
    const sn_cutting *k = net->cutting;
    const size_t springs = (size_t)net->spring_blocks * SN_BLOCK;
    const double *stiffness = net->data[SN_DOUBLE].stiffness;
    const double *volume = net->data[SN_DOUBLE].volume;
    memset(cut->touched, 0, springs * sizeof *cut->touched);
    memset(cut->sum, 0, springs * sizeof *cut->sum);
    copy_doubles(net->spring_volume, springs, cut->spring_volume);
    for (int e = 0; e < net->cells && springs > 0; e++) {
        const int slot = net->cell_slot[e];
        for (int q = net->spring_share_start[slot]; q < net->spring_share_start[slot + 1]; q++) {
            const int s = net->spring_share[q];
            cut->touched[s] |= cut->removed[e];
            if (!cut->removed[e]) cut->sum[s] += k->share[q];
            if (cut->removed[e]) cut->spring_volume[s] -= volume[slot];
        }
    }
    for (size_t s = 0; s < springs; s++) {
        if (cut->touched[s] && !(cut->sum[s] > 0)) cut->spring_volume[s] = 0.0;
        put(cut->stiffness, s,
            cut->touched[s] ? stiffness[s] * (cut->sum[s] / k->spring_whole[s]) : stiffness[s]);
    }
}

enum { STARS = SN_BLOCK / SN_STAR, STAR_CORNERS = 1 + SN_STAR };

/// The ends of a spring that is left, to put others at.
typedef struct spring_ends {
    uint16_t middle, end;
    bool found;
} spring_ends;

// one that is left in star i of a block
static spring_ends left_in_star(const double *stiffness, const uint16_t *corner, int i) {
    for (int n = 0; n < SN_STAR; n++)
        if (stiffness[n * STARS + i] > 0)
            return (spring_ends){corner[i], corner[(1 + n) * STARS + i], true};
    return (spring_ends){0};
}

// springs that are gone, one star: where another of the star stands, or of the tile
static void leave_star(const double *stiffness, int i, const spring_ends *other, uint16_t *corner) {
    const spring_ends own = left_in_star(stiffness, corner, i);
    for (int n = 0; n < SN_STAR; n++)
        if (!(stiffness[n * STARS + i] > 0))
            corner[(1 + n) * STARS + i] = own.found ? own.end : other->end;
    if (!own.found) corner[i] = other->middle;
}

static void leave_stars(const sn_net *net, sn_cut *cut) {
    const sn_tiles *t = &net->spring_tiles;
    const size_t numbers = (size_t)STAR_CORNERS * STARS;
    if (t->corner_count > 0)
        memcpy(cut->spring_corner, t->corner, t->corner_count * sizeof *t->corner);
    for (int k = 0; k < t->count; k++) {
        const sn_tile_place *place = &t->place[k];
        const double *stiffness =
            (const double *)cut->stiffness[SN_DOUBLE] + (size_t)place->block * SN_BLOCK;
        uint16_t *corner = cut->spring_corner + place->corner;
        spring_ends any = {0};
        for (int n = 0; n < place->blocks * STARS && !any.found; n++)
            any = left_in_star(stiffness + n / STARS * SN_BLOCK,
                               corner + (size_t)(n / STARS) * numbers, n % STARS);
        cut->spring_empty[k] = !any.found;
        for (int n = 0; n < place->blocks * STARS && any.found; n++)
            leave_star(stiffness + n / STARS * SN_BLOCK, n % STARS, &any,
                       corner + (size_t)(n / STARS) * numbers);
    }
}

//---- nodes ---------------------------------------------------------------------------------------

static const int *corners_of(const sn_net *net, int e) {
    const int slot = net->cell_slot[e];
    return net->cell_node + slot / SN_BLOCK * 4 * SN_BLOCK + slot % SN_BLOCK;
}

static int root_of(int *parent, int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// loose nodes, and the numbers of the pieces in the order of their first nodes
static void leave_nodes(const sn_net *net, sn_cut *cut) {
    int *piece = cut->piece; // the parent in a tree of its piece, which is no later node
    for (int i = 0; i < net->nodes; i++) {
        piece[i] = i;
        cut->loose[i] = true;
    }
    for (int e = 0; e < net->cells; e++) {
        const int *corner = corners_of(net, e);
        for (int a = 0; a < 4 && !cut->removed[e]; a++) {
            const int p = root_of(piece, corner[0]), q = root_of(piece, corner[a * SN_BLOCK]);
            piece[p > q ? p : q] = p > q ? q : p;
            cut->loose[corner[a * SN_BLOCK]] = false;
        }
    }
    for (int i = 0; i < net->nodes; i++) piece[i] = root_of(piece, i);
    cut->pieces = 0;
    for (int i = 0; i < net->nodes; i++) { // numbers n as -2 - n: they are no nodes
        if (cut->loose[i])
            piece[i] = -1;
        else
            piece[i] = piece[i] == i ? -2 - cut->pieces++ : piece[piece[i]];
    }
    memset(cut->touched, 0, (size_t)cut->pieces * sizeof *cut->touched);
    for (int i = 0; i < net->nodes; i++) {
        if (piece[i] < -1) piece[i] = -2 - piece[i];
        if (piece[i] >= 0 && net->fixed_bits[i]) cut->touched[piece[i]] = true;
    }
    cut->free_piece = false;
    for (int k = 0; k < cut->pieces; k++) cut->free_piece = cut->free_piece || !cut->touched[k];
}

static void leave_rim(const sn_net *net, sn_cut *cut) {
    bool *lost = cut->touched; // nodes
    memset(lost, 0, (size_t)net->nodes * sizeof *lost);
    for (int e = 0; e < net->cells; e++)
        for (int a = 0; a < 4 && cut->removed[e]; a++)
            lost[corners_of(net, e)[a * SN_BLOCK]] = true;
    cut->rim_count = 0;
    for (int e = 0; e < net->cells; e++) {
        const int *corner = corners_of(net, e);
        const bool near = lost[corner[0]] || lost[corner[SN_BLOCK]] || lost[corner[2 * SN_BLOCK]] ||
                          lost[corner[3 * SN_BLOCK]];
        if (near && !cut->removed[e]) cut->rim[cut->rim_count++] = net->cell_slot[e];
    }
}

// the surface for tools: faces of cells that are left towards none
static void leave_surface(const sn_net *net, sn_cut *cut) {
    static const int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    const sn_cutting *k = net->cutting;
    double *area = cut->sum;
    memset(area, 0, (size_t)net->nodes * sizeof *area);
    for (int f = 0; f < 4 * net->cells; f++) {
        const int other = k->neighbour[f], *corner = corners_of(net, f / 4);
        if (cut->removed[f / 4] || (other >= 0 && !cut->removed[other])) continue;
        for (int a = 0; a < 3; a++) area[corner[face[f % 4][a] * SN_BLOCK]] += k->third[f];
    }
    for (int n = 0; n < net->contact_count; n++)
        cut->contact_stiffness[n] = k->penalty * area[net->contact_node[n]];
}

static void leave_loads(const sn_net *net, sn_cut *cut) {
    for (int l = 0; l < net->load_count; l++) {
        const sn_net_load *load = &net->load[l];
        const sn_cutting_load *from = &net->cutting->load[l];
        double *force = cut->load_force[l];
        for (int f = 0; f < from->faces && cut->load_gone[l]; f++)
            cut->load_gone[l][f] = cut->removed[from->cell[f]];
        if (force) memset(force, 0, (size_t)load->count * 3 * sizeof *force);
        if (load->kind == SN_LOAD_FORCE && !cut->removed[from->cell[0]])
            copy_doubles(load->force, (size_t)load->count * 3, force);
        for (int f = 0; f < from->faces && load->kind == SN_LOAD_TRACTION; f++)
            for (int a = 0; a < 3 && !cut->removed[from->cell[f]]; a++)
                for (int d = 0; d < 3; d++)
                    force[3 * from->place[3 * f + a] + d] += from->third[f] * from->vector[d];
    }
}

void sn_cut_restore(const sn_net *net, sn_cut *cut) {
    leave_cells(net, cut);
    leave_fans(net, cut);
    leave_points(net, cut);
    leave_springs(net, cut);
    leave_stars(net, cut);
    leave_nodes(net, cut);
    leave_rim(net, cut);
    leave_surface(net, cut);
    leave_loads(net, cut);
}
