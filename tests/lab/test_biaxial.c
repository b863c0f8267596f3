// Curves of two directions: reading, prediction against closed forms and another path, fits.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 40, RATIOS = 5 };
// strain of each axis at the end of a pull; the first is equibiaxial
static const double ends[RATIOS][2] = {
    {0.20, 0.20}, {0.23, 0.12}, {0.12, 0.24}, {0.25, 0.04}, {0.05, 0.27}};

static sn_curve sheet_curve(sn_curve_kind kind) {
    double zero[ROWS] = {0.0}, time[ROWS];
    for (int i = 0; i < ROWS; ++i) time[i] = i;
    sn_curve c = oracle_curve("sheet", ROWS, time, zero, zero);
    c.kind = kind;
    if (kind == SN_CURVE_BIAXIAL) {
        c.stretch_2 = sn_alloc(ROWS, sizeof *c.stretch_2);
        c.stress_2 = sn_alloc(ROWS, sizeof *c.stress_2);
    }
    return c;
}

// stretches up to Green strains `end`, stresses of the tissue with noise of a part of the peak of
// each axis
static sn_curve biaxial(const sn_tissue *tissue, const double end[2], double noise,
                        uint64_t *seed) {
    sn_curve c = sheet_curve(SN_CURVE_BIAXIAL);
    for (int i = 0; i < ROWS; ++i) {
        double part = (double)i / (ROWS - 1);
        c.stretch[i] = sqrt(1.0 + 2.0 * end[0] * part);
        c.stretch_2[i] = sqrt(1.0 + 2.0 * end[1] * part);
    }
    sn_fit_curve p;
    CHECK_OK(sn_fit_predict(tissue, &c, &p));
    assert_non_null(p.predicted_2);
    for (int i = 0; i < ROWS; ++i) {
        c.stress[i] = p.predicted[i] + noise * fabs(p.predicted[ROWS - 1]) * oracle_normal(seed);
        c.stress_2[i] =
            p.predicted_2[i] + noise * fabs(p.predicted_2[ROWS - 1]) * oracle_normal(seed);
    }
    sn_free(p.predicted);
    sn_free(p.predicted_2);
    return c;
}

static sn_curve sheared(const sn_tissue *tissue, double end, double noise, uint64_t *seed) {
    sn_curve c = sheet_curve(SN_CURVE_SHEAR);
    for (int i = 0; i < ROWS; ++i) c.stretch[i] = end * i / (ROWS - 1);
    sn_fit_curve p;
    CHECK_OK(sn_fit_predict(tissue, &c, &p));
    assert_null(p.predicted_2);
    for (int i = 0; i < ROWS; ++i)
        c.stress[i] = p.predicted[i] + noise * fabs(p.predicted[ROWS - 1]) * oracle_normal(seed);
    sn_free(p.predicted);
    return c;
}

static sn_fit_def fit_of(const sn_law *law, const sn_curve *curve, int count) {
    sn_fit_def def = sn_fit_def_default();
    def.law = law;
    def.curve = curve;
    def.curve_count = count;
    return def;
}

static void fix(sn_fit_def *def, const char *name, double value) {
    def->fixed_name[def->fixed_count] = name;
    def->fixed_value[def->fixed_count++] = value;
}

static void release(int count, sn_curve *curve) {
    for (int k = 0; k < count; ++k) sn_curve_release(&curve[k]);
}

//---- reading -------------------------------------------------------------------------------------

static sn_record *record_of(int columns, const char *const *name, int rows, const double *value) {
    sn_record *r;
    CHECK_OK(sn_record_create("file.csv", &r));
    for (int k = 0; k < columns; ++k) CHECK_OK(sn_record_add_series(r, name[k], "1"));
    for (int i = 0; i < rows; ++i) CHECK_OK(sn_record_append(r, value + i * columns));
    return r;
}

