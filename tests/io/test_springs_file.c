// Springs given one by one in a file: what was written is read, and what is wrong is named.
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include "check.h"
#include "sinew/io.h"

static const char path[] = "springs-test.csv";

static sn_mesh *block(double length) {
    sn_mesh *mesh;
    const sn_shape_def def = {
        .shape = SN_SHAPE_BLOCK, .size = {length, 0.01, 0.01}, .cells = {2, 1, 1}};
    CHECK_OK(sn_mesh_build(&def, &mesh));
    return mesh;
}

static void round_trip(void **state) {
    (void)state;
    sn_mesh *mesh = block(0.02);
    sn_spring_set *set, *read;
    snprintf(mesh->region_name[0], SN_NAME_MAX, "liver, left: \"deep\"");
    CHECK_OK(sn_spring_set_create(3, 1, &set));
    for (int k = 0; k < 3; k++) {
        set->end[2 * k] = 11 - k; // of twelve nodes
        set->end[2 * k + 1] = k;
        set->stiffness[k] = 100.0 / 3 + k;
    }
    set->exponent[0] = -1.0 / 3;
    for (int given = 0; given < 2; given++) {
        if (given) set->bulk[0] = 1e4 / 7;
        for (int k = 0; k < SN_SPRING_SQUARES && given; k++)
            set->square[k] = k == 6 ? 20.0 / 7 : k < 3 ? (9 - k) / 7.0 : -1.0 / 7;
        CHECK_OK(sn_springs_write(path, mesh, set, "a remark: nobody reads it"));
        CHECK_OK(sn_springs_read(path, mesh, &read));
        assert_int_equal(read->count, 3);
        assert_memory_equal(read->end, set->end, 6 * sizeof *set->end);
        assert_memory_equal(read->stiffness, set->stiffness, 3 * sizeof *set->stiffness);
        assert_true(read->exponent[0] == set->exponent[0]);
        assert_memory_equal(read->square, set->square, SN_SPRING_SQUARES * sizeof(double));
        assert_true(given ? read->bulk[0] == set->bulk[0] : isnan(read->bulk[0]));
        sn_spring_set_destroy(read);
    }
    sn_mesh *other = block(0.021);
    snprintf(other->region_name[0], SN_NAME_MAX, "%s", mesh->region_name[0]);
    CHECK_FAILS(sn_springs_read(path, other, &read), SN_E_DEFINITION, "of another mesh");
    assert_null(read);
    sn_mesh_destroy(other);
    sn_spring_set_destroy(set);
    sn_mesh_destroy(mesh);
    unlink(path);
}

static void units(void **state) {
    (void)state;
    static const char text[] = "# exponent of body: 2\n"
                               "from;to;region;length [mm];stiffness [kN/m]\n"
                               "0;1;body;10;0.5\n";
    sn_mesh *mesh = block(0.02);
    sn_spring_set *set;
    CHECK_OK(sn_text_write(path, text, strlen(text)));
    CHECK_OK(sn_springs_read(path, mesh, &set));
    CHECK_REL(set->stiffness[0], 500, 1e-15);
    sn_spring_set_destroy(set);
    sn_mesh_destroy(mesh);
    unlink(path);
}

#define TABLE "from,to,region,length [m],stiffness [N/m]\n"
#define HEAD "# exponent of body: 2\n" TABLE

static void bad_files(void **state) {
    (void)state;
    static const struct {
        const char *text, *part;
        sn_status status;
    } bad[] = {
        {"", "no springs", SN_E_DATA},
        {HEAD, "no springs", SN_E_DATA},
        {"from,to,region,length,stiffness [N/m]\n", ":1: expected the header", SN_E_SYNTAX},
        {"from,to,region,length [Pa],stiffness [N/m]\n", ":1:", SN_E_UNIT},
        {"from,to,length [m],stiffness [N/m]\n", ":1: expected the header", SN_E_SYNTAX},
        {HEAD "0,1,body,0.01\n", ":3: 4 cells, expected 5", SN_E_SYNTAX},
        {HEAD "0,1,body,0.01,5\n0,12,body,0.01,5\n", ":4: column \"to\": node 12", SN_E_DEFINITION},
        {HEAD "-1,1,body,0.01,5\n", "column \"from\": node -1", SN_E_DEFINITION},
        {HEAD "0.5,1,body,0.01,5\n", "node 0.5", SN_E_DEFINITION},
        {HEAD "a,1,body,0.01,5\n", "\"a\" is not a number", SN_E_SYNTAX},
        {HEAD "0,1,skin,0.01,5\n", "no region \"skin\"", SN_E_NAME},
        {HEAD "0,1,body,0.02,5\n", ":3: the spring from node 0 to 1 is 0.02 m", SN_E_DEFINITION},
        {HEAD "0,1,body,0.01,-5\n", ":3: a stiffness below 0", SN_E_RANGE},
        {HEAD "1,1,body,0,5\n", ":3: a spring with one node", SN_E_DEFINITION},
        {"# exponent of skin: 2\n", ":1: the mesh has no region \"skin\"", SN_E_NAME},
        {"# exponent of body: 2 kPa\n", ":1:", SN_E_UNIT},
        {"# bulk modulus of body: 2\n", ":1:", SN_E_UNIT},
        {"# squares of body: 1 2 3\n", ":1: squares \"1 2 3\": expected 7 numbers", SN_E_SYNTAX},
        {"# squares of body: 1 2 3 0 0 0 5 6\n", ":1: squares", SN_E_SYNTAX},
        {"# squares of body: 1 2 3 0 0 0 a\n", ":1: squares", SN_E_SYNTAX},
        {"# squares of skin: 1 2 3 0 0 0 5\n", ":1: the mesh has no region \"skin\"", SN_E_NAME},
        {HEAD "# squares of body: 1 1 1 0 0 0 -9\n0,1,body,0.01,5\n", "below 0", SN_E_RANGE},
        {TABLE "0,1,body,0.01,5\n", "no exponent", SN_E_KEY},
    };
    sn_mesh *mesh = block(0.02);
    sn_spring_set *set;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        CHECK_OK(sn_text_write(path, bad[k].text, strlen(bad[k].text)));
        CHECK_FAILS(sn_springs_read(path, mesh, &set), bad[k].status, bad[k].part);
        assert_non_null(strstr(sn_error_text(), path));
        assert_null(set);
    }
    unlink(path);
    CHECK_FAILS(sn_springs_read(path, mesh, &set), SN_E_FILE, path);
    sn_mesh_destroy(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),
        cmocka_unit_test(units),
        cmocka_unit_test(bad_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
