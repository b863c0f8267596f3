// The virtual testing machine against quadrature, direct convolution and closed forms.
// SPDX-License-Identifier: Apache-2.0
#include "lab/protocol/path.h"
#include "lab_oracle.h"

enum { ROWS = 40 };

// a motion with two speeds, a reversal and a hold, and times all over it
static sn_history *motion(double top, double seconds, double *time) {
    const double knots[] = {0.0, seconds, 1.7 * seconds, 3.1 * seconds, 40.0 * seconds};
    const double value[] = {1.0, 1.0 + 0.7 * (top - 1.0), top, 1.0 + 0.4 * (top - 1.0),
                            1.0 + 0.4 * (top - 1.0)};
    sn_history *h;
    CHECK_OK(sn_history_create(1, 5, knots, value, &h));
    uint64_t seed = 77;
    for (int i = 0; i < ROWS; ++i)
        time[i] = i < 25 ? check_random(&seed, 0.0, 3.1 * seconds)
                         : 3.1 * seconds * pow(12.0, (i - 24) / 15.0);
    return h;
}

static sn_memory random_memory(int k, uint64_t *seed) {
    if (k % 2) {
        double v[] = {check_random(seed, 0.02, 0.5), pow(10.0, check_random(seed, -3.0, -1.0)),
                      pow(10.0, check_random(seed, 1.0, 3.0))};
        return oracle_memory("fung-spectrum", 0, v, 3);
    }
    double v[] = {check_random(seed, 0.05, 0.25), check_random(seed, 0.05, 0.25),
                  check_random(seed, 0.05, 0.25), check_random(seed, 0.01, 0.05),
                  check_random(seed, 0.3, 2.0),   check_random(seed, 5.0, 50.0)};
    return oracle_memory("prony", 3, v, 6);
}

static double exponential_slope(double stretch, const double *v) {
    return v[1] * exp(v[0] * (stretch - 1.0)); // equation (14): B, C
}

static double peak_of(const double *x, int n) {
    double peak = 0.0;
    for (int i = 0; i < n; ++i) peak = fmax(peak, fabs(x[i]));
    return peak;
}

// The interface promises 1e-7 of the peak; the quadrature's own error is below 1e-9.
static void exponential_law_follows_quadrature(void **state) {
    (void)state;
    uint64_t seed = 4711;
    for (int k = 0; k < 8; ++k) {
        double time[ROWS], stress[ROWS];
        double v[] = {check_random(&seed, 2.0, 30.0), check_random(&seed, 1e3, 5e4)};
        sn_tissue tissue = oracle_tissue("exponential", v, 2);
        tissue.memory = random_memory(k, &seed);
        sn_history *h =
            motion(check_random(&seed, 1.03, 1.2), pow(10.0, check_random(&seed, -1.3, 1.0)), time);
        CHECK_OK(sn_lab_uniaxial(&tissue, h, ROWS, time, stress));
        double peak = peak_of(stress, ROWS);
        assert_true(peak > 1e-3 * v[1]);
        for (int i = 0; i < ROWS; ++i)
            CHECK_ABS(stress[i],
                      oracle_hereditary(h, &tissue.memory, time[i], exponential_slope, v),
                      1e-7 * peak);
        sn_history_destroy(h);
    }
}

// Demiray, J = 1: S_d = c exp(b (I1 - 3)) (1 - I1/3 C^-1)
static double demiray_s(double stretch, const double *v, bool axial) {
    double l2 = stretch * stretch, i1 = l2 + 2.0 / stretch;
    return v[0] * exp(v[1] * (i1 - 3.0)) * (1.0 - i1 / 3.0 * (axial ? 1.0 / l2 : stretch));
}
// slopes by central differences: error h2/6 f'''/f' ~ 1e-11 (b L)^2, rounding 1e-16/1e-5
static double demiray_s11(double stretch, const double *v) {
    return (demiray_s(stretch + 1e-5, v, true) - demiray_s(stretch - 1e-5, v, true)) / 2e-5;
}
static double demiray_s22(double stretch, const double *v) {
    return (demiray_s(stretch + 1e-5, v, false) - demiray_s(stretch - 1e-5, v, false)) / 2e-5;
}

