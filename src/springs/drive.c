// What moves a net: supports, prescribed motion, tractions, pressures, tools; and its probes.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/state.h"

//---- building ------------------------------------------------------------------------------------

// what prescribes each direction: 0 nothing, 1 a support, 2 + k displacement load k; the last wins,
// as in sn_case_prescribed()
static void mark(const sn_surface *surface, int direction, int by, int *owner) {
    for (int i = 0; i < 3 * surface->face_count; i++) owner[3 * surface->face[i] + direction] = by;
}

static sn_status build_fixed(const sn_case *c, sn_net *net) {
    int *owner = sn_alloc((size_t)net->nodes * 3, sizeof *owner), count = 0;
    net->factor = sn_alloc((size_t)c->load_count, sizeof *net->factor);
    net->fixed_bits = sn_alloc((size_t)net->nodes, sizeof *net->fixed_bits);
    if (!owner || !net->factor || !net->fixed_bits) goto memory;
    for (int s = 0; s < c->support_count; s++)
        for (int d = 0; d < 3; d++)
            if (c->support[s].fix[d]) mark(&c->mesh->surface[c->support[s].surface], d, 1, owner);
    net->factor_count = c->load_count;
    for (int l = 0; l < c->load_count; l++) {
        const sn_load *load = &c->load[l];
        if (load->kind != SN_LOAD_DISPLACEMENT) continue;
        if (sn_history_copy(load->factor, &net->factor[l]) != SN_OK) goto memory;
        for (int d = 0; d < 3; d++)
            if (!load->free[d]) mark(&c->mesh->surface[load->surface], d, 2 + l, owner);
    }
    for (int k = 0; k < 3 * net->nodes; k++) count += owner[k] != 0;
    net->fixed = sn_alloc((size_t)count, sizeof *net->fixed);
    if (!net->fixed) goto memory;
    for (int k = 0; k < 3 * net->nodes; k++) {
        if (!owner[k]) continue;
        int load = owner[k] - 2;
        net->fixed[net->fixed_count++] =
            (sn_net_fixed){k / 3, k % 3, load, load < 0 ? 0.0 : c->load[load].vector[k % 3]};
        net->fixed_bits[k / 3] = (unsigned char)(net->fixed_bits[k / 3] | 1u << (unsigned)(k % 3));
    }
    sn_free(owner);
    return SN_OK;
memory:
    sn_free(owner);
    return SN_E_MEMORY;
}

static double face_area(const double *a, const double *b, const double *c) {
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2];
    double z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

// a third of the area of a surface's faces at each of their nodes (nodes of the net)
static void lump_area(const sn_mesh *mesh, int surface, double *area) {
    const sn_surface *s = &mesh->surface[surface];
    for (int f = 0; f < s->face_count; f++) {
        const int *n = s->face + 3 * f;
        double third =
            face_area(mesh->node + 3 * n[0], mesh->node + 3 * n[1], mesh->node + 3 * n[2]) / 3.0;
        for (int k = 0; k < 3; k++) area[n[k]] += third;
    }
}

static sn_status build_traction(const sn_case *c, const sn_load *load, double *area,
                                sn_net_load *out) {
    const int nodes = c->mesh->node_count;
    memset(area, 0, (size_t)nodes * sizeof *area);
    lump_area(c->mesh, load->surface, area);
    for (int i = 0; i < nodes; i++) out->count += area[i] > 0;
    out->node = sn_alloc((size_t)out->count, sizeof *out->node);
    out->force = sn_alloc((size_t)out->count * 3, sizeof *out->force);
    if (!out->node || !out->force) return SN_E_MEMORY;
    for (int i = 0, k = 0; i < nodes; i++) {
        if (!(area[i] > 0)) continue;
        out->node[k] = i;
        for (int d = 0; d < 3; d++) out->force[3 * k + d] = area[i] * load->vector[d];
        k++;
    }
    return SN_OK;
}

static sn_status build_force(const sn_case *c, const sn_load *load, sn_net_load *out) {
    int cell;
    double weight[4];
    SN_TRY(sn_mesh_locate(c->mesh, load->point, &cell, weight));
    out->count = 4;
    out->node = sn_alloc(4, sizeof *out->node);
    out->force = sn_alloc(12, sizeof *out->force);
    if (!out->node || !out->force) return SN_E_MEMORY;
    for (int a = 0; a < 4; a++) {
        out->node[a] = c->mesh->cell[4 * cell + a];
        for (int d = 0; d < 3; d++) out->force[3 * a + d] = weight[a] * load->vector[d];
    }
    return SN_OK;
}

