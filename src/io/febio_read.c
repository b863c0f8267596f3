// Reads a tissue from the material section of a FEBio file.
// SPDX-License-Identifier: Apache-2.0
//
// The conventions are those of febio.c. A material is read if all that it says is understood: a
// parameter that is not in its table, a map or an expression in place of a number are refused.
#include <libxml/parser.h>
#include <libxml/tree.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/file.h"
#include "io/foreign.h"
#include "io/text.h"

#define FILE_MAX ((size_t)64 << 20)
#define TERMS_MAX 6

typedef struct febio_reader {
    const char *path;
    sn_foreign *how;
} febio_reader;

static sn_status fail_at(const febio_reader *r, const xmlNode *node, sn_status status,
                         const char *what) {
    return sn_fail(status, "%s:%ld: <%s>: %s", r->path, xmlGetLineNo(node),
                   sn_text_quote((const char *)node->name).text, what);
}

static bool is_named(const xmlNode *node, const char *name) {
    return node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0;
}

// a child of this name; *twice tells that there are two
static const xmlNode *child(const xmlNode *parent, const char *name, const xmlNode **second) {
    const xmlNode *first = NULL;
    if (second) *second = NULL;
    for (const xmlNode *n = parent->children; n; n = n->next) {
        if (!is_named(n, name)) continue;
        if (first && second && !*second) *second = n;
        if (!first) first = n;
    }
    return first;
}

// the value of an attribute, at most SN_TEXT_MAX - 1 bytes of it; empty where there is none
static void attribute(const xmlNode *node, const char *name, char out[SN_TEXT_MAX]) {
    xmlChar *value = xmlGetProp((xmlNode *)node, (const xmlChar *)name);
    snprintf(out, SN_TEXT_MAX, "%s", value ? (const char *)value : "");
    xmlFree(value);
}

// the text of an element
static void content(const xmlNode *node, char out[SN_TEXT_MAX]) {
    xmlChar *value = xmlNodeGetContent(node);
    char *trimmed = value ? sn_text_trim((char *)value) : NULL;
    snprintf(out, SN_TEXT_MAX, "%s", trimmed ? trimmed : "");
    xmlFree(value);
}

static sn_status number_of(const febio_reader *r, const xmlNode *node, double *value) {
    char text[SN_TEXT_MAX], message[2 * SN_TEXT_MAX];
    const char *end;
    content(node, text);
    if (!sn_number_parse(text, value, &end) && *end == 0) return SN_OK;
    snprintf(message, sizeof message, "found \"%s\", expected a number", sn_text_quote(text).text);
    return fail_at(r, node, SN_E_SYNTAX, message);
}

// A number of a material. Without `optional` it must be there; else *value stays as it is.
static sn_status read_number(const febio_reader *r, const xmlNode *parent, const char *name,
                             bool optional, double *value) {
    const xmlNode *second, *node = child(parent, name, &second);
    char message[SN_TEXT_MAX];
    if (second) return fail_at(r, second, SN_E_KEY, "stands here twice");
    if (node) return number_of(r, node, value);
    if (optional) return SN_OK;
    snprintf(message, sizeof message, "<%s> is missing", name);
    return fail_at(r, parent, SN_E_KEY, message);
}

static sn_status read_stress(const febio_reader *r, const xmlNode *parent, const char *name,
                             double *value) {
    SN_TRY(read_number(r, parent, name, false, value));
    *value *= r->how->stress;
    return SN_OK;
}

//---- laws ----------------------------------------------------------------------------------------

static sn_status mooney_rivlin(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    double c1, c2;
    SN_TRY(read_stress(r, node, "c1", &c1));
    SN_TRY(read_stress(r, node, "c2", &c2));
    if (c2 == 0) {
        sn_foreign_law(t, "neo-hookean", 0);
        sn_foreign_set(t, "shear_modulus", 0, 2 * c1);
        return SN_OK;
    }
    sn_foreign_law(t, "mooney-rivlin", 0);
    sn_foreign_set(t, "c1", 0, c1);
    sn_foreign_set(t, "c2", 0, c2);
    return SN_OK;
}

static sn_status veronda_westmann(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    double c1, c2;
    SN_TRY(read_stress(r, node, "c1", &c1));
    SN_TRY(read_number(r, node, "c2", false, &c2));
    sn_foreign_law(t, "veronda-westmann", 0);
    sn_foreign_set(t, "c1", 0, c1);
    sn_foreign_set(t, "c2", 0, c2);
    return SN_OK;
}

