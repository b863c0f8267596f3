// Cuts of a case file: cells that are taken out during a run.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "io/case_file.h"

static const char *const regions[] = {"sphere", "box", "cells"}; // as sn_cut_kind

// {centre: [0 mm, 0 mm, 5 mm], radius: 2 mm}
static sn_status read_sphere(const sn_yaml *map, sn_cut_def *cut) {
    static const char *const keys[] = {"centre", "radius"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(map, keys, 2));
    SN_TRY(sn_yaml_need(map, "centre", &node));
    SN_TRY(sn_yaml_quantities(node, "m", 3, cut->centre));
    SN_TRY(sn_yaml_need(map, "radius", &node));
    SN_TRY(sn_yaml_quantity(node, "m", &cut->radius));
    return cut->radius > 0.0 ? SN_OK
                             : sn_yaml_expected(node, SN_E_RANGE, "a radius of more than 0");
}

// {from: [0 mm, 0 mm, 4 mm], to: [9 mm, 9 mm, 5 mm]}
static sn_status read_box(const sn_yaml *map, sn_cut_def *cut) {
    static const char *const keys[] = {"from", "to"};
    const sn_yaml *node;
    SN_TRY(sn_yaml_map(map, keys, 2));
    SN_TRY(sn_yaml_need(map, "from", &node));
    SN_TRY(sn_yaml_quantities(node, "m", 3, cut->low));
    SN_TRY(sn_yaml_need(map, "to", &node));
    SN_TRY(sn_yaml_quantities(node, "m", 3, cut->high));
    for (const sn_yaml *item = node->first; item; item = item->next)
        if (!(cut->high[item->index] > cut->low[item->index]))
            return sn_yaml_expected(item, SN_E_RANGE, "more than the same number of \"from\"");
    return SN_OK;
}

// [12, 13, 40]
static sn_status read_cells(const sn_yaml *node, const sn_mesh *mesh, sn_cut_def *cut) {
    SN_TRY(sn_yaml_list(node, "numbers of cells from 0, such as [12, 13, 40]"));
    if (node->count == 0) return sn_yaml_fail(node, SN_E_SYNTAX, "an empty list, expected cells");
    cut->cell = sn_alloc((size_t)node->count, sizeof *cut->cell);
    if (!cut->cell) return SN_E_MEMORY;
    cut->cell_count = node->count;
    for (const sn_yaml *item = node->first; item; item = item->next)
        SN_TRY(sn_yaml_int(item, 0, mesh->cell_count - 1, &cut->cell[item->index]));
    return SN_OK;
}

static sn_status read_region(const sn_yaml *map, const sn_case *c, sn_cut_def *cut) {
    const sn_yaml *region = NULL;
    for (int k = 0; k < 3; k++) {
        const sn_yaml *found = sn_yaml_get(map, regions[k]);
        if (!found) continue;
        if (region)
            return sn_yaml_fail(found, SN_E_KEY,
                                "expected one region of a cut, \"%s\" is given too", region->key);
        region = found;
        cut->kind = (sn_cut_kind)k;
    }
    if (!region)
        return sn_yaml_fail(map, SN_E_KEY,
                            "no region of the cut, expected one of sphere, box, cells");
    switch (cut->kind) {
    case SN_CUT_SPHERE: return read_sphere(region, cut);
    case SN_CUT_BOX: return read_box(region, cut);
    case SN_CUT_CELLS: return read_cells(region, c->mesh, cut);
    }
    return SN_OK;
}

sn_status sn_case_read_cuts(const sn_yaml *node, sn_case *c) {
    static const char *const keys[] = {"at", "sphere", "box", "cells"};
    void *items = NULL;
    SN_TRY(sn_case_read_items(
        node, "cuts such as {at: 1 s, sphere: {centre: [0 mm, 0 mm, 5 mm], radius: 2 mm}}",
        sizeof *c->cut, &items));
    c->cut = items;
    for (const sn_yaml *item = node->first; item; item = item->next) {
        sn_cut_def *cut = &c->cut[c->cut_count++]; // counted first: what it owns is freed
        const sn_yaml *at;
        SN_TRY(sn_yaml_map(item, keys, 4));
        SN_TRY(sn_yaml_need(item, "at", &at));
        SN_TRY(sn_yaml_quantity(at, "s", &cut->at));
        if (!(cut->at >= 0.0 && cut->at <= c->until))
            return sn_yaml_expected(at, SN_E_RANGE, "0 s to the end of the run, %g s", c->until);
        SN_TRY(read_region(item, c, cut));
    }
    return SN_OK;
}
