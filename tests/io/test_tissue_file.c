// Tissue files.
// SPDX-License-Identifier: Apache-2.0
#include "hostile.h"
#include "io/yaml.h"

static const char valid[] = "tissue: rabbit skin\n"
                            "source: where the constants come from\n"
                            "density: 1100 kg/m3\n"
                            "elastic: {law: exponential, B: 15, C: 20 kPa}\n"
                            "memory:  {law: fung-spectrum, c: 0.1, tau1: 10 ms, tau2: 100 s}\n";

static sn_tissue read_text(const char *text) {
    sn_tissue tissue;
    CHECK_OK(sn_tissue_read(scratch_write("t.yaml", text, strlen(text)), &tissue));
    return tissue;
}

static double memory_value(const sn_tissue *tissue, const char *name, int term) {
    const sn_memory_law *law = tissue->memory.law;
    int k = sn_param_find(law->params, law->param_count, name);
    assert_true(k >= 0);
    return tissue->memory.value[sn_param_offset(law->params, k, tissue->memory.terms) + term];
}

// All values are finite but for the word that stands for infinity.
static sn_status read_and_check(const char *path) {
    sn_tissue tissue;
    memset(&tissue, 0x5A, sizeof tissue);
    sn_tissue before = tissue;
    sn_status status = sn_tissue_read(path, &tissue);
    if (status != SN_OK) {
        assert_memory_equal(&tissue, &before, sizeof tissue); // untouched
        return status;
    }
    for (int k = 0; k < tissue.law->param_count; k++) {
        const sn_param *param = &tissue.law->params[k];
        const double *value = tissue.value + sn_param_offset(tissue.law->params, k, tissue.terms);
        for (int i = 0; i < sn_param_length(param, tissue.terms); i++)
            assert_true(isfinite(value[i]) || (param->infinity && value[i] > 0));
    }
    int count = sn_param_offset(tissue.memory.law->params, tissue.memory.law->param_count,
                                tissue.memory.terms);
    for (int k = 0; k < count; k++) assert_true(isfinite(tissue.memory.value[k]));
    assert_true(isnan(tissue.density) || (isfinite(tissue.density) && tissue.density > 0));
    return SN_OK;
}

//---- accepted ------------------------------------------------------------------------------------

static void example_of_the_manual(void **state) {
    (void)state;
    sn_tissue t = read_text(valid);
    assert_string_equal(t.name, "rabbit skin");
    assert_string_equal(t.source, "where the constants come from");
    assert_string_equal(t.law->name, "exponential");
    assert_string_equal(t.memory.law->name, "fung-spectrum");
    CHECK_ABS(t.density, 1100.0, 0.0);
    CHECK_ABS(sn_tissue_value(&t, "B"), 15.0, 0.0);
    CHECK_ABS(sn_tissue_value(&t, "C"), 20e3, 0.0);
    CHECK_ABS(memory_value(&t, "c", 0), 0.1, 0.0);
    CHECK_ABS(memory_value(&t, "tau1", 0), 0.01, 0.0);
    CHECK_ABS(memory_value(&t, "tau2", 0), 100.0, 0.0);
    assert_true(isnan(t.poissons_ratio));
}

static void forms_are_equal(void **state) {
    (void)state;
    static const char *const forms[] = {
        // block style, quotes, comments, a byte order mark, CRLF, document marks
        "tissue: rabbit skin\nsource: where the constants come from\ndensity: 1.1 g/cm3\n"
        "elastic:\n  law: exponential\n  B: 15\n  C: 20 kPa\n"
        "memory:\n  law: fung-spectrum\n  c: 10 %\n  tau1: 0.01 s\n  tau2: 100 s\n",
        "\xEF\xBB\xBF--- # a comment\r\n\"tissue\": 'rabbit skin'\r\nsource: >\r\n  where the\r\n"
        "  constants come from\r\n"
        "density: \"1100 kg/m3\"\r\nelastic: {law: exponential, B: 15, C: 20000 Pa}\r\n"
        "memory: {tau2: 100s, tau1: 10ms, c: 1e-1, law: fung-spectrum}\r\n...\r\n",
        "{tissue: rabbit skin, source: where the constants come from, density: 1100 kg/m3,"
        " elastic: {law: exponential, B: 15, C: 0.02 N/mm2}, convention: instantaneous,"
        " memory: {law: fung-spectrum, c: 0.1, tau1: 10 ms, tau2: 100 s}}",
    };
    sn_tissue expected = read_text(valid);
    for (size_t k = 0; k < sizeof forms / sizeof forms[0]; k++) {
        sn_tissue t = read_text(forms[k]);
        assert_string_equal(t.name, expected.name);
        assert_string_equal(t.source, expected.source);
        assert_ptr_equal(t.law, expected.law);
        assert_memory_equal(t.value, expected.value, 2 * sizeof(double));
        assert_memory_equal(t.memory.value, expected.memory.value, 3 * sizeof(double));
        CHECK_ABS(t.density, expected.density, 0.0);
    }
}

