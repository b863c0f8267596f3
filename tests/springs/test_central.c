// Central springs: constants of the lattices, the spring's law and memory.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "springs/moment.h"
#include "springs/steps.h"

// Cauchy-Born tensor of all springs of a net that lie between low and high, each counted by the
// part of its length inside: a period of the lattice. Over the volume of the box and mu.
static void lattice_tensor(const sn_net *net, const double low[3], const double high[3], double mu,
                           double C[3][3][3][3]) {
    const double *stiffness = net->data[SN_DOUBLE].stiffness;
    double volume = 1;
    memset(C, 0, 81 * sizeof(double));
    for (int d = 0; d < 3; d++) volume *= high[d] - low[d];
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        int block = s / SN_BLOCK, lane = s % SN_BLOCK;
        const int a = net->spring_end[block * 2 * SN_BLOCK + lane];
        const int b = net->spring_end[(block * 2 + 1) * SN_BLOCK + lane];
        double D[3], L2 = 0, weight = 1;
        for (int d = 0; d < 3; d++) {
            double x = net->node_position[3 * a + d], y = net->node_position[3 * b + d];
            D[d] = y - x;
            L2 += D[d] * D[d];
            double left = fmin(x, y), right = fmax(x, y), tiny = 1e-9;
            if (left < low[d] - tiny || right > high[d] + tiny) {
                // half-open box: what leaves through a side comes in at the other
                weight *= fmax(0, fmin(right, high[d]) - fmax(left, low[d])) / (right - left);
            } else if (right - left < tiny && (left < low[d] + tiny || right > high[d] - tiny)) {
                weight *= 0.5; // lies in a side, half of it belongs here
            }
        }
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                for (int k = 0; k < 3; k++)
                    for (int l = 0; l < 3; l++)
                        C[i][j][k][l] +=
                            weight * stiffness[s] * D[i] * D[j] * D[k] * D[l] / (L2 * volume * mu);
    }
}

