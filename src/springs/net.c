// Builds nets.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/isa.h"
#include "springs/parts.h"
#include "springs/steps.h"

static sn_status check_settings(const sn_case *c) {
    const sn_springs_def *def = &c->springs;
    if (!(def->step >= 0) || !isfinite(def->step))
        return sn_fail(SN_E_RANGE, "springs: step is %g s, expected a positive time or auto",
                       def->step);
    if (!(def->damping >= 0) || !isfinite(def->damping))
        return sn_fail(SN_E_RANGE, "springs: damping is %g 1/s, expected 0 or more", def->damping);
    if (c->mesh->cell_count > SN_CELLS_MAX / 4)
        return sn_fail(SN_E_RANGE, "springs: the mesh has %d cells, at most %d fit the lists",
                       c->mesh->cell_count, SN_CELLS_MAX / 4);
    return SN_OK;
}

// what readers refuse too; a mesh that a program made may not have come through them
static sn_status check_mesh(const sn_mesh *mesh) {
    unsigned char *used = sn_alloc((size_t)mesh->node_count, 1);
    if (!used) return SN_E_MEMORY;
    sn_status status = SN_OK;
    for (int e = 0; e < mesh->cell_count && status == SN_OK; e++) {
        for (int a = 0; a < 4; a++) used[mesh->cell[4 * e + a]] = 1;
        double volume = sn_mesh_cell_volume(mesh, e);
        if (!(volume > 0))
            status = sn_fail(SN_E_MESH,
                             "springs: cell %d has the volume %g m3: it is flat or turned inside "
                             "out; sn_mesh_finish() turns such cells round",
                             e, volume);
    }
    for (int i = 0; i < mesh->node_count && status == SN_OK; i++)
        if (!used[i])
            status = sn_fail(SN_E_MESH, "springs: node %d belongs to no cell: leave it away", i);
    sn_free(used);
    return status;
}

static sn_status check_motion(const sn_case *c) {
    for (int t = 0; t < c->tool_count; t++)
        if (c->tool[t].grasp[1] > c->tool[t].grasp[0] &&
            c->springs.integrator != SN_INTEGRATOR_EXPLICIT)
            return sn_fail(SN_E_UNSUPPORTED, "tool \"%s\": grasp needs integrator explicit",
                           c->tool[t].name);
    if (c->springs.integrator != SN_INTEGRATOR_QUASI_STATIC) return SN_OK;
    char text[SN_TEXT_MAX];
    sn_case_free_motions(c, text);
    int carrier = sn_case_carried_by(c);
    if (text[0] == '\0' && carrier < 0) return SN_OK;
    if (text[0] == '\0')
        return sn_fail(SN_E_DEFINITION,
                       "springs: no supports: the body would only be carried along by the rigid "
                       "motion of \"%s\"; hold another surface under \"supports\"",
                       c->mesh->surface[carrier].name);
    return sn_fail(SN_E_DEFINITION,
                   "springs: supports and prescribed motions leave %s free, so there is no "
                   "equilibrium to find; add supports or use integrator explicit",
                   text);
}

//---- tissues -------------------------------------------------------------------------------------

