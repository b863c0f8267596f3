// Follows the highest frequency of a state while it steps.
// SPDX-License-Identifier: Apache-2.0
//
// A look is a few steps of Lanczos' method from the mode that was found last: three evaluations of
// the forces at one place, which together take as long as three steps. They are spread over 8 to 64
// steps, tasks of the evaluations in their order, so that no step takes much longer than others;
// the place is a copy, so that all that the look sees is one body, whatever happens meanwhile.
//
// A look is due after a number of steps, and when a node can have moved by a certain way; both
// adapt to how the frequency changes. The look begins at half of the way and is as fast as the way
// asks for. What it finds is as old as the look took, and serves until the next one ends: so the
// frequency is taken to grow twice by as much as it did since the last look. Tissue that has
// stiffened swings between softer and stiffer places: measured on an exponential law at 16 times
// its stiffness at rest, 0.9 of the limit blows up in the end and 0.77 does not, so stiffening
// shortens the step by up to another sixth.
//
// Where nodes move by more than a fiftieth of an edge in a step, stiffness changes within steps,
// and 0.9 of the limit is too long: up to twice the eigenvalue then rules the step. What rules it
// rises at once and falls slowly, because steps that change their length with the vibration feed
// it. (Blocks that strike a plane at 0.03 to 1 m/s, tests/springs/test_looks.c.)
//
// The copy of the place and the number of tasks done are all that bytes of a state hold of a look:
// what it had done by then is done again when they are read.
#include <math.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/steps.h"

enum { CHECK_FIRST = 64, CHECK_LEAST = 8, CHECK_MOST = 512 };        // steps from look to look
enum { SPREAD_LEAST = 8, SPREAD_MOST = 64 };                         // steps of a look
static const double way_first = 0.05, way_least = 1e-4;              // between looks, of an edge
static const double way_most = 1.0;                                  // in quiet
static const double wild_way = 0.02, wild_slope = 10, wild_most = 2; // in one step
static const double fall = 1.0 / 64;                     // of what rules the step, in one step
static const double doubt_first = 2, doubt_least = 1.05; // after a cut
static const double touched_first = 0.1;                 // from a tool's first touch on

// a search that follows one mode is blind to pieces apart from it: a cut body is looked at harder
static int steps_of(const sn_state *s) {
    return sn_state_parts(s) ? 2 * SN_LANCZOS_WARM : SN_LANCZOS_WARM;
}

static sn_frequency_call frequency_call(sn_state *s, const void *u, int steps, bool upright) {
    return (sn_frequency_call){.precision = s->precision,
                               .u = u,
                               .trial = s->probe_trial,
                               .mode = s->mode,
                               .basis = s->basis,
                               .steps = steps,
                               .scratch = &s->probe,
                               .team = s->team,
                               .parts = sn_state_parts(s),
                               .upright = upright || sn_state_is_upright(s)};
}

// the margin for tissue that has stiffened
static double margin(const sn_net *net, double omega2) {
    return 1.0 + 0.44 * fmin(1.0, fmax(0.0, 2.0 * (omega2 / net->omega2 - 1.0)));
}

static void take_frequency(const sn_net *net, sn_state *s, double omega2) {
    // what the pieces of a cut body were as one is the least that they are taken for
    if (sn_state_parts(s)) omega2 = fmax(omega2, net->omega2);
    if (sn_state_parts(s) && s->look.upright) omega2 += sn_state_upright_stiffness(net, s);
    if (isfinite(omega2) && omega2 > 0) {
        double growth = omega2 / s->seen_omega2;
        if (fabs(growth - 1.0) > 0.1) {
            s->check_every = s->check_every / 2 > CHECK_LEAST ? s->check_every / 2 : CHECK_LEAST;
            s->check_way = fmax(0.5 * s->check_way, way_least * net->edge);
        } else if (fabs(growth - 1.0) < 0.03) {
            s->check_every = s->check_every < CHECK_MOST ? 2 * s->check_every : CHECK_MOST;
            s->check_way = fmin(1.5 * s->check_way, way_most * net->edge);
        }
        growth = fmax(growth, 1.0);
        s->seen_omega2 = omega2;
        s->omega2 = omega2 * (s->look.upright ? growth : growth * growth) * margin(net, omega2);
        if (sn_net_has_fibres(net)) s->omega2 = fmax(s->omega2, net->omega2); // all of them taut
        s->doubt = s->doubt > doubt_least ? 0.5 * (1 + s->doubt) : 1.0;
        s->omega2 *= s->doubt;
    }
    s->check_in = s->check_every;
    s->moved = 0;
}

