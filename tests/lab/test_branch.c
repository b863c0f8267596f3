// A memory for each part of the stress on the virtual testing machine: closed forms, quadrature,
// direct convolution; equal memories against one.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 24 };

// of hgo: mu, k1, k2, kappa, angle, bulk; the fibres' share of the stress is about a half
static const double constants[6] = {2.3e3, 3.1e3, 1.7, 0.09, 0.0, (double)INFINITY};

static sn_tissue artery(double angle, double bulk) {
    sn_tissue t = oracle_tissue("hgo", constants, 6);
    double spectrum[] = {0.19, 0.017, 43.0}, prony[] = {0.31, 0.27, 0.06, 2.1},
           kelvin[] = {0.8, 2.3};
    t.value[4] = angle;
    t.value[5] = bulk;
    t.branched = true;
    t.memory = oracle_memory("prony", 2, prony, 4);
    t.fibre = oracle_memory("fung-spectrum", 0, spectrum, 3);
    if (isfinite(bulk)) t.volumetric = oracle_memory("kelvin", 0, kelvin, 2);
    CHECK_OK(sn_tissue_check(&t));
    return t;
}

// one memory for all, written twice: the exponentials of the fibres stand in another order, so that
// the machine keeps them apart
static void make_equal(sn_tissue *t, sn_tissue *whole) {
    double there[] = {0.31, 0.27, 0.06, 2.1}, back[] = {0.27, 0.31, 2.1, 0.06};
    bool fibres = t->law->fibre_constant != NULL;
    t->branched = true;
    t->memory = oracle_memory("prony", 2, there, 4);
    t->fibre = fibres ? oracle_memory("prony", 2, back, 4) : sn_memory_none();
    t->volumetric = isinf(sn_tissue_value(t, "bulk_modulus")) ? sn_memory_none() : t->memory;
    *whole = *t;
    whole->branched = false;
    sn_tissue part[2];
    assert_int_equal(sn_tissue_split(t, part), fibres ? 2 : 1);
}

static double peak_of(const double *x, int n) {
    double peak = 0.0;
    for (int i = 0; i < n; ++i) peak = fmax(peak, fabs(x[i]));
    return peak;
}

//---- quadrature ----------------------------------------------------------------------------------

// a component of S_d of hgo on a motion: v = {kind, component, target 1, target 2, constants}
enum { PULL, BIAXIAL, SHEAR };
static double elastic(double x, const double *v) {
    double E[6] = {0.0}, S[6], u = x - 1.0, l[3] = {x, 0.0, 0.0};
    if (v[0] == SHEAR) {
        double g = v[2] * u;
        E[1] = 0.5 * g * g;
        E[3] = 0.5 * g;
    } else {
        l[0] = v[0] == PULL ? x : 1.0 + (v[2] - 1.0) * u;
        l[1] = v[0] == PULL ? 1.0 / sqrt(x) : 1.0 + (v[3] - 1.0) * u;
        l[2] = 1.0 / (l[0] * l[1]);
        for (int i = 0; i < 3; ++i) E[i] = 0.5 * (l[i] * l[i] - 1.0);
    }
    sn_law_solid(sn_law_find("hgo"), v + 4, 0, 1, E, NULL, S, NULL);
    return S[(int)v[1]];
}
// central difference: error h2/6 f'''/f' ~ 1e-10, rounding 1e-16/1e-5
static double slope(double x, const double *v) {
    return (elastic(x + 1e-5, v) - elastic(x - 1e-5, v)) / 2e-5;
}

// H of a component: the matrix under its memory and the fibres under theirs; constants by hand
static double hereditary(const sn_history *h, const sn_tissue *t, double time, int kind,
                         int component, const double target[2]) {
    double sum = 0.0;
    for (int part = 0; part < 2; ++part) {
        double v[10] = {kind, component, target[0], target[1]};
        memcpy(v + 4, t->value, 6 * sizeof *v);
        v[4 + (part == 0)] = 0.0;
        sum +=
            oracle_hereditary(h, part == 1 && t->branched ? &t->fibre : &t->memory, time, slope, v);
    }
    return sum;
}

