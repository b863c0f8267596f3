// Shapes that the tests of model/ share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string.h>

#include "check.h"
#include "sinew/model.h"

static inline sn_mesh *build(const sn_shape_def *def) {
    sn_mesh *mesh = NULL;
    CHECK_OK(sn_mesh_build(def, &mesh));
    return mesh;
}

static inline sn_shape_def block(sn_pattern pattern, int x, int y, int z) {
    return (sn_shape_def){.shape = SN_SHAPE_BLOCK,
                          .pattern = pattern,
                          .size = {0.031, 0.017, 0.023},
                          .cells = {x, y, z}};
}

static inline sn_shape_def tube(sn_pattern pattern, int radial, int around, int along) {
    return (sn_shape_def){.shape = SN_SHAPE_TUBE,
                          .pattern = pattern,
                          .inner_radius = 0.0113,
                          .outer_radius = 0.0171,
                          .length = 0.037,
                          .cells = {radial, around, along}};
}

static inline sn_shape_def cylinder(sn_pattern pattern, int radial, int around, int along) {
    return (sn_shape_def){.shape = SN_SHAPE_CYLINDER,
                          .pattern = pattern,
                          .radius = 0.0137,
                          .length = 0.029,
                          .cells = {radial, around, along}};
}

/// Area of a surface and the sum of its area vectors.
static inline double surface_area(const sn_mesh *mesh, int surface, double vector[3]) {
    const sn_surface *s = &mesh->surface[surface];
    double area = 0;
    vector[0] = vector[1] = vector[2] = 0;
    for (int f = 0; f < s->face_count; f++) {
        const double *a = mesh->node + 3 * s->face[3 * f], *b = mesh->node + 3 * s->face[3 * f + 1],
                     *c = mesh->node + 3 * s->face[3 * f + 2];
        double u[3], v[3], n[3];
        for (int i = 0; i < 3; i++) u[i] = b[i] - a[i], v[i] = c[i] - a[i];
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            n[i] = 0.5 * (u[j] * v[k] - u[k] * v[j]);
            vector[i] += n[i];
        }
        area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return area;
}