// T = L S, and T = sigma/L: closed forms, 1e-15 is rounding
static void records_become_curves(void **state) {
    (void)state;
    const char *const pk2[] = {"green_strain_1", "pk2_stress_1", "green_strain_2", "true_stress_2"};
    const double value[] = {0, 0, 0, 0, 0.1, 10, 0.2, 30, 0.15, 20, 0.3, 90};
    sn_curve c;
    sn_record *r = record_of(4, pk2, 3, value);
    CHECK_OK(sn_curve_from_record(r, &c));
    assert_int_equal(c.kind, SN_CURVE_BIAXIAL);
    assert_null(c.time);
    CHECK_REL(c.stretch[1], sqrt(1.2), 1e-15);
    CHECK_REL(c.stress[1], 10.0 * sqrt(1.2), 1e-15);
    CHECK_REL(c.stretch_2[2], sqrt(1.6), 1e-15);
    CHECK_REL(c.stress_2[2], 90.0 / sqrt(1.6), 1e-15);
    assert_non_null(strstr(c.remarks, "second Piola-Kirchhoff"));
    assert_non_null(strstr(c.remarks, "incompressible"));
    sn_tensile t;
    CHECK_FAILS(sn_reduce_tensile(&c, NULL, &t), SN_E_UNSUPPORTED,
                "a tensile test needs a uniaxial one");
    sn_cycles y;
    CHECK_FAILS(sn_reduce_cyclic(&c, &y), SN_E_UNSUPPORTED, "a biaxial curve");
    sn_creep_result w;
    CHECK_FAILS(sn_reduce_creep(&c, &w), SN_E_UNSUPPORTED, "a biaxial curve");
    sn_relaxation_result x;
    CHECK_FAILS(sn_reduce_relaxation(&c, &x), SN_E_UNSUPPORTED, "a biaxial curve");
    sn_curve_release(&c);
    sn_record_destroy(r);

    const char *const force[] = {"length_1", "force_1", "extension_2", "force_2"};
    r = record_of(4, force, 3, value);
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "\"# gauge_length_1: ...\"");
    CHECK_OK(sn_record_add_note(r, "gauge_length", "0.05 m", 0.05));
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "\"# area_1: ...\", or a thickness");
    CHECK_OK(sn_record_add_note(r, "thickness", "2 m", 2.0));
    CHECK_OK(sn_record_add_note(r, "width_1", "3 m", 3.0));
    CHECK_OK(sn_record_add_note(r, "width_2", "5 m", 5.0));
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "row 1: stretch is 0");
    sn_record_values(r, "length_1")[0] = 0.05;
    CHECK_OK(sn_curve_from_record(r, &c));
    CHECK_REL(c.stress[1], 10.0 / 6.0, 1e-15);
    CHECK_REL(c.stress_2[1], 30.0 / 10.0, 1e-15);
    CHECK_REL(c.stretch_2[1], 1.0 + 0.2 / 0.05, 1e-15);
    sn_curve_release(&c);
    sn_record_destroy(r);
}

static void kinds_are_told_apart(void **state) {
    (void)state;
    const double value[] = {0, 0, 0, 0, 0.1, 10, 0.2, 30, 0.15, 20, 0.3, 90};
    const char *const shear[] = {"shear_strain", "shear_stress"};
    const char *const missing[] = {"strain_1", "stress_1", "strain_2"};
    const char *const mixed[] = {"strain", "stress", "strain_2", "stress_2"};
    const char *const three[] = {"shear_strain", "shear_stress", "strain_1", "stress_1"};
    sn_curve c;
    sn_record *r = record_of(2, shear, 4, value);
    CHECK_OK(sn_curve_from_record(r, &c));
    assert_int_equal(c.kind, SN_CURVE_SHEAR);
    assert_true(c.stretch[2] == 0.1 && c.stress[2] == 10.0);
    sn_curve_release(&c);
    sn_record_destroy(r);
    r = record_of(3, missing, 3, value);
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "the stress of the second axis");
    sn_record_destroy(r);
    r = record_of(4, mixed, 3, value);
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "two kinds of test, strain and strain_2");
    sn_record_destroy(r);
    r = record_of(4, three, 3, value);
    CHECK_FAILS(sn_curve_from_record(r, &c), SN_E_DATA, "two kinds of test, strain_1 and shear");
    sn_record_destroy(r);
}

//---- prediction ----------------------------------------------------------------------------------

