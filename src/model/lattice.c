// Rectangular cells in three directions, cut into tetrahedra.
// SPDX-License-Identifier: Apache-2.0
//
// Kuhn: the six tetrahedra of a cell are the six ways to walk from one corner to the opposite one
// along the edges. The repeated cut starts from the low corner in every cell. The mirrored one
// starts, in each direction, from the side with the even index, so that neighbours reflect each
// other: faces match, and the star of an inner node is symmetric in all three directions.
//
// Body-centred: four tetrahedra around each inner face, each spanned by an edge of the face and the
// centres on both sides; a face on the boundary is halved and each half joined to the centre. The
// star of a corner inside is symmetric (6 corners, 8 centres), and so is that of a centre whose
// cell has no face on the boundary.
#include "model/lattice.h"

double sn_lattice_cell_count(const sn_lattice *l) {
    double n[3] = {l->cells[0], l->cells[1], l->cells[2]};
    if (l->pattern != SN_PATTERN_BCC) return 6 * n[0] * n[1] * n[2];
    double count = 0;
    for (int d = 0; d < 3; d++) {
        double layer = n[(d + 1) % 3] * n[(d + 2) % 3];
        count += l->ring && d == 1 ? 4 * layer * n[d] : 4 * layer * (n[d] - 1) + 2 * 2 * layer;
    }
    return count;
}

void sn_lattice_nodes(const sn_lattice *l, int n[3]) {
    for (int d = 0; d < 3; d++) n[d] = l->cells[d] + (l->ring && d == 1 ? 0 : 1);
}

double sn_lattice_corner_count(const sn_lattice *l) {
    double count = 1;
    for (int d = 0; d < 3; d++) count *= (double)l->cells[d] + (l->ring && d == 1 ? 0 : 1);
    return count;
}

double sn_lattice_node_count(const sn_lattice *l) {
    double centres = (double)l->cells[0] * l->cells[1] * l->cells[2];
    return sn_lattice_corner_count(l) + (l->pattern == SN_PATTERN_BCC ? centres : 0);
}

static int corner_at(const sn_lattice *l, const int at[3]) {
    int n[3];
    sn_lattice_nodes(l, n);
    return at[0] + n[0] * (at[1] % n[1] + n[1] * at[2]);
}

static int centre_at(const sn_lattice *l, const int at[3]) {
    int j = (at[1] + l->cells[1]) % l->cells[1];
    return (int)sn_lattice_corner_count(l) + at[0] + l->cells[0] * (j + l->cells[1] * at[2]);
}

// The six Kuhn tetrahedra of the cell at (i, j, k).
static int *cut_kuhn(const sn_lattice *l, const int at[3], int *out) {
    static const int walk[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    int start[3], step[3];
    for (int d = 0; d < 3; d++) {
        int odd = l->pattern == SN_PATTERN_MIRRORED ? at[d] % 2 : 0;
        start[d] = at[d] + odd;
        step[d] = odd ? -1 : 1;
    }
    for (int w = 0; w < 6; w++) {
        int p[3] = {start[0], start[1], start[2]};
        *out++ = corner_at(l, p);
        for (int s = 0; s < 3; s++) {
            p[walk[w][s]] += step[walk[w][s]];
            *out++ = corner_at(l, p);
        }
    }
    return out;
}

// The tetrahedra at the low face of the cell `at` across direction d; `at` may lie one beyond the
// last cell for the face that closes the lattice.
static int *cut_bcc_face(const sn_lattice *l, int d, const int at[3], int *out) {
    static const int round[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    int u = (d + 1) % 3, v = (d + 2) % 3, node[4];
    for (int c = 0; c < 4; c++) {
        int p[3] = {at[0], at[1], at[2]};
        p[u] += round[c][0];
        p[v] += round[c][1];
        node[c] = corner_at(l, p);
    }
    int below[3] = {at[0], at[1], at[2]};
    below[d]--;
    bool closed = l->ring && d == 1;
    if (closed || (at[d] > 0 && at[d] < l->cells[d])) {
        int low = centre_at(l, below), high = centre_at(l, at);
        for (int c = 0; c < 4; c++) {
            int tet[4] = {node[c], node[(c + 1) % 4], low, high};
            for (int i = 0; i < 4; i++) *out++ = tet[i];
        }
        return out;
    }
    int centre = centre_at(l, at[d] == 0 ? at : below);
    int first = (at[u] + at[v]) % 2; // diagonals alternate
    for (int half = 0; half < 2; half++) {
        int c = first + 2 * half;
        int tet[4] = {node[c], node[(c + 1) % 4], node[(c + 2) % 4], centre};
        for (int i = 0; i < 4; i++) *out++ = tet[i];
    }
    return out;
}

void sn_lattice_cut(const sn_lattice *l, int *cell) {
    bool bcc = l->pattern == SN_PATTERN_BCC;
    for (int d = 0; d < (bcc ? 3 : 1); d++) {
        int n[3] = {l->cells[0], l->cells[1], l->cells[2]};
        if (bcc && !(l->ring && d == 1)) n[d]++;
        int at[3];
        for (at[2] = 0; at[2] < n[2]; at[2]++)
            for (at[1] = 0; at[1] < n[1]; at[1]++)
                for (at[0] = 0; at[0] < n[0]; at[0]++)
                    cell = bcc ? cut_bcc_face(l, d, at, cell) : cut_kuhn(l, at, cell);
    }
}
