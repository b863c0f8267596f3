// Linear statics: against the quasi-static analysis as strain goes to zero, and exact homogeneity.
// SPDX-License-Identifier: Apache-2.0
#include "body.h"

typedef struct fields {
    const sn_mesh *mesh;
    bool linear;
    double stress[6], strain[6], pressure, energy; ///< means over the body of the last frame
} fields;

// The two stresses are one, and the stretches hold the change of volume: differences of states of
// 1e-5 strain, whose error is of second order in it.
static void check_small(const sn_frame *frame, int n) {
    const double *S = frame->fields[5].value + 6 * n, *sigma = frame->fields[3].value + 6 * n,
                 *l = frame->fields[6].value + 3 * n, *e = frame->fields[2].value + 6 * n;
    double size = 1e-12, strain = fabs(l[0] - 1) + fabs(l[2] - 1);
    for (int k = 0; k < 6; k++) size = fmax(size, fabs(sigma[k]));
    for (int k = 0; k < 6; k++) CHECK_ABS((S[k] - sigma[k]) / size, 0, 1e-4);
    assert_true(l[0] >= l[1] && l[1] >= l[2]);
    CHECK_ABS(l[0] + l[1] + l[2] - 3, e[0] + e[1] + e[2], 1e-4 * strain + 1e-12);
}

static sn_status keep(void *context, const sn_frame *frame) {
    fields *f = context;
    double volume = 0;
    memset(f->stress, 0, sizeof f->stress);
    memset(f->strain, 0, sizeof f->strain);
    f->energy = f->pressure = 0;
    for (int n = 0; n < f->mesh->cell_count; n++) {
        double v = sn_mesh_cell_volume(f->mesh, n);
        for (int k = 0; k < 6; k++) {
            f->strain[k] += v * frame->fields[2].value[6 * n + k];
            f->stress[k] += v * frame->fields[3].value[6 * n + k];
        }
        f->energy += v * frame->fields[4].value[n];
        volume += v;
        if (f->linear) check_small(frame, n);
    }
    for (int k = 0; k < 6; k++) {
        f->stress[k] /= volume;
        f->strain[k] /= volume;
    }
    for (int n = 0; n < f->mesh->node_count; n++)
        f->pressure += frame->fields[1].value[n] / f->mesh->node_count;
    return SN_OK;
}

// A bent block with fibres under traction, pressure, gravity and a moved end.
static sn_case *loaded(sn_element element, double size) {
    sn_tissue t = guccione(900, element == SN_ELEMENT_P2P1 ? (double)INFINITY : 5e3);
    sn_case *c = body_block(0.03, 0.01, 0.01, 3, 1, 1, &t, element);
    const double fibre[3] = {0.48, 0.6, 0.64};
    memcpy(c->fibre, fibre, sizeof fibre);
    body_support(c, "left", true, true, true);
    body_move(c, "right", ANY, ANY, 1e-3 * size, make_ramp(0, 1));
    body_pull(c, "top", 5 * size, 0, 0, make_ramp(0, 1));
    body_press(c, "back", 10 * size, make_ramp(0, 1));
    body_probe(c, "tip", 0.03, 0.005, 0.005);
    body_reaction(c, "wall", "left");
    c->continuum.tolerance = 1e-11;
    return c;
}

// The two analyses differ by the square of the load: by a quarter for half of it, relative to it by
// a half. Differences above 1e-9 of the value are counted.
static void limit(void **state) {
    (void)state;
    static const char *const column[] = {"tip_ux", "wall_fx", "wall_fz"};
    for (int e = 0; e < 3; e++) {
        double difference[2][5];
        for (int half = 0; half < 2; half++) {
            double value[2][5];
            for (int linear = 0; linear < 2; linear++) {
                sn_case *c = loaded((sn_element)e, half ? 0.01 : 0.02);
                if (linear) c->continuum.analysis = SN_ANALYSIS_LINEAR;
                fields f = {.mesh = c->mesh, .linear = linear};
                sn_output output = {.context = &f, .frame = keep};
                sn_run_summary s;
                sn_record *r = body_run(c, &output, &s);
                for (int k = 0; k < 3; k++) value[linear][k] = last_value(r, column[k]);
                value[linear][3] = f.stress[0];
                value[linear][4] = f.pressure;
                if (linear) {
                    assert_int_equal(s.newton_iterations, 2); // one solution a stop: 0 and 1 s
                    // work of a linear path, and the energy of its end
                    CHECK_REL(s.elastic_J, s.external_work_J, 1e-6);
                    CHECK_REL(f.energy, s.elastic_J, 1e-5);
                }
                sn_record_destroy(r);
                sn_case_destroy(c);
            }
            for (int k = 0; k < 5; k++)
                difference[half][k] = (value[0][k] - value[1][k]) / value[1][k];
        }
        for (int k = 0; k < 5; k++) {
            if (getenv("SINEW_SHOW"))
                print_message("element %d, %d: %.3g %.3g\n", e, k, difference[0][k],
                              difference[1][k]);
            assert_true(fabs(difference[0][k]) > 1e-8 && fabs(difference[0][k]) < 0.1);
            CHECK_REL(difference[0][k] / difference[1][k], 2, 0.05);
        }
    }
}

