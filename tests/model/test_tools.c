// Shapes of tools: depth, normals, contact and poses of capsules, planes and triangulated surfaces.
// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

#define STIFFNESS 41.0 // N/m

//---- surfaces ------------------------------------------------------------------------------------

// Two triangles for each side of a box, outward; at most `room` triangles of 9 numbers.
static int box_triangles(const double low[3], const double high[3], double *corner) {
    int count = 0;
    for (int d = 0; d < 3; d++)
        for (int side = 0; side < 2; side++) {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            double x[4][3];
            for (int k = 0; k < 4; k++) { // round the side, seen from outside for side 1
                x[k][d] = side ? high[d] : low[d];
                x[k][e] = k == 1 || k == 2 ? high[e] : low[e];
                x[k][f] = k >= 2 ? high[f] : low[f];
            }
            static const int way[2][6] = {{0, 2, 1, 0, 3, 2}, {0, 1, 2, 0, 2, 3}};
            for (int k = 0; k < 6; k++)
                memcpy(corner + 9 * count + 3 * k, x[way[side][k]], sizeof x[0]);
            count += 2;
        }
    return count;
}

static sn_tool mesh_tool(int triangles, const double *corner, double friction) {
    sn_tool tool = {.name = "jaw", .kind = SN_TOOL_MESH, .friction = friction};
    CHECK_OK(sn_tool_surface_create(triangles, corner, &tool.surface));
    return tool;
}

// Signed distance to a box, negative outside here.
static double box_depth(const double low[3], const double high[3], const double r[3]) {
    double out = 0, in = INFINITY;
    for (int d = 0; d < 3; d++) {
        const double over = fmax(low[d] - r[d], r[d] - high[d]);
        out += fmax(over, 0) * fmax(over, 0);
        in = fmin(in, -over);
    }
    return in > 0 ? in : -sqrt(out);
}

static void box_distances(void **state) {
    (void)state;
    const double low[3] = {-0.013, -0.021, -0.008}, high[3] = {0.017, 0.009, 0.011};
    double corner[12 * 9];
    sn_tool tool = mesh_tool(box_triangles(low, high, corner), corner, 0);
    const sn_pose pose = sn_pose_at((double[]){0, 0, 0});
    uint64_t seed = 77;
    int inside = 0;
    for (int trial = 0; trial < 4000; trial++) {
        double r[3], n[3];
        for (int d = 0; d < 3; d++) r[d] = check_random(&seed, -0.04, 0.04);
        const double depth = sn_tool_depth(&tool, &pose, r, n);
        CHECK_ABS(depth, box_depth(low, high, r), 1e-16); // coordinates 0.04, rounding 1e-17
        inside += depth > 0;
        CHECK_ABS(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-14);
        // the normal is the slope of the depth
        for (int d = 0; d < 3; d++) {
            double up[3] = {r[0], r[1], r[2]}, h = 1e-7;
            up[d] += h;
            double away = sn_tool_depth(&tool, &pose, up, NULL) - depth;
            if (fabs(depth) > 1e-3) // off the medial planes but for a part in 1e4: skip kinks
                if (fabs(away / h + n[d]) > 1e-3) assert_true(depth > 0); // two sides as near
        }
    }
    assert_in_range(inside, 20, 2000);
    sn_tool_release(&tool);
}

// Brute force: distance over all triangles by dense sampling is poor; instead the winding number
// tells the side, and a fine subdivision of each triangle bounds the distance.
static double winding(int triangles, const double *corner, const double r[3]) {
    double sum = 0;
    for (int f = 0; f < triangles; f++) { // solid angle: Van Oosterom & Strackee (1983)
        double v[3][3], l[3];
        for (int k = 0; k < 3; k++) {
            for (int d = 0; d < 3; d++) v[k][d] = corner[9 * f + 3 * k + d] - r[d];
            l[k] = sqrt(v[k][0] * v[k][0] + v[k][1] * v[k][1] + v[k][2] * v[k][2]);
        }
        double ab = 0, bc = 0, ca = 0;
        for (int d = 0; d < 3; d++) {
            ab += v[0][d] * v[1][d];
            bc += v[1][d] * v[2][d];
            ca += v[2][d] * v[0][d];
        }
        const double det = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) -
                           v[0][1] * (v[1][0] * v[2][2] - v[1][2] * v[2][0]) +
                           v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
        sum += 2 * atan2(det, l[0] * l[1] * l[2] + ab * l[2] + bc * l[0] + ca * l[1]);
    }
    return sum / (4 * acos(-1));
}

