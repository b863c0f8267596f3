// Tissues in the files of FEBio and Abaqus: energies of those programs, round trips, hostile files.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>
#include <string.h>

#include "hostile.h"

typedef sn_status writer(const char *path, const sn_tissue *tissue, sn_foreign *how);
typedef sn_status reader(const char *path, sn_tissue *tissue, sn_foreign *how);

// kPa, ms, mm: a unit of density of 1e3 1e-6/1e-6
static sn_foreign units(void) {
    sn_foreign how = sn_foreign_default();
    how.stress = 1e3;
    how.time = 1e-3;
    how.length = 1e-3;
    return how;
}

static sn_tissue tissue_of(const char *yaml) {
    sn_tissue tissue;
    CHECK_OK(sn_tissue_read(scratch_write("t.yaml", yaml, strlen(yaml)), &tissue));
    return tissue;
}

#define HEAD "tissue: some tissue\ndensity: 1060 kg/m3\n"
#define MEMORY "memory: {law: prony, g: [0.31, 0.17, 0.05], tau: [13 ms, 0.7 s, 91 s]}\n"

static const char *const both[] = {
    HEAD "elastic: {law: neo-hookean, shear_modulus: 3.1 kPa, bulk_modulus: 307 kPa}\n" MEMORY,
    HEAD "elastic: {law: mooney-rivlin, c1: 1.3 kPa, c2: 0.7 kPa, bulk_modulus: 307 kPa}\n" MEMORY,
    HEAD "elastic: {law: ogden, mu: [1.7 kPa, -0.3 kPa], alpha: [2.6, -3.1], bulk_modulus: 1 "
         "MPa}\n" MEMORY,
    HEAD "elastic: {law: fung, c: 1.9 kPa, a: [3, 2.2, 1.4, 0.3, 0.2, -0.1, 1.1, 1.3, 0.6], "
         "bulk_modulus: 1 MPa}\n" MEMORY,
    HEAD "elastic: {law: hgo, mu: 7 kPa, k1: 10.3 kPa, k2: 5.1, kappa: 0.11, angle: 41 deg, "
         "bulk_modulus: 1 MPa}\n" MEMORY,
    HEAD "elastic: {law: neo-hookean, shear_modulus: 3.1 kPa, bulk_modulus: 307 kPa}\n",
};
static const char *const febio_only[] = {
    HEAD "elastic: {law: demiray, c: 1.9 kPa, b: 3.7, bulk_modulus: 1 MPa}\n" MEMORY,
    HEAD "elastic: {law: veronda-westmann, c1: 1.9 kPa, c2: 3.7, bulk_modulus: 1 MPa}\n" MEMORY,
    HEAD "elastic: {law: neo-hookean, shear_modulus: 3.1 kPa, bulk_modulus: 307 kPa}\n"
         "memory: {law: maxwell, tau: 3 s}\n",
};
static const char *const abaqus_only[] = {
    HEAD "elastic: {law: mooney-rivlin, c1: 1.3 kPa, c2: 0.7 kPa, bulk_modulus: "
         "incompressible}\n" MEMORY,
};

//---- round trips ---------------------------------------------------------------------------------

static void check_trip(const char *yaml, const char *file, writer *write, reader *read) {
    const sn_tissue tissue = tissue_of(yaml);
    sn_tissue back;
    sn_foreign how = units();
    CHECK_OK(write(scratch_path(file), &tissue, &how));
    assert_true(how.max_error == 0);
    CHECK_OK(read(scratch_path(file), &back, &how));
    assert_ptr_equal(back.law, tissue.law);
    assert_int_equal(back.terms, tissue.terms);
    CHECK_REL(back.density, 1060, 1e-14);
    int count = sn_param_offset(back.law->params, back.law->param_count, back.terms);
    // some ten roundings, and those of a 3 x 3 inverse with a condition number below 10
    for (int i = 0; i < count; i++)
        if (isinf(tissue.value[i]))
            assert_true(isinf(back.value[i]));
        else
            CHECK_REL(back.value[i], tissue.value[i], 1e-12);
    sn_exponentials one, two;
    CHECK_OK(sn_memory_expand(&tissue.memory, &one));
    CHECK_OK(sn_memory_expand(&back.memory, &two));
    assert_int_equal(one.terms, two.terms);
    CHECK_ABS(two.g_inf, one.g_inf, 1e-12);
    for (int i = 0; i < one.terms; i++) {
        CHECK_REL(two.g[i], one.g[i], 1e-12);
        CHECK_REL(two.tau[i], one.tau[i], 1e-12);
    }
}

