// Cases: what they prescribe, what they leave free, copies, columns, axes, penalty.
// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

static void prescribed(void **state) {
    (void)state;
    sn_case *c = block_case();
    hold(c, "left", "x");
    hold(c, "front", "y");
    move(c, "right", 0.003, NAN, NAN)->factor = ramp(0, 1, 2);
    move(c, "top", NAN, NAN, -0.001);
    CHECK_OK(sn_case_check(c));
    size_t n = (size_t)c->mesh->node_count;
    unsigned char *fixed = malloc(n);
    double *value = malloc(n * 3 * sizeof *value);
    for (int k = 0; k < 4; k++) {
        double t = 0.7 * k;
        for (size_t i = 0; i < 3 * n; i++) value[i] = -77;
        memset(fixed, 255, n);
        sn_case_prescribed(c, t, fixed, value);
        for (size_t a = 0; a < n; a++) {
            const double *x = c->mesh->node + 3 * a;
            double want[3] = {-77, -77, -77};
            unsigned bits = 0;
            if (x[0] == 0) want[0] = 0, bits |= 1;
            if (x[0] == c->shape.size[0]) want[0] = 0.003 * fmin(t / 2, 1), bits |= 1;
            if (x[1] == 0) want[1] = 0, bits |= 2;
            if (x[2] == c->shape.size[2]) want[2] = -0.001, bits |= 4;
            assert_int_equal(fixed[a], bits);
            for (int d = 0; d < 3; d++) CHECK_ABS(value[3 * a + (size_t)d], want[d], 1e-17);
        }
    }
    free(fixed);
    free(value);
    sn_case_destroy(c);
}

static void check_free(const sn_case *c, const char *expected) {
    char text[SN_TEXT_MAX];
    sn_case_free_motions(c, text);
    assert_string_equal(text, expected);
}

static void free_motions(void **state) {
    (void)state;
    sn_case *c = block_case();
    check_free(c,
               "translation along x, translation along y, translation along z, rotation about x, "
               "rotation about y, rotation about z");
    hold(c, "left", "x");
    check_free(c, "translation along y, translation along z, rotation about x");
    hold(c, "front", "y");
    check_free(c, "translation along z");
    hold(c, "bottom", "z");
    check_free(c, "");
    c->support_count = 0;
    hold(c, "bottom", "xyz");
    check_free(c, "");
    c->support_count = 0;
    hold(c, "top", "z");
    check_free(c, "translation along x, translation along y, rotation about z");
    c->support_count = 0;
    hold(c, "front", "yz");
    check_free(c, "translation along x");
    // displacement loads hold as supports do; tractions do not
    c->support_count = 0;
    move(c, "right", 0.001, NAN, NAN);
    check_free(c, "translation along y, translation along z, rotation about x");
    move(c, "left", NAN, 0, 0.001);
    check_free(c, "");
    c->load[0].kind = c->load[1].kind = SN_LOAD_TRACTION;
    check_free(c,
               "translation along x, translation along y, translation along z, rotation about x, "
               "rotation about y, rotation about z");
    sn_case_destroy(c);
}

// A single triangle, edge or node is held: surfaces that a reader may bring.
static void carried_along(void **state) {
    (void)state;
    sn_case *c = block_case();
    assert_int_equal(sn_case_carried_by(c), -1);
    c->load = sn_alloc(2, sizeof *c->load);
    c->load_count = 1;
    c->load[0] = (sn_load){.kind = SN_LOAD_DISPLACEMENT, .surface = 3, .vector = {1e-3, 0, 0}};
    assert_int_equal(sn_case_carried_by(c), 3);
    c->gravity[2] = -9.81;
    assert_int_equal(sn_case_carried_by(c), -1);
    c->gravity[2] = 0;
    hold(c, "left", "x");
    assert_int_equal(sn_case_carried_by(c), -1);
    sn_case_destroy(c);
}

