// The tissue of every region with the memory of every quadrature point.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK = SN_FE_MEMORY * SN_FE_POINTS };

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

static sn_status init_material(const sn_case *c, const sn_fe_space *s, int region, double shortest,
                               sn_fe_material *m) {
    m->tissue = c->tissue + region;
    m->factor = 1.0;
    SN_TRY(check_law(c, s, region, &m->bulk));
    double longest = fmax(c->until, 2.0 * shortest);
    sn_status status = sn_memory_compress(&m->tissue->memory, shortest, longest,
                                          c->continuum.memory_tolerance, &m->series);
    if (status != SN_OK)
        return sn_fail_within(status, "region \"%s\"", c->mesh->region_name[region]);
    m->remembers = m->series.terms > 0 || m->series.viscous > 0.0 || m->series.g_inf < 1.0;
    return SN_OK;
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
        m->viscous |= m->material[r].series.viscous > 0.0;
    }
    size_t total = 0;
    for (int b = 0; b < s->batches; b++) {
        const sn_fe_material *of = m->material + s->batch_region[b];
        m->at[b] = total;
        if (of->remembers) total += (size_t)(2 + of->series.terms) * BLOCK;
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

static void set_factors(sn_fe_material *m, double h) {
    const sn_exponentials *e = &m->series;
    m->step = h;
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

void sn_fe_materials_begin(sn_fe_materials *m, const sn_fe_space *s, double h) {
    for (int r = 0; r < m->count; r++)
        if (m->material[r].remembers) set_factors(m->material + r, h);
    for (int b = 0; b < s->batches; b++) {
        const sn_fe_material *of = m->material + s->batch_region[b];
        if (!of->remembers) continue;
        double *past = m->state + m->at[b], *before = past + BLOCK;
        double back = of->factor - of->series.g_inf;
        for (int k = 0; k < BLOCK; k++) past[k] = -back * before[k];
        for (int i = 0; i < of->series.terms; i++) {
            const double *H = before + (size_t)(i + 1) * BLOCK;
            for (int k = 0; k < BLOCK; k++) past[k] += of->decay[i] * H[k];
        }
    }
}

void sn_fe_materials_commit(sn_fe_materials *m, const sn_fe_space *s, int batch,
                            const double *elastic) {
    const sn_fe_material *of = m->material + s->batch_region[batch];
    if (!of->remembers) return;
    double *before = m->state + m->at[batch] + BLOCK;
    for (int i = 0; i < of->series.terms; i++) {
        double *H = before + (size_t)(i + 1) * BLOCK;
        for (int k = 0; k < BLOCK; k++)
            H[k] = of->decay[i] * H[k] + of->gain[i] * (elastic[k] - before[k]);
    }
    memcpy(before, elastic, BLOCK * sizeof *before);
}
