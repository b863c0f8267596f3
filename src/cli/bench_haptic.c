// sinew bench springs --haptic: frames of a millisecond, and the largest body that holds them.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>

#include "cli/cli.h"

enum { LEAST = 4, MOST = 80, THREADS = 2 };    // cells along an edge
static const double frame = 1e-3, trial = 2.0; // s

/// A benchmark under way.
typedef struct haptic_bench {
    cli_progress progress;
    double seconds; ///< that a size must hold
    int threads, runs;
    bool table;
    json_t *results;
} haptic_bench;

static bool holds(const sn_springs_haptic_row *r) {
    return r->frame_p999_s < frame;
}

static sn_status measure(haptic_bench *b, int cells, double seconds, sn_springs_haptic_row *row) {
    char text[64];
    snprintf(text, sizeof text, "%d thread%s, %d^3 nodes, %g s", b->threads,
             b->threads > 1 ? "s" : "", cells + 1, seconds);
    // some six runs a number of threads: two sizes, four on the way to the largest
    cli_progress_show(&b->progress, fmin(0.95, b->runs++ / (6.0 * THREADS)), text);
    return sn_springs_haptic(cells, b->threads, seconds, row);
}

// The largest size whose frames hold for the whole time; 0 where none does. A frame of n cells
// along an edge costs n^3 times the number of steps, which is as n: that and a row of another size
// say where to begin. From there short runs go up or down to the edge, and from the edge whole ones
// down.
static sn_status find_largest(haptic_bench *b, const sn_springs_haptic_row *near, int cells,
                              int *largest, sn_springs_haptic_row *row) {
    const double part = fmin(b->seconds, trial);
    int at = (int)(cells * pow(frame / near->frame_p999_s, 0.25));
    at = at < LEAST ? LEAST : at > MOST ? MOST : at;
    SN_TRY(measure(b, at, part, row));
    const bool up = holds(row);
    while (up && at < MOST) {
        SN_TRY(measure(b, at + 1, part, row));
        if (!holds(row)) break;
        at++;
    }
    while (!up && --at >= LEAST) {
        SN_TRY(measure(b, at, part, row));
        if (holds(row)) break;
    }
    for (; at >= LEAST; at--) {
        SN_TRY(measure(b, at, b->seconds, row));
        if (holds(row)) break;
    }
    *largest = at >= LEAST ? at : 0;
    return SN_OK;
}

static json_t *row_json(const sn_springs_haptic_row *r, bool largest) {
    json_t *json = json_object();
    cli_put_integer(json, "nodes", r->nodes);
    cli_put_integer(json, "springs", r->springs);
    cli_put_integer(json, "threads", r->threads);
    cli_put_flag(json, "largest", largest);
    cli_put_integer(json, "frames", r->frames);
    cli_put_number(json, "steps_per_frame", r->steps_per_frame);
    cli_put_number(json, "frame_p50_s", r->frame_p50_s);
    cli_put_number(json, "frame_p999_s", r->frame_p999_s);
    cli_put_number(json, "frame_max_s", r->frame_max_s);
    cli_put_number(json, "cpu_p50_s", r->cpu_p50_s);
    cli_put_number(json, "cpu_p999_s", r->cpu_p999_s);
    cli_put_number(json, "worst_steps", r->worst_steps);
    cli_put_number(json, "worst_looks", r->worst_looks);
    cli_put_number(json, "worst_cpu_s", r->worst_cpu_s);
    cli_put_number(json, "real_time_factor", r->real_time_factor);
    cli_put_number(json, "force_N", r->force_N);
    cli_put_integer(json, "warnings", r->warnings);
    return json;
}

static void print_row(const sn_springs_haptic_row *r, bool largest) {
    printf(
        "%6d %7d %3d %7d %6.2f %8.3f %8.3f %8.3f %8.3f %9.3f %7.3f   %.1f steps, %3.0f %% looks, "
        "%.3f ms of it run%s\n",
        r->nodes, r->springs, r->threads, r->frames, r->steps_per_frame, 1e3 * r->frame_p50_s,
        1e3 * r->frame_p999_s, 1e3 * r->frame_max_s, 1e3 * r->cpu_p999_s, r->real_time_factor,
        r->force_N, r->worst_steps, 100 * r->worst_looks, 1e3 * r->worst_cpu_s,
        largest ? "; the largest with 99.9 % of its frames below 1 ms" : "");
    fflush(stdout);
}

static void take_row(haptic_bench *b, const sn_springs_haptic_row *row, bool largest) {
    json_array_append_new(b->results, row_json(row, largest));
    cli_progress_end(&b->progress);
    if (b->table) print_row(row, largest);
}

// 11^3, 21^3, the largest
static sn_status rows_of(haptic_bench *b) {
    static const int sizes[] = {10, 20};
    sn_springs_haptic_row row, near;
    for (int k = 0; k < 2; k++) {
        SN_TRY(measure(b, sizes[k], b->seconds, &near));
        take_row(b, &near, false);
    }
    int cells;
    SN_TRY(find_largest(b, &near, sizes[1], &cells, &row));
    if (cells > 0) take_row(b, &row, true);
    if (cells == 0 && b->table)
        printf("%d threads: not even %d^3 nodes hold 1 ms\n", b->threads, LEAST + 1);
    return SN_OK;
}

int cli_bench_haptic(const cli_arguments *arguments, double seconds) {
    char machine[256];
    cli_machine(machine, sizeof machine);
    haptic_bench b = {.progress = cli_progress_start(arguments),
                      .seconds = seconds,
                      .table = !arguments->json && !arguments->quiet,
                      .results = json_array()};
    if (b.table)
        printf("%s, kernels %s\n%6s %7s %3s %7s %6s %8s %8s %8s %8s %9s %7s   %s\n", machine,
               sn_isa_name(), "nodes", "springs", "thr", "frames", "steps", "50 % ms", "99.9 %",
               "max", "99.9 run", "real time", "force N", "the longest thousandth of frames");
    for (b.threads = 1; b.threads <= THREADS; b.threads++) {
        sn_status status = rows_of(&b);
        cli_progress_end(&b.progress);
        if (status == SN_OK) continue;
        json_decref(b.results);
        return cli_fail(status);
    }
    json_t *json = json_object();
    cli_put_text(json, "kernels", sn_isa_name());
    return cli_bench_end(arguments, json, b.results);
}
