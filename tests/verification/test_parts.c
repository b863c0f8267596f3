// A memory for each part of the stress, and fibres beside springs: the rungs against linear finite
// elements and against the virtual testing machine.
// SPDX-License-Identifier: Apache-2.0
#include "engines.h"
#include "parts.h"

#define LENGTH 0.012
#define SIDE 0.004

// A strip held at the left (`clamped`: in all directions, else it may contract) and pulled by
// `pull` of its length and `shear` of its side within a second. Fibres in the plane of x and y.
static sn_case *strip(const sn_tissue *t, double turn, bool clamped, double pull, double shear) {
    sn_case *c = make_block((const double[]){LENGTH, SIDE, SIDE}, (const int[]){6, 2, 2},
                            SN_PATTERN_MIRRORED, t);
    c->fibre[0] = cos(turn), c->fibre[1] = sin(turn);
    add_support(c, "left", clamped ? "xyz" : "x");
    if (!clamped) add_support(c, "front", "y");
    if (!clamped) add_support(c, "bottom", "z");
    sn_load *load = add_load(c, SN_LOAD_DISPLACEMENT, "right", pull * LENGTH, shear * SIDE, 0, 1);
    load->free[1] = load->free[2] = !clamped;
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
    c->until = 1.5;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->springs.volume = false;
    c->continuum.element = SN_ELEMENT_P1;
    c->continuum.steps = 150; // 100 in the ramp
    CHECK_OK(sn_case_check(c));
    return c;
}

// Coupled springs without the volume term are linear elements with branches too: pulled and sheared
// between clamps, fibres askew. Each engine takes its own steps, as in test_strip.c: second order,
// at least 100 in the ramp of the one and 20 in that of the other.
static void coupled_springs_are_linear_elements(void **state) {
    (void)state;
    sn_tissue t = artery(1900, 0.1, 0.5, 2e4);
    part_memories(&t);
    sn_case *c = strip(&t, 0.6, true, 0.2, 0.3);
    c->springs.rung = SN_RUNG_COUPLED;
    sn_record *springs = reaction(sn_springs_run, c), *elements = reaction(sn_continuum_run, c);
    CHECK_ABS(distance(springs, elements), 0, 3.2e-4);
    sn_record_destroy(springs);
    // steps of one length on both sides: what is left are the tolerances of both
    c->springs.step = 0.01;
    c->springs.memory_tolerance = c->continuum.memory_tolerance = 1e-6;
    sn_record *same = reaction(sn_springs_run, c), *finer = reaction(sn_continuum_run, c);
    CHECK_ABS(distance(same, finer), 0, 1e-6);
    // not vacuous: one memory for all is another tissue
    c->tissue[0].branched = false;
    springs = reaction(sn_springs_run, c);
    assert_true(distance(springs, elements) > 1e-2);
    sn_record_destroy(springs);
    sn_record_destroy(elements);
    sn_record_destroy(same);
    sn_record_destroy(finer);
    sn_case_destroy(c);
}

// Sides free, compressible: every rung that has the law itself follows the virtual test.
static void rungs_follow_the_virtual_test(void **state) {
    (void)state;
    sn_tissue t = artery(1900, 0.1, 0.5, 1.3e5);
    part_memories(&t);
    for (int k = 0; k < 4; k++) {
        sn_case *c = strip(&t, 0, false, 0.2, 0);
        c->springs.rung = k % 2 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED;
        c->springs.volume = k / 2;
        sn_record *springs = reaction(sn_springs_run, c);
        sn_history *stretch;
        const double *time = sn_record_values(springs, "time");
        const double *pull = sn_record_values(springs, "pull_fx");
        double *stress = sn_alloc((size_t)springs->rows, sizeof *stress), worst = 0, most = 0;
        CHECK_OK(sn_history_create(1, 2, (double[]){0, 1}, (double[]){1, 1.2}, &stretch));
        CHECK_OK(sn_lab_uniaxial(&t, stretch, springs->rows, time, stress));
        for (int i = 0; i < springs->rows; i++) {
            worst = fmax(worst, fabs(pull[i] - stress[i] * SIDE * SIDE));
            most = fmax(most, fabs(stress[i] * SIDE * SIDE));
        }
        CHECK_ABS(worst / most, 0, 2e-3); // 20 steps in the ramp, memories to 1e-3
        sn_free(stress);
        sn_history_destroy(stretch);
        sn_record_destroy(springs);
        sn_case_destroy(c);
    }
}

// A strip along its fibres and across them, on central springs with fibres and nodal volume,
// against linear elements.
static void central_strips_along_and_across(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        sn_tissue t = artery(4000, 0, 0, 1.3e4);
        if (k % 3 == 2) part_memories(&t);
        sn_case *c = strip(&t, k % 3 == 1 ? acos(-1) / 2 : 0, k / 3, 0.15, 0);
        c->springs.volume = true;
        c->springs.rung = SN_RUNG_CENTRAL;
        sn_record *springs = reaction(sn_springs_run, c), *elements = reaction(sn_continuum_run, c);
        // along, the fibres carry nearly all; across, the springs of the matrix are alone: what the
        // fit of their law and their own error of the mesh leave
        CHECK_ABS(distance(springs, elements), 0, k % 3 == 1 ? 0.06 : 0.01);
        sn_record_destroy(springs);
        sn_record_destroy(elements);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coupled_springs_are_linear_elements),
        cmocka_unit_test(rungs_follow_the_virtual_test),
        cmocka_unit_test(central_strips_along_and_across),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
