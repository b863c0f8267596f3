// A record of any kind brought to time, stretch and nominal stress.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (15) and (17): Green strain (L^2 - 1)/2, T = L S; incompressible: T = sigma/L,
// along each axis of a biaxial test as well, where the face of an axis shrinks by its stretch.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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
    if (strstr(curve->remarks, text)) return; // of the other axis
    snprintf(curve->remarks + used, sizeof curve->remarks - used, "%s%s", used ? "; " : "", text);
}

// A note for an axis ("", "_1" or "_2"): its own, or one without suffix for a square specimen.
static double axis_note(const sn_record *record, const char *key, const char *suffix, bool *found) {
    char own[SN_NAME_MAX];
    snprintf(own, sizeof own, "%s%s", key, suffix);
    const sn_note *note = sn_record_note(record, own);
    if (!note) note = sn_record_note(record, key);
    *found = *found || note;
    return note ? note->value : (double)NAN;
}

// the value of the note of a source; an area may be a thickness times a width
static sn_status need_note(const sn_record *record, const source *from, const char *column,
                           const char *suffix, double *note) {
    bool found = false, area = strcmp(from->note, "area") == 0;
    *note = axis_note(record, from->note, suffix, &found);
    if (area && !found)
        *note =
            axis_note(record, "thickness", "", &found) * axis_note(record, "width", suffix, &found);
    if (isfinite(*note) && *note > 0.0) return SN_OK;
    return sn_fail(
        SN_E_DATA, "%s: column %s needs a remark \"# %s%s: ...\"%s above 0 with its unit, %s",
        record->name, column, from->note, suffix, area ? ", or a thickness and a width," : "",
        found ? "found one without a usable value" : "found none");
}

// a quantity of one axis: the columns it can come from, what was found
typedef struct wanted {
    const source *sources;
    int count;
    const char *what, *names;
    const source *chosen;
    const double *column;
    double note;
} wanted;

// the first source that the record has, with its column and the value of its note
static sn_status choose(const sn_record *record, const char *suffix, wanted *w) {
    char name[SN_NAME_MAX];
    for (int i = 0; i < w->count; ++i) {
        snprintf(name, sizeof name, "%s%s", w->sources[i].column, suffix);
        w->column = sn_record_values(record, name);
        if (!w->column) continue;
        w->chosen = &w->sources[i];
        return w->chosen->note ? need_note(record, w->chosen, name, suffix, &w->note) : SN_OK;
    }
    return sn_fail(SN_E_DATA, "%s: no column for %s%s: expected %s%s", record->name, w->what,
                   !*suffix               ? ""
                   : *(suffix + 1) == '1' ? " of the first axis"
                                          : " of the second axis",
                   w->names, *suffix ? ", each with its _1 or _2" : "");
}

// a column of either table with this suffix, or NULL
static const char *any_column(const sn_record *record, const char *suffix) {
    static _Thread_local char name[SN_NAME_MAX];
    for (int i = 0; i < STRETCHES + STRESSES; ++i) {
        const source *s = i < STRETCHES ? &stretch_sources[i] : &stress_sources[i - STRETCHES];
        snprintf(name, sizeof name, "%s%s", s->column, suffix);
        if (sn_record_find(record, name) >= 0) return name;
    }
    return NULL;
}

// the kind of test that the columns belong to
static sn_status find_kind(const sn_record *record, sn_curve_kind *kind) {
    char one[SN_NAME_MAX] = "", two[SN_NAME_MAX] = "";
    const char *axis = any_column(record, "_1");
    if (!axis) axis = any_column(record, "_2");
    if (axis) snprintf(two, sizeof two, "%s", axis);
    axis = any_column(record, "");
    if (axis) snprintf(one, sizeof one, "%s", axis);
    bool shear =
        sn_record_find(record, "shear_strain") >= 0 || sn_record_find(record, "shear_stress") >= 0;
    bool dynamic = sn_record_find(record, "storage_modulus") >= 0 ||
                   sn_record_find(record, "loss_modulus") >= 0;
    *kind = dynamic ? SN_CURVE_DYNAMIC
            : shear ? SN_CURVE_SHEAR
            : *two  ? SN_CURVE_BIAXIAL
                    : SN_CURVE_UNIAXIAL;
    const char *found[4];
    int kinds = 0;
    if (*one) found[kinds++] = one;
    if (*two) found[kinds++] = two;
    if (shear) found[kinds++] = "shear_strain";
    if (dynamic) found[kinds++] = "storage_modulus";
    if (kinds < 2) return SN_OK;
    return sn_fail(SN_E_DATA,
                   "%s: columns of two kinds of test, %s and %s: expected one of uniaxial "
                   "(stretch, stress, ...), biaxial (stretch_1, stretch_2, ...), shear "
                   "(shear_strain, shear_stress) or dynamic (frequency, storage_modulus, "
                   "loss_modulus): leave the others out",
                   record->name, found[0], found[1]);
}

