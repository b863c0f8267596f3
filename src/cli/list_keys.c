// The keys of the JSON objects that commands print and write.
// SPDX-License-Identifier: Apache-2.0
//
// A path names a value: "a.b" a key in a key, "a[]" every item of a list, "*" any name that comes
// from the user's files. tests/cli/list.sh runs every command and holds what it prints against
// these tables, both ways: a new key needs its row here, and a row needs a command that prints it.
#include <fnmatch.h>
#include <stdio.h>
#include <string.h>

#include "cli/list.h"

typedef struct key_row {
    const char *path, *unit, *meaning;
} key_row;

typedef struct key_table {
    const char *command; ///< as `sinew list keys` knows it
    const char *text;
    const key_row *rows;
    int count;
} key_table;

#define EXPONENTIALS(prefix)                                                                       \
    {prefix, "", "the memory as exponentials, compressed"},                                        \
        {prefix ".terms", "", "number of exponentials"},                                           \
        {prefix ".max_error", "1", "largest error over the band, of G(0) = 1"},                    \
        {prefix ".band_s[]", "s", "ends of the band of times"},                                    \
        {prefix ".g_infinity", "1", "what never relaxes"}, {prefix ".g[]", "1", "weights"}, {      \
        prefix ".tau_s[]", "s", "relaxation times"                                                 \
    }

#define ANALYSIS                                                                                   \
    {"rows", "", "of the record"}, {"discarded", "", "rows that were not used"}, {                 \
        "remarks[]", "", "which rows and why, and what else to know"                               \
    }

static const key_row tensile[] = {
    ANALYSIS,
    {"youngs_modulus_Pa", "Pa", "Young's modulus"},
    {"youngs_modulus_error_Pa", "Pa", "its standard error"},
    {"modulus_method", "", "how it was found"},
    {"chord_modulus_Pa", "Pa", "slope of the chord over the same strains"},
    {"toe_modulus_Pa", "Pa", "slope at small stretch"},
    {"toe_limit_strain", "1", "end of the toe; null where there is none"},
    {"toe_limit_stress_Pa", "Pa", "stress there"},
    {"toe_reason", "", "why there is no end of the toe; absent where there is one"},
    {"max_slope_modulus_Pa", "Pa", "largest slope"},
    {"yield_stress_Pa", "Pa", "0.2 % offset yield; null where the line never meets the curve"},
    {"yield_strain", "1", "strain there; null likewise"},
    {"reason", "", "why there is no yield; absent where there is one"},
    {"ultimate_tensile_strength_Pa", "Pa", "largest nominal stress"},
    {"strain_at_ultimate", "1", "strain there"},
    {"work_to_failure_J_per_m3", "J/m3", "area under the curve"},
    {"preload_Pa", "Pa", "stress at which the strain is 0; null without --preload"},
    {"stretch_at_zero_strain", "1", "stretch at which the strain is 0"},
    {"stress_noise_Pa", "Pa", "scatter of the stress from row to row"},
    {"loading_ramps", "", "full loading ramps in the record"},
    {"loading_ramp", "", "the one that was used, from 1"},
    {"slope_stress", "", "regression of slope on stress, equation (13)"},
    {"slope_stress.B", "1", "its slope"},
    {"slope_stress.C_Pa", "Pa", "its value at no stress"},
    {"slope_stress.r_squared", "1", "how straight it is"},
    {"slope_stress.window_strain", "1", "strain over which a slope is taken"},
    {"slope_stress.bend", "1", "how far the slopes bend off the line"},
    {"slope_stress.bend_over_error", "1", "that over its standard error"},
    {"slope_stress.test", "", "whether the line holds, in words"},
};

static const key_row cyclic[] = {
    ANALYSIS,
    {"cycles", "", "one object a cycle"},
    {"cycles[].hysteresis", "1", "loop area over area under the loading curve"},
    {"cycles[].loading_area_J_per_m3", "J/m3", "area under the loading curve"},
    {"cycles[].loop_area_J_per_m3", "J/m3", "area of the loop"},
    {"cycles[].peak_stress_Pa", "Pa", "largest nominal stress"},
    {"definition", "", "of hysteresis, in words"},
    {"peak_stress_change", "1", "of the peak stress from the last cycle but one to the last"},
    {"hysteresis_change", "1", "the same of the hysteresis"},
    {"preconditioned_after_cycle", "", "after it no cycle differs from the last; null: never"},
    {"reason", "", "why there is none; absent where there is one"},
};

