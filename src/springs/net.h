// The inside of a net and of a state.
// SPDX-License-Identifier: Apache-2.0
//
// A net holds what kernels read in double precision always, and in single precision too where the
// explicit integrator runs in it: equilibrium, the search for the highest frequency, fields and
// energies are double whatever the step is.
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

/// Factors of the recursion of one memory for one step.
typedef struct sn_recursion {
    double alpha;
    double decay[SN_BRANCHES_MAX], gain[SN_BRANCHES_MAX];
} sn_recursion;
/// Those of one region: of every part of the stress, the same where it has one memory.
typedef struct sn_factors {
    sn_recursion part[SN_PARTS];
} sn_factors;

/// Arrays that one evaluation of the forces fills.
typedef struct sn_scratch {
    void *f;             ///< quads                                (nodes)
    void *part;          ///< quads: forces of the entries of tiles (part_count)
    void *growth;        ///< of the entries of fan tiles
    void *shape, *piola; ///< smoothed: (cell_blocks, edge_blocks x SN_BLOCK x 12)
    void *pressure;      ///<                                      (point_blocks x SN_BLOCK)
    sn_cell_pass *cells; ///< what kernels are told, by region (region_count)
    sn_cell_pass *fibre; ///< of a central net
    sn_spring_pass *springs;
    sn_point_pass *points;
} sn_scratch;

/// A node that moves with a tool.
typedef struct sn_grip {
    int tool;                        ///< -1: free
    double at[3];                    ///< in the tool's axes, m
    double u_before[3], v_before[3]; ///< at the start of the step
    double way_a[3];                 ///< acceleration of the last step
} sn_grip;

typedef struct sn_implicit sn_implicit;

#define SN_LANCZOS_MAX 10 ///< steps before a restart, at rest
#define SN_LANCZOS_WARM 2 ///< steps while running

/// A search for the highest frequency under way.
typedef struct sn_lanczos {
    int steps;
    double tiny; ///< factor of the trial displacement
    double diagonal[SN_LANCZOS_MAX], beside[SN_LANCZOS_MAX];
} sn_lanczos;

/// A look at the frequency that goes on over several steps (springs/look.c).
typedef struct sn_look {
    void *u;      ///< quads: the place that is looked at
    int done;     ///< tasks; 0: none is under way
    bool upright; ///< cells were crushed there
    sn_lanczos lanczos;
} sn_look;

struct sn_state {
    double time;
    sn_precision precision;
    void *u, *v;    ///< quads
    void *f_before; ///< quads: total force at the start of the last step
    void *store;
    sn_scratch now;
    sn_team *team;                     ///< NULL: alone
    double *chunk_sum, *chunk_fastest; ///< of sn_move_pass
    double factors_step;               ///< of `factors`; 0: none yet
    sn_factors *factors;               ///< (region_count)
    double last_step;                  ///< length of the last step
    double *a_fixed;                   ///< acceleration of prescribed directions (fixed_count)
    double *ext;                       ///< force of loads and tools             (nodes x 3)
    sn_contact *contact;               ///< (tool_count x contact_count)
    sn_pose *tool_pose;                ///< where sn_state_set_tool() put it
    bool *tool_set;
    double (*tool_force)[3];
    double (*tool_torque)[3];  ///< about the tool's centre
    unsigned char *tool_phase; ///< of a grasp by the case: 0 before, 1 in it, 2 after
    double *load_factor;       ///< of sn_state_set_load()         (factor_count)
    double *load_was;          ///< in use at the end of the last step; NAN: that of the case
    bool *load_set;
    double *push;                ///< of sn_state_push(), N          (nodes x 3)
    int *pushed, pushed_count;   ///< nodes that have one
    sn_grip *grip;               ///<                                (nodes)
    int *gripped, gripped_count; ///< nodes that tools hold
    // the search for the highest frequency
    sn_look look;
    void *probe_trial; ///< quads
    double *mode, *basis;
    sn_scratch probe;
    double omega2, seen_omega2; ///< until the next look, at the last look
    double ruling_omega2;       ///< what the step is chosen for
    double doubt;               ///< factor on omega2: above 1 until looks have seen what a cut left
    bool touching;              ///< a node touches a tool
    long steps;
    int check_in, check_every; ///< steps until omega2 is looked at again
    double moved, check_way;   ///< most that a node can have moved since, may move, m
    int warnings;
    bool broken;  ///< a step gave numbers that are not finite; the state was put back to rest
    bool crushed; ///< volume points were, and some cells may still be
    double damped_energy;  ///< taken by damping by mass so far, J
    sn_implicit *implicit; ///< Nullable: what the implicit integrator works with
    sn_cut *cut;           ///< Nullable: what was removed; of a net that is cuttable
};

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

