// Finite elements: the accurate reference. PETSc underneath; none of its types shows here.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Runs a case by total-Lagrangian finite elements with Newton's method (elements and steps from
/// c->continuum). Fields: displacement [m], pressure [Pa], Green strain [1], Cauchy stress [Pa],
/// energy density [J/m3], second Piola-Kirchhoff stress [Pa], principal stretches [1] (the largest
/// first), on the nodes and cells of c->mesh (elements with midside nodes give their corner
/// values); velocity [m/s] in addition where the analysis is dynamic.
/// @param history  gets the columns of sn_case_history_columns()
/// @return SN_OK also where Newton gave up (summary->converged false, summary->reason says why;
/// what converged before is in the history); SN_E_DEFINITION where rigid motion is free;
/// SN_E_UNSUPPORTED; SN_E_MEMORY.
SN_API sn_status sn_continuum_run(const sn_case *c, const sn_output *output,
                                  sn_run_summary *summary, sn_record *history);

//---- several processes ---------------------------------------------------------------------------
// Processes that mpirun has started share a run of sn_continuum_run(), _resume() and _refine(): all
// call it with the same case and get the same history and summary. Frames and states are handed out
// on the first alone. Everything else runs in each process for itself.

/// Joins the processes of the launcher, where there is one: *count 1 where not.
SN_API sn_status sn_ranks_join(int *rank, int *count);
/// The same status on all, with its text: SN_OK where it was SN_OK everywhere. All must call it.
SN_API sn_status sn_ranks_agree(sn_status status);
/// Whether this process left a run with an error that the others, still in it, do not know of: what
/// is left is sn_ranks_abort().
SN_API bool sn_ranks_lost(void);
/// Ends all processes.
SN_API void sn_ranks_abort(int code);

//---- going on where a run was killed -------------------------------------------------------------

/// sn_continuum_run() that saves its state, or goes on from a saved one of the same case; steps,
/// tolerance and times of the case may have changed. The history gets the rows from before too;
/// frames are handed out from the state on. The answer is that of a run that saved its state and
/// was not interrupted, to the last bit where nothing was changed (one thread, one machine).
/// @return as sn_continuum_run(); SN_E_DATA (the state is damaged, or of another case).
SN_API sn_status sn_continuum_resume(const sn_case *c, const sn_output *output,
                                     const sn_restart *restart, sn_run_summary *summary,
                                     sn_record *history);

//---- its own error -------------------------------------------------------------------------------

#define SN_REFINE_MAX 3 ///< most meshes of a refinement

/// One number of a run on all meshes, coarse to fine.
typedef struct sn_refined {
    char name[SN_NAME_MAX];      ///< a column of the history (its last row), or "elastic_J"
    char unit[SN_NAME_MAX];      ///< SI
    double value[SN_REFINE_MAX]; ///<                            (meshes)
    double order;                ///< observed, or assumed where `observed` is false
    bool observed;               ///< three meshes that converge towards one side
    double extrapolated;         ///< to a mesh without end
    double error[SN_REFINE_MAX]; ///< estimated error of each value, never negative (meshes)
} sn_refined;

typedef struct sn_refinement {
    int meshes;                        ///< that were run to their end
    sn_run_summary run[SN_REFINE_MAX]; ///<                     (meshes)
    int count;                         ///< 0 where fewer than two meshes ended
    sn_refined *quantity;              ///< sn_refinement_release() frees them (count)
    char reason[SN_TEXT_MAX];          ///< why a finer mesh is missing; empty when none is
} sn_refinement;

/// Runs a case on its own mesh as sn_continuum_run() does, then on meshes of half the cell size
/// (built-in shapes are built anew with twice the cells, so that curved walls get better too;
/// other meshes are split by sn_mesh_refine()), and extrapolates displacements, reactions and the
/// elastic energy at the end by Richardson's rule. Output, summary and history are those of the
/// case's own mesh. Errors of the steps in time and of memory_tolerance are in none of this.
/// Source: Roache, J. Fluids Eng. 116 (1994) 405: the error is 1.25 times the distance to the
/// extrapolated value where three meshes show an order between 0.5 and 6; else order 2 is assumed
/// and the factor is 3.
/// @param meshes  2 or 3 with the case's own
/// @return as sn_continuum_run() for the case's own mesh; SN_E_RANGE.
SN_API sn_status sn_continuum_refine(const sn_case *c, int meshes, const sn_output *output,
                                     sn_run_summary *summary, sn_record *history,
                                     sn_refinement *out);
/// The same by order, for a case of element P1: on its own mesh as it is, on the same mesh with
/// P2P1, and with runs = 3 on cells of half the size with P2P1. The errors assume that P2P1 at
/// least halves the error of P1 (two runs), or order 2 of P2P1 (three); no order is observed.
/// @param runs  2 or 3
/// @return as sn_continuum_refine(); SN_E_UNSUPPORTED (the element is quadratic already).
SN_API sn_status sn_continuum_raise(const sn_case *c, int runs, const sn_output *output,
                                    sn_run_summary *summary, sn_record *history,
                                    sn_refinement *out);
SN_API void sn_refinement_release(sn_refinement *r);

//---- benchmark ----------------------------------------------------------------------------------

/// What sn_continuum_bench() measures; times but wall_s are seconds of the processor, of the rank
/// that took the longest.
typedef struct sn_continuum_bench_row {
    sn_element element;
    int nodes, cells, unknowns, steps;
    int ranks;
    int newton_iterations, factorisations; ///< or hierarchies of multigrid
    int applications;         ///< of the factors or of multigrid, in all linear solutions
    int systems;              ///< that were solved
    int rescues;              ///< of these, that multigrid had to leave to factors
    int cycles;               ///< iterative: of multigrid, for the last system to 1e-8 of its size
    double residual_ns;       ///< a cell: one evaluation of the forces, insertion included
    double tangent_ns;        ///< a cell: one tangent, insertion included
    double solve_s;           ///< factorisations and solutions
    double total_s;           ///< from the case to the last step
    double wall_s;            ///< the same by the clock on the wall
    double peak_memory_bytes; ///< of all ranks; 0 where the system does not say
} sn_continuum_bench_row;

/// Times a clamped cube of `cells`^3 times six tetrahedra pulled by 30 % in 10 steps
/// (Mooney-Rivlin, c1 = 1 Pa, c2 = 0.1 Pa, bulk modulus 100 Pa), to the default tolerance.
/// @return SN_OK, SN_E_RANGE (cells), SN_E_SOLVER (it did not converge), SN_E_MEMORY.
SN_API sn_status sn_continuum_bench(sn_element element, int cells, sn_solver solver,
                                    sn_continuum_bench_row *row);

#ifdef __cplusplus
}
#endif
