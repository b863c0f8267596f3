// Cuts: what is left is the body without the cells, and nothing is lost on the way.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"
#include "springs/net.h"

static const double size[3] = {0.06, 0.04, 0.04};
static const int cells[3] = {9, 7, 7}; // several tiles of every kind

/// What a test needs of one state.
typedef struct body {
    sn_case *c;
    sn_net *net;
    sn_state *s;
} body;

static body start(sn_case *c) {
    body b = {.c = c};
    CHECK_OK(sn_net_create(c, &b.net));
    CHECK_OK(sn_state_create(b.net, &b.s));
    return b;
}

static void end(body *b) {
    sn_state_destroy(b->s);
    sn_net_destroy(b->net);
    sn_case_destroy(b->c);
}

static void run_for(const body *b, double seconds) {
    for (double left = seconds; left > 1e-12;) left -= sn_state_step(b->net, b->s, left).step;
}

enum { KINDS = 6 }; // rungs, with volume and without

static void set_kind(sn_case *c, int kind) {
    c->springs.rung = (sn_rung)(kind / 2);
    c->springs.volume = kind % 2 == 0;
}

static void add_cut(sn_case *c, double at, const double low[3], const double high[3]) {
    c->cut = sn_resize(c->cut, (size_t)c->cut_count + 1, sizeof *c->cut);
    c->cut[c->cut_count++] = (sn_cut_def){.at = at,
                                          .kind = SN_CUT_BOX,
                                          .low = {low[0], low[1], low[2]},
                                          .high = {high[0], high[1], high[2]}};
}

// every fifth cell or so, and all around one node
static int some_cells(const sn_mesh *mesh, bool *removed, int *list) {
    int count = 0;
    uint64_t seed = 11;
    for (int e = 0; e < mesh->cell_count; e++) {
        const int *node = mesh->cell + 4 * e, lone = mesh->node_count / 3;
        const bool around =
            node[0] == lone || node[1] == lone || node[2] == lone || node[3] == lone;
        removed[e] = check_random(&seed, 0, 1) < 0.2 || around;
        if (removed[e]) list[count++] = e;
    }
    return count;
}

//---- forces --------------------------------------------------------------------------------------

// forces and energy at displacements of the nodes of the mesh, without those of the state
static double forces_at(const sn_net *net, const sn_parts *parts, sn_precision precision,
                        const double *u, double *f) {
    const size_t nodes = (size_t)net->nodes, points = (size_t)net->point_blocks * SN_BLOCK;
    sn_scratch scratch = {0};
    sn_fields *fields;
    double *own = sn_alloc(nodes * 4, sizeof *own), *pressure = sn_alloc(points, sizeof *pressure);
    void *at = sn_alloc(nodes * 4, sizeof(double));
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            own[4 * i + d] = u[3 * net->node_name[i] + d];
            sn_real_put(precision, at, (size_t)(4 * i + d), own[4 * i + d]);
        }
    CHECK_OK(sn_scratch_create(net, precision, &scratch));
    const sn_force_call call = {
        .precision = precision, .mode = SN_MEMORY_OFF, .u = at, .parts = parts, .out = &scratch};
    sn_net_forces(net, &call);
    for (int i = 0; i < net->nodes; i++)
        for (int d = 0; d < 3; d++)
            f[3 * net->node_name[i] + d] = sn_real_at(precision, scratch.f, (size_t)(4 * i + d));
    CHECK_OK(sn_fields_create(net, &fields));
    const sn_moment m = {.precision = SN_DOUBLE, .u = own, .pressure = pressure, .parts = parts};
    sn_fields_fill(net, fields, &m);
    const double energy = sn_fields_elastic(net, fields);
    sn_fields_destroy(fields);
    sn_scratch_destroy(&scratch);
    sn_free(own);
    sn_free(pressure);
    sn_free(at);
    return energy;
}

static double largest(const double *x, int count) {
    double most = 0;
    for (int k = 0; k < count; k++) most = fmax(most, fabs(x[k]));
    return most;
}

// two tissues in a body whose cells are all different, or (classes) in one whose springs have class
// constants
static sn_case *make_body(int kind, bool classes, sn_precision precision) {
    sn_tissue t = demiray(2e3, 4, 4e4);
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    if (!classes) jitter(c, 0.12, 5);
    c->mesh->region_count = 2;
    c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
    snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
    for (int e = 0; e < c->mesh->cell_count; e++)
        c->mesh->region[e] = c->mesh->node[3 * c->mesh->cell[4 * e]] > 0.031;
    c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
    c->tissue[1] = demiray(4e3, 3, 6e4);
    c->springs.precision = precision;
    c->springs.cuttable = true;
    set_kind(c, kind);
    return c;
}

