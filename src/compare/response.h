// What is done to a body and what it answers: force against motion, over time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

enum { SN_DRIVES_MAX = 16 };

/// A load or a tool with the one number that is prescribed and the one that answers. Their product,
/// integrated, is the work.
typedef struct sn_drive {
    int load, tool;      ///< one of them; the other -1
    double direction[3]; ///< of motion and force; zero of a pressure, which has the normal
    int column;          ///< of the force in the history where the force answers, else -1
} sn_drive;

typedef struct sn_response {
    const sn_case *c;    ///< borrowed
    const sn_mesh *mesh; ///< of the points at which displacements are known, borrowed
    int count;
    sn_drive drive[SN_DRIVES_MAX];
    sn_record *record; ///< owned
} sn_response;

/// Adds the probes that the answers need to a case of the caller's own, once.
/// @return SN_OK, SN_E_MEMORY.
sn_status sn_response_probes(sn_case *c);
/// Finds the drives of a case that sn_response_probes() has seen. Loads beyond SN_DRIVES_MAX have
/// no response. Motions are means over the surfaces of `mesh`, the same for all models: each on its
/// own mesh would add the error of a mean over few nodes.
sn_status sn_response_create(const sn_case *c, const sn_mesh *mesh, sn_response *response);
/// Whether any force answers.
bool sn_response_has_force(const sn_response *response);
void sn_response_release(sn_response *response);
/// Adds a row; forces that answer are still 0.
/// @param u  displacements, m                                 (nodes of the mesh x 3)
sn_status sn_response_frame(sn_response *response, double time, const double *u);
/// Takes the forces that answer from the history of the run.
void sn_response_finish(sn_response *response, const sn_record *history);

/// rms over common rows of the difference of what answers, over the largest in `b`; worst of the
/// drives. NAN where there is none.
double sn_response_error(const sn_record *a, const sn_record *b);

/// Forces of a run, and those of the same motion where the tissue has no memory: two responses.
typedef struct sn_force_pair {
    const sn_record *force;
    const sn_record *elastic; ///< Nullable: not known
} sn_force_pair;

/// Largest difference, over common rows, of the forces that answer a prescribed motion after their
/// elastic difference was taken out of `a` (the head of response.c says how), over the largest in
/// `b`; worst of the drives. NAN where no force answers or an elastic one is not known.
/// @param memory  Nullable: what remembers does not remember alike; then only the common factor of
///                the elastic forces is taken out
/// @return SN_OK, SN_E_MEMORY, what sn_memory_expand() says.
sn_status sn_relaxation_error(const sn_memory *memory, const sn_force_pair *a,
                              const sn_force_pair *b, double *error);
