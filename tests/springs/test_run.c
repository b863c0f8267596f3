// What runs hand out: frames, rows, summaries, reasons; steps allocate nothing.
// SPDX-License-Identifier: Apache-2.0
#include "allocator.h"
#include "bodies.h"
#include "springs/moment.h"
#include "springs/state.h"

static const double size[3] = {0.04, 0.02, 0.02};
static const int cells[3] = {4, 2, 2};

typedef struct seen {
    const sn_case *c;
    int frames, fail_at, told;
    double time[64], stress[6], strain[6], energy, pressure, worst;
} seen;

static const sn_field *field(const sn_frame *frame, const char *name, const char *unit,
                             sn_place place, int components) {
    for (int k = 0; k < frame->field_count; k++) {
        const sn_field *f = &frame->fields[k];
        if (strcmp(f->name, name)) continue;
        assert_string_equal(f->unit, unit);
        assert_int_equal(f->place, place);
        assert_int_equal(f->components, components);
        return f;
    }
    fail_msg("no field %s", name);
    return NULL;
}

static sn_status look(void *context, const sn_frame *frame) {
    seen *s = context;
    const int n = s->c->mesh->cell_count;
    const sn_field *u = field(frame, "displacement", "m", SN_ON_NODES, 3);
    const sn_field *v = field(frame, "velocity", "m/s", SN_ON_NODES, 3);
    const sn_field *p = field(frame, "pressure", "Pa", SN_ON_NODES, 1);
    const sn_field *E = field(frame, "green_strain", "1", SN_ON_CELLS, 6);
    const sn_field *T = field(frame, "cauchy_stress", "Pa", SN_ON_CELLS, 6);
    const sn_field *W = field(frame, "energy_density", "J/m3", SN_ON_CELLS, 1);
    for (int i = 0; i < 3 * s->c->mesh->node_count; i++)
        assert_true(isfinite(u->value[i]) && isfinite(v->value[i]));
    s->time[s->frames++] = frame->time;
    s->worst = 0;
    for (int k = 0; k < 6; k++) {
        s->strain[k] = E->value[6 * (n / 2) + k];
        s->stress[k] = T->value[6 * (n / 2) + k];
        for (int e = 0; e < n; e++)
            s->worst = fmax(s->worst, fabs(T->value[6 * e + k] - s->stress[k]));
    }
    s->energy = W->value[n / 2];
    s->pressure = p->value[s->c->mesh->node_count / 2];
    return s->frames == s->fail_at ? sn_fail(SN_E_STOPPED, "enough") : SN_OK;
}

static void tell(void *context, double done, const char *text) {
    assert_true(done >= 0 && done <= 1 && text[0]);
    ((seen *)context)->told++;
}

static sn_case *pulled_block(const sn_tissue *t) {
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, t);
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    add_support(c, "left", "x");
    add_support(c, "front", "y");
    add_support(c, "bottom", "z");
    sn_load *l = add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.2 * size[0], 0, 0, 1);
    l->free[1] = l->free[2] = true;
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
    return c;
}

