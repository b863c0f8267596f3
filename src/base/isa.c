// Which row of kernels this processor runs.
// SPDX-License-Identifier: Apache-2.0
#include "base/isa.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "sinew/base.h"

static const char *const names[] = {
#define SN_ISA_NAME(isa) #isa,
    SN_ISA_LIST(SN_ISA_NAME)
#undef SN_ISA_NAME
};

const char *sn_isa_row_name(int isa) {
    return names[isa];
}

int sn_isa_available(int isa) {
    const char *name = names[isa];
#if defined(__x86_64__) || defined(__i386__)
    __builtin_cpu_init();
    if (!strcmp(name, "sse2")) return !!__builtin_cpu_supports("sse2");
    if (!strcmp(name, "avx2")) return !!__builtin_cpu_supports("avx2");
    if (!strcmp(name, "avx512"))
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
#endif
    return !strcmp(name, "scalar") || !strcmp(name, "neon"); // all AArch64 has NEON
}

int sn_isa_choose(const char *wanted) {
    int best = 0;
    for (int isa = 0; isa < SN_ISA_COUNT; isa++) {
        if (!sn_isa_available(isa)) continue;
        if (wanted && !strcmp(wanted, names[isa])) return isa;
        best = isa;
    }
    return best;
}

int sn_isa_current(void) {
    // every thread that comes first finds the same row, so who stores it does not matter
    static atomic_int chosen = -1;
    int isa = atomic_load_explicit(&chosen, memory_order_relaxed);
    if (isa < 0) {
        isa = sn_isa_choose(getenv("SINEW_ISA"));
        atomic_store_explicit(&chosen, isa, memory_order_relaxed);
    }
    return isa;
}

const char *sn_isa_name(void) {
    return names[sn_isa_current()];
}
