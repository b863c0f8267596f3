// Gmsh meshes of hexahedra, prisms and pyramids: cut alike by neighbours and surfaces.
// SPDX-License-Identifier: Apache-2.0
#include "hostile.h"

// A random order of 0 … n-1.
static void shuffle(int n, uint64_t *seed, int *order) {
    for (int k = 0; k < n; k++) order[k] = k;
    for (int k = n - 1; k > 0; k--) {
        int with = (int)check_random(seed, 0, k + 1), keep = order[k];
        order[k] = order[with];
        order[with] = keep;
    }
}

// Nodes at `x`, listed in the order `order` under the tags 1 … n of their own index.
static void write_nodes(FILE *file, int n, const double *x, const int *order) {
    fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", n);
    for (int k = 0; k < n; k++) {
        const double *at = x + 3 * order[k];
        fprintf(file, "%d %.17g %.17g %.17g\n", order[k] + 1, at[0], at[1], at[2]);
    }
    fprintf(file, "$EndNodes\n");
}

static void write_element(FILE *file, int tag, int type, int physical, int corners,
                          const int *node) {
    fprintf(file, "%d %d 2 %d 1", tag, type, physical);
    for (int k = 0; k < corners; k++) fprintf(file, " %d", node[k] + 1);
    fprintf(file, "\n");
}

// What the outer triangles enclose: the volume of the body if no face is left open inside.
static double enclosed(const sn_mesh *mesh) {
    const sn_surface *s = &mesh->surface[mesh->surface_count - 1];
    double sum = 0;
    assert_string_equal(s->name, "boundary");
    for (int f = 0; f < s->face_count; f++) {
        const double *a = mesh->node + 3 * s->face[3 * f], *b = mesh->node + 3 * s->face[3 * f + 1],
                     *c = mesh->node + 3 * s->face[3 * f + 2];
        sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                a[2] * (b[0] * c[1] - b[1] * c[0])) /
               6;
    }
    return sum;
}

enum { SIDE = 4, CORNERS = SIDE * SIDE * SIDE };

// 3 x 3 x 3 hexahedra with shuffled numbers and bent faces inside: whatever the numbers are, the
// cut is conforming. If two neighbours cut a quadrangle differently, four triangles of it would be
// left over in "boundary", and a surface's triangle would be the face of no cell.
static void block(void **state) {
    (void)state;
    uint64_t seed = 4711;
    for (int trial = 0; trial < 20; trial++) {
        double x[3 * CORNERS];
        int order[CORNERS], tag = 1, top = 0;
        for (int n = 0; n < CORNERS; n++) {
            int at[3] = {n % SIDE, n / SIDE % SIDE, n / SIDE / SIDE};
            bool inside = true;
            for (int i = 0; i < 3; i++) inside &= at[i] > 0 && at[i] + 1 < SIDE;
            for (int i = 0; i < 3; i++)
                x[3 * n + i] = at[i] + (inside ? check_random(&seed, -0.15, 0.15) : 0);
        }
        shuffle(CORNERS, &seed, order);
        const char *path = scratch_path("hex.msh");
        FILE *file = fopen(path, "w");
        write_nodes(file, CORNERS, x, order);
        fprintf(file, "$Elements\n%d\n", 27 + 9);
        for (int c = 0; c < 27; c++) {
            int n = c % 3 + SIDE * (c / 3 % 3) + SIDE * SIDE * (c / 9);
            const int node[8] = {n,      n + 1,  n + 5,  n + 4, // a layer is 16 further up
                                 n + 16, n + 17, n + 21, n + 20};
            write_element(file, tag++, 5, c < 9 ? 8 : 9, 8, node);
            if (c >= 18) write_element(file, tag++, 3, 7, 4, node + 4), top++;
        }
        fprintf(file, "$EndElements\n");
        fclose(file);
        sn_mesh *mesh;
        CHECK_OK(sn_mesh_read_gmsh(path, 1e-3, &mesh));
        assert_int_equal(mesh->split_cells, 27);
        assert_int_equal(mesh->cell_count, 6 * 27);
        assert_int_equal(mesh->node_count, CORNERS);
        assert_int_equal(mesh->region_count, 2);
        assert_string_equal(mesh->surface[0].name, "surface_7");
        assert_int_equal(mesh->surface[0].face_count, 2 * top);
        assert_int_equal(mesh->surface[1].face_count, 2 * 6 * 9);
        CHECK_REL(sn_mesh_volume(mesh), 27e-9, 1e-13); // rounding of 162 volumes
        CHECK_REL(enclosed(mesh), 27e-9, 1e-13);
        CHECK_REL(sn_mesh_area(mesh, 0), 9e-6, 1e-13);
        sn_mesh *copy;
        CHECK_OK(sn_mesh_copy(mesh, &copy));
        assert_int_equal(copy->split_cells, 27);
        sn_mesh_destroy(copy);
        sn_mesh_destroy(mesh);
    }
}

