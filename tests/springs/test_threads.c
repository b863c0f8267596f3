// Threads, tiles and the order of nodes: none may be seen in a result.
// SPDX-License-Identifier: Apache-2.0
#include <stdatomic.h>

#include "bodies.h"
#include "springs/state.h"

static const double size[3] = {0.04, 0.03, 0.03};
static const int cells[3] = {10, 8, 8}; // several tiles of every kind

//---- the team ------------------------------------------------------------------------------------

static _Atomic int done[1000];

static void count_task(void *context, int k) {
    atomic_fetch_add(&done[k], 1 + *(int *)context * 0);
}

static void every_task_runs_once(void **state) {
    (void)state;
    for (int threads = 1; threads <= 5; threads++) {
        sn_team *team;
        int context = 0;
        CHECK_OK(sn_team_create(threads, &team));
        assert_true((team == NULL) == (sn_team_limit(threads) == 1));
        for (int turn = 0; turn < 3000; turn++) {
            const int count = (turn * 7) % 40 + (turn == 77 ? 900 : 0);
            for (int k = 0; k < 1000; k++) atomic_store(&done[k], 0);
            sn_team_run(team, count, count_task, &context);
            for (int k = 0; k < 1000; k++) assert_int_equal(atomic_load(&done[k]), k < count);
        }
        sn_team_destroy(team);
    }
}

//---- cases ---------------------------------------------------------------------------------------

enum { KINDS = 10 }; // from 8: smoothed

// pulled, pressed and poked; two tissues
static sn_case *some_case(int kind) {
    sn_tissue t = demiray(2e3, 6, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    sn_case *c = make_block(size, cells, kind < 6 ? SN_PATTERN_MIRRORED : SN_PATTERN_BCC, &t);
    jitter(c, 0.1, 3);
    c->mesh->region_count = 2;
    c->mesh->region_name = sn_resize(c->mesh->region_name, 2, sizeof *c->mesh->region_name);
    snprintf(c->mesh->region_name[1], SN_NAME_MAX, "other");
    for (int e = 0; e < c->mesh->cell_count; e++)
        c->mesh->region[e] = c->mesh->node[3 * c->mesh->cell[4 * e]] > 0.018;
    c->tissue = sn_resize(c->tissue, 2, sizeof *c->tissue);
    c->tissue[1] = demiray(4e3, 3, 6e4);
    c->springs.precision = kind % 2 ? SN_SINGLE : SN_DOUBLE;
    c->springs.rung = kind >= 8      ? SN_RUNG_SMOOTHED
                      : kind / 2 % 2 ? SN_RUNG_CENTRAL
                                     : SN_RUNG_COUPLED;
    c->springs.volume = (kind >= 4 && kind < 9) || kind / 2 == 0;
    add_support(c, "left", "xyz");
    add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.004, 0.002, 0, 0.01);
    add_load(c, SN_LOAD_PRESSURE, "front", 0, 0, 0, 0.01)->pressure = 200;
    add_tool(c, "probe", 0.01, (const double[]){0.0203, 0.0148, 0.0406},
             (const double[]){0.001, 0, -0.003}, 0.01);
    return c;
}

static sn_state *after_steps(const sn_net *net, int steps) {
    sn_state *s;
    CHECK_OK(sn_state_create(net, &s));
    for (int n = 0; n < steps; n++) sn_state_step(net, s, 2e-4);
    assert_false(s->broken);
    return s;
}

static void threads_change_no_bit(void **state) {
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        sn_state *first = NULL;
        sn_net *net[4];
        for (int threads = 1; threads <= 3; threads++) {
            sn_case *c = some_case(kind);
            c->springs.threads = threads;
            CHECK_OK(sn_net_create(c, &net[threads]));
            const sn_net *n = net[threads];
            assert_true(n->spring_tiles.count + n->cell_tiles.count > 3); // something to share
            sn_state *s = after_steps(n, 150); // some looks at the frequency among them
            const size_t real = kind % 2 ? sizeof(float) : sizeof(double);
            const size_t quads = (size_t)n->nodes * 4 * real;
            if (!first) {
                first = s;
                double most = 0;
                for (size_t k = 0; k < (size_t)n->nodes * 4; k++)
                    most = fmax(most, fabs(sn_real_at(s->precision, s->u, k)));
                assert_true(most > 1e-3); // it moved
                sn_case_destroy(c);
                continue;
            }
            assert_memory_equal(s->u, first->u, quads);
            assert_memory_equal(s->v, first->v, quads);
            assert_memory_equal(s->store, first->store, n->store_size * real);
            assert_memory_equal(&s->omega2, &first->omega2, sizeof s->omega2);
            sn_state_destroy(s);
            sn_case_destroy(c);
        }
        sn_state_destroy(first);
        for (int threads = 1; threads <= 3; threads++) sn_net_destroy(net[threads]);
    }
}

//---- order of nodes ------------------------------------------------------------------------------

typedef struct last_frame {
    int nodes, cells;
    double *field[3]; ///< displacement, pressure, stress
} last_frame;

