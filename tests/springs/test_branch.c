// A memory for each part of the stress: motions that show one part, equal memories against one,
// known motions against quadrature, tangents, rotation, energies, bytes.
// SPDX-License-Identifier: Apache-2.0
#include "base/isa.h"
#include "nets.h"
#include "parted.h"

static const double size[3] = {0.03, 0.02, 0.02};
static const int cells[3] = {3, 2, 2};
static const double cube_size[3] = {0.01, 0.01, 0.01};

static sn_case *cube(const sn_tissue *t, sn_rung rung, bool volume) {
    sn_case *c = make_block(cube_size, (const int[]){1, 1, 1}, SN_PATTERN_MIRRORED, t);
    c->fibre[0] = t->law->fibres ? 1 : 0;
    c->springs.rung = rung;
    c->springs.volume = volume;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->springs.memory_tolerance = 1e-6;
    return c;
}

static void move(sn_case *c, const char *surface, const double way[3], const bool free[3]) {
    sn_load *l = add_load(c, SN_LOAD_DISPLACEMENT, surface, way[0], way[1], way[2], 0);
    memcpy(l->free, free, sizeof l->free);
}

// F = diag(stretch): all nodes led
static void lead(sn_case *c, const double stretch[3]) {
    static const char *const fixed[] = {"left", "front", "bottom"};
    static const char *const moved[] = {"right", "back", "top"};
    static const char *const axis[] = {"x", "y", "z"};
    for (int d = 0; d < 3; d++) {
        double way[3] = {0};
        bool free[3] = {true, true, true};
        way[d] = (stretch[d] - 1) * cube_size[d];
        free[d] = false;
        add_support(c, fixed[d], axis[d]);
        move(c, moved[d], way, free);
    }
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
}

//---- one part at a time --------------------------------------------------------------------------

static void relax(sn_case *c, const double weight[SN_PARTS]) {
    sn_run_summary summary;
    c->until = 20;
    c->output_every = 1;
    sn_record *r = run_case(c, &summary);
    assert_true(summary.converged);
    check_relaxation(r, c->tissue, weight);
    sn_record_destroy(r);
}

// Blown up by 8 %: nothing but pressure.
static void volume_relaxes_alone(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 6e3);
    part_memories(&t);
    for (int k = 0; k < 4; k++) {
        sn_case *c = cube(&t, k / 2 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED, k % 2);
        lead(c, (const double[]){1.08, 1.08, 1.08});
        relax(c, (const double[]){0, 1, 0});
        sn_case_destroy(c);
    }
}

// Simple shear of 0.4 by the corners: J = 1, nothing but S_d, and springs.
static void shape_relaxes_alone(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 6e3);
    part_memories(&t);
    for (int k = 0; k < 5; k++) {
        const sn_rung rung = k < 2 ? SN_RUNG_COUPLED : k < 4 ? SN_RUNG_SMOOTHED : SN_RUNG_CENTRAL;
        sn_case *c = cube(&t, rung, k % 2);
        add_support(c, "bottom", "xyz");
        move(c, "top", (const double[]){0.004, 0, 0}, (const bool[]){false, false, false});
        add_probe(c, "pull", SN_PROBE_REACTION, "top", 0, 0, 0);
        relax(c, (const double[]){1, 0, 0});
        sn_case_destroy(c);
    }
}

// the pull at once
static double first_pull(const sn_tissue *t, sn_rung rung, bool volume, const double stretch[3]) {
    sn_case *c = cube(t, rung, volume);
    lead(c, stretch);
    c->until = c->output_every = 1e-3;
    sn_run_summary summary;
    sn_record *r = run_case(c, &summary);
    double pull = sn_record_values(r, "pull_fx")[0];
    sn_record_destroy(r);
    sn_case_destroy(c);
    return pull;
}