static const key_row relaxation[] = {
    ANALYSIS,
    {"peak_stress_Pa", "Pa", "nominal stress at the end of the ramp"},
    {"relaxed_fraction", "1", "(peak - final)/peak"},
    {"rate_per_decade", "1", "fall over peak per decade of time"},
    {"ramp_s", "s", "length of the ramp, found in the data"},
    {"hold_s", "s", "length of the hold"},
    {"final_stress_Pa", "Pa", "nominal stress in the last row"},
    {"held_stretch", "1", "stretch of the hold"},
    {"overshoot", "1", "largest stretch over the held one, over the way of the ramp"},
    {"steps", "", "ramps with a hold in the record"},
    {"step", "", "the one that was used, from 1"},
    {"relaxation", "", "one object a tenth of a decade of time"},
    {"relaxation[].time_s", "s", "since the peak"},
    {"relaxation[].stress_over_peak", "1", "mean over the tenth"},
};

static const key_row creep[] = {
    ANALYSIS,
    {"compliance_per_Pa", "1/Pa", "strain over stress at the end of the hold"},
    {"initial_compliance_per_Pa", "1/Pa", "the same at its start"},
    {"creep_rate_per_s", "1/s", "smallest slope of the strain over a quarter of the hold"},
    {"time_to_rupture_s", "s", "from the start of the hold; null where it did not break"},
    {"recovered_fraction", "1", "of the strain at the end of the hold; null if never unloaded"},
    {"rupture_reason", "", "why it did not break; absent where it did"},
    {"recovery_reason", "", "why nothing recovered; absent where it did"},
    {"stress_Pa", "Pa", "held nominal stress"},
    {"ramp_s", "s", "length of the loading"},
    {"hold_s", "s", "time under the stress"},
};

static const key_row dynamic[] = {
    ANALYSIS,
    {"sweep", "", "one object a frequency"},
    {"sweep[].frequency_Hz", "Hz", "of the oscillation"},
    {"sweep[].storage_modulus_Pa", "Pa", "in phase with the stretch"},
    {"sweep[].loss_modulus_Pa", "Pa", "in phase with its rate"},
    {"sweep[].tan_delta", "1", "loss over storage"},
    {"sweep[].phase_rad", "rad", "of the stress before the stretch"},
    {"sweep[].storage_modulus_error_Pa", "Pa", "raw sinusoids: standard error"},
    {"sweep[].loss_modulus_error_Pa", "Pa", "raw sinusoids: standard error"},
    {"sweep[].mean_stretch", "1", "raw sinusoids: what it oscillates about"},
    {"sweep[].stretch_amplitude", "1", "raw sinusoids: of the first harmonic"},
    {"sweep[].mean_stress_Pa", "Pa", "raw sinusoids: what it oscillates about"},
    {"sweep[].stress_amplitude_Pa", "Pa", "raw sinusoids: of the first harmonic"},
    {"sweep[].harmonic_distortion", "1", "raw sinusoids: harmonics 2 to 5 over the first"},
    {"sweep[].cycles", "1", "raw sinusoids: number that was fitted"},
    {"storage_power_law", "1", "d log storage modulus / d log frequency"},
    {"loss_power_law", "1", "d log loss modulus / d log frequency"},
    {"low_plateau_modulus_Pa", "Pa", "storage modulus at the low end where it is level, or null"},
    {"low_plateau_reason", "", "why there is none; absent where there is one"},
    {"high_plateau_modulus_Pa", "Pa", "storage modulus at the high end where it is level, or null"},
    {"high_plateau_reason", "", "why there is none; absent where there is one"},
    {"peak_tan_delta", "1", "its peak within the record, or null"},
    {"peak_tan_delta_frequency_Hz", "Hz", "where"},
    {"peak_tan_delta_reason", "", "why there is none; absent where there is one"},
};

static const key_row biaxial[] = {
    ANALYSIS,
    {"peak_stretch_1", "1", "stretch of axis 1 at the largest sum of both stresses"},
    {"peak_stress_1_Pa", "Pa", "nominal stress there"},
    {"low_modulus_1_Pa", "Pa", "slope over the first fifth of its stretch"},
    {"high_modulus_1_Pa", "Pa", "slope over the last fifth"},
    {"peak_stretch_2", "1", "the same of axis 2"},
    {"peak_stress_2_Pa", "Pa", "the same of axis 2"},
    {"low_modulus_2_Pa", "Pa", "the same of axis 2"},
    {"high_modulus_2_Pa", "Pa", "the same of axis 2"},
    {"stress_ratio", "1", "stress 1 over stress 2 at the peak"},
    {"stretch_ratio", "1", "(stretch 1 - 1)/(stretch 2 - 1) at the peak"},
    {"anisotropy", "1", "2 (c2 - c1)/(c1 + c2), c strain over stress: above 0 where 1 is stiffer"},
    {"strain_energy_J_per_m3", "J/m3", "work of both stresses up to the peak"},
};