// Equation (21) by hand, and simple shear of it: T12 = S12 + g S22, S12 = c a3 E12 exp(Q) with
// E12 and E21 apart, so that Q holds 2 a3 E12^2. Rounding only.
static void membrane_follows_its_closed_form(void **state) {
    (void)state;
    const double v[] = {3e3, 9.0, 5.0, 4.0, 2.0};
    uint64_t seed = 1;
    sn_tissue t = oracle_tissue("fung-planar", v, 5);
    sn_curve b = biaxial(&t, ends[1], 0.0, &seed), s = sheared(&t, 0.5, 0.0, &seed);
    for (int i = 0; i < ROWS; ++i) {
        double x = ends[1][0] * i / (ROWS - 1), y = ends[1][1] * i / (ROWS - 1);
        double X = v[0] * exp(v[1] * x * x + v[2] * y * y + 2.0 * v[4] * x * y);
        CHECK_ABS(b.stress[i], sqrt(1.0 + 2.0 * x) * X * (v[1] * x + v[4] * y), 1e-9);
        CHECK_ABS(b.stress_2[i], sqrt(1.0 + 2.0 * y) * X * (v[2] * y + v[4] * x), 1e-9);
        double g = s.stretch[i], e = 0.5 * g, f = 0.5 * g * g;
        double Z = v[0] * exp(v[2] * f * f + 2.0 * v[3] * e * e);
        CHECK_ABS(s.stress[i], Z * (v[3] * e + g * v[2] * f), 1e-9);
    }
    sn_curve_release(&b);
    sn_curve_release(&s);
}

// The virtual machine takes the rates from the tangent of the law and halves its steps to 5e-8 of
// the peak; this path takes them from values, at steps of a 48th of the reach: within 1e-6.
static void memory_agrees_with_the_machine(void **state) {
    (void)state;
    const double demiray[] = {2.1e3, 9.0, (double)INFINITY};
    const double fibres[] = {2e3, 18.0, 7.0, 5.0, (double)INFINITY};
    const double artery[] = {2.3e3, 3.1e3, 1.7, 0.09, 0.6, (double)INFINITY};
    const double prony[] = {0.31, 0.27, 0.004, 2.0}, spectrum[] = {0.3, 0.013, 40.0};
    for (int k = 0; k < 6; ++k) {
        sn_tissue t = k < 2   ? oracle_tissue("demiray", demiray, 3)
                      : k < 4 ? oracle_tissue("guccione", fibres, 5)
                              : oracle_tissue("hgo", artery, 6);
        t.memory = k % 2 ? oracle_memory("prony", 2, prony, 4)
                         : oracle_memory("fung-spectrum", 0, spectrum, 3);
        for (int shear = 0; shear < 2; ++shear) {
            sn_protocol p = sn_protocol_default(shear ? SN_PROTOCOL_SHEAR : SN_PROTOCOL_BIAXIAL);
            p.stretch_1 = 1.21;
            p.stretch_2 = 1.08;
            p.shear = 0.4;
            p.ramp = 1.7;
            p.points = 31;
            sn_record *record;
            sn_curve c;
            sn_fit_curve f;
            CHECK_OK(sn_lab_test(&t, &p, &record));
            CHECK_OK(sn_curve_from_record(record, &c));
            CHECK_OK(sn_fit_predict(&t, &c, &f));
            CHECK_ABS(f.rmse / f.peak, 0.0, 1e-6);
            assert_true(f.peak > 500.0 && (f.predicted_2 != NULL) == !shear);
            sn_free(f.predicted);
            sn_free(f.predicted_2);
            sn_tissue branched = t;
            branched.branched = true;
            branched.volumetric = branched.fibre = sn_memory_none();
            CHECK_FAILS(sn_fit_predict(&branched, &c, &f), SN_E_UNSUPPORTED,
                        shear ? "a branch memory and a shear curve" : "and a biaxial curve");
            sn_curve_release(&c);
            sn_record_destroy(record);
        }
    }
}

//---- reduction -----------------------------------------------------------------------------------

