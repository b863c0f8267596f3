// The ranks of MPI that share one body: who owns which cells and nodes, and what is exchanged.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/ranks.h"

#include <limits.h>
#include <petscdmplex.h>
#include <petscsf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "continuum/petsc.h"
#include "continuum/space.h"
#include "sinew/continuum.h"

_Static_assert(sizeof(PetscInt) == sizeof(int), "PETSc with 32-bit indices");

#if defined(PETSC_HAVE_PTSCOTCH)
#define PARTITIONER PETSCPARTITIONERPTSCOTCH
#elif defined(PETSC_HAVE_PARMETIS)
#define PARTITIONER PETSCPARTITIONERPARMETIS
#else
#define PARTITIONER PETSCPARTITIONERSIMPLE
#endif

//---- parting ------------------------------------------------------------------------------------

// The cells that a distributed mesh has on this rank: 1 + rank into `owner` there.
static sn_status mark_own(DM spread, PetscSF migration, int rank, int *owner) {
    sn_status status = SN_OK;
    PetscInt leaves, first, end;
    const PetscInt *at;
    const PetscSFNode *from;
    TRY_PETSC(DMPlexGetHeightStratum(spread, 0, &first, &end), "parts of the mesh");
    TRY_PETSC(PetscSFGetGraph(migration, NULL, &leaves, &at, &from), "parts of the mesh");
    for (PetscInt k = 0; k < leaves; k++) {
        PetscInt point = at ? at[k] : k;
        if (point >= first && point < end) owner[from[k].index] = 1 + rank;
    }
fail:
    return status;
}

