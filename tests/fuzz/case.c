// Fuzz target: case files, with a tissue and a mesh beside them. What is read has been checked.
// SPDX-License-Identifier: Apache-2.0
#include "fuzz.h"

#include <string.h>

static const char tissue[] =
    "tissue: t\ndensity: 1000 kg/m3\n"
    "elastic: {law: neo-hookean, shear_modulus: 3 kPa, bulk_modulus: 300 kPa}\n";
static const char mesh[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static bool ready;
    fuzz_limit_memory();
    if (!ready) {
        fuzz_file("t.yaml", tissue, strlen(tissue));
        fuzz_file("m.msh", mesh, strlen(mesh));
        ready = true;
    }
    sn_case *c = NULL;
    sn_status status = sn_case_read(fuzz_file("input.yaml", data, size), &c);
    if (status != SN_OK) {
        fuzz_check_error(status, "input.yaml");
        return 0;
    }
    fuzz_check_finite(c->mesh->node, 3 * c->mesh->node_count);
    sn_case_destroy(c);
    return 0;
}