static void little_is_needed(void **state) {
    (void)state;
    sn_tissue t = read_text("tissue: t\nelastic: {law: neo-hookean, shear_modulus: 3 kPa, "
                            "bulk_modulus: incompressible}\n");
    assert_true(isnan(t.density));
    assert_string_equal(t.memory.law->name, "none");
    assert_true(isinf(sn_tissue_value(&t, "bulk_modulus")));
    t = read_text("tissue: t\nelastic: {law: linear, modulus: 3 kPa, poissons_ratio: 0.45}\n");
    CHECK_ABS(t.poissons_ratio, 0.45, 0.0);
}

static void lists_are_terms(void **state) {
    (void)state;
    sn_tissue t =
        read_text("tissue: t\nelastic: {law: linear, modulus: 3 kPa}\n"
                  "memory: {law: prony, tau: [10 ms, 1 s, 2 min], g: [0.1, 0.2, 30 %]}\n");
    assert_int_equal(t.memory.terms, 3);
    static const double g[] = {0.1, 0.2, 0.3}, tau[] = {0.01, 1, 120};
    for (int i = 0; i < 3; i++) {
        CHECK_ABS(memory_value(&t, "g", i), g[i], 0.0);
        CHECK_ABS(memory_value(&t, "tau", i), tau[i], 0.0);
    }
}

// Weights over the long-term modulus: G(0)/G(inf) = 1 + 0.5 + 1.5 = 3, so E = 3 * 2 kPa and
// g = 0.5/3, 1.5/3. The key may stand in three places.
static void long_term_constants_are_converted(void **state) {
    (void)state;
    static const char *const forms[] = {
        "tissue: t\nconvention: long-term\nelastic: {law: linear, modulus: 2 kPa}\n"
        "memory: {law: prony, g: [0.5, 1.5], tau: [1 s, 10 s]}\n",
        "tissue: t\nelastic: {law: linear, modulus: 2 kPa, convention: long-term}\n"
        "memory: {law: prony, g: [0.5, 1.5], tau: [1 s, 10 s]}\n",
        "tissue: t\nelastic: {law: linear, modulus: 2 kPa}\n"
        "memory: {law: prony, g: [0.5, 1.5], tau: [1 s, 10 s], convention: long-term}\n",
    };
    for (int k = 0; k < 3; k++) {
        sn_tissue t = read_text(forms[k]);
        CHECK_REL(sn_tissue_value(&t, "modulus"), 6e3, 1e-15);
        CHECK_REL(memory_value(&t, "g", 0), 0.5 / 3, 1e-15);
        CHECK_REL(memory_value(&t, "g", 1), 0.5, 1e-15);
    }
}

// A memory for each part of the stress. What is not named has none, but fibres follow the
// deviatoric memory until they are named.
#define HGO                                                                                        \
    "tissue: t\nelastic: {law: hgo, mu: 2 kPa, k1: 3 kPa, k2: 2, kappa: 0.1, angle: 30 deg, "      \
    "bulk_modulus: 40 kPa}\n"

static void branches(void **state) {
    (void)state;
    sn_tissue t = read_text(HGO "memory:\n  branch:\n"
                                "    deviatoric: {law: prony, g: [0.5], tau: [20 ms]}\n"
                                "    volumetric: {law: kelvin, tau_epsilon: 1 s, tau_sigma: 2 s}\n"
                                "    fibre: {law: none}\n");
    assert_true(t.branched);
    assert_string_equal(t.memory.law->name, "prony");
    CHECK_ABS(memory_value(&t, "tau", 0), 0.02, 0.0);
    assert_string_equal(t.volumetric.law->name, "kelvin");
    CHECK_ABS(t.volumetric.value[1], 2.0, 0.0);
    assert_string_equal(t.fibre.law->name, "none");
    t = read_text(HGO "memory: {branch: {deviatoric: {law: maxwell, tau: 3 s}}}\n");
    assert_string_equal(t.volumetric.law->name, "none");
    assert_string_equal(t.fibre.law->name, "maxwell");
    CHECK_ABS(t.fibre.value[0], 3.0, 0.0);
    t = read_text(HGO "memory: {branch: {volumetric: {law: maxwell, tau: 3 s}}}\n");
    assert_string_equal(t.memory.law->name, "none");
    assert_string_equal(t.fibre.law->name, "none");
    t = read_text("tissue: t\nelastic: {law: demiray, c: 1 kPa, b: 2, bulk_modulus: 9 kPa}\n"
                  "memory: {branch: {deviatoric: {law: maxwell, tau: 3 s}}}\n");
    assert_true(t.branched);
    assert_string_equal(t.fibre.law->name, "none"); // there are none
    t = read_text(HGO
                  "convention: long-term\nmemory: {branch: {deviatoric: {law: prony, g: [1, 2], "
                  "tau: [1 s, 2 s]}, volumetric: {law: prony, g: [0.5], tau: [1 s]}}}\n");
    CHECK_REL(sn_tissue_value(&t, "mu"), 8e3, 1e-15);
    CHECK_REL(sn_tissue_value(&t, "k1"), 12e3, 1e-15);
    CHECK_REL(sn_tissue_value(&t, "bulk_modulus"), 60e3, 1e-15);
    CHECK_REL(t.fibre.value[1], 0.5, 1e-15);
}