static sn_status check_central(const sn_case *c, sn_net *net, sn_net_region *region) {
    const sn_tissue *t = &region->tissue;
    if (t->law->fibres && !t->law->fibre_constant && !c->springs_given)
        return sn_fail(SN_E_UNSUPPORTED,
                       "tissue %s: law %s has fibres and matrix in one energy, which central "
                       "springs cannot take apart; use what `sinew calibrate` finds, model "
                       "coupled or smoothed, or a law like hgo",
                       t->name, t->law->name);
    region->splits = sn_tissue_split_fibres(t, region->split);
    if (c->springs_given) {
        const int r = (int)(region - net->region);
        region->exponent = c->springs_given->exponent[r];
        for (int k = 0; k < SN_SPRING_SQUARES; k++) {
            region->square[k] = c->springs_given->square[SN_SPRING_SQUARES * r + k];
            region->squared = region->squared || region->square[k] != 0;
        }
        region->bulk = c->springs.volume ? sn_net_given_bulk(c, r, region->bulk) : 0.0;
        return SN_OK;
    }
    SN_TRY(sn_spring_fit(&region->split[0], &region->exponent, &region->stiffening));
    // springs bring lambda = mu, a bulk modulus of 5/3 mu
    double own = 5.0 / 3.0 * region->shear * region->stiffening;
    double missing = region->bulk - own;
    if (c->springs.volume && missing < -1e-9 * own)
        return sn_fail(
            SN_E_UNSUPPORTED,
            "tissue %s: central springs bring a bulk modulus of %g Pa (a Poisson's ratio "
            "of 1/4), the tissue has %g Pa; use model coupled, or volume: false",
            t->name, own, region->bulk);
    if (!c->springs.volume && fabs(missing) > 0.01 * own)
        snprintf(net->note + strlen(net->note), sizeof net->note - strlen(net->note),
                 "Central springs without volume act with Poisson's ratio 1/4 (tissue %.40s). ",
                 t->name);
    region->bulk = c->springs.volume ? fmax(missing, 0.0) : 0.0;
    return SN_OK;
}

static sn_status set_tissue(const sn_case *c, sn_net *net, sn_net_region *region) {
    const sn_tissue *t = &region->tissue;
    sn_moduli moduli;
    if (t->law->kind == SN_LAW_UNIAXIAL && net->rung != SN_RUNG_CENTRAL)
        return sn_fail(SN_E_UNSUPPORTED,
                       "tissue %s: law %s is uniaxial; cells need a solid law, or use model "
                       "central with poissons_ratio",
                       t->name, t->law->name);
    sn_tissue_moduli(t, &moduli);
    region->shear = moduli.shear;
    region->bulk = moduli.bulk;
    region->stiffening = 1.0;
    if (net->rung != SN_RUNG_CENTRAL || net->volume) {
        if (isinf(region->bulk))
            return sn_fail(SN_E_UNSUPPORTED,
                           "tissue %s: incompressible; springs need a finite bulk_modulus, for "
                           "example %g Pa (1000 times the shear modulus)",
                           t->name, 1000.0 * moduli.shear);
    }
    sn_tissue apart[2];
    region->fibred = sn_tissue_split_fibres(t, apart) > 1;
    region->bare = apart[0];
    region->splits = sn_tissue_split(t, region->split);
    if (net->rung == SN_RUNG_CENTRAL) SN_TRY(check_central(c, net, region));
    for (int k = 0; k < SN_VALUES_MAX; k++) {
        region->value_f[k] = (float)t->value[k];
        region->bare_f[k] = (float)region->bare.value[k];
        for (int n = 0; n < region->splits; n++)
            region->split_value_f[n][k] = (float)region->split[n].value[k];
    }
    if (net->integrator != SN_INTEGRATOR_QUASI_STATIC && !isfinite(t->density))
        return sn_fail(SN_E_DEFINITION,
                       "tissue %s: no density: moving springs have inertia; give it in the tissue, "
                       "such as density: 1060 kg/m3, or use integrator quasi-static",
                       t->name);
    region->density = isfinite(t->density) ? t->density : 0.0;
    return SN_OK;
}

static sn_status set_memory(const sn_case *c, sn_net_region *region, double t_min) {
    t_min = fmin(fmax(t_min, c->until * 1e-6), c->until * 0.1);
    sn_exponentials *const memory[SN_PARTS] = {&region->memory, &region->volumetric,
                                               &region->fibre};
    for (int p = 0; p < (region->tissue.branched ? SN_PARTS : 1); p++) {
        SN_TRY(sn_memory_compress(sn_tissue_memory(&region->tissue, (sn_part)p), t_min, c->until,
                                  c->springs.memory_tolerance, memory[p]));
        // damping by stiffness is a viscous part of the law: it sees no rigid motion
        if (c->springs.integrator != SN_INTEGRATOR_QUASI_STATIC)
            memory[p]->viscous += c->springs.stiffness_damping;
    }
    region->branches = region->memory.terms + (region->memory.viscous > 0);
    return SN_OK;
}

