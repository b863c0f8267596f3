// The inside of a state, and what a program imposes on it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/forces.h"

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

//---- what is imposed while it runs ---------------------------------------------------------------

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
