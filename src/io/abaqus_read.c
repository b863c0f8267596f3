// Reads a tissue from the materials of an Abaqus input file.
// SPDX-License-Identifier: Apache-2.0
//
// A keyword line starts with '*' ('**' is a comment), has parameters after commas, goes on in the
// next line where it ends in a comma, and is followed by lines of numbers. Case and blanks do not
// count. Keywords that are no part of a material are passed over; options of a material that change
// its stress and are not understood are refused. Conventions: abaqus.c.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/csv.h"
#include "io/file.h"
#include "io/foreign.h"
#include "io/text.h"

#define HEAD_MAX 512
#define TERMS_MAX SN_TERMS_MAX
#define OGDEN_MAX 6

// A keyword with what follows it.
typedef struct block {
    int line;
    char head[HEAD_MAX]; ///< upper case, blanks taken out, comma in front of every parameter
    int count;           ///< numbers
    double number[3 * TERMS_MAX];
    int rows;
    bool text; ///< a data line that is no list of numbers
} block;

typedef struct abaqus_reader {
    sn_csv csv;
    sn_foreign *how;
    bool inside;   ///< of the material that is wanted
    int materials; ///< materials of the wanted name so far
    char name[SN_NAME_MAX];
    block elastic, viscoelastic; ///< line 0 where there is none
    double density, angle;
    bool angled;
} abaqus_reader;

static sn_status fail_line(const abaqus_reader *r, int line, sn_status status, const char *what) {
    return sn_fail(status, "%s:%d: %s", r->csv.path, line, what);
}

//---- keyword lines -------------------------------------------------------------------------------

// takes blanks out and makes capitals
static void squeeze(const char *text, char *out, size_t size) {
    size_t n = strlen(out);
    for (; *text && n + 1 < size; text++)
        if (*text != ' ' && *text != '\t')
            out[n++] = (char)(*text >= 'a' && *text <= 'z' ? *text - 'a' + 'A' : *text);
    out[n] = 0;
}

static bool is_keyword(const block *b, const char *keyword) {
    size_t length = strlen(keyword);
    return strncmp(b->head, keyword, length) == 0 && (!b->head[length] || b->head[length] == ',');
}

// whether a parameter stands there; *value gets what follows its '='
static bool parameter(const block *b, const char *name, char value[SN_NAME_MAX]) {
    size_t length = strlen(name);
    for (const char *s = strchr(b->head, ','); s; s = strchr(s + 1, ',')) {
        if (strncmp(s + 1, name, length) != 0) continue;
        const char *end = s + 1 + length;
        if (*end && *end != ',' && *end != '=') continue;
        if (value)
            snprintf(value, SN_NAME_MAX, "%.*s", *end == '=' ? (int)strcspn(end + 1, ",") : 0,
                     *end == '=' ? end + 1 : "");
        return true;
    }
    return false;
}

static void read_numbers(abaqus_reader *r, block *b) {
    r->csv.separator = ',';
    char *s = r->csv.text;
    const char *end;
    for (b->rows++; *s; s = *end ? (char *)end + 1 : (char *)end) {
        double value;
        s += strspn(s, " \t");
        if (!*s) return;
        bool bad = *s != ',' && sn_number_parse(s, &value, &end) != NULL;
        if (*s == ',') value = 0, end = s; // an empty field is 0
        if (!bad) end += strspn(end, " \t");
        if (bad || (*end && *end != ',') || b->count == (int)(sizeof b->number / sizeof(double))) {
            b->text = true;
            return;
        }
        b->number[b->count++] = value;
    }
}

// Reads the block whose keyword line is in the buffer; the line after it is in the buffer then.
static sn_status read_block(abaqus_reader *r, block *b) {
    *b = (block){.line = r->csv.line};
    squeeze(r->csv.text, b->head, sizeof b->head);
    for (;;) {
        size_t length = strlen(b->head);
        SN_TRY(sn_csv_line(&r->csv));
        if (r->csv.end) return SN_OK;
        if (strncmp(r->csv.text, "**", 2) == 0) continue;
        if (r->csv.text[0] == '*') return SN_OK;
        if (b->rows == 0 && b->count == 0 && length && b->head[length - 1] == ',')
            squeeze(r->csv.text, b->head, sizeof b->head);
        else
            read_numbers(r, b);
    }
}

//---- blocks --------------------------------------------------------------------------------------

