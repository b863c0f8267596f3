// Comparisons as a whole: what must be equal is, what is known in closed form comes out, what is
// missing is said.
// SPDX-License-Identifier: Apache-2.0
#include "check.h"

#include "sinew/compare.h"

static sn_history *knots(int count, const double *time, const double *value) {
    sn_history *history;
    CHECK_OK(sn_history_create(1, count, time, value, &history));
    return history;
}

// a block of 40 x 20 x 20 mm, clamped left, its right face moved along x and y, ramp and hold
static sn_case *block(int along, const char *law, double bulk) {
    sn_case *c;
    CHECK_OK(sn_case_create(&c));
    c->shape = (sn_shape_def){.shape = SN_SHAPE_BLOCK,
                              .size = {0.04, 0.02, 0.02},
                              .cells = {along, along / 2, along / 2}};
    c->has_shape = true;
    CHECK_OK(sn_mesh_build(&c->shape, &c->mesh));
    c->tissue = sn_alloc(1, sizeof *c->tissue);
    *c->tissue = sn_tissue_default();
    c->tissue->law = sn_law_find(law);
    CHECK_OK(sn_tissue_set(c->tissue, strcmp(law, "demiray") ? "shear_modulus" : "c", 3e3));
    if (!strcmp(law, "demiray")) CHECK_OK(sn_tissue_set(c->tissue, "b", 3));
    CHECK_OK(sn_tissue_set(c->tissue, "bulk_modulus", bulk));
    c->tissue->memory = sn_memory_none();
    c->support_count = 1;
    c->support = sn_alloc(1, sizeof *c->support);
    c->support[0] =
        (sn_support){.surface = sn_mesh_surface(c->mesh, "left"), .fix = {true, true, true}};
    c->load_count = 1;
    c->load = sn_alloc(1, sizeof *c->load);
    c->load[0] = (sn_load){.kind = SN_LOAD_DISPLACEMENT,
                           .surface = sn_mesh_surface(c->mesh, "right"),
                           .vector = {6e-3, 8e-3, 0},
                           .factor = knots(2, (double[]){0, 1}, (double[]){0, 1})};
    c->until = 1;
    c->output_every = 0.5;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->springs.step = 0.5;
    c->continuum.steps = 2;
    return c;
}

static int model(const char *name) {
    for (int k = 0; k < sn_compare_model_count(); k++)
        if (!strcmp(sn_compare_model_name(k), name)) return k;
    fail_msg("no model %s", name);
    return -1;
}

// The energy of the coupled rung without volume term is that of linear tetrahedra, so both have one
// equilibrium. Both stop at a residual of 1e-9 of the forces; the condition of this small system
// leaves a factor of some hundreds.
static void coupled_is_p1(void **state) {
    (void)state;
    const char *laws[] = {"neo-hookean", "demiray"};
    for (int k = 0; k < 2; k++) {
        sn_case *c = block(4, laws[k], 3e4);
        const int models[] = {model("coupled"), model("P1"), model("coupled+volume")};
        sn_comparison r;
        c->continuum.tolerance = 1e-9;
        CHECK_OK(sn_compare(c, 3, models, NULL, &r));
        const sn_comparison_model *a = &r.model[0], *b = &r.model[1], *other = &r.model[2];
        assert_true(a->done && b->done);
        double apart = 0, other_apart = 0;
        for (int i = 0; i < 3 * a->points; i++) {
            apart = fmax(apart, fabs(a->displacement[i] - b->displacement[i]));
            other_apart = fmax(other_apart, fabs(other->displacement[i] - b->displacement[i]));
        }
        CHECK_ABS(apart / 0.01, 0, 1e-6);       // 10 mm is the largest motion
        assert_true(other_apart / 0.01 > 1e-3); // and models do differ
        for (int i = 1; i < a->response->rows; i++)
            CHECK_REL(a->response->series[2].value[i], b->response->series[2].value[i], 1e-6);
        CHECK_ABS(a->error.displacement_rms, b->error.displacement_rms, 1e-6);
        assert_true(b->error.displacement_rms > 1e-3);
        sn_comparison_destroy(&r);
        sn_case_destroy(c);
    }
}