// the next tasks of the look; ends with the look at the latest
static void go_on(const sn_net *net, sn_state *s, int tasks) {
    sn_look *look = &s->look;
    const int all = sn_net_force_tasks(net);
    const sn_frequency_call call = frequency_call(s, look->u, steps_of(s), look->upright);
    while (tasks > 0) {
        const sn_force_call force = {.precision = s->precision,
                                     .mode = SN_MEMORY_OFF,
                                     .u = look->done < all ? look->u : s->probe_trial,
                                     .parts = sn_state_parts(s),
                                     .upright = look->upright || sn_state_is_upright(s),
                                     .out = &s->probe,
                                     .team = s->team};
        const int first = look->done % all, count = tasks < all - first ? tasks : all - first;
        sn_net_forces_part(net, &force, first, count);
        look->done += count;
        tasks -= count;
        if (first + count < all) return;
        const bool more = look->done == all ? sn_lanczos_begin(net, &call, &look->lanczos)
                                            : sn_lanczos_go_on(net, &call, &look->lanczos);
        if (more) continue;
        const bool found = look->lanczos.steps > 0;
        look->done = 0;
        take_frequency(net, s, found ? sn_lanczos_end(net, &call, &look->lanczos) : 0.0);
        return;
    }
}

static void begin(const sn_net *net, sn_state *s) {
    const size_t size = s->precision == SN_SINGLE ? sizeof(float) : sizeof(double);
    sn_state_look_at_cells(net, s);
    memcpy(s->look.u, s->u, 4 * (size_t)net->nodes * size);
    s->look.upright = s->crushed;
}

// what the step is chosen for, after one in which a node moved by `way` at most
static void rule(const sn_net *net, sn_state *s, double way) {
    const double over = fmax(0.0, way / net->edge - wild_way);
    const double wanted = s->omega2 * fmin(wild_most, 1 + wild_slope * over);
    const bool plain = s->crushed && !sn_state_parts(s);
    s->ruling_omega2 = plain ? s->omega2 : fmax(wanted, (1 - fall) * s->ruling_omega2);
}

static void go_looking(const sn_net *net, sn_state *s, double way) {
    const double far = s->check_way;
    const int spread = s->check_every > SPREAD_MOST ? SPREAD_MOST : s->check_every;
    s->moved += way;
    s->check_in--;
    if (s->look.done == 0) {
        const int since = s->check_every - s->check_in;
        if (s->crushed ? s->check_in > 0 && (s->moved <= far || since < CHECK_LEAST)
                       : s->check_in > spread && s->moved < 0.5 * far)
            return;
        begin(net, s);
    }
    // where cells are crushed a look is taken at once: that state is short, and changes fast
    const double part =
        s->look.upright ? 1.0 : fmin(fmax(1.0 / spread, 2 * way / far), 1.0 / SPREAD_LEAST);
    go_on(net, s, (int)ceil(part * (1 + steps_of(s)) * sn_net_force_tasks(net)));
}

void sn_state_follow_frequency(const sn_net *net, sn_state *s, double way) {
    go_looking(net, s, way);
    rule(net, s, way);
}

void sn_state_look_closer(const sn_net *net, sn_state *s) {
    s->check_way = fmin(s->check_way, touched_first * net->edge);
}

void sn_state_forget_look(sn_state *s) {
    s->look.done = 0;
}

void sn_state_redo_look(const sn_net *net, sn_state *s) {
    const int done = s->look.done;
    s->look.done = 0;
    go_on(net, s, done);
}

void sn_state_rest_frequency(const sn_net *net, sn_state *s) {
    sn_state_forget_look(s);
    s->ruling_omega2 = s->omega2 = s->seen_omega2 = net->omega2;
    s->doubt = 1;
    s->check_way = way_first * net->edge;
    if (net->mode) memcpy(s->mode, net->mode, (size_t)net->nodes * 3 * sizeof *s->mode);
    s->check_every = s->check_in = CHECK_FIRST;
    s->moved = 0;
}

void sn_state_find_frequency(const sn_net *net, sn_state *s) {
    sn_state_forget_look(s);
    const sn_frequency_call call = frequency_call(s, s->u, SN_LANCZOS_MAX, s->crushed);
    double omega2 = fmax(sn_net_frequency(net, &call), sn_net_frequency(net, &call));
    s->seen_omega2 = isfinite(omega2) && omega2 > 0 ? omega2 : net->omega2;
    s->omega2 = fmax(s->seen_omega2 * margin(net, s->seen_omega2), net->omega2);
    s->ruling_omega2 = s->omega2;
    s->doubt = 1;
    s->check_in = s->check_every = CHECK_LEAST;
    s->moved = 0;
}

void sn_state_finish_look(const sn_net *net, sn_state *s) {
    const int all = (1 + steps_of(s)) * sn_net_force_tasks(net);
    if (s->look.done > 0 && s->doubt > 1) go_on(net, s, all - s->look.done);
}

// A cut softens; but means over fewer cells, with the masses that were, swing faster there: at most
// 1.8 times the eigenvalue of the look before, in 1100 cuts at random through blocks of all rungs.
void sn_state_doubt_frequency(const sn_net *net, sn_state *s) {
    sn_state_forget_look(s);
    const double least = fmax(s->seen_omega2 * margin(net, s->seen_omega2), net->omega2);
    s->doubt = doubt_first;
    s->omega2 = fmax(fmax(s->omega2, s->ruling_omega2), doubt_first * least);
    s->ruling_omega2 = s->omega2;
    s->check_every = CHECK_LEAST;
    s->check_in = 0;
}
