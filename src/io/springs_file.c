// Springs given one by one as a text table.
// SPDX-License-Identifier: Apache-2.0
//
// The rest length of every spring stands in the table, so that a table of another mesh is noticed:
// nodes have no names but their numbers.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/buffer.h"
#include "io/csv.h"
#include "io/file.h"
#include "io/text.h"

enum { FROM, TO, REGION, LENGTH, STIFFNESS, COLUMNS };
static const char *const column_name[COLUMNS] = {"from", "to", "region", "length", "stiffness"};
static const char *const column_unit[COLUMNS] = {NULL, NULL, NULL, "m", "N/m"};
static const double same_length = 1e-6; // relative: digits that files keep

static double rest_length(const sn_mesh *mesh, const int end[2]) {
    double sum = 0;
    for (int d = 0; d < 3; d++) {
        const double D =
            mesh->node[3 * (size_t)end[1] + (size_t)d] - mesh->node[3 * (size_t)end[0] + (size_t)d];
        sum += D * D;
    }
    return sqrt(sum);
}

//---- writing -------------------------------------------------------------------------------------

static void put_name(sn_buffer *b, const char *name) {
    const bool quoted = strpbrk(name, ",;\t\"") != NULL;
    if (quoted) sn_buffer_text(b, "\"");
    for (const char *s = name; *s; s++) {
        if (*s == '"') sn_buffer_text(b, "\"");
        sn_buffer_add(b, *s == '\n' || *s == '\r' ? " " : s, 1);
    }
    if (quoted) sn_buffer_text(b, "\"");
}

static void put_squares(sn_buffer *b, const char *region, const double *q) {
    bool any = false;
    for (int k = 0; k < SN_SPRING_SQUARES; k++) any = any || q[k] != 0;
    if (!any) return;
    sn_buffer_print(b, "# squares of %s:", region);
    for (int k = 0; k < SN_SPRING_SQUARES; k++) sn_buffer_print(b, " %.17g", q[k]);
    sn_buffer_text(b, "\n");
}

sn_status sn_springs_write(const char *path, const sn_mesh *mesh, const sn_spring_set *set,
                           const char *comment) {
    sn_buffer b = {0};
    if (comment) sn_buffer_print(&b, "# %s\n", comment);
    for (int r = 0; r < set->region_count; r++) {
        sn_buffer_print(&b, "# exponent of %s: %.17g\n", mesh->region_name[r], set->exponent[r]);
        put_squares(&b, mesh->region_name[r], set->square + SN_SPRING_SQUARES * (size_t)r);
        if (!isnan(set->bulk[r]))
            sn_buffer_print(&b, "# bulk modulus of %s: %.17g Pa\n", mesh->region_name[r],
                            set->bulk[r]);
    }
    sn_buffer_text(&b, "from,to,region,length [m],stiffness [N/m]\n");
    for (int k = 0; k < set->count; k++) {
        const int *end = set->end + 2 * (size_t)k;
        sn_buffer_print(&b, "%d,%d,", end[0], end[1]);
        put_name(&b, mesh->region_name[set->region[k]]);
        sn_buffer_print(&b, ",%.9g,%.17g\n", rest_length(mesh, end), set->stiffness[k]);
    }
    sn_status status = b.status;
    if (status == SN_OK) status = sn_text_write(path, b.text, b.size);
    sn_buffer_free(&b);
    return status;
}

//---- reading -------------------------------------------------------------------------------------

typedef struct springs_reader {
    sn_csv csv;
    const sn_mesh *mesh;
    sn_spring_set *set;
    int capacity;
    double factor[COLUMNS]; // to SI
    bool *has_exponent;
} springs_reader;

static int find_region(const sn_mesh *mesh, const char *name) {
    for (int r = 0; r < mesh->region_count; r++)
        if (strcmp(mesh->region_name[r], name) == 0) return r;
    return -1;
}

static sn_status fail_row(const springs_reader *v, sn_status status, const char *text) {
    return sn_fail(status, "%s:%d: %s", v->csv.path, v->csv.line, text);
}

static sn_status unknown_region(const springs_reader *v, const char *name) {
    return sn_fail(SN_E_NAME, "%s:%d: the mesh has no region \"%s\"; its first is \"%s\"",
                   v->csv.path, v->csv.line, sn_text_quote(name).text,
                   sn_text_quote(v->mesh->region_name[0]).text);
}

