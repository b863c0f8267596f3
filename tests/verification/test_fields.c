// The files that ParaView opens, read back: every field of every element against what it must be.
// SPDX-License-Identifier: Apache-2.0
#include "build.h"
#include "scratch.h"
#include "sinew/sinew.h"

#define MU 2300.0
#define BULK 9100.0

static sn_case *block(sn_element element, bool homogeneous) {
    const sn_tissue t = neo_hookean(MU, BULK);
    sn_case *c = make_block((const double[]){0.03, 0.02, 0.01}, (const int[]){3, 2, 1},
                            SN_PATTERN_MIRRORED, &t);
    add_support(c, "left", homogeneous ? "x" : "xyz");
    if (homogeneous) add_support(c, "front", "y");
    if (homogeneous) add_support(c, "bottom", "z");
    const double across = homogeneous ? 0 : 0.002;
    sn_load *load = add_load(c, SN_LOAD_DISPLACEMENT, "right", 0.009, across, 2 * across, 1);
    load->free[1] = load->free[2] = homogeneous;
    c->until = c->output_every = 1;
    c->continuum.element = element;
    c->continuum.steps = 4;
    c->continuum.tolerance = 1e-10;
    return c;
}

static sn_status write_frame(void *vtu, const sn_frame *frame) {
    return sn_vtu_frame(vtu, frame);
}

// Runs a case into fields.pvd and gives the text of its last frame.
static char *run(const sn_case *c) {
    sn_vtu *vtu;
    sn_record *history;
    sn_run_summary summary;
    CHECK_OK(sn_vtu_create(scratch, "fields", c->mesh, &vtu));
    CHECK_OK(sn_record_create("fields", &history));
    sn_output output = {.context = vtu, .frame = write_frame};
    CHECK_OK(sn_continuum_run(c, &output, &summary, history));
    assert_true(summary.converged);
    sn_vtu_destroy(vtu);
    sn_record_destroy(history);
    char *text = scratch_read("fields_0001.vtu");
    assert_non_null(text);
    return text;
}

// The values of an array of doubles (base64 behind the count of bytes); free() them.
static double *array(const char *text, const char *name, int components, size_t count) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char mark[96];
    snprintf(mark, sizeof mark, "type=\"Float64\" Name=\"%s\" NumberOfComponents=\"%d\"", name,
             components);
    const char *at = strstr(text, mark);
    if (!at) fail_msg("no %s", mark);
    at = strchr(at, '>') + 1;
    if (strncmp(at, "<Info", 5) == 0 || *at == '\n') { // the unit stands in between
        at = strstr(at, "</InformationKey>") + strlen("</InformationKey>");
        at += strspn(at, " \n");
    }
    unsigned char *out = calloc(strcspn(at, "<") + 16, 1);
    size_t bytes = 0;
    unsigned word = 0, bits = 0;
    for (const char *d; *at && (d = strchr(digits, *at)); at++) {
        word = word << 6 | (unsigned)(d - digits);
        bits += 6;
        if (bits >= 8) out[bytes++] = (unsigned char)(word >> (bits -= 8));
    }
    assert_int_equal(bytes, 8 + 8 * count * (size_t)components);
    double *values = malloc(8 * count * (size_t)components);
    memcpy(values, out + 8, 8 * count * (size_t)components);
    free(out);
    return values;
}

typedef struct fields {
    double *u, *p, *E, *sigma, *W, *S, *l;
} fields;

static fields read_fields(const char *text, const sn_mesh *mesh) {
    size_t nodes = (size_t)mesh->node_count, cells = (size_t)mesh->cell_count;
    return (fields){
        array(text, "displacement", 3, nodes),       array(text, "pressure", 1, nodes),
        array(text, "green_strain", 6, cells),       array(text, "cauchy_stress", 6, cells),
        array(text, "energy_density", 1, cells),     array(text, "second_pk_stress", 6, cells),
        array(text, "principal_stretches", 3, cells)};
}

static void release(fields *f) {
    double *const all[] = {f->u, f->p, f->E, f->sigma, f->W, f->S, f->l};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
}

// VTK's order of a symmetric tensor: xx yy zz xy yz xz.
static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