static sn_status build_loads(const sn_case *c, sn_net *net, double *area) {
    net->load = sn_alloc((size_t)c->load_count, sizeof *net->load);
    if (!net->load) return SN_E_MEMORY;
    for (int l = 0; l < c->load_count; l++) {
        const sn_load *load = &c->load[l];
        if (load->kind == SN_LOAD_DISPLACEMENT) continue;
        sn_net_load *out = &net->load[net->load_count++];
        out->name = l;
        out->kind = load->kind;
        out->pressure = load->pressure;
        SN_TRY(sn_history_copy(load->factor, &out->factor));
        if (load->kind == SN_LOAD_TRACTION) {
            SN_TRY(build_traction(c, load, area, out));
            continue;
        }
        if (load->kind == SN_LOAD_FORCE) {
            SN_TRY(build_force(c, load, out));
            continue;
        }
        const sn_surface *s = &c->mesh->surface[load->surface];
        out->count = s->face_count;
        out->node = sn_alloc((size_t)s->face_count * 3, sizeof *out->node);
        if (!out->node) return SN_E_MEMORY;
        memcpy(out->node, s->face, (size_t)s->face_count * 3 * sizeof *out->node);
    }
    return SN_OK;
}

static sn_status build_tools(const sn_case *c, sn_net *net, double *area) {
    if (c->tool_count == 0) return SN_OK;
    net->tool = sn_alloc((size_t)c->tool_count, sizeof *net->tool);
    if (!net->tool) return SN_E_MEMORY;
    for (int t = 0; t < c->tool_count; t++) {
        SN_TRY(sn_tool_copy(&c->tool[t], &net->tool[t]));
        net->tool_count = t + 1;
    }
    int boundary = sn_mesh_surface(c->mesh, "boundary");
    if (boundary < 0) return SN_E_NAME;
    memset(area, 0, (size_t)net->nodes * sizeof *area);
    lump_area(c->mesh, boundary, area);
    for (int i = 0; i < net->nodes; i++) net->skin_count += area[i] > 0;
    net->contact_count = net->cuttable ? net->nodes : net->skin_count;
    net->contact_node = sn_alloc((size_t)net->contact_count, sizeof *net->contact_node);
    net->contact_stiffness = sn_alloc((size_t)net->contact_count, sizeof(double));
    if (!net->contact_node || !net->contact_stiffness) return SN_E_MEMORY;
    double penalty = sn_case_penalty(c);
    for (int i = 0, k = 0, inner = net->skin_count; i < net->nodes; i++) {
        if (!(area[i] > 0) && !net->cuttable) continue;
        const int place = area[i] > 0 ? k++ : inner++;
        net->contact_node[place] = i;
        net->contact_stiffness[place] = penalty * area[i];
    }
    return SN_OK;
}

// nodes that loads and tools can push, each once
static sn_status list_loaded(sn_net *net) {
    unsigned char *on = sn_alloc((size_t)net->nodes, 1);
    if (!on) return SN_E_MEMORY;
    for (int l = 0; l < net->load_count; l++) {
        const sn_net_load *load = &net->load[l];
        int n = load->kind == SN_LOAD_PRESSURE ? 3 * load->count : load->count;
        for (int k = 0; k < n; k++) on[load->node[k]] = 1;
    }
    for (int k = 0; k < net->skin_count; k++) on[net->contact_node[k]] = 1;
    for (int i = 0; i < net->nodes; i++) net->loaded_count += on[i];
    net->loaded_all = net->contact_count > net->skin_count ? net->nodes : net->loaded_count;
    net->loaded = sn_alloc((size_t)net->loaded_all, sizeof *net->loaded);
    if (net->loaded)
        for (int i = 0, k = 0, inner = net->loaded_count; i < net->nodes; i++) {
            if (on[i])
                net->loaded[k++] = i;
            else if (inner < net->loaded_all)
                net->loaded[inner++] = i;
        }
    sn_free(on);
    return net->loaded ? SN_OK : SN_E_MEMORY;
}