// Every rung has the memory exactly. At small strain, 0.6 %, what is left without the elastic error
// is the square of that strain, 4e-5, times a few. At large strain, 30 %, the law that takes the
// elastic error out is only near the truth (strains do not follow the motion when the stress has
// relaxed), and springs go by steps of an eighth of a second, the reference by shorter ones: a
// quarter of a per cent is measured.
static void memory_is_exact(void **state) {
    (void)state;
    const double hold[2][3] = {{0, 0.5, 3}, {0, 1, 1}};
    const double cycle[2][5] = {{0, 0.5, 1, 1.5, 2}, {0, 1, 0.2, 1, 0.2}};
    for (int turn = 0; turn < 4; turn++) {
        const bool cyclic = turn & 1, small = turn < 2;
        sn_case *c = block(4, "demiray", 3e4);
        for (int d = 0; d < 3 && small; d++) c->load[0].vector[d] *= 0.02;
        sn_memory *m = &c->tissue->memory;
        m->law = sn_memory_law_find("prony");
        m->terms = 2;
        memcpy(m->value, (double[]){0.3, 0.2, 0.2, 2}, 4 * sizeof(double)); // g, then tau
        sn_history_destroy(c->load[0].factor);
        c->load[0].factor = cyclic ? knots(5, cycle[0], cycle[1]) : knots(3, hold[0], hold[1]);
        c->until = cyclic ? 2 : 3;
        c->output_every = c->springs.step = 0.125;
        c->continuum.steps = (int)(c->until / 0.125);
        const int models[] = {model("central+volume"), model("coupled+volume"),
                              model("smoothed+volume"), model("P1")};
        sn_comparison r;
        CHECK_OK(sn_compare(c, 4, models, NULL, &r));
        for (int k = 0; k < 4; k++) {
            assert_true(r.model[k].done);
            print_message("%s %s, %s: force %.2f %%, without its elastic error %.3f %%\n",
                          small ? "small" : "large", cyclic ? "cycles" : "hold", r.model[k].name,
                          100 * r.model[k].error.response_rms,
                          100 * r.model[k].error.relaxation_max);
            CHECK_ABS(r.model[k].error.relaxation_max, 0, small ? 2e-4 : 0.005);
            // forces of the same motion without memory are there, and never less
            const sn_record *force = r.model[k].response, *elastic = r.model[k].elastic;
            assert_non_null(elastic);
            assert_int_equal(elastic->rows, force->rows);
            assert_true(elastic->series[2].value[8] > 1.1 * force->series[2].value[8]);
        }
        // the elastic error is there to be taken out, and the force does relax
        assert_true(r.model[3].error.response_rms > 0.02);
        const sn_record *truth = r.reference.model.response;
        if (!cyclic)
            assert_true(truth->series[2].value[truth->rows - 1] < 0.7 * truth->series[2].value[4]);
        sn_comparison_destroy(&r);
        sn_case_destroy(c);
    }
}

// What is prescribed and what answers, of a traction, against numbers by hand.
static void responses(void **state) {
    (void)state;
    sn_case *c = block(4, "neo-hookean", 3e4);
    c->load[0].kind = SN_LOAD_TRACTION;
    memcpy(c->load[0].vector, (double[]){30, 40, 0}, sizeof c->load[0].vector);
    sn_comparison r;
    const int models[] = {model("smoothed+volume")};
    CHECK_OK(sn_compare(c, 1, models, NULL, &r));
    const sn_record *answer = r.model[0].response;
    assert_int_equal(answer->series_count, 3);
    assert_string_equal(answer->series[1].name, "right_force");
    assert_string_equal(answer->series[2].name, "right_displacement");
    CHECK_REL(answer->series[1].value[1], 0.5 * 50 * 4e-4, 1e-12); // half of 50 Pa on 4 cm2
    assert_true(answer->series[2].value[2] > 0);
    // one load: the error of its motion at two output times, the first being zero
    const double *x = answer->series[2].value, *y = r.reference.model.response->series[2].value;
    double squares = pow(x[1] - y[1], 2) + pow(x[2] - y[2], 2);
    CHECK_REL(r.model[0].error.response_rms, sqrt(squares / 3) / y[2], 1e-12);
    assert_true(isnan(r.model[0].error.reaction_rms));   // no probe, no tool
    assert_true(isnan(r.model[0].error.relaxation_max)); // no memory
    assert_null(r.model[0].elastic);
    assert_true(r.reference.model.error.response_rms > 0);
    sn_comparison_destroy(&r);
    sn_case_destroy(c);
}

