// Biaxial and shear tests: solids, incompressible or not, and membranes.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); incompressible: S = H[S_d] - p C^-1, H the hereditary
// integral, J = 1.
//
// The motions are driven by u, from 0 to 1 at constant speed. Nominal stresses:
//     biaxial, membrane:                      T_i = l_i H[S_ii],  i = 1, 2
//     biaxial, incompressible, l3 = 1/(l1 l2), whose free thickness gives p = l3^2 H[S33]:
//                                             T_i = l_i H[S_ii] - l3^2 H[S33]/l_i
//     biaxial, compressible: the thickness is solved for, lateral.c
//     simple shear g in the 1-2 plane:        T_12 = H[S12] + g H[S22]
// Simple shear keeps the volume and the thickness, so p drops out where the solid is incompressible
// and the volume stress is 0 at every instant where it is not: all three kinds share the line. The
// nominal stress is the true one: the sheared face keeps its area.
#include <math.h>

#include "lab/protocol/hereditary.h"
#include "lab/protocol/protocol.h"
#include "lab/protocol/refine.h"

static const double tolerance = 5e-8; // of the peak

typedef struct plane {
    const sn_tissue *tissue;
    bool shear;
    bool block;       // biaxial test of a compressible solid
    double target[2]; // stretches, or the shear strain
    const sn_path *path;
    const sn_exponentials *e; // of every part of the stress; of the one at hand in add_stress()
} plane;

// stretches at u, the third the thickness
static void stretches_at(const plane *p, double u, double l[3]) {
    for (int i = 0; i < 2; ++i) l[i] = 1.0 + (p->target[i] - 1.0) * u;
    l[2] = 1.0 / (l[0] * l[1]);
}

// Green strain and the rate of (E11, E22, E33, 2 E12, …) over u
static void strain_at(const plane *p, double u, double E[6], double rate[6]) {
    for (int i = 0; i < 6; ++i) E[i] = rate[i] = 0.0;
    if (p->shear) {
        double g = p->target[0] * u;
        E[1] = 0.5 * g * g;
        E[3] = 0.5 * g;
        rate[1] = g * p->target[0];
        rate[3] = p->target[0];
        return;
    }
    double l[3], dl[3] = {p->target[0] - 1.0, p->target[1] - 1.0, 0.0};
    stretches_at(p, u, l);
    dl[2] = -l[2] * (dl[0] / l[0] + dl[1] / l[1]);
    for (int i = 0; i < 3; ++i) {
        E[i] = 0.5 * (l[i] - 1.0) * (l[i] + 1.0);
        rate[i] = l[i] * dl[i];
    }
}

// place of (i, j) in the upper triangle by rows of a symmetric matrix of `size` rows
static size_t place(size_t size, size_t i, size_t j) {
    size_t low = i < j ? i : j, high = i < j ? j : i;
    return low * (2 * size - 1 - low) / 2 + high;
}

// what the law sees: strain, its rate over u, stress and tangent of `size` components
typedef struct strained {
    size_t size; // 6, or 3 of a membrane: 11 22 12
    double *E, *rate, *S, *D;
} strained;

static sn_status strained_create(const plane *p, size_t n, const double *x, strained *at) {
    static const int membrane[] = {0, 1, 3}, solid[] = {0, 1, 2, 3, 4, 5};
    bool thin = p->tissue->law->kind == SN_LAW_MEMBRANE;
    size_t size = thin ? 3 : 6;
    *at = (strained){.size = size};
    at->E = sn_alloc((3 * size + size * (size + 1) / 2) * n, sizeof *at->E);
    if (!at->E) return SN_E_MEMORY;
    at->rate = at->E + size * n, at->S = at->rate + size * n, at->D = at->S + size * n;
    for (size_t i = 0; i < n; ++i) {
        double strain[6], speed[6];
        strain_at(p, x[i], strain, speed);
        for (size_t j = 0; j < size; ++j) {
            at->E[j * n + i] = strain[(thin ? membrane : solid)[j]];
            at->rate[j * n + i] = speed[(thin ? membrane : solid)[j]];
        }
    }
    const sn_tissue *t = p->tissue;
    if (thin)
        sn_law_membrane(t->law, t->value, t->terms, (int)n, at->E, NULL, at->S, at->D);
    else
        sn_law_solid(t->law, t->value, t->terms, (int)n, at->E, NULL, at->S, at->D);
    return SN_OK;
}

