// Case files.
// SPDX-License-Identifier: Apache-2.0
#include "hostile.h"

// all keys, as the manual has them
static const char valid[] =
    "case: indentation of a liver block\n"
    "mesh: {block: {size: [10 mm, 0.01 m, 5 mm], cells: [2, 3, 1], pattern: kuhn}}\n"
    "tissue: t.yaml\n"
    "fibres: [3, 0, 4]\n"
    "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\n"
    "supports: [{on: bottom, fix: xyz}, {on: left, fix: y}]\n"
    "loads:\n"
    "  - {on: top, displacement: [1 mm, free, -2 mm], time: {ramp: 1 s}}\n"
    "  - {on: right, traction: [0 kPa, 2 kPa, 0 kPa], time: {table: [[0 s, 0], [0.5 s, 80 %]]}}\n"
    "  - {on: back, pressure: 10 kPa}\n"
    "tools: [{name: ball, sphere: 5 mm, at: [5 mm, 5 mm, 11 mm], friction: 0.1,\n"
    "         path: [[0 s, 0 mm, 0 mm, 0 mm], [1 s, 0 mm, 1 mm, -10 mm]]}]\n"
    "probes: [{name: tip, point: [5 mm, 5 mm, 5 mm]}, {name: pull, reaction: top}]\n"
    "time: {until: 2 s, output_every: 50 ms}\n"
    "springs: {model: smoothed, volume: false, integrator: implicit, scheme: backward-euler, step: "
    "0.1 ms,\n"
    "          precision: double, threads: 2, damping: {mass: 3 1/s, stiffness: 2 ms}, "
    "memory_tolerance: 0.01}\n"
    "continuum: {element: P1, analysis: dynamic, steps: 7, tolerance: 1e-6, memory_tolerance: 1 "
    "%}\n";

static int setup(void **state) {
    static const char tissue[] =
        "tissue: t\ndensity: 1000 kg/m3\n"
        "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 300 kPa}\n";
    static const char bad[] = "tissue: t\nelastic: {law: neo-hookean, shear_modulus: 3}\n";
    if (scratch_open(state)) return -1;
    scratch_write("t.yaml", tissue, sizeof tissue - 1);
    scratch_write("bad.yaml", bad, sizeof bad - 1);
    return 0;
}

static sn_case *read_text(const char *text) {
    sn_case *c;
    CHECK_OK(sn_case_read(scratch_write("c.yaml", text, strlen(text)), &c));
    return c;
}

static void check_finite(const double *values, int count) {
    for (int i = 0; i < count; i++) assert_true(isfinite(values[i]));
}

static sn_status read_and_check(const char *path) {
    sn_case *c;
    sn_status status = sn_case_read(path, &c);
    if (status != SN_OK) {
        assert_null(c);
        return status;
    }
    check_finite(c->mesh->node, 3 * c->mesh->node_count);
    check_finite(c->fibre, 3);
    check_finite(c->gravity, 3);
    for (int k = 0; k < c->load_count; k++) {
        check_finite(c->load[k].vector, 3);
        check_finite(&c->load[k].pressure, 1);
        const sn_history *h = c->load[k].factor;
        if (h) check_finite(h->value, h->count * h->channels);
    }
    for (int k = 0; k < c->tool_count; k++) {
        check_finite(c->tool[k].at, 3);
        check_finite(&c->tool[k].radius, 1);
        const sn_history *h = c->tool[k].path;
        if (h) check_finite(h->value, h->count * h->channels);
    }
    check_finite((const double[]){c->until, c->output_every, c->springs.step, c->springs.damping,
                                  c->springs.memory_tolerance, c->continuum.tolerance},
                 6);
    sn_case_destroy(c);
    return SN_OK;
}

//---- accepted ------------------------------------------------------------------------------------

static void check_loads(const sn_case *c) {
    double value[3];
    assert_int_equal(c->load_count, 3);
    const sn_load *move = &c->load[0], *pull = &c->load[1], *push = &c->load[2];
    assert_int_equal(move->kind, SN_LOAD_DISPLACEMENT);
    assert_int_equal(move->surface, sn_mesh_surface(c->mesh, "top"));
    CHECK_ABS(move->vector[0], 0.001, 0.0);
    CHECK_ABS(move->vector[2], -0.002, 0.0);
    assert_true(!move->free[0] && move->free[1] && !move->free[2]);
    sn_history_at(move->factor, 0.25, value);
    CHECK_ABS(value[0], 0.25, 0.0);
    sn_history_at(move->factor, 5, value);
    CHECK_ABS(value[0], 1.0, 0.0);
    assert_int_equal(pull->kind, SN_LOAD_TRACTION);
    CHECK_ABS(pull->vector[1], 2e3, 0.0);
    sn_history_at(pull->factor, 0.25, value);
    CHECK_ABS(value[0], 0.4, 1e-16);
    assert_int_equal(push->kind, SN_LOAD_PRESSURE);
    CHECK_ABS(push->pressure, 10e3, 0.0);
    assert_null(push->factor);
}

