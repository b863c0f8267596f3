// Finishing, refining and asking meshes.
// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

// sums of at most some thousand terms of one sign
#define ROUNDING 1e-12

// Two tetrahedra on the two sides of the triangle 0 1 2, one region each.
static sn_mesh *two_cells(int surfaces) {
    static const double node[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.3, 0.9, 0.4, 0.2, -0.7};
    static const int cell[] = {0, 1, 2, 3, 0, 1, 2, 4}; // the second is inverted
    sn_mesh *m = NULL;
    CHECK_OK(sn_mesh_create(5, 2, 2, surfaces, &m));
    memcpy(m->node, node, sizeof node);
    memcpy(m->cell, cell, sizeof cell);
    m->region[1] = 1;
    strcpy(m->region_name[0], "above");
    strcpy(m->region_name[1], "below");
    return m;
}

static void add_surface(sn_mesh *m, int s, const char *name, int faces, const int *face) {
    strcpy(m->surface[s].name, name);
    m->surface[s].face_count = faces;
    m->surface[s].face = sn_alloc((size_t)faces * 3, sizeof(int));
    memcpy(m->surface[s].face, face, (size_t)faces * 3 * sizeof(int));
}

static bool same_turn(const int *face, int a, int b, int c) {
    for (int i = 0; i < 3; i++)
        if (face[i] == a && face[(i + 1) % 3] == b && face[(i + 2) % 3] == c) return true;
    return false;
}

static void finish(void **state) {
    (void)state;
    sn_mesh *m = two_cells(3);
    // an outer face given inwards and outwards, and the inner face in both directions
    add_surface(m, 0, "side", 2, (int[]){1, 0, 3, 0, 1, 3});
    add_surface(m, 1, "seen from below", 1, (int[]){0, 2, 1});
    add_surface(m, 2, "seen from above", 1, (int[]){0, 1, 2});
    CHECK_OK(sn_mesh_finish(m));
    // volumes 0.9/6 and 0.7/6: base 1/2, heights 0.9 and 0.7
    CHECK_REL(sn_mesh_volume(m), 1.6 / 6, 1e-15);
    assert_true(same_turn(m->surface[0].face, 0, 1, 3));
    assert_true(same_turn(m->surface[0].face + 3, 0, 1, 3));
    assert_int_equal(m->surface[0].cell[0], 0);
    // (0 2 1) points down, out of the cell above; (0 1 2) up, out of the cell below
    assert_true(same_turn(m->surface[1].face, 0, 2, 1));
    assert_int_equal(m->surface[1].cell[0], 0);
    assert_true(same_turn(m->surface[2].face, 0, 1, 2));
    assert_int_equal(m->surface[2].cell[0], 1);
    assert_int_equal(m->surface_count, 4);
    assert_string_equal(m->surface[3].name, "boundary");
    assert_int_equal(m->surface[3].face_count, 6);
    CHECK_OK(sn_mesh_finish(m)); // again: nothing changes
    assert_int_equal(m->surface_count, 4);
    sn_mesh_destroy(m);
    sn_mesh_destroy(NULL);
}

