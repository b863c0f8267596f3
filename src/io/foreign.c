// What the files of other programs share: units, memories of few terms, laws put together.
// SPDX-License-Identifier: Apache-2.0
#include "io/foreign.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

sn_foreign sn_foreign_default(void) {
    return (sn_foreign){.stress = NAN, .time = NAN, .length = NAN, .from = 1e-3, .to = 1e3};
}

sn_status sn_foreign_check(const sn_foreign *how) {
    if (!(how->stress > 0 && isfinite(how->stress) && how->time > 0 && isfinite(how->time)))
        return sn_fail(SN_E_DEFINITION,
                       "files of this kind carry no units: the units of stress and time must be "
                       "given");
    if (!(how->from > 0 && how->to > how->from && isfinite(how->to)))
        return sn_fail(SN_E_DEFINITION,
                       "the band of times runs from %g s to %g s: expected 0 < from < to",
                       how->from, how->to);
    return SN_OK;
}

void sn_foreign_remark(sn_foreign *how, const char *format, ...) {
    size_t used = strlen(how->remarks);
    va_list arguments;
    va_start(arguments, format);
    if (used && used + 2 < sizeof how->remarks) used = strlen(strcat(how->remarks, "; "));
    vsnprintf(how->remarks + used, sizeof how->remarks - used, format, arguments);
    va_end(arguments);
}

sn_status sn_foreign_start(const sn_tissue *tissue, sn_foreign *how) {
    how->remarks[0] = 0;
    SN_TRY(sn_foreign_check(how));
    SN_TRY(sn_tissue_check(tissue));
    if (isfinite(tissue->density) && isnan(how->length))
        sn_foreign_remark(how, "the density was left out: it needs a unit of length");
    return SN_OK;
}

double sn_foreign_density(const sn_foreign *how) {
    return how->stress * how->time * how->time / (how->length * how->length);
}

//---- memory --------------------------------------------------------------------------------------

#define TOLERANCE 1e-3 // of G(0); what a conversion may lose without asking for more terms
#define HALVINGS 12    // of the logarithm of a tolerance: within a thousandth of the best

static sn_status compress(const sn_tissue *tissue, int most, const sn_foreign *how,
                          sn_exponentials *out) {
    double low = TOLERANCE, high = 1;
    const sn_memory *memory = &tissue->memory;
    sn_exponentials e;
    if (sn_memory_compress(memory, how->from, how->to, low, out) == SN_OK && out->terms <= most)
        return SN_OK;
    // the smallest tolerance that `most` terms reach, between one they miss and one they keep
    SN_TRY(sn_memory_compress(memory, how->from, how->to, high, out));
    for (int k = 0; k < HALVINGS; k++) {
        double tolerance = sqrt(low * high);
        if (sn_memory_compress(memory, how->from, how->to, tolerance, &e) == SN_OK &&
            e.terms <= most) {
            high = tolerance;
            *out = e;
        } else {
            low = tolerance;
        }
    }
    return SN_OK;
}

sn_status sn_foreign_memory(const sn_tissue *tissue, int most, sn_foreign *how,
                            sn_exponentials *out) {
    if (tissue->branched)
        return sn_fail(SN_E_UNSUPPORTED,
                       "memory branch: a file of another program takes one memory for all parts of "
                       "the stress: give one, such as {law: prony, g: [0.3], tau: [1 s]}");
    SN_TRY(sn_memory_expand(&tissue->memory, out));
    if (out->viscous > 0)
        return sn_fail(SN_E_UNSUPPORTED,
                       "memory %s has a purely viscous part, which a sum of exponentials cannot "
                       "hold",
                       tissue->memory.law->name);
    bool exact = out->max_error == 0 && out->terms <= most;
    if (!exact) {
        SN_TRY(compress(tissue, most, how, out));
        sn_foreign_remark(how,
                          "memory %s as %d exponentials, error at most %.2g of G(0) at times from "
                          "%g s to %g s",
                          tissue->memory.law->name, out->terms, out->max_error, how->from, how->to);
    }
    how->terms = out->terms;
    how->max_error = exact ? 0 : out->max_error;
    return SN_OK;
}

void sn_foreign_prony(sn_tissue *tissue, int terms, const double *g, const double *tau) {
    sn_memory *memory = &tissue->memory;
    *memory = sn_memory_none();
    if (terms == 0) return;
    memory->law = sn_memory_law_find("prony");
    memory->terms = terms;
    memcpy(memory->value, g, (size_t)terms * sizeof *g);
    memcpy(memory->value + terms, tau, (size_t)terms * sizeof *tau);
}

//---- laws ----------------------------------------------------------------------------------------

void sn_foreign_law(sn_tissue *tissue, const char *law, int terms) {
    *tissue = sn_tissue_default();
    tissue->law = sn_law_find(law);
    tissue->terms = terms;
    SN_ASSERT(tissue->law);
    sn_param_defaults(tissue->law->params, tissue->law->param_count, terms, tissue->value);
}

static int place(const sn_tissue *tissue, const char *name, int index) {
    int k = sn_param_find(tissue->law->params, tissue->law->param_count, name);
    SN_ASSERT(k >= 0);
    return sn_param_offset(tissue->law->params, k, tissue->terms) + index;
}

void sn_foreign_set(sn_tissue *tissue, const char *name, int index, double value) {
    tissue->value[place(tissue, name, index)] = value;
}

double sn_foreign_get(const sn_tissue *tissue, const char *name, int index) {
    return tissue->value[place(tissue, name, index)];
}

void sn_foreign_scale(sn_tissue *tissue, double factor, bool bulk) {
    const sn_law *law = tissue->law;
    for (int k = 0; k < law->param_count; k++) {
        const sn_param *p = &law->params[k];
        if (strcmp(p->unit, "Pa") != 0) continue;
        if (!bulk && strcmp(p->name, "bulk_modulus") == 0) continue;
        int first = sn_param_offset(law->params, k, tissue->terms);
        int length = sn_param_length(p, tissue->terms);
        for (int i = 0; i < length; i++) tissue->value[first + i] *= factor;
    }
}

void sn_foreign_orthotropic(const sn_tissue *tissue, double a[9]) {
    if (strcmp(tissue->law->name, "fung") == 0) {
        for (int i = 0; i < 9; i++) a[i] = sn_foreign_get(tissue, "a", i);
        return;
    }
    double bf = sn_foreign_get(tissue, "bf", 0), bt = sn_foreign_get(tissue, "bt", 0);
    double bfs = sn_foreign_get(tissue, "bfs", 0);
    const double guccione[9] = {bf, bt, bt, 0, 0, 0, bfs, bt, bfs};
    memcpy(a, guccione, sizeof guccione);
}
