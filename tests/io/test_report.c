// Reports: whole pages, hostile text, plots with and without gnuplot, bodies.
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include "allocator.h"
#include "hostile.h"
#include "markup.h"

// text that would act in HTML, in an attribute, in a gnuplot string or in a shell
static const char hostile_text[] = "</title><script>alert(1)</script> \"' onload=\"x\" & \";!touch "
                                   "PWNED;'.system('touch PWNED').'`touch PWNED`\n!touch PWNED\n"
                                   "$HOME @x \\ ]]> --> ü";

static char *write_and_read(sn_report *report, const char *name) {
    const char *path = scratch_path(name);
    CHECK_OK(sn_report_write(report, path));
    char *text = scratch_read(name);
    assert_non_null(text);
    struct stat file; // no zero in it
    assert_int_equal(stat(path, &file), 0);
    assert_int_equal(strlen(text), file.st_size);
    return text;
}

static int count_of(const char *text, const char *part) {
    int count = 0;
    for (; (text = strstr(text, part)); text += strlen(part)) count++;
    return count;
}

static bool has_gnuplot(void) {
    return system("command -v gnuplot >/dev/null 2>&1") == 0;
}

// All ids differ, and what refers to one is there.
static void check_ids(const char *text) {
    static char ids[4096][48];
    int count = 0;
    for (const char *at = text; (at = strpbrk(at, " "));) {
        at++;
        if (strncmp(at, "id=", 3)) continue;
        size_t length = strcspn(at + 4, "\"'");
        assert_in_range(length, 1, 47);
        memcpy(ids[count], at + 4, length);
        ids[count][length] = 0;
        for (int k = 0; k < count; k++) assert_string_not_equal(ids[k], ids[count]);
        assert_in_range(++count, 1, 4095);
    }
    for (const char *at = text; (at = strstr(at, "href='#")); at++) {
        char name[48] = "";
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at + 7, "'"), at + 7);
        bool found = false;
        for (int k = 0; k < count && !found; k++) found = !strcmp(ids[k], name);
        if (!found) print_message("no element '%s'\n", name);
        assert_true(found);
    }
}

static void test_page(void **state) {
    (void)state;
    sn_report *report;
    CHECK_OK(sn_report_create("Title & more", &report));
    sn_report_heading(report, "One < two");
    sn_report_text(report, "%d of %s, %.2f", 3, "<four>", 0.125);
    static const char *const cells[] = {"model", "error [%]", "note",     "a", "−1.5", "3rd ramp",
                                        "b",     "–",         "2 things", "c", "2e-3", NULL};
    sn_report_table(report, 4, 3, cells, "A \"table\".");
    sn_report_table(report, 1, 1, cells, NULL);
    char *text = write_and_read(report, "page.html");
    assert_true(is_well_formed(text, false));
    assert_non_null(strstr(text, "<title>Title &amp; more</title>"));
    assert_non_null(strstr(text, "<h1>Title &amp; more</h1>"));
    assert_non_null(strstr(text, "<h2>One &lt; two</h2>"));
    assert_non_null(strstr(text, "<p>3 of &lt;four&gt;, 0.12</p>"));
    assert_non_null(strstr(text, "<b>Table 1.</b> A &quot;table&quot;."));
    assert_non_null(strstr(text, "<b>Table 2.</b>"));
    // numbers stand right, in the head of the column too; mixed text stands left
    assert_non_null(strstr(text, "<th class=\"n\">error [%]</th><th>note</th>"));
    assert_non_null(strstr(text, "<td>a</td><td class=\"n\">−1.5</td><td>3rd ramp</td>"));
    assert_null(strstr(text, "<script>")); // no bodies, no script
    // the page fetches nothing
    assert_non_null(strstr(text, "default-src 'none'"));
    assert_null(strstr(text, "src="));
    assert_null(strstr(text, "@import"));

    // writing again after more text gives one page, not two
    sn_report_text(report, "last");
    char *more = write_and_read(report, "more.html");
    assert_true(is_well_formed(more, false));
    assert_int_equal(count_of(more, "</html>"), 1);
    assert_true(strlen(more) > strlen(text));
    CHECK_FAILS(sn_report_write(report, "/nowhere/at/all.html"), SN_E_FILE, "/nowhere/at/all.html");
    free(text);
    free(more);
    sn_report_destroy(report);
    sn_report_destroy(NULL);
}

