// Balance and tangent of single states: patch test, differences, Newton's order, rigid rotation.
// SPDX-License-Identifier: Apache-2.0
#include "solve.h"

static const sn_element elements[] = {SN_ELEMENT_P1, SN_ELEMENT_P2, SN_ELEMENT_P2P1};

static sn_status nothing(void *context, const sn_frame *frame) {
    (void)context;
    assert_in_range(frame->field_count, 7, 8); // the eighth: fibres
    return SN_OK;
}

// Fields against each other in a state of one deformation F = 1 + H: F S F^T = J sigma; principal
// stretches by the invariants of C, which Green strain has nothing to do with.
static void check_patch_fields(const sn_mesh *mesh, const sn_fe_measure *m, const double H[3][3]) {
    static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double F[3][3], C[3][3] = {{0}}, trace = 0, square = 0, scale = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) F[i][j] = H[i][j] + (i == j);
    double J = F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) +
               F[0][1] * (F[1][2] * F[2][0] - F[1][0] * F[2][2]) +
               F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) C[i][j] += F[k][i] * F[k][j];
    for (int i = 0; i < 3; i++) {
        trace += C[i][i];
        for (int j = 0; j < 3; j++) square += C[i][j] * C[i][j];
    }
    for (int n = 0; n < mesh->cell_count; n++) {
        const double *l = m->stretch + 3 * n, *S = m->reference + 6 * n, *sigma = m->stress + 6 * n;
        assert_true(l[0] >= l[1] && l[1] >= l[2]);
        CHECK_REL(l[0] * l[0] + l[1] * l[1] + l[2] * l[2], trace, 1e-9);
        CHECK_REL(pow(l[0], 4) + pow(l[1], 4) + pow(l[2], 4), square, 1e-9);
        CHECK_REL(l[0] * l[1] * l[2], J, 1e-9);
        for (int k = 0; k < 6; k++) scale = fmax(scale, fabs(sigma[k]));
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double push = 0;
                for (int k = 0; k < 3; k++)
                    for (int o = 0; o < 3; o++) push += F[i][k] * S[sym[k][o]] * F[j][o];
                CHECK_ABS((push / J - sigma[sym[i][j]]) / scale, 0, 1e-9);
            }
    }
}

