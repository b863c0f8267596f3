// A folder for the files of a test, gone in the end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dirent.h>
#include <unistd.h>

#include "check.h"

static char scratch[256];

static inline int scratch_open(void **state) {
    (void)state;
    snprintf(scratch, sizeof scratch, "%s/sinew-test-XXXXXX",
             getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
    return mkdtemp(scratch) ? 0 : -1;
}

static inline int scratch_close(void **state) {
    (void)state;
    DIR *folder = opendir(scratch);
    if (!folder) return -1;
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[600];
        snprintf(path, sizeof path, "%s/%s", scratch, entry->d_name);
        if (entry->d_name[0] != '.') remove(path); // an empty folder too
    }
    closedir(folder);
    return rmdir(scratch);
}

/// Path of a scratch file; valid until the fourth call after it.
static inline const char *scratch_path(const char *name) {
    static char path[4][512];
    static int next;
    char *out = path[next++ % 4];
    snprintf(out, sizeof path[0], "%s/%s", scratch, name);
    return out;
}

static inline const char *scratch_write(const char *name, const char *text, size_t bytes) {
    const char *path = scratch_path(name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(text, 1, bytes, file) != bytes || fclose(file) != 0) fail_msg("%s", path);
    return path;
}

/// The text of a file, closed by a zero; NULL where there is none. free() it.
static inline char *scratch_read(const char *name) {
    FILE *file = fopen(scratch_path(name), "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    size_t bytes = (size_t)ftell(file);
    rewind(file);
    char *text = calloc(bytes + 1, 1);
    assert_int_equal(fread(text, 1, bytes, file), bytes);
    fclose(file);
    return text;
}
