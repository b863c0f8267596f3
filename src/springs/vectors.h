// Vectors of many numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>
#include <stdint.h>

/// a . b. The order of the sum is the same on every machine, but not that of the numbers.
double sn_dot(const double *a, const double *b, size_t n);

#define SN_NOISE_START 88172645463325252u
/// The next of numbers without structure, in [-0.5, 0.5): the same everywhere. *state starts at
/// SN_NOISE_START. Source: Marsaglia, Xorshift RNGs, J. Stat. Softw. 8 (2003) 14, of 64 bits.
double sn_noise(uint64_t *state);