//---- arrays --------------------------------------------------------------------------------------

static sn_status set_masses(const sn_case *c, sn_net *net) {
    sn_net_data *data = &net->data[SN_DOUBLE];
    const size_t nodes = (size_t)net->nodes;
    const double *volume = data->volume;
    net->mass = sn_alloc(nodes, sizeof *net->mass);
    double *weight = data->weight = sn_alloc(nodes * 4, sizeof *weight);
    data->inverse_mass = sn_alloc(nodes * 4, sizeof(double));
    if (!net->mass || !weight || !data->inverse_mass) return SN_E_MEMORY;
    for (int e = 0; e < net->cells; e++)
        for (int a = 0; a < 4; a++)
            net->mass[c->mesh->cell[4 * e + a]] +=
                0.25 * net->region[c->mesh->region[e]].density * volume[net->cell_slot[e]];
    for (size_t i = 0; i < nodes; i++)
        for (size_t d = 0; d < 3; d++) weight[4 * i + d] = net->mass[i] * net->gravity[d];
    return SN_OK;
}

static double mean_edge(const sn_net *net) {
    double volume = 0.0;
    const double *v = net->data[SN_DOUBLE].volume;
    for (int s = 0; s < net->cell_blocks * SN_BLOCK; s++) volume += v[s];
    return cbrt(6.0 * volume / net->cells); // of a cell of a cube
}

static sn_status set_inverse_masses(sn_net *net) {
    double *inverse = net->data[SN_DOUBLE].inverse_mass;
    net->root_inverse_mass = sn_alloc((size_t)net->nodes * 3, sizeof *net->root_inverse_mass);
    if (!net->root_inverse_mass) return SN_E_MEMORY;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            bool free = !(net->fixed_bits[i] >> d & 1) && net->mass[i] > 0;
            inverse[4 * i + d] = free ? 1.0 / net->mass[i] : 0.0;
            net->root_inverse_mass[3 * i + d] = sqrt(inverse[4 * i + d]);
        }
    return SN_OK;
}

// float copy of an array of count doubles
static sn_status to_single(const void *from, size_t count, void **to) {
    if (!from) return SN_OK;
    float *out = *to = sn_alloc(count, sizeof *out);
    if (!out) return SN_E_MEMORY;
    for (size_t i = 0; i < count; i++) out[i] = (float)((const double *)from)[i];
    return SN_OK;
}

static sn_status single_positions(sn_tiles *t) {
    return to_single(t->position[SN_DOUBLE], (size_t)sn_tiles_entries(t) * 4,
                     &t->position[SN_SINGLE]);
}

static sn_status copy_single(sn_net *net) {
    if (net->precision == SN_DOUBLE) return SN_OK;
    const sn_net_data *d = &net->data[SN_DOUBLE];
    sn_net_data *s = &net->data[SN_SINGLE];
    const size_t cells = (size_t)net->cell_blocks * SN_BLOCK;
    const size_t springs = (size_t)net->spring_blocks * SN_BLOCK, nodes = (size_t)net->nodes * 4;
    const size_t places =
        (size_t)(net->rung == SN_RUNG_SMOOTHED ? net->edge_blocks : net->cell_blocks);
    if (net->cell_tiles.count > 0) {
        SN_TRY(to_single(d->gradient, cells * 9, &s->gradient));
        SN_TRY(to_single(d->volume, cells, &s->volume));
        SN_TRY(to_single(d->turn, 9 * (size_t)SN_BLOCK * places, &s->turn));
    }
    SN_TRY(to_single(d->stiffness, springs, &s->stiffness));
    SN_TRY(single_positions(&net->cell_tiles));
    SN_TRY(single_positions(&net->spring_tiles));
    SN_TRY(single_positions(&net->fan_tiles));
    SN_TRY(
        to_single(d->point_stiffness, (size_t)net->point_blocks * SN_BLOCK, &s->point_stiffness));
    SN_TRY(to_single(d->weight, nodes, &s->weight));
    return to_single(d->inverse_mass, nodes, &s->inverse_mass);
}

