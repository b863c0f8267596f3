// Rigid tools of a case file.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "io/case_file.h"

static const char *const shapes[] = {"sphere", "capsule", "plane", "mesh"}; // as sn_tool_kind

static sn_status read_radius(const sn_yaml *node, double *radius) {
    SN_TRY(sn_yaml_quantity(node, "m", radius));
    return *radius > 0.0 ? SN_OK : sn_yaml_expected(node, SN_E_RANGE, "a radius of more than 0");
}

// {radius: 2 mm, axis: [0 mm, 0 mm, 30 mm]}
static sn_status read_capsule(const sn_yaml *map, sn_tool *tool) {
    static const char *const keys[] = {"radius", "axis"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(map, keys, 2));
    SN_TRY(sn_yaml_need(map, "radius", &node));
    SN_TRY(read_radius(node, &tool->radius));
    SN_TRY(sn_yaml_need(map, "axis", &node));
    return sn_yaml_quantities(node, "m", 3, tool->axis);
}

// {file: jaw.stl, unit: mm}
static sn_status read_mesh(const sn_yaml *map, sn_tool *tool) {
    static const char *const keys[] = {"file", "unit"};
    const sn_yaml *file, *unit;
    const char *name;
    char *path;
    double factor;
    SN_TRY(sn_yaml_map(map, keys, 2));
    SN_TRY(sn_yaml_need(map, "file", &file));
    SN_TRY(sn_yaml_need(map, "unit", &unit)); // an STL file has none
    SN_TRY(sn_case_read_unit(map, &factor));
    SN_TRY(sn_yaml_text(file, "the path of an STL file", &name));
    SN_TRY(sn_case_join_path(file, name, &path));
    sn_status status = sn_tool_surface_read_stl(path, factor, &tool->surface);
    sn_free(path);
    return sn_yaml_within(file, status);
}

static sn_status read_shape(const sn_yaml *map, sn_tool *tool) {
    const sn_yaml *shape = NULL;
    for (int k = 0; k < 4; k++) {
        const sn_yaml *found = sn_yaml_get(map, shapes[k]);
        if (!found) continue;
        if (shape)
            return sn_yaml_fail(found, SN_E_KEY,
                                "expected one shape of a tool, \"%s\" is given too", shape->key);
        shape = found;
        tool->kind = (sn_tool_kind)k;
    }
    if (!shape)
        return sn_yaml_fail(map, SN_E_KEY,
                            "no shape of the tool, expected one of sphere, capsule, plane, mesh");
    switch (tool->kind) {
    case SN_TOOL_SPHERE: return read_radius(shape, &tool->radius);
    case SN_TOOL_CAPSULE: return read_capsule(shape, tool);
    case SN_TOOL_PLANE: return sn_yaml_quantities(shape, "1", 3, tool->axis);
    case SN_TOOL_MESH: return read_mesh(shape, tool);
    }
    return SN_OK;
}

static sn_status read_tool(const sn_yaml *map, const sn_case *c, sn_tool *tool) {
    static const char *const keys[] = {"name", "sphere", "capsule", "plane",    "mesh",
                                       "at",   "path",   "turn",    "friction", "grasp"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(map, keys, 10));
    SN_TRY(sn_case_read_name(map, c, tool->name));
    SN_TRY(read_shape(map, tool));
    SN_TRY(sn_yaml_need(map, "at", &node));
    SN_TRY(sn_yaml_quantities(node, "m", 3, tool->at));
    if ((node = sn_yaml_get(map, "path")))
        SN_TRY(sn_case_read_table(
            node, 3, "m", "rows [time, x, y, z] such as [1 s, 0 mm, 0 mm, -5 mm]", &tool->path));
    if ((node = sn_yaml_get(map, "turn")))
        SN_TRY(sn_case_read_table(node, 3, "rad",
                                  "rows [time, about x, about y, about z] such as "
                                  "[1 s, 0 deg, 0 deg, 30 deg]",
                                  &tool->turn));
    if ((node = sn_yaml_get(map, "grasp"))) {
        SN_TRY(sn_yaml_quantities(node, "s", 2, tool->grasp));
        if (!(tool->grasp[0] >= 0.0 && tool->grasp[1] > tool->grasp[0]))
            return sn_yaml_expected(node, SN_E_RANGE,
                                    "two rising times such as [1 s, 2 s], from 0 s on");
    }
    if (!(node = sn_yaml_get(map, "friction"))) return SN_OK;
    SN_TRY(sn_yaml_quantity(node, "1", &tool->friction));
    if (tool->friction >= 0.0) return SN_OK;
    return sn_yaml_expected(node, SN_E_RANGE, "a coefficient of 0 or more");
}

sn_status sn_case_read_tools(const sn_yaml *node, sn_case *c) {
    void *items = NULL;
    SN_TRY(sn_case_read_items(node,
                              "tools such as {name: probe, sphere: 5 mm, at: [0 mm, 0 mm, 9 mm]}",
                              sizeof *c->tool, &items));
    c->tool = items;
    for (const sn_yaml *item = node->first; item; item = item->next) {
        // counted before it is read, so that a half read one is released; it has no name yet
        SN_TRY(read_tool(item, c, &c->tool[c->tool_count++]));
    }
    return SN_OK;
}
