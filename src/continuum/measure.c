// What a run hands out: fields, a row of the history, energies.
// SPDX-License-Identifier: Apache-2.0
#include "continuum/measure.h"

#include <math.h>
#include <string.h>

enum { N = SN_FE_POINTS };

static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
static const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

//---- fields -------------------------------------------------------------------------------------

// R^T a R for symmetric a: from material axes to space.
static void turn(const double *R, double a[6]) {
    double out[6];
    for (int k = 0; k < 6; k++) {
        out[k] = 0.0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                out[k] += R[3 * i + pair[k][0]] * a[sym[i][j]] * R[3 * j + pair[k][1]];
    }
    memcpy(a, out, sizeof out);
}

// Cauchy stress F S F^T / J of point n.
static void cauchy(const sn_fe_points *p, int n, double out[6]) {
    double F[3][3], FS[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) F[i][j] = p->M[(3 * i + j) * N + n] + (i == j ? 1.0 : 0.0);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            FS[i][j] = 0.0;
            for (int k = 0; k < 3; k++) FS[i][j] += F[i][k] * p->S[sym[k][j] * N + n];
        }
    for (int c = 0; c < 6; c++) {
        const double *a = FS[pair[c][0]], *b = F[pair[c][1]];
        out[c] = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / (1.0 + p->J1[n]);
    }
}

// Roots of the eigenvalues of C = 1 + 2 E at point n, the largest first. The trigonometric solution
// of the characteristic equation, scaled by E so that small strains keep their digits.
// Source: Smith, Comm. ACM 4 (1961) 168.
static void stretches(const sn_fe_points *p, int n, double out[3]) {
    double e[6], mean = 0.0, size = 0.0;
    for (int k = 0; k < 6; k++) e[k] = p->E[k * N + n];
    for (int k = 0; k < 3; k++) mean += e[k] / 3.0;
    for (int k = 0; k < 3; k++) {
        e[k] -= mean;
        size += e[k] * e[k] + 2.0 * e[3 + k] * e[3 + k];
    }
    size = sqrt(size / 6.0);
    double det = e[0] * (e[1] * e[2] - e[4] * e[4]) - e[3] * (e[3] * e[2] - e[4] * e[5]) +
                 e[5] * (e[3] * e[4] - e[1] * e[5]);
    double half = size > 0.0 ? det / (2.0 * size * size * size) : 0.0;
    double angle = acos(fmax(-1.0, fmin(1.0, half))) / 3.0;
    for (int k = 0; k < 3; k++) {
        double value = mean + 2.0 * size * cos(angle - 2.0 * k * acos(-1.0) / 3.0);
        out[k] = sqrt(fmax(0.0, 1.0 + 2.0 * value));
    }
    double middle = out[2]; // the order of the angles is largest, middle, smallest
    out[2] = fmin(out[1], out[2]);
    out[1] = fmax(out[1], middle);
}

// Averages of one cell; `extra` is the mean of -tr(sigma)/3 without the unknown pressure.
static void average_cell(const sn_fe_problem *p, int batch, int at, sn_fe_measure *m,
                         double *extra) {
    const sn_fe_space *s = p->space;
    const sn_fe_points *v = &p->work->points;
    int cell = s->slot[batch * s->batch_cells + at];
    double strain[6] = {0}, stress[6] = {0}, reference[6] = {0}, stretch[3] = {0}, energy = 0.0;
    *extra = 0.0;
    for (int q = 0; q < s->element.points; q++) {
        int n = q * s->batch_cells + at;
        double w = s->element.weight[q], sigma[6], at_point[3];
        cauchy(v, n, sigma);
        stretches(v, n, at_point);
        for (int k = 0; k < 6; k++) {
            strain[k] += w * v->E[k * N + n];
            stress[k] += w * sigma[k];
            reference[k] += w * v->S[k * N + n];
        }
        for (int k = 0; k < 3; k++) stretch[k] += w * at_point[k];
        energy += w * v->W[n];
        *extra -= w * ((sigma[0] + sigma[1] + sigma[2]) / 3.0 - (s->element.mixed ? v->p[n] : 0.0));
    }
    const double *axes = s->rotated ? sn_fe_axes(s, batch, at) : NULL;
    double *const tensors[] = {strain, stress, reference};
    for (int k = 0; axes && k < 3; k++) turn(axes, tensors[k]);
    memcpy(m->reference + 6 * cell, reference, sizeof reference);
    memcpy(m->stretch + 3 * cell, stretch, sizeof stretch);
    memcpy(m->strain + 6 * cell, strain, sizeof strain);
    memcpy(m->stress + 6 * cell, stress, sizeof stress);
    m->energy[cell] = energy;
}