// a sheet of Hooke's kind, T_i = k_i (l_i - 1) + k (l_j - 1), pulled along a straight path: slopes
// along it and the work are closed forms, and exact for straight lines
static void straight_sheet_is_reduced_exactly(void **state) {
    (void)state;
    const double k1 = 7e4, k2 = 3e4, k12 = 1e4, e1 = 0.1, e2 = 0.2;
    sn_curve c = sheet_curve(SN_CURVE_BIAXIAL);
    for (int i = 0; i < ROWS; ++i) {
        // up to row ROWS - 6, then back: that does not count
        double part = fmin(i, 2 * (ROWS - 6) - i) / (ROWS - 6);
        c.stretch[i] = 1.0 + e1 * part;
        c.stretch_2[i] = 1.0 + e2 * part;
        c.stress[i] = (k1 * e1 + k12 * e2) * part;
        c.stress_2[i] = (k2 * e2 + k12 * e1) * part;
    }
    sn_biaxial_result r;
    CHECK_OK(sn_reduce_biaxial(&c, &r));
    double T1 = k1 * e1 + k12 * e2, T2 = k2 * e2 + k12 * e1;
    assert_int_equal(r.peak, ROWS - 6);
    CHECK_REL(r.axis[0].peak_stress, T1, 1e-12);
    CHECK_REL(r.axis[1].peak_stretch, 1.2, 1e-12);
    CHECK_REL(r.axis[0].low_modulus, T1 / e1, 1e-10);
    CHECK_REL(r.axis[1].high_modulus, T2 / e2, 1e-10);
    CHECK_REL(r.stress_ratio, T1 / T2, 1e-12);
    CHECK_REL(r.stretch_ratio, 0.5, 1e-12);
    CHECK_REL(r.anisotropy, 2.0 * (e2 / T2 - e1 / T1) / (e2 / T2 + e1 / T1), 1e-12);
    CHECK_REL(r.energy, 0.5 * (T1 * e1 + T2 * e2), 1e-12);
    c.stress[3] = 1e9;
    CHECK_FAILS(sn_reduce_biaxial(&c, &r), SN_E_DATA, "4 rows up to the largest sum");
    c.kind = SN_CURVE_SHEAR;
    CHECK_FAILS(sn_reduce_biaxial(&c, &r), SN_E_UNSUPPORTED, "a biaxial test needs a biaxial one");
    c.kind = SN_CURVE_BIAXIAL;
    c.stress[3] = c.stress[2];
    for (int i = 0; i < ROWS; ++i) c.stretch[i] = c.stretch_2[i] = 1.0;
    CHECK_FAILS(sn_reduce_biaxial(&c, &r), SN_E_DATA, "no axis is pulled");
    sn_curve_release(&c);
}

// the moduli of a stiffening law rise, and the work is its energy: the trapezoid rule on 40 rows
// leaves 1/12 h^2 of the rise of the slopes, a relative 1e-3
static void stiffening_sheet_is_reduced(void **state) {
    (void)state;
    const double v[] = {3e3, 9.0, 5.0, 4.0, 2.0};
    uint64_t seed = 1;
    sn_tissue t = oracle_tissue("fung-planar", v, 5);
    sn_curve c = biaxial(&t, ends[0], 0.0, &seed);
    sn_biaxial_result r;
    CHECK_OK(sn_reduce_biaxial(&c, &r));
    double Q = (9.0 + 5.0 + 2.0 * 2.0) * 0.04;
    CHECK_REL(r.energy, 0.5 * 3e3 * expm1(Q), 2e-3);
    assert_true(r.anisotropy > 0.2 && r.axis[0].high_modulus > 1.5 * r.axis[0].low_modulus);
    CHECK_REL(r.stretch_ratio, 1.0, 1e-12);
    sn_curve_release(&c);
}

//---- fits ----------------------------------------------------------------------------------------

// One law with its constants; those that stand in `held` are fixed at their values.
typedef struct law_case {
    const char *law;
    int count;
    double value[16];
    const char *const *name; // of the values, NULL: not looked at
    const char *held;        // names between spaces
} law_case;

static sn_fit_def fit_case(const law_case *l, const sn_tissue *t, const sn_curve *curve, int n) {
    sn_fit_def def = fit_of(t->law, curve, n);
    for (int k = 0; k < l->count; ++k) {
        char word[32];
        if (!l->name[k]) continue;
        snprintf(word, sizeof word, " %s ", l->name[k]);
        if (strstr(l->held, word)) fix(&def, l->name[k], l->value[k]);
    }
    return def;
}

static const char *const planar_names[] = {"c", "a1", "a2", "a3", "a4"};
static const char *const skin_names[] = {"alpha1", "alpha2", "alpha3", "alpha4", "c",
                                         "a1",     "a2",     "a3",     "a4",     "gamma1",
                                         "gamma2", "gamma4", "gamma5"};
static const char *const fung_names[] = {"c",  "a1", "a2", "a3", "a4",          "a5",
                                         "a6", NULL, NULL, NULL, "bulk_modulus"};