static void lattices_are_isotropic(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        const double size[3] = {0.06, k == 2 ? 0.072 : 0.06, k == 2 ? 0.054 : 0.06};
        sn_case *c = make_block(size, (const int[]){6, 6, 6},
                                k == 1 ? SN_PATTERN_BCC : SN_PATTERN_MIRRORED, &t);
        c->springs.rung = SN_RUNG_CENTRAL;
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        double low[3], high[3], C[3][3][3][3], worst = 0;
        for (int d = 0; d < 3; d++) { // 2 x 2 x 2 inner cells, a period of the mirrored cut
            low[d] = size[d] / 3;
            high[d] = 2 * size[d] / 3;
        }
        lattice_tensor(net, low, high, 3e3, C);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                for (int m = 0; m < 3; m++)
                    for (int n = 0; n < 3; n++) {
                        // lambda = mu = 1
                        double expected =
                            (i == j) * (m == n) + (i == m) * (j == n) + (i == n) * (j == m);
                        worst = fmax(worst, fabs(C[i][j][m][n] - expected));
                    }
        CHECK_ABS(worst, 0, 1e-12); // rounding of sums of some 100 springs
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

static void cubic_constants_are_known(void **state) {
    (void)state;
    double axis[3], face[3], body;
    sn_shape_def def = {.shape = SN_SHAPE_BLOCK, .size = {0.2, 0.3, 0.1}, .cells = {4, 6, 2}};
    assert_true(sn_lattice_constants(&def, axis, face, &body));
    for (int d = 0; d < 3; d++) { // h = 0.05
        CHECK_REL(axis[d], 0.05 * 17 / 14, 1e-12);
        CHECK_REL(face[d], 0.05 * 11 / 7, 1e-12);
    }
    CHECK_REL(body, 0.05 * 9 / 14, 1e-12);
    def.pattern = SN_PATTERN_BCC;
    assert_true(sn_lattice_constants(&def, axis, face, &body));
    CHECK_REL(axis[1], 0.05, 1e-12);
    CHECK_REL(body, 0.05 * 1.5, 1e-12);
    def.size[0] = 0.21; // a stretched body-centred lattice cannot be isotropic
    assert_false(sn_lattice_constants(&def, axis, face, &body));
    def.pattern = SN_PATTERN_KUHN;
    assert_false(sn_lattice_constants(&def, axis, face, &body));
}

// Sum of volumes, whatever the mesh; and of k L^2, which is 15 mu V on the mean over directions
// where nothing relaxes, and a few per cent more on this mesh, whose scale is that of relaxed
// springs.
static void rule_of_cells_adds_up(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block((const double[]){0.03, 0.02, 0.02}, (const int[]){4, 3, 3},
                            SN_PATTERN_MIRRORED, &t);
    jitter(c, 0.2, 8);
    c->springs.rung = SN_RUNG_CENTRAL;
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    const double *k = net->data[SN_DOUBLE].stiffness, *inverse = net->data[SN_DOUBLE].inverse;
    double sum = 0;
    int springs = 0;
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        sum += k[s] / inverse[s];
        springs += k[s] > 0;
    }
    const double stiffer = sum / (15 * 3e3 * sn_mesh_volume(c->mesh));
    assert_true(stiffer > 1 && stiffer < 1.1);
    int *edges, count;
    CHECK_OK(sn_mesh_edges(c->mesh, &edges, &count));
    assert_int_equal(springs, count);
    assert_int_equal(sn_net_spring_count(net), count);
    sn_free(edges);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

// The fit: a linear spring law, stretched, must give back B near 0; an exponential one its own
// stress.
static void fit_reproduces_uniaxial_stress(void **state) {
    (void)state;
    double B, factor;
    sn_tissue t = neo_hookean(3e3, 3e6);
    CHECK_OK(sn_spring_fit(&t, &B, &factor));
    CHECK_REL(factor, 1, 0);
    assert_true(-4 < B && B < 0); // neo-Hookean stress bends down a little
    // a central net of one cubic cell size, incompressible by a stiff nodal volume, against its
    // tissue
    const double size[3] = {0.03, 0.03, 0.03};
    for (int k = 0; k < 3; k++) {
        sn_tissue tissue = k == 0 ? neo_hookean(3e3, 3e6) : demiray(2e3, 6, 2e6);
        if (k == 2) {
            tissue = make_tissue("exponential");
            CHECK_OK(sn_tissue_set(&tissue, "B", 10));
            CHECK_OK(sn_tissue_set(&tissue, "C", 6e3));
            tissue.poissons_ratio = 0.4995;
        }
        sn_case *c = make_block(size, (const int[]){3, 3, 3}, SN_PATTERN_MIRRORED, &tissue);
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
        add_support(c, "left", "x");
        add_support(c, "front", "y");
        add_support(c, "bottom", "z");
        sn_load *l = add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.25 * size[0], 0, 0, 1);
        l->free[1] = l->free[2] = true;
        add_probe(c, "pull", SN_PROBE_REACTION, "right", 0, 0, 0);
        sn_run_summary s;
        sn_record *r = run_case(c, &s);
        assert_true(s.converged);
        double T, lambda = 1.25;
        if (k == 2) {
            sn_law_uniaxial(tissue.law, tissue.value, 0, 1, &lambda, NULL, &T, NULL);
        } else {
            double E[6] = {0.5 * (lambda * lambda - 1),
                           0.5 * (1 / lambda - 1),
                           0.5 * (1 / lambda - 1),
                           0,
                           0,
                           0},
                   S[6];
            sn_law_solid(tissue.law, tissue.value, 0, 1, E, NULL, S, NULL);
            T = lambda * S[0] - S[1] / (lambda * lambda);
        }
        // a cube of springs is no average over all directions, and its free faces are soft
        CHECK_REL(last_value(r, "pull_fx"), T * size[1] * size[2], 0.12);
        sn_record_destroy(r);
        sn_case_destroy(c);
    }
}

