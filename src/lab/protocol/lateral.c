// Hereditary stress of a block of a solid, some of whose stretches must be solved for.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); a face is held at a stretch or loaded with a stress.
//
// Nominal stress on the face across axis i, H the hereditary integral, l the stretches.
// Compressible, unknown is every stretch that is not held:
//     T_i = l_i H[S_ii] + H[K (J - 1)] J/l_i.
// Incompressible, l3 = 1/(l1 l2), the third face always free of load:
//     T_i = l_i H[S_ii] - p/l_i,  p = l3^2 H[S_33]
// (pulled along one axis the sides of an orthotropic law differ, and that both give the same p is
// the condition for l2). Where the memory is branched, the H of each kind of channel is its own;
// and where fibres have another memory than the matrix, S_ii is a sum of two channels.
//
// The recursion for a step is affine in the new stress, H[S] = a S_new + b, so a trial of the
// stretches costs one evaluation of the law and touches no memory variable. Newton on the
// logarithms of the stretches with differences for the matrix: they need no tangent of the volume
// term and all points go to the law in one call. Steps are of second order; the callers refine.
#include <math.h>
#include <string.h>

#include "lab/protocol/block.h"

enum {
    VOLUME = SN_BLOCK_VOLUME,
    FIBRES = SN_BLOCK_FIBRES,
    CHANNELS = SN_BLOCK_CHANNELS,
    TRIALS = 4
};
static const int newton_max = 100;
static const double difference = 1e-6; // of a logarithm: balances rounding against curvature

// which of the memories acts on a channel
static int memory_of(const sn_block *p, int channel) {
    if (p->memories == 1 || channel < VOLUME) return SN_PART_DEVIATORIC;
    return channel == VOLUME ? SN_PART_VOLUMETRIC : SN_PART_FIBRE;
}

static void stretches_of(const sn_block *p, sn_block_trial *t) {
    for (int i = 0; i < 3; ++i) t->stretch[i] = p->faces->held[i] ? p->target[i] : exp(t->y[i]);
    if (isinf(p->bulk)) t->stretch[2] = 1.0 / (t->stretch[0] * t->stretch[1]);
}

// elastic channels, total stresses and residuals at n trials
static void evaluate(const sn_block *p, int n, sn_block_trial *t) {
    double E[6 * TRIALS] = {0}, S[2][6 * TRIALS];
    SN_ASSERT(n <= TRIALS);
    for (int i = 0; i < n; ++i) {
        stretches_of(p, &t[i]);
        for (int c = 0; c < 3; ++c) {
            double l = t[i].stretch[c];
            E[c * n + i] = 0.5 * (l - 1.0) * (l + 1.0);
        }
    }
    for (int k = 0; k < p->parts; ++k)
        sn_law_solid(p->tissue->law, p->part[k].value, p->tissue->terms, n, E, NULL, S[k], NULL);
    for (int i = 0; i < n; ++i) {
        const double *l = t[i].stretch;
        double J = l[0] * l[1] * l[2], total[CHANNELS] = {0.0};
        for (int k = 0; k < p->parts; ++k)
            for (int c = 0; c < 3; ++c) t[i].value[(k ? FIBRES : 0) + c] = S[k][c * n + i];
        // U'(J) = K (J - 1) from the logarithm of J: J - 1 itself drowns the rates of stiff solids
        double log_volume = t[i].y[0] + t[i].y[1] + t[i].y[2];
        t[i].value[VOLUME] = isinf(p->bulk) ? 0.0 : p->bulk * expm1(log_volume);
        for (int c = 0; c < p->channels; ++c) total[c] = p->a[c] * t[i].value[c] + p->b[c];
        for (int c = FIBRES; c < p->channels; ++c) total[c - FIBRES] += total[c];
        double pressure = isinf(p->bulk) ? l[2] * l[2] * total[2] : -total[VOLUME] * J;
        for (int c = 0; c < 3; ++c) t[i].nominal[c] = l[c] * total[c] - pressure / l[c];
        for (int j = 0; j < p->unknowns; ++j) {
            int c = p->unknown[j];
            t[i].residual[j] = l[c] * (t[i].nominal[c] - p->target[c]);
        }
    }
}

void sn_solve_small(int n, double A[3][3], const double *r, double *x) {
    for (int i = 0; i < n; ++i) x[i] = -r[i];
    for (int k = 0; k < n; ++k) {
        int best = k;
        for (int i = k + 1; i < n; ++i)
            if (fabs(A[i][k]) > fabs(A[best][k])) best = i;
        double swap = x[k];
        x[k] = x[best], x[best] = swap;
        for (int j = 0; j < n; ++j) swap = A[k][j], A[k][j] = A[best][j], A[best][j] = swap;
        for (int i = k + 1; i < n; ++i) {
            double f = A[i][k] / A[k][k];
            for (int j = k; j < n; ++j) A[i][j] -= f * A[k][j];
            x[i] -= f * x[k];
        }
    }
    for (int k = n - 1; k >= 0; --k) {
        for (int j = k + 1; j < n; ++j) x[k] -= A[k][j] * x[j];
        x[k] /= A[k][k];
    }
}

