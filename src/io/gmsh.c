// Gmsh meshes, ASCII 2.2 and 4.1.
// SPDX-License-Identifier: Apache-2.0
//
// Source: "MSH file format" and "Legacy formats" in the Gmsh reference manual.
//
// Both versions are read into the same lists: nodes under their tags, tetrahedra and triangles
// with the physical group they belong to. Only how a line is laid out and where the group stands
// differs: in 2.2 with every element, in 4.1 with the geometric entity of a block of elements. The
// mesh is built from the lists: node tags, which may be sparse, become 0 … n-1 in the order of the
// file, and nodes of no tetrahedron (midside nodes, points of the geometry) are left out. Other
// cells and faces are cut as they are read: see gmsh_element.c.
//
// A count in the file is believed only as far as the bytes that follow could hold it.
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/gmsh_element.h"
#include "io/gmsh_mesh.h"
#include "io/gmsh_scan.h"
#include "sinew/io.h"

#define GROUPS_MAX 4096
#define NODE_BYTES 8    // the shortest node: "1\n0 0 0\n"
#define ELEMENT_BYTES 4 // the shortest element of 4.1: "1 1\n"

// A surface or volume of the geometry with its physical groups (4.1).
typedef struct entity {
    int dimension;
    long long tag;
    int first, count; // in groups_of
} entity;

typedef struct mark {
    long long tag;
    int node; // place in the file
    int line;
} mark;

typedef struct reader {
    sn_gmsh_scan scan;
    int version;
    double scale;
    sn_gmsh_lists lists;
    int group_capacity, face_capacity, cell_capacity;
    bool has_entities;
    entity *entities;
    int entity_count, entity_capacity;
    int *groups_of;
    int groups_of_count, groups_of_capacity;
    mark *marks; // sorted by tag                                (lists.node_count)
} reader;

// Room for one more; `*list` is a pointer to any object.
static sn_status grow(void *list, int count, int *capacity, size_t size) {
    if (count < *capacity) return SN_OK;
    if (*capacity > INT_MAX / 2) return sn_fail(SN_E_MEMORY, "more than %d entries", *capacity);
    int larger = *capacity ? 2 * *capacity : 64;
    void *block;
    memcpy(&block, list, sizeof block);
    block = sn_resize(block, (size_t)larger, size);
    if (!block) return SN_E_MEMORY;
    memcpy(list, &block, sizeof block);
    *capacity = larger;
    return SN_OK;
}

//---- physical groups -----------------------------------------------------------------------------

// Adds a group unless it is there. Tag 0 is what belongs to no physical volume.
static sn_status find_group(reader *r, int dimension, long long tag, int *found) {
    if (tag < 0) tag = -tag;                     // the sign only turns the orientation round
    for (int g = r->lists.group_count; g-- > 0;) // the latest first: elements come group by group
        if (r->lists.groups[g].dimension == dimension && r->lists.groups[g].tag == tag) {
            *found = g;
            return SN_OK;
        }
    if (r->lists.group_count == GROUPS_MAX)
        return sn_gmsh_fail(&r->scan, SN_E_UNSUPPORTED,
                            "found more than %d physical surfaces and volumes, expected fewer",
                            GROUPS_MAX);
    SN_TRY(
        grow(&r->lists.groups, r->lists.group_count, &r->group_capacity, sizeof *r->lists.groups));
    sn_gmsh_group *made = &r->lists.groups[r->lists.group_count];
    *made = (sn_gmsh_group){.dimension = dimension, .tag = tag};
    if (tag == 0)
        snprintf(made->name, sizeof made->name, "body");
    else
        snprintf(made->name, sizeof made->name, "%s_%lld", dimension == 2 ? "surface" : "volume",
                 tag);
    *found = r->lists.group_count++;
    return SN_OK;
}

