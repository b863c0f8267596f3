// Constants of central springs by rules.
// SPDX-License-Identifier: Apache-2.0
// Source: Lloyd, Szekely, Harders, Identification of spring parameters for deformable object
// simulation, IEEE Trans. Vis. Comput. Graph. 13 (2007) 1081-1094: a tetrahedron of edge l gives
// each of its edges 2 sqrt2/25 E l, from the stiffness matrix of a regular linear one at Poisson's
// ratio 1/4; others get l = (6 sqrt2 V)^(1/3), the edge of the regular one of their volume.
//
// Both baselines are as published: matched to Young's modulus, as if Poisson's ratio were that of
// springs. On a tissue of another ratio nu the shear modulus comes out by (5/4) / (1 + nu) less or
// more. Uniform springs are matched on orientation average, sum k L^2 = 6 E V; cf. Kot, Nagahashi,
// Szymczak, Elastic moduli of simple mass spring models, Vis. Comput. 31 (2015) 1339. They take
// the law's exponent and the volume term from the net's own rule.
#include "compare/calibrate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sinew/springs.h"

sn_status sn_calibration_case(const sn_case *from, sn_case **c) {
    const sn_mesh *mesh = from->mesh;
    sn_status status;
    *c = NULL;
    sn_case *own = NULL;
    SN_TRY(sn_case_create(&own));
    SN_TRY_GOTO(status, sn_mesh_copy(mesh, &own->mesh));
    own->tissue = sn_alloc((size_t)mesh->region_count, sizeof *own->tissue);
    own->support = sn_alloc(1, sizeof *own->support);
    if (!own->tissue || !own->support) {
        status = SN_E_MEMORY;
        goto fail;
    }
    memcpy(own->tissue, from->tissue, (size_t)mesh->region_count * sizeof *own->tissue);
    for (int r = 0; r < mesh->region_count; r++) {
        own->tissue[r].branched = false;
        own->tissue[r].memory = sn_memory_none();
    }
    own->shape = from->shape;
    own->has_shape = from->has_shape;
    memcpy(own->fibre, from->fibre, sizeof own->fibre);
    memcpy(own->fibres.sheet, from->fibres.sheet, sizeof own->fibres.sheet);
    own->support_count = 1;
    own->support[0] =
        (sn_support){.surface = sn_mesh_surface(mesh, "boundary"), .fix = {true, true, true}};
    own->until = own->output_every = 1.0;
    own->springs.rung = SN_RUNG_CENTRAL;
    own->springs.volume = true;
    own->springs.integrator = SN_INTEGRATOR_QUASI_STATIC;
    own->springs.precision = SN_DOUBLE;
    *c = own;
    return SN_OK;
fail:
    sn_case_destroy(own);
    return status;
}

sn_status sn_calibration_affine(const sn_case *c, sn_spring_set **set) {
    sn_net *net;
    *set = NULL;
    SN_TRY(sn_net_create(c, &net));
    sn_status status = sn_net_spring_set(net, set);
    sn_net_destroy(net);
    return status;
}

//---- edges ---------------------------------------------------------------------------------------

typedef struct cell_edge {
    int region, low, high;
    double length; // of a regular tetrahedron of the cell's volume
} cell_edge;

static int compare_edges(const void *a, const void *b) {
    const cell_edge *p = a, *q = b;
    if (p->region != q->region) return p->region < q->region ? -1 : 1;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    return (p->high > q->high) - (p->high < q->high);
}

