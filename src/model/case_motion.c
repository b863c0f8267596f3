// Which rigid motions a case leaves free.
// SPDX-License-Identifier: Apache-2.0
//
// Six modes: translations along x y z, and rotations about x y z through the middle of the body, as
// displacements over the body's size so that all six have one scale. Every fixed direction of every
// node gives a row of six numbers; the modes that no row sees are free: the null space of the Gram
// matrix, from its eigenvectors (cyclic Jacobi). Elimination with pivots brings the null space to
// one leading mode a vector, which names it.
#include <stdio.h>
#include <string.h>

#include "base/vector.h"
#include "model/mesh.h"

#define MODES 6
// A Gram eigenvalue below this times the largest is rounding. Supports on a patch of a
// millionth of the body's size still count: they give 1e-12 of a rotation.
#define FREE 1e-13

// Adds the row of direction d at a node, placed relative to the middle in body sizes.
static void add_row(const double x[3], int d, double gram[MODES][MODES]) {
    double row[MODES] = {0};
    row[d] = 1;
    for (int axis = 0; axis < 3; axis++) {
        double e[3] = {0}, turned[3];
        e[axis] = 1;
        cross3(e, x, turned);
        row[3 + axis] = turned[d];
    }
    for (int i = 0; i < MODES; i++)
        for (int j = 0; j < MODES; j++) gram[i][j] += row[i] * row[j];
}

static void rotate(double a[MODES][MODES], double v[MODES][MODES], int p, int q) {
    double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    double t = copysign(1, theta) / (fabs(theta) + sqrt(1 + theta * theta));
    double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int k = 0; k < MODES; k++) {
        double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (int k = 0; k < MODES; k++) {
        double pk = a[p][k], qk = a[q][k], vp = v[k][p], vq = v[k][q];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
        v[k][p] = c * vp - s * vq;
        v[k][q] = s * vp + c * vq;
    }
}

// Diagonalises a symmetric matrix; columns of v are its eigenvectors.
static void jacobi(double a[MODES][MODES], double v[MODES][MODES]) {
    memset(v, 0, sizeof(double[MODES][MODES]));
    for (int i = 0; i < MODES; i++) v[i][i] = 1;
    for (int sweep = 0; sweep < 30; sweep++) // converges quadratically; 6 to 8 sweeps suffice
        for (int p = 0; p < MODES; p++)
            for (int q = p + 1; q < MODES; q++)
                if (a[p][q] != 0) rotate(a, v, p, q);
}

// Orthonormal rows that span the free motions; returns how many.
static int null_space(double gram[MODES][MODES], double null[MODES][MODES]) {
    double v[MODES][MODES], largest = 0;
    jacobi(gram, v);
    for (int i = 0; i < MODES; i++) largest = fmax(largest, gram[i][i]);
    int count = 0;
    for (int i = 0; i < MODES; i++) {
        if (gram[i][i] > FREE * largest) continue;
        for (int k = 0; k < MODES; k++) null[count][k] = v[k][i];
        count++;
    }
    return count;
}

// Gauss-Jordan with full pivoting: afterwards lead[r] is the mode of row r alone.
static void eliminate(double null[MODES][MODES], int count, int lead[MODES]) {
    for (int r = 0; r < count; r++) {
        int row = r, column = 0;
        for (int i = r; i < count; i++)
            for (int k = 0; k < MODES; k++)
                if (fabs(null[i][k]) > fabs(null[row][column]) * (1 + 1e-9)) row = i, column = k;
        double pivot[MODES];
        memcpy(pivot, null[row], sizeof pivot);
        memcpy(null[row], null[r], sizeof pivot);
        for (int k = 0; k < MODES; k++) null[r][k] = pivot[k] / pivot[column];
        lead[r] = column;
        for (int i = 0; i < count; i++) {
            double factor = null[i][column];
            if (i == r) continue;
            for (int k = 0; k < MODES; k++) null[i][k] -= factor * null[r][k];
        }
    }
}

// Appends "translation along z" or "rotation about (0.71, 0.71, 0)".
static void append_motion(char text[SN_TEXT_MAX], const double mode[MODES], int lead) {
    const double *part = mode + (lead < 3 ? 0 : 3);
    double length = norm3(part);
    size_t used = strlen(text);
    const char *comma = used > 0 ? ", " : "";
    const char *what = lead < 3 ? "translation along" : "rotation about";
    if (fabs(part[lead % 3]) > 0.999 * length)
        snprintf(text + used, SN_TEXT_MAX - used, "%s%s %c", comma, what, "xyz"[lead % 3]);
    else
        snprintf(text + used, SN_TEXT_MAX - used, "%s%s (%.2g, %.2g, %.2g)", comma, what,
                 part[0] / length, part[1] / length, part[2] / length);
}

void sn_case_free_motions(const sn_case *c, char text[SN_TEXT_MAX]) {
    const sn_mesh *mesh = c->mesh;
    text[0] = 0;
    double low[3], high[3], gram[MODES][MODES] = {{0}}, size = sn_mesh_size(mesh);
    sn_mesh_box(mesh, low, high);
    // faces repeat their nodes: that changes weights, not what is free
    for (int i = 0; i < c->support_count + c->load_count; i++) {
        const sn_load *load = i < c->support_count ? NULL : &c->load[i - c->support_count];
        if (load && load->kind != SN_LOAD_DISPLACEMENT) continue;
        const sn_surface *s = &mesh->surface[load ? load->surface : c->support[i].surface];
        for (size_t k = 0; k < 3 * (size_t)s->face_count; k++) {
            double x[3];
            for (int d = 0; d < 3; d++)
                x[d] = (mesh->node[3 * (size_t)s->face[k] + (size_t)d] - (low[d] + high[d]) / 2) /
                       size;
            for (int d = 0; d < 3; d++)
                if (load ? !load->free[d] : c->support[i].fix[d]) add_row(x, d, gram);
        }
    }
    double null[MODES][MODES];
    int lead[MODES], count = null_space(gram, null);
    eliminate(null, count, lead);
    for (int mode = 0; mode < MODES; mode++)
        for (int r = 0; r < count; r++)
            if (lead[r] == mode) append_motion(text, null[r], mode);
}

int sn_case_carried_by(const sn_case *c) {
    bool alone = c->support_count == 0 && c->tool_count == 0 && c->load_count == 1 &&
                 c->load[0].kind == SN_LOAD_DISPLACEMENT && norm3(c->gravity) == 0;
    return alone ? c->load[0].surface : -1;
}
