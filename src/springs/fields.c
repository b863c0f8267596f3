// Fields, rows of the history and energies of a moment of a run.
// SPDX-License-Identifier: Apache-2.0
//
// Stresses of central springs are virials: a spring of force f and length vector x adds f x x / l
// to the cells around it, in parts by their volumes. The pressure is -tr(Cauchy stress)/3, the mean
// of the cells around a node by volume. energy_density is W + U of the instantaneous law at the
// present strain, whatever the memory has relaxed. On the smoothed rung strain, stress and energy
// of a cell are the means of its six edges, which adds up: every edge has a sixth of each of its
// cells.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "springs/forces.h"
#include "springs/moment.h"
#include "springs/parts.h"

/// Energy of the instantaneous law, W + U: all of it, summed as it comes, and its parts.
typedef struct energies {
    double all, part[SN_PARTS];
} energies;

enum { EDGE_ENERGIES = 1 + SN_PARTS, EDGE_NUMBERS = 12 + EDGE_ENERGIES };

struct sn_fields {
    double *displacement, *velocity, *pressure; ///< nodes of the mesh
    double *strain, *stress, *energy;           ///< cells of the mesh
    double *held;                               ///< energy of the equilibrium part
    double *around;                             ///< volume around each node
    double *growth;                             ///< J - 1 of volume points
    double *edge;    ///< strain, stress, energies of smoothed edges: EDGE_NUMBERS each
    double *fibre;   ///< at rest, of cells; NULL: no law has any
    double *removed; ///< NULL: nothing can be removed; 1 of cells that were
};

static const sn_net_region *region_of(const sn_net *net, int slot) {
    const sn_net_region *r = net->region;
    while (slot >= (r->cell_block + r->cell_blocks) * SN_BLOCK) r++;
    return r;
}

static sn_status set_fibres(const sn_net *net, sn_fields *f) {
    bool fibres = false;
    for (int r = 0; r < net->region_count; r++) fibres |= net->region[r].tissue.law->fibres;
    if (!fibres) return SN_OK;
    f->fibre = sn_alloc((size_t)net->cells * 3, sizeof *f->fibre);
    if (!f->fibre) return SN_E_MEMORY;
    for (size_t e = 0; e < (size_t)net->cells; e++)
        if (region_of(net, net->cell_slot[e])->tissue.law->fibres)
            memcpy(f->fibre + 3 * e, net->cell_axes ? net->cell_axes + 9 * e : net->axes,
                   3 * sizeof *f->fibre);
    return SN_OK;
}

sn_status sn_fields_create(const sn_net *net, sn_fields **fields) {
    *fields = NULL;
    sn_fields *f = sn_alloc(1, sizeof *f);
    if (!f) return SN_E_MEMORY;
    const size_t nodes = (size_t)net->nodes, cells = (size_t)net->cells;
    f->displacement = sn_alloc(nodes * 3, sizeof(double));
    f->velocity = sn_alloc(nodes * 3, sizeof(double));
    f->pressure = sn_alloc(nodes, sizeof(double));
    f->around = sn_alloc(nodes, sizeof(double));
    f->strain = sn_alloc(cells * 6, sizeof(double));
    f->stress = sn_alloc(cells * 6, sizeof(double));
    f->energy = sn_alloc(cells, sizeof(double));
    f->held = sn_alloc(cells, sizeof(double));
    f->growth = sn_alloc((size_t)net->point_blocks * SN_BLOCK, sizeof(double));
    f->edge = sn_alloc((size_t)net->edge_blocks * SN_BLOCK * EDGE_NUMBERS, sizeof(double));
    if (net->cuttable) f->removed = sn_alloc(cells, sizeof(double));
    if ((net->cuttable && !f->removed) || !f->edge || !f->displacement || !f->velocity ||
        !f->pressure || !f->around || !f->strain || !f->stress || !f->energy || !f->held ||
        !f->growth) {
        sn_fields_destroy(f);
        return SN_E_MEMORY;
    }
    if (set_fibres(net, f) != SN_OK) {
        sn_fields_destroy(f);
        return SN_E_MEMORY;
    }
    *fields = f;
    return SN_OK;
}

