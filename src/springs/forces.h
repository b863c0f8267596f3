// Forces and tangent of a net at a place, and the memory that they go on with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/net.h"

//---- memory --------------------------------------------------------------------------------------

/// Factors of the recursion of one memory for one step.
typedef struct sn_recursion {
    double alpha;
    double decay[SN_BRANCHES_MAX], gain[SN_BRANCHES_MAX];
} sn_recursion;
/// Those of one region: of every part of the stress, the same where it has one memory.
typedef struct sn_factors {
    sn_recursion part[SN_PARTS];
} sn_factors;

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
    struct sn_tangent *tangent; ///< Nullable: gets the slopes of pressures, see
                                ///< sn_tangent_add_pressure()
} sn_load_call;
/// Adds a load to ext (nodes x 3).
void sn_net_add_load(const sn_net *net, int load, double factor, const sn_load_call *call,
                     double *ext);
/// Adds all loads, with their own factors times `part`.
void sn_net_loads(const sn_net *net, double t, double part, const sn_load_call *call, double *ext);
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

/// Modulus of the stress of crushed cells (SN_UPRIGHT) of a region, Pa.
double sn_region_upright(const sn_net_region *region);

//---- the tangent ---------------------------------------------------------------------------------

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
/// Adds the symmetric part of minus the slope of the forces of a pressure on a face with nodes at
/// x. Only at the rim of the surface is that not the whole: where the rim is held, or there is
/// none, a pressure has the energy -p V.
void sn_tangent_add_pressure(sn_tangent *tangent, const int node[3], double x[3][3],
                             double pressure);
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