void sn_fe_measure_fill(sn_fe_measure *m, const sn_fe_problem *p, const double *x) {
    const sn_fe_space *s = p->space;
    int width = s->batch_cells;
    sn_fe_fault fault;
    memcpy(m->displacement, x, 3 * (size_t)s->corners * sizeof *x);
    memset(m->pressure, 0, (size_t)s->corners * sizeof *m->pressure);
    for (int b = 0; b < s->batches; b++) {
        const int *node = s->node + (size_t)b * (size_t)(s->element.nodes * width);
        bool good = sn_fe_points_at(s, p->materials, b, x, SN_FE_ENERGY, &p->work->points, &fault);
        SN_ASSERT(good);
        (void)good;
        for (int at = 0; at < s->batch_count[b]; at++) {
            double extra;
            average_cell(p, b, at, m, &extra);
            for (int k = 0; k < 4; k++)
                m->pressure[node[k * width + at]] += 0.25 * s->volume[b * width + at] * extra;
        }
    }
    sn_fe_gather_corners(s, m->pressure);
    sn_fe_gather_cells(s->ranks, 6, m->strain);
    sn_fe_gather_cells(s->ranks, 6, m->stress);
    sn_fe_gather_cells(s->ranks, 6, m->reference);
    sn_fe_gather_cells(s->ranks, 3, m->stretch);
    sn_fe_gather_cells(s->ranks, 1, m->energy);
    for (int a = 0; a < s->corners; a++) {
        m->pressure[a] /= p->flux_scale[a];
        if (s->element.mixed) m->pressure[a] -= x[3 * s->nodes + a];
    }
}

sn_status sn_fe_measure_emit(sn_fe_measure *m, const sn_fe_problem *p, const sn_output *output) {
    sn_field fields[9] = {
        {"displacement", "m", SN_ON_NODES, 3, m->displacement},
        {"pressure", "Pa", SN_ON_NODES, 1, m->pressure},
        {"green_strain", "1", SN_ON_CELLS, 6, m->strain},
        {"cauchy_stress", "Pa", SN_ON_CELLS, 6, m->stress},
        {"energy_density", "J/m3", SN_ON_CELLS, 1, m->energy},
        {"second_pk_stress", "Pa", SN_ON_CELLS, 6, m->reference},
        {"principal_stretches", "1", SN_ON_CELLS, 3, m->stretch},
    };
    int count = 7;
    if (p->inertia) // corners first
        fields[count++] = (sn_field){"velocity", "m/s", SN_ON_NODES, 3, p->inertia->v};
    if (p->space->rotated) fields[count++] = (sn_field){"fibre", "1", SN_ON_CELLS, 3, m->fibre};
    const sn_frame frame = {p->level.time, count, fields};
    bool first = p->space->ranks->rank == 0;
    return sn_fe_agree(p->space->ranks, first ? output->frame(output->context, &frame) : SN_OK);
}

sn_status sn_fe_measure_frame(sn_fe_measure *m, const sn_fe_problem *p, const double *x,
                              const sn_output *output) {
    if (!m->fields) return SN_OK;
    sn_fe_measure_fill(m, p, x);
    return sn_fe_measure_emit(m, p, output);
}

double sn_fe_measure_energy(const sn_fe_problem *p, const double *x) {
    const sn_fe_space *s = p->space;
    sn_fe_fault fault;
    double sum = 0.0;
    for (int b = 0; b < s->batches && !isnan(sum); b++) {
        const sn_fe_points *v = &p->work->points;
        if (!sn_fe_points_at(s, p->materials, b, x, SN_FE_ENERGY, &p->work->points, &fault))
            sum = (double)NAN;
        for (int q = 0; q < s->element.points && !isnan(sum); q++)
            for (int at = 0; at < s->batch_count[b]; at++)
                if (sn_fe_cell_is_own(s->ranks, s->slot[b * s->batch_cells + at]))
                    sum += v->weight[q * s->batch_cells + at] * v->W[q * s->batch_cells + at];
    }
    return sn_fe_sum(s->ranks, sum);
}

//---- history ------------------------------------------------------------------------------------