void sn_fields_destroy(sn_fields *f) {
    if (!f) return;
    void *all[] = {f->displacement, f->velocity, f->pressure, f->around, f->strain, f->stress,
                   f->energy,       f->growth,   f->edge,     f->held,   f->fibre,  f->removed};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_free(f);
}

//---- one cell ------------------------------------------------------------------------------------

/// Deformation of the cell of a slot, in material axes.
typedef struct cell_shape {
    double F[9], J, V;
} cell_shape;

static void find_ratio(cell_shape *c) {
    const double *F = c->F;
    c->J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
           F[2] * (F[3] * F[7] - F[4] * F[6]);
}

static void find_shape(const sn_net *net, const sn_moment *m, int slot, cell_shape *c) {
    const size_t block = (size_t)slot / SN_BLOCK, lane = (size_t)slot % SN_BLOCK;
    const double *gradient = net->data[SN_DOUBLE].gradient;
    const int *corner = net->cell_node + block * 4 * SN_BLOCK + lane;
    c->V = ((const double *)sn_parts_volume(net, m->parts, SN_DOUBLE))[slot];
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++) {
            double sum = net->axes[3 * j + i];
            double u0 = sn_real_at(m->precision, m->u, 4 * (size_t)corner[0] + i);
            for (size_t a = 1; a < 4; a++)
                sum += (sn_real_at(m->precision, m->u, 4 * (size_t)corner[a * SN_BLOCK] + i) - u0) *
                       gradient[(block * 9 + 3 * (a - 1) + j) * SN_BLOCK + lane];
            c->F[3 * i + j] = sum;
        }
    find_ratio(c);
}

// of a smoothed edge
static void find_edge_shape(const sn_net *net, const sn_moment *m, int edge, cell_shape *c) {
    const double *Q = net->axes;
    double sum[9] = {0};
    c->V = 0;
    for (int s = net->edge_start[edge]; s < net->edge_start[edge + 1]; s++) {
        cell_shape one;
        find_shape(net, m, net->edge_cell[s], &one);
        c->V += one.V / 6.0;
        for (int k = 0; k < 9; k++) // H: a mean of F would lose the digits of small strains
            sum[k] += one.V / 6.0 * (one.F[k] - Q[3 * (k % 3) + k / 3]);
    }
    for (int k = 0; k < 9; k++) c->F[k] = Q[3 * (k % 3) + k / 3] + (c->V > 0 ? sum[k] / c->V : 0.0);
    find_ratio(c);
}

static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

static void green_strain(const double F[9], double E[6]) {
    for (int k = 0; k < 6; k++) {
        int i = pair[k][0], j = pair[k][1];
        E[k] = 0.5 * (F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j] - (i == j));
    }
}

double sn_net_law_strain(const sn_net *net, const sn_moment *m, int slot, double E[6]) {
    cell_shape c;
    if (net->rung == SN_RUNG_SMOOTHED)
        find_edge_shape(net, m, slot, &c);
    else
        find_shape(net, m, slot, &c);
    green_strain(c.F, E);
    return net->rung == SN_RUNG_SMOOTHED && net->edge_filling[slot] ? 0.0 : c.V;
}

// from material axes to space: Q^T E Q
static void turn_back(const sn_net *net, const double E[6], double *out) {
    const double *Q = net->axes;
    for (int k = 0; k < 6; k++) {
        out[k] = 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                out[k] += Q[3 * i + pair[k][0]] * E[sym[i][j]] * Q[3 * j + pair[k][1]];
    }
}

// F S F^T / J
static void add_cauchy(const cell_shape *c, const double S[6], double *stress) {
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                stress[k] +=
                    c->F[3 * pair[k][0] + i] * S[sym[i][j]] * c->F[3 * pair[k][1] + j] / c->J;
}

static void add_energy(energies *e, sn_part part, double x) {
    e->all += x;
    e->part[part] += x;
}

// number i of a block with memory, from the store; `T` where nothing is remembered
static double remembered(const sn_recalled *r, size_t block, size_t i, double T) {
    if (r->branches == 0) return T;
    double sum = r->memory->g_inf * sn_recalled_at(r, block, 0, i);
    for (size_t k = 1; k <= r->branches; k++) sum += sn_recalled_at(r, block, k, i);
    return sum;
}

//---- stress of the rungs -------------------------------------------------------------------------

