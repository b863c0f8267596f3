// Cells that a case takes out of its body, and the mesh that is left.
// SPDX-License-Identifier: Apache-2.0
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/vector.h"
#include "model/mesh.h"

//---- cells of a cut ------------------------------------------------------------------------------

static bool is_inside(const sn_cut_def *cut, const double x[3]) {
    if (cut->kind == SN_CUT_SPHERE) return distance3(x, cut->centre) <= cut->radius;
    for (int d = 0; d < 3; d++)
        if (!(x[d] >= cut->low[d] && x[d] <= cut->high[d])) return false;
    return true;
}

static void find_centre(const sn_mesh *mesh, int cell, double x[3]) {
    x[0] = x[1] = x[2] = 0;
    for (int a = 0; a < 4; a++)
        for (int d = 0; d < 3; d++)
            x[d] +=
                0.25 * mesh->node[3 * (size_t)mesh->cell[4 * (size_t)cell + (size_t)a] + (size_t)d];
}

sn_status sn_case_cut_cells(const sn_case *c, int k, int **cells, int *count) {
    const sn_cut_def *cut = &c->cut[k];
    const bool listed = cut->kind == SN_CUT_CELLS;
    *count = 0;
    int *list = *cells =
        sn_alloc((size_t)(listed ? cut->cell_count : c->mesh->cell_count), sizeof *list);
    if (!list) return SN_E_MEMORY;
    if (listed) {
        if (cut->cell_count > 0) memcpy(list, cut->cell, (size_t)cut->cell_count * sizeof *list);
        qsort(list, (size_t)cut->cell_count, sizeof *list, compare_int);
        for (int n = 0; n < cut->cell_count; n++) // each once
            if (n == 0 || list[n] != list[*count - 1]) list[(*count)++] = list[n];
        return SN_OK;
    }
    for (int e = 0; e < c->mesh->cell_count; e++) {
        double x[3];
        find_centre(c->mesh, e, x);
        if (is_inside(cut, x)) list[(*count)++] = e;
    }
    return SN_OK;
}

//---- what is left --------------------------------------------------------------------------------

/// New numbers of what is left of a mesh; -1 for what is not.
typedef struct rest_numbers {
    int *node, *cell;
    int nodes, cells;
} rest_numbers;

static sn_status number_rest(const sn_mesh *mesh, const bool *removed, rest_numbers *n) {
    n->node = sn_alloc((size_t)mesh->node_count, sizeof *n->node);
    n->cell = sn_alloc((size_t)mesh->cell_count, sizeof *n->cell);
    if (!n->node || !n->cell) return SN_E_MEMORY;
    for (int i = 0; i < mesh->node_count; i++) n->node[i] = -1;
    for (int e = 0; e < mesh->cell_count; e++) {
        n->cell[e] = removed[e] ? -1 : n->cells++;
        for (int a = 0; a < 4 && !removed[e]; a++) n->node[mesh->cell[4 * e + a]] = 0;
    }
    for (int i = 0; i < mesh->node_count; i++)
        if (n->node[i] == 0) n->node[i] = n->nodes++;
    if (n->cells == 0) return sn_fail(SN_E_MESH, "all %d cells were removed", mesh->cell_count);
    return SN_OK;
}

static void copy_rest(const sn_mesh *mesh, const rest_numbers *n, sn_mesh *rest) {
    for (int i = 0; i < mesh->node_count; i++)
        if (n->node[i] >= 0)
            memcpy(rest->node + 3 * n->node[i], mesh->node + 3 * i, 3 * sizeof *mesh->node);
    for (int e = 0; e < mesh->cell_count; e++) {
        if (n->cell[e] < 0) continue;
        rest->region[n->cell[e]] = mesh->region[e];
        for (int a = 0; a < 4; a++) rest->cell[4 * n->cell[e] + a] = n->node[mesh->cell[4 * e + a]];
    }
    memcpy(rest->region_name, mesh->region_name,
           (size_t)mesh->region_count * sizeof *mesh->region_name);
}

static sn_status copy_surface(const sn_surface *from, const rest_numbers *n, sn_surface *to) {
    memcpy(to->name, from->name, sizeof to->name);
    int faces = 0;
    for (int f = 0; f < from->face_count; f++) faces += n->cell[from->cell[f]] >= 0;
    SN_TRY(sn_surface_reserve(to, faces));
    for (int f = 0, k = 0; f < from->face_count; f++) {
        if (n->cell[from->cell[f]] < 0) continue;
        for (int a = 0; a < 3; a++) to->face[3 * k + a] = n->node[from->face[3 * f + a]];
        to->cell[k++] = n->cell[from->cell[f]];
    }
    return SN_OK;
}

sn_status sn_mesh_without(const sn_mesh *mesh, const bool *removed, sn_mesh **rest, int *node) {
    rest_numbers n = {0};
    sn_mesh *made = NULL;
    const int surfaces = mesh->surface_count - 1; // sn_mesh_finish() makes "boundary" anew, as last
    int boundary = 0;
    sn_status status;
    *rest = NULL;
    while (strcmp(mesh->surface[boundary].name, "boundary") != 0) boundary++;
    SN_TRY_GOTO(status, number_rest(mesh, removed, &n));
    SN_TRY_GOTO(status, sn_mesh_create(n.nodes, n.cells, mesh->region_count, surfaces, &made));
    copy_rest(mesh, &n, made);
    for (int s = 0; s < surfaces; s++)
        SN_TRY_GOTO(status,
                    copy_surface(&mesh->surface[s + (s >= boundary)], &n, &made->surface[s]));
    SN_TRY_GOTO(status, sn_mesh_finish(made));
    const sn_surface outside = made->surface[surfaces]; // to the place that it had
    memmove(made->surface + boundary + 1, made->surface + boundary,
            (size_t)(surfaces - boundary) * sizeof outside);
    made->surface[boundary] = outside;
    for (int i = 0; node && i < mesh->node_count; i++)
        if (n.node[i] >= 0) node[n.node[i]] = i;
    *rest = made;
    made = NULL;
fail:
    sn_free(n.node);
    sn_free(n.cell);
    sn_mesh_destroy(made);
    return status;
}