static const char *const guccione_names[] = {"C", "bf", "bt", NULL, "bulk_modulus"};
static const law_case planar = {"fung-planar", 5, {2e3, 19.0, 11.0, 8.0, 4.0}, planar_names, ""};
static const law_case skin = {"fung-skin",
                              13,
                              {4e3, 3e3, 0, 1e3, 3e2, 30.0, 21.0, 8.0, 7.0, 0, 0, 0, 0},
                              skin_names,
                              " gamma1 gamma2 gamma4 gamma5 "};
// the thickness strain follows the others, so its constants are hardly seen: held
static const law_case fung = {"fung",
                              11,
                              {2e3, 19.0, 11.0, 5.0, 4.0, 1.0, 2.0, 8.0, 8.0, 8.0, INFINITY},
                              fung_names,
                              " a3 a5 a6 "};
static const law_case guccione = {
    "guccione", 5, {2e3, 18.0, 7.0, 5.0, INFINITY}, guccione_names, ""};

// 1 % noise of the peak of each axis. Every constant within its 95 % interval widened by half of
// its width on both sides (4 standard errors: 6e-5 a constant by chance); the predicted curves
// within the noise, 1 % of a peak, of the true ones. Everything is identifiable.
static void check_recovery(const law_case *l, int ratios) {
    uint64_t seed = 77;
    sn_tissue t = oracle_tissue(l->law, l->value, 0);
    memcpy(t.value, l->value, (size_t)l->count * sizeof *l->value);
    sn_curve curve[RATIOS], truth[RATIOS];
    for (int k = 0; k < ratios; ++k) {
        curve[k] = biaxial(&t, ends[k], 0.01, &seed);
        truth[k] = biaxial(&t, ends[k], 0.0, &seed);
    }
    sn_fit_def def = fit_case(l, &t, curve, ratios);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    assert_true(r->converged);
    assert_int_equal(r->points, 2 * ratios * ROWS);
    assert_true(r->identifiable);
    for (int k = 0; k < l->count; ++k) {
        if (!l->name[k] || isinf(l->value[k])) continue;
        const sn_fit_param *p = oracle_param(r, l->name[k]);
        if (p->fixed) continue;
        double width = p->ci95[1] - p->ci95[0];
        CHECK_ABS(l->value[k], 0.5 * (p->ci95[0] + p->ci95[1]), width);
    }
    CHECK_OK(sn_law_check(r->tissue.law, r->tissue.value, r->tissue.terms));
    for (int k = 0; k < ratios; ++k) {
        double peak[2] = {truth[k].stress[ROWS - 1], truth[k].stress_2[ROWS - 1]};
        for (int i = 0; i < ROWS; ++i) {
            CHECK_ABS(r->curve[k].predicted[i], truth[k].stress[i], 1e-2 * peak[0]);
            CHECK_ABS(r->curve[k].predicted_2[i], truth[k].stress_2[i], 1e-2 * peak[1]);
        }
    }
    sn_fit_release(r);
    sn_free(r);
    release(ratios, curve);
    release(ratios, truth);
}

static void constants_come_back_from_loading_ratios(void **state) {
    (void)state;
    check_recovery(&planar, 3);
    check_recovery(&fung, 3);
    check_recovery(&guccione, 3);
    check_recovery(&skin, 5);
}

// a shear constant that no curve sees is tied, and is found where a shear curve does see it
static void shears_are_tied_until_seen(void **state) {
    (void)state;
    uint64_t seed = 5;
    sn_tissue t = oracle_tissue("fung-planar", planar.value, 5);
    sn_curve curve[4];
    for (int k = 0; k < 3; ++k) curve[k] = biaxial(&t, ends[k], 0.0, &seed);
    curve[3] = sheared(&t, 0.5, 0.0, &seed);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    sn_fit_def def = fit_of(t.law, curve, 3);
    CHECK_OK(sn_fit(&def, r));
    const sn_fit_param *a3 = oracle_param(r, "a3");
    assert_true(a3->fixed && strstr(a3->reason, "isotropic"));
    CHECK_REL(a3->value, 0.5 * (19.0 + 11.0) - 4.0, 1e-5); // the others to the search's 1e-6
    sn_fit_release(r);
    def = fit_of(t.law, curve, 4);
    CHECK_OK(sn_fit(&def, r));
    a3 = oracle_param(r, "a3");
    assert_false(a3->fixed);
    for (int k = 0; k < 5; ++k) CHECK_REL(r->param[k].value, planar.value[k], 1e-5);
    sn_fit_release(r);
    def = fit_of(t.law, curve, 3);
    fix(&def, "a3", 8.0);
    CHECK_OK(sn_fit(&def, r));
    assert_true(oracle_param(r, "a3")->value == 8.0);
    sn_fit_release(r);
    sn_free(r);
    release(4, curve);
}

