// Contact that does not shorten the explicit step.
// SPDX-License-Identifier: Apache-2.0
//
// A node that touches a tool hangs on a spring K = k nn, with k (I - nn) in addition where friction
// sticks, which oscillates faster than the tissue does. Taken where the node will be, h v+ from
// here, instead of where it is (backward Euler), this spring turns the step
//     m (v+ - v) = h f   into   (m + h^2 K) v+ = m v + h f.
// With h^2 K = kappa m, and h^2 w^2 of the tissue there, the amplitude of a step is below 1 as long
// as h^2 w^2 < 4 + kappa: contact leaves the limit of the step where the tissue has it, whatever k
// is, and takes energy from a node that strikes a tool; a rule that keeps the energy would feed the
// chatter of a node that touches in some steps only. Nothing changes in equilibrium.
//
// The force of the tool on the node is then f_contact - h K v+: what the tool feels, what counts as
// its work, and what moves the node all are this force. h is the last step; the next one may be
// longer by a fifth (SN_TOUCH_GROWTH; 1.236 is the limit where k is infinite).
#include <math.h>

#include "springs/parts.h"
#include "springs/steps.h"

double sn_state_touch_step(const sn_net *net, const sn_state *s) {
    if (s->last_step > 0) return s->last_step;
    const double limit = sn_net_step_safety(net) * sn_net_stable_step(net, s->ruling_omega2);
    return net->asked_step > 0 ? fmin(net->asked_step, limit) : limit;
}

/// A node that touches, and its tools.
typedef struct touch {
    int node;
    double x[3], v[3], f[3];
    double hK[9]; ///< of all tools, times h
} touch;

// adds the stiffness of the touch of one tool, times scale: nn, and I - nn where friction holds
static void add_stiffness(const sn_tool *tool, const sn_pose *pose, const sn_contact *contact,
                          const double x[3], double scale, double K[9]) {
    double n[3], slid2 = 0, along = 0;
    const double most = tool->friction * sn_tool_depth(tool, pose, x, n);
    for (int i = 0; i < 3; i++) {
        double way = x[i] - pose->centre[i];
        for (int j = 0; j < 3; j++) way -= pose->turn[3 * i + j] * contact->anchor[j];
        along += way * n[i];
        slid2 += way * way;
    }
    // where it slips the anchor has followed until friction is all that there can be
    const bool sticks = most > 0 && slid2 - along * along < 0.999 * most * most;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) K[3 * i + j] += scale * (sticks ? i == j : n[i] * n[j]);
}

// solves (m + h A) a = f - A v in the directions that are free, A symmetric and not negative
static void solve(double m, double h, const double A[9], unsigned fixed, const double f[3],
                  const double v[3], double a[3]) {
    double M[3][4];
    for (int i = 0; i < 3; i++) {
        const bool held = fixed >> i & 1;
        for (int j = 0; j < 3; j++)
            M[i][j] = (i == j) * m + (held || fixed >> j & 1 ? 0.0 : h * A[3 * i + j]);
        M[i][3] = f[i];
        for (int j = 0; j < 3; j++) M[i][3] -= A[3 * i + j] * v[j];
        if (held) M[i][3] = 0.0;
    }
    for (int p = 0; p < 3; p++) // no pivoting: the matrix is positive definite
        for (int i = 0; i < 3; i++) {
            if (i == p) continue;
            const double factor = M[i][p] / M[p][p];
            for (int j = p; j < 4; j++) M[i][j] -= factor * M[p][j];
        }
    for (int i = 0; i < 3; i++) a[i] = M[i][3] / M[i][i];
}

// takes hK v+ off the force of one tool, and off all that is known of it
static void ease(sn_state *s, int t, const touch *at, const double hK[9], const double next[3]) {
    double less[3], r[3];
    for (int i = 0; i < 3; i++) {
        less[i] = hK[3 * i] * next[0] + hK[3 * i + 1] * next[1] + hK[3 * i + 2] * next[2];
        r[i] = at->x[i] - s->tool_pose[t].centre[i];
        const size_t place = 4 * (size_t)at->node + (size_t)i;
        sn_real_put(s->precision, s->now.f, place,
                    sn_real_at(s->precision, s->now.f, place) - less[i]);
        s->ext[3 * at->node + i] -= less[i];
        s->tool_force[t][i] += less[i];
    }
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, g = (d + 2) % 3;
        s->tool_torque[t][d] += r[e] * less[g] - r[g] * less[e];
    }
}

// adds the stiffness of tool t, where it touches contact node k, times h to hK
static bool touches(const sn_net *net, const sn_state *s, int t, int k, const touch *at, double h,
                    double hK[9]) {
    const sn_contact *contact = &s->contact[(size_t)t * (size_t)net->contact_count + (size_t)k];
    if (!contact->touching) return false;
    const sn_parts *parts = sn_state_parts(s);
    const double *stiffness = parts ? parts->contact_stiffness : net->contact_stiffness;
    add_stiffness(&net->tool[t], &s->tool_pose[t], contact, at->x, h * stiffness[k], hK);
    return true;
}

static void ease_node(const sn_net *net, sn_state *s, int k, double h) {
    touch at = {.node = net->contact_node[k]};
    double next[3];
    for (int d = 0; d < 3; d++) {
        const size_t place = 4 * (size_t)at.node + (size_t)d;
        at.x[d] = net->node_position[3 * at.node + d] + sn_real_at(s->precision, s->u, place);
        at.v[d] = sn_real_at(s->precision, s->v, place);
        at.f[d] = sn_real_at(s->precision, s->now.f, place);
    }
    for (int t = 0; t < net->tool_count; t++) touches(net, s, t, k, &at, h, at.hK);
    solve(net->mass[at.node], h, at.hK, net->fixed_bits[at.node], at.f, at.v, next);
    for (int d = 0; d < 3; d++) next[d] = at.v[d] + h * next[d];
    for (int t = 0; t < net->tool_count; t++) {
        double hK[9] = {0};
        if (touches(net, s, t, k, &at, h, hK)) ease(s, t, &at, hK, next);
    }
}

void sn_state_ease_contact(const sn_net *net, sn_state *s) {
    const double h = sn_state_touch_step(net, s);
    for (int k = 0; k < net->contact_count; k++) {
        bool any = false;
        for (int t = 0; t < net->tool_count; t++)
            any = any || s->contact[(size_t)t * (size_t)net->contact_count + (size_t)k].touching;
        if (any) ease_node(net, s, k, h);
    }
}
