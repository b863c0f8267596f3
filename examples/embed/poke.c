// A block of tissue poked by a sphere: the engine in a program of one's own, libsinew and libm
// alone. SPDX-License-Identifier: Apache-2.0
#include <stdio.h>

#include <sinew/springs.h>

// what a haptic program does a thousand times a second: set the tool, step, read the force
static void frame(const sn_net *net, sn_state *state, const double tool[3], double force[3]) {
    const sn_pose pose = sn_pose_at(tool);
    sn_state_set_tool(net, state, 0, &pose);
    for (double left = 1e-3; left > 1e-9;) left -= sn_state_step(net, state, left).step;
    sn_state_tool_force(net, state, 0, force);
}

static sn_status build(sn_case **c) {
    sn_shape_def block = {.shape = SN_SHAPE_BLOCK, .size = {0.04, 0.04, 0.02}, .cells = {8, 8, 4}};
    SN_TRY(sn_case_create(c));
    SN_TRY(sn_mesh_build(&block, &(*c)->mesh));
    (*c)->shape = block, (*c)->has_shape = true;
    sn_tissue liver = sn_tissue_default();
    liver.density = 1060;
    liver.law = sn_law_find("demiray");
    SN_TRY(sn_tissue_set(&liver, "c", 2e3));
    SN_TRY(sn_tissue_set(&liver, "b", 3));
    SN_TRY(sn_tissue_set(&liver, "bulk_modulus", 2e5));
    liver.memory =
        (sn_memory){.law = sn_memory_law_find("fung-spectrum"), .value = {0.1, 0.01, 100}};
    (*c)->tissue = sn_alloc(1, sizeof liver);
    (*c)->support = sn_alloc(1, sizeof(sn_support));
    (*c)->tool = sn_alloc(1, sizeof(sn_tool));
    if (!(*c)->tissue || !(*c)->support || !(*c)->tool) return SN_E_MEMORY;
    (*c)->tissue[0] = liver;
    (*c)->support[0] = (sn_support){sn_mesh_surface((*c)->mesh, "bottom"), {true, true, true}};
    (*c)->tool[0] = (sn_tool){
        .name = "probe", .kind = SN_TOOL_SPHERE, .radius = 0.005, .at = {0.02, 0.02, 0.025}};
    (*c)->support_count = (*c)->tool_count = 1;
    (*c)->until = 1, (*c)->output_every = 1;
    return sn_case_check(*c);
}

int main(void) {
    sn_case *c = NULL;
    sn_net *net = NULL;
    sn_state *state = NULL;
    double force[3] = {0};
    sn_status status = build(&c);
    if (status == SN_OK) status = sn_net_create(c, &net);
    if (status == SN_OK) status = sn_state_create(net, &state);
    if (status != SN_OK) fprintf(stderr, "%s\n", sn_error_text());
    for (int ms = 1; status == SN_OK && ms <= 100; ms++) {
        frame(net, state, (double[]){0.02, 0.02, 0.025 - 4e-5 * ms}, force);
        if (ms % 25 == 0) printf("%3d ms  %.3f mm  %.4f N\n", ms, 0.04 * ms, force[2]);
    }
    sn_state_destroy(state);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return status != SN_OK || !(force[2] > 0);
}
