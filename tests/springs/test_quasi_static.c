// Equilibrium runs: residual, closed forms, memory, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"

static const double size[3] = {0.06, 0.03, 0.03};
static const int cells[3] = {6, 3, 3};

// a block held at x = 0 so that it may contract sideways, pulled at the other end
static sn_case *pulled_block(const sn_tissue *t, double stretch, double ramp) {
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, t);
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    add_support(c, "left", "x");
    add_support(c, "front", "y");
    add_support(c, "bottom", "z");
    sn_load *l = add_load(c, SN_LOAD_DISPLACEMENT, "right", (stretch - 1) * size[0], 0, 0, ramp);
    l->free[1] = l->free[2] = true;
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
    add_probe(c, "hold", SN_PROBE_REACTION, "left", 0, 0, 0);
    add_probe(c, "corner", SN_PROBE_POINT, "", size[0], size[1], size[2]);
    return c;
}

// Nominal stress and lateral stretch of a compressible solid with free sides, by bisection.
static double uniaxial_stress(const sn_tissue *t, double bulk, double stretch, double *lateral) {
    double low = 0.5, high = 1.5, S[6], J = 1;
    for (int k = 0; k < 200; k++) {
        double b = 0.5 * (low + high);
        double E[6] = {
            0.5 * (stretch * stretch - 1), 0.5 * (b * b - 1), 0.5 * (b * b - 1), 0, 0, 0};
        sn_law_solid(t->law, t->value, t->terms, 1, E, NULL, S, NULL);
        J = stretch * b * b;
        double side = S[1] + bulk * (J - 1) * J / (b * b);
        if (side < 0)
            low = b;
        else
            high = b;
        *lateral = b;
    }
    return stretch * (S[0] + bulk * (J - 1) * J / (stretch * stretch));
}

