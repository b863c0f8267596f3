// What the memory of a net has stored.
// SPDX-License-Identifier: Apache-2.0
//
// A branch of modulus g holds the stress H; q = H/g obeys q' = T' - q/tau. It is a spring of the
// instantaneous law, scaled by g, between the strain e and a strain e_v that creeps after it, whose
// stress is T(e_v) = T - q. It has stored
//     R = g (W(e) - W(e_v) - T(e_v) (e - e_v)),
// with R' = H e' - g q/tau (e - e_v): the work done on the branch less a loss that is never below
// zero where T rises with e. Linear: R = H^2 / (2 g k). Springs and volume stresses are taken so,
// without approximation; six components of a cell (or a smoothed edge) by the linear form with the
// tangent D of the law (and of a volume term) at the present strain, R = g/2 q . D^-1 q. Fibres
// with a memory of their own resist only along themselves, and not at all while slack, so that
// their D has no inverse: they take that of matrix and fibres together, which is less than theirs
// would be where they are soft. A viscous part stores nothing.
#include <math.h>

#include "springs/forces.h"
#include "springs/moment.h"
#include "springs/parts.h"

//---- springs -------------------------------------------------------------------------------------

static double of_springs(const sn_net *net, const sn_net_region *region, const sn_moment *m) {
    const sn_recalled b = sn_recall(net, region, m, SN_STORE_SPRING);
    const double *stiffness = sn_parts_stiffness(net, m->parts, SN_DOUBLE);
    const double *inverse = net->data[SN_DOUBLE].inverse;
    double sum = 0;
    for (size_t n = 0; n < (size_t)region->spring_blocks * SN_BLOCK; n++) {
        const size_t slot = (size_t)region->spring_block * SN_BLOCK + n;
        const size_t block = n / SN_BLOCK, lane = n % SN_BLOCK;
        if (!(stiffness[slot] > 0)) continue;
        const sn_spring_law law = sn_net_spring_law(net, region, (int)slot);
        const double T = sn_recalled_at(&b, block, 0, lane), lambda = sn_spring_stretch(&law, T);
        const double now = sn_spring_potential(&law, lambda);
        for (int k = 0; k < b.memory->terms; k++) {
            const double g = b.memory->g[k];
            const double t = T - sn_recalled_at(&b, block, (size_t)k + 1, lane) / g;
            const double v = sn_spring_stretch(&law, t);
            double held = now - sn_spring_potential(&law, v) - t * (lambda - v);
            sum += g * stiffness[slot] / inverse[slot] * fmax(held, 0.0); // rounding
        }
    }
    return sum;
}

//---- volume points and cells ---------------------------------------------------------------------

static double of_points(const sn_net *net, const sn_net_region *region, const sn_moment *m) {
    const sn_recalled b = sn_recall(net, region, m, SN_STORE_POINT);
    const double *volume = sn_parts_point_volume(net, m->parts);
    double sum = 0;
    for (size_t n = 0; region->bulk > 0 && n < (size_t)region->point_blocks * SN_BLOCK; n++) {
        const double V = volume[(size_t)region->point_block * SN_BLOCK + n];
        for (int k = 0; k < b.memory->terms; k++) {
            double H = sn_recalled_at(&b, n / SN_BLOCK, (size_t)k + 1, n % SN_BLOCK);
            sum += V * H * H / (2.0 * b.memory->g[k] * region->bulk);
        }
    }
    return sum;
}

// q . (D + bulk 1 1)^-1 q by conjugate gradients. D of the law alone resists no change of volume,
// and of q only rounding and squares of strains want one: bulk keeps them small
static double compliance(const double D[21], double bulk, const double q[6]) {
    double x[6] = {0}, r[6], p[6], rr = 0, sum = 0;
    for (int i = 0; i < 6; i++) {
        r[i] = p[i] = q[i];
        rr += q[i] * q[i];
    }
    const double least = 1e-20 * rr;
    for (int turn = 0; turn < 12 && rr > least; turn++) {
        double y[6] = {0}, py = 0, next = 0;
        for (int i = 0, k = 0; i < 6; i++)
            for (int j = i; j < 6; j++, k++) {
                y[i] += D[k] * p[j];
                if (j > i) y[j] += D[k] * p[i];
            }
        for (int i = 0; i < 3; i++) y[i] += bulk * (p[0] + p[1] + p[2]);
        for (int i = 0; i < 6; i++) py += p[i] * y[i];
        if (!(py > 0)) break;
        for (int i = 0; i < 6; i++) {
            x[i] += rr / py * p[i];
            r[i] -= rr / py * y[i];
            next += r[i] * r[i];
        }
        for (int i = 0; i < 6; i++) p[i] = r[i] + next / rr * p[i];
        rr = next;
    }
    for (int i = 0; i < 6; i++) sum += q[i] * x[i];
    return fmax(sum, 0.0);
}