static sn_status keep_frame(void *context, const sn_frame *frame) {
    static const char *const names[] = {"displacement", "pressure", "cauchy_stress"};
    last_frame *last = context;
    for (int k = 0; k < frame->field_count; k++)
        for (int n = 0; n < 3; n++) {
            const sn_field *f = &frame->fields[k];
            if (strcmp(f->name, names[n]) != 0) continue;
            size_t count =
                (size_t)((f->place == SN_ON_NODES ? last->nodes : last->cells) * f->components);
            sn_free(last->field[n]);
            last->field[n] = sn_alloc(count, sizeof(double));
            memcpy(last->field[n], f->value, count * sizeof(double));
        }
    return SN_OK;
}

// gives node k of the mesh the number to[k]
static void renumber(sn_mesh *m, const int *to) {
    double *node = sn_alloc((size_t)m->node_count * 3, sizeof *node);
    for (int k = 0; k < m->node_count; k++)
        for (int d = 0; d < 3; d++) node[3 * to[k] + d] = m->node[3 * k + d];
    memcpy(m->node, node, (size_t)m->node_count * 3 * sizeof *node);
    sn_free(node);
    for (int k = 0; k < 4 * m->cell_count; k++) m->cell[k] = to[m->cell[k]];
    for (int s = 0; s < m->surface_count; s++)
        for (int k = 0; k < 3 * m->surface[s].face_count; k++)
            m->surface[s].face[k] = to[m->surface[s].face[k]];
}

static void run_numbered(int kind, const int *to, last_frame *last, double *positions) {
    sn_case *c = some_case(kind);
    if (to) renumber(c->mesh, to);
    c->until = 0.01;
    c->output_every = 0.01;
    last->nodes = c->mesh->node_count;
    last->cells = c->mesh->cell_count;
    add_probe(c, "corner", SN_PROBE_POINT, NULL, 0.031, 0.013, 0.024);
    sn_output output = {.context = last, .frame = keep_frame};
    sn_run_summary summary;
    sn_record *history;
    CHECK_OK(sn_record_create("run", &history));
    CHECK_OK(sn_springs_run(c, &output, &summary, history));
    positions[0] = last_value(history, "corner_ux");
    sn_record_destroy(history);
    sn_net *net;
    CHECK_OK(sn_net_create(c, &net));
    sn_state *s = after_steps(net, 40);
    sn_state_positions(net, s, positions + 1);
    sn_state_destroy(s);
    sn_net_destroy(net);
    sn_case_destroy(c);
}

static void numbering_changes_no_bit(void **state) {
    (void)state;
    for (int kind = 0; kind < KINDS; kind += 3) {
        sn_case *c = some_case(kind);
        const int nodes = c->mesh->node_count;
        int *to = sn_alloc((size_t)nodes, sizeof *to);
        uint64_t seed = 5;
        for (int k = 0; k < nodes; k++) {
            int j = (int)check_random(&seed, 0, k + 1);
            to[k] = to[j];
            to[j] = k;
        }
        last_frame a = {0}, b = {0};
        double *x = sn_alloc((size_t)nodes * 3 + 1, sizeof *x);
        double *y = sn_alloc((size_t)nodes * 3 + 1, sizeof *y);
        run_numbered(kind, NULL, &a, x);
        run_numbered(kind, to, &b, y);
        CHECK_ABS(x[0], y[0], 0);
        assert_true(fabs(x[0]) > 1e-4);
        for (int k = 0; k < nodes; k++) {
            for (int d = 0; d < 3; d++) {
                CHECK_ABS(y[1 + 3 * to[k] + d], x[1 + 3 * k + d], 0);
                // the mesh as well as the results: no node got another's place
                assert_true(fabs(x[1 + 3 * k + d] - c->mesh->node[3 * k + d]) < 0.008);
                CHECK_ABS(b.field[0][3 * to[k] + d], a.field[0][3 * k + d], 0);
            }
            CHECK_ABS(b.field[1][to[k]], a.field[1][k], 0);
        }
        for (int k = 0; k < 6 * c->mesh->cell_count; k++)
            CHECK_ABS(b.field[2][k], a.field[2][k], 0);
        for (int n = 0; n < 3; n++) {
            sn_free(a.field[n]);
            sn_free(b.field[n]);
        }
        sn_free(x);
        sn_free(y);
        sn_free(to);
        sn_case_destroy(c);
    }
}

//---- fans ----------------------------------------------------------------------------------------

static double fan_volume(const sn_mesh *m, const sn_fan *fan, int k) {
    const int corner[4] = {fan->node[0], fan->node[1], fan->node[2 + k],
                           fan->node[2 + (k + 1) % fan->ring]};
    double e[3][3];
    for (int a = 0; a < 3; a++)
        for (int d = 0; d < 3; d++)
            e[a][d] = m->node[3 * corner[a + 1] + d] - m->node[3 * corner[0] + d];
    return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
            e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
           6;
}