static sn_status build_reaction(const sn_case *c, sn_net *net, int surface, sn_net_probe *out) {
    unsigned char *on = sn_alloc((size_t)net->nodes, 1);
    if (!on) return SN_E_MEMORY;
    const sn_surface *s = &c->mesh->surface[surface];
    for (int k = 0; k < 3 * s->face_count; k++) on[s->face[k]] = 1;
    for (int k = 0; k < net->fixed_count; k++) out->count += on[net->fixed[k].node];
    out->fixed = sn_alloc((size_t)out->count, sizeof *out->fixed);
    if (out->fixed)
        for (int k = 0, n = 0; k < net->fixed_count; k++)
            if (on[net->fixed[k].node]) out->fixed[n++] = k;
    sn_free(on);
    return out->fixed ? SN_OK : SN_E_MEMORY;
}

static sn_status build_probes(const sn_case *c, sn_net *net) {
    net->probe = sn_alloc((size_t)c->probe_count, sizeof *net->probe);
    if (!net->probe) return SN_E_MEMORY;
    for (int p = 0; p < c->probe_count; p++) {
        sn_net_probe *out = &net->probe[p];
        net->probe_count = p + 1;
        out->kind = c->probe[p].kind;
        if (out->kind == SN_PROBE_REACTION) {
            SN_TRY(build_reaction(c, net, c->probe[p].surface, out));
            continue;
        }
        int cell;
        SN_TRY(sn_mesh_locate(c->mesh, c->probe[p].point, &cell, out->weight));
        memcpy(out->node, c->mesh->cell + 4 * cell, sizeof out->node);
    }
    return SN_OK;
}

sn_status sn_net_build_drive(const sn_case *c, sn_net *net) {
    SN_TRY(build_fixed(c, net));
    double *area = sn_alloc((size_t)net->nodes, sizeof *area);
    if (!area) return SN_E_MEMORY;
    sn_status status;
    SN_TRY_GOTO(status, build_loads(c, net, area));
    SN_TRY_GOTO(status, build_tools(c, net, area));
    SN_TRY_GOTO(status, list_loaded(net));
    SN_TRY_GOTO(status, build_probes(c, net));
fail:
    sn_free(area);
    return status;
}

//---- using ---------------------------------------------------------------------------------------

double sn_net_prescribed(const sn_net *net, const sn_net_fixed *fixed, double t) {
    if (fixed->load < 0) return 0.0;
    double factor;
    sn_history_at(net->factor[fixed->load], t, &factor);
    return factor * fixed->value;
}

double sn_net_next_corner(const sn_net *net, double t) {
    double next = INFINITY;
    for (int l = 0; l < net->factor_count; l++)
        next = fmin(next, sn_history_next(net->factor[l], t));
    for (int l = 0; l < net->load_count; l++)
        next = fmin(next, sn_history_next(net->load[l].factor, t));
    for (int k = 0; k < net->tool_count; k++)
        next = fmin(next, fmin(sn_history_next(net->tool[k].path, t),
                               sn_history_next(net->tool[k].turn, t)));
    for (int k = 0; k < net->tool_count; k++)
        for (int e = 0; e < 2; e++)
            if (net->tool[k].grasp[e] > t) next = fmin(next, net->tool[k].grasp[e]);
    return fmin(next, sn_cutting_next(net, t));
}

static bool factor_changes(const sn_history *factor, double from, double to) {
    double a, b;
    sn_history_at(factor, from, &a);
    sn_history_at(factor, to, &b);
    return a != b;
}

bool sn_net_changes(const sn_net *net, double from, double to) {
    bool changes = false;
    for (int l = 0; l < net->factor_count; l++)
        changes = changes || factor_changes(net->factor[l], from, to);
    for (int l = 0; l < net->load_count; l++)
        changes = changes || factor_changes(net->load[l].factor, from, to);
    for (int k = 0; k < net->tool_count; k++) {
        sn_pose a, b;
        sn_tool_pose(&net->tool[k], from, &a);
        sn_tool_pose(&net->tool[k], to, &b);
        changes = changes || memcmp(&a, &b, sizeof a) != 0;
    }
    return changes;
}

