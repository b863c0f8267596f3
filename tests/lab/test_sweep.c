// Sweeps over speed: hysteresis against closed forms and published-precision tables, dynamic moduli
// against a simulated oscillation.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { SPEEDS = 9 };

// hysteresis at `points` ramp times from `from` to `to`
static void sweep(const sn_tissue *tissue, double stretch, double from, double to, int points,
                  double *H) {
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_HYSTERESIS);
    p.stretch = stretch;
    p.from = from;
    p.to = to;
    p.points = points;
    sn_record *record;
    CHECK_OK(sn_lab_test(tissue, &p, &record));
    assert_int_equal(record->rows, points);
    const double *f = sn_record_values(record, "frequency");
    for (int i = 0; i < points; ++i) {
        double ramp = from * pow(to / from, (double)i / (points - 1));
        CHECK_REL(f[i], 0.5 / ramp, 1e-14);
    }
    memcpy(H, sn_record_values(record, "hysteresis"), (size_t)points * sizeof *H);
    sn_record_destroy(record);
}

// One triangle from rest, a = T/tau, e = exp(-a): Maxwell [2a - (1 - e)(3 - e)]/(a - 1 + e), Voigt
// 2/(1 + T/(2 tau)). Below a = 0.01 the first form has lost the digits; its limit is 4a/3 there,
// good to a relative a.
static void maxwell_and_voigt_have_their_closed_forms(void **state) {
    (void)state;
    double modulus = 3.3e3, tau = 0.37, H[SPEEDS];
    sn_tissue tissue = oracle_tissue("linear", &modulus, 1);
    tissue.memory = oracle_memory("maxwell", 0, &tau, 1);
    sweep(&tissue, 1.137, 1e-5 * tau, 1e3 * tau, SPEEDS, H);
    for (int i = 0; i < SPEEDS; ++i) {
        double a = 1e-5 * pow(10.0, i), e = exp(-a), down = -expm1(-a);
        double expected = a < 0.01 ? 4.0 * a / 3.0 : (2.0 * a - down * (3.0 - e)) / (a - down);
        CHECK_REL(H[i], expected, a < 0.01 ? 1.1 * a : 1e-6);
    }
    assert_true(H[SPEEDS - 1] > 1.99); // pushed back: more than all of the work
    tissue.memory = oracle_memory("voigt", 0, &tau, 1);
    sweep(&tissue, 0.931, 1e-5 * tau, 1e3 * tau, SPEEDS, H);
    for (int i = 0; i < SPEEDS; ++i) CHECK_REL(H[i], 2.0 / (1.0 + 0.5e-5 * pow(10.0, i)), 1e-6);
}

static void check_table(const sn_tissue *tissue, double stretch, const double *table, double half) {
    double H[SPEEDS];
    sweep(tissue, stretch, 1e-4, 1e4, SPEEDS, H);
    for (int i = 0; i < SPEEDS; ++i) CHECK_ABS(H[i], table[i], half);
}

// Ramp times 1e-4 … 1e4 s, figures of an independent program, half a unit of their third
// decimal.
static void bell_and_plateau(void **state) {
    (void)state;
    static const double box[] = {0.0007, 0.0067, 0.050, 0.136, 0.175, 0.199, 0.162, 0.036, 0.004};
    static const double box_exp[] = {0.0008, 0.0079, 0.062, 0.186, 0.247,
                                     0.283,  0.247,  0.070, 0.008};
    double modulus = 1e4, v[] = {20.0, 2e4}, spectrum[] = {0.1, 0.01, 100.0}, flat[31];
    sn_tissue linear = oracle_tissue("linear", &modulus, 1);
    linear.memory = oracle_memory("fung-spectrum", 0, spectrum, 3);
    check_table(&linear, 1.1, box, 5.1e-4);
    sn_tissue hard = oracle_tissue("exponential", v, 2);
    hard.memory = linear.memory;
    check_table(&hard, 1.2, box_exp, 5.1e-4);

    // the plateau over three decades: 0.14 … 0.20, and 0.19 … 0.29 with the hardening spring
    sweep(&linear, 1.1, 0.1, 100.0, 31, flat);
    for (int i = 0; i < 31; ++i) assert_true(flat[i] > 0.135 && flat[i] < 0.205);
    sweep(&hard, 1.2, 0.1, 100.0, 31, flat);
    for (int i = 0; i < 31; ++i) assert_true(flat[i] > 0.185 && flat[i] < 0.29);

    // the bell, with a linear and with a hardening spring: nonlinearity does not flatten it
    double times[] = {1.0, 2.0}, bell[SPEEDS];
    hard.memory = oracle_memory("kelvin", 0, times, 2);
    linear.memory = hard.memory;
    for (int k = 0; k < 2; ++k) {
        sweep(k ? &hard : &linear, 1.2, 1e-4, 1e4, SPEEDS, bell);
        int top = 0, turns = 0;
        for (int i = 1; i < SPEEDS; ++i) {
            if (bell[i] > bell[top]) top = i;
            if (i > 1) turns += (bell[i] > bell[i - 1]) != (bell[i - 1] > bell[i - 2]);
        }
        assert_true(top == 4 || top == 5);
        assert_int_equal(turns, 1);
        assert_true(bell[0] < 2e-3 && bell[SPEEDS - 1] < 2e-3 && bell[top] > 0.3);
    }
}

