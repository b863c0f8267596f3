// Memories of the parts of the stress: what is refused, the split, conversion to and fro.
// SPDX-License-Identifier: Apache-2.0
#include "laws.h"

static sn_memory memory_of(const char *law, int terms, const double *value, int count) {
    sn_memory memory = {.law = sn_memory_law_find(law), .terms = terms};
    assert_non_null(memory.law);
    memcpy(memory.value, value, (size_t)count * sizeof *value);
    return memory;
}

static const double two[] = {0.31, 0.17, 0.06, 2.9}; // g, tau
static const double one[] = {0.42, 0.7};

static sn_tissue branched(const char *law) {
    sn_tissue t = some_tissue(sn_law_find(law));
    t.branched = true;
    t.memory = memory_of("prony", 2, two, 4);
    t.volumetric = memory_of("prony", 1, one, 2);
    if (t.law->fibre_constant)
        t.fibre = memory_of("fung-spectrum", 0, (double[]){0.2, 0.01, 60}, 3);
    CHECK_OK(sn_tissue_check(&t));
    return t;
}

static void check_refuses(void **state) {
    (void)state;
    sn_tissue t = branched("demiray");
    t.fibre = t.memory;
    CHECK_FAILS(sn_tissue_check(&t), SN_E_UNSUPPORTED,
                "tissue demiray: memory branch fibre: law demiray has no fibres");
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_UNSUPPORTED, "law demiray has no fibres");
    t.branched = false; // then nobody looks at it
    CHECK_OK(sn_tissue_check(&t));
    t = branched("hgo");
    CHECK_OK(sn_tissue_set(&t, "bulk_modulus", (double)INFINITY));
    CHECK_FAILS(sn_tissue_check(&t), SN_E_DEFINITION,
                "memory branch volumetric: law hgo is incompressible");
    t.volumetric = sn_memory_none();
    CHECK_OK(sn_tissue_check(&t));
    t.fibre.value[1] = 0; // tau1
    CHECK_FAILS(sn_tissue_check(&t), SN_E_RANGE, "tissue hgo: fibre: memory fung-spectrum");
    static const char *const flat[] = {"exponential", "fung-planar"};
    for (int k = 0; k < 2; k++) {
        t = sn_tissue_default();
        t.law = sn_law_find(flat[k]);
        memcpy(t.value, (double[]){20, 3, 2, 1, 0.5}, 5 * sizeof(double));
        CHECK_OK(sn_tissue_check(&t));
        t.branched = true;
        CHECK_FAILS(sn_tissue_check(&t), SN_E_UNSUPPORTED, "no three-dimensional solid");
        assert_non_null(strstr(sn_error_text(), flat[k]));
    }
}

static void memories_of_parts(void **state) {
    (void)state;
    sn_tissue t = branched("hgo");
    assert_ptr_equal(sn_tissue_memory(&t, SN_PART_DEVIATORIC), &t.memory);
    assert_ptr_equal(sn_tissue_memory(&t, SN_PART_VOLUMETRIC), &t.volumetric);
    assert_ptr_equal(sn_tissue_memory(&t, SN_PART_FIBRE), &t.fibre);
    t.branched = false;
    for (int k = 0; k < SN_PARTS; k++)
        assert_ptr_equal(sn_tissue_memory(&t, (sn_part)k), &t.memory);
}

// Matrix and fibres apart whatever their memories, each with its own.
static void fibres_split_at_will(void **state) {
    (void)state;
    sn_tissue part[2], t = branched("hgo");
    for (int k = 0; k < 2; k++) {
        t.branched = k;
        assert_int_equal(sn_tissue_split(&t, part), 1 + k);
        assert_int_equal(sn_tissue_split_fibres(&t, part), 2);
        assert_true(sn_tissue_value(&part[0], "k1") == 0 && sn_tissue_value(&part[1], "mu") == 0);
        assert_true(sn_tissue_value(&part[0], "mu") == sn_tissue_value(&t, "mu"));
        assert_true(sn_tissue_value(&part[1], "k1") == sn_tissue_value(&t, "k1"));
        assert_ptr_equal(part[1].memory.law, (k ? &t.fibre : &t.memory)->law);
        assert_false(part[0].branched || part[1].branched);
    }
    t = some_tissue(sn_law_find("guccione"));
    assert_int_equal(sn_tissue_split_fibres(&t, part), 1);
}

enum { POINTS = 40 };

static double largest(const double *v, int n) {
    double size = 0;
    for (int i = 0; i < n; i++) size = fmax(size, fabs(v[i]));
    return size;
}

