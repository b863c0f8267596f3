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
/// The exponentials in use, of the tissue of region 0: of its deviatoric part where branched.
SN_API const sn_exponentials *sn_net_memory(const sn_net *net);
/// The step, seconds: explicit 0.9 of the stability limit at rest, implicit as chosen, or the
/// case's own.
SN_API double sn_net_step(const sn_net *net);

/// Whether the springs of a central net of the case are those of a lattice, of which the elastic
/// tensor is isotropic by class constants: built-in blocks of the patterns mirrored and bcc.
SN_API bool sn_springs_lattice(const sn_case *c);
/// The springs of a central net: the nodes of the mesh at their ends (spring_count x 2) and their
/// stiffness at small strain, N/m (spring_count). Both are Nullable. A region has springs of its
/// own: an edge between two regions stands twice.
SN_API void sn_net_springs(const sn_net *net, int *ends, double *stiffness);
/// The same with what else their force depends on, as a case takes it in `springs_given`; of other
/// rungs a set without springs. @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_net_spring_set(const sn_net *net, sn_spring_set **set);
/// Gives every spring of a central net a stiffness of its own, N/m, in the order of
/// sn_net_springs(): what a calibration found, or springs taken out (0). The volume term stays what
/// it is. The explicit step is found anew; no state of the net may exist.
/// @return SN_OK; else the net is as it was: SN_E_UNSUPPORTED (no springs), SN_E_RANGE (negative,
/// not finite), SN_E_MEMORY.
SN_API sn_status sn_net_set_spring_stiffness(sn_net *net, const double *stiffness);

//---- virtual tests -------------------------------------------------------------------------------

#define SN_RESPONSES 13
/// "stretch x" y z, "shear xy" yz zx, "pressure", "bend x" y z, "twist x" y z.
SN_API const char *sn_net_response_name(int test);
/// How stiff a net is at small strain, without supports and loads, against the homogeneous body: a
/// stress that is even or linear in space, as in a long beam that is bent or twisted, acts by its
/// tractions on a body of any shape, whose answer is known. Of any rung.
/// @param held   the surface moves as that of the body instead, and only the inside is free
/// @param tests  one bit a test
/// @param error  stiffness over the body's, less 1; NAN where it was not asked for or not found
/// @return SN_OK, SN_E_UNSUPPORTED (several regions, fibres that carry tension only or turn from
/// cell to cell, incompressible), SN_E_MEMORY.
SN_API sn_status sn_net_responses(const sn_net *net, bool held, unsigned tests,
                                  double error[SN_RESPONSES]);

SN_API sn_status sn_state_create(const sn_net *net, sn_state **state);
SN_API void sn_state_destroy(sn_state *state); // NULL is allowed
/// Back to rest, and whole.
SN_API void sn_state_reset(const sn_net *net, sn_state *state);
//---- what a program changes between two steps ----------------------------------------------------

/// Overrides the path of a tool: its pose from the next step on.
/// @return SN_OK, SN_E_RANGE (not finite: the tool stays where it was).
SN_API sn_status sn_state_set_tool(const sn_net *net, sn_state *state, int tool,
                                   const sn_pose *pose);
/// Overrides the time table of a load, prescribed motions too: its factor from the next step on, in
/// which a prescribed surface goes all the way.
/// @return SN_OK, SN_E_RANGE (not finite: the factor stays).
SN_API sn_status sn_state_set_load(const sn_net *net, sn_state *state, int load, double factor);
/// A force on a node of the mesh, N, until it is set again; zero ends it.
/// @return SN_OK, SN_E_RANGE (not finite: the force stays).
SN_API sn_status sn_state_push(const sn_net *net, sn_state *state, int node, const double force[3]);
/// Nodes of the mesh that move with a tool from now on, as if glued to it, but for directions that
/// the case prescribes. A node that another tool holds changes hands. Their reaction is part of the
/// tool's force and torque; they are in no contact with tools.
/// @param nodes  Nullable: all nodes that touch the tool now
/// @return nodes that the tool holds; none but with the integrator explicit.
SN_API int sn_state_grasp(const sn_net *net, sn_state *state, int tool, int count,
                          const int *nodes);
/// Lets go of all nodes that a tool holds; they keep their velocity.
SN_API void sn_state_release(const sn_net *net, sn_state *state, int tool);
/// Removes cells for good, of a net built with springs.cuttable or from a case with cuts (which
/// runs carry out by themselves). Their stiffness, memory and volume are gone; places, velocities
/// and masses of nodes stay. Loads on their faces end; nodes that come to the surface touch tools.
/// A node that has lost all its cells is loose: it flies by itself, with its weight, and no tool
/// touches or holds it. Cells that are gone already count for nothing. Allocates nothing, and takes
/// about as long as five to ten steps; the next forty are up to 30 % shorter.
/// @param cells    numbers in the mesh                              (count)
/// @param removed  Nullable: how many there were to remove
/// @return SN_OK, SN_E_UNSUPPORTED (the net is not cuttable), SN_E_RANGE (no such cell: nothing was
/// cut).
SN_API sn_status sn_state_cut(const sn_net *net, sn_state *state, int count, const int *cells,
                              int *removed);
/// Whether a cell of the mesh was removed.
SN_API bool sn_state_is_cut(const sn_net *net, const sn_state *state, int cell);
/// Whether a node of the mesh has lost all its cells.
SN_API bool sn_state_is_loose(const sn_net *net, const sn_state *state, int node);
/// Goes on with another net of the same mesh, tissues with other constants, other loads or other
/// settings: what a state carries over is place, velocity, time, tools and contact. Memory is kept
/// where all regions have as many exponentials as before, part by part; else it begins anew, as if
/// the present stress had come on at once. Forces and the limit of the step are those of the new
/// net. Nets are constant, so the new one can be built while the old one runs.
/// @return SN_OK, SN_E_DEFINITION (other mesh, rung, precision, tools or number of loads: nothing
/// changed), SN_E_MEMORY.
SN_API sn_status sn_state_move(const sn_net *from, const sn_net *to, sn_state *state);

