// Files inside io: opening with a message, and writing through a temporary name.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdio.h>

#include "sinew/io.h"

/// Opens a file for reading; folders are refused. @return SN_OK, SN_E_FILE with the path.
sn_status sn_file_open(const char *path, FILE **stream);
/// Reads a whole file, with a closing zero after it. *text is sn_alloc'd for the caller.
/// @return SN_OK, SN_E_FILE, SN_E_DATA (more than `most` bytes), SN_E_MEMORY.
sn_status sn_file_read(const char *path, size_t most, char **text, size_t *bytes);

/// A file being written under a temporary name next to its own. What is not a regular file (a pipe,
/// a terminal) is written directly.
typedef struct sn_outfile {
    FILE *stream;
    char *path;      ///< where it will stand
    char *temporary; ///< where it stands now; NULL where it is written directly
} sn_outfile;

/// @return SN_OK, SN_E_FILE, SN_E_MEMORY. On failure nothing is left to close.
sn_status sn_outfile_open(sn_outfile *file, const char *path);
/// Flushes, renames and releases; on failure the temporary file is gone.
sn_status sn_outfile_close(sn_outfile *file);
/// Drops what was written and releases.
void sn_outfile_abandon(sn_outfile *file);