static void example_of_the_manual(void **state) {
    (void)state;
    sn_case *c = read_text(valid);
    assert_string_equal(c->name, "indentation of a liver block");
    assert_true(c->has_shape);
    assert_int_equal(c->shape.shape, SN_SHAPE_BLOCK);
    assert_int_equal(c->shape.pattern, SN_PATTERN_KUHN);
    assert_int_equal(c->mesh->cell_count, 6 * 2 * 3 * 1);
    CHECK_REL(sn_mesh_volume(c->mesh), 0.01 * 0.01 * 0.005, 1e-12);
    assert_string_equal(c->tissue[0].name, "t");
    CHECK_ABS(c->fibre[0], 0.6, 1e-16);
    CHECK_ABS(c->fibre[2], 0.8, 1.2e-16);
    CHECK_ABS(c->gravity[2], -9.81, 0.0);
    assert_int_equal(c->support_count, 2);
    assert_int_equal(c->support[1].surface, sn_mesh_surface(c->mesh, "left"));
    assert_true(c->support[0].fix[0] && c->support[0].fix[1] && c->support[0].fix[2]);
    assert_true(!c->support[1].fix[0] && c->support[1].fix[1] && !c->support[1].fix[2]);
    check_loads(c);
    assert_int_equal(c->tool_count, 1);
    assert_string_equal(c->tool[0].name, "ball");
    CHECK_ABS(c->tool[0].radius, 0.005, 0.0);
    CHECK_ABS(c->tool[0].at[2], 0.011, 0.0);
    CHECK_ABS(c->tool[0].friction, 0.1, 0.0);
    double at[3];
    sn_history_at(c->tool[0].path, 0.5, at);
    CHECK_ABS(at[1], 0.0005, 1e-18);
    CHECK_ABS(at[2], -0.005, 1e-18);
    assert_int_equal(c->probe_count, 2);
    assert_int_equal(c->probe[0].kind, SN_PROBE_POINT);
    CHECK_ABS(c->probe[0].point[2], 0.005, 0.0);
    assert_int_equal(c->probe[1].kind, SN_PROBE_REACTION);
    assert_int_equal(c->probe[1].surface, sn_mesh_surface(c->mesh, "top"));
    CHECK_ABS(c->until, 2.0, 0.0);
    CHECK_ABS(c->output_every, 0.05, 0.0);
    const sn_springs_def *s = &c->springs;
    assert_true(s->rung == SN_RUNG_SMOOTHED && !s->volume && s->precision == SN_DOUBLE);
    assert_true(s->integrator == SN_INTEGRATOR_IMPLICIT && s->threads == 2);
    CHECK_ABS(s->step, 1e-4, 0.0);
    CHECK_ABS(s->damping, 3.0, 0.0);
    CHECK_ABS(s->stiffness_damping, 2e-3, 1e-18);
    assert_int_equal(s->scheme, SN_SCHEME_BACKWARD_EULER);
    CHECK_ABS(s->memory_tolerance, 0.01, 0.0);
    const sn_continuum_def *f = &c->continuum;
    assert_true(f->element == SN_ELEMENT_P1 && f->analysis == SN_ANALYSIS_DYNAMIC);
    assert_int_equal(f->steps, 7);
    CHECK_ABS(f->tolerance, 1e-6, 0.0);
    CHECK_ABS(f->memory_tolerance, 0.01, 0.0);
    sn_case_destroy(c);
}

#define M "mesh: {block: {size: [10 mm, 10 mm, 10 mm], cells: [2, 2, 2]}}\n"
#define BASE "case: c\n" M "tissue: t.yaml\n"
#define TIME "time: {until: 1 s, output_every: 0.5 s}\n"

static void little_is_needed(void **state) {
    (void)state;
    sn_case *c = read_text(BASE "time: {until: 1 s}\n");
    sn_springs_def s = sn_springs_def_default();
    sn_continuum_def f = sn_continuum_def_default();
    assert_int_equal(c->shape.pattern, SN_PATTERN_MIRRORED);
    assert_true(c->springs.rung == s.rung && c->springs.volume == s.volume);
    assert_true(c->springs.step == 0.0 && c->continuum.element == f.element);
    CHECK_ABS(c->output_every, 0.01, 0.0);
    assert_int_equal(c->support_count + c->load_count + c->tool_count + c->probe_count, 0);
    CHECK_ABS(fabs(c->fibre[0]) + fabs(c->gravity[2]), 0.0, 0.0);
    sn_case_destroy(c);
}

static void shapes_are_built(void **state) {
    (void)state;
    sn_case *c = read_text("case: c\ntissue: t.yaml\ntime: {until: 1 s}\nmesh: {cylinder: "
                           "{radius: 5 mm, length: 2 cm, cells: [2, 12, 3]}, pattern: kuhn}\n");
    assert_int_equal(c->shape.shape, SN_SHAPE_CYLINDER);
    assert_int_equal(c->shape.pattern, SN_PATTERN_KUHN);
    CHECK_ABS(c->shape.length, 0.02, 0.0);
    assert_true(sn_mesh_surface(c->mesh, "outer") >= 0);
    sn_case_destroy(c);
    c = read_text("case: c\ntissue: {body: t.yaml}\ntime: {until: 1 s}\n"
                  "mesh: {tube: {inner_radius: 4 mm, outer_radius: 5 mm, length: 2 mm,\n"
                  "  cells: [1, 12, 1]}}\n"
                  "loads: [{on: inner, pressure: 1 kPa, time: {ramp: 1 s}}]\n"
                  "springs: {step: auto}\n");
    assert_int_equal(c->shape.shape, SN_SHAPE_TUBE);
    assert_int_equal(c->shape.cells[1], 12);
    CHECK_ABS(c->shape.inner_radius, 0.004, 0.0);
    CHECK_ABS(c->springs.step, 0.0, 0.0);
    assert_string_equal(c->tissue[0].name, "t");
    sn_case_destroy(c);
}