// Stretched along the first axis with the sides held: all parts at once. Their shares: where cells
// have a law, from the law; on a central net
// from nets without fibres, and without volume.
static void parts_relax_each(void **state) {
    (void)state;
    const double L = 1.15, stretch[3] = {L, 1, 1}, bulk = 9e3;
    for (int n = 0; n < 6; n++) {
        const sn_rung rung = n < 2 ? SN_RUNG_COUPLED : n < 4 ? SN_RUNG_SMOOTHED : SN_RUNG_CENTRAL;
        sn_tissue t = artery(1900, 0.1, 0.5, bulk), bare = artery(0, 0.1, 0.5, bulk);
        double share[SN_PARTS], sum = 0;
        part_stresses(&t, L, share);
        if (rung == SN_RUNG_CENTRAL) {
            const double net = first_pull(&bare, rung, n % 2, stretch);
            share[SN_PART_DEVIATORIC] = first_pull(&bare, rung, false, stretch);
            share[SN_PART_VOLUMETRIC] = net - share[SN_PART_DEVIATORIC];
            // the fibres are those of cells
            CHECK_REL(first_pull(&t, rung, n % 2, stretch) - net,
                      share[SN_PART_FIBRE] * L * cube_size[1] * cube_size[2], 1e-9);
            share[SN_PART_FIBRE] = first_pull(&t, rung, n % 2, stretch) - net;
        }
        for (int k = 0; k < SN_PARTS; k++) sum += share[k];
        for (int k = 0; k < SN_PARTS; k++) share[k] /= sum;
        assert_true(share[0] > 0.1 && share[2] > 0.1);
        assert_true(share[1] > 0.1 || (n == 4 && fabs(share[1]) < 1e-9));
        part_memories(&t);
        sn_case *c = cube(&t, rung, n % 2);
        lead(c, stretch);
        relax(c, share);
        sn_case_destroy(c);
    }
}

//---- known motions -------------------------------------------------------------------------------

static const double corner_time[] = {0, 0.2, 0.5, 0.6, 0.8, 1.0};
static const double corner_value[] = {0, 1, 1, 0.3, 1, 0};

// S_m, S_f along the first axis and U' of the leading motion of level a
static void parts_at(const sn_tissue *t, double a, double T[SN_PARTS]) {
    const double L = 1 + 0.15 * a;
    part_stresses(t, L, T);
    T[SN_PART_VOLUMETRIC] = sn_tissue_value(t, "bulk_modulus") * (L - 1);
}

// force on the right side: L (H_d[S_m] + H_f[S_f]) + H_v[U'], by brute force
static double hereditary(const sn_tissue *t, const sn_history *factor, double time) {
    enum { STEPS = 2000 };
    double sum[SN_PARTS] = {0}, before[SN_PARTS], now[SN_PARTS], a;
    parts_at(t, 0, before);
    for (int i = 0; i < STEPS; i++) {
        sn_history_at(factor, time * (i + 1) / STEPS, &a);
        parts_at(t, a, now);
        for (int k = 0; k < SN_PARTS; k++) {
            sum[k] += sn_memory_relaxation(sn_tissue_memory(t, (sn_part)k),
                                           time * (STEPS - i - 0.5) / STEPS) *
                      (now[k] - before[k]);
            before[k] = now[k];
        }
    }
    return ((1 + 0.15 * a) * (sum[0] + sum[2]) + sum[1]) * cube_size[1] * cube_size[2];
}

// Ramp, hold and cycles of an element whose nodes are all led, by every integrator.
static void known_motion_follows_the_quadrature(void **state) {
    (void)state;
    sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
    part_memories(&t);
    for (int k = 0; k < 4; k++) {
        sn_case *c = cube(&t, k == 3 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED, k == 1);
        lead(c, (const double[]){1.15, 1, 1});
        sn_history *factor = NULL;
        CHECK_OK(sn_history_create(1, 6, corner_time, corner_value, &factor));
        c->load[0].factor = factor;
        c->springs.integrator = k < 2    ? SN_INTEGRATOR_EXPLICIT
                                : k == 2 ? SN_INTEGRATOR_IMPLICIT
                                         : SN_INTEGRATOR_QUASI_STATIC;
        c->springs.step = 2e-3;
        c->output_every = 0.05;
        c->springs.memory_tolerance = 1e-5;
        // light, so that the sudden starts and stops of the nodes give no force
        c->tissue[0].density = k < 2 ? 1000 : 1e-3;
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        assert_true(k < 2 || net->step <= 2e-3);
        sn_net_destroy(net);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        const double *time = sn_record_values(r, "time"), *f = sn_record_values(r, "pull_fx");
        double most = 0, worst = 0;
        for (int i = 1; i < r->rows; i++) {
            double expected = hereditary(&t, factor, time[i]);
            most = fmax(most, fabs(expected));
            if (i % 2) worst = fmax(worst, fabs(f[i] - expected)); // between the corners
        }
        // second order in the step, 1/100 of the shortest ramp, and in the quadrature's; memories
        // to 1e-5
        CHECK_ABS(worst / most, 0, 1e-4);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

//---- equal memories ------------------------------------------------------------------------------

static sn_case *bent(const sn_tissue *t, sn_rung rung, bool volume) {
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, t);
    if (t->law->fibres) c->fibre[0] = 0.8, c->fibre[1] = 0.6;
    c->springs.rung = rung;
    c->springs.volume = volume;
    add_support(c, "left", "xyz");
    add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.004, 0.002, 0.001, 0.1);
    add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
    add_probe(c, "tip", SN_PROBE_POINT, "", 0.015, 0.01, 0.02);
    c->until = 0.2;
    c->output_every = 0.05;
    return c;
}