static void round_trips(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        check_trip(both[k], "t.feb", sn_tissue_write_febio, sn_tissue_read_febio);
        check_trip(both[k], "t.inp", sn_tissue_write_abaqus, sn_tissue_read_abaqus);
    }
    for (int k = 0; k < 3; k++)
        check_trip(febio_only[k], "t.feb", sn_tissue_write_febio, sn_tissue_read_febio);
    check_trip(abaqus_only[0], "t.inp", sn_tissue_write_abaqus, sn_tissue_read_abaqus);
}

//---- energies as the other programs define them, from the numbers in the file
//---------------------

static char *slurp(const char *path) {
    static char text[8192];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    return text;
}

// the number behind a mark
static double after(const char *text, const char *mark) {
    const char *at = strstr(text, mark);
    if (!at) fail_msg("no %s", mark);
    return strtod(at + strlen(mark), NULL);
}

// energy of a tissue at an isochoric strain of det(2E + I) = 1, J/m3
static double energy_of(const sn_tissue *tissue, const double E[6]) {
    double W;
    sn_law_solid(tissue->law, tissue->value, tissue->terms, 1, E, &W, NULL, NULL);
    return W;
}

// principal stretches 1.2, 0.9, 1/(1.2 0.9), turned about the third axis by 0.4
static void strain(double E[6], double stretch[3]) {
    double c = cos(0.4), s = sin(0.4), L[3];
    stretch[0] = 1.2, stretch[1] = 0.9, stretch[2] = 1 / (1.2 * 0.9);
    for (int i = 0; i < 3; i++) L[i] = 0.5 * (stretch[i] * stretch[i] - 1);
    const double turned[6] = {c * c * L[0] + s * s * L[1],
                              s * s * L[0] + c * c * L[1],
                              L[2],
                              c * s * (L[0] - L[1]),
                              0,
                              0};
    memcpy(E, turned, sizeof turned);
}

static double invariant(int which, const double l[3]) {
    double sum = -3;
    for (int i = 0; i < 3; i++) sum += which == 1 ? l[i] * l[i] : 1 / (l[i] * l[i]);
    return sum;
}

static double powers(double alpha, const double l[3]) {
    return pow(l[0], alpha) + pow(l[1], alpha) + pow(l[2], alpha) - 3;
}

// two families at +-angle in the first two axes
static double fibres(double k1, double k2, double kappa, double angle, const double E[6],
                     double I1) {
    double W = 0;
    for (int side = -1; side <= 1; side += 2) {
        double c = cos(angle), s = side * sin(angle);
        double I4 = 2 * (c * c * E[0] + s * s * E[1] + 2 * c * s * E[3]);
        double e = fmax(0, kappa * I1 + (1 - 3 * kappa) * I4);
        W += k1 / (2 * k2) * (exp(k2 * e * e) - 1);
    }
    return W;
}

// FEBio's: Q = sum_a (2 mu_a a.E^2 a + sum_b lambda_ab E_aa E_bb)/c with Lame constants of E, G, v
static double febio_fung(const char *f, const double E[6]) {
    double E1 = after(f, "<E1>"), E2 = after(f, "<E2>"), E3 = after(f, "<E3>");
    double G12 = after(f, "<G12>"), G23 = after(f, "<G23>"), G31 = after(f, "<G31>");
    double S[3][3] = {{1 / E1, -after(f, "<v12>") / E1, -after(f, "<v31>") / E3},
                      {0, 1 / E2, -after(f, "<v23>") / E2},
                      {0, 0, 1 / E3}};
    S[1][0] = S[0][1], S[2][0] = S[0][2], S[2][1] = S[1][2];
    double det = 0, C[3][3], c = after(f, "<c>");
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3, p = (i + 1) % 3, q = (i + 2) % 3;
            C[i][k] = S[a][p] * S[b][q] - S[a][q] * S[b][p];
        }
    for (int k = 0; k < 3; k++) det += S[0][k] * C[k][0];
    double mu[3] = {G12 + G31 - G23, G12 - G31 + G23, -G12 + G31 + G23};
    double squares[3] = {E[0] * E[0] + E[3] * E[3] + E[5] * E[5],
                         E[1] * E[1] + E[3] * E[3] + E[4] * E[4],
                         E[2] * E[2] + E[4] * E[4] + E[5] * E[5]};
    double Q = 0;
    for (int i = 0; i < 3; i++) {
        Q += 2 * mu[i] * squares[i];
        for (int k = 0; k < 3; k++) Q += (C[i][k] / det - (i == k ? 2 * mu[i] : 0)) * E[i] * E[k];
    }
    return 0.5 * c * (exp(Q / c) - 1);
}

