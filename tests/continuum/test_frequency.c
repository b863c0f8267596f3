// Steps that follow the motion, and the frequencies of bars with them.
// SPDX-License-Identifier: Apache-2.0
#include "waves.h"

// Quick at first and slow when the memory has calmed it: the steps grow, and few are needed.
static void steps_grow(void **state) {
    (void)state;
    const double prony[] = {0.6, 0.02}, modulus = 2e4 + 4.0 * 3000 / 3;
    sn_tissue t = neo_hookean(3000, 2e4);
    body_set_memory(&t, "prony", 1, prony, 2);
    long steps[2];
    double end[2];
    for (int k = 0; k < 2; k++) {
        sn_case *c = wave_bar(SN_ELEMENT_P2, 3, 0, &t);
        body_pull(c, "right", 1e-6 * modulus, 0, 0, NULL);
        c->until = c->output_every = 1;
        c->continuum.step = k ? 0.1 : 5e-4;
        c->continuum.step_tolerance = k ? 1e-4 : 0;
        sn_run_summary s;
        sn_record *r = body_run(c, NULL, &s);
        if (getenv("SINEW_SHOW")) print_message("%ld steps; %s\n", s.steps, s.note);
        steps[k] = s.steps;
        end[k] = last_value(r, "tip_ux");
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    CHECK_REL(end[1], 1e-7 / 0.4, 1e-3);
    assert_true(steps[1] < steps[0] / 2);
}

//---- frequencies --------------------------------------------------------------------------------

// The mean period of a column about a level, by its upward crossings, which an error of the level
// shifts alike.
static double period_of(const sn_record *r, const char *column, double level) {
    const double *t = sn_record_values(r, "time"), *u = sn_record_values(r, column);
    double first = 0, last = 0;
    int count = 0;
    for (int k = 1; k < r->rows; k++) {
        if (!(u[k - 1] < level && u[k] >= level)) continue;
        last = t[k - 1] + (t[k] - t[k - 1]) * (level - u[k - 1]) / (u[k] - u[k - 1]);
        if (count++ == 0) first = last;
    }
    assert_true(count >= 3);
    return (last - first) / (count - 1);
}

// A bar that its weight pulls suddenly rings about the static tip rho g L^2/2M in odd modes, whose
// periods all divide the first: 4 L/c with c^2 = M/rho, along it M = K + 4G/3, across it G. With
// steps of the default tolerance one in 70 of a period errs by (omega h)^2/10 = 0.1 %.
static void bar_frequencies(void **state) {
    (void)state;
    const double G = 3000, K = 2e4, L = 0.1;
    sn_tissue t = neo_hookean(G, K);
    for (int k = 0; k < 6; k++) {
        int axis = k / 3;
        double modulus = axis ? G : K + 4 * G / 3, T = 4 * L / sqrt(modulus / DENSITY);
        sn_case *c = wave_bar(elements[k % 3], k % 3 ? 8 : 16, axis, &t);
        c->gravity[axis] = 1e-6 * modulus / (DENSITY * L);
        c->until = 3.4 * T;
        c->output_every = T / 40;
        c->continuum.steps = 20;
        c->continuum.step_tolerance = SN_STEP_TOLERANCE;
        sn_run_summary s;
        sn_record *r = body_run(c, NULL, &s);
        double period = period_of(r, axis ? "tip_uy" : "tip_ux", 0.5e-6 * L);
        if (getenv("SINEW_SHOW"))
            print_message("%s along %d: period %.5g, closed form %.5g (%+.3f %%), %ld steps; %s\n",
                          s.model, axis, period, T, 100 * (period / T - 1), s.steps, s.note);
        CHECK_REL(period, T, 3e-3);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// A slender cantilever of Poisson's ratio 0 after a force that rises over half a period, which
// leaves hardly anything but the first mode: omega = 1.8751^2 sqrt(E h^2/(12 rho L^4)). Shear and
// turning mass of the sections lower it by some 0.5 % for L = 20 h.
static void bending_frequency(void **state) {
    (void)state;
    const double G = 3000, E = 2 * G, L = 0.1, h = 0.005;
    double T =
        2 * acos(-1.0) / (1.875104 * 1.875104 * sqrt(E * h * h / (12 * DENSITY * pow(L, 4))));
    sn_tissue t = neo_hookean(G, 2 * G / 3);
    for (int e = 1; e < 3; e++) {
        sn_case *c = body_block(L, h, h, 12, 1, 1, &t, elements[e]);
        double traction = 1e-5 * E * h / L;
        body_support(c, "left", true, true, true);
        body_pull(c, "right", 0, 0, traction, make_ramp(0, T / 2));
        c->continuum.analysis = SN_ANALYSIS_DYNAMIC;
        c->continuum.tolerance = 1e-9;
        c->continuum.step_tolerance = SN_STEP_TOLERANCE;
        c->continuum.steps = 20;
        c->until = 3.2 * T;
        c->output_every = T / 40;
        body_probe(c, "tip", L, h / 2, h / 2);
        sn_run_summary s;
        sn_record *r = body_run(c, NULL, &s);
        double level = traction * h * h * pow(L, 3) / (3 * E * pow(h, 4) / 12);
        double period = period_of(r, "tip_uz", level);
        if (getenv("SINEW_SHOW"))
            print_message("%s: period %.5g, slender beam %.5g (%+.3f %%), %ld steps; %s\n", s.model,
                          period, T, 100 * (period / T - 1), s.steps, s.note);
        CHECK_REL(period, T, 1.2e-2);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(steps_grow),
                                       cmocka_unit_test(bar_frequencies),
                                       cmocka_unit_test(bending_frequency)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