// One memory for all, kept apart and not: every rung, with and without volume, every integrator.
static void equal_branches_are_one_memory(void **state) {
    (void)state;
    static const char *const column[] = {"pull_fx", "pull_fy", "pull_fz",
                                         "tip_ux",  "tip_uy",  "tip_uz"};
    for (int k = 0; k < 18; k++) {
        sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
        equal_memories(&t);
        sn_record *r[2];
        sn_run_summary s[2];
        for (int one = 0; one < 2; one++) {
            t.branched = !one;
            sn_case *c = bent(&t, (sn_rung)(k % 3), k / 3 % 2);
            c->springs.integrator = (sn_integrator)(k / 6);
            if (c->springs.integrator != SN_INTEGRATOR_QUASI_STATIC)
                c->springs.stiffness_damping = 1e-4;
            c->springs.step = 1e-3; // one for both
            r[one] = run_case(c, &s[one]);
            assert_true(s[one].converged);
            sn_case_destroy(c);
        }
        assert_int_equal(r[0]->rows, r[1]->rows);
        for (int j = 0; j < 6; j++) {
            const double *a = sn_record_values(r[0], column[j]);
            const double *b = sn_record_values(r[1], column[j]);
            // rounding, in some hundred steps or what Newton's tolerance lets through
            double most = 0, worst = 0;
            for (int i = 1; i < r[0]->rows; i++) {
                most = fmax(most, fabs(a[i]));
                worst = fmax(worst, fabs(a[i] - b[i]));
            }
            assert_true(most > (j < 3 ? 0.01 : 2e-5));
            CHECK_ABS(worst / most, 0, 1e-11);
        }
        CHECK_REL(s[0].elastic_J, s[1].elastic_J, 1e-11);
        CHECK_REL(s[0].external_work_J, s[1].external_work_J, 1e-11);
        assert_int_equal(s[0].memory_terms, s[1].memory_terms);
        for (int one = 0; one < 2; one++) sn_record_destroy(r[one]);
    }
}

//---- tangent, rotation ---------------------------------------------------------------------------

static double *motion_of(const sn_net *net, double amount, uint64_t seed) {
    double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) u[4 * i + d] = amount * 0.01 * check_random(&seed, -1, 1);
    return u;
}

