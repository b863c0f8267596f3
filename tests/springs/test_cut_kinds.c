// Cuts through bodies of all kinds: fibres, memories, tissues, loads and tools at once.
// SPDX-License-Identifier: Apache-2.0
#include "cuts.h"
#include "parted.h"
#include "springs/parts.h"
#include "springs/steps.h"

enum { SORTS = 4 }; // of tissue

// two tissues; a memory; fibres everywhere another way, with a memory for each part; both
static sn_case *make_sort(int sort, int kind, const int cells[3]) {
    sn_tissue t = neo_hookean(6e3, 5e4), other = demiray(3e3, 4, 6e4);
    if (sort >= 2) t = artery(3000, 0.1, 0.5, 4e4);
    if (sort == 1) t.memory = prony(0.3, 0.01, 0.2, 0.2);
    if (sort >= 2) part_memories(&t);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    if (sort >= 2) turn_fibres(c, 77);
    // a smoothed edge keeps the mean direction of all cells that it had
    for (int e = 1; e < c->fibres.count && kind / 2 == SN_RUNG_SMOOTHED; e++)
        memcpy(c->fibres.listed + 6 * e, c->fibres.listed, 6 * sizeof(double));
    if (sort % 3 == 0) {
        c->mesh->region_count = 2;
        c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
        snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
        for (int e = 0; e < c->mesh->cell_count; e++)
            c->mesh->region[e] = c->mesh->node[3 * c->mesh->cell[4 * e]] > 0.021;
        c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
        c->tissue[1] = other;
    }
    set_kind(c, kind);
    add_support(c, "left", "xyz");
    return c;
}

static void add_random_cut(sn_case *c, double at, double part, uint64_t seed) {
    c->cut = sn_resize(c->cut, (size_t)c->cut_count + 1, sizeof *c->cut);
    sn_cut_def *cut = &c->cut[c->cut_count++];
    *cut = (sn_cut_def){.at = at, .kind = SN_CUT_CELLS};
    cut->cell = sn_alloc((size_t)c->mesh->cell_count, sizeof *cut->cell);
    for (int e = 0; e < c->mesh->cell_count; e++)
        if (check_random(&seed, 0, 1) < part) cut->cell[cut->cell_count++] = e;
}

//---- equilibrium ---------------------------------------------------------------------------------

// the case of what a box leaves of the body of another
static sn_case *rest_of(sn_case *c, const sn_cut_def *cut) {
    bool *removed = sn_alloc((size_t)c->mesh->cell_count, sizeof *removed);
    int *list, count, kept = 0;
    sn_mesh *left;
    c->cut_count = 1;
    c->cut = sn_resize(c->cut, 1, sizeof *c->cut);
    c->cut[0] = *cut;
    CHECK_OK(sn_case_cut_cells(c, 0, &list, &count));
    c->cut_count = 0;
    for (int k = 0; k < count; k++) removed[list[k]] = true;
    CHECK_OK(sn_mesh_without(c->mesh, removed, &left, NULL));
    for (int e = 0; e < c->mesh->cell_count && c->fibres.count > 0; e++)
        if (!removed[e])
            memmove(c->fibres.listed + 6 * kept++, c->fibres.listed + 6 * e, 6 * sizeof(double));
    if (c->fibres.count > 0) c->fibres.count = kept;
    sn_mesh_destroy(c->mesh);
    c->mesh = left;
    sn_free(removed);
    sn_free(list);
    return c;
}

static sn_case *loaded(int sort, int kind) {
    sn_case *c = make_sort(sort, kind, (const int[3]){4, 3, 3});
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.003, 0, 0.001, 0.1);
    add_load(c, SN_LOAD_PRESSURE, "front", 0, 0, 0, 0.05)->pressure = 50;
    add_load(c, SN_LOAD_TRACTION, "top", 20, 0, 20, 0.05);
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
    add_probe(c, "base", SN_PROBE_REACTION, "left", 0, 0, 0);
    c->until = 0.2;
    c->output_every = 0.05;
    return c;
}

