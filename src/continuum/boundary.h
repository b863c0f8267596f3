// What acts on the body from outside: gravity, traction, follower pressure, tools.
// SPDX-License-Identifier: Apache-2.0
//
// Traction and gravity are dead: constant nodal forces times a factor of time. A pressure p pushes
// inwards on the deformed surface, with x(xi, eta) its position (outward normal x,xi x x,eta):
//     f_a = -p int N_a x,xi x x,eta dxi deta,
//     -df_a/dx_b = p int N_a (N_b,xi e x x,eta + x,xi x N_b,eta e) dxi deta,
// an unsymmetric tangent. Tools touch the surface "boundary" at contact points with
// sn_tool_contact(): for P1 the nodes with a third of their faces' areas (the rule of the springs),
// for P2 the six points of the faces' quadrature rule. With friction the tangent is
// unsymmetric; Newton needs it whole, or crawls where it slips.
#pragma once

#include "continuum/pattern.h"

/// A place where tools may touch.
typedef struct sn_fe_spot {
    int count; ///< nodes: 1 or 6
    int node[SN_FE_FACE_NODES];
    double shape[SN_FE_FACE_NODES];
    double area; ///< rest area, m2
} sn_fe_spot;

typedef struct sn_fe_boundary {
    double *gravity;      ///< nodal forces, N; NULL without gravity; at first of the cells of this
                          ///< rank alone                               (3 x nodes)
    double **traction;    ///< nodal forces of tractions and forces at factor 1, else NULL  (loads)
    sn_fe_faces *pressed; ///< faces of pressure loads                  (loads)
    bool symmetric;       ///< the tangent: no pressure, no friction
    double penalty;       ///< Pa/m
    int spots;
    sn_fe_spot *spot;
    sn_contact *before, *after; ///< memory of contact (tools x spots)
    double (*tool_force)[3];    ///< force of the tissue on the tool, N (tools)
} sn_fe_boundary;

sn_status sn_fe_boundary_create(const sn_case *c, const sn_fe_space *s, sn_fe_boundary **out);
void sn_fe_boundary_destroy(sn_fe_boundary *b, const sn_case *c); // NULL is allowed

/// The external forces at time t, all loads times `scale`.
/// @param x         unknowns                                                     (dofs)
/// @param external  forces on the body are added, N                              (dofs)
/// @param matrix    Nullable: gets -d external / dx added
void sn_fe_boundary_apply(sn_fe_boundary *b, const sn_case *c, const sn_fe_space *s, double t,
                          double scale, const double *x, double *external,
                          const sn_fe_matrix *matrix);
/// Forces of one load at factor 1, or of gravity (load -1), added to `external`.
void sn_fe_boundary_load(const sn_fe_boundary *b, const sn_case *c, const sn_fe_space *s, int load,
                         const double *x, double *external);
/// Accepts the contact of the last sn_fe_boundary_apply().
void sn_fe_boundary_commit(sn_fe_boundary *b, const sn_case *c);
