// Volume of cells and the forces of nodal pressure, by fans.
// SPDX-License-Identifier: Apache-2.0
//
// A fan goes round the edge from p to q: its cell k has the corners p q r_k r_k+1. With E and A_k
// the vectors from p to q and r_k at rest, d_e and d_k what they changed by, e = E + d_e, a_k = A_k
// + d_k,
//     6 V_k (J_k - 1) = d_e.(a_k x a_k+1) - d_k.(E x a_k+1) + d_k+1.(E x A_k)
// exactly and without loss of digits at small strain, and the derivatives of 6 V_k J_k are
//     a_k x a_k+1 for q,   -e x a_k+1 for r_k,   e x a_k for r_k+1,   less all these for p.
// No gradients or volumes are read.
#include "springs/kernels/block.h"

void SN_KERNEL(sn_volumes)(const sn_cell_pass *pass, const sn_tile *tile);
void SN_KERNEL(sn_press)(const sn_cell_pass *pass, const sn_tile *tile);

enum { WIDTH = SN_FAN_BLOCK, MEMBERS = SN_FAN_RING + 1 };

typedef struct fan_block {
    // of q, then of the ring, seen from p: displacement (where forces are found: place), and at
    // rest
    real d[3 * MEMBERS * WIDTH];
    real A[3 * MEMBERS * WIDTH];
    real p[(MEMBERS + 1) * WIDTH];     // pressure of p, then what others have more
    real f[3 * (MEMBERS + 1) * WIDTH]; // of p, q, then the ring: growth or force
} fan_block;

static const block_layout layout = {.width = WIDTH, .component = WIDTH, .spoke = 3 * WIDTH};

SN_INLINE void load3(const real *from, int i, wide x[3]) {
    for (int k = 0; k < 3; k++) x[k] = wide_load(from + k * WIDTH + i);
}

SN_INLINE void cross(const wide a[3], const wide b[3], wide c[3]) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        c[k] = a[i] * b[j] - a[j] * b[i];
    }
}

