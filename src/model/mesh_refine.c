// Splits every tetrahedron into eight.
// SPDX-License-Identifier: Apache-2.0
// Source: Bey, Computing 55 (1995) 355, red refinement; shortest inner diagonal.
//
// Four children stand at the corners; the octahedron between them is cut into four around one of
// its diagonals, each of which joins the midpoints of two opposite edges. The shortest gives the
// best shapes; equal lengths fall to edges 02 and 13, and the order of the nodes of the children is
// Bey's, so that Kuhn cells stay Kuhn cells however often they are refined.
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"

// Midpoints: node node_count + e stands on edge e.
typedef struct midpoints {
    const sn_mesh *mesh;
    int *edge;  ///< rising                                       (edge_count x 2)
    int *first; ///< first edge of a node                         (node_count + 1)
    int edge_count;
} midpoints;

static sn_status midpoints_create(const sn_mesh *mesh, midpoints *m) {
    *m = (midpoints){.mesh = mesh};
    SN_TRY(sn_mesh_edges(mesh, &m->edge, &m->edge_count));
    m->first = sn_alloc((size_t)mesh->node_count + 1, sizeof *m->first);
    if (!m->first) return SN_E_MEMORY;
    for (int e = 0; e < m->edge_count; e++) m->first[m->edge[2 * (size_t)e] + 1]++;
    for (int a = 0; a < mesh->node_count; a++) m->first[a + 1] += m->first[a];
    return SN_OK;
}

static int midpoint(const midpoints *m, int a, int b) {
    int low = a < b ? a : b, high = a < b ? b : a;
    int from = m->first[low], to = m->first[low + 1] - 1;
    while (from < to) {
        int middle = from + (to - from) / 2;
        if (m->edge[2 * (size_t)middle + 1] < high)
            from = middle + 1;
        else
            to = middle;
    }
    SN_ASSERT(m->edge[2 * (size_t)from + 1] == high);
    return m->mesh->node_count + from;
}

static void split_cell(const midpoints *m, const double *node, const int *v, int *out) {
    // the order of the corners that brings each pair of opposite edges to 02 and 13
    static const int order[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 1, 3, 2}};
    // the four inner children around the diagonal from the midpoint of 02 to that of 13
    static const int inner[4][4][2] = {{{0, 1}, {0, 2}, {0, 3}, {1, 3}},
                                       {{0, 1}, {0, 2}, {1, 2}, {1, 3}},
                                       {{0, 2}, {0, 3}, {1, 3}, {2, 3}},
                                       {{0, 2}, {1, 2}, {1, 3}, {2, 3}}};
    int mid[4][4];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) mid[i][j] = i == j ? v[i] : midpoint(m, v[i], v[j]);

    const int *o = order[0];
    double shortest = 0;
    for (int d = 0; d < 3; d++) {
        int p = mid[order[d][0]][order[d][2]], q = mid[order[d][1]][order[d][3]];
        double length = distance3(node + 3 * (size_t)p, node + 3 * (size_t)q);
        if (d > 0 && length >= shortest * (1 - 1e-9)) continue; // rounding decides nothing
        o = order[d];
        shortest = length;
    }
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) *out++ = mid[i][j];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) *out++ = mid[o[inner[i][j][0]]][o[inner[i][j][1]]];
}

static sn_status split_surface(const midpoints *m, const sn_surface *coarse, sn_surface *fine) {
    memcpy(fine->name, coarse->name, sizeof fine->name);
    SN_TRY(sn_surface_reserve(fine, 4 * coarse->face_count));
    int *out = fine->face;
    for (int f = 0; f < coarse->face_count; f++) {
        const int *v = coarse->face + 3 * (size_t)f;
        int ab = midpoint(m, v[0], v[1]), bc = midpoint(m, v[1], v[2]),
            ca = midpoint(m, v[2], v[0]);
        int child[12] = {v[0], ab, ca, ab, v[1], bc, ca, bc, v[2], ab, bc, ca};
        memcpy(out, child, sizeof child);
        out += 12;
    }
    return SN_OK;
}

sn_status sn_mesh_refine(const sn_mesh *mesh, sn_mesh **fine) {
    *fine = NULL;
    if (mesh->cell_count > SN_CELLS_MAX / 8)
        return sn_fail(SN_E_RANGE, "refining %d tetrahedra makes %.0f: at most %d are possible",
                       mesh->cell_count, 8.0 * mesh->cell_count, SN_CELLS_MAX);
    midpoints m;
    sn_mesh *out = NULL;
    sn_status status;
    SN_TRY_GOTO(status, midpoints_create(mesh, &m));
    SN_TRY_GOTO(status, sn_mesh_create(mesh->node_count + m.edge_count, 8 * mesh->cell_count,
                                       mesh->region_count, mesh->surface_count, &out));
    memcpy(out->region_name, mesh->region_name,
           (size_t)mesh->region_count * sizeof *out->region_name);
    memcpy(out->node, mesh->node, 3 * (size_t)mesh->node_count * sizeof *out->node);
    double *x = out->node + 3 * (size_t)mesh->node_count;
    for (int e = 0; e < m.edge_count; e++) {
        const double *a = mesh->node + 3 * (size_t)m.edge[2 * (size_t)e];
        const double *b = mesh->node + 3 * (size_t)m.edge[2 * (size_t)e + 1];
        for (int i = 0; i < 3; i++) *x++ = 0.5 * (a[i] + b[i]);
    }
    for (int c = 0; c < mesh->cell_count; c++) {
        split_cell(&m, out->node, mesh->cell + 4 * (size_t)c, out->cell + 32 * (size_t)c);
        for (int i = 0; i < 8; i++) out->region[8 * (size_t)c + (size_t)i] = mesh->region[c];
    }
    for (int s = 0; s < mesh->surface_count; s++)
        SN_TRY_GOTO(status, split_surface(&m, &mesh->surface[s], &out->surface[s]));
    SN_TRY_GOTO(status, sn_mesh_finish(out));
    *fine = out;
    out = NULL;
fail:
    sn_mesh_destroy(out);
    sn_free(m.edge);
    sn_free(m.first);
    return status;
}
