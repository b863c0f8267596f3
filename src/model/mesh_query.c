// Questions to a mesh: surfaces by name, their nodes, edges, where a point is.
// SPDX-License-Identifier: Apache-2.0
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "base/vector.h"
#include "model/mesh.h"

int sn_mesh_surface(const sn_mesh *mesh, const char *name) {
    for (int s = 0; s < mesh->surface_count; s++)
        if (!strcmp(mesh->surface[s].name, name)) return s;

    char known[SN_TEXT_MAX] = "";
    const char **names = sn_alloc((size_t)mesh->surface_count, sizeof *names);
    if (!names) return -1;
    for (int s = 0; s < mesh->surface_count; s++) {
        names[s] = mesh->surface[s].name;
        if (strlen(known) + strlen(names[s]) + 2 > sizeof known) continue;
        if (s > 0) strcat(known, " ");
        strcat(known, names[s]);
    }
    const char *near = sn_suggest(name, names, mesh->surface_count);
    if (near)
        (void)sn_fail(SN_E_NAME, "no surface \"%s\": did you mean \"%s\"?", name, near);
    else
        (void)sn_fail(SN_E_NAME, "no surface \"%s\": the mesh has %s", name,
                      known[0] ? known : "none");
    sn_free(names);
    return -1;
}

sn_status sn_mesh_surface_nodes(const sn_mesh *mesh, int surface, int **nodes, int *count) {
    SN_ASSERT(surface >= 0 && surface < mesh->surface_count);
    *nodes = NULL;
    *count = 0;
    const sn_surface *s = &mesh->surface[surface];
    unsigned char *on = sn_alloc((size_t)mesh->node_count, 1);
    if (!on) return SN_E_MEMORY;
    int found = 0;
    for (size_t i = 0; i < 3 * (size_t)s->face_count; i++) {
        found += !on[s->face[i]];
        on[s->face[i]] = 1;
    }
    int *list = sn_alloc((size_t)found, sizeof *list);
    if (list) {
        *nodes = list;
        *count = found;
        for (int a = 0; a < mesh->node_count; a++)
            if (on[a]) *list++ = a;
    }
    sn_free(on);
    return *nodes ? SN_OK : SN_E_MEMORY;
}

// Six (low, high) pairs of a cell.
static void cell_edges(const int *v, int pair[6][2]) {
    int e = 0;
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++, e++) {
            pair[e][0] = v[i] < v[j] ? v[i] : v[j];
            pair[e][1] = v[i] < v[j] ? v[j] : v[i];
        }
}

// Upper ends of all cell edges, gathered by the lower end: row a is high[row[a] … row[a + 1]),
// still with repetitions.
static void gather_edges(const sn_mesh *mesh, size_t *row, int *high) {
    int pair[6][2];
    for (int c = 0; c < mesh->cell_count; c++) {
        cell_edges(mesh->cell + 4 * (size_t)c, pair);
        for (int e = 0; e < 6; e++) row[pair[e][0] + 1]++;
    }
    for (int a = 0; a < mesh->node_count; a++) row[a + 1] += row[a];
    // row[a + 1] moves from the end of row a to its start …
    for (int c = mesh->cell_count - 1; c >= 0; c--) {
        cell_edges(mesh->cell + 4 * (size_t)c, pair);
        for (int e = 0; e < 6; e++) high[--row[pair[e][0] + 1]] = pair[e][1];
    }
    // … and then to its own place
    for (int a = 0; a < mesh->node_count; a++) row[a] = row[a + 1];
    row[mesh->node_count] = 6 * (size_t)mesh->cell_count;
}

