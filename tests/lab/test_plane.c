// Biaxial and shear tests of solids and membranes: quadrature, direct convolution, limits.
// SPDX-License-Identifier: Apache-2.0
#include "lab_oracle.h"

enum { ROWS = 24 };

static sn_record *run(const sn_tissue *tissue, const sn_protocol *p) {
    sn_record *record;
    CHECK_OK(sn_lab_test(tissue, p, &record));
    assert_int_equal(record->rows, p->points);
    CHECK_REL(sn_record_values(record, "time")[p->points - 1], p->ramp, 1e-15);
    return record;
}

static sn_memory memory_of(int k, uint64_t *seed) {
    double prony[] = {0.31, 0.27, check_random(seed, 0.02, 0.2), check_random(seed, 0.5, 4.0)};
    double spectrum[] = {check_random(seed, 0.05, 0.4), 0.013, check_random(seed, 3.0, 90.0)};
    return k % 2 ? oracle_memory("prony", 2, prony, 4)
                 : oracle_memory("fung-spectrum", 0, spectrum, 3);
}

// the driving number of the oracle is 1 + u: it starts at rest and rises by 1 in the ramp
static sn_history *drive(double ramp) {
    const double knots[] = {0.0, ramp}, value[] = {1.0, 2.0};
    sn_history *h;
    CHECK_OK(sn_history_create(1, 2, knots, value, &h));
    return h;
}

//---- shear ---------------------------------------------------------------------------------------

// neo-Hookean, J = 1, I1 = 3 + g^2: S_d = mu (1 - I1/3 C^-1), so that S12 = mu I1 g/3 and
// S22 = mu (1 - I1/3) = -mu g^2/3; v = {mu, target}
static double shear_s12(double x, const double *v) {
    double g = v[1] * (x - 1.0);
    return v[0] * v[1] * (1.0 + g * g);
}
static double shear_s22(double x, const double *v) {
    double g = v[1] * (x - 1.0);
    return -2.0 / 3.0 * v[0] * v[1] * g;
}

// 1e-7 of the peak is the machine's promise
static void sheared_neo_hookean_follows_quadrature(void **state) {
    (void)state;
    uint64_t seed = 3141;
    for (int k = 0; k < 4; ++k) {
        // J = 1 throughout: a finite bulk modulus changes nothing
        double mu = check_random(&seed, 1e3, 9e3), v[] = {mu, k == 1 ? 2.5 * mu : (double)INFINITY};
        sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
        tissue.memory = memory_of(k, &seed);
        sn_protocol p = sn_protocol_default(SN_PROTOCOL_SHEAR);
        p.shear = (k < 2 ? 1.0 : -1.0) * check_random(&seed, 0.2, 1.4);
        p.ramp = pow(10.0, check_random(&seed, -1.5, 1.0));
        p.points = ROWS;
        sn_record *record = run(&tissue, &p);
        sn_history *h = drive(p.ramp);
        const double *time = sn_record_values(record, "time");
        const double *strain = sn_record_values(record, "shear_strain");
        const double *stress = sn_record_values(record, "shear_stress");
        double constants[] = {mu, p.shear}, peak = fabs(stress[ROWS - 1]);
        assert_true(peak > 0.1 * mu * fabs(p.shear));
        for (int i = 0; i < ROWS; ++i) {
            CHECK_ABS(strain[i], p.shear * time[i] / p.ramp, 1e-14);
            double s12 = oracle_hereditary(h, &tissue.memory, time[i], shear_s12, constants);
            double s22 = oracle_hereditary(h, &tissue.memory, time[i], shear_s22, constants);
            CHECK_ABS(stress[i], s12 + strain[i] * s22, 1e-7 * peak);
        }
        sn_history_destroy(h);
        sn_record_destroy(record);
    }
}

//---- biaxial -------------------------------------------------------------------------------------