// the machine promises 1e-7 of the peak
static void pulled_fibres_follow_quadrature(void **state) {
    (void)state;
    const double knots[] = {0.0, 0.8, 1.4, 9.0}, value[] = {1.0, 1.3, 1.17, 1.17};
    const double none[2] = {0.0, 0.0};
    sn_tissue t = artery(0.0, (double)INFINITY);
    double time[ROWS], stress[ROWS], L;
    sn_history *h;
    CHECK_OK(sn_history_create(1, 4, knots, value, &h));
    for (int i = 0; i < ROWS; ++i) time[i] = i < 16 ? 0.1 * i : 1.5 * pow(1.25, i - 16);
    CHECK_OK(sn_lab_uniaxial(&t, h, ROWS, time, stress));
    double peak = peak_of(stress, ROWS);
    for (int i = 0; i < ROWS; ++i) {
        sn_history_at(h, time[i], &L);
        double s11 = hereditary(h, &t, time[i], PULL, 0, none);
        double s22 = hereditary(h, &t, time[i], PULL, 1, none);
        CHECK_ABS(stress[i], L * s11 - s22 / (L * L), 1e-7 * peak);
    }
    // and one memory for both is another thing
    double whole[ROWS];
    t.fibre = t.memory;
    CHECK_OK(sn_lab_uniaxial(&t, h, ROWS, time, whole));
    assert_true(fabs(whole[ROWS - 1] - stress[ROWS - 1]) > 0.02 * peak);
    sn_history_destroy(h);
}

static void plane_tests_follow_quadrature(void **state) {
    (void)state;
    const double knots[] = {0.0, 0.7}, value[] = {1.0, 2.0};
    sn_tissue t = artery(0.6, (double)INFINITY);
    sn_history *h;
    CHECK_OK(sn_history_create(1, 2, knots, value, &h));
    // 12 rows, so many that a step of level 1 would cross several, and these with one memory
    for (int k = 0; k < 6; ++k) {
        const int kind = k % 2 ? SHEAR : BIAXIAL, points = k < 2 ? 12 : 31;
        t.branched = k < 4;
        sn_record *record;
        sn_protocol p =
            sn_protocol_default(kind == SHEAR ? SN_PROTOCOL_SHEAR : SN_PROTOCOL_BIAXIAL);
        p.ramp = 0.7;
        p.points = points;
        p.shear = 0.6;
        p.stretch_1 = 1.24;
        p.stretch_2 = 1.11;
        CHECK_OK(sn_lab_test(&t, &p, &record));
        const double target[2] = {kind == SHEAR ? p.shear : p.stretch_1, p.stretch_2};
        const double *time = sn_record_values(record, "time");
        const double *T = sn_record_values(record, kind == SHEAR ? "shear_stress" : "stress_2");
        for (int i = 0; i < p.points; ++i) {
            double u = time[i] / 0.7, expected, l1 = 1.0 + 0.24 * u, l2 = 1.0 + 0.11 * u;
            if (kind == SHEAR)
                expected = hereditary(h, &t, time[i], kind, 3, target) +
                           p.shear * u * hereditary(h, &t, time[i], kind, 1, target);
            else
                expected = l2 * hereditary(h, &t, time[i], kind, 1, target) -
                           hereditary(h, &t, time[i], kind, 2, target) / (l1 * l1 * l2 * l2 * l2);
            CHECK_ABS(T[i], expected, 2e-7 * fabs(T[p.points - 1]));
        }
        sn_record_destroy(record);
    }
    sn_history_destroy(h);
}

//---- direct convolution --------------------------------------------------------------------------

enum { STEPS = 160, CHANNELS = 7 };

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

// elastic S of matrix, K (J - 1), S of fibres
static void channels_at(const sn_tissue *t, const double l[3], double value[CHANNELS]) {
    double E[6] = {0.0}, S[6], v[6];
    for (int i = 0; i < 3; ++i) E[i] = 0.5 * (l[i] * l[i] - 1.0);
    for (int part = 0; part < 2; ++part) {
        memcpy(v, t->value, sizeof v);
        v[part == 0] = 0.0;
        sn_law_solid(t->law, v, 0, 1, E, NULL, S, NULL);
        memcpy(value + 4 * part, S, 3 * sizeof *S);
    }
    value[3] = t->value[5] * (l[0] * l[1] * l[2] - 1.0);
}

