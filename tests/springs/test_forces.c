// Nodal forces of every rung against independent formulas.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "laws.h"
#include "springs/forces.h"
#include "springs/moment.h"

static const double size[3] = {0.03, 0.02, 0.025};
static const int cells[3] = {3, 2, 2};

// random displacements of up to `amount` of the shortest edge
static double *random_motion(const sn_case *c, double amount, uint64_t seed) {
    double *u = sn_alloc((size_t)c->mesh->node_count * 4, sizeof *u);
    for (int i = 0; i < c->mesh->node_count; i++)
        for (int d = 0; d < 3; d++) u[4 * i + d] = amount * 0.01 * check_random(&seed, -1, 1);
    return u;
}

// a net has an order of nodes of its own: what stands at node_name[i] of the mesh, at node i
static double *to_net(const sn_net *net, const double *x) {
    double *y = sn_alloc((size_t)net->nodes * 4, sizeof *y);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 4; d++) y[4 * i + d] = x[4 * net->node_name[i] + d];
    return y;
}

// of a net's own order
static double *own_forces_at(const sn_net *net, const double *u) {
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
    const sn_force_call call = {
        .precision = SN_DOUBLE, .mode = SN_MEMORY_OFF, .u = u, .out = &scratch};
    sn_net_forces(net, &call);
    double *f = sn_alloc((size_t)sn_net_node_count(net) * 4, sizeof *f);
    memcpy(f, scratch.f, (size_t)sn_net_node_count(net) * 4 * sizeof *f);
    sn_scratch_destroy(&scratch);
    return f;
}

static double *forces_at(const sn_net *net, const double *u) {
    double *own = to_net(net, u), *g = own_forces_at(net, own);
    double *f = sn_alloc((size_t)net->nodes * 4, sizeof *f);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 4; d++) f[4 * net->node_name[i] + d] = g[4 * i + d];
    sn_free(own);
    sn_free(g);
    return f;
}

static double largest(const double *f, int nodes) {
    double most = 0;
    for (int i = 0; i < nodes; i++)
        for (int d = 0; d < 3; d++) most = fmax(most, fabs(f[4 * i + d]));
    return most;
}

static double elastic_at(const sn_net *net, const double *u) {
    sn_fields *fields;
    CHECK_OK(sn_fields_create(net, &fields));
    double *pressure = sn_alloc((size_t)net->point_blocks * SN_BLOCK + 1, sizeof *pressure);
    double *own = to_net(net, u);
    const sn_moment m = {.precision = SN_DOUBLE, .u = own, .pressure = pressure};
    sn_fields_fill(net, fields, &m);
    double energy = sn_fields_elastic(net, fields);
    sn_free(own);
    sn_free(pressure);
    sn_fields_destroy(fields);
    return energy;
}

//---- linear-tetrahedron finite elements, written once more ---------------------------------------

static void inverse3(const double A[9], double B[9], double *det) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, p = (i + 1) % 3, q = (i + 2) % 3;
            B[3 * i + j] = A[3 * a + p] * A[3 * b + q] - A[3 * a + q] * A[3 * b + p];
        }
    *det = A[0] * B[0] + A[1] * B[3] + A[2] * B[6];
    for (int k = 0; k < 9; k++) B[k] /= *det;
}

static void multiply3(const double A[9], const double B[9], double C[9]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            C[3 * i + j] = 0;
            for (int k = 0; k < 3; k++) C[3 * i + j] += A[3 * i + k] * B[3 * k + j];
        }
}

static void transpose3(const double A[9], double B[9]) {
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) B[3 * i + j] = A[3 * j + i];
}

