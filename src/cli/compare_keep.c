// sinew compare: results that are kept, so that an interrupted comparison goes on.
// SPDX-License-Identifier: Apache-2.0
//
// A kept file is made of bytes of this machine and this version: a head with the sizes of the
// structures, the structure itself, then the arrays that it owns. The name is a fingerprint of
// everything that the numbers depend on, so that a case that was changed is run anew.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/compare.h"

//---- fingerprint ---------------------------------------------------------------------------------

// FNV-1a, 64 bits
static unsigned long long mix(unsigned long long hash, const void *bytes, size_t count) {
    const unsigned char *at = bytes;
    for (size_t k = 0; k < count; k++) hash = (hash ^ at[k]) * 1099511628211ull;
    return hash;
}

typedef struct fingerprint {
    unsigned long long hash;
} fingerprint;

static void add_text(fingerprint *f, const char *text) {
    f->hash = mix(f->hash, text, strlen(text) + 1);
}

static void add_number(fingerprint *f, double value) {
    f->hash = mix(f->hash, &value, sizeof value);
}

static void add_numbers(fingerprint *f, const double *value, size_t count) {
    add_number(f, (double)count);
    f->hash = mix(f->hash, value, count * sizeof *value);
}

static void add_integers(fingerprint *f, const int *value, size_t count) {
    add_number(f, (double)count);
    f->hash = mix(f->hash, value, count * sizeof *value);
}

static void add_history(fingerprint *f, const sn_history *h) {
    add_number(f, h ? h->count : -1);
    if (!h) return;
    add_numbers(f, h->time, (size_t)h->count);
    add_numbers(f, h->value, (size_t)(h->count * h->channels));
}

static void add_memory(fingerprint *f, const sn_memory *m) {
    add_text(f, m->law ? m->law->name : "");
    add_number(f, m->terms);
    add_numbers(f, m->value, SN_VALUES_MAX);
}

static void add_tissue(fingerprint *f, const sn_tissue *t) {
    add_text(f, t->law->name);
    add_number(f, t->terms);
    add_numbers(f, t->value, SN_VALUES_MAX);
    add_number(f, t->poissons_ratio);
    add_number(f, t->density);
    for (int k = 0; k < SN_PARTS; k++) add_memory(f, sn_tissue_memory(t, (sn_part)k));
}

static void add_mesh(fingerprint *f, const sn_mesh *m) {
    add_numbers(f, m->node, 3 * (size_t)m->node_count);
    add_integers(f, m->cell, 4 * (size_t)m->cell_count);
    add_integers(f, m->region, (size_t)m->cell_count);
    for (int s = 0; s < m->surface_count; s++)
        add_integers(f, m->surface[s].face, 3 * (size_t)m->surface[s].face_count);
}

static void add_tool(fingerprint *f, const sn_tool *t) {
    add_text(f, t->name);
    add_number(f, t->kind);
    add_number(f, t->radius);
    add_numbers(f, t->axis, 3);
    add_numbers(f, t->at, 3);
    add_number(f, t->friction);
    add_number(f, sn_tool_reach(t));
    add_history(f, t->path);
    add_history(f, t->turn);
}

static void add_what_acts(fingerprint *f, const sn_case *c) {
    for (int i = 0; i < c->support_count; i++) {
        add_number(f, c->support[i].surface);
        for (int d = 0; d < 3; d++) add_number(f, c->support[i].fix[d]);
    }
    for (int i = 0; i < c->load_count; i++) {
        const sn_load *load = &c->load[i];
        add_number(f, load->kind);
        add_number(f, load->surface);
        add_numbers(f, load->point, 3);
        add_numbers(f, load->vector, 3);
        for (int d = 0; d < 3; d++) add_number(f, load->free[d]);
        add_number(f, load->pressure);
        add_history(f, load->factor);
    }
    for (int i = 0; i < c->tool_count; i++) add_tool(f, &c->tool[i]);
    for (int i = 0; i < c->probe_count; i++) {
        add_text(f, c->probe[i].name);
        add_number(f, c->probe[i].kind);
        add_number(f, c->probe[i].surface);
        add_numbers(f, c->probe[i].point, 3);
    }
}