static const key_row fit[] = {
    {"elastic", "", "name of the elastic law"},
    {"memory", "", "name of the memory"},
    {"parameters", "", "one object a constant"},
    {"parameters[].name", "", "key of the constant; terms of a list are g1, g2, …"},
    {"parameters[].value", "as `unit`", "fitted or fixed value; null where infinite"},
    {"parameters[].unit", "", "SI unit"},
    {"parameters[].standard_error", "as `unit`", "null where fixed"},
    {"parameters[].ci95[]", "as `unit`", "ends of the 95 % interval"},
    {"parameters[].ci95_bootstrap[]", "as `unit`", "with --bootstrap: those from the refits"},
    {"parameters[].fixed", "", "held by the user"},
    {"parameters[].identifiable", "", "whether the data determine it"},
    {"r_squared", "1", "1 - SSE/SST over all points"},
    {"rmse_Pa", "Pa", "root of the mean square residual"},
    {"nrmse", "1", "that over the largest measured stress or modulus"},
    {"aicc", "1", "Akaike's criterion, corrected: smaller is better"},
    {"correlation[][]", "1", "of the constants, in the order of `parameters`"},
    {"active_bounds[]", "", "constants at a bound of the search"},
    {"identifiable", "", "every constant is"},
    {"not_identifiable", "", "one object a constant that is not"},
    {"not_identifiable[].name", "", "which"},
    {"not_identifiable[].reason", "", "why"},
    {"weakest_combination", "", "the combination of constants that the data know least"},
    {"determined_combination", "", "what they know of constants that they do not tell apart"},
    {"convex", "", "Fung laws: the energy is convex; else null"},
    {"converged", "", "the search ended well"},
    {"reason", "", "how it ended"},
    {"points", "", "rows of all curves"},
    {"data", "", "one object a curve"},
    {"data[].file", "", "path as given"},
    {"data[].sha256", "", "of the file"},
    {"data[].points", "", "rows"},
    {"data[].kind", "", "uniaxial, biaxial, shear or dynamic"},
    {"data[].window", "", "null without time, else"},
    {"data[].window[]", "s", "first and last time used"},
    {"data[].weight", "1", "factor of its squares"},
    {"data[].rmse_Pa", "Pa", "root of its mean square residual"},
    {"data[].rmse_over_peak", "1", "that over its largest stress"},
    {"data[].r_squared", "1", "1 - SSE/SST of this curve"},
    {"data[].durbin_watson", "1", "of its residuals: 2 where they are white"},
    {"data[].worst", "", "row of the largest residual"},
    {"data[].worst.time_s", "s", "its time"},
    {"data[].worst.row", "", "its number, from 1"},
    {"data[].worst.axis", "", "1 or 2; absent unless biaxial"},
    {"data[].worst.frequency_Hz", "Hz", "absent unless dynamic"},
    {"data[].worst.modulus", "", "storage or loss; absent unless dynamic"},
    {"data[].worst.measured_Pa", "Pa", "measured stress or modulus there"},
    {"data[].worst.fitted_Pa", "Pa", "fitted stress or modulus there"},
    {"weights", "", "of the curves: plain, peak or noise"},
    {"terms", "", "with --terms or --law-terms auto: the choice"},
    {"terms.of", "", "elastic or memory"},
    {"terms.chosen", "", "number of terms"},
    {"terms.runner_up", "", "hardly worse, or null"},
    {"terms.reason", "", "of the choice"},
    {"terms.tried", "", "one object a number of terms"},
    {"terms.tried[].terms", "", "number of terms"},
    {"terms.tried[].constants", "", "that were searched"},
    {"terms.tried[].aicc", "1", "Akaike's criterion, corrected"},
    {"terms.tried[].r_squared", "1", "1 - SSE/SST over all points"},
    {"terms.tried[].rmse_Pa", "Pa", "root of the mean square residual"},
    {"terms.tried[].converged", "", "the search ended well"},
    {"bootstrap", "", "with --bootstrap: what became of the refits"},
    {"bootstrap.refits", "", "asked for"},
    {"bootstrap.failed", "", "did not converge"},
    {"bootstrap.seed", "", "of the signs"},
    {"bootstrap.block_rows", "", "rows that share a sign, at most"},
    {"bootstrap.reason", "", "why some are left out, or why there are no intervals"},
    EXPONENTIALS("memory_as_exponentials"),
    {"held_out", "", "with --hold-out: one object a curve, predicted from the others"},
    {"held_out[].file", "", "path as given"},
    {"held_out[].rmse_Pa", "Pa", "error of the prediction"},
    {"held_out[].rmse_over_peak", "1", "that over its largest stress"},
    {"held_out[].r_squared", "1", "1 - SSE/SST of the prediction"},
};

