// A run that is stopped at an output and goes on gives the numbers of one that was not; what is
// written where Newton gives up.
// SPDX-License-Identifier: Apache-2.0
#include "body.h"

typedef struct session {
    int frames, stop_at; ///< the frame at which the run is killed; 0: never
    unsigned char *bytes;
    size_t count;
    double last; ///< time of the last frame
} session;

static sn_status count_frame(void *context, const sn_frame *frame) {
    session *s = context;
    s->last = frame->time;
    if (++s->frames == s->stop_at) return sn_fail(SN_E_STOPPED, "killed");
    return SN_OK;
}

static sn_status keep_state(void *context, const void *bytes, size_t count) {
    session *s = context;
    sn_free(s->bytes);
    s->bytes = sn_alloc(count, 1);
    assert_non_null(s->bytes);
    memcpy(s->bytes, bytes, count);
    s->count = count;
    return SN_OK;
}

// 0: quasi-static with memory and friction, 1: dynamic with memory and steps
// by accuracy, 2: dynamic incompressible
static sn_case *course(int kind) {
    const double prony[] = {0.4, 0.05};
    sn_tissue t = neo_hookean(3000, kind == 2 ? (double)INFINITY : 2e4);
    if (kind < 2) body_set_memory(&t, "prony", 1, prony, 2);
    sn_case *c = body_block(0.02, 0.02, 0.01, 3, 3, 2, &t, kind ? SN_ELEMENT_P2P1 : SN_ELEMENT_P1);
    body_support(c, "bottom", true, true, true);
    if (kind == 0) {
        const double time[3] = {0, 0.5, 1}, at[9] = {0, 0, 0, 0, 0, -0.002, 0.001, 0, -0.002};
        sn_history *path;
        CHECK_OK(sn_history_create(3, 3, time, at, &path));
        c->tool[c->tool_count++] = (sn_tool){.name = "ball",
                                             .radius = 0.006,
                                             .at = {0.0101, 0.0098, 0.0165},
                                             .path = path,
                                             .friction = 0.3};
    } else {
        body_pull(c, "right", 100, 0, 200, make_ramp(0, 0.03));
        c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
    }
    c->until = kind ? 0.05 : 1;
    c->output_every = c->until / 5;
    c->continuum.steps = 10;
    if (kind == 1) c->continuum.step_tolerance = 1e-3;
    body_probe(c, "tip", 0.02, 0.01, 0.01);
    body_reaction(c, "base", "bottom");
    return c;
}

static void goes_on(void **state) {
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        sn_case *c = course(kind);
        sn_run_summary whole, part;
        sn_record *a, *b;
        session all = {.stop_at = 0}; // saves too: factors are dropped at every save
        const sn_output counted = {.context = &all, .frame = count_frame};
        const sn_restart kept = {.context = &all, .save = keep_state};
        CHECK_OK(sn_record_create("whole", &a));
        CHECK_OK(sn_continuum_resume(c, &counted, &kept, &whole, a));
        sn_free(all.bytes);
        session s = {.stop_at = 4}; // killed while the fourth frame is written: third is the last
        sn_output output = {.context = &s, .frame = count_frame};
        sn_restart restart = {.context = &s, .save = keep_state};
        CHECK_OK(sn_record_create("part", &b));
        CHECK_FAILS(sn_continuum_resume(c, &output, &restart, &part, b), SN_E_STOPPED, "killed");
        sn_record_destroy(b);
        assert_non_null(s.bytes);
        s.stop_at = s.frames = 0;
        size_t count = s.count;
        unsigned char *bytes = s.bytes;
        s.bytes = NULL;
        restart.state = bytes;
        restart.bytes = count;
        CHECK_OK(sn_record_create("part", &b));
        CHECK_OK(sn_continuum_resume(c, &output, &restart, &part, b));
        assert_true(part.converged);
        assert_int_equal(s.frames, 3); // 0.6, 0.8 and 1 of the whole; three were there
        assert_int_equal(a->rows, b->rows);
        for (int k = 0; k < a->series_count; k++)
            for (int n = 0; n < a->rows; n++) // to the last bit
                assert_true(a->series[k].value[n] == b->series[k].value[n]);
        assert_true(whole.external_work_J == part.external_work_J);
        assert_true(whole.elastic_J == part.elastic_J && whole.kinetic_J == part.kinetic_J);
        assert_int_equal(whole.steps, part.steps);
        assert_int_equal(whole.newton_iterations, part.newton_iterations);
        sn_record_destroy(b);
        sn_record_destroy(a);

        // another case, a short file, a damaged head
        CHECK_OK(sn_record_create("part", &b));
        c->load_count ? (c->load[0].vector[0] += 1) : (c->tool[0].at[0] += 1e-5);
        CHECK_FAILS(sn_continuum_resume(c, &output, &restart, &part, b), SN_E_DATA,
                    "not of this case");
        c->load_count ? (c->load[0].vector[0] -= 1) : (c->tool[0].at[0] -= 1e-5);
        sn_record_destroy(b);
        sn_case_destroy(c);
        c = course(kind);
        CHECK_OK(sn_record_create("part", &b));
        restart.bytes = count - 8;
        CHECK_FAILS(sn_continuum_resume(c, &output, &restart, &part, b), SN_E_DATA, "damaged");
        restart.bytes = 12;
        CHECK_FAILS(sn_continuum_resume(c, &output, &restart, &part, b), SN_E_DATA, "damaged");
        sn_free(s.bytes);
        sn_free(bytes);
        sn_record_destroy(b);
        sn_case_destroy(c);
    }
}

// Pressed through its floor: the last state that converged is written although no output is due.
static void last_state(void **state) {
    (void)state;
    for (int dynamic = 0; dynamic < 2; dynamic++) {
        sn_tissue t = neo_hookean(2000, 1e4);
        sn_case *c = body_block(0.01, 0.01, 0.01, 2, 2, 2, &t, SN_ELEMENT_P1);
        body_support(c, "bottom", true, true, true);
        body_move(c, "top", 0, 0, -0.012, make_ramp(0, 1));
        body_reaction(c, "floor", "bottom");
        if (dynamic) c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
        c->continuum.steps = 10;
        session s = {0};
        sn_output output = {.context = &s, .frame = count_frame};
        sn_run_summary summary;
        sn_record *r;
        CHECK_OK(sn_record_create("test", &r));
        CHECK_OK(sn_continuum_run(c, &output, &summary, r));
        assert_false(summary.converged);
        assert_non_null(strstr(summary.reason, "stopped at"));
        assert_int_equal(s.frames, 2); // rest and the last
        assert_int_equal(r->rows, 2);
        CHECK_ABS(s.last, summary.simulated_s, 1e-12);
        assert_true(s.last > 0.1 && s.last < 0.9);
        assert_true(last_value(r, "floor_fz") > 0.05); // it pushes up
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(goes_on), cmocka_unit_test(last_state)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
