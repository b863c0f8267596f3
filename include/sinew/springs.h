// The real-time engine: nonlinear springs with memory on the edges or cells of a mesh.
// SPDX-License-Identifier: Apache-2.0
//
// A net is constant: build it once, share it. A state is all that changes. A step reads the net and
// the inputs of the state, and writes the state; it allocates nothing and opens nothing. With
// c->springs.threads above 1 a state has threads of its own (none may outlive it), which wait for
// work by spinning for some 50 microseconds and then sleep: the first step after a pause wakes
// them, the only system call. Results have the same bits for any number of threads.
#pragma once

#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/// A spring net: constant description.
typedef struct sn_net sn_net;
/// Positions, velocities, memory variables and results of one simulation of a net.
typedef struct sn_state sn_state;

/// Builds the net of a case: rung, volume term, integrator, precision and step from c->springs.
/// The case is not referred to afterwards.
/// @return SN_OK, SN_E_UNSUPPORTED (a law that the rung cannot carry), SN_E_DEFINITION,
/// SN_E_MEMORY.
SN_API sn_status sn_net_create(const sn_case *c, sn_net **net);
SN_API void sn_net_destroy(sn_net *net); // NULL is allowed
SN_API int sn_net_node_count(const sn_net *net);
SN_API int sn_net_spring_count(const sn_net *net);
SN_API int sn_net_cell_count(const sn_net *net);
/// The exponentials in use, of the tissue of region 0.
SN_API const sn_exponentials *sn_net_memory(const sn_net *net);
/// The step, seconds: explicit 0.9 of the stability limit at rest, implicit as chosen, or the
/// case's own.
SN_API double sn_net_step(const sn_net *net);

SN_API sn_status sn_state_create(const sn_net *net, sn_state **state);
SN_API void sn_state_destroy(sn_state *state); // NULL is allowed
/// Back to rest.
SN_API void sn_state_reset(const sn_net *net, sn_state *state);
/// Overrides the path of a tool: its pose from the next step on.
SN_API void sn_state_set_tool(const sn_net *net, sn_state *state, int tool, const sn_pose *pose);

/// What a step did.
typedef struct sn_step_info {
    double time;  ///< seconds, after the step
    double step;  ///< seconds taken; less than asked where stability needs it
    int warnings; ///< counted so far: steps cut, states recovered
} sn_step_info;

/// Advances by at most dt seconds, one explicit or implicit step. Never allocates.
SN_API sn_step_info sn_state_step(const sn_net *net, sn_state *state, double dt);
/// Positions now, metres (node_count x 3), copied to the caller's array.
SN_API void sn_state_positions(const sn_net *net, const sn_state *state, double *position);
/// Force of the tissue on a tool, newtons.
SN_API void sn_state_tool_force(const sn_net *net, const sn_state *state, int tool,
                                double force[3]);

/// Runs a case to its end. Fields as in sn_continuum_run(), velocity [m/s] in addition; frames and
/// rows at time 0, every output_every, and at the end. Reactions are what supports and prescribed
/// motion give the body (mass times acceleration less all other forces there), tool forces what the
/// tissue gives the tool. summary->elastic_J is the energy of the equilibrium part of the law at
/// the end, memory_J what the branches of the memory hold, dissipated_J what damping took and, with
/// memory, the work done on the tissue less what it stored.
/// @return SN_OK also where the run stopped early (summary->converged false, summary->reason).
SN_API sn_status sn_springs_run(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                                sn_record *history);

/// What a row of the benchmark times: whole steps of a block of `cells`^3 mirrored cells, 0.1 m
/// wide, clamped below (E = 10 kPa, density 1000 kg/m3, Poisson's ratio 0.45).
typedef struct sn_springs_bench_plan {
    sn_rung rung;
    bool volume;
    const char *law; ///< central: exponential; coupled: neo-hookean or demiray. NULL: the first
    int memory_terms, cells, threads;
    sn_precision precision;
} sn_springs_bench_plan;

/// One row of the benchmark of the force kernels.
typedef struct sn_springs_bench_row {
    char model[SN_NAME_MAX], law[SN_NAME_MAX];
    bool volume;
    int memory_terms, nodes, springs, cells, threads;
    sn_precision precision;
    double springs_per_second; ///< 0 for rungs without springs
    double cells_per_second;   ///< 0 for the central rung without volume
    double bound_per_second; ///< the lesser of the next two: springs, else cells, that the measured
                             ///< rates of this processor allow
    double memory_bound_per_second;     ///< by the bytes that a step moves
    double arithmetic_bound_per_second; ///< by the operations of a step
    double plain_per_second;            ///< of a plain loop that does the same, on one thread
    double step_s;                      ///< the stable step at rest
    double real_time_factor;            ///< at that step
} sn_springs_bench_row;

/// Times one row: about a second, most of it for the rates of the processor.
/// @return SN_OK, SN_E_RANGE, SN_E_NAME (law), SN_E_MEMORY.
SN_API sn_status sn_springs_bench(const sn_springs_bench_plan *plan, sn_springs_bench_row *row);

#ifdef __cplusplus
}
#endif
