// Status texts, the thread's error text, asserts.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/base.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ERROR_TEXT_MAX 1024

static _Thread_local char error_text[ERROR_TEXT_MAX];
static sn_assert_handler *assert_handler;

const char *sn_version(void) {
    return SINEW_VERSION;
}

const char *sn_status_text(sn_status status) {
    static const char *const text[] = {
#define STATUS_TEXT(code, words) [code] = words,
        SN_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
    };
    if ((int)status < 0 || status >= SN_STATUS_COUNT) return "unknown status";
    return text[status];
}

const char *sn_error_text(void) {
    return error_text;
}

sn_status sn_fail(sn_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error_text, sizeof error_text, format, arguments);
    va_end(arguments);
    return status;
}

sn_status sn_fail_within(sn_status status, const char *format, ...) {
    char inner[ERROR_TEXT_MAX];
    memcpy(inner, error_text, sizeof inner);
    va_list arguments;
    va_start(arguments, format);
    int used = vsnprintf(error_text, sizeof error_text, format, arguments);
    va_end(arguments);
    if (used >= 0 && (size_t)used < sizeof error_text)
        snprintf(error_text + used, sizeof error_text - (size_t)used, ": %s", inner);
    return status;
}

void sn_set_assert_handler(sn_assert_handler *handler) {
    assert_handler = handler;
}

void sn_assert_failed(const char *condition, const char *file, int line) {
    if (assert_handler) {
        assert_handler(condition, file, line);
        return;
    }
    fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
    abort();
}
