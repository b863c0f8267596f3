// Constants of the long term, as other programs have them, and ours: to and fro.
// SPDX-License-Identifier: Apache-2.0
//
// An energy per volume that is made of constants in pascals and of pure numbers is proportional to
// those in pascals, so these are what must be multiplied, each part of the stress by its own ratio.
#include <math.h>

#include "tissue/parts.h"

// Converts the weights of a memory; *ratio is what its stresses are multiplied by.
typedef sn_status conversion(sn_memory *memory, double *ratio);

// the weights of a memory law that has some, `memory->terms` of them, else NULL
static double *weights_of(sn_memory *memory) {
    int k = sn_param_find(memory->law->params, memory->law->param_count, "g");
    return k < 0 ? NULL : memory->value + sn_param_offset(memory->law->params, k, memory->terms);
}

static sn_status from_long_term(sn_memory *memory, double *ratio) {
    double *g = weights_of(memory);
    if (g) {
        // weights over the long-term modulus: they may exceed 1, G(0) is 1 plus their sum
        *ratio = 1;
        for (int i = 0; i < memory->terms; i++) *ratio += g[i];
        if (!(*ratio >= 1 && isfinite(*ratio)))
            return sn_fail(SN_E_RANGE, "memory %s: the weights g sum to %g: expected at least 0",
                           memory->law->name, *ratio - 1);
        for (int i = 0; i < memory->terms; i++) g[i] /= *ratio;
        return SN_OK;
    }
    SN_TRY(sn_memory_check(memory));
    double equilibrium = sn_memory_equilibrium(memory);
    *ratio = 1 / equilibrium;
    if (equilibrium > 0) return SN_OK;
    return sn_fail(SN_E_RANGE,
                   "memory %s relaxes to no stress at all: there are no long-term constants; "
                   "give instantaneous ones",
                   memory->law->name);
}

static sn_status to_long_term(sn_memory *memory, double *ratio) {
    SN_TRY(sn_memory_check(memory));
    *ratio = 1;
    if (memory->law == sn_memory_none().law) return SN_OK;
    double *g = weights_of(memory);
    if (!g)
        return sn_fail(SN_E_UNSUPPORTED,
                       "memory %s has no weights over a long-term modulus, only prony has: "
                       "compress it to exponentials first",
                       memory->law->name);
    *ratio = sn_memory_equilibrium(memory);
    // what is left of 1 after the weights is theirs to rounding only
    if (!(*ratio > 1e-12))
        return sn_fail(SN_E_RANGE,
                       "memory %s relaxes to no stress at all: a fluid has no long-term constants",
                       memory->law->name);
    for (int i = 0; i < memory->terms; i++) g[i] /= *ratio;
    return SN_OK;
}

static sn_status check_separable(const sn_tissue *tissue, const double ratio[SN_PARTS]) {
    const sn_law *law = tissue->law;
    if (ratio[SN_PART_DEVIATORIC] == ratio[SN_PART_VOLUMETRIC] || law->kind != SN_LAW_SOLID ||
        sn_param_find(law->params, law->param_count, "bulk_modulus") >= 0)
        return SN_OK;
    return sn_fail(SN_E_UNSUPPORTED,
                   "law %s has no bulk_modulus of its own, so that long-term constants cannot be "
                   "converted where shape and volume relax differently: give instantaneous ones, "
                   "or take a law such as neo-hookean",
                   law->name);
}

static sn_status convert(sn_tissue *tissue, conversion *of) {
    sn_tissue t = *tissue;
    double ratio[SN_PARTS];
    if (!t.law)
        return sn_fail(SN_E_DEFINITION, "long-term constants of a tissue without an elastic law");
    SN_TRY(sn_tissue_check_branches(&t));
    sn_memory *memory[SN_PARTS] = {&t.memory, &t.volumetric, &t.fibre};
    for (int k = 0; k < SN_PARTS; k++) {
        if (k > 0 && !t.branched) {
            ratio[k] = ratio[0];
            continue;
        }
        SN_ASSERT(memory[k]->law);
        sn_status status = of(memory[k], &ratio[k]);
        if (status != SN_OK && t.branched)
            return sn_fail_within(status, "%s", sn_tissue_part_name((sn_part)k));
        if (status != SN_OK) return status;
    }
    SN_TRY(check_separable(&t, ratio));
    for (int k = 0; k < t.law->param_count; k++) {
        const sn_param *param = &t.law->params[k];
        double *value = t.value + sn_param_offset(t.law->params, k, t.terms);
        for (int part = 0; part < SN_PARTS; part++) {
            if (!sn_tissue_owns(t.law, param, (sn_part)part)) continue;
            for (int i = 0; i < sn_param_length(param, t.terms); i++) value[i] *= ratio[part];
        }
    }
    *tissue = t;
    return SN_OK;
}

sn_status sn_tissue_from_long_term(sn_tissue *tissue) {
    return convert(tissue, from_long_term);
}

sn_status sn_tissue_to_long_term(sn_tissue *tissue) {
    return convert(tissue, to_long_term);
}
