// A ParaView collection: one .vtu a frame, and a .pvd that lists the frames written so far.
// SPDX-License-Identifier: Apache-2.0
//
// Source: the VTK XML file formats, UnstructuredGrid and Collection.
//
// Every frame is a whole file: rest positions, tetrahedra, the region of each cell, the fields.
// Arrays stand inline as base64 behind a 64-bit byte count, so the values that are read back are
// the values that were written, bit for bit. Positions are those at rest: "displacement" moves
// them (Warp By Vector).
//
// Name is the field's name alone, because scripts look arrays up by it (meshio's
// point_data["displacement"], ParaView's calculator). The unit goes with the array as VTK's own key
// UNITS_LABEL, and a symmetric tensor has its six components in VTK's order, xx yy zz xy yz xz.
//
// Cells that a field "removed" marks are left out, with their values; an array "cell" says which
// are there. Nodes all stay.
#include <stdint.h>
#include <string.h>

#include "io/buffer.h"
#include "io/text.h"
#include "sinew/io.h"

#define VTK_TETRA 10
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define BYTE_ORDER_NAME "BigEndian"
#else
#define BYTE_ORDER_NAME "LittleEndian"
#endif

struct sn_vtu {
    char *folder, *name;
    size_t node_count, cell_count;
    int frames;
    sn_buffer points; ///< the same in every frame
    sn_buffer cells;  ///< of frames that have them all
    sn_buffer regions;
    sn_buffer names;    ///< of the regions
    int *cell, *region; ///< of the mesh
    int *kept;          ///< cells of a frame that has removed ones
    double *values;     ///< of these, 6 each at most
    size_t kept_count;
    sn_buffer list; ///< the DataSet lines of the collection
    sn_buffer file; ///< the file being written
    sn_buffer path;
};

static char *copy_text(const char *text) {
    size_t bytes = strlen(text) + 1;
    char *copy = sn_alloc(bytes, 1);
    if (copy) memcpy(copy, text, bytes);
    return copy;
}

// The byte count and the values as one base64 text. Eight bytes of count and the first of the
// values are three whole groups, so that the rest can follow without being copied.
static void add_values(sn_buffer *out, const void *values, size_t bytes) {
    unsigned char head[9];
    uint64_t count = bytes;
    memcpy(head, &count, 8);
    if (bytes) head[8] = *(const unsigned char *)values;
    sn_buffer_base64(out, head, bytes ? 9 : 8);
    if (bytes) sn_buffer_base64(out, (const unsigned char *)values + 1, bytes - 1);
}

static void add_array(sn_buffer *out, const char *type, const char *name, int components,
                      const void *values, size_t bytes) {
    sn_buffer_print(out, "<DataArray type=\"%s\" Name=\"", type);
    sn_buffer_escape(out, name);
    sn_buffer_print(out, "\" NumberOfComponents=\"%d\" format=\"binary\">", components);
    add_values(out, values, bytes);
    sn_buffer_text(out, "</DataArray>\n");
}

static void add_points(sn_buffer *out, const sn_mesh *mesh) {
    sn_buffer_text(out, "<Points>\n");
    add_array(out, "Float64", "Points", 3, mesh->node,
              3 * (size_t)mesh->node_count * sizeof(double));
    sn_buffer_text(out, "</Points>\n");
}

static sn_status add_cells(sn_buffer *out, size_t cells, const int *nodes) {
    int32_t *ends = sn_alloc(cells, sizeof *ends);
    uint8_t *types = sn_alloc(cells, 1);
    if (ends && types) {
        for (size_t c = 0; c < cells; c++) ends[c] = (int32_t)(4 * (c + 1));
        memset(types, VTK_TETRA, cells);
        sn_buffer_text(out, "<Cells>\n");
        add_array(out, "Int32", "connectivity", 1, nodes, 4 * cells * sizeof(int));
        add_array(out, "Int32", "offsets", 1, ends, cells * sizeof *ends);
        add_array(out, "UInt8", "types", 1, types, cells);
        sn_buffer_text(out, "</Cells>\n");
    }
    sn_status status = ends && types ? out->status : SN_E_MEMORY;
    sn_free(ends);
    sn_free(types);
    return status;
}

// Numbers of regions stand in a field, their names in a remark.
static void add_names(sn_buffer *out, const sn_mesh *mesh) {
    sn_buffer_text(out, "<!-- regions:");
    for (int r = 0; r < mesh->region_count; r++) {
        sn_buffer_print(out, " %d ", r);
        // a comment ends at "--": a name cannot be allowed to hold one
        for (const char *at = mesh->region_name[r]; *at; at++) {
            char mark[2] = {*at == '-' ? '_' : *at, 0};
            sn_buffer_escape(out, mark);
        }
        sn_buffer_text(out, r + 1 < mesh->region_count ? "," : " ");
    }
    sn_buffer_text(out, "-->\n");
}

