// What cuts leave of a net.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/net.h"

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
/// Pieces that hang together by cells: the piece of each node, -1 of loose ones (nodes). NULL where
/// nothing was cut.
const int *sn_state_pieces(const sn_state *s, int *count);
/// Whether what is left has a piece that no support or prescribed motion holds.
bool sn_state_has_free_piece(const sn_state *s);
/// Number of cells removed.
int sn_state_removed(const sn_state *s);
/// Velocity and spin of a rigid motion, and sums that they are found from.
typedef struct sn_rigid {
    double mass, centre[3], linear[3], spin[3], inertia[9];
} sn_rigid;
/// Room for the rigid motions of the pieces of a state; NULL where nothing was cut.
sn_rigid *sn_state_rigid(const sn_state *s);
