// Rigid motions that the supports leave free, where the loads do not push along them.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/rigid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SEEN 1e-6     // part of a motion that a fixed direction must see
#define BALANCED 1e-9 // resultant of a load along a motion, of the sum of its parts

typedef double motion[6]; // translation, then rotation about the middle of the body

static double dot6(const motion a, const motion b) {
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += a[k] * b[k];
    return sum;
}

// Displacement in direction d at r from the middle: t + w x r.
static double moved(const motion m, const double r[3], int d) {
    int a = (d + 1) % 3, b = (d + 2) % 3;
    return m[d] + m[3 + a] * r[b] - m[3 + b] * r[a];
}

// The motion that a direction of a node sees, as a unit row.
static void row_of(const sn_fe_space *s, int node, int d, motion row) {
    double r[3];
    for (int i = 0; i < 3; i++) r[i] = (s->rest[3 * node + i] - s->middle[i]) / s->size;
    for (int k = 0; k < 6; k++) {
        motion unit = {0};
        unit[k] = 1.0;
        row[k] = moved(unit, r, d);
    }
}

// Makes v orthogonal to an orthonormal set, twice for rounding; returns the length left.
static double reduce(motion *basis, int count, motion v) {
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < count; k++) {
            double along = dot6(basis[k], v);
            for (int i = 0; i < 6; i++) v[i] -= along * basis[k][i];
        }
    return sqrt(dot6(v, v));
}

static void keep(motion *basis, int *count, const motion v, double length) {
    for (int i = 0; i < 6; i++) basis[*count][i] = v[i] / length;
    (*count)++;
}

// What the fixed directions see: each time the row that is least seen so far. With `part`, of the
// nodes of one part of the body alone.
static int seen_motions(const sn_fe_space *s, const int *part, int which, motion *basis) {
    int count = 0;
    while (count < 6) {
        motion best = {0};
        double longest = 0.0;
        for (int a = 0; a < s->nodes; a++)
            for (int d = 0; d < 3; d++) {
                motion v;
                if (!(s->fixed[a] >> d & 1) || (part && part[a] != which)) continue;
                row_of(s, a, d, v);
                double length = reduce(basis, count, v);
                if (length > longest) {
                    longest = length;
                    memcpy(best, v, sizeof best);
                }
            }
        if (longest < SEEN) break;
        keep(basis, &count, best, longest);
    }
    return count;
}

// Pins by elimination with full pivoting: afterwards the motions are independent at the pins.
static void choose_pins(sn_fe_space *s) {
    motion left[6];
    memcpy(left, s->free_motion, sizeof left);
    for (int k = 0; k < s->free_motions; k++) {
        double largest = 0.0, row[6];
        int which = k;
        for (int a = 0; a < s->corners; a++)
            for (int d = 0; d < 3; d++) {
                if (s->fixed[a] >> d & 1) continue;
                row_of(s, a, d, row);
                for (int j = k; j < s->free_motions; j++)
                    if (fabs(dot6(left[j], row)) > largest * (1.0 + 1e-9)) {
                        largest = fabs(dot6(left[j], row));
                        which = j;
                        s->pin[k] = 3 * a + d;
                    }
            }
        motion swap;
        memcpy(swap, left[k], sizeof swap);
        memcpy(left[k], left[which], sizeof swap);
        memcpy(left[which], swap, sizeof swap);
        row_of(s, s->pin[k] / 3, s->pin[k] % 3, row);
        for (int j = k + 1; j < s->free_motions; j++) {
            double by = dot6(left[j], row) / dot6(left[k], row);
            for (int i = 0; i < 6; i++) left[j][i] -= by * left[k][i];
        }
    }
}

