// A case without a solver: mesh, regions, surfaces, fibres, supports, loads, tools, time programme.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/tissue.h"

#ifdef __cplusplus
extern "C" {
#endif

//---- mesh ---------------------------------------------------------------------------------------

/// A named set of boundary triangles, outward normals by the right-hand rule.
typedef struct sn_surface {
    char name[SN_NAME_MAX];
    int face_count;
    int *face; ///< nodes of each triangle                     (face_count x 3)
    int *cell; ///< the tetrahedron behind each triangle       (face_count)
} sn_surface;

/// A mesh of linear tetrahedra, metres. Arrays come from sn_alloc(); sn_mesh_destroy() frees them.
typedef struct sn_mesh {
    int node_count;
    double *node; ///< rest positions                          (node_count x 3)
    int cell_count;
    int *cell;   ///< nodes, positive volume                   (cell_count x 4)
    int *region; ///< region of each cell                      (cell_count)
    int region_count;
    char (*region_name)[SN_NAME_MAX]; ///<                     (region_count)
    int surface_count;
    sn_surface *surface; ///<                                  (surface_count)
    int split_cells;     ///< hexahedra, prisms and pyramids of a file that were cut into tetrahedra
} sn_mesh;

/// How a block of rectangular cells is cut into tetrahedra.
typedef enum sn_pattern {
    SN_PATTERN_MIRRORED, ///< six Kuhn tetrahedra a cell, neighbouring cells reflect each other
    SN_PATTERN_BCC,      ///< body-centred lattice
    SN_PATTERN_KUHN      ///< six Kuhn tetrahedra, one cut repeated
} sn_pattern;

/// What the built-in shapes take.
typedef enum sn_shape {
    SN_SHAPE_BLOCK,
    SN_SHAPE_CYLINDER,
    SN_SHAPE_TUBE,
    SN_SHAPE_ELLIPSOID
} sn_shape;
typedef struct sn_shape_def {
    sn_shape shape;
    sn_pattern pattern;
    double size[3];                    ///< block: edge lengths, m
    double radius;                     ///< cylinder, m
    double inner_radius, outer_radius; ///< tube, m
    double length;                     ///< cylinder and tube, m, along z from 0
    double inner[2], outer[2];         ///< ellipsoid: half axes of its walls, short and long, m
    double base;                       ///< ellipsoid: z of the cut, m
    int cells[3];      ///< block: along x y z; cylinder and tube: radial, around, along; ellipsoid:
                       ///< through, around, along
    double ratio;      ///< block: longest over shortest cell along each edge; 0 or 1: even
    double towards[3]; ///< block with a ratio: point of the block around which cells are short, m
} sn_shape_def;

/// Most tetrahedra a mesh may have (32-bit indices, and memory).
#define SN_CELLS_MAX 50000000

/// Builds a built-in shape with its surfaces: block left right front back bottom top
/// (-x +x -y +y -z +z) from the origin; tube inner outer bottom top; cylinder outer bottom top; all
/// with "boundary" as the last; ellipsoid (about z, open at z = base, its apex at -z) inner outer
/// base. One region, "body". Tube and cylinder have a node on the x axis of
/// every ring. Cylinder: rings of 6, 12, 18, … points until `around` is reached (of evenly growing
/// counts where around > 6 radial); it has no bcc pattern. Ellipsoid: a disc of such rings, `along`
/// of them, bent over the wall.
/// @return SN_OK, SN_E_RANGE (sizes, counts, more than SN_CELLS_MAX), SN_E_UNSUPPORTED, SN_E_MESH
/// (cells too thin), SN_E_MEMORY.
SN_API sn_status sn_mesh_build(const sn_shape_def *def, sn_mesh **mesh);
/// A mesh of zeros with room for so many things (surfaces still without faces): for readers.
SN_API sn_status sn_mesh_create(int node_count, int cell_count, int region_count, int surface_count,
                                sn_mesh **mesh);
SN_API void sn_mesh_destroy(sn_mesh *mesh); // NULL is allowed
/// Checks indices, finite coordinates, unused nodes, flat cells; turns inverted cells round; finds
/// the cell behind every surface face and orients the face outwards. Adds the surface "boundary"
/// (all outer faces). Readers call it last. A face inside the body keeps its direction and gets the
/// cell for which that is outwards. `cell` of a surface may be NULL before.
/// @return SN_OK, SN_E_MESH, SN_E_MEMORY.
SN_API sn_status sn_mesh_finish(sn_mesh *mesh);
/// Splits every tetrahedron into eight, keeping regions and surfaces. @return SN_OK, SN_E_MEMORY,
/// SN_E_RANGE (more than SN_CELLS_MAX).
SN_API sn_status sn_mesh_refine(const sn_mesh *mesh, sn_mesh **fine);
/// An equal mesh. @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_mesh_copy(const sn_mesh *mesh, sn_mesh **copy);
/// The mesh without some of its cells, and without nodes that then belong to none. Regions and
/// surfaces stay, with the faces whose cell is there; "boundary" is the new outside.
/// @param removed  cells to leave out                         (cell_count)
/// @param node     Nullable: number in `mesh` of each node that is left; room for all of `mesh`
/// @return SN_OK, SN_E_MESH (no cell is left), SN_E_MEMORY.
SN_API sn_status sn_mesh_without(const sn_mesh *mesh, const bool *removed, sn_mesh **rest,
                                 int *node);
/// Index of a surface by name; -1 with a text (and a suggestion) stored when there is none.
SN_API int sn_mesh_surface(const sn_mesh *mesh, const char *name);
/// Nodes of a surface, each once, rising. *nodes is sn_alloc'd for the caller.
SN_API sn_status sn_mesh_surface_nodes(const sn_mesh *mesh, int surface, int **nodes, int *count);
/// Unique edges, ends rising, sorted. *edges (count x 2) is sn_alloc'd for the caller.
SN_API sn_status sn_mesh_edges(const sn_mesh *mesh, int **edges, int *count);
/// Signed volume of a cell, m3.
SN_API double sn_mesh_cell_volume(const sn_mesh *mesh, int cell);
/// Area of a surface at rest, m2.
SN_API double sn_mesh_area(const sn_mesh *mesh, int surface);
/// Volume of the body, m3.
SN_API double sn_mesh_volume(const sn_mesh *mesh);

//---- supports, loads, tools, probes --------------------------------------------------------------

typedef struct sn_support {
    int surface;
    bool fix[3];
} sn_support;

typedef enum sn_load_kind {
    SN_LOAD_DISPLACEMENT, ///< prescribed motion of the nodes of a surface
    SN_LOAD_TRACTION,     ///< force over original area, fixed direction
    SN_LOAD_PRESSURE,     ///< follower pressure on the deformed surface, positive pushes inwards
    SN_LOAD_FORCE         ///< force at a material point, fixed direction
} sn_load_kind;

typedef struct sn_load {
    sn_load_kind kind;
    int surface;        ///< not of a force
    double point[3];    ///< force: where it acts at rest, m
    double vector[3];   ///< displacement [m], traction [Pa] or force [N]
    bool free[3];       ///< displacement: this component is not prescribed
    double pressure;    ///< Pa
    sn_history *factor; ///< Nullable (constant 1), owned; one channel
} sn_load;

typedef enum sn_tool_kind {
    SN_TOOL_SPHERE,
    SN_TOOL_CAPSULE, ///< all points within a radius of a straight axis
    SN_TOOL_PLANE,   ///< a half space
    SN_TOOL_MESH     ///< the inside of a closed surface of triangles
} sn_tool_kind;

/// A closed surface of triangles with a tree of boxes to find its nearest point.
typedef struct sn_tool_surface sn_tool_surface;

/// A rigid body that moves as told and pushes the tissue. Its shape is given in its own axes, with
/// the origin at its centre.
typedef struct sn_tool {
    char name[SN_NAME_MAX];
    sn_tool_kind kind;
    double radius;  ///< sphere and capsule, m
    double axis[3]; ///< capsule: from the centre of one end to that of the other, m; plane: its
                    ///< outward normal, any length
    sn_tool_surface *surface; ///< mesh, owned
    double at[3]; ///< centre at rest, m: of the sphere, of the capsule's first end, a point of the
                  ///< plane, the origin of the mesh
    sn_history *path; ///< Nullable, owned; displacement of the centre, three channels, m
    sn_history *turn; ///< Nullable, owned; rotation vector about the centre, three channels, rad
    double friction;  ///< Coulomb coefficient
    double grasp[2];  ///< nodes that touch at the first time are held until the second, s; equal:
                      ///< never
} sn_tool;

/// Where a rigid body is: a point x of its own axes stands at centre + turn x.
typedef struct sn_pose {
    double centre[3]; ///< m
    double turn[9];   ///< rotation, row-major 3 x 3
} sn_pose;

typedef enum sn_probe_kind { SN_PROBE_POINT, SN_PROBE_REACTION } sn_probe_kind;
typedef struct sn_probe {
    char name[SN_NAME_MAX];
    sn_probe_kind kind;
    double point[3]; ///< material point, m
    int surface;     ///< reaction: force that the support or prescribed motion exerts on the body
} sn_probe;

//---- cuts ----------------------------------------------------------------------------------------

typedef enum sn_cut_kind {
    SN_CUT_SPHERE, ///< cells whose centre is in a sphere
    SN_CUT_BOX,    ///< cells whose centre is in a box along the axes
    SN_CUT_CELLS   ///< cells by number
} sn_cut_kind;

/// Cells that are taken out of the body during a run: by where they are at rest.
typedef struct sn_cut_def {
    double at; ///< when, s; 0: before the first step
    sn_cut_kind kind;
    double centre[3], radius; ///< sphere, m
    double low[3], high[3];   ///< box, m
    int cell_count;           ///< cells
    int *cell;                ///< numbers in the mesh, from 0, owned (cell_count)
} sn_cut_def;

//---- settings of the engines ---------------------------------------------------------------------

typedef enum sn_rung { SN_RUNG_CENTRAL, SN_RUNG_COUPLED, SN_RUNG_SMOOTHED } sn_rung;
typedef enum sn_integrator {
    SN_INTEGRATOR_EXPLICIT,
    SN_INTEGRATOR_IMPLICIT,
    SN_INTEGRATOR_QUASI_STATIC
} sn_integrator;
/// Of the implicit integrator.
typedef enum sn_scheme {
    SN_SCHEME_BDF2,          ///< second order, little damping of its own
    SN_SCHEME_BACKWARD_EULER ///< first order, damps what is fast against the step
} sn_scheme;
typedef enum sn_precision { SN_SINGLE, SN_DOUBLE } sn_precision;

typedef struct sn_springs_def {
    sn_rung rung;
    bool volume; ///< nodal volume energy
    sn_integrator integrator;
    sn_scheme scheme; ///< implicit
    double step; ///< seconds; 0 chooses: explicit from the highest frequency, implicit from the
                 ///< time a shear wave takes across the body, quasi-static from output_every
    sn_precision precision; ///< of the explicit integrator; the others run in double
    int threads;
    double damping; ///< mass-proportional Rayleigh coefficient, 1/s, on motion relative to
                    ///< the rigid motion of the body
    double stiffness_damping; ///< stiffness-proportional Rayleigh coefficient, s: a stress of this
                              ///< times the rate of the instantaneous elastic stress
    double tolerance; ///< quasi-static, implicit: relative residual at which Newton stops; 0: 1e-10
                      ///< and 1e-8
    double memory_tolerance; ///< largest error of the exponentials, of G(0)
    bool cuttable; ///< a program may remove cells (sn_state_cut); with cuts in the case it may
} sn_springs_def;

typedef enum sn_element { SN_ELEMENT_P1, SN_ELEMENT_P2, SN_ELEMENT_P2P1 } sn_element;
typedef enum sn_analysis {
    SN_ANALYSIS_QUASI_STATIC,
    SN_ANALYSIS_DYNAMIC, ///< with inertia, from rest
    SN_ANALYSIS_LINEAR   ///< small strain: the tangent at rest, one linear system
} sn_analysis;

typedef enum sn_solver {
    SN_SOLVER_DIRECT,   ///< MUMPS
    SN_SOLVER_ITERATIVE ///< Krylov with multigrid: less memory, for large bodies and many ranks
} sn_solver;

typedef struct sn_continuum_def {
    sn_element element;
    sn_analysis analysis;
    int steps;               ///< least number of steps over the case; cut back where needed
    double step;             ///< longest step, s; 0: until / steps
    double step_tolerance;   ///< dynamic: estimated error of one step, of the largest displacement
                             ///< so far (rms), that chooses its length; 0: all as long as they may
    double rho_infinity;     ///< dynamic: spectral radius at infinite frequency, 0 to 1
    double tolerance;        ///< relative residual at which Newton stops
    double memory_tolerance; ///< largest error of the exponentials, of G(0)
    sn_solver solver;        ///< of linear systems
} sn_continuum_def;

#define SN_STEP_TOLERANCE 1e-4 ///< what a case file takes for `step: auto`

SN_API sn_springs_def sn_springs_def_default(void);
SN_API sn_continuum_def sn_continuum_def_default(void);

//---- fibres --------------------------------------------------------------------------------------

/// How the axes of the material run through the body.
typedef enum sn_fibre_rule {
    SN_FIBRES_ALIKE,  ///< one direction in all cells: sn_case.fibre
    SN_FIBRES_AROUND, ///< in the wall around an axis, at an angle
    SN_FIBRES_LISTED  ///< given cell by cell
} sn_fibre_rule;

/// The rule is kept in the case, so that it holds on any mesh: see sn_case_axes_field(). Around an
/// axis, with n the normal of the wall, c the direction around the axis and l = n x c along the
/// wall, the fibre is cos(angle) c + sin(angle) l.
typedef struct sn_fibres {
    sn_fibre_rule rule;
    double sheet[3];   ///< alike: the second axis, made orthogonal to the fibre; zero: chosen
    double axis[3];    ///< around: direction of the axis, any length
    double through[3]; ///< around: a point of the axis, m
    double angle[2]; ///< around: at the inner and the outer wall, linear in the depth between, rad
    int wall[2];     ///< around: surfaces of the inner and the outer wall, for depth and normal;
                     ///< both -1: the normal points away from the axis, the angle is the same
    bool sheet_normal; ///< around: the second axis is n, else it is in the wall, across the fibre
    int count;         ///< listed: the mesh's cells
    double *listed;    ///< listed: fibre and second axis (zero: chosen), any length, owned
                       ///<                                                      (count x 6)
} sn_fibres;

//---- springs given one by one --------------------------------------------------------------------

/// Springs of a central net in place of those that follow from the tissue's moduli, as
/// sn_calibrate() finds them. Arrays come from sn_alloc(); sn_spring_set_destroy() frees them.
/// With x = stretch - 1 and n its direction at rest the force of a spring, over stiffness and rest
/// length, is
///     (exp(B x) - 1) / B + x (exp(n.C n x^2) - 1)         in tension,
///     (lambda - 1/lambda^2) / 3 + x (exp(c x^2) - 1)      in compression,
/// with no more than 60 in the exponents of squares.
#define SN_SPRING_SQUARES 7 ///< C: xx yy zz xy yz zx, then c

typedef struct sn_spring_set {
    int count, region_count;
    int *end;          ///< nodes of the mesh, both of the region; no edge is needed (count x 2)
    int *region;       ///< of the mesh                            (count)
    double *stiffness; ///< N/m at small strain, 0 or more         (count)
    double *exponent;  ///< B of the law of the springs            (region_count)
    double *square;    ///< C and c of it, 0 or more in every direction
                       ///<                   (region_count x SN_SPRING_SQUARES)
    double *bulk;      ///< of the nodal volume energy, Pa; NAN: what the springs, stretched evenly,
                       ///< lack of the tissue's bulk modulus      (region_count)
} sn_spring_set;

/// A set of zeros with room for so many, `bulk` NAN. @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_spring_set_create(int count, int region_count, sn_spring_set **set);
SN_API void sn_spring_set_destroy(sn_spring_set *set); // NULL is allowed
/// An equal set; NULL of NULL. @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_spring_set_copy(const sn_spring_set *set, sn_spring_set **copy);
/// Checks that a set fits a mesh; messages count springs from 0.
/// @return SN_OK, SN_E_DEFINITION (nodes, regions), SN_E_RANGE (stiffness, exponent, bulk),
/// SN_E_MEMORY.
SN_API sn_status sn_spring_set_check(const sn_spring_set *set, const sn_mesh *mesh);

//---- case ----------------------------------------------------------------------------------------

/// Everything a solver needs to know. Owns all it points to.
typedef struct sn_case {
    char name[SN_TEXT_MAX];
    sn_mesh *mesh;
    sn_shape_def shape; ///< how the mesh was built, where has_shape
    bool has_shape;
    sn_tissue *tissue; ///<                                    (mesh->region_count)
    double fibre[3];   ///< direction in every cell, unit length; zero where none is given
    sn_fibres fibres;  ///< second axis, or the rule of fibres that turn from cell to cell
    double gravity[3]; ///< m/s2
    int support_count, load_count, tool_count, probe_count;
    sn_support *support;
    sn_load *load;
    sn_tool *tool;
    sn_probe *probe;
    int cut_count;
    sn_cut_def *cut;     ///< in any order of times
    double until;        ///< seconds
    double output_every; ///< seconds
    sn_springs_def springs;
    sn_continuum_def continuum;
    sn_spring_set *springs_given; ///< Nullable, owned: of the rung central; others do not look
} sn_case;

/// An empty case with default settings.
SN_API sn_status sn_case_create(sn_case **c);
SN_API void sn_case_destroy(sn_case *c); // NULL is allowed
/// The same case on another mesh with the same surfaces and regions (by index). Takes the mesh
/// unless it fails. Everything else is copied, so both may be destroyed; has_shape stays where the
/// mesh has as many nodes and cells as before, else it is cleared. Cuts by a region take the cells
/// that the region has on the new mesh. Listed fibres go from the cell that holds the middle of the
/// new one (or is nearest to it). Springs given one by one stay where the mesh has the same nodes
/// and cells, else they are left away.
/// @return SN_OK, SN_E_DEFINITION (regions or surfaces differ; cuts of numbered cells on a mesh
/// with another number of cells), SN_E_MEMORY.
SN_API sn_status sn_case_on_mesh(const sn_case *c, sn_mesh *mesh, sn_case **copy);
/// Checks what no reader of one key can see: tissues in range and fit for three dimensions, a fibre
/// where a law needs one, probes inside the body, loads and supports that contradict each other,
/// tools that start inside, times. @return SN_OK, SN_E_DEFINITION, SN_E_RANGE.
SN_API sn_status sn_case_check(const sn_case *c);
/// Tells cases apart by all that a state of an engine depends on: mesh, tissues, fibre, gravity,
/// supports, loads, tools, probes; not times of output and settings of engines.
SN_API uint64_t sn_case_fingerprint(const sn_case *c);

/// What is prescribed at each node at time t, from supports and displacement loads. Where both hold
/// a node in one direction they must say the same; sn_case_check() refuses what contradicts.
/// @param fixed  one bit a direction (1 x, 2 y, 4 z)          (node_count)
/// @param value  displacement of fixed directions, m          (node_count x 3), others untouched
SN_API void sn_case_prescribed(const sn_case *c, double t, unsigned char *fixed, double *value);
/// Which rigid motions the supports and prescribed motions leave free, as text for a message, such
/// as "translation along z, rotation about x"; empty when none.
SN_API void sn_case_free_motions(const sn_case *c, char text[SN_TEXT_MAX]);
/// The surface whose prescribed motion is all that acts on the body, so that at rest it would only
/// be carried along undeformed (as a rule, the supports were forgotten); -1 when there is more.
SN_API int sn_case_carried_by(const sn_case *c);
/// The cells of cut k of a case, rising. *cells is sn_alloc'd for the caller.
/// @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_case_cut_cells(const sn_case *c, int k, int **cells, int *count);
/// Names of the history columns of the case in the order engines fill them: time, then for a point
/// probe NAME_ux NAME_uy NAME_uz [m], for a reaction or a tool NAME_fx NAME_fy NAME_fz [N].
SN_API sn_status sn_case_history_columns(const sn_case *c, sn_record *history);
/// Material axes: rotation whose first row is the fibre (identity where there is none); the second
/// is the sheet, or else the coordinate axis that follows the fibre's largest component, made
/// orthogonal. Of fibres that are alike.
SN_API void sn_case_axes(const sn_case *c, double axes[9]);
/// Material axes of every cell. Where they are the same in all cells whose law has fibres, *field
/// is NULL and `axes` holds them; else *field is sn_alloc'd for the caller, the identity in the
/// other cells, and `axes` is the identity. No law with fibres: NULL and the identity.
/// @param field  rotations as of sn_case_axes()                     (*field: cells x 9)
/// @return SN_OK, SN_E_DEFINITION (a cell on the axis, walls that touch), SN_E_MEMORY.
SN_API sn_status sn_case_axes_field(const sn_case *c, double axes[9], double **field);
/// Where a material point is: cell and barycentric weights. Points up to 1e-6 of the body's size
/// outside are taken to the nearest cell. @return SN_OK, SN_E_DEFINITION (outside).
SN_API sn_status sn_mesh_locate(const sn_mesh *mesh, const double point[3], int *cell,
                                double weight[4]);

//---- tools ---------------------------------------------------------------------------------------

/// A surface from triangles with outward normals by the right-hand rule, metres. Corners at equal
/// places are one.
/// @param corner  three corners of each triangle                    (triangles x 3 x 3)
/// @return SN_OK, SN_E_MESH (not closed, inside out, no triangle with an area), SN_E_MEMORY.
SN_API sn_status sn_tool_surface_create(int triangles, const double *corner,
                                        sn_tool_surface **surface);
SN_API void sn_tool_surface_destroy(sn_tool_surface *surface); // NULL is allowed
/// A copy with its own path, turn and surface. @return SN_OK, SN_E_MEMORY.
SN_API sn_status sn_tool_copy(const sn_tool *tool, sn_tool *copy);
/// Frees what a tool owns.
SN_API void sn_tool_release(sn_tool *tool);

/// A pose without rotation.
SN_API sn_pose sn_pose_at(const double centre[3]);
/// The rotation about `vector` by its length in radians, row-major. Source: Rodrigues' formula.
SN_API void sn_rotation(const double vector[3], double turn[9]);
/// Where a tool is at time t, by its path and turn.
SN_API void sn_tool_pose(const sn_tool *tool, double t, sn_pose *pose);
/// How far the tool reaches from its centre, m; INFINITY for a plane.
SN_API double sn_tool_reach(const sn_tool *tool);
/// How deep a point is in the tool, m, negative outside. `normal` (Nullable) is the outward normal
/// of the tool at the nearest point of its surface, in space; zero where there is no such
/// direction.
SN_API double sn_tool_depth(const sn_tool *tool, const sn_pose *pose, const double position[3],
                            double normal[3]);

//---- contact with tools --------------------------------------------------------------------------

/// Memory of one contact point: where it sticks, in the tool's axes.
typedef struct sn_contact {
    bool touching;
    double anchor[3];
} sn_contact;

/// Penalty contact of a surface point with a tool: normal force stiffness * depth outwards, and
/// Coulomb friction by an elastic stick and a slip (return mapping). Both engines use it.
/// @param stiffness  N/m: penalty per area times the area of the point
/// @param before     memory at the start of the step; *after gets the memory at its end
/// @param force      on the tissue, N
/// @param tangent    -d force/d position, row-major 3 x 3, unsymmetric with friction; Nullable
/// @return true when the point touches.
SN_API bool sn_tool_contact(const sn_tool *tool, const sn_pose *pose, const double position[3],
                            double stiffness, const sn_contact *before, sn_contact *after,
                            double force[3], double tangent[9]);
/// Penalty per area, Pa/m, that both engines use for a case: keeps the depth small against the
/// cells without ruling the explicit step: 2 (K' + 4/3 shear) / h, K' = min(bulk, 20 shear), h the
/// mean edge of the boundary faces.
SN_API double sn_case_penalty(const sn_case *c);

//---- runs ----------------------------------------------------------------------------------------

/// What a run hands out while it goes on.
typedef struct sn_output {
    void *context;
    /// Nullable: called at time 0 and then every output_every; an error stops the run.
    sn_status (*frame)(void *context, const sn_frame *frame);
    /// Nullable: called now and then; done in 0 … 1.
    void (*progress)(void *context, double done, const char *text);
    /// Nullable: gets a row at every output (springs only), columns "time", "kinetic_energy",
    /// "elastic_energy", "memory_energy", "dissipated_energy", "external_work" and
    /// "energy_residual" (J, not relative).
    sn_record *energy;
} sn_output;

/// Numbers of a run, for summary.json.
typedef struct sn_run_summary {
    char engine[SN_NAME_MAX]; ///< "springs" or "continuum"
    char model[SN_NAME_MAX];  ///< "coupled+volume", "P2P1", …
    int nodes, cells, springs;
    int unknowns;
    double step_s; ///< smallest step used
    long steps;
    double simulated_s, wall_s;
    double real_time_factor;                                  ///< simulated_s / wall_s
    double step_wall_p50_s, step_wall_p99_s, step_wall_max_s; ///< wall time of one step
    double kinetic_J;
    double elastic_J; ///< springs: of the equilibrium part of the law, g_inf (W + U); continuum: of
                      ///< the instantaneous law
    double memory_J;  ///< springs: stored in the branches of the memory
    double instant_J; ///< of the instantaneous law, W + U, whatever has relaxed
    double dissipated_J, external_work_J;
    double released_J; ///< springs: of dissipated_J, what cuts took: what removed cells had stored
    int cells_removed; ///< springs: by cuts
    double energy_residual; ///< relative to the largest of the terms
    int memory_terms;
    double memory_error;     ///< stated error of the exponentials, of G(0)
    double memory_band_s[2]; ///< over this band
    int threads;
    int ranks;                       ///< processes that shared the work
    int newton_iterations, cutbacks; ///< 0 for explicit runs
    bool converged;
    char reason[SN_TEXT_MAX]; ///< why it stopped early, with numbers; empty when it did not
    char note[SN_TEXT_MAX];   ///< what a reader of the result must know; may be empty
} sn_run_summary;

/// Where a run puts what it needs to go on, and where it starts from: its state, as bytes of this
/// machine and this version.
typedef struct sn_restart {
    void *context;
    /// Nullable: called after every output, after the last only by the springs; the bytes belong to
    /// the engine. An error stops the run.
    sn_status (*save)(void *context, const void *state, size_t bytes);
    const void *state; ///< Nullable: a saved state to go on from
    size_t bytes;      ///< of it
} sn_restart;

#ifdef __cplusplus
}
#endif