static void incompressible_solid_follows_quadrature(void **state) {
    (void)state;
    uint64_t seed = 99;
    for (int k = 0; k < 4; ++k) {
        double time[ROWS], stress[ROWS], at;
        double v[] = {check_random(&seed, 1e3, 5e3), check_random(&seed, 2.0, 20.0),
                      (double)INFINITY};
        sn_tissue tissue = oracle_tissue("demiray", v, 3);
        tissue.memory = random_memory(k, &seed);
        sn_history *h = motion(1.21, pow(10.0, check_random(&seed, -1.3, 1.0)), time);
        CHECK_OK(sn_lab_uniaxial(&tissue, h, ROWS, time, stress));
        double peak = peak_of(stress, ROWS);
        for (int i = 0; i < ROWS; ++i) {
            sn_history_at(h, time[i], &at);
            double s11 = oracle_hereditary(h, &tissue.memory, time[i], demiray_s11, v);
            double s22 = oracle_hereditary(h, &tissue.memory, time[i], demiray_s22, v);
            CHECK_ABS(stress[i], at * s11 - s22 / (at * at), 1e-7 * peak);
        }
        sn_history_destroy(h);
    }
}

// The two ways of the machine agree where both apply: incompressible with equal sides.
static void lateral_solution_agrees_with_closed_form(void **state) {
    (void)state;
    double time[ROWS], closed[ROWS], solved[2][ROWS];
    double v[] = {2.3e3, 9.0, (double)INFINITY};
    uint64_t seed = 5;
    sn_tissue tissue = oracle_tissue("demiray", v, 3);
    tissue.memory = random_memory(0, &seed);
    sn_history *h = motion(1.19, 0.7, time);
    sn_path *path;
    sn_exponentials e;
    CHECK_OK(sn_memory_expand(&tissue.memory, &e));
    CHECK_OK(sn_path_create(h, ROWS, time, &path));
    CHECK_OK(sn_path_stress(path, &tissue, SN_PULL_CLOSED, &e, 16, closed));
    for (int j = 0; j < 2; ++j)
        CHECK_OK(sn_path_stress(path, &tissue, SN_PULL_LATERAL, &e, 16 << j, solved[j]));
    double peak = peak_of(closed, ROWS);
    for (int i = 0; i < ROWS; ++i) { // second order: what is left after Richardson is 1e-6
        double limit = solved[1][i] + (solved[1][i] - solved[0][i]) / 3.0;
        CHECK_ABS(limit, closed[i], 2e-6 * peak);
    }
    sn_path_destroy(path);
    sn_history_destroy(h);
}

//---- direct convolution for a compressible solid
//---------------------------------------------------

enum { STEPS = 240 };

// neo-Hookean at J != 1: S_d = mu J^(-2/3) (1 - I1/3 C^-1)
static void neo_hookean(double mu, double stretch, double side, double *s11, double *s22) {
    double J = stretch * side * side, i1 = stretch * stretch + 2.0 * side * side;
    double f = mu * pow(J, -2.0 / 3.0);
    *s11 = f * (1.0 - i1 / 3.0 / (stretch * stretch));
    *s22 = f * (1.0 - i1 / 3.0 / (side * side));
}

// mean of G over [a, b], Simpson on 8 pieces
static double mean_relaxation(const sn_memory *m, double a, double b) {
    double sum = 0.0;
    for (int i = 0; i <= 16; ++i)
        sum += (i == 0 || i == 16 ? 1.0
                : i % 2           ? 4.0
                                  : 2.0) *
               sn_memory_relaxation(m, a + (b - a) * i / 16.0);
    return sum / 48.0;
}

// stress after a ramp of `seconds` to `top`, channels as increments weighted with the mean of G;
// the side stretch by bisection. Second order in the step.
static double convolved(double mu, double K, const sn_memory *m, double top, double seconds,
                        int steps) {
    double increment[3][STEPS], before[3] = {0.0, 0.0, 0.0}, nominal = (double)NAN,
                                h = seconds / steps;
    for (int n = 0; n < steps; ++n) {
        double stretch = 1.0 + (top - 1.0) * (n + 1) / steps, history[3] = {0.0, 0.0, 0.0};
        for (int k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c)
                history[c] += mean_relaxation(m, (n - k) * h, (n - k + 1) * h) * increment[c][k];
        double now = mean_relaxation(m, 0.0, h), low = 0.7, high = 1.0, value[3];
        for (int i = 0; i < 55; ++i) {
            double side = 0.5 * (low + high), J = stretch * side * side, total[3];
            neo_hookean(mu, stretch, side, &value[0], &value[1]);
            value[2] = K * (J - 1.0);
            for (int c = 0; c < 3; ++c) total[c] = history[c] + now * (value[c] - before[c]);
            double s22 = total[1] * side * side + total[2] * J;
            *(s22 > 0.0 ? &high : &low) = side;
            nominal = stretch * total[0] + total[2] * J / stretch;
        }
        for (int c = 0; c < 3; ++c) {
            increment[c][n] = value[c] - before[c];
            before[c] = value[c];
        }
    }
    return nominal;
}