static int spring_end(const sn_net *net, int slot, int end) {
    return net
        ->node_name[net->spring_end[(slot / SN_BLOCK * 2 + end) * SN_BLOCK + slot % SN_BLOCK]];
}

// Off lattices the springs of a region have a common scale, which follows from the whole mesh:
// gives those of `other`, the net of the rest, the scale that they had in `net`. A spring that lost
// no cell shows it; one that did has less of its stiffness in `other`.
static void take_scale(const sn_net *net, const int *name, sn_net *other) {
    const double *k = net->data[SN_DOUBLE].stiffness, *l = other->data[SN_DOUBLE].stiffness;
    double *scaled = sn_alloc((size_t)other->springs, sizeof *scaled);
    int count = 0;
    for (int r = 0; r < other->region_count; r++) {
        const sn_net_region *g = &net->region[r], *h = &other->region[r];
        const int first = h->spring_block * SN_BLOCK, last = first + h->spring_blocks * SN_BLOCK;
        double scale = INFINITY;
        for (int j = first; j < last; j++)
            for (int i = g->spring_block * SN_BLOCK;
                 i < (g->spring_block + g->spring_blocks) * SN_BLOCK; i++)
                if (other->spring_volume[j] > 0 && net->spring_volume[i] > 0 &&
                    spring_end(net, i, 0) == name[spring_end(other, j, 0)] &&
                    spring_end(net, i, 1) == name[spring_end(other, j, 1)])
                    scale = fmin(scale, k[i] / l[j]);
        for (int j = first; j < last; j++)
            if (other->spring_volume[j] > 0) scaled[count++] = scale * l[j];
    }
    assert_int_equal(count, other->springs);
    CHECK_OK(sn_net_set_spring_stiffness(other, scaled));
    sn_free(scaled);
}

// Cut at rest, a net has the forces and the energy of a net of the mesh without the cells.
static void what_is_left_is_the_rest(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS + 2; k++) {
        const bool classes = k >= 2 * KINDS;
        const sn_precision precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        body b = start(make_body(classes ? 0 : k / 2, classes, precision));
        const sn_mesh *mesh = b.c->mesh;
        const size_t nodes = (size_t)mesh->node_count;
        bool *removed = sn_alloc((size_t)mesh->cell_count, sizeof *removed);
        int *list = sn_alloc((size_t)mesh->cell_count, sizeof *list), *name, taken;
        const int count = some_cells(mesh, removed, list);
        name = sn_alloc(nodes, sizeof *name);
        sn_mesh *left;
        CHECK_OK(sn_mesh_without(mesh, removed, &left, name));
        assert_int_equal(left->cell_count, mesh->cell_count - count);
        assert_true(left->node_count < mesh->node_count);
        sn_case *rest = b.c; // tissues and settings of the same case
        sn_mesh *whole = rest->mesh;
        rest->mesh = left;
        sn_net *other;
        CHECK_OK(sn_net_create(rest, &other));
        rest->mesh = whole;
        if (other->springs > 0 && !classes) take_scale(b.net, name, other);

        CHECK_OK(sn_state_cut(b.net, b.s, count / 2, list, &taken));
        assert_int_equal(taken, count / 2);
        CHECK_OK(sn_state_cut(b.net, b.s, count, list, &taken));
        assert_int_equal(taken, count - count / 2);
        double *u = sn_alloc(nodes * 3, sizeof *u), *v = sn_alloc(nodes * 3, sizeof *v);
        double *f = sn_alloc(nodes * 3, sizeof *f), *g = sn_alloc(nodes * 3, sizeof *g);
        double *h = sn_alloc(nodes * 3, sizeof *h);
        uint64_t seed = 3;
        for (size_t i = 0; i < 3 * nodes; i++)
            u[i] = 0.1 * (double)(i % 3 + 1) * mesh->node[i] + check_random(&seed, -4e-4, 4e-4);
        for (int i = 0; i < left->node_count; i++) memcpy(v + 3 * i, u + 3 * name[i], 24);
        const sn_parts *parts = sn_state_parts(b.s);
        const double e1 = forces_at(b.net, parts, precision, u, f);
        const double e2 = forces_at(other, NULL, precision, v, g);
        const double e3 = forces_at(b.net, NULL, precision, u, h);
        // sums of a few dozen terms in another order
        const double scale = largest(g, 3 * left->node_count);
        const double tolerance = precision == SN_DOUBLE ? 1e-13 : 2e-5;
        for (int i = 0; i < left->node_count; i++)
            for (int d = 0; d < 3; d++)
                CHECK_ABS(f[3 * name[i] + d], g[3 * i + d], tolerance * scale);
        CHECK_REL(e1, e2, 1e-12);
        double apart = 0;
        int loose = 0;
        for (size_t i = 0; i < nodes; i++) {
            const bool alone = sn_state_is_loose(b.net, b.s, (int)i);
            loose += alone;
            for (size_t d = 0; d < 3; d++) {
                if (alone) assert_true(f[3 * i + d] == 0);
                apart = fmax(apart, fabs(f[3 * i + d] - h[3 * i + d]));
            }
        }
        assert_int_equal(loose, mesh->node_count - left->node_count);
        assert_true(apart > 0.05 * scale && e3 > 1.05 * e1);
        for (int e = 0; e < mesh->cell_count; e++)
            assert_int_equal(sn_state_is_cut(b.net, b.s, e), removed[e]);
        void *all[] = {removed, list, name, u, v, f, g, h};
        for (size_t n = 0; n < sizeof all / sizeof *all; n++) sn_free(all[n]);
        sn_mesh_destroy(left);
        sn_net_destroy(other);
        end(&b);
    }
}