sn_status sn_fe_measure_row(sn_fe_measure *m, const sn_fe_problem *p, const double *x,
                            sn_record *history) {
    const sn_fe_space *s = p->space;
    double *to = m->row;
    *to++ = p->level.time;
    for (int k = 0; k < p->c->probe_count; k++, to += 3) {
        to[0] = to[1] = to[2] = 0.0;
        for (int r = 0; r < m->reaction_count[k]; r++)
            for (int i = 0; i < 3; i++) to[i] += p->residual[3 * m->reaction[k][r] + i];
        if (p->c->probe[k].kind != SN_PROBE_POINT) continue;
        double shape[SN_FE_NODES];
        sn_fe_cell_shape(s->element.nodes, m->point_weight[k], shape);
        for (int a = 0; a < s->element.nodes; a++)
            for (int i = 0; i < 3; i++) to[i] += shape[a] * x[3 * m->point_node[k][a] + i];
    }
    for (int k = 0; k < p->c->tool_count; k++)
        for (int i = 0; i < 3; i++) *to++ = p->boundary->tool_force[k][i];
    SN_ASSERT(to - m->row == m->columns);
    return sn_record_append(history, m->row);
}

static sn_status find_probes(const sn_fe_problem *p, sn_fe_measure *m) {
    const sn_case *c = p->c;
    for (int k = 0; k < c->probe_count; k++) {
        const sn_probe *probe = c->probe + k;
        if (probe->kind == SN_PROBE_REACTION) {
            SN_TRY(sn_fe_surface_nodes(p->space, c->mesh, probe->surface, m->reaction + k,
                                       m->reaction_count + k));
            continue;
        }
        int cell;
        sn_status status = sn_mesh_locate(c->mesh, probe->point, &cell, m->point_weight[k]);
        if (status != SN_OK) return sn_fail_within(status, "probe \"%s\"", probe->name);
        sn_fe_cell_nodes(p->space, c->mesh, cell, m->point_node[k]);
    }
    return SN_OK;
}

// The fibre at rest, 0 in cells without.
static void fill_fibres(const sn_fe_problem *p, double *fibre) {
    const sn_fe_space *s = p->space;
    for (int b = 0; b < s->batches && s->rotated; b++)
        for (int at = 0; at < s->batch_count[b]; at++)
            if (p->c->tissue[s->batch_region[b]].law->fibres)
                memcpy(fibre + 3 * (size_t)s->slot[b * s->batch_cells + at], sn_fe_axes(s, b, at),
                       3 * sizeof *fibre);
}

void sn_fe_measure_destroy(sn_fe_measure *m, const sn_case *c) {
    if (!m) return;
    for (int k = 0; m->reaction && k < c->probe_count; k++) sn_free(m->reaction[k]);
    void *const parts[] = {m->displacement, m->pressure,       m->strain,     m->stress,
                           m->reference,    m->stretch,        m->energy,     m->row,
                           m->reaction,     m->reaction_count, m->point_node, m->point_weight,
                           m->fibre};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) sn_free(parts[k]);
    sn_free(m);
}

sn_status sn_fe_measure_create(const sn_fe_problem *p, const sn_record *history, bool fields,
                               sn_fe_measure **out) {
    sn_status status = SN_E_MEMORY;
    size_t probes = (size_t)p->c->probe_count;
    size_t corners = fields ? (size_t)p->space->corners : 0;
    size_t cells = fields ? (size_t)p->c->mesh->cell_count : 0;
    sn_fe_measure *m = *out = sn_alloc(1, sizeof *m);
    if (!m) return SN_E_MEMORY;
    m->columns = history->series_count;
    m->fields = fields;
    m->displacement = sn_alloc(3 * corners, sizeof *m->displacement);
    m->pressure = sn_alloc(corners, sizeof *m->pressure);
    m->strain = sn_alloc(6 * cells, sizeof *m->strain);
    m->stress = sn_alloc(6 * cells, sizeof *m->stress);
    m->reference = sn_alloc(6 * cells, sizeof *m->reference);
    m->stretch = sn_alloc(3 * cells, sizeof *m->stretch);
    m->energy = sn_alloc(cells, sizeof *m->energy);
    m->fibre = sn_alloc(3 * cells, sizeof *m->fibre);
    m->row = sn_alloc((size_t)m->columns, sizeof *m->row);
    m->reaction = sn_alloc(probes, sizeof *m->reaction);
    m->reaction_count = sn_alloc(probes, sizeof *m->reaction_count);
    m->point_node = sn_alloc(probes, sizeof *m->point_node);
    m->point_weight = sn_alloc(probes, sizeof *m->point_weight);
    if (!m->displacement || !m->pressure || !m->strain || !m->stress || !m->reference ||
        !m->stretch || !m->energy || !m->fibre || !m->row || !m->reaction || !m->reaction_count ||
        !m->point_node || !m->point_weight)
        goto fail;
    if (fields) fill_fibres(p, m->fibre);
    if (fields) sn_fe_gather_cells(p->space->ranks, 3, m->fibre);
    SN_TRY_GOTO(status, find_probes(p, m));
    return SN_OK;
fail:
    sn_fe_measure_destroy(m, p->c);
    *out = NULL;
    return status;
}
