// The last step of every mesh: checks, orientation, the cells behind the surfaces, the boundary.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"

// a cell of less volume than this times the cube of its longest edge is flat
#define FLAT 1e-12

static sn_status check_counts(const sn_mesh *mesh) {
    if (mesh->node_count < 4 || mesh->cell_count < 1)
        return sn_fail(
            SN_E_MESH,
            "the mesh has %d nodes and %d tetrahedra: it needs 4 nodes and 1 tetrahedron "
            "at least",
            mesh->node_count, mesh->cell_count);
    if (mesh->cell_count > SN_CELLS_MAX)
        return sn_fail(SN_E_MESH, "the mesh has %d tetrahedra: at most %d are possible",
                       mesh->cell_count, SN_CELLS_MAX);
    if (mesh->region_count < 1) return sn_fail(SN_E_MESH, "the mesh has no region");
    for (int s = 0; s < mesh->surface_count; s++)
        for (int other = 0; other < s; other++)
            if (!strcmp(mesh->surface[s].name, mesh->surface[other].name))
                return sn_fail(SN_E_MESH, "two surfaces have the name \"%s\": rename one",
                               mesh->surface[s].name);
    return SN_OK;
}

static sn_status check_nodes(const sn_mesh *mesh) {
    for (size_t i = 0; i < 3 * (size_t)mesh->node_count; i++)
        if (!isfinite(mesh->node[i]))
            return sn_fail(SN_E_MESH,
                           "coordinate %c of node %d (counted from 0) is %g, not a number",
                           "xyz"[i % 3], (int)(i / 3), mesh -> node[i]);
    unsigned char *used = sn_alloc((size_t)mesh->node_count, 1);
    if (!used) return SN_E_MEMORY;
    sn_status status = SN_OK;
    for (size_t i = 0; i < 4 * (size_t)mesh->cell_count; i++) {
        int a = mesh->cell[i];
        if (a < 0 || a >= mesh->node_count) {
            status = sn_fail(SN_E_MESH,
                             "cell %d (counted from 0) names node %d, but nodes run from 0 to %d",
                             (int)(i / 4), a, mesh->node_count - 1);
            goto fail;
        }
        used[a] = 1;
    }
    for (int a = 0; a < mesh->node_count; a++)
        if (!used[a]) {
            status = sn_fail(SN_E_MESH,
                             "node %d (counted from 0) belongs to no tetrahedron: remove it", a);
            goto fail;
        }
fail:
    sn_free(used);
    return status;
}

static double longest_edge(const sn_mesh *mesh, const int *v) {
    double longest = 0;
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++)
            longest = fmax(longest,
                           distance3(mesh->node + 3 * (size_t)v[i], mesh->node + 3 * (size_t)v[j]));
    return longest;
}

// Regions in range, no flat cell, all volumes positive.
static sn_status orient_cells(sn_mesh *mesh) {
    for (int c = 0; c < mesh->cell_count; c++) {
        int *v = mesh->cell + 4 * (size_t)c;
        if (mesh->region[c] < 0 || mesh->region[c] >= mesh->region_count)
            return sn_fail(SN_E_MESH, "cell %d (counted from 0) is in region %d of %d regions", c,
                           mesh->region[c], mesh->region_count);
        double volume = sn_mesh_cell_volume(mesh, c), edge = longest_edge(mesh, v);
        if (!(fabs(volume) > FLAT * edge * edge * edge)) // also when it is not a number
            return sn_fail(SN_E_MESH,
                           "cell %d (counted from 0, nodes %d %d %d %d) is flat: volume %.3g m3, "
                           "longest edge %.3g m; remesh there",
                           c, v[0], v[1], v[2], v[3], fabs(volume), edge);
        if (volume < 0) { // 1 and 3: keeps the pairs of opposite edges that mesh_refine.c prefers
            int swap = v[1];
            v[1] = v[3];
            v[3] = swap;
        }
    }
    return SN_OK;
}

// How often `node` runs round in the same direction as `face` does: true for the same direction.
static bool same_direction(const int node[3], const int face[3]) {
    for (int i = 0; i < 3; i++)
        if (node[0] == face[i]) return node[1] == face[(i + 1) % 3];
    return false;
}