static sn_status ogden(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    double mu[TERMS_MAX], alpha[TERMS_MAX];
    int terms = 0;
    for (int i = 1; i <= TERMS_MAX; i++) {
        char name[8];
        double c = 0, m = 1;
        snprintf(name, sizeof name, "c%d", i);
        SN_TRY(read_number(r, node, name, true, &c));
        snprintf(name, sizeof name, "m%d", i);
        SN_TRY(read_number(r, node, name, true, &m));
        if (c == 0) continue;
        if (m == 0) return fail_at(r, node, SN_E_RANGE, "a power m of 0 has no energy");
        mu[terms] = c * r->how->stress / m;
        alpha[terms++] = m;
    }
    if (terms == 0) return fail_at(r, node, SN_E_KEY, "<c1> is missing");
    sn_foreign_law(t, "ogden", terms);
    for (int i = 0; i < terms; i++) {
        sn_foreign_set(t, "mu", i, mu[i]);
        sn_foreign_set(t, "alpha", i, alpha[i]);
    }
    return SN_OK;
}

// A*(exp(B*(I1-3))-1): c = 2 A B, b = B
static sn_status demiray(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    const xmlNode *second, *w = child(node, "W", &second);
    char text[SN_TEXT_MAX];
    const char *s, *end;
    double scale, b;
    if (!w || second) return fail_at(r, node, SN_E_KEY, "expected one <W>");
    content(w, text);
    bool good = !sn_number_parse(text, &scale, &end) && strncmp(end, "*(exp(", 6) == 0;
    s = good ? end + 6 : text;
    good = good && !sn_number_parse(s, &b, &end) && strcmp(end, "*(I1-3))-1)") == 0;
    if (!good)
        return fail_at(r, w, SN_E_UNSUPPORTED,
                       "of all expressions A*(exp(B*(I1-3))-1) with numbers A and B is understood");
    sn_foreign_law(t, "demiray", 0);
    sn_foreign_set(t, "c", 0, 2 * scale * b * r->how->stress);
    sn_foreign_set(t, "b", 0, b);
    return SN_OK;
}

// the inverse of the compliance of E_i and v_ij, over c
static sn_status fung(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    static const char *const names[] = {"E1",  "E2",  "E3",  "G12", "G23",
                                        "G31", "v12", "v23", "v31", "c"};
    double v[10];
    for (int i = 0; i < 10; i++) SN_TRY(read_number(r, node, names[i], false, &v[i]));
    if (!(v[0] > 0 && v[1] > 0 && v[2] > 0 && v[9] > 0))
        return fail_at(r, node, SN_E_RANGE, "E1, E2, E3 and c must be more than 0");
    double s11 = 1 / v[0], s22 = 1 / v[1], s33 = 1 / v[2];
    double s12 = -v[6] / v[0], s23 = -v[7] / v[1], s31 = -v[8] / v[2];
    double det = s11 * (s22 * s33 - s23 * s23) - s12 * (s12 * s33 - s23 * s31) +
                 s31 * (s12 * s23 - s22 * s31);
    if (!(det > 0))
        return fail_at(r, node, SN_E_RANGE, "the compliance of E and v is not positive definite");
    double scale = 1 / (det * v[9]);
    const double a[9] = {(s22 * s33 - s23 * s23) * scale,
                         (s11 * s33 - s31 * s31) * scale,
                         (s11 * s22 - s12 * s12) * scale,
                         (s23 * s31 - s12 * s33) * scale,
                         (s12 * s31 - s11 * s23) * scale,
                         (s12 * s23 - s22 * s31) * scale,
                         2 * v[3] / v[9],
                         2 * v[4] / v[9],
                         2 * v[5] / v[9]};
    sn_foreign_law(t, "fung", 0);
    sn_foreign_set(t, "c", 0, v[9] * r->how->stress);
    for (int i = 0; i < 9; i++) sn_foreign_set(t, "a", i, a[i]);
    return SN_OK;
}

static sn_status hgo(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    double c, k1, k2, kappa, gamma;
    SN_TRY(read_stress(r, node, "c", &c));
    SN_TRY(read_stress(r, node, "k1", &k1));
    SN_TRY(read_number(r, node, "k2", false, &k2));
    SN_TRY(read_number(r, node, "kappa", false, &kappa));
    SN_TRY(read_number(r, node, "gamma", false, &gamma));
    sn_foreign_law(t, "hgo", 0);
    sn_foreign_set(t, "mu", 0, c);
    sn_foreign_set(t, "k1", 0, k1);
    sn_foreign_set(t, "k2", 0, k2);
    sn_foreign_set(t, "kappa", 0, kappa);
    sn_foreign_set(t, "angle", 0, gamma * (3.14159265358979323846 / 180));
    return SN_OK;
}

