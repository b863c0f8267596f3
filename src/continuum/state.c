// The state of a run as bytes, so that a killed run can go on.
// SPDX-License-Identifier: Apache-2.0
//
// One function, visit(), names every part of the state; it is called three times: to count, to
// write, to read.
#include "continuum/state.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "continuum/shelf.h"

#define SAME_TIME 1e-9 // of `until`

typedef enum direction { COUNT, WRITE, READ } direction;

typedef struct archive {
    direction way;
    unsigned char *at; ///< next byte
    size_t size;       ///< counted so far; of a read: bytes that are left
    bool good;         ///< false: a read came to the end, or found what cannot be
    double *memory;    ///< of the tissues of the whole body
    size_t numbers;    ///< its length
} archive;

static void pass(archive *a, void *data, size_t bytes) {
    if (a->way == COUNT) {
        a->size += bytes;
        return;
    }
    if (a->way == READ) {
        a->good &= bytes <= a->size;
        if (!a->good) return;
        memcpy(data, a->at, bytes);
        a->size -= bytes;
    } else {
        memcpy(a->at, data, bytes);
    }
    a->at += bytes;
}

static void pass_doubles(archive *a, double *data, size_t count) {
    pass(a, data, count * sizeof *data);
}

// A number that must be the same on both sides.
static void agree(archive *a, uint64_t here) {
    uint64_t there = here;
    pass(a, &there, sizeof there);
    a->good &= there == here;
}

//---- which case ---------------------------------------------------------------------------------

// What the numbers of the state mean: the case, element, analysis, exponentials of the memories.
// Not the length of the steps and the tolerance, which may be changed.
static uint64_t fingerprint(const sn_fe_march *m) {
    const int kind[] = {(int)m->c->continuum.element, (int)m->c->continuum.analysis};
    uint64_t hash = sn_hash(sn_case_fingerprint(m->c), kind, sizeof kind);
    for (int r = 0; r < m->problem->materials->count; r++)
        for (int part = 0; part < SN_PARTS; part++) {
            const sn_exponentials *e = &m->problem->materials->material[r].part[part].series;
            const double ends[] = {e->g_inf, e->viscous};
            hash = sn_hash(hash, ends, sizeof ends);
            hash = sn_hash(hash, e->g, (size_t)e->terms * sizeof *e->g);
            hash = sn_hash(hash, e->tau, (size_t)e->terms * sizeof *e->tau);
        }
    return hash;
}

//---- the parts ----------------------------------------------------------------------------------

static void visit_history(archive *a, sn_record *history, double *row, sn_status *status) {
    uint64_t rows = (uint64_t)history->rows;
    agree(a, (uint64_t)history->series_count);
    pass(a, &rows, sizeof rows);
    size_t columns = (size_t)history->series_count;
    for (uint64_t n = 0; n < rows && a->good; n++) {
        for (size_t k = 0; k < columns && a->way != READ; k++) row[k] = history->series[k].value[n];
        pass_doubles(a, row, columns);
        if (a->way != READ || !a->good) continue;
        if ((*status = sn_record_append(history, row)) != SN_OK) a->good = false;
    }
}

static void visit_inertia(archive *a, sn_fe_inertia *i, size_t nodes) {
    if (!i) return;
    pass(a, &i->moving, sizeof i->moving);
    pass_doubles(a, &i->error, 1);
    pass_doubles(a, &i->way, 1);
    double *const vectors[] = {i->u, i->v, i->a, i->r, i->reaction};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        pass_doubles(a, vectors[k], 3 * nodes);
}

static void visit_counters(archive *a, sn_fe_march *m) {
    sn_run_summary *s = m->summary;
    pass(a, &s->steps, sizeof s->steps);
    pass(a, &s->newton_iterations, sizeof s->newton_iterations);
    pass(a, &s->cutbacks, sizeof s->cutbacks);
    pass(a, &m->rounded, sizeof m->rounded);
    pass(a, &m->inaccurate, sizeof m->inaccurate);
    pass(a, &m->blind, sizeof m->blind);
    pass(a, &m->past_count, sizeof m->past_count);
    pass_doubles(a, m->past_at, SN_FE_PAST);
    double *const numbers[] = {&s->step_s,      &s->simulated_s, &s->external_work_J,    &m->wish,
                               &m->limit,       &m->elapsed,     &m->problem->reference, &m->pace,
                               &m->longest_used};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) pass_doubles(a, numbers[k], 1);
    pass(a, s->note, sizeof s->note);
}

