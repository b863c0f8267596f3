// `fibres` of a case file: one direction, a rule around an axis, or a file with a row a cell.
// SPDX-License-Identifier: Apache-2.0
//
//     fibres: [1, 0, 0]
//     fibres: {direction: [1, 0, 0], sheet: [0, 1, 0]}
//     fibres: {circumferential: z, angle: [60 deg, -60 deg], walls: [inner, outer]}
//     fibres: {file: fibres.csv}
#include <math.h>
#include <string.h>

#include "io/case_file.h"
#include "io/csv.h"
#include "io/file.h"
#include "io/text.h"

static const double right_angle = 1.57079632679489661923;

// false where it has no length
static bool make_unit(double v[3]) {
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0.0)) return false;
    for (int i = 0; i < 3; i++) v[i] /= largest; // no overflow in the squares
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= length;
    return true;
}

static sn_status read_direction(const sn_yaml *node, double v[3]) {
    SN_TRY(sn_yaml_quantities(node, "1", 3, v));
    return make_unit(v) ? SN_OK : sn_yaml_fail(node, SN_E_RANGE, "the direction has no length");
}

static sn_status read_alike(const sn_yaml *map, sn_case *c) {
    static const char *const keys[] = {"direction", "sheet"};
    const sn_yaml *sheet = sn_yaml_get(map, "sheet");
    SN_TRY(sn_yaml_map(map, keys, 2));
    SN_TRY(read_direction(sn_yaml_get(map, "direction"), c->fibre));
    return sheet ? read_direction(sheet, c->fibres.sheet) : SN_OK;
}

//---- around an axis ------------------------------------------------------------------------------

static sn_status read_axis(const sn_yaml *node, double axis[3]) {
    static const char *const names[] = {"x", "y", "z"};
    if (node->kind == SN_YAML_LIST) return read_direction(node, axis);
    for (int k = 0; k < 3 && node->kind == SN_YAML_TEXT; k++)
        if (strcmp(node->text, names[k]) == 0) {
            axis[k] = 1;
            return SN_OK;
        }
    return sn_yaml_expected(node, SN_E_SYNTAX, "an axis: x, y, z or a direction such as [0, 0, 1]");
}

// one angle, or that at the inner and that at the outer wall
static sn_status read_angle(const sn_yaml *node, double angle[2]) {
    if (node->kind == SN_YAML_LIST) return sn_yaml_quantities(node, "rad", 2, angle);
    SN_TRY(sn_yaml_quantity(node, "rad", angle));
    angle[1] = angle[0];
    return SN_OK;
}

static sn_status read_wall(const sn_yaml *node, const char *name, const sn_case *c, int *wall) {
    *wall = sn_mesh_surface(c->mesh, name);
    if (*wall < 0) return sn_yaml_within(node, SN_E_NAME);
    if (c->mesh->surface[*wall].face_count > 0) return SN_OK;
    return sn_yaml_fail(node, SN_E_DEFINITION, "the surface \"%s\" has no faces",
                        sn_text_quote(name).text);
}

// The walls where none are named: those of a body that has them. The normal of a built-in tube
// needs none.
static sn_status choose_walls(const sn_yaml *map, sn_case *c) {
    static const char *const names[] = {"inner", "outer"};
    sn_fibres *f = &c->fibres;
    bool both = true, turns = f->angle[0] < f->angle[1] || f->angle[0] > f->angle[1];
    for (int k = 0; k < 2; k++) {
        int at = 0;
        while (at < c->mesh->surface_count && strcmp(c->mesh->surface[at].name, names[k]) != 0)
            at++;
        both = both && at < c->mesh->surface_count && c->mesh->surface[at].face_count > 0;
        f->wall[k] = at;
    }
    if (both && (turns || !c->has_shape || c->shape.shape != SN_SHAPE_TUBE)) return SN_OK;
    f->wall[0] = f->wall[1] = -1;
    if (!turns) return SN_OK;
    return sn_yaml_fail(map, SN_E_KEY,
                        "an angle that changes through the wall needs \"walls\", such as "
                        "[inner, outer]: the inner and the outer surface of the mesh");
}