// a solid whose sides are solved for, against the incompressible one whose sides are known: what is
// left is the shear over the bulk modulus, 1e-6 of the stress
static void compressible_solid_tends_to_incompressible(void **state) {
    (void)state;
    double v[] = {2.3e3, 2.3e9}, spectrum[] = {0.2, 0.03, 20.0}, soft[3], limit[3];
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    tissue.memory = oracle_memory("fung-spectrum", 0, spectrum, 3);
    sweep(&tissue, 1.23, 0.07, 11.0, 3, soft);
    tissue.value[1] = (double)INFINITY;
    sweep(&tissue, 1.23, 0.07, 11.0, 3, limit);
    for (int i = 0; i < 3; ++i) CHECK_ABS(soft[i], limit[i], 3e-6);
    // a Voigt memory, whose rates are differences that a larger bulk modulus would drown in
    // rounding: what is left is a part of 1e-3
    double tau = 0.6;
    tissue.memory = oracle_memory("voigt", 0, &tau, 1);
    sweep(&tissue, 1.23, 0.07, 11.0, 3, limit);
    tissue.value[1] = 2.3e6;
    sweep(&tissue, 1.23, 0.07, 11.0, 3, soft);
    for (int i = 0; i < 3; ++i) CHECK_ABS(soft[i], limit[i], 2e-4);
}

//---- dynamic -------------------------------------------------------------------------------------

// First harmonic of the simulated stress under L0 + a sin wt, after a hold so long that all but
// 1e-6 of the memory is gone, from the eighth period on. A sine of 400 straight lines lacks
// (2 pi/400)2/12 = 2e-5 of its amplitude and lags nothing; a2 f'''/f' is 1e-4 of the moduli and
// less; the start of the oscillation has left exp(-8 periods/tau), so the period is long enough.
static void check_oscillation(const sn_tissue *tissue, double mean, double frequency) {
    enum { LINES = 400, PERIODS = 9, KNOTS = LINES * PERIODS + 3 };
    const double a = 1e-3, start = 2000.0, w = 6.283185307179586 * frequency;
    double *time = sn_alloc(3 * KNOTS, sizeof *time), *value = time + KNOTS,
           *stress = value + KNOTS;
    time[0] = 0.0, value[0] = 1.0;
    time[1] = 1.0, value[1] = mean;
    for (int i = 0; i <= LINES * PERIODS; ++i) {
        double s = i / (LINES * frequency);
        time[2 + i] = start + s;
        value[2 + i] = mean + a * sin(w * s);
    }
    sn_history *h;
    CHECK_OK(sn_history_create(1, KNOTS, time, value, &h));
    CHECK_OK(sn_lab_uniaxial(tissue, h, KNOTS, time, stress));
    double in = 0.0, out = 0.0;
    for (int i = LINES * (PERIODS - 1); i < LINES * PERIODS; ++i) {
        double s = i / (LINES * frequency);
        in += 2.0 / LINES * stress[2 + i] * sin(w * s) / a;
        out += 2.0 / LINES * stress[2 + i] * cos(w * s) / a;
    }
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    p.stretch = mean;
    p.from = frequency;
    p.to = 2.0 * frequency;
    p.points = 3;
    sn_record *record;
    CHECK_OK(sn_lab_test(tissue, &p, &record));
    double storage = sn_record_values(record, "storage_modulus")[0];
    double loss = sn_record_values(record, "loss_modulus")[0];
    assert_true(loss > 0.02 * storage);
    CHECK_ABS(in, storage, 3e-4 * storage);
    CHECK_ABS(out, loss, 3e-4 * storage);
    sn_record_destroy(record);
    sn_history_destroy(h);
    sn_free(time);
}

