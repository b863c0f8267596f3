// Motion that must stay what it is: turned and thrown bodies, energies over long runs, the ledger.
// SPDX-License-Identifier: Apache-2.0
#include "nets.h"
#include "springs/steps.h"

// Turned by half a radian at once: no force, with memory and damping by stiffness, on both rungs.
static void rotation_gives_no_force(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        t.memory = prony(0.4, 0.05, 0.3, 0.5);
        sn_case *c = make_block((const double[]){0.04, 0.02, 0.02}, (const int[]){4, 2, 2},
                                SN_PATTERN_BCC, &t);
        c->springs.rung = k ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.stiffness_damping = 1e-3;
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        double turn[9], most[2] = {0};
        sn_rotation((const double[]){0.3, -0.4, 0.2}, turn);
        for (int stretch = 0; stretch < 2; stretch++) { // the second must give force
            for (int i = 0; i < net->nodes; i++)
                for (int d = 0; d < 3; d++) {
                    const double *x = net->node_position + 3 * i;
                    double y = turn[3 * d] * x[0] + turn[3 * d + 1] * x[1] + turn[3 * d + 2] * x[2];
                    ((double *)s->u)[4 * i + d] = y * (1 + 1e-3 * stretch) - x[d];
                }
            most[stretch] = advance(net, s, 1e-4);
        }
        // rounding of strains, 1e-16, times 11 (the viscous part over a step) against 1e-3
        CHECK_ABS(most[0] / most[1], 0, 1e-11);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A thrown body, damped in both ways, keeps its momentum and falls as told.
static void damping_takes_no_momentum(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block((const double[]){0.04, 0.02, 0.02}, (const int[]){4, 2, 2},
                                SN_PATTERN_MIRRORED, &t);
        c->springs.rung = k % 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.integrator = k < 2 ? SN_INTEGRATOR_EXPLICIT : SN_INTEGRATOR_IMPLICIT;
        c->springs.damping = 50;
        c->springs.stiffness_damping = 1e-4;
        c->springs.step = k < 2 ? 0 : 1e-3;
        c->gravity[2] = -9.81;
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        uint64_t seed = 4;
        double before[6] = {0}, after[6] = {0}, motion[2] = {0}, mass = 0, weight = 0;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++)
                ((double *)s->v)[4 * i + d] = check_random(&seed, -0.1, 0.1);
        for (int n = 0; n < 2; n++) {
            double *sum = n ? after : before;
            for (int q = 0; n > 0 && q < 200; q++) sn_state_step(net, s, 1e-3);
            for (int i = 0; i < net->nodes; i++)
                for (int d = 0; d < 3; d++) {
                    const double *u = s->u, *v = s->v, *x = net->node_position;
                    int e = (d + 1) % 3, g = (d + 2) % 3;
                    double m = net->mass[i];
                    sum[d] += m * v[4 * i + d];
                    sum[3 + d] += m * ((x[3 * i + e] + u[4 * i + e]) * v[4 * i + g] -
                                       (x[3 * i + g] + u[4 * i + g]) * v[4 * i + e]);
                    if (n == 0) mass += m / 3;
                }
            for (int i = 0; i < net->nodes; i++)
                for (int d = 0; d < 3; d++) {
                    double way = ((double *)s->v)[4 * i + d] - sum[d] / mass;
                    motion[n] += 0.5 * net->mass[i] * way * way;
                }
        }
        // explicit velocities are half a step old
        weight = mass * -9.81 * (s->time - (k < 2 ? 0.5 * s->last_step : 0));
        for (int d = 0; d < 3; d++) // 1e3 roundings; Newton to 1e-8 of the weight
            CHECK_ABS((after[d] - before[d] - (d == 2) * weight) / (mass * 0.1), 0,
                      k < 2 ? 1e-11 : 1e-6);
        assert_true(motion[1] < 0.3 * motion[0]); // all but the spin is damped
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// kinetic and elastic energy of a free state without memory
static double energy_of(const sn_net *net, const sn_state *s) {
    const double *v = s->v, *f = s->now.f;
    double sum = 0, behind = s->implicit ? 0.0 : 0.5 * s->last_step;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            double w = v[4 * i + d] + behind * f[4 * i + d] / net->mass[i];
            if (net->fixed_bits[i] >> d & 1) w = 0;
            sum += 0.5 * net->mass[i] * w * w;
        }
    return sum + elastic_energy(net, s);
}

// A million steps of a free, ringing cube: the energy swings and does not drift.
static void a_million_steps(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 5e3);
    sn_case *c = make_block((const double[]){0.01, 0.01, 0.01}, (const int[]){1, 1, 1},
                            SN_PATTERN_MIRRORED, &t);
    c->springs.rung = SN_RUNG_CENTRAL;
    c->springs.volume = false;
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    uint64_t seed = 5;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) ((double *)s->v)[4 * i + d] = check_random(&seed, -0.2, 0.2);
    double mean[10] = {0}, swing = 0, start = energy_of(net, s);
    for (int n = 0; n < 1000000; n++) {
        sn_state_step(net, s, 0.4 * net->step);
        if (n % 100) continue;
        double off = energy_of(net, s) / start - 1;
        mean[n / 100000] += off / 1000;
        swing = fmax(swing, fabs(off));
    }
    // (omega h)^2 / 8 of what swings fastest, omega h = 0.72, whenever and for however long
    CHECK_ABS(swing, 0, 0.065);
    assert_true(swing > 1e-4);
    // means over a tenth of the time change as the energy spreads to what swings fast
    for (int k = 1; k < 10; k++) CHECK_ABS(mean[k] - mean[0], 0, 0.02);
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

