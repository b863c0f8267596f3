// Faces of all cells, matched in pairs.
// SPDX-License-Identifier: Apache-2.0
//
// A face is known by its three nodes. Faces are kept in chains, one chain for every sum of three
// node numbers: no product, no sorting, and neighbours in space stay neighbours in memory. In a
// lattice a chain holds about four different faces.
#include "model/mesh.h"

// nodes of the face opposite node k, seen from outside
static const int corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

void sn_face_nodes(const sn_mesh *mesh, int face, int node[3]) {
    const int *v = mesh->cell + 4 * (size_t)(face / 4);
    for (int i = 0; i < 3; i++) node[i] = v[corner[face % 4][i]];
}

// three nodes in rising order
static void sorted(const int node[3], int out[3]) {
    int a = node[0], b = node[1], c = node[2];
    int low = a < b ? a : b, high = a < b ? b : a;
    out[0] = low < c ? low : c;
    out[2] = high > c ? high : c;
    out[1] = low < c ? (high < c ? high : c) : low;
}

static size_t chain_of(const int key[3]) {
    return (size_t)key[0] + (size_t)key[1] + (size_t)key[2];
}

// The first face of a chain with the nodes of `key`.
static int find_in_chain(const sn_mesh *mesh, const sn_faces *faces, const int key[3]) {
    for (int face = faces->head[chain_of(key)]; face >= 0; face = faces->next[face]) {
        int node[3], k[3];
        sn_face_nodes(mesh, face, node);
        sorted(node, k);
        if (k[0] == key[0] && k[1] == key[1] && k[2] == key[2]) return face;
    }
    return -1;
}

int sn_faces_find(const sn_mesh *mesh, const sn_faces *faces, const int node[3]) {
    int key[3];
    sorted(node, key);
    return find_in_chain(mesh, faces, key);
}

sn_status sn_faces_create(const sn_mesh *mesh, sn_faces *faces) {
    size_t chains = 3 * (size_t)mesh->node_count;
    int count = 4 * mesh->cell_count;
    *faces = (sn_faces){.other = sn_alloc((size_t)count, sizeof(int)),
                        .head = sn_alloc(chains, sizeof(int)),
                        .next = sn_alloc((size_t)count, sizeof(int))};
    if (!faces->other || !faces->head || !faces->next) return SN_E_MEMORY;
    for (size_t i = 0; i < chains; i++) faces->head[i] = -1;

    for (int face = 0; face < count; face++) {
        int node[3], key[3];
        sn_face_nodes(mesh, face, node);
        sorted(node, key);
        int twin = find_in_chain(mesh, faces, key);
        faces->other[face] = twin;
        if (twin < 0) { // the first of the two stays in the chain for both
            faces->next[face] = faces->head[chain_of(key)];
            faces->head[chain_of(key)] = face;
            continue;
        }
        if (faces->other[twin] >= 0)
            return sn_fail(
                SN_E_MESH,
                "cells %d, %d and %d (counted from 0) share the face of nodes %d %d %d: a "
                "face belongs to one cell or two; remove the cells that overlap",
                twin / 4, faces->other[twin] / 4, face / 4, key[0], key[1], key[2]);
        faces->other[twin] = face;
    }
    return SN_OK;
}

void sn_faces_destroy(sn_faces *faces) {
    sn_free(faces->other);
    sn_free(faces->head);
    sn_free(faces->next);
    *faces = (sn_faces){0};
}
