// Built-in shapes: volumes, areas, closed boundaries, symmetric stars, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#define PI 3.14159265358979323846

// Sums of up to 1e4 terms of one sign, each right to a few roundings: 1e4 * 2e-16 at the very
// worst, some 1e-14 in truth.
#define ROUNDING 1e-12

static const sn_pattern patterns[] = {SN_PATTERN_MIRRORED, SN_PATTERN_BCC, SN_PATTERN_KUHN};

static double cell_volume(const sn_mesh *m, int c) {
    double e[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            e[k][i] = m->node[3 * m->cell[4 * c + k + 1] + i] - m->node[3 * m->cell[4 * c] + i];
    return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
            e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
           6;
}

static int compare_key(const void *a, const void *b) {
    const int *x = a, *y = b;
    for (int i = 0; i < 3; i++)
        if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
    return 0;
}

static void sort3(int *v) {
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (v[j] > v[j + 1]) {
                int swap = v[j];
                v[j] = v[j + 1];
                v[j + 1] = swap;
            }
}

// What holds for every sound mesh of a body: by brute force, nothing from src/model/.
static void check_sound(const sn_mesh *m, double volume) {
    double sum = 0;
    for (int c = 0; c < m->cell_count; c++) {
        double v = cell_volume(m, c);
        assert_true(v > 0);
        sum += v;
    }
    CHECK_REL(sum, volume, ROUNDING);
    CHECK_REL(sn_mesh_volume(m), volume, ROUNDING);

    // every face belongs to one cell or two; those of one are the surface "boundary"
    int faces = 4 * m->cell_count;
    int(*key)[3] = calloc((size_t)faces, sizeof *key);
    for (int c = 0; c < m->cell_count; c++)
        for (int k = 0; k < 4; k++) {
            int *out = key[4 * c + k];
            for (int i = 0; i < 4; i++)
                if (i != k) *out++ = m->cell[4 * c + i];
            sort3(key[4 * c + k]);
        }
    qsort(key, (size_t)faces, sizeof *key, compare_key);
    int unique = 0, outer = 0;
    for (int f = 0; f < faces;) {
        int run = 1;
        while (f + run < faces && !compare_key(key[f], key[f + run])) run++;
        assert_in_range(run, 1, 2);
        outer += run == 1;
        unique++;
        f += run;
    }
    free(key);
    int boundary = sn_mesh_surface(m, "boundary");
    assert_int_equal(m->surface[boundary].face_count, outer);

    // Euler: nodes - edges + faces - cells = 1 for a ball, 0 for a ring
    int *edge, edges;
    CHECK_OK(sn_mesh_edges(m, &edge, &edges));
    sn_free(edge);
    int ring = sn_mesh_surface(m, "inner") >= 0 && sn_mesh_surface(m, "base") < 0;
    assert_int_equal(m->node_count - edges + unique - m->cell_count, ring ? 0 : 1);

    // closed: area vectors sum to zero; outwards: the divergence theorem gives the volume
    double vector[3], enclosed = 0;
    double area = surface_area(m, boundary, vector);
    for (int i = 0; i < 3; i++) CHECK_ABS(vector[i] / area, 0, ROUNDING);
    const sn_surface *s = &m->surface[boundary];
    for (int f = 0; f < s->face_count; f++) {
        const double *a = m->node + 3 * s->face[3 * f], *b = m->node + 3 * s->face[3 * f + 1],
                     *c = m->node + 3 * s->face[3 * f + 2];
        enclosed += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                     a[2] * (b[0] * c[1] - b[1] * c[0])) /
                    6;
    }
    CHECK_REL(enclosed, volume, ROUNDING);
    // the named ones are all of it, and each has its cell behind
    double named = 0;
    for (int i = 0; i < m->surface_count - 1; i++) named += surface_area(m, i, vector);
    CHECK_REL(named, area, ROUNDING);
    for (int i = 0; i < m->surface_count; i++)
        for (int f = 0; f < m->surface[i].face_count; f++) {
            int found = 0, c = m->surface[i].cell[f];
            for (int k = 0; k < 4; k++)
                for (int j = 0; j < 3; j++)
                    found += m->cell[4 * c + k] == m->surface[i].face[3 * f + j];
            assert_int_equal(found, 3);
        }
}

