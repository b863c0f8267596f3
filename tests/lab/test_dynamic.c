// Dynamic moduli: sweeps and raw sinusoids with closed forms.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 41, RAW = 6000 };
static const double pi = 3.14159265358979323846;

// standard linear solid: E (1 - g + g i w tau/(1 + i w tau))
static double storage(double E, double g, double tau, double f) {
    double w = 2.0 * pi * f * tau;
    return E * (1.0 - g + g * w * w / (1.0 + w * w));
}
static double loss(double E, double g, double tau, double f) {
    double w = 2.0 * pi * f * tau;
    return E * g * w / (1.0 + w * w);
}

static sn_record *sweep_of(int rows, double g, double tau, double from, double to, bool backwards) {
    sn_record *record;
    CHECK_OK(sn_record_create("sweep.csv", &record));
    CHECK_OK(sn_record_add_series(record, "frequency", "Hz"));
    CHECK_OK(sn_record_add_series(record, "storage_modulus", "Pa"));
    CHECK_OK(sn_record_add_series(record, "loss_modulus", "Pa"));
    for (int i = 0; i < rows; ++i) {
        double f = from * pow(to / from, (double)(backwards ? rows - 1 - i : i) / (rows - 1));
        double row[] = {f, storage(3e4, g, tau, f), loss(3e4, g, tau, f)};
        CHECK_OK(sn_record_append(record, row));
    }
    return record;
}

// tan delta = g w/(1 - g + w^2), w in units of 1/tau: largest at w = sqrt(1 - g), g/(2 sqrt(1 -
// g)); plateaus E (1 - g) and E
static void solid_has_plateaus_and_a_peak(void **state) {
    (void)state;
    const double g = 0.6, tau = 0.3;
    sn_record *record = sweep_of(ROWS, g, tau, 1e-3, 1e3, true);
    sn_dynamic r;
    CHECK_OK(sn_reduce_sweep(record, &r));
    assert_int_equal(r.count, ROWS);
    assert_non_null(strstr(r.remarks, "order of frequency"));
    for (int k = 1; k < ROWS; ++k) assert_true(r.at[k].frequency > r.at[k - 1].frequency);
    CHECK_REL(r.at[20].tan_delta, loss(1, g, tau, 1.0) / storage(1, g, tau, 1.0), 1e-12);
    // seven points to a decade, a parabola over half a decade: the peak is 1/cosh of ln w, and
    // what the parabola leaves is of the fourth order, 5/24 u^4 with u up to 0.66: 4 %, less at
    // the vertex
    CHECK_REL(r.peak_tan_delta, g / (2.0 * sqrt(1.0 - g)), 0.02);
    CHECK_REL(r.peak_frequency, sqrt(1.0 - g) / (2.0 * pi * tau), 0.05);
    CHECK_REL(r.low_plateau, 3e4 * (1.0 - g), 1e-3); // w^2 at the end of the half decade
    CHECK_REL(r.high_plateau, 3e4, 1e-3);
    assert_true(!*r.peak_reason && !*r.low_reason && !*r.high_reason);
    sn_dynamic_release(&r);
    sn_record_destroy(record);
}

// a Maxwell body: tan delta falls as 1/w, E' rises as w^2 where w is small
static void what_the_record_does_not_reach_is_null_with_a_reason(void **state) {
    (void)state;
    sn_record *record = sweep_of(21, 1.0, 1e-4, 1.0, 100.0, false);
    sn_dynamic r;
    CHECK_OK(sn_reduce_sweep(record, &r));
    assert_true(isnan(r.peak_tan_delta) && isnan(r.peak_frequency));
    assert_non_null(strstr(r.peak_reason, "at the lower end of the record, 1 Hz"));
    assert_true(isnan(r.low_plateau) && isnan(r.high_plateau));
    assert_non_null(strstr(r.low_reason, "to the power 2.0"));
    CHECK_REL(r.storage_per_decade, 2.0, 1e-2); // w is 0.06 at most: 2 w^2/(1 + w^2)
    CHECK_REL(r.loss_per_decade, 1.0, 1e-2);
    sn_dynamic_release(&r);
    r.count = 0;
    sn_record_values(record, "loss_modulus")[3] = -1.0;
    CHECK_FAILS(sn_reduce_sweep(record, &r), SN_E_DATA, "sweep.csv: row 4: loss_modulus is -1");
    sn_record_values(record, "loss_modulus")[3] = 1.0;
    sn_record_values(record, "frequency")[3] = 1.0;
    CHECK_FAILS(sn_reduce_sweep(record, &r), SN_E_DATA, "rows 1 and 4 have the same frequency");
    sn_record_destroy(record);
    CHECK_OK(sn_record_create("other.csv", &record));
    CHECK_OK(sn_record_add_series(record, "frequency", "Hz"));
    CHECK_FAILS(sn_reduce_sweep(record, &r), SN_E_DATA, "no column storage_modulus");
    sn_record_destroy(record);
}

// Raw rows of several frequencies one after the other, `cycles` of each, unevenly in time, with a
// drift, a third harmonic of `third` of the first in the stress, and scatter.
typedef struct raw {
    int n;
    double time[RAW], stretch[RAW], stress[RAW];
} raw;
static const double amplitude = 0.02, E = 3e4, g = 0.6, tau = 0.05;