//---- motion --------------------------------------------------------------------------------------

// clamped at its left, pulled down; a slot is cut into it from above
static sn_case *hanging(int kind, double at) {
    static const int few[3] = {6, 3, 3};
    static const double low[3] = {0.018, -1, 0.012}, high[3] = {0.032, 1, 1};
    sn_tissue t = neo_hookean(1e4, 5e4);
    sn_case *c = make_block(size, few, SN_PATTERN_MIRRORED, &t);
    set_kind(c, kind);
    c->gravity[2] = -9.81;
    add_support(c, "left", "xyz");
    add_cut(c, at, low, high);
    c->until = 0.1;
    c->output_every = 0.02;
    return c;
}

static sn_run_summary run_quietly(const sn_case *c, sn_record **energy) {
    sn_record *history;
    sn_run_summary summary;
    sn_output output = {0};
    CHECK_OK(sn_record_create("e", energy));
    CHECK_OK(sn_record_create("h", &history));
    output.energy = *energy;
    CHECK_OK(sn_springs_run(c, &output, &summary, history));
    assert_true(summary.converged);
    sn_record_destroy(history);
    return summary;
}

// The residual of the explicit run is of second order in the step with the cut as without: what a
// ledger that misses some of it would lack does not depend on the step.
static void the_ledger_balances(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        double residual[2][2];
        for (int cut = 0; cut < 2; cut++)
            for (int half = 0; half < 2; half++) {
                sn_case *c = hanging(k, 0.041);
                if (!cut) c->cut_count = 0;
                c->springs.step = half ? 1e-4 : 2e-4;
                sn_record *energy;
                const sn_run_summary s = run_quietly(c, &energy);
                residual[cut][half] = s.energy_residual;
                assert_int_equal(s.cells_removed, cut ? 36 : 0);
                assert_true((double)s.steps < 1.01 * c->until / c->springs.step + 20);
                if (cut) {
                    assert_true(s.released_J > 1e-3 * s.elastic_J);
                    CHECK_REL(s.dissipated_J, s.released_J, 1e-12);
                    const double *lost = sn_record_values(energy, "dissipated_energy");
                    assert_true(lost[2] == 0); // at 40 ms
                    CHECK_REL(lost[3], s.released_J, 1e-12);
                }
                sn_record_destroy(energy);
                c->cut_count = 1;
                sn_case_destroy(c);
            }
        printf("residual without %.3g %.3g with a cut %.3g %.3g\n", residual[0][0], residual[0][1],
               residual[1][0], residual[1][1]);
        // a quarter, but for what is left of the fourth order and of output times
        assert_true(residual[1][1] < 0.35 * residual[1][0] || residual[1][1] < 1e-7);
        assert_true(residual[1][1] < 20 * residual[0][1]);
    }
}