static void check_surface(const sn_mesh *m, const char *name, double area, const double vector[3]) {
    int s = sn_mesh_surface(m, name);
    assert_true(s >= 0);
    double v[3];
    CHECK_REL(surface_area(m, s, v), area, ROUNDING);
    for (int i = 0; i < 3; i++) CHECK_ABS(v[i] / area, vector[i], ROUNDING);
}

static void blocks(void **state) {
    (void)state;
    static const int cells[][3] = {{1, 1, 1}, {1, 2, 3}, {4, 3, 5}, {2, 2, 2}, {7, 1, 1}};
    static const char *const name[] = {"left", "right", "front", "back", "bottom", "top"};
    for (int p = 0; p < 3; p++)
        for (int k = 0; k < 5; k++) {
            sn_shape_def def = block(patterns[p], cells[k][0], cells[k][1], cells[k][2]);
            sn_mesh *m = build(&def);
            double s[3] = {def.size[0], def.size[1], def.size[2]};
            check_sound(m, s[0] * s[1] * s[2]);
            for (int i = 0; i < 6; i++) {
                double n[3] = {0};
                n[i / 2] = i % 2 ? 1 : -1;
                check_surface(m, name[i], s[(i / 2 + 1) % 3] * s[(i / 2 + 2) % 3], n);
            }
            int n[3] = {cells[k][0], cells[k][1], cells[k][2]};
            int expected = (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
            if (patterns[p] == SN_PATTERN_BCC) expected += n[0] * n[1] * n[2];
            assert_int_equal(m->node_count, expected);
            assert_string_equal(m->region_name[0], "body");
            sn_mesh_destroy(m);
        }
}

// The cross-section of a tube is the ring between two regular polygons.
static void tubes(void **state) {
    (void)state;
    static const int cells[][3] = {{1, 4, 1}, {2, 6, 3}, {3, 16, 4}, {1, 3, 2}, {2, 11, 2}};
    for (int p = 0; p < 3; p++)
        for (int k = 0; k < 5; k++) {
            sn_shape_def def = tube(patterns[p], cells[k][0], cells[k][1], cells[k][2]);
            int n = def.cells[1];
            if (def.pattern == SN_PATTERN_MIRRORED && n % 2) continue;
            if (def.pattern == SN_PATTERN_BCC && n < 11)
                continue; // through this wall: refused below
            sn_mesh *m = build(&def);
            double ri = def.inner_radius, ro = def.outer_radius;
            double ring = n / 2.0 * sin(2 * PI / n) * (ro * ro - ri * ri);
            check_sound(m, ring * def.length);
            check_surface(m, "bottom", ring, (double[3]){0, 0, -1});
            check_surface(m, "top", ring, (double[3]){0, 0, 1});
            check_surface(m, "inner", 2 * n * ri * sin(PI / n) * def.length, (double[3]){0});
            check_surface(m, "outer", 2 * n * ro * sin(PI / n) * def.length, (double[3]){0});
            // the x axis carries a node on the inner edge of both ends
            int found = 0;
            for (int a = 0; a < m->node_count; a++) {
                const double *x = m->node + 3 * a;
                found += x[0] == ri && x[1] == 0 && (x[2] == 0 || x[2] == def.length);
            }
            assert_int_equal(found, 2);
            sn_mesh_destroy(m);
        }
}

static void cylinders(void **state) {
    (void)state;
    static const int cells[][3] = {{1, 3, 1},  {2, 12, 3}, {4, 24, 4}, {3, 5, 2},
                                   {5, 17, 2}, {2, 40, 2}, {9, 3, 1},  {12, 31, 1}};
    for (int p = 0; p < 3; p += 2) // mirrored and kuhn
        for (int k = 0; k < 8; k++) {
            sn_shape_def def = cylinder(patterns[p], cells[k][0], cells[k][1], cells[k][2]);
            sn_mesh *m = build(&def);
            int n = def.cells[1];
            double r = def.radius, disc = n / 2.0 * sin(2 * PI / n) * r * r;
            check_sound(m, disc * def.length);
            check_surface(m, "bottom", disc, (double[3]){0, 0, -1});
            check_surface(m, "top", disc, (double[3]){0, 0, 1});
            check_surface(m, "outer", 2 * n * r * sin(PI / n) * def.length, (double[3]){0});
            sn_mesh_destroy(m);
        }
}

// Whether the neighbours of every node for which inner[] is set lie in pairs x, -x around it.
// Counts the nodes that were looked at, and those whose star is not symmetric.
static void count_stars(const sn_mesh *m, const unsigned char *inner, int *looked, int *lopsided) {
    int *edge, edges;
    CHECK_OK(sn_mesh_edges(m, &edge, &edges));
    *looked = *lopsided = 0;
    for (int a = 0; a < m->node_count; a++) {
        if (!inner[a]) continue;
        double offset[64][3];
        int count = 0;
        for (int e = 0; e < edges; e++)
            for (int end = 0; end < 2; end++)
                if (edge[2 * e + end] == a) {
                    int b = edge[2 * e + 1 - end];
                    for (int i = 0; i < 3; i++)
                        offset[count][i] = m->node[3 * b + i] - m->node[3 * a + i];
                    count++;
                }
        int paired = 0;
        for (int x = 0; x < count; x++)
            for (int y = 0; y < count; y++) {
                double d = 0; // sides are millimetres, rounding some 1e-18 m
                for (int i = 0; i < 3; i++) d = fmax(d, fabs(offset[x][i] + offset[y][i]));
                paired += d < 1e-12;
            }
        ++*looked;
        *lopsided += paired != count;
    }
    sn_free(edge);
}

static void symmetric_stars(void **state) {
    (void)state;
    for (int p = 0; p < 3; p++) {
        sn_shape_def def = block(patterns[p], 4, 5, 4);
        sn_mesh *m = build(&def);
        unsigned char *inner = malloc((size_t)m->node_count);
        memset(inner, 1, (size_t)m->node_count);
        int *nodes, count, looked, lopsided;
        CHECK_OK(sn_mesh_surface_nodes(m, sn_mesh_surface(m, "boundary"), &nodes, &count));
        for (int i = 0; i < count; i++) inner[nodes[i]] = 0;
        sn_free(nodes);
        if (patterns[p] == SN_PATTERN_BCC) // centres of cells at the boundary lack a neighbour
            for (int k = 0; k < 4; k++)
                for (int j = 0; j < 5; j++)
                    for (int i = 0; i < 4; i++)
                        if (i % 3 == 0 || j % 4 == 0 || k % 3 == 0)
                            inner[5 * 6 * 5 + i + 4 * (j + 5 * k)] = 0;
        count_stars(m, inner, &looked, &lopsided);
        assert_int_equal(looked, 3 * 4 * 3 + (patterns[p] == SN_PATTERN_BCC ? 2 * 3 * 2 : 0));
        assert_int_equal(lopsided, 0);
        // the check can fail: on the boundary stars are lopsided
        memset(inner, 1, (size_t)m->node_count);
        count_stars(m, inner, &looked, &lopsided);
        assert_true(lopsided > 0);
        free(inner);
        sn_mesh_destroy(m);
    }
}

// Kuhn has 14 neighbours everywhere; the mirrored star depends on how many indices are odd.
static void mirrored_is_not_kuhn(void **state) {
    (void)state;
    sn_shape_def def = block(SN_PATTERN_MIRRORED, 4, 4, 4);
    sn_mesh *m = build(&def);
    int *edge, edges, degree[125] = {0};
    CHECK_OK(sn_mesh_edges(m, &edge, &edges));
    for (int e = 0; e < 2 * edges; e++) degree[edge[e]]++;
    sn_free(edge);
    assert_int_equal(degree[2 + 5 * (2 + 5 * 2)], 26); // all even: start of 8 cells
    assert_int_equal(degree[1 + 5 * (1 + 5 * 1)], 26); // all odd: end of 8 cells
    assert_int_equal(degree[1 + 5 * (2 + 5 * 2)], 10); // 6 + 4 diagonals of the face across
    sn_mesh_destroy(m);
}

// Two layers of a mirrored cylinder reflect each other: every edge has its image. Kuhn's do not.
static void mirrored_cylinder(void **state) {
    (void)state;
    for (int p = 0; p < 3; p += 2) {
        sn_shape_def def = cylinder(patterns[p], 3, 15, 2);
        sn_mesh *m = build(&def);
        int *edge, edges, missing = 0, points = m->node_count / 3;
        CHECK_OK(sn_mesh_edges(m, &edge, &edges));
        unsigned char *table = calloc((size_t)m->node_count, (size_t)m->node_count);
        for (int e = 0; e < edges; e++) {
            table[edge[2 * e] * m->node_count + edge[2 * e + 1]] = 1;
            table[edge[2 * e + 1] * m->node_count + edge[2 * e]] = 1;
        }
        for (int e = 0; e < edges; e++) {
            int image[2];
            for (int i = 0; i < 2; i++) {
                int a = edge[2 * e + i], level = a / points;
                image[i] = a % points + points * (2 - level);
                CHECK_ABS(m->node[3 * image[i] + 2], def.length - m->node[3 * a + 2], 1e-17);
            }
            missing += !table[image[0] * m->node_count + image[1]];
        }
        assert_true(patterns[p] == SN_PATTERN_MIRRORED ? missing == 0 : missing > 0);
        free(table);
        sn_free(edge);
        sn_mesh_destroy(m);
    }
}

// Diagonals of the boundary of a body-centred block alternate: within a side every node has four or
// no diagonals.
static void bcc_diagonals(void **state) {
    (void)state;
    sn_shape_def def = block(SN_PATTERN_BCC, 5, 4, 3);
    sn_mesh *m = build(&def);
    for (int s = 0; s < 6; s++) {
        int degree[6 * 5 * 4] = {0}, found = 0; // faces round a node
        const sn_surface *side = &m->surface[s];
        for (int i = 0; i < 3 * side->face_count; i++) degree[side->face[i]]++;
        for (int a = 0; a < 6 * 5 * 4; a++) {
            const double *x = m->node + 3 * a;
            bool inner = degree[a] > 0;
            for (int d = 0; d < 3; d++)
                if (d != s / 2) inner = inner && x[d] > 0 && x[d] < def.size[d];
            if (!inner) continue;
            assert_true(degree[a] == 4 || degree[a] == 8);
            found++;
        }
        assert_int_equal(found, s < 2 ? 3 * 2 : s < 4 ? 4 * 2 : 4 * 3);
    }
    sn_mesh_destroy(m);
}

static void refusals(void **state) {
    (void)state;
    sn_mesh *m = (sn_mesh *)1;
    sn_shape_def d = block(SN_PATTERN_MIRRORED, 200000, 200000, 200000);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "48000000000000000 tetrahedra");
    assert_null(m);
    d.pattern = SN_PATTERN_BCC;
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "200000, 200000, 200000");
    d = block(SN_PATTERN_KUHN, 2147483647, 2147483647, 2147483647);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "at most 50000000");
    d = block(SN_PATTERN_KUHN, 3, 0, 3);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "0 along \"y\", at least 1");
    d = block(SN_PATTERN_KUHN, 3, 3, 3);
    static const double bad[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        d.size[2] = bad[i];
        CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "size along z");
    }
    d.size[2] = 1e-18;
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_MESH, "flat");

    d = tube(SN_PATTERN_MIRRORED, 2, 9, 2);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "9 cells around");
    d = tube(SN_PATTERN_KUHN, 2, 2, 2);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "2 along \"around\", at least 3");
    d = tube(SN_PATTERN_KUHN, 2, 8, 2);
    d.outer_radius = d.inner_radius;
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "must be larger than inner_radius");
    d = tube(SN_PATTERN_KUHN, 2, 8, 2);
    d.length = -1;
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "length is -1 m");
    d.inner_radius = NAN;
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "inner_radius");

    d = cylinder(SN_PATTERN_BCC, 2, 8, 2);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_UNSUPPORTED, "take mirrored or kuhn");
    d = cylinder(SN_PATTERN_KUHN, 2, 8, 2);
    d.radius = 0;
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "radius is 0 m");
    d = cylinder(SN_PATTERN_KUHN, 2147483647, 2147483647, 2147483647);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "at most 50000000");
    d = cylinder(SN_PATTERN_KUHN, 1, 2147483647, 2147483647);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "at most 50000000");
    d = cylinder(SN_PATTERN_KUHN, 1, 5, 0);
    CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "0 along \"along\"");
}

