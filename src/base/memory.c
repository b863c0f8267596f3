// The allocator behind everything.
// SPDX-License-Identifier: Apache-2.0
#include "sinew/base.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static void *default_resize(void *context, void *block, size_t bytes) {
    (void)context;
    return realloc(block, bytes);
}

static void default_release(void *context, void *block) {
    (void)context;
    free(block);
}

static sn_allocator allocator = {default_resize, default_release, NULL};

void sn_set_allocator(const sn_allocator *replacement) {
    static const sn_allocator standard = {default_resize, default_release, NULL};
    allocator = replacement ? *replacement : standard;
}

void *sn_resize(void *block, size_t count, size_t size) {
    size_t bytes = count * size;
    if (size != 0 && count > SIZE_MAX / size) {
        sn_fail(SN_E_MEMORY, "out of memory: %zu items of %zu bytes", count, size);
        return NULL;
    }
    // a block of no bytes still has an address, so that NULL always means shortage
    void *resized = allocator.resize(allocator.context, block, bytes ? bytes : 1);
    if (!resized) sn_fail(SN_E_MEMORY, "out of memory: %zu items of %zu bytes", count, size);
    return resized;
}

void *sn_alloc(size_t count, size_t size) {
    void *block = sn_resize(NULL, count, size);
    if (block) memset(block, 0, count * size);
    return block;
}

void sn_free(void *block) {
    if (block) allocator.release(allocator.context, block);
}