// Halved cells: what P1 errs by goes down, and the estimate of the reference's own error covers
// its distance to a reference on a finer mesh.
static void reference_error(void **state) {
    (void)state;
    sn_case *c = block(4, "neo-hookean", 1.5e4), *fine;
    sn_reference own, better;
    sn_comparison_model p1[2];
    CHECK_OK(sn_compare_mesh(c, 2, &fine));
    assert_int_equal(fine->shape.cells[0], 8);
    CHECK_OK(sn_reference_create(c, NULL, NULL, &own));
    CHECK_OK(sn_reference_create(fine, c, NULL, &better));
    CHECK_OK(sn_compare_model(&better, c, model("P1"), NULL, &p1[0]));
    CHECK_OK(sn_compare_model(&better, fine, model("P1"), NULL, &p1[1]));
    assert_true(p1[1].error.displacement_rms < 0.5 * p1[0].error.displacement_rms);
    assert_true(p1[1].error.response_rms < 0.5 * p1[0].error.response_rms);
    const sn_record *a = own.model.response, *b = better.model.response;
    double distance = fabs(a->series[2].value[a->rows - 1] / b->series[2].value[b->rows - 1] - 1);
    print_message("reference's force: off by %.3f %%, estimated %.3f %%\n", 100 * distance,
                  100 * own.model.error.response_rms);
    // a third of the distance to a coarser mesh is the error where the order is 2; the clamped
    // edges make it less, up to 2 times
    assert_true(own.model.error.response_rms > 0.5 * distance);
    assert_true(better.model.error.response_rms < own.model.error.response_rms);
    for (int k = 0; k < 2; k++) sn_comparison_model_release(&p1[k]);
    sn_reference_release(&own);
    sn_reference_release(&better);
    sn_case_destroy(fine);
    sn_case_destroy(c);
}

static void what_is_missing(void **state) {
    (void)state;
    sn_case *c = block(2, "neo-hookean", (double)INFINITY), *other;
    char why[SN_TEXT_MAX];
    sn_comparison r;
    const int models[] = {model("coupled"), model("P1")};
    // an incompressible tissue has no linear elements
    CHECK_OK(sn_compare(c, 2, models, NULL, &r));
    for (int k = 0; k < 2; k++) {
        assert_false(r.model[k].done);
        assert_true(r.model[k].summary.reason[0]);
        assert_true(isnan(r.model[k].error.displacement_rms));
    }
    assert_true(r.reference.model.done);
    sn_comparison_destroy(&r);
    // rungs without volume are for who asks
    assert_false(sn_compare_model_fits(c, model("central"), why));
    assert_non_null(strstr(why, "Poisson"));
    assert_true(sn_compare_model_fits(c, model("central+volume"), why));
    CHECK_OK(sn_tissue_set(c->tissue, "bulk_modulus", 5e3)); // nu = 1/4
    assert_true(sn_compare_model_fits(c, model("central"), why));
    // meshes
    CHECK_FAILS(sn_compare_mesh(c, 0, &other), SN_E_RANGE, "mesh 0");
    c->has_shape = false;
    CHECK_FAILS(sn_compare_mesh(c, 3, &other), SN_E_RANGE, "1, 2, 4");
    CHECK_OK(sn_compare_mesh(c, 2, &other));
    assert_int_equal(other->mesh->cell_count, 8 * c->mesh->cell_count);
    sn_case_destroy(other);
    // a reference that cannot end: a step of the whole motion, turned inside out
    c->load[0].vector[0] = -0.1;
    c->continuum.tolerance = 1e-8;
    sn_reference reference;
    CHECK_OK(sn_reference_create(c, NULL, NULL, &reference));
    assert_false(reference.model.done);
    assert_int_equal(strncmp(reference.text, "NONE", 4), 0);
    sn_comparison_model out;
    CHECK_FAILS(sn_compare_model(&reference, c, model("P1"), NULL, &out), SN_E_DEFINITION,
                "no reference");
    sn_reference_release(&reference);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coupled_is_p1),   cmocka_unit_test(memory_is_exact),
        cmocka_unit_test(responses),       cmocka_unit_test(reference_error),
        cmocka_unit_test(what_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
