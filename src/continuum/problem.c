// The discrete problem: the balance of forces at a state, its tangent, and what a step remembers.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/problem.h"

#include <math.h>
#include <string.h>

// Forces that belong to strains below 1e-5 are compared with the forces of a strain of 1e-5:
// Newton's tolerance (1e-9 or so of it) then lies above what rounding does to a body that is only
// turned or not loaded at all.
static double rounding_reference(const sn_fe_problem *p) {
    double stiff = 0.0;
    for (int r = 0; r < p->materials->count; r++) {
        sn_moduli moduli;
        sn_tissue_moduli(p->c->tissue + r, &moduli);
        stiff = fmax(stiff, moduli.shear + (p->space->element.mixed ? 0.0 : moduli.bulk));
    }
    return 1e-5 * stiff * cbrt(pow(sn_mesh_volume(p->c->mesh), 2));
}

static void integrate_pressures(sn_fe_problem *p) {
    const sn_fe_space *s = p->space;
    int width = s->batch_cells;
    for (int b = 0; b < s->batches; b++) {
        const int *node = s->node + (size_t)b * (size_t)(s->element.nodes * width);
        for (int k = 0; k < 4; k++)
            for (int c = 0; c < s->batch_count[b]; c++)
                p->flux_scale[node[k * width + c]] += 0.25 * s->volume[b * width + c];
    }
    sn_fe_gather_corners(s, p->flux_scale);
}

void sn_fe_problem_destroy(sn_fe_problem *p) {
    if (!p) return;
    sn_fe_solver_destroy(p->solver);
    sn_fe_inertia_destroy(p->inertia);
    sn_fe_boundary_destroy(p->boundary, p->c);
    sn_fe_materials_destroy(p->materials);
    sn_fe_pattern_destroy(p->pattern);
    sn_fe_space_destroy(p->space);
    void *const parts[] = {p->work,     p->entry,  p->prescribed, p->residual,
                           p->external, p->lifted, p->flux_scale, p->soft};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(p);
}

static sn_status alloc_vectors(sn_fe_problem *p, bool iterative) {
    const sn_fe_space *s = p->space;
    size_t dofs = (size_t)s->dofs, softs = iterative && s->element.mixed ? (size_t)s->corners : 0;
    p->work = sn_alloc(1, sizeof *p->work);
    p->entry = sn_alloc((size_t)p->pattern->row_start[p->pattern->rows], sizeof *p->entry);
    p->prescribed = sn_alloc(3 * (size_t)s->nodes, sizeof *p->prescribed);
    p->residual = sn_alloc(dofs, sizeof *p->residual);
    p->external = sn_alloc(dofs, sizeof *p->external);
    p->lifted = sn_alloc(dofs, sizeof *p->lifted);
    p->flux_scale = sn_alloc((size_t)s->corners, sizeof *p->flux_scale);
    if (softs) p->soft = sn_alloc(softs, sizeof *p->soft);
    return p->work && p->entry && p->prescribed && p->residual && p->external && p->lifted &&
                   p->flux_scale && (p->soft || !softs)
               ? SN_OK
               : SN_E_MEMORY;
}

// What each rank makes for itself, with what its own cells add to dead loads.
static sn_status create_tissue(sn_fe_problem *p, double shortest) {
    SN_TRY(sn_fe_materials_create(p->c, p->space, shortest, &p->materials));
    return sn_fe_boundary_create(p->c, p->space, &p->boundary);
}

static sn_status create_system(sn_fe_problem *p) {
    const sn_case *c = p->c;
    bool dynamic = c->continuum.analysis == SN_ANALYSIS_DYNAMIC;
    bool iterative = c->continuum.solver == SN_SOLVER_ITERATIVE;
    if (!dynamic) { // inertia holds what the supports leave free
        sn_fe_rigid_find(p->space);
        SN_TRY(sn_fe_rigid_parts(p->space, c->mesh));
        SN_TRY(sn_fe_rigid_hinges(p->space, c->mesh));
        SN_TRY(sn_fe_rigid_check(p->space, c, p->boundary));
    }
    SN_TRY(sn_fe_pattern_create(p->space, iterative, &p->pattern));
    if (dynamic) SN_TRY(sn_fe_inertia_create(c, p->space, p->pattern, &p->inertia));
    return alloc_vectors(p, iterative);
}