static void fields_of_a_uniform_stretch(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) { // from 4: smoothed
        sn_tissue t = k < 2 ? demiray(2e3, 4, 4e4) : guccione(1e3, 4e4);
        if (k == 3) t.memory = prony(0.2, 1e4, 0.1, 2e4); // has not begun to relax: the same
        sn_case *c = pulled_block(&t);
        c->fibre[2] = 1; // second and third axes are then x and y
        c->springs.volume = k % 2;
        if (k >= 4) c->springs.rung = SN_RUNG_SMOOTHED;
        seen s = {.c = c};
        sn_output output = {.context = &s, .frame = look, .progress = tell};
        sn_run_summary summary;
        sn_record *r;
        CHECK_OK(sn_record_create("run", &r));
        CHECK_OK(sn_springs_run(c, &output, &summary, r));
        assert_int_equal(s.frames, 11);
        for (int n = 0; n <= 10; n++) CHECK_ABS(s.time[n], 0.1 * n, 1e-12);
        // all cells alike; force over deformed area; free sides carry nothing
        double b2 = (1 + 2 * s.strain[1]) * (1 + 2 * s.strain[2]);
        double force = last_value(r, "pull_fx");
        CHECK_ABS(s.worst / s.stress[0], 0, 1e-7); // tolerance of equilibrium
        CHECK_REL(s.stress[0], force / (size[1] * size[2] * sqrt(b2)), k == 3 ? 1e-3 : 1e-7);
        for (int d = 1; d < 6; d++) CHECK_ABS(s.stress[d] / s.stress[0], 0, k == 3 ? 1e-3 : 1e-7);
        CHECK_REL(s.strain[0], 0.5 * (1.2 * 1.2 - 1), 1e-9);
        CHECK_REL(s.pressure, -s.stress[0] / 3, 1e-3);
        CHECK_REL(s.energy * size[0] * size[1] * size[2], summary.instant_J, 1e-7);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

typedef struct tensors {
    const double *strain, *stress; // of the fields, which stay
} tensors;

static sn_status take_tensors(void *context, const sn_frame *frame) {
    tensors *t = context;
    t->strain = field(frame, "green_strain", "1", SN_ON_CELLS, 6)->value;
    t->stress = field(frame, "cauchy_stress", "Pa", SN_ON_CELLS, 6)->value;
    return SN_OK;
}

// The virial of central springs: its mean over the body is what the ends carry.
static void virial_carries_the_force(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = pulled_block(&t);
    c->springs.rung = SN_RUNG_CENTRAL;
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    sn_fields *fields;
    CHECK_OK(sn_fields_create(net, &fields));
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
    double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u), sum = 0, mean = 0, volume = 0;
    uint64_t seed = 6;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            u[4 * i + d] =
                (d == 0) * 0.1 * net->node_position[3 * i] + 5e-4 * check_random(&seed, -1, 1);
    const sn_force_call call = {
        .precision = SN_DOUBLE, .mode = SN_MEMORY_OFF, .u = u, .out = &scratch};
    sn_net_forces(net, &call);
    const sn_moment m = {.precision = SN_DOUBLE, .u = u, .pressure = scratch.pressure};
    sn_fields_fill(net, fields, &m);
    // sum of x f is minus the integral of the stress over the deformed body
    for (int i = 0; i < net->nodes; i++)
        sum -= (net->node_position[3 * i] + u[4 * i]) * ((double *)scratch.f)[4 * i];
    tensors got = {0};
    sn_output output = {.context = &got, .frame = take_tensors};
    CHECK_OK(sn_fields_emit(fields, 0, &output));
    const double *rest = net->data[SN_DOUBLE].volume;
    for (int e = 0; e < net->cells; e++) {
        const double *E = got.strain + 6 * e;
        double C[6];
        for (int k = 0; k < 6; k++) C[k] = 2 * E[k] + (k < 3);
        double det = C[0] * (C[1] * C[2] - C[4] * C[4]) - C[3] * (C[3] * C[2] - C[4] * C[5]) +
                     C[5] * (C[3] * C[4] - C[1] * C[5]);
        mean += got.stress[6 * e] * rest[net->cell_slot[e]] * sqrt(det);
        volume += rest[net->cell_slot[e]];
    }
    CHECK_REL(volume, sn_mesh_volume(c->mesh), 1e-12);
    CHECK_REL(mean, sum, 1e-11);
    sn_free(u);
    sn_scratch_destroy(&scratch);
    sn_fields_destroy(fields);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

// Two tissues in a row carry one force.
static void regions_carry_one_force(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = pulled_block(&t);
        c->mesh->region_count = 2;
        c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
        snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
        for (int e = 0; e < c->mesh->cell_count; e++) {
            double x = 0;
            for (int a = 0; a < 4; a++) x += 0.25 * c->mesh->node[3 * c->mesh->cell[4 * e + a]];
            c->mesh->region[e] = x > 0.5 * size[0];
        }
        c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
        c->tissue[1] = demiray(1e3, 3, 1e4);
        c->tissue[1].memory = prony(0.3, 0.1, 0.1, 3);
        c->springs.volume = k > 0;
        c->springs.rung = k == 2 ? SN_RUNG_CENTRAL : k == 3 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED;
        add_probe(c, "hold", SN_PROBE_REACTION, "left", 0, 0, 0);
        add_probe(c, "middle", SN_PROBE_POINT, "", 0.5 * size[0], 0, 0);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        CHECK_REL(last_value(r, "hold_fx"), -last_value(r, "pull_fx"), 1e-8);
        // the softer half stretches more
        assert_true(last_value(r, "middle_ux") < 0.4 * 0.2 * size[0]);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

static void frame_error_stops(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = pulled_block(&t);
        c->springs.integrator = k ? SN_INTEGRATOR_EXPLICIT : SN_INTEGRATOR_QUASI_STATIC;
        seen s = {.c = c, .fail_at = 3};
        sn_output output = {.context = &s, .frame = look};
        sn_run_summary summary;
        sn_record *r;
        CHECK_OK(sn_record_create("run", &r));
        CHECK_FAILS(sn_springs_run(c, &output, &summary, r), SN_E_STOPPED, "enough");
        assert_int_equal(s.frames, 3);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

static void end_is_recorded(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    for (int k = 0; k < 2; k++) {
        sn_case *c = pulled_block(&t);
        c->springs.integrator = k ? SN_INTEGRATOR_EXPLICIT : SN_INTEGRATOR_QUASI_STATIC;
        c->springs.threads = 4;
        c->until = 0.25;
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        const double *time = sn_record_values(r, "time");
        assert_int_equal(r->rows, 4); // 0, 0.1, 0.2 and the end
        CHECK_ABS(time[3], 0.25, 1e-15);
        CHECK_ABS(s.simulated_s, 0.25, 1e-15);
        assert_int_equal(s.threads, sn_team_limit(4));
        assert_string_equal(s.model, "coupled+volume");
        assert_int_equal(s.nodes, c->mesh->node_count);
        assert_true(s.steps > 0 && s.step_s > 0 && s.wall_s > 0 && s.real_time_factor > 0);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// A pressure far beyond what the tissue bears: both integrators end with a reason and finite rows.
static void hopeless_runs_give_a_reason(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.integrator = k ? SN_INTEGRATOR_EXPLICIT : SN_INTEGRATOR_QUASI_STATIC;
        add_support(c, "left", "xyz");
        sn_load *l = add_load(c, SN_LOAD_PRESSURE, "top", 0, 0, 0, 1);
        l->pressure = 1e7;
        add_probe(c, "tip", SN_PROBE_POINT, "", size[0], 0, 0);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_false(s.converged);
        assert_true(s.reason[0] != '\0');
        assert_true(r->rows >= 1);
        for (int n = 0; n < r->rows; n++)
            for (int col = 0; col < r->series_count; col++)
                assert_true(isfinite(r->series[col].value[n]));
        assert_true(isfinite(s.elastic_J) && isfinite(s.energy_residual));
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

//---- allocation ----------------------------------------------------------------------------------

static void steps_of(sn_rung rung) {
    sn_tissue t = demiray(2e3, 4, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    c->springs.rung = rung;
    c->springs.damping = 5;
    add_support(c, "bottom", "xyz");
    add_tool(c, "probe", 0.01, (const double[]){0.02, 0.01, 0.0301}, (const double[]){0, 0, 0}, 1);
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    long before = allocations;
    double force[3], most = 0;
    sn_pose hand = sn_pose_at((double[]){0.02, 0.01, 0.0301});
    for (int n = 0; n < 400; n++) { // a hand pushes down, and leaves
        hand.centre[2] = 0.0301 - 0.003 * sin(acos(-1) * n / 400);
        sn_state_set_tool(net, s, 0, &hand);
        sn_state_step(net, s, 1e-3);
        sn_state_tool_force(net, s, 0, force);
        most = fmax(most, force[2]);
    }
    assert_int_equal(allocations, before);
    assert_true(before > 0);
    assert_true(most > 0.01);
    assert_true(fabs(force[2]) < 0.1 * most);
    double *x = malloc((size_t)net->nodes * 3 * sizeof *x);
    sn_state_positions(net, s, x);
    for (int k = 0; k < 3 * net->nodes; k++) assert_true(fabs(x[k] - c->mesh->node[k]) < 0.003);
    sn_state_reset(net, s);
    sn_state_positions(net, s, x);
    for (int k = 0; k < 3 * net->nodes; k++) CHECK_ABS(x[k], c->mesh->node[k], 0);
    free(x);
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

static void steps_do_not_allocate(void **state) {
    (void)state;
    static const sn_rung rungs[] = {SN_RUNG_COUPLED, SN_RUNG_SMOOTHED, SN_RUNG_CENTRAL};
    for (int k = 0; k < 3; k++) steps_of(rungs[k]);
}

static void shortage_is_reported(void **state) {
    (void)state;
    sn_tissue t = demiray(2e3, 4, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    for (int k = 0; k < 4; k++) {
        sn_case *c = pulled_block(&t);
        c->until = 0.1;
        c->springs.rung = k == 1 ? SN_RUNG_CENTRAL : k == 3 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED;
        c->springs.integrator = k == 2 ? SN_INTEGRATOR_EXPLICIT : SN_INTEGRATOR_QUASI_STATIC;
        c->springs.precision = SN_SINGLE;
        for (long n = 0;; n++) {
            sn_run_summary s;
            sn_record *r;
            CHECK_OK(sn_record_create("run", &r));
            allocations_left = n;
            sn_status status = sn_springs_run(c, NULL, &s, r);
            bool all = allocations_left != 0;
            allocations_left = -1;
            sn_record_destroy(r);
            if (all) {
                assert_int_equal(status, SN_OK);
                assert_true(n > 40);
                break;
            }
            if (status != SN_OK) assert_int_equal(status, SN_E_MEMORY);
        }
        sn_case_destroy(c);
    }
}

static void bench_gives_rows(void **state) {
    (void)state;
    sn_springs_bench_row row;
    sn_springs_bench_plan plan = {.rung = SN_RUNG_CENTRAL,
                                  .volume = true,
                                  .memory_terms = 2,
                                  .cells = 3,
                                  .threads = 1,
                                  .precision = SN_SINGLE};
    CHECK_OK(sn_springs_bench(&plan, &row));
    assert_int_equal(row.memory_terms, 2);
    assert_int_equal(row.nodes, 64);
    assert_int_equal(row.cells, 162);
    assert_true(row.springs_per_second > 0 && row.cells_per_second > 0 && row.bound_per_second > 0);
    assert_true(row.plain_per_second > 0 && row.step_s > 0 && row.real_time_factor > 0);
    plan.rung = SN_RUNG_SMOOTHED;
    CHECK_OK(sn_springs_bench(&plan, &row));
    assert_string_equal(row.model, "smoothed");
    assert_true(row.springs == 0 && row.cells_per_second > 0 && row.bound_per_second > 0);
    assert_true(row.plain_per_second > 0 && row.real_time_factor > 0);
    plan.rung = SN_RUNG_CENTRAL;
    plan.law = "demiray";
    CHECK_FAILS(sn_springs_bench(&plan, &row), SN_E_NAME, "exponential for central");
    plan.cells = 0;
    CHECK_FAILS(sn_springs_bench(&plan, &row), SN_E_RANGE, "cells");
}

int main(void) {
    sn_set_allocator(&counting);
    const struct CMUnitTest tests[] = {cmocka_unit_test(fields_of_a_uniform_stretch),
                                       cmocka_unit_test(virial_carries_the_force),
                                       cmocka_unit_test(regions_carry_one_force),
                                       cmocka_unit_test(frame_error_stops),
                                       cmocka_unit_test(end_is_recorded),
                                       cmocka_unit_test(hopeless_runs_give_a_reason),
                                       cmocka_unit_test(steps_do_not_allocate),
                                       cmocka_unit_test(shortage_is_reported),
                                       cmocka_unit_test(bench_gives_rows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
