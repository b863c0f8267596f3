// A record of any kind brought to time, stretch and nominal stress.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (15) and (17): Green strain (L^2 - 1)/2, T = L S; incompressible: T = sigma/L.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lab/reduce/clean.h"
#include "sinew/lab.h"

// how a column becomes stretch or nominal stress: x the column, note the remark, stretch the row's
typedef struct source {
    const char *column;
    const char *note; // Nullable: the remark it needs
    double (*convert)(double x, double note, double stretch);
    const char *remark; // Nullable: what to say about it
} source;

static double as_it_is(double x, double note, double stretch) {
    (void)note, (void)stretch;
    return x;
}
static double from_strain(double x, double note, double stretch) {
    (void)note, (void)stretch;
    return 1.0 + x;
}
static double from_green(double x, double note, double stretch) {
    (void)note, (void)stretch;
    return sqrt(1.0 + 2.0 * x);
}
static double from_length(double x, double note, double stretch) {
    (void)stretch;
    return x / note;
}
static double from_extension(double x, double note, double stretch) {
    (void)stretch;
    return 1.0 + x / note;
}
static double from_true(double x, double note, double stretch) {
    (void)note;
    return x / stretch;
}
static double from_pk2(double x, double note, double stretch) {
    (void)note;
    return x * stretch;
}
static double from_force(double x, double note, double stretch) {
    (void)stretch;
    return x / note;
}

static const source stretch_sources[] = {
    {"stretch", NULL, as_it_is, NULL},
    {"strain", NULL, from_strain, "stretch = 1 + strain"},
    {"green_strain", NULL, from_green, "stretch from Green strain"},
    {"length", "gauge_length", from_length, "stretch = length over gauge length"},
    {"extension", "gauge_length", from_extension, "stretch = 1 + extension over gauge length"}};
static const source stress_sources[] = {
    {"stress", NULL, as_it_is, NULL},
    {"force", "area", from_force, "nominal stress = force over area"},
    {"true_stress", NULL, from_true, "nominal stress = true stress over stretch (incompressible)"},
    {"pk2_stress", NULL, from_pk2, "nominal stress = stretch times second Piola-Kirchhoff stress"}};
enum {
    STRETCHES = sizeof stretch_sources / sizeof *stretch_sources,
    STRESSES = sizeof stress_sources / sizeof *stress_sources
};

static void remark(sn_curve *curve, const char *text) {
    size_t used = strlen(curve->remarks);
    snprintf(curve->remarks + used, sizeof curve->remarks - used, "%s%s", used ? "; " : "", text);
}

// the first source that the record has, with its column and the value of its note
static sn_status choose(const sn_record *record, const source *sources, int count, const char *what,
                        const char *wanted, const source **chosen, const double **column,
                        double *note) {
    for (int i = 0; i < count; ++i) {
        *column = sn_record_values(record, sources[i].column);
        if (!*column) continue;
        *chosen = &sources[i];
        if (!sources[i].note) return SN_OK;
        const sn_note *found = sn_record_note(record, sources[i].note);
        *note = found ? found->value : (double)NAN;
        if (isfinite(*note) && *note > 0.0) return SN_OK;
        return sn_fail(SN_E_DATA,
                       "%s: column %s needs a remark \"# %s: ...\" above 0 with its unit, %s",
                       record->name, sources[i].column, sources[i].note,
                       found ? "found one without a usable value" : "found none");
    }
    return sn_fail(SN_E_DATA, "%s: no column for %s: expected %s", record->name, what, wanted);
}

static sn_status allocate(sn_curve *curve, int rows, bool timed) {
    size_t n = (size_t)rows;
    curve->stretch = sn_alloc(n, sizeof *curve->stretch);
    curve->stress = sn_alloc(n, sizeof *curve->stress);
    if (timed) curve->time = sn_alloc(n, sizeof *curve->time);
    return curve->stretch && curve->stress && (!timed || curve->time) ? SN_OK : SN_E_MEMORY;
}

// One row into the curve.
static sn_status take_row(const sn_record *record, int row, double time, double stretch,
                          double stress, sn_curve *curve) {
    int n = curve->count;
    if (!isfinite(stretch) || !(stretch > 0.0))
        return sn_fail(SN_E_DATA, "%s: row %d: stretch is %g, expected a number above 0",
                       record->name, row + 1, stretch);
    if (!isfinite(stress))
        return sn_fail(SN_E_DATA, "%s: row %d: stress is %g, expected a number", record->name,
                       row + 1, stress);
    if (curve->time) {
        if (!isfinite(time))
            return sn_fail(SN_E_DATA, "%s: row %d: time is %g, expected a number", record->name,
                           row + 1, time);
        curve->time[n] = time;
    }
    curve->stretch[n] = stretch;
    curve->stress[n] = stress;
    curve->count++;
    return SN_OK;
}

static sn_status fill(const sn_record *record, sn_curve *curve) {
    const source *length = NULL, *load = NULL;
    const double *x, *f, *time = sn_record_values(record, "time");
    double length_note = (double)NAN, load_note = (double)NAN;
    SN_TRY(choose(record, stretch_sources, STRETCHES, "the stretch",
                  "stretch, strain, green_strain, or length or extension with a gauge length",
                  &length, &x, &length_note));
    SN_TRY(choose(record, stress_sources, STRESSES, "the stress",
                  "stress (nominal), true_stress, pk2_stress, or force with an area", &load, &f,
                  &load_note));
    SN_TRY(allocate(curve, record->rows, time != NULL));
    for (int i = 0; i < record->rows; ++i) {
        double stretch = length->convert(x[i], length_note, (double)NAN);
        double stress = load->convert(f[i], load_note, stretch);
        SN_TRY(take_row(record, i, time ? time[i] : (double)NAN, stretch, stress, curve));
    }
    if (length->remark) remark(curve, length->remark);
    if (load->remark) remark(curve, load->remark);
    SN_TRY(sn_curve_clean(curve));
    if (curve->count < 3)
        return sn_fail(SN_E_DATA, "%s: %d usable rows: expected at least 3", record->name,
                       curve->count);
    return SN_OK;
}

sn_status sn_curve_from_record(const sn_record *record, sn_curve *curve) {
    SN_ASSERT(record && curve);
    *curve = (sn_curve){0};
    snprintf(curve->name, sizeof curve->name, "%s", record->name);
    sn_status status = fill(record, curve);
    if (status != SN_OK) sn_curve_release(curve);
    return status;
}

void sn_curve_release(sn_curve *curve) {
    if (!curve) return;
    sn_free(curve->time);
    sn_free(curve->stretch);
    sn_free(curve->stress);
    *curve = (sn_curve){0};
}