static void assemble(void *problem, bool pressed);

sn_status sn_fe_problem_create(const sn_case *c, double shortest, sn_fe_problem **problem) {
    sn_status status = SN_OK;
    sn_fe_problem *p = *problem = sn_alloc(1, sizeof *p);
    if (!p) return SN_E_MEMORY;
    p->c = c;
    SN_TRY_GOTO(status, sn_fe_space_create(c, &p->space));
    SN_TRY_GOTO(status, sn_fe_agree(p->space->ranks, create_tissue(p, shortest)));
    if (p->boundary->gravity) sn_fe_gather_nodes(p->space, p->boundary->gravity);
    SN_TRY_GOTO(status, sn_fe_agree(p->space->ranks, create_system(p)));
    p->least_reference = rounding_reference(p);
    integrate_pressures(p);
    const sn_fe_solver_def def = {.space = p->space,
                                  .pattern = p->pattern,
                                  .value = p->entry,
                                  .soft = p->soft,
                                  .symmetric = p->boundary->symmetric,
                                  .iterative = p->pattern->whole,
                                  .assemble = assemble,
                                  .context = p};
    if (p->pattern->unknowns > 0) SN_TRY_GOTO(status, sn_fe_solver_create(&def, &p->solver));
    sn_fe_problem_begin(p, (sn_fe_level){0.0, 0.0, 0.0});
    return SN_OK;
fail:
    sn_fe_problem_destroy(p);
    *problem = NULL;
    return status;
}

void sn_fe_problem_begin(sn_fe_problem *p, sn_fe_level level) {
    p->level = level;
    sn_fe_materials_begin(p->materials, p->space, level.step);
    if (p->inertia) sn_fe_inertia_begin(p->inertia, p->c, p->space, level.time, level.step);
    sn_fe_space_prescribed(p->space, p->c, level.time, p->prescribed);
    for (size_t n = 0; n < 3 * (size_t)p->space->nodes; n++) p->prescribed[n] *= level.scale;
}

static double force_reference(const sn_fe_problem *p, const sn_fe_balance *balance) {
    return fmax(fmax(balance->reference, p->reference), p->least_reference);
}

void sn_fe_problem_weigh(sn_fe_problem *p, const sn_fe_balance *balance) {
    double scale = 0.0;
    if (!p->space->element.mixed || !p->solver) return;
    for (int a = 0; a < p->space->corners; a++) scale += p->flux_scale[a] * p->flux_scale[a];
    sn_fe_solver_weigh(p->solver, force_reference(p, balance) / sqrt(scale));
}

// Reactions beyond this are of a state that stiffened out of all proportion on Newton's way:
// measured by them, whatever is out of balance would look small. A lever of 1 : 1e5 is still
// believed, and where nothing but prescribed motion acts, forces of 1e4 strains of the tissue at
// rest.
static double most_reaction(const sn_fe_problem *p, double loads) {
    return fmax(1e5 * fmax(loads, p->reference), 1e9 * p->least_reference);
}

static void measure(const sn_fe_problem *p, double inertia, sn_fe_balance *out) {
    const sn_fe_space *s = p->space;
    double free = 0.0, held = 0.0, external = 0.0, flux = 0.0, scale = 0.0;
    for (int n = 0; n < 3 * s->nodes; n++) {
        double square = p->residual[n] * p->residual[n];
        *(p->pattern->row[n] != SN_FE_PRESCRIBED ? &free : &held) += square;
        external += p->external[n] * p->external[n];
    }
    for (int n = 3 * s->nodes, a = 0; n < s->dofs; n++, a++) {
        flux += p->residual[n] * p->residual[n];
        scale += p->flux_scale[a] * p->flux_scale[a];
    }
    out->force = sqrt(free);
    double loads = fmax(sqrt(external), inertia);
    out->reference = fmax(fmin(sqrt(held), most_reaction(p, loads)), loads);
    out->volume = scale > 0.0 ? sqrt(flux / scale) : 0.0;
    out->error = fmax(out->force / force_reference(p, out), out->volume);
    out->sound = isfinite(out->error);
    if (!out->sound) out->fault = (sn_fe_fault){.cell = 0, .J = (double)NAN};
}