static void finish_refuses(void **state) {
    (void)state;
    sn_mesh *m = two_cells(0);
    m->cell[6] = 5;
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "cell 1 (counted from 0) names node 5");
    m->cell[6] = -1;
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "names node -1");
    m->cell[6] = 2;
    m->node[3 * 4 + 1] = NAN;
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "coordinate y of node 4");
    m->node[3 * 4 + 1] = 0.2;
    m->node[3 * 4 + 2] = 1e-13; // 1.7e-14 m3 on an edge of 1.4 m
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "cell 1 (counted from 0, nodes 0 1 2 4) is flat");
    m->node[3 * 4 + 2] = -1e-10; // thin, not flat
    CHECK_OK(sn_mesh_finish(m));
    m->region[1] = 2;
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "in region 2 of 2");
    sn_mesh_destroy(m);

    m = two_cells(0);
    for (int i = 0; i < 4; i++) m->cell[4 + i] = m->cell[i];
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "node 4 (counted from 0) belongs to no");
    sn_mesh_destroy(m);

    CHECK_OK(sn_mesh_create(6, 3, 1, 0, &m));
    static const double node[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 1, 1, 1};
    static const int cell[] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5};
    memcpy(m->node, node, sizeof node);
    memcpy(m->cell, cell, sizeof cell);
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "cells 0, 1 and 2 (counted from 0) share the face");
    sn_mesh_destroy(m);

    m = two_cells(1);
    add_surface(m, 0, "lid", 2, (int[]){0, 1, 3, 1, 3, 4});
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH,
                "surface \"lid\": triangle 1 (counted from 0, nodes 1 3 4)");
    m->surface[0].face[4] = 77;
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "nodes 1 77 4");
    sn_mesh_destroy(m);

    m = two_cells(1);
    add_surface(m, 0, "boundary", 1, (int[]){0, 1, 3});
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "rename the surface");
    sn_mesh_destroy(m);

    m = two_cells(2);
    add_surface(m, 0, "lid", 1, (int[]){0, 1, 3});
    add_surface(m, 1, "lid", 1, (int[]){0, 1, 3});
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "two surfaces have the name \"lid\"");
    sn_mesh_destroy(m);

    CHECK_OK(sn_mesh_create(3, 0, 1, 0, &m));
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "3 nodes and 0 tetrahedra");
    sn_mesh_destroy(m);
    CHECK_OK(sn_mesh_create(4, 1, 0, 0, &m));
    CHECK_FAILS(sn_mesh_finish(m), SN_E_MESH, "no region");
    sn_mesh_destroy(m);
}

// Faces of a mesh with its nodes and cells shuffled are the same faces.
static void finish_shuffled(void **state) {
    (void)state;
    uint64_t seed = 20240611;
    sn_shape_def def = tube(SN_PATTERN_MIRRORED, 2, 10, 4);
    sn_mesh *m = build(&def), *copy = NULL;
    double vector[3], area = surface_area(m, 4, vector);
    CHECK_OK(sn_mesh_create(m->node_count, m->cell_count, 1, 0, &copy));
    int *place = malloc((size_t)m->node_count * sizeof *place);
    for (int a = 0; a < m->node_count; a++) place[a] = a;
    for (int a = m->node_count - 1; a > 0; a--) {
        int b = (int)check_random(&seed, 0, a + 1), swap = place[a];
        place[a] = place[b];
        place[b] = swap;
    }
    for (int a = 0; a < m->node_count; a++)
        memcpy(copy->node + 3 * place[a], m->node + 3 * a, 3 * sizeof(double));
    for (int c = 0; c < m->cell_count; c++) {
        int turn = (int)check_random(&seed, 0, 4);
        for (int k = 0; k < 4; k++) // some are inverted by this
            copy->cell[4 * c + k] = place[m->cell[4 * c + (turn < 2 ? k : k ^ turn % 2)]];
    }
    free(place);
    CHECK_OK(sn_mesh_finish(copy));
    CHECK_REL(sn_mesh_volume(copy), sn_mesh_volume(m), ROUNDING);
    CHECK_REL(surface_area(copy, 0, vector), area, ROUNDING);
    for (int i = 0; i < 3; i++) CHECK_ABS(vector[i] / area, 0, ROUNDING);
    sn_mesh_destroy(m);
    sn_mesh_destroy(copy);
}

