// Fields in VTK's XML: what is read back equals what was written, the collection lists the frames.
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include "hostile.h"
#include "markup.h"

// Decodes base64 by the alphabet of RFC 4648; returns the number of bytes.
static size_t decode(const char *text, unsigned char *out) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t count = 0;
    unsigned word = 0, bits = 0;
    for (const char *d; *text && (d = strchr(digits, *text)); text++) {
        word = word << 6 | (unsigned)(d - digits);
        bits += 6;
        if (bits >= 8) out[count++] = (unsigned char)(word >> (bits -= 8));
    }
    return count;
}

// The values of the array of this name: the first eight bytes are its size.
static void check_array(const char *text, const char *name, const void *values, size_t bytes) {
    char mark[128];
    snprintf(mark, sizeof mark, "Name=\"%s\"", name);
    const char *at = strstr(text, mark);
    assert_non_null(at);
    at = strchr(at, '>') + 1;
    unsigned char *out = malloc(strcspn(at, "<") + 16);
    size_t found = decode(at, out);
    uint64_t size;
    assert_int_equal(found, bytes + 8);
    memcpy(&size, out, 8);
    assert_int_equal(size, bytes);
    assert_memory_equal(out + 8, values, bytes);
    // padded to whole groups of four
    size_t length = strcspn(at, "<\n");
    assert_int_equal(length % 4, 0);
    free(out);
}

static sn_mesh *make_mesh(void) {
    sn_mesh *mesh;
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {0.01, 0.02, 0.03}, .cells = {2, 3, 1}};
    CHECK_OK(sn_mesh_build(&def, &mesh));
    return mesh;
}

static double *random_values(size_t count, uint64_t seed) {
    double *values = malloc(count * sizeof *values);
    for (size_t i = 0; i < count; i++) values[i] = check_random(&seed, -1, 1) * 1e-3;
    return values;
}

static void test_frames(void **state) {
    (void)state;
    sn_mesh *mesh = make_mesh();
    size_t nodes = (size_t)mesh->node_count, cells = (size_t)mesh->cell_count;
    double *motion = random_values(3 * nodes, 3), *stress = random_values(6 * cells, 5),
           *density = random_values(cells, 7);
    density[1] = (double)NAN;
    sn_field fields[] = {
        {"displacement", "m", SN_ON_NODES, 3, motion},
        {"Cauchy stress", "Pa", SN_ON_CELLS, 6, stress},
        {"energy <\"&'>", "", SN_ON_CELLS, 1, density},
    };
    sn_vtu *vtu;
    CHECK_OK(sn_vtu_create(scratch, "fields", mesh, &vtu));
    static const double times[] = {0, 0.05, 1.0 / 3};
    for (int f = 0; f < 3; f++) {
        CHECK_OK(sn_vtu_frame(vtu, &(sn_frame){times[f], 3, fields}));
        // complete after every frame: f + 1 frames and no more
        char *list = scratch_read("fields.pvd");
        assert_true(is_well_formed(list, true));
        int count = 0;
        for (const char *at = list; (at = strstr(at, "<DataSet")); at++) count++;
        assert_int_equal(count, f + 1);
        char name[64];
        snprintf(name, sizeof name, "file=\"fields_%04d.vtu\"", f);
        const char *entry = strstr(list, name);
        assert_non_null(entry);
        while (strncmp(entry, "timestep=\"", 10)) entry--;
        CHECK_ABS(atof(entry + 10), times[f], 0);
        free(list);
    }
    sn_vtu_destroy(vtu);

    char *text = scratch_read("fields_0002.vtu");
    assert_non_null(text);
    assert_true(is_well_formed(text, true));
    assert_non_null(strstr(text, "header_type=\"UInt64\""));
    char counts[96];
    snprintf(counts, sizeof counts, "NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\"", nodes, cells);
    assert_non_null(strstr(text, counts));
    check_array(text, "Points", mesh->node, 3 * nodes * sizeof(double));
    check_array(text, "connectivity", mesh->cell, 4 * cells * sizeof(int));
    check_array(text, "region", mesh->region, cells * sizeof(int));
    check_array(text, "displacement", motion, 3 * nodes * sizeof(double));
    check_array(text, "Cauchy stress", stress, 6 * cells * sizeof(double));
    check_array(text, "energy &lt;&quot;&amp;&#39;&gt;", density, cells * sizeof(double));
    int32_t *ends = malloc(cells * sizeof *ends);
    unsigned char *types = malloc(cells);
    for (size_t c = 0; c < cells; c++) ends[c] = (int32_t)(4 * c + 4), types[c] = 10;
    check_array(text, "offsets", ends, cells * sizeof *ends);
    check_array(text, "types", types, cells);
    // node fields stand under the nodes, cell fields under the cells
    const char *point_data = strstr(text, "<PointData>"), *cell_data = strstr(text, "<CellData>");
    assert_true(point_data < strstr(text, "\"displacement\""));
    assert_true(strstr(text, "\"displacement\"") < cell_data);
    assert_true(cell_data < strstr(text, "\"Cauchy stress\""));
    // the unit of stress, and none where there is none
    assert_non_null(strstr(text, "location=\"vtkDataArray\">Pa</InformationKey>"));
    int units = 0;
    for (const char *at = text; (at = strstr(at, "UNITS_LABEL")); at++) units++;
    assert_int_equal(units, 2);
    free(text);
    free(ends);
    free(types);
    free(motion);
    free(stress);
    free(density);
    sn_mesh_destroy(mesh);
}

