// Reduction of what laboratories record: cycles before the pull, holds, scatter, uneven rows.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 1000, MANY = 8000 };

typedef struct rows {
    int n;
    double time[MANY], stretch[MANY], stress[MANY];
} rows;

static const double B = 25.0, C = 1e4; // exponential curve, stress to 0.2: 59 kPa

static double exponential(double strain) {
    return C / B * expm1(B * strain);
}

// a way of the stretch in n rows, unevenly in time where `uneven`
static void way(rows *r, double from, double to, double seconds, int n, bool uneven,
                uint64_t *seed) {
    double start = r->n ? r->time[r->n - 1] : -seconds / n;
    for (int i = 1; i <= n; ++i) {
        double part = (double)i / n;
        if (uneven && i < n) part -= check_random(seed, 0.0, 0.9 / n);
        r->time[r->n] = start + seconds * part;
        r->stretch[r->n++] = from + (to - from) * part;
    }
}

static sn_curve curve_of(const char *name, const rows *r) {
    return oracle_curve(name, r->n, r->time, r->stretch, r->stress);
}

// bilinear: the yield is sp + Ep o/(1 - Ep/E); the stress falls by a third in the hold, in which
// the stretch flickers
static void a_hold_after_the_pull_is_no_yield(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 4;
    for (int k = 0; k < 2; ++k) { // without and with a yield
        r.n = 0;
        way(&r, 1.0, 1.1, 10.0, ROWS, true, &seed);
        way(&r, 1.1, 1.1, 60.0, ROWS, true, &seed);
        way(&r, 1.1, 1.02, 10.0, ROWS, true, &seed);
        double E = 5e6, Ep = 2e5, sp = k ? 3e5 : 1e9;
        for (int i = 0; i < r.n; ++i) {
            double e = r.stretch[i] - 1.0;
            r.stress[i] = E * e < sp ? E * e : sp + Ep * (e - sp / E);
            if (i >= ROWS) r.stress[i] *= 1.0 - 0.33 * fmin(1.0, (r.time[i] - 10.0) / 60.0);
            if (i >= ROWS && i < 2 * ROWS) r.stretch[i] += 1e-4 * (i % 3 - 1);
        }
        sn_curve curve = curve_of("held", &r);
        sn_tensile out;
        CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
        CHECK_REL(out.youngs_modulus, E, 3e-3);
        if (k) CHECK_REL(out.yield_stress, sp + Ep * 0.002 / (1.0 - Ep / E), 3e-3);
        if (!k) {
            assert_true(isnan(out.yield_stress) && isnan(out.yield_strain));
            assert_non_null(strstr(out.reason, "no intersection"));
            CHECK_REL(out.ultimate_tensile_strength, E * 0.1, 6e-3); // half a percent of the way
        }
        assert_true(out.last < ROWS && out.last > 0.99 * ROWS);
        assert_int_equal(out.discarded, r.n - 1 - out.last);
        assert_non_null(strstr(out.remarks, "after it reached its largest stretch"));
        sn_tensile_release(&out);
        sn_curve_release(&curve);
    }
}

// four cycles to 5 %, a rest, the pull to 20 %, and the way back
static void preconditioned(rows *r, uint64_t *seed) {
    r->n = 0;
    for (int k = 0; k < 4; ++k) {
        way(r, 1.0, 1.05, 5.0, 100, true, seed);
        way(r, 1.05, 1.0, 5.0, 100, true, seed);
    }
    way(r, 1.0, 1.0, 20.0, 200, true, seed);
    way(r, 1.0, 1.2, 20.0, ROWS, true, seed);
    way(r, 1.2, 1.0, 20.0, 300, true, seed);
    for (int i = 0; i < r->n; ++i) {
        bool pull = i >= 1000 && i < 1000 + ROWS;
        r->stress[i] = (pull ? 1.0 : 0.8) * exponential(r->stretch[i] - 1.0);
    }
}