static double febio_energy(int law, const char *f, const double E[6], const double l[3]) {
    double I1 = invariant(1, l), I2 = invariant(2, l);
    if (law <= 1) return after(f, "<c1>") * I1 + after(f, "<c2>") * I2;
    if (law == 2) {
        double m1 = after(f, "<m1>"), m2 = after(f, "<m2>");
        return after(f, "<c1>") / (m1 * m1) * powers(m1, l) +
               after(f, "<c2>") / (m2 * m2) * powers(m2, l);
    }
    if (law == 3) return febio_fung(f, E);
    return 0.5 * after(f, "<c>") * I1 + fibres(after(f, "<k1>"), after(f, "<k2>"),
                                               after(f, "<kappa>"),
                                               after(f, "<gamma>") / 180 * M_PI, E, I1);
}

static double abaqus_energy(int law, const char *f, const double E[6], const double l[3]) {
    double v[12] = {0}, I1 = invariant(1, l), I2 = invariant(2, l), Q = 0;
    const char *s = strstr(f, "HYPERELASTIC,");
    assert_non_null(strstr(s, "MODULI=INSTANTANEOUS\n"));
    s = strchr(s, '\n') + 1;
    for (int i = 0; i < 12 && *s != '*'; i++) {
        char *end;
        v[i] = strtod(s, &end);
        s = end + strspn(end, ", \n");
    }
    if (law == 0) return v[0] * I1;
    if (law == 1) return v[0] * I1 + v[1] * I2;
    if (law == 2)
        return 2 * v[0] / (v[1] * v[1]) * powers(v[1], l) +
               2 * v[2] / (v[3] * v[3]) * powers(v[3], l);
    if (law == 4) {
        const char *d = strstr(f, "\n3, 0.\n") + 7;
        char *end;
        double c = strtod(d, &end), angle = atan2(strtod(end + 1, NULL), c);
        return v[0] * I1 + fibres(v[2], v[3], v[4], angle, E, I1);
    }
    // b1111 b1122 b2222 b1133 b2233 b3333 b1212 b1313 b2323 c D, summed over all indices
    Q = v[0] * E[0] * E[0] + 2 * v[1] * E[0] * E[1] + v[2] * E[1] * E[1] + 2 * v[3] * E[0] * E[2] +
        2 * v[4] * E[1] * E[2] + v[5] * E[2] * E[2] +
        4 * (v[6] * E[3] * E[3] + v[7] * E[5] * E[5] + v[8] * E[4] * E[4]);
    return 0.5 * v[9] * (exp(Q) - 1);
}

static void energies_are_theirs(void **state) {
    (void)state;
    double E[6], l[3];
    strain(E, l);
    for (int k = 0; k < 5; k++) {
        const sn_tissue tissue = tissue_of(both[k]);
        sn_foreign how = units();
        double W = energy_of(&tissue, E) / 1e3, g_inf = 1 - 0.31 - 0.17 - 0.05;
        assert_true(W > 0);
        CHECK_OK(sn_tissue_write_febio(scratch_path("t.feb"), &tissue, &how));
        // FEBio holds the long-term law: W G(infinity)
        const char *text = slurp(scratch_path("t.feb"));
        const char *elastic = strstr(text, "<elastic");
        CHECK_REL(febio_energy(k, elastic, E, l), W * g_inf, 1e-12);
        CHECK_REL(after(text, "<g1>"), 0.31 / g_inf, 1e-14);
        CHECK_REL(after(text, "<t2>"), 700, 1e-14);
        CHECK_REL(after(text, "<k>"), k < 2 ? 307 : 1000, 1e-14);
        CHECK_REL(after(text, "<density>"), 1.06, 1e-14); // kPa ms2/mm2 is 1000 kg/m3
        assert_non_null(strstr(text, "<pressure_model>2<"));
        assert_non_null(strstr(how.remarks, "spares the volume"));
        CHECK_OK(sn_tissue_write_abaqus(scratch_path("t.inp"), &tissue, &how));
        text = slurp(scratch_path("t.inp"));
        CHECK_REL(abaqus_energy(k, text, E, l), W, 1e-12);
        const char *memory = strstr(text, "*VISCOELASTIC, TIME=PRONY\n");
        assert_non_null(memory);
        CHECK_REL(after(memory, "PRONY\n0.31, 0.31, "), 13, 1e-14);
        CHECK_REL(after(memory, "\n0.17, 0.17, "), 700, 1e-14);
    }
}