static const key_row test[] = {
    {"tissue", "", "name of the tissue"},
    {"points", "", "rows of the curve"},
    {"peak_*", "as named",
     "value farthest from rest of a column: `peak_stretch`, `peak_stress_Pa`"},
    {"duration_s", "s", "time of the last row"},
    {"cycles", "", "cyclic: one object a cycle"},
    {"cycles[].cycle", "", "its number, those before the record counted"},
    {"cycles[].peak_stress_Pa", "Pa", "largest nominal stress"},
    {"cycles[].hysteresis", "1", "loop area over area under the loading curve"},
    {"peak_change", "1", "cyclic: of the peak stress from the last cycle but one to the last"},
    EXPONENTIALS("memory"),
    EXPONENTIALS("memory.deviatoric"),
    EXPONENTIALS("memory.volumetric"),
    EXPONENTIALS("memory.fibre"),
    {"rmse_Pa", "Pa", "with --replay: error of the prediction"},
    {"rmse_over_peak", "1", "with --replay: that over the largest measured stress"},
    {"r_squared", "1", "with --replay: 1 - SSE/SST"},
    {"sweep", "", "hysteresis and dynamic: one object a speed"},
    {"sweep[].frequency_Hz", "Hz", "1/(2 ramp), or that of the oscillation"},
    {"sweep[].ramp_s", "s", "hysteresis: time of the ramp"},
    {"sweep[].hysteresis", "1", "hysteresis: loop area over area under the loading curve"},
    {"sweep[].storage_modulus_Pa", "Pa", "dynamic: in phase with the stretch"},
    {"sweep[].loss_modulus_Pa", "Pa", "dynamic: in phase with its rate"},
    {"sweep[].tan_delta", "1", "dynamic: loss over storage"},
};

static const key_row runs[] = {
    {"engine", "", "springs or continuum"},
    {"model", "", "rung or element"},
    {"nodes", "", "of the mesh"},
    {"cells", "", "tetrahedra"},
    {"springs", "", "edges of central rungs"},
    {"unknowns", "", "of the continuum's system"},
    {"step_s", "s", "smallest step"},
    {"steps", "", "number of steps"},
    {"simulated_s", "s", "time reached"},
    {"wall_s", "s", "time it took"},
    {"real_time_factor", "1", "simulated over wall: above 1 is faster than the clock"},
    {"step_wall_p50_s", "s", "median of the time of a step"},
    {"step_wall_p99_s", "s", "99th percentile"},
    {"step_wall_max_s", "s", "longest step"},
    {"threads", "", "used"},
    {"ranks", "", "processes that shared the work; continuum, else 0"},
    {"newton_iterations", "", "in all"},
    {"cutbacks", "", "steps that were halved"},
    {"kinetic_J", "J", "kinetic energy at the end"},
    {"elastic_J", "J", "elastic energy at the end (springs: of the equilibrium part)"},
    {"memory_J", "J", "stored in the branches of the memory at the end (springs)"},
    {"dissipated_J", "J", "by memory, damping, friction and cuts"},
    {"released_J", "J", "of that by cuts: what removed cells had stored (springs)"},
    {"cells_removed", "", "by cuts"},
    {"external_work_J", "J", "of loads, supports and tools"},
    {"energy_residual", "1", "what is missing in the balance, relative"},
    {"memory_terms", "", "exponentials that stand for the memory"},
    {"memory_error", "1", "their largest error, of G(0) = 1"},
    {"memory_band_s[]", "s", "over this band of times"},
    {"converged", "", "it ran to its end"},
    {"reason", "", "why not"},
    {"note", "", "what else to know"},
    {"probes", "", "last row of the history"},
    {"probes.*", "m or N", "one component of a probe, reaction or tool"},
    {"refinement", "", "with --refine: what finer meshes say"},
    {"refinement.meshes", "", "coarse to fine, the case's own first"},
    {"refinement.meshes[].model", "", "element"},
    {"refinement.meshes[].nodes", "", "of the mesh, with midsides"},
    {"refinement.meshes[].cells", "", "tetrahedra"},
    {"refinement.meshes[].unknowns", "", "of its system"},
    {"refinement.meshes[].wall_s", "s", "time it took"},
    {"refinement.quantities", "", "last row of the history, and elastic_J"},
    {"refinement.quantities.*", "as named", "one of them"},
    {"refinement.quantities.*.values[]", "as named", "on every mesh"},
    {"refinement.quantities.*.order", "1", "of convergence in the cell size"},
    {"refinement.quantities.*.observed", "", "false: the order is assumed"},
    {"refinement.quantities.*.extrapolated", "as named", "to a mesh without end (Richardson)"},
    {"refinement.quantities.*.errors[]", "as named", "estimated error of each value"},
    {"refinement.reason", "", "why a finer mesh is missing"},
};

