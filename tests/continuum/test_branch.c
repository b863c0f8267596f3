// A memory for each part of the stress: steps that show one part, equal memories against one,
// rotation.
// SPDX-License-Identifier: Apache-2.0
#include "body.h"
#include "continuum/problem.h"

static const sn_element elements[] = {SN_ELEMENT_P1, SN_ELEMENT_P2, SN_ELEMENT_P2P1};

static sn_case *cube(const sn_tissue *t, sn_element element) {
    sn_case *c = body_block(0.01, 0.01, 0.01, 1, 1, 1, t, element);
    c->fibre[0] = t->law->fibres ? 1 : 0;
    c->until = 20;
    c->output_every = 1;
    c->continuum.memory_tolerance = 1e-6;
    return c;
}

static sn_tissue parted(void) {
    sn_tissue t = body_artery(0.1, 9e3);
    sn_tissue n = neo_hookean(3000, 6000);
    n.branched = true;
    n.memory = t.memory;
    n.volumetric = t.volumetric;
    return n;
}

static void relax(const sn_case *c, const double weight[SN_PARTS]) {
    sn_run_summary summary;
    sn_record *r = body_run(c, NULL, &summary);
    check_relaxation(r, c->tissue, weight);
    sn_record_destroy(r);
}

// Blown up by 8 % along every axis: nothing but pressure.
static void volume_relaxes_alone(void **state) {
    (void)state;
    sn_tissue t = parted();
    for (int e = 0; e < 3; e++) {
        sn_case *c = cube(&t, elements[e]);
        body_rollers(c);
        body_move(c, "right", 0.0008, ANY, ANY, NULL);
        body_move(c, "back", ANY, 0.0008, ANY, NULL);
        body_move(c, "top", ANY, ANY, 0.0008, NULL);
        body_reaction(c, "pull", "right");
        relax(c, (double[]){0, 1, 0});
        sn_case_destroy(c);
    }
}

// Simple shear of 0.4 by the corners of linear cells: J = 1, nothing but S_d.
static void shape_relaxes_alone(void **state) {
    (void)state;
    sn_tissue t = parted();
    sn_case *c = cube(&t, SN_ELEMENT_P1);
    body_support(c, "bottom", true, true, true);
    body_move(c, "top", 0.004, 0, 0, NULL);
    body_reaction(c, "pull", "top");
    relax(c, (double[]){1, 0, 0});
    sn_case_destroy(c);
}

// Stretched along the first axis with the sides held: F = diag(1.15, 1, 1), all parts at once.
// Their shares from the law.
static void parts_relax_each(void **state) {
    (void)state;
    sn_tissue t = body_artery(0.1, 9e3);
    double share[SN_PARTS], sum = 0;
    part_stresses(&t, 1.15, share);
    for (int k = 0; k < SN_PARTS; k++) sum += share[k];
    for (int k = 0; k < SN_PARTS; k++) assert_true((share[k] /= sum) > 0.1);
    for (int e = 0; e < 3; e++) {
        sn_case *c = cube(&t, elements[e]);
        body_rollers(c);
        body_move(c, "right", 0.0015, ANY, ANY, NULL);
        body_move(c, "back", ANY, 0, ANY, NULL);
        body_move(c, "top", ANY, ANY, 0, NULL);
        body_reaction(c, "pull", "right");
        relax(c, share);
        sn_case_destroy(c);
    }
}

// One memory for all, written twice: the fibres' exponentials stand in another order, so that they
// are kept apart; on a body with free sides, turned fibres and a ramp. Both runs solve the balance
// to 1e-10 of the force.
static void equal_branches_are_one_memory(void **state) {
    (void)state;
    static const double back[] = {0.25, 0.3, 3.0, 0.2};
    for (int k = 0; k < 4; k++) {
        double bulk = k == 3 ? (double)INFINITY : 9e3;
        sn_tissue t = body_artery(0.1, bulk), part[2];
        t.volumetric = k == 3 ? sn_memory_none() : t.memory;
        t.fibre = t.memory;
        memcpy(t.fibre.value, back, sizeof back);
        assert_int_equal(sn_tissue_split(&t, part), 2);
        sn_record *r[2];
        sn_run_summary summary[2];
        for (int one = 0; one < 2; one++) {
            t.branched = !one;
            sn_case *c = body_block(0.02, 0.01, 0.01, 2, 1, 1, &t, elements[k == 3 ? 2 : k]);
            c->fibre[0] = 0.8, c->fibre[1] = 0.6;
            body_support(c, "left", true, true, true);
            body_move(c, "right", 0.003, 0.001, 0.002, make_ramp(0, 0.5));
            body_reaction(c, "pull", "right");
            body_probe(c, "tip", 0.01, 0.01, 0.01);
            c->until = 1;
            c->output_every = 0.25;
            c->continuum.steps = 8;
            r[one] = body_run(c, NULL, &summary[one]);
            sn_case_destroy(c);
        }
        assert_int_equal(r[0]->rows, r[1]->rows);
        static const char *const column[] = {"pull_fx", "pull_fy", "pull_fz",
                                             "tip_ux",  "tip_uy",  "tip_uz"};
        for (int j = 0; j < 6; j++)
            for (int i = 1; i < r[0]->rows; i++)
                CHECK_REL(sn_record_values(r[0], column[j])[i],
                          sn_record_values(r[1], column[j])[i], 1e-12);
        CHECK_REL(summary[0].elastic_J, summary[1].elastic_J, 1e-12);
        CHECK_REL(summary[0].dissipated_J, summary[1].dissipated_J, 1e-11);
        assert_int_equal(summary[0].memory_terms, summary[1].memory_terms);
        assert_true(summary[0].cutbacks == 0);
        for (int one = 0; one < 2; one++) sn_record_destroy(r[one]);
    }
}

