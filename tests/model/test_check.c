// Every refusal of sn_case_check(), and what it must let pass.
// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

static void check_refused(sn_case *c, sn_status status, const char *part) {
    CHECK_FAILS(sn_case_check(c), status, part);
    assert_null(strchr(sn_error_text(), '\n'));
    sn_case_destroy(c);
}

static void sound_cases(void **state) {
    (void)state;
    sn_case *c = block_case();
    CHECK_OK(sn_case_check(c));
    hold(c, "left", "x");
    hold(c, "front", "y");
    hold(c, "bottom", "z");
    move(c, "right", 0.003, NAN, NAN)->factor = ramp(0, 1, 1);
    CHECK_OK(sn_case_check(c)); // shared edges, different directions
    sn_case_destroy(c);

    c = block_case();
    hold(c, "left", "xyz");
    move(c, "right", 0.003, 0.001, 0)->factor = ramp(0, 1, 1);
    CHECK_OK(sn_case_check(c)); // different values, no shared node
    move(c, "top", NAN, NAN, 0)->factor = ramp(0, 1, 1);
    CHECK_OK(sn_case_check(c)); // shared edges, both say 0 along z
    sn_case_destroy(c);

    c = block_case();
    move(c, "right", 0.002, NAN, NAN)->factor = ramp(0, 1, 1);
    move(c, "top", 0.001, NAN, NAN)->factor = ramp(0, 2, 1);
    CHECK_OK(sn_case_check(c)); // written differently, the same motion
    c->tissue[0].law = &uniaxial_law;
    c->tissue[0].poissons_ratio = 0.45;
    CHECK_OK(sn_case_check(c));
    c->tissue[0].law = &fibre_law;
    c->tissue[0].poissons_ratio = NAN;
    c->fibre[0] = 0.6;
    c->fibre[2] = -0.8;
    CHECK_OK(sn_case_check(c));
    c->tissue[0].density = NAN; // nothing moves by itself, nothing weighs
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    CHECK_OK(sn_case_check(c));
    sn_case_destroy(c);
}

static void tissues(void **state) {
    (void)state;
    sn_case *c = block_case();
    c->tissue[0].law = NULL;
    check_refused(c, SN_E_DEFINITION, "region \"body\": tissue liver");
    c = block_case();
    c->tissue[0].value[0] = -1;
    check_refused(c, SN_E_RANGE, "modulus");
    c = block_case();
    c->tissue[0].law = &membrane_law;
    check_refused(c, SN_E_DEFINITION, "is for membranes");
    c = block_case();
    c->tissue[0].law = &uniaxial_law;
    check_refused(c, SN_E_DEFINITION, "needs poissons_ratio");
    c = block_case();
    c->tissue[0].law = &fibre_law;
    check_refused(c, SN_E_DEFINITION, "has fibres: give their direction");
    c = block_case();
    c->tissue[0].branched = true;
    c->tissue[0].volumetric = c->tissue[0].fibre = sn_memory_none();
    CHECK_OK(sn_case_check(c));
    c->tissue[0].fibre.law = sn_memory_law_find("maxwell");
    check_refused(c, SN_E_UNSUPPORTED, "region \"body\": tissue liver: memory branch fibre");
    c = block_case();
    c->fibre[1] = 0.5;
    check_refused(c, SN_E_RANGE, "length 0.5: 1 expected");
    c = block_case();
    c->fibre[1] = NAN;
    check_refused(c, SN_E_RANGE, "finite");
    c = block_case();
    c->tissue[0].density = 0;
    check_refused(c, SN_E_RANGE, "density is 0");
    c = block_case();
    c->tissue[0].density = NAN;
    CHECK_OK(sn_case_check(c)); // whether the springs need one is theirs to say
    c->gravity[2] = -9.81;
    c->tissue[0].density = NAN;
    check_refused(c, SN_E_DEFINITION, "no density");
    c = block_case();
    c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
    c->tissue[0].density = NAN;
    check_refused(c, SN_E_DEFINITION, "no density");
    c = block_case();
    sn_free(c->tissue);
    c->tissue = NULL;
    check_refused(c, SN_E_DEFINITION, "has no tissue");
    CHECK_OK(sn_case_create(&c));
    check_refused(c, SN_E_DEFINITION, "has no mesh");
    c = block_case();
    c->mesh->surface[6].name[0] = 'B';
    check_refused(c, SN_E_DEFINITION, "the mesh was not finished");
}

