// A memory law with its constants: check, evaluate, expand.
// SPDX-License-Identifier: Apache-2.0
#include "relax/laws.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// what expansions of continuous spectra aim at: far below the noise of any measurement
#define EXPAND_ERROR 2e-12

sn_memory sn_memory_none(void) {
    return (sn_memory){.law = &sn_relax_none};
}

static bool has_list(const sn_memory_law *law) {
    for (int k = 0; k < law->param_count; k++)
        if (law->params[k].length == SN_PARAM_LIST) return true;
    return false;
}

sn_status sn_memory_check(const sn_memory *memory) {
    const sn_memory_law *law = memory->law;
    if (!law) return sn_fail(SN_E_DEFINITION, "a memory without a law: expected one, or `none`");
    int terms = memory->terms;
    if (has_list(law) ? terms < 1 || terms > SN_TERMS_MAX : terms != 0)
        return sn_fail(SN_E_RANGE, "memory %s: %d terms: expected %d to %d", law->name, terms,
                       has_list(law), has_list(law) ? SN_TERMS_MAX : 0);
    SN_ASSERT(sn_param_offset(law->params, law->param_count, terms) <= SN_VALUES_MAX);
    char owner[SN_NAME_MAX];
    snprintf(owner, sizeof owner, "memory %s", law->name);
    SN_TRY(sn_param_check(law->params, law->param_count, terms, memory->value, owner));
    return law->check ? law->check(memory->value, terms) : SN_OK;
}

double sn_memory_relaxation(const sn_memory *memory, double t) {
    SN_ASSERT(t >= 0);
    return memory->law->relaxation(memory->value, memory->terms, t);
}

double sn_memory_equilibrium(const sn_memory *memory) {
    return memory->law->equilibrium(memory->value, memory->terms);
}

void sn_memory_modulus(const sn_memory *memory, double w, double *storage, double *loss) {
    SN_ASSERT(w >= 0);
    double out[2];
    memory->law->modulus(memory->value, memory->terms, w, out);
    *storage = out[0];
    *loss = out[1];
}

sn_status sn_memory_expand(const sn_memory *memory, sn_exponentials *out) {
    memset(out, 0, sizeof *out);
    SN_TRY(sn_memory_check(memory));
    memory->law->expand(memory->value, memory->terms, EXPAND_ERROR, out);
    out->t_max = INFINITY;
    return SN_OK;
}

void sn_memory_sensitivity(const sn_memory *memory, sn_memory_slope *out) {
    const sn_memory_law *law = memory->law;
    int values = sn_param_offset(law->params, law->param_count, memory->terms);
    for (int k = 0; k < values; k++) out[k] = (sn_memory_slope){.tau = 1.0};
    law->sensitivity(memory->value, memory->terms, out);
}

double sn_memory_slope_at(const sn_memory_slope *slope, double G, double t) {
    SN_ASSERT(t >= 0);
    double x = t / slope->tau;
    // exp(-745) is 0, and infinity times it would be no number
    double relaxing = x < 745 ? (slope->plain + slope->aged * x) * exp(-x) : 0.0;
    return slope->constant + slope->own * G + relaxing;
}
