// Inside model: the nearest point of a tool's surface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

/// Where a point is against a tool, in the tool's axes.
typedef struct sn_touch {
    double depth;   ///< m, negative outside
    double n[3];    ///< outward unit normal at the nearest point; zero: there is no direction
    double bend[9]; ///< dn/dr, 1/m, symmetric, row-major; infinite where depth is 0 at an edge
} sn_touch;

/// The nearest point of a closed surface of triangles to r.
void sn_tool_surface_near(const sn_tool_surface *surface, const double r[3], sn_touch *touch);
/// A surface that need not be closed, of any triangles: it only knows how far points are from it.
/// @param node  (… x 3)
/// @param face  nodes of each triangle                               (triangles x 3)
/// @return SN_OK, SN_E_MESH (no triangles), SN_E_MEMORY.
sn_status sn_tool_surface_open(int triangles, const int *face, const double *node,
                               sn_tool_surface **surface);
/// Distance of a point from the surface, m.
double sn_tool_surface_distance(const sn_tool_surface *surface, const double r[3]);
/// Corners of the surface, m, in the tool's axes                          (*count x 3).
const double *sn_tool_surface_corners(const sn_tool_surface *surface, int *count);
/// Largest distance of a corner from the origin, m.
double sn_tool_surface_reach(const sn_tool_surface *surface);
/// An equal surface. @return SN_OK, SN_E_MEMORY.
sn_status sn_tool_surface_copy(const sn_tool_surface *surface, sn_tool_surface **copy);
/// The nearest point of any tool to r, in the tool's axes.
void sn_tool_near(const sn_tool *tool, const double r[3], sn_touch *touch);
