// Checked access to the tree of a YAML file.
// SPDX-License-Identifier: Apache-2.0
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/text.h"
#include "io/units.h"
#include "io/yaml.h"

#define PATH_MAX_BYTES 256
#define TEXT_MAX_BYTES 512

//---- messages ------------------------------------------------------------------------------------

// "loads[2].displacement[3]" of a value; empty at the root.
static void key_path(const sn_yaml *node, char *out, size_t size) {
    out[0] = 0;
    if (!node->parent) return;
    key_path(node->parent, out, size);
    size_t used = strlen(out);
    if (node->key)
        snprintf(out + used, size - used, "%s%s", used ? "." : "", sn_text_quote(node->key).text);
    else
        snprintf(out + used, size - used, "[%d]", node->index + 1);
}

static sn_status fail_text(const sn_yaml *node, sn_status status, const char *text) {
    char path[PATH_MAX_BYTES];
    key_path(node, path, sizeof path);
    if (!*path) return sn_fail(status, "%s:%d:%d: %s", node->file, node->line, node->column, text);
    return sn_fail(status, "%s:%d:%d: key \"%s\": %s", node->file, node->line, node->column, path,
                   text);
}

sn_status sn_yaml_fail(const sn_yaml *node, sn_status status, const char *format, ...) {
    char text[TEXT_MAX_BYTES];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return fail_text(node, status, text);
}

sn_status sn_yaml_expected(const sn_yaml *node, sn_status status, const char *format, ...) {
    char expected[TEXT_MAX_BYTES], text[TEXT_MAX_BYTES + SN_QUOTE_MAX + 32];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(expected, sizeof expected, format, arguments);
    va_end(arguments);
    if (node->kind == SN_YAML_TEXT && *node->text)
        snprintf(text, sizeof text, "found \"%s\", expected %s", sn_text_quote(node->text).text,
                 expected);
    else
        snprintf(text, sizeof text, "found %s, expected %s",
                 node->kind == SN_YAML_TEXT   ? "nothing"
                 : node->kind == SN_YAML_LIST ? "a list"
                                              : "a map",
                 expected);
    return fail_text(node, status, text);
}

sn_status sn_yaml_within(const sn_yaml *node, sn_status status) {
    if (status == SN_OK) return SN_OK;
    char path[PATH_MAX_BYTES];
    key_path(node, path, sizeof path);
    if (!*path) return sn_fail_within(status, "%s:%d:%d", node->file, node->line, node->column);
    return sn_fail_within(status, "%s:%d:%d: key \"%s\"", node->file, node->line, node->column,
                          path);
}

// "a, b, c" of names, as far as they fit.
static void join_names(const char *const *names, int count, char *out, size_t size) {
    size_t used = 0;
    out[0] = 0;
    for (int k = 0; k < count; k++) {
        if (used + strlen(names[k]) + 8 > size) {
            snprintf(out + used, size - used, ", …");
            return;
        }
        used += (size_t)snprintf(out + used, size - used, "%s%s", k > 0 ? ", " : "", names[k]);
    }
}

//---- maps and lists ------------------------------------------------------------------------------

static sn_status unknown_key(const sn_yaml *value, const char *const *keys, int count) {
    char path[PATH_MAX_BYTES], all[TEXT_MAX_BYTES];
    key_path(value, path, sizeof path);
    const char *near = sn_suggest(value->key, keys, count);
    if (near)
        return sn_fail(SN_E_KEY, "%s:%d:%d: unknown key \"%s\", did you mean \"%s\"?", value->file,
                       value->key_line, value->key_column, path, near);
    join_names(keys, count, all, sizeof all);
    return sn_fail(SN_E_KEY, "%s:%d:%d: unknown key \"%s\", expected one of %s", value->file,
                   value->key_line, value->key_column, path, all);
}

sn_status sn_yaml_map(const sn_yaml *node, const char *const *keys, int count) {
    if (node->kind != SN_YAML_MAP) {
        char all[TEXT_MAX_BYTES];
        join_names(keys, count, all, sizeof all);
        return sn_yaml_expected(node, SN_E_SYNTAX, "a map {…} with keys of %s", all);
    }
    for (const sn_yaml *value = node->first; value; value = value->next) {
        bool known = false;
        for (int k = 0; k < count; k++) known = known || strcmp(keys[k], value->key) == 0;
        if (!known) return unknown_key(value, keys, count);
    }
    return SN_OK;
}

sn_status sn_yaml_list(const sn_yaml *node, const char *what) {
    if (node->kind == SN_YAML_LIST) return SN_OK;
    return sn_yaml_expected(node, SN_E_SYNTAX, "a list […] of %s", what);
}

