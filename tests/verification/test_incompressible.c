// Nearly incompressible: springs with the nodal volume term against mixed finite elements.
// SPDX-License-Identifier: Apache-2.0
#include "laws.h"

#include "sinew/sinew.h"

/// What the last frame shows.
typedef struct seen {
    const sn_mesh *mesh;
    double volume; ///< over that at rest
} seen;

static double volume_of(const sn_mesh *mesh, const double *u) {
    double sum = 0;
    for (int e = 0; e < mesh->cell_count; e++) {
        double x[4][3], d[3][3];
        for (int a = 0; a < 4; a++)
            for (int k = 0; k < 3; k++) {
                int at = 3 * mesh->cell[4 * e + a] + k;
                x[a][k] = mesh->node[at] + (u ? u[at] : 0.0);
            }
        for (int a = 0; a < 3; a++)
            for (int k = 0; k < 3; k++) d[a][k] = x[a + 1][k] - x[0][k];
        sum += (d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
                d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
                d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])) /
               6.0;
    }
    return sum;
}

static sn_status look(void *context, const sn_frame *frame) {
    seen *s = context;
    for (int k = 0; k < frame->field_count; k++)
        if (strcmp(frame->fields[k].name, "displacement") == 0)
            s->volume = volume_of(s->mesh, frame->fields[k].value) / volume_of(s->mesh, NULL);
    return SN_OK;
}

// a quarter of a clamped bar, Poisson's ratio 0.4999, drawn by a traction to about 1.3 of its
// length
static sn_case *bar(void) {
    const double E = 1e4, nu = 0.4999;
    sn_case *c;
    CHECK_OK(sn_case_create(&c));
    c->shape =
        (sn_shape_def){.shape = SN_SHAPE_BLOCK, .size = {0.04, 0.01, 0.01}, .cells = {16, 4, 4}};
    c->has_shape = true;
    CHECK_OK(sn_mesh_build(&c->shape, &c->mesh));
    c->tissue = sn_alloc(1, sizeof *c->tissue);
    c->tissue[0] = sn_tissue_default();
    c->tissue[0].law = sn_law_find("neo-hookean");
    CHECK_OK(sn_tissue_set(&c->tissue[0], "shear_modulus", E / (2 + 2 * nu)));
    CHECK_OK(sn_tissue_set(&c->tissue[0], "bulk_modulus", E / (3 - 6 * nu)));
    c->support_count = 3;
    c->support = sn_alloc(3, sizeof *c->support);
    c->support[0] = (sn_support){sn_mesh_surface(c->mesh, "left"), {true, true, true}};
    c->support[1] = (sn_support){sn_mesh_surface(c->mesh, "front"), {false, true, false}};
    c->support[2] = (sn_support){sn_mesh_surface(c->mesh, "bottom"), {false, false, true}};
    c->load_count = 1;
    c->load = sn_alloc(1, sizeof *c->load);
    c->load[0] = (sn_load){.kind = SN_LOAD_TRACTION,
                           .surface = sn_mesh_surface(c->mesh, "right"),
                           .vector = {2450, 0, 0}};
    CHECK_OK(sn_history_create(1, 2, (double[]){0, 1}, (double[]){0, 1}, &c->load[0].factor));
    c->probe_count = 1;
    c->probe = sn_alloc(1, sizeof *c->probe);
    c->probe[0] = (sn_probe){.name = "tip", .kind = SN_PROBE_POINT, .point = {0.04, 0, 0}};
    c->until = 1;
    c->output_every = 0.1;
    c->springs.volume = true;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->continuum.element = SN_ELEMENT_P2P1;
    c->continuum.steps = 5;
    return c;
}

typedef sn_status engine(const sn_case *, const sn_output *, sn_run_summary *, sn_record *);

static double tip(engine *run, const sn_case *c, seen *s) {
    sn_record *history;
    sn_run_summary summary = {0};
    CHECK_OK(sn_record_create("run", &history));
    CHECK_OK(run(c, &(sn_output){.context = s, .frame = look}, &summary, history));
    if (!summary.converged) print_message("%s\n", summary.reason);
    assert_true(summary.converged);
    double x = sn_record_values(history, "tip_ux")[history->rows - 1];
    sn_record_destroy(history);
    return x;
}

static void block_keeps_its_volume(void **state) {
    (void)state;
    sn_case *c = bar();
    seen s = {.mesh = c->mesh};
    c->springs.rung = SN_RUNG_COUPLED;
    double ours = tip(sn_springs_run, c, &s);
    CHECK_ABS(s.volume, 1, 1e-3);
    double mixed = tip(sn_continuum_run, c, &s);
    assert_true(mixed > 0.27 * 0.04 && mixed < 0.33 * 0.04);
    CHECK_REL(ours, mixed, 0.02);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(block_keeps_its_volume)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