//---- refused -------------------------------------------------------------------------------------

#define T "tissue: t\n"
#define E "elastic: {law: exponential, B: 15, C: 20 kPa}\n"

static void bad_tissues_are_refused(void **state) {
    (void)state;
    static const hostile table[] = {
        {"", SN_E_DATA, "the file is empty", NULL},
        {"# nothing\n", SN_E_DATA, "the file is empty", NULL},
        {"rabbit", SN_E_SYNTAX, "t.yaml:1:1: not a map", NULL},
        {"- a\n- b\n", SN_E_SYNTAX, "not a map", NULL},
        {"tissue: [", SN_E_SYNTAX, "t.yaml:", "not YAML"},
        {"tissue: t\n\telastic: x\n", SN_E_SYNTAX, "t.yaml:2:1: not YAML", "tab character"},
        {"tissue: t: u\n", SN_E_SYNTAX, "t.yaml:1:10: not YAML: mapping values are not allowed",
         NULL},
        {"tissue: \"t\n", SN_E_SYNTAX, "not YAML", NULL},
        {"tissue: t\xC3(\n", SN_E_SYNTAX, "t.yaml: not YAML", "at byte 11"},
        {"tissue: \"a\\0b\"\n" E, SN_E_SYNTAX, "t.yaml:1:9: a control character", NULL},
        {"tissue: \"a\\x1B[31m\"\n" E, SN_E_SYNTAX, "a control character", NULL},
        {"a: &a [x,x]\nb: &b [*a,*a]\nc: [*b,*b]\n", SN_E_SYNTAX, "t.yaml:1:4: anchors and aliases",
         NULL},
        {"a: *a\n", SN_E_SYNTAX, "anchors and aliases", NULL},
        {"&a tissue: t\n" E, SN_E_SYNTAX, "anchors and aliases", NULL},
        {"tissue: !!binary aGVsbG8=\n", SN_E_SYNTAX, "t.yaml:1:9: tags (!) are not supported",
         NULL},
        {T E "---\n" T E, SN_E_DATA, "t.yaml:3:1: a second document", NULL},
        {"? [a]\n: b\n", SN_E_SYNTAX, "a key is a list or a map", NULL},
        {T T E, SN_E_KEY, "t.yaml:2:1: key \"tissue\" is given twice, first in line 1", NULL},
        {T "tisue: x\n" E, SN_E_KEY, "t.yaml:2:1: unknown key \"tisue\", did you mean \"tissue\"?",
         NULL},
        {T E "viscosity: 3 Pa s\n", SN_E_KEY, "t.yaml:3:1: unknown key \"viscosity\"",
         "expected one of tissue, source"},
        {E, SN_E_KEY, "t.yaml:1:1: key \"tissue\" is missing", NULL},
        {T, SN_E_KEY, "key \"elastic\" is missing", NULL},
        {"tissue:\n" E, SN_E_SYNTAX, "key \"tissue\": found nothing, expected the name", NULL},
        {"tissue: [a]\n" E, SN_E_SYNTAX, "key \"tissue\": found a list, expected the name", NULL},
        {"tissue: aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\n" E, SN_E_RANGE,
         "key \"tissue\"", "at most 63 bytes"},
        {T E "density: 1100\n", SN_E_UNIT,
         "t.yaml:3:10: key \"density\": found \"1100\" without a unit",
         "a density such as \"10 kg/m3\""},
        {T E "density: 1100 kg\n", SN_E_UNIT, "key \"density\"", "is a mass"},
        {T E "density: 0 kg/m3\n", SN_E_RANGE,
         "key \"density\": found \"0 kg/m3\", expected a density of more than 0", NULL},
        {T E "density: -1 kg/m3\n", SN_E_RANGE, "key \"density\"", "more than 0"},
        {T E "density: nan kg/m3\n", SN_E_SYNTAX, "key \"density\": found \"nan kg/m3\"", NULL},
        {T E "density: 1e999 kg/m3\n", SN_E_SYNTAX, "too large", NULL},
        {T E "density: [1 kg/m3]\n", SN_E_SYNTAX,
         "key \"density\": found a list, expected a density", NULL},
        {T "elastic: exponential\n", SN_E_SYNTAX,
         "key \"elastic\": found \"exponential\", expected a map such as {law:", NULL},
        {T "elastic: {B: 15, C: 20 kPa}\n", SN_E_KEY, "key \"elastic.law\" is missing", NULL},
        {T "elastic: {law: exponental, B: 15, C: 20 kPa}\n", SN_E_NAME,
         "t.yaml:2:16: key \"elastic.law\"", "exponential"},
        {T "elastic: {law: , B: 15, C: 20 kPa}\n", SN_E_SYNTAX,
         "key \"elastic.law\": found nothing", NULL},
        {T "elastic: {law: {a: b}}\n", SN_E_SYNTAX, "key \"elastic.law\": found a map", NULL},
        {T "elastic: {law: exponential, B: 15, c: 20 kPa}\n", SN_E_KEY,
         "t.yaml:2:36: unknown key \"elastic.c\", did you mean \"C\"?", NULL},
        {T "elastic: {law: exponential}\n", SN_E_KEY,
         "key \"elastic\": law exponential needs \"B\", \"C\": missing", NULL},
        {T "elastic: {law: exponential, B: 15}\n", SN_E_KEY, "needs \"C\": missing", NULL},
        {T "elastic: {law: exponential, B: 15, C: 20}\n", SN_E_UNIT,
         "key \"elastic.C\": found \"20\" without a unit, expected a pressure", NULL},
        {T "elastic: {law: exponential, B: 15, C: 20 kpa}\n", SN_E_UNIT, "key \"elastic.C\"",
         "did you mean \"kPa\"?"},
        {T "elastic: {law: exponential, B: 15 mm, C: 20 kPa}\n", SN_E_UNIT, "key \"elastic.B\"",
         "is a length"},
        {T "elastic: {law: exponential, B: 15, C: -20 kPa}\n", SN_E_RANGE,
         "t.yaml:2:39: key \"elastic.C\": found \"-20 kPa\", expected", NULL},
        {T "elastic: {law: exponential, B: 15, C: 20 kPa, poissons_ratio: 0.5}\n", SN_E_RANGE,
         "key \"elastic.poissons_ratio\": found \"0.5\", expected more than -1 and less than 0.5",
         NULL},
        {T "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 1 MPa, poissons_ratio: "
           "0.4}\n",
         SN_E_KEY, "unknown key \"elastic.poissons_ratio\"", NULL},
        {T "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: incompresible}\n",
         SN_E_SYNTAX, "key \"elastic.bulk_modulus\": found \"incompresible\"", "or incompressible"},
        {T "elastic: {law: neo-hookean, shear_modulus: incompressible, bulk_modulus: 1 MPa}\n",
         SN_E_SYNTAX, "key \"elastic.shear_modulus\"", "not a number"},
        {T "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: inf Pa}\n", SN_E_SYNTAX,
         "key \"elastic.bulk_modulus\"", "inf Pa"},
        {T "elastic: {law: neo-hookean, shear_modulus: [3 kPa], bulk_modulus: 1 MPa}\n",
         SN_E_SYNTAX, "found a list, expected a pressure", NULL},
        {T E "memory: none\n", SN_E_SYNTAX,
         "key \"memory\": found \"none\", expected a map such as", NULL},
        {T E "memory: {law: fung, c: 0.1, tau1: 1 s, tau2: 2 s}\n", SN_E_NAME, "key \"memory.law\"",
         NULL},
        {T E "memory: {law: fung-spectrum, c: 0.1, tau1: 1, tau2: 2 s}\n", SN_E_UNIT,
         "key \"memory.tau1\"", "a time such as"},
        {T E "memory: {law: fung-spectrum, c: 0.1, tau1: 2 s, tau2: 1 s}\n", SN_E_RANGE,
         "t.yaml:3:9: key \"memory\"", "tau"},
        {T E "memory: {law: fung-spectrum, c: 0.1, tau1: 0 s, tau2: 1 s}\n", SN_E_RANGE,
         "key \"memory.tau1\": found \"0 s\"", NULL},
        {T E "memory: {law: prony, g: 0.3, tau: 1 s}\n", SN_E_SYNTAX,
         "key \"memory.g\": found \"0.3\", expected a list", NULL},
        {T E "memory: {law: prony, g: [], tau: []}\n", SN_E_SYNTAX,
         "key \"memory.g\": found a list, expected", NULL},
        {T E "memory: {law: prony, g: [0.1, 0.2], tau: [1 s]}\n", SN_E_SYNTAX,
         "key \"memory.tau\": found a list of 1, expected 2 values as in \"g\"", NULL},
        {T E "memory: {law: prony}\n", SN_E_KEY, "memory prony needs \"g\", \"tau\": missing",
         NULL},
        {T E "memory: {law: prony, g: [0.1, x], tau: [1 s, 2 s]}\n", SN_E_SYNTAX,
         "key \"memory.g[2]\": found \"x\"", NULL},
        {T E "memory: {law: prony, g: [0.1, [0.1]], tau: [1 s, 2 s]}\n", SN_E_SYNTAX,
         "key \"memory.g[2]\": found a list", NULL},
        {T E "memory: {law: prony, g: [0.7, 0.7], tau: [1 s, 2 s]}\n", SN_E_RANGE, "key \"memory\"",
         "long-term"},
        {T E "memory: {law: prony, g: [1.2], tau: [1 s]}\n", SN_E_RANGE,
         "key \"memory.g[1]\": found \"1.2\", expected at least 0 and at most 1", NULL},
        {T E "memory: {branch: {deviatoric: {law: prony, g: [0.7], tau: [1 s]}}}\n",
         SN_E_UNSUPPORTED, "t.yaml:3:18: key \"memory.branch\"", "exponential is no three-dim"},
        {HGO "memory: {branch: {deviatorik: {law: none}}}\n", SN_E_KEY,
         "t.yaml:3:19: unknown key \"memory.branch.deviatorik\"", "did you mean \"deviatoric\"?"},
        {HGO "memory: {branches: {fibre: {law: none}}}\n", SN_E_KEY,
         "unknown key \"memory.branches\"", "did you mean \"branch\"?"},
        {HGO "memory: {law: {fibre: {law: none}}}\n", SN_E_SYNTAX, "key \"memory.law\"",
         "the name of a law"},
        {HGO "memory: {law: none, branch: {fibre: {law: none}}}\n", SN_E_KEY,
         "unknown key \"memory.law\"", "branch"},
        {HGO "memory: {branch: {}}\n", SN_E_KEY, "key \"memory.branch\"", "missing"},
        {HGO "memory: {branch: none}\n", SN_E_SYNTAX, "key \"memory.branch\": found \"none\"",
         "a map such as {deviatoric: {law"},
        {HGO "memory: {branch: {fibre: none}}\n", SN_E_SYNTAX, "key \"memory.branch.fibre\"",
         "a map such as {law"},
        {HGO "memory: {branch: {fibre: {law: pronny}}}\n", SN_E_NAME,
         "t.yaml:3:32: key \"memory.branch.fibre.law\"", "did you mean \"prony\"?"},
        {HGO "memory: {branch: {fibre: {law: maxwell, tau: 3}}}\n", SN_E_UNIT,
         "key \"memory.branch.fibre.tau\"", "a time such as"},
        {HGO "memory: {branch: {fibre: {law: maxwell, tau: 3 s, convention: long-term}}}\n",
         SN_E_KEY, "unknown key \"memory.branch.fibre.convention\"", NULL},
        {HGO "memory: {branch: {volumetric: {law: prony, g: [0.7, 0.7], tau: [1 s, 2 s]}}}\n",
         SN_E_RANGE, "key \"memory.branch.volumetric\"", "weights g sum to 1.4"},
        {HGO "memory: {branch: {volumetric: {law: prony, g: [-2], tau: [1 s]}}, convention: "
             "long-term}\n",
         SN_E_RANGE, "key \"memory.convention\"", "volumetric: memory prony"},
        {T "elastic: {law: neo-hookean, shear_modulus: 1 kPa, bulk_modulus: 9 kPa}\n"
           "memory: {branch: {fibre: {law: maxwell, tau: 3 s}}}\n",
         SN_E_UNSUPPORTED, "key \"memory.branch\"", "law neo-hookean has no fibres"},
        {T "elastic: {law: neo-hookean, shear_modulus: 1 kPa, bulk_modulus: incompressible}\n"
           "memory: {branch: {volumetric: {law: maxwell, tau: 3 s}}}\n",
         SN_E_DEFINITION, "key \"memory.branch\"", "incompressible"},
        {T E "convention: longterm\n", SN_E_NAME, "key \"convention\"",
         "did you mean \"long-term\"?"},
        {T E "convention: long-term\nmemory: {law: maxwell, tau: 1 s}\n", SN_E_RANGE,
         "key \"convention\"", "maxwell"},
        {T E "convention: long-term\nmemory: {law: prony, g: [-2], tau: [1 s]}\n", SN_E_RANGE,
         "key \"convention\"", "g"},
        {T E "convention: long-term\nmemory: {law: none, convention: long-term}\n", SN_E_KEY,
         "key \"memory.convention\": given twice, first in line 3", NULL},
        {"a: "
         "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[x]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]"
         "]]]]]]]]]]]]\n",
         SN_E_SYNTAX, "t.yaml:1:35: more than 32 levels", NULL},
    };
    check_hostile(read_and_check, "t.yaml", table, sizeof table / sizeof table[0]);
}

