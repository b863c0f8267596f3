// Contact of a point with a sphere.
// SPDX-License-Identifier: Apache-2.0
#include "check.h"
#include "sinew/model.h"

#define STIFFNESS 37.0 // N/m
#define RADIUS 0.0053  // m

static sn_tool sphere(double friction) {
    return (sn_tool){
        .name = "probe", .radius = RADIUS, .at = {0.01, -0.02, 0.03}, .friction = friction};
}

static bool touch(const sn_tool *tool, const double centre[3], const double position[3],
                  double stiffness, const sn_contact *before, sn_contact *after, double force[3],
                  double tangent[9]) {
    const sn_pose pose = sn_pose_at(centre);
    return sn_tool_contact(tool, &pose, position, stiffness, before, after, force, tangent);
}

static void centre_at(const sn_tool *tool, double t, double centre[3]) {
    sn_pose pose;
    sn_tool_pose(tool, t, &pose);
    for (int i = 0; i < 3; i++) centre[i] = pose.centre[i];
}

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length(const double *a) {
    return sqrt(dot(a, a));
}

// A point at this depth in a random direction, with an anchor `slip` away in a random direction.
static void random_contact(uint64_t *seed, double depth, double slip, const double centre[3],
                           double x[3], sn_contact *before) {
    double n[3], s[3];
    for (int i = 0; i < 3; i++) {
        n[i] = check_random(seed, -1, 1);
        s[i] = check_random(seed, -1, 1);
    }
    double ln = length(n), ls = length(s);
    before->touching = true;
    for (int i = 0; i < 3; i++) {
        x[i] = centre[i] + (RADIUS - depth) * n[i] / ln;
        before->anchor[i] = x[i] - centre[i] + slip * s[i] / ls;
    }
}

// The tangent against central differences of the force. Returns the largest entry off symmetry of
// the differences.
static double check_tangent(const sn_tool *tool, const double x[3], const sn_contact *before) {
    double force[3], tangent[9], K[9], h = 1e-5 * RADIUS;
    sn_contact after;
    assert_true(touch(tool, tool->at, x, STIFFNESS, before, &after, force, tangent));
    for (int j = 0; j < 3; j++) {
        double y[3] = {x[0], x[1], x[2]}, up[3], down[3];
        y[j] = x[j] + h;
        assert_true(touch(tool, tool->at, y, STIFFNESS, before, &after, up, NULL));
        y[j] = x[j] - h;
        assert_true(touch(tool, tool->at, y, STIFFNESS, before, &after, down, NULL));
        for (int i = 0; i < 3; i++) K[3 * i + j] = -(up[i] - down[i]) / (2 * h);
    }
    double skew = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            // truncation h^2 = 1e-10 over the smallest length squared, (slip/radius)^2 = 1e-2 or
            // so; rounding 1e-16 / 1e-5
            CHECK_ABS(tangent[3 * i + j] / STIFFNESS, K[3 * i + j] / STIFFNESS, 2e-9);
            skew = fmax(skew, fabs(K[3 * i + j] - K[3 * j + i]) / STIFFNESS);
        }
    return skew;
}

static void tangents(void **state) {
    (void)state;
    uint64_t seed = 991;
    double x[3];
    sn_contact before, after;
    double force[3];
    sn_tool smooth = sphere(0), rough = sphere(0.3);
    for (int trial = 0; trial < 40; trial++) {
        random_contact(&seed, 0.1 * RADIUS, 0.2 * RADIUS, smooth.at, x, &before);
        double skew = check_tangent(&smooth, x, &before);
        CHECK_ABS(skew, 0, 1e-9); // no friction: the force has a potential
        // stick: slip below 0.3 * 0.1 of the radius
        random_contact(&seed, 0.1 * RADIUS, 0.029 * RADIUS, rough.at, x, &before);
        touch(&rough, rough.at, x, STIFFNESS, &before, &after, force, NULL);
        assert_memory_equal(after.anchor, before.anchor, sizeof after.anchor);
        check_tangent(&rough, x, &before);
        // slip, unless the anchor lies nearly along the normal
        random_contact(&seed, 0.1 * RADIUS, 0.5 * RADIUS, rough.at, x, &before);
        touch(&rough, rough.at, x, STIFFNESS, &before, &after, force, NULL);
        if (!memcmp(after.anchor, before.anchor, sizeof after.anchor)) continue;
        skew = check_tangent(&rough, x, &before);
        assert_true(skew > 0.01); // slip has no potential: the differences see it
    }
}

