// What the kernels of the springs are told: plain pointers and sizes, one struct a pass.
// SPDX-License-Identifier: Apache-2.0
//
// Items (cells, springs, volume points) stand in blocks of SN_BLOCK, each block a structure of
// arrays: component k of item i of block b is at [(b * components + k) * SN_BLOCK + i]. Blocks are
// filled up with copies of their last item whose volume or stiffness is 0, so no kernel has a tail.
// What nodes carry (displacement, velocity, force) are quads: x y z and an unused fourth number.
//
// Consecutive blocks of one kind and one region make a tile: so few that what their nodes carry
// fits the first cache. A tile reads its nodes once, works on copies, and adds the forces of its
// items up in an array of its own, one entry for each of its nodes, in the order of its items. Then
// every node sums the entries of its tiles, in the order of its list. No two tiles write to one
// place and every sum has one order, whatever the number of lanes or threads.
//
// Springs stand in stars of SN_STAR that share their end 0: spring n of a star stands n SN_BLOCK /
// SN_STAR slots after the first. The corners of a star are its middle and the other ends.
//
// The volume of cells is computed by fans: cells around one edge, which share two nodes each with
// the next. A fan of six cells reads and writes 8 nodes, where six cells alone do 24. Fans stand in
// blocks of SN_FAN_BLOCK, all of one size and kind in a tile.
//
// Smoothed edges: strain and stress live at edges, each with a sixth of every cell around it. What
// cells tell edges and edges tell cells stands item by item, in quads, since both read it in an
// order of their own.
//
// `void *` stands for arrays of float or double: the precision of the kernel that is called.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "sinew/law.h"
#include "sinew/model.h"

#define SN_BLOCK 128
#define SN_STAR 4                          ///< springs of a star
#define SN_FAN_BLOCK 32                    ///< fans in a block
#define SN_FAN_RING 8                      ///< most nodes around the edge of a fan
#define SN_TILE_BLOCKS 8                   ///< most blocks of a tile
#define SN_TILE_NODES 512                  ///< most nodes of a tile; four times SN_BLOCK at least
#define SN_NODE_CHUNK 256                  ///< nodes that one call of a kernel moves or sums
#define SN_BRANCHES_MAX (SN_TERMS_MAX + 1) ///< exponentials and the viscous part

/// A net that was crushed may stand with cells turned inside out: springs and mean pressures can
/// balance there. Cells below this part of their volume then get a stress of their own, upright
/// (J - SN_UPRIGHT), until none is.
#define SN_UPRIGHT 0.3

#define SN_SPRING_STEEPEST                                                                         \
    60.0 ///< most of C x^2 in the law of a spring: finite in single precision

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

/// Consecutive blocks of items that share nodes.
typedef struct sn_tile {
    int block, blocks;
    int nodes;
    const int *node;        ///< of the net                       (nodes)
    const int *point;       ///< volume point of each node        (nodes)
    const uint16_t *corner; ///< of the items: four times the place in `node`
                            ///<                                  (blocks x corners x SN_BLOCK)
    int ring;               ///< fans: nodes around the edge; corners are its ends, then these
    bool closed;            ///< fans: the last node of the ring meets the first
    const void *present;    ///< fans, Nullable: 0 where the cell behind a node of the ring was
                            ///< removed; beside `corner`
    const void *position;   ///< quads: at rest, from some origin  (nodes)
    void *force;            ///< out: quads                       (nodes)
    void *growth;           ///< out of the volume pass, m3       (nodes)
} sn_tile;

