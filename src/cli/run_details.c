// sinew run: the error estimates of --refine, the state file of --resume.
// SPDX-License-Identifier: Apache-2.0
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/run.h"

//---- --refine ------------------------------------------------------------------------------------

static json_t *mesh_json(const sn_run_summary *s) {
    json_t *json = json_object();
    cli_put_text(json, "model", s->model);
    cli_put_integer(json, "nodes", s->nodes);
    cli_put_integer(json, "cells", s->cells);
    cli_put_integer(json, "unknowns", s->unknowns);
    cli_put_number(json, "wall_s", s->wall_s);
    return json;
}

json_t *run_refinement_json(const sn_refinement *r) {
    json_t *json = json_object(), *meshes = json_array(), *quantities = json_object();
    for (int m = 0; m < r->meshes; m++) json_array_append_new(meshes, mesh_json(&r->run[m]));
    for (int k = 0; k < r->count; k++) {
        const sn_refined *q = &r->quantity[k];
        json_t *one = json_object();
        cli_put(one, "values", cli_numbers(r->meshes, q->value));
        cli_put_number(one, "order", q->order);
        cli_put_flag(one, "observed", q->observed);
        cli_put_number(one, "extrapolated", q->extrapolated);
        cli_put(one, "errors", cli_numbers(r->meshes, q->error));
        cli_put(quantities, q->name, one);
    }
    cli_put(json, "meshes", meshes);
    cli_put(json, "quantities", quantities);
    cli_put_text(json, "reason", r->reason);
    return json;
}

static const char *order_text(const sn_refined *q, char *text, size_t size) {
    snprintf(text, size, "%.2f%s", q->order, q->observed ? "" : " (assumed)");
    return text;
}

void run_refinement_print(const sn_refinement *r) {
    char order[32];
    if (r->count)
        printf("  %-24s %14s %14s %14s  order\n", "refined", "this mesh", "error", "extrapolated");
    for (int k = 0; k < r->count; k++) {
        const sn_refined *q = &r->quantity[k];
        printf("  %-24s %14s %14s %14s  %s\n", q->name, cli_show(q->value[0], q->unit),
               cli_show(q->error[0], q->unit), cli_show(q->extrapolated, q->unit),
               order_text(q, order, sizeof order));
    }
    if (*r->reason) printf("  refinement ended early: %s\n", r->reason);
}

void run_refinement_report(const sn_refinement *r, sn_report *report) {
    enum { COLUMNS = 5, WIDTH = 48 };
    size_t rows = (size_t)r->count + 1;
    char(*text)[WIDTH] = sn_alloc(rows * COLUMNS, WIDTH);
    const char **cells = sn_alloc(rows * COLUMNS, sizeof *cells);
    static const char *const head[COLUMNS] = {"quantity", "this mesh", "its error", "extrapolated",
                                              "order"};
    for (size_t k = 0; text && cells && k < rows * COLUMNS; k++) cells[k] = text[k];
    for (size_t k = 0; text && cells && k < rows; k++) {
        const sn_refined *q = k > 0 ? &r->quantity[k - 1] : NULL;
        char order[32];
        const char *show[COLUMNS];
        for (int i = 0; i < COLUMNS; i++) show[i] = head[i];
        if (q) {
            show[0] = q->name;
            show[1] = cli_show(q->value[0], q->unit);
            show[2] = cli_show(q->error[0], q->unit);
            show[3] = cli_show(q->extrapolated, q->unit);
            show[4] = order_text(q, order, sizeof order);
        }
        for (int i = 0; i < COLUMNS; i++)
            snprintf(text[k * COLUMNS + (size_t)i], WIDTH, "%s", show[i]);
    }
    if (text && cells && r->count)
        sn_report_table(report, (int)rows, COLUMNS, cells, "Error by refinement, at the end");
    if (*r->reason) sn_report_text(report, "The refinement ended early: %s", r->reason);
    sn_free(text);
    sn_free(cells);
}

//---- the mesh ------------------------------------------------------------------------------------

void run_mesh_note(const sn_mesh *mesh, sn_run_summary *s) {
    size_t used = strlen(s->note);
    if (mesh->split_cells == 0) return;
    snprintf(s->note + used, sizeof s->note - used,
             "%s%d hexahedra, prisms or pyramids of the mesh were cut into tetrahedra",
             used ? "; " : "", mesh->split_cells);
}

//---- --resume ------------------------------------------------------------------------------------

sn_status run_state_read(const char *folder, void **bytes, size_t *count) {
    char path[4096];
    sn_status status = SN_OK;
    *bytes = NULL;
    *count = 0;
    FILE *file = fopen(cli_path(path, sizeof path, folder, RUN_STATE), "rb");
    if (!file)
        return sn_fail(SN_E_FILE, "%s: %s: no unfinished run is there to resume", path,
                       strerror(errno));
    size_t room = 0, got = 1;
    while (got > 0 && status == SN_OK) {
        if (*count == room) {
            room = 2 * room + 65536;
            void *more = sn_resize(*bytes, room, 1);
            if (more)
                *bytes = more;
            else
                status = SN_E_MEMORY;
        }
        if (status != SN_OK) break;
        got = fread((char *)*bytes + *count, 1, room - *count, file);
        *count += got;
    }
    if (status == SN_OK && ferror(file)) status = sn_fail(SN_E_FILE, "%s: cannot be read", path);
    fclose(file);
    if (status != SN_OK) {
        sn_free(*bytes);
        *bytes = NULL;
    }
    return status;
}

sn_status run_state_write(void *folder, const void *state, size_t bytes) {
    char path[4096];
    return sn_text_write(cli_path(path, sizeof path, folder, RUN_STATE), state, bytes);
}

void run_state_remove(const char *folder) {
    char path[4096];
    remove(cli_path(path, sizeof path, folder, RUN_STATE));
}