typedef struct conv {
    const sn_tissue *t;
    double history[CHANNELS], now[CHANNELS], before[CHANNELS];
} conv;

// Cauchy-like lateral residuals; returns the nominal stress
static double pulled(const conv *c, const double l[3], double value[CHANNELS], double r[2]) {
    double total[CHANNELS], J = l[0] * l[1] * l[2], S[3];
    channels_at(c->t, l, value);
    for (int k = 0; k < CHANNELS; ++k)
        total[k] = c->history[k] + c->now[k] * (value[k] - c->before[k]);
    for (int i = 0; i < 3; ++i) S[i] = total[i] + total[4 + i] + total[3] * J / (l[i] * l[i]);
    r[0] = S[1];
    r[1] = S[2];
    return l[0] * S[0];
}

// stress after a ramp of `seconds` to `top`: every channel's increments weighted with the mean of
// its own G; Newton on both sides. Second order in the step.
static double convolved(const sn_tissue *t, double top, double seconds, int steps) {
    static double increment[CHANNELS][STEPS];
    const sn_memory *m[CHANNELS] = {&t->memory, &t->memory, &t->memory, &t->volumetric,
                                    &t->fibre,  &t->fibre,  &t->fibre};
    double h = seconds / steps, l[3] = {1.0, 1.0, 1.0}, value[CHANNELS], nominal = (double)NAN;
    conv c = {.t = t};
    for (int n = 0; n < steps; ++n) {
        for (int k = 0; k < CHANNELS; ++k) {
            c.history[k] = 0.0;
            c.now[k] = mean_relaxation(m[k], 0.0, h);
            for (int j = 0; j < n; ++j)
                c.history[k] +=
                    mean_relaxation(m[k], (n - j) * h, (n - j + 1) * h) * increment[k][j];
        }
        // history holds what came before, the increment of this step starts at `before`
        l[0] = 1.0 + (top - 1.0) * (n + 1) / steps;
        for (int it = 0; it < 12; ++it) {
            double r[2], s[2], A[2][2];
            nominal = pulled(&c, l, value, r);
            for (int j = 0; j < 2; ++j) {
                l[1 + j] += 1e-6;
                pulled(&c, l, value, s);
                l[1 + j] -= 1e-6;
                for (int i = 0; i < 2; ++i) A[i][j] = (s[i] - r[i]) / 1e-6;
            }
            double det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
            l[1] -= (A[1][1] * r[0] - A[0][1] * r[1]) / det;
            l[2] -= (A[0][0] * r[1] - A[1][0] * r[0]) / det;
        }
        double r[2];
        nominal = pulled(&c, l, value, r);
        for (int k = 0; k < CHANNELS; ++k) {
            increment[k][n] = value[k] - c.before[k];
            c.before[k] = value[k];
        }
    }
    return nominal;
}

// three memories, fibres across the pull, bulk moduli from soft to firm: 1e-6 of the stress, to
// which Richardson's limit of 80 and 160 steps is good (it moves the finer one by 1e-5 or less)
static void compressible_parts_follow_direct_convolution(void **state) {
    (void)state;
    static const double bulk[] = {4e3, 6e4}, angle[] = {0.0, 0.7};
    for (int k = 0; k < 4; ++k) {
        double top = 1.21, seconds = 1.7, stress[2];
        sn_tissue t = artery(angle[k % 2], bulk[k / 2]);
        const double knots[] = {0.0, seconds}, value[] = {1.0, top};
        sn_history *h;
        CHECK_OK(sn_history_create(1, 2, knots, value, &h));
        CHECK_OK(sn_lab_uniaxial(&t, h, 1, &knots[1], &stress[0]));
        double coarse = convolved(&t, top, seconds, STEPS / 2);
        double fine = convolved(&t, top, seconds, STEPS);
        CHECK_REL(stress[0], fine + (fine - coarse) / 3.0, 1e-6);
        t.volumetric = t.memory; // each memory is seen
        CHECK_OK(sn_lab_uniaxial(&t, h, 1, &knots[1], &stress[1]));
        assert_true(fabs(stress[1] / stress[0] - 1.0) > 1e-4);
        sn_history_destroy(h);
    }
}