static void normal_force(void **state) {
    (void)state;
    sn_tool tool = sphere(0);
    sn_contact none = {0}, after;
    double force[3], tangent[9], x[3] = {0.01, -0.02, 0.03 - 0.9 * RADIUS};
    assert_true(touch(&tool, tool.at, x, STIFFNESS, &none, &after, force, tangent));
    assert_true(after.touching);
    // pushed away from the centre: k * depth; 0.03 - 0.9 R and back rounds at 1e-16 * 0.03/(0.1 R)
    CHECK_REL(force[2], -STIFFNESS * 0.1 * RADIUS, 1e-13);
    CHECK_ABS(force[0], 0, 0);
    CHECK_ABS(force[1], 0, 0);
    CHECK_REL(tangent[8], STIFFNESS, 1e-13);
    CHECK_REL(tangent[0], -STIFFNESS * 0.1 / 0.9, 1e-13);

    x[2] = 0.03 - 1.0001 * RADIUS; // out of reach: nothing, and what was there is wiped
    after.touching = true;
    force[0] = tangent[3] = 7;
    assert_false(touch(&tool, tool.at, x, STIFFNESS, &none, &after, force, tangent));
    assert_false(after.touching);
    CHECK_ABS(length(force), 0, 0);
    for (int i = 0; i < 9; i++) CHECK_ABS(tangent[i], 0, 0);
    x[2] = 0.03; // the very centre has no direction
    assert_false(touch(&tool, tool.at, x, STIFFNESS, &none, &after, force, NULL));

    // penalty energy k depth^2 / 2: work along a path equals its change (Simpson on 200 intervals)
    double from[3] = {0.01 + 0.2 * RADIUS, -0.02, 0.03 - 0.7 * RADIUS};
    double to[3] = {0.01 - 0.4 * RADIUS, -0.02 + 0.5 * RADIUS, 0.03 - 0.3 * RADIUS};
    double work = 0, d[3], depth[2] = {0};
    for (int i = 0; i < 3; i++) d[i] = to[i] - from[i];
    for (int k = 0; k <= 200; k++) {
        double y[3], s = k / 200.0;
        for (int i = 0; i < 3; i++) y[i] = from[i] + s * d[i];
        touch(&tool, tool.at, y, STIFFNESS, &none, &after, force, NULL);
        work += dot(force, d) / 600 * (k == 0 || k == 200 ? 1 : k % 2 ? 4 : 2);
        double r[3];
        for (int i = 0; i < 3; i++) r[i] = y[i] - tool.at[i];
        if (k == 0) depth[0] = RADIUS - length(r);
        depth[1] = RADIUS - length(r);
    }
    // Simpson: (1/200)^4 of a smooth function, some 1e-9
    CHECK_REL(work, STIFFNESS * (depth[0] * depth[0] - depth[1] * depth[1]) / 2, 1e-7);
}

// The same contact turned by 90 degrees about z turns force, anchor and tangent.
static void turned(void **state) {
    (void)state;
    uint64_t seed = 5;
    sn_tool tool = sphere(0.3);
    for (int trial = 0; trial < 20; trial++) {
        double x[3], origin[3] = {0}, f[3], g[3], K[9], L[9];
        sn_contact before, after, turned_before, turned_after;
        random_contact(&seed, 0.2 * RADIUS, 0.1 * RADIUS, origin, x, &before);
        double y[3] = {-x[1], x[0], x[2]};
        turned_before = before;
        turned_before.anchor[0] = -before.anchor[1];
        turned_before.anchor[1] = before.anchor[0];
        touch(&tool, origin, x, STIFFNESS, &before, &after, f, K);
        touch(&tool, origin, y, STIFFNESS, &turned_before, &turned_after, g, L);
        double tiny = 1e-15 * STIFFNESS; // rounding
        CHECK_ABS(g[0], -f[1], tiny * RADIUS);
        CHECK_ABS(g[1], f[0], tiny * RADIUS);
        CHECK_ABS(g[2], f[2], tiny * RADIUS);
        CHECK_ABS(turned_after.anchor[0], -after.anchor[1], 1e-15 * RADIUS);
        CHECK_ABS(L[0], K[4], 2 * tiny);
        CHECK_ABS(L[1], -K[3], 2 * tiny);
        CHECK_ABS(L[8], K[8], 2 * tiny);
    }
}

