// The body of a case file: its mesh and the tissues of its regions.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "io/case_file.h"
#include "io/text.h"

enum { NAMES_SHOWN = 64 };

sn_status sn_case_join_path(const sn_yaml *node, const char *name, char **joined) {
    const char *slash = strrchr(node->file, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - node->file) + 1 : 0;
    char *path = sn_alloc(folder + strlen(name) + 1, 1);
    if (!path) return SN_E_MEMORY;
    memcpy(path, node->file, folder);
    strcpy(path + folder, name);
    *joined = path;
    return SN_OK;
}

//---- mesh ----------------------------------------------------------------------------------------

static const char *const pattern_names[] = {"mirrored", "bcc", "kuhn"}; // as enum sn_pattern

static sn_status read_pattern(const sn_yaml *node, sn_shape_def *def) {
    int index;
    SN_TRY(sn_yaml_choice(node, pattern_names, 3, &index));
    def->pattern = (sn_pattern)index;
    return SN_OK;
}

static sn_status read_length(const sn_yaml *map, const char *key, double *value) {
    const sn_yaml *node;
    SN_TRY(sn_yaml_need(map, key, &node));
    SN_TRY(sn_yaml_quantity(node, "m", value));
    if (*value > 0.0) return SN_OK;
    return sn_yaml_expected(node, SN_E_RANGE, "a length of more than 0");
}

static sn_status read_cells(const sn_yaml *map, const char *what, int cells[3]) {
    const sn_yaml *node;
    SN_TRY(sn_yaml_need(map, "cells", &node));
    if (node->kind != SN_YAML_LIST || node->count != 3)
        return sn_yaml_fail(node, SN_E_SYNTAX, "expected a list of 3 whole numbers %s", what);
    for (const sn_yaml *item = node->first; item; item = item->next)
        SN_TRY(sn_yaml_int(item, 1, SN_CELLS_MAX, &cells[item->index]));
    return SN_OK;
}

// {towards: [x, y, z], ratio: 4}
static sn_status read_grade(const sn_yaml *map, sn_shape_def *def) {
    static const char *const keys[] = {"towards", "ratio"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(map, keys, 2));
    SN_TRY(sn_yaml_need(map, "towards", &node));
    SN_TRY(sn_yaml_quantities(node, "m", 3, def->towards));
    SN_TRY(sn_yaml_need(map, "ratio", &node));
    SN_TRY(sn_yaml_quantity(node, "1", &def->ratio));
    if (def->ratio >= 1.0 && def->ratio <= 100.0) return SN_OK;
    return sn_yaml_expected(node, SN_E_RANGE, "longest over shortest cell, 1 to 100");
}

static sn_status read_block(const sn_yaml *map, sn_shape_def *def) {
    static const char *const keys[] = {"size", "cells", "pattern", "grade"};
    const sn_yaml *size, *grade;
    def->shape = SN_SHAPE_BLOCK;
    SN_TRY(sn_yaml_map(map, keys, 4));
    if ((grade = sn_yaml_get(map, "grade"))) SN_TRY(read_grade(grade, def));
    SN_TRY(sn_yaml_need(map, "size", &size));
    SN_TRY(sn_yaml_quantities(size, "m", 3, def->size));
    for (const sn_yaml *item = size->first; item; item = item->next)
        if (!(def->size[item->index] > 0.0))
            return sn_yaml_expected(item, SN_E_RANGE, "a length of more than 0");
    return read_cells(map, "[along x, along y, along z]", def->cells);
}

static sn_status read_cylinder(const sn_yaml *map, sn_shape_def *def) {
    static const char *const keys[] = {"radius", "length", "cells", "pattern"};
    def->shape = SN_SHAPE_CYLINDER;
    SN_TRY(sn_yaml_map(map, keys, 4));
    SN_TRY(read_length(map, "radius", &def->radius));
    SN_TRY(read_length(map, "length", &def->length));
    return read_cells(map, "[radial, around, along]", def->cells);
}

