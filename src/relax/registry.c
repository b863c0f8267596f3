// The registry of memory laws.
// SPDX-License-Identifier: Apache-2.0
#include "relax/laws.h"

#include <string.h>

static const sn_memory_law *const laws[] = {
#define LAW_ADDRESS(name) &sn_relax_##name,
    SN_MEMORY_LAWS(LAW_ADDRESS)
#undef LAW_ADDRESS
};
#define LAW_COUNT ((int)(sizeof laws / sizeof *laws))

int sn_memory_law_count(void) {
    return LAW_COUNT;
}

const sn_memory_law *sn_memory_law_at(int index) {
    SN_ASSERT(index >= 0 && index < LAW_COUNT);
    return laws[index];
}

const sn_memory_law *sn_memory_law_find(const char *name) {
    const char *names[LAW_COUNT];
    for (int i = 0; i < LAW_COUNT; i++) {
        if (strcmp(laws[i]->name, name) == 0) return laws[i];
        names[i] = laws[i]->name;
    }
    const char *near = sn_suggest(name, names, LAW_COUNT);
    if (near) {
        sn_fail(SN_E_NAME, "no memory law \"%s\": did you mean \"%s\"?", name, near);
        return NULL;
    }
    char list[SN_TEXT_MAX] = "";
    for (int i = 0; i < LAW_COUNT; i++) {
        if (i > 0) strncat(list, ", ", sizeof list - strlen(list) - 1);
        strncat(list, names[i], sizeof list - strlen(list) - 1);
    }
    sn_fail(SN_E_NAME, "no memory law \"%s\": there are %s", name, list);
    return NULL;
}
