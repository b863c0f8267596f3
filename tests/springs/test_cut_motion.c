// Cuts in a body that moves: energy and momentum, pieces that fly, dust.
// SPDX-License-Identifier: Apache-2.0
#include "cuts.h"
#include "springs/parts.h"
#include "springs/state.h"

//---- energy --------------------------------------------------------------------------------------

// The residual of the explicit run is of second order in the step with the cut as without: what a
// ledger that misses some of it would lack does not depend on the step.
static void the_ledger_balances(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        double residual[2][2];
        for (int cut = 0; cut < 2; cut++)
            for (int half = 0; half < 2; half++) {
                sn_case *c = hanging(k, 0.041);
                if (!cut) c->cut_count = 0;
                c->springs.step = half ? 1e-4 : 2e-4;
                sn_record *energy;
                const sn_run_summary s = run_quietly(c, &energy);
                residual[cut][half] = s.energy_residual;
                assert_int_equal(s.cells_removed, cut ? 36 : 0);
                assert_true((double)s.steps < 1.01 * c->until / c->springs.step + 20);
                if (cut) {
                    assert_true(s.released_J > 1e-3 * s.elastic_J);
                    CHECK_REL(s.dissipated_J, s.released_J, 1e-12);
                    const double *lost = sn_record_values(energy, "dissipated_energy");
                    assert_true(lost[2] == 0); // at 40 ms
                    CHECK_REL(lost[3], s.released_J, 1e-12);
                }
                sn_record_destroy(energy);
                c->cut_count = 1;
                sn_case_destroy(c);
            }
        printf("residual without %.3g %.3g with a cut %.3g %.3g\n", residual[0][0], residual[0][1],
               residual[1][0], residual[1][1]);
        // a quarter, but for what is left of the fourth order and of output times
        assert_true(residual[1][1] < 0.35 * residual[1][0] || residual[1][1] < 1e-7);
        assert_true(residual[1][1] < 20 * residual[0][1]);
    }
}

// With memory and damping, by all integrators.
static void ledgers_of_all_kinds(void **state) {
    (void)state;
    for (int k = 0; k < 3 * 4; k++) {
        static const int kinds[4] = {0, 2, 3, 4};
        const sn_integrator integrator = (sn_integrator)(k / 4);
        double residual[2];
        for (int half = 0; half < 2; half++) {
            sn_case *c = hanging(kinds[k % 4], 0.041);
            c->tissue[0].memory = prony(0.3, 0.01, 0.2, 0.2);
            c->springs.integrator = integrator;
            c->springs.step = (integrator == SN_INTEGRATOR_EXPLICIT ? 2e-4 : 2e-3) / (1 + half);
            if (integrator != SN_INTEGRATOR_QUASI_STATIC) c->springs.damping = 20;
            if (integrator != SN_INTEGRATOR_QUASI_STATIC) c->springs.stiffness_damping = 1e-4;
            if (integrator == SN_INTEGRATOR_QUASI_STATIC) c->gravity[2] = -3;
            sn_record *energy;
            const sn_run_summary s = run_quietly(c, &energy);
            residual[half] = s.energy_residual;
            assert_int_equal(s.cells_removed, 36);
            assert_true(s.released_J > 0 && s.dissipated_J > s.released_J);
            // nothing comes back, but for the trapezoidal rule
            const double *lost = sn_record_values(energy, "dissipated_energy");
            for (int n = 1; n < energy->rows; n++)
                assert_true(lost[n] > lost[n - 1] - 1e-3 * lost[energy->rows - 1]);
            assert_true(lost[3] - lost[2] > 0.99 * s.released_J);
            sn_record_destroy(energy);
            sn_case_destroy(c);
        }
        printf("integrator %d kind %d: residual %.3g, of half the step %.3g\n", k / 4, kinds[k % 4],
               residual[0], residual[1]);
        // of second order, the implicit step after a cut (backward Euler) of first; in equilibrium
        // there is none by definition: see below
        if (integrator != SN_INTEGRATOR_QUASI_STATIC)
            assert_true(residual[1] <
                        (integrator == SN_INTEGRATOR_EXPLICIT ? 0.35 : 0.6) * residual[0]);
    }
}