// Two tetrahedra on one face, in millimetres, two regions.
static const char gmsh[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 1 \"skin\"\n3 2 \"wall\"\n3 3 \"core\"\n"
    "$EndPhysicalNames\n"
    "$Nodes\n5\n1 0 0 0\n2 10 0 0\n3 0 10 0\n4 0 0 10\n5 10 10 10\n$EndNodes\n"
    "$Elements\n3\n1 2 2 1 1 1 2 3\n2 4 2 2 1 1 2 3 4\n3 4 2 3 1 2 3 4 5\n"
    "$EndElements\n";

static void meshes_come_from_files(void **state) {
    (void)state;
    scratch_write("m.msh", gmsh, sizeof gmsh - 1);
    sn_case *c = read_text("case: c\nmesh: {file: m.msh, unit: mm}\ntissue: {wall: t.yaml, core: "
                           "t.yaml}\nsupports: [{on: skin, fix: z}]\ntime: {until: 1 s}\n");
    assert_false(c->has_shape);
    assert_int_equal(c->mesh->region_count, 2);
    CHECK_REL(sn_mesh_volume(c->mesh), 1e-6 / 6 + 2e-6 / 6, 1e-12);
    assert_string_equal(c->tissue[1].name, "t");
    sn_case_destroy(c);
    c = read_text("case: c\nmesh: {file: m.msh}\ntissue: t.yaml\ntime: {until: 1 s}\n");
    CHECK_REL(sn_mesh_volume(c->mesh), 0.5e3, 1e-12); // metres
    sn_case_destroy(c);
    static const hostile table[] = {
        {"case: c\nmesh: {file: m.msh, unit: kPa}\ntissue: t.yaml\n" TIME, SN_E_UNIT,
         "c.yaml:2:27: key \"mesh.unit\"", "a length"},
        {"case: c\nmesh: {file: m.msh, scale: 2}\ntissue: t.yaml\n" TIME, SN_E_KEY,
         "unknown key \"mesh.scale\"", NULL},
        {"case: c\nmesh: {file: no.msh}\ntissue: t.yaml\n" TIME, SN_E_FILE,
         "c.yaml:2:14: key \"mesh.file\"", "no.msh: cannot open"},
        {"case: c\nmesh: {file: m.msh, pattern: bcc}\ntissue: t.yaml\n" TIME, SN_E_KEY,
         "key \"mesh.pattern\"", NULL},
        {"case: c\nmesh: {file: m.msh}\ntissue: {wall: t.yaml}\n" TIME, SN_E_KEY,
         "key \"tissue\": no tissue for the region \"core\"", NULL},
        {"case: c\nmesh: {file: m.msh}\ntissue: {wall: t.yaml, cor: t.yaml}\n" TIME, SN_E_NAME,
         "key \"tissue.cor\"", "did you mean \"core\"?"},
    };
    check_hostile(read_and_check, "c.yaml", table, sizeof table / sizeof table[0]);
}

static void paths_are_relative_to_the_case(void **state) {
    (void)state;
    char text[1000];
    sn_case *c;
    snprintf(text, sizeof text, "case: c\n" M "tissue: %s/t.yaml\n" TIME, scratch); // absolute
    sn_case_destroy(read_text(text));
    // from another folder
    char here[512];
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir("/"), 0);
    sn_status status = sn_case_read(scratch_write("c.yaml", valid, sizeof valid - 1), &c);
    assert_int_equal(chdir(scratch), 0);
    if (status == SN_OK) sn_case_destroy(c);
    sn_status bare = sn_case_read("c.yaml", &c);
    assert_int_equal(chdir(here), 0);
    assert_int_equal(status, SN_OK);
    assert_int_equal(bare, SN_OK);
    sn_case_destroy(c);
}

//---- fibres --------------------------------------------------------------------------------------

#define TUBE                                                                                       \
    "case: c\ntissue: t.yaml\n" TIME                                                               \
    "mesh: {tube: {inner_radius: 4 mm, outer_radius: 5 mm, length: 2 mm, cells: [1, 6, 1]}}\n"
#define EGG                                                                                        \
    "case: c\ntissue: t.yaml\n" TIME "mesh: {ellipsoid: {inner: [7 mm, 17 mm], outer: [10 mm, "    \
    "20 mm], base: 5 mm, cells: [1, 6, 3]}}\n"

