// Inertia: the consistent mass and the generalised-alpha method.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/inertia.h"

#include <math.h>
#include <string.h>

#define STIFFEST 20.0 // bulk over shear modulus whose waves are still of interest

//---- mass ---------------------------------------------------------------------------------------

// Corners of node a of a cell: one of a corner, the ends of a midside.
static void ends_of(int a, int end[2]) {
    end[0] = a < 4 ? a : sn_fe_cell_edge[a - 4][0];
    end[1] = a < 4 ? a : sn_fe_cell_edge[a - 4][1];
}

// int N_a N_b dV / V, from int lambda^(i j k l) dV / V = 6 i! j! k! l! / (i + j + k + l + 3)!.
static double overlap(int nodes, int a, int b) {
    if (nodes == 4) return a == b ? 0.1 : 0.05;
    int i[2], j[2];
    ends_of(a < b ? a : b, i);
    ends_of(a < b ? b : a, j);
    int shared = (i[0] == j[0]) + (i[0] == j[1]) + (i[1] == j[0]) + (i[1] == j[1]);
    if (i[0] == i[1] && j[0] == j[1]) return (shared ? 6.0 : 1.0) / 420.0;
    if (i[0] == i[1]) return (shared ? -4.0 : -6.0) / 420.0;
    return (shared == 2 ? 32.0 : shared == 1 ? 16.0 : 8.0) / 420.0;
}

// out += M z for nodal vectors, on all ranks alike.
static void multiply(const sn_fe_inertia *m, const sn_fe_space *s, const double *z, double *out) {
    int width = s->batch_cells, nodes = s->element.nodes;
    for (int b = 0; b < s->batches; b++)
        for (int at = 0; at < s->batch_count[b]; at++) {
            const int *node = s->node + (size_t)b * (size_t)(nodes * width) + at;
            double mass = m->density[b] * s->volume[b * width + at];
            for (int k = 0; k < nodes; k++) {
                const double *by = m->mass_of_cell + k * nodes;
                double sum[3] = {0};
                for (int l = 0; l < nodes; l++)
                    for (int i = 0; i < 3; i++)
                        sum[i] += by[l] * z[3 * (size_t)node[l * width] + (size_t)i];
                for (int i = 0; i < 3; i++)
                    out[3 * (size_t)node[k * width] + (size_t)i] += mass * sum[i];
            }
        }
    sn_fe_gather_nodes(s, out);
}

static void assemble(sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p) {
    int nodes = s->element.nodes, blocks = p->cell_blocks;
    const sn_fe_matrix matrix = {.pattern = p, .space = s, .value = m->mass};
    for (int b = 0; b < s->batches; b++)
        for (int at = 0; at < s->batch_count[b]; at++) {
            const int place = b * s->batch_cells + at;
            const int *offset = p->offset + (size_t)place * (size_t)(blocks * blocks);
            double mass = m->density[b] * s->volume[place];
            for (int k = 0; k < nodes; k++)
                for (int l = 0; l < nodes; l++) {
                    double v = mass * m->mass_of_cell[k * nodes + l];
                    const double block[9] = {v, 0, 0, 0, v, 0, 0, 0, v};
                    sn_fe_matrix_add(&matrix, sn_fe_cell_block(s, b, at, k),
                                     sn_fe_cell_block(s, b, at, l), offset[k * blocks + l], block);
                }
        }
}

//---- life ---------------------------------------------------------------------------------------

void sn_fe_inertia_destroy(sn_fe_inertia *m) {
    if (!m) return;
    void *const parts[] = {m->density, m->mass,   m->u,       m->v,       m->a,    m->r,
                           m->next_a,  m->next_r, m->known_v, m->known_a, m->work, m->reaction};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(m);
}

static sn_status find_densities(const sn_case *c, const sn_fe_space *s, sn_fe_inertia *m) {
    for (int b = 0; b < s->batches; b++) {
        m->density[b] = c->tissue[s->batch_region[b]].density;
        if (!isfinite(m->density[b]))
            return sn_fail(SN_E_DEFINITION,
                           "region \"%s\": analysis: dynamic needs the tissue's density",
                           c->mesh->region_name[s->batch_region[b]]);
    }
    return SN_OK;
}