SN_INLINE wide dot(const wide a[3], const wide b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A node of the ring.
typedef struct ring_node {
    wide d[3], a[3];
    wide rest[3]; // E x A
    wide now[3];  // E x a
} ring_node;

SN_INLINE void ring_load(const fan_block *c, int k, int i, const wide E[3], ring_node *r) {
    wide A[3], turned[3];
    load3(c->d + 3 * (k + 1) * WIDTH, i, r->d);
    load3(c->A + 3 * (k + 1) * WIDTH, i, A);
    cross(E, A, r->rest);
    cross(E, r->d, turned);
    for (int j = 0; j < 3; j++) {
        r->a[j] = A[j] + r->d[j];
        r->now[j] = r->rest[j] + turned[j];
    }
}

// x of a cell that is there; present: Nullable row of the cells after ring node k, 0 where removed
SN_INLINE wide if_there(const real *present, int k, int i, wide x) {
    const wide none = wide_set(0);
    if (!present) return x;
    return wide_select(wide_less(none, wide_load(present + k * WIDTH + i)), x, none);
}

// a quarter of V (J - 1)
SN_INLINE wide cell_growth(const wide de[3], const ring_node *one, const ring_node *two) {
    wide c[3];
    cross(one->a, two->a, c);
    return (real)(1.0 / 24.0) * ((dot(de, c) - dot(one->d, two->now)) + dot(two->d, one->rest));
}

// growth of the members of the fans of one group of lanes
SN_INLINE void grow(fan_block *c, const real *present, int ring, bool closed, int i) {
    wide de[3], E[3], all, carry, first;
    ring_node one, two, start;
    load3(c->d, i, de);
    load3(c->A, i, E);
    ring_load(c, 0, i, E, &start);
    one = start;
    all = carry = first = wide_set(0);
    for (int k = 0; k + 1 < ring; k++) {
        ring_load(c, k + 1, i, E, &two);
        wide g = if_there(present, k, i, cell_growth(de, &one, &two));
        all = all + g;
        if (k == 0) first = g;
        wide_store(c->f + (2 + k) * WIDTH + i, carry + g);
        carry = g;
        one = two;
    }
    if (closed) {
        wide g = if_there(present, ring - 1, i, cell_growth(de, &one, &start));
        all = all + g;
        wide_store(c->f + 2 * WIDTH + i, first + g);
        carry = carry + g;
    }
    wide_store(c->f + (1 + ring) * WIDTH + i, carry);
    wide_store(c->f + i, all);
    wide_store(c->f + WIDTH + i, all);
}

SN_INLINE void grow_blocks(const sn_tile *tile, const tile_nodes *nodes, int ring, bool closed,
                           real *sum) {
    fan_block c;
    const int corners = 2 + ring;
    for (int b = 0; b < tile->blocks; b++) {
        const uint16_t *corner = tile->corner + b * corners * WIDTH;
        block_spokes(nodes, corner, corners - 1, layout, c.d, c.A);
        const real *present =
            tile->present ? (const real *)tile->present + b * corners * WIDTH : NULL;
        for (int i = 0; i < WIDTH; i += SN_LANES) grow(&c, present, ring, closed, i);
        for (int k = 0; k < corners * WIDTH; k += 4)
            for (int j = k; j < k + 4; j++) sum[corner[j]] += c.f[j];
    }
}

void SN_KERNEL(sn_volumes)(const sn_cell_pass *pass, const sn_tile *tile) {
    tile_nodes nodes;
    real sum[4 * SN_TILE_NODES]; // one of four is used: places are multiples of four
    tile_load(tile, pass->u, &nodes);
    for (int k = 0; k < tile->nodes; k++) sum[4 * k] = 0;
    grow_blocks(tile, &nodes, tile->ring, tile->closed, sum);
    real *growth = tile->growth;
    for (int k = 0; k < tile->nodes; k++) growth[k] = sum[4 * k];
}

// -p/6 of the cell after ring node k
SN_INLINE wide cell_pressure(const fan_block *c, int k, int next, int i) {
    const real quarter = (real)0.25, sixth = (real)(1.0 / 6.0);
    wide more = (wide_load(c->p + WIDTH + i) + wide_load(c->p + (2 + k) * WIDTH + i)) +
                wide_load(c->p + (2 + next) * WIDTH + i);
    return -sixth * (wide_load(c->p + i) + quarter * more);
}

/// A node of the ring under pressure.
typedef struct pressed_node {
    wide a[3];
    wide t[3]; // e x a
} pressed_node;

SN_INLINE void pressed_load(const fan_block *c, int k, int i, const wide e[3], pressed_node *r) {
    load3(c->d + 3 * (k + 1) * WIDTH, i, r->a);
    cross(e, r->a, r->t);
}

// the same of the stress that turns a crushed cell round: see SN_UPRIGHT
SN_INLINE wide upright_pressure(const fan_block *c, real modulus, int k, int next, int i,
                                const wide e[3], const pressed_node *one, const pressed_node *two) {
    const real sixth = (real)(1.0 / 6.0), tiny = (real)1e-30;
    wide E[3], A[3], B[3], n[3];
    load3(c->A, i, E);
    load3(c->A + 3 * (k + 1) * WIDTH, i, A);
    load3(c->A + 3 * (next + 1) * WIDTH, i, B);
    cross(A, B, n);
    wide rest = wide_max(dot(E, n), wide_set(tiny)); // what fills has no volume
    cross(one->a, two->a, n);
    return -sixth * modulus * wide_min(dot(e, n) / rest - (real)SN_UPRIGHT, wide_set(0));
}

// one cell: adds to the force on q, returns that on the ring
SN_INLINE void push_cell(wide p, const pressed_node *one, const pressed_node *two, wide q[3],
                         wide on_one[3], wide on_two[3]) {
    wide c[3];
    cross(one->a, two->a, c);
    for (int j = 0; j < 3; j++) {
        q[j] = q[j] + p * c[j];
        on_one[j] = p * two->t[j];
        on_two[j] = p * one->t[j];
    }
}

SN_INLINE void store3(real *to, int i, const wide x[3]) {
    for (int k = 0; k < 3; k++) wide_store(to + k * WIDTH + i, x[k]);
}

// forces on the members of the fans of one group of lanes
SN_INLINE void push(fan_block *c, const real *present, int ring, bool closed, real modulus, int i) {
    wide e[3], q[3], sum[3], carry[3], first[3], on_one[3], on_two[3];
    pressed_node one, two, start;
    load3(c->d, i, e);
    for (int j = 0; j < 3; j++) q[j] = sum[j] = carry[j] = first[j] = wide_set(0);
    pressed_load(c, 0, i, e, &start);
    one = start;
    for (int k = 0; k + 1 < ring; k++) {
        pressed_load(c, k + 1, i, e, &two);
        wide p = cell_pressure(c, k, k + 1, i);
        if (modulus > 0) p = p + upright_pressure(c, modulus, k, k + 1, i, e, &one, &two);
        p = if_there(present, k, i, p);
        push_cell(p, &one, &two, q, on_one, on_two);
        for (int j = 0; j < 3; j++) {
            on_one[j] = carry[j] - on_one[j];
            carry[j] = on_two[j];
            if (k == 0) first[j] = on_one[j];
            if (k > 0) sum[j] = sum[j] + on_one[j];
        }
        store3(c->f + 3 * (2 + k) * WIDTH, i, on_one);
        one = two;
    }
    if (closed) {
        wide p = cell_pressure(c, ring - 1, 0, i);
        if (modulus > 0) p = p + upright_pressure(c, modulus, ring - 1, 0, i, e, &one, &start);
        p = if_there(present, ring - 1, i, p);
        push_cell(p, &one, &start, q, on_one, on_two);
        for (int j = 0; j < 3; j++) {
            first[j] = first[j] + on_two[j];
            carry[j] = carry[j] - on_one[j];
        }
        store3(c->f + 3 * 2 * WIDTH, i, first);
    }
    store3(c->f + 3 * (1 + ring) * WIDTH, i, carry);
    store3(c->f + 3 * WIDTH, i, q);
    for (int j = 0; j < 3; j++) sum[j] = -(((sum[j] + first[j]) + carry[j]) + q[j]);
    store3(c->f, i, sum);
}

SN_INLINE void push_blocks(const sn_tile *tile, const real *now, int ring, bool closed,
                           real modulus) {
    fan_block c;
    const int corners = 2 + ring;
    for (int b = 0; b < tile->blocks; b++) {
        const uint16_t *corner = tile->corner + b * corners * WIDTH;
        block_fourth(now, corner, WIDTH, c.p);
        block_quads(now, corner, corners - 1, layout, c.d, c.p + WIDTH);
        if (modulus > 0) block_quads(tile->position, corner, corners - 1, layout, c.A, NULL);
        const real *present =
            tile->present ? (const real *)tile->present + b * corners * WIDTH : NULL;
        for (int i = 0; i < WIDTH; i += SN_LANES) push(&c, present, ring, closed, modulus, i);
        for (int k = 0; k < corners; k++)
            for (int i = 0; i < WIDTH; i += 4) {
                const real *from = c.f + 3 * k * WIDTH + i;
                quad q[4];
                block_take(from, from + WIDTH, from + 2 * WIDTH, q);
                tile_add(tile->force, corner + k * WIDTH + i, q);
            }
    }
}

void SN_KERNEL(sn_press)(const sn_cell_pass *pass, const sn_tile *tile) {
    tile_quads now;
    tile_load_quads(tile, pass->u, tile->position, pass->pressure, &now);
    memset(tile->force, 0, (size_t)tile->nodes * sizeof(quad));
    push_blocks(tile, now.at, tile->ring, tile->closed, (real)pass->upright);
}
