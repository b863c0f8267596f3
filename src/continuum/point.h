// Quadrature points: from displacements and pressures to strain, stress and consistent tangent.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (16), (33); e.g. Holzapfel, Nonlinear solid mechanics (2000), chapters 6 and 8.
//
// In material axes, with M the displacement gradient, F = I + M, E = sym M + M^T M / 2 and
// J - 1 = tr M + II(M) + det M (no difference of nearly equal numbers at small strain):
//     S = H_d[S_d(E)] + H_f[S_f(E)] + p J C^{-1},   p = H_v[K (J - 1)]  or the unknown pressure,
//     dS/dE = a_d D_d + a_f D_f + p J (C^{-1} (x) C^{-1} - 2 I_{C^{-1}})
//             (+ a_v K J C^{-1} (x) J C^{-1}),
// S_f the fibres where they have a memory of their own, else 0. p is positive in tension. The
// equation of the unknown pressure is
//     g = J - 1 + past/a_v - p/(a_v K) = 0,
// divided by the factor a_v of the volumetric memory so that the matrix is symmetric; 1/K = 0 where
// the tissue is incompressible, and there is then no volumetric memory.
#pragma once

#include "continuum/material.h"

/// Values at the points of one batch: [component * SN_FE_POINTS + point], material axes.
typedef struct sn_fe_points {
    double weight[SN_FE_POINTS]; ///< rest volume, m3
    double M[9 * SN_FE_POINTS];  ///< displacement gradient, row-major
    double E[6 * SN_FE_POINTS];  ///< Green strain
    double J1[SN_FE_POINTS];     ///< J - 1
    double Ci[6 * SN_FE_POINTS]; ///< C^{-1}
    double p[SN_FE_POINTS];      ///< pressure-like stress, positive in tension, Pa
    double g[SN_FE_POINTS];      ///< equation of the unknown pressure; mixed element
    double W[SN_FE_POINTS];      ///< elastic energy density, distortional and volumetric, J/m3
    double T[SN_FE_MEMORY * SN_FE_POINTS]; ///< elastic values that are remembered
    double S[6 * SN_FE_POINTS];            ///< second Piola-Kirchhoff stress with memory, Pa
    double D[21 * SN_FE_POINTS];           ///< consistent tangent dS/de, Pa
} sn_fe_points;

/// What to compute beyond the stress; the last leaves out all that the unknown pressure does.
enum { SN_FE_ENERGY = 1, SN_FE_TANGENT = 2, SN_FE_UNPRESSED = 4 };

/// Where an evaluation failed.
typedef struct sn_fe_fault {
    int cell; ///< of the mesh
    double J; ///< its volume ratio, NAN where a stress overflowed
} sn_fe_fault;

/// Displacements of the nodes of a batch in material axes.
/// @param u  (nodes x 3 x cells)
void sn_fe_gather(const sn_fe_space *s, int batch, const double *x, double *u);
/// Evaluates one batch. @return false with *fault where a cell is turned inside out or a stress is
/// not finite; only `fault` is then of use.
bool sn_fe_points_at(const sn_fe_space *s, const sn_fe_materials *m, int batch, const double *x,
                     unsigned what, sn_fe_points *out, sn_fe_fault *fault);
