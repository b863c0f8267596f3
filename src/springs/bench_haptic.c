// Times frames of a millisecond, as a haptic device asks for them.
// SPDX-License-Identifier: Apache-2.0
//
// A sphere of 15 mm pokes the middle of the top twice a second, while the block hangs on its own
// weight and rings: it goes down 12 mm, which is some 5 mm into the top as that settles. Each frame
// sets the tool's pose, steps until a millisecond has passed and reads the force. Steps are as long
// as they can be, so that a frame has one or two of them; the last one reaches into the next frame,
// by less than its length. Frames follow each other without a pause: a loop against a clock is in
// examples/embed/haptic.c.
//
// Beside the wall time of frames stands the time that the calling thread ran in them: where other
// programs share the processor, that is what the engine itself took (on one thread).
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "springs/bench.h"
#include "springs/state.h"

static const double frame = 1e-3, radius = 0.015, deep = 0.012, edge = 0.1; // SI
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

/// One frame.
typedef struct haptic_frame {
    double wall, cpu; ///< s; cpu: of the calling thread
    int steps;
    bool looks; ///< a look at the frequency was under way
} haptic_frame;

static double thread_clock(void) {
#ifdef CLOCK_THREAD_CPUTIME_ID
    struct timespec t;
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) == 0)
        return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
#endif
    return sn_clock();
}

static int by_wall(const void *a, const void *b) {
    const haptic_frame *x = a, *y = b;
    return (x->wall > y->wall) - (x->wall < y->wall);
}

static int by_cpu(const void *a, const void *b) {
    const haptic_frame *x = a, *y = b;
    return (x->cpu > y->cpu) - (x->cpu < y->cpu);
}

static void poke(const sn_net *net, sn_state *state, int frames, haptic_frame *f,
                 sn_springs_haptic_row *row) {
    double sum = 0, force[3];
    long steps = 0;
    for (int n = 0; n < frames; n++) {
        const double start = sn_clock(), cpu = thread_clock();
        double down = 0.5 * deep * (1 - cos(2 * turn * n * frame));
        const sn_pose pose =
            sn_pose_at((double[]){0.5 * edge, 0.5 * edge, edge + 1.001 * radius - down});
        sn_state_set_tool(net, state, 0, &pose);
        f[n] = (haptic_frame){0};
        while (state->time < (n + 1) * frame - 1e-9) {
            f[n].looks = f[n].looks || state->look.done > 0;
            row->warnings = sn_state_step(net, state, 1).warnings;
            f[n].looks = f[n].looks || state->look.done > 0;
            f[n].steps++;
        }
        sn_state_tool_force(net, state, 0, force);
        row->force_N = fmax(row->force_N, force[2]);
        f[n].wall = sn_clock() - start;
        f[n].cpu = thread_clock() - cpu;
        sum += f[n].wall;
        steps += f[n].steps;
    }
    row->steps_per_frame = (double)steps / frames;
    row->real_time_factor = frames * frame / sum;
}

static void take_percentiles(int frames, haptic_frame *f, sn_springs_haptic_row *row) {
    const int p999 = (int)ceil(0.999 * frames) - 1;
    qsort(f, (size_t)frames, sizeof *f, by_cpu);
    row->cpu_p50_s = f[(frames - 1) / 2].cpu;
    row->cpu_p999_s = f[p999].cpu;
    qsort(f, (size_t)frames, sizeof *f, by_wall);
    row->frames = frames;
    row->frame_p50_s = f[(frames - 1) / 2].wall;
    row->frame_p999_s = f[p999].wall;
    row->frame_max_s = f[frames - 1].wall;
    for (int n = p999; n < frames; n++) {
        row->worst_steps += (double)f[n].steps / (frames - p999);
        row->worst_looks += (double)f[n].looks / (frames - p999);
        row->worst_cpu_s += f[n].cpu / (frames - p999);
    }
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
    haptic_frame *f = NULL;
    sn_status status;
    *row = (sn_springs_haptic_row){0};
    if (!(seconds >= 0.01 && seconds <= 1e6))
        return sn_fail(SN_E_RANGE, "bench: %g s of frames, expected 0.01 s to 1e6 s", seconds);
    const int frames = (int)ceil(seconds / frame);
    SN_TRY_GOTO(status, sn_springs_bench_case(&plan, &c));
    SN_TRY_GOTO(status, add_sphere(c));
    SN_TRY_GOTO(status, sn_net_create(c, &net));
    SN_TRY_GOTO(status, sn_state_create(net, &state));
    f = sn_alloc((size_t)frames, sizeof *f);
    if (!f) {
        status = SN_E_MEMORY;
        goto fail;
    }
    row->nodes = sn_net_node_count(net);
    row->springs = sn_net_spring_count(net);
    row->threads = threads;
    row->step_s = sn_net_step(net);
    poke(net, state, frames, f, row);
    take_percentiles(frames, f, row);
fail:
    sn_free(f);
    sn_state_destroy(state);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return status;
}