// Files that are large rather than wrong must be refused soon.
static void sizes_are_refused(void **state) {
    (void)state;
    size_t size = 8000000, used = 0;
    char *text = malloc(size);
    used = (size_t)sprintf(text, T E "memory: {law: prony, tau: [");
    for (int k = 0; k < 100; k++) used += (size_t)sprintf(text + used, "%d s, ", k + 1);
    used += (size_t)sprintf(text + used, "1 s], g: [1]}\n");
    scratch_write("t.yaml", text, used);
    CHECK_FAILS(read_and_check(scratch_path("t.yaml")), SN_E_RANGE, "expected at most 64 terms");

    used = 0;
    for (int k = 0; k < 2000; k++) used += (size_t)sprintf(text + used, "k%d: 1\n", k);
    scratch_write("t.yaml", text, used);
    CHECK_FAILS(read_and_check(scratch_path("t.yaml")), SN_E_DATA,
                "t.yaml:1001:1: more than 1000 keys");

    memset(text, '[', size);
    memcpy(text, "a: ", 3);
    scratch_write("t.yaml", text, size);
    CHECK_FAILS(read_and_check(scratch_path("t.yaml")), SN_E_SYNTAX, "more than 32 levels");

    memcpy(text, "a: [", 4);
    for (size_t k = 4; k + 1 < size; k += 2) memcpy(text + k, "x,", 2);
    scratch_write("t.yaml", text, size);
    CHECK_FAILS(read_and_check(scratch_path("t.yaml")), SN_E_DATA, "more than 2000000 values");
    free(text);

    CHECK_FAILS(read_and_check("/dev/zero"), SN_E_DATA, "more than 64 MiB");
    CHECK_FAILS(read_and_check(scratch_path("none.yaml")), SN_E_FILE, "none.yaml: cannot open");
    CHECK_FAILS(read_and_check(scratch), SN_E_FILE, "is a folder");
}