// a solid, biaxial and uniaxial curves together, a memory on all of them
static void kinds_mix_with_memory(void **state) {
    (void)state;
    const double demiray[] = {2.1e3, 9.0, (double)INFINITY}, prony[] = {0.4, 6.0};
    uint64_t seed = 5;
    sn_tissue t = oracle_tissue("demiray", demiray, 3);
    t.memory = oracle_memory("prony", 1, prony, 2);
    sn_curve curve[3] = {biaxial(&t, ends[1], 0.0, &seed), sheared(&t, 0.5, 0.0, &seed)};
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_RELAXATION);
    p.stretch = 1.3;
    sn_record *record;
    CHECK_OK(sn_lab_test(&t, &p, &record));
    CHECK_OK(sn_curve_from_record(record, &curve[2]));
    sn_record_destroy(record);
    sn_fit_def def = fit_of(t.law, curve, 3);
    def.memory = t.memory.law;
    def.terms = 1;
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    for (int k = 0; k < 2; ++k) CHECK_REL(r->tissue.value[k], demiray[k], 1e-5);
    for (int k = 0; k < 2; ++k) CHECK_REL(r->tissue.memory.value[k], prony[k], 1e-5);
    sn_fit_release(r);
    sn_free(r);
    release(3, curve);
}

// Equal strains make S11 and S22 depend on a1 + a4 and a2 + a4 alone: the fit says so, and its
// curves are right to the noise all the same.
static void one_ratio_is_not_enough(void **state) {
    (void)state;
    const law_case *cases[] = {&planar, &skin, &fung};
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    for (int k = 0; k < 3; ++k) {
        uint64_t seed = 9;
        const law_case *l = cases[k];
        sn_tissue t = oracle_tissue(l->law, l->value, 0);
        memcpy(t.value, l->value, (size_t)l->count * sizeof *l->value);
        sn_curve c = biaxial(&t, ends[0], 0.01, &seed);
        sn_fit_def def = fit_case(l, &t, &c, 1);
        CHECK_OK(sn_fit(&def, r));
        assert_false(r->identifiable);
        const sn_fit_param *a4 = oracle_param(r, "a4");
        assert_false(a4->identifiable);
        assert_non_null(strstr(a4->reason, "one loading ratio"));
        if (k < 2) assert_non_null(strstr(a4->reason, "only a1 +1 a4 and a2 +1 a4 are known"));
        if (k == 0) {
            assert_true(oracle_param(r, "c")->identifiable);
            CHECK_REL(oracle_param(r, "a1")->value + a4->value, 23.0, 0.1);
            CHECK_REL(oracle_param(r, "a2")->value + a4->value, 15.0, 0.1);
        }
        assert_true(r->nrmse < 0.012);
        sn_fit_release(r);
        sn_curve_release(&c);
    }
    sn_free(r);
}

