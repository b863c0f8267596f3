// Families of fibres on a central net: springs of cells beside the springs of edges.
// SPDX-License-Identifier: Apache-2.0
#include "nets.h"
#include "parted.h"

static const double size[3] = {0.03, 0.02, 0.025};
static const int cells[3] = {3, 2, 2};

static sn_case *distorted(const sn_tissue *t, sn_rung rung, bool volume) {
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, t);
    jitter(c, 0.2, 21);
    c->fibre[0] = 0.48;
    c->fibre[1] = 0.6;
    c->fibre[2] = 0.64;
    c->springs.rung = rung;
    c->springs.volume = volume;
    return c;
}

// what is at work at node i of the mesh, of a random place
static double *forces_of(const sn_case *c, sn_precision precision, sn_memory_mode mode) {
    sn_net *net;
    sn_scratch scratch = {0};
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_scratch_create(net, precision, &scratch));
    const size_t numbers = (size_t)net->nodes * 4;
    double *f = sn_alloc(numbers, sizeof *f);
    void *u = sn_alloc(numbers, sizeof(double)), *store = sn_alloc(net->store_size, sizeof(double));
    sn_factors *factors = sn_alloc(1, sizeof *factors);
    sn_net_factors(net, 0.2, factors);
    for (int turn = 1; turn <= 2; turn++) { // the second from where the first came
        uint64_t seed = 5;
        for (int i = 0; i < net->nodes; i++)
            for (size_t d = 0; d < 3; d++)
                sn_real_put(precision, u, 4 * (size_t)net->node_place[i] + d,
                            0.0007 * turn * check_random(&seed, -1, 1));
        const sn_force_call call = {.precision = precision,
                                    .mode = mode,
                                    .u = u,
                                    .factors = factors,
                                    .store = store,
                                    .out = &scratch};
        sn_net_forces(net, &call);
    }
    for (int i = 0; i < net->nodes; i++)
        for (size_t d = 0; d < 3; d++)
            f[4 * (size_t)i + d] =
                sn_real_at(precision, scratch.f, 4 * (size_t)net->node_place[i] + d);
    sn_free(u);
    sn_free(store);
    sn_free(factors);
    sn_scratch_destroy(&scratch);
    sn_net_destroy(net);
    return f;
}

// Forces with fibres less those without, on the central rung, are those on the coupled one: with
// memory (of the fibres' own) and without, in both precisions, with and without volume.
static void fibre_forces_are_those_of_coupled_cells(void **state) {
    (void)state;
    for (int k = 0; k < 16; k++) {
        double *f[2][2], worst = 0, most = 0;
        const bool branched = k / 8;
        int count = 0;
        for (int n = 0; n < 4; n++) {
            sn_tissue t = artery(n % 2 ? 1900 : 0, 0.1, 0.5, 9e3);
            if (branched) part_memories(&t);
            if (!branched) t.memory = prony(0.3, 0.05, 0.2, 0.4);
            sn_case *c = distorted(&t, n / 2 ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED, k / 4 % 2);
            c->springs.precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
            // one band of times for both rungs
            c->springs.step = 1e-5;
            f[n / 2][n % 2] =
                forces_of(c, c->springs.precision, k / 2 % 2 ? SN_MEMORY_ADVANCE : SN_MEMORY_OFF);
            count = 4 * c->mesh->node_count;
            sn_case_destroy(c);
        }
        for (int i = 0; i < count; i++) {
            const double fibres = f[0][1][i] - f[0][0][i];
            most = fmax(most, fabs(fibres));
            worst = fmax(worst, fabs(f[1][1][i] - f[1][0][i] - fibres));
        }
        assert_true(most > 0.01); // newtons
        // rounding of the whole forces, of which the fibres are a tenth or more
        CHECK_ABS(worst / most, 0, k % 2 ? 1e-5 : 1e-12);
        for (int n = 0; n < 4; n++) sn_free(f[n / 2][n % 2]);
    }
}

//---- small strain --------------------------------------------------------------------------------

// One family along x, so that a strain eps with the sides held has e = 4/3 eps and the stress
// 2 families k1 e 4/3 = 32/9 k1 eps along it; across, -2/3 eps, and they are slack.
static sn_tissue aligned(double k1, double bulk) {
    sn_tissue t = artery(k1, 0.1, 0.5, bulk);
    CHECK_OK(sn_tissue_set(&t, "kappa", 0));
    CHECK_OK(sn_tissue_set(&t, "angle", 0));
    return t;
}

