// Fuzz target: materials of Abaqus.
// SPDX-License-Identifier: Apache-2.0
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    sn_tissue tissue;
    sn_foreign how = sn_foreign_default();
    how.stress = 1e3;
    how.time = how.length = 1e-3;
    sn_status status = sn_tissue_read_abaqus(fuzz_file("input.inp", data, size), &tissue, &how);
    if (status != SN_OK)
        fuzz_check_error(status, "input.inp");
    else
        SN_ASSERT(sn_tissue_check(&tissue) == SN_OK);
    return 0;
}
