// Material axes of cells: rules against geometry, lists, other meshes, what is refused.
// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

static const double pi = 3.14159265358979323846;

static sn_case *on_shape(const sn_shape_def *def) {
    sn_case *c = block_case();
    sn_mesh_destroy(c->mesh);
    c->shape = *def;
    c->mesh = build(def);
    c->tissue[0].law = &fibre_law;
    c->fibres = (sn_fibres){.rule = SN_FIBRES_AROUND, .axis = {0, 0, 3}, .wall = {-1, -1}};
    return c;
}

static double *field_of(const sn_case *c) {
    double axes[9], *field = NULL;
    CHECK_OK(sn_case_check(c));
    CHECK_OK(sn_case_axes_field(c, axes, &field));
    assert_non_null(field);
    for (int k = 0; k < c->mesh->cell_count; k++) {
        const double *a = field + 9 * k;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                CHECK_ABS(a[3 * i] * a[3 * j] + a[3 * i + 1] * a[3 * j + 1] +
                              a[3 * i + 2] * a[3 * j + 2],
                          i == j, 1e-15);
        CHECK_ABS(a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
                      a[2] * (a[3] * a[7] - a[4] * a[6]),
                  1, 2e-15);
    }
    return field;
}

static void middle(const sn_mesh *mesh, int cell, double x[3]) {
    for (int i = 0; i < 3; i++) {
        x[i] = 0;
        for (int k = 0; k < 4; k++) x[i] += 0.25 * mesh->node[3 * mesh->cell[4 * cell + k] + i];
    }
}

static void check_row(const double *row, double x, double y, double z) {
    CHECK_ABS(row[0], x, 1e-14);
    CHECK_ABS(row[1], y, 1e-14);
    CHECK_ABS(row[2], z, 1e-14);
}

// Exact at the middles of cells, whatever the mesh; the axis may lie anywhere.
static void around_a_tube(void **state) {
    (void)state;
    sn_shape_def def = tube(SN_PATTERN_MIRRORED, 2, 12, 3);
    sn_case *c = on_shape(&def);
    const double angle = 0.7, C = cos(angle), S = sin(angle);
    c->fibres.angle[0] = c->fibres.angle[1] = angle;
    for (int normal = 0; normal < 2; normal++) {
        c->fibres.sheet_normal = normal;
        double *field = field_of(c);
        for (int k = 0; k < c->mesh->cell_count; k++) {
            double x[3];
            middle(c->mesh, k, x);
            double r = hypot(x[0], x[1]), cs = x[0] / r, sn = x[1] / r;
            const double *a = field + 9 * k;
            check_row(a, -C * sn, C * cs, S);
            if (normal) {
                check_row(a + 3, cs, sn, 0);
            } else {
                check_row(a + 3, S * sn, -S * cs, C);
                check_row(a + 6, cs, sn, 0);
            }
        }
        sn_free(field);
    }
    // along x, through (0, 0.1, 0.2)
    c->fibres = (sn_fibres){
        .rule = SN_FIBRES_AROUND, .axis = {0.1, 0, 0}, .through = {7, 0.1, 0.2}, .wall = {-1, -1}};
    double *field = field_of(c);
    for (int k = 0; k < c->mesh->cell_count; k++) {
        double x[3];
        middle(c->mesh, k, x);
        double r = hypot(x[1] - 0.1, x[2] - 0.2);
        check_row(field + 9 * k, 0, -(x[2] - 0.2) / r, (x[1] - 0.1) / r);
    }
    sn_free(field);
    sn_case_destroy(c);
}