// what a spectrum costs is said, and true
static void spectra_are_compressed(void **state) {
    (void)state;
    const sn_tissue tissue =
        tissue_of(HEAD "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 300 kPa}\n"
                       "memory: {law: fung-spectrum, c: 0.5, tau1: 1 us, tau2: 1e5 s}\n");
    for (int program = 0; program < 2; program++) {
        sn_tissue back;
        sn_foreign how = units();
        how.from = 1e-6;
        how.to = 1e6;
        const char *path = scratch_path(program ? "s.inp" : "s.feb");
        CHECK_OK((program ? sn_tissue_write_abaqus : sn_tissue_write_febio)(path, &tissue, &how));
        assert_true(how.terms <= (program ? 13 : 6));
        assert_true(how.max_error > 0 && how.max_error < (program ? 2e-3 : 0.05));
        assert_non_null(strstr(how.remarks, "exponentials, error at most"));
        double said = how.max_error, worst = 0;
        CHECK_OK((program ? sn_tissue_read_abaqus : sn_tissue_read_febio)(path, &back, &how));
        for (double t = 1e-6; t < 1e6; t *= 1.1)
            worst = fmax(worst, fabs(sn_memory_relaxation(&back.memory, t) -
                                     sn_memory_relaxation(&tissue.memory, t)));
        assert_true(worst <= said * (1 + 1e-9) + 1e-12 && worst > 0.5 * said);
        CHECK_REL(sn_memory_relaxation(&back.memory, 0), 1, 1e-12);
    }
}

// constants of the long term, the default of Abaqus, and a memory that spares the volume
static void long_term_constants(void **state) {
    (void)state;
    const char text[] = "*Material, name=a\n*Hyperelastic, neo hooke\n 0.5, 0.002\n"
                        "*Viscoelastic, time=prony\n0.5, 0, 2.\n*Solid Section, material=A\n";
    sn_tissue t;
    sn_foreign how = units();
    CHECK_OK(sn_tissue_read_abaqus(scratch_write("l.inp", text, strlen(text)), &t, &how));
    CHECK_REL(sn_tissue_value(&t, "shear_modulus"), 2e3, 1e-15);
    CHECK_REL(sn_tissue_value(&t, "bulk_modulus"), 1e6, 1e-15);
    assert_non_null(strstr(how.remarks, "spares the volume"));
    assert_string_equal(t.name, "A");
    assert_true(isnan(t.density));
    const char feb[] =
        "<febio_spec version=\"4.0\"><Material><material id=\"1\" name=\"x\" "
        "type=\"Mooney-Rivlin\"><density>1</density><c1>1</c1><c2>0</c2><k>100</k>"
        "</material><material id=\"2\" name=\"y\" type=\"Ogden\"><c1>4</c1><m1>2</m1>"
        "<k>100</k></material></Material></febio_spec>";
    const char *path = scratch_write("m.feb", feb, strlen(feb));
    how.material = "y";
    CHECK_OK(sn_tissue_read_febio(path, &t, &how));
    CHECK_REL(sn_tissue_value(&t, "bulk_modulus"), 1e5, 1e-15);
    assert_string_equal(t.law->name, "ogden");
    assert_non_null(strstr(how.remarks, "pressure_model"));
    how.material = "z";
    assert_int_equal(sn_tissue_read_febio(path, &t, &how), SN_E_NAME);
    how.material = NULL;
    assert_int_equal(sn_tissue_read_febio(path, &t, &how), SN_E_NAME);
    assert_non_null(strstr(sn_error_text(), "--material"));
}

//---- refusals and hostile files ------------------------------------------------------------------