static void position(const sn_net *net, sn_precision precision, const void *u, int node,
                     double x[3]) {
    for (int d = 0; d < 3; d++)
        x[d] = net->node_position[3 * node + d] +
               sn_real_at(precision, u, 4 * (size_t)node + (size_t)d);
}

void sn_net_clear_ext(const sn_net *net, const sn_parts *parts, double *ext) {
    for (int k = 0; k < sn_net_loaded(net, parts); k++)
        memset(ext + 3 * net->loaded[k], 0, 3 * sizeof *ext);
}

// a third of the force of a pressure on a deformed face at each of its nodes
static void push_face(double x[3][3], double pressure, double force[3]) {
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = x[1][k] - x[0][k];
        v[k] = x[2][k] - x[0][k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        force[k] = -pressure / 6.0 * (u[i] * v[j] - u[j] * v[i]);
    }
}

void sn_net_add_load(const sn_net *net, int load, double factor, const sn_load_call *call,
                     double *ext) {
    const sn_net_load *l = &net->load[load];
    if (l->kind != SN_LOAD_PRESSURE) {
        const double *part = call->parts ? call->parts->load_force[load] : l->force;
        for (int k = 0; k < l->count; k++)
            for (int d = 0; d < 3; d++) ext[3 * l->node[k] + d] += factor * part[3 * k + d];
        return;
    }
    for (int f = 0; f < l->count; f++) {
        const int *node = l->node + 3 * f;
        double x[3][3], force[3];
        if (call->parts && call->parts->load_gone[load][f]) continue;
        for (int k = 0; k < 3; k++) position(net, call->precision, call->u, node[k], x[k]);
        push_face(x, factor * l->pressure, force);
        if (call->tangent) sn_tangent_add_pressure(call->tangent, node, x, factor * l->pressure);
        for (int k = 0; k < 3; k++)
            for (int d = 0; d < 3; d++) ext[3 * node[k] + d] += force[d];
    }
}

void sn_net_loads(const sn_net *net, double t, double part, const sn_load_call *call, double *ext) {
    for (int l = 0; l < net->load_count; l++) {
        double factor;
        sn_history_at(net->load[l].factor, t, &factor);
        sn_net_add_load(net, l, part * factor, call, ext);
    }
}

bool sn_net_contact(const sn_net *net, const sn_contact_call *call) {
    const double *stiffness = call->parts ? call->parts->contact_stiffness : net->contact_stiffness;
    const int count = call->parts ? net->contact_count : net->skin_count;
    bool any = false;
    for (int t = 0; t < net->tool_count; t++) {
        const sn_pose *pose = &call->pose[t];
        const double near = sn_tool_reach(&net->tool[t]);
        double *sum = call->tool_force[t], torque[3] = {0};
        sum[0] = sum[1] = sum[2] = 0.0;
        for (int k = 0; k < count; k++) {
            const int node = net->contact_node[k];
            const size_t at = (size_t)t * (size_t)net->contact_count + (size_t)k;
            double x[3], force[3], tangent[9], r[3];
            position(net, call->precision, call->u, node, x);
            for (int d = 0; d < 3; d++) r[d] = x[d] - pose->centre[d];
            const bool far = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] >= near * near;
            if (far || !(stiffness[k] > 0) || (call->grip && call->grip[node].tool >= 0)) {
                call->after[at] = (sn_contact){0};
                continue;
            }
            if (!sn_tool_contact(&net->tool[t], pose, x, stiffness[k], &call->before[at],
                                 &call->after[at], force, call->tangent ? tangent : NULL))
                continue;
            any = true;
            for (int d = 0; d < 3; d++) {
                call->ext[3 * node + d] += force[d];
                sum[d] -= force[d]; // of the tissue on the tool
                int e = (d + 1) % 3, g = (d + 2) % 3;
                torque[d] -= r[e] * force[g] - r[g] * force[e];
            }
            if (call->tangent) call->tangent(call->context, node, tangent);
        }
        if (call->tool_torque) memcpy(call->tool_torque[t], torque, sizeof torque);
    }
    return any;
}

void sn_net_tool_pose(const sn_net *net, const sn_state *state, int tool, double t, sn_pose *pose) {
    if (state && state->tool_set[tool])
        *pose = state->tool_pose[tool];
    else
        sn_tool_pose(&net->tool[tool], t, pose);
}
