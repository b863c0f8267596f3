// The parts of a case file: one function a key, each fills its part of the case.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/yaml.h"

/// `mesh`: a built-in shape, or a file relative to the case file.
sn_status sn_case_read_mesh(const sn_yaml *node, sn_case *c);
/// `tissue`: one file, or a file for every region of the mesh.
sn_status sn_case_read_tissues(const sn_yaml *node, sn_case *c);
/// `fibres`; the mesh is there already.
sn_status sn_case_read_fibres(const sn_yaml *node, sn_case *c);
/// `supports`, `loads`, `tools`, `probes`, `cuts`: lists; the mesh is there already.
sn_status sn_case_read_supports(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_loads(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_tools(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_probes(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_cuts(const sn_yaml *node, sn_case *c);
/// A list of supports, loads, tools or probes, and room for them, `size` bytes each.
sn_status sn_case_read_items(const sn_yaml *node, const char *what, size_t size, void **items);
/// [[time, value…], …] with `channels` values of one unit after each time.
sn_status sn_case_read_table(const sn_yaml *node, int channels, const char *si_unit,
                             const char *example, sn_history **history);
/// `name` of a map: it heads columns of the history, so it is short, plain, and not given before.
sn_status sn_case_read_name(const sn_yaml *map, const sn_case *c, char name[SN_NAME_MAX]);
/// A path that stands in a file, relative to the folder of that file. *joined is sn_alloc'd.
sn_status sn_case_join_path(const sn_yaml *node, const char *name, char **joined);
/// `unit` of a map with `file`: metres per unit; 1 where there is none.
sn_status sn_case_read_unit(const sn_yaml *map, double *factor);
/// `springs` and `continuum`: what is not given keeps its default.
sn_status sn_case_read_springs(const sn_yaml *node, sn_springs_def *def);
sn_status sn_case_read_continuum(const sn_yaml *node, sn_continuum_def *def);