// Energy, stress and tangent of the parts add up to the whole's; the matrix does not see the fibre
// constant, and the fibres see nothing else. Two sums of a few terms: a few rounding units.
static void parts_add_up(void **state) {
    (void)state;
    int with_fibres = 0;
    for (int l = 0; l < sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l);
        if (law->kind != SN_LAW_SOLID) continue;
        sn_tissue t = branched(law->name), part[2], other[2];
        int parts = sn_tissue_split(&t, part);
        assert_int_equal(parts, law->fibre_constant ? 2 : 1);
        assert_true(!part[0].branched && part[0].memory.terms == 2);
        if (parts == 1) {
            assert_memory_equal(part[0].value, t.value, sizeof t.value);
            continue;
        }
        with_fibres++;
        assert_string_equal(part[1].memory.law->name, "fung-spectrum");
        double E[6 * POINTS], R[3][28 * POINTS]; // W, S, D
        uint64_t seed = 31;
        for (int i = 0; i < 6 * POINTS; i++)
            E[i] = check_random(&seed, i < 3 * POINTS ? -0.1 : -0.05, i < 3 * POINTS ? 0.2 : 0.05);
        const sn_tissue *all[] = {&t, &part[0], &part[1]};
        for (int k = 0; k < 3; k++)
            sn_law_solid(law, all[k]->value, all[k]->terms, POINTS, E, R[k], R[k] + POINTS,
                         R[k] + 7 * POINTS);
        static const int start[] = {0, 1, 7, 28};
        for (int k = 0; k < 3; k++) {
            int at = start[k] * POINTS, n = (start[k + 1] - start[k]) * POINTS;
            double size = largest(R[0] + at, n), error = 0;
            for (int i = at; i < at + n; i++)
                error = fmax(error, fabs(R[1][i] + R[2][i] - R[0][i]));
            CHECK_ABS(error / size, 0, 1e-14);
            assert_true(largest(R[1] + at, n) > 0.05 * size && largest(R[2] + at, n) > 0.05 * size);
        }
        CHECK_OK(
            sn_tissue_set(&t, law->fibre_constant, 2 * sn_tissue_value(&t, law->fibre_constant)));
        assert_int_equal(sn_tissue_split(&t, other), 2);
        assert_memory_equal(other[0].value, part[0].value, sizeof t.value);
        double S[6 * POINTS];
        sn_law_solid(law, other[1].value, other[1].terms, POINTS, E, NULL, S, NULL);
        for (int i = 0; i < 6 * POINTS; i++)
            CHECK_ABS(S[i], 2 * R[2][POINTS + i], 1e-14 * largest(S, 6 * POINTS));
        t.fibre = t.memory; // fibres that relax as the matrix does need not be apart
        assert_int_equal(sn_tissue_split(&t, other), 1);
        assert_memory_equal(other[0].value, t.value, sizeof t.value);
    }
    assert_true(with_fibres > 0);
}

// Each part by its own ratio: 1 + sum g of the weights over the long-term modulus, or
// 1/G(infinity).
static void from_long_term(void **state) {
    (void)state;
    sn_tissue t = branched("hgo"), given = t;
    t.memory = memory_of("prony", 2, (double[]){1.5, 0.5, 0.06, 2.9}, 4); // 3
    t.volumetric = memory_of("prony", 1, (double[]){0.25, 0.7}, 2);       // 1.25
    t.fibre = memory_of("kelvin", 0, (double[]){1, 4}, 2);                // G(infinity) = 1/4
    CHECK_OK(sn_tissue_from_long_term(&t));
    CHECK_REL(sn_tissue_value(&t, "mu"), 3 * sn_tissue_value(&given, "mu"), 1e-15);
    CHECK_REL(sn_tissue_value(&t, "k1"), 4 * sn_tissue_value(&given, "k1"), 1e-15);
    CHECK_REL(sn_tissue_value(&t, "bulk_modulus"), 1.25 * sn_tissue_value(&given, "bulk_modulus"),
              1e-15);
    assert_true(sn_tissue_value(&t, "k2") == sn_tissue_value(&given, "k2"));
    CHECK_REL(t.memory.value[0], 0.5, 1e-15);
    CHECK_REL(t.volumetric.value[0], 0.2, 1e-15);
    CHECK_OK(sn_tissue_check(&t));
    // hookean: one modulus and a ratio are both parts
    t = branched("hookean");
    given = t;
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_UNSUPPORTED, "hookean has no bulk_modulus");
    assert_memory_equal(&t, &given, sizeof t);
    t.volumetric = t.memory;
    CHECK_OK(sn_tissue_from_long_term(&t));
    CHECK_REL(sn_tissue_value(&t, "youngs_modulus"),
              1.48 * sn_tissue_value(&given, "youngs_modulus"), 1e-15);
    t = branched("neo-hookean");
    t.volumetric = memory_of("maxwell", 0, (double[]){1}, 1);
    CHECK_FAILS(sn_tissue_from_long_term(&t), SN_E_RANGE, "volumetric: memory maxwell relaxes");
}

