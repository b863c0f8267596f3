// Lines and cells of a text table.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdio.h>

#include "sinew/io.h"

#define SN_CSV_COLUMNS_MAX 64
#define SN_CSV_LINE_MAX 65536 ///< bytes of a line with its closing zero

/// A text file read line by line. Zero it, set `path` and `stream`.
typedef struct sn_csv {
    const char *path; ///< for messages
    FILE *stream;
    int line; ///< number of the line in `text`, from 1
    bool end; ///< there was no further line
    char text[SN_CSV_LINE_MAX];
    char separator;
    int cell_count;
    char *cell[SN_CSV_COLUMNS_MAX]; ///< into text: trimmed, quotes taken off
} sn_csv;

/// Reads the next line into `text`: LF, CRLF and CR end a line; a byte order mark is dropped; a
/// line that is not UTF-8 is taken for Latin-1. Sets `end` where there is none.
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX (zero bytes, longer than SN_CSV_LINE_MAX).
sn_status sn_csv_line(sn_csv *csv);
/// Tab, else semicolon, else comma: the first of them that stands outside quotes and brackets.
char sn_csv_separator(const char *header);
/// Cuts `text` into cells. @return SN_OK, SN_E_SYNTAX (open quote, too many cells).
sn_status sn_csv_cells(sn_csv *csv);
