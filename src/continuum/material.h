// The tissue of every region with the memory of every quadrature point.
// SPDX-License-Identifier: Apache-2.0
// Source: quasi-linear viscoelasticity, equations (32)-(35).
//
// Memory acts on numbers of a point: the six components of the elastic distortional stress S_d and
// one volumetric scalar v, which is K (J - 1) for P1 and P2, and the elastic volume strain theta of
// the pressure for P2P1 (equal to J - 1 after projection on the pressures). Where the fibres have a
// memory of their own, S_d is without them and six more numbers are theirs. Every part of the
// stress has its own exponentials, all the same where the tissue is not branched. Over a step of
// length h the response to the elastic value T is
//     a T + past,   a = g_inf + sum gain_i + viscous/h,
//     past = sum decay_i H_i - (sum gain_i + viscous/h) T_before,
// so that `past` is fixed during Newton's iterations and `a` is the factor of the tangent. H_i and
// T_before change only when a step is accepted (commit).
#pragma once

#include "continuum/space.h"

/// Numbers of a point that have a memory: S_d, v, and S of the fibres.
enum { SN_FE_VOLUME = 6, SN_FE_FIBRES = 7, SN_FE_MEMORY = 13 };

/// The memory of one part of the stress.
typedef struct sn_fe_memory {
    int first, count; ///< its numbers
    sn_exponentials series;
    double factor; ///< a
    double decay[SN_TERMS_MAX], gain[SN_TERMS_MAX];
} sn_fe_memory;

typedef struct sn_fe_material {
    const sn_tissue *tissue;
    sn_tissue split[2]; ///< of the distortional stress: the whole, or the matrix and the fibres
    int splits;         ///< 1 or 2
    int numbers;        ///< that have a memory: SN_FE_FIBRES or SN_FE_MEMORY
    double bulk;        ///< Pa; INFINITY where incompressible
    bool remembers;     ///< false: G = 1
    double step;        ///< h of the step being tried, s; 0 for an instantaneous one
    sn_fe_memory part[SN_PARTS];
} sn_fe_material;

typedef struct sn_fe_materials {
    int count; ///< regions
    sn_fe_material *material;
    bool remembers; ///< any of them
    bool viscous;   ///< any has a viscous part (Voigt)
    /// Of every batch: past, before, each numbers x SN_FE_POINTS, then H_1 … of each part, each its
    /// count x SN_FE_POINTS; no room where the batch does not remember.
    double *state;
    size_t numbers; ///< in `state`
    size_t *at;     ///< first number of a batch                           (batches)
} sn_fe_materials;

/// Checks the laws and reduces the memories to exponentials over [shortest, until] seconds.
/// @return SN_OK, SN_E_UNSUPPORTED (not a solid law; incompressible without pressures), SN_E_RANGE.
sn_status sn_fe_materials_create(const sn_case *c, const sn_fe_space *s, double shortest,
                                 sn_fe_materials **out);
void sn_fe_materials_destroy(sn_fe_materials *m); // NULL is allowed
/// How many numbers of a point `state` holds for a material.
size_t sn_fe_material_kept(const sn_fe_material *m);
/// Starts a step of h seconds (0: instantaneous): factors, and `past` of every point.
void sn_fe_materials_begin(sn_fe_materials *m, const sn_fe_space *s, double h);
/// `past` of a batch, (numbers x SN_FE_POINTS), or NULL where it does not remember.
static inline const double *sn_fe_materials_past(const sn_fe_materials *m, const sn_fe_space *s,
                                                 int batch) {
    return m->material[s->batch_region[batch]].remembers ? m->state + m->at[batch] : NULL;
}
/// Accepts the step for one batch: `elastic` is T at its end (numbers x SN_FE_POINTS).
void sn_fe_materials_commit(sn_fe_materials *m, const sn_fe_space *s, int batch,
                            const double *elastic);