// x = (I + H) X has one strain and one stress everywhere: with the boundary moved so, the inside
// must follow, whatever the mesh. Rounding: condition number times 1e-16 stays far below 1e-10.
static void patch(sn_element element, const sn_tissue *tissue, bool fibres) {
    static const double H[3][3] = {{0.21, -0.13, 0.04}, {0.07, -0.11, 0.17}, {-0.09, 0.15, 0.12}};
    sn_case *c = body_block(0.02, 0.015, 0.01, 2, 2, 2, tissue, element);
    body_distort(c, 0.2, 77);
    if (fibres) {
        const double fibre[3] = {0.48, 0.6, 0.64};
        memcpy(c->fibre, fibre, sizeof fibre);
    }
    body_support(c, "boundary", true, true, true);
    solve one = solve_begin(c, 1e-11);
    sn_fe_problem *const p = one.p;
    const double *const x = one.x;
    for (int a = 0; a < p->space->nodes; a++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                p->prescribed[3 * a + i] += H[i][j] * p->space->rest[3 * a + j];
    solve_step(&one);
    int inside = 0;
    double worst = 0;
    for (int d = 0; d < 3 * p->space->nodes; d++) {
        inside += p->pattern->row[d] >= 0;
        worst = fmax(worst, fabs(x[d] - p->prescribed[d]));
    }
    assert_true(inside > 0);
    CHECK_ABS(worst / 0.02, 0, 1e-10);

    // strain of every cell, and stress equal in all cells
    solve_frame(&one, &(sn_output){.frame = nothing});
    const sn_fe_measure *const m = one.m;
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    for (int k = 0; k < 6; k++) {
        int i = pair[k][0], j = pair[k][1];
        double E = 0.5 * (H[i][j] + H[j][i]), strain = 0, stress = 0, scale = 0;
        for (int l = 0; l < 3; l++) E += 0.5 * H[l][i] * H[l][j];
        for (int n = 0; n < c->mesh->cell_count; n++) {
            strain = fmax(strain, fabs(m->strain[6 * n + k] - E));
            stress = fmax(stress, fabs(m->stress[6 * n + k] - m->stress[k]));
            for (int l = 0; l < 6; l++) scale = fmax(scale, fabs(m->stress[l]));
        }
        CHECK_ABS(strain, 0, 1e-10);
        CHECK_ABS(stress / scale, 0,
                  1e-9); // the bulk modulus multiplies errors of the volume by 50
    }
    check_patch_fields(c->mesh, m, H);
    solve_end(&one);
    sn_case_destroy(c);
}

static void patch_test(void **state) {
    (void)state;
    sn_tissue isotropic = neo_hookean(1700, 9.1e4), fibrous = guccione(900, 5e4);
    for (int k = 0; k < 3; k++) {
        patch(elements[k], &isotropic, false);
        patch(elements[k], &fibrous, true);
    }
}

//---- tangent ------------------------------------------------------------------------------------

// K v by the matrix, with the columns of prescribed unknowns through `lift`.
static void multiply(const sn_fe_problem *p, const double *v, double *out) {
    for (int r = 0; r < p->pattern->rows; r++) {
        out[r] = 0;
        for (int k = p->pattern->row_start[r]; k < p->pattern->row_start[r + 1]; k++)
            out[r] += p->entry[k] * v[p->pattern->column[k]];
    }
}

// A random state of about 20 % strain, with pressures.
static void random_state(const sn_fe_problem *p, uint64_t *seed, double h, double stiff,
                         double *x) {
    for (int d = 0; d < p->space->dofs; d++)
        x[d] = d < 3 * p->space->nodes ? check_random(seed, -0.06, 0.06) * h
                                       : check_random(seed, -stiff, stiff);
}

// Central differences of the residual along a random direction, two steps: the error falls with the
// square of the step (truncation), which rules out a wrong tangent that happens to be near.
static void check_tangent(const sn_case *c, double h, double stiff, uint64_t seed, bool symmetric) {
    sn_fe_problem *p;
    sn_fe_balance balance;
    CHECK_OK(sn_fe_problem_create(c, 0.1, &p));
    size_t dofs = (size_t)p->space->dofs, rows = (size_t)p->pattern->rows;
    double *x = sn_alloc(dofs, 8), *v = sn_alloc(dofs, 8), *y = sn_alloc(dofs, 8);
    double *free = sn_alloc(rows, 8), *Kv = sn_alloc(rows, 8), *fd = sn_alloc(dofs, 8);
    // a first step leaves memory and contact behind
    random_state(p, &seed, h, stiff, x);
    sn_fe_problem_begin(p, (sn_fe_level){0.5, 1, 0.5});
    sn_fe_problem_balance(p, x, &balance);
    assert_true(balance.sound);
    sn_fe_problem_commit(p, x, &balance);
    for (size_t d = 0; d < dofs; d++) x[d] *= 1.1;
    random_state(p, &seed, h, stiff, v);
    sn_fe_problem_begin(p, (sn_fe_level){1, 1, 0.3});

    sn_fe_problem_tangent(p, x, v); // lifts the prescribed part
    for (size_t d = 0; d < dofs; d++)
        if (p->pattern->row[d] >= 0) free[p->pattern->row[d]] = v[d];
    multiply(p, free, Kv);
    double error[2], size = 0;
    for (int k = 0; k < 2; k++) {
        double step = k ? 1e-4 : 1e-3;
        memset(fd, 0, dofs * 8);
        for (int side = -1; side <= 1; side += 2) {
            for (size_t d = 0; d < dofs; d++) y[d] = x[d] + side * step * v[d];
            sn_fe_problem_balance(p, y, &balance);
            assert_true(balance.sound);
            for (size_t d = 0; d < dofs; d++) fd[d] += side * p->residual[d] / (2 * step);
        }
        // displacement rows are newtons, pressure rows cubic metres: each on its own scale
        error[k] = 0;
        for (int part = 0; part < 2; part++) {
            double difference = 0;
            size = 0;
            for (size_t d = 0; d < dofs; d++) {
                int r = p->pattern->row[d];
                if (r < 0 || (d >= 3 * (size_t)p->space->nodes) != (part == 1)) continue;
                difference += pow(fd[d] - Kv[r] - p->lifted[d], 2);
                size += fd[d] * fd[d];
            }
            if (size > 0) error[k] = fmax(error[k], sqrt(difference / size));
        }
    }
    CHECK_ABS(error[1], 0, 1e-6);
    assert_true(error[1] < 0.05 * error[0] || error[1] < 1e-9);
    double asymmetry = 0, largest = 0; // w . K v = v . K w
    for (size_t r = 0; r < rows; r++) y[r] = check_random(&seed, -1, 1);
    multiply(p, y, fd);
    for (size_t r = 0; r < rows; r++) {
        asymmetry += free[r] * fd[r] - y[r] * Kv[r];
        largest = fmax(largest, fabs(y[r] * Kv[r]));
    }
    assert_true((fabs(asymmetry) < 1e-10 * largest * (double)rows) == symmetric);
    double *const all[] = {x, v, y, free, Kv, fd};
    for (int k = 0; k < 6; k++) sn_free(all[k]);
    sn_fe_problem_destroy(p);
}

static void tangent(void **state) {
    (void)state;
    static const double prony[] = {0.3, 0.25, 0.2, 3.0};
    // fibres in all directions, since the tangent of others jumps where they go slack
    sn_tissue t[4] = {neo_hookean(1300, 2.1e4), demiray(1100, 1.7, 3e4), guccione(700, 4e4),
                      body_artery(1.0 / 3, 3e4)};
    body_set_memory(t + 1, "prony", 2, prony, 4);
    body_set_memory(t + 2, "prony", 2, prony, 4);
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 4; k++) {
            sn_case *c = body_block(0.03, 0.02, 0.01, 2, 1, 1, t + k, elements[e]);
            if (k >= 2) c->fibre[0] = 0.8, c->fibre[2] = -0.6;
            body_support(c, "left", true, true, true);
            check_tangent(c, 0.01, 2000, (uint64_t)(17 + 3 * e + k), true);
            body_press(c, "top", 4e4, NULL); // about the stiffness: it cannot hide
            check_tangent(c, 0.01, 2000, (uint64_t)(117 + 3 * e + k), false);
            if (k >= 2) { // axes of their own in every cell
                turn_fibres(c, 7);
                check_tangent(c, 0.01, 2000, (uint64_t)(217 + 3 * e + k), false);
            }
            sn_case_destroy(c);
        }
    sn_tissue incompressible = neo_hookean(1300, (double)INFINITY);
    sn_case *c = body_block(0.03, 0.02, 0.01, 2, 1, 1, &incompressible, SN_ELEMENT_P2P1);
    body_support(c, "left", true, true, true);
    check_tangent(c, 0.01, 2000, 5, true);
    sn_case_destroy(c);
}

