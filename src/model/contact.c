// Contact of a surface point with a tool: penalty, elastic stick, Coulomb slip.
// SPDX-License-Identifier: Apache-2.0
// Source: return mapping for friction, Wriggers, Computational Contact Mechanics (2006),
// section 5.2.
//
// Everything is in the tool's axes: r the point, n the tool's outward normal there, N = dn/dr
// (symmetric, N n = 0), g the depth with dg/dr = -n, k the stiffness.
//     normal force     f_n = k g n
//     trial friction   f_t = -k s,  s = (I - nn) w,  w = r - anchor
//     slip             |k s| > mu k g: f_t = -mu k g s/|s|; the anchor follows, so that k|s| = mu k
//     g
// Derivatives, with P = I - nn (constant anchor):
//     -df_n/dr = k (nn - g N),  ds/dr = P - (n.w) N - n (N w)
//     stick  -df_t/dr = k ds/dr
//     slip   -df_t/dr = mu k (g/|s| (I - tt) ds/dr - tn),  t = s/|s|
#include <string.h>

#include "base/vector.h"
#include "model/tool.h"

// The part of w along the surface, and its derivative where wanted.
static void slide(const sn_touch *at, const double w[3], double s[3], double ds[9]) {
    const double along = dot3(at->n, w);
    double bent[3];
    for (int i = 0; i < 3; i++) s[i] = w[i] - along * at->n[i];
    if (!ds) return;
    times3(at->bend, w, bent);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            ds[3 * i + j] =
                (i == j) - at->n[i] * at->n[j] - along * at->bend[3 * i + j] - at->n[i] * bent[j];
}

// Adds friction to force and tangent over the stiffness; `kept` of s is left after slipping.
static void rub(const sn_touch *at, double friction, const double w[3], double force[3],
                double tangent[9], double s[3], double *kept) {
    double ds[9], t[3];
    slide(at, w, s, tangent ? ds : NULL);
    const double size = norm3(s), limit = friction * at->depth;
    const bool slips = size > limit;
    *kept = slips ? limit / size : 1;
    for (int i = 0; i < 3; i++) force[i] -= *kept * s[i];
    if (!tangent) return;
    for (int i = 0; i < 3; i++) t[i] = slips ? s[i] / size : 0;
    for (int j = 0; j < 3; j++) {
        const double along = t[0] * ds[j] + t[1] * ds[3 + j] + t[2] * ds[6 + j];
        for (int i = 0; i < 3; i++)
            tangent[3 * i + j] +=
                *kept * (ds[3 * i + j] - t[i] * along) - (slips ? friction * t[i] * at->n[j] : 0);
    }
}

bool sn_tool_contact(const sn_tool *tool, const sn_pose *pose, const double position[3],
                     double stiffness, const sn_contact *before, sn_contact *after, double force[3],
                     double tangent[9]) {
    sn_touch at;
    double away[3], r[3], local[3] = {0}, K[9], KR[9];
    memset(force, 0, 3 * sizeof *force);
    if (tangent) memset(tangent, 0, 9 * sizeof *tangent);
    sub3(position, pose->centre, away);
    transpose_times3(pose->turn, away, r);
    sn_tool_near(tool, r, &at);
    const sn_contact memory = *before; // the two may be one
    *after = (sn_contact){0};
    if (!(at.depth > 0) || !(norm3(at.n) > 0)) return false; // no direction at the very centre

    after->touching = true;
    for (int i = 0; i < 3; i++) {
        local[i] = at.depth * at.n[i];
        after->anchor[i] = r[i];
        for (int j = 0; j < 3; j++)
            K[3 * i + j] = at.n[i] * at.n[j] - at.depth * at.bend[3 * i + j];
    }
    if (tool->friction > 0 && memory.touching) { // the first touch sticks where it is: no friction
        double w[3], s[3], kept;
        sub3(r, memory.anchor, w);
        rub(&at, tool->friction, w, local, tangent ? K : NULL, s, &kept);
        for (int i = 0; i < 3; i++)
            after->anchor[i] = kept < 1 ? r[i] - kept * s[i] : memory.anchor[i];
    }
    times3(pose->turn, local, force);
    for (int i = 0; i < 3; i++) force[i] *= stiffness;
    if (!tangent) return true;
    for (int i = 0; i < 3; i++) // turn K turn^T
        for (int j = 0; j < 3; j++)
            KR[3 * i + j] = K[3 * i] * pose->turn[3 * j] + K[3 * i + 1] * pose->turn[3 * j + 1] +
                            K[3 * i + 2] * pose->turn[3 * j + 2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            tangent[3 * i + j] =
                stiffness * (pose->turn[3 * i] * KR[j] + pose->turn[3 * i + 1] * KR[3 + j] +
                             pose->turn[3 * i + 2] * KR[6 + j]);
    return true;
}
