// What acts on the body of a case file: supports and loads; and the probes that watch it.
// SPDX-License-Identifier: Apache-2.0
#include <ctype.h>
#include <string.h>

#include "io/case_file.h"
#include "io/text.h"

// Most items of a list: checks of the whole case compare them with each other.
#define ITEMS_MAX 1000

sn_status sn_case_read_items(const sn_yaml *node, const char *what, size_t size, void **items) {
    SN_TRY(sn_yaml_list(node, what));
    if (node->count > ITEMS_MAX)
        return sn_yaml_fail(node, SN_E_RANGE, "found a list of %d, expected at most %d",
                            node->count, ITEMS_MAX);
    *items = sn_alloc((size_t)node->count, size);
    return *items ? SN_OK : SN_E_MEMORY;
}

static sn_status read_surface(const sn_yaml *node, const sn_case *c, int *surface) {
    const char *name;
    SN_TRY(sn_yaml_text(node, "the name of a surface", &name));
    *surface = sn_mesh_surface(c->mesh, name);
    return *surface >= 0 ? SN_OK : sn_yaml_within(node, SN_E_NAME);
}

static sn_status need_surface(const sn_yaml *map, const sn_case *c, int *surface) {
    const sn_yaml *node;
    SN_TRY(sn_yaml_need(map, "on", &node));
    return read_surface(node, c, surface);
}

//---- supports ------------------------------------------------------------------------------------

static sn_status read_fix(const sn_yaml *node, bool fix[3]) {
    static const char what[] = "any of x y z, each once, such as xyz";
    const char *text;
    SN_TRY(sn_yaml_text(node, what, &text));
    for (const char *s = text; *s; s++) {
        if (*s < 'x' || *s > 'z' || fix[*s - 'x'])
            return sn_yaml_expected(node, SN_E_SYNTAX, "%s", what);
        fix[*s - 'x'] = true;
    }
    return SN_OK;
}

sn_status sn_case_read_supports(const sn_yaml *node, sn_case *c) {
    static const char *const keys[] = {"on", "fix"};
    void *items = NULL;
    SN_TRY(sn_case_read_items(node, "supports such as {on: bottom, fix: xyz}", sizeof *c->support,
                              &items));
    c->support = items;
    for (const sn_yaml *item = node->first; item; item = item->next) {
        sn_support *support = &c->support[c->support_count++];
        const sn_yaml *fix;
        SN_TRY(sn_yaml_map(item, keys, 2));
        SN_TRY(need_surface(item, c, &support->surface));
        SN_TRY(sn_yaml_need(item, "fix", &fix));
        SN_TRY(read_fix(fix, support->fix));
    }
    return SN_OK;
}

//---- histories -----------------------------------------------------------------------------------

sn_status sn_case_read_table(const sn_yaml *node, int channels, const char *si_unit,
                             const char *example, sn_history **history) {
    SN_TRY(sn_yaml_list(node, example));
    if (node->count == 0) return sn_yaml_fail(node, SN_E_SYNTAX, "an empty table, expected rows");
    double *time = sn_alloc((size_t)node->count, sizeof *time);
    double *value = sn_alloc((size_t)node->count, (size_t)channels * sizeof *value);
    sn_status status = time && value ? SN_OK : SN_E_MEMORY;
    int count = 0;
    for (const sn_yaml *row = node->first; row && status == SN_OK; row = row->next, count++) {
        if (row->kind != SN_YAML_LIST || row->count != 1 + channels) {
            status = sn_yaml_fail(row, SN_E_SYNTAX, "expected a row of %d values, %s", 1 + channels,
                                  example);
            break;
        }
        const sn_yaml *item = row->first;
        SN_TRY_GOTO(status, sn_yaml_quantity(item, "s", &time[count]));
        if (count > 0 && !(time[count] > time[count - 1])) {
            status = sn_yaml_expected(item, SN_E_RANGE, "a later time than in the row before");
            break;
        }
        for (int k = 0; k < channels; k++) {
            item = item->next;
            SN_TRY_GOTO(status, sn_yaml_quantity(item, si_unit, &value[count * channels + k]));
        }
    }
    if (status == SN_OK)
        status = sn_yaml_within(node, sn_history_create(channels, count, time, value, history));
fail:
    sn_free(time);
    sn_free(value);
    return status;
}