// One spring alone: a tetrahedron whose other edges do not change their length.
static void spring_remembers(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    t.memory = prony(0.4, 0.05, 0.25, 0.6);
    sn_case *c = make_block((const double[]){0.01, 0.01, 0.01}, (const int[]){1, 1, 1},
                            SN_PATTERN_MIRRORED, &t);
    c->springs.rung = SN_RUNG_CENTRAL;
    c->springs.volume = false;
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    const size_t nodes = (size_t)net->nodes;
    double *u = sn_alloc(nodes * 4, sizeof *u), *store = sn_alloc(net->store_size, sizeof *store);
    sn_factors factors;
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
    const sn_force_call call = {.precision = SN_DOUBLE,
                                .mode = SN_MEMORY_ADVANCE,
                                .u = u,
                                .factors = &factors,
                                .store = store,
                                .out = &scratch};
    // stretch of the spring 0 over time: up, down a bit, hold; steps of uneven length
    const int a = net->spring_end[0], b = net->spring_end[SN_BLOCK];
    const double *stiffness = net->data[SN_DOUBLE].stiffness;
    double D[3], L = 0, time = 0, T[201], at[201];
    for (int d = 0; d < 3; d++) {
        D[d] = net->node_position[3 * b + d] - net->node_position[3 * a + d];
        L += D[d] * D[d];
    }
    L = sqrt(L);
    T[0] = at[0] = 0;
    for (int n = 1; n <= 200; n++) {
        double h = n % 3 ? 0.004 : 0.011, x;
        time += h;
        x = time < 0.4 ? 0.3 * time / 0.4 : time < 0.6 ? 0.3 - 0.5 * (time - 0.4) : 0.2;
        for (int d = 0; d < 3; d++) u[4 * b + d] = x * D[d];
        sn_net_factors(net, h, &factors);
        sn_net_forces(net, &call);
        double B = net->region[0].exponent;
        at[n] = time;
        T[n] = fabs(B * x) < 1e-12 ? x : expm1(B * x) / B;
        // the hereditary integral, T straight between the times: G integrated over each piece
        double sum = 0;
        for (int k = 1; k <= n; k++) {
            double slope = (T[k] - T[k - 1]) / (at[k] - at[k - 1]), piece = 0;
            const double g[2] = {0.4, 0.25}, tau[2] = {0.05, 0.6};
            piece += (1 - 0.65) * (at[k] - at[k - 1]);
            for (int i = 0; i < 2; i++)
                piece += g[i] * tau[i] *
                         (exp(-(time - at[k]) / tau[i]) - exp(-(time - at[k - 1]) / tau[i]));
            sum += slope * piece;
        }
        double f = 0;
        // only b moves, so that spring 0 alone pulls at a
        for (int d = 0; d < 3; d++) f += ((double *)scratch.f)[4 * a + d] * D[d] / L;
        CHECK_ABS(f / (stiffness[0] * L), sum, 1e-13); // rounding over 200 steps
    }
    assert_true(fabs(T[200] - T[60]) > 0.02);
    sn_free(u);
    sn_free(store);
    sn_scratch_destroy(&scratch);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

static double stretched_energy(const sn_net *net) {
    sn_fields *fields;
    CHECK_OK(sn_fields_create(net, &fields));
    double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
    double *p = sn_alloc((size_t)net->point_blocks * SN_BLOCK, sizeof *p);
    for (int i = 0; i < net->nodes; i++) u[4 * i] = 0.1 * net->node_position[3 * i];
    const sn_moment m = {.precision = SN_DOUBLE, .u = u, .pressure = p};
    sn_fields_fill(net, fields, &m);
    double energy = sn_fields_elastic(net, fields);
    sn_free(u);
    sn_free(p);
    sn_fields_destroy(fields);
    return energy;
}

// The only spring, of stiffness k, pulled by one of its ends.
static void pull_one(const sn_net *net, const sn_mesh *mesh, const int end[2], double k) {
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, SN_SINGLE, &scratch));
    float *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
    double D[3], L2 = 0, way = 0.01;
    for (int d = 0; d < 3; d++) {
        D[d] = mesh->node[3 * end[1] + d] - mesh->node[3 * end[0] + d];
        L2 += D[d] * D[d];
    }
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3 && net->node_name[i] == end[1]; d++)
            u[4 * i + d] = (float)(way * D[d]);
    sn_net_forces(net, &(sn_force_call){
                           .precision = SN_SINGLE, .mode = SN_MEMORY_OFF, .u = u, .out = &scratch});
    for (int i = 0; i < net->nodes; i++) {
        double f = 0;
        for (int d = 0; d < 3; d++) f += (double)((float *)scratch.f)[4 * i + d] * D[d] / sqrt(L2);
        const double sign = net->node_name[i] == end[0] ? 1 : net->node_name[i] == end[1] ? -1 : 0;
        // force k L (lambda - 1) (1 + B way / 2), B of a few; single precision
        CHECK_ABS(f / (k * sqrt(L2) * way), sign, 0.03);
    }
    sn_free(u);
    sn_scratch_destroy(&scratch);
}

