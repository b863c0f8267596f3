// Tests swept over speed: hysteresis of a triangle, dynamic moduli.
// SPDX-License-Identifier: Apache-2.0
// Source: the paper's hysteresis, loop area over the area under the loading curve; storage and loss
// modulus from the hereditary integral, equation (33), for a small oscillation.
//
// Areas. After a corner of the motion the stress changes on every time scale of the memory at once,
// so a leg is integrated over panels that double in length from a millionth of it, with
// Gauss-Legendre of order 16 on each: an exponential of any relaxation time is seen by some panel.
// The panels are cut in two until the hysteresis stands still. A Voigt memory jumps at the corner
// itself, where no node lies, and has one time; its panels start from a 32nd of the leg, because
// the rates of a compressible solid are differences that a millionth of it would drown in rounding.
//
// Moduli. About a stretch L that has been held for ever, dL = a exp(i w t) changes an elastic
// channel f by f' dL, and its hereditary integral by G*(w) f' dL, G* = G' + i G''. Uniaxial laws
// have T = H[T], so the moduli are G' T' and G'' T'. A strip of a membrane has T = L H[S11], whose
// factor moves too, on what has relaxed: E*(w) = G*(w) L S11' + G(infinity) S11. A solid moves its
// sides as well. With p the pressure, T_i = l_i H[S_ii] - p/l_i, and for small changes d
//     dT_i = d_i (Goo S_ii + p/l_i^2) + l_i G* sum_j (dS_ii/dl_j) d_j - dp/l_i,
//     dp = -kappa sum_j d_j/l_j,   kappa = G* K J^2 + Goo K (J - 1) J   (incompressible: infinite),
// with dT_2 = dT_3 = 0 three equations for the changes of the sides and of the pressure. Where the
// memory is branched, the parts of S_ii come each with their G* and Goo, and the volume with its.
#include <complex.h>
#include <math.h>
#include <stdio.h>

#include "lab/protocol/path.h"
#include "lab/protocol/protocol.h"

enum { PANELS = 21, PANELS_VISCOUS = 6, NODES = 8, CUTS = 6 };
static const double tolerance = 1e-7; // of the hysteresis, absolute
static const double two_pi = 6.28318530717958647693;

//---- hysteresis ----------------------------------------------------------------------------------

// nodes and weights over a leg of one second; returns their number
static int leg_nodes(int panels, int cuts, double *node, double *weight) {
    static const double x[NODES / 2] = {0.1834346424956498049, 0.5255324099163289858,
                                        0.7966664774136267396, 0.9602898564975362317};
    static const double w[NODES / 2] = {0.3626837833783619830, 0.3137066458778872873,
                                        0.2223810344533744705, 0.1012285362903762591};
    int count = 0;
    for (int k = 0; k < panels; ++k) {
        double low = k ? ldexp(1.0, k - panels) : 0.0, high = ldexp(1.0, k + 1 - panels);
        double half = 0.5 * (high - low) / cuts;
        for (int j = 0; j < cuts; ++j) {
            double middle = low + half * (2 * j + 1);
            for (int q = 0; q < NODES; ++q) {
                double at = q < NODES / 2 ? -x[NODES / 2 - 1 - q] : x[q - NODES / 2];
                node[count] = middle + half * at;
                weight[count++] = half * w[q < NODES / 2 ? NODES / 2 - 1 - q : q - NODES / 2];
            }
        }
    }
    return count;
}

typedef struct leg_work {
    double *node, *weight, *time, *stress;
} leg_work;

// hysteresis of one triangle of ramp time `ramp`, every panel cut into `cuts`
static sn_status hysteresis_at(const sn_tissue *tissue, double target, double ramp, int cuts,
                               leg_work *work, double *hysteresis) {
    const double knots[] = {0.0, ramp, 2.0 * ramp}, value[] = {1.0, target, 1.0};
    int panels = PANELS;
    for (int k = 0; k < SN_PARTS; ++k)
        if (sn_tissue_memory(tissue, (sn_part)k)->law->impulse) panels = PANELS_VISCOUS;
    int n = leg_nodes(panels, cuts, work->node, work->weight);
    for (int i = 0; i < n; ++i) {
        work->time[i] = ramp * work->node[i];
        work->time[n + i] = ramp * (1.0 + work->node[i]);
    }
    sn_history *stretch;
    SN_TRY(sn_history_create(1, 3, knots, value, &stretch));
    sn_status status = sn_lab_uniaxial(tissue, stretch, 2 * n, work->time, work->stress);
    sn_history_destroy(stretch);
    if (status != SN_OK) return status;
    double loading = 0.0, unloading = 0.0; // over the change of stretch
    for (int i = 0; i < n; ++i) {
        loading += work->weight[i] * work->stress[i];
        unloading += work->weight[i] * work->stress[n + i];
    }
    *hysteresis = (loading - unloading) / loading;
    if (isfinite(*hysteresis)) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "law %s: no area under the loading curve to stretch %g in %g s: hysteresis has "
                   "no value",
                   tissue->law->name, target, ramp);
}

