// The published benchmarks of examples/benchmarks, each as the file stands, on its one coarse mesh.
// SPDX-License-Identifier: Apache-2.0
// scripts/verify-benchmarks.sh refines them and prints the table.
#include "check.h"
#include "sinew/sinew.h"

#define FOLDER SN_SOURCE_DIR "/examples/benchmarks/"

// A number of the last row of the history, m.
static double last(const char *file, const char *column) {
    sn_case *c;
    sn_record *r;
    sn_run_summary summary;
    CHECK_OK(sn_case_read(file, &c));
    CHECK_OK(sn_record_create("run", &r));
    CHECK_OK(sn_continuum_run(c, NULL, &summary, r));
    if (!summary.converged) print_message("%s: %s\n", file, summary.reason);
    assert_true(summary.converged);
    const double *v = sn_record_values(r, column);
    assert_non_null(v);
    double value = v[r->rows - 1];
    sn_record_destroy(r);
    sn_case_destroy(c);
    return value;
}

// 11 codes: 4.0 to 4.2 mm
static void land_1(void **state) {
    (void)state;
    double z = 1e-3 + last(FOLDER "land-1.yaml", "end_uz");
    assert_true(z > 4.0e-3 && z < 4.2e-3);
}

// Cook's membrane on 8 x 8 quadratic cells: below the published value, as a coarse mesh is stiffer,
// by at most what the corner at the clamp costs (an order below 1 from there: 0.2 to 1.7 %).
static void cook(void **state) {
    (void)state;
    static const struct {
        const char *file, *column;
        double factor, published;
    } row[] = {
        {FOLDER "cook-plane-stress.yaml", "middle_uy", 1e5, 23.96e-3},
        {FOLDER "cook-linear.yaml", "corner_uy", 1e5, 32.24e-3},
        {FOLDER "cook-incompressible.yaml", "middle_uy", 1e5, 16.432584e-3},
        {FOLDER "cook-neo-hookean.yaml", "corner_uy", 1, 6.9083e-3},
    };
    for (int k = 0; k < 4; k++) {
        double value = row[k].factor * last(row[k].file, row[k].column);
        if (getenv("SINEW_SHOW"))
            print_message("%s: %.5g, published %.5g\n", row[k].file, value, row[k].published);
        assert_true(value < row[k].published && value > 0.98 * row[k].published);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(land_1), cmocka_unit_test(cook)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
