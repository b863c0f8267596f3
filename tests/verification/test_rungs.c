// How near each way of making springs of a mesh comes to converged finite elements: a block of
// 40 x 20 x 20 mm in bending and torsion, 637 nodes, Poisson's ratio 0.45.
// SPDX-License-Identifier: Apache-2.0
#include "build.h"
#include "engines.h"

static const double size[3] = {0.04, 0.02, 0.02};

static sn_case *block(int per_side) {
    const sn_tissue t = neo_hookean(1e4 / 2.9, 1e4 / 0.3);
    sn_case *c =
        make_block(size, (const int[]){2 * per_side, per_side, per_side}, SN_PATTERN_MIRRORED, &t);
    add_support(c, "left", "xyz");
    c->until = c->output_every = 1;
    c->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    c->springs.volume = true;
    c->springs.step = 1; // one step: nearly linear
    c->continuum.steps = 1;
    return c;
}

// the right face goes up, free to turn and to come nearer
static void bend(sn_case *c) {
    sn_load *load = add_load(c, SN_LOAD_DISPLACEMENT, "right", 0, 0, 4e-4, 1);
    load->free[0] = load->free[1] = true;
}

// tractions on the right face that turn about the axis: a surface of its own for every triangle
static void twist(sn_case *c) {
    const sn_surface right = c->mesh->surface[sn_mesh_surface(c->mesh, "right")];
    const int before = c->mesh->surface_count, faces = right.face_count;
    c->mesh->surface =
        sn_resize(c->mesh->surface, (size_t)(before + faces), sizeof *c->mesh->surface);
    c->load = sn_alloc((size_t)faces, sizeof *c->load);
    c->mesh->surface_count = before + faces;
    c->load_count = faces;
    for (int k = 0; k < faces; k++) {
        sn_surface *s = &c->mesh->surface[before + k];
        double x[2] = {0};
        *s = (sn_surface){.face_count = 1,
                          .face = sn_alloc(3, sizeof *s->face),
                          .cell = sn_alloc(1, sizeof *s->cell)};
        s->cell[0] = right.cell[k];
        snprintf(s->name, sizeof s->name, "face-%d", k);
        for (int a = 0; a < 3; a++) {
            s->face[a] = right.face[3 * k + a];
            for (int d = 0; d < 2; d++)
                x[d] += (c->mesh->node[3 * s->face[a] + 1 + d] - 0.5 * size[1 + d]) / 3;
        }
        c->load[k] = (sn_load){.kind = SN_LOAD_TRACTION,
                               .surface = before + k,
                               .vector = {0, -5e3 * x[1], 5e3 * x[0]},
                               .factor = make_ramp(0, 1)};
    }
}

/// Work of the loads: of a given motion too large where the body is too stiff, of given forces too
/// small.
static double energy(int per_side, void (*load)(sn_case *), engine *run, sn_rung rung,
                     sn_element element) {
    sn_case *c = block(per_side);
    sn_run_summary s = {0};
    load(c);
    c->springs.rung = rung;
    c->continuum.element = element;
    sn_record_destroy(run_engine(run, c, NULL, &s));
    sn_case_destroy(c);
    return s.elastic_J;
}

static void smoothed_is_nearer(void **state) {
    (void)state;
    static void (*const loads[])(sn_case *) = {bend, twist};
    static const char *const names[] = {"bending", "torsion"};
    for (int k = 0; k < 2; k++) {
        // quadratic elements on the same mesh are within a few thousandths of the limit
        const double truth =
            energy(6, loads[k], sn_continuum_run, SN_RUNG_COUPLED, SN_ELEMENT_P2P1);
        double stiffer[3]; // over the truth
        static const sn_rung rungs[] = {SN_RUNG_COUPLED, SN_RUNG_SMOOTHED, SN_RUNG_CENTRAL};
        for (int n = 0; n < 3; n++) {
            double e = energy(6, loads[k], sn_springs_run, rungs[n], SN_ELEMENT_P1);
            stiffer[n] = k == 0 ? e / truth - 1 : truth / e - 1;
        }
        print_message("%s at 637 nodes, stiffness over the reference's: coupled %+.2f %%, "
                      "smoothed %+.2f %%, central %+.2f %%\n",
                      names[k], 100 * stiffer[0], 100 * stiffer[1], 100 * stiffer[2]);
        assert_true(stiffer[1] < stiffer[0] && stiffer[0] > 0.04);
        // a smoothing of half of the error at least; not below the truth by more
        assert_true(fabs(stiffer[1]) < 0.5 * stiffer[0]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(smoothed_is_nearer)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
