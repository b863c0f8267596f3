// Reads and writes tissue files.
// SPDX-License-Identifier: Apache-2.0
//
//     tissue: rabbit skin
//     source: where the constants come from
//     density: 1100 kg/m3
//     elastic: {law: exponential, B: 15, C: 20 kPa}
//     memory: {law: fung-spectrum, c: 0.1, tau1: 10 ms, tau2: 100 s}
//
// or, where the parts of the stress differ,
//
//     memory: {branch: {deviatoric: {law: …}, volumetric: {law: …}, fibre: {law: …}}}
//
// The keys below `elastic` and `memory` are the parameter table of the law, so a new law is read
// and written without a line here. `convention` (instantaneous, the default, or long-term) may
// stand at the top, in `elastic` or in `memory`, once: it is about both.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/buffer.h"
#include "io/text.h"
#include "io/units.h"
#include "io/yaml.h"

#define KEYS_MAX (SN_VALUES_MAX + 4)

static const char *const parts[SN_PARTS] = {"deviatoric", "volumetric", "fibre"};

//---- parameters from a table ---------------------------------------------------------------------

// A table of parameters with room for its values.
typedef struct table {
    const char *owner; ///< "law demiray", for messages
    const sn_param *params;
    int count;
    bool ranged; ///< check ranges; not before constants of the long term are converted
    int *terms;
    double *value; ///< (SN_VALUES_MAX)
} table;

static void bound_text(const sn_param *param, double bound, char out[SN_NAME_MAX]) {
    sn_quantity_print(bound, param->unit, out);
}

static sn_status check_range(const sn_yaml *node, const sn_param *param, double value) {
    bool low = value < param->min || (param->min_open && value <= param->min);
    bool high = value > param->max || (param->max_open && value >= param->max);
    if (!low && !high) return SN_OK;
    char min[SN_NAME_MAX], max[SN_NAME_MAX];
    bound_text(param, param->min, min);
    bound_text(param, param->max, max);
    if (isinf(param->max))
        return sn_yaml_expected(node, SN_E_RANGE, "%s %s",
                                param->min_open ? "more than" : "at least", min);
    if (isinf(param->min))
        return sn_yaml_expected(node, SN_E_RANGE, "%s %s",
                                param->max_open ? "less than" : "at most", max);
    return sn_yaml_expected(node, SN_E_RANGE, "%s %s and %s %s",
                            param->min_open ? "more than" : "at least", min,
                            param->max_open ? "less than" : "at most", max);
}

static sn_status read_value(const sn_yaml *node, const table *t, const sn_param *param,
                            double *value) {
    if (param->infinity && node->kind == SN_YAML_TEXT) {
        if (strcmp(node->text, param->infinity) == 0) {
            *value = (double)INFINITY;
            return SN_OK;
        }
        const char *end;
        if (sn_number_parse(node->text, value, &end) != NULL) {
            char example[SN_NAME_MAX];
            sn_unit_example(param->unit, example);
            return sn_yaml_expected(node, SN_E_SYNTAX, "%s or %s", example, param->infinity);
        }
    }
    SN_TRY(sn_yaml_quantity(node, param->unit, value));
    return t->ranged ? check_range(node, param, *value) : SN_OK;
}

// All lists of one value a term must be equally long; that length is the number of terms.
static sn_status find_terms(const sn_yaml *map, const table *t) {
    const char *first = NULL;
    *t->terms = 0;
    for (int k = 0; k < t->count; k++) {
        if (t->params[k].length != SN_PARAM_LIST) continue;
        const sn_yaml *node = sn_yaml_get(map, t->params[k].name);
        if (!node) continue;
        if (node->kind != SN_YAML_LIST || node->count == 0)
            return sn_yaml_expected(node, SN_E_SYNTAX, "a list […] with a value for every term");
        if (node->count > SN_TERMS_MAX)
            return sn_yaml_fail(node, SN_E_RANGE, "found a list of %d, expected at most %d terms",
                                node->count, SN_TERMS_MAX);
        if (first && node->count != *t->terms)
            return sn_yaml_fail(node, SN_E_SYNTAX,
                                "found a list of %d, expected %d values as in \"%s\"", node->count,
                                *t->terms, first);
        first = t->params[k].name;
        *t->terms = node->count;
    }
    if (sn_param_offset(t->params, t->count, *t->terms) > SN_VALUES_MAX)
        return sn_yaml_fail(map, SN_E_RANGE, "more than %d values", SN_VALUES_MAX);
    return SN_OK;
}