// S12 and S22 in shear; S11, S22 and in a solid S33
static int channels_of(const plane *p) {
    return p->shear || p->tissue->law->kind == SN_LAW_MEMBRANE ? 2 : 3;
}

static sn_status fill(const void *context, int count, const double *x, double *value,
                      double *slope) {
    static const size_t biaxial[] = {0, 1, 2}, sheared[] = {3, 1}, sheared_membrane[] = {2, 1};
    const plane *p = context;
    size_t n = (size_t)count, channels = (size_t)channels_of(p);
    strained at;
    SN_TRY(strained_create(p, n, x, &at));
    const size_t *component = !p->shear ? biaxial : at.size == 3 ? sheared_membrane : sheared;
    for (size_t c = 0; c < channels; ++c) {
        for (size_t i = 0; i < n; ++i) {
            double sum = 0.0;
            for (size_t j = 0; j < at.size; ++j)
                sum += at.D[place(at.size, component[c], j) * n + i] * at.rate[j * n + i];
            value[c * n + i] = at.S[component[c] * n + i];
            slope[c * n + i] = sum;
        }
    }
    sn_free(at.E);
    return SN_OK;
}

// nominal stresses of a compressible block at the recorded times: T_1 then T_2 (2 x n)
static sn_status block_at_level(const plane *p, int level, double *stress) {
    const sn_path *path = p->path;
    sn_faces faces = {.held = {true, true, false}, .at = {1.0, 1.0, 0.0}};
    for (int i = 0; i < 2; ++i) faces.per[i] = p->target[i] - 1.0;
    sn_block_row *row = sn_alloc((size_t)path->count, sizeof *row);
    if (!row) return SN_E_MEMORY;
    sn_status status = sn_path_block(path, p->tissue, &faces, p->e, level, row);
    for (int r = 0; status == SN_OK && r < path->records; ++r)
        for (int i = 0; i < 2; ++i) stress[i * path->records + r] = row[path->record[r]].stress[i];
    sn_free(row);
    return status;
}

// adds the same where the elastic stresses are known functions of u; T_12 (n) in shear
static sn_status add_stress(const plane *p, int level, double *stress) {
    const sn_path *path = p->path;
    sn_channels of = {channels_of(p), p, fill};
    double *out = sn_alloc((size_t)(path->count * of.count), sizeof *out);
    if (!out) return SN_E_MEMORY;
    sn_status status = sn_path_hereditary(path, &of, p->e, level, out);
    for (int r = 0; status == SN_OK && r < path->records; ++r) {
        double u = path->stretch[path->record[r]], l[3];
        const double *H = out + path->record[r] * of.count;
        if (p->shear) {
            stress[r] += H[0] + p->target[0] * u * H[1];
            continue;
        }
        stretches_at(p, u, l);
        double pressure = of.count == 3 ? l[2] * l[2] * H[2] : 0.0;
        for (int i = 0; i < 2; ++i) stress[i * path->records + r] += l[i] * H[i] - pressure / l[i];
    }
    sn_free(out);
    return status;
}

// the nominal stress is a sum over the parts of the elastic stress, each with its memory
static sn_status known_at_level(const plane *whole, int level, double *stress) {
    sn_tissue part[2];
    int parts = sn_tissue_split(whole->tissue, part), columns = whole->shear ? 1 : 2;
    for (int i = 0; i < columns * whole->path->records; ++i) stress[i] = 0.0;
    for (int k = 0; k < parts; ++k) {
        plane p = *whole;
        p.tissue = &part[k];
        p.e = &whole->e[k == 0 ? SN_PART_DEVIATORIC : SN_PART_FIBRE];
        SN_TRY(add_stress(&p, level, stress));
    }
    return SN_OK;
}

static sn_status stress_at_level(const void *context, int level, double *stress) {
    const plane *p = context;
    const sn_path *path = p->path;
    SN_TRY(p->block ? block_at_level(p, level, stress) : known_at_level(p, level, stress));
    for (int i = 0; i < path->records * (p->shear ? 1 : 2); ++i)
        if (!isfinite(stress[i]))
            return sn_fail(SN_E_RANGE, "law %s overflows %g s into the test: check the constants",
                           p->tissue->law->name, path->time[path->record[i % path->records]]);
    return SN_OK;
}

