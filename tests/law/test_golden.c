// The bits of every law: the same for every compiler, instruction set and machine, forever, until a
// change of the arithmetic is meant. Then the new hashes, which the failing test prints, go below.
// SPDX-License-Identifier: Apache-2.0
#include "points.h"

enum { POINTS = 1001 };

static const struct golden {
    const char *law;
    uint64_t hash;
} goldens[] = {
    {"linear", 0x39388a3e5eca997dull},
    {"exponential", 0xee7fdca5243fd403ull},
    {"hookean", 0x82438467767df05bull},
    {"neo-hookean", 0x05d0a2852e78d847ull},
    {"mooney-rivlin", 0xb0b301797a450c99ull},
    {"demiray", 0x67b56b52fdf6eecbull},
    {"veronda-westmann", 0xb424032a43671ea2ull},
    {"guccione", 0x102fb928324d1574ull},
    {"ogden", 0xfd40d9796a5d78cbull},
    {"fung", 0x27053e8c6734ab46ull},
    {"fung-general", 0x0f3e3f108b21a4d9ull},
    {"hgo", 0xf33de2c7a750e5f7ull},
    {"fung-skin", 0xd0e8bd77c0e43dc4ull},
    {"fung-planar", 0x4515998cf9d73678ull},
};

/// FNV-1a.
static uint64_t hash_of(uint64_t hash, const void *data, size_t bytes) {
    for (size_t i = 0; i < bytes; i++)
        hash = (hash ^ ((const unsigned char *)data)[i]) * 1099511628211ull;
    return hash;
}

// arguments come from sums and products only, so that they are the same everywhere too
static uint64_t law_hash(const sn_law *law) {
    static double E[6 * POINTS], W[POINTS], S[6 * POINTS], D[21 * POINTS];
    static float E_f[6 * POINTS], W_f[POINTS], S_f[6 * POINTS], D_f[21 * POINTS];
    double value[POINTS_VALUES_MAX];
    float value_f[POINTS_VALUES_MAX];
    const int terms = law_terms(law);
    for (int k = 0, at = 0; k < law->param_count; k++) {
        const sn_param *p = &law->params[k];
        for (int i = 0; i < sn_param_length(p, terms); i++, at++) {
            bool pressure = strcmp(p->unit, "Pa") == 0;
            double one = p->length == 9 && i >= 3 ? 0.25 : 1; // convex without a thought
            value[at] = one * (pressure       ? 3000 * (at + 1)
                               : p->max < 0.4 ? 0.25
                               : p->max < 1   ? 0.375
                               : p->max < 2   ? 0.75
                                              : 2.5 + at);
            value_f[at] = (float)value[at];
        }
    }
    uint64_t seed = 401;
    const bool solid = law->kind == SN_LAW_SOLID;
    for (int i = 0; i < POINTS; i++) {
        double one[6];
        random_strain(&seed, 0.25, one);
        if (law->kind == SN_LAW_UNIAXIAL) one[0] += 1;
        for (int k = 0; k < 6; k++) E_f[k * POINTS + i] = (float)(E[k * POINTS + i] = one[k]);
    }
    memset(D, 0, sizeof D), memset(S, 0, sizeof S);
    memset(D_f, 0, sizeof D_f), memset(S_f, 0, sizeof S_f);
    if (solid) {
        sn_law_solid(law, value, terms, POINTS, E, W, S, D);
        sn_law_solid_f(law, value_f, terms, POINTS, E_f, W_f, S_f, D_f);
    } else if (law->kind == SN_LAW_MEMBRANE) {
        sn_law_membrane(law, value, terms, POINTS, E, W, S, D);
        sn_law_membrane_f(law, value_f, terms, POINTS, E_f, W_f, S_f, D_f);
    } else {
        sn_law_uniaxial(law, value, 0, POINTS, E, W, S, D);
        sn_law_uniaxial_f(law, value_f, 0, POINTS, E_f, W_f, S_f, D_f);
    }
    uint64_t hash = 14695981039346656037ull;
    hash = hash_of(hash_of(hash_of(hash, W, sizeof W), S, sizeof S), D, sizeof D);
    return hash_of(hash_of(hash_of(hash, W_f, sizeof W_f), S_f, sizeof S_f), D_f, sizeof D_f);
}

static void test_golden(void **state) {
    (void)state;
    bool good = true;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        uint64_t hash = law_hash(law);
        bool found = false;
        for (size_t g = 0; g < sizeof goldens / sizeof goldens[0]; g++)
            found |= strcmp(goldens[g].law, law->name) == 0 && goldens[g].hash == hash;
        if (!found)
            print_message("    {\"%s\", 0x%016llxull},\n", law->name, (unsigned long long)hash);
        good &= found;
    }
    assert_true(good);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_golden)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
