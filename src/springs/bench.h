// The body that benchmarks step.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/springs.h"

/// The block of a plan: clamped below, under its weight, E = 10 kPa, 0.1 m wide.
/// @return SN_OK, SN_E_RANGE (counts), SN_E_NAME (law), SN_E_MEMORY.
sn_status sn_springs_bench_case(const sn_springs_bench_plan *plan, sn_case **c);