// Newton's change of the unknowns from a trial and those at a difference in each unknown; its
// largest, not finite where there is none
static double newton_change(int n, const sn_block_trial *t, double change[3]) {
    double A[3][3];
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            A[i][j] = (t[j + 1].residual[i] - t[0].residual[i]) / difference;
    sn_solve_small(n, A, t[0].residual, change);
    double size = 0.0, limit = 0.1; // a tenth of the stretch a go: the law stays in its domain
    for (int i = 0; i < n; ++i)
        size = isfinite(change[i]) ? fmax(size, fabs(change[i])) : (double)INFINITY;
    for (int i = 0; i < n && size > limit; ++i) change[i] *= limit / size;
    return size;
}

static sn_status no_equilibrium(const sn_block *p) {
    for (int i = 0; i < 3; ++i)
        if (!p->faces->held[i] && p->target[i] != 0.0)
            return sn_fail(SN_E_SOLVER,
                           "law %s: at %g s no stretch near %g carries a nominal stress of %g Pa: "
                           "the specimen gives way; use a smaller stress or a shorter test",
                           p->tissue->law->name, p->time, exp(p->y[i]), p->target[i]);
    return sn_fail(SN_E_SOLVER,
                   "law %s: the free sides at stretch %g, %g s have no equilibrium near lateral "
                   "stretch %g: check the constants",
                   p->tissue->law->name, p->target[0], p->time, exp(p->y[p->unknown[0]]));
}

// solves for the unknown stretches; *now is the equilibrium
static sn_status solve(sn_block *p, sn_block_trial *now) {
    sn_block_trial t[TRIALS];
    double change[3];
    int n = p->unknowns;
    memcpy(t[0].y, p->y, sizeof p->y);
    for (int iteration = 0; iteration < newton_max; ++iteration) {
        for (int j = 0; j < n; ++j) {
            memcpy(t[j + 1].y, t[0].y, sizeof t[0].y);
            t[j + 1].y[p->unknown[j]] += difference;
        }
        evaluate(p, n + 1, t);
        double size = newton_change(n, t, change);
        if (!isfinite(size)) break;
        for (int j = 0; j < n; ++j) t[0].y[p->unknown[j]] += change[j];
        if (size > 1e-11) continue; // the matrix is good to 1e-6: what remains is 1e-17
        evaluate(p, 1, t);
        for (int i = 0; i < 3; ++i) p->y[i] = log(t[0].stretch[i]);
        *now = t[0];
        return SN_OK;
    }
    return no_equilibrium(p);
}

// Where the faces are at the driving number u. What is held moves the first guess of the others, at
// constant volume.
static void drive(sn_block *p, double u) {
    double moved = 0.0;
    int held = 0;
    for (int i = 0; i < 3; ++i) {
        p->target[i] = p->faces->at[i] + p->faces->per[i] * u;
        if (!p->faces->held[i]) continue;
        double y = log(p->target[i]);
        moved += y - p->y[i];
        p->y[i] = y;
        ++held;
    }
    for (int i = 0; i < 3 && held > 0; ++i)
        if (!p->faces->held[i]) p->y[i] -= moved / (3 - held);
}

static void keep(const sn_block_trial *t, sn_block_row *row) {
    memcpy(row->stretch, t->stretch, sizeof row->stretch);
    memcpy(row->stress, t->nominal, sizeof row->stress);
}

sn_status sn_block_start(sn_block *p, const sn_path *path, sn_block_row *row) {
    sn_block_trial now;
    bool viscous = false;
    for (int m = 0; m < p->memories; ++m) viscous = viscous || p->e[m].viscous > 0.0;
    p->time = path->time[0];
    drive(p, path->stretch[0]);
    for (int i = 0; i < 3 && viscous; ++i) // a dashpot holds against a jump of the load
        if (!p->faces->held[i]) p->target[i] = 0.0;
    for (int c = 0; c < p->channels; ++c) p->a[c] = 1.0; // a step from rest: G(0) = 1
    SN_TRY(solve(p, &now));
    for (int c = 0; c < p->channels; ++c) {
        const sn_exponentials *e = &p->e[memory_of(p, c)];
        p->value[c] = now.value[c];
        for (int i = 0; i < e->terms; ++i) p->H[c][i] = e->g[i] * now.value[c];
    }
    if (p->slopes) sn_block_slopes_start(p, &now);
    keep(&now, row);
    return SN_OK;
}