static sn_status read_names(reader *r) {
    sn_gmsh_scan *scan = &r->scan;
    if (!sn_gmsh_enter(scan, "$PhysicalNames")) return SN_OK;
    long long count, dimension, tag;
    SN_TRY(sn_gmsh_line(scan, "the number of names"));
    SN_TRY(sn_gmsh_integer(scan, "the number of names", 0, INT_MAX, &count));
    SN_TRY(sn_gmsh_line_end(scan, "the number of names"));
    for (long long i = 0; i < count; i++) {
        char name[SN_NAME_MAX];
        SN_TRY(sn_gmsh_line(scan, "dimension, tag and name of a physical group"));
        SN_TRY(sn_gmsh_integer(scan, "a dimension, 0 to 3", 0, 3, &dimension));
        SN_TRY(sn_gmsh_integer(scan, "the tag of a physical group, 1 or more", 1, INT_MAX, &tag));
        SN_TRY(sn_gmsh_name(scan, name));
        SN_TRY(sn_gmsh_line_end(scan, "dimension, tag and name"));
        if (dimension < 2) continue;
        int g, before = r->lists.group_count;
        SN_TRY(find_group(r, (int)dimension, tag, &g));
        if (g < before)
            return sn_gmsh_fail(
                scan, SN_E_SYNTAX,
                "found a second name for the physical group %lld of dimension %lld, "
                "expected one",
                tag, dimension);
        if (*name) memcpy(r->lists.groups[g].name, name, sizeof name);
    }
    return sn_gmsh_leave(scan);
}

//---- entities (4.1) ------------------------------------------------------------------------------

static int compare_entities(const void *left, const void *right) {
    const entity *a = left, *b = right;
    if (a->dimension != b->dimension) return a->dimension - b->dimension;
    return (a->tag > b->tag) - (a->tag < b->tag);
}

// tag, box, physical tags; what bounds it follows and is not needed
static sn_status read_entity(reader *r, int dimension) {
    sn_gmsh_scan *scan = &r->scan;
    SN_TRY(sn_gmsh_line(scan, "a surface or a volume"));
    long long tag, count, physical;
    double box;
    SN_TRY(sn_gmsh_integer(scan, "the tag of an entity", INT_MIN, INT_MAX, &tag));
    for (int i = 0; i < 6; i++) SN_TRY(sn_gmsh_number(scan, "the box of an entity", &box));
    SN_TRY(sn_gmsh_integer(scan, "the number of physical tags", 0, INT_MAX, &count));
    SN_TRY(grow(&r->entities, r->entity_count, &r->entity_capacity, sizeof *r->entities));
    entity *made = &r->entities[r->entity_count++];
    *made = (entity){dimension, tag, r->groups_of_count, 0};
    for (long long i = 0; i < count; i++) {
        SN_TRY(sn_gmsh_integer(scan, "a physical tag", -INT_MAX, INT_MAX, &physical));
        if (physical == 0) continue;
        SN_TRY(
            grow(&r->groups_of, r->groups_of_count, &r->groups_of_capacity, sizeof *r->groups_of));
        SN_TRY(find_group(r, dimension, physical, &r->groups_of[r->groups_of_count]));
        r->groups_of_count++;
        made->count++;
    }
    return SN_OK;
}

static sn_status read_entities(reader *r) {
    sn_gmsh_scan *scan = &r->scan;
    if (sn_gmsh_enter(scan, "$PartitionedEntities"))
        return sn_gmsh_fail(scan, SN_E_UNSUPPORTED,
                            "found a mesh in partitions, expected one in one piece: save it "
                            "unpartitioned");
    r->has_entities = sn_gmsh_enter(scan, "$Entities");
    if (!r->has_entities) return SN_OK;
    long long count[4];
    SN_TRY(sn_gmsh_line(scan, "the numbers of points, curves, surfaces and volumes"));
    for (int d = 0; d < 4; d++)
        SN_TRY(
            sn_gmsh_integer(scan, "the number of entities of a dimension", 0, INT_MAX, &count[d]));
    SN_TRY(sn_gmsh_line_end(scan, "four numbers of entities"));
    for (long long i = 0; i < count[0] + count[1]; i++)
        SN_TRY(sn_gmsh_line(scan, "a point or a curve"));
    for (int d = 2; d < 4; d++)
        for (long long i = 0; i < count[d]; i++) SN_TRY(read_entity(r, d));
    if (r->entity_count)
        qsort(r->entities, (size_t)r->entity_count, sizeof *r->entities, compare_entities);
    for (int e = 1; e < r->entity_count; e++)
        if (!compare_entities(&r->entities[e - 1], &r->entities[e]))
            return sn_gmsh_fail(scan, SN_E_SYNTAX,
                                "found entity %lld of dimension %d twice, expected it once",
                                r->entities[e].tag, r->entities[e].dimension);
    return sn_gmsh_leave(scan);
}

//---- nodes ---------------------------------------------------------------------------------------

static int compare_marks(const void *left, const void *right) {
    const mark *a = left, *b = right;
    return (a->tag > b->tag) - (a->tag < b->tag);
}