static sn_status allocate(sn_curve *curve, int rows, bool timed) {
    size_t n = (size_t)rows;
    bool two = curve->kind == SN_CURVE_BIAXIAL;
    curve->stretch = sn_alloc(n, sizeof *curve->stretch);
    curve->stress = sn_alloc(n, sizeof *curve->stress);
    if (two) curve->stretch_2 = sn_alloc(n, sizeof *curve->stretch_2);
    if (two) curve->stress_2 = sn_alloc(n, sizeof *curve->stress_2);
    if (timed) curve->time = sn_alloc(n, sizeof *curve->time);
    return curve->stretch && curve->stress && (!timed || curve->time) &&
                   (!two || (curve->stretch_2 && curve->stress_2))
               ? SN_OK
               : SN_E_MEMORY;
}

// what a row holds, second axis included
typedef struct row {
    double time, stretch[2], stress[2];
} row;

static sn_status check_row(const sn_record *record, const sn_curve *curve, int i, const row *r) {
    int axes = curve->kind == SN_CURVE_BIAXIAL ? 2 : 1;
    bool shear = curve->kind == SN_CURVE_SHEAR;
    for (int a = 0; a < axes; ++a) {
        if (!isfinite(r->stretch[a]) || (!shear && !(r->stretch[a] > 0.0)))
            return sn_fail(SN_E_DATA, "%s: row %d: %s is %g, expected a number%s", record->name,
                           i + 1, shear ? "shear strain" : "stretch", r->stretch[a],
                           shear ? "" : " above 0");
        if (!isfinite(r->stress[a]))
            return sn_fail(SN_E_DATA, "%s: row %d: stress is %g, expected a number", record->name,
                           i + 1, r->stress[a]);
    }
    if (curve->time && !isfinite(r->time))
        return sn_fail(SN_E_DATA, "%s: row %d: time is %g, expected a number", record->name, i + 1,
                       r->time);
    return SN_OK;
}

// One row into the curve.
static sn_status take_row(const sn_record *record, int i, const row *r, sn_curve *curve) {
    int n = curve->count;
    SN_TRY(check_row(record, curve, i, r));
    if (curve->time) curve->time[n] = r->time;
    curve->stretch[n] = r->stretch[0];
    curve->stress[n] = r->stress[0];
    if (curve->kind == SN_CURVE_BIAXIAL) {
        curve->stretch_2[n] = r->stretch[1];
        curve->stress_2[n] = r->stress[1];
    }
    curve->count++;
    return SN_OK;
}

//---- moduli over frequency -----------------------------------------------------------------------

typedef struct modulus_row {
    double number[3]; // frequency, storage and loss modulus
    int row;          // of the record: rows of one frequency keep their order
} modulus_row;

static int by_frequency(const void *a, const void *b) {
    const modulus_row *x = a, *y = b;
    int order = (x->number[0] > y->number[0]) - (x->number[0] < y->number[0]);
    return order ? order : x->row - y->row;
}

static sn_status read_moduli(const sn_record *record, modulus_row *moduli) {
    static const char *const names[] = {"frequency", "storage_modulus", "loss_modulus"};
    for (int k = 0; k < 3; ++k) {
        const double *column = sn_record_values(record, names[k]);
        if (!column)
            return sn_fail(SN_E_DATA,
                           "%s: no column %s: a dynamic curve has frequency, storage_modulus and "
                           "loss_modulus",
                           record->name, names[k]);
        for (int i = 0; i < record->rows; ++i) {
            if (!isfinite(column[i]) || (k == 0 && !(column[i] > 0.0)))
                return sn_fail(SN_E_DATA, "%s: row %d: %s is %g, expected a number%s", record->name,
                               i + 1, names[k], column[i], k == 0 ? " above 0" : "");
            moduli[i].number[k] = column[i];
            moduli[i].row = i;
        }
    }
    return SN_OK;
}

