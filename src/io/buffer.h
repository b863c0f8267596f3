// A text that grows: what every writer of io/ fills before one sn_text_write().
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdarg.h>

#include "sinew/base.h"

/// Zeroed to start with. An addition that found no memory makes all later ones do nothing;
/// whoever hands the text on looks at `status` once.
typedef struct sn_buffer {
    char *text; ///< size bytes and a closing zero; NULL before the first addition
    size_t size, capacity;
    sn_status status; ///< SN_OK or SN_E_MEMORY
} sn_buffer;

void sn_buffer_free(sn_buffer *buffer);
void sn_buffer_add(sn_buffer *buffer, const char *text, size_t bytes);
void sn_buffer_text(sn_buffer *buffer, const char *text);
/// As printf; numbers always have a decimal point, whatever the locale of the program.
void sn_buffer_print(sn_buffer *buffer, const char *format, ...) SN_PRINTF(2, 3);
void sn_buffer_vprint(sn_buffer *buffer, const char *format, va_list arguments) SN_PRINTF(2, 0);
/// Text for XML and HTML, inside an element or a quoted attribute: the five marks become entities,
/// control characters blanks. NULL adds nothing.
void sn_buffer_escape(sn_buffer *buffer, const char *text);
/// Bytes as base64 (RFC 4648), padded.
void sn_buffer_base64(sn_buffer *buffer, const void *bytes, size_t count);