static void compressible_solid_follows_direct_convolution(void **state) {
    (void)state;
    const double ratios[] = {1.3, 20.0};
    for (int k = 0; k < 4; ++k) {
        double mu = 3.1e3, K = ratios[k / 2] * mu, v[] = {mu, K}, stress, top = 1.37, seconds = 2.3;
        uint64_t seed = 11;
        sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
        tissue.memory = random_memory(k, &seed);
        const double knots[] = {0.0, seconds}, value[] = {1.0, top};
        sn_history *h;
        CHECK_OK(sn_history_create(1, 2, knots, value, &h));
        CHECK_OK(sn_lab_uniaxial(&tissue, h, 1, &knots[1], &stress));
        double coarse = convolved(mu, K, &tissue.memory, top, seconds, STEPS / 2);
        double fine = convolved(mu, K, &tissue.memory, top, seconds, STEPS);
        double limit = fine + (fine - coarse) / 3.0;
        // what Richardson leaves is a small part of what it moved; 1e-7 is the machine's own
        // promise
        CHECK_ABS(stress, limit, 0.1 * fabs(fine - coarse) + 1e-7 * stress);
        assert_true(fabs(fine - coarse) < 1e-4 * stress);
        sn_history_destroy(h);
    }
}

// K over mu of 1e6: the incompressible stress to mu/K
static void compressible_tends_to_incompressible(void **state) {
    (void)state;
    double time[ROWS], soft[ROWS], limit[ROWS], v[] = {2e3, 2e9};
    uint64_t seed = 21;
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    tissue.memory = random_memory(1, &seed);
    sn_history *h = motion(1.3, 0.4, time);
    CHECK_OK(sn_lab_uniaxial(&tissue, h, ROWS, time, soft));
    tissue.value[1] = (double)INFINITY;
    CHECK_OK(sn_lab_uniaxial(&tissue, h, ROWS, time, limit));
    double peak = peak_of(limit, ROWS);
    for (int i = 0; i < ROWS; ++i) CHECK_ABS(soft[i], limit[i], 3e-6 * peak);
    sn_history_destroy(h);
}

//---- membranes: strips with a free side
//-----------------------------------------------------------

// (21): A2 = a4 E11 + a2 E22 = 0 at the free side, at every stretch, so S11 is that of one axis
// with a = a1 - a4^2/a2; v = {c, a1, a2, a3, a4}
static double planar_s11(double stretch, const double *v) {
    double a = v[1] - v[4] * v[4] / v[2], E = 0.5 * (stretch * stretch - 1.0);
    return v[0] * a * E * exp(a * E * E);
}
static double planar_slope(double stretch, const double *v) {
    return (planar_s11(stretch + 1e-5, v) - planar_s11(stretch - 1e-5, v)) / 2e-5;
}

// T = L H[S11], because H[S22] = 0 where S22 = 0 at all times
static void membrane_strip_follows_quadrature(void **state) {
    (void)state;
    uint64_t seed = 1234;
    for (int k = 0; k < 4; ++k) {
        double time[ROWS], stress[ROWS], at;
        double v[] = {check_random(&seed, 1e3, 9e3), check_random(&seed, 3.0, 9.0),
                      check_random(&seed, 3.0, 9.0), 1.0, check_random(&seed, -2.0, 2.0)};
        sn_tissue tissue = oracle_tissue("fung-planar", v, 5);
        tissue.memory = random_memory(k, &seed);
        sn_history *h = motion(k == 2 ? 0.93 : check_random(&seed, 1.1, 1.4),
                               pow(10.0, check_random(&seed, -1.3, 1.0)), time);
        CHECK_OK(sn_lab_uniaxial(&tissue, h, ROWS, time, stress));
        double peak = peak_of(stress, ROWS);
        assert_true(peak > 0.1 * v[0]);
        for (int i = 0; i < ROWS; ++i) {
            sn_history_at(h, time[i], &at);
            double H = oracle_hereditary(h, &tissue.memory, time[i], planar_slope, v);
            CHECK_ABS(stress[i], at * H, 2e-7 * peak);
        }
        sn_history_destroy(h);
    }
}

