// How a state goes on: the highest frequency, the two integrators.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/state.h"

//---- the highest frequency -----------------------------------------------------------------------

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
/// What that stress adds to the highest eigenvalue at most, of one cell, 1/s2: a look at a place
/// where it does not act just then cannot see it.
double sn_state_upright_stiffness(const sn_net *net, const sn_state *s);

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
static inline double sn_net_step_safety(const sn_net *net) {
    return sn_net_has_fibres(net) ? SN_STEP_SAFETY_FIBRES : SN_STEP_SAFETY;
}

/// The highest frequency at the present place, by a search from the vector in s->mode.
void sn_state_find_frequency(const sn_net *net, sn_state *s);

//---- either integrator ---------------------------------------------------------------------------

/// Back to rest, but for what is prescribed at the state's time.
void sn_state_rest(const sn_net *net, sn_state *s);
/// Adds half a kick by the present forces to v, but of nodes that tools hold.
void sn_state_half_kick(const sn_net *net, sn_state *s, double half);
/// All forces at the present place and time, explicit or implicit, with the memory as `factors`
/// move it on.
void sn_state_find_forces(const sn_net *net, sn_state *s);

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
/// Smallest volume ratio of any cell; NAN where one is not finite. u: quads.
double sn_net_smallest_ratio(const sn_net *net, const sn_parts *parts, const double *u);

#define SN_IMPLICIT_PIECES 9
/// What of the implicit integrator later steps depend on; returns how many pieces. Calls
/// sn_implicit_forget().
int sn_implicit_pieces(const sn_net *net, sn_implicit *implicit, sn_piece *piece);
/// The next step builds its tangent anew, as after going on from bytes.
void sn_implicit_forget(sn_implicit *implicit);
