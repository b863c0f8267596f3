// The explicit integrator: conservation, waves, the limit of the step, damping, contact, one result
// for all instruction sets.
// SPDX-License-Identifier: Apache-2.0
#include "base/isa.h"
#include "nets.h"
#include "springs/steps.h"

static const double size[3] = {0.04, 0.02, 0.02};
static const int cells[3] = {4, 2, 2};

static void kick(const sn_net *net, sn_state *s, double speed, uint64_t seed) {
    (void)net;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            ((double *)s->v)[4 * i + d] = speed * check_random(&seed, -1, 1);
}

typedef struct motion {
    double momentum[3], spin[3], kinetic, elastic;
} motion;

static motion measure(const sn_net *net, const sn_state *s) {
    motion m = {0};
    const double *u = s->u, *v = s->v, *f = s->now.f;
    for (int i = 0; i < net->nodes; i++) {
        for (int d = 0; d < 3; d++) {
            int e = (d + 1) % 3, g = (d + 2) % 3;
            double mass = net->mass[i];
            double xe = net->node_position[3 * i + e] + u[4 * i + e];
            double xg = net->node_position[3 * i + g] + u[4 * i + g];
            double w = v[4 * i + d] + 0.5 * s->last_step * f[4 * i + d] / mass;
            m.momentum[d] += mass * v[4 * i + d];
            m.spin[d] += mass * (xe * v[4 * i + g] - xg * v[4 * i + e]);
            m.kinetic += 0.5 * mass * w * w;
        }
    }
    m.elastic = elastic_energy(net, s);
    return m;
}