// The rank of each cell, by DMPlex: the first rank knows the mesh and gives it away.
static sn_status part_cells(const sn_mesh *mesh, sn_fe_ranks *r) {
    sn_status status = SN_OK;
    DM whole = NULL, spread = NULL;
    PetscSF migration = NULL;
    PetscPartitioner partitioner;
    int cells = mesh->cell_count;
    bool first = r->rank == 0;
    PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    TRY_PETSC(DMPlexCreateFromCellListPetsc(PETSC_COMM_WORLD, 3, first ? cells : 0,
                                            first ? mesh->node_count : 0, 4, PETSC_FALSE,
                                            mesh->cell, 3, mesh->node, &whole),
              "mesh for DMPlex");
    TRY_PETSC(DMPlexGetPartitioner(whole, &partitioner), "parts of the mesh");
    TRY_PETSC(PetscPartitionerSetType(partitioner, PARTITIONER), "parts of the mesh");
    TRY_PETSC(DMPlexDistribute(whole, 0, &migration, &spread), "parts of the mesh");
    SN_TRY_GOTO(status, mark_own(spread, migration, r->rank, r->cell_owner));
    MPI_Allreduce(MPI_IN_PLACE, r->cell_owner, cells, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
    for (int c = 0; c < cells; c++) r->cell_owner[c]--;
fail:
    PetscSFDestroy(&migration);
    DMDestroy(&spread);
    DMDestroy(&whole);
    PetscPopErrorHandler();
    return status;
}

// Items by owner, rising within: a counting sort.
static void list_by_owner(int items, const int *owner, int count, int *list, int *start) {
    memset(start, 0, ((size_t)count + 1) * sizeof *start);
    for (int k = 0; k < items; k++) start[owner[k] + 1]++;
    for (int p = 0; p < count; p++) start[p + 1] += start[p];
    for (int k = 0; k < items; k++) list[start[owner[k]]++] = k;
    for (int p = count; p > 0; p--) start[p] = start[p - 1];
    start[0] = 0;
}

static void share_nodes(const sn_mesh *mesh, const sn_fe_space *s, sn_fe_ranks *r) {
    int node[SN_FE_NODES];
    for (int a = 0; a < s->nodes; a++) r->node_owner[a] = r->count;
    for (int c = 0; c < mesh->cell_count; c++) {
        sn_fe_cell_nodes(s, mesh, c, node);
        for (int a = 0; a < s->element.nodes; a++)
            if (r->cell_owner[c] < r->node_owner[node[a]])
                r->node_owner[node[a]] = r->cell_owner[c];
    }
    for (int a = 0; a < s->nodes; a++) // of no cell
        if (r->node_owner[a] == r->count) r->node_owner[a] = 0;
    for (int c = 0; c < mesh->cell_count; c++) {
        sn_fe_cell_nodes(s, mesh, c, node);
        for (int a = 0; a < s->element.nodes; a++) r->near[c] |= r->node_owner[node[a]] == r->rank;
        r->near[c] |= r->cell_owner[c] == r->rank;
    }
    for (int a = 0; a < s->corners; a++) r->corners[r->node_owner[a]]++;
    list_by_owner(mesh->cell_count, r->cell_owner, r->count, r->cell_list, r->cell_start);
    list_by_owner(s->nodes, r->node_owner, r->count, r->node_list, r->node_start);
}

//---- life ---------------------------------------------------------------------------------------

void sn_fe_ranks_destroy(sn_fe_ranks *r) {
    if (!r) return;
    void *const parts[] = {r->near,       r->cell_owner, r->cell_list,  r->cell_start,
                           r->node_owner, r->node_list,  r->node_start, r->corners,
                           r->size,       r->from,       r->packed};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(r);
}

static sn_status alloc_lists(const sn_mesh *mesh, const sn_fe_space *s, sn_fe_ranks *r) {
    size_t cells = (size_t)mesh->cell_count, nodes = (size_t)s->nodes, count = (size_t)r->count;
    r->near = sn_alloc(cells, sizeof *r->near);
    r->cell_owner = sn_alloc(cells, sizeof *r->cell_owner);
    r->cell_list = sn_alloc(cells, sizeof *r->cell_list);
    r->cell_start = sn_alloc(count + 1, sizeof *r->cell_start);
    r->node_owner = sn_alloc(nodes, sizeof *r->node_owner);
    r->node_list = sn_alloc(nodes, sizeof *r->node_list);
    r->node_start = sn_alloc(count + 1, sizeof *r->node_start);
    r->corners = sn_alloc(count, sizeof *r->corners);
    r->size = sn_alloc(count, sizeof *r->size);
    r->from = sn_alloc(count, sizeof *r->from);
    size_t most = 3 * nodes + (size_t)s->corners + count;
    r->packed = sn_alloc(most > cells ? most : cells, sizeof *r->packed);
    return r->near && r->cell_owner && r->cell_list && r->cell_start && r->node_owner &&
                   r->node_list && r->node_start && r->corners && r->size && r->from && r->packed
               ? SN_OK
               : SN_E_MEMORY;
}

sn_status sn_fe_ranks_create(const sn_mesh *mesh, const sn_fe_space *s, sn_fe_ranks **ranks) {
    sn_status status = SN_OK;
    *ranks = NULL;
    sn_fe_ranks *r = sn_alloc(1, sizeof *r);
    if (!r) return SN_E_MEMORY;
    SN_TRY_GOTO(status, sn_ranks_join(&r->rank, &r->count));
    if (r->count > mesh->cell_count)
        SN_TRY_GOTO(status, sn_fail(SN_E_DEFINITION,
                                    "%d ranks for a mesh of %d cells: start at most one a cell",
                                    r->count, mesh->cell_count));
    if (r->count > 1) {
        SN_TRY_GOTO(status, sn_fe_agree(r, alloc_lists(mesh, s, r)));
        SN_TRY_GOTO(status, part_cells(mesh, r));
        share_nodes(mesh, s, r);
    }
    *ranks = r;
    return SN_OK;
fail:
    sn_fe_ranks_destroy(r);
    return status;
}

//---- exchange -----------------------------------------------------------------------------------

// The parts of all ranks, which lie in `packed` by r->size and r->from.
static void exchange(const sn_fe_ranks *r) {
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, r->packed, r->size, r->from, MPI_DOUBLE,
                   PETSC_COMM_WORLD);
}

