// A haptic loop at 1 kHz against the clock: a sphere pokes a block of tissue; prints how long its
// frames took. libsinew and libm alone: haptic [SECONDS]. SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <sinew/springs.h>

static sn_status build(sn_case **c) { // 60 x 60 x 30 mm, clamped below, E of some 10 kPa
    sn_shape_def block = {.shape = SN_SHAPE_BLOCK, .size = {0.06, 0.06, 0.03}, .cells = {8, 8, 4}};
    SN_TRY(sn_case_create(c));
    SN_TRY(sn_mesh_build(&block, &(*c)->mesh));
    sn_tissue t = sn_tissue_default();
    t.density = 1000, t.law = sn_law_find("exponential"), t.poissons_ratio = 0.45;
    SN_TRY(sn_tissue_set(&t, "C", 1e4));
    SN_TRY(sn_tissue_set(&t, "B", 5));
    t.memory = (sn_memory){.law = sn_memory_law_find("fung-spectrum"), .value = {0.1, 0.01, 100}};
    (*c)->tissue = sn_alloc(1, sizeof t);
    (*c)->support = sn_alloc(1, sizeof(sn_support));
    (*c)->tool = sn_alloc(1, sizeof(sn_tool));
    if (!(*c)->tissue || !(*c)->support || !(*c)->tool) return SN_E_MEMORY;
    (*c)->tissue[0] = t;
    (*c)->support[0] = (sn_support){sn_mesh_surface((*c)->mesh, "bottom"), {true, true, true}};
    (*c)->tool[0] = (sn_tool){
        .name = "probe", .kind = SN_TOOL_SPHERE, .radius = 0.01, .at = {0.03, 0.03, 0.0401}};
    (*c)->support_count = (*c)->tool_count = 1;
    (*c)->gravity[2] = -9.81, (*c)->springs.rung = SN_RUNG_CENTRAL;
    (*c)->until = (*c)->output_every = 1;
    return sn_case_check(*c);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv) {
    sn_case *c = NULL;
    sn_net *net = NULL;
    sn_state *state = NULL;
    const long frames = (long)(1000 * (argc > 1 ? atof(argv[1]) : 1.0));
    long bin[12] = {0}; // of 0.1 ms; the last but one: up to 2 ms; the last: longer
    if (build(&c) != SN_OK || sn_net_create(c, &net) != SN_OK ||
        sn_state_create(net, &state) != SN_OK)
        return fprintf(stderr, "%s\n", sn_error_text()), 1;
    struct timespec due;
    clock_gettime(CLOCK_MONOTONIC, &due);
    double force[3], most = 0;
    for (long n = 0; n < frames; n++) {
        due.tv_nsec += 1000000;
        if (due.tv_nsec >= 1000000000) due.tv_nsec -= 1000000000, due.tv_sec++;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
        const double start = now(), down = 2e-3 * (1 - cos(6.2832e-3 * (double)n)); // the hand
        const sn_pose pose = sn_pose_at((double[]){0.03, 0.03, 0.0401 - down});
        sn_state_set_tool(net, state, 0, &pose);
        for (double left = 1e-3; left > 1e-9;) left -= sn_state_step(net, state, left).step;
        sn_state_tool_force(net, state, 0, force); // to the motors of the device
        most = fmax(most, force[2]);
        const double took = 1e4 * (now() - start);
        bin[took < 10 ? (int)took : took < 20 ? 10 : 11]++;
    }
    printf("%d nodes, %ld frames, at most %.3f N\n", sn_net_node_count(net), frames, most);
    for (int k = 0; k < 12; k++)
        printf("%s %.1f ms %8ld\n", k < 11 ? "to  " : "over", k < 10 ? 0.1 * (k + 1) : 2.0, bin[k]);
    sn_state_destroy(state), sn_net_destroy(net), sn_case_destroy(c);
    return !(most > 0);
}
