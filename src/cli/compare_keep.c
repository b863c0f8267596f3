// sinew compare: results that are kept, so that an interrupted comparison goes on.
// SPDX-License-Identifier: Apache-2.0
//
// A kept file is made of bytes of this machine and this version: a head with the sizes of the
// structures, the structure itself, then the arrays that it owns. The name is a fingerprint of
// everything that the numbers depend on, so that a case that was changed is run anew.
#include <stdio.h>
#include <string.h>

#include "cli/compare.h"

//---- fingerprint ---------------------------------------------------------------------------------

static uint64_t mix_text(uint64_t hash, const char *text) {
    return sn_hash(hash, text, strlen(text) + 1);
}

// What the fingerprint of a case leaves to its user: times, settings of the engines, cuts. Rung,
// volume and element are the model's; the number of threads changes no result.
static uint64_t mix_settings(uint64_t hash, const sn_case *c) {
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
                              s->tolerance,
                              s->memory_tolerance,
                              (double)e->analysis,
                              e->steps,
                              e->step,
                              e->step_tolerance,
                              e->rho_infinity,
                              e->tolerance,
                              e->memory_tolerance,
                              (double)e->solver};
    return sn_hash(hash, numbers, sizeof numbers);
}

static uint64_t mix_cuts(uint64_t hash, const sn_case *c) {
    for (int k = 0; k < c->cut_count; k++) {
        const sn_cut_def *cut = &c->cut[k];
        const double numbers[] = {cut->at,        (double)cut->kind, cut->centre[0], cut->centre[1],
                                  cut->centre[2], cut->radius,       cut->low[0],    cut->low[1],
                                  cut->low[2],    cut->high[0],      cut->high[1],   cut->high[2]};
        hash = sn_hash(hash, numbers, sizeof numbers);
        hash = sn_hash(hash, cut->cell, (size_t)cut->cell_count * sizeof *cut->cell);
    }
    return hash;
}

// Columns of what is kept are called by these.
static uint64_t mix_names(uint64_t hash, const sn_case *c) {
    const sn_mesh *m = c->mesh;
    for (int k = 0; k < m->surface_count; k++) hash = mix_text(hash, m->surface[k].name);
    for (int k = 0; k < c->tool_count; k++) hash = mix_text(hash, c->tool[k].name);
    for (int k = 0; k < c->probe_count; k++) hash = mix_text(hash, c->probe[k].name);
    return hash;
}

void compare_key(const sn_case *c, const char *model, int mesh, const char *reference,
                 char key[17]) {
    // what the mesh beside that of the reference, which measures its error, is made of
    const int numbers[] = {mesh, c->has_shape ? (int)c->shape.pattern : -1};
    uint64_t hash = mix_cuts(mix_settings(sn_case_fingerprint(c), c), c);
    hash = sn_hash(mix_names(hash, c), numbers, sizeof numbers);
    hash = mix_text(mix_text(mix_text(hash, sn_version()), model), reference);
    snprintf(key, 17, "%016llx", (unsigned long long)hash);
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
