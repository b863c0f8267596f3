// Times the explicit step.
// SPDX-License-Identifier: Apache-2.0
//
// The bound is what the memory system would allow: the bytes that one item and its share of the
// nodes move in a step (counted below from the arrays of pass.h), against the bandwidth of a triad
// a = b + s c over arrays that together are as large as the net's, measured in the same call.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "springs/net.h"

static const double young = 1e4, density = 1000, poisson = 0.45, edge = 0.1; // SI
static const double least_time = 0.15;                                       // seconds of a sample
enum { SAMPLES = 5 };

static sn_status bench_tissue(sn_rung rung, bool volume, int memory_terms, sn_tissue *t) {
    *t = sn_tissue_default();
    snprintf(t->name, sizeof t->name, "bench");
    t->density = density;
    t->law = sn_law_find(rung == SN_RUNG_CENTRAL ? "exponential" : "demiray");
    if (!t->law) return SN_E_NAME;
    sn_param_defaults(t->law->params, t->law->param_count, 0, t->value);
    if (rung == SN_RUNG_CENTRAL) {
        SN_TRY(sn_tissue_set(t, "B", 5));
        SN_TRY(sn_tissue_set(t, "C", young));
        t->poissons_ratio = volume ? poisson : 0.25;
    } else {
        SN_TRY(sn_tissue_set(t, "c", young / (2 * (1 + poisson))));
        SN_TRY(sn_tissue_set(t, "b", 2));
        SN_TRY(sn_tissue_set(t, "bulk_modulus", young / (3 * (1 - 2 * poisson))));
    }
    t->memory = sn_memory_none();
    if (memory_terms == 0) return SN_OK;
    t->memory.law = sn_memory_law_find("prony");
    if (!t->memory.law) return SN_E_NAME;
    t->memory.terms = memory_terms;
    for (int k = 0; k < memory_terms; k++) { // a decade apart up to a second
        t->memory.value[k] = 0.5 / memory_terms;
        t->memory.value[memory_terms + k] = pow(10.0, -k * 3.0 / memory_terms);
    }
    return SN_OK;
}

static sn_status bench_case(sn_rung rung, bool volume, int memory_terms, int cells,
                            sn_precision precision, sn_case **out) {
    sn_status status;
    SN_TRY(sn_case_create(out));
    sn_case *c = *out;
    c->has_shape = true;
    c->shape = (sn_shape_def){.shape = SN_SHAPE_BLOCK,
                              .pattern = SN_PATTERN_MIRRORED,
                              .size = {edge, edge, edge},
                              .cells = {cells, cells, cells}};
    SN_TRY_GOTO(status, sn_mesh_build(&c->shape, &c->mesh));
    c->tissue = sn_alloc(1, sizeof *c->tissue);
    c->support = sn_alloc(1, sizeof *c->support);
    if (!c->tissue || !c->support) {
        status = SN_E_MEMORY;
        goto fail;
    }
    SN_TRY_GOTO(status, bench_tissue(rung, volume, memory_terms, c->tissue));
    c->support_count = 1;
    c->support[0] =
        (sn_support){.surface = sn_mesh_surface(c->mesh, "bottom"), .fix = {true, true, true}};
    c->gravity[2] = -9.81;
    c->until = 1;
    c->output_every = 0.1;
    c->springs.rung = rung;
    c->springs.volume = volume;
    c->springs.precision = precision;
    c->springs.memory_tolerance = 1e-12; // all terms that were asked for
    return SN_OK;
fail:
    sn_case_destroy(c);
    *out = NULL;
    return status;
}