//---- memory --------------------------------------------------------------------------------------

/// Kinds of items that remember.
enum {
    SN_STORE_CELL, ///< split[0] where a solid law is, and its volume stress unless branched
    SN_STORE_SPRING,
    SN_STORE_POINT,
    SN_STORE_FIBRE, ///< split[1]
    SN_STORE_BULK,  ///< volume stress where a solid law is, of a branched tissue
    SN_STORES
};
/// Where one kind of item of a region stands in the store of a state: blocks x (1 + branches) x
/// components x SN_BLOCK, nothing where there are no branches.
typedef struct sn_net_store {
    sn_part part;
    int components, blocks;
    size_t first;
} sn_net_store;
void sn_region_stores(const sn_net *net, const sn_net_region *region,
                      sn_net_store store[SN_STORES]);
/// Places all stores in that of a state.
void sn_net_place_stores(sn_net *net);
/// Recomputes factors for a step of h seconds.
void sn_net_factors(const sn_net *net, double h, sn_factors *factors);
/// Takes the viscous part out of factors: the impulse of a sudden change is over at once.
void sn_net_no_impulse(const sn_net *net, sn_factors *factors);
/// history <- what the store contributes to the stress at the end of the step of `factors`, double.
void sn_net_history(const sn_net *net, const sn_factors *factors, const double *store,
                    double *history);

//---- forces --------------------------------------------------------------------------------------

typedef struct sn_force_call {
    sn_precision precision;
    sn_memory_mode mode;
    const void *u;
    const sn_factors *factors; ///< Nullable with SN_MEMORY_OFF
    void *store;               ///< ADVANCE
    const void *history;       ///< TRIAL
    const sn_parts *parts;     ///< Nullable
    bool upright;              ///< some cells are crushed (SN_UPRIGHT)
    bool bare;                 ///< without fibres, where these have an energy of their own
    sn_scratch *out;
    sn_team *team; ///< Nullable: alone
} sn_force_call;
/// Internal forces and weight at all nodes, in out->f.
void sn_net_forces(const sn_net *net, const sn_force_call *call);
/// The same in parts: an evaluation is sn_net_force_tasks() tasks in order, and `count` of them,
/// from `first` on, are done. All but the last part leave what they did in `out` alone.
void sn_net_forces_part(const sn_net *net, const sn_force_call *call, int first, int count);
int sn_net_force_tasks(const sn_net *net);
sn_status sn_scratch_create(const sn_net *net, sn_precision precision, sn_scratch *scratch);
void sn_scratch_destroy(sn_scratch *scratch);

/// Displacement of prescribed direction k at time t.
double sn_net_prescribed(const sn_net *net, const sn_net_fixed *fixed, double t);
/// The next corner of any load, tool path or prescribed motion after t.
double sn_net_next_corner(const sn_net *net, double t);
/// Whether anything imposed changes between two times with no corner between them.
bool sn_net_changes(const sn_net *net, double from, double to);
/// Nodes of `loaded` that may be pushed. parts: Nullable, here and below.
static inline int sn_net_loaded(const sn_net *net, const sn_parts *parts) {
    return parts ? net->loaded_all : net->loaded_count;
}
/// A place, to find the forces of loads at.
typedef struct sn_load_call {
    sn_precision precision;
    const void *u; ///< quads
    const sn_parts *parts;
} sn_load_call;
/// Adds a load to ext (nodes x 3).
void sn_net_add_load(const sn_net *net, int load, double factor, const sn_load_call *call,
                     double *ext);