// data of a law that is not convex: the fit ends at the limit, not beyond and not with an error
static void fits_stay_convex(void **state) {
    (void)state;
    const double v[] = {2e3, 12.0, 6.0, 8.0, 9.0}; // 12 6 < 9^2; prediction asks no one
    uint64_t seed = 3;
    sn_tissue t = oracle_tissue("fung-planar", v, 5);
    sn_curve curve[RATIOS];
    sn_tissue convex = t;
    convex.value[4] = 4.0;
    for (int k = 0; k < RATIOS; ++k) {
        curve[k] = biaxial(&convex, ends[k], 0.0, &seed);
        for (int i = 0; i < ROWS; ++i) {
            double x = ends[k][0] * i / (ROWS - 1), y = ends[k][1] * i / (ROWS - 1);
            double X = v[0] * exp(v[1] * x * x + v[2] * y * y + 2.0 * v[4] * x * y);
            curve[k].stress[i] = curve[k].stretch[i] * X * (v[1] * x + v[4] * y);
            curve[k].stress_2[i] = curve[k].stretch_2[i] * X * (v[2] * y + v[4] * x);
        }
    }
    CHECK_FAILS(sn_law_check(t.law, t.value, 0), SN_E_RANGE, "not convex");
    sn_fit_def def = fit_of(t.law, curve, RATIOS);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    CHECK_OK(sn_fit(&def, r));
    CHECK_OK(sn_law_check(r->tissue.law, r->tissue.value, 0));
    const sn_fit_param *a4 = oracle_param(r, "a4");
    assert_true(a4->at_bound && strstr(a4->reason, "limit of convexity"));
    double limit = sqrt(oracle_param(r, "a1")->value * oracle_param(r, "a2")->value);
    CHECK_REL(a4->value, limit, 1e-3);
    assert_true(r->r_squared > 0.9);
    sn_fit_release(r);
    sn_free(r);
    release(RATIOS, curve);
}

static void refusals_name_the_curve(void **state) {
    (void)state;
    uint64_t seed = 3;
    sn_tissue t = oracle_tissue("fung-planar", planar.value, 5);
    sn_curve c = biaxial(&t, ends[1], 0.0, &seed),
             uniaxial = oracle_curve("strip", ROWS, NULL, c.stretch, c.stress);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    sn_fit_curve f;
    sn_fit_def def = fit_of(sn_law_find("exponential"), &c, 1);
    CHECK_FAILS(sn_fit(&def, r), SN_E_UNSUPPORTED, "sheet: a biaxial curve, and law exponential");
    def = fit_of(sn_law_find("neo-hookean"), &c, 1);
    fix(&def, "bulk_modulus", 1e6);
    CHECK_FAILS(sn_fit(&def, r), SN_E_UNSUPPORTED, "a finite bulk modulus");
    def = fit_of(t.law, &uniaxial, 1);
    CHECK_FAILS(sn_fit(&def, r), SN_E_UNSUPPORTED, "the curve strip is uniaxial");
    for (int i = 0; i < ROWS; ++i) c.stretch[i] = c.stretch_2[i] = 1.1;
    def = fit_of(t.law, &c, 1);
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "the stretch is 1.1 in every row");
    c.stretch[0] = 1.0;
    def.memory = sn_memory_law_find("voigt");
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "starts at stretch 1.1: memory voigt");
    sn_free(c.time);
    c.time = NULL;
    def.memory = sn_memory_law_find("kelvin");
    CHECK_FAILS(sn_fit(&def, r), SN_E_DATA, "no time column");
    t.memory = oracle_memory("maxwell", 0, (double[]){1.0}, 1);
    CHECK_FAILS(sn_fit_predict(&t, &c, &f), SN_E_DATA, "no time column");
    sn_free(r);
    sn_curve_release(&c);
    sn_curve_release(&uniaxial);
}

//---- pericardium ---------------------------------------------------------------------------------

enum { PROTOCOLS = 3, MOST = 64 };

// the paired tables: E11, S11, E22, S22 with stresses in pascals
static sn_curve pericardium(int k, double table[MOST][4]) {
    static const char *const names[] = {"1-1", "1-0.5", "0.5-1"};
    char path[512], line[512];
    snprintf(path, sizeof path, "%s/data/pericardium/protocol-%s.csv", SN_SOURCE_DIR, names[k]);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    const char *const columns[] = {"green_strain_1", "pk2_stress_1", "green_strain_2",
                                   "pk2_stress_2"};
    int n = 0;
    while (fgets(line, sizeof line, file)) {
        double *v = table[n];
        if (n + 1 < MOST && sscanf(line, "%lf,%lf,%lf,%lf", &v[0], &v[1], &v[2], &v[3]) == 4) {
            v[1] *= 1e3;
            v[3] *= 1e3;
            n++;
        }
    }
    fclose(file);
    sn_record *r = record_of(4, columns, n, table[0]);
    sn_curve c;
    CHECK_OK(sn_curve_from_record(r, &c));
    sn_record_destroy(r);
    table[n][0] = (double)NAN;
    return c;
}