// The least number around that a body-centred tube names is enough, and one less is too few: there
// the two tetrahedra at a radial face would turn over.
static void bcc_tube_limit(void **state) {
    (void)state;
    for (int radial = 1; radial <= 4; radial++) {
        sn_mesh *m = NULL;
        sn_shape_def d = tube(SN_PATTERN_BCC, radial, 3, 2);
        CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "pattern bcc needs");
        int least = atoi(strstr(sn_error_text(), "needs ") + 6);
        d.cells[1] = least - 1;
        CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "pattern bcc needs");
        d.cells[1] = least;
        m = build(&d);
        check_sound(m, least / 2.0 * sin(2 * PI / least) *
                           (d.outer_radius * d.outer_radius - d.inner_radius * d.inner_radius) *
                           d.length);
        sn_mesh_destroy(m);
        // independent: middle of two centres against the inner edge of the outermost cells
        double h = (d.outer_radius - d.inner_radius) / radial, inner = d.outer_radius - h;
        double c = cos(PI / least), e = cos(PI / (least - 1));
        assert_true((inner + h / 2) * c * c > inner);
        assert_true((inner + h / 2) * e * e <= inner);
    }
}

// Integral of f(u) from 0 to b by Simpson's rule, good to (b/2000)^4.
static double simpson(double (*f)(double, const double *), const double *with, double b) {
    enum { N = 2000 };
    double sum = 0, h = b / N;
    for (int k = 0; k <= N; k++) sum += (k == 0 || k == N ? 1 : k % 2 ? 4 : 2) * f(k * h, with);
    return sum * h / 3;
}
static double slice(double u, const double *axis) { // pi r^2 dz, of a half ellipsoid from its apex
    return acos(-1) * axis[0] * axis[0] * sin(u) * sin(u) * axis[1] * sin(u);
}
static double ring_area(double u, const double *axis) { // 2 pi r ds
    return 2 * acos(-1) * axis[0] * sin(u) * hypot(axis[0] * cos(u), axis[1] * sin(u));
}

