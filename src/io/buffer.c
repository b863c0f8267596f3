// A text that grows, and its encodings.
// SPDX-License-Identifier: Apache-2.0
#include "io/buffer.h"

#include <locale.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

void sn_buffer_free(sn_buffer *buffer) {
    sn_free(buffer->text);
    *buffer = (sn_buffer){0};
}

// Room for `bytes` more and the closing zero.
static bool reserve(sn_buffer *buffer, size_t bytes) {
    if (buffer->status != SN_OK) return false;
    if (bytes < buffer->capacity - buffer->size) return true;
    size_t capacity = 2 * buffer->capacity > 256 ? 2 * buffer->capacity : 256;
    while (capacity - buffer->size <= bytes) {
        if (capacity > SIZE_MAX / 2) {
            buffer->status = SN_E_MEMORY;
            return false;
        }
        capacity *= 2;
    }
    char *text = sn_resize(buffer->text, capacity, 1);
    if (!text) {
        buffer->status = SN_E_MEMORY;
        return false;
    }
    buffer->text = text;
    buffer->capacity = capacity;
    return true;
}

void sn_buffer_add(sn_buffer *buffer, const char *text, size_t bytes) {
    if (!reserve(buffer, bytes)) return;
    if (bytes) memcpy(buffer->text + buffer->size, text, bytes);
    buffer->size += bytes;
    buffer->text[buffer->size] = 0;
}

void sn_buffer_text(sn_buffer *buffer, const char *text) {
    sn_buffer_add(buffer, text, strlen(text));
}

// Prints at the end of the text; gives the length that was needed.
static int print_at_end(sn_buffer *buffer, const char *format, va_list arguments) {
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    locale_t before = plain ? uselocale(plain) : (locale_t)0;
    int length =
        vsnprintf(buffer->text + buffer->size, buffer->capacity - buffer->size, format, arguments);
    if (plain) {
        uselocale(before);
        freelocale(plain);
    }
    return length;
}

void sn_buffer_vprint(sn_buffer *buffer, const char *format, va_list arguments) {
    size_t room = 128;
    while (reserve(buffer, room)) {
        va_list copy;
        va_copy(copy, arguments);
        int length = print_at_end(buffer, format, copy);
        va_end(copy);
        SN_ASSERT(length >= 0);
        if (length < 0) return;
        if ((size_t)length < buffer->capacity - buffer->size) {
            buffer->size += (size_t)length;
            return;
        }
        room = (size_t)length;
    }
}

void sn_buffer_print(sn_buffer *buffer, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    sn_buffer_vprint(buffer, format, arguments);
    va_end(arguments);
}

void sn_buffer_escape(sn_buffer *buffer, const char *text) {
    if (!text) return;
    for (const char *at = text; *at; at++) {
        switch (*at) {
        case '&': sn_buffer_text(buffer, "&amp;"); break;
        case '<': sn_buffer_text(buffer, "&lt;"); break;
        case '>': sn_buffer_text(buffer, "&gt;"); break;
        case '"': sn_buffer_text(buffer, "&quot;"); break;
        case '\'': sn_buffer_text(buffer, "&#39;"); break;
        default:
            // bytes of UTF-8 sequences are negative or large: they pass
            if ((unsigned char)*at < 0x20 || *at == 0x7f)
                sn_buffer_add(buffer, *at == '\n' ? "\n" : " ", 1);
            else
                sn_buffer_add(buffer, at, 1);
        }
    }
}

void sn_buffer_base64(sn_buffer *buffer, const void *bytes, size_t count) {
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (count > SIZE_MAX / 2) buffer->status = SN_E_MEMORY;
    size_t groups = count / 3, left = count % 3;
    if (!reserve(buffer, 4 * (groups + (left > 0)))) return;
    const unsigned char *in = bytes;
    char *out = buffer->text + buffer->size;
    for (size_t g = 0; g < groups; g++, in += 3, out += 4) {
        unsigned word = (unsigned)in[0] << 16 | (unsigned)in[1] << 8 | in[2];
        for (int k = 0; k < 4; k++) out[k] = digit[word >> (18 - 6 * k) & 63];
    }
    if (left) {
        unsigned word = (unsigned)in[0] << 16 | (left == 2 ? (unsigned)in[1] << 8 : 0);
        out[0] = digit[word >> 18 & 63];
        out[1] = digit[word >> 12 & 63];
        out[2] = left == 2 ? digit[word >> 6 & 63] : '=';
        out[3] = '=';
        out += 4;
    }
    *out = 0;
    buffer->size = (size_t)(out - buffer->text);
}