// appends the springs of a region that start at corner a of a cell and end at another corner
static int add_shares(sn_net *net, const sn_net_region *g, const int *from, const int *list,
                      const int *corner, int a, int count) {
    const int first = g->spring_block * SN_BLOCK, last = first + g->spring_blocks * SN_BLOCK;
    const int node = corner[a * SN_BLOCK];
    for (int k = from[node]; k < from[node + 1]; k++) {
        const int spring = list[k];
        if (spring < first || spring >= last) continue;
        int end = net->spring_end[(spring / SN_BLOCK * 2 + 1) * SN_BLOCK + spring % SN_BLOCK];
        for (int b = 0; b < 4; b++)
            if (corner[b * SN_BLOCK] == end) net->spring_share[count++] = spring;
    }
    return count;
}

// springs by the node they start at: from (nodes + 2), list (springs)
static void list_starts(const sn_net *net, int *from, int *list) {
    const double *stiffness = net->data[SN_DOUBLE].stiffness;
    for (int pass = 0; pass < 2; pass++) {
        for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
            if (!(stiffness[s] > 0)) continue;
            const int node = net->spring_end[s / SN_BLOCK * 2 * SN_BLOCK + s % SN_BLOCK];
            if (pass == 0)
                from[node + 2]++;
            else
                list[from[node + 1]++] = s;
        }
        for (int i = 0; i < net->nodes && pass == 0; i++) from[i + 2] += from[i + 1];
    }
}

// springs around each cell, for stresses on the central rung
static sn_status list_shares(sn_net *net) {
    if (net->rung != SN_RUNG_CENTRAL) return SN_OK;
    const size_t slots = (size_t)net->cell_blocks * SN_BLOCK;
    const double *volume = net->data[SN_DOUBLE].volume;
    int *from = sn_alloc((size_t)net->nodes + 2, sizeof *from), count = 0;
    int *list = sn_alloc((size_t)net->springs, sizeof *list);
    net->spring_share_start = sn_alloc(slots + 1, sizeof(int));
    net->spring_share = sn_alloc((size_t)net->cells * 6, sizeof(int));
    const bool all = from && list && net->spring_share_start && net->spring_share;
    if (all) list_starts(net, from, list);
    for (int r = 0; r < net->region_count && all; r++) {
        const sn_net_region *g = &net->region[r];
        for (int s = g->cell_block * SN_BLOCK; s < (g->cell_block + g->cell_blocks) * SN_BLOCK;
             s++) {
            net->spring_share_start[s] = count;
            if (!(volume[s] > 0)) continue; // filling
            const int *corner = net->cell_node + (s / SN_BLOCK) * 4 * SN_BLOCK + s % SN_BLOCK;
            for (int a = 0; a < 4; a++) count = add_shares(net, g, from, list, corner, a, count);
        }
    }
    if (all) net->spring_share_start[slots] = count;
    sn_free(from);
    sn_free(list);
    return all ? SN_OK : SN_E_MEMORY;
}

//---- whole ---------------------------------------------------------------------------------------

