// A YAML file as a tree in which every value knows its place, and checked access to it.
// SPDX-License-Identifier: Apache-2.0
//
// All functions that return a status store a text "FILE:LINE:COLUMN: key "a.b[2]": found …,
// expected …"; items of a list are counted from 1. A NULL node is never accepted.
#pragma once

#include "sinew/io.h"

typedef enum sn_yaml_kind { SN_YAML_TEXT, SN_YAML_LIST, SN_YAML_MAP } sn_yaml_kind;

/// A value of the file.
typedef struct sn_yaml {
    sn_yaml_kind kind;
    int line, column;             ///< of the value, from 1
    char *text;                   ///< scalars: the text on one line, trimmed; else NULL
    const char *file;             ///< path of the file
    const struct sn_yaml *parent; ///< NULL at the root
    char *key;                    ///< in a map; else NULL
    int key_line, key_column;
    int index; ///< place in the list or map, from 0
    int count; ///< values in this list or map
    struct sn_yaml *first, *last, *next;
} sn_yaml;

/// Reads one document whose root is a map. Refused: more than 64 MiB, more than 2,000,000 values,
/// more than 32 levels, anchors and aliases, tags, duplicate keys, keys that are no text, control
/// characters. @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_KEY, SN_E_DATA, SN_E_MEMORY.
sn_status sn_yaml_read(const char *path, sn_yaml **root);
void sn_yaml_destroy(sn_yaml *root); // NULL is allowed

//---- messages ------------------------------------------------------------------------------------

/// "FILE:L:C: key "k": " and the text.
sn_status sn_yaml_fail(const sn_yaml *node, sn_status status, const char *format, ...)
    SN_PRINTF(3, 4);
/// "FILE:L:C: key "k": found …, expected " and the text.
sn_status sn_yaml_expected(const sn_yaml *node, sn_status status, const char *format, ...)
    SN_PRINTF(3, 4);
/// Puts the place before the text that a called function stored; SN_OK passes.
sn_status sn_yaml_within(const sn_yaml *node, sn_status status);

//---- access --------------------------------------------------------------------------------------

/// Expects a map with keys from `keys` only. @return SN_OK, SN_E_SYNTAX, SN_E_KEY.
sn_status sn_yaml_map(const sn_yaml *node, const char *const *keys, int count);
/// Expects a list. `what` says of what ("supports such as {on: bottom, fix: xyz}").
sn_status sn_yaml_list(const sn_yaml *node, const char *what);
/// The value of a key, NULL where the map has none (or is no map).
const sn_yaml *sn_yaml_get(const sn_yaml *map, const char *key);
/// The value of a key that must be there. @return SN_OK, SN_E_KEY.
sn_status sn_yaml_need(const sn_yaml *map, const char *key, const sn_yaml **value);
/// A text that is not empty; `what` says what is expected ("the name of a surface").
sn_status sn_yaml_text(const sn_yaml *node, const char *what, const char **text);
/// The same copied to `out` of `size` bytes; refuses longer ones.
sn_status sn_yaml_copy(const sn_yaml *node, const char *what, char *out, size_t size);
/// A quantity of the dimension of si_unit, in SI. @return SN_OK, SN_E_SYNTAX, SN_E_UNIT.
sn_status sn_yaml_quantity(const sn_yaml *node, const char *si_unit, double *value);
/// A list of exactly `count` of them.
sn_status sn_yaml_quantities(const sn_yaml *node, const char *si_unit, int count, double *values);
/// A whole number within a range. @return SN_OK, SN_E_SYNTAX, SN_E_RANGE.
sn_status sn_yaml_int(const sn_yaml *node, int min, int max, int *value);
/// true or false.
sn_status sn_yaml_bool(const sn_yaml *node, bool *value);
/// One of `count` words. @return SN_OK, SN_E_SYNTAX, SN_E_NAME with a suggestion.
sn_status sn_yaml_choice(const sn_yaml *node, const char *const *names, int count, int *index);