static void free_motions_of_few_nodes(void **state) {
    (void)state;
    sn_case *c = block_case();
    sn_surface *top = &c->mesh->surface[sn_mesh_surface(c->mesh, "top")];
    int n[3] = {4, 5, 3}, first = n[0] * n[1] * (n[2] - 1);
    top->face_count = 1;
    hold(c, "top", "xyz");
    check_free(c, "");
    for (int i = 0; i < 3; i++) top->face[i] = first; // corner (0, 0, top)
    check_free(c, "rotation about x, rotation about y, rotation about z");
    top->face[1] = first + n[0] - 1; // with the far end of the edge along x
    check_free(c, "rotation about x");
    top->face[1] = first + n[0] * n[1] - 1; // with the opposite corner of the top
    double x = c->shape.size[0], y = c->shape.size[1], l = hypot(x, y);
    char text[SN_TEXT_MAX];
    snprintf(text, sizeof text, "rotation about (%.2g, %.2g, 0)", x / l, y / l);
    char found[SN_TEXT_MAX];
    sn_case_free_motions(c, found);
    // the zero may carry a sign or rounding
    assert_memory_equal(found, text, strlen("rotation about (0.88, 0.48"));
    assert_null(strchr(found + 15, 'b'));
    sn_case_destroy(c);

    // a tube held in all directions but its own, by the walls: only sliding is left
    c = block_case();
    sn_mesh_destroy(c->mesh);
    sn_shape_def def = tube(SN_PATTERN_MIRRORED, 1, 8, 2);
    c->mesh = build(&def);
    hold(c, "outer", "xy");
    check_free(c, "translation along z");
    c->support_count = 0;
    hold(c, "inner", "z");
    check_free(c, "translation along x, translation along y, rotation about z");
    sn_case_destroy(c);
}

// a block held on the left, pulled to the right, poked and watched
static sn_case *loaded_case(void) {
    sn_case *c = block_case();
    hold(c, "left", "xyz");
    move(c, "right", 0.001, NAN, NAN)->factor = ramp(0, 1, 0.5);
    add_sphere(c, "ball", 0.002, 0.01, 0.01, 0.03);
    CHECK_OK(sn_history_create(3, 1, (double[]){0}, (double[]){0, 0, -0.001}, &c->tool[0].path));
    add_probe(c, "tip", SN_PROBE_POINT, 0.01, 0.01, 0.01, NULL);
    return c;
}

static void on_mesh(void **state) {
    (void)state;
    sn_case *c = loaded_case(), *copy = NULL;
    strcpy(c->name, "pull");
    sn_mesh *fine = NULL;
    CHECK_OK(sn_mesh_refine(c->mesh, &fine));
    CHECK_OK(sn_case_on_mesh(c, fine, &copy));
    CHECK_OK(sn_case_check(c));
    sn_case_destroy(c); // the copy stands alone
    assert_ptr_equal(copy->mesh, fine);
    assert_string_equal(copy->name, "pull");
    assert_string_equal(copy->tissue[0].name, "liver");
    assert_false(copy->has_shape);
    assert_int_equal(copy->support_count, 1);
    assert_true(copy->support[0].fix[2]);
    double f;
    sn_pose pose;
    sn_history_at(copy->load[0].factor, 0.25, &f);
    CHECK_ABS(f, 0.5, 1e-15);
    sn_tool_pose(&copy->tool[0], 0, &pose);
    CHECK_ABS(pose.centre[2], 0.029, 1e-17);
    assert_string_equal(copy->probe[0].name, "tip");
    CHECK_OK(sn_case_check(copy));

    // another shape has other surfaces; what is refused stays the caller's
    sn_shape_def def = tube(SN_PATTERN_KUHN, 1, 5, 1);
    sn_case *none = copy;
    sn_mesh *m = build(&def);
    CHECK_FAILS(sn_case_on_mesh(copy, m, &none), SN_E_DEFINITION, "\"inner\" where the case");
    assert_null(none);
    sn_mesh_destroy(m);
    m = build(&copy->shape);
    m->region_count = 2;
    CHECK_FAILS(sn_case_on_mesh(copy, m, &none), SN_E_DEFINITION, "2 regions, the case has 1");
    m->region_count = 1;
    copy->has_shape = true;
    CHECK_OK(sn_case_on_mesh(copy, m, &none)); // back to the shape, from a finer mesh
    assert_false(none->has_shape);
    none->has_shape = true;
    sn_mesh *same = build(&copy->shape);
    sn_case *twin = NULL;
    CHECK_OK(sn_case_on_mesh(none, same, &twin));
    assert_true(twin->has_shape);
    sn_case_destroy(twin);
    sn_case_destroy(none);
    sn_case_destroy(copy);
    sn_case_destroy(NULL);
}

