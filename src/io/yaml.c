// Reads a YAML file into a tree in which every value knows its place.
// SPDX-License-Identifier: Apache-2.0
//
// Built from the events of libyaml. Not libcyaml: it gives no place for a value that is wrong in
// our eyes, names the line before an unknown key, and takes "1.0e3 kPa" for 1000. Not libyaml's
// documents either: they have resolved the aliases, which are refused here, so that a file cannot
// grow while it is read.
#include "io/yaml.h"

#include <string.h>
#include <yaml.h>

#include "io/file.h"
#include "io/text.h"

#define FILE_MAX ((size_t)64 << 20)
#define NODES_MAX 2000000
#define DEPTH_MAX 32
#define KEYS_MAX 1000 // of one map: duplicates are found by comparing all

typedef struct loader {
    yaml_parser_t parser;
    const char *path; ///< the caller's
    int nodes;
} loader;

static sn_status fail_at(const loader *l, yaml_mark_t mark, sn_status status, const char *what) {
    return sn_fail(status, "%s:%zu:%zu: %s", l->path, mark.line + 1, mark.column + 1, what);
}

// libyaml's own complaint in one line.
static sn_status fail_parser(const loader *l) {
    const yaml_parser_t *p = &l->parser;
    if (p->error == YAML_MEMORY_ERROR) return sn_fail(SN_E_MEMORY, "%s: out of memory", l->path);
    const char *problem = p->problem ? p->problem : "not readable";
    if (p->error == YAML_READER_ERROR)
        return sn_fail(SN_E_SYNTAX, "%s: not YAML: %s at byte %zu", l->path, problem,
                       p->problem_offset + 1);
    if (!p->context)
        return sn_fail(SN_E_SYNTAX, "%s:%zu:%zu: not YAML: %s", l->path, p->problem_mark.line + 1,
                       p->problem_mark.column + 1, problem);
    return sn_fail(SN_E_SYNTAX, "%s:%zu:%zu: not YAML: %s (%s from line %zu on)", l->path,
                   p->problem_mark.line + 1, p->problem_mark.column + 1, problem, p->context,
                   p->context_mark.line + 1);
}

static sn_status next_event(loader *l, yaml_event_t *event) {
    return yaml_parser_parse(&l->parser, event) ? SN_OK : fail_parser(l);
}

// The text of a scalar on one line: line ends and tabs become blanks. *text is sn_alloc'd.
static sn_status scalar_text(const loader *l, const yaml_event_t *event, char **text) {
    size_t length = event->data.scalar.length;
    char *copy = sn_alloc(length + 1, 1);
    if (!copy) return SN_E_MEMORY;
    memcpy(copy, event->data.scalar.value, length);
    for (size_t i = 0; i < length; i++) {
        unsigned char byte = (unsigned char)copy[i];
        if (byte == '\n' || byte == '\r' || byte == '\t') {
            copy[i] = ' ';
        } else if (byte < 0x20 || byte == 0x7F) {
            sn_free(copy);
            return fail_at(l, event->start_mark, SN_E_SYNTAX,
                           "a control character in a text, expected plain text");
        }
    }
    char *start = sn_text_trim(copy);
    memmove(copy, start, strlen(start) + 1);
    *text = copy;
    return SN_OK;
}

// Anchors and tags of an event that begins a value.
static sn_status refuse_extras(const loader *l, const yaml_event_t *event) {
    const yaml_char_t *anchor = NULL, *tag = NULL;
    switch (event->type) {
    case YAML_SCALAR_EVENT:
        anchor = event->data.scalar.anchor;
        tag = event->data.scalar.tag;
        break;
    case YAML_SEQUENCE_START_EVENT:
        anchor = event->data.sequence_start.anchor;
        tag = event->data.sequence_start.tag;
        break;
    case YAML_MAPPING_START_EVENT:
        anchor = event->data.mapping_start.anchor;
        tag = event->data.mapping_start.tag;
        break;
    default: break;
    }
    if (anchor || event->type == YAML_ALIAS_EVENT)
        return fail_at(l, event->start_mark, SN_E_SYNTAX,
                       "anchors and aliases (&, *) are not supported, write the values out");
    if (tag)
        return fail_at(l, event->start_mark, SN_E_SYNTAX,
                       "tags (!) are not supported, write the value without");
    return SN_OK;
}

static void free_node(sn_yaml *node) {
    while (node->first) {
        sn_yaml *child = node->first;
        node->first = child->next;
        free_node(child);
    }
    sn_free(node->text);
    sn_free(node->key);
    sn_free(node);
}

static sn_status load(loader *l, const yaml_event_t *event, int depth, sn_yaml *node);

// Adds an empty value to a list or map.
static sn_status add_child(loader *l, yaml_mark_t mark, sn_yaml *parent, sn_yaml **child) {
    if (l->nodes++ == NODES_MAX)
        return fail_at(l, mark, SN_E_DATA, "more than 2000000 values in one file");
    sn_yaml *node = sn_alloc(1, sizeof *node);
    if (!node) return SN_E_MEMORY;
    node->file = parent->file;
    node->parent = parent;
    node->index = parent->count++;
    if (parent->last)
        parent->last->next = node;
    else
        parent->first = node;
    parent->last = node;
    *child = node;
    return SN_OK;
}

