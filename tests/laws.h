// Constants for any solid law, so that a test can loop over the registry.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"
#include "sinew/tissue.h"

/// A tissue of moderate constants for any solid law: convex, stresses of kilopascals, no memory.
static inline sn_tissue some_tissue(const sn_law *law) {
    static const double nine[] = {6, 4, 3, 1, -0.5, 0.8, 1.5, 2, 2.5};
    sn_tissue t = sn_tissue_default();
    snprintf(t.name, sizeof t.name, "%s", law->name);
    t.law = law;
    t.density = 1000;
    double *value = t.value;
    for (int k = 0; k < law->param_count; k++) {
        const sn_param *p = &law->params[k];
        if (p->length == SN_PARAM_LIST) t.terms = 2;
        for (int i = 0; i < sn_param_length(p, t.terms); i++) {
            double part = p->length == 9 ? nine[i] : 1 + 0.25 * i;
            *value++ = part * (!strcmp(p->name, "bulk_modulus") ? 3e4
                               : !strcmp(p->unit, "Pa")         ? 2e3 + 500 * k
                               : p->max < 0.4                   ? 0.1
                               : p->max < 1                     ? 0.4
                                                                : 1.3);
        }
    }
    CHECK_OK(sn_tissue_check(&t));
    return t;
}