static sn_status copy_case(const sn_case *c, sn_net *net) {
    const sn_springs_def *def = &c->springs;
    net->nodes = c->mesh->node_count;
    net->cells = c->mesh->cell_count;
    net->rung = def->rung;
    net->volume = def->volume;
    net->volume_mode = def->volume                    ? SN_VOLUME_NODE
                       : def->rung != SN_RUNG_CENTRAL ? SN_VOLUME_CELL
                                                      : SN_VOLUME_NONE;
    net->integrator = def->integrator;
    net->precision = def->integrator == SN_INTEGRATOR_EXPLICIT ? def->precision : SN_DOUBLE;
    net->isa = sn_isa_current();
    net->damping = def->damping;
    net->until = c->until;
    net->output_every = c->output_every;
    net->scheme = def->scheme;
    net->asked_step = def->step;
    net->tolerance = def->tolerance > 0                              ? def->tolerance
                     : def->integrator == SN_INTEGRATOR_QUASI_STATIC ? 1e-10
                                                                     : 1e-8;
    net->cuttable = def->cuttable || c->cut_count > 0;
    memcpy(net->gravity, c->gravity, sizeof net->gravity);
    net->threads = sn_team_limit(def->threads);
    if (net->threads < def->threads)
        snprintf(net->note, sizeof net->note, "%d threads were asked for; this build runs on %d. ",
                 def->threads, net->threads);
    net->node_position = sn_alloc((size_t)net->nodes * 3, sizeof(double));
    net->region_count = c->mesh->region_count;
    net->region = sn_alloc((size_t)net->region_count, sizeof *net->region);
    if (!net->node_position || !net->region) return SN_E_MEMORY;
    memcpy(net->node_position, c->mesh->node, (size_t)net->nodes * 3 * sizeof(double));
    for (int r = 0; r < net->region_count; r++) {
        net->region[r].tissue = c->tissue[r];
        SN_TRY(set_tissue(c, net, &net->region[r]));
    }
    SN_TRY(sn_case_axes_field(c, net->axes, &net->cell_axes));
    for (int k = 0; k < 9; k++) net->rotated = net->rotated || net->axes[k] != (k % 4 == 0);
    return SN_OK;
}

// of a case whose mesh has its nodes in the net's order
static sn_status build(const sn_case *c, sn_net *net) {
    SN_TRY(copy_case(c, net));
    SN_TRY(sn_net_build_cells(c, net));
    if (net->rung == SN_RUNG_CENTRAL) SN_TRY(sn_net_build_springs(c, net));
    if (net->rung == SN_RUNG_SMOOTHED) SN_TRY(sn_net_build_edges(c, net));
    SN_TRY(sn_net_build_turns(net));
    SN_TRY(sn_net_build_tiles(c, net));
    SN_TRY(c->springs_given && net->rung == SN_RUNG_CENTRAL ? sn_net_share_given(net)
                                                            : list_shares(net));
    SN_TRY(set_masses(c, net));
    SN_TRY(sn_net_build_drive(c, net));
    SN_TRY(set_inverse_masses(net));
    if (net->cuttable) SN_TRY(sn_cutting_create(c, net));
    net->edge = mean_edge(net);
    // the step must be known before the memory, the viscous part before the step
    for (int r = 0; r < net->region_count; r++)
        SN_TRY(set_memory(c, &net->region[r], c->output_every));
    double t_min = 1e-3 * net->output_every;
    if (net->integrator == SN_INTEGRATOR_EXPLICIT) {
        SN_TRY(sn_net_find_step(net));
        t_min = net->step;
    } else if (net->integrator == SN_INTEGRATOR_IMPLICIT) {
        t_min = net->step = sn_net_implicit_step(net);
    } else {
        double corner = sn_net_next_corner(net, 0.0);
        if (isfinite(corner)) t_min = fmin(t_min, 1e-3 * corner);
        if (net->asked_step > 0) t_min = fmin(t_min, net->asked_step);
    }
    for (int r = 0; r < net->region_count; r++) SN_TRY(set_memory(c, &net->region[r], t_min));
    sn_net_place_stores(net);
    return copy_single(net);
}