sn_status sn_mesh_edges(const sn_mesh *mesh, int **edges, int *count) {
    *edges = NULL;
    *count = 0;
    size_t *row = sn_alloc((size_t)mesh->node_count + 1, sizeof *row);
    int *high = sn_alloc(6 * (size_t)mesh->cell_count, sizeof *high);
    sn_status status = SN_E_MEMORY;
    if (!row || !high) goto fail;
    gather_edges(mesh, row, high);

    size_t found = 0; // without repetitions
    for (int a = 0; a < mesh->node_count; a++) {
        qsort(high + row[a], row[a + 1] - row[a], sizeof *high, compare_int);
        for (size_t i = row[a]; i < row[a + 1]; i++) found += i == row[a] || high[i] != high[i - 1];
    }
    int *out = sn_alloc(2 * found, sizeof *out);
    if (!out) goto fail;
    *edges = out;
    *count = (int)found;
    for (int a = 0; a < mesh->node_count; a++)
        for (size_t i = row[a]; i < row[a + 1]; i++)
            if (i == row[a] || high[i] != high[i - 1]) {
                *out++ = a;
                *out++ = high[i];
            }
    status = SN_OK;
fail:
    sn_free(row);
    sn_free(high);
    return status;
}

double sn_mesh_depth(const sn_mesh *mesh, int cell, const double point[3], double weight[4]) {
    double volume = sn_mesh_cell_volume(mesh, cell), depth = (double)INFINITY;
    for (int k = 0; k < 4; k++) {
        int node[3];
        sn_face_nodes(mesh, 4 * cell + k, node);
        double normal[3], to[3];
        sn_triangle_normal(mesh, node, normal);
        sub3(point, mesh->node + 3 * (size_t)node[0], to);
        double inwards = -dot3(normal, to);
        weight[k] = inwards / (6 * volume);
        depth = fmin(depth, inwards / norm3(normal));
    }
    return depth;
}

void sn_mesh_middle(const sn_mesh *mesh, int cell, double middle[3]) {
    const int *v = mesh->cell + 4 * (size_t)cell;
    for (size_t i = 0; i < 3; i++)
        middle[i] = 0.25 * (mesh->node[3 * (size_t)v[0] + i] + mesh->node[3 * (size_t)v[1] + i] +
                            mesh->node[3 * (size_t)v[2] + i] + mesh->node[3 * (size_t)v[3] + i]);
}

static bool near_cell(const sn_mesh *mesh, int cell, const double point[3], double margin) {
    const int *v = mesh->cell + 4 * (size_t)cell;
    for (int i = 0; i < 3; i++) {
        double low = (double)INFINITY, high = -(double)INFINITY;
        for (int k = 0; k < 4; k++) {
            double x = mesh->node[3 * (size_t)v[k] + (size_t)i];
            low = fmin(low, x);
            high = fmax(high, x);
        }
        if (point[i] < low - margin || point[i] > high + margin) return false;
    }
    return true;
}

bool sn_mesh_find_point(const sn_mesh *mesh, const double point[3], int *cell, double weight[4]) {
    double margin = 1e-6 * sn_mesh_size(mesh), best = -margin;
    *cell = -1;
    for (int c = 0; c < mesh->cell_count; c++) {
        double w[4], depth;
        if (!near_cell(mesh, c, point, margin)) continue;
        depth = sn_mesh_depth(mesh, c, point, w);
        if (depth < best) continue;
        best = depth;
        *cell = c;
        memcpy(weight, w, sizeof w);
    }
    if (*cell < 0) return false;
    double sum = 0;
    for (int k = 0; k < 4; k++) sum += weight[k] = fmax(weight[k], 0);
    for (int k = 0; k < 4; k++) weight[k] /= sum;
    return true;
}

sn_status sn_mesh_locate(const sn_mesh *mesh, const double point[3], int *cell, double weight[4]) {
    if (sn_mesh_find_point(mesh, point, cell, weight)) return SN_OK;
    double low[3], high[3];
    sn_mesh_box(mesh, low, high);
    return sn_fail(
        SN_E_DEFINITION,
        "the point (%g, %g, %g) m is outside the body, which lies within x %g … %g, y %g … "
        "%g, z %g … %g m",
        point[0], point[1], point[2], low[0], high[0], low[1], high[1], low[2], high[2]);
}
