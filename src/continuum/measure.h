// What a run hands out: fields, a row of the history, energies.
// SPDX-License-Identifier: Apache-2.0
//
// Cell values are volume averages over the quadrature points; of the second Piola-Kirchhoff stress
// in the axes of space, of the principal stretches (roots of the eigenvalues of C) one by one, the
// largest first. The pressure is -tr(Cauchy stress)/3,
// positive in compression: the mean of the cells around a node by volume; for P2P1 the unknown
// pressure of the node (sign turned) plus that mean of what the distortional stress adds.
#pragma once

#include "continuum/problem.h"

typedef struct sn_fe_measure {
    double *displacement; ///< (corners x 3)
    double *pressure;     ///< (corners)
    double *strain;       ///< (cells x 6)
    double *stress;       ///< Cauchy (cells x 6)
    double *reference;    ///< second Piola-Kirchhoff stress (cells x 6)
    double *stretch;      ///< principal stretches (cells x 3)
    double *energy;       ///< (cells)
    double *fibre;        ///< at rest                      (cells x 3)
    bool fields;          ///< somebody wants them
    double *row;          ///< a row of the history
    int columns;
    int **reaction; ///< nodes of the surface of each reaction probe  (probes)
    int *reaction_count;
    int (*point_node)[SN_FE_NODES]; ///< nodes of the cell of each point probe (probes)
    double (*point_weight)[4];
} sn_fe_measure;

sn_status sn_fe_measure_create(const sn_fe_problem *p, const sn_record *history, bool fields,
                               sn_fe_measure **out);
void sn_fe_measure_destroy(sn_fe_measure *m, const sn_case *c); // NULL is allowed
/// Appends the row of the present state (the problem's last balance belongs to x).
sn_status sn_fe_measure_row(sn_fe_measure *m, const sn_fe_problem *p, const double *x,
                            sn_record *history);
/// Computes the fields of a state.
void sn_fe_measure_fill(sn_fe_measure *m, const sn_fe_problem *p, const double *x);
/// Hands out the fields as they were computed last, at the problem's time: on the first rank.
sn_status sn_fe_measure_emit(sn_fe_measure *m, const sn_fe_problem *p, const sn_output *output);
/// Computes the fields of the present state and hands them out.
sn_status sn_fe_measure_frame(sn_fe_measure *m, const sn_fe_problem *p, const double *x,
                              const sn_output *output);
/// Elastic energy of a state, J.
double sn_fe_measure_energy(const sn_fe_problem *p, const double *x);