#define MODEL(prefix)                                                                              \
    {prefix ".name", "", "rung or element"},                                                       \
        {prefix ".mesh", "", "factor on the cells of the case along each edge"},                   \
        {prefix ".done", "", "it ran to its end"}, {prefix ".reason", "", "why not"},              \
        {prefix ".displacement_rms", "1", "root mean square error of displacements"},              \
        {prefix ".displacement_max", "1", "largest error of displacements"},                       \
        {prefix ".response_rms", "1",                                                              \
         "of the force on what is moved, the motion of what is pushed"},                           \
        {prefix ".reaction_rms", "1", "root mean square error of forces"},                         \
        {prefix ".stress_rms", "1", "root mean square error of stresses"},                         \
        {prefix ".energy", "1", "error of the elastic energy"},                                    \
        {prefix ".relaxation_max", "1",                                                            \
         "of a force without its elastic error; null: no memory, no force answers"},               \
        {prefix ".wall_s", "s", "time it took"},                                                   \
        {prefix ".real_time_factor", "1", "simulated over wall"},                                  \
        {prefix ".live", "", "frames of 1 ms of the explicit engine; null for elements"},          \
        {prefix ".live.step_s", "s", "stable step"},                                               \
        {prefix ".live.real_time_factor", "1", "of the median frame"},                             \
        {prefix ".live.frame_p50_s", "s", "median wall time of a frame"},                          \
        {prefix ".live.frame_p99_s", "s", "99 % of the frames took less"},                         \
        {prefix ".live.frame_max_s", "s", "the longest frame"},                                    \
        {prefix ".calibration_s", "s", "time that finding the springs' constants took"},           \
        {prefix ".peak_memory_bytes", "byte", "of the run"},                                       \
        {prefix ".nodes", "", "of its mesh, with midsides"}, {prefix ".cells", "", "tetrahedra"},  \
        {prefix ".springs", "", "of a central net"}, {                                             \
        prefix ".memory_terms", "", "exponentials that stand for the memory"                       \
    }

#define COMPARISON(prefix)                                                                         \
    {prefix "case", "", "name of the case"}, {prefix "file", "", "where it was read"},             \
        {prefix "reference", "", "the converged model; its errors are its own estimated ones"},    \
        MODEL(prefix "reference"), {prefix "reference.text", "", "how it was converged"},          \
        {prefix "models", "", "one object a model and mesh; errors over the reference's largest"}, \
        MODEL(prefix "models[]"), {prefix "left_out", "", "models that --models would run"},       \
        {prefix "left_out[].name", "", "of the model"}, {prefix "left_out[].reason", "", "why"}, { \
        prefix "words[]", "", "which model to use for which error; what is missing"                \
    }

static const key_row comparison[] = {COMPARISON("")};