// Contact: the ball overlaps the top face of the first state already, so that no spot comes or
// goes.
static void tangent_of_contact(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(1300, 2.1e4);
    for (int e = 0; e < 3; e++) {
        sn_case *c = body_block(0.01, 0.01, 0.01, 1, 1, 1, &t, elements[e]);
        body_support(c, "bottom", true, true, true);
        c->tool[c->tool_count++] =
            (sn_tool){.name = "ball", .radius = 0.05, .at = {0.004, 0.006, 0.01 + 0.05 - 0.004}};
        check_tangent(c, 0.01, 2000, (uint64_t)(31 + e), true);
        sn_case_destroy(c);
    }
}

//---- Newton -------------------------------------------------------------------------------------

// Quadratic: e_{k+1} <= 10 e_k^2 for relative errors below 0.01 and above rounding; linear
// convergence would break that bound by orders of magnitude.
static void newton_is_quadratic(void **state) {
    (void)state;
    sn_tissue t = neo_hookean(1000, 1e4);
    for (int e = 0; e < 3; e++)
        for (int follower = 0; follower < 2; follower++) {
            sn_case *c = body_block(0.02, 0.02, 0.02, 2, 2, 2, &t, elements[e]);
            body_support(c, "bottom", true, true, true);
            if (follower)
                body_press(c, "right", 300, NULL);
            else
                body_move(c, "top", 0.002, 0, 0.005, NULL);
            sn_fe_problem *p;
            sn_fe_newton newton;
            sn_fe_outcome out;
            CHECK_OK(sn_fe_problem_create(c, 1, &p));
            CHECK_OK(sn_fe_newton_init(&newton, p, 1e-13));
            double *x = sn_alloc((size_t)p->space->dofs, sizeof *x);
            int pairs = 0;
            sn_fe_problem_begin(p, (sn_fe_level){1, 1, 1});
            CHECK_OK(sn_fe_newton_solve(&newton, true, x, &out));
            for (int k = 2; k <= out.iterations; k++) {
                double e0 = newton.trace[k - 1], e1 = newton.trace[k];
                if (e0 > 0.01 || e0 < 1e-7) continue; // the next would be rounding
                pairs++;
                assert_true(e1 <= 10 * e0 * e0);
            }
            // printed always: the exponent of each error doubles
            print_message("Newton, %s, %s: relative residuals", p->space->element.name,
                          follower ? "follower pressure" : "prescribed motion");
            for (int k = 1; k <= out.iterations; k++) print_message(" %.1e", newton.trace[k]);
            print_message("\n");
            assert_true(out.balance.error < 1e-11);
            assert_true(out.iterations <= 8);
            assert_true(pairs > 0);
            sn_free(x);
            sn_fe_newton_free(&newton);
            sn_fe_problem_destroy(p);
            sn_case_destroy(c);
        }
}