// Largest error of the angle of a fibre and of the normal, both in radians.
static void tube_errors(int fine, double error[2]) {
    sn_shape_def def = tube(SN_PATTERN_MIRRORED, 3 * fine, 24 * fine, 2 * fine);
    sn_case *c = on_shape(&def);
    c->fibres.angle[0] = pi / 3;
    c->fibres.angle[1] = -pi / 3;
    c->fibres.wall[0] = sn_mesh_surface(c->mesh, "inner");
    c->fibres.wall[1] = sn_mesh_surface(c->mesh, "outer");
    double *field = field_of(c);
    error[0] = error[1] = 0;
    for (int k = 0; k < c->mesh->cell_count; k++) {
        double x[3];
        middle(c->mesh, k, x);
        double r = hypot(x[0], x[1]), depth = (r - 0.0113) / (0.0171 - 0.0113);
        const double *a = field + 9 * k;
        double angle = atan2(a[2], (-a[0] * x[1] + a[1] * x[0]) / r);
        error[0] = fmax(error[0], fabs(angle - pi / 3 * (1 - 2 * depth)));
        error[1] = fmax(error[1], acos(fmin(1, (a[6] * x[0] + a[7] * x[1]) / r)));
    }
    sn_free(field);
    sn_case_destroy(c);
}

// Distances from walls of straight faces err by the sagitta, Ro (pi/around)^2/2 of the thickness:
// 2.5 % of 120 degrees here, a quarter of it on the fine mesh. The normal has no part around the
// axis by construction, and none along it since the tube is the same all along.
static void angle_through_a_tube(void **state) {
    (void)state;
    double coarse[2], fine[2];
    tube_errors(1, coarse);
    tube_errors(2, fine);
    if (getenv("SINEW_SHOW"))
        print_message("angle %g %g, normal %g %g\n", coarse[0], fine[0], coarse[1], fine[1]);
    CHECK_ABS(coarse[0], 0, 0.025 * 2 * pi / 3);
    assert_true(fine[0] < 0.35 * coarse[0]);
    CHECK_ABS(coarse[1], 0, 1e-7); // the square root of rounding
    CHECK_ABS(fine[1], 0, 1e-7);
}

// The ellipsoids between the walls: t where (r / rs)^2 + (z / rl)^2 = 1, rs = 7 + 3 t, rl = 17 + 3
// t, have the normal (r / rs^2, z / rl^2).
static void wall_of_an_ellipsoid(void **state) {
    (void)state;
    double worst[2][2] = {{0}};
    for (int fine = 0; fine < 2; fine++) {
        sn_shape_def def = {.shape = SN_SHAPE_ELLIPSOID,
                            .inner = {0.007, 0.017},
                            .outer = {0.010, 0.020},
                            .base = 0.005,
                            .cells = {2 << fine, 16 << fine, 10 << fine}};
        sn_case *c = on_shape(&def);
        c->fibres.angle[0] = 1;
        c->fibres.angle[1] = -1;
        c->fibres.wall[0] = sn_mesh_surface(c->mesh, "inner");
        c->fibres.wall[1] = sn_mesh_surface(c->mesh, "outer");
        double *field = field_of(c);
        int seen = 0;
        for (int k = 0; k < c->mesh->cell_count; k++) {
            double x[3], low = -0.5, high = 1.5;
            middle(c->mesh, k, x);
            double r = hypot(x[0], x[1]);
            if (r < 0.003) continue; // the apex
            for (int n = 0; n < 50; n++) {
                double t = 0.5 * (low + high), rs = 0.007 + 0.003 * t, rl = 0.017 + 0.003 * t;
                if (pow(r / rs, 2) + pow(x[2] / rl, 2) > 1)
                    low = t;
                else
                    high = t;
            }
            double rs = 0.007 + 0.003 * low, rl = 0.017 + 0.003 * low;
            double n[3] = {x[0] / (rs * rs), x[1] / (rs * rs), x[2] / (rl * rl)};
            double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            const double *a = field + 9 * k;
            double along = (a[6] * n[0] + a[7] * n[1] + a[8] * n[2]) / l;
            double angle = acos(fmin(1, fmax(-1, (-a[0] * x[1] + a[1] * x[0]) / r)));
            worst[fine][0] = fmax(worst[fine][0], fabs(angle - fabs(1 - 2 * low)));
            worst[fine][1] = fmax(worst[fine][1], acos(fmin(1, along)));
            // towards the base inside, away from it outside
            if (fabs(1 - 2 * low) > 0.3) assert_true((a[2] > 0) == (low < 0.5));
            seen++;
        }
        assert_true(seen > 100);
        sn_free(field);
        sn_case_destroy(c);
    }
    if (getenv("SINEW_SHOW"))
        print_message("angle %g %g, normal %g %g\n", worst[0][0], worst[1][0], worst[0][1],
                      worst[1][1]);
    // faces are straight: the sagitta again, on half as many; the rim of the base counts too
    CHECK_ABS(worst[1][0], 0, 0.06);
    CHECK_ABS(worst[1][1], 0, 0.04);
    assert_true(worst[1][0] < 0.4 * worst[0][0]);
    assert_true(worst[1][1] < 0.6 * worst[0][1]);
}