// S_d along axis `axis` of a neo-Hookean at u; v = {mu, target 1, target 2}
static double biaxial_s(double u, const double *v, int axis) {
    double l[3] = {1.0 + (v[1] - 1.0) * u, 1.0 + (v[2] - 1.0) * u, 0.0};
    l[2] = 1.0 / (l[0] * l[1]);
    double i1 = l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
    return v[0] * (1.0 - i1 / 3.0 / (l[axis] * l[axis]));
}
// slopes by central differences: error h2/6 f'''/f' ~ 1e-10, rounding 1e-16/1e-5
#define BIAXIAL_SLOPE(axis)                                                                        \
    static double biaxial_slope_##axis(double x, const double *v) {                                \
        double d = 1e-5;                                                                           \
        return (biaxial_s(x - 1.0 + d, v, axis) - biaxial_s(x - 1.0 - d, v, axis)) / (2.0 * d);    \
    }
BIAXIAL_SLOPE(0)
BIAXIAL_SLOPE(1)
BIAXIAL_SLOPE(2)

static void stretched_neo_hookean_follows_quadrature(void **state) {
    (void)state;
    uint64_t seed = 2718;
    for (int k = 0; k < 4; ++k) {
        double mu = check_random(&seed, 1e3, 9e3), v[] = {mu, (double)INFINITY};
        sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
        tissue.memory = memory_of(k, &seed);
        sn_protocol p = sn_protocol_default(SN_PROTOCOL_BIAXIAL);
        p.stretch_1 = check_random(&seed, 1.05, 1.5);
        p.stretch_2 = k == 1 ? p.stretch_1 : check_random(&seed, 0.9, 1.5);
        p.ramp = pow(10.0, check_random(&seed, -1.5, 1.0));
        p.points = ROWS;
        sn_record *record = run(&tissue, &p);
        sn_history *h = drive(p.ramp);
        const double *time = sn_record_values(record, "time"), *l[2], *T[2];
        l[0] = sn_record_values(record, "stretch_1");
        l[1] = sn_record_values(record, "stretch_2");
        T[0] = sn_record_values(record, "stress_1");
        T[1] = sn_record_values(record, "stress_2");
        double constants[] = {mu, p.stretch_1, p.stretch_2};
        double peak = fmax(fabs(T[0][ROWS - 1]), fabs(T[1][ROWS - 1]));
        assert_true(l[0][ROWS - 1] == p.stretch_1 && l[1][ROWS - 1] == p.stretch_2);
        oracle_slope *slope[] = {biaxial_slope_0, biaxial_slope_1, biaxial_slope_2};
        for (int i = 0; i < ROWS; ++i) {
            double H[3], l3 = 1.0 / (l[0][i] * l[1][i]);
            for (int c = 0; c < 3; ++c)
                H[c] = oracle_hereditary(h, &tissue.memory, time[i], slope[c], constants);
            for (int c = 0; c < 2; ++c)
                CHECK_ABS(T[c][i], l[c][i] * H[c] - l3 * l3 * H[2] / l[c][i], 2e-7 * peak);
        }
        sn_history_destroy(h);
        sn_record_destroy(record);
    }
}

