// Biaxial and shear tests of incompressible solids.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35) with (32); S = H[S_d] - p C^-1, H the hereditary integral, J = 1.
//
// Both motions are known: they are driven by u, from 0 to 1 at constant speed. The free thickness,
// S33 = 0, gives p = l3^2 H[S33] (l3 the thickness stretch). Nominal stresses:
//     biaxial, F = diag(l1, l2, 1/(l1 l2)):   T_i = l_i H[S_ii] - l3^2 H[S33]/l_i,  i = 1, 2
//     simple shear g in the 1-2 plane:        T_12 = H[S12] + g H[S22]
// In shear p drops out, and the nominal stress is the true one: the sheared face keeps its area.
#include <math.h>

#include "lab/protocol/hereditary.h"
#include "lab/protocol/protocol.h"
#include "lab/protocol/refine.h"

static const double tolerance = 5e-8; // of the peak

typedef struct plane {
    const sn_tissue *tissue;
    bool shear;
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

// place of (i, j) in the upper triangle by rows
static size_t place(size_t i, size_t j) {
    size_t low = i < j ? i : j, high = i < j ? j : i;
    return low * (11 - low) / 2 + high;
}

static sn_status fill(const void *context, int count, const double *x, double *value,
                      double *slope) {
    static const size_t biaxial[] = {0, 1, 2}, sheared[] = {3, 1};
    const plane *p = context;
    const size_t *component = p->shear ? sheared : biaxial;
    size_t n = (size_t)count, channels = p->shear ? 2 : 3;
    double *E = sn_alloc((6 + 6 + 6 + 21) * n, sizeof *E);
    if (!E) return SN_E_MEMORY;
    double *rate = E + 6 * n, *S = rate + 6 * n, *D = S + 6 * n;
    for (size_t i = 0; i < n; ++i) {
        double strain[6], speed[6];
        strain_at(p, x[i], strain, speed);
        for (size_t j = 0; j < 6; ++j) {
            E[j * n + i] = strain[j];
            rate[j * n + i] = speed[j];
        }
    }
    sn_law_solid(p->tissue->law, p->tissue->value, p->tissue->terms, count, E, NULL, S, D);
    for (size_t c = 0; c < channels; ++c) {
        for (size_t i = 0; i < n; ++i) {
            double sum = 0.0;
            for (size_t j = 0; j < 6; ++j)
                sum += D[place(component[c], j) * n + i] * rate[j * n + i];
            value[c * n + i] = S[component[c] * n + i];
            slope[c * n + i] = sum;
        }
    }
    sn_free(E);
    return SN_OK;
}

// adds the nominal stresses at the recorded times: T_12 (n), or T_1 then T_2 (2 x n)
static sn_status add_stress(const plane *p, int level, double *stress) {
    const sn_path *path = p->path;
    sn_channels of = {p->shear ? 2 : 3, p, fill};
    double *out = sn_alloc((size_t)(path->count * of.count), sizeof *out);
    if (!out) return SN_E_MEMORY;
    sn_status status = sn_path_hereditary(path, &of, p->e, level, out);
    for (int r = 0; status == SN_OK && r < path->records; ++r) {
        double u = path->stretch[path->record[r]], l[3], second = 0.0;
        const double *H = out + path->record[r] * of.count;
        if (p->shear) {
            stress[r] += H[0] + p->target[0] * u * H[1];
        } else {
            stretches_at(p, u, l);
            stress[r] += l[0] * H[0] - l[2] * l[2] * H[2] / l[0];
            second = stress[path->records + r] += l[1] * H[1] - l[2] * l[2] * H[2] / l[1];
        }
        if (!isfinite(stress[r]) || !isfinite(second))
            status = sn_fail(SN_E_RANGE, "law %s overflows %g s into the test: check the constants",
                             p->tissue->law->name, path->time[path->record[r]]);
    }
    sn_free(out);
    return status;
}

// the nominal stress is a sum over the parts of the elastic stress, each with its memory
static sn_status stress_at_level(const void *context, int level, double *stress) {
    const plane *whole = context;
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

static sn_status check(const sn_tissue *tissue, const sn_protocol *p) {
    const char *name = sn_protocol_name(p->kind);
    SN_TRY(sn_protocol_check(p));
    bool moves =
        p->kind == SN_PROTOCOL_SHEAR ? p->shear != 0.0 : p->stretch_1 != 1.0 || p->stretch_2 != 1.0;
    if (!moves)
        return sn_fail(SN_E_RANGE, "protocol %s: nothing would move: give another target", name);
    sn_moduli moduli = {0.0, 0.0, 0.0};
    if (tissue->law->kind == SN_LAW_SOLID)
        tissue->law->moduli(tissue->value, tissue->terms, &moduli);
    if (isinf(moduli.bulk)) return SN_OK;
    return sn_fail(SN_E_UNSUPPORTED,
                   "law %s: a %s test needs an incompressible solid, such as neo-hookean with "
                   "bulk_modulus: incompressible",
                   tissue->law->name, name);
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
    SN_TRY_GOTO(status, sn_refine(stress_at_level, &p, p.shear ? n : 2 * n, 0.0, tolerance, stress,
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