static void moduli_follow_a_simulated_oscillation(void **state) {
    (void)state;
    double v[] = {9.7, 1.3e4}, solid[] = {2.1e3, 3.7, (double)INFINITY};
    double prony[] = {0.31, 0.22, 0.05, 0.9};
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    tissue.memory = oracle_memory("prony", 2, prony, 4);
    check_oscillation(&tissue, 1.083, 0.23);
    tissue = oracle_tissue("demiray", solid, 3);
    tissue.memory = oracle_memory("prony", 2, prony, 4);
    check_oscillation(&tissue, 1.19, 0.31);
    check_oscillation(&tissue, 1.0, 1.7);
}

// sides that move as well: a compressible solid, an incompressible one whose sides differ, a strip
static void moduli_with_free_sides_follow_a_simulated_oscillation(void **state) {
    (void)state;
    double compressible[] = {2.1e3, 4.7e3}, planar[] = {4e3, 5.0, 4.0, 1.0, 1.5};
    double fung[] = {1e3, 9.0, 2.0, 4.0, 1.0, 1.2, 0.9, 2.0, 2.0, 2.0, (double)INFINITY};
    double prony[] = {0.31, 0.22, 0.05, 0.9};
    sn_tissue tissue = oracle_tissue("neo-hookean", compressible, 2);
    tissue.memory = oracle_memory("prony", 2, prony, 4);
    check_oscillation(&tissue, 1.31, 0.23);
    tissue = oracle_tissue("fung-planar", planar, 5);
    tissue.memory = oracle_memory("prony", 2, prony, 4);
    check_oscillation(&tissue, 1.12, 0.31);
    tissue = oracle_tissue("fung", fung, 1);
    memcpy(tissue.value, fung, sizeof fung);
    tissue.memory = oracle_memory("prony", 2, prony, 4);
    check_oscillation(&tissue, 1.09, 0.31);
}

// at rest every solid has E G*(w), E = 9 K mu/(3 K + mu): (24), (27), (29) for single bodies
static void solids_at_rest_have_their_closed_forms(void **state) {
    (void)state;
    double v[] = {2e3, 3e3}, E = 9.0 * 3e3 * 2e3 / (3.0 * 3e3 + 2e3), tau = 0.4,
           times[] = {0.5, 1.3};
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    p.points = 7;
    for (int k = 0; k < 3; ++k) {
        sn_record *record;
        tissue.memory = k == 0   ? oracle_memory("maxwell", 0, &tau, 1)
                        : k == 1 ? oracle_memory("voigt", 0, &tau, 1)
                                 : oracle_memory("kelvin", 0, times, 2);
        CHECK_OK(sn_lab_test(&tissue, &p, &record));
        for (int i = 0; i < p.points; ++i) {
            double w = 6.283185307179586 * sn_record_values(record, "frequency")[i], x = w * tau;
            double e2 = w * w * 0.25, storage, loss;
            storage = k == 0   ? x * x / (1.0 + x * x)
                      : k == 1 ? 1.0
                               : 0.5 / 1.3 * (1.0 + w * w * 0.65) / (1.0 + e2);
            loss = k == 0 ? x / (1.0 + x * x) : k == 1 ? x : 0.5 / 1.3 * w * 0.8 / (1.0 + e2);
            CHECK_REL(sn_record_values(record, "storage_modulus")[i], E * storage, 1e-12);
            CHECK_REL(sn_record_values(record, "loss_modulus")[i], E * loss, 1e-12);
        }
        sn_record_destroy(record);
    }
}

// small triangles of solids and strips are those of a linear spring; what is left is the strain
static void small_triangles_have_their_closed_forms(void **state) {
    (void)state;
    double solid[] = {2e3, 5e3}, planar[] = {3e3, 5.0, 4.0, 1.0, 1.5}, tau = 0.37, H[3];
    for (int k = 0; k < 2; ++k) {
        sn_tissue tissue =
            k ? oracle_tissue("fung-planar", planar, 5) : oracle_tissue("neo-hookean", solid, 2);
        tissue.memory = oracle_memory("maxwell", 0, &tau, 1);
        sweep(&tissue, 1.0001, 0.1 * tau, 10.0 * tau, 3, H);
        for (int i = 0; i < 3; ++i) {
            double a = 0.1 * pow(10.0, i), e = exp(-a);
            CHECK_ABS(H[i], (2.0 * a - (1.0 - e) * (3.0 - e)) / (a - 1.0 + e), 3e-4);
        }
    }
}