static const key_row study[] = {
    {"cases", "", "one object a case, as compare.json"},
    COMPARISON("cases[]."),
    {"summary", "", "one object a model and mesh, over all cases"},
    {"summary[].name", "", "of the model"},
    {"summary[].mesh", "", "factor on the cells of the cases along each edge"},
    {"summary[].nodes", "", "most of any case"},
    {"summary[].cases", "", "that ran to their end"},
    {"summary[].missing", "", "that did not"},
    {"summary[].median", "1", "error: the larger of displacement_rms and response_rms"},
    {"summary[].worst", "1", "the largest of these errors"},
    {"summary[].worst_case", "", "where it was found"},
    {"summary[].displacement_rms", "1", "worst"},
    {"summary[].response_rms", "1", "worst"},
    {"summary[].relaxation_max", "1", "worst; null where no case has a memory"},
    {"summary[].wall_s", "s", "of all cases"},
    {"summary[].live_real_time_factor", "1", "of the slowest case"},
    {"words[]", "", "which model to use for which error; what is missing"},
};

static const key_row calibration[] = {
    {"case", "", "name of the case"},
    {"rule", "", "full, affine, uniform or lloyd"},
    {"nodes", "", "of the mesh"},
    {"cells", "", "tetrahedra"},
    {"springs", "", "with a stiffness above 0"},
    {"springs_beyond_edges", "", "of them, those that are no edges of the mesh"},
    {"regions", "", "one object a region of the mesh"},
    {"regions[].name", "", "of the region"},
    {"regions[].force_residual", "1",
     "part of the nodal forces of even strains that no springs give; null where not fitted"},
    {"regions[].tensor_residual", "1",
     "the same of linearly growing strains, which hold the elastic tensor; on lattices of a tissue "
     "with directions, part of its tensor that edges do not give"},
    {"regions[].scale", "1", "common factor from the held tests"},
    {"regions[].strain", "1", "up to which the law of the springs was fitted"},
    {"regions[].exponent", "1", "of the law of the springs"},
    {"regions[].squares", "", "of the law of the springs"},
    {"regions[].squares[]", "1", "in tension xx, yy, zz, xy, yz, zx; in compression"},
    {"regions[].factor", "1", "on all stiffnesses, fitted with the law"},
    {"regions[].errors", "", "of the virtual tests"},
    {"regions[].errors.*", "1",
     "held and free: stiffness at small strain over the continuum's, less 1; finite: rms of the "
     "stress over its largest"},
    {"regions[].worst", "", "the test with the largest error"},
    {"regions[].worst.*", "", "of each kind"},
};

static const key_row bench_springs[] = {
    {"results", "", "one object a net"},
    {"results[].model", "", "rung"},
    {"results[].law", "", "elastic law"},
    {"results[].volume", "", "with a volume energy"},
    {"results[].memory_terms", "", "exponentials"},
    {"results[].nodes", "", "of the net"},
    {"results[].springs", "", "of the net"},
    {"results[].cells", "", "of the net"},
    {"results[].threads", "", "used"},
    {"results[].precision", "", "single or double"},
    {"results[].springs_per_second", "1/s", "whole steps"},
    {"results[].cells_per_second", "1/s", "whole steps"},
    {"results[].bound_per_second", "1/s", "the lower of the two bounds below"},
    {"results[].memory_bound_per_second", "1/s", "what the memory's bandwidth allows"},
    {"results[].arithmetic_bound_per_second", "1/s", "what the arithmetic rate allows"},
    {"results[].plain_per_second", "1/s", "a plain scalar loop of the same work"},
    {"results[].step_s", "s", "stable step"},
    {"results[].real_time_factor", "1", "simulated over wall time"},
    {"results[].memory_cost", "", "time of a step over that with no exponentials; else null"},
    {"results[].thread_gain", "", "speed over that of one thread; else null"},
    {"machine", "", "processor"},
    {"kernels", "", "instruction set"},
};

static const key_row bench_continuum[] = {
    {"results", "", "one object a body"},
    {"results[].element", "", "P1, P2 or P2P1"},
    {"results[].ranks", "", "processes"},
    {"results[].nodes", "", "with midsides"},
    {"results[].cells", "", "tetrahedra"},
    {"results[].unknowns", "", "free displacements and pressures"},
    {"results[].steps", "", "of the load"},
    {"results[].newton_iterations", "", "of all steps"},
    {"results[].factorisations", "", "of the tangent, or hierarchies of multigrid"},
    {"results[].applications", "", "of factors or of multigrid, in all linear solutions"},
    {"results[].systems", "", "linear ones that were solved"},
    {"results[].rescues", "", "of these, left to factors; iterative"},
    {"results[].cycles", "", "of multigrid for the last system to 1e-8; iterative"},
    {"results[].residual_ns", "ns", "a cell: the forces once"},
    {"results[].tangent_ns", "ns", "a cell: the tangent once, insertion included"},
    {"results[].solve_s", "s", "of the processor, slowest rank: linear solutions"},
    {"results[].total_s", "s", "of the processor, slowest rank: the whole run"},
    {"results[].wall_s", "s", "of the clock: the whole run"},
    {"results[].peak_memory_bytes", "B", "of all ranks; 0 where unknown"},
    {"machine", "", "processor"},
};

