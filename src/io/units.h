// Units inside io: a unit resolved once for many numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/io.h"

/// si = factor * x + offset. Where the factor is the inverse of a whole number (mm, ms) it divides
/// by that number, so that "3 mm" and "0.003 m" are the same double.
double sn_unit_apply(double x, double factor, double offset);

/// What a quantity of this SI unit looks like, for messages: `a pressure such as "10 kPa"`.
/// `out` holds SN_NAME_MAX bytes.
void sn_unit_example(const char *si_unit, char out[SN_NAME_MAX]);

/// Prints a value in SI as a quantity a person would write ("20 kPa", "10 ms", "0.3") that reads
/// back as the same double. `out` holds SN_NAME_MAX bytes.
void sn_quantity_print(double value, const char *si_unit, char out[SN_NAME_MAX]);
