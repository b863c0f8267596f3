// The tissue of every region with the memory of every quadrature point.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = SN_FE_POINTS };

static void solid_laws(char text[SN_TEXT_MAX]) {
    size_t used = 0;
    text[0] = 0;
    for (int k = 0; k < sn_law_count(); k++) {
        const sn_law *law = sn_law_at(k);
        if (law->kind != SN_LAW_SOLID || used + strlen(law->name) + 3 > SN_TEXT_MAX) continue;
        used +=
            (size_t)snprintf(text + used, SN_TEXT_MAX - used, "%s%s", used ? ", " : "", law->name);
    }
}

static sn_status check_law(const sn_case *c, const sn_fe_space *s, int region, double *bulk) {
    const sn_tissue *tissue = c->tissue + region;
    const char *where = c->mesh->region_name[region];
    if (tissue->law->kind != SN_LAW_SOLID) {
        char laws[SN_TEXT_MAX];
        solid_laws(laws);
        return sn_fail(SN_E_UNSUPPORTED,
                       "region \"%s\": the law %s is not a three-dimensional solid, which the "
                       "continuum needs; use one of %s, or the engine springs",
                       where, tissue->law->name, laws);
    }
    sn_moduli moduli;
    sn_tissue_moduli(tissue, &moduli);
    *bulk = sn_tissue_value(tissue, "bulk_modulus");
    if (isnan(*bulk)) *bulk = moduli.bulk;
    if (isinf(*bulk) && !s->element.mixed)
        return sn_fail(
            SN_E_UNSUPPORTED,
            "region \"%s\": an incompressible tissue needs the element P2P1, not %s; set "
            "continuum: {element: P2P1} or give a finite bulk_modulus",
            where, s->element.name);
    return SN_OK;
}

static sn_status init_memories(const sn_case *c, const char *where, double shortest,
                               sn_fe_material *m) {
    static const int first[SN_PARTS + 1] = {0, SN_FE_VOLUME, SN_FE_FIBRES, SN_FE_MEMORY};
    double longest = fmax(c->until, 2.0 * shortest);
    m->splits = sn_tissue_split(m->tissue, m->split);
    m->numbers = m->splits > 1 ? SN_FE_MEMORY : SN_FE_FIBRES;
    for (int k = 0; k < SN_PARTS; k++) {
        sn_fe_memory *part = m->part + k;
        sn_exponentials *e = &part->series;
        part->factor = 1.0;
        part->first = first[k];
        part->count = k == SN_PART_FIBRE && m->splits == 1 ? 0 : first[k + 1] - first[k];
        if (part->count == 0) continue;
        sn_status status = sn_memory_compress(sn_tissue_memory(m->tissue, (sn_part)k), shortest,
                                              longest, c->continuum.memory_tolerance, e);
        if (status != SN_OK) return sn_fail_within(status, "region \"%s\"", where);
        m->remembers |= e->terms > 0 || e->viscous > 0.0 || e->g_inf < 1.0;
    }
    return SN_OK;
}

static sn_status init_material(const sn_case *c, const sn_fe_space *s, int region, double shortest,
                               sn_fe_material *m) {
    m->tissue = c->tissue + region;
    SN_TRY(check_law(c, s, region, &m->bulk));
    return init_memories(c, c->mesh->region_name[region], shortest, m);
}

size_t sn_fe_material_kept(const sn_fe_material *m) {
    size_t sum = m->remembers ? 2 * (size_t)m->numbers : 0;
    for (int k = 0; k < SN_PARTS && m->remembers; k++)
        sum += (size_t)(m->part[k].series.terms * m->part[k].count);
    return sum;
}

void sn_fe_materials_destroy(sn_fe_materials *m) {
    if (!m) return;
    sn_free(m->material);
    sn_free(m->state);
    sn_free(m->at);
    sn_free(m);
}

