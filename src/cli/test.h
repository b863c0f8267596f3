// What sinew test found, for its terminal, its JSON and its page.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"

typedef struct test_outcome {
    const sn_tissue *tissue;
    sn_protocol protocol; ///< looked at where nothing was replayed
    sn_record *record;
    bool replayed;
    sn_curve measured; ///< of a replay
    sn_fit_curve prediction;
    sn_cycles cycles; ///< of a cyclic test; none where they could not be told apart
} test_outcome;

/// A protocol was run, not a curve replayed, and it is this one.
bool test_is(const test_outcome *o, sn_protocol_kind kind);
/// Key of a part of the stress with a memory of its own; NULL where it has none. A tissue that is
/// not branched has one, its first.
const char *test_part(const sn_tissue *tissue, sn_part part);
/// The memory of a part as exponentials over the times that the test sees. @return false where it
/// cannot be had.
bool test_memory(const test_outcome *o, sn_part part, sn_exponentials *e);
/// Writes the page. @return SN_OK, SN_E_FILE, SN_E_MEMORY.
sn_status test_report(const char *path, const test_outcome *o);