// Neo-Hookean: W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2,
// sigma = mu J^(-5/3) (B - I1/3) + K (J - 1).
static void of_gradient(double F[3][3], double sigma[6], double *J, double *W) {
    double B[3][3] = {{0}}, I1 = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) B[i][j] += F[i][k] * F[j][k];
    for (int i = 0; i < 3; i++) I1 += B[i][i];
    *J = F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) +
         F[0][1] * (F[1][2] * F[2][0] - F[1][0] * F[2][2]) +
         F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
    *W = MU / 2 * (I1 / cbrt(*J * *J) - 3) + BULK / 2 * (*J - 1) * (*J - 1);
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++)
            sigma[sym[i][j]] = MU / (*J * cbrt(*J * *J)) * (B[i][j] - (i == j ? I1 / 3 : 0)) +
                               (i == j ? BULK * (*J - 1) : 0);
}

// The deformation gradient of a linear cell from the displacements in the file.
static void gradient(const sn_mesh *mesh, int cell, const double *u, double F[3][3]) {
    const int *v = mesh->cell + 4 * cell;
    double D[3][3], d[3][3], G[3][3]; // columns: edges at rest, of displacement; D^-1
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            D[i][k] = mesh->node[3 * v[k + 1] + i] - mesh->node[3 * v[0] + i];
            d[i][k] = u[3 * v[k + 1] + i] - u[3 * v[0] + i];
        }
    double det = 0;
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3;
        for (int j = 0; j < 3; j++) {
            int m = (j + 1) % 3, n = (j + 2) % 3;
            G[j][i] = D[a][m] * D[b][n] - D[a][n] * D[b][m];
        }
        det += D[i][0] * G[0][i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            F[i][j] = i == j;
            for (int k = 0; k < 3; k++) F[i][j] += d[i][k] * G[k][j] / det;
        }
}

// A cell against its deformation gradient; 1e-9: rounding of differences of displacements.
static void check_cell(const fields *f, int n, double F[3][3]) {
    double sigma[6], J, W, size = 0, trace = 0, product = 1;
    of_gradient(F, sigma, &J, &W);
    for (int k = 0; k < 6; k++) size = fmax(size, fabs(sigma[k]));
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double E = i == j ? -0.5 : 0, push = 0;
            for (int k = 0; k < 3; k++) E += 0.5 * F[k][i] * F[k][j];
            for (int k = 0; k < 3; k++)
                for (int o = 0; o < 3; o++) push += F[i][k] * f->S[6 * n + sym[k][o]] * F[j][o] / J;
            CHECK_ABS(f->E[6 * n + sym[i][j]], E, 1e-9);
            CHECK_ABS(f->sigma[6 * n + sym[i][j]] / size, sigma[sym[i][j]] / size, 1e-8);
            CHECK_ABS(push / size, sigma[sym[i][j]] / size, 1e-8);
            if (i == j) trace += 2 * E + 1;
        }
    CHECK_REL(f->W[n], W, 1e-8);
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        product *= f->l[3 * n + k];
        sum += pow(f->l[3 * n + k], 2);
    }
    CHECK_REL(product, J, 1e-9);
    CHECK_REL(sum, trace, 1e-9);
}

// Linear cells: every field of every cell follows from the displacements in the file.
static void linear_cells(void **state) {
    (void)state;
    sn_case *c = block(SN_ELEMENT_P1, false);
    char *text = run(c);
    fields f = read_fields(text, c->mesh);
    for (int n = 0; n < c->mesh->cell_count; n++) {
        double F[3][3];
        gradient(c->mesh, n, f.u, F);
        check_cell(&f, n, F);
    }
    release(&f);
    free(text);
    sn_case_destroy(c);
}

// All elements in one state of uniaxial tension: quadratic ones have the fields of their corners
// and cells as linear ones do. Newton's tolerance 1e-10 is left, of the stress.
static void all_elements(void **state) {
    (void)state;
    for (int e = 0; e < 3; e++) {
        sn_case *c = block((sn_element)e, true);
        char *text = run(c);
        fields f = read_fields(text, c->mesh);
        for (int n = 0; n < c->mesh->cell_count; n++) {
            double F[3][3];
            gradient(c->mesh, n, f.u, F);
            check_cell(&f, n, F);
            CHECK_REL(f.l[3 * n], 1.3, 1e-9);
            CHECK_ABS(f.sigma[6 * n + 1] / f.sigma[6 * n], 0, 1e-8);
        }
        for (int a = 0; a < c->mesh->node_count; a++) CHECK_REL(f.p[a], -f.sigma[0] / 3, 1e-7);
        release(&f);
        free(text);
        sn_case_destroy(c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(linear_cells),
                                       cmocka_unit_test(all_elements)};
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