//---- momentum ------------------------------------------------------------------------------------

// momentum at the present place: velocities are half a step behind
static void momentum(const body *b, double sum[4]) {
    sum[0] = sum[1] = sum[2] = sum[3] = 0;
    for (int i = 0; i < b->net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const size_t at = (size_t)(4 * i + d);
            const double m = b->net->mass[i], f = sn_real_at(b->s->precision, b->s->now.f, at);
            const double p =
                m * sn_real_at(b->s->precision, b->s->v, at) + 0.5 * b->s->last_step * f;
            sum[d] += p;
            sum[3] += fabs(p);
        }
}

static void cuts_take_no_momentum(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        const sn_precision precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        sn_case *c = make_body(k / 2, false, precision);
        c->tissue[0].memory = prony(0.3, 0.01, 0.2, 0.2);
        c->springs.stiffness_damping = 1e-5;
        body b = start(c);
        for (int i = 0; i < 40; i++)
            CHECK_OK(sn_state_push(b.net, b.s, 7 * i % b.net->nodes,
                                   (const double[]){1e-3 * i, 1e-3, -2e-3 * (i % 5)}));
        run_for(&b, 4e-3);
        bool *removed = sn_alloc((size_t)b.net->cells, sizeof *removed);
        int *list = sn_alloc((size_t)b.net->cells, sizeof *list);
        const int count = some_cells(c->mesh, removed, list);
        double before[4], after[4];
        momentum(&b, before);
        CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL));
        momentum(&b, after);
        for (int d = 0; d < 3; d++) // the rounding of 500 nodes
            CHECK_ABS(after[d], before[d], (precision == SN_DOUBLE ? 1e-14 : 1e-6) * before[3]);
        run_for(&b, 4e-3);
        assert_false(b.s->broken);
        sn_free(removed);
        sn_free(list);
        end(&b);
    }
}

//---- a bar in two --------------------------------------------------------------------------------

static double mean_of(const body *b, const void *array, bool right, int d) {
    double mass = 0, sum = 0;
    for (int i = 0; i < b->net->nodes; i++) {
        if ((b->net->node_position[3 * i] > 0.029) != right) continue;
        mass += b->net->mass[i];
        sum += b->net->mass[i] * sn_real_at(b->s->precision, array, (size_t)(4 * i + d));
    }
    return sum / mass;
}

// The loose part falls as a stone does, with damping by mass too; the other one swings.
static void a_bar_in_two(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        sn_case *c = hanging(k / 2, 1);
        c->cut_count = 0;
        c->springs.cuttable = true;
        c->springs.damping = k % 2 ? 30 : 0;
        c->springs.integrator =
            k % 2 == 0 && k / 2 % 2 ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_EXPLICIT;
        body b = start(c);
        run_for(&b, 0.03);
        c->cut_count = 1;
        memcpy(c->cut[0].low, (const double[3]){0.02, -1, -1}, 24);
        memcpy(c->cut[0].high, (const double[3]){0.03, 1, 1}, 24);
        int *list, count;
        CHECK_OK(sn_case_cut_cells(c, 0, &list, &count));
        assert_int_equal(count, 54);
        CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL));
        sn_free(list);
        int pieces;
        assert_non_null(sn_state_pieces(b.s, &pieces));
        assert_int_equal(pieces, 2);
        const double behind = b.s->implicit ? 0 : 0.5 * b.s->last_step, fall = 0.05;
        const double v = mean_of(&b, b.s->v, true, 2) - 9.81 * behind;
        const double u = mean_of(&b, b.s->u, true, 2), u0 = mean_of(&b, b.s->u, false, 2);
        const double t0 = b.s->time;
        double lowest = u0, highest = u0;
        while (b.s->time < t0 + fall - 1e-9) {
            sn_state_step(b.net, b.s, t0 + fall - b.s->time);
            lowest = fmin(lowest, mean_of(&b, b.s->u, false, 2));
            highest = fmax(highest, mean_of(&b, b.s->u, false, 2));
        }
        const double t = b.s->time - t0, way = mean_of(&b, b.s->u, true, 2) - u;
        // BDF2 starts the fall with a step of first order: 9.81 h^2 or so
        CHECK_ABS(way, v * t - 0.5 * 9.81 * t * t, b.s->implicit ? 2e-5 : 1e-9);
        assert_true(way < -0.01);
        assert_true(highest > u0 + 1e-5 && highest - lowest < 0.01); // it springs back
        assert_false(b.s->broken);
        end(&b);
    }
}