// The loop of a sine of amplitude a = (target - 1)/2 on a linear law has the area pi a2 E'', once
// it has settled: after 9 periods of 0.8 s of a memory of 0.5 s. A sine of 100 lines a way is
// (pi/100)2/12 = 8e-5 of its amplitude short, and the trapezoids on 200 rows a way 4e-5.
static void sine_cycles_lose_the_loss_modulus(void **state) {
    (void)state;
    double modulus = 4.1e3, times[] = {0.5, 1.3}, storage, loss;
    sn_tissue tissue = oracle_tissue("linear", &modulus, 1);
    tissue.memory = oracle_memory("kelvin", 0, times, 2);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_CYCLIC);
    p.wave = SN_WAVE_SINE;
    p.stretch = 1.12;
    p.ramp = 0.4;
    p.cycles = 10;
    p.points = 4001;
    sn_record *record;
    sn_curve curve;
    sn_cycles cycles;
    CHECK_OK(sn_lab_test(&tissue, &p, &record));
    const double *t = sn_record_values(record, "time"), *l = sn_record_values(record, "stretch");
    const double *cycle = sn_record_values(record, "cycle");
    for (int i = 0; i < p.points; ++i) {
        double exact = 1.0 + 0.06 * (1.0 - cos(6.283185307179586 * t[i] / 0.8));
        CHECK_ABS(l[i], exact, 0.06 * 1.3e-4); // (pi/100)2/8
        assert_true(cycle[i] == fmax(1.0, ceil(i / 400.0)));
    }
    CHECK_OK(sn_curve_from_record(record, &curve));
    CHECK_OK(sn_reduce_cyclic(&curve, &cycles));
    assert_int_equal(cycles.count, 10);
    sn_memory_modulus(&tissue.memory, 6.283185307179586 / 0.8, &storage, &loss);
    CHECK_REL(cycles.cycle[9].loop_area, 3.141592653589793 * 0.06 * 0.06 * modulus * loss, 4e-4);
    sn_cycles_release(&cycles);
    sn_curve_release(&curve);
    sn_record_destroy(record);
    p = sn_protocol_default(SN_PROTOCOL_TENSILE);
    p.wave = SN_WAVE_SINE;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "tensile takes no wave");
}

static void moduli_at_rest_are_those_of_the_memory(void **state) {
    (void)state;
    double modulus = 7.7e3, tau = 0.21;
    sn_tissue tissue = oracle_tissue("linear", &modulus, 1);
    tissue.memory = oracle_memory("voigt", 0, &tau, 1);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    p.points = 5;
    sn_record *record;
    CHECK_OK(sn_lab_test(&tissue, &p, &record));
    for (int i = 0; i < 5; ++i) {
        double f = sn_record_values(record, "frequency")[i];
        CHECK_REL(f, 0.01 * pow(10.0, i), 1e-14);
        CHECK_REL(sn_record_values(record, "storage_modulus")[i], modulus, 1e-15);
        CHECK_REL(sn_record_values(record, "loss_modulus")[i],
                  modulus * 6.283185307179586 * f * tau, 1e-14);
    }
    sn_record_destroy(record);
}

static void refusals_say_what(void **state) {
    (void)state;
    double v[] = {2e3, 2e4};
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    sn_record *record;
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    p.to = p.from;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "from and to are both 0.01");
    p = sn_protocol_default(SN_PROTOCOL_HYSTERESIS);
    p.stretch = 1.0;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "nothing would move");
    p.from = 0.0;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "protocol hysteresis: from");
    CHECK_FAILS(sn_protocol_set(&p, "hold", 1.0), SN_E_NAME, "protocol hysteresis takes no hold");
    CHECK_OK(sn_protocol_set(&p, "points", 7.0));
    assert_int_equal(p.points, 7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maxwell_and_voigt_have_their_closed_forms),
        cmocka_unit_test(bell_and_plateau),
        cmocka_unit_test(compressible_solid_tends_to_incompressible),
        cmocka_unit_test(moduli_follow_a_simulated_oscillation),
        cmocka_unit_test(moduli_with_free_sides_follow_a_simulated_oscillation),
        cmocka_unit_test(solids_at_rest_have_their_closed_forms),
        cmocka_unit_test(small_triangles_have_their_closed_forms),
        cmocka_unit_test(sine_cycles_lose_the_loss_modulus),
        cmocka_unit_test(moduli_at_rest_are_those_of_the_memory),
        cmocka_unit_test(refusals_say_what),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