// To the long term and back: two divisions and a sum, a few rounding units.
static void round_trip(void **state) {
    (void)state;
    int tried = 0;
    for (int l = 0; l < 2 * sn_law_count(); l++) {
        const sn_law *law = sn_law_at(l / 2);
        bool parts = l % 2;
        if (law->kind == SN_LAW_MEMBRANE) continue;
        if (parts && (law->kind != SN_LAW_SOLID || !strcmp(law->name, "hookean"))) continue;
        sn_tissue t = some_tissue(law), there;
        t.memory = memory_of("prony", 2, two, 4);
        t.branched = parts;
        if (parts) t.volumetric = memory_of("prony", 1, one, 2);
        there = t;
        CHECK_OK(sn_tissue_to_long_term(&there));
        int count = sn_param_offset(law->params, law->param_count, t.terms);
        bool moved = false;
        for (int k = 0; k < count; k++) moved |= there.value[k] != t.value[k];
        assert_true(moved);
        CHECK_REL(there.memory.value[0], 0.31 / 0.52, 1e-15);
        CHECK_REL(there.memory.value[1], 0.17 / 0.52, 1e-15);
        assert_memory_equal(there.memory.value + 2, two + 2, 2 * sizeof *two);
        CHECK_OK(sn_tissue_from_long_term(&there));
        CHECK_OK(sn_tissue_check(&there));
        for (int k = 0; k < count; k++)
            if (isfinite(t.value[k]))
                CHECK_ABS(there.value[k], t.value[k], 1e-15 * fabs(t.value[k]));
            else
                assert_true(there.value[k] == t.value[k]);
        for (int k = 0; k < 2; k++) {
            CHECK_REL(there.memory.value[k], two[k], 1e-15);
            if (parts) CHECK_REL(there.volumetric.value[0], one[0], 1e-15);
        }
        tried++;
    }
    assert_true(tried > sn_law_count() + 5);
    // fibres without a memory keep theirs
    sn_tissue t = branched("hgo"), there;
    t.fibre = sn_memory_none();
    there = t;
    CHECK_OK(sn_tissue_to_long_term(&there));
    CHECK_REL(sn_tissue_value(&there, "mu"), 0.52 * sn_tissue_value(&t, "mu"), 1e-15);
    CHECK_REL(sn_tissue_value(&there, "bulk_modulus"), 0.58 * sn_tissue_value(&t, "bulk_modulus"),
              1e-15);
    assert_true(sn_tissue_value(&there, "k1") == sn_tissue_value(&t, "k1"));
}

static void to_long_term_refuses(void **state) {
    (void)state;
    sn_tissue t = branched("neo-hookean"), given;
    t.volumetric = memory_of("kelvin", 0, (double[]){1, 4}, 2);
    given = t;
    CHECK_FAILS(sn_tissue_to_long_term(&t), SN_E_UNSUPPORTED,
                "volumetric: memory kelvin has no weights");
    assert_memory_equal(&t, &given, sizeof t); // though the deviatoric one could be converted
    t.branched = false;
    t.memory = memory_of("prony", 2, (double[]){0.25, 0.75, 1, 2}, 4);
    CHECK_FAILS(sn_tissue_to_long_term(&t), SN_E_RANGE, "a fluid has no long-term constants");
    t.memory.value[0] = 0.5;
    CHECK_FAILS(sn_tissue_to_long_term(&t), SN_E_RANGE, "weights g sum to 1.25");
    t.law = NULL;
    CHECK_FAILS(sn_tissue_to_long_term(&t), SN_E_DEFINITION, "without an elastic law");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(check_refuses),        cmocka_unit_test(memories_of_parts),
        cmocka_unit_test(fibres_split_at_will), cmocka_unit_test(parts_add_up),
        cmocka_unit_test(from_long_term),       cmocka_unit_test(round_trip),
        cmocka_unit_test(to_long_term_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