static sn_status read_param(const sn_yaml *node, const table *t, int k) {
    const sn_param *param = &t->params[k];
    double *value = t->value + sn_param_offset(t->params, k, *t->terms);
    if (param->length == 0 || param->length == 1) return read_value(node, t, param, value);
    int count = sn_param_length(param, *t->terms);
    if (node->kind != SN_YAML_LIST || node->count != count)
        return node->kind == SN_YAML_LIST
                   ? sn_yaml_fail(node, SN_E_SYNTAX, "found a list of %d, expected %d values",
                                  node->count, count)
                   : sn_yaml_expected(node, SN_E_SYNTAX, "a list […] of %d values", count);
    for (const sn_yaml *item = node->first; item; item = item->next)
        SN_TRY(read_value(item, t, param, value++));
    return SN_OK;
}

// Reads the parameters of a table from a map; what has a default may be left out.
static sn_status read_table(const sn_yaml *map, const table *t) {
    char missing[SN_TEXT_MAX] = "";
    size_t used = 0;
    SN_TRY(find_terms(map, t));
    sn_param_defaults(t->params, t->count, *t->terms, t->value);
    for (int k = 0; k < t->count; k++) {
        const sn_param *param = &t->params[k];
        const sn_yaml *node = sn_yaml_get(map, param->name);
        bool empty = param->length == SN_PARAM_LIST && *t->terms == 0;
        if (node)
            SN_TRY(read_param(node, t, k));
        else if ((isnan(param->init) || empty) && used < sizeof missing)
            used += (size_t)snprintf(missing + used, sizeof missing - used, "%s\"%s\"",
                                     used ? ", " : "", param->name);
    }
    if (*missing) return sn_yaml_fail(map, SN_E_KEY, "%s needs %s: missing", t->owner, missing);
    return SN_OK;
}

// Keys that a map may have: those of the table and some more.
static sn_status check_keys(const sn_yaml *map, const table *t, const char *const *more,
                            int count) {
    const char *keys[KEYS_MAX];
    int n = 0;
    for (int k = 0; k < count; k++) keys[n++] = more[k];
    for (int k = 0; k < t->count && n < KEYS_MAX; k++) keys[n++] = t->params[k].name;
    return sn_yaml_map(map, keys, n);
}

//---- elastic and memory --------------------------------------------------------------------------

// The value of "law" in a map that may have any further keys at this point.
static sn_status read_law_name(const sn_yaml *map, const char *example, const sn_yaml **node) {
    if (map->kind != SN_YAML_MAP)
        return sn_yaml_expected(map, SN_E_SYNTAX, "a map such as %s", example);
    SN_TRY(sn_yaml_need(map, "law", node));
    const char *name;
    return sn_yaml_text(*node, "the name of a law", &name);
}

static sn_status read_elastic(const sn_yaml *map, sn_tissue *tissue) {
    static const char *const more[] = {"law", "convention", "poissons_ratio"};
    const sn_yaml *law;
    SN_TRY(read_law_name(map, "{law: exponential, B: 15, C: 20 kPa}", &law));
    tissue->law = sn_law_find(law->text);
    if (!tissue->law) return sn_yaml_within(law, SN_E_NAME);

    char owner[SN_NAME_MAX];
    snprintf(owner, sizeof owner, "law %s", tissue->law->name);
    table t = {owner, tissue->law->params, tissue->law->param_count,
               true,  &tissue->terms,      tissue->value};
    bool uniaxial = tissue->law->kind == SN_LAW_UNIAXIAL;
    SN_TRY(check_keys(map, &t, more, uniaxial ? 3 : 2));
    SN_TRY(read_table(map, &t));
    const sn_yaml *ratio = sn_yaml_get(map, "poissons_ratio");
    if (uniaxial && ratio) {
        SN_TRY(sn_yaml_quantity(ratio, "1", &tissue->poissons_ratio));
        if (!(tissue->poissons_ratio > -1.0 && tissue->poissons_ratio < 0.5))
            return sn_yaml_expected(ratio, SN_E_RANGE, "more than -1 and less than 0.5");
    }
    return sn_yaml_within(map, sn_law_check(tissue->law, tissue->value, tissue->terms));
}

static const char memory_example[] = "{law: fung-spectrum, c: 0.1, tau1: 10 ms, tau2: 100 s}";

// One law of memory; `more` are the keys that its map may have beside the law's.
static sn_status read_law_of_memory(const sn_yaml *map, bool long_term, const char *const *more,
                                    int count, sn_memory *memory) {
    const sn_yaml *law;
    SN_TRY(read_law_name(map, memory_example, &law));
    memory->law = sn_memory_law_find(law->text);
    if (!memory->law) return sn_yaml_within(law, SN_E_NAME);

    char owner[SN_NAME_MAX];
    snprintf(owner, sizeof owner, "memory %s", memory->law->name);
    table t = {owner,      memory->law->params, memory->law->param_count,
               !long_term, &memory->terms,      memory->value};
    SN_TRY(check_keys(map, &t, more, count));
    SN_TRY(read_table(map, &t));
    return long_term ? SN_OK : sn_yaml_within(map, sn_memory_check(memory));
}

