// sinew list: the tables that the program itself is made of, as Markdown or JSON.
// SPDX-License-Identifier: Apache-2.0
//
// The manual's pages hold what this command prints (scripts/manual.sh), so they cannot say anything
// else than the program does.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/list.h"

json_t *list_section(json_t *sections, const char *name, const char *text) {
    json_t *section = json_object(), *rows = json_array();
    if (name) cli_put_text(section, "name", name);
    if (text) cli_put_text(section, "text", text);
    cli_put(section, "rows", rows);
    json_array_append_new(sections, section);
    return rows;
}

//---- laws, memories, protocols -------------------------------------------------------------------

static void range_text(const sn_param *p, char text[64]) {
    char low[24] = "", high[24] = "";
    if (isfinite(p->min)) snprintf(low, sizeof low, "%s %.9g", p->min_open ? ">" : "≥", p->min);
    if (isfinite(p->max)) snprintf(high, sizeof high, "%s %.9g", p->max_open ? "<" : "≤", p->max);
    snprintf(text, 64, "%s%s%s%s%s", low, *low && *high ? ", " : "", high,
             p->infinity && (*low || *high) ? ", or " : "", p->infinity ? p->infinity : "");
}

static void length_text(const sn_param *p, char text[32]) {
    if (p->length == SN_PARAM_LIST)
        snprintf(text, 32, "one per term");
    else
        snprintf(text, 32, "%d", p->length > 1 ? p->length : 1);
}

static void add_params(json_t *rows, const sn_param *params, int count) {
    for (int k = 0; k < count; k++) {
        const sn_param *p = &params[k];
        char range[64], length[32];
        json_t *row = json_object();
        range_text(p, range);
        length_text(p, length);
        cli_put_text(row, "key", p->name);
        cli_put_text(row, "symbol", p->symbol);
        cli_put_text(row, "unit", p->unit);
        cli_put_text(row, "values", length);
        cli_put_text(row, "range", range);
        cli_put_number(row, "default", p->init);
        cli_put_text(row, "meaning", p->text);
        json_array_append_new(rows, row);
    }
}

// whether the user chose this name, or none
static bool chosen(int count, char **names, const char *name) {
    return count == 0 || strcmp(names[0], name) == 0;
}

// refuses a choice that no section answered to
static int answered(const json_t *sections, const char *what, int count, char **names,
                    const char *const *known, int known_count) {
    if (count > 1) return cli_refuse("list: one name at most, got %d", count);
    return json_array_size(sections) ? -1 : cli_unknown(what, names[0], known, known_count);
}

#define NAMES_MAX 64

static int list_laws(json_t *sections, int count, char **names) {
    static const char *const kinds[] = {
        [SN_LAW_UNIAXIAL] = "uniaxial", [SN_LAW_SOLID] = "solid", [SN_LAW_MEMBRANE] = "membrane"};
    const char *known[NAMES_MAX];
    int n = sn_law_count();
    SN_ASSERT(n <= NAMES_MAX);
    for (int k = 0; k < n; k++) {
        const sn_law *law = sn_law_at(k);
        char text[1024];
        known[k] = law->name;
        if (!chosen(count, names, law->name)) continue;
        snprintf(text, sizeof text, "%s%s. %s Source: %s.", kinds[law->kind],
                 law->fibres ? ", needs `fibres`" : "", law->text, law->source);
        add_params(list_section(sections, law->name, text), law->params, law->param_count);
    }
    return answered(sections, "law", count, names, known, n);
}

static int list_memories(json_t *sections, int count, char **names) {
    const char *known[NAMES_MAX];
    int n = sn_memory_law_count();
    SN_ASSERT(n <= NAMES_MAX);
    for (int k = 0; k < n; k++) {
        const sn_memory_law *law = sn_memory_law_at(k);
        char text[1024];
        known[k] = law->name;
        if (!chosen(count, names, law->name)) continue;
        snprintf(text, sizeof text, "%s Source: %s.", law->text, law->source);
        add_params(list_section(sections, law->name, text), law->params, law->param_count);
    }
    return answered(sections, "memory", count, names, known, n);
}

static int list_protocols(json_t *sections, int count, char **names) {
    const char *known[NAMES_MAX];
    int n = sn_protocol_count();
    SN_ASSERT(n <= NAMES_MAX);
    for (int k = 0; k < n; k++) {
        int params;
        const sn_param *table = sn_protocol_params((sn_protocol_kind)k, &params);
        known[k] = sn_protocol_name((sn_protocol_kind)k);
        if (!chosen(count, names, known[k])) continue;
        add_params(list_section(sections, known[k], NULL), table, params);
    }
    return answered(sections, "protocol", count, names, known, n);
}

//---- options -------------------------------------------------------------------------------------

