// Reference elements: shape functions and quadrature of the tetrahedra and of their faces.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/element.h"

#include <math.h>

const int sn_fe_cell_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
const int sn_fe_face_edge[3][2] = {{0, 1}, {1, 2}, {2, 0}};

void sn_fe_cell_shape(int nodes, const double lambda[4], double *shape) {
    for (int a = 0; a < 4; a++)
        shape[a] = nodes == 4 ? lambda[a] : lambda[a] * (2.0 * lambda[a] - 1.0);
    for (int a = 4; a < nodes; a++) {
        const int *end = sn_fe_cell_edge[a - 4];
        shape[a] = 4.0 * lambda[end[0]] * lambda[end[1]];
    }
}

static void cell_slope(int nodes, const double lambda[4], double slope[][4]) {
    for (int a = 0; a < 4; a++) slope[a][a] = nodes == 4 ? 1.0 : 4.0 * lambda[a] - 1.0;
    for (int a = 4; a < nodes; a++) {
        const int *end = sn_fe_cell_edge[a - 4];
        slope[a][end[0]] = 4.0 * lambda[end[1]];
        slope[a][end[1]] = 4.0 * lambda[end[0]];
    }
}

// xi = lambda_1, eta = lambda_2, lambda_0 = 1 - xi - eta
static void face_values(int nodes, const double lambda[3], double *shape, double slope[][2]) {
    double d[SN_FE_FACE_NODES][3] = {{0}};
    for (int a = 0; a < 3; a++) {
        shape[a] = nodes == 3 ? lambda[a] : lambda[a] * (2.0 * lambda[a] - 1.0);
        d[a][a] = nodes == 3 ? 1.0 : 4.0 * lambda[a] - 1.0;
    }
    for (int a = 3; a < nodes; a++) {
        const int *end = sn_fe_face_edge[a - 3];
        shape[a] = 4.0 * lambda[end[0]] * lambda[end[1]];
        d[a][end[0]] = 4.0 * lambda[end[1]];
        d[a][end[1]] = 4.0 * lambda[end[0]];
    }
    for (int a = 0; a < nodes; a++) {
        slope[a][0] = d[a][1] - d[a][0];
        slope[a][1] = d[a][2] - d[a][0];
    }
}

static void cell_rule(sn_fe_element *e) {
    if (e->points == 1) {
        e->weight[0] = 1.0;
        for (int k = 0; k < 4; k++) e->lambda[0][k] = 0.25;
        return;
    }
    double near = (5.0 + 3.0 * sqrt(5.0)) / 20.0, far = (5.0 - sqrt(5.0)) / 20.0;
    for (int q = 0; q < 4; q++) {
        e->weight[q] = 0.25;
        for (int k = 0; k < 4; k++) e->lambda[q][k] = q == k ? near : far;
    }
}

static void face_rule(sn_fe_element *e) {
    static const double weight[2] = {0.22338158967801146570, 0.10995174365532186764};
    static const double twice[2] = {0.44594849091596488632, 0.09157621350977074346};
    if (e->face_points == 1) {
        const double centre[3] = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
        e->face_weight[0] = 1.0;
        face_values(e->face_nodes, centre, e->face_shape[0], e->face_slope[0]);
        return;
    }
    for (int q = 0; q < 6; q++) {
        double lambda[3];
        for (int k = 0; k < 3; k++)
            lambda[k] = k == q % 3 ? 1.0 - 2.0 * twice[q / 3] : twice[q / 3];
        e->face_weight[q] = weight[q / 3];
        face_values(e->face_nodes, lambda, e->face_shape[q], e->face_slope[q]);
    }
}

void sn_fe_element_init(sn_element kind, sn_fe_element *e) {
    static const char *const name[] = {
        [SN_ELEMENT_P1] = "P1", [SN_ELEMENT_P2] = "P2", [SN_ELEMENT_P2P1] = "P2P1"};
    bool linear = kind == SN_ELEMENT_P1;
    *e = (sn_fe_element){.name = name[kind],
                         .mixed = kind == SN_ELEMENT_P2P1,
                         .nodes = linear ? 4 : 10,
                         .points = linear ? 1 : 4,
                         .face_nodes = linear ? 3 : 6,
                         .face_points = linear ? 1 : 6};
    cell_rule(e);
    for (int q = 0; q < e->points; q++) cell_slope(e->nodes, e->lambda[q], e->slope[q]);
    face_rule(e);
}