static void add_settings(fingerprint *f, const sn_case *c) {
    const sn_springs_def *s = &c->springs;
    const sn_continuum_def *e = &c->continuum;
    const double numbers[] = {c->until,
                              c->output_every,
                              (double)s->integrator,
                              (double)s->scheme,
                              s->step,
                              (double)s->precision,
                              s->damping,
                              s->stiffness_damping,
                              s->memory_tolerance,
                              (double)e->analysis,
                              e->steps,
                              e->step,
                              e->rho_infinity,
                              e->tolerance,
                              e->memory_tolerance};
    add_numbers(f, numbers, sizeof numbers / sizeof numbers[0]);
}

void compare_key(const sn_case *c, const char *model, int mesh, const char *reference,
                 char key[17]) {
    fingerprint f = {14695981039346656037ull};
    add_text(&f, sn_version());
    add_text(&f, model);
    add_text(&f, reference);
    add_number(&f, mesh);
    add_mesh(&f, c->mesh);
    if (c->has_shape) add_number(&f, c->shape.pattern);
    for (int r = 0; r < c->mesh->region_count; r++) add_tissue(&f, &c->tissue[r]);
    add_numbers(&f, c->fibre, 3);
    add_numbers(&f, c->gravity, 3);
    add_what_acts(&f, c);
    add_settings(&f, c);
    snprintf(key, 17, "%016llx", f.hash);
}

//---- bytes ---------------------------------------------------------------------------------------

typedef struct bytes {
    char *data;
    size_t size, room, at;
    bool good; ///< nothing failed so far
} bytes;

static const char head[16] = "sinew kept 1";

static void put(bytes *b, const void *data, size_t count) {
    if (!b->good) return;
    if (b->size + count > b->room) {
        size_t room = 2 * (b->size + count);
        char *grown = sn_resize(b->data, room, 1);
        b->good = grown != NULL;
        if (!grown) return;
        b->data = grown;
        b->room = room;
    }
    if (count) memcpy(b->data + b->size, data, count);
    b->size += count;
}

static void get(bytes *b, void *data, size_t count) {
    b->good = b->good && b->size - b->at >= count;
    if (!b->good) return;
    if (count) memcpy(data, b->data + b->at, count);
    b->at += count;
}

static double *get_numbers(bytes *b, size_t count) {
    b->good = b->good && count <= (b->size - b->at) / sizeof(double);
    double *value = b->good ? sn_alloc(count, sizeof *value) : NULL;
    b->good = value != NULL;
    if (value) get(b, value, count * sizeof *value);
    return value;
}

static void put_record(bytes *b, const sn_record *r) {
    int size[2] = {r ? r->series_count : -1, r ? r->rows : 0};
    put(b, size, sizeof size);
    for (int k = 0; k < size[0]; k++) {
        put(b, r->series[k].name, SN_NAME_MAX);
        put(b, r->series[k].unit, SN_NAME_MAX);
        put(b, r->series[k].value, (size_t)r->rows * sizeof(double));
    }
}

static sn_record *get_record(bytes *b) {
    int size[2] = {-1, 0};
    sn_record *r = NULL;
    double row[256] = {0};
    get(b, size, sizeof size);
    if (!b->good || size[0] < 0) return NULL;
    b->good = size[0] <= 256 && size[1] >= 0 && sn_record_create("kept", &r) == SN_OK;
    for (int k = 0; k < size[0] && b->good; k++) {
        char name[SN_NAME_MAX], unit[SN_NAME_MAX];
        get(b, name, sizeof name);
        get(b, unit, sizeof unit);
        name[SN_NAME_MAX - 1] = unit[SN_NAME_MAX - 1] = 0;
        b->good = b->good && sn_record_add_series(r, name, unit) == SN_OK;
        if (k == 0) // rows of zeros, for the values to go to
            for (int i = 0; i < size[1] && b->good; i++)
                b->good = b->size - b->at >= sizeof(double) && sn_record_append(r, row) == SN_OK;
        if (b->good) get(b, r->series[k].value, (size_t)size[1] * sizeof(double));
    }
    return r;
}

