// Nodes that tools hold.
// SPDX-License-Identifier: Apache-2.0
//
// A held node takes the place that its tool's pose gives it at the end of each step, and the
// velocity that leads there. What the tool must give it for that is its mass times its acceleration
// less all other forces on it; the tool gets the opposite.
#include <math.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/state.h"

static const double same_time = 1e-9; // of the whole time: two times that are one

static double place_of(const sn_net *net, const sn_state *s, int node, int d) {
    return net->node_position[3 * node + d] +
           sn_real_at(s->precision, s->u, 4 * (size_t)node + (size_t)d);
}

static void hold(const sn_net *net, sn_state *s, int tool, const sn_pose *pose, int node) {
    sn_grip *grip = &s->grip[node];
    const sn_parts *parts = sn_state_parts(s);
    if (net->fixed_bits[node] == 7 || (parts && parts->loose[node])) return; // nothing to hold
    if (grip->tool < 0) s->gripped[s->gripped_count++] = node;
    *grip = (sn_grip){.tool = tool};
    double r[3];
    for (int d = 0; d < 3; d++) r[d] = place_of(net, s, node, d) - pose->centre[d];
    for (int d = 0; d < 3; d++)
        for (int e = 0; e < 3; e++) grip->at[d] += pose->turn[3 * e + d] * r[e];
}

int sn_state_grasp(const sn_net *net, sn_state *s, int tool, int count, const int *nodes) {
    SN_ASSERT(tool >= 0 && tool < net->tool_count);
    if (net->integrator != SN_INTEGRATOR_EXPLICIT) return 0;
    sn_pose pose;
    sn_net_tool_pose(net, s, tool, s->time, &pose);
    for (int k = 0; k < count && nodes; k++) {
        SN_ASSERT(nodes[k] >= 0 && nodes[k] < net->nodes);
        hold(net, s, tool, &pose, net->node_place[nodes[k]]);
    }
    const sn_contact *contact = s->contact + (size_t)tool * (size_t)net->contact_count;
    for (int k = 0; k < net->contact_count && !nodes; k++)
        if (contact[k].touching) hold(net, s, tool, &pose, net->contact_node[k]);
    int held = 0;
    for (int k = 0; k < s->gripped_count; k++) held += s->grip[s->gripped[k]].tool == tool;
    return held;
}

void sn_state_release(const sn_net *net, sn_state *s, int tool) {
    SN_ASSERT(tool >= 0 && tool < net->tool_count);
    int kept = 0;
    for (int k = 0; k < s->gripped_count; k++) {
        const int node = s->gripped[k];
        if (s->grip[node].tool == tool)
            s->grip[node].tool = -1;
        else
            s->gripped[kept++] = node;
    }
    s->gripped_count = kept;
}

void sn_state_move_grips(const sn_net *net, sn_state *s, double h) {
    for (int k = 0; k < s->gripped_count; k++) {
        const int node = s->gripped[k];
        sn_grip *grip = &s->grip[node];
        sn_pose pose;
        sn_net_tool_pose(net, s, grip->tool, s->time + h, &pose);
        for (int d = 0; d < 3; d++) {
            const size_t at = 4 * (size_t)node + (size_t)d;
            if (net->fixed_bits[node] >> d & 1) continue;
            double there = pose.centre[d] - net->node_position[3 * node + d];
            for (int e = 0; e < 3; e++) there += pose.turn[3 * d + e] * grip->at[e];
            double v = (there - grip->u_before[d]) / h;
            grip->way_a[d] = (v - grip->v_before[d]) / h;
            sn_real_put(s->precision, s->v, at, v);
            sn_real_put(s->precision, s->u, at, there);
        }
    }
}

void sn_state_remember_grips(sn_state *s) {
    for (int k = 0; k < s->gripped_count; k++)
        for (int d = 0; d < 3; d++) {
            const size_t at = 4 * (size_t)s->gripped[k] + (size_t)d;
            s->grip[s->gripped[k]].u_before[d] = sn_real_at(s->precision, s->u, at);
            s->grip[s->gripped[k]].v_before[d] = sn_real_at(s->precision, s->v, at);
        }
}

void sn_state_pull_tools(const sn_net *net, sn_state *s) {
    for (int k = 0; k < s->gripped_count; k++) {
        const int node = s->gripped[k];
        const sn_grip *grip = &s->grip[node];
        double f[3], r[3];
        for (int d = 0; d < 3; d++) {
            const bool fixed = net->fixed_bits[node] >> d & 1;
            f[d] = fixed ? 0.0
                         : sn_real_at(s->precision, s->now.f, 4 * (size_t)node + (size_t)d) -
                               net->mass[node] * grip->way_a[d];
            r[d] = place_of(net, s, node, d) - s->tool_pose[grip->tool].centre[d];
            s->tool_force[grip->tool][d] += f[d];
        }
        for (int d = 0; d < 3; d++) {
            const int e = (d + 1) % 3, g = (d + 2) % 3;
            s->tool_torque[grip->tool][d] += r[e] * f[g] - r[g] * f[e];
        }
    }
}

void sn_state_follow_grasps(const sn_net *net, sn_state *s) {
    const double now = s->time + same_time * net->until;
    for (int t = 0; t < net->tool_count; t++) {
        const sn_tool *tool = &net->tool[t];
        if (!(tool->grasp[1] > tool->grasp[0])) continue;
        if (s->tool_phase[t] == 0 && now >= tool->grasp[0]) {
            sn_state_grasp(net, s, t, 0, NULL);
            s->tool_phase[t] = 1;
        }
        if (s->tool_phase[t] == 1 && now >= tool->grasp[1]) {
            sn_state_release(net, s, t);
            s->tool_phase[t] = 2;
        }
    }
}
