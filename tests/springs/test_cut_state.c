// Cut states: threads, bytes, other nets.
// SPDX-License-Identifier: Apache-2.0
#include "cuts.h"
#include "kept.h"
#include "springs/state.h"

// The same with two threads as with one; bytes saved right after a cut bring the state back.
static void cuts_keep_bits(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        const sn_precision precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        body b[3];
        bool *removed = NULL;
        int *list = NULL, count = 0;
        for (int n = 0; n < 3; n++) {
            sn_case *c = make_body(k / 2, false, precision);
            c->tissue[1].memory = prony(0.3, 0.01, 0.2, 0.2);
            c->springs.threads = n == 1 ? 2 : 1;
            c->springs.damping = 10;
            c->gravity[0] = 9.81;
            add_support(c, "bottom", "xyz");
            b[n] = start(c);
            if (n == 2) continue;
            if (n == 0) {
                removed = sn_alloc((size_t)c->mesh->cell_count, sizeof *removed);
                list = sn_alloc((size_t)c->mesh->cell_count, sizeof *list);
                count = some_cells(c->mesh, removed, list);
            }
            run_for(&b[n], 3e-3);
            CHECK_OK(sn_state_cut(b[n].net, b[n].s, count, list, NULL));
            const size_t bytes = sn_state_size(b[n].net, b[n].s);
            unsigned char *saved = malloc(bytes);
            sn_state_save(b[n].net, b[n].s, saved);
            run_for(&b[n], 3e-3);
            unsigned char *later = malloc(bytes), *again = malloc(bytes);
            sn_state_save(b[n].net, b[n].s, later);
            CHECK_OK(sn_state_load(b[n].net, b[n].s, saved, bytes));
            run_for(&b[n], 3e-3);
            sn_state_save(b[n].net, b[n].s, again);
            assert_memory_equal(again, later, bytes);
            if (n == 0) { // into a state that was never cut
                CHECK_OK(sn_state_load(b[0].net, b[0].s, saved, bytes));
                sn_state_reset(b[0].net, b[0].s);
                CHECK_OK(sn_state_load(b[0].net, b[0].s, saved, bytes));
                run_for(&b[0], 3e-3);
                sn_state_save(b[0].net, b[0].s, again);
                assert_memory_equal(again, later, bytes);
            }
            free(saved);
            free(later);
            free(again);
        }
        const size_t bytes = (size_t)b[0].net->nodes * 4 * (k % 2 ? 4 : 8);
        assert_memory_equal(b[0].s->u, b[1].s->u, bytes);
        assert_memory_equal(b[0].s->v, b[1].s->v, bytes);
        run_for(&b[2], 6e-3);
        assert_true(memcmp(b[0].s->u, b[2].s->u, bytes) != 0);
        sn_free(removed);
        sn_free(list);
        for (int n = 0; n < 3; n++) end(&b[n]);
    }
}

// Cuts at an output and between two; stopped after each output in turn, a run ends the same.
static void cut_runs_go_on(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_case *c = hanging(2 * k, 0.04);
        c->springs.integrator = (sn_integrator)k;
        c->tissue[0].memory = prony(0.3, 0.01, 0.2, 0.2);
        add_cut(c, 0.03, (const double[3]){0.04, -1, -1}, (const double[3]){0.05, 0.015, 0.025});
        sn_run_summary first, second;
        sn_record *a = run_case(c, &first);
        assert_true(first.converged && first.cells_removed > 36);
        for (int stop = 1; stop <= 4; stop++) {
            keeper kept = run_killed(c, NULL, stop);
            sn_record *b = run_on(c, NULL, &kept, &second);
            check_same_rows(a, b);
            check_same_summary(first, second);
            sn_record_destroy(b);
            // another time of a cut is another case
            c->cut[1].at = 0.031;
            CHECK_RUN_ON_FAILS(c, NULL, &kept, SN_E_DEFINITION, "another net");
            c->cut[1].at = 0.03;
            free(kept.bytes);
        }
        sn_record_destroy(a);
        sn_case_destroy(c);
    }
}

// A net with other constants takes up what was cut.
static void moved_states_stay_cut(void **state) {
    (void)state;
    body b = start(make_body(0, false, SN_DOUBLE));
    sn_net *other, *whole;
    CHECK_OK(sn_tissue_set(&b.c->tissue[0], "c", 2500));
    CHECK_OK(sn_net_create(b.c, &other));
    b.c->springs.cuttable = false;
    CHECK_OK(sn_net_create(b.c, &whole));
    const int gone[3] = {3, 50, 51};
    int taken;
    CHECK_OK(sn_state_cut(b.net, b.s, 3, gone, NULL));
    CHECK_FAILS(sn_state_move(b.net, whole, b.s), SN_E_DEFINITION, "must be the same");
    CHECK_OK(sn_state_move(b.net, other, b.s));
    assert_true(sn_state_is_cut(other, b.s, 50));
    run_for(&(body){.net = other, .s = b.s}, 1e-3);
    CHECK_OK(sn_state_cut(other, b.s, 3, gone, &taken));
    assert_int_equal(taken, 0);

    CHECK_FAILS(sn_state_cut(b.net, b.s, 1, &(int){-1}, &taken), SN_E_RANGE, "cut of cell -1");
    CHECK_FAILS(sn_state_cut(b.net, b.s, 2, (int[]){9, b.net->cells}, &taken), SN_E_RANGE,
                "nothing was cut");
    assert_false(sn_state_is_cut(b.net, b.s, 9));
    sn_state *s;
    CHECK_OK(sn_state_create(whole, &s));
    CHECK_FAILS(sn_state_cut(whole, s, 1, gone, NULL), SN_E_UNSUPPORTED, "springs.cuttable");
    assert_false(sn_state_is_cut(whole, s, 3));
    sn_state_destroy(s);
    sn_net_destroy(other);
    sn_net_destroy(whole);
    end(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cuts_keep_bits),
                                       cmocka_unit_test(cut_runs_go_on),
                                       cmocka_unit_test(moved_states_stay_cut)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