// A free body thrown with random velocities: momentum and spin stay, energy stays near.
static void free_body_conserves(void **state) {
    (void)state;
    for (int k = 0; k < 5; k++) {
        sn_tissue t = k < 2 ? neo_hookean(3e3, 2e4) : demiray(2e3, 4, 2e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.rung = k == 4 ? SN_RUNG_SMOOTHED : k % 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.volume = k > 0;
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        kick(net, s, 0.3, 5);
        sn_state_step(net, s, 1);
        motion first = measure(net, s), now;
        double total = first.kinetic + first.elastic, drift[2] = {0};
        for (int n = 0; n < 3000; n++) {
            sn_state_step(net, s, 0.5 * net->step);
            if (n % 10) continue;
            now = measure(net, s);
            double *most = &drift[n >= 1500];
            *most = fmax(*most, fabs(now.kinetic + now.elastic - total) / total);
        }
        double scale = net->mass[0] * net->nodes * 0.3;
        for (int d = 0; d < 3; d++) {
            CHECK_ABS((now.momentum[d] - first.momentum[d]) / scale, 0, 1e-12); // 3000 roundings
            CHECK_ABS((now.spin[d] - first.spin[d]) / (scale * size[0]), 0, 1e-12);
        }
        // symplectic: the error is an oscillation of (h omega)^2/8 of what swings fast, here with
        // h omega = 0.9: 0.1, and it does not grow; energies of strain did mix with those of motion
        CHECK_ABS(drift[0], 0, 0.1);
        assert_true(drift[1] < 1.3 * drift[0]);
        assert_true(now.elastic > 0.1 * total);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A bar held sideways, struck along its axis: the first frequency is c/(4 L) with c^2 = (K + 4/3
// mu)/rho when no point can move sideways, by the order of the mesh.
static double bar_period(int n) {
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block((const double[]){0.1, 0.02, 0.02}, (const int[]){n, 2, 2},
                            SN_PATTERN_MIRRORED, &t);
    c->springs.volume = false;
    const char *sides[] = {"front", "back", "bottom", "top"};
    add_support(c, "left", "xyz");
    for (int k = 0; k < 4; k++) add_support(c, sides[k], k < 2 ? "y" : "z");
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    // in the shape of the mode, small: 1e-4 of strain
    for (int i = 0; i < net->nodes; i++)
        ((double *)s->u)[4 * i] = 1e-5 * sin(acos(-1) / 2 * net->node_position[3 * i] / 0.1);
    int tip = 0;
    for (int i = 0; i < net->nodes; i++)
        if (net->node_position[3 * i] > 0.0999) tip = i;
    double crossed[3] = {0}, before = 1e-5, since = 0;
    // one step makes the forces belong to this place: half of a kick less
    for (int k = 0; k < 3;) {
        sn_state_step(net, s, 0.3 * net->step);
        double now = ((double *)s->u)[4 * tip];
        if (now * before < 0) crossed[k++] = since + (s->time - since) * before / (before - now);
        before = now;
        since = s->time;
    }
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return crossed[2] - crossed[0];
}

static void bar_rings_at_its_frequency(void **state) {
    (void)state;
    double speed = sqrt((2e4 + 4.0 / 3.0 * 3e3) / 1000), exact = 4 * 0.1 / speed;
    double coarse = fabs(bar_period(4) / exact - 1), fine = fabs(bar_period(16) / exact - 1);
    CHECK_ABS(fine, 0, 1e-3); // (pi/2 / 16)^2 / 24 by lumped linear elements, twice that across
    // second order: 16 times less, within what the cells' changing shape and the reading leave
    CHECK_REL(coarse / fine, 16, 0.25);
}

// The true highest frequency at rest.
static double highest_frequency(const sn_net *net) {
    double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
    const double value = highest_eigenvalue(net, u, 4000);
    sn_free(u);
    return sqrt(value);
}

// largest displacement after many steps of a fixed length, from a small random push
static double after_steps(const sn_net *net, double step, int count) {
    sn_state *s;
    CHECK_OK(sn_state_create(net, &s));
    sn_net *loose = (sn_net *)(uintptr_t)net; // the engine's own limit must not interfere
    double omega2 = net->omega2;
    kick(net, s, 1e-6, 9);
    loose->omega2 = 1e-3;
    s->omega2 = 1e-3;
    for (int n = 0; n < count && !s->broken; n++) {
        s->check_in = 1000;
        s->moved = 0;
        s->ruling_omega2 = 1e-3;
        sn_state_step(net, s, step);
    }
    double most = s->broken ? INFINITY : 0;
    for (int k = 0; k < 4 * net->nodes; k++) most = fmax(most, fabs(((double *)s->u)[k]));
    loose->omega2 = omega2;
    sn_state_destroy(s);
    return most;
}

static void step_is_near_the_limit(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        sn_tissue t = k != 3 ? neo_hookean(3e3, 2e4) : demiray(2e3, 4, 2e6);
        sn_case *c = make_block(size, cells, k == 1 ? SN_PATTERN_BCC : SN_PATTERN_MIRRORED, &t);
        c->springs.rung = k < 2 ? SN_RUNG_CENTRAL : k < 4 ? SN_RUNG_COUPLED : SN_RUNG_SMOOTHED;
        c->springs.volume = k != 2 && k != 4;
        add_support(c, "left", "xyz");
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        double limit = 2 / highest_frequency(net);
        CHECK_REL(net->step, SN_STEP_SAFETY * limit,
                  0.02); // the search settles to 2e-3 in omega^2 a restart
        assert_true(after_steps(net, net->step, 3000) < 1e-4);
        assert_false(after_steps(net, 1.1 * limit, 3000) < 1e-4);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// An exponential tissue is stretched until it is many times stiffer: the step must follow.
static void step_follows_stiffening(void **state) {
    (void)state;
    sn_tissue t = demiray(2e3, 20, 2e4);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    add_support(c, "left", "xyz");
    add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.4 * size[0], 0, 0, 0.5);
    c->until = 0.6;
    sn_run_summary s;
    sn_record *r = run_case(c, &s);
    if (!s.converged) print_message("%s\n", s.reason);
    assert_true(s.converged);
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    assert_true(s.step_s < 0.6 * net->step);
    // energy in, energy stored: 1 % is what steps near the limit of stability leave
    CHECK_ABS(s.energy_residual, 0, 0.01);
    sn_net_destroy(net);
    sn_record_destroy(r);
    sn_case_destroy(c);
}

// Gravity on a free body: it falls as told, damped or not, spinning or not.
static void damping_spares_rigid_motion(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    c->gravity[2] = -9.81;
    c->springs.damping = 200;
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    const double h = net->step;
    const int n = 400;
    for (int k = 0; k < n; k++) sn_state_step(net, s, h);
    // symplectic Euler with the half kick at the start: exact for constant acceleration
    for (int i = 0; i < net->nodes; i++)
        CHECK_REL(((double *)s->u)[4 * i + 2], -0.5 * 9.81 * s->time * s->time, 1e-10);
    sn_state_destroy(s);

    net->gravity[2] = 0;
    memset(net->data[SN_DOUBLE].weight, 0, (size_t)net->nodes * 4 * sizeof(double));
    CHECK_OK(sn_state_create(net, &s));
    kick(net, s, 0.05, 4);
    for (int i = 0; i < net->nodes; i++) { // and a spin about z
        ((double *)s->v)[4 * i] += -2 * net->node_position[3 * i + 1];
        ((double *)s->v)[4 * i + 1] += 2 * net->node_position[3 * i];
    }
    sn_state_step(net, s, h);
    motion first = measure(net, s);
    for (int k = 0; k < 4 * n; k++) sn_state_step(net, s, h);
    motion last = measure(net, s);
    double scale = net->mass[0] * net->nodes * 0.1;
    for (int d = 0; d < 3; d++) {
        CHECK_ABS((last.momentum[d] - first.momentum[d]) / scale, 0, 1e-12);
        CHECK_ABS((last.spin[d] - first.spin[d]) / (scale * size[0]), 0, 1e-11);
    }
    assert_true(last.kinetic < 0.9 * first.kinetic); // the vibration is gone
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

static uint64_t hash_bytes(uint64_t h, const void *from, size_t bytes) {
    for (size_t k = 0; k < bytes; k++)
        h = (h ^ ((const unsigned char *)from)[k]) * 1099511628211ull;
    return h;
}

static void result_is_one_for_all_instruction_sets(void **state) {
    (void)state;
    for (int k = 0; k < 12; k++) {
        sn_tissue t = demiray(2e3, 6, 4e4);
        t.memory = prony(0.3, 0.01, 0.2, 0.2);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.rung = k >= 8 ? SN_RUNG_SMOOTHED : k / 2 % 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.volume = k >= 8 ? k / 2 % 2 : k / 4;
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.2 * size[0], 0.002, 0, 0.02);
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        uint64_t first = 0;
        for (int isa = 0; isa < SN_ISA_COUNT; isa++) {
            if (!sn_isa_available(isa)) continue;
            sn_state *s;
            net->isa = isa;
            CHECK_OK(sn_state_create(net, &s));
            while (s->time < 0.02) sn_state_step(net, s, 1);
            size_t real = k % 2 ? sizeof(float) : sizeof(double);
            uint64_t h = hash_bytes(14695981039346656037ull, s->u, (size_t)net->nodes * 4 * real);
            h = hash_bytes(h, s->store, net->store_size * real);
            if (isa == 0) first = h;
            assert_true(h == first);
            sn_state_destroy(s);
        }
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A sphere pressed into a block: the block's reaction and the tool's force, against inertia at the
// end.
static void tool_force_balances(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block((const double[]){0.04, 0.04, 0.02}, (const int[]){6, 6, 3},
                                SN_PATTERN_MIRRORED, &t);
        c->springs.integrator = k == 0 ? SN_INTEGRATOR_QUASI_STATIC : SN_INTEGRATOR_EXPLICIT;
        c->springs.precision = k == 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.damping = 60;
        c->until = 1;
        add_support(c, "bottom", "xyz");
        add_probe(c, "floor", SN_PROBE_REACTION, "bottom", 0, 0, 0);
        add_tool(c, "probe", 0.01, (const double[]){0.0203, 0.0198, 0.0301},
                 (const double[]){0.001, 0, -0.004}, 0.5);
        c->tool[0].friction = 0.3;
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        if (!s.converged) print_message("%s\n", s.reason);
        assert_true(s.converged);
        double push = last_value(r, "probe_fz");
        assert_true(push > 0.01); // of the tissue on the tool: upwards
        // in equilibrium both are one; the explicit body still shakes a little
        CHECK_ABS((last_value(r, "floor_fz") - push) / push, 0, k == 0 ? 1e-9 : 0.02);
        CHECK_ABS((last_value(r, "floor_fx") - last_value(r, "probe_fx")) / push, 0,
                  k == 0 ? 1e-9 : 0.02);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// Slow explicit stretch with memory against the quasi-static run of the same case.
static void slow_motion_is_equilibrium(void **state) {
    (void)state;
    double pull[3];
    for (int k = 0; k < 3; k++) {
        sn_tissue t = demiray(2e3, 4, 4e4);
        t.memory = prony(0.3, 0.05, 0.2, 0.5);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.integrator = k == 0 ? SN_INTEGRATOR_QUASI_STATIC : SN_INTEGRATOR_EXPLICIT;
        c->springs.precision = k == 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.damping = 50;
        c->springs.memory_tolerance = 1e-6; // the same exponentials
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.1 * size[0], 0, 0, 1);
        add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        pull[k] = last_value(r, "pull_fx");
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    CHECK_REL(pull[1], pull[0],
              5e-3); // what is left of the start's jerk, and damping of the stretch
    CHECK_REL(pull[2], pull[1], 1e-3); // single against double
}

// Energy of an undamped run without memory, by each precision.
static void ledger_closes(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.rung = k == 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.precision = k == 1 ? SN_SINGLE : SN_DOUBLE;
        c->gravity[2] = -9.81;
        c->until = 0.3;
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.1 * size[0], 0, 0, 0.2);
        sn_load *l = add_load(c, SN_LOAD_PRESSURE, "top", 0, 0, 0, 0.1);
        l->pressure = 100;
        add_load(c, SN_LOAD_TRACTION, "front", 0, 50, 20, 0.1);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        assert_true(s.kinetic_J > 0 && s.elastic_J > 0 && s.dissipated_J == 0);
        CHECK_ABS(s.energy_residual, 0, 0.01); // (h omega)^2 of the modes that carry energy
        assert_true(s.step_wall_p50_s > 0 && s.step_wall_p50_s <= s.step_wall_p99_s &&
                    s.step_wall_p99_s <= s.step_wall_max_s);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(free_body_conserves),
                                       cmocka_unit_test(bar_rings_at_its_frequency),
                                       cmocka_unit_test(step_is_near_the_limit),
                                       cmocka_unit_test(step_follows_stiffening),
                                       cmocka_unit_test(damping_spares_rigid_motion),
                                       cmocka_unit_test(result_is_one_for_all_instruction_sets),
                                       cmocka_unit_test(tool_force_balances),
                                       cmocka_unit_test(slow_motion_is_equilibrium),
                                       cmocka_unit_test(ledger_closes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
