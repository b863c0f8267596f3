// The implicit integrator with tools and loads: where it ends, what it cannot bear, what it
// allocates. SPDX-License-Identifier: Apache-2.0
#include "allocator.h"
#include "nets.h"
#include "springs/steps.h"

static sn_case *poked(const sn_tissue *t, sn_rung rung) {
    sn_case *c = make_block((const double[]){0.04, 0.04, 0.02}, (const int[]){4, 4, 2},
                            SN_PATTERN_MIRRORED, t);
    c->springs.rung = rung;
    c->until = 0.6;
    add_support(c, "bottom", "xyz");
    add_tool(c, "probe", 0.01, (const double[]){0.021, 0.019, 0.0301},
             (const double[]){0.001, 0, -0.004}, 0.5);
    return c;
}

// Pressed slowly, with memory, the implicit motion ends where equilibrium is.
static void implicit_meets_equilibrium(void **state) {
    (void)state;
    sn_tissue t = demiray(2e3, 4, 4e4);
    t.memory = prony(0.4, 0.05, 0.3, 0.5);
    for (int k = 0; k < 2; k++) {
        sn_case *c = poked(&t, k ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED);
        double force[2];
        sn_run_summary s[2];
        for (int n = 0; n < 2; n++) {
            c->springs.integrator = n ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_QUASI_STATIC;
            c->springs.step = 5e-3;
            c->springs.stiffness_damping = 1e-3;
            sn_record *r = run_case(c, &s[n]);
            if (!s[n].converged) print_message("%s\n", s[n].reason);
            assert_true(s[n].converged);
            force[n] = last_value(r, "probe_fz");
            sn_record_destroy(r);
        }
        assert_true(force[0] > 0.05);
        // pressed at 8 mm/s: rings at 30 1/s and more, which 0.1 s of rest damps
        CHECK_REL(force[1], force[0], 2e-3);
        CHECK_ABS(s[1].energy_residual, 0, 2e-3);
        assert_int_equal(s[1].steps, 120);
        assert_int_equal(s[1].cutbacks, 0);
        c->tool[0].friction = 0.2; // what sticks is drawn along, and resists more
        sn_record *r = run_case(c, &s[1]);
        assert_true(s[1].converged && s[1].cutbacks == 0);
        assert_true(last_value(r, "probe_fz") > force[1]);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// More than the tissue bears: steps are cut, and at last a reason with numbers; no NaN anywhere.
static void hopeless_steps_are_cut(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block((const double[]){0.04, 0.02, 0.02}, (const int[]){4, 2, 2},
                            SN_PATTERN_MIRRORED, &t);
    c->springs.integrator = SN_INTEGRATOR_IMPLICIT;
    add_support(c, "left", "xyz");
    add_load(c, SN_LOAD_PRESSURE, "top", 0, 0, 0, 1)->pressure = 1e7;
    add_probe(c, "tip", SN_PROBE_POINT, NULL, 0.04, 0, 0);
    sn_run_summary s;
    sn_record *r = run_case(c, &s);
    assert_false(s.converged);
    assert_non_null(strstr(s.reason, "found no balance"));
    assert_true(s.cutbacks > 10);
    for (int n = 0; n < r->rows; n++)
        for (int k = 0; k < r->series_count; k++) assert_true(isfinite(r->series[k].value[n]));
    assert_true(isfinite(s.elastic_J) && isfinite(s.energy_residual));
    sn_record_destroy(r);
    sn_case_destroy(c);
}

static void implicit_steps_do_not_allocate(void **state) {
    (void)state;
    sn_tissue t = demiray(2e3, 4, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    sn_case *c = poked(&t, SN_RUNG_COUPLED);
    c->springs.integrator = SN_INTEGRATOR_IMPLICIT;
    c->springs.damping = 5;
    c->springs.step = 5e-3;
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    long before = allocations;
    double force[3], x = 0;
    while (s->time < 0.5) sn_state_step(net, s, 1);
    sn_state_tool_force(net, s, 0, force);
    assert_true(force[2] > 0.05);
    assert_int_equal(allocations, before);
    assert_true(before > 0);
    // the same again from rest
    for (int n = 0; n < 2; n++) {
        sn_state_reset(net, s);
        while (s->time < 0.2) sn_state_step(net, s, 1);
        double now = ((double *)s->u)[4 * node_at(net, 0.02, 0.02, 0.02) + 2];
        if (n > 0) assert_true(now == x);
        x = now;
    }
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

// Gravity on soft blocks from coarse to fine: they sag and stand, at any refinement, with springs
// as stiff as the continuum wants (about E h). Sag of a column clamped below, against rho g L^2 /
// (2 E).
static void nets_bear_their_weight(void **state) {
    (void)state;
    static const int parts[] = {2, 4, 10};
    double sag[3];
    for (int k = 0; k < 6; k++) {
        const double E = 1e4, nu = k < 3 ? 0.45 : 0.25;
        sn_tissue t = neo_hookean(E / (2 + 2 * nu), E / (3 - 6 * nu));
        const int n = parts[k % 3];
        sn_case *c = make_block((const double[]){0.1, 0.1, 0.1}, (const int[]){n, n, n},
                                SN_PATTERN_MIRRORED, &t);
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.volume = k < 3;
        c->springs.integrator = SN_INTEGRATOR_IMPLICIT;
        c->springs.scheme = SN_SCHEME_BACKWARD_EULER;
        c->springs.step = 0.02;
        c->gravity[2] = -9.81;
        add_support(c, "bottom", "xyz");
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        while (s->time < 1.2) sn_state_step(net, s, 1);
        assert_false(s->broken);
        assert_true(sn_net_smallest_ratio(net, NULL, s->u) > 0.2);
        sag[k % 3] = -((double *)s->u)[4 * node_at(net, 0.05, 0.05, 0.1) + 2];
        double bar = 1000 * 9.81 * 0.01 / (2 * E);
        assert_true(sag[k % 3] > 0.4 * bar && sag[k % 3] < 1.6 * bar);
        if (k % 3 == 2) CHECK_REL(sag[1], sag[2], 0.15); // settles with refinement
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

int main(void) {
    sn_set_allocator(&counting);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(implicit_meets_equilibrium),
        cmocka_unit_test(hopeless_steps_are_cut),
        cmocka_unit_test(implicit_steps_do_not_allocate),
        cmocka_unit_test(nets_bear_their_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
