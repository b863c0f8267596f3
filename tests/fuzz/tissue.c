// Fuzz target: tissue files. What is read can be written, and reads back the same.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    sn_tissue tissue, again;
    memset(&tissue, 0, sizeof tissue);
    memset(&again, 0, sizeof again);
    sn_status status = sn_tissue_read(fuzz_file("input.yaml", data, size), &tissue);
    if (status != SN_OK) {
        fuzz_check_error(status, "input.yaml");
        return 0;
    }
    SN_ASSERT(sn_tissue_check(&tissue) == SN_OK);
    const char *path = fuzz_file("written.yaml", "", 0);
    SN_ASSERT(sn_tissue_write(path, &tissue, "fuzz") == SN_OK);
    SN_ASSERT(sn_tissue_read(path, &again) == SN_OK);
    int count = sn_param_offset(tissue.law->params, tissue.law->param_count, tissue.terms);
    SN_ASSERT(again.law == tissue.law && again.terms == tissue.terms);
    SN_ASSERT(memcmp(again.value, tissue.value, (size_t)count * sizeof *tissue.value) == 0);
    const sn_memory *m = &tissue.memory;
    count = sn_param_offset(m->law->params, m->law->param_count, m->terms);
    SN_ASSERT(again.memory.law == m->law && again.memory.terms == m->terms);
    SN_ASSERT(memcmp(again.memory.value, m->value, (size_t)count * sizeof *m->value) == 0);
    return 0;
}