// With memory and damping, by all integrators.
static void ledgers_of_all_kinds(void **state) {
    (void)state;
    for (int k = 0; k < 3 * 4; k++) {
        static const int kinds[4] = {0, 2, 3, 4};
        const sn_integrator integrator = (sn_integrator)(k / 4);
        double residual[2];
        for (int half = 0; half < 2; half++) {
            sn_case *c = hanging(kinds[k % 4], 0.041);
            c->tissue[0].memory = prony(0.3, 0.01, 0.2, 0.2);
            c->springs.integrator = integrator;
            c->springs.step = (integrator == SN_INTEGRATOR_EXPLICIT ? 2e-4 : 2e-3) / (1 + half);
            if (integrator != SN_INTEGRATOR_QUASI_STATIC) c->springs.damping = 20;
            if (integrator != SN_INTEGRATOR_QUASI_STATIC) c->springs.stiffness_damping = 1e-4;
            if (integrator == SN_INTEGRATOR_QUASI_STATIC) c->gravity[2] = -3;
            sn_record *energy;
            const sn_run_summary s = run_quietly(c, &energy);
            residual[half] = s.energy_residual;
            assert_int_equal(s.cells_removed, 36);
            assert_true(s.released_J > 0 && s.dissipated_J > s.released_J);
            // nothing comes back, but for the trapezoidal rule
            const double *lost = sn_record_values(energy, "dissipated_energy");
            for (int n = 1; n < energy->rows; n++)
                assert_true(lost[n] > lost[n - 1] - 1e-3 * lost[energy->rows - 1]);
            assert_true(lost[3] - lost[2] > 0.99 * s.released_J);
            sn_record_destroy(energy);
            sn_case_destroy(c);
        }
        printf("integrator %d kind %d: residual %.3g, of half the step %.3g\n", k / 4, kinds[k % 4],
               residual[0], residual[1]);
        // of second order, the implicit step after a cut (backward Euler) of first; in equilibrium
        // there is none by definition: see below
        if (integrator != SN_INTEGRATOR_QUASI_STATIC)
            assert_true(residual[1] <
                        (integrator == SN_INTEGRATOR_EXPLICIT ? 0.35 : 0.6) * residual[0]);
    }
}

// The body at equilibrium after a cut is where it would be had it never had the cells.
static void equilibrium_forgets_the_cut(void **state) {
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        double place[2];
        for (int early = 0; early < 2; early++) {
            sn_case *c = hanging(k, early ? 0 : 0.05);
            c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
            c->gravity[2] = -3; // of central springs alone more is too much
            add_probe(c, "tip", SN_PROBE_POINT, NULL, 0.06, 0.02, 0);
            sn_run_summary s;
            sn_record *history, *energy;
            CHECK_OK(sn_record_create("h", &history));
            CHECK_OK(sn_record_create("e", &energy));
            CHECK_OK(sn_springs_run(c, &(sn_output){.energy = energy}, &s, history));
            assert_true(s.converged && s.released_J > 0);
            place[early] = last_value(history, "tip_uz");
            // the trapezoidal rule leaves some at the start, the cut adds none
            const double *residual = sn_record_values(energy, "energy_residual");
            CHECK_ABS(residual[5], residual[0], 1e-9 * s.external_work_J);
            sn_record_destroy(history);
            sn_record_destroy(energy);
            sn_case_destroy(c);
        }
        CHECK_REL(place[0], place[1], 1e-7);
    }
}

// momentum at the present place: velocities are half a step behind
static void momentum(const body *b, double sum[4]) {
    sum[0] = sum[1] = sum[2] = sum[3] = 0;
    for (int i = 0; i < b->net->nodes; i++)
        for (int d = 0; d < 3; d++) {
            const size_t at = (size_t)(4 * i + d);
            const double m = b->net->mass[i], f = sn_real_at(b->s->precision, b->s->now.f, at);
            const double p =
                m * sn_real_at(b->s->precision, b->s->v, at) + 0.5 * b->s->last_step * f;
            sum[d] += p;
            sum[3] += fabs(p);
        }
}

static void cuts_take_no_momentum(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        const sn_precision precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        sn_case *c = make_body(k / 2, false, precision);
        c->tissue[0].memory = prony(0.3, 0.01, 0.2, 0.2);
        c->springs.stiffness_damping = 1e-5;
        body b = start(c);
        for (int i = 0; i < 40; i++)
            CHECK_OK(sn_state_push(b.net, b.s, 7 * i % b.net->nodes,
                                   (const double[]){1e-3 * i, 1e-3, -2e-3 * (i % 5)}));
        run_for(&b, 4e-3);
        bool *removed = sn_alloc((size_t)b.net->cells, sizeof *removed);
        int *list = sn_alloc((size_t)b.net->cells, sizeof *list);
        const int count = some_cells(c->mesh, removed, list);
        double before[4], after[4];
        momentum(&b, before);
        CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL));
        momentum(&b, after);
        for (int d = 0; d < 3; d++) // the rounding of 500 nodes
            CHECK_ABS(after[d], before[d], (precision == SN_DOUBLE ? 1e-14 : 1e-6) * before[3]);
        run_for(&b, 4e-3);
        assert_false(b.s->broken);
        sn_free(removed);
        sn_free(list);
        end(&b);
    }
}

//---- a bar in two --------------------------------------------------------------------------------

static double mean_of(const body *b, const void *array, bool right, int d) {
    double mass = 0, sum = 0;
    for (int i = 0; i < b->net->nodes; i++) {
        if ((b->net->node_position[3 * i] > 0.029) != right) continue;
        mass += b->net->mass[i];
        sum += b->net->mass[i] * sn_real_at(b->s->precision, array, (size_t)(4 * i + d));
    }
    return sum / mass;
}