/// Which values of the nodes go round: `nodes` (x 3) and `corners` are NULL where not.
typedef struct values {
    double *nodes, *corners;
    int *number; ///< Nullable: of all ranks the smallest remains
} values;

// The part of one rank, into `packed` or out of it.
static void copy_part(const sn_fe_ranks *r, int p, const values *v, bool out) {
    const int *node = r->node_list + r->node_start[p];
    double *at = r->packed + r->from[p];
    for (int k = 0; k < r->node_start[p + 1] - r->node_start[p] && v->nodes; k++, at += 3)
        for (int i = 0; i < 3; i++)
            *(out ? at + i : v->nodes + 3 * node[k] + i) =
                *(out ? v->nodes + 3 * node[k] + i : at + i);
    for (int k = 0; k < r->corners[p] && v->corners; k++, at++)
        *(out ? at : v->corners + node[k]) = *(out ? v->corners + node[k] : at);
    if (v->number && out) *at = *v->number;
    if (v->number && *at < *v->number) *v->number = (int)*at;
}

static void gather(const sn_fe_ranks *r, const values *v) {
    if (r->count == 1) return;
    for (int p = 0, from = 0; p < r->count; from += r->size[p++]) {
        r->from[p] = from;
        r->size[p] = (v->nodes ? 3 * (r->node_start[p + 1] - r->node_start[p]) : 0) +
                     (v->corners ? r->corners[p] : 0) + (v->number ? 1 : 0);
    }
    copy_part(r, r->rank, v, true);
    exchange(r);
    for (int p = 0; p < r->count; p++)
        if (p != r->rank) copy_part(r, p, v, false);
}

void sn_fe_gather_nodes(const sn_fe_space *s, double *v) {
    gather(s->ranks, &(values){.nodes = v});
}

void sn_fe_gather_corners(const sn_fe_space *s, double *v) {
    gather(s->ranks, &(values){.corners = v});
}

void sn_fe_gather_unknowns(const sn_fe_space *s, double *v) {
    sn_fe_gather_least(s, v, NULL);
}

void sn_fe_gather_least(const sn_fe_space *s, double *v, int *number) {
    double *pressures = s->element.mixed ? v + 3 * (size_t)s->nodes : NULL;
    gather(s->ranks, &(values){v, pressures, number});
}