// A point dragged along under constant depth: sticks with stiffness k, then slips at mu times the
// normal force, which opposes the motion; turning back, it sticks again until the other side.
static void stick_and_slip(void **state) {
    (void)state;
    double mu = 0.4, depth = 0.0002;
    sn_tool tool = sphere(mu);
    sn_contact memory = {0};
    double lateral = 0, tangential_now = 0, force[3], limit = mu * STIFFNESS * depth;
    // the point keeps its place; the tool turns under it by small angles about the centre's y axis,
    // so that depth stays and the tangential way is known: (radius - depth) * angle
    double distance = RADIUS - depth, slipped_at = 0;
    for (int k = 0; k <= 400; k++) {
        double angle = 0.0002 * (k <= 200 ? k : 400 - k);
        double x[3] = {tool.at[0] + distance * sin(angle), tool.at[1],
                       tool.at[2] - distance * cos(angle)};
        assert_true(touch(&tool, tool.at, x, STIFFNESS, &memory, &memory, force, NULL));
        double t[3] = {cos(angle), 0, sin(angle)}, n[3] = {sin(angle), 0, -cos(angle)};
        tangential_now = dot(force, t);
        // rounding: coordinates 0.03 with 1e-16 against a depth of 2e-4
        CHECK_REL(dot(force, n), STIFFNESS * depth, 1e-12);
        assert_true(fabs(tangential_now) <= limit * (1 + 1e-12));
        lateral = distance * angle;
        if (k <= 200 && STIFFNESS * distance * sin(angle) < limit) // stick: s = distance sin(angle)
            CHECK_ABS(tangential_now, -STIFFNESS * distance * sin(angle), 1e-12 * limit);
        else if (k <= 200) { // slip: against the motion
            CHECK_REL(tangential_now, -limit, 1e-12);
            if (slipped_at == 0) slipped_at = lateral;
        }
    }
    CHECK_REL(slipped_at, limit / STIFFNESS, 0.02); // the step is 1.3 % of that way
    CHECK_REL(tangential_now, limit, 1e-12);        // all the way back: slips the other way
    // first touch makes no friction
    sn_contact none = {0};
    double x[3] = {tool.at[0], tool.at[1] + 0.6 * distance, tool.at[2] - 0.8 * distance};
    touch(&tool, tool.at, x, STIFFNESS, &none, &memory, force, NULL);
    CHECK_REL(length(force), STIFFNESS * depth, 1e-12);
    CHECK_REL(length(memory.anchor), distance, 1e-12);
}

// A tool that moves together with its point does not rub: memory is relative to the centre.
static void moves_along(void **state) {
    (void)state;
    sn_tool tool = sphere(0.4);
    sn_history *path = NULL;
    double time[] = {0, 2}, value[] = {0, 0, 0, 0.01, 0.02, -0.04};
    CHECK_OK(sn_history_create(3, 2, time, value, &path));
    tool.path = path;
    double centre[3], force[3], first[3];
    sn_contact memory = {0};
    for (int k = 0; k <= 10; k++) {
        centre_at(&tool, 0.2 * k, centre);
        for (int i = 0; i < 3; i++)
            CHECK_ABS(centre[i], tool.at[i] + 0.1 * k * value[3 + i], 1e-17);
        double x[3] = {centre[0] + 0.6 * 0.95 * RADIUS, centre[1], centre[2] + 0.8 * 0.95 * RADIUS};
        touch(&tool, centre, x, STIFFNESS, &memory, &memory, force, NULL);
        if (k == 0) memcpy(first, force, sizeof first);
        for (int i = 0; i < 3; i++) CHECK_ABS(force[i], first[i], 1e-15); // 0.03 m * 1e-16 * 37 N/m
    }
    tool.path = NULL;
    centre_at(&tool, 1, centre);
    assert_memory_equal(centre, tool.at, sizeof centre);
    sn_history_destroy(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tangents),       cmocka_unit_test(normal_force), cmocka_unit_test(turned),
        cmocka_unit_test(stick_and_slip), cmocka_unit_test(moves_along),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