// Constants of single springs: all four times stiffer halves the step; one alone is found where its
// nodes are.
static void springs_take_constants(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block((const double[]){0.03, 0.03, 0.03}, (const int[]){3, 3, 3},
                            SN_PATTERN_MIRRORED, &t);
    c->springs.rung = SN_RUNG_CENTRAL;
    c->springs.precision = SN_SINGLE;
    c->springs.volume = false;
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    const int count = sn_net_spring_count(net);
    const double step = sn_net_step(net), energy = stretched_energy(net);
    int *ends = sn_alloc((size_t)count * 2, sizeof *ends);
    double *k = sn_alloc((size_t)count, sizeof *k), *again = sn_alloc((size_t)count, sizeof *again);
    sn_net_springs(net, ends, k);
    for (int s = 0; s < count; s++) k[s] *= 4;
    CHECK_OK(sn_net_set_spring_stiffness(net, k));
    sn_net_springs(net, NULL, again);
    for (int s = 0; s < count; s++) {
        CHECK_ABS(again[s], k[s], 0);
        assert_true(ends[2 * s] != ends[2 * s + 1]);
    }
    CHECK_REL(sn_net_step(net), step / 2, 2e-3); // to which the search for the frequency settles
    CHECK_REL(stretched_energy(net), 4 * energy, 1e-13);
    memset(k, 0, (size_t)count * sizeof *k);
    k[7] = 3;
    CHECK_OK(sn_net_set_spring_stiffness(net, k));
    pull_one(net, c->mesh, ends + 14, 3);
    k[3] = -1;
    CHECK_FAILS(sn_net_set_spring_stiffness(net, k), SN_E_RANGE, "spring 3");
    sn_net_springs(net, NULL, again);
    CHECK_ABS(again[7], 3, 0);
    sn_free(ends);
    sn_free(k);
    sn_free(again);
    sn_net_destroy(net);
    c->springs.rung = SN_RUNG_COUPLED;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_FAILS(sn_net_set_spring_stiffness(net, &step), SN_E_UNSUPPORTED, "central");
    sn_net_destroy(net);
    sn_case_destroy(c);
}

