// Vectors of many numbers.
// SPDX-License-Identifier: Apache-2.0
#include "springs/vectors.h"

enum { APART = 16 }; // sums that do not wait for each other

double sn_dot(const double *a, const double *b, size_t n) {
    double part[APART] = {0}, sum = 0.0;
    size_t i = 0;
    for (; i + APART <= n; i += APART)
        for (size_t k = 0; k < APART; k++) part[k] += a[i + k] * b[i + k];
    for (; i < n; i++) part[0] += a[i] * b[i];
    for (size_t k = 0; k < APART; k++) sum += part[k];
    return sum;
}

double sn_noise(uint64_t *state) {
    uint64_t x = *state;
    x ^= x << 13;
    x ^= x >> 7;
    x ^= x << 17;
    *state = x;
    return (double)(x >> 11) / 9007199254740992.0 - 0.5;
}