// The ventricle of Land's second problem, finer and finer: volume and walls approach the integrals
// with the second order of flat facets.
static void ellipsoids(void **state) {
    (void)state;
    double off[3];
    for (int p = 0; p < 2; p++)
        for (int k = 0; k < 3; k++) {
            const int n = 1 << k;
            sn_shape_def def = {.shape = SN_SHAPE_ELLIPSOID,
                                .pattern = p ? SN_PATTERN_KUHN : SN_PATTERN_MIRRORED,
                                .inner = {0.007, 0.017},
                                .outer = {0.010, 0.020},
                                .base = 0.005,
                                .cells = {n, 12 * n, 8 * n}};
            sn_mesh *m = build(&def);
            const double inner = simpson(slice, def.inner, acos(-def.base / def.inner[1]));
            const double outer = simpson(slice, def.outer, acos(-def.base / def.outer[1]));
            double sum = sn_mesh_volume(m), vector[3];
            check_sound(m, sum);
            off[k] = 1 - sum / (outer - inner);
            assert_int_equal(m->surface_count, 4);
            const double wall = surface_area(m, sn_mesh_surface(m, "inner"), vector);
            const double exact = simpson(ring_area, def.inner, acos(-def.base / def.inner[1]));
            CHECK_REL(wall, exact, 0.1 / (n * n));
            // the base is flat and faces +z
            const double base = surface_area(m, sn_mesh_surface(m, "base"), vector);
            CHECK_REL(vector[2], base, 1e-12);
            sn_mesh_destroy(m);
        }
    assert_true(off[1] > 0 && off[1] / off[2] > 3.5 && off[1] / off[2] < 4.5);

    sn_mesh *m = NULL;
    sn_shape_def def = {.shape = SN_SHAPE_ELLIPSOID,
                        .inner = {1, 2},
                        .outer = {2, 3},
                        .base = 2,
                        .cells = {1, 8, 4}};
    CHECK_FAILS(sn_mesh_build(&def, &m), SN_E_RANGE, "does not cut the inner wall");
    def.base = 0, def.outer[1] = 2;
    CHECK_FAILS(sn_mesh_build(&def, &m), SN_E_RANGE, "the long half axis of the outer wall");
    def.outer[1] = 3, def.pattern = SN_PATTERN_BCC;
    CHECK_FAILS(sn_mesh_build(&def, &m), SN_E_UNSUPPORTED, "bcc");
    def.pattern = SN_PATTERN_KUHN, def.cells[1] = 2;
    CHECK_FAILS(sn_mesh_build(&def, &m), SN_E_RANGE, "\"around\"");
    assert_null(m);
}

