// Error norms on what two runs of one case handed out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compare/sample.h"

/// Displacements and stresses of a run at its output times, at the points of some mesh.
typedef struct sn_capture {
    const sn_sampler *sampler; ///< Nullable: the run's own mesh is that of the points
    int nodes, cells;          ///< of the mesh of the points
    int frames, capacity;
    double *time;         ///< seconds                             (frames)
    double *displacement; ///< m                                   (frames x nodes x 3)
    double *stress;       ///< Cauchy stress, Pa                   (frames x cells x 6)
} sn_capture;

/// Takes what a frame has at the points: an sn_output frame callback, context a zeroed sn_capture
/// with nodes and cells, and maybe the sampler, set. @return SN_OK, SN_E_MEMORY.
sn_status sn_capture_frame(void *context, const sn_frame *frame);
void sn_capture_release(sn_capture *capture);

/// Weights of the nodes: a quarter of the volume of every cell around a node, over the whole.
/// *weight is sn_alloc'd for the caller.                            (node_count)
sn_status sn_node_weights(const sn_mesh *mesh, double **weight);
/// Volumes of the cells over the whole.                             (cell_count)
sn_status sn_cell_weights(const sn_mesh *mesh, double **weight);

/// Largest displacement magnitude over frames and nodes, m.
double sn_displacement_scale(const sn_capture *capture);
/// rms over frames and (weighted) nodes, and maximum, of |a - b| [m], over the frames both have.
void sn_displacement_error(const sn_capture *a, const sn_capture *b, const double *weight,
                           double *rms, double *max);
/// rms over frames and (weighted) cells of the Frobenius norm of the difference of stresses, Pa.
double sn_stress_error(const sn_capture *a, const sn_capture *b, const double *weight);
/// Largest Frobenius norm of the stress over frames and cells, Pa.
double sn_stress_scale(const sn_capture *capture);
/// Worst over all force columns (NAME_fx NAME_fy NAME_fz) of the rms over rows of the difference of
/// two histories, over the largest force of that name in `b`. Columns with less than a millionth of
/// the largest force are rounding and do not count. NAN where there is no force.
double sn_reaction_error(const sn_record *a, const sn_record *b);

/// Values of a field of a frame; every engine hands out displacement and cauchy_stress.
const double *sn_frame_field(const sn_frame *frame, const char *name);
