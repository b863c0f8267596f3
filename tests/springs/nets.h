// What tests ask of the inside of a net.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodies.h"
#include "springs/moment.h"
#include "springs/state.h"

static inline int node_at(const sn_net *net, double x, double y, double z) {
    for (int i = 0; i < net->nodes; i++) {
        const double *p = net->node_position + 3 * i;
        if (hypot(hypot(p[0] - x, p[1] - y), p[2] - z) < 1e-9) return i;
    }
    fail();
    return -1;
}

/// Moves the memory on by h to s->u, and finds the forces there, without loads.
/// @return the largest, N
static inline double advance(const sn_net *net, sn_state *s, double h) {
    double most = 0;
    sn_net_factors(net, h, s->factors);
    const sn_force_call call = {.precision = SN_DOUBLE,
                                .mode = SN_MEMORY_ADVANCE,
                                .u = s->u,
                                .factors = s->factors,
                                .store = s->store,
                                .out = &s->now};
    sn_net_forces(net, &call);
    for (int i = 0; i < 4 * net->nodes; i++) most = fmax(most, fabs(((double *)s->now.f)[i]));
    return most;
}

/// The tangent of the instantaneous law at u (quads), without pressure.
static inline sn_tangent *tangent_at(const sn_net *net, const double *u) {
    sn_tangent *t;
    CHECK_OK(sn_tangent_create(net, &t));
    double *zero = sn_alloc((size_t)net->point_blocks * SN_BLOCK + 1, sizeof *zero);
    sn_tangent_assemble(net, t, &(sn_tangent_call){.u = u, .pressure = zero});
    sn_free(zero);
    return t;
}

/// Highest eigenvalue of M^-1 K by many power iterations, independent of the engine's own search.
static inline double highest_eigenvalue(const sn_net *net, const double *u, int turns) {
    const size_t n = (size_t)net->nodes * 3;
    const double *inverse = net->data[SN_DOUBLE].inverse_mass;
    double *x = sn_alloc(n, sizeof *x), *y = sn_alloc(n, sizeof *y), value = 0;
    sn_tangent *t = tangent_at(net, u);
    uint64_t seed = 3;
    for (size_t k = 0; k < n; k++) x[k] = check_random(&seed, -1, 1);
    for (int turn = 0; turn < turns; turn++) {
        double norm = 0, along = 0, own = 0;
        sn_tangent_multiply(net, t, x, y);
        for (size_t k = 0; k < n; k++) {
            const double m = inverse[4 * (k / 3) + k % 3];
            along += x[k] * y[k];
            own += m > 0 ? x[k] * x[k] / m : 0;
            y[k] *= m;
            norm += y[k] * y[k];
        }
        value = along / own;
        for (size_t k = 0; k < n; k++) x[k] = y[k] / sqrt(norm);
    }
    sn_free(x);
    sn_free(y);
    sn_tangent_destroy(t);
    return value;
}

/// Energy of the instantaneous law, W + U, of a state in double precision.
static inline double elastic_energy(const sn_net *net, const sn_state *s) {
    sn_fields *fields;
    CHECK_OK(sn_fields_create(net, &fields));
    sn_fields_fill(net, fields,
                   &(sn_moment){.precision = SN_DOUBLE,
                                .u = s->u,
                                .v = s->v,
                                .store = s->store,
                                .pressure = s->now.pressure});
    const double energy = sn_fields_elastic(net, fields);
    sn_fields_destroy(fields);
    return energy;
}