// x of F X + noise, all turned by R; the pressures are left.
static void place(const sn_fe_space *s, const double F[3][3], const double *noise,
                  const double R[3][3], double *x) {
    for (int a = 0; a < s->nodes; a++) {
        double at[3];
        for (int i = 0; i < 3; i++) {
            at[i] = noise[3 * a + i];
            for (int j = 0; j < 3; j++) at[i] += F[i][j] * s->rest[3 * a + j];
        }
        for (int i = 0; i < 3; i++) {
            x[3 * a + i] = -s->rest[3 * a + i];
            for (int j = 0; j < 3; j++) x[3 * a + i] += R[i][j] * at[j];
        }
    }
}

// A body is strained in four steps, once as it is and once while it turns: S is the same at all
// times. Rounding: displacements of the size of the body.
static void rotation_leaves_the_stress(void **state) {
    (void)state;
    static const double still[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    sn_tissue t = body_artery(0.1, 9e3);
    for (int e = 0; e < 3; e++) {
        sn_case *c = body_block(0.03, 0.02, 0.01, 2, 1, 1, &t, elements[e]);
        c->fibre[0] = 0.6, c->fibre[2] = 0.8;
        body_support(c, "left", true, true, true);
        sn_fe_problem *p[2];
        sn_fe_balance balance;
        for (int k = 0; k < 2; k++) CHECK_OK(sn_fe_problem_create(c, 0.1, &p[k]));
        size_t dofs = (size_t)p[0]->space->dofs, stresses = 6 * SN_FE_POINTS;
        double *x = sn_alloc(dofs, 8), *noise = sn_alloc(dofs, 8);
        double *S = sn_alloc(stresses, 8), largest = 0, worst = 0;
        uint64_t seed = 7;
        for (size_t d = 0; d < dofs; d++) noise[d] = check_random(&seed, -4e-4, 4e-4);
        for (size_t d = 3 * (size_t)p[0]->space->nodes; d < dofs; d++)
            x[d] = check_random(&seed, -900, 900);
        for (int step = 1; step <= 4; step++) {
            double g = 0.07 * step, a = 0.9 * step; // shear and angle
            const double F[3][3] = {{1 + g, 0.3 * g, 0}, {0, 1 - 0.2 * g, g}, {0, 0, 1}};
            const double R[3][3] = {{cos(a), -sin(a), 0}, {sin(a), cos(a), 0}, {0, 0, 1}};
            for (int k = 0; k < 2; k++) {
                place(p[k]->space, F, noise, k ? R : still, x);
                sn_fe_problem_begin(p[k], (sn_fe_level){0.3 * step, 1, 0.3});
                sn_fe_problem_balance(p[k], x, &balance); // leaves the points of the last batch
                assert_true(balance.sound);
                const double *now = p[k]->work->points.S;
                for (size_t i = 0; i < stresses; i++) {
                    if (k) worst = fmax(worst, fabs(now[i] - S[i]));
                    S[i] = now[i];
                    largest = fmax(largest, fabs(S[i]));
                }
                sn_fe_problem_commit(p[k], x, &balance);
            }
        }
        assert_true(largest > 300);
        CHECK_ABS(worst / largest, 0, 1e-12);
        double *const all[] = {x, noise, S};
        for (int k = 0; k < 3; k++) sn_free(all[k]);
        for (int k = 0; k < 2; k++) sn_fe_problem_destroy(p[k]);
        sn_case_destroy(c);
    }
}

// memories that forget nothing, or fibres only
static void parts_without_memory(void **state) {
    (void)state;
    static const double prony[] = {0, 1}, tau = 0.4;
    sn_tissue t = body_artery(0.1, 9e3);
    double force[3];
    for (int k = 0; k < 3; k++) {
        if (k == 0) t.branched = false, t.memory = sn_memory_none();
        if (k > 0) t.branched = true, t.volumetric = sn_memory_none();
        if (k == 1) t.fibre.law = sn_memory_law_find("prony"), t.fibre.terms = 1;
        if (k == 1) memcpy(t.fibre.value, prony, sizeof prony);
        if (k == 2) t.fibre = (sn_memory){.law = sn_memory_law_find("voigt"), .value = {tau}};
        sn_case *c = cube(&t, SN_ELEMENT_P2P1);
        body_rollers(c);
        body_move(c, "right", 0.002, ANY, ANY, make_ramp(0, 1));
        body_reaction(c, "pull", "right");
        c->until = 1;
        c->continuum.steps = 4;
        sn_run_summary summary;
        sn_record *r = body_run(c, NULL, &summary);
        force[k] = last_value(r, "pull_fx");
        assert_true((summary.dissipated_J != 0) == (k == 2));
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
    CHECK_REL(force[1], force[0], 1e-8); // Newton's tolerance
    assert_true(force[2] > 1.05 * force[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volume_relaxes_alone),
        cmocka_unit_test(shape_relaxes_alone),
        cmocka_unit_test(parts_relax_each),
        cmocka_unit_test(equal_branches_are_one_memory),
        cmocka_unit_test(rotation_leaves_the_stress),
        cmocka_unit_test(parts_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
