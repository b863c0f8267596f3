// Fibres that turn from cell to cell: both engines on one mesh.
// SPDX-License-Identifier: Apache-2.0
#include "engines.h"
#include "parts.h"

// A tube of hgo whose fibres wind from 60 to -60 degrees through the wall, opened by a pressure and
// pulled.
static sn_case *tube(bool file) {
    static const char *const name[] = {"mu", "k1", "k2"};
    const double value[] = {9e3, 12e3, 1.1}, turn = 1.0471975511965976;
    sn_tissue t = artery(0, 0.1, 0.6, 2e5);
    for (int k = 0; k < 3; k++) CHECK_OK(sn_tissue_set(&t, name[k], value[k]));
    sn_case *c = make_case(&(sn_shape_def){.shape = SN_SHAPE_TUBE,
                                           .inner_radius = 5e-3,
                                           .outer_radius = 8e-3,
                                           .length = 4e-3,
                                           .cells = {2, 12, 2}},
                           &t);
    c->fibres = (sn_fibres){.rule = SN_FIBRES_AROUND,
                            .axis = {0, 0, 1},
                            .angle = {turn, -turn},
                            .wall = {surface_of(c, "inner"), surface_of(c, "outer")}};
    if (file) { // the same, cell by cell
        double axes[9], *field;
        CHECK_OK(sn_case_axes_field(c, axes, &field));
        c->fibres = (sn_fibres){.rule = SN_FIBRES_LISTED, .count = c->mesh->cell_count};
        c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
        for (int k = 0; k < c->mesh->cell_count; k++)
            memcpy(c->fibres.listed + 6 * k, field + 9 * k, 6 * sizeof(double));
        sn_free(field);
    }
    add_support(c, "bottom", "xyz");
    add_load(c, SN_LOAD_PRESSURE, "inner", 0, 0, 0, 1)->pressure = 2e3;
    add_load(c, SN_LOAD_TRACTION, "top", 0, 0, 2e3, 1);
    add_probe(c, "rim", SN_PROBE_POINT, NULL, 5e-3, 0, 4e-3);
    add_probe(c, "hold", SN_PROBE_REACTION, "bottom", 0, 0, 0);
    c->until = c->output_every = 1;
    c->springs.rung = SN_RUNG_COUPLED;
    c->springs.volume = false;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->continuum.element = SN_ELEMENT_P1;
    c->continuum.steps = 5;
    c->continuum.tolerance = 1e-11;
    return c;
}

// Coupled springs are linear elements, with axes of their own in every cell too; residuals of 1e-10
// against a condition of some thousands. Listed, the rule's axes are rounded once more.
static void coupled_springs_are_linear_elements(void **state) {
    (void)state;
    static const char *const column[] = {"rim_ux", "rim_uy", "rim_uz"};
    sn_case *c = tube(false), *listed = tube(true);
    sn_run_summary summary[3];
    sn_record *of[3] = {run_engine(sn_continuum_run, c, NULL, &summary[0]),
                        run_engine(sn_springs_run, c, NULL, &summary[1]),
                        run_engine(sn_springs_run, listed, NULL, &summary[2])};
    const double size = last_value(of[0], "rim_ux");
    assert_true(size > 1e-5);
    assert_true(fabs(last_value(of[0], "rim_uy")) > 0.01 * size); // it twists
    for (int n = 1; n < 3; n++) {
        for (int i = 0; i < 3; i++)
            CHECK_ABS((last_value(of[n], column[i]) - last_value(of[0], column[i])) / size, 0,
                      1e-8);
        CHECK_REL(last_value(of[n], "hold_fz"), last_value(of[0], "hold_fz"), 1e-8);
        CHECK_REL(summary[n].elastic_J, summary[0].elastic_J, 1e-8);
    }
    for (int n = 0; n < 3; n++) sn_record_destroy(of[n]);

    // the same with one direction is another body: the comparison sees the fibres
    c->fibres = (sn_fibres){0};
    c->fibre[0] = 1;
    sn_record *other = run_engine(sn_springs_run, c, NULL, &summary[0]);
    assert_true(fabs(last_value(other, "rim_ux") - size) > 0.05 * size);
    sn_record_destroy(other);
    sn_case_destroy(c);
    sn_case_destroy(listed);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(coupled_springs_are_linear_elements)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