static sn_status step(sn_block *p, double time, double u, sn_block_row *row) {
    double decay[SN_PARTS][SN_TERMS_MAX], gain[SN_PARTS][SN_TERMS_MAX], h = time - p->time;
    sn_block_trial now;
    for (int m = 0; m < p->memories; ++m) sn_exponentials_factors(&p->e[m], h, decay[m], gain[m]);
    for (int c = 0; c < p->channels; ++c) {
        int m = memory_of(p, c);
        const double *d = decay[m], *g = gain[m];
        double viscous = p->e[m].viscous / h;
        p->a[c] = p->e[m].g_inf + viscous;
        p->b[c] = -viscous * p->value[c];
        for (int i = 0; i < p->e[m].terms; ++i) {
            p->a[c] += g[i];
            p->b[c] += d[i] * p->H[c][i] - g[i] * p->value[c];
        }
    }
    p->time = time;
    drive(p, u);
    SN_TRY(solve(p, &now));
    if (p->slopes) sn_block_slopes_step(p, h, decay[0], gain[0], &now);
    for (int c = 0; c < p->channels; ++c) {
        int m = memory_of(p, c);
        double change = now.value[c] - p->value[c];
        for (int i = 0; i < p->e[m].terms; ++i)
            p->H[c][i] = decay[m][i] * p->H[c][i] + gain[m][i] * change;
        p->value[c] = now.value[c];
    }
    keep(&now, row);
    return SN_OK;
}

// Parts of the interval after instant k, and how they are graded: part j of n ends at the fraction
// (exp(alpha j/n) - 1)/(exp(alpha) - 1) of it. A hold after a fast ramp wants its steps early, and
// a smooth grading keeps the even expansion of the error.
static int parts_of(const sn_path *path, int k, int level, double *alpha) {
    double change = fabs(path->stretch[k + 1] - path->stretch[k]);
    double duration = path->time[k + 1] - path->time[k];
    double before = k > 0 ? path->time[k] - path->time[k - 1] : duration;
    *alpha = log1p(duration / before) - log(2.0);
    if (!(*alpha > 0.1)) *alpha = 0.0;
    double parts = path->range > 0.0 ? ceil(12.0 * change / path->range) : 1.0;
    return level * (int)fmax(1.0 + ceil(*alpha), parts);
}

sn_status sn_block_cross(sn_block *p, const sn_path *path, int k, int level, sn_block_row *row) {
    double alpha, t0 = path->time[k], u0 = path->stretch[k];
    int parts = parts_of(path, k, level, &alpha);
    for (int j = 1; j <= parts; ++j) {
        double part = (double)j / parts;
        double u = alpha > 0.0 ? expm1(alpha * part) / expm1(alpha) : part;
        if (j == parts) u = 1.0;
        double t = j == parts ? path->time[k + 1] : t0 + u * (path->time[k + 1] - t0);
        SN_TRY(step(p, t, u0 + u * (path->stretch[k + 1] - u0), row));
    }
    return SN_OK;
}

sn_block sn_block_of(const sn_tissue *tissue, const sn_faces *faces, const sn_exponentials *e) {
    sn_moduli moduli;
    tissue->law->moduli(tissue->value, tissue->terms, &moduli);
    sn_block p = {.tissue = tissue, .faces = faces, .e = e, .bulk = moduli.bulk};
    for (int i = 0; i < (isinf(moduli.bulk) ? 2 : 3); ++i)
        if (!faces->held[i]) p.unknown[p.unknowns++] = i;
    p.parts = sn_tissue_split(tissue, p.part);
    p.channels = p.parts > 1 ? CHANNELS : FIBRES;
    p.memories = tissue->branched ? SN_PARTS : 1;
    return p;
}

sn_status sn_path_block(const sn_path *path, const sn_tissue *tissue, const sn_faces *faces,
                        const sn_exponentials *e, int level, sn_block_row *row) {
    sn_block p = sn_block_of(tissue, faces, e);
    SN_TRY(sn_block_start(&p, path, &row[0]));
    for (int k = 0; k + 1 < path->count; ++k)
        SN_TRY(sn_block_cross(&p, path, k, level, &row[k + 1]));
    return SN_OK;
}

sn_status sn_path_held(const sn_tissue *tissue, const sn_exponentials *e, double stretch,
                       sn_block_row *row) {
    sn_block p = sn_block_of(tissue, &sn_faces_pulled, e);
    sn_block_trial now;
    for (int c = 0; c < p.channels; ++c) p.a[c] = p.memories > 1 ? e[memory_of(&p, c)].g_inf : 1.0;
    drive(&p, stretch);
    SN_TRY(solve(&p, &now));
    keep(&now, row);
    return SN_OK;
}

const sn_faces sn_faces_pulled = {.held = {true, false, false}, .per = {1.0, 0.0, 0.0}};

sn_status sn_path_stress_lateral(const sn_path *path, const sn_tissue *tissue,
                                 const sn_exponentials *e, int level, double *stress) {
    sn_block_row *row = sn_alloc((size_t)path->count, sizeof *row);
    if (!row) return SN_E_MEMORY;
    sn_status status = sn_path_block(path, tissue, &sn_faces_pulled, e, level, row);
    for (int r = 0; status == SN_OK && r < path->records; ++r)
        stress[r] = path->record[r] < 0 ? 0.0 : row[path->record[r]].stress[0];
    sn_free(row);
    return status;
}
