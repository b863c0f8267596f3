// Finite strain against solutions that are known: manufactured ones with body forces, torsion, a
// thick tube of an exponential law. SPDX-License-Identifier: Apache-2.0
#include "body.h"
#include "continuum/newton.h"
#include "continuum/refine.h"

#define MU 1000.0

//---- manufactured solutions ---------------------------------------------------------------------

// A displacement of the unit cube with strains to 20 %. `swell` is 0.1, and J varies as much; or
// MU/K, and J - 1 is so small that the pressure K (J - 1) is of the order of MU.
typedef struct made {
    sn_tissue tissue;
    double bulk, swell;
} made;

static void displacement(const made *m, const double X[3], double u[3]) {
    u[0] = 0.10 * sin(1.7 * X[1] + 0.4);
    u[1] = 0.0;
    u[2] = 0.12 * sin(1.3 * X[0] + 0.9 * X[1]) + m->swell * cos(2.1 * X[2] - 0.3);
}

static void gradient(const made *m, const double X[3], double F[3][3]) {
    double a = 0.12 * cos(1.3 * X[0] + 0.9 * X[1]);
    const double M[3][3] = {{1, 0.17 * cos(1.7 * X[1] + 0.4), 0},
                            {0, 1, 0},
                            {1.3 * a, 0.9 * a, 1 - m->swell * 2.1 * sin(2.1 * X[2] - 0.3)}};
    memcpy(F, M, sizeof M);
}

static double pressure(const made *m, const double X[3]) {
    return -m->bulk * m->swell * 2.1 * sin(2.1 * X[2] - 0.3); // K (J - 1), J = F_zz
}

// P = F S_d + p cof F
static void nominal(const made *m, const double X[3], double P[3][3]) {
    static const int at[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double F[3][3], E[6], S[6], p = pressure(m, X);
    gradient(m, X, F);
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double C = 0;
            for (int k = 0; k < 3; k++) C += F[k][i] * F[k][j];
            E[at[i][j]] = 0.5 * (C - (i == j));
        }
    sn_law_solid(m->tissue.law, m->tissue.value, m->tissue.terms, 1, E, NULL, S, NULL);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            P[i][j] = p * (F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1]);
            for (int k = 0; k < 3; k++) P[i][j] += F[i][k] * S[at[k][j]];
        }
}

// -Div P by differences of fourth order: h^4 is 1e-12, rounding of P over h 1e-13 K.
static void body_force(const made *m, const double X[3], double B[3]) {
    const double h = 1e-3, weight[2] = {8.0 / 12, -1.0 / 12};
    B[0] = B[1] = B[2] = 0;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 2; k++) {
            double P[2][3][3];
            for (int side = 0; side < 2; side++) {
                double Y[3] = {X[0], X[1], X[2]};
                Y[j] += (side ? 1 : -1) * (k + 1) * h;
                nominal(m, Y, P[side]);
            }
            for (int i = 0; i < 3; i++) B[i] -= weight[k] * (P[1][i][j] - P[0][i][j]) / h;
        }
}

// Gauss points of the unit cube folded into the tetrahedron: exact to degree 5.
enum { GAUSS = 4, POINTS = GAUSS * GAUSS * GAUSS };

static void quadrature(double lambda[POINTS][4], double weight[POINTS]) {
    const double g[4] = {0.861136311594053, 0.339981043584856, -0.339981043584856,
                         -0.861136311594053};
    const double w[4] = {0.347854845137454, 0.652145154862546, 0.652145154862546,
                         0.347854845137454};
    for (int n = 0; n < POINTS; n++) {
        int i = n % GAUSS, j = n / GAUSS % GAUSS, k = n / GAUSS / GAUSS;
        double r = 0.5 + 0.5 * g[i], s = 0.5 + 0.5 * g[j], t = 0.5 + 0.5 * g[k];
        double y = s * (1 - r), z = t * (1 - r) * (1 - s);
        lambda[n][0] = 1 - r - y - z;
        lambda[n][1] = r;
        lambda[n][2] = y;
        lambda[n][3] = z;
        weight[n] = 6 * w[i] * w[j] * w[k] / 8 * (1 - r) * (1 - r) * (1 - s); // of the volume
    }
}

typedef struct point {
    double shape[SN_FE_NODES], X[3];
    int node[SN_FE_NODES];
} point;