const sn_yaml *sn_yaml_get(const sn_yaml *map, const char *key) {
    if (map->kind != SN_YAML_MAP) return NULL;
    for (const sn_yaml *value = map->first; value; value = value->next)
        if (strcmp(value->key, key) == 0) return value;
    return NULL;
}

sn_status sn_yaml_need(const sn_yaml *map, const char *key, const sn_yaml **value) {
    *value = sn_yaml_get(map, key);
    if (*value) return SN_OK;
    char path[PATH_MAX_BYTES];
    key_path(map, path, sizeof path);
    return sn_fail(SN_E_KEY, "%s:%d:%d: key \"%s%s%s\" is missing", map->file, map->line,
                   map->column, path, *path ? "." : "", key);
}

//---- scalars -------------------------------------------------------------------------------------

sn_status sn_yaml_text(const sn_yaml *node, const char *what, const char **text) {
    if (node->kind != SN_YAML_TEXT || !*node->text)
        return sn_yaml_expected(node, SN_E_SYNTAX, "%s", what);
    *text = node->text;
    return SN_OK;
}

sn_status sn_yaml_copy(const sn_yaml *node, const char *what, char *out, size_t size) {
    const char *text = NULL;
    SN_TRY(sn_yaml_text(node, what, &text));
    if (strlen(text) >= size)
        return sn_yaml_expected(node, SN_E_RANGE, "%s of at most %zu bytes", what, size - 1);
    strcpy(out, text);
    return SN_OK;
}

sn_status sn_yaml_quantity(const sn_yaml *node, const char *si_unit, double *value) {
    if (node->kind == SN_YAML_TEXT)
        return sn_yaml_within(node, sn_quantity_parse(node->text, si_unit, value));
    char example[SN_NAME_MAX];
    sn_unit_example(si_unit, example);
    return sn_yaml_expected(node, SN_E_SYNTAX, "%s", example);
}

sn_status sn_yaml_quantities(const sn_yaml *node, const char *si_unit, int count, double *values) {
    char example[SN_NAME_MAX];
    sn_unit_example(si_unit, example);
    if (node->kind != SN_YAML_LIST)
        return sn_yaml_expected(node, SN_E_SYNTAX, "a list of %d values, each %s", count, example);
    if (node->count != count)
        return sn_yaml_fail(node, SN_E_SYNTAX, "found a list of %d, expected %d values, each %s",
                            node->count, count, example);
    int k = 0;
    for (const sn_yaml *item = node->first; item; item = item->next)
        SN_TRY(sn_yaml_quantity(item, si_unit, &values[k++]));
    return SN_OK;
}

sn_status sn_yaml_int(const sn_yaml *node, int min, int max, int *value) {
    if (node->kind != SN_YAML_TEXT || !*node->text)
        return sn_yaml_expected(node, SN_E_SYNTAX, "a whole number");
    const char *digits = node->text + (*node->text == '-' || *node->text == '+');
    size_t count = strspn(digits, "0123456789");
    if (count == 0 || digits[count] != 0)
        return sn_yaml_expected(node, SN_E_SYNTAX, "a whole number");
    long long number = count > 18 ? -1 : strtoll(node->text, NULL, 10);
    if (count > 18 || number < min || number > max)
        return sn_yaml_expected(node, SN_E_RANGE, "a whole number from %d to %d", min, max);
    *value = (int)number;
    return SN_OK;
}

sn_status sn_yaml_bool(const sn_yaml *node, bool *value) {
    static const char *const names[] = {"false", "true"};
    int index;
    SN_TRY(sn_yaml_choice(node, names, 2, &index));
    *value = index == 1;
    return SN_OK;
}

sn_status sn_yaml_choice(const sn_yaml *node, const char *const *names, int count, int *index) {
    char all[TEXT_MAX_BYTES];
    join_names(names, count, all, sizeof all);
    if (node->kind != SN_YAML_TEXT || !*node->text)
        return sn_yaml_expected(node, SN_E_SYNTAX, "one of %s", all);
    for (int k = 0; k < count; k++) {
        if (strcmp(names[k], node->text) != 0) continue;
        *index = k;
        return SN_OK;
    }
    const char *near = sn_suggest(node->text, names, count);
    if (near)
        return sn_yaml_expected(node, SN_E_NAME, "one of %s, did you mean \"%s\"?", all, near);
    return sn_yaml_expected(node, SN_E_NAME, "one of %s", all);
}