static const key_row bench_haptic[] = {
    {"results", "", "one object a size and number of threads"},
    {"results[].nodes", "", "of the net"},
    {"results[].springs", "", "of the net"},
    {"results[].threads", "", "used"},
    {"results[].largest", "", "whether it is the largest size that holds 1 ms"},
    {"results[].frames", "", "of 1 ms of simulated time"},
    {"results[].steps_per_frame", "", "explicit steps, mean"},
    {"results[].frame_p50_s", "s", "wall time of a frame: half of them took less"},
    {"results[].frame_p999_s", "s", "99.9 % of them"},
    {"results[].frame_max_s", "s", "the longest"},
    {"results[].cpu_p50_s", "s", "time that the calling thread ran in a frame: half of them"},
    {"results[].cpu_p999_s", "s", "99.9 % of them"},
    {"results[].worst_steps", "", "of the longest thousandth of frames: steps in each, mean"},
    {"results[].worst_looks", "", "part of those with a look at the frequency"},
    {"results[].worst_cpu_s", "s", "time that the calling thread ran in those, mean"},
    {"results[].real_time_factor", "", "simulated over wall time"},
    {"results[].force_N", "N", "largest on the sphere"},
    {"results[].warnings", "", "states recovered"},
    {"machine", "", "processor"},
    {"kernels", "", "instruction set"},
};

static const key_row bench_fit[] = {
    {"results", "", "one object a fit"},
    {"results[].what", "", "the data"},
    {"results[].points", "", "rows"},
    {"results[].seconds", "s", "time it took"},
    {"results[].evaluations", "", "of the model"},
    {"direct_convolution_s", "s", "one curve by a plain convolution"},
    {"recursion_s", "s", "the same by the recursion"},
    {"machine", "", "processor"},
};

static const key_row conversion[] = {
    {"tissue", "", "name of the tissue"},
    {"elastic", "", "name of the elastic law"},
    {"memory", "", "name of the memory that was read"},
    {"terms", "", "exponentials in the file of the other program"},
    {"max_error", "1", "what their number costs, of G(0) = 1"},
    {"remarks", "", "what differs between the two"},
};

static const key_row lists[] = {
    {"*", "", "the topic: one object a section"},
    {"*[].name", "", "law, command, …; absent where there is one section"},
    {"*[].text", "", "what it is"},
    {"*[].rows", "", "one object a row"},
    {"*[].rows[].*", "", "a column of the printed table"},
};

#define TABLE(name, text, rows)                                                                    \
    { name, text, rows, (int)(sizeof(rows) / sizeof(rows)[0]) }

static const key_table tables[] = {
    TABLE("analyze-tensile", "`sinew analyze --test tensile`, analysis.json", tensile),
    TABLE("analyze-cyclic", "`sinew analyze --test cyclic`, analysis.json", cyclic),
    TABLE("analyze-relaxation", "`sinew analyze --test relaxation`, analysis.json", relaxation),
    TABLE("analyze-creep", "`sinew analyze --test creep`, analysis.json", creep),
    TABLE("analyze-dynamic", "`sinew analyze --test dynamic`, analysis.json", dynamic),
    TABLE("analyze-biaxial", "`sinew analyze --test biaxial`, analysis.json", biaxial),
    TABLE("fit", "`sinew fit`, fit.json", fit),
    TABLE("test", "`sinew test`", test),
    TABLE("run", "`sinew run`, summary.json", runs),
    TABLE("calibrate", "`sinew calibrate`, calibration.json", calibration),
    TABLE("compare", "`sinew compare` of one case, compare.json", comparison),
    TABLE("study", "`sinew compare` of several cases, study.json", study),
    TABLE("bench-springs", "`sinew bench springs`", bench_springs),
    TABLE("bench-continuum", "`sinew bench continuum`", bench_continuum),
    TABLE("bench-haptic", "`sinew bench springs --haptic`", bench_haptic),
    TABLE("bench-fit", "`sinew bench fit`", bench_fit),
    TABLE("convert", "`sinew convert`", conversion),
    TABLE("list", "`sinew list`", lists),
};

