// Text from outside made fit for a message, and numbers read the same way under every locale.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/base.h"

/// Bytes of a quoted text with its closing zero.
#define SN_QUOTE_MAX 64

/// What was found, fit for one line of a message: at most 48 bytes, cut at a whole character and
/// marked with "…", control characters and broken UTF-8 replaced by "?".
typedef struct sn_quote {
    char text[SN_QUOTE_MAX];
} sn_quote;
sn_quote sn_text_quote(const char *text);

/// True where the bytes are well-formed UTF-8.
bool sn_text_is_utf8(const char *text);
/// Cuts spaces and tabs (and no-break spaces at the ends) off in place; returns the first
/// character left.
char *sn_text_trim(char *text);

/// Reads a decimal number at the start of `text` with a decimal point, whatever the locale:
/// [+-]digits[.digits][e[+-]digits]. Hexadecimal, nan, inf and numbers that overflow are refused.
/// @param end  first character after the number
/// @return NULL, or what is wrong in a few words ("not a number", "a number too large")
const char *sn_number_parse(const char *text, double *value, const char **end);

/// Prints with a number of significant digits and a decimal point, whatever the locale.
void sn_number_format(double value, int digits, char out[32]);
/// Prints with at least `digits` significant digits and as many more as it takes to read back as
/// the same double.
void sn_number_print(double value, int digits, char out[32]);