static sn_status load_list(loader *l, int depth, sn_yaml *list) {
    for (;;) {
        yaml_event_t event;
        SN_TRY(next_event(l, &event));
        sn_status status = SN_OK;
        bool end = event.type == YAML_SEQUENCE_END_EVENT;
        sn_yaml *child = NULL;
        if (!end) status = add_child(l, event.start_mark, list, &child);
        if (!end && status == SN_OK) status = load(l, &event, depth, child);
        yaml_event_delete(&event);
        if (end || status != SN_OK) return status;
    }
}

// The key of a map's next value, into a new child.
static sn_status load_key(loader *l, const yaml_event_t *event, sn_yaml *map, sn_yaml **child) {
    SN_TRY(refuse_extras(l, event));
    if (event->type != YAML_SCALAR_EVENT)
        return fail_at(l, event->start_mark, SN_E_SYNTAX,
                       "a key is a list or a map, expected a name such as \"law:\"");
    if (map->count == KEYS_MAX)
        return fail_at(l, event->start_mark, SN_E_DATA, "more than 1000 keys in one map");
    sn_yaml *node = NULL;
    SN_TRY(add_child(l, event->start_mark, map, &node));
    node->key_line = node->line = (int)event->start_mark.line + 1;
    node->key_column = node->column = (int)event->start_mark.column + 1;
    SN_TRY(scalar_text(l, event, &node->key));
    for (const sn_yaml *other = map->first; other != node; other = other->next)
        if (strcmp(other->key, node->key) == 0)
            return sn_fail(SN_E_KEY, "%s:%d:%d: key \"%s\" is given twice, first in line %d",
                           l->path, node->line, node->column, sn_text_quote(node->key).text,
                           other->key_line);
    *child = node;
    return SN_OK;
}

static sn_status load_map(loader *l, int depth, sn_yaml *map) {
    for (;;) {
        yaml_event_t event;
        sn_yaml *child = NULL;
        SN_TRY(next_event(l, &event));
        bool end = event.type == YAML_MAPPING_END_EVENT;
        sn_status status = end ? SN_OK : load_key(l, &event, map, &child);
        yaml_event_delete(&event);
        if (end || status != SN_OK) return status;
        SN_TRY(next_event(l, &event));
        status = load(l, &event, depth, child);
        yaml_event_delete(&event);
        SN_TRY(status);
    }
}

// The value that begins with an event.
static sn_status load(loader *l, const yaml_event_t *event, int depth, sn_yaml *node) {
    node->line = (int)event->start_mark.line + 1;
    node->column = (int)event->start_mark.column + 1;
    SN_TRY(refuse_extras(l, event));
    if (depth == DEPTH_MAX)
        return fail_at(l, event->start_mark, SN_E_SYNTAX, "more than 32 levels of lists and maps");
    switch (event->type) {
    case YAML_SEQUENCE_START_EVENT: node->kind = SN_YAML_LIST; return load_list(l, depth + 1, node);
    case YAML_MAPPING_START_EVENT: node->kind = SN_YAML_MAP; return load_map(l, depth + 1, node);
    default: node->kind = SN_YAML_TEXT; return scalar_text(l, event, &node->text);
    }
}

// Moves on to an event of the type; SN_E_DATA where another one comes.
static sn_status expect_event(loader *l, yaml_event_type_t type, const char *otherwise) {
    yaml_event_t event;
    SN_TRY(next_event(l, &event));
    sn_status status =
        event.type == type ? SN_OK : fail_at(l, event.start_mark, SN_E_DATA, otherwise);
    yaml_event_delete(&event);
    return status;
}

static sn_status load_document(loader *l, sn_yaml *root) {
    SN_TRY(expect_event(l, YAML_STREAM_START_EVENT, "not YAML"));
    SN_TRY(expect_event(l, YAML_DOCUMENT_START_EVENT, "the file is empty, expected keys"));
    yaml_event_t event;
    SN_TRY(next_event(l, &event));
    sn_status status = event.type == YAML_MAPPING_START_EVENT || event.type == YAML_ALIAS_EVENT
                           ? load(l, &event, 0, root)
                           : fail_at(l, event.start_mark, SN_E_SYNTAX,
                                     "not a map, expected keys such as \"key: value\"");
    yaml_event_delete(&event);
    SN_TRY(status);
    SN_TRY(expect_event(l, YAML_DOCUMENT_END_EVENT, "not YAML"));
    return expect_event(l, YAML_STREAM_END_EVENT,
                        "a second document begins, expected one document in a file");
}

sn_status sn_yaml_read(const char *path, sn_yaml **root) {
    *root = NULL;
    char *text;
    size_t bytes;
    SN_TRY(sn_file_read(path, FILE_MAX, &text, &bytes));
    // root and the path that all nodes point to are one block
    size_t length = strlen(path);
    sn_yaml *node = sn_alloc(1, sizeof *node + length + 1);
    loader l = {.path = path};
    if (!node || !yaml_parser_initialize(&l.parser)) {
        sn_free(node);
        sn_free(text);
        return sn_fail(SN_E_MEMORY, "%s: out of memory", path);
    }
    char *own_path = (char *)(node + 1);
    memcpy(own_path, path, length + 1);
    node->file = own_path;
    yaml_parser_set_input_string(&l.parser, (const unsigned char *)text, bytes);
    sn_status status = load_document(&l, node);
    yaml_parser_delete(&l.parser);
    sn_free(text);
    if (status != SN_OK)
        free_node(node);
    else
        *root = node;
    return status;
}

void sn_yaml_destroy(sn_yaml *root) {
    if (root) free_node(root);
}
