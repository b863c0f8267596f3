// Lines and cells of a text table: the tokenizer under the curve reader.
// SPDX-License-Identifier: Apache-2.0
//
// Why not libcsv or another library: messages must name the line and the column, comment lines
// carry remarks, the separator and the decimal comma are found from the file, zero bytes must be
// seen. libcsv tells no line numbers, knows no comments, and hands out cells one by one; what would
// be left for it to do is the page below.
#include "io/csv.h"

#include <errno.h>
#include <string.h>

#include "io/text.h"

static sn_status fail_line(const sn_csv *csv, const char *what) {
    return sn_fail(SN_E_SYNTAX, "%s:%d: %s", csv->path, csv->line, what);
}

// Bytes up to the end of the line; *ended tells a line from the end of the file.
static sn_status read_bytes(sn_csv *csv, size_t *length, bool *ended) {
    size_t used = 0;
    *ended = true;
    for (;;) {
        int byte = getc_unlocked(csv->stream);
        if (byte == EOF) {
            if (ferror(csv->stream))
                return sn_fail(SN_E_FILE, "%s: cannot read: %s", csv->path, strerror(EIO));
            *ended = used > 0;
            break;
        }
        if (byte == '\n') break;
        if (byte == '\r') {
            int after = getc_unlocked(csv->stream);
            if (after != '\n' && after != EOF) ungetc(after, csv->stream);
            break;
        }
        if (byte == 0)
            return fail_line(csv, "found a zero byte, expected a text file (UTF-8, not UTF-16)");
        if (used == SN_CSV_LINE_MAX - 1)
            return fail_line(csv, "the line is longer than 65535 bytes, expected a text table");
        csv->text[used++] = (char)byte;
    }
    csv->text[used] = 0;
    *length = used;
    return SN_OK;
}

// Latin-1 to UTF-8 in place, from the back; machines write "µm" and "°" in it.
static sn_status from_latin1(sn_csv *csv, size_t length) {
    size_t high = 0;
    for (size_t i = 0; i < length; i++) high += (unsigned char)csv->text[i] >= 0x80;
    if (length + high >= SN_CSV_LINE_MAX)
        return fail_line(csv, "the line is longer than 65535 bytes, expected a text table");
    size_t to = length + high;
    csv->text[to] = 0;
    for (size_t i = length; i-- > 0;) {
        unsigned char byte = (unsigned char)csv->text[i];
        if (byte < 0x80) {
            csv->text[--to] = (char)byte;
        } else {
            csv->text[--to] = (char)(0x80 | (byte & 0x3F));
            csv->text[--to] = (char)(0xC0 | byte >> 6);
        }
    }
    return SN_OK;
}

sn_status sn_csv_line(sn_csv *csv) {
    size_t length = 0;
    bool ended;
    csv->line++;
    SN_TRY(read_bytes(csv, &length, &ended));
    csv->end = !ended;
    if (csv->line == 1 && strncmp(csv->text, "\xEF\xBB\xBF", 3) == 0)
        memmove(csv->text, csv->text + 3, length - 3 + 1);
    if (!sn_text_is_utf8(csv->text)) return from_latin1(csv, strlen(csv->text));
    return SN_OK;
}

char sn_csv_separator(const char *header) {
    bool quoted = false, semicolon = false;
    int depth = 0;
    for (const char *s = header; *s; s++) {
        if (*s == '"') quoted = !quoted;
        if (quoted) continue;
        if (*s == '[') depth++;
        if (*s == ']' && depth > 0) depth--;
        if (depth > 0) continue;
        if (*s == '\t') return '\t';
        if (*s == ';') semicolon = true;
    }
    return semicolon ? ';' : ',';
}

// A quoted cell at *at: takes the quotes off in place, moves *at behind the closing quote.
static bool unquote(char **at) {
    char *from = *at + 1, *to = *at;
    for (;;) {
        if (*from == 0) return false;
        if (*from == '"' && from[1] != '"') break;
        if (*from == '"') from++;
        *to++ = *from++;
    }
    *at = from + 1;
    *to = 0;
    return true;
}

sn_status sn_csv_cells(sn_csv *csv) {
    char *s = csv->text;
    csv->cell_count = 0;
    for (;;) {
        if (csv->cell_count == SN_CSV_COLUMNS_MAX) return fail_line(csv, "more than 64 columns");
        while (*s == ' ' || (*s == '\t' && csv->separator != '\t')) s++;
        char *cell = s;
        if (*s == '"') {
            if (!unquote(&s)) return fail_line(csv, "a quote is open at the end of the line");
            while (*s == ' ') s++;
            if (*s && *s != csv->separator)
                return fail_line(csv, "text after a closing quote, expected a separator");
        } else {
            while (*s && *s != csv->separator) s++;
        }
        bool more = *s != 0;
        *s = 0;
        csv->cell[csv->cell_count++] = sn_text_trim(cell);
        if (!more) return SN_OK;
        s++;
    }
}
