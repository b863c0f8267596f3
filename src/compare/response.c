// What is done to a body and what it answers: force against motion, over time.
// SPDX-License-Identifier: Apache-2.0
//
// Moved surface: its motion is prescribed, the reaction along it answers. Traction and pressure:
// their whole force is prescribed, and the mean motion of the surface along them (weighted by area)
// answers, which is the motion that the force does work on. Force at a point and tools likewise.
//
// The error of memory. A force F(t) under a prescribed motion comes of two things: the elastic
// force E(t) that the same motion would take without memory, and what memory makes of it. Where all
// of a tissue remembers alike, with G(t), and where the strain of every point follows the motion,
// it is F = int G(t - s) dE(s), whatever the curve E is. So a model whose elastic curve were the
// reference's would have the force
//     c F + int G(t - s) d(E_ref - c E)(s),
// and what of that is apart from F_ref is memory's. c brings E nearest to E_ref: then a model that
// is k times the reference, with and without memory, has no error even where the law above is only
// near the truth, as it is at finite strain.
#include "compare/response.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double length3(const double v[3]) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double along(const double direction[3], const double v[3]) {
    return direction[0] * v[0] + direction[1] * v[1] + direction[2] * v[2];
}

//---- drives --------------------------------------------------------------------------------------

static void probe_name(int load, char name[SN_NAME_MAX]) {
    snprintf(name, SN_NAME_MAX, "load %d", load + 1); // a user's name holds no blank
}

sn_status sn_response_probes(sn_case *c) {
    for (int k = 0; k < c->probe_count; k++)
        if (strchr(c->probe[k].name, ' ')) return SN_OK; // they are there
    for (int i = 0; i < c->load_count; i++) {
        if (c->load[i].kind != SN_LOAD_DISPLACEMENT) continue;
        sn_probe *grown = sn_resize(c->probe, (size_t)c->probe_count + 1, sizeof *grown);
        if (!grown) return SN_E_MEMORY;
        c->probe = grown;
        sn_probe probe = {.kind = SN_PROBE_REACTION, .surface = c->load[i].surface};
        probe_name(i, probe.name);
        c->probe[c->probe_count++] = probe;
    }
    return SN_OK;
}

// where the path of a tool leads at its farthest, over that distance; false where it stays
static bool way_of(const sn_tool *tool, double direction[3]) {
    double largest = 0;
    for (int k = 0; tool->path && k < tool->path->count; k++) {
        double way[3];
        for (int d = 0; d < 3; d++) way[d] = tool->path->value[3 * k + d] - tool->path->value[d];
        if (length3(way) <= largest) continue;
        largest = length3(way);
        for (int d = 0; d < 3; d++) direction[d] = way[d] / largest;
    }
    return largest > 0;
}

static bool load_direction(const sn_load *load, double direction[3]) {
    for (int d = 0; d < 3; d++)
        direction[d] = load->kind == SN_LOAD_DISPLACEMENT && load->free[d] ? 0 : load->vector[d];
    double length = length3(direction);
    for (int d = 0; d < 3 && length > 0; d++) direction[d] /= length;
    return length > 0;
}

static void find_drives(sn_response *r, const sn_record *columns) {
    const sn_case *c = r->c;
    for (int i = 0; i < c->load_count && r->count < SN_DRIVES_MAX; i++) {
        sn_drive drive = {.load = i, .tool = -1, .column = -1};
        char name[SN_NAME_MAX], column[SN_NAME_MAX + 4];
        if (c->load[i].kind == SN_LOAD_PRESSURE ? c->load[i].pressure == 0
                                                : !load_direction(&c->load[i], drive.direction))
            continue;
        probe_name(i, name);
        snprintf(column, sizeof column, "%s_fx", name);
        if (c->load[i].kind == SN_LOAD_DISPLACEMENT) drive.column = sn_record_find(columns, column);
        r->drive[r->count++] = drive;
    }
    for (int i = 0; i < c->tool_count && r->count < SN_DRIVES_MAX; i++) {
        sn_drive drive = {.load = -1, .tool = i};
        char column[SN_NAME_MAX + 4];
        if (!way_of(&c->tool[i], drive.direction)) continue;
        snprintf(column, sizeof column, "%s_fx", c->tool[i].name);
        drive.column = sn_record_find(columns, column);
        r->drive[r->count++] = drive;
    }
}