// Turning a strained state turns its forces and leaves its energy.
static void rotation(void **state) {
    (void)state;
    static const double R[3][3] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
    static const double prony[] = {0.3, 0.25, 0.2, 3.0};
    sn_tissue t = guccione(700, 4e4);
    body_set_memory(&t, "prony", 2, prony, 4);
    for (int e = 0; e < 3; e++) {
        uint64_t seed = (uint64_t)(91 + e);
        sn_case *c = body_block(0.03, 0.02, 0.01, 2, 1, 1, &t, elements[e]);
        c->fibre[1] = 1;
        body_support(c, "left", true, true, true);
        sn_fe_problem *p;
        sn_fe_balance balance;
        CHECK_OK(sn_fe_problem_create(c, 1, &p));
        size_t dofs = (size_t)p->space->dofs;
        double *x = sn_alloc(dofs, 8), *y = sn_alloc(dofs, 8), *f = sn_alloc(dofs, 8);
        double worst = 0, largest = 0;
        random_state(p, &seed, 0.01, 2000, x);
        sn_fe_problem_begin(p, (sn_fe_level){1, 1, 0.3});
        sn_fe_problem_balance(p, x, &balance);
        memcpy(f, p->residual, dofs * 8);
        memcpy(y, x, dofs * 8);
        for (int a = 0; a < p->space->nodes; a++)
            for (int i = 0; i < 3; i++) {
                double at = 0;
                for (int j = 0; j < 3; j++)
                    at += R[i][j] * (x[3 * a + j] + p->space->rest[3 * a + j]);
                y[3 * a + i] = at - p->space->rest[3 * a + i];
            }
        sn_fe_problem_balance(p, y, &balance);
        for (int a = 0; a < p->space->nodes; a++)
            for (int i = 0; i < 3; i++) {
                double turned = 0;
                for (int j = 0; j < 3; j++) turned += R[i][j] * f[3 * a + j];
                worst = fmax(worst, fabs(turned - p->residual[3 * a + i]));
                largest = fmax(largest, fabs(turned));
            }
        CHECK_ABS(worst / largest, 0, 1e-12); // rounding of positions 3 h from the origin
        CHECK_REL(sn_fe_measure_energy(p, y), sn_fe_measure_energy(p, x), 1e-12);
        sn_free(x);
        sn_free(y);
        sn_free(f);
        sn_fe_problem_destroy(p);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(patch_test), cmocka_unit_test(tangent),
                                       cmocka_unit_test(tangent_of_contact),
                                       cmocka_unit_test(newton_is_quadratic),
                                       cmocka_unit_test(rotation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
