// One body in motion: its case, net and state.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bodies.h"
#include "springs/state.h"

/// What a test needs of one state.
typedef struct body {
    sn_case *c;
    sn_net *net;
    sn_state *s;
} body;

/// The case is the body's from here on.
static inline body start(sn_case *c) {
    body b = {.c = c};
    CHECK_OK(sn_net_create(c, &b.net));
    CHECK_OK(sn_state_create(b.net, &b.s));
    return b;
}

static inline void end(body *b) {
    sn_state_destroy(b->s);
    sn_net_destroy(b->net);
    sn_case_destroy(b->c);
}

static inline void run_for(const body *b, double seconds) {
    for (double left = seconds; left > 1e-12;) left -= sn_state_step(b->net, b->s, left).step;
}

/// All that a program can read.
static inline void check_finite(const body *b) {
    sn_state_view view;
    sn_state_look(b->net, b->s, &view);
    for (int i = 0; i < b->net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            size_t at = (size_t)(view.stride * view.place[i] + d);
            assert_true(isfinite(sn_real_at(view.precision, view.displacement, at)));
            assert_true(isfinite(sn_real_at(view.precision, view.velocity, at)));
            assert_true(isfinite(sn_real_at(view.precision, view.force, at)));
        }
    for (int t = 0; t < b->net->tool_count; t++) {
        double force[3], torque[3];
        sn_state_tool_force(b->net, b->s, t, force);
        sn_state_tool_torque(b->net, b->s, t, torque);
        for (int d = 0; d < 3; d++) assert_true(isfinite(force[d]) && isfinite(torque[d]));
    }
}