static void mutations_are_survived(void **state) {
    (void)state;
    check_fuzz(read_and_check, "t.yaml", valid, 2000);
    check_fuzz(read_and_check, "t.yaml",
               "tissue: 'l'\nelastic:\n  law: neo-hookean\n  shear_modulus: 3 kPa\n"
               "  bulk_modulus: incompressible\nconvention: long-term\n"
               "memory: {law: prony, g: [0.1, 2e-1], tau: [1 s, 10 s]}\n",
               1000);
}

//---- written -------------------------------------------------------------------------------------

static void check_same_memory(const sn_memory *a, const sn_memory *b) {
    assert_ptr_equal(a->law, b->law);
    assert_int_equal(a->terms, b->terms);
    int count = sn_param_offset(a->law->params, a->law->param_count, a->terms);
    assert_memory_equal(a->value, b->value, (size_t)count * sizeof(double));
}

static void check_same(const sn_tissue *a, const sn_tissue *b) {
    assert_string_equal(a->name, b->name);
    assert_string_equal(a->source, b->source);
    assert_ptr_equal(a->law, b->law);
    assert_int_equal(a->terms, b->terms);
    assert_true(a->branched == b->branched);
    for (int k = 0; k < SN_PARTS; k++)
        check_same_memory(sn_tissue_memory(a, (sn_part)k), sn_tissue_memory(b, (sn_part)k));
    int count = sn_param_offset(a->law->params, a->law->param_count, a->terms);
    assert_memory_equal(a->value, b->value, (size_t)count * sizeof(double));
    assert_true(a->density == b->density || (isnan(a->density) && isnan(b->density)));
    assert_true(a->poissons_ratio == b->poissons_ratio ||
                (isnan(a->poissons_ratio) && isnan(b->poissons_ratio)));
}