//---- lists ---------------------------------------------------------------------------------------

static void list(sn_case *c, uint64_t seed) {
    c->fibres = (sn_fibres){.rule = SN_FIBRES_LISTED, .count = c->mesh->cell_count};
    c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
    for (int k = 0; k < 6 * c->mesh->cell_count; k++)
        c->fibres.listed[k] = check_random(&seed, -1, 1);
}

static void listed_on_other_meshes(void **state) {
    (void)state;
    sn_shape_def def = block(SN_PATTERN_MIRRORED, 3, 4, 2);
    sn_case *c = on_shape(&def), *copy, *back;
    list(c, 5);
    double *field = field_of(c);
    for (int k = 0; k < c->mesh->cell_count; k++) { // along the rows, in their plane
        const double *row = c->fibres.listed + 6 * k, *a = field + 9 * k;
        double l = sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        check_row(a, row[0] / l, row[1] / l, row[2] / l);
        CHECK_ABS(row[3] * a[6] + row[4] * a[7] + row[5] * a[8], 0, 1e-14);
        assert_true(row[3] * a[3] + row[4] * a[4] + row[5] * a[5] > 0);
    }
    sn_free(field);

    // cells that were split have what their parent has; so has the parent again
    sn_mesh *mesh;
    CHECK_OK(sn_mesh_refine(c->mesh, &mesh));
    CHECK_OK(sn_case_on_mesh(c, mesh, &copy));
    assert_int_equal(copy->fibres.count, 8 * c->mesh->cell_count);
    for (int k = 0; k < 6 * copy->fibres.count; k++)
        assert_true(copy->fibres.listed[k] == c->fibres.listed[6 * (k / 48) + k % 6]);
    CHECK_OK(sn_mesh_copy(c->mesh, &mesh));
    CHECK_OK(sn_case_on_mesh(copy, mesh, &back));
    assert_memory_equal(back->fibres.listed, c->fibres.listed,
                        6 * (size_t)c->fibres.count * sizeof(double));
    sn_case_destroy(back);
    sn_case_destroy(copy);

    // another numbering, and cells that stand out of the body by a hair: found by their place
    CHECK_OK(sn_mesh_copy(c->mesh, &mesh));
    int n = mesh->cell_count;
    for (int k = 0; k < 4 * n; k++) mesh->cell[k] = c->mesh->cell[4 * (n - 1 - k / 4) + k % 4];
    for (int k = 0; k < 3 * mesh->node_count; k++) mesh->node[k] += 1e-6;
    CHECK_OK(sn_case_on_mesh(c, mesh, &copy));
    for (int k = 0; k < n; k++)
        assert_memory_equal(copy->fibres.listed + 6 * k, c->fibres.listed + 6 * (n - 1 - k),
                            6 * sizeof(double));
    sn_case_destroy(copy);
    sn_shape_def far = block(SN_PATTERN_MIRRORED, 3, 4, 2);
    mesh = build(&far);
    for (int k = 0; k < mesh->node_count; k++) mesh->node[3 * k] += 1; // outside: the nearest
    CHECK_OK(sn_case_on_mesh(c, mesh, &copy));
    assert_int_equal(copy->fibres.count, n);
    CHECK_OK(sn_case_check(copy));
    sn_case_destroy(copy);
    sn_case_destroy(c);
}

