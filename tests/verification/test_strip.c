// One tissue, one strip, three ways: the virtual testing machine, the springs, the finite elements.
// SPDX-License-Identifier: Apache-2.0
#include "build.h"
#include "engines.h"
#include "laws.h"

#define LENGTH 0.012
#define SIDE 0.003
#define RAMP 1.0
#define STRETCH 1.2376

// cardiac muscle as fitted (rounded), bulk over shear modulus 1000
static sn_tissue muscle(double bulk_ratio) {
    sn_tissue t = demiray(3100, 12.3, bulk_ratio * 3100);
    t.density = 1060;
    t.memory.law = sn_memory_law_find("fung-spectrum");
    t.memory.value[0] = 0.26;
    t.memory.value[1] = 2e-3;
    t.memory.value[2] = 60;
    CHECK_OK(sn_tissue_check(&t));
    return t;
}

// an eighth of the strip; `clamped` holds the left face in all directions
static sn_case *strip(double bulk_ratio, bool clamped) {
    const sn_tissue t = muscle(bulk_ratio);
    sn_case *c = make_block((const double[]){LENGTH, SIDE, SIDE}, (const int[]){6, 2, 2},
                            SN_PATTERN_MIRRORED, &t);
    add_support(c, "left", clamped ? "xyz" : "x");
    add_support(c, "front", "y");
    add_support(c, "bottom", "z");
    sn_load *load = add_load(c, SN_LOAD_DISPLACEMENT, "right", (STRETCH - 1) * LENGTH, 0, 0, RAMP);
    load->free[1] = load->free[2] = true;
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
    c->until = 1.5;
    c->springs.rung = SN_RUNG_COUPLED;
    c->continuum.element = SN_ELEMENT_P1;
    c->continuum.steps = 150; // 100 in the ramp: the recursion is second order in the step
    CHECK_OK(sn_case_check(c));
    return c;
}

// the pull that the virtual test of the same tissue gives for this cross-section
static sn_record *virtual_test(const sn_tissue *tissue, const sn_record *like) {
    sn_history *stretch;
    sn_record *record;
    const double *time = sn_record_values(like, "time");
    double *stress = sn_alloc((size_t)like->rows, sizeof *stress);
    CHECK_OK(sn_history_create(1, 2, (double[]){0, RAMP}, (double[]){1, STRETCH}, &stretch));
    CHECK_OK(sn_lab_uniaxial(tissue, stretch, like->rows, time, stress));
    CHECK_OK(sn_record_create("virtual", &record));
    CHECK_OK(sn_record_add_series(record, "pull_fx", "N"));
    for (int i = 0; i < like->rows; i++)
        CHECK_OK(sn_record_append(record, (double[]){stress[i] * SIDE * SIDE}));
    sn_free(stress);
    sn_history_destroy(stretch);
    return record;
}

// Coupled springs without the volume term are linear finite elements: on a clamped strip, where the
// field is not homogeneous, both solved to 1e-9, the reactions agree to 1e-6.
static void coupled_springs_are_linear_elements(void **state) {
    (void)state;
    sn_case *c = strip(20, true);
    // no memory: the two engines choose their own steps for it
    c->tissue[0].memory = sn_memory_none();
    c->springs.volume = false;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    sn_record *springs = reaction(sn_springs_run, c), *elements = reaction(sn_continuum_run, c);
    CHECK_ABS(distance(springs, elements), 0, 1e-6);
    // not vacuous: the volume term makes another model of it
    c->springs.volume = true;
    sn_record *other = reaction(sn_springs_run, c);
    assert_true(distance(other, elements) > 1e-4);
    sn_record_destroy(springs);
    sn_record_destroy(elements);
    sn_record_destroy(other);
    sn_case_destroy(c);
}

// The same for every solid law of the registry, with fibres and with memory, pulled and sheared.
static void for_every_solid_law_and_with_memory(void **state) {
    (void)state;
    for (int k = 0; k < sn_law_count(); k++) {
        const sn_law *law = sn_law_at(k);
        if (law->kind != SN_LAW_SOLID) continue;
        sn_case *c = strip(20, true);
        sn_tissue *t = &c->tissue[0];
        *t = some_tissue(law);
        c->fibre[0] = 0.8, c->fibre[1] = 0.6;
        c->load[0].vector[1] = 0.3 * SIDE;
        c->load[0].free[1] = false;
        c->support_count = 1; // the planes of symmetry would hold what is sheared
        c->springs.volume = false;
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        sn_record *springs = reaction(sn_springs_run, c), *elements = reaction(sn_continuum_run, c);
        print_message("%s\n", law->name);
        CHECK_ABS(distance(springs, elements), 0, 1e-6);
        sn_record_destroy(springs);
        sn_record_destroy(elements);
        // With memory the engines choose their own steps: second order, at least 100 in the ramp of
        // the one and 20 in that of the other, of a stress that bends by about its own size over
        // it: 1/(8 20^2) at most.
        t->memory = (sn_memory){
            .law = sn_memory_law_find("prony"), .terms = 2, .value = {0.3, 0.25, 0.05, 0.7}};
        springs = reaction(sn_springs_run, c);
        elements = reaction(sn_continuum_run, c);
        CHECK_ABS(distance(springs, elements), 0, 3.2e-4);
        sn_record_destroy(springs);
        sn_record_destroy(elements);
        sn_case_destroy(c);
    }
}

// Sides free: the stretch is homogeneous, and both engines must follow the virtual test of the same
// tissue within 1 % of its peak; springs explicit, with inertia, and quasi-static. (At the fastest
// measured speed, a ramp of 0.1 s, the sudden stop sends a wave through the strip: 3 % of the peak,
// which the machine of one point cannot know.)
static void both_engines_follow_the_virtual_test(void **state) {
    (void)state;
    sn_case *c = strip(1000, false);
    c->springs.volume = true;
    sn_record *springs = reaction(sn_springs_run, c), *elements = reaction(sn_continuum_run, c);
    sn_record *machine = virtual_test(&c->tissue[0], springs);
    CHECK_ABS(distance(elements, machine), 0, 0.01);
    CHECK_ABS(distance(springs, machine), 0, 0.01);
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    sn_record *still = reaction(sn_springs_run, c);
    CHECK_ABS(distance(still, machine), 0, 0.01);
    c->continuum.element = SN_ELEMENT_P2P1;
    sn_record *mixed = reaction(sn_continuum_run, c);
    CHECK_ABS(distance(mixed, machine), 0, 0.01);
    // not vacuous: without memory the curve is another one
    c->tissue[0].memory = sn_memory_none();
    sn_record *elastic = reaction(sn_continuum_run, c);
    assert_true(distance(elastic, machine) > 0.1);
    sn_record_destroy(springs);
    sn_record_destroy(elements);
    sn_record_destroy(machine);
    sn_record_destroy(still);
    sn_record_destroy(mixed);
    sn_record_destroy(elastic);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coupled_springs_are_linear_elements),
        cmocka_unit_test(for_every_solid_law_and_with_memory),
        cmocka_unit_test(both_engines_follow_the_virtual_test),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
