// STL files: text and binary, what is refused, damaged files.
// SPDX-License-Identifier: Apache-2.0
#include "hostile.h"

// a tetrahedron with corners 0, x, y, z, outward
static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
static const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};

static size_t text_stl(char *out, int count) {
    size_t at = (size_t)sprintf(out, "solid tip\n");
    for (int f = 0; f < count; f++) {
        at += (size_t)sprintf(out + at, " facet normal 0 0 0\n  outer loop\n");
        for (int k = 0; k < 3; k++) {
            const float *x = corners[faces[f][k]];
            at += (size_t)sprintf(out + at, "   vertex %g %g %.3e\n", (double)x[0], (double)x[1],
                                  (double)x[2]);
        }
        at += (size_t)sprintf(out + at, "  endloop\n endfacet\n");
    }
    return at + (size_t)sprintf(out + at, "endsolid tip\n");
}

static size_t binary_stl(char *out, int count) {
    memset(out, 0, 84 + 50 * (size_t)count);
    strcpy(out, "solid, although binary");
    out[80] = (char)count;
    for (int f = 0; f < count; f++)
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++) {
                float x = corners[faces[f][k]][d];
                unsigned bits;
                memcpy(&bits, &x, sizeof bits);
                for (int b = 0; b < 4; b++)
                    out[84 + 50 * f + 12 + 12 * k + 4 * d + b] = (char)(bits >> 8 * b);
            }
    return 84 + 50 * (size_t)count;
}

static sn_status read_metres(const char *path) {
    sn_tool_surface *surface;
    sn_status status = sn_tool_surface_read_stl(path, 1, &surface);
    if (status != SN_OK) {
        assert_null(surface);
        return status;
    }
    sn_tool tool = {.kind = SN_TOOL_MESH, .surface = surface};
    assert_true(isfinite(sn_tool_reach(&tool)));
    sn_tool_release(&tool);
    return SN_OK;
}

static void both_forms(void **state) {
    (void)state;
    char text[4096];
    const sn_pose pose = sn_pose_at((double[]){0, 0, 0});
    for (int form = 0; form < 2; form++) {
        size_t bytes = form ? binary_stl(text, 4) : text_stl(text, 4);
        sn_tool tool = {.kind = SN_TOOL_MESH};
        CHECK_OK(
            sn_tool_surface_read_stl(scratch_write("t.stl", text, bytes), 1e-3, &tool.surface));
        CHECK_REL(sn_tool_reach(&tool), 4e-3, 1e-15);
        const double r[3] = {1e-4, 5e-4, 6e-4}; // nearest to the side x = 0
        CHECK_REL(sn_tool_depth(&tool, &pose, r, NULL), 1e-4, 1e-12);
        sn_tool_release(&tool);
    }
}

static void refused(void **state) {
    (void)state;
    char text[4096];
    static const hostile cases[] = {
        {"", SN_E_SYNTAX, "0 vertices", NULL},
        {"a mesh of another kind", SN_E_SYNTAX, "three a triangle", NULL},
        {"facet\nvertex 0 0 0\nvertex 1 0 0\nfacet", SN_E_SYNTAX, "t.stl:4: \"facet\"",
         "three vertices"},
        {"vertex 0 0 nan", SN_E_SYNTAX, "t.stl:1: \"nan\"", "a coordinate"},
        {"vertex 0 0\n", SN_E_SYNTAX, "a coordinate", NULL},
        {"vertex 0 0 1e999", SN_E_SYNTAX, "a coordinate", NULL},
        {"vertex 0 0 0 vertex 1 0 0 vertex 0 1 0", SN_E_MESH, "t.stl", "at least 4"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *path = scratch_write("t.stl", cases[k].text, strlen(cases[k].text));
        CHECK_FAILS(read_metres(path), cases[k].status, cases[k].part);
        if (cases[k].part2) CHECK_FAILS(read_metres(path), cases[k].status, cases[k].part2);
    }
    size_t bytes = text_stl(text, 4);
    text[bytes / 2] = 0; // a zero in a text ends it: two triangles are left
    CHECK_FAILS(read_metres(scratch_write("t.stl", text, bytes)), SN_E_MESH, "t.stl: 2 triangles");
    CHECK_FAILS(read_metres(scratch_path("none.stl")), SN_E_FILE, "none.stl");
}

// every prefix and many single-byte changes: an answer, never a crash
static void damaged(void **state) {
    (void)state;
    char text[4096];
    uint64_t seed = 99;
    for (int form = 0; form < 2; form++) {
        size_t bytes = form ? binary_stl(text, 4) : text_stl(text, 4);
        for (size_t n = 0; n < bytes; n += 3) (void)read_metres(scratch_write("t.stl", text, n));
        for (int trial = 0; trial < 300; trial++) {
            size_t at = (size_t)check_random(&seed, 0, (double)bytes);
            char was = text[at];
            text[at] = (char)check_random(&seed, -128, 128);
            (void)read_metres(scratch_write("t.stl", text, bytes));
            text[at] = was;
        }
        CHECK_OK(read_metres(scratch_write("t.stl", text, bytes)));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_forms),
        cmocka_unit_test(refused),
        cmocka_unit_test(damaged),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