// A hundred times the explicit limit, from a wild start: energy only falls, to rest under gravity.
static void implicit_bears_long_steps(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block((const double[]){0.04, 0.02, 0.02}, (const int[]){4, 2, 2},
                                SN_PATTERN_MIRRORED, &t);
        sn_net *net;
        sn_state *s;
        c->springs.rung = k % 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        add_support(c, "left", "xyz");
        CHECK_OK(sn_net_create(c, &net));
        c->springs.step = 100 / SN_STEP_SAFETY * net->step;
        sn_net_destroy(net);
        c->springs.integrator = SN_INTEGRATOR_IMPLICIT;
        c->springs.scheme = k < 2 ? SN_SCHEME_BDF2 : SN_SCHEME_BACKWARD_EULER;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        uint64_t seed = 6;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++)
                if (!(net->fixed_bits[i] >> d & 1))
                    ((double *)s->v)[4 * i + d] = check_random(&seed, -0.01, 0.01);
        double start = energy_of(net, s), now = start;
        for (int n = 0; n < 60; n++) {
            sn_step_info info = sn_state_step(net, s, 1);
            CHECK_REL(info.step, c->springs.step, 1e-12);
            now = energy_of(net, s);
            assert_true(now < 1.01 * start);
        }
        assert_true(now < 0.1 * start);
        assert_int_equal(s->warnings, 0);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

//---- the ledger ----------------------------------------------------------------------------------

// Linear springs in cycles: what is stored in the branches is sum H^2 / (2 g k), and what is lost
// never falls.
static void ledger_of_cycles(void **state) {
    (void)state;
    const double time[] = {0, 0.1, 0.3, 0.4, 0.5, 0.7, 0.8, 1.0};
    const double value[] = {0, 1, 1, -0.5, 1, 0, 0.3, 0};
    for (int k = 0; k < 3; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        t.memory = prony(0.4, 0.05, 0.3, 0.5);
        sn_case *c = make_block((const double[]){0.02, 0.01, 0.01}, (const int[]){2, 1, 1},
                                SN_PATTERN_MIRRORED, &t);
        c->springs.rung = k == 1 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.volume = k != 2;
        c->springs.integrator = k == 0 ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_QUASI_STATIC;
        c->springs.step = 1e-3;
        c->output_every = 0.01;
        add_support(c, "left", "xyz");
        sn_load *l = add_load(c, SN_LOAD_DISPLACEMENT, "right", 1e-5, 0, 0, 0);
        CHECK_OK(sn_history_create(1, 8, time, value, &l->factor));
        sn_record *energy, *r;
        sn_run_summary summary;
        CHECK_OK(sn_record_create("energy", &energy));
        CHECK_OK(sn_record_create("run", &r));
        CHECK_OK(sn_springs_run(c, &(sn_output){.energy = energy}, &summary, r));
        const double *lost = sn_record_values(energy, "dissipated_energy");
        const double *held = sn_record_values(energy, "memory_energy");
        const double *left = sn_record_values(energy, "energy_residual");
        const double *elastic = sn_record_values(energy, "elastic_energy");
        const double end = lost[energy->rows - 1];
        assert_int_equal(energy->rows, 101);
        double most = 0, most_held = 0;
        for (int n = 1; n < energy->rows; n++) {
            assert_true(lost[n] > lost[n - 1] - 1e-5 * end); // trapezoidal rule of the work
            assert_true(held[n] >= 0);
            most = fmax(most, elastic[n]);
            most_held = fmax(most_held, held[n]);
            // equilibrium leaves nothing by construction; BDF2 damps what rings, at omega h of 0.3
            if (k == 0) CHECK_ABS(left[n] / end, 0, 0.02);
        }
        // after the first ramp, 0.1 s: E/2 (u/L)^2 A L times sum g (tau/T (1 - exp(-T/tau)))^2
        double part[2] = {0.05 / 0.1 * (1 - exp(-2)), 0.5 / 0.1 * (1 - exp(-0.2))};
        double expected = (0.4 * part[0] * part[0] + 0.3 * part[1] * part[1]) / 0.3;
        CHECK_REL(held[10] / elastic[10], expected, 5e-3); // clamped: strains change as it relaxes
        assert_true(end > 0.5 * most && most_held > 0.5 * most);
        CHECK_REL(summary.dissipated_J, end, 1e-12);
        sn_record_destroy(energy);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotation_gives_no_force), cmocka_unit_test(damping_takes_no_momentum),
        cmocka_unit_test(a_million_steps),         cmocka_unit_test(implicit_bears_long_steps),
        cmocka_unit_test(ledger_of_cycles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