// A star with spikes and dents: a sphere of n x 2n patches whose radius swings.
static int star_triangles(int n, double *corner) {
    int count = 0;
    const double pi = acos(-1);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < 2 * n; j++) {
            double x[4][3];
            for (int k = 0; k < 4; k++) {
                const int a = i + (k == 1 || k == 2), b = (j + (k >= 2)) % (2 * n);
                const bool pole = a == 0 || a == n;
                const double theta = pi * a / n, phi = pole ? 0 : pi * b / n;
                const double radius =
                    0.01 * (1 + (pole ? 0 : 0.35 * sin(3 * theta) * cos(4 * phi)));
                x[k][0] = pole ? 0 : radius * sin(theta) * cos(phi);
                x[k][1] = pole ? 0 : radius * sin(theta) * sin(phi);
                x[k][2] = pole ? (a ? -radius : radius) : radius * cos(theta);
            }
            static const int way[6] = {0, 1, 2, 0, 2, 3};
            for (int k = 0; k < 6; k++) memcpy(corner + 9 * count + 3 * k, x[way[k]], sizeof x[0]);
            count += 2;
        }
    return count;
}

static void star_sides(void **state) {
    (void)state;
    enum { N = 16 };
    double *corner = sn_alloc(4 * N * N * 9, sizeof *corner);
    const int triangles = star_triangles(N, corner);
    sn_tool tool = mesh_tool(triangles, corner, 0);
    const sn_pose pose = sn_pose_at((double[]){0, 0, 0});
    uint64_t seed = 12;
    int inside = 0;
    for (int trial = 0; trial < 1500; trial++) {
        double r[3], n[3], foot[3];
        for (int d = 0; d < 3; d++) r[d] = check_random(&seed, -0.014, 0.014);
        const double depth = sn_tool_depth(&tool, &pose, r, n);
        const double w = winding(triangles, corner, r);
        assert_true(depth > 0 ? w > 0.5 : w < 0.5);
        inside += depth > 0;
        // no corner is nearer than the surface, and the foot of the normal is on the surface
        for (int k = 0; k < 3 * triangles; k++) {
            double s = 0;
            for (int d = 0; d < 3; d++) s += pow(corner[3 * k + d] - r[d], 2);
            assert_true(sqrt(s) >= fabs(depth) - 1e-15);
        }
        for (int d = 0; d < 3; d++) foot[d] = r[d] + depth * n[d];
        CHECK_ABS(sn_tool_depth(&tool, &pose, foot, NULL), 0, 1e-15);
    }
    assert_in_range(inside, 200, 1300);
    // a copy answers the same
    sn_tool copy;
    CHECK_OK(sn_tool_copy(&tool, &copy));
    sn_tool_release(&tool);
    double r[3] = {0.004, 0.005, -0.003};
    assert_true(sn_tool_depth(&copy, &pose, r, NULL) > 0);
    sn_tool_release(&copy);
    sn_free(corner);
}

static void refused_surfaces(void **state) {
    (void)state;
    double corner[12 * 9], turned[12 * 9];
    sn_tool_surface *s = NULL;
    const int n = box_triangles((double[]){0, 0, 0}, (double[]){1, 2, 3}, corner);
    CHECK_FAILS(sn_tool_surface_create(n - 1, corner, &s), SN_E_MESH, "not closed");
    CHECK_FAILS(sn_tool_surface_create(3, corner, &s), SN_E_MESH, "at least 4");
    for (int f = 0; f < n; f++)
        for (int k = 0; k < 3; k++)
            memcpy(turned + 9 * f + 3 * k, corner + 9 * f + 3 * (2 - k), 3 * sizeof(double));
    CHECK_FAILS(sn_tool_surface_create(n, turned, &s), SN_E_MESH, "outwards");
    memcpy(turned, corner, sizeof turned);
    memcpy(turned, corner + 3, 3 * sizeof(double)); // one triangle the other way round
    memcpy(turned + 3, corner, 3 * sizeof(double));
    CHECK_FAILS(sn_tool_surface_create(n, turned, &s), SN_E_MESH, "run the same way");
    memcpy(turned, corner, sizeof turned);
    turned[13] = NAN;
    CHECK_FAILS(sn_tool_surface_create(n, turned, &s), SN_E_MESH, "triangle 2");
    assert_null(s);
}

