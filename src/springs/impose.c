// What a program imposes on a running state: poses, factors of loads, pushes; and what it reads.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "springs/state.h"

static bool finite3(const double x[3]) {
    return isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]);
}

sn_status sn_state_set_tool(const sn_net *net, sn_state *s, int tool, const sn_pose *pose) {
    SN_ASSERT(tool >= 0 && tool < net->tool_count);
    for (int k = 0; k < 3; k++)
        if (!finite3(pose->turn + 3 * k) || !finite3(pose->centre))
            return sn_fail(SN_E_RANGE,
                           "tool \"%s\": the pose at (%g, %g, %g) m is not finite; it stays where "
                           "it was",
                           net->tool[tool].name, pose->centre[0], pose->centre[1], pose->centre[2]);
    s->tool_set[tool] = true;
    s->tool_pose[tool] = *pose;
    return SN_OK;
}

sn_status sn_state_set_load(const sn_net *net, sn_state *s, int load, double factor) {
    SN_ASSERT(load >= 0 && load < net->factor_count);
    if (!isfinite(factor))
        return sn_fail(SN_E_RANGE, "load %d: the factor %g is not finite; it stays what it was",
                       load, factor);
    s->load_set[load] = true;
    s->load_factor[load] = factor;
    return SN_OK;
}

sn_status sn_state_push(const sn_net *net, sn_state *s, int node, const double force[3]) {
    SN_ASSERT(node >= 0 && node < net->nodes);
    if (!finite3(force))
        return sn_fail(SN_E_RANGE,
                       "node %d: the force (%g, %g, %g) N is not finite; it stays what it was",
                       node, force[0], force[1], force[2]);
    const int place = net->node_place[node];
    int at = 0;
    while (at < s->pushed_count && s->pushed[at] != place) at++;
    memcpy(s->push + 3 * place, force, 3 * sizeof *force);
    if (force[0] != 0 || force[1] != 0 || force[2] != 0) {
        if (at == s->pushed_count) s->pushed[s->pushed_count++] = place;
    } else if (at < s->pushed_count) {
        s->pushed[at] = s->pushed[--s->pushed_count];
    }
    return SN_OK;
}

void sn_state_add_pushes(sn_state *s) {
    for (int k = 0; k < s->pushed_count; k++)
        for (int d = 0; d < 3; d++) {
            const size_t at = 4 * (size_t)s->pushed[k] + (size_t)d;
            sn_real_put(s->precision, s->now.f, at,
                        sn_real_at(s->precision, s->now.f, at) + s->push[3 * s->pushed[k] + d]);
        }
}

double sn_state_load_factor(const sn_net *net, const sn_state *s, int load, double t) {
    if (s->load_set[load]) return s->load_factor[load];
    const sn_history *factor = net->factor[load];
    for (int k = 0; k < net->load_count; k++)
        if (net->load[k].name == load) factor = net->load[k].factor;
    double value;
    sn_history_at(factor, t, &value);
    return value;
}

double sn_state_prescribed(const sn_net *net, const sn_state *s, const sn_net_fixed *fixed,
                           double t, bool was) {
    const int load = fixed->load;
    if (load < 0) return 0.0;
    if (was && !isnan(s->load_was[load])) return s->load_was[load] * fixed->value;
    if (!was && s->load_set[load]) return s->load_factor[load] * fixed->value;
    return sn_net_prescribed(net, fixed, t);
}

void sn_state_clear_imposed(const sn_net *net, sn_state *s) {
    const size_t nodes = (size_t)net->nodes;
    for (int t = 0; t < net->tool_count; t++) {
        s->tool_set[t] = false;
        s->tool_phase[t] = 0;
    }
    for (int l = 0; l < net->factor_count; l++) {
        s->load_set[l] = false;
        s->load_was[l] = (double)NAN;
    }
    memset(s->push, 0, nodes * 3 * sizeof *s->push);
    s->pushed_count = 0;
    for (size_t i = 0; i < nodes; i++) s->grip[i].tool = -1;
    s->gripped_count = 0;
}

//---- reading -------------------------------------------------------------------------------------

void sn_state_look(const sn_net *net, const sn_state *s, sn_state_view *view) {
    *view = (sn_state_view){.precision = s->precision,
                            .stride = 4,
                            .displacement = s->u,
                            .velocity = s->v,
                            .force = s->now.f,
                            .rest = net->node_position,
                            .place = net->node_place};
}

void sn_state_positions(const sn_net *net, const sn_state *s, double *out) {
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            out[3 * net->node_name[i] + d] =
                net->node_position[3 * i + d] +
                sn_real_at(s->precision, s->u, 4 * (size_t)i + (size_t)d);
}

void sn_state_tool_force(const sn_net *net, const sn_state *s, int tool, double force[3]) {
    SN_ASSERT(tool >= 0 && tool < net->tool_count);
    memcpy(force, s->tool_force[tool], 3 * sizeof *force);
}

void sn_state_tool_torque(const sn_net *net, const sn_state *s, int tool, double torque[3]) {
    SN_ASSERT(tool >= 0 && tool < net->tool_count);
    memcpy(torque, s->tool_torque[tool], 3 * sizeof *torque);
}