// Cut before it starts, a body has the whole history of one that never had the cells, with its
// memories and loads on faces that are left.
static void the_rest_has_its_history(void **state) {
    (void)state;
    static const sn_cut_def wound = {
        .kind = SN_CUT_BOX, .low = {0.016, -1, 0.026}, .high = {0.054, 1, 1}};
    for (int n = 0; n < SORTS * KINDS; n++) {
        const int sort = n / KINDS, kind = n % KINDS;
        sn_run_summary s[2];
        sn_record *h[2];
        for (int k = 0; k < 2; k++) {
            sn_case *c = loaded(sort, kind);
            if (k == 1)
                add_cut(c, 0, wound.low, wound.high);
            else
                rest_of(c, &wound);
            h[k] = run_case(c, &s[k]);
            assert_true(s[k].converged);
            sn_case_destroy(c);
        }
        assert_true(s[1].cells_removed > 0 && s[0].cells_removed == 0);
        assert_int_equal(s[0].cells, s[1].cells - s[1].cells_removed);
        assert_int_equal(h[0]->series_count, h[1]->series_count);
        double most = 0;
        for (int q = 1; q < h[0]->series_count; q++)
            for (int row = 0; row < h[0]->rows; row++)
                most = fmax(most, fabs(h[0]->series[q].value[row]));
        for (int q = 1; q < h[0]->series_count; q++)
            for (int row = 0; row < h[0]->rows; row++)
                CHECK_ABS(h[1]->series[q].value[row], h[0]->series[q].value[row],
                          1e-8 * most); // the steps are solved to 1e-10
        assert_true(most > 0.1);        // N
        for (int k = 0; k < 2; k++) sn_record_destroy(h[k]);
    }
}

//---- motion --------------------------------------------------------------------------------------

// pulled down, pushed on three faces, poked from above and held by the ball, cut at random twice
// and where the ball holds it
static sn_case *everything(int sort, int kind) {
    sn_case *c = make_sort(sort, kind, (const int[3]){6, 4, 4});
    c->springs.precision = (sort + kind) % 3 == 0 ? SN_SINGLE : SN_DOUBLE;
    c->springs.damping = kind % 2 ? 10 : 0;
    c->gravity[2] = -5;
    add_load(c, SN_LOAD_TRACTION, "right", 50, 0, -20, 0.02);
    add_load(c, SN_LOAD_PRESSURE, "front", 0, 0, 0, 0.02)->pressure = 80;
    add_tool(c, "ball", 0.01, (const double[]){0.03, 0.02, 0.0505}, (const double[]){0, 0, -0.02},
             0.05);
    c->tool[0].grasp[0] = sort % 2 ? 0.03 : 0;
    c->tool[0].grasp[1] = sort % 2 ? 0.06 : 0;
    add_random_cut(c, 0.02, 0.2, 11);
    add_cut(c, 0.0413, (const double[]){0.035, -1, 0.03}, (const double[]){0.055, 1, 1});
    add_random_cut(c, 0.0413, 0.3, 11); // some for the second time
    add_random_cut(c, 0.07, 0.1, 5);
    c->until = 0.1;
    c->output_every = 0.02;
    return c;
}

// At the step that a run chooses.
static void ledgers_close_whatever_is_cut(void **state) {
    (void)state;
    for (int n = 0; n < SORTS * KINDS; n++) {
        sn_case *c = everything(n / KINDS, n % KINDS);
        sn_record *energy;
        const sn_run_summary s = run_quietly(c, &energy);
        printf("sort %d kind %d: residual %.2g, step %.3g s, released %.2g of %.2g J\n", n / KINDS,
               n % KINDS, s.energy_residual, s.step_s, s.released_J, s.dissipated_J);
        // 0.9 of the limit of stability, where a motion of that frequency has an error of its own
        // size; measured at most 0.0006
        assert_true(s.energy_residual < 0.003);
        assert_true(s.cells_removed > s.cells / 3 && s.released_J > 0);
        sn_record_destroy(energy);
        sn_case_destroy(c);
    }
}

