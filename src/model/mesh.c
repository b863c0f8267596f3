// Meshes: life and measures.
// SPDX-License-Identifier: Apache-2.0
#include "model/mesh.h"

#include <string.h>

#include "base/vector.h"

sn_status sn_mesh_create(int node_count, int cell_count, int region_count, int surface_count,
                         sn_mesh **mesh) {
    SN_ASSERT(node_count >= 0 && cell_count >= 0 && region_count >= 0 && surface_count >= 0);
    *mesh = NULL;
    sn_mesh *m = sn_alloc(1, sizeof *m);
    if (!m) return SN_E_MEMORY;
    m->node_count = node_count;
    m->cell_count = cell_count;
    m->region_count = region_count;
    m->node = sn_alloc((size_t)node_count * 3, sizeof *m->node);
    m->cell = sn_alloc((size_t)cell_count * 4, sizeof *m->cell);
    m->region = sn_alloc((size_t)cell_count, sizeof *m->region);
    m->region_name = sn_alloc((size_t)region_count, sizeof *m->region_name);
    m->surface = sn_alloc((size_t)surface_count, sizeof *m->surface);
    if (!m->node || !m->cell || !m->region || !m->region_name || !m->surface) {
        sn_mesh_destroy(m);
        return SN_E_MEMORY;
    }
    m->surface_count = surface_count;
    *mesh = m;
    return SN_OK;
}

void sn_mesh_destroy(sn_mesh *mesh) {
    if (!mesh) return;
    for (int s = 0; s < mesh->surface_count; s++) {
        sn_free(mesh->surface[s].face);
        sn_free(mesh->surface[s].cell);
    }
    sn_free(mesh->surface);
    sn_free(mesh->region_name);
    sn_free(mesh->region);
    sn_free(mesh->cell);
    sn_free(mesh->node);
    sn_free(mesh);
}

sn_status sn_surface_reserve(sn_surface *surface, int face_count) {
    SN_ASSERT(!surface->face && !surface->cell);
    surface->face = sn_alloc((size_t)face_count * 3, sizeof *surface->face);
    surface->cell = sn_alloc((size_t)face_count, sizeof *surface->cell);
    if (!surface->face || !surface->cell) return SN_E_MEMORY;
    surface->face_count = face_count;
    return SN_OK;
}

static sn_status copy_surface(const sn_surface *from, sn_surface *to) {
    SN_TRY(sn_surface_reserve(to, from->face_count));
    size_t faces = (size_t)from->face_count;
    memcpy(to->name, from->name, sizeof to->name);
    memcpy(to->face, from->face, faces * 3 * sizeof *to->face);
    memcpy(to->cell, from->cell, faces * sizeof *to->cell);
    return SN_OK;
}

sn_status sn_mesh_copy(const sn_mesh *mesh, sn_mesh **copy) {
    sn_mesh *m;
    *copy = NULL;
    SN_TRY(sn_mesh_create(mesh->node_count, mesh->cell_count, mesh->region_count,
                          mesh->surface_count, &m));
    size_t cells = (size_t)mesh->cell_count;
    memcpy(m->node, mesh->node, (size_t)mesh->node_count * 3 * sizeof *m->node);
    memcpy(m->cell, mesh->cell, cells * 4 * sizeof *m->cell);
    memcpy(m->region, mesh->region, cells * sizeof *m->region);
    memcpy(m->region_name, mesh->region_name, (size_t)mesh->region_count * sizeof *m->region_name);
    for (int s = 0; s < mesh->surface_count; s++) {
        if (copy_surface(&mesh->surface[s], &m->surface[s]) == SN_OK) continue;
        sn_mesh_destroy(m);
        return SN_E_MEMORY;
    }
    m->split_cells = mesh->split_cells;
    *copy = m;
    return SN_OK;
}

void sn_triangle_normal(const sn_mesh *mesh, const int node[3], double normal[3]) {
    const double *a = mesh->node + 3 * (size_t)node[0];
    double ab[3], ac[3];
    sub3(mesh->node + 3 * (size_t)node[1], a, ab);
    sub3(mesh->node + 3 * (size_t)node[2], a, ac);
    cross3(ab, ac, normal);
}

double sn_mesh_cell_volume(const sn_mesh *mesh, int cell) {
    const int *v = mesh->cell + 4 * (size_t)cell;
    double normal[3], ad[3];
    sn_triangle_normal(mesh, v, normal);
    sub3(mesh->node + 3 * (size_t)v[3], mesh->node + 3 * (size_t)v[0], ad);
    return dot3(normal, ad) / 6;
}

double sn_mesh_area(const sn_mesh *mesh, int surface) {
    const sn_surface *s = &mesh->surface[surface];
    double area = 0, normal[3];
    for (int f = 0; f < s->face_count; f++) {
        sn_triangle_normal(mesh, s->face + 3 * (size_t)f, normal);
        area += 0.5 * norm3(normal);
    }
    return area;
}

double sn_mesh_volume(const sn_mesh *mesh) {
    double volume = 0;
    for (int c = 0; c < mesh->cell_count; c++) volume += sn_mesh_cell_volume(mesh, c);
    return volume;
}

void sn_mesh_box(const sn_mesh *mesh, double low[3], double high[3]) {
    for (int i = 0; i < 3; i++) {
        low[i] = (double)INFINITY;
        high[i] = -(double)INFINITY;
        for (int a = 0; a < mesh->node_count; a++) {
            low[i] = fmin(low[i], mesh->node[3 * (size_t)a + (size_t)i]);
            high[i] = fmax(high[i], mesh->node[3 * (size_t)a + (size_t)i]);
        }
    }
}

double sn_mesh_size(const sn_mesh *mesh) {
    double low[3], high[3];
    sn_mesh_box(mesh, low, high);
    return distance3(low, high);
}