static sn_status enter_material(abaqus_reader *r, const block *b) {
    char name[SN_NAME_MAX] = "", wanted[SN_NAME_MAX] = "";
    parameter(b, "NAME", name);
    if (r->how->material) squeeze(r->how->material, wanted, sizeof wanted);
    r->inside = !*wanted || strcmp(name, wanted) == 0;
    if (!r->inside) return SN_OK;
    memcpy(r->name, name, sizeof name);
    if (++r->materials == 1) return SN_OK;
    return fail_line(r, b->line, SN_E_NAME,
                     *wanted ? "a second material of this name"
                             : "a second material: say which with --material");
}

// the two local directions of an orientation: at +angle and -angle to the first axis
static void take_orientation(abaqus_reader *r, const block *b) {
    if (!parameter(b, "LOCALDIRECTIONS", NULL) || b->count != 14) return;
    const double *one = b->number + 8, *two = one + 3;
    bool mirrored = fabs(one[0] - two[0]) <= 1e-12 && fabs(one[1] + two[1]) <= 1e-12 &&
                    one[2] == 0 && two[2] == 0 && one[0] >= 0 && one[1] >= 0;
    if (!mirrored) return;
    r->angle = atan2(one[1], one[0]);
    r->angled = true;
}

static sn_status take_option(abaqus_reader *r, const block *b) {
    static const char *const refused[] = {
        "*ELASTIC", "*HYPERFOAM",   "*MULLINSEFFECT", "*HYSTERESIS", "*PLASTIC", "*USERMATERIAL",
        "*CREEP",   "*HYPOELASTIC", "*VISCOUS",       "*TRS",        "*DAMPING"};
    for (int k = 0; k < (int)(sizeof refused / sizeof refused[0]); k++)
        if (is_keyword(b, refused[k])) {
            char text[SN_TEXT_MAX];
            snprintf(text, sizeof text, "%s is not supported in a material", refused[k]);
            return fail_line(r, b->line, SN_E_UNSUPPORTED, text);
        }
    if (is_keyword(b, "*DENSITY")) {
        if (b->count != 1 || b->text)
            return fail_line(r, b->line, SN_E_SYNTAX, "*DENSITY: expected one number");
        r->density = b->number[0];
    }
    bool elastic = is_keyword(b, "*HYPERELASTIC") || is_keyword(b, "*ANISOTROPICHYPERELASTIC");
    block *slot = elastic ? &r->elastic : is_keyword(b, "*VISCOELASTIC") ? &r->viscoelastic : NULL;
    if (!slot) return SN_OK;
    if (slot->line) return fail_line(r, b->line, SN_E_KEY, "stands twice in this material");
    if (b->text || b->count == 0)
        return fail_line(r, b->line, SN_E_SYNTAX, "expected lines of numbers after this keyword");
    *slot = *b;
    return SN_OK;
}

//---- laws ----------------------------------------------------------------------------------------

static sn_status wrong_count(const abaqus_reader *r, const char *expected) {
    return sn_fail(SN_E_SYNTAX,
                   "%s:%d: %d numbers, expected %s (constants that depend on temperature are not "
                   "supported)",
                   r->csv.path, r->elastic.line, r->elastic.count, expected);
}

// D = 2/K; 0 is incompressible
static sn_status set_volume(const abaqus_reader *r, sn_tissue *t, double D) {
    if (!(D >= 0)) return fail_line(r, r->elastic.line, SN_E_RANGE, "D is negative");
    sn_foreign_set(t, "bulk_modulus", 0, D > 0 ? 2 / D * r->how->stress : (double)INFINITY);
    return SN_OK;
}

static sn_status read_ogden(const abaqus_reader *r, sn_tissue *t) {
    const block *b = &r->elastic;
    char text[SN_NAME_MAX] = "1";
    parameter(b, "N", text);
    int terms = text[0] - '0';
    if (strlen(text) != 1 || terms < 1 || terms > OGDEN_MAX)
        return fail_line(r, b->line, SN_E_RANGE, "OGDEN: expected N from 1 to 6");
    if (b->count < 2 * terms || b->count > 3 * terms)
        return wrong_count(r, "mu and alpha of every term, then D");
    sn_foreign_law(t, "ogden", terms);
    for (int i = 0; i < terms; i++) {
        double mu = b->number[2 * i], alpha = b->number[2 * i + 1];
        if (alpha == 0) return fail_line(r, b->line, SN_E_RANGE, "OGDEN: alpha is 0");
        sn_foreign_set(t, "mu", i, 2 * mu / alpha * r->how->stress);
        sn_foreign_set(t, "alpha", i, alpha);
    }
    for (int i = 2 * terms + 1; i < b->count; i++)
        if (b->number[i] != 0)
            return fail_line(r, b->line, SN_E_UNSUPPORTED,
                             "OGDEN: D2 and further ones (higher powers of J - 1) must be 0");
    return set_volume(r, t, b->count > 2 * terms ? b->number[2 * terms] : 0);
}

