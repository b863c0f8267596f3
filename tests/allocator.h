// An allocator that counts, and that may run out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check.h"

static long allocations;           ///< so far
static long blocks_live;           ///< not yet released
static long allocations_left = -1; ///< that still succeed; negative: all

static inline void *counted_resize(void *context, void *block, size_t bytes) {
    (void)context;
    if (allocations_left == 0) return NULL;
    if (allocations_left > 0) allocations_left--;
    allocations++;
    blocks_live += !block;
    return realloc(block, bytes);
}

static inline void counted_release(void *context, void *block) {
    (void)context;
    blocks_live -= block != NULL;
    free(block);
}

static const sn_allocator counting = {counted_resize, counted_release, NULL};
