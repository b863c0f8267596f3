// All elastic laws by name, and the functions of sinew/law.h.
// SPDX-License-Identifier: Apache-2.0
#include "law/kernels.h"

#include <stdio.h>

// a new law: its file in laws/ and its line here
#define LAWS(X)                                                                                    \
    X(linear)                                                                                      \
    X(exponential)                                                                                 \
    X(hookean)                                                                                     \
    X(neo_hookean)                                                                                 \
    X(mooney_rivlin)                                                                               \
    X(ogden)                                                                                       \
    X(demiray)                                                                                     \
    X(veronda_westmann)                                                                            \
    X(fung)                                                                                        \
    X(fung_general)                                                                                \
    X(guccione)                                                                                    \
    X(hgo)                                                                                         \
    X(fung_skin)                                                                                   \
    X(fung_planar)

#define DECLARE(name) extern const sn_law sn_law_##name;
LAWS(DECLARE)
#define ROW(name) &sn_law_##name,
static const sn_law *const laws[] = {LAWS(ROW)};
enum { COUNT = sizeof laws / sizeof laws[0] };

int sn_law_count(void) {
    return COUNT;
}

const sn_law *sn_law_at(int index) {
    SN_ASSERT(index >= 0 && index < COUNT);
    return laws[index];
}

const sn_law *sn_law_find(const char *name) {
    const char *names[COUNT];
    for (int k = 0; k < COUNT; k++) {
        if (strcmp(laws[k]->name, name) == 0) return laws[k];
        names[k] = laws[k]->name;
    }
    const char *near = sn_suggest(name, names, COUNT);
    if (near) {
        sn_fail(SN_E_NAME, "no elastic law \"%s\": did you mean \"%s\"?", name, near);
        return NULL;
    }
    char all[SN_TEXT_MAX] = "";
    for (int k = 0; k < COUNT; k++) {
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", k ? ", " : "", names[k]);
    }
    sn_fail(SN_E_NAME, "no elastic law \"%s\": there are %s", name, all);
    return NULL;
}

sn_status sn_law_check(const sn_law *law, const double *value, int terms) {
    char owner[SN_NAME_MAX];
    snprintf(owner, sizeof owner, "law %s", law->name);
    SN_TRY(sn_param_check(law->params, law->param_count, terms, value, owner));
    return law->check ? law->check(value, terms) : SN_OK;
}

int sn_law_components(const sn_law *law) {
    return law->kind == SN_LAW_UNIAXIAL ? 1 : law->kind == SN_LAW_SOLID ? 6 : 3;
}

void sn_law_sensitivity(const sn_law *law, const double *value, int terms, int n, const double *in,
                        double *dS) {
    int values = sn_param_offset(law->params, law->param_count, terms);
    memset(dS, 0, (size_t)values * (size_t)sn_law_components(law) * (size_t)n * sizeof *dS);
    law->sensitivity(value, terms, n, in, dS);
}

void sn_law_uniaxial(const sn_law *law, const double *value, int terms, int n,
                     const double *stretch, double *W, double *T, double *dT) {
    SN_ASSERT(law->kind == SN_LAW_UNIAXIAL);
    sn_law_batch_64 batch = {value, terms, n, stretch, W, T, dT};
    law->kernels->f64[sn_isa_current()](&batch);
}

void sn_law_uniaxial_f(const sn_law *law, const float *value, int terms, int n,
                       const float *stretch, float *W, float *T, float *dT) {
    SN_ASSERT(law->kind == SN_LAW_UNIAXIAL);
    sn_law_batch_32 batch = {value, terms, n, stretch, W, T, dT};
    law->kernels->f32[sn_isa_current()](&batch);
}

void sn_law_solid(const sn_law *law, const double *value, int terms, int n, const double *E,
                  double *W, double *S, double *D) {
    SN_ASSERT(law->kind == SN_LAW_SOLID);
    sn_law_batch_64 batch = {value, terms, n, E, W, S, D};
    law->kernels->f64[sn_isa_current()](&batch);
}

void sn_law_solid_f(const sn_law *law, const float *value, int terms, int n, const float *E,
                    float *W, float *S, float *D) {
    SN_ASSERT(law->kind == SN_LAW_SOLID);
    sn_law_batch_32 batch = {value, terms, n, E, W, S, D};
    law->kernels->f32[sn_isa_current()](&batch);
}

void sn_law_membrane(const sn_law *law, const double *value, int terms, int n, const double *E,
                     double *W, double *S, double *D) {
    SN_ASSERT(law->kind == SN_LAW_MEMBRANE);
    sn_law_batch_64 batch = {value, terms, n, E, W, S, D};
    law->kernels->f64[sn_isa_current()](&batch);
}

void sn_law_membrane_f(const sn_law *law, const float *value, int terms, int n, const float *E,
                       float *W, float *S, float *D) {
    SN_ASSERT(law->kind == SN_LAW_MEMBRANE);
    sn_law_batch_32 batch = {value, terms, n, E, W, S, D};
    law->kernels->f32[sn_isa_current()](&batch);
}
