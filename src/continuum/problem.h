// The discrete problem: the balance of forces at a state, its tangent, and what a step remembers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "continuum/boundary.h"
#include "continuum/cell.h"
#include "continuum/inertia.h"
#include "continuum/rigid.h"
#include "continuum/solver.h"

/// Where in the programme a step ends.
typedef struct sn_fe_level {
    double time;  ///< s
    double scale; ///< of all loads and prescribed motions: below 1 only on the way into time 0
    double step;  ///< length in time, s; 0 for an instantaneous step
} sn_fe_level;

/// How far from balance a state is.
typedef struct sn_fe_balance {
    bool sound; ///< false: `fault` says where the state cannot be evaluated
    sn_fe_fault fault;
    double force;     ///< norm of the forces out of balance, N
    double reference; ///< norm of the external forces, reactions or inertia, the largest, N
    double volume;    ///< norm of the pressure equations relative to that of a volume strain of 1
    double error;     ///< the larger of force/reference and volume
} sn_fe_balance;

typedef struct sn_fe_problem {
    const sn_case *c;
    sn_fe_space *space;
    sn_fe_pattern *pattern;
    sn_fe_materials *materials;
    sn_fe_boundary *boundary;
    sn_fe_inertia *inertia; ///< NULL unless the analysis is dynamic
    sn_fe_solver *solver;
    sn_fe_work *work;
    sn_fe_level level;
    double *entry;      ///< of the matrix                      (pattern->row_start[rows])
    double *prescribed; ///< at the level, m                    (3 x nodes)
    double *residual;   ///< internal minus external forces     (dofs)
    double *external;   ///< N                                  (dofs)
    double *lifted;     ///< see sn_fe_matrix                   (dofs)
    double *soft;       ///< see sn_fe_solver_def; NULL unless iterative and mixed (corners)
    double *flux_scale; ///< integrals of the pressures' shape functions, m3 (corners)
    const double *at;   ///< state of the last tangent (borrowed), with its `lift` and whether it
    const double *lift; ///< was that of the cells alone: for sn_fe_solver_def.assemble
    bool cells_alone;
    double reference;       ///< largest of the references of accepted steps, N
    double least_reference; ///< below it forces are rounding, N
} sn_fe_problem;

/// Builds everything for a case. @param shortest  the shortest step that is planned, s
sn_status sn_fe_problem_create(const sn_case *c, double shortest, sn_fe_problem **problem);
void sn_fe_problem_destroy(sn_fe_problem *p); // NULL is allowed
/// Starts a step to a level.
void sn_fe_problem_begin(sn_fe_problem *p, sn_fe_level level);
/// Evaluates the balance at x: residual, external, norms.
void sn_fe_problem_balance(sn_fe_problem *p, const double *x, sn_fe_balance *out);
/// Evaluates the tangent at a sound x, for increments `lift` of prescribed unknowns (Nullable): see
/// `lifted`.
void sn_fe_problem_tangent(sn_fe_problem *p, const double *x, const double *lift);
/// Makes the linear solver weigh forces and pressure equations as the error of this balance does.
void sn_fe_problem_weigh(sn_fe_problem *p, const sn_fe_balance *balance);
/// The part of the tangent that belongs to the cells, without loads, contact and inertia: all there
/// is of it in linear analysis.
void sn_fe_problem_stiffness(sn_fe_problem *p, const double *x, const double *lift);
/// Accepts x as the end of the step: memory, contact, reference, motion. Of a dynamic problem the
/// residual becomes the forces that supports exert, inertia included.
void sn_fe_problem_commit(sn_fe_problem *p, const double *x, const sn_fe_balance *balance);
