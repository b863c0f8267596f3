// Text from outside made fit for a message, and numbers read the same way under every locale.
// SPDX-License-Identifier: Apache-2.0
#include "io/text.h"

#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHOWN_MAX 48

// Length of the well-formed UTF-8 character at s, 0 where it is broken.
// Source: The Unicode Standard, table 3-7.
static int utf8_length(const unsigned char *s) {
    if (s[0] < 0x80) return 1;
    int length = s[0] >= 0xC2 && s[0] <= 0xDF   ? 2
                 : s[0] >= 0xE0 && s[0] <= 0xEF ? 3
                 : s[0] >= 0xF0 && s[0] <= 0xF4 ? 4
                                                : 0;
    for (int i = 1; i < length; i++)
        if ((s[i] & 0xC0) != 0x80) return 0;
    if (s[0] == 0xE0 && s[1] < 0xA0) return 0; // overlong
    if (s[0] == 0xED && s[1] > 0x9F) return 0; // surrogates
    if (s[0] == 0xF0 && s[1] < 0x90) return 0; // overlong
    if (s[0] == 0xF4 && s[1] > 0x8F) return 0; // beyond U+10FFFF
    return length;
}

bool sn_text_is_utf8(const char *text) {
    const unsigned char *s = (const unsigned char *)text;
    while (*s) {
        int length = utf8_length(s);
        if (length == 0) return false;
        s += length;
    }
    return true;
}

sn_quote sn_text_quote(const char *text) {
    sn_quote quote;
    size_t used = 0;
    const unsigned char *s = (const unsigned char *)text;
    while (*s && used < SHOWN_MAX) {
        int length = utf8_length(s);
        if (length < 2) {
            quote.text[used++] = length == 0 || *s < 0x20 || *s == 0x7F ? '?' : (char)*s;
            s++;
            continue;
        }
        bool c1_control = s[0] == 0xC2 && s[1] < 0xA0;
        if (c1_control) {
            quote.text[used++] = '?';
        } else {
            memcpy(quote.text + used, s, (size_t)length);
            used += (size_t)length;
        }
        s += length;
    }
    snprintf(quote.text + used, sizeof quote.text - used, "%s", *s ? "…" : "");
    return quote;
}

// Bytes of the blank at s: space, tab or the two bytes of a no-break space.
static int blank_length(const char *s) {
    if (*s == ' ' || *s == '\t') return 1;
    return s[0] == '\xC2' && s[1] == '\xA0' ? 2 : 0;
}

char *sn_text_trim(char *text) {
    while (blank_length(text)) text += blank_length(text);
    size_t length = strlen(text);
    for (;;) {
        if (length >= 1 && blank_length(text + length - 1) == 1)
            length -= 1;
        else if (length >= 2 && blank_length(text + length - 2) == 2)
            length -= 2;
        else
            break;
    }
    text[length] = 0;
    return text;
}

static locale_t c_locale;
static void make_locale(void) {
    c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

// The "C" locale, made once: the program around us may run under one with decimal commas.
static locale_t plain_locale(void) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_locale);
    return c_locale;
}

const char *sn_number_parse(const char *text, double *value, const char **end) {
    // strtod also takes blanks, nan, inf and 0x1p3: let nothing but decimal digits through
    const char *s = text + (*text == '+' || *text == '-');
    bool digit = isdigit((unsigned char)s[0]) || (s[0] == '.' && isdigit((unsigned char)s[1]));
    if (!digit) return "not a number";
    if (s[0] == '0' && (s[1] == 'x' || s[1] == 'X')) return "a hexadecimal number";
    locale_t locale = plain_locale();
    if (!locale) return "out of memory";
    char *stop;
    double x = strtod_l(text, &stop, locale);
    if (!isfinite(x)) return "a number too large";
    *value = x;
    *end = stop;
    return NULL;
}

void sn_number_format(double value, int digits, char out[32]) {
    locale_t locale = plain_locale();
    locale_t before = locale ? uselocale(locale) : (locale_t)0;
    snprintf(out, 32, "%.*g", digits, value);
    if (before) uselocale(before);
}

void sn_number_print(double value, int digits, char out[32]) {
    double back;
    const char *end;
    do {
        sn_number_format(value, digits, out);
    } while (digits++ < 17 && (sn_number_parse(out, &back, &end) != NULL || back != value));
}