static void put_model(bytes *b, const sn_comparison_model *m) {
    put(b, m, sizeof *m);
    put_record(b, m->history);
    put_record(b, m->energy);
    put_record(b, m->response);
    put_record(b, m->elastic);
    put(b, m->displacement, 3 * (size_t)m->points * sizeof(double));
    put(b, m->distance, (size_t)m->points * sizeof(double));
}

static void get_model(bytes *b, sn_comparison_model *m) {
    get(b, m, sizeof *m);
    m->history = m->energy = m->response = m->elastic = NULL; // another process had them there
    m->displacement = m->distance = NULL;
    if (!b->good) return;
    m->history = get_record(b);
    m->energy = get_record(b);
    m->response = get_record(b);
    m->elastic = get_record(b);
    b->good = b->good && m->points >= 0;
    if (!b->good || m->points == 0) return;
    m->displacement = get_numbers(b, 3 * (size_t)m->points);
    m->distance = get_numbers(b, (size_t)m->points);
}

//---- files ---------------------------------------------------------------------------------------

static void kept_path(char path[4096], const char *folder, const char *key) {
    snprintf(path, 4096, "%s/kept/%s", folder, key);
}

static void put_head(bytes *b) {
    size_t size[] = {sizeof(sn_comparison_model), sizeof(sn_reference)};
    put(b, head, sizeof head);
    put(b, size, sizeof size);
}

static bool open_kept(const char *folder, const char *key, bytes *b) {
    char path[4096], found[sizeof head];
    size_t size[2] = {0};
    *b = (bytes){.good = true};
    kept_path(path, folder, key);
    if (sn_text_read(path, (size_t)1 << 31, &b->data, &b->size) != SN_OK) return false;
    get(b, found, sizeof found);
    get(b, size, sizeof size);
    return b->good && memcmp(found, head, sizeof head) == 0 &&
           size[0] == sizeof(sn_comparison_model) && size[1] == sizeof(sn_reference);
}

static sn_status save(const char *folder, const char *key, bytes *b) {
    char path[4096];
    kept_path(path, folder, key);
    sn_status status = b->good ? sn_text_write(path, b->data, b->size)
                               : sn_fail(SN_E_MEMORY, "out of memory: %s", path);
    sn_free(b->data);
    return status;
}

sn_status compare_keep_model(const char *folder, const char *key,
                             const sn_comparison_model *model) {
    bytes b = {.good = true};
    put_head(&b);
    put_model(&b, model);
    return save(folder, key, &b);
}

sn_status compare_keep_reference(const char *folder, const char *key, const sn_reference *r) {
    bytes b = {.good = true};
    size_t frames = (size_t)r->frames;
    put_head(&b);
    put_model(&b, &r->model);
    put(&b, r->text, sizeof r->text);
    put(&b, &r->frames, sizeof r->frames);
    put(&b, r->time, frames * sizeof(double));
    put(&b, r->displacement, 3 * frames * (size_t)r->mesh->node_count * sizeof(double));
    put(&b, r->stress, 6 * frames * (size_t)r->mesh->cell_count * sizeof(double));
    return save(folder, key, &b);
}

bool compare_kept_model(const char *folder, const char *key, sn_comparison_model *model) {
    bytes b;
    *model = (sn_comparison_model){0};
    bool good = open_kept(folder, key, &b);
    if (good) get_model(&b, model);
    good = good && b.good && b.at == b.size;
    sn_free(b.data);
    if (!good) sn_comparison_model_release(model);
    return good;
}

// r->mesh is there already: it is that of the case
bool compare_kept_reference(const char *folder, const char *key, sn_reference *r) {
    bytes b;
    bool good = open_kept(folder, key, &b);
    if (good) {
        get_model(&b, &r->model);
        get(&b, r->text, sizeof r->text);
        get(&b, &r->frames, sizeof r->frames);
    }
    good = good && b.good && r->frames >= 0;
    if (good && r->frames > 0) {
        size_t frames = (size_t)r->frames;
        r->time = get_numbers(&b, frames);
        r->displacement = get_numbers(&b, 3 * frames * (size_t)r->mesh->node_count);
        r->stress = get_numbers(&b, 6 * frames * (size_t)r->mesh->cell_count);
    }
    good = good && b.good && b.at == b.size;
    sn_free(b.data);
    if (!good) sn_reference_release(r);
    return good;
}
