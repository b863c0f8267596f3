// Times the explicit step.
// SPDX-License-Identifier: Apache-2.0
//
// Two bounds. Memory: the bytes that a step moves, counted below from the arrays of pass.h, against
// the bandwidth of a triad a = b + s c over arrays that together are as large as the net's.
// Arithmetic: the operations of a step, counted from the formulas of the kernels (a division or
// root as one), against the rate of independent multiplications and additions in the widest
// registers; not fused, as kernels use no fused operation. Both are measured in the same call, on
// one thread, and count double for two threads. Beside it runs a plain loop (springs/bench_plain.h)
// that does the same work.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "springs/bench.h"
#include "springs/bench_plain.h"

static const double young = 1e4, density = 1000, poisson = 0.45, edge = 0.1; // SI
static const double least_time = 0.15;                                       // seconds of a sample
enum { SAMPLES = 5 };

static sn_status bench_law(const sn_springs_bench_plan *plan, sn_tissue *t) {
    const double shear = young / (2 * (1 + poisson));
    const bool central = plan->rung == SN_RUNG_CENTRAL;
    const char *name = plan->law ? plan->law : central ? "exponential" : "neo-hookean";
    t->law = sn_law_find(name);
    if (!t->law) return SN_E_NAME;
    sn_param_defaults(t->law->params, t->law->param_count, 0, t->value);
    if (central && strcmp(name, "exponential") == 0) {
        SN_TRY(sn_tissue_set(t, "B", 5));
        SN_TRY(sn_tissue_set(t, "C", young));
        t->poissons_ratio = plan->volume ? poisson : 0.25;
        return SN_OK;
    }
    if (!central && strcmp(name, "demiray") == 0) {
        SN_TRY(sn_tissue_set(t, "c", shear));
        SN_TRY(sn_tissue_set(t, "b", 2));
    } else if (!central && strcmp(name, "neo-hookean") == 0) {
        SN_TRY(sn_tissue_set(t, "shear_modulus", shear));
    } else {
        return sn_fail(SN_E_NAME,
                       "bench: law %s; expected exponential for central, neo-hookean or "
                       "demiray for coupled and smoothed",
                       name);
    }
    return sn_tissue_set(t, "bulk_modulus", young / (3 * (1 - 2 * poisson)));
}