/// Adds all loads, with their own factors.
void sn_net_loads(const sn_net *net, double t, const sn_load_call *call, double *ext);
/// Clears ext at the loaded nodes.
void sn_net_clear_ext(const sn_net *net, const sn_parts *parts, double *ext);
/// Contact with tools: forces into ext, sum by tool into tool_force; `after` may be `before`.
/// tangent(context, node, 3x3) is called for touching nodes where not NULL.
typedef void sn_tangent_sink(void *context, int node, const double tangent[9]);
typedef struct sn_contact_call {
    sn_precision precision;
    const void *u;
    const sn_pose *pose; ///< of the tools
    const sn_contact *before;
    sn_contact *after;
    double *ext;
    double (*tool_force)[3];
    double (*tool_torque)[3]; ///< Nullable: about the centre of the pose
    const sn_grip *grip;      ///< Nullable: nodes that tools hold do not touch them (nodes)
    const sn_parts *parts;    ///< Nullable
    sn_tangent_sink *tangent;
    void *context;
} sn_contact_call;
/// @return whether a node touches a tool.
bool sn_net_contact(const sn_net *net, const sn_contact_call *call);
/// Where a tool is at time t.
void sn_net_tool_pose(const sn_net *net, const sn_state *state, int tool, double t, sn_pose *pose);

/// After a step in which a node moved by `way` at most: goes on with the look at the frequency, or
/// starts one when it is due.
void sn_state_follow_frequency(const sn_net *net, sn_state *s, double way);
/// A tool begins to touch: looks follow each other closely until they find nothing new.
void sn_state_look_closer(const sn_net *net, sn_state *s);
/// After a cut: omega2 doubles, until looks that begin at once have seen what is left.
void sn_state_doubt_frequency(const sn_net *net, sn_state *s);
/// Before a cut: a look that follows another cut, if one is under way, is brought to its end, so
/// that cuts which follow each other fast leave no state without looks.
void sn_state_finish_look(const sn_net *net, sn_state *s);
/// Ends a look under way without a result: what it looked at is no more.
void sn_state_forget_look(sn_state *s);
/// Does again what a look under way had done, which bytes do not hold.
void sn_state_redo_look(const sn_net *net, sn_state *s);
/// Frequency and way until the next look, of a state at rest.
void sn_state_rest_frequency(const sn_net *net, sn_state *s);
/// Looks whether cells are crushed, from s->now.growth, and from all cells while some were; counts
/// a warning when it begins.
void sn_state_look_at_cells(const sn_net *net, sn_state *s);
/// Whether crushed cells have a stress of their own now (SN_UPRIGHT).
bool sn_state_is_upright(const sn_state *s);
/// Modulus of the stress of crushed cells (SN_UPRIGHT) of a region, Pa.
double sn_region_upright(const sn_net_region *region);
/// What that stress adds to the highest eigenvalue at most, of one cell, 1/s2: a look at a place
/// where it does not act just then cannot see it.
double sn_state_upright_stiffness(const sn_net *net, const sn_state *s);

//---- what is imposed while a state runs ----------------------------------------------------------

/// Factor of a load of the case: the caller's, or that of its time table.
double sn_state_load_factor(const sn_net *net, const sn_state *s, int load, double t);
/// Displacement of prescribed direction k at time t, at the end of the last step where `was`.
double sn_state_prescribed(const sn_net *net, const sn_state *s, const sn_net_fixed *fixed,
                           double t, bool was);
/// No loads, pushes or grips but those of the case; tools where the case has them.
void sn_state_clear_imposed(const sn_net *net, sn_state *s);
/// Adds pushes to the forces in s->now.f.
void sn_state_add_pushes(sn_state *s);
/// Keeps the place and velocity of held nodes, at the start of a step.
void sn_state_remember_grips(sn_state *s);
/// Takes held nodes to where their tools are at the state's time + h.
void sn_state_move_grips(const sn_net *net, sn_state *s, double h);
/// Takes the stiffness of contact off the stable step (springs/touch.c): changes s->now.f, s->ext
/// and what tools feel at the nodes that touch.
void sn_state_ease_contact(const sn_net *net, sn_state *s);
/// The step that contact is eased for, s, and how much longer than it the next one may be.
double sn_state_touch_step(const sn_net *net, const sn_state *s);
#define SN_TOUCH_GROWTH 1.2
/// Adds what held nodes give their tools, from the forces in s->now.f.
void sn_state_pull_tools(const sn_net *net, sn_state *s);
/// Grasps and releases what the case says for the state's time.
void sn_state_follow_grasps(const sn_net *net, sn_state *s);

//---- explicit integration -----------------------------------------------------------------------