// rows in the order of the frequency
static sn_status fill_dynamic(const sn_record *record, sn_curve *curve) {
    size_t n = (size_t)record->rows;
    const sn_note *note = sn_record_note(record, "mean_stretch");
    curve->mean_stretch = note ? note->value : 1.0;
    if (!isfinite(curve->mean_stretch) || !(curve->mean_stretch > 0.0))
        return sn_fail(SN_E_DATA, "%s: # mean_stretch: %s: expected a number above 0", record->name,
                       note->text);
    if (!note) remark(curve, "no remark mean_stretch: taken as 1");
    modulus_row *moduli = sn_alloc(n + 1, sizeof *moduli);
    sn_status status = SN_E_MEMORY;
    curve->frequency = sn_alloc(n, sizeof *curve->frequency);
    curve->storage = sn_alloc(n, sizeof *curve->storage);
    curve->loss = sn_alloc(n, sizeof *curve->loss);
    if (!moduli || !curve->frequency || !curve->storage || !curve->loss) goto fail;
    SN_TRY_GOTO(status, read_moduli(record, moduli));
    qsort(moduli, n, sizeof *moduli, by_frequency);
    for (size_t i = 0; i < n; ++i) {
        curve->frequency[i] = moduli[i].number[0];
        curve->storage[i] = moduli[i].number[1];
        curve->loss[i] = moduli[i].number[2];
    }
    curve->count = record->rows;
fail:
    sn_free(moduli);
    return status;
}

//---- all kinds -----------------------------------------------------------------------------------

static sn_status fill(const sn_record *record, sn_curve *curve) {
    static const source shear_strain = {"shear_strain", NULL, as_it_is, NULL};
    static const source shear_stress = {"shear_stress", NULL, as_it_is, NULL};
    static const char *const suffixes[] = {"_1", "_2"};
    SN_TRY(find_kind(record, &curve->kind));
    if (curve->kind == SN_CURVE_DYNAMIC) return fill_dynamic(record, curve);
    const double *time = sn_record_values(record, "time");
    bool two = curve->kind == SN_CURVE_BIAXIAL, shear = curve->kind == SN_CURVE_SHEAR;
    wanted length[2], load[2];
    for (int a = 0; a < (two ? 2 : 1); ++a) {
        const char *suffix = two ? suffixes[a] : "";
        length[a] = (wanted){stretch_sources,
                             STRETCHES,
                             "the stretch",
                             "stretch, strain, green_strain, or length or extension with a gauge "
                             "length",
                             NULL,
                             NULL,
                             (double)NAN};
        load[a] = (wanted){
            stress_sources, STRESSES,
            "the stress",   "stress (nominal), true_stress, pk2_stress, or force with an area",
            NULL,           NULL,
            (double)NAN};
        if (shear) {
            length[a] = (wanted){&shear_strain, 1, "the shear", "shear_strain", NULL, NULL, 0.0};
            load[a] = (wanted){&shear_stress, 1, "the shear", "shear_stress", NULL, NULL, 0.0};
        }
        SN_TRY(choose(record, suffix, &length[a]));
        SN_TRY(choose(record, suffix, &load[a]));
        if (length[a].chosen->remark) remark(curve, length[a].chosen->remark);
        if (load[a].chosen->remark) remark(curve, load[a].chosen->remark);
    }
    SN_TRY(allocate(curve, record->rows, time != NULL));
    for (int i = 0; i < record->rows; ++i) {
        row r = {.time = time ? time[i] : (double)NAN};
        for (int a = 0; a < (two ? 2 : 1); ++a) {
            const wanted *l = &length[a], *f = &load[a];
            r.stretch[a] = l->chosen->convert(l->column[i], l->note, (double)NAN);
            r.stress[a] = f->chosen->convert(f->column[i], f->note, r.stretch[a]);
        }
        SN_TRY(take_row(record, i, &r, curve));
    }
    return SN_OK;
}

static sn_status finish(const sn_record *record, sn_curve *curve) {
    SN_TRY(fill(record, curve));
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
    sn_status status = finish(record, curve);
    if (status != SN_OK) sn_curve_release(curve);
    return status;
}

void sn_curve_release(sn_curve *curve) {
    if (!curve) return;
    sn_free(curve->time);
    sn_free(curve->stretch);
    sn_free(curve->stress);
    sn_free(curve->stretch_2);
    sn_free(curve->stress_2);
    sn_free(curve->frequency);
    sn_free(curve->storage);
    sn_free(curve->loss);
    *curve = (sn_curve){0};
}

const char *sn_curve_kind_name(sn_curve_kind kind) {
    static const char *const names[] = {"uniaxial", "biaxial", "shear", "dynamic"};
    SN_ASSERT(kind <= SN_CURVE_DYNAMIC);
    return names[kind];
}

const double *sn_curve_measured(const sn_curve *curve, int which) {
    if (curve->kind == SN_CURVE_DYNAMIC) return which ? curve->loss : curve->storage;
    if (which == 0) return curve->stress;
    return curve->kind == SN_CURVE_BIAXIAL ? curve->stress_2 : NULL;
}

sn_status sn_curve_expect(const sn_curve *curve, sn_curve_kind kind, const char *what) {
    if (curve->kind == kind) return SN_OK;
    return sn_fail(SN_E_UNSUPPORTED, "%s: a %s curve: %s needs a %s one", curve->name,
                   sn_curve_kind_name(curve->kind), what, sn_curve_kind_name(kind));
}
