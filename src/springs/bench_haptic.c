// Times frames of a millisecond, as a haptic device asks for them.
// SPDX-License-Identifier: Apache-2.0
//
// A sphere of 15 mm pokes the middle of the top, 5 mm deep at most, twice a second, while the block
// hangs on its own weight and rings. Each frame sets the tool's pose, steps a millisecond and reads
// the force. Frames follow each other without a pause: a loop against a clock is in
// examples/embed/haptic.c.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "springs/bench.h"

static const double frame = 1e-3, radius = 0.015, deep = 0.005, edge = 0.1; // SI
static const double turn = 6.283185307179586;

static sn_status add_sphere(sn_case *c) {
    c->tool = sn_alloc(1, sizeof *c->tool);
    if (!c->tool) return SN_E_MEMORY;
    c->tool_count = 1;
    c->tool[0] = (sn_tool){.name = "sphere",
                           .kind = SN_TOOL_SPHERE,
                           .radius = radius,
                           .at = {0.5 * edge, 0.5 * edge, edge + 1.001 * radius}};
    return SN_OK;
}

static int compare_double(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// frames; wall time of each
static void poke(const sn_net *net, sn_state *state, int frames, double *wall,
                 sn_springs_haptic_row *row) {
    double sum = 0, force[3];
    long steps = 0;
    for (int n = 0; n < frames; n++) {
        double start = sn_clock();
        double down = 0.5 * deep * (1 - cos(2 * turn * n * frame));
        const sn_pose pose =
            sn_pose_at((double[]){0.5 * edge, 0.5 * edge, edge + 1.001 * radius - down});
        sn_state_set_tool(net, state, 0, &pose);
        for (double left = frame; left > 1e-9; steps++) {
            sn_step_info info = sn_state_step(net, state, left);
            left -= info.step;
            row->warnings = info.warnings;
        }
        sn_state_tool_force(net, state, 0, force);
        row->force_N = fmax(row->force_N, force[2]);
        wall[n] = sn_clock() - start;
        sum += wall[n];
    }
    row->steps_per_frame = (double)steps / frames;
    row->real_time_factor = frames * frame / sum;
}

static void take_percentiles(int frames, double *wall, sn_springs_haptic_row *row) {
    qsort(wall, (size_t)frames, sizeof *wall, compare_double);
    row->frames = frames;
    row->frame_p50_s = wall[(frames - 1) / 2];
    row->frame_p999_s = wall[(size_t)ceil(0.999 * frames) - 1];
    row->frame_max_s = wall[frames - 1];
}

sn_status sn_springs_haptic(int cells, int threads, double seconds, sn_springs_haptic_row *row) {
    const sn_springs_bench_plan plan = {.rung = SN_RUNG_CENTRAL,
                                        .volume = true,
                                        .memory_terms = 3,
                                        .cells = cells,
                                        .threads = threads,
                                        .precision = SN_SINGLE};
    sn_case *c = NULL;
    sn_net *net = NULL;
    sn_state *state = NULL;
    double *wall = NULL;
    sn_status status;
    *row = (sn_springs_haptic_row){0};
    if (!(seconds >= 0.01 && seconds <= 1e6))
        return sn_fail(SN_E_RANGE, "bench: %g s of frames, expected 0.01 s to 1e6 s", seconds);
    const int frames = (int)ceil(seconds / frame);
    SN_TRY_GOTO(status, sn_springs_bench_case(&plan, &c));
    SN_TRY_GOTO(status, add_sphere(c));
    SN_TRY_GOTO(status, sn_net_create(c, &net));
    SN_TRY_GOTO(status, sn_state_create(net, &state));
    wall = sn_alloc((size_t)frames, sizeof *wall);
    if (!wall) {
        status = SN_E_MEMORY;
        goto fail;
    }
    row->nodes = sn_net_node_count(net);
    row->springs = sn_net_spring_count(net);
    row->threads = threads;
    row->step_s = sn_net_step(net);
    poke(net, state, frames, wall, row);
    take_percentiles(frames, wall, row);
fail:
    sn_free(wall);
    sn_state_destroy(state);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return status;
}
