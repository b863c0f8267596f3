// Fuzz target: Gmsh meshes.
// SPDX-License-Identifier: Apache-2.0
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    sn_mesh *mesh = NULL;
    fuzz_limit_memory();
    sn_status status = sn_mesh_read_gmsh(fuzz_file("input.msh", data, size), 1e-3, &mesh);
    if (status != SN_OK) {
        fuzz_check_error(status, "input.msh");
        return 0;
    }
    SN_ASSERT(mesh->node_count > 0 && mesh->cell_count > 0);
    for (int i = 0; i < 4 * mesh->cell_count; i++)
        SN_ASSERT(mesh->cell[i] >= 0 && mesh->cell[i] < mesh->node_count);
    fuzz_check_finite(mesh->node, 3 * mesh->node_count);
    sn_mesh_destroy(mesh);
    return 0;
}