// f_a = -V P grad N_a with P = F (S_d + K (J-1) J C^-1): deformed edges times inverse rest edges
static void add_element(const sn_case *c, int cell, const double Q[9], const double *u, double *f) {
    const int *n = c->mesh->cell + 4 * cell;
    const sn_tissue *t = &c->tissue[c->mesh->region[cell]];
    double X[9], x[9], Xi[9], F[9], Ft[9], C[9], Ci[9], det, J, volume;
    for (int a = 0; a < 3; a++)
        for (int d = 0; d < 3; d++) {
            X[3 * d + a] = c->mesh->node[3 * n[a + 1] + d] - c->mesh->node[3 * n[0] + d];
            x[3 * d + a] = X[3 * d + a] + u[4 * n[a + 1] + d] - u[4 * n[0] + d];
        }
    inverse3(X, Xi, &volume);
    volume /= 6;
    multiply3(x, Xi, F);
    transpose3(F, Ft);
    multiply3(Ft, F, C);
    inverse3(C, Ci, &det);
    J = sqrt(det);
    double E[9], Em[9], Qt[9], half[9];
    for (int k = 0; k < 9; k++) E[k] = 0.5 * (C[k] - (k % 4 == 0));
    transpose3(Q, Qt);
    multiply3(Q, E, half);
    multiply3(half, Qt, Em);
    double e6[6] = {Em[0], Em[4], Em[8], Em[1], Em[5], Em[2]}, S6[6];
    sn_law_solid(t->law, t->value, t->terms, 1, e6, NULL, S6, NULL);
    double Sm[9] = {S6[0], S6[3], S6[5], S6[3], S6[1], S6[4], S6[5], S6[4], S6[2]}, S[9], P[9];
    multiply3(Qt, Sm, half);
    multiply3(half, Q, S);
    sn_moduli moduli;
    sn_tissue_moduli(t, &moduli);
    for (int k = 0; k < 9; k++) S[k] += moduli.bulk * (J - 1) * J * Ci[k];
    multiply3(F, S, P);
    for (int a = 0; a < 3; a++)
        for (int d = 0; d < 3; d++) {
            double sum = 0; // row a of X^-1 is the gradient of shape function a + 1
            for (int k = 0; k < 3; k++) sum -= volume * P[3 * d + k] * Xi[3 * a + k];
            f[4 * n[a + 1] + d] += sum;
            f[4 * n[0] + d] -= sum;
        }
}

