// What springs refuse: a memory for each part of the stress.
// SPDX-License-Identifier: Apache-2.0
#include "bodies.h"

static void branches_are_refused(void **state) {
    (void)state;
    const double size[3] = {0.02, 0.02, 0.02};
    const int cells[3] = {2, 2, 2};
    sn_tissue t = demiray(2e3, 4, 4e4);
    t.memory = prony(0.3, 0.01, 0.2, 0.2);
    t.branched = true;
    snprintf(t.name, sizeof t.name, "liver");
    sn_case *c = make_block(size, cells, SN_PATTERN_MIRRORED, &t);
    add_support(c, "bottom", "xyz");
    sn_net *net;
    CHECK_FAILS(sn_net_create(c, &net), SN_E_UNSUPPORTED,
                "springs: tissue liver has a branch memory");
    assert_null(net);
    c->tissue[0].branched = false;
    CHECK_OK(sn_net_create(c, &net));
    sn_net_destroy(net);
    sn_case_destroy(c);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(branches_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