static void few_axes(void **state) {
    (void)state;
    double axes[9], *field = NULL;
    sn_case *c = block_case();
    // no law with fibres: nothing to turn
    c->fibre[1] = 1;
    CHECK_OK(sn_case_axes_field(c, axes, &field));
    for (int k = 0; k < 9; k++) CHECK_ABS(axes[k], k % 4 == 0, 0);
    // one direction and its sheet
    c->tissue[0].law = &fibre_law;
    c->fibres.sheet[0] = -2;
    c->fibres.sheet[1] = 7;
    CHECK_OK(sn_case_check(c));
    CHECK_OK(sn_case_axes_field(c, axes, &field));
    assert_null(field);
    check_row(axes, 0, 1, 0);
    check_row(axes + 3, -1, 0, 0);
    check_row(axes + 6, 0, 0, 1);
    // listed but alike in the region that has fibres; the other one does not count
    list(c, 3);
    c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
    c->tissue[1] = c->tissue[0];
    c->tissue[1].law = &solid_law;
    c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
    strcpy(c->mesh->region_name[1], "other");
    c->mesh->region_count = 2;
    for (int k = 0; k < c->mesh->cell_count; k++) {
        c->mesh->region[k] = k % 2;
        for (int i = 0; i < 6 && k % 2 == 0; i++) c->fibres.listed[6 * k + i] = i == 2 || i == 4;
    }
    CHECK_OK(sn_case_axes_field(c, axes, &field));
    assert_null(field);
    check_row(axes, 0, 0, 1);
    check_row(axes + 3, 0, 1, 0);
    c->fibres.listed[0] = 1;
    CHECK_OK(sn_case_axes_field(c, axes, &field));
    assert_non_null(field);
    for (int k = 0; k < 9; k++) CHECK_ABS(axes[k], k % 4 == 0, 0);
    for (int k = 0; k < 9; k++) CHECK_ABS(field[9 + k], k % 4 == 0, 0); // of the other tissue
    CHECK_ABS(field[0], sqrt(0.5), 1e-15);
    sn_free(field);
    sn_case_destroy(c);
}

//---- refused -------------------------------------------------------------------------------------

static void refused(void **state) {
    (void)state;
    double axes[9], *field = NULL;
    sn_shape_def def = tube(SN_PATTERN_MIRRORED, 1, 8, 1);
    sn_case *c = on_shape(&def);
    CHECK_OK(sn_case_check(c));
    c->fibres.angle[1] = 1;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "needs walls");
    c->fibres.wall[0] = sn_mesh_surface(c->mesh, "inner");
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "the outer wall, surface -1");
    c->fibres.wall[1] = c->fibres.wall[0];
    CHECK_OK(sn_case_check(c));
    CHECK_FAILS(sn_case_axes_field(c, axes, &field), SN_E_DEFINITION, "\"inner\" touch at");
    assert_null(field);
    c->fibres.wall[1] = sn_mesh_surface(c->mesh, "outer");
    c->fibres.angle[1] = NAN;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "angles");
    c->fibres.angle[1] = 0;
    c->fibres.axis[2] = 0;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "the axis (0, 0, 0)");

    // an axis through the middle of cell 3
    c->fibres = (sn_fibres){.rule = SN_FIBRES_AROUND, .axis = {0, 1, 0}, .wall = {-1, -1}};
    middle(c->mesh, 3, c->fibres.through);
    CHECK_FAILS(sn_case_axes_field(c, axes, &field), SN_E_DEFINITION, "cell 3 at (");

    list(c, 9);
    CHECK_OK(sn_case_check(c));
    c->fibres.listed[6 * 4 + 1] = INFINITY;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "row 5 (");
    for (int i = 0; i < 6; i++) c->fibres.listed[6 * 4 + i] = i % 3;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "row 5: the second direction");
    for (int i = 0; i < 3; i++) c->fibres.listed[6 * 4 + i] = 0;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "row 5 (");
    c->fibres.count--;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "one a cell");
    sn_case_destroy(c);

    c = block_case();
    c->fibre[0] = 1;
    c->fibres.sheet[0] = 1;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "along the fibre");
    c->fibres.sheet[1] = NAN;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "sheet");
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(around_a_tube),
                                       cmocka_unit_test(angle_through_a_tube),
                                       cmocka_unit_test(wall_of_an_ellipsoid),
                                       cmocka_unit_test(listed_on_other_meshes),
                                       cmocka_unit_test(few_axes),
                                       cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
