// What the kernels of the springs are told: plain pointers and sizes, one struct a pass.
// SPDX-License-Identifier: Apache-2.0
//
// Items (cells, springs, volume points) stand in blocks of SN_BLOCK, each block a structure of
// arrays: component k of item i of block b is at [(b * components + k) * SN_BLOCK + i]. Blocks are
// filled up with copies of their last item whose volume or stiffness is 0, so no kernel has a tail.
// What nodes carry (displacement, velocity, force) are quads: x y z and an unused fourth number.
//
// A step has two passes. The first reads node displacements and writes a force for every item; the
// second sums, node by node, over the items that touch it, in the order of its list. Nothing is
// scattered, so the sum has one order whatever the number of lanes or threads.
//
// `void *` stands for arrays of float or double: the precision of the kernel that is called.
#pragma once

#include <stddef.h>

#include "sinew/law.h"
#include "sinew/model.h"

#define SN_BLOCK 128
#define SN_BRANCHES_MAX (SN_TERMS_MAX + 1) ///< exponentials and the viscous part

/// How an instantaneous stress becomes the stress with memory.
typedef enum sn_memory_mode {
    SN_MEMORY_OFF,     ///< it stays what it is
    SN_MEMORY_ADVANCE, ///< one step of the recursion, which is kept
    SN_MEMORY_TRIAL ///< the value at the end of a step that may be tried again: alpha T + history
} sn_memory_mode;

typedef struct sn_memory_pass {
    sn_memory_mode mode;
    int branches;
    double g_inf, alpha;
    double decay[SN_BRANCHES_MAX], gain[SN_BRANCHES_MAX];
    void *store; ///< T before, then the branches  (blocks x (1 + branches) x components x SN_BLOCK)
    const void *history; ///< (blocks x components x SN_BLOCK)
} sn_memory_pass;

/// Where the volume stress of a cell comes from.
typedef enum sn_volume_mode {
    SN_VOLUME_NONE, ///< no such term
    SN_VOLUME_CELL, ///< K (J - 1) of the cell itself: the seventh component of its stress
    SN_VOLUME_NODE  ///< mean pressure of the four volume points
} sn_volume_mode;

/// The cells of one region.
typedef struct sn_cell_pass {
    int blocks;
    const int *node;      ///<                                    (blocks x 4 x SN_BLOCK)
    const void *gradient; ///< of shape functions 1 2 3, 1/m      (blocks x 9 x SN_BLOCK)
    const void *volume;   ///< m3                                 (blocks x SN_BLOCK)
    const void *u;        ///< quads
    double axes[9];       ///< rotation to material axes
    bool rotated;         ///< axes are not the identity
    const sn_law *law;    ///< NULL: only the volume term (central rung)
    const double *value;
    const float *value_f;
    int terms;
    sn_volume_mode volume_mode;
    double bulk;
    const int *point;      ///< volume points of the corners       (blocks x 4 x SN_BLOCK)
    const void *pressure;  ///< at the volume points
    sn_memory_pass memory; ///< 6 components, 7 with SN_VOLUME_CELL
    void *growth;          ///< out of the volume pass: V (J - 1) / 4, m3   (blocks x SN_BLOCK)
    void *force;           ///< out of the force pass: quads       (blocks x 4 x SN_BLOCK)
} sn_cell_pass;

/// The volume points of one region: a node, as far as it belongs to this region.
typedef struct sn_point_pass {
    int blocks;
    const int *start; ///< into `item`, of this region's points (blocks x SN_BLOCK + 1)
    const int *item;  ///< cells: index into `growth`
    const void *growth;
    const void *stiffness; ///< K / V of the point, Pa/m3         (blocks x SN_BLOCK)
    sn_memory_pass memory; ///< one component
    void *pressure;        ///< out                                 (blocks x SN_BLOCK)
} sn_point_pass;

/// The springs of one region.
typedef struct sn_spring_pass {
    int blocks;
    const int *end;        ///<                                   (blocks x 2 x SN_BLOCK)
    const void *edge;      ///< rest vector from end 0 to end 1, m (blocks x 3 x SN_BLOCK)
    const void *inverse;   ///< 1 / rest length squared           (blocks x SN_BLOCK)
    const void *stiffness; ///< N/m                               (blocks x SN_BLOCK)
    double exponent;       ///< B of the law
    const void *u;
    sn_memory_pass memory; ///< one component: force over stiffness and rest length
    void *force;           ///< out: on end 0; end 1 gets the opposite. quads (blocks x SN_BLOCK)
} sn_spring_pass;

/// Sums item forces at nodes.
typedef struct sn_node_pass {
    int nodes;
    const void *weight; ///< quads: mass times gravity
    const int *start;   ///< three lists a node: springs that end 0 here, end 1, cell corners
                        ///<                                      (3 x nodes + 1)
    const int *item;    ///< quads in spring_force or cell_force
    const void *spring_force, *cell_force;
    void *force; ///< out: quads
} sn_node_pass;

/// Kick and drift of symplectic Euler.
typedef struct sn_move_pass {
    int nodes;
    double step;
    double kick;              ///< time that the forces act on the velocity
    const void *force;        ///< quads
    const void *inverse_mass; ///< quads: 0 in prescribed directions
    void *u, *v;
    double sum;     ///< out: sum of squared velocities; not finite when the state is not
    double fastest; ///< out: bound of the speed of any node: the largest component times sqrt 3
} sn_move_pass;

typedef struct sn_spring_kernels {
    void (*volumes)(const sn_cell_pass *pass); ///< fills growth
    void (*points)(const sn_point_pass *pass);
    void (*cells)(const sn_cell_pass *pass);
    void (*springs)(const sn_spring_pass *pass);
    void (*nodes)(const sn_node_pass *pass);
    void (*move)(sn_move_pass *pass);
} sn_spring_kernels;

/// The kernels of an instruction set (base/isa.h) and a precision.
const sn_spring_kernels *sn_spring_kernels_row(int isa, sn_precision precision);