sn_status sn_calibration_edges(const sn_mesh *mesh, sn_spring_set **set) {
    static const int corner[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    const size_t count = (size_t)mesh->cell_count * 6;
    size_t edges = 0;
    *set = NULL;
    cell_edge *edge = sn_alloc(count, sizeof *edge);
    if (!edge) return SN_E_MEMORY;
    for (size_t k = 0; k < count; k++) {
        const int *node = mesh->cell + k / 6 * 4;
        const int a = node[corner[k % 6][0]], b = node[corner[k % 6][1]];
        const double volume = sn_mesh_cell_volume(mesh, (int)(k / 6));
        edge[k] = (cell_edge){mesh->region[k / 6], a < b ? a : b, a < b ? b : a,
                              cbrt(6 * sqrt(2.0) * volume)};
    }
    qsort(edge, count, sizeof *edge, compare_edges);
    for (size_t k = 0; k < count; k++) edges += k == 0 || compare_edges(&edge[k - 1], &edge[k]);
    sn_status status = sn_spring_set_create((int)edges, mesh->region_count, set);
    for (size_t k = 0, n = 0; k < count && status == SN_OK; k++) {
        n += k > 0 && compare_edges(&edge[k - 1], &edge[k]);
        (*set)->region[n] = edge[k].region;
        (*set)->end[2 * n] = edge[k].low;
        (*set)->end[2 * n + 1] = edge[k].high;
        (*set)->stiffness[n] += edge[k].length;
    }
    sn_free(edge);
    return status;
}

//---- baselines -----------------------------------------------------------------------------------

static double youngs_modulus(const sn_tissue *tissue) {
    sn_moduli m;
    sn_tissue_moduli(tissue, &m);
    return isinf(m.bulk) ? 3 * m.shear : 9 * m.bulk * m.shear / (3 * m.bulk + m.shear);
}

static sn_status uniform_constants(const sn_case *c, sn_spring_set *set) {
    const sn_mesh *mesh = c->mesh;
    const size_t regions = (size_t)mesh->region_count;
    double *sum = sn_alloc(2 * regions, sizeof *sum), *volume = sum + regions;
    if (!sum) return SN_E_MEMORY;
    for (int e = 0; e < mesh->cell_count; e++)
        volume[mesh->region[e]] += sn_mesh_cell_volume(mesh, e);
    for (int k = 0; k < set->count; k++)
        for (int d = 0; d < 3; d++) {
            const double D =
                mesh->node[3 * set->end[2 * k + 1] + d] - mesh->node[3 * set->end[2 * k] + d];
            sum[set->region[k]] += D * D;
        }
    for (int k = 0; k < set->count; k++) {
        const int r = set->region[k];
        set->stiffness[k] = 6 * youngs_modulus(&c->tissue[r]) * volume[r] / sum[r];
    }
    sn_free(sum);
    return SN_OK;
}

// with the lengths that sn_calibration_edges() leaves
static void lloyd_constants(const sn_case *c, sn_spring_set *set) {
    for (int k = 0; k < set->count; k++)
        set->stiffness[k] *= 2 * sqrt(2.0) / 25 * youngs_modulus(&c->tissue[set->region[k]]);
}

// The springs of the net itself, with an isotropic tissue of shear modulus 1 Pa in place of those
// that it refuses.
static sn_status own_springs(const sn_case *c, sn_spring_set **set) {
    sn_case *plain;
    sn_status status;
    *set = NULL;
    SN_TRY(sn_calibration_case(c, &plain));
    for (int r = 0; r < c->mesh->region_count; r++) {
        sn_tissue *t = &plain->tissue[r];
        if (!sn_calibration_oriented(t)) continue;
        t->law = sn_law_find("neo-hookean");
        t->terms = 0;
        SN_TRY_GOTO(status, sn_tissue_set(t, "shear_modulus", 1));
        SN_TRY_GOTO(status, sn_tissue_set(t, "bulk_modulus", 100));
    }
    status = sn_calibration_affine(plain, set);
fail:
    sn_case_destroy(plain);
    return status;
}

static sn_status baseline(const sn_case *c, sn_calibration_rule rule, sn_spring_set **set) {
    sn_spring_set *own;
    SN_TRY(own_springs(c, &own));
    sn_status status = sn_calibration_edges(c->mesh, set);
    for (int r = 0; r < own->region_count && status == SN_OK; r++)
        (*set)->exponent[r] = own->exponent[r];
    sn_spring_set_destroy(own);
    if (status == SN_OK && rule == SN_CALIBRATION_UNIFORM) return uniform_constants(c, *set);
    if (status == SN_OK) lloyd_constants(c, *set);
    return status;
}

//---- the full rule -------------------------------------------------------------------------------

static const double most_left = 0.05; // of a tensor that the edges of a lattice do not give: then
                                      // second neighbours are tried

// Appends the springs of a body to the set of the whole.
static sn_status append(sn_spring_set *whole, const sn_calibration_body *body, const int *node) {
    const sn_spring_set *from = body->c->springs_given;
    const size_t all = (size_t)(whole->count + from->count);
    int *end = sn_resize(whole->end, all, 2 * sizeof *end);
    if (end) whole->end = end;
    int *region = sn_resize(whole->region, all, sizeof *region);
    if (region) whole->region = region;
    double *stiffness = sn_resize(whole->stiffness, all, sizeof *stiffness);
    if (stiffness) whole->stiffness = stiffness;
    if (!end || !region || !stiffness) return SN_E_MEMORY;
    for (int k = 0; k < from->count; k++, whole->count++) {
        for (int e = 0; e < 2; e++) end[2 * whole->count + e] = node[from->end[2 * k + e]];
        region[whole->count] = body->region;
        stiffness[whole->count] = from->stiffness[k];
    }
    whole->exponent[body->region] = from->exponent[0];
    memcpy(whole->square + SN_SPRING_SQUARES * body->region, from->square,
           SN_SPRING_SQUARES * sizeof *from->square);
    return SN_OK;
}

// Least squares and the scale of one region, into body->c->springs_given.
static sn_status fit_body(sn_calibration_body *body, sn_calibration_region *region) {
    sn_moduli moduli;
    sn_case *c = body->c;
    sn_tissue_moduli(&c->tissue[0], &moduli);
    sn_spring_set_destroy(c->springs_given);
    double K[3][3][3][3];
    SN_TRY(sn_calibration_target(body, K));
    for (int i = 0; i < 81; i++) K[i / 27][i / 9 % 3][i / 3 % 3][i % 3] /= moduli.shear;
    SN_TRY(sn_calibration_fit(c->mesh, K, &c->springs_given, region->left));
    for (int k = 0; k < c->springs_given->count; k++)
        c->springs_given->stiffness[k] *= moduli.shear;
    return sn_calibration_scale(body, &region->scale);
}

// k L^2 over the volume
static double spring_total(const sn_case *c) {
    const sn_spring_set *set = c->springs_given;
    double sum = 0;
    for (int k = 0; k < set->count; k++)
        for (int d = 0; d < 3; d++) {
            const double *x = c->mesh->node + d;
            const double D = x[3 * set->end[2 * k + 1]] - x[3 * set->end[2 * k]];
            sum += set->stiffness[k] * D * D;
        }
    return sum / sn_mesh_volume(c->mesh);
}

// Constants of one region at small strain by the full rule, from those of the net itself.
static sn_status full_constants(bool exact, sn_calibration_body *body,
                                sn_calibration_region *region) {
    sn_moduli moduli;
    sn_tissue_moduli(&body->c->tissue[0], &moduli);
    body->total = 15 * moduli.shear;
    if (exact && sn_calibration_oriented(&body->c->tissue[0])) {
        region->left[0] = 0;
        SN_TRY(sn_calibration_classes(body, &region->left[1]));
        body->total = spring_total(body->c);
        exact = region->left[1] < most_left;
    }
    if (!exact) SN_TRY(fit_body(body, region));
    body->c->springs_given->bulk[0] = NAN;
    if (body->total > 9 * moduli.bulk)
        return sn_fail(SN_E_UNSUPPORTED,
                       "tissue %s: central springs for it bring a bulk modulus of %g Pa, it has %g "
                       "Pa; use model coupled",
                       body->c->tissue[0].name, body->total / 9, moduli.bulk);
    return SN_OK;
}

/// What all regions share.
typedef struct job {
    const sn_case *own;
    sn_calibration_rule rule;
    bool tested; // else nothing is found out but the springs
    bool exact;  // the net's own springs have an isotropic tensor
    double strain, share[SN_CALIBRATION_KINDS];
    sn_spring_set *rule_set; // of the rule; of the net itself for the full one
    sn_spring_set *set;      // result of the full rule
} job;

// What of the law of springs the rule fits. The net's own rule, which baselines have their exponent
// from, refuses tissues with directions.
static sn_calibration_finite_fit fit_of(const job *j, int r) {
    if (j->rule == SN_CALIBRATION_FULL) return SN_CALIBRATION_FIT_LAW;
    return sn_calibration_oriented(&j->own->tissue[r]) ? SN_CALIBRATION_FIT_EXPONENT
                                                       : SN_CALIBRATION_FIT_NOTHING;
}

static bool has_work(const job *j) {
    bool any = j->tested;
    for (int r = 0; r < j->own->mesh->region_count; r++)
        any = any || fit_of(j, r) != SN_CALIBRATION_FIT_NOTHING;
    return any;
}

static sn_status do_region(job *j, int r, sn_calibration_region *region) {
    const sn_mesh *mesh = j->own->mesh;
    const bool full = j->rule == SN_CALIBRATION_FULL;
    sn_calibration_body body = {0};
    int *node = sn_alloc((size_t)mesh->node_count, sizeof *node);
    sn_status status = node ? SN_OK : SN_E_MEMORY;
    if (status != SN_OK) return status;
    snprintf(region->name, sizeof region->name, "%s", mesh->region_name[r]);
    region->scale = 1;
    region->strain = j->strain;
    region->left[0] = region->left[1] = NAN;
    SN_TRY_GOTO(status, sn_calibration_body_open(j->own, r, &body));
    for (int i = 0; i < mesh->node_count; i++)
        if (body.number[i] >= 0) node[body.number[i]] = i;
    SN_TRY_GOTO(status, sn_calibration_body_take(&body, j->rule_set));
    if (full) SN_TRY_GOTO(status, full_constants(j->exact, &body, region));
    if (j->tested) SN_TRY_GOTO(status, sn_calibration_small(&body, region));
    SN_TRY_GOTO(status, sn_calibration_finite(&body, j->share, fit_of(j, r), region));
    if (!full) j->rule_set->exponent[r] = body.c->springs_given->exponent[0];
    if (full) SN_TRY_GOTO(status, append(j->set, &body, node));
fail:
    sn_calibration_body_close(&body);
    sn_free(node);
    return status;
}

//---- whole ---------------------------------------------------------------------------------------

static void tell(const sn_output *progress, double done, const char *text) {
    if (progress && progress->progress) progress->progress(progress->context, done, text);
}

static sn_status rule_springs(job *j, sn_spring_set **set) {
    if (j->rule == SN_CALIBRATION_UNIFORM || j->rule == SN_CALIBRATION_LLOYD)
        return baseline(j->own, j->rule, set);
    if (j->rule != SN_CALIBRATION_FULL) return sn_calibration_affine(j->own, set);
    SN_TRY(own_springs(j->own, set));
    j->exact = sn_springs_lattice(j->own);
    return sn_spring_set_create(0, j->own->mesh->region_count, &j->set);
}

// edge: of the mesh, sorted
static void count_springs(const int *edge, int edges, sn_calibration *out) {
    out->springs = out->beyond = 0;
    for (int k = 0; k < out->set->count; k++) {
        const int *end = out->set->end + 2 * (size_t)k;
        const int low = end[0] < end[1] ? end[0] : end[1], high = end[0] + end[1] - low;
        int from = 0, to = edges - 1;
        while (from < to) {
            const int middle = from + (to - from) / 2, *e = edge + 2 * (size_t)middle;
            if (e[0] < low || (e[0] == low && e[1] < high))
                from = middle + 1;
            else
                to = middle;
        }
        if (!(out->set->stiffness[k] > 0)) continue;
        out->springs++;
        out->beyond += edge[2 * from] != low || edge[2 * from + 1] != high;
    }
}

static sn_status check_fibres(const sn_case *c) {
    for (int r = 0; r < c->mesh->region_count; r++)
        if (sn_calibration_oriented(&c->tissue[r]) && c->fibres.rule != SN_FIBRES_ALIKE)
            return sn_fail(SN_E_UNSUPPORTED,
                           "calibrate: tissue %s has fibres that turn from cell to cell; springs "
                           "get constants by direction, the same everywhere; use model coupled or "
                           "smoothed",
                           c->tissue[r].name);
    return SN_OK;
}

static sn_status calibrate(const sn_case *c, sn_calibration_rule rule, double strain, bool tested,
                           const sn_output *progress, sn_calibration *out) {
    job j = {.rule = rule, .tested = tested, .strain = strain, .share = {1, 1, 1}};
    sn_case *own = NULL;
    sn_spring_set *set = NULL;
    int *edge = NULL, edges = 0;
    sn_status status;
    *out = (sn_calibration){.rule = rule};
    if (!(strain >= 0) || strain > 2)
        return sn_fail(SN_E_RANGE, "calibrate: strain is %g, expected more than 0 and at most 2",
                       strain);
    SN_TRY(check_fibres(c));
    SN_TRY_GOTO(status, sn_calibration_case(c, &own));
    j.own = own;
    const int regions = own->mesh->region_count;
    out->region = sn_alloc((size_t)regions, sizeof *out->region);
    status = out->region ? SN_OK : SN_E_MEMORY;
    if (status != SN_OK) goto fail;
    tell(progress, 0.0, "springs");
    SN_TRY_GOTO(status, rule_springs(&j, &set));
    const bool works = has_work(&j);
    if (strain == 0 && works) {
        tell(progress, 0.1, "strain of the case");
        SN_TRY_GOTO(status, sn_calibration_strain(c, &j.strain, j.share));
    }
    j.rule_set = set;
    for (; works && out->region_count < regions; out->region_count++) {
        const int r = out->region_count;
        tell(progress, 0.2 + 0.8 * r / regions, own->mesh->region_name[r]);
        SN_TRY_GOTO(status, do_region(&j, r, &out->region[r]));
    }
    out->set = j.set ? j.set : set;
    if (j.set)
        j.set = NULL;
    else
        set = NULL;
    SN_TRY_GOTO(status, sn_mesh_edges(own->mesh, &edge, &edges));
    count_springs(edge, edges, out);
fail:
    sn_free(edge);
    sn_spring_set_destroy(set);
    sn_spring_set_destroy(j.set);
    sn_case_destroy(own);
    if (status != SN_OK) sn_calibration_destroy(out);
    return status;
}

sn_status sn_calibrate_to(const sn_case *c, sn_calibration_rule rule, double strain,
                          const sn_output *progress, sn_calibration *out) {
    return calibrate(c, rule, strain, true, progress, out);
}

sn_status sn_calibrate(const sn_case *c, sn_calibration_rule rule, const sn_output *progress,
                       sn_calibration *out) {
    return calibrate(c, rule, 0, true, progress, out);
}

sn_status sn_calibration_springs(const sn_case *c, sn_calibration_rule rule,
                                 const sn_output *progress, sn_spring_set **set) {
    sn_calibration calibration;
    *set = NULL;
    SN_TRY(calibrate(c, rule, 0, false, progress, &calibration));
    *set = calibration.set;
    calibration.set = NULL;
    sn_calibration_destroy(&calibration);
    return SN_OK;
}

void sn_calibration_destroy(sn_calibration *calibration) {
    sn_spring_set_destroy(calibration->set);
    sn_free(calibration->region);
    *calibration = (sn_calibration){0};
}