static sn_status read_squares(springs_reader *v, const char *name, const char *text) {
    const int region = find_region(v->mesh, name);
    if (region < 0) return unknown_region(v, name);
    double *q = v->set->square + SN_SPRING_SQUARES * (size_t)region;
    const char *at = text;
    for (int k = 0; k < SN_SPRING_SQUARES; k++) {
        const char *wrong;
        while (*at == ' ' || *at == '\t') at++;
        wrong = sn_number_parse(at, &q[k], &at);
        if (wrong) break;
        if (k + 1 == SN_SPRING_SQUARES && *at == 0) return SN_OK;
    }
    return sn_fail(SN_E_SYNTAX,
                   "%s:%d: squares \"%s\": expected 7 numbers, of tension xx yy zz xy yz zx and of "
                   "compression",
                   v->csv.path, v->csv.line, sn_text_quote(text).text);
}

// "# exponent of body: 12.5", "# squares of body: 9 9 9 0 0 0 22" and "# bulk modulus of body: 30
// kPa"; other remarks are nobody's
static sn_status read_remark(springs_reader *v) {
    static const char *const what[3] = {"exponent of ", "bulk modulus of ", "squares of "};
    char *text = sn_text_trim(v->csv.text + 1), *colon = strrchr(text, ':');
    for (int k = 0; k < 3; k++) {
        const size_t length = strlen(what[k]);
        double value;
        if (!colon || strncmp(text, what[k], length) != 0) continue;
        *colon = 0;
        if (k == 2) return read_squares(v, sn_text_trim(text + length), sn_text_trim(colon + 1));
        const int region = find_region(v->mesh, sn_text_trim(text + length));
        if (region < 0) return unknown_region(v, text + length);
        const sn_status status = sn_quantity_parse(sn_text_trim(colon + 1), k ? "Pa" : "1", &value);
        if (status != SN_OK) return sn_fail_within(status, "%s:%d", v->csv.path, v->csv.line);
        if (k == 0) v->has_exponent[region] = true;
        (k ? v->set->bulk : v->set->exponent)[region] = value;
    }
    return SN_OK;
}

static sn_status read_header(springs_reader *v) {
    bool good = true;
    v->csv.separator = sn_csv_separator(v->csv.text);
    SN_TRY(sn_csv_cells(&v->csv));
    good = v->csv.cell_count == COLUMNS;
    for (int k = 0; k < COLUMNS && good; k++) {
        char *cell = v->csv.cell[k], *open = strchr(cell, '['), *close = strchr(cell, ']');
        double offset;
        v->factor[k] = 1;
        if (column_unit[k] && open && close > open) {
            *close = *open = 0;
            const sn_status status =
                sn_unit_to_si(sn_text_trim(open + 1), column_unit[k], &v->factor[k], &offset);
            if (status != SN_OK) return sn_fail_within(status, "%s:%d", v->csv.path, v->csv.line);
        }
        good = (!column_unit[k] || open) && strcmp(sn_text_trim(cell), column_name[k]) == 0;
    }
    return good ? SN_OK
                : fail_row(v, SN_E_SYNTAX,
                           "expected the header \"from,to,region,length [m],stiffness [N/m]\"");
}

static sn_status read_number(const springs_reader *v, int column, double *value) {
    const char *end, *text = v->csv.cell[column], *wrong = sn_number_parse(text, value, &end);
    if (!wrong && *end) wrong = "not a number";
    if (wrong)
        return sn_fail(SN_E_SYNTAX, "%s:%d: column \"%s\": \"%s\" is %s", v->csv.path, v->csv.line,
                       column_name[column], sn_text_quote(text).text, wrong);
    *value *= v->factor[column];
    return SN_OK;
}

static sn_status read_end(const springs_reader *v, int column, int *node) {
    double value;
    SN_TRY(read_number(v, column, &value));
    if (!(value >= 0) || value >= v->mesh->node_count || value != floor(value))
        return sn_fail(SN_E_DEFINITION,
                       "%s:%d: column \"%s\": node %g: the mesh has nodes 0 to %d; these springs "
                       "are of another mesh",
                       v->csv.path, v->csv.line, column_name[column], value,
                       v->mesh->node_count - 1);
    *node = (int)value;
    return SN_OK;
}

