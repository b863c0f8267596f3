// Gmsh meshes: both versions, groups, node numbers, what is refused, damaged files.
// SPDX-License-Identifier: Apache-2.0
#include "allocator.h"
#include "hostile.h"

// A cube of edge 3 in six tetrahedra round the diagonal from 20 to 7, tags sparse and out of order.
// Two regions, one named; two surfaces, one named; a node that only a point uses; physical tag with
// a minus sign; comments.
#define HEAD_22 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define NAMES "$PhysicalNames\n3\n0 1 \"tip\"\n2 7 \"low er\"\n3 5 \"muscle\"\n$EndPhysicalNames\n"
#define NODES_22                                                                                   \
    "$Nodes\n9\n20 0 0 0\n1000000000000 3 0 0\n3 0 3 0\n4 3 3 0\n15 0 0 3\n6 3 0 3\n5 0 3 3\n"     \
    "7 3 3 3\n99 1 1 9\n$EndNodes\n"
#define BIG "1000000000000"
static const char cube_22[] =
    HEAD_22 "$Comments\nanything $Nodes\n$Nodes\n$EndComments\n" NAMES NODES_22
            "$Elements\n11\n1 15 2 1 1 99\n2 1 2 0 1 20 99\n"
            "3 2 2 -7 1 20 4 " BIG "\n4 2 2 7 1 3 4 20\n5 2 3 9 1 0 15 6 7\n"
            "6 4 2 5 1 20 " BIG " 4 7\n7 4 2 5 1 20 4 3 7\n8 4 2 5 1 20 3 5 7\n"
            "9 4 2 0 2 20 5 15 7\n10 4 2 0 2 20 15 6 7\n11 4 2 0 2 20 6 " BIG " 7\n$EndElements\n";

#define ENTITIES_41                                                                                \
    "$Entities\n1 1 2 2\n1 0 0 0 1 1\n1 0 0 0 3 0 0 0 2 1 -1\n"                                    \
    "1 0 0 0 3 3 0 1 -7 1 1\n2 0 0 3 3 3 3 1 9 0\n"                                                \
    "1 0 0 0 3 3 3 1 5 2 1 2\n2 0 0 0 3 3 3 0 0\n$EndEntities\n"
#define NODES_41                                                                                   \
    "$Nodes\n2 9 3 1000000000000\n0 1 0 1\n99\n1 1 9\n3 1 1 8\n20\n" BIG                           \
    "\n3\n4\n15\n6\n5\n7\n0 0 0 0.1 0.2 0.3\n3 0 0\n0 3 0\n3 3 0\n0 0 3\n3 0 3\n0 3 3\n3 3 3\n"    \
    "$EndNodes\n"
static const char cube_41[] =
    "$MeshFormat\r\n4.1 0 8\r\n$EndMeshFormat\r\n" NAMES ENTITIES_41 NODES_41
    "$Elements\n5 10 1 11\n0 1 15 1\n1 99\n2 1 2 2\n3 20 4 " BIG "\n4 3 4 20\n"
    "2 2 2 1\n5 15 6 7\n3 1 4 3\n6 20 " BIG " 4 7\n7 20 4 3 7\n8 20 3 5 7\n"
    "3 2 4 3\n9 20 5 15 7\n10 20 15 6 7\n11 20 6 " BIG " 7\n$EndElements";

static sn_status read_metres(const char *path) {
    sn_mesh *mesh;
    sn_status status = sn_mesh_read_gmsh(path, 1, &mesh);
    if (status != SN_OK) {
        assert_null(mesh);
        return status;
    }
    for (int i = 0; i < 3 * mesh->node_count; i++) assert_true(isfinite(mesh->node[i]));
    assert_true(mesh->cell_count > 0 && mesh->region_count > 0);
    sn_mesh_destroy(mesh);
    return SN_OK;
}

