// The elements of Gmsh, and how faces and cells are cut into triangles and tetrahedra.
// SPDX-License-Identifier: Apache-2.0
//
// Source: Dompierre, Labbe, Vallet & Camarero, How to subdivide pyramids, prisms and hexahedra into
// tetrahedra, Proc. 8th Int. Meshing Roundtable (1999) 195.
//
// A quadrangle is cut along the diagonal through its smallest node, so that two cells that share it
// cut it alike, and so does a surface that lies on it. A cell is cut into the cones from its own
// smallest node over the triangles of the faces that do not hold that node: the faces that do are
// then cut through it, which is their own rule too. Pyramids give two, prisms three, hexahedra six
// tetrahedra; no node is added.
#include "io/gmsh_element.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

// What is not listed is refused.
static const sn_gmsh_element elements[] = {
    {15, SN_GMSH_SKIPPED, 0, 1, 0, "points"},
    {1, SN_GMSH_SKIPPED, 1, 2, 0, "lines"},
    {8, SN_GMSH_SKIPPED, 1, 3, 0, "lines"},
    {2, SN_GMSH_FACE, 2, 3, 3, "triangles"},
    {9, SN_GMSH_FACE, 2, 6, 3, "triangles"},
    {3, SN_GMSH_FACE, 2, 4, 4, "quadrangles"},
    {16, SN_GMSH_FACE, 2, 8, 4, "quadrangles"},
    {10, SN_GMSH_FACE, 2, 9, 4, "quadrangles"},
    {4, SN_GMSH_CELL, 3, 4, 4, "tetrahedra"},
    {11, SN_GMSH_CELL, 3, 10, 4, "tetrahedra"},
    {5, SN_GMSH_CELL, 3, 8, 8, "hexahedra"},
    {17, SN_GMSH_CELL, 3, 20, 8, "hexahedra"},
    {12, SN_GMSH_CELL, 3, 27, 8, "hexahedra"},
    {6, SN_GMSH_CELL, 3, 6, 6, "prisms"},
    {18, SN_GMSH_CELL, 3, 15, 6, "prisms"},
    {13, SN_GMSH_CELL, 3, 18, 6, "prisms"},
    {7, SN_GMSH_CELL, 3, 5, 5, "pyramids"},
    {19, SN_GMSH_CELL, 3, 13, 5, "pyramids"},
    {14, SN_GMSH_CELL, 3, 14, 5, "pyramids"},
    {26, SN_GMSH_REFUSED, 1, 0, 0, "lines of third order"},
    {21, SN_GMSH_REFUSED, 2, 0, 0, "triangles of third order"},
    {29, SN_GMSH_REFUSED, 3, 0, 0, "tetrahedra of third order"},
};

const sn_gmsh_element *sn_gmsh_element_find(long long number) {
    for (size_t k = 0; k < sizeof elements / sizeof *elements; k++)
        if (elements[k].number == number) return elements + k;
    return NULL;
}

// Faces with outward normals by the right-hand rule.
typedef struct solid {
    int corners, faces;
    int size[6], face[6][4];
} solid;

static const solid solids[] = {
    {4, 4, {3, 3, 3, 3}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}},
    {5, 5, {4, 3, 3, 3, 3}, {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
    {6, 5, {3, 3, 4, 4, 4}, {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
    {8,
     6,
     {4, 4, 4, 4, 4, 4},
     {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
};

int sn_gmsh_cut_face(int corners, const int *node, int part[2][3]) {
    int least = 0;
    for (int k = 1; k < corners; k++)
        if (node[k] < node[least]) least = k;
    for (int t = 0; t < corners - 2; t++) {
        part[t][0] = node[least];
        for (int k = 1; k < 3; k++) part[t][k] = node[(least + t + k) % corners];
    }
    return corners - 2;
}

int sn_gmsh_cut_cell(int corners, const int *node, int part[SN_GMSH_PARTS][4]) {
    const solid *s = solids;
    int least = node[0], parts = 0;
    if (corners == 4) { // as it stands
        memcpy(part[0], node, sizeof part[0]);
        return 1;
    }
    while (s->corners != corners) s++;
    for (int k = 1; k < corners; k++) least = node[k] < least ? node[k] : least;
    for (int f = 0; f < s->faces; f++) {
        int on[4], triangle[2][3];
        bool holds = false;
        for (int k = 0; k < s->size[f]; k++) {
            on[k] = node[s->face[f][k]];
            holds |= on[k] == least;
        }
        if (holds) continue;
        int triangles = sn_gmsh_cut_face(s->size[f], on, triangle);
        for (int t = 0; t < triangles; t++, parts++) {
            part[parts][0] = least;
            memcpy(part[parts] + 1, triangle[t], sizeof triangle[t]);
        }
    }
    return parts;
}
