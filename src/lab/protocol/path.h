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
    SN_PULL_LATERAL,  ///< the lateral stretches are solved for at every instant
    SN_PULL_STRIP     ///< a membrane: the free side follows from the stretch
} sn_pull;

/// Chooses the way. @return SN_OK, SN_E_UNSUPPORTED (shear under a pull), SN_E_RANGE.
sn_status sn_pull_choose(const sn_tissue *tissue, sn_pull *pull);
/// Refuses a solid law whose axes do not stay at right angles when they are stretched.
/// @return SN_OK, SN_E_UNSUPPORTED, SN_E_RANGE (no usable stress).
sn_status sn_pull_straight(const sn_tissue *tissue);

/// The memory of every part of a tissue as exponentials; all the same where it is not branched.
/// @param viscous  whether any of them has a viscous part (Voigt). @return SN_OK, SN_E_RANGE.
sn_status sn_path_memory(const sn_tissue *tissue, sn_exponentials e[SN_PARTS], bool *viscous);

/// Elastic channels S11 and S22 of SN_PULL_CLOSED, Pa, with their slopes over the stretch.
/// @param value, slope  (2 x points). @return SN_OK or SN_E_MEMORY.
sn_status sn_pull_closed(const sn_tissue *tissue, int points, const double *stretch, double *value,
                         double *slope);

/// Elastic channel S11, Pa, of a membrane strip (SN_PULL_STRIP) with its slope over the stretch.
/// The free side has S22 = 0 at every instant, so its hereditary integral is 0 as well: the nominal
/// stress is L H[S11].
/// @param value, slope  (points). @return SN_OK, SN_E_SOLVER (no free side), SN_E_MEMORY.
sn_status sn_pull_strip(const sn_tissue *tissue, int points, const double *stretch, double *value,
                        double *slope);

/// Nominal stress, Pa, at the recorded times, with `level` times the coarsest steps. A smooth
/// function of the tissue's constants at a given level, as a fit needs it.
/// @param e  the tissue's memory as exponentials; where it is branched, of every part  (SN_PARTS)
/// @return SN_OK, SN_E_RANGE (a step under a Voigt memory), SN_E_SOLVER (lateral), SN_E_MEMORY.
sn_status sn_path_stress(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                         const sn_exponentials *e, int level, double *stress);

/// What sn_path_stress() takes, in one.
typedef struct sn_pulled {
    const sn_path *path;
    const sn_tissue *tissue;
    sn_pull pull;
    const sn_exponentials *e;
    int level;
} sn_pulled;
/// Some constants of a tissue, by their places among the values of law and memory.
typedef struct sn_constants {
    int law_count, memory_count;
    int law[SN_FIT_PARAMS_MAX], memory[SN_FIT_PARAMS_MAX];
} sn_constants;

/// Derivatives of sn_path_stress() by constants, those of the law first, each over its own unit.
/// @param slopes  Pa over the unit of the constant    (law_count + memory_count) x records
/// Not for SN_PULL_STRIP, nor branched tissues. @return as sn_path_stress().
sn_status sn_path_slopes(const sn_pulled *pulled, const sn_constants *by, double *slopes);
/// The part of sn_path_slopes() for SN_PULL_UNIAXIAL and SN_PULL_CLOSED.
sn_status sn_path_slopes_known(const sn_pulled *pulled, const sn_constants *by, double *slopes);
/// The part of sn_path_slopes() for SN_PULL_LATERAL.
sn_status sn_path_slopes_lateral(const sn_pulled *pulled, const sn_constants *by, double *slopes);

/// The part of sn_path_stress() for every way but SN_PULL_LATERAL: error of fourth order in
/// the step, whatever the relaxation times.
sn_status sn_path_stress_known(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                               const sn_exponentials *e, int level, double *stress);
/// Stretch at the recorded times of a path whose driving number is the nominal stress, Pa, with
/// `level` steps an interval, or what sn_path_block() takes. Second order in the step (first under
/// a Voigt memory).
/// @return SN_OK, SN_E_SOLVER (no stretch carries the stress), SN_E_MEMORY.
sn_status sn_path_stretch(const sn_path *path, const sn_tissue *tissue, sn_pull pull,
                          const sn_exponentials *e, int level, double *stretch);
/// The part of sn_path_stress() for SN_PULL_LATERAL: second order in the step.
sn_status sn_path_stress_lateral(const sn_path *path, const sn_tissue *tissue,
                                 const sn_exponentials *e, int level, double *stress);

/// The faces of a block of a solid law, across its three axes: each is held at a stretch or loaded
/// with a nominal stress, Pa, at + per * (the path's driving number).
typedef struct sn_faces {
    bool held[3]; ///< at a stretch; the third face of an incompressible solid is free: load 0
    double at[3], per[3];
} sn_faces;
/// Pulled along the first axis, the sides free.
extern const sn_faces sn_faces_pulled;
/// A block at an instant.
typedef struct sn_block_row {
    double stretch[3]; ///< [1]
    double stress[3];  ///< nominal, Pa
} sn_block_row;
/// The block along a path, at all its instants, with `level` times the coarsest steps: the
/// stretches that are not held are solved for. Second order in the step (first under a Voigt
/// memory). The volume stress is a channel of its own beside those of the distortional stress.
/// @param e  the tissue's memory as exponentials; where it is branched, of every part  (SN_PARTS)
/// @param row                                                             (path->count)
/// @return SN_OK, SN_E_SOLVER (no equilibrium).
sn_status sn_path_block(const sn_path *path, const sn_tissue *tissue, const sn_faces *faces,
                        const sn_exponentials *e, int level, sn_block_row *row);
/// A block that has been pulled to a stretch (sn_faces_pulled) and held for ever: where its sides
/// stand. Parts that relax differently must all keep a share, G(infinity) > 0. The stresses are
/// relaxed ones where the tissue is branched, instantaneous ones where it is not.
/// @param e  as in sn_path_block(). @return SN_OK, SN_E_SOLVER (no equilibrium).
sn_status sn_path_held(const sn_tissue *tissue, const sn_exponentials *e, double stretch,
                       sn_block_row *row);