// Every cell once and right way round: as many as the mesh has, each of positive volume, and in all
// the volume of the body and its first moments of a field that tells cells apart.
static void fans_cover_all_cells(void **state) {
    (void)state;
    static const sn_pattern pattern[] = {SN_PATTERN_MIRRORED, SN_PATTERN_BCC, SN_PATTERN_KUHN};
    sn_tissue t = neo_hookean(3e3, 2e4);
    for (int n = 0; n < 6; n++) {
        sn_case *c = make_block(size, cells, pattern[n / 2], &t);
        if (n % 2) jitter(c, 0.1, 9); // no cell turns over
        const sn_mesh *m = c->mesh;
        sn_fan *fan;
        int count, covered = 0;
        double volume = 0, marked = 0, want = 0;
        CHECK_OK(sn_net_list_fans(m, 0, &fan, &count));
        for (int k = 0; k < count; k++) {
            assert_in_range(fan[k].ring, 2, SN_FAN_RING);
            for (int j = 0; j < fan[k].ring - !fan[k].closed; j++, covered++) {
                double v = fan_volume(m, &fan[k], j), mark = 0;
                assert_true(v > 0);
                const int corner[4] = {fan[k].node[0], fan[k].node[1], fan[k].node[2 + j],
                                       fan[k].node[2 + (j + 1) % fan[k].ring]};
                for (int a = 0; a < 4; a++) mark += sin(1.7 * corner[a]);
                volume += v;
                marked += v * mark * mark;
            }
        }
        for (int e = 0; e < m->cell_count; e++) {
            double mark = 0;
            for (int a = 0; a < 4; a++) mark += sin(1.7 * m->cell[4 * e + a]);
            want += sn_mesh_cell_volume(m, e) * mark * mark;
        }
        assert_int_equal(covered, m->cell_count);
        CHECK_REL(volume, sn_mesh_volume(m), 1e-12); // rounding of a few thousand terms
        CHECK_REL(marked, want, 1e-12);
        if (n == 0) assert_int_equal(count, m->cell_count / 6); // whole cubes
        assert_true(count < 0.7 * m->cell_count);
        sn_free(fan);
        sn_case_destroy(c);
    }
}

// Exact for any step against tau: the stress after a ramp and a hold in closed form.
static void memory_does_not_mind_the_step(void **state) {
    (void)state;
    for (int k = -5; k <= 5; k++) {
        sn_tissue t = neo_hookean(3e3, 2e4);
        t.memory = prony(0.4, 0.05, 0.25, 0.6);
        sn_case *c = make_block(size, (const int[]){2, 2, 2}, SN_PATTERN_MIRRORED, &t);
        c->springs.rung = SN_RUNG_CENTRAL;
        c->springs.volume = false;
        sn_net *net;
        CHECK_OK(sn_net_create(c, &net));
        assert_int_equal(net->region[0].branches, 2);
        net->region[0].memory.tau[0] = pow(10, k);
        net->region[0].memory.tau[1] = 3 * pow(10, k);
        double *u = sn_alloc((size_t)net->nodes * 4, sizeof *u), pulled[2][2];
        double *store = sn_alloc(net->store_size, sizeof *store);
        sn_scratch scratch = {0};
        sn_factors factors;
        CHECK_OK(sn_scratch_create(net, SN_DOUBLE, &scratch));
        const int a = net->spring_end[0], b = net->spring_end[SN_BLOCK];
        const double h = 1;
        for (int mode = 0; mode < 2; mode++)
            for (int n = 0; n < 2; n++) { // up in one step, held for one
                for (int d = 0; d < 3; d++)
                    u[4 * b + d] =
                        0.1 * (net->node_position[3 * b + d] - net->node_position[3 * a + d]);
                sn_net_factors(net, h, &factors);
                sn_net_forces(net,
                              &(sn_force_call){.precision = SN_DOUBLE,
                                               .mode = mode ? SN_MEMORY_ADVANCE : SN_MEMORY_OFF,
                                               .u = u,
                                               .factors = &factors,
                                               .store = store,
                                               .out = &scratch});
                pulled[mode][n] = 0;
                for (int d = 0; d < 3; d++)
                    pulled[mode][n] += ((double *)scratch.f)[4 * a + d] * u[4 * b + d];
            }
        double up = 0, held = 0;
        for (int i = 0; i < 2; i++) {
            const double tau = net->region[0].memory.tau[i], g = net->region[0].memory.g[i];
            up += g * tau / h * -expm1(-h / tau);
            held += g * tau / h * -expm1(-h / tau) * exp(-h / tau);
        }
        // a few roundings of sums whose terms have one sign
        CHECK_REL(pulled[1][0] / pulled[0][0], 0.35 + up, 1e-13);
        CHECK_REL(pulled[1][1] / pulled[0][1], 0.35 + held, 1e-13);
        sn_free(u);
        sn_free(store);
        sn_scratch_destroy(&scratch);
        sn_net_destroy(net);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_task_runs_once), cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(numbering_changes_no_bit), cmocka_unit_test(fans_cover_all_cells),
        cmocka_unit_test(memory_does_not_mind_the_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
