// Reads measured curves: a text table with a header of names and units, remarks in comment lines.
// SPDX-License-Identifier: Apache-2.0
//
//     # area: 4.2 mm2
//     # specimen: rabbit 12, abdominal skin
//     time [s],force [N],extension [mm]
//     0,0,0
//
// The header is the first line that is neither blank nor a comment. Units stand in it or, for all
// columns, in a second row. Nothing is guessed: a name is one of the table below, a unit must be
// given (percent and fraction differ by a hundred), and a decimal comma is taken for one only where
// the separator is another character and no cell has a decimal point.
#include <math.h>
#include <string.h>
#include <strings.h>

#include "io/csv.h"
#include "io/file.h"
#include "io/text.h"
#include "io/units.h"

#define ROWS_MAX 20000000
#define NOTES_MAX 1000

typedef struct column_kind {
    const char *name, *unit;
    bool paired;           ///< takes a suffix _1 or _2
    const char *others[4]; ///< what other programs call it: for suggestions only
} column_kind;

static const column_kind column_kinds[] = {
    {"time", "s", false, {"t", "elapsed_time", "seconds"}},
    {"force", "N", true, {"load", "f"}},
    {"extension", "m", true, {"displacement", "position", "elongation", "disp"}},
    {"length", "m", true, {"l"}},
    {"stretch", "1", true, {"lambda", "stretch_ratio"}},
    {"strain", "1", true, {"eps", "epsilon", "engineering_strain", "nominal_strain"}},
    {"stress", "Pa", true, {"sigma", "nominal_stress", "engineering_stress", "pk1_stress"}},
    {"true_stress", "Pa", true, {"cauchy_stress", "cauchy"}},
    {"green_strain", "1", true, {"e", "green_lagrange_strain"}},
    {"pk2_stress", "Pa", true, {"s", "pk2", "second_piola_kirchhoff_stress"}},
    {"cycle", "1", false, {"cycles", "cycle_number", "n"}},
    {"shear_strain", "1", false, {"gamma"}},
    {"shear_stress", "Pa", false, {"tau"}},
    {"frequency", "Hz", false, {"freq", "omega"}},
    {"storage_modulus", "Pa", false, {"g'", "e'", "e_stor", "storage"}},
    {"loss_modulus", "Pa", false, {"g''", "e''", "e_loss", "loss"}},
    {"hysteresis", "1", false, {"h", "energy_loss"}},
};
enum { KIND_COUNT = sizeof column_kinds / sizeof column_kinds[0] };

// Remarks that are quantities; all are sizes, so they must be positive.
static const struct {
    const char *key, *unit;
} quantity_notes[] = {
    {"area", "m2"},          {"area_1", "m2"},        {"area_2", "m2"},   {"gauge_length", "m"},
    {"gauge_length_1", "m"}, {"gauge_length_2", "m"}, {"thickness", "m"}, {"width", "m"},
    {"width_1", "m"},        {"width_2", "m"},        {"diameter", "m"},  {"mean_stretch", "1"},
};
enum { QUANTITY_COUNT = sizeof quantity_notes / sizeof quantity_notes[0] };

typedef struct column {
    char name[SN_NAME_MAX];
    const column_kind *kind;
    char unit[SN_NAME_MAX]; ///< as written; empty where none stands in the header
    bool has_unit;
    double factor, offset; ///< to SI
} column;

typedef struct reader {
    sn_csv csv;
    int column_count;
    column column[SN_CSV_COLUMNS_MAX];
    sn_record *record;
    int comma_line, point_line; ///< where the first decimal comma and point stand; 0: none yet
} reader;

//---- remarks -------------------------------------------------------------------------------------