// {ramp: 1 s} or {table: [[0 s, 0], [1 s, 1]]}
static sn_status read_factor(const sn_yaml *node, sn_history **factor) {
    static const char *const keys[] = {"ramp", "table"};
    SN_TRY(sn_yaml_map(node, keys, 2));
    const sn_yaml *ramp = sn_yaml_get(node, "ramp"), *table = sn_yaml_get(node, "table");
    if (!ramp == !table)
        return sn_yaml_fail(node, SN_E_KEY,
                            "expected either {ramp: 1 s} or {table: [[0 s, 0], [1 s, 1]]}");
    if (table)
        return sn_case_read_table(table, 1, "1", "rows [time, factor] such as [0 s, 0]", factor);
    double time[2] = {0.0, 0.0};
    static const double value[2] = {0.0, 1.0};
    SN_TRY(sn_yaml_quantity(ramp, "s", &time[1]));
    if (!(time[1] > 0.0)) return sn_yaml_expected(ramp, SN_E_RANGE, "a time of more than 0");
    return sn_yaml_within(ramp, sn_history_create(1, 2, time, value, factor));
}

//---- loads ---------------------------------------------------------------------------------------

static sn_status read_displacement(const sn_yaml *node, sn_load *load) {
    if (node->kind != SN_YAML_LIST || node->count != 3)
        return sn_yaml_fail(
            node, SN_E_SYNTAX,
            "expected a list of 3 lengths, or \"free\", such as [1 mm, free, 0 mm]");
    for (const sn_yaml *item = node->first; item; item = item->next) {
        int k = item->index;
        load->free[k] = item->kind == SN_YAML_TEXT && strcmp(item->text, "free") == 0;
        if (!load->free[k]) SN_TRY(sn_yaml_quantity(item, "m", &load->vector[k]));
    }
    if (load->free[0] && load->free[1] && load->free[2])
        return sn_yaml_fail(node, SN_E_RANGE, "all three components are free, expected a length");
    return SN_OK;
}

// {point: [x, y, z], force: …}: at a material point; {on: top, force: …}: spread evenly over a
// surface, which makes it a traction.
static sn_status read_force(const sn_yaml *map, const sn_yaml *node, const sn_case *c,
                            sn_load *load) {
    const sn_yaml *on = sn_yaml_get(map, "on"), *point = sn_yaml_get(map, "point");
    if (!on == !point)
        return sn_yaml_fail(map, SN_E_KEY,
                            "expected either \"on\" with the name of a surface or \"point\" with "
                            "[x, y, z] for the force");
    SN_TRY(sn_yaml_quantities(node, "N", 3, load->vector));
    load->kind = SN_LOAD_FORCE;
    if (point) return sn_yaml_quantities(point, "m", 3, load->point);
    SN_TRY(read_surface(on, c, &load->surface));
    const double area = sn_mesh_area(c->mesh, load->surface);
    if (!(area > 0.0)) return sn_yaml_fail(on, SN_E_DEFINITION, "the surface has no area");
    load->kind = SN_LOAD_TRACTION;
    for (int d = 0; d < 3; d++) load->vector[d] /= area;
    return SN_OK;
}