//---- capsule and plane ---------------------------------------------------------------------------

static void round_and_flat(void **state) {
    (void)state;
    const sn_pose pose = sn_pose_at((double[]){0.01, 0.02, 0.03});
    sn_tool bar = {.kind = SN_TOOL_CAPSULE, .radius = 0.004, .axis = {0, 0, 0.02}};
    double n[3];
    // beside the axis, beyond either end
    CHECK_ABS(sn_tool_depth(&bar, &pose, (double[]){0.013, 0.02, 0.04}, n), 0.001, 1e-17);
    CHECK_ABS(n[0], 1, 1e-14);
    CHECK_ABS(sn_tool_depth(&bar, &pose, (double[]){0.01, 0.02, 0.027}, n), 0.001, 1e-17);
    CHECK_ABS(n[2], -1, 1e-14);
    CHECK_ABS(sn_tool_depth(&bar, &pose, (double[]){0.01, 0.023, 0.054}, n), -0.001, 1e-16);
    CHECK_ABS(n[1], 0.6, 1e-13);
    CHECK_ABS(sn_tool_reach(&bar), 0.024, 1e-17);
    // an axis of no length is a sphere
    sn_tool ball = {.kind = SN_TOOL_CAPSULE, .radius = 0.004}, sphere = {.radius = 0.004};
    const double x[3] = {0.0113, 0.0187, 0.0321};
    assert_true(sn_tool_depth(&ball, &pose, x, NULL) == sn_tool_depth(&sphere, &pose, x, NULL));
    // the plane takes a normal of any length
    sn_tool floor = {.kind = SN_TOOL_PLANE, .axis = {0, 0, 7}};
    CHECK_ABS(sn_tool_depth(&floor, &pose, (double[]){3, 4, 0.025}, n), 0.005, 1e-17);
    CHECK_ABS(n[2], 1, 0);
    assert_true(isinf(sn_tool_reach(&floor)));
}

//---- contact of all shapes, turned ---------------------------------------------------------------

static void random_pose(uint64_t *seed, sn_pose *pose) {
    double vector[3];
    for (int d = 0; d < 3; d++) {
        pose->centre[d] = check_random(seed, -0.02, 0.02);
        vector[d] = check_random(seed, -3, 3);
    }
    sn_rotation(vector, pose->turn);
}

// a point in space of one in the tool's axes
static void to_space(const sn_pose *pose, const double r[3], double x[3]) {
    for (int i = 0; i < 3; i++)
        x[i] = pose->centre[i] + pose->turn[3 * i] * r[0] + pose->turn[3 * i + 1] * r[1] +
               pose->turn[3 * i + 2] * r[2];
}