static void find_size(sn_fe_space *s) {
    double low[3] = {(double)INFINITY, (double)INFINITY, (double)INFINITY},
           high[3] = {-(double)INFINITY, -(double)INFINITY, -(double)INFINITY};
    for (int n = 0; n < 3 * s->corners; n++) {
        low[n % 3] = fmin(low[n % 3], s->rest[n]);
        high[n % 3] = fmax(high[n % 3], s->rest[n]);
    }
    s->size = 0.0;
    for (int i = 0; i < 3; i++) {
        s->middle[i] = 0.5 * (low[i] + high[i]);
        s->size = fmax(s->size, high[i] - low[i]);
    }
}

void sn_fe_rigid_find(sn_fe_space *s) {
    motion basis[6];
    find_size(s);
    int seen = seen_motions(s, NULL, 0, basis), count = seen;
    while (count < 6) { // complete the basis: each time the unit motion that is least in it
        motion best = {0};
        double longest = 0.0;
        for (int k = 0; k < 6; k++) {
            motion v = {0};
            v[k] = 1.0;
            double length = reduce(basis, count, v);
            if (length > longest) {
                longest = length;
                memcpy(best, v, sizeof best);
            }
        }
        keep(basis, &count, best, longest);
    }
    s->free_motions = 6 - seen;
    memcpy(s->free_motion, basis + seen, (size_t)s->free_motions * sizeof *basis);
    choose_pins(s);
}

//---- parts of the body that do not hang together -------------------------------------------------

static int part_of(int *part, int node) {
    while (part[node] != node) node = part[node] = part[part[node]];
    return node;
}

// The smallest node of its part for every node; returns how many parts there are.
static int find_parts(const sn_fe_space *s, const sn_mesh *mesh, int *part) {
    int parts = 0, node[SN_FE_NODES];
    for (int a = 0; a < s->nodes; a++) part[a] = a;
    for (int c = 0; c < mesh->cell_count; c++) {
        sn_fe_cell_nodes(s, mesh, c, node);
        for (int k = 1; k < s->element.nodes; k++) {
            int one = part_of(part, node[0]), other = part_of(part, node[k]);
            part[one > other ? one : other] = one > other ? other : one;
        }
    }
    for (int a = 0; a < s->nodes; a++) {
        part[a] = part_of(part, a);
        parts += part[a] == a;
    }
    return parts;
}

sn_status sn_fe_rigid_parts(const sn_fe_space *s, const sn_mesh *mesh) {
    int *part = sn_alloc((size_t)s->nodes, sizeof *part);
    if (!part) return SN_E_MEMORY;
    sn_status status = SN_OK;
    int parts = find_parts(s, mesh, part);
    for (int a = 0; a < s->nodes && parts > 1 && status == SN_OK; a++) {
        motion basis[6];
        if (part[a] != a || seen_motions(s, part, a, basis) == 6) continue;
        const double *at = s->rest + 3 * a;
        status = sn_fail(SN_E_DEFINITION,
                         "the mesh has %d parts that do not touch, and the one at (%.4g, %.4g, "
                         "%.4g) m hangs on nothing: join it to the rest, leave it out, or fix it",
                         parts, at[0], at[1], at[2]);
    }
    sn_free(part);
    return status;
}

//---- parts that hang together by a node or an edge -----------------------------------------------

enum { BLOCKS = 32 }; // most blocks whose hinges are searched

/// Blocks are what hangs together by faces. Each may move as a rigid body; what holds them are the
/// supports and the nodes they share.
typedef struct blocks {
    int count, rank, hinge; ///< a node that two share; -1
    int *of_cell;           ///< block of each cell of the mesh
    double basis[6 * BLOCKS][6 * BLOCKS];
} blocks;

typedef struct side {
    int node[3], cell; ///< nodes rising
} side;