// "right", or "load 3" for a second load on a surface and for forces at points
static void name_drive(const sn_response *r, int k, char name[SN_NAME_MAX]) {
    const sn_drive *drive = &r->drive[k];
    if (drive->tool >= 0) {
        snprintf(name, SN_NAME_MAX, "%.40s", r->c->tool[drive->tool].name);
        return;
    }
    const sn_load *load = &r->c->load[drive->load];
    bool plain = load->kind != SN_LOAD_FORCE;
    for (int i = 0; i < drive->load && plain; i++)
        plain = r->c->load[i].kind == SN_LOAD_FORCE || r->c->load[i].surface != load->surface;
    if (plain)
        snprintf(name, SN_NAME_MAX, "%.40s", r->c->mesh->surface[load->surface].name);
    else
        probe_name(drive->load, name);
}

sn_status sn_response_create(const sn_case *c, const sn_mesh *mesh, sn_response *r) {
    sn_record *columns = NULL;
    sn_status status;
    *r = (sn_response){.c = c, .mesh = mesh};
    SN_TRY_GOTO(status, sn_record_create("response", &r->record));
    SN_TRY_GOTO(status, sn_record_create("columns", &columns));
    SN_TRY_GOTO(status, sn_case_history_columns(c, columns));
    find_drives(r, columns);
    SN_TRY_GOTO(status, sn_record_add_series(r->record, "time", "s"));
    for (int k = 0; k < r->count; k++) {
        char name[SN_NAME_MAX], column[2][SN_NAME_MAX + 16];
        bool force_answers = r->drive[k].column >= 0;
        name_drive(r, k, name);
        snprintf(column[0], sizeof column[0], "%s_displacement", name);
        snprintf(column[1], sizeof column[1], "%s_force", name);
        for (int side = 0; side < 2; side++) {
            bool force = force_answers == (side == 1);
            SN_TRY_GOTO(status, sn_record_add_series(r->record, column[force], force ? "N" : "m"));
        }
    }
fail:
    sn_record_destroy(columns);
    return status;
}

bool sn_response_has_force(const sn_response *r) {
    bool any = false;
    for (int k = 0; k < r->count; k++) any = any || r->drive[k].column >= 0;
    return any;
}

void sn_response_release(sn_response *r) {
    sn_record_destroy(r->record);
    *r = (sn_response){0};
}

//---- rows ----------------------------------------------------------------------------------------

// mean motion of a surface along a direction, or (direction zero) against its outward normal
static double mean_motion(const sn_mesh *mesh, const sn_surface *s, const double direction[3],
                          const double *u) {
    double moved = 0, area = 0;
    bool normal = length3(direction) == 0;
    for (int f = 0; f < s->face_count; f++) {
        const int *v = s->face + 3 * (size_t)f;
        double a[3], b[3], n[3], mean[3] = {0};
        for (size_t d = 0; d < 3; d++) {
            double origin = mesh->node[3 * (size_t)v[0] + d];
            a[d] = mesh->node[3 * (size_t)v[1] + d] - origin;
            b[d] = mesh->node[3 * (size_t)v[2] + d] - origin;
            for (int k = 0; k < 3; k++) mean[d] += u[3 * (size_t)v[k] + d] / 3;
        }
        for (int d = 0; d < 3; d++) {
            int i = (d + 1) % 3, j = (d + 2) % 3;
            n[d] = 0.5 * (a[i] * b[j] - a[j] * b[i]);
        }
        double face = length3(n);
        area += face;
        moved += normal ? -along(n, mean) : face * along(direction, mean);
    }
    return moved / area;
}

static double prescribed_force(const sn_case *c, const sn_load *load, double factor) {
    if (load->kind == SN_LOAD_FORCE) return factor * length3(load->vector);
    double area = sn_mesh_area(c->mesh, load->surface);
    if (load->kind == SN_LOAD_PRESSURE) return factor * load->pressure * area;
    return factor * length3(load->vector) * area;
}

static double motion_of_point(const sn_mesh *mesh, const sn_load *load, const double direction[3],
                              const double *u) {
    int cell;
    double w[4], sum = 0;
    if (sn_mesh_locate(mesh, load->point, &cell, w) != SN_OK)
        return (double)NAN; // the check refuses it
    for (int k = 0; k < 4; k++)
        sum += w[k] * along(direction, u + 3 * (size_t)mesh->cell[4 * (size_t)cell + (size_t)k]);
    return sum;
}