//---- all of it -----------------------------------------------------------------------------------

// Every cell removed, one by one in the end: dust that falls. Debris is no load on the step.
static void nothing_left(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        sn_tissue t = demiray(2e3, 60, 4e4); // overflows where a cell is drawn to many lengths
        t.memory = prony(0.3, 0.01, 0.2, 0.2);
        sn_case *c = make_block(size, (const int[]){4, 3, 3}, SN_PATTERN_MIRRORED, &t);
        set_kind(c, k / 2);
        c->springs.precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.cuttable = true;
        c->springs.damping = 5;
        c->gravity[2] = -9.81;
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_TRACTION, "right", 50, 0, 0, 0);
        add_load(c, SN_LOAD_PRESSURE, "top", 0, 0, 0, 0)->pressure = 50;
        body b = start(c);
        run_for(&b, 2e-3);
        const double step = b.s->last_step;
        sn_state_reset(b.net, b.s);
        for (int e = 0; e < b.net->cells; e++) {
            CHECK_OK(sn_state_cut(b.net, b.s, 1, &e, NULL));
            if (e % 16 == 0) run_for(&b, 1e-4);
        }
        assert_int_equal(sn_state_removed(b.s), b.net->cells);
        for (int i = 0; i < b.net->nodes; i++) assert_true(sn_state_is_loose(b.net, b.s, i));
        run_for(&b, 0.3);
        check_finite(&b);
        assert_int_equal(b.s->warnings, 0);
        assert_true(b.s->last_step > 0.5 * step || b.s->last_step > 1e-4);
        double lowest = 0;
        for (int i = 0; i < b.net->nodes; i++)
            lowest = fmin(lowest, sn_real_at(b.s->precision, b.s->u, (size_t)(4 * i + 2)));
        assert_true(lowest < -0.4); // 44 cm in 0.3 s

        // a reset mends it
        sn_state_reset(b.net, b.s);
        assert_null(sn_state_parts(b.s));
        body fresh = start(b.c);
        run_for(&b, 5e-3);
        run_for(&fresh, 5e-3);
        const size_t bytes = (size_t)b.net->nodes * 4 * (k % 2 ? 4 : 8);
        assert_memory_equal(b.s->u, fresh.s->u, bytes);
        sn_state_destroy(fresh.s);
        sn_net_destroy(fresh.net);
        end(&b);
    }
}

// The same through runs, of all integrators.
static void runs_of_dust(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_case *c = hanging(2 * k, 0.03);
        memcpy(c->cut[0].low, (const double[3]){-1, -1, -1}, 24);
        c->cut[0].high[0] = 1;
        c->springs.integrator = (sn_integrator)k;
        sn_record *energy;
        const sn_run_summary s = run_quietly(c, &energy);
        assert_int_equal(s.cells_removed, s.cells);
        assert_true(s.elastic_J == 0);
        CHECK_ABS(s.energy_residual, 0, 0.02);
        sn_record_destroy(energy);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ledger_balances),   cmocka_unit_test(ledgers_of_all_kinds),
        cmocka_unit_test(cuts_take_no_momentum), cmocka_unit_test(a_bar_in_two),
        cmocka_unit_test(nothing_left),          cmocka_unit_test(runs_of_dust)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
