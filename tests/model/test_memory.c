// Shortage of memory at every single request: an error, no leak, no crash.
// SPDX-License-Identifier: Apache-2.0
#include "allocator.h"
#include "cases.h"

typedef sn_status try_once(const sn_case *c);

// Calls with 0, 1, 2, … requests granted until it succeeds. Returns how many it needed.
static int exhaust(try_once *call, const sn_case *c) {
    for (int granted = 0;; granted++) {
        const long before = blocks_live;
        allocations_left = granted;
        sn_status status = call(c);
        allocations_left = -1;
        assert_int_equal(blocks_live, before);
        if (status == SN_OK) return granted;
        assert_int_equal(status, SN_E_MEMORY);
    }
}

static sn_status try_shape(const sn_shape_def *def) {
    sn_mesh *mesh;
    SN_TRY(sn_mesh_build(def, &mesh));
    sn_mesh_destroy(mesh);
    return SN_OK;
}

static sn_status try_bcc(const sn_case *c) {
    (void)c;
    sn_shape_def def = tube(SN_PATTERN_BCC, 2, 12, 1);
    return try_shape(&def);
}

static sn_status try_cylinder(const sn_case *c) {
    (void)c;
    sn_shape_def def = cylinder(SN_PATTERN_MIRRORED, 2, 12, 1);
    return try_shape(&def);
}

static sn_status try_refine(const sn_case *c) {
    sn_mesh *mesh;
    SN_TRY(sn_mesh_refine(c->mesh, &mesh));
    sn_mesh_destroy(mesh);
    return SN_OK;
}

static sn_status try_lists(const sn_case *c) {
    int *list, count;
    SN_TRY(sn_mesh_edges(c->mesh, &list, &count));
    sn_free(list);
    SN_TRY(sn_mesh_surface_nodes(c->mesh, 0, &list, &count));
    sn_free(list);
    return SN_OK;
}

static sn_status try_copy(const sn_case *c) {
    sn_case *copy;
    sn_mesh *mesh;
    SN_TRY(sn_mesh_build(&c->shape, &mesh));
    sn_status status = sn_case_on_mesh(c, mesh, &copy);
    if (status == SN_OK)
        sn_case_destroy(copy);
    else
        sn_mesh_destroy(mesh);
    return status;
}

static sn_status try_fibres(const sn_case *c) {
    double axes[9], *field;
    SN_TRY(sn_case_axes_field(c, axes, &field));
    sn_free(field);
    return SN_OK;
}

static void shortage(void **state) {
    (void)state;
    sn_set_allocator(&counting);
    sn_case *c = block_case();
    hold(c, "left", "xyz");
    move(c, "right", 0.001, NAN, NAN)->factor = ramp(0, 1, 0.5);
    move(c, "top", NAN, NAN, NAN)->free[2] = false;
    c->load[1].factor = ramp(0, 1, 0.25);
    c->load[1].vector[2] = 0;
    add_sphere(c, "ball", 0.002, 0.01, 0.01, 0.03);
    CHECK_OK(sn_history_create(3, 1, (double[]){0}, (double[]){0, 0, 0}, &c->tool[0].path));
    add_probe(c, "tip", SN_PROBE_POINT, 0.01, 0.01, 0.01, NULL);
    assert_true(exhaust(try_bcc, c) > 5);
    assert_true(exhaust(try_cylinder, c) > 5);
    assert_true(exhaust(try_refine, c) > 5);
    assert_int_equal(exhaust(try_lists, c), 5);
    assert_true(exhaust(try_copy, c) > 10);
    assert_true(exhaust(sn_case_check, c) > 0);
    c->tissue[0].law = &fibre_law;
    c->fibres =
        (sn_fibres){.rule = SN_FIBRES_AROUND,
                    .axis = {0, 1, 0},
                    .through = {0.1, 0, 0},
                    .angle = {0, 1},
                    .wall = {sn_mesh_surface(c->mesh, "left"), sn_mesh_surface(c->mesh, "right")}};
    assert_true(exhaust(try_fibres, c) > 10);
    c->fibres = (sn_fibres){.rule = SN_FIBRES_LISTED, .count = c->mesh->cell_count};
    c->fibres.listed = sn_alloc(6 * (size_t)c->mesh->cell_count, sizeof(double));
    for (int k = 0; k < 6 * c->mesh->cell_count; k++) c->fibres.listed[k] = k % 7;
    assert_true(exhaust(try_copy, c) > 12);
    sn_case_destroy(c);
    assert_int_equal(blocks_live, 0);
    sn_set_allocator(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(shortage)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
