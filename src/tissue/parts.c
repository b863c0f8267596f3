// Parts of the stress: which memory acts on which, and the law split in two where fibres differ.
// SPDX-License-Identifier: Apache-2.0
// Source: equations (33)-(35).
//
// An energy per volume is proportional to its constants in pascals taken together. Where it is also
// proportional in one of them alone, the fibre constant, up to what the others make, it is a sum of
// two: what is left without the fibre constant, and what is left without the others. So one kernel
// gives both parts.
#include "tissue/parts.h"

#include <math.h>
#include <string.h>

static const char bulk_name[] = "bulk_modulus";

bool sn_tissue_owns(const sn_law *law, const sn_param *param, sn_part part) {
    if (strcmp(param->unit, "Pa") != 0) return false;
    sn_part owner = SN_PART_DEVIATORIC;
    if (strcmp(param->name, bulk_name) == 0) owner = SN_PART_VOLUMETRIC;
    if (law->fibre_constant && strcmp(param->name, law->fibre_constant) == 0) owner = SN_PART_FIBRE;
    return owner == part;
}

const char *sn_tissue_part_name(sn_part part) {
    static const char *const names[SN_PARTS] = {"deviatoric", "volumetric", "fibre"};
    return names[part];
}

const sn_memory *sn_tissue_memory(const sn_tissue *tissue, sn_part part) {
    if (!tissue->branched || part == SN_PART_DEVIATORIC) return &tissue->memory;
    return part == SN_PART_VOLUMETRIC ? &tissue->volumetric : &tissue->fibre;
}

static bool forgets(const sn_memory *memory) {
    return memory->law == sn_memory_none().law;
}

sn_status sn_tissue_check_branches(const sn_tissue *tissue) {
    const sn_law *law = tissue->law;
    if (!tissue->branched) return SN_OK;
    if (law->kind != SN_LAW_SOLID)
        return sn_fail(SN_E_UNSUPPORTED,
                       "memory branch: law %s is no three-dimensional solid, its stress has no "
                       "parts: give one memory, such as {law: prony, g: [0.3], tau: [1 s]}",
                       law->name);
    if (!law->fibre_constant && !forgets(&tissue->fibre))
        return sn_fail(SN_E_UNSUPPORTED,
                       "memory branch fibre: law %s has no fibres with an energy of their own: "
                       "leave it out, or take a law that has, such as hgo",
                       law->name);
    if (isinf(sn_tissue_value(tissue, bulk_name)) && !forgets(&tissue->volumetric))
        return sn_fail(SN_E_DEFINITION,
                       "memory branch volumetric: law %s is incompressible here, its volume has "
                       "nothing to relax: leave it out, or give a finite bulk_modulus",
                       law->name);
    return SN_OK;
}

static bool alike(const sn_memory *a, const sn_memory *b) {
    if (a->law != b->law || a->terms != b->terms) return false;
    int count = sn_param_offset(a->law->params, a->law->param_count, a->terms);
    for (int k = 0; k < count; k++)
        if (a->value[k] != b->value[k]) return false;
    return true;
}

// sets the constants that belong to a part to 0
static void silence(sn_tissue *tissue, sn_part part) {
    const sn_law *law = tissue->law;
    for (int k = 0; k < law->param_count; k++) {
        if (!sn_tissue_owns(law, &law->params[k], part)) continue;
        double *value = tissue->value + sn_param_offset(law->params, k, tissue->terms);
        int length = sn_param_length(&law->params[k], tissue->terms);
        for (int i = 0; i < length; i++) value[i] = 0;
    }
}

int sn_tissue_split(const sn_tissue *tissue, sn_tissue part[2]) {
    SN_ASSERT(tissue->law);
    if (tissue->branched && !alike(&tissue->memory, &tissue->fibre))
        return sn_tissue_split_fibres(tissue, part);
    part[0] = *tissue;
    part[0].branched = false;
    return 1;
}

int sn_tissue_split_fibres(const sn_tissue *tissue, sn_tissue part[2]) {
    SN_ASSERT(tissue->law);
    part[0] = *tissue;
    part[0].branched = false;
    if (!tissue->law->fibre_constant) return 1;
    part[1] = part[0];
    part[1].memory = *sn_tissue_memory(tissue, SN_PART_FIBRE);
    silence(&part[0], SN_PART_FIBRE);
    silence(&part[1], SN_PART_DEVIATORIC);
    return 2;
}
