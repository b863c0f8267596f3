// A hash to tell data apart.
// SPDX-License-Identifier: Apache-2.0
#include <string.h>

#include "sinew/base.h"

uint64_t sn_hash(uint64_t hash, const void *data, size_t bytes) {
    const unsigned char *at = data;
    for (; bytes > 0; at += 8) {
        uint64_t word = 0;
        size_t part = bytes < 8 ? bytes : 8;
        memcpy(&word, at, part);
        hash = (hash ^ word) * 1099511628211u;
        hash ^= hash >> 29; // the product carries upwards only
        bytes -= part;
    }
    return hash;
}