static void visit(archive *a, sn_fe_march *m, double *time, sn_status *status) {
    sn_fe_problem *p = m->problem;
    size_t dofs = (size_t)p->space->dofs;
    agree(a, 0x336574617473u); // "state3", and the order of bytes
    agree(a, fingerprint(m));
    agree(a, dofs);
    agree(a, a->numbers);
    pass_doubles(a, time, 1);
    visit_counters(a, m);
    pass_doubles(a, m->x, dofs);
    for (int k = 0; k < SN_FE_PAST; k++) pass_doubles(a, m->past[k], dofs);
    pass_doubles(a, m->force, dofs);
    pass_doubles(a, a->memory, a->numbers);
    size_t pairs = (size_t)m->c->tool_count * (size_t)p->boundary->spots;
    if (pairs) pass(a, p->boundary->before, pairs * sizeof *p->boundary->before);
    visit_inertia(a, p->inertia, (size_t)p->space->nodes);
    visit_history(a, m->history, m->measure->row, status);
}

//---- the two ends -------------------------------------------------------------------------------

static sn_status hand_over(sn_fe_march *m, archive *a, double time) {
    sn_status status = SN_OK;
    visit(a, m, &time, &status);
    unsigned char *bytes = sn_alloc(a->size, 1);
    if (!bytes) return SN_E_MEMORY;
    a->way = WRITE;
    a->at = bytes;
    visit(a, m, &time, &status);
    status = m->restart->save(m->restart->context, bytes, a->size);
    sn_free(bytes);
    return status;
}

sn_status sn_fe_state_save(sn_fe_march *m, double time) {
    const sn_fe_ranks *ranks = m->problem->space->ranks;
    sn_fe_materials *of = m->problem->materials;
    archive a = {.way = COUNT, .good = true, .memory = of->state, .numbers = of->numbers};
    sn_fe_shelf shelf = {0};
    sn_status status = SN_OK;
    if (!sn_fe_from_first(ranks, m->restart && m->restart->save)) return SN_OK;
    // a run that goes on from here has no factors either
    if (m->problem->solver) sn_fe_solver_forget(m->problem->solver);
    m->elapsed = sn_clock() - m->started;
    if (ranks->count > 1) {
        status = sn_fe_agree(ranks, sn_fe_shelf_init(m->problem, ranks->rank == 0, &shelf));
        if (status == SN_OK) status = sn_fe_shelf_fill(&shelf);
        a.memory = shelf.all;
        a.numbers = shelf.total;
    }
    if (status == SN_OK)
        status = sn_fe_agree(ranks, ranks->rank == 0 ? hand_over(m, &a, time) : SN_OK);
    sn_fe_shelf_free(&shelf);
    return status;
}

static sn_status take_up(sn_fe_march *m, archive *a, int *stop) {
    sn_status status = SN_OK;
    double time = 0.0;
    uint64_t head[2];
    if (a->size >= sizeof head) memcpy(head, m->restart->state, sizeof head);
    if (a->size >= sizeof head && head[1] != fingerprint(m))
        return sn_fail(SN_E_DATA, "resume: the state is not of this case: mesh, tissues, loads, "
                                  "element and analysis must be those of the run that was killed");
    unsigned char *copy = sn_alloc(a->size, 1);
    if (!copy) return SN_E_MEMORY;
    memcpy(copy, m->restart->state, a->size);
    a->at = copy;
    visit(a, m, &time, &status);
    sn_free(copy);
    if (status != SN_OK) return status;
    if (!a->good || a->size != 0)
        return sn_fail(SN_E_DATA, "resume: the state of %zu bytes is damaged or of another version",
                       m->restart->bytes);
    m->started = sn_clock() - m->elapsed;
    for (int k = 0; k < m->schedule.count; k++)
        if (fabs(m->schedule.stop[k].time - time) <= SAME_TIME * m->c->until) *stop = k;
    if (*stop < 0)
        return sn_fail(SN_E_DATA, "resume: the case has no output at %g s, where the state is",
                       time);
    return SN_OK;
}

sn_status sn_fe_state_restore(sn_fe_march *m, int *stop) {
    const sn_fe_ranks *ranks = m->problem->space->ranks;
    sn_fe_materials *of = m->problem->materials;
    sn_fe_shelf shelf = {0};
    sn_status status = SN_OK;
    *stop = -1;
    if (!m->restart || !m->restart->state) return SN_OK;
    archive a = {.way = READ, .good = true, .size = m->restart->bytes, .memory = of->state};
    a.numbers = of->numbers;
    if (ranks->count > 1) {
        status = sn_fe_shelf_init(m->problem, true, &shelf);
        a.memory = shelf.all;
        a.numbers = shelf.total;
    }
    if (status == SN_OK) status = take_up(m, &a, stop);
    if (status == SN_OK && ranks->count > 1) sn_fe_shelf_take(&shelf);
    sn_fe_shelf_free(&shelf);
    return sn_fe_agree(ranks, status);
}