static void refusals_say_what(void **state) {
    (void)state;
    static const struct {
        const char *yaml;
        writer *write;
        const char *part;
    } cases[] = {
        {HEAD "elastic: {law: exponential, B: 3, C: 2 kPa}\n", sn_tissue_write_febio,
         "no counterpart in FEBio"},
        {HEAD "elastic: {law: demiray, c: 1 kPa, b: 3, bulk_modulus: 1 MPa}\n",
         sn_tissue_write_abaqus, "no counterpart in Abaqus"},
        {HEAD "elastic: {law: demiray, c: 1 Pa, b: 900, bulk_modulus: 1 MPa}\n",
         sn_tissue_write_febio, "--stress-unit"},
        {HEAD "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: incompressible}\n",
         sn_tissue_write_febio, "FEBio needs a number"},
        {HEAD "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 1 MPa}\n"
              "memory: {law: voigt, tau: 1 s}\n",
         sn_tissue_write_febio, "purely viscous"},
        {HEAD "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 1 MPa}\n"
              "memory: {law: maxwell, tau: 1 s}\n",
         sn_tissue_write_abaqus, "relaxes to no stress"},
        {HEAD "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 1 MPa}\n"
              "memory: {branch: {deviatoric: {law: prony, g: [0.3], tau: [1 s]}}}\n",
         sn_tissue_write_febio, "memory branch: a file of another program takes one"},
    };
    for (int k = 0; k < 7; k++) {
        const sn_tissue tissue = tissue_of(cases[k].yaml);
        sn_foreign how = units();
        assert_int_equal(cases[k].write(scratch_path("no"), &tissue, &how), SN_E_UNSUPPORTED);
        assert_non_null(strstr(sn_error_text(), cases[k].part));
        assert_int_equal(access(scratch_path("no"), F_OK), -1);
    }
    const sn_tissue tissue = tissue_of(both[0]);
    sn_foreign how = sn_foreign_default();
    assert_int_equal(sn_tissue_write_febio(scratch_path("no"), &tissue, &how), SN_E_DEFINITION);
    how = units();
    how.to = how.from;
    assert_int_equal(sn_tissue_write_febio(scratch_path("no"), &tissue, &how), SN_E_DEFINITION);
}

static sn_status read_febio(const char *path) {
    sn_tissue tissue;
    sn_foreign how = units();
    return sn_tissue_read_febio(path, &tissue, &how);
}

static sn_status read_abaqus(const char *path) {
    sn_tissue tissue;
    sn_foreign how = units();
    return sn_tissue_read_abaqus(path, &tissue, &how);
}

#define FEB(type, inside)                                                                          \
    "<febio_spec><Material><material type=\"" type "\">" inside                                    \
    "</material></Material></febio_spec>"

static void bad_febio_files_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {"", SN_E_SYNTAX, "no XML", NULL},
        {"<a><b></a>", SN_E_SYNTAX, "no XML", NULL},
        {"<a/>", SN_E_KEY, "expected <febio_spec>", NULL},
        {"<febio_spec><Material/></febio_spec>", SN_E_KEY, "no <material>", NULL},
        {FEB("Mooney-Rivlin", "<c1>1</c1><k>9</k>"), SN_E_KEY, "<c2> is missing", ":1"},
        {FEB("Mooney-Rivlin", "<c1>1</c1><c2>x</c2><k>9</k>"), SN_E_SYNTAX, "found \"x\"", "<c2>"},
        {FEB("Mooney-Rivlin", "<c1>nan</c1><c2>1</c2><k>9</k>"), SN_E_SYNTAX, "nan", NULL},
        {FEB("Mooney-Rivlin", "<c1>1</c1><c1>1</c1><c2>1</c2><k>9</k>"), SN_E_KEY, "twice", NULL},
        {FEB("Mooney-Rivlin", "<c1>1</c1><c2>0</c2>"), SN_E_KEY, "<k>", NULL},
        {FEB("Mooney-Rivlin", "<c1>-1</c1><c2>0</c2><k>9</k>"), SN_E_RANGE, "shear_modulus", NULL},
        {FEB("Mooney-Rivlin", "<c1>1</c1><c2>0</c2><k>9</k><x>1</x>"), SN_E_KEY, "<x>", NULL},
        {FEB("Mooney-Rivln", ""), SN_E_UNSUPPORTED, "did you mean \"Mooney-Rivlin\"", NULL},
        {FEB("uncoupled viscoelastic", "<k>1</k>"), SN_E_KEY, "<elastic> is missing", NULL},
        {FEB("uncoupled viscoelastic",
             "<k>9</k><g1>-2</g1><elastic type=\"Mooney-Rivlin\"><c1>1</c1><c2>0</c2></elastic>"),
         SN_E_RANGE, "weights", NULL},
        {FEB("Ogden", "<k>9</k>"), SN_E_KEY, "<c1>", NULL},
        {FEB("Ogden", "<c1>1</c1><m1>0</m1><k>9</k>"), SN_E_RANGE, "power", NULL},
        {FEB("uncoupled hyperelastic", "<W>3*I1</W><k>9</k>"), SN_E_UNSUPPORTED, "A*(exp", NULL},
        {FEB("Fung orthotropic",
             "<E1>1</E1><E2>1</E2><E3>1</E3><G12>1</G12><G23>1</G23><G31>1</G31><v12>2</v12>"
             "<v23>0</v23><v31>0</v31><c>1</c><k>1</k>"),
         SN_E_RANGE, "positive definite", NULL},
        {"<!DOCTYPE a [<!ENTITY b SYSTEM \"/etc/hostname\">]>" FEB(
             "Mooney-Rivlin", "<c1>&b;</c1><c2>0</c2><k>9</k>"),
         SN_E_SYNTAX, "expected a number", NULL},
    };
    check_hostile(read_febio, "bad.feb", table, sizeof table / sizeof table[0]);
}