/// Highest eigenvalue of M^-1 K (instantaneous stiffness, prescribed directions held) at
/// displacement u, by Lanczos' method from the vector in `mode`, which gets the approximate
/// eigenvector.
typedef struct sn_frequency_call {
    sn_precision precision; ///< of the forces; the vectors of the search are double
    const void *u;          ///< quads
    void *trial;            ///< quads, scratch
    double *mode;           ///< mass-scaled displacements    (nodes x 3)
    double *basis;          ///< scratch                      (steps + 1 vectors)
    int steps;              ///< at most SN_LANCZOS_MAX
    sn_scratch *scratch;    ///< in that precision
    sn_team *team;          ///< Nullable: alone
    const sn_parts *parts;  ///< Nullable
    bool upright;           ///< as in sn_force_call
    bool taut;              ///< at rest: fibres resist both ways
} sn_frequency_call;
double sn_net_frequency(const sn_net *net, const sn_frequency_call *call);
/// The same in parts: begin with the forces at u in the scratch; while it is true that another
/// evaluation is wanted, of the forces at `trial`, go on with them; end gives the eigenvalue.
bool sn_lanczos_begin(const sn_net *net, const sn_frequency_call *call, sn_lanczos *l);
bool sn_lanczos_go_on(const sn_net *net, const sn_frequency_call *call, sn_lanczos *l);
double sn_lanczos_end(const sn_net *net, const sn_frequency_call *call, sn_lanczos *l);
/// After a search in a cut body: gives call->mode, of length 1, weight on what is apart from it.
void sn_lanczos_spread(const sn_net *net, const sn_frequency_call *call, const sn_lanczos *l);
/// Before the first of them: gives a mode length 1, and a motion without structure on top.
void sn_lanczos_stir(const sn_net *net, double *mode);
/// The explicit step and the mode of the highest frequency of a net at rest.
sn_status sn_net_find_step(sn_net *net);
/// Longest stable step for a highest eigenvalue, without safety.
double sn_net_stable_step(const sn_net *net, double omega2);
/// Part of the stability limit that a step takes.
#define SN_STEP_SAFETY 0.9
/// The same with fibres: symplectic Euler slowly gains energy where they tighten and slacken within
/// few steps. Measured without any damping, fibres 15 times as stiff as the matrix: at 0.9 of the
/// limit motions grow tenfold in 20,000 steps, at 0.77 twofold, at 0.63 they stay.
#define SN_STEP_SAFETY_FIBRES 0.63
/// Whether a net has fibres apart from the matrix. These carry tension only, so that a body that
/// stands still does not show how stiff it may be in the next moment.
static inline bool sn_net_has_fibres(const sn_net *net) {
    for (int r = 0; r < net->region_count; r++)
        if (net->region[r].fibred) return true;
    return false;
}
static inline double sn_net_step_safety(const sn_net *net) {
    return sn_net_has_fibres(net) ? SN_STEP_SAFETY_FIBRES : SN_STEP_SAFETY;
}

//---- implicit integration ------------------------------------------------------------------------

/// The step that the implicit integrator chooses for a net, or the case's own, s.
double sn_net_implicit_step(const sn_net *net);
/// For a state whose u, v, store, factors and scratch stand.
sn_status sn_implicit_create(const sn_net *net, sn_implicit **implicit);
void sn_implicit_destroy(sn_implicit *implicit); // NULL is allowed
/// Forgets the steps before: the state stands at rest.
void sn_implicit_reset(const sn_net *net, sn_implicit *implicit);
/// One step of at most dt; no allocation. Breaks the state where none, however short, succeeds.
void sn_implicit_advance(const sn_net *net, sn_state *s, double dt);
/// The next step starts from place and velocity alone: forces are others than those of the step
/// before.
void sn_implicit_restart(sn_implicit *implicit);
#define SN_RIGID 6 ///< motions of a rigid body
/// Forces of damping by mass at u and v of a state, and M R of its rigid motions.
/// @param rigid  (SN_RIGID x nodes x 3)
/// @param drag   (nodes x 3)
void sn_implicit_drag(const sn_net *net, const sn_state *s, double *rigid, double *drag);
/// Displacements at the start of the last step, quads.
const double *sn_implicit_before(const sn_implicit *implicit);
/// Why the last step was cut or failed, with numbers; empty where it was not.
const char *sn_implicit_reason(const sn_implicit *implicit);
/// Newton corrections, and steps cut, so far.
void sn_implicit_counts(const sn_implicit *implicit, int *corrections, int *cuts);
/// Back to rest, but for what is prescribed at the state's time.
void sn_state_rest(const sn_net *net, sn_state *s);
/// Smallest volume ratio of any cell; NAN where one is not finite. u: quads.
double sn_net_smallest_ratio(const sn_net *net, const sn_parts *parts, const double *u);