// Cells that were removed are in no frame, nor are their values; the others say who they are.
static void test_removed(void **state) {
    (void)state;
    sn_mesh *mesh = make_mesh();
    const size_t cells = (size_t)mesh->cell_count;
    double *stress = random_values(6 * cells, 5), *removed = calloc(cells, sizeof *removed);
    double *left = malloc(6 * cells * sizeof *left);
    int *nodes = malloc(4 * cells * sizeof *nodes), *names = malloc(cells * sizeof *names);
    const sn_field fields[] = {{"stress", "Pa", SN_ON_CELLS, 6, stress},
                               {"removed", "1", SN_ON_CELLS, 1, removed}};
    sn_vtu *vtu;
    CHECK_OK(sn_vtu_create(scratch, "cut", mesh, &vtu));
    for (int f = 0; f < 3; f++) { // none, every third, all
        size_t count = 0;
        for (size_t e = 0; e < cells; e++) {
            removed[e] = f == 2 || (f == 1 && e % 3 == 1);
            if (removed[e] != 0) continue;
            memcpy(nodes + 4 * count, mesh->cell + 4 * e, 4 * sizeof *nodes);
            memcpy(left + 6 * count, stress + 6 * e, 6 * sizeof *left);
            names[count++] = (int)e;
        }
        CHECK_OK(sn_vtu_frame(vtu, &(sn_frame){f, 2, fields}));
        char name[32], head[64];
        snprintf(name, sizeof name, "cut_%04d.vtu", f);
        char *text = scratch_read(name);
        assert_true(is_well_formed(text, true));
        snprintf(head, sizeof head, "NumberOfCells=\"%zu\"", count);
        assert_non_null(strstr(text, head));
        check_array(text, "connectivity", nodes, 4 * count * sizeof *nodes);
        check_array(text, "cell", names, count * sizeof *names);
        check_array(text, "stress", left, 6 * count * sizeof *left);
        assert_null(strstr(text, "\"removed\""));
        free(text);
    }
    sn_vtu_destroy(vtu);
    free(stress);
    free(removed);
    free(left);
    free(nodes);
    free(names);
    sn_mesh_destroy(mesh);
}

static void test_refused(void **state) {
    (void)state;
    sn_mesh *mesh = make_mesh();
    // the name of a region cannot end the comment it stands in
    snprintf(mesh->region_name[0], SN_NAME_MAX, "a--><b>--");
    sn_vtu *vtu;
    CHECK_OK(sn_vtu_create(scratch, "named", mesh, &vtu));
    CHECK_OK(sn_vtu_frame(vtu, &(sn_frame){0}));
    sn_vtu_destroy(vtu);
    char *text = scratch_read("named_0000.vtu");
    assert_true(is_well_formed(text, true));
    free(text);

    char folder[300];
    snprintf(folder, sizeof folder, "%s/missing", scratch);
    CHECK_OK(sn_vtu_create(folder, "fields", mesh, &vtu));
    CHECK_FAILS(sn_vtu_frame(vtu, &(sn_frame){0}), SN_E_FILE, "missing/fields_0000.vtu");
    // a frame that failed is not counted: the next one takes its place
    CHECK_OK(sn_folder_make(folder));
    CHECK_OK(sn_vtu_frame(vtu, &(sn_frame){.time = 2}));
    assert_null(scratch_read("missing/fields_0001.vtu"));
    text = scratch_read("missing/fields.pvd");
    assert_non_null(strstr(text, "timestep=\"2\" part=\"0\" file=\"fields_0000.vtu\""));
    free(text);
    remove(scratch_path("missing/fields.pvd"));
    remove(scratch_path("missing/fields_0000.vtu"));
    sn_vtu_destroy(vtu);
    sn_vtu_destroy(NULL);
    sn_mesh_destroy(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames),
        cmocka_unit_test(test_removed),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