// the law of skin, whose free side has no closed form: S22 = 0 along the elastic curve, which is a
// biaxial test with the side where the strip puts it
static void skin_strip_has_a_free_side(void **state) {
    (void)state;
    double v[] = {1.1e3, 0.8e3, 0.5e3, 0.3e3, 2.3e3, 3.1, 2.4, 1.3, 0.9, 0.7, 0.5, 0.3, 0.2};
    sn_tissue tissue = oracle_tissue("fung-skin", v, 13);
    sn_protocol pull = sn_protocol_default(SN_PROTOCOL_TENSILE),
                both = sn_protocol_default(SN_PROTOCOL_BIAXIAL);
    sn_record *strip, *record;
    pull.stretch = both.stretch_1 = 1.31;
    CHECK_OK(sn_lab_test(&tissue, &pull, &strip));
    double T = sn_record_values(strip, "stress")[pull.points - 1], low = 0.8, high = 1.0;
    for (int i = 0; i < 45; ++i) { // the side stress rises with the side stretch
        both.stretch_2 = 0.5 * (low + high);
        CHECK_OK(sn_lab_test(&tissue, &both, &record));
        bool pulls = sn_record_values(record, "stress_2")[both.points - 1] > 0.0;
        *(pulls ? &high : &low) = both.stretch_2;
        if (i == 44) CHECK_REL(sn_record_values(record, "stress_1")[both.points - 1], T, 1e-11);
        sn_record_destroy(record);
    }
    assert_true(T > 1e3 && low > 0.82 && low < 0.99);
    sn_record_destroy(strip);
}

// after a step everything relaxes with G, sides and pressure included: T(t) = T(0) G(t)
static void steps_of_all_kinds_relax_with_g(void **state) {
    (void)state;
    double solid[] = {2e3, 5e3}, planar[] = {3e3, 5.0, 4.0, 1.0, 1.5},
           memory[] = {0.21, 0.03, 47.0};
    const double knot = 0.6, value = 1.17, time[] = {0.6, 0.61, 1.7, 60.0, 4000.0};
    for (int k = 0; k < 2; ++k) {
        double stress[5];
        sn_tissue tissue =
            k ? oracle_tissue("fung-planar", planar, 5) : oracle_tissue("neo-hookean", solid, 2);
        tissue.memory = oracle_memory("fung-spectrum", 0, memory, 3);
        sn_history *h;
        CHECK_OK(sn_history_create(1, 1, &knot, &value, &h));
        CHECK_OK(sn_lab_uniaxial(&tissue, h, 5, time, stress));
        for (int i = 0; i < 5; ++i)
            CHECK_REL(stress[i], stress[0] * sn_memory_relaxation(&tissue.memory, time[i] - knot),
                      1e-10);
        sn_history_destroy(h);
    }
}

//---- limits and closed forms
//-----------------------------------------------------------------------

static void no_memory_gives_the_elastic_stress(void **state) {
    (void)state;
    double v[] = {12.3, 2.7e4}, time[ROWS], stress[ROWS], at;
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    sn_history *h = motion(1.17, 0.9, time);
    CHECK_OK(sn_lab_uniaxial(&tissue, h, ROWS, time, stress));
    for (int i = 0; i < ROWS; ++i) {
        sn_history_at(h, time[i], &at);
        CHECK_ABS(stress[i], v[1] / v[0] * expm1(v[0] * (at - 1.0)), 1e-12 * v[1]);
    }
    sn_history_destroy(h);
}

// a step: T(t) = T(L) G(t), and 0 before it
static void step_relaxes_with_g(void **state) {
    (void)state;
    double v[] = {7.7, 1.9e4}, memory[] = {0.21, 0.03, 47.0};
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    tissue.memory = oracle_memory("fung-spectrum", 0, memory, 3);
    const double knot = 0.6, value = 1.123, time[] = {0.2, 0.6, 0.61, 1.7, 60.0, 4000.0};
    double stress[6], elastic = v[1] / v[0] * expm1(v[0] * 0.123);
    sn_history *h;
    CHECK_OK(sn_history_create(1, 1, &knot, &value, &h));
    CHECK_OK(sn_lab_uniaxial(&tissue, h, 6, time, stress));
    assert_true(stress[0] == 0.0);
    for (int i = 1; i < 6; ++i) // memory as exponentials is good to 1e-11
        CHECK_REL(stress[i], elastic * sn_memory_relaxation(&tissue.memory, time[i] - knot), 1e-10);
    sn_history_destroy(h);
}

