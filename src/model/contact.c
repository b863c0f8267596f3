// Contact of a surface point with a tool: penalty, elastic stick, Coulomb slip.
// SPDX-License-Identifier: Apache-2.0
// Source: return mapping for friction, Wriggers, Computational Contact Mechanics (2006),
// section 5.2.
//
// Everything is relative to the tool's centre: r = position - centre, distance p, n = r/p, depth
// g = radius - p, k the stiffness.
//     normal force     f_n = k g n
//     trial friction   f_t = -k s,  s = (I - nn)(r - anchor)
//     slip             |k s| > mu k g: f_t = -mu k g s/|s|; the anchor follows, so that k|s| = mu k
//     g
// Derivatives, with P = I - nn, w = r - anchor (constant anchor):
//     dn/dr = P/p,  dg/dr = -n,  ds/dr = (1 - n.w/p) P - n s/p
#include <string.h>

#include "base/vector.h"
#include "sinew/model.h"

void sn_tool_centre(const sn_tool *tool, double t, double centre[3]) {
    double path[3] = {0, 0, 0};
    if (tool->path) sn_history_at(tool->path, t, path);
    for (int i = 0; i < 3; i++) centre[i] = tool->at[i] + path[i];
}

// Where a point is against a sphere.
typedef struct touch {
    double r[3], n[3];
    double distance, depth;
} touch;

// Adds -df_t/dr, its symmetric part, for friction along s.
static void add_friction_tangent(const touch *at, double stiffness, double friction,
                                 const double anchor[3], const double s[3], bool slips,
                                 double tangent[9]) {
    double w[3], slip[3] = {0}, limit = 0; // f_t = -k limit s where it slips
    sub3(at->r, anchor, w);
    double turn = 1 - dot3(at->n, w) / at->distance;
    if (slips) {
        double size = norm3(s);
        limit = friction * at->depth / size;
        for (int i = 0; i < 3; i++) slip[i] = s[i] / size;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double *n = at->n;
            double project = (i == j) - n[i] * n[j];
            double d = turn * (project - slip[i] * slip[j]) -
                       0.5 * (n[i] * s[j] + s[i] * n[j]) / at->distance;
            if (slips) d = limit * d - 0.5 * friction * (slip[i] * n[j] + n[i] * slip[j]);
            tangent[3 * i + j] += stiffness * d;
        }
}

bool sn_tool_contact(const sn_tool *tool, const double centre[3], const double position[3],
                     double stiffness, const sn_contact *before, sn_contact *after, double force[3],
                     double tangent[9]) {
    touch at;
    sub3(position, centre, at.r);
    at.distance = norm3(at.r);
    at.depth = tool->radius - at.distance;
    memset(force, 0, 3 * sizeof *force);
    if (tangent) memset(tangent, 0, 9 * sizeof *tangent);
    const sn_contact memory = *before; // the two may be one
    *after = (sn_contact){0};
    if (!(at.depth > 0) || !(at.distance > 0)) return false; // no direction at the very centre

    after->touching = true;
    double turned = at.depth / at.distance;
    for (int i = 0; i < 3; i++) {
        at.n[i] = at.r[i] / at.distance;
        force[i] = stiffness * at.depth * at.n[i];
        after->anchor[i] = at.r[i];
    }
    if (tangent)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                tangent[3 * i + j] =
                    stiffness * ((1 + turned) * (at.n[i] * at.n[j]) - turned * (i == j));
    if (!(tool->friction > 0)) return true;

    const double *anchor = memory.touching ? memory.anchor : at.r;
    double s[3], w[3];
    sub3(at.r, anchor, w);
    double along = dot3(at.n, w);
    for (int i = 0; i < 3; i++) s[i] = w[i] - along * at.n[i];
    double size = norm3(s), limit = tool->friction * at.depth;
    bool slips = size > limit;
    double kept = slips ? limit / size : 1;
    for (int i = 0; i < 3; i++) {
        force[i] -= stiffness * kept * s[i];
        after->anchor[i] = slips ? at.r[i] - kept * s[i] : anchor[i];
    }
    if (tangent) add_friction_tangent(&at, stiffness, tool->friction, anchor, s, slips, tangent);
    return true;
}