// The tangent of a step under way, all parts with a factor and a history of their own.
static void tangents_are_force_slopes(void **state) {
    (void)state;
    for (int k = 0; k < 6; k++) {
        sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
        part_memories(&t);
        sn_case *c = bent(&t, (sn_rung)(k % 3), k / 3);
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        sn_net *net;
        sn_tangent *tangent;
        sn_scratch scratch = {0};
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_tangent_create(net, &tangent));
        CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
        const int n = net->nodes;
        double *store = sn_alloc(net->store_size, sizeof *store);
        double *history = sn_alloc(net->store_size, sizeof *history);
        double *u = motion_of(net, 0.1, 15), *v = motion_of(net, 0.1, 16);
        sn_factors *factors = sn_alloc(1, sizeof *factors);
        sn_net_factors(net, 0.3, factors);
        sn_force_call call = {.precision = SN_DOUBLE,
                              .mode = SN_MEMORY_ADVANCE,
                              .u = u,
                              .factors = factors,
                              .store = store,
                              .history = history,
                              .out = &scratch};
        sn_net_forces(net, &call); // a step before
        sn_net_factors(net, 0.1, factors);
        sn_net_history(net, factors, store, history);
        for (int i = 0; i < 4 * n; i++) u[i] *= 0.6;
        call.mode = SN_MEMORY_TRIAL;
        sn_net_forces(net, &call);
        sn_tangent_assemble(
            net, tangent,
            &(sn_tangent_call){
                .u = u, .factors = factors, .history = history, .pressure = scratch.pressure});
        double *x = sn_alloc((size_t)n * 3, sizeof *x), *y = sn_alloc((size_t)n * 3, sizeof *y);
        double *slope = sn_alloc((size_t)n * 3, sizeof *slope), worst = 0, scale = 0;
        const double h = 1e-4;
        for (int i = 0; i < 3 * n; i++) x[i] = v[4 * (i / 3) + i % 3];
        sn_tangent_multiply(net, tangent, x, y);
        for (int side = 1; side >= -1; side -= 2) {
            for (int i = 0; i < 4 * n; i++) u[i] += side * h * v[i];
            sn_net_forces(net, &call);
            for (int i = 0; i < 3 * n; i++)
                slope[i] += side * ((double *)scratch.f)[4 * (i / 3) + i % 3] / (2 * h);
            for (int i = 0; i < 4 * n; i++) u[i] -= side * h * v[i];
        }
        for (int i = 0; i < 3 * n; i++) {
            worst = fmax(worst, fabs(y[i] + slope[i]));
            scale = fmax(scale, fabs(y[i]));
        }
        // 1e-5 of an edge: truncation 1e-10 times a few 100, rounding 1e-11; fibres that begin to
        // carry between the two places bend, as springs do, by 1e-5 of a part of the cells
        CHECK_ABS(worst / scale, 0, 1e-6);
        double *const all[] = {store, history, u, v, x, y, slope};
        for (int i = 0; i < 7; i++) sn_free(all[i]);
        sn_free(factors);
        sn_scratch_destroy(&scratch);
        sn_tangent_destroy(tangent);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A body of parts that all flow is strained and relaxes to nothing, each part in its own time. Then
// it is turned at once: no force comes of that.
static void rotation_of_a_relaxed_body_gives_no_force(void **state) {
    (void)state;
    const sn_memory_law *maxwell = sn_memory_law_find("maxwell");
    for (int k = 0; k < 6; k++) {
        sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
        t.branched = true;
        t.memory = (sn_memory){.law = maxwell, .value = {0.02}};
        t.volumetric = (sn_memory){.law = maxwell, .value = {0.05}};
        t.fibre = (sn_memory){.law = maxwell, .value = {0.01}};
        sn_case *c = bent(&t, (sn_rung)(k % 3), k / 3);
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        double *u = motion_of(net, 0.15, 4), R[9], first, relaxed, turned;
        memcpy(s->u, u, (size_t)net->nodes * 4 * sizeof *u);
        first = advance(net, s, 1e-6);
        for (int n = 0; n < 40; n++) relaxed = advance(net, s, 0.05);
        sn_rotation((const double[]){0.3, -0.4, 0.2}, R);
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++) {
                const double *x = net->node_position + 3 * i;
                double y = -x[d];
                for (int j = 0; j < 3; j++) y += R[3 * d + j] * (x[j] + u[4 * i + j]);
                ((double *)s->u)[4 * i + d] = y;
            }
        turned = advance(net, s, 1e-6);
        CHECK_ABS(relaxed / first, 0, 1e-12);
        CHECK_ABS(turned / first, 0, 1e-12); // rounding of displacements of the size of the body
        // not vacuous: a strain does
        for (int i = 0; i < 4 * net->nodes; i++) ((double *)s->u)[i] *= 1.01;
        assert_true(advance(net, s, 1e-6) > 1e-3 * first);
        sn_free(u);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

//---- energy --------------------------------------------------------------------------------------

// The ledger of a body in motion with all parts; what is lost does not fall.
static void ledger_closes(void **state) {
    (void)state;
    for (int k = 0; k < 12; k++) {
        sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
        part_memories(&t);
        sn_case *c = bent(&t, (sn_rung)(k % 3), k / 3 % 2);
        c->springs.integrator = k < 6 ? SN_INTEGRATOR_EXPLICIT : SN_INTEGRATOR_QUASI_STATIC;
        sn_history_destroy(c->load[0].factor);
        CHECK_OK(sn_history_create(1, 4, (double[]){0, 0.4, 0.6, 1}, (double[]){0, 1, 1, -0.5},
                                   &c->load[0].factor));
        c->output_every = 0.02;
        c->until = 1;
        sn_record *energy, *r;
        sn_run_summary s;
        CHECK_OK(sn_record_create("energy", &energy));
        CHECK_OK(sn_record_create("run", &r));
        CHECK_OK(sn_springs_run(c, &(sn_output){.energy = energy}, &s, r));
        const double *lost = sn_record_values(energy, "dissipated_energy");
        const double *held = sn_record_values(energy, "memory_energy");
        assert_true(s.converged && s.memory_J > 0 && s.dissipated_J > 0);
        CHECK_ABS(s.energy_residual, 0, 0.01); // (h omega)^2 of the modes that carry energy
        double fall = 0;
        for (int n = 1; n < energy->rows; n++) {
            assert_true(held[n] >= 0);
            fall = fmax(fall, lost[n - 1] - lost[n]);
        }
        // the trapezoidal rule of the work, and that what branches of cells hold is an estimate
        CHECK_ABS(fall / s.dissipated_J, 0, 5e-3);
        sn_record_destroy(energy);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// What the branches of cells and of smoothed edges hold under one uniform strain is the same, with
// one memory and with parts.
static void cells_and_edges_hold_the_same(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_run_summary s[2];
        for (int smoothed = 0; smoothed < 2; smoothed++) {
            sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
            t.memory = prony(0.3, 0.25, 0.2, 3.0);
            if (k % 2) part_memories(&t);
            sn_case *c = cube(&t, smoothed ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED, k / 2);
            lead(c, (const double[]){1.15, 1.02, 0.95});
            sn_record_destroy(run_case(c, &s[smoothed]));
            sn_case_destroy(c);
        }
        assert_true(s[0].memory_J > 0);
        CHECK_REL(s[1].memory_J, s[0].memory_J, 1e-10);
        CHECK_REL(s[1].elastic_J, s[0].elastic_J, 1e-10);
    }
}

//---- states --------------------------------------------------------------------------------------

static void steps(const sn_net *net, sn_state *s, int count) {
    for (int n = 0; n < count; n++) sn_state_step(net, s, 1);
    assert_false(s->broken);
}

static double force_difference(const sn_net *net, const sn_state *a, const sn_state *b) {
    double worst = 0, most = 0;
    for (size_t i = 0; i < 4 * (size_t)net->nodes; i++) {
        const double x = sn_real_at(a->precision, a->now.f, i);
        const double y = sn_real_at(b->precision, b->now.f, i);
        most = fmax(most, fabs(x));
        worst = fmax(worst, fabs(x - y));
    }
    return worst / most;
}

// Bytes bring all parts back, all instruction sets and numbers of threads give the same bits, and
// another net takes over what it can.
static void states_carry_all_parts(void **state) {
    (void)state;
    for (int k = 0; k < 12; k++) {
        sn_tissue t = artery(1900, 0.1, 0.5, 9e3);
        part_memories(&t);
        sn_case *c = bent(&t, (sn_rung)(k % 3), k / 3 % 2);
        c->springs.precision = k < 6 ? SN_DOUBLE : SN_SINGLE;
        sn_net *net, *two, *other;
        sn_state *a, *b;
        CHECK_OK(sn_net_create(c, &net));
        c->springs.threads = 2;
        CHECK_OK(sn_net_create(c, &two));
        CHECK_OK(sn_state_create(net, &a));
        steps(net, a, 30);
        const size_t bytes = sn_state_size(net, a);
        unsigned char *middle = malloc(bytes), *later = malloc(bytes), *again = malloc(bytes);
        sn_state_save(net, a, middle);
        steps(net, a, 30);
        sn_state_save(net, a, later);
        for (int isa = 0; isa < SN_ISA_COUNT; isa++) {
            if (!sn_isa_available(isa)) continue;
            two->isa = isa;
            CHECK_OK(sn_state_create(two, &b));
            steps(two, b, 60);
            sn_state_save(net, b, again);
            assert_memory_equal(again, later, bytes);
            sn_state_destroy(b);
        }
        CHECK_OK(sn_state_create(net, &b));
        CHECK_OK(sn_state_load(net, b, middle, bytes));
        steps(net, b, 30);
        sn_state_save(net, b, again);
        assert_memory_equal(again, later, bytes);

        CHECK_OK(sn_state_move(two, net, b)); // the same constants: nothing changes
        CHECK_ABS(force_difference(net, a, b), 0, k < 6 ? 1e-9 : 1e-5);
        c->tissue[0].branched = false; // memory begins anew
        CHECK_OK(sn_net_create(c, &other));
        CHECK_OK(sn_state_move(net, other, b));
        assert_true(force_difference(net, a, b) > 1e-3);
        steps(other, b, 30);
        CHECK_FAILS(sn_state_load(other, b, middle, bytes), SN_E_DEFINITION, "another net");
        free(middle);
        free(later);
        free(again);
        sn_state_destroy(a);
        sn_state_destroy(b);
        sn_net_destroy(net);
        sn_net_destroy(two);
        sn_net_destroy(other);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(volume_relaxes_alone),
        cmocka_unit_test(shape_relaxes_alone),
        cmocka_unit_test(parts_relax_each),
        cmocka_unit_test(known_motion_follows_the_quadrature),
        cmocka_unit_test(equal_branches_are_one_memory),
        cmocka_unit_test(tangents_are_force_slopes),
        cmocka_unit_test(rotation_of_a_relaxed_body_gives_no_force),
        cmocka_unit_test(ledger_closes),
        cmocka_unit_test(cells_and_edges_hold_the_same),
        cmocka_unit_test(states_carry_all_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
