// A test laid out in time, and the stress of a tissue along it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/lab.h"

/// The instants of a test: knots of the history and times of the record, merged. The stretch (or
/// whatever drives the test) is linear between them, so every corner of the motion and every
/// recorded time is an instant.
typedef struct sn_path {
    int count;       ///< number of instants
    double *time;    ///< seconds, strictly rising                     (count)
    double *stretch; ///< [1]; the first after the step, if there is one (count)
    int records;     ///< number of recorded times
    int *record;     ///< instant of each; -1: before the start        (records)
    double range;    ///< largest less smallest stretch, rest included
    double rest;     ///< where nothing is stressed
} sn_path;

/// Lays out a test that is driven by one number, `rest` before it starts.
/// @return SN_OK, SN_E_DATA (time not finite), SN_E_MEMORY.
sn_status sn_path_lay(const sn_history *motion, double rest, int n, const double *time,
                      sn_path **path);
/// Lays out a test driven by a stretch. @return SN_OK, SN_E_DATA (time not finite), SN_E_RANGE
/// (stretch not above 0), SN_E_MEMORY.
sn_status sn_path_create(const sn_history *stretch, int n, const double *time, sn_path **path);
void sn_path_destroy(sn_path *path); // NULL is allowed

/// How a tissue is pulled.
typedef enum sn_pull {
    SN_PULL_UNIAXIAL, ///< a uniaxial law: nominal stress is a function of the stretch
    SN_PULL_CLOSED,   ///< incompressible, both lateral directions alike: lateral stretch is known
    SN_PULL_LATERAL   ///< the lateral stretches are solved for at every instant
} sn_pull;

/// Chooses the way. @return SN_OK, SN_E_UNSUPPORTED (membrane law; shear under a pull), SN_E_RANGE.
sn_status sn_pull_choose(const sn_tissue *tissue, sn_pull *pull);

/// The memory of every part of a tissue as exponentials; all the same where it is not branched.
/// @param viscous  whether any of them has a viscous part (Voigt). @return SN_OK, SN_E_RANGE.
sn_status sn_path_memory(const sn_tissue *tissue, sn_exponentials e[SN_PARTS], bool *viscous);

/// Elastic channels S11 and S22 of SN_PULL_CLOSED, Pa, with their slopes over the stretch.
/// @param value, slope  (2 x points). @return SN_OK or SN_E_MEMORY.
sn_status sn_pull_closed(const sn_tissue *tissue, int points, const double *stretch, double *value,
                         double *slope);

/// Nominal stress, Pa, at the recorded times, with `level` times the coarsest steps. A smooth
/// function of the tissue's constants at a given level, as a fit needs it.
/// @param e  the tissue's memory as exponentials; where it is branched, of every part  (SN_PARTS)
/// @return SN_OK, SN_E_RANGE (a step under a Voigt memory), SN_E_SOLVER (lateral), SN_E_MEMORY.
sn_status sn_path_stress(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                         const sn_exponentials *e, int level, double *stress);

/// The part of sn_path_stress() for SN_PULL_UNIAXIAL and SN_PULL_CLOSED: error of fourth order in
/// the step, whatever the relaxation times.
sn_status sn_path_stress_known(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                               const sn_exponentials *e, int level, double *stress);
/// Stretch at the recorded times of a path whose driving number is the nominal stress, Pa, with
/// `level` steps an interval. SN_PULL_UNIAXIAL and SN_PULL_CLOSED; second order in the step (first
/// under a Voigt memory).
/// @return SN_OK, SN_E_SOLVER (no stretch carries the stress), SN_E_MEMORY.
sn_status sn_path_stretch(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                          const sn_exponentials *e, int level, double *stretch);
/// The part of sn_path_stress() for SN_PULL_LATERAL: second order in the step.
sn_status sn_path_stress_lateral(const sn_path *path, const sn_tissue *tissue,
                                 const sn_exponentials *e, int level, double *stress);
