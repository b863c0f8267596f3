// Richardson extrapolation over meshes: known answers, observed order, what does not converge.
// SPDX-License-Identifier: Apache-2.0
#include "body.h"

static const sn_refined *quantity(const sn_refinement *r, const char *name) {
    for (int k = 0; k < r->count; k++)
        if (strcmp(r->quantity[k].name, name) == 0) return r->quantity + k;
    fail_msg("no quantity %s", name);
    return NULL;
}

// A thick tube under pressure between frictionless plates at small strain (Lame): displacement of
// the inner wall (1 + nu)/E p a^2/(b^2 - a^2) ((1 - 2 nu) a + b^2/a). The polygon of the straight
// cells is part of the error, of second order; the meshes are built anew, so it vanishes too.
static void tube(void **state) {
    (void)state;
    const double a = 0.01, b = 0.02, G = 3000, K = 6000, pressure = 0.03;
    const double E = 9 * K * G / (3 * K + G), nu = E / (2 * G) - 1;
    double exact =
        (1 + nu) / E * pressure * a * a / (b * b - a * a) * ((1 - 2 * nu) * a + b * b / a);
    sn_shape_def def = {.shape = SN_SHAPE_TUBE,
                        .inner_radius = a,
                        .outer_radius = b,
                        .length = 0.004,
                        .cells = {2, 12, 1}};
    for (int e = 0; e < 2; e++) {
        sn_tissue t = neo_hookean(G, K);
        sn_case *c = body_case(&def, &t, e ? SN_ELEMENT_P2 : SN_ELEMENT_P1);
        c->shape = def;
        c->has_shape = true;
        body_support(c, "bottom", false, false, true);
        body_support(c, "top", false, false, true);
        body_press(c, "inner", pressure, NULL);
        body_probe(c, "wall", a, 0, 0.002);
        body_reaction(c, "plate", "top");
        sn_record *r;
        sn_run_summary s;
        sn_refinement f;
        CHECK_OK(sn_record_create("tube", &r));
        CHECK_OK(sn_continuum_refine(c, 3, NULL, &s, r, &f));
        assert_int_equal(f.meshes, 3);
        assert_int_equal(f.count, r->series_count);
        const sn_refined *q = quantity(&f, "wall_ux");
        if (getenv("SINEW_SHOW"))
            print_message("%s: exact %.5g, meshes %.5g %.5g %.5g, order %.2f, extrapolated %.5g, "
                          "errors %.2g %.2g %.2g\n",
                          s.model, exact, q->value[0], q->value[1], q->value[2], q->order,
                          q->extrapolated, q->error[0], q->error[1], q->error[2]);
        CHECK_REL(q->value[0], last_value(r, "wall_ux"), 1e-15); // the case's own mesh
        assert_int_equal(s.nodes, f.run[0].nodes);
        assert_true(f.run[2].cells == 64 * f.run[0].cells);
        assert_true(q->observed && q->order > 1.4 && q->order < 2.6);
        // the estimate holds the true error, and is not many times as large
        for (int k = 0; k < 3; k++) {
            double true_error = fabs(q->value[k] - exact);
            assert_true(q->error[k] > true_error && q->error[k] < 2.5 * true_error);
        }
        assert_true(fabs(q->extrapolated - exact) < 0.7 * fabs(q->value[2] - exact));
        assert_true(quantity(&f, "plate_fz")->error[0] > 0);
        assert_string_equal(quantity(&f, "elastic_J")->unit, "J");
        sn_refinement_release(&f);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// A state that every mesh holds exactly: no order to observe, and no error but the solver's.
static void homogeneous(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3000, 6000);
    for (int meshes = 2; meshes <= 3; meshes++) {
        sn_case *c = body_block(0.01, 0.01, 0.01, 1, 1, 1, &t, SN_ELEMENT_P1);
        body_rollers(c);
        body_move(c, "right", 0.002, ANY, ANY, make_ramp(0, 1));
        body_reaction(c, "pull", "right"); // no has_shape: the mesh is split
        sn_record *r;
        sn_run_summary s;
        sn_refinement f;
        CHECK_OK(sn_record_create("block", &r));
        CHECK_OK(sn_continuum_refine(c, meshes, NULL, &s, r, &f));
        assert_int_equal(f.meshes, meshes);
        const sn_refined *q = quantity(&f, "pull_fx");
        assert_false(q->observed);
        CHECK_REL(q->extrapolated, q->value[0], 1e-8);
        for (int k = 0; k < meshes; k++) assert_true(q->error[k] <= 1e-8 * q->value[0]);
        assert_true(f.run[1].cells == 8 * f.run[0].cells);
        sn_refinement_release(&f);
        CHECK_FAILS(sn_continuum_refine(c, meshes == 2 ? 1 : 4, NULL, &s, r, &f), SN_E_RANGE,
                    "2 or 3");
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// A finer mesh that does not get to the end is named; the case's own results stay.
static void gives_up(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(2000, 1e4);
    sn_case *c = body_block(0.01, 0.01, 0.01, 1, 1, 1, &t, SN_ELEMENT_P1);
    body_support(c, "bottom", true, true, true);
    body_move(c, "top", 0, 0, -0.012, make_ramp(0, 1));
    sn_record *r;
    sn_run_summary s;
    sn_refinement f;
    CHECK_OK(sn_record_create("block", &r));
    CHECK_OK(sn_continuum_refine(c, 2, NULL, &s, r, &f));
    assert_int_equal(f.meshes, 0);
    assert_int_equal(f.count, 0);
    assert_false(s.converged);
    assert_non_null(strstr(f.reason, "mesh 1"));
    sn_refinement_release(&f);
    sn_record_destroy(r);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(tube), cmocka_unit_test(homogeneous),
                                       cmocka_unit_test(gives_up)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
