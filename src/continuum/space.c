// The discrete body: nodes with midsides, cells in batches, surfaces, which motions are prescribed.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/space.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

int sn_fe_space_midside(const sn_fe_space *s, int a, int b) {
    int first = a < b ? a : b, second = a < b ? b : a;
    int low = s->edge_at[first], high = s->edge_at[first + 1];
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (s->edge[2 * middle + 1] <= second)
            low = middle;
        else
            high = middle;
    }
    SN_ASSERT(s->edge[2 * low] == first && s->edge[2 * low + 1] == second);
    return s->corners + low;
}

void sn_fe_cell_nodes(const sn_fe_space *s, const sn_mesh *mesh, int cell, int *node) {
    const int *corner = mesh->cell + 4 * cell;
    for (int a = 0; a < 4; a++) node[a] = corner[a];
    for (int a = 4; a < s->element.nodes; a++)
        node[a] = sn_fe_space_midside(s, corner[sn_fe_cell_edge[a - 4][0]],
                                      corner[sn_fe_cell_edge[a - 4][1]]);
}

//---- nodes --------------------------------------------------------------------------------------

static sn_status make_nodes(sn_fe_space *s, const sn_mesh *mesh) {
    s->corners = s->nodes = mesh->node_count;
    s->cells = mesh->cell_count;
    if (s->element.nodes == 10) {
        SN_TRY(sn_mesh_edges(mesh, &s->edge, &s->edge_count));
        s->edge_at = sn_alloc((size_t)s->corners + 1, sizeof *s->edge_at);
        if (!s->edge_at) return SN_E_MEMORY;
        for (int e = 0; e < s->edge_count; e++) s->edge_at[s->edge[2 * e] + 1]++;
        for (int a = 0; a < s->corners; a++) s->edge_at[a + 1] += s->edge_at[a];
        s->nodes += s->edge_count;
    }
    if (s->nodes > 500000000 / 3)
        return sn_fail(SN_E_RANGE, "the mesh gives %d nodes, more than 32-bit indices hold",
                       s->nodes);
    s->dofs = 3 * s->nodes + (s->element.mixed ? s->corners : 0);
    s->rest = sn_alloc(3 * (size_t)s->nodes, sizeof *s->rest);
    if (!s->rest) return SN_E_MEMORY;
    memcpy(s->rest, mesh->node, 3 * (size_t)s->corners * sizeof *s->rest);
    for (int e = 0; e < s->edge_count; e++)
        for (int i = 0; i < 3; i++)
            s->rest[3 * (s->corners + e) + i] =
                0.5 * (mesh->node[3 * s->edge[2 * e] + i] + mesh->node[3 * s->edge[2 * e + 1] + i]);
    return SN_OK;
}

//---- cells --------------------------------------------------------------------------------------

// Gradients of the barycentric coordinates in material axes (NULL: of space), and the volume.
static double cell_gradients(const sn_mesh *mesh, int cell, const double *axes, double g[4][3]) {
    const double *x[4];
    double side[3][3], raw[4][3];
    for (int k = 0; k < 4; k++) x[k] = mesh->node + 3 * mesh->cell[4 * cell + k];
    for (int k = 0; k < 3; k++) sub3(x[k + 1], x[0], side[k]);
    for (int k = 0; k < 3; k++) cross3(side[(k + 1) % 3], side[(k + 2) % 3], raw[k + 1]);
    double six = 0.0;
    for (int i = 0; i < 3; i++) six += side[0][i] * raw[1][i];
    for (int i = 0; i < 3; i++) raw[0][i] = -(raw[1][i] + raw[2][i] + raw[3][i]);
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++) {
            double v = 0.0;
            for (int j = 0; j < 3 && axes; j++) v += axes[3 * i + j] * raw[k][j];
            g[k][i] = (axes ? v : raw[k][i]) / six;
        }
    return six / 6.0;
}

static void place_cell(sn_fe_space *s, const sn_mesh *mesh, const double *field, int batch, int at,
                       int cell) {
    int width = s->batch_cells;
    if (field)
        memcpy(s->turned + 9 * (size_t)(batch * width + at), field + 9 * (size_t)cell,
               9 * sizeof *field);
    double g[4][3];
    s->slot[batch * width + at] = cell;
    const double *axes = s->rotated ? sn_fe_axes(s, batch, at) : NULL;
    s->volume[batch * width + at] = cell_gradients(mesh, cell, axes, g);
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++)
            s->gradient[((size_t)batch * 12 + (size_t)(3 * k + i)) * (size_t)width + (size_t)at] =
                g[k][i];
    int *node = s->node + (size_t)batch * (size_t)(s->element.nodes * width);
    int of[SN_FE_NODES];
    sn_fe_cell_nodes(s, mesh, cell, of);
    for (int a = 0; a < s->element.nodes; a++) node[a * width + at] = of[a];
}

