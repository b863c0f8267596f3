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
// have T = H[T], so the moduli are G' T' and G'' T'. Incompressible solids have T = L H[S11] -
// H[S22]/L^2, whose factors move too, on what has relaxed:
//     E*(w) = G*(w) (L S11' - S22'/L^2) + G(infinity) (S11 + 2 S22/L^3).
#include <math.h>

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

// dT/dstretch about a held stretch: the part that goes with G* and the part on what has relaxed
typedef struct tangent {
    double moving, held;
} tangent;

static sn_status tangent_at(const sn_tissue *tissue, sn_pull pull, double L, tangent *out) {
    *out = (tangent){0.0, 0.0};
    if (pull == SN_PULL_LATERAL)
        return sn_fail(SN_E_UNSUPPORTED,
                       "law %s: a dynamic test needs a uniaxial law, or an incompressible solid "
                       "that is alike across the pull (bulk_modulus: incompressible)",
                       tissue->law->name);
    if (pull == SN_PULL_UNIAXIAL) {
        sn_law_uniaxial(tissue->law, tissue->value, tissue->terms, 1, &L, NULL, NULL, &out->moving);
    } else {
        double value[2], slope[2];
        SN_TRY(sn_pull_closed(tissue, 1, &L, value, slope));
        out->moving = L * slope[0] - slope[1] / (L * L);
        out->held =
            sn_memory_equilibrium(&tissue->memory) * (value[0] + 2.0 * value[1] / (L * L * L));
    }
    if (isfinite(out->moving) && isfinite(out->held)) return SN_OK;
    return sn_fail(SN_E_RANGE, "law %s overflows at stretch %g: check the constants",
                   tissue->law->name, L);
}

sn_status sn_test_dynamic(const sn_tissue *tissue, const sn_protocol *p, sn_record *record) {
    tangent slope[2];
    sn_tissue part[2]; // each with its memory
    sn_pull pull;
    double *frequency;
    SN_TRY(sn_protocol_sweep(p, &frequency));
    sn_status status;
    SN_TRY_GOTO(status, sn_tissue_check(tissue));
    SN_TRY_GOTO(status, sn_pull_choose(tissue, &pull));
    int parts = sn_tissue_split(tissue, part);
    for (int k = 0; k < parts; ++k)
        SN_TRY_GOTO(status, tangent_at(&part[k], pull, p->stretch, &slope[k]));
    SN_TRY_GOTO(status, sn_record_add_series(record, "frequency", "Hz"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "storage_modulus", "Pa"));
    SN_TRY_GOTO(status, sn_record_add_series(record, "loss_modulus", "Pa"));
    for (int i = 0; i < p->points; ++i) {
        double storage, loss, row[] = {frequency[i], 0.0, 0.0};
        for (int k = 0; k < parts; ++k) {
            sn_memory_modulus(&part[k].memory, two_pi * frequency[i], &storage, &loss);
            row[1] += storage * slope[k].moving + slope[k].held;
            row[2] += loss * slope[k].moving;
        }
        SN_TRY_GOTO(status, sn_record_append(record, row));
    }
fail:
    sn_free(frequency);
    return status;
}