void sn_fe_problem_balance(sn_fe_problem *p, const double *x, sn_fe_balance *out) {
    const sn_fe_space *s = p->space;
    *out = (sn_fe_balance){.error = (double)INFINITY};
    memset(p->residual, 0, (size_t)s->dofs * sizeof *p->residual);
    memset(p->external, 0, (size_t)s->dofs * sizeof *p->external);
    out->fault.cell = s->cells;
    for (int b = 0; b < s->batches && out->fault.cell == s->cells; b++)
        if (sn_fe_points_at(s, p->materials, b, x, 0, &p->work->points, &out->fault))
            sn_fe_cell_forces(s, b, p->work, p->residual);
    int own = out->fault.cell;
    sn_fe_gather_least(s, p->residual, &out->fault.cell);
    if (out->fault.cell < s->cells) {
        sn_fe_from_holder(s->ranks, out->fault.cell == own, &out->fault.J);
        return;
    }
    sn_fe_boundary_apply(p->boundary, p->c, s, p->level.time, p->level.scale, x, p->external, NULL);
    for (int n = 0; n < s->dofs; n++) p->residual[n] -= p->external[n];
    double inertia = 0.0;
    if (p->inertia) inertia = sn_fe_inertia_add(p->inertia, s, p->pattern, x, p->residual);
    measure(p, inertia, out);
}

static void assemble_cells(sn_fe_problem *p, unsigned what) {
    const sn_fe_space *s = p->space;
    sn_fe_matrix matrix = {p->pattern, s, p->entry, p->lift, p->lifted, p->soft};
    sn_fe_fault fault;
    memset(p->entry, 0, (size_t)p->pattern->row_start[p->pattern->rows] * sizeof *p->entry);
    memset(p->lifted, 0, (size_t)s->dofs * sizeof *p->lifted);
    if (p->soft) memset(p->soft, 0, (size_t)s->corners * sizeof *p->soft);
    for (int k = 0; k < p->pattern->held_count; k++) p->entry[p->pattern->held[k]] = 1.0;
    for (int b = 0; b < s->batches; b++) {
        bool good = sn_fe_points_at(s, p->materials, b, p->at, what, &p->work->points, &fault);
        SN_ASSERT(good);
        (void)good;
        sn_fe_cell_tangent(s, p->materials->material + s->batch_region[b], b, p->work, &matrix);
    }
}

// The tangent of p->at; see sn_fe_solver_def.
static void assemble(void *problem, bool pressed) {
    sn_fe_problem *p = problem;
    const sn_fe_space *s = p->space;
    sn_fe_matrix matrix = {p->pattern, s, p->entry, p->lift, p->lifted, NULL};
    assemble_cells(p, SN_FE_TANGENT | (pressed ? 0u : SN_FE_UNPRESSED));
    if (p->cells_alone) return;
    if (p->inertia) sn_fe_inertia_tangent(p->inertia, p->pattern, p->entry);
    memset(p->external, 0, (size_t)s->dofs * sizeof *p->external);
    sn_fe_boundary_apply(p->boundary, p->c, s, p->level.time, p->level.scale, p->at, p->external,
                         &matrix);
}

static void assemble_at(sn_fe_problem *p, const double *x, const double *lift, bool cells_alone) {
    p->at = x;
    p->lift = lift;
    p->cells_alone = cells_alone;
    assemble(p, true);
}

void sn_fe_problem_stiffness(sn_fe_problem *p, const double *x, const double *lift) {
    assemble_at(p, x, lift, true);
}

void sn_fe_problem_tangent(sn_fe_problem *p, const double *x, const double *lift) {
    assemble_at(p, x, lift, false);
}

void sn_fe_problem_commit(sn_fe_problem *p, const double *x, const sn_fe_balance *balance) {
    const sn_fe_space *s = p->space;
    sn_fe_fault fault;
    for (int b = 0; b < s->batches; b++) {
        if (!p->materials->material[s->batch_region[b]].remembers) continue;
        bool good = sn_fe_points_at(s, p->materials, b, x, 0, &p->work->points, &fault);
        SN_ASSERT(good);
        (void)good;
        sn_fe_materials_commit(p->materials, s, b, p->work->points.T);
    }
    sn_fe_boundary_commit(p->boundary, p->c);
    if (p->inertia) sn_fe_inertia_commit(p->inertia, s, p->pattern, x, p->residual);
    p->reference = fmax(p->reference, balance->reference);
}
