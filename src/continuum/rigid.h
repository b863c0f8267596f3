// Rigid motions that the supports leave free, where the loads do not push along them.
// SPDX-License-Identifier: Apache-2.0
//
// A tube under pressure between two frictionless plates may slide and spin; nothing pushes it to.
// The problem is then symmetric under these motions and its solution is unique up to them. As many
// single unknowns as there are motions are left out of the linear system ("pins": no force arises
// there, because the loads are in balance), and every increment is made orthogonal to the motions
// about the present position, so that the body as a whole stays where it was.
#pragma once

#include "continuum/boundary.h"

/// Finds the free motions and chooses their pins: s->free_motion, s->pin.
void sn_fe_rigid_find(sn_fe_space *s);
/// Checks that every part of a body in several parts is held on its own.
/// @return SN_OK, SN_E_DEFINITION, SN_E_MEMORY.
sn_status sn_fe_rigid_parts(const sn_fe_space *s, const sn_mesh *mesh);
/// Checks that no part of the body that shares only nodes or edges with the rest can turn on them;
/// not where more than 32 such parts meet. @return SN_OK, SN_E_DEFINITION, SN_E_MEMORY.
sn_status sn_fe_rigid_hinges(const sn_fe_space *s, const sn_mesh *mesh);
/// Checks that no load pushes along a free motion. @return SN_OK, SN_E_DEFINITION, SN_E_MEMORY.
sn_status sn_fe_rigid_check(const sn_fe_space *s, const sn_case *c, sn_fe_boundary *b);
/// Takes the free motions out of an increment of the state x.
void sn_fe_rigid_project(const sn_fe_space *s, const int *row, const double *x, double *increment);