// what one branch of six components holds per volume, over g/2
static double twice_held(const sn_net_region *region, const sn_recalled *b, const double D[21],
                         int k, size_t n) {
    const double g = b->memory->g[k];
    double q[6];
    for (size_t c = 0; c < 6; c++)
        q[c] = sn_recalled_at(b, n / SN_BLOCK, (size_t)k + 1, c * SN_BLOCK + n % SN_BLOCK) / g;
    return compliance(D, region->bulk + region->shear, q);
}

// number i of a place
static double twice_held_volume(const sn_net_region *region, const sn_recalled *b, int k, size_t n,
                                size_t i) {
    double p = sn_recalled_at(b, n / SN_BLOCK, (size_t)k + 1, i * SN_BLOCK + n % SN_BLOCK) /
               b->memory->g[k];
    return region->bulk > 0 ? p * p / region->bulk : 0.0;
}

// D of the matrix, then of matrix and fibres
static void tangents(const sn_net *net, const sn_net_region *region, int slot, const double E[6],
                     double D[2][21]) {
    double S[6], fibres[21];
    for (int k = 0; k < region->splits; k++) {
        sn_net_law(net, &region->split[k], slot, 1, E, NULL, S, k ? fibres : D[0]);
    }
    for (int i = 0; i < 21 && region->splits > 1; i++) D[1][i] = D[0][i] + fibres[i];
}

static double of_cells(const sn_net *net, const sn_net_region *region, const sn_moment *m) {
    static const int kind[2] = {SN_STORE_CELL, SN_STORE_FIBRE};
    const sn_recalled volume = sn_recall(net, region, m, SN_STORE_BULK);
    const int first = sn_net_first_split(net);
    sn_recalled b[2];
    double sum = 0;
    for (int k = first; k < region->splits; k++) b[k] = sn_recall(net, region, m, kind[k]);
    for (size_t n = 0; n < (size_t)sn_region_law_blocks(net, region) * SN_BLOCK; n++) {
        const size_t slot = (size_t)sn_region_law_block(net, region) * SN_BLOCK + n;
        double E[6], D[2][21];
        const double V = sn_net_law_strain(net, m, (int)slot, E);
        if (!(V > 0)) continue;
        tangents(net, region, (int)slot, E, D);
        for (int k = first; k < region->splits; k++)
            for (int j = 0; j < b[k].memory->terms; j++) {
                double twice = twice_held(region, &b[k], D[k], j, n);
                if (b[k].count == 7 * SN_BLOCK) twice += twice_held_volume(region, &b[k], j, n, 6);
                sum += 0.5 * b[k].memory->g[j] * V * twice;
            }
        if (!region->tissue.branched || net->volume_mode != SN_VOLUME_CELL) continue;
        for (int j = 0; j < volume.memory->terms; j++)
            sum += 0.5 * volume.memory->g[j] * V * twice_held_volume(region, &volume, j, n, 0);
    }
    return sum;
}

double sn_net_memory_energy(const sn_net *net, const sn_moment *m) {
    double sum = 0;
    for (int r = 0; r < net->region_count; r++) {
        const sn_net_region *region = &net->region[r];
        if (!region->tissue.branched && region->memory.terms == 0) continue;
        if (net->rung == SN_RUNG_CENTRAL) sum += of_springs(net, region, m);
        sum += of_cells(net, region, m);
        if (net->volume) sum += of_points(net, region, m);
    }
    return sum;
}