//---- what a run hands out ------------------------------------------------------------------------

static inline double sn_real_at(sn_precision precision, const void *array, size_t i) {
    return precision == SN_SINGLE ? (double)((const float *)array)[i] : ((const double *)array)[i];
}

static inline void sn_real_put(sn_precision precision, void *array, size_t i, double x) {
    if (precision == SN_SINGLE)
        ((float *)array)[i] = (float)x;
    else
        ((double *)array)[i] = x;
}

/// A moment of a run, in double: what fields, history and energies are computed from.
typedef struct sn_moment {
    double time;
    sn_precision precision;
    const void *u, *v; ///< quads; v Nullable
    const void *f;     ///< total force, quads
    const void *store;
    const void *pressure;    ///< at volume points
    const double *a_fixed;   ///< Nullable: at rest
    double (*tool_force)[3]; ///< read only
    double kinetic, damped;  ///< J: of motion; taken by damping by mass so far
    const sn_parts *parts;   ///< Nullable
    bool upright;            ///< crushed cells have a stress of their own
} sn_moment;
/// Energy of crushed cells against the stress that turns them round, J.
double sn_net_upright_energy(const sn_net *net, const sn_moment *moment);
typedef struct sn_fields sn_fields;
sn_status sn_fields_create(const sn_net *net, sn_fields **fields);
void sn_fields_destroy(sn_fields *fields); // NULL is allowed
/// Fills all fields of a moment; energy_density included.
void sn_fields_fill(const sn_net *net, sn_fields *fields, const sn_moment *moment);
/// Hands out what was filled last.
sn_status sn_fields_emit(const sn_fields *fields, double time, const sn_output *output);
/// Energy of the instantaneous law, W + U, of the whole body, from what was filled last, J.
double sn_fields_elastic(const sn_net *net, const sn_fields *fields);
/// What a body has stored, J.
typedef struct sn_stored {
    double instant; ///< of the instantaneous law, W + U
    double elastic; ///< of the equilibrium part, g_inf (W + U), each part with its own g_inf; and
                    ///< of crushed cells
    double memory;  ///< in the branches
} sn_stored;
/// From what was filled last, which was this moment.
sn_stored sn_fields_stored(const sn_net *net, const sn_fields *fields, const sn_moment *moment);
/// Green strain of the place of a slot where a solid law is evaluated (a cell, or a smoothed edge),
/// in material axes; returns its volume, 0 where it only fills a block.
double sn_net_law_strain(const sn_net *net, const sn_moment *moment, int slot, double E[6]);
/// What the branches of the memory have stored, J.
double sn_net_memory_energy(const sn_net *net, const sn_moment *moment);
/// Appends one row: time, probes, tools. `row` has room for the columns.
sn_status sn_net_history_row(const sn_net *net, const sn_moment *moment, double *row,
                             sn_record *history);

/// The memory of one kind of item of a region at a moment.
typedef struct sn_recalled {
    const sn_moment *moment;
    const sn_exponentials *memory;
    size_t first, count; ///< in the store: first number, numbers of a block and branch
    size_t branches;     ///< in the store, the viscous part too
} sn_recalled;
/// kind: SN_STORE_CELL …
sn_recalled sn_recall(const sn_net *net, const sn_net_region *region, const sn_moment *moment,
                      int kind);
/// The instantaneous stress for k = 0, else that of branch k - 1, of number i of a block. There are
/// none where `branches` is 0.
static inline double sn_recalled_at(const sn_recalled *r, size_t block, size_t k, size_t i) {
    return sn_real_at(r->moment->precision, r->moment->store,
                      r->first + (block * (1 + r->branches) + k) * r->count + i);
}

//---- equilibrium ---------------------------------------------------------------------------------