// the thickness of a compressible solid by bisection at every step of a direct convolution
static void compressible_follows_direct_convolution(void **state) {
    (void)state;
    uint64_t seed = 161;
    for (int k = 0; k < 4; ++k) {
        double mu = 2.7e3, K = (k < 2 ? 1.4 : 40.0) * mu, v[] = {mu, K}, T[3][2];
        sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
        tissue.memory = memory_of(k, &seed);
        sn_protocol p = sn_protocol_default(SN_PROTOCOL_BIAXIAL);
        p.stretch_1 = 1.37;
        p.stretch_2 = k == 2 ? 1.37 : check_random(&seed, 0.92, 1.3);
        p.ramp = pow(10.0, check_random(&seed, -0.5, 1.0));
        p.points = ROWS;
        for (int j = 0; j < 3; ++j) {
            int steps = 125 << j;
            oracle_march m = oracle_march_start(&tissue.memory, p.ramp, steps, 4);
            for (int n = 1; n <= steps; ++n) {
                double u = (double)n / steps, low = 0.4, high = 1.6, value[4];
                double l[3] = {1.0 + (p.stretch_1 - 1.0) * u, 1.0 + (p.stretch_2 - 1.0) * u, 1.0};
                oracle_march_history(&m);
                for (int i = 0; i < 52; ++i) {
                    l[2] = 0.5 * (low + high);
                    *(oracle_neo_hookean_stress(&m, mu, K, l, 2) > 0.0 ? &high : &low) = l[2];
                }
                for (int i = 0; i < 2; ++i) T[j][i] = oracle_neo_hookean_stress(&m, mu, K, l, i);
                oracle_neo_hookean(mu, K, l, value);
                oracle_march_keep(&m, value);
            }
            sn_free(m.mean);
        }
        sn_record *record = run(&tissue, &p);
        for (int i = 0; i < 2;
             ++i) { // second order: the h2 part is removed, what moved tells the rest
            double stress = sn_record_values(record, i ? "stress_2" : "stress_1")[ROWS - 1];
            double coarse = T[1][i] + (T[1][i] - T[0][i]) / 3.0;
            double fine = T[2][i] + (T[2][i] - T[1][i]) / 3.0;
            assert_true(fabs(fine - coarse) < 1e-6 * fabs(fine));
            CHECK_ABS(stress, fine, 1e-6 * fabs(fine));
        }
        sn_record_destroy(record);
    }
}

// K over mu of 1e6: the incompressible stresses to mu/K
static void compressible_tends_to_incompressible(void **state) {
    (void)state;
    double v[] = {2e3, 2e9};
    uint64_t seed = 8;
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    tissue.memory = memory_of(0, &seed);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_BIAXIAL);
    p.stretch_1 = 1.21;
    p.stretch_2 = 1.07;
    p.points = ROWS;
    sn_record *soft = run(&tissue, &p), *limit;
    tissue.value[1] = (double)INFINITY;
    limit = run(&tissue, &p);
    for (int i = 0; i < 2; ++i) {
        const double *a = sn_record_values(soft, i ? "stress_2" : "stress_1");
        const double *b = sn_record_values(limit, i ? "stress_2" : "stress_1");
        for (int k = 1; k < ROWS; ++k) CHECK_ABS(a[k], b[k], 3e-6 * b[ROWS - 1]);
    }
    sn_record_destroy(soft);
    sn_record_destroy(limit);
}

//---- membranes -----------------------------------------------------------------------------------

// (20) with its undefined symbols as the manual has them: alpha1..4, c, a1..4, gamma1 2 4 5
static const double skin[] = {1.1e3, 0.8e3, 0.5e3, 0.3e3, 2.3e3, 3.1, 2.4,
                              1.3,   0.9,   0.7,   0.5,   0.3,   0.2};
static void skin_stress(double x, double y, double z, double S[3]) {
    const double *v = skin, *a = v + 5, *g = v + 9;
    double Q = a[0] * x * x + a[1] * y * y + 2.0 * a[2] * z * z + 2.0 * a[3] * x * y +
               g[0] * x * x * x + g[1] * y * y * y + g[2] * x * x * y + g[3] * x * y * y;
    double A1 = a[0] * x + a[3] * y + 1.5 * g[0] * x * x + g[2] * x * y + 0.5 * g[3] * y * y;
    double A2 = a[3] * x + a[1] * y + 1.5 * g[1] * y * y + 0.5 * g[2] * x * x + g[3] * x * y;
    double X = v[4] * exp(Q);
    S[0] = v[0] * x + v[3] * y + X * A1;
    S[1] = v[3] * x + v[1] * y + X * A2;
    S[2] = v[2] * z + X * a[2] * z;
}

