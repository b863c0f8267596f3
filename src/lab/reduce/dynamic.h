// What a sweep and raw sinusoids share: figures of moduli over frequency.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/lab.h"

/// Sorts by frequency and finds slopes, plateaus and the peak of tan delta.
void sn_dynamic_finish(sn_dynamic *dynamic);