void sn_fe_gather_cells(const sn_fe_ranks *r, int width, double *v) {
    if (r->count == 1) return;
    for (int p = 0; p < r->count; p++) {
        r->from[p] = r->cell_start[p];
        r->size[p] = r->cell_start[p + 1] - r->cell_start[p];
    }
    double *own = r->packed + r->from[r->rank];
    const int *cell = r->cell_list + r->from[r->rank];
    for (int i = 0; i < width; i++) {
        for (int k = 0; k < r->size[r->rank]; k++)
            own[k] = v[(size_t)width * (size_t)cell[k] + (size_t)i];
        MPI_Gatherv(r->rank == 0 ? MPI_IN_PLACE : own, r->size[r->rank], MPI_DOUBLE, r->packed,
                    r->size, r->from, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
        for (int k = 0; k < r->cell_start[r->count] && r->rank == 0; k++)
            v[(size_t)width * (size_t)r->cell_list[k] + (size_t)i] = r->packed[k];
    }
}

// In pieces that fit the counts of MPI.
void sn_fe_gather_parts(const sn_fe_ranks *r, const size_t *length, double *part) {
    size_t most = INT_MAX / 2;
    for (int p = 1; p < r->count; p++) {
        part += r->rank == 0 ? length[p - 1] : 0;
        for (size_t at = 0; at < length[p] && (r->rank == 0 || r->rank == p); at += most) {
            int size = (int)(length[p] - at < most ? length[p] - at : most);
            if (r->rank == p)
                MPI_Send(part + at, size, MPI_DOUBLE, 0, 0, PETSC_COMM_WORLD);
            else
                MPI_Recv(part + at, size, MPI_DOUBLE, p, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE);
        }
    }
}

static double reduce(const sn_fe_ranks *r, double value, MPI_Op by) {
    double all = value;
    if (r->count > 1) MPI_Allreduce(&value, &all, 1, MPI_DOUBLE, by, PETSC_COMM_WORLD);
    // of a sum the ranks might see different roundings
    if (r->count > 1 && by == MPI_SUM) MPI_Bcast(&all, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD);
    return all;
}

double sn_fe_sum(const sn_fe_ranks *r, double value) {
    return reduce(r, value, MPI_SUM);
}

double sn_fe_largest(const sn_fe_ranks *r, double value) {
    return reduce(r, value, MPI_MAX);
}

bool sn_fe_all(const sn_fe_ranks *r, bool holds) {
    return r->count == 1 ? holds : reduce(r, holds ? 1.0 : 0.0, MPI_MIN) > 0.5;
}

void sn_fe_from_holder(const sn_fe_ranks *r, bool holds, double *value) {
    int holder = holds ? r->rank : r->count;
    if (r->count == 1) return;
    MPI_Allreduce(MPI_IN_PLACE, &holder, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
    SN_ASSERT(holder < r->count);
    MPI_Bcast(value, 1, MPI_DOUBLE, holder, PETSC_COMM_WORLD);
}

int sn_fe_from_first(const sn_fe_ranks *r, int value) {
    if (r->count > 1) MPI_Bcast(&value, 1, MPI_INT, 0, PETSC_COMM_WORLD);
    return value;
}

sn_status sn_fe_agree(const sn_fe_ranks *r, sn_status status) {
    char text[SN_TEXT_MAX];
    int failed = status == SN_OK ? r->count : r->rank, code = (int)status;
    if (r->count == 1) return status;
    MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
    if (failed == r->count) return SN_OK;
    snprintf(text, sizeof text, "%s", sn_error_text());
    MPI_Bcast(text, (int)sizeof text, MPI_CHAR, failed, PETSC_COMM_WORLD);
    MPI_Bcast(&code, 1, MPI_INT, failed, PETSC_COMM_WORLD);
    return sn_fail((sn_status)code, "%s", text);
}

//---- the beginning and the end of all ------------------------------------------------------------

static sn_fe_ranks world = {.count = 1};
static MPI_Comm aside; // for those who leave, while others may wait in PETSC_COMM_WORLD
static bool lost;

sn_status sn_ranks_join(int *rank, int *count) {
    static const char *const signs[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
    bool launched = false;
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) launched |= getenv(signs[k]) != NULL;
    if (launched && world.count == 1) {
        SN_TRY(sn_fe_petsc_start());
        MPI_Comm_rank(PETSC_COMM_WORLD, &world.rank);
        MPI_Comm_size(PETSC_COMM_WORLD, &world.count);
        if (world.count > 1) MPI_Comm_dup(PETSC_COMM_WORLD, &aside);
    }
    *rank = world.rank;
    *count = world.count;
    return SN_OK;
}

sn_status sn_ranks_agree(sn_status status) {
    return sn_fe_agree(&world, status);
}

bool sn_ranks_lost(void) {
    return lost;
}

void sn_ranks_abort(int code) {
    if (world.count > 1) MPI_Abort(PETSC_COMM_WORLD, code);
}

#define PATIENCE 3.0 // seconds that a rank with an error waits for the others
#define STAGGER 0.5  // more for each rank: the first that gives up ends all

sn_status sn_fe_settle(sn_status status) {
    MPI_Request request;
    int met = 0, here = 1, all = 0;
    const struct timespec nap = {.tv_nsec = 1000000};
    if (world.count == 1) return status;
    MPI_Iallreduce(&here, &all, 1, MPI_INT, MPI_SUM, aside, &request);
    if (status == SN_OK) {
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    } else {
        double end = sn_clock() + PATIENCE + STAGGER * world.rank;
        while (!met && sn_clock() < end) {
            MPI_Test(&request, &met, MPI_STATUS_IGNORE);
            if (!met) nanosleep(&nap, NULL);
        }
        lost = !met;
        if (lost) return status;
    }
    return sn_fe_agree(&world, status);
}
