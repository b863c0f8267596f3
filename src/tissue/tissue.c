// A tissue: checks, named constants, moduli.
// SPDX-License-Identifier: Apache-2.0
#include <math.h>

#include "tissue/parts.h"

sn_tissue sn_tissue_default(void) {
    const sn_memory none = sn_memory_none();
    return (sn_tissue){
        .density = NAN, .poissons_ratio = NAN, .memory = none, .volumetric = none, .fibre = none};
}

static sn_status check_density(const sn_tissue *tissue) {
    if (isnan(tissue->density) || (tissue->density > 0 && isfinite(tissue->density))) return SN_OK;
    return sn_fail(SN_E_RANGE, "density is %g kg/m3: expected more than 0", tissue->density);
}

static sn_status check_poissons_ratio(const sn_tissue *tissue) {
    double ratio = tissue->poissons_ratio;
    if (isnan(ratio)) return SN_OK;
    if (tissue->law->kind != SN_LAW_UNIAXIAL)
        return sn_fail(SN_E_DEFINITION,
                       "poissons_ratio is given, but law %s is not uniaxial: leave it out, its own "
                       "constants say how it changes volume",
                       tissue->law->name);
    if (ratio > -1 && ratio < 0.5) return SN_OK;
    return sn_fail(SN_E_RANGE, "poissons_ratio is %g: expected more than -1 and less than 0.5",
                   ratio);
}

// lists must have terms, and the values must fit into the tissue
static sn_status check_terms(const sn_tissue *tissue) {
    const sn_law *law = tissue->law;
    bool list = false;
    for (int k = 0; k < law->param_count; k++) list |= law->params[k].length == SN_PARAM_LIST;
    int least = list ? 1 : 0, most = list ? SN_TERMS_MAX : 0;
    if (tissue->terms >= least && tissue->terms <= most &&
        sn_param_offset(law->params, law->param_count, tissue->terms) <= SN_VALUES_MAX)
        return SN_OK;
    return sn_fail(SN_E_RANGE, "law %s: %d terms: expected %d to %d, and at most %d values in all",
                   law->name, tissue->terms, least, most, SN_VALUES_MAX);
}

static sn_status check_memories(const sn_tissue *tissue) {
    if (!tissue->branched) return sn_memory_check(&tissue->memory);
    SN_TRY(sn_tissue_check_branches(tissue));
    for (int k = 0; k < SN_PARTS; k++) {
        sn_status status = sn_memory_check(sn_tissue_memory(tissue, (sn_part)k));
        if (status != SN_OK) return sn_fail_within(status, "%s", sn_tissue_part_name((sn_part)k));
    }
    return SN_OK;
}

static sn_status check_parts(const sn_tissue *tissue) {
    if (!tissue->law)
        return sn_fail(SN_E_DEFINITION, "no elastic law: expected one, such as `exponential`");
    SN_TRY(check_terms(tissue));
    SN_TRY(sn_law_check(tissue->law, tissue->value, tissue->terms));
    SN_TRY(check_memories(tissue));
    SN_TRY(check_density(tissue));
    return check_poissons_ratio(tissue);
}

sn_status sn_tissue_check(const sn_tissue *tissue) {
    sn_status status = check_parts(tissue);
    if (status == SN_OK || tissue->name[0] == 0) return status;
    return sn_fail_within(status, "tissue %s", tissue->name);
}

double sn_tissue_value(const sn_tissue *tissue, const char *name) {
    const sn_law *law = tissue->law;
    if (!law) return NAN;
    int k = sn_param_find(law->params, law->param_count, name);
    if (k < 0 || law->params[k].length > 1 || law->params[k].length == SN_PARAM_LIST) return NAN;
    return tissue->value[sn_param_offset(law->params, k, tissue->terms)];
}

static sn_status unknown_name(const sn_law *law, const char *name) {
    const char *names[SN_VALUES_MAX];
    int count = law->param_count < SN_VALUES_MAX ? law->param_count : SN_VALUES_MAX;
    for (int k = 0; k < count; k++) names[k] = law->params[k].name;
    const char *near = sn_suggest(name, names, count);
    return sn_fail(SN_E_NAME, "law %s has no parameter \"%s\"%s%s%s", law->name, name,
                   near ? ": did you mean \"" : "", near ? near : "", near ? "\"?" : "");
}

sn_status sn_tissue_set(sn_tissue *tissue, const char *name, double value) {
    const sn_law *law = tissue->law;
    if (!law) return sn_fail(SN_E_NAME, "cannot set \"%s\": the tissue has no elastic law", name);
    int k = sn_param_find(law->params, law->param_count, name);
    if (k < 0) return unknown_name(law, name);
    if (law->params[k].length > 1 || law->params[k].length == SN_PARAM_LIST)
        return sn_fail(SN_E_NAME, "parameter \"%s\" of law %s is a list: expected a scalar", name,
                       law->name);
    tissue->value[sn_param_offset(law->params, k, tissue->terms)] = value;
    return SN_OK;
}

void sn_tissue_moduli(const sn_tissue *tissue, sn_moduli *out) {
    SN_ASSERT(tissue->law);
    tissue->law->moduli(tissue->value, tissue->terms, out);
    if (tissue->law->kind != SN_LAW_UNIAXIAL) return;
    // isotropic Hooke, equation (5); NAN where no ratio is given
    out->shear = out->young / (2 * (1 + tissue->poissons_ratio));
    out->bulk = out->young / (3 * (1 - 2 * tissue->poissons_ratio));
}