// All kinds side by side: a hexahedron, a pyramid on it (volume 1/3), a prism beside it (1/2) and a
// tetrahedron on the prism's triangle; with numbers in random order.
static void mixed(void **state) {
    (void)state;
    static const double x[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0,   0,   1, 1,   0,  1,
                               1, 1, 1, 0, 1, 1, 2, 0, 0, 2, 0, 1, 0.5, 0.5, 2, 1.3, -1, 0.3};
    static const int hexahedron[] = {0, 1, 2, 3, 4, 5, 6, 7}, pyramid[] = {4, 5, 6, 7, 10},
                     prism[] = {1, 8, 2, 5, 9, 6}, quadrangle[] = {8, 2, 6, 9},
                     tetrahedron[] = {1, 8, 9, 11};
    enum { NODES = 12 };
    uint64_t seed = 99;
    for (int trial = 0; trial < 300; trial++) {
        int order[NODES];
        shuffle(NODES, &seed, order);
        // a tetrahedron fits a quadrangle's half only if the cut runs through its nodes
        bool fits = false;
        int least = 1, place[NODES];
        for (int k = 0; k < NODES; k++) place[order[k]] = k;
        static const int side[4] = {1, 8, 9, 5};
        for (int k = 1; k < 4; k++)
            if (place[side[k]] < place[least]) least = side[k];
        fits = least == 1 || least == 9;
        const char *path = scratch_path("mixed.msh");
        FILE *file = fopen(path, "w");
        write_nodes(file, NODES, x, order);
        fprintf(file, "$Elements\n%d\n", fits ? 5 : 4);
        write_element(file, 1, 5, 1, 8, hexahedron);
        write_element(file, 2, 7, 1, 5, pyramid);
        write_element(file, 3, 6, 1, 6, prism);
        write_element(file, 4, 3, 2, 4, quadrangle);
        if (fits) write_element(file, 5, 4, 1, 4, tetrahedron);
        fprintf(file, "$EndElements\n");
        fclose(file);
        sn_mesh *mesh;
        CHECK_OK(sn_mesh_read_gmsh(path, 1, &mesh));
        double volume = 1 + 1.0 / 3 + 0.5 + (fits ? 1.0 / 6 : 0);
        assert_int_equal(mesh->split_cells, 3);
        assert_int_equal(mesh->cell_count, 6 + 2 + 3 + fits);
        CHECK_REL(sn_mesh_volume(mesh), volume, 1e-14);
        CHECK_REL(enclosed(mesh), volume, 1e-14);
        // 4 free quadrangles of the hexahedron, 4 triangles of the pyramid, 2 and 2 of the prism
        assert_int_equal(mesh->surface[1].face_count, 2 * 4 + 4 + 2 + 2 * 2 + (fits ? 2 : 0));
        assert_int_equal(mesh->surface[0].face_count, 2);
        sn_mesh_destroy(mesh);
    }
}

// Second order: midside, face and middle nodes are dropped. A cell whose numbers run the other way
// round is turned as tetrahedra are.
static void second_order(void **state) {
    (void)state;
    static const struct {
        int type, nodes, corners, cells;
        double volume;
    } kinds[] = {{17, 20, 8, 6, 1},   {12, 27, 8, 6, 1},       {18, 15, 6, 3, 0.5},
                 {13, 18, 6, 3, 0.5}, {19, 13, 5, 2, 1.0 / 3}, {14, 14, 5, 2, 1.0 / 3}};
    static const double hexahedron[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                            {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const int prism[6] = {0, 1, 3, 4, 5, 7};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int turned = 0; turned < 2; turned++) {
            const char *path = scratch_path("second.msh");
            FILE *file = fopen(path, "w");
            int nodes = kinds[k].nodes;
            fprintf(file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", nodes);
            for (int n = 0; n < nodes; n++) {
                const double *at = hexahedron[kinds[k].corners == 6 && n < 6 ? prism[n] : n % 8];
                fprintf(file, "%d %g %g %g\n", n + 1, at[0], at[1], turned ? -at[2] : at[2]);
            }
            fprintf(file, "$EndNodes\n$Elements\n1\n1 %d 2 0 1", kinds[k].type);
            for (int n = 0; n < nodes; n++) fprintf(file, " %d", n + 1);
            fprintf(file, "\n$EndElements\n");
            fclose(file);
            sn_mesh *mesh;
            CHECK_OK(sn_mesh_read_gmsh(path, 1, &mesh));
            assert_int_equal(mesh->node_count, kinds[k].corners);
            assert_int_equal(mesh->cell_count, kinds[k].cells);
            CHECK_REL(sn_mesh_volume(mesh), kinds[k].volume, 1e-15);
            sn_mesh_destroy(mesh);
        }
}

static sn_status read_it(const char *path) {
    sn_mesh *mesh;
    SN_TRY(sn_mesh_read_gmsh(path, 1, &mesh));
    sn_mesh_destroy(mesh);
    return SN_OK;
}

#define CUBE "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
#define CELL "$EndNodes\n$Elements\n1\n1 5 2 0 1 1 2 3 4 5 6 7 8\n$EndElements\n"

static void refused(void **state) {
    (void)state;
    static const hostile text[] = {
        // the top turned by 180 degrees
        {CUBE "5 1 1 1\n6 0 1 1\n7 0 0 1\n8 1 0 1\n" CELL, SN_E_MESH,
         ":17: $Elements: found one of the hexahedra so twisted", "remesh"},
        {CUBE "5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 0 0\n" CELL, SN_E_MESH, "flat", NULL},
        {CUBE "5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n$Elements\n1\n"
              "1 5 2 0 1 1 2 3 4 5 6 7\n$EndElements\n",
         SN_E_SYNTAX, ":17: $Elements: found the end of the line", "tag of a node"},
    };
    check_hostile(read_it, "bad.msh", text, sizeof text / sizeof *text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(block), cmocka_unit_test(mixed),
                                       cmocka_unit_test(second_order), cmocka_unit_test(refused)};
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