static void fibres_by_rule(void **state) {
    (void)state;
    const double degree = 0.017453292519943296;
    sn_case *c = read_text(BASE TIME "fibres: {direction: [3, 0, 4], sheet: [0, 2, 0]}\n");
    assert_int_equal(c->fibres.rule, SN_FIBRES_ALIKE);
    CHECK_ABS(c->fibre[2], 0.8, 1.2e-16);
    CHECK_ABS(c->fibres.sheet[1], 1, 0);
    sn_case_destroy(c);

    c = read_text(TUBE "fibres: {circumferential: z, angle: 30 deg}\n");
    assert_int_equal(c->fibres.rule, SN_FIBRES_AROUND);
    CHECK_ABS(c->fibres.axis[2], 1, 0);
    CHECK_REL(c->fibres.angle[1], 30 * degree, 1e-15);
    assert_true(c->fibres.wall[0] == -1 && c->fibres.wall[1] == -1); // away from the axis is exact
    assert_false(c->fibres.sheet_normal);
    sn_case_destroy(c);

    c = read_text(TUBE "fibres: {longitudinal: [0, 0, 2], angle: [60 deg, -60 deg], sheet: normal,"
                       " through: [1 mm, 0 mm, 0 mm]}\n");
    CHECK_REL(c->fibres.angle[0], 30 * degree, 1e-14);
    CHECK_REL(c->fibres.angle[1], 150 * degree, 1e-14);
    CHECK_ABS(c->fibres.through[0], 1e-3, 0);
    assert_int_equal(c->fibres.wall[0], sn_mesh_surface(c->mesh, "inner"));
    assert_int_equal(c->fibres.wall[1], sn_mesh_surface(c->mesh, "outer"));
    assert_true(c->fibres.sheet_normal);
    sn_case_destroy(c);

    c = read_text(EGG "fibres: {circumferential: z}\n"); // its wall leans: it needs the surfaces
    assert_int_equal(c->fibres.wall[0], sn_mesh_surface(c->mesh, "inner"));
    sn_case_destroy(c);
    c = read_text(BASE TIME "fibres: {circumferential: y, angle: [1 rad, 2 rad], walls: [bottom, "
                            "top]}\n");
    assert_int_equal(c->fibres.wall[1], sn_mesh_surface(c->mesh, "top"));
    sn_case_destroy(c);

    static const hostile table[] = {
        {TUBE "fibres: {circumferental: z}\n", SN_E_KEY, "unknown key \"fibres.circumferental\"",
         "did you mean \"circumferential\"?"},
        {TUBE "fibres: {angle: 30 deg}\n", SN_E_KEY, "key \"fibres\": expected one of direction",
         NULL},
        {TUBE "fibres: {circumferential: z, direction: [1, 0, 0]}\n", SN_E_KEY,
         "key \"fibres.circumferential\": expected one rule, \"direction\"", NULL},
        {TUBE "fibres: {direction: [1, 0, 0], angle: 30 deg}\n", SN_E_KEY,
         "unknown key \"fibres.angle\"", NULL},
        {TUBE "fibres: {direction: [1, 0, 0], sheet: [-2, 0, 0]}\n", SN_E_DEFINITION,
         "the sheet (-1, 0, 0) is along the fibre", NULL},
        {TUBE "fibres: {circumferential: r}\n", SN_E_SYNTAX,
         "key \"fibres.circumferential\": found \"r\", expected an axis", NULL},
        {TUBE "fibres: {circumferential: z, angle: 30}\n", SN_E_UNIT, "key \"fibres.angle\"", NULL},
        {TUBE "fibres: {circumferential: z, sheet: across}\n", SN_E_NAME, "key \"fibres.sheet\"",
         "wall, normal"},
        {TUBE "fibres: {circumferential: z, walls: [iner, outer]}\n", SN_E_NAME,
         "key \"fibres.walls[1]\"", "did you mean \"inner\"?"},
        {TUBE "fibres: {circumferential: z, walls: [inner, inner]}\n", SN_E_DEFINITION,
         "key \"fibres.walls\"", "two different"},
        {TUBE "fibres: {circumferential: z, walls: inner}\n", SN_E_SYNTAX, "key \"fibres.walls\"",
         "such as [inner, outer]"},
        {BASE TIME "fibres: {circumferential: z, angle: [1 rad, 2 rad]}\n", SN_E_KEY,
         "key \"fibres\": an angle that changes", "walls"},
        {BASE TIME "fibres: f.csv\n", SN_E_SYNTAX, "key \"fibres\": found \"f.csv\"",
         "{file: fibres.csv}"},
    };
    check_hostile(read_and_check, "c.yaml", table, sizeof table / sizeof table[0]);
}

static sn_status read_listed(const char *path) {
    (void)path; // f.csv, which the case names
    sn_case *c;
    static const char text[] =
        "case: c\nmesh: {file: m.msh, unit: mm}\ntissue: t.yaml\n" TIME "fibres: {file: f.csv}\n";
    sn_status status = sn_case_read(scratch_write("c.yaml", text, sizeof text - 1), &c);
    if (status == SN_OK) sn_case_destroy(c);
    return status;
}

static void fibres_from_a_file(void **state) {
    (void)state;
    static const char rows[] = "# two cells\nfx [1];fy;fz;sx;sy;sz\n\n0;0;2;1;0;0\n3;-4;0;0;0;-1\n";
    scratch_write("m.msh", gmsh, sizeof gmsh - 1);
    scratch_write("f.csv", rows, sizeof rows - 1);
    sn_case *c = read_text("case: c\nmesh: {file: m.msh, unit: mm}\ntissue: t.yaml\n" TIME
                           "fibres: {file: f.csv}\n");
    assert_int_equal(c->fibres.rule, SN_FIBRES_LISTED);
    assert_int_equal(c->fibres.count, 2);
    CHECK_REL(c->fibres.listed[6] / c->fibres.listed[7], -0.75, 1e-15);
    CHECK_ABS(c->fibres.listed[3], 1, 0);
    sn_case_destroy(c);
    static const hostile table[] = {
        {"fx,fy\n1,0\n", SN_E_SYNTAX, "f.csv:1: found a header of 2 columns", "fx,fy,fz"},
        {"fx,fy,sx\n1,0,0\n", SN_E_SYNTAX, "f.csv:1: found a header", NULL},
        {"fx,fy,fz [m]\n1,0,0\n", SN_E_SYNTAX, "f.csv:1: found a header", NULL},
        {"fx,fy,fz\n1,0,0\n0,0\n", SN_E_SYNTAX, "f.csv:3: found 2 columns, expected 3", NULL},
        {"fx,fy,fz\n1,0,0\n0,x,1\n", SN_E_SYNTAX, "f.csv:3: column 2: found \"x\"", NULL},
        {"fx,fy,fz\n1,0,0\n0,1e999,1\n", SN_E_SYNTAX, "f.csv:3: column 2", NULL},
        {"fx,fy,fz\n1,0,0\n0,0,0\n", SN_E_RANGE, "f.csv:3: the fibre has no length", NULL},
        {"fx,fy,fz,sx,sy,sz\n1,0,0,0,0,0\n", SN_E_RANGE, "f.csv:2: the second direction", NULL},
        {"fx,fy,fz,sx,sy,sz\n1,0,0,-3,0,0\n", SN_E_RANGE, "f.csv:2: the second direction is along",
         NULL},
        {"fx,fy,fz\n1,0,0\n", SN_E_DATA, "f.csv: found 1 rows, expected one for each of the 2",
         NULL},
        {"fx,fy,fz\n1,0,0\n1,0,0\n1,0,0\n", SN_E_DATA, "f.csv:4: more rows than the 2 cells", NULL},
        {"\n# nothing\n", SN_E_SYNTAX, "f.csv: empty", NULL},
    };
    check_hostile(read_listed, "f.csv", table, sizeof table / sizeof table[0]);
}