static sn_status read_walls(const sn_yaml *map, sn_case *c) {
    const sn_yaml *node = sn_yaml_get(map, "walls");
    if (!node) return choose_walls(map, c);
    if (node->kind != SN_YAML_LIST || node->count != 2)
        return sn_yaml_expected(node, SN_E_SYNTAX,
                                "the inner and the outer surface, such as [inner, outer]");
    for (const sn_yaml *item = node->first; item; item = item->next) {
        const char *name;
        SN_TRY(sn_yaml_text(item, "the name of a surface", &name));
        SN_TRY(read_wall(item, name, c, &c->fibres.wall[item->index]));
    }
    if (c->fibres.wall[0] != c->fibres.wall[1]) return SN_OK;
    return sn_yaml_fail(node, SN_E_DEFINITION, "expected two different surfaces");
}

static sn_status read_around(const sn_yaml *map, const char *rule, sn_case *c) {
    const char *const keys[] = {rule, "angle", "walls", "through", "sheet"};
    static const char *const sheets[] = {"wall", "normal"};
    sn_fibres *f = &c->fibres;
    const sn_yaml *node;
    f->rule = SN_FIBRES_AROUND;
    SN_TRY(sn_yaml_map(map, keys, 5));
    SN_TRY(read_axis(sn_yaml_get(map, rule), f->axis));
    if ((node = sn_yaml_get(map, "angle"))) SN_TRY(read_angle(node, f->angle));
    for (int k = 0; k < 2 && rule[0] == 'l'; k++) f->angle[k] = right_angle - f->angle[k];
    if ((node = sn_yaml_get(map, "through"))) SN_TRY(sn_yaml_quantities(node, "m", 3, f->through));
    if ((node = sn_yaml_get(map, "sheet"))) {
        int index;
        SN_TRY(sn_yaml_choice(node, sheets, 2, &index));
        f->sheet_normal = index == 1;
    }
    return read_walls(map, c);
}

//---- a row a cell --------------------------------------------------------------------------------

static const char columns[] = "fx,fy,fz or fx,fy,fz,sx,sy,sz";

// The next line that is neither blank nor a comment, in cells; `end` of the csv where there is
// none.
static sn_status next_row(sn_csv *csv) {
    do {
        SN_TRY(sn_csv_line(csv));
        if (csv->end) return SN_OK;
    } while (!*sn_text_trim(csv->text) || *sn_text_trim(csv->text) == '#');
    if (!csv->separator) csv->separator = sn_csv_separator(csv->text);
    return sn_csv_cells(csv);
}

static sn_status read_header(sn_csv *csv, int *count) {
    static const char *const names[] = {"fx", "fy", "fz", "sx", "sy", "sz"};
    SN_TRY(next_row(csv));
    if (csv->end)
        return sn_fail(SN_E_SYNTAX, "%s: empty, expected a header %s", csv->path, columns);
    *count = csv->cell_count;
    bool good = *count == 3 || *count == 6;
    for (int k = 0; k < *count && good; k++) {
        char *unit = strchr(csv->cell[k], '['); // "fx [1]" is fx
        if (unit && strcmp(unit, "[1]") == 0) *unit = 0;
        good = strcmp(sn_text_trim(csv->cell[k]), names[k]) == 0;
    }
    if (good) return SN_OK;
    return sn_fail(SN_E_SYNTAX, "%s:%d: found a header of %d columns, expected %s", csv->path,
                   csv->line, *count, columns);
}

static sn_status read_row(const sn_csv *csv, int count, double row[6]) {
    if (csv->cell_count != count)
        return sn_fail(SN_E_SYNTAX, "%s:%d: found %d columns, expected %d", csv->path, csv->line,
                       csv->cell_count, count);
    for (int k = 0; k < count; k++) {
        const char *end, *wrong = sn_number_parse(csv->cell[k], &row[k], &end);
        if (!wrong && *end) wrong = "not a number";
        if (wrong)
            return sn_fail(SN_E_SYNTAX, "%s:%d: column %d: found \"%s\", %s", csv->path, csv->line,
                           k + 1, sn_text_quote(csv->cell[k]).text, wrong);
    }
    for (int v = 0; v < count; v += 3)
        if (!make_unit(row + v))
            return sn_fail(SN_E_RANGE, "%s:%d: the %s has no length", csv->path, csv->line,
                           v ? "second direction" : "fibre");
    double n[3] = {row[1] * row[5] - row[2] * row[4], row[2] * row[3] - row[0] * row[5],
                   row[0] * row[4] - row[1] * row[3]};
    if (count == 6 && n[0] * n[0] + n[1] * n[1] + n[2] * n[2] < 1e-16)
        return sn_fail(SN_E_RANGE, "%s:%d: the second direction is along the fibre", csv->path,
                       csv->line);
    return SN_OK;
}