/// What a step did.
typedef struct sn_step_info {
    double time;  ///< seconds, after the step
    double step;  ///< seconds taken; less than asked where stability needs it
    int warnings; ///< counted so far: steps cut, states recovered
} sn_step_info;

/// Advances by at most dt seconds, one explicit or implicit step; an explicit one by dt or by the
/// largest equal part of dt that is stable, so that steps that go on to dt are all of one length.
/// Never allocates.
SN_API sn_step_info sn_state_step(const sn_net *net, sn_state *state, double dt);
/// Arrays of the engine, to read without a copy; they hold until the next call that changes the
/// state. A node's numbers stand in a row of `stride`, x y z first; node i of the mesh has row
/// place[i], as the engine keeps neighbours together.
typedef struct sn_state_view {
    sn_precision precision;   ///< of `displacement`, `velocity` and `force`: float or double
    int stride;               ///< numbers from one row to the next, of these three
    const void *displacement; ///< m
    const void *velocity;     ///< m/s; half a step behind
    const void *force;        ///< N: of tissue, loads, tools and weight, without supports
    const double *rest;       ///< positions at rest, m, by row        (node_count x 3)
    const int *place;         ///< row of each node of the mesh        (node_count)
} sn_state_view;
SN_API void sn_state_look(const sn_net *net, const sn_state *state, sn_state_view *view);
/// Positions now, metres (node_count x 3), copied to the caller's array.
SN_API void sn_state_positions(const sn_net *net, const sn_state *state, double *position);
/// Force of the tissue on a tool, newtons.
SN_API void sn_state_tool_force(const sn_net *net, const sn_state *state, int tool,
                                double force[3]);
/// Torque of the tissue on a tool about the tool's centre, N m, axes of space.
SN_API void sn_state_tool_torque(const sn_net *net, const sn_state *state, int tool,
                                 double torque[3]);

//---- states as bytes -----------------------------------------------------------------------------

/// Bytes that sn_state_save() writes.
SN_API size_t sn_state_size(const sn_net *net, const sn_state *state);
/// All that later steps depend on, and a fingerprint of the net. Allocates nothing.
SN_API void sn_state_save(const sn_net *net, const sn_state *state, void *bytes);
/// Steps after it give the bits that they gave after sn_state_save(), on the same kind of processor
/// and with any number of threads. Allocates nothing.
/// @return SN_OK; SN_E_DATA (damaged), SN_E_DEFINITION (of another net), SN_E_UNSUPPORTED (of
/// another version): the state is as it was.
SN_API sn_status sn_state_load(const sn_net *net, sn_state *state, const void *bytes, size_t size);

//---- runs ----------------------------------------------------------------------------------------

/// Runs a case to its end. Fields as in sn_continuum_run(), velocity [m/s] in addition; frames and
/// rows at time 0, every output_every, and at the end. Reactions are what supports and prescribed
/// motion give the body (mass times acceleration less all other forces there), tool forces what the
/// tissue gives the tool. summary->elastic_J is the energy of the equilibrium part of the law at
/// the end, memory_J what the branches of the memory hold, dissipated_J what damping took and, with
/// memory, the work done on the tissue less what it stored.
/// @return SN_OK also where the run stopped early (summary->converged false, summary->reason).
SN_API sn_status sn_springs_run(const sn_case *c, const sn_output *output, sn_run_summary *summary,
                                sn_record *history);

/// The same, stopped and continued: with restart->state it goes on behind the output after which
/// those bytes were saved, whose frame is handed out once more. History and summary, but for wall
/// times, come out with the same bits as without a stop.
/// @return as sn_springs_run(), and as sn_state_load().
SN_API sn_status sn_springs_resume(const sn_case *c, const sn_output *output,
                                   const sn_restart *restart, sn_run_summary *summary,
                                   sn_record *history);

/// What a row of the benchmark times: whole steps of a block of `cells`^3 mirrored cells, 0.1 m
/// wide, clamped below (E = 10 kPa, density 1000 kg/m3, Poisson's ratio 0.45).
typedef struct sn_springs_bench_plan {
    sn_rung rung;
    bool volume;
    const char *law; ///< central: exponential; others: neo-hookean or demiray. NULL: the first
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

/// Frames of a millisecond of such a block of cells^3, poked by a sphere: central springs with the
/// volume term, exponential law and three exponentials, single precision, at the stable step.
typedef struct sn_springs_haptic_row {
    int nodes, springs, threads, frames;
    double step_s; ///< at rest
    double steps_per_frame;
    double frame_p50_s, frame_p999_s, frame_max_s; ///< wall time of a frame
    double cpu_p50_s, cpu_p999_s;                  ///< time that the calling thread ran in a frame
    double worst_steps; ///< of the longest thousandth of all frames: steps in each,
    double worst_looks; ///< part in which the frequency was looked at,
    double worst_cpu_s; ///< time that the calling thread ran
    double real_time_factor;
    double force_N; ///< largest on the sphere
    int warnings;
} sn_springs_haptic_row;
/// @return SN_OK, SN_E_RANGE, SN_E_MEMORY.
SN_API sn_status sn_springs_haptic(int cells, int threads, double seconds,
                                   sn_springs_haptic_row *row);

#ifdef __cplusplus
}
#endif
