// How far a case strains its body.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/calibrate.h"
#include "sinew/springs.h"

enum { FRAMES = 10 }; // of the run
static const double unknown = 0.3, least = 0.02, most = 1.0, part = 0.95, smallest = 0.02;

/// Strain of a cell, and its volume.
typedef struct strained {
    double strain, volume;
} strained;

typedef struct watch {
    const sn_mesh *mesh;
    strained *cell;
    double largest;
    double share[SN_CALIBRATION_KINDS]; ///< squares of strains, by kind
} watch;

static int compare_strains(const void *a, const void *b) {
    const strained *p = a, *q = b;
    return (p->strain > q->strain) - (p->strain < q->strain);
}

// |stretch - 1| of a stretch at constant volume with the same norm of the Green strain. Adds to the
// shares by the third invariant: 1 for a stretch, 0 for shear, -1 for compression.
static double strain_of(const double E[6], double volume, double *share) {
    const double mean = (E[0] + E[1] + E[2]) / 3;
    const double a = E[0] - mean, b = E[1] - mean, c = E[2] - mean, p = E[3], q = E[4], r = E[5];
    const double sum = a * a + b * b + c * c + 2 * (p * p + q * q + r * r);
    const double third = a * (b * c - q * q) - p * (p * c - q * r) + r * (p * q - b * r);
    const double kind = sum > 0 ? 3 * sqrt(6.0) * third / (sum * sqrt(sum)) : 0;
    share[0] += volume * sum * fmax(kind, 0.0);
    share[1] += volume * sum * fmax(-kind, 0.0);
    share[2] += volume * sum * fmax(1 - fabs(kind), 0.0);
    return sqrt(1 + 2 * sqrt(2.0 / 3.0 * sum)) - 1;
}

static sn_status see_frame(void *context, const sn_frame *frame) {
    watch *w = context;
    double volume = 0;
    for (int k = 0; k < frame->field_count; k++) {
        if (strcmp(frame->fields[k].name, "green_strain") != 0) continue;
        for (int e = 0; e < w->mesh->cell_count; e++) {
            const double *E = frame->fields[k].value + 6 * (size_t)e;
            const double V = sn_mesh_cell_volume(w->mesh, e);
            w->cell[e] = (strained){strain_of(E, V, w->share), V};
            volume += V;
        }
    }
    qsort(w->cell, (size_t)w->mesh->cell_count, sizeof *w->cell, compare_strains);
    double below = 0;
    for (int e = 0; e < w->mesh->cell_count && below <= part * volume; e++) {
        below += w->cell[e].volume;
        if (below > part * volume) w->largest = fmax(w->largest, w->cell[e].strain);
    }
    return SN_OK;
}

sn_status sn_calibration_strain(const sn_case *c, double *strain,
                                double share[SN_CALIBRATION_KINDS]) {
    *strain = unknown;
    if (c->load_count + c->tool_count == 0) return SN_OK;
    sn_case quick = *c; // everything is borrowed
    quick.springs_given = NULL;
    quick.springs.rung = SN_RUNG_CENTRAL;
    for (int r = 0; r < c->mesh->region_count; r++) // of which the net's own rule has no springs
        if (sn_calibration_oriented(&c->tissue[r])) quick.springs.rung = SN_RUNG_COUPLED;
    quick.springs.volume = true;
    quick.springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    if (c->springs.integrator != SN_INTEGRATOR_QUASI_STATIC) quick.springs.step = 0;
    quick.output_every = fmax(c->output_every, c->until / FRAMES);
    watch w = {.mesh = c->mesh, .cell = sn_alloc((size_t)c->mesh->cell_count, sizeof *w.cell)};
    sn_record *history = NULL;
    sn_run_summary summary = {.converged = false};
    sn_status status = w.cell ? sn_record_create("quick", &history) : SN_E_MEMORY;
    if (status == SN_OK) {
        const sn_output output = {.context = &w, .frame = see_frame};
        status = sn_springs_run(&quick, &output, &summary, history);
        if (status == SN_OK && summary.converged) {
            *strain = fmin(fmax(w.largest, least), most);
            const double all = w.share[0] + w.share[1] + w.share[2];
            for (int k = 0; k < SN_CALIBRATION_KINDS && all > 0; k++)
                share[k] = fmax(w.share[k] / all, smallest);
        }
        if (status != SN_E_MEMORY) status = SN_OK; // a case that cannot be run so is no error here
    }
    sn_record_destroy(history);
    sn_free(w.cell);
    return status;
}
