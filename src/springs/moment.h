// A moment of a run: fields, rows of the history, energies.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/net.h"

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