// All that a program can do between two steps, in the same one: nothing is lost on the way.
static void cuts_meet_tools(void **state) {
    (void)state;
    for (int n = 0; n < SORTS * KINDS; n++) {
        sn_case *c = everything(n / KINDS, n % KINDS);
        c->tool[0].grasp[0] = c->tool[0].grasp[1] = 0;
        c->springs.cuttable = true;
        c->cut_count = 0;
        body b = start(c);
        run_for(&b, 0.04);
        double before[3], after[3];
        int held = 0, *list, count;
        sn_state_tool_force(b.net, b.s, 0, before);
        assert_true(fabs(before[2]) > 0);
        if (n % 2) held = sn_state_grasp(b.net, b.s, 0, 0, NULL);
        assert_true(held > 0 || n % 2 == 0);
        c->cut_count = 4;
        for (int k = 0; k < 4; k++) {
            CHECK_OK(sn_case_cut_cells(c, k, &list, &count));
            CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL));
            CHECK_OK(sn_state_cut(b.net, b.s, count, list, &count));
            assert_int_equal(count, 0); // the second time
            sn_free(list);
        }
        for (int i = 0; i < b.net->nodes; i++)
            assert_true(!sn_state_is_loose(b.net, b.s, i) ||
                        b.s->grip[b.net->node_place[i]].tool < 0);
        sn_state_tool_force(b.net, b.s, 0, after);
        for (int d = 0; d < 3; d++) assert_true(isfinite(after[d]));
        run_for(&b, 0.03);
        assert_false(b.s->broken);
        for (int i = 0; i < 4 * b.net->nodes; i++)
            assert_true(isfinite(sn_real_at(b.s->precision, b.s->u, (size_t)i)));
        end(&b);
    }
}

//---- what hangs ----------------------------------------------------------------------------------

// a body of which two cuts at random leave half: rags on threads
static sn_case *rags(int kind) {
    sn_tissue t = demiray(3.8e3, 6.74, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    sn_case *c = make_block(size, (const int[]){6, 4, 5}, SN_PATTERN_MIRRORED, &t);
    set_kind(c, kind);
    c->springs.stiffness_damping = 1e-4;
    c->gravity[2] = -6.54;
    add_support(c, "left", "xyz");
    add_load(c, SN_LOAD_PRESSURE, "top", 0, 0, 0, 0.05)->pressure = 150;
    add_random_cut(c, 0.0102, 0.43, 11752204027220947258u);
    add_random_cut(c, 0.031, 0.33, 6858918808598774356u);
    c->until = 0.2;
    c->output_every = 0.05;
    return c;
}

// Rags stiffen by themselves, far from the mode that was the highest, and fold: the step follows
// (a search from that mode alone left one of them at 1.0 times the limit, and let it blow up), and
// cells that are turned inside out give no energy (of the central net the ledger lacked as much as
// the body had).
static void rags_keep_the_step(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        sn_case *c = rags(k);
        sn_record *energy;
        const sn_run_summary s = run_quietly(c, &energy);
        printf("rags, kind %d: residual %.2g, step %.3g s\n", k, s.energy_residual, s.step_s);
        assert_true(s.energy_residual < 0.01);
        sn_record_destroy(energy);
        sn_case_destroy(c);
    }
}

// Slots that fill up a block repeat a cell that may be gone: no step looks at them.
static void what_fills_is_gone_too(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        sn_case *c = make_sort(0, k, (const int[3]){3, 2, 2});
        c->springs.cuttable = true;
        body b = start(c);
        double *u = sn_alloc((size_t)b.net->nodes * 4, sizeof *u);
        uint64_t seed = 5;
        for (int i = 0; i < 4 * b.net->nodes; i++) u[i] = check_random(&seed, -1, 1);
        assert_true(sn_net_smallest_ratio(b.net, NULL, u) < 0);
        for (int e = 0; e < b.net->cells; e++) CHECK_OK(sn_state_cut(b.net, b.s, 1, &e, NULL));
        assert_true(isinf(sn_net_smallest_ratio(b.net, sn_state_parts(b.s), u)));
        sn_free(u);
        end(&b);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rest_has_its_history), cmocka_unit_test(ledgers_close_whatever_is_cut),
        cmocka_unit_test(cuts_meet_tools), cmocka_unit_test(rags_keep_the_step),
        cmocka_unit_test(what_fills_is_gone_too)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