// A count that the rest of the file could hold.
static sn_status read_count(reader *r, const char *what, size_t least_bytes, int *count) {
    long long found;
    SN_TRY(sn_gmsh_integer(&r->scan, what, 0, LLONG_MAX, &found));
    size_t left = sn_gmsh_left(&r->scan);
    // the last line may lack its newline
    if ((unsigned long long)found > (left + 1) / least_bytes || found > INT_MAX)
        return sn_gmsh_fail(&r->scan, SN_E_SYNTAX,
                            "found %s of %lld, expected what fits into the %zu bytes that follow",
                            what, found, left);
    *count = (int)found;
    return SN_OK;
}

static sn_status read_position(reader *r, int node) {
    for (int i = 0; i < 3; i++) {
        double x;
        SN_TRY(sn_gmsh_number(&r->scan, "a coordinate", &x));
        x *= r->scale;
        if (!isfinite(x))
            return sn_gmsh_fail(
                &r->scan, SN_E_SYNTAX,
                "found a coordinate that overflows in metres, expected a finite one");
        r->lists.node[3 * (size_t)node + (size_t)i] = x;
    }
    return SN_OK;
}

static sn_status read_tag(reader *r, int node) {
    long long tag;
    SN_TRY(sn_gmsh_integer(&r->scan, "the tag of a node, 1 or more", 1, LLONG_MAX, &tag));
    r->marks[node] = (mark){tag, node, r->scan.line};
    return SN_OK;
}

static sn_status read_nodes_22(reader *r) {
    for (int n = 0; n < r->lists.node_count; n++) {
        SN_TRY(sn_gmsh_line(&r->scan, "a node (fewer nodes than declared)"));
        SN_TRY(read_tag(r, n));
        SN_TRY(read_position(r, n));
        SN_TRY(sn_gmsh_line_end(&r->scan, "the tag of a node and three coordinates"));
    }
    return SN_OK;
}

// Blocks of tags and then positions.
static sn_status read_nodes_41(reader *r, long long blocks) {
    sn_gmsh_scan *scan = &r->scan;
    int done = 0;
    for (long long b = 0; b < blocks; b++) {
        long long dimension, tag, parametric;
        int count = 0;
        SN_TRY(sn_gmsh_line(scan, "a block of nodes (fewer blocks than declared)"));
        SN_TRY(sn_gmsh_integer(scan, "the dimension of an entity, 0 to 3", 0, 3, &dimension));
        SN_TRY(sn_gmsh_integer(scan, "the tag of an entity", INT_MIN, INT_MAX, &tag));
        SN_TRY(sn_gmsh_integer(scan, "0 or 1 for parametric", 0, 1, &parametric));
        SN_TRY(read_count(r, "a number of nodes", NODE_BYTES, &count));
        SN_TRY(sn_gmsh_line_end(scan, "four numbers of a block"));
        if (count > r->lists.node_count - done)
            return sn_gmsh_fail(
                scan, SN_E_SYNTAX,
                "found %d nodes in this block, expected at most %d: %d are declared "
                "in all",
                count, r->lists.node_count - done, r->lists.node_count);
        for (int n = done; n < done + count; n++) {
            SN_TRY(sn_gmsh_line(scan, "the tag of a node"));
            SN_TRY(read_tag(r, n));
            SN_TRY(sn_gmsh_line_end(scan, "the tag of a node"));
        }
        for (int n = done; n < done + count; n++) {
            SN_TRY(sn_gmsh_line(scan, "the coordinates of a node"));
            SN_TRY(read_position(r, n));
            if (!parametric) SN_TRY(sn_gmsh_line_end(scan, "three coordinates"));
        }
        done += count;
    }
    if (done == r->lists.node_count) return SN_OK;
    return sn_gmsh_fail(scan, SN_E_SYNTAX, "found %d nodes in all blocks, expected the %d declared",
                        done, r->lists.node_count);
}