sn_status sn_fe_materials_create(const sn_case *c, const sn_fe_space *s, double shortest,
                                 sn_fe_materials **out) {
    sn_status status = SN_E_MEMORY;
    sn_fe_materials *m = *out = sn_alloc(1, sizeof *m);
    if (!m) return SN_E_MEMORY;
    m->count = c->mesh->region_count;
    m->material = sn_alloc((size_t)m->count, sizeof *m->material);
    m->at = sn_alloc((size_t)s->batches, sizeof *m->at);
    if (!m->material || !m->at) goto fail;
    for (int r = 0; r < m->count; r++) {
        SN_TRY_GOTO(status, init_material(c, s, r, shortest, m->material + r));
        m->remembers |= m->material[r].remembers;
        for (int k = 0; k < SN_PARTS; k++)
            m->viscous |= m->material[r].part[k].series.viscous > 0.0;
    }
    size_t total = 0;
    for (int b = 0; b < s->batches; b++) {
        m->at[b] = total;
        total += sn_fe_material_kept(m->material + s->batch_region[b]) * N;
    }
    status = SN_E_MEMORY;
    m->numbers = total;
    m->state = sn_alloc(total, sizeof *m->state);
    if (!m->state) goto fail;
    return SN_OK;
fail:
    sn_fe_materials_destroy(m);
    *out = NULL;
    return status;
}

static void set_factors(sn_fe_memory *m, double h) {
    const sn_exponentials *e = &m->series;
    if (h > 0.0) sn_exponentials_factors(e, h, m->decay, m->gain);
    m->factor = e->g_inf + (h > 0.0 ? e->viscous / h : 0.0);
    for (int k = 0; k < e->terms; k++) {
        if (!(h > 0.0)) { // the limit of the factors
            m->decay[k] = 1.0;
            m->gain[k] = e->g[k];
        }
        m->factor += m->gain[k];
    }
}

// `past` of one part; H points to its first exponential and is moved behind its last.
static void recall(const sn_fe_memory *m, const double *before, const double **H, double *past) {
    size_t count = (size_t)m->count * N, first = (size_t)m->first * N;
    double back = m->factor - m->series.g_inf;
    for (size_t k = 0; k < count; k++) past[first + k] = -back * before[first + k];
    for (int i = 0; i < m->series.terms; i++, *H += count)
        for (size_t k = 0; k < count; k++) past[first + k] += m->decay[i] * (*H)[k];
}

void sn_fe_materials_begin(sn_fe_materials *m, const sn_fe_space *s, double h) {
    for (int r = 0; r < m->count; r++) {
        sn_fe_material *of = m->material + r;
        if (!of->remembers) continue;
        of->step = h;
        for (int k = 0; k < SN_PARTS; k++)
            if (of->part[k].count > 0) set_factors(of->part + k, h);
    }
    for (int b = 0; b < s->batches; b++) {
        const sn_fe_material *of = m->material + s->batch_region[b];
        if (!of->remembers) continue;
        size_t block = (size_t)of->numbers * N;
        double *past = m->state + m->at[b];
        const double *before = past + block, *H = before + block;
        for (int k = 0; k < SN_PARTS; k++) recall(of->part + k, before, &H, past);
    }
}

void sn_fe_materials_commit(sn_fe_materials *m, const sn_fe_space *s, int batch,
                            const double *elastic) {
    const sn_fe_material *of = m->material + s->batch_region[batch];
    if (!of->remembers) return;
    size_t block = (size_t)of->numbers * N;
    double *before = m->state + m->at[batch] + block, *H = before + block;
    for (int p = 0; p < SN_PARTS; p++) {
        const sn_fe_memory *part = of->part + p;
        size_t count = (size_t)part->count * N, first = (size_t)part->first * N;
        for (int i = 0; i < part->series.terms; i++, H += count)
            for (size_t k = 0; k < count; k++)
                H[k] = part->decay[i] * H[k] +
                       part->gain[i] * (elastic[first + k] - before[first + k]);
    }
    memcpy(before, elastic, block * sizeof *before);
}
