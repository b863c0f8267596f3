// The inside of calibration.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/compare.h"

#define SN_CALIBRATION_KINDS 3 ///< of deformation: stretch, compression, shear

#define SN_CALIBRATION_RAYS 108

/// Springs of one direction.
typedef struct sn_calibration_ray {
    double n[3];
    double weight; ///< of k L^2 over the volume, Pa
} sn_calibration_ray;

/// One region as a body of its own, with its springs in c->springs_given.
typedef struct sn_calibration_body {
    int region;  ///< in the whole case
    int *number; ///< node of the body of each node of the whole; -1 elsewhere
    sn_case *c;
    double total; ///< of k L^2 over the volume, Pa, without what is there for nets to relax
    int rays;     ///< 0, or the directions that the springs were fitted to at every node
    sn_calibration_ray ray[SN_CALIBRATION_RAYS];
} sn_calibration_body;

/// What of the law of springs is fitted to finite deformations.
typedef enum sn_calibration_finite_fit {
    SN_CALIBRATION_FIT_NOTHING,
    SN_CALIBRATION_FIT_EXPONENT,
    SN_CALIBRATION_FIT_LAW ///< all, with a factor on the stiffnesses
} sn_calibration_finite_fit;

/// A case with the mesh and the tissues of another, without memory, held by its whole surface:
/// central springs with the volume term, quasi-static, double precision.
sn_status sn_calibration_case(const sn_case *from, sn_case **c);
/// The springs that a central net of a case takes by itself, or has been given.
sn_status sn_calibration_affine(const sn_case *c, sn_spring_set **set);
/// The springs of sn_calibrate() alone: what they err by is not found out, which costs most of it.
sn_status sn_calibration_springs(const sn_case *c, sn_calibration_rule rule,
                                 const sn_output *progress, sn_spring_set **set);
/// Springs of all edges by region and ends, exponents 0; `stiffness` holds the sum over the cells
/// around the edge of the edge length of a regular tetrahedron of their volume, m.
sn_status sn_calibration_edges(const sn_mesh *mesh, sn_spring_set **set);
/// The largest strain that a case comes to, from a quick run of its springs: that below which 95
/// parts in 100 of the body stay at all times, as |stretch - 1|, between 0.02 and 1; 0.3 where the
/// case has no equilibrium.
/// @param share  how much of it is stretch, compression and shear: parts of the squares of strains,
///               at least 0.02; untouched where there is no run
sn_status sn_calibration_strain(const sn_case *c, double *strain,
                                double share[SN_CALIBRATION_KINDS]);

/// Whether matrix and fibres are in one energy: springs then have constants by their direction.
bool sn_calibration_oriented(const sn_tissue *tissue);
/// Edges and second neighbours of a body of one region without exponent, for the tensor of springs
/// K: symmetric in all indices, over the shear modulus.
/// @param left  parts of the third and fourth moments that are not met
sn_status sn_calibration_fit(const sn_mesh *mesh, double K[3][3][3][3], sn_spring_set **set,
                             double left[2]);

/// @return SN_OK, SN_E_MEMORY, SN_E_MESH.
sn_status sn_calibration_body_open(const sn_case *c, int region, sn_calibration_body *body);
void sn_calibration_body_close(sn_calibration_body *body);
/// Takes the springs of its region out of a set of the whole.
sn_status sn_calibration_body_take(sn_calibration_body *body, const sn_spring_set *set);
/// The tensor of springs of all directions that comes closest to the tissue's elasticity, Pa; the
/// springs are left in body->ray.
sn_status sn_calibration_target(sn_calibration_body *body, double K[3][3][3][3]);
/// Gives the springs of a lattice, of shear modulus 1 Pa and isotropic, factors by their direction
/// for the tissue's elasticity. @param left  part of it that they do not give
sn_status sn_calibration_classes(sn_calibration_body *body, double *left);
/// Multiplies the springs of a body by one factor, so that the mean stiffness in the held tests but
/// pressure is the continuum's.
sn_status sn_calibration_scale(sn_calibration_body *body, double *scale);
/// The law of the springs: what is not fitted is taken as it is. Uses region->strain and notes the
/// errors that stay. @param share  weights of stretch, compression and shear
sn_status sn_calibration_finite(sn_calibration_body *body, const double *share,
                                sn_calibration_finite_fit fit, sn_calibration_region *region);
/// The errors at small strain.
sn_status sn_calibration_small(sn_calibration_body *body, sn_calibration_region *region);
/// Appends an error. `format` has one %s.
void sn_calibration_note(sn_calibration_region *region, double error, const char *format,
                         const char *name);
