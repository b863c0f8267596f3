// A disc of triangles, and the cylinder of tetrahedra over it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/model.h"

/// Points on ring r (0 the centre … radial the rim).
int sn_disc_ring(int radial, int around, int r);
/// Points and triangles of the disc. Wide: what int cannot hold is counted right.
double sn_disc_point_count(int radial, int around);
double sn_disc_triangle_count(int radial, int around);
/// Writes points on the unit disc (points x 2), rings from the centre outwards, each from the x
/// axis counter-clockwise; and triangles, counter-clockwise (triangles x 3).
void sn_disc_cut(int radial, int around, double *point, int *triangle);
/// Cuts `layers` layers of prisms over the triangles into tetrahedra (3 a prism), in no particular
/// orientation. Node p of level k is number p + points * k.
void sn_disc_extrude(int points, int triangles, const int *triangle, int layers, bool mirrored,
                     int *cell);
