// Bad input: refused, or survived and counted.
// SPDX-License-Identifier: Apache-2.0
#include "driven.h"

static void bad_bodies_are_refused(void **state) {
    (void)state;
    sn_net *net = NULL;
    for (int k = 0; k < 4; k++) {
        sn_case *c = soft_block();
        const char *part = "";
        if (k == 0) { // a node of no cell
            int n = c->mesh->node_count++;
            c->mesh->node = sn_resize(c->mesh->node, 3 * (size_t)(n + 1), sizeof(double));
            for (int d = 0; d < 3; d++) c->mesh->node[3 * n + d] = 0.01 + 1e-4 * d;
            part = "node 45";
        } else if (k == 1) { // an inverted cell
            int swap = c->mesh->cell[4];
            c->mesh->cell[4] = c->mesh->cell[5];
            c->mesh->cell[5] = swap;
            part = "cell 1";
        } else if (k == 2) {
            c->tissue[0].density = 0;
            part = "density";
        } else {
            add_load(c, SN_LOAD_TRACTION, "right", (double)NAN, 0, 0, 1);
            part = "load";
        }
        sn_status status = sn_net_create(c, &net);
        if (status == SN_OK || !strstr(sn_error_text(), part))
            print_message("kind %d: status %d, \"%s\"\n", k, (int)status,
                          status == SN_OK ? "" : sn_error_text());
        assert_true(status != SN_OK && strstr(sn_error_text(), part));
        sn_case_destroy(c);
    }
}

static void long_steps_are_cut_and_counted(void **state) {
    (void)state;
    sn_case *c = soft_block();
    c->springs.step = 1;
    add_support(c, "left", "xyz");
    body b = start(c);
    sn_step_info info = {0};
    for (int n = 0; n < 5; n++) info = sn_state_step(b.net, b.s, 1);
    assert_int_equal(info.warnings, 5);
    assert_true(info.step < 0.01);
    end(&b);
}

enum { PRESSED, SWALLOWED, TORN, TURNED, HARMS };

// what is imposed at millisecond n of 300
static void harm(const body *b, int kind, int n) {
    sn_pose pose = sn_pose_at(b->c->tool[0].at);
    if (kind == PRESSED) pose.centre[2] = 0.0201 - 0.04 * n / 300.0; // through the support
    if (kind == SWALLOWED) pose.centre[2] = 0.013;
    CHECK_OK(sn_state_set_tool(b->net, b->s, 0, &pose));
    CHECK_OK(sn_state_set_load(b->net, b->s, 0, kind == TURNED ? 0.03 * n / 300.0 : 0.0));
    if (kind == TORN && n == 100)
        CHECK_OK(sn_state_push(b->net, b->s, 30, (const double[]){1e30, 0, 1e30}));
}

static void leave_alone(const body *b) {
    sn_pose away = sn_pose_at((const double[]){0.02, 0.01, 0.2});
    CHECK_OK(sn_state_push(b->net, b->s, 30, (const double[]){0, 0, 0}));
    CHECK_OK(sn_state_set_load(b->net, b->s, 0, 0.0));
    CHECK_OK(sn_state_set_tool(b->net, b->s, 0, &away));
}

// A net is pressed flat by a plane, swallowed by a sphere that starts inside, torn by a push
// without measure, or turned inside out from its top; left alone it comes back, and says so where
// it had to begin anew.
static void nets_survive_anything(void **state) {
    (void)state;
    static const sn_rung rungs[] = {SN_RUNG_COUPLED, SN_RUNG_CENTRAL, SN_RUNG_SMOOTHED};
    for (int k = 0; k < 3 * 2 * HARMS; k++) {
        const int kind = k / 2 % HARMS;
        const sn_rung rung = rungs[k / (2 * HARMS)];
        sn_tissue t = rung == SN_RUNG_CENTRAL ? neo_hookean(3e3, 2e4) : demiray(2e3, 4, 4e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.rung = rung;
        c->springs.damping = 100;
        add_support(c, "bottom", "xyz");
        if (kind == TURNED)
            add_load(c, SN_LOAD_DISPLACEMENT, "top", 0, 0, -1, 1);
        else
            add_load(c, SN_LOAD_TRACTION, "top", 0, 0, -1, 1);
        add_tool(c, "tool", 0.01, (const double[]){0.02, 0.01, 0.0301}, (const double[]){0, 0, 0},
                 1);
        if (kind == PRESSED) {
            c->tool[0].kind = SN_TOOL_PLANE;
            c->tool[0].axis[2] = -1;
        }
        body b = start(c);
        double most = 0;
        for (int n = 0; n < 300; n++) {
            harm(&b, kind, n);
            run_for(&b, 1e-3);
            if (n % 10 == 0) check_finite(&b);
            most = fmax(most, farthest(&b));
        }
        leave_alone(&b);
        run_for(&b, 1.5);
        check_finite(&b);
        assert_true(kind == TORN || most > (kind == SWALLOWED ? 0.001 : 0.01)); // it was far
        assert_true(farthest(&b) < 1e-4);
        if (kind == TORN) assert_true(b.s->warnings > 0);
        CHECK_FAILS(sn_state_set_tool(b.net, b.s, 0, &(sn_pose){.centre = {(double)NAN, 0, 0}}),
                    SN_E_RANGE, "tool \"tool\"");
        end(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bad_bodies_are_refused),
                                       cmocka_unit_test(long_steps_are_cut_and_counted),
                                       cmocka_unit_test(nets_survive_anything)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