#define TABLES ((int)(sizeof tables / sizeof tables[0]))

//---- the keys of a result file -------------------------------------------------------------------

typedef struct scan {
    const key_table *table;
    const char *file;
    bool *seen; ///< rows of the table that were found         (count)
} scan;

// a path as fnmatch() wants it: names apart by slashes, and no brackets
static void plain(const char *path, char out[256]) {
    snprintf(out, 256, "%s", path);
    for (char *s = out; *s; s++) *s = *s == '.' ? '/' : *s == '[' || *s == ']' ? '!' : *s;
}

// the row of a path: an exact one before one with a wildcard, which stands for one name
static int find_row(const key_table *table, const char *path) {
    char name[256], pattern[256];
    for (int k = 0; k < table->count; k++)
        if (strcmp(table->rows[k].path, path) == 0) return k;
    plain(path, name);
    for (int k = 0; k < table->count; k++) {
        plain(table->rows[k].path, pattern);
        if (strchr(pattern, '*') && fnmatch(pattern, name, FNM_PATHNAME) == 0) return k;
    }
    return -1;
}

static int visit(scan *s, const json_t *value, const char *path);

static int visit_object(scan *s, const json_t *object, const char *path) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value) {
        char name[256];
        snprintf(name, sizeof name, "%s%s%s", path, *path ? "." : "", key);
        int code = visit(s, value, name);
        if (code >= 0) return code;
    }
    return -1;
}

// A list of numbers, texts or lists is one value, "g[]"; of a list of objects the list itself and
// every key of its objects have rows. What is empty tells nothing of its items and passes.
static int visit_array(scan *s, const json_t *array, const char *path) {
    size_t i;
    json_t *item;
    char name[256];
    snprintf(name, sizeof name, "%s[]", path);
    int row = find_row(s->table, path);
    if (row >= 0) s->seen[row] = true;
    if (row < 0 && json_is_object(json_array_get(array, 0)))
        return cli_refuse("%s: unknown key \"%s\" of %s", s->file, path, s->table->command);
    json_array_foreach(array, i, item) {
        int code = json_is_object(item) ? visit_object(s, item, name) : visit(s, item, name);
        if (code >= 0) return code;
    }
    return -1;
}

static int visit(scan *s, const json_t *value, const char *path) {
    if (json_is_array(value)) return visit_array(s, value, path);
    int row = find_row(s->table, path);
    if (row < 0)
        return cli_refuse("%s: unknown key \"%s\" of %s", s->file, path, s->table->command);
    s->seen[row] = true;
    return json_is_object(value) ? visit_object(s, value, path) : -1;
}

static int scan_file(scan *s) {
    json_error_t error;
    json_t *json = json_load_file(s->file, 0, &error);
    if (!json) return cli_refuse("%s:%d: no JSON: %s", s->file, error.line, error.text);
    int code = json_is_object(json) ? visit_object(s, json, "")
                                    : cli_refuse("%s: expected a JSON object", s->file);
    json_decref(json);
    return code;
}

static void add_rows(json_t *sections, const key_table *table, const bool *seen) {
    char text[128];
    snprintf(text, sizeof text, "%s.", table->text);
    json_t *rows = list_section(sections, table->command, text);
    for (int k = 0; k < table->count; k++) {
        if (seen && !seen[k]) continue;
        json_t *row = json_object();
        cli_put_text(row, "key", table->rows[k].path);
        cli_put_text(row, "unit", table->rows[k].unit);
        cli_put_text(row, "meaning", table->rows[k].meaning);
        json_array_append_new(rows, row);
    }
}

int list_keys(json_t *sections, int count, char **names) {
    const char *known[TABLES];
    for (int k = 0; k < TABLES; k++) {
        known[k] = tables[k].command;
        if (count > 0 && strcmp(names[0], known[k]) != 0) continue;
        if (count < 2) {
            add_rows(sections, &tables[k], NULL);
            continue;
        }
        bool *seen = sn_alloc((size_t)tables[k].count, sizeof *seen);
        if (!seen) return cli_fail(SN_E_MEMORY);
        int code = -1;
        for (int i = 1; i < count && code < 0; i++) {
            scan s = {&tables[k], names[i], seen};
            code = scan_file(&s);
        }
        if (code < 0) add_rows(sections, &tables[k], seen);
        sn_free(seen);
        return code;
    }
    return json_array_size(sections) ? -1 : cli_unknown("command", names[0], known, TABLES);
}
