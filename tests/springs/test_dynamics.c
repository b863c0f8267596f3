// Motion against closed forms: orders of accuracy, chains, waves, memory.
// SPDX-License-Identifier: Apache-2.0
#include "nets.h"

static const double pi = 3.14159265358979323846;

//---- one node ------------------------------------------------------------------------------------

/// A node among nodes that are held: m x'' + c x' + k x = 0.
typedef struct oscillator {
    sn_case *c;
    sn_net *net;
    int node;
    double omega, share; ///< mass of the node over that of the body
} oscillator;

// 3 x 3 block of the tangent at rest: node's own, or between two nodes; component dd
static double stiffness_at_rest(const sn_net *net, int row, int column, int d) {
    const size_t n = (size_t)net->nodes;
    double *u = sn_alloc(n * 4, sizeof *u), *x = sn_alloc(n * 3, sizeof *x);
    double *y = sn_alloc(n * 3, sizeof *y);
    sn_tangent *t = tangent_at(net, u);
    x[3 * column + d] = 1;
    sn_tangent_multiply(net, t, x, y);
    const double k = y[3 * row + d];
    sn_free(u);
    sn_free(x);
    sn_free(y);
    sn_tangent_destroy(t);
    return k;
}

// in units of its undamped motion: mass 2 zeta_m omega, stiffness 2 zeta_k / omega
static oscillator hang_node(sn_integrator integrator, sn_scheme scheme, double zeta_m,
                            double zeta_k) {
    oscillator o = {0};
    sn_tissue t = neo_hookean(3e3, 5e3);
    for (int turn = 0; turn < 2; turn++) {
        o.c = make_block((const double[]){0.02, 0.02, 0.02}, (const int[]){2, 2, 2},
                         SN_PATTERN_MIRRORED, &t);
        o.c->springs.rung = SN_RUNG_CENTRAL;
        o.c->springs.volume = false;
        o.c->springs.integrator = integrator;
        o.c->springs.scheme = scheme;
        o.c->springs.step = integrator == SN_INTEGRATOR_IMPLICIT ? 1 : 0;
        add_support(o.c, "boundary", "xyz");
        if (turn == 1) {
            o.c->springs.damping = 2 * zeta_m * o.omega / (1 - o.share);
            o.c->springs.stiffness_damping = 2 * zeta_k / o.omega;
        }
        CHECK_OK(sn_net_create(o.c, &o.net));
        if (turn == 1) break;
        double whole = 0;
        o.node = node_at(o.net, 0.01, 0.01, 0.01);
        for (int i = 0; i < o.net->nodes; i++) whole += o.net->mass[i];
        o.share = o.net->mass[o.node] / whole;
        o.omega = sqrt(stiffness_at_rest(o.net, o.node, o.node, 0) / o.net->mass[o.node]);
        sn_net_destroy(o.net);
        sn_case_destroy(o.c);
    }
    return o;
}

// error of the place after 0.8 periods in n steps, over the amplitude
static double oscillator_error(const oscillator *o, int n, double zeta) {
    sn_state *s;
    CHECK_OK(sn_state_create(o->net, &s));
    const double speed = 1e-7 * 0.01 * o->omega; // 1e-7 of an edge: as much nonlinearity
    const double until = 0.8 * 2 * pi / o->omega;
    ((double *)s->v)[4 * o->node] = speed;
    for (int k = 0; k < n; k++) {
        sn_step_info info = sn_state_step(o->net, s, until / n);
        CHECK_REL(info.step, until / n, 1e-12);
    }
    double damped = o->omega * sqrt(1 - zeta * zeta), x = ((double *)s->u)[4 * o->node];
    double exact = speed / damped * exp(-zeta * o->omega * s->time) * sin(damped * s->time);
    sn_state_destroy(s);
    return (x - exact) * o->omega / speed;
}

