// What rules the explicit step while it runs: parts of a frame, contact, looks at the frequency.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "springs/bench.h"
#include "springs/steps.h"

static const double size[3] = {0.03, 0.03, 0.03};
static const int cells[3] = {3, 3, 3};

static double kinetic(const sn_net *net, const sn_state *s) {
    double sum = 0;
    for (int i = 0; i < net->nodes; i++)
        for (size_t d = 0; d < 3; d++) {
            const double v = sn_real_at(s->precision, s->v, 4 * (size_t)i + d);
            sum += 0.5 * net->mass[i] * v * v;
        }
    return sum;
}

// A frame of 1.46 steps, again and again. A whole step and what is left, in turn, are unstable:
// with x and y the two times the frequency, (x + y)^2 (1 - xy/4) > 4 for x = 1.8, y = 0.46 x. Equal
// parts of what is left are not.
static void frames_are_cut_into_equal_steps(void **state) {
    (void)state;
    const sn_springs_bench_plan plan = {
        .rung = SN_RUNG_CENTRAL, .volume = true, .cells = 6, .threads = 1, .precision = SN_SINGLE};
    double peak[2] = {0};
    for (int turns = 0; turns < 2; turns++) {
        sn_case *c;
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_springs_bench_case(&plan, &c));
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        const double frame = 1.46 * net->step;
        for (int n = 0; n < 400; n++)
            for (double left = frame; left > 1e-9;) {
                const double part = turns ? fmin(left, net->step) : left;
                const sn_step_info info = sn_state_step(net, s, part);
                if (!turns) CHECK_REL(info.step, 0.5 * frame, 1e-6);
                left -= info.step;
                peak[turns] = fmax(peak[turns], kinetic(net, s));
            }
        if (!turns) assert_int_equal(s->warnings, 0);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
    assert_true(peak[1] > 1.2 * peak[0]); // until shorter steps end it
}

