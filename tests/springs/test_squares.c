// The law that calibrated springs have, and the net that it acts in.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "springs/tangent.h"

static const sn_spring_law laws[] = {{5, 0, 0},   {5, 0, 20},      {-3, 9, 22}, {-3, 0.4, 0.2},
                                     {0, 15, 60}, {1e-14, 4, 400}, {-8, 30, 0}};
enum { LAWS = sizeof laws / sizeof *laws };

// as sinew/model.h has it, in the plainest way
static double force(const sn_spring_law *law, double lambda) {
    const double x = lambda - 1, B = law->exponent;
    if (x < 0)
        return (lambda - 1 / (lambda * lambda)) / 3 + x * (exp(fmin(law->down * x * x, 60)) - 1);
    return (fabs(B) < 1e-10 ? x : (exp(B * x) - 1) / B) + x * (exp(law->up * x * x) - 1);
}

// Force, slope by central differences, energy by Simpson's rule, and the way back.
static void one_spring(void **state) {
    (void)state;
    for (int k = 0; k < LAWS; k++) {
        const sn_spring_law *law = &laws[k];
        for (double lambda = 0.55; lambda < 1.6; lambda += 0.0437) {
            double slope;
            const double t = sn_spring_tension(law, lambda, &slope), h = 1e-5;
            // exp(y) - 1 by exp loses 1e-16 over y
            CHECK_ABS(t, force(law, lambda), 1e-11 * (1 + fabs(t)));
            const double rise = (force(law, lambda + h) - force(law, lambda - h)) / (2 * h);
            if (fabs(lambda - 1) > h) CHECK_REL(slope, rise, 1e-5); // h^2 times a third derivative
            double sum = 0;
            const int n = 2000;
            for (int i = 0; i <= n; i++)
                sum += (i == 0 || i == n ? 1
                        : i % 2          ? 4
                                         : 2) *
                       force(law, 1 + (lambda - 1) * i / n) * (lambda - 1) / (3 * n);
            // fourth order; second where the slope jumps, at the most that an exponent may be
            const bool steepest = law->down * (lambda - 1) * (lambda - 1) > SN_SPRING_STEEPEST;
            CHECK_REL(sn_spring_potential(law, lambda), sum, steepest ? 1e-4 : 1e-7);
            // back to the stretch as well as the force is known
            CHECK_ABS(sn_spring_stretch(law, t), lambda, 1e-12 * (1 + fabs(t) / slope));
        }
        for (double x = 1e-7; x < 1e-2; x *= 10) // near rest: series
            CHECK_REL(sn_spring_potential(law, 1 + x), x * x / 2, 20 * x + 1e-8);
        double huge = 50; // beyond what B < 0 alone can carry
        if (law->up > 0)
            CHECK_REL(sn_spring_tension(law, sn_spring_stretch(law, huge), NULL), huge, 1e-9);
    }
}

static sn_case *squared(sn_precision precision) {
    const double size[3] = {0.03, 0.02, 0.02};
    const int cells[3] = {3, 2, 2};
    const sn_tissue t = neo_hookean(3e3, 3e4);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    sn_net *net;
    c->springs.rung = SN_RUNG_CENTRAL;
    c->springs.volume = true;
    c->springs.precision = precision;
    c->springs.integrator = SN_INTEGRATOR_EXPLICIT;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_net_spring_set(net, &c->springs_given));
    sn_net_destroy(net);
    const double square[SN_SPRING_SQUARES] = {20, 12, 9, 4, -3, 2, 15};
    memcpy(c->springs_given->square, square, sizeof square);
    c->springs_given->exponent[0] = -2;
    return c;
}

static double *motion(const sn_net *net, double amount) {
    double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u);
    uint64_t seed = 5;
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) u[4 * i + d] = amount * 0.01 * check_random(&seed, -1, 1);
    return u;
}

static void find_forces(const sn_net *net, sn_precision precision, const double *u, double *f,
                        double *pressure) {
    const int n = 4 * net->nodes;
    sn_scratch scratch = {0};
    float *single = sn_alloc((size_t)n, sizeof *single);
    for (int i = 0; i < n; i++) single[i] = (float)u[i];
    CHECK_OK(sn_scratch_create(net, precision, &scratch));
    const void *at = precision == SN_SINGLE ? (const void *)single : u;
    sn_net_forces(net, &(sn_force_call){.precision = precision, .u = at, .out = &scratch});
    for (int i = 0; i < n; i++) f[i] = sn_real_at(precision, scratch.f, (size_t)i);
    if (pressure)
        memcpy(pressure, scratch.pressure, (size_t)net->point_blocks * SN_BLOCK * sizeof *pressure);
    sn_free(single);
    sn_scratch_destroy(&scratch);
}

// of the springs alone, by the plain law
static double energy(const sn_net *net, const double *u) {
    double sum = 0;
    const double *k = net->data[SN_DOUBLE].stiffness, *q = net->region[0].square;
    for (int s = 0; s < net->spring_blocks * SN_BLOCK; s++) {
        const int *end = net->spring_end + s / SN_BLOCK * 2 * SN_BLOCK + s % SN_BLOCK;
        double D[3], L2 = 0, l2 = 0;
        if (!(k[s] > 0)) continue;
        for (int d = 0; d < 3; d++) {
            D[d] = net->node_position[3 * end[SN_BLOCK] + d] - net->node_position[3 * end[0] + d];
            const double x = D[d] + u[4 * end[SN_BLOCK] + d] - u[4 * end[0] + d];
            L2 += D[d] * D[d];
            l2 += x * x;
        }
        const double up = (q[0] * D[0] * D[0] + q[1] * D[1] * D[1] + q[2] * D[2] * D[2] +
                           2 * (q[3] * D[0] * D[1] + q[4] * D[1] * D[2] + q[5] * D[2] * D[0])) /
                          L2;
        const sn_spring_law law = {net->region[0].exponent, up, q[6]};
        sum += k[s] * L2 * sn_spring_potential(&law, sqrt(l2 / L2));
    }
    return sum;
}