// Finds the cells behind a surface and turns its outer faces outwards.
static sn_status finish_surface(const sn_mesh *mesh, const sn_faces *faces, sn_surface *surface) {
    if (!surface->cell) {
        surface->cell = sn_alloc((size_t)surface->face_count, sizeof(int));
        if (!surface->cell) return SN_E_MEMORY;
    }
    for (int f = 0; f < surface->face_count; f++) {
        int *node = surface->face + 3 * (size_t)f;
        int found = -1;
        bool in_range = true;
        for (int i = 0; i < 3; i++) in_range &= node[i] >= 0 && node[i] < mesh->node_count;
        if (in_range) found = sn_faces_find(mesh, faces, node);
        if (found < 0)
            return sn_fail(
                SN_E_MESH,
                "surface \"%s\": triangle %d (counted from 0, nodes %d %d %d) is not a face "
                "of any tetrahedron",
                surface->name, f, node[0], node[1], node[2]);
        int outwards[3];
        sn_face_nodes(mesh, found, outwards);
        if (!same_direction(node, outwards)) {
            if (faces->other[found] >= 0)
                found = faces->other[found];
            else
                memcpy(node, outwards, sizeof outwards);
        }
        surface->cell[f] = found / 4;
    }
    return SN_OK;
}

static int count_boundary(const sn_mesh *mesh, const sn_faces *faces) {
    int count = 0;
    for (int face = 0; face < 4 * mesh->cell_count; face++) count += faces->other[face] < 0;
    return count;
}

// A surface of the name "boundary" that came with the mesh must be what the name says: as many
// faces as the boundary has, all outer, none twice.
static sn_status check_own_boundary(const sn_mesh *mesh, const sn_faces *faces,
                                    const sn_surface *surface) {
    int expected = count_boundary(mesh, faces), outer = 0;
    unsigned char *seen = sn_alloc((size_t)mesh->cell_count * 4, 1);
    if (!seen) return SN_E_MEMORY;
    for (int f = 0; f < surface->face_count; f++) {
        int face = sn_faces_find(mesh, faces, surface->face + 3 * (size_t)f);
        outer += faces->other[face] < 0 && !seen[face];
        seen[face] = 1;
    }
    sn_free(seen);
    if (surface->face_count == expected && outer == expected) return SN_OK;
    return sn_fail(
        SN_E_MESH,
        "surface \"boundary\" has %d faces, %d of them outer ones, but the mesh has %d outer "
        "faces: the name is kept for all of them; rename the surface",
        surface->face_count, outer, expected);
}

static sn_status add_boundary(sn_mesh *mesh, const sn_faces *faces) {
    for (int s = 0; s < mesh->surface_count; s++)
        if (!strcmp(mesh->surface[s].name, "boundary"))
            return check_own_boundary(mesh, faces, &mesh->surface[s]);

    size_t count = (size_t)mesh->surface_count;
    sn_surface *grown = sn_resize(mesh->surface, count + 1, sizeof *grown);
    if (!grown) return SN_E_MEMORY;
    mesh->surface = grown;
    sn_surface *boundary = &grown[count];
    *boundary = (sn_surface){.name = "boundary"};
    mesh->surface_count++;
    SN_TRY(sn_surface_reserve(boundary, count_boundary(mesh, faces)));
    int f = 0;
    for (int face = 0; face < 4 * mesh->cell_count; face++)
        if (faces->other[face] < 0) {
            sn_face_nodes(mesh, face, boundary->face + 3 * (size_t)f);
            boundary->cell[f++] = face / 4;
        }
    return SN_OK;
}

sn_status sn_mesh_finish(sn_mesh *mesh) {
    SN_TRY(check_counts(mesh));
    SN_TRY(check_nodes(mesh));
    SN_TRY(orient_cells(mesh));
    sn_faces faces;
    sn_status status;
    SN_TRY_GOTO(status, sn_faces_create(mesh, &faces));
    for (int s = 0; s < mesh->surface_count; s++)
        SN_TRY_GOTO(status, finish_surface(mesh, &faces, &mesh->surface[s]));
    SN_TRY_GOTO(status, add_boundary(mesh, &faces));
fail:
    sn_faces_destroy(&faces);
    return status;
}
