// Finite elements: the accurate reference. PETSc underneath; none of its types shows here.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Runs a case by total-Lagrangian finite elements with Newton's method (elements and steps from
/// c->continuum). Fields: displacement [m], pressure [Pa], Green strain [1], Cauchy stress [Pa],
/// energy density [J/m3], on the nodes and cells of c->mesh (elements with midside nodes give their
/// corner values).
/// @param history  gets the columns of sn_case_history_columns()
/// @return SN_OK also where Newton gave up (summary->converged false, summary->reason says why;
/// what converged before is in the history); SN_E_DEFINITION where rigid motion is free;
/// SN_E_UNSUPPORTED; SN_E_MEMORY.
SN_API sn_status sn_continuum_run(const sn_case *c, const sn_output *output,
                                  sn_run_summary *summary, sn_record *history);

/// What sn_continuum_bench() measures; times are seconds of the processor.
typedef struct sn_continuum_bench_row {
    sn_element element;
    int nodes, cells, unknowns, steps;
    int newton_iterations, factorisations;
    int applications;         ///< of the factors, in all linear solutions
    double residual_ns;       ///< a cell: one evaluation of the forces, insertion included
    double tangent_ns;        ///< a cell: one tangent, insertion included
    double solve_s;           ///< factorisations and solutions
    double total_s;           ///< from the case to the last step
    double peak_memory_bytes; ///< 0 where the system does not say
} sn_continuum_bench_row;

/// Times a clamped cube of `cells`^3 times six tetrahedra pulled by 30 % in 10 steps
/// (Mooney-Rivlin, c1 = 1 Pa, c2 = 0.1 Pa, bulk modulus 100 Pa), to the default tolerance.
/// @return SN_OK, SN_E_RANGE (cells), SN_E_SOLVER (it did not converge), SN_E_MEMORY.
SN_API sn_status sn_continuum_bench(sn_element element, int cells, sn_continuum_bench_row *row);

#ifdef __cplusplus
}
#endif
