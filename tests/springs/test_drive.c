// What a program imposes on a running state and reads from it; nothing but arithmetic in a step.
// SPDX-License-Identifier: Apache-2.0
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "allocator.h"
#include "driven.h"

//---- loads and pushes ----------------------------------------------------------------------------

static void pushes_give_momentum(void **state) {
    (void)state;
    body b = start(soft_block());
    const double force[3] = {1e-3, -2e-3, 5e-4};
    CHECK_OK(sn_state_push(b.net, b.s, 7, (const double[]){9, 9, 9}));
    CHECK_OK(sn_state_push(b.net, b.s, 7, force)); // in its place
    CHECK_OK(sn_state_push(b.net, b.s, 9, force));
    CHECK_OK(sn_state_push(b.net, b.s, 9, (const double[]){0, 0, 0}));
    // the kick of the first step lasts half a step, and knows the force of the time before it
    sn_state_step(b.net, b.s, 1e-4);
    const double first = 0.5 * b.s->last_step;
    for (int n = 0; n < 500; n++) sn_state_step(b.net, b.s, 1e-4);
    for (int d = 0; d < 3; d++) {
        double momentum = 0;
        for (int i = 0; i < b.net->nodes; i++)
            momentum += b.net->mass[i] * ((double *)b.s->v)[4 * i + d];
        CHECK_REL(momentum, force[d] * (b.s->time - 0.5 * b.s->last_step - first), 1e-11);
    }
    CHECK_FAILS(sn_state_push(b.net, b.s, 7, (const double[]){0, (double)NAN, 0}), SN_E_RANGE,
                "node 7");
    assert_true(b.s->push[3 * b.net->node_place[7] + 1] == force[1]);
    end(&b);
}

// A factor that a program sets does what a case with that factor does.
static void set_loads_replace_tables(void **state) {
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        double u[2][3];
        for (int k = 0; k < 2; k++) {
            sn_case *c = soft_block();
            add_support(c, "left", "xyz");
            sn_load *hold = add_load(c, SN_LOAD_DISPLACEMENT, "left", 0, 0, 0, 0);
            hold->free[1] = hold->free[2] = true; // numbers of loads differ from those of forces
            const sn_load_kind kinds[] = {SN_LOAD_TRACTION, SN_LOAD_PRESSURE, SN_LOAD_DISPLACEMENT};
            sn_load *l = add_load(c, kinds[kind], "right", 200, 0, 0, 0.05);
            l->pressure = 300;
            if (kind == 2) l->vector[0] = 0.01;
            if (k == 0) l->factor->value[1] = kind == 2 ? 0.6 : l->factor->value[1];
            if (k == 0 && kind < 2) l->factor->value[0] = l->factor->value[1] = 0.6;
            body b = start(c);
            if (k == 1 && kind < 2) {
                // it acts from the next step's end on; set before the state begins
                CHECK_OK(sn_state_set_load(b.net, b.s, 1, 0.6));
                sn_state_step(b.net, b.s, 1e-9);
                b.s->last_step = 0;
            }
            for (int n = 0; n < 400; n++) {
                double t = b.s->time + 1e-4;
                if (k == 1 && kind == 2)
                    CHECK_OK(sn_state_set_load(b.net, b.s, 1, 0.6 * fmin(1, t / 0.05)));
                sn_state_step(b.net, b.s, 1e-4);
            }
            int tip = 0;
            for (int i = 0; i < b.net->nodes; i++)
                if (b.net->node_position[3 * i] > 0.039) tip = i;
            for (int d = 0; d < 3; d++) u[k][d] = ((double *)b.s->u)[4 * tip + d];
            CHECK_FAILS(sn_state_set_load(b.net, b.s, 1, (double)INFINITY), SN_E_RANGE, "load 1");
            end(&b);
        }
        assert_true(fabs(u[0][0]) > 1e-4);
        // prescribed: the same places; forces: one step of 1e-9 s more
        CHECK_REL(u[1][0], u[0][0], kind == 2 ? 1e-12 : 1e-4);
    }
}