static sn_status read_rows(sn_csv *csv, int cells, sn_fibres *f) {
    int count = 0, rows = 0;
    SN_TRY(read_header(csv, &count));
    f->listed = sn_alloc(6 * (size_t)cells, sizeof *f->listed);
    if (!f->listed) return SN_E_MEMORY;
    for (;; rows++) {
        SN_TRY(next_row(csv));
        if (csv->end || rows == cells) break;
        SN_TRY(read_row(csv, count, f->listed + 6 * (size_t)rows));
    }
    f->count = rows;
    if (!csv->end)
        return sn_fail(SN_E_DATA,
                       "%s:%d: more rows than the %d cells of the mesh, expected one a "
                       "cell",
                       csv->path, csv->line, cells);
    if (rows == cells) return SN_OK;
    return sn_fail(SN_E_DATA,
                   "%s: found %d rows, expected one for each of the %d cells of the mesh",
                   csv->path, rows, cells);
}

static sn_status read_list(const sn_yaml *map, sn_case *c) {
    static const char *const keys[] = {"file"};
    const sn_yaml *node = sn_yaml_get(map, "file");
    const char *name;
    char *path = NULL;
    sn_csv *csv = NULL;
    sn_status status;
    SN_TRY(sn_yaml_map(map, keys, 1));
    SN_TRY(sn_yaml_text(node, "the path of a CSV file", &name));
    SN_TRY(sn_case_join_path(node, name, &path));
    c->fibres.rule = SN_FIBRES_LISTED;
    csv = sn_alloc(1, sizeof *csv);
    if (!csv) {
        status = SN_E_MEMORY;
        goto fail;
    }
    csv->path = path;
    SN_TRY_GOTO(status, sn_file_open(path, &csv->stream));
    SN_TRY_GOTO(status, read_rows(csv, c->mesh->cell_count, &c->fibres));
fail:
    if (csv && csv->stream) fclose(csv->stream);
    sn_free(csv);
    sn_free(path);
    return sn_yaml_within(node, status);
}

//---- all -----------------------------------------------------------------------------------------

sn_status sn_case_read_fibres(const sn_yaml *node, sn_case *c) {
    static const char *const rules[] = {"direction", "circumferential", "longitudinal", "file"};
    static const char *const keys[] = {"direction", "circumferential", "longitudinal", "file",
                                       "sheet",     "angle",           "walls",        "through"};
    const char *rule = NULL;
    if (node->kind == SN_YAML_LIST) return read_direction(node, c->fibre);
    if (node->kind != SN_YAML_MAP)
        return sn_yaml_expected(node, SN_E_SYNTAX,
                                "a direction such as [1, 0, 0], a rule such as {circumferential: "
                                "z, angle: 30 deg}, or {file: fibres.csv}");
    SN_TRY(sn_yaml_map(node, keys, 8));
    for (int k = 0; k < 4; k++) {
        const sn_yaml *found = sn_yaml_get(node, rules[k]);
        if (found && rule)
            return sn_yaml_fail(found, SN_E_KEY, "expected one rule, \"%s\" is given too", rule);
        if (found) rule = rules[k];
    }
    if (!rule)
        return sn_yaml_fail(node, SN_E_KEY,
                            "expected one of direction, circumferential, longitudinal, file");
    if (strcmp(rule, "direction") == 0) return read_alike(node, c);
    if (strcmp(rule, "file") == 0) return read_list(node, c);
    return read_around(node, rule, c);
}