static void the_last_full_ramp_is_used(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 5;
    preconditioned(&r, &seed);
    sn_curve curve = curve_of("pull", &r);
    sn_tensile out;
    CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
    assert_int_equal(out.ramps, 5);
    assert_int_equal(out.ramp, 5);
    assert_true(abs(out.first - 999) <= 8 && abs(out.last - 1999) <= 1); // 0.5 % of the way
    assert_int_equal(out.discarded, r.n - (out.last - out.first + 1));
    assert_non_null(strstr(out.remarks, "loading ramp 5 of 5 used"));
    CHECK_REL(out.B, B, 3e-3);
    CHECK_REL(out.C, C, 3e-3);
    CHECK_REL(out.ultimate_tensile_strength, exponential(0.2), 1e-12);
    assert_true(strncmp(out.slope_test, "straight", 8) == 0);
    sn_tensile_release(&out);
    sn_tensile_def def = sn_tensile_def_default();
    def.ramp = 2;
    CHECK_OK(sn_reduce_tensile(&curve, &def, &out));
    CHECK_REL(out.ultimate_tensile_strength, 0.8 * exponential(0.05), 1e-3);
    sn_tensile_release(&out);
    def.ramp = 6;
    CHECK_FAILS(sn_reduce_tensile(&curve, &def, &out), SN_E_RANGE,
                "pull: loading ramp 6 asked for, the record has 5");
    sn_curve_release(&curve);
}

// strain from the preload: the exponential about a later zero is one with C + B p; the toe ends
// ln 2/B before the steepest slope
static void preload_toe_and_window(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 6;
    r.n = 0;
    way(&r, 1.0, 1.2, 20.0, ROWS, true, &seed);
    for (int i = 0; i < r.n; ++i) r.stress[i] = exponential(r.stretch[i] - 1.0);
    sn_curve curve = curve_of("toe", &r);
    sn_tensile_def def = sn_tensile_def_default();
    sn_tensile out;
    def.preload = 2e3;
    CHECK_OK(sn_reduce_tensile(&curve, &def, &out));
    double zero = 1.0 + log1p(B * def.preload / C) / B;
    CHECK_REL(out.preload_stretch, zero, 1e-6); // a row's chord: (B row)^2/8 of a row, 2e-4
    CHECK_REL(out.strain_at_ultimate, 1.2 / zero - 1.0, 1e-5);
    CHECK_REL(out.B, B * zero, 3e-3);
    CHECK_REL(out.C, C * zero, 2e-2);
    // the steepest window is half of 1 % of the strain before the end
    CHECK_ABS(out.toe_limit, (1.2 - log(2.0) / B) / zero - 1.0, 0.01 * 0.2);
    assert_non_null(strstr(out.remarks, "under the preload left out"));
    sn_tensile_release(&out);
    def = sn_tensile_def_default();
    def.from = 0.05;
    def.to = 0.06;
    CHECK_OK(sn_reduce_tensile(&curve, &def, &out));
    CHECK_REL(out.youngs_modulus, C * exp(B * 0.055), 0.01); // (B/2 0.01)^2/10 and a row
    CHECK_REL(out.chord_modulus, C * exp(B * 0.055), 0.01);
    assert_non_null(strstr(out.modulus_method, "chosen window, strain 0.05"));
    sn_tensile_release(&out);
    def.from = 0.3;
    def.to = 0.4;
    CHECK_FAILS(sn_reduce_tensile(&curve, &def, &out), SN_E_RANGE,
                "toe: 0 rows between strain 0.3 and 0.4");
    def = sn_tensile_def_default();
    def.preload = 1e6;
    CHECK_FAILS(sn_reduce_tensile(&curve, &def, &out), SN_E_DATA, "the preload of 1e+06 Pa lies");
    sn_curve_release(&curve);
    for (int i = 0; i < r.n; ++i) r.stress[i] = 1e4 * (r.stretch[i] - 1.0);
    curve = curve_of("line", &r);
    CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
    assert_true(isnan(out.toe_limit));
    assert_non_null(strstr(out.toe_reason, "starts at 100 %"));
    sn_tensile_release(&out);
    sn_curve_release(&curve);
}

// scatter s: the mean over (10 s/p)^2 rows is known to p/10, so the crossing to that over the slope
// there, C + B p; three times, and twice for the middle of several crossings
static void preload_through_scatter(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 13;
    for (int k = 0; k < 20; ++k) {
        r.n = 0;
        way(&r, 1.0, 1.2, 20.0, 4 * ROWS, true, &seed);
        for (int i = 0; i < r.n; ++i)
            r.stress[i] = exponential(r.stretch[i] - 1.0) + 500.0 * oracle_normal(&seed);
        sn_curve curve = curve_of("noisy", &r);
        sn_tensile_def def = sn_tensile_def_default();
        sn_tensile out;
        def.preload = 1e3;
        CHECK_OK(sn_reduce_tensile(&curve, &def, &out));
        double zero = 1.0 + log1p(B * def.preload / C) / B;
        CHECK_ABS(out.preload_stretch, zero, 2.0 * 3.0 * 100.0 / (C + B * def.preload));
        sn_tensile_release(&out);
        sn_curve_release(&curve);
    }
}