// What is imposed on implicit steps brings the same rest as on explicit ones.
static void implicit_steps_obey_too(void **state) {
    (void)state;
    const sn_integrator integrators[] = {SN_INTEGRATOR_EXPLICIT, SN_INTEGRATOR_IMPLICIT};
    double u[2][3];
    for (int k = 0; k < 2; k++) {
        sn_case *c = soft_block();
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.002, 0, 0, 0.05)->free[1] = true;
        add_load(c, SN_LOAD_TRACTION, "top", 100, 0, 0, 0.05);
        c->springs.integrator = integrators[k];
        c->springs.stiffness_damping = 0.01;
        body b = start(c);
        CHECK_OK(sn_state_set_load(b.net, b.s, 0, 0.5));
        CHECK_OK(sn_state_set_load(b.net, b.s, 1, 0.3));
        int tip = 0; // where x and z are prescribed, y is not
        for (int i = 0; i < b.net->nodes; i++)
            if (b.net->node_position[3 * i] > 0.039 && b.net->node_position[3 * i + 2] < 1e-3)
                tip = b.net->node_name[i];
        CHECK_OK(sn_state_push(b.net, b.s, tip, (const double[]){0, 5e-3, 0}));
        run_for(&b, 2.0); // the slowest motion, some 60/s, goes by exp(-0.005 60^2 2)
        for (int d = 0; d < 3; d++) u[k][d] = ((double *)b.s->u)[4 * b.net->node_place[tip] + d];
        end(&b);
    }
    // half the motion of the right side; the push; by the tolerance of Newton's method, 1e-8 of the
    // forces
    assert_true(fabs(u[0][0] - 1e-3) < 1e-12 && u[0][1] > 1e-4);
    for (int d = 0; d < 3; d++) CHECK_ABS(u[1][d], u[0][d], 1e-6 * u[0][0]);
}

//---- reading -------------------------------------------------------------------------------------

static void views_and_torques(void **state) {
    (void)state;
    sn_case *c = soft_block();
    c->springs.precision = SN_SINGLE;
    add_support(c, "bottom", "xyz");
    add_tool(c, "probe", 0.004, (const double[]){0.018, 0.006, 0.0241},
             (const double[]){0, 0, -0.003}, 0.1);
    c->tool[0].kind = SN_TOOL_CAPSULE;
    c->tool[0].axis[1] = 0.008;
    c->tool[0].friction = 0.5;
    body b = start(c);
    run_for(&b, 0.1);
    sn_state_view view;
    sn_state_look(b.net, b.s, &view);
    assert_int_equal(view.precision, SN_SINGLE);
    double *x = malloc((size_t)b.net->nodes * 3 * sizeof *x), force[3], torque[3];
    sn_state_positions(b.net, b.s, x);
    for (int i = 0; i < b.net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const float *u = view.displacement;
            int row = view.place[i];
            assert_true(view.rest[3 * row + d] == c->mesh->node[3 * i + d]);
            assert_true(x[3 * i + d] == view.rest[3 * row + d] + (double)u[view.stride * row + d]);
        }
    // by the forces on nodes: no load acts but the tool
    double sum[3] = {0}, turn[3] = {0};
    for (int i = 0; i < b.net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            int e = (d + 1) % 3, g = (d + 2) % 3;
            double re = x[3 * b.net->node_name[i] + e] - b.s->tool_pose[0].centre[e];
            double rg = x[3 * b.net->node_name[i] + g] - b.s->tool_pose[0].centre[g];
            sum[d] -= b.s->ext[3 * i + d];
            turn[d] -= re * b.s->ext[3 * i + g] - rg * b.s->ext[3 * i + e];
        }
    sn_state_tool_force(b.net, b.s, 0, force);
    sn_state_tool_torque(b.net, b.s, 0, torque);
    assert_true(force[2] > 0.01 && fabs(torque[0]) > 1e-3 * force[2] * 0.004);
    for (int d = 0; d < 3; d++) {
        CHECK_ABS(force[d], sum[d], 1e-12 * force[2]);
        CHECK_ABS(torque[d], turn[d], 1e-12 * force[2] * 0.02);
    }
    free(x);
    end(&b);
}

//---- grasping ------------------------------------------------------------------------------------