sn_status sn_vtu_create(const char *folder, const char *name, const sn_mesh *mesh, sn_vtu **vtu) {
    SN_ASSERT(sizeof(int) == sizeof(int32_t));
    *vtu = NULL;
    sn_vtu *made = sn_alloc(1, sizeof *made);
    if (!made) return SN_E_MEMORY;
    sn_status status = SN_E_MEMORY;
    made->node_count = (size_t)mesh->node_count;
    made->cell_count = (size_t)mesh->cell_count;
    const size_t numbers = 4 * made->cell_count;
    made->cell = sn_alloc(numbers, sizeof(int));
    made->region = sn_alloc(made->cell_count, sizeof(int));
    if (!made->cell || !made->region) goto fail;
    if (numbers > 0) memcpy(made->cell, mesh->cell, numbers * sizeof(int));
    if (numbers > 0) memcpy(made->region, mesh->region, made->cell_count * sizeof(int));
    made->folder = copy_text(folder);
    made->name = copy_text(name);
    if (!made->folder || !made->name) goto fail;
    add_points(&made->points, mesh);
    SN_TRY_GOTO(status, made->points.status);
    SN_TRY_GOTO(status, add_cells(&made->cells, made->cell_count, mesh->cell));
    add_array(&made->regions, "Int32", "region", 1, mesh->region, made->cell_count * sizeof(int));
    SN_TRY_GOTO(status, made->regions.status);
    add_names(&made->names, mesh);
    SN_TRY_GOTO(status, made->names.status);
    *vtu = made;
    return SN_OK;
fail:
    sn_vtu_destroy(made);
    return status;
}

void sn_vtu_destroy(sn_vtu *vtu) {
    if (!vtu) return;
    sn_free(vtu->folder);
    sn_free(vtu->name);
    sn_free(vtu->cell);
    sn_free(vtu->region);
    sn_free(vtu->kept);
    sn_free(vtu->values);
    sn_buffer_free(&vtu->points);
    sn_buffer_free(&vtu->cells);
    sn_buffer_free(&vtu->regions);
    sn_buffer_free(&vtu->names);
    sn_buffer_free(&vtu->list);
    sn_buffer_free(&vtu->file);
    sn_buffer_free(&vtu->path);
    sn_free(vtu);
}

//---- cells that are left -------------------------------------------------------------------------

static bool is_mark(const sn_field *field) {
    return field->place == SN_ON_CELLS && strcmp(field->name, "removed") == 0;
}

// the field that says which cells are not there; NULL where none can be missing
static const double *find_mark(const sn_frame *frame) {
    for (int f = 0; f < frame->field_count; f++)
        if (is_mark(&frame->fields[f])) return frame->fields[f].value;
    return NULL;
}

static sn_status list_kept(sn_vtu *vtu, const double *removed) {
    if (!vtu->kept) vtu->kept = sn_alloc(vtu->cell_count, sizeof(int));
    if (!vtu->values) vtu->values = sn_alloc(6 * vtu->cell_count, sizeof(double));
    if (!vtu->kept || !vtu->values) return SN_E_MEMORY;
    vtu->kept_count = 0;
    for (size_t e = 0; e < vtu->cell_count; e++)
        if (removed[e] == 0) vtu->kept[vtu->kept_count++] = (int)e;
    return SN_OK;
}

// rows of whole numbers of the cells that are kept
static sn_status add_kept(sn_vtu *vtu, bool grid) {
    const int *from = grid ? vtu->cell : vtu->region;
    const size_t wide = grid ? 4 : 1, count = vtu->kept_count;
    int *rows = sn_alloc(wide * count, sizeof *rows);
    if (!rows) return SN_E_MEMORY;
    for (size_t k = 0; k < wide * count; k++)
        rows[k] = from[wide * (size_t)vtu->kept[k / wide] + k % wide];
    if (grid)
        add_cells(&vtu->file, count, rows);
    else
        add_array(&vtu->file, "Int32", "region", 1, rows, count * sizeof *rows);
    sn_free(rows);
    return SN_OK;
}

static sn_status add_grid(sn_vtu *vtu, bool all) {
    sn_buffer_add(&vtu->file, vtu->points.text, vtu->points.size);
    if (!all) return add_kept(vtu, true);
    sn_buffer_add(&vtu->file, vtu->cells.text, vtu->cells.size);
    return SN_OK;
}

static sn_status add_regions(sn_vtu *vtu, bool all) {
    if (all)
        sn_buffer_add(&vtu->file, vtu->regions.text, vtu->regions.size);
    else
        SN_TRY(add_kept(vtu, false));
    sn_buffer_add(&vtu->file, vtu->names.text, vtu->names.size);
    if (vtu->kept)
        add_array(&vtu->file, "Int32", "cell", 1, vtu->kept, vtu->kept_count * sizeof(int));
    return SN_OK;
}

// a field without the values of removed cells
static sn_field keep_values(sn_vtu *vtu, const sn_field *field) {
    const size_t wide = (size_t)field->components;
    sn_field kept = *field;
    SN_ASSERT(wide <= 6);
    for (size_t k = 0; k < wide * vtu->kept_count; k++)
        vtu->values[k] = field->value[wide * (size_t)vtu->kept[k / wide] + k % wide];
    kept.value = vtu->values;
    return kept;
}

//---- frames --------------------------------------------------------------------------------------