//---- closed forms --------------------------------------------------------------------------------

// A step of an incompressible solid: S_d relaxes with G_d at every stretch; with fibres, the
// matrix's stress with G_d and the fibres' with G_f.
static void steps_relax_by_part(void **state) {
    (void)state;
    const double knot = 0.0, value = 1.23, time[] = {0.0, 0.01, 0.6, 7.0, 300.0};
    double stress[5], elastic_stress[2], at = 0.0;
    sn_history *h;
    CHECK_OK(sn_history_create(1, 1, &knot, &value, &h));
    sn_tissue t = artery(0.0, (double)INFINITY);
    for (int part = 0; part < 2; ++part) {
        sn_tissue alone = t;
        alone.branched = false;
        alone.memory = sn_memory_none();
        alone.value[part == 0] = 0.0; // mu or k1: what remains of an elastic step
        CHECK_OK(sn_lab_uniaxial(&alone, h, 1, &at, &elastic_stress[part]));
    }
    CHECK_OK(sn_lab_uniaxial(&t, h, 5, time, stress));
    for (int i = 0; i < 5; ++i) // memory as exponentials is good to 1e-11
        CHECK_REL(stress[i],
                  elastic_stress[0] * sn_memory_relaxation(&t.memory, time[i]) +
                      elastic_stress[1] * sn_memory_relaxation(&t.fibre, time[i]),
                  1e-10);
    assert_true(elastic_stress[1] > 0.3 * elastic_stress[0]);
    sn_history_destroy(h);
}

// about a held stretch, E* = sum over the parts of G* (L S11' - S22'/L^2) + G(inf) (S11 + 2
// S22/L^3)
static void dynamic_moduli_add_up(void **state) {
    (void)state;
    sn_tissue t = artery(0.0, (double)INFINITY);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    sn_record *record;
    p.stretch = 1.18;
    CHECK_OK(sn_lab_test(&t, &p, &record));
    const double *frequency = sn_record_values(record, "frequency"), L = p.stretch;
    for (int i = 0; i < record->rows; ++i) {
        double sum[2] = {0.0, 0.0};
        for (int part = 0; part < 2; ++part) {
            const sn_memory *m = part == 0 ? &t.memory : &t.fibre;
            double s[2], ds[2], storage, loss;
            for (int c = 0; c < 2; ++c) {
                double v[10] = {PULL, c};
                memcpy(v + 4, t.value, 6 * sizeof *v);
                v[4 + (part == 0)] = 0.0;
                s[c] = elastic(L, v);
                ds[c] = slope(L, v);
            }
            sn_memory_modulus(m, 6.283185307179586 * frequency[i], &storage, &loss);
            double moving = L * ds[0] - ds[1] / (L * L);
            sum[0] +=
                storage * moving + sn_memory_equilibrium(m) * (s[0] + 2.0 * s[1] / (L * L * L));
            sum[1] += loss * moving;
        }
        CHECK_REL(sn_record_values(record, "storage_modulus")[i], sum[0], 1e-8);
        CHECK_REL(sn_record_values(record, "loss_modulus")[i], sum[1], 1e-8);
    }
    sn_record_destroy(record);
}

//---- equal memories ------------------------------------------------------------------------------