// A block strikes a plane that is as stiff as what the engines choose, or a hundred times stiffer.
// Contact does not rule the step (explicit contact would need one 0.06 as long), vibrations that
// the blow leaves in tissue and contact do not grow, and momentum changes by the force on the tool.
// With friction on a slope too.
static void contact_leaves_the_step_alone(void **state) {
    (void)state;
    const double fall[] = {0.3, 1.0}, stiffer[] = {1, 100};
    for (int k = 0; k < 16; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.rung = k & 1 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        add_tool(c, "table", 0.01, (const double[]){0, 0, -1e-4}, (const double[]){0, 0, 0}, 1);
        c->tool[0].kind = SN_TOOL_PLANE;
        c->tool[0].axis[2] = 1;
        c->tool[0].axis[0] = k & 2 ? 0.2 : 0;
        c->tool[0].friction = k & 2 ? 0.4 : 0;
        const double down = fall[k >> 2 & 1];
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        for (int n = 0; n < net->contact_count; n++) net->contact_stiffness[n] *= stiffer[k >> 3];
        double mass = 0, momentum = 0, impulse = 0, before = 0, force = 0;
        for (int i = 0; i < net->nodes; i++) {
            ((double *)s->v)[4 * i + 2] = -down;
            mass += net->mass[i];
        }
        const double start = 0.5 * mass * down * down;
        int touched = 0;
        for (int n = 0; n < 600; n++) {
            const sn_step_info info = sn_state_step(net, s, 1);
            impulse += 0.5 * (before + info.step) * force; // from the middle to the middle
            before = info.step;
            force = -s->tool_force[0][2];
            touched += s->touching;
            assert_true(info.step > 0.3 * net->step); // the tissue stiffens, and is thrown about
            // velocities belong to the middle of a step: a little more than energy allows
            assert_true(kinetic(net, s) < 1.1 * start);
        }
        for (int i = 0; i < net->nodes; i++) momentum += net->mass[i] * ((double *)s->v)[4 * i + 2];
        assert_true(touched > 3);
        assert_int_equal(s->warnings, 0);
        assert_true(momentum > 0);                        // it came back, or slid up the slope
        CHECK_REL(momentum + mass * down, impulse, 1e-9); // but for the rounding of sums
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// a block of central springs with volume, wholly stretched by `part`
static void stretch(const sn_net *net, sn_state *s, double part) {
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            sn_real_put(s->precision, s->u, 4 * (size_t)i + (size_t)d,
                        (d == 0 ? part : -0.4 * part) * net->node_position[3 * i + d]);
}

static sn_case *stretchy(sn_precision precision, int threads) {
    sn_tissue t = make_tissue("exponential");
    CHECK_OK(sn_tissue_set(&t, "B", 8));
    CHECK_OK(sn_tissue_set(&t, "C", 1e4));
    t.poissons_ratio = 0.4;
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    c->springs.rung = SN_RUNG_CENTRAL;
    c->springs.volume = true;
    c->springs.precision = precision;
    c->springs.threads = threads;
    return c;
}

// A look in parts finds what a search at once finds, and both see that the net has stiffened.
static void looks_find_the_frequency(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_case *c = stretchy(k ? SN_SINGLE : SN_DOUBLE, 1);
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        stretch(net, s, 0.25);
        sn_state_find_frequency(net, s);
        const double right = s->seen_omega2;
        assert_true(right > 1.5 * net->omega2);
        sn_state_rest_frequency(net, s);
        int calls = 0, looks = 0;
        for (; looks < 12; looks++) { // each goes on from the mode of the one before
            s->check_in = 1;
            do sn_state_follow_frequency(net, s, 0);
            while (++calls < 1000 && s->look.done > 0);
        }
        assert_true(calls >= 8 * looks);        // no look at once
        CHECK_REL(s->seen_omega2, right, 0.03); // both come from below; 10 steps against 12 times 2
        assert_true(s->omega2 >= s->seen_omega2);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A state that is saved in the middle of a look goes on with the same bits, on two threads too.
static void looks_are_part_of_the_bytes(void **state) {
    (void)state;
    for (int threads = 1; threads <= 2; threads++) {
        sn_case *one = stretchy(SN_SINGLE, 1), *other = stretchy(SN_SINGLE, threads);
        sn_net *net, *many;
        sn_state *a, *b;
        CHECK_OK(sn_net_create(one, &net));
        CHECK_OK(sn_net_create(other, &many));
        CHECK_OK(sn_state_create(net, &a));
        CHECK_OK(sn_state_create(many, &b));
        stretch(net, a, 0.1);
        const int tasks = sn_net_force_tasks(net);
        const size_t bytes = sn_state_size(net, a);
        unsigned char *saved = malloc(bytes), *later = malloc(bytes), *again = malloc(bytes);
        int met[3] = {0}; // evaluations that were under way
        for (int n = 0; n < 3000; n++) {
            sn_state_step(net, a, 1);
            if (a->look.done == 0 || met[a->look.done / tasks] > 2) continue;
            met[a->look.done / tasks]++;
            sn_state_save(net, a, saved);
            for (int k = 0; k < 40; k++) sn_state_step(net, a, 1);
            sn_state_save(net, a, later);
            CHECK_OK(sn_state_load(many, b, saved, bytes));
            for (int k = 0; k < 40; k++) sn_state_step(many, b, 1);
            sn_state_save(many, b, again);
            assert_memory_equal(again, later, bytes);
        }
        for (int k = 0; k < 3; k++) assert_true(met[k] > 0);
        free(saved);
        free(later);
        free(again);
        sn_state_destroy(a);
        sn_state_destroy(b);
        sn_net_destroy(net);
        sn_net_destroy(many);
        sn_case_destroy(one);
        sn_case_destroy(other);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(frames_are_cut_into_equal_steps),
                                       cmocka_unit_test(contact_leaves_the_step_alone),
                                       cmocka_unit_test(looks_find_the_frequency),
                                       cmocka_unit_test(looks_are_part_of_the_bytes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