// Scatter s of the stress, rows at random: the slope against stress. A slope over the window has
// the standard error 3 % of the steepest, S = B T + C; there are range/window of them on their own,
// and the stress they are regressed on has the standard deviation d. 4 standard errors of B.
static void scatter_leaves_the_slopes(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 7;
    double top = exponential(0.2), mean = 0.0, square = 0.0;
    for (int i = 0; i < 1000; ++i) {
        double T = exponential(0.2 * (i + 0.5) / 1000);
        mean += T / 1000;
        square += T * T / 1000;
    }
    double spread = sqrt(square - mean * mean);
    for (int k = 0; k < 20; ++k) {
        r.n = 0;
        way(&r, 1.0, 1.2, 20.0, ROWS, true, &seed);
        double sigma = 0.01 * top;
        for (int i = 0; i < r.n; ++i)
            r.stress[i] = exponential(r.stretch[i] - 1.0) + sigma * oracle_normal(&seed);
        sn_curve curve = curve_of("noisy", &r);
        sn_tensile out;
        CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
        CHECK_REL(out.stress_noise, sigma, 0.2); // 1000 rows, a median: 4 x 1.17/sqrt(1000)
        assert_true(out.slope_window > 0.005 && out.slope_window < 0.03); // not the 1 % of no noise
        double error = 0.03 * (B * top + C) / sqrt(0.2 / out.slope_window) / spread;
        CHECK_ABS(out.B, B, 4.0 * error);
        CHECK_ABS(out.C, C, 4.0 * error * mean * 1.5);
        assert_true(isnan(out.yield_stress));
        assert_true(strncmp(out.slope_test, "not straight", 12) != 0);
        sn_tensile_release(&out);
        sn_curve_release(&curve);
    }
}

// a parabola's slope goes with the root of the stress: far from (13), and said
static void a_bent_slope_is_said(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 8;
    r.n = 0;
    way(&r, 1.0, 1.2, 20.0, ROWS, false, &seed);
    for (int i = 0; i < r.n; ++i) {
        double e = r.stretch[i] - 1.0;
        r.stress[i] = 1e6 * e * e + 100.0 * oracle_normal(&seed);
    }
    sn_curve curve = curve_of("parabola", &r);
    sn_tensile out;
    CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
    assert_non_null(strstr(out.slope_test, "not straight, the slope rises slower than (13)"));
    assert_true(out.slope_curvature < -0.05 && out.slope_curvature_t < -3.0);
    sn_tensile_release(&out);
    sn_curve_release(&curve);
}

// offset yield through scatter: the curve bends by Ep/E, the height of the line under the curve is
// 0.002 E, and its mean is known to a fifth of that: the crossing moves by up to 3/5 of 0.002
static void yield_through_scatter(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 9;
    const double E = 1e8, Ep = 5e6, sp = 4e6;
    for (int k = 0; k < 20; ++k) {
        r.n = 0;
        way(&r, 1.0, 1.2, 20.0, 4000, true, &seed);
        for (int i = 0; i < r.n; ++i) {
            double e = r.stretch[i] - 1.0;
            r.stress[i] =
                (E * e < sp ? E * e : sp + Ep * (e - sp / E)) + 1e5 * oracle_normal(&seed);
        }
        sn_curve curve = curve_of("metal", &r);
        sn_tensile out;
        CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
        // 800 rows of scatter 1e5 over 0.04: 1e5 sqrt(12/800)/0.04, 0.3 %; and 2 % by the method
        CHECK_REL(out.youngs_modulus, E, 0.03);
        // the line's zero and slope move the crossing, which the flat curve hardly feels
        CHECK_REL(out.yield_stress, sp + Ep * 0.002 / (1.0 - Ep / E), 0.04);
        sn_tensile_release(&out);
        for (int i = 0; i < r.n; ++i) curve.stress[i] += 2e6 * oracle_normal(&seed);
        CHECK_OK(sn_reduce_tensile(&curve, NULL, &out));
        assert_true(isnan(out.yield_stress));
        assert_non_null(strstr(out.reason, "hides a 0.2 % offset"));
        sn_tensile_release(&out);
        sn_curve_release(&curve);
    }
}

