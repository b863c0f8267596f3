// The parts of a case file: one function a key, each fills its part of the case.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/yaml.h"

/// `mesh`: a built-in shape, or a file relative to the case file.
sn_status sn_case_read_mesh(const sn_yaml *node, sn_case *c);
/// `tissue`: one file, or a file for every region of the mesh.
sn_status sn_case_read_tissues(const sn_yaml *node, sn_case *c);
/// `supports`, `loads`, `tools`, `probes`: lists; the mesh is there already.
sn_status sn_case_read_supports(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_loads(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_tools(const sn_yaml *node, sn_case *c);
sn_status sn_case_read_probes(const sn_yaml *node, sn_case *c);
/// `springs` and `continuum`: what is not given keeps its default.
sn_status sn_case_read_springs(const sn_yaml *node, sn_springs_def *def);
sn_status sn_case_read_continuum(const sn_yaml *node, sn_continuum_def *def);