static void columns(void **state) {
    (void)state;
    sn_case *c = block_case();
    add_probe(c, "tip", SN_PROBE_POINT, 0, 0, 0, NULL);
    add_probe(c, "pull", SN_PROBE_REACTION, 0, 0, 0, "right");
    add_sphere(c, "ball", 0.001, 0, 0, 0.1);
    sn_record *r = NULL;
    CHECK_OK(sn_record_create("history", &r));
    CHECK_OK(sn_case_history_columns(c, r));
    static const char *const expected[][2] = {
        {"time", "s"},    {"tip_ux", "m"},  {"tip_uy", "m"},  {"tip_uz", "m"},  {"pull_fx", "N"},
        {"pull_fy", "N"}, {"pull_fz", "N"}, {"ball_fx", "N"}, {"ball_fy", "N"}, {"ball_fz", "N"}};
    assert_int_equal(r->series_count, 10);
    for (int i = 0; i < 10; i++) {
        assert_string_equal(r->series[i].name, expected[i][0]);
        assert_string_equal(r->series[i].unit, expected[i][1]);
    }
    sn_record_destroy(r);
    sn_case_destroy(c);
}

static void axes(void **state) {
    (void)state;
    sn_case *c = block_case();
    uint64_t seed = 3;
    for (int trial = 0; trial < 30; trial++) {
        double a[9], l = 0;
        for (int i = 0; i < 3; i++) c->fibre[i] = trial < 6 ? 0 : check_random(&seed, -1, 1);
        if (trial > 2 && trial < 6) c->fibre[trial % 3] = -1; // along an axis, against it
        if (trial < 3 && trial > 0) c->fibre[trial - 1] = 1;
        for (int i = 0; i < 3; i++) l += c->fibre[i] * c->fibre[i];
        for (int i = 0; i < 3 && l > 0; i++) c->fibre[i] /= sqrt(l);
        sn_case_axes(c, a);
        if (trial < 2) // none, and along x
            for (int i = 0; i < 9; i++) assert_true(a[i] == (i % 4 == 0));
        for (int i = 0; i < 3 && l > 0; i++) CHECK_ABS(a[i], c->fibre[i], 1e-15);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                CHECK_ABS(a[3 * i] * a[3 * j] + a[3 * i + 1] * a[3 * j + 1] +
                              a[3 * i + 2] * a[3 * j + 2],
                          i == j, 1e-15);
        double det = a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) +
                     a[2] * (a[3] * a[7] - a[4] * a[6]);
        CHECK_ABS(det, 1, 2e-15);
    }
    sn_case_destroy(c);
}

static void penalty(void **state) {
    (void)state;
    sn_case *c = block_case();
    // edges of the boundary of 3 x 4 x 2 cells a x b x h, by counting: every face has its two sides
    // and its diagonal, each side as often as faces meet it
    sn_shape_def d = c->shape;
    double step[3], length = 0;
    int faces = 0;
    for (int i = 0; i < 3; i++) step[i] = d.size[i] / d.cells[i];
    for (int i = 0; i < 3; i++) {
        int u = (i + 1) % 3, v = (i + 2) % 3, rectangles = 2 * d.cells[u] * d.cells[v];
        length += 2 * rectangles * (step[u] + step[v] + hypot(step[u], step[v]));
        faces += 2 * rectangles;
    }
    double mean = length / (3 * faces), shear = 9100.0 / 3;
    CHECK_REL(sn_case_penalty(c), 2 * (20 * shear + 4 * shear / 3) / mean, 1e-13);
    sn_case_destroy(c);
}

