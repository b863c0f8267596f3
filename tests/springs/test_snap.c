// A body that snaps through under a dead load: equilibrium beyond the point where it is lost.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"

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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(arch_snaps_through)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