static sn_status read_tube(const sn_yaml *map, sn_shape_def *def) {
    static const char *const keys[] = {"inner_radius", "outer_radius", "length", "cells",
                                       "pattern"};
    def->shape = SN_SHAPE_TUBE;
    SN_TRY(sn_yaml_map(map, keys, 5));
    SN_TRY(read_length(map, "inner_radius", &def->inner_radius));
    SN_TRY(read_length(map, "outer_radius", &def->outer_radius));
    SN_TRY(read_length(map, "length", &def->length));
    if (!(def->outer_radius > def->inner_radius))
        return sn_yaml_expected(sn_yaml_get(map, "outer_radius"), SN_E_RANGE,
                                "more than the inner radius");
    return read_cells(map, "[radial, around, along]", def->cells);
}

static sn_status read_axes(const sn_yaml *map, const char *key, double axes[2]) {
    const sn_yaml *node;
    SN_TRY(sn_yaml_need(map, key, &node));
    SN_TRY(sn_yaml_quantities(node, "m", 2, axes));
    for (const sn_yaml *item = node->first; item; item = item->next)
        if (!(axes[item->index] > 0.0))
            return sn_yaml_expected(item, SN_E_RANGE, "a length of more than 0");
    return SN_OK;
}

static sn_status read_ellipsoid(const sn_yaml *map, sn_shape_def *def) {
    static const char *const keys[] = {"inner", "outer", "base", "cells", "pattern"};
    const sn_yaml *node;
    def->shape = SN_SHAPE_ELLIPSOID;
    SN_TRY(sn_yaml_map(map, keys, 5));
    SN_TRY(read_axes(map, "inner", def->inner));
    SN_TRY(read_axes(map, "outer", def->outer));
    SN_TRY(sn_yaml_need(map, "base", &node));
    SN_TRY(sn_yaml_quantity(node, "m", &def->base));
    return read_cells(map, "[through, around, along]", def->cells);
}

static sn_status read_shape(const sn_yaml *mesh, const sn_yaml *shape, sn_case *c) {
    sn_shape_def *def = &c->shape;
    sn_status status = strcmp(shape->key, "block") == 0      ? read_block(shape, def)
                       : strcmp(shape->key, "cylinder") == 0 ? read_cylinder(shape, def)
                       : strcmp(shape->key, "tube") == 0     ? read_tube(shape, def)
                                                             : read_ellipsoid(shape, def);
    SN_TRY(status);
    const sn_yaml *inside = sn_yaml_get(shape, "pattern"), *beside = sn_yaml_get(mesh, "pattern");
    if (inside && beside)
        return sn_yaml_fail(beside, SN_E_KEY, "given twice, first in line %d", inside->line);
    if (inside || beside) SN_TRY(read_pattern(inside ? inside : beside, def));
    c->has_shape = true;
    return sn_yaml_within(shape, sn_mesh_build(def, &c->mesh));
}

sn_status sn_case_read_unit(const sn_yaml *map, double *factor) {
    const sn_yaml *unit = sn_yaml_get(map, "unit");
    const char *text;
    double offset;
    *factor = 1.0;
    if (!unit) return SN_OK;
    SN_TRY(sn_yaml_text(unit, "a unit of length such as mm", &text));
    return sn_yaml_within(unit, sn_unit_to_si(text, "m", factor, &offset));
}

// {file: liver.msh, unit: mm}; without a unit the coordinates are metres.
static sn_status read_file(const sn_yaml *mesh, const sn_yaml *file, sn_case *c) {
    double factor;
    const char *text;
    const sn_yaml *pattern = sn_yaml_get(mesh, "pattern");
    if (pattern)
        return sn_yaml_fail(pattern, SN_E_KEY,
                            "a mesh from a file has its own cells, expected "
                            "\"file\" and \"unit\" only");
    SN_TRY(sn_case_read_unit(mesh, &factor));
    SN_TRY(sn_yaml_text(file, "the path of a Gmsh mesh", &text));
    char *path;
    SN_TRY(sn_case_join_path(file, text, &path));
    sn_status status = sn_mesh_read_gmsh(path, factor, &c->mesh);
    sn_free(path);
    return sn_yaml_within(file, status);
}