static void bad_abaqus_files_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {"", SN_E_KEY, "no *MATERIAL", NULL},
        {"*MATERIAL, NAME=A\n", SN_E_KEY, "no *HYPERELASTIC", NULL},
        {"*MATERIAL, NAME=A\n*ELASTIC\n1, 2\n", SN_E_UNSUPPORTED, "*ELASTIC", ":2"},
        {"*MATERIAL, NAME=A\n*MATERIAL, NAME=B\n", SN_E_NAME, "--material", ":2"},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n", SN_E_SYNTAX, "numbers", ":2"},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\nx\n", SN_E_SYNTAX, "numbers", ":2"},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,2,3\n", SN_E_SYNTAX, "C10 and D1", ":2"},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,-2\n", SN_E_RANGE, "D is negative", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, YEOH\n1,2,3\n", SN_E_UNSUPPORTED, "NEO HOOKE", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, OGDEN, N=9\n1,2,3\n", SN_E_RANGE, "N from 1", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, OGDEN, N=2\n1,2,3,4,0,1\n", SN_E_UNSUPPORTED, "D2",
         NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, OGDEN\n1,0,1\n", SN_E_RANGE, "alpha", NULL},
        {"*MATERIAL, NAME=A\n*ANISOTROPIC HYPERELASTIC, HOLZAPFEL\n1,2,3,4,0.1\n", SN_E_KEY,
         "*ORIENTATION", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,2\n*HYPERELASTIC, NEO HOOKE\n1,2\n",
         SN_E_KEY, "twice", ":4"},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,2\n*VISCOELASTIC, TIME=CREEP\n1,2,3\n",
         SN_E_UNSUPPORTED, "TIME=PRONY", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,2\n*VISCOELASTIC, TIME=PRONY\n1,2\n",
         SN_E_SYNTAX, "g, k, tau", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,2\n*VISCOELASTIC, TIME=PRONY\n.1,.2,3\n",
         SN_E_UNSUPPORTED, "k = g", NULL},
        {"*MATERIAL, NAME=A\n*HYPERELASTIC, NEO HOOKE\n1,2\n*VISCOELASTIC, TIME=PRONY\n1,1,3\n",
         SN_E_RANGE, "sum", NULL},
    };
    check_hostile(read_abaqus, "bad.inp", table, sizeof table / sizeof table[0]);
}

static void mutations_are_survived(void **state) {
    (void)state;
    const sn_tissue tissue = tissue_of(both[4]);
    sn_foreign how = units();
    char text[8192];
    CHECK_OK(sn_tissue_write_febio(scratch_path("t.feb"), &tissue, &how));
    strcpy(text, slurp(scratch_path("t.feb")));
    check_fuzz(read_febio, "fuzz.feb", text, 3000);
    CHECK_OK(sn_tissue_write_abaqus(scratch_path("t.inp"), &tissue, &how));
    strcpy(text, strchr(strchr(slurp(scratch_path("t.inp")), '\n') + 1, '\n') + 1); // no comments
    check_fuzz(read_abaqus, "fuzz.inp", text, 3000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trips),
        cmocka_unit_test(energies_are_theirs),
        cmocka_unit_test(spectra_are_compressed),
        cmocka_unit_test(long_term_constants),
        cmocka_unit_test(refusals_say_what),
        cmocka_unit_test(bad_febio_files_are_refused),
        cmocka_unit_test(bad_abaqus_files_are_refused),
        cmocka_unit_test(mutations_are_survived),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