// The loose part falls as a stone does, with damping by mass too; the other one swings.
static void a_bar_in_two(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        sn_case *c = hanging(k / 2, 1);
        c->cut_count = 0;
        c->springs.cuttable = true;
        c->springs.damping = k % 2 ? 30 : 0;
        c->springs.integrator =
            k % 2 == 0 && k / 2 % 2 ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_EXPLICIT;
        body b = start(c);
        run_for(&b, 0.03);
        c->cut_count = 1;
        memcpy(c->cut[0].low, (const double[3]){0.02, -1, -1}, 24);
        memcpy(c->cut[0].high, (const double[3]){0.03, 1, 1}, 24);
        int *list, count;
        CHECK_OK(sn_case_cut_cells(c, 0, &list, &count));
        assert_int_equal(count, 54);
        CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL));
        sn_free(list);
        int pieces;
        assert_non_null(sn_state_pieces(b.s, &pieces));
        assert_int_equal(pieces, 2);
        const double behind = b.s->implicit ? 0 : 0.5 * b.s->last_step, fall = 0.05;
        const double v = mean_of(&b, b.s->v, true, 2) - 9.81 * behind;
        const double u = mean_of(&b, b.s->u, true, 2), u0 = mean_of(&b, b.s->u, false, 2);
        const double t0 = b.s->time;
        double lowest = u0, highest = u0;
        while (b.s->time < t0 + fall - 1e-9) {
            sn_state_step(b.net, b.s, t0 + fall - b.s->time);
            lowest = fmin(lowest, mean_of(&b, b.s->u, false, 2));
            highest = fmax(highest, mean_of(&b, b.s->u, false, 2));
        }
        const double t = b.s->time - t0, way = mean_of(&b, b.s->u, true, 2) - u;
        // BDF2 starts the fall with a step of first order: 9.81 h^2 or so
        CHECK_ABS(way, v * t - 0.5 * 9.81 * t * t, b.s->implicit ? 2e-5 : 1e-9);
        assert_true(way < -0.01);
        assert_true(highest > u0 + 1e-5 && highest - lowest < 0.01); // it springs back
        assert_false(b.s->broken);
        end(&b);
    }
}

//---- all of it -----------------------------------------------------------------------------------

static void check_finite(const body *b) {
    for (int i = 0; i < 4 * b->net->nodes; i++) {
        assert_true(isfinite(sn_real_at(b->s->precision, b->s->u, (size_t)i)));
        assert_true(isfinite(sn_real_at(b->s->precision, b->s->v, (size_t)i)));
        assert_true(isfinite(sn_real_at(b->s->precision, b->s->now.f, (size_t)i)));
    }
}

// Every cell removed, one by one in the end: dust that falls. Debris is no load on the step.
static void nothing_left(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        sn_tissue t = demiray(2e3, 60, 4e4); // overflows where a cell is drawn to many lengths
        t.memory = prony(0.3, 0.01, 0.2, 0.2);
        sn_case *c = make_block(size, (const int[]){4, 3, 3}, SN_PATTERN_MIRRORED, &t);
        set_kind(c, k / 2);
        c->springs.precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        c->springs.cuttable = true;
        c->springs.damping = 5;
        c->gravity[2] = -9.81;
        add_support(c, "left", "xyz");
        add_load(c, SN_LOAD_TRACTION, "right", 50, 0, 0, 0);
        add_load(c, SN_LOAD_PRESSURE, "top", 0, 0, 0, 0)->pressure = 50;
        body b = start(c);
        run_for(&b, 2e-3);
        const double step = b.s->last_step;
        sn_state_reset(b.net, b.s);
        for (int e = 0; e < b.net->cells; e++) {
            CHECK_OK(sn_state_cut(b.net, b.s, 1, &e, NULL));
            if (e % 16 == 0) run_for(&b, 1e-4);
        }
        assert_int_equal(sn_state_removed(b.s), b.net->cells);
        for (int i = 0; i < b.net->nodes; i++) assert_true(sn_state_is_loose(b.net, b.s, i));
        run_for(&b, 0.3);
        check_finite(&b);
        assert_int_equal(b.s->warnings, 0);
        assert_true(b.s->last_step > 0.5 * step || b.s->last_step > 1e-4);
        double lowest = 0;
        for (int i = 0; i < b.net->nodes; i++)
            lowest = fmin(lowest, sn_real_at(b.s->precision, b.s->u, (size_t)(4 * i + 2)));
        assert_true(lowest < -0.4); // 44 cm in 0.3 s

        // a reset mends it
        sn_state_reset(b.net, b.s);
        assert_null(sn_state_parts(b.s));
        body fresh = start(b.c);
        run_for(&b, 5e-3);
        run_for(&fresh, 5e-3);
        const size_t bytes = (size_t)b.net->nodes * 4 * (k % 2 ? 4 : 8);
        assert_memory_equal(b.s->u, fresh.s->u, bytes);
        sn_state_destroy(fresh.s);
        sn_net_destroy(fresh.net);
        end(&b);
    }
}

