// Smoothed edges: what they must have in common with coupled cells, and what not.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "laws.h"
#include "springs/forces.h"
#include "springs/moment.h"

static const double size[3] = {0.03, 0.02, 0.025};
static const int cells[3] = {3, 2, 2};

static double *forces_at(const sn_net *net, const double *u) {
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
    sn_net_forces(net, &(sn_force_call){
                           .precision = SN_DOUBLE, .mode = SN_MEMORY_OFF, .u = u, .out = &scratch});
    double *f = sn_alloc((size_t)net->nodes * 4, sizeof *f);
    memcpy(f, scratch.f, (size_t)net->nodes * 4 * sizeof *f);
    sn_scratch_destroy(&scratch);
    return f;
}

static double elastic_at(const sn_net *net, const double *u) {
    sn_fields *fields;
    CHECK_OK(sn_fields_create(net, &fields));
    double *pressure = sn_alloc((size_t)net->point_blocks * SN_BLOCK, sizeof *pressure);
    const sn_moment m = {.precision = SN_DOUBLE, .u = u, .pressure = pressure};
    sn_fields_fill(net, fields, &m);
    double energy = sn_fields_elastic(net, fields);
    sn_free(pressure);
    sn_fields_destroy(fields);
    return energy;
}

// every third cell of another tissue
static void split(sn_case *c, const sn_tissue *other) {
    c->mesh->region_count = 2;
    c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
    snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
    for (int e = 0; e < c->mesh->cell_count; e++) c->mesh->region[e] = e % 3 == 0;
    c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
    c->tissue[1] = *other;
}

static sn_case *distorted(const sn_tissue *t, uint64_t seed) {
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, t);
    jitter(c, 0.2, seed);
    c->fibre[0] = 0.48;
    c->fibre[1] = 0.6;
    c->fibre[2] = 0.64;
    return c;
}

static sn_net *make_net(sn_case *c, sn_rung rung, bool volume) {
    sn_net *net;
    c->springs.rung = rung;
    c->springs.volume = volume;
    CHECK_OK(sn_net_create(c, &net));
    return net;
}

static bool on_boundary(const double *X, double part) {
    for (int d = 0; d < 3; d++) // jitter is a fifth of an edge, 0.01 m
        if (X[d] < part || X[d] > size[d] - part) return true;
    return false;
}

// Patch test: an affine motion of a distorted mesh. Nodes inside are in equilibrium, and every
// nodal force is that of coupled cells, whose strain is the same; another motion tells them apart.
static void uniform_strain_is_that_of_cells(void **state) {
    (void)state;
    const double A[9] = {0.12, 0.05, -0.08, 0.02, -0.06, 0.1, -0.04, 0.03, 0.07};
    for (int k = 0; k < 2 * sn_law_count(); k++) {
        const sn_law *law = sn_law_at(k / 2);
        if (law->kind != SN_LAW_SOLID) continue;
        sn_tissue t = some_tissue(law);
        sn_case *c = distorted(&t, 11 + (uint64_t)k);
        sn_net *smooth = make_net(c, SN_RUNG_SMOOTHED, k % 2);
        sn_net *coupled = make_net(c, SN_RUNG_COUPLED, k % 2);
        double *u = sn_alloc((size_t)smooth->nodes * 4, sizeof *u);
        for (int i = 0; i < smooth->nodes; i++)
            for (int d = 0; d < 3; d++)
                for (int j = 0; j < 3; j++)
                    u[4 * i + d] += A[3 * d + j] * smooth->node_position[3 * i + j];
        double *f = forces_at(smooth, u), *g = forces_at(coupled, u), most = 0, inside = 0, far = 0;
        int inner = 0;
        for (int i = 0; i < smooth->nodes; i++) {
            const bool free = !on_boundary(smooth->node_position + 3 * i, 0.0045);
            inner += free;
            for (int d = 0; d < 3; d++) {
                most = fmax(most, fabs(g[4 * i + d]));
                far = fmax(far, fabs(f[4 * i + d] - g[4 * i + d]));
                if (free) inside = fmax(inside, fabs(f[4 * i + d]));
            }
        }
        assert_true(most > 0.01 && inner >= 2);
        // rounding: strains to 1e-16, stiffness over stress about 10, sums of some 20 cells
        CHECK_ABS(inside / most, 0, 1e-12);
        CHECK_ABS(far / most, 0, 1e-12);
        CHECK_REL(elastic_at(smooth, u), elastic_at(coupled, u), 1e-12);
        uint64_t seed = 3;
        for (int i = 0; i < 4 * smooth->nodes; i++) u[i] += 0.001 * check_random(&seed, -1, 1);
        // an average costs less than what it is an average of
        assert_true(elastic_at(smooth, u) < 0.99 * elastic_at(coupled, u));
        sn_free(u);
        sn_free(f);
        sn_free(g);
        sn_net_destroy(smooth);
        sn_net_destroy(coupled);
        sn_case_destroy(c);
    }
}

