// Memory of a body: relaxation and creep against the hereditary integral.
// SPDX-License-Identifier: Apache-2.0
#include "body.h"

static const double spectrum[3] = {0.23, 0.013, 90}; // c, tau1, tau2

static sn_case *cube(sn_element element, double bulk) {
    sn_tissue t = neo_hookean(3000, bulk);
    body_set_memory(&t, "fung-spectrum", 0, spectrum, 3);
    sn_case *c = body_block(0.01, 0.01, 0.01, 1, 1, 1, &t, element);
    body_rollers(c);
    c->until = 20;
    c->output_every = 0.5;
    c->continuum.memory_tolerance = 1e-5;
    return c;
}

// (1/T) int_0^min(t, T) G(t - s) ds by Simpson's rule.
static double ramp_response(const sn_memory *memory, double t, double T) {
    const int n = 4000;
    double end = fmin(t, T), sum = 0;
    for (int k = 0; k <= n; k++)
        sum += (k == 0 || k == n ? 1
                : k % 2          ? 4
                                 : 2) *
               sn_memory_relaxation(memory, t - end * k / n);
    return sum * end / (3 * n) / T;
}

// At a strain of 1e-5 the elastic force follows the ramp in proportion, so that the force is the
// ramp's response times the elastic force. Remaining: strain 1e-5 and memory tolerance 1e-5.
static void relaxation(void **state) {
    (void)state;
    static const sn_element elements[] = {SN_ELEMENT_P1, SN_ELEMENT_P2, SN_ELEMENT_P2P1,
                                          SN_ELEMENT_P2P1};
    for (int k = 0; k < 4; k++) {
        double bulk = k == 3 ? (double)INFINITY : 6000;
        double young = k == 3 ? 9000 : 9 * bulk * 3000 / (3 * bulk + 3000);
        sn_case *c = cube(elements[k], bulk);
        body_move(c, "right", 1e-7, ANY, ANY, make_ramp(0, 0.5));
        body_reaction(c, "pull", "right");
        sn_run_summary summary;
        sn_record *r = body_run(c, NULL, &summary);
        assert_int_equal(r->rows, 41);
        double worst = 0;
        for (int i = 1; i < r->rows; i++) {
            double t = sn_record_values(r, "time")[i];
            double force = young * 1e-5 * 1e-4 * ramp_response(&c->tissue->memory, t, 0.5);
            worst = fmax(worst, fabs(sn_record_values(r, "pull_fx")[i] / force - 1));
        }
        CHECK_ABS(worst, 0, 5e-5);
        assert_true(summary.memory_terms > 3 && summary.memory_error <= 1e-5);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// Creep under a traction ramp: int G(t - s) d eps(s) = sigma(t)/E by product integration with 8000
// equal steps, of second order.
static void creep_reference(const sn_memory *memory, double T, double until, int n, double *eps) {
    double h = until / n;
    double *mean = sn_alloc((size_t)n, sizeof *mean); // of G over a step
    for (int k = 0; k < n; k++)
        mean[k] =
            (sn_memory_relaxation(memory, k * h) + 4 * sn_memory_relaxation(memory, (k + 0.5) * h) +
             sn_memory_relaxation(memory, (k + 1) * h)) /
            6;
    eps[0] = 0;
    for (int i = 1; i <= n; i++) {
        double sum = fmin(i * h / T, 1);
        for (int j = 1; j < i; j++) sum -= mean[i - j] * (eps[j] - eps[j - 1]);
        eps[i] = eps[i - 1] + sum / mean[0];
    }
    sn_free(mean);
}

// The graded steps follow the creep after the corner although `steps` asks for 20 only.
static void creep(void **state) {
    (void)state;
    enum { FINE = 8000 };
    double *eps = sn_alloc(FINE + 1, sizeof *eps);
    for (int k = 0; k < 2; k++) {
        sn_case *c = cube(k ? SN_ELEMENT_P2P1 : SN_ELEMENT_P1, 6000);
        double young = 9.0 * 6000 * 3000 / (3 * 6000 + 3000);
        body_pull(c, "right", 1e-5 * young, 0, 0, make_ramp(0, 0.5));
        body_probe(c, "tip", 0.01, 0.01, 0.01);
        c->continuum.steps = 20;
        sn_run_summary summary;
        sn_record *r = body_run(c, NULL, &summary);
        creep_reference(&c->tissue->memory, 0.5, 20, FINE, eps);
        double worst = 0;
        for (int i = 1; i < r->rows; i++) {
            double u = sn_record_values(r, "tip_ux")[i] / (0.01 * 1e-5);
            worst = fmax(worst, fabs(u / eps[i * FINE / 40] - 1));
        }
        if (getenv("SINEW_SHOW"))
            print_message("creep %.3f to %.3f in %ld steps, %d terms\n", eps[FINE / 40], eps[FINE],
                          summary.steps, summary.memory_terms);
        assert_true(eps[FINE] > 1.3); // it creeps
        CHECK_ABS(worst, 0, 5e-4);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    sn_free(eps);
}

// At large strain S relaxes as G at every stretch (separability): after a jump at time 0 the force
// at fixed length is the instantaneous force times G(t).
static void jump(void **state) {
    (void)state;
    sn_case *c = cube(SN_ELEMENT_P2P1, 6000);
    body_move(c, "right", 0.004, ANY, ANY, NULL);
    body_reaction(c, "pull", "right");
    sn_run_summary summary;
    sn_record *r = body_run(c, NULL, &summary);
    const double *t = sn_record_values(r, "time"), *f = sn_record_values(r, "pull_fx");
    assert_true(f[0] > 0);
    for (int i = 0; i < r->rows; i++)
        CHECK_REL(f[i] / f[0], sn_memory_relaxation(&c->tissue->memory, t[i]), 5e-5);
    sn_record_destroy(r);
    sn_case_destroy(c);
}

// A closed cycle: what the force's loop encloses is dissipated, and nothing is stored in the
// strain. The summary sums the work over the run's steps, the test over the outputs: both
// trapezoidal.
static void cycle(void **state) {
    (void)state;
    sn_case *c = cube(SN_ELEMENT_P2P1, 6000);
    sn_history *triangle;
    const double time[3] = {0, 2, 4}, value[3] = {0, 1, 0};
    CHECK_OK(sn_history_create(1, 3, time, value, &triangle));
    body_move(c, "right", 0.003, ANY, ANY, triangle);
    body_reaction(c, "pull", "right");
    body_probe(c, "tip", 0.01, 0.01, 0.01);
    c->until = 4;
    c->output_every = 0.05;
    c->continuum.steps = 80;
    sn_run_summary summary;
    sn_record *r = body_run(c, NULL, &summary);
    const double *u = sn_record_values(r, "tip_ux"), *f = sn_record_values(r, "pull_fx");
    double loop = 0, up = 0;
    for (int i = 1; i < r->rows; i++) {
        double work = 0.5 * (f[i] + f[i - 1]) * (u[i] - u[i - 1]);
        loop += work;
        up += i <= 40 ? work : 0;
    }
    assert_true(loop > 0.05 * up && loop < 0.6 * up);
    CHECK_ABS((summary.dissipated_J - loop) / up, 0, 2e-3); // steps of 1/40: about 1/40^2 each
    CHECK_ABS(summary.elastic_J / up, 0, 1e-3); // but for the sides, which are not back yet
    sn_record_destroy(r);
    sn_case_destroy(c);
}

// Voigt: force mu u + eta du/dt, with eta/mu = tau, through the ramp and after.
static void voigt(void **state) {
    (void)state;
    const double tau = 0.3;
    sn_case *c = cube(SN_ELEMENT_P1, 6000);
    body_set_memory(c->tissue, "voigt", 0, &tau, 1);
    body_move(c, "right", 1e-7, ANY, ANY, make_ramp(0, 2));
    body_reaction(c, "pull", "right");
    c->until = 4;
    sn_run_summary summary;
    sn_record *r = body_run(c, NULL, &summary);
    double elastic = 9.0 * 6000 * 3000 / (3 * 6000 + 3000) * 1e-5 * 1e-4;
    for (int i = 1; i < r->rows; i++) {
        double t = sn_record_values(r, "time")[i];
        double expected = t < 2.25 ? t / 2 + tau / 2 : 1;
        CHECK_REL(sn_record_values(r, "pull_fx")[i], elastic * expected, 1e-4);
    }
    sn_record_destroy(r);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(relaxation), cmocka_unit_test(creep),
                                       cmocka_unit_test(jump), cmocka_unit_test(cycle),
                                       cmocka_unit_test(voigt)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
