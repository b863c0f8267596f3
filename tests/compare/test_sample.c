// Values of one mesh at the points of another, against fields that are known everywhere.
// SPDX-License-Identifier: Apache-2.0
#include "check.h"

#include "compare/sample.h"

static sn_mesh *block(int cells, sn_pattern pattern) {
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK,
                        .pattern = pattern,
                        .size = {0.3, 0.1, 0.2},
                        .cells = {cells, cells + 1, cells}};
    sn_mesh *mesh;
    CHECK_OK(sn_mesh_build(&def, &mesh));
    return mesh;
}

// a linear field: it is its own interpolant
static void at(const double *x, double u[3]) {
    u[0] = 1 + 2 * x[0] - x[1];
    u[1] = x[2] - 3 * x[0];
    u[2] = 0.5 * x[1];
}

static void linear_fields(void **state) {
    (void)state;
    static const sn_pattern patterns[] = {SN_PATTERN_MIRRORED, SN_PATTERN_BCC};
    for (int k = 0; k < 2; k++) {
        sn_mesh *from = block(3, patterns[k]), *to = block(5, SN_PATTERN_KUHN);
        sn_sampler s;
        double *u = sn_alloc((size_t)from->node_count, 3 * sizeof *u);
        double *v = sn_alloc((size_t)to->node_count, 3 * sizeof *v), truth[3];
        CHECK_OK(sn_sampler_create(from, to, &s));
        for (int i = 0; i < from->node_count; i++) at(from->node + 3 * i, u + 3 * i);
        sn_sample_nodes(&s, u, v);
        for (int i = 0; i < to->node_count; i++) {
            at(to->node + 3 * i, truth);
            // four products of numbers about 1; points on a face may be 1e-9 of a cell outside
            for (int d = 0; d < 3; d++) CHECK_ABS(v[3 * i + d], truth[d], 1e-13);
        }
        sn_free(u);
        sn_free(v);
        sn_sampler_release(&s);
        sn_mesh_destroy(from);
        sn_mesh_destroy(to);
    }
}

// on its own mesh every cell has its own value; a finer mesh keeps the mean of the whole
static void cells(void **state) {
    (void)state;
    sn_mesh *mesh = block(2, SN_PATTERN_MIRRORED), *fine;
    sn_sampler s;
    CHECK_OK(sn_mesh_refine(mesh, &fine));
    double *a = sn_alloc((size_t)fine->cell_count, 6 * sizeof *a);
    double *b = sn_alloc((size_t)fine->cell_count, 6 * sizeof *b);
    for (int i = 0; i < 6 * mesh->cell_count; i++) a[i] = i;
    CHECK_OK(sn_sampler_create(mesh, mesh, &s));
    sn_sample_cells(&s, a, b);
    for (int i = 0; i < 6 * mesh->cell_count; i++) CHECK_ABS(b[i], i, 0);
    sn_sampler_release(&s);
    CHECK_OK(sn_sampler_create(mesh, fine, &s));
    sn_sample_cells(&s, a, b);
    for (int m = 0; m < 6; m++) {
        double coarse = 0, sum = 0;
        for (int c = 0; c < mesh->cell_count; c++)
            coarse += a[6 * c + m] * sn_mesh_cell_volume(mesh, c);
        for (int c = 0; c < fine->cell_count; c++)
            sum += b[6 * c + m] * sn_mesh_cell_volume(fine, c);
        CHECK_REL(sum, coarse, 1e-12); // some hundred additions
    }
    sn_sampler_release(&s);
    sn_free(a);
    sn_free(b);
    sn_mesh_destroy(mesh);
    sn_mesh_destroy(fine);
}

// outside a wall of straight cells a linear field goes on
static void outside(void **state) {
    (void)state;
    sn_shape_def def = {.shape = SN_SHAPE_TUBE,
                        .inner_radius = 0.1,
                        .outer_radius = 0.2,
                        .length = 0.1,
                        .cells = {1, 8, 1}};
    sn_mesh *from, *to;
    sn_sampler s;
    CHECK_OK(sn_mesh_build(&def, &from));
    def.cells[1] = 16;
    CHECK_OK(sn_mesh_build(&def, &to));
    CHECK_OK(sn_sampler_create(from, to, &s));
    double u[200 * 3], v[200 * 3], truth[3], least = 0;
    assert_true(from->node_count < 200 && to->node_count < 200);
    for (int i = 0; i < from->node_count; i++) at(from->node + 3 * i, u + 3 * i);
    sn_sample_nodes(&s, u, v);
    for (int i = 0; i < to->node_count; i++) {
        at(to->node + 3 * i, truth);
        for (int d = 0; d < 3; d++) CHECK_ABS(v[3 * i + d], truth[d], 1e-13);
        for (int k = 0; k < 4; k++) least = fmin(least, s.weight[4 * i + k]);
    }
    assert_true(least < -0.01); // some are outside
    sn_sampler_release(&s);
    sn_mesh_destroy(from);
    sn_mesh_destroy(to);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_fields),
        cmocka_unit_test(cells),
        cmocka_unit_test(outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