static void locate(const sn_fe_space *s, int batch, int at, const double lambda[4], point *p) {
    memset(p->X, 0, sizeof p->X);
    sn_fe_cell_shape(s->element.nodes, lambda, p->shape);
    for (int a = 0; a < s->element.nodes; a++) {
        p->node[a] = sn_fe_cell_block(s, batch, at, a);
        for (int i = 0; i < 3; i++) p->X[i] += p->shape[a] * s->rest[3 * p->node[a] + i];
    }
}

static void load_body(const made *m, sn_fe_problem *p) {
    const sn_fe_space *s = p->space;
    double lambda[POINTS][4], weight[POINTS], B[3];
    point at;
    p->boundary->gravity = sn_alloc(3 * (size_t)s->nodes, sizeof(double));
    quadrature(lambda, weight);
    for (int b = 0; b < s->batches; b++)
        for (int c = 0; c < s->batch_count[b]; c++)
            for (int q = 0; q < POINTS; q++) {
                double volume = weight[q] * s->volume[b * s->batch_cells + c];
                locate(s, b, c, lambda[q], &at);
                body_force(m, at.X, B);
                for (int a = 0; a < s->element.nodes; a++)
                    for (int i = 0; i < 3; i++)
                        p->boundary->gravity[3 * at.node[a] + i] += volume * at.shape[a] * B[i];
            }
}

// Relative errors in the mean square of displacement and, for the mixed element, pressure; last the
// mean square of the displacement over the exact one.
static void errors(const made *m, const sn_fe_problem *p, const double *x, double error[3]) {
    const sn_fe_space *s = p->space;
    double lambda[POINTS][4], weight[POINTS], square[2] = {0}, size[2] = {0}, own = 0;
    point at;
    quadrature(lambda, weight);
    for (int b = 0; b < s->batches; b++)
        for (int c = 0; c < s->batch_count[b]; c++)
            for (int q = 0; q < POINTS; q++) {
                double v = weight[q] * s->volume[b * s->batch_cells + c], u[3];
                locate(s, b, c, lambda[q], &at);
                displacement(m, at.X, u);
                double exact = pressure(m, at.X), found = 0;
                for (int i = 0; i < 3; i++) {
                    double ui = 0;
                    for (int a = 0; a < s->element.nodes; a++)
                        ui += at.shape[a] * x[3 * at.node[a] + i];
                    square[0] += v * (ui - u[i]) * (ui - u[i]);
                    size[0] += v * u[i] * u[i];
                    own += v * ui * ui;
                }
                for (int k = 0; k < 4 && s->element.mixed; k++)
                    found += lambda[q][k] * x[3 * s->nodes + at.node[k]];
                square[1] += v * (found - exact) * (found - exact);
                size[1] += v * exact * exact;
            }
    for (int k = 0; k < 2; k++) error[k] = sqrt(square[k] / size[k]);
    error[2] = own / size[0];
}

static void solve_made(const made *m, sn_element element, int n, double error[3]) {
    sn_case *c = body_block(1, 1, 1, n, n, n, &m->tissue, element);
    sn_fe_problem *p;
    sn_fe_newton newton;
    sn_fe_outcome out;
    body_support(c, "boundary", true, true, true);
    CHECK_OK(sn_fe_problem_create(c, 1, &p));
    CHECK_OK(sn_fe_newton_init(&newton, p, 1e-10));
    load_body(m, p);
    double *x = sn_alloc((size_t)p->space->dofs, sizeof *x);
    sn_fe_problem_begin(p, (sn_fe_level){1, 1, 1});
    for (int a = 0; a < p->space->nodes; a++)
        displacement(m, p->space->rest + 3 * a, p->prescribed + 3 * a);
    CHECK_OK(sn_fe_newton_solve(&newton, true, x, &out));
    if (!out.converged) print_message("%s\n", out.reason);
    assert_true(out.converged);
    errors(m, p, x, error);
    sn_free(x);
    sn_fe_newton_free(&newton);
    sn_fe_problem_destroy(p);
    sn_case_destroy(c);
}

