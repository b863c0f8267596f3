// Runs: contact, output, what is refused, giving up with a reason, the schedule.
// SPDX-License-Identifier: Apache-2.0
#include "body.h"
#include "continuum/schedule.h"

static void indent(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(2000, 2e4);
    double force[3];
    for (int e = 0; e < 3; e++) {
        sn_case *c = body_block(0.03, 0.03, 0.015, 6, 6, 3, &t, (sn_element)e);
        body_support(c, "bottom", true, true, true);
        sn_history *path;
        const double time[3] = {0, 1, 2}, at[9] = {0, 0, 0, 0, 0, -0.004, 0.001, 0, -0.004};
        CHECK_OK(sn_history_create(3, 3, time, at, &path));
        c->tool[c->tool_count++] = (sn_tool){.name = "ball",
                                             .radius = 0.008,
                                             .at = {0.0151, 0.0148, 0.0235},
                                             .path = path,
                                             .friction = 0.3};
        body_reaction(c, "base", "bottom");
        c->until = 2;
        c->continuum.steps = 10;
        c->continuum.tolerance = 1e-9;
        sn_run_summary summary;
        sn_record *r = body_run(c, NULL, &summary);
        // balance: the base carries what the ball pushes
        double size = 0, difference = 0;
        for (int k = 0; k < 3; k++) {
            const char *const base[] = {"base_fx", "base_fy", "base_fz"};
            const char *const ball[] = {"ball_fx", "ball_fy", "ball_fz"};
            size += pow(last_value(r, base[k]), 2);
            difference += pow(last_value(r, base[k]) - last_value(r, ball[k]), 2);
        }
        CHECK_ABS(sqrt(difference / size), 0, 1e-7); // 1e-9 of a residual summed over many nodes
        // it pushes down, so the base pushes up; and dragged to +x it is held back by friction
        assert_true(sn_record_values(r, "ball_fz")[1] > 0);
        assert_true(fabs(sn_record_values(r, "ball_fz")[0]) == 0);
        assert_true(last_value(r, "ball_fx") < -0.05 * last_value(r, "ball_fz"));
        force[e] = sn_record_values(r, "ball_fz")[1];
        if (getenv("SINEW_SHOW"))
            print_message("%s: %.4f N, %ld steps, %d iterations, %d cutbacks\n", summary.model,
                          force[e], summary.steps, summary.newton_iterations, summary.cutbacks);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    // linear cells are stiffer on so coarse a mesh, the two quadratic ones agree
    CHECK_REL(force[0], force[2], 0.3);
    CHECK_REL(force[1], force[2], 0.05);
}

typedef struct seen {
    int frames;
    double time[8], volume, pressure;
    const sn_case *c;
    int told;
} seen;

static sn_status look(void *context, const sn_frame *frame) {
    seen *s = context;
    static const char *const name[] = {"displacement",       "pressure",       "green_strain",
                                       "cauchy_stress",      "energy_density", "second_pk_stress",
                                       "principal_stretches"};
    static const int components[] = {3, 1, 6, 6, 1, 6, 3};
    assert_int_equal(frame->field_count, 7);
    for (int k = 0; k < 7; k++) {
        assert_string_equal(frame->fields[k].name, name[k]);
        assert_int_equal(frame->fields[k].components, components[k]);
        assert_int_equal(frame->fields[k].place, k < 2 ? SN_ON_NODES : SN_ON_CELLS);
    }
    s->time[s->frames++] = frame->time;
    s->pressure = frame->fields[1].value[0];
    const double *sigma = frame->fields[3].value;
    // uniaxial: sigma_xx alone, so that the pressure is -sigma_xx/3 everywhere
    for (int a = 0; a < s->c->mesh->node_count && frame->time > 0; a++)
        CHECK_REL(frame->fields[1].value[a], -sigma[0] / 3, 1e-6);
    for (int n = 0; n < s->c->mesh->cell_count && frame->time > 0; n++) {
        CHECK_REL(frame->fields[3].value[6 * n], sigma[0], 1e-6);
        for (int k = 1; k < 6; k++)
            CHECK_ABS(frame->fields[3].value[6 * n + k] / sigma[0], 0, 1e-6);
        // sigma = l1/(l2 l3) S11 along the first axis; Green strain from the same stretches
        const double *l = frame->fields[6].value + 3 * n, *S = frame->fields[5].value + 6 * n;
        CHECK_REL(S[0], sigma[0] * l[1] * l[2] / l[0], 1e-6);
        for (int k = 1; k < 6; k++) CHECK_ABS(S[k] / S[0], 0, 1e-6);
        for (int k = 0; k < 3; k++)
            CHECK_REL(l[k], sqrt(1 + 2 * frame->fields[2].value[6 * n + k]), 1e-6);
    }
    return SN_OK;
}

static void frames(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(2000, 5e4);
    for (int e = 0; e < 3; e++) {
        sn_case *c = body_block(0.03, 0.02, 0.015, 2, 1, 1, &t, (sn_element)e);
        body_rollers(c);
        body_pull(c, "right", 800, 0, 0, make_ramp(0, 0.7));
        body_reaction(c, "wall", "left");
        c->output_every = 0.4; // 0, 0.4, 0.8 and the end
        seen s = {.c = c};
        sn_output output = {.context = &s, .frame = look};
        sn_run_summary summary;
        sn_record *r = body_run(c, &output, &summary);
        assert_int_equal(s.frames, 4);
        static const double time[] = {0, 0.4, 0.8, 1};
        for (int k = 0; k < 4; k++) CHECK_ABS(s.time[k], time[k], 1e-12);
        CHECK_REL(last_value(r, "wall_fx"), -800 * 3e-4, 1e-8);
        assert_true(s.pressure < -800 / 3.0); // tension; Cauchy exceeds nominal stress
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

static sn_status refuse(void *context, const sn_frame *frame) {
    (void)context;
    return frame->time > 0 ? sn_fail(SN_E_FILE, "the disk is full") : SN_OK;
}

static void refusals(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(2000, (double)INFINITY);
    sn_run_summary summary;
    sn_record *r;
    CHECK_OK(sn_record_create("test", &r));

    sn_case *c = body_block(0.03, 0.02, 0.015, 2, 1, 1, &t, SN_ELEMENT_P1);
    body_rollers(c);
    CHECK_FAILS(sn_continuum_run(c, NULL, &summary, r), SN_E_UNSUPPORTED, "P2P1");
    c->continuum.element = SN_ELEMENT_P2;
    CHECK_FAILS(sn_continuum_run(c, NULL, &summary, r), SN_E_UNSUPPORTED, "P2P1");
    c->continuum.element = SN_ELEMENT_P2P1;
    c->support_count = 1; // left x only
    body_pull(c, "top", 0, 300, 0, NULL);
    CHECK_FAILS(sn_continuum_run(c, NULL, &summary, r), SN_E_DEFINITION, "along y");
    c->load_count = 0;
    c->support_count = 3;
    c->continuum.tolerance = 0;
    CHECK_FAILS(sn_continuum_run(c, NULL, &summary, r), SN_E_RANGE, "tolerance");
    c->continuum.tolerance = 1e-9;
    sn_output output = {.frame = refuse};
    CHECK_FAILS(sn_continuum_run(c, &output, &summary, r), SN_E_FILE, "disk is full");

    c->tissue->law = sn_law_find("exponential");
    sn_param_defaults(c->tissue->law->params, c->tissue->law->param_count, 0, c->tissue->value);
    CHECK_OK(sn_tissue_set(c->tissue, "B", 15));
    CHECK_OK(sn_tissue_set(c->tissue, "C", 2e4));
    c->tissue->poissons_ratio = 0.25;
    CHECK_FAILS(sn_continuum_run(c, NULL, &summary, r), SN_E_UNSUPPORTED, "neo-hookean");
    sn_case_destroy(c);

    sn_tissue light = neo_hookean(2000, 1e4);
    light.density = (double)NAN;
    c = body_block(0.03, 0.02, 0.015, 2, 1, 1, &light, SN_ELEMENT_P1);
    body_rollers(c);
    c->gravity[2] = -9.81;
    sn_status status = sn_continuum_run(c, NULL, &summary, r);
    assert_true(status == SN_E_DEFINITION || status == SN_E_RANGE);
    assert_non_null(strstr(sn_error_text(), "density"));
    sn_case_destroy(c);
    sn_record_destroy(r);
}

// A block pressed through its own floor cannot be solved: the run ends with a reason, keeps what
// converged before and is no error.
static void gives_up(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(2000, 1e4);
    sn_case *c = body_block(0.01, 0.01, 0.01, 2, 2, 2, &t, SN_ELEMENT_P1);
    body_support(c, "bottom", true, true, true);
    body_move(c, "top", 0, 0, -0.012, make_ramp(0, 1));
    c->output_every = 0.1;
    c->continuum.steps = 10;
    sn_run_summary summary;
    sn_record *r;
    CHECK_OK(sn_record_create("test", &r));
    CHECK_OK(sn_continuum_run(c, NULL, &summary, r));
    assert_false(summary.converged);
    assert_non_null(strstr(summary.reason, "stopped at"));
    assert_true(summary.cutbacks >= 12);
    assert_true(summary.simulated_s > 0.3 && summary.simulated_s < 0.9);
    assert_true(r->rows >= 4);
    if (getenv("SINEW_SHOW")) print_message("%s\n", summary.reason);
    sn_record_destroy(r);
    sn_case_destroy(c);
}

static void schedule(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(2000, 1e4);
    sn_case *c = body_block(0.01, 0.01, 0.01, 1, 1, 1, &t, SN_ELEMENT_P1);
    body_move(c, "top", 0, 0, 0.001, make_ramp(0.25, 0.5));
    c->output_every = 0.3;
    c->continuum.steps = 8;
    sn_fe_schedule s;
    for (int graded = 0; graded < 2; graded++) {
        static const double stop[] = {0, 0.25, 0.3, 0.6, 0.75, 0.9, 1};
        static const bool output[] = {true, false, true, true, false, true, true};
        CHECK_OK(sn_fe_schedule_create(c, graded, &s));
        assert_int_equal(s.count, 7);
        for (int k = 0; k < 7; k++) {
            CHECK_ABS(s.stop[k].time, stop[k], 1e-14);
            assert_true(s.stop[k].output == output[k]);
            assert_true(s.stop[k].corner == (k == 0 || k == 1 || k == 4));
            assert_true(isinf(s.stop[k].first) == !(graded && s.stop[k].corner));
        }
        CHECK_ABS(s.shortest, graded ? 0.25 / 20 : 0.125, 1e-14);
        CHECK_ABS(sn_fe_schedule_step(&s, 3, 0.3, (double)INFINITY), 0.1, 1e-14);
        CHECK_ABS(sn_fe_schedule_step(&s, 3, 0.59, 0.02), 0.01, 1e-14);
        sn_fe_schedule_free(&s);
    }
    c->until = 0;
    CHECK_FAILS(sn_fe_schedule_create(c, false, &s), SN_E_DEFINITION, "until");
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(indent), cmocka_unit_test(frames),
                                       cmocka_unit_test(refusals), cmocka_unit_test(gives_up),
                                       cmocka_unit_test(schedule)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
