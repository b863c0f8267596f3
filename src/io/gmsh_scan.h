// Gmsh files line by line: sections, numbers of a line, messages that name the place.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/base.h"

/// Most sections of a file that are looked at ($MeshFormat … $Elements).
#define SN_GMSH_SECTIONS 8

typedef struct sn_gmsh_section {
    const char *name; ///< with its $, constant
    char *text;       ///< first byte after the line of its name
    int line;         ///< of its name
} sn_gmsh_section;

/// A file in memory and a place in it.
typedef struct sn_gmsh_scan {
    const char *path;
    char *text; ///< owned; every line ends with a zero once it was read
    char *end;
    sn_gmsh_section section[SN_GMSH_SECTIONS];
    int section_count;

    const char *where; ///< name of the section being read
    char *next;        ///< first byte of the line after this one
    const char *at;    ///< next character of this line
    int line;
} sn_gmsh_scan;

/// Reads the file, its $MeshFormat, and where its sections stand.
/// @param version  22 or 41
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_UNSUPPORTED (binary, other versions), SN_E_MEMORY.
sn_status sn_gmsh_open(const char *path, sn_gmsh_scan *scan, int *version);
void sn_gmsh_close(sn_gmsh_scan *scan);

/// Goes to the first line of a section. @return false where the file has none.
bool sn_gmsh_enter(sn_gmsh_scan *scan, const char *name);
/// Goes to the next line. @return SN_OK, SN_E_SYNTAX at the end of the section (`what` was
/// expected).
sn_status sn_gmsh_line(sn_gmsh_scan *scan, const char *what);
/// Goes past the last line, which must be the section's $End.
sn_status sn_gmsh_leave(sn_gmsh_scan *scan);
/// Most bytes that the section can still have: bounds what a count may claim.
size_t sn_gmsh_left(const sn_gmsh_scan *scan);

/// The next whole number of the line, within [low, high]. `what` names it.
sn_status sn_gmsh_integer(sn_gmsh_scan *scan, const char *what, long long low, long long high,
                          long long *value);
/// The next number of the line. @return SN_OK, SN_E_SYNTAX (also nan and inf).
sn_status sn_gmsh_number(sn_gmsh_scan *scan, const char *what, double *value);
/// The next text of the line, in double quotes. Fits SN_NAME_MAX.
sn_status sn_gmsh_name(sn_gmsh_scan *scan, char name[SN_NAME_MAX]);
/// The line must be at its end.
sn_status sn_gmsh_line_end(sn_gmsh_scan *scan, const char *expected);

/// Stores "path:LINE: $Section: …" and returns `status`.
sn_status sn_gmsh_fail(const sn_gmsh_scan *scan, sn_status status, const char *format, ...)
    SN_PRINTF(3, 4);
