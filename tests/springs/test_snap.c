// A body that snaps through under a dead load: equilibrium beyond the point where it is lost.
// SPDX-License-Identifier: Apache-2.0
#include "kept.h"

// A shallow arch, clamped at both ends, pressed down until it hangs through.
static sn_case *arch(void) {
    const double size[3] = {0.1, 0.01, 0.005}, rise = 0.011, pi = 3.14159265358979;
    const int cells[3] = {16, 1, 2};
    const sn_tissue t = neo_hookean(1e4, 2e4);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    for (int i = 0; i < c->mesh->node_count; i++) {
        const double s = sin(pi * c->mesh->node[3 * i] / size[0]);
        c->mesh->node[3 * i + 2] += rise * s * s;
    }
    c->has_shape = false;
    c->springs.rung = SN_RUNG_COUPLED;
    add_support(c, "left", "xyz");
    add_support(c, "right", "xyz");
    add_load(c, SN_LOAD_TRACTION, "top", 0, 0, -60, 1);
    add_probe(c, "middle", SN_PROBE_POINT, "", 0.5 * size[0], 0.005, rise);
    return c;
}

// Newton's method ends where the arch loses its hold; the run goes on to the other side, where a
// motion with inertia and much damping comes to rest as well. What the arch gives off is lost.
static void arch_snaps_through(void **state) {
    (void)state;
    sn_run_summary snapped, moved;
    sn_case *c = arch();
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    sn_record *still = run_case(c, &snapped);
    print_message("%s%s\n", snapped.note, snapped.reason);
    assert_true(snapped.converged);
    assert_non_null(strstr(snapped.note, "snapped"));
    c->springs.integrator = SN_INTEGRATOR_IMPLICIT;
    c->springs.damping = 20;
    c->springs.step = 0.01;
    c->until = 4;
    sn_record *motion = run_case(c, &moved);
    const double w = last_value(still, "middle_uz"), there = last_value(motion, "middle_uz");
    print_message(
        "middle %g m, by motion %g m; work %g, elastic %g, dissipated %g J, residual %g\n", w,
        there, snapped.external_work_J, snapped.elastic_J, snapped.dissipated_J,
        snapped.energy_residual);
    assert_true(there < -0.011); // below its supports
    CHECK_REL(w, there, 1e-3);
    // a hundredth of the work, and the ledger closes with it: trapezoids of 20 steps and more
    assert_true(snapped.dissipated_J > 0.01 * snapped.external_work_J);
    CHECK_ABS(snapped.energy_residual, 0, 1e-3);
    sn_record_destroy(still);
    sn_record_destroy(motion);
    sn_case_destroy(c);
}

// Pressed to and fro the arch snaps through and back, and loses its hold a third time: the run is
// let go twice at most. Killed before the first time, right after it or after the second, it goes
// on to the same end with the same bits: rows, ledger, note and reason.
static void snapping_runs_go_on(void **state) {
    (void)state;
    static const double time[] = {0, 0.2, 0.5, 1}, factor[] = {0, 1, -1, 1};
    static const int stop[] = {1, 2, 7}; // at 0.05, 0.1 and 0.35 s
    sn_case *c = arch();
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->output_every = 0.05;
    sn_history_destroy(c->load[0].factor);
    CHECK_OK(sn_history_create(1, 4, time, factor, &c->load[0].factor));
    sn_run_summary first, second;
    sn_record *e, *f, *a;
    CHECK_OK(sn_record_create("a", &a));
    CHECK_OK(sn_record_create("e", &e));
    CHECK_OK(sn_springs_run(c, &(sn_output){.energy = e}, &first, a));
    print_message("%d rows; %s; %s\n", a->rows, first.note, first.reason);
    assert_non_null(strstr(first.note, "in 2 of its steps, first at 0.1 s"));
    assert_true(a->rows > 8 && !first.converged && first.dissipated_J > 0);
    for (int k = 0; k < 3; k++) {
        CHECK_OK(sn_record_create("f", &f));
        keeper kept = run_killed(c, &(sn_output){.energy = f}, stop[k]);
        sn_record_destroy(f);
        CHECK_OK(sn_record_create("f", &f));
        sn_record *b = run_on(c, &(sn_output){.energy = f}, &kept, &second);
        check_same_rows(a, b);
        check_same_rows(e, f);
        check_same_summary(first, second);
        sn_record_destroy(b);
        sn_record_destroy(f);
        free(kept.bytes);
    }
    sn_record_destroy(e);
    sn_record_destroy(a);
    sn_case_destroy(c);
}

// Whatever its steps, halved many times in one or a few times in each of several near the limit.
static void any_step_snaps_through(void **state) {
    (void)state;
    static const double time[] = {0, 0.5, 1}, factor[] = {0, 1, 1}, step[] = {0.01, 0.02, 0.1};
    double w[3];
    for (int k = 0; k < 3; k++) {
        sn_case *c = arch();
        sn_run_summary s;
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        c->springs.step = step[k];
        c->output_every = 0.1;
        c->until = 1;
        sn_history_destroy(c->load[0].factor);
        CHECK_OK(sn_history_create(1, 3, time, factor, &c->load[0].factor));
        sn_record *r = run_case(c, &s);
        if (!s.converged) print_message("step %g s: %s\n", step[k], s.reason);
        assert_true(s.converged);
        assert_non_null(strstr(s.note, "in 1 of its steps"));
        w[k] = last_value(r, "middle_uz");
        CHECK_REL(w[k], w[0], 1e-6); // one equilibrium, to ten digits of the forces
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(arch_snaps_through),
                                       cmocka_unit_test(snapping_runs_go_on),
                                       cmocka_unit_test(any_step_snaps_through)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