// The same through runs, of all integrators.
static void runs_of_dust(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_case *c = hanging(2 * k, 0.03);
        memcpy(c->cut[0].low, (const double[3]){-1, -1, -1}, 24);
        c->cut[0].high[0] = 1;
        c->springs.integrator = (sn_integrator)k;
        sn_record *energy;
        const sn_run_summary s = run_quietly(c, &energy);
        assert_int_equal(s.cells_removed, s.cells);
        assert_true(s.elastic_J == 0);
        CHECK_ABS(s.energy_residual, 0, 0.02);
        sn_record_destroy(energy);
        sn_case_destroy(c);
    }
}

// A piece that nothing holds has no equilibrium, which a quasi-static run says.
static void loose_pieces_have_no_equilibrium(void **state) {
    (void)state;
    sn_case *c = hanging(2, 0.03);
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    memcpy(c->cut[0].low, (const double[3]){0.02, -1, -1}, 24);
    sn_run_summary s;
    sn_record *history = run_case(c, &s);
    assert_false(s.converged);
    assert_non_null(strstr(s.reason, "a piece that no support"));
    assert_non_null(strstr(s.reason, "explicit or implicit"));
    sn_record_destroy(history);
    sn_case_destroy(c);
}

//---- loads and tools -----------------------------------------------------------------------------

static double sum_ext(const body *b, int d) {
    double sum = 0;
    for (int i = 0; i < b->net->nodes; i++) sum += b->s->ext[3 * i + d];
    return sum;
}

static void loads_end_with_their_faces(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_tissue t = neo_hookean(1e4, 5e4);
        sn_case *c = make_block(size, (const int[]){4, 4, 4}, SN_PATTERN_MIRRORED, &t);
        c->springs.cuttable = true;
        add_support(c, "bottom", "xyz");
        sn_load *l = add_load(c, (sn_load_kind)(SN_LOAD_TRACTION + k), "top", 0, 0, 100, 0);
        l->pressure = -100;
        memcpy(l->point, (const double[3]){0.01, 0.02, 0.04}, 24);
        add_cut(c, 0, (const double[3]){-1, -1, 0.03}, (const double[3]){0.03, 1, 1});
        body b = start(c);
        run_for(&b, 1e-6);
        const double all = k == 2 ? 100 : 100 * size[0] * size[1];
        CHECK_REL(sum_ext(&b, 2), all, 1e-5); // the pressure follows
        int *list, count;
        CHECK_OK(sn_case_cut_cells(c, 0, &list, &count));
        CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL)); // the left half of the top
        CHECK_ABS(sum_ext(&b, 2), k == 2 ? 0 : all / 2, 1e-5 * all);
        sn_free(list);
        end(&b);
    }
}

// A plane that comes down on a body without its upper half meets the new surface.
static void tools_touch_the_new_surface(void **state) {
    (void)state;
    for (int k = 0; k < 4; k++) {
        sn_tissue t = neo_hookean(1e4, 5e4);
        sn_case *c = make_block(size, (const int[]){4, 4, 4}, SN_PATTERN_MIRRORED, &t);
        c->springs.cuttable = true;
        c->springs.integrator = k == 3 ? SN_INTEGRATOR_IMPLICIT : SN_INTEGRATOR_EXPLICIT;
        c->springs.damping = 200;
        add_support(c, "bottom", "xyz");
        add_tool(c, "plate", 0, (const double[]){0.03, 0.02, 0.041}, (const double[]){0, 0, 0}, 1);
        c->tool[0].kind = SN_TOOL_PLANE;
        c->tool[0].axis[2] = -1;
        add_cut(c, 0, (const double[3]){-1, -1, 0.02}, (const double[3]){1, 1, 1});
        body b = start(c);
        int *list, count;
        double force[3];
        CHECK_OK(sn_case_cut_cells(c, 0, &list, &count));
        if (k > 0) CHECK_OK(sn_state_cut(b.net, b.s, count, list, NULL));
        const sn_pose pose = sn_pose_at((const double[]){0.03, 0.02, k == 1 ? 0.0205 : 0.019});
        sn_state_set_tool(b.net, b.s, 0, &pose);
        run_for(&b, 0.05);
        sn_state_tool_force(b.net, b.s, 0, force);
        // dust above stays where it is, and is not pushed; half a cell is far away
        if (k == 1) assert_true(force[2] == 0);
        // 1 mm of 20 mm with the sides free, E = 27 kPa: 3.3 N; held below a little more
        if (k > 1) assert_true(force[2] > 2.5 && force[2] < 4.5);
        for (int i = 0; i < b.net->nodes; i++)
            if (sn_state_is_loose(b.net, b.s, i)) {
                assert_true(k > 0);
                assert_true(
                    sn_real_at(b.s->precision, b.s->u, 4 * (size_t)b.net->node_place[i] + 2) == 0);
            }
        if (k == 2) { // grasps leave loose nodes
            const int held = sn_state_grasp(b.net, b.s, 0, 0, NULL);
            assert_true(held > 0);
            for (int i = 0; i < b.net->nodes; i++)
                if (sn_state_is_loose(b.net, b.s, i))
                    assert_int_equal(sn_state_grasp(b.net, b.s, 0, 1, &i), held);
            for (int e = 0; e < b.net->cells; e++) CHECK_OK(sn_state_cut(b.net, b.s, 1, &e, NULL));
            assert_int_equal(sn_state_grasp(b.net, b.s, 0, 0, NULL), 0);
        }
        sn_free(list);
        end(&b);
    }
}