static void coupled_cells_are_linear_elements(void **state) {
    (void)state;
    for (int k = 0; k < 2 * sn_law_count(); k++) {
        const sn_law *law = sn_law_at(k / 2);
        const bool turned = k % 2; // axes of their own in every cell
        if (law->kind != SN_LAW_SOLID || (turned && !law->fibres)) continue;
        sn_tissue t = some_tissue(law);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        jitter(c, 0.2, 11 + (uint64_t)k);
        c->fibre[0] = 0.48;
        c->fibre[1] = 0.6;
        c->fibre[2] = 0.64;
        if (turned) turn_fibres(c, 3);
        c->springs.volume = false;
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        double Q[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, *field = NULL;
        if (t.law->fibres) sn_case_axes(c, Q);
        if (turned) CHECK_OK(sn_case_axes_field(c, Q, &field));
        assert_true(turned == (field != NULL));
        double *u = random_motion(c, 0.15, 5 + (uint64_t)k), *f = forces_at(net, u);
        double *g = sn_alloc((size_t)c->mesh->node_count * 4, sizeof *g);
        for (int e = 0; e < c->mesh->cell_count; e++)
            add_element(c, e, field ? field + 9 * (size_t)e : Q, u, g);
        sn_free(field);
        double scale = largest(g, c->mesh->node_count), worst = 0;
        assert_true(scale > 0.01); // newtons: not a comparison of zeros
        for (int i = 0; i < c->mesh->node_count; i++)
            for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(f[4 * i + d] - g[4 * i + d]));
        // rounding: E to 1e-16, stiffness over stress about 10, exponents a few
        CHECK_ABS(worst / scale, 0, 1e-12);
        sn_free(u);
        sn_free(f);
        sn_free(g);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

//---- every rung ----------------------------------------------------------------------------------

typedef void each_rung(const sn_case *c, const sn_net *net);

static void for_each_rung(each_rung *check) {
    for (int n = 0; n < 20; n++) {
        // smoothed: as these, in part central, kinds; central with families of fibres; then fibres
        // of every cell: smoothed, coupled, central
        static const int like[] = {0, 2, 5, 7, 0, 2, 4, 6, 0, 0};
        const bool families = n == 14 || n == 15 || n == 19, turned = n >= 16;
        const bool smoothed = (n >= 10 && n < 14) || n == 16 || n == 17;
        const int k = n >= 10 ? like[n - 10] : n;
        bool central = k >= 6 ? k % 2 : k % 2 == 1;
        sn_tissue t = k < 4 ? neo_hookean(3e3, 2e4) : demiray(2e3, 4, 4e4);
        if (k >= 8) {
            t = make_tissue("exponential");
            CHECK_OK(sn_tissue_set(&t, "B", 8));
            CHECK_OK(sn_tissue_set(&t, "C", 5e3));
            t.poissons_ratio = 0.45;
            central = true;
        }
        if (turned) t = guccione(2e3, 3e4), central = false;
        sn_case *c = make_block(size, cells, k == 5 ? SN_PATTERN_BCC : SN_PATTERN_MIRRORED, &t);
        if (families) {
            c->tissue[0] = some_tissue(sn_law_find("hgo"));
            c->fibre[0] = 0.6, c->fibre[2] = 0.8;
            central = true;
        }
        if (k != 3) jitter(c, 0.2, 21);
        if (k == 7) { // two regions
            c->mesh->region_count = 2;
            c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
            snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
            for (int e = 0; e < c->mesh->cell_count; e++) c->mesh->region[e] = e % 3 == 0;
            c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
            c->tissue[1] = neo_hookean(1e3, 2e4);
        }
        if (turned) turn_fibres(c, 13);
        c->springs.rung = smoothed ? SN_RUNG_SMOOTHED : central ? SN_RUNG_CENTRAL : SN_RUNG_COUPLED;
        c->springs.volume = k / 2 % 2 == 0;
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        check(c, net);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

static void force_is_energy_slope(const sn_case *c, const sn_net *net) {
    double *u = random_motion(c, 0.12, 77), *f = forces_at(net, u), scale, worst = 0;
    scale = largest(f, c->mesh->node_count);
    uint64_t seed = 31;
    for (int n = 0; n < 12; n++) {
        int at = 4 * (int)check_random(&seed, 0, c->mesh->node_count) + n % 3;
        const double h = 2e-7, keep = u[at]; // a few 1e-5 of an edge
        u[at] = keep + h;
        double up = elastic_at(net, u);
        u[at] = keep - h;
        double down = elastic_at(net, u);
        u[at] = keep;
        worst = fmax(worst, fabs(-(up - down) / (2 * h) - f[at]));
    }
    // rounding 1e-16 W / (h f), W / f about an edge: 1e-11; truncation (h / edge)^2 times a few
    // 100. Springs have no third derivative at lambda = 1: h / edge there, weighed by its rarity
    CHECK_ABS(worst / scale, 0, 1e-6);
    sn_free(u);
    sn_free(f);
}

static void forces_are_energy_slopes(void **state) {
    (void)state;
    for_each_rung(force_is_energy_slope);
}

static void rotation_gives_no_force(const sn_case *c, const sn_net *net) {
    const double a = 0.9, b = -0.5, shift[3] = {0.1, -0.05, 0.02};
    const double R1[9] = {cos(a), -sin(a), 0, sin(a), cos(a), 0, 0, 0, 1};
    const double R2[9] = {1, 0, 0, 0, cos(b), -sin(b), 0, sin(b), cos(b)};
    double R[9], *u = random_motion(c, 0, 1);
    multiply3(R1, R2, R);
    for (int i = 0; i < c->mesh->node_count; i++)
        for (int d = 0; d < 3; d++) {
            u[4 * i + d] = shift[d] - c->mesh->node[3 * i + d];
            for (int k = 0; k < 3; k++) u[4 * i + d] += R[3 * d + k] * c->mesh->node[3 * i + k];
        }
    double *f = forces_at(net, u);
    double *v = random_motion(c, 0.12, 3), *g = forces_at(net, v);
    // rounding of u, 1e-16 of 0.1 m against edges of 0.01 m, times bulk over shear
    CHECK_ABS(largest(f, c->mesh->node_count) / largest(g, c->mesh->node_count), 0, 1e-12);
    sn_free(u);
    sn_free(f);
    sn_free(v);
    sn_free(g);
}

static void rigid_motion_gives_no_force(void **state) {
    (void)state;
    for_each_rung(rotation_gives_no_force);
}

// forces of a rotated body are the rotated forces; they add up to no force and no moment
static void inner_forces_balance(const sn_case *c, const sn_net *net) {
    double *u = random_motion(c, 0.12, 9), *f = forces_at(net, u);
    double sum[3] = {0}, moment[3] = {0}, scale = largest(f, c->mesh->node_count);
    for (int i = 0; i < c->mesh->node_count; i++)
        for (int d = 0; d < 3; d++) {
            int e = (d + 1) % 3, g = (d + 2) % 3;
            sum[d] += f[4 * i + d];
            moment[d] += (c->mesh->node[3 * i + e] + u[4 * i + e]) * f[4 * i + g] -
                         (c->mesh->node[3 * i + g] + u[4 * i + g]) * f[4 * i + e];
        }
    for (int d = 0; d < 3; d++) { // sums of about 50 terms
        CHECK_ABS(sum[d] / scale, 0, 1e-13);
        CHECK_ABS(moment[d] / (scale * 0.03), 0, 1e-13);
    }
    sn_free(u);
    sn_free(f);
}

static void forces_balance(void **state) {
    (void)state;
    for_each_rung(inner_forces_balance);
}

static void tangent_is_force_slope(const sn_case *c, const sn_net *net) {
    const int n = c->mesh->node_count;
    sn_tangent *t;
    CHECK_OK(sn_tangent_create(net, &t));
    double *u = random_motion(c, 0.12, 15), *v = random_motion(c, 0.1, 16);
    sn_scratch scratch = {0};
    CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
    sn_force_call call = {.precision = SN_DOUBLE, .mode = SN_MEMORY_OFF, .u = u, .out = &scratch};
    sn_net_forces(net, &call);
    sn_tangent_assemble(net, t, &(sn_tangent_call){.u = u, .pressure = scratch.pressure});
    double *x = sn_alloc((size_t)n * 3, sizeof *x), *y = sn_alloc((size_t)n * 3, sizeof *y);
    const double h = 1e-4;
    for (int k = 0; k < 3 * n; k++) x[k] = v[4 * (k / 3) + k % 3];
    sn_tangent_multiply(net, t, x, y);
    for (int k = 0; k < 4 * n; k++) u[k] += h * v[k];
    double *up = own_forces_at(net, u);
    for (int k = 0; k < 4 * n; k++) u[k] -= 2 * h * v[k];
    double *down = own_forces_at(net, u), worst = 0, scale = 0;
    for (int k = 0; k < 3 * n; k++) {
        int at = 4 * (k / 3) + k % 3;
        worst = fmax(worst, fabs(y[k] + (up[at] - down[at]) / (2 * h)));
        scale = fmax(scale, fabs(y[k]));
    }
    // steps of 1e-5 of an edge: truncation 1e-10 times a few 100, rounding 1e-11; springs as above
    CHECK_ABS(worst / scale, 0, 1e-6);
    sn_free(u);
    sn_free(v);
    sn_free(x);
    sn_free(y);
    sn_free(up);
    sn_free(down);
    sn_scratch_destroy(&scratch);
    sn_tangent_destroy(t);
}

static void tangents_are_force_slopes(void **state) {
    (void)state;
    for_each_rung(tangent_is_force_slope);
}

// y <- (tangent with the pressure of load 0) x minus (tangent without it) x
static void pressure_stiffness(const sn_net *net, const double *u, const double *x, double *y) {
    sn_tangent *t;
    const size_t n = (size_t)net->nodes * 3;
    double *none = sn_alloc((size_t)net->point_blocks * SN_BLOCK + 1, sizeof *none);
    double *before = sn_alloc(n, sizeof *before), *ext = sn_alloc(n, sizeof *ext);
    CHECK_OK(sn_tangent_create(net, &t));
    sn_tangent_assemble(net, t, &(sn_tangent_call){.u = u, .pressure = none});
    sn_tangent_multiply(net, t, x, before);
    const sn_load_call call = {SN_DOUBLE, u, NULL, t};
    sn_net_loads(net, 1.0, 0.5, &call, ext); // half of it
    sn_tangent_multiply(net, t, x, y);
    for (size_t k = 0; k < n; k++) y[k] -= before[k];
    sn_free(none);
    sn_free(before);
    sn_free(ext);
    sn_tangent_destroy(t);
}

// ext <- half of the load at u + h v
static void half_load_at(const sn_net *net, const double *u, const double *v, double h,
                         double *ext) {
    const size_t n = (size_t)net->nodes * 4;
    double *there = sn_alloc(n, sizeof *there);
    for (size_t k = 0; k < n; k++) there[k] = u[k] + h * v[k];
    memset(ext, 0, (size_t)net->nodes * 3 * sizeof *ext);
    sn_net_loads(net, 1.0, 0.5, &(sn_load_call){SN_DOUBLE, there, NULL, NULL}, ext);
    sn_free(there);
}

// A pressure on the whole surface of a body has all of its slope in the tangent; one with a free
// rim the symmetric part of it.
static void pressure_stiffens_by_its_slope(void **state) {
    (void)state;
    const char *const surfaces[] = {"boundary", "top"};
    for (int k = 0; k < 2; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
        add_load(c, SN_LOAD_PRESSURE, surfaces[k], 0, 0, 0, 1)->pressure = 5e4;
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        const int n = 3 * net->nodes;
        double *u = random_motion(c, 0.12, 15), *way[2], *x[2], *y[2], slope[2][2] = {{0}};
        double whole = 0, part = 0, *up = sn_alloc((size_t)n, sizeof *up),
               *down = sn_alloc((size_t)n, sizeof *down);
        const double h = 1e-2;
        for (int a = 0; a < 2; a++) {
            way[a] = random_motion(c, 0.1, 16 + (uint64_t)a);
            x[a] = sn_alloc((size_t)n, sizeof *x[a]);
            y[a] = sn_alloc((size_t)n, sizeof *y[a]);
            for (int i = 0; i < n; i++) x[a][i] = way[a][4 * (i / 3) + i % 3];
            pressure_stiffness(net, u, x[a], y[a]);
        }
        for (int a = 0; a < 2; a++) { // the force is of second order in u: differences are exact
            half_load_at(net, u, way[a], h, up);
            half_load_at(net, u, way[a], -h, down);
            for (int i = 0; i < n; i++) {
                const double d = -(up[i] - down[i]) / (2 * h);
                for (int b = 0; b < 2; b++) slope[b][a] += x[b][i] * d;
                whole = fmax(whole, fabs(d));
                part = fmax(part, fabs(d - y[a][i]));
            }
        }
        double symmetric = 0, mine = 0, scale = fabs(slope[0][0]) + fabs(slope[1][1]);
        for (int i = 0; i < n; i++) {
            symmetric += x[0][i] * y[1][i] - x[1][i] * y[0][i];
            mine += x[0][i] * y[1][i];
        }
        // rounding of forces, 1e-16 of them over a step of 1e-2 of a tenth of an edge
        if (k == 0) CHECK_ABS(part / whole, 0, 1e-12);
        if (k == 1) assert_true(part / whole > 1e-2); // the rim
        CHECK_ABS(symmetric / scale, 0, 1e-13);
        CHECK_ABS((mine - 0.5 * (slope[0][1] + slope[1][0])) / scale, 0, 1e-12);
        double *const all[] = {u, way[0], way[1], x[0], x[1], y[0], y[1], up, down};
        for (int i = 0; i < 9; i++) sn_free(all[i]);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(coupled_cells_are_linear_elements),
                                       cmocka_unit_test(forces_are_energy_slopes),
                                       cmocka_unit_test(rigid_motion_gives_no_force),
                                       cmocka_unit_test(forces_balance),
                                       cmocka_unit_test(tangents_are_force_slopes),
                                       cmocka_unit_test(pressure_stiffens_by_its_slope)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