//---- refused -------------------------------------------------------------------------------------

#define MESH(x) "case: c\ntissue: t.yaml\n" TIME "mesh: " x "\n"
#define LOAD(x) BASE TIME "loads: [" x "]\n"
#define TOOL(x) BASE TIME "tools: [" x "]\n"
#define PROBE(x) BASE TIME "probes: [" x "]\n"

static void bad_bodies_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {"", SN_E_DATA, "the file is empty", NULL},
        {"case: [", SN_E_SYNTAX, "not YAML", NULL},
        {"a: &a [x,x]\nb: &b [*a,*a]\nc: [*b,*b]\n", SN_E_SYNTAX, "c.yaml:1:4: anchors", NULL},
        {BASE TIME "suports: []\n", SN_E_KEY,
         "c.yaml:5:1: unknown key \"suports\", did you mean \"supports\"?", NULL},
        {M "tissue: t.yaml\n" TIME, SN_E_KEY, "key \"case\" is missing", NULL},
        {"case: c\ntissue: t.yaml\n" TIME, SN_E_KEY, "key \"mesh\" is missing", NULL},
        {"case: c\n" M TIME, SN_E_KEY, "key \"tissue\" is missing", NULL},
        {BASE, SN_E_KEY, "key \"time\" is missing", NULL},
        {"case: c\n" M "tissue: nope.yaml\n" TIME, SN_E_FILE, "c.yaml:3:9: key \"tissue\"",
         "nope.yaml: cannot open"},
        {"case: c\n" M "tissue: bad.yaml\n" TIME, SN_E_UNIT, "c.yaml:3:9: key \"tissue\"",
         "bad.yaml:2:44: key \"elastic.shear_modulus\""},
        {"case: c\n" M "tissue: [t.yaml]\n" TIME, SN_E_SYNTAX, "key \"tissue\": found a list",
         NULL},
        {"case: c\n" M "tissue: {skin: t.yaml}\n" TIME, SN_E_NAME, "key \"tissue.skin\"",
         "\"body\""},
        {"case: c\n" M "tissue: {}\n" TIME, SN_E_KEY, "no tissue for the region \"body\"", NULL},
        {"case: c\n" M "tissue: c.yaml\n" TIME, SN_E_KEY, "key \"tissue\"",
         "c.yaml:1:1: unknown key \"case\""},
        {MESH("block"), SN_E_SYNTAX, "key \"mesh\": found \"block\", expected a map", NULL},
        {MESH("{}"), SN_E_KEY, "key \"mesh\": no shape", NULL},
        {MESH("{bloc: {}}"), SN_E_KEY, "did you mean \"block\"?", NULL},
        {MESH("{ellipsoid: {}}"), SN_E_KEY, "key \"mesh.ellipsoid.inner\" is missing", NULL},
        {MESH("{ellipsoid: {inner: [7 mm, 17 mm], outer: [10 mm, 20 mm], base: 18 mm, cells: [1, "
              "8, 4]}}"),
         SN_E_RANGE, "key \"mesh.ellipsoid\"", "does not cut"},
        {MESH("{ellipsoid: {inner: [7 mm, 17], outer: [10 mm, 20 mm], base: 5 mm, cells: [1, 8, "
              "4]}}"),
         SN_E_UNIT, "key \"mesh.ellipsoid.inner[2]\"", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [1, 1, 1]}, file: x.msh}"), SN_E_KEY,
         "key \"mesh.file\"", "\"block\" is given too"},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [1, 1, 1]}, unit: mm}"), SN_E_KEY,
         "key \"mesh.unit\"", NULL},
        {MESH("{block: {cells: [1, 1, 1]}}"), SN_E_KEY, "key \"mesh.block.size\" is missing", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m]}}"), SN_E_KEY, "key \"mesh.block.cells\" is missing",
         NULL},
        {MESH("{block: {size: [1 m, 1 m], cells: [1, 1, 1]}}"), SN_E_SYNTAX,
         "key \"mesh.block.size\": found a list of 2, expected 3", NULL},
        {MESH("{block: {size: 1 m, cells: [1, 1, 1]}}"), SN_E_SYNTAX,
         "key \"mesh.block.size\": found \"1 m\", expected a list of 3", NULL},
        {MESH("{block: {size: [1, 1, 1], cells: [1, 1, 1]}}"), SN_E_UNIT,
         "key \"mesh.block.size[1]\": found \"1\" without a unit, expected a length", NULL},
        {MESH("{block: {size: [1 m, -1 m, 1 m], cells: [1, 1, 1]}}"), SN_E_RANGE,
         "key \"mesh.block.size[2]\": found \"-1 m\", expected a length of more than 0", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [0, 2, 2]}}"), SN_E_RANGE,
         "c.yaml:4:47: key \"mesh.block.cells[1]\": found \"0\"", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [2.5, 2, 2]}}"), SN_E_SYNTAX,
         "found \"2.5\", expected a whole number", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [2, 2]}}"), SN_E_SYNTAX,
         "key \"mesh.block.cells\": expected a list of 3", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [200000, 200000, 200000]}}"), SN_E_RANGE,
         "c.yaml:4:15: key \"mesh.block\"", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [99999999999999999999, 1, 1]}}"), SN_E_RANGE,
         "key \"mesh.block.cells[1]\"", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [1, 1, 1], pattern: mirored}}"), SN_E_NAME,
         "did you mean \"mirrored\"?", NULL},
        {MESH("{block: {size: [1 m, 1 m, 1 m], cells: [1, 1, 1], pattern: kuhn}, pattern: kuhn}"),
         SN_E_KEY, "key \"mesh.pattern\": given twice", NULL},
        {MESH("{cylinder: {radius: 1 m, cells: [1, 12, 1]}}"), SN_E_KEY,
         "key \"mesh.cylinder.length\" is missing", NULL},
        {MESH("{tube: {inner_radius: 2 m, outer_radius: 1 m, length: 1 m, cells: [1, 12, 1]}}"),
         SN_E_RANGE, "key \"mesh.tube.outer_radius\"", "inner radius"},
        {BASE TIME "fibres: [0, 0, 0]\n", SN_E_RANGE, "key \"fibres\": the direction has no length",
         NULL},
        {BASE TIME "fibres: [1, 0]\n", SN_E_SYNTAX, "key \"fibres\": found a list of 2", NULL},
        {BASE TIME "fibres: [1 m, 0 m, 0 m]\n", SN_E_UNIT, "key \"fibres[1]\"", "is a length"},
        {BASE TIME "gravity: [0, 0, -9.81]\n", SN_E_UNIT, "key \"gravity[1]\"",
         "an acceleration such as"},
        {BASE TIME "gravity: -9.81 m/s2\n", SN_E_SYNTAX, "key \"gravity\"", "a list of 3"},
        {BASE "time: 1 s\n", SN_E_SYNTAX, "key \"time\": found \"1 s\"", NULL},
        {BASE "time: {output_every: 1 s}\n", SN_E_KEY, "key \"time.until\" is missing", NULL},
        {BASE "time: {until: 0 s}\n", SN_E_RANGE,
         "key \"time.until\": found \"0 s\", expected more than 0", NULL},
        {BASE "time: {until: 1 s, output_every: 1 ns}\n", SN_E_RANGE, "key \"time.output_every\"",
         "a millionth"},
        {BASE "time: {until: 1}\n", SN_E_UNIT, "key \"time.until\"", "a time such as"},
    };
    check_hostile(read_and_check, "c.yaml", table, sizeof table / sizeof table[0]);
}