// equation (27) through a ramp of a linear law: mu (u + tau du/dt) on the way, the jump drops at
// its end. The recorded corner has the stress of the motion before it.
static void voigt_ramp_has_its_closed_form(void **state) {
    (void)state;
    double modulus = 8.1e3, tau = 0.37, rate = 0.05;
    sn_tissue tissue = oracle_tissue("linear", &modulus, 1);
    tissue.memory = oracle_memory("voigt", 0, &tau, 1);
    const double knots[] = {0.0, 2.0, 9.0}, value[] = {1.0, 1.1, 1.1},
                 time[] = {0.5, 2.0, 2.1, 9.0};
    double stress[4];
    sn_history *h;
    CHECK_OK(sn_history_create(1, 3, knots, value, &h));
    CHECK_OK(sn_lab_uniaxial(&tissue, h, 4, time, stress));
    CHECK_REL(stress[0], modulus * rate * (0.5 + tau), 1e-12);
    CHECK_REL(stress[1], modulus * rate * (2.0 + tau), 1e-12);
    CHECK_REL(stress[2], modulus * 0.1, 1e-12);
    CHECK_REL(stress[3], modulus * 0.1, 1e-12);
    sn_history_destroy(h);
}

// Voigt in a compressible solid: the backward rate converges, if at first order only
static void voigt_solid_converges(void **state) {
    (void)state;
    double v[] = {2e3, 1e4}, tau = 0.2, stress[2], incompressible[2];
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    tissue.memory = oracle_memory("voigt", 0, &tau, 1);
    const double knots[] = {0.0, 1.0, 3.0}, value[] = {1.0, 1.2, 1.2}, time[] = {1.0, 3.0};
    sn_history *h;
    CHECK_OK(sn_history_create(1, 3, knots, value, &h));
    CHECK_OK(sn_lab_uniaxial(&tissue, h, 2, time, stress));
    tissue.value[1] = 2e9;
    CHECK_OK(sn_lab_uniaxial(&tissue, h, 2, time, stress));
    tissue.value[1] = (double)INFINITY;
    CHECK_OK(sn_lab_uniaxial(&tissue, h, 2, time, incompressible));
    for (int i = 0; i < 2; ++i) CHECK_REL(stress[i], incompressible[i], 1e-5);
    // elastic part: mu (L - 1/L2)
    CHECK_REL(incompressible[1], 2e3 * (1.2 - 1.0 / 1.44), 1e-9);
    assert_true(incompressible[0] > 1.1 * incompressible[1]);
    sn_history_destroy(h);
}

// H of one triangle from rest: Maxwell [2a - (1 - e)(3 - e)]/(a - 1 + e), a = T/tau, e = exp(-a);
// Voigt 2/(1 + T/(2 tau)). 4000 rows a leg: the trapezoid is off by 1e-7 of the area; the Voigt
// stress jumps at the turn, so the row there belongs to one leg only: an area of a row, 1/4000.
static void hysteresis_has_its_closed_forms(void **state) {
    (void)state;
    double modulus = 1e4;
    const double ramps[] = {0.02, 0.3, 1.9, 25.0};
    for (int k = 0; k < 4; ++k) {
        double tau = 0.83, T = ramps[k], a = T / tau, e = exp(-a);
        sn_tissue tissue = oracle_tissue("linear", &modulus, 1);
        sn_protocol protocol = sn_protocol_default(SN_PROTOCOL_CYCLIC);
        protocol.ramp = T;
        protocol.cycles = 1;
        protocol.points = 8001;
        for (int voigt = 0; voigt < 2; ++voigt) {
            sn_record *record;
            sn_curve curve;
            sn_cycles cycles;
            tissue.memory = oracle_memory(voigt ? "voigt" : "maxwell", 0, &tau, 1);
            CHECK_OK(sn_lab_test(&tissue, &protocol, &record));
            CHECK_OK(sn_curve_from_record(record, &curve));
            CHECK_OK(sn_reduce_cyclic(&curve, &cycles));
            assert_int_equal(cycles.count, 1);
            double expected = voigt ? 2.0 / (1.0 + T / (2.0 * tau))
                                    : (2.0 * a - (1.0 - e) * (3.0 - e)) / (a - 1.0 + e);
            CHECK_REL(cycles.cycle[0].hysteresis, expected, voigt ? 1e-3 : 1e-5);
            sn_cycles_release(&cycles);
            sn_curve_release(&curve);
            sn_record_destroy(record);
        }
    }
}