static void orders_of_accuracy(void **state) {
    (void)state;
    // explicit with damping by stiffness takes the rate of half a step ago: first order. Damping by
    // mass, where supports hold part of the rigid motion, is exact to damping^2 h: little at 0.005
    static const struct {
        sn_integrator integrator;
        sn_scheme scheme;
        double zeta_m, zeta_k, order, error;
    } all[] = {{SN_INTEGRATOR_EXPLICIT, 0, 0, 0, 2, 1e-4},
               {SN_INTEGRATOR_EXPLICIT, 0, 0.005, 0, 2, 1e-4},
               {SN_INTEGRATOR_EXPLICIT, 0, 0, 0.1, 1, 1e-2},
               {SN_INTEGRATOR_IMPLICIT, SN_SCHEME_BACKWARD_EULER, 0, 0, 1, 0.05},
               {SN_INTEGRATOR_IMPLICIT, SN_SCHEME_BACKWARD_EULER, 0.1, 0.05, 1, 0.05},
               {SN_INTEGRATOR_IMPLICIT, SN_SCHEME_BDF2, 0, 0, 2, 1e-3},
               {SN_INTEGRATOR_IMPLICIT, SN_SCHEME_BDF2, 0.1, 0, 2, 1e-3},
               {SN_INTEGRATOR_IMPLICIT, SN_SCHEME_BDF2, 0, 0.1, 2, 1e-3}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        oscillator o = hang_node(all[k].integrator, all[k].scheme, all[k].zeta_m, all[k].zeta_k);
        double zeta = all[k].zeta_m + all[k].zeta_k;
        double coarse = oscillator_error(&o, 400, zeta), fine = oscillator_error(&o, 800, zeta);
        // the next power of the step, 0.0125 in omega h, at a few times the weight
        CHECK_ABS(log2(fabs(coarse / fine)) - all[k].order, 0, 0.1);
        CHECK_ABS(fine, 0, all[k].error);
        assert_true(fabs(fine) > 1e-7); // of the steps, not of the reading
        sn_net_destroy(o.net);
        sn_case_destroy(o.c);
    }
}

//---- chains and waves ----------------------------------------------------------------------------

