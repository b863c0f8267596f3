// What a test or a run measured: series of equal length, and remarks.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/base.h"

#include <stdio.h>
#include <string.h>

sn_status sn_record_create(const char *name, sn_record **record) {
    *record = sn_alloc(1, sizeof **record);
    if (!*record) return SN_E_MEMORY;
    snprintf((*record)->name, sizeof(*record)->name, "%s", name);
    return SN_OK;
}

void sn_record_destroy(sn_record *record) {
    if (!record) return;
    for (int k = 0; k < record->series_count; k++) sn_free(record->series[k].value);
    sn_free(record->series);
    sn_free(record->note);
    sn_free(record);
}

sn_status sn_record_add_series(sn_record *record, const char *name, const char *unit) {
    sn_series *series = sn_resize(record->series, (size_t)record->series_count + 1, sizeof *series);
    if (!series) return SN_E_MEMORY;
    record->series = series;
    sn_series *added = &series[record->series_count];
    added->value = sn_alloc((size_t)record->capacity, sizeof *added->value);
    if (!added->value) return SN_E_MEMORY;
    snprintf(added->name, sizeof added->name, "%s", name);
    snprintf(added->unit, sizeof added->unit, "%s", unit);
    record->series_count++;
    return SN_OK;
}

static sn_status grow(sn_record *record) {
    int capacity = record->capacity ? 2 * record->capacity : 64;
    for (int k = 0; k < record->series_count; k++) {
        double *value =
            sn_resize(record->series[k].value, (size_t)capacity, sizeof *record->series[k].value);
        if (!value) return SN_E_MEMORY;
        record->series[k].value = value;
    }
    record->capacity = capacity;
    return SN_OK;
}

sn_status sn_record_append(sn_record *record, const double *row) {
    if (record->rows == record->capacity) SN_TRY(grow(record));
    for (int k = 0; k < record->series_count; k++) record->series[k].value[record->rows] = row[k];
    record->rows++;
    return SN_OK;
}

int sn_record_find(const sn_record *record, const char *name) {
    for (int k = 0; k < record->series_count; k++)
        if (strcmp(record->series[k].name, name) == 0) return k;
    return -1;
}

double *sn_record_values(const sn_record *record, const char *name) {
    int k = sn_record_find(record, name);
    return k < 0 ? NULL : record->series[k].value;
}

sn_status sn_record_add_note(sn_record *record, const char *key, const char *text, double value) {
    sn_note *note = sn_resize(record->note, (size_t)record->note_count + 1, sizeof *note);
    if (!note) return SN_E_MEMORY;
    record->note = note;
    sn_note *added = &note[record->note_count++];
    snprintf(added->key, sizeof added->key, "%s", key);
    snprintf(added->text, sizeof added->text, "%s", text);
    added->value = value;
    return SN_OK;
}

const sn_note *sn_record_note(const sn_record *record, const char *key) {
    for (int k = 0; k < record->note_count; k++)
        if (strcmp(record->note[k].key, key) == 0) return &record->note[k];
    return NULL;
}