static void bad_loads_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {BASE TIME "supports: {on: bottom, fix: xyz}\n", SN_E_SYNTAX,
         "key \"supports\": found a map, expected a list", NULL},
        {BASE TIME "supports: [{on: botom, fix: xyz}]\n", SN_E_NAME,
         "c.yaml:5:17: key \"supports[1].on\"", "bottom"},
        {BASE TIME "supports: [{fix: xyz}]\n", SN_E_KEY, "key \"supports[1].on\" is missing", NULL},
        {BASE TIME "supports: [{on: top}]\n", SN_E_KEY, "key \"supports[1].fix\" is missing", NULL},
        {BASE TIME "supports: [{on: top, fix: xw}]\n", SN_E_SYNTAX,
         "key \"supports[1].fix\": found \"xw\"", "such as xyz"},
        {BASE TIME "supports: [{on: top, fix: xx}]\n", SN_E_SYNTAX, "each once", NULL},
        {BASE TIME "supports: [{on: top, fix: }]\n", SN_E_SYNTAX, "found nothing", NULL},
        {BASE TIME "supports: [top]\n", SN_E_SYNTAX,
         "key \"supports[1]\": found \"top\", expected a map", NULL},
        {LOAD("{on: topp, pressure: 1 kPa}"), SN_E_NAME, "c.yaml:5:14: key \"loads[1].on\"", "top"},
        {LOAD("{on: top}"), SN_E_KEY, "key \"loads[1]\": no load", NULL},
        {LOAD("{on: top, pressure: 1 kPa, traction: [0 Pa, 0 Pa, 0 Pa]}"), SN_E_KEY,
         "key \"loads[1].pressure\"", "\"traction\" is given too"},
        {LOAD("{on: top, force: 1 N}"), SN_E_SYNTAX, "key \"loads[1].force\"", "a list of 3"},
        {LOAD("{on: top, weight: 1 N}"), SN_E_KEY, "unknown key \"loads[1].weight\"", NULL},
        {LOAD("{on: top, displacement: [0 mm, 0 mm, 1 kPa]}"), SN_E_UNIT,
         "c.yaml:5:46: key \"loads[1].displacement[3]\"", "is a pressure"},
        {LOAD("{on: top, displacement: [0, 0 mm, 1 mm]}"), SN_E_UNIT,
         "key \"loads[1].displacement[1]\": found \"0\" without a unit", NULL},
        {LOAD("{on: top, displacement: 1 mm}"), SN_E_SYNTAX, "key \"loads[1].displacement\"",
         "such as [1 mm, free, 0 mm]"},
        {LOAD("{on: top, displacement: [free, free, free]}"), SN_E_RANGE,
         "all three components are free", NULL},
        {LOAD("{on: top, displacement: [fre, 0 mm, 0 mm]}"), SN_E_SYNTAX, "found \"fre\"", NULL},
        {LOAD("{on: top, traction: [0 kPa, free, 0 kPa]}"), SN_E_SYNTAX,
         "key \"loads[1].traction[2]\"", NULL},
        {LOAD("{on: top, pressure: 1e400 kPa}"), SN_E_SYNTAX, "too large", NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: 1 s}"), SN_E_SYNTAX,
         "key \"loads[1].time\": found \"1 s\"", NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: {}}"), SN_E_KEY,
         "key \"loads[1].time\": expected either", NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: {ramp: 0 s}}"), SN_E_RANGE,
         "key \"loads[1].time.ramp\"", "more than 0"},
        {LOAD("{on: top, pressure: 1 kPa, time: {table: []}}"), SN_E_SYNTAX, "an empty table",
         NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: {table: [0 s, 1]}}"), SN_E_SYNTAX,
         "key \"loads[1].time.table[1]\": expected a row of 2", NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: {table: [[0 s, 0], [0 s, 1]]}}"), SN_E_RANGE,
         "key \"loads[1].time.table[2][1]\": found \"0 s\", expected a later time", NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: {table: [[0, 0], [1 s, 1]]}}"), SN_E_UNIT,
         "key \"loads[1].time.table[1][1]\"", NULL},
        {LOAD("{on: top, pressure: 1 kPa, time: {table: [[0 s, 0 s], [1 s, 1]]}}"), SN_E_UNIT,
         "key \"loads[1].time.table[1][2]\"", "a pure number"},
        {BASE TIME
         "supports: [{on: top, fix: z}]\nloads: [{on: top, displacement: [0 m, 0 m, 1 mm]}]\n",
         SN_E_DEFINITION, "c.yaml: ", "top"},
        {TOOL("{sphere: 5 mm, at: [0 mm, 0 mm, 90 mm]}"), SN_E_KEY,
         "key \"tools[1].name\" is missing", NULL},
        {TOOL("{name: a, at: [0 mm, 0 mm, 90 mm]}"), SN_E_KEY, "key \"tools[1]\": no shape",
         "sphere, capsule, plane, mesh"},
        {TOOL("{name: a, box: 5 mm, at: [0 mm, 0 mm, 90 mm]}"), SN_E_KEY, "key \"tools[1].box\"",
         NULL},
        {TOOL("{name: a, sphere: 5 mm, plane: [0, 0, 1], at: [0 mm, 0 mm, 90 mm]}"), SN_E_KEY,
         "key \"tools[1].plane\"", "\"sphere\" is given too"},
        {TOOL("{name: a, capsule: {radius: 5 mm}, at: [0 mm, 0 mm, 90 mm]}"), SN_E_KEY,
         "key \"tools[1].capsule.axis\" is missing", NULL},
        {TOOL("{name: a, capsule: 5 mm, at: [0 mm, 0 mm, 90 mm]}"), SN_E_SYNTAX,
         "key \"tools[1].capsule\"", NULL},
        {TOOL("{name: a, plane: [0, 0, 0], at: [0 mm, 0 mm, 90 mm]}"), SN_E_RANGE, "have a length",
         NULL},
        {TOOL("{name: a, mesh: {file: jaw.stl}, at: [0 mm, 0 mm, 90 mm]}"), SN_E_KEY,
         "key \"tools[1].mesh.unit\" is missing", NULL},
        {TOOL("{name: a, mesh: {file: jaw.stl, unit: mm}, at: [0 mm, 0 mm, 90 mm]}"), SN_E_FILE,
         "jaw.stl", NULL},
        {TOOL("{name: a, mesh: {file: jaw.stl, unit: kPa}, at: [0 mm, 0 mm, 90 mm]}"), SN_E_UNIT,
         "key \"tools[1].mesh.unit\"", NULL},
        {TOOL("{name: a, sphere: 5 mm, at: [0 mm, 0 mm, 90 mm], turn: [[0 s, 0 mm, 0 mm, 0 mm]]}"),
         SN_E_UNIT, "key \"tools[1].turn[1][2]\"", NULL},
        {LOAD("{force: [0 N, 0 N, 1 N]}"), SN_E_KEY, "expected either \"on\"", "\"point\""},
        {LOAD("{on: top, point: [0 m, 0 m, 0 m], force: [0 N, 0 N, 1 N]}"), SN_E_KEY,
         "expected either \"on\"", NULL},
        {LOAD("{point: [0 m, 0 m, 0 m], pressure: 1 kPa}"), SN_E_KEY,
         "only a force acts at a point", NULL},
        {LOAD("{point: [9 m, 0 m, 0 m], force: [0 N, 0 N, 1 N]}"), SN_E_DEFINITION,
         "load 1, a force", NULL},
        {LOAD("{on: top, force: [0 kPa, 0 N, 1 N]}"), SN_E_UNIT, "key \"loads[1].force[1]\"", NULL},
        {TOOL("{name: a, sphere: 0 mm, at: [0 mm, 0 mm, 90 mm]}"), SN_E_RANGE,
         "a radius of more than 0", NULL},
        {TOOL("{name: a, sphere: 5 mm, at: [0 mm, 0 mm, 90 mm], friction: -1}"), SN_E_RANGE,
         "key \"tools[1].friction\"", NULL},
        {TOOL("{name: a, sphere: 5 mm, at: [0 mm, 0 mm, 90 mm], path: [[0 s, 0 mm]]}"), SN_E_SYNTAX,
         "key \"tools[1].path[1]\": expected a row of 4", NULL},
        {TOOL("{name: a b, sphere: 5 mm, at: [0 mm, 0 mm, 90 mm]}"), SN_E_SYNTAX,
         "key \"tools[1].name\": found \"a b\", expected a name of letters", NULL},
        {TOOL("{name: a, sphere: 5 mm, at: [5 mm, 5 mm, 9 mm]}"), SN_E_DEFINITION,
         "c.yaml: ", "a"}, // starts inside
        {PROBE("{name: a, point: [0 mm, 0 mm, 0 mm]}, {name: a, reaction: top}"), SN_E_NAME,
         "key \"probes[2].name\": found \"a\"", "no other"},
        {PROBE("{name: a}"), SN_E_KEY, "key \"probes[1]\": expected either \"point\"", NULL},
        {PROBE("{name: a, point: [0 mm, 0 mm, 0 mm], reaction: top}"), SN_E_KEY, "expected either",
         NULL},
        {PROBE("{name: a, reaction: tip}"), SN_E_NAME, "key \"probes[1].reaction\"", "top"},
        {PROBE("{name: a, point: [0 mm, 0 mm, 99 mm]}"), SN_E_DEFINITION,
         "c.yaml: ", "a"}, // outside
        {PROBE("{name: a, point: [0 mm, 0 mm]}"), SN_E_SYNTAX, "key \"probes[1].point\"", NULL},
    };
    check_hostile(read_and_check, "c.yaml", table, sizeof table / sizeof table[0]);
}

