// What the protocols share inside the laboratory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/lab.h"

/// Holds all parameters of a protocol against its table. @return SN_OK or SN_E_RANGE.
sn_status sn_protocol_check(const sn_protocol *protocol);
/// Checks a protocol with `from` and `to` and gives the values of its sweep, evenly spaced in the
/// logarithm, both ends included, in *value (sn_alloc'd, protocol->points of them).
/// @return SN_OK, SN_E_RANGE, SN_E_MEMORY.
sn_status sn_protocol_sweep(const sn_protocol *protocol, double **value);

/// Rows of a ramp and hold: a third over the ramp, the others spaced by the logarithm of the time
/// since its end, from a twentieth of the ramp or a hundredth of the hold, whichever is shorter.
/// @param time  seconds from the start of the ramp, points >= 3           (points)
void sn_protocol_hold_times(int points, double ramp, double hold, double *time);

/// The tests behind sn_lab_test() that are no plain uniaxial motion. They append their columns and
/// rows to an empty record.
sn_status sn_test_hysteresis(const sn_tissue *tissue, const sn_protocol *p, sn_record *record);
sn_status sn_test_dynamic(const sn_tissue *tissue, const sn_protocol *p, sn_record *record);
sn_status sn_test_creep(const sn_tissue *tissue, const sn_protocol *p, sn_record *record);
/// Moduli of a small oscillation about a stretch held for ever, d(nominal stress)/d(stretch), Pa,
/// of one axis pulled with free sides. A smooth function of the tissue's constants.
/// @param frequency  Hz, above 0                                                (n)
/// @param storage, loss  the real and the imaginary part                        (n)
/// @return SN_OK, SN_E_UNSUPPORTED (law), SN_E_RANGE (overflow), SN_E_SOLVER (no free sides).
sn_status sn_dynamic_moduli(const sn_tissue *tissue, double stretch, int n, const double *frequency,
                            double *storage, double *loss);
/// Biaxial and shear.
sn_status sn_test_plane(const sn_tissue *tissue, const sn_protocol *p, sn_record *record);
