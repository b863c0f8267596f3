// What the topics of sinew list share: a topic is a list of sections, a section a table.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

/// Adds a section {name, text, rows} to a list and gives its rows, an array of objects whose keys,
/// in the order they were put, are the columns. `name` and `text` are Nullable.
json_t *list_section(json_t *sections, const char *name, const char *text);

/// Every equation of the source paper: what it is, where it lives, what proves it.
int list_equations(json_t *sections, int count, char **names);
/// Keys of the JSON objects that commands print. names[0] chooses a command; further names are
/// result files, and only the keys found in them are listed. A key that is in no table is refused.
int list_keys(json_t *sections, int count, char **names);