#define SPRINGS(x) BASE TIME "springs: {" x "}\n"
#define CONTINUUM(x) BASE TIME "continuum: {" x "}\n"

static void bad_settings_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {SPRINGS("model: couple"), SN_E_NAME, "key \"springs.model\": found \"couple\"",
         "did you mean \"coupled\"?"},
        {SPRINGS("modell: coupled"), SN_E_KEY, "did you mean \"model\"?", NULL},
        {SPRINGS("volume: yes"), SN_E_NAME, "key \"springs.volume\"", "false, true"},
        {SPRINGS("integrator: euler"), SN_E_NAME, "explicit, implicit, quasi-static", NULL},
        {SPRINGS("tolerance: 1e-6"), SN_E_DEFINITION, "explicit integrator solves no equations",
         NULL},
        {SPRINGS("integrator: implicit, tolerance: 2"), SN_E_RANGE, "less than 1", NULL},
        {SPRINGS("step: 1"), SN_E_UNIT, "key \"springs.step\"", "a time"},
        {SPRINGS("step: 0 s"), SN_E_RANGE, "more than 0", NULL},
        {SPRINGS("step: automatic"), SN_E_SYNTAX, "auto or a time", NULL},
        {SPRINGS("step: [1 s]"), SN_E_SYNTAX, "auto or a time", NULL},
        {SPRINGS("precision: half"), SN_E_NAME, "single, double", NULL},
        {SPRINGS("threads: 0"), SN_E_RANGE, "from 1 to 1024", NULL},
        {SPRINGS("threads: 2000000000"), SN_E_RANGE, "from 1 to 1024", NULL},
        {SPRINGS("damping: -1 1/s"), SN_E_RANGE, "key \"springs.damping\"", NULL},
        {SPRINGS("damping: {stiffness: -1 ms}"), SN_E_RANGE, "key \"springs.damping.stiffness\"",
         NULL},
        {SPRINGS("damping: {mass: 1 s}"), SN_E_UNIT, "key \"springs.damping.mass\"", NULL},
        {SPRINGS("damping: {stifness: 1 ms}"), SN_E_KEY, "stiffness", NULL},
        {SPRINGS("scheme: bdf3"), SN_E_NAME, "bdf2", NULL},
        {SPRINGS("damping: 0.1"), SN_E_UNIT, "a rate such as", NULL},
        {SPRINGS("memory_tolerance: 0"), SN_E_RANGE, "less than 1", NULL},
        {CONTINUUM("element: p1"), SN_E_NAME, "did you mean \"P1\"?", NULL},
        {CONTINUUM("analysis: static"), SN_E_NAME, "key \"continuum.analysis\"", NULL},
        {CONTINUUM("steps: 0"), SN_E_RANGE, "key \"continuum.steps\"", NULL},
        {CONTINUUM("tolerance: 1"), SN_E_RANGE, "key \"continuum.tolerance\"", NULL},
        {CONTINUUM("tolerance: 1e-6 s"), SN_E_UNIT, "key \"continuum.tolerance\"", NULL},
        {BASE TIME "continuum: P1\n", SN_E_SYNTAX,
         "key \"continuum\": found \"P1\", expected a map", NULL},
    };
    check_hostile(read_and_check, "c.yaml", table, sizeof table / sizeof table[0]);
}

