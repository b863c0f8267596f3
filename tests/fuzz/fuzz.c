// The input as a file, and what every reader owes its caller.
// SPDX-License-Identifier: Apache-2.0
#include "fuzz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[200];
static char names[8][64];
static int name_count;

static void remove_folder(void) {
    char path[300];
    for (int k = 0; k < name_count; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        unlink(path);
    }
    rmdir(folder);
}

static void stop(const char *what) {
    fprintf(stderr, "fuzz: %s: \"%s\"\n", what, sn_error_text());
    abort();
}

const char *fuzz_file(const char *name, const void *data, size_t size) {
    static char path[300];
    if (!*folder) {
        const char *parent = getenv("TMPDIR");
        snprintf(folder, sizeof folder, "%s/sinew-fuzz-XXXXXX", parent ? parent : "/tmp");
        if (!mkdtemp(folder)) stop("no temporary folder");
        atexit(remove_folder);
    }
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int k = 0;
    while (k < name_count && strcmp(names[k], name) != 0) k++;
    if (k == name_count) snprintf(names[name_count++], sizeof names[0], "%s", name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0) stop("cannot write");
    return path;
}

//---- memory --------------------------------------------------------------------------------------

#define BLOCK_MAX ((size_t)4 << 20)

static void *resize(void *context, void *block, size_t bytes) {
    (void)context;
    return bytes > BLOCK_MAX ? NULL : realloc(block, bytes);
}

static void release(void *context, void *block) {
    (void)context;
    free(block);
}

void fuzz_limit_memory(void) {
    static bool done;
    if (!done) sn_set_allocator(&(sn_allocator){resize, release, NULL});
    done = true;
}

//---- checks --------------------------------------------------------------------------------------

void fuzz_check_error(sn_status status, const char *file) {
    const char *text = sn_error_text();
    if (status == SN_E_MEMORY) return;
    if (!*text || strpbrk(text, "\r\n")) stop("expected one line of text");
    if (!strstr(text, file)) stop("expected the name of the file in the text");
}

void fuzz_check_finite(const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) stop("a value that is not finite was read");
}