//---- cycles --------------------------------------------------------------------------------------

// friction that settles as 1 + exp(-k): loading k e2/2 + f e, loop 2 f e; sine ways, holds between
static void cycles_settle(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 10;
    enum { CYCLES = 8, LEG = 200, HOLD = 50 };
    const double pi = 3.14159265358979323846, k = 3e4, top = 0.1;
    for (int noisy = 0; noisy < 2; ++noisy) {
        r.n = 0;
        for (int c = 0; c < CYCLES; ++c)
            for (int i = 0; i < 2 * (LEG + HOLD); ++i) {
                bool up = i < LEG + HOLD;
                int at = up ? i : i - LEG - HOLD;
                double part = at < LEG ? 0.5 - 0.5 * cos(pi * (at + 1) / LEG) : 1.0;
                double e = top * (up ? part : 1.0 - part), friction = 400.0 * (1.0 + exp(-c));
                r.time[r.n] = 0.01 * r.n;
                r.stretch[r.n] = 1.0 + e;
                r.stress[r.n] = k * e * (1.0 + 0.3 * exp(-c)) + (up ? friction : -friction);
                if (noisy) {
                    r.stretch[r.n] += 1e-3 * top * oracle_normal(&seed);
                    r.stress[r.n] += 1e-3 * k * top * oracle_normal(&seed);
                }
                ++r.n;
            }
        sn_curve curve = curve_of("cycles", &r);
        sn_cycles cycles;
        CHECK_OK(sn_reduce_cyclic(&curve, &cycles));
        assert_int_equal(cycles.count, CYCLES);
        for (int c = 0; c < CYCLES; ++c) {
            double f = 400.0 * (1.0 + exp(-c)), K = k * (1.0 + 0.3 * exp(-c));
            // the turn is found to a row in the sine's flat end and the scatter: 3e-3 of the way
            CHECK_REL(cycles.cycle[c].hysteresis, 2.0 * f / (0.5 * K * top + f), 0.02);
            CHECK_REL(cycles.cycle[c].peak_stress, K * top + f, noisy ? 5e-3 : 1e-3);
        }
        // changes of H from cycle c to c + 1, at least 2 % up to c = 3 (5.5, 2.2 % after 2, 3)
        double before = 0.0;
        int settled = CYCLES;
        for (int c = CYCLES - 1; c >= 0; --c) {
            double f = 400.0 * (1.0 + exp(-c)), K = k * (1.0 + 0.3 * exp(-c));
            double H = 2.0 * f / (0.5 * K * top + f);
            if (c < CYCLES - 1 && fabs(before / H - 1.0) > 0.02) break;
            before = H;
            settled = c + 1;
        }
        assert_true(settled > 1 && settled < CYCLES);
        assert_true(abs(cycles.preconditioned_after - settled) <= noisy);
        sn_cycles_release(&cycles);
        curve.count = 2 * 2 * (LEG + HOLD);
        CHECK_OK(sn_reduce_cyclic(&curve, &cycles));
        assert_int_equal(cycles.preconditioned_after, 0);
        assert_non_null(strstr(cycles.reason, "from cycle 1 to 2 the peak stress changes by"));
        sn_cycles_release(&cycles);
        sn_curve_release(&curve);
    }
}

//---- relaxation ----------------------------------------------------------------------------------

// T = E (L - 1) (1 - 0.08 log10(1 + t/0.1)), t from the end of the ramp
static double held_stress(double E, double stretch, double t) {
    return E * (stretch - 1.0) * (t > 0.0 ? 1.0 - 0.08 * log10(1.0 + t / 0.1) : 1.0);
}