static sn_status read_isotropic(const abaqus_reader *r, sn_tissue *t) {
    const block *b = &r->elastic;
    const double *v = b->number, unit = r->how->stress;
    if (parameter(b, "NEOHOOKE", NULL)) {
        if (b->count > 2) return wrong_count(r, "C10 and D1");
        sn_foreign_law(t, "neo-hookean", 0);
        sn_foreign_set(t, "shear_modulus", 0, 2 * v[0] * unit);
        return set_volume(r, t, v[1]);
    }
    if (parameter(b, "MOONEY-RIVLIN", NULL)) {
        if (b->count < 2 || b->count > 3) return wrong_count(r, "C10, C01 and D1");
        sn_foreign_law(t, "mooney-rivlin", 0);
        sn_foreign_set(t, "c1", 0, v[0] * unit);
        sn_foreign_set(t, "c2", 0, v[1] * unit);
        return set_volume(r, t, v[2]);
    }
    if (parameter(b, "OGDEN", NULL)) return read_ogden(r, t);
    return fail_line(r, b->line, SN_E_UNSUPPORTED,
                     "*HYPERELASTIC: of its energies NEO HOOKE, MOONEY-RIVLIN and OGDEN are "
                     "supported");
}

static sn_status read_anisotropic(const abaqus_reader *r, sn_tissue *t) {
    const block *b = &r->elastic;
    const double *v = b->number, unit = r->how->stress;
    if (parameter(b, "FUNG-ORTHOTROPIC", NULL)) {
        if (b->count != 11) return wrong_count(r, "nine b, c and D");
        const double a[9] = {v[0], v[2], v[5], v[1], v[4], v[3], 2 * v[6], 2 * v[8], 2 * v[7]};
        sn_foreign_law(t, "fung", 0);
        sn_foreign_set(t, "c", 0, v[9] * unit);
        for (int i = 0; i < 9; i++) sn_foreign_set(t, "a", i, a[i]);
        return set_volume(r, t, v[10]);
    }
    if (parameter(b, "HOLZAPFEL", NULL)) {
        if (b->count != 5) return wrong_count(r, "C10, D, k1, k2 and kappa");
        if (!r->angled)
            return fail_line(r, b->line, SN_E_KEY,
                             "HOLZAPFEL: expected an *ORIENTATION, LOCAL DIRECTIONS=2 before it, "
                             "with directions cos, sin, 0 and cos, -sin, 0");
        sn_foreign_law(t, "hgo", 0);
        sn_foreign_set(t, "mu", 0, 2 * v[0] * unit);
        sn_foreign_set(t, "k1", 0, v[2] * unit);
        sn_foreign_set(t, "k2", 0, v[3]);
        sn_foreign_set(t, "kappa", 0, v[4]);
        sn_foreign_set(t, "angle", 0, r->angle);
        return set_volume(r, t, v[1]);
    }
    return fail_line(r, b->line, SN_E_UNSUPPORTED,
                     "*ANISOTROPIC HYPERELASTIC: of its energies FUNG-ORTHOTROPIC and HOLZAPFEL "
                     "are supported");
}

//---- memory --------------------------------------------------------------------------------------