static sn_status alloc_batches(sn_fe_space *s, bool turned) {
    size_t batches = (size_t)s->batches, places = batches * (size_t)s->batch_cells;
    s->batch_region = sn_alloc(batches, sizeof *s->batch_region);
    s->batch_count = sn_alloc(batches, sizeof *s->batch_count);
    s->slot = sn_alloc(places, sizeof *s->slot);
    s->node = sn_alloc(places * (size_t)s->element.nodes, sizeof *s->node);
    s->gradient = sn_alloc(places * 12, sizeof *s->gradient);
    s->volume = sn_alloc(places, sizeof *s->volume);
    bool good = s->batch_region && s->batch_count && s->slot && s->node && s->gradient && s->volume;
    if (good && turned) good = (s->turned = sn_alloc(9 * places, sizeof *s->turned)) != NULL;
    return good ? SN_OK : SN_E_MEMORY;
}

// field: axes of the cells of the mesh, NULL where all have s->axes
static sn_status make_batches(sn_fe_space *s, const sn_mesh *mesh, const double *field) {
    int width = s->batch_cells = SN_FE_POINTS / s->element.points;
    int *size = sn_alloc((size_t)mesh->region_count, sizeof *size);
    int *open = sn_alloc((size_t)mesh->region_count, sizeof *open); // batch being filled
    sn_status status = size && open ? SN_OK : SN_E_MEMORY;
    if (status != SN_OK) goto fail;
    for (int c = 0; c < mesh->cell_count; c++)
        size[mesh->region[c]] += sn_fe_cell_is_near(s->ranks, c);
    for (int r = 0; r < mesh->region_count; r++) {
        open[r] = s->batches;
        s->batches += (size[r] + width - 1) / width;
    }
    SN_TRY_GOTO(status, alloc_batches(s, field != NULL));
    for (int c = 0; c < mesh->cell_count; c++) {
        int region = mesh->region[c], batch = open[region];
        if (!sn_fe_cell_is_near(s->ranks, c)) continue;
        s->batch_region[batch] = region;
        place_cell(s, mesh, field, batch, s->batch_count[batch], c);
        if (++s->batch_count[batch] == width) open[region]++;
    }
    for (int b = 0; b < s->batches; b++)
        for (int at = s->batch_count[b]; at < width; at++)
            place_cell(s, mesh, field, b, at, s->slot[b * width + s->batch_count[b] - 1]);
fail:
    sn_free(size);
    sn_free(open);
    return status;
}

//---- surfaces -----------------------------------------------------------------------------------

void sn_fe_faces_free(sn_fe_faces *faces) {
    sn_free(faces->node);
    sn_free(faces->area);
    *faces = (sn_fe_faces){0};
}

sn_status sn_fe_faces_of(const sn_fe_space *s, const sn_mesh *mesh, int surface, sn_fe_faces *out) {
    const sn_surface *from = mesh->surface + surface;
    int width = s->element.face_nodes;
    *out = (sn_fe_faces){.count = from->face_count};
    out->node = sn_alloc((size_t)from->face_count * (size_t)width, sizeof *out->node);
    out->area = sn_alloc((size_t)from->face_count, sizeof *out->area);
    if (!out->node || !out->area) {
        sn_fe_faces_free(out);
        return SN_E_MEMORY;
    }
    for (int f = 0; f < from->face_count; f++) {
        const int *corner = from->face + 3 * f;
        int *node = out->node + f * width;
        double side[2][3], normal[3];
        for (int a = 0; a < 3; a++) node[a] = corner[a];
        for (int a = 3; a < width; a++)
            node[a] = sn_fe_space_midside(s, corner[sn_fe_face_edge[a - 3][0]],
                                          corner[sn_fe_face_edge[a - 3][1]]);
        for (int k = 0; k < 2; k++)
            sub3(s->rest + 3 * corner[k + 1], s->rest + 3 * corner[0], side[k]);
        cross3(side[0], side[1], normal);
        out->area[f] =
            0.5 * sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    }
    return SN_OK;
}

