// Virtual tests of calibrated springs, region by region, and the scale that follows from them.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compare/calibrate.h"
#include "sinew/springs.h"

enum { ALL = 0x1fff, PRESSURE = 6 }; // all tests; the one that springs have no part in

//---- one region as a body ------------------------------------------------------------------------

// nodes of a region: number in it of each node of the mesh, -1 elsewhere; returns how many
static int number_nodes(const sn_mesh *mesh, int region, int *number) {
    int count = 0;
    for (int i = 0; i < mesh->node_count; i++) number[i] = -1;
    for (int k = 0; k < 4 * mesh->cell_count; k++)
        if (mesh->region[k / 4] == region) number[mesh->cell[k]] = 0;
    for (int i = 0; i < mesh->node_count; i++)
        if (number[i] == 0) number[i] = count++;
    return count;
}

static sn_status extract_mesh(const sn_mesh *mesh, int region, int *number, sn_mesh **out) {
    const int nodes = number_nodes(mesh, region, number);
    int cells = 0;
    for (int e = 0; e < mesh->cell_count; e++) cells += mesh->region[e] == region;
    SN_TRY(sn_mesh_create(nodes, cells, 1, 0, out));
    sn_mesh *m = *out;
    snprintf(m->region_name[0], SN_NAME_MAX, "%s", mesh->region_name[region]);
    for (int i = 0; i < mesh->node_count; i++)
        for (int d = 0; d < 3 && number[i] >= 0; d++)
            m->node[3 * number[i] + d] = mesh->node[3 * i + d];
    for (int e = 0, n = 0; e < mesh->cell_count; e++)
        for (int a = 0; a < 4 && mesh->region[e] == region; a++)
            m->cell[n++] = number[mesh->cell[4 * e + a]];
    sn_status status = sn_mesh_finish(m);
    if (status != SN_OK) {
        sn_mesh_destroy(m);
        *out = NULL;
    }
    return status;
}

sn_status sn_calibration_body_open(const sn_case *c, int region, sn_calibration_body *body) {
    *body = (sn_calibration_body){.region = region};
    sn_mesh *mesh = NULL;
    sn_status status;
    body->number = sn_alloc((size_t)c->mesh->node_count, sizeof *body->number);
    if (!body->number) return SN_E_MEMORY;
    SN_TRY_GOTO(status, extract_mesh(c->mesh, region, body->number, &mesh));
    sn_case part = {.mesh = mesh, .tissue = &c->tissue[region], .shape = c->shape};
    part.has_shape = c->has_shape && c->mesh->region_count == 1;
    memcpy(part.fibre, c->fibre, sizeof part.fibre);
    part.fibres = c->fibres;
    status = sn_calibration_case(&part, &body->c);
fail:
    sn_mesh_destroy(mesh);
    if (status != SN_OK) sn_calibration_body_close(body);
    return status;
}

void sn_calibration_body_close(sn_calibration_body *body) {
    sn_case_destroy(body->c);
    sn_free(body->number);
    *body = (sn_calibration_body){0};
}

sn_status sn_calibration_body_take(sn_calibration_body *body, const sn_spring_set *set) {
    int count = 0;
    sn_spring_set_destroy(body->c->springs_given);
    body->c->springs_given = NULL;
    for (int k = 0; k < set->count; k++) count += set->region[k] == body->region;
    SN_TRY(sn_spring_set_create(count, 1, &body->c->springs_given));
    sn_spring_set *to = body->c->springs_given;
    to->exponent[0] = set->exponent[body->region];
    memcpy(to->square, set->square + SN_SPRING_SQUARES * body->region,
           SN_SPRING_SQUARES * sizeof *to->square);
    to->bulk[0] = set->bulk[body->region];
    for (int k = 0, n = 0; k < set->count; k++) {
        if (set->region[k] != body->region) continue;
        for (int e = 0; e < 2; e++) to->end[2 * n + e] = body->number[set->end[2 * k + e]];
        to->stiffness[n++] = set->stiffness[k];
    }
    return SN_OK;
}

//---- tests ---------------------------------------------------------------------------------------

static sn_status test(const sn_case *c, bool held, unsigned tests, double error[SN_RESPONSES]) {
    sn_net *net;
    SN_TRY(sn_net_create(c, &net));
    sn_status status = sn_net_responses(net, held, tests, error);
    sn_net_destroy(net);
    return status;
}

// The tissue at small strain, no nearer to incompressible than Poisson's ratio 0.45: held bending
// of a net that must keep its volume at every node says more about that than about its springs.
static sn_status milder(const sn_tissue *tissue, sn_tissue *out) {
    sn_moduli moduli;
    sn_tissue_moduli(tissue, &moduli);
    *out = *tissue;
    if (!sn_calibration_oriented(tissue)) {
        out->law = sn_law_find("neo-hookean");
        out->terms = 0;
        SN_TRY(sn_tissue_set(out, "shear_modulus", moduli.shear));
    }
    return sn_tissue_set(out, "bulk_modulus", fmin(moduli.bulk, 29.0 / 3.0 * moduli.shear));
}

sn_status sn_calibration_scale(sn_calibration_body *body, double *scale) {
    sn_case c = *body->c; // everything but the tissue is borrowed
    sn_tissue tissue;
    *scale = 1;
    SN_TRY(milder(&c.tissue[0], &tissue));
    c.tissue = &tissue;
    for (int turn = 0; turn < 2; turn++) { // the volume term changes with the springs, by little
        double error[SN_RESPONSES], mean = 0;
        SN_TRY(test(&c, true, ALL & ~(1u << PRESSURE), error));
        for (int k = 0; k < SN_RESPONSES; k++)
            mean += k == PRESSURE ? 0.0 : error[k] / (SN_RESPONSES - 1);
        if (!(mean > -0.9) || !isfinite(mean))
            return sn_fail(SN_E_SOLVER,
                           "calibrate: the springs of region \"%s\" do not hold together: virtual "
                           "tests find %g times the stiffness of the continuum",
                           c.mesh->region_name[0], 1 + mean);
        *scale /= 1 + mean;
        for (int k = 0; k < c.springs_given->count; k++) c.springs_given->stiffness[k] /= 1 + mean;
    }
    return SN_OK;
}

void sn_calibration_note(sn_calibration_region *region, double error, const char *format,
                         const char *name) {
    SN_ASSERT(region->error_count < SN_CALIBRATION_ERRORS_MAX);
    sn_calibration_error *to = &region->error[region->error_count++];
    snprintf(to->name, sizeof to->name, format, name);
    to->error = error;
}

sn_status sn_calibration_small(sn_calibration_body *body, sn_calibration_region *region) {
    for (int held = 1; held >= 0; held--) {
        double error[SN_RESPONSES];
        SN_TRY(test(body->c, held, ALL, error));
        for (int k = 0; k < SN_RESPONSES; k++)
            sn_calibration_note(region, error[k], held ? "held, %s" : "free, %s",
                                sn_net_response_name(k));
    }
    return SN_OK;
}