// of a cell, or of a smoothed edge
static void solid_place(const sn_net *net, const sn_net_region *region, const sn_moment *m,
                        int slot, const cell_shape *c, double *stress, energies *energy) {
    static const int kind[2] = {SN_STORE_CELL, SN_STORE_FIBRE};
    const size_t block = (size_t)(slot / SN_BLOCK - sn_region_law_block(net, region));
    const size_t lane = (size_t)slot % SN_BLOCK;
    double E[6], S[6], W, p = region->bulk * (c->J - 1.0);
    green_strain(c->F, E);
    for (int n = sn_net_first_split(net); n < region->splits; n++) {
        const sn_recalled r = sn_recall(net, region, m, kind[n]);
        sn_net_law(net, &region->split[n], slot, 1, E, &W, S, NULL);
        add_energy(energy, sn_split_part(n), W);
        for (size_t k = 0; k < 6; k++) S[k] = remembered(&r, block, k * SN_BLOCK + lane, S[k]);
        add_cauchy(c, S, stress);
    }
    if (net->volume_mode != SN_VOLUME_CELL) return;
    const bool apart = region->tissue.branched;
    const sn_recalled r = sn_recall(net, region, m, apart ? SN_STORE_BULK : SN_STORE_CELL);
    add_energy(energy, SN_PART_VOLUMETRIC, 0.5 * p * (c->J - 1.0));
    p = remembered(&r, block, (apart ? 0u : 6u) * SN_BLOCK + lane, p);
    for (int k = 0; k < 3; k++) stress[k] += p;
}

static void find_edges(const sn_net *net, sn_fields *f, const sn_moment *m) {
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        for (int e = region->edge_block * SN_BLOCK;
             e < (region->edge_block + region->edge_blocks) * SN_BLOCK; e++) {
            double E[6], *to = f->edge + EDGE_NUMBERS * (size_t)e;
            cell_shape c;
            if (net->edge_filling[e]) continue;
            find_edge_shape(net, m, e, &c);
            green_strain(c.F, E);
            turn_back(net, E, to);
            energies energy = {0};
            memset(to + 6, 0, 6 * sizeof *to);
            solid_place(net, region, m, e, &c, to + 6, &energy);
            to[12] = energy.all;
            memcpy(to + 13, energy.part, sizeof energy.part);
        }
    }
}

// mean of the six edges; replaces the strain of the cell
static void smoothed_cell(const sn_net *net, const sn_fields *f, int slot, double *strain,
                          double *stress, energies *energy) {
    memset(strain, 0, 6 * sizeof *strain);
    for (int k = 0; k < 6; k++) {
        const int e = net->cell_edge[(slot / SN_BLOCK * 6 + k) * SN_BLOCK + slot % SN_BLOCK];
        const double *from = f->edge + EDGE_NUMBERS * (size_t)e;
        for (int i = 0; i < 6; i++) {
            strain[i] += from[i] / 6.0;
            stress[i] += from[6 + i] / 6.0;
        }
        energy->all += from[12] / 6.0;
        for (int p = 0; p < SN_PARTS; p++) energy->part[p] += from[13 + p] / 6.0;
    }
}

static void central_cell(const sn_net *net, const sn_net_region *region, const sn_moment *m,
                         int slot, const cell_shape *c, double *stress, energies *energy) {
    const sn_net_data *data = &net->data[SN_DOUBLE];
    const double *stiffness = sn_parts_stiffness(net, m->parts, SN_DOUBLE);
    const double *volume = sn_parts_spring_volume(net, m->parts);
    const sn_recalled r = sn_recall(net, region, m, SN_STORE_SPRING);
    for (int q = net->spring_share_start[slot]; q < net->spring_share_start[slot + 1]; q++) {
        const int s = net->spring_share[q];
        const size_t block = (size_t)s / SN_BLOCK, lane = (size_t)s % SN_BLOCK;
        const double inverse = ((const double *)data->inverse)[s];
        const sn_spring_law law = sn_net_spring_law(net, region, s);
        const double part = stiffness[s] / volume[s];
        double x[3], l2 = 0, t, phi;
        for (size_t d = 0; d < 3; d++) {
            const int *end = net->spring_end + block * 2 * SN_BLOCK + lane;
            x[d] = ((const double *)data->edge)[(block * 3 + d) * SN_BLOCK + lane] +
                   sn_real_at(m->precision, m->u, 4 * (size_t)end[SN_BLOCK] + d) -
                   sn_real_at(m->precision, m->u, 4 * (size_t)end[0] + d);
            l2 += x[d] * x[d];
        }
        double lambda = sqrt(l2 * inverse);
        t = sn_spring_tension(&law, lambda, NULL);
        phi = sn_spring_potential(&law, lambda);
        t = remembered(&r, block - (size_t)region->spring_block, lane, t);
        for (int k = 0; k < 6; k++)
            stress[k] += part * t / lambda * x[pair[k][0]] * x[pair[k][1]] / c->J;
        add_energy(energy, SN_PART_DEVIATORIC, part * phi / inverse);
    }
}

