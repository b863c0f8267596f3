// Checks of a case that no reader of one key can make.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"
#include "model/tool.h"

// a tool may start this deep in the body, of the body's size: rounding of coordinates
#define START_DEPTH 1e-6

static bool finite3(const double v[3]) {
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

//---- tissues -------------------------------------------------------------------------------------

static bool needs_density(const sn_case *c) {
    return norm3(c->gravity) > 0 || c->continuum.analysis == SN_ANALYSIS_DYNAMIC;
}

static sn_status check_tissue(const sn_case *c, const sn_tissue *tissue) {
    SN_TRY(sn_tissue_check(tissue));
    const sn_law *law = tissue->law;
    if (law->kind == SN_LAW_MEMBRANE)
        return sn_fail(SN_E_DEFINITION,
                       "law \"%s\" is for membranes: a body needs a solid law such as "
                       "demiray or neo-hookean",
                       law->name);
    if (law->kind == SN_LAW_UNIAXIAL && !isfinite(tissue->poissons_ratio))
        return sn_fail(SN_E_DEFINITION,
                       "the uniaxial law \"%s\" needs poissons_ratio in a "
                       "three-dimensional body: give it, or take a solid law",
                       law->name);
    if (law->fibres && c->fibres.rule == SN_FIBRES_ALIKE && !(norm3(c->fibre) > 0))
        return sn_fail(
            SN_E_DEFINITION,
            "law \"%s\" has fibres: give their direction under \"fibres\", such as [1, 0, 0]",
            law->name);
    if (needs_density(c) && isnan(tissue->density))
        return sn_fail(SN_E_DEFINITION, "no density: gravity and dynamic runs need one; "
                                        "give it in the tissue, such as \"density: 1060 kg/m3\"");
    return SN_OK;
}

static sn_status check_tissues(const sn_case *c) {
    if (!finite3(c->fibre) || !finite3(c->gravity))
        return sn_fail(SN_E_RANGE, "the fibre direction and gravity must be finite numbers");
    SN_TRY(sn_fibres_check(c));
    for (int r = 0; r < c->mesh->region_count; r++) {
        sn_status status = check_tissue(c, &c->tissue[r]);
        if (status != SN_OK)
            return sn_fail_within(status, "region \"%s\"", c->mesh->region_name[r]);
    }
    return SN_OK;
}

//---- supports and loads --------------------------------------------------------------------------

static sn_status check_surface(const sn_mesh *mesh, int surface, const char *what, int index) {
    if (surface < 0 || surface >= mesh->surface_count)
        return sn_fail(SN_E_DEFINITION, "%s %d is on surface %d, but the mesh has %d", what,
                       index + 1, surface, mesh->surface_count);
    if (mesh->surface[surface].face_count == 0)
        return sn_fail(SN_E_DEFINITION, "%s %d: surface \"%s\" has no faces", what, index + 1,
                       mesh->surface[surface].name);
    return SN_OK;
}

static sn_status check_point(const sn_case *c, const sn_load *load, int index) {
    int cell;
    double weight[4];
    if (load->kind != SN_LOAD_FORCE) return SN_OK;
    if (sn_mesh_locate(c->mesh, load->point, &cell, weight) == SN_OK) return SN_OK;
    return sn_fail_within(SN_E_DEFINITION, "load %d, a force", index + 1);
}

static sn_status check_loads(const sn_case *c) {
    for (int i = 0; i < c->support_count; i++) {
        const sn_support *s = &c->support[i];
        SN_TRY(check_surface(c->mesh, s->surface, "support", i));
        if (!s->fix[0] && !s->fix[1] && !s->fix[2])
            return sn_fail(SN_E_DEFINITION,
                           "support %d on \"%s\" fixes no direction: give \"fix: xyz\" or "
                           "some of the letters",
                           i + 1, c->mesh->surface[s->surface].name);
    }
    for (int i = 0; i < c->load_count; i++) {
        const sn_load *load = &c->load[i];
        const bool at_point = load->kind == SN_LOAD_FORCE;
        if (!at_point) SN_TRY(check_surface(c->mesh, load->surface, "load", i));
        const char *on = at_point ? "a point" : c->mesh->surface[load->surface].name;
        SN_TRY(check_point(c, load, i));
        if (!finite3(load->vector) || !isfinite(load->pressure))
            return sn_fail(SN_E_RANGE, "load %d on \"%s\" is not a finite number", i + 1, on);
        if (load->factor && load->factor->channels != 1)
            return sn_fail(SN_E_DEFINITION,
                           "load %d on \"%s\": its time table has %d columns of values, "
                           "1 expected",
                           i + 1, on, load->factor->channels);
        if (load->kind == SN_LOAD_DISPLACEMENT && load->free[0] && load->free[1] && load->free[2])
            return sn_fail(SN_E_DEFINITION,
                           "load %d on \"%s\": all three components are free; "
                           "prescribe one",
                           i + 1, on);
    }
    return SN_OK;
}

// One motion of a surface: a support or a displacement load.
typedef struct motion {
    int surface;
    bool holds[3];
    double vector[3];
    const sn_history *factor;
} motion;

static int gather_motions(const sn_case *c, motion *out) {
    int count = 0;
    for (int i = 0; i < c->support_count; i++, count++) {
        out[count] = (motion){.surface = c->support[i].surface};
        memcpy(out[count].holds, c->support[i].fix, sizeof out[count].holds);
    }
    for (int i = 0; i < c->load_count; i++) {
        const sn_load *load = &c->load[i];
        if (load->kind != SN_LOAD_DISPLACEMENT) continue;
        out[count] = (motion){.surface = load->surface, .factor = load->factor};
        memcpy(out[count].vector, load->vector, sizeof load->vector);
        for (int d = 0; d < 3; d++) out[count].holds[d] = !load->free[d];
        count++;
    }
    return count;
}

static double motion_at(const motion *m, int d, double t) {
    double factor;
    sn_history_at(m->factor, t, &factor);
    return m->vector[d] * factor;
}

// Whether two motions differ in direction d at a knot of either, beyond rounding; *t is where.
// Both are piecewise linear, so knots tell all.
static bool differ(const motion *a, const motion *b, int d, double *t) {
    const sn_history *history[2] = {a->factor, b->factor};
    double rounding = 1e-12 * fmax(fabs(a->vector[d]), fabs(b->vector[d]));
    for (int h = 0; h < 2; h++) {
        int knots = history[h] ? history[h]->count : 1;
        for (int k = 0; k < knots; k++) {
            *t = history[h] ? history[h]->time[k] : 0;
            if (fabs(motion_at(a, d, *t) - motion_at(b, d, *t)) > rounding) return true;
        }
    }
    return false;
}

// The first node of surface b that is marked as one of surface a; -1 when they do not touch.
static int shared_node(const sn_mesh *mesh, int a, int b, unsigned char *mark) {
    const sn_surface *s = &mesh->surface[a], *other = &mesh->surface[b];
    memset(mark, 0, (size_t)mesh->node_count);
    for (size_t i = 0; i < 3 * (size_t)s->face_count; i++) mark[s->face[i]] = 1;
    for (size_t i = 0; i < 3 * (size_t)other->face_count; i++)
        if (mark[other->face[i]]) return other->face[i];
    return -1;
}

static sn_status check_pair(const sn_mesh *mesh, const motion *a, const motion *b,
                            unsigned char *mark) {
    for (int d = 0; d < 3; d++) {
        double t;
        if (!a->holds[d] || !b->holds[d] || !differ(a, b, d, &t)) continue;
        int node = shared_node(mesh, a->surface, b->surface, mark);
        if (node < 0) return SN_OK;
        const double *x = mesh->node + 3 * (size_t)node;
        return sn_fail(
            SN_E_DEFINITION,
            "\"%s\" and \"%s\" share node %d at (%g, %g, %g) m, where one prescribes %g m along "
            "%c and the other %g m (at %g s): free that direction on one of them",
            mesh->surface[a->surface].name, mesh->surface[b->surface].name, node, x[0], x[1], x[2],
            motion_at(a, d, t), "xyz"[d], motion_at(b, d, t), t);
    }
    return SN_OK;
}

static sn_status check_contradictions(const sn_case *c) {
    sn_status status = SN_E_MEMORY;
    motion *m = sn_alloc((size_t)(c->support_count + c->load_count), sizeof *m);
    unsigned char *mark = sn_alloc((size_t)c->mesh->node_count, 1);
    if (!m || !mark) goto fail;
    int count = gather_motions(c, m);
    for (int a = 0; a < count; a++)
        for (int b = a + 1; b < count; b++)
            SN_TRY_GOTO(status, check_pair(c->mesh, &m[a], &m[b], mark));
    status = SN_OK;
fail:
    sn_free(m);
    sn_free(mark);
    return status;
}

//---- probes and tools ----------------------------------------------------------------------------

// Probes and tools share the columns of the history, so that their names must all differ.
static sn_status check_names(const sn_case *c) {
    int count = c->probe_count + c->tool_count;
    for (int a = 0; a < count; a++) {
        const char *name = a < c->probe_count ? c->probe[a].name : c->tool[a - c->probe_count].name;
        if (!name[0]) return sn_fail(SN_E_DEFINITION, "a probe or tool has no name: give it one");
        if (strlen(name) > SN_NAME_MAX - 4)
            return sn_fail(SN_E_DEFINITION, "the name \"%s\" is too long: at most %d bytes", name,
                           SN_NAME_MAX - 4);
        for (int b = 0; b < a; b++)
            if (!strcmp(name,
                        b < c->probe_count ? c->probe[b].name : c->tool[b - c->probe_count].name))
                return sn_fail(SN_E_DEFINITION, "two probes or tools are named \"%s\": rename one",
                               name);
    }
    return SN_OK;
}

static sn_status check_probes(const sn_case *c) {
    for (int i = 0; i < c->probe_count; i++) {
        const sn_probe *p = &c->probe[i];
        int cell;
        double weight[4];
        sn_status status = p->kind == SN_PROBE_POINT
                               ? sn_mesh_locate(c->mesh, p->point, &cell, weight)
                               : check_surface(c->mesh, p->surface, "reaction", i);
        if (status != SN_OK) return sn_fail_within(status, "probe \"%s\"", p->name);
    }
    return SN_OK;
}

// The deepest boundary node in a tool: how deep, and the outward direction of the boundary there.
static double deepest_node(const sn_mesh *mesh, const sn_tool *tool, const sn_pose *pose, int *node,
                           double outwards[3]) {
    const sn_surface *s = &mesh->surface[sn_mesh_surface(mesh, "boundary")];
    double deepest = -(double)INFINITY;
    *node = s->face[0];
    for (size_t i = 0; i < 3 * (size_t)s->face_count; i++) {
        double depth = sn_tool_depth(tool, pose, mesh->node + 3 * (size_t)s->face[i], NULL);
        if (!(depth > deepest)) continue;
        deepest = depth;
        *node = s->face[i];
    }
    memset(outwards, 0, 3 * sizeof *outwards);
    for (int f = 0; f < s->face_count; f++) {
        const int *v = s->face + 3 * (size_t)f;
        if (v[0] != *node && v[1] != *node && v[2] != *node) continue;
        double normal[3];
        sn_triangle_normal(mesh, v, normal);
        for (int d = 0; d < 3; d++) outwards[d] += normal[d];
    }
    double length = norm3(outwards);
    for (int d = 0; d < 3; d++) outwards[d] /= length;
    return deepest;
}

// Whether a tool that no node has entered stands in the body all the same: points of its own that
// are inside, by which a small tool is found between the nodes of a coarse surface.
static bool has_point_inside(const sn_mesh *mesh, const sn_tool *tool, const sn_pose *pose) {
    int cell, corners = 0;
    double weight[4], at[3];
    if (tool->kind == SN_TOOL_PLANE) return false;
    if (tool->kind != SN_TOOL_MESH && sn_mesh_find_point(mesh, pose->centre, &cell, weight))
        return true;
    if (tool->kind == SN_TOOL_CAPSULE) {
        times3(pose->turn, tool->axis, at);
        for (int d = 0; d < 3; d++) at[d] += pose->centre[d];
        return sn_mesh_find_point(mesh, at, &cell, weight);
    }
    const double *corner = tool->surface ? sn_tool_surface_corners(tool->surface, &corners) : NULL;
    for (int k = 0; k < corners; k++) {
        times3(pose->turn, corner + 3 * (size_t)k, at);
        for (int d = 0; d < 3; d++) at[d] += pose->centre[d];
        if (sn_mesh_find_point(mesh, at, &cell, weight)) return true;
    }
    return false;
}

static sn_status check_tool_start(const sn_mesh *mesh, const sn_tool *tool) {
    double outwards[3];
    int node;
    sn_pose pose;
    sn_tool_pose(tool, 0, &pose);
    double depth = deepest_node(mesh, tool, &pose, &node, outwards);
    bool inside = has_point_inside(mesh, tool, &pose);
    if (depth <= START_DEPTH * sn_mesh_size(mesh) && !inside) return SN_OK;

    const double *x = mesh->node + 3 * (size_t)node, *at = pose.centre;
    if (tool->kind != SN_TOOL_SPHERE)
        return sn_fail(
            SN_E_DEFINITION,
            "tool \"%s\" starts inside the body, near node %d at (%g, %g, %g) m: move it "
            "out along (%.2g, %.2g, %.2g)%s",
            tool->name, node, x[0], x[1], x[2], outwards[0], outwards[1], outwards[2],
            tool->kind == SN_TOOL_PLANE ? ", or turn its normal round" : "");
    // from the node on, the centre must stand a radius away along the outward direction
    double free[3];
    for (int d = 0; d < 3; d++) free[d] = x[d] + tool->radius * outwards[d];
    return sn_fail(
        SN_E_DEFINITION,
        "tool \"%s\" starts inside the body, %.3g m deep at node %d at (%g, %g, %g) m: move "
        "its centre from (%g, %g, %g) m to (%g, %g, %g) m or beyond",
        tool->name, inside ? 2 * tool->radius - depth : depth, node, x[0], x[1], x[2], at[0], at[1],
        at[2], free[0], free[1], free[2]);
}

static sn_status check_tool_shape(const sn_tool *tool) {
    bool round = tool->kind == SN_TOOL_SPHERE || tool->kind == SN_TOOL_CAPSULE;
    if ((round && !(tool->radius > 0)) || !isfinite(tool->radius) || !finite3(tool->at))
        return sn_fail(SN_E_RANGE,
                       "tool \"%s\": radius %g m must be positive, and its place finite",
                       tool->name, tool->radius);
    if (!finite3(tool->axis) || (tool->kind == SN_TOOL_PLANE && !(norm3(tool->axis) > 0)))
        return sn_fail(SN_E_RANGE, "tool \"%s\": the direction (%g, %g, %g) must be finite%s",
                       tool->name, tool->axis[0], tool->axis[1], tool->axis[2],
                       tool->kind == SN_TOOL_PLANE ? " and have a length" : "");
    if (tool->kind == SN_TOOL_MESH && !tool->surface)
        return sn_fail(SN_E_DEFINITION, "tool \"%s\": no surface", tool->name);
    return SN_OK;
}

static sn_status check_tools(const sn_case *c) {
    for (int i = 0; i < c->tool_count; i++) {
        const sn_tool *tool = &c->tool[i];
        SN_TRY(check_tool_shape(tool));
        if (!(tool->friction >= 0) || !isfinite(tool->friction))
            return sn_fail(SN_E_RANGE, "tool \"%s\": friction %g must be 0 or more", tool->name,
                           tool->friction);
        if (tool->path && tool->path->channels != 3)
            return sn_fail(SN_E_DEFINITION,
                           "tool \"%s\": its path has %d columns of values, 3 expected", tool->name,
                           tool->path->channels);
        if (tool->turn && tool->turn->channels != 3)
            return sn_fail(SN_E_DEFINITION,
                           "tool \"%s\": its turn has %d columns of values, 3 expected", tool->name,
                           tool->turn->channels);
        SN_TRY(check_tool_start(c->mesh, tool));
    }
    return SN_OK;
}

//---- cuts ----------------------------------------------------------------------------------------

static sn_status check_cut_shape(const sn_case *c, const sn_cut_def *cut, int index) {
    const double *low = cut->low, *high = cut->high;
    if (!(cut->at >= 0 && cut->at <= c->until))
        return sn_fail(SN_E_RANGE, "cut %d is at %g s: 0 s to the end of the run, %g s, expected",
                       index + 1, cut->at, c->until);
    if (cut->kind == SN_CUT_SPHERE &&
        (!(cut->radius > 0) || !isfinite(cut->radius) || !finite3(cut->centre)))
        return sn_fail(SN_E_RANGE,
                       "cut %d: radius %g m must be positive, and the centre of the sphere finite",
                       index + 1, cut->radius);
    if (cut->kind == SN_CUT_BOX && (!finite3(low) || !finite3(high) || !(low[0] < high[0]) ||
                                    !(low[1] < high[1]) || !(low[2] < high[2])))
        return sn_fail(SN_E_RANGE,
                       "cut %d: the box from (%g, %g, %g) m to (%g, %g, %g) m must rise in every "
                       "direction",
                       index + 1, low[0], low[1], low[2], high[0], high[1], high[2]);
    for (int k = 0; cut->kind == SN_CUT_CELLS && k < cut->cell_count; k++)
        if (cut->cell[k] < 0 || cut->cell[k] >= c->mesh->cell_count)
            return sn_fail(SN_E_RANGE, "cut %d: no cell %d: the mesh has cells 0 to %d", index + 1,
                           cut->cell[k], c->mesh->cell_count - 1);
    return SN_OK;
}

static sn_status check_cuts(const sn_case *c) {
    for (int i = 0; i < c->cut_count; i++) {
        int *cells = NULL, count;
        SN_TRY(check_cut_shape(c, &c->cut[i], i));
        SN_TRY(sn_case_cut_cells(c, i, &cells, &count));
        sn_free(cells);
        if (count == 0)
            return sn_fail(SN_E_DEFINITION,
                           "cut %d hits no cell: it takes cells whose centre at rest is inside; "
                           "make it larger, or look where the body is",
                           i + 1);
    }
    return SN_OK;
}

//---- settings ------------------------------------------------------------------------------------

static sn_status check_positive(const char *what, const char *unit, double value) {
    if (value > 0 && isfinite(value)) return SN_OK;
    return sn_fail(SN_E_RANGE, "%s is %g%s%s: it must be positive", what, value, unit[0] ? " " : "",
                   unit);
}

static sn_status check_settings(const sn_case *c) {
    SN_TRY(check_positive("time: until", "s", c->until));
    SN_TRY(check_positive("time: output_every", "s", c->output_every));
    SN_TRY(check_positive("springs: memory_tolerance", "", c->springs.memory_tolerance));
    if (!(c->springs.tolerance >= 0 && c->springs.tolerance < 1))
        return sn_fail(SN_E_RANGE,
                       "springs: tolerance is %g: less than 1 expected, or 0 for that of the "
                       "integrator",
                       c->springs.tolerance);
    SN_TRY(check_positive("springs: threads", "", c->springs.threads));
    if (!(c->springs.step >= 0) || !isfinite(c->springs.step))
        return sn_fail(SN_E_RANGE, "springs: step is %g s: positive expected, or auto",
                       c->springs.step);
    if (!(c->springs.damping >= 0) || !isfinite(c->springs.damping))
        return sn_fail(SN_E_RANGE, "springs: damping is %g 1/s: 0 or more expected",
                       c->springs.damping);
    if (!(c->springs.stiffness_damping >= 0) || !isfinite(c->springs.stiffness_damping))
        return sn_fail(SN_E_RANGE, "springs: stiffness damping is %g s: 0 or more expected",
                       c->springs.stiffness_damping);
    SN_TRY(check_positive("continuum: steps", "", c->continuum.steps));
    SN_TRY(check_positive("continuum: tolerance", "", c->continuum.tolerance));
    return check_positive("continuum: memory_tolerance", "", c->continuum.memory_tolerance);
}

sn_status sn_case_check(const sn_case *c) {
    if (!c->mesh || !c->tissue)
        return sn_fail(SN_E_DEFINITION, "the case has no %s", c->mesh ? "tissue" : "mesh");
    if (sn_mesh_surface(c->mesh, "boundary") < 0)
        return sn_fail_within(SN_E_DEFINITION, "the mesh was not finished");
    SN_TRY(check_settings(c));
    SN_TRY(check_tissues(c));
    SN_TRY(check_loads(c));
    SN_TRY(check_contradictions(c));
    SN_TRY(check_names(c));
    SN_TRY(check_probes(c));
    if (c->springs_given) SN_TRY(sn_spring_set_check(c->springs_given, c->mesh));
    SN_TRY(check_tools(c));
    return check_cuts(c);
}
