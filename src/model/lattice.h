// Rectangular cells in three directions, cut into tetrahedra: blocks, and tubes after bending.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

/// A lattice of cells. Node (i, j, k) is number i + n0 (j + n1 k); the centres of the cells follow
/// in the same manner where the pattern has them.
typedef struct sn_lattice {
    int cells[3];
    bool ring; ///< direction 1 closes on itself: its last cells meet the first
    sn_pattern pattern;
} sn_lattice;

/// Tetrahedra the lattice is cut into. Wide: what int cannot hold is counted right.
double sn_lattice_cell_count(const sn_lattice *lattice);
/// Nodes in each direction.
void sn_lattice_nodes(const sn_lattice *lattice, int n[3]);
/// Corners of all cells; then the centres in addition.
double sn_lattice_corner_count(const sn_lattice *lattice);
double sn_lattice_node_count(const sn_lattice *lattice);
/// Writes the nodes of all tetrahedra, in no particular orientation (count x 4).
/// A ring needs 3 cells in direction 1; an even number in the mirrored pattern.
void sn_lattice_cut(const sn_lattice *lattice, int *cell);
