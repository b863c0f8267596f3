// The inside of a net.
// SPDX-License-Identifier: Apache-2.0
//
// A net holds what kernels read in double precision always, and in single precision too where the
// explicit integrator runs in it: equilibrium, the search for the highest frequency, fields and
// energies are double whatever the step is. What is done with it: springs/forces.h (forces and
// tangent at a place), springs/state.h (the inside of a state), springs/steps.h (how a state goes
// on), springs/moment.h (fields and energies), springs/run.h, springs/parts.h (what cuts leave).
#pragma once

#include <stdint.h>

#include "sinew/springs.h"
#include "springs/pass.h"
#include "springs/team.h"

/// Part of a net: the cells, springs and volume points of one region of the mesh.
typedef struct sn_net_region {
    sn_tissue tissue;
    float value_f[SN_VALUES_MAX];
    int splits;         ///< of the distortional stress: 1; 2: the matrix, then the fibres
    sn_tissue split[2]; ///< central: the matrix is of springs, fibres are of cells
    float split_value_f[2][SN_VALUES_MAX];
    bool fibred;    ///< fibres have an energy of their own, which resists tension only
    sn_tissue bare; ///< where fibred: without them
    float bare_f[SN_VALUES_MAX];
    double density;
    double shear;    ///< instantaneous, small strain
    double bulk;     ///< of the volume term of this net (central: what springs do not bring)
    double exponent; ///< B of the springs
    double square[SN_SPRING_SQUARES]; ///< C and c of the springs
    bool squared;                     ///< not all of them 0
    double stiffening; ///< factor on the springs' stiffness from the fit of their law
    /// Of all parts of the stress; of the deviatoric one where the tissue is branched.
    sn_exponentials memory;
    int branches; ///< exponentials and the viscous part
    /// Of the other parts where the tissue is branched.
    sn_exponentials volumetric, fibre;
    int cell_block, cell_blocks;
    int spring_block, spring_blocks;
    int point_block, point_blocks;
    int edge_block, edge_blocks;                  ///< smoothed
    size_t cell_store, spring_store, point_store; ///< first number in the state's store; of
                                                  ///< `cell_store` where the law is: at cells, or
                                                  ///< at smoothed edges
    size_t fibre_store, bulk_store; ///< where the law is too: split[1]; volume of a branched tissue
} sn_net_region;

/// The exponentials of a part of the stress.
static inline const sn_exponentials *sn_region_memory(const sn_net_region *region, sn_part part) {
    if (!region->tissue.branched || part == SN_PART_DEVIATORIC) return &region->memory;
    return part == SN_PART_VOLUMETRIC ? &region->volumetric : &region->fibre;
}
/// Their number, and the viscous part.
static inline int sn_region_branches(const sn_net_region *region, sn_part part) {
    const sn_exponentials *memory = sn_region_memory(region, part);
    return memory->terms + (memory->viscous > 0);
}
/// The part of the stress that split[k] is.
static inline sn_part sn_split_part(int k) {
    return k == 0 ? SN_PART_DEVIATORIC : SN_PART_FIBRE;
}

typedef struct sn_tile_place {
    int region;
    int block, blocks;
    int ring; ///< of fans
    bool closed;
    size_t corner; ///< first in `corner` of sn_tiles
} sn_tile_place;

/// Blocks of one kind in tiles (springs/pass.h), region by region.
typedef struct sn_tiles {
    int count;
    sn_tile_place *place; ///<                                    (count)
    int *start;           ///< first entry of `node` of each, and the end (count + 1)
    int *node;            ///< nodes of the tiles, rising in each
    int *point;           ///< volume point of each; NULL without
    size_t corner_count;
    uint16_t *corner;  ///< four times the place in `node` from the tile's start
    void *position[2]; ///< quads, by sn_precision: rest positions from the tile's first node
} sn_tiles;

static inline int sn_tiles_entries(const sn_tiles *t) {
    return t->count > 0 ? t->start[t->count] : 0;
}

/// A spring that has no place yet.
typedef struct sn_spring {
    int end[2];
    double edge[3]; ///< from end 0 to end 1
    double length2, stiffness;
    double volume; ///< of the cells around it
} sn_spring;

/// An edge of a cell: one of six.
typedef struct sn_edge_part {
    int low, high; ///< nodes
    int slot;      ///< of the cell
    int side;      ///< which of the six
    double volume; ///< of the cell
    double turn;   ///< dihedral angle over a full turn
} sn_edge_part;