typedef struct sn_tangent sn_tangent;
sn_status sn_tangent_create(const sn_net *net, sn_tangent **tangent);
void sn_tangent_destroy(sn_tangent *tangent); // NULL is allowed
/// Where the tangent is wanted.
typedef struct sn_tangent_call {
    const double *u;           ///< quads
    const sn_factors *factors; ///< Nullable: the instantaneous law
    const double *history;     ///< with factors
    const double *pressure;    ///< at volume points, as the force call left it
    const sn_parts *parts;     ///< Nullable
} sn_tangent_call;
/// Assembles -d(internal force)/du.
void sn_tangent_assemble(const sn_net *net, sn_tangent *tangent, const sn_tangent_call *call);
/// Adds a 3 x 3 block at a node (contact).
void sn_tangent_add(sn_tangent *tangent, int node, const double block[9]);
/// A sn_tangent_sink that adds a block, which friction may make unsymmetric, to the tangent
/// `context`.
void sn_tangent_add_contact(void *context, int node, const double block[9]);
/// Adds factor times the mass of each node.
void sn_tangent_add_mass(const sn_net *net, sn_tangent *tangent, double factor);
/// Takes factor sum b b^T off every product from now on; the vectors b stay the caller's.
/// count 0: nothing.                                          (count x nodes x 3)
void sn_tangent_lower(sn_tangent *tangent, int count, const double *vectors, double factor);
/// The vectors of sn_tangent_lower() stand for as many of every piece of the body: sum by pieces.
/// piece: Nullable, of nodes, -1 of those that belong to none; the caller's.
void sn_tangent_lower_pieces(sn_tangent *tangent, const int *piece, int pieces);
/// Inverts the diagonal blocks, with prescribed directions held: after all has been added.
void sn_tangent_prepare(const sn_net *net, sn_tangent *tangent);
/// y <- K x, all directions. x, y: (nodes x 3).
void sn_tangent_multiply(const sn_net *net, sn_tangent *tangent, const double *x, double *y);
/// Solves K x = b in the free directions (b is 0 elsewhere) by conjugate gradients (BiCGSTAB where
/// K is unsymmetric) from the x given, until the residual is at most `target` in norm. x is 0 in
/// prescribed directions. @return iterations; negative where a direction of negative curvature or a
/// breakdown ended it.
int sn_tangent_solve(const sn_net *net, sn_tangent *tangent, const double *b, double target,
                     double *x);

//---- runs ----------------------------------------------------------------------------------------

/// Memory that a snapshot holds.
typedef struct sn_piece {
    void *data;
    size_t bytes;
} sn_piece;
#define SN_PIECES_MAX 64
#define SN_IMPLICIT_PIECES 9
uint64_t sn_net_fingerprint(const sn_case *c, const sn_net *net);
/// What of the implicit integrator later steps depend on; returns how many pieces. Calls
/// sn_implicit_forget().
int sn_implicit_pieces(const sn_net *net, sn_implicit *implicit, sn_piece *piece);
/// The next step builds its tangent anew, as after going on from bytes.
void sn_implicit_forget(sn_implicit *implicit);

#define SN_WALLS 65536 ///< wall times kept of a run
typedef struct sn_run {
    const sn_net *net;
    const sn_output *output;   ///< Nullable
    const sn_restart *restart; ///< Nullable
    sn_run_summary *summary;
    sn_record *history;
    sn_fields *fields;
    double *row;
    double started, told; ///< on the clock
    double *wall;         ///< of steps; a sample where there are more than SN_WALLS
    long wall_seen;
    double internal_work; ///< done on the tissue by its nodes so far, J
    double external_work; ///< J
    double released;      ///< by cuts so far, J
    double stored_start, kinetic_start;
} sn_run;
void sn_run_wall(sn_run *run, double seconds);
/// @return SN_OK; tells progress at most a few times a second.
void sn_run_progress(sn_run *run, double time);
/// Row and frame of a moment.
sn_status sn_run_record(sn_run *run, const sn_moment *moment);
/// Hands a frame out, without a row: the first thing that a run does that goes on from bytes.
sn_status sn_run_frame(sn_run *run, const sn_moment *moment);
static inline bool sn_run_goes_on(const sn_run *run) {
    return run->restart && run->restart->state;
}
/// After every output: saves the run, its state and `own`, what the integrator keeps beside them.
sn_status sn_run_save(sn_run *run, const sn_state *s, const sn_piece *own, int count);
/// Takes all that from run->restart->state. @return SN_OK, SN_E_DATA, SN_E_DEFINITION (another
/// case), SN_E_UNSUPPORTED (another version), SN_E_MEMORY.
sn_status sn_run_load(sn_run *run, sn_state *s, const sn_piece *own, int count);
/// Time of output k, or the end of the run; INFINITY after the end.
double sn_run_output_time(const sn_net *net, long k);
/// Fills the fields and the stored energies of the summary; returns elastic and memory, J.
double sn_run_store(sn_run *run, const sn_moment *moment);
/// Rows to be filled in sn_output.energy.
sn_status sn_run_energy_rows(sn_record *energy, int rows);
sn_status sn_run_motion(sn_run *run);
sn_status sn_run_quasi_static(sn_run *run);

