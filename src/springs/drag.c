// Damping by mass of the implicit step: forces on the motion relative to the rigid motion.
// SPDX-License-Identifier: Apache-2.0
//
// With R the six rigid motions of a piece of the body, orthonormal in M, the matrix of damping is
// M - sum (M R)(M R)^T, piece by piece: a piece that was cut off flies as a whole without damping,
// and a node that lost all its cells too.
#include <math.h>
#include <string.h>

#include "springs/parts.h"
#include "springs/steps.h"

/// The pieces of a body, and sums over each: one piece where nothing was cut.
typedef struct piece_sums {
    const int *piece; ///< Nullable: of nodes, -1 of loose ones
    int pieces;
    sn_rigid *all, whole; ///< `mass` and `centre`; sums in `linear`
} piece_sums;

static int piece_of(const piece_sums *p, size_t node) {
    return p->piece ? p->piece[node] : 0;
}

// sums over the pieces of a . b, over mass where there is one; into linear[to]
static void sum_pieces(const sn_net *net, piece_sums *p, const double *a, const double *b,
                       const double *mass, int to) {
    for (int k = 0; k < p->pieces; k++) p->all[k].linear[to] = 0;
    for (size_t q = 0; q < (size_t)net->nodes * 3; q++) {
        const int k = piece_of(p, q / 3);
        if (k >= 0) p->all[k].linear[to] += mass ? a[q] * b[q] / mass[q / 3] : a[q] * b[q];
    }
}

static void find_centres(const sn_net *net, const double *u, piece_sums *p) {
    memset(p->all, 0, (size_t)p->pieces * sizeof *p->all);
    for (int i = 0; i < net->nodes; i++) {
        const int k = piece_of(p, (size_t)i);
        if (k < 0) continue;
        p->all[k].mass += net->mass[i];
        for (int d = 0; d < 3; d++)
            p->all[k].centre[d] += net->mass[i] * (net->node_position[3 * i + d] + u[4 * i + d]);
    }
}

// M times rigid motion k of each piece: translations, then rotations about its centre
static void set_motion(const sn_net *net, const double *u, const piece_sums *p, int k, double *b) {
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const int at = piece_of(p, (size_t)i);
            const sn_rigid *whole = &p->all[at < 0 ? 0 : at];
            int e = (k + 1) % 3, f = (k + 2) % 3; // rotation k - 3 moves e by -r_f, f by r_e
            int along = d == e ? f : e;
            double r = net->node_position[3 * i + along] + u[4 * i + along] -
                       whole->centre[along] / whole->mass;
            double way = k < 3 ? (double)(d == k) : d == k - 3 ? 0.0 : d == e ? -r : r;
            b[3 * i + d] = at < 0 ? 0.0 : net->mass[i] * way;
        }
}

// M R at the present place, orthonormal by Gram and Schmidt, of every piece by itself; 0 where a
// piece has all its mass on an axis
static void find_rigid(const sn_net *net, const double *u, piece_sums *p, double *rigid) {
    const size_t n = (size_t)net->nodes * 3;
    find_centres(net, u, p);
    for (int k = 0; k < SN_RIGID; k++) {
        double *b = rigid + (size_t)k * n;
        set_motion(net, u, p, k, b);
        sum_pieces(net, p, b, b, net->mass, 1);
        for (int j = 0; j < k; j++) { // R_j . M R_k = (M R_j) M^-1 (M R_k)
            const double *c = rigid + (size_t)j * n;
            sum_pieces(net, p, c, b, net->mass, 0);
            for (size_t q = 0; q < n; q++) {
                const int at = piece_of(p, q / 3);
                if (at >= 0) b[q] -= p->all[at].linear[0] * c[q];
            }
        }
        sum_pieces(net, p, b, b, net->mass, 0);
        for (size_t q = 0; q < n; q++) {
            const int at = piece_of(p, q / 3);
            if (at < 0) continue;
            const double left = p->all[at].linear[0], whole = p->all[at].linear[1];
            b[q] = left > 1e-12 * whole ? b[q] / sqrt(left) : 0.0;
        }
    }
}

void sn_implicit_drag(const sn_net *net, const sn_state *s, double *rigid, double *drag) {
    const size_t n = (size_t)net->nodes * 3;
    const double *v = s->v;
    piece_sums p = {.pieces = 1};
    p.piece = sn_state_pieces(s, &p.pieces);
    p.all = p.piece ? sn_state_rigid(s) : &p.whole;
    find_rigid(net, s->u, &p, rigid);
    for (size_t q = 0; q < n; q++)
        drag[q] = piece_of(&p, q / 3) < 0 ? 0.0 : net->mass[q / 3] * v[4 * (q / 3) + q % 3];
    for (int k = 0; k < SN_RIGID; k++) {
        const double *b = rigid + (size_t)k * n;
        for (int j = 0; j < p.pieces; j++) p.all[j].linear[0] = 0;
        for (size_t q = 0; q < n; q++) {
            const int at = piece_of(&p, q / 3);
            if (at >= 0) p.all[at].linear[0] += b[q] * v[4 * (q / 3) + q % 3];
        }
        for (size_t q = 0; q < n; q++) {
            const int at = piece_of(&p, q / 3);
            if (at >= 0) drag[q] -= p.all[at].linear[0] * b[q];
        }
    }
    for (size_t q = 0; q < n; q++)
        drag[q] *= net->fixed_bits[q / 3] >> (q % 3) & 1 ? 0.0 : -net->damping;
}