/// Cells around one edge.
typedef struct sn_fan {
    int ring;    ///< nodes around the edge
    bool closed; ///< the last meets the first
    int node[2 + SN_FAN_RING];
} sn_fan;

/// What kernels read, in one precision. Single precision has only what the step reads.
typedef struct sn_net_data {
    void *gradient, *volume; ///< cells; single: coupled only
    void *turn; ///< Nullable: axes of the places of the law, where they differ (blocks x 9 x …)
    void *edge, *inverse, *stiffness; ///< springs; edge and 1 / length2: double only
    void *point_stiffness;            ///< volume points
    void *weight, *inverse_mass;      ///< nodes, quads
} sn_net_data;

/// A prescribed direction of a node.
typedef struct sn_net_fixed {
    int node, direction;
    int load; ///< -1: a support
    double value;
} sn_net_fixed;

/// Traction or force lumped at nodes, or faces under pressure.
typedef struct sn_net_load {
    sn_load_kind kind;
    int name;           ///< number in the case
    sn_history *factor; ///< Nullable, owned
    double pressure;
    int count;     ///< nodes of a traction or force, faces of a pressure
    int *node;     ///<                                       (count, or count x 3)
    double *force; ///< traction or force: N at factor 1      (count x 3)
} sn_net_load;

typedef struct sn_net_probe {
    sn_probe_kind kind;
    int node[4]; ///< point
    double weight[4];
    int count; ///< reaction: entries of `fixed` that belong to its surface
    int *fixed;
} sn_net_probe;

/// What cuts leave of a net: stands where NULL stands for the whole net. Arrays as those of a net.
typedef struct sn_parts {
    const void *volume[2], *stiffness[2], *point_stiffness[2]; ///< by sn_precision
    const double *point_volume, *spring_volume;
    const uint16_t *cell_corner;       ///< removed cells have all corners at one node
    const uint16_t *spring_corner;     ///< springs that are gone stand where others stand
    const unsigned char *spring_empty; ///< tiles of which no spring is left
    const void *present[2];            ///< fans: see sn_tile, beside their `corner`
    const int *rim, *rim_count;        ///< slots of cells at nodes that have lost one (rim_count)
    const bool *gone;                  ///< slots of removed cells        (cell_blocks x SN_BLOCK)
    const bool *loose;                 ///< nodes that have lost all cells               (nodes)
    const double *contact_stiffness;   ///< 0: not on the surface              (contact_count)
    double *const *load_force;         ///< of a load: as its `force`, NULL of a pressure
    bool *const *load_gone; ///< of a load: faces of removed cells; NULL but of a pressure
} sn_parts;
typedef struct sn_cutting sn_cutting; // springs/cut.h
typedef struct sn_cut sn_cut;

struct sn_net {
    int nodes, cells, springs;
    sn_rung rung;
    bool volume;
    sn_volume_mode volume_mode;
    sn_integrator integrator;
    sn_scheme scheme;
    sn_precision precision; ///< of the step
    int isa, threads;
    double damping;
    double until, output_every;
    double asked_step; ///< of the case; 0: chosen
    double tolerance;  ///< relative residual at which Newton stops: quasi-static, implicit
    double step;       ///< explicit, implicit
    double omega2;     ///< highest eigenvalue of M^-1 K at rest, 1/s2
    double *mode;      ///< of omega2, in mass-scaled displacements      (nodes x 3)
    double edge;       ///< mean length of a cell's edges, m
    char note[SN_TEXT_MAX];

    int region_count;
    sn_net_region *region;
    int cell_blocks, spring_blocks, point_blocks, edge_blocks;
    int *cell_node;          ///<                                     (cell_blocks x 4 x SN_BLOCK)
    int *cell_point;         ///<                                     (cell_blocks x 4 x SN_BLOCK)
    int *cell_slot;          ///< place of each cell of the mesh      (cells)
    int *spring_end;         ///<                                     (spring_blocks x 2 x SN_BLOCK)
    int *spring_share_start; ///< springs of each slot of a cell (cell_blocks x SN_BLOCK + 1)
    int *spring_share;       ///< slot of the spring
    int *edge_start, *edge_cell; ///< smoothed: slots of the cells around each edge
    int *cell_edge;     ///< smoothed: slots of the edges of each cell (cell_blocks x 6 x SN_BLOCK)
    int edge_most;      ///< most cells around an edge
    bool *edge_filling; ///< (edge_blocks x SN_BLOCK)
    double *spring_volume; ///< volume of the cells around each spring (spring_blocks x SN_BLOCK)
    sn_tiles spring_tiles, cell_tiles, fan_tiles; ///< central, where a solid law is, with volume
    int part_count;                ///< entries of springs, then of fans (central), then of cells
    int fan_part;                  ///< first entry of fans
    int cell_part;                 ///< first entry of cells
    int *point_start, *point_item; ///< entries of fan tiles at each volume point
    int *point_node;      ///< node of each volume point; -1 for filling (point_blocks x SN_BLOCK)
    double *point_volume; ///<                                (point_blocks x SN_BLOCK)
    int *node_start, *node_item; ///< entries of tiles at each node
    int *node_name;              ///< number in the mesh of each node (nodes)
    int *node_place;             ///< the other way round             (nodes)
    double *node_position;       ///<                         (nodes x 3)
    double *mass;                ///<                               (nodes)
    double *root_inverse_mass;   ///< of free directions, else 0   (nodes x 3)
    double gravity[3];
    double axes[9];      ///< of the material; the identity where they differ
    bool rotated;        ///< axes are not the identity
    double *cell_axes;   ///< Nullable: of each cell of the mesh, where they differ (cells x 9)
    size_t store_size;   ///< numbers in the store of a state
    sn_net_data data[2]; ///< by sn_precision

