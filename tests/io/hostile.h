// Hostile inputs and mutations for the tests of readers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scratch.h"
#include "sinew/io.h"

/// A reader under test: reads a file and gives up what it read. A value that is not finite must
/// fail the test inside.
typedef sn_status read_function(const char *path);

/// An input that must be refused: status, and two parts of the message (the second Nullable).
typedef struct hostile {
    const char *text;
    sn_status status;
    const char *part, *part2;
} hostile;

/// The message is one line, not empty, and names the file.
static inline bool message_useful(const char *file) {
    const char *text = sn_error_text();
    return *text && strstr(text, file) && !strpbrk(text, "\r\n");
}

static inline void check_hostile(read_function *read, const char *file, const hostile *table,
                                 int count) {
    int bad = 0;
    for (int k = 0; k < count; k++) {
        const hostile *h = &table[k];
        const char *path = scratch_write(file, h->text, strlen(h->text));
        sn_fail(SN_OK, "%s", "");
        sn_status status = read(path);
        bool good = status == h->status && message_useful(file) &&
                    strstr(sn_error_text(), h->part) &&
                    (!h->part2 || strstr(sn_error_text(), h->part2));
        if (good && !getenv("SINEW_SHOW")) continue;
        bad += !good;
        print_message("input %d of %d: %.60s…\n  status %d, expected %d\n  text \"%s\"\n  expected "
                      "\"%s\" \"%s\"\n",
                      k + 1, count, h->text, (int)status, (int)h->status, sn_error_text(), h->part,
                      h->part2 ? h->part2 : "");
    }
    assert_int_equal(bad, 0);
}

/// Reads bytes that may be anything: success, or a useful message. @return whether it was read.
static inline bool check_survives(read_function *read, const char *file, const char *text,
                                  size_t bytes) {
    const char *path = scratch_write(file, text, bytes);
    sn_fail(SN_OK, "%s", "");
    sn_status status = read(path);
    if (status != SN_OK && !message_useful(file)) {
        print_message("status %d, text \"%s\" for:\n%.*s\n", (int)status, sn_error_text(),
                      (int)bytes, text);
        fail();
    }
    return status == SN_OK;
}

/// Every prefix of a valid file, then `count` mutations of it: one to four bytes replaced, added or
/// taken away, half of them characters that mean something to the reader.
static inline void check_fuzz(read_function *read, const char *file, const char *text, int count) {
    static const char sharp[] = "-+.,;:#%&*!|>'\"[]{}()eExn019 \t\n\r";
    size_t length = strlen(text);
    int read_well = 0;
    for (size_t n = 0; n < length; n++) check_survives(read, file, text, n);
    uint64_t seed = 0x9E3779B97F4A7C15u;
    char *copy = malloc(length + 8);
    for (int k = 0; k < count; k++) {
        memcpy(copy, text, length);
        size_t n = length;
        int changes = 1 + (int)check_random(&seed, 0, 4);
        for (int i = 0; i < changes; i++) {
            size_t at = (size_t)check_random(&seed, 0, (double)n);
            bool meaning = check_random(&seed, 0, 1) < 0.5;
            char byte = meaning ? sharp[(size_t)check_random(&seed, 0, sizeof sharp - 1)]
                                : (char)(int)check_random(&seed, 0, 256);
            int kind = (int)check_random(&seed, 0, 3);
            if (kind == 0) copy[at] = byte;
            if (kind == 1) memmove(copy + at + 1, copy + at, n++ - at), copy[at] = byte;
            if (kind == 2) memmove(copy + at, copy + at + 1, --n - at);
        }
        read_well += check_survives(read, file, copy, n);
    }
    free(copy);
    // not vacuous: some changes are harmless, most are not
    if (getenv("SINEW_SHOW")) print_message("%d of %d mutations were read\n", read_well, count);
    assert_in_range(read_well, 1, count / 2);
}