// v = {target 1, target 2, component}
static double skin_biaxial(double u, const double *v) {
    double l1 = 1.0 + (v[0] - 1.0) * u, l2 = 1.0 + (v[1] - 1.0) * u, S[3];
    skin_stress(0.5 * (l1 * l1 - 1.0), 0.5 * (l2 * l2 - 1.0), 0.0, S);
    return S[(int)v[2]];
}
static double skin_sheared(double u, const double *v) {
    double g = v[0] * u, S[3];
    skin_stress(0.0, 0.5 * g * g, 0.5 * g, S);
    return S[(int)v[2]];
}
// slopes by central differences, as above
static double skin_biaxial_slope(double x, const double *v) {
    return (skin_biaxial(x - 1.0 + 1e-5, v) - skin_biaxial(x - 1.0 - 1e-5, v)) / 2e-5;
}
static double skin_sheared_slope(double x, const double *v) {
    return (skin_sheared(x - 1.0 + 1e-5, v) - skin_sheared(x - 1.0 - 1e-5, v)) / 2e-5;
}

static void membranes_follow_quadrature(void **state) {
    (void)state;
    uint64_t seed = 577;
    for (int k = 0; k < 4; ++k) {
        sn_tissue tissue = oracle_tissue("fung-skin", skin, 13);
        tissue.memory = memory_of(k, &seed);
        sn_protocol p = sn_protocol_default(k < 2 ? SN_PROTOCOL_BIAXIAL : SN_PROTOCOL_SHEAR);
        p.stretch_1 = check_random(&seed, 1.1, 1.3);
        p.stretch_2 = k ? check_random(&seed, 0.95, 1.3) : p.stretch_1;
        p.shear = check_random(&seed, -0.6, -0.3);
        p.ramp = pow(10.0, check_random(&seed, -1.0, 1.0));
        p.points = ROWS;
        sn_record *record = run(&tissue, &p);
        sn_history *h = drive(p.ramp);
        const double *time = sn_record_values(record, "time");
        for (int i = 0; i < ROWS; ++i) {
            double u = time[i] / p.ramp;
            for (int c = 0; c < 2 && k < 2; ++c) {
                double v[] = {p.stretch_1, p.stretch_2, c}, l = 1.0 + (v[c] - 1.0) * u;
                const double *T = sn_record_values(record, c ? "stress_2" : "stress_1");
                double H = oracle_hereditary(h, &tissue.memory, time[i], skin_biaxial_slope, v);
                CHECK_ABS(T[i], l * H, 2e-7 * fmax(fabs(T[ROWS - 1]), 100.0));
            }
            if (k < 2) continue;
            double v12[] = {p.shear, 0.0, 2.0}, v22[] = {p.shear, 0.0, 1.0};
            const double *T = sn_record_values(record, "shear_stress");
            double H12 = oracle_hereditary(h, &tissue.memory, time[i], skin_sheared_slope, v12);
            double H22 = oracle_hereditary(h, &tissue.memory, time[i], skin_sheared_slope, v22);
            assert_true(fabs(T[ROWS - 1]) > 300.0);
            CHECK_ABS(T[i], H12 + p.shear * u * H22, 2e-7 * fabs(T[ROWS - 1]));
        }
        sn_history_destroy(h);
        sn_record_destroy(record);
    }
}