// Least sum of squares of equation (21) at given a1, a2, a4: c by linear least squares.
static double brute_sum(double table[PROTOCOLS][MOST][4], double a1, double a2, double a4) {
    double cross = 0.0, square = 0.0, norm = 0.0;
    if (!(a1 > 0.0 && a2 > 0.0 && a1 * a2 > a4 * a4)) return (double)INFINITY;
    for (int k = 0; k < PROTOCOLS; ++k)
        for (int i = 0; !isnan(table[k][i][0]); ++i) {
            double x = table[k][i][0], y = table[k][i][2];
            double X = exp(a1 * x * x + a2 * y * y + 2.0 * a4 * x * y);
            double m[2] = {(a1 * x + a4 * y) * X, (a4 * x + a2 * y) * X};
            double l[2] = {sqrt(1.0 + 2.0 * x), sqrt(1.0 + 2.0 * y)};
            for (int j = 0; j < 2; ++j) {
                double T = l[j] * table[k][i][2 * j + 1];
                cross += l[j] * m[j] * T;
                square += l[j] * m[j] * l[j] * m[j];
                norm += T * T;
            }
        }
    return cross > 0.0 ? norm - cross * cross / square : norm;
}

// The best of a grid, then of ever finer grids about it: no gradient, no start to be lucky with.
static double brute_force(double table[PROTOCOLS][MOST][4]) {
    enum { SIDE = 21, ZOOMS = 40 };
    double centre[3] = {150.0, 100.0, 0.0}, half[3] = {150.0, 100.0, 100.0};
    double best = (double)INFINITY;
    for (int z = 0; z < ZOOMS; ++z) {
        double found[3] = {centre[0], centre[1], centre[2]};
        for (int i = 0; i < SIDE * SIDE * SIDE; ++i) {
            const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
            double a[3];
            for (int j = 0; j < 3; ++j)
                a[j] = centre[j] + half[j] * (2.0 * at[j] / (SIDE - 1.0) - 1.0);
            double sum = brute_sum(table, a[0], a[1], a[2]);
            if (!(sum < best)) continue;
            best = sum;
            memcpy(found, a, sizeof found);
        }
        for (int j = 0; j < 3; ++j) {
            half[j] *= found[j] == centre[j] ? 0.5 : 0.8;
            centre[j] = found[j];
        }
    }
    return best;
}

// No worse than the best fit of the same law found another way; more constants only help.
static void pericardium_is_fitted_as_well_as_it_can_be(void **state) {
    (void)state;
    static double table[PROTOCOLS][MOST][4];
    sn_curve curve[PROTOCOLS];
    for (int k = 0; k < PROTOCOLS; ++k) curve[k] = pericardium(k, table[k]);
    double best = brute_force(table), sum[3];
    const char *const laws[] = {"fung-planar", "fung-skin", "fung"};
    const double least[] = {0.965, 0.98, 0.97}; // R2 as in data/pericardium/SOURCE.md
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    for (int k = 0; k < 3; ++k) {
        sn_fit_def def = fit_of(sn_law_find(laws[k]), curve, PROTOCOLS);
        CHECK_OK(sn_fit(&def, r));
        sum[k] = r->rmse * r->rmse * r->points;
        assert_true(r->converged && r->r_squared > least[k]);
        CHECK_OK(sn_law_check(r->tissue.law, r->tissue.value, 0));
        sn_fit_release(r);
    }
    CHECK_REL(sum[0], best, 1e-6); // both stop at a minimum: second order in what is left
    assert_true(sum[1] < sum[0] && sum[2] < sum[0]);
    sn_free(r);
    release(PROTOCOLS, curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_become_curves),
        cmocka_unit_test(kinds_are_told_apart),
        cmocka_unit_test(membrane_follows_its_closed_form),
        cmocka_unit_test(memory_agrees_with_the_machine),
        cmocka_unit_test(straight_sheet_is_reduced_exactly),
        cmocka_unit_test(stiffening_sheet_is_reduced),
        cmocka_unit_test(constants_come_back_from_loading_ratios),
        cmocka_unit_test(shears_are_tied_until_seen),
        cmocka_unit_test(kinds_mix_with_memory),
        cmocka_unit_test(one_ratio_is_not_enough),
        cmocka_unit_test(fits_stay_convex),
        cmocka_unit_test(refusals_name_the_curve),
        cmocka_unit_test(pericardium_is_fitted_as_well_as_it_can_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