sn_status sn_fe_inertia_create(const sn_case *c, const sn_fe_space *s, const sn_fe_pattern *p,
                               sn_fe_inertia **out) {
    sn_status status = SN_E_MEMORY;
    sn_fe_inertia *m = *out = sn_alloc(1, sizeof *m);
    if (!m) return SN_E_MEMORY;
    int nodes = s->element.nodes;
    m->rho = c->continuum.rho_infinity;
    for (int a = 0; a < nodes; a++)
        for (int b = 0; b < nodes; b++) m->mass_of_cell[a * nodes + b] = overlap(nodes, a, b);
    double **const vectors[] = {&m->u,      &m->v,       &m->a,       &m->r,    &m->next_a,
                                &m->next_r, &m->known_v, &m->known_a, &m->work, &m->reaction};
    m->density = sn_alloc((size_t)s->batches, sizeof *m->density);
    m->mass = sn_alloc((size_t)p->row_start[p->rows], sizeof *m->mass);
    if (!m->density || !m->mass) goto fail;
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        if (!(*vectors[k] = sn_alloc(3 * (size_t)s->nodes, sizeof **vectors[k]))) goto fail;
    SN_TRY_GOTO(status, find_densities(c, s, m));
    assemble(m, s, p);
    return SN_OK;
fail:
    sn_fe_inertia_destroy(m);
    *out = NULL;
    return status;
}

//---- steps --------------------------------------------------------------------------------------

// Adds `by` times the prescribed displacements at time t, which are zero until time 0.
static void add_prescribed(sn_fe_inertia *m, const sn_case *c, const sn_fe_space *s, double t,
                           double by, double *out) {
    if (!(t > 0.0)) return;
    sn_fe_space_prescribed(s, c, t, m->work);
    for (int a = 0; a < s->nodes; a++)
        for (int d = 0; d < 3; d++)
            if (s->fixed[a] >> d & 1) out[3 * a + d] += by * m->work[3 * a + d];
}

void sn_fe_inertia_begin(sn_fe_inertia *m, const sn_case *c, const sn_fe_space *s, double t,
                         double h) {
    size_t bytes = 3 * (size_t)s->nodes * sizeof *m->u;
    double rho = m->rho;
    m->step = h;
    if (!(h > 0.0)) return;
    m->alpha_m = m->moving ? (2.0 * rho - 1.0) / (rho + 1.0) : 0.0;
    m->alpha_f = m->moving ? rho / (rho + 1.0) : 0.0;
    double lag = m->alpha_f - m->alpha_m;
    m->gamma = m->moving ? 0.5 + lag : 1.0;
    m->beta = m->moving ? 0.25 * (1.0 + lag) * (1.0 + lag) : 0.5;
    memset(m->known_v, 0, bytes);
    memset(m->known_a, 0, bytes);
    // the history may end at `until`: the last difference is one-sided, not one with a corner
    double middle = fmax(fmin(t, c->until - h), h);
    add_prescribed(m, c, s, middle + h, 1.0 / (h * h), m->known_a);
    add_prescribed(m, c, s, middle, -2.0 / (h * h), m->known_a);
    add_prescribed(m, c, s, middle - h, 1.0 / (h * h), m->known_a);
    add_prescribed(m, c, s, middle + h, 0.5 / h, m->known_v);
    add_prescribed(m, c, s, middle - h, -0.5 / h, m->known_v);
    for (int n = 0; n < 3 * s->nodes; n++) m->known_v[n] += (t - middle) * m->known_a[n];
}

double sn_fe_inertia_add(sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p,
                         const double *x, double *residual) {
    double h = m->step, square = 0.0, *acting = m->next_r;
    if (!(h > 0.0)) return 0.0;
    for (int n = 0; n < 3 * s->nodes; n++) {
        bool known = p->row[n] == SN_FE_PRESCRIBED;
        double before = m->alpha_m, path = x[n] - m->u[n] - h * m->v[n];
        m->next_a[n] = (path / (h * h) - (0.5 - m->beta) * m->a[n]) / m->beta;
        if (known) { // true accelerations, not those of the formulas, which lag behind the time
            m->next_a[n] = m->known_a[n];
            before = m->alpha_f;
        }
        m->work[n] = ((1.0 - before) * m->next_a[n] + before * m->a[n]) / (1.0 - m->alpha_f);
        acting[n] = 0.0;
    }
    multiply(m, s, m->work, acting);
    for (int n = 0; n < 3 * s->nodes; n++) {
        double r = residual[n];
        square += acting[n] * acting[n];
        residual[n] += acting[n] + m->alpha_f / (1.0 - m->alpha_f) * m->r[n];
        m->next_r[n] = r;
    }
    return sqrt(square);
}

