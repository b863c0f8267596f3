// Writes a record as a text table that sn_curve_read() and spreadsheets read.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "io/file.h"
#include "io/text.h"

// A name is quoted only where it must be.
static void write_name(FILE *stream, const sn_series *series, bool first) {
    char cell[2 * SN_NAME_MAX + 4];
    snprintf(cell, sizeof cell, "%s [%s]", series->name, series->unit);
    if (!first) fputc(',', stream);
    if (!strpbrk(cell, ",;\t\"\r\n")) {
        fputs(cell, stream);
        return;
    }
    fputc('"', stream);
    for (const char *s = cell; *s; s++) {
        if (*s == '"') fputc('"', stream);
        fputc(*s == '\n' || *s == '\r' ? ' ' : *s, stream);
    }
    fputc('"', stream);
}

static void write_note(FILE *stream, const sn_note *note) {
    fprintf(stream, "# %s: ", note->key);
    for (const char *s = note->text; *s; s++) fputc((unsigned char)*s < 0x20 ? ' ' : *s, stream);
    fputc('\n', stream);
}

static sn_status write_row(FILE *stream, const char *path, const sn_record *record, int row,
                           bool exact) {
    for (int k = 0; k < record->series_count; k++) {
        double value = record->series[k].value[row];
        if (!isfinite(value))
            return sn_fail(SN_E_DATA, "%s: column \"%s\": row %d is not a finite number", path,
                           record->series[k].name, row + 1);
        char number[32];
        if (exact)
            sn_number_format(value, 17, number);
        else
            sn_number_print(value, 9, number);
        if (k > 0) fputc(',', stream);
        fputs(number, stream);
    }
    fputc('\n', stream);
    return SN_OK;
}

sn_status sn_curve_write(const char *path, const sn_record *record, bool exact) {
    sn_outfile file;
    SN_TRY(sn_outfile_open(&file, path));
    for (int k = 0; k < record->note_count; k++) write_note(file.stream, &record->note[k]);
    for (int k = 0; k < record->series_count; k++)
        write_name(file.stream, &record->series[k], k == 0);
    fputc('\n', file.stream);
    sn_status status = SN_OK;
    for (int row = 0; row < record->rows && status == SN_OK; row++)
        status = write_row(file.stream, path, record, row, exact);
    if (status == SN_OK) return sn_outfile_close(&file);
    sn_outfile_abandon(&file);
    return status;
}