static sn_status bench_tissue(const sn_springs_bench_plan *plan, sn_tissue *t) {
    const int memory_terms = plan->memory_terms;
    *t = sn_tissue_default();
    snprintf(t->name, sizeof t->name, "bench");
    t->density = density;
    SN_TRY(bench_law(plan, t));
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

sn_status sn_springs_bench_case(const sn_springs_bench_plan *plan, sn_case **out) {
    const int cells = plan->cells;
    sn_status status;
    *out = NULL;
    if (cells < 1 || plan->memory_terms < 0 || plan->memory_terms > SN_TERMS_MAX ||
        plan->threads < 1)
        return sn_fail(SN_E_RANGE,
                       "bench: %d cells, %d exponentials, %d threads; expected 1 or more, 0 to %d, "
                       "1 or more",
                       cells, plan->memory_terms, plan->threads, SN_TERMS_MAX);
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
    SN_TRY_GOTO(status, bench_tissue(plan, c->tissue));
    c->support_count = 1;
    c->support[0] =
        (sn_support){.surface = sn_mesh_surface(c->mesh, "bottom"), .fix = {true, true, true}};
    c->gravity[2] = -9.81;
    c->until = 1;
    c->output_every = 0.1;
    c->springs.rung = plan->rung;
    c->springs.volume = plan->volume;
    c->springs.precision = plan->precision;
    c->springs.threads = plan->threads;
    c->springs.memory_tolerance = 1e-12; // all terms that were asked for
    return SN_OK;
fail:
    sn_case_destroy(c);
    *out = NULL;
    return status;
}

// bytes of one step
static double step_bytes(const sn_net *net) {
    const double r = net->precision == SN_SINGLE ? 4 : 8, index = 4, corner = 2;
    const double store = 2 * (1 + net->region[0].branches) * (net->region[0].branches > 0) * r;
    const double entry = index + (4 + 4) * r; // node, rest position, displacement
    const double force = (4 + 4) * r + index; // out and in, item
    const double springs = net->spring_blocks * (double)SN_BLOCK;
    const double fans = sn_tiles_entries(&net->fan_tiles);
    double bytes = springs * (corner * (1 + SN_STAR) / SN_STAR + r + store);
    bytes += sn_tiles_entries(&net->spring_tiles) * (entry + force);
    if (net->rung == SN_RUNG_SMOOTHED) {
        // shapes out and in at each edge that shares them, stresses out and in at each cell: what a
        // cache that holds them all would move is less
        const double components = net->volume_mode == SN_VOLUME_CELL ? 7 : 6;
        const double edges = net->edge_blocks * (double)SN_BLOCK, item = 12 * r;
        bytes += net->cells * (2 * 4 * corner + 19 * r + item + 6 * index);
        bytes += edges * (2 * item + index + components * store) + net->cells * 6 * (index + item);
        bytes += sn_tiles_entries(&net->cell_tiles) * (2 * entry + force + index + r);
    }
    if (net->rung == SN_RUNG_COUPLED) { // corners, gradient, volume
        const double components = net->volume_mode == SN_VOLUME_CELL ? 7 : 6;
        bytes += net->cells * (4 * corner + 10 * r + components * store);
        bytes += sn_tiles_entries(&net->cell_tiles) * (entry + force + index + r);
    }
    if (net->volume) { // corners, growth out and in; springs press by fans too
        const bool press = net->rung == SN_RUNG_CENTRAL;
        bytes += (press ? 2.0 : 1.0) * (double)net->fan_tiles.corner_count * corner;
        bytes += fans * (entry + 2 * r + index + (press ? entry + index + r + force : 0));
        bytes += net->nodes * (2 * r + index + store);
    }
    // weight, force out and in, inverse mass, u and v in and out
    return bytes + net->nodes * ((4 + 8 + 4 + 16) * r + index);
}

// operations of one step, from the formulas of the kernels
static double step_operations(const sn_net *net) {
    const int branches = net->region[0].branches;
    const double memory = branches > 0 ? 2 + 4 * branches : 0;
    const bool central = net->rung == SN_RUNG_CENTRAL;
    double sum = 40.0 * net->nodes; // sums of entries, kick and drift
    sum += net->springs * (82 + memory);
    if (net->rung == SN_RUNG_SMOOTHED) {
        const double law = strcmp(net->region[0].tissue.law->name, "demiray") == 0 ? 130 : 100;
        const double edges = net->edge_blocks * (double)SN_BLOCK;
        sum += net->cells * (57 + 9 + 6 * 9 + 6 * 9 + 57 + 45 + 18 + 30.0);
        sum += edges * (14 + 42 + 12 + 45 + law + (net->volume ? 6 : 7) * memory);
    } else if (!central) {
        const double law = strcmp(net->region[0].tissue.law->name, "demiray") == 0 ? 130 : 100;
        sum += net->cells * (265 + law + (net->volume ? 6 : 7) * memory);
    }
    if (net->volume) sum += net->cells * (central ? 62 + 60 : 62) + net->nodes * (4 + memory);
    return sum;
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

// multiplications and additions a second
static double arithmetic(const sn_net *net) {
    double best = 0;
    for (int sample = 0; sample < SAMPLES; sample++) {
        const long turns = 200000;
        double out[8], start = sn_clock();
        double done = sn_spring_kernels_row(net->isa, net->precision)->peak(turns, out);
        best = fmax(best, done / (sn_clock() - start));
    }
    return best;
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

static sn_status plain_time(const sn_net *net, double *seconds) {
    sn_plain *plain;
    *seconds = INFINITY;
    SN_TRY(sn_plain_create(net, &plain));
    for (int sample = 0; sample < SAMPLES; sample++) {
        double start = sn_clock(), time = 0;
        long steps = 0;
        for (; time < 0.3 * least_time; steps++, time = sn_clock() - start) sn_plain_step(plain);
        *seconds = fmin(*seconds, time / (double)steps);
    }
    sn_plain_destroy(plain);
    return SN_OK;
}

static sn_status fill_row(const sn_net *net, sn_state *state, sn_springs_bench_row *row) {
    const bool central = net->rung == SN_RUNG_CENTRAL;
    double bytes = step_bytes(net), seconds = step_time(net, state), bandwidth, plain;
    SN_TRY(triad(bytes, &bandwidth));
    SN_TRY(plain_time(net, &plain));
    static const char *const rungs[] = {"central", "coupled", "smoothed"};
    const double items = central ? net->springs : net->cells;
    snprintf(row->model, sizeof row->model, "%s", rungs[net->rung]);
    snprintf(row->law, sizeof row->law, "%s", net->region[0].tissue.law->name);
    row->volume = net->volume;
    row->memory_terms = net->region[0].memory.terms;
    row->nodes = net->nodes;
    row->springs = net->springs;
    row->cells = net->cells;
    row->threads = net->threads;
    row->precision = net->precision;
    row->springs_per_second = net->springs / seconds;
    row->cells_per_second = !central || net->volume ? net->cells / seconds : 0;
    row->memory_bound_per_second = net->threads * bandwidth * items / bytes;
    row->arithmetic_bound_per_second =
        net->threads * arithmetic(net) * items / step_operations(net);
    row->bound_per_second = fmin(row->memory_bound_per_second, row->arithmetic_bound_per_second);
    row->plain_per_second = items / plain;
    row->step_s = net->step;
    row->real_time_factor = net->step / seconds;
    return SN_OK;
}

sn_status sn_springs_bench(const sn_springs_bench_plan *plan, sn_springs_bench_row *row) {
    sn_case *c = NULL;
    sn_net *net = NULL;
    sn_state *state = NULL;
    sn_status status;
    *row = (sn_springs_bench_row){0};
    SN_TRY_GOTO(status, sn_springs_bench_case(plan, &c));
    SN_TRY_GOTO(status, sn_net_create(c, &net));
    SN_TRY_GOTO(status, sn_state_create(net, &state));
    SN_TRY_GOTO(status, fill_row(net, state, row));
fail:
    sn_state_destroy(state);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return status;
}