// A value within the range of a parameter, of any magnitude where the range allows.
static double random_value(uint64_t *seed, const sn_param *param) {
    if (param->infinity && check_random(seed, 0, 1) < 0.3) return (double)INFINITY;
    double low = fmax(param->min, -1e9), high = fmin(param->max, 1e9);
    if (low > 0 || (low == 0 && param->min_open)) {
        low = fmax(low, 1e-9);
        return low * pow(high / low, check_random(seed, 0.01, 0.99));
    }
    return low + (high - low) * check_random(seed, 0.01, 0.99);
}

static void fill_random(uint64_t *seed, const sn_param *params, int count, int terms,
                        double *values) {
    for (int k = 0; k < count; k++) {
        double *list = values;
        for (int i = 0; i < sn_param_length(&params[k], terms); i++)
            *values++ = random_value(seed, &params[k]);
        if (params[k].length != 9) continue;
        for (int i = 0; i < 9; i++) list[i] = fabs(list[i]); // a convex form, to be written at all
        for (int i = 3; i < 6; i++) list[i] *= 0.4 * fmin(list[0], fmin(list[1], list[2])) / 1e9;
    }
}

// Every law with every memory, constants drawn at random, comes back to the bit.
static void written_tissues_read_back_to_the_bit(void **state) {
    (void)state;
    uint64_t seed = 11;
    int written = 0, tried = 0, in_parts = 0;
    for (int l = 0; l < sn_law_count(); l++) {
        int of_law = 0;
        for (int m = 0; m < sn_memory_law_count() * 8; m++, tried++) {
            sn_tissue tissue = sn_tissue_default(), back;
            tissue.law = sn_law_at(l);
            tissue.memory.law = sn_memory_law_at(m / 8);
            for (int k = 0; k < tissue.law->param_count; k++)
                if (tissue.law->params[k].length == SN_PARAM_LIST) tissue.terms = 1 + m % 3;
            for (int k = 0; k < tissue.memory.law->param_count; k++)
                if (tissue.memory.law->params[k].length == SN_PARAM_LIST)
                    tissue.memory.terms = 1 + m % 5;
            strcpy(tissue.name, m % 2 ? "t" : "It's: #1 {\"odd\\\"}, µ -");
            strcpy(tissue.source, m % 3 ? "" : "- [1] https://x.org/y?z=1 & more: 'a'");
            if (m % 2) tissue.density = check_random(&seed, 1, 5000);
            if (m % 4 == 1 && tissue.law->kind == SN_LAW_UNIAXIAL)
                tissue.poissons_ratio = check_random(&seed, -0.9, 0.49);
            fill_random(&seed, tissue.law->params, tissue.law->param_count, tissue.terms,
                        tissue.value);
            fill_random(&seed, tissue.memory.law->params, tissue.memory.law->param_count,
                        tissue.memory.terms, tissue.memory.value);
            if (tissue.memory.terms) // weights that sum to less than 1
                for (int i = 0; i < tissue.memory.terms; i++) tissue.memory.value[i] /= 8;
            // every third solid relaxes in parts, and maybe another law's memory in one of them
            tissue.branched = m % 3 == 2 && tissue.law->kind == SN_LAW_SOLID;
            if (m % 2) tissue.volumetric = tissue.memory;
            if (tissue.law->fibre_constant && m % 4) tissue.fibre = tissue.memory;
            if (sn_tissue_check(&tissue) != SN_OK) continue; // conditions beyond the ranges
            in_parts += tissue.branched;
            const char *path = scratch_path("w.yaml");
            CHECK_OK(sn_tissue_write(path, &tissue, m % 2 ? "fitted to\n\ntwo: curves\t#" : NULL));
            CHECK_OK(sn_tissue_read(path, &back));
            check_same(&tissue, &back);
            written++, of_law++;
        }
        assert_true(of_law > 3);
    }
    if (getenv("SINEW_SHOW")) print_message("%d of %d tissues written\n", written, tried);
    assert_true(written > tried / 3 && in_parts > 20);
}