/// The cells of one region; on the smoothed rung its edges too, where the law and its memory then
/// are. Arrays of items start at block 0 of the net.
typedef struct sn_cell_pass {
    const void *gradient; ///< of shape functions 1 2 3, 1/m      (blocks x 9 x SN_BLOCK)
    const void *volume;   ///< m3                                 (blocks x SN_BLOCK)
    const void *u;        ///< quads
    double axes[9];       ///< rotation to material axes
    bool rotated;         ///< axes are not the identity
    const void *turn;     ///< Nullable: axes of the law of each item, where they differ and the
                          ///< pass is in axes of space           (blocks x 9 x SN_BLOCK)
    const sn_law *law;
    const double *value;
    const float *value_f;
    int terms;
    sn_volume_mode volume_mode;
    double bulk;
    double upright;        ///< Pa; 0: no cell is crushed. With SN_VOLUME_NODE
    const void *pressure;  ///< at the volume points
    int first;             ///< block of the net where the memory starts
    sn_memory_pass memory; ///< 6 components, 7 with SN_VOLUME_CELL; apart: 6
    // parts of the stress that have a memory each
    bool apart;
    const double *fibre_value; ///< Nullable: fibres, which `value` is without
    const float *fibre_value_f;
    sn_memory_pass bulk_memory;  ///< 1 component, with SN_VOLUME_CELL
    sn_memory_pass fibre_memory; ///< 6 components
    // smoothed
    void *shape;            ///< of cells: three quads, the rows of V/6 H; V/6 in the first one
    void *piola;            ///< of edges: three quads, the rows of the first Piola-Kirchhoff stress
    const int *share_start; ///< into `share`                     (edge blocks x SN_BLOCK + 1)
    const int *share;       ///< slots of the cells around an edge
    const int *edge;        ///< slots of the edges of a cell     (blocks x 6 x SN_BLOCK)
} sn_cell_pass;

/// The volume points of one region: a node, as far as it belongs to this region.
typedef struct sn_point_pass {
    const int *start;      ///< into `item`                        (blocks x SN_BLOCK + 1)
    const int *item;       ///< entries of `growth`
    const void *growth;    ///< of the nodes of tiles
    const void *stiffness; ///< K / V of the point, Pa/m3         (blocks x SN_BLOCK)
    int first;             ///< block of the net where the memory starts
    sn_memory_pass memory; ///< one component
    void *pressure;        ///< out                                 (blocks x SN_BLOCK)
} sn_point_pass;

/// The springs of one region.
typedef struct sn_spring_pass {
    const void *stiffness; ///< N/m                               (blocks x SN_BLOCK)
    double exponent;       ///< B of the law
    const double *square;  ///< Nullable: C and c of the law    (SN_SPRING_SQUARES)
    const void *u;
    int first;             ///< block of the net where the memory starts
    sn_memory_pass memory; ///< one component: force over stiffness and rest length
} sn_spring_pass;

/// Sums the entries of tiles at nodes.
typedef struct sn_node_pass {
    int nodes;
    const void *weight; ///< quads: mass times gravity
    const int *start;   ///<                                     (nodes + 1)
    const int *item;    ///< entries of `part`
    const void *part;   ///< quads: forces of the nodes of tiles
    void *force;        ///< out: quads
} sn_node_pass;

/// Kick and drift of symplectic Euler.
typedef struct sn_move_pass {
    int nodes;
    double step;
    double kick;              ///< time that the forces act on the velocity
    const void *force;        ///< quads
    const void *inverse_mass; ///< quads: 0 in prescribed directions
    void *u, *v;
    double *sum;     ///< out, by chunk: sum of squared velocities; not finite when the state is not
    double *fastest; ///< out, by chunk: square of the largest component of a velocity
} sn_move_pass;

typedef struct sn_spring_kernels {
    void (*volumes)(const sn_cell_pass *pass, const sn_tile *tile); ///< fills growth, by fans
    void (*points)(const sn_point_pass *pass, int block);
    void (*cells)(const sn_cell_pass *pass, const sn_tile *tile);
    void (*press)(const sn_cell_pass *pass, const sn_tile *tile);  ///< pressure alone, by fans
    void (*shapes)(const sn_cell_pass *pass, const sn_tile *tile); ///< cells to `shape`
    void (*edges)(const sn_cell_pass *pass, int block);            ///< the law: shape to piola
    void (*shares)(const sn_cell_pass *pass, const sn_tile *tile); ///< piola to forces of cells
    void (*springs)(const sn_spring_pass *pass, const sn_tile *tile);
    void (*nodes)(const sn_node_pass *pass, int chunk);
    void (*move)(const sn_move_pass *pass, int chunk);
    double (*peak)(long turns, double *out); ///< independent arithmetic; returns operations done
} sn_spring_kernels;

/// The kernels of an instruction set (base/isa.h) and a precision.
const sn_spring_kernels *sn_spring_kernels_row(int isa, sn_precision precision);