// mean over the corners of nodal pressure and of the energy of the volume points
static void nodal_volume(const sn_net *net, const sn_net_region *region, const sn_fields *f,
                         const sn_moment *m, int slot, double *stress, energies *energy) {
    const int *point = net->cell_point + (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
    for (int a = 0; a < 4; a++) {
        const int p = point[a * SN_BLOCK];
        double pressure = sn_real_at(m->precision, m->pressure, (size_t)p);
        for (int k = 0; k < 3; k++) stress[k] += 0.25 * pressure;
        add_energy(energy, SN_PART_VOLUMETRIC, 0.125 * region->bulk * f->growth[p] * f->growth[p]);
    }
}

//---- whole ---------------------------------------------------------------------------------------

static void find_growth(const sn_net *net, sn_fields *f, const sn_moment *m) {
    const size_t points = (size_t)net->point_blocks * SN_BLOCK;
    const double *volume = sn_parts_volume(net, m->parts, SN_DOUBLE);
    const double *around = sn_parts_point_volume(net, m->parts);
    memset(f->growth, 0, points * sizeof *f->growth);
    for (int s = 0; net->volume && s < net->cell_blocks * SN_BLOCK; s++) {
        cell_shape c;
        if (!(volume[s] > 0)) continue;
        find_shape(net, m, s, &c);
        const int *point = net->cell_point + (s / SN_BLOCK) * 4 * SN_BLOCK + s % SN_BLOCK;
        for (int a = 0; a < 4; a++) f->growth[point[a * SN_BLOCK]] += 0.25 * c.V * (c.J - 1.0);
    }
    for (size_t p = 0; p < points; p++)
        if (around[p] > 0) f->growth[p] /= around[p];
}

static void fill_nodes(const sn_net *net, sn_fields *f, const sn_moment *m) {
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            size_t at = 4 * (size_t)i + (size_t)d;
            int to = 3 * net->node_name[i] + d;
            f->displacement[to] = sn_real_at(m->precision, m->u, at);
            f->velocity[to] = m->v ? sn_real_at(m->precision, m->v, at) : 0.0;
        }
}

static double equilibrium_part(const sn_net_region *region, const energies *e) {
    double sum = 0;
    if (!region->tissue.branched) return region->memory.g_inf * e->all;
    for (int p = 0; p < SN_PARTS; p++)
        sum += sn_region_memory(region, (sn_part)p)->g_inf * e->part[p];
    return sum;
}

