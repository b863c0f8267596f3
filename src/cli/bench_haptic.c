// sinew bench springs --haptic: frames of a millisecond, and the largest body that holds them.
// SPDX-License-Identifier: Apache-2.0
#include <stdio.h>

#include "cli/cli.h"

enum { LEAST = 4, MOST = 64, THREADS = 2 };    // cells along an edge
static const double frame = 1e-3, trial = 0.5; // s

static bool holds(const sn_springs_haptic_row *r) {
    return r->frame_p999_s < frame;
}

// the largest size whose frames hold for `seconds`: bisection by short runs, then down from there
// until the whole time holds; 0 where none does
static sn_status find_largest(int threads, double seconds, int *cells, sn_springs_haptic_row *row) {
    int low = LEAST - 1, high = MOST + 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        SN_TRY(sn_springs_haptic(middle, threads, seconds < trial ? seconds : trial, row));
        if (holds(row))
            low = middle;
        else
            high = middle;
    }
    for (; low >= LEAST; low--) {
        SN_TRY(sn_springs_haptic(low, threads, seconds, row));
        if (holds(row)) break;
    }
    *cells = low >= LEAST ? low : 0;
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
    cli_put_number(json, "real_time_factor", r->real_time_factor);
    cli_put_number(json, "force_N", r->force_N);
    cli_put_integer(json, "warnings", r->warnings);
    return json;
}

static void print_row(const sn_springs_haptic_row *r, bool largest) {
    printf("%6d %7d %3d %7d %6.2f %8.3f %8.3f %8.3f %9.3f%s\n", r->nodes, r->springs, r->threads,
           r->frames, r->steps_per_frame, 1e3 * r->frame_p50_s, 1e3 * r->frame_p999_s,
           1e3 * r->frame_max_s, r->real_time_factor,
           largest ? "  largest with 99.9 % of its frames below 1 ms" : "");
    fflush(stdout);
}

// 11^3, 21^3, the largest
static sn_status rows_of(int threads, double seconds, bool table, json_t *results) {
    static const int sizes[] = {10, 20};
    sn_springs_haptic_row row;
    for (int k = 0; k < 2; k++) {
        SN_TRY(sn_springs_haptic(sizes[k], threads, seconds, &row));
        json_array_append_new(results, row_json(&row, false));
        if (table) print_row(&row, false);
    }
    int cells;
    SN_TRY(find_largest(threads, seconds, &cells, &row));
    if (cells > 0) json_array_append_new(results, row_json(&row, true));
    if (cells > 0 && table) print_row(&row, true);
    if (cells == 0 && table)
        printf("%d threads: not even %d^3 nodes hold 1 ms\n", threads, LEAST + 1);
    return SN_OK;
}

int cli_bench_haptic(const cli_arguments *arguments, double seconds) {
    const bool table = !arguments->json && !arguments->quiet;
    char machine[256];
    cli_machine(machine, sizeof machine);
    if (table)
        printf("%s, kernels %s\n%6s %7s %3s %7s %6s %8s %8s %8s %9s\n", machine, sn_isa_name(),
               "nodes", "springs", "thr", "frames", "steps", "50 % ms", "99.9 %", "max",
               "real time");
    json_t *results = json_array();
    for (int threads = 1; threads <= THREADS; threads++) {
        sn_status status = rows_of(threads, seconds, table, results);
        if (status == SN_OK) continue;
        json_decref(results);
        return cli_fail(status);
    }
    json_t *json = json_object();
    cli_put(json, "results", results);
    cli_put_text(json, "machine", machine);
    cli_put_text(json, "kernels", sn_isa_name());
    if (arguments->json)
        cli_print_json(json);
    else
        json_decref(json);
    return CLI_DONE;
}
