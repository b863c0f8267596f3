// Rigid tools: their poses, and how deep a point is in them.
// SPDX-License-Identifier: Apache-2.0
#include "model/tool.h"

#include <string.h>

#include "base/vector.h"

//---- owning --------------------------------------------------------------------------------------

sn_status sn_tool_copy(const sn_tool *tool, sn_tool *copy) {
    *copy = *tool;
    copy->path = copy->turn = NULL;
    copy->surface = NULL;
    sn_status status;
    SN_TRY_GOTO(status, sn_history_copy(tool->path, &copy->path));
    SN_TRY_GOTO(status, sn_history_copy(tool->turn, &copy->turn));
    if (tool->surface) SN_TRY_GOTO(status, sn_tool_surface_copy(tool->surface, &copy->surface));
    return SN_OK;
fail:
    sn_tool_release(copy);
    return status;
}

void sn_tool_release(sn_tool *tool) {
    sn_history_destroy(tool->path);
    sn_history_destroy(tool->turn);
    sn_tool_surface_destroy(tool->surface);
    tool->path = tool->turn = NULL;
    tool->surface = NULL;
}

//---- poses ---------------------------------------------------------------------------------------

static const double unturned[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

sn_pose sn_pose_at(const double centre[3]) {
    sn_pose pose;
    memcpy(pose.centre, centre, sizeof pose.centre);
    memcpy(pose.turn, unturned, sizeof pose.turn);
    return pose;
}

void sn_rotation(const double vector[3], double turn[9]) {
    const double angle = norm3(vector);
    memcpy(turn, unturned, sizeof unturned);
    if (!(angle > 0)) return;
    const double half = 0.5 * angle, s = sin(angle) / angle;
    const double c = 2 * (sin(half) / angle) * (sin(half) / angle); // (1 - cos)/angle^2, no cancel
    const double cross[9] = {0,          -vector[2], vector[1], vector[2], 0,
                             -vector[0], -vector[1], vector[0], 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            turn[3 * i + j] +=
                s * cross[3 * i + j] + c * (vector[i] * vector[j] - (i == j) * angle * angle);
}

void sn_tool_pose(const sn_tool *tool, double t, sn_pose *pose) {
    double path[3] = {0, 0, 0}, turn[3] = {0, 0, 0};
    if (tool->path) sn_history_at(tool->path, t, path);
    if (tool->turn) sn_history_at(tool->turn, t, turn);
    for (int i = 0; i < 3; i++) pose->centre[i] = tool->at[i] + path[i];
    sn_rotation(turn, pose->turn);
}

//---- shapes --------------------------------------------------------------------------------------

// n = from/|from|: outward of a ball around a point, or of a round bar, whose axis (unit) is then
// taken out of dn/dr
static void round_touch(double radius, const double from[3], const double *axis, sn_touch *touch) {
    const double distance = norm3(from);
    touch->depth = radius - distance;
    if (!(distance > 0)) return; // on the axis there is no direction
    for (int i = 0; i < 3; i++) touch->n[i] = from[i] / distance;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double project = (i == j) - touch->n[i] * touch->n[j];
            if (axis) project -= axis[i] * axis[j];
            touch->bend[3 * i + j] = project / distance;
        }
}

static void capsule_touch(const sn_tool *tool, const double r[3], sn_touch *touch) {
    const double length = norm3(tool->axis);
    double axis[3] = {0, 0, 0}, from[3];
    for (int i = 0; i < 3 && length > 0; i++) axis[i] = tool->axis[i] / length;
    const double along = fmin(fmax(dot3(r, axis), 0), length);
    for (int i = 0; i < 3; i++) from[i] = r[i] - along * axis[i];
    round_touch(tool->radius, from, along > 0 && along < length ? axis : NULL, touch);
}

static void plane_touch(const sn_tool *tool, const double r[3], sn_touch *touch) {
    const double length = norm3(tool->axis);
    for (int i = 0; i < 3; i++) touch->n[i] = tool->axis[i] / length;
    touch->depth = -dot3(r, touch->n);
}

void sn_tool_near(const sn_tool *tool, const double r[3], sn_touch *touch) {
    *touch = (sn_touch){0};
    switch (tool->kind) {
    case SN_TOOL_SPHERE: round_touch(tool->radius, r, NULL, touch); return;
    case SN_TOOL_CAPSULE: capsule_touch(tool, r, touch); return;
    case SN_TOOL_PLANE: plane_touch(tool, r, touch); return;
    case SN_TOOL_MESH: sn_tool_surface_near(tool->surface, r, touch); return;
    }
}

double sn_tool_reach(const sn_tool *tool) {
    switch (tool->kind) {
    case SN_TOOL_SPHERE: return tool->radius;
    case SN_TOOL_CAPSULE: return tool->radius + norm3(tool->axis);
    case SN_TOOL_PLANE: return (double)INFINITY;
    case SN_TOOL_MESH: return sn_tool_surface_reach(tool->surface);
    }
    return (double)INFINITY;
}

double sn_tool_depth(const sn_tool *tool, const sn_pose *pose, const double position[3],
                     double normal[3]) {
    double away[3], r[3];
    sn_touch touch;
    sub3(position, pose->centre, away);
    transpose_times3(pose->turn, away, r);
    sn_tool_near(tool, r, &touch);
    if (normal) times3(pose->turn, touch.n, normal);
    return touch.depth;
}
