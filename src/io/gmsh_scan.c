// Gmsh files line by line.
// SPDX-License-Identifier: Apache-2.0
//
// The file is read whole and looked through once for its sections, so that a file cut short, an
// end that is missing and a section that stands twice are found before any of them is read. After
// that a section's lines cannot run past its $End.
#include "io/gmsh_scan.h"

#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/file.h"
#include "io/text.h"

#define CONVERT "convert it with: gmsh FILE -save_all -save -format msh41 -o NEW.msh"

// the sections that are read; all others are skipped
static const char *const known[] = {"$MeshFormat",          "$PhysicalNames", "$Entities",
                                    "$PartitionedEntities", "$Nodes",         "$Elements"};

sn_status sn_gmsh_fail(const sn_gmsh_scan *scan, sn_status status, const char *format, ...) {
    char text[SN_TEXT_MAX * 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return sn_fail(status, "%s:%d: %s%s%s", scan->path, scan->line, scan->where,
                   *scan->where ? ": " : "", text);
}

//---- sections ------------------------------------------------------------------------------------

// End of the line that starts at text: its newline, or the end of the file.
static char *line_end(const sn_gmsh_scan *scan, char *text) {
    char *end = memchr(text, '\n', (size_t)(scan->end - text));
    return end ? end : scan->end;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

// The first word of a line, cut to what a section's name can have.
static void first_word(const char *text, const char *end, char word[64]) {
    size_t length = 0;
    while (text < end && is_blank(*text)) text++;
    for (; text < end && !is_blank(*text) && length < 63; text++) word[length++] = *text;
    word[length] = 0;
}

static sn_status add_section(sn_gmsh_scan *scan, const char *name, char *text) {
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (strcmp(name, known[k])) continue;
        for (int s = 0; s < scan->section_count; s++)
            if (!strcmp(name, scan->section[s].name))
                return sn_gmsh_fail(scan, SN_E_SYNTAX,
                                    "found a second %s (the first in line %d), expected one", name,
                                    scan->section[s].line);
        sn_gmsh_section *section = &scan->section[scan->section_count++];
        section->name = known[k];
        section->text = text;
        section->line = scan->line;
    }
    return SN_OK;
}

// Looks through the file for its sections.
static sn_status find_sections(sn_gmsh_scan *scan) {
    char open[64] = "", word[64];
    int opened = 0;
    scan->where = "";
    scan->line = 0;
    for (char *text = scan->text, *end; text < scan->end; text = end + 1) {
        end = line_end(scan, text);
        scan->line++;
        if (*open && *text != '$') continue; // the lines of a section: most of the file
        first_word(text, end, word);
        if (!*word) continue;
        if (!*open && (word[0] != '$' || !strncmp(word, "$End", 4)))
            return sn_gmsh_fail(scan, SN_E_SYNTAX,
                                "found \"%s\", expected a section such as $Nodes",
                                sn_text_quote(word).text);
        if (!*open) {
            SN_TRY(add_section(scan, word, end < scan->end ? end + 1 : end));
            memcpy(open, word, sizeof open);
            opened = scan->line;
        } else if (!strncmp(word, "$End", 4) && !strcmp(word + 4, open + 1)) {
            *open = 0;
        } else if (strcmp(open, "$Comments")) {
            return sn_gmsh_fail(scan, SN_E_SYNTAX, "found \"%s\", expected $End%s for line %d",
                                sn_text_quote(word).text, open + 1, opened);
        }
        if (end == scan->end) break;
    }
    if (!*open) return SN_OK;
    return sn_gmsh_fail(scan, SN_E_SYNTAX,
                        "found the end of the file, expected $End%s for line %d: the file is cut "
                        "short",
                        open + 1, opened);
}

// $MeshFormat stands first (comments may precede it) and is read before all else: the rest of a
// binary file has no lines.
static sn_status read_format(sn_gmsh_scan *scan, int *version) {
    char *text = scan->text, *end = line_end(scan, text);
    char word[64];
    bool comment = false;
    scan->where = "";
    for (scan->line = 1;; scan->line++) {
        first_word(text, end, word);
        if (!comment && *word && strcmp(word, "$Comments")) break;
        if (*word) comment = strcmp(word, "$EndComments") != 0;
        if (end == scan->end) break;
        text = end + 1;
        end = line_end(scan, text);
    }
    if (strcmp(word, "$MeshFormat"))
        return sn_gmsh_fail(
            scan, SN_E_SYNTAX,
            "found \"%s\", expected $MeshFormat: this is no Gmsh mesh of format 2.2 or "
            "4.1",
            sn_text_quote(word).text);
    scan->where = "$MeshFormat";
    scan->line++;
    // a copy: a closing zero in the text would hide zero bytes of the file's own
    char line[128] = "";
    if (end < scan->end)
        snprintf(line, sizeof line, "%.*s", (int)(line_end(scan, end + 1) - end - 1), end + 1);
    scan->at = line + strspn(line, " \t\r");
    double number;
    long long type, bytes;
    SN_TRY(sn_gmsh_number(scan, "a version", &number));
    SN_TRY(sn_gmsh_integer(scan, "a file type, 0 or 1", 0, 1, &type));
    SN_TRY(sn_gmsh_integer(scan, "a data size", 1, 1024, &bytes));
    SN_TRY(sn_gmsh_line_end(scan, "version, file type, data size"));
    *version = number > 2.19 && number < 2.21 ? 22 : number > 4.09 && number < 4.11 ? 41 : 0;
    if (!*version)
        return sn_gmsh_fail(scan, SN_E_UNSUPPORTED,
                            "found format %g, expected 2.2 or 4.1; " CONVERT, number);
    if (type)
        return sn_gmsh_fail(scan, SN_E_UNSUPPORTED,
                            "found a binary file, expected ASCII; " CONVERT
                            ", or save it as ASCII in Gmsh's dialogue");
    return SN_OK;
}

sn_status sn_gmsh_open(const char *path, sn_gmsh_scan *scan, int *version) {
    *scan = (sn_gmsh_scan){.path = path, .where = "", .at = ""};
    size_t bytes;
    SN_TRY(sn_file_read(path, SIZE_MAX / 4, &scan->text, &bytes));
    scan->end = scan->text + bytes;
    const char *zero = memchr(scan->text, 0, bytes);
    sn_status status = read_format(scan, version);
    if (status == SN_OK && zero)
        status = sn_fail(SN_E_SYNTAX,
                         "%s: found a zero byte at byte %zu, expected text: the file is damaged or "
                         "binary; " CONVERT,
                         path, (size_t)(zero - scan->text));
    if (status == SN_OK) status = find_sections(scan);
    if (status != SN_OK) sn_gmsh_close(scan);
    return status;
}

void sn_gmsh_close(sn_gmsh_scan *scan) {
    sn_free(scan->text);
    *scan = (sn_gmsh_scan){.path = scan->path, .where = "", .at = ""};
}

//---- lines ---------------------------------------------------------------------------------------

bool sn_gmsh_enter(sn_gmsh_scan *scan, const char *name) {
    for (int s = 0; s < scan->section_count; s++)
        if (!strcmp(scan->section[s].name, name)) {
            scan->where = scan->section[s].name;
            scan->line = scan->section[s].line;
            scan->next = scan->section[s].text;
            scan->at = "";
            return true;
        }
    return false;
}

// Goes to the next line that is not blank; false at the end of the file.
static bool next_line(sn_gmsh_scan *scan) {
    while (scan->next < scan->end) {
        char *text = scan->next, *end = line_end(scan, text);
        *end = 0; // the byte after the last line is a zero already
        scan->next = end < scan->end ? end + 1 : end;
        scan->line++;
        while (is_blank(*text)) text++;
        scan->at = text;
        if (*text) return true;
    }
    return false;
}

sn_status sn_gmsh_line(sn_gmsh_scan *scan, const char *what) {
    if (!next_line(scan))
        return sn_gmsh_fail(scan, SN_E_SYNTAX, "found the end of the file, expected %s", what);
    if (*scan->at != '$') return SN_OK;
    return sn_gmsh_fail(scan, SN_E_SYNTAX, "found %s, expected %s", sn_text_quote(scan->at).text,
                        what);
}

sn_status sn_gmsh_leave(sn_gmsh_scan *scan) {
    if (next_line(scan) && *scan->at == '$') return SN_OK;
    return sn_gmsh_fail(scan, SN_E_SYNTAX,
                        "found \"%s\", expected $End%s: more lines than the section declares",
                        sn_text_quote(scan->at).text, scan->where + 1);
}

size_t sn_gmsh_left(const sn_gmsh_scan *scan) {
    return (size_t)(scan->end - scan->next);
}

//---- the words of a line -------------------------------------------------------------------------

static sn_status fail_word(const sn_gmsh_scan *scan, const char *what) {
    char word[64];
    first_word(scan->at, scan->at + strlen(scan->at), word);
    if (!*word)
        return sn_gmsh_fail(scan, SN_E_SYNTAX, "found the end of the line, expected %s", what);
    return sn_gmsh_fail(scan, SN_E_SYNTAX, "found \"%s\", expected %s", sn_text_quote(word).text,
                        what);
}

// Moves to the next word after a number that ended at `end`.
static bool pass(sn_gmsh_scan *scan, const char *end) {
    if (end == scan->at || (*end && !is_blank(*end))) return false;
    while (is_blank(*end)) end++;
    scan->at = end;
    return true;
}

sn_status sn_gmsh_integer(sn_gmsh_scan *scan, const char *what, long long low, long long high,
                          long long *value) {
    const char *word = scan->at;
    char *end;
    errno = 0;
    long long found = strtoll(word, &end, 10);
    bool range = errno == ERANGE;
    if (range || found < low || found > high || !pass(scan, end)) return fail_word(scan, what);
    *value = found;
    return SN_OK;
}

sn_status sn_gmsh_number(sn_gmsh_scan *scan, const char *what, double *value) {
    const char *end;
    if (sn_number_parse(scan->at, value, &end) || !pass(scan, end)) return fail_word(scan, what);
    return SN_OK;
}

sn_status sn_gmsh_name(sn_gmsh_scan *scan, char name[SN_NAME_MAX]) {
    const char *close = strrchr(scan->at, '"');
    if (*scan->at != '"' || close == scan->at) return fail_word(scan, "a name in double quotes");
    size_t length = (size_t)(close - scan->at) - 1;
    if (length >= SN_NAME_MAX)
        return sn_gmsh_fail(scan, SN_E_SYNTAX, "found a name of %zu bytes, expected at most %d",
                            length, SN_NAME_MAX - 1);
    memcpy(name, scan->at + 1, length);
    name[length] = 0;
    if (!sn_text_is_utf8(name)) return fail_word(scan, "a name in UTF-8");
    pass(scan, close + 1);
    return SN_OK;
}

sn_status sn_gmsh_line_end(sn_gmsh_scan *scan, const char *expected) {
    if (!*scan->at) return SN_OK;
    char word[64];
    first_word(scan->at, scan->at + strlen(scan->at), word);
    return sn_gmsh_fail(scan, SN_E_SYNTAX, "found \"%s\" after the last number, expected only %s",
                        sn_text_quote(word).text, expected);
}