// Two lines, gaps in one, a logarithmic plot with values that it cannot show, bars.
static void add_plots(sn_report *report, const char *word) {
    double x[60], y[60], z[60];
    for (int i = 0; i < 60; i++) {
        x[i] = i - 1; // -1, 0: no place on a logarithmic axis
        y[i] = i % 13 == 5 ? (double)NAN : 3 + sin(0.37 * i);
        z[i] = i == 30 ? HUGE_VAL : exp(-0.3 * i);
    }
    sn_line lines[] = {{word, SN_POINTS, 0, 60, x, y}, {"model", SN_LINE, 9, 60, x, z}};
    sn_report_plot(report, &(sn_plot){word, word, word, word, false, false, 0, 0, 2, lines});
    lines[0].style = SN_LINE_POINTS;
    lines[1].style = SN_DASHED;
    sn_report_plot(report,
                   &(sn_plot){"log", "time [s]", "G [1]", NULL, true, true, 0, 0, 2, lines});
    lines[0].style = lines[1].style = SN_BARS;
    sn_report_plot(report,
                   &(sn_plot){"bars", "case", "error [%]", NULL, false, false, 0, 0, 2, lines});
    lines[0].label = lines[1].label = NULL;
    lines[0].count = lines[1].count = 1; // one point: axes of no length
    sn_report_plot(report, &(sn_plot){"one", "x", "y", NULL, false, false, 0, 0, 2, lines});
    lines[0].count = lines[1].count = 0;
    sn_report_plot(report, &(sn_plot){"empty", "x", "y", NULL, true, false, 0, 0, 2, lines});
}

static void test_plots(void **state) {
    (void)state;
    if (!has_gnuplot()) skip();
    sn_report *report;
    CHECK_OK(sn_report_create("plots", &report));
    add_plots(report, "word");
    char *text = write_and_read(report, "plots.html");
    assert_true(is_well_formed(text, false));
    assert_int_equal(count_of(text, "<figure>"), 5);
    assert_int_equal(count_of(text, "<svg "), 4); // nothing to draw in the fifth
    assert_int_equal(count_of(text, "</svg>"), 4);
    assert_non_null(strstr(text, "No plot “empty”: none of its values can be drawn."));
    assert_int_equal(count_of(text, "class=\"note\""), 1);
    assert_non_null(strstr(text, ">10⁻"));             // decades
    assert_non_null(strstr(text, "<b>Figure 5.</b>")); // numbered through
    assert_null(strstr(text, "GNUPLOT"));              // no version of a program
    check_ids(text);
    // the same page again
    sn_report *again;
    CHECK_OK(sn_report_create("plots", &again));
    add_plots(again, "word");
    char *same = write_and_read(again, "again.html");
    assert_string_equal(text, same);
    free(text);
    free(same);
    sn_report_destroy(report);
    sn_report_destroy(again);
}