// Equal memories are one memory, in every test that there is: sums in another order. The lateral
// stretches are solved to 1e-11 and extrapolated. Creep of one memory may take another way, each
// good to 1e-7 of the strain.
static void equal_branches_are_one_memory(void **state) {
    (void)state;
    static const sn_protocol_kind kinds[] = {
        SN_PROTOCOL_TENSILE, SN_PROTOCOL_RELAXATION, SN_PROTOCOL_HYSTERESIS, SN_PROTOCOL_DYNAMIC,
        SN_PROTOCOL_BIAXIAL, SN_PROTOCOL_SHEAR,      SN_PROTOCOL_CREEP};
    for (int k = 0; k < 7; ++k)
        for (int solid = 0; solid < 4; ++solid) {
            double bulk = solid < 2 ? (double)INFINITY : 9e3;
            sn_tissue whole, t = artery(k >= 4 ? 0.6 : 0.0, bulk);
            double v[] = {2e3, 2.0, bulk};
            if (solid % 2) t = oracle_tissue("demiray", v, 3);
            make_equal(&t, &whole);
            sn_protocol p = sn_protocol_default(kinds[k]);
            p.points = 8;
            p.stress = 300.0;
            sn_record *record, *expected;
            CHECK_OK(sn_lab_test(&whole, &p, &expected));
            CHECK_OK(sn_lab_test(&t, &p, &record));
            for (int c = 0; c < record->series_count; ++c) {
                const double *a = record->series[c].value, *b = expected->series[c].value;
                double peak = peak_of(b, p.points), good = k < 6 ? 1e-10 : 1e-7;
                for (int i = 0; i < record->rows; ++i) CHECK_ABS(a[i], b[i], good * peak);
            }
            sn_record_destroy(record);
            sn_record_destroy(expected);
        }
}

//---- creep, and a stretch held for ever
//-----------------------------------------------------------

// A test that loads a specimen and one that pulls it along the stretches found undo each other; the
// second takes straight lines between `rows` of them, off by the square of their distance.
static double load_again(const sn_tissue *t, double load, double seconds, int rows) {
    const double knots[] = {0.0, seconds}, loads[] = {0.0, load};
    double time[81], stretch[81], stress;
    sn_history *h;
    for (int i = 0; i < rows; ++i) time[i] = seconds * i / (rows - 1);
    CHECK_OK(sn_history_create(1, 2, knots, loads, &h));
    CHECK_OK(sn_lab_creep(t, h, rows, time, stretch));
    sn_history_destroy(h);
    CHECK_OK(sn_history_create(1, rows, time, stretch, &h));
    CHECK_OK(sn_lab_uniaxial(t, h, 1, &seconds, &stress));
    sn_history_destroy(h);
    return stress;
}

// Richardson's limit of 40 and 80 rows (it moves the finer one by 1e-4) against both machines,
// which are good to 1e-7 of strain and stress
static void creep_undoes_a_pull(void **state) {
    (void)state;
    for (int k = 0; k < 4; ++k) {
        sn_tissue t = artery(k % 2 ? 0.7 : 0.0, k < 2 ? (double)INFINITY : 9e3);
        double load = 1500.0, coarse = load_again(&t, load, 1.3, 41),
               fine = load_again(&t, load, 1.3, 81);
        CHECK_REL(fine + (fine - coarse) / 3.0, load, 3e-6);
    }
}

// stress of a pull to `stretch` in a second, held for `hold` s, and moved by `step` in 1e-7 s
static double moved(const sn_tissue *t, double stretch, double hold, double step) {
    const double time[] = {0.0, 1.0, 1.0 + hold, 1.0 + hold + 1e-7};
    const double value[] = {1.0, stretch, stretch, stretch + step};
    double stress;
    sn_history *h;
    CHECK_OK(sn_history_create(1, 4, time, value, &h));
    CHECK_OK(sn_lab_uniaxial(t, h, 1, &time[3], &stress));
    sn_history_destroy(h);
    return stress;
}

