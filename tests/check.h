// What cmocka lacks for numbers. Every check prints value, expected and error when it fails;
// SINEW_SHOW=1 prints all of them, so that a tolerance can be held against the true residual.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "sinew/base.h"

static inline void check_number(double value, double expected, double error, double tolerance,
                                const char *what, const char *file, int line) {
    bool good = error <= tolerance; // false for NaN
    if (!good || getenv("SINEW_SHOW"))
        print_message("%s:%d: %s: %.17g, expected %.17g, error %.3g, tolerance %.3g\n", file, line,
                      what, value, expected, error, tolerance);
    if (!good) fail();
}

/// |value - expected| <= tolerance * |expected|
#define CHECK_REL(value, expected, tolerance)                                                      \
    do {                                                                                           \
        double check_v_ = (value), check_e_ = (expected);                                          \
        check_number(check_v_, check_e_, fabs(check_v_ - check_e_) / fabs(check_e_), (tolerance),  \
                     #value, __FILE__, __LINE__);                                                  \
    } while (0)
/// |value - expected| <= tolerance
#define CHECK_ABS(value, expected, tolerance)                                                      \
    do {                                                                                           \
        double check_v_ = (value), check_e_ = (expected);                                          \
        check_number(check_v_, check_e_, fabs(check_v_ - check_e_), (tolerance), #value, __FILE__, \
                     __LINE__);                                                                    \
    } while (0)
/// The call must give SN_OK.
#define CHECK_OK(call)                                                                             \
    do {                                                                                           \
        sn_status check_s_ = (call);                                                               \
        if (check_s_ != SN_OK) {                                                                   \
            print_message("%s:%d: %s: %s\n", __FILE__, __LINE__, #call, sn_error_text());          \
            fail();                                                                                \
        }                                                                                          \
    } while (0)
/// The call must give `status`, and the stored text must contain `part`.
#define CHECK_FAILS(call, status, part)                                                            \
    do {                                                                                           \
        sn_status check_s_ = (call);                                                               \
        if (check_s_ != (status) || !strstr(sn_error_text(), (part))) {                            \
            print_message("%s:%d: %s: status %d, text \"%s\", expected status %d with \"%s\"\n",   \
                          __FILE__, __LINE__, #call, (int)check_s_, sn_error_text(),               \
                          (int)(status), (part));                                                  \
            fail();                                                                                \
        }                                                                                          \
    } while (0)

/// Random numbers that are the same everywhere (xorshift64*), in [low, high).
static inline double check_random(uint64_t *seed, double low, double high) {
    uint64_t x = *seed;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    *seed = x;
    return low + (high - low) * (double)((x * 2685821657736338717ull) >> 11) / 9007199254740992.0;
}