// A line of many points is thinned to what can be seen, and keeps its peaks and ends.
static void test_many_points(void **state) {
    (void)state;
    if (!has_gnuplot()) skip();
    enum { COUNT = 200000 };
    double *x = malloc(COUNT * sizeof *x), *y = malloc(COUNT * sizeof *y);
    for (int i = 0; i < COUNT; i++) {
        x[i] = i / (double)COUNT;
        y[i] = i == COUNT / 3 ? 10 : sin(20 * x[i]);
    }
    sn_line line = {"wave", SN_LINE, 0, COUNT, x, y};
    sn_report *report;
    CHECK_OK(sn_report_create("many", &report));
    sn_report_plot(report, &(sn_plot){"many", "x", "y", NULL, false, false, 0, 0, 1, &line});
    char *text = write_and_read(report, "many.html");
    // the curve is less than 5 axes long in each direction, a point every 1/3000 of one at most,
    // and a point takes less than 20 bytes
    assert_in_range(strlen(text), 5000, 5 * 3000 * 2 * 20);
    // the peak is 94 % of the way up an axis from -1.55 to 11.66: its place from the top of the
    // plot is 1.66/13.2 of 300 and more pixels, far above where the wave is
    double highest = 1e9;
    for (const char *at = strstr(text, "plot_1"); at && (at = strpbrk(at, ",")); at++) {
        double value = atof(at + 1);
        if (value > 40 && value < highest) highest = value;
    }
    assert_true(highest < 100);
    free(text);
    free(x);
    free(y);
    sn_report_destroy(report);
}

static void test_hostile(void **state) {
    (void)state;
    sn_report *report;
    char folder[1024];
    assert_non_null(getcwd(folder, sizeof folder));
    assert_int_equal(chdir(scratch), 0); // where a command that got through would leave its mark
    CHECK_OK(sn_report_create(hostile_text, &report));
    sn_report_heading(report, hostile_text);
    sn_report_text(report, "%s", hostile_text);
    const char *const cells[] = {hostile_text, "n", hostile_text, "1"};
    sn_report_table(report, 2, 2, cells, hostile_text);
    add_plots(report, hostile_text);
    char *text = write_and_read(report, "hostile.html");
    assert_int_equal(chdir(folder), 0);
    assert_true(is_well_formed(text, false));
    assert_null(strstr(text, "<script"));
    assert_int_not_equal(access(scratch_path("PWNED"), F_OK), 0);
    if (has_gnuplot()) {
        assert_int_equal(count_of(text, "<svg "), 4);
        assert_non_null(strstr(text, "$HOME @x")); // unchanged in the label
        check_ids(text);
    }
    free(text);
    sn_report_destroy(report);
}

// No gnuplot, and one that fails: the page says so and shows values.
static void test_without_gnuplot(void **state) {
    (void)state;
    char *before = strdup(getenv("PATH"));
    static const char *const scripts[] = {
        NULL, "#!/bin/sh\necho >&2\necho '  line 3: no such terminal' >&2\nexit 1\n",
        "#!/bin/sh\nkill -9 $$\n", "#!/bin/sh\nexit 0\n"};
    static const char *const reasons[] = {"gnuplot is not installed", "line 3: no such terminal",
                                          "ended by signal 9", "it gave no reason"};
    for (int k = 0; k < 4; k++) {
        if (scripts[k]) chmod(scratch_write("gnuplot", scripts[k], strlen(scripts[k])), 0755);
        setenv("PATH", scratch, 1);
        sn_report *report;
        CHECK_OK(sn_report_create("none", &report));
        add_plots(report, hostile_text);
        setenv("PATH", before, 1);
        char *text = write_and_read(report, "none.html");
        assert_true(is_well_formed(text, false));
        assert_int_equal(count_of(text, "<svg"), 0);
        assert_int_equal(count_of(text, "class=\"note\""), 5);
        assert_int_equal(count_of(text, "<figcaption>"), 5);
        assert_int_equal(count_of(text, "<table>"), 4);
        if (!strstr(text, reasons[k])) print_message("%s\n", strstr(text, "class=\"note\""));
        assert_non_null(strstr(text, reasons[k]));
        assert_null(strstr(text, "<script"));
        free(text);
        sn_report_destroy(report);
    }
    setenv("PATH", "", 1);
    sn_report *report;
    CHECK_OK(sn_report_create("none", &report));
    add_plots(report, "word");
    setenv("PATH", before, 1);
    free(before);
    char *text = write_and_read(report, "none.html");
    assert_true(is_well_formed(text, false));
    assert_int_equal(count_of(text, "class=\"note\""), 5);
    free(text);
    sn_report_destroy(report);
}