static void add_field(sn_buffer *out, const sn_field *field, size_t points) {
    SN_ASSERT(field->components >= 1);
    sn_buffer_text(out, "<DataArray type=\"Float64\" Name=\"");
    sn_buffer_escape(out, field->name);
    sn_buffer_print(out, "\" NumberOfComponents=\"%d\" format=\"binary\">", field->components);
    add_values(out, field->value, points * (size_t)field->components * sizeof(double));
    if (field->unit[0]) { // after the values: a reader takes the text before the first child
        sn_buffer_text(out, "\n<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">");
        sn_buffer_escape(out, field->unit);
        sn_buffer_text(out, "</InformationKey>\n");
    }
    sn_buffer_text(out, "</DataArray>\n");
}

static void add_fields(sn_vtu *vtu, const sn_frame *frame, sn_place place, bool all) {
    for (int f = 0; f < frame->field_count; f++) {
        const sn_field *field = &frame->fields[f];
        if (field->place != place || is_mark(field)) continue;
        if (place == SN_ON_NODES) {
            add_field(&vtu->file, field, vtu->node_count);
        } else if (all) {
            add_field(&vtu->file, field, vtu->cell_count);
        } else {
            const sn_field kept = keep_values(vtu, field);
            add_field(&vtu->file, &kept, vtu->kept_count);
        }
    }
}

static void add_head(sn_buffer *out, const char *type) {
    sn_buffer_print(out,
                    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<VTKFile type=\"%s\" "
                    "version=\"1.0\" byte_order=\"" BYTE_ORDER_NAME "\" header_type=\"UInt64\">\n",
                    type);
}

static void add_time(sn_buffer *out, double time) {
    char text[32];
    sn_number_print(time, 6, text);
    sn_buffer_text(out, text);
}

static sn_status fill_frame(sn_vtu *vtu, const sn_frame *frame) {
    sn_buffer *out = &vtu->file;
    const double *removed = find_mark(frame);
    out->size = 0;
    if (removed) SN_TRY(list_kept(vtu, removed));
    const bool all = !removed || vtu->kept_count == vtu->cell_count;
    add_head(out, "UnstructuredGrid");
    sn_buffer_text(out, "<UnstructuredGrid>\n<FieldData>\n<DataArray type=\"Float64\" "
                        "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">");
    add_time(out, frame->time);
    sn_buffer_print(out,
                    "</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"%zu\" "
                    "NumberOfCells=\"%zu\">\n",
                    vtu->node_count, all ? vtu->cell_count : vtu->kept_count);
    SN_TRY(add_grid(vtu, all));
    sn_buffer_text(out, "<PointData>\n");
    add_fields(vtu, frame, SN_ON_NODES, all);
    sn_buffer_text(out, "</PointData>\n<CellData>\n");
    SN_TRY(add_regions(vtu, all));
    add_fields(vtu, frame, SN_ON_CELLS, all);
    sn_buffer_text(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    return SN_OK;
}

static void fill_collection(sn_vtu *vtu) {
    sn_buffer *out = &vtu->file;
    out->size = 0;
    add_head(out, "Collection");
    sn_buffer_text(out, "<Collection>\n");
    sn_buffer_add(out, vtu->list.text, vtu->list.size);
    sn_buffer_text(out, "</Collection>\n</VTKFile>\n");
}

static sn_status write_file(sn_vtu *vtu) {
    if (vtu->file.status != SN_OK || vtu->path.status != SN_OK)
        return sn_fail(SN_E_MEMORY, "%s/%s: out of memory for a frame", vtu->folder, vtu->name);
    return sn_text_write(vtu->path.text, vtu->file.text, vtu->file.size);
}

static void list_frame(sn_vtu *vtu, double time) {
    sn_buffer_text(&vtu->list, "<DataSet timestep=\"");
    add_time(&vtu->list, time);
    sn_buffer_text(&vtu->list, "\" part=\"0\" file=\"");
    sn_buffer_escape(&vtu->list, vtu->name);
    sn_buffer_print(&vtu->list, "_%04d.vtu\"/>\n", vtu->frames);
}

sn_status sn_vtu_continue(sn_vtu *vtu, int frames, const double *time) {
    SN_ASSERT(vtu->frames == 0);
    for (; vtu->frames < frames; vtu->frames++) list_frame(vtu, time[vtu->frames]);
    return vtu->list.status;
}

sn_status sn_vtu_frame(sn_vtu *vtu, const sn_frame *frame) {
    SN_TRY(fill_frame(vtu, frame));
    vtu->path.size = 0;
    sn_buffer_print(&vtu->path, "%s/%s_%04d.vtu", vtu->folder, vtu->name, vtu->frames);
    SN_TRY(write_file(vtu));

    size_t before = vtu->list.size;
    list_frame(vtu, frame->time);
    if (vtu->list.status != SN_OK) return vtu->list.status;
    fill_collection(vtu);
    vtu->path.size = 0;
    sn_buffer_print(&vtu->path, "%s/%s.pvd", vtu->folder, vtu->name);
    sn_status status = write_file(vtu);
    if (status == SN_OK)
        vtu->frames++;
    else
        vtu->list.size = before;
    return status;
}