//---- cuts ----------------------------------------------------------------------------------------

/// Arrays of what is left of a net, of a net where parts is NULL.
static inline const void *sn_parts_volume(const sn_net *net, const sn_parts *parts,
                                          sn_precision p) {
    return parts ? parts->volume[p] : net->data[p].volume;
}
static inline const void *sn_parts_stiffness(const sn_net *net, const sn_parts *parts,
                                             sn_precision p) {
    return parts ? parts->stiffness[p] : net->data[p].stiffness;
}
static inline const void *sn_parts_point_stiffness(const sn_net *net, const sn_parts *parts,
                                                   sn_precision p) {
    return parts ? parts->point_stiffness[p] : net->data[p].point_stiffness;
}
static inline const double *sn_parts_point_volume(const sn_net *net, const sn_parts *parts) {
    return parts ? parts->point_volume : net->point_volume;
}
static inline const double *sn_parts_spring_volume(const sn_net *net, const sn_parts *parts) {
    return parts ? parts->spring_volume : net->spring_volume;
}
/// What is left of the net of a state; NULL before the first cut.
const sn_parts *sn_state_parts(const sn_state *s);
/// What cuts need to know of a net, for cuttable ones. c: of the mesh in the net's order.
sn_status sn_cutting_create(const sn_case *c, sn_net *net);
void sn_cutting_destroy(sn_cutting *cutting); // NULL is allowed
/// Goes on with a hash by the cuts of the case.
uint64_t sn_cutting_mix(uint64_t hash, const sn_net *net);
/// Time of the first cut of the case after t; INFINITY without.
double sn_cutting_next(const sn_net *net, double t);
/// All that a state of a cuttable net can need for cuts.
sn_status sn_cut_create(const sn_net *net, sn_cut **cut);
void sn_cut_destroy(sn_cut *cut); // NULL is allowed
/// Nothing is cut.
void sn_cut_mend(const sn_net *net, sn_cut *cut);
/// What is left, from what was removed: after bytes were read, or for a state of another net.
void sn_cut_restore(const sn_net *net, sn_cut *cut);
/// What of cuts a snapshot holds; returns how many pieces.
int sn_cut_pieces(const sn_net *net, sn_cut *cut, sn_piece *piece);
#define SN_CUT_PIECES 2
/// The next cut of the case that is due at the state's time: its cells.
/// @return false where none is.
bool sn_state_due_cut(const sn_net *net, sn_state *s, int *count, const int **cells);
/// Removes cells in a run. run->released gets what was stored before; the caller takes off what is
/// stored afterwards. @return as sn_state_cut().
sn_status sn_run_cut(sn_run *run, sn_state *s, const sn_moment *before, int count,
                     const int *cells);
/// Pieces that hang together by cells: the piece of each node, -1 of loose ones (nodes). NULL where
/// nothing was cut.
const int *sn_state_pieces(const sn_state *s, int *count);
/// Whether what is left has a piece that no support or prescribed motion holds.
bool sn_state_has_free_piece(const sn_state *s);
/// Number of cells removed.
int sn_state_removed(const sn_state *s);
/// Adds half a kick by the present forces to v, but of nodes that tools hold.
void sn_state_half_kick(const sn_net *net, sn_state *s, double half);
/// All forces at the present place and time, explicit or implicit, with the memory as `factors`
/// move it on.
void sn_state_find_forces(const sn_net *net, sn_state *s);
/// The highest frequency at the present place, by a search from the vector in s->mode.
void sn_state_find_frequency(const sn_net *net, sn_state *s);
/// Velocity and spin of a rigid motion, and sums that they are found from.
typedef struct sn_rigid {
    double mass, centre[3], linear[3], spin[3], inertia[9];
} sn_rigid;
/// Room for the rigid motions of the pieces of a state; NULL where nothing was cut.
sn_rigid *sn_state_rigid(const sn_state *s);