static const struct {
    const char *type;
    sn_status (*read)(const febio_reader *r, const xmlNode *node, sn_tissue *t);
    const char *keys; ///< between blanks: what it may say
} laws[] = {
    {"Mooney-Rivlin", mooney_rivlin, " c1 c2 "},
    {"Ogden", ogden, " c1 c2 c3 c4 c5 c6 m1 m2 m3 m4 m5 m6 "},
    {"uncoupled hyperelastic", demiray, " W "},
    {"Veronda-Westmann", veronda_westmann, " c1 c2 "},
    {"Fung orthotropic", fung, " E1 E2 E3 G12 G23 G31 v12 v23 v31 c mat_axis fiber "},
    {"Holzapfel-Gasser-Ogden", hgo, " c k1 k2 kappa gamma mat_axis fiber "},
};

#define LAWS ((int)(sizeof laws / sizeof laws[0]))

static sn_status unknown_type(const febio_reader *r, const xmlNode *node, const char *type) {
    char message[2 * SN_TEXT_MAX];
    const char *names[LAWS + 1] = {"uncoupled viscoelastic"};
    for (int k = 0; k < LAWS; k++) names[k + 1] = laws[k].type;
    const char *near = sn_suggest(type, names, LAWS + 1);
    snprintf(message, sizeof message,
             "material type \"%s\" is not understood%s%s%s; there are uncoupled viscoelastic, "
             "Mooney-Rivlin, Ogden, Veronda-Westmann, Fung orthotropic, Holzapfel-Gasser-Ogden",
             sn_text_quote(type).text, near ? ", did you mean \"" : "", near ? near : "",
             near ? "\"?" : "");
    return fail_at(r, node, SN_E_UNSUPPORTED, message);
}

// refuses children that are not among the keys of the material
static sn_status check_keys(const febio_reader *r, const xmlNode *node, const char *keys) {
    for (const xmlNode *n = node->children; n; n = n->next) {
        char word[SN_TEXT_MAX];
        if (n->type != XML_ELEMENT_NODE) continue;
        snprintf(word, sizeof word, " %s ", (const char *)n->name);
        if (strstr(keys, word) || strstr(" density k pressure_model laugon atol ", word)) continue;
        return fail_at(r, n, SN_E_KEY, "is not known in this material");
    }
    return SN_OK;
}

static sn_status read_law(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    char type[SN_TEXT_MAX];
    attribute(node, "type", type);
    for (int k = 0; k < LAWS; k++) {
        if (strcmp(type, laws[k].type) != 0) continue;
        SN_TRY(check_keys(r, node, laws[k].keys));
        return laws[k].read(r, node, t);
    }
    return unknown_type(r, node, type);
}

//---- memory and volume ---------------------------------------------------------------------------

// Constants of the long term to ours: weights over G(0), stresses times G(0).
static sn_status read_memory(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    double g0 = 1, g[TERMS_MAX], tau[TERMS_MAX], sum;
    int terms = 0;
    SN_TRY(read_number(r, node, "g0", true, &g0));
    sum = g0;
    for (int i = 1; i <= TERMS_MAX; i++) {
        char name[8];
        double weight = 0, time = 1;
        snprintf(name, sizeof name, "g%d", i);
        SN_TRY(read_number(r, node, name, true, &weight));
        snprintf(name, sizeof name, "t%d", i);
        SN_TRY(read_number(r, node, name, true, &time));
        if (weight == 0) continue;
        sum += weight;
        g[terms] = weight;
        tau[terms++] = time * r->how->time;
    }
    if (!(g0 >= 0 && sum > 0 && isfinite(sum)))
        return fail_at(r, node, SN_E_RANGE, "the weights g must not be negative, and not all 0");
    for (int i = 0; i < terms; i++) g[i] /= sum;
    sn_foreign_scale(t, sum, false);
    sn_foreign_prony(t, terms, g, tau);
    if (terms) sn_foreign_remark(r->how, "FEBio's memory spares the volume, here it relaxes too");
    return SN_OK;
}

static sn_status read_volume(const febio_reader *r, const xmlNode *node, const xmlNode *elastic,
                             sn_tissue *t) {
    const xmlNode *second, *model = child(node, "pressure_model", &second);
    char text[SN_TEXT_MAX] = "";
    double k = 0;
    SN_TRY(read_number(r, elastic, "k", true, &k));
    SN_TRY(read_number(r, node, "k", true, &k)); // what stands outside counts
    if (!(k > 0)) return fail_at(r, node, SN_E_KEY, "<k>, the bulk modulus, is missing or not > 0");
    sn_foreign_set(t, "bulk_modulus", 0, k * r->how->stress);
    if (model) content(model, text);
    if (strcmp(text, "2") != 0 && strcmp(text, "Abaqus") != 0)
        sn_foreign_remark(r->how,
                          "U(J) is K/2 (J - 1)^2 here, which is pressure_model 2; the material's "
                          "own is another one, equal at small changes of volume");
    return SN_OK;
}