void sn_fields_fill(const sn_net *net, sn_fields *f, const sn_moment *m) {
    fill_nodes(net, f, m);
    find_growth(net, f, m);
    if (net->rung == SN_RUNG_SMOOTHED) find_edges(net, f, m);
    memset(f->pressure, 0, (size_t)net->nodes * sizeof *f->pressure);
    memset(f->around, 0, (size_t)net->nodes * sizeof *f->around);
    for (int e = 0; e < net->cells; e++) {
        const int slot = net->cell_slot[e];
        const sn_net_region *region = region_of(net, slot);
        double E[6], *stress = f->stress + 6 * e;
        cell_shape c;
        memset(stress, 0, 6 * sizeof *stress);
        f->energy[e] = f->held[e] = 0;
        if (f->removed) f->removed[e] = m->parts && m->parts->gone[slot];
        if (m->parts && m->parts->gone[slot]) {
            memset(f->strain + 6 * e, 0, 6 * sizeof *f->strain);
            continue;
        }
        find_shape(net, m, slot, &c);
        green_strain(c.F, E);
        turn_back(net, E, f->strain + 6 * e);
        energies energy = {0};
        if (net->rung == SN_RUNG_CENTRAL) central_cell(net, region, m, slot, &c, stress, &energy);
        if (net->rung == SN_RUNG_SMOOTHED)
            smoothed_cell(net, f, slot, f->strain + 6 * e, stress, &energy);
        else if (sn_region_law_blocks(net, region) > 0)
            solid_place(net, region, m, slot, &c, stress, &energy);
        if (net->volume) nodal_volume(net, region, f, m, slot, stress, &energy);
        f->energy[e] = energy.all;
        f->held[e] = equilibrium_part(region, &energy);
        const int *corner = net->cell_node + (slot / SN_BLOCK) * 4 * SN_BLOCK + slot % SN_BLOCK;
        for (int a = 0; a < 4; a++) {
            const int node = net->node_name[corner[a * SN_BLOCK]];
            f->pressure[node] -= c.V * (stress[0] + stress[1] + stress[2]) / 3.0;
            f->around[node] += c.V;
        }
    }
    for (int i = 0; i < net->nodes; i++)
        if (f->around[i] > 0) f->pressure[i] /= f->around[i]; // else a node without cells
}

sn_status sn_fields_emit(const sn_fields *f, double time, const sn_output *output) {
    sn_field all[8] = {{"displacement", "m", SN_ON_NODES, 3, f->displacement},
                       {"velocity", "m/s", SN_ON_NODES, 3, f->velocity},
                       {"pressure", "Pa", SN_ON_NODES, 1, f->pressure},
                       {"green_strain", "1", SN_ON_CELLS, 6, f->strain},
                       {"cauchy_stress", "Pa", SN_ON_CELLS, 6, f->stress},
                       {"energy_density", "J/m3", SN_ON_CELLS, 1, f->energy}};
    int count = 6;
    if (f->fibre) all[count++] = (sn_field){"fibre", "1", SN_ON_CELLS, 3, f->fibre};
    if (f->removed) all[count++] = (sn_field){"removed", "1", SN_ON_CELLS, 1, f->removed};
    const sn_frame frame = {time, count, all};
    return output->frame(output->context, &frame);
}

double sn_fields_elastic(const sn_net *net, const sn_fields *f) {
    const double *volume = net->data[SN_DOUBLE].volume;
    double sum = 0;
    for (int e = 0; e < net->cells; e++) sum += f->energy[e] * volume[net->cell_slot[e]];
    return sum;
}

sn_stored sn_fields_stored(const sn_net *net, const sn_fields *f, const sn_moment *m) {
    const double *volume = net->data[SN_DOUBLE].volume;
    sn_stored sum = {.instant = sn_fields_elastic(net, f), .memory = sn_net_memory_energy(net, m)};
    for (int e = 0; e < net->cells; e++) sum.elastic += f->held[e] * volume[net->cell_slot[e]];
    sum.elastic += sn_net_upright_energy(net, m);
    return sum;
}

sn_status sn_net_history_row(const sn_net *net, const sn_moment *m, double *row,
                             sn_record *history) {
    double *to = row;
    *to++ = m->time;
    for (int p = 0; p < net->probe_count; p++, to += 3) {
        const sn_net_probe *probe = &net->probe[p];
        to[0] = to[1] = to[2] = 0.0;
        if (probe->kind == SN_PROBE_POINT) {
            for (int a = 0; a < 4; a++)
                for (int d = 0; d < 3; d++)
                    to[d] += probe->weight[a] *
                             sn_real_at(m->precision, m->u, 4 * (size_t)probe->node[a] + (size_t)d);
            continue;
        }
        // what the support gives: mass times acceleration less all other forces
        for (int k = 0; k < probe->count; k++) {
            const sn_net_fixed *fixed = &net->fixed[probe->fixed[k]];
            size_t at = 4 * (size_t)fixed->node + (size_t)fixed->direction;
            double a = m->a_fixed ? m->a_fixed[probe->fixed[k]] : 0.0;
            to[fixed->direction] += net->mass[fixed->node] * a - sn_real_at(m->precision, m->f, at);
        }
    }
    for (int t = 0; t < net->tool_count; t++)
        for (int d = 0; d < 3; d++) *to++ = m->tool_force[t][d];
    return sn_record_append(history, row);
}
