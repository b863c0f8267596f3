// Inertia: the consistent mass and the generalised-alpha method.
// SPDX-License-Identifier: Apache-2.0
// Source: Chung & Hulbert, J. Appl. Mech. 60 (1993) 371.
//
// With r = internal minus external forces (without inertia) and rho the spectral radius at infinite
// frequency, a step of length h solves for u_{n+1}
//     M [(1 - am) a_{n+1} + am a_n] + (1 - af) r_{n+1} + af r_n = 0,
//     u_{n+1} = u_n + h v_n + h^2 [(1/2 - beta) a_n + beta a_{n+1}],
//     v_{n+1} = v_n + h [(1 - gamma) a_n + gamma a_{n+1}],
//     am = (2 rho - 1)/(rho + 1), af = rho/(rho + 1), gamma = 1/2 - am + af,
//     beta = (1 - am + af)^2/4:
// forces are weighted, not states, so that memory and contact see the ends of the steps alone. The
// equation is divided by 1 - af; the pressures, which have no mass, meet their own equation at the
// end of the step, and the matrix K + (1 - am)/((1 - af) beta h^2) M stays symmetric. rho = 1 has
// no dissipation (Newmark's average acceleration seen at the outputs).
//
// The first step takes am = af = 0, beta = 1/2, gamma = 1, which needs no acceleration at the
// start: loads may act suddenly and pressures of incompressible tissues jump. Its error, of second
// order in v, is made once.
//
// The error of a step is estimated by (beta - 1/6) h^2 (a_{n+1} - a_n), the difference to a
// displacement of third order (Zienkiewicz & Xie, Earthq. Eng. Struct. Dyn. 20 (1991) 871).
//
// Prescribed directions follow their histories, not the formulas above: a = second central
// difference of the history over h, so that a corner gives the impulse that it should. They are
// at rest before time 0.
#pragma once

#include "continuum/pattern.h"

typedef struct sn_fe_inertia {
    double mass_of_cell[SN_FE_NODES * SN_FE_NODES]; ///< int N_a N_b dV / V
    double *density;                                ///< kg/m3                   (batches)
    double *mass;                                   ///< entries as the matrix   (row_start[rows])
    double *u, *v, *a, *r;     ///< last accepted state; r in N                  (3 x nodes each)
    double *next_a, *next_r;   ///< of the last balance                          (3 x nodes each)
    double *known_v, *known_a; ///< of prescribed directions at the step's end   (3 x nodes each)
    double *work, *reaction;   ///<                                              (3 x nodes)
    double rho;
    double step; ///< h, s; 0: no inertia acts
    double alpha_m, alpha_f, beta, gamma;
    bool moving;       ///< a step has been accepted
    double error, way; ///< largest so far: estimated error of a step, displacement; both rms, m
} sn_fe_inertia;

/// @return SN_OK, SN_E_DEFINITION (no density), SN_E_MEMORY.
sn_status sn_fe_inertia_create(const sn_case *c, const sn_fe_space *s, const sn_fe_pattern *p,
                               sn_fe_inertia **out);
void sn_fe_inertia_destroy(sn_fe_inertia *m); // NULL is allowed
/// Starts a step of h seconds that ends at time t.
void sn_fe_inertia_begin(sn_fe_inertia *m, const sn_case *c, const sn_fe_space *s, double t,
                         double h);
/// Adds inertia and what the start of the step weighs to a residual of internal minus external
/// forces. @return the norm of M a, N.
double sn_fe_inertia_add(sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p,
                         const double *x, double *residual);
/// Adds the mass to the entries of the tangent.
void sn_fe_inertia_tangent(const sn_fe_inertia *m, const sn_fe_pattern *p, double *entry);
/// Estimates the error of the step to x, the state of the last sn_fe_inertia_add().
/// @param error  rms, m; 0 for the first step, which starts without an acceleration
/// @param way    rms of the largest displacement so far, x included, m
void sn_fe_inertia_judge(const sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p,
                         const double *x, double *error, double *way);
/// The time that a wave takes through the smallest cell, s.
double sn_fe_inertia_transit(const sn_case *c, const sn_fe_space *s);
/// Accepts x, the state of the last sn_fe_inertia_add(), and makes `residual` the forces that
/// supports exert: see sn_fe_inertia_reactions().
void sn_fe_inertia_commit(sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p,
                          const double *x, double *residual);
/// Forces that supports exert in the last accepted state, inertia included: r + M a at prescribed
/// directions, zero elsewhere.
/// @param residual  N                                                          (3 x nodes)
void sn_fe_inertia_reactions(const sn_fe_inertia *m, const sn_fe_space *s, double *residual);
/// Kinetic energy of the last accepted state, J.
double sn_fe_inertia_energy(sn_fe_inertia *m, const sn_fe_space *s);