static void laws_with_lists_and_angles(void **state) {
    (void)state;
    sn_tissue t = read_text("tissue: brain\nelastic: {law: ogden, mu: [0.5 kPa, -200 Pa], "
                            "alpha: [3, -4.5], bulk_modulus: incompressible}\n");
    assert_int_equal(t.terms, 2);
    const double ogden[] = {500, -200, 3, -4.5};
    for (int k = 0; k < 4; k++) assert_true(t.value[k] == ogden[k]);
    assert_true(isinf(t.value[4]));
    t = read_text("tissue: artery\nelastic: {law: hgo, mu: 7.64 kPa, k1: 996.6 kPa, k2: 524.6, "
                  "kappa: 0.226, angle: 90 deg, bulk_modulus: 1 MPa}\n");
    CHECK_REL(t.value[4], 1.57079632679489661923, 1e-15);
    t = read_text("tissue: skin\nelastic: {law: fung, c: 2 kPa, a: [9, 5, 4, 1, 0, -1, 3, 2, 2], "
                  "bulk_modulus: 1 MPa}\n");
    assert_true(t.value[1] == 9 && t.value[6] == -1 && t.value[10] == 1e6);
    const struct {
        const char *elastic, *part;
    } bad[] = {
        {"{law: ogden, mu: [1 kPa], alpha: [2, 3], bulk_modulus: 1 MPa}", "found a list of 2"},
        {"{law: ogden, mu: [1 kPa], alpha: [-2], bulk_modulus: 1 MPa}", "mu alpha of term 1"},
        {"{law: fung, c: 1 kPa, a: [1, 1, 1], bulk_modulus: 1 MPa}", "expected 9 values"},
        {"{law: fung-planar, c: 1 kPa, a1: 1, a2: 1, a3: 1, a4: 2}", "positive definite"},
        {"{law: hgo, mu: 1 kPa, k1: 1 kPa, k2: 1, kappa: 0, angle: 40, bulk_modulus: 1 MPa}",
         "an angle such as"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        char text[300];
        sn_tissue out = sn_tissue_default();
        snprintf(text, sizeof text, "tissue: t\nelastic: %s\n", bad[k].elastic);
        assert_true(sn_tissue_read(scratch_write("t.yaml", text, strlen(text)), &out) != SN_OK);
        assert_non_null(strstr(sn_error_text(), bad[k].part));
        assert_non_null(strstr(sn_error_text(), "t.yaml:2"));
    }
}

static void written_text_is_readable(void **state) {
    (void)state;
    char text[1000] = "";
    sn_tissue tissue = read_text(valid);
    const char *path = scratch_path("w.yaml");
    CHECK_OK(sn_tissue_write(path, &tissue, "a remark"));
    FILE *file = fopen(path, "r");
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_string_equal(text, "# a remark\n"
                              "tissue: rabbit skin\n"
                              "source: where the constants come from\n"
                              "density: 1100 kg/m3\n"
                              "elastic:\n  law: exponential\n  B: 15\n  C: 20 kPa\n"
                              "memory:\n  law: fung-spectrum\n  c: 0.1\n  tau1: 10 ms\n"
                              "  tau2: 100 s\n");
    tissue = read_text(HGO "memory: {branch: {deviatoric: {law: maxwell, tau: 3 s}}}\n");
    CHECK_OK(sn_tissue_write(path, &tissue, NULL));
    memset(text, 0, sizeof text);
    file = fopen(path, "r");
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    assert_string_equal(strstr(text, "memory:"),
                        "memory:\n  branch:\n    deviatoric:\n      law: maxwell\n      tau: 3 s\n"
                        "    volumetric:\n      law: none\n"
                        "    fibre:\n      law: maxwell\n      tau: 3 s\n");
    sn_tissue empty = sn_tissue_default();
    CHECK_FAILS(sn_tissue_write(path, &empty, NULL), SN_E_DEFINITION, "no elastic law");
    CHECK_FAILS(sn_tissue_write(scratch_path("no/t.yaml"), &tissue, NULL), SN_E_FILE, "no/t.yaml");
}

//---- the tree ------------------------------------------------------------------------------------

static void places_are_right(void **state) {
    (void)state;
    static const char text[] = "a: 1\nb:\n  - x\n  - {c: y,\n     d: [p, q]}\n";
    sn_yaml *root;
    CHECK_OK(sn_yaml_read(scratch_write("t.yaml", text, strlen(text)), &root));
    const sn_yaml *d = sn_yaml_get(sn_yaml_get(root, "b")->last, "d");
    assert_non_null(d);
    assert_int_equal(d->line, 5);
    assert_int_equal(d->column, 9);
    assert_int_equal(d->key_column, 6);
    sn_yaml_fail(d->last, SN_E_RANGE, "x");
    assert_non_null(strstr(sn_error_text(), "t.yaml:5:13: key \"b[2].d[2]\": x"));
    assert_null(sn_yaml_get(root, "c"));
    assert_null(sn_yaml_get(d, "c"));
    sn_yaml_destroy(root);
    sn_yaml_destroy(NULL);
}

static void numbers_are_whole(void **state) {
    (void)state;
    static const struct {
        const char *text;
        sn_status status;
        int value;
    } table[] = {{"n: 12", SN_OK, 12},        {"n: +7", SN_OK, 7},
                 {"n: 1.5", SN_E_SYNTAX, 0},  {"n: 1e2", SN_E_SYNTAX, 0},
                 {"n: 10 m", SN_E_SYNTAX, 0}, {"n: ", SN_E_SYNTAX, 0},
                 {"n: a", SN_E_SYNTAX, 0},    {"n: 0", SN_E_RANGE, 0},
                 {"n: -3", SN_E_RANGE, 0},    {"n: 101", SN_E_RANGE, 0},
                 {"n: [1]", SN_E_SYNTAX, 0},  {"n: 99999999999999999999999", SN_E_RANGE, 0},
                 {"n: 0x10", SN_E_SYNTAX, 0}};
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        sn_yaml *root;
        int value = 0;
        CHECK_OK(
            sn_yaml_read(scratch_write("t.yaml", table[k].text, strlen(table[k].text)), &root));
        assert_int_equal(sn_yaml_int(root->first, 1, 100, &value), table[k].status);
        assert_int_equal(value, table[k].value);
        sn_yaml_destroy(root);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_the_manual),
        cmocka_unit_test(forms_are_equal),
        cmocka_unit_test(little_is_needed),
        cmocka_unit_test(lists_are_terms),
        cmocka_unit_test(long_term_constants_are_converted),
        cmocka_unit_test(branches),
        cmocka_unit_test(bad_tissues_are_refused),
        cmocka_unit_test(sizes_are_refused),
        cmocka_unit_test(mutations_are_survived),
        cmocka_unit_test(written_tissues_read_back_to_the_bit),
        cmocka_unit_test(laws_with_lists_and_angles),
        cmocka_unit_test(written_text_is_readable),
        cmocka_unit_test(places_are_right),
        cmocka_unit_test(numbers_are_whole),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