// A memory for each part. One that is not named has none; but fibres, which are a part of what is
// called deviatoric, follow it until they are named.
static sn_status read_branches(const sn_yaml *map, bool long_term, sn_tissue *tissue) {
    static const char *const memory_keys[] = {"branch", "convention"};
    static const char *const more[] = {"law"};
    sn_memory *const memory[SN_PARTS] = {&tissue->memory, &tissue->volumetric, &tissue->fibre};
    const sn_yaml *branch = sn_yaml_get(map, "branch");
    SN_TRY(sn_yaml_map(map, memory_keys, 2));
    if (branch->kind != SN_YAML_MAP)
        return sn_yaml_expected(branch, SN_E_SYNTAX, "a map such as {deviatoric: %s}",
                                memory_example);
    SN_TRY(sn_yaml_map(branch, parts, SN_PARTS));
    if (branch->count == 0)
        return sn_yaml_fail(branch, SN_E_KEY, "needs deviatoric, volumetric or fibre: missing");
    tissue->branched = true;
    for (int k = 0; k < SN_PARTS; k++) {
        const sn_yaml *part = sn_yaml_get(branch, parts[k]);
        if (part) SN_TRY(read_law_of_memory(part, long_term, more, 1, memory[k]));
    }
    if (tissue->law->fibre_constant && !sn_yaml_get(branch, parts[SN_PART_FIBRE]))
        tissue->fibre = tissue->memory;
    return SN_OK;
}

static sn_status read_memory(const sn_yaml *map, bool long_term, sn_tissue *tissue) {
    static const char *const more[] = {"law", "convention"};
    static const char *const keys[] = {"branch", "law", "convention"};
    if (sn_yaml_get(map, "branch")) return read_branches(map, long_term, tissue);
    // no constant of a law is a map: one that is, is a misspelt branch
    for (const sn_yaml *value = map->first; value; value = value->next)
        if (value->kind == SN_YAML_MAP) SN_TRY(sn_yaml_map(map, keys, 3));
    return read_law_of_memory(map, long_term, more, 2, &tissue->memory);
}

// The key "convention" wherever it stands. *node is NULL where there is none.
static sn_status find_convention(const sn_yaml *root, const sn_yaml **node, bool *long_term) {
    static const char *const names[] = {"instantaneous", "long-term"};
    const sn_yaml *const places[] = {root, sn_yaml_get(root, "elastic"),
                                     sn_yaml_get(root, "memory")};
    *node = NULL;
    *long_term = false;
    for (int k = 0; k < 3; k++) {
        const sn_yaml *found = places[k] ? sn_yaml_get(places[k], "convention") : NULL;
        if (!found) continue;
        int index;
        if (*node)
            return sn_yaml_fail(found, SN_E_KEY, "given twice, first in line %d", (*node)->line);
        SN_TRY(sn_yaml_choice(found, names, 2, &index));
        *node = found;
        *long_term = index == 1;
    }
    return SN_OK;
}

static sn_status read_tissue(const sn_yaml *root, sn_tissue *tissue) {
    static const char *const keys[] = {"tissue",  "source", "density",
                                       "elastic", "memory", "convention"};
    const sn_yaml *node, *convention;
    bool long_term;
    SN_TRY(sn_yaml_map(root, keys, 6));
    SN_TRY(find_convention(root, &convention, &long_term));
    SN_TRY(sn_yaml_need(root, "tissue", &node));
    SN_TRY(sn_yaml_copy(node, "the name of the tissue", tissue->name, sizeof tissue->name));
    if ((node = sn_yaml_get(root, "source")))
        SN_TRY(sn_yaml_copy(node, "where the constants come from", tissue->source,
                            sizeof tissue->source));
    if ((node = sn_yaml_get(root, "density"))) {
        SN_TRY(sn_yaml_quantity(node, "kg/m3", &tissue->density));
        if (!(tissue->density > 0.0))
            return sn_yaml_expected(node, SN_E_RANGE, "a density of more than 0");
    }
    SN_TRY(sn_yaml_need(root, "elastic", &node));
    SN_TRY(read_elastic(node, tissue));
    if ((node = sn_yaml_get(root, "memory"))) SN_TRY(read_memory(node, long_term, tissue));
    if (long_term) SN_TRY(sn_yaml_within(convention, sn_tissue_from_long_term(tissue)));
    // the rest has been checked where it stands: what is left is the law against the branches
    return sn_yaml_within(tissue->branched ? sn_yaml_get(node, "branch") : root,
                          sn_tissue_check(tissue));
}