sn_status sn_case_read_mesh(const sn_yaml *node, sn_case *c) {
    static const char *const keys[] = {"block", "cylinder", "tube",   "ellipsoid",
                                       "file",  "unit",     "pattern"};
    SN_TRY(sn_yaml_map(node, keys, 7));
    const sn_yaml *source = NULL;
    for (int k = 0; k < 5; k++) {
        const sn_yaml *found = sn_yaml_get(node, keys[k]);
        if (found && source)
            return sn_yaml_fail(found, SN_E_KEY, "expected one shape, \"%s\" is given too",
                                source->key);
        if (found) source = found;
    }
    if (!source)
        return sn_yaml_fail(node, SN_E_KEY,
                            "no shape, expected one of block, cylinder, tube, ellipsoid, file");
    if (strcmp(source->key, "file") == 0) return read_file(node, source, c);
    const sn_yaml *unit = sn_yaml_get(node, "unit");
    if (unit)
        return sn_yaml_fail(unit, SN_E_KEY,
                            "belongs to \"file\"; a built-in shape has its units "
                            "at its numbers");
    return read_shape(node, source, c);
}

//---- tissues -------------------------------------------------------------------------------------

static sn_status read_tissue(const sn_yaml *node, sn_tissue *tissue) {
    const char *name;
    char *path;
    SN_TRY(sn_yaml_text(node, "the path of a tissue file", &name));
    SN_TRY(sn_case_join_path(node, name, &path));
    sn_status status = sn_tissue_read(path, tissue);
    sn_free(path);
    return sn_yaml_within(node, status);
}

static int find_region(const sn_mesh *mesh, const char *name) {
    for (int k = 0; k < mesh->region_count; k++)
        if (strcmp(mesh->region_name[k], name) == 0) return k;
    return -1;
}

static sn_status unknown_region(const sn_yaml *node, const sn_mesh *mesh) {
    const char *names[NAMES_SHOWN];
    int count = mesh->region_count < NAMES_SHOWN ? mesh->region_count : NAMES_SHOWN;
    for (int k = 0; k < count; k++) names[k] = mesh->region_name[k];
    const char *near = sn_suggest(node->key, names, count);
    return sn_yaml_fail(node, SN_E_NAME, "the mesh has no region of that name, %s \"%s\"%s",
                        near ? "did you mean" : "it has",
                        near ? near : sn_text_quote(names[0]).text, near ? "?" : "");
}

sn_status sn_case_read_tissues(const sn_yaml *node, sn_case *c) {
    int count = c->mesh->region_count;
    c->tissue = sn_alloc((size_t)count, sizeof *c->tissue);
    if (!c->tissue) return SN_E_MEMORY;
    if (node->kind != SN_YAML_MAP) {
        SN_TRY(read_tissue(node, &c->tissue[0]));
        for (int k = 1; k < count; k++) c->tissue[k] = c->tissue[0];
        return SN_OK;
    }
    for (const sn_yaml *file = node->first; file; file = file->next) {
        int region = find_region(c->mesh, file->key);
        if (region < 0) return unknown_region(file, c->mesh);
        SN_TRY(read_tissue(file, &c->tissue[region]));
    }
    for (int k = 0; k < count; k++)
        if (!c->tissue[k].law)
            return sn_yaml_fail(node, SN_E_KEY, "no tissue for the region \"%s\" of the mesh",
                                sn_text_quote(c->mesh->region_name[k]).text);
    return SN_OK;
}