static void loads(void **state) {
    (void)state;
    sn_case *c = block_case();
    hold(c, "left", "");
    check_refused(c, SN_E_DEFINITION, "support 1 on \"left\" fixes no direction");
    c = block_case();
    hold(c, "left", "x");
    c->support[0].surface = 7;
    check_refused(c, SN_E_DEFINITION, "support 1 is on surface 7, but the mesh has 7");
    c = block_case();
    move(c, "top", 0, 0, 0);
    c->mesh->surface[5].face_count = 0;
    check_refused(c, SN_E_DEFINITION, "surface \"top\" has no faces");
    c = block_case();
    move(c, "top", NAN, NAN, NAN);
    check_refused(c, SN_E_DEFINITION, "all three components are free");
    c = block_case();
    move(c, "top", 0, 0, INFINITY);
    check_refused(c, SN_E_RANGE, "load 1 on \"top\" is not a finite number");
    c = block_case();
    move(c, "top", 0, 0, 1);
    CHECK_OK(sn_history_create(2, 1, (double[]){0}, (double[]){0, 0}, &c->load[0].factor));
    check_refused(c, SN_E_DEFINITION, "has 2 columns of values, 1 expected");
}

static void contradictions(void **state) {
    (void)state;
    sn_case *c = block_case();
    hold(c, "left", "xyz");
    move(c, "top", NAN, NAN, 0.003)->factor = ramp(0, 1, 0.5);
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION,
                "\"left\" and \"top\" share node 40 at (0, 0, 0.023) m");
    check_refused(c, SN_E_DEFINITION, "0 m along z and the other 0.003 m (at 0.5 s)");
    // two loads that part only between the ends: the knots tell
    c = block_case();
    move(c, "right", 0.001, NAN, NAN)->factor = ramp(0, 1, 1);
    sn_history *h = NULL;
    CHECK_OK(sn_history_create(1, 3, (double[]){0, 0.4, 1}, (double[]){0, 0.5, 1}, &h));
    move(c, "top", 0.001, NAN, NAN)->factor = h;
    check_refused(c, SN_E_DEFINITION, "\"right\" and \"top\" share node");
    c = block_case();
    move(c, "right", 0.001, NAN, NAN);
    move(c, "front", 0.0011, NAN, NAN);
    check_refused(c, SN_E_DEFINITION, "free that direction on one of them");
}

static void names_and_probes(void **state) {
    (void)state;
    sn_case *c = block_case();
    add_probe(c, "tip", SN_PROBE_POINT, 0.01, 0.01, 0.01, NULL);
    add_sphere(c, "tip", 0.001, 0, 0, 0.1);
    check_refused(c, SN_E_DEFINITION, "two probes or tools are named \"tip\"");
    c = block_case();
    add_probe(c, "", SN_PROBE_POINT, 0.01, 0.01, 0.01, NULL);
    check_refused(c, SN_E_DEFINITION, "has no name");
    c = block_case();
    char name[SN_NAME_MAX] = {0};
    memset(name, 'a', SN_NAME_MAX - 1);
    add_probe(c, name, SN_PROBE_POINT, 0.01, 0.01, 0.01, NULL);
    check_refused(c, SN_E_DEFINITION, "at most 60 bytes");
    c = block_case();
    add_probe(c, "tip", SN_PROBE_POINT, 0.01, 0.01, 0.1, NULL);
    check_refused(c, SN_E_DEFINITION, "probe \"tip\": the point (0.01, 0.01, 0.1) m is outside");
    c = block_case();
    add_probe(c, "pull", SN_PROBE_REACTION, 0, 0, 0, "top");
    c->probe[0].surface = -1;
    check_refused(c, SN_E_DEFINITION, "probe \"pull\": reaction 1 is on surface -1");
}

