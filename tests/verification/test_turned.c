// Fibres that turn from cell to cell: both engines on one mesh.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "check.h"
#include "sinew/continuum.h"
#include "sinew/springs.h"

// A tube of hgo whose fibres wind from 60 to -60 degrees through the wall, opened by a pressure and
// pulled.
static sn_case *artery(bool file) {
    static const char *const name[] = {"mu", "k1", "k2", "kappa", "angle", "bulk_modulus"};
    const double value[] = {9e3, 12e3, 1.1, 0.1, 0.6, 2e5}, turn = 1.0471975511965976;
    sn_case *c;
    CHECK_OK(sn_case_create(&c));
    c->shape = (sn_shape_def){.shape = SN_SHAPE_TUBE,
                              .inner_radius = 5e-3,
                              .outer_radius = 8e-3,
                              .length = 4e-3,
                              .cells = {2, 12, 2}};
    c->has_shape = true;
    CHECK_OK(sn_mesh_build(&c->shape, &c->mesh));
    c->tissue = sn_alloc(1, sizeof *c->tissue);
    c->tissue[0] = sn_tissue_default();
    c->tissue[0].law = sn_law_find("hgo");
    sn_param_defaults(c->tissue->law->params, c->tissue->law->param_count, 0, c->tissue->value);
    for (int k = 0; k < 6; k++) CHECK_OK(sn_tissue_set(c->tissue, name[k], value[k]));
    c->fibres =
        (sn_fibres){.rule = SN_FIBRES_AROUND,
                    .axis = {0, 0, 1},
                    .angle = {turn, -turn},
                    .wall = {sn_mesh_surface(c->mesh, "inner"), sn_mesh_surface(c->mesh, "outer")}};
    if (file) { // the same, cell by cell
        double axes[9], *field;
        CHECK_OK(sn_case_axes_field(c, axes, &field));
        c->fibres = (sn_fibres){.rule = SN_FIBRES_LISTED, .count = c->mesh->cell_count};
        c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
        for (int k = 0; k < c->mesh->cell_count; k++)
            memcpy(c->fibres.listed + 6 * k, field + 9 * k, 6 * sizeof(double));
        sn_free(field);
    }
    c->support = sn_alloc(1, sizeof *c->support);
    c->support[c->support_count++] =
        (sn_support){sn_mesh_surface(c->mesh, "bottom"), {true, true, true}};
    c->load = sn_alloc(2, sizeof *c->load);
    c->load[c->load_count++] = (sn_load){
        .kind = SN_LOAD_PRESSURE, .surface = sn_mesh_surface(c->mesh, "inner"), .pressure = 2e3};
    c->load[c->load_count++] = (sn_load){.kind = SN_LOAD_TRACTION,
                                         .surface = sn_mesh_surface(c->mesh, "top"),
                                         .vector = {0, 0, 2e3}};
    for (int k = 0; k < 2; k++)
        CHECK_OK(sn_history_create(1, 2, (double[]){0, 1}, (double[]){0, 1}, &c->load[k].factor));
    c->probe = sn_alloc(2, sizeof *c->probe);
    c->probe[c->probe_count++] =
        (sn_probe){.name = "rim", .kind = SN_PROBE_POINT, .point = {5e-3, 0, 4e-3}};
    c->probe[c->probe_count++] = (sn_probe){
        .name = "hold", .kind = SN_PROBE_REACTION, .surface = sn_mesh_surface(c->mesh, "bottom")};
    c->until = c->output_every = 1;
    c->springs.rung = SN_RUNG_COUPLED;
    c->springs.volume = false;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->continuum.element = SN_ELEMENT_P1;
    c->continuum.steps = 5;
    c->continuum.tolerance = 1e-11;
    return c;
}

typedef sn_status engine(const sn_case *, const sn_output *, sn_run_summary *, sn_record *);

static sn_record *run(engine *with, const sn_case *c, sn_run_summary *summary) {
    sn_record *history;
    CHECK_OK(sn_record_create("run", &history));
    CHECK_OK(with(c, &(sn_output){0}, summary, history));
    if (!summary->converged) print_message("%s\n", summary->reason);
    assert_true(summary->converged);
    return history;
}

static double last(const sn_record *r, const char *column) {
    return sn_record_values(r, column)[r->rows - 1];
}

// Coupled springs are linear elements, with axes of their own in every cell too; residuals of 1e-10
// against a condition of some thousands. Listed, the rule's axes are rounded once more.
static void coupled_springs_are_linear_elements(void **state) {
    (void)state;
    static const char *const column[] = {"rim_ux", "rim_uy", "rim_uz"};
    sn_case *c = artery(false), *listed = artery(true);
    sn_run_summary summary[3];
    sn_record *of[3] = {run(sn_continuum_run, c, &summary[0]), run(sn_springs_run, c, &summary[1]),
                        run(sn_springs_run, listed, &summary[2])};
    const double size = last(of[0], "rim_ux");
    assert_true(size > 1e-5);
    assert_true(fabs(last(of[0], "rim_uy")) > 0.01 * size); // it twists
    for (int n = 1; n < 3; n++) {
        for (int i = 0; i < 3; i++)
            CHECK_ABS((last(of[n], column[i]) - last(of[0], column[i])) / size, 0, 1e-8);
        CHECK_REL(last(of[n], "hold_fz"), last(of[0], "hold_fz"), 1e-8);
        CHECK_REL(summary[n].elastic_J, summary[0].elastic_J, 1e-8);
    }
    for (int n = 0; n < 3; n++) sn_record_destroy(of[n]);

    // the same with one direction is another body: the comparison sees the fibres
    c->fibres = (sn_fibres){0};
    c->fibre[0] = 1;
    sn_record *other = run(sn_springs_run, c, &summary[0]);
    assert_true(fabs(last(other, "rim_ux") - size) > 0.05 * size);
    sn_record_destroy(other);
    sn_case_destroy(c);
    sn_case_destroy(listed);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(coupled_springs_are_linear_elements)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
