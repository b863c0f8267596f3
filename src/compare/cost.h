// What a model costs: memory of a run, and time of live frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/compare.h"

/// Begins to watch the peak of the process's memory. @return what is in use now, bytes; 0 where the
/// system does not say.
double sn_memory_watch(void);
/// Peak since sn_memory_watch(), above what it returned, bytes; 0: not known.
double sn_memory_peak(double before);

/// Steps the net of a case for a tenth of a second or 200 frames of 1 ms, five at least, from rest.
/// A case that its explicit engine refuses leaves live->step_s NAN.
void sn_live_measure(const sn_case *c, sn_live *live);