static void held_nodes_follow_their_tool(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_case *c = soft_block();
        c->springs.precision = k ? SN_SINGLE : SN_DOUBLE;
        c->springs.damping = 200;
        add_support(c, "bottom", "xyz");
        add_tool(c, "jaw", 0.01, (const double[]){0.02, 0.01, 0.0301},
                 (const double[]){0, 0, -5e-4}, 0.01);
        body b = start(c);
        run_for(&b, 0.02);
        const int held = sn_state_grasp(b.net, b.s, 0, 0, NULL);
        assert_true(held >= 1 && held < 15);
        int mine[2] = {0, c->mesh->node_count - 1}; // one is on the support: not to be held
        assert_int_equal(sn_state_grasp(b.net, b.s, 0, 2, mine), held + 1);
        double before[3], at[3];
        const int node = b.s->gripped[0];
        for (int d = 0; d < 3; d++)
            before[d] = b.net->node_position[3 * node + d] +
                        sn_real_at(b.s->precision, b.s->u, 4 * (size_t)node + (size_t)d) -
                        (d == 2 ? 0.0301 - 5e-4 : c->tool[0].at[d]);
        // lifted by 2 mm and turned by 0.2 about z
        sn_pose pose = {.centre = {0.02, 0.01, 0.0301}};
        for (int n = 1; n <= 200; n++) {
            pose.centre[2] = 0.0301 - 5e-4 + 2e-3 * n / 200;
            sn_rotation((const double[]){0, 0, 0.2 * n / 200}, pose.turn);
            CHECK_OK(sn_state_set_tool(b.net, b.s, 0, &pose));
            run_for(&b, 1e-3);
        }
        run_for(&b, 0.3);
        for (int d = 0; d < 3; d++) {
            at[d] = pose.centre[d];
            for (int e = 0; e < 3; e++) at[d] += pose.turn[3 * d + e] * before[e];
            CHECK_ABS(b.net->node_position[3 * node + d] +
                          sn_real_at(b.s->precision, b.s->u, 4 * (size_t)node + (size_t)d),
                      at[d], k ? 1e-9 : 1e-15); // rounding of a millimetre
        }
        // at rest: what the tool is pulled by is what the support holds
        double force[3], foot[3] = {0};
        sn_state_tool_force(b.net, b.s, 0, force);
        for (int q = 0; q < b.net->fixed_count; q++)
            foot[b.net->fixed[q].direction] +=
                sn_real_at(b.s->precision, b.s->now.f,
                           4 * (size_t)b.net->fixed[q].node + (size_t)b.net->fixed[q].direction);
        assert_true(force[2] < -0.01);
        for (int d = 0; d < 3; d++) CHECK_ABS(force[d] + foot[d], 0, 1e-3 * fabs(force[2]));
        sn_state_release(b.net, b.s, 0);
        pose.centre[2] += 0.05;
        CHECK_OK(sn_state_set_tool(b.net, b.s, 0, &pose));
        run_for(&b, 0.5);
        sn_state_tool_force(b.net, b.s, 0, force);
        assert_true(force[2] == 0);
        assert_true(farthest(&b) < 2e-5); // 2 mm before, and 100 of the longest damping times
        end(&b);
    }
}

// The same in a run, with its ledger.
static void cases_grasp_and_release(void **state) {
    (void)state;
    sn_case *c = soft_block();
    add_support(c, "bottom", "xyz");
    add_probe(c, "top", SN_PROBE_POINT, "", 0.02, 0.01, 0.02);
    add_tool(c, "jaw", 0.01, (const double[]){0.02, 0.01, 0.03}, (const double[]){0, 0, 0}, 1);
    sn_history_destroy(c->tool[0].path);
    CHECK_OK(sn_history_create(3, 4, (const double[]){0, 0.02, 0.04, 0.1},
                               (const double[]){0, 0, 0, 0, 0, -5e-4, 0, 0, -5e-4, 0, 0, 2e-3},
                               &c->tool[0].path));
    c->tool[0].grasp[0] = 0.03;
    c->tool[0].grasp[1] = 0.125;
    c->springs.damping = 100;
    c->springs.step = 2.5e-4;
    c->until = 0.4;
    c->output_every = 0.01;
    sn_run_summary s;
    sn_record *r = run_case(c, &s);
    const double *uz = sn_record_values(r, "top_uz"), *fz = sn_record_values(r, "jaw_fz");
    assert_true(s.converged);
    assert_true(fz[2] > 0.001 && fz[12] < -0.01 && fz[14] == 0);
    CHECK_ABS(uz[12] - uz[3], 2.5e-3, 1e-9); // moved with the jaw
    assert_true(fabs(last_value(r, "top_uz")) < 1e-4);
    // of second order in the step: 0.051 at the stable one, a quarter of it
    assert_true(s.external_work_J > 0);
    CHECK_ABS(s.energy_residual, 0, 1.5 * 0.051 / 16);
    sn_record_destroy(r);
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    sn_net *net;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED, "grasp needs integrator explicit");
    sn_case_destroy(c);
}

//---- another net ---------------------------------------------------------------------------------

static double hang(const body *b) {
    run_for(b, 1.0);
    return farthest(b);
}