static sn_mesh *read_text(const char *text, double scale) {
    sn_mesh *mesh;
    CHECK_OK(sn_mesh_read_gmsh(scratch_write("m.msh", text, strlen(text)), scale, &mesh));
    return mesh;
}

static double region_volume(const sn_mesh *mesh, int region) {
    double sum = 0;
    for (int c = 0; c < mesh->cell_count; c++) {
        if (mesh->region[c] != region) continue;
        double e[3][3];
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                e[k][i] = mesh->node[3 * mesh->cell[4 * c + k + 1] + i] -
                          mesh->node[3 * mesh->cell[4 * c] + i];
        sum += (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
               6;
    }
    return sum;
}

static void test_cube(void **state) {
    (void)state;
    const char *const texts[] = {cube_22, cube_41};
    for (int v = 0; v < 2; v++) {
        sn_mesh *mesh = read_text(texts[v], 1e-3);
        assert_int_equal(mesh->node_count, 8); // node 99 belongs to no tetrahedron
        assert_int_equal(mesh->cell_count, 6);
        assert_int_equal(mesh->region_count, 2);
        assert_string_equal(mesh->region_name[0], "muscle");
        assert_string_equal(mesh->region_name[1], "body");
        // half of 27 mm3 each; a handful of roundings
        CHECK_REL(region_volume(mesh, 0), 13.5e-9, 1e-14);
        CHECK_REL(region_volume(mesh, 1), 13.5e-9, 1e-14);
        assert_int_equal(mesh->surface_count, 3);
        assert_string_equal(mesh->surface[0].name, "low er");
        assert_int_equal(mesh->surface[0].face_count, 2);
        assert_string_equal(mesh->surface[1].name, "surface_9");
        assert_int_equal(mesh->surface[1].face_count, 1);
        assert_string_equal(mesh->surface[2].name, "boundary");
        assert_int_equal(mesh->surface[2].face_count, 12);
        // the nodes keep the order of the file
        double second[3] = {3e-3, 0, 0};
        for (int i = 0; i < 3; i++) CHECK_ABS(mesh->node[3 + i], second[i], 0);
        for (int k = 0; k < 6; k++) CHECK_ABS(mesh->node[3 * mesh->surface[0].face[k] + 2], 0, 0);
        sn_mesh_destroy(mesh);
    }
}

// Second order: the midside nodes are dropped, their tags checked.
static void test_second_order(void **state) {
    (void)state;
    static const char text[] =
        HEAD_22 "$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n"
                "8 0 0 .5\n9 0 .5 .5\n10 .5 0 .5\n$EndNodes\n$Elements\n2\n"
                "1 9 2 4 1 1 3 2 7 6 5\n2 11 2 0 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";
    sn_mesh *mesh = read_text(text, 2);
    assert_int_equal(mesh->node_count, 4);
    assert_int_equal(mesh->cell_count, 1);
    assert_string_equal(mesh->region_name[0], "body");
    assert_string_equal(mesh->surface[0].name, "surface_4");
    assert_int_equal(mesh->surface[0].face_count, 1);
    CHECK_REL(sn_mesh_volume(mesh), 8.0 / 6, 1e-15);
    sn_mesh_destroy(mesh);
}

// A surface may be in two groups (4.1): its triangles are in both.
static void test_two_groups(void **state) {
    (void)state;
    static const char text[] =
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"one\"\n2 2 \"\"\n"
        "$EndPhysicalNames\n$Entities\n0 0 1 1\n4 0 0 0 1 1 1 2 1 2 0\n3 0 0 0 1 1 1 1 12 0\n"
        "$EndEntities\n$Nodes\n1 4 1 4\n3 3 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
        "$EndNodes\n$Elements\n2 2 1 2\n2 4 2 1\n1 1 2 3\n3 3 4 1\n2 1 2 3 4\n$EndElements\n";
    sn_mesh *mesh = read_text(text, 1);
    assert_int_equal(mesh->surface_count, 3);
    assert_string_equal(mesh->surface[0].name, "one");
    assert_string_equal(mesh->surface[1].name, "surface_2"); // an empty name is none
    assert_string_equal(mesh->region_name[0], "volume_12");
    for (int s = 0; s < 2; s++) {
        assert_int_equal(mesh->surface[s].face_count, 1);
        assert_int_equal(mesh->surface[s].cell[0], 0);
    }
    sn_mesh_destroy(mesh);
}

// A built block, written in both versions with scrambled tags, reads back as the same mesh.
static void test_block(void **state) {
    (void)state;
    sn_mesh *block;
    sn_shape_def def = {
        .shape = SN_SHAPE_BLOCK, .size = {0.013, 0.0171, 0.0234}, .cells = {7, 8, 9}};
    CHECK_OK(sn_mesh_build(&def, &block));
    for (int version = 0; version < 2; version++) {
        const char *path = scratch_path(version ? "block41.msh" : "block22.msh");
        FILE *file = fopen(path, "w");
        fprintf(file, "$MeshFormat\n%s 0 8\n$EndMeshFormat\n$Nodes\n", version ? "4.1" : "2.2");
        // tags fall from node to node, with gaps
        if (version) {
            fprintf(file, "1 %d 1 9\n3 1 0 %d\n", block->node_count, block->node_count);
            for (int n = 0; n < block->node_count; n++) fprintf(file, "%d\n", 90000 - 7 * n);
        } else {
            fprintf(file, "%d\n", block->node_count);
        }
        for (int n = 0; n < block->node_count; n++) {
            if (!version) fprintf(file, "%d ", 90000 - 7 * n);
            for (int i = 0; i < 3; i++)
                fprintf(file, "%.17g%c", block->node[3 * n + i], i < 2 ? ' ' : '\n');
        }
        fprintf(file, "$EndNodes\n$Elements\n");
        if (version)
            fprintf(file, "1 %d 1 9\n3 1 4 %d\n", block->cell_count, block->cell_count);
        else
            fprintf(file, "%d\n", block->cell_count);
        for (int c = 0; c < block->cell_count; c++) {
            fprintf(file, version ? "%d" : "%d 4 2 0 1", c + 1);
            for (int k = 0; k < 4; k++) fprintf(file, " %d", 90000 - 7 * block->cell[4 * c + k]);
            fprintf(file, "\n");
        }
        fprintf(file, "$EndElements\n");
        fclose(file);

        sn_mesh *mesh;
        CHECK_OK(sn_mesh_read_gmsh(path, 1, &mesh));
        assert_int_equal(mesh->node_count, block->node_count);
        assert_int_equal(mesh->cell_count, block->cell_count);
        // 17 digits bring back the same doubles
        assert_memory_equal(mesh->node, block->node, 3 * sizeof(double) * (size_t)mesh->node_count);
        assert_memory_equal(mesh->cell, block->cell, 4 * sizeof(int) * (size_t)mesh->cell_count);
        sn_mesh_destroy(mesh);
    }
    sn_mesh_destroy(block);
}

#define TET_NODES "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
#define ELEMENTS(count, lines) "$Elements\n" count "\n" lines "$EndElements\n"
#define TET "1 4 2 0 1 1 2 3 4\n"
#define HEAD_41 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
#define TET_NODES_41 "$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"

static const hostile refused_text[] = {
    {"", SN_E_SYNTAX, ":1: found \"\", expected $MeshFormat", NULL},
    {"solid cube\n", SN_E_SYNTAX, ":1: found \"solid\", expected $MeshFormat", NULL},
    {"$MeshFormat\n2.2 1 8\n\1\n", SN_E_UNSUPPORTED, ":2: $MeshFormat: found a binary file",
     "-format msh41 -o"},
    {"$MeshFormat\n4.1 1 8\n", SN_E_UNSUPPORTED, "binary", "save it as ASCII"},
    {"$MeshFormat\n4 0 8\n$EndMeshFormat\n", SN_E_UNSUPPORTED,
     "found format 4, expected 2.2 or 4.1", "gmsh FILE"},
    {"$MeshFormat\n2.2 0\n", SN_E_SYNTAX, ":2: $MeshFormat: found the end of the line",
     "a data size"},
    {"$MeshFormat\n2.2 0 8\n", SN_E_SYNTAX, "expected $EndMeshFormat for line 1", "cut short"},
    {HEAD_22, SN_E_SYNTAX, "found no $Nodes", NULL},
    {HEAD_22 TET_NODES, SN_E_SYNTAX, "found no $Elements", NULL},
    {HEAD_22 TET_NODES TET_NODES, SN_E_SYNTAX, ":11: found a second $Nodes", "line 4"},
    {HEAD_22 "$Nodes\n1\n1 0 0 0\n$Elements\n", SN_E_SYNTAX,
     ":7: found \"$Elements\", expected $EndNodes for line 4", NULL},
    {HEAD_22 "loose\n" TET_NODES, SN_E_SYNTAX, ":4: found \"loose\"", "section"},
    {HEAD_22 "$Nodes\n4\n1 0.0000000000 0 0\n2 1 0 0\n$EndNodes\n", SN_E_SYNTAX,
     ":8: $Nodes: found $EndNodes", "fewer nodes"},
    {HEAD_22 "$Nodes\n1\n1 0 0 0\n2 1 0 0\n$EndNodes\n", SN_E_SYNTAX,
     ":7: $Nodes: found \"2 1 0 0\", expected $EndNodes", "more lines"},
    {HEAD_22 "$Nodes\n9000000000000\n1 0 0 0\n$EndNodes\n", SN_E_SYNTAX,
     ":5: $Nodes: found a number of nodes of 9000000000000", "bytes that follow"},
    {HEAD_22 "$Nodes\n99999999999999999999\n1 0 0 0\n$EndNodes\n", SN_E_SYNTAX,
     ":5: $Nodes: found \"99999999999999999999\"", NULL},
    {HEAD_22 "$Nodes\n-1\n$EndNodes\n", SN_E_SYNTAX, ":5: $Nodes: found \"-1\"", NULL},
    {HEAD_22 "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n" ELEMENTS("1", TET), SN_E_SYNTAX,
     ":7: $Nodes: found node 1 for the second time", "line 6"},
    {HEAD_22 "$Nodes\n1\n1 0 nan 0\n$EndNodes\n", SN_E_SYNTAX,
     ":6: $Nodes: found \"nan\", expected a coordinate", NULL},
    {HEAD_22 "$Nodes\n1\n1 0 1e999 0\n$EndNodes\n", SN_E_SYNTAX, "found \"1e999\"", NULL},
    {HEAD_22 "$Nodes\n1\n1 0 0\n$EndNodes\n", SN_E_SYNTAX, ":6: $Nodes: found the end of the line",
     "coordinate"},
    {HEAD_22 "$Nodes\n1\n1 0 0 0 0\n$EndNodes\n", SN_E_SYNTAX, "found \"0\" after the last number",
     NULL},
    {HEAD_22 "$Nodes\n1\n1 0 0,5 0\n$EndNodes\n", SN_E_SYNTAX, "found \"0,5\"", NULL},
    {HEAD_22 TET_NODES ELEMENTS("1", "1 4 2 0 1 1 2 3 5\n"), SN_E_SYNTAX,
     ":13: $Elements: found node 5, expected one of the 4", NULL},
    {HEAD_22 TET_NODES ELEMENTS("1", "1 29 2 0 1 1 2 3 4\n"), SN_E_UNSUPPORTED,
     ":13: $Elements: found tetrahedra of third order (type 29)", "first or second order"},
    {HEAD_22 TET_NODES ELEMENTS("1", "1 92 2 0 1 1 2 3 4\n"), SN_E_UNSUPPORTED,
     "unknown elements (type 92)", NULL},
    {HEAD_22 TET_NODES ELEMENTS("1", "1 4 2 0 1 1 2 3\n"), SN_E_SYNTAX,
     ":13: $Elements: found the end of the line", "tag of a node"},
    {HEAD_22 TET_NODES ELEMENTS("1", "1 4 2 0 1 1 2 3 4 4\n"), SN_E_SYNTAX, "found \"4\" after",
     NULL},
    {HEAD_22 TET_NODES ELEMENTS("2", TET), SN_E_SYNTAX, ":14: $Elements: found $EndElements",
     "fewer elements"},
    {HEAD_22 TET_NODES ELEMENTS("1", TET TET), SN_E_SYNTAX,
     ":14: $Elements: found \"1 4 2 0 1 1 2 3 4\"", "more lines"},
    {HEAD_22 TET_NODES ELEMENTS("1", "1 2 2 7 1 1 2 3\n"), SN_E_MESH, "found no tetrahedra",
     "-save_all"},
    {HEAD_22 TET_NODES ELEMENTS("2", TET "2 4 2 0 1 1 2 3 3\n"), SN_E_MESH, "flat", NULL},
    {HEAD_22 "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 2 0 0\n$EndNodes\n" ELEMENTS(
         "2", TET "2 2 2 7 1 1 2 5\n"),
     SN_E_MESH, "surface \"surface_7\" has a triangle with a node at (2, 0, 0) m",
     "no tetrahedron"},
    {HEAD_22 "$PhysicalNames\n1\n3 1 \"body\"\n$EndPhysicalNames\n" TET_NODES ELEMENTS(
         "2", TET "2 4 2 1 1 1 2 3 4\n"),
     SN_E_MESH, "two regions have the name \"body\"", NULL},
    {HEAD_22 "$PhysicalNames\n1\n3 1 body\n$EndPhysicalNames\n", SN_E_SYNTAX,
     ":6: $PhysicalNames: found \"body\", expected a name in double quotes", NULL},
    {HEAD_22 "$PhysicalNames\n2\n3 1 \"a\"\n3 1 \"b\"\n$EndPhysicalNames\n", SN_E_SYNTAX,
     ":7: $PhysicalNames: found a second name for the physical group 1", NULL},
    {HEAD_22
     "$PhysicalNames\n1\n3 1 \"a234567890123456789012345678901234567890123456789012345678901"
     "23456789\"\n$EndPhysicalNames\n",
     SN_E_SYNTAX, "found a name of 69 bytes, expected at most 63", NULL},
    {HEAD_41 "$PartitionedEntities\n2\n$EndPartitionedEntities\n", SN_E_UNSUPPORTED, "partitions",
     NULL},
    {HEAD_41 "$Entities\n0 0 0 2\n1 0 0 0 1 1 1 0 0\n1 0 0 0 1 1 1 0 0\n$EndEntities\n",
     SN_E_SYNTAX, "found entity 1 of dimension 3 twice", NULL},
    {HEAD_41 "$Nodes\n1 4 1 4\n3 1 0 5\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n",
     SN_E_SYNTAX, ":6: $Nodes: found 5 nodes in this block, expected at most 4", NULL},
    {HEAD_41 "$Nodes\n1 4 1 4\n3 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n", SN_E_SYNTAX,
     "found 3 nodes in all blocks, expected the 4", NULL},
    {HEAD_41 "$Nodes\n9 4 1 4\n3 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n", SN_E_SYNTAX,
     "fewer blocks", NULL},
    {HEAD_41 TET_NODES_41 "$Elements\n1 1 1 1\n2 1 4 1\n1 1 2 3 4\n$EndElements\n", SN_E_SYNTAX,
     "found tetrahedra (type 4) in an entity of dimension 2", NULL},
    {HEAD_41 TET_NODES_41 "$Elements\n1 7 1 1\n3 1 4 900000\n1 1 2 3 4\n$EndElements\n",
     SN_E_SYNTAX, "found a number of elements of 900000", NULL},
    {HEAD_41 TET_NODES_41 "$Elements\n1 2 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n", SN_E_SYNTAX,
     "found 1 elements in all blocks, expected the 2", NULL},
    {HEAD_41 "$Entities\n0 0 0 1\n2 0 0 0 1 1 1 0 0\n$EndEntities\n" TET_NODES_41
             "$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n",
     SN_E_SYNTAX, "found entity 1 of dimension 3, expected one that $Entities lists", NULL},
    {HEAD_41 "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 2 3 4 0\n$EndEntities\n" TET_NODES_41
             "$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n",
     SN_E_MESH, "found volume 1 in 2 physical volumes (\"volume_3\", \"volume_4\")", NULL},
};

static void test_refused(void **state) {
    (void)state;
    check_hostile(read_metres, "h.msh", refused_text, sizeof refused_text / sizeof *refused_text);
    // a zero byte in the middle
    static const char zero[] =
        HEAD_22 TET_NODES "$Elements\n1\n1 4 2 0\0 1 1 2 3 4\n$EndElements\n";
    CHECK_FAILS(read_metres(scratch_write("z.msh", zero, sizeof zero - 1)), SN_E_SYNTAX,
                "found a zero byte at byte");
    CHECK_FAILS(read_metres(scratch_path("nowhere.msh")), SN_E_FILE, "nowhere.msh");
    CHECK_FAILS(read_metres(scratch), SN_E_FILE, "folder");
    sn_mesh *mesh;
    const char *good = scratch_write("g.msh", cube_22, sizeof cube_22 - 1);
    CHECK_FAILS(sn_mesh_read_gmsh(good, 0, &mesh), SN_E_RANGE, "scale");
    CHECK_FAILS(sn_mesh_read_gmsh(good, HUGE_VAL, &mesh), SN_E_RANGE, "scale");
    CHECK_FAILS(sn_mesh_read_gmsh(good, 1e308, &mesh), SN_E_SYNTAX, "overflows in metres");
    assert_null(mesh);
}

// More physical groups than are kept: refused before the search for one gets slow.
static void test_many_groups(void **state) {
    (void)state;
    size_t room = 5000 * 32, used = 0;
    char *text = malloc(room);
    used += (size_t)snprintf(text, room, HEAD_22 TET_NODES "$Elements\n5000\n");
    for (int e = 1; e <= 5000; e++)
        used += (size_t)snprintf(text + used, room - used, "%d 2 2 %d 1 1 2 3\n", e, e);
    used += (size_t)snprintf(text + used, room - used, "$EndElements\n");
    CHECK_FAILS(read_metres(scratch_write("many.msh", text, used)), SN_E_UNSUPPORTED, "4096");
    free(text);
}

// Wherever memory ends: SN_E_MEMORY, and nothing is lost.
static void test_memory(void **state) {
    (void)state;
    const char *path = scratch_write("memory.msh", cube_41, sizeof cube_41 - 1);
    sn_set_allocator(&counting);
    sn_status status = SN_E_MEMORY;
    long allowed = 0;
    for (; status == SN_E_MEMORY && allowed < 1000; allowed++) {
        allocations_left = allowed;
        status = read_metres(path);
    }
    sn_set_allocator(NULL);
    allocations_left = -1;
    CHECK_OK(status);
    assert_true(allowed > 10);
}

static void test_fuzz(void **state) {
    (void)state;
    check_fuzz(read_metres, "f22.msh", cube_22, 4000);
    check_fuzz(read_metres, "f41.msh", cube_41, 4000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube),       cmocka_unit_test(test_second_order),
        cmocka_unit_test(test_two_groups), cmocka_unit_test(test_block),
        cmocka_unit_test(test_refused),    cmocka_unit_test(test_many_groups),
        cmocka_unit_test(test_memory),     cmocka_unit_test(test_fuzz),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
