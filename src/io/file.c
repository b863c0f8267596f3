// Files and folders: whole files in, files out through a temporary name, folders.
// SPDX-License-Identifier: Apache-2.0
#include "io/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static sn_status fail_path(const char *path, const char *what) {
    int code = errno;
    char reason[128];
    // the GNU strerror_r: returns the text, in `reason` or constant
    return sn_fail(SN_E_FILE, "%s: %s: %s", path, what, strerror_r(code, reason, sizeof reason));
}

//---- reading -------------------------------------------------------------------------------------

sn_status sn_file_open(const char *path, FILE **stream) {
    *stream = NULL;
    FILE *file = fopen(path, "rbe");
    if (!file) return fail_path(path, "cannot open");
    struct stat about;
    if (fstat(fileno(file), &about) == 0 && S_ISDIR(about.st_mode)) {
        fclose(file);
        return sn_fail(SN_E_FILE, "%s: is a folder, expected a file", path);
    }
    *stream = file;
    return SN_OK;
}

sn_status sn_file_read(const char *path, size_t most, char **text, size_t *bytes) {
    *text = NULL;
    *bytes = 0;
    FILE *file;
    SN_TRY(sn_file_open(path, &file));
    size_t capacity = 1 << 14, used = 0;
    char *block = sn_alloc(capacity, 1);
    sn_status status = block ? SN_OK : SN_E_MEMORY;
    while (status == SN_OK) {
        size_t got = fread(block + used, 1, capacity - 1 - used, file);
        used += got;
        if (got == 0) {
            if (ferror(file)) status = fail_path(path, "cannot read");
            break;
        }
        if (used > most) {
            status = sn_fail(SN_E_DATA, "%s: more than %zu MiB, too large for a file of this kind",
                             path, most >> 20);
        } else if (used == capacity - 1) {
            char *larger = sn_resize(block, capacity * 2, 1);
            if (!larger)
                status = SN_E_MEMORY;
            else
                block = larger, capacity *= 2;
        }
    }
    fclose(file);
    if (status != SN_OK) {
        sn_free(block);
        return status;
    }
    block[used] = 0;
    *text = block;
    *bytes = used;
    return SN_OK;
}

sn_status sn_text_read(const char *path, size_t most, char **text, size_t *bytes) {
    return sn_file_read(path, most, text, bytes);
}

//---- writing -------------------------------------------------------------------------------------

static void outfile_release(sn_outfile *file) {
    sn_free(file->temporary);
    free(file->path); // realpath's or strdup's
    *file = (sn_outfile){0};
}

// A new file next to file->path: "PATH.PID.N.tmp", so that runs side by side do not meet.
static sn_status open_temporary(sn_outfile *file) {
    static atomic_uint counter;
    size_t length = strlen(file->path) + 64;
    file->temporary = sn_alloc(length, 1);
    if (!file->temporary) return SN_E_MEMORY;
    snprintf(file->temporary, length, "%s.%ld.%u.tmp", file->path, (long)getpid(),
             atomic_fetch_add(&counter, 1u));
    int descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return fail_path(file->path, "cannot write");
    file->stream = fdopen(descriptor, "wb");
    if (file->stream) return SN_OK;
    sn_status status = fail_path(file->path, "cannot write");
    close(descriptor);
    unlink(file->temporary);
    return status;
}

sn_status sn_outfile_open(sn_outfile *file, const char *path) {
    *file = (sn_outfile){0};
    struct stat about;
    bool exists = stat(path, &about) == 0;
    sn_status status = SN_OK;
    if (exists && S_ISDIR(about.st_mode))
        return sn_fail(SN_E_FILE, "%s: cannot write: is a folder", path);
    if (exists && !S_ISREG(about.st_mode)) {
        file->path = strdup(path);
        if (file->path) file->stream = fopen(path, "wbe");
        if (!file->stream) status = fail_path(path, "cannot write");
    } else {
        // a link stays a link: what it points to is replaced
        file->path = exists ? realpath(path, NULL) : strdup(path);
        status = file->path ? open_temporary(file) : fail_path(path, "cannot write");
    }
    if (status != SN_OK) outfile_release(file);
    return status;
}

sn_status sn_outfile_close(sn_outfile *file) {
    sn_status status = SN_OK;
    bool failed = ferror(file->stream) != 0;
    errno = failed ? EIO : 0;
    if (fclose(file->stream) != 0 || failed) status = fail_path(file->path, "cannot write");
    if (file->temporary) {
        if (status == SN_OK && rename(file->temporary, file->path) != 0)
            status = fail_path(file->path, "cannot write");
        if (status != SN_OK) unlink(file->temporary);
    }
    outfile_release(file);
    return status;
}

void sn_outfile_abandon(sn_outfile *file) {
    if (file->stream) fclose(file->stream);
    if (file->temporary) unlink(file->temporary);
    outfile_release(file);
}

sn_status sn_text_write(const char *path, const char *text, size_t bytes) {
    sn_outfile file;
    SN_TRY(sn_outfile_open(&file, path));
    fwrite(text, 1, bytes, file.stream); // an error stays in the stream until it is closed
    return sn_outfile_close(&file);
}

sn_status sn_folder_make(const char *path) {
    size_t length = strlen(path);
    if (length == 0) return sn_fail(SN_E_FILE, "cannot make a folder without a name");
    char *partial = sn_alloc(length + 1, 1);
    if (!partial) return SN_E_MEMORY;
    memcpy(partial, path, length);
    sn_status status = SN_OK;
    for (size_t i = 1; i <= length && status == SN_OK; i++) {
        if (path[i] != '/' && path[i] != 0) continue;
        partial[i] = 0;
        if (mkdir(partial, 0777) != 0 && errno != EEXIST)
            status = fail_path(partial, "cannot make the folder");
        if (i < length) partial[i] = '/';
    }
    sn_free(partial);
    if (status != SN_OK) return status;
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISDIR(about.st_mode))
        return sn_fail(SN_E_FILE, "%s: cannot make the folder: a file of that name exists", path);
    return SN_OK;
}