static sn_status make_room(springs_reader *v) {
    sn_spring_set *set = v->set;
    if (set->count < v->capacity) return SN_OK;
    v->capacity = v->capacity ? 2 * v->capacity : 1024;
    int *end = sn_resize(set->end, (size_t)v->capacity, 2 * sizeof *end);
    if (end) set->end = end;
    int *region = sn_resize(set->region, (size_t)v->capacity, sizeof *region);
    if (region) set->region = region;
    double *stiffness = sn_resize(set->stiffness, (size_t)v->capacity, sizeof *stiffness);
    if (stiffness) set->stiffness = stiffness;
    return end && region && stiffness ? SN_OK : SN_E_MEMORY;
}

static sn_status read_spring(springs_reader *v) {
    double length, stiffness;
    int end[2];
    SN_TRY(sn_csv_cells(&v->csv));
    if (v->csv.cell_count != COLUMNS)
        return sn_fail(SN_E_SYNTAX, "%s:%d: %d cells, expected %d", v->csv.path, v->csv.line,
                       v->csv.cell_count, COLUMNS);
    for (int e = 0; e < 2; e++) SN_TRY(read_end(v, e, &end[e]));
    const int region = find_region(v->mesh, v->csv.cell[REGION]);
    if (region < 0) return unknown_region(v, v->csv.cell[REGION]);
    SN_TRY(read_number(v, LENGTH, &length));
    SN_TRY(read_number(v, STIFFNESS, &stiffness));
    if (end[0] == end[1])
        return fail_row(v, SN_E_DEFINITION, "a spring with one node at both ends");
    if (!(stiffness >= 0)) return fail_row(v, SN_E_RANGE, "a stiffness below 0 N/m");
    const double here = rest_length(v->mesh, end);
    if (!(fabs(length - here) <= same_length * here))
        return sn_fail(
            SN_E_DEFINITION,
            "%s:%d: the spring from node %d to %d is %g m long, in this mesh %g m: these "
            "springs are of another mesh; calibrate this one",
            v->csv.path, v->csv.line, end[0], end[1], length, here);
    SN_TRY(make_room(v));
    const int k = v->set->count++;
    v->set->end[2 * k] = end[0];
    v->set->end[2 * k + 1] = end[1];
    v->set->region[k] = region;
    v->set->stiffness[k] = stiffness;
    return SN_OK;
}

static sn_status read_lines(springs_reader *v) {
    bool header = false;
    for (;;) {
        SN_TRY(sn_csv_line(&v->csv));
        if (v->csv.end) break;
        if (*v->csv.text == '#') {
            SN_TRY(read_remark(v));
        } else if (*sn_text_trim(v->csv.text) != 0) {
            SN_TRY(header ? read_spring(v) : read_header(v));
            header = true;
        }
    }
    if (v->set->count == 0) return sn_fail(SN_E_DATA, "%s: no springs", v->csv.path);
    for (int r = 0; r < v->mesh->region_count; r++)
        if (!v->has_exponent[r])
            return sn_fail(SN_E_KEY,
                           "%s: no exponent for the region \"%s\": expected a line \"# exponent of "
                           "%s: 12\"",
                           v->csv.path, v->mesh->region_name[r], v->mesh->region_name[r]);
    const sn_status status = sn_spring_set_check(v->set, v->mesh);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "%s", v->csv.path);
}

sn_status sn_springs_read(const char *path, const sn_mesh *mesh, sn_spring_set **set) {
    *set = NULL;
    springs_reader *v = sn_alloc(1, sizeof *v);
    if (!v) return SN_E_MEMORY;
    v->csv.path = path;
    v->mesh = mesh;
    v->has_exponent = sn_alloc((size_t)mesh->region_count, sizeof *v->has_exponent);
    sn_status status =
        v->has_exponent ? sn_spring_set_create(0, mesh->region_count, &v->set) : SN_E_MEMORY;
    if (status == SN_OK) status = sn_file_open(path, &v->csv.stream);
    if (status == SN_OK) {
        status = read_lines(v);
        fclose(v->csv.stream);
    }
    if (status == SN_OK) {
        *set = v->set;
        v->set = NULL;
    }
    sn_spring_set_destroy(v->set);
    sn_free(v->has_exponent);
    sn_free(v);
    return status;
}