sn_status sn_response_frame(sn_response *r, double time, const double *u) {
    double row[1 + 2 * SN_DRIVES_MAX] = {time};
    for (int k = 0; k < r->count; k++) {
        const sn_drive *drive = &r->drive[k];
        double *pair = row + 1 + 2 * k, factor;
        if (drive->tool >= 0) {
            const sn_tool *tool = &r->c->tool[drive->tool];
            double way[3];
            sn_history_at(tool->path, time, way);
            for (int d = 0; d < 3; d++) way[d] -= tool->path->value[d];
            pair[0] = along(drive->direction, way);
            continue;
        }
        const sn_load *load = &r->c->load[drive->load];
        sn_history_at(load->factor, time, &factor);
        if (load->kind == SN_LOAD_DISPLACEMENT) {
            pair[0] = factor * along(drive->direction, load->vector);
            continue;
        }
        pair[0] = prescribed_force(r->c, load, factor);
        pair[1] = load->kind == SN_LOAD_FORCE
                      ? motion_of_point(r->mesh, load, drive->direction, u)
                      : mean_motion(r->mesh, &r->mesh->surface[load->surface], drive->direction, u);
    }
    return sn_record_append(r->record, row);
}

void sn_response_finish(sn_response *r, const sn_record *history) {
    int rows = r->record->rows < history->rows ? r->record->rows : history->rows;
    for (int k = 0; k < r->count; k++) {
        const sn_drive *drive = &r->drive[k];
        if (drive->column < 0) continue;
        // the force on the tool is minus that on the tissue
        double sign = drive->tool >= 0 ? -1 : 1;
        for (int i = 0; i < rows; i++) {
            double f[3];
            for (int d = 0; d < 3; d++) f[d] = history->series[drive->column + d].value[i];
            r->record->series[2 + 2 * k].value[i] = sign * along(drive->direction, f);
        }
    }
}

//---- errors --------------------------------------------------------------------------------------

static double largest(const double *value, int rows) {
    double most = 0;
    for (int i = 0; i < rows; i++) most = fmax(most, fabs(value[i]));
    return most;
}

double sn_response_error(const sn_record *a, const sn_record *b) {
    int rows = a->rows < b->rows ? a->rows : b->rows;
    double worst = (double)NAN;
    for (int k = 2; k < b->series_count; k += 2) {
        const double *x = a->series[k].value, *y = b->series[k].value;
        double scale = largest(y, rows), sum = 0;
        if (!(scale > 0)) continue;
        for (int i = 0; i < rows; i++) sum += (x[i] - y[i]) * (x[i] - y[i]);
        double error = sqrt(sum / rows) / scale;
        if (isnan(worst) || error > worst) worst = error;
    }
    return worst;
}

// what a series comes to after memory, the motion between rows being linear; in place
static void remember(const sn_exponentials *memory, const double *time, int rows, double *value) {
    double part[SN_TERMS_MAX], before = value[0];
    for (int k = 0; k < memory->terms; k++) part[k] = memory->g[k] * before;
    for (int i = 1; i < rows; i++) {
        double decay[SN_TERMS_MAX], gain[SN_TERMS_MAX];
        const double h = time[i] - time[i - 1], change = value[i] - before;
        before = value[i];
        sn_exponentials_factors(memory, h, decay, gain);
        value[i] = memory->g_inf * before + memory->viscous * change / h;
        for (int k = 0; k < memory->terms; k++) {
            part[k] = decay[k] * part[k] + gain[k] * change;
            value[i] += part[k];
        }
    }
}

sn_status sn_relaxation_error(const sn_memory *memory, const sn_force_pair *a,
                              const sn_force_pair *b, double *error) {
    *error = (double)NAN;
    if (!a->elastic || !b->elastic) return SN_OK;
    const sn_record *all[] = {a->force, b->force, a->elastic, b->elastic};
    int rows = all[0]->rows;
    for (int k = 1; k < 4; k++) rows = all[k]->rows < rows ? all[k]->rows : rows;
    sn_exponentials sum;
    if (memory) SN_TRY(sn_memory_expand(memory, &sum));
    double *left = sn_alloc((size_t)rows, sizeof *left);
    if (!left) return SN_E_MEMORY;
    for (int k = 2; k < b->force->series_count; k += 2) {
        if (strcmp(b->force->series[k].unit, "N") != 0) continue; // a motion answers
        const double *x = a->force->series[k].value, *y = b->force->series[k].value;
        const double *p = a->elastic->series[k].value, *q = b->elastic->series[k].value;
        double scale = largest(y, rows), pq = 0, pp = 0, most = 0;
        for (int i = 0; i < rows; i++) {
            pq += p[i] * q[i];
            pp += p[i] * p[i];
        }
        if (!(scale > 0) || !(pp > 0)) continue;
        const double factor = pq / pp;
        for (int i = 0; i < rows; i++) left[i] = memory ? q[i] - factor * p[i] : 0.0;
        if (memory) remember(&sum, b->force->series[0].value, rows, left);
        for (int i = 0; i < rows; i++) most = fmax(most, fabs(factor * x[i] + left[i] - y[i]));
        *error = fmax(*error, most / scale); // leaves NAN out
    }
    sn_free(left);
    return SN_OK;
}