// Values are shown in the units of the labels: the table that stands in for a figure has them.
static void test_scaled(void **state) {
    (void)state;
    const double x[] = {0.25, 0.5}, y[] = {2000, 3500};
    const sn_line line = {"stress", SN_LINE, 0, 2, x, y};
    sn_plot plot = {.title = "t", .x_label = "time [ms]", .y_label = "stress [kPa]"};
    plot.line_count = 1, plot.line = &line;
    plot.x_scale = 1e3, plot.y_scale = 1e-3;
    char *before = strdup(getenv("PATH"));
    setenv("PATH", "", 1);
    sn_report *report;
    CHECK_OK(sn_report_create("scaled", &report));
    sn_report_plot(report, &plot);
    setenv("PATH", before, 1);
    free(before);
    char *text = write_and_read(report, "scaled.html");
    static const char *const shown[] = {">250<", ">500<", ">2<", ">3.5<"};
    for (int k = 0; k < 4; k++) assert_int_equal(count_of(text, shown[k]), 1);
    assert_int_equal(count_of(text, "2000"), 0);
    assert_true(x[0] == 0.25 && y[0] == 2000); // the caller's values stay
    free(text);
    sn_report_destroy(report);
}

//---- bodies --------------------------------------------------------------------------------------

// The bytes of an attribute of the k-th canvas, from base64.
static size_t attribute(const char *text, int k, const char *name, unsigned char *out) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (; k >= 0; k--) text = strstr(text, "<canvas") + 1;
    char mark[32];
    snprintf(mark, sizeof mark, " data-%s=\"", name);
    text = strstr(text, mark) + strlen(mark);
    size_t count = 0;
    unsigned word = 0, bits = 0;
    for (const char *d; (d = strchr(digits, *text)); text++) {
        word = word << 6 | (unsigned)(d - digits);
        bits += 6;
        if (bits >= 8) out[count++] = (unsigned char)(word >> (bits -= 8));
    }
    return count;
}

static unsigned number(const unsigned char *bytes, size_t k) {
    return bytes[2 * k] | (unsigned)bytes[2 * k + 1] << 8;
}