//---- bits ----------------------------------------------------------------------------------------

// The same with two threads as with one; bytes saved right after a cut bring the state back.
static void cuts_keep_bits(void **state) {
    (void)state;
    for (int k = 0; k < 2 * KINDS; k++) {
        const sn_precision precision = k % 2 ? SN_SINGLE : SN_DOUBLE;
        body b[3];
        bool *removed = NULL;
        int *list = NULL, count = 0;
        for (int n = 0; n < 3; n++) {
            sn_case *c = make_body(k / 2, false, precision);
            c->tissue[1].memory = prony(0.3, 0.01, 0.2, 0.2);
            c->springs.threads = n == 1 ? 2 : 1;
            c->springs.damping = 10;
            c->gravity[0] = 9.81;
            add_support(c, "bottom", "xyz");
            b[n] = start(c);
            if (n == 2) continue;
            if (n == 0) {
                removed = sn_alloc((size_t)c->mesh->cell_count, sizeof *removed);
                list = sn_alloc((size_t)c->mesh->cell_count, sizeof *list);
                count = some_cells(c->mesh, removed, list);
            }
            run_for(&b[n], 3e-3);
            CHECK_OK(sn_state_cut(b[n].net, b[n].s, count, list, NULL));
            const size_t bytes = sn_state_size(b[n].net, b[n].s);
            unsigned char *saved = malloc(bytes);
            sn_state_save(b[n].net, b[n].s, saved);
            run_for(&b[n], 3e-3);
            unsigned char *later = malloc(bytes), *again = malloc(bytes);
            sn_state_save(b[n].net, b[n].s, later);
            CHECK_OK(sn_state_load(b[n].net, b[n].s, saved, bytes));
            run_for(&b[n], 3e-3);
            sn_state_save(b[n].net, b[n].s, again);
            assert_memory_equal(again, later, bytes);
            if (n == 0) { // into a state that was never cut
                CHECK_OK(sn_state_load(b[0].net, b[0].s, saved, bytes));
                sn_state_reset(b[0].net, b[0].s);
                CHECK_OK(sn_state_load(b[0].net, b[0].s, saved, bytes));
                run_for(&b[0], 3e-3);
                sn_state_save(b[0].net, b[0].s, again);
                assert_memory_equal(again, later, bytes);
            }
            free(saved);
            free(later);
            free(again);
        }
        const size_t bytes = (size_t)b[0].net->nodes * 4 * (k % 2 ? 4 : 8);
        assert_memory_equal(b[0].s->u, b[1].s->u, bytes);
        assert_memory_equal(b[0].s->v, b[1].s->v, bytes);
        run_for(&b[2], 6e-3);
        assert_true(memcmp(b[0].s->u, b[2].s->u, bytes) != 0);
        sn_free(removed);
        sn_free(list);
        for (int n = 0; n < 3; n++) end(&b[n]);
    }
}

/// The bytes of a run after one of its outputs.
typedef struct keeper {
    int left;
    unsigned char *bytes;
    size_t size;
} keeper;

static sn_status keep(void *context, const void *bytes, size_t count) {
    keeper *k = context;
    k->bytes = realloc(k->bytes, count);
    memcpy(k->bytes, bytes, count);
    k->size = count;
    return --k->left == 0 ? sn_fail(SN_E_STOPPED, "killed") : SN_OK;
}