// Twice the load gives twice of all to rounding, however large, with no iteration; a strain of 300
// % is no obstacle. Uniaxial closed form: E = 9 K G/(3 K + G).
static void homogeneous(void **state) {
    (void)state;
    const double G = 3000, K = 6000, E = 9 * K * G / (3 * K + G);
    sn_tissue t = neo_hookean(G, K);
    for (int e = 0; e < 3; e++) {
        sn_case *c = body_block(0.03, 0.02, 0.015, 2, 1, 1, &t, (sn_element)e);
        body_rollers(c);
        body_pull(c, "right", 3 * E, 0, 0, make_ramp(0, 1));
        body_probe(c, "tip", 0.03, 0.02, 0.015);
        body_reaction(c, "wall", "left");
        c->continuum.analysis = SN_ANALYSIS_LINEAR;
        c->output_every = 0.5;
        fields f = {.mesh = c->mesh};
        sn_output output = {.context = &f, .frame = keep};
        sn_run_summary s;
        sn_record *r = body_run(c, &output, &s);
        CHECK_REL(last_value(r, "tip_ux"), 3 * 0.03, 1e-10);
        CHECK_REL(sn_record_values(r, "tip_ux")[1], 1.5 * 0.03, 1e-10);
        CHECK_REL(last_value(r, "tip_uy"), -3 * 0.02 * (E / (2 * G) - 1), 1e-10);
        CHECK_REL(last_value(r, "wall_fx"), -3 * E * 3e-4, 1e-7); // probed at a strain of 1e-5
        CHECK_REL(f.stress[0], 3 * E, 1e-7);
        CHECK_REL(f.strain[0], 3, 1e-7);
        CHECK_ABS(f.stress[1] / E, 0, 1e-6);
        CHECK_REL(f.pressure, -E, 1e-6);
        CHECK_REL(s.elastic_J, 0.5 * 9 * E * 9e-6, 1e-6);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// Factors of large systems are rough (solver.c), and the solution must not be: uniaxial closed
// form at K/G = 50, to the 1e-10 of the solver times the condition of the system.
static void large_systems(void **state) {
    (void)state;
    const double G = 3000, K = 150e3, E = 9 * K * G / (3 * K + G);
    sn_tissue t = neo_hookean(G, K);
    sn_case *c = body_block(0.03, 0.02, 0.02, 12, 8, 8, &t, SN_ELEMENT_P2P1);
    body_rollers(c);
    body_pull(c, "right", 0.01 * E, 0, 0, make_ramp(0, 1));
    body_probe(c, "tip", 0.03, 0.02, 0.02);
    body_reaction(c, "wall", "left");
    c->continuum.analysis = SN_ANALYSIS_LINEAR;
    sn_run_summary s;
    sn_record *r = body_run(c, NULL, &s);
    assert_true(s.unknowns > 20000); // else the factors are not rough
    CHECK_REL(last_value(r, "tip_ux"), 0.01 * 0.03, 1e-8);
    CHECK_REL(last_value(r, "wall_fx"), -0.01 * E * 4e-4, 1e-7); // probed at a strain of 1e-5
    sn_record_destroy(r);
    sn_case_destroy(c);
}

static void refusals(void **state) {
    (void)state;
    sn_run_summary s;
    sn_record *r;
    CHECK_OK(sn_record_create("test", &r));
    sn_case *c = loaded(SN_ELEMENT_P1, 1);
    c->continuum.analysis = SN_ANALYSIS_LINEAR;
    const double prony[] = {0.4, 0.01};
    body_set_memory(c->tissue, "prony", 1, prony, 2);
    CHECK_FAILS(sn_continuum_run(c, NULL, &s, r), SN_E_UNSUPPORTED, "memory");
    c->tissue->memory = sn_memory_none();
    c->tool[c->tool_count++] =
        (sn_tool){.name = "ball", .radius = 0.003, .at = {0.015, 0.005, 0.02}};
    CHECK_FAILS(sn_continuum_run(c, NULL, &s, r), SN_E_UNSUPPORTED, "contact");
    sn_record_destroy(r);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(limit), cmocka_unit_test(homogeneous),
                                       cmocka_unit_test(large_systems), cmocka_unit_test(refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
