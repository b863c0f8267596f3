// Error norms on what two runs of one case handed out.
// SPDX-License-Identifier: Apache-2.0
#include "compare/norms.h"

#include <math.h>
#include <string.h>

const double *sn_frame_field(const sn_frame *frame, const char *name) {
    for (int k = 0; k < frame->field_count; k++)
        if (strcmp(frame->fields[k].name, name) == 0) return frame->fields[k].value;
    SN_ASSERT(false);
    return NULL;
}

static sn_status grow(sn_capture *c) {
    int capacity = c->capacity ? 2 * c->capacity : 16;
    double *time = sn_resize(c->time, (size_t)capacity, sizeof *time);
    if (!time) return SN_E_MEMORY;
    c->time = time;
    double *u = sn_resize(c->displacement, (size_t)capacity * (size_t)c->nodes, 3 * sizeof *u);
    if (!u) return SN_E_MEMORY;
    c->displacement = u;
    double *s = sn_resize(c->stress, (size_t)capacity * (size_t)c->cells, 6 * sizeof *s);
    if (!s) return SN_E_MEMORY;
    c->stress = s;
    c->capacity = capacity;
    return SN_OK;
}

sn_status sn_capture_frame(void *context, const sn_frame *frame) {
    sn_capture *c = context;
    if (c->frames == c->capacity) SN_TRY(grow(c));
    size_t u = (size_t)c->nodes * 3, s = (size_t)c->cells * 6, i = (size_t)c->frames;
    c->time[i] = frame->time;
    const double *displacement = sn_frame_field(frame, "displacement");
    const double *stress = sn_frame_field(frame, "cauchy_stress");
    if (c->sampler) {
        sn_sample_nodes(c->sampler, displacement, c->displacement + i * u);
        sn_sample_cells(c->sampler, stress, c->stress + i * s);
    } else {
        memcpy(c->displacement + i * u, displacement, u * sizeof(double));
        memcpy(c->stress + i * s, stress, s * sizeof(double));
    }
    c->frames++;
    return SN_OK;
}

void sn_capture_release(sn_capture *capture) {
    sn_free(capture->time);
    sn_free(capture->displacement);
    sn_free(capture->stress);
    *capture = (sn_capture){0};
}

sn_status sn_node_weights(const sn_mesh *mesh, double **weight) {
    double total = sn_mesh_volume(mesh), *w = sn_alloc((size_t)mesh->node_count, sizeof *w);
    if (!w) return SN_E_MEMORY;
    for (int c = 0; c < mesh->cell_count; c++)
        for (int k = 0; k < 4; k++)
            w[mesh->cell[4 * c + k]] += sn_mesh_cell_volume(mesh, c) / 4 / total;
    *weight = w;
    return SN_OK;
}

sn_status sn_cell_weights(const sn_mesh *mesh, double **weight) {
    double total = sn_mesh_volume(mesh), *w = sn_alloc((size_t)mesh->cell_count, sizeof *w);
    if (!w) return SN_E_MEMORY;
    for (int c = 0; c < mesh->cell_count; c++) w[c] = sn_mesh_cell_volume(mesh, c) / total;
    *weight = w;
    return SN_OK;
}

static double norm3(const double *v) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// off-diagonal components stand for two
static double norm6(const double *s) {
    return sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2] +
                2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

double sn_displacement_scale(const sn_capture *capture) {
    double scale = 0;
    for (size_t i = 0; i < (size_t)capture->frames * (size_t)capture->nodes; i++)
        scale = fmax(scale, norm3(capture->displacement + 3 * i));
    return scale;
}

double sn_stress_scale(const sn_capture *capture) {
    double scale = 0;
    for (size_t i = 0; i < (size_t)capture->frames * (size_t)capture->cells; i++)
        scale = fmax(scale, norm6(capture->stress + 6 * i));
    return scale;
}

static int common_frames(const sn_capture *a, const sn_capture *b) {
    int frames = a->frames < b->frames ? a->frames : b->frames;
    for (int f = 0; f < frames; f++)
        SN_ASSERT(fabs(a->time[f] - b->time[f]) <= 1e-9 * fabs(b->time[frames - 1]));
    return frames;
}

void sn_displacement_error(const sn_capture *a, const sn_capture *b, const double *weight,
                           double *rms, double *max) {
    int frames = common_frames(a, b);
    double sum = 0;
    *max = 0;
    for (int f = 0; f < frames; f++) {
        for (int i = 0; i < a->nodes; i++) {
            size_t at = ((size_t)f * (size_t)a->nodes + (size_t)i) * 3;
            double d[3];
            for (int k = 0; k < 3; k++)
                d[k] = a->displacement[at + (size_t)k] - b->displacement[at + (size_t)k];
            double error = norm3(d);
            sum += weight[i] * error * error;
            *max = fmax(*max, error);
        }
    }
    *rms = sqrt(sum / frames);
}

double sn_stress_error(const sn_capture *a, const sn_capture *b, const double *weight) {
    int frames = common_frames(a, b);
    double sum = 0;
    for (int f = 0; f < frames; f++) {
        for (int i = 0; i < a->cells; i++) {
            size_t at = ((size_t)f * (size_t)a->cells + (size_t)i) * 6;
            double d[6];
            for (int k = 0; k < 6; k++)
                d[k] = a->stress[at + (size_t)k] - b->stress[at + (size_t)k];
            double error = norm6(d);
            sum += weight[i] * error * error;
        }
    }
    return sqrt(sum / frames);
}

static bool is_force(const sn_record *r, int column) {
    size_t length = strlen(r->series[column].name);
    return column + 2 < r->series_count && length >= 3 &&
           strcmp(r->series[column].name + length - 3, "_fx") == 0;
}

static void force_at(const sn_record *r, int column, int row, double f[3]) {
    for (int j = 0; j < 3; j++) f[j] = r->series[column + j].value[row];
}

static double largest_force(const sn_record *r, int column, int rows) {
    double largest = 0, f[3];
    for (int i = 0; i < rows; i++) {
        force_at(r, column, i, f);
        largest = fmax(largest, norm3(f));
    }
    return largest;
}

double sn_reaction_error(const sn_record *a, const sn_record *b) {
    int rows = a->rows < b->rows ? a->rows : b->rows;
    double worst = (double)NAN, most = 0;
    for (int k = 0; k < b->series_count; k++)
        if (is_force(b, k)) most = fmax(most, largest_force(b, k, rows));
    for (int k = 0; k < b->series_count; k++) {
        if (!is_force(b, k)) continue;
        double sum = 0, scale = largest_force(b, k, rows);
        if (!(scale > 1e-6 * most)) continue;
        for (int i = 0; i < rows; i++) {
            double d[3], f[3];
            force_at(b, k, i, f);
            force_at(a, k, i, d);
            for (int j = 0; j < 3; j++) d[j] -= f[j];
            sum += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        }
        double error = sqrt(sum / rows) / scale;
        if (isnan(worst) || error > worst) worst = error;
    }
    return worst;
}