static sn_status check(const sn_tissue *tissue, const sn_protocol *p) {
    const char *name = sn_protocol_name(p->kind);
    SN_TRY(sn_protocol_check(p));
    bool moves =
        p->kind == SN_PROTOCOL_SHEAR ? p->shear != 0.0 : p->stretch_1 != 1.0 || p->stretch_2 != 1.0;
    if (!moves)
        return sn_fail(SN_E_RANGE, "protocol %s: nothing would move: give another target", name);
    if (tissue->law->kind == SN_LAW_UNIAXIAL)
        return sn_fail(SN_E_UNSUPPORTED,
                       "law %s is uniaxial: a %s test needs a solid law, such as neo-hookean, or a "
                       "membrane law, such as fung-planar",
                       tissue->law->name, name);
    if (p->kind == SN_PROTOCOL_BIAXIAL && tissue->law->kind == SN_LAW_SOLID)
        return sn_pull_straight(tissue);
    return SN_OK;
}

static sn_status fill_record(const plane *p, int n, const double *time, const double *stress,
                             sn_record *record) {
    SN_TRY(sn_record_add_series(record, "time", "s"));
    SN_TRY(sn_record_add_series(record, p->shear ? "shear_strain" : "stretch_1", "1"));
    if (!p->shear) SN_TRY(sn_record_add_series(record, "stretch_2", "1"));
    SN_TRY(sn_record_add_series(record, p->shear ? "shear_stress" : "stress_1", "Pa"));
    if (!p->shear) SN_TRY(sn_record_add_series(record, "stress_2", "Pa"));
    for (int i = 0; i < n; ++i) {
        double u = p->path->stretch[p->path->record[i]], l[3];
        stretches_at(p, u, l);
        double biaxial[] = {time[i], l[0], l[1], stress[i], stress[p->shear ? i : n + i]};
        double sheared[] = {time[i], p->target[0] * u, stress[i]};
        SN_TRY(sn_record_append(record, p->shear ? sheared : biaxial));
    }
    return SN_OK;
}

sn_status sn_test_plane(const sn_tissue *tissue, const sn_protocol *protocol, sn_record *record) {
    SN_TRY(check(tissue, protocol));
    sn_exponentials e[SN_PARTS];
    bool viscous;
    SN_TRY(sn_path_memory(tissue, e, &viscous));
    plane p = {.tissue = tissue, .shear = protocol->kind == SN_PROTOCOL_SHEAR, .e = e};
    p.target[0] = p.shear ? protocol->shear : protocol->stretch_1;
    p.target[1] = p.shear ? 1.0 : protocol->stretch_2;
    sn_moduli moduli;
    tissue->law->moduli(tissue->value, tissue->terms, &moduli);
    p.block = !p.shear && tissue->law->kind == SN_LAW_SOLID && !isinf(moduli.bulk);
    double base = !p.block ? 0.0 : viscous ? 2.0 : 4.0;
    const double knots[] = {0.0, protocol->ramp}, drive[] = {0.0, 1.0};
    int n = protocol->points;
    double change;
    sn_history *motion = NULL;
    sn_path *path = NULL;
    sn_status status = SN_E_MEMORY;
    double *time = sn_alloc(3 * (size_t)n, sizeof *time), *stress = time + n;
    if (!time) goto fail;
    for (int i = 0; i < n; ++i) time[i] = i == n - 1 ? knots[1] : knots[1] * i / (n - 1);
    SN_TRY_GOTO(status, sn_history_create(1, 2, knots, drive, &motion));
    SN_TRY_GOTO(status, sn_path_lay(motion, 0.0, n, time, &path));
    p.path = path;
    SN_TRY_GOTO(status, sn_refine(stress_at_level, &p, p.shear ? n : 2 * n, base, tolerance, stress,
                                  &change));
    if (change > tolerance)
        SN_TRY_GOTO(status,
                    sn_fail(SN_E_SOLVER,
                            "law %s: the %s test changes by %g of its peak when its steps are "
                            "halved the last time (expected %g): use a smaller target",
                            tissue->law->name, sn_protocol_name(protocol->kind), change,
                            tolerance));
    status = fill_record(&p, n, time, stress, record);
fail:
    sn_path_destroy(path);
    sn_history_destroy(motion);
    sn_free(time);
    return status;
}