// Order of the displacement's error 2 for P1, 3 for P2 and P2P1, and 2 for the pressure of P2P1
// (its error is that of the interpolation, which the strains of the quadratic cells share). Two
// meshes that are not yet in the limit: half an order below is allowed; above, a pressure that
// comes closer to its limit may be faster.
static void manufactured(void **state) {
    (void)state;
    for (int e = 0; e < 3; e++) {
        bool mixed = e == SN_ELEMENT_P2P1;
        made m = {.bulk = mixed ? 1e3 * MU : 3 * MU, .swell = mixed ? 1e-3 : 0.1};
        m.tissue = neo_hookean(MU, m.bulk);
        int n = e == SN_ELEMENT_P1 ? 4 : 3;
        double coarse[3], fine[3], expected = e == SN_ELEMENT_P1 ? 2 : 3;
        solve_made(&m, (sn_element)e, n, coarse);
        solve_made(&m, (sn_element)e, 2 * n, fine);
        double order = log2(coarse[0] / fine[0]), order_p = log2(coarse[1] / fine[1]);
        if (getenv("SINEW_SHOW"))
            print_message("element %d: %.2e %.2e, order %.2f\n", e, coarse[0], fine[0], order);
        CHECK_ABS(order, expected, 0.5);
        assert_true(fine[0] < 0.01);
        if (!mixed) continue;
        if (getenv("SINEW_SHOW"))
            print_message("pressure: %.2e %.2e, order %.2f\n", coarse[1], fine[1], order_p);
        assert_true(order_p > 1.5 && fine[1] < 0.1);
    }
}

// The error that two and three meshes state for the mean square of the displacement holds the true
// one, and is at most four times as large; for quadratic cells, whose order is 3 here and above
// where 2 is assumed, up to thirty-two times.
static void stated_error(void **state) {
    (void)state;
    for (int e = 0; e < 3; e++) {
        made m = {.bulk = e == SN_ELEMENT_P2P1 ? 1e3 * MU : 3 * MU,
                  .swell = e == SN_ELEMENT_P2P1 ? 1e-3 : 0.1};
        m.tissue = neo_hookean(MU, m.bulk);
        int most = e == SN_ELEMENT_P1 ? 3 : 2;
        sn_refined q = {0};
        for (int k = 0; k < most; k++) {
            double error[3];
            solve_made(&m, (sn_element)e, 2 << k, error);
            q.value[k] = error[2];
        }
        for (int meshes = 2; meshes <= most; meshes++) {
            sn_fe_extrapolate(&q, meshes, 1e-10);
            for (int k = 0; k < meshes; k++) {
                double part = q.error[k] / fabs(q.value[k] - 1);
                if (getenv("SINEW_SHOW"))
                    print_message("element %d, mesh %d of %d: %+.3f %%, stated over true %.2f\n", e,
                                  k + 1, meshes, 100 * (q.value[k] - 1), part);
                assert_true(part >= 1 && part <= (e == SN_ELEMENT_P1 ? 4 : 32));
            }
        }
    }
}

//---- torsion ------------------------------------------------------------------------------------

// Torque about the axis and push along it on the top of a twisted cylinder, ends rigid.
static void twist(int around, double R, double length, double angle, double *torque, double *push) {
    sn_tissue t = neo_hookean(MU, (double)INFINITY);
    sn_shape_def def = {.shape = SN_SHAPE_CYLINDER,
                        .radius = R,
                        .length = length,
                        .cells = {around / 6, around, around / 6}};
    sn_case *c = body_case(&def, &t, SN_ELEMENT_P2P1);
    body_support(c, "bottom", true, true, true);
    body_support(c, "top", true, true, true);
    sn_fe_problem *p;
    sn_fe_newton newton;
    sn_fe_outcome out;
    CHECK_OK(sn_fe_problem_create(c, 1, &p));
    CHECK_OK(sn_fe_newton_init(&newton, p, 1e-10));
    double *x = sn_alloc((size_t)p->space->dofs, sizeof *x);
    const double *rest = p->space->rest;
    *torque = *push = 0;
    for (int step = 1; step <= 3; step++) {
        double turn = angle * step / 3;
        sn_fe_problem_begin(p, (sn_fe_level){1, 1, 1});
        for (int a = 0; a < p->space->nodes; a++) {
            const double *X = rest + 3 * a;
            double by = turn * X[2] / length, *to = p->prescribed + 3 * a; // bottom: 0
            to[0] = cos(by) * X[0] - sin(by) * X[1] - X[0];
            to[1] = sin(by) * X[0] + cos(by) * X[1] - X[1];
            to[2] = 0;
        }
        CHECK_OK(sn_fe_newton_solve(&newton, true, x, &out));
        if (!out.converged) print_message("%s\n", out.reason);
        assert_true(out.converged);
    }
    for (int a = 0; a < p->space->nodes; a++) {
        const double *X = rest + 3 * a, *u = x + 3 * a, *f = p->residual + 3 * a;
        if (X[2] < length * (1 - 1e-9)) continue;
        *torque += (X[0] + u[0]) * f[1] - (X[1] + u[1]) * f[0];
        *push += f[2];
    }
    sn_free(x);
    sn_fe_newton_free(&newton);
    sn_fe_problem_destroy(p);
    sn_case_destroy(c);
}