static int compare_sides(const void *a, const void *b) {
    const int *x = ((const side *)a)->node, *y = ((const side *)b)->node;
    for (int k = 0; k < 3; k++)
        if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

static void list_sides(const sn_mesh *mesh, side *to) {
    for (int f = 0; f < 4 * mesh->cell_count; f++, to++) {
        const int *cell = mesh->cell + 4 * (size_t)(f / 4);
        to->cell = f / 4;
        for (int k = 0, n = 0; k < 4; k++) {
            if (k == f % 4) continue;
            int at = n++;
            for (; at > 0 && to->node[at - 1] > cell[k]; at--) to->node[at] = to->node[at - 1];
            to->node[at] = cell[k];
        }
    }
}

static sn_status find_blocks(const sn_mesh *mesh, blocks *b) {
    size_t count = 4 * (size_t)mesh->cell_count;
    side *sides = sn_alloc(count, sizeof *sides);
    if (!sides) return SN_E_MEMORY;
    list_sides(mesh, sides);
    qsort(sides, count, sizeof *sides, compare_sides);
    for (int n = 0; n < mesh->cell_count; n++) b->of_cell[n] = n;
    for (size_t f = 1; f < count; f++) {
        if (compare_sides(sides + f - 1, sides + f) != 0) continue;
        int one = part_of(b->of_cell, sides[f - 1].cell),
            other = part_of(b->of_cell, sides[f].cell);
        b->of_cell[one > other ? one : other] = one > other ? other : one;
    }
    sn_free(sides);
    // a parent stands before its cells: it holds the number of its block, -1 - k, when they ask
    for (int n = 0; n < mesh->cell_count; n++) {
        int parent = b->of_cell[n];
        b->of_cell[n] = parent == n ? -1 - b->count++ : b->of_cell[parent];
    }
    for (int n = 0; n < mesh->cell_count; n++) b->of_cell[n] = -1 - b->of_cell[n];
    return SN_OK;
}

// Adds what direction d of a node sees in one block, less what it sees in another (-1: none).
static void add_row(const sn_fe_space *s, blocks *b, int node, int d, int block, int other) {
    double row[6 * BLOCKS] = {0}, length;
    int size = 6 * b->count;
    row_of(s, node, d, row + 6 * block);
    for (int k = 0; k < 6 && other >= 0; k++) row[6 * other + k] = -row[6 * block + k];
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < b->rank; k++) {
            double along = 0.0;
            for (int i = 0; i < size; i++) along += b->basis[k][i] * row[i];
            for (int i = 0; i < size; i++) row[i] -= along * b->basis[k][i];
        }
    length = 0.0;
    for (int i = 0; i < size; i++) length += row[i] * row[i];
    length = sqrt(length);
    if (length < SEEN) return;
    for (int i = 0; i < size; i++) b->basis[b->rank][i] = row[i] / length;
    b->rank++;
}

static void add_rows(const sn_fe_space *s, const sn_mesh *mesh, int *first, blocks *b) {
    for (int a = 0; a < mesh->node_count; a++) first[a] = -1;
    for (int n = 0; n < 4 * mesh->cell_count && b->rank < 6 * b->count; n++) {
        int node = mesh->cell[n], block = b->of_cell[n / 4];
        if (first[node] == block) continue;
        for (int d = 0; d < 3; d++)
            if (first[node] >= 0)
                add_row(s, b, node, d, block, first[node]);
            else if (s->fixed[node] >> d & 1)
                add_row(s, b, node, d, block, -1);
        if (first[node] >= 0)
            b->hinge = node;
        else
            first[node] = block;
    }
}

sn_status sn_fe_rigid_hinges(const sn_fe_space *s, const sn_mesh *mesh) {
    sn_status status = SN_E_MEMORY;
    blocks *b = sn_alloc(1, sizeof *b);
    int *first = sn_alloc((size_t)mesh->node_count, sizeof *first);
    if (!b || !first || !(b->of_cell = sn_alloc((size_t)mesh->cell_count, sizeof *b->of_cell)))
        goto fail;
    b->hinge = -1;
    SN_TRY_GOTO(status, find_blocks(mesh, b));
    if (b->count == 1 || b->count > BLOCKS) goto fail; // many: Newton has to find out
    add_rows(s, mesh, first, b);
    if (b->rank >= 6 * b->count - s->free_motions || b->hinge < 0) goto fail;
    const double *at = s->rest + 3 * b->hinge;
    status = sn_fail(SN_E_DEFINITION,
                     "the mesh has %d parts that meet in single nodes or edges only, as at (%.4g, "
                     "%.4g, %.4g) m, and one can turn there as on a hinge: join them by faces, or "
                     "fix more",
                     b->count, at[0], at[1], at[2]);
fail:
    if (b) sn_free(b->of_cell);
    sn_free(b);
    sn_free(first);
    return status;
}