// The tangent against central differences. Counts slips.
static void check_contact(const sn_tool *tool, const sn_pose *pose, const double x[3],
                          const sn_contact *before, int *slips) {
    const double h = 1e-8;
    double force[3], tangent[9], up[3], down[3];
    sn_contact after;
    assert_true(sn_tool_contact(tool, pose, x, STIFFNESS, before, &after, force, tangent));
    *slips += memcmp(after.anchor, before->anchor, sizeof after.anchor) != 0;
    for (int j = 0; j < 3; j++) {
        double y[3] = {x[0], x[1], x[2]};
        y[j] = x[j] + h;
        sn_tool_contact(tool, pose, y, STIFFNESS, before, &after, up, NULL);
        y[j] = x[j] - h;
        sn_tool_contact(tool, pose, y, STIFFNESS, before, &after, down, NULL);
        // lengths of 1e-3: truncation (h/1e-3)^2 = 1e-10; rounding 1e-17/1e-8 times the curvature
        for (int i = 0; i < 3; i++)
            CHECK_ABS(tangent[3 * i + j], -(up[i] - down[i]) / (2 * h), 3e-8 * STIFFNESS);
    }
    // the force is the same seen in the tool's axes
    double r[3], away[3], local[3], turned[3] = {0, 0, 0};
    const sn_pose still = sn_pose_at((double[]){0, 0, 0});
    for (int d = 0; d < 3; d++) away[d] = x[d] - pose->centre[d];
    for (int d = 0; d < 3; d++)
        r[d] = pose->turn[d] * away[0] + pose->turn[3 + d] * away[1] + pose->turn[6 + d] * away[2];
    sn_tool_contact(tool, &still, r, STIFFNESS, before, &after, local, NULL);
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++) turned[i] += pose->turn[3 * i + d] * local[d];
    for (int i = 0; i < 3; i++) CHECK_ABS(turned[i], force[i], 1e-15 * STIFFNESS);
}

static void contact_of(sn_tool *tool, const double r[3], uint64_t *seed) {
    int slips = 0, trials = 40;
    for (int trial = 0; trial < trials; trial++) {
        sn_pose pose;
        double x[3];
        random_pose(seed, &pose);
        to_space(&pose, r, x);
        sn_contact before = {.touching = true};
        const double way = trial % 2 ? 1e-4 : 2e-3; // sticks, slips
        for (int d = 0; d < 3; d++) before.anchor[d] = r[d] + check_random(seed, -way, way);
        tool->friction = 0.4;
        check_contact(tool, &pose, x, &before, &slips);
        int none = 0;
        tool->friction = 0;
        check_contact(tool, &pose, x, &before, &none);
    }
    assert_in_range(slips, trials / 2 - 3, trials / 2);
}

static void contacts(void **state) {
    (void)state;
    uint64_t seed = 4242;
    sn_tool bar = {.kind = SN_TOOL_CAPSULE, .radius = 0.004, .axis = {0.003, -0.01, 0.02}};
    contact_of(&bar, (double[]){0.0037, -0.0042, 0.0121}, &seed); // beside
    contact_of(&bar, (double[]){-0.001, 0.0021, -0.0023}, &seed); // at the end
    sn_tool floor = {.kind = SN_TOOL_PLANE, .axis = {0.3, -0.2, 0.9}};
    contact_of(&floor, (double[]){0.001, 0.002, -0.0011}, &seed);

    double corner[18 * 9];
    // two boxes that share a side make an L: the inner edge is nearest to points behind it
    int n = box_triangles((double[]){-0.01, -0.01, -0.01}, (double[]){0.01, 0.01, 0.01}, corner);
    sn_tool jaw = mesh_tool(n, corner, 0);
    contact_of(&jaw, (double[]){0.0013, 0.0022, 0.0087}, &seed); // under a face
    sn_tool_release(&jaw);
    double *star = sn_alloc(4 * 8 * 8 * 9, sizeof *star);
    jaw = mesh_tool(star_triangles(8, star), star, 0);
    // behind dents of the star the nearest place is an edge or a corner: normals turn with r
    int bent = 0;
    const sn_pose still = sn_pose_at((double[]){0, 0, 0});
    for (int trial = 0; trial < 400 && bent < 12; trial++) {
        double r[3], a[3], b[3], turn = 0;
        for (int d = 0; d < 3; d++) r[d] = check_random(&seed, -0.009, 0.009);
        const double depth = sn_tool_depth(&jaw, &still, r, a);
        if (depth < 5e-4) continue;
        double away[3] = {r[0] + 1e-7, r[1] - 1e-7, r[2] + 1e-7};
        sn_tool_depth(&jaw, &still, away, b);
        for (int d = 0; d < 3; d++) turn = fmax(turn, fabs(a[d] - b[d]));
        if (!(turn > 1e-6 && turn < 1e-3)) continue; // a face, or a jump between two
        int slips = 0;
        sn_contact before = {.touching = true, .anchor = {r[0], r[1], r[2] + 1e-5}};
        check_contact(&jaw, &still, r, &before, &slips);
        bent++;
    }
    assert_int_equal(bent, 12);
    sn_tool_release(&jaw);
    sn_free(star);
}