sn_status sn_tissue_read(const char *path, sn_tissue *tissue) {
    sn_yaml *root;
    sn_tissue read = sn_tissue_default();
    SN_TRY(sn_yaml_read(path, &root));
    sn_status status = read_tissue(root, &read);
    sn_yaml_destroy(root);
    if (status == SN_OK) *tissue = read;
    return status;
}

//---- writing -------------------------------------------------------------------------------------

// A text as YAML: bare where that is safe, else between double quotes.
static void write_text(sn_buffer *out, const char *text) {
    static const char safe[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 "
                               "_-+./(),;=%";
    size_t length = strlen(text);
    bool bare = length > 0 && strspn(text, safe) == length && text[length - 1] != ' ' &&
                strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", text[0]);
    if (bare) {
        sn_buffer_text(out, text);
        return;
    }
    sn_buffer_text(out, "\"");
    for (const char *s = text; *s; s++) {
        char character = (unsigned char)*s < 0x20 || *s == 0x7F ? ' ' : *s;
        if (character == '"' || character == '\\') sn_buffer_text(out, "\\");
        sn_buffer_add(out, &character, 1);
    }
    sn_buffer_text(out, "\"");
}

static void write_value(sn_buffer *out, const sn_param *param, double value) {
    char text[SN_NAME_MAX];
    if (isinf(value) && param->infinity)
        snprintf(text, sizeof text, "%s", param->infinity);
    else
        sn_quantity_print(value, param->unit, text);
    sn_buffer_text(out, text);
}

static void write_params(sn_buffer *out, const char *indent, const sn_param *params, int count,
                         int terms, const double *value) {
    for (int k = 0; k < count; k++) {
        const sn_param *param = &params[k];
        int length = sn_param_length(param, terms);
        bool list = param->length == SN_PARAM_LIST || param->length > 1;
        sn_buffer_print(out, "%s%s: %s", indent, param->name, list ? "[" : "");
        for (int i = 0; i < length; i++) {
            if (i > 0) sn_buffer_text(out, ", ");
            write_value(out, param, *value++);
        }
        sn_buffer_text(out, list ? "]\n" : "\n");
    }
}

static void write_memory(sn_buffer *out, const sn_tissue *tissue) {
    int count = !tissue->branched ? 1 : tissue->law->fibre_constant ? 3 : 2;
    const char *indent = tissue->branched ? "      " : "  ";
    sn_buffer_text(out, tissue->branched ? "memory:\n  branch:\n" : "memory:\n");
    for (int k = 0; k < count; k++) {
        const sn_memory *memory = sn_tissue_memory(tissue, (sn_part)k);
        if (tissue->branched) sn_buffer_print(out, "    %s:\n", parts[k]);
        sn_buffer_print(out, "%slaw: %s\n", indent, memory->law->name);
        write_params(out, indent, memory->law->params, memory->law->param_count, memory->terms,
                     memory->value);
    }
}

static void write_comment(sn_buffer *out, const char *comment) {
    while (*comment) {
        size_t length = strcspn(comment, "\n");
        sn_buffer_text(out, length ? "# " : "#");
        for (size_t i = 0; i < length; i++) {
            char character = (unsigned char)comment[i] < 0x20 ? ' ' : comment[i];
            sn_buffer_add(out, &character, 1);
        }
        sn_buffer_text(out, "\n");
        comment += length + (comment[length] == '\n');
    }
}

sn_status sn_tissue_write(const char *path, const sn_tissue *tissue, const char *comment) {
    SN_TRY(sn_tissue_check(tissue));
    sn_buffer out = {0};
    char density[SN_NAME_MAX];
    if (comment) write_comment(&out, comment);
    sn_buffer_text(&out, "tissue: ");
    write_text(&out, *tissue->name ? tissue->name : "unnamed");
    if (*tissue->source) {
        sn_buffer_text(&out, "\nsource: ");
        write_text(&out, tissue->source);
    }
    if (!isnan(tissue->density)) {
        sn_quantity_print(tissue->density, "kg/m3", density);
        sn_buffer_print(&out, "\ndensity: %s", density);
    }
    sn_buffer_print(&out, "\nelastic:\n  law: %s\n", tissue->law->name);
    write_params(&out, "  ", tissue->law->params, tissue->law->param_count, tissue->terms,
                 tissue->value);
    if (tissue->law->kind == SN_LAW_UNIAXIAL && !isnan(tissue->poissons_ratio)) {
        char ratio[SN_NAME_MAX];
        sn_quantity_print(tissue->poissons_ratio, "1", ratio);
        sn_buffer_print(&out, "  poissons_ratio: %s\n", ratio);
    }
    write_memory(&out, tissue);
    sn_status status = out.status == SN_OK ? sn_text_write(path, out.text, out.size) : out.status;
    sn_buffer_free(&out);
    return status;
}