// About a stretch that was held for 1e3 s, four hundred times the longest relaxation time: at high
// frequency the storage modulus is the slope of sudden moves; at low frequency that of an elastic
// body of relaxed constants. Slopes over 2e-4 are off by some 1e-8, times a stiffening of 10; what
// relaxes in the move is 1e-7/0.06 of it, and G' is off by the square of that.
static void slow_and_fast_oscillations(void **state) {
    (void)state;
    const double step = 1e-4;
    for (int k = 0; k < 4; ++k) {
        sn_tissue t = artery(k % 2 ? 0.7 : 0.0, k < 2 ? (double)INFINITY : 9e3), relaxed = t;
        double half[] = {0.4, 0.3};
        t.fibre = relaxed.fibre = oracle_memory("prony", 1, half, 2);
        relaxed.branched = false;
        relaxed.memory = sn_memory_none();
        relaxed.value[0] *= sn_memory_equilibrium(&t.memory);
        relaxed.value[1] *= sn_memory_equilibrium(&t.fibre);
        if (k >= 2) relaxed.value[5] *= sn_memory_equilibrium(&t.volumetric);
        sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
        sn_record *record;
        p.stretch = 1.18;
        p.points = 3;
        p.from = 1e-6;
        p.to = 1e6;
        CHECK_OK(sn_lab_test(&t, &p, &record));
        const double *storage = sn_record_values(record, "storage_modulus");
        double fast = moved(&t, 1.18, 1e3, step) - moved(&t, 1.18, 1e3, -step);
        double slow = moved(&relaxed, 1.18, 1e3, step) - moved(&relaxed, 1.18, 1e3, -step);
        CHECK_REL(storage[0], slow / (2.0 * step), 3e-6);
        CHECK_REL(storage[2], fast / (2.0 * step), 3e-6);
        assert_true(storage[2] > 1.3 * storage[0]);
        sn_record_destroy(record);
    }
}

static void fluid_parts_are_refused(void **state) {
    (void)state;
    const double tau = 0.3, knots[] = {0.0, 1.0}, loads[] = {100.0, 100.0};
    double stretch;
    sn_tissue t = artery(0.0, 9e3);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_DYNAMIC);
    sn_record *record;
    sn_history *h;
    t.volumetric = oracle_memory("maxwell", 0, &tau, 1);
    CHECK_FAILS(sn_lab_test(&t, &p, &record), SN_E_UNSUPPORTED,
                "memory maxwell relaxes to nothing");
    // a load that jumps on a dashpot in one part
    CHECK_OK(sn_history_create(1, 2, knots, loads, &h));
    CHECK_OK(sn_lab_creep(&t, h, 1, &knots[1], &stretch));
    t.volumetric = oracle_memory("voigt", 0, &tau, 1);
    CHECK_FAILS(sn_lab_creep(&t, h, 1, &knots[1], &stretch), SN_E_UNSUPPORTED,
                "law hgo: a creep test whose stress starts at 100 Pa");
    sn_history_destroy(h);
}

static void steps_under_voigt_are_refused(void **state) {
    (void)state;
    const double knot = 0.0, value = 1.1, tau = 0.3;
    double stress;
    sn_tissue t = artery(0.0, 9e3);
    sn_history *h;
    CHECK_OK(sn_history_create(1, 1, &knot, &value, &h));
    CHECK_OK(sn_lab_uniaxial(&t, h, 1, &knot, &stress));
    t.volumetric = oracle_memory("voigt", 0, &tau, 1);
    CHECK_FAILS(sn_lab_uniaxial(&t, h, 1, &knot, &stress), SN_E_RANGE, "under memory voigt");
    t.volumetric = sn_memory_none();
    t.fibre = oracle_memory("voigt", 0, &tau, 1);
    CHECK_FAILS(sn_lab_uniaxial(&t, h, 1, &knot, &stress), SN_E_RANGE, "under memory voigt");
    sn_history_destroy(h);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pulled_fibres_follow_quadrature),
        cmocka_unit_test(plane_tests_follow_quadrature),
        cmocka_unit_test(compressible_parts_follow_direct_convolution),
        cmocka_unit_test(steps_relax_by_part),
        cmocka_unit_test(dynamic_moduli_add_up),
        cmocka_unit_test(equal_branches_are_one_memory),
        cmocka_unit_test(creep_undoes_a_pull),
        cmocka_unit_test(slow_and_fast_oscillations),
        cmocka_unit_test(fluid_parts_are_refused),
        cmocka_unit_test(steps_under_voigt_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