// bytes of one step
static double step_bytes(const sn_net *net) {
    const double r = net->precision == SN_SINGLE ? 4 : 8, index = 4;
    const double store = 2 * (1 + net->region[0].branches) * (net->region[0].branches > 0);
    double bytes = 0;
    if (net->rung == SN_RUNG_CENTRAL) // ends, edge, inverse, stiffness, memory, force, sums
        bytes += net->springs * (2 * index + (3 + 1 + 1 + store + 4 + 8) * r + 2 * index);
    if (net->rung == SN_RUNG_COUPLED || net->volume) // nodes, gradients, volume, force, sums
        bytes += net->cells * (4 * index + (9 + 1 + 16 + 16) * r + 4 * index);
    if (net->rung == SN_RUNG_COUPLED)
        bytes += net->cells * store * (net->volume_mode == SN_VOLUME_CELL ? 7 : 6) * r;
    if (net->volume) { // nodes, gradients and volume again, growth twice, points
        bytes += net->cells * (4 * index + (9 + 1 + 1 + 4) * r + 8 * index);
        bytes += net->nodes * (2 + store) * r;
    }
    // weight, force out and in, u and v in and out, inverse mass
    return bytes + net->nodes * (4 * (1 + 2 + 4 + 1) * r + 3 * index);
}

// bytes a second of a triad over `bytes` in all
static sn_status triad(double bytes, double *bandwidth) {
    const size_t n = (size_t)fmax(bytes / (3 * sizeof(double)), 1024);
    double *a = sn_alloc(n, sizeof *a), *b = sn_alloc(n, sizeof *b), *c = sn_alloc(n, sizeof *c);
    sn_status status = a && b && c ? SN_OK : SN_E_MEMORY;
    *bandwidth = 0;
    for (int sample = 0; sample < SAMPLES && status == SN_OK; sample++) {
        double start = sn_clock(), time = 0;
        long turns = 0;
        for (; time < 0.2 * least_time; turns++, time = sn_clock() - start) {
            const double s = 1e-3 * (double)turns;
            for (size_t i = 0; i < n; i++) a[i] = b[i] + s * c[i];
            double *swap = b; // so that no turn can be left out
            b = a;
            a = swap;
        }
        *bandwidth = fmax(*bandwidth, 3.0 * (double)(n * sizeof *a) * (double)turns / time);
    }
    sn_free(a);
    sn_free(b);
    sn_free(c);
    return status;
}

// fastest seconds a step, over some samples
static double step_time(const sn_net *net, sn_state *state) {
    double best = INFINITY;
    for (int sample = 0; sample < SAMPLES; sample++) {
        double start = sn_clock(), time = 0;
        long steps = 0;
        while (time < least_time) {
            for (int k = 0; k < 8; k++) sn_state_step(net, state, net->step);
            steps += 8;
            time = sn_clock() - start;
        }
        best = fmin(best, time / (double)steps);
    }
    return best;
}

sn_status sn_springs_bench(sn_rung rung, bool volume, int memory_terms, int cells,
                           sn_precision precision, sn_springs_bench_row *row) {
    sn_case *c = NULL;
    sn_net *net = NULL;
    sn_state *state = NULL;
    double bandwidth;
    sn_status status;
    *row = (sn_springs_bench_row){0};
    if (cells < 1 || memory_terms < 0 || memory_terms > SN_TERMS_MAX)
        return sn_fail(SN_E_RANGE,
                       "bench: %d cells and %d exponentials; expected 1 or more, and 0 "
                       "to %d",
                       cells, memory_terms, SN_TERMS_MAX);
    SN_TRY_GOTO(status, bench_case(rung, volume, memory_terms, cells, precision, &c));
    SN_TRY_GOTO(status, sn_net_create(c, &net));
    SN_TRY_GOTO(status, sn_state_create(net, &state));
    double bytes = step_bytes(net), seconds = step_time(net, state);
    SN_TRY_GOTO(status, triad(bytes, &bandwidth));
    snprintf(row->model, sizeof row->model, "%s", rung == SN_RUNG_CENTRAL ? "central" : "coupled");
    row->volume = volume;
    row->memory_terms = net->region[0].memory.terms;
    row->nodes = net->nodes;
    row->springs = net->springs;
    row->cells = net->cells;
    row->threads = 1;
    row->precision = precision;
    row->springs_per_second = net->springs / seconds;
    row->cells_per_second = rung == SN_RUNG_COUPLED || volume ? net->cells / seconds : 0;
    row->bound_per_second =
        bandwidth * (rung == SN_RUNG_CENTRAL ? net->springs : net->cells) / bytes;
fail:
    sn_state_destroy(state);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return status;
}
