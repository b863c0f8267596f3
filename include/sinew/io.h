// Files: units, curves, tissues, cases, meshes, fields, reports.
// SPDX-License-Identifier: Apache-2.0
//
// Every reader refuses bad input with file, line, key, what was found, what was expected, and a
// suggestion for a misspelt key. Every writer writes to a temporary name and renames.
#pragma once

#include "sinew/lab.h"
#include "sinew/model.h"

#ifdef __cplusplus
extern "C" {
#endif

//---- units ---------------------------------------------------------------------------------------

/// Factor and offset from a unit to SI: si = factor * x + offset. `si_unit` names the wanted
/// dimension ("Pa", "m", "1", …). @return SN_OK, SN_E_UNIT (unknown unit, wrong dimension).
SN_API sn_status sn_unit_to_si(const char *unit, const char *si_unit, double *factor,
                               double *offset);
/// Parses "10 kPa" as a quantity of the dimension of si_unit. A bare number is accepted only for
/// si_unit "1". Refuses nan, inf and numbers that overflow.
/// @return SN_OK, SN_E_UNIT, SN_E_SYNTAX.
SN_API sn_status sn_quantity_parse(const char *text, const char *si_unit, double *value);

//---- curves --------------------------------------------------------------------------------------

/// Reads a curve: columns in SI units under the names of the manual, remarks with their SI values.
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_KEY, SN_E_UNIT, SN_E_RANGE, SN_E_DATA.
SN_API sn_status sn_curve_read(const char *path, sn_record **record);
/// Writes a record as CSV: remarks, header "name [unit],…", 9 significant digits or more as needed
/// to read back the same doubles (17 where `exact`).
SN_API sn_status sn_curve_write(const char *path, const sn_record *record, bool exact);

//---- tissues and cases ---------------------------------------------------------------------------

SN_API sn_status sn_tissue_read(const char *path, sn_tissue *tissue);
/// Writes a tissue file. `comment` (Nullable) stands at its head, every line after "# ".
SN_API sn_status sn_tissue_write(const char *path, const sn_tissue *tissue, const char *comment);
/// Reads a case with its tissues and mesh (paths relative to the case file) and checks it.
SN_API sn_status sn_case_read(const char *path, sn_case **c);
/// Writes springs given one by one: remarks "exponent of REGION" and, where it is given, "bulk
/// modulus of REGION", then the table from, to (nodes from 0), region, length [m], stiffness [N/m].
/// @param comment  Nullable; stands at its head
/// @return SN_OK, SN_E_FILE, SN_E_MEMORY.
SN_API sn_status sn_springs_write(const char *path, const sn_mesh *mesh, const sn_spring_set *set,
                                  const char *comment);
/// Reads what sn_springs_write() writes. Lengths must be those of the mesh to 1e-6.
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_UNIT, SN_E_NAME (region), SN_E_DEFINITION (of
/// another mesh), SN_E_RANGE, SN_E_KEY (no exponent), SN_E_DATA (no springs), SN_E_MEMORY.
SN_API sn_status sn_springs_read(const char *path, const sn_mesh *mesh, sn_spring_set **set);
/// Reads a Gmsh mesh, ASCII 2.2 or 4.1: tetrahedra, physical volumes as regions, physical surfaces
/// as surfaces. `scale` brings its coordinates to metres. Calls sn_mesh_finish(). Groups without a
/// name are "volume_3" and "surface_7", cells of no physical volume the region "body"; tetrahedra
/// of second order keep their corners.
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_UNSUPPORTED (binary, other versions, other
/// elements),
///         SN_E_MESH, SN_E_RANGE (scale), SN_E_MEMORY.
SN_API sn_status sn_mesh_read_gmsh(const char *path, double scale, sn_mesh **mesh);

/// Reads a closed surface of triangles for a tool from an STL file, text or binary. `scale` brings
/// its coordinates to metres.
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_MESH, SN_E_DATA (too large), SN_E_MEMORY.
SN_API sn_status sn_tool_surface_read_stl(const char *path, double scale,
                                          sn_tool_surface **surface);

//---- tissues of other programs -------------------------------------------------------------------

/// How a file of a program without units is to be taken, and what a conversion had to give up.
typedef struct sn_foreign {
    double stress;        ///< SI value of the file's unit of stress, e.g. 1e3 for kPa
    double time;          ///< SI value of its unit of time
    double length;        ///< SI value of its unit of length, for densities; NAN: none is written
    const char *material; ///< Nullable: name of the material to read where there are several
    double from, to;      ///< band in which a spectrum is compressed, seconds
    int terms;            ///< out: exponentials in the file
    double max_error;     ///< out: largest error over the band that their number costs, of G(0) = 1
    char remarks[512];    ///< out: what differs, in words; empty where nothing does
} sn_foreign;
/// Units missing (NAN), band 1 ms to 1000 s.
SN_API sn_foreign sn_foreign_default(void);
/// Writes a tissue as a FEBio 4 file with its material section. Laws: neo-hookean, mooney-rivlin,
/// ogden, demiray, veronda-westmann, fung, guccione, hgo, of finite bulk modulus.
/// @return SN_OK, SN_E_DEFINITION (units missing), SN_E_UNSUPPORTED, SN_E_RANGE, SN_E_FILE,
/// SN_E_MEMORY.
SN_API sn_status sn_tissue_write_febio(const char *path, const sn_tissue *tissue, sn_foreign *how);
/// Reads what sn_tissue_write_febio() writes and its like; guccione comes back as fung.
/// @return SN_OK, SN_E_FILE, SN_E_SYNTAX, SN_E_KEY, SN_E_NAME, SN_E_RANGE, SN_E_UNSUPPORTED, …
SN_API sn_status sn_tissue_read_febio(const char *path, sn_tissue *tissue, sn_foreign *how);
/// Writes a tissue as an Abaqus material. Laws: neo-hookean, mooney-rivlin, ogden, fung, guccione,
/// hgo; a fluid (no long-term stress) is refused.
SN_API sn_status sn_tissue_write_abaqus(const char *path, const sn_tissue *tissue, sn_foreign *how);
SN_API sn_status sn_tissue_read_abaqus(const char *path, sn_tissue *tissue, sn_foreign *how);

//---- fields --------------------------------------------------------------------------------------

/// A ParaView collection: one .vtu a frame and a .pvd that is complete after every frame.
typedef struct sn_vtu sn_vtu;
/// @param folder  exists already; files are folder/name.pvd and folder/name_0000.vtu …
SN_API sn_status sn_vtu_create(const char *folder, const char *name, const sn_mesh *mesh,
                               sn_vtu **vtu);
/// Cells where the field "removed" is not 0 are left out of the file; an array "cell" then says
/// which are there.
SN_API sn_status sn_vtu_frame(sn_vtu *vtu, const sn_frame *frame);
/// Takes up a collection of an earlier run in the same folder: its frames stay listed, and new ones
/// are numbered after them. Comes before the first sn_vtu_frame().
/// @param time  of each frame                                 (frames)
SN_API sn_status sn_vtu_continue(sn_vtu *vtu, int frames, const double *time);
SN_API void sn_vtu_destroy(sn_vtu *vtu); // NULL is allowed

//---- files and folders ---------------------------------------------------------------------------

/// Writes text to path through a temporary name in the same folder.
SN_API sn_status sn_text_write(const char *path, const char *text, size_t bytes);
/// Reads a whole file of at most `most` bytes. *text is sn_alloc'd, with a closing zero.
/// @return SN_OK, SN_E_FILE, SN_E_DATA (too large), SN_E_MEMORY.
SN_API sn_status sn_text_read(const char *path, size_t most, char **text, size_t *bytes);
/// Makes a folder and its parents.
SN_API sn_status sn_folder_make(const char *path);
/// SHA-256 of a file as 64 hexadecimal digits and a closing zero.
SN_API sn_status sn_file_sha256(const char *path, char digest[65]);

//---- reports -------------------------------------------------------------------------------------

/// A self-contained HTML page in the making: headings, text, tables, plots, bodies.
typedef struct sn_report sn_report;

SN_API sn_status sn_report_create(const char *title, sn_report **report);
SN_API void sn_report_destroy(sn_report *report); // NULL is allowed
SN_API void sn_report_heading(sn_report *report, const char *text);
/// A paragraph of plain text (escaped here).
SN_API void sn_report_text(sn_report *report, const char *format, ...) SN_PRINTF(2, 3);
/// A table: `cells` holds rows x columns strings, the first row the header.
SN_API void sn_report_table(sn_report *report, int rows, int columns, const char *const *cells,
                            const char *caption);

typedef enum sn_line_style { SN_LINE, SN_POINTS, SN_LINE_POINTS, SN_DASHED, SN_BARS } sn_line_style;
typedef struct sn_line {
    const char *label;
    sn_line_style style;
    int colour; ///< 0 … 7 of the palette; lines of one thing share it
    int count;
    const double *x, *y; ///< borrowed                             (count)
} sn_line;
typedef struct sn_plot {
    const char *title, *x_label, *y_label; ///< labels carry units
    const char *caption;                   ///< Nullable
    bool log_x, log_y;
    double x_scale, y_scale; ///< values are multiplied by these, to fit the labels' units; 0: 1
    int line_count;
    const sn_line *line; ///< borrowed                             (line_count)
} sn_plot;
/// A plot as SVG, drawn by gnuplot. Where gnuplot is missing the page says so in its place.
SN_API void sn_report_plot(sn_report *report, const sn_plot *plot);

/// A deformed body with a scalar painted on its surface; the reader turns it with the mouse.
typedef struct sn_body {
    const char *title;
    const char *value_label; ///< with unit
    const sn_mesh *mesh;
    const double *displacement; ///< m                             (nodes x 3)
    const double *value;        ///< painted                       (nodes)
    double value_max;           ///< top of the colour scale; 0: the largest value
    double value_scale;         ///< numbers on the scale are multiplied by this; 0: 1
} sn_body;
/// Bodies side by side, turned together.
SN_API void sn_report_bodies(sn_report *report, int count, const sn_body *bodies,
                             const char *caption);
/// Writes the page. @return SN_OK, SN_E_FILE, SN_E_MEMORY (also of any earlier call).
SN_API sn_status sn_report_write(sn_report *report, const char *path);

#ifdef __cplusplus
}
#endif