// Cuts at an output and between two; stopped after each output in turn, a run ends the same.
static void cut_runs_go_on(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        sn_case *c = hanging(2 * k, 0.04);
        c->springs.integrator = (sn_integrator)k;
        c->tissue[0].memory = prony(0.3, 0.01, 0.2, 0.2);
        add_cut(c, 0.03, (const double[3]){0.04, -1, -1}, (const double[3]){0.05, 0.015, 0.025});
        sn_record *a, *b;
        sn_run_summary first, second;
        CHECK_OK(sn_record_create("a", &a));
        CHECK_OK(sn_springs_run(c, NULL, &first, a));
        assert_true(first.converged && first.cells_removed > 36);
        for (int stop = 1; stop <= 4; stop++) {
            keeper part = {.left = stop};
            sn_restart point = {.context = &part, .save = keep};
            CHECK_OK(sn_record_create("b", &b));
            CHECK_FAILS(sn_springs_resume(c, NULL, &point, &second, b), SN_E_STOPPED, "killed");
            sn_record_destroy(b);
            unsigned char *from = malloc(part.size);
            memcpy(from, part.bytes, part.size);
            point.state = from;
            point.bytes = part.size;
            CHECK_OK(sn_record_create("b", &b));
            CHECK_OK(sn_springs_resume(c, NULL, &point, &second, b));
            assert_true(first.kinetic_J == second.kinetic_J && first.elastic_J == second.elastic_J);
            assert_true(first.released_J == second.released_J);
            assert_true(first.energy_residual == second.energy_residual);
            assert_int_equal(first.cells_removed, second.cells_removed);
            sn_record_destroy(b);
            // another time of a cut is another case
            c->cut[1].at = 0.031;
            CHECK_OK(sn_record_create("b", &b));
            CHECK_FAILS(sn_springs_resume(c, NULL, &point, &second, b), SN_E_DEFINITION,
                        "another net");
            c->cut[1].at = 0.03;
            sn_record_destroy(b);
            free(part.bytes);
            free(from);
        }
        sn_record_destroy(a);
        sn_case_destroy(c);
    }
}

// A net with other constants takes up what was cut.
static void moved_states_stay_cut(void **state) {
    (void)state;
    body b = start(make_body(0, false, SN_DOUBLE));
    sn_net *other, *whole;
    CHECK_OK(sn_tissue_set(&b.c->tissue[0], "c", 2500));
    CHECK_OK(sn_net_create(b.c, &other));
    b.c->springs.cuttable = false;
    CHECK_OK(sn_net_create(b.c, &whole));
    const int gone[3] = {3, 50, 51};
    int taken;
    CHECK_OK(sn_state_cut(b.net, b.s, 3, gone, NULL));
    CHECK_FAILS(sn_state_move(b.net, whole, b.s), SN_E_DEFINITION, "must be the same");
    CHECK_OK(sn_state_move(b.net, other, b.s));
    assert_true(sn_state_is_cut(other, b.s, 50));
    run_for(&(body){.net = other, .s = b.s}, 1e-3);
    CHECK_OK(sn_state_cut(other, b.s, 3, gone, &taken));
    assert_int_equal(taken, 0);

    CHECK_FAILS(sn_state_cut(b.net, b.s, 1, &(int){-1}, &taken), SN_E_RANGE, "cut of cell -1");
    CHECK_FAILS(sn_state_cut(b.net, b.s, 2, (int[]){9, b.net->cells}, &taken), SN_E_RANGE,
                "nothing was cut");
    assert_false(sn_state_is_cut(b.net, b.s, 9));
    sn_state *s;
    CHECK_OK(sn_state_create(whole, &s));
    CHECK_FAILS(sn_state_cut(whole, s, 1, gone, NULL), SN_E_UNSUPPORTED, "springs.cuttable");
    assert_false(sn_state_is_cut(whole, s, 3));
    sn_state_destroy(s);
    sn_net_destroy(other);
    sn_net_destroy(whole);
    end(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_left_is_the_rest),
                                       cmocka_unit_test(the_ledger_balances),
                                       cmocka_unit_test(ledgers_of_all_kinds),
                                       cmocka_unit_test(equilibrium_forgets_the_cut),
                                       cmocka_unit_test(cuts_take_no_momentum),
                                       cmocka_unit_test(a_bar_in_two),
                                       cmocka_unit_test(nothing_left),
                                       cmocka_unit_test(runs_of_dust),
                                       cmocka_unit_test(loose_pieces_have_no_equilibrium),
                                       cmocka_unit_test(loads_end_with_their_faces),
                                       cmocka_unit_test(tools_touch_the_new_surface),
                                       cmocka_unit_test(cuts_keep_bits),
                                       cmocka_unit_test(cut_runs_go_on),
                                       cmocka_unit_test(moved_states_stay_cut)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