// Rivlin: a neo-Hookean cylinder twisted by tau per length without change of length or radius needs
// the torque pi mu tau R^4/2 and is pushed at its ends by pi mu tau^2 R^4/4 (Poynting). Straight
// edges around cost about (2 pi/n)^2/3 of R^4: 9 % and 2.3 % for 12 and 24. The two meshes
// extrapolate by their order of 2, which leaves a fifth of the finer one's error of the torque and,
// as the push also feels the pressures of the coarse cells, up to all of that of the push.
static void torsion(void **state) {
    (void)state;
    const double R = 0.01, length = 0.012, angle = 0.6, tau = angle / length;
    double torque[2], push[2], pi = acos(-1);
    double moment = pi * MU * tau * pow(R, 4) / 2, force = -pi * MU * tau * tau * pow(R, 4) / 4;
    for (int k = 0; k < 2; k++) twist(12 << k, R, length, angle, torque + k, push + k);
    if (getenv("SINEW_SHOW"))
        print_message("torque %.4f %.4f, force %.4f %.4f of the closed form\n", torque[0] / moment,
                      torque[1] / moment, push[0] / force, push[1] / force);
    CHECK_REL(torque[1], moment, 0.04);
    CHECK_REL((4 * torque[1] - torque[0]) / 3, moment, 0.005);
    CHECK_REL((4 * push[1] - push[0]) / 3, force, 0.02);
}

//---- a thick tube -------------------------------------------------------------------------------

// The pressure that opens a tube of demiray's law, kept at its length: the integral over the wall
// of (sigma_tt - sigma_rr)/r = c exp(b (I1 - 3)) (l^2 - l^-2)/r, l = r/R, I1 = l^2 + l^-2 + 1.
static double tube_pressure(double c, double b, double Ri, double Ro, double ri) {
    double a = ri * ri - Ri * Ri, ro = sqrt(Ro * Ro + a), sum = 0;
    const int n = 2000; // the midpoint rule: (1/n)^2
    for (int k = 0; k < n; k++) {
        double r = ri + (ro - ri) * (k + 0.5) / n, square = r * r / (r * r - a);
        sum += c * exp(b * (square + 1 / square - 2)) * (square - 1 / square) / r;
    }
    return sum * (ro - ri) / n;
}

static double inner_radius(int around, double c, double b, double Ri, double Ro, double pressure) {
    sn_tissue t = demiray(c, b, (double)INFINITY);
    sn_shape_def def = {.shape = SN_SHAPE_TUBE,
                        .inner_radius = Ri,
                        .outer_radius = Ro,
                        .length = 2e-3,
                        .cells = {around / 6, around, 1}};
    sn_case *body = body_case(&def, &t, SN_ELEMENT_P2P1);
    body_support(body, "bottom", false, false, true);
    body_support(body, "top", false, false, true);
    body_press(body, "inner", pressure, make_ramp(0, 1));
    body_probe(body, "wall", Ri, 0, 1e-3);
    body->continuum.steps = 10;
    sn_run_summary summary;
    sn_record *r = body_run(body, NULL, &summary);
    double radius = Ri + last_value(r, "wall_ux");
    sn_record_destroy(r);
    sn_case_destroy(body);
    return radius;
}

// As for torsion: the order of the straight edges extrapolates two meshes.
static void exponential_tube(void **state) {
    (void)state;
    const double Ri = 5e-3, Ro = 8e-3, c = 9e3, b = 1.6, ri = 1.3 * Ri;
    double p = tube_pressure(c, b, Ri, Ro, ri), radius[2];
    for (int k = 0; k < 2; k++) radius[k] = inner_radius(12 << k, c, b, Ri, Ro, p);
    if (getenv("SINEW_SHOW"))
        print_message("radius %.5f %.5f of the closed form\n", radius[0] / ri, radius[1] / ri);
    CHECK_REL(radius[1], ri, 0.02);
    CHECK_REL((4 * radius[1] - radius[0]) / 3, ri, 0.004);
    assert_true(fabs(radius[1] - ri) < 0.5 * fabs(radius[0] - ri));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(manufactured),
                                       cmocka_unit_test(stated_error), cmocka_unit_test(torsion),
                                       cmocka_unit_test(exponential_tube)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