//---- loads ---------------------------------------------------------------------------------------

static bool balanced(const sn_fe_space *s, const double *force) {
    double total = 0.0;
    for (int n = 0; n < 3 * s->nodes; n++) total += fabs(force[n]);
    for (int k = 0; k < s->free_motions; k++) {
        double along = 0.0;
        for (int n = 0; n < 3 * s->nodes; n++) {
            motion row;
            if (force[n] == 0.0) continue;
            row_of(s, n / 3, n % 3, row);
            along += force[n] * dot6(s->free_motion[k], row);
        }
        if (fabs(along) > BALANCED * total) return false;
    }
    return true;
}

sn_status sn_fe_rigid_check(const sn_fe_space *s, const sn_case *c, sn_fe_boundary *b) {
    char motions[SN_TEXT_MAX];
    if (s->free_motions == 0) return SN_OK;
    sn_case_free_motions(c, motions);
    const char *why = c->tool_count > 0 ? "a tool may push along it" : NULL;
    double *force = sn_alloc((size_t)s->dofs, sizeof *force);
    double *rest = sn_alloc((size_t)s->dofs, sizeof *rest);
    for (int k = -1; force && rest && k < c->load_count && !why; k++) {
        memset(force, 0, (size_t)s->dofs * sizeof *force);
        sn_fe_boundary_load(b, c, s, k, rest, force);
        if (!balanced(s, force)) why = k < 0 ? "gravity pushes along it" : "a load pushes along it";
    }
    bool memory = force && rest;
    sn_free(force);
    sn_free(rest);
    if (!memory) return SN_E_MEMORY;
    if (!why) return SN_OK;
    return sn_fail(SN_E_DEFINITION,
                   "the supports leave rigid motion free: %s; %s: fix more directions or surfaces",
                   motions, why);
}

// Solves the symmetric positive definite system in place by Gauss elimination.
static void solve(double G[6][7], int n) {
    for (int k = 0; k < n; k++)
        for (int i = 0; i < n; i++) {
            double by = i == k ? 0.0 : G[i][k] / G[k][k];
            for (int j = k; j <= n; j++) G[i][j] -= by * G[k][j];
        }
    for (int k = 0; k < n; k++) G[k][n] /= G[k][k];
}

void sn_fe_rigid_project(const sn_fe_space *s, const int *row, const double *x, double *increment) {
    int n = s->free_motions;
    double G[6][7] = {{0}};
    if (n == 0) return;
    for (int pass = 0; pass < 2; pass++) { // sums, then the subtraction
        for (int a = 0; a < s->nodes; a++) {
            double r[3];
            for (int i = 0; i < 3; i++)
                r[i] = (s->rest[3 * a + i] + x[3 * a + i] - s->middle[i]) / s->size;
            for (int d = 0; d < 3; d++) {
                double v[6];
                if (row[3 * a + d] == SN_FE_PRESCRIBED) continue;
                for (int k = 0; k < n; k++) v[k] = moved(s->free_motion[k], r, d);
                for (int k = 0; k < n; k++) {
                    if (pass) increment[3 * a + d] -= G[k][n] * v[k];
                    for (int j = 0; j < n && !pass; j++) G[k][j] += v[k] * v[j];
                    if (!pass) G[k][n] += v[k] * increment[3 * a + d];
                }
            }
        }
        if (!pass) solve(G, n);
    }
}