// without memory: neo-Hookean T = mu (l - l3^2/l) and mu g; a small strain of any law
static void elastic_limits(void **state) {
    (void)state;
    double v[] = {3.3e3, (double)INFINITY}, demiray[] = {2.1e3, 7.0, (double)INFINITY};
    sn_tissue tissue = oracle_tissue("neo-hookean", v, 2);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_BIAXIAL);
    p.stretch_1 = 1.31;
    p.stretch_2 = 0.93;
    sn_record *record = run(&tissue, &p);
    double l3 = 1.0 / (1.31 * 0.93);
    CHECK_REL(sn_record_values(record, "stress_1")[100], 3.3e3 * (1.31 - l3 * l3 / 1.31), 1e-13);
    CHECK_REL(sn_record_values(record, "stress_2")[100], 3.3e3 * (0.93 - l3 * l3 / 0.93), 1e-13);
    sn_record_destroy(record);
    p = sn_protocol_default(SN_PROTOCOL_SHEAR);
    p.shear = 0.83;
    record = run(&tissue, &p);
    CHECK_REL(sn_record_values(record, "shear_stress")[100], 3.3e3 * 0.83, 1e-13);
    sn_record_destroy(record);
    tissue = oracle_tissue("demiray", demiray, 3);
    p.shear = 1e-4; // shear modulus c, next term b g^2
    record = run(&tissue, &p);
    CHECK_REL(sn_record_values(record, "shear_stress")[100], 2.1e3 * 1e-4, 1e-6);
    sn_record_destroy(record);
}

// a strip pulled at the lateral stretch it would take by itself is the uniaxial test: l2 =
// l1^(-1/2) at the end only, so the law and not the memory is compared
static void uniaxial_is_a_biaxial_test(void **state) {
    (void)state;
    double v[] = {2.1e3, 7.0, (double)INFINITY};
    sn_tissue tissue = oracle_tissue("demiray", v, 3);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_BIAXIAL),
                pull = sn_protocol_default(SN_PROTOCOL_TENSILE);
    p.stretch_1 = pull.stretch = 1.44;
    p.stretch_2 = 1.0 / 1.2;
    sn_record *record = run(&tissue, &p), *tensile;
    CHECK_OK(sn_lab_test(&tissue, &pull, &tensile));
    double T = sn_record_values(tensile, "stress")[pull.points - 1];
    CHECK_REL(sn_record_values(record, "stress_1")[100], T, 1e-12);
    CHECK_ABS(sn_record_values(record, "stress_2")[100], 0.0, 1e-12 * T);
    sn_record_destroy(record);
    sn_record_destroy(tensile);
}

static void refusals_say_what(void **state) {
    (void)state;
    double v[] = {12.0, 6e3}, solid[] = {2e3, 2e4};
    sn_record *record;
    sn_tissue tissue = oracle_tissue("exponential", v, 2);
    sn_protocol p = sn_protocol_default(SN_PROTOCOL_BIAXIAL);
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_UNSUPPORTED,
                "a biaxial test needs a solid law");
    p.kind = SN_PROTOCOL_SHEAR;
    p.shear = 0.1;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_UNSUPPORTED,
                "a shear test needs a solid law");
    p.kind = SN_PROTOCOL_BIAXIAL;
    tissue = oracle_tissue("neo-hookean", solid, 2);
    p.stretch_1 = p.stretch_2 = 1.0;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "nothing would move");
    p.stretch_2 = 0.0;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "protocol biaxial: stretch-2");
    p = sn_protocol_default(SN_PROTOCOL_SHEAR);
    p.shear = 0.0;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "nothing would move");
    double huge[] = {2e3, 900.0, (double)INFINITY};
    tissue = oracle_tissue("demiray", huge, 3);
    p.shear = 9.0;
    CHECK_FAILS(sn_lab_test(&tissue, &p, &record), SN_E_RANGE, "overflows");
    assert_null(record);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sheared_neo_hookean_follows_quadrature),
        cmocka_unit_test(stretched_neo_hookean_follows_quadrature),
        cmocka_unit_test(compressible_follows_direct_convolution),
        cmocka_unit_test(compressible_tends_to_incompressible),
        cmocka_unit_test(membranes_follow_quadrature),
        cmocka_unit_test(elastic_limits),
        cmocka_unit_test(uniaxial_is_a_biaxial_test),
        cmocka_unit_test(refusals_say_what),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