static sn_status read_nodes(reader *r) {
    sn_gmsh_scan *scan = &r->scan;
    if (!sn_gmsh_enter(scan, "$Nodes"))
        return sn_fail(SN_E_SYNTAX, "%s: found no $Nodes, expected them", scan->path);
    SN_TRY(sn_gmsh_line(scan, "the number of nodes"));
    long long blocks = 0, bound;
    if (r->version == 41)
        SN_TRY(sn_gmsh_integer(scan, "the number of blocks", 0, LLONG_MAX, &blocks));
    SN_TRY(read_count(r, "a number of nodes", NODE_BYTES, &r->lists.node_count));
    for (int i = 0; r->version == 41 && i < 2; i++)
        SN_TRY(sn_gmsh_integer(scan, "the least and the largest tag", 0, LLONG_MAX, &bound));
    SN_TRY(sn_gmsh_line_end(scan, r->version == 41 ? "four numbers" : "the number of nodes"));

    r->lists.node = sn_alloc((size_t)r->lists.node_count, 3 * sizeof *r->lists.node);
    r->marks = sn_alloc((size_t)r->lists.node_count, sizeof *r->marks);
    if (!r->lists.node || !r->marks) return SN_E_MEMORY;
    SN_TRY(r->version == 41 ? read_nodes_41(r, blocks) : read_nodes_22(r));
    SN_TRY(sn_gmsh_leave(scan));
    qsort(r->marks, (size_t)r->lists.node_count, sizeof *r->marks, compare_marks);
    for (int n = 1; n < r->lists.node_count; n++)
        if (r->marks[n - 1].tag == r->marks[n].tag) {
            int a = r->marks[n - 1].line, b = r->marks[n].line;
            scan->line = a > b ? a : b;
            return sn_gmsh_fail(scan, SN_E_SYNTAX,
                                "found node %lld for the second time (first in line %d), expected "
                                "every tag once",
                                r->marks[n].tag, a < b ? a : b);
        }
    return SN_OK;
}

// The place of a node by its tag; -1 when there is none.
static int find_node(const reader *r, long long tag) {
    if (!r->lists.node_count) return -1;
    long long guess = tag - r->marks[0].tag; // right where tags have no gaps
    if (guess < 0) return -1;
    if (guess < r->lists.node_count && r->marks[guess].tag == tag) return r->marks[guess].node;
    mark key = {.tag = tag};
    const mark *found =
        bsearch(&key, r->marks, (size_t)r->lists.node_count, sizeof *r->marks, compare_marks);
    return found ? found->node : -1;
}

//---- elements ------------------------------------------------------------------------------------

static sn_status read_type(reader *r, const sn_gmsh_element **type) {
    long long number;
    SN_TRY(sn_gmsh_integer(&r->scan, "the number of an element type", 1, INT_MAX, &number));
    *type = sn_gmsh_element_find(number);
    if (*type && (*type)->kind != SN_GMSH_REFUSED) return SN_OK;
    return sn_gmsh_fail(&r->scan, SN_E_UNSUPPORTED,
                        "found %s (type %lld), expected tetrahedra, hexahedra, prisms or pyramids "
                        "of first or second order with their triangles and quadrangles",
                        *type ? (*type)->name : "unknown elements", number);
}

// The nodes of an element, of which the corners are kept.
static sn_status read_corners(reader *r, const sn_gmsh_element *type, int *node) {
    for (int k = 0; k < type->nodes; k++) {
        long long tag;
        SN_TRY(sn_gmsh_integer(&r->scan, "the tag of a node", 1, LLONG_MAX, &tag));
        int place = find_node(r, tag);
        if (place < 0)
            return sn_gmsh_fail(&r->scan, SN_E_SYNTAX,
                                "found node %lld, expected one of the %d that $Nodes lists", tag,
                                r->lists.node_count);
        if (k < type->corners) node[k] = place;
    }
    return sn_gmsh_line_end(&r->scan, "as many nodes as the element has");
}

