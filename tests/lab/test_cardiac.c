// The joint fit of the measured ramps of passive cardiac muscle, and the four held-out predictions.
// SPDX-License-Identifier: Apache-2.0
#include "cardiac.h"

static sn_fit_def joint(const char *law, const sn_curve *curve, int count) {
    sn_fit_def def = sn_fit_def_default();
    def.law = sn_law_find(law);
    def.memory = sn_memory_law_find("fung-spectrum");
    def.curve = curve;
    def.curve_count = count;
    return def;
}

// An independent fit of the full records (100 rows each) reaches R2 = 0.980; of these reduced
// tables 0.97 is asked. The fastest ramp has a peak that the law misses, and the shortest
// relaxation time is hidden: only an upper end of its interval is found, and the stiffness hangs on
// it.
static void four_ramps_together(void **state) {
    (void)state;
    sn_curve curve[CARDIAC_RAMPS];
    for (int k = 0; k < CARDIAC_RAMPS; ++k) curve[k] = cardiac_ramp(k);
    const char *const laws[] = {"exponential", "demiray"};
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    for (int l = 0; l < 2; ++l) {
        sn_fit_def def = joint(laws[l], curve, CARDIAC_RAMPS);
        CHECK_OK(sn_fit(&def, r));
        assert_true(r->converged);
        CHECK_ABS(r->r_squared, 1.0, 0.02);
        assert_int_equal(r->curve[0].worst, 11); // the peak of the fastest ramp
        assert_false(r->identifiable);
        for (int k = 0; k < r->param_count; ++k) {
            const sn_fit_param *p = &r->param[k];
            bool hidden = strcmp(p->name, "tau1") == 0;
            // the stiffness trades off with tau1, whose interval is open below
            bool stiffness = strcmp(p->unit, "Pa") == 0 && !p->fixed;
            assert_true(p->identifiable == !(hidden || stiffness));
            if (stiffness) assert_non_null(strstr(p->reason, "tied to tau1"));
            if (!hidden) continue;
            assert_true(p->profiled && p->ci95[1] < 0.1 / 3.0);
            assert_true(strstr(p->reason, "bound") || strstr(p->reason, "interval"));
        }
        sn_fit_release(r);
    }
    sn_free(r);
    for (int k = 0; k < CARDIAC_RAMPS; ++k) sn_curve_release(&curve[k]);
}

// The slower three are predicted within 6 % of their peak. The fastest is an extrapolation by ten
// in rate; on this table, whose rows crowd at the peak that the law misses, it comes to 6.7 % (6.4
// % with demiray), on the full record to 4.8 %.
static void held_out_ramps_are_predicted(void **state) {
    (void)state;
    const char *const laws[] = {"exponential", "demiray"};
    const double limit[2][CARDIAC_RAMPS] = {{0.068, 0.06, 0.06, 0.06}, {0.065, 0.06, 0.06, 0.06}};
    sn_curve curve[CARDIAC_RAMPS], three[CARDIAC_RAMPS - 1];
    for (int k = 0; k < CARDIAC_RAMPS; ++k) curve[k] = cardiac_ramp(k);
    sn_fit_result *r = sn_alloc(1, sizeof *r);
    for (int l = 0; l < 2; ++l)
        for (int out = 0; out < CARDIAC_RAMPS; ++out) {
            for (int k = 0, at = 0; k < CARDIAC_RAMPS; ++k)
                if (k != out) three[at++] = curve[k];
            sn_fit_def def = joint(laws[l], three, CARDIAC_RAMPS - 1);
            sn_fit_curve prediction;
            CHECK_OK(sn_fit(&def, r));
            CHECK_OK(sn_fit_predict(&r->tissue, &curve[out], &prediction));
            CHECK_ABS(prediction.rmse / prediction.peak, 0.0, limit[l][out]);
            sn_free(prediction.predicted);
            sn_fit_release(r);
        }
    sn_free(r);
    for (int k = 0; k < CARDIAC_RAMPS; ++k) sn_curve_release(&curve[k]);
}

// what a reader of the table sees: peaks of 17.06 and 7.97 kPa, falling to 37 % and by 15 %
static void measured_relaxation(void **state) {
    (void)state;
    const double ramp[] = {0.1, 1.0, 10.0, 100.0}, peak[] = {17063.0, 12002.0, 9680.0, 7971.0};
    const double last[] = {6371.0, 6977.0, 6569.0, 6807.0};
    for (int k = 0; k < CARDIAC_RAMPS; ++k) {
        sn_curve curve = cardiac_ramp(k);
        sn_relaxation_result out;
        CHECK_OK(sn_reduce_relaxation(&curve, &out));
        CHECK_REL(out.ramp_s, ramp[k], 1e-12);
        CHECK_REL(out.peak_stress, peak[k], 1e-12);
        CHECK_REL(out.relaxed_fraction, 1.0 - last[k] / peak[k], 1e-12);
        assert_true(out.rate_per_decade > 0.03 && out.rate_per_decade < 0.2);
        sn_curve_release(&curve);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_ramps_together),
        cmocka_unit_test(held_out_ramps_are_predicted),
        cmocka_unit_test(measured_relaxation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
