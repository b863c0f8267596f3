// Error norms against hand-made fields with known answers.
// SPDX-License-Identifier: Apache-2.0
#include "check.h"

#include "compare/norms.h"

// hands a capture two frames in which every node moves by base + amount along x, every cell has the
// stress base + amount in xx and xy
static void two_frames(sn_capture *capture, double amount) {
    double u[8 * 3], s[6 * 6];
    for (int f = 0; f < 2; f++) {
        for (int i = 0; i < capture->nodes * 3; i++) u[i] = i % 3 ? 0.5 : 2.0 * (f + 1) + amount;
        for (int i = 0; i < capture->cells * 6; i++)
            s[i] = i % 6 == 0 || i % 6 == 3 ? 7.0 * f + amount : 0;
        sn_field fields[] = {{"displacement", "m", SN_ON_NODES, 3, u},
                             {"cauchy_stress", "Pa", SN_ON_CELLS, 6, s}};
        CHECK_OK(sn_capture_frame(capture, &(sn_frame){0.25 * f, 2, fields}));
    }
}

static void fields(void **state) {
    (void)state;
    sn_capture a = {.nodes = 8, .cells = 6}, b = {.nodes = 8, .cells = 6};
    two_frames(&a, 0.3);
    two_frames(&b, 0);
    double node[8], cell[6], rms, max;
    for (int i = 0; i < 8; i++) node[i] = 1.0 / 8;
    for (int i = 0; i < 6; i++) cell[i] = 1.0 / 6;
    sn_displacement_error(&a, &b, node, &rms, &max);
    // every node is off by 0.3; rounding of a dozen additions
    CHECK_REL(rms, 0.3, 1e-14);
    CHECK_REL(max, 0.3, 1e-14);
    CHECK_REL(sn_displacement_scale(&b), sqrt(16 + 2 * 0.25), 1e-14);
    // xx counts once, xy twice
    CHECK_REL(sn_stress_error(&a, &b, cell), 0.3 * sqrt(3), 1e-14);
    CHECK_REL(sn_stress_scale(&b), 7 * sqrt(3), 1e-14);
    // one node counts more than the others: only it is off
    for (int i = 0; i < 2; i++) a.displacement[i * 24] = b.displacement[i * 24] + 5;
    for (int i = 0; i < 8; i++) node[i] = i == 0 ? 0.65 : 0.05;
    sn_displacement_error(&a, &b, node, &rms, &max);
    CHECK_REL(rms, sqrt(0.65 * 25 + 0.35 * 0.09), 1e-14);
    CHECK_REL(max, 5.0, 1e-14);
    sn_capture_release(&a);
    sn_capture_release(&b);
}

static void record(sn_record **r, double factor, double other) {
    CHECK_OK(sn_record_create("r", r));
    static const char *const names[] = {"time",    "tip_ux",  "tip_uy",  "tip_uz",  "pull_fx",
                                        "pull_fy", "pull_fz", "tool_fx", "tool_fy", "tool_fz"};
    for (int k = 0; k < 10; k++) CHECK_OK(sn_record_add_series(*r, names[k], k ? "N" : "s"));
    for (int i = 0; i < 3; i++)
        CHECK_OK(sn_record_append(*r, (double[]){i, 100 * factor, 0, 0, 4.0 * i * factor, 0,
                                                 3.0 * i * factor, 0, other * i, 0}));
}

static void reactions(void **state) {
    (void)state;
    sn_record *a, *b;
    record(&a, 1.02, 6.3);
    record(&b, 1, 6);
    // pull: 2 % of 5 N per row index; rms over 0, 1, 2 is sqrt(5/3), largest force 10 N;
    // tool: 5 % of 6 N, largest 12 N. The displacement columns are no forces.
    CHECK_REL(sn_reaction_error(a, b), 0.3 * sqrt(5.0 / 3) / 12, 1e-12);
    sn_record_destroy(a);
    sn_record_destroy(b);
    CHECK_OK(sn_record_create("none", &a));
    CHECK_OK(sn_record_add_series(a, "time", "s"));
    assert_true(isnan(sn_reaction_error(a, a)));
    sn_record_destroy(a);
}

static void weights_sum_to_one(void **state) {
    (void)state;
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {0.3, 0.1, 0.2}, .cells = {3, 2, 2}};
    sn_mesh *mesh;
    CHECK_OK(sn_mesh_build(&def, &mesh));
    double *node, *cell, sum = 0;
    CHECK_OK(sn_node_weights(mesh, &node));
    CHECK_OK(sn_cell_weights(mesh, &cell));
    for (int i = 0; i < mesh->node_count; i++) sum += node[i];
    CHECK_REL(sum, 1.0, 1e-13);
    sum = 0;
    for (int i = 0; i < mesh->cell_count; i++) sum += cell[i];
    CHECK_REL(sum, 1.0, 1e-13);
    sn_free(node);
    sn_free(cell);
    sn_mesh_destroy(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields),
        cmocka_unit_test(reactions),
        cmocka_unit_test(weights_sum_to_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
