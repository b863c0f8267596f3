// States that a program drives: bytes and back, what it imposes between steps, and bad input.
// SPDX-License-Identifier: Apache-2.0
#include "kept.h"
#include "springs/net.h"

static const double size[3] = {0.04, 0.02, 0.02};
static const int cells[3] = {4, 2, 2};

// clamped below, poked from above by a sphere just off the top, loaded at its right
static sn_case *some_case(sn_precision precision, sn_rung rung) {
    sn_tissue t = demiray(2e3, 4, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    c->springs.precision = precision;
    c->springs.rung = rung;
    c->springs.damping = 20;
    c->gravity[2] = -9.81;
    add_support(c, "bottom", "xyz");
    add_load(c, SN_LOAD_TRACTION, "right", 50, 0, 0, 0.05);
    add_tool(c, "probe", 0.01, (const double[]){0.02, 0.01, 0.0301}, (const double[]){0, 0, -0.004},
             0.1);
    c->tool[0].friction = 0.3;
    c->until = 0.2;
    c->output_every = 0.05;
    return c;
}

//---- bytes ---------------------------------------------------------------------------------------

static void bytes_bring_a_state_back(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_case *c =
            some_case(k % 2 ? SN_SINGLE : SN_DOUBLE, k / 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED);
        sn_net *net;
        sn_state *a, *b;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &a));
        CHECK_OK(sn_state_create(net, &b));
        CHECK_OK(sn_state_push(net, a, 3, (const double[]){0, 1e-3, 0}));
        CHECK_OK(sn_state_set_load(net, a, 0, 0.7));
        for (int n = 0; n < 300; n++) sn_state_step(net, a, 1e-3);
        const size_t bytes = sn_state_size(net, a);
        unsigned char *saved = malloc(bytes), *later = malloc(bytes), *again = malloc(bytes);
        sn_state_save(net, a, saved);
        for (int n = 0; n < 300; n++) sn_state_step(net, a, 1e-3);
        sn_state_save(net, a, later);
        CHECK_OK(sn_state_load(net, b, saved, bytes));
        sn_state_save(net, b, again);
        assert_memory_equal(again, saved, bytes);
        for (int n = 0; n < 300; n++) sn_state_step(net, b, 1e-3);
        sn_state_save(net, b, again);
        assert_memory_equal(again, later, bytes);
        assert_true(memcmp(saved, later, bytes) != 0);

        saved[bytes - 7] ^= 1; // one bit
        CHECK_FAILS(sn_state_load(net, b, saved, bytes), SN_E_DATA, "damaged");
        saved[bytes - 7] ^= 1;
        CHECK_FAILS(sn_state_load(net, b, saved, bytes - 1), SN_E_DATA, "damaged");
        CHECK_FAILS(sn_state_load(net, b, "SNSTATE", 8), SN_E_DATA, "no state of the springs");
        saved[8]++; // the format's version
        CHECK_FAILS(sn_state_load(net, b, saved, bytes), SN_E_UNSUPPORTED, "another version");
        saved[8]--;
        sn_state_save(net, b, again);
        assert_memory_equal(again, later, bytes); // refusals left it alone

        sn_net *other;
        CHECK_OK(sn_tissue_set(&c->tissue[0], "c", 2001));
        CHECK_OK(sn_net_create(c, &other));
        CHECK_FAILS(sn_state_load(other, b, saved, bytes), SN_E_DEFINITION, "another net");
        sn_net_destroy(other);
        free(saved);
        free(later);
        free(again);
        sn_state_destroy(a);
        sn_state_destroy(b);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

//---- runs ----------------------------------------------------------------------------------------

typedef struct watcher {
    int frames, nodes, cells;
    double sum; ///< of all numbers of the last frame
} watcher;

static sn_status take_frame(void *context, const sn_frame *frame) {
    watcher *w = context;
    w->sum = 0;
    for (int f = 0; f < frame->field_count; f++) {
        const sn_field *field = &frame->fields[f];
        int count = field->components * (field->place == SN_ON_NODES ? w->nodes : w->cells);
        for (int n = 0; n < count; n++) w->sum += (n % 7 + 1) * field->value[n];
    }
    w->frames++;
    return SN_OK;
}

// Stopped after each of its outputs in turn, a run ends with the same bits.
static void runs_go_on_where_they_were(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_case *c =
            some_case(k == 1 ? SN_SINGLE : SN_DOUBLE, k == 1 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED);
        if (k >= 2)
            c->springs.integrator = k == 2 ? SN_INTEGRATOR_QUASI_STATIC : SN_INTEGRATOR_IMPLICIT;
        if (k == 3) c->springs.damping = 5;
        c->tool[0].grasp[0] = k == 0 ? 0.07 : 0;
        c->tool[0].grasp[1] = k == 0 ? 0.12 : 0;
        add_probe(c, "foot", SN_PROBE_REACTION, "bottom", 0, 0, 0);
        watcher whole = {.nodes = c->mesh->node_count, .cells = c->mesh->cell_count};
        sn_output output = {.context = &whole, .frame = take_frame};
        sn_run_summary first, second;
        sn_record *a, *b, *e, *f;
        CHECK_OK(sn_record_create("a", &a));
        CHECK_OK(sn_record_create("e", &e));
        output.energy = e;
        CHECK_OK(sn_springs_run(c, &output, &first, a));
        assert_true(first.converged);
        assert_int_equal(a->rows, 5);
        for (int stop = 1; stop <= 4; stop++) {
            watcher part = whole;
            output.context = &part;
            CHECK_OK(sn_record_create("f", &f));
            output.energy = f;
            keeper kept = run_killed(c, &output, stop);
            sn_record_destroy(f);
            CHECK_OK(sn_record_create("f", &f));
            output.energy = f;
            part.frames = 0;
            b = run_on(c, &output, &kept, &second);
            assert_int_equal(part.frames, 5 - stop);
            assert_true(part.sum == whole.sum);
            check_same_rows(a, b);
            assert_int_equal(e->series_count, 7);
            check_same_rows(e, f);
            check_same_summary(first, second);
            kept.size--;
            CHECK_RUN_ON_FAILS(c, &output, &kept, SN_E_DATA, "damaged");
            kept.size++;
            c->until = 0.3;
            CHECK_RUN_ON_FAILS(c, &output, &kept, SN_E_DEFINITION, "another net");
            c->until = 0.2;
            sn_record_destroy(b);
            sn_record_destroy(f);
            free(kept.bytes);
        }
        sn_record_destroy(e);
        sn_record_destroy(a);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bytes_bring_a_state_back),
                                       cmocka_unit_test(runs_go_on_where_they_were)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
