// The instruction sets that kernels are compiled for, and the one in use.
// SPDX-License-Identifier: Apache-2.0
//
// A folder with kernels keeps a table of function pointers with a row for each instruction set:
//     static fn *const row[SN_ISA_COUNT] = {
//     #define X(isa) [SN_ISA_##isa] = name_##isa##_64,
//         SN_ISA_LIST(X)
//     #undef X
//     };
// and calls row[sn_isa_current()]. All rows give equal bits (base/wide.h).
#pragma once

#ifdef SN_HAVE_ISA_sse2
#define SN_ISA_IF_sse2(...) __VA_ARGS__
#else
#define SN_ISA_IF_sse2(...)
#endif
#ifdef SN_HAVE_ISA_avx2
#define SN_ISA_IF_avx2(...) __VA_ARGS__
#else
#define SN_ISA_IF_avx2(...)
#endif
#ifdef SN_HAVE_ISA_avx512
#define SN_ISA_IF_avx512(...) __VA_ARGS__
#else
#define SN_ISA_IF_avx512(...)
#endif
#ifdef SN_HAVE_ISA_neon
#define SN_ISA_IF_neon(...) __VA_ARGS__
#else
#define SN_ISA_IF_neon(...)
#endif

/// X(isa) for every instruction set of this build, the slowest first.
#define SN_ISA_LIST(X)                                                                             \
    X(scalar)                                                                                      \
    SN_ISA_IF_sse2(X(sse2)) SN_ISA_IF_avx2(X(avx2)) SN_ISA_IF_avx512(X(avx512))                    \
        SN_ISA_IF_neon(X(neon))
/// X(isa, name) likewise, for macros that need a name.
#define SN_ISA_LIST_FOR(X, name)                                                                   \
    X(scalar, name)                                                                                \
    SN_ISA_IF_sse2(X(sse2, name)) SN_ISA_IF_avx2(X(avx2, name)) SN_ISA_IF_avx512(X(avx512, name))  \
        SN_ISA_IF_neon(X(neon, name))

enum sn_isa {
#define SN_ISA_ENUM(isa) SN_ISA_##isa,
    SN_ISA_LIST(SN_ISA_ENUM)
#undef SN_ISA_ENUM
        SN_ISA_COUNT
};

/// The row in use: chosen once, from the processor or SINEW_ISA. Thread-safe.
int sn_isa_current(void);
/// Whether this processor can run a row.
int sn_isa_available(int isa);
/// "scalar", "sse2", …
const char *sn_isa_row_name(int isa);
/// The row that SINEW_ISA=`wanted` selects: the named one if it is there and the processor has it,
/// else the best. Nullable: the best.
int sn_isa_choose(const char *wanted);
