// Cuts: what is left is the body without the cells.
// SPDX-License-Identifier: Apache-2.0
#include "cuts.h"
#include "springs/moment.h"
#include "springs/parts.h"
#include "springs/state.h"

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

//---- equilibrium ---------------------------------------------------------------------------------

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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_left_is_the_rest),
                                       cmocka_unit_test(equilibrium_forgets_the_cut),
                                       cmocka_unit_test(loose_pieces_have_no_equilibrium),
                                       cmocka_unit_test(loads_end_with_their_faces),
                                       cmocka_unit_test(tools_touch_the_new_surface)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