static void stretch_follows_the_law(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        double bulk = k < 2 ? 2e4 : 4e4, b, area = size[1] * size[2];
        sn_tissue t = k < 2 ? neo_hookean(3e3, bulk) : demiray(2e3, 4, bulk);
        sn_case *c = pulled_block(&t, 1.2, 1);
        c->springs.volume = k % 2;
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        double T = uniaxial_stress(&t, bulk, 1.2, &b);
        // the field is uniform, which linear cells represent exactly: the residual's tolerance is
        // left
        CHECK_REL(last_value(r, "pull_fx"), T * area, 1e-8);
        CHECK_REL(last_value(r, "hold_fx"), -T * area, 1e-8);
        CHECK_REL(last_value(r, "corner_uy"), (b - 1) * size[1], 1e-8);
        CHECK_REL(last_value(r, "corner_uz"), (b - 1) * size[2], 1e-8);
        assert_int_equal(r->rows, 11);
        // no memory: all work is stored, up to the trapezoidal rule over 20 steps, 1/20^2 / 12 =
        // 2e-4 of the curvature of the force, which is a few times the force over the range
        CHECK_ABS(s.energy_residual, 0, 1e-3);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// Stress of the uniform field by direct evaluation of the hereditary integral (equation 33): at
// each time the lateral stretch and both stress components, memory by quadrature of G over many
// steps.
static void relaxation_of(sn_rung rung) {
    sn_tissue t = neo_hookean(3e3, 2e4);
    t.memory.law = sn_memory_law_find("fung-spectrum");
    t.memory.terms = 0;
    t.memory.value[0] = 0.25;
    t.memory.value[1] = 1e-2;
    t.memory.value[2] = 50;
    sn_case *c = pulled_block(&t, 1.15, 0.5);
    c->until = 20;
    c->output_every = 0.5;
    c->springs.volume = false;
    c->springs.rung = rung;
    sn_run_summary s;
    sn_record *r = run_case(c, &s);
    assert_true(s.converged);
    const double *time = sn_record_values(r, "time"), *f = sn_record_values(r, "pull_fx");
    double b, peak = uniaxial_stress(&t, 2e4, 1.15, &b) * size[1] * size[2];
    for (int k = 1; k < r->rows; k++) {
        // one G for S_d and for the volume: the lateral stretch stays what it is without memory,
        // and the force relaxes like G after the ramp: integral of G(t - s) dT(s), T(s) known
        double sum = 0, before = 0, until = fmin(time[k], 0.5);
        const int n = 400;
        for (int i = 0; i < n; i++) {
            double to = until * (i + 1) / n, middle = until * (i + 0.5) / n;
            double T = uniaxial_stress(&t, 2e4, 1 + 0.15 * to / 0.5, &b) * size[1] * size[2];
            sum += (T - before) * sn_memory_relaxation(&t.memory, time[k] - middle);
            before = T;
        }
        // exponentials within 1e-3 of G, and the nonlinearity of S within a step, 1/20 of the ramp
        CHECK_ABS((f[k] - sum) / peak, 0, 5e-3);
    }
    assert_true(f[r->rows - 1] < 0.7 * f[1]); // it did relax
    sn_record_destroy(r);
    sn_case_destroy(c);
}

static void relaxation_follows_the_memory(void **state) {
    (void)state;
    relaxation_of(SN_RUNG_COUPLED);
    relaxation_of(SN_RUNG_SMOOTHED);
}

// Stretch with both ends held, and shear: no uniform field. Each rung, hard cases included.
static void held_block_converges(void **state) {
    (void)state;
    for (int k = 0; k < 9; k++) {
        sn_tissue t = k < 3   ? neo_hookean(3e3, k == 2 ? 3e6 : 2.1e4)
                      : k < 6 ? demiray(2e3, 8, 6e4)
                              : guccione(2e3, 6e4);
        if (k == 4 || k == 8) t.memory = prony(0.3, 0.05, 0.2, 1);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        if (k == 1) jitter(c, 0.15, 4);
        c->fibre[0] = 0.6;
        c->fibre[1] = 0.8;
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        c->springs.volume = k != 0 && k != 4 && k != 8;
        c->springs.rung = k >= 7 ? SN_RUNG_SMOOTHED : k == 5 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.15 * size[0], 0.1 * size[0], 0, 1);
        add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
        add_probe(c, "hold", SN_PROBE_REACTION, "left", 0, 0, 0);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        if (!s.converged) print_message("%d: %s\n", k, s.reason);
        assert_true(s.converged);
        double pull = last_value(r, "pull_fx");
        assert_true(pull > 0.1);
        for (int d = 0; d < 3; d++) {
            char a[] = "pull_fx", b[] = "hold_fx";
            a[6] = b[6] = (char)('x' + d);
            // equilibrium to 1e-10 of the reactions, summed over about 1000 directions
            CHECK_ABS((last_value(r, a) + last_value(r, b)) / pull, 0, 3e-9);
        }
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// A plate pressed on and then drawn along, until all that touches slips: what it drags is then
// friction times what it presses, whatever the tissue. The tangent is unsymmetric all the way.
static void dragged_plate_slips(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_tissue t = k == 1 ? demiray(2e3, 4, 4e4) : neo_hookean(3e3, 3e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        c->springs.rung = k == 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        add_support(c, "bottom", "xyz");
        add_probe(c, "hold", SN_PROBE_REACTION, "bottom", 0, 0, 0);
        add_tool(c, "plate", 0, (const double[]){0, 0, size[2] + 1e-4}, (const double[3]){0}, 1);
        sn_tool *plate = &c->tool[0];
        plate->kind = SN_TOOL_PLANE;
        plate->axis[2] = -1;
        plate->friction = 0.5;
        sn_history_destroy(plate->path);
        // pressed by a tenth, drawn by eight: slip begins near friction 3 G/G 0.1 = 0.15
        const double way[] = {0, 0, 0, 0, 0, -0.1 * size[2], 0.8 * size[2], 0, -0.1 * size[2]};
        CHECK_OK(sn_history_create(3, 3, (const double[]){0, 0.5, 1}, way, &plate->path));
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        if (!s.converged) print_message("%d: %s\n", k, s.reason);
        assert_true(s.converged);
        const double press = last_value(r, "plate_fz"), drag = last_value(r, "plate_fx");
        assert_true(press > 1);
        // no node drags more; less by 1 - cos of the angle at which it also slips sideways, a few
        // thousandths of a radian at this way
        assert_true(-drag <= 0.5 * press * (1 + 1e-12));
        CHECK_REL(drag, -0.5 * press, 1e-4);
        CHECK_ABS((last_value(r, "hold_fx") - drag) / press, 0, 3e-9); // equilibrium, as above
        CHECK_ABS((last_value(r, "hold_fz") - press) / press, 0, 3e-9);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// A looser tolerance takes fewer corrections, and leaves an error of its own size.
static void tolerance_is_kept(void **state) {
    (void)state;
    const double tolerance[] = {0, 1e-4, 1e-12};
    double pull[3];
    int corrections[3];
    for (int k = 0; k < 3; k++) {
        sn_tissue t = demiray(2e3, 4, 4e4);
        sn_case *c = pulled_block(&t, 1.3, 1);
        add_support(c, "left", "xyz"); // else the field is uniform
        c->springs.tolerance = tolerance[k];
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        pull[k] = last_value(r, "pull_fx");
        corrections[k] = s.newton_iterations;
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    assert_true(corrections[1] < corrections[0]);
    CHECK_REL(pull[0], pull[2], 1e-9); // 1e-10 of the forces at work, unless told
    CHECK_REL(pull[1], pull[2], 1e-3);
    assert_true(fabs(pull[1] - pull[2]) > fabs(pull[0] - pull[2]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stretch_follows_the_law), cmocka_unit_test(relaxation_follows_the_memory),
        cmocka_unit_test(held_block_converges), cmocka_unit_test(dragged_plate_slips),
        cmocka_unit_test(tolerance_is_kept)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
