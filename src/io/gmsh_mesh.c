// The mesh that the lists of a Gmsh file become.
// SPDX-License-Identifier: Apache-2.0
#include "io/gmsh_mesh.h"

#include <string.h>

void sn_gmsh_lists_free(sn_gmsh_lists *lists) {
    sn_free(lists->groups);
    sn_free(lists->node);
    sn_free(lists->faces);
    sn_free(lists->cells);
    *lists = (sn_gmsh_lists){0};
}

// Regions and surfaces in the order of the file.
static sn_status build_groups(sn_gmsh_lists *lists, sn_mesh *mesh) {
    int regions = 0, surfaces = 0;
    for (int g = 0; g < lists->group_count; g++) {
        sn_gmsh_group *group = &lists->groups[g];
        int *count = group->dimension == 3 ? &regions : &surfaces;
        group->index = group->count ? (*count)++ : -1;
    }
    mesh->region_name = sn_alloc((size_t)regions, sizeof *mesh->region_name);
    mesh->surface = sn_alloc((size_t)surfaces, sizeof *mesh->surface);
    if (!mesh->region_name || !mesh->surface) return SN_E_MEMORY;
    mesh->region_count = regions;
    mesh->surface_count = surfaces;
    for (int g = 0; g < lists->group_count; g++) {
        const sn_gmsh_group *group = &lists->groups[g];
        if (group->index < 0) continue;
        if (group->dimension == 3) {
            for (int other = 0; other < group->index; other++)
                if (!strcmp(group->name, mesh->region_name[other]))
                    return sn_fail(
                        SN_E_MESH,
                        "two regions have the name \"%s\" (cells without a physical volume "
                        "are the region \"body\"): rename one",
                        group->name);
            memcpy(mesh->region_name[group->index], group->name, SN_NAME_MAX);
            continue;
        }
        sn_surface *surface = &mesh->surface[group->index];
        memcpy(surface->name, group->name, SN_NAME_MAX);
        surface->face = sn_alloc((size_t)group->count, 3 * sizeof(int));
        if (!surface->face) return SN_E_MEMORY;
    }
    return SN_OK;
}

// Numbers the nodes of tetrahedra in the order of the file.
// @param number  of each node; -1 where it belongs to no tetrahedron  (node_count)
static sn_status build_nodes(const sn_gmsh_lists *lists, sn_mesh *mesh, int *number) {
    for (int n = 0; n < lists->node_count; n++) number[n] = -1;
    for (int c = 0; c < lists->cell_count; c++)
        for (int k = 0; k < 4; k++) number[lists->cells[c].node[k]] = 0;
    for (int n = 0; n < lists->node_count; n++)
        if (number[n] == 0) number[n] = mesh->node_count++;
    mesh->node = sn_alloc((size_t)mesh->node_count, 3 * sizeof *mesh->node);
    if (!mesh->node) return SN_E_MEMORY;
    for (int n = 0; n < lists->node_count; n++)
        if (number[n] >= 0)
            memcpy(mesh->node + 3 * (size_t)number[n], lists->node + 3 * (size_t)n,
                   3 * sizeof *mesh->node);
    return SN_OK;
}

static sn_status build_cells(const sn_gmsh_lists *lists, sn_mesh *mesh, const int *number) {
    mesh->cell = sn_alloc((size_t)lists->cell_count, 4 * sizeof *mesh->cell);
    mesh->region = sn_alloc((size_t)lists->cell_count, sizeof *mesh->region);
    if (!mesh->cell || !mesh->region) return SN_E_MEMORY;
    mesh->cell_count = lists->cell_count;
    mesh->split_cells = lists->split_cells;
    for (int c = 0; c < lists->cell_count; c++) {
        const sn_gmsh_cell *cell = &lists->cells[c];
        for (int k = 0; k < 4; k++) mesh->cell[4 * (size_t)c + (size_t)k] = number[cell->node[k]];
        mesh->region[c] = lists->groups[cell->group].index;
    }
    return SN_OK;
}

static sn_status build_faces(const sn_gmsh_lists *lists, sn_mesh *mesh, const int *number) {
    for (int f = 0; f < lists->face_count; f++) {
        const sn_gmsh_face *face = &lists->faces[f];
        sn_surface *surface = &mesh->surface[lists->groups[face->group].index];
        for (int k = 0; k < 3; k++) {
            int node = number[face->node[k]];
            if (node < 0) {
                const double *x = lists->node + 3 * (size_t)face->node[k];
                return sn_fail(SN_E_MESH,
                               "surface \"%s\" has a triangle with a node at (%.6g, %.6g, %.6g) m "
                               "that belongs to no tetrahedron: save the volume behind it too",
                               surface->name, x[0], x[1], x[2]);
            }
            surface->face[3 * (size_t)surface->face_count + (size_t)k] = node;
        }
        surface->face_count++;
    }
    return SN_OK;
}

static sn_status build(sn_gmsh_lists *lists, sn_mesh *mesh, int *number) {
    SN_TRY(build_groups(lists, mesh));
    SN_TRY(build_nodes(lists, mesh, number));
    SN_TRY(build_cells(lists, mesh, number));
    SN_TRY(build_faces(lists, mesh, number));
    return sn_mesh_finish(mesh);
}

sn_status sn_gmsh_build(sn_gmsh_lists *lists, const char *path, sn_mesh **mesh) {
    *mesh = NULL;
    sn_mesh *made = sn_alloc(1, sizeof *made);
    int *number = sn_alloc((size_t)lists->node_count, sizeof *number);
    sn_status status = SN_E_MEMORY;
    if (made && number) status = build(lists, made, number);
    sn_free(number);
    if (status == SN_OK) {
        *mesh = made;
        return SN_OK;
    }
    sn_mesh_destroy(made);
    return sn_fail_within(status, "%s", path);
}