static void test_bodies(void **state) {
    (void)state;
    sn_mesh *mesh[2];
    sn_shape_def block = {.shape = SN_SHAPE_BLOCK, .size = {0.04, 0.03, 0.02}, .cells = {4, 3, 3}};
    CHECK_OK(sn_mesh_build(&block, &mesh[0]));
    CHECK_OK(sn_mesh_build(&block, &mesh[1]));
    sn_body bodies[2];
    size_t nodes = (size_t)mesh[0]->node_count;
    double *motion = calloc(3 * nodes, sizeof *motion), *value = calloc(nodes, sizeof *value);
    double *still = calloc(3 * nodes, sizeof *still);
    for (size_t n = 0; n < nodes; n++) {
        motion[3 * n] = 0.5 * mesh[0]->node[3 * n]; // stretched to 0.06 along x
        value[n] = 40 * mesh[0]->node[3 * n + 2];   // 0 … 0.8
    }
    value[0] = (double)NAN;
    bodies[0] = (sn_body){hostile_text, hostile_text, mesh[0], motion, value, 0, 0};
    bodies[1] = (sn_body){"second", "error [mm]", mesh[1], still, value, 0.4, 0};
    sn_report *report;
    CHECK_OK(sn_report_create("bodies", &report));
    sn_report_bodies(report, 2, bodies, hostile_text);
    char *text = write_and_read(report, "bodies.html");
    assert_true(is_well_formed(text, false));
    assert_int_equal(count_of(text, "<canvas"), 2);
    assert_int_equal(count_of(text, "<script>"), 1);
    assert_null(strstr(text, "alert(1)</script>"));

    unsigned char *bytes = malloc(strlen(text));
    const sn_surface *boundary = NULL;
    for (int s = 0; s < mesh[0]->surface_count; s++)
        if (!strcmp(mesh[0]->surface[s].name, "boundary")) boundary = &mesh[0]->surface[s];
    // a block of 4 x 3 x 3 cells has 5*4*4 - 3*2*2 nodes and 2*2*(12+12+9) triangles outside
    size_t faces = attribute(text, 0, "faces", bytes) / 6, skin = 80 - 12;
    assert_int_equal(faces, 132);
    unsigned last = 0;
    for (size_t k = 0; k < 3 * faces; k++) last = number(bytes, k) > last ? number(bytes, k) : last;
    assert_int_equal(last, skin - 1); // every node once
    unsigned *face = malloc(3 * faces * sizeof *face);
    for (size_t k = 0; k < 3 * faces; k++) face[k] = number(bytes, k);

    // positions to half a step of 0.06 m / 65535 in the cube of the stretched block, whose sides
    // beyond the longest are centred
    assert_int_equal(attribute(text, 0, "points", bytes), 6 * skin);
    double size = 0.06, low[3] = {0, 0.015 - 0.03, 0.01 - 0.03}, worst = 0;
    for (size_t k = 0; k < 3 * faces; k++)
        for (size_t i = 0; i < 3; i++) {
            size_t n = 3 * (size_t)boundary->face[k] + i;
            double x = low[i] + size * number(bytes, 3 * (size_t)face[k] + i) / 65535;
            worst = fmax(worst, fabs(x - mesh[0]->node[n] - motion[n]));
        }
    CHECK_ABS(worst, 0, 0.5001 * size / 65535);
    // values to half a step of the scale; what is not a number has its own mark
    assert_int_equal(attribute(text, 0, "values", bytes), 2 * skin);
    worst = 0;
    int missing = 0;
    for (size_t k = 0; k < 3 * faces; k++) {
        double expected = value[boundary->face[k]];
        if (isnan(expected)) {
            assert_int_equal(number(bytes, face[k]), 65535);
            missing++;
        } else {
            worst = fmax(worst, fabs(0.8 * number(bytes, face[k]) / 65534 - expected));
        }
    }
    assert_true(missing > 0);
    CHECK_ABS(worst, 0, 0.5001 * 0.8 / 65534);
    // the twelve edges of the block, none of the lines between its flat triangles
    // (cells: 4 times 4 and 4 times 3 and 4 times 3 pieces of them)
    assert_int_equal(attribute(text, 0, "outline", bytes) / 12, 4 * (4 + 3 + 3));
    // the second scale is cut at 0.4 and says so
    assert_int_equal(count_of(text, "data-low=\"0\" data-high=\"0.8\" data-over=\"0\""), 1);
    assert_int_equal(count_of(text, "data-low=\"0\" data-high=\"0.4\" data-over=\"1\""), 1);
    assert_non_null(strstr(text, "data-half=\"0.03\""));
    free(text);

    // a position that is not a number is named, and drawn nowhere
    motion[3 * (size_t)boundary->face[0] + 1] = (double)NAN;
    sn_report_bodies(report, 2, bodies, "bad");
    text = write_and_read(report, "bodies.html");
    assert_true(is_well_formed(text, false));
    assert_int_equal(count_of(text, "<canvas"), 2);
    char expected[64];
    snprintf(expected, sizeof expected, "No picture: node %d of ", boundary->face[0]);
    assert_non_null(strstr(text, expected));
    free(text);
    free(bytes);
    free(face);
    free(motion);
    free(value);
    free(still);
    sn_report_destroy(report);
    for (int k = 0; k < 2; k++) sn_mesh_destroy(mesh[k]);
}

