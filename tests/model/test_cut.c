// Cuts of a case, and the mesh that is left.
// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

static sn_cut_def *add_cut(sn_case *c, sn_cut_kind kind, double at) {
    c->cut = sn_resize(c->cut, (size_t)c->cut_count + 1, sizeof *c->cut);
    c->cut[c->cut_count] = (sn_cut_def){.kind = kind, .at = at};
    return &c->cut[c->cut_count++];
}

static void list_cells(sn_cut_def *cut, int count, const int *cell) {
    cut->cell = sn_alloc((size_t)count, sizeof *cut->cell);
    cut->cell_count = count;
    for (int k = 0; k < count; k++) cut->cell[k] = cell[k];
}

// Removed and left volumes make the whole; surfaces lose the faces of removed cells.
static void what_is_left(void **state) {
    (void)state;
    sn_case *c = block_case();
    const sn_mesh *m = c->mesh;
    bool *removed = sn_alloc((size_t)m->cell_count, sizeof *removed);
    int *name = sn_alloc((size_t)m->node_count, sizeof *name), count = 0;
    double gone = 0;
    sn_mesh *left;
    uint64_t seed = 2;
    for (int e = 0; e < m->cell_count; e++) {
        removed[e] = check_random(&seed, 0, 1) < 0.4;
        if (removed[e]) gone += sn_mesh_cell_volume(m, e);
        count += removed[e];
    }
    CHECK_OK(sn_mesh_without(m, removed, &left, name));
    assert_int_equal(left->cell_count, m->cell_count - count);
    CHECK_REL(sn_mesh_volume(left) + gone, sn_mesh_volume(m), 1e-12);
    assert_int_equal(left->surface_count, m->surface_count);
    for (int s = 0; s < m->surface_count; s++) {
        assert_string_equal(left->surface[s].name, m->surface[s].name);
        if (!strcmp(m->surface[s].name, "boundary")) continue;
        int faces = 0;
        for (int f = 0; f < m->surface[s].face_count; f++) faces += !removed[m->surface[s].cell[f]];
        assert_int_equal(left->surface[s].face_count, faces);
    }
    for (int i = 0; i < left->node_count; i++)
        assert_memory_equal(left->node + 3 * i, m->node + 3 * name[i], 3 * sizeof(double));
    sn_mesh_destroy(left);
    for (int e = 0; e < m->cell_count; e++) removed[e] = true;
    CHECK_FAILS(sn_mesh_without(m, removed, &left, NULL), SN_E_MESH, "cells were removed");
    assert_null(left);
    sn_free(removed);
    sn_free(name);
    sn_case_destroy(c);
}

static void cells_of_cuts(void **state) {
    (void)state;
    sn_case *c = block_case();
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (int k = 0; k < 3 * c->mesh->node_count; k++) {
        low[k % 3] = fmin(low[k % 3], c->mesh->node[k]);
        high[k % 3] = fmax(high[k % 3], c->mesh->node[k]);
    }
    sn_cut_def *box = add_cut(c, SN_CUT_BOX, 0); // the third of the body with the smallest x
    memcpy(box->low, low, sizeof low);
    memcpy(box->high, high, sizeof high);
    box->high[0] = low[0] + (high[0] - low[0]) / 3;
    sn_cut_def *ball = add_cut(c, SN_CUT_SPHERE, 1);
    memcpy(ball->centre, low, sizeof low);
    ball->radius = 10 * (high[0] - low[0] + high[1] - low[1] + high[2] - low[2]);
    list_cells(add_cut(c, SN_CUT_CELLS, 0.5), 4, (const int[]){7, 3, 7, 0});
    CHECK_OK(sn_case_check(c));
    int *cells, count;
    CHECK_OK(sn_case_cut_cells(c, 0, &cells, &count));
    assert_int_equal(count, c->mesh->cell_count / 3);
    sn_free(cells);
    CHECK_OK(sn_case_cut_cells(c, 1, &cells, &count));
    assert_int_equal(count, c->mesh->cell_count);
    sn_free(cells);
    CHECK_OK(sn_case_cut_cells(c, 2, &cells, &count));
    assert_int_equal(count, 3);
    assert_true(cells[0] == 0 && cells[1] == 3 && cells[2] == 7);
    sn_free(cells);

    // on a finer mesh regions have their cells there; numbers have no meaning
    sn_mesh *fine;
    sn_case *copy;
    CHECK_OK(sn_mesh_refine(c->mesh, &fine));
    CHECK_FAILS(sn_case_on_mesh(c, fine, &copy), SN_E_DEFINITION, "cut 3: its numbers");
    sn_free(c->cut[2].cell);
    c->cut_count = 2;
    CHECK_OK(sn_case_on_mesh(c, fine, &copy));
    CHECK_OK(sn_case_cut_cells(copy, 0, &cells, &count));
    assert_int_equal(count, copy->mesh->cell_count / 3);
    sn_free(cells);
    sn_case_destroy(copy);
    sn_case_destroy(c);
}

static void bad_cuts(void **state) {
    (void)state;
    sn_case *c = block_case();
    sn_cut_def *cut = add_cut(c, SN_CUT_SPHERE, 0);
    cut->radius = 1e3;
    CHECK_OK(sn_case_check(c));
    cut->at = 1.01;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "cut 1 is at 1.01 s: 0 s to the end of the run");
    cut->at = 1;
    cut->radius = (double)NAN;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "cut 1: radius");
    cut->radius = 1e-9;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "cut 1 hits no cell");
    cut->kind = SN_CUT_BOX;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "must rise in every direction");
    cut->kind = SN_CUT_CELLS;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "cut 1 hits no cell");
    list_cells(cut, 1, &c->mesh->cell_count);
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "the mesh has cells 0 to");
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_left),
                                       cmocka_unit_test(cells_of_cuts), cmocka_unit_test(bad_cuts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