static sn_status read_memory(abaqus_reader *r, sn_tissue *t) {
    const block *b = &r->viscoelastic;
    char text[SN_NAME_MAX] = "";
    double g[TERMS_MAX], tau[TERMS_MAX], sum = 0;
    int terms = b->count / 3;
    bool spared = true;
    if (!parameter(b, "TIME", text) || strcmp(text, "PRONY") != 0)
        return fail_line(r, b->line, SN_E_UNSUPPORTED,
                         "*VISCOELASTIC: only TIME=PRONY is supported");
    if (b->count != 3 * terms || terms != b->rows || terms > TERMS_MAX)
        return fail_line(r, b->line, SN_E_SYNTAX, "*VISCOELASTIC: expected lines of g, k, tau");
    for (int i = 0; i < terms; i++) spared = spared && b->number[3 * i + 1] == 0;
    for (int i = 0; i < terms; i++) {
        const double *v = b->number + 3 * i;
        if (!spared && v[1] != v[0])
            return fail_line(r, b->line, SN_E_UNSUPPORTED,
                             "*VISCOELASTIC: expected k = g in every line (one memory for shape "
                             "and volume) or k = 0 in all");
        g[i] = v[0];
        tau[i] = v[2] * r->how->time;
        sum += v[0];
    }
    if (spared)
        sn_foreign_remark(r->how, "the file's memory spares the volume, here it relaxes too");
    sn_foreign_prony(t, terms, g, tau);
    if (parameter(&r->elastic, "MODULI", text) && strcmp(text, "INSTANTANEOUS") == 0) return SN_OK;
    // what Abaqus takes where nothing is said: constants of the long term
    if (!(sum < 1)) return fail_line(r, b->line, SN_E_RANGE, "*VISCOELASTIC: g sum to 1 or more");
    sn_foreign_scale(t, 1 / (1 - sum), !spared);
    return SN_OK;
}

//---- the file ------------------------------------------------------------------------------------

static sn_status read_blocks(abaqus_reader *r) {
    block *b = sn_alloc(1, sizeof *b);
    if (!b) return SN_E_MEMORY;
    sn_status status = sn_csv_line(&r->csv);
    while (status == SN_OK && !r->csv.end) {
        if (r->csv.text[0] != '*' || r->csv.text[1] == '*') {
            status = sn_csv_line(&r->csv);
            continue;
        }
        status = read_block(r, b);
        if (status != SN_OK) break;
        if (is_keyword(b, "*MATERIAL"))
            status = enter_material(r, b);
        else if (is_keyword(b, "*ORIENTATION"))
            take_orientation(r, b);
        else if (is_keyword(b, "*STEP"))
            r->inside = false;
        else if (r->inside)
            status = take_option(r, b);
    }
    sn_free(b);
    return status;
}

static sn_status build(abaqus_reader *r, sn_tissue *t) {
    if (!r->materials)
        return sn_fail(r->how->material ? SN_E_NAME : SN_E_KEY, "%s: no *MATERIAL%s%s", r->csv.path,
                       r->how->material ? " of the name " : "",
                       r->how->material ? r->how->material : "");
    if (!r->elastic.line)
        return sn_fail(SN_E_KEY,
                       "%s: material %s has no *HYPERELASTIC or *ANISOTROPIC HYPERELASTIC",
                       r->csv.path, r->name);
    bool isotropic = is_keyword(&r->elastic, "*HYPERELASTIC");
    SN_TRY(isotropic ? read_isotropic(r, t) : read_anisotropic(r, t));
    snprintf(t->name, sizeof t->name, "%s", *r->name ? r->name : "tissue");
    snprintf(t->source, sizeof t->source, "Abaqus material %s", t->name);
    if (r->viscoelastic.line) SN_TRY(read_memory(r, t));
    t->density = r->density * sn_foreign_density(r->how);
    if (isfinite(r->density) && isnan(r->how->length))
        sn_foreign_remark(r->how, "the density was left out: it needs a unit of length");
    if (!isotropic && isfinite(sn_tissue_value(t, "bulk_modulus")))
        sn_foreign_remark(r->how,
                          "U(J) was ((J^2 - 1)/2 - ln J)/D and is K/2 (J - 1)^2 here: equal "
                          "at small changes of volume");
    sn_status status = sn_tissue_check(t);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "%s:%d", r->csv.path, r->elastic.line);
}

sn_status sn_tissue_read_abaqus(const char *path, sn_tissue *tissue, sn_foreign *how) {
    sn_tissue read;
    how->remarks[0] = 0;
    SN_TRY(sn_foreign_check(how));
    abaqus_reader *r = sn_alloc(1, sizeof *r);
    if (!r) return SN_E_MEMORY;
    r->csv.path = path;
    r->how = how;
    r->density = NAN;
    sn_status status = sn_file_open(path, &r->csv.stream);
    if (status == SN_OK) status = read_blocks(r);
    if (status == SN_OK) status = build(r, &read);
    if (r->csv.stream) fclose(r->csv.stream);
    sn_free(r);
    if (status != SN_OK) return status;
    how->terms = read.memory.terms;
    how->max_error = 0;
    *tissue = read;
    return SN_OK;
}
