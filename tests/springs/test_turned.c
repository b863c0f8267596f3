// Material axes that differ from cell to cell against equal ones, and whole runs with them.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "listed.h"
#include "springs/forces.h"

static const double size[3] = {0.03, 0.02, 0.025};
static const int cells[3] = {3, 2, 2};

static sn_tissue artery(void) {
    static const char *const name[] = {"mu", "k1", "k2", "kappa", "angle", "bulk_modulus"};
    const double value[] = {2e3, 3e3, 2, 0.1, 0.5, 3e4};
    sn_tissue t = make_tissue("hgo");
    for (int k = 0; k < 6; k++) CHECK_OK(sn_tissue_set(&t, name[k], value[k]));
    return t;
}

static sn_case *body(const sn_tissue *t, sn_rung rung, bool volume) {
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, t);
    jitter(c, 0.2, 41);
    c->fibre[0] = 0.6;
    c->fibre[2] = 0.8;
    c->fibres.sheet[1] = 1;
    c->springs.rung = rung;
    c->springs.volume = volume;
    return c;
}

static double *forces_at(const sn_net *net, sn_precision precision, const void *u) {
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, precision, &scratch));
    sn_net_forces(net, &(sn_force_call){
                           .precision = precision, .mode = SN_MEMORY_OFF, .u = u, .out = &scratch});
    double *f = sn_alloc((size_t)net->nodes * 4, sizeof *f);
    for (size_t k = 0; k < (size_t)net->nodes * 4; k++)
        f[k] = k % 4 == 3 ? 0 : sn_real_at(precision, scratch.f, k);
    sn_scratch_destroy(&scratch);
    return f;
}

// Rounding of two ways to the same stress: 1e-16 (6e-8) times stiffness over stress, about 10, and
// some tens of operations; 50 times more where bulk weighs over shear.
static void equal_axes_are_one(void **state) {
    (void)state;
    sn_tissue t = artery();
    for (int k = 0; k < 8; k++) {
        const sn_precision precision = k & 4 ? SN_SINGLE : SN_DOUBLE;
        const double rounding = k & 4 ? 2e-4 : 1e-12;
        sn_case *c = body(&t, k & 1 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED, k & 2);
        c->springs.precision = precision;
        sn_net *one, *all;
        CHECK_OK(sn_net_create(c, &one));
        list_alike(c);
        CHECK_OK(sn_net_create(c, &all));
        assert_true(one->rotated && !one->data[precision].turn);
        assert_true(!all->rotated && all->data[precision].turn);
        assert_true(one->fingerprint != all->fingerprint);
        uint64_t seed = 7;
        double u[4 * 200] = {0}, worst = 0, scale = 0;
        float single[4 * 200] = {0};
        assert_true(one->nodes <= 200);
        for (int i = 0; i < 4 * one->nodes; i++) {
            u[i] = i % 4 == 3 ? 0 : check_random(&seed, -0.002, 0.002);
            single[i] = (float)u[i];
        }
        const void *at = k & 4 ? (const void *)single : u;
        double *f = forces_at(one, precision, at), *g = forces_at(all, precision, at);
        for (int i = 0; i < 4 * one->nodes; i++) {
            worst = fmax(worst, fabs(f[i] - g[i]));
            scale = fmax(scale, fabs(f[i]));
        }
        assert_true(scale > 0.01);
        assert_true(worst > 0); // by another way
        CHECK_ABS(worst / scale, 0, rounding);
        sn_free(f);
        sn_free(g);
        sn_net_destroy(one);
        sn_net_destroy(all);
        sn_case_destroy(c);
    }
}

// Axes that are listed but all the same are one direction: the same bits.
static void alike_is_uniform(void **state) {
    (void)state;
    sn_tissue t = artery();
    sn_case *c = body(&t, SN_RUNG_COUPLED, true);
    sn_net *one, *all;
    CHECK_OK(sn_net_create(c, &one));
    list_alike(c);
    for (int k = 0; k < 6 * c->fibres.count; k++) c->fibres.listed[k] = c->fibres.listed[k % 6];
    CHECK_OK(sn_net_create(c, &all));
    assert_null(all->cell_axes);
    sn_net_destroy(one);
    sn_net_destroy(all);
    sn_case_destroy(c);
}

// A quasi-static run with memory, listed against one direction: tangent, memory, stress, energies.
// Both solve to 1e-10 of the reaction.
static void runs_agree(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_tissue t = artery();
        t.memory = prony(0.3, 0.1, 0.2, 0.7);
        sn_case *c = body(&t, k & 1 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED, k & 2);
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.004, 0.002, 0, 0.5);
        c->output_every = 0.5;
        frames *out = sn_alloc(2, sizeof *out);
        sn_run_summary summary[2];
        for (int n = 0; n < 2; n++) {
            sn_record *history;
            if (n == 1) list_alike(c);
            out[n].cells = c->mesh->cell_count;
            assert_true(out[n].cells <= 200);
            CHECK_OK(sn_record_create("run", &history));
            CHECK_OK(sn_springs_run(c, &(sn_output){.frame = keep_frame, .context = &out[n]},
                                    &summary[n], history));
            assert_true(summary[n].converged);
            sn_record_destroy(history);
        }
        check_alike(out, c);
        CHECK_REL(summary[1].elastic_J, summary[0].elastic_J, 1e-7);
        CHECK_REL(summary[1].dissipated_J, summary[0].dissipated_J, 1e-6);
        sn_free(out);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(equal_axes_are_one),
                                       cmocka_unit_test(alike_is_uniform),
                                       cmocka_unit_test(runs_agree)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