static sn_status read_load(const sn_yaml *map, const sn_case *c, sn_load *load) {
    static const char *const keys[] = {"displacement", "traction", "pressure", "force",
                                       "on",           "point",    "time"};
    SN_TRY(sn_yaml_map(map, keys, 7));
    const sn_yaml *kind = NULL;
    for (int k = 0; k < 4; k++) { // in the order of sn_load_kind
        const sn_yaml *found = sn_yaml_get(map, keys[k]);
        if (!found) continue;
        if (kind)
            return sn_yaml_fail(found, SN_E_KEY, "expected one kind of load, \"%s\" is given too",
                                kind->key);
        kind = found;
        load->kind = (sn_load_kind)k;
    }
    if (!kind)
        return sn_yaml_fail(map, SN_E_KEY,
                            "no load, expected one of displacement, traction, pressure, force");
    const sn_yaml *point = sn_yaml_get(map, "point");
    if (point && load->kind != SN_LOAD_FORCE)
        return sn_yaml_fail(point, SN_E_KEY,
                            "only a force acts at a point, a %s acts \"on\" a "
                            "surface",
                            kind->key);
    if (load->kind == SN_LOAD_FORCE) {
        SN_TRY(read_force(map, kind, c, load));
    } else {
        SN_TRY(need_surface(map, c, &load->surface));
        if (load->kind == SN_LOAD_DISPLACEMENT)
            SN_TRY(read_displacement(kind, load));
        else if (load->kind == SN_LOAD_TRACTION)
            SN_TRY(sn_yaml_quantities(kind, "Pa", 3, load->vector));
        else
            SN_TRY(sn_yaml_quantity(kind, "Pa", &load->pressure));
    }
    const sn_yaml *time = sn_yaml_get(map, "time");
    return time ? read_factor(time, &load->factor) : SN_OK;
}

sn_status sn_case_read_loads(const sn_yaml *node, sn_case *c) {
    void *items = NULL;
    SN_TRY(sn_case_read_items(node, "loads such as {on: top, pressure: 1 kPa, time: {ramp: 1 s}}",
                              sizeof *c->load, &items));
    c->load = items;
    for (const sn_yaml *item = node->first; item; item = item->next)
        SN_TRY(read_load(item, c, &c->load[c->load_count++]));
    return SN_OK;
}

//---- probes --------------------------------------------------------------------------------------

sn_status sn_case_read_name(const sn_yaml *map, const sn_case *c, char name[SN_NAME_MAX]) {
    static const char what[] = "a name of letters, digits, _ and -";
    const sn_yaml *node;
    char text[SN_NAME_MAX - 4]; // room for "_ux" behind it
    SN_TRY(sn_yaml_need(map, "name", &node));
    SN_TRY(sn_yaml_copy(node, what, text, sizeof text));
    for (const char *s = text; *s; s++)
        if (!isalnum((unsigned char)*s) && *s != '_' && *s != '-')
            return sn_yaml_expected(node, SN_E_SYNTAX, "%s", what);
    bool taken = false;
    for (int k = 0; k < c->tool_count; k++) taken = taken || !strcmp(c->tool[k].name, text);
    for (int k = 0; k < c->probe_count; k++) taken = taken || !strcmp(c->probe[k].name, text);
    if (taken) return sn_yaml_expected(node, SN_E_NAME, "a name that no other tool or probe has");
    strcpy(name, text);
    return SN_OK;
}

static sn_status read_probe(const sn_yaml *map, const sn_case *c, sn_probe *probe) {
    static const char *const keys[] = {"name", "point", "reaction"};
    SN_TRY(sn_yaml_map(map, keys, 3));
    SN_TRY(sn_case_read_name(map, c, probe->name));
    const sn_yaml *point = sn_yaml_get(map, "point"), *reaction = sn_yaml_get(map, "reaction");
    if (!point == !reaction)
        return sn_yaml_fail(map, SN_E_KEY,
                            "expected either \"point\" with [x, y, z] or \"reaction\" with the "
                            "name of a surface");
    probe->kind = point ? SN_PROBE_POINT : SN_PROBE_REACTION;
    return point ? sn_yaml_quantities(point, "m", 3, probe->point)
                 : read_surface(reaction, c, &probe->surface);
}

sn_status sn_case_read_probes(const sn_yaml *node, sn_case *c) {
    void *items = NULL;
    SN_TRY(sn_case_read_items(node, "probes such as {name: pull, reaction: top}", sizeof *c->probe,
                              &items));
    c->probe = items;
    for (const sn_yaml *item = node->first; item; item = item->next)
        SN_TRY(read_probe(item, c, &c->probe[c->probe_count++]));
    return SN_OK;
}