static void relaxation_after_cycles_and_an_overshoot(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 11;
    for (int noisy = 0; noisy < 2; ++noisy) {
        r.n = 0;
        for (int k = 0; k < 3; ++k) {
            way(&r, 1.0, 1.1, 2.0, 100, true, &seed);
            way(&r, 1.1, 1.0, 2.0, 100, true, &seed);
        }
        way(&r, 1.0, 1.0, 10.0, 100, true, &seed);
        double start = r.time[r.n - 1];
        way(&r, 1.0, 1.105, 2.1, 210, true, &seed);
        int end = r.n - 1;
        way(&r, 1.105, 1.1, 0.1, 10, true, &seed);
        way(&r, 1.1, 1.1, 300.0, 3000, true, &seed);
        for (int i = 0; i < r.n; ++i)
            r.stress[i] = held_stress(8e4, r.stretch[i], i > 700 ? r.time[i] - r.time[end] : 0.0);
        for (int i = 0; noisy && i < r.n; ++i) {
            r.stretch[i] += 2e-4 * oracle_normal(&seed);
            r.stress[i] += 40.0 * oracle_normal(&seed); // 0.5 % of the peak
        }
        sn_curve curve = curve_of("overshoot", &r);
        sn_relaxation_result out;
        CHECK_OK(sn_reduce_relaxation(&curve, &out));
        CHECK_REL(out.held_stretch, 1.1, 1e-4);
        // rest and top are known to six scatters of 2e-4 of a way of 0.105 in 2.1 s: 0.024 s, and
        // the rest within a row
        CHECK_ABS(out.ramp_s, r.time[end] - start, noisy ? 0.06 : 0.011);
        CHECK_ABS(out.overshoot, 0.05, noisy ? 0.01 : 1e-9); // four scatters of 0.1
        CHECK_REL(out.peak_stress, 8e4 * 0.105, noisy ? 0.02 : 1e-12);
        double last = held_stress(8e4, 1.1, 300.1);
        // sixty rows at the end: the end of a line is known to 2 scatters/sqrt(60), 10 Pa
        CHECK_REL(out.final_stress, last, noisy ? 0.01 : 2e-4);
        CHECK_ABS(out.rate_per_decade, 0.08 / 1.05, 0.01); // log10(1 + t/0.1) is bent before 1 s
        assert_int_equal(out.steps, 1);
        assert_true(abs(out.discarded - 700) <= 8);
        assert_non_null(strstr(out.remarks, "before the ramp left out"));
        assert_non_null(strstr(out.remarks, "overshoots"));
        assert_true(out.points > 20 && out.point_s[out.points - 1] > 200.0);
        sn_curve_release(&curve);
    }
}

static void one_of_several_steps_is_used(void **state) {
    (void)state;
    static rows r;
    uint64_t seed = 12;
    for (int larger = 0; larger < 2; ++larger) {
        r.n = 0;
        double at = 1.0;
        for (int k = 0; k < 3; ++k) {
            double to = at + (larger && k == 1 ? 0.06 : 0.04);
            way(&r, at, to, 0.5, 50, false, &seed);
            way(&r, to, to, 50.0, 500, false, &seed);
            at = to;
        }
        for (int i = 0; i < r.n; ++i)
            r.stress[i] = held_stress(8e4, r.stretch[i], fmod(r.time[i] + 0.005, 50.5) - 0.495);
        sn_curve curve = curve_of("steps", &r);
        sn_relaxation_result out;
        CHECK_OK(sn_reduce_relaxation(&curve, &out));
        assert_int_equal(out.steps, 3);
        assert_int_equal(out.step, larger ? 2 : 1);
        CHECK_REL(out.held_stretch, larger ? 1.1 : 1.04, 1e-12);
        CHECK_ABS(out.ramp_s, 0.5, 0.011);
        CHECK_ABS(out.hold_s, 50.0, 0.11);
        CHECK_REL(out.final_stress, held_stress(8e4, out.held_stretch, 50.0), 1e-3);
        assert_non_null(strstr(out.remarks, larger ? "step 2 of 3 used" : "step 1 of 3 used"));
        sn_curve_release(&curve);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hold_after_the_pull_is_no_yield),
        cmocka_unit_test(the_last_full_ramp_is_used),
        cmocka_unit_test(preload_toe_and_window),
        cmocka_unit_test(preload_through_scatter),
        cmocka_unit_test(scatter_leaves_the_slopes),
        cmocka_unit_test(a_bent_slope_is_said),
        cmocka_unit_test(yield_through_scatter),
        cmocka_unit_test(cycles_settle),
        cmocka_unit_test(relaxation_after_cycles_and_an_overshoot),
        cmocka_unit_test(one_of_several_steps_is_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