static void constants_change_at_run_time(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        body b[2];
        for (int n = 0; n < 2; n++) {
            sn_tissue t = neo_hookean(n ? 3e3 : 1.5e3, n ? 2e4 : 1e4);
            if (k == 1) t.memory = prony(0.2, 0.01, 0.1, n ? 0.1 : 0.2);
            sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
            c->gravity[0] = 9.81;
            c->springs.damping = 100;
            add_support(c, "left", "xyz");
            b[n] = start(c);
        }
        double soft = hang(&b[0]), stiff = hang(&b[1]);
        assert_true(soft > 1.5 * stiff);
        CHECK_OK(sn_state_move(b[0].net, b[1].net, b[0].s));
        // stiff elements are sqrt(2) faster
        assert_true(b[0].s->omega2 > 0.9 * b[1].s->omega2);
        const body moved = {.net = b[1].net, .s = b[0].s};
        CHECK_REL(hang(&moved), stiff, k ? 4e-3 : 1e-5); // exp(-1 s / 0.2 s) of a half
        CHECK_OK(sn_state_move(b[1].net, b[0].net, b[0].s));
        CHECK_REL(hang(&b[0]), soft, k ? 4e-3 : 1e-5);

        // memory that comes anew begins with all its stress, and forgets
        sn_case *c = b[0].c;
        c->tissue[0].memory = prony(0.4, 0.02, 0.1, 0.05);
        c->tissue[0].memory.terms = k ? 1 : 2;
        if (k) c->tissue[0].memory.value[1] = 0.02; // g, then tau
        sn_net *other;
        CHECK_OK(sn_net_create(c, &other));
        CHECK_OK(sn_state_move(b[0].net, other, b[0].s));
        const body creeping = {.net = other, .s = b[0].s};
        double later = hang(&creeping);
        assert_true(later > 1.1 * soft && later < 3 * soft);
        check_finite(&creeping);
        sn_net_destroy(other);
        c->springs.volume = false;
        CHECK_OK(sn_net_create(c, &other));
        CHECK_FAILS(sn_state_move(b[0].net, other, b[0].s), SN_E_DEFINITION, "must be the same");
        sn_net_destroy(other);
        end(&b[0]);
        end(&b[1]);
    }
}

//---- the inside of a step ------------------------------------------------------------------------

// all that a program does a thousand times a second, for 200 ms
static void drive(const body *b, unsigned char *bytes, size_t size_of_state) {
    sn_pose pose = sn_pose_at(b->c->tool[0].at);
    for (int n = 0; n < 200; n++) {
        pose.centre[2] = 0.0301 - 2e-5 * n;
        sn_state_set_tool(b->net, b->s, 0, &pose);
        sn_state_set_load(b->net, b->s, 0, 0.01 * n);
        sn_state_push(b->net, b->s, 20, (const double[]){1e-5 * n, 0, 0});
        if (n == 100) sn_state_grasp(b->net, b->s, 0, 0, NULL);
        if (n == 150) sn_state_release(b->net, b->s, 0);
        const int gone[3] = {n, n + 1, n / 2};
        if (n == 60 || n == 95 || n == 170) sn_state_cut(b->net, b->s, 3, gone, NULL);
        run_for(b, 1e-3);
        if (n % 50 != 49) continue;
        sn_state_save(b->net, b->s, bytes);
        if (sn_state_load(b->net, b->s, bytes, size_of_state) != SN_OK) return;
    }
}

// In a process that the system kills at its first call but read, write and exit, and with an
// allocator that counts.
static void steps_call_nothing(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        static const sn_rung rungs[] = {SN_RUNG_COUPLED, SN_RUNG_CENTRAL, SN_RUNG_SMOOTHED};
        sn_tissue t = demiray(2e3, 4, 4e4);
        t.memory = prony(0.3, 0.01, 0.2, 0.2);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.rung = rungs[k / 2];
        c->springs.damping = 20;
        c->springs.cuttable = true;
        add_support(c, "bottom", "xyz");
        add_load(c, SN_LOAD_PRESSURE, "right", 0, 0, 0, 0)->pressure = 50;
        add_tool(c, "tool", 0.01, (const double[]){0.02, 0.01, 0.0301}, (const double[]){0, 0, 0},
                 1);
        body b = start(c);
        const size_t bytes = sn_state_size(b.net, b.s);
        unsigned char *here = malloc(bytes), *there = malloc(bytes);
        int pipes[2], status = 0;
        assert_int_equal(pipe(pipes), 0);
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            long sent = prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) == 0;
            drive(&b, here, bytes);
            for (size_t at = 0; sent > 0 && at < bytes; at += (size_t)sent)
                sent = write(pipes[1], here + at, bytes - at);
            syscall(SYS_exit, 0);
        }
        close(pipes[1]);
        size_t got = 0;
        for (long n; (n = read(pipes[0], there + got, bytes - got)) > 0;) got += (size_t)n;
        close(pipes[0]);
        waitpid(child, &status, 0);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        assert_int_equal(got, bytes);
        long before = allocations;
        drive(&b, here, bytes);
        assert_int_equal(allocations, before);
        assert_true(before > 0);
        assert_memory_equal(here, there, bytes);
        free(here);
        free(there);
        end(&b);
    }
}

int main(void) {
    sn_set_allocator(&counting);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pushes_give_momentum),         cmocka_unit_test(set_loads_replace_tables),
        cmocka_unit_test(implicit_steps_obey_too),      cmocka_unit_test(views_and_torques),
        cmocka_unit_test(held_nodes_follow_their_tool), cmocka_unit_test(cases_grasp_and_release),
        cmocka_unit_test(constants_change_at_run_time), cmocka_unit_test(steps_call_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