static sn_status read_material(const febio_reader *r, const xmlNode *node, sn_tissue *t) {
    char type[SN_TEXT_MAX];
    double density = NAN;
    const xmlNode *elastic = node;
    attribute(node, "type", type);
    bool memory = strcmp(type, "uncoupled viscoelastic") == 0;
    if (memory) {
        SN_TRY(check_keys(r, node, " elastic g0 g1 g2 g3 g4 g5 g6 t1 t2 t3 t4 t5 t6 "));
        elastic = child(node, "elastic", NULL);
        if (!elastic) return fail_at(r, node, SN_E_KEY, "<elastic> is missing");
    }
    SN_TRY(read_law(r, elastic, t));
    attribute(node, "name", type);
    snprintf(t->name, sizeof t->name, "%.*s", SN_NAME_MAX - 1, *type ? type : "tissue");
    snprintf(t->source, sizeof t->source, "FEBio material \"%.60s\"", t->name);
    if (memory) SN_TRY(read_memory(r, node, t));
    SN_TRY(read_volume(r, node, elastic, t));
    SN_TRY(read_number(r, elastic, "density", true, &density));
    SN_TRY(read_number(r, node, "density", true, &density));
    t->density = density * sn_foreign_density(r->how);
    if (isfinite(density) && isnan(r->how->length))
        sn_foreign_remark(r->how, "the density was left out: it needs a unit of length");
    sn_status status = sn_tissue_check(t);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "%s:%ld", r->path, xmlGetLineNo(node));
}

//---- the file ------------------------------------------------------------------------------------

// the one material there is, or that of the name or number asked for
static sn_status find_material(const febio_reader *r, const xmlNode *section,
                               const xmlNode **material) {
    const char *wanted = r->how->material;
    int count = 0;
    for (const xmlNode *n = section->children; n; n = n->next) {
        char name[SN_TEXT_MAX], id[SN_TEXT_MAX];
        if (!is_named(n, "material")) continue;
        attribute(n, "name", name);
        attribute(n, "id", id);
        if (wanted && strcmp(wanted, name) != 0 && strcmp(wanted, id) != 0) continue;
        count++;
        *material = n;
    }
    if (count == 1) return SN_OK;
    if (wanted)
        return sn_fail(SN_E_NAME, "%s: %s material \"%s\"", r->path, count ? "more than one" : "no",
                       wanted);
    return count ? sn_fail(SN_E_NAME, "%s: %d materials: say which with --material", r->path, count)
                 : sn_fail(SN_E_KEY, "%s: no <material> in <Material>", r->path);
}

static sn_status read_document(const febio_reader *r, xmlDoc *document, sn_tissue *tissue) {
    const xmlNode *root = document ? xmlDocGetRootElement(document) : NULL;
    if (!root) {
        const xmlError *error = xmlGetLastError();
        char text[SN_TEXT_MAX];
        snprintf(text, sizeof text, "%s", error && error->message ? error->message : "no XML");
        text[strcspn(text, "\r\n")] = 0;
        return sn_fail(SN_E_SYNTAX, "%s:%d: no XML: %s", r->path, error ? error->line : 1,
                       sn_text_quote(text).text);
    }
    const xmlNode *section = is_named(root, "febio_spec") ? child(root, "Material", NULL) : NULL;
    const xmlNode *material = NULL;
    if (!section)
        return sn_fail(SN_E_KEY, "%s: expected <febio_spec> with a section <Material>", r->path);
    SN_TRY(find_material(r, section, &material));
    return read_material(r, material, tissue);
}

// what the parser would print goes nowhere; its first complaint is in xmlGetLastError()
static void silent(void *context, const char *format, ...) {
    (void)context;
    (void)format;
}

sn_status sn_tissue_read_febio(const char *path, sn_tissue *tissue, sn_foreign *how) {
    char *text;
    size_t bytes;
    const febio_reader r = {path, how};
    sn_tissue read;
    how->remarks[0] = 0;
    SN_TRY(sn_foreign_check(how));
    SN_TRY(sn_file_read(path, FILE_MAX, &text, &bytes));
    xmlGenericErrorFunc printer = xmlGenericError; // of this thread
    void *context = xmlGenericErrorContext;
    xmlSetGenericErrorFunc(NULL, silent);
    xmlResetLastError();
    // nothing is loaded from elsewhere, entities stay what they are
    xmlDoc *document = xmlReadMemory(text, (int)bytes, "file", NULL,
                                     XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING);
    sn_free(text);
    sn_status status = read_document(&r, document, &read);
    xmlFreeDoc(document);
    xmlSetGenericErrorFunc(context, printer);
    if (status != SN_OK) return status;
    how->terms = read.memory.terms;
    how->max_error = 0;
    *tissue = read;
    return SN_OK;
}