static void too_many_are_refused(void **state) {
    (void)state;
    char *text = malloc(200000);
    size_t used = (size_t)sprintf(text, BASE TIME "supports:\n");
    for (int k = 0; k < 1001; k++) used += (size_t)sprintf(text + used, "  - {on: top, fix: x}\n");
    scratch_write("c.yaml", text, used);
    free(text);
    CHECK_FAILS(read_and_check(scratch_path("c.yaml")), SN_E_RANGE, "at most 1000");
    sn_case *c;
    CHECK_FAILS(sn_case_read(scratch_path("none.yaml"), &c), SN_E_FILE, "none.yaml: cannot open");
    assert_null(c);
}

static void mutations_are_survived(void **state) {
    (void)state;
    check_fuzz(read_and_check, "c.yaml", valid, 2000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_the_manual),
        cmocka_unit_test(little_is_needed),
        cmocka_unit_test(shapes_are_built),
        cmocka_unit_test(meshes_come_from_files),
        cmocka_unit_test(paths_are_relative_to_the_case),
        cmocka_unit_test(fibres_by_rule),
        cmocka_unit_test(fibres_from_a_file),
        cmocka_unit_test(bad_bodies_are_refused),
        cmocka_unit_test(bad_loads_are_refused),
        cmocka_unit_test(bad_settings_are_refused),
        cmocka_unit_test(too_many_are_refused),
        cmocka_unit_test(mutations_are_survived),
    };
    return cmocka_run_group_tests(tests, setup, scratch_close);
}