// Positions of the nodes along one edge of a block, rising.
static int along_edge(const sn_mesh *m, int axis, double *x) {
    int count = 0;
    for (int a = 0; a < m->node_count; a++) {
        const double *p = m->node + 3 * a;
        if (p[(axis + 1) % 3] == 0 && p[(axis + 2) % 3] == 0) x[count++] = p[axis];
    }
    return count;
}

// Cells grow away from a point by the ratio that is asked for, on both sides of it alike, and a
// mesh of twice the cells has all nodes of the coarse one.
static void graded_blocks(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_shape_def d = {.shape = SN_SHAPE_BLOCK,
                          .pattern = patterns[k],
                          .size = {0.3, 0.2, 0.1},
                          .cells = {200, 4, 2},
                          .ratio = 4,
                          .towards = {0.1, 0, 0.1}};
        sn_mesh *m, *fine;
        double x[401], y[401];
        CHECK_OK(sn_mesh_build(&d, &m));
        check_sound(m, 0.3 * 0.2 * 0.1);
        assert_int_equal(along_edge(m, 0, x), 201);
        double least = 1;
        for (int i = 0; i < 200; i++) least = fmin(least, x[i + 1] - x[i]);
        // the last of 200 cells is half a cell short of the end of the curve: 1.2 / 200 off
        CHECK_REL((x[200] - x[199]) / least, 4, 0.02);
        for (int i = 1; i < 200; i++) {
            // a geometric series: the same factor from cell to cell, down to the point and up again
            double growth = (x[i + 1] - x[i]) / (x[i] - x[i - 1]);
            if (x[i - 1] < 0.1 && x[i + 1] > 0.1) continue;
            CHECK_REL(x[i] < 0.1 ? 1 / growth : growth, (x[200] - x[199]) / (x[199] - x[198]),
                      1e-9);
        }
        // the short end of y at 0, of z at 0.1
        assert_int_equal(along_edge(m, 1, y), 5);
        assert_true(y[1] < 0.5 * (y[4] - y[3]));
        assert_int_equal(along_edge(m, 2, y), 3);
        assert_true(y[1] > 0.06 && y[2] == 0.1);
        for (int i = 0; i < 3; i++) d.cells[i] *= 2;
        CHECK_OK(sn_mesh_build(&d, &fine));
        assert_int_equal(along_edge(fine, 0, y), 401);
        for (int i = 0; i <= 200; i++) CHECK_ABS(y[2 * i], x[i], 1e-15);
        sn_mesh_destroy(m);
        sn_mesh_destroy(fine);
        // a ratio of 1 is no grading
        for (int i = 0; i < 3; i++) d.cells[i] = 3;
        d.ratio = 1;
        CHECK_OK(sn_mesh_build(&d, &m));
        assert_int_equal(along_edge(m, 0, x), 4);
        CHECK_ABS(x[1], 0.1, 1e-16);
        sn_mesh_destroy(m);
        d.ratio = 0.5;
        CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "ratio 0.5");
        d.ratio = 3;
        d.towards[1] = 0.21;
        CHECK_FAILS(sn_mesh_build(&d, &m), SN_E_RANGE, "towards y");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks),
        cmocka_unit_test(graded_blocks),
        cmocka_unit_test(tubes),
        cmocka_unit_test(cylinders),
        cmocka_unit_test(ellipsoids),
        cmocka_unit_test(symmetric_stars),
        cmocka_unit_test(mirrored_is_not_kuhn),
        cmocka_unit_test(refusals),
        cmocka_unit_test(bcc_tube_limit),
        cmocka_unit_test(mirrored_cylinder),
        cmocka_unit_test(bcc_diagonals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