    int fixed_count;
    sn_net_fixed *fixed;
    unsigned char *fixed_bits; ///<                           (nodes)
    int load_count;
    sn_net_load *load;
    int factor_count;    ///< of displacement loads
    sn_history **factor; ///< owned, Nullable entries
    int tool_count;
    sn_tool *tool; ///< paths owned
    int contact_count;
    int skin_count; ///< of these on the surface at rest: the first; others may get there by cuts
    int *contact_node;
    double *contact_stiffness; ///< N/m; 0 behind `skin_count`
    int loaded_count;          ///< but for nodes that are not on the surface yet
    int loaded_all;
    int *loaded; ///< nodes that loads and tools can push               (loaded_all)
    int probe_count;
    sn_net_probe *probe;
    bool by_turn;         ///< springs have class constants: shares of cells by their angle
    bool cuttable;        ///< its states may be cut
    sn_cutting *cutting;  ///< Nullable: what cuts need to know; of a net that is cuttable
    uint64_t fingerprint; ///< of all that results depend on
};

/// The first of region->split that is evaluated at cells or smoothed edges: on the central rung the
/// fibres.
static inline int sn_net_first_split(const sn_net *net) {
    return net->rung == SN_RUNG_CENTRAL ? 1 : 0;
}
/// Blocks of the places of a region where a solid law is evaluated: cells, or smoothed edges. None
/// on the central rung without fibres.
static inline int sn_region_law_blocks(const sn_net *net, const sn_net_region *region) {
    if (sn_net_first_split(net) >= region->splits) return 0;
    return net->rung == SN_RUNG_SMOOTHED ? region->edge_blocks : region->cell_blocks;
}
static inline int sn_region_law_block(const sn_net *net, const sn_net_region *region) {
    return net->rung == SN_RUNG_SMOOTHED ? region->edge_block : region->cell_block;
}

/// Calls of the kernels that go over nodes.
static inline int sn_net_chunks(const sn_net *net) {
    return (net->nodes + SN_NODE_CHUNK - 1) / SN_NODE_CHUNK;
}

/// Whether a net has fibres apart from the matrix. These carry tension only, so that a body that
/// stands still does not show how stiff it may be in the next moment.
static inline bool sn_net_has_fibres(const sn_net *net) {
    for (int r = 0; r < net->region_count; r++)
        if (net->region[r].fibred) return true;
    return false;
}
static inline double sn_real_at(sn_precision precision, const void *array, size_t i) {
    return precision == SN_SINGLE ? (double)((const float *)array)[i] : ((const double *)array)[i];
}

static inline void sn_real_put(sn_precision precision, void *array, size_t i, double x) {
    if (precision == SN_SINGLE)
        ((float *)array)[i] = (float)x;
    else
        ((double *)array)[i] = x;
}

/// Memory that a snapshot holds.
typedef struct sn_piece {
    void *data;
    size_t bytes;
} sn_piece;
#define SN_PIECES_MAX 64

//---- building ------------------------------------------------------------------------------------

/// Cells into blocks, volume points, node lists (springs too where the rung has them).
sn_status sn_net_build_cells(const sn_case *c, sn_net *net);
/// Edges into springs: class constants, or those of cells with a common scale.
sn_status sn_net_build_springs(const sn_case *c, sn_net *net);
/// Springs given one by one (springs/given.c): a set whose nodes stand in the order of the net.
sn_status sn_net_order_springs(const sn_spring_set *set, const int *name, int nodes,
                               sn_spring_set **ordered);
