// Motion with inertia: bars and waves against closed forms, order in time, energy, free bodies.
// SPDX-License-Identifier: Apache-2.0
#include "waves.h"

// A traction that acts suddenly on the free end: by d'Alembert the tip rises at s/(rho c), turns at
// 2 L/c at twice the static value and is back at 4 L/c, the period of the first mode; the wall
// carries 2 s from L/c to 3 L/c. The strain of 1e-6 makes the rest linear. The corners of both are
// rounded over about (cell/L)^(2/3) of L/c (dispersion of third order), for 20 to 40 cells 0.1.
static void sudden_pull(void **state) {
    (void)state;
    const double G = 3000, K = 2e4;
    sn_tissue t = neo_hookean(G, K);
    for (int k = 0; k < 6; k++) {
        int axis = k / 3; // along the bar, across it
        double modulus = axis ? G : K + 4 * G / 3, T = 0.1 / sqrt(modulus / DENSITY);
        sn_case *c = wave_bar(elements[k % 3], k % 3 ? 20 : 40, axis, &t);
        body_pull(c, "right", axis ? 0 : 1e-6 * modulus, axis ? 1e-6 * modulus : 0, 0, NULL);
        c->until = 4 * T;
        c->output_every = T / 10;
        c->continuum.step = T / 80;
        sn_run_summary s;
        sn_record *r = body_run(c, NULL, &s);
        const double *time = sn_record_values(r, "time");
        const double *u = sn_record_values(r, axis ? "tip_uy" : "tip_ux");
        const double *f = sn_record_values(r, axis ? "wall_fy" : "wall_fx");
        double worst = 0, wall = 0;
        for (int i = 0; i < r->rows; i++) {
            double phase = time[i] / T;
            worst = fmax(worst, fabs(u[i] / 1e-7 - (phase < 2 ? phase : 4 - phase)));
            double carried = phase > 1 && phase < 3 ? 2 : 0;
            if (fabs(phase - 1) > 0.35 && fabs(phase - 3) > 0.35)
                wall = fmax(wall, fabs(f[i] / (1e-6 * modulus * 1e-4) + carried));
        }
        if (getenv("SINEW_SHOW"))
            print_message("%s along %d: tip %.4f, wall %.4f %s\n", s.model, axis, worst, wall,
                          s.note);
        CHECK_ABS(worst, 0, 0.06);
        CHECK_ABS(wall, 0, 0.3); // what rings behind the front
        assert_int_equal(s.steps, 320);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

enum { OUTPUTS = 5 };

// Displacement of the tip and force of the wall at all outputs of a run with n steps.
static void course_of(sn_case *c, int n, double out[2 * OUTPUTS]) {
    sn_run_summary s;
    c->continuum.steps = n;
    sn_record *r = body_run(c, NULL, &s);
    assert_int_equal(r->rows, OUTPUTS + 1);
    for (int k = 0; k < OUTPUTS; k++) {
        out[k] = sn_record_values(r, "tip_ux")[k + 1] / 0.004;
        out[OUTPUTS + k] = sn_record_values(r, "wall_fx")[k + 1] / 0.3;
    }
    sn_record_destroy(r);
}

static double distance(const double *a, const double *b, int count) {
    double sum = 0;
    for (int k = 0; k < count; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(sum / count);
}

// sin^2 with corners between the outputs: on one, a reaction would show the impulse of the corner.
static sn_history *smooth_motion(void) {
    enum { KNOTS = 51 };
    double time[KNOTS], value[KNOTS];
    sn_history *h;
    for (int k = 0; k < KNOTS; k++) {
        time[k] = (k + 0.5) * 2e-4;
        value[k] = pow(sin(120 * time[k]), 2);
    }
    value[0] = 0;
    CHECK_OK(sn_history_create(1, KNOTS, time, value, &h));
    return h;
}

// 0: traction on linear cells, 1: on quadratic ones, 2: with memory, 3: incompressible, 4: motion.
static sn_case *shaken(int kind) {
    static const double time[] = {0, 0.002, 0.004, 0.006, 0.008, 0.01};
    static const double force[] = {0.5, 1, 0.8, 0.3, -0.2, -0.4};
    static const sn_element of[] = {SN_ELEMENT_P1, SN_ELEMENT_P2, SN_ELEMENT_P2, SN_ELEMENT_P2P1,
                                    SN_ELEMENT_P2};
    const double prony[] = {0.4, 0.01};
    sn_tissue t = neo_hookean(3000, kind == 3 ? (double)INFINITY : 6000);
    if (kind == 2) body_set_memory(&t, "prony", 1, prony, 2);
    sn_case *c = body_block(0.02, 0.01, 0.01, 2, 1, 1, &t, of[kind]);
    sn_history *h;
    if (kind == 4)
        h = smooth_motion();
    else
        CHECK_OK(sn_history_create(1, 6, time, force, &h));
    body_support(c, "left", true, true, true);
    if (kind == 4)
        body_move(c, "right", 0.004, 0, 0, h);
    else
        body_pull(c, "right", 1500, 200, 0, h);
    body_probe(c, "tip", kind == 4 ? 0.01 : 0.02, 0.006, 0.006);
    body_reaction(c, "wall", "left");
    c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
    c->until = 0.01;
    c->output_every = 0.002;
    return c;
}

// Second order in the step at large strain, of displacements and reactions, although the load jumps
// at time 0 and all histories have corners. The finest run's own error is 1/16 of the next, so that
// order 2 shows as log2((64 - 1)/(16 - 1)) = 2.07; the terms of higher order leave some 0.2 at a
// tenth of the shortest period.
static void order(void **state) {
    (void)state;
    static const int steps[] = {100, 200, 800};
    for (int kind = 0; kind < 5; kind++) {
        sn_case *c = shaken(kind);
        double course[3][2 * OUTPUTS];
        for (int n = 0; n < 3; n++) course_of(c, steps[n], course[n]);
        // under a moved support forces hold the impulses of its corners, which are as short as a
        // step; the displacement is still of order 2 or better
        int count = kind == 4 ? OUTPUTS : 2 * OUTPUTS;
        double error[2] = {distance(course[0], course[2], count),
                           distance(course[1], course[2], count)};
        double rate = log2(error[0] / error[1]);
        if (getenv("SINEW_SHOW"))
            print_message("case %d: errors %.3g %.3g, order %.2f\n", kind, error[0], error[1],
                          rate);
        assert_true(rate > 1.7 && rate < (kind == 4 ? 3.2 : 2.3));
        sn_case_destroy(c);
    }
}

// A body that nothing holds, of all elements, under a force with gravity: its middle falls by
// (g + F/m) t^2/2. The method moves with a constant acceleration exactly, so that only Newton's
// tolerance is left; P1 is checked for the momentum of all its nodes by the velocity field.
typedef struct falling {
    const sn_mesh *mesh;
    double momentum[3], momentum_time;
} falling;

static sn_status add_momentum(void *context, const sn_frame *frame) {
    falling *f = context;
    memset(f->momentum, 0, sizeof f->momentum);
    assert_int_equal(frame->field_count, 8);
    assert_string_equal(frame->fields[7].name, "velocity");
    for (int n = 0; n < f->mesh->cell_count; n++)
        for (int k = 0; k < 4; k++)
            for (int i = 0; i < 3; i++)
                f->momentum[i] += DENSITY * sn_mesh_cell_volume(f->mesh, n) / 4 *
                                  frame->fields[7].value[3 * f->mesh->cell[4 * n + k] + i];
    f->momentum_time = frame->time;
    return SN_OK;
}

static void free_fall(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3000, 2e4);
    sn_case *c = body_block(0.02, 0.01, 0.01, 2, 1, 1, &t, SN_ELEMENT_P1);
    c->gravity[2] = -9.81;
    body_pull(c, "right", 100, 0, 0, NULL);
    c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
    c->until = 0.05;
    c->output_every = 0.025;
    c->continuum.steps = 40;
    falling f = {.mesh = c->mesh};
    sn_output output = {.context = &f, .frame = add_momentum};
    sn_run_summary s;
    sn_record *r = body_run(c, &output, &s);
    CHECK_ABS(f.momentum_time, 0.05, 1e-15);
    CHECK_REL(f.momentum[2], -9.81 * DENSITY * 2e-6 * 0.05, 1e-8);
    CHECK_REL(f.momentum[0], 100 * 1e-4 * 0.05, 1e-8);
    CHECK_ABS(f.momentum[1] / f.momentum[0], 0, 1e-8);
    // a rigid fall alone holds this energy; the force stretches and shakes the body as well
    assert_true(s.kinetic_J > 0.5 * DENSITY * 2e-6 * pow(9.81 * 0.05, 2));
    sn_record_destroy(r);
    sn_case_destroy(c);
}

// Without dissipation the energy that came in stays; with it less, and never more. Trapezoidal work
// of large strains: the error falls with the square of the step.
static void energy(void **state) {
    (void)state;
    double residual[3];
    for (int k = 0; k < 3; k++) {
        sn_case *c = shaken(1);
        c->continuum.rho_infinity = k == 2 ? 0.2 : 1;
        c->continuum.steps = k == 1 ? 200 : 100;
        sn_run_summary s;
        sn_record *r = body_run(c, NULL, &s);
        residual[k] = s.energy_residual;
        assert_true(s.kinetic_J > 0.02 * s.external_work_J && s.elastic_J > 0);
        if (k == 2) assert_true(s.kinetic_J + s.elastic_J < s.external_work_J);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    if (getenv("SINEW_SHOW"))
        print_message("energy residual %.2g %.2g, damped %.2g\n", residual[0], residual[1],
                      residual[2]);
    CHECK_ABS(residual[1], 0, 2e-3);
    assert_true(residual[0] > 2.5 * residual[1]);
    assert_true(residual[2] > 4 * residual[0]);
}

// A body with memory comes to rest where the relaxed law holds it: the static displacement over
// g_inf at strain 1e-6. By until, ten relaxation times, exp(-10) of the motion is left or less.
static void comes_to_rest(void **state) {
    (void)state;
    const double prony[] = {0.6, 0.02};
    sn_tissue t = neo_hookean(3000, 2e4);
    body_set_memory(&t, "prony", 1, prony, 2);
    double modulus = 2e4 + 4.0 * 3000 / 3;
    sn_case *c = wave_bar(SN_ELEMENT_P2, 3, 0, &t);
    body_pull(c, "right", 1e-6 * modulus, 0, 0, NULL);
    c->until = 1;
    c->output_every = 0.01;
    c->continuum.step = 0.0025;
    sn_run_summary s;
    sn_record *r = body_run(c, NULL, &s);
    const double *u = sn_record_values(r, "tip_ux");
    double most = 0;
    for (int k = 0; k < r->rows; k++) most = fmax(most, u[k]);
    CHECK_REL(last_value(r, "tip_ux"), 1e-7 / 0.4, 2e-4);
    assert_true(most > 1.02 * last_value(r, "tip_ux")); // it swung
    assert_true(s.kinetic_J < 1e-6 * s.external_work_J);
    sn_record_destroy(r);
    sn_case_destroy(c);
}

// Steps of an eighth of the period of a bar are told from those of a 320th.
static void long_steps(void **state) {
    (void)state;
    const double modulus = 2e4 + 4.0 * 3000 / 3;
    sn_tissue t = neo_hookean(3000, 2e4);
    for (int fine = 0; fine < 2; fine++) {
        sn_case *c = wave_bar(SN_ELEMENT_P1, 10, 0, &t);
        body_pull(c, "right", 1e-6 * modulus, 0, 0, NULL);
        c->until = c->output_every = 0.4 / sqrt(modulus / DENSITY);
        c->continuum.steps = fine ? 320 : 8;
        sn_run_summary s;
        sn_record *r = body_run(c, NULL, &s);
        if (getenv("SINEW_SHOW")) print_message("%ld steps: %s\n", s.steps, s.note);
        assert_true((strstr(s.note, "steps are long") == NULL) == fine);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

//---- steps by accuracy --------------------------------------------------------------------------

// The error of the whole falls with the tolerance of a step: a step's own error is of third order
// in its length, that of the run of second, so that an eighth of the tolerance halves the steps and
// quarters the error, whatever changes of length the control makes on the way. Loads have corners.
// The reference's own error adds 0.07 to the order, as in order().
static void steps_by_accuracy(void **state) {
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        double course[3][2 * OUTPUTS], error[2], steps[2];
        sn_case *c = shaken(kind);
        for (int n = 0; n < 3; n++) {
            sn_run_summary s;
            c->continuum.steps = n == 2 ? 1600 : 5;
            c->continuum.step_tolerance = n == 2 ? 0 : n == 1 ? 3.2e-6 : 2.56e-5;
            sn_record *r = body_run(c, NULL, &s);
            for (int k = 0; k < OUTPUTS; k++) {
                course[n][k] = sn_record_values(r, "tip_ux")[k + 1] / 0.004;
                course[n][OUTPUTS + k] = sn_record_values(r, "wall_fx")[k + 1] / 0.3;
            }
            if (n < 2) steps[n] = (double)s.steps;
            assert_true((strstr(s.note, "steps of") && strstr(s.note, "taken back")) == (n < 2));
            if (getenv("SINEW_SHOW"))
                print_message("case %d: %ld steps, %d cut back; %s\n", kind, s.steps, s.cutbacks,
                              s.note);
            sn_record_destroy(r);
        }
        for (int n = 0; n < 2; n++) error[n] = distance(course[n], course[2], 2 * OUTPUTS);
        double rate = log(error[0] / error[1]) / log(steps[1] / steps[0]);
        if (getenv("SINEW_SHOW"))
            print_message("case %d: errors %.3g %.3g, order %.2f in the steps\n", kind, error[0],
                          error[1], rate);
        assert_true(rate > 1.7 && rate < 2.4);
        // 100 to 200 of the largest single error add up, most of them cancel
        assert_true(error[0] < 100 * 2.56e-5 && error[1] < 100 * 3.2e-6);
        sn_case_destroy(c);
    }
}

static void refusals(void **state) {
    (void)state;
    sn_run_summary s;
    sn_record *r;
    sn_case *c = shaken(0);
    CHECK_OK(sn_record_create("test", &r));
    c->continuum.rho_infinity = 1.2;
    CHECK_FAILS(sn_continuum_run(c, NULL, &s, r), SN_E_RANGE, "rho_infinity");
    c->continuum.rho_infinity = 0.8;
    c->continuum.step_tolerance = 1;
    CHECK_FAILS(sn_continuum_run(c, NULL, &s, r), SN_E_RANGE, "step_tolerance");
    c->continuum.step_tolerance = 1e-4;
    c->continuum.analysis = SN_ANALYSIS_QUASI_STATIC;
    CHECK_FAILS(sn_continuum_run(c, NULL, &s, r), SN_E_UNSUPPORTED, "analysis: dynamic");
    c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
    c->tissue->density = (double)NAN;
    CHECK_FAILS(sn_continuum_run(c, NULL, &s, r), SN_E_DEFINITION, "density");
    sn_record_destroy(r);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sudden_pull),       cmocka_unit_test(order),
        cmocka_unit_test(free_fall),         cmocka_unit_test(energy),
        cmocka_unit_test(comes_to_rest),     cmocka_unit_test(long_steps),
        cmocka_unit_test(steps_by_accuracy), cmocka_unit_test(refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