// Nodes in a row among held nodes, each tied to the next by k and to the rest by g:
// eigenfrequencies omega_p^2 = g/m + 4 k/m sin^2(p pi / (2 (n + 1))). A repeated Kuhn cut makes all
// nodes alike.
static void chain_frequencies(void **state) {
    (void)state;
    enum { LINKS = 8 };
    sn_tissue t = neo_hookean(3e3, 5e3);
    for (int p = 1; p < LINKS; p += 2) {
        sn_case *c = make_block((const double[]){0.02, 0.02, 0.02}, (const int[]){2, 2, LINKS},
                                SN_PATTERN_KUHN, &t);
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.volume = false;
        const double h = 0.02 / LINKS;
        add_support(c, "boundary", "xyz");
        // the row itself moves along z only: a surface of its nodes
        sn_surface *row = &c->mesh->surface[sn_mesh_surface(c->mesh, "left")];
        int *face = row->face;
        for (int k = 0; k < row->face_count * 3; k++) face[k] = 0;
        for (int i = 0, n = 0; i < c->mesh->node_count; i++) {
            const double *x = c->mesh->node + 3 * i;
            if (fabs(x[0] - 0.01) < 1e-9 && fabs(x[1] - 0.01) < 1e-9) face[n++] = i;
        }
        add_support(c, "left", "xy");
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        int first = node_at(net, 0.01, 0.01, h), next = node_at(net, 0.01, 0.01, 2 * h);
        double m = net->mass[first], k = -stiffness_at_rest(net, first, next, 2);
        double ground = stiffness_at_rest(net, first, first, 2) - 2 * k;
        assert_true(k > ground); // links rule, not what holds each node
        double half = sin(p * pi / (2 * LINKS)), omega = sqrt((ground + 4 * k * half * half) / m);
        for (int n = 1; n < LINKS; n++)
            ((double *)s->v)[4 * node_at(net, 0.01, 0.01, n * h) + 2] =
                1e-9 * omega * sin(p * pi * n / LINKS);
        enum { STEPS = 1000 };
        for (int n = 0; n < STEPS; n++) sn_state_step(net, s, 0.8 * 2 * pi / omega / STEPS);
        // (omega h)^2 / 24 over 0.8 periods: 8e-6, and 1e-7 of nonlinearity
        for (int n = 1; n < LINKS; n++)
            CHECK_ABS(((double *)s->u)[4 * node_at(net, 0.01, 0.01, n * h) + 2] / 1e-9,
                      sin(0.8 * 2 * pi) * sin(p * pi * n / LINKS), 2e-5);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A bar whose nodes move in one direction only, its left end pushed: the far end, free, goes twice
// as far when the wave arrives.
static double arrival(const double push[3], const char *held, sn_integrator integrator) {
    enum { LENGTH = 40 };
    const double ramp = 0.012;
    sn_tissue t = neo_hookean(3e3, 2e4);
    sn_case *c = make_block((const double[]){0.1, 0.005, 0.005}, (const int[]){LENGTH, 1, 1},
                            SN_PATTERN_MIRRORED, &t);
    const char *sides[] = {"front", "back", "bottom", "top"};
    c->springs.volume = false;
    c->springs.integrator = integrator;
    c->springs.step = integrator == SN_INTEGRATOR_IMPLICIT ? 2e-4 : 0;
    for (int k = 0; k < 4; k++) add_support(c, sides[k], held);
    add_load(c, SN_LOAD_DISPLACEMENT, "left", push[0], push[1], push[2], ramp);
    sn_net *net;
    sn_state *s;
    CHECK_OK(sn_net_create(c, &net));
    CHECK_OK(sn_state_create(net, &s));
    int tip = node_at(net, 0.1, 0, 0), d = push[0] != 0 ? 0 : 1;
    double crossing = NAN, before = 0, since = 0;
    while (s->time < 0.15) {
        sn_state_step(net, s, 2e-4);
        double now = ((double *)s->u)[4 * tip + d] - push[d]; // half of twice the push
        if (now > 0) {
            crossing = since + (s->time - since) * before / (before - now);
            break;
        }
        before = now;
        since = s->time;
    }
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
    return crossing - 0.5 * ramp;
}

static void waves_arrive_in_time(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        sn_integrator way = k ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_EXPLICIT;
        double P = arrival((const double[]){1e-6, 0, 0}, "yz", way);
        double S = arrival((const double[]){0, 1e-6, 0}, "xz", way);
        // the middle of a ramp of 24 (P) or 8 (S) cells' time: dispersion bends its ends
        CHECK_REL(P, 0.1 / sqrt((2e4 + 4.0 / 3.0 * 3e3) / 1000), 0.01);
        CHECK_REL(S, 0.1 / sqrt(3e3 / 1000), 0.01);
    }
}

//---- memory --------------------------------------------------------------------------------------

// integral of G(t - s) dT(lambda(s)) from 0 to t by the midpoint rule, lambda(0) = 1
typedef struct pull {
    const sn_history *factor;
    const sn_memory *memory;
    double B, along, whole2; ///< stretched part and whole of the squared rest length
    double stretch;          ///< of the body at factor 1
} pull;

static double tension(const pull *p, double t, double *lambda) {
    double factor;
    sn_history_at(p->factor, t, &factor);
    double a = 1 + (p->stretch - 1) * factor;
    *lambda = sqrt((p->along * a * a + p->whole2 - p->along) / p->whole2);
    return expm1(p->B * (*lambda - 1)) / p->B;
}

static double hereditary(const pull *p, double t) {
    enum { PARTS = 4000 };
    double sum = 0, lambda, before = tension(p, 0, &lambda);
    for (int k = 0; k < PARTS; k++) {
        double now = tension(p, t * (k + 1) / PARTS, &lambda);
        sum += sn_memory_relaxation(p->memory, t * (1 - (k + 0.5) / PARTS)) * (now - before);
        before = now;
    }
    return sum;
}

// Springs of a block whose nodes are all led along x, through ramp, hold and cycles: the force on
// its right side against the convolution of every spring.
static void springs_follow_the_convolution(void **state) {
    (void)state;
    const double time[] = {0, 0.2, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
    const double value[] = {0, 1, 1, 0.3, 1, 0.3, 1, 0};
    for (int k = 0; k < 2; k++) {
        sn_tissue t = make_tissue("exponential");
        CHECK_OK(sn_tissue_set(&t, "B", 8));
        CHECK_OK(sn_tissue_set(&t, "C", 1e4));
        t.poissons_ratio = 0.25;
        t.memory = prony(0.4, 0.05, 0.3, 0.5);
        sn_case *c = make_block((const double[]){0.02, 0.01, 0.01}, (const int[]){1, 1, 1},
                                SN_PATTERN_MIRRORED, &t);
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.volume = false;
        c->springs.integrator = k ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_EXPLICIT;
        c->springs.step = 1e-3;
        add_support(c, "boundary", "yz");
        add_support(c, "left", "x");
        sn_load *l = add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.004, 0, 0, 0);
        l->free[1] = l->free[2] = true;
        CHECK_OK(sn_history_create(1, 8, time, value, &l->factor));
        sn_net *net;
        sn_state *s;
        CHECK_OK(sn_net_create(c, &net));
        CHECK_OK(sn_state_create(net, &s));
        const double *edge = net->data[SN_DOUBLE].edge, *stiff = net->data[SN_DOUBLE].stiffness;
        double most = 0, worst = 0;
        for (int n = 1; n <= 1000; n++) {
            while (s->time < n * 1e-3 - 1e-12) sn_state_step(net, s, n * 1e-3 - s->time);
            double force = 0, expected = 0;
            if (n % 50) continue;
            for (int i = 0; i < net->nodes; i++)
                if (net->node_position[3 * i] > 0.01) force -= ((double *)s->now.f)[4 * i];
            for (int e = 0; e < net->spring_blocks * SN_BLOCK; e++) {
                double D[3], lambda;
                for (int d = 0; d < 3; d++)
                    D[d] = edge[(e / SN_BLOCK * 3 + d) * SN_BLOCK + e % SN_BLOCK];
                if (!(stiff[e] > 0) || fabs(D[0]) < 1e-9) continue;
                const pull p = {l->factor,
                                &t.memory,
                                net->region[0].exponent,
                                D[0] * D[0],
                                D[0] * D[0] + D[1] * D[1] + D[2] * D[2],
                                1.2};
                double stress = hereditary(&p, s->time), a;
                tension(&p, s->time, &lambda);
                sn_history_at(l->factor, s->time, &a);
                expected += stiff[e] * stress / lambda * fabs(D[0]) * (1 + 0.2 * a);
            }
            most = fmax(most, fabs(expected));
            worst = fmax(worst, fabs(force - expected));
        }
        // steps linear in T against a T that bends: (B dlambda)^2 / 12 a step of 7e-3, 4e-6, and
        // the quadrature's (dt / tau)^2 / 24
        CHECK_ABS(worst / most, 0, 2e-5);
        assert_true(worst / most > 1e-12);
        sn_state_destroy(s);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

// A block, light against its steps, under a sudden traction creeps by J(t).
static void block_creeps(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(3e3, 2e4);
    t.memory = prony(0.4, 0.05, 0.3, 0.5);
    t.density = 1e-4; // rings at 5e4 1/s
    sn_retardations J;
    CHECK_OK(sn_memory_creep(&t.memory, &J));
    sn_case *c = make_block((const double[]){0.02, 0.01, 0.01}, (const int[]){2, 1, 1},
                            SN_PATTERN_MIRRORED, &t);
    c->springs.integrator = SN_INTEGRATOR_IMPLICIT;
    c->springs.step = 1e-3;
    c->until = 1;
    add_support(c, "left", "x");
    add_support(c, "front", "y");
    add_support(c, "bottom", "z");
    add_load(c, SN_LOAD_TRACTION, "right", 0.01, 0, 0, 0);
    add_probe(c, "tip", SN_PROBE_POINT, NULL, 0.02, 0.01, 0.01);
    sn_run_summary summary;
    sn_record *r = run_case(c, &summary);
    const double *time = sn_record_values(r, "time"), *x = sn_record_values(r, "tip_ux");
    const double E = 9 * 2e4 * 3e3 / (3 * 2e4 + 3e3);
    for (int k = 1; k < r->rows; k++)
        // the load, there at once, is felt over the first step: half a step late. Then
        // (1e-3 / 0.05)^2 / 12 = 3e-5; strains of 1e-6
        CHECK_REL(x[k], 0.01 / E * 0.02 * sn_retardations_at(&J, time[k] - 5e-4), 5e-5);
    assert_int_equal(summary.cutbacks, 0);
    sn_record_destroy(r);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders_of_accuracy),   cmocka_unit_test(chain_frequencies),
        cmocka_unit_test(waves_arrive_in_time), cmocka_unit_test(springs_follow_the_convolution),
        cmocka_unit_test(block_creeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