static void check_refined(const sn_mesh *m) {
    sn_mesh *fine = NULL;
    int *edge, edges;
    CHECK_OK(sn_mesh_edges(m, &edge, &edges));
    sn_free(edge);
    CHECK_OK(sn_mesh_refine(m, &fine));
    assert_int_equal(fine->cell_count, 8 * m->cell_count);
    assert_int_equal(fine->node_count, m->node_count + edges);
    CHECK_REL(sn_mesh_volume(fine), sn_mesh_volume(m), ROUNDING);
    assert_int_equal(fine->surface_count, m->surface_count);
    for (int s = 0; s < m->surface_count; s++) {
        double coarse[3], now[3], area = surface_area(m, s, coarse);
        assert_string_equal(fine->surface[s].name, m->surface[s].name);
        assert_int_equal(fine->surface[s].face_count, 4 * m->surface[s].face_count);
        CHECK_REL(surface_area(fine, s, now), area, ROUNDING);
        for (int i = 0; i < 3; i++) CHECK_ABS(now[i] / area, coarse[i] / area, ROUNDING);
        for (int f = 0; f < fine->surface[s].face_count;
             f++) // behind it lies a child of the parent
            assert_int_equal(fine->surface[s].cell[f] / 8, m->surface[s].cell[f / 4]);
    }
    assert_int_equal(fine->region_count, m->region_count);
    for (int c = 0; c < fine->cell_count; c++) assert_int_equal(fine->region[c], m->region[c / 8]);
    sn_mesh_destroy(fine);
}

static void refine(void **state) {
    (void)state;
    sn_mesh *m = two_cells(1);
    add_surface(m, 0, "inside", 1, (int[]){0, 2, 1});
    CHECK_OK(sn_mesh_finish(m));
    check_refined(m);
    sn_mesh *fine = NULL, *finer = NULL;
    CHECK_OK(sn_mesh_refine(m, &fine));
    assert_string_equal(fine->region_name[1], "below");
    check_refined(fine);
    sn_mesh_destroy(fine);
    sn_mesh_destroy(m);

    sn_shape_def def = tube(SN_PATTERN_BCC, 2, 12, 2);
    m = build(&def);
    check_refined(m);
    sn_mesh_destroy(m);

    // a cube of Kuhn cells, refined twice, has congruent cells: one volume, one longest edge
    def = block(SN_PATTERN_KUHN, 1, 1, 1);
    def.size[0] = def.size[1] = def.size[2] = 1;
    m = build(&def);
    CHECK_OK(sn_mesh_refine(m, &fine));
    CHECK_OK(sn_mesh_refine(fine, &finer));
    for (int c = 0; c < finer->cell_count; c++) {
        double longest = 0;
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++) {
                double d2 = 0;
                for (int k = 0; k < 3; k++) {
                    double d = finer->node[3 * finer->cell[4 * c + i] + k] -
                               finer->node[3 * finer->cell[4 * c + j] + k];
                    d2 += d * d;
                }
                longest = fmax(longest, sqrt(d2));
            }
        CHECK_REL(longest, sqrt(3) / 4, 1e-14);
    }
    sn_mesh_destroy(finer);
    sn_mesh_destroy(fine);

    m->cell_count = SN_CELLS_MAX / 8 + 1; // refused by number, before anything is touched
    CHECK_FAILS(sn_mesh_refine(m, &fine), SN_E_RANGE, "refining 6250001 tetrahedra");
    assert_null(fine);
    m->cell_count = 6;
    sn_mesh_destroy(m);
}