static void add_part(raw *r, double f, double cycles, int per_cycle, double third, double noise,
                     uint64_t *seed) {
    double start = r->n ? r->time[r->n - 1] + 0.4 / f / per_cycle : 0.0;
    double Es = storage(E, g, tau, f), El = loss(E, g, tau, f), T = amplitude * hypot(Es, El);
    for (int i = 0; i < cycles * per_cycle; ++i) {
        double t = (i + check_random(seed, 0.0, 0.9)) / f / per_cycle, phase = 2.0 * pi * f * t;
        r->time[r->n] = start + t;
        r->stretch[r->n] = 1.1 + amplitude * sin(phase) + noise * amplitude * oracle_normal(seed);
        r->stress[r->n++] = 2e3 - 3.0 * t + amplitude * (Es * sin(phase) + El * cos(phase)) +
                            third * T * sin(3.0 * phase + 0.4) + noise * T * oracle_normal(seed);
    }
}

static void sinusoids_give_the_moduli(void **state) {
    (void)state;
    static raw r;
    const double f[] = {0.3, 1.0, 4.0, 15.0}, noises[] = {0.0, 0.02};
    uint64_t seed = 77;
    for (int k = 0; k < 2; ++k) {
        r.n = 0;
        for (int i = 0; i < 4; ++i) add_part(&r, f[i], 8, 60, 0.05, noises[k], &seed);
        sn_curve curve = oracle_curve("raw", r.n, r.time, r.stretch, r.stress);
        sn_dynamic out;
        CHECK_OK(sn_reduce_oscillation(&curve, &out));
        assert_int_equal(out.count, 4);
        for (int i = 0; i < 4; ++i) {
            const sn_oscillation *o = &out.at[i];
            double Es = storage(E, g, tau, f[i]), El = loss(E, g, tau, f[i]), size = hypot(Es, El);
            int n = o->last - o->first + 1;
            assert_true(o->cycles == 6 && n > 6 * 55);
            // amplitudes in stretch and stress each have the error noise sqrt(2/n) of themselves:
            // 4.5 standard errors; 1e-9: rounding of time differences over a row
            double error = 4.5 * 2.0 * noises[k] * sqrt(1.0 / n) + 1e-9;
            CHECK_ABS(o->storage_modulus, Es, error * size);
            CHECK_ABS(o->loss_modulus, El, error * size);
            CHECK_ABS(o->phase, atan2(El, Es), error);
            CHECK_REL(o->frequency, f[i], error / o->cycles);
            CHECK_ABS(o->harmonic_distortion, 0.05, 2.0 * error);
            CHECK_REL(o->stretch_amplitude, amplitude, error);
            CHECK_ABS(o->mean_stretch, 1.1, error * amplitude);
            if (noises[k] > 0.0) { // the stated error knows the stress' scatter
                CHECK_REL(o->storage_error, noises[k] * sqrt(2.0 / n) * size, 0.2);
            }
        }
        assert_true(out.discarded > 0);
        assert_non_null(strstr(out.remarks, "outside the cycles that were fitted"));
        sn_dynamic_release(&out);
        sn_curve_release(&curve);
    }
}

static void no_sinusoids(void **state) {
    (void)state;
    static raw r;
    uint64_t seed = 7;
    sn_dynamic out;
    r.n = 0;
    add_part(&r, 1.0, 1.4, 50, 0.0, 0.0, &seed);
    sn_curve curve = oracle_curve("short", r.n, r.time, r.stretch, r.stress);
    CHECK_FAILS(sn_reduce_oscillation(&curve, &out), SN_E_DATA, "short: no sinusoids");
    sn_curve_release(&curve);
    curve = oracle_curve("timeless", r.n, NULL, r.stretch, r.stress);
    CHECK_FAILS(sn_reduce_oscillation(&curve, &out), SN_E_DATA, "no time column");
    for (int i = 0; i < r.n; ++i) curve.stretch[i] = 1.0;
    sn_curve_release(&curve);
    for (int i = 0; i < r.n; ++i) r.stretch[i] = 1.0;
    curve = oracle_curve("still", r.n, r.time, r.stretch, r.stress);
    CHECK_FAILS(sn_reduce_oscillation(&curve, &out), SN_E_DATA, "still: the stretch is 1");
    sn_curve_release(&curve);
}

// a triangle is used by its fundamental, and said to be no sine; the elastic spring has no loss
static void triangle_is_said(void **state) {
    (void)state;
    static raw r;
    sn_dynamic out;
    r.n = 1000;
    for (int i = 0; i < r.n; ++i) {
        double part = fmod(0.01 * i, 2.0);
        r.time[i] = 0.01 * i;
        r.stretch[i] = 1.0 + 0.1 * (part < 1.0 ? part : 2.0 - part);
        r.stress[i] = 5e3 * (r.stretch[i] - 1.0);
    }
    sn_curve curve = oracle_curve("triangle", r.n, r.time, r.stretch, r.stress);
    CHECK_OK(sn_reduce_oscillation(&curve, &out));
    assert_int_equal(out.count, 1);
    assert_non_null(strstr(out.remarks, "is no sine"));
    // the third harmonic, a ninth of the first, pulls the frequency by up to that part of a radian
    // over the cycles' length
    CHECK_REL(out.at[0].frequency, 0.5, 1.0 / 9.0 / (2.0 * pi * out.at[0].cycles));
    CHECK_REL(out.at[0].storage_modulus, 5e3, 1e-9);
    CHECK_ABS(out.at[0].loss_modulus, 0.0, 1e-6);
    sn_dynamic_release(&out);
    sn_curve_release(&curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_has_plateaus_and_a_peak),
        cmocka_unit_test(what_the_record_does_not_reach_is_null_with_a_reason),
        cmocka_unit_test(sinusoids_give_the_moduli),
        cmocka_unit_test(no_sinusoids),
        cmocka_unit_test(triangle_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