static void defaults(void **state) {
    (void)state;
    sn_case *c = NULL;
    CHECK_OK(sn_case_create(&c));
    assert_null(c->mesh);
    assert_int_equal(c->springs.threads, 1);
    assert_int_equal(c->continuum.element, SN_ELEMENT_P2P1);
    sn_case_destroy(c);
}

// Every number that an engine's state depends on changes the fingerprint; nothing else does.
static void fingerprints(void **state) {
    (void)state;
    sn_case *c = loaded_case(), *copy = NULL;
    const uint64_t own = sn_case_fingerprint(c);
    double *const numbers[] = {&c->mesh->node[5],
                               &c->tissue[0].value[0],
                               &c->tissue[0].density,
                               &c->fibre[1],
                               &c->fibres.sheet[0],
                               &c->fibres.axis[2],
                               &c->fibres.through[1],
                               &c->fibres.angle[1],
                               &c->gravity[2],
                               &c->load[0].vector[0],
                               &c->load[0].pressure,
                               &c->load[0].factor->time[1],
                               &c->load[0].factor->value[0],
                               &c->tool[0].radius,
                               &c->tool[0].axis[2],
                               &c->tool[0].at[1],
                               &c->tool[0].friction,
                               &c->tool[0].grasp[1],
                               &c->tool[0].path->value[2],
                               &c->probe[0].point[0]};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        const double kept = *numbers[k];
        *numbers[k] = nextafter(kept, 1e300);
        assert_true(sn_case_fingerprint(c) != own);
        *numbers[k] = kept;
    }
    int *const counts[] = {&c->mesh->cell[7],        &c->mesh->surface[0].face[2],
                           &c->support[0].surface,   &c->load[0].surface,
                           (int *)&c->load[0].kind,  (int *)&c->tool[0].kind,
                           (int *)&c->probe[0].kind, &c->mesh->region[3],
                           (int *)&c->fibres.rule,   &c->fibres.wall[1]};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        *counts[k] += 1;
        assert_true(sn_case_fingerprint(c) != own);
        *counts[k] -= 1;
    }
    bool *const flags[] = {&c->support[0].fix[1], &c->load[0].free[2]};
    for (size_t k = 0; k < sizeof flags / sizeof *flags; k++) {
        *flags[k] = !*flags[k];
        assert_true(sn_case_fingerprint(c) != own);
        *flags[k] = !*flags[k];
    }
    c->tissue[0].memory = sn_memory_none();
    c->tissue[0].memory.law = sn_memory_law_find("maxwell");
    assert_true(sn_case_fingerprint(c) != own);
    c->tissue[0].memory = sn_memory_none();
    c->until *= 2; // what an engine may change when it goes on
    c->springs.threads = 2;
    strcpy(c->name, "another");
    assert_true(sn_case_fingerprint(c) == own);
    sn_mesh *mesh = NULL;
    CHECK_OK(sn_mesh_copy(c->mesh, &mesh));
    CHECK_OK(sn_case_on_mesh(c, mesh, &copy));
    assert_true(sn_case_fingerprint(copy) == own);
    sn_case_destroy(copy);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(prescribed),    cmocka_unit_test(free_motions),
        cmocka_unit_test(carried_along), cmocka_unit_test(free_motions_of_few_nodes),
        cmocka_unit_test(on_mesh),       cmocka_unit_test(columns),
        cmocka_unit_test(axes),          cmocka_unit_test(penalty),
        cmocka_unit_test(defaults),      cmocka_unit_test(fingerprints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