static void moduli_at_small_strain(void **state) {
    (void)state;
    const double eps = 1e-5, mu = 1300, bulk = 9e3, k1 = 4e3;
    for (int k = 0; k < 8; k++) {
        const bool across = k % 2, pushed = k / 2 % 2, volume = k / 4;
        sn_tissue t = aligned(k1, bulk);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        c->fibre[across ? 1 : 0] = 1;
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.volume = volume;
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        add_support(c, "boundary", "yz");
        add_support(c, "left", "x");
        sn_load *l =
            add_load(c, SN_LOAD_DISPLACEMENT, "right", (pushed ? -eps : eps) * size[0], 0, 0, 1);
        l->free[1] = l->free[2] = true;
        add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        const double area = size[1] * size[2];
        const double got = last_value(r, "pull_fx") / area / (pushed ? -eps : eps);
        double expected = volume ? bulk + 4.0 / 3 * mu : 3 * mu;
        if (!across && !pushed) expected += 32.0 / 9 * k1;
        if (across && pushed) expected += 8.0 / 9 * k1; // e = 2/3 eps, 2 k1 e 2/3
        CHECK_REL(got, expected, 1e-3); // strains of 1e-5 bend laws by a few times that
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

//---- the step ------------------------------------------------------------------------------------

static void kick(const sn_net *net, sn_state *s, double speed) {
    uint64_t seed = 9;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            if (!(net->fixed_bits[i] >> d & 1))
                ((double *)s->v)[4 * i + d] = speed * check_random(&seed, -1, 1);
}

// The body strained along its fibres so that all carry.
static double taut_eigenvalue(const sn_net *net, double strain) {
    const double *a = net->axes;
    double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            for (int e = 0; e < 3; e++)
                u[4 * i + d] += strain * a[d] * a[e] * net->node_position[3 * i + e];
    const double value = highest_eigenvalue(net, u, 3000);
    sn_free(u);
    return value;
}

// A kicked body, whose fibres now carry and now not, swings no wider in the last 10,000 steps than
// in the first, without any damping; the step is the shorter for fibres, as waves along them are
// faster.
static void step_knows_fibres(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        static const sn_rung rungs[] = {SN_RUNG_CENTRAL, SN_RUNG_CENTRAL, SN_RUNG_CENTRAL,
                                        SN_RUNG_CENTRAL, SN_RUNG_COUPLED, SN_RUNG_SMOOTHED};
        double step[2], most[2] = {0};
        for (int fibres = 0; fibres < 2; fibres++) {
            sn_tissue t = aligned(fibres ? 2e4 : 0, 9e3);
            sn_case *c = make_block(size, cells, k % 2 ? SN_PATTERN_BCC : SN_PATTERN_MIRRORED, &t);
            c->fibre[0] = 0.6, c->fibre[1] = 0.8;
            c->springs.rung = rungs[k];
            c->springs.volume = k / 2 > 0;
            add_support(c, "left", "xyz");
            sn_net *net;
            sn_state *s;
            CHECK_OK(sn_net_create(c, &net));
            CHECK_OK(sn_state_create(net, &s));
            step[fibres] = net->step;
            // strain 1e-4 of a law that bends by about ten times that; the search settles to 2e-3
            if (fibres) CHECK_REL(net->omega2, taut_eigenvalue(net, 1e-4), 1e-2);
            kick(net, s, 0.02);
            for (int n = 0; n < 20000 * fibres; n++) {
                sn_state_step(net, s, 1);
                for (int i = 0; i < 4 * net->nodes; i += 5)
                    most[n >= 10000] = fmax(most[n >= 10000], fabs(((double *)s->u)[i]));
            }
            assert_false(s->broken);
            sn_state_destroy(s);
            sn_net_destroy(net);
            sn_case_destroy(c);
        }
        assert_true(step[1] < 0.8 * step[0]);
        assert_true(most[1] < 1.5 * most[0]);
    }
}

// Period of longitudinal vibration of a bar whose fibres are held taut: 4 L / c, c of the modulus
// along them.
static void waves_run_along_fibres(void **state) {
    (void)state;
    const double length = 0.1, eps = 1e-3, mu = 1300, bulk = 9e3, k1 = 2e4;
    sn_tissue t = aligned(k1, bulk);
    CHECK_OK(sn_tissue_set(&t, "k2", 0));
    sn_case *c = make_block((const double[]){length, 0.0125, 0.0125}, (const int[]){16, 2, 2},
                            SN_PATTERN_MIRRORED, &t);
    c->fibre[0] = 1;
    c->springs.rung = SN_RUNG_CENTRAL;
    add_support(c, "boundary", "yz");
    add_support(c, "left", "x");
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    // pulled by the stress of the strain eps, in place; then in its first mode, a tenth of it
    sn_history *whole;
    CHECK_OK(sn_history_create(1, 2, (double[]){0, 1}, (double[]){1, 1}, &whole));
    const double modulus = bulk + 4.0 / 3 * mu + 32.0 / 9 * k1;
    sn_load *l = add_load(c, SN_LOAD_TRACTION, "right", modulus * eps, 0, 0, 0);
    l->factor = whole;
    sn_net_destroy(net);
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    int tip = 0;
    for (int i = 0; i < net->nodes; i++) {
        const double x = net->node_position[3 * i];
        ((double *)s->u)[4 * i] = eps * x + 0.1 * eps * length * sin(acos(-1) / 2 * x / length);
        if (x > 0.999 * length) tip = i;
    }
    double crossed[5] = {0}, mean = 0, before = 1, since = 0, low = INFINITY, high = -INFINITY;
    for (int pass = 0; pass < 2; pass++) { // where it swings about, then when it passes there
        const double end = s->time + 4 * 4 * length / sqrt(modulus / 1000);
        for (int k = 0; s->time < end && k < 5;) {
            sn_state_step(net, s, 0.3 * net->step);
            double now = ((double *)s->u)[4 * tip] - mean;
            low = fmin(low, now);
            high = fmax(high, now);
            if (pass == 1 && now * before < 0)
                crossed[k++] = since + (s->time - since) * before / (before - now);
            before = now;
            since = s->time;
        }
        if (pass == 0) mean = 0.5 * (low + high);
        before = 0;
    }
    CHECK_REL(mean, eps * length, 5e-3);
    CHECK_REL((crossed[4] - crossed[0]) / 2, 4 * length / sqrt(modulus / 1000), 5e-3);
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

//---- refusals ------------------------------------------------------------------------------------

static void one_energy_is_refused(void **state) {
    (void)state;
    sn_tissue t = guccione(1e3, 3e4);
    sn_net *net;
    sn_case *c = distorted(&t, SN_RUNG_CENTRAL, true);
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED,
                "law guccione has fibres and matrix in one energy");
    assert_null(net);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fibre_forces_are_those_of_coupled_cells),
        cmocka_unit_test(moduli_at_small_strain),
        cmocka_unit_test(step_knows_fibres),
        cmocka_unit_test(waves_run_along_fibres),
        cmocka_unit_test(one_energy_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