// Crushed and let go, flattened or shrunk with every node somewhere: down to a tenth of the height
// and a fifth of the size with the volume term, to half and 0.6 without, which knows lengths only
// and can come out inside out of less. A law that let springs vanish at a finite force would leave
// nodes on each other.
static void crushed_nets_recover(void **state) {
    (void)state;
    for (int k = 0; k < 8; k++) {
        sn_tissue t = make_tissue(k / 2 % 2 ? "exponential" : "linear");
        if (k / 2 % 2) {
            CHECK_OK(sn_tissue_set(&t, "B", 10));
            CHECK_OK(sn_tissue_set(&t, "C", 6e3));
        } else {
            CHECK_OK(sn_tissue_set(&t, "modulus", 6e3));
        }
        const bool volume = k / 4;
        t.poissons_ratio = volume ? 0.45 : 0.25;
        const double size[3] = {0.03, 0.03, 0.03};
        sn_case *c = make_block(size, (const int[]){3, 3, 3}, SN_PATTERN_MIRRORED, &t);
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.volume = volume;
        add_support(c, "bottom", "xyz");
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        uint64_t seed = 5;
        const double flat = volume ? 0.9 : 0.5, small = volume ? 0.8 : 0.4;
        double *u = s->u, most = 0, crushed = 0;
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++) {
                const double X = net->node_position[3 * i + d];
                if (net->fixed_bits[i] >> d & 1) continue;
                u[4 * i + d] = k % 2 ? -small * X + check_random(&seed, -4e-4, 4e-4)
                                     : (d == 2 ? -flat * X : 0);
                crushed = fmax(crushed, fabs(u[4 * i + d]));
            }
        // down the slope of the energy: motion is stopped after every step, and before every step
        // a look at how stiff the net is now goes from its begin to its end
        for (int n = 0; n < 7000; n++) {
            s->check_in = 1;
            do sn_state_follow_frequency(net, s, 0);
            while (s->look.done > 0);
            // (h omega)^2 below 2: 0.9^2
            sn_state_step(net, s, n == 0 ? 1e-12 : 0.45 * sn_net_stable_step(net, s->omega2));
            memset(s->v, 0, (size_t)net->nodes * 4 * sizeof(double));
        }
        assert_false(s->broken);
        for (int i = 0; i < net->nodes; i++)
            for (int d = 0; d < 3; d++) most = fmax(most, fabs(u[4 * i + d]));
        assert_true(crushed > 0.01);
        CHECK_ABS(most, 0, 1e-6); // of 0.03; the slowest mode halves some 100 times
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

static sn_case *small_block(const sn_tissue *t) {
    return make_block((const double[]){0.02, 0.02, 0.02}, (const int[]){2, 2, 2},
                      SN_PATTERN_MIRRORED, t);
}

static void refusals_name_the_reason(void **state) {
    (void)state;
    sn_net *net;
    sn_tissue fibre = guccione(1e3, 3e4);
    sn_case *c = small_block(&fibre);
    c->fibre[0] = 1;
    c->springs.rung = SN_RUNG_CENTRAL;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED, "fibres");
    assert_null(net);
    sn_case_destroy(c);

    sn_tissue soft = neo_hookean(3e3, 4e3); // nu = 0.2
    c = small_block(&soft);
    c->springs.rung = SN_RUNG_CENTRAL;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED, "Poisson's ratio of 1/4");
    c->springs.volume = false;
    CHECK_OK(sn_net_create(c, &net));
    sn_net_destroy(net);
    c->springs.rung = SN_RUNG_COUPLED;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_DEFINITION, "equilibrium");
    c->load = sn_alloc(1, sizeof *c->load);
    c->load_count = 1;
    c->load[0] = (sn_load){.kind = SN_LOAD_DISPLACEMENT,
                           .surface = sn_mesh_surface(c->mesh, "top"),
                           .vector = {0, 0, 1e-3}};
    CHECK_FAILS(sn_net_create(c, &net), SN_E_DEFINITION, "rigid motion of \"top\"");
    c->springs.integrator = SN_INTEGRATOR_EXPLICIT;
    c->tissue[0].density = NAN;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_DEFINITION, "no density");
    c->tissue[0].density = 1000;
    c->springs.step = -1;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_RANGE, "step");
    c->springs.step = 0;
    c->springs.damping = NAN;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_RANGE, "damping");
    sn_case_destroy(c);

    sn_tissue hard = neo_hookean(3e3, INFINITY);
    c = small_block(&hard);
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED, "finite bulk_modulus");
    sn_case_destroy(c);

    sn_tissue line = make_tissue("exponential");
    CHECK_OK(sn_tissue_set(&line, "B", 10));
    CHECK_OK(sn_tissue_set(&line, "C", 6e3));
    line.poissons_ratio = 0.4;
    c = small_block(&line);
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED, "uniaxial");
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lattices_are_isotropic), cmocka_unit_test(cubic_constants_are_known),
        cmocka_unit_test(rule_of_cells_adds_up),  cmocka_unit_test(fit_reproduces_uniaxial_stress),
        cmocka_unit_test(spring_remembers),       cmocka_unit_test(springs_take_constants),
        cmocka_unit_test(crushed_nets_recover),   cmocka_unit_test(refusals_name_the_reason)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