static bool is_key(const char *text) {
    size_t length = strlen(text);
    return length > 0 && length < SN_NAME_MAX &&
           strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

static sn_status quantity_note(reader *r, const char *key, const char *text, const char *unit,
                               double *value) {
    const char *path = r->csv.path;
    int line = r->csv.line;
    if (sn_record_note(r->record, key))
        return sn_fail(SN_E_KEY, "%s:%d: \"%s\" is given twice", path, line, key);
    sn_status status = sn_quantity_parse(text, unit, value);
    if (status != SN_OK) return sn_fail_within(status, "%s:%d: \"%s\"", path, line, key);
    if (!(*value > 0.0))
        return sn_fail(SN_E_RANGE, "%s:%d: \"%s\": found \"%s\", expected more than 0", path, line,
                       key, sn_text_quote(text).text);
    return SN_OK;
}

// "# key: value"; a comment of another form says nothing to a program.
static sn_status read_note(reader *r, char *comment) {
    char *colon = strchr(comment, ':');
    if (!colon) return SN_OK;
    *colon = 0;
    const char *key = sn_text_trim(comment);
    char *text = sn_text_trim(colon + 1);
    if (!is_key(key) || !*text) return SN_OK;
    for (char *s = text; *s; s++)
        if ((unsigned char)*s < 0x20 || *s == 0x7F) *s = ' ';
    if (r->record->note_count == NOTES_MAX)
        return sn_fail(SN_E_DATA, "%s:%d: more than %d remarks", r->csv.path, r->csv.line,
                       NOTES_MAX);
    double value = (double)NAN;
    for (int k = 0; k < QUANTITY_COUNT; k++)
        if (strcmp(key, quantity_notes[k].key) == 0)
            SN_TRY(quantity_note(r, key, text, quantity_notes[k].unit, &value));
    if (strlen(text) >= SN_TEXT_MAX) { // a remark may be cut, at a whole character
        size_t cut = SN_TEXT_MAX - 1;
        while (cut > 0 && ((unsigned char)text[cut] & 0xC0) == 0x80) cut--;
        text[cut] = 0;
    }
    return sn_record_add_note(r->record, key, text, value);
}

// The next line that holds a header or data, cut into cells; remarks on the way are kept.
static sn_status next_row(reader *r) {
    for (;;) {
        SN_TRY(sn_csv_line(&r->csv));
        if (r->csv.end) return SN_OK;
        char *text = r->csv.text + strspn(r->csv.text, " \t");
        if (*text == '#')
            SN_TRY(read_note(r, text + 1));
        else if (*text)
            break;
    }
    if (!r->csv.separator) r->csv.separator = sn_csv_separator(r->csv.text);
    return sn_csv_cells(&r->csv);
}

//---- header --------------------------------------------------------------------------------------

static sn_status fail_column(const reader *r, sn_status status, const char *name,
                             const char *what) {
    return sn_fail(status, "%s:%d: column \"%s\": %s", r->csv.path, r->csv.line,
                   sn_text_quote(name).text, what);
}

static const column_kind *find_kind(const char *name) {
    size_t length = strlen(name);
    bool suffix =
        length > 2 && (!strcmp(name + length - 2, "_1") || !strcmp(name + length - 2, "_2"));
    for (int k = 0; k < KIND_COUNT; k++) {
        const column_kind *kind = &column_kinds[k];
        if (strcmp(name, kind->name) == 0) return kind;
        if (suffix && kind->paired && strlen(kind->name) == length - 2 &&
            strncmp(name, kind->name, length - 2) == 0)
            return kind;
    }
    return NULL;
}

static sn_status unknown_column(const reader *r, const char *name) {
    const char *names[KIND_COUNT];
    const char *near = NULL;
    // "Load (N)": the words before the parenthesis
    char word[SN_NAME_MAX];
    snprintf(word, sizeof word, "%.*s", (int)strcspn(name, "(["), name);
    char *trimmed = sn_text_trim(word);
    for (char *s = trimmed; *s; s++)
        if (*s == ' ') *s = '_';
    for (int k = 0; k < KIND_COUNT; k++) {
        names[k] = column_kinds[k].name;
        for (int i = 0; i < 4 && column_kinds[k].others[i]; i++)
            if (strcasecmp(trimmed, column_kinds[k].others[i]) == 0) near = names[k];
    }
    if (!near) near = sn_suggest(trimmed, names, KIND_COUNT);
    if (near)
        return sn_fail(SN_E_KEY, "%s:%d: unknown column \"%s\", did you mean \"%s [%s]\"?",
                       r->csv.path, r->csv.line, sn_text_quote(name).text, near,
                       find_kind(near)->unit);
    return sn_fail(SN_E_KEY,
                   "%s:%d: unknown column \"%s\", expected a header such as "
                   "\"time [s],force [N],extension [mm]\"",
                   r->csv.path, r->csv.line, sn_text_quote(name).text);
}

// One cell of the header: "name [unit]" or "name".
static sn_status read_name(const reader *r, char *cell, column *c) {
    if (!*cell)
        return sn_fail(SN_E_SYNTAX,
                       "%s:%d: a column has no name, expected a header such as "
                       "\"time [s],force [N],extension [mm]\"",
                       r->csv.path, r->csv.line);
    char *open = strchr(cell, '[');
    size_t length = strlen(cell);
    c->has_unit = open != NULL;
    if (open) {
        if (cell[length - 1] != ']')
            return fail_column(r, SN_E_SYNTAX, cell, "expected \"name [unit]\"");
        cell[length - 1] = 0;
        const char *unit = sn_text_trim(open + 1);
        if (strlen(unit) >= sizeof c->unit)
            return fail_column(r, SN_E_UNIT, cell, "the unit is longer than 63 bytes");
        strcpy(c->unit, unit);
        *open = 0;
        sn_text_trim(cell);
    }
    c->kind = find_kind(cell);
    if (!c->kind) return unknown_column(r, cell);
    snprintf(c->name, sizeof c->name, "%s", cell);
    return SN_OK;
}

static sn_status resolve_unit(const reader *r, column *c) {
    c->factor = 1.0;
    c->offset = 0.0;
    if (!c->has_unit || !*c->unit) {
        if (strcmp(c->name, "cycle") == 0) return SN_OK; // a count has no unit
        bool ratio = strcmp(c->kind->unit, "1") == 0;
        return sn_fail(SN_E_UNIT,
                       "%s:%d: column \"%s\": no unit, expected a header such as \"%s [%s]\"%s",
                       r->csv.path, r->csv.line, c->name, c->name, c->kind->unit,
                       ratio ? " (a fraction) or [%]" : "");
    }
    if (strcmp(c->unit, "-") == 0) strcpy(c->unit, "1");
    sn_status status = sn_unit_to_si(c->unit, c->kind->unit, &c->factor, &c->offset);
    if (status != SN_OK)
        return sn_fail_within(status, "%s:%d: column \"%s\"", r->csv.path, r->csv.line, c->name);
    return SN_OK;
}

static sn_status read_header(reader *r) {
    SN_TRY(next_row(r));
    if (r->csv.end)
        return sn_fail(SN_E_DATA,
                       "%s: the file is empty, expected a header such as "
                       "\"time [s],force [N],extension [mm]\"",
                       r->csv.path);
    r->column_count = r->csv.cell_count;
    for (int k = 0; k < r->column_count; k++) {
        column *c = &r->column[k];
        SN_TRY(read_name(r, r->csv.cell[k], c));
        for (int i = 0; i < k; i++)
            if (strcmp(r->column[i].name, c->name) == 0)
                return fail_column(r, SN_E_KEY, c->name, "stands in the header twice");
    }
    return SN_OK;
}

//---- rows ----------------------------------------------------------------------------------------

static sn_status fail_cell(const reader *r, int k, const char *cell, const char *why) {
    return sn_fail(SN_E_DATA, "%s:%d: column \"%s\": found \"%s\"%s, expected a number",
                   r->csv.path, r->csv.line, r->column[k].name, sn_text_quote(cell).text, why);
}

// A decimal comma becomes a point where it can be nothing else.
static sn_status decimal_comma(reader *r, int k, char *cell) {
    char *comma = strchr(cell, ','), *point = strchr(cell, '.');
    if (point && !r->point_line) r->point_line = r->csv.line;
    if (comma && !r->comma_line) r->comma_line = r->csv.line;
    if (comma && (point || strchr(comma + 1, ',')))
        return fail_cell(r, k, cell, " (thousands separators are not read)");
    if (r->comma_line && r->point_line)
        return sn_fail(SN_E_DATA,
                       "%s:%d: column \"%s\": found \"%s\", but decimal %s stand from line %d on: "
                       "expected one kind",
                       r->csv.path, r->csv.line, r->column[k].name, sn_text_quote(cell).text,
                       comma ? "points" : "commas", comma ? r->point_line : r->comma_line);
    if (comma) *comma = '.';
    return SN_OK;
}

static sn_status read_cell(reader *r, int k, double *value) {
    char *cell = r->csv.cell[k];
    if (r->csv.separator != ',') SN_TRY(decimal_comma(r, k, cell));
    const column *c = &r->column[k];
    const char *end;
    double x;
    const char *problem = sn_number_parse(cell, &x, &end);
    if (problem)
        return fail_cell(r, k, cell, strcmp(problem, "not a number") ? " (too large)" : "");
    if (*end) return fail_cell(r, k, cell, "");
    *value = sn_unit_apply(x, c->factor, c->offset);
    return isfinite(*value) ? SN_OK : fail_cell(r, k, cell, " (too large)");
}

static sn_status read_row(reader *r) {
    double row[SN_CSV_COLUMNS_MAX];
    if (r->csv.cell_count != r->column_count)
        return sn_fail(SN_E_DATA, "%s:%d: found %d columns, expected %d as in the header",
                       r->csv.path, r->csv.line, r->csv.cell_count, r->column_count);
    if (r->record->rows == ROWS_MAX)
        return sn_fail(SN_E_DATA, "%s:%d: more than %d rows", r->csv.path, r->csv.line, ROWS_MAX);
    for (int k = 0; k < r->column_count; k++) SN_TRY(read_cell(r, k, &row[k]));
    return sn_record_append(r->record, row);
}

// A second row of units: no unit stands in the header, and some cell of the row is not a number.
static bool is_unit_row(const reader *r) {
    bool text = false;
    for (int k = 0; k < r->column_count; k++)
        if (r->column[k].has_unit) return false;
    if (r->csv.end || r->csv.cell_count != r->column_count) return false;
    for (int k = 0; k < r->csv.cell_count; k++) {
        double x;
        const char *end;
        if (sn_number_parse(r->csv.cell[k], &x, &end) != NULL) text = true;
    }
    return text;
}

// Units as "kPa", "[kPa]" or "(kPa)".
static sn_status read_unit_row(reader *r) {
    for (int k = 0; k < r->column_count; k++) {
        column *c = &r->column[k];
        char *unit = r->csv.cell[k];
        size_t length = strlen(unit);
        if (length >= 2 && ((unit[0] == '[' && unit[length - 1] == ']') ||
                            (unit[0] == '(' && unit[length - 1] == ')'))) {
            unit[length - 1] = 0;
            unit = sn_text_trim(unit + 1);
        }
        if (strlen(unit) >= sizeof c->unit)
            return fail_column(r, SN_E_UNIT, c->name, "the unit is longer than 63 bytes");
        strcpy(c->unit, unit);
        c->has_unit = true;
        SN_TRY(resolve_unit(r, c));
    }
    return next_row(r);
}

static sn_status read_table(reader *r) {
    SN_TRY(read_header(r));
    bool in_header = false;
    for (int k = 0; k < r->column_count; k++) in_header = in_header || r->column[k].has_unit;
    // units of the header are judged while its line number stands
    for (int k = 0; in_header && k < r->column_count; k++) SN_TRY(resolve_unit(r, &r->column[k]));
    int header_line = r->csv.line;
    SN_TRY(next_row(r));
    if (!in_header && is_unit_row(r)) {
        SN_TRY(read_unit_row(r));
    } else if (!in_header) {
        r->csv.line = header_line;
        for (int k = 0; k < r->column_count; k++) SN_TRY(resolve_unit(r, &r->column[k]));
    }
    for (int k = 0; k < r->column_count; k++)
        SN_TRY(sn_record_add_series(r->record, r->column[k].name, r->column[k].kind->unit));
    while (!r->csv.end) {
        SN_TRY(read_row(r));
        SN_TRY(next_row(r));
    }
    if (r->record->rows == 0)
        return sn_fail(SN_E_DATA, "%s: there is a header but no row of data", r->csv.path);
    return SN_OK;
}

sn_status sn_curve_read(const char *path, sn_record **record) {
    *record = NULL;
    // the last bytes of a long path tell more than the first
    size_t length = strlen(path);
    const char *name = length < SN_TEXT_MAX ? path : path + (length - (SN_TEXT_MAX - 1));
    sn_status status;
    FILE *stream = NULL;
    reader *r = sn_alloc(1, sizeof *r);
    if (!r) return SN_E_MEMORY;
    SN_TRY_GOTO(status, sn_file_open(path, &stream));
    SN_TRY_GOTO(status, sn_record_create(name, &r->record));
    r->csv.path = path;
    r->csv.stream = stream;
    SN_TRY_GOTO(status, read_table(r));
    *record = r->record;
    r->record = NULL;
fail:
    if (stream) fclose(stream);
    sn_record_destroy(r->record);
    sn_free(r);
    return status;
}