sn_status sn_net_create(const sn_case *c, sn_net **net) {
    *net = NULL;
    SN_TRY(check_settings(c));
    SN_TRY(sn_case_check(c));
    SN_TRY(check_motion(c));
    SN_TRY(check_mesh(c->mesh));
    sn_net *n = sn_alloc(1, sizeof *n);
    if (!n) return SN_E_MEMORY;
    sn_case ordered = *c;
    ordered.mesh = NULL;
    ordered.springs_given = NULL;
    n->node_name = sn_alloc((size_t)c->mesh->node_count, sizeof *n->node_name);
    sn_status status =
        n->node_name ? sn_net_order_nodes(c->mesh, &ordered.mesh, n->node_name) : SN_E_MEMORY;
    if (status == SN_OK && c->springs_given)
        status = sn_net_order_springs(c->springs_given, n->node_name, c->mesh->node_count,
                                      &ordered.springs_given);
    if (status == SN_OK) status = build(&ordered, n);
    sn_mesh_destroy(ordered.mesh);
    sn_spring_set_destroy(ordered.springs_given);
    n->node_place = sn_alloc((size_t)c->mesh->node_count, sizeof *n->node_place);
    if (!n->node_place) status = SN_E_MEMORY;
    for (int i = 0; i < n->nodes && status == SN_OK; i++) n->node_place[n->node_name[i]] = i;
    if (status == SN_OK) n->fingerprint = sn_net_fingerprint(c, n);
    if (status != SN_OK) {
        sn_net_destroy(n);
        return status;
    }
    *net = n;
    return SN_OK;
}

static void destroy_data(sn_net_data *d) {
    void *all[] = {d->gradient,        d->volume, d->edge,         d->inverse, d->stiffness,
                   d->point_stiffness, d->weight, d->inverse_mass, d->turn};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
}

static void destroy_drive(sn_net *n) {
    for (int k = 0; k < n->factor_count; k++) sn_history_destroy(n->factor[k]);
    for (int k = 0; k < n->load_count; k++) {
        sn_history_destroy(n->load[k].factor);
        sn_free(n->load[k].node);
        sn_free(n->load[k].force);
    }
    for (int k = 0; k < n->tool_count; k++) sn_tool_release(&n->tool[k]);
    for (int k = 0; k < n->probe_count; k++) sn_free(n->probe[k].fixed);
    void *all[] = {n->factor,       n->load,   n->tool,
                   n->probe,        n->fixed,  n->fixed_bits,
                   n->contact_node, n->loaded, n->contact_stiffness};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
}

void sn_net_destroy(sn_net *n) {
    if (!n) return;
    destroy_data(&n->data[SN_SINGLE]);
    destroy_data(&n->data[SN_DOUBLE]);
    destroy_drive(n);
    sn_tiles_destroy(&n->cell_tiles);
    sn_tiles_destroy(&n->spring_tiles);
    sn_tiles_destroy(&n->fan_tiles);
    sn_net_destroy_edges(n);
    sn_cutting_destroy(n->cutting);
    void *all[] = {n->node_name,     n->region,      n->cell_node,          n->cell_point,
                   n->cell_slot,     n->spring_end,  n->spring_share_start, n->spring_share,
                   n->spring_volume, n->point_start, n->point_item,         n->point_node,
                   n->point_volume,  n->node_start,  n->node_item,          n->node_position,
                   n->mass,          n->mode,        n->root_inverse_mass,  n->node_place,
                   n->cell_axes};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) sn_free(all[k]);
    sn_free(n);
}

int sn_net_node_count(const sn_net *net) {
    return net->nodes;
}
int sn_net_spring_count(const sn_net *net) {
    return net->springs;
}
int sn_net_cell_count(const sn_net *net) {
    return net->cells;
}
const sn_exponentials *sn_net_memory(const sn_net *net) {
    return &net->region[0].memory;
}
double sn_net_step(const sn_net *net) {
    return net->step;
}