// A round body has no sharp edge: its box is drawn instead.
static void test_smooth_body(void **state) {
    (void)state;
    // a block pushed onto a ball: its sides meet smoothly
    sn_mesh *mesh;
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {2, 2, 2}, .cells = {10, 10, 10}};
    CHECK_OK(sn_mesh_build(&def, &mesh));
    for (int n = 0; n < mesh->node_count; n++) {
        double *x = mesh->node + 3 * n, most = 0, length = 0;
        for (int i = 0; i < 3; i++) {
            x[i] -= 1;
            most = fmax(most, fabs(x[i]));
            length += x[i] * x[i];
        }
        for (int i = 0; i < 3 && most > 0; i++) x[i] *= most / sqrt(length);
    }
    double *zero = calloc(3 * (size_t)mesh->node_count, sizeof *zero);
    sn_body body = {"ball", "error [m]", mesh, zero, zero, 0, 0};
    sn_report *report;
    CHECK_OK(sn_report_create("ball", &report));
    sn_report_bodies(report, 1, &body, "ball");
    char *text = write_and_read(report, "ball.html");
    unsigned char *bytes = malloc(strlen(text));
    assert_int_equal(attribute(text, 0, "outline", bytes), 12 * 12);
    for (size_t k = 0; k < 6 * 12; k++) assert_true(number(bytes, k) % 65535 == 0); // corners
    // all values zero: the scale still has a length
    assert_non_null(strstr(text, "data-low=\"0\" data-high=\"1\""));
    free(text);
    free(bytes);
    free(zero);
    sn_report_destroy(report);
    sn_mesh_destroy(mesh);
}

//---- memory --------------------------------------------------------------------------------------

// Wherever memory ends, the report says so when it is written, and nothing is lost or touched
// twice.
static void test_memory(void **state) {
    (void)state;
    sn_mesh *mesh;
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {1, 1, 1}, .cells = {1, 1, 1}};
    CHECK_OK(sn_mesh_build(&def, &mesh));
    double zero[3 * 64] = {0};
    assert_in_range(mesh->node_count, 4, 64);
    sn_body body = {"cube", "error [m]", mesh, zero, zero, 0, 0};
    double x[2] = {0, 1};
    sn_line line = {"line", SN_LINE, 0, 2, x, x};
    sn_plot plot = {"plot", "x", "y", NULL, false, false, 0, 0, 1, &line};
    static const char *const cells[] = {"a", "1"};
    char *before = strdup(getenv("PATH"));
    setenv("PATH", scratch, 1); // without gnuplot: fast, and no less to allocate
    remove(scratch_path("gnuplot"));
    sn_set_allocator(&counting);
    bool done = false;
    int failed = 0;
    for (long allowed = 0; !done && allowed < 1000; allowed++) {
        allocations_left = allowed;
        sn_report *report;
        sn_status status = sn_report_create("memory", &report);
        if (status == SN_OK) {
            sn_report_text(report, "%s", "text");
            sn_report_table(report, 2, 1, cells, "table");
            sn_report_plot(report, &plot);
            sn_report_bodies(report, 1, &body, "cube");
            status = sn_report_write(report, scratch_path("memory.html"));
        }
        sn_report_destroy(report);
        done = status == SN_OK;
        failed += status == SN_E_MEMORY;
        assert_true(done || status == SN_E_MEMORY);
    }
    sn_set_allocator(NULL);
    allocations_left = -1;
    setenv("PATH", before, 1);
    free(before);
    assert_true(done && failed > 5);
    sn_mesh_destroy(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_page),
        cmocka_unit_test(test_plots),
        cmocka_unit_test(test_many_points),
        cmocka_unit_test(test_hostile),
        cmocka_unit_test(test_without_gnuplot),
        cmocka_unit_test(test_scaled),
        cmocka_unit_test(test_bodies),
        cmocka_unit_test(test_smooth_body),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