// Six times the volume of a tetrahedron.
static double size_of(const reader *r, const int node[4]) {
    double e[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            e[k][i] = r->lists.node[3 * (size_t)node[k + 1] + (size_t)i] -
                      r->lists.node[3 * (size_t)node[0] + (size_t)i];
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
           e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

static sn_status add_cell(reader *r, const sn_gmsh_element *type, int group) {
    int node[SN_GMSH_CORNERS], part[SN_GMSH_PARTS][4], positive = 0;
    SN_TRY(read_corners(r, type, node));
    int parts = sn_gmsh_cut_cell(type->corners, node, part);
    for (int k = 0; k < parts; k++) positive += size_of(r, part[k]) > 0.0;
    if (positive != 0 && positive != parts)
        return sn_gmsh_fail(&r->scan, SN_E_MESH,
                            "found one of the %s so twisted that %d of the %d tetrahedra it is cut "
                            "into are inside out, expected flatter faces: remesh there",
                            type->name, positive > parts / 2 ? parts - positive : positive, parts);
    for (int k = 0; k < parts; k++) {
        SN_TRY(
            grow(&r->lists.cells, r->lists.cell_count, &r->cell_capacity, sizeof *r->lists.cells));
        if (r->lists.cell_count == SN_CELLS_MAX)
            return sn_gmsh_fail(&r->scan, SN_E_MESH,
                                "found more than %d tetrahedra, expected fewer", SN_CELLS_MAX);
        sn_gmsh_cell *cell = &r->lists.cells[r->lists.cell_count++];
        memcpy(cell->node, part[k], sizeof part[k]);
        cell->group = group;
        r->lists.groups[group].count++;
    }
    r->lists.split_cells += parts > 1;
    return SN_OK;
}

static sn_status add_face(reader *r, const sn_gmsh_element *type, int count, const int *groups) {
    int node[SN_GMSH_CORNERS], part[2][3], parts = 0;
    if (count) {
        SN_TRY(read_corners(r, type, node));
        parts = sn_gmsh_cut_face(type->corners, node, part);
    }
    for (int k = 0; k < count * parts; k++) {
        SN_TRY(
            grow(&r->lists.faces, r->lists.face_count, &r->face_capacity, sizeof *r->lists.faces));
        sn_gmsh_face *face = &r->lists.faces[r->lists.face_count++];
        memcpy(face->node, part[k % parts], sizeof part[0]);
        face->group = groups[k / parts];
        r->lists.groups[face->group].count++;
    }
    return SN_OK;
}

// What is left of an element's line: its nodes. It goes into every group of the list.
static sn_status read_element(reader *r, const sn_gmsh_element *type, int count,
                              const int *groups) {
    return type->kind == SN_GMSH_CELL ? add_cell(r, type, groups[0])
                                      : add_face(r, type, count, groups);
}

// tag, type, number of tags, the physical and other tags, nodes
static sn_status read_elements_22(reader *r, int count) {
    sn_gmsh_scan *scan = &r->scan;
    for (int e = 0; e < count; e++) {
        const sn_gmsh_element *type;
        long long tag, tags, physical = 0, other;
        SN_TRY(sn_gmsh_line(scan, "an element (fewer elements than declared)"));
        SN_TRY(sn_gmsh_integer(scan, "the tag of an element", 1, LLONG_MAX, &tag));
        SN_TRY(read_type(r, &type));
        if (type->kind == SN_GMSH_SKIPPED) continue;
        SN_TRY(sn_gmsh_integer(scan, "the number of tags", 0, INT_MAX, &tags));
        if (tags > 0) SN_TRY(sn_gmsh_integer(scan, "a physical tag", -INT_MAX, INT_MAX, &physical));
        for (long long i = 1; i < tags; i++)
            SN_TRY(sn_gmsh_integer(scan, "a tag", INT_MIN, INT_MAX, &other));
        int found = 0, groups = type->kind == SN_GMSH_CELL || physical != 0;
        if (groups) SN_TRY(find_group(r, type->dimension, physical, &found));
        SN_TRY(read_element(r, type, groups, &found));
    }
    return SN_OK;
}

// The groups of the entity of a block of elements.
static sn_status block_groups(reader *r, int dimension, long long tag, int *body, int *count,
                              const int **groups) {
    entity key = {.dimension = dimension, .tag = tag};
    const entity *found = NULL;
    if (r->entity_count)
        found = bsearch(&key, r->entities, (size_t)r->entity_count, sizeof *r->entities,
                        compare_entities);
    if (!found && r->has_entities)
        return sn_gmsh_fail(&r->scan, SN_E_SYNTAX,
                            "found entity %lld of dimension %d, expected one that $Entities lists",
                            tag, dimension);
    *count = found ? found->count : 0;
    *groups = *count ? r->groups_of + found->first : NULL;
    if (dimension == 3 && *count > 1)
        return sn_gmsh_fail(
            &r->scan, SN_E_MESH,
            "found volume %lld in %d physical volumes (\"%s\", \"%s\"), expected one: a "
            "cell has one tissue",
            tag, *count, r->lists.groups[(*groups)[0]].name, r->lists.groups[(*groups)[1]].name);
    if (dimension == 3 && *count == 0) {
        SN_TRY(find_group(r, 3, 0, body));
        *groups = body;
        *count = 1;
    }
    return SN_OK;
}

static sn_status read_elements_41(reader *r, long long blocks, int declared) {
    sn_gmsh_scan *scan = &r->scan;
    int done = 0;
    for (long long b = 0; b < blocks; b++) {
        const sn_gmsh_element *type;
        long long dimension, tag, element;
        int count = 0, group_count = 0, body = 0;
        const int *groups = NULL;
        SN_TRY(sn_gmsh_line(scan, "a block of elements (fewer blocks than declared)"));
        SN_TRY(sn_gmsh_integer(scan, "the dimension of an entity, 0 to 3", 0, 3, &dimension));
        SN_TRY(sn_gmsh_integer(scan, "the tag of an entity", INT_MIN, INT_MAX, &tag));
        SN_TRY(read_type(r, &type));
        SN_TRY(read_count(r, "a number of elements", ELEMENT_BYTES, &count));
        SN_TRY(sn_gmsh_line_end(scan, "four numbers of a block"));
        if (count > declared - done)
            return sn_gmsh_fail(scan, SN_E_SYNTAX,
                                "found %d elements in this block, expected at most %d: %d are "
                                "declared in all",
                                count, declared - done, declared);
        if (type->dimension != dimension)
            return sn_gmsh_fail(
                scan, SN_E_SYNTAX,
                "found %s (type %d) in an entity of dimension %lld, expected one of "
                "dimension %d",
                type->name, type->number, dimension, type->dimension);
        if (dimension > 1)
            SN_TRY(block_groups(r, (int)dimension, tag, &body, &group_count, &groups));
        for (int e = 0; e < count; e++) {
            SN_TRY(sn_gmsh_line(scan, "an element (fewer elements than declared)"));
            SN_TRY(sn_gmsh_integer(scan, "the tag of an element", 1, LLONG_MAX, &element));
            if (type->kind != SN_GMSH_SKIPPED) SN_TRY(read_element(r, type, group_count, groups));
        }
        done += count;
    }
    if (done == declared) return SN_OK;
    return sn_gmsh_fail(scan, SN_E_SYNTAX,
                        "found %d elements in all blocks, expected the %d declared", done,
                        declared);
}

static sn_status read_elements(reader *r) {
    sn_gmsh_scan *scan = &r->scan;
    if (!sn_gmsh_enter(scan, "$Elements"))
        return sn_fail(SN_E_SYNTAX, "%s: found no $Elements, expected them", scan->path);
    SN_TRY(sn_gmsh_line(scan, "the number of elements"));
    long long blocks = 0, bound;
    int count = 0;
    if (r->version == 41)
        SN_TRY(sn_gmsh_integer(scan, "the number of blocks", 0, LLONG_MAX, &blocks));
    SN_TRY(read_count(r, "a number of elements", ELEMENT_BYTES, &count));
    for (int i = 0; r->version == 41 && i < 2; i++)
        SN_TRY(sn_gmsh_integer(scan, "the least and the largest tag", 0, LLONG_MAX, &bound));
    SN_TRY(sn_gmsh_line_end(scan, r->version == 41 ? "four numbers" : "the number of elements"));
    SN_TRY(r->version == 41 ? read_elements_41(r, blocks, count) : read_elements_22(r, count));
    if (!r->lists.cell_count)
        return sn_gmsh_fail(
            scan, SN_E_MESH,
            "found no tetrahedra or other cells, expected some: mesh in 3D, and where physical "
            "groups are defined, define a Physical Volume too or save with "
            "-save_all");
    return sn_gmsh_leave(scan);
}

//---- all -----------------------------------------------------------------------------------------

static sn_status read_all(reader *r, const char *path, sn_mesh **mesh) {
    SN_TRY(sn_gmsh_open(path, &r->scan, &r->version));
    SN_TRY(read_names(r));
    if (r->version == 41) SN_TRY(read_entities(r));
    SN_TRY(read_nodes(r));
    SN_TRY(read_elements(r));
    sn_gmsh_close(&r->scan); // the text is as large as the mesh
    return sn_gmsh_build(&r->lists, path, mesh);
}

sn_status sn_mesh_read_gmsh(const char *path, double scale, sn_mesh **mesh) {
    *mesh = NULL;
    if (!(scale > 0) || !isfinite(scale))
        return sn_fail(SN_E_RANGE, "%s: found a scale of %g, expected a number above 0", path,
                       scale);
    reader r = {.scale = scale};
    sn_status status = read_all(&r, path, mesh);
    sn_gmsh_close(&r.scan);
    sn_free(r.entities);
    sn_free(r.groups_of);
    sn_free(r.marks);
    sn_gmsh_lists_free(&r.lists);
    return status;
}