void sn_fe_inertia_tangent(const sn_fe_inertia *m, const sn_fe_pattern *p, double *entry) {
    if (!(m->step > 0.0)) return;
    double by = (1.0 - m->alpha_m) / ((1.0 - m->alpha_f) * m->beta * m->step * m->step);
    for (int k = 0; k < p->row_start[p->rows]; k++) entry[k] += by * m->mass[k];
}

void sn_fe_inertia_judge(const sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p,
                         const double *x, double *error, double *way) {
    double change = 0.0, moved = 0.0, h = m->step;
    for (int n = 0; n < 3 * s->nodes; n++) {
        double by = m->next_a[n] - m->a[n];
        change += p->row[n] == SN_FE_PRESCRIBED ? 0.0 : by * by;
        moved += x[n] * x[n];
    }
    *error = m->moving ? (m->beta - 1.0 / 6.0) * h * h * sqrt(change / (3 * s->nodes)) : 0.0;
    *way = fmax(m->way, sqrt(moved / (3 * s->nodes)));
}

double sn_fe_inertia_transit(const sn_case *c, const sn_fe_space *s) {
    double least = (double)INFINITY;
    for (int b = 0; b < s->batches; b++) {
        const sn_tissue *tissue = c->tissue + s->batch_region[b];
        sn_moduli moduli;
        sn_tissue_moduli(tissue, &moduli);
        // waves of pressure in what hardly changes its volume are not what a step is to resolve
        double stiff = fmin(moduli.bulk, STIFFEST * moduli.shear) + 4.0 / 3.0 * moduli.shear;
        double speed = sqrt(stiff / tissue->density);
        for (int at = 0; at < s->batch_count[b]; at++)
            least = fmin(least, cbrt(6.0 * s->volume[b * s->batch_cells + at]) / speed);
    }
    return -sn_fe_largest(s->ranks, -least);
}

void sn_fe_inertia_commit(sn_fe_inertia *m, const sn_fe_space *s, const sn_fe_pattern *p,
                          const double *x, double *residual) {
    double h = m->step, lag = m->alpha_f - m->alpha_m, error;
    if (!(h > 0.0)) return;
    sn_fe_inertia_judge(m, s, p, x, &error, &m->way);
    m->error = fmax(m->error, error);
    memcpy(m->reaction, m->next_r, 3 * (size_t)s->nodes * sizeof *m->reaction);
    for (int n = 0; n < 3 * s->nodes; n++) {
        bool known = p->row[n] == SN_FE_PRESCRIBED;
        double a = m->next_a[n];
        // the formulas' a_{n+1} belongs to a time that is lag h earlier
        m->work[n] = known ? a : a + lag * (a - m->a[n]);
        m->v[n] = known ? m->known_v[n] : m->v[n] + h * ((1.0 - m->gamma) * m->a[n] + m->gamma * a);
        m->u[n] = x[n];
        m->a[n] = a;
        m->r[n] = m->next_r[n];
    }
    m->moving = true;
    multiply(m, s, m->work, m->reaction);
    for (int n = 0; n < 3 * s->nodes; n++)
        if (p->row[n] != SN_FE_PRESCRIBED) m->reaction[n] = 0.0;
    sn_fe_inertia_reactions(m, s, residual);
}

void sn_fe_inertia_reactions(const sn_fe_inertia *m, const sn_fe_space *s, double *residual) {
    memcpy(residual, m->reaction, 3 * (size_t)s->nodes * sizeof *residual);
}

double sn_fe_inertia_energy(sn_fe_inertia *m, const sn_fe_space *s) {
    double sum = 0.0;
    memset(m->work, 0, 3 * (size_t)s->nodes * sizeof *m->work);
    multiply(m, s, m->v, m->work);
    for (int n = 0; n < 3 * s->nodes; n++) sum += 0.5 * m->v[n] * m->work[n];
    return sum;
}
