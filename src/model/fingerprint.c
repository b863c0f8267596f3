// A number that tells cases apart, so that a saved state never goes on with another one.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "model/tool.h"

static uint64_t mix_history(uint64_t hash, const sn_history *h) {
    if (!h) return sn_hash(hash, "none", 4);
    hash = sn_hash(hash, h->time, (size_t)h->count * sizeof *h->time);
    return sn_hash(hash, h->value, (size_t)h->count * (size_t)h->channels * sizeof *h->value);
}

static uint64_t mix_memory(uint64_t hash, const sn_memory *m) {
    const int numbers[] = {m->terms, (int)strlen(m->law->name)};
    hash = sn_hash(hash, numbers, sizeof numbers);
    hash = sn_hash(hash, m->law->name, strlen(m->law->name));
    return sn_hash(hash, m->value, sizeof m->value);
}

static uint64_t mix_tissue(uint64_t hash, const sn_tissue *t) {
    const double numbers[] = {t->density, t->poissons_ratio, t->terms, t->branched};
    hash = sn_hash(hash, t->law->name, strlen(t->law->name));
    hash = sn_hash(hash, t->value, sizeof t->value);
    hash = sn_hash(hash, numbers, sizeof numbers);
    for (int part = 0; part < SN_PARTS; part++)
        hash = mix_memory(hash, sn_tissue_memory(t, (sn_part)part));
    return hash;
}

static uint64_t mix_mesh(uint64_t hash, const sn_mesh *m) {
    hash = sn_hash(hash, m->node, 3 * (size_t)m->node_count * sizeof *m->node);
    hash = sn_hash(hash, m->cell, 4 * (size_t)m->cell_count * sizeof *m->cell);
    hash = sn_hash(hash, m->region, (size_t)m->cell_count * sizeof *m->region);
    for (int k = 0; k < m->surface_count; k++) {
        const sn_surface *s = &m->surface[k];
        hash = sn_hash(hash, s->face, 3 * (size_t)s->face_count * sizeof *s->face);
    }
    return hash;
}

static uint64_t mix_load(uint64_t hash, const sn_load *l) {
    const bool at_point = l->kind == SN_LOAD_FORCE;
    const double numbers[] = {(double)l->kind, at_point ? -1 : l->surface,
                              l->pressure,     l->free[0],
                              l->free[1],      l->free[2]};
    hash = sn_hash(mix_history(hash, l->factor), numbers, sizeof numbers);
    hash = sn_hash(hash, l->vector, sizeof l->vector);
    return at_point ? sn_hash(hash, l->point, sizeof l->point) : hash;
}

static uint64_t mix_tool(uint64_t hash, const sn_tool *t) {
    const double numbers[] = {(double)t->kind, t->radius,   t->axis[0], t->axis[1],
                              t->axis[2],      t->at[0],    t->at[1],   t->at[2],
                              t->friction,     t->grasp[0], t->grasp[1]};
    hash = sn_hash(mix_history(mix_history(hash, t->path), t->turn), numbers, sizeof numbers);
    if (!t->surface) return hash;
    int corners;
    const double *corner = sn_tool_surface_corners(t->surface, &corners);
    return sn_hash(hash, corner, 3 * (size_t)corners * sizeof *corner);
}

static uint64_t mix_probe(uint64_t hash, const sn_probe *p) {
    const int what[] = {(int)p->kind, p->kind == SN_PROBE_POINT ? -1 : p->surface};
    hash = sn_hash(hash, what, sizeof what);
    return p->kind == SN_PROBE_POINT ? sn_hash(hash, p->point, sizeof p->point) : hash;
}

static uint64_t mix_fibres(uint64_t hash, const sn_case *c) {
    const sn_fibres *f = &c->fibres;
    const int what[] = {(int)f->rule, f->wall[0], f->wall[1], f->sheet_normal};
    hash = sn_hash(sn_hash(hash, c->fibre, sizeof c->fibre), what, sizeof what);
    hash = sn_hash(hash, f->sheet, sizeof f->sheet);
    hash = sn_hash(hash, f->axis, sizeof f->axis);
    hash = sn_hash(hash, f->through, sizeof f->through);
    hash = sn_hash(hash, f->angle, sizeof f->angle);
    return f->listed ? sn_hash(hash, f->listed, 6 * (size_t)f->count * sizeof *f->listed) : hash;
}

static uint64_t mix_springs(uint64_t hash, const sn_spring_set *s) {
    if (!s) return hash;
    const size_t count = (size_t)s->count, regions = (size_t)s->region_count;
    hash = sn_hash(hash, s->end, 2 * count * sizeof *s->end);
    hash = sn_hash(hash, s->region, count * sizeof *s->region);
    hash = sn_hash(hash, s->stiffness, count * sizeof *s->stiffness);
    hash = sn_hash(hash, s->exponent, regions * sizeof *s->exponent);
    hash = sn_hash(hash, s->square, regions * SN_SPRING_SQUARES * sizeof *s->square);
    return sn_hash(hash, s->bulk, regions * sizeof *s->bulk);
}

uint64_t sn_case_fingerprint(const sn_case *c) {
    const int counts[] = {c->support_count, c->load_count, c->tool_count, c->probe_count};
    uint64_t hash = mix_fibres(sn_hash(SN_HASH_START, counts, sizeof counts), c);
    hash = sn_hash(hash, c->gravity, sizeof c->gravity);
    hash = mix_mesh(hash, c->mesh);
    for (int k = 0; k < c->mesh->region_count; k++) hash = mix_tissue(hash, &c->tissue[k]);
    for (int k = 0; k < c->support_count; k++) {
        const sn_support *s = &c->support[k];
        const int what[] = {s->surface, s->fix[0], s->fix[1], s->fix[2]};
        hash = sn_hash(hash, what, sizeof what);
    }
    for (int k = 0; k < c->load_count; k++) hash = mix_load(hash, &c->load[k]);
    for (int k = 0; k < c->tool_count; k++) hash = mix_tool(hash, &c->tool[k]);
    for (int k = 0; k < c->probe_count; k++) hash = mix_probe(hash, &c->probe[k]);
    return mix_springs(hash, c->springs_given);
}
