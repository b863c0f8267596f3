// Cells: nodal forces and tangent matrices from the values at the quadrature points.
// SPDX-License-Identifier: Apache-2.0
//
// Forces and tangents are first formed for the four barycentric coordinates ("corners"), where all
// elements look like the linear one, and mixed by the slopes dN_a/dlambda_k afterwards (element.h).
// The gradients of the four sum to zero, so that three of them are enough.
#pragma once

#include "continuum/pattern.h"
#include "continuum/point.h"

#define SN_FE_LANES 8 ///< cells whose tangents are formed together

/// Room for the work on one batch.
typedef struct sn_fe_work {
    sn_fe_points points;
    double force[3 * SN_FE_NODES * SN_FE_POINTS];         ///< (nodes x 3 x cells)
    double flux[4 * SN_FE_POINTS];                        ///< pressure equations (4 x cells)
    double corner[16][9 * SN_FE_LANES];                   ///< tangent of the lambda_k at a point
    double cofactor[12 * SN_FE_LANES];                    ///< cof F grad lambda_k at a point
    double K[SN_FE_NODES * SN_FE_NODES][9 * SN_FE_LANES]; ///< upper half used
    double L[SN_FE_NODES * 4][3 * SN_FE_LANES];           ///< displacement-pressure
    double M[16][SN_FE_LANES];                            ///< pressure-pressure
} sn_fe_work;

/// Adds the internal forces of a batch to `residual` (dofs).
void sn_fe_cell_forces(const sn_fe_space *s, int batch, sn_fe_work *work, double *residual);
/// Adds the tangent of a batch to the matrix.
void sn_fe_cell_tangent(const sn_fe_space *s, const sn_fe_material *m, int batch, sn_fe_work *work,
                        const sn_fe_matrix *matrix);