static void tools(void **state) {
    (void)state;
    double r = 0.004, x = 0.031 / 3, y = 0.017 / 2, top = 0.023; // above a node of the top
    sn_case *c = block_case();
    add_sphere(c, "ball", r, x, y, top + r); // touches
    CHECK_OK(sn_case_check(c));
    c->tool[0].at[2] = top + 0.9 * r;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION,
                "tool \"ball\" starts inside the body, 0.0004 m deep");
    // the place it names is good
    double to[3];
    assert_int_equal(
        sscanf(strstr(sn_error_text(), "m to (") + 5, "(%lf, %lf, %lf)", to, to + 1, to + 2), 3);
    CHECK_ABS(to[2], top + r, 1e-7);
    memcpy(c->tool[0].at, to, sizeof to);
    CHECK_OK(sn_case_check(c));
    // a small tool that lies in the middle of a cell touches no node
    c->tool[0].radius = 0.0001;
    c->tool[0].at[0] = x + 0.003;
    c->tool[0].at[1] = y + 0.001;
    c->tool[0].at[2] = top - 0.002;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "starts inside the body");
    // where the path starts counts, not where `at` is
    CHECK_OK(sn_history_create(3, 1, (double[]){0}, (double[]){0, 0, 0.01}, &c->tool[0].path));
    CHECK_OK(sn_case_check(c));
    c->tool[0].path->channels = 1;
    check_refused(c, SN_E_DEFINITION, "its path has 1 columns");

    c = block_case();
    add_sphere(c, "ball", 0, x, y, 1);
    check_refused(c, SN_E_RANGE, "radius 0 m must be positive");
    c = block_case();
    add_sphere(c, "ball", r, x, y, NAN);
    check_refused(c, SN_E_RANGE, "its place finite");
    c = block_case();
    add_sphere(c, "ball", r, x, y, 1)->friction = -0.1;
    check_refused(c, SN_E_RANGE, "friction -0.1 must be 0 or more");
}

static void settings(void **state) {
    (void)state;
    static const double bad[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        sn_case *c = block_case();
        c->until = bad[i];
        check_refused(c, SN_E_RANGE, "time: until is");
        c = block_case();
        c->output_every = bad[i];
        check_refused(c, SN_E_RANGE, "time: output_every is");
        c = block_case();
        c->springs.memory_tolerance = bad[i];
        check_refused(c, SN_E_RANGE, "springs: memory_tolerance is");
        c = block_case();
        c->continuum.memory_tolerance = bad[i];
        check_refused(c, SN_E_RANGE, "continuum: memory_tolerance is");
        c = block_case();
        c->continuum.tolerance = bad[i];
        check_refused(c, SN_E_RANGE, "continuum: tolerance is");
        if (i == 0) continue; // these may be 0
        c = block_case();
        c->springs.step = bad[i];
        check_refused(c, SN_E_RANGE, "springs: step is");
        c = block_case();
        c->springs.damping = bad[i];
        check_refused(c, SN_E_RANGE, "springs: damping is");
    }
    sn_case *c = block_case();
    c->springs.threads = 0;
    check_refused(c, SN_E_RANGE, "springs: threads is 0");
    c = block_case();
    c->continuum.steps = 0;
    check_refused(c, SN_E_RANGE, "continuum: steps is 0");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sound_cases),
        cmocka_unit_test(tissues),
        cmocka_unit_test(loads),
        cmocka_unit_test(contradictions),
        cmocka_unit_test(names_and_probes),
        cmocka_unit_test(tools),
        cmocka_unit_test(settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