// Forces are slopes of the energy, the tangent is their slope, and single precision follows.
static void nets(void **state) {
    (void)state;
    sn_case *c = squared(SN_SINGLE);
    c->springs.volume = false;
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    const int n = 4 * net->nodes;
    double *u = motion(net, 0.15), *v = motion(net, 0.1), scale = 0;
    double *f = sn_alloc((size_t)n, sizeof *f), *g = sn_alloc((size_t)n, sizeof *g);
    for (int i = 0; i < n; i++) v[i] = v[(i * 7 + 4) % n / 4 * 4 + i % 4] * (i % 4 < 3);
    find_forces(net, SN_DOUBLE, u, f, NULL);
    find_forces(net, SN_SINGLE, u, g, NULL);
    for (int i = 0; i < n; i++) scale = fmax(scale, fabs(f[i]));
    // rounding of a place by 6e-8 of an edge, stiffened some 3 times, and of sums of 26 springs
    for (int i = 0; i < n; i++)
        if (i % 4 < 3) CHECK_ABS(f[i] / scale, g[i] / scale, 5e-6);
    const double h = 1e-4;
    double work = 0, rise = 0;
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i < n; i++) u[i] += side * h * v[i];
        rise += side * energy(net, u) / (2 * h);
        for (int i = 0; i < n; i++) u[i] -= side * h * v[i];
    }
    for (int i = 0; i < n; i++) work -= i % 4 < 3 ? f[i] * v[i] : 0;
    CHECK_REL(work, rise, 1e-6); // h^2, and rounding of the energy over h
    sn_net_destroy(net);
    sn_free(u);
    sn_free(v);
    sn_free(f);
    sn_free(g);
    sn_case_destroy(c);
}

static void tangents(void **state) {
    (void)state;
    sn_case *c = squared(SN_DOUBLE);
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->support = sn_alloc(1, sizeof *c->support);
    c->support_count = 1;
    c->support[0] = (sn_support){sn_mesh_surface(c->mesh, "left"), {true, true, true}};
    sn_net *net;
    sn_tangent *tangent;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_tangent_create(net, &tangent));
    const int n = net->nodes;
    double *u = motion(net, 0.15), *f = sn_alloc((size_t)n * 4, sizeof *f);
    double *pressure = sn_alloc((size_t)net->point_blocks * SN_BLOCK, sizeof *pressure);
    double *x = sn_alloc((size_t)n * 3, sizeof *x), *y = sn_alloc((size_t)n * 3, sizeof *y);
    double *slope = sn_alloc((size_t)n * 3, sizeof *slope), worst = 0, scale = 0;
    uint64_t seed = 9;
    const double h = 1e-6; // m: 1e-4 edges
    for (int i = 0; i < 3 * n; i++) x[i] = check_random(&seed, -1, 1);
    find_forces(net, SN_DOUBLE, u, f, pressure);
    sn_tangent_assemble(net, tangent, &(sn_tangent_call){.u = u, .pressure = pressure});
    sn_tangent_multiply(net, tangent, x, y);
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i < 3 * n; i++) u[4 * (i / 3) + i % 3] += side * h * x[i];
        find_forces(net, SN_DOUBLE, u, f, NULL);
        for (int i = 0; i < 3 * n; i++) slope[i] += side * f[4 * (i / 3) + i % 3] / (2 * h);
        for (int i = 0; i < 3 * n; i++) u[4 * (i / 3) + i % 3] -= side * h * x[i];
    }
    for (int i = 0; i < 3 * n; i++) {
        worst = fmax(worst, fabs(y[i] + slope[i]));
        scale = fmax(scale, fabs(y[i]));
    }
    CHECK_ABS(worst / scale, 0, 1e-5); // a spring that crosses rest bends by its curvatures
    double *const all[] = {u, f, pressure, x, y, slope};
    for (int i = 0; i < 6; i++) sn_free(all[i]);
    sn_tangent_destroy(tangent);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

static void refusals(void **state) {
    (void)state;
    sn_case *c = squared(SN_DOUBLE);
    sn_spring_set *set = c->springs_given;
    CHECK_OK(sn_spring_set_check(set, c->mesh));
    const double bad[][SN_SPRING_SQUARES] = {{-1, 2, 2, 0, 0, 0, 1},
                                             {1, 2, 2, 3, 0, 0, 1}, // below 0 along x - y
                                             {1, 1, 1, 0, 0, 0, -1},
                                             {1, (double)NAN, 1, 0, 0, 0, 1}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        memcpy(set->square, bad[k], sizeof bad[k]);
        CHECK_FAILS(sn_spring_set_check(set, c->mesh), SN_E_RANGE, "stiffen");
    }
    const double edge[SN_SPRING_SQUARES] = {2, 2, 2, 2, 0, 0, 400}; // 0 along x - y
    memcpy(set->square, edge, sizeof edge);
    CHECK_OK(sn_spring_set_check(set, c->mesh));
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_spring),
        cmocka_unit_test(nets),
        cmocka_unit_test(tangents),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