sn_status sn_fe_surface_nodes(const sn_fe_space *s, const sn_mesh *mesh, int surface, int **nodes,
                              int *count) {
    sn_fe_faces faces = {0};
    SN_TRY(sn_fe_faces_of(s, mesh, surface, &faces));
    bool *seen = sn_alloc((size_t)s->nodes, sizeof *seen);
    int total = 0;
    *nodes = NULL;
    *count = 0;
    if (seen) {
        for (int k = 0; k < faces.count * s->element.face_nodes; k++) {
            total += !seen[faces.node[k]];
            seen[faces.node[k]] = true;
        }
        *nodes = sn_alloc((size_t)total, sizeof **nodes);
    }
    if (*nodes)
        for (int a = 0; a < s->nodes; a++)
            if (seen[a]) (*nodes)[(*count)++] = a;
    sn_free(seen);
    sn_fe_faces_free(&faces);
    return *nodes ? SN_OK : SN_E_MEMORY;
}

//---- prescribed motion --------------------------------------------------------------------------

static sn_status fix_midsides(sn_fe_space *s, const sn_mesh *mesh, int surface,
                              unsigned char bits) {
    int *nodes = NULL, count = 0;
    SN_TRY(sn_fe_surface_nodes(s, mesh, surface, &nodes, &count));
    for (int k = 0; k < count; k++)
        if (nodes[k] >= s->corners) s->fixed[nodes[k]] |= bits;
    sn_free(nodes);
    return SN_OK;
}

static sn_status make_fixed(sn_fe_space *s, const sn_case *c) {
    s->fixed = sn_alloc((size_t)s->nodes, 1);
    double *value = sn_alloc(3 * (size_t)s->corners, sizeof *value);
    if (!s->fixed || !value) {
        sn_free(value);
        return SN_E_MEMORY;
    }
    sn_case_prescribed(c, 0.0, s->fixed, value);
    sn_free(value);
    for (int k = 0; k < c->support_count && s->edge_count; k++) {
        const sn_support *p = c->support + k;
        unsigned bits = (p->fix[0] ? 1u : 0u) | (p->fix[1] ? 2u : 0u) | (p->fix[2] ? 4u : 0u);
        SN_TRY(fix_midsides(s, c->mesh, p->surface, (unsigned char)bits));
    }
    for (int k = 0; k < c->load_count && s->edge_count; k++) {
        const sn_load *p = c->load + k;
        if (p->kind != SN_LOAD_DISPLACEMENT) continue;
        unsigned bits = (p->free[0] ? 0u : 1u) | (p->free[1] ? 0u : 2u) | (p->free[2] ? 0u : 4u);
        SN_TRY(fix_midsides(s, c->mesh, p->surface, (unsigned char)bits));
    }
    return SN_OK;
}

void sn_fe_space_prescribed(const sn_fe_space *s, const sn_case *c, double t, double *value) {
    // which directions are fixed does not change with time: the same bytes are written again
    sn_case_prescribed(c, t, s->fixed, value);
    for (int e = 0; e < s->edge_count; e++) {
        int node = s->corners + e;
        for (int i = 0; i < 3; i++)
            if (s->fixed[node] >> i & 1)
                value[3 * node + i] =
                    0.5 * (value[3 * s->edge[2 * e] + i] + value[3 * s->edge[2 * e + 1] + i]);
    }
}

//---- life ---------------------------------------------------------------------------------------

void sn_fe_space_destroy(sn_fe_space *s) {
    if (!s) return;
    void *const parts[] = {s->rest,        s->edge,  s->edge_at, s->batch_region,
                           s->batch_count, s->slot,  s->node,    s->gradient,
                           s->volume,      s->fixed, s->turned};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_fe_ranks_destroy(s->ranks);
    sn_free(s);
}

sn_status sn_fe_space_create(const sn_case *c, sn_fe_space **space) {
    sn_status status = SN_OK;
    double *field = NULL;
    sn_fe_space *s = *space = sn_alloc(1, sizeof *s);
    if (!s) return SN_E_MEMORY;
    sn_fe_element_init(c->continuum.element, &s->element);
    for (int r = 0; r < c->mesh->region_count; r++) s->rotated |= c->tissue[r].law->fibres;
    SN_TRY_GOTO(status, sn_case_axes_field(c, s->axes, &field));
    SN_TRY_GOTO(status, make_nodes(s, c->mesh));
    SN_TRY_GOTO(status, sn_fe_ranks_create(c->mesh, s, &s->ranks));
    SN_TRY_GOTO(status, sn_fe_agree(s->ranks, make_batches(s, c->mesh, field)));
    SN_TRY_GOTO(status, make_fixed(s, c));
    sn_free(field);
    return SN_OK;
fail:
    sn_free(field);
    sn_fe_space_destroy(s);
    *space = NULL;
    return status;
}