/// Bulk modulus of the volume term beside given springs, of a tissue with the bulk modulus `bulk`.
double sn_net_given_bulk(const sn_case *c, int region, double bulk);
/// Springs of one region out of c->springs_given.
sn_status sn_net_given_springs(const sn_case *c, sn_net *net, int region);
/// Which cells share the energy and stress of given springs, and their volume.
sn_status sn_net_share_given(sn_net *net);
/// Edges with the cells around them, of the smoothed rung.
sn_status sn_net_build_edges(const sn_case *c, sn_net *net);
void sn_net_destroy_edges(sn_net *net);
/// The edges of the cells of a region, sorted by nodes, then by slot of the cell. *parts is
/// sn_alloc'd for the caller.
sn_status sn_net_list_parts(const sn_mesh *mesh, const sn_net *net, int region,
                            sn_edge_part **parts, int *count);
/// Places the springs of a region, sorted by end 0, in stars.
sn_status sn_net_place_springs(sn_net *net, sn_net_region *region, const sn_spring *spring,
                               int count);
/// Axes of the places of the law from those of the cells, where they differ. After the edges.
sn_status sn_net_build_turns(sn_net *net);
/// The law of a tissue at n places from `slot` (cells, or smoothed edges), at most SN_BLOCK, as
/// sn_law_solid(), with strains and stresses in net->axes. S is needed, W and D may be NULL.
void sn_net_law(const sn_net *net, const sn_tissue *tissue, int slot, int n, const double *E,
                double *W, double *S, double *D);
/// Tiles, and the lists of nodes and volume points. After cells and springs.
sn_status sn_net_build_tiles(const sn_case *c, sn_net *net);
/// All cells of a region in fans: by size, then along the curve. *fans is sn_alloc'd for the
/// caller.
sn_status sn_net_list_fans(const sn_mesh *mesh, int region, sn_fan **fans, int *count);
void sn_tiles_destroy(sn_tiles *tiles); // the struct itself is the caller's
/// A copy of the mesh with its nodes in the order of a space-filling curve. name[k]: number in
/// `mesh` of node k of the copy. Cells keep their numbers.
sn_status sn_net_order_nodes(const sn_mesh *mesh, sn_mesh **ordered, int *name);
/// order[k]: which cell is the k-th on the curve.
sn_status sn_net_cell_order(const sn_mesh *mesh, int *order);
/// Slot, from its first, of item k of `count` along the curve. Within a chunk, items that follow
/// each other on the curve, and share nodes, stand 16 slots apart, and neighbours are far from each
/// other on the curve: a sum at a node then need not wait for the one before.
static inline int sn_spread(int k, int count, int chunk) {
    enum { APART = 16 };
    if (k / chunk * chunk + chunk > count) chunk = SN_BLOCK; // the rest, in smaller ones
    const int first = k / chunk * chunk, place = k - first, runs = chunk / APART;
    return first + chunk > count ? k : first + place % runs * APART + place / runs;
}
/// Supports, loads, tools, probes.
sn_status sn_net_build_drive(const sn_case *c, sn_net *net);
/// Stiffness per unit shear modulus of an edge that is wholly present, by class of the built-in
/// blocks. @return false where the block has no such constants.
bool sn_lattice_constants(const sn_shape_def *shape, double axis[3], double face[3], double *body);
/// Factor on the springs of a region, of which stiffnesses are over the shear modulus, that brings
/// the net to it.
sn_status sn_net_relaxed_scale(const sn_mesh *mesh, int region, const sn_spring *spring, int count,
                               double *scale);
/// The law of one spring (equation 14 in tension, without collapse in compression, and what a
/// calibration adds: sinew/model.h), over stiffness and rest length.
typedef struct sn_spring_law {
    double exponent, up, down; ///< B; n.C n; c
} sn_spring_law;
sn_spring_law sn_net_spring_law(const sn_net *net, const sn_net_region *region, int slot);
/// Force at a stretch above 0. @param slope  Nullable
double sn_spring_tension(const sn_spring_law *law, double lambda, double *slope);
/// Its integral from rest, over squared rest length.
double sn_spring_potential(const sn_spring_law *law, double lambda);
/// The stretch at which the force is t.
double sn_spring_stretch(const sn_spring_law *law, double t);
/// Exponent B, and factor on the stiffness, of springs that together stretch like the tissue.
sn_status sn_spring_fit(const sn_tissue *tissue, double *exponent, double *factor);

uint64_t sn_net_fingerprint(const sn_case *c, const sn_net *net);