static void put_default(json_t *row, const cli_option *option) {
    char text[64] = "";
    if (option->kind == CLI_INTEGER && *(const int *)option->value > 0)
        snprintf(text, sizeof text, "%d", *(const int *)option->value);
    if (option->kind == CLI_QUANTITY && isfinite(*(const double *)option->value))
        snprintf(text, sizeof text, "%.9g", *(const double *)option->value);
    if (option->kind == CLI_TEXT && *(const char *const *)option->value)
        snprintf(text, sizeof text, "%s", *(const char *const *)option->value);
    cli_put_text(row, "default", text);
}

static void add_option(json_t *rows, const cli_option *option) {
    json_t *row = json_object();
    char name[64];
    snprintf(name, sizeof name, "--%s%s%s", option->name, option->argument ? " " : "",
             option->argument ? option->argument : "");
    cli_put_text(row, "option", name);
    cli_put_text(row, "unit", option->unit ? option->unit : "");
    put_default(row, option);
    cli_put_text(row, "meaning", option->text);
    json_array_append_new(rows, row);
}

static void add_options(void *context, const cli_command *command, const cli_option *options,
                        int count) {
    char text[512];
    snprintf(text, sizeof text, "`sinew %s %s`: %s.", command->name, command->usage, command->text);
    json_t *rows = list_section(context, command->name, text);
    for (int k = 0; k < count; k++) add_option(rows, &options[k]);
}

static int list_options(json_t *sections, int count, char **names) {
    const char *known[NAMES_MAX];
    int n = cli_command_count();
    SN_ASSERT(n <= NAMES_MAX);
    for (int k = 0; k < n; k++) {
        const cli_command *command = cli_command_at(k);
        known[k] = command->name;
        if (chosen(count, names, command->name)) cli_visit_options(command, add_options, sections);
    }
    return answered(sections, "command", count, names, known, n);
}

//---- Markdown ------------------------------------------------------------------------------------

static void print_cell(const json_t *value, bool code) {
    if (json_is_number(value)) {
        printf(" %.9g |", json_number_value(value));
        return;
    }
    const char *text = json_is_string(value) ? json_string_value(value) : "";
    code = code && *text;
    printf(code ? " `" : " ");
    for (const char *s = text; *s; s++) printf(*s == '|' ? "\\|" : "%c", *s);
    printf(code ? "` |" : " |");
}

static void print_rows(const json_t *rows) {
    size_t i;
    json_t *row, *value;
    const char *key;
    json_array_foreach(rows, i, row) {
        bool first = true;
        if (i == 0) {
            printf("|");
            json_object_foreach(row, key, value) printf(" %s |", key);
            printf("\n|");
            json_object_foreach(row, key, value) printf("---|");
            printf("\n");
        }
        printf("|");
        json_object_foreach(row, key, value) {
            print_cell(value, first && json_is_string(value));
            first = false;
        }
        printf("\n");
    }
}

static void print_sections(const json_t *sections) {
    size_t i;
    json_t *section;
    json_array_foreach(sections, i, section) {
        const char *name = json_string_value(json_object_get(section, "name"));
        const char *text = json_string_value(json_object_get(section, "text"));
        const json_t *rows = json_object_get(section, "rows");
        if (i > 0) printf("\n");
        if (name) printf("### %s\n\n", name);
        if (text) printf("%s\n", text);
        if (text && json_array_size(rows)) printf("\n");
        if (!text && !json_array_size(rows)) printf("(none)\n");
        print_rows(rows);
    }
}

//---- the command ---------------------------------------------------------------------------------

typedef struct list_topic {
    const char *name;
    int (*list)(json_t *sections, int count, char **names); ///< -1 or an exit code
} list_topic;

static const list_topic topics[] = {
    {"equations", list_equations}, {"options", list_options},   {"keys", list_keys},
    {"laws", list_laws},           {"memories", list_memories}, {"protocols", list_protocols},
};

#define TOPICS ((int)(sizeof topics / sizeof topics[0]))

static int run(const cli_command *command, int argc, char **argv) {
    cli_arguments arguments;
    int code = cli_parse(command, argc, argv, NULL, 0, &arguments);
    if (code >= 0) return code;
    if (arguments.count < 1)
        return cli_refuse("list: what? equations, options, keys, laws, memories or protocols");
    const char *names[TOPICS];
    for (int k = 0; k < TOPICS; k++) {
        names[k] = topics[k].name;
        if (strcmp(arguments.item[0], names[k]) != 0) continue;
        json_t *sections = json_array();
        code = topics[k].list(sections, arguments.count - 1, arguments.item + 1);
        if (code < 0 && arguments.json) {
            json_t *json = json_object();
            cli_put(json, names[k], json_incref(sections));
            cli_print_json(json);
        } else if (code < 0 && !arguments.quiet) {
            print_sections(sections);
        }
        json_decref(sections);
        return code < 0 ? CLI_DONE : code;
    }
    return cli_unknown("topic", arguments.item[0], names, TOPICS);
}

const cli_command cli_lists = {
    "list", "equations|options|keys|laws|memories|protocols [NAME [RESULT.json…]]",
    "tables: equations with their tests, options, JSON keys, laws, memories, protocols",
    "sinew list laws demiray", run};