static sn_status hysteresis_refined(const sn_tissue *tissue, double target, double ramp,
                                    leg_work *work, double *hysteresis) {
    double last, change = (double)INFINITY;
    SN_TRY(hysteresis_at(tissue, target, ramp, 1, work, hysteresis));
    for (int level = 1; level < CUTS; ++level) {
        last = *hysteresis;
        SN_TRY(hysteresis_at(tissue, target, ramp, 1 << level, work, hysteresis));
        change = fabs(*hysteresis - last);
        if (change <= tolerance) return SN_OK;
    }
    return sn_fail(SN_E_SOLVER,
                   "law %s: the hysteresis of a ramp of %g s changes by %g when its steps are "
                   "halved the last time (expected %g): use a smaller stretch",
                   tissue->law->name, ramp, change, tolerance);
}

sn_status sn_test_hysteresis(const sn_tissue *tissue, const sn_protocol *p, sn_record *record) {
    double *ramp;
    leg_work work = {NULL, NULL, NULL, NULL};
    SN_TRY(sn_tissue_check(tissue));
    SN_TRY(sn_protocol_sweep(p, &ramp));
    size_t n = (size_t)(PANELS * NODES) << (CUTS - 1); // nodes of a leg at the most
    sn_status status = SN_E_MEMORY;
    work.node = sn_alloc(6 * n, sizeof *work.node);
    if (!work.node) goto fail;
    work.weight = work.node + n;
    work.time = work.node + 2 * n;
    work.stress = work.node + 4 * n;
    if (p->stretch == 1.0) {
        status = sn_fail(SN_E_RANGE, "protocol hysteresis: stretch is 1, nothing would move: give "
                                     "another target");
        goto fail;
    }
    SN_TRY_GOTO(status, sn_record_add_series(record, "frequency", "Hz"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "hysteresis", "1"));
    for (int i = 0; i < p->points; ++i) {
        double row[] = {0.5 / ramp[i], (double)NAN};
        SN_TRY_GOTO(status, hysteresis_refined(tissue, p->stretch, ramp[i], &work, &row[1]));
        SN_TRY_GOTO(status, sn_record_append(record, row));
    }
fail:
    sn_free(work.node);
    sn_free(ramp);
    return status;
}

//---- dynamic moduli ------------------------------------------------------------------------------

// a test about a held stretch
typedef struct tangent {
    bool solid;
    double moving, held;   // dT/dstretch that goes with G*, and on what has relaxed; not of a solid
    double l[3];           // of a solid: stretches,
    int parts;             // of the distortional stress, which have
    sn_tissue part[2];     // a memory each,
    double S[2][3];        // S_ii
    double slope[2][3][3]; // and dS_ii/dl_j,
    double bulk;
} tangent;

// stretches of the sides and elastic stresses of a solid that has been held for ever
static sn_status solid_at(const sn_tissue *tissue, double L, tangent *out) {
    static const int place[3][3] = {{0, 1, 2}, {1, 6, 7}, {2, 7, 11}}; // upper triangle by rows
    sn_exponentials e[SN_PARTS];
    sn_block_row row;
    sn_moduli moduli;
    bool viscous;
    SN_TRY(sn_path_memory(tissue, e, &viscous));
    for (int k = 0; k < SN_PARTS && tissue->branched; ++k)
        if (!(e[k].g_inf > 0.0))
            return sn_fail(SN_E_UNSUPPORTED,
                           "law %s: a branch with memory %s relaxes to nothing, so a stretch held "
                           "for ever leaves its sides anywhere: a dynamic test needs branches that "
                           "keep a share",
                           tissue->law->name, sn_tissue_memory(tissue, (sn_part)k)->law->name);
    SN_TRY(sn_path_held(tissue, e, L, &row));
    double E[6] = {0}, S[6], D[21];
    for (int i = 0; i < 3; ++i) {
        out->l[i] = row.stretch[i];
        E[i] = 0.5 * (out->l[i] - 1.0) * (out->l[i] + 1.0);
    }
    out->parts = sn_tissue_split(tissue, out->part);
    for (int k = 0; k < out->parts; ++k) {
        sn_law_solid(tissue->law, out->part[k].value, tissue->terms, 1, E, NULL, S, D);
        for (int i = 0; i < 3; ++i) {
            out->S[k][i] = S[i];
            for (int j = 0; j < 3; ++j) out->slope[k][i][j] = D[place[i][j]] * out->l[j];
        }
    }
    tissue->law->moduli(tissue->value, tissue->terms, &moduli);
    out->bulk = moduli.bulk;
    out->solid = true;
    return SN_OK;
}

static sn_status tangent_at(const sn_tissue *tissue, double L, tangent *out) {
    sn_pull pull;
    *out = (tangent){.solid = false};
    SN_TRY(sn_pull_choose(tissue, &pull));
    if (pull == SN_PULL_UNIAXIAL) {
        sn_law_uniaxial(tissue->law, tissue->value, tissue->terms, 1, &L, NULL, NULL, &out->moving);
    } else if (pull == SN_PULL_STRIP) {
        double value, slope;
        SN_TRY(sn_pull_strip(tissue, 1, &L, &value, &slope));
        out->moving = L * slope;
        out->held = sn_memory_equilibrium(&tissue->memory) * value;
    } else {
        SN_TRY(solid_at(tissue, L, out));
    }
    bool usable = isfinite(out->moving) && isfinite(out->held);
    for (int k = 0; k < out->parts; ++k)
        for (int i = 0; i < 3; ++i)
            usable = usable && isfinite(out->S[k][i]) && isfinite(out->slope[k][i][i]);
    if (usable) return SN_OK;
    return sn_fail(SN_E_RANGE, "law %s overflows at stretch %g: check the constants",
                   tissue->law->name, L);
}

