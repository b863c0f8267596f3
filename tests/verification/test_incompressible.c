// Nearly incompressible: springs with the nodal volume term against mixed finite elements.
// SPDX-License-Identifier: Apache-2.0
#include "build.h"
#include "engines.h"

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
    const sn_tissue t = neo_hookean(E / (2 + 2 * nu), E / (3 - 6 * nu));
    sn_case *c = make_block((const double[]){0.04, 0.01, 0.01}, (const int[]){16, 4, 4},
                            SN_PATTERN_MIRRORED, &t);
    add_support(c, "left", "xyz");
    add_support(c, "front", "y");
    add_support(c, "bottom", "z");
    add_load(c, SN_LOAD_TRACTION, "right", 2450, 0, 0, 1);
    add_probe(c, "tip", SN_PROBE_POINT, NULL, 0.04, 0, 0);
    c->springs.volume = true;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->continuum.element = SN_ELEMENT_P2P1;
    c->continuum.steps = 5;
    return c;
}

static double tip(engine *run, const sn_case *c, seen *s) {
    sn_run_summary summary = {0};
    sn_record *history = run_engine(run, c, &(sn_output){.context = s, .frame = look}, &summary);
    const double x = last_value(history, "tip_ux");
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