//---- the definition, edge by edge ----------------------------------------------------------------

// displacement gradient of a cell times its volume over six, in space; returns that sixth
static double shape_of(const sn_mesh *m, int cell, const double *u, double H[9]) {
    const int *n = m->cell + 4 * cell;
    double X[3][3], g[3][3], det = 0;
    for (int a = 0; a < 3; a++)
        for (int d = 0; d < 3; d++) X[a][d] = m->node[3 * n[a + 1] + d] - m->node[3 * n[0] + d];
    for (int a = 0; a < 3; a++)
        for (int d = 0; d < 3; d++) {
            const double *p = X[(a + 1) % 3], *q = X[(a + 2) % 3];
            g[a][d] = p[(d + 1) % 3] * q[(d + 2) % 3] - p[(d + 2) % 3] * q[(d + 1) % 3];
        }
    for (int d = 0; d < 3; d++) det += X[0][d] * g[0][d];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int a = 0; a < 3; a++)
                H[3 * i + j] += det / 36 * (u[4 * n[a + 1] + i] - u[4 * n[0] + i]) * g[a][j] / det;
    return det / 36;
}

static bool has(const sn_mesh *m, int cell, int node) {
    for (int a = 0; a < 4; a++)
        if (m->cell[4 * cell + a] == node) return true;
    return false;
}

// energy of the edge between two nodes in one region; 0 where there is none
static double edge_energy(const sn_case *c, int region, int a, int b, const double *u) {
    double H[9] = {0}, F[9], E[6], V = 0, W;
    for (int e = 0; e < c->mesh->cell_count; e++)
        if (c->mesh->region[e] == region && has(c->mesh, e, a) && has(c->mesh, e, b))
            V += shape_of(c->mesh, e, u, H);
    if (!(V > 0)) return 0;
    for (int k = 0; k < 9; k++) F[k] = H[k] / V + (k % 4 == 0);
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int k = 0; k < 6; k++) {
        int i = pair[k][0], j = pair[k][1];
        E[k] = 0.5 * (F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j] - (i == j));
    }
    const sn_tissue *t = &c->tissue[region];
    sn_moduli moduli;
    sn_tissue_moduli(t, &moduli);
    sn_law_solid(t->law, t->value, t->terms, 1, E, &W, NULL, NULL);
    double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
               F[2] * (F[3] * F[7] - F[4] * F[6]);
    return V * (W + 0.5 * moduli.bulk * (J - 1) * (J - 1));
}