static void poses(void **state) {
    (void)state;
    double R[9];
    sn_rotation((double[]){0, 0, acos(-1) / 2}, R); // x to y
    CHECK_ABS(R[3], 1, 1e-15);
    CHECK_ABS(R[0], 0, 1e-15);
    uint64_t seed = 3;
    for (int trial = 0; trial < 50; trial++) {
        const double size = trial % 2 ? 3 : 1e-7;
        double v[3];
        for (int d = 0; d < 3; d++) v[d] = check_random(&seed, -size, size);
        sn_rotation(v, R);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) sum += R[3 * i + k] * R[3 * j + k];
                CHECK_ABS(sum, i == j, 2e-15);
            }
            // the axis stays
            CHECK_ABS(R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2], v[i],
                      3e-15 * size);
        }
        // the first order of a small turn: R - I = cross(v)
        if (size < 1) CHECK_ABS(R[3] - v[2], 0, 1e-14);
    }
    sn_tool tool = {.radius = 1, .at = {1, 2, 3}};
    CHECK_OK(
        sn_history_create(3, 2, (double[]){0, 1}, (double[]){0, 0, 0, 0, 0, acos(-1)}, &tool.turn));
    sn_pose pose;
    sn_tool_pose(&tool, 0.5, &pose);
    CHECK_ABS(pose.turn[3], 1, 1e-15);
    CHECK_ABS(pose.centre[1], 2, 0);
    sn_tool_release(&tool);
}

static void starts_inside(void **state) {
    (void)state;
    sn_case *c = block_case();
    double low[3], high[3];
    for (int d = 0; d < 3; d++) low[d] = INFINITY, high[d] = -INFINITY;
    for (int i = 0; i < 3 * c->mesh->node_count; i++) {
        low[i % 3] = fmin(low[i % 3], c->mesh->node[i]);
        high[i % 3] = fmax(high[i % 3], c->mesh->node[i]);
    }
    const double top = high[2], mid[2] = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
    const double size = top - low[2];
    c->tool = sn_alloc(1, sizeof *c->tool);
    c->tool_count = 1;
    sn_tool *t = c->tool;
    *t = (sn_tool){.name = "bar", .kind = SN_TOOL_CAPSULE, .radius = 0.1 * size};
    t->at[0] = mid[0], t->at[1] = mid[1], t->at[2] = top + 0.11 * size;
    t->axis[2] = size;
    CHECK_OK(sn_case_check(c));
    t->axis[2] = -0.5 * size; // its other end is in the body, between the nodes
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "\"bar\" starts inside");
    *t = (sn_tool){.name = "floor", .kind = SN_TOOL_PLANE, .axis = {0, 0, 1}};
    t->at[2] = low[2];
    CHECK_OK(sn_case_check(c));
    t->axis[2] = -1;
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "turn its normal round");
    t->axis[2] = 0;
    CHECK_FAILS(sn_case_check(c), SN_E_RANGE, "have a length");
    double corner[12 * 9];
    const double small[3] = {-0.01 * size, -0.01 * size, -0.01 * size};
    const int n = box_triangles(small, (double[]){0.01 * size, 0.01 * size, 0.01 * size}, corner);
    *t = mesh_tool(n, corner, 0);
    t->at[0] = mid[0] + 0.013 * size, t->at[1] = mid[1], t->at[2] = top + 0.02 * size;
    CHECK_OK(sn_case_check(c));
    t->at[2] = top - 0.05 * size; // swallowed: no node of the body is in it
    CHECK_FAILS(sn_case_check(c), SN_E_DEFINITION, "\"jaw\" starts inside");
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(box_distances),    cmocka_unit_test(star_sides),
        cmocka_unit_test(refused_surfaces), cmocka_unit_test(round_and_flat),
        cmocka_unit_test(contacts),         cmocka_unit_test(poses),
        cmocka_unit_test(starts_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
