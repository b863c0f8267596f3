// What the tests of cuts share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "body.h"

static const double size[3] = {0.06, 0.04, 0.04};

enum { KINDS = 6 }; // rungs, with volume and without

static inline void set_kind(sn_case *c, int kind) {
    c->springs.rung = (sn_rung)(kind / 2);
    c->springs.volume = kind % 2 == 0;
}

static inline void add_cut(sn_case *c, double at, const double low[3], const double high[3]) {
    c->cut = sn_resize(c->cut, (size_t)c->cut_count + 1, sizeof *c->cut);
    c->cut[c->cut_count++] = (sn_cut_def){.at = at,
                                          .kind = SN_CUT_BOX,
                                          .low = {low[0], low[1], low[2]},
                                          .high = {high[0], high[1], high[2]}};
}

// every fifth cell or so, and all around one node
static inline int some_cells(const sn_mesh *mesh, bool *removed, int *list) {
    int count = 0;
    uint64_t seed = 11;
    for (int e = 0; e < mesh->cell_count; e++) {
        const int *node = mesh->cell + 4 * e, lone = mesh->node_count / 3;
        const bool around =
            node[0] == lone || node[1] == lone || node[2] == lone || node[3] == lone;
        removed[e] = check_random(&seed, 0, 1) < 0.2 || around;
        if (removed[e]) list[count++] = e;
    }
    return count;
}

// two tissues in a body whose cells are all different, or (classes) in one whose springs have class
// constants
static inline sn_case *make_body(int kind, bool classes, sn_precision precision) {
    static const int cells[3] = {9, 7, 7}; // several tiles of every kind
    sn_tissue t = demiray(2e3, 4, 4e4);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    if (!classes) jitter(c, 0.12, 5);
    c->mesh->region_count = 2;
    c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
    snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
    for (int e = 0; e < c->mesh->cell_count; e++)
        c->mesh->region[e] = c->mesh->node[3 * c->mesh->cell[4 * e]] > 0.031;
    c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
    c->tissue[1] = demiray(4e3, 3, 6e4);
    c->springs.precision = precision;
    c->springs.cuttable = true;
    set_kind(c, kind);
    return c;
}

// clamped at its left, pulled down; a slot is cut into it from above
static inline sn_case *hanging(int kind, double at) {
    static const int few[3] = {6, 3, 3};
    static const double low[3] = {0.018, -1, 0.012}, high[3] = {0.032, 1, 1};
    sn_tissue t = neo_hookean(1e4, 5e4);
    sn_case *c = make_block(size, few, SN_PATTERN_MIRRORED, &t);
    set_kind(c, kind);
    c->gravity[2] = -9.81;
    add_support(c, "left", "xyz");
    add_cut(c, at, low, high);
    c->until = 0.1;
    c->output_every = 0.02;
    return c;
}

static inline sn_run_summary run_quietly(const sn_case *c, sn_record **energy) {
    sn_record *history;
    sn_run_summary summary;
    sn_output output = {0};
    CHECK_OK(sn_record_create("e", energy));
    CHECK_OK(sn_record_create("h", &history));
    output.energy = *energy;
    CHECK_OK(sn_springs_run(c, &output, &summary, history));
    assert_true(summary.converged);
    sn_record_destroy(history);
    return summary;
}
