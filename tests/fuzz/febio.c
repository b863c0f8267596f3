// Fuzz target: materials of FEBio.
// SPDX-License-Identifier: Apache-2.0
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    sn_tissue tissue;
    sn_foreign how = sn_foreign_default();
    how.stress = 1e3;
    how.time = how.length = 1e-3;
    sn_status status = sn_tissue_read_febio(fuzz_file("input.feb", data, size), &tissue, &how);
    if (status != SN_OK)
        fuzz_check_error(status, "input.feb");
    else
        SN_ASSERT(sn_tissue_check(&tissue) == SN_OK);
    return 0;
}