static void refusals_say_what_and_where(void **state) {
    (void)state;
    double v[] = {12.0, 1e4}, tau = 0.4, stress[2], nan = (double)NAN;
    const double knots[] = {0.0, 1.0}, value[] = {1.0, 1.1}, step[] = {1.05, 1.1};
    const double negative[] = {1.0, -0.2}, far[] = {1.0, 80.0};
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    sn_history *h;
    CHECK_OK(sn_history_create(1, 2, knots, value, &h));
    CHECK_FAILS(sn_lab_uniaxial(&tissue, h, 1, &nan, stress), SN_E_DATA, "time 1 is not finite");
    sn_history_destroy(h);

    tissue = oracle_tissue("exponential", v, 2);
    CHECK_OK(sn_history_create(1, 2, knots, negative, &h));
    CHECK_FAILS(sn_lab_uniaxial(&tissue, h, 2, knots, stress), SN_E_RANGE, "stretch at 1 s");
    sn_history_destroy(h);

    CHECK_OK(sn_history_create(1, 2, knots, far, &h));
    CHECK_FAILS(sn_lab_uniaxial(&tissue, h, 2, knots, stress), SN_E_RANGE, "overflows at stretch");
    sn_history_destroy(h);

    // cubic terms so strong that no side stretch is free of stress
    double runs_away[] = {0, 0, 0, 0, 1e3, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 900.0, 0.0};
    CHECK_OK(sn_history_create(1, 2, knots, value, &h));
    tissue = oracle_tissue("fung-skin", runs_away, 13);
    CHECK_FAILS(sn_lab_uniaxial(&tissue, h, 2, knots, stress), SN_E_SOLVER, "finds no free side");
    sn_history_destroy(h);

    tissue = oracle_tissue("exponential", v, 2);
    tissue.memory = oracle_memory("voigt", 0, &tau, 1);
    CHECK_OK(sn_history_create(1, 2, knots, step, &h));
    CHECK_FAILS(sn_lab_uniaxial(&tissue, h, 2, knots, stress), SN_E_RANGE, "infinite stress");
    sn_history_destroy(h);
}

// As many rows on a ramp as there are steps at the coarsest, or twice as many: a machine that
// halves its steps must do so between the rows as well. Against quadrature, to the 1e-7 of the peak
// that the machine promises.
static void steps_are_halved_between_dense_rows(void **state) {
    (void)state;
    const double v[] = {23.0, 1.3e3}, prony[] = {0.31, 0.27, 0.004, 2.0}, knots[] = {0.0, 1.7},
                 value[] = {1.0, 1.31};
    sn_tissue t = oracle_tissue("exponential", v, 2);
    t.memory = oracle_memory("prony", 2, prony, 4);
    sn_history *h;
    CHECK_OK(sn_history_create(1, 2, knots, value, &h));
    for (int rows = 13; rows <= 37; rows += 12) {
        double time[37], stress[37];
        for (int i = 0; i < rows; ++i) time[i] = 1.7 * i / (rows - 1);
        CHECK_OK(sn_lab_uniaxial(&t, h, rows, time, stress));
        for (int i = 1; i < rows; ++i)
            CHECK_ABS(stress[i], oracle_hereditary(h, &t.memory, time[i], exponential_slope, v),
                      1e-7 * stress[rows - 1]);
    }
    sn_history_destroy(h);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponential_law_follows_quadrature),
        cmocka_unit_test(incompressible_solid_follows_quadrature),
        cmocka_unit_test(lateral_solution_agrees_with_closed_form),
        cmocka_unit_test(compressible_solid_follows_direct_convolution),
        cmocka_unit_test(compressible_tends_to_incompressible),
        cmocka_unit_test(membrane_strip_follows_quadrature),
        cmocka_unit_test(skin_strip_has_a_free_side),
        cmocka_unit_test(steps_of_all_kinds_relax_with_g),
        cmocka_unit_test(no_memory_gives_the_elastic_stress),
        cmocka_unit_test(step_relaxes_with_g),
        cmocka_unit_test(voigt_ramp_has_its_closed_form),
        cmocka_unit_test(voigt_solid_converges),
        cmocka_unit_test(hysteresis_has_its_closed_forms),
        cmocka_unit_test(refusals_say_what_and_where),
        cmocka_unit_test(steps_are_halved_between_dense_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