static void energy_is_the_sum_over_edges(void **state) {
    (void)state;
    sn_tissue t = demiray(2e3, 4, 4e4), other = neo_hookean(6e3, 2e4);
    sn_case *c = distorted(&t, 21);
    split(c, &other);
    sn_net *net = make_net(c, SN_RUNG_SMOOTHED, false);
    const int nodes = net->nodes;
    double *u = sn_alloc((size_t)nodes * 4, sizeof *u), *v = sn_alloc((size_t)nodes * 4, sizeof *v);
    double sum = 0;
    uint64_t seed = 7;
    for (int i = 0; i < nodes; i++) // u of the mesh's nodes, v of the net's
        for (int d = 0; d < 3; d++) u[4 * i + d] = 0.001 * check_random(&seed, -1, 1);
    for (int i = 0; i < nodes; i++) memcpy(v + 4 * i, u + 4 * net->node_name[i], 4 * sizeof *v);
    for (int r = 0; r < 2; r++)
        for (int a = 0; a < nodes; a++)
            for (int b = a + 1; b < nodes; b++) sum += edge_energy(c, r, a, b, u);
    assert_true(sum > 1e-5);
    CHECK_REL(elastic_at(net, v), sum, 1e-12); // rounding of some hundred terms of one sign
    sn_free(u);
    sn_free(v);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

//---- structure -----------------------------------------------------------------------------------

// Every cell is around each of its six edges once, and nothing else is around them.
static void edges_know_their_cells(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block(size, (const int[]){7, 6, 5}, SN_PATTERN_MIRRORED, &t);
    split(c, &t);
    sn_net *net = make_net(c, SN_RUNG_SMOOTHED, true);
    int shares = 0, edges = 0;
    for (int e = 0; e < net->edge_blocks * SN_BLOCK; e++) {
        if (net->edge_filling[e]) continue;
        edges++;
        for (int k = net->edge_start[e]; k < net->edge_start[e + 1]; k++, shares++) {
            const int s = net->edge_cell[k];
            int times = 0;
            for (int side = 0; side < 6; side++)
                times += net->cell_edge[(s / SN_BLOCK * 6 + side) * SN_BLOCK + s % SN_BLOCK] == e;
            assert_int_equal(times, 1);
        }
    }
    assert_int_equal(shares, 6 * net->cells);
    assert_true(edges > net->cells); // two sets of them between regions
    assert_true(net->edge_blocks > 8);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

//---- pressure of the results ---------------------------------------------------------------------

typedef struct pressures {
    double *value;
    int nodes;
} pressures;

static sn_status keep_pressure(void *context, const sn_frame *frame) {
    pressures *p = context;
    for (int k = 0; k < frame->field_count; k++)
        if (strcmp(frame->fields[k].name, "pressure") == 0)
            memcpy(p->value, frame->fields[k].value, (size_t)p->nodes * sizeof *p->value);
    return SN_OK;
}

// Nodal pressures into the fields of a body at rest: even and linear ones come out as they are,
// a checkerboard is damped. Nodes inside have the same surroundings on both sides.
static void pressure_is_averaged(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 3e6);
    sn_case *c = make_block((const double[]){0.08, 0.08, 0.08}, (const int[]){8, 8, 8},
                            SN_PATTERN_MIRRORED, &t);
    for (int k = 0; k < 6; k++) {
        sn_net *net = make_net(c, k % 2 ? SN_RUNG_SMOOTHED : SN_RUNG_COUPLED, true);
        sn_fields *fields;
        CHECK_OK(sn_fields_create(net, &fields));
        double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
        double *in = sn_alloc((size_t)net->point_blocks * SN_BLOCK, sizeof *in);
        double *want = sn_alloc((size_t)net->nodes, sizeof *want);
        pressures got = {sn_alloc((size_t)net->nodes, sizeof(double)), net->nodes};
        for (int p = 0; p < net->point_blocks * SN_BLOCK; p++) {
            if (net->point_node[p] < 0) continue;
            const double *X = net->node_position + 3 * net->point_node[p];
            const long sum = lround(X[0] / 0.01) + lround(X[1] / 0.01) + lround(X[2] / 0.01);
            in[p] = k < 2 ? 7 : k < 4 ? 100 * X[0] - 40 * X[1] + 30 * X[2] : sum % 2 ? -1 : 1;
            want[net->node_name[net->point_node[p]]] = in[p];
        }
        const sn_moment m = {.precision = SN_DOUBLE, .u = u, .pressure = in};
        const sn_output output = {.context = &got, .frame = keep_pressure};
        sn_fields_fill(net, fields, &m);
        CHECK_OK(sn_fields_emit(fields, 0, &output));
        int inner = 0;
        for (int i = 0; i < net->nodes; i++) {
            const double *X = c->mesh->node + 3 * i;
            bool inside = true;
            for (int d = 0; d < 3; d++) inside = inside && X[d] > 0.005 && X[d] < 0.075;
            if (!inside) continue;
            inner++;
            // a stress is a tension: the sign turns
            if (k < 4)
                CHECK_ABS(got.value[i] + want[i], 0, 1e-12); // rounding of some 24 terms of 10
            else
                assert_true(fabs(got.value[i]) < 0.4);
        }
        assert_int_equal(inner, 7 * 7 * 7);
        sn_free(u);
        sn_free(in);
        sn_free(want);
        sn_free(got.value);
        sn_fields_destroy(fields);
        sn_net_destroy(net);
    }
    sn_case_destroy(c);
}

static void uniaxial_law_is_refused(void **state) {
    (void)state;
    sn_tissue t = make_tissue("exponential");
    CHECK_OK(sn_tissue_set(&t, "B", 10));
    CHECK_OK(sn_tissue_set(&t, "C", 6e3));
    t.poissons_ratio = 0.4;
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    c->springs.rung = SN_RUNG_SMOOTHED;
    sn_net *net;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED, "uniaxial");
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_strain_is_that_of_cells),
        cmocka_unit_test(energy_is_the_sum_over_edges), cmocka_unit_test(edges_know_their_cells),
        cmocka_unit_test(pressure_is_averaged), cmocka_unit_test(uniaxial_law_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
