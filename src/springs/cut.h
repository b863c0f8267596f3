// The inside of what cuts need: constant lists of a net, and what a state has lost.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/parts.h"

/// A load on faces, and the cells behind them.
typedef struct sn_cutting_load {
    int faces;        ///< 1 of a force at a point: the cell around it
    int *cell;        ///< behind each face                         (faces)
    int *place;       ///< traction: entries of its `node` at the corners (faces x 3)
    double *third;    ///< traction: a third of the area, m2        (faces)
    double vector[3]; ///< of the case: traction, Pa, or force, N
} sn_cutting_load;

struct sn_cutting {
    int *neighbour;       ///< cell beyond the face opposite each corner, -1 none (cells x 4)
    double *third;        ///< a third of the area of that face, m2       (cells x 4)
    double penalty;       ///< of contact, Pa/m
    int *fan_slot;        ///< slot of the cell after each node of a ring, -1 none: beside `corner`
    double *share;        ///< weight of the cell in the spring, beside `spring_share`
    double *spring_whole; ///< sum of the weights of each spring (spring_blocks x SN_BLOCK)
    sn_cutting_load *load;
    int load_count;
    int count; ///< cuts of the case, by time
    double *at;
    int *start; ///< into `cell`                                 (count + 1)
    int *cell;  ///< cells of the mesh, rising in each cut
};

struct sn_cut {
    sn_parts parts;
    bool *removed; ///< cells of the mesh
    int count;     ///< of them
    int next;      ///< cut of the case that comes next
    // what parts point at
    void *volume[2], *stiffness[2], *point_stiffness[2], *present[2];
    double *point_volume, *spring_volume, *contact_stiffness;
    uint16_t *cell_corner, *spring_corner;
    unsigned char *spring_empty;
    int *rim, rim_count;
    bool *gone, *loose;
    int load_count;
    double **load_force;
    bool **load_gone;
    // the pieces that hang together
    int *piece; ///< of each node; -1 loose
    int pieces;
    bool free_piece; ///< one that nothing holds
    sn_rigid *rigid; ///< (nodes / 4 + 1)
    // scratch
    bool *touched; ///< of springs, points or nodes
    double *sum;   ///< of the same
};