// what memory makes of a part of the stress in a small oscillation
typedef struct response {
    double complex moving; // G*(w)
    double held;           // G(infinity)
} response;

static response response_at(const sn_memory *memory, double frequency) {
    double storage, loss;
    sn_memory_modulus(memory, two_pi * frequency, &storage, &loss);
    return (response){storage + loss * (double complex)I, sn_memory_equilibrium(memory)};
}

// dT/dstretch of a solid, the parts of its distortional stress and its volume stress each with a
// memory of their own
static double complex solid_modulus(const tangent *t, const response *distortion, response volume) {
    const double *l = t->l;
    double J = l[0] * l[1] * l[2], held[3] = {0.0};
    double complex moving[3][3] = {{0.0}};
    for (int k = 0; k < t->parts; ++k)
        for (int i = 0; i < 3; ++i) {
            held[i] += distortion[k].held * t->S[k][i];
            for (int j = 0; j < 3; ++j) moving[i][j] += distortion[k].moving * t->slope[k][i][j];
        }
    bool free_volume = !isinf(t->bulk);
    // incompressible: the relaxed stress of the free third face is the pressure
    double p =
        free_volume ? -volume.held * sn_volume_stress(t->bulk, J) * J : l[2] * l[2] * held[2];
    double complex compliance = 0.0; // 1/kappa
    if (free_volume) compliance = 1.0 / (volume.moving * t->bulk * J * J - p);
    // rows: dT_1, dT_2, dT_3 and the volume; columns: d_1, d_2, d_3 and dp
    double complex A[4][4];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) A[i][j] = l[i] * moving[i][j];
        A[i][i] += held[i] + p / (l[i] * l[i]);
        A[i][3] = -1.0 / l[i];
        A[3][i] = 1.0 / l[i];
    }
    A[3][3] = compliance;
    for (int k = 3; k > 0; --k) { // eliminates dp, d_3, d_2; a pivot of 0 is swapped away
        int best = k;
        for (int i = 1; i < k; ++i)
            if (cabs(A[i][k]) > cabs(A[best][k])) best = i;
        for (int j = 0; j < 4; ++j) {
            double complex swap = A[k][j];
            A[k][j] = A[best][j], A[best][j] = swap;
        }
        for (int i = 0; i < k; ++i) {
            double complex f = A[i][k] / A[k][k];
            for (int j = 0; j < k; ++j) A[i][j] -= f * A[k][j];
        }
    }
    return A[0][0];
}

sn_status sn_dynamic_moduli(const sn_tissue *tissue, double stretch, int n, const double *frequency,
                            double *storage, double *loss) {
    tangent t;
    SN_TRY(tangent_at(tissue, stretch, &t));
    for (int i = 0; i < n; ++i) {
        response g[2] = {response_at(&tissue->memory, frequency[i])}; // of all that is no solid
        double complex modulus = g[0].moving * t.moving + t.held;
        for (int k = 0; k < t.parts; ++k) g[k] = response_at(&t.part[k].memory, frequency[i]);
        if (t.solid)
            modulus = solid_modulus(
                &t, g, response_at(sn_tissue_memory(tissue, SN_PART_VOLUMETRIC), frequency[i]));
        storage[i] = creal(modulus);
        loss[i] = cimag(modulus);
    }
    return SN_OK;
}

sn_status sn_test_dynamic(const sn_tissue *tissue, const sn_protocol *p, sn_record *record) {
    double *frequency, *storage = NULL;
    char text[SN_NAME_MAX];
    SN_TRY(sn_protocol_sweep(p, &frequency));
    size_t n = (size_t)p->points;
    sn_status status = SN_E_MEMORY;
    storage = sn_alloc(2 * n, sizeof *storage);
    if (!storage) goto fail;
    double *loss = storage + n;
    SN_TRY_GOTO(status, sn_tissue_check(tissue));
    SN_TRY_GOTO(status, sn_dynamic_moduli(tissue, p->stretch, p->points, frequency, storage, loss));
    SN_TRY_GOTO(status, sn_record_add_series(record, "frequency", "Hz"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "storage_modulus", "Pa"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "loss_modulus", "Pa"));
    snprintf(text, sizeof text, "%.15g", p->stretch);
    SN_TRY_GOTO(status, sn_record_add_note(record, "mean_stretch", text, p->stretch));
    for (int i = 0; i < p->points; ++i)
        SN_TRY_GOTO(status,
                    sn_record_append(record, (double[]){frequency[i], storage[i], loss[i]}));
fail:
    sn_free(storage);
    sn_free(frequency);
    return status;
}