static void questions(void **state) {
    (void)state;
    sn_shape_def def = block(SN_PATTERN_MIRRORED, 3, 2, 2);
    sn_mesh *m = build(&def);
    assert_int_equal(sn_mesh_surface(m, "top"), 5);
    assert_int_equal(sn_mesh_surface(m, "botom"), -1);
    assert_non_null(strstr(sn_error_text(), "did you mean \"bottom\""));
    assert_int_equal(sn_mesh_surface(m, "ceiling"), -1);
    assert_non_null(strstr(sn_error_text(), "left right front back bottom top boundary"));

    int *nodes, count;
    CHECK_OK(sn_mesh_surface_nodes(m, 1, &nodes, &count));
    assert_int_equal(count, 9);
    for (int i = 0; i < count; i++) {
        assert_true(m->node[3 * nodes[i]] == def.size[0]);
        if (i > 0) assert_true(nodes[i] > nodes[i - 1]);
    }
    sn_free(nodes);

    // edges against a table of all pairs
    int *edge, edges, expected = 0;
    CHECK_OK(sn_mesh_edges(m, &edge, &edges));
    unsigned char *table = calloc((size_t)m->node_count, (size_t)m->node_count);
    for (int c = 0; c < m->cell_count; c++)
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                table[m->cell[4 * c + i] * m->node_count + m->cell[4 * c + j]] = 1;
    for (int a = 0; a < m->node_count; a++)
        for (int b = a + 1; b < m->node_count; b++) expected += table[a * m->node_count + b];
    assert_int_equal(edges, expected);
    for (int e = 0; e < edges; e++) {
        assert_true(edge[2 * e] < edge[2 * e + 1]);
        assert_true(table[edge[2 * e] * m->node_count + edge[2 * e + 1]]);
        if (e > 0)
            assert_true(edge[2 * e] > edge[2 * e - 2] ||
                        (edge[2 * e] == edge[2 * e - 2] && edge[2 * e + 1] > edge[2 * e - 1]));
    }
    free(table);
    sn_free(edge);
    sn_mesh_destroy(m);
}

static void locate(void **state) {
    (void)state;
    uint64_t seed = 77;
    sn_shape_def def = tube(SN_PATTERN_MIRRORED, 2, 12, 4);
    sn_mesh *m = build(&def);
    int cell;
    double w[4];
    for (int trial = 0; trial < 200; trial++) {
        // a random point of a random cell
        int c = (int)check_random(&seed, 0, m->cell_count);
        double given[4], sum = 0, x[3] = {0}, back[3] = {0};
        for (int k = 0; k < 4; k++) sum += given[k] = -log(check_random(&seed, 1e-9, 1));
        for (int k = 0; k < 4; k++)
            for (int i = 0; i < 3; i++)
                x[i] += given[k] / sum * m->node[3 * m->cell[4 * c + k] + i];
        CHECK_OK(sn_mesh_locate(m, x, &cell, w));
        assert_int_equal(cell, c);
        for (int k = 0; k < 4; k++) {
            // relative to a cell of some mm with coordinates of some cm: 1e-16 * 10 * 10
            CHECK_ABS(w[k], given[k] / sum, 1e-13);
            for (int i = 0; i < 3; i++) back[i] += w[k] * m->node[3 * m->cell[4 * cell + k] + i];
        }
        for (int i = 0; i < 3; i++) CHECK_ABS(back[i], x[i], 1e-16);
    }
    // nodes are in one of their cells
    CHECK_OK(sn_mesh_locate(m, m->node + 3 * 17, &cell, w));
    for (int k = 0; k < 4; k++) assert_true((m->cell[4 * cell + k] == 17) == (w[k] > 0.5));

    double size = 2 * def.outer_radius; // of the body, at least
    double x[3] = {def.inner_radius - 0.5e-6 * size, 0, def.length};
    CHECK_OK(sn_mesh_locate(m, x, &cell, w));
    CHECK_ABS(w[0] + w[1] + w[2] + w[3], 1, 1e-15);
    for (int k = 0; k < 4; k++) assert_true(w[k] >= 0);
    x[0] = def.inner_radius - 1e-5 * size;
    CHECK_FAILS(sn_mesh_locate(m, x, &cell, w), SN_E_DEFINITION, "outside the body");
    x[0] = 0; // in the bore
    CHECK_FAILS(sn_mesh_locate(m, x, &cell, w), SN_E_DEFINITION, "z 0 … 0.037 m");
    x[2] = NAN;
    CHECK_FAILS(sn_mesh_locate(m, x, &cell, w), SN_E_DEFINITION, "outside the body");
    sn_mesh_destroy(m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finish),          cmocka_unit_test(finish_refuses),
        cmocka_unit_test(finish_shuffled), cmocka_unit_test(refine),
        cmocka_unit_test(questions),       cmocka_unit_test(locate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
