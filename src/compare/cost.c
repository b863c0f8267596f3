// What a model costs: memory of a run, and time of live frames.
// SPDX-License-Identifier: Apache-2.0
//
// Linux keeps the peak of the resident memory of a process and begins anew when "5" is written to
// clear_refs. What an earlier run has freed must be back with the system by then, else the next run
// takes it from there and seems to need nothing.
#include "compare/cost.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "sinew/springs.h"

//---- memory --------------------------------------------------------------------------------------

// a line of /proc/self/status such as "VmHWM:  1234 kB", bytes
static double status_line(const char *key) {
    FILE *file = fopen("/proc/self/status", "r");
    char line[256];
    double kilobytes = 0;
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, key, strlen(key)) == 0) kilobytes = strtod(line + strlen(key), NULL);
    if (file) fclose(file);
    return 1024 * kilobytes;
}

double sn_memory_watch(void) {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (!file) return 0;
    bool good = fputs("5", file) >= 0;
    good = fclose(file) == 0 && good;
    return good ? status_line("VmRSS:") : 0;
}

double sn_memory_peak(double before) {
    return before > 0 ? fmax(0, status_line("VmHWM:") - before) : 0;
}

//---- live frames ---------------------------------------------------------------------------------

enum { FRAMES_MOST = 200, FRAMES_LEAST = 5 };
static const double frame = 1e-3;   // of a haptic loop, seconds
static const double patience = 0.1; // seconds

static int compare_double(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void run_frames(const sn_net *net, sn_state *state, sn_live *live) {
    double wall[FRAMES_MOST], start = sn_clock(), before = start;
    int n = 0;
    while (n < FRAMES_MOST && (n < FRAMES_LEAST || before - start < patience)) {
        for (double left = frame; left > 1e-9 * frame;)
            left -= sn_state_step(net, state, left).step;
        double now = sn_clock();
        wall[n] = now - before;
        before = now;
        double bin = floor(8 * log10(wall[n] / 1e-6));
        live->bin[(int)fmin(fmax(bin, 0), SN_LIVE_BINS - 1)]++;
        n++;
    }
    live->frames = n;
    live->step_s = sn_net_step(net);
    qsort(wall, (size_t)n, sizeof *wall, compare_double);
    live->frame_p50_s = wall[(n - 1) / 2];
    live->real_time_factor = frame / live->frame_p50_s;
    live->frame_p99_s = wall[(int)ceil(0.99 * n) - 1];
    live->frame_max_s = wall[n - 1];
}

void sn_live_measure(const sn_case *c, sn_live *live) {
    sn_case own = *c; // borrows everything
    sn_net *net = NULL;
    sn_state *state = NULL;
    *live = (sn_live){.step_s = (double)NAN,
                      .real_time_factor = (double)NAN,
                      .frame_p50_s = (double)NAN,
                      .frame_p99_s = (double)NAN,
                      .frame_max_s = (double)NAN};
    own.springs.integrator = SN_INTEGRATOR_EXPLICIT;
    own.springs.precision = SN_SINGLE;
    own.springs.step = 0;
    if (sn_net_create(&own, &net) == SN_OK && sn_state_create(net, &state) == SN_OK)
        run_frames(net, state, live);
    sn_state_destroy(state);
    sn_net_destroy(net);
}
